/// glint_picture: a finished file, its texts, and its rows for display.
#include "engine/base/status.h"
#include "engine/files/picture/file.h"
#include "engine/files/picture/pfm.h"
#include "engine/files/picture/picture.h"
#include "engine/files/picture/png.h"
#include "engine/files/picture/write.h"
#include "engine/film/tone.h"

#include <stdlib.h>
#include <string.h>

typedef struct entry { ///< a text
    struct entry *next;
    char *value; ///< follows the keyword in memory
    char keyword[];
} entry;

struct glint_picture {
    glint_png_head head; ///< size and format; bits 32: the file is a .pfm
    void *codes; ///< pixel values of a .png; NULL: not read
    float *values; ///< values of a .pfm; otherwise NULL
    uint8_t *viewed; ///< the 8-bit sRGB value for each pixel value
    entry *texts;
};

// ---- Texts --------------------------------------------------------------------------------------------------------

static size_t to_utf8(const uint8_t *latin1, size_t size, char *out)
{
    size_t used = 0;
    for (size_t i = 0; i < size; i++) {
        if (latin1[i] >= 0x80)
            out[used++] = (char)(0xc0 | latin1[i] >> 6);
        out[used++] = (char)(latin1[i] >= 0x80 ? 0x80 | (latin1[i] & 0x3f) : latin1[i]);
    }
    out[used] = '\0';
    return used;
}

/// Adds a tEXt, "keyword NUL value", unless its keyword is there already. False: out of memory.
static bool add_text(void *user, const uint8_t *bytes, size_t size)
{
    glint_picture *picture = user;
    const uint8_t *zero = memchr(bytes, 0, size);
    if (!zero)
        return true;
    size_t length = (size_t)(zero - bytes);
    entry *text = malloc(sizeof *text + 2 * size + 2);
    if (!text)
        return false;
    text->value = text->keyword + to_utf8(bytes, length, text->keyword) + 1;
    to_utf8(zero + 1, size - length - 1, text->value);
    if (glint_picture_text(picture, text->keyword)) {
        free(text);
        return true;
    }
    text->next = picture->texts;
    picture->texts = text;
    return true;
}

const char *glint_picture_text(const glint_picture *picture, const char *keyword)
{
    if (!picture || !keyword)
        return NULL;
    for (const entry *text = picture->texts; text; text = text->next)
        if (strcmp(text->keyword, keyword) == 0)
            return text->value;
    return NULL;
}

// ---- Reading ------------------------------------------------------------------------------------------------------

/// Fills the table of displayed values for all pixel values.
static bool make_viewed(glint_picture *picture)
{
    bool linear = picture->head.transfer == GLINT_TRANSFER_LINEAR;
    size_t count = picture->head.bits == 16 ? 65536 : 256;
    picture->viewed = malloc(count);
    for (size_t i = 0; i < count && picture->viewed; i++) {
        double value = (double)i / (double)(count - 1);
        picture->viewed[i] = (uint8_t)((linear ? glint_srgb_encode(value) : value) * 255 + 0.5);
    }
    return picture->viewed != NULL;
}

static glint_status read_png(glint_picture *picture, const glint_bytes *bytes, bool pixels, glint_error *error)
{
    glint_png png;
    glint_status status = glint_png_scan(bytes->data, bytes->size, &picture->head, add_text, picture, error);
    if (status || !pixels)
        return status;
    status = glint_png_decode(bytes->data, bytes->size, &png, error);
    if (status)
        return status;
    picture->codes = png.codes;
    picture->head.channels = png.channels;
    picture->head.bits = png.bits;
    return make_viewed(picture) ? GLINT_OK : glint_fail_nomem(error);
}

static glint_status read_pfm(glint_picture *picture, const glint_bytes *bytes, bool pixels, glint_error *error)
{
    glint_pfm pfm;
    glint_status status = glint_pfm_decode(bytes->data, bytes->size, &pfm, error);
    if (status)
        return status;
    picture->head = (glint_png_head) { .width = pfm.width, .height = pfm.height, .bits = 32 };
    picture->head.channels = pfm.channels;
    picture->head.transfer = GLINT_TRANSFER_LINEAR;
    picture->values = pixels ? pfm.values : NULL;
    if (!pixels)
        free(pfm.values);
    return GLINT_OK;
}

glint_status glint_picture_read(const char *path, bool pixels, glint_picture **out, glint_error *error)
{
    GLINT_REFUSE_NULL(path, error);
    GLINT_REFUSE_NULL(out, error);
    glint_file_kind kind;
    glint_bytes bytes = { 0 };
    glint_error inner;
    glint_picture *picture = calloc(1, sizeof *picture);
    if (!picture)
        return glint_fail_nomem(error);
    glint_status status = glint_file_kind_read(path, &kind, error);
    if (!status)
        status = glint_file_read_picture(path, &bytes, error);
    if (!status) {
        status = kind == GLINT_FILE_PNG ? read_png(picture, &bytes, pixels, &inner)
                                        : read_pfm(picture, &bytes, pixels, &inner);
        if (status)
            glint_fail(error, status, "%.300s: %.200s", path, inner.message);
    }
    free(bytes.data);
    if (status)
        glint_picture_destroy(picture);
    else
        *out = picture;
    return status;
}

glint_status glint_picture_from_bytes(const void *data, size_t size, glint_picture **out, glint_error *error)
{
    GLINT_REFUSE_NULL(data, error);
    GLINT_REFUSE_NULL(out, error);
    const glint_bytes bytes = { .data = (uint8_t *)(uintptr_t)data, .size = size };
    glint_picture *picture = calloc(1, sizeof *picture);
    glint_status status = picture ? read_png(picture, &bytes, true, error) : glint_fail_nomem(error);
    if (status)
        glint_picture_destroy(picture);
    else
        *out = picture;
    return status;
}

void glint_picture_destroy(glint_picture *picture)
{
    if (!picture)
        return;
    for (entry *text = picture->texts; text;) {
        entry *next = text->next;
        free(text);
        text = next;
    }
    free(picture->codes);
    free(picture->values);
    free(picture->viewed);
    free(picture);
}

int glint_picture_width(const glint_picture *picture) { return picture ? picture->head.width : 0; }

int glint_picture_height(const glint_picture *picture) { return picture ? picture->head.height : 0; }

int glint_picture_bits(const glint_picture *picture) { return picture ? picture->head.bits : 0; }

int glint_picture_channels(const glint_picture *picture) { return picture ? picture->head.channels : 0; }

glint_transfer glint_picture_transfer(const glint_picture *picture) { return picture ? picture->head.transfer : 0; }

const void *glint_picture_codes(const glint_picture *picture) { return picture->codes; }

// ---- Rows ---------------------------------------------------------------------------------------------------------

static void row_of_values(const glint_picture *picture, int y, uint8_t *rgb)
{
    size_t width = (size_t)picture->head.width, channels = (size_t)picture->head.channels;
    const float *row = picture->values + (size_t)y * width * channels;
    glint_tone_desc tone = glint_tone_desc_default();
    for (size_t i = 0; i < 3 * width; i++)
        rgb[i] = (uint8_t)glint_tone_value(&tone, row[channels == 3 ? i : i / 3]);
}

static unsigned code_at(const glint_picture *picture, size_t i)
{
    return picture->head.bits == 16 ? ((const uint16_t *)picture->codes)[i] : ((const uint8_t *)picture->codes)[i];
}

void glint_picture_row(const glint_picture *picture, int y, int backdrop, uint8_t *rgb)
{
    if (!picture || !rgb)
        return;
    if (picture->values) {
        row_of_values(picture, y, rgb);
        return;
    }
    size_t width = (size_t)picture->head.width, channels = (size_t)picture->head.channels;
    size_t first = (size_t)y * width * channels, most = picture->head.bits == 16 ? 65535 : 255;
    bool grey = channels < 3, alpha = channels == 2 || channels == 4;
    for (size_t x = 0; x < width; x++) {
        size_t at = first + x * channels, cover = alpha ? code_at(picture, at + channels - 1) : most;
        for (size_t c = 0; c < 3; c++) {
            size_t code = picture->viewed[code_at(picture, at + (grey ? 0 : c))];
            rgb[3 * x + c] = (uint8_t)((code * cover + (size_t)backdrop * (most - cover) + most / 2) / most);
        }
    }
}

void glint_picture_light(const glint_picture *picture, int y, float *rgb)
{
    if (!picture || !rgb)
        return;
    const size_t width = (size_t)picture->head.width, channels = (size_t)picture->head.channels;
    const size_t first = (size_t)y * width * channels;
    const double most = picture->head.bits == 16 ? 65535 : 255;
    for (size_t i = 0; i < 3 * width; i++) {
        const size_t at = first + i / 3 * channels + (channels < 3 ? 0 : i % 3);
        if (picture->values) {
            rgb[i] = picture->values[at];
            continue;
        }
        const double share = code_at(picture, at) / most;
        rgb[i] = (float)(picture->head.transfer == GLINT_TRANSFER_SRGB ? glint_srgb_decode(share) : share);
    }
}
