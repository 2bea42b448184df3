/// glint_apng: an animated PNG (acTL, fcTL, fdAT), whose chunks libpng writes directly to a draft.
///
/// Format: Animated PNG Specification, third edition of PNG. Each frame after the first holds the rectangle that
/// differs from the previous frame, and replaces the pixels there.
#include "engine/base/status.h"
#include "engine/files/picture/bands.h"
#include "engine/files/picture/libpng.h"
#include "engine/files/picture/picture.h"
#include "engine/files/picture/png.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK_BYTES ((size_t)1 << 20) // size of one IDAT or fdAT chunk

typedef struct box {
    int x, y, width, height;
} box;

struct glint_apng {
    glint_apng_desc desc;
    glint_draft *draft;
    png_structp png;
    png_infop info;
    glint_error error; ///< the draft's error, set before libpng jumps
    uint32_t sequence, frames; ///< number of the next fcTL or fdAT chunk; number of frames added
    uint16_t delay[2]; ///< a frame's duration in seconds: numerator and denominator
    size_t pixel_bytes;
    uint8_t *before; ///< pixel values of the previous frame
    uint8_t *chunk; ///< buffer for an fdAT
    glint_bands *bands; ///< deflates frames
};

// ---- libpng -------------------------------------------------------------------------------------------------------

static void take_bytes(png_structp png, png_bytep data, size_t size)
{
    glint_apng *apng = png_get_io_ptr(png);
    if (glint_draft_append(apng->draft, data, size, &apng->error))
        png_error(png, "no room");
}

/// Returns the draft's error if libpng failed because of the draft, otherwise out of memory.
static glint_status give_error(const glint_apng *apng, glint_error *error)
{
    if (!apng->error.status)
        return glint_fail_nomem(error);
    return glint_fail(error, apng->error.status, "%s", apng->error.message);
}

static void put32(uint8_t *out, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(value >> (24 - 8 * i));
}

static void put16(uint8_t *out, uint16_t value)
{
    out[0] = (uint8_t)(value >> 8);
    out[1] = (uint8_t)value;
}

static bool write_head(glint_apng *apng)
{
    const glint_apng_desc *desc = &apng->desc;
    uint8_t control[8];
    if (setjmp(png_jmpbuf(apng->png)))
        return false;
    png_set_write_fn(apng->png, apng, take_bytes, glint_png_flush);
    png_set_IHDR(apng->png, apng->info, (png_uint_32)desc->width, (png_uint_32)desc->height, desc->bits,
                 desc->alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (desc->transfer == GLINT_TRANSFER_SRGB)
        png_set_sRGB(apng->png, apng->info, PNG_sRGB_INTENT_PERCEPTUAL);
    else if (desc->transfer == GLINT_TRANSFER_LINEAR)
        png_set_gAMA_fixed(apng->png, apng->info, 100000);
    png_write_info(apng->png, apng->info);
    put32(control, desc->frame_count);
    put32(control + 4, desc->plays);
    png_write_chunk(apng->png, (png_const_bytep) "acTL", control, sizeof control);
    return true;
}

static void write_control(glint_apng *apng, const box *b)
{
    uint8_t control[26];
    put32(control, apng->sequence++);
    put32(control + 4, (uint32_t)b->width);
    put32(control + 8, (uint32_t)b->height);
    put32(control + 12, (uint32_t)b->x);
    put32(control + 16, (uint32_t)b->y);
    put16(control + 20, apng->delay[0]);
    put16(control + 22, apng->delay[1]);
    control[24] = control[25] = 0; // the frame stays until the next one, and replaces the pixels below it
    png_write_chunk(apng->png, (png_const_bytep) "fcTL", control, sizeof control);
}

static bool write_frame(glint_apng *apng, const box *b, const glint_bytes *stream)
{
    if (setjmp(png_jmpbuf(apng->png)))
        return false;
    write_control(apng, b);
    for (size_t at = 0; at < stream->size; at += CHUNK_BYTES) {
        size_t rest = stream->size - at, size = rest < CHUNK_BYTES ? rest : CHUNK_BYTES;
        if (apng->frames == 0) {
            png_write_chunk(apng->png, (png_const_bytep) "IDAT", stream->data + at, size);
        } else {
            put32(apng->chunk, apng->sequence++);
            memcpy(apng->chunk + 4, stream->data + at, size);
            png_write_chunk(apng->png, (png_const_bytep) "fdAT", apng->chunk, size + 4);
        }
    }
    return true;
}

static bool write_end(glint_apng *apng)
{
    if (setjmp(png_jmpbuf(apng->png)))
        return false;
    png_write_chunk(apng->png, (png_const_bytep) "IEND", NULL, 0);
    return true;
}

// ---- Beginning and end --------------------------------------------------------------------------------------------

/// Sets the ratio of two 16-bit numbers nearest to 1/fps; if several ratios are equally near, the one with the
/// smallest numerator.
static void set_delay(glint_apng *apng)
{
    double least = HUGE_VAL;
    for (int above = 1; above <= 65535 && least > 0; above++) {
        double below = floor(apng->desc.fps * above + 0.5);
        double off = fabs(below / above - apng->desc.fps);
        if (below < 1 || below > 65535 || !(off < least))
            continue;
        least = off;
        apng->delay[0] = (uint16_t)above;
        apng->delay[1] = (uint16_t)below;
    }
}

static glint_status check_desc(const glint_apng_desc *desc, glint_error *error)
{
    glint_status status = glint_check_whole("width", desc->width, 1, GLINT_SIDE_MAX, error);
    if (!status)
        status = glint_check_whole("height", desc->height, 1, GLINT_SIDE_MAX, error);
    if (!status && desc->bits != 8 && desc->bits != 16)
        status = glint_fail(error, GLINT_ERR_INVALID, "bits: 8 or 16 expected, got %d", desc->bits);
    if (!status)
        status = glint_check_whole("frame_count", desc->frame_count, 1, 1 << 30, error);
    if (!status)
        status = glint_check_range("fps", desc->fps, 1.0 / 65535, 65535, "number 1/65535 .. 65535", error);
    return status;
}

static glint_status open_apng(glint_apng *apng, const char *path, glint_error *error)
{
    const glint_apng_desc *desc = &apng->desc;
    apng->pixel_bytes = (desc->alpha ? 4 : 3) * (desc->bits == 16 ? 2 : 1);
    apng->before = calloc((size_t)desc->width * (size_t)desc->height, apng->pixel_bytes);
    apng->chunk = malloc(CHUNK_BYTES + 4);
    apng->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, glint_png_fail, glint_png_warn);
    apng->info = apng->png ? png_create_info_struct(apng->png) : NULL;
    if (!apng->before || !apng->chunk || !apng->info)
        return glint_fail_nomem(error);
    set_delay(apng);
    glint_status status = glint_bands_create(1, &apng->bands, error);
    if (!status)
        status = glint_draft_create(path, &apng->draft, error);
    if (!status && !write_head(apng))
        status = give_error(apng, error);
    return status;
}

glint_status glint_apng_create(const char *path, const glint_apng_desc *desc, glint_apng **out, glint_error *error)
{
    GLINT_REFUSE_NULL(path, error);
    GLINT_REFUSE_NULL(desc, error);
    GLINT_REFUSE_NULL(out, error);
    glint_status status = check_desc(desc, error);
    if (status)
        return status;
    glint_apng *apng = calloc(1, sizeof *apng);
    if (!apng)
        return glint_fail_nomem(error);
    apng->desc = *desc;
    status = open_apng(apng, path, error);
    if (status)
        glint_apng_destroy(apng);
    else
        *out = apng;
    return status;
}

glint_status glint_apng_finish(glint_apng *apng, glint_error *error)
{
    GLINT_REFUSE_NULL(apng, error);
    if (apng->frames != apng->desc.frame_count)
        return glint_fail(error, GLINT_ERR_INVALID, "frame_count: %u frames expected, got %u", apng->desc.frame_count,
                          apng->frames);
    if (!write_end(apng))
        return give_error(apng, error);
    return glint_draft_finish(apng->draft, error);
}

void glint_apng_destroy(glint_apng *apng)
{
    if (!apng)
        return;
    png_destroy_write_struct(&apng->png, &apng->info);
    glint_draft_destroy(apng->draft);
    glint_bands_destroy(apng->bands);
    free(apng->before);
    free(apng->chunk);
    free(apng);
}

// ---- Frames -------------------------------------------------------------------------------------------------------

/// Returns the smallest rectangle that contains all pixels in which two frames differ; one pixel if the frames are
/// identical.
static box find_changed(const glint_apng *apng, const uint8_t *codes)
{
    size_t pixel = apng->pixel_bytes, width = (size_t)apng->desc.width, row_bytes = width * pixel;
    size_t left = width, right = 0;
    int top = -1, bottom = 0;
    for (int y = 0; y < apng->desc.height; y++) {
        const uint8_t *a = codes + (size_t)y * row_bytes, *b = apng->before + (size_t)y * row_bytes;
        if (memcmp(a, b, row_bytes) == 0)
            continue;
        top = top < 0 ? y : top;
        bottom = y;
        size_t from = 0, to = width;
        while (memcmp(a + from * pixel, b + from * pixel, pixel) == 0)
            from++;
        while (memcmp(a + (to - 1) * pixel, b + (to - 1) * pixel, pixel) == 0)
            to--;
        left = from < left ? from : left;
        right = to > right ? to : right;
    }
    if (top < 0)
        return (box) { 0, 0, 1, 1 };
    return (box) { (int)left, top, (int)(right - left), bottom - top + 1 };
}

typedef struct part { ///< of a frame
    const uint8_t *codes;
    size_t row_bytes, first; ///< offset of the rectangle's first byte in a row
} part;

static const void *row_of_part(const void *user, int y, void *scratch)
{
    const part *p = user;
    (void)scratch;
    return p->codes + p->first + (size_t)y * p->row_bytes;
}

static glint_status check_picture(const glint_apng *apng, const glint_picture *picture, glint_error *error)
{
    const glint_apng_desc *desc = &apng->desc;
    if (!glint_picture_codes(picture) || glint_picture_channels(picture) != (desc->alpha ? 4 : 3))
        return glint_fail(error, GLINT_ERR_INVALID, "picture: a .png of %s expected, got %d channels",
                          desc->alpha ? "RGB with alpha" : "RGB without alpha", glint_picture_channels(picture));
    if (glint_picture_width(picture) != desc->width || glint_picture_height(picture) != desc->height ||
        glint_picture_bits(picture) != desc->bits || glint_picture_transfer(picture) != desc->transfer)
        return glint_fail(error, GLINT_ERR_INVALID, "picture: %dx%d pixels of %d bits expected, got %dx%d of %d",
                          desc->width, desc->height, desc->bits, glint_picture_width(picture),
                          glint_picture_height(picture), glint_picture_bits(picture));
    if (apng->frames == desc->frame_count)
        return glint_fail(error, GLINT_ERR_INVALID, "frame_count: %u frames expected, got more", desc->frame_count);
    return GLINT_OK;
}

glint_status glint_apng_add(glint_apng *apng, const glint_picture *picture, glint_error *error)
{
    GLINT_REFUSE_NULL(apng, error);
    GLINT_REFUSE_NULL(picture, error);
    glint_status status = check_picture(apng, picture, error);
    if (status)
        return status;
    const glint_apng_desc *desc = &apng->desc;
    size_t row_bytes = (size_t)desc->width * apng->pixel_bytes;
    const uint8_t *codes = glint_picture_codes(picture);
    const glint_bytes *stream;
    box b = { 0, 0, desc->width, desc->height };
    if (apng->frames > 0)
        b = find_changed(apng, codes);
    part p = { codes, row_bytes, (size_t)b.y * row_bytes + (size_t)b.x * apng->pixel_bytes };
    glint_png_source source = { .width = b.width, .height = b.height, .row = row_of_part, .user = &p };
    source.alpha = desc->alpha;
    source.tone = glint_tone_desc_default();
    source.tone.bits = desc->bits;
    status = glint_bands_deflate(apng->bands, &source, desc->encode, &stream, NULL, error);
    if (!status && !write_frame(apng, &b, stream))
        status = give_error(apng, error);
    if (!status) {
        memcpy(apng->before, codes, row_bytes * (size_t)desc->height);
        apng->frames++;
    }
    return status;
}
