/// A batch of rays that start on surfaces: at most a tile's samples, walked through the stages together. Internal.
///
/// tile/bounce.c and tile/indirect.c decide which rays there are and what becomes of the light they find.
#ifndef GLINT_BATCH_H
#define GLINT_BATCH_H

#include "engine/tile/pattern.h"

#define GLINT_WEIGHT_MAX 1e150 ///< products with what a surface gives stay finite

typedef struct glint_batch_ray {
    double origin[3], direction[3], weight[3]; ///< the direction is unit but for rounding
    uint32_t leaving; ///< the primitive it starts on
    uint32_t pixel; ///< its sample's place in the tile
    uint32_t depth; ///< mirrors and refractions on its path so far
    uint32_t scatters; ///< matt surfaces
    double way; ///< from the eye to where it starts, along its path; in frames with programs
    double least; ///< the weight below which a path of indirect light ends
    uint16_t term; ///< where its light goes
    bool inward;
    glint_media media;
} glint_batch_ray;

typedef struct glint_batch {
    glint_tile tile; ///< its samples are the rays, in arrays; `group_count` and `active` say which there are
    glint_batch_ray ray[GLINT_TILE_SAMPLES];
    uint16_t inward[GLINT_TILE_GROUPS], wanted[GLINT_TILE_GROUPS], total[GLINT_TILE_GROUPS];
    _Alignas(64) uint32_t leaving[GLINT_TILE_SAMPLES];
    // where the wanted samples of a tile go on, by glint_batch_find_ways
    _Alignas(64) double ratio[GLINT_TILE_SAMPLES];
    _Alignas(64) double reflectance[GLINT_TILE_SAMPLES];
    _Alignas(64) double reflected[3][GLINT_TILE_SAMPLES], refracted[3][GLINT_TILE_SAMPLES];
} glint_batch;

/// Before the first batch of a sample of `to`.
void glint_batch_begin(glint_batch *batch, const glint_tile *to, const glint_tile_frame *frame, glint_walk walk);
/// Puts the active rays into the arrays; the other lanes do nothing.
void glint_batch_load(glint_batch *batch, glint_precision precision);
/// Finds what the rays hit, and weakens them by what they went through. Returns whether anything is hit.
bool glint_batch_cast(glint_batch *batch, const glint_tile_frame *frame);
/// Makes the sums of the batch's tile: what surfaces and background themselves send back along the rays.
void glint_batch_light(glint_batch *batch, const glint_tile_frame *frame, bool any);
/// The same of those hits whose light is worked out for themselves.
void glint_batch_shine(glint_batch *batch, const glint_tile_frame *frame, bool any);
/// The light of all local terms along ray `i`, in channel `c`.
double glint_batch_found(const glint_batch *batch, int c, uint32_t i);
/// Where light goes on from the samples of `tile` in batch->wanted: mirrored and refracted. `tile` is the batch's own, or
/// one that the eye sees.
void glint_batch_find_ways(glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame);
/// A ray that starts where sample `i` of the tile hits, before its direction and weight are known.
glint_batch_ray glint_batch_start_ray(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame,
                                      uint32_t i);
/// The mirrored and the refracted ray of sample `i`, weighed, after glint_batch_find_ways. Where batch->total is set both
/// go the same way.
void glint_batch_split(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       glint_batch_ray *mirror, glint_batch_ray *through);
/// Adds the work of the batches to the tile they were made for.
void glint_batch_end(const glint_batch *batch, glint_tile *to);

#endif
