# make bench; included by the Makefile.

BENCH_H := $(wildcard tests/bench/*.h)
bench_c  = $(addprefix tests/bench/,$(addsuffix .c,$(1)))
# The comparators are not part of the engine: they may use any flags for speed.
FAST    := -I. -std=c11 -D_GNU_SOURCE $(WARN) -O3 -march=native -ffast-math -ffp-contract=fast -pthread
# Evaluated when the bench is made: whether this machine can run AVX-512 (NATIVE), and whether Embree is installed.
EMBREE   = $(shell echo '\#include <embree3/rtcore.h>' | $(CC) -E - >/dev/null 2>&1 && echo embree)
PACKETS  = $(if $(and $(findstring __AVX512BW__,$(NATIVE)),$(findstring __AVX512DQ__,$(NATIVE))),hand $(EMBREE))

$(BUILD)/tests/bench/glint_side: $(call bench_c,glint_main glint_scene glint_frame glint_job glint_program options scenes)
$(BUILD)/tests/bench/hand:       $(call bench_c,hand hand_program packet picture options scenes)
$(BUILD)/tests/bench/embree:     $(call bench_c,embree packet picture options scenes)
$(BUILD)/tests/bench/peers:      $(call bench_c,peers options scenes)
$(BUILD)/tests/bench/plain:      $(call bench_c,plain options scenes)
$(BUILD)/tests/bench/embree_lone: $(call bench_c,embree_lone options scenes)

$(BUILD)/tests/bench/glint_side: $(BENCH_H) $(BUILD)/libglint.a $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(COMPILE) $(filter %.c,$^) $(LINK) $(BUILD)/libglint.a $(LIBS) -o $@

$(addprefix $(BUILD)/tests/bench/,hand embree peers plain embree_lone): $(BENCH_H)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(FAST) $(filter %.c,$^) -Wl,--as-needed $(if $(filter %/embree %/embree_lone,$@),-lembree3) -lpng -lz -lm -o $@

.PHONY: bench-run bench-programs
bench: ## glint beside a hand-written program, Embree, POV-Ray and Tachyon: one table; BENCH=frame,jobs picks parts, readme the README's table, RUNS=7
	@tests/deps.sh build bench
	@$(MAKE) --no-print-directory bench-run

bench-programs: $(PROGRAMS)
	@:

bench-run: all
	@$(MAKE) --no-print-directory bench-programs PROGRAMS='$(addprefix $(BUILD)/tests/bench/,glint_side peers plain $(if $(EMBREE),embree_lone) $(PACKETS))'
	@$(LUA) tests/bench/bench.lua $(BUILD) '$(CC) $(shell $(CC) -dumpfullversion 2>/dev/null), $(filter-out $(UNWANTED),$(CFLAGS))' \
	    '$(BENCH)' '$(RUNS)'

EFFECT_PARTS  = $(shell $(LUA) tests/effects/table.lua parts)

.PHONY: bench-effects bench-effects-run
bench-effects: ## each effect's cost to a scene that does not call for it: rays, calls, instructions beside a build without it
	@tests/deps.sh build test
	@$(MAKE) --no-print-directory bench-effects-run

bench-effects-run: all
	@$(MAKE) --no-print-directory $(EFFECT_PARTS:%=$(BUILD)/without/%/glint)
	@$(LUA) tests/effects/table.lua bench $(BUILD)

.PHONY: check-without
check-without: ## a build without programs: patterns are errors with their line, all else is the same picture
	@$(MAKE) --no-print-directory all
	@$(MAKE) --no-print-directory $(BUILD)/without/PROGRAM/glint
	@$(RUNNER) tests/command/without.sh

# The bindings do not depend on the parts that the engine omits.
$(BUILD)/without/%/glint: $(BINDINGS_OBJ) $(BUILD)/libglint.a
	@$(MAKE) --no-print-directory -s BUILD=$(@D) WITHOUT=$* $(@D)/libglint.a
	$(call say,LINK)
	$(Q)$(CC) $(LINK) $(LINK_COMMAND) $(BINDINGS_OBJ) $(@D)/libglint.a $(LUA_LIBS) $(LIBS) $(COMMAND_LIBS) $(LIB_DL) -o $@
