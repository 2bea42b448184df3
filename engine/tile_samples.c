/// Samples of a tile that are shaded together: their sums never leave the registers.
#include "engine/base/alloc.h"
#include "engine/tile.h"

#include <stdlib.h>
#include <string.h>

struct glint_samples {
    _Alignas(64) uint32_t material[GLINT_LIGHT_CHUNK][GLINT_TILE_SAMPLES];
    uint16_t hits[GLINT_LIGHT_CHUNK][GLINT_TILE_GROUPS];
    glint_shade_light lights[GLINT_LIGHT_CHUNK];
    glint_shade_args shade[GLINT_LIGHT_CHUNK];
};

struct glint_samples *glint_samples_create(void) { return glint_alloc(1, sizeof(struct glint_samples)); }

void glint_samples_destroy(struct glint_samples *samples) { free(samples); }

void glint_tile_remember_sample(glint_tile *tile, const glint_tile_frame *frame, uint32_t light_count)
{
    struct glint_samples *samples = tile->samples;
    const uint32_t k = tile->sample;
    glint_shade_args *shade = &samples->shade[k];
    *shade = glint_tile_shade_args(tile, frame, 0, light_count, &samples->lights[tile->own_lights]);
    memcpy(samples->hits[k], tile->at.hits, tile->group_count * sizeof *samples->hits[k]);
    shade->hits = samples->hits[k];
    if (!shade->only)
        memcpy(samples->material[k], tile->material, tile->group_count * GLINT_GROUP * sizeof *samples->material[k]);
    shade->material = samples->material[k];
    glint_tile_count_powers(tile, frame, 0, light_count);
}

void glint_tile_resolve_samples(glint_tile *tile, const glint_tile_frame *frame)
{
    const uint32_t count = (uint32_t)frame->plan->desc.samples;
    glint_shade_args *shade = tile->samples->shade;
    glint_tile_point_film(tile, frame->plan, shade->film, shade->beauty);
    frame->stages->resolve_samples(shade, count);
    glint_tile_book(tile, frame, GLINT_STAGE_SHADE, false);
    tile->counts.runs[GLINT_STAGE_SHADE] += count - 1;
    glint_tile_book(tile, frame, GLINT_STAGE_RESOLVE, false);
}
