/// The tone stage on every instruction set against the scalar reference: for any table and any lanes, and, with its
/// estimate, for every float that has a pixel value.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/film/tone.h"
#include "engine/render/stages/stages.h"
#include "tests/engine/cases/random.h"

#define ALIGNED _Alignas(64)
#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])

enum { ENTRIES = 0x3f80 - GLINT_TONE_FIRST + 1 }; // entries for values up to 1
enum { CASES = 600, TONE_BYTES = 3 * GLINT_TILE_SAMPLES, STRIDE_MOST = 3 * GLINT_TILE_WIDTH + 10 };

// ---- Random numbers ----

static float odd_number(void)
{
    static const float odd[] = { 0,       -0.0f,    1,       -1,       NAN,       -NAN,       INFINITY,  -INFINITY,
                                 FLT_MIN, -FLT_MIN, FLT_MAX, -FLT_MAX, 0x1p-149f, -0x1p-149f, 1.0000001f };
    return odd[below(COUNT_OF(odd))];
}

static uint16_t random_mask(void)
{
    uint32_t kind = below(8);
    return (uint16_t)(kind < 4 ? 0xffff : kind == 4 ? 0 : below(65536));
}

// ---- Instruction sets ----

static bool runs_here(const glint_stages *stages) { return stages != &glint_stages_ref && glint_stages_usable(stages); }

#define FOR_EACH_OTHER(stages) \
    for (const glint_stages *const *stages = glint_stages_built; *stages; stages++) \
        if (runs_here(*stages))

// ---- Cases ----

/// Makes a table of pixel values with a threshold anywhere in a bucket, at its ends, or nowhere.
static void make_tone_table(uint32_t table[ENTRIES])
{
    uint32_t code = 0;
    for (uint32_t i = 0; i < ENTRIES; i++) {
        bool step = code < 255 && one_in(7);
        uint32_t threshold = !step ? 65536 : one_in(4) ? 1 : one_in(3) ? 65535 : 1 + below(65535);
        table[i] = code | threshold << 8;
        code += step;
    }
}

static float tone_value(const uint32_t *table)
{
    uint32_t bucket = below(ENTRIES);
    uint32_t bits = ((GLINT_TONE_FIRST + bucket) << 16) + ((table[bucket] >> 8) + below(3) - 1) % 65536;
    float x;
    memcpy(&x, &bits, sizeof x);
    return one_in(8) ? odd_number() : one_in(3) ? (float)between(-0.1, 1.2) : x;
}

/// Returns a table: 0 .. 3 clamp, 4 .. 7 reinhard, 8 .. 11 filmic.
static const glint_tone_table *tone_of(int index)
{
    glint_tone_desc desc = { (glint_tone_curve)(index / 4), index & 1 ? GLINT_TRANSFER_LINEAR : GLINT_TRANSFER_SRGB,
                             index & 2 ? GLINT_ROUNDING_TRUNCATE : GLINT_ROUNDING_NEAREST, 8, 0, false };
    const glint_tone_table *table = NULL;
    assert_int_equal(glint_tone_table_shared(&desc, &table, NULL), GLINT_OK);
    return table;
}

typedef struct tone_case {
    ALIGNED float beauty[3][GLINT_TILE_SAMPLES];
    uint32_t table[ENTRIES];
    uint16_t active[GLINT_TILE_GROUPS];
    glint_tone_args args;
} tone_case;

/// The output of a call: the tile's pixels, with space around and between the rows, and the counts.
typedef struct tone_result {
    uint8_t codes[(GLINT_TILE_HEIGHT + 2) * STRIDE_MOST];
    uint64_t clipped, nonfinite;
} tone_result;

static void make_case(tone_case *c)
{
    uint32_t across = 1 + below(8), groups = across * (1 + below(6));
    bool tame = one_in(2), made_up = one_in(2);
    const glint_tone_table *real = tone_of((int)below(12));
    make_tone_table(c->table);
    c->args = (glint_tone_args) { .group_count = groups, .groups_across = across, .active = c->active };
    static const float gains[] = { 1, 0.7f, 2, 0x1p-32f, 0x1p32f };
    c->args.table = made_up ? c->table : real->lut;
    c->args.fit = made_up || !real->has_fit ? NULL : &real->fit;
    c->args.top = made_up ? 1 : real->top;
    c->args.white = made_up ? 1 : real->white;
    c->args.gain = gains[one_in(3) ? below(COUNT_OF(gains)) : 0];
    c->args.stride = 12 * across + below(11);
    for (uint32_t g = 0; g < groups; g++)
        c->active[g] = random_mask();
    for (int k = 0; k < 3; k++) {
        for (uint32_t i = 0; i < groups * GLINT_GROUP; i++)
            c->beauty[k][i] = tame        ? (float)between(0, 1)
                              : one_in(9) ? (float)between(0, 700)
                                          : tone_value(c->args.table);
        c->args.beauty[k] = c->beauty[k];
    }
}

static void run_case(const tone_case *c, const glint_stages *stages, tone_result *result)
{
    memset(result, 0xa5, sizeof *result); // the bytes of inactive lanes must stay unchanged
    result->clipped = 3;
    result->nonfinite = 4;
    glint_tone_args args = c->args;
    args.codes = result->codes + STRIDE_MOST;
    args.clipped = &result->clipped;
    args.nonfinite = &result->nonfinite;
    stages->tone(&args);
}

static void test_tone_cases(void **state)
{
    (void)state;
    static tone_case c;
    static tone_result want, got;
    for (uint32_t seed = 0; seed < CASES; seed += case_step()) {
        random_state = seed;
        make_case(&c);
        run_case(&c, &glint_stages_ref, &want);
        FOR_EACH_OTHER(isa)
        {
            run_case(&c, *isa, &got);
            if (memcmp(&want, &got, sizeof want))
                fail_msg("%s, seed %u: not what the reference wrote", (*isa)->name, seed);
        }
    }
}

/// The reference itself: it writes the active lanes at their positions, with the pixel values of the definition.
static void test_tone_reference(void **state)
{
    (void)state;
    static tone_case c;
    static tone_result got;
    for (uint32_t seed = 0; seed < CASES / 10; seed += case_step()) {
        random_state = seed;
        make_case(&c);
        const glint_tone_table *table = tone_of((int)(seed % 12));
        c.args.table = table->lut;
        c.args.top = table->top;
        c.args.white = table->white;
        c.args.gain = 1;
        run_case(&c, &glint_stages_ref, &got);
        for (size_t i = 0; i < sizeof got.codes; i++) {
            // before the first row, the index wraps to a large value
            size_t at = i - STRIDE_MOST, y = at / c.args.stride, x = at % c.args.stride / 3;
            size_t group = y / 4 * c.args.groups_across + x / 4, lane = y % 4 * 4 + x % 4;
            bool lit = x < 4 * c.args.groups_across && group < c.args.group_count && c.active[group] >> lane & 1;
            double want = lit ? glint_tone_value(&table->desc,
                                                 (double)c.beauty[at % c.args.stride % 3][group * GLINT_GROUP + lane])
                              : 0xa5;
            assert_int_equal(got.codes[i], (int)want);
        }
    }
}

// ---- Every float ----

/// Computes the pixel values of TONE_BYTES floats, in order, from the bits `bits` on with a step of `step`.
static void tone_floats(const glint_stages *stages, const glint_tone_table *table, uint32_t bits, uint32_t step,
                        uint8_t codes[TONE_BYTES])
{
    static ALIGNED float beauty[3][GLINT_TILE_SAMPLES];
    static ALIGNED uint16_t all[GLINT_TILE_GROUPS];
    uint64_t count[2] = { 0 };
    memset(all, 0xff, sizeof all);
    for (uint32_t i = 0; i < TONE_BYTES; i++, bits += step)
        memcpy(&beauty[i % 3][i / 3], &bits, sizeof bits);
    glint_tone_args args = { .group_count = GLINT_TILE_GROUPS,
                             .groups_across = 1,
                             .active = all,
                             .beauty = { beauty[0], beauty[1], beauty[2] },
                             .gain = 1,
                             .white = table->white,
                             .top = table->top,
                             .table = table->lut,
                             .fit = table->has_fit ? &table->fit : NULL,
                             .codes = codes,
                             .stride = 12,
                             .clipped = &count[0],
                             .nonfinite = &count[1] };
    stages->tone(&args);
}

/// The estimate must never be wrong: tests every float that has an sRGB pixel value, and one in seven for other tables.
static void test_tone_every_float(void **state)
{
    (void)state;
    static uint8_t want[TONE_BYTES], got[TONE_BYTES];
    for (int i = 0; i < 5; i++) {
        const uint32_t step = i == 0 ? 1 : i == 4 ? 40961 : 7; // the last table's floats go down to the smallest float
        const uint32_t first = i == 4 ? 0 : GLINT_TONE_FIRST << 16;
        for (uint64_t bits = first; bits <= 0x3f800001u; bits += (uint64_t)step * TONE_BYTES) {
            tone_floats(&glint_stages_ref, tone_of(i), (uint32_t)bits, step, want);
            FOR_EACH_OTHER(isa)
            {
                tone_floats(*isa, tone_of(i), (uint32_t)bits, step, got);
                if (memcmp(want, got, sizeof want))
                    fail_msg("%s, table %d: a code of the %d floats from %x on", (*isa)->name, i, TONE_BYTES,
                             (unsigned)bits);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tone_reference),
        cmocka_unit_test(test_tone_cases),
        cmocka_unit_test(test_tone_every_float),
    };
    glint_tone_store_open();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    glint_tone_store_close();
    for (const glint_stages *const *isa = glint_stages_built; *isa; isa++)
        if (!glint_stages_usable(*isa))
            printf("skipped: %s\n", (*isa)->name);
    return failed;
}
