/// Adaptive sampling: the chosen pixels of a tile, gathered. They lie along edges, so that the tile's own groups are mostly empty. Here a
/// group is one sample of 16 of them, wherever they are in the tile, and one walk has up to 16 samples of as many as fit.
#include "engine/base/alloc.h"
#include "engine/tile/tile.h"

#include <stdlib.h>
#include <string.h>

#define FEW_PRIMS 16 ///< of more, rays are cast faster where they lie beside each other
#define FULL 0.9 ///< of the lanes of the groups that have any: from there on gathering saves nothing

struct glint_gathered {
    _Alignas(64) double pixel[2][GLINT_TILE_SAMPLES]; ///< columns and rows of the picture
    _Alignas(64) float beauty[3][GLINT_TILE_SAMPLES];
    uint16_t active[GLINT_TILE_GROUPS]; ///< as they are in the tile, and the following
    uint32_t group_count, groups_across;
};

struct glint_gathered *glint_gathered_create(void) { return glint_alloc(1, sizeof(struct glint_gathered)); }

void glint_gathered_destroy(struct glint_gathered *gathered) { free(gathered); }

bool glint_tile_may_gather(const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    if (!frame->base || !plan->local || plan->runs[GLINT_STAGE_PATTERN] || plan->camera.orthographic || plan->lens ||
        plan->desc.passes & GLINT_LIGHT_PASSES || glint_tile_wants_coverage(plan) || frame->raster ||
        frame->geometry.prim_count > FEW_PRIMS)
        return false;
    for (uint32_t i = 0; i < plan->light_count; i++)
        if (plan->lights[i].light_samples) // one a lane
            return false;
    return true;
}

uint32_t glint_tile_list_gathered(const glint_tile *tile, const glint_tile_frame *frame, uint16_t place[GLINT_TILE_SAMPLES])
{
    uint32_t count = 0, groups = 0;
    if (tile->cached || !glint_tile_may_gather(frame))
        return 0;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        groups += tile->active[g] != 0;
        for (unsigned left = tile->active[g]; left; left &= left - 1)
            place[count++] = (uint16_t)(g * GLINT_GROUP + (uint32_t)__builtin_ctz(left));
    }
    return count < FULL * GLINT_GROUP * groups ? count : 0;
}

/// Tells the camera the pixels at these places; lanes that are left over have the first of them once more, and are not active.
static void place_pixels(glint_tile *tile, const uint16_t *place, uint32_t count, double (*pixel)[GLINT_TILE_SAMPLES])
{
    double first[2] = { tile->x0 + tile->width, tile->y0 + tile->height }, end[2] = { 0, 0 };
    for (uint32_t i = 0; i < (count + GLINT_GROUP - 1) / GLINT_GROUP * GLINT_GROUP; i++) {
        const uint32_t at = place[i < count ? i : 0], g = at / GLINT_GROUP, lane = at % GLINT_GROUP;
        pixel[0][i] = tile->x0 + 4 * (g % tile->groups_across) + lane % 4;
        pixel[1][i] = tile->y0 + 4 * (g / tile->groups_across) + lane / 4;
        for (int c = 0; c < 2; c++) {
            first[c] = pixel[c][i] < first[c] ? pixel[c][i] : first[c];
            end[c] = pixel[c][i] + 1 > end[c] ? pixel[c][i] + 1 : end[c];
        }
    }
    tile->camera.x0 = first[0];
    tile->camera.y0 = first[1];
    for (int c = 0; c < 2; c++) {
        tile->camera.pixel[c] = pixel[c];
        tile->camera.end[c] = end[c];
    }
}

void glint_tile_gather(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *place, uint32_t count, uint32_t first,
                       uint32_t samples)
{
    struct glint_gathered *gathered = tile->gathered;
    const uint32_t blocks = (count + GLINT_GROUP - 1) / GLINT_GROUP;
    const size_t real = frame->plan->desc.precision == GLINT_FLOAT ? sizeof(float) : sizeof(double);
    memcpy(gathered->active, tile->active, sizeof gathered->active);
    gathered->group_count = tile->group_count;
    gathered->groups_across = tile->groups_across;
    glint_tile_aim(tile, frame, 0);
    place_pixels(tile, place, count, gathered->pixel);
    tile->groups_across = tile->camera.groups_across = 1;
    tile->camera.group_count = blocks;
    for (uint32_t k = 0; k < samples; k++) {
        glint_plan_sample_offset(frame->plan, first + k, tile->camera.offset);
        tile->camera.down = (char *)tile->rays.direction + k * blocks * 3 * GLINT_GROUP * real;
        glint_tile_make_rays(tile, frame);
    }
    tile->camera.down = tile->rays.direction;
    tile->group_count = tile->camera.group_count = samples * blocks;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const uint32_t left = count - g % blocks * GLINT_GROUP;
        tile->active[g] = left < GLINT_GROUP ? (uint16_t)((1u << left) - 1) : 0xffff;
    }
}

void glint_tile_shade_gathered(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count, const uint16_t *place,
                               uint32_t count, uint32_t first, uint32_t samples)
{
    struct glint_gathered *gathered = tile->gathered;
    float *const beauty[3] = { gathered->beauty[0], gathered->beauty[1], gathered->beauty[2] };
    const bool last = first + samples == (uint32_t)frame->plan->desc.samples;
    glint_tile_shade_stacked(tile, frame, light_count, first, samples, beauty);
    memcpy(tile->active, gathered->active, sizeof tile->active);
    tile->group_count = gathered->group_count;
    tile->groups_across = gathered->groups_across;
    for (int c = 0; c < 3 && last; c++)
        for (uint32_t i = 0; i < count; i++)
            tile->film.beauty[c][place[i]] = beauty[c][i];
}
