/// The paths of a tile's points, for indirect light and for rough surfaces. Internal.
#ifndef GLINT_INDIRECT_PATHS_H
#define GLINT_INDIRECT_PATHS_H

#include "engine/base/sequence.h"
#include "engine/render/paths/event.h"

/// Points of the unit square, for the scattered rays: see glint_scatter_args.
typedef struct draws {
    _Alignas(64) uint32_t number[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t order[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t digits[2][GLINT_TILE_SAMPLES];
} draws;

/// A block of 4 x 4 pixels, seen through the same sequence of mirrors, with its number.
typedef struct glint_pixel_block {
    bool known;
    uint64_t at, depth_code, number;
} glint_pixel_block;

struct glint_indirect {
    glint_batch batch;
    glint_plan plan; ///< the frame's plan, with one sample of each light and without visible lights
    glint_tile_frame frame; ///< the frame with this plan
    glint_plan_light *lights; ///< lights of `plan`; NULL: there are none
    uint32_t paths[GLINT_TILE_SAMPLES], fewest; ///< number of paths of each point, and the least of these
    uint16_t matt[GLINT_TILE_GROUPS]; ///< the points that have paths
    uint64_t
        block[GLINT_TILE_SAMPLES]; ///< number of each point's pixel_block
    uint32_t lane[GLINT_TILE_SAMPLES]; ///< index of the pixel in its block
    draws first_draws, next_draws; ///< for the points, and for the hits of their paths
    glint_rays first; ///< the first ray of each point, by index; paths of a point differ only in direction
    double weight[3][GLINT_TILE_SAMPLES]; ///< throughput of these rays before anything is subtracted
    glint_rays next[2]; ///< rays of odd and even steps
    double share[GLINT_TILE_SAMPLES]; ///< with plan->sky: weights of scattered rays by their densities
    uint16_t scattered[GLINT_TILE_GROUPS]; ///< samples whose path is scattered
    uint16_t spread[GLINT_TILE_GROUPS]; ///< samples whose path a rough surface reflects or refracts
    uint8_t event[GLINT_TILE_SAMPLES]; ///< which of the two, a glint_event
    _Alignas(64) double direction[3][GLINT_TILE_SAMPLES]; ///< directions of scattered paths
    _Alignas(64) double up[3][GLINT_TILE_SAMPLES]; ///< real: (0, 0, 1), for points of the unit disk
    // an argument and the results of the stage spread, for the rays that plain rough surfaces reflect
    _Alignas(64) double alpha[GLINT_TILE_SAMPLES]; ///< real
    _Alignas(64) double grazing[GLINT_TILE_SAMPLES], unmasked[GLINT_TILE_SAMPLES];
    glint_term term; ///< the term of all first rays; GLINT_TERM_COUNT: they have several
    uint64_t salt; ///< distinguishes the sequences of indirect light, 0, from those of rough surfaces
};

/// Makes the memory for paths; NULL: out of memory.
struct glint_indirect *glint_indirect_create(const glint_plan *plan);
void glint_indirect_destroy(void *memory);
/// Prepares for the paths of a tile in a frame.
void glint_indirect_begin(struct glint_indirect *indirect, const glint_tile_frame *frame);
/// Follows one path of each point from its first ray, in indirect->first, to its end, and adds its light to the sums
/// of `to`.
void glint_indirect_follow(struct glint_indirect *indirect, const glint_tile_frame *frame, glint_tile *to,
                           uint64_t number);
/// Draws the point of the unit square for path `number` of point i.
void glint_indirect_draw(const struct glint_indirect *indirect, uint32_t i, uint64_t number, uint32_t which, double out[2]);

/// Returns the maximum like fmax: for NaN and a number, the number.
static inline double glint_larger(double a, double b) { return a > b || b != b ? a : b; }

static inline double glint_largest(const double c[3]) { return glint_larger(c[0], glint_larger(c[1], c[2])); }

/// Returns the index in its sequence for path `number` of point i.
static inline uint64_t glint_indirect_point_of(const struct glint_indirect *indirect, uint32_t i, uint64_t number)
{
    const uint64_t each = (uint64_t)indirect->plan.indirect.samples * (uint64_t)indirect->plan.desc.samples;
    return indirect->lane[i] * each + number;
}

/// Returns the seed of that sequence. There are two seeds for each step; `which` selects one. k: the index.
static inline uint64_t glint_indirect_seed_of(const struct glint_indirect *indirect, uint32_t i, uint64_t k,
                                              uint32_t which)
{
    return glint_sequence_mix(indirect->block[i], which | (k >> 32) << 32);
}

/// Stores index k of a sequence at `at` for the stage scatter, which uses the index plus its own offset `further`.
static inline void glint_indirect_note(draws *to, uint32_t at, uint64_t k, const glint_sequence_seed *seed,
                                       uint32_t further)
{
    to->number[at] = (uint32_t)k - further;
    to->order[at] = seed->order;
    to->digits[0][at] = seed->digits[0];
    to->digits[1][at] = seed->digits[1];
}

/// Returns the point of the unit square for ray i.
static inline void glint_indirect_square(const draws *from, uint32_t i, uint32_t further, double square[2])
{
    const glint_sequence_seed seed = { from->order[i], { from->digits[0][i], from->digits[1][i] } };
    glint_sequence_flipped(from->number[i] + further, &seed, square);
}

/// Returns whether the scattered direction at i leaves the sample's surface.
static inline bool glint_indirect_leaves(const glint_tile *tile, const glint_plan *plan, uint32_t i,
                                         const double (*direction)[GLINT_TILE_SAMPLES])
{
    double d[3];
    for (int c = 0; c < 3; c++)
        d[c] = glint_real_at(direction[c], plan->desc.precision, i);
    return glint_event_leaves(tile, plan, i, d);
}

/// Finds the points and their numbers of paths. Returns the largest number.
uint32_t glint_indirect_find_points(struct glint_indirect *indirect, const glint_tile *to,
                                    const glint_tile_frame *frame, const glint_tile *seen, const glint_batch *from);
/// Completes the first ray of the paths of point i, which glint_ray_begin has put into indirect->first: its throughput is
/// multiplied by `factor`. The first rays of a point differ only in their directions.
void glint_indirect_begin_point(struct glint_indirect *indirect, const glint_tile *to, const glint_plan *plan, uint32_t i,
                                uint32_t paths, const double *factor, glint_pixel_block *block);
/// Returns the number of paths of a point, which is smaller for points seen weakly in mirrors.
uint32_t glint_indirect_paths_of(const glint_plan *plan, const glint_batch *from, uint32_t i);
/// Selects the points that have a path number `path`, and draws for them. Returns whether there are any.
bool glint_indirect_choose_points(struct glint_indirect *indirect, const glint_plan *plan, uint32_t path, uint64_t number);
/// Computes directions around normals for the samples in `wanted`, with indices offset by `further`.
void glint_indirect_scatter(const glint_tile_frame *frame, uint32_t group_count, const void *const normal[3],
                            const uint16_t *wanted, const draws *drawn, uint32_t further,
                            double (*direction)[GLINT_TILE_SAMPLES]);
/// Draws directions from samples of `tile` by the sky or the cosine, and writes the weights of their rays. The
/// other arguments are as for glint_indirect_scatter.
void glint_indirect_draw_sky(const glint_tile *tile, const glint_plan *plan, const uint16_t *wanted, const draws *drawn,
                             uint32_t further, double (*direction)[GLINT_TILE_SAMPLES], double *share);
/// Multiplies the rays in `wanted` by these weights. Drops those of weight 0.
void glint_indirect_weigh_sky(glint_rays *rays, const uint16_t *wanted, const double *share);
/// Makes the first rays of path number `path` of every point. Returns whether there are any.
bool glint_indirect_begin_paths(struct glint_indirect *indirect, const glint_tile_frame *frame, const glint_tile *seen,
                                uint32_t path, uint64_t number);
/// Computes the continuations at samples of the batch with mirrors and transparent materials.
void glint_indirect_find_directions(struct glint_indirect *indirect, const glint_tile_frame *frame);
/// Adds the background seen by rays that hit nothing, the lanes in `missed`, to the sums of their pixels. background: NULL:
/// the colours in batch->shown.
void glint_indirect_collect_missed(const struct glint_indirect *indirect, const glint_tile_frame *frame,
                                   const uint16_t *missed, const double *background, glint_tile *to);
/// After a cast: adds the open sky that the rays reach, and continues the rays that hit transparent surfaces.
/// Returns whether there are any.
bool glint_indirect_open_sky(struct glint_indirect *indirect, const glint_tile_frame *frame, bool any, uint32_t step,
                             glint_tile *to);

#endif
