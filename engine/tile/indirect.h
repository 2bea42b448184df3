/// What tile/indirect.c and tile/open_sky.c share: the paths of a tile's points. Internal.
#ifndef GLINT_TILE_INDIRECT_H
#define GLINT_TILE_INDIRECT_H

#include "engine/tile/batch.h"

/// Points of the unit square, for the scattered rays: see glint_scatter_args.
typedef struct draws {
    _Alignas(64) uint32_t number[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t order[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t digits[2][GLINT_TILE_SAMPLES];
} draws;

struct glint_indirect {
    glint_batch batch;
    glint_plan plan; ///< the frame's, with one sample of each light, which is not seen
    glint_tile_frame frame; ///< likewise
    glint_plan_light *lights; ///< of that plan; NULL: there are none
    uint32_t paths[GLINT_TILE_SAMPLES], fewest; ///< that each point gets, and the least of these
    uint16_t matt[GLINT_TILE_GROUPS]; ///< the points that get any
    uint64_t
        block[GLINT_TILE_SAMPLES]; ///< a number for the 4 x 4 pixels of each point, and for its place among mirrors
    uint32_t lane[GLINT_TILE_SAMPLES]; ///< which of these pixels
    draws first_draws, next_draws; ///< of the points, and of what their paths met
    glint_rays first; ///< from each point its own number's ray: but for its direction, the same for all paths
    double weight[3][GLINT_TILE_SAMPLES]; ///< what these weigh before anything is taken from them
    glint_rays next[2]; ///< rays of odd and even steps
    uint16_t scattered[GLINT_TILE_GROUPS]; ///< samples that a path leaves so
    _Alignas(64) double direction[3][GLINT_TILE_SAMPLES]; ///< of these
};

/// Samples of the batch that mirrors and transparent materials may send paths on from; finds where to.
void glint_indirect_find_ways(struct glint_indirect *indirect, const glint_tile_frame *frame);
/// Adds what rays that meet nothing bring, the lanes in `missed`, to the sums of their pixels.
void glint_indirect_collect_missed(const struct glint_indirect *indirect, const glint_tile_frame *frame,
                                   const uint16_t *missed, const double background[3], glint_tile *to);
/// After a cast: adds the light of the open sky that the rays lead to, and sends those on that meet what lets light through.
/// Returns whether there are any.
bool glint_indirect_open_sky(struct glint_indirect *indirect, const glint_tile_frame *frame, bool any, uint32_t step,
                             glint_tile *to);

#endif
