#include "engine/image/png.h"

#include "engine/base/status.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <zlib.h>

#define DEFLATE_RATIO_MAX 1032 // a stream cannot unpack to more than this many times its size

typedef struct reader {
    png_structp png;
    png_infop info;
    const uint8_t *data;
    size_t size, at;
    glint_png out;
    char message[128];
} reader;

static void give_bytes(png_structp png, png_bytep out, size_t size)
{
    reader *r = png_get_io_ptr(png);
    if (size > r->size - r->at)
        png_error(png, "ends too early");
    memcpy(out, r->data + r->at, size);
    r->at += size;
}

static void keep_message(png_structp png, png_const_charp message)
{
    reader *r = png_get_error_ptr(png);
    snprintf(r->message, sizeof r->message, "%s", message);
    png_longjmp(png, 1);
}

/// Warnings are none of ours, but that libpng goes on, out of step, where memory was short.
static void heed_warning(png_structp png, png_const_charp message)
{
    if (strstr(message, "emory"))
        keep_message(png, message);
}

static void read_header(reader *r)
{
    png_set_read_fn(r->png, r, give_bytes);
    png_set_user_limits(r->png, GLINT_SIDE_MAX, GLINT_SIDE_MAX);
    png_set_crc_action(r->png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_read_info(r->png, r->info);
    png_set_expand(r->png);
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    if (png_get_bit_depth(r->png, r->info) == 16)
        png_set_swap(r->png);
#endif
}

/// All that may jump.
static bool read_container(reader *r)
{
    if (setjmp(png_jmpbuf(r->png)))
        return false;
    read_header(r);
    int passes = png_set_interlace_handling(r->png);
    png_read_update_info(r->png, r->info);
    r->out.width = (int)png_get_image_width(r->png, r->info);
    r->out.height = (int)png_get_image_height(r->png, r->info);
    r->out.channels = png_get_channels(r->png, r->info);
    r->out.bits = png_get_bit_depth(r->png, r->info);
    size_t row_bytes = png_get_rowbytes(r->png, r->info), height = (size_t)r->out.height;
    // Expanding a palette or bits makes at most 32 times of what was packed.
    if (row_bytes / 32 * height / DEFLATE_RATIO_MAX > r->size)
        png_error(r->png, "too little data for its size");
    r->out.codes = calloc(height, row_bytes);
    if (!r->out.codes)
        png_error(r->png, "out of memory");
    for (int pass = 0; pass < passes; pass++)
        for (size_t y = 0; y < height; y++)
            png_read_row(r->png, (png_bytep)r->out.codes + y * row_bytes, NULL);
    png_read_end(r->png, NULL);
    return true;
}

glint_status glint_png_decode(const uint8_t *data, size_t size, glint_png *out, glint_error *error)
{
    reader *r = calloc(1, sizeof *r);
    if (!r)
        return glint_fail_nomem(error);
    r->data = data;
    r->size = size;
    bool done = false;
    snprintf(r->message, sizeof r->message, "out of memory");
    r->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, r, keep_message, heed_warning);
    r->info = r->png ? png_create_info_struct(r->png) : NULL;
    if (r->info)
        done = read_container(r);
    png_destroy_read_struct(&r->png, &r->info, NULL);
    glint_status status = GLINT_OK;
    if (done) {
        *out = r->out;
    } else {
        free(r->out.codes);
        bool memory = strstr(r->message, "emory") != NULL; // libpng has several wordings
        status =
            memory ? glint_fail_nomem(error) : glint_fail(error, GLINT_ERR_FORMAT, "not a whole PNG: %s", r->message);
    }
    free(r);
    return status;
}

// ---- Checking without decoding ------------------------------------------------------------------------------------

static uint32_t big_endian(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static bool is_text(const uint8_t *body, size_t size, const char *keyword, const char *value)
{
    size_t key = strlen(keyword), length = strlen(value);
    return size == key + 1 + length && memcmp(body, keyword, key + 1) == 0 &&
           memcmp(body + key + 1, value, length) == 0;
}

bool glint_png_has_text(const uint8_t *data, size_t size, const char *keyword, const char *value)
{
    static const uint8_t signature[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
    if (size < sizeof signature || memcmp(data, signature, sizeof signature) != 0)
        return false;
    bool found = false, pixels = false;
    for (size_t at = sizeof signature; size - at >= 12;) {
        const uint8_t *chunk = data + at;
        uint32_t length = big_endian(chunk);
        if (length > size - at - 12)
            return false;
        if (crc32_z(0, chunk + 4, (size_t)length + 4) != big_endian(chunk + 8 + length))
            return false;
        if (at == sizeof signature && memcmp(chunk + 4, "IHDR", 4) != 0)
            return false;
        pixels |= memcmp(chunk + 4, "IDAT", 4) == 0;
        found |= memcmp(chunk + 4, "tEXt", 4) == 0 && is_text(chunk + 8, length, keyword, value);
        at += 12 + (size_t)length;
        if (memcmp(chunk + 4, "IEND", 4) == 0)
            return found && pixels && length == 0 && at == size;
    }
    return false;
}
