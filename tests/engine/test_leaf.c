/// Meshes whose triangles are as small as pixels, seen edge-on, or around the eye or the light. Every instruction set
/// is compared with the reference, which tests every triangle against every ray. Neither the eye nor the light misses
/// a triangle, and each pixel uses its own triangle's shading.
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <setjmp.h>
#include <string.h>

#include <cmocka.h>

#include "engine/glint.h"
#include "tests/engine/cases/random.h"
#include "tests/engine/cases/render_case.h"
#include "tests/engine/cases/sets.h"

enum { SIDE = 22, SIZE = 40, SEEDS = 36 };

// ---- Sheets ----

/// Placement of a scene: all coordinates of its sheets are multiplied by `scale`, then moved.
typedef struct place {
    double scale, move[3];
} place;

static void put(const place *at, const double x[3], double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = x[c] * at->scale + at->move[c];
}

/// Adds a bumpy sheet of SIDE x SIDE quads, two triangles each, from `corner` along `across` and `down`. Each sheet
/// has its own material and shading, and one or two sides.
static void add_sheet(glint_scene *scene, const place *at, const double corner[3], const double across[3],
                      const double down[3], double bumps)
{
    static double vertices[(SIDE + 1) * (SIDE + 1)][3];
    static uint32_t corners[6 * SIDE * SIDE], sizes[2 * SIDE * SIDE];
    glint_shape *shape;
    size_t count = 0;
    for (uint32_t i = 0; i <= SIDE; i++)
        for (uint32_t j = 0; j <= SIDE; j++) {
            double x[3];
            for (int c = 0; c < 3; c++)
                x[c] = corner[c] + (across[c] * i + down[c] * j) / SIDE + bumps * between(-1, 1);
            put(at, x, vertices[(SIDE + 1) * i + j]);
        }
    for (uint32_t i = 0; i < SIDE; i++)
        for (uint32_t j = 0; j < SIDE; j++) {
            const uint32_t a = (SIDE + 1) * i + j, b = a + 1, c = a + SIDE + 1, d = c + 1;
            memcpy(corners + 3 * count, (const uint32_t[]) { a, b, c, b, d, c }, 6 * sizeof *corners);
            sizes[count++] = 3;
            sizes[count++] = 3;
        }
    glint_material *material;
    glint_material_desc m = glint_material_desc_default();
    for (int c = 0; c < 3; c++)
        m.diffuse[c] = between(0, 1);
    assert_int_equal(glint_material_create(&m, &material, NULL), GLINT_OK);
    glint_mesh_desc d = glint_mesh_desc_default();
    d.material = material;
    d.two_sided = below(3) > 0;
    d.has_shading = true;
    d.shading = below(2) ? GLINT_SHADING_PHONG : GLINT_SHADING_FACETED;
    d.vertices = &vertices[0][0];
    d.vertex_count = (SIDE + 1) * (SIDE + 1);
    d.corners = corners;
    d.face_sizes = sizes;
    d.face_count = count;
    assert_int_equal(glint_mesh_create(&d, &shape, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_shape(scene, shape, NULL), GLINT_OK);
    glint_shape_release(shape);
    glint_material_release(material);
}

/// Adds a ball among the triangles.
static void add_ball(glint_scene *scene, const place *at, const double center[3], double radius)
{
    glint_shape *shape;
    glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    put(at, center, d.center);
    d.radius = radius * at->scale;
    assert_int_equal(glint_shape_create(&d, &shape, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_shape(scene, shape, NULL), GLINT_OK);
    glint_shape_release(shape);
}

static glint_scene *lit_scene(const place *at, const double eye[3], const double light[3], bool directional)
{
    glint_scene *scene;
    glint_camera *camera;
    glint_light *lamp;
    glint_camera_desc c = glint_camera_desc_default();
    put(at, eye, c.eye);
    put(at, (const double[3]) { 0, 0, 0 }, c.at);
    c.fov_y_rad = below(2) ? 0.5 : between(0.05, 1.5);
    glint_light_desc l = glint_light_desc_default(directional ? GLINT_LIGHT_DIRECTIONAL : GLINT_LIGHT_POINT);
    put(at, light, l.position);
    for (int k = 0; k < 3; k++)
        l.direction[k] = -light[k];
    assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
    assert_int_equal(glint_camera_create(&c, &camera, NULL), GLINT_OK);
    assert_int_equal(glint_light_create(&l, &lamp, NULL), GLINT_OK);
    assert_int_equal(glint_scene_set(scene, &(glint_scene_desc) { .struct_size = sizeof(glint_scene_desc), .camera = camera }, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_light(scene, lamp, NULL), GLINT_OK);
    glint_camera_release(camera);
    glint_light_release(lamp);
    return scene;
}

/// Makes sheets behind each other: some are coplanar with the eye or the light, some surround the eye, and some
/// shadow themselves only through their bumps.
static glint_scene *sheets(uint64_t seed, glint_precision precision)
{
    random_state = seed;
    place at = { pow(2, between(-10, 10)), { 0, 0, 0 } };
    for (int c = 0; c < 3 && below(2) && precision == GLINT_PRECISION_DOUBLE; c++)
        at.move[c] = at.scale * between(-1, 1) * pow(10, between(0, 7));
    const double eye[3] = { below(2) ? 0 : between(-2, 2), below(2) ? 0 : between(-2, 2), 8 };
    const double light[3] = { below(3) ? between(-6, 6) : 0, below(3) ? between(-6, 6) : 0,
                              below(4) ? between(1, 9) : 8 };
    glint_scene *scene = lit_scene(&at, eye, light, below(3) == 0);
    for (int i = 0, count = 2 + (int)below(3); i < count; i++) {
        const double z = between(-3, 3), wide = pow(10, between(-0.7, 0.8)), bumps = below(2) ? 0 : 0.3 * wide / SIDE;
        double corner[3] = { -wide / 2, -wide / 2, z }, across[3] = { wide, 0, 0 }, down[3] = { 0, wide, 0 };
        const double *from = below(2) ? eye : light;
        switch (precision == GLINT_PRECISION_FLOAT ? 1 + below(4) : below(5)) {
        case 0: // a sheet coplanar with the eye or the light; not in float, where hits in the plane are arbitrary
            for (int c = 0; c < 3; c++)
                down[c] = (from[c] - corner[c]) * (below(3) ? 0.5 : 1.5);
            break;
        case 1: // a sheet around the eye or the light
            for (int c = 0; c < 3; c++)
                corner[c] = from[c] - across[c] / 2 - down[c] / 2 + (c == 2 ? between(-0.1, 0.1) : 0);
            break;
        case 2: // a grid whose corners project close to pixel centres
            across[0] = down[1] = SIDE * (8 - z) * 2 * tan(0.25) / SIZE;
            corner[0] = corner[1] = -across[0] / 2;
            break;
        default:
            across[2] = between(-2, 2) * wide;
            down[2] = between(-2, 2) * wide;
        }
        add_sheet(scene, &at, corner, across, down, bumps);
    }
    if (below(2))
        add_ball(scene, &at, (const double[3]) { between(-1, 1), between(-1, 1), between(-1, 4) }, between(0.01, 0.5));
    return scene;
}

// ---- Pictures ----

static glint_image *render(const glint_scene *scene, const char *isa, glint_precision precision)
{
    glint_render_desc d = glint_render_desc_default();
    d.width = d.height = SIZE;
    d.precision = precision;
    d.passes = 1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_DEPTH | 1u << GLINT_PASS_OBJECT_ID;
    return render_with(scene, isa, &d);
}

static void no_triangle_is_lost(void **unused)
{
    static const glint_pass passes[] = { GLINT_PASS_OBJECT_ID, GLINT_PASS_DEPTH, GLINT_PASS_BEAUTY };
    (void)unused;
    for (uint64_t seed = 1; seed <= SEEDS; seed += case_step()) {
        const glint_precision precision = seed % 3 ? GLINT_PRECISION_DOUBLE : GLINT_PRECISION_FLOAT;
        glint_scene *scene = sheets(seed, precision);
        glint_image *want = render(scene, "ref", precision);
        for (size_t i = FIRST_KERNELS; i < INSTRUCTION_SETS; i++) {
            glint_image *got = render(scene, instruction_sets[i], precision);
            for (int k = 0; k < 3 && got; k++)
                if (differing(want, got, passes[k], SIZE))
                    fail_msg("seed %d, %s, precision %d, pass %d: %d pixels", (int)seed, instruction_sets[i],
                             (int)precision, (int)passes[k], differing(want, got, passes[k], SIZE));
            glint_image_release(got);
        }
        glint_image_release(want);
        glint_scene_release(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(no_triangle_is_lost) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
