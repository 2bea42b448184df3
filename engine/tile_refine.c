/// The part of a tile that gets all samples, and the rest, which has its one.
#include "engine/tile.h"

/// Place of a pixel of the tile in its arrays.
static uint32_t place_of(const glint_tile *tile, uint32_t x, uint32_t y)
{
    return (y / 4 * tile->groups_across + x / 4) * GLINT_GROUP + y % 4 * 4 + x % 4;
}

static size_t pixel_of(const glint_tile *tile, const glint_tile_frame *frame, uint32_t x, uint32_t y)
{
    return (size_t)(tile->y0 + y) * (size_t)frame->image->width + tile->x0 + x;
}

bool glint_tile_choose_refined(glint_tile *tile, const glint_tile_frame *frame)
{
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count; g++)
        tile->active[g] = 0;
    for (uint32_t y = 0; y < tile->height; y++)
        for (uint32_t x = 0; x < tile->width; x++) {
            const uint32_t i = place_of(tile, x, y);
            if (!frame->refined[pixel_of(tile, frame, x, y)])
                continue;
            tile->active[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
            any = 1;
        }
    return any;
}

/// Takes one pixel from the base.
static void take_pixel(glint_tile *tile, const glint_tile_frame *frame, uint32_t i, size_t pixel)
{
    const glint_image *base = frame->base;
    for (int c = 0; c < 3; c++) {
        tile->beauty[c][i] = base->plane[GLINT_PASS_BEAUTY][c][pixel];
        for (int k = 0; k < GLINT_TERM_COUNT; k++)
            if (frame->plan->desc.passes >> (GLINT_PASS_BACKGROUND + k) & 1)
                tile->film[k][c][i] = base->plane[GLINT_PASS_BACKGROUND + k][c][pixel];
    }
    if (glint_tile_wants_coverage(frame->plan))
        tile->covered[i] = base->plane[GLINT_PASS_ALPHA][0][pixel] > 0 ? (uint32_t)frame->plan->desc.samples : 0;
}

void glint_tile_take_base(glint_tile *tile, const glint_tile_frame *frame)
{
    static const glint_pass whole[] = { GLINT_PASS_DEPTH, GLINT_PASS_NORMAL, GLINT_PASS_OBJECT_ID };
    const uint32_t passes = frame->plan->desc.passes;
    for (uint32_t y = 0; y < tile->height; y++) {
        for (uint32_t x = 0; x < tile->width; x++) {
            const uint32_t i = place_of(tile, x, y);
            const size_t pixel = pixel_of(tile, frame, x, y);
            tile->active[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
            if (!frame->refined[pixel])
                take_pixel(tile, frame, i, pixel);
            if (passes >> GLINT_PASS_REFINED & 1)
                frame->image->plane[GLINT_PASS_REFINED][0][pixel] = frame->refined[pixel];
            for (int k = 0; k < 3; k++)
                for (int c = 0; passes >> whole[k] & 1 && c < glint_pass_channels(whole[k]); c++)
                    frame->image->plane[whole[k]][c][pixel] = frame->base->plane[whole[k]][c][pixel];
        }
    }
}
