/// An eye and a light surrounded by clutter: balls, boxes, cylinders and triangles in front, at the sides and behind.
/// Every instruction set is compared with the reference, which tests every primitive against every ray. No occluder
/// is lost, for wide and narrow fields of view, a lens, and gathered groups of few pixels.
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <setjmp.h>
#include <string.h>

#include <cmocka.h>

#include "tests/engine/cases/random.h"
#include "tests/engine/cases/render_case.h"
#include "tests/engine/cases/sets.h"

enum { SIZE = 48, SEEDS = 48, FACES = 120 };

static void place(double reach, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = between(-reach, reach);
}

static void add(glint_scene *scene, glint_shape *shape)
{
    assert_int_equal(glint_scene_add_shape(scene, shape, NULL), GLINT_OK);
    glint_shape_release(shape);
}

/// Adds a ball, box, cylinder or cone; some extend past the eye.
static void add_solid(glint_scene *scene, double reach)
{
    static const glint_shape_kind kinds[] = { GLINT_SHAPE_SPHERE, GLINT_SHAPE_BOX, GLINT_SHAPE_CYLINDER,
                                              GLINT_SHAPE_CONE };
    glint_shape_desc d = glint_shape_desc_default(kinds[below(4)]);
    glint_shape *shape;
    double size[3];
    d.radius = reach * between(0.005, 0.08);
    place(reach, d.center);
    place(0.1 * reach, size);
    if (one_in(3)) // it extends from behind the eye to far ahead
        size[below(3)] *= 20;
    for (int c = 0; c < 3; c++) {
        d.base[c] = d.min[c] = d.center[c];
        d.top[c] = d.center[c] + size[c];
        d.max[c] = d.center[c] + fabs(size[c]) + 0.001 * reach;
    }
    assert_int_equal(glint_shape_create(&d, &shape, NULL), GLINT_OK);
    add(scene, shape);
}

/// Adds unconnected triangles.
static void add_triangles(glint_scene *scene, double reach)
{
    static const glint_shading shadings[] = { GLINT_SHADING_PHONG, GLINT_SHADING_FACETED, GLINT_SHADING_FLAT };
    double vertices[3 * FACES][3], middle[3], aside[3];
    uint32_t corners[3 * FACES], sizes[FACES];
    glint_mesh_desc d = glint_mesh_desc_default();
    glint_shape *shape;
    for (uint32_t i = 0; i < 3 * FACES; i++) {
        if (i % 3 == 0)
            place(reach, middle);
        place(0.2 * reach, aside);
        for (int c = 0; c < 3; c++)
            vertices[i][c] = middle[c] + aside[c];
        corners[i] = i;
        sizes[i / 3] = 3;
    }
    d.has_shading = true;
    d.shading = shadings[below(3)];
    d.two_sided = below(2);
    d.vertices = &vertices[0][0];
    d.vertex_count = 3 * FACES;
    d.corners = corners;
    d.face_sizes = sizes;
    d.face_count = FACES;
    assert_int_equal(glint_mesh_create(&d, &shape, NULL), GLINT_OK);
    add(scene, shape);
}

static void aim(glint_scene *scene, double reach)
{
    glint_camera_desc c = glint_camera_desc_default();
    glint_light_desc l = glint_light_desc_default(GLINT_LIGHT_POINT);
    glint_camera *camera;
    glint_light *light;
    place(0.3 * reach, c.eye);
    place(reach, c.at);
    if (below(2)) { // the camera looks along an axis, where boxes are equally tight on the screen and in the world
        memcpy(c.at, c.eye, sizeof c.at);
        c.at[2 * below(2)] += reach;
    }
    c.fov_y_rad = below(2) ? between(0.05, 1.2) : between(1.2, 2.9);
    if (below(3) == 0) {
        c.aperture = reach * between(0.001, 0.1);
        c.focus = reach * between(0.05, 2);
    }
    place(0.5 * reach, l.position);
    assert_int_equal(glint_camera_create(&c, &camera, NULL), GLINT_OK);
    assert_int_equal(glint_light_create(&l, &light, NULL), GLINT_OK);
    assert_int_equal(glint_scene_set(scene, &(glint_scene_desc) { .struct_size = sizeof(glint_scene_desc), .camera = camera }, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_light(scene, light, NULL), GLINT_OK);
    glint_camera_release(camera);
    glint_light_release(light);
}

static glint_scene *clutter(uint64_t seed)
{
    glint_scene *scene;
    random_state = seed;
    const double reach = pow(2, between(-6, 6));
    assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
    aim(scene, reach);
    for (int i = below(5) ? 60 : 0; i > 0; i--)
        add_solid(scene, reach);
    if (below(3))
        add_triangles(scene, reach);
    if (below(3) == 0) {
        glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_PLANE);
        glint_shape *shape;
        d.point[1] = -0.4 * reach;
        assert_int_equal(glint_shape_create(&d, &shape, NULL), GLINT_OK);
        add(scene, shape);
    }
    return scene;
}

/// Compares all instruction sets with the reference, with `samples` samples per pixel. `adaptive` is the threshold of
/// adaptive sampling, or 0.
static void same_as_reference(uint64_t seed, int samples, double adaptive)
{
    glint_scene *scene = clutter(seed);
    glint_render_desc d = glint_render_desc_default();
    d.width = d.height = SIZE;
    d.samples = samples;
    d.adaptive = adaptive;
    d.passes = 1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_DEPTH | 1u << GLINT_PASS_OBJECT_ID;
    if (adaptive > 0)
        d.passes = 1u << GLINT_PASS_BEAUTY;
    glint_image *want = render_with(scene, "ref", &d);
    for (size_t i = FIRST_KERNELS; i < INSTRUCTION_SETS; i++) {
        glint_image *got = render_with(scene, instruction_sets[i], &d);
        for (int pass = 0; pass < GLINT_PASS_COUNT && got; pass++)
            if (d.passes >> pass & 1 && differing(want, got, (glint_pass)pass, SIZE))
                fail_msg("seed %d, %s, %d samples, pass %d: %d pixels", (int)seed, instruction_sets[i], samples, pass,
                         differing(want, got, (glint_pass)pass, SIZE));
        glint_image_release(got);
    }
    glint_image_release(want);
    glint_scene_release(scene);
}

static void nothing_around_the_eye_is_lost(void **unused)
{
    (void)unused;
    for (uint64_t seed = 1; seed <= SEEDS; seed += case_step())
        same_as_reference(seed, 1, 0);
}

/// Groups that hold the samples of one pixel, of a few pixels, or of parts of pixels.
static void gathered_pixels_are_the_same(void **unused)
{
    static const int samples[] = { 16, 2, 4, 9, 16, 25 };
    (void)unused;
    for (uint64_t seed = 100; seed < 100 + SEEDS / 2; seed += case_step())
        same_as_reference(seed, samples[seed % 6], between(0.02, 0.2));
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(nothing_around_the_eye_is_lost),
                                        cmocka_unit_test(gathered_pixels_are_the_same) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
