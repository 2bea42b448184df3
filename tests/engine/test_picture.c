// Options of a picture: alpha and outline, compared with their definitions and with the picture without them.
#include "tests/engine/cases/image_case.h"

#include <stdlib.h>

#define WIDTH 75
#define HEIGHT 53
#define PIXELS (WIDTH * HEIGHT)

typedef struct world {
    glint_scene *scene;
    glint_renderer *renderer;
} world;

static glint_shape *ball(double x, double z, double radius, const double diffuse[3], double mirror)
{
    glint_material_desc look = glint_material_desc_default();
    glint_shape_desc shape = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    glint_shape *out = NULL;
    for (int c = 0; c < 3; c++) {
        look.diffuse[c] = diffuse[c];
        look.specular[c] = 0.5;
        look.mirror[c] = mirror;
    }
    look.has_mirror = mirror > 0;
    assert_int_equal(glint_material_create(&look, &shape.material, NULL), GLINT_OK);
    shape.center[0] = x;
    shape.center[2] = z;
    shape.radius = radius;
    assert_int_equal(glint_shape_create(&shape, &out, NULL), GLINT_OK);
    glint_material_release(shape.material);
    return out;
}

/// Makes two balls in front of a bright background. `mirror` is the reflectance of one ball.
static void make_world(world *w, double mirror)
{
    static const double red[3] = { 0.8, 0.2, 0.1 }, blue[3] = { 0.1, 0.2, 0.9 };
    glint_camera_desc view = glint_camera_desc_default();
    glint_light_desc lamp = glint_light_desc_default(GLINT_LIGHT_POINT);
    glint_scene_desc desc = { .struct_size = sizeof(glint_scene_desc), .ambient = { 0.1, 0.1, 0.2 }, .background = { 1.5, 0.5, 0.25 } };
    glint_renderer_desc how = glint_renderer_desc_default();
    glint_light *light = NULL;
    glint_shape *shapes[2] = { ball(-1, 0, 1.5, red, 0), ball(1.5, -2, 2, blue, mirror) };
    view.eye[2] = 9;
    lamp.position[0] = lamp.position[1] = lamp.position[2] = 6;
    assert_int_equal(glint_scene_create(&w->scene, NULL), GLINT_OK);
    assert_int_equal(glint_camera_create(&view, &desc.camera, NULL), GLINT_OK);
    assert_int_equal(glint_scene_set(w->scene, &desc, NULL), GLINT_OK);
    assert_int_equal(glint_light_create(&lamp, &light, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_light(w->scene, light, NULL), GLINT_OK);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(glint_scene_add_shape(w->scene, shapes[i], NULL), GLINT_OK);
        glint_shape_release(shapes[i]);
    }
    glint_camera_release(desc.camera);
    glint_light_release(light);
    assert_int_equal(glint_renderer_create(&how, &w->renderer, NULL), GLINT_OK);
}

static void free_world(world *w)
{
    glint_renderer_destroy(w->renderer);
    glint_scene_release(w->scene);
}

static glint_image *render(world *w, const glint_render_desc *desc)
{
    glint_plan *plan = NULL;
    glint_image *image = NULL;
    assert_int_equal(glint_plan_create(w->scene, desc, &plan, NULL), GLINT_OK);
    assert_int_equal(glint_render(w->renderer, plan, &image, NULL, NULL), GLINT_OK);
    glint_plan_destroy(plan);
    return image;
}

static glint_render_desc small_frame(double samples, uint32_t passes)
{
    glint_render_desc desc = glint_render_desc_default();
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.samples = samples;
    desc.passes = passes;
    return desc;
}

// ---- Alpha ----------------------------------------------------------------------------------------------------------

/// Alpha removes only the background, from every sample that hits nothing.
static void test_alpha_passes(void **state)
{
    (void)state;
    world w;
    make_world(&w, 0);
    for (int samples = 1; samples <= 16; samples *= 4) {
        glint_render_desc desc = small_frame(samples, every_pass);
        glint_image *plain = render(&w, &desc);
        desc.alpha = true;
        glint_image *clear = render(&w, &desc);
        const float *alpha = clear->plane[GLINT_PASS_ALPHA][0];
        int partly = 0;
        for (size_t i = 0; i < PIXELS; i++) {
            assert_true(plain->plane[GLINT_PASS_ALPHA][0][i] == alpha[i]);
            assert_true(alpha[i] * (float)samples == floorf(alpha[i] * (float)samples));
            assert_true((double)plain->plane[GLINT_PASS_BACKGROUND][0][i] == 1.5 * (1 - (double)alpha[i]));
            partly += alpha[i] > 0 && alpha[i] < 1;
            for (int c = 0; c < 3; c++) {
                assert_true(clear->plane[GLINT_PASS_BACKGROUND][c][i] == 0);
                for (int pass = GLINT_PASS_AMBIENT; pass <= GLINT_PASS_SPECULAR; pass++)
                    assert_true(clear->plane[pass][c][i] == plain->plane[pass][c][i]);
            }
        }
        assert_true(samples == 1 ? partly == 0 : partly > 50);
        glint_image_release(plain);
        glint_image_release(clear);
    }
    free_world(&w);
}

/// The background's reflection in a mirror stays.
static void test_alpha_mirror(void **state)
{
    (void)state;
    world w;
    make_world(&w, 0.5);
    glint_render_desc desc = small_frame(4, every_pass);
    glint_image *plain = render(&w, &desc);
    desc.alpha = true;
    glint_image *clear = render(&w, &desc);
    double shown = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        assert_true(plain->plane[GLINT_PASS_MIRROR][0][i] == clear->plane[GLINT_PASS_MIRROR][0][i]);
        shown = fmax(shown, clear->plane[GLINT_PASS_MIRROR][0][i]);
    }
    assert_true(shown == 0.75);
    glint_image_release(plain);
    glint_image_release(clear);
    free_world(&w);
}

static unsigned png_code(const glint_png *png, size_t at)
{
    return png->bits == 16 ? ((uint16_t *)png->codes)[at] : ((uint8_t *)png->codes)[at];
}

static glint_png decode(const glint_image *image, const glint_render_desc *desc)
{
    glint_png png;
    uint8_t *data;
    size_t size;
    glint_write_desc how = describe("x.png");
    how.tone = desc->tone;
    assert_int_equal(glint_image_to_bytes(image, &how, &data, &size, NULL), GLINT_OK);
    assert_int_equal(glint_png_decode(data, size, &png, NULL), GLINT_OK);
    free(data);
    return png;
}

/// The pixel values are, by definition, beauty / alpha, and alpha. They are identical whether they are made during
/// rendering or from the planes.
static void test_alpha_codes(void **state)
{
    (void)state;
    world w;
    make_world(&w, 0.5);
    for (int i = 0; i < 8; i++) {
        glint_render_desc desc = small_frame(i & 1 ? 1 : 9, 1u << GLINT_PASS_BEAUTY);
        desc.alpha = true;
        desc.tone.bits = i & 2 ? 16 : 8;
        desc.tone.exposure = i & 4 ? 0.7 : 0;
        desc.tone.transfer = i & 4 ? GLINT_TRANSFER_LINEAR : GLINT_TRANSFER_SRGB;
        glint_image *cached = render(&w, &desc);
        desc.passes = 0;
        desc.codes = true;
        glint_image *coded = render(&w, &desc);
        assert_int_equal(coded->channels, 4);
        assert_null(coded->plane[GLINT_PASS_ALPHA][0]);
        glint_png a = decode(cached, &desc), b = decode(coded, &desc);
        const unsigned most = desc.tone.bits == 16 ? 65535 : 255;
        assert_int_equal(a.channels, 4);
        assert_memory_equal(a.codes, b.codes, PIXELS * 4 * (size_t)a.bits / 8);
        for (size_t p = 0; p < PIXELS; p++) {
            const float alpha = cached->plane[GLINT_PASS_ALPHA][0][p];
            assert_int_equal(png_code(&a, 4 * p + 3), (unsigned)floor((double)alpha * most + 0.5));
            for (size_t c = 0; c < 3; c++) {
                const float beauty = cached->plane[GLINT_PASS_BEAUTY][c][p];
                const double want = alpha > 0 ? glint_tone_value(&desc.tone, beauty / alpha) : 0;
                assert_int_equal(png_code(&a, 4 * p + c), (unsigned)want);
            }
        }
        free(a.codes);
        free(b.codes);
        glint_image_release(cached);
        glint_image_release(coded);
    }
    free_world(&w);
}

/// Where all samples hit, the picture equals the opaque one.
static void test_alpha_opaque(void **state)
{
    (void)state;
    world w;
    make_world(&w, 0);
    glint_render_desc desc = small_frame(4, 0);
    desc.codes = true;
    glint_image *plain = render(&w, &desc);
    desc.alpha = true;
    glint_image *clear = render(&w, &desc);
    const uint8_t *rgb = plain->codes, *rgba = clear->codes;
    int opaque = 0;
    for (size_t p = 0; p < PIXELS; p++) {
        if (rgba[4 * p + 3] < 255)
            continue;
        opaque++;
        assert_memory_equal(rgb + 3 * p, rgba + 4 * p, 3);
    }
    assert_true(opaque > 500);
    glint_image_release(plain);
    glint_image_release(clear);
    free_world(&w);
}

/// The bytes of a picture, read back, give its pixel values. Truncated bytes are refused wherever they are cut.
static void test_bytes_again(void **state)
{
    (void)state;
    world w;
    make_world(&w, 0);
    glint_render_desc desc = small_frame(4, 1u << GLINT_PASS_BEAUTY);
    glint_image *image = render(&w, &desc);
    const glint_png png = decode(image, &desc);
    glint_write_desc how = describe("x.png");
    how.tone = desc.tone;
    glint_picture *picture = NULL;
    glint_error error;
    uint8_t *data, row[3 * WIDTH];
    size_t size;
    assert_int_equal(glint_image_to_bytes(image, &how, &data, &size, NULL), GLINT_OK);
    assert_int_equal(glint_picture_from_bytes(data, size, &picture, &error), GLINT_OK);
    assert_int_equal(glint_picture_width(picture), WIDTH);
    assert_int_equal(glint_picture_height(picture), HEIGHT);
    for (int y = 0; y < HEIGHT; y++) {
        glint_picture_row(picture, y, 0, row);
        assert_memory_equal(row, (uint8_t *)png.codes + sizeof row * (size_t)y, sizeof row);
    }
    glint_picture_destroy(picture);
    for (size_t cut = 0; cut < size; cut += size / 50)
        assert_int_equal(glint_picture_from_bytes(data, cut, &picture, &error), GLINT_ERR_FORMAT);
    free(data);
    free(png.codes);
    glint_image_release(image);
    free_world(&w);
}

// ---- Outline --------------------------------------------------------------------------------------------------------

/// Returns whether a pixel has a line, from the hits of the pixel and its neighbours. Only valid for smooth shapes
/// that do not occlude themselves.
static bool ends_here(const glint_image *image, int x, int y)
{
    static const int steps[4][2] = { { 1, 0 }, { 0, 1 }, { -1, 0 }, { 0, -1 } };
    const float *id = image->plane[GLINT_PASS_OBJECT_ID][0], *depth = image->plane[GLINT_PASS_DEPTH][0];
    const size_t at = (size_t)y * WIDTH + (size_t)x;
    for (int i = 0; i < 4; i++) {
        const int u = x + steps[i][0], v = y + steps[i][1];
        const size_t next = (size_t)v * WIDTH + (size_t)u;
        if (u >= 0 && v >= 0 && u < WIDTH && v < HEIGHT && id[at] != id[next] && depth[at] < depth[next])
            return true;
    }
    return false;
}

/// The outlines of two balls, and no lines inside them.
static void test_outline_objects(void **state)
{
    (void)state;
    world w;
    make_world(&w, 0);
    glint_render_desc desc = small_frame(1, 1u << GLINT_PASS_OUTLINE);
    glint_image *image = render(&w, &desc);
    int lines = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const bool line = image->plane[GLINT_PASS_OUTLINE][0][y * WIDTH + x] == 1;
            assert_int_equal(line, ends_here(image, x, y));
            lines += line;
        }
    assert_true(lines > 100 && lines < 300);
    glint_image_release(image);
    free_world(&w);
}

/// Renders one shape with an orthographic camera. `height` is the height of the view, in scene units.
static glint_image *outline_of(glint_shape *shape, double height)
{
    world w;
    glint_camera_desc view = glint_camera_desc_default();
    glint_scene_desc desc = { .struct_size = sizeof(glint_scene_desc) };
    glint_renderer_desc how = glint_renderer_desc_default();
    view.projection = GLINT_PROJECTION_ORTHOGRAPHIC;
    view.height = height;
    view.eye[0] = 3;
    view.eye[1] = 4;
    view.eye[2] = 12;
    assert_int_equal(glint_scene_create(&w.scene, NULL), GLINT_OK);
    assert_int_equal(glint_camera_create(&view, &desc.camera, NULL), GLINT_OK);
    assert_int_equal(glint_scene_set(w.scene, &desc, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_shape(w.scene, shape, NULL), GLINT_OK);
    assert_int_equal(glint_renderer_create(&how, &w.renderer, NULL), GLINT_OK);
    glint_render_desc frame = small_frame(1, 1u << GLINT_PASS_OUTLINE);
    glint_image *image = render(&w, &frame);
    glint_camera_release(desc.camera);
    glint_shape_release(shape);
    free_world(&w);
    return image;
}

/// Counts the lines that are not at the silhouette of the shape.
static int inner_lines(const glint_image *image)
{
    int count = 0;
    for (int y = 1; y < HEIGHT - 1; y++)
        for (int x = 1; x < WIDTH - 1; x++)
            count += image->plane[GLINT_PASS_OUTLINE][0][y * WIDTH + x] == 1 && !ends_here(image, x, y);
    return count;
}

static glint_shape *make(const glint_shape_desc *desc)
{
    glint_shape *out = NULL;
    assert_int_equal(glint_shape_create(desc, &out, NULL), GLINT_OK);
    return out;
}

static glint_shape *two_quads(const double *vertices, size_t count, const uint32_t corners[8])
{
    static const uint32_t sizes[] = { 4, 4 };
    glint_mesh_desc desc = glint_mesh_desc_default();
    glint_shape *out = NULL;
    desc.vertices = vertices;
    desc.vertex_count = count;
    desc.corners = corners;
    desc.face_sizes = sizes;
    desc.face_count = 2;
    assert_int_equal(glint_mesh_create(&desc, &out, NULL), GLINT_OK);
    return out;
}

/// Lines appear on the three visible inner edges of a box, and in a mesh where one sheet occludes another and where
/// two meet. No lines appear on a ball of at least four pixels, on a smooth mesh with few triangles or on a plane
/// towards the horizon.
static void test_outline_edges(void **state)
{
    (void)state;
    glint_shape_desc box = glint_shape_desc_default(GLINT_SHAPE_BOX);
    glint_image *image = outline_of(make(&box), 5);
    const int edges = inner_lines(image); // three edges of 2 units, at about 10 pixels per unit, seen at an angle
    assert_true(edges > 30 && edges < 75);
    glint_image_release(image);
    for (double pixels = 4; pixels <= 25; pixels += 0.7) {
        glint_shape_desc ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
        ball.radius = 1;
        image = outline_of(make(&ball), HEIGHT / pixels);
        assert_int_equal(inner_lines(image), 0);
        glint_image_release(image);
    }
    static const double middle[3] = { 0, 0, 0 };
    for (double segments = 8; segments <= 64; segments *= 2) {
        glint_mesh_desc smooth = glint_mesh_desc_default();
        glint_shape *mesh = NULL;
        smooth.has_shading = true;
        smooth.shading = GLINT_SHADING_PHONG;
        assert_int_equal(glint_sphere_mesh_create(middle, 2, segments, &smooth, &mesh, NULL), GLINT_OK);
        image = outline_of(mesh, 5);
        assert_int_equal(inner_lines(image), 0);
        glint_image_release(image);
    }
    glint_shape_desc plane = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    plane.normal[1] = 1;
    image = outline_of(make(&plane), 5);
    assert_int_equal(inner_lines(image), 0);
    glint_image_release(image);
    static const double sheets[8][3] = { { -1, -1, 2 },  { 0, -1, 2 },  { 0, 1, 2 },  { -1, 1, 2 },
                                         { -3, -2, -2 }, { 3, -2, -2 }, { 3, 2, -2 }, { -3, 2, -2 } };
    static const double valley[6][3] = { { -2, -1, 2 }, { 0, -1, 0 }, { 0, 1, 0 }, { -2, 1, 2 }, { 2, -1, 2 }, { 2, 1, 2 } };
    image = outline_of(two_quads(&sheets[0][0], 8, (const uint32_t[]) { 0, 1, 2, 3, 4, 5, 6, 7 }), 5);
    const int steps = inner_lines(image); // 4 units along the top and the side of the front sheet
    assert_true(steps > 36 && steps < 50);
    glint_image_release(image);
    image = outline_of(two_quads(&valley[0][0], 6, (const uint32_t[]) { 0, 1, 2, 3, 1, 4, 5, 2 }), 5);
    const int bend = inner_lines(image); // a bend of 2 units
    assert_true(bend > 14 && bend < 30);
    glint_image_release(image);
}

/// The lines in the file cover the picture and leave all other pixels untouched:
/// in pixel values and planes, with and without alpha.
static void test_outline_drawn(void **state)
{
    (void)state;
    world w;
    make_world(&w, 0);
    for (int i = 0; i < 16; i++) {
        glint_render_desc desc = small_frame(4, i & 1 ? every_pass : 0);
        desc.codes = !(i & 1);
        desc.alpha = i & 2;
        desc.tone.bits = i & 4 ? 16 : 8;
        glint_image *plain = render(&w, &desc);
        desc.outline = i & 8 ? GLINT_OUTLINE_WHITE : GLINT_OUTLINE_BLACK;
        glint_image *drawn = render(&w, &desc);
        glint_png a = decode(plain, &desc), b = decode(drawn, &desc);
        const unsigned most = i & 4 ? 65535 : 255, ink = i & 8 ? most : 0;
        const size_t channels = i & 2 ? 4 : 3;
        for (size_t p = 0; p < PIXELS; p++) {
            const bool line = drawn->plane[GLINT_PASS_OUTLINE][0][p] == 1;
            for (size_t c = 0; c < channels; c++)
                assert_int_equal(png_code(&b, channels * p + c),
                                 !line    ? png_code(&a, channels * p + c)
                                 : c == 3 ? most
                                          : ink);
        }
        free(a.codes);
        free(b.codes);
        glint_image_release(plain);
        glint_image_release(drawn);
    }
    free_world(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_alpha_passes),
        cmocka_unit_test(test_alpha_mirror),
        cmocka_unit_test(test_alpha_codes),
        cmocka_unit_test(test_alpha_opaque),
        cmocka_unit_test(test_bytes_again),
        cmocka_unit_test(test_outline_objects),
        cmocka_unit_test(test_outline_edges),
        cmocka_unit_test(test_outline_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
