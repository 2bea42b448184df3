/// The paths of a tile's points: what the sources of this folder share. Internal.
#ifndef GLINT_INDIRECT_PATHS_H
#define GLINT_INDIRECT_PATHS_H

#include "engine/base/sequence.h"
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

/// As fmax: of a NaN and a number the number.
static inline double glint_larger(double a, double b) { return a > b || b != b ? a : b; }

static inline double glint_largest(const double c[3]) { return glint_larger(c[0], glint_larger(c[1], c[2])); }

/// Which point of its sequence path `number` of a pixel's point i takes.
static inline uint64_t glint_indirect_point_of(const struct glint_indirect *indirect, uint32_t i, uint64_t number)
{
    const uint64_t each = (uint64_t)indirect->plan.indirect.samples * (uint64_t)indirect->plan.desc.samples;
    return indirect->lane[i] * each + number;
}

/// The seed of that sequence, two for each turn: `which` says what for. k: the point.
static inline uint64_t glint_indirect_seed_of(const struct glint_indirect *indirect, uint32_t i, uint64_t k,
                                              uint32_t which)
{
    return glint_sequence_mix(indirect->block[i], which | (k >> 32) << 32);
}

/// Notes point k of a sequence in place `at` for the stage scatter, which takes the point `further` than what is noted.
static inline void glint_indirect_note(draws *to, uint32_t at, uint64_t k, const glint_sequence_seed *seed,
                                       uint32_t further)
{
    to->number[at] = (uint32_t)k - further;
    to->order[at] = seed->order;
    to->digits[0][at] = seed->digits[0];
    to->digits[1][at] = seed->digits[1];
}

/// Whether light that is scattered from a sample leaves its surface, along the direction in place i.
static inline bool glint_indirect_leaves(const glint_tile *tile, const glint_plan *plan, uint32_t i,
                                         const double (*direction)[GLINT_TILE_SAMPLES])
{
    double d[3];
    for (int c = 0; c < 3; c++)
        d[c] = glint_real_at(direction[c], plan->desc.precision, i);
    return glint_tile_leaves(tile, plan, i, d);
}

/// Where paths begin, and how many at each point. Returns the most.
uint32_t glint_indirect_find_points(struct glint_indirect *indirect, const glint_tile *to,
                                    const glint_tile_frame *frame, const glint_tile *seen, const glint_batch *from);
/// Directions around the normals of `tile` for the samples in `wanted`, by points that are `further` than those drawn.
void glint_indirect_scatter(const glint_tile *tile, const glint_tile_frame *frame, const uint16_t *wanted,
                            const draws *drawn, uint32_t further, double (*direction)[GLINT_TILE_SAMPLES]);
/// The first rays of path `path` of every point. Returns whether there are any.
bool glint_indirect_begin_paths(struct glint_indirect *indirect, const glint_tile_frame *frame, const glint_tile *seen,
                                uint32_t path, uint64_t number);
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
