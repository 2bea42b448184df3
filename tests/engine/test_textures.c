/// Textures: pixel values, wrapping, interpolation, footprints, slopes, and invalid files.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "engine/glint_files.h"
#include "engine/render/program/builder.h"
#include "tests/engine/png_case.h"
#include "tests/engine/cases/random.h"

static glint_error error;
static char path[64]; ///< path of a file that is unique to this process

static glint_texture *load(glint_wrap wrap, glint_filter filter, bool linear)
{
    glint_texture *texture;
    glint_texture_desc desc = glint_texture_desc_default();
    desc.wrap = wrap;
    desc.filter = filter;
    desc.linear = linear;
    if (glint_texture_read(path, &desc, &texture, &error))
        fail_msg("%s", error.message);
    return texture;
}

/// Samples a texture with the kernel that frames use. across, down: footprints in units of u and v.
static void texel_by_axis(const glint_texture *texture, double u, double v, double across, double down, double out[4])
{
    glint_builder *b;
    glint_program *p;
    glint_value at[4], color[4];
    const double inputs[GLINT_INPUT_COUNT] = { u, v, across, down };
    assert_int_equal(glint_builder_create(GLINT_PROGRAM_PATTERN, &b, &error), GLINT_OK);
    for (int k = 0; k < 4; k++)
        glint_builder_input(b, (glint_input)k, &at[k], &error);
    assert_int_equal(glint_builder_texel_by_axis(b, texture, at[0], at[1], at + 2, color, &error), GLINT_OK);
    assert_int_equal(glint_program_make(b, color, 4, &p, &error), GLINT_OK);
    assert_int_equal(glint_program_evaluate(p, inputs, out, &error), GLINT_OK);
    glint_program_release(p);
    glint_builder_destroy(b);
}

static void texel(const glint_texture *texture, double u, double v, double footprint, double out[4])
{
    texel_by_axis(texture, u, v, footprint, footprint, out);
}

static void expect(const glint_texture *texture, double u, double v, double red, double green, double blue,
                   double alpha)
{
    const double want[4] = { red, green, blue, alpha };
    double got[4];
    texel(texture, u, v, 0, got);
    for (int c = 0; c < 4; c++)
        if (!(fabs(got[c] - want[c]) < 1e-7))
            fail_msg("channel %d at %g, %g: %.9g, want %.9g", c, u, v, got[c], want[c]);
}

/// Writes a picture of 2 x 2 pixels: red, green above blue, partly transparent grey.
static void write_four(void)
{
    static const uint8_t four[] = { 255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 128, 128, 128, 51 };
    write_png(path, 2, 2, PNG_COLOR_TYPE_RGB_ALPHA, 8, 0, four);
}

/// A texture from the caller's memory equals one from a file.
static void test_memory(void **state)
{
    (void)state;
    static const uint8_t rgb[] = { 255, 0, 0, 0, 255, 0, 0, 0, 255, 128, 128, 128 };
    const double gray = glint_srgb_decode(128.0 / 255);
    glint_texture_desc desc = glint_texture_desc_default();
    glint_texture *t;
    desc.rgb = rgb;
    for (int side = -1; side < 2; side++) {
        desc.width = desc.height = side < 0 ? 70000 : side;
        assert_int_equal(glint_texture_create(&desc, &t, &error), side < 1 ? GLINT_ERR_INVALID : GLINT_OK);
        assert_true(side == 1 || strstr(error.message, "a picture of at most"));
    }
    glint_texture_release(t);
    desc.width = desc.height = 2;
    assert_int_equal(glint_texture_create(&desc, &t, &error), GLINT_OK);
    expect(t, 0.25, 0.75, 1, 0, 0, 1);
    expect(t, 0.75, 0.75, 0, 1, 0, 1);
    expect(t, 0.25, 0.25, 0, 0, 1, 1);
    expect(t, 0.75, 0.25, gray, gray, gray, 1);
    glint_texture_release(t);
    desc.rgb = NULL;
    assert_int_equal(glint_texture_create(&desc, &t, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "rgb, row: one of them expected");
}

static void test_codes(void **state)
{
    (void)state;
    const double gray = glint_srgb_decode(128.0 / 255);
    write_four();
    glint_texture *t = load(GLINT_WRAP_REPEAT, GLINT_FILTER_BILINEAR, false);
    assert_true(glint_texture_width(t) == 2 && glint_texture_height(t) == 2);
    expect(t, 0.25, 0.75, 1, 0, 0, 1); // in the texture, v points up
    expect(t, 0.75, 0.75, 0, 1, 0, 1);
    expect(t, 0.25, 0.25, 0, 0, 1, 1);
    expect(t, 0.75, 0.25, gray, gray, gray, 0.2);
    glint_texture_release(t);
    t = load(GLINT_WRAP_REPEAT, GLINT_FILTER_BILINEAR, true);
    expect(t, 0.75, 0.25, 128.0 / 255, 128.0 / 255, 128.0 / 255, 0.2);
    glint_texture_release(t);
    static const uint16_t wide[] = { 1000, 40000 };
    write_png(path, 2, 1, PNG_COLOR_TYPE_GRAY, 16, 1.0, wide); // a gamma chunk of 1 means linear pixel values
    t = load(GLINT_WRAP_CLAMP, GLINT_FILTER_BILINEAR, false);
    expect(t, 0.25, 0.5, 1000 / 65535.0, 1000 / 65535.0, 1000 / 65535.0, 1);
    expect(t, 0.75, 0.5, 40000 / 65535.0, 40000 / 65535.0, 40000 / 65535.0, 1);
    glint_texture_release(t);
    write_png(path, 2, 1, PNG_COLOR_TYPE_PALETTE, 8, 0, (uint8_t[]) { 2, 0 });
    t = load(GLINT_WRAP_CLAMP, GLINT_FILTER_BILINEAR, false);
    expect(t, 0.25, 0.5, 0, 0, 1, 1);
    glint_texture_release(t);
}

static void test_wrapping(void **state)
{
    (void)state;
    write_four();
    glint_texture *repeat = load(GLINT_WRAP_REPEAT, GLINT_FILTER_BILINEAR, false);
    glint_texture *clamp = load(GLINT_WRAP_CLAMP, GLINT_FILTER_BILINEAR, false);
    glint_texture *nearest = load(GLINT_WRAP_REPEAT, GLINT_FILTER_NEAREST, false);
    expect(repeat, 3.25, -4.25, 1, 0, 0, 1);
    expect(repeat, 0, 0.75, 0.5, 0.5, 0, 1); // a mean of green on the left and red on the right
    expect(repeat, 1, 0.75, 0.5, 0.5, 0, 1);
    expect(repeat, 0.5, 0.75, 0.5, 0.5, 0, 1);
    expect(repeat, 0.375, 0.75, 0.75, 0.25, 0, 1);
    expect(repeat, -1e-20, 0.75, 0.5, 0.5, 0, 1);
    expect(clamp, 0, 0.75, 1, 0, 0, 1);
    expect(clamp, -5, 7, 1, 0, 0, 1);
    expect(clamp, INFINITY, -INFINITY, glint_srgb_decode(128.0 / 255), glint_srgb_decode(128.0 / 255),
           glint_srgb_decode(128.0 / 255), 0.2);
    expect(clamp, NAN, 1, 1, 0, 0, 1);
    expect(nearest, 0.49, 0.51, 1, 0, 0, 1);
    expect(nearest, 0.51, 0.51, 0, 1, 0, 1);
    expect(nearest, -0.51, 1.49, 0, 0, 1, 1);
    glint_texture *around = load(GLINT_WRAP_AROUND, GLINT_FILTER_BILINEAR, false);
    expect(around, 1, 0.75, 0.5, 0.5, 0, 1); // the texture repeats horizontally
    expect(around, -2.75, 1, 1, 0, 0, 1); // the texture is clamped vertically
    expect(around, 0.25, -0.2, 0, 0, 1, 1);
    glint_texture_release(around);
    around = load(GLINT_WRAP_AROUND, GLINT_FILTER_NEAREST, false);
    expect(around, 1.3, 1.7, 1, 0, 0, 1);
    glint_texture_release(around);
    double any[4];
    texel(repeat, INFINITY, NAN, NAN, any); // the result is some texel of the picture
    assert_true(any[3] >= 0.2 && any[3] <= 1);
    glint_texture_release(repeat);
    glint_texture_release(clamp);
    glint_texture_release(nearest);
}

/// A 64 x 16 texture with one bright texel: its total light does not depend on the footprint.
static void test_footprints(void **state)
{
    (void)state;
    static uint8_t samples[64 * 16];
    samples[5 * 64 + 9] = 255;
    write_png(path, 64, 16, PNG_COLOR_TYPE_GRAY, 8, 0, samples);
    glint_texture *t = load(GLINT_WRAP_REPEAT, GLINT_FILTER_BILINEAR, true);
    double all[4], one[4], high[4], between_[4], low[4];
    texel_by_axis(t, 0.3, 0.3, 1, 1, all);
    assert_true(fabs(all[0] - 1.0 / (64 * 16)) < 1e-9);
    texel_by_axis(t, 9.5 / 64, 1 - 5.5 / 16, 1.0 / 64, 1.0 / 16, one);
    assert_true(one[0] == 1);
    texel_by_axis(t, 10.0 / 64, 1 - 5.0 / 16, 2.0 / 64, 2.0 / 16, high);
    texel_by_axis(t, 10.0 / 64, 1 - 5.0 / 16, 4.0 / 64, 4.0 / 16, low);
    texel_by_axis(t, 10.0 / 64, 1 - 5.0 / 16, sqrt(8) / 64, sqrt(8) / 16, between_);
    assert_true(high[0] > low[0] && fabs(between_[0] - (high[0] + low[0]) / 2) < 1e-12);
    double mean[2] = { 0 };
    for (int i = 0; i < 1024; i++) { // the samples at the centres of a level's texels have the texture's mean
        texel_by_axis(t, (i % 64 + 0.5) / 64, (i / 64 + 0.5) / 16, 4.0 / 64, 4.0 / 16, all);
        texel_by_axis(t, (i % 64 + 0.5) / 64, (i / 64 + 0.5) / 16, 12.0 / 64, 2.0 / 16, one);
        mean[0] += all[0] / 1024;
        mean[1] += one[0] / 1024;
    }
    assert_true(fabs(mean[0] - 1.0 / 1024) < 1e-9 && fabs(mean[1] - 1.0 / 1024) < 1e-9);
    // 4 texels wide and 1 high: the mean of bilinear colours at -1.5, -0.5, 0.5, 1.5 texels
    texel_by_axis(t, 9.5 / 64, 1 - 5.5 / 16, 4.0 / 64, 1.0 / 16, one);
    assert_true(fabs(one[0] - 0.25) < 1e-12);
    texel_by_axis(t, 11.0 / 64, 1 - 5.5 / 16, 4.0 / 64, 1.0 / 16, one);
    assert_true(fabs(one[0] - 0.25) < 1e-12);
    texel_by_axis(t, 9.5 / 64, 1 - 6.5 / 16, 4.0 / 64, 1.0 / 16, one);
    assert_true(one[0] == 0);
    texel_by_axis(t, 9.5 / 64, 1 - 7.5 / 16, 1.0 / 64, 5.0 / 16, one); // two texels below, of five
    assert_true(fabs(one[0] - 0.2) < 1e-12);
    glint_texture_release(t);
}

static void test_slopes(void **state)
{
    (void)state;
    uint8_t samples[3 * 13 * 7];
    random_state = 71000;
    for (size_t i = 0; i < sizeof samples; i++)
        samples[i] = (uint8_t)below(256);
    write_png(path, 13, 7, PNG_COLOR_TYPE_RGB, 8, 0, samples);
    for (int wrap = 0; wrap < 3; wrap++) {
        glint_texture *t = load((glint_wrap)wrap, GLINT_FILTER_BILINEAR, false);
        uint32_t kinks = 0;
        for (int i = 0; i < 2000; i++) {
            const double at[GLINT_OPERANDS_MAX] = { between(-1, 2), between(-1, 2), one_in(2) ? 0 : between(0, 1) };
            double slope[GLINT_RESULTS_MAX];
            glint_fold(GLINT_OP_TEXEL_SLOPE, t, at, slope);
            for (int axis = 0; axis < 2; axis++) {
                double low[GLINT_RESULTS_MAX], high[GLINT_RESULTS_MAX], p[GLINT_OPERANDS_MAX] = { at[0], at[1], at[2] };
                p[axis] -= 0x1p-30;
                glint_fold(GLINT_OP_TEXEL, t, p, low);
                p[axis] += 0x1p-29;
                glint_fold(GLINT_OP_TEXEL, t, p, high);
                for (int c = 0; c < 4; c++)
                    kinks += fabs((high[c] - low[c]) * 0x1p29 - slope[4 * axis + c]) > 1e-5;
            }
        }
        assert_int_equal(kinks, 0);
        glint_texture_release(t);
    }
}

static void expect_failure(glint_status want, const char *part)
{
    glint_texture *texture;
    glint_texture_desc desc = glint_texture_desc_default();
    assert_int_equal(glint_texture_read(path, &desc, &texture, &error), want);
    if (!strstr(error.message, part) || !strstr(error.message, path))
        fail_msg("'%s' has no '%s'", error.message, part);
}

static void test_files(void **state)
{
    (void)state;
    write_four();
    assert_int_equal(truncate(path, 60), 0);
    expect_failure(GLINT_ERR_FORMAT, "ends too early");
    FILE *file = fopen(path, "wb");
    fputs("no picture", file);
    fclose(file);
    expect_failure(GLINT_ERR_FORMAT, "does not begin as one");
    uint8_t *black = calloc(4097, 8200 / 8);
    write_png(path, 8193, 4097, PNG_COLOR_TYPE_GRAY, 1, 0, black);
    expect_failure(GLINT_ERR_FORMAT, "at most 33554432 pixels expected, got 8193 x 4097");
    write_png(path, 65536, 1, PNG_COLOR_TYPE_GRAY, 1, 0, black);
    expect_failure(GLINT_ERR_FORMAT, "at most 65535 pixels a side expected, got 65536 x 1");
    free(black);
    remove(path);
    expect_failure(GLINT_ERR_IO, "No such file");
    glint_texture *texture;
    glint_texture_desc desc = glint_texture_desc_default();
    assert_int_equal(glint_texture_create(&desc, &texture, &error), GLINT_ERR_INVALID);
    static const uint8_t rgb[3];
    desc.width = desc.height = 1;
    desc.rgb = rgb;
    desc.wrap = (glint_wrap)3;
    assert_int_equal(glint_texture_create(&desc, &texture, &error), GLINT_ERR_INVALID);
    glint_texture_release(NULL);
}

/// The key depends on the texels and on how they are read. A program retains its texture.
static void test_keys(void **state)
{
    (void)state;
    write_four();
    glint_texture *t[4] = { load(GLINT_WRAP_REPEAT, GLINT_FILTER_BILINEAR, false),
                            load(GLINT_WRAP_REPEAT, GLINT_FILTER_BILINEAR, false),
                            load(GLINT_WRAP_CLAMP, GLINT_FILTER_BILINEAR, false),
                            load(GLINT_WRAP_REPEAT, GLINT_FILTER_BILINEAR, true) };
    assert_true(glint_key_equal(glint_texture_key(t[0]), glint_texture_key(t[1])));
    assert_false(glint_key_equal(glint_texture_key(t[0]), glint_texture_key(t[2])));
    assert_false(glint_key_equal(glint_texture_key(t[0]), glint_texture_key(t[3])));
    glint_builder *b;
    glint_program *p;
    glint_value at[3], color[4];
    glint_builder_create(GLINT_PROGRAM_PATTERN, &b, &error);
    for (int k = 0; k < 3; k++)
        glint_builder_input(b, (glint_input)(GLINT_INPUT_UV_U + k), &at[k], &error);
    glint_builder_texel(b, t[0], at[0], at[1], at[2], color, &error);
    assert_int_equal(glint_builder_finish(b, color, 3, &p, &error), GLINT_OK);
    glint_builder_destroy(b);
    for (int i = 0; i < 4; i++)
        glint_texture_release(t[i]);
    double inputs[GLINT_INPUT_COUNT] = { [GLINT_INPUT_UV_U] = 0.25, [GLINT_INPUT_UV_V] = 0.25 }, out[3];
    assert_int_equal(glint_program_evaluate(p, inputs, out, &error), GLINT_OK);
    assert_true(out[0] == 0 && out[2] == 1);
    char *listing = glint_program_listing(p);
    assert_string_equal(listing, "r0 r1 r2 r3 = texel t0 uv.u uv.v footprint footprint\nreturn r0 r1 r2\n");
    free(listing);
    glint_program_release(p);
}

/// The same texels with another wrap mode: the new texture reads like one loaded with that mode, has its own key, and
/// outlives the first texture.
static void test_rewrap(void **state)
{
    (void)state;
    write_four();
    glint_texture *first = load(GLINT_WRAP_REPEAT, GLINT_FILTER_BILINEAR, false), *second, *third;
    assert_int_equal(glint_texture_rewrap(first, GLINT_WRAP_AROUND, &second, &error), GLINT_OK);
    assert_false(glint_key_equal(glint_texture_key(first), glint_texture_key(second)));
    glint_texture_release(first);
    expect(second, 0.25, 1, 1, 0, 0, 1);
    assert_int_equal(glint_texture_rewrap(second, GLINT_WRAP_CLAMP, &third, &error), GLINT_OK);
    glint_texture_release(second);
    expect(third, 1.5, 0.75, 0, 1, 0, 1);
    assert_true(glint_texture_width(third) == 2 && glint_texture_height(third) == 2);
    assert_int_equal(glint_texture_rewrap(third, (glint_wrap)3, &second, &error), GLINT_ERR_INVALID);
    assert_non_null(strstr(error.message, "wrap: repeat, clamp or around expected, got 3"));
    glint_texture_release(third);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_codes),  cmocka_unit_test(test_wrapping), cmocka_unit_test(test_footprints),
        cmocka_unit_test(test_slopes), cmocka_unit_test(test_files),    cmocka_unit_test(test_keys),
        cmocka_unit_test(test_rewrap), cmocka_unit_test(test_memory),
    };
    snprintf(path, sizeof path, "/tmp/glint_texture_%ld.png", (long)getpid());
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    remove(path);
    return failed;
}
