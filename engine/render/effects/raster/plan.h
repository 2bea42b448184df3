/// Scan conversion: finds the triangles that each tile of a frame may show, by projecting all triangles. Internal.
///
/// The reverse of casting: no index is traversed. A triangle is entered in each tile that its image may touch,
/// conservatively; hits are decided as in casting. Other primitives are cast, and the nearer hit wins.
#ifndef GLINT_RASTER_H
#define GLINT_RASTER_H

#include "engine/render/plan/plan.h"

/// A frame's tiles and their triangles; the renderer keeps it to reuse its memory.
typedef struct glint_raster {
    bool on; ///< for this frame
    bool rest; ///< other primitives must be cast as well
    glint_geometry_table others; ///< the other primitives, with their own index
    size_t tile_count, tile_capacity, entry_capacity;
    size_t *first; ///< index of each tile's first entry, and the end of the last
    glint_raster_entry *entries; ///< tile after tile, the nearer first
} glint_raster;

/// Finds the entries before a frame. If there are too many entries, `on` stays false, and the frame must be cast.
glint_status glint_raster_begin(glint_raster *raster, const glint_plan *plan, const glint_geometry_table *geometry,
                                glint_pool *pool, glint_error *error);
void glint_raster_clear(glint_raster *raster);
/// Returns whether the frame's triangles are scan-converted, when all other stages are chosen.
bool glint_raster_is_called(const glint_plan *plan);

#endif
