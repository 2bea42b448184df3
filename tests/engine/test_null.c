/// NULL where a pointer is expected: an error that names the argument, and never a crash later.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "engine/glint.h"

/// `call` must refuse `name`; the call fills `error`.
#define REFUSES(name, call) \
    do { \
        glint_error error = { 0 }; \
        assert_int_equal(call, GLINT_ERR_INVALID); \
        assert_string_equal(error.message, name ": pointer expected, got NULL"); \
    } while (0)

typedef struct parts {
    glint_scene *scene;
    glint_shape *shape, *group;
    glint_light *light;
    glint_material *material;
    glint_camera *camera;
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
} parts;

static parts make(void)
{
    parts p = { 0 };
    const glint_shape_desc sphere = glint_shape_desc_default(GLINT_SHAPE_SPHERE), group = glint_shape_desc_default(GLINT_SHAPE_GROUP);
    const glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_POINT);
    const glint_material_desc material = glint_material_desc_default();
    const glint_camera_desc camera = glint_camera_desc_default();
    const glint_renderer_desc renderer = glint_renderer_desc_default();
    glint_render_desc frame = glint_render_desc_default();
    frame.width = frame.height = 8;
    assert_int_equal(glint_scene_create(&p.scene, NULL), GLINT_OK);
    assert_int_equal(glint_shape_create(&sphere, &p.shape, NULL), GLINT_OK);
    assert_int_equal(glint_shape_create(&group, &p.group, NULL), GLINT_OK);
    assert_int_equal(glint_light_create(&light, &p.light, NULL), GLINT_OK);
    assert_int_equal(glint_material_create(&material, &p.material, NULL), GLINT_OK);
    assert_int_equal(glint_camera_create(&camera, &p.camera, NULL), GLINT_OK);
    assert_int_equal(glint_renderer_create(&renderer, &p.renderer, NULL), GLINT_OK);
    glint_scene_desc scene = *glint_scene_get(p.scene);
    scene.camera = p.camera;
    assert_int_equal(glint_scene_set(p.scene, &scene, NULL), GLINT_OK);
    assert_int_equal(glint_plan_create(p.scene, &frame, &p.plan, NULL), GLINT_OK);
    assert_int_equal(glint_render(p.renderer, p.plan, &p.image, NULL, NULL), GLINT_OK);
    return p;
}

static void destroy(parts *p)
{
    glint_image_release(p->image);
    glint_plan_destroy(p->plan);
    glint_renderer_destroy(p->renderer);
    glint_camera_release(p->camera);
    glint_material_release(p->material);
    glint_light_release(p->light);
    glint_shape_release(p->group);
    glint_shape_release(p->shape);
    glint_scene_release(p->scene);
}

static void test_null_of_scenes(void **state)
{
    parts p = make();
    glint_scene_desc desc = *glint_scene_get(p.scene);
    (void)state;
    REFUSES("out", glint_scene_create(NULL, &error));
    REFUSES("scene", glint_scene_set(NULL, &desc, &error));
    REFUSES("desc", glint_scene_set(p.scene, NULL, &error));
    REFUSES("scene", glint_scene_add_shape(NULL, p.shape, &error));
    REFUSES("shape", glint_scene_add_shape(p.scene, NULL, &error));
    REFUSES("scene", glint_scene_add_light(NULL, p.light, &error));
    REFUSES("light", glint_scene_add_light(p.scene, NULL, &error));
    REFUSES("overlay", glint_scene_add_overlay(p.scene, NULL, &error));
    REFUSES("shape", glint_scene_remove_shape(p.scene, NULL, &error));
    REFUSES("light", glint_scene_remove_light(p.scene, NULL, &error));
    REFUSES("overlay", glint_scene_remove_overlay(p.scene, NULL, &error));
    REFUSES("group", glint_group_add(NULL, p.shape, &error));
    REFUSES("child", glint_group_add(p.group, NULL, &error));
    REFUSES("child", glint_group_remove(p.group, NULL, &error));
    assert_int_equal(glint_scene_add_shape(p.scene, NULL, NULL), GLINT_ERR_INVALID); // without an error to fill
    assert_int_equal(glint_scene_shape_count(p.scene), 0);
    assert_int_equal(glint_group_count(p.group), 0);
    destroy(&p);
}

static void test_null_of_objects(void **state)
{
    parts p = make();
    const glint_material_desc material = glint_material_desc_default();
    const glint_mesh_desc mesh = glint_mesh_desc_default();
    const double axis[3] = { 0, 0, 1 };
    glint_shape *shape = NULL;
    (void)state;
    REFUSES("desc", glint_material_create(NULL, &p.material, &error));
    REFUSES("out", glint_material_create(&material, NULL, &error));
    REFUSES("material", glint_material_set(NULL, &material, &error));
    REFUSES("desc", glint_material_set(p.material, NULL, &error));
    REFUSES("to_light", glint_material_evaluate(p.material, axis, NULL, axis, NULL, &error));
    REFUSES("desc", glint_light_create(NULL, &p.light, &error));
    REFUSES("desc", glint_light_set(p.light, NULL, &error));
    REFUSES("desc", glint_camera_create(NULL, &p.camera, &error));
    REFUSES("desc", glint_camera_set(p.camera, NULL, &error));
    REFUSES("desc", glint_shape_create(NULL, &shape, &error));
    REFUSES("desc", glint_shape_set(p.shape, NULL, &error));
    REFUSES("desc", glint_spheres_create(NULL, &shape, &error));
    REFUSES("desc", glint_mesh_create(NULL, &shape, &error));
    REFUSES("path", glint_mesh_load(NULL, &mesh, &shape, &error));
    REFUSES("center", glint_sphere_mesh_create(NULL, 1, 8, &mesh, &shape, &error));
    REFUSES("desc", glint_overlay_create(NULL, &(glint_overlay *) { NULL }, &error));
    REFUSES("desc", glint_texture_create(NULL, &(glint_texture *) { NULL }, &error));
    destroy(&p);
}

static void test_null_of_frames(void **state)
{
    parts p = make();
    const glint_render_desc frame = glint_render_desc_default();
    const double point[3] = { 0, 0, 9 };
    bool hit;
    float pixel[3];
    glint_plan *plan = NULL;
    (void)state;
    REFUSES("scene", glint_plan_create(NULL, &frame, &plan, &error));
    REFUSES("desc", glint_plan_create(p.scene, NULL, &plan, &error));
    REFUSES("out", glint_plan_create(p.scene, &frame, NULL, &error));
    REFUSES("desc", glint_renderer_create(NULL, &p.renderer, &error));
    REFUSES("renderer", glint_render(NULL, p.plan, &p.image, NULL, &error));
    REFUSES("plan", glint_render(p.renderer, NULL, &p.image, NULL, &error));
    REFUSES("out", glint_render(p.renderer, p.plan, NULL, NULL, &error));
    REFUSES("image", glint_image_pixel(NULL, GLINT_PASS_BEAUTY, 0, 0, pixel, &error));
    REFUSES("desc", glint_image_write(p.image, NULL, &error));
    REFUSES("direction", glint_scene_cast(p.scene, point, NULL, &hit, NULL, &error));
    REFUSES("path", glint_draft_create(NULL, &(glint_draft *) { NULL }, &error));
    REFUSES("path", glint_picture_read(NULL, true, &(glint_picture *) { NULL }, &error));
    REFUSES("data", glint_picture_from_bytes(NULL, 0, &(glint_picture *) { NULL }, &error));
    destroy(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_null_of_scenes),
        cmocka_unit_test(test_null_of_objects),
        cmocka_unit_test(test_null_of_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
