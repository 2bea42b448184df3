/// A batch of rays that start on surfaces: at most a tile's samples, walked through the stages together. Internal.
///
/// effects/bounce and effects/indirect make the rays and use their light.
#ifndef GLINT_PATHS_BATCH_H
#define GLINT_PATHS_BATCH_H

#include "engine/render/effects/bounce/plan.h"
#include "engine/render/pattern/pattern.h"
#include "engine/render/paths/ray.h"

typedef struct glint_batch {
    glint_tile tile; ///< samples are the packed hits of the rays; `group_count` and `active` say which exist
    glint_rays *rays; ///< the rays to cast
    glint_rays own; ///< the initial value of `rays`
    bool ordered; ///< every hit must have the sample of its ray's number
    bool distances; ///< only distances of hits are read; surfaces are not computed
    bool by_lane; ///< packed samples keep the lane of their ray
    bool whole; ///< every ray has the sample of its own number, even if it hits nothing
    _Alignas(64) double t[GLINT_TILE_SAMPLES]; ///< distance and primitive per ray, before packing; real
    _Alignas(64) uint32_t prim[GLINT_TILE_SAMPLES];
    uint16_t with_sample[GLINT_TILE_GROUPS]; ///< rays that have a sample; not set if `whole`
    uint16_t sample[GLINT_TILE_SAMPLES]; ///< the sample of each ray that has one
    uint16_t ray_of[GLINT_TILE_SAMPLES]; ///< the ray of each sample
    double shown[3][GLINT_TILE_SAMPLES]; ///< the background seen by rays without a sample, if a program computes it
    // continuations of the wanted samples of a tile, by glint_event_find_directions
    uint16_t wanted[GLINT_TILE_GROUPS], total[GLINT_TILE_GROUPS];
    _Alignas(64) double ratio[GLINT_TILE_SAMPLES];
    _Alignas(64) double reflectance[GLINT_TILE_SAMPLES];
    _Alignas(64) double normal[3][GLINT_TILE_SAMPLES]; ///< real; only in frames with bumps
    _Alignas(64) double reflected[3][GLINT_TILE_SAMPLES], refracted[3][GLINT_TILE_SAMPLES];
} glint_batch;

static inline bool glint_batch_has_sample(const glint_batch *batch, uint32_t ray)
{
    return batch->whole || glint_has_lane(batch->with_sample, ray);
}

/// Returns the media of the ray that hit a sample; only in frames with transparent materials.
static inline const glint_media *glint_batch_media(const glint_batch *batch, uint32_t i)
{
    return &batch->rays->media[batch->ray_of[i]];
}

/// Called before the first batch of a sample of `to`.
void glint_batch_begin(glint_batch *batch, const glint_tile *to, const glint_tile_frame *frame, glint_walk walk);
/// Casts batch->rays, and applies absorption to their throughput. Returns whether anything is hit.
bool glint_batch_cast(glint_batch *batch, const glint_tile_frame *frame);
/// After the cast: finds the rays that hit nothing.
void glint_batch_find_missed(const glint_batch *batch, uint16_t missed[GLINT_TILE_GROUPS]);
/// Runs the programs of the materials that the rays hit.
void glint_batch_find_patterns(glint_batch *batch, const glint_tile_frame *frame);
/// Computes the sums of the batch's tile: the light that surfaces, and in a whole batch the background, send back
/// along the rays. lights: the frame, or one with other lights; the light of faces and vertices is cached for all readers,
/// so it is the frame's.
void glint_batch_light(glint_batch *batch, const glint_tile_frame *frame, const glint_tile_frame *lights, bool any);
/// Computes the sums of glint_batch_light only for the hits that are shaded per sample.
void glint_batch_shine(glint_batch *batch, const glint_tile_frame *frame, bool any);
/// Returns the light of all local terms of sample `i`, in channel `c`.
static inline double glint_batch_local_light(const glint_batch *batch, int c, uint32_t i)
{
    const double(*sum)[3][GLINT_TILE_SAMPLES] = batch->tile.film.sum;
    double light = sum[0][c][i];
    for (int k = 1; k < GLINT_TERM_LOCAL; k++)
        light += sum[k][c][i];
    return light;
}
/// Returns the light along ray `ray`.
static inline double glint_batch_light_of(const glint_batch *batch, const glint_plan *plan, int c, uint32_t ray)
{
    if (glint_batch_has_sample(batch, ray))
        return glint_batch_local_light(batch, c, batch->sample[ray]);
    return plan->environment ? batch->shown[c][ray] : plan->background[c];
}
/// Returns whether ray `ray` shows the eye the background through surfaces, which lowers the coverage of its pixel.
/// Only for frames that need coverage.
static inline bool glint_batch_uncovers(const glint_batch *batch, const glint_plan *plan, uint32_t ray)
{
    const uint32_t i = batch->sample[ray];
    const bool seen = glint_batch_has_sample(batch, ray) &&
                      (glint_has_lane(batch->tile.at.hits, i) || glint_tile_sees_light(&batch->tile, plan, i));
    return batch->rays->camera_path[ray] && !seen;
}
/// Returns the medium that a cast ray of the batch crossed since its last surface.
uint32_t glint_batch_crossed(const glint_batch *batch, const glint_tile_frame *frame, uint32_t ray);
/// Adds the work of the batches to the tile they were made for.
void glint_batch_end(const glint_batch *batch, glint_tile *to);

#endif
