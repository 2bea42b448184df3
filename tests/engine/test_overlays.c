/// Labels, colour bars and axes: the pixel values that they write, their positions,
/// and the pixels that they leave untouched.
#include "engine/glint_inspect.h"
#include "tests/engine/cases/image_case.h"

#include "engine/figures/overlay/overlay.h"
#include "engine/figures/text/font.h"

#define WIDTH 160
#define HEIGHT 120
#define MIDDLE_X (WIDTH / 2 - 1) // the centre pixel of an item with an odd width that is placed at 0.5
#define MIDDLE_Y (HEIGHT / 2 - 1)

typedef struct world {
    glint_scene *scene;
    glint_overlay *overlay;
    glint_renderer *renderer;
    glint_render_desc render;
    glint_write_desc write;
} world;

static world make_world(const glint_overlay_desc *desc, double background)
{
    world w = { .render = glint_render_desc_default() };
    glint_renderer_desc renderer = glint_renderer_desc_default();
    glint_camera_desc view = glint_camera_desc_default();
    glint_camera *camera = NULL;
    glint_scene_desc scene = { .struct_size = sizeof(glint_scene_desc), .background = { background, background, background } };
    renderer.threads = 2;
    w.render.width = WIDTH;
    w.render.height = HEIGHT;
    w.render.passes = 0;
    w.render.codes = true;
    w.write.struct_size = sizeof w.write;
    w.write.pass = GLINT_PASS_BEAUTY;
    assert_int_equal(glint_camera_create(&view, &camera, NULL), GLINT_OK);
    assert_int_equal(glint_scene_create(&w.scene, NULL), GLINT_OK);
    scene.camera = camera;
    assert_int_equal(glint_scene_set(w.scene, &scene, NULL), GLINT_OK);
    glint_camera_release(camera);
    assert_int_equal(glint_overlay_create(desc, &w.overlay, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_overlay(w.scene, w.overlay, NULL), GLINT_OK);
    assert_int_equal(glint_renderer_create(&renderer, &w.renderer, NULL), GLINT_OK);
    return w;
}

static void drop_world(world *w)
{
    glint_overlay_release(w->overlay);
    glint_scene_release(w->scene);
    glint_renderer_destroy(w->renderer);
}

/// Renders a picture, writes it and reads it back.
static glint_picture *show(world *w, const char *name, glint_frame_stats *stats)
{
    glint_plan *plan = NULL;
    glint_image *image = NULL;
    glint_picture *picture = NULL;
    glint_error error = { 0 };
    w->write.path = in_folder(name);
    w->write.tone = w->render.tone;
    if (glint_plan_create(w->scene, &w->render, &plan, &error) || glint_render(w->renderer, plan, &image, stats, &error) ||
        glint_image_write(image, &w->write, &error) || glint_picture_read(w->write.path, true, &picture, &error))
        fail_msg("%s", error.message);
    glint_plan_destroy(plan);
    glint_image_release(image);
    return picture;
}

/// Returns the value of a pixel in a grey picture over a backdrop of 0.
static int grey(const glint_picture *picture, int x, int y)
{
    uint8_t row[3 * WIDTH];
    glint_picture_row(picture, y, 0, row);
    return row[3 * x + 1];
}

static glint_overlay_desc label_at(double x, double y, const char *text)
{
    glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_LABEL);
    desc.has_position = true;
    desc.position[0] = x;
    desc.position[1] = y;
    snprintf(desc.text, sizeof desc.text, "%s", text);
    return desc;
}

#define KEYS 36 ///< number of overlays in test_key

/// A pixel is white where the glyph has a bit; elsewhere the picture shows through. 13 pixels are the font's own
/// size; at 144 dpi a point has two pixels.
static void test_letters(void **state)
{
    (void)state;
    glint_overlay_desc desc = label_at(7, 5, "\xc2\xb0" "A\n\xce\xb1");
    desc.has_size = true;
    desc.size = 13; // 26 pixels
    world w = make_world(&desc, 0);
    w.write.dpi = 144;
    glint_picture *picture = show(&w, "letters.png", NULL);
    static const char *const letters[3] = { "\xc2\xb0", "A", "\xce\xb1" };
    static const int at[3][2] = { { 7, 5 }, { 7 + 16, 5 }, { 7, 5 + 30 } };
    int lit = 0, all = 0;
    for (int i = 0; i < 3; i++) {
        const char *text = letters[i];
        const uint8_t *glyph = glint_font_next(&text);
        for (int y = 0; y < 2 * GLINT_FONT_HEIGHT; y++)
            for (int x = 0; x < 2 * GLINT_FONT_WIDTH; x++) {
                const int bit = glyph[y / 2] >> (GLINT_FONT_WIDTH - 1 - x / 2) & 1;
                assert_int_equal(grey(picture, at[i][0] + x, at[i][1] + y), bit ? 255 : 0);
                lit += bit;
            }
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        all += grey(picture, i % WIDTH, i / WIDTH) > 0;
    assert_int_equal(all, lit); // no other pixels are lit
    glint_picture_destroy(picture);
    drop_world(&w);
}

/// A background of opacity o and value b over a pixel value c gives (c (255 - a) + b a) / 255, a = 255 o. With alpha
/// the background also covers transparent pixels.
static void test_background(void **state)
{
    (void)state;
    glint_overlay_desc desc = label_at(20, 10, " ");
    desc.has_background = true;
    desc.opacity = 0.6;
    for (int c = 0; c < 3; c++)
        desc.background[c] = 0.5;
    world w = make_world(&desc, 0.2);
    const int a = 153, ink = (int)(glint_srgb_encode(0.5) * 255 + 0.5), below = (int)(glint_srgb_encode(0.2) * 255 + 0.5);
    glint_picture *picture = show(&w, "eight.png", NULL);
    assert_int_equal(grey(picture, 20, 10), (below * (255 - a) + ink * a + 127) / 255);
    assert_int_equal(grey(picture, 19, 10), below);
    glint_picture_destroy(picture);
    w.render.tone.bits = 16;
    w.render.tone.transfer = GLINT_TRANSFER_LINEAR;
    picture = show(&w, "sixteen.png", NULL);
    assert_int_equal(glint_picture_bits(picture), 16);
    const double mixed = (0.2 * (255 - a) + 0.5 * a) / 255;
    assert_true(abs(grey(picture, 20, 10) - (int)(glint_srgb_encode(mixed) * 255 + 0.5)) <= 1);
    glint_picture_destroy(picture);
    w.render.tone = glint_tone_desc_default();
    w.render.alpha = true;
    picture = show(&w, "alpha.png", NULL);
    assert_int_equal(glint_picture_channels(picture), 4);
    uint8_t row[3 * WIDTH];
    glint_picture_row(picture, 10, 255, row); // the white backdrop shows through with a share of 0.4
    assert_true(abs(row[3 * 20] - (255 * (255 - a) + ink * a) / 255) <= 1);
    assert_int_equal(row[3 * 19], 255);
    glint_picture_destroy(picture);
    drop_world(&w);
}

/// The bar's centre line has the table's 256 colours in order, from bottom to top or left to right, over 512 pixels.
static void test_colors(void **state)
{
    (void)state;
    for (int horizontal = 0; horizontal < 2; horizontal++) {
        glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_COLORBAR);
        desc.map = GLINT_COLORMAP_TURBO;
        desc.orientation = horizontal ? GLINT_ORIENTATION_HORIZONTAL : GLINT_ORIENTATION_VERTICAL;
        desc.has_length = desc.has_size = true;
        desc.length = 512;
        desc.size = 13;
        world w = make_world(&desc, 0);
        w.render.width = w.render.height = 600;
        glint_picture *picture = show(&w, "bar.png", NULL);
        const uint32_t *table = glint_colormap_table(GLINT_COLORMAP_TURBO);
        uint8_t *rgb = malloc(600 * 600 * 3);
        assert_non_null(rgb);
        for (int y = 0; y < 600; y++)
            glint_picture_row(picture, y, 0, rgb + (size_t)y * 600 * 3);
        int found = 0;
        for (int start = 0; start < 600 * 600 && !found; start++) { // searches for the first colour of the bar
            const size_t step = horizontal ? 3 : 600 * 3;
            int i = 0;
            while (i < 512 && (horizontal ? start % 600 : start / 600) + i < 600) {
                const uint8_t *p = rgb + (size_t)start * 3 + (size_t)i * step;
                const uint32_t code = (uint32_t)p[0] << 16 | (uint32_t)p[1] << 8 | p[2];
                if (code != table[(horizontal ? i : 511 - i) / 2])
                    break;
                i++;
            }
            found = i == 512;
        }
        assert_true(found);
        free(rgb);
        glint_picture_destroy(picture);
        drop_world(&w);
    }
}

/// Seen from the front, x points right in red and y up in green, both with the given length. After a quarter turn
/// about y, z points left.
static void test_axes(void **state)
{
    (void)state;
    glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_AXES);
    desc.at[0] = desc.at[1] = 0.5;
    desc.has_length = desc.has_size = true;
    desc.length = 30;
    desc.size = 13;
    world w = make_world(&desc, 0);
    glint_picture *picture = show(&w, "axes.png", NULL);
    uint8_t row[3 * WIDTH];
    glint_picture_row(picture, MIDDLE_Y, 0, row);
    assert_true(row[3 * (MIDDLE_X + 20)] > 200 && row[3 * (MIDDLE_X + 20) + 1] < 100);
    assert_int_equal(row[3 * (MIDDLE_X - 20)], 0);
    glint_picture_row(picture, MIDDLE_Y - 20, 0, row);
    assert_true(row[3 * (MIDDLE_X) + 1] > 150 && row[3 * (MIDDLE_X)] < 100);
    glint_picture_destroy(picture);
    glint_camera_desc view = glint_camera_desc_default();
    view.eye[0] = 10;
    view.eye[2] = 0;
    assert_int_equal(glint_camera_set(glint_scene_get(w.scene)->camera, &view, NULL), GLINT_OK);
    picture = show(&w, "axes.png", NULL);
    glint_picture_row(picture, MIDDLE_Y, 0, row);
    assert_true(row[3 * (MIDDLE_X - 20) + 2] > 200 && row[3 * (MIDDLE_X - 20)] < 100);
    glint_picture_destroy(picture);
    drop_world(&w);
}

/// Seen from the front, the lowest edge is the x axis and the leftmost edge the y axis, at their projected pixels,
/// with marks at round numbers. The z axis, which points at the eye, has no marks. `values` moves the marks. No other
/// pixel has colour.
static void test_box_axes(void **state)
{
    (void)state;
    glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_AXES);
    desc.has_box = desc.has_size = true;
    desc.size = 8; // leaves space for a number every 19 pixels
    const double box[2][3] = { { -4, -3, 0 }, { 4, 3, 2 } };
    memcpy(desc.box, box, sizeof box);
    for (int named = 0; named < 2; named++) {
        desc.has_values = named;
        const double values[2][3] = { { 0, 0, 0 }, { 10, 1, 1 } };
        memcpy(desc.values, values, sizeof values);
        world w = make_world(&desc, 0);
        glint_camera_desc view = glint_camera_desc_default();
        view.projection = GLINT_PROJECTION_ORTHOGRAPHIC;
        view.height = 12; // one unit is 10 pixels
        assert_int_equal(glint_camera_set(glint_scene_get(w.scene)->camera, &view, NULL), GLINT_OK);
        glint_picture *picture = show(&w, "box.png", NULL);
        for (int x = 42; x < 118; x++) // the edge is at y = 90, and half of the line's width is on each side
            assert_true(grey(picture, x, 89) > 100 && grey(picture, x, 90) > 100);
        for (int y = 32; y < 88; y++)
            assert_true(grey(picture, 39, y) > 100 && grey(picture, 40, y) > 100);
        for (int y = 0; y < 89; y++)
            for (int x = 41; x < WIDTH; x++)
                assert_int_equal(grey(picture, x, y), 0); // nothing is drawn inside, above or at the right of the box
        int marks = 0;
        for (int x = 42; x < 118; x++)
            marks += grey(picture, x, 92) > 100 && grey(picture, x - 1, 92) <= 100;
        const int at[2][2] = { { 60, 100 }, { 56, 104 } }; // marks at -2 and 2; or, for the range 0 .. 10, at 2 and 8
        for (int i = 0; i < 2; i++)
            assert_true(grey(picture, at[named][i], 92) > 100 && grey(picture, at[named][i] - 3, 92) == 0);
        // marks at 2, 4, 6 and 8; or at -2, 0 and 2, as the marks at the ends are outside these columns
        assert_int_equal(marks, named ? 4 : 3);
        glint_picture_destroy(picture);
        drop_world(&w);
    }
}

/// Returns whether a point is inside a triangle of three of the eight points, and so inside the points' convex hull.
static bool is_within(double at[8][2], double x, double y)
{
    for (int a = 0; a < 8; a++)
        for (int b = a + 1; b < 8; b++)
            for (int c = b + 1; c < 8; c++) {
                const double u = (at[b][0] - at[a][0]) * (y - at[a][1]) - (at[b][1] - at[a][1]) * (x - at[a][0]);
                const double v = (at[c][0] - at[b][0]) * (y - at[b][1]) - (at[c][1] - at[b][1]) * (x - at[b][0]);
                const double t = (at[a][0] - at[c][0]) * (y - at[c][1]) - (at[a][1] - at[c][1]) * (x - at[c][0]);
                if ((u > 0 && v > 0 && t > 0) || (u < 0 && v < 0 && t < 0))
                    return true;
            }
    return false;
}

/// Projects the corners of `box` with a camera at `eye` that looks at the origin, y up.
static void project_box(const glint_overlay_desc *desc, const glint_camera_desc *view, double at[8][2])
{
    double forward[3], length = 0;
    for (int c = 0; c < 3; c++)
        length += view->eye[c] * view->eye[c];
    for (int c = 0; c < 3; c++)
        forward[c] = -view->eye[c] / sqrt(length);
    const double flat = sqrt(forward[0] * forward[0] + forward[2] * forward[2]);
    const double right[3] = { -forward[2] / flat, 0, forward[0] / flat };
    const double up[3] = { right[1] * forward[2] - right[2] * forward[1], right[2] * forward[0] - right[0] * forward[2],
                           right[0] * forward[1] - right[1] * forward[0] };
    const bool parallel = view->projection == GLINT_PROJECTION_ORTHOGRAPHIC;
    for (int i = 0; i < 8; i++) {
        double x = 0, y = 0, z = 0;
        for (int c = 0; c < 3; c++) {
            const double d = desc->box[i >> c & 1][c] - view->eye[c];
            x += d * right[c], y += d * up[c], z += d * forward[c];
        }
        const double scale = HEIGHT / 2.0 / (parallel ? view->height / 2 : z * tan(view->fov_y_rad / 2));
        at[i][0] = WIDTH / 2.0 + x * scale;
        at[i][1] = HEIGHT / 2.0 - y * scale;
    }
}

/// For every eye outside the box, no axis, mark, number or name covers the box in the picture, and some of them
/// appear around the box.
static void test_box_outside(void **state)
{
    (void)state;
    glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_AXES);
    desc.has_box = true;
    const double box[2][3] = { { -2, -1, -1.5 }, { 1, 1.2, 3 } };
    memcpy(desc.box, box, sizeof box);
    world w = make_world(&desc, 0);
    for (int i = 0; i < 60; i++) {
        glint_camera_desc view = glint_camera_desc_default();
        const double turn = 2.399963 * i, lift = -1.5 + 3.0 * (i + 0.5) / 60, far = 5 + i % 7;
        double at[8][2];
        view.projection = i % 2 ? GLINT_PROJECTION_ORTHOGRAPHIC : GLINT_PROJECTION_PERSPECTIVE;
        view.eye[0] = far * cos(lift) * sin(turn);
        view.eye[1] = far * sin(lift);
        view.eye[2] = far * cos(lift) * cos(turn);
        view.fov_y_rad = 1.2;
        assert_int_equal(glint_camera_set(glint_scene_get(w.scene)->camera, &view, NULL), GLINT_OK);
        glint_picture *picture = show(&w, "outside.png", NULL);
        project_box(&desc, &view, at);
        double middle[2] = { 0, 0 };
        int lit = 0;
        for (int k = 0; k < 16; k++)
            middle[k % 2] += at[k / 2][k % 2] / 8;
        for (int y = 0; y < HEIGHT; y++) {
            uint8_t row[3 * WIDTH];
            glint_picture_row(picture, y, 0, row);
            for (int x = 0; x < WIDTH; x++) {
                const double dx = x + 0.5 - middle[0], dy = y + 0.5 - middle[1], away = sqrt(dx * dx + dy * dy) + 1e-9;
                const double farther = 1 + 3 / away; // allows for the lines' own width
                if (row[3 * x] > 0 && is_within(at, middle[0] + dx * farther, middle[1] + dy * farther))
                    fail_msg("view %d: a pixel at %d, %d lies over the box", i, x, y);
                lit += row[3 * x] > 0;
            }
        }
        assert_true(lit > 60);
        glint_picture_destroy(picture);
    }
    drop_world(&w);
}

/// A picture of a region has the same pixels as that part of the whole picture.
static void test_region(void **state)
{
    (void)state;
    glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_COLORBAR);
    snprintf(desc.text, sizeof desc.text, "K");
    desc.has_background = true;
    world w = make_world(&desc, 0.3);
    glint_picture *whole = show(&w, "whole.png", NULL);
    const int64_t region[4] = { 77, 31, 83, 60 };
    memcpy(w.render.region, region, sizeof region);
    glint_picture *part = show(&w, "part.png", NULL);
    uint8_t a[3 * WIDTH], b[3 * WIDTH];
    for (int y = 0; y < 60; y++) {
        glint_picture_row(whole, 31 + y, 0, a);
        glint_picture_row(part, y, 0, b);
        assert_memory_equal(a + 3 * 77, b, 3 * 83);
    }
    glint_picture_destroy(whole);
    glint_picture_destroy(part);
    drop_world(&w);
}

/// Returns the overlays of a picture as SVG for a page of `factor` times its size.
static char *svg_on_page(const glint_image *image, int factor, double least)
{
    const glint_page page = { .width = factor * WIDTH, .height = factor * HEIGHT, .scale = factor, .least = least };
    glint_error error = { 0 };
    char *svg = NULL;
    if (glint_image_overlays_svg(image, &page, &svg, &error))
        fail_msg("%s", error.message);
    return svg;
}

/// Reads the ends of the line in an SVG.
static void read_line(const char *svg, double ends[4])
{
    assert_int_equal(sscanf(strstr(svg, "d=\"M"), "d=\"M%lf %lfL%lf %lf", &ends[0], &ends[1], &ends[2], &ends[3]), 4);
}

/// On a page, the overlays are vectors of the page's size. The picture below them has no overlays.
static void test_page(void **state)
{
    (void)state;
    glint_overlay_desc line = glint_overlay_desc_default(GLINT_OVERLAY_LINE), label = label_at(21, 13, "K");
    glint_error error = { 0 };
    glint_overlay *other = NULL;
    glint_plan *plan = NULL;
    glint_image *image = NULL;
    double once[4], twice[4];
    static uint8_t rgba[4 * WIDTH * HEIGHT];
    line.from[0] = -1;
    line.to[0] = 1;
    label.has_background = true;
    world w = make_world(&line, 1);
    assert_int_equal(glint_overlay_create(&label, &other, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_overlay(w.scene, other, NULL), GLINT_OK);
    if (glint_plan_create(w.scene, &w.render, &plan, &error) || glint_render(w.renderer, plan, &image, NULL, &error))
        fail_msg("%s", error.message);
    char *small = svg_on_page(image, 1, 0), *large = svg_on_page(image, 2, 26), *none;
    assert_non_null(strstr(small, "viewBox=\"0 0 160 120\""));
    assert_non_null(strstr(large, "viewBox=\"0 0 320 240\""));
    read_line(small, once);
    read_line(large, twice);
    for (int i = 0; i < 4; i++)
        assert_float_equal(twice[i], 2 * once[i], 0.002);
    assert_float_equal(twice[0] + twice[2], 320, 0.002); // the camera looks at the line's middle
    assert_float_equal(twice[1], 120, 0.001);
    assert_non_null(strstr(small, "<rect x=\"21\" y=\"13\""));
    assert_non_null(strstr(large, "<rect x=\"42\" y=\"26\""));
    assert_non_null(strstr(small, "font-size=\"13\"")); // the bitmap font has no 10 pixels
    assert_non_null(strstr(large, "font-size=\"26\""));
    const glint_write_desc plain = { .struct_size = sizeof(glint_write_desc), .pass = GLINT_PASS_BEAUTY, .tone = w.render.tone };
    assert_int_equal(glint_image_rgba(glint_image_without_overlays(image), &plain, rgba, &error), GLINT_OK);
    for (size_t i = 0; i < sizeof rgba; i++)
        assert_int_equal(rgba[i], 255);
    const glint_page bad = { .width = WIDTH, .height = 0, .scale = 1 };
    assert_int_equal(glint_image_overlays_svg(image, &bad, &none, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "page.height: expected 1 .. 65535, got 0");
    free(small);
    free(large);
    glint_image_release(image);
    glint_plan_destroy(plan);
    glint_overlay_release(other);
    drop_world(&w);
}

/// Returns the overlays of a scene with one overlay as SVG for a page of the picture's size.
static char *one_on_page(const glint_overlay_desc *desc, double least)
{
    world w = make_world(desc, 1);
    glint_plan *plan = NULL;
    glint_image *image = NULL;
    assert_int_equal(glint_plan_create(w.scene, &w.render, &plan, NULL), GLINT_OK);
    assert_int_equal(glint_render(w.renderer, plan, &image, NULL, NULL), GLINT_OK);
    char *svg = svg_on_page(image, 1, least);
    glint_image_release(image);
    glint_plan_destroy(plan);
    drop_world(&w);
    return svg;
}

/// Stores the smallest and the largest value of an attribute, which is written with its quotation mark: ` y="`.
static void span_of(const char *svg, const char *attribute, double span[2])
{
    span[0] = INFINITY;
    span[1] = -INFINITY;
    for (const char *at = svg; (at = strstr(at, attribute)) != NULL; at++) {
        const double value = atof(at + strlen(attribute));
        span[0] = fmin(span[0], value);
        span[1] = fmax(span[1], value);
    }
}

/// A formula that is wider than the page breaks before a sign outside its fences. A bar becomes shorter.
static void test_fit(void **state)
{
    (void)state;
    glint_overlay_desc label = glint_overlay_desc_default(GLINT_OVERLAY_LABEL), bar = glint_overlay_desc_default(GLINT_OVERLAY_COLORBAR);
    double x[2], y[2];
    snprintf(label.text, sizeof label.text, "$a = b\\,(c + d) + e + f + (g - h) - i$");
    char *whole = one_on_page(&label, 0), *broken = one_on_page(&label, 13);
    span_of(whole, "<text x=\"", x);
    assert_true(x[1] > WIDTH); // 13 pixels are more than a script without a size gets
    span_of(broken, "<text x=\"", x);
    assert_true(x[0] >= 0 && x[1] < WIDTH - 5);
    span_of(whole, " y=\"", y);
    assert_float_equal(y[0], y[1], 0);
    span_of(broken, " y=\"", y);
    assert_true(y[1] - y[0] >= 13 && y[1] - y[0] < 2 * 13 + 1); // two lines
    assert_null(strchr(broken, '$'));
    free(whole);
    free(broken);
    bar.low = 0;
    bar.high = 1;
    char *fits = one_on_page(&bar, 13);
    span_of(fits, " y=\"", y);
    assert_true(y[0] >= 0 && y[1] <= HEIGHT); // ten font sizes are 130 pixels
    free(fits);
}

/// Returns the attribute of the text Q, and the largest one of all texts in *most.
static double place_of_q(const char *svg, const char *attribute, double *most)
{
    double span[2];
    const char *end = strstr(svg, ">Q<"), *at = end;
    assert_non_null(end);
    while (strncmp(at, "<text ", 6) != 0)
        at--;
    span_of(svg, attribute, span);
    *most = span[1];
    at = strstr(at, attribute);
    assert_true(at && at < end);
    return atof(at + strlen(attribute));
}

/// The label of a curve is next to the area of the curves. On pages that enlarge letters, it is inside, away from the curve.
static void test_legend(void **state)
{
    (void)state;
    const double x[] = { 0, 1, 2, 3, 4, 5, 6, 7, 8 };
    const double y[2][9] = { { 0, 0, 0, 0, 0, 0, 8, 8, 8 }, { 8, 8, 8, 0, 0, 0, 0, 0, 0 } };
    double at[2][2], most;
    for (int i = 0; i < 2; i++) {
        const glint_curve curve = { .label = "Q", .x = x, .y = y[i], .count = 9 };
        glint_overlay_desc desc = glint_overlay_desc_default(GLINT_OVERLAY_CHART);
        assert_int_equal(glint_chart_create(&curve, 1, &desc.chart, NULL), GLINT_OK);
        desc.has_extent = true;
        desc.extent[0] = desc.extent[1] = 72;
        char *wide = one_on_page(&desc, 0), *narrow = one_on_page(&desc, 15);
        const double beside = place_of_q(wide, "<text x=\"", &most);
        assert_float_equal(beside, most, 0);
        at[i][0] = place_of_q(narrow, "<text x=\"", &most);
        assert_true(at[i][0] < 126 - 13 - 8); // the paper ends at 126, the area a font size before, and Q is 8 pixels wide
        at[i][1] = place_of_q(narrow, " y=\"", &most);
        free(wide);
        free(narrow);
        glint_chart_release(desc.chart);
    }
    assert_true(at[0][0] < at[1][0] - 10); // the left end of a curve that rises, the right end of one that falls
    assert_float_equal(at[0][1], at[1][1], 0);
}

/// A changed text changes the key of beauty and the bytes of the file, and runs no stage again. The planes, the other
/// passes and their keys stay the same. The earlier picture is unchanged.
static void test_reuse(void **state)
{
    (void)state;
    glint_overlay_desc desc = label_at(3, 3, "one");
    world w = make_world(&desc, 0.3);
    glint_frame_stats stats;
    glint_image *images[4] = { NULL };
    char keys[4][33], depth_keys[4][33];
    uint8_t *bytes[4];
    size_t sizes[4];
    w.render.passes = 1u << GLINT_PASS_DEPTH;
    w.write.path = "x.png";
    w.write.tone = w.render.tone;
    for (int i = 0; i < 4; i++) {
        glint_plan *plan = NULL;
        snprintf(desc.text, sizeof desc.text, "%s", i < 3 ? "one" : "two");
        assert_int_equal(glint_overlay_set(w.overlay, &desc, NULL), GLINT_OK);
        assert_int_equal(glint_plan_create(w.scene, &w.render, &plan, NULL), GLINT_OK);
        assert_int_equal(glint_render(w.renderer, plan, &images[i], &stats, NULL), GLINT_OK);
        glint_write_desc depth = w.write;
        depth.pass = GLINT_PASS_DEPTH;
        glint_frame_key(plan, &w.write, keys[i]);
        glint_frame_key(plan, &depth, depth_keys[i]);
        glint_plan_destroy(plan);
    }
    for (int i = 0; i < stats.stage_count; i++)
        assert_true(stats.stage_reused[i] == 1);
    for (int i = 0; i < 4; i++)
        assert_int_equal(glint_image_to_bytes(images[i], &w.write, &bytes[i], &sizes[i], NULL), GLINT_OK);
    assert_string_equal(keys[0], keys[2]);
    assert_string_not_equal(keys[2], keys[3]);
    assert_string_equal(depth_keys[2], depth_keys[3]);
    assert_true(sizes[0] == sizes[2] && memcmp(bytes[0], bytes[2], sizes[0]) == 0);
    assert_false(sizes[2] == sizes[3] && memcmp(bytes[2], bytes[3], sizes[2]) == 0);
    for (int i = 0; i < 4; i++) {
        free(bytes[i]);
        glint_image_release(images[i]);
    }
    drop_world(&w);
}

/// Pictures of a job through the writer, which caches bands of the previous picture, equal pictures written separately.
static void test_writer(void **state)
{
    (void)state;
    glint_overlay_desc desc = label_at(3, 50, "0");
    world w = make_world(&desc, 0.3);
    glint_writer *writer = NULL;
    assert_int_equal(glint_writer_create(2, 2, &writer, NULL), GLINT_OK);
    for (int i = 0; i < 5; i++) {
        glint_plan *plan = NULL;
        glint_image *image = NULL;
        glint_write_result result;
        snprintf(desc.text, sizeof desc.text, "%s", i == 3 ? "" : i % 2 ? "odd" : "even");
        assert_int_equal(glint_overlay_set(w.overlay, &desc, NULL), GLINT_OK);
        assert_int_equal(glint_plan_create(w.scene, &w.render, &plan, NULL), GLINT_OK);
        assert_int_equal(glint_render(w.renderer, plan, &image, NULL, NULL), GLINT_OK);
        w.write.tone = w.render.tone;
        w.write.path = in_folder("job.png");
        assert_int_equal(glint_writer_submit(writer, image, &w.write, NULL, NULL), GLINT_OK);
        assert_true(glint_writer_collect(writer, true, &result));
        assert_int_equal(result.status, GLINT_OK);
        glint_bytes job = read_ok(in_folder("job.png"));
        w.write.path = in_folder("alone.png");
        assert_int_equal(glint_image_write(image, &w.write, NULL), GLINT_OK);
        glint_bytes alone = read_ok(in_folder("alone.png"));
        assert_true(job.size == alone.size && memcmp(job.data, alone.data, job.size) == 0);
        free(job.data);
        free(alone.data);
        glint_plan_destroy(plan);
        glint_image_release(image);
    }
    glint_writer_destroy(writer);
    drop_world(&w);
}

/// The key depends on each field of an overlay.
static void test_key(void **state)
{
    (void)state;
    glint_overlay_desc bar = glint_overlay_desc_default(GLINT_OVERLAY_COLORBAR), axes = glint_overlay_desc_default(GLINT_OVERLAY_AXES);
    const glint_overlay_desc arrow = glint_overlay_desc_default(GLINT_OVERLAY_ARROW), arc = glint_overlay_desc_default(GLINT_OVERLAY_ARC);
    glint_overlay_desc changed[KEYS];
    for (size_t i = 0; i < KEYS; i++)
        changed[i] = bar;
    changed[1].text[0] = 'x';
    changed[2].at[0] = 0.3;
    changed[3].has_position = true;
    changed[4].has_size = true, changed[4].size = 9;
    changed[5].has_margin = true;
    changed[6].color[2] = 0.5;
    changed[7].has_background = true;
    changed[8].has_background = true, changed[8].background[1] = 1;
    changed[9].opacity = 0.5;
    changed[10].has_length = true, changed[10].length = 40;
    changed[11].map = GLINT_COLORMAP_MAGMA;
    changed[12].low = -1;
    changed[13].high = 2;
    changed[14].orientation = GLINT_ORIENTATION_HORIZONTAL;
    changed[15].tick_count = 1, changed[15].ticks[0] = 0.5;
    changed[16] = axes;
    changed[17] = axes, changed[17].names[1][0] = 'b';
    changed[18] = axes, changed[18].has_box = true, changed[18].box[1][0] = 2;
    changed[19] = changed[18], changed[19].box[1][0] = 3;
    changed[20] = changed[18], changed[20].has_values = true, changed[20].values[1][0] = 2;
    changed[21] = changed[20], changed[21].values[1][0] = 3;
    changed[22] = arrow;
    changed[23] = arrow, changed[23].from[1] = 1;
    changed[24] = arrow, changed[24].to[2] = 1;
    changed[25] = arrow, changed[25].has_width = true;
    changed[26] = changed[25], changed[26].width = 3;
    changed[27] = arrow, changed[27].hidden = GLINT_HIDDEN_DASHED;
    changed[28] = arrow, changed[28].kind = GLINT_OVERLAY_LINE;
    changed[29] = arc;
    changed[30] = arc, changed[30].point[0] = 1;
    changed[31] = arc, changed[31].has_radius = true, changed[31].radius = 1;
    changed[32] = changed[31], changed[32].radius = 2;
    changed[33] = label_at(0, 0, "a");
    changed[34] = changed[33], changed[34].has_point = true;
    changed[35] = changed[34], changed[35].point[2] = -1;
    char keys[KEYS][33];
    for (size_t i = 0; i < KEYS; i++) {
        world w = make_world(&changed[i], 0);
        glint_plan *plan = NULL;
        assert_int_equal(glint_plan_create(w.scene, &w.render, &plan, NULL), GLINT_OK);
        w.write.path = "x.png";
        glint_frame_key(plan, &w.write, keys[i]);
        for (size_t k = 0; k < i; k++)
            assert_string_not_equal(keys[k], keys[i]);
        glint_plan_destroy(plan);
        drop_world(&w);
    }
}

int main(void)
{
    setenv("GLINT_FONT", "bitmap", 1); // uses the font that gives the same pixels on every machine
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_letters), cmocka_unit_test(test_background), cmocka_unit_test(test_colors),
        cmocka_unit_test(test_axes),    cmocka_unit_test(test_box_axes), cmocka_unit_test(test_box_outside),
        cmocka_unit_test(test_region),  cmocka_unit_test(test_page), cmocka_unit_test(test_fit), cmocka_unit_test(test_legend),      cmocka_unit_test(test_reuse),
        cmocka_unit_test(test_writer),  cmocka_unit_test(test_key),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
