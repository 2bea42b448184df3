// Float image files: .npy files are read by their format, .exr files by the OpenEXR library, and the values must equal
// the planes. Crops and black pictures are compared with the planes of the whole image.
#include "tests/engine/cases/image_case.h"

#include <float.h>
#include <stdlib.h>

#define WIDTH 37
#define HEIGHT 41 // more than two blocks of .exr rows
#define PIXELS (WIDTH * HEIGHT)

static float random_float(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)((double)(*state >> 8) / (1 << 20) - 4);
}

/// An image with random planes of either sign in these passes, including infinities and NaN.
static glint_image *make_planes(uint32_t passes)
{
    glint_image *image = NULL;
    uint32_t state = 7;
    assert_int_equal(glint_image_create(WIDTH, HEIGHT, passes, NULL, &image, NULL), GLINT_OK);
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++)
        for (int c = 0; c < 3; c++)
            for (size_t i = 0; image->plane[pass][c] && i < PIXELS; i++)
                image->plane[pass][c][i] = i == 5 ? INFINITY : i == 6 ? -INFINITY : i == 7 ? NAN : random_float(&state);
    return image;
}

/// Returns the value that a file stores: colours are made finite, distances stay unchanged.
static float expected(glint_pass pass, float value)
{
    if (glint_pass_channels(pass) == 1)
        return value;
    return isnan(value) ? 0 : isinf(value) ? copysignf(FLT_MAX, value) : value;
}

static bool same(float a, float b) { return a == b || (isnan(a) && isnan(b)); }

static void write_bytes(const glint_image *image, const char *path, glint_pass pass, int bits, uint8_t **data,
                        size_t *size)
{
    static const glint_text texts[] = { { "Software", "glint" }, { "glint:params", "a=1\nb=2" }, { "glint:key", "" } };
    glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = path, .pass = pass, .text = texts, .text_count = 3 };
    desc.tone = glint_tone_desc_default();
    desc.tone.bits = bits;
    assert_int_equal(glint_image_to_bytes(image, &desc, data, size, NULL), GLINT_OK);
}

static void check_npy(const glint_image *image, glint_pass pass)
{
    uint8_t *data;
    size_t size;
    char shape[64];
    const int channels = glint_pass_channels(pass);
    write_bytes(image, "x.npy", pass, 8, &data, &size);
    assert_memory_equal(data, "\x93NUMPY\x01\x00", 8);
    const size_t head = 10 + (data[8] | (size_t)data[9] << 8);
    assert_int_equal(head % 64, 0);
    assert_int_equal(data[head - 1], '\n');
    assert_int_equal(size, head + PIXELS * (size_t)channels * 4);
    data[head - 1] = '\0';
    snprintf(shape, sizeof shape, "'shape': (%d, %d, %d)", HEIGHT, WIDTH, channels);
    assert_non_null(strstr((char *)data + 10, shape));
    assert_non_null(strstr((char *)data + 10, "'descr': '<f4', 'fortran_order': False"));
    for (size_t i = 0; i < PIXELS; i++)
        for (int c = 0; c < channels; c++) {
            float value;
            memcpy(&value, data + head + (i * (size_t)channels + (size_t)c) * 4, 4);
            assert_true(same(value, expected(pass, image->plane[pass][c][i])));
        }
    free(data);
}

static void test_npy(void **state)
{
    (void)state;
    glint_image *image = make_planes(every_pass);
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++)
        check_npy(image, (glint_pass)pass);
    glint_image_release(image);
}

// ---- OpenEXR --------------------------------------------------------------------------------------------------------

#ifdef GLINT_HAVE_OPENEXR
#include <openexr.h>

typedef struct memory {
    const uint8_t *data;
    size_t size;
} memory;

static int64_t read_bytes(exr_const_context_t context, void *user, void *to, uint64_t size, uint64_t offset,
                          exr_stream_error_func_ptr_t fail)
{
    const memory *from = user;
    (void)context, (void)fail;
    const uint64_t rest = offset < from->size ? from->size - offset : 0, count = size < rest ? size : rest;
    memcpy(to, from->data + offset, (size_t)count);
    return (int64_t)count;
}

/// Reads the channel with this name as floats, top row first. Returns false when there is none.
static bool read_channel(const memory *file, const char *name, float *out, uint16_t *type)
{
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t context;
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t lines = 0;
    bool found = false;
    how.user_data = (void *)(uintptr_t)file;
    how.read_fn = read_bytes;
    assert_int_equal(exr_start_read(&context, "memory", &how), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_scanlines_per_chunk(context, 0, &lines), EXR_ERR_SUCCESS);
    for (int y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        assert_int_equal(exr_read_scanline_chunk_info(context, 0, y, &chunk), EXR_ERR_SUCCESS);
        if (y == 0)
            assert_int_equal(exr_decoding_initialize(context, 0, &chunk, &pipe), EXR_ERR_SUCCESS);
        else
            assert_int_equal(exr_decoding_update(context, 0, &chunk, &pipe), EXR_ERR_SUCCESS);
        for (int c = 0; c < pipe.channel_count; c++) {
            exr_coding_channel_info_t *info = &pipe.channels[c];
            const bool wanted = strcmp(info->channel_name, name) == 0;
            info->decode_to_ptr = wanted ? (uint8_t *)(out + (size_t)y * WIDTH) : NULL;
            info->user_data_type = EXR_PIXEL_FLOAT;
            info->user_bytes_per_element = info->user_pixel_stride = 4;
            info->user_line_stride = 4 * WIDTH;
            if (wanted)
                *type = info->data_type;
            found = found || wanted;
        }
        if (y == 0)
            assert_int_equal(exr_decoding_choose_default_routines(context, 0, &pipe), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_run(context, 0, &pipe), EXR_ERR_SUCCESS);
    }
    exr_decoding_destroy(context, &pipe);
    exr_finish(&context);
    return found;
}

static void check_channel(const memory *file, const glint_image *image, const char *name, glint_pass pass, int c,
                          bool half)
{
    static float read[PIXELS];
    uint16_t type = 99;
    assert_true(read_channel(file, name, read, &type));
    assert_int_equal(type, half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT);
    for (size_t i = 0; i < PIXELS; i++) {
        const float want = expected(pass, image->plane[pass][c][i]);
        if (half && fabsf(want) > 65520)
            assert_true(isinf(read[i]) && (read[i] > 0) == (want > 0));
        else if (half && isfinite(want)) // half: 11 significant bits, and a spacing of 2^-24 among the subnormals
            assert_true(fabsf(read[i] - want) <= fabsf(want) * 0x1p-11f + 0x1p-25f);
        else
            assert_true(same(read[i], want));
    }
}

static void test_exr(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        glint_pass pass;
        int c;
        bool keeps_float;
    } channels[] = { { "R", GLINT_PASS_BEAUTY, 0, false },          { "G", GLINT_PASS_BEAUTY, 1, false },
                     { "B", GLINT_PASS_BEAUTY, 2, false },          { "A", GLINT_PASS_ALPHA, 0, false },
                     { "depth.Z", GLINT_PASS_DEPTH, 0, true },      { "object_id.ID", GLINT_PASS_OBJECT_ID, 0, true },
                     { "normal.X", GLINT_PASS_NORMAL, 0, false },   { "normal.Z", GLINT_PASS_NORMAL, 2, false },
                     { "diffuse.G", GLINT_PASS_DIFFUSE, 1, false }, { "outline.Y", GLINT_PASS_OUTLINE, 0, true },
                     { "albedo.B", GLINT_PASS_ALBEDO, 2, false } };
    glint_image *image = make_planes(every_pass);
    for (int bits = 8; bits <= 16; bits += 8) {
        uint8_t *data;
        size_t size;
        float unread[PIXELS];
        uint16_t type;
        write_bytes(image, "x.EXR", GLINT_PASS_BEAUTY, bits, &data, &size);
        const memory file = { data, size };
        for (size_t i = 0; i < sizeof channels / sizeof *channels; i++)
            check_channel(&file, image, channels[i].name, channels[i].pass, channels[i].c,
                          bits == 16 && !channels[i].keeps_float);
        assert_false(read_channel(&file, "beauty.R", unread, &type));
        free(data);
    }
    glint_image_release(image);
}

/// Checks that the bytes of a file depend only on the image.
static void test_exr_again(void **state)
{
    (void)state;
    uint8_t *data[2];
    size_t size[2];
    glint_image *image = make_planes(1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_DEPTH);
    for (int i = 0; i < 2; i++)
        write_bytes(image, "x.exr", GLINT_PASS_BEAUTY, 8, &data[i], &size[i]);
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(data[0], data[1], size[0]);
    assert_non_null(strstr(glint_exr_library(), "OpenEXR 3."));
    free(data[0]);
    free(data[1]);
    glint_image_release(image);
}
#else
static void test_exr(void **state)
{
    (void)state;
    uint8_t *data;
    size_t size;
    glint_error error;
    glint_image *image = make_planes(1u << GLINT_PASS_BEAUTY);
    const glint_write_desc desc = { .struct_size = sizeof(glint_write_desc), .path = "x.exr", .tone = glint_tone_desc_default() };
    assert_int_equal(glint_image_to_bytes(image, &desc, &data, &size, &error), GLINT_ERR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "OpenEXR"));
    assert_null(glint_exr_library());
    glint_image_release(image);
}
#endif

// ---- Parts and black pictures ---------------------------------------------------------------------------------------

static void test_crop(void **state)
{
    (void)state;
    const int x = 3, y = 11, width = 20, height = 7;
    glint_image *image = make_planes(every_pass), *part = NULL;
    assert_int_equal(glint_image_crop(image, x, y, width, height, &part, NULL), GLINT_OK);
    assert_int_equal(glint_image_width(part), width);
    assert_int_equal(glint_image_height(part), height);
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++)
        for (int i = 0; i < width * height; i++) {
            float a[3], b[3];
            glint_image_pixel(part, (glint_pass)pass, i % width, i / width, a, NULL);
            glint_image_pixel(image, (glint_pass)pass, x + i % width, y + i / width, b, NULL);
            for (int c = 0; c < 3; c++)
                assert_true(same(a[c], b[c]));
        }
    glint_image_release(part);
    glint_image_release(image);
}

static void test_black(void **state)
{
    (void)state;
    for (int bits = 8; bits <= 16; bits += 8) {
        glint_tone_desc tone = glint_tone_desc_default();
        glint_image *image = NULL;
        tone.bits = bits;
        assert_int_equal(glint_image_create(WIDTH, HEIGHT, 0, &tone, &image, NULL), GLINT_OK);
        memset(image->codes, 0, PIXELS * 3u * (size_t)(bits / 8));
        assert_true(glint_image_is_black(image));
        ((uint8_t *)image->codes)[PIXELS * 3u * (size_t)(bits / 8) - 1] = 1;
        assert_false(glint_image_is_black(image));
        glint_image_release(image);
    }
    glint_image *image = make_planes(1u << GLINT_PASS_BEAUTY);
    assert_false(glint_image_is_black(image));
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < PIXELS; i++)
            image->plane[GLINT_PASS_BEAUTY][c][i] = i == 7 ? NAN : 0;
    assert_true(glint_image_is_black(image));
    glint_image_release(image);
    image = make_planes(1u << GLINT_PASS_DEPTH);
    assert_false(glint_image_is_black(image)); // without a beauty pass, the image's light is unknown
    glint_image_release(image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_npy),       cmocka_unit_test(test_exr),
#ifdef GLINT_HAVE_OPENEXR
        cmocka_unit_test(test_exr_again),
#endif
        cmocka_unit_test(test_crop),      cmocka_unit_test(test_black),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
