/// glint_texture: a picture as linear floats, with its mipmap levels.
#include "engine/render/program/program.h"

#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/film/tone.h"

#include <stdlib.h>
#include <string.h>

#define SIDE_MAX 65535
#define LEVELS_MAX 17 // levels of a texture of SIDE_MAX texels

struct glint_texture {
    glint_texture_table table;
    glint_texture_level levels[LEVELS_MAX];
    glint_key key;
    glint_texture *owner; ///< the texture that owns the texels, retained; NULL: this texture owns them
    _Atomic uint32_t references;
};

static glint_texture_desc defaults(void) { return (glint_texture_desc) { .wrap = GLINT_WRAP_REPEAT }; }

void glint_texture_desc_init(glint_texture_desc *desc, size_t size)
{
    const glint_texture_desc full = defaults();
    glint_desc_write(desc, size, &full, sizeof full);
}

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

// ---- Levels -------------------------------------------------------------------------------------------------------

/// Allocates the texels of the next level. NULL: out of memory.
static float *add_level(glint_texture *texture, uint32_t width, uint32_t height)
{
    float *texels = glint_alloc_large((size_t)width * height, 4 * sizeof *texels);
    if (texels)
        texture->levels[texture->table.level_count++] = (glint_texture_level) { width, height, texels };
    return texels;
}

/// Checks a row of light. A program's light is refused above GLINT_REFLECTANCE_MAX.
static glint_status check_row(const float *row, int width, int y, glint_error *error)
{
    for (int i = 0; i < 4 * width; i++)
        if (!(row[i] >= 0 && (double)row[i] <= GLINT_REFLECTANCE_MAX))
            return glint_fail(error, GLINT_ERR_FORMAT, "pixel %d, %d: light of 0 .. 1e30 expected, got %g", i / 4, y, (double)row[i]);
    return GLINT_OK;
}

static glint_status fill_rows(glint_texture *texture, const glint_texture_desc *desc, glint_error *error)
{
    float *to = add_level(texture, (uint32_t)desc->width, (uint32_t)desc->height);
    glint_status status = to ? GLINT_OK : glint_fail_nomem(error);
    for (int y = 0; y < desc->height && !status; y++, to += 4 * (size_t)desc->width) {
        desc->row(desc->context, y, to);
        status = check_row(to, desc->width, y, error);
    }
    return status;
}

static glint_status fill_rgb(glint_texture *texture, const glint_texture_desc *desc, glint_error *error)
{
    const size_t count = (size_t)desc->width * (size_t)desc->height;
    float light[256], *to = add_level(texture, (uint32_t)desc->width, (uint32_t)desc->height);
    if (!to)
        return glint_fail_nomem(error);
    for (int code = 0; code < 256; code++)
        light[code] = (float)(desc->linear ? code / 255.0 : glint_srgb_decode(code / 255.0));
    for (size_t i = 0; i < count; i++, to += 4) {
        for (size_t c = 0; c < 3; c++)
            to[c] = light[desc->rgb[3 * i + c]];
        to[3] = 1;
    }
    return GLINT_OK;
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

static glint_status fill(glint_texture *texture, const glint_texture_desc *desc, glint_error *error)
{
    const glint_status status = desc->row ? fill_rows(texture, desc, error) : fill_rgb(texture, desc, error);
    if (status)
        return status;
    for (const glint_texture_level *last = texture->levels; last->width > 1 || last->height > 1; last++)
        if (!add_half(texture))
            return glint_fail_nomem(error);
    return GLINT_OK;
}

// ---- Textures -----------------------------------------------------------------------------------------------------

static glint_key key_of(const glint_texture *texture)
{
    const glint_texture_level *first = &texture->levels[0];
    const uint32_t head[] = { first->width, first->height, texture->table.wrap, texture->table.filter };
    const glint_key key = glint_key_add((glint_key) { 0 }, head, sizeof head);
    return glint_key_add(key, first->texels, (size_t)first->width * first->height * 4 * sizeof *first->texels);
}

static glint_status check(const glint_texture_desc *desc, glint_error *error)
{
    if (!desc->rgb == !desc->row)
        return glint_fail(error, GLINT_ERR_INVALID, "rgb, row: one of them expected");
    if (desc->width < 1 || desc->height < 1 || desc->width > SIDE_MAX || desc->height > SIDE_MAX ||
        (size_t)desc->width * (size_t)desc->height > GLINT_TEXELS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "a picture of at most %zu pixels expected, got %d x %d", GLINT_TEXELS_MAX,
                          desc->width, desc->height);
    if ((unsigned)desc->wrap > GLINT_WRAP_AROUND)
        return glint_fail(error, GLINT_ERR_INVALID, "wrap: repeat, clamp or around expected, got %d", (int)desc->wrap);
    if ((unsigned)desc->filter > GLINT_FILTER_NEAREST)
        return glint_fail(error, GLINT_ERR_INVALID, "filter: bilinear or nearest expected, got %d", (int)desc->filter);
    return GLINT_OK;
}

glint_status glint_texture_create(const glint_texture_desc *given, glint_texture **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_texture_desc, defaults());
    status = check(desc, error);
    if (status)
        return status;
    glint_texture *texture = calloc(1, sizeof *texture);
    if (!texture)
        return glint_fail_nomem(error);
    texture->references = 1;
    texture->table = (glint_texture_table) { .levels = texture->levels, .wrap = desc->wrap, .filter = desc->filter };
    status = fill(texture, desc, error);
    if (status) {
        glint_texture_release(texture);
        return status;
    }
    texture->key = key_of(texture);
    *out = texture;
    return GLINT_OK;
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
