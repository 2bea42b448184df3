/// Tools for the tests of the stages: random numbers that include special values, and outputs between guard bytes
/// that are compared bit for bit. Every stage runs on every instruction set against the scalar reference.
#ifndef GLINT_STAGE_CASE_H
#define GLINT_STAGE_CASE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/glint.h"
#include "engine/render/stages/stages.h"
#include "tests/engine/cases/random.h"

#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])

// ---- Random numbers ----------------------------------------------------------------------------------------------

static inline double power_of_ten(double a, double b) { return pow(10, between(a, b)); }

static inline double either_sign(double x) { return one_in(2) ? x : -x; }

static inline double odd_number(void)
{
    static const double odd[] = { 0,         -0.0,       1,        -1,        NAN,     INFINITY, -INFINITY,
                                  0x1p-1074, -0x1p-1030, 0x1p-149, -0x1p-140, DBL_MIN, DBL_MAX,  -DBL_MAX,
                                  FLT_MIN,   FLT_MAX,    1e-30,    1e30,      -1e20,   1e-160,   1e160 };
    return odd[below(COUNT_OF(odd))];
}

/// Returns `x`, or in odd cases sometimes a special value.
static inline double maybe_odd(bool odd_case, double x) { return odd_case && one_in(12) ? odd_number() : x; }

/// A mask of lanes: all, none or some.
static inline uint16_t random_mask(void)
{
    uint32_t kind = below(8);
    return (uint16_t)(kind < 3 ? 0xffff : kind == 3 ? 0 : random_bits());
}

// ---- Arrays ------------------------------------------------------------------------------------------------------

enum { GUARD_BYTES = 128, MOST_ARRAYS = 400 };
typedef enum array_kind { KIND_U16, KIND_U32, KIND_FLOAT, KIND_DOUBLE } array_kind;

typedef struct test_array {
    const char *name;
    array_kind kind;
    uint32_t count;
    unsigned char *bytes; ///< guard, elements, guard
} test_array;

/// Arrays of the current case: inputs of the stage, outputs of the reference, outputs of the other instruction set.
static test_array inputs[MOST_ARRAYS], wanted[MOST_ARRAYS], gotten[MOST_ARRAYS];
static uint32_t input_count, wanted_count, gotten_count;

static inline size_t element_size(array_kind kind) { return kind == KIND_U16 ? 2 : kind == KIND_DOUBLE ? 8 : 4; }

static inline size_t array_bytes(const test_array *a) { return element_size(a->kind) * a->count + 2 * GUARD_BYTES; }

/// Returns the first element: 64-byte aligned, like the arrays of a tile.
static inline void *array_elements(const test_array *a) { return a->bytes + GUARD_BYTES; }

static inline void *new_array(test_array *list, uint32_t *list_count, const char *name, array_kind kind, uint32_t count)
{
    if (*list_count == MOST_ARRAYS)
        abort();
    test_array *a = &list[(*list_count)++];
    *a = (test_array) { name, kind, count, NULL };
    a->bytes = aligned_alloc(64, (array_bytes(a) + 63) / 64 * 64);
    if (!a->bytes)
        abort();
    memset(a->bytes, 0xa5, array_bytes(a));
    return array_elements(a);
}

static inline void free_arrays(test_array *list, uint32_t *list_count)
{
    while (*list_count)
        free(list[--*list_count].bytes);
}

static inline void *input(array_kind kind, uint32_t count) { return new_array(inputs, &input_count, "", kind, count); }

static inline array_kind real_kind(int precision) { return precision == GLINT_PRECISION_DOUBLE ? KIND_DOUBLE : KIND_FLOAT; }

static inline void input3(const void *array[3], array_kind kind, uint32_t count)
{
    for (int c = 0; c < 3; c++)
        array[c] = input(kind, count);
}

static inline void put(const void *array, int precision, uint32_t i, double x)
{
    if (precision == GLINT_PRECISION_DOUBLE)
        ((double *)(uintptr_t)array)[i] = x;
    else
        ((float *)(uintptr_t)array)[i] = (float)x;
}

static inline void put3(const void *const array[3], int precision, uint32_t i, const double v[3])
{
    for (int c = 0; c < 3; c++)
        put(array[c], precision, i, v[c]);
}

static inline double get(const void *array, int precision, uint32_t i)
{
    return precision == GLINT_PRECISION_DOUBLE ? ((const double *)array)[i] : (double)((const float *)array)[i];
}

// ---- Every instruction set in turn -------------------------------------------------------------------------------

static const glint_stages *tested[8]; ///< the reference, followed by all other instruction sets that this machine can
    ///< run
static uint32_t tested_count;
static const glint_stages *running; ///< the instruction set that runs now; new_output allocates for its outputs
static uint32_t mismatches;
static uint64_t case_seed;

static inline void find_tested(void)
{
    tested[tested_count++] = &glint_stages_ref;
    for (const glint_stages *const *isa = glint_stages_built; *isa; isa++) {
        if (*isa == &glint_stages_ref)
            continue;
        if (glint_stages_usable(*isa))
            tested[tested_count++] = *isa;
    }
}

/// Prints, at the end of a run, the instruction sets that could not be tested, so that no gap goes unnoticed.
static inline void print_skipped(void)
{
    for (const glint_stages *const *isa = glint_stages_built; *isa; isa++)
        if (!glint_stages_usable(*isa))
            printf("skipped: %s\n", (*isa)->name);
}

static inline void *output(const char *name, array_kind kind, uint32_t count)
{
    return running == &glint_stages_ref ? new_array(wanted, &wanted_count, name, kind, count)
                                        : new_array(gotten, &gotten_count, name, kind, count);
}

static inline void output3(void *array[3], const char *name, array_kind kind, uint32_t count)
{
    for (int c = 0; c < 3; c++)
        array[c] = output(name, kind, count);
}

/// Returns whether two elements have the same bits. All NaNs count as equal: the payload depends on the order of
/// operands that the compiler chose.
static inline bool same_element(const test_array *a, const test_array *b, uint32_t i)
{
    size_t size = element_size(a->kind);
    const void *x = (unsigned char *)array_elements(a) + size * i;
    const void *y = (unsigned char *)array_elements(b) + size * i;
    if (memcmp(x, y, size) == 0)
        return true;
    if (a->kind == KIND_FLOAT)
        return isnan(*(const float *)x) && isnan(*(const float *)y);
    return a->kind == KIND_DOUBLE && isnan(*(const double *)x) && isnan(*(const double *)y);
}

static inline void report_element(const test_array *want, const test_array *got, uint32_t i)
{
    if (want->kind == KIND_FLOAT || want->kind == KIND_DOUBLE) {
        int precision = want->kind == KIND_DOUBLE ? GLINT_PRECISION_DOUBLE : GLINT_PRECISION_FLOAT;
        printf("%a, wanted %a\n", get(array_elements(got), precision, i), get(array_elements(want), precision, i));
    } else if (want->kind == KIND_U32) {
        printf("%x, wanted %x\n", ((uint32_t *)array_elements(got))[i], ((uint32_t *)array_elements(want))[i]);
    } else {
        printf("%x, wanted %x\n", ((uint16_t *)array_elements(got))[i], ((uint16_t *)array_elements(want))[i]);
    }
}

static inline void compare_array(const char *stage, const test_array *want, const test_array *got)
{
    size_t end = GUARD_BYTES + element_size(want->kind) * want->count;
    if (memcmp(want->bytes, got->bytes, array_bytes(want)) == 0)
        return;
    if (memcmp(want->bytes, got->bytes, GUARD_BYTES) || memcmp(want->bytes + end, got->bytes + end, GUARD_BYTES)) {
        mismatches++;
        printf("%s %s, seed %llu: wrote outside `%s`\n", stage, running->name, (unsigned long long)case_seed,
               want->name);
    }
    for (uint32_t i = 0; i < want->count; i++) {
        if (same_element(want, got, i) || ++mismatches > 20)
            continue;
        printf("%s %s, seed %llu: %s[%u] = ", stage, running->name, (unsigned long long)case_seed, want->name, i);
        report_element(want, got, i);
    }
}

/// Compares the outputs of `running` with the outputs of the reference, which must have run first.
static inline void compare_outputs(const char *stage)
{
    for (uint32_t k = 0; k < gotten_count; k++)
        compare_array(stage, &wanted[k], &gotten[k]);
    free_arrays(gotten, &gotten_count);
}

static inline void end_case(void)
{
    free_arrays(inputs, &input_count);
    free_arrays(wanted, &wanted_count);
    free_arrays(gotten, &gotten_count);
}

#define FOR_EACH_TESTED for (uint32_t isa_ = 0; isa_ < tested_count && (running = tested[isa_]); isa_++)

/// Returns the reference's output called `name` in the current case; NULL when the stage has no such output.
static inline const test_array *wanted_array(const char *name)
{
    for (uint32_t k = 0; k < wanted_count; k++)
        if (strcmp(wanted[k].name, name) == 0)
            return &wanted[k];
    return NULL;
}

static inline void run_cases(uint32_t cases, uint64_t seed, void (*one)(int precision, bool odd))
{
    mismatches = 0;
    end_case(); // clears what a failed test left behind
    for (uint32_t i = 0; i < cases; i += case_step()) {
        random_state = case_seed = seed + i;
        one(i & 1 ? GLINT_PRECISION_FLOAT : GLINT_PRECISION_DOUBLE, i % 3 == 2);
        end_case();
    }
    assert_int_equal(mismatches, 0);
}

static inline uint16_t *masks(uint32_t groups)
{
    uint16_t *mask = input(KIND_U16, groups);
    for (uint32_t g = 0; g < groups; g++)
        mask[g] = random_mask();
    return mask;
}

static inline bool lane_of(const uint16_t *mask, uint32_t i) { return mask[i / GLINT_GROUP] >> i % GLINT_GROUP & 1; }

static inline const struct glint_geometry_stages *geometry(int precision) { return &running->geometry[precision]; }

// ---- Vectors -----------------------------------------------------------------------------------------------------

static inline double dot3(const double a[3], const double b[3]) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }

static inline double length3(const double a[3]) { return hypot(hypot(a[0], a[1]), a[2]); }

static inline void cross3(const double a[3], const double b[3], double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

/// out = from + k towards.
static inline void along3(const double from[3], double k, const double towards[3], double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = from[c] + k * towards[c];
}

static inline void random_unit(double v[3])
{
    double length;
    do {
        for (int c = 0; c < 3; c++)
            v[c] = between(-1, 1);
        length = length3(v);
    } while (length > 1 || length < 0.01);
    for (int c = 0; c < 3; c++)
        v[c] /= length;
}

/// Sets `out` to a random unit vector perpendicular to `v`.
static inline void random_across(const double v[3], double out[3])
{
    double any[3], length;
    do {
        random_unit(any);
        cross3(v, any, out);
        length = length3(out);
    } while (!(length > 1e-3 * length3(v)));
    for (int c = 0; c < 3; c++)
        out[c] /= length;
}

#endif
