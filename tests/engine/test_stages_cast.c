/// camera, in_sight, cast and surface on every instruction set against the scalar reference, which tests every
/// primitive: neither the BVH nor a filter loses a hit or changes a bit.
#include "tests/engine/cases/stage_rays.h"

enum { CASES = 300 };

// ---- camera ------------------------------------------------------------------------------------------------------

static void camera_case(int precision, bool odd)
{
    const uint32_t across = one_in(4) ? 1 : 1 + below(GLINT_TILE_WIDTH / 4), down = 1 + below(GLINT_TILE_HEIGHT / 4);
    const uint32_t n = across * down * GLINT_GROUP;
    glint_camera_args args = { .group_count = across * down, .groups_across = across, .orthographic = one_in(2) };
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
    glint_lens lens = { .radius = 1, .per_focus = 1 };
    for (int i = 0; i < 3 * GLINT_GROUP; i++) {
        lens.shift[i / GLINT_GROUP][i % GLINT_GROUP] = maybe_odd(odd, either_sign(power_of_ten(-3, 6)));
        lens.bend[i / GLINT_GROUP][i % GLINT_GROUP] = maybe_odd(odd, either_sign(power_of_ten(-6, 3)));
    }
    args.lens = one_in(2) ? &lens : NULL;
    if (across == 1 && !args.lens && !args.orthographic)
        scatter_pixels(&args);
    FOR_EACH_TESTED
    {
        output3(args.origin, "origin", real_kind(precision), n);
        output3(args.direction, "direction", real_kind(precision), n);
        args.across = output("across", real_kind(precision), 3 * across * GLINT_GROUP);
        args.down = output("down", real_kind(precision), 3 * down * GLINT_GROUP);
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

static uint32_t out_of_sight;

static bool any_hit(uint32_t groups)
{
    const uint16_t *hits = array_elements(wanted_array("hits"));
    for (uint32_t g = 0; g < groups; g++)
        if (hits[g])
            return true;
    return false;
}

static void check_sight(const ray_case *c, glint_cast_view *view)
{
    glint_cast_args args = c->cast;
    args.view = view;
    if (geometry(c->precision)->in_sight(&args))
        return;
    out_of_sight++;
    if (!any_hit(c->cast.group_count))
        return;
    mismatches++;
    printf("in_sight %s, seed %llu: false, but something is hit\n", running->name, (unsigned long long)case_seed);
}

/// Casts with every instruction set. `views` has one view for each instruction set, or NULL.
static void cast_with(const ray_case *c, glint_cast_view views[])
{
    static const char *const names[RAY_KINDS] = { "cast_bundle",     "cast_bundle, pixels", "cast_rays, orthographic",
                                                  "cast_rays, lens", "cast_rays, parallel", "cast_rays, alike",
                                                  "cast_rays" };
    glint_cast_args args = c->cast;
    const uint32_t n = args.group_count * GLINT_GROUP;
    FOR_EACH_TESTED
    {
        args.t = output("t", real_kind(c->precision), n);
        args.prim = output("prim", KIND_U32, n);
        args.hits = output("hits", KIND_U16, args.group_count);
        args.view = views ? &views[isa_] : NULL;
        cast_on(running, c, &args);
        compare_outputs(names[c->kind]);
        if (c->kind == RAYS_OF_EYE)
            check_sight(c, args.view);
    }
}

static void cast_all(const ray_case *c) { cast_with(c, NULL); }

/// Puts special values into some rays, but never a tiny direction, whose square would be 0 in float.
static void spoil_rays(ray_case *c)
{
    double origin[3], direction[3];
    for (uint32_t i = 0; i < c->cast.group_count * GLINT_GROUP; i++) {
        get_ray(c, i, origin, direction);
        for (uint32_t k = 0; k < 3; k++) {
            put(c->origin[k], c->precision, i, maybe_odd(true, origin[k]));
            direction[k] = maybe_odd(true, direction[k]);
        }
        if (!(length3(direction) < 1e-15))
            put3(c->direction, c->precision, i, direction);
    }
}

static void cast_case(int precision, bool odd)
{
    ray_case c;
    start_rays(&c, (ray_kind)below(RAY_KINDS), precision);
    if (odd && c.kind == RAYS_FREE)
        spoil_rays(&c);
    cast_all(&c);
    end_rays(&c);
}

static void test_cast(void **state)
{
    (void)state;
    run_cases(4 * CASES, 2000, cast_case);
}

/// Starts a ray on a triangle: either in a random direction, or next to an edge,
/// to cross that edge almost in the plane.
static void leave_triangle(ray_case *c, uint32_t i, const glint_prim *prim)
{
    const bool by_edge = one_in(2);
    double point[3], direction[3], e[3], f[3], m[3];
    for (int k = 0; k < 3; k++) {
        e[k] = prim->corner[1][k] - prim->corner[0][k];
        f[k] = prim->corner[2][k] - prim->corner[0][k];
    }
    for (int k = 0; k < 3; k++)
        m[k] = e[(k + 1) % 3] * f[(k + 2) % 3] - e[(k + 2) % 3] * f[(k + 1) % 3];
    const double w = between(0, 0.9), share = power_of_ten(-17, -1), rise = either_sign(power_of_ten(-17, 0));
    const double side = length3(f), area = length3(m);
    for (int k = 0; k < 3; k++) {
        point[k] = prim->corner[0][k] + (w * e[k] + share * f[k]);
        direction[k] = rise * (m[k] / area) - f[k] / side;
    }
    if (!by_edge)
        random_unit(direction);
    put3(c->origin, c->precision, i, point);
    put3(c->direction, c->precision, i, direction);
}

/// Rebuilds the scene with triangles or solids.
static void mix_scene(ray_case *c, bool triangles, bool solids)
{
    free_scene(c->scene);
    c->plan.triangles = triangles;
    c->plan.solids = solids;
    c->scene = random_scene(&c->plan);
    c->cast.geometry = &c->scene->table;
}

/// Tests rays that start on the primitives; some of these rays point inwards.
static void leaving_case(int precision, bool odd)
{
    (void)odd;
    ray_case c;
    start_rays(&c, RAYS_FREE, precision);
    if (precision == GLINT_PRECISION_DOUBLE && one_in(2)) // test_stages_occlude.c covers triangles in float
        mix_scene(&c, true, false);
    const uint32_t n = c.cast.group_count * GLINT_GROUP;
    uint32_t *leaving = input(KIND_U32, n);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t index = below(c.scene->table.prim_count);
        const glint_prim *prim = &c.scene->prims[index];
        double direction[3], point[3];
        leaving[i] = one_in(8) ? GLINT_MISS : index;
        if (prim->kind == GLINT_PRIM_TRIANGLE)
            leave_triangle(&c, i, prim);
        if (prim->kind == GLINT_PRIM_TRIANGLE || prim->kind == GLINT_PRIM_PLANE)
            continue; // for planes, the position of the ray's origin does not matter
        random_unit(direction);
        along3(prim->center, prim->kind == GLINT_PRIM_SPHERE ? prim->radius : 0, direction, point);
        put3(c.origin, precision, i, point);
        if (one_in(3)) { // a direction almost along the surface
            random_across(direction, point);
            along3(point, either_sign(power_of_ten(-17, 0)), direction, direction);
        } else {
            random_unit(direction);
        }
        put3(c.direction, precision, i, direction);
    }
    c.cast.leaving = leaving;
    c.cast.inward = masks(c.cast.group_count);
    cast_all(&c);
    end_rays(&c);
}

static void test_leaving(void **state)
{
    (void)state;
    run_cases(2 * CASES, 7000, leaving_case);
}

/// The scene is built around one tile and seen from a nearby tile:
/// any primitive visible in the nearby tile is at its border.
static void neighbour_case(int precision, bool odd)
{
    (void)odd;
    ray_case c;
    start_rays(&c, RAYS_OF_EYE, precision);
    for (int round = 0; round < 3; round++) {
        c.camera.x0 += either_sign(4 * c.camera.groups_across);
        c.camera.y0 += 4 * below(3) * (c.cast.group_count / c.camera.groups_across);
        shoot_camera(&c);
        cast_all(&c);
        free_arrays(wanted, &wanted_count);
    }
    end_rays(&c);
}

static void test_in_sight(void **state)
{
    (void)state;
    out_of_sight = 0;
    run_cases(CASES, 3000, neighbour_case);
    assert_true(out_of_sight > 0 || case_step() > 1); // a run of few cases may have no such primitive
}

/// Moves the camera to another tile of the picture, most often a neighbour, and to other sample positions.
static void move_tile(ray_case *c)
{
    glint_camera_args *camera = &c->camera;
    const double x0 = camera->x0 + (double)GLINT_TILE_WIDTH * (below(3) - 1.0);
    const double y0 = camera->y0 + (double)GLINT_TILE_HEIGHT * (below(3) - 1.0);
    camera->x0 = x0 < 0 || x0 >= camera->width ? 0 : x0;
    camera->y0 = y0 < 0 || y0 >= camera->height ? 0 : y0;
    for (int k = 0; k < 2; k++)
        camera->offset[k] = one_in(2) ? below(2) : between(0, 1);
    shoot_camera(c);
}

/// Casts several tiles of one picture. Each call gets the cached data of earlier calls.
static void cast_tiles(ray_case *c)
{
    static glint_cast_view views[sizeof tested / sizeof *tested];
    memset(views, 0, sizeof views);
    for (int round = 0; round < 4; round++) {
        if (round)
            free_arrays(wanted, &wanted_count);
        cast_with(c, views);
        move_tile(c);
    }
}

static void tiles_case(int precision, bool odd)
{
    (void)odd;
    ray_case c;
    start_rays(&c, RAYS_OF_EYE, precision);
    cast_tiles(&c);
    end_rays(&c);
}

static void test_tiles(void **state)
{
    (void)state;
    run_cases(CASES, 3800, tiles_case);
}

// ---- From afar ---------------------------------------------------------------------------------------------------

/// Tests exactly axis-parallel rays from up to 1e36 away, at spheres that are tiny compared with that distance.
static void afar_case(int precision, bool odd)
{
    (void)odd;
    static test_scene scene;
    const uint32_t n = GLINT_TILE_SAMPLES, most_exponent = precision == GLINT_PRECISION_DOUBLE ? 36 : 15;
    ray_case c = { .kind = RAYS_FREE, .precision = precision, .plan = { .size = 1 }, .scene = &scene };
    scene.table.prim_count = 1 + below(60);
    for (uint32_t i = 0; i < scene.table.prim_count; i++) {
        const double center[3] = { between(-1, 1), between(-1, 1), between(-1, 1) };
        set_sphere(&scene.prims[i], center, power_of_ten(-6, -1));
    }
    finish_scene(&c.plan, &scene);
    input3(c.origin, real_kind(precision), n);
    input3(c.direction, real_kind(precision), n);
    for (uint32_t i = 0; i < n; i++) {
        const glint_prim *prim = &scene.prims[below(scene.table.prim_count)];
        const uint32_t axis = below(3);
        double direction[3] = { 0 }, origin[3];
        direction[axis] = either_sign(power_of_ten(-1, 1));
        for (int k = 0; k < 3; k++)
            origin[k] = prim->center[k] + prim->radius * between(-0.8, 0.8);
        origin[axis] -= power_of_ten(0, most_exponent) * direction[axis];
        put3(c.origin, precision, i, origin);
        put3(c.direction, precision, i, direction);
    }
    c.cast = (glint_cast_args) { .group_count = GLINT_TILE_GROUPS,
                                 .active = masks(GLINT_TILE_GROUPS),
                                 .geometry = &scene.table };
    memcpy(c.cast.origin, c.origin, sizeof c.cast.origin);
    memcpy(c.cast.direction, c.direction, sizeof c.cast.direction);
    cast_all(&c);
    end_rays(&c);
}

static void test_from_afar(void **state)
{
    (void)state;
    run_cases(CASES / 2, 7000, afar_case);
}

// ---- Borders of groups ---------------------------------------------------------------------------------------------

/// Sets an axis-aligned camera whose outermost rays of each group run exactly along the group's border.
static void set_border_camera(glint_camera_args *camera, double distance)
{
    const double height = random_tile(camera), edge = power_of_ten(-1.5, 0);
    const uint32_t axis = below(3);
    for (int c = 0; c < 2; c++)
        camera->offset[c] = below(2);
    camera->forward[axis] = either_sign(1);
    camera->right[(axis + 1) % 3] = either_sign(edge / height);
    camera->up[(axis + 2) % 3] = either_sign(edge / height);
    camera->eye[axis] = -distance * camera->forward[axis];
}

/// Chooses a ray on the left, right, upper or lower border of a group,
/// and the direction that leads out of the group there.
static void border_ray(const ray_case *c, double origin[3], double direction[3], double outwards[3])
{
    const glint_camera_args *camera = &c->camera;
    const bool across = one_in(2), far = camera->offset[!across] > 0;
    const uint32_t lane = across ? 4 * below(4) + (far ? 3 : 0) : below(4) + 4 * (far ? 3 : 0);
    const double *axis = across ? camera->right : camera->up;
    get_ray(c, below(camera->group_count) * GLINT_GROUP + lane, origin, direction);
    const double sign = far == across ? 1 : -1, back = dot3(axis, direction) / dot3(direction, direction);
    for (int k = 0; k < 3; k++)
        outwards[k] = sign * (axis[k] - back * direction[k]);
    const double size = length3(outwards);
    for (int k = 0; k < 3; k++)
        outwards[k] /= size;
}

/// Spheres outside of groups that touch, or almost touch, a ray along the border of the group.
static void border_case(int precision, bool odd)
{
    (void)odd;
    static test_scene scene;
    const double distance = power_of_ten(0.3, 3);
    ray_case c = { .kind = RAYS_OF_EYE, .precision = precision, .plan = { .size = 1 }, .scene = &scene };
    set_border_camera(&c.camera, distance);
    make_axes(&c.camera, precision);
    shoot_camera(&c);
    scene.table.prim_count = 1 + below(60);
    for (uint32_t i = 0; i < scene.table.prim_count; i++) {
        double origin[3], direction[3], outwards[3], center[3];
        const double radius = distance * power_of_ten(-6, -1.5);
        border_ray(&c, origin, direction, outwards);
        along3(origin, distance * between(0.5, 2), direction, center);
        along3(center, radius * (1 - power_of_ten(-16, -5)), outwards, center);
        set_sphere(&scene.prims[i], center, radius);
    }
    finish_scene(&c.plan, &scene);
    uint16_t *active = masks(c.camera.group_count);
    memset(active, 0xff, c.camera.group_count * sizeof *active);
    c.cast = (glint_cast_args) {
        .group_count = c.camera.group_count, .active = active, .geometry = &scene.table, .camera = &c.camera
    };
    cast_all(&c);
    end_rays(&c);
}

static void test_borders(void **state)
{
    (void)state;
    run_cases(2 * CASES, 3500, border_case);
}

// ---- Groups filled by one primitive --------------------------------------------------------------------------------

/// Sets a sphere or plane whose silhouette runs along the border of a group: exactly on the border, or slightly
/// inside or outside.
static void set_along_border(const ray_case *c, glint_prim *prim, double distance)
{
    double origin[3], direction[3], outwards[3], place[3], center[3];
    border_ray(c, origin, direction, outwards);
    const double radius = distance * power_of_ten(-2.5, one_in(4) ? 4 : 0.5), sign = one_in(4) ? 1 : -1;
    along3(origin, distance * between(0.5, 2) / length3(direction), direction, place);
    if (one_in(6)) {
        for (int k = 0; k < 3; k++)
            place[k] = origin[k] + distance * between(-1, 1);
        set_plane(prim, place, outwards);
        return;
    }
    along3(place, sign * radius * (1 + slight()), outwards, center);
    set_sphere(prim, center, radius);
}

/// A sphere with nearly the same silhouette as another one, but farther away, often only slightly.
static void set_behind(const ray_case *c, glint_prim *prim, const glint_prim *other)
{
    const double times = 1 + power_of_ten(-12, 0);
    double center[3];
    for (int k = 0; k < 3; k++)
        center[k] = c->camera.eye[k] + times * (other->center[k] - c->camera.eye[k]);
    set_sphere(prim, center, times * other->radius * (1 + slight()));
}

static uint32_t groups_filled;

/// Few primitives, each of which fills groups of the tile up to their border.
static void filled_case(int precision, bool odd)
{
    (void)odd;
    static test_scene scene;
    const double distance = power_of_ten(-1, 3);
    ray_case c = { .kind = RAYS_OF_EYE, .precision = precision, .plan = { .size = distance }, .scene = &scene };
    set_border_camera(&c.camera, distance);
    make_axes(&c.camera, precision);
    shoot_camera(&c);
    scene.table.prim_count = 1 + below(one_in(3) ? 20 : 4);
    for (uint32_t i = 0; i < scene.table.prim_count; i++) {
        set_along_border(&c, &scene.prims[i], distance);
        if (i > 0 && one_in(4) && scene.prims[i - 1].kind == GLINT_PRIM_SPHERE)
            set_behind(&c, &scene.prims[i], &scene.prims[i - 1]);
    }
    finish_scene(&c.plan, &scene);
    uint16_t *active = masks(c.camera.group_count);
    if (!one_in(4))
        memset(active, 0xff, c.camera.group_count * sizeof *active);
    c.cast = (glint_cast_args) {
        .group_count = c.camera.group_count, .active = active, .geometry = &scene.table, .camera = &c.camera
    };
    cast_tiles(&c);
    const uint16_t *hits = array_elements(wanted_array("hits"));
    for (uint32_t g = 0; g < c.camera.group_count; g++)
        groups_filled += hits[g] == 0xffff;
    end_rays(&c);
}

static void test_filled(void **state)
{
    (void)state;
    groups_filled = 0;
    run_cases(8 * CASES, 8500, filled_case);
    assert_true(groups_filled * case_step() > 10 * CASES);
}

// ---- Equal distances ---------------------------------------------------------------------------------------------

/// Four primitives that a downward ray hits at one point, numbered in random order: two coincident spheres, a third
/// that touches them from inside, and a tangent plane.
static test_scene *tied_scene(const scene_plan *plan)
{
    static test_scene scene;
    const double normal[3] = { 0, 0, 1 }, center[3][3] = { { 0, 0, 0 }, { 0, 0, 0.5 }, { 0, 0, 1 } };
    scene.table.prim_count = 4;
    set_sphere(&scene.prims[0], center[0], 1);
    set_sphere(&scene.prims[1], center[0], 1);
    set_sphere(&scene.prims[2], center[1], 0.5);
    set_plane(&scene.prims[3], center[2], normal);
    finish_scene(plan, &scene);
    return &scene;
}

/// Checks ties: the lowest id wins. The ray in the middle of the picture points exactly down.
static void ties_case(int precision, bool odd)
{
    (void)odd;
    ray_case c = { .kind = one_in(2) ? RAYS_OF_EYE : RAYS_OF_ORTHOGRAPHIC_CAMERA, .precision = precision };
    c.plan = (scene_plan) { .size = 1 };
    c.camera = (glint_camera_args) { .group_count = GLINT_TILE_GROUPS,
                                     .groups_across = GLINT_TILE_WIDTH / 4,
                                     .width = GLINT_TILE_WIDTH,
                                     .height = GLINT_TILE_HEIGHT,
                                     .orthographic = c.kind != RAYS_OF_EYE,
                                     .eye = { 0, 0, 2 + below(7) },
                                     .forward = { 0, 0, -1 },
                                     .right = { 1. / 32 },
                                     .up = { 0, 1. / 32 } };
    const uint32_t middle = (3 * c.camera.groups_across + 4) * GLINT_GROUP, n = GLINT_TILE_SAMPLES;
    input3(c.origin, real_kind(precision), n);
    input3(c.direction, real_kind(precision), n);
    make_axes(&c.camera, precision);
    shoot_camera(&c);
    uint16_t *active = masks(GLINT_TILE_GROUPS);
    active[middle / GLINT_GROUP] |= 1;
    c.scene = tied_scene(&c.plan);
    c.cast = (glint_cast_args) { .group_count = GLINT_TILE_GROUPS,
                                 .active = active,
                                 .geometry = &c.scene->table,
                                 .camera = &c.camera };
    memcpy(c.cast.origin, c.origin, sizeof c.cast.origin);
    memcpy(c.cast.direction, c.direction, sizeof c.cast.direction);
    cast_all(&c);
    assert_int_equal(c.scene->prims[((uint32_t *)array_elements(wanted_array("prim")))[middle]].id, 0);
    end_rays(&c);
}

static void test_ties(void **state)
{
    (void)state;
    run_cases(CASES, 4000, ties_case);
}

// ---- surface -----------------------------------------------------------------------------------------------------

/// Makes hits as cast leaves them. In odd cases, replaces some primitives and distances.
static void make_hits(ray_case *c, bool odd)
{
    const uint32_t n = c->cast.group_count * GLINT_GROUP;
    c->cast.t = input(real_kind(c->precision), n);
    c->cast.prim = input(KIND_U32, n);
    c->cast.hits = input(KIND_U16, c->cast.group_count);
    cast_on(&glint_stages_ref, c, &c->cast);
    for (uint32_t i = 0; i < n && odd; i++) {
        if (!lane_of(c->cast.hits, i))
            continue;
        put(c->cast.t, c->precision, i, maybe_odd(odd, get(c->cast.t, c->precision, i)));
        if (one_in(2))
            c->cast.prim[i] = below(c->scene->table.prim_count);
    }
}

/// Makes the input of surface. Returns the number of lanes.
static uint32_t make_surface_case(ray_case *c, glint_surface_args *args, int precision, bool odd, bool mixed)
{
    start_rays(c, (ray_kind)below(RAY_KINDS), precision);
    if (mixed)
        mix_scene(c, one_in(2), one_in(2));
    make_hits(c, odd);
    *args = (glint_surface_args) { .group_count = c->cast.group_count,
                                   .hits = c->cast.hits,
                                   .prim = c->cast.prim,
                                   .prims = c->scene->prims,
                                   .mixed = c->plan.triangles || c->plan.solids,
                                   .scale = c->scene->table.scale,
                                   .solids = c->scene->solids,
                                   .camera = is_from_eye(c->kind) ? &c->camera : NULL,
                                   .t = c->cast.t };
    memcpy(args->origin, c->origin, sizeof args->origin);
    memcpy(args->direction, c->direction, sizeof args->direction);
    return args->group_count * GLINT_GROUP;
}

static void ask_surface(glint_surface_args *args, uint32_t n)
{
    args->material = output("material", KIND_U32, n);
    args->back = output("back", KIND_U16, args->group_count);
    args->dark = output("dark", KIND_U16, args->group_count);
    args->slack = args->mixed ? output("slack", KIND_DOUBLE, n) : NULL;
}

static void put_box(const glint_point_box *box)
{
    double *ends = output("box", KIND_DOUBLE, 6);
    uint32_t *only = output("only", KIND_U32, 1);
    memcpy(ends, box->lower, sizeof box->lower);
    memcpy(ends + 3, box->upper, sizeof box->upper);
    *only = box->only;
}

/// Triangles and solids need real hits and double precision.
static bool may_mix(int precision, bool odd) { return precision == GLINT_PRECISION_DOUBLE && !odd && one_in(2); }

static void surface_case(int precision, bool odd)
{
    ray_case c;
    glint_surface_args args;
    glint_point_box box;
    const uint32_t n = make_surface_case(&c, &args, precision, odd, may_mix(precision, odd));
    args.box = one_in(2) ? &box : NULL;
    FOR_EACH_TESTED
    {
        output3(args.point, "point", real_kind(precision), n);
        output3(args.normal, "normal", real_kind(precision), n);
        ask_surface(&args, n);
        geometry(precision)->surface(&args);
        if (args.box)
            put_box(&box);
        compare_outputs("surface");
    }
    end_rays(&c);
}

/// Checks runs that compute only points: in the requested lanes, they equal the points computed with normals.
static void points_case(int precision, bool odd)
{
    static _Alignas(64) double points[3][GLINT_TILE_SAMPLES], normals[3][GLINT_TILE_SAMPLES];
    static _Alignas(64) uint32_t material[GLINT_TILE_SAMPLES];
    static uint16_t back[GLINT_TILE_GROUPS], dark[GLINT_TILE_GROUPS];
    ray_case c;
    glint_surface_args args;
    const uint32_t n = make_surface_case(&c, &args, precision, odd, false);
    args.material = material;
    args.back = back;
    args.dark = dark;
    for (int k = 0; k < 3; k++) {
        args.point[k] = points[k];
        args.normal[k] = normals[k];
    }
    glint_stages_ref.geometry[precision].surface(&args);
    uint16_t *hits = masks(args.group_count);
    for (uint32_t g = 0; g < args.group_count; g++)
        hits[g] = one_in(4) ? hits[g] & c.cast.hits[g] : c.cast.hits[g];
    args.hits = hits;
    args.normal[0] = args.normal[1] = args.normal[2] = NULL;
    FOR_EACH_TESTED
    {
        output3(args.point, "point", real_kind(precision), n);
        geometry(precision)->surface(&args);
        for (uint32_t i = 0; i < n; i++)
            for (int k = 0; k < 3 && lane_of(hits, i); k++) {
                const double alone = get(args.point[k], precision, i), with_normal = get(points[k], precision, i);
                assert_memory_equal(&alone, &with_normal, sizeof alone);
            }
        compare_outputs("points");
    }
    end_rays(&c);
}

/// Makes a light near a primitive or far away, and materials of every kind.
static void make_lamp(const ray_case *c, glint_light_args *light)
{
    static glint_shade_material materials[4]; // as many materials as finish_scene assigns
    for (uint32_t i = 0; i < COUNT_OF(materials); i++)
        materials[i] = (glint_shade_material) { .highlight = below(3), .least = one_in(3) ? 0 : (float)between(0, 1) };
    *light = (glint_light_args) { .group_count = c->cast.group_count,
                                  .hits = c->cast.hits,
                                  .materials = materials,
                                  .camera = is_from_eye(c->kind) ? &c->camera : NULL,
                                  .directional = one_in(3),
                                  .scale = one_in(2) ? 1 : 0x1p-3,
                                  .sample_count = 1,
                                  .attenuated = one_in(2),
                                  .coefficients = { between(0, 2), between(0, 1), between(0, 1) },
                                  .highlights = !one_in(4),
                                  .sparing = one_in(2) };
    if (one_in(2)) { // lanes that a visible light covers are not lit
        uint16_t *hits = masks(light->group_count);
        for (uint32_t g = 0; g < light->group_count; g++)
            hits[g] = one_in(2) ? c->cast.hits[g] : hits[g] & c->cast.hits[g];
        light->hits = hits;
    }
    const glint_prim *prim = &c->scene->prims[below(c->scene->table.prim_count)];
    const double away = c->plan.size * power_of_ten(-2, 2);
    random_unit(light->position);
    for (int k = 0; k < 3 && !light->directional; k++)
        light->position[k] = prim->center[k] + away * light->position[k];
}

static void lit_surface_case(int precision, bool odd)
{
    static _Alignas(64) double normal[3][GLINT_TILE_SAMPLES];
    ray_case c;
    glint_surface_args args;
    glint_light_args light;
    glint_point_box box;
    const uint32_t n = make_surface_case(&c, &args, precision, odd, may_mix(precision, odd));
    args.box = &box;
    args.all_normals = one_in(2);
    make_lamp(&c, &light);
    for (int k = 0; k < 3; k++) {
        args.normal[k] = normal[k];
        light.direction[k] = c.direction[k];
    }
    FOR_EACH_TESTED
    {
        if (args.all_normals || args.mixed)
            output3(args.normal, "normal", real_kind(precision), n);
        memcpy(light.normal, args.normal, sizeof args.normal);
        output3(args.point, "point", real_kind(precision), n);
        memcpy(light.point, args.point, sizeof args.point);
        ask_surface(&args, n);
        light.material = args.material;
        light.dark = args.dark;
        light.lit[0] = output("lit", KIND_U16, args.group_count);
        light.cosine[0] = output("cosine", KIND_FLOAT, n);
        light.attenuation[0] = output("attenuation", KIND_FLOAT, n);
        light.log2_specular[0] = output("log2_specular", KIND_FLOAT, n);
        light.brightest[0] = output("brightest", KIND_FLOAT, 1);
        geometry(precision)->lit_surface(&args, &light);
        put_box(&box);
        compare_outputs("lit_surface");
    }
    end_rays(&c);
}

static void test_surface(void **state)
{
    (void)state;
    run_cases(2 * CASES, 6000, surface_case);
}

static void test_points(void **state)
{
    (void)state;
    run_cases(2 * CASES, 6500, points_case);
}

static void test_lit_surface(void **state)
{
    (void)state;
    run_cases(2 * CASES, 7000, lit_surface_case);
}

int main(void)
{
    find_tested();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_camera),    cmocka_unit_test(test_cast),    cmocka_unit_test(test_in_sight),
        cmocka_unit_test(test_from_afar), cmocka_unit_test(test_borders), cmocka_unit_test(test_ties),
        cmocka_unit_test(test_surface),   cmocka_unit_test(test_leaving), cmocka_unit_test(test_lit_surface),
        cmocka_unit_test(test_points),
        cmocka_unit_test(test_filled),    cmocka_unit_test(test_tiles),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    print_skipped();
    return failed;
}
