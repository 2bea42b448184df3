/// Stages of derivatives: every instruction set against the scalar reference, with some or all inputs varying.
#include "tests/engine/cases/stage_case.h"

#define CASES 6000

static glint_dual number(bool sloped, double a, double b) { return dual(between(a, b), sloped && !one_in(3) ? between(-2, 2) : 0); }

static double *sixteen(double a, double b)
{
    double *row = input(KIND_DOUBLE, GLINT_GROUP);
    for (int i = 0; i < GLINT_GROUP; i++)
        row[i] = one_in(8) ? floor(between(a, b)) : between(a, b);
    return row;
}

/// Makes unit vectors, some along axes. Some equal the vectors `like` or their opposites.
static void units(const double *out[3], const double *const like[3])
{
    double *row[3];
    for (int c = 0; c < 3; c++)
        out[c] = row[c] = input(KIND_DOUBLE, GLINT_GROUP);
    for (int i = 0; i < GLINT_GROUP; i++) {
        const bool same = like && one_in(5), along = one_in(6);
        const double side = one_in(2) ? 1 : -1;
        const int axis = (int)below(3);
        double v[3];
        random_unit(v);
        for (int c = 0; c < 3; c++)
            row[c][i] = same ? side * like[c][i] : along ? (c == axis ? side : 0) : v[c];
    }
}

static void any_points(bool bent, glint_derivative_points *out)
{
    *out = (glint_derivative_points) { .slope = { { NULL } } };
    for (int c = 0; c < 3; c++)
        out->point[c] = sixteen(-3, 3);
    units(out->eye, NULL);
    units(out->normal, out->eye);
    for (int i = 0; i < 9 && bent; i++)
        out->slope[i / 3][i % 3] = sixteen(-2, 2);
}

static glint_derivative_light any_light(bool turned, bool other)
{
    glint_derivative_light light = { .directional = one_in(4), .is_spot = one_in(3) };
    light.attenuated = !light.directional && one_in(2);
    for (int c = 0; c < 3; c++) {
        light.position[c] = number(turned, -1, 1);
        light.axis[c] = number(turned, -1, 1);
        light.coefficients[c] = number(other, 0.1, 1);
        light.diffuse[c] = number(other, 0, 2);
        light.specular[c] = number(other, 0, 2);
    }
    light.outer = number(other, -1, 1);
    light.inverse = one_in(4) ? dual(HUGE_VAL, 0) : number(other, 1, 10);
    light.exponent = one_in(2) ? dual(0, 0) : number(other, 0, 20);
    light.turns = turned;
    light.shines = other;
    light.varies = turned || other;
    return light;
}

/// Chooses a light position that is away from all points.
static void any_source(const glint_derivative_points *points, const glint_derivative_light *light, glint_derivative_source *out)
{
    *out = (glint_derivative_source) { .weight = one_in(3) ? sixteen(0, 1) : NULL, .radiant = !light->directional && one_in(3) };
    out->both = out->radiant && one_in(2);
    units(out->position, points->normal);
    units(out->normal, NULL);
    for (int c = 0; c < 3 && !light->directional; c++) {
        double *row = input(KIND_DOUBLE, GLINT_GROUP);
        for (int i = 0; i < GLINT_GROUP; i++)
            row[i] = points->point[c][i] + (one_in(2) ? 4 : 1) * out->position[c][i];
        out->position[c] = row;
    }
    const bool tinted = one_in(4);
    for (int c = 0; c < 3 && tinted; c++) {
        out->tint[c] = sixteen(0, 1);
        out->tint_slope[c] = sixteen(-1, 1);
    }
}

static glint_derivative_material any_material(bool other)
{
    glint_derivative_material m = { .varies = other, .highlight = below(4) };
    m.lobe = m.highlight == GLINT_HIGHLIGHT_FACETS ? GLINT_LOBE_GGX + below(2) : below(2);
    for (int c = 0; c < 3; c++) {
        m.diffuse[c] = number(other, 0, 1);
        m.specular[c] = number(other, 0, 1);
        m.grazing[c] = number(other, 0, 1);
    }
    m.shininess = one_in(6) ? dual(0, 0) : number(other, 0, 200);
    m.alpha = number(other, 0.001, 1);
    return m;
}

static void any_planes(glint_derivative_planes *out)
{
    *out = (glint_derivative_planes) { .value = { NULL } };
    for (int k = 0; k < GLINT_DERIVED_COUNT; k++) {
        const int first = k < GLINT_DERIVED_SHININESS ? k / 3 * 3 : k; // all channels of a colour vary, or none
        const double most = k == GLINT_DERIVED_SHININESS ? 200 : 1;
        if (k == first ? !one_in(2) : !out->value[first])
            continue;
        out->value[k] = sixteen(k == GLINT_DERIVED_ALPHA ? 0.5 : 0, most);
        out->slope[k] = one_in(2) ? sixteen(-1, 1) : NULL;
    }
}

/// Turns -0 into 0, because both signs are the same derivative.
static void drop_signs(double *row)
{
    for (int i = 0; i < GLINT_GROUP; i++)
        row[i] += 0.0;
}

static void any_three(bool sloped, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = sloped && !one_in(4) ? between(-2, 2) : 0;
}

/// Buffers for hits on a moving sphere or plane, or hits seen by a moving eye.
typedef struct any_bend_buffers {
    glint_prim prim;
    glint_derivative_part part;
    glint_derivative_view view;
    glint_bend_camera camera;
    double normal[4];
} any_bend_buffers;

static glint_bend_args any_bend(const glint_derivative_points *points, any_bend_buffers *buffers)
{
    const bool along = one_in(2), sees = along || !one_in(3), moves = !sees || one_in(2), round = one_in(2);
    buffers->prim = (glint_prim) { .kind = round ? GLINT_PRIM_SPHERE : GLINT_PRIM_PLANE,
                                   .center = { between(-1, 1), 2, between(-1, 1) } };
    if (round) {
        buffers->prim.radius = between(0.1, 3);
    } else {
        random_unit(buffers->normal);
        buffers->prim.normal = buffers->normal;
    }
    buffers->part = (glint_derivative_part) { .moves = moves, .growth = moves && round ? between(-1, 1) : 0 };
    any_three(moves, buffers->part.position);
    any_three(moves && !round, buffers->part.normal);
    any_three(!round, buffers->part.pivot);
    buffers->view = (glint_derivative_view) { .moves = sees, .nearer = along ? between(-1, 1) : 0 };
    buffers->camera =
        (glint_bend_camera) { .near = along && one_in(2) ? between(0, 1) : 0, .orthographic = along && one_in(2) };
    any_three(true, buffers->camera.eye);
    random_unit(buffers->camera.forward);
    random_across(buffers->camera.forward, buffers->camera.right);
    cross3(buffers->camera.right, buffers->camera.forward, buffers->camera.up);
    any_three(sees, buffers->view.eye);
    any_three(sees, buffers->view.forward);
    any_three(sees, buffers->view.right);
    any_three(sees, buffers->view.up);
    for (int c = 0; c < 3; c++)
        any_three(sees, buffers->camera.turn[c]);
    glint_bend_args args = { .points = points,
                             .prim = &buffers->prim,
                             .part = &buffers->part,
                             .view = &buffers->view,
                             .camera = &buffers->camera };
    for (int c = 0; c < 3 && along; c++) {
        args.screen[c % 2] = sixteen(-4, 4);
        args.shift[c] = sixteen(-1, 1);
        args.shift_slope[c] = sixteen(-1, 1);
    }
    return args;
}

static void slope_case(int precision, bool odd)
{
    (void)precision;
    const bool bent = one_in(2), turned = one_in(3), other = one_in(3), painted = odd && one_in(2), weighs = one_in(3);
    glint_derivative_points points;
    glint_derivative_source source;
    glint_derivative_planes planes;
    any_points(bent, &points);
    const glint_derivative_light light = any_light(turned, other);
    const glint_derivative_material material = any_material(other && one_in(2));
    any_source(&points, &light, &source);
    any_planes(&planes);
    const double *before = sixteen(-1, 1);
    glint_slope_args args = { &light, &material, painted ? &planes : NULL, &points, &source, .lanes = random_mask() };
    FOR_EACH_TESTED
    {
        for (int c = 0; c < 3; c++) {
            args.sum[c] = memcpy(output("sum", KIND_DOUBLE, GLINT_GROUP), before, GLINT_GROUP * sizeof *before);
            args.whole[c] = weighs ? memcpy(output("whole", KIND_DOUBLE, GLINT_GROUP), before, GLINT_GROUP * sizeof *before) : NULL;
        }
        running->slope(&args);
        compare_outputs("slope");
    }
}

static void test_slope(void **state)
{
    (void)state;
    run_cases(CASES, 71000, slope_case);
}

static void arrival_case(int precision, bool odd)
{
    (void)precision;
    const bool bent = one_in(2), turned = one_in(2), sloped = !odd || one_in(2), valued = !sloped || one_in(2);
    glint_derivative_points points;
    glint_derivative_source source;
    any_points(bent, &points);
    const glint_derivative_light light = any_light(turned, one_in(2));
    any_source(&points, &light, &source);
    glint_arrival_args args = { &light, &points, &source, .value = { NULL } };
    FOR_EACH_TESTED
    {
        for (int k = 0; k < GLINT_ARRIVAL_COUNT; k++) {
            args.value[k] = valued ? output("value", KIND_DOUBLE, GLINT_GROUP) : NULL;
            args.slope[k] = sloped ? output("slope", KIND_DOUBLE, GLINT_GROUP) : NULL;
        }
        running->arrival(&args);
        for (int k = 0; k < GLINT_ARRIVAL_COUNT; k++) {
            if (sloped)
                drop_signs(args.slope[k]);
        }
        compare_outputs("arrival");
    }
}

static void test_arrival(void **state)
{
    (void)state;
    run_cases(CASES, 72000, arrival_case);
}

static void eyes_case(int precision, bool odd)
{
    (void)precision;
    double *rows[2];
    for (int k = 0; k < 2; k++) {
        rows[k] = input(KIND_DOUBLE, 3 * GLINT_GROUP);
        for (int i = 0; i < 3 * GLINT_GROUP; i++)
            rows[k][i] = maybe_odd(odd, between(-2, 2));
    }
    glint_eyes_args args = { .direction = rows[0], .more = one_in(2) ? rows[1] : NULL };
    FOR_EACH_TESTED
    {
        for (int c = 0; c < 3; c++)
            args.eye[c] = output("eye", KIND_DOUBLE, GLINT_GROUP);
        running->eyes(&args);
        compare_outputs("eyes");
    }
}

static void test_eyes(void **state)
{
    (void)state;
    run_cases(CASES / 10, 73000, eyes_case);
}

static void bend_case(int precision, bool odd)
{
    (void)precision;
    (void)odd;
    any_bend_buffers buffers = { .normal = { 0 } };
    glint_derivative_points points;
    any_points(false, &points);
    glint_bend_args args = any_bend(&points, &buffers);
    FOR_EACH_TESTED
    {
        double *rows = output("slope", KIND_DOUBLE, 9 * GLINT_GROUP);
        for (int k = 0; k < 9; k++)
            args.slope[k / 3][k % 3] = rows + k * GLINT_GROUP;
        running->bend(&args);
        for (int k = 0; k < 9; k++)
            drop_signs(rows + (size_t)k * GLINT_GROUP);
        compare_outputs("bend");
    }
}

static void test_bend(void **state)
{
    (void)state;
    run_cases(CASES, 74000, bend_case);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slope),
        cmocka_unit_test(test_arrival),
        cmocka_unit_test(test_eyes),
        cmocka_unit_test(test_bend),
    };
    find_tested();
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    print_skipped();
    return failed;
}
