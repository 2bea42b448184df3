/// The light of faces and vertices, computed once for flat and Gouraud shading. Internal.
///
/// A shading point has two sides. Sides are computed in blocks, when a sample first needs one of them. The points of
/// a block and their lanes are fixed, so every side gets the same light, in whatever order tiles run. The worker that
/// claims a block computes it; others wait for it.
#ifndef GLINT_SHADING_POINTS_H
#define GLINT_SHADING_POINTS_H

#include "engine/render/tile/tile.h"

#include <stdatomic.h>

#define GLINT_SHADING_POINT_BLOCK 64 ///< a few groups: neighbours in a mesh are usually visible together

typedef enum glint_block_state { GLINT_BLOCK_NONE, GLINT_BLOCK_CLAIMED, GLINT_BLOCK_DONE } glint_block_state;

/// The light that a renderer caches from frame to frame.
typedef struct glint_shading_points_cached {
    glint_key key; ///< key of the contents; all zero: empty
    uint32_t blocks; ///< blocks of one side; the blocks of backs follow those of fronts
    glint_shading_point_light *light; ///< light of fronts, then backs; then both for each light group
    size_t group_count; ///< of light passes
    double *slopes; ///< for each point its light (three numbers) and three slopes for each derivative; NULL: no
        ///< derivatives
    size_t slope_count; ///< derivatives
    atomic_uchar *state; ///< state of each block: a glint_block_state
    size_t reserved; ///< bytes reserved in the budget
} glint_shading_points_cached;

/// As glint_stage.begin and end: reuse the cached light if its key is the plan's, otherwise allocate memory.
glint_status glint_shading_points_begin(glint_renderer *renderer, glint_tile_frame *frame, glint_error *error);
void glint_shading_points_end(glint_renderer *renderer);

static inline glint_shading_points_cached *glint_shading_points_of(const glint_tile_frame *frame)
{
    return frame->own[GLINT_STAGE_VERTEX_SHADING];
}

/// Caches the light of a block of faces or vertices for each group of lights; nothing without light passes.
void glint_groups_store_block(const glint_tile *tile, const glint_tile_frame *frame, uint32_t block);
/// Adds the cached light of each group to the samples that show the faces and vertices of `args`.
void glint_groups_spread(const glint_tile *tile, const glint_tile_frame *frame, glint_vertex_args *args);

#endif
