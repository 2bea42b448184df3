/// Successive frames that differ in more than their objects: in the number of samples, the BVH order or the
/// background, or with more lights than the renderer caches. Each frame equals the same frame rendered afresh.
#include "engine/glint.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { LIGHTS = 70 }; // more lights than the renderer caches

typedef struct stand {
    glint_scene *scene;
    glint_camera *camera;
    glint_material *paint;
    glint_shape *ball;
    glint_light *lights[LIGHTS];
    glint_renderer *renderers[2]; ///< one renderer that reuses results, and one that does not
    glint_render_desc render;
} stand;

static void make_stand(stand *s, int lights)
{
    *s = (stand) { .render = glint_render_desc_default() };
    glint_camera_desc view = glint_camera_desc_default();
    glint_material_desc look = glint_material_desc_default();
    glint_mesh_desc mesh = glint_mesh_desc_default();
    const double middle[3] = { 0 };
    glint_renderer_desc desc = glint_renderer_desc_default();
    view.eye[2] = 4;
    s->render.width = s->render.height = 100;
    for (int c = 0; c < 3; c++)
        look.specular[c] = 1;
    look.shininess = 5;
    assert_int_equal(glint_scene_create(&s->scene, NULL), GLINT_OK);
    assert_int_equal(glint_camera_create(&view, &s->camera, NULL), GLINT_OK);
    assert_int_equal(glint_material_create(&look, &s->paint, NULL), GLINT_OK);
    mesh.material = s->paint;
    assert_int_equal(glint_sphere_mesh_create(middle, 1, 40, &mesh, &s->ball, NULL), GLINT_OK);
    glint_scene_desc whole = *glint_scene_get(s->scene);
    whole.struct_size = sizeof whole;
    whole.camera = s->camera;
    assert_int_equal(glint_scene_set(s->scene, &whole, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_shape(s->scene, s->ball, NULL), GLINT_OK);
    for (int i = 0; i < lights; i++) { // all lights except the last shine from behind
        glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_DIRECTIONAL);
        light.direction[0] = light.direction[1] = 0;
        light.direction[2] = i + 1 < lights ? 1 : -1;
        light.shadows = false;
        assert_int_equal(glint_light_create(&light, &s->lights[i], NULL), GLINT_OK);
        assert_int_equal(glint_scene_add_light(s->scene, s->lights[i], NULL), GLINT_OK);
    }
    for (int i = 0; i < 2; i++) {
        desc.no_reuse = i;
        assert_int_equal(glint_renderer_create(&desc, &s->renderers[i], NULL), GLINT_OK);
    }
}

static void free_stand(stand *s)
{
    for (int i = 0; i < 2; i++)
        glint_renderer_destroy(s->renderers[i]);
    for (int i = 0; i < LIGHTS; i++)
        glint_light_release(s->lights[i]);
    glint_material_release(s->paint);
    glint_shape_release(s->ball);
    glint_camera_release(s->camera);
    glint_scene_release(s->scene);
}

/// Renders the current scene with both renderers and compares every pixel. Returns the sum of all pixel values.
static double check(const stand *s)
{
    glint_plan *plan;
    glint_image *image[2];
    double sum = 0;
    assert_int_equal(glint_plan_create(s->scene, &s->render, &plan, NULL), GLINT_OK);
    for (int i = 0; i < 2; i++)
        assert_int_equal(glint_render(s->renderers[i], plan, &image[i], NULL, NULL), GLINT_OK);
    for (int y = 0; y < s->render.height; y++)
        for (int x = 0; x < s->render.width; x++) {
            float p[3], q[3];
            glint_image_pixel(image[0], GLINT_PASS_BEAUTY, x, y, p, NULL);
            glint_image_pixel(image[1], GLINT_PASS_BEAUTY, x, y, q, NULL);
            assert_memory_equal(p, q, sizeof p);
            sum += p[0];
        }
    for (int i = 0; i < 2; i++)
        glint_image_release(image[i]);
    glint_plan_destroy(plan);
    return sum;
}

/// Turns the first light a little and renders.
static double turn_light(stand *s)
{
    glint_light_desc light = *glint_light_get(s->lights[0]);
    light.struct_size = sizeof light;
    light.direction[0] += 0.25;
    assert_int_equal(glint_light_set(s->lights[0], &light, NULL), GLINT_OK);
    return check(s);
}

static void other_samples(void **state)
{
    (void)state;
    static const double samples[] = { 1, 4, 2, 4, 9, 1 };
    stand s;
    make_stand(&s, 1);
    double last = 0;
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        s.render.samples = samples[i];
        const double sum = check(&s);
        assert_true(sum != last);
        last = turn_light(&s); // this frame uses cached results
        assert_true(last != sum);
    }
    free_stand(&s);
}

/// Hits are cached as positions in the primitive array, which building a BVH changes.
static void an_index_that_comes_later(void **state)
{
    (void)state;
    static const glint_visibility ways[] = { GLINT_VISIBILITY_SCAN, GLINT_VISIBILITY_SCAN, GLINT_VISIBILITY_CAST,
                                             GLINT_VISIBILITY_SCAN };
    stand s;
    make_stand(&s, 1);
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        s.render.visibility = ways[i];
        assert_true(turn_light(&s) > 0 && turn_light(&s) > 0);
    }
    free_stand(&s);
}

static void a_light_beyond_those_cached(void **state)
{
    (void)state;
    stand s;
    make_stand(&s, LIGHTS);
    double last = check(&s);
    glint_light_desc light = *glint_light_get(s.lights[LIGHTS - 1]);
    light.struct_size = sizeof light;
    light.diffuse[0] = 0.5;
    light.has_diffuse = true;
    assert_int_equal(glint_light_set(s.lights[LIGHTS - 1], &light, NULL), GLINT_OK);
    assert_true(check(&s) < last);
    last = check(&s);
    glint_material_desc look = *glint_material_get(s.paint);
    look.struct_size = sizeof look;
    look.shininess = 500; // only the highlight shrinks
    assert_int_equal(glint_material_set(s.paint, &look, NULL), GLINT_OK);
    assert_true(check(&s) < last);
    free_stand(&s);
}

static void a_background_alone(void **state)
{
    (void)state;
    stand s;
    make_stand(&s, 1);
    double last = check(&s);
    for (int i = 0; i < 3; i++) {
        glint_scene_desc whole = *glint_scene_get(s.scene);
        whole.struct_size = sizeof whole;
        whole.background[0] += 0.25;
        assert_int_equal(glint_scene_set(s.scene, &whole, NULL), GLINT_OK);
        const double sum = check(&s);
        assert_true(sum > last);
        last = sum;
    }
    free_stand(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_samples),
        cmocka_unit_test(an_index_that_comes_later),
        cmocka_unit_test(a_light_beyond_those_cached),
        cmocka_unit_test(a_background_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
