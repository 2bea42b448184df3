/// Every stage on every instruction set against the scalar reference, bit for bit, in double and in float; that the
/// filter loses no hit; and how accurate the two elementary functions are.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/stage_case.h"

#define ALIGNED _Alignas(64)

enum { MOST_GROUPS = GLINT_TILE_GROUPS, CASES = 300, FILTER_CASES = 330 };

/// Worst errors in units of the last place of a float result, as sums of what can happen.
/// exp2: the last sum 0.5, the product before it 0.25, its factor 0.25, the terms before that 0.1, and the polynomial's
/// 2e-8 at most 0.34. log2, near a power of two from below: f rounded to float 1, the last sum of the polynomial 0.7,
/// the terms before it 0.2, the last product 0.5, the polynomial 0.34.
#define MAX_ULP_EXP2 1.5
#define MAX_ULP_LOG2 2.75

static void run_cases(uint32_t cases, uint64_t seed, void (*one)(int precision, bool odd))
{
    mismatches = 0;
    end_case(); // what a failed test left
    for (uint32_t i = 0; i < cases; i++) {
        random_state = case_seed = seed + i;
        one(i & 1 ? GLINT_FLOAT : GLINT_DOUBLE, i % 3 == 2);
        end_case();
    }
    assert_int_equal(mismatches, 0);
}

static uint16_t *masks(uint32_t groups)
{
    uint16_t *mask = input(KIND_U16, groups);
    for (uint32_t g = 0; g < groups; g++)
        mask[g] = random_mask();
    return mask;
}

static bool lane_of(const uint16_t *mask, uint32_t i)
{
    return mask[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
}

static const struct glint_geometry_stages *geometry(int precision)
{
    return &running->geometry[precision];
}

// ---- camera ------------------------------------------------------------------------------------------------------

static void camera_case(int precision, bool odd)
{
    uint32_t groups = 1 + below(MOST_GROUPS), n = groups * GLINT_GROUP;
    glint_camera_args args = {.group_count = groups, .groups_across = 1 + below(8), .orthographic = one_in(2)};
    args.x0 = GLINT_TILE_WIDTH * below(2000);
    args.y0 = GLINT_TILE_HEIGHT * below(2000);
    args.width = 1 + below(65535);
    args.height = 1 + below(65535);
    for (int c = 0; c < 3; c++) {
        if (c < 2)
            args.offset[c] = one_in(2) ? 0.5 : between(0, 1);
        args.eye[c] = maybe_odd(odd, either_sign(power_of_ten(-3, 6)));
        args.forward[c] = maybe_odd(odd, between(-1, 1));
        args.right[c] = maybe_odd(odd, between(-1e-2, 1e-2));
        args.up[c] = maybe_odd(odd, between(-1e-2, 1e-2));
    }
    FOR_EACH_TESTED
    {
        output3(args.origin, "origin", real_kind(precision), n);
        output3(args.direction, "direction", real_kind(precision), n);
        for (int c = 0; c < 3; c++)
            args.direction_f[c] = output("direction_f", KIND_FLOAT, n);
        geometry(precision)->camera(&args);
        compare_outputs("camera");
    }
}

static void test_camera(void **state)
{
    (void)state;
    run_cases(CASES, 1000, camera_case);
}

// ---- cast --------------------------------------------------------------------------------------------------------

/// Rays for a scene; those of cast_rays start around the bundle's origin, so some in, on and just off its sphere.
static void make_rays(const test_scene *scene, int precision, bool odd, glint_cast_args *args)
{
    uint32_t n = args->group_count * GLINT_GROUP;
    input3(args->origin, real_kind(precision), n);
    input3(args->direction, real_kind(precision), n);
    for (int c = 0; c < 3; c++)
        args->direction_f[c] = input(KIND_FLOAT, n);
    double origin[3], direction[3];
    double jitter = one_in(2) ? 0 : power_of_ten(-16, 0) / scene->filter_scale;
    for (uint32_t i = 0; i < n; i++) {
        for (int c = 0; c < 3; c++)
            origin[c] = scene->origin[c] + jitter * between(-1, 1);
        aim(scene, args->bundle ? scene->origin : origin, direction);
        for (int c = 0; c < 3; c++) {
            put(args->origin[c], precision, i, maybe_odd(odd, origin[c]));
            put(args->direction[c], precision, i, maybe_odd(odd, direction[c]));
            ((float *)(uintptr_t)args->direction_f[c])[i] = (float)get(args->direction[c], precision, i);
        }
    }
}

static void cast_all(int precision, glint_cast_args *args)
{
    uint32_t n = args->group_count * GLINT_GROUP;
    FOR_EACH_TESTED
    {
        args->t = output("t", real_kind(precision), n);
        args->prim = output("prim", KIND_U32, n);
        args->hits = output("hits", KIND_U16, args->group_count);
        if (args->bundle)
            geometry(precision)->cast_bundle(args);
        else
            geometry(precision)->cast_rays(args);
        compare_outputs(args->bundle ? "cast_bundle" : "cast_rays");
    }
}

static glint_cast_args cast_args(const test_scene *scene, bool bundle, uint32_t groups)
{
    glint_cast_args args = {.group_count = groups,
                            .active = masks(groups),
                            .prims = scene->prims,
                            .bundle = bundle ? scene->bundle : NULL,
                            .candidates = scene->candidates,
                            .candidate_count = scene->candidate_count,
                            .filter_scale = scene->filter_scale};
    memcpy(args.reference, scene->reference, sizeof args.reference);
    return args;
}

static void cast_case(int precision, bool odd)
{
    test_scene scene;
    random_scene(&scene, power_of_ten(-3, 5), one_in(2) ? 0 : power_of_ten(-3, 6), one_in(3) ? 6 : 1);
    scene.candidate_count = below(scene.prim_count + 1);
    glint_cast_args args = cast_args(&scene, one_in(2), 1 + below(MOST_GROUPS));
    make_rays(&scene, precision, odd, &args);
    cast_all(precision, &args);
}

static void test_cast(void **state)
{
    (void)state;
    run_cases(2 * CASES, 2000, cast_case);
}

/// Radii and distances of which the squares leave the range of float, some that of double.
static void cast_extremes_case(int precision, bool odd)
{
    test_scene scene;
    random_scene(&scene, power_of_ten(-30, 30), one_in(2) ? 0 : power_of_ten(-30, 30), 12);
    glint_cast_args args = cast_args(&scene, one_in(2), 1 + below(MOST_GROUPS));
    make_rays(&scene, precision, odd, &args);
    cast_all(precision, &args);
}

static void test_cast_extremes(void **state)
{
    (void)state;
    run_cases(CASES, 3000, cast_extremes_case);
}

/// Equal t, the candidates in each of their 24 orders: the lowest index wins. Two spheres coincide, a third touches
/// them from inside at the point that the rays meet, and a plane is tangent there.
static void ties_case(int precision, bool odd)
{
    (void)odd;
    test_scene scene = {.prim_count = 4};
    const double normal[3] = {0, 0, 1}, center[3][3] = {{0, 0, 0}, {0, 0, 0.5}, {0, 0, 1}};
    uint32_t slot[4] = {0, 1, 2, 3};
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t at = below(i + 1), swap = slot[i];
        slot[i] = slot[at];
        slot[at] = swap;
    }
    set_sphere(&scene.prims[slot[0]], center[0], 1);
    set_sphere(&scene.prims[slot[1]], center[0], 1);
    set_sphere(&scene.prims[slot[2]], center[1], 0.5);
    set_plane(&scene.prims[slot[3]], center[2], normal);
    scene.origin[2] = 2 + below(7);
    finish_scene(&scene);
    for (uint32_t order = 0; order < 24; order++) {
        uint32_t left[4] = {0, 1, 2, 3}, code = order;
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t pick = code % (4 - k);
            code /= 4 - k;
            scene.candidates[k] = left[pick];
            left[pick] = left[3 - k];
        }
        glint_cast_args args = cast_args(&scene, one_in(2), 1);
        make_rays(&scene, precision, false, &args);
        const double down[3] = {0, 0, -1};
        for (uint32_t i = 0; i < GLINT_GROUP; i += 2) {
            put3(args.origin, precision, i, scene.origin);
            put3(args.direction, precision, i, down);
            for (int c = 0; c < 3; c++)
                ((float *)(uintptr_t)args.direction_f[c])[i] = (float)down[c];
        }
        *(uint16_t *)(uintptr_t)args.active |= 1;
        cast_all(precision, &args);
        assert_int_equal(*(uint32_t *)array_elements(&wanted[1]), 0);
        end_case();
    }
}

static void test_ties(void **state)
{
    (void)state;
    run_cases(20, 4000, ties_case);
}

/// More than a million rays within 1e-1 .. 1e-16 of tangency, most of them closer than a float can tell.
static void filter_case(int precision, bool odd)
{
    (void)odd;
    for (int bundle = 0; bundle < 2; bundle++) {
        test_scene scene;
        random_scene(&scene, power_of_ten(-3, 5), one_in(4) ? 0 : power_of_ten(-3, 6), one_in(4) ? 6 : 1);
        scene.candidate_count = 1 + below(scene.prim_count < 6 ? scene.prim_count : 6);
        for (int part = 0; part < 2; part++) {
            glint_cast_args args = cast_args(&scene, bundle, MOST_GROUPS);
            memset((void *)(uintptr_t)args.active, 0xff, MOST_GROUPS * sizeof *args.active);
            make_rays(&scene, precision, false, &args);
            cast_all(precision, &args);
            end_case();
        }
    }
}

static void test_filter_loses_no_hit(void **state)
{
    (void)state;
    run_cases(FILTER_CASES, 5000, filter_case);
}

// ---- surface and bounds ------------------------------------------------------------------------------------------

/// Hits as cast leaves them; in an odd case other primitives and distances than those.
static void make_hits(const test_scene *scene, int precision, bool odd, glint_cast_args *cast)
{
    uint32_t n = cast->group_count * GLINT_GROUP;
    cast->t = input(real_kind(precision), n);
    cast->prim = input(KIND_U32, n);
    cast->hits = input(KIND_U16, cast->group_count);
    if (cast->bundle)
        glint_stages_ref.geometry[precision].cast_bundle(cast);
    else
        glint_stages_ref.geometry[precision].cast_rays(cast);
    for (uint32_t i = 0; i < n && odd; i++) {
        if (!lane_of(cast->hits, i))
            continue;
        put(cast->t, precision, i, maybe_odd(odd, get(cast->t, precision, i)));
        if (one_in(2))
            cast->prim[i] = below(scene->prim_count);
    }
}

static void surface_case(int precision, bool odd)
{
    test_scene scene;
    if (odd && one_in(2))
        random_scene(&scene, power_of_ten(-30, 30), one_in(2) ? 0 : power_of_ten(-30, 30), 40);
    else
        random_scene(&scene, power_of_ten(-3, 5), one_in(2) ? 0 : power_of_ten(-3, 6), one_in(2) ? 8 : 1);
    glint_cast_args cast = cast_args(&scene, one_in(2), 1 + below(MOST_GROUPS));
    make_rays(&scene, precision, false, &cast);
    make_hits(&scene, precision, odd, &cast);
    uint32_t n = cast.group_count * GLINT_GROUP;
    glint_surface_args args = {.group_count = cast.group_count,
                               .hits = cast.hits,
                               .prim = cast.prim,
                               .prims = scene.prims,
                               .bundle = cast.bundle,
                               .t = cast.t};
    memcpy(args.eye, scene.origin, sizeof args.eye);
    memcpy(args.origin, cast.origin, sizeof args.origin);
    memcpy(args.direction, cast.direction, sizeof args.direction);
    FOR_EACH_TESTED
    {
        output3(args.point, "point", real_kind(precision), n);
        output3(args.normal, "normal", real_kind(precision), n);
        args.material = output("material", KIND_U32, n);
        args.coincident = output("coincident", KIND_U32, n);
        args.side = output("side", KIND_U32, n);
        geometry(precision)->surface(&args);
        compare_outputs("surface");
    }
}

static void test_surface(void **state)
{
    (void)state;
    run_cases(2 * CASES, 6000, surface_case);
}

static void bounds_case(int precision, bool odd)
{
    uint32_t groups = 1 + below(MOST_GROUPS), n = groups * GLINT_GROUP;
    glint_bounds_args args = {.group_count = groups, .hits = masks(groups)};
    input3(args.point, real_kind(precision), n);
    for (uint32_t i = 0; i < n; i++)
        for (int c = 0; c < 3; c++)
            put(args.point[c], precision, i, maybe_odd(odd, one_in(4) ? either_sign(0) : between(-1, 1)));
    if (one_in(8))
        memset((void *)(uintptr_t)args.hits, 0, groups * sizeof *args.hits);
    FOR_EACH_TESTED
    {
        geometry(precision)->bounds(&args);
        memcpy(output("lower", KIND_DOUBLE, 3), args.lower, sizeof args.lower);
        memcpy(output("upper", KIND_DOUBLE, 3), args.upper, sizeof args.upper);
        compare_outputs("bounds");
    }
}

static void test_bounds(void **state)
{
    (void)state;
    run_cases(CASES, 7000, bounds_case);
}

// ---- light -------------------------------------------------------------------------------------------------------

/// Points, normals, materials and sides as surface leaves them: nothing where a group has no hit, zeros in the other
/// lanes without one.
static void make_points(glint_light_args *args, int precision, bool odd, double size)
{
    uint32_t n = args->group_count * GLINT_GROUP;
    uint32_t *material = input(KIND_U32, n), *side = input(KIND_U32, n);
    args->material = material;
    args->side = side;
    input3(args->point, real_kind(precision), n);
    input3(args->normal, real_kind(precision), n);
    input3(args->direction, real_kind(precision), n);
    bool grazing = one_in(3);
    for (uint32_t i = 0; i < n; i++) {
        double direction[3], normal[3] = {0}, point[3] = {0};
        random_unit(direction);
        bool hit = lane_of(args->hits, i);
        if (hit) {
            random_unit(normal);
            for (int c = 0; c < 3; c++) {
                point[c] = maybe_odd(odd, one_in(20) ? args->position[c] : size * between(-1, 1));
                normal[c] = maybe_odd(odd, grazing ? normal[c] * power_of_ten(-30, 0) : normal[c]);
                direction[c] *= power_of_ten(-2, 2);
            }
            uint32_t facing = below(10); // the eye at the light, or the light straight behind
            for (int c = 0; c < 3; c++) {
                double along = point[c] - args->position[c];
                direction[c] = maybe_odd(odd, facing == 0 ? along : facing == 1 ? -along : direction[c]);
            }
        }
        put3(args->direction, precision, i, direction);
        if (!args->hits[i / GLINT_GROUP])
            continue;
        put3(args->point, precision, i, point);
        put3(args->normal, precision, i, normal);
        material[i] = hit ? below(6) : 0;
        side[i] = hit ? below(4) : 0;
    }
}

static void light_case(int precision, bool odd)
{
    glint_light_args args = {.group_count = 1 + below(MOST_GROUPS), .directional = one_in(3), .attenuated = one_in(2)};
    uint32_t n = args.group_count * GLINT_GROUP;
    double size = power_of_ten(-4, 6), distance = size * power_of_ten(-3, 3);
    args.blinn_end = below(7);
    args.phong_end = below(args.blinn_end + 1);
    args.scale = args.directional ? 1 : ldexp(1, -ilogb(distance));
    random_unit(args.position);
    for (int c = 0; c < 3; c++) {
        args.position[c] *= args.directional ? 1 : distance;
        args.coefficients[c] = one_in(4) ? 0 : power_of_ten(-3, 2);
    }
    args.hits = masks(args.group_count);
    make_points(&args, precision, odd, size);
    FOR_EACH_TESTED
    {
        args.lit = output("lit", KIND_U16, args.group_count);
        args.cosine = output("cosine", KIND_FLOAT, n);
        args.attenuation = output("attenuation", KIND_FLOAT, n);
        args.log2_specular = output("log2_specular", KIND_FLOAT, n);
        geometry(precision)->light(&args);
        compare_outputs("light");
    }
}

static void test_light(void **state)
{
    (void)state;
    run_cases(3 * CASES, 8000, light_case);
}

// ---- occlude -----------------------------------------------------------------------------------------------------

static int sign_of(long double x)
{
    return (x > 0) - (x < 0);
}

/// On which side of each primitive the light is.
static void make_light_sides(const test_scene *scene, const glint_occlude_args *args, int8_t *side)
{
    for (uint32_t i = 0; i < scene->prim_count; i++) {
        const glint_prim *prim = &scene->prims[i];
        long double length2 = 0, height = 0;
        for (int c = 0; c < 3; c++) {
            long double from = (long double)args->position[c] - prim->center[c];
            length2 += from * from;
            height += prim->normal[c] * (args->directional ? (long double)args->position[c] : from);
        }
        if (prim->kind == GLINT_PRIM_PLANE)
            side[i] = (int8_t)sign_of(height);
        else
            side[i] = (int8_t)(args->directional ? 1 : sign_of(length2 - (long double)prim->radius * prim->radius));
        if (one_in(12)) // exactly on it
            side[i] = 0;
    }
}

/// A point on some primitive, or one from which the way to the light passes close by the outline of another.
static void make_shadow_point(const test_scene *scene, const glint_occlude_args *args, double point[3], uint32_t *own)
{
    const glint_prim *prim = &scene->prims[below(scene->prim_count)];
    double direction[3];
    *own = prim->coincident;
    if (prim->kind == GLINT_PRIM_SPHERE && one_in(2)) {
        random_unit(direction);
        for (int c = 0; c < 3; c++)
            point[c] = prim->center[c] + prim->radius * direction[c];
        return;
    }
    aim(scene, scene->origin, direction);
    double length = power_of_ten(-2, 2) / (scene->filter_scale * length3(direction));
    for (int c = 0; c < 3; c++)
        point[c] = args->directional ? scene->origin[c] - args->position[c] * length
                                     : scene->origin[c] + direction[c] * length;
}

static void occlude_case(int precision, bool odd)
{
    test_scene scene;
    double size = power_of_ten(-3, 5);
    random_scene(&scene, size, one_in(2) ? 0 : power_of_ten(-3, 6), one_in(2) ? 6 : 1);
    glint_occlude_args args = {.group_count = 1 + below(MOST_GROUPS),
                               .directional = one_in(3),
                               .prims = scene.prims,
                               .candidates = scene.candidates,
                               .filter_scale = scene.filter_scale,
                               .scale = 1};
    args.candidate_count = one_in(2) ? scene.prim_count : below(scene.prim_count + 1);
    memcpy(args.reference, scene.reference, sizeof args.reference);
    memcpy(args.position, scene.origin, sizeof args.position);
    if (args.directional)
        random_unit(args.position);
    else
        args.scale = ldexp(1, -ilogb(size));
    int8_t light_side[MOST_PRIMS];
    make_light_sides(&scene, &args, light_side);
    args.light_side = light_side;

    uint32_t n = args.group_count * GLINT_GROUP;
    uint32_t *coincident = input(KIND_U32, n), *side = input(KIND_U32, n);
    args.lit = masks(args.group_count);
    args.coincident = coincident;
    args.side = side;
    input3(args.point, real_kind(precision), n);
    for (uint32_t i = 0; i < n; i++) {
        double point[3];
        make_shadow_point(&scene, &args, point, &coincident[i]);
        side[i] = one_in(2) ? below(4) : 0;
        for (int c = 0; c < 3; c++)
            put(args.point[c], precision, i, maybe_odd(odd, one_in(30) ? scene.origin[c] : point[c]));
    }
    FOR_EACH_TESTED
    {
        uint64_t rays = 5;
        args.rays = &rays;
        args.open = output("open", KIND_U16, args.group_count);
        geometry(precision)->occlude(&args);
        *(double *)output("rays", KIND_DOUBLE, 1) = (double)rays;
        compare_outputs("occlude");
    }
}

static void test_occlude(void **state)
{
    (void)state;
    run_cases(4 * CASES, 9000, occlude_case);
}

// ---- shade and resolve -------------------------------------------------------------------------------------------

static void random_color(double color[3])
{
    for (int c = 0; c < 3; c++)
        color[c] = one_in(6) ? 0 : one_in(10) ? power_of_ten(-40, 40) : between(0, 2);
}

/// What light and occlude hand over: numbers only in the groups that were lit, before shadows.
static void make_shade_light(glint_shade_light *light, const uint16_t *hits, uint32_t groups)
{
    uint32_t n = groups * GLINT_GROUP;
    uint16_t *lit = input(KIND_U16, groups);
    float *cosine = input(KIND_FLOAT, n), *attenuation = input(KIND_FLOAT, n), *log2_specular = input(KIND_FLOAT, n);
    random_color(light->diffuse);
    random_color(light->specular);
    for (uint32_t g = 0; g < groups; g++) {
        uint16_t facing = hits[g] & random_mask();
        lit[g] = one_in(2) ? facing : facing & random_mask();
        for (uint32_t i = g * GLINT_GROUP; facing && i < (g + 1) * GLINT_GROUP; i++) {
            bool bright = facing >> i % GLINT_GROUP & 1;
            cosine[i] = (float)(!bright ? 0 : one_in(8) ? 1 : between(0, 1));
            attenuation[i] = bright ? one_in(20) ? FLT_MAX : (float)power_of_ten(-6, 1) : 0;
            log2_specular[i] = !bright || one_in(5) ? GLINT_NO_SPECULAR : one_in(9) ? 0 : (float)-power_of_ten(-9, 2);
        }
    }
    light->lit = lit;
    light->cosine = cosine;
    light->attenuation = one_in(2) ? attenuation : NULL;
    light->log2_specular = log2_specular;
}

static void make_materials(glint_shade_material *material, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        random_color(material[i].diffuse);
        random_color(material[i].specular);
        random_color(material[i].ambient);
        material[i].shininess = (float)(one_in(8) ? 0 : power_of_ten(-2, 4));
        material[i].has_specular = below(2);
    }
}

/// The shade outputs of the set that is running: sums that start as `before` says, or the film and the beauty.
static void make_shade_outputs(glint_shade_args *args, const double *before, uint32_t passes)
{
    uint32_t n = args->group_count * GLINT_GROUP;
    for (int term = 0; term < GLINT_TERM_COUNT; term++) {
        for (int c = 0; c < 3; c++) {
            bool computed = term != GLINT_TERM_SPECULAR || args->has_specular;
            args->sum[term][c] = before && computed ? output("sum", KIND_DOUBLE, n) : NULL;
            for (uint32_t i = 0; i < n && args->sum[term][c]; i++)
                args->sum[term][c][i] = before[i];
            args->film[term][c] = !before && passes >> term & 1 ? output("film", KIND_FLOAT, n) : NULL;
        }
    }
    for (int c = 0; c < 3; c++)
        args->beauty[c] = before ? NULL : output("beauty", KIND_FLOAT, n);
}

static void shade_case(int precision, bool odd)
{
    (void)precision, (void)odd;
    uint32_t groups = 1 + below(MOST_GROUPS), n = groups * GLINT_GROUP;
    glint_shade_material material_table[6];
    glint_shade_light lights[GLINT_LIGHT_CHUNK];
    uint16_t *active = masks(groups), *hits = masks(groups);
    uint32_t *material = input(KIND_U32, n);
    double *before = one_in(2) ? input(KIND_DOUBLE, n) : NULL;
    uint32_t passes = one_in(3) ? 0 : below(16);
    for (uint32_t g = 0; g < groups; g++)
        hits[g] &= active[g];
    for (uint32_t i = 0; i < n; i++) {
        if (hits[i / GLINT_GROUP])
            material[i] = lane_of(hits, i) ? below(COUNT_OF(material_table)) : 0;
        if (before)
            before[i] = one_in(3) ? 0 : power_of_ten(-5, 3);
    }
    make_materials(material_table, COUNT_OF(material_table));
    glint_shade_args args = {.group_count = groups,
                             .active = active,
                             .hits = hits,
                             .material = material,
                             .materials = material_table,
                             .has_specular = one_in(2),
                             .first = !before || one_in(2),
                             .lights = lights,
                             .light_count = below(GLINT_LIGHT_CHUNK + 1)};
    random_color(args.background);
    for (uint32_t k = 0; k < args.light_count; k++)
        make_shade_light(&lights[k], hits, groups);
    FOR_EACH_TESTED
    {
        make_shade_outputs(&args, before, args.has_specular ? passes : passes & 7);
        running->shade(&args);
        compare_outputs(before ? "shade, sums" : "shade");
    }
}

static void test_shade(void **state)
{
    (void)state;
    run_cases(2 * CASES, 10000, shade_case);
}

static void resolve_case(int precision, bool odd)
{
    (void)precision;
    uint32_t groups = 1 + below(MOST_GROUPS), n = groups * GLINT_GROUP, passes = below(16);
    glint_resolve_args args = {.group_count = groups, .samples = 1 + below(1000)};
    for (int term = 0; term < GLINT_TERM_COUNT; term++) {
        for (int c = 0; c < 3; c++) {
            args.sum[term][c] = input(KIND_DOUBLE, n);
            for (uint32_t i = 0; i < n; i++)
                args.sum[term][c][i] = maybe_odd(odd, one_in(3) ? 0 : power_of_ten(-5, 3));
        }
    }
    FOR_EACH_TESTED
    {
        for (int term = 0; term < GLINT_TERM_COUNT; term++)
            for (int c = 0; c < 3; c++)
                args.film[term][c] = passes >> term & 1 ? output("film", KIND_FLOAT, n) : NULL;
        for (int c = 0; c < 3; c++)
            args.beauty[c] = output("beauty", KIND_FLOAT, n);
        running->resolve(&args);
        compare_outputs("resolve");
    }
}

static void test_resolve(void **state)
{
    (void)state;
    run_cases(CASES / 2, 11000, resolve_case);
}

// ---- tone --------------------------------------------------------------------------------------------------------

/// Codes with a threshold anywhere in a bucket, at its ends, or nowhere.
static void make_tone_table(uint32_t table[GLINT_TONE_ENTRIES])
{
    uint32_t code = 0;
    for (uint32_t i = 0; i < GLINT_TONE_ENTRIES; i++) {
        bool step = code < 255 && one_in(7);
        uint32_t threshold = !step ? 65536 : one_in(4) ? 1 : one_in(3) ? 65535 : 1 + below(65535);
        table[i] = code | threshold << 8;
        code += step;
    }
}

static float tone_value(const uint32_t *table)
{
    uint32_t bucket = below(GLINT_TONE_ENTRIES);
    uint32_t bits = ((GLINT_TONE_FIRST + bucket) << 16) + ((table[bucket] >> 8) + below(3) - 1) % 65536;
    float x;
    memcpy(&x, &bits, sizeof x);
    return one_in(8) ? (float)odd_number() : one_in(3) ? (float)between(-0.1, 1.2) : x;
}

static void tone_case(int precision, bool odd)
{
    (void)precision, (void)odd;
    uint32_t groups = 1 + below(MOST_GROUPS), n = groups * GLINT_GROUP;
    uint32_t table[GLINT_TONE_ENTRIES];
    make_tone_table(table);
    glint_tone_args args = {.group_count = groups, .active = masks(groups), .table = table};
    for (int c = 0; c < 3; c++) {
        float *beauty = input(KIND_FLOAT, n);
        for (uint32_t i = 0; i < n; i++)
            beauty[i] = tone_value(table);
        args.beauty[c] = beauty;
    }
    FOR_EACH_TESTED
    {
        uint64_t clipped = 3, nonfinite = 4;
        args.clipped = &clipped;
        args.nonfinite = &nonfinite;
        args.rgb = output("rgb", KIND_U32, n);
        running->tone(&args);
        double *counts = output("counts", KIND_DOUBLE, 2);
        counts[0] = (double)clipped;
        counts[1] = (double)nonfinite;
        compare_outputs("tone");
    }
}

static void test_tone(void **state)
{
    (void)state;
    run_cases(CASES, 12000, tone_case);
}

// ---- elementary functions ----------------------------------------------------------------------------------------

/// How far `got` is from `want`, in units of the last place of `want` as a float.
static double ulps(float got, long double want)
{
    if (want == 0)
        return got == 0 ? 0 : HUGE_VAL;
    return fabs((double)(((long double)got - want) / ldexpl(1, ilogbl(want) - 23)));
}

/// exp2 through shade: white light on a white material of shininess 1, log2_specular = y.
static double exp2_error(const float y[GLINT_TILE_SAMPLES])
{
    static ALIGNED uint16_t all[GLINT_TILE_GROUPS];
    static ALIGNED uint32_t material[GLINT_TILE_SAMPLES];
    static ALIGNED float cosine[GLINT_TILE_SAMPLES], film[GLINT_TILE_SAMPLES], beauty[3][GLINT_TILE_SAMPLES];
    memset(all, 0xff, sizeof all);
    glint_shade_material white = {.specular = {1, 1, 1}, .shininess = 1, .has_specular = 1};
    glint_shade_light light = {.lit = all, .cosine = cosine, .log2_specular = y, .specular = {1, 1, 1}};
    glint_shade_args args = {.group_count = GLINT_TILE_GROUPS,
                             .active = all,
                             .hits = all,
                             .material = material,
                             .materials = &white,
                             .has_specular = true,
                             .first = true,
                             .lights = &light,
                             .light_count = 1,
                             .beauty = {beauty[0], beauty[1], beauty[2]}};
    args.film[GLINT_TERM_SPECULAR][0] = film;
    running->shade(&args);
    double worst = 0;
    for (uint32_t i = 0; i < GLINT_TILE_SAMPLES; i++)
        worst = fmax(worst, ulps(film[i], exp2l(y[i])));
    return worst;
}

static void test_exp2_accuracy(void **state)
{
    (void)state;
    static ALIGNED float y[GLINT_TILE_SAMPLES];
    random_state = 13000;
    for (uint32_t k = 0; k < 200; k++) {
        for (uint32_t i = 0; i < GLINT_TILE_SAMPLES; i++)
            y[i] = (float)(k % 4 == 0 ? between(-1, 0) : k % 4 == 1 ? -power_of_ten(-10, 1.6) : between(-40, 0));
        y[0] = -40;
        y[1] = 0;
        y[2] = -0.5f;
        FOR_EACH_TESTED
        {
            double worst = exp2_error(y);
            if (!(worst <= MAX_ULP_EXP2))
                print_message("%s: exp2 is %.3f ulp off\n", running->name, worst);
            assert_true(worst <= MAX_ULP_EXP2);
        }
    }
}

/// log2 through light: with normal and light along z and the ray (1, 0, -s), Phong's x is s^2 / (1 + s^2).
static double log2_error(int precision, uint32_t n, const double *s)
{
    static ALIGNED uint16_t all[GLINT_TILE_GROUPS], lit[GLINT_TILE_GROUPS];
    static ALIGNED uint32_t zero[GLINT_TILE_SAMPLES];
    static ALIGNED float cosine[GLINT_TILE_SAMPLES], log2_specular[GLINT_TILE_SAMPLES];
    memset(all, 0xff, sizeof all);
    glint_light_args args = {.group_count = n / GLINT_GROUP,
                             .hits = all,
                             .material = zero,
                             .side = zero,
                             .directional = true,
                             .position = {0, 0, 1},
                             .scale = 1,
                             .phong_end = 1,
                             .blinn_end = 1,
                             .lit = lit,
                             .cosine = cosine,
                             .log2_specular = log2_specular};
    input3(args.point, real_kind(precision), n);
    input3(args.normal, real_kind(precision), n);
    input3(args.direction, real_kind(precision), n);
    const double origin[3] = {0}, up[3] = {0, 0, 1};
    for (uint32_t i = 0; i < n; i++) {
        const double direction[3] = {1, 0, -s[i]};
        put3(args.point, precision, i, origin);
        put3(args.normal, precision, i, up);
        put3(args.direction, precision, i, direction);
    }
    geometry(precision)->light(&args);
    double worst = 0;
    for (uint32_t i = 0; i < n; i++) {
        float s_f = (float)s[i], x_f = s_f * s_f / (1 + s_f * s_f);
        double x = s[i] * s[i] / (1 + s[i] * s[i]);
        worst = fmax(worst, ulps(2 * log2_specular[i], log2l(precision == GLINT_DOUBLE ? x : (double)x_f)));
    }
    end_case();
    return worst;
}

static void test_log2_accuracy(void **state)
{
    (void)state;
    static double s[GLINT_TILE_SAMPLES];
    random_state = 14000;
    for (uint32_t k = 0; k < 200; k++) {
        for (uint32_t i = 0; i < GLINT_TILE_SAMPLES; i++)
            s[i] = k % 3 == 0 ? power_of_ten(-12, 0) : k % 3 == 1 ? power_of_ten(0, 9) : power_of_ten(-1, 0.5);
        FOR_EACH_TESTED
        {
            double worst =
                fmax(log2_error(GLINT_DOUBLE, GLINT_TILE_SAMPLES, s), log2_error(GLINT_FLOAT, GLINT_TILE_SAMPLES, s));
            if (!(worst <= MAX_ULP_LOG2))
                print_message("%s: log2 is %.3f ulp off\n", running->name, worst);
            assert_true(worst <= MAX_ULP_LOG2);
        }
    }
}

int main(void)
{
    find_tested();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_camera),
        cmocka_unit_test(test_cast),
        cmocka_unit_test(test_cast_extremes),
        cmocka_unit_test(test_ties),
        cmocka_unit_test(test_filter_loses_no_hit),
        cmocka_unit_test(test_surface),
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_light),
        cmocka_unit_test(test_occlude),
        cmocka_unit_test(test_shade),
        cmocka_unit_test(test_resolve),
        cmocka_unit_test(test_tone),
        cmocka_unit_test(test_exp2_accuracy),
        cmocka_unit_test(test_log2_accuracy),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    print_skipped();
    return failed;
}
