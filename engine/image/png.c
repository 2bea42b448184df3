#include "engine/image/png.h"

#include "engine/base/status.h"
#include "engine/image/deflate.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>

#define FILTER_SUB 1
#define BAND_BYTES ((size_t)1 << 18) // of filtered rows; fixed, so that no setting changes the file
#define CHUNK_BYTES ((size_t)1 << 20) // of one IDAT
#define VECTOR 16

typedef uint8_t vector8 __attribute__((vector_size(VECTOR)));
typedef uint16_t vector16 __attribute__((vector_size(VECTOR)));

// ---- Rows ---------------------------------------------------------------------------------------------------------

/// Filter SUB: each byte less the one `step` bytes before it.
static void filter_sub(const uint8_t *row, size_t bytes, size_t step, uint8_t *out)
{
    *out++ = FILTER_SUB;
    memcpy(out, row, step);
    size_t i = step;
    for (; i + VECTOR <= bytes; i += VECTOR) {
        vector8 here, before;
        memcpy(&here, row + i, VECTOR);
        memcpy(&before, row + i - step, VECTOR);
        here -= before;
        memcpy(out + i, &here, VECTOR);
    }
    for (; i < bytes; i++)
        out[i] = (uint8_t)(row[i] - row[i - step]);
}

/// Native 16-bit codes to the file's order, high byte first; `out` may be `codes`.
static void swap_to_file(const uint16_t *codes, size_t count, uint8_t *out)
{
    size_t i = 0;
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    for (; i + VECTOR / 2 <= count; i += VECTOR / 2) {
        vector16 v;
        memcpy(&v, codes + i, VECTOR);
        v = v << 8 | v >> 8;
        memcpy(out + 2 * i, &v, VECTOR);
    }
#endif
    for (; i < count; i++) {
        uint16_t code = codes[i];
        out[2 * i] = (uint8_t)(code >> 8);
        out[2 * i + 1] = (uint8_t)code;
    }
}

typedef struct rows {
    const glint_png_source *source;
    size_t row_bytes; ///< without the filter's byte
    void *scratch, *swapped; ///< a row each; swapped for 16 bits only
} rows;

static void filter_rows(const rows *r, int first, int count, uint8_t *out)
{
    const glint_png_source *source = r->source;
    for (int y = first; y < first + count; y++) {
        const void *codes = source->row(source->user, y, r->scratch);
        if (source->bits == 16) {
            swap_to_file(codes, r->row_bytes / 2, r->swapped);
            codes = r->swapped;
        }
        filter_sub(codes, r->row_bytes, source->bits == 16 ? 6 : 3, out);
        out += r->row_bytes + 1;
    }
}

// ---- Bands --------------------------------------------------------------------------------------------------------

/// Rows in one band; every band of a picture but the last has this many.
static int rows_a_band(const rows *r, glint_encode encode)
{
    if (!glint_deflate_has_bands(encode))
        return r->source->height;
    size_t count = BAND_BYTES / (r->row_bytes + 1);
    return count < 1 ? 1 : count > (size_t)r->source->height ? r->source->height : (int)count;
}

/// The zlib stream of the whole picture, band by band.
static glint_status deflate_bands(const rows *r, glint_encode encode, glint_bytes *stream, glint_error *error)
{
    int height = r->source->height, step = rows_a_band(r, encode);
    uint8_t *raw = malloc((r->row_bytes + 1) * (size_t)step); // at most 2^35
    if (!raw)
        return glint_fail_nomem(error);
    glint_status status = glint_deflate_begin(stream) ? GLINT_OK : glint_fail_nomem(error);
    uint32_t sum = 1;
    for (int y = 0; y < height && !status; y += step) {
        int count = height - y < step ? height - y : step;
        size_t size = (r->row_bytes + 1) * (size_t)count;
        uint32_t band_sum = 1;
        filter_rows(r, y, count, raw);
        status = glint_deflate_band(encode, raw, size, y + count == height, stream, &band_sum, error);
        sum = glint_deflate_join(sum, band_sum, size);
    }
    free(raw);
    if (!status && !glint_deflate_end(stream, sum))
        status = glint_fail_nomem(error);
    return status;
}

static glint_status deflate_picture(const glint_png_source *source, glint_encode encode, glint_bytes *stream,
                                    glint_error *error)
{
    size_t row_bytes = (size_t)source->width * 3 * (source->bits == 16 ? 2 : 1);
    rows r = { source, row_bytes, malloc(row_bytes), source->bits == 16 ? malloc(row_bytes) : NULL };
    glint_status status = r.scratch && (r.swapped || source->bits == 8) ? GLINT_OK : glint_fail_nomem(error);
    if (!status)
        status = deflate_bands(&r, encode, stream, error);
    free(r.scratch);
    free(r.swapped);
    return status;
}

// ---- Text ---------------------------------------------------------------------------------------------------------

static bool is_latin1(uint8_t c) { return (c >= 32 && c <= 126) || c >= 161; }

static bool is_keyword(const char *keyword)
{
    size_t length = keyword ? strlen(keyword) : 0;
    if (length < 1 || length > 79 || keyword[0] == ' ' || keyword[length - 1] == ' ' || strstr(keyword, "  "))
        return false;
    for (size_t i = 0; i < length; i++)
        if (!is_latin1((uint8_t)keyword[i]))
            return false;
    return true;
}

/// UTF-8 to Latin-1; what Latin-1 does not have, and control bytes but the line's end, become '?'.
static void copy_as_latin1(const char *value, char *out)
{
    const uint8_t *from = (const uint8_t *)value;
    while (*from) {
        uint8_t c = *from++;
        if ((c == 0xc2 || c == 0xc3) && (*from & 0xc0) == 0x80)
            c = (uint8_t)(c << 6 | (*from++ & 0x3f));
        else if (c >= 0x80) {
            while ((*from & 0xc0) == 0x80)
                from++;
            c = '?';
        }
        *out++ = (char)(is_latin1(c) || c == '\n' ? c : '?');
    }
    *out = '\0';
}

static glint_status check_text(const glint_text *text, size_t count, glint_error *error)
{
    for (size_t i = 0; i < count; i++) {
        if (!is_keyword(text[i].keyword))
            return glint_fail(error, GLINT_ERR_INVALID,
                              "text: keyword of 1 .. 79 Latin-1 characters expected, got '%.80s'",
                              text[i].keyword ? text[i].keyword : "");
        if (!text[i].value || strlen(text[i].value) > GLINT_PNG_TEXT_MAX)
            return glint_fail(error, GLINT_ERR_INVALID, "text: '%s': value of at most %d bytes expected",
                              text[i].keyword, GLINT_PNG_TEXT_MAX);
    }
    return GLINT_OK;
}

// ---- The container ------------------------------------------------------------------------------------------------

typedef struct container {
    png_structp png;
    png_infop info;
    const glint_png_source *source;
    const glint_text *text;
    size_t text_count;
    const glint_bytes *stream;
    glint_bytes *out;
    char *latin1; ///< room for the longest value
} container;

static void take_bytes(png_structp png, png_bytep data, size_t size)
{
    if (!glint_bytes_append(png_get_io_ptr(png), data, size))
        png_error(png, "out of memory");
}

static void nothing_to_flush(png_structp png) { (void)png; }

static void jump_out(png_structp png, png_const_charp message)
{
    (void)message;
    png_longjmp(png, 1);
}

/// Arguments are checked, so that a warning too can only mean that memory is short: no file without its text.
static void heed_warning(png_structp png, png_const_charp message)
{
    if (strstr(message, "emory"))
        jump_out(png, message);
}

static void set_text(container *c)
{
    for (size_t i = 0; i < c->text_count; i++) {
        copy_as_latin1(c->text[i].value, c->latin1);
        png_text entry = { .compression = PNG_TEXT_COMPRESSION_NONE };
        entry.key = (png_charp)(uintptr_t)c->text[i].keyword; // copied by libpng
        entry.text = c->latin1;
        png_set_text(c->png, c->info, &entry, 1);
    }
}

/// All that may jump. False: libpng ran out of memory (nothing else can fail once the arguments are checked).
static bool write_container(container *c)
{
    if (setjmp(png_jmpbuf(c->png)))
        return false;
    const glint_png_source *source = c->source;
    png_set_write_fn(c->png, c->out, take_bytes, nothing_to_flush);
    png_set_IHDR(c->png, c->info, (png_uint_32)source->width, (png_uint_32)source->height, source->bits,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (source->transfer == GLINT_TRANSFER_SRGB)
        png_set_sRGB(c->png, c->info, PNG_sRGB_INTENT_PERCEPTUAL);
    else
        png_set_gAMA_fixed(c->png, c->info, 100000);
    set_text(c);
    png_write_info(c->png, c->info);
    for (size_t at = 0; at < c->stream->size; at += CHUNK_BYTES) {
        size_t rest = c->stream->size - at;
        png_write_chunk(c->png, (png_const_bytep) "IDAT", c->stream->data + at,
                        rest < CHUNK_BYTES ? rest : CHUNK_BYTES);
    }
    png_write_chunk(c->png, (png_const_bytep) "IEND", NULL, 0);
    return true;
}

static glint_status put_in_container(container *c, glint_error *error)
{
    size_t longest = 0;
    for (size_t i = 0; i < c->text_count; i++)
        longest = strlen(c->text[i].value) > longest ? strlen(c->text[i].value) : longest;
    bool done = false;
    c->latin1 = malloc(longest + 1);
    c->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, jump_out, heed_warning);
    c->info = c->png ? png_create_info_struct(c->png) : NULL;
    if (c->latin1 && c->info && glint_bytes_reserve(c->out, c->stream->size + 1024))
        done = write_container(c);
    png_destroy_write_struct(&c->png, &c->info);
    free(c->latin1);
    return done ? GLINT_OK : glint_fail_nomem(error);
}

glint_status glint_png_encode(const glint_png_source *source, glint_encode encode, const glint_text *text,
                              size_t text_count, glint_bytes *out, glint_error *error)
{
    glint_status status = check_text(text, text_count, error);
    if (status)
        return status;
    glint_bytes stream = { 0 };
    status = deflate_picture(source, encode, &stream, error);
    if (!status) {
        container c = { .source = source, .text = text, .text_count = text_count, .stream = &stream, .out = out };
        status = put_in_container(&c, error);
    }
    free(stream.data);
    return status;
}
