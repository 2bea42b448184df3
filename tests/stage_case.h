/// What the tests of the stages are made of: random numbers with odd ones among them, outputs between guard bytes that
/// are compared bit for bit, and scenes whose tables keep the promises of stages.h.
#ifndef GLINT_STAGE_CASE_H
#define GLINT_STAGE_CASE_H

#include "engine/glint.h"
#include "engine/stages/stages.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])

// ---- Random numbers ----------------------------------------------------------------------------------------------

static uint64_t random_state;

static uint64_t random_bits(void)
{
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static uint32_t below(uint32_t n)
{
    return (uint32_t)((random_bits() >> 32) * n >> 32);
}

static bool one_in(uint32_t n)
{
    return below(n) == 0;
}

static double between(double a, double b)
{
    return a + (b - a) * ((double)(random_bits() >> 11) * 0x1p-53);
}

static double power_of_ten(double a, double b)
{
    return pow(10, between(a, b));
}

static double either_sign(double x)
{
    return one_in(2) ? x : -x;
}

static double odd_number(void)
{
    static const double odd[] = {0,         -0.0,       1,        -1,        NAN,     INFINITY, -INFINITY,
                                 0x1p-1074, -0x1p-1030, 0x1p-149, -0x1p-140, DBL_MIN, DBL_MAX,  -DBL_MAX,
                                 FLT_MIN,   FLT_MAX,    1e-30,    1e30,      -1e20,   1e-160,   1e160};
    return odd[below(COUNT_OF(odd))];
}

/// `x`, or where the case is an odd one, now and then something nobody expects.
static double maybe_odd(bool odd_case, double x)
{
    return odd_case && one_in(12) ? odd_number() : x;
}

/// A mask of lanes: all, none, or some of them.
static uint16_t random_mask(void)
{
    uint32_t kind = below(8);
    return (uint16_t)(kind < 3 ? 0xffff : kind == 3 ? 0 : random_bits());
}

// ---- Arrays ------------------------------------------------------------------------------------------------------

enum { GUARD_BYTES = 128, MOST_ARRAYS = 160 };
typedef enum array_kind { KIND_U16, KIND_U32, KIND_FLOAT, KIND_DOUBLE } array_kind;

typedef struct test_array {
    const char *name;
    array_kind kind;
    uint32_t count;
    unsigned char *bytes; ///< guard, elements, guard
} test_array;

/// Arrays of the case at hand: what the stage reads, what the reference wrote, what the other instruction set wrote.
static test_array inputs[MOST_ARRAYS], wanted[MOST_ARRAYS], gotten[MOST_ARRAYS];
static uint32_t input_count, wanted_count, gotten_count;

static size_t element_size(array_kind kind)
{
    return kind == KIND_U16 ? 2 : kind == KIND_DOUBLE ? 8 : 4;
}

static size_t array_bytes(const test_array *a)
{
    return element_size(a->kind) * a->count + 2 * GUARD_BYTES;
}

/// Where the elements start: 64-byte aligned, as a tile's arrays are.
static void *array_elements(const test_array *a)
{
    return a->bytes + GUARD_BYTES;
}

static void *new_array(test_array *list, uint32_t *list_count, const char *name, array_kind kind, uint32_t count)
{
    if (*list_count == MOST_ARRAYS)
        abort();
    test_array *a = &list[(*list_count)++];
    *a = (test_array){name, kind, count, NULL};
    a->bytes = aligned_alloc(64, (array_bytes(a) + 63) / 64 * 64);
    if (!a->bytes)
        abort();
    memset(a->bytes, 0xa5, array_bytes(a));
    return array_elements(a);
}

static void free_arrays(test_array *list, uint32_t *list_count)
{
    while (*list_count)
        free(list[--*list_count].bytes);
}

static void *input(array_kind kind, uint32_t count)
{
    return new_array(inputs, &input_count, "", kind, count);
}

static array_kind real_kind(int precision)
{
    return precision == GLINT_DOUBLE ? KIND_DOUBLE : KIND_FLOAT;
}

static void input3(const void *array[3], array_kind kind, uint32_t count)
{
    for (int c = 0; c < 3; c++)
        array[c] = input(kind, count);
}

static void put(const void *array, int precision, uint32_t i, double x)
{
    if (precision == GLINT_DOUBLE)
        ((double *)(uintptr_t)array)[i] = x;
    else
        ((float *)(uintptr_t)array)[i] = (float)x;
}

static void put3(const void *const array[3], int precision, uint32_t i, const double v[3])
{
    for (int c = 0; c < 3; c++)
        put(array[c], precision, i, v[c]);
}

static double get(const void *array, int precision, uint32_t i)
{
    return precision == GLINT_DOUBLE ? ((const double *)array)[i] : (double)((const float *)array)[i];
}

// ---- Every instruction set in turn -------------------------------------------------------------------------------

static const glint_stages *tested[8]; ///< the reference, then every other that this machine can run
static uint32_t tested_count;
static const glint_stages *running; ///< whose outputs new_output makes
static uint32_t mismatches;
static uint64_t case_seed;

static void find_tested(void)
{
    tested[tested_count++] = &glint_stages_ref;
    for (const glint_stages *const *isa = glint_stages_built; *isa; isa++) {
        if (*isa == &glint_stages_ref)
            continue;
        if (glint_stages_usable(*isa))
            tested[tested_count++] = *isa;
    }
}

/// The last lines of a run: what it could not test, so that it is never silent.
static void print_skipped(void)
{
    for (const glint_stages *const *isa = glint_stages_built; *isa; isa++)
        if (!glint_stages_usable(*isa))
            printf("skipped: %s\n", (*isa)->name);
}

static void *output(const char *name, array_kind kind, uint32_t count)
{
    return running == &glint_stages_ref ? new_array(wanted, &wanted_count, name, kind, count)
                                        : new_array(gotten, &gotten_count, name, kind, count);
}

static void output3(void *array[3], const char *name, array_kind kind, uint32_t count)
{
    for (int c = 0; c < 3; c++)
        array[c] = output(name, kind, count);
}

/// The same bits; for numbers, any NaN is as good as another: which one comes out depends on the order of operands
/// that the compiler chose.
static bool same_element(const test_array *a, const test_array *b, uint32_t i)
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

static void report_element(const test_array *want, const test_array *got, uint32_t i)
{
    if (want->kind == KIND_FLOAT || want->kind == KIND_DOUBLE) {
        int precision = want->kind == KIND_DOUBLE ? GLINT_DOUBLE : GLINT_FLOAT;
        printf("%a, wanted %a\n", get(array_elements(got), precision, i), get(array_elements(want), precision, i));
    } else if (want->kind == KIND_U32) {
        printf("%x, wanted %x\n", ((uint32_t *)array_elements(got))[i], ((uint32_t *)array_elements(want))[i]);
    } else {
        printf("%x, wanted %x\n", ((uint16_t *)array_elements(got))[i], ((uint16_t *)array_elements(want))[i]);
    }
}

static void compare_array(const char *stage, const test_array *want, const test_array *got)
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

/// After a stage ran on `running`: compares its outputs with the reference's, which ran first.
static void compare_outputs(const char *stage)
{
    for (uint32_t k = 0; k < gotten_count; k++)
        compare_array(stage, &wanted[k], &gotten[k]);
    free_arrays(gotten, &gotten_count);
}

static void end_case(void)
{
    free_arrays(inputs, &input_count);
    free_arrays(wanted, &wanted_count);
    free_arrays(gotten, &gotten_count);
}

#define FOR_EACH_TESTED for (uint32_t isa_ = 0; isa_ < tested_count && (running = tested[isa_]); isa_++)

// ---- Scenes ------------------------------------------------------------------------------------------------------

enum { MOST_PRIMS = 24 };

typedef struct test_scene {
    uint32_t prim_count, candidate_count;
    glint_prim prims[MOST_PRIMS];
    glint_bundle_prim bundle[MOST_PRIMS];
    uint32_t candidates[MOST_PRIMS];
    double origin[3]; ///< of the bundle
    double reference[3], filter_scale;
} test_scene;

static double dot3(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

static double length3(const double a[3])
{
    return hypot(hypot(a[0], a[1]), a[2]);
}

static void random_unit(double v[3])
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

static float rounded_up(double x)
{
    float rounded = (float)x;
    return (double)rounded < x ? nextafterf(rounded, INFINITY) : rounded;
}

static void set_sphere(glint_prim *prim, const double center[3], double radius)
{
    *prim = (glint_prim){.kind = GLINT_PRIM_SPHERE, .radius = radius, .scale = ldexp(1, -ilogb(radius))};
    memcpy(prim->center, center, sizeof prim->center);
    double r = radius * prim->scale;
    prim->r2 = r * r;
    prim->r2_low = fma(r, r, -prim->r2);
}

static void set_plane(glint_prim *prim, const double point[3], const double normal[3])
{
    *prim = (glint_prim){.kind = GLINT_PRIM_PLANE};
    memcpy(prim->center, point, sizeof prim->center);
    memcpy(prim->normal, normal, sizeof prim->normal);
}

static bool same_geometry(const glint_prim *a, const glint_prim *b)
{
    return a->kind == b->kind && memcmp(a->center, b->center, sizeof a->center) == 0 &&
           memcmp(a->normal, b->normal, sizeof a->normal) == 0 && memcmp(&a->radius, &b->radius, sizeof a->radius) == 0;
}

static double two_sum_error(double a, double b)
{
    double s = a + b, v = s - a;
    return (a - (s - v)) + (b - v);
}

/// |f|^2 - (radius scale)^2 with one rounding, but for the last bit of its error terms.
static double sphere_c(const double f[3], const glint_prim *prim)
{
    double x = f[0] * f[0] + f[1] * f[1], y = x + f[2] * f[2], z = y - prim->r2;
    double low = two_sum_error(f[0] * f[0], f[1] * f[1]) + two_sum_error(x, f[2] * f[2]) + two_sum_error(y, -prim->r2);
    for (int c = 0; c < 3; c++)
        low += fma(f[c], f[c], -(f[c] * f[c]));
    return z + (low - prim->r2_low);
}

static void set_bundle_prim(glint_bundle_prim *seen, const glint_prim *prim, const double origin[3])
{
    double from[3];
    for (int c = 0; c < 3; c++)
        from[c] = origin[c] - prim->center[c];
    *seen = (glint_bundle_prim){.filter_limit2 = INFINITY};
    if (prim->kind == GLINT_PRIM_PLANE) {
        seen->c = dot3(prim->normal, from);
        return;
    }
    for (int c = 0; c < 3; c++) {
        seen->f[c] = from[c] * prim->scale;
        seen->filter_f[c] = (float)seen->f[c];
    }
    seen->c = sphere_c(seen->f, prim);
    double limit = prim->radius * prim->scale * (1 + 1e-6) + 8 * 0x1p-24 * length3(seen->f);
    seen->filter_limit2 = rounded_up(limit * limit * (1 + 1e-15));
}

/// Fills what follows from the primitives' geometry and the origin; all are candidates, in random order.
static void finish_scene(test_scene *scene)
{
    double extent = DBL_MIN;
    for (uint32_t i = 0; i < scene->prim_count; i++)
        for (int c = 0; c < 3; c++)
            extent = fmax(extent, fabs(scene->prims[i].center[c] - scene->reference[c]) + scene->prims[i].radius);
    scene->filter_scale = ldexp(1, -ilogb(extent));
    for (uint32_t i = 0; i < scene->prim_count; i++) {
        glint_prim *prim = &scene->prims[i];
        for (prim->coincident = 0; !same_geometry(prim, &scene->prims[prim->coincident]);)
            prim->coincident++;
        prim->material = below(4);
        prim->two_sided = below(2);
        double center[3];
        for (int c = 0; c < 3; c++) {
            center[c] = (prim->center[c] - scene->reference[c]) * scene->filter_scale;
            prim->filter_center[c] = (float)center[c];
        }
        double bound = prim->radius * scene->filter_scale * (1 + 1e-6) + 8 * 0x1p-24 * length3(center);
        prim->filter_bound = prim->kind == GLINT_PRIM_PLANE ? INFINITY : rounded_up(bound * (1 + 1e-15));
        set_bundle_prim(&scene->bundle[i], prim, scene->origin);

        uint32_t at = below(i + 1);
        scene->candidates[i] = scene->candidates[at];
        scene->candidates[at] = i;
    }
    scene->candidate_count = scene->prim_count;
}

static void random_prim(test_scene *scene, glint_prim *prim, double size, double offset)
{
    double center[3], normal[3];
    for (int c = 0; c < 3; c++)
        center[c] = scene->reference[c] + size * between(-1, 1);
    random_unit(normal);
    if (one_in(4)) { // the axes and their ties
        memset(normal, 0, sizeof normal);
        normal[below(3)] = either_sign(1);
    }
    if (prim > scene->prims && one_in(4))
        *prim = scene->prims[below((uint32_t)(prim - scene->prims))];
    else if (one_in(5))
        set_plane(prim, center, normal);
    else
        set_sphere(prim, center, size * power_of_ten(-offset, offset < 2 ? 0 : offset));
}

/// A random scene whose radii differ from its size by up to `spread` powers of ten, some of it coincident, and an
/// origin that may lie inside a sphere, on it or just off it.
static void random_scene(test_scene *scene, double size, double offset, double spread)
{
    *scene = (test_scene){.prim_count = 1 + below(MOST_PRIMS)};
    for (int c = 0; c < 3; c++)
        scene->reference[c] = either_sign(offset) * between(0.5, 1);
    for (uint32_t i = 0; i < scene->prim_count; i++)
        random_prim(scene, &scene->prims[i], size, spread);
    double away[3], distance = size * power_of_ten(-1, 1);
    random_unit(away);
    const glint_prim *near = &scene->prims[below(scene->prim_count)];
    bool at_prim = one_in(3) && near->kind == GLINT_PRIM_SPHERE;
    if (at_prim)
        distance = near->radius * (one_in(3) ? between(0, 1) : one_in(2) ? 1 : 1 + either_sign(power_of_ten(-16, -1)));
    for (int c = 0; c < 3; c++)
        scene->origin[c] = (at_prim ? near->center[c] : scene->reference[c]) + distance * away[c];
    finish_scene(scene);
}

/// A direction from `origin` towards some candidate: well inside its outline, or within 1e-1 .. 1e-16 of tangency.
static void aim(const test_scene *scene, const double origin[3], double direction[3])
{
    const glint_prim *prim = &scene->prims[scene->candidates[below(scene->candidate_count)]];
    double to[3], side[3], random[3];
    random_unit(random);
    memcpy(direction, random, sizeof random);
    for (int c = 0; c < 3; c++)
        to[c] = prim->center[c] - origin[c];
    double distance = length3(to);
    if (prim->kind == GLINT_PRIM_PLANE || !(distance > prim->radius) || one_in(8))
        return;
    for (int c = 0; c < 3; c++)
        side[c] = to[(c + 1) % 3] * random[(c + 2) % 3] - to[(c + 2) % 3] * random[(c + 1) % 3];
    double sine = prim->radius / distance, edge = distance * sine / sqrt((1 - sine) * (1 + sine));
    edge *= one_in(3) ? between(0, 1) : 1 + either_sign(power_of_ten(-16, -1));
    double width = edge / length3(side), length = power_of_ten(-1, 1) / distance;
    for (int c = 0; c < 3; c++)
        direction[c] = (to[c] + side[c] * width) * length;
}

#endif
