/// A batch of rays that start on surfaces: at most a tile's samples, walked through the stages together. Internal.
///
/// effects/bounce and effects/indirect decide which rays there are and what becomes of the light they find.
#ifndef GLINT_BATCH_H
#define GLINT_BATCH_H

#include "engine/effects/pattern/pattern.h"
#include "engine/tile/rays.h"

#define GLINT_WEIGHT_MAX 1e150 ///< products with what a surface gives stay finite

/// A weight, bounded.
static inline double glint_weight(double x) { return x < GLINT_WEIGHT_MAX ? x : GLINT_WEIGHT_MAX; }

typedef struct glint_batch {
    glint_tile tile; ///< its samples are what the rays have met, packed; `group_count` and `active` say which there are
    glint_rays *rays; ///< that are cast
    glint_rays own; ///< what that is at first
    bool ordered; ///< every ray is to have the sample of its own number
    bool distances; ///< of what is met the distance is read alone: surfaces are not found
    bool by_lane; ///< packed samples keep the lane of their ray
    bool whole; ///< every ray has the sample of its own number, also where it meets nothing
    _Alignas(64) double t[GLINT_TILE_SAMPLES]; ///< of each ray as it is cast, before samples are packed; real. And so `prim`
    _Alignas(64) uint32_t prim[GLINT_TILE_SAMPLES];
    uint16_t met[GLINT_TILE_GROUPS]; ///< not whole: the rays that have a sample
    uint16_t sample[GLINT_TILE_SAMPLES]; ///< of each ray that has one
    uint16_t ray_of[GLINT_TILE_SAMPLES]; ///< the other way
    double shown[3][GLINT_TILE_SAMPLES]; ///< where a program gives the background, what rays without a sample see of it
    // where the wanted samples of a tile go on, by glint_batch_find_ways
    uint16_t wanted[GLINT_TILE_GROUPS], total[GLINT_TILE_GROUPS];
    _Alignas(64) double ratio[GLINT_TILE_SAMPLES];
    _Alignas(64) double reflectance[GLINT_TILE_SAMPLES];
    _Alignas(64) double reflected[3][GLINT_TILE_SAMPLES], refracted[3][GLINT_TILE_SAMPLES];
} glint_batch;

/// The direction in which a ray goes on from a surface.
typedef enum glint_way {
    GLINT_WAY_MIRRORED,
    GLINT_WAY_REFRACTED, ///< or totally reflected
    GLINT_WAY_STRAIGHT, ///< through a translucent surface
    GLINT_WAYS
} glint_way;

#define GLINT_PASSES_MAX 4096 ///< translucent surfaces that one ray may go straight through

/// Rays that go on from samples of a tile.
typedef struct glint_sent {
    uint32_t count;
    uint16_t sample[GLINT_TILE_SAMPLES]; ///< where each begins
    uint8_t way[GLINT_TILE_SAMPLES]; ///< a glint_way
} glint_sent;

static inline bool glint_batch_has_sample(const glint_batch *batch, uint32_t ray)
{
    return batch->whole || glint_has_lane(batch->met, ray);
}

/// What the ray that found a sample went through; frames with transparent materials.
static inline const glint_media *glint_batch_media(const glint_batch *batch, uint32_t i)
{
    return &batch->rays->media[batch->ray_of[i]];
}

/// Before the first batch of a sample of `to`.
void glint_batch_begin(glint_batch *batch, const glint_tile *to, const glint_tile_frame *frame, glint_walk walk);
/// Finds what batch->rays hit, and weakens them by what they went through. Returns whether anything is hit.
bool glint_batch_cast(glint_batch *batch, const glint_tile_frame *frame);
/// The rays that have met nothing, after that.
void glint_batch_find_missed(const glint_batch *batch, uint16_t missed[GLINT_TILE_GROUPS]);
/// Makes the sums of the batch's tile: what surfaces, and of a whole batch the background, themselves send back along the rays.
void glint_batch_light(glint_batch *batch, const glint_tile_frame *frame, bool any);
/// The same of those hits whose light is worked out for themselves.
void glint_batch_shine(glint_batch *batch, const glint_tile_frame *frame, bool any);
/// The light of all local terms of sample `i`, in channel `c`.
static inline double glint_batch_found(const glint_batch *batch, int c, uint32_t i)
{
    const double(*sum)[3][GLINT_TILE_SAMPLES] = batch->tile.film.sum;
    double light = sum[0][c][i];
    for (int k = 1; k < GLINT_TERM_LOCAL; k++)
        light += sum[k][c][i];
    return light;
}
/// The light along ray `ray`.
static inline double glint_batch_light_of(const glint_batch *batch, const glint_plan *plan, int c, uint32_t ray)
{
    if (glint_batch_has_sample(batch, ray))
        return glint_batch_found(batch, c, batch->sample[ray]);
    return plan->environment ? batch->shown[c][ray] : plan->background[c];
}
/// Returns whether ray `ray` shows the eye the background through surfaces, and lowers the coverage of its pixel. Only for frames that need
/// coverage.
static inline bool glint_batch_uncovers(const glint_batch *batch, const glint_plan *plan, uint32_t ray)
{
    const uint32_t i = batch->sample[ray];
    const bool seen = glint_batch_has_sample(batch, ray) &&
                      (glint_has_lane(batch->tile.at.hits, i) || (plan->visible_light_count && glint_tile_sees_light(&batch->tile, i)));
    return batch->rays->sight[ray] && !seen;
}
/// Where light goes on from the samples of `tile` in batch->wanted: mirrored and refracted. `tile` is the batch's own, or
/// one that the eye sees.
void glint_batch_find_ways(glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame);
/// A ray that starts where sample `i` of the tile hits, before its direction and weight are known: its direction is not set, and
/// its media only in frames with transparent materials.
void glint_batch_start_ray(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                           glint_ray *ray);
/// Weighs the rays that go on from sample `i`, after glint_batch_find_ways: each comes with the weight of the ray that came. A ray that the
/// material does not send gets 0.
void glint_batch_weigh(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       double weight[GLINT_WAYS][3]);
/// These rays, weighed; the last one only in frames with translucent surfaces. Where batch->total is set the first two go the same way.
void glint_batch_split(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       glint_ray rays[GLINT_WAYS]);
/// The same of many samples: makes `rays` of those that are sent, from ray 0 on, but for their weights and slopes. Those from a tile
/// that the eye sees get their term, too.
void glint_batch_send(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame,
                      const glint_sent *sent, glint_rays *rays);
/// The medium that a ray of the batch, which is cast, went through since its last surface.
uint32_t glint_batch_crossed(const glint_batch *batch, const glint_tile_frame *frame, uint32_t ray);
/// The media of sample `i` of the tile on the ray's side of its surface, and beyond: materials, GLINT_NO_MEDIUM.
void glint_batch_sides(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       uint32_t sides[2]);
/// Adds the work of the batches to the tile they were made for.
void glint_batch_end(const glint_batch *batch, glint_tile *to);

#endif
