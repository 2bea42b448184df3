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

/// Makes the grids of a frame's lights without samples that throw shadows, where the tiles that it runs, or those of the next frames,
/// pay for them and they are within what may be kept, drops others, and names them in `frame`. A refined frame has those of its base. Zeroed memory is a beginning.
glint_status glint_grids_begin(glint_grids *grids, glint_tile_frame *frame, const glint_extent *extent, int threads,
                               glint_error *error);
void glint_grids_clear(glint_grids *grids);

#endif
