/// The contract of raster: the nearest triangle of each ray, from a list of the triangles that a tile may show. Begin
/// with stages.h.
#ifndef GLINT_CONTRACT_RASTER_H
#define GLINT_CONTRACT_RASTER_H

#include "engine/render/stages/contract/hits.h"

typedef struct glint_raster_entry {
    uint32_t prim; ///< a triangle
    uint8_t x0, y0, x1, y1; ///< the pixels of the tile in which it may be visible, inclusive
    float depth; ///< lower bound of t * scale over all hits
} glint_raster_entry;

typedef struct glint_raster_args {
    glint_cast_args cast; ///< as for cast_bundle or, with an orthographic camera, as for cast_rays; `camera` is set
        ///< in both cases
    const glint_raster_entry *entries; ///< in any order; the scan is fastest if nearer triangles come first
    uint32_t entry_count;
} glint_raster_args;
// Like cast, with the triangles of the entries instead of all primitives.

#endif
