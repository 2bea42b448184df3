/// The grids of a frame's lights, cached while geometry and light stay unchanged. Internal.
#ifndef GLINT_GRIDS_H
#define GLINT_GRIDS_H

#include "engine/render/plan/plan.h"
#include "engine/render/tile/tile.h"

typedef struct glint_grids {
    glint_key where; ///< key of the geometry of the grids
    const glint_node *nodes;
    bool plain; ///< see glint_index
    uint32_t count;
    struct {
        bool directional;
        bool used; ///< recorded by an earlier frame, and used in the current one, too
        bool made; ///< otherwise only recorded
        double position[3];
        glint_light_grid *grid; ///< NULL: there is none
    } of[GLINT_TILE_GRIDS];
} glint_grids;

/// Makes the grids of a frame's lights that cast shadows and are not sampled as areas, and sets them in `frame`.
/// Drops grids that are not needed. A grid is made if it pays in the tiles of this or the next frames, and if it
/// takes at most 1 / GLINT_TILE_GRIDS of the cache budget. A refined frame has the grids of its base. Initialise the
/// structure with zeros.
glint_status glint_grids_begin(glint_grids *grids, glint_tile_frame *frame, const glint_extent *extent, int threads,
                               glint_error *error);
void glint_grids_clear(glint_grids *grids);

#endif
