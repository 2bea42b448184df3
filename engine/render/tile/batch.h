/// A batch of rays that start on surfaces: at most a tile's samples, walked through the stages together. Internal.
///
/// effects/bounce and effects/indirect make the rays and use their light.
#ifndef GLINT_BATCH_H
#define GLINT_BATCH_H

#include "engine/render/effects/bounce/plan.h"
#include "engine/render/effects/pattern/pattern.h"
#include "engine/render/tile/rays.h"

/// Returns a weight, limited to GLINT_WEIGHT_MAX.
static inline double glint_weight(double x) { return x < GLINT_WEIGHT_MAX ? x : GLINT_WEIGHT_MAX; }

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
    // continuations of the wanted samples of a tile, by glint_batch_find_directions
    uint16_t wanted[GLINT_TILE_GROUPS], total[GLINT_TILE_GROUPS];
    _Alignas(64) double ratio[GLINT_TILE_SAMPLES];
    _Alignas(64) double reflectance[GLINT_TILE_SAMPLES];
    _Alignas(64) double reflected[3][GLINT_TILE_SAMPLES], refracted[3][GLINT_TILE_SAMPLES];
} glint_batch;

/// The direction in which a ray goes on from a surface.
typedef enum glint_branch {
    GLINT_BRANCH_MIRRORED,
    GLINT_BRANCH_REFRACTED, ///< refracted or totally reflected
    GLINT_BRANCH_STRAIGHT, ///< straight on through a translucent surface
    GLINT_BRANCHES
} glint_branch;

#define GLINT_PASSES_MAX 4096 ///< translucent surfaces that one ray may go straight through

/// Rays that continue from samples of a tile.
typedef struct glint_sent {
    uint32_t count;
    uint16_t sample[GLINT_TILE_SAMPLES]; ///< the sample where each ray starts
    uint8_t branch[GLINT_TILE_SAMPLES]; ///< a glint_branch
} glint_sent;

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
/// Casts batch->rays, and applies absorption to their weights. Returns whether anything is hit.
bool glint_batch_cast(glint_batch *batch, const glint_tile_frame *frame);
/// After the cast: finds the rays that hit nothing.
void glint_batch_find_missed(const glint_batch *batch, uint16_t missed[GLINT_TILE_GROUPS]);
/// Computes the sums of the batch's tile: the light that surfaces, and in a whole batch the background, send back
/// along the rays.
void glint_batch_light(glint_batch *batch, const glint_tile_frame *frame, bool any);
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
    return batch->rays->sight[ray] && !seen;
}
/// Returns whether any visible material passes a test. The materials must be known.
bool glint_tile_shows(const glint_tile *tile, const glint_tile_frame *frame, bool (*test)(const glint_bounce_material *));
/// Returns the refractive index on this side of the surface of sample i divided by the index beyond; 1 for a mirror
/// that does not transmit.
double glint_batch_ratio(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i);
/// Updates the media of a ray that crosses the surface of sample i. A material that transmits has an inside; any
/// other translucent surface has none.
void glint_batch_cross(const glint_tile *tile, const glint_tile_frame *frame, uint32_t i, glint_media *media);
/// Computes the reflected and refracted directions at the samples of `tile` in batch->wanted. `tile` is the batch's
/// own, or one that the eye sees.
void glint_batch_find_directions(glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame);
/// Starts a ray at the hit of sample `i` of the tile. Direction and weight are set later,
/// and the media only in frames with transparent materials.
void glint_batch_start_ray(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                           glint_ray *ray);
/// Computes the weights of the rays that go on from sample `i`, after glint_batch_find_directions. On entry, each
/// weight is the weight of the arriving ray. A ray that the material does not send gets 0.
void glint_batch_weigh(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       double weight[GLINT_BRANCHES][3]);
/// Returns the rays that go on from a sample, with weights. The last ray is set only in frames with translucent
/// surfaces. If batch->total is set, the first two rays have the same direction.
void glint_batch_split(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       glint_ray rays[GLINT_BRANCHES]);
/// Fills `rays`, from ray 0 on, with the continued rays listed in `sent`, without weights and slopes. Rays from a
/// tile seen by the eye get their term, too.
void glint_batch_send(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame,
                      const glint_sent *sent, glint_rays *rays);
/// Returns the medium that a cast ray of the batch crossed since its last surface.
uint32_t glint_batch_crossed(const glint_batch *batch, const glint_tile_frame *frame, uint32_t ray);
/// Finds the media of sample `i` on the ray's side of its surface, and beyond: materials or GLINT_NO_MEDIUM.
void glint_batch_sides(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       uint32_t sides[2]);
/// Adds the work of the batches to the tile they were made for.
void glint_batch_end(const glint_batch *batch, glint_tile *to);

#endif
