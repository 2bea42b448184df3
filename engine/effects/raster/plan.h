/// Scan conversion: which triangles each tile of a frame may show, found by projecting all of them. Internal.
///
/// The other way round than casting: no index is walked. A triangle is entered in each tile that its image may touch,
/// generously; whether a ray hits it is decided as ever. What is no triangle is cast, and the nearer of both is seen.
#ifndef GLINT_RASTER_H
#define GLINT_RASTER_H

#include "engine/plan/plan.h"

/// A frame's tiles and their triangles; kept by the renderer for its memory.
typedef struct glint_raster {
    bool on; ///< for this frame
    double ms; ///< that finding the entries took
    bool rest; ///< there is something to be cast beside
    glint_geometry_table others; ///< that, with its own index
    size_t tile_count, tile_room, entry_room;
    size_t *first; ///< of each tile, its first entry, and one more
    glint_raster_entry *entries; ///< tile after tile, the nearer first
} glint_raster;

/// Before a frame. Where there are too many entries, `on` stays false: the frame is to be cast.
glint_status glint_raster_begin(glint_raster *raster, const glint_plan *plan, const glint_geometry_table *geometry,
                                glint_pool *pool, glint_error *error);
void glint_raster_clear(glint_raster *raster);
/// Whether scanning is likely to be faster than casting; needs_index: other stages of the plan walk it.
bool glint_raster_pays(const glint_plan *plan, bool needs_index);

#endif
