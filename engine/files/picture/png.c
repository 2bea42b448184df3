#include "engine/files/picture/png.h"

#include "engine/base/status.h"
#include "engine/files/picture/bands.h"
#include "engine/files/picture/libpng.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>

#define CHUNK_BYTES ((size_t)1 << 20) // of one IDAT

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

/// Converts UTF-8 to Latin-1. Characters that Latin-1 lacks, and control bytes except the newline, become '?'.
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
    double dpi;
    const glint_bytes *stream;
    glint_bytes *out;
    char *latin1; ///< buffer for the longest value
} container;

static void take_bytes(png_structp png, png_bytep data, size_t size)
{
    if (!glint_bytes_append(png_get_io_ptr(png), data, size))
        png_error(png, "out of memory");
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

/// Contains all calls that may jump. False: libpng ran out of memory (nothing else can fail once the arguments are
/// checked).
static bool write_container(container *c)
{
    if (setjmp(png_jmpbuf(c->png)))
        return false;
    const glint_png_source *source = c->source;
    png_set_write_fn(c->png, c->out, take_bytes, glint_png_flush);
    png_set_IHDR(c->png, c->info, (png_uint_32)source->width, (png_uint_32)source->height, source->tone.bits,
                 source->alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (source->tone.transfer == GLINT_TRANSFER_SRGB)
        png_set_sRGB(c->png, c->info, PNG_sRGB_INTENT_PERCEPTUAL);
    else if (source->tone.transfer == GLINT_TRANSFER_LINEAR)
        png_set_gAMA_fixed(c->png, c->info, 100000);
    const png_uint_32 meter = (png_uint_32)(c->dpi / 0.0254 + 0.5); // pixels per metre
    if (meter > 0)
        png_set_pHYs(c->png, c->info, meter, meter, PNG_RESOLUTION_METER);
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
    c->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, glint_png_fail, glint_png_warn);
    c->info = c->png ? png_create_info_struct(c->png) : NULL;
    if (c->latin1 && c->info && glint_bytes_reserve(c->out, c->stream->size + 1024))
        done = write_container(c);
    png_destroy_write_struct(&c->png, &c->info);
    free(c->latin1);
    return done ? GLINT_OK : glint_fail_nomem(error);
}

static glint_status encode(glint_bands *bands, const glint_png_source *source, const glint_png_desc *desc, glint_bytes *out,
                           double *reused, glint_error *error)
{
    container c = { .source = source, .text = desc->text, .text_count = desc->text_count, .dpi = desc->dpi, .out = out };
    const glint_status status = glint_bands_deflate(bands, source, desc->encode, &c.stream, reused, error);
    return status ? status : put_in_container(&c, error);
}

glint_status glint_png_encode(glint_bands *bands, const glint_png_source *source, const glint_png_desc *desc,
                              glint_bytes *out, double *reused, glint_error *error)
{
    glint_bands *own = NULL;
    glint_status status = check_text(desc->text, desc->text_count, error);
    if (!status && !bands)
        status = glint_bands_create(1, &own, error);
    if (!status)
        status = encode(bands ? bands : own, source, desc, out, reused, error);
    glint_bands_destroy(own);
    return status;
}
