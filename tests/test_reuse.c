/// Random edits of a scene, one after the other: the frame that reuses what it can must have the bits of a fresh one.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "engine/glint.h"

#define SHAPES 6
#define LIGHTS 3

static uint64_t state;

static uint32_t draw(uint32_t below)
{
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)((state >> 33) % below);
}

static double uniform(double low, double high)
{
    return low + (high - low) * (draw(1u << 30) / (double)(1u << 30));
}

typedef struct world {
    glint_scene *scene;
    glint_camera *camera;
    glint_material *materials[SHAPES];
    glint_shape *shapes[SHAPES];
    bool in_scene[SHAPES];
    glint_light *lights[LIGHTS];
    bool shining[LIGHTS];
    glint_render_desc render;
} world;

static void random_color(double c[3])
{
    for (int i = 0; i < 3; i++)
        c[i] = draw(4) ? uniform(0, 1) : 0;
}

static void edit_material(world *w)
{
    glint_material *material = w->materials[draw(SHAPES)];
    glint_material_desc d = *glint_material_get(material);
    switch (draw(6)) {
    case 0: random_color(d.diffuse); break;
    case 1: random_color(d.specular); break;
    case 2: d.shininess = draw(5) ? uniform(0, 300) : 0; break;
    case 3: d.model = (glint_model)draw(3); break;
    case 4: d.has_ambient = draw(2); random_color(d.ambient); break;
    default: d.specular[0] = d.specular[1] = d.specular[2] = 0; break;
    }
    assert_int_equal(glint_material_set(material, &d, NULL), GLINT_OK);
}

static void edit_light(world *w)
{
    uint32_t i = draw(LIGHTS);
    glint_light_desc d = *glint_light_get(w->lights[i]);
    switch (draw(9)) {
    case 0: d.intensity = draw(4) ? uniform(0, 2) : 0; break;
    case 1: random_color(d.color); break;
    case 2: d.shadows = !d.shadows; break;
    case 3: d.attenuation[1] = draw(2) ? uniform(0, 0.2) : 0; break;
    case 4: d.has_specular = draw(2); random_color(d.specular); break;
    case 5: random_color(d.ambient); break;
    case 6:
        if (w->shining[i])
            glint_scene_remove_light(w->scene, w->lights[i], NULL);
        else
            glint_scene_add_light(w->scene, w->lights[i], NULL);
        w->shining[i] = !w->shining[i];
        break;
    default:
        for (int c = 0; c < 3; c++) {
            d.position[c] = uniform(-6, 6);
            d.direction[c] = uniform(-1, 1);
        }
    }
    assert_int_equal(glint_light_set(w->lights[i], &d, NULL), GLINT_OK);
}

static void edit_shape(world *w)
{
    uint32_t i = draw(SHAPES);
    glint_shape_desc d = *glint_shape_get(w->shapes[i]);
    switch (draw(6)) {
    case 0: d.radius = uniform(0.2, 2); break;
    case 1: d.material = w->materials[draw(SHAPES)]; break;
    case 2: d.two_sided = !d.two_sided; break;
    case 3:
        if (w->in_scene[i])
            glint_scene_remove_shape(w->scene, w->shapes[i], NULL);
        else
            glint_scene_add_shape(w->scene, w->shapes[i], NULL);
        w->in_scene[i] = !w->in_scene[i];
        break;
    default:
        for (int c = 0; c < 3; c++)
            d.center[c] = d.point[c] = uniform(-3, 3);
    }
    assert_int_equal(glint_shape_set(w->shapes[i], &d, NULL), GLINT_OK);
}

static void edit_frame(world *w)
{
    glint_camera_desc c = *glint_camera_get(w->camera);
    glint_scene_desc s = *glint_scene_get(w->scene);
    switch (draw(9)) {
    case 0: c.eye[draw(3)] += uniform(-1, 1); break;
    case 1: c.projection = (glint_projection)draw(2); break;
    case 2: c.fov_y_rad = uniform(0.3, 2); break;
    case 3: random_color(s.ambient); break;
    case 4: random_color(s.background); break;
    case 5: w->render.samples = 1 + draw(4); break;
    case 6: w->render.precision = (glint_precision)draw(2); break;
    case 7: w->render.passes = draw(1u << GLINT_PASS_COUNT) | 1; break;
    default: w->render.seed = draw(3); break;
    }
    assert_int_equal(glint_camera_set(w->camera, &c, NULL), GLINT_OK);
    assert_int_equal(glint_scene_set(w->scene, &s, NULL), GLINT_OK);
}

static void make_world(world *w)
{
    memset(w, 0, sizeof *w);
    glint_camera_desc c = glint_camera_desc_default();
    c.eye[1] = 2;
    assert_int_equal(glint_camera_create(&c, &w->camera, NULL), GLINT_OK);
    assert_int_equal(glint_scene_create(&w->scene, NULL), GLINT_OK);
    glint_scene_desc s = { .camera = w->camera, .ambient = { 0.1, 0.1, 0.1 } };
    assert_int_equal(glint_scene_set(w->scene, &s, NULL), GLINT_OK);
    for (int i = 0; i < SHAPES; i++) {
        glint_material_desc m = glint_material_desc_default();
        random_color(m.diffuse);
        random_color(m.specular);
        assert_int_equal(glint_material_create(&m, &w->materials[i], NULL), GLINT_OK);
        glint_shape_desc d = glint_shape_desc_default(i == 0 ? GLINT_SHAPE_PLANE : GLINT_SHAPE_SPHERE);
        d.material = w->materials[i];
        d.point[1] = -2;
        for (int k = 0; k < 3; k++)
            d.center[k] = uniform(-2, 2);
        assert_int_equal(glint_shape_create(&d, &w->shapes[i], NULL), GLINT_OK);
        assert_int_equal(glint_scene_add_shape(w->scene, w->shapes[i], NULL), GLINT_OK);
        w->in_scene[i] = true;
    }
    for (int i = 0; i < LIGHTS; i++) {
        glint_light_desc d = glint_light_desc_default(i == 2 ? GLINT_LIGHT_DIRECTIONAL : GLINT_LIGHT_POINT);
        d.position[1] = 5;
        d.position[0] = i;
        assert_int_equal(glint_light_create(&d, &w->lights[i], NULL), GLINT_OK);
        assert_int_equal(glint_scene_add_light(w->scene, w->lights[i], NULL), GLINT_OK);
        w->shining[i] = true;
    }
    w->render = glint_render_desc_default();
    w->render.width = 70;
    w->render.height = 50;
}

static void free_world(world *w)
{
    for (int i = 0; i < SHAPES; i++) {
        glint_material_release(w->materials[i]);
        glint_shape_release(w->shapes[i]);
    }
    for (int i = 0; i < LIGHTS; i++)
        glint_light_release(w->lights[i]);
    glint_camera_release(w->camera);
    glint_scene_release(w->scene);
}

static bool same_pixels(const glint_image *a, const glint_image *b, uint32_t passes)
{
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++) {
        if (!(passes >> pass & 1))
            continue;
        for (int y = 0; y < glint_image_height(a); y++)
            for (int x = 0; x < glint_image_width(a); x++) {
                float p[3], q[3];
                glint_image_pixel(a, (glint_pass)pass, x, y, p, NULL);
                glint_image_pixel(b, (glint_pass)pass, x, y, q, NULL);
                if (memcmp(p, q, sizeof p))
                    return false;
            }
    }
    return true;
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

/// Renders after each of many edits with two renderers, one of which forgets everything.
static void edits(size_t memory, int threads, double limit_s)
{
    world w;
    glint_renderer *reusing, *fresh;
    glint_renderer_desc desc = glint_renderer_desc_default();
    desc.threads = threads;
    desc.reuse_memory = memory;
    assert_int_equal(glint_renderer_create(&desc, &reusing, NULL), GLINT_OK);
    desc.no_reuse = true;
    assert_int_equal(glint_renderer_create(&desc, &fresh, NULL), GLINT_OK);
    make_world(&w);
    const double start = seconds();
    uint64_t reused = 0, edit = 0;
    void (*const kinds[])(world *) = { edit_material, edit_material, edit_light, edit_light, edit_shape, edit_frame };
    for (; seconds() - start < limit_s; edit++) {
        if (draw(8)) // now and then nothing changes
            kinds[draw(edit % 4 ? 4 : 6)](&w);
        glint_plan *plan;
        glint_image *a, *b;
        glint_frame_stats stats;
        assert_int_equal(glint_plan_create(w.scene, &w.render, &plan, NULL), GLINT_OK);
        assert_int_equal(glint_render(reusing, plan, &a, &stats, NULL), GLINT_OK);
        assert_int_equal(glint_render(fresh, plan, &b, NULL, NULL), GLINT_OK);
        for (int i = 0; i < stats.stage_count; i++)
            reused += stats.stage_reused[i] > 0;
        if (!same_pixels(a, b, w.render.passes))
            fail_msg("edit %llu: the reused frame differs from the fresh one", (unsigned long long)edit);
        glint_image_release(a);
        glint_image_release(b);
        glint_plan_destroy(plan);
    }
    print_message("%llu edits, %llu stage results reused\n", (unsigned long long)edit, (unsigned long long)reused);
    assert_true(memory > 0 || reused > edit / 2);
    free_world(&w);
    glint_renderer_destroy(reusing);
    glint_renderer_destroy(fresh);
}

static double limit_s(double usual)
{
    const char *soak = getenv("GLINT_SOAK_SECONDS");
    return soak ? atof(soak) / 3 : usual;
}

static void reused_equals_fresh(void **unused)
{
    (void)unused;
    state = 1;
    edits(0, 2, limit_s(4));
}

static void reused_equals_fresh_without_memory(void **unused)
{
    (void)unused;
    state = 2;
    edits(1, 2, limit_s(1));
}

static void reused_equals_fresh_with_little_memory(void **unused)
{
    (void)unused;
    state = 3;
    for (size_t memory = 20000; memory < 4000000; memory = memory * 3 / 2)
        edits(memory, 8, limit_s(2) / 14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reused_equals_fresh),
        cmocka_unit_test(reused_equals_fresh_without_memory),
        cmocka_unit_test(reused_equals_fresh_with_little_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
