/// occlude and soft_light on every instruction set against the scalar reference, which tests every primitive for
/// every point: neither the BVH, nor a tile's list of occluders, nor a filter loses or adds a shadow.
#include "engine/render/geometry/geometry.h"
#include "tests/engine/cases/stage_scene.h"

enum { CASES = 3000 };

/// The primitives and the light of a case.
typedef enum shadow_kind {
    SHADOWS, ///< any primitives and any light
    SHADOWS_OF_SMALL, ///< mostly small spheres
    SHADOWS_IN_LAYERS ///< many primitives between an area light and distant points that are close together
} shadow_kind;

typedef struct shadow_case {
    int precision;
    shadow_kind kind;
    scene_plan plan;
    test_scene *scene;
    glint_occlude_args args;
    uint32_t *prim;
    uint16_t *back;
    void *slack;
    bool soft; ///< whether the light is an area light
    bool cone; ///< whether each point has its own samples, inside a cone
} shadow_case;

// ---- Lights and points -------------------------------------------------------------------------------------------

/// Places the light inside the scene, around it, far away, or at infinity. Returns its distance from the middle.
static double place_light(shadow_case *c)
{
    const double size = c->plan.size;
    const bool apart = c->kind == SHADOWS_IN_LAYERS;
    const double distance =
        size * (apart ? between(2, 8) : one_in(3) ? between(0, 1) : one_in(3) ? power_of_ten(1, 12) : between(1, 10));
    double direction[3];
    random_unit(direction);
    if (one_in(4)) {
        memset(direction, 0, sizeof direction);
        direction[below(3)] = either_sign(1);
    }
    c->args.scale = 1;
    c->args.directional = !apart && one_in(3);
    if (c->args.directional) {
        memcpy(c->args.position, direction, sizeof direction);
        return size;
    }
    c->args.scale = ldexp(1, -ilogb(distance));
    along3(c->plan.middle, distance, direction, c->args.position);
    return distance;
}

static glint_light_sample lamps[GLINT_LIGHT_CHUNK];

/// Places sample s of a lane on the light, or in its cone.
static void place_sample(const shadow_case *c, const double axis[3], double radius, uint32_t s, int lane)
{
    double out[3];
    if (axis)
        random_across(axis, out);
    else
        random_unit(out);
    for (int k = 0; k < 3; k++)
        lamps[s].position[k][lane] = c->args.position[k] + radius * out[k];
    if (!c->cone)
        return;
    const double angle = between(0, 6.3);
    lamps[s].position[0][lane] = one_in(20) ? below(2) : between(0, 1);
    lamps[s].position[1][lane] = cos(angle);
    lamps[s].position[2][lane] = sin(angle);
}

/// Turns the light into an area light: a ball or a planar disk of any size.
static void place_lamps(shadow_case *c, double distance)
{
    const bool apart = c->kind == SHADOWS_IN_LAYERS;
    c->cone = !apart && (case_seed >> 4) % 3 == 0; // chosen by the seed, independently of precision and odd
    const double radius = !c->cone && one_in(8) ? 0 : distance * (apart ? power_of_ten(-3, -0.3) : power_of_ten(-6, 0.5));
    const bool flat = !c->cone && one_in(2);
    double axis[3], lower[3], upper[3];
    random_unit(axis);
    c->soft = true;
    c->args.directional = false;
    c->args.sample_count = 1 + below(GLINT_LIGHT_CHUNK);
    for (int k = 0; k < 3; k++) {
        lower[k] = c->args.position[k] - (c->cone ? radius : 0);
        upper[k] = c->args.position[k] + (c->cone ? radius : 0);
    }
    for (uint32_t s = 0; s < c->args.sample_count; s++)
        for (int lane = 0; lane < GLINT_GROUP; lane++) {
            place_sample(c, flat ? axis : NULL, radius, s, lane);
            for (int k = 0; k < 3 && !c->cone; k++) {
                lower[k] = fmin(lower[k], lamps[s].position[k][lane]);
                upper[k] = fmax(upper[k], lamps[s].position[k][lane]);
            }
        }
    for (uint32_t s = 0; s < c->args.sample_count; s++) {
        memcpy(lamps[s].lower, lower, sizeof lower);
        memcpy(lamps[s].upper, upper, sizeof upper);
        memcpy(lamps[s].center, c->args.position, sizeof lamps[s].center);
        lamps[s].radius = radius;
        lamps[s].emission = c->cone ? GLINT_EMIT_CONE : GLINT_EMIT_ALL;
        c->args.light_sample[s] = &lamps[s];
    }
}

/// Places the points of a tile. They are usually close together;
/// otherwise the tile's shaft would contain half the scene.
static void place_points(shadow_case *c, double light_distance)
{
    const scene_plan *plan = &c->plan;
    const bool apart = c->kind == SHADOWS_IN_LAYERS;
    const double width = plan->size * (apart ? power_of_ten(-3, -0.5) : one_in(3) ? 1 : power_of_ten(-6, 0));
    const double deep = apart ? 0.5 : one_in(8) ? 100 : 1;
    double near[3], point[3];
    for (int k = 0; k < 3; k++)
        near[k] = plan->middle[k] + deep * plan->size * between(-1, 1);
    for (uint32_t i = 0; i < c->args.group_count * GLINT_GROUP; i++) {
        for (int k = 0; k < 3; k++) {
            point[k] = near[k] + width * between(-1, 1);
            put(c->args.point[k], c->precision, i, point[k]);
            point[k] = get(c->args.point[k], c->precision, i);
        }
        if (c->plan.line_count == MOST_LINES || !one_in(3))
            continue;
        double way[3];
        for (int k = 0; k < 3; k++)
            way[k] = c->args.position[k] - (c->args.directional ? 0 : point[k]);
        const double length = length3(way);
        if (length > 0 && isfinite(length))
            add_line(&c->plan, point, way, c->args.directional ? light_distance : length);
    }
    if (c->plan.line_count == 0)
        add_line(&c->plan, plan->middle, (const double[3]) { 0, 0, 1 }, plan->size);
}

/// Places a point on a triangle, and stores the point's rounding error, as surface does.
static void place_on_triangle(shadow_case *c, uint32_t i, const glint_prim *prim)
{
    const double slack = c->precision == GLINT_PRECISION_DOUBLE ? GLINT_POINT_SLACK_DOUBLE : GLINT_POINT_SLACK_FLOAT;
    const double u = one_in(6) ? below(2) : between(0, 1), v = (1 - u) * (one_in(6) ? below(2) : between(0, 1));
    double point[3], f = 0, g = 0, far = 0;
    for (int k = 0; k < 3; k++) {
        const double along = prim->corner[1][k] - prim->corner[0][k], across = prim->corner[2][k] - prim->corner[0][k];
        point[k] = prim->corner[0][k] + (u * along + v * across);
        f = fmax(f, fabs(along));
        g = fmax(g, fabs(across));
        far = fmax(far, fabs(point[k]));
    }
    put3(c->args.point, c->precision, i, point);
    put(c->slack, c->precision, i, slack * ((f + g) + far));
}

/// Restores the position of a point that moved far away, perhaps beyond the light.
static void keep_near(shadow_case *c, uint32_t i, const double was[3])
{
    double off[3];
    for (int k = 0; k < 3; k++)
        off[k] = get(c->args.point[k], c->precision, i) - c->plan.middle[k];
    if (c->kind != SHADOWS_IN_LAYERS || length3(off) < c->plan.size)
        return;
    put3(c->args.point, c->precision, i, was);
    c->prim[i] = GLINT_MISS;
    c->back[i / GLINT_GROUP] &= (uint16_t) ~(1u << i % GLINT_GROUP);
}

/// Moves a point onto a primitive, or marks the point as being on no primitive that could shadow it. The larger
/// `few`, the fewer primitives get points.
static void place_on_surface(shadow_case *c, uint32_t i, uint32_t few)
{
    const test_scene *scene = c->scene;
    double out[3], point[3];
    c->prim[i] = below(one_in(4) ? scene->table.prim_count : (few + scene->table.prim_count) / (few + 1));
    const glint_prim *prim = &scene->prims[c->prim[i]];
    if (one_in(3)) {
        c->back[i / GLINT_GROUP] &= (uint16_t) ~(1u << i % GLINT_GROUP);
        if (prim->kind == GLINT_PRIM_TRIANGLE || prim->kind == GLINT_PRIM_SOLID)
            c->prim[i] = GLINT_MISS; // the self-shadowing rules of triangles and solids depend on the point's position
        return;
    }
    if (prim->kind == GLINT_PRIM_TRIANGLE) {
        place_on_triangle(c, i, prim);
        return;
    }
    if (prim->kind == GLINT_PRIM_SOLID) {
        place_on_solid(scene, prim, point);
    } else if (prim->kind == GLINT_PRIM_SPHERE) {
        random_unit(out);
        along3(prim->center, prim->radius, out, point);
    } else {
        random_across(prim->normal, out);
        along3(prim->center, c->plan.size * between(-1, 1), out, point);
    }
    put3(c->args.point, c->precision, i, point);
}

/// Moves some points onto their primitive. The other points are on no primitive that could shadow them.
static void place_on_surfaces(shadow_case *c)
{
    const uint32_t few = below(4);
    for (uint32_t i = 0; i < c->args.group_count * GLINT_GROUP; i++) {
        double was[3];
        for (int k = 0; k < 3; k++)
            was[k] = get(c->args.point[k], c->precision, i);
        place_on_surface(c, i, few);
        keep_near(c, i, was);
    }
}

// ---- occlude -----------------------------------------------------------------------------------------------------

/// Replaces most primitives by small spheres at the same positions.
static void shrink(shadow_case *c)
{
    uint32_t left = below(2) * below(GLINT_GRID_OTHERS);
    for (uint32_t i = 0; i < c->scene->table.prim_count; i++) {
        glint_prim *prim = &c->scene->prims[i];
        const double small = c->plan.size * power_of_ten(-4, -1.5);
        double center[3];
        if (prim->kind == GLINT_PRIM_PLANE || (prim->kind == GLINT_PRIM_SPHERE && prim->radius < small) || (left && left--))
            continue;
        memcpy(center, prim->kind == GLINT_PRIM_TRIANGLE ? prim->corner[0] : prim->center, sizeof center);
        set_sphere(prim, center, small);
    }
    free_scene(c->scene);
    finish_scene(&c->plan, c->scene);
}

static void start_shadows(shadow_case *c, int precision, bool odd, shadow_kind kind)
{
    memset(c, 0, sizeof *c);
    c->precision = precision;
    c->kind = kind;
    random_place(&c->plan, precision == GLINT_PRECISION_DOUBLE); // avoids points where float overflows
    const uint32_t groups = c->args.group_count = 1 + below(GLINT_TILE_GROUPS), n = groups * GLINT_GROUP;
    c->args.sample_count = 1;
    c->args.prim = c->prim = input(KIND_U32, n);
    c->args.back = c->back = masks(groups);
    for (uint32_t g = 0; g < groups; g++)
        c->back[g] = one_in(2) ? 0 : c->back[g];
    if (kind == SHADOWS_IN_LAYERS) {
        c->plan.count = 30 + below(300);
        c->plan.spread = one_in(4) ? 0.5 : between(2, 4);
    }
    // In float, rounding can produce hits on distant triangles and solids that the BVH would not test.
    c->plan.triangles = precision == GLINT_PRECISION_DOUBLE && !odd && one_in(2);
    c->plan.solids = precision == GLINT_PRECISION_DOUBLE && !odd && one_in(3);
    input3(c->args.point, real_kind(precision), n);
    input3(c->args.direction, real_kind(precision), n);
    input3(c->args.normal, real_kind(precision), n);
    c->args.slack = c->slack = input(real_kind(precision), n);
    for (uint32_t i = 0; i < n; i++) {
        double way[3];
        random_unit(way);
        put3(c->args.direction, precision, i, way);
        put3(c->args.normal, precision, i, (const double[3]) { way[1], -way[2], way[0] });
        put(c->slack, precision, i, one_in(2) ? 0 : -1e-15 * length3(c->plan.middle));
    }
    const double distance = place_light(c);
    if (kind == SHADOWS_IN_LAYERS || (!c->args.directional && one_in(2)))
        place_lamps(c, distance);
    for (uint32_t s = 0; s < c->args.sample_count; s++)
        c->args.lit[s] = masks(groups);
    place_points(c, distance);
    c->scene = random_scene(&c->plan);
    if (kind == SHADOWS_OF_SMALL)
        shrink(c);
    c->args.geometry = &c->scene->table;
    place_on_surfaces(c);
}

static uint64_t lit_lanes(const shadow_case *c)
{
    uint64_t lanes = 0;
    for (uint32_t s = 0; s < c->args.sample_count; s++)
        for (uint32_t g = 0; g < c->args.group_count; g++)
            lanes += (unsigned)__builtin_popcount(c->args.lit[s][g]);
    return lanes;
}

static bool is_triangle(const shadow_case *c, uint32_t prim)
{
    return prim != GLINT_MISS && c->scene->prims[prim].kind == GLINT_PRIM_TRIANGLE;
}

/// Makes a box as surface gives it: around the points that the light reaches, or around all points.
static void make_box(const shadow_case *c, glint_point_box *box)
{
    *box = (glint_point_box) { { HUGE_VAL, HUGE_VAL, HUGE_VAL }, { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL }, GLINT_MISS };
    const bool all = one_in(2);
    bool several = false;
    for (uint32_t i = 0; i < c->args.group_count * GLINT_GROUP; i++) {
        bool lit = all;
        for (uint32_t s = 0; s < c->args.sample_count; s++)
            lit = lit || lane_of(c->args.lit[s], i);
        if (!lit)
            continue;
        several = several || lane_of(c->back, i) || is_triangle(c, c->prim[i]) ||
                  (box->only != GLINT_MISS && box->only != c->prim[i]);
        box->only = c->prim[i];
        for (int k = 0; k < 3; k++) {
            const double x = get(c->args.point[k], c->precision, i);
            box->lower[k] = x < box->lower[k] ? x : box->lower[k];
            box->upper[k] = x > box->upper[k] ? x : box->upper[k];
        }
    }
    if (several)
        box->only = GLINT_MISS;
}

static uint32_t settled; ///< number of cases in which the area light as a whole decided some lanes without rays
static uint32_t gridded; ///< number of cases in which the light had a grid

/// Creates the grid of a light without samples, if it can have one.
static glint_light_grid *make_grid(const shadow_case *c)
{
    static uint32_t calls;
    glint_light_grid *grid = NULL;
    glint_error error;
    // a small limit gives wider cells, or no grid
    const size_t max_bytes = calls++ % 3 ? SIZE_MAX : (size_t)c->scene->table.prim_count * 40;
    if (!c->soft)
        assert_int_equal(
            glint_light_grid_create(&c->scene->table, c->args.directional, c->args.position, max_bytes, &grid, &error),
            GLINT_OK);
    gridded += grid != NULL;
    if (grid) {
        const size_t cells = (size_t)grid->count[0] * grid->count[1];
        assert_true(cells * sizeof(uint32_t) + grid->begin[cells] * 3 * sizeof(uint32_t) <= max_bytes);
    }
    return grid;
}

static void occlude_all(shadow_case *c)
{
    static _Alignas(64) unsigned char scratch[GLINT_OCCLUDE_SCRATCH];
    glint_occlude_args args = c->args;
    glint_point_box box;
    make_box(c, &box);
    args.box = one_in(2) ? &box : NULL;
    glint_light_grid *grid = make_grid(c);
    args.grid = grid;
    args.scratch = c->kind == SHADOWS_IN_LAYERS || one_in(2) ? scratch : NULL;
    FOR_EACH_TESTED
    {
        uint64_t rays = 5;
        args.rays = &rays;
        for (uint32_t s = 0; s < args.sample_count; s++)
            args.unoccluded[s] = output("open", KIND_U16, args.group_count);
        geometry(c->precision)->occlude(&args);
        if (c->soft) // lanes that the whole light decides count no rays
            settled += running != &glint_stages_ref && rays < lit_lanes(c) + 5;
        else
            *(double *)output("rays", KIND_DOUBLE, 1) = (double)rays;
        assert_true(rays <= lit_lanes(c) + 5);
        compare_outputs("occlude");
    }
    glint_light_grid_destroy(grid);
}

/// Counts of unoccluded and shadowed lanes: a useful test needs both.
static uint32_t open_lanes, dark_lanes;

static void count_lanes(const shadow_case *c)
{
    const uint16_t *open = array_elements(wanted_array("open"));
    for (uint32_t g = 0; g < c->args.group_count; g++) {
        open_lanes += (unsigned)__builtin_popcount(open[g]);
        dark_lanes += (unsigned)__builtin_popcount(c->args.lit[0][g] & ~(unsigned)open[g]);
    }
}

// ---- soft_light --------------------------------------------------------------------------------------------------

static uint64_t summed, highlights; ///< number of lanes that the light reached, and of those lanes with a highlight

static void count_sums(const glint_light_args *light)
{
    const uint16_t *reached = array_elements(wanted_array("reached"));
    const float *specular = light->highlights ? array_elements(wanted_array("specular")) : NULL;
    for (uint32_t i = 0; i < light->group_count * GLINT_GROUP; i++) {
        summed += lane_of(reached, i);
        highlights += specular && lane_of(reached, i) && specular[i] > 0;
    }
}

/// Chooses random normals and rays; most of them face the light.
static void look_at_points(const shadow_case *c, glint_light_args *light, bool odd)
{
    const uint32_t n = light->group_count * GLINT_GROUP;
    uint32_t *material = input(KIND_U32, n);
    light->material = material;
    input3(light->normal, real_kind(c->precision), n);
    input3(light->direction, real_kind(c->precision), n);
    const uint32_t one = below(6);
    for (uint32_t i = 0; i < n; i++) {
        double normal[3], direction[3], way[3];
        for (int k = 0; k < 3; k++)
            way[k] = c->args.position[k] - get(light->point[k], c->precision, i);
        const double length = length3(way);
        random_unit(normal);
        random_unit(direction);
        for (int k = 0; k < 3; k++) {
            if (length > 0 && i % 3)
                normal[k] = 0.3 * normal[k] + way[k] / length;
            if (length > 0 && i % 5)
                direction[k] = 0.4 * direction[k] - way[k] / length;
            normal[k] = maybe_odd(odd, normal[k]);
            direction[k] = maybe_odd(odd, direction[k] * 3);
        }
        put3(light->normal, c->precision, i, normal);
        put3(light->direction, c->precision, i, direction);
        material[i] = one_in(4) ? below(6) : one;
    }
}

static void make_gloss(glint_shade_material materials[6])
{
    for (int m = 0; m < 6; m++)
        materials[m] = (glint_shade_material) { .highlight = below(GLINT_HIGHLIGHT_FACETS),
                                                .lobe = below(GLINT_LOBE_POWER_COSINE + 1),
                                                .shininess = one_in(6) ? 0 : (float)power_of_ten(-1, 5),
                                                .least = one_in(3) ? 0 : (float)between(0, 1) };
}

static const glint_point_box *hit_box(const shadow_case *c, const uint16_t *hits, glint_point_box *box)
{
    shadow_case hit = *c;
    hit.args.lit[0] = hits;
    hit.args.sample_count = 1;
    make_box(&hit, box);
    return box;
}

static void soft_light_all(const shadow_case *c, bool odd)
{
    static const uint32_t emissions[] = { GLINT_EMIT_ALL,   GLINT_EMIT_ALL,           GLINT_EMIT_ALL,
                                          GLINT_EMIT_FRONT, GLINT_EMIT_RADIANT_FRONT, GLINT_EMIT_RADIANT_BOTH };
    const uint32_t groups = c->args.group_count;
    const uint32_t emission = c->cone ? GLINT_EMIT_CONE : emissions[below(COUNT_OF(emissions))];
    glint_shade_material materials[6];
    glint_light_args light = { .group_count = groups,
                               .hits = masks(groups),
                               .dark = masks(groups),
                               .materials = materials,
                               .scale = c->args.scale,
                               .sample_count = c->args.sample_count,
                               .attenuated = one_in(2) || emission >= GLINT_EMIT_RADIANT_FRONT,
                               .coefficients = { 1, 0.1, 0.01 },
                               .highlights = !one_in(4),
                               .sparing = one_in(2) };
    glint_occlude_args occlude = c->args;
    glint_point_box box;
    make_gloss(materials);
    for (uint32_t s = 0; s < light.sample_count; s++) {
        lamps[s].emission = emission;
        light.light_sample[s] = &lamps[s];
        for (int lane = 0; lane < GLINT_GROUP; lane++) {
            double out[3];
            random_unit(out);
            for (int k = 0; k < 3; k++)
                lamps[s].normal[k][lane] = out[k];
        }
        occlude.lit[s] = light.hits;
    }
    for (uint32_t g = 0; g < groups; g++)
        ((uint16_t *)light.dark)[g] &= (uint16_t)(random_bits() & light.hits[g]);
    memcpy(light.point, c->args.point, sizeof light.point);
    look_at_points(c, &light, odd);
    for (int k = 0; k < 3 && c->cone; k++)
        light.normal[k] = c->args.normal[k];
    occlude.box = one_in(2) ? hit_box(c, light.hits, &box) : NULL;
    const bool shadows = !one_in(9);
    FOR_EACH_TESTED
    {
        uint64_t rays = 0;
        occlude.rays = &rays;
        const glint_soft_args args = { .light = &light,
                                       .occlude = shadows ? &occlude : NULL,
                                       .reached = output("reached", KIND_U16, groups),
                                       .diffuse = output("diffuse", KIND_FLOAT, groups * GLINT_GROUP),
                                       .specular = output("specular", KIND_FLOAT, groups * GLINT_GROUP) };
        if (geometry(c->precision)->soft_light(&args))
            compare_outputs("soft_light");
        else
            free_arrays(gotten, &gotten_count); // the case has too many occluders
        assert_true(rays <= (uint64_t)groups * GLINT_GROUP * light.sample_count);
    }
    count_sums(&light);
}

static void soft_light_case(int precision, bool odd)
{
    shadow_case c;
    start_shadows(&c, precision, odd, SHADOWS);
    if (c.soft)
        soft_light_all(&c, odd);
    free_scene(c.scene);
}

static void test_soft_light(void **state)
{
    (void)state;
    summed = highlights = 0;
    run_cases(CASES, 900000, soft_light_case);
    assert_true(summed * case_step() > 10000 && highlights * case_step() > 1000);
}

static void occlude_case(int precision, bool odd)
{
    shadow_case c;
    start_shadows(&c, precision, odd, SHADOWS);
    for (uint32_t i = 0; odd && i < c.args.group_count * GLINT_GROUP; i++)
        for (int k = 0; k < 3 && one_in(8); k++) {
            c.back[i / GLINT_GROUP] &= (uint16_t) ~(1u << i % GLINT_GROUP); // the point is no longer on a primitive
            put(c.args.point[k], precision, i, odd_number());
        }
    occlude_all(&c);
    count_lanes(&c);
    free_scene(c.scene);
}

static void test_occlude(void **state)
{
    (void)state;
    open_lanes = dark_lanes = 0;
    run_cases(CASES, 9000, occlude_case);
    assert_true(open_lanes * case_step() > 10000 && dark_lanes * case_step() > 10000);
    assert_true(settled * case_step() > 100);
}

/// Tests many small spheres and a few other surfaces, where the kernel uses the grid and double precision decides.
static void occlude_grid_case(int precision, bool odd)
{
    shadow_case c;
    (void)precision;
    start_shadows(&c, GLINT_PRECISION_DOUBLE, odd, SHADOWS_OF_SMALL);
    occlude_all(&c);
    count_lanes(&c);
    free_scene(c.scene);
}

static void test_occlude_grid(void **state)
{
    (void)state;
    gridded = open_lanes = dark_lanes = 0;
    run_cases(CASES, 300000, occlude_grid_case);
    assert_true(gridded * case_step() > 200);
    assert_true(open_lanes * case_step() > 10000 && dark_lanes * case_step() > 10000);
}

/// Tests area lights behind more occluders than a list can hold.
static void occlude_layers_case(int precision, bool odd)
{
    shadow_case c;
    (void)precision;
    start_shadows(&c, GLINT_PRECISION_DOUBLE, odd, SHADOWS_IN_LAYERS);
    occlude_all(&c);
    count_lanes(&c);
    free_scene(c.scene);
}

static void test_occlude_layers(void **state)
{
    (void)state;
    open_lanes = dark_lanes = 0;
    run_cases(CASES / 3, 600000, occlude_layers_case);
    assert_true(open_lanes * case_step() > 2000 && dark_lanes * case_step() > 10000); // these cases have many occluders
}

/// Cases that failed in the past.
static void test_occlude_found(void **state)
{
    static const struct {
        uint64_t seed;
        glint_precision precision;
        bool odd;
    } found[] = {
        // a triangle as small as 30 rounding errors: a point that counts as on it is outside the triangle's box
        { 1021078, GLINT_PRECISION_DOUBLE, false },
        // a point with a position that is not finite made its cell forget the extent of the cell's other points
        { 3012971, GLINT_PRECISION_FLOAT, true },
        { 3038036, GLINT_PRECISION_DOUBLE, true },
    };
    (void)state;
    mismatches = 0;
    for (uint32_t i = 0; i < COUNT_OF(found); i++) {
        random_state = case_seed = found[i].seed;
        occlude_case(found[i].precision, found[i].odd);
        end_case();
    }
    assert_int_equal(mismatches, 0);
}

int main(void)
{
    find_tested();
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_occlude), cmocka_unit_test(test_occlude_grid),
                                        cmocka_unit_test(test_occlude_layers),
                                        cmocka_unit_test(test_occlude_found),
                                        cmocka_unit_test(test_soft_light) };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    print_skipped();
    return failed;
}
