#include "engine/files/picture/png.h"

#include "engine/base/status.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <zlib.h>

#define DEFLATE_RATIO_MAX 1032 // the highest possible compression ratio of a deflate stream

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

static void store_message(png_structp png, png_const_charp message)
{
    reader *r = png_get_error_ptr(png);
    snprintf(r->message, sizeof r->message, "%s", message);
    png_longjmp(png, 1);
}

/// Ignores warnings except those about memory, after which libpng would continue with wrong data.
static void heed_warning(png_structp png, png_const_charp message)
{
    if (strstr(message, "emory"))
        store_message(png, message);
}

static void read_header(reader *r)
{
    png_set_read_fn(r->png, r, give_bytes);
    png_set_user_limits(r->png, GLINT_SIDE_MAX, GLINT_SIDE_MAX);
    png_set_crc_action(r->png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_keep_unknown_chunks(r->png, PNG_HANDLE_CHUNK_NEVER, NULL, -1); // texts and profiles are not decompressed
    png_read_info(r->png, r->info);
    const uint64_t height = png_get_image_height(r->png, r->info);
    if (png_get_rowbytes(r->png, r->info) * height / DEFLATE_RATIO_MAX > r->size)
        png_error(r->png, "too little data for its size");
    png_set_expand(r->png);
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    if (png_get_bit_depth(r->png, r->info) == 16)
        png_set_swap(r->png);
#endif
}

/// Contains all calls that may jump.
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
    r->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, r, store_message, heed_warning);
    r->info = r->png ? png_create_info_struct(r->png) : NULL;
    if (r->info)
        done = read_container(r);
    png_destroy_read_struct(&r->png, &r->info, NULL);
    glint_status status = GLINT_OK;
    if (done) {
        *out = r->out;
    } else {
        free(r->out.codes);
        bool memory = strstr(r->message, "emory") != NULL; // libpng has several messages
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

/// One chunk of a PNG in memory.
typedef struct chunk {
    const uint8_t *type, *body;
    uint32_t size; ///< size of the chunk's body, bytes
} chunk;

static bool is_type(const chunk *c, const char *type) { return memcmp(c->type, type, 4) == 0; }

/// Reads the chunk at *at and moves *at past it. False: there is no whole chunk with a right CRC.
static bool next_chunk(const uint8_t *data, size_t size, size_t *at, chunk *out)
{
    if (size - *at < 12)
        return false;
    const uint8_t *from = data + *at;
    uint32_t length = big_endian(from);
    if (length > size - *at - 12 || crc32_z(0, from + 4, (size_t)length + 4) != big_endian(from + 8 + length))
        return false;
    *out = (chunk) { from + 4, from + 8, length };
    *at += 12 + (size_t)length;
    return true;
}

static bool has_signature(const uint8_t *data, size_t size)
{
    static const uint8_t signature[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
    return size >= sizeof signature && memcmp(data, signature, sizeof signature) == 0;
}

#define FIRST_CHUNK 8 // after the signature

bool glint_png_has_text(const uint8_t *data, size_t size, const char *keyword, const char *value)
{
    bool found = false, pixels = false, first = true;
    size_t at = FIRST_CHUNK;
    chunk c;
    if (!has_signature(data, size))
        return false;
    while (next_chunk(data, size, &at, &c)) {
        if (first && !is_type(&c, "IHDR"))
            return false;
        first = false;
        pixels |= is_type(&c, "IDAT");
        found |= is_type(&c, "tEXt") && is_text(c.body, c.size, keyword, value);
        if (is_type(&c, "IEND"))
            return found && pixels && c.size == 0 && at == size;
    }
    return false;
}

/// Returns the width (0) or height (1) in IHDR; 0: not an IHDR.
static uint32_t side_of(const chunk *c, int which)
{
    return is_type(c, "IHDR") && c->size == 13 ? big_endian(c->body + 4 * which) : 0;
}

/// Reads IHDR into the head. False: no valid picture has this IHDR.
static bool read_ihdr(const chunk *c, glint_png_head *head)
{
    static const int channels[7] = { 1, 0, 3, 3, 2, 0, 4 };
    const uint32_t width = side_of(c, 0), height = side_of(c, 1);
    if (width < 1 || width > GLINT_SIDE_MAX || height < 1 || height > GLINT_SIDE_MAX || c->body[9] > 6)
        return false;
    head->width = (int)width;
    head->height = (int)height;
    head->bits = c->body[8] == 16 ? 16 : 8;
    head->channels = channels[c->body[9]];
    return head->channels > 0;
}

static glint_status refuse_ihdr(const chunk *c, glint_error *error)
{
    const uint32_t width = side_of(c, 0), height = side_of(c, 1);
    if (width <= GLINT_SIDE_MAX && height <= GLINT_SIDE_MAX)
        return glint_fail(error, GLINT_ERR_FORMAT, "not a whole PNG: no size");
    return glint_fail(error, GLINT_ERR_FORMAT, "a picture of at most %d pixels a side expected, got %u x %u",
                      GLINT_SIDE_MAX, width, height);
}

/// Facts from earlier chunks that decide whether a tRNS chunk counts.
typedef struct seen_chunks {
    int color; ///< colour type in IHDR: 0 grey, 2 RGB, 3 palette
    uint32_t palette; ///< entries
    bool pixels;
} seen_chunks;

/// Returns whether the decoder accepts a tRNS chunk, which must have the right length for the picture's colour type. It
/// then becomes an alpha channel.
static bool is_transparency(const chunk *c, const seen_chunks *seen)
{
    if (seen->pixels)
        return false;
    return seen->color == 0 ? c->size == 2 : seen->color == 2 ? c->size == 6 : 0 < c->size && c->size <= seen->palette;
}

/// Reads one chunk other than pixels into the head.
static void read_ancillary(const chunk *c, seen_chunks *seen, glint_png_head *head)
{
    if (is_type(c, "IHDR") && c->size == 13)
        seen->color = c->body[9];
    if (is_type(c, "PLTE"))
        seen->palette = c->size / 3;
    seen->pixels |= is_type(c, "IDAT");
    if (is_type(c, "gAMA") && c->size == 4)
        head->transfer = big_endian(c->body) == 100000 ? GLINT_TRANSFER_LINEAR : GLINT_TRANSFER_SRGB;
    else if (is_type(c, "acTL") && c->size == 8)
        head->is_animated = big_endian(c->body) > 1;
    else if (is_type(c, "tRNS") && is_transparency(c, seen))
        head->channels += head->channels == 1 || head->channels == 3;
}

uint64_t glint_png_raw_bytes(const uint8_t *data, size_t size)
{
    glint_png_head head = { 0 };
    uint64_t frames = 1;
    size_t at = FIRST_CHUNK;
    chunk c;
    if (!has_signature(data, size) || !next_chunk(data, size, &at, &c) || !read_ihdr(&c, &head))
        return 0;
    while (next_chunk(data, size, &at, &c) && !is_type(&c, "IDAT"))
        if (is_type(&c, "acTL") && c.size == 8)
            frames = 1 + (uint64_t)big_endian(c.body);
    return ((uint64_t)head.width * (uint64_t)(head.channels * head.bits / 8) + 1) * (uint64_t)head.height * frames;
}

glint_status glint_png_scan(const uint8_t *data, size_t size, glint_png_head *out,
                            bool (*text)(void *user, const uint8_t *bytes, size_t size), void *user, glint_error *error)
{
    glint_png_head head = { .transfer = GLINT_TRANSFER_SRGB };
    seen_chunks seen = { 0 };
    size_t at = FIRST_CHUNK;
    chunk c;
    if (!has_signature(data, size))
        return glint_fail(error, GLINT_ERR_FORMAT, "not a whole PNG: it does not begin as one");
    while (next_chunk(data, size, &at, &c)) {
        if (!head.width && !read_ihdr(&c, &head))
            return refuse_ihdr(&c, error);
        read_ancillary(&c, &seen, &head);
        if (text && is_type(&c, "tEXt") && !text(user, c.body, c.size))
            return glint_fail_nomem(error);
        if (is_type(&c, "IEND")) {
            *out = head;
            return seen.pixels && at == size ? GLINT_OK
                                        : glint_fail(error, GLINT_ERR_FORMAT, "not a whole PNG: no picture in it");
        }
    }
    return glint_fail(error, GLINT_ERR_FORMAT, "not a whole PNG: it ends too early or is damaged");
}
