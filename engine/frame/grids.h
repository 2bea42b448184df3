/// The grids of a frame's lights, kept while the geometry and a light stay where they are. Internal.
#ifndef GLINT_GRIDS_H
#define GLINT_GRIDS_H

#include "engine/plan/plan.h"
#include "engine/tile/tile.h"

typedef struct glint_grids {
    glint_key where; ///< of the geometry that they are of
    const glint_node *nodes;
    bool plain; ///< see glint_index
    uint32_t count;
    struct {
        bool directional;
        bool used; ///< noted by an earlier frame, and of the one at hand too
        bool made; ///< else it was only noted
        double position[3];
        glint_light_grid *grid; ///< NULL: there is none
    } of[GLINT_TILE_GRIDS];
} glint_grids;

/// Makes the grids of a frame's lights without samples that throw shadows, and names them in `frame`; drops those that it has no use
/// for. A grid is made where the tiles that the frame runs, or those of the next frames, pay for it, and where it takes no more than
/// 1 / GLINT_TILE_GRIDS of what may be kept. A refined frame has those of its base. Zeroed memory is a beginning.
glint_status glint_grids_begin(glint_grids *grids, glint_tile_frame *frame, const glint_extent *extent, int threads,
                               glint_error *error);
void glint_grids_clear(glint_grids *grids);

#endif
