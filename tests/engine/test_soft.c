/// Area lights through the C API: the cost of their shadows, and identical pictures in every configuration.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <string.h>

#include "tests/engine/cases/floor_scene.h"

#define SIDE 48

/// A floor seen from above at an angle.
static glint_scene *make_slanted_floor(void) { return make_floor((double[3]) { 0, 8, 9 }, (double[3]) { 0, 0, 0 }); }

static bool visible; ///< whether the lights added next are visible

static void add_light(glint_scene *scene, glint_light_kind kind, double height, double radius, double samples)
{
    static const double square[4][3] = { { -1, 6, -1 }, { 1, 6, -1 }, { 1, 6, 1 }, { -1, 6, 1 } };
    glint_light_desc d = glint_light_desc_default(kind);
    glint_light *light;
    d.position[1] = height;
    d.radius = radius;
    d.samples = samples;
    d.visible = visible;
    d.vertices = square;
    d.vertex_count = 4;
    assert_int_equal(glint_light_create(&d, &light, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_light(scene, light, NULL), GLINT_OK);
    glint_light_release(light);
}

typedef struct setting {
    const char *isa;
    int threads;
    bool no_reuse;
    double samples; ///< samples per pixel
    glint_precision precision;
} setting;

static glint_image *render(const glint_scene *scene, setting set, glint_frame_stats *stats, glint_ray_counts *expected)
{
    glint_render_desc desc = glint_render_desc_default();
    glint_renderer_desc r = glint_renderer_desc_default();
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    desc.width = desc.height = SIDE;
    desc.samples = set.samples ? set.samples : 1;
    desc.precision = set.precision;
    r.isa = set.isa;
    r.threads = set.threads ? set.threads : 1;
    r.no_reuse = set.no_reuse;
    glint_status status = glint_renderer_create(&r, &renderer, NULL);
    if (status == GLINT_ERR_UNSUPPORTED)
        return NULL;
    assert_int_equal(status, GLINT_OK);
    assert_int_equal(glint_plan_create(scene, &desc, &plan, NULL), GLINT_OK);
    if (expected)
        *expected = glint_plan_expected_rays(plan);
    assert_int_equal(glint_render(renderer, plan, &image, stats, NULL), GLINT_OK);
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    return image;
}

static uint64_t shadow_rays(const glint_scene *scene)
{
    glint_frame_stats stats;
    glint_image_release(render(scene, (setting) { .no_reuse = true }, &stats, NULL));
    return stats.rays.shadow;
}

static void nothing_between_costs_no_rays(void **state)
{
    (void)state;
    glint_scene *scene = make_slanted_floor();
    add_light(scene, GLINT_LIGHT_SPHERE, 6, 0.5, 16);
    add_ball(scene, (double[3]) { 0, 20, 0 }, 1, 0); // a ball above the light
    assert_int_equal(shadow_rays(scene), 0);
    glint_scene_release(scene);
}

static void one_ball_hides_the_whole(void **state)
{
    (void)state;
    glint_scene *scene = make_slanted_floor();
    glint_frame_stats stats;
    add_light(scene, GLINT_LIGHT_SPHERE, 20, 0.5, 16);
    add_ball(scene, (double[3]) { 0, 15, 0 }, 4, 0); // a ball between the light and the whole visible floor
    glint_image *image = render(scene, (setting) { .no_reuse = true }, &stats, NULL);
    float black[3];
    assert_int_equal(glint_image_pixel(image, GLINT_PASS_BEAUTY, SIDE / 2, SIDE / 2, black, NULL), GLINT_OK);
    assert_true(black[0] == 0 && stats.rays.shadow < SIDE * SIDE);
    glint_image_release(image);
    glint_scene_release(scene);
}

static void rays_are_of_the_penumbra(void **state)
{
    (void)state;
    glint_scene *scene = make_slanted_floor();
    add_light(scene, GLINT_LIGHT_SPHERE, 6, 0.5, 64);
    add_ball(scene, (double[3]) { 1, 2, 0 }, 1, 0);
    const uint64_t rays = shadow_rays(scene);
    assert_true(rays > 0 && rays < (uint64_t)SIDE * SIDE * 64 / 3);
    glint_scene_release(scene);
}

static void point_like_lights_cost_one_ray(void **state)
{
    (void)state;
    const glint_light_kind kinds[] = { GLINT_LIGHT_POINT, GLINT_LIGHT_SPHERE, GLINT_LIGHT_DISK, GLINT_LIGHT_SPOT };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        glint_ray_counts expected;
        glint_frame_stats stats;
        glint_scene *scene = make_slanted_floor();
        add_light(scene, kinds[i], 6, 0, 16);
        glint_image_release(render(scene, (setting) { .no_reuse = true }, &stats, &expected));
        assert_int_equal(expected.shadow, SIDE * SIDE);
        glint_scene_release(scene);
    }
}

/// The reference has no BVH and resolves no shadows for whole groups or tiles.
static void every_way_gives_one_picture(void **state)
{
    (void)state;
    static const setting ways[] = {
        { .isa = "generic" }, { .isa = "avx2" }, { .isa = "avx512" }, { .threads = 3 }, { .no_reuse = true },
    };
    const glint_light_kind kinds[] = { GLINT_LIGHT_SPOT, GLINT_LIGHT_DISK, GLINT_LIGHT_POLYGON, GLINT_LIGHT_SPHERE };
    glint_scene *scene = make_slanted_floor();
    visible = true;
    for (int i = 0; i < 30; i++) // adds so many occluders that each group traverses the BVH separately
        add_ball(scene, (double[3]) { i % 6 - 2.5, 1 + 0.1 * i, i / 6 - 2 }, 0.3, 0);
    add_ball(scene, (double[3]) { 0, 6, 0 }, 1.2, 0); // a ball that contains some of the light's samples
    for (int precision = 0; precision < 2; precision++)
        for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
            add_light(scene, kinds[k], 5 + (double)k, 1, 19);
            setting set = { .isa = "ref", .samples = 2, .precision = (glint_precision)precision };
            glint_image *want = render(scene, set, NULL, NULL);
            for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
                set = ways[i];
                set.samples = 2;
                set.precision = (glint_precision)precision;
                glint_image *got = render(scene, set, NULL, NULL);
                if (got && differing(got, want))
                    fail_msg("kind %zu, way %zu: another picture", k, i);
                glint_image_release(got);
            }
            glint_image_release(want);
        }
    visible = false;
    glint_scene_release(scene);
}

static void bad_descriptions_are_refused(void **state)
{
    (void)state;
    glint_error error;
    glint_light *light;
    glint_light_desc d = glint_light_desc_default((glint_light_kind)17);
    assert_int_equal(glint_light_create(&d, &light, &error), GLINT_ERR_INVALID);
    d = glint_light_desc_default(GLINT_LIGHT_POLYGON);
    assert_int_equal(glint_light_create(&d, &light, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "vertices: 3 to 4096 corners expected, got 0");
    static const double corners[3][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1.0 / 0.0, 0 } };
    d.vertices = corners;
    d.vertex_count = 3;
    assert_int_equal(glint_light_create(&d, &light, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "vertices: corner 3: finite numbers expected, got {0, inf, 0}");
}

static void effects_are_those_called_for(void **state)
{
    (void)state;
    static const struct {
        glint_light_kind kind;
        const char *effect;
        bool soft;
    } lights[] = {
        { GLINT_LIGHT_SPOT, "spot light", false },      { GLINT_LIGHT_DISK, "disk light", true },
        { GLINT_LIGHT_POLYGON, "polygon light", true }, { GLINT_LIGHT_SPHERE, "sphere light", true },
        { GLINT_LIGHT_POINT, "point light", false },
    };
    for (size_t i = 0; i < sizeof lights / sizeof *lights; i++) {
        glint_scene *scene = make_slanted_floor();
        add_light(scene, lights[i].kind, 6, 1, 16);
        for (size_t k = 0; k < sizeof lights / sizeof *lights; k++)
            assert_int_equal(has_effect(scene, lights[k].effect), i == k);
        assert_int_equal(has_effect(scene, "soft shadow"), lights[i].soft);
        assert_int_equal(has_effect(scene, "hard shadow"), !lights[i].soft);
        assert_false(has_effect(scene, "visible light"));
        glint_scene_release(scene);
    }
}

static void stages_run(const glint_scene *scene, glint_frame_stats *stats, bool *visible_lights)
{
    *visible_lights = false;
    glint_image_release(render(scene, (setting) { .no_reuse = true }, stats, NULL));
    for (int i = 0; i < stats->stage_count; i++)
        *visible_lights = *visible_lights || strcmp(stats->stage_name[i], "visible_lights") == 0;
}

/// A light without a surface, without emission, or not set to visible, adds no effect.
static void lights_are_seen_where_called_for(void **state)
{
    (void)state;
    const struct {
        glint_light_kind kind;
        double radius;
        bool visible, seen;
    } cases[] = { { GLINT_LIGHT_SPHERE, 1, true, true },    { GLINT_LIGHT_DISK, 1, true, true },
                  { GLINT_LIGHT_POLYGON, 1, true, true },   { GLINT_LIGHT_SPHERE, 1, false, false },
                  { GLINT_LIGHT_SPHERE, 0, true, false },   { GLINT_LIGHT_POINT, 1, true, false },
                  { GLINT_LIGHT_SPOT, 1, true, false },     { GLINT_LIGHT_DIRECTIONAL, 1, true, false },
                  { GLINT_LIGHT_POLYGON, 1, false, false }, { GLINT_LIGHT_DISK, 0, true, false } };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        glint_scene *scene = make_slanted_floor();
        glint_frame_stats stats;
        bool visible_lights;
        visible = cases[i].visible;
        add_light(scene, cases[i].kind, 6, cases[i].radius, 4);
        visible = false;
        stages_run(scene, &stats, &visible_lights);
        assert_int_equal(visible_lights, cases[i].seen);
        assert_int_equal(has_effect(scene, "visible light"), cases[i].seen);
        glint_scene_release(scene);
    }
}

static void too_many_samples_are_refused(void **state)
{
    (void)state;
    glint_error error;
    glint_plan *plan;
    glint_render_desc desc = glint_render_desc_default();
    glint_scene *scene = make_slanted_floor();
    for (int i = 0; i < 2049; i++)
        add_light(scene, GLINT_LIGHT_SPHERE, 6, 1, 65536);
    assert_int_equal(glint_plan_create(scene, &desc, &plan, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "lights: at most 134217728 samples of all together expected, got 134283264");
    glint_scene_release(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_between_costs_no_rays),    cmocka_unit_test(one_ball_hides_the_whole),
        cmocka_unit_test(rays_are_of_the_penumbra),         cmocka_unit_test(point_like_lights_cost_one_ray),
        cmocka_unit_test(every_way_gives_one_picture),      cmocka_unit_test(bad_descriptions_are_refused),
        cmocka_unit_test(lights_are_seen_where_called_for), cmocka_unit_test(effects_are_those_called_for),
        cmocka_unit_test(too_many_samples_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
