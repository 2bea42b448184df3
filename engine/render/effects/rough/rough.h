/// Rays that a rough surface reflects and refracts. Internal.
#ifndef GLINT_ROUGH_H
#define GLINT_ROUGH_H

#include "engine/render/paths/event.h"

/// Estimates the shares of a ray's light that the rough surface of sample i reflects and refracts, to choose between
/// them. Both are above 0 where light may go on. disk: see glint_rough_leave. share: by GLINT_EVENT_MIRROR and
/// GLINT_EVENT_REFRACT.
void glint_rough_shares(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                        const double disk[2], double share[2]);

/// Returns whether a surface only reflects, from GGX's facets, so that the stage spread serves it.
static inline bool glint_is_plain(const glint_plan *plan, uint32_t material)
{
    const glint_bounce_material *m = &plan->bouncing[material];
    return m->rough && !m->transmits && !m->beckmann && !m->fresnel && !plan->sky &&
           !(glint_plan_bumps(plan) && plan->patterns->of[material].slope);
}

/// Returns the reflected share in channel c without the material's factors, by Schlick. grazing: (1 - cosine)^5 of the
/// arriving ray and the facet.
static inline double glint_schlick(const glint_bounce_material *m, int c, double grazing)
{
    return m->schlick ? m->f0[c] + (1 - m->f0[c]) * grazing : 1;
}

/// Turns ray n, which glint_ray_begin has started at sample i, into one that its rough surface reflects or refracts:
/// direction, side, depth, media; multiplies the throughput, which is 0 where the drawn facet sends the ray through the
/// surface. disk: a point of the unit disk, where equal areas are equally likely. cube: the point of the unit square that
/// it belongs to, and a third number in 0 .. 1; only read under a sky with bright parts, which may draw another event
/// than the given one. Returns the event.
glint_event glint_rough_leave(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                              const double disk[2], const double *cube, glint_event event, glint_rays *rays, uint32_t n);

#endif
