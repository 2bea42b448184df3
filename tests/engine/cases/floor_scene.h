/// Shared by the tests of area lights: balls over a floor, and checks of pictures and plans. Included after cmocka.h.
#ifndef GLINT_TESTS_FLOOR_SCENE_H
#define GLINT_TESTS_FLOOR_SCENE_H

#include <string.h>

#include "engine/glint.h"
#include "engine/glint_inspect.h"

static inline void add_ball(glint_scene *scene, const double center[3], double radius, double mirror)
{
    glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    glint_material_desc m = glint_material_desc_default();
    glint_material *material;
    glint_shape *shape;
    m.has_mirror = true;
    m.mirror[0] = mirror;
    memcpy(d.center, center, sizeof d.center);
    d.radius = radius;
    assert_int_equal(glint_material_create(&m, &material, NULL), GLINT_OK);
    d.material = material;
    assert_int_equal(glint_shape_create(&d, &shape, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_shape(scene, shape, NULL), GLINT_OK);
    glint_shape_release(shape);
    glint_material_release(material);
}

/// A floor at y = 0, without a light.
static inline glint_scene *make_floor(const double eye[3], const double at[3])
{
    glint_scene *scene;
    glint_camera_desc c = glint_camera_desc_default();
    glint_camera *camera;
    glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    glint_shape *floor;
    memcpy(c.eye, eye, sizeof c.eye);
    memcpy(c.at, at, sizeof c.at);
    assert_int_equal(glint_camera_create(&c, &camera, NULL), GLINT_OK);
    assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
    glint_scene_desc s = { .struct_size = sizeof(glint_scene_desc), .camera = camera };
    assert_int_equal(glint_scene_set(scene, &s, NULL), GLINT_OK);
    memcpy(d.normal, (double[3]) { 0, 1, 0 }, sizeof d.normal);
    assert_int_equal(glint_shape_create(&d, &floor, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_shape(scene, floor, NULL), GLINT_OK);
    glint_shape_release(floor);
    glint_camera_release(camera);
    return scene;
}

/// Counts the pixels whose beauty differs in any bit.
static inline int differing(const glint_image *a, const glint_image *b)
{
    int count = 0;
    for (int y = 0; y < glint_image_height(a); y++)
        for (int x = 0; x < glint_image_width(a); x++) {
            float p[3], q[3];
            glint_image_pixel(a, GLINT_PASS_BEAUTY, x, y, p, NULL);
            glint_image_pixel(b, GLINT_PASS_BEAUTY, x, y, q, NULL);
            count += memcmp(p, q, sizeof p) != 0;
        }
    return count;
}

/// Returns whether the scene uses an effect with this name.
static inline bool has_effect(const glint_scene *scene, const char *effect)
{
    glint_render_desc desc = glint_render_desc_default();
    const glint_effect *list;
    glint_plan *plan;
    bool found = false;
    assert_int_equal(glint_plan_create(scene, &desc, &plan, NULL), GLINT_OK);
    const size_t count = glint_plan_effects(plan, &list);
    for (size_t i = 0; i < count; i++)
        found = found || strcmp(list[i].effect, effect) == 0;
    glint_plan_destroy(plan);
    return found;
}

#endif
