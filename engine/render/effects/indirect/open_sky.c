/// Ambient occlusion: casts rays from each point, in directions with the density of their cosine. The share of rays
/// that leave the scene is the open sky, which multiplies the ambient light. Surfaces within the scene's distance
/// block rays, except surfaces that transmit or are translucent: there rays go on, with a weight reduced by the
/// surface.
#include "engine/render/effects/indirect/paths.h"
#include "engine/render/effects/light_groups/light_groups.h"
#include "engine/render/effects/pattern/pattern.h"

#include <math.h>

/// Treats surfaces beyond the distance as open sky.
static void open_far(glint_batch *batch, const glint_plan *plan)
{
    glint_tile *tile = &batch->tile;
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = tile->at.hits[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits), ray = batch->ray_of[i];
            if (glint_real_at(tile->at.t, plan->desc.precision, i) <= plan->indirect.distance) // directions are unit
                continue;
            tile->at.hits[g] &= (uint16_t) ~(bits & -bits);
            if (!batch->whole)
                batch->with_sample[ray / GLINT_GROUP] &= (uint16_t) ~(1u << ray % GLINT_GROUP);
        }
}

/// Runs the programs of transmitted shares.
static void find_shares(glint_tile *tile, const glint_tile_frame *frame)
{
    const uint32_t shares = 1u << GLINT_FIELD_MIRROR | 1u << GLINT_FIELD_TRANSMISSION | 1u << GLINT_FIELD_CLEAR;
    if (glint_tile_fields_shown(tile, frame->plan) & shares)
        glint_tile_find_patterns(tile, frame);
}

/// Returns the continued ray of sample i: the refracted one or, at a translucent surface, the straight one with the
/// weight of both.
static glint_ray ray_beyond(const glint_batch *batch, const glint_tile_frame *frame, uint32_t i)
{
    const bool ends = !(batch->rays->depth[batch->ray_of[i]] < frame->plan->desc.max_depth);
    glint_ray split[GLINT_BRANCHES];
    glint_batch_split(batch, &batch->tile, frame, i, split);
    const glint_ray *refracted = &split[GLINT_BRANCH_REFRACTED], *straight = &split[GLINT_BRANCH_STRAIGHT];
    if (!frame->plan->clears || !(straight->weight[0] > 0))
        return *refracted;
    glint_ray ray = *straight;
    for (int c = 0; c < 3 && !ends; c++)
        ray.weight[c] += refracted->weight[c];
    return ray;
}

/// Sends on the rays at surfaces that let light through. Returns whether there are any.
static bool go_through(struct glint_indirect *indirect, const glint_tile_frame *frame, uint32_t step)
{
    glint_batch *batch = &indirect->batch;
    glint_tile *tile = &batch->tile;
    glint_rays *rays = &indirect->next[step & 1];
    unsigned any = 0;
    find_shares(tile, frame);
    glint_indirect_find_directions(indirect, frame);
    glint_rays_clear(rays, tile->group_count);
    for (uint32_t g = 0; g < tile->group_count; g++) {
        for (unsigned bits = batch->wanted[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            const glint_bounce_material *m = &frame->plan->bouncing[tile->surface.material[i]];
            if (!m->transmits && !m->clears)
                continue;
            const glint_ray through = ray_beyond(batch, frame, i);
            if (fmax(through.weight[0], fmax(through.weight[1], through.weight[2])) > through.least)
                glint_rays_put(rays, frame->plan, i, &through);
        }
        any |= rays->active[g];
    }
    batch->rays = rays;
    return any;
}

bool glint_indirect_open_sky(struct glint_indirect *indirect, const glint_tile_frame *frame, bool any, uint32_t step,
                             glint_tile *to)
{
    static const double white[3] = { 1, 1, 1 };
    glint_batch *batch = &indirect->batch;
    uint16_t missed[GLINT_TILE_GROUPS];
    if (any && isfinite(frame->plan->indirect.distance))
        open_far(batch, frame->plan);
    glint_batch_find_missed(batch, missed);
    glint_indirect_collect_missed(indirect, frame, missed, white, to);
    for (uint32_t i = 0; frame->plan->light_groups && i < batch->rays->group_count * GLINT_GROUP; i++)
        for (int c = 0; c < 3 && glint_has_lane(missed, i); c++) // weights are ambient light
            glint_groups_add_ambient(to, frame->plan, batch->rays->pixel[i], c, batch->rays->weight[c][i]);
    return any && (frame->plan->transmits || frame->plan->clears) && go_through(indirect, frame, step);
}
