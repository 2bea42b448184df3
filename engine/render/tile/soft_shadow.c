/// Sums the samples of an area light as they are computed, without storing each.
#include "engine/render/pattern/pattern.h"

#include <string.h>

/// Returns whether only the sum of the samples is read: no sample is cached or counted, and nothing reads single
/// samples.
static bool is_summed(const glint_tile *tile, const glint_tile_frame *frame, uint32_t first, uint32_t slot,
                      uint32_t count)
{
    const glint_plan *plan = frame->plan;
    const glint_plan_light *light = &plan->lights[first + slot];
    const uint32_t each_sample = 1u << GLINT_FIELD_SHININESS | 1u << GLINT_FIELD_BUMP | 1u << GLINT_FIELD_SHADER;
    if (!light->light_samples || light->hard || plan->facets || glint_plan_cuts(plan) || frame->count_work || frame->time_stages || glint_tile_fields_shown(tile, plan) & each_sample)
        return false;
    for (uint32_t i = slot; i < slot + count; i++)
        if (tile->at.light[i].cosine != glint_tile_own_light(tile, i)->cosine ||
            (light->shadows && tile->at.light[i].unoccluded != glint_tile_own_light(tile, i)->unoccluded))
            return false;
    for (glint_stage_set bits = plan->singles; bits; bits &= bits - 1)
        if (glint_stage_table[__builtin_ctzll(bits)]->singles(tile, frame, light))
            return false;
    return true;
}

static bool sum(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, uint32_t slot, uint32_t count)
{
    uint32_t slots[GLINT_LIGHT_CHUNK];
    uint16_t reached[GLINT_TILE_GROUPS];
    for (uint32_t i = 0; i < count; i++)
        slots[i] = slot + i;
    const bool shadows = frame->plan->lights[first + slot].shadows;
    const glint_light_args light = glint_tile_light_args(tile, frame, first, slots, count);
    const glint_occlude_args occlude = glint_tile_occlude_args(tile, frame, first, slots, count);
    const glint_soft_args args = { .light = &light,
                                   .occlude = shadows ? &occlude : NULL,
                                   .reached = reached,
                                   .diffuse = tile->at.light[slot].cosine,
                                   .specular = tile->at.light[slot].log2_specular };
    if (!frame->stages->geometry[frame->plan->desc.precision].soft_light(&args))
        return false;
    for (uint32_t i = slot; i < slot + count; i++) {
        memcpy(tile->at.light[i].lit, reached, tile->group_count * sizeof *reached);
        memcpy(tile->at.light[i].unoccluded, reached, tile->group_count * sizeof *reached);
        tile->at.light[i].brightest = 0; // unknown: the largest logarithm possible
    }
    glint_tile_count_stage(tile, frame, GLINT_STAGE_LIGHT, false);
    tile->counts.runs[GLINT_STAGE_LIGHT] += count - 1;
    if (shadows) {
        glint_tile_count_stage(tile, frame, GLINT_STAGE_OCCLUDE, false);
        tile->counts.runs[GLINT_STAGE_OCCLUDE] += count - 1;
    }
    return true;
}

bool glint_tile_sum_light(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, uint32_t slot,
                          uint32_t count)
{
    const bool summed = is_summed(tile, frame, first, slot, count) && sum(tile, frame, first, slot, count);
    for (uint32_t i = slot; i < slot + count; i++)
        tile->at.light[i].summed = summed;
    return summed;
}
