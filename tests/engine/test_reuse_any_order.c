/// Lights, cameras, colours and shapes that return to what they were, in any order, with little or much memory: each
/// frame equals the same frame rendered afresh.
#include "engine/glint.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/engine/cases/step.h"

enum { LIGHTS = 2, CROWD = 400 }; // CROWD: number of spheres behind the eye

typedef struct stand {
    glint_scene *scene;
    glint_camera *camera;
    glint_material *paint;
    glint_shape *ball, *floor, *crowd[CROWD];
    glint_light *lights[LIGHTS];
    glint_renderer *renderers[2]; ///< one renderer that reuses results, and one that does not
    glint_render_desc render;
} stand;

static uint64_t state;

/// Returns a random integer in 0 .. n - 1.
static uint32_t draw(uint32_t n)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state >> 33) % n;
}

static void make_stand(stand *s, size_t memory)
{
    *s = (stand) { .render = glint_render_desc_default() };
    glint_camera_desc view = glint_camera_desc_default();
    glint_material_desc look = glint_material_desc_default();
    glint_renderer_desc desc = glint_renderer_desc_default();
    view.eye[2] = 6;
    s->render.width = 100;
    s->render.height = 80;
    s->render.passes = 1u << GLINT_PASS_BEAUTY;
    for (int c = 0; c < 3; c++)
        look.specular[c] = 0.5;
    assert_int_equal(glint_scene_create(&s->scene, NULL), GLINT_OK);
    assert_int_equal(glint_camera_create(&view, &s->camera, NULL), GLINT_OK);
    assert_int_equal(glint_material_create(&look, &s->paint, NULL), GLINT_OK);
    glint_shape_desc ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE), floor = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    ball.material = floor.material = s->paint;
    floor.point[1] = -1;
    assert_int_equal(glint_shape_create(&ball, &s->ball, NULL), GLINT_OK);
    assert_int_equal(glint_shape_create(&floor, &s->floor, NULL), GLINT_OK);
    glint_scene_desc whole = *glint_scene_get(s->scene);
    whole.struct_size = sizeof whole;
    whole.camera = s->camera;
    assert_int_equal(glint_scene_set(s->scene, &whole, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_shape(s->scene, s->ball, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_shape(s->scene, s->floor, NULL), GLINT_OK);
    for (int i = 0; i < CROWD; i++) {
        ball.center[0] = i - 0.5 * CROWD;
        ball.center[2] = 20;
        assert_int_equal(glint_shape_create(&ball, &s->crowd[i], NULL), GLINT_OK);
        assert_int_equal(glint_scene_add_shape(s->scene, s->crowd[i], NULL), GLINT_OK);
    }
    for (int i = 0; i < LIGHTS; i++) {
        glint_light_desc light = glint_light_desc_default(i ? GLINT_LIGHT_POINT : GLINT_LIGHT_SPHERE);
        light.position[1] = 6;
        light.position[2] = 3;
        light.radius = 0.5;
        light.samples = 3;
        assert_int_equal(glint_light_create(&light, &s->lights[i], NULL), GLINT_OK);
        assert_int_equal(glint_scene_add_light(s->scene, s->lights[i], NULL), GLINT_OK);
    }
    desc.threads = 2;
    desc.reuse_memory = memory;
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
    glint_shape_release(s->floor);
    for (int i = 0; i < CROWD; i++)
        glint_shape_release(s->crowd[i]);
    glint_camera_release(s->camera);
    glint_scene_release(s->scene);
}

static void set_lamp(const stand *s, int lamp, double x)
{
    glint_light_desc light = *glint_light_get(s->lights[lamp]);
    light.struct_size = sizeof light;
    light.position[0] = x;
    assert_int_equal(glint_light_set(s->lights[lamp], &light, NULL), GLINT_OK);
}

static void set_eye(const stand *s, double x)
{
    glint_camera_desc view = *glint_camera_get(s->camera);
    view.struct_size = sizeof view;
    view.eye[0] = x;
    assert_int_equal(glint_camera_set(s->camera, &view, NULL), GLINT_OK);
}

static void set_color(const stand *s, double red)
{
    glint_material_desc look = *glint_material_get(s->paint);
    look.struct_size = sizeof look;
    look.diffuse[0] = red;
    assert_int_equal(glint_material_set(s->paint, &look, NULL), GLINT_OK);
}

static void set_ball(const stand *s, double x)
{
    glint_shape_desc place = *glint_shape_get(s->ball);
    place.struct_size = sizeof place;
    place.center[0] = x;
    assert_int_equal(glint_shape_set(s->ball, &place, NULL), GLINT_OK);
}

/// Renders the current scene with both renderers and compares every pixel.
static void check(const stand *s, int frame)
{
    glint_plan *plan;
    glint_image *image[2];
    assert_int_equal(glint_plan_create(s->scene, &s->render, &plan, NULL), GLINT_OK);
    for (int i = 0; i < 2; i++)
        assert_int_equal(glint_render(s->renderers[i], plan, &image[i], NULL, NULL), GLINT_OK);
    for (int y = 0; y < s->render.height; y++)
        for (int x = 0; x < s->render.width; x++) {
            float p[3], q[3];
            glint_image_pixel(image[0], GLINT_PASS_BEAUTY, x, y, p, NULL);
            glint_image_pixel(image[1], GLINT_PASS_BEAUTY, x, y, q, NULL);
            if (memcmp(p, q, sizeof p) != 0)
                fail_msg("frame %d: pixel %d, %d differs from the fresh one", frame, x, y);
        }
    for (int i = 0; i < 2; i++)
        glint_image_release(image[i]);
    glint_plan_destroy(plan);
}

/// Sets one property to one of a few values.
static void change(stand *s)
{
    const uint32_t what = draw(16);
    if (what < 5)
        set_lamp(s, 0, draw(3));
    else if (what < 7)
        set_lamp(s, 1, draw(3));
    else if (what < 9)
        set_eye(s, 0.5 * draw(3));
    else if (what < 11)
        set_color(s, 0.3 * draw(3));
    else if (what < 12)
        set_ball(s, 0.5 * draw(2));
    else if (what < 15)
        s->render.adaptive = draw(2) ? 0 : 0.1;
    else
        s->render.samples = draw(8) ? 4 : 1;
    if (s->render.adaptive > 0 && s->render.samples == 1)
        s->render.samples = 4;
}

/// A reused result must belong to the same pixels, surfaces and samples, also if other frames came in between.
static void come_back(size_t memory, int frames)
{
    stand s;
    make_stand(&s, memory);
    for (int frame = 0; frame < frames; frame++) {
        for (uint32_t left = 1 + draw(3); left > 0; left--)
            change(&s);
        check(&s, frame);
    }
    free_stand(&s);
}

static void frames_in_any_order(void **unused)
{
    (void)unused;
    for (uint64_t round = 0; round < 8; round += case_step()) {
        state = 900 + round;
        come_back(0, 150);
    }
}

static void frames_in_any_order_with_little_memory(void **unused)
{
    (void)unused;
    for (size_t memory = 300000; memory < 40000000; memory *= 2) {
        state = 1000 + memory;
        come_back(memory, 60 / (int)case_step());
    }
}

static glint_image *render_held(stand *s)
{
    glint_plan *plan;
    glint_image *image;
    assert_int_equal(glint_plan_create(s->scene, &s->render, &plan, NULL), GLINT_OK);
    assert_int_equal(glint_render(s->renderers[0], plan, &image, NULL, NULL), GLINT_OK);
    glint_plan_destroy(plan);
    return image;
}

/// The renderer may overwrite a picture that nobody retains. A retained picture stays as it is.
static void a_picture_that_is_held(void **unused)
{
    (void)unused;
    stand s;
    float before[3], after[3];
    make_stand(&s, 0);
    glint_image *held = render_held(&s);
    assert_int_equal(glint_image_pixel(held, GLINT_PASS_BEAUTY, 50, 40, before, NULL), GLINT_OK);
    set_color(&s, 0.2);
    glint_image *next = render_held(&s);
    assert_int_equal(glint_image_pixel(held, GLINT_PASS_BEAUTY, 50, 40, after, NULL), GLINT_OK);
    assert_memory_equal(before, after, sizeof before);
    assert_int_equal(glint_image_pixel(next, GLINT_PASS_BEAUTY, 50, 40, after, NULL), GLINT_OK);
    assert_memory_not_equal(before, after, sizeof before);
    glint_image_release(held);
    glint_image_release(next);
    // each frame overwrites the previous one; the light and the colour change in turn
    for (int frame = 0; frame < 6; frame++) {
        set_color(&s, 0.1 * (frame / 2));
        set_lamp(&s, 0, frame / 2 + frame % 2);
        check(&s, frame);
    }
    free_stand(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_that_is_held),
        cmocka_unit_test(frames_in_any_order),
        cmocka_unit_test(frames_in_any_order_with_little_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
