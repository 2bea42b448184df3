/// glint_texture: a picture as linear floats, with its mipmap levels.
#include "engine/program/program.h"

#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/file/exr.h"
#include "engine/file/file.h"
#include "engine/file/hdr.h"
#include "engine/file/jpeg.h"
#include "engine/file/pfm.h"
#include "engine/file/png.h"

#include <stdlib.h>
#include <string.h>

#define TEXELS_MAX ((size_t)1 << 25)
#define SIDE_MAX 65535
#define LEVELS_MAX 17 // levels of a texture of SIDE_MAX texels

struct glint_texture {
    glint_texture_table table;
    glint_texture_level levels[LEVELS_MAX];
    glint_key key;
    glint_texture *owner; ///< the texture that owns the texels, retained; NULL: this texture owns them
    _Atomic uint32_t references;
};

glint_texture_desc glint_texture_desc_default(void) { return (glint_texture_desc) { .wrap = GLINT_WRAP_REPEAT }; }

glint_texture *glint_texture_retain(glint_texture *texture)
{
    if (texture)
        atomic_fetch_add(&texture->references, 1);
    return texture;
}

void glint_texture_release(glint_texture *texture)
{
    if (!texture || atomic_fetch_sub(&texture->references, 1) > 1)
        return;
    for (uint32_t i = 0; i < texture->table.level_count && !texture->owner; i++)
        free((void *)texture->levels[i].texels);
    glint_texture_release(texture->owner);
    free(texture);
}

int glint_texture_width(const glint_texture *texture) { return texture ? (int)texture->levels[0].width : 0; }

int glint_texture_height(const glint_texture *texture) { return texture ? (int)texture->levels[0].height : 0; }

const glint_texture_table *glint_texture_table_of(const glint_texture *texture) { return &texture->table; }

glint_key glint_texture_key(const glint_texture *texture) { return texture->key; }

/// A picture as it was read: pixel values, or linear floats.
typedef struct picture {
    glint_png png;
    glint_pfm floats; ///< its `values` are NULL: `png` is the picture
    bool linear; ///< of `png`
} picture;

// ---- Levels -------------------------------------------------------------------------------------------------------

/// Allocates the texels of the next level. NULL: out of memory.
static float *add_level(glint_texture *texture, uint32_t width, uint32_t height)
{
    float *texels = glint_alloc_large((size_t)width * height, 4 * sizeof *texels);
    if (texels)
        texture->levels[texture->table.level_count++] = (glint_texture_level) { width, height, texels };
    return texels;
}

/// Returns the linear light of each pixel value. NULL: out of memory.
static float *decoding(const glint_png *png, bool linear)
{
    const int last = png->bits == 16 ? 65535 : 255;
    float *table = malloc((size_t)(last + 1) * sizeof *table);
    for (int i = 0; table && i <= last; i++)
        table[i] = (float)(linear ? (double)i / last : glint_srgb_decode((double)i / last));
    return table;
}

static bool fill_floats(glint_texture *texture, const glint_pfm *floats)
{
    const size_t count = (size_t)floats->width * (size_t)floats->height, channels = (size_t)floats->channels;
    float *to = add_level(texture, (uint32_t)floats->width, (uint32_t)floats->height);
    for (size_t i = 0; i < count && to; i++, to += 4) {
        for (size_t c = 0; c < 3; c++)
            to[c] = floats->values[i * channels + (channels == 3 ? c : 0)];
        to[3] = 1;
    }
    return to != NULL;
}

static bool fill_codes(glint_texture *texture, const glint_png *png, bool linear)
{
    const size_t count = (size_t)png->width * (size_t)png->height, channels = (size_t)png->channels;
    const bool gray = channels < 3, alpha = channels == 2 || channels == 4;
    const float most = png->bits == 16 ? 65535 : 255;
    float *table = decoding(png, linear),
          *to = table ? add_level(texture, (uint32_t)png->width, (uint32_t)png->height) : NULL;
    for (size_t i = 0; i < count && to; i++, to += 4) {
        unsigned code[4] = { 0 };
        for (size_t c = 0; c < channels; c++)
            code[c] = png->bits == 16 ? ((const uint16_t *)png->codes)[i * channels + c]
                                      : ((const uint8_t *)png->codes)[i * channels + c];
        for (size_t c = 0; c < 3; c++)
            to[c] = table[code[gray ? 0 : c]];
        to[3] = alpha ? (float)code[channels - 1] / most : 1;
    }
    free(table);
    return to != NULL;
}

/// Adds the next mipmap level. Each texel is the mean of the four texels that it covers. At the end of a side with an
/// odd length, the last texel counts twice.
static bool add_half(glint_texture *texture)
{
    const glint_texture_level from = texture->levels[texture->table.level_count - 1];
    const uint32_t width = (from.width + 1) / 2, height = (from.height + 1) / 2;
    float *to = add_level(texture, width, height);
    for (size_t y = 0; y < height && to; y++)
        for (size_t x = 0; x < width; x++, to += 4) {
            const size_t x0 = 2 * x, x1 = x0 + 1 < from.width ? x0 + 1 : x0;
            const size_t y0 = 2 * y, y1 = y0 + 1 < from.height ? y0 + 1 : y0;
            const float *a = from.texels + 4 * (y0 * from.width), *b = from.texels + 4 * (y1 * from.width);
            for (size_t c = 0; c < 4; c++)
                to[c] = (float)((((double)a[4 * x0 + c] + (double)a[4 * x1 + c]) +
                                 ((double)b[4 * x0 + c] + (double)b[4 * x1 + c])) *
                                0.25);
        }
    return to != NULL;
}

static bool fill(glint_texture *texture, const picture *from)
{
    bool done = from->floats.values ? fill_floats(texture, &from->floats) : fill_codes(texture, &from->png, from->linear);
    const glint_texture_level *last = texture->levels;
    while (done && (last->width > 1 || last->height > 1)) {
        done = add_half(texture);
        last = &texture->levels[texture->table.level_count - 1];
    }
    return done;
}

// ---- Reading ------------------------------------------------------------------------------------------------------

/// The first bytes of other picture formats.
static const struct {
    size_t at;
    const char *begin, *kind;
} OTHERS[] = { { 0, "GIF8", "GIF" },       { 0, "BM", "BMP" },          { 0, "II*", "TIFF" },     { 0, "MM", "TIFF" },
               { 8, "WEBP", "WebP" },      { 0, "DDS ", "DDS" },        { 0, "8BPS", "Photoshop" },
               { 4, "jP  ", "JPEG 2000" },  { 4, "ftypavif", "AVIF" },  { 4, "ftyphei", "HEIF" }, { 0, "<", "SVG or another XML" }, { 0, "qoif", "QOI" },
               { 0, "P3", "PPM" },         { 0, "P5", "PGM" },          { 0, "P6", "PPM" } };

/// Refuses a picture of another format, and names the format.
static glint_status refuse_other(const glint_bytes *bytes, glint_error *error)
{
    for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++) {
        const size_t length = strlen(OTHERS[i].begin);
        if (bytes->size >= OTHERS[i].at + length && memcmp(bytes->data + OTHERS[i].at, OTHERS[i].begin, length) == 0)
            return glint_fail(error, GLINT_ERR_FORMAT, "is %s; textures are .png, .jpg, .hdr, .exr or .pfm", OTHERS[i].kind);
    }
    return GLINT_OK;
}

/// Checks the values of a float picture. A program's light is refused above GLINT_REFLECTANCE_MAX.
static glint_status check_floats(const glint_pfm *floats, glint_error *error)
{
    const size_t row = (size_t)floats->width * (size_t)floats->channels, count = row * (size_t)floats->height;
    if (count > TEXELS_MAX * (size_t)floats->channels)
        return glint_fail(error, GLINT_ERR_FORMAT, "a picture of at most %zu pixels expected, got %d x %d", TEXELS_MAX,
                          floats->width, floats->height);
    for (size_t i = 0; i < count; i++)
        if (!(floats->values[i] >= 0 && (double)floats->values[i] <= GLINT_REFLECTANCE_MAX))
            return glint_fail(error, GLINT_ERR_FORMAT, "pixel %zu, %zu: light of 0 .. 1e30 expected, got %g",
                              i % row / (size_t)floats->channels, i / row, (double)floats->values[i]);
    return GLINT_OK;
}

/// Decodes a picture of floats. *known is whether the bytes begin like one.
static glint_status decode_floats(const glint_bytes *bytes, glint_pfm *out, bool *known, glint_error *error)
{
    glint_status status = GLINT_OK;
    *known = true;
    if (glint_is_hdr(bytes->data, bytes->size))
        status = glint_hdr_decode(bytes->data, bytes->size, TEXELS_MAX, out, error);
    else if (glint_is_exr(bytes->data, bytes->size))
        status = glint_exr_decode(bytes, TEXELS_MAX, out, error);
    else if (glint_is_pfm(bytes->data, bytes->size))
        status = glint_pfm_decode(bytes->data, bytes->size, out, error);
    else
        *known = false;
    return status || !*known ? status : check_floats(out, error);
}

static glint_status decode(const glint_bytes *bytes, picture *out, glint_error *error)
{
    glint_png_head head;
    bool known;
    if (glint_is_jpeg(bytes->data, bytes->size))
        return glint_jpeg_decode(bytes->data, bytes->size, TEXELS_MAX, &out->png, error);
    glint_status status = decode_floats(bytes, &out->floats, &known, error);
    if (status || known)
        return status;
    status = refuse_other(bytes, error);
    if (!status)
        status = glint_png_scan(bytes->data, bytes->size, &head, NULL, NULL, error);
    if (status)
        return status;
    if ((size_t)head.width * (size_t)head.height > TEXELS_MAX)
        return glint_fail(error, GLINT_ERR_FORMAT, "a picture of at most %zu pixels expected, got %d x %d", TEXELS_MAX,
                          head.width, head.height);
    out->linear = out->linear || head.transfer == GLINT_TRANSFER_LINEAR;
    return glint_png_decode(bytes->data, bytes->size, &out->png, error);
}

static glint_status copy_codes(const glint_texture_desc *desc, glint_png *png, glint_error *error)
{
    const size_t bytes = 3 * (size_t)desc->width * (size_t)desc->height;
    *png = (glint_png) { .width = desc->width, .height = desc->height, .channels = 3, .bits = 8 };
    png->codes = malloc(bytes);
    if (!png->codes)
        return glint_fail_nomem(error);
    memcpy(png->codes, desc->rgb, bytes);
    return GLINT_OK;
}

static glint_status read_picture(const glint_texture_desc *desc, picture *out, glint_error *error)
{
    glint_bytes bytes = { 0 };
    glint_error inner;
    if (!desc->path)
        return copy_codes(desc, &out->png, error);
    glint_status status = glint_file_read_picture(desc->path, &bytes, error);
    if (status)
        return status;
    status = decode(&bytes, out, &inner);
    free(bytes.data);
    return status ? glint_fail(error, status, "%.300s: %.200s", desc->path, inner.message) : GLINT_OK;
}

static glint_key key_of(const glint_texture *texture)
{
    const glint_texture_level *first = &texture->levels[0];
    const uint32_t head[] = { first->width, first->height, texture->table.wrap, texture->table.filter };
    const glint_key key = glint_key_add((glint_key) { 0 }, head, sizeof head);
    return glint_key_add(key, first->texels, (size_t)first->width * first->height * 4 * sizeof *first->texels);
}

static glint_status check(const glint_texture_desc *desc, glint_error *error)
{
    if (desc->path ? !*desc->path : !desc->rgb)
        return glint_fail(error, GLINT_ERR_INVALID, "path: name of a .png expected");
    if (!desc->path && (desc->width < 1 || desc->height < 1 || desc->width > SIDE_MAX || desc->height > SIDE_MAX ||
                        (size_t)desc->width * (size_t)desc->height > TEXELS_MAX))
        return glint_fail(error, GLINT_ERR_INVALID, "rgb: a picture of at most %zu pixels expected, got %d x %d",
                          TEXELS_MAX, desc->width, desc->height);
    if ((unsigned)desc->wrap > GLINT_WRAP_AROUND)
        return glint_fail(error, GLINT_ERR_INVALID, "wrap: repeat, clamp or around expected, got %d", (int)desc->wrap);
    if ((unsigned)desc->filter > GLINT_FILTER_NEAREST)
        return glint_fail(error, GLINT_ERR_INVALID, "filter: bilinear or nearest expected, got %d", (int)desc->filter);
    return GLINT_OK;
}

glint_status glint_texture_create(const glint_texture_desc *desc, glint_texture **out, glint_error *error)
{
    GLINT_REFUSE_NULL(desc, error);
    GLINT_REFUSE_NULL(out, error);
    picture from = { .linear = desc->linear };
    glint_status status = check(desc, error);
    if (!status)
        status = read_picture(desc, &from, error);
    glint_texture *texture = status ? NULL : calloc(1, sizeof *texture);
    if (texture) {
        texture->references = 1;
        texture->table =
            (glint_texture_table) { .levels = texture->levels, .wrap = desc->wrap, .filter = desc->filter };
    }
    if (texture && fill(texture, &from)) {
        texture->key = key_of(texture);
        *out = texture;
    } else if (!status) {
        glint_texture_release(texture);
        status = glint_fail_nomem(error);
    }
    free(from.png.codes);
    free(from.floats.values);
    return status;
}

glint_status glint_texture_rewrap(const glint_texture *texture, glint_wrap wrap, glint_texture **out,
                                  glint_error *error)
{
    GLINT_REFUSE_NULL(texture, error);
    GLINT_REFUSE_NULL(out, error);
    glint_texture *owner = texture->owner ? texture->owner : (glint_texture *)(uintptr_t)texture;
    if ((unsigned)wrap > GLINT_WRAP_AROUND)
        return glint_fail(error, GLINT_ERR_INVALID, "wrap: repeat, clamp or around expected, got %d", (int)wrap);
    glint_texture *twin = calloc(1, sizeof *twin);
    if (!twin)
        return glint_fail_nomem(error);
    memcpy(twin->levels, texture->levels, sizeof twin->levels);
    twin->table = texture->table;
    twin->table.levels = twin->levels;
    twin->table.wrap = wrap;
    twin->key = glint_key_add(texture->key, &wrap, sizeof wrap);
    twin->owner = glint_texture_retain(owner);
    twin->references = 1;
    *out = twin;
    return GLINT_OK;
}
