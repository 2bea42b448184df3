/// The table that a background is sampled by: its density integrates to 1, drawn directions follow it, and the mean of
/// brightness / density is the sky's integral. Also skies that have no table.
#include <math.h>
#include <stdlib.h>

#include "engine/base/sequence.h"
#include "engine/render/effects/environment/plan.h"
#include "engine/render/effects/environment/sky.h"
#include "engine/render/program/program.h"
#include "tests/engine/cases/builder_case.h"

#define PI 3.14159265358979323846

// ---- Skies ----

static const double SPOT[3] = { -0.48, 0.6, 0.64 }; // a direction

static double dot(const double a[3], const double b[3]) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }

/// Returns the program max(d . SPOT - cosine, 0) + rest.
static glint_program *spot(double cosine, double rest)
{
    begin_program(GLINT_PROGRAM_PATTERN);
    glint_value value = num(-cosine);
    for (int c = 0; c < 3; c++) {
        const glint_value part = op(GLINT_OP_MUL, in((glint_input)(GLINT_INPUT_P_X + c)), num(SPOT[c]), 0);
        value = op(GLINT_OP_ADD, part, value, 0);
    }
    value = op(GLINT_OP_ADD, op(GLINT_OP_MAX, value, num(0), 0), num(rest), 0);
    return end_program(&value, 1);
}

/// Returns the program of a black picture with one texel of brightness 1 in all three channels.
static glint_program *texel(int width, int height, int x, int y, glint_filter filter)
{
    glint_value color[4];
    glint_texture *texture;
    uint8_t *rgb = calloc((size_t)width * (size_t)height, 3);
    assert_non_null(rgb);
    for (int c = 0; c < 3; c++)
        rgb[3 * (y * width + x) + c] = 255;
    const glint_texture_desc desc = { .struct_size = sizeof(glint_texture_desc), .rgb = rgb, .width = width, .height = height, .wrap = GLINT_WRAP_AROUND, .filter = filter };
    OK(glint_texture_create(&desc, &texture, &error));
    begin_program(GLINT_PROGRAM_PATTERN);
    OK(glint_builder_texel(builder, texture, in(GLINT_INPUT_UV_U), in(GLINT_INPUT_UV_V), num(0), color, &error));
    glint_program *out = end_program(color, 3);
    glint_texture_release(texture);
    free(rgb);
    return out;
}

/// Makes the plan of a matt ball under a sky. Releases the program.
static glint_plan *plan_of(glint_program *sky, bool indirect)
{
    glint_scene *scene;
    glint_material *material;
    glint_shape *shape;
    glint_plan *plan;
    glint_camera_desc camera = glint_camera_desc_default();
    glint_material_desc matt = glint_material_desc_default();
    glint_shape_desc ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    glint_scene_desc desc = { .struct_size = sizeof(glint_scene_desc), .background_program = sky, .has_indirect = indirect, .indirect_samples = 4, .indirect_bounces = 1 };
    const glint_render_desc render = glint_render_desc_default();
    OK(glint_camera_create(&camera, &desc.camera, &error));
    OK(glint_material_create(&matt, &material, &error));
    ball.material = material;
    OK(glint_shape_create(&ball, &shape, &error));
    OK(glint_scene_create(&scene, &error));
    OK(glint_scene_set(scene, &desc, &error));
    OK(glint_scene_add_shape(scene, shape, &error));
    OK(glint_plan_create(scene, &render, &plan, &error));
    glint_camera_release(desc.camera);
    glint_material_release(material);
    glint_shape_release(shape);
    glint_scene_release(scene);
    glint_program_release(sky);
    return plan;
}

// ---- Properties of the table ----

/// Returns the integral of the density over the sphere, by the midpoints of a grid finer than the table's.
static double integral_of(const glint_sky *sky, int width)
{
    const int height = width / 2;
    double sum = 0;
    for (int j = 0; j < height; j++) {
        const double above = cos(PI * j / height), below = cos(PI * (j + 1) / height), y = (above + below) / 2;
        for (int i = 0; i < width; i++) {
            const double angle = 2 * PI * ((i + 0.5) / width - 0.5), r = sqrt(1 - y * y);
            const double d[3] = { r * sin(angle), y, -r * cos(angle) };
            sum += glint_sky_density(sky, d) * (above - below) * (2 * PI / width);
        }
    }
    return sum;
}

/// Returns the brightness of a direction by the plan's own program.
static double brightness_of(const glint_plan *plan, const double d[3])
{
    double in[GLINT_INPUT_COUNT] = { 0 }, out[GLINT_PROGRAM_OUTPUTS_MAX] = { 0 };
    for (int c = 0; c < 3; c++)
        in[GLINT_INPUT_P_X + c] = d[c];
    in[GLINT_INPUT_UV_U] = 0.5 + atan2(d[0], -d[2]) / (2 * PI);
    in[GLINT_INPUT_UV_V] = acos(fmin(fmax(-d[1], -1), 1)) / PI;
    OK(glint_program_evaluate(plan->environment->program, in, out, &error));
    return out[0];
}

/// Returns the mean of brightness / density over drawn directions, and the largest such value.
static double estimate_of(const glint_plan *plan, int count, double *most)
{
    double sum = 0;
    *most = 0;
    for (int k = 0; k < count; k++) {
        double u[2], d[3];
        glint_sequence_scrambled((uint32_t)k, 1, u);
        glint_sky_draw(plan->sky, u, d);
        assert_true(fabs(dot(d, d) - 1) < 1e-14);
        const double density = glint_sky_density(plan->sky, d);
        assert_true(density > 0);
        const double value = brightness_of(plan, d) / density;
        sum += value;
        *most = fmax(*most, value);
    }
    return sum / count;
}

/// Checks the properties. width: a multiple of the table's width. integral: of the sky's brightness.
static void check_sky(glint_program *program, int width, double integral, double relative)
{
    double most;
    glint_plan *plan = plan_of(program, true);
    assert_non_null(plan->sky);
    assert_true(fabs(integral_of(plan->sky, width) - 1) < 1e-9);
    const double estimate = estimate_of(plan, 1 << 12, &most);
    if (!(fabs(estimate / integral - 1) < relative))
        fail_msg("%.9g instead of %.9g", estimate, integral);
    if (!(most < 8 * integral)) // no direction weighs more than its cell explains
        fail_msg("a direction weighs %.9g of %.9g", most, integral);
    glint_plan_destroy(plan);
}

/// The integral of (cos - c) over a cap is pi (1 - c)^2.
static void formulas(void **state)
{
    (void)state;
    for (double cosine = 0.5; cosine < 0.99999; cosine = (cosine + 3) / 4)
        check_sky(spot(cosine, 0), 1024, PI * (1 - cosine) * (1 - cosine), 0.01);
    check_sky(spot(0.9, 1e-4), 1024, PI * 0.01 + 4 * PI * 1e-4, 0.01);
}

/// The tent of a texel has the width of two texels; the integral of a tent of base 2a around t times sin t is
/// 2 sin t (1 - cos a) / a.
static double tent(int width, int height, int y)
{
    const double a = PI / height;
    return 2 * PI / width * (2 * sin((y + 0.5) * a) * (1 - cos(a)) / a);
}

static void texels(void **state)
{
    (void)state;
    check_sky(texel(64, 32, 20, 9, GLINT_FILTER_BILINEAR), 1024, tent(64, 32, 9), 0.002);
    check_sky(texel(64, 32, 0, 16, GLINT_FILTER_BILINEAR), 1024, tent(64, 32, 16), 0.002); // across the seam
    check_sky(texel(512, 256, 100, 250, GLINT_FILTER_BILINEAR), 1024, tent(512, 256, 250), 0.002);
    check_sky(texel(1024, 512, 600, 200, GLINT_FILTER_BILINEAR), 2048, tent(1024, 512, 200), 0.005);
    check_sky(texel(1024, 512, 600, 200, GLINT_FILTER_NEAREST), 2048,
              2 * PI / 1024 * (cos(PI * 200 / 512) - cos(PI * 201 / 512)), 0.03);
}

/// Skies without a table: not called for, plain, nearly even, black.
static void none(void **state)
{
    (void)state;
    glint_plan *const plans[] = { plan_of(spot(0.9, 0), false), plan_of(spot(2, 0.5), true), plan_of(spot(-1, 0), true),
                                  plan_of(spot(2, 0), true) };
    for (size_t i = 0; i < sizeof plans / sizeof *plans; i++) {
        assert_null(plans[i]->sky);
        glint_plan_destroy(plans[i]);
    }
}

/// Plans of one program share a table, if their pixels are equally wide.
static void shared(void **state)
{
    (void)state;
    glint_program *program = spot(0.9, 0);
    glint_plan *a = plan_of(glint_program_retain(program), true), *b = plan_of(glint_program_retain(program), true);
    assert_non_null(a->sky);
    assert_ptr_equal(a->sky, b->sky);
    glint_program_release(program);
    glint_plan_destroy(a);
    assert_true(fabs(integral_of(b->sky, 1024) - 1) < 1e-9);
    glint_plan_destroy(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(formulas), cmocka_unit_test(texels), cmocka_unit_test(none),
                                        cmocka_unit_test(shared) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
