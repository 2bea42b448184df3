# make check and the other checks; included by the Makefile.

# ---- Tests ----

$(BUILD)/tests/%: tests/%.c $(BUILD)/libglint.a $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(COMPILE) -MMD -MP $< $(LINK) $(BUILD)/libglint.a $(TEST_LIBS) $(LIBS) -o $@

# The sandbox of --untrusted, attacked from the inside.
$(BUILD)/tests/command/walls: tests/command/walls.c $(BUILD)/bindings/command/walls.o
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(COMPILE) $(LUA_CFLAGS) -MMD -MP $< $(BUILD)/bindings/command/walls.o $(LINK) $(LIBS) $(COMMAND_LIBS) -o $@

# The renderer, without any other part of the engine and without libraries.
RENDERER_OBJ := $(filter $(addprefix $(BUILD)/engine/,base/% film/% render/%),$(ENGINE_OBJ))
$(BUILD)/tests/command/alone: tests/command/alone.c $(RENDERER_OBJ)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(COMPILE) -MMD -MP $< $(RENDERER_OBJ) $(LINK) -lm $(PTHREAD) -o $@

$(HARD_OBJ): OWN := -D_GNU_SOURCE # arithmetic in _Float128
# The hard cases: each hard_*.c is a program; the other files are shared. They use only the public API.
$(HARD_BIN): $(BUILD)/%: %.c $(HARD_OBJ) $(BUILD)/libglint.a $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(COMPILE) -D_GNU_SOURCE -MMD -MP $< $(LINK) $(HARD_OBJ) $(BUILD)/libglint.a $(TEST_LIBS) $(LIBS) -o $@

# The command without effects, of the same objects, except the tables of kernels.
$(KERNELS:%=$(CORE)/table.%.o): $(CORE)/table.%.o: engine/render/stages/simd/table.c $(BUILD)/flags $(BUILD)/kernels
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(COMPILE) $(PLAIN) -DGLINT_ISA=$* $(NO_FLOAT) $(call without_kernels,$(EFFECTS)) -MMD -MP -c $< -o $@
$(CORE)/glint: $(BINDINGS_OBJ) $(CORE_OBJ)
	$(call say,LINK)
	@rm -f $(@D)/libglint.a
	$(Q)$(AR) qcs $(@D)/libglint.a $(CORE_OBJ)
	$(Q)$(CC) $(LINK) $(LINK_COMMAND) $(BINDINGS_OBJ) $(@D)/libglint.a $(LUA_LIBS) $(LIBS) $(COMMAND_LIBS) $(LIB_DL) -o $@

tests: all $(TEST_BIN) $(TEST_TOOLS) $(HARD_BIN) $(CORE)/glint

SCRIPTED := $(wildcard tests/lua/test_*.lua tests/hard/*.lua tests/lua/check_*.lua \
              $(addprefix tests/command/,$(addsuffix .sh,alone cli completion denoise dump effects exposure faults films gallery golden inputs install kills left_out memory mistakes parts povray publish python readme relight sweeps until untrusted vectors warnings watch)) tests/machines/systems.sh)
RUNNER = BUILD=$(BUILD) LUA=$(LUA) MAKE="$(MAKE)" tests/run.sh

check: ## every test; T=name runs those whose name has it
	@tests/deps.sh build test
	@$(MAKE) --no-print-directory check-run

check-run: tests
	@T="$(T)" $(RUNNER) make:lint make:check-headers make:check-symbols make:check-layers $(TEST_BIN) $(HARD_BIN) $(SCRIPTED)

# Bits, in a few minutes: kernels against the reference, the BVH, images, goldens, and the interface in Lua.
QUICK := $(filter $(BUILD)/tests/engine/test_stages_% %/test_bvh %/test_image,$(TEST_BIN)) tests/command/golden.sh tests/lua/test_api.lua
.PHONY: quick quick-run
quick: ## what most mistakes break, in a few minutes: kernels against the reference, goldens, the interface in Lua
	@tests/deps.sh build test
	@$(MAKE) --no-print-directory quick-run

quick-run: all $(QUICK)
	@$(RUNNER) make:check-layers $(QUICK)

# Tests worth running under a sanitizer: C, Lua and the command line. Excludes tests of other programs and of
# installed files, and tests that only run scripts which other tests also run.
SANITIZED := $(filter-out $(addprefix tests/,$(addprefix command/,povray.sh gallery.sh install.sh readme.sh) machines/systems.sh),$(SCRIPTED))
# Tests of threads: tiles, BVH, bands of rows, the writer, the cache between frames, the server of watch. One
# instruction set suffices: threads share the same data in all of them.
THREADED  := $(addprefix $(BUILD)/tests/,$(addprefix engine/test_,bands bvh carry carry_turns files image reuse reuse_turns soft) \
               hard/hard_limits) tests/lua/test_patterned.lua tests/command/watch.sh

# ASan sees every access of the kernels: UBSan need not look for null pointers and the sizes of objects there.
asan: ## the tests under AddressSanitizer and UBSan, in build-asan/, with the generic kernels and the best of this machine
	@tests/deps.sh build test
	@$(MAKE) --no-print-directory san-run BUILD=build-asan CFLAGS="-O1 -g1" KERNEL_CFLAGS="-O1 -fno-sanitize=null,object-size" \
	    SANITIZE=address,undefined,float-cast-overflow KERNELS="$(sort generic $(BEST))" PRELOAD=libasan.so ITEMS='$$(TEST_BIN) $$(HARD_BIN) $$(SANITIZED)'

tsan: ## the tests with threads under ThreadSanitizer, in build-tsan/
	@tests/deps.sh build test
	@$(MAKE) --no-print-directory san-run BUILD=build-tsan CFLAGS="-O1 -g1" KERNEL_CFLAGS=-O1 SANITIZE=thread \
	    KERNELS=$(BEST) PRELOAD=libtsan.so ITEMS='$$(THREADED)'

# ---- Checks that need more than the build does; each says what is missing ----

.PHONY: check-films check-report check-mixer check-watch check-rock check-farm
check-films: ## films by the real ffmpeg, and what Chromium makes of them; installs both through apt
	@tests/deps.sh build test films
	@$(MAKE) --no-print-directory all
	@$(RUNNER) tests/command/real_films.sh

check-report: all ## the page of glint cost --report in headless Chromium, where that is installed
	@$(RUNNER) tests/command/report.sh

check-mixer: all ## the page of glint relight in headless Chromium, where that is installed
	@$(RUNNER) tests/command/mixer.sh

check-watch: all ## the page of glint watch in headless Chromium, where that is installed
	@$(RUNNER) tests/command/watch_page.sh

check-rock: ## the rock of make dist into a folder of its own; installs luarocks and zip through apt
	@tests/deps.sh build rock
	@TEST_LIMIT_S=1200 $(RUNNER) tests/command/rock.sh

# The minimal build: POSIX, generic kernels, no optional library, no optimization (a little for kernels, for speed).
PORTABLE_MAKE  := $(MAKE) --no-print-directory BUILD=build-portable PORTABLE=1 have= CFLAGS="-O0 -Werror" KERNEL_CFLAGS="-O1 -Werror"
PORTABLE_TESTS := $(addprefix $(BUILD)/tests/engine/test_,bands carry_turns deflate files image open picture reuse_turns) \
                    $(addprefix tests/lua/test_,$(addsuffix .lua,api data mesh_files)) \
                    $(addprefix tests/command/,$(addsuffix .sh,alone cli completion films golden inputs install kills parts watch))

CLANG_MAKE  := $(MAKE) --no-print-directory BUILD=build-clang CC=clang CFLAGS="-O2 -g -Werror"
CLANG_TESTS := $(filter $(BUILD)/tests/engine/test_stages_%,$(TEST_BIN)) \
                 $(addprefix $(BUILD)/tests/engine/test_,caps files lattice leaf math program program_math reuse tone) \
                 $(addprefix tests/command/,$(addsuffix .sh,alone cli golden))

.PHONY: check-portable check-portable-run check-clang check-clang-run
check-portable: ## PORTABLE=1 at -O0 without any optional library: files, folders, watch, runs, installation
	@tests/deps.sh build test
	+@$(PORTABLE_MAKE) check-portable-run

check-portable-run: all $(filter $(BUILD)/%,$(PORTABLE_TESTS)) $(BUILD)/tests/command/alone
	@T="$(T)" $(RUNNER) $(PORTABLE_TESTS)

check-clang: ## clang's build without a warning, tests too: kernels, goldens, the command; installs clang through apt
	@tests/deps.sh build test fuzz
	+@$(CLANG_MAKE) check-clang-run

check-clang-run: all $(TEST_BIN) $(BUILD)/tests/command/alone $(HARD_BIN) # every test compiles with it, too
	@T="$(T)" GLINT_CASE_STEP=5 $(RUNNER) $(CLANG_TESTS)

.PHONY: check-package
check-package: ## the Debian source package of .github/debian, and what lintian says of it; installs what that takes through apt
	@tests/deps.sh package
	@$(RUNNER) tests/command/source_package.sh

check-farm: all ## scripts/farm with GNU parallel, and on a Slurm that SLURM_CLUSTER=PROGRAM starts
	@tests/deps.sh farm
	@$(RUNNER) tests/command/farm.sh

ARM64          := build-arm64
ARM64_SYSROOT  := $(ARM64)/sysroot
ARM64_LIBRARY  := $(CURDIR)/$(ARM64_SYSROOT)/usr/lib/aarch64-linux-gnu
ARM64_TESTS    := $(patsubst %,$(ARM64)/tests/engine/test_%,stages_bounce stages_cast stages_light stages_occlude stages_scatter \
                    stages_shade tone)
ARM64_EMULATOR := qemu-aarch64 -L $(CURDIR)/$(ARM64_SYSROOT)

.PHONY: check-arm64 check-arm64-run
check-arm64: ## goldens, the kernels' tests and a job's hashes on arm64, under qemu; installs compiler and qemu through apt
	@tests/deps.sh build test arm64
	@tests/machines/arm64_sysroot.sh $(ARM64_SYSROOT)
	@$(MAKE) --no-print-directory all
	@PKG_CONFIG_LIBDIR=$(ARM64_LIBRARY)/pkgconfig PKG_CONFIG_SYSROOT_DIR=$(CURDIR)/$(ARM64_SYSROOT) $(MAKE) --no-print-directory \
	    BUILD=$(ARM64) CC="$(ARM64_CC) --sysroot=$(CURDIR)/$(ARM64_SYSROOT)" $(ARM64)/glint $(ARM64)/glint.so $(ARM64_TESTS)
	@$(MAKE) --no-print-directory check-arm64-run

ARM64_CC ?= aarch64-linux-gnu-gcc

check-arm64-run:
	@ELSEWHERE=$(ARM64) GLINT_CASE_STEP=23 EMULATOR="$(ARM64_EMULATOR)" ENCODERS=same LACKS=avx2 \
	    TEST_LIMIT_S=$${TEST_LIMIT_S:-1200} $(RUNNER) tests/machines/elsewhere.sh $(ARM64_TESTS)

MUSL           := build-musl
MUSL_LIBRARIES := $(CURDIR)/$(MUSL)/libraries

.PHONY: check-musl check-musl-run
check-musl: ## goldens and a job's pixels by a static command on musl, with no optional library; its libraries are built from Debian's sources
	@tests/deps.sh build test musl
	@mkdir -p $(MUSL)
	@tests/machines/libraries.sh $(MUSL_LIBRARIES) musl-gcc ar
	@$(MAKE) --no-print-directory all
	@PKG_CONFIG_LIBDIR=$(MUSL_LIBRARIES)/lib/pkgconfig $(MAKE) --no-print-directory BUILD=$(MUSL) CC=musl-gcc LDFLAGS=-static \
	    CFLAGS=-O1 KERNEL_CFLAGS=-O1 KERNELS=$(BEST:avx512=avx2) FLOAT= $(MUSL)/glint
	@$(MAKE) --no-print-directory check-musl-run

check-musl-run:
	@ELSEWHERE=$(MUSL) EMULATOR= LACKS=avx512 $(RUNNER) tests/machines/elsewhere.sh

# Only clang has libFuzzer. The kernels are compiled without its counters: other tests cover them.
FUZZ       := build-fuzz
FUZZERS    := picture mesh command data scene pattern formula
FUZZ_CC    ?= clang
FUZZ_BIN   := $(FUZZERS:%=$(BUILD)/tests/fuzz/fuzz_%)
FUZZ_MAKE  := $(MAKE) --no-print-directory BUILD=$(FUZZ) PORTABLE=1 CC="$(FUZZ_CC)" CFLAGS="-O1 -g" \
                KERNEL_CFLAGS="-O1 -fno-sanitize=all" \
                SANITIZE=fuzzer-no-link,address,undefined,float-cast-overflow

.PHONY: fuzz check-fuzz fuzz-programs
check-fuzz: ## each fuzzer for FUZZ_SECONDS (60) or FUZZ_RUNS inputs, from its corpus in tests/fuzz/corpus; installs clang through apt
	@tests/deps.sh build fuzz
	+@$(FUZZ_MAKE) fuzz-programs
	@T="$(T)" FUZZ=$(FUZZ) $(RUNNER) $(FUZZERS:%=fuzz:%)

fuzz: ## the fuzzers for an hour each, or FUZZ_SECONDS
	@FUZZ_SECONDS=$${FUZZ_SECONDS:-3600} TEST_LIMIT_S=1000000 $(MAKE) --no-print-directory check-fuzz

fuzz-programs: $(FUZZ_BIN)

$(addprefix $(BUILD)/tests/fuzz/fuzz_,data scene pattern): $(BUILD)/tests/fuzz/fuzz_%: tests/fuzz/fuzz_lua.c tests/fuzz/fuzz.h \
    $(MODULE_OBJ) $(BUILD)/libglint.a
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(COMPILE) $(LUA_CFLAGS) -DDRIVER='"tests/fuzz/$*.lua"' $< -fsanitize=fuzzer $(LINK) $(MODULE_OBJ) $(BUILD)/libglint.a \
	    $(LUA_LIBS) $(LIBS) $(LIB_DL) -o $@

$(BUILD)/tests/fuzz/fuzz_command: $(filter-out $(BUILD)/bindings/command/main.o,$(BINDINGS_OBJ))
$(BUILD)/tests/fuzz/fuzz_%: tests/fuzz/fuzz_%.c tests/fuzz/file.c tests/fuzz/fuzz.h $(BUILD)/libglint.a
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(COMPILE) $(LUA_CFLAGS) $(filter %.c,$^) -fsanitize=fuzzer $(LINK) $(filter %.o,$^) $(BUILD)/libglint.a \
	    $(if $(filter %.o,$^),$(LUA_LIBS) $(COMMAND_LIBS) $(LIB_DL)) $(LIBS) -o $@

# Lua unloads the module at its end. pixman, which cairo uses, never frees its tables, so it stays loaded: otherwise they
# would be reported as leaks.
.PHONY: san-run
san-run: tests
	@T="$(T)" HARD_RAYS=20000 GLINT_CASE_STEP=7 TEST_LIMIT_S=$${TEST_LIMIT_S:-900} \
	    PRELOAD=$$($(CC) -print-file-name=$(PRELOAD))$(if $(CAIRO_LIBS),:libpixman-1.so.0) $(RUNNER) $(ITEMS)

hard: ## the hard cases as Markdown tables: truth, engine in double and in float, textbook formula, verdict
	@tests/deps.sh build test
	@$(MAKE) --no-print-directory -s hard-run

hard-run: $(HARD_BIN) $(BUILD)/glint.so
	@bad=0; for program in $(HARD_BIN); do $$program --table || bad=1; echo; done; \
	LUA_CPATH="$(BUILD)/?.so;;" $(LUA) tests/hard/hard_scenes.lua --table || bad=1; \
	BUILD=$(BUILD) $(LUA) tests/hard/hard_faces.lua --table || bad=1; exit $$bad

SOAK_RAYS ?= 1e8
SOAK_SECONDS ?= 300
SOAK_SEED ?= 7

calibrate: all ## how often --until and the advice of glint cost are right: 12 scenes, 10 seeds; QUICK=1: small pictures, minutes
	@BUILD=$(BUILD) $(LUA) tests/bench/calibrate.lua 12 10 $(if $(QUICK),48x27,160x90)

soak: ## random edits against fresh frames for SOAK_SECONDS, then the hard cases with SOAK_RAYS rays (1e8: half an hour)
	@tests/deps.sh build test
	@$(MAKE) --no-print-directory soak-run

# The soak uses other seeds than the check, so that both test new cases.
soak-run: all $(HARD_BIN) $(BUILD)/tests/engine/test_reuse $(BUILD)/tests/engine/test_carry
	@GLINT_SOAK_SECONDS=$(SOAK_SECONDS) GLINT_SEED=$(SOAK_SEED) $(BUILD)/tests/engine/test_reuse
	@GLINT_SEED=$(SOAK_SEED) $(BUILD)/tests/engine/test_carry
	@tests/hard/soak.sh $(BUILD)/tests/hard $(SOAK_RAYS)
	@STEP=1 BUILD=$(BUILD) bash tests/command/faults.sh

gallery: all ## renders the pictures of scripts/README.md and bindings/docs/ anew, where they are not what the scripts render
	@BUILD=$(BUILD) tests/command/gallery.sh update
	@BUILD=$(BUILD) bash tests/command/readme.sh update

golden-update: all ## writes the golden pictures anew, and prints which moved and by how much
	@BUILD=$(BUILD) tests/command/golden.sh update

check-layers: ## the engine names no Lua, the stages no scene
	@tests/layers.sh

check-symbols: $(KERNEL_OBJ) $(BUILD)/glint.so $(BINDINGS_OBJ) ## an instruction set's object defines its table and nothing else; no large circle of files
	@tests/symbols.sh $(BUILD)/glint.so $(KERNEL_OBJ)
	@$(LUA) tests/circles.lua $(ENGINE_OBJ) $(BINDINGS_OBJ)

check-headers: ## each header compiles alone
	@CC="$(CC)" tests/headers.sh $(COMPILE) $(LUA_CFLAGS)

lint: ## luacheck and cppcheck, where installed
	@tests/lint.sh
