/// Ambient occlusion: casts rays from each point, in directions with the density of their cosine. The share of rays
/// that leave the scene is the open sky, which multiplies the ambient light. Surfaces within the scene's distance
/// block rays, except surfaces that transmit or are translucent: there rays go on, with a weight reduced by the
/// surface.
#include "engine/render/effects/indirect/paths.h"
#include "engine/render/light_groups/light_groups.h"
#include "engine/render/pattern/pattern.h"

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

/// Continues the ray of sample i: the refracted one or, at a translucent surface, the straight one with the light of both.
static void go_beyond(const glint_batch *batch, const glint_tile_frame *frame, uint32_t i, glint_rays *rays)
{
    const uint32_t ray = batch->ray_of[i];
    const bool ends = !(batch->rays->depth[ray] < frame->plan->desc.max_depth);
    double throughput[GLINT_SPLITS][3];
    for (int event = 0; event < GLINT_SPLITS; event++)
        for (int c = 0; c < 3; c++)
            throughput[event][c] = batch->rays->throughput[c][ray];
    glint_bsdf_weights(batch, &batch->tile, frame, i, throughput);
    const bool straight = frame->plan->clears && throughput[GLINT_EVENT_STRAIGHT][0] > 0;
    const glint_event event = straight ? GLINT_EVENT_STRAIGHT : GLINT_EVENT_REFRACT;
    double *sent = throughput[event];
    for (int c = 0; c < 3 && straight && !ends; c++)
        sent[c] += throughput[GLINT_EVENT_REFRACT][c];
    if (!(fmax(sent[0], fmax(sent[1], sent[2])) > batch->rays->min_throughput[ray]))
        return;
    glint_ray_continue(batch, &batch->tile, frame, i, event, rays, i);
    for (int c = 0; c < 3; c++)
        rays->throughput[c][i] = sent[c];
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
            if (m->transmits || m->clears)
                go_beyond(batch, frame, i, rays);
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
            glint_groups_add_ambient(to, frame->plan, batch->rays->pixel[i], c, batch->rays->throughput[c][i]);
    return any && (frame->plan->transmits || frame->plan->clears) && go_through(indirect, frame, step);
}
