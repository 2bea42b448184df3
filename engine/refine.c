#include "engine/refine.h"
#include "engine/base/status.h"

#include <stdlib.h>
#include <string.h>

typedef struct chooser {
    const glint_image *base;
    glint_refine *refine;
    uint32_t least; ///< sum of differences of codes that is not enough
} chooser;

glint_render_desc glint_refine_base(const glint_render_desc *desc)
{
    glint_render_desc base = *desc;
    base.samples = 1;
    base.adaptive = 0;
    base.outline = GLINT_OUTLINE_NONE;
    base.passes = (desc->passes & ~(1u << GLINT_PASS_REFINED | 1u << GLINT_PASS_OUTLINE)) | 1u << GLINT_PASS_BEAUTY |
                  1u << GLINT_PASS_NORMAL | 1u << GLINT_PASS_OBJECT_ID;
    base.codes = true;
    base.tone = glint_tone_desc_default();
    base.tone.curve = desc->tone.curve;
    base.tone.exposure = desc->tone.exposure;
    base.tone.bits = 16;
    return base;
}

static uint32_t difference(uint16_t a, uint16_t b) { return a > b ? (uint32_t)(a - b) : (uint32_t)(b - a); }

/// Whether pixels p and q are worth a closer look. (Codes may have alpha.)
static bool differ(const chooser *c, size_t p, size_t q)
{
    const glint_image *base = c->base;
    const float *id = base->plane[GLINT_PASS_OBJECT_ID][0];
    float *const *normal = base->plane[GLINT_PASS_NORMAL];
    const size_t channels = (size_t)base->channels;
    const uint16_t *codes = base->codes;
    uint32_t sum = 0;
    if (id[p] != id[q])
        return true;
    for (size_t k = 0; k < channels; k++)
        sum += difference(codes[p * channels + k], codes[q * channels + k]);
    if (sum > c->least)
        return true;
    const float cosine = (normal[0][p] * normal[0][q] + normal[1][p] * normal[1][q]) + normal[2][p] * normal[2][q];
    return id[p] > 0 && cosine < GLINT_REFINE_NORMAL;
}

/// Compares a row's pixels with each other and with those of the row below; marks of the latter are put aside, so that no
/// two rows write to one place.
static void choose_row(void *context, size_t y, int worker)
{
    const chooser *c = context;
    const size_t width = (size_t)c->base->width, row = y * width;
    const bool last = y + 1 == (size_t)c->base->height;
    uint8_t *own = c->refine->chosen + row, *below = last ? NULL : c->refine->below + row + width;
    (void)worker;
    memset(own, 0, width);
    if (y == 0)
        memset(c->refine->below, 0, width);
    if (below)
        memset(below, 0, width);
    for (size_t x = 0; x < width; x++) {
        if (x + 1 < width && differ(c, row + x, row + x + 1))
            own[x] = own[x + 1] = 1;
        for (size_t k = x ? x - 1 : 0; below && k <= x + 1 && k < width; k++)
            if (differ(c, row + x, row + width + k))
                own[x] = below[k] = 1;
    }
}

glint_status glint_refine_choose(glint_refine *refine, const glint_image *base, double threshold, glint_pool *pool,
                                 glint_error *error)
{
    const size_t pixels = (size_t)base->width * (size_t)base->height;
    chooser c = { .base = base, .refine = refine, .least = (uint32_t)(threshold * 65535) };
    if (refine->capacity < pixels) {
        glint_refine_clear(refine);
        refine->chosen = malloc(pixels);
        refine->below = malloc(pixels);
        if (!refine->chosen || !refine->below)
            return glint_fail_nomem(error);
        refine->capacity = pixels;
    }
    glint_pool_run(pool, (size_t)base->height, choose_row, &c);
    refine->count = 0;
    for (size_t i = 0; i < pixels; i++)
        refine->count += refine->chosen[i] |= refine->below[i];
    return GLINT_OK;
}

void glint_refine_clear(glint_refine *refine)
{
    free(refine->chosen);
    free(refine->below);
    *refine = (glint_refine) { 0 };
}
