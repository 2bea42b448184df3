/// cast and occlude in exactly degenerate cases. Positions, directions and sizes are small integers times one power
/// of two, so that rays pass exactly through corners and edges, in planes and along faces and axes, and values are
/// exactly 0. Every instruction set is compared with the scalar reference.
#include "tests/engine/cases/stage_rays.h"

enum { CASES = 1500, REACH = 3 };

static double unit; ///< grid spacing of the current case

/// A point on the lattice.
static void lattice3(double v[3])
{
    for (int k = 0; k < 3; k++)
        v[k] = unit * ((double)below(2 * REACH + 1) - REACH);
}

/// A nonzero vector on the lattice.
static void lattice_way(double v[3])
{
    do
        lattice3(v);
    while (!(length3(v) > 0));
}

// ---- Scenes ------------------------------------------------------------------------------------------------------

/// Three corners that are not collinear. Some triangles share an edge with the previous triangle.
static void set_lattice_triangle(glint_prim *prim, const glint_prim *last)
{
    double f[3], g[3], n[3];
    *prim = (glint_prim) {
        .kind = GLINT_PRIM_TRIANGLE, .corner = corner_buffer(), .item = GLINT_MISS, .shading_points = GLINT_MISS
    };
    do {
        for (int j = 0; j < 3; j++)
            if (j < 2 && last && last->kind == GLINT_PRIM_TRIANGLE && one_in(2))
                memcpy(prim->corner[j], last->corner[1 - j], sizeof prim->corner[j]);
            else
                lattice3(prim->corner[j]);
        along3(prim->corner[1], -1, prim->corner[0], f);
        along3(prim->corner[2], -1, prim->corner[0], g);
        cross3(f, g, n);
    } while (!(length3(n) > 0));
}

/// Makes an axis-aligned solid, with its axes in any order.
static void set_lattice_solid(test_scene *scene, uint32_t i)
{
    glint_solid *solid = &scene->solids[i];
    const uint32_t turn = below(3);
    *solid = (glint_solid) { .form = below(GLINT_FORM_TORUS + 1), .tube = one_in(2) ? 0.5 : 0.25 };
    for (uint32_t k = 0; k < 3; k++) {
        const double size = either_sign(unit * (1u << below(2)));
        solid->forward[(k + turn) % 3][k] = size;
        solid->inverse[k][(k + turn) % 3] = 1 / size;
    }
    scene->prims[i] = (glint_prim) { .kind = GLINT_PRIM_SOLID };
    scene->prims[i].item = i;
    lattice3(scene->prims[i].center);
}

static test_scene *lattice_scene(void)
{
    static test_scene scene;
    const scene_plan plan = { .size = REACH * unit };
    const uint32_t kinds = one_in(3) ? 1 : 4;
    scene.table.prim_count = 1 + below(one_in(4) ? 60 : 6);
    for (uint32_t i = 0; i < scene.table.prim_count; i++) {
        const uint32_t kind = below(kinds);
        double place[3], normal[3] = { 0 };
        lattice3(place);
        normal[below(3)] = either_sign(1);
        if (kind == 0)
            set_lattice_triangle(&scene.prims[i], i ? &scene.prims[i - 1] : NULL);
        else if (kind == 1)
            set_lattice_solid(&scene, i);
        else if (kind == 2)
            set_sphere(&scene.prims[i], place, unit * (1 + below(2)));
        else
            set_plane(&scene.prims[i], place, normal);
    }
    finish_scene(&plan, &scene);
    return &scene;
}

/// A point on a triangle: a corner or the midpoint of an edge.
static void place_on(const glint_prim *prim, double point[3])
{
    const uint32_t u = below(3), v = below(3 - u);
    for (int k = 0; k < 3; k++)
        point[k] = prim->corner[0][k] + (0.5 * u * (prim->corner[1][k] - prim->corner[0][k]) +
                                         0.5 * v * (prim->corner[2][k] - prim->corner[0][k]));
}

// ---- cast --------------------------------------------------------------------------------------------------------

static uint64_t met, on_solids; ///< number of rays that hit something, and of rays that hit a solid

/// Approximate distance of a point from the surface of a unit shape.
static double off_unit(uint32_t form, double tube, const double k[3])
{
    const double round = hypot(k[0], k[1]), z = k[2];
    const bool cone = form == GLINT_FORM_CONE || form == GLINT_FORM_FUNNEL;
    const double side = fabs(round - (cone ? z : 1)), beyond = fmax(fmax(cone ? -z : -1 - z, z - 1), 0);
    const double end = fmax(fmin(fabs(z - 1), cone ? INFINITY : fabs(z + 1)), fmax(round - 1, 0));
    switch (form) {
    case GLINT_FORM_BALL:
        return fabs(length3(k) - 1);
    case GLINT_FORM_BOX:
        return fabs(fmax(fmax(fabs(k[0]), fabs(k[1])), fabs(z)) - 1);
    case GLINT_FORM_DISK:
        return fmax(fabs(z), fmax(round - 1, 0));
    case GLINT_FORM_TUBE:
    case GLINT_FORM_FUNNEL:
        return fmax(side, beyond);
    case GLINT_FORM_TORUS:
        return fabs(hypot(round - 1, z) - tube);
    default:
        return fmin(fmax(side, beyond), end);
    }
}

/// Checks that the reference's hits on solids are on their surfaces, independently of the other instruction sets.
static void check_hits(const ray_case *c)
{
    const test_array *t = wanted_array("t"), *prim = wanted_array("prim");
    const uint16_t *hits = array_elements(wanted_array("hits"));
    for (uint32_t i = 0; i < c->cast.group_count * GLINT_GROUP; i++) {
        double origin[3], direction[3], k[3];
        if (!lane_of(hits, i))
            continue;
        met++;
        const glint_prim *met_prim = &c->scene->prims[((const uint32_t *)array_elements(prim))[i]];
        if (met_prim->kind != GLINT_PRIM_SOLID)
            continue;
        on_solids++;
        const glint_solid *solid = &c->scene->solids[met_prim->item];
        get_ray(c, i, origin, direction);
        along3(origin, get(array_elements(t), c->precision, i), direction, origin);
        along3(origin, -1, met_prim->center, origin);
        for (int j = 0; j < 3; j++)
            k[j] = dot3(solid->inverse[j], origin);
        if (off_unit(solid->form, solid->tube, k) > (c->precision == GLINT_PRECISION_DOUBLE ? 1e-12 : 1e-4))
            fail_msg("seed %llu, ray %u: form %u is hit at {%g, %g, %g}", (unsigned long long)case_seed, i, solid->form,
                     k[0], k[1], k[2]);
    }
}

static void cast_all(const ray_case *c)
{
    glint_cast_args args = c->cast;
    const uint32_t n = args.group_count * GLINT_GROUP;
    FOR_EACH_TESTED
    {
        args.t = output("t", real_kind(c->precision), n);
        args.prim = output("prim", KIND_U32, n);
        args.hits = output("hits", KIND_U16, args.group_count);
        cast_on(running, c, &args);
        compare_outputs(c->kind == RAYS_OF_EYE ? "cast_bundle" : "cast_rays");
    }
    check_hits(c);
}

/// Some of the individual rays start on a triangle.
static void shoot_lattice(ray_case *c)
{
    uint32_t *leaving = input(KIND_U32, c->cast.group_count * GLINT_GROUP);
    double origin[3], direction[3];
    for (uint32_t i = 0; i < c->cast.group_count * GLINT_GROUP; i++) {
        const uint32_t from = below(c->scene->table.prim_count);
        leaving[i] = GLINT_MISS;
        lattice3(origin);
        if (c->kind == RAYS_FREE && one_in(3) && c->scene->prims[from].kind == GLINT_PRIM_TRIANGLE) {
            leaving[i] = from;
            place_on(&c->scene->prims[from], origin);
        }
        if (c->kind == RAYS_FREE || i % GLINT_GROUP == 0)
            lattice_way(direction);
        put3(c->origin, c->precision, i, origin);
        put3(c->direction, c->precision, i, direction);
    }
    if (c->kind == RAYS_FREE) {
        c->cast.leaving = leaving;
        c->cast.inward = masks(c->cast.group_count);
    }
}

/// The eye is on the lattice, and the camera's axes are parallel to its axes.
static void look_along_lattice(ray_case *c)
{
    glint_camera_args *camera = &c->camera;
    const uint32_t axis = below(3);
    camera->width = camera->height = 64;
    camera->x0 = camera->y0 = 16 + 8 * below(3);
    camera->offset[0] = camera->offset[1] = one_in(2) ? 0.5 : 0;
    lattice3(camera->eye);
    camera->forward[axis] = either_sign(1);
    camera->right[(axis + 1) % 3] = either_sign(0.125);
    camera->up[(axis + 2) % 3] = either_sign(0.125);
    make_axes(camera, c->precision);
    shoot_camera(c);
}

static void cast_case(int precision, bool odd)
{
    (void)odd;
    static const ray_kind kinds[] = { RAYS_OF_EYE, RAYS_PARALLEL, RAYS_FREE };
    unit = ldexp(1, (int)below(9) - 4);
    ray_case c = { .kind = kinds[below(3)], .precision = precision, .scene = lattice_scene() };
    const uint32_t groups = GLINT_TILE_GROUPS / 4, n = groups * GLINT_GROUP;
    c.camera = (glint_camera_args) { .group_count = groups, .groups_across = 4 };
    c.cast = (glint_cast_args) { .group_count = groups,
                                 .active = masks(groups),
                                 .geometry = &c.scene->table,
                                 .camera = c.kind == RAYS_OF_EYE ? &c.camera : NULL };
    if (c.kind == RAYS_OF_EYE) {
        look_along_lattice(&c);
    } else {
        input3(c.origin, real_kind(precision), n);
        input3(c.direction, real_kind(precision), n);
        shoot_lattice(&c);
    }
    memcpy(c.cast.origin, c.origin, sizeof c.cast.origin);
    memcpy(c.cast.direction, c.direction, sizeof c.cast.direction);
    cast_all(&c);
    end_rays(&c);
}

static void test_cast(void **state)
{
    (void)state;
    met = on_solids = 0;
    run_cases(CASES, 20000, cast_case);
    assert_true(met * case_step() > 10000 && on_solids * case_step() > 3000);
}

// ---- occlude -----------------------------------------------------------------------------------------------------

static uint64_t open_lanes, dark_lanes;

/// Places points on triangles, as surface does, and anywhere else, with view directions from anywhere.
static void place_points(glint_occlude_args *args, const test_scene *scene, int precision, uint32_t *prim,
                         const void *slack)
{
    const double share = precision == GLINT_PRECISION_DOUBLE ? GLINT_POINT_SLACK_DOUBLE : GLINT_POINT_SLACK_FLOAT;
    double point[3], ray[3];
    for (uint32_t i = 0; i < args->group_count * GLINT_GROUP; i++) {
        const uint32_t on = below(scene->table.prim_count);
        const bool is_on = one_in(2) && scene->prims[on].kind == GLINT_PRIM_TRIANGLE;
        prim[i] = is_on ? on : GLINT_MISS;
        lattice3(point);
        lattice_way(ray);
        if (is_on)
            place_on(&scene->prims[on], point);
        put3(args->point, precision, i, point);
        put3(args->direction, precision, i, ray);
        put(slack, precision, i, is_on ? share * 5 * REACH * unit : 0);
    }
}

static void occlude_case(int precision, bool odd)
{
    (void)odd;
    unit = ldexp(1, (int)below(9) - 4);
    test_scene *scene = lattice_scene();
    const uint32_t groups = 1 + below(GLINT_TILE_GROUPS / 4), n = groups * GLINT_GROUP;
    uint32_t *prim = input(KIND_U32, n);
    glint_occlude_args args = { .group_count = groups,
                                .sample_count = 1,
                                .directional = one_in(3),
                                .scale = 1,
                                .geometry = &scene->table,
                                .prim = prim,
                                .back = masks(groups),
                                .slack = input(real_kind(precision), n) };
    args.lit[0] = masks(groups);
    lattice_way(args.position);
    if (one_in(3)) // moves the point off a plane by a tiny amount
        args.position[below(3)] += either_sign(unit * power_of_ten(-17, -12));
    if (!args.directional)
        args.scale = ldexp(1, -ilogb(length3(args.position)));
    input3(args.point, real_kind(precision), n);
    input3(args.direction, real_kind(precision), n);
    place_points(&args, scene, precision, prim, args.slack);
    FOR_EACH_TESTED
    {
        uint64_t rays = 0;
        args.rays = &rays;
        args.unoccluded[0] = output("open", KIND_U16, groups);
        geometry(precision)->occlude(&args);
        compare_outputs("occlude");
    }
    const uint16_t *open = array_elements(wanted_array("open"));
    for (uint32_t g = 0; g < groups; g++) {
        open_lanes += (unsigned)__builtin_popcount(open[g]);
        dark_lanes += (unsigned)__builtin_popcount(args.lit[0][g] & ~(unsigned)open[g]);
    }
    free_scene(scene);
}

static void test_occlude(void **state)
{
    (void)state;
    open_lanes = dark_lanes = 0;
    run_cases(CASES, 30000, occlude_case);
    assert_true(open_lanes * case_step() > 10000 && dark_lanes * case_step() > 10000);
}

int main(void)
{
    find_tested();
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_cast), cmocka_unit_test(test_occlude) };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    print_skipped();
    return failed;
}
