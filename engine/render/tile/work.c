/// Counts the work of a tile's stages, for the statistics of a frame.
#include "engine/render/tile/tile.h"

void glint_tile_count_light(glint_tile *tile, const glint_tile_frame *frame, uint32_t count)
{
    for (uint32_t g = 0; frame->count_work && g < tile->group_count; g++)
        tile->counts.work.light_samples += (uint64_t)__builtin_popcount(tile->at.sampled[g]) * count;
}

static bool is_power(const glint_shade_material *material)
{
    return material->highlight == GLINT_HIGHLIGHT_PHONG || material->highlight == GLINT_HIGHLIGHT_BLINN;
}

/// Counts the highlights that `shade` evaluates: the light reaches the point, and the material has a highlight there.
void glint_tile_count_powers(glint_tile *tile, const glint_tile_frame *frame, uint32_t from, uint32_t count)
{
    const glint_plan *plan = frame->plan;
    for (uint32_t i = 0; frame->count_work && plan->powers && i < count; i++) {
        const bool shadows = plan->lights[from + i].shadows;
        const uint16_t *reached = shadows ? tile->at.light[i].unoccluded : tile->at.light[i].lit;
        for (uint32_t at = 0; at < tile->group_count * GLINT_GROUP; at++)
            if (reached[at / GLINT_GROUP] >> at % GLINT_GROUP & 1 &&
                is_power(&plan->materials[tile->surface.material[at]]) &&
                tile->at.light[i].log2_specular[at] > GLINT_NO_SPECULAR)
                tile->counts.work.powers++;
    }
}
