/// Adaptive sampling: gathers the chosen pixels of a tile. They lie along edges, so the tile's own groups are mostly
/// empty. One walk takes up to 16 samples of as many pixels as fit. A group is the samples of one pixel, or of a few
/// adjacent pixels: such a small part of the picture shows few primitives, and mostly the same one in all lanes.
/// Shading adds up samples in their order, and gets them one after the other.
#include "engine/base/alloc.h"
#include "engine/render/tile/tile.h"

#include <stdlib.h>
#include <string.h>

#define BLOCK 2 ///< groups along the side of the squares in whose order pixels are listed
#define FULL 0.9 ///< share of the lanes of all groups with a chosen pixel: above it, gathering saves nothing

struct glint_gathered {
    _Alignas(64) double pixel[2][GLINT_TILE_SAMPLES]; ///< columns and rows in the picture
    _Alignas(64) float beauty[3][GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t numbers[GLINT_TILE_SAMPLES]; ///< a result while it is reordered
    _Alignas(64) double point_light[2][3]
                                   [GLINT_TILE_SAMPLES]; ///< light of faces and vertices per sample: diffuse, specular
    bool has_point_light;
    uint16_t active[GLINT_TILE_GROUPS]; ///< `active` and the next members: saved from the tile
    uint32_t group_count, groups_across;
};

struct glint_gathered *glint_gathered_create(void) { return glint_alloc(1, sizeof(struct glint_gathered)); }

void glint_gathered_destroy(struct glint_gathered *gathered) { free(gathered); }

uint32_t glint_tile_list_gathered(const glint_tile *tile, const glint_tile_frame *frame,
                                  uint16_t slots[GLINT_TILE_SAMPLES])
{
    const uint32_t across = tile->groups_across, down = tile->group_count / across;
    uint32_t count = 0, groups = 0;
    if (tile->cached || !glint_tile_may_gather(frame))
        return 0;
    for (uint32_t y = 0; y < down; y += BLOCK)
        for (uint32_t x = 0; x < across; x += BLOCK)
            for (uint32_t i = 0; i < BLOCK * BLOCK; i++) {
                const uint32_t column = x + i % BLOCK, row = y + i / BLOCK, g = row * across + column;
                if (column >= across || row >= down)
                    continue;
                groups += tile->active[g] != 0;
                for (unsigned bits = tile->active[g]; bits; bits &= bits - 1)
                    slots[count++] = (uint16_t)(g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits));
            }
    return count < FULL * GLINT_GROUP * groups ? count : 0;
}

/// Computes column and row, in the picture, of the pixel at a position in the tile.
static void pixel_at(const glint_tile *tile, uint32_t slots, double out[2])
{
    const uint32_t g = slots / GLINT_GROUP, lane = slots % GLINT_GROUP;
    out[0] = tile->x0 + 4 * (g % tile->groups_across) + lane % 4;
    out[1] = tile->y0 + 4 * (g / tile->groups_across) + lane / 4;
}

/// Sets the camera's rays for the pixels at these positions: `samples` lanes each, at `offset` within the pixel. The
/// remaining lanes repeat the first pixel, and are not active.
static void place_pixels(glint_tile *tile, const uint16_t *slots, uint32_t count,
                         const double (*offset)[GLINT_LIGHT_CHUNK], uint32_t samples,
                         double (*pixel)[GLINT_TILE_SAMPLES])
{
    double first[2], end[2] = { 0, 0 }, at[2];
    pixel_at(tile, slots[0], first);
    for (uint32_t i = 0; i < count; i++) {
        pixel_at(tile, slots[i], at);
        for (int c = 0; c < 2; c++) {
            first[c] = at[c] < first[c] ? at[c] : first[c];
            end[c] = at[c] + 1 > end[c] ? at[c] + 1 : end[c];
            for (uint32_t k = 0; k < samples; k++)
                pixel[c][i * samples + k] = at[c] + offset[c][k];
        }
    }
    for (int c = 0; c < 2; c++)
        for (uint32_t i = count * samples; i % GLINT_GROUP; i++)
            pixel[c][i] = pixel[c][0];
    tile->camera.x0 = first[0];
    tile->camera.y0 = first[1];
    for (int c = 0; c < 2; c++) {
        tile->camera.pixel[c] = pixel[c];
        tile->camera.end[c] = end[c];
    }
}

/// Makes the rays, one pixel after the other.
static void make_pixel_rays(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *slots, uint32_t count,
                            uint32_t first, uint32_t samples)
{
    double offset[2][GLINT_LIGHT_CHUNK], at[2];
    for (uint32_t k = 0; k < samples; k++) {
        glint_plan_sample_offset(frame->plan, first + k, at);
        offset[0][k] = at[0];
        offset[1][k] = at[1];
    }
    place_pixels(tile, slots, count, (const double(*)[GLINT_LIGHT_CHUNK])offset, samples, tile->gathered->pixel);
    tile->camera.groups_across = 1;
    tile->camera.group_count = (count * samples + GLINT_GROUP - 1) / GLINT_GROUP;
    tile->camera.offset[0] = tile->camera.offset[1] = 0; // the positions of the pixels already contain the offsets
    tile->camera.down = tile->rays.direction;
    glint_tile_make_rays(tile, frame);
}

/// Activates the first `count` lanes of groups that repeat after `every` groups.
static void activate_lanes(glint_tile *tile, uint32_t every, uint32_t count)
{
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const uint32_t remaining = count - g % every * GLINT_GROUP;
        tile->active[g] = remaining < GLINT_GROUP ? (uint16_t)((1u << remaining) - 1) : 0xffff;
    }
}

void glint_tile_gather(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *slots, uint32_t count,
                       uint32_t first, uint32_t samples)
{
    struct glint_gathered *gathered = tile->gathered;
    memcpy(gathered->active, tile->active, sizeof gathered->active);
    gathered->has_point_light = false;
    gathered->group_count = tile->group_count;
    gathered->groups_across = tile->groups_across;
    glint_tile_aim(tile, frame, 0);
    make_pixel_rays(tile, frame, slots, count, first, samples);
    tile->groups_across = 1;
    tile->group_count = tile->camera.group_count;
    activate_lanes(tile, tile->group_count, count * samples);
}

// ---- Reordering from pixel by pixel to sample by sample ----

/// Transposes 16 pixels with 16 samples each.
static void stack_square(const uint32_t *from, uint32_t *to, size_t stride)
{
    for (size_t k = 0; k < GLINT_GROUP; k++)
        for (size_t p = 0; p < GLINT_GROUP; p++)
            to[k * stride + p] = from[p * GLINT_GROUP + k];
}

/// Reorders numbers, one per lane.
static void stack_numbers(struct glint_gathered *gathered, void *numbers, uint32_t count, uint32_t samples)
{
    const uint32_t blocks = (count + GLINT_GROUP - 1) / GLINT_GROUP, *from = gathered->numbers;
    uint32_t *to = numbers;
    memcpy(gathered->numbers, numbers, count * samples * sizeof *from);
    if (samples == GLINT_GROUP) {
        for (size_t b = 0; b < blocks; b++)
            stack_square(from + b * GLINT_GROUP * GLINT_GROUP, to + b * GLINT_GROUP, blocks * GLINT_GROUP);
        return;
    }
    for (uint32_t p = 0; p < count; p++)
        for (uint32_t k = 0; k < samples; k++)
            to[k * blocks * GLINT_GROUP + p] = *from++;
}

/// Transposes the bits of 16 groups: those of one lane become a group.
static void transpose_lanes(uint16_t lanes[GLINT_GROUP])
{
    unsigned low = 0x00ff;
    for (unsigned j = GLINT_GROUP / 2; j; j /= 2, low ^= low << j)
        for (unsigned g = 0; g < GLINT_GROUP; g = ((g | j) + 1) & ~j) {
            const unsigned other = (lanes[g] >> j ^ lanes[g | j]) & low;
            lanes[g] ^= (uint16_t)(other << j);
            lanes[g | j] ^= (uint16_t)other;
        }
}

/// Reorders bits, one per lane.
static void stack_lanes(uint16_t *lanes, uint32_t groups, uint32_t count, uint32_t samples)
{
    const uint32_t blocks = (count + GLINT_GROUP - 1) / GLINT_GROUP;
    uint16_t from[GLINT_TILE_GROUPS + GLINT_GROUP] = { 0 }, to[GLINT_TILE_GROUPS] = { 0 };
    memcpy(from, lanes, groups * sizeof *from);
    for (uint32_t b = 0; samples == GLINT_GROUP && b < blocks; b++) {
        transpose_lanes(from + b * GLINT_GROUP);
        for (uint32_t k = 0; k < samples; k++)
            to[k * blocks + b] = from[b * GLINT_GROUP + k];
    }
    for (uint32_t p = 0, i = 0; samples != GLINT_GROUP && p < count; p++)
        for (uint32_t k = 0; k < samples; k++, i++)
            to[k * blocks + p / GLINT_GROUP] |= (uint16_t)((from[i / GLINT_GROUP] >> i % GLINT_GROUP & 1) << p % GLINT_GROUP);
    memcpy(lanes, to, samples * blocks * sizeof *lanes);
}

/// Reorders the input of shade.
static void stack_samples(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count, uint32_t count, uint32_t samples)
{
    const glint_plan *plan = frame->plan;
    const uint32_t groups = tile->group_count;
    stack_lanes(tile->at.hits, groups, count, samples);
    if (!tile->at.only) // otherwise they are not read
        stack_numbers(tile->gathered, tile->surface.material, count, samples);
    for (uint32_t i = 0; i < light_count; i++) {
        const glint_plan_light *light = &plan->lights[i];
        uint16_t *lit = light->shadows ? tile->at.light[i].unoccluded : tile->at.light[i].lit;
        if (!glint_has_lanes(lit, groups)) {
            memset(lit, 0, sizeof tile->lights[0].lit);
            continue;
        }
        stack_lanes(lit, groups, count, samples);
        stack_numbers(tile->gathered, tile->at.light[i].cosine, count, samples);
        if (plan->highlights)
            stack_numbers(tile->gathered, tile->at.light[i].log2_specular, count, samples);
        if (light->attenuated)
            stack_numbers(tile->gathered, tile->at.light[i].attenuation, count, samples);
        if (light->cap)
            stack_numbers(tile->gathered, tile->at.light[i].visible, count, samples);
    }
    tile->group_count = (count + GLINT_GROUP - 1) / GLINT_GROUP * samples;
    activate_lanes(tile, tile->group_count / samples, count);
}

double (*glint_tile_gathered_points(glint_tile *tile))[3][GLINT_TILE_SAMPLES]
{
    struct glint_gathered *gathered = tile->gathered;
    gathered->has_point_light = true;
    memset(gathered->point_light, 0, sizeof gathered->point_light);
    return gathered->point_light;
}

void glint_tile_shade_gathered(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count,
                               const uint16_t *slots, uint32_t count, uint32_t first, uint32_t samples)
{
    struct glint_gathered *gathered = tile->gathered;
    float *const beauty[3] = { gathered->beauty[0], gathered->beauty[1], gathered->beauty[2] };
    const bool last = first + samples == (uint32_t)frame->plan->desc.samples;
    if (samples > 1)
        stack_samples(tile, frame, light_count, count, samples);
    glint_tile_shade_stacked(tile, frame, light_count, first, samples,
                             gathered->has_point_light ? (const double(*)[3][GLINT_TILE_SAMPLES])gathered->point_light
                                                       : NULL,
                             count, beauty);
    memcpy(tile->active, gathered->active, sizeof tile->active);
    tile->group_count = gathered->group_count;
    tile->groups_across = gathered->groups_across;
    for (int c = 0; c < 3 && last; c++)
        for (uint32_t i = 0; i < count; i++)
            tile->film.beauty[c][slots[i]] = beauty[c][i];
}
