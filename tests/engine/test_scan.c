/// Scan conversion against ray casting: a thousand random meshes, from outside and inside, crossing the eye's plane,
/// with corners and edges at pixel centres, in both precisions and projections. Object, distance and normal must be
/// identical bit for bit in every pixel. Also tests frames without triangles or without a BVH.
#include "engine/glint.h"
#include "engine/glint_inspect.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/engine/cases/random.h"
#include "tests/engine/cases/sets.h"

enum { MOST = 1200 };

typedef struct soup {
    double vertices[3 * MOST][3];
    uint32_t corners[4 * MOST], sizes[MOST];
    size_t vertex_count, corner_count, face_count;
} soup;

static void add_face(soup *s, uint32_t size, const uint32_t *corners)
{
    memcpy(s->corners + s->corner_count, corners, size * sizeof *corners);
    s->corner_count += size;
    s->sizes[s->face_count++] = size;
}

/// Random triangles: long ones, slivers, some duplicates.
static void make_triangles(soup *s)
{
    const size_t count = 1 + below(below(4) ? 40 : 400);
    for (size_t i = 0; i < count; i++) {
        const uint32_t n = (uint32_t)s->vertex_count, corners[3] = { n, n + 1, n + 2 };
        const double size = pow(10, between(-2, 1)), thin = below(5) ? 1 : 1e-5;
        double middle[3];
        for (int c = 0; c < 3; c++)
            middle[c] = between(-4, 4);
        for (int j = 0; j < 3; j++)
            for (int c = 0; c < 3; c++)
                s->vertices[n + (uint32_t)j][c] = middle[c] + size * between(-1, 1) * (j == 2 ? thin : 1);
        s->vertex_count += 3;
        add_face(s, 3, corners);
        if (below(10) == 0)
            add_face(s, 3, corners);
    }
}

/// Makes a sheet of squares at integer positions. With a matching camera, corners and edges are at pixel centres.
static void make_sheet(soup *s)
{
    const uint32_t n = 2 + below(14);
    const int axis = (int)below(3);
    for (uint32_t i = 0; i <= n; i++)
        for (uint32_t j = 0; j <= n; j++) {
            double *v = s->vertices[s->vertex_count++];
            v[axis] = below(2) ? 0 : below(3);
            v[(axis + 1) % 3] = (double)i - n / 2;
            v[(axis + 2) % 3] = (double)j - n / 2;
        }
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++) {
            const uint32_t a = i * (n + 1) + j, corners[4] = { a, a + 1, a + n + 2, a + n + 1 };
            add_face(s, 4, corners);
        }
}

static glint_shape *make_mesh(double scale, const double offset[3])
{
    static soup s;
    glint_shape *shape = NULL;
    glint_error error = { .message = "" };
    glint_mesh_desc d = glint_mesh_desc_default();
    d.two_sided = below(4) > 0;
    d.has_shading = true;
    d.shading = (glint_shading)below(4);
    if (below(3) == 0) {
        const double center[3] = { offset[0] + scale * between(-2, 2), offset[1], offset[2] };
        if (glint_sphere_mesh_create(center, scale * between(0.1, 4), 3 + below(60), &d, &shape, &error))
            fail_msg("%s", error.message);
        return shape;
    }
    memset(&s, 0, sizeof s);
    if (below(2))
        make_triangles(&s);
    else
        make_sheet(&s);
    for (size_t i = 0; i < s.vertex_count; i++)
        for (int c = 0; c < 3; c++)
            s.vertices[i][c] = offset[c] + scale * s.vertices[i][c];
    d.vertices = &s.vertices[0][0];
    d.vertex_count = s.vertex_count;
    d.corners = s.corners;
    d.face_sizes = s.sizes;
    d.face_count = s.face_count;
    if (glint_mesh_create(&d, &shape, &error))
        fail_msg("%s", error.message);
    return shape;
}

static void add(glint_scene *scene, glint_shape *shape)
{
    assert_int_equal(glint_scene_add_shape(scene, shape, NULL), GLINT_OK);
    glint_shape_release(shape);
}

static glint_camera *make_camera(double scale, const double offset[3])
{
    glint_camera *camera;
    glint_camera_desc c = glint_camera_desc_default();
    const bool straight = below(2); // integer positions give rays along axes and through corners
    for (int k = 0; k < 3; k++) {
        c.eye[k] = offset[k] + scale * (straight ? (k == 2 ? 8 : below(3)) : between(-6, 6));
        c.at[k] = offset[k] + scale * (straight ? (k == 2 ? 0 : (c.eye[k] - offset[k]) / scale) : between(-2, 2));
    }
    c.projection = below(3) == 0 ? GLINT_PROJECTION_ORTHOGRAPHIC : GLINT_PROJECTION_PERSPECTIVE;
    c.fov_y_rad = below(4) ? between(0.3, 1.8) : between(0.02, 3);
    c.height = scale * (below(2) ? 12 : between(1, 20));
    if (below(3) == 0)
        c.pixel_offset = between(0, 1);
    assert_int_equal(glint_camera_create(&c, &camera, NULL), GLINT_OK);
    return camera;
}

/// Adds spheres and planes next to the mesh.
static void add_others(glint_scene *scene, double scale, const double offset[3])
{
    for (uint32_t i = below(4); i > 0; i--) {
        glint_shape *shape;
        glint_shape_desc d = glint_shape_desc_default(below(3)        ? GLINT_SHAPE_SPHERE
                                                      : below(2) == 0 ? GLINT_SHAPE_PLANE
                                                                      : GLINT_SHAPE_BOX);
        for (int c = 0; c < 3; c++) {
            d.center[c] = d.point[c] = offset[c] + scale * between(-4, 4);
            d.min[c] = d.center[c] - scale;
            d.max[c] = d.center[c] + scale;
        }
        d.radius = scale * between(0.2, 2);
        assert_int_equal(glint_shape_create(&d, &shape, NULL), GLINT_OK);
        add(scene, shape);
    }
}

static glint_scene *random_scene(uint64_t seed)
{
    glint_scene *scene;
    random_state = seed;
    const double scale = below(4) ? 1 : pow(10, between(-6, 6)), far = below(5) ? 0 : pow(10, between(0, 4));
    const double offset[3] = { far * scale, -far * scale, 2 * far * scale };
    assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
    glint_scene_desc s = { .struct_size = sizeof(glint_scene_desc), .camera = make_camera(scale, offset), .ambient = { 0.4, 0.4, 0.4 }, .background = { 0.1 } };
    assert_int_equal(glint_scene_set(scene, &s, NULL), GLINT_OK);
    glint_camera_release(s.camera);
    if (below(2))
        add_others(scene, scale, offset);
    for (uint32_t i = 1 + below(2); i > 0; i--)
        add(scene, make_mesh(scale, offset));
    if (below(2))
        add_others(scene, scale, offset);
    glint_light *light;
    glint_light_desc d = glint_light_desc_default(GLINT_LIGHT_DIRECTIONAL);
    d.direction[0] = -1, d.direction[1] = -2, d.direction[2] = -1;
    d.shadows = below(2);
    assert_int_equal(glint_light_create(&d, &light, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_light(scene, light, NULL), GLINT_OK);
    glint_light_release(light);
    return scene;
}

static glint_render_desc desc_of(glint_visibility visibility)
{
    glint_render_desc r = glint_render_desc_default();
    r.width = 70;
    r.height = 52;
    r.visibility = visibility;
    r.passes = 1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_DEPTH | 1u << GLINT_PASS_NORMAL | 1u << GLINT_PASS_OBJECT_ID;
    return r;
}

/// Returns NULL when this machine lacks the instruction set.
static glint_image *render(const glint_scene *scene, const glint_render_desc *r, const char *isa)
{
    glint_plan *plan = NULL;
    glint_image *image = NULL;
    glint_renderer *renderer = NULL;
    glint_renderer_desc d = glint_renderer_desc_default();
    glint_error error = { .message = "" };
    d.threads = 2;
    d.isa = isa;
    glint_status status = glint_renderer_create(&d, &renderer, &error);
    if (status == GLINT_ERR_UNSUPPORTED)
        return NULL;
    if (status || glint_plan_create(scene, r, &plan, &error) || glint_render(renderer, plan, &image, NULL, &error))
        fail_msg("%s", error.message);
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    return image;
}

/// Counts the pixels that differ in any bit of any pass. *hits gets the number of pixels of `a` with a hit.
static int differing(const glint_image *a, const glint_image *b, int *hits)
{
    static const glint_pass passes[] = { GLINT_PASS_BEAUTY, GLINT_PASS_DEPTH, GLINT_PASS_NORMAL, GLINT_PASS_OBJECT_ID };
    int count = 0;
    for (int y = 0; y < glint_image_height(a); y++)
        for (int x = 0; x < glint_image_width(a); x++) {
            bool same = true;
            for (size_t k = 0; k < sizeof passes / sizeof *passes; k++) {
                float p[3] = { 0 }, q[3] = { 0 };
                glint_image_pixel(a, passes[k], x, y, p, NULL);
                glint_image_pixel(b, passes[k], x, y, q, NULL);
                same = same && memcmp(p, q, sizeof p) == 0;
                *hits += passes[k] == GLINT_PASS_OBJECT_ID && p[0] > 0;
            }
            count += !same;
        }
    return count;
}

/// If `moved`, half of the pictures place their samples by a seed, even a single sample per pixel.
/// Returns the number of hits.
static int scanned_and_cast(uint64_t first, uint64_t last, bool moved)
{
    int hits = 0;
    for (uint64_t seed = first; seed <= last; seed += case_step()) {
        glint_scene *scene = random_scene(seed);
        glint_render_desc cast = desc_of(GLINT_VISIBILITY_CAST), raster = desc_of(GLINT_VISIBILITY_SCAN);
        cast.samples = raster.samples = below(3) ? 1 : 3;
        cast.seed = raster.seed = moved && seed % 2 ? (double)seed : 0;
        cast.precision = raster.precision = below(3) ? GLINT_PRECISION_DOUBLE : GLINT_PRECISION_FLOAT;
        glint_image *want = render(scene, &cast, NULL), *got = render(scene, &raster, NULL);
        const int wrong = differing(want, got, &hits);
        if (wrong)
            fail_msg("seed %d, precision %d: %d pixels", (int)seed, raster.precision, wrong);
        glint_image_release(want);
        glint_image_release(got);
        glint_scene_release(scene);
    }
    return hits;
}

static void same_as_casting(void **unused)
{
    (void)unused;
    assert_true(scanned_and_cast(1, 1000, true) * (int)case_step() > 1000000);
}

/// Tests seeds with sheets that are seen edge-on: the rays of one pixel run in the plane of triangles.
static void in_the_plane_of_the_eye(void **unused)
{
    static const uint64_t seeds[] = { 12107, 17819, 17979, 22574, 25546, 35020, 35436, 46600, 54696, 55745, 61770 };
    (void)unused;
    for (size_t i = 0; i < sizeof seeds / sizeof *seeds; i++)
        assert_true(scanned_and_cast(seeds[i], seeds[i], false) > 0);
}

static void same_on_every_instruction_set(void **unused)
{
    int hits = 0;
    (void)unused;
    for (uint64_t seed = 2001; seed <= 2030; seed += case_step()) {
        glint_scene *scene = random_scene(seed);
        glint_render_desc raster = desc_of(GLINT_VISIBILITY_SCAN);
        raster.precision = seed % 2 ? GLINT_PRECISION_DOUBLE : GLINT_PRECISION_FLOAT;
        glint_image *want = render(scene, &raster, "ref");
        for (size_t i = FIRST_KERNELS; i < INSTRUCTION_SETS; i++) {
            glint_image *got = render(scene, &raster, instruction_sets[i]);
            const int wrong = got ? differing(want, got, &hits) : 0;
            if (wrong)
                fail_msg("seed %d, %s: %d pixels", (int)seed, instruction_sets[i], wrong);
            glint_image_release(got);
        }
        glint_image_release(want);
        glint_scene_release(scene);
    }
}

/// One renderer alternates between frames with and without a BVH: cached results of one frame stay valid for the next.
static void in_turn(void **unused)
{
    (void)unused;
    for (uint64_t seed = 3001; seed <= 3040; seed += case_step()) {
        glint_scene *scene = random_scene(seed);
        glint_renderer *renderer;
        glint_renderer_desc d = glint_renderer_desc_default();
        int hits = 0;
        d.threads = 1;
        assert_int_equal(glint_renderer_create(&d, &renderer, NULL), GLINT_OK);
        for (int frame = 0; frame < 6; frame++) {
            glint_light *light = glint_scene_light_at(scene, 0);
            glint_light_desc l = *glint_light_get(light);
            l.struct_size = sizeof l;
            l.shadows = below(2);
            l.intensity = between(0.5, 1);
            assert_int_equal(glint_light_set(light, &l, NULL), GLINT_OK);
            glint_render_desc r = desc_of((glint_visibility)below(3)), cast = desc_of(GLINT_VISIBILITY_CAST);
            glint_plan *plan;
            glint_image *got, *want = render(scene, &cast, NULL);
            assert_int_equal(glint_plan_create(scene, &r, &plan, NULL), GLINT_OK);
            assert_int_equal(glint_render(renderer, plan, &got, NULL, NULL), GLINT_OK);
            if (differing(want, got, &hits))
                fail_msg("seed %d, frame %d", (int)seed, frame);
            glint_plan_destroy(plan);
            glint_image_release(got);
            glint_image_release(want);
        }
        glint_renderer_destroy(renderer);
        glint_scene_release(scene);
    }
}

static bool has_effect(const glint_plan *plan, const char *name)
{
    const glint_effect *effects;
    const size_t count = glint_plan_effects(plan, &effects);
    for (size_t i = 0; i < count; i++)
        if (strcmp(effects[i].effect, name) == 0)
            return true;
    return false;
}

/// Without triangles there is nothing to scan. The engine casts rays at a few triangles among other primitives. It
/// scans the triangles when they are on their own and nothing else needs a BVH. An invalid value is refused.
static void only_triangles(void **unused)
{
    (void)unused;
    for (int mesh = 0; mesh < 3; mesh++) {
        const double offset[3] = { 0 };
        glint_scene *scene;
        random_state = 5;
        assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
        glint_scene_desc s = { .struct_size = sizeof(glint_scene_desc), .camera = make_camera(1, offset) };
        assert_int_equal(glint_scene_set(scene, &s, NULL), GLINT_OK);
        glint_camera_release(s.camera);
        glint_shape *sphere;
        glint_shape_desc d = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
        d.radius = 1;
        assert_int_equal(glint_shape_create(&d, &sphere, NULL), GLINT_OK);
        if (mesh < 2)
            add(scene, sphere);
        if (mesh == 2)
            glint_shape_release(sphere);
        if (mesh > 0)
            add(scene, make_mesh(1, offset));
        glint_render_desc r = desc_of(GLINT_VISIBILITY_SCAN);
        glint_plan *plan;
        assert_int_equal(glint_plan_create(scene, &r, &plan, NULL), GLINT_OK);
        assert_int_equal(has_effect(plan, "scan conversion"), mesh > 0);
        glint_plan_destroy(plan);
        r.visibility = GLINT_VISIBILITY_AUTO;
        assert_int_equal(glint_plan_create(scene, &r, &plan, NULL), GLINT_OK);
        assert_int_equal(has_effect(plan, "scan conversion"), mesh == 2);
        glint_plan_destroy(plan);
        r.visibility = (glint_visibility)3;
        assert_int_equal(glint_plan_create(scene, &r, &plan, NULL), GLINT_ERR_INVALID);
        glint_scene_release(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_as_casting),
        cmocka_unit_test(in_the_plane_of_the_eye),
        cmocka_unit_test(same_on_every_instruction_set),
        cmocka_unit_test(in_turn),
        cmocka_unit_test(only_triangles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
