/// The pixels of a tile that get all samples, and the other pixels, which come from the base.
#include "engine/render/tile/tile.h"

#include <string.h>

/// The positions of a group's pixels, and which of them are inside the image.
typedef struct group_pixels {
    size_t first; ///< in a plane of the image
    uint32_t columns, rows;
} group_pixels;

static group_pixels pixels_of(const glint_tile *tile, const glint_tile_frame *frame, uint32_t g)
{
    const uint32_t x = 4 * (g % tile->groups_across), y = 4 * (g / tile->groups_across);
    return (group_pixels) { .first = (size_t)(tile->y0 + y) * (size_t)frame->image->width + tile->x0 + x,
                            .columns = tile->width - x < 4 ? tile->width - x : 4,
                            .rows = tile->height - y < 4 ? tile->height - y : 4 };
}

bool glint_tile_choose_refined(glint_tile *tile, const glint_tile_frame *frame)
{
    const uint32_t *chosen = frame->refine->tiles[tile->index].chosen;
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const uint32_t x = 4 * (g % tile->groups_across), *row = chosen + 4 * (g / tile->groups_across);
        unsigned lanes = 0;
        for (uint32_t y = 0; y < 4; y++)
            lanes |= (row[y] >> x & 15) << 4 * y;
        tile->active[g] = (uint16_t)lanes;
        any |= lanes;
    }
    return any;
}

static void mark_refined(const glint_tile *tile, const glint_tile_frame *frame)
{
    const uint32_t *chosen = frame->refine->tiles[tile->index].chosen;
    for (uint32_t y = 0; y < tile->height && frame->plan->desc.passes >> GLINT_PASS_REFINED & 1; y++) {
        const size_t row = (size_t)(tile->y0 + y) * (size_t)frame->image->width + tile->x0;
        for (uint32_t x = 0; x < tile->width; x++)
            frame->image->plane[GLINT_PASS_REFINED][0][row + x] = chosen[y] >> x & 1;
    }
}

bool glint_tile_is_base(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_film_counts before = { .clipped = tile->counts.clipped,
                                       .nonfinite = tile->counts.nonfinite,
                                       .lights = tile->counts.runs[GLINT_STAGE_LIGHT] };
    if (!frame->base || !frame->refine->whole || glint_tile_has_chosen(tile, frame))
        return false;
    const glint_refine_tile *own = &frame->refine->tiles[tile->index];
    if (!frame->refine->in_place)
        glint_tile_copy(tile, frame, frame->base);
    mark_refined(tile, frame);
    tile->counts.clipped += own->clipped;
    tile->counts.nonfinite += own->nonfinite;
    glint_tile_sign_film(tile, frame, before, false);
    return true;
}

void glint_tile_take_plane(const glint_tile *tile, const glint_tile_frame *frame, const void *plane, void *groups)
{
    const size_t size = sizeof(float), stride = size * (size_t)frame->image->width;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const group_pixels at = pixels_of(tile, frame, g);
        const unsigned refined = tile->active[g];
        for (uint32_t y = 0; y < at.rows; y++) {
            const char *from = (const char *)plane + size * at.first + y * stride;
            char *to = (char *)groups + size * (g * GLINT_GROUP + 4 * y);
            if (!(refined >> 4 * y & 15) && at.columns == 4) {
                memcpy(to, from, 4 * size);
                continue;
            }
            for (uint32_t x = 0; x < at.columns; x++)
                if (!(refined >> (4 * y + x) & 1))
                    memcpy(to + size * x, from + size * x, size);
        }
    }
}

/// Computes the coverage from the one sample of the base, which stands for all.
static void take_coverage(glint_tile *tile, const glint_tile_frame *frame)
{
    float alpha[GLINT_TILE_SAMPLES] = { 0 };
    glint_tile_take_plane(tile, frame, frame->base->plane[GLINT_PASS_ALPHA][0], alpha);
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++)
        if (!glint_has_lane(tile->active, i))
            tile->film.covered[i] = (double)alpha[i] * frame->plan->desc.samples;
}

/// Copies the planes that come from the base for all pixels.
static void copy_whole(const glint_tile *tile, const glint_tile_frame *frame)
{
    static const glint_pass whole[] = { GLINT_PASS_DEPTH, GLINT_PASS_NORMAL, GLINT_PASS_OBJECT_ID, GLINT_PASS_ALBEDO };
    const uint32_t passes = frame->plan->desc.passes;
    const bool has_whole = !glint_plan_casts_centres(frame->plan) && !frame->refine->in_place;
    const size_t count = has_whole ? sizeof whole / sizeof *whole : 0;
    for (uint32_t y = 0; y < tile->height; y++) {
        const size_t row = (size_t)(tile->y0 + y) * (size_t)frame->image->width + tile->x0;
        for (size_t k = 0; k < count; k++)
            for (int c = 0; passes >> whole[k] & 1 && c < glint_pass_channels(whole[k]); c++)
                memcpy(frame->image->plane[whole[k]][c] + row, frame->base->plane[whole[k]][c] + row,
                       tile->width * sizeof(float));
    }
}

void glint_tile_take_base(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_image *base = frame->base;
    for (int c = 0; c < 3; c++) {
        glint_tile_take_plane(tile, frame, base->plane[GLINT_PASS_BEAUTY][c], tile->film.beauty[c]);
        for (int k = 0; k < GLINT_TERM_COUNT; k++)
            if (frame->plan->desc.passes >> (GLINT_PASS_BACKGROUND + k) & 1)
                glint_tile_take_plane(tile, frame, base->plane[GLINT_PASS_BACKGROUND + k][c], tile->film.terms[k][c]);
    }
    if (glint_tile_wants_coverage(frame->plan))
        take_coverage(tile, frame);
    copy_whole(tile, frame);
    mark_refined(tile, frame);
    glint_tile_activate(tile);
}

/// Hashes how much neighbours must differ, and how the differences are computed.
static glint_key own_key(const glint_plan *plan, glint_key key)
{
    const double seen[] = { plan->desc.adaptive, plan->desc.tone.curve, plan->desc.tone.exposure };
    return GLINT_KEY_ADD(key, seen);
}

static bool called(const glint_plan *plan) { return plan->desc.adaptive > 0 && plan->desc.samples > 1; }

/// Runs before all other stages, because it chooses the pixels that they run for.
const glint_stage glint_stage_adaptive = {
    .name = "refine",
    .doc = "which pixels get all samples, by edges of objects, normals and contrast",
    .called = called,
    .own = own_key,
    .reads = GLINT_READS_OWN(ADAPTIVE),
    .walks = true,
};
