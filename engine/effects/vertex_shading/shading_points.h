/// The light of faces and vertices that is worked out once: for flat and Gouraud shading. Internal.
///
/// A site has two sides. Sides are worked out in blocks, the first time that a sample needs one of a block: the sites of a
/// block are always the same and in the same lanes, so that every side gets the same light, in whatever order tiles run. A block is
/// worked out by the worker that claims it; others wait for it.
#ifndef GLINT_SHADING_POINTS_H
#define GLINT_SHADING_POINTS_H

#include "engine/plan/plan.h"
#include "engine/reuse/reuse.h"

#include <stdatomic.h>

#define GLINT_SHADING_POINT_BLOCK 64 ///< a few groups: neighbours in a mesh are mostly seen together

typedef enum glint_block_state { GLINT_BLOCK_NONE, GLINT_BLOCK_CLAIMED, GLINT_BLOCK_DONE } glint_block_state;

/// What a renderer keeps of them from frame to frame.
typedef struct glint_shading_points_cached {
    glint_key key; ///< of what is there; all zero: nothing
    uint32_t blocks; ///< of one side; those of the backs follow those of the fronts
    uint32_t ready; ///< blocks that were there before this frame
    glint_shading_point_light *light; ///< of the fronts, then of the backs; then of each group of light passes likewise
    size_t group_count; ///< of light passes
    double *slopes; ///< of each its light, three numbers, and as many slopes by each derivative; NULL: the frame has none
    size_t slope_count; ///< derivatives
    atomic_uchar *state; ///< of each block: a glint_block_state
    size_t reserved; ///< bytes of the budget
} glint_shading_points_cached;

/// Before a frame: keeps what has the plan's key, and makes room for the rest.
glint_status glint_shading_points_begin(glint_shading_points_cached *shading_points, const glint_plan *plan,
                                        glint_reuse *reuse, glint_error *error);
void glint_shading_points_clear(glint_shading_points_cached *shading_points, glint_reuse *reuse);

#endif
