/// Scan conversion of a tile: its triangles come from the frame's list, the other primitives are cast, and the nearer
/// hit wins.
#include "engine/base/alloc.h"
#include "engine/tile/tile.h"

#include <stdlib.h>

/// The results of casting the other primitives.
struct glint_raster_rest {
    _Alignas(64) double t[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t prim[GLINT_TILE_SAMPLES];
    uint16_t hits[GLINT_TILE_GROUPS];
};

struct glint_raster_rest *glint_raster_rest_create(void) { return glint_alloc(1, sizeof(struct glint_raster_rest)); }

void glint_raster_rest_destroy(struct glint_raster_rest *rest) { free(rest); }

bool glint_tile_raster_in_sight(const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_raster *raster = frame->raster;
    return raster->rest || raster->first[tile->index + 1] > raster->first[tile->index];
}

/// Merges both: the nearer hit wins, or at equal distance the surface defined first.
static void merge(glint_tile *tile, const glint_tile_frame *frame)
{
    const struct glint_raster_rest *rest = tile->raster_rest;
    const glint_precision precision = frame->plan->desc.precision;
    const glint_prim *prims = frame->geometry.prims;
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = rest->hits[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits), prim = tile->at.prim[i];
            const double mine = glint_real_at(tile->at.t, precision, i), other = glint_real_at(rest->t, precision, i);
            if (prim != GLINT_MISS && !(other < mine || (other == mine && prims[rest->prim[i]].id < prims[prim].id)))
                continue;
            glint_real_put(tile->at.t, precision, i, other);
            tile->at.prim[i] = rest->prim[i];
            tile->at.hits[g] |= (uint16_t)(bits & -bits);
        }
}

void glint_tile_raster(glint_tile *tile, const glint_tile_frame *frame, const glint_cast_args *args)
{
    const struct glint_geometry_stages *stages = &frame->stages->geometry[frame->plan->desc.precision];
    const glint_raster *raster = frame->raster;
    const size_t first = raster->first[tile->index];
    const glint_raster_args triangles = { .cast = *args,
                                          .entries = raster->entries + first,
                                          .entry_count = (uint32_t)(raster->first[tile->index + 1] - first) };
    stages->raster(&triangles);
    if (!raster->rest)
        return;
    glint_cast_args others = *args;
    others.geometry = &raster->others;
    others.view = NULL;
    others.t = tile->raster_rest->t;
    others.prim = tile->raster_rest->prim;
    others.hits = tile->raster_rest->hits;
    if (frame->plan->camera.orthographic)
        stages->cast_rays(&others);
    else
        stages->cast_bundle(&others);
    merge(tile, frame);
}
