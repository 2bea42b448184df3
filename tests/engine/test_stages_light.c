/// light, view and facet on every instruction set against the scalar reference, and the accuracy of their logarithm.
#include "tests/engine/cases/stage_case.h"

#define ALIGNED _Alignas(64)

enum { CASES = 300 };

// ---- light -------------------------------------------------------------------------------------------------------

static glint_shade_material materials[6];

/// Makes points, normals, materials and masks of unlit lanes, as surface leaves them: groups without a hit hold
/// anything; in the other groups, lanes without a hit hold zeros.
static void make_points(glint_light_args *args, int precision, bool odd, double size)
{
    uint32_t n = args->group_count * GLINT_GROUP;
    uint32_t *material = input(KIND_U32, n);
    uint16_t *dark = masks(args->group_count);
    args->material = material;
    args->dark = dark;
    for (uint32_t g = 0; g < args->group_count; g++)
        dark[g] = one_in(3) ? dark[g] & args->hits[g] : 0;
    input3(args->point, real_kind(precision), n);
    input3(args->normal, real_kind(precision), n);
    input3(args->direction, real_kind(precision), n);
    bool grazing = one_in(3);
    for (uint32_t i = 0; i < n; i++) {
        double direction[3], normal[3] = { 0 }, point[3] = { 0 };
        random_unit(direction);
        bool hit = lane_of(args->hits, i);
        if (hit) {
            random_unit(normal);
            for (int c = 0; c < 3; c++) {
                point[c] = maybe_odd(odd, one_in(20) ? args->position[c] : size * between(-1, 1));
                normal[c] = maybe_odd(odd, grazing ? normal[c] * power_of_ten(-30, 0) : normal[c]);
                direction[c] *= power_of_ten(-2, 2);
            }
            uint32_t facing = below(10); // the light is at the eye, or straight behind the point
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
        material[i] = hit ? below(COUNT_OF(materials)) : 0;
    }
}

/// The directions of a perspective camera, stored as column and row parts.
static void make_camera(glint_camera_args *camera, int precision, bool odd)
{
    const uint32_t across = 1 + below(GLINT_TILE_WIDTH / 4), down = 1 + below(GLINT_TILE_HEIGHT / 4);
    *camera = (glint_camera_args) { .group_count = across * down, .groups_across = across };
    camera->across = input(real_kind(precision), 3 * across * GLINT_GROUP);
    camera->down = input(real_kind(precision), 3 * down * GLINT_GROUP);
    for (uint32_t i = 0; i < 3 * across * GLINT_GROUP; i++)
        put(camera->across, precision, i, maybe_odd(odd, between(-1, 1)));
    for (uint32_t i = 0; i < 3 * down * GLINT_GROUP; i++)
        put(camera->down, precision, i, maybe_odd(odd, between(-1, 1)));
}

static void place_light(glint_light_args *args, double distance)
{
    args->directional = one_in(3);
    const bool near = fabs(log2(distance)) < 16 && one_in(2); // distances close enough to 1 for a scale of 1
    args->scale = args->directional || near ? 1 : ldexp(1, -ilogb(distance));
    args->attenuated = one_in(2);
    args->highlights = !one_in(4);
    random_unit(args->position);
    for (int c = 0; c < 3; c++) {
        args->position[c] *= args->directional ? 1 : distance;
        args->coefficients[c] = one_in(4) ? 0 : power_of_ten(-3, 2);
    }
}

/// The cone of a spot light that points roughly at the middle. Its axis and edges sometimes pass through points.
static void make_spot(glint_light_args *args, glint_spot *spot)
{
    const double inner = cos(between(0, 3)), outer = one_in(4) ? inner : fmin(inner, cos(between(0, 3.2)));
    *spot = (glint_spot) { .outer = outer,
                           .inverse = inner > outer ? 1 / (inner - outer) : HUGE_VAL,
                           .exponent = one_in(2) ? 0 : (float)power_of_ten(-2, 3) };
    random_unit(spot->axis);
    for (int c = 0; c < 3 && one_in(2); c++)
        spot->axis[c] = -args->position[c] / length3(args->position);
    args->spot = spot;
    args->directional = false;
    args->attenuated = true;
}

/// Chooses each lane's sample position in the cone, sometimes at the cone's axis or edge.
static void make_cone(glint_light_sample *light_sample)
{
    for (int lane = 0; lane < GLINT_GROUP; lane++) {
        const double angle = between(0, 6.3);
        light_sample->position[0][lane] = one_in(20) ? 0 : one_in(20) ? 1 : between(0, 1);
        light_sample->position[1][lane] = cos(angle);
        light_sample->position[2][lane] = sin(angle);
    }
}

/// Samples of an area light around the light's position, of any size.
static void make_lamps(glint_light_args *args, glint_light_sample *lamps, double radius)
{
    args->sample_count = 1 + below(GLINT_LIGHT_CHUNK);
    args->directional = false;
    const uint32_t emission = below(GLINT_EMIT_CONE + 1);
    args->attenuated = args->attenuated || emission >= GLINT_EMIT_RADIANT_FRONT;
    for (uint32_t s = 0; s < args->sample_count; s++) {
        lamps[s] = (glint_light_sample) { .emission = emission, .radius = radius };
        memcpy(lamps[s].center, args->position, sizeof lamps[s].center);
        for (int lane = 0; lane < GLINT_GROUP; lane++) {
            double out[3];
            random_unit(out);
            for (int c = 0; c < 3; c++) {
                lamps[s].position[c][lane] = args->position[c] + radius * out[c];
                lamps[s].normal[c][lane] = out[c];
            }
        }
        if (emission == GLINT_EMIT_CONE)
            make_cone(&lamps[s]);
        args->light_sample[s] = &lamps[s];
    }
}

/// Makes several lights that differ only in their positions.
static void make_alike(glint_light_args *args, double (*place)[3])
{
    args->sample_count = 1 + below(GLINT_LIGHT_CHUNK);
    for (uint32_t s = 0; s < args->sample_count; s++) {
        random_unit(place[s]);
        for (int c = 0; c < 3 && !args->directional; c++)
            place[s][c] *= length3(args->position) * power_of_ten(-1, 1);
        memcpy(place[s], s ? place[s] : args->position, sizeof place[s]);
        args->positions[s] = place[s];
    }
}

/// Makes a light's arguments without outputs. Returns the number of lanes.
static uint32_t make_light_case(glint_light_args *args, glint_camera_args *camera, glint_spot *spot, int precision,
                                bool odd)
{
    static glint_light_sample lamps[GLINT_LIGHT_CHUNK];
    static double place[GLINT_LIGHT_CHUNK][3];
    *args =
        (glint_light_args) { .sample_count = 1, .group_count = 1 + below(GLINT_TILE_GROUPS), .materials = materials };
    const double size = power_of_ten(-4, 6);
    for (uint32_t i = 0; i < COUNT_OF(materials); i++)
        materials[i] = (glint_shade_material) { .highlight = below(4), .least = one_in(3) ? 0 : (float)between(0, 1) };
    args->sparing = one_in(2);
    if (one_in(2)) {
        make_camera(camera, precision, odd);
        args->camera = camera;
        args->group_count = camera->group_count;
    }
    place_light(args, size * power_of_ten(-3, 3));
    if (one_in(3))
        make_spot(args, spot);
    else if (one_in(2))
        make_lamps(args, lamps, size * power_of_ten(-4, 2));
    else if (one_in(2))
        make_alike(args, place);
    args->hits = masks(args->group_count);
    make_points(args, precision, odd, size);
    return args->group_count * GLINT_GROUP;
}

static void light_case(int precision, bool odd)
{
    glint_light_args args;
    glint_camera_args camera;
    glint_spot spot;
    const uint32_t n = make_light_case(&args, &camera, &spot, precision, odd);
    FOR_EACH_TESTED
    {
        for (uint32_t s = 0; s < args.sample_count; s++) {
            args.lit[s] = output("lit", KIND_U16, args.group_count);
            args.cosine[s] = output("cosine", KIND_FLOAT, n);
            args.attenuation[s] = output("attenuation", KIND_FLOAT, n);
            args.log2_specular[s] = output("log2_specular", KIND_FLOAT, n);
            args.brightest[s] = output("brightest", KIND_FLOAT, 1);
        }
        geometry(precision)->light(&args);
        compare_outputs("light");
    }
}

/// Tests view and facet at such points, with random masks of the lanes that the light reaches.
static void facet_case(int precision, bool odd)
{
    glint_light_args args, *light = &args;
    glint_camera_args camera;
    glint_spot spot;
    const uint32_t n = make_light_case(light, &camera, &spot, precision, odd);
    glint_view_args view = { .group_count = light->group_count, .hits = light->hits, .camera = light->camera };
    glint_facet_args facet = { .group_count = light->group_count,
                               .camera = light->camera,
                               .material = light->material,
                               .materials = materials,
                               .directional = light->directional,
                               .scale = light->scale,
                               .sample_count = light->sample_count };
    for (int c = 0; c < 3; c++) {
        facet.position[c] = light->position[c];
        facet.point[c] = light->point[c];
        facet.normal[c] = view.normal[c] = light->normal[c];
        facet.direction[c] = view.direction[c] = light->direction[c];
    }
    for (uint32_t s = 0; s < light->sample_count; s++) {
        uint16_t *lit = masks(light->group_count);
        for (uint32_t g = 0; g < light->group_count; g++)
            lit[g] &= light->hits[g];
        facet.light_sample[s] = light->light_sample[s];
        facet.lit[s] = lit;
    }
    FOR_EACH_TESTED
    {
        view.facing = output("facing", KIND_FLOAT, n);
        geometry(precision)->view(&view);
        for (uint32_t s = 0; s < light->sample_count; s++) {
            facet.sine2[s] = output("sine2", KIND_FLOAT, n);
            facet.schlick[s] = output("schlick", KIND_FLOAT, n);
        }
        geometry(precision)->facet(&facet);
        compare_outputs("view and facet");
    }
}

static void test_light(void **state)
{
    (void)state;
    run_cases(3 * CASES, 8000, light_case);
}

static void test_facet(void **state)
{
    (void)state;
    run_cases(3 * CASES, 9000, facet_case);
}

// ---- elementary functions ----------------------------------------------------------------------------------------

/// The error of `got` in ulps of `want` as a float.
static double ulps(float got, long double want)
{
    if (want == 0)
        return got == 0 ? 0 : HUGE_VAL;
    return fabs((double)(((long double)got - want) / ldexpl(1, ilogbl(want) - 23)));
}

/// Largest possible error in float ulps, a sum of these errors. Near 1: 1 from rounding f to float, 0.7 from the last
/// sum of the polynomial, 0.2 from the terms before it, 0.5 from the last product, 0.34 from the polynomial itself.
/// Below 1, where the error is largest just under sqrt(1/2): 1.02 from rounding x to float, 0.5 from the last sum,
/// and 0.87 from the other errors, which belong to numbers half as large.
#define MAX_ULP_LOG2 2.75

/// log2 through light: with normal and light along z and the ray (1, 0, -s), Phong's x is s^2 / (1 + s^2).
static double log2_error(int precision, uint32_t n, const double *s)
{
    static ALIGNED uint16_t all[GLINT_TILE_GROUPS], none[GLINT_TILE_GROUPS], lit[GLINT_TILE_GROUPS];
    static ALIGNED uint32_t zero[GLINT_TILE_SAMPLES];
    static ALIGNED float cosine[GLINT_TILE_SAMPLES], log2_specular[GLINT_TILE_SAMPLES];
    memset(all, 0xff, sizeof all);
    const glint_shade_material phong = { .highlight = GLINT_HIGHLIGHT_PHONG };
    glint_light_args args = { .group_count = n / GLINT_GROUP,
                              .hits = all,
                              .material = zero,
                              .materials = &phong,
                              .dark = none,
                              .directional = true,
                              .position = { 0, 0, 1 },
                              .scale = 1,
                              .sample_count = 1,
                              .highlights = true,
                              .lit = { lit },
                              .cosine = { cosine },
                              .log2_specular = { log2_specular } };
    input3(args.point, real_kind(precision), n);
    input3(args.normal, real_kind(precision), n);
    input3(args.direction, real_kind(precision), n);
    const double origin[3] = { 0 }, up[3] = { 0, 0, 1 };
    for (uint32_t i = 0; i < n; i++) {
        const double direction[3] = { 1, 0, -s[i] };
        put3(args.point, precision, i, origin);
        put3(args.normal, precision, i, up);
        put3(args.direction, precision, i, direction);
    }
    geometry(precision)->light(&args);
    double worst = 0;
    for (uint32_t i = 0; i < n; i++) {
        float s_f = (float)s[i], x_f = s_f * s_f / (1 + s_f * s_f);
        double x = s[i] * s[i] / (1 + s[i] * s[i]);
        worst = fmax(worst, ulps(2 * log2_specular[i], log2l(precision == GLINT_PRECISION_DOUBLE ? x : (double)x_f)));
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
                fmax(log2_error(GLINT_PRECISION_DOUBLE, GLINT_TILE_SAMPLES, s), log2_error(GLINT_PRECISION_FLOAT, GLINT_TILE_SAMPLES, s));
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
        cmocka_unit_test(test_light),
        cmocka_unit_test(test_facet),
        cmocka_unit_test(test_log2_accuracy),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    print_skipped();
    return failed;
}
