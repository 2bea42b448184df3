# glint: `make` builds the command and the Lua module, `make help` lists the rest. Every source is found by wildcard.
# tests/tests.mk has the checks, tests/bench/bench.mk the bench, and bindings/web/web.mk the module for browsers.

# Jobs: as many as there are processors, unless -j says otherwise.
JOBS := $(shell case " $$MAKEFLAGS" in (*" -j"* | *" --jobs"*) ;; (*) nproc 2>/dev/null || getconf _NPROCESSORS_ONLN 2>/dev/null || \
          getconf NPROCESSORS_ONLN 2>/dev/null ;; esac)
MAKEFLAGS += $(JOBS:%=-j%)
ifneq ($(filter clean,$(MAKECMDGOALS)),)
.NOTPARALLEL: # `make clean all`
endif

BUILD    ?= build
CC       ?= cc
AR       ?= ar
CFLAGS   ?= -O2 -g
KERNEL_CFLAGS ?= -O3
# Names used by Debian, FreeBSD and OpenBSD.
LUA_NAMES := lua5.4 lua-5.4 lua54
LUA      ?= $(shell for name in $(LUA_NAMES); do command -v $$name >/dev/null && echo $$name && break; done)
LUA_PACKAGE := $(shell for name in $(LUA_NAMES); do pkg-config --exists $$name 2>/dev/null && echo $$name && break; done)
comma    := ,

prefix   ?= /usr/local
PREFIX   ?= $(prefix)
bindir   ?= $(PREFIX)/bin
# Debian installs the libraries of system packages in one folder per architecture.
MULTIARCH := $(if $(filter /usr,$(PREFIX)),$(shell $(CC) -print-multiarch 2>/dev/null))
libdir   ?= $(PREFIX)/lib$(if $(MULTIARCH),/$(MULTIARCH))
incdir   ?= $(PREFIX)/include
datadir  ?= $(PREFIX)/share
luadir   ?= $(libdir)/lua/5.4
luasharedir ?= $(datadir)/lua/5.4

VERSION := $(shell sed -n 's/^.define GLINT_VERSION "\(.*\)"/\1/p' engine/glint.h)

# ---- Flags ----

# The same bits everywhere: no contraction, and no user flags that select instructions or relax arithmetic.
UNWANTED := -march=% -mcpu=% -mavx% -msse% -mfma -Of% -ffast% -funsafe% -ffp-contract=% -flto%
WARN := -Wall -Wextra -Wpedantic
WARN += -Wshadow
WARN += -Wstrict-prototypes
TARGET := $(shell $(CC) -dumpmachine)
# The default uses everything that Linux offers. PORTABLE=1 uses only POSIX 2008 (and anonymous mappings, which are in
# POSIX since 2024): any other system call does not compile.
FEATURES := $(if $(and $(PORTABLE),$(findstring linux,$(TARGET))),-D_XOPEN_SOURCE=700 -DMAP_ANONYMOUS=0x20,-D_GNU_SOURCE)
# THREADS= is for machines without threads: the caller does all work. WebAssembly has no threads, and needs no -fPIC.
WASM    := $(findstring wasm,$(TARGET))
THREADS ?= $(if $(WASM),,yes)
PTHREAD := $(if $(THREADS),-pthread)
STRICT := -std=c11 $(FEATURES) $(WARN) $(if $(WASM),,-fPIC) -fvisibility=hidden -ffp-contract=off -fno-math-errno

# Names of linker options and tools that differ between ELF systems and Apple's. tests/machines/systems.sh fakes TARGET.
LINUX  := $(findstring linux,$(TARGET))
MACOS  := $(findstring darwin,$(TARGET))
LINK_NEEDED  := $(if $(MACOS),-Wl$(comma)-dead_strip_dylibs,-Wl$(comma)--as-needed)
LINK_PRIVATE := $(if $(MACOS),,-Wl$(comma)--exclude-libs$(comma)libglint.a)
LINK_COMMAND := $(if $(MACOS),,-Wl$(comma)-E $(LINK_PRIVATE))
LINK_MODULE  := $(if $(MACOS),-bundle -undefined dynamic_lookup,-shared $(LINK_PRIVATE))
LINK_SHARED   = $(if $(MACOS),-dynamiclib -Wl$(comma)-install_name$(comma)$(libdir)/$(SONAME) -Wl$(comma)-exported_symbols_list,-shared \
                  -Wl$(comma)-soname$(comma)$(SONAME) $(if $(LINUX),-Wl$(comma)-z$(comma)defs) -Wl$(comma)--version-script)
LIB_DL       := $(if $(LINUX),-ldl)
STRIP_DEBUG  := $(if $(MACOS),-S,--strip-debug)
STRIP_LOCAL  := $(if $(MACOS),-S -x,--strip-unneeded)

have = $(shell pkg-config --exists $(1) 2>/dev/null && echo yes)
PACKAGES := libpng zlib libxxhash
# ISA-L's output depends on the address of its stream (engine/files/picture/deflate.c),
# and ThreadSanitizer does not allow the necessary addresses.
ifeq ($(call have,libisal)$(filter thread,$(SANITIZE)),yes)
  PACKAGES += libisal
  DEFINES += -DGLINT_HAVE_ISAL
endif
ifeq ($(call have,libdeflate),yes)
  PACKAGES += libdeflate
  DEFINES += -DGLINT_HAVE_LIBDEFLATE
endif
# FreeType, Cairo, libjpeg, libsixel and libzstd are each used by one file. Only that file gets their flags.
ifeq ($(call have,freetype2),yes)
  FONT_CFLAGS := -DGLINT_HAVE_FREETYPE $(shell pkg-config --cflags freetype2)
  FONT_LIBS := $(shell pkg-config --libs freetype2)
endif
# For PDF files.
ifeq ($(call have,freetype2 cairo-ft cairo-pdf fontconfig),yes)
  CAIRO_CFLAGS := -DGLINT_HAVE_CAIRO $(shell pkg-config --cflags cairo-ft cairo-pdf fontconfig)
  CAIRO_LIBS := $(shell pkg-config --libs cairo-ft cairo-pdf fontconfig)
endif
# For JPEG textures.
ifeq ($(call have,libjpeg),yes)
  JPEG_CFLAGS := -DGLINT_HAVE_JPEG $(shell pkg-config --cflags libjpeg)
  JPEG_LIBS := $(shell pkg-config --libs libjpeg)
endif
# For drawing in terminals.
ifeq ($(call have,libsixel),yes)
  SIXEL_CFLAGS := -DGLINT_HAVE_SIXEL $(shell pkg-config --cflags libsixel)
  SIXEL_LIBS := $(shell pkg-config --libs libsixel)
endif
# For data files compressed by zstd.
ifeq ($(call have,libzstd),yes)
  ZSTD_CFLAGS := -DGLINT_HAVE_ZSTD $(shell pkg-config --cflags libzstd)
  ZSTD_LIBS := $(shell pkg-config --libs libzstd)
endif
# Only the C core of OpenEXR is used.
ifeq ($(call have,'OpenEXR >= 3.1'),yes)
  EXR_LIBS := $(filter -lOpenEXRCore%,$(shell pkg-config --libs OpenEXR))
  DEFINES += -DGLINT_HAVE_OPENEXR $(patsubst -I%,-isystem %,$(filter -I%OpenEXR,$(shell pkg-config --cflags-only-I OpenEXR)))
endif
ifeq ($(if $(PORTABLE),,$(call have,libseccomp)),yes)
  COMMAND_LIBS := $(shell pkg-config --libs libseccomp)
  DEFINES += -DGLINT_HAVE_SECCOMP
endif

# Run-time checks, for all files except the kernels, whose bounds the caller guarantees and whose speed matters to the
# instruction. Kernels have no checks even where the compiler or a package's flags harden by default. A sanitizer
# brings its own.
OPTIMIZED := $(filter -O1 -O2 -O3 -Os -Og,$(CFLAGS))
PLAIN := -fno-stack-protector -U_FORTIFY_SOURCE
# Optimized objects have line numbers only. Debug information of variables, few of which survive optimization, takes a
# fifth of the time of a compilation, and a third of a kernel's. CFLAGS="-O0 -g" or LINES= have it.
LINES := $(if $(filter -g%,$(CFLAGS)),-g1)
ifeq ($(SANITIZE)$(WASM),)
  HARDEN      := -fstack-protector-strong $(if $(OPTIMIZED),-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3)
  HARDEN_LINK := $(if $(MACOS),,-Wl,-z,relro -Wl,-z,now)
endif

# WITHOUT="indirect bounce" leaves out effects, WITHOUT=all all effects that can be (see engine/render/README.md): the
# left_out.c of their folders stand in for them, and the tables of kernels change. WITHOUT=MESH omits a part of the
# kernels, see engine/render/stages/contract/with.h.
EFFECTS  := $(patsubst engine/render/effects/%/left_out.c,%,$(wildcard engine/render/effects/*/left_out.c))
# bounce bounds the light along a ray, which indirect reads; rough follows its rays by indirect's paths.
LEFT_OUT := $(sort $(if $(filter all,$(WITHOUT)),$(EFFECTS),$(filter $(EFFECTS),$(WITHOUT) $(if $(filter bounce,$(WITHOUT)),indirect) $(if $(filter bounce indirect,$(WITHOUT)),rough))))
# The switches of with.h for the tables of kernels of a build without these effects.
without_kernels = $(shell echo '$(1:%=-DGLINT_WITHOUT_%=0,0)' | tr a-z A-Z)
PARTS_OUT := $(filter-out all $(EFFECTS),$(WITHOUT))
$(foreach part,$(PARTS_OUT),$(if $(shell grep -rl 'GLINT_WITH($(part))' engine),,$(error WITHOUT=$(part): no such effect or part of the kernels)))
DEFINES += $(PARTS_OUT:%=-DGLINT_WITHOUT_%=0,0) $(if $(PARTS_OUT),-Wno-type-limits)

# PORTABLE=1 builds here as for other machines:
# generic kernels, POSIX instead of inotify, eventfd etc., and no --untrusted.
DEFINES += $(if $(PORTABLE),-DGLINT_PORTABLE) $(if $(THREADS),,-DGLINT_NO_THREADS)

# The public headers. Their functions are visible in the shared library. Calls of them within the engine stay direct.
HEADERS := $(wildcard engine/glint*.h)
OWN_CALLS := $(if $(WASM),,-fno-semantic-interposition)

# SANITIZE=address,undefined ... is set by `make asan` and `make tsan`.
ifdef SANITIZE
  SAN_FLAGS := -fsanitize=$(SANITIZE) -fno-sanitize-recover=all -fno-omit-frame-pointer
endif

# Objects do not contain the build folder, so that builds in two folders give the same bytes.
HERE := -ffile-prefix-map="$(CURDIR)"=.

# GCC for x86 would fill and copy structs of some hundred bytes with `rep`, whose start-up takes as long as the
# arithmetic of a group.
MOVES := -mmemset-strategy=unrolled_loop:512:noalign,libcall:-1:noalign -mmemcpy-strategy=unrolled_loop:512:noalign,libcall:-1:noalign
MOVES := $(shell $(CC) -Werror $(MOVES) -x c -S -o /dev/null /dev/null 2>/dev/null && echo '$(MOVES)')

COMPILE := $(HERE) -I. -I$(BUILD) $(DEFINES) $(shell pkg-config --cflags $(PACKAGES) 2>/dev/null) $(CPPFLAGS) \
           $(filter-out $(UNWANTED),$(CFLAGS)) $(STRICT) $(MOVES) $(SAN_FLAGS) $(PTHREAD)
LUA_CFLAGS := $(shell pkg-config --cflags $(LUA_PACKAGE) 2>/dev/null)
LUA_LIBS   := $(shell pkg-config --libs $(LUA_PACKAGE) 2>/dev/null)
LIBS       := $(shell pkg-config --libs $(PACKAGES) 2>/dev/null) $(FONT_LIBS) $(CAIRO_LIBS) $(JPEG_LIBS) $(SIXEL_LIBS) $(ZSTD_LIBS) $(EXR_LIBS) -lm $(PTHREAD)
TEST_LIBS  := $(shell pkg-config --libs cmocka 2>/dev/null) $(if $(call have,mpfr),$(shell pkg-config --libs mpfr))
LINK       := $(SAN_FLAGS) $(HARDEN_LINK) $(LDFLAGS) $(if $(WASM),,$(LINK_NEEDED))

# ---- Sources ----

ENGINE_SRC   := $(sort $(shell find engine -name "*.c"))
# The module for browsers has its own entry points, and only some files of the command.
WEB_SRC      := $(filter-out bindings/run/film_pipe.c,$(wildcard $(addsuffix /*.c,$(addprefix bindings/,lua pattern run value web)))) \
                  $(addprefix bindings/command/,$(addsuffix .c,describe events explain output progress script signals untrusted_lua))
BINDINGS_SRC := $(sort $(if $(WASM),$(WEB_SRC),$(filter-out bindings/web/%,$(wildcard bindings/*/*.c))))
# The instruction sets for this kind of machine. KERNELS=native compiles only the best one of this very machine,
# KERNELS=avx2 only that one, for work on a kernel.
KERNELS := generic $(if $(PORTABLE),,$(if $(filter x86_64-% amd64-%,$(TARGET)),avx2 avx512))
NATIVE   = $(shell $(CC) -march=native -dM -E - </dev/null 2>/dev/null)
native_has = $(if $(PORTABLE),,$(if $(filter-out $(foreach one,$(1),$(findstring $(one),$(NATIVE))),$(1)),,yes))
BEST     = $(if $(call native_has,__AVX512BW__ __AVX512DQ__ __AVX512VL__),avx512,$(if $(call native_has,__AVX2__ __FMA__),avx2,generic))
ifeq ($(KERNELS),native)
  override KERNELS := $(BEST)
endif
# The stages and the kernels of other folders are compiled for each instruction set, those of geometry and light also for each
# precision.
STAGE_SRC    := $(filter-out engine/render/stages/ref/% engine/render/stages/simd/select.c,$(filter engine/render/stages/% $(wildcard engine/render/*/kernel*.c engine/render/effects/*/kernel*.c),$(ENGINE_SRC)))
STAGES_ONCE  := $(filter engine/render/stages/simd/% engine/render/stages/film/% %/shade/samples.c \
                  %/adaptive/kernel.c %/derivative/kernel.c %/pattern/kernel.c %/kernel_sky.c,$(STAGE_SRC))
STAGES_TWICE := $(filter-out $(STAGES_ONCE),$(STAGE_SRC))
# FLOAT= leaves out float, for a build in less time: the reference then renders --precision float, with the same bits.
FLOAT        ?= yes
NO_FLOAT     := $(if $(FLOAT),,-DGLINT_NO_FLOAT)
STAGE_OBJ    := $(foreach isa,$(KERNELS),$(STAGES_ONCE:%.c=$(BUILD)/%.$(isa).o) $(foreach real,f64 $(FLOAT:%=f32),$(STAGES_TWICE:%.c=$(BUILD)/%.$(isa).$(real).o)))
ENGINE_SRC   := $(filter-out $(STAGE_SRC),$(ENGINE_SRC))
TABLE_OBJ    := $(KERNELS:%=$(BUILD)/engine/render/stages/simd/table.%.o)
# without EFFECTS: the objects of a build that leaves them out
without       = $(filter-out $(foreach effect,$(1),$(BUILD)/engine/render/effects/$(effect)/%) %/left_out.o,$(STAGE_OBJ) $(ENGINE_SRC:%.c=$(BUILD)/%.o)) \
                  $(1:%=$(BUILD)/engine/render/effects/%/left_out.o)
ENGINE_OBJ   := $(call without,$(LEFT_OUT))
CORE         := $(BUILD)/without/effects
CORE_OBJ     := $(filter-out $(TABLE_OBJ),$(call without,$(EFFECTS))) $(KERNELS:%=$(CORE)/table.%.o)
BINDINGS_OBJ := $(BINDINGS_SRC:%.c=$(BUILD)/%.o)
COMMAND_OBJ  := $(BUILD)/bindings/command/main.o $(BUILD)/bindings/command/untrusted.o $(BUILD)/bindings/command/walls.o # the command has them, the module has not
MODULE_OBJ   := $(filter-out $(COMMAND_OBJ),$(BINDINGS_OBJ))
TEST_BIN     := $(patsubst %.c,$(BUILD)/%,$(sort $(wildcard tests/engine/test_*.c)))
TEST_TOOLS   := $(BUILD)/tests/compare16 $(BUILD)/tests/command/alone $(BUILD)/tests/gr/codes $(if $(COMMAND_LIBS),$(BUILD)/tests/command/walls)
HARD_BIN     := $(patsubst %.c,$(BUILD)/%,$(sort $(wildcard tests/hard/hard_*.c)))
HARD_OBJ     := $(patsubst %.c,$(BUILD)/%.o,$(sort $(wildcard tests/hard/oracle/*.c)))
KERNEL_OBJ   := $(BUILD)/engine/render/stages/ref/ref.o $(STAGE_OBJ)

# ---- Build ----

# V=1 prints the commands, -s nothing.
Q   := $(if $(V),,@)
say  = $(if $(V)$(findstring s,$(firstword -$(MAKEFLAGS))),,@echo "  $(1)	$@")

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.PHONY: all need deps check check-run asan tsan hard hard-run calibrate soak soak-run bench demo demo-run install uninstall \
        install-rock golden-update gallery check-layers check-symbols check-headers lint clean help tests FORCE

# The manual page and the API for editors: the new program inserts the engine's tables of fields, if it can run here.
FILLED := $(BUILD)/glint.1 $(BUILD)/meta/glint.lua
$(FILLED): $(BUILD)/%: bindings/% bindings/meta/fill.lua $(BUILD)/glint
	@mkdir -p $(@D)
	@FROM=$< ASAN_OPTIONS=detect_leaks=0 $(BUILD)/glint --quiet bindings/meta/fill.lua > $@

all: $(BUILD)/glint $(BUILD)/glint.so $(BUILD)/libglint.a $(if $(filter $(shell uname -m)-%,$(TARGET)),$(FILLED)) ## the command build/glint and the Lua module build/glint.so

# Only kernels are compiled for an instruction set; engine/render/stages/ref and select.c are not. Processors with AVX2
# also have BMI and POPCNT for masks; select.c checks for all of them.
X86_BITS := -mbmi -mbmi2 -mpopcnt
# UBSan cannot look into intrinsics. It checks the stages' sources in the generic kernels; ASan checks both.
FLAGS_avx2   := $(X86_BITS) -mavx2 -mfma $(if $(findstring undefined,$(SANITIZE)),-fno-sanitize=undefined -fno-sanitize=float-cast-overflow)
FLAGS_avx512 := -mavx512f -mavx512dq -mavx512vl -mavx512bw $(FLAGS_avx2)
# stage_rule SUFFIX, INSTRUCTION SET, FLAGS
define stage_rule
$$(BUILD)/engine/%.$(1).o: engine/%.c $$(BUILD)/flags | need
	@mkdir -p $$(@D)
	$$(call say,CC)
	$$(Q)$$(CC) $$(COMPILE) $$(PLAIN) $$(LINES) $$(KERNEL_CFLAGS) $$(FLAGS_$(2)) $$(OWN) -DGLINT_ISA=$(2) $(3) -MMD -MP -c $$< -o $$@
endef
$(foreach isa,$(KERNELS),$(foreach real,64 32,$(eval $(call stage_rule,$(isa).f$(real),$(isa),-DGLINT_REAL=$(real)))) \
    $(eval $(call stage_rule,$(isa),$(isa),$(NO_FLOAT))))
$(TABLE_OBJ): OWN = $(call without_kernels,$(LEFT_OUT))
$(TABLE_OBJ): $(BUILD)/kernels $(BUILD)/effects
# Some sources need flags of their own.
UNROLLED := $(addprefix engine/,compare/flip.c $(addprefix render/,adaptive/choose.c frame/stats.c light_groups/light_groups.c \
              paths/batch.c paths/event.c pattern/inputs.c pattern/shader.c) $(addprefix render/effects/,bounce/bounce.c derivative/bend.c derivative/derivative.c \
              derivative/fade.c derivative/shader.c environment/environment.c indirect/begin.c indirect/indirect.c \
              transparent_shadow/plan.c transparent_shadow/transparent_shadow.c))
$(if $(filter-out $(ENGINE_SRC),$(UNROLLED)),$(error no such source: $(filter-out $(ENGINE_SRC),$(UNROLLED))))
$(UNROLLED:%.c=$(BUILD)/%.o): OWN := $(KERNEL_CFLAGS)
$(BUILD)/engine/render/stages/simd/select.o: OWN := $(KERNELS:%=-DGLINT_KERNEL_%) $(NO_FLOAT)
$(BUILD)/engine/render/stages/simd/select.o: $(BUILD)/kernels
$(BUILD)/libglint.a: $(BUILD)/effects
$(BUILD)/engine/figures/text/letters.o: OWN := $(FONT_CFLAGS)
$(BUILD)/engine/files/vector/pdf.o: OWN := $(CAIRO_CFLAGS)
$(BUILD)/engine/files/picture/jpeg.o: OWN := $(JPEG_CFLAGS)
$(BINDINGS_OBJ): ISA := $(LUA_CFLAGS)
$(BUILD)/bindings/watch/sixel.o: OWN := $(SIXEL_CFLAGS)
$(BUILD)/bindings/lua/unpack.o: OWN := $(ZSTD_CFLAGS)

# Files embedded in the command, as C: bindings/watch/page.html.h has the bytes of bindings/watch/page.html.
CARRIED := $(patsubst %,$(BUILD)/%.h,$(wildcard bindings/*/*.html bindings/*/*.css bindings/web/pages/formula.js $(filter-out bindings/meta/% bindings/cost/% bindings/run/%,$(wildcard bindings/*/*.lua))))
$(CARRIED): $(BUILD)/%.h: %
	@mkdir -p $(@D)
	@{ echo '// The bytes of $<.'; od -An -v -tu1 $< | sed 's/[0-9][0-9]*/&,/g'; } > $@

# Lua modules as C, for programs without files: { name, bytes, size } each. Comments become empty lines.
$(BUILD)/bindings/web/library.h: $(sort $(wildcard scripts/lib/glint/*.lua))
$(BUILD)/bindings/command/dialect.h: scripts/lib/gr.lua $(sort $(wildcard scripts/lib/gr/*.lua))
$(BUILD)/bindings/cost/modules.h: $(sort $(wildcard bindings/cost/*.lua))
$(BUILD)/bindings/run/modules.h: $(sort $(wildcard bindings/run/*.lua))
MODULES := $(patsubst %,$(BUILD)/bindings/%.h,web/library command/dialect cost/modules run/modules)
$(MODULES): Makefile
	@mkdir -p $(@D)
	@{ for file in $(filter %.lua,$^); do echo "static const unsigned char $$(basename $$file .lua)_lua[] = {"; \
	       sed 's/^ *--.*//' $$file | od -An -v -tu1 | sed 's/[0-9][0-9]*/&,/g'; echo '};'; done; \
	   echo 'static const glintL_carried LIBRARY[] = {'; \
	   for file in $(filter %.lua,$^); do name=$${file#scripts/lib/}; name=$${name%.lua}; bytes=$$(basename $$file .lua)_lua; \
	       echo "{ \"$$(echo $$name | tr / .)\", $$bytes, sizeof $$bytes },"; done; \
	   echo '};'; } > $@
$(BINDINGS_OBJ): | $(CARRIED) $(MODULES)

$(BUILD)/%.o: %.c $(BUILD)/flags | need
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(COMPILE) $(if $(OPTIMIZED),$(LINES)) $(if $(filter $(KERNEL_OBJ),$@),$(PLAIN),$(HARDEN)) $(OWN_CALLS) $(ISA) $(OWN) -MMD -MP -c $< -o $@

$(BUILD)/glint: $(BINDINGS_OBJ) $(BUILD)/libglint.a
	$(call say,LINK)
	$(Q)$(CC) $(LINK) $(LINK_COMMAND) $(BINDINGS_OBJ) $(BUILD)/libglint.a $(LUA_LIBS) $(LIBS) $(COMMAND_LIBS) $(LIB_DL) -o $@

$(BUILD)/glint.so: $(MODULE_OBJ) $(BUILD)/libglint.a
	$(call say,LINK)
	$(Q)$(CC) $(LINK) $(LINK_MODULE) $(MODULE_OBJ) $(BUILD)/libglint.a $(LIBS) -o $@

$(BUILD)/libglint.a: $(ENGINE_OBJ)
	@rm -f $@
	$(call say,AR)
	$(Q)$(AR) qcs $@ $(ENGINE_OBJ) # q: sources of two folders may have one name

# The shared library: its name includes the ABI version (for its guarantees see engine/README.md), it exports the
# symbols of the public headers.
ABI        := $(if $(filter 0.%,$(VERSION)),$(basename $(VERSION)),$(firstword $(subst ., ,$(VERSION))))
shared_name = $(if $(MACOS),libglint$(1:%=.%).dylib,libglint.so$(1:%=.%))
SHARED     := $(call shared_name,$(VERSION))
SONAME     := $(call shared_name,$(ABI))

# The list of exported symbols: a version script, or for Apple's linker a list of names.
$(BUILD)/libglint.map: $(HEADERS)
	@mkdir -p $(@D)
	@sed -nE '/^(typedef|static|#|\/\/)/d; s/^[a-z].*[ *](glint_[a-z0-9_]+)\(.*/\1/p' $^ | sort -u | $(if $(MACOS),sed 's/^/_/', \
	    { echo 'GLINT_$(ABI) {'; echo '  global:'; sed 's/.*/    &;/'; echo '  local: *;'; echo '};'; }) > $@

$(BUILD)/$(SHARED): $(ENGINE_OBJ) $(BUILD)/libglint.map
	$(call say,LINK)
	$(Q)$(CC) $(LINK) $(LINK_SHARED),$(BUILD)/libglint.map $(ENGINE_OBJ) $(LIBS) -o $@

.PHONY: shared
shared: $(BUILD)/$(SHARED) ## the shared library, build/libglint.so.VERSION

# When flags or libraries change, everything is compiled again.
# When only KERNELS or FLOAT changes, only the tables of kernels (select.c, table.c) are. When other effects are left
# out, table.c is compiled and the libraries are made again.
$(BUILD)/flags: SAID = $(CC) $(COMPILE) $(HARDEN) $(LUA_CFLAGS) $(FONT_CFLAGS) $(JPEG_CFLAGS) $(SIXEL_CFLAGS) $(ZSTD_CFLAGS)
$(BUILD)/kernels: SAID = $(KERNELS) $(FLOAT)
$(BUILD)/effects: SAID = $(LEFT_OUT)
$(BUILD)/flags $(BUILD)/kernels $(BUILD)/effects: FORCE
	@mkdir -p $(@D)
	@echo '$(SAID)' | cmp -s - $@ || echo '$(SAID)' > $@

need:
	@tests/deps.sh need

-include $(ENGINE_OBJ:.o=.d) $(EFFECTS:%=$(BUILD)/engine/render/effects/%/left_out.d) $(wildcard $(CORE)/*.d) $(BINDINGS_OBJ:.o=.d) $(TEST_BIN:=.d) $(TEST_TOOLS:=.d) $(HARD_OBJ:.o=.d) $(HARD_BIN:=.d)

# An installation may be made from a copy without tests.
-include tests/tests.mk tests/bench/bench.mk

# ---- Use ----

demo: ## renders scripts/moving_light.lua, 120 frames, into build/demo/
	@tests/deps.sh build
	@$(MAKE) --no-print-directory $(if $(filter file,$(origin KERNELS)),KERNELS=native FLOAT=) demo-run

demo-run: $(BUILD)/glint
	@mkdir -p $(BUILD)/demo
	$(BUILD)/glint scripts/moving_light.lua -o '$(BUILD)/demo/moving_light_%04d.png'
	@echo
	@echo "120 frames: $(abspath $(BUILD)/demo)/moving_light_0001.png ... moving_light_0120.png"
	@echo "Look at one with any viewer, or at all of them as a film:"
	@echo "  ffmpeg -framerate 24 -i $(BUILD)/demo/moving_light_%04d.png -pix_fmt yuv420p $(BUILD)/demo/moving_light.mp4"
	@echo "Try:  $(BUILD)/glint scripts/moving_light.lua --help"
	$(if $(FLOAT),,@echo "This build is slow with --precision float. make builds everything.")

# The Lua modules: gr.lua is `require "gr"`, glint/xyz.lua is `require "glint.xyz"`.
LUA_LIBRARY := $(patsubst scripts/lib/%,%,$(sort $(wildcard scripts/lib/*.lua scripts/lib/*/*.lua)))

# The pages by topic, and the examples with their data. Links between pages use their installed names; links to pages
# that only the sources have become plain text. Commands name the installed examples.
docdir   := $(datadir)/doc/glint
examples := $(datadir)/glint/examples
PAGES    := README.md:README.md learn.md:bindings/docs/learn.md how-to.md:bindings/docs/how-to.md explain.md:bindings/docs/explain.md \
            lua-and-command.md:bindings/README.md engine.md:engine/README.md renderer.md:engine/render/README.md \
            examples.md:scripts/README.md farms.md:scripts/farm/README.md python.md:scripts/python.md particles.md:scripts/particles.md CHANGELOG.md:.github/CHANGELOG.md
EXAMPLES := $(sort $(patsubst scripts/%,%,$(wildcard scripts/*.lua scripts/*.c scripts/data/* scripts/farm/*.sh)))
PICTURES := $(notdir $(wildcard bindings/docs/pictures/*.png))
page_to   = $(firstword $(subst :, ,$(1)))

$(BUILD)/doc/data.md: scripts/lib/page.awk $(wildcard scripts/lib/glint/*.lua)
	@mkdir -p $(@D)
	@awk -f $^ > $@

.PHONY: pages
pages: $(BUILD)/doc/data.md ## the installed manual by topic, in build/doc/
	@for page in $(PAGES); do \
	    case $$page in *:bindings/docs/*) shown= ;; *) shown='s|!\[[^]]*\]([^)]*)||g' ;; esac; \
	    sed -e 's|](\(\.\./\)*bindings/README\.md|](lua-and-command.md|g' -e 's|](\(\.\./\)*engine/README\.md|](engine.md|g' -e 's|](\(engine/\)*render/README\.md|](renderer.md|g' \
	        -e 's|](\(\.\./\)*\(bindings/\)*docs/\([a-z-]*\.md\)|](\3|g' -e 's|](\(\.\./\)*scripts/\([a-z]*\.md\)|](\2|g' \
	        -e 's|](\(\.\./\)*scripts/README\.md|](examples.md|g' -e 's|](\(\.\./\.\./scripts/\)*farm/README\.md|](farms.md|g' \
	        -e 's|](\.github/CHANGELOG\.md|](CHANGELOG.md|g' -e 's,](\([a-z_]*\.lua\)),](../../glint/examples/\1),g' \
	        -e 's,](\([a-z_]*\.c\)),](../../glint/examples/\1),g' -e 's,\([ "]\)scripts/\([a-z_]*\.lua\),\1$(examples)/\2,g' \
	        -e 's,\([ "]\)scripts/data/,\1$(examples)/data/,g' \
	        -e "$$shown" -e 's|\[\([^]]*\)\]([a-z./]*/[A-Z]*\.md)|\1|g' "$${page#*:}" > "$(BUILD)/doc/$${page%%:*}" || exit 1; done

include bindings/web/web.mk

# ---- Installation ----

# The installed files: mode, source, destination.
define INSTALLED
755 $(BUILD)/glint $(bindir)/glint
755 $(BUILD)/glint.so $(luadir)/glint.so
644 $(BUILD)/libglint.a $(libdir)/libglint.a
644 $(BUILD)/$(SHARED) $(libdir)/$(SHARED)
644 $(BUILD)/glint.pc $(libdir)/pkgconfig/glint.pc
$(foreach file,$(CMAKE_FILES),644 $(BUILD)/$(file) $(libdir)/cmake/glint/$(file)
)
$(foreach header,$(HEADERS),644 $(header) $(incdir)/$(notdir $(header))
)
644 $(BUILD)/glint.1 $(datadir)/man/man1/glint.1
644 $(BUILD)/meta/glint.lua $(datadir)/glint/glint.lua
644 $(BUILD)/completion/bash $(datadir)/bash-completion/completions/glint
644 $(BUILD)/completion/zsh $(datadir)/zsh/site-functions/_glint
644 $(BUILD)/completion/fish $(datadir)/fish/vendor_completions.d/glint.fish
$(foreach module,$(LUA_LIBRARY),644 scripts/lib/$(module) $(luasharedir)/$(module)
)
$(foreach page,$(PAGES) data.md,644 $(BUILD)/doc/$(call page_to,$(page)) $(docdir)/$(call page_to,$(page))
)
$(foreach picture,$(PICTURES),644 bindings/docs/pictures/$(picture) $(docdir)/pictures/$(picture)
)
$(foreach file,$(EXAMPLES),$(if $(filter %.sh,$(file)),755,644) scripts/$(file) $(examples)/$(file)
)
endef
export INSTALLED

# The installed tree can be moved: glint.pc finds the prefix relative to itself, if the libraries are below the prefix.
pc_prefix = $(if $(filter $(PREFIX)/%,$(libdir)),$${pcfiledir}/..$(shell echo '$(libdir:$(PREFIX)/%=/%)' | sed 's|/[^/]*|/..|g'),$(PREFIX))
$(BUILD)/glint.pc: engine/glint.pc.in FORCE
	@sed -e 's|@prefix@|$(pc_prefix)|' -e 's|@libdir@|$(libdir:$(PREFIX)/%=$${prefix}/%)|' \
	    -e 's|@includedir@|$(incdir:$(PREFIX)/%=$${prefix}/%)|' \
	    -e 's|@version@|$(VERSION)|' -e 's|@requires@|$(PACKAGES) $(if $(FONT_LIBS),freetype2) $(if $(CAIRO_LIBS),cairo-ft cairo-pdf fontconfig) $(if $(JPEG_LIBS),libjpeg)|' -e 's|@private@|$(EXR_LIBS)|' $< > $@

# The same for CMake, whose package lies two folders deeper.
CMAKE_FILES := glint-config.cmake glint-config-version.cmake
cmake_prefix = $(if $(filter $(PREFIX)/%,$(libdir)),$${CMAKE_CURRENT_LIST_DIR}/../..$(shell echo '$(libdir:$(PREFIX)/%=/%)' | sed 's|/[^/]*|/..|g'),$(PREFIX))
$(addprefix $(BUILD)/,$(CMAKE_FILES)): $(BUILD)/%: engine/%.in FORCE
	@sed -e 's|@cmake_prefix@|$(cmake_prefix)|' -e 's|@cmake_libdir@|$(libdir:$(PREFIX)/%=$${glint_prefix}/%)|' \
	    -e 's|@cmake_incdir@|$(incdir:$(PREFIX)/%=$${glint_prefix}/%)|' -e 's|@version@|$(VERSION)|' -e 's|@shared@|$(SHARED)|' \
	    -e 's|@soname@|$(SONAME)|' -e 's|@abi_pattern@|$(subst .,[.],$(ABI))[.]|' $< > $@

$(BUILD)/completion/%: $(BUILD)/glint
	@mkdir -p $(@D)
	@$(BUILD)/glint completion $* > $@

# Debug information is nine tenths of the command and the archive. STRIP=: keeps it.
STRIP ?= strip
# put MODE FROM TO; uses only options of install(1) that all systems have.
PUT   := put() { echo "  INSTALL	$$3"; mkdir -p "$$(dirname "$$3")" && install -m "$$1" "$$2" "$$3"; }
LINKS  = $(SONAME) $(call shared_name,)
install: all shared pages $(BUILD)/glint.pc $(addprefix $(BUILD)/,$(CMAKE_FILES)) $(FILLED) $(addprefix $(BUILD)/completion/,bash zsh fish) ## PREFIX=/usr/local, DESTDIR=
	@$(PUT); printf '%s\n' "$$INSTALLED" | while read -r mode from to; do \
	    [ -n "$$mode" ] || continue; put "$$mode" "$$from" "$(DESTDIR)$$to" || exit 1; \
	    case $$to in *.a) $(STRIP) $(STRIP_DEBUG) "$(DESTDIR)$$to" ;; \
	    */bin/glint | *.so | *.so.* | *.dylib) $(STRIP) $(STRIP_LOCAL) "$(DESTDIR)$$to" ;; esac || exit 1; done
	@for link in $(LINKS); do ln -sf $(SHARED) "$(DESTDIR)$(libdir)/$$link" || exit 1; done

# Files that a release publishes, from the committed state: the source archive, whose bytes depend only on the commit,
# and the rock that contains it.
DIST := $(BUILD)/dist
ROCK := glint-$(VERSION)-1

.PHONY: dist
dist: ## build/dist: the archive of the sources, and with zip the rock that holds it
	@rm -rf $(DIST) && mkdir -p $(DIST)
	@git archive --format=tar --prefix=glint-$(VERSION)/ HEAD | gzip -9n > $(DIST)/glint-$(VERSION).tar.gz
	@cp bindings/$(ROCK).rockspec $(DIST)/
	@if command -v zip >/dev/null; then cd $(DIST) && zip -qX $(ROCK).src.rock $(ROCK).rockspec glint-$(VERSION).tar.gz; fi
	@ls $(DIST)/*

# For the rockspec: LuaRocks copies the files in its folders.
install-rock: all
	@$(PUT); put 755 $(BUILD)/glint $(bindir)/glint && put 755 $(BUILD)/glint.so $(luadir)/glint.so && \
	    for module in $(LUA_LIBRARY); do put 644 scripts/lib/$$module $(luasharedir)/$$module || exit 1; done

uninstall: ## removes what install has put there, with the same PREFIX and DESTDIR
	@printf '%s\n' "$$INSTALLED" | while read -r mode from to; do \
	    [ -z "$$mode" ] || { echo "  REMOVE	$(DESTDIR)$$to"; rm -f "$(DESTDIR)$$to" || exit 1; }; done
	@rm -f $(addprefix "$(DESTDIR)$(libdir)"/,$(LINKS))
	@for folder in $(examples)/data $(examples)/farm $(examples) $(datadir)/glint $(docdir)/pictures $(docdir) $(luasharedir)/glint $(luasharedir)/gr; do \
	    if [ -d "$(DESTDIR)$$folder" ]; then rmdir "$(DESTDIR)$$folder" || exit 1; fi; done

deps: ## installs what the build and the tests need, through apt
	@tests/deps.sh build test

clean: ## removes build/ and the folders of the checks, build-asan/, build-clang/ and so on
	rm -rf $(BUILD) build-asan build-tsan build-clang build-portable $(ARM64) $(MUSL) $(FUZZ) $(WEB_OBJECTS)

help: ## this list
	@awk -F':.*## ' '/^[a-z-]+:.*## /{printf "  %-14s %s\n", $$1, $$2}' $(filter Makefile %.mk,$(MAKEFILE_LIST))
