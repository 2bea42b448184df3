/// Scan conversion of a tile: its triangles come from the frame's list, the other primitives are cast, and the nearer
/// hit wins.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/render/effects/raster/plan.h"
#include "engine/render/frame/renderer.h"

#include <stdlib.h>

/// The results of casting the other primitives.
typedef struct raster_rest {
    _Alignas(64) double t[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t prim[GLINT_TILE_SAMPLES];
    uint16_t hits[GLINT_TILE_GROUPS];
} raster_rest;

static void *create(const glint_plan *plan)
{
    (void)plan;
    return glint_alloc(1, sizeof(raster_rest));
}

static raster_rest *own_of(const glint_tile *tile) { return tile->own[GLINT_STAGE_RASTER]; }

static bool in_sight(const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_raster *raster = frame->own[GLINT_STAGE_RASTER];
    return raster->rest || raster->first[tile->index + 1] > raster->first[tile->index];
}

/// Merges both: the nearer hit wins, or at equal distance the surface defined first.
static void merge(glint_tile *tile, const glint_tile_frame *frame)
{
    const raster_rest *rest = own_of(tile);
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

static void cast(glint_tile *tile, const glint_tile_frame *frame, const glint_cast_args *args)
{
    const struct glint_geometry_stages *stages = &frame->stages->geometry[frame->plan->desc.precision];
    const glint_raster *raster = frame->own[GLINT_STAGE_RASTER];
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
    others.t = own_of(tile)->t;
    others.prim = own_of(tile)->prim;
    others.hits = own_of(tile)->hits;
    if (frame->plan->camera.orthographic)
        stages->cast_rays(&others);
    else
        stages->cast_bundle(&others);
    merge(tile, frame);
}

// ---- A frame ----

/// Returns whether some tile's hits are not cached.
static bool casts(const glint_reuse *reuse, const glint_plan *plan)
{
    for (size_t i = 0; i < reuse->tile_count; i++)
        if (!glint_key_equal(reuse->tiles[i].cast, plan->keys[GLINT_STAGE_CAST]))
            return true;
    return reuse->tile_count == 0;
}

/// Finds the triangles of each tile. If there are too many, all primitives are cast, with the index.
static glint_status begin(glint_renderer *renderer, glint_tile_frame *frame, glint_error *error)
{
    const glint_plan *plan = frame->plan;
    if (!casts(&renderer->reuse, plan))
        return GLINT_OK;
    glint_raster *raster = renderer->own[GLINT_STAGE_RASTER];
    if (!raster && !(raster = renderer->own[GLINT_STAGE_RASTER] = calloc(1, sizeof *raster)))
        return glint_fail_nomem(error);
    const double start = glint_frame_now_ms();
    const glint_status status = glint_raster_begin(raster, plan, &frame->geometry, renderer->pool, error);
    renderer->cast_ms = glint_frame_now_ms() - start;
    if (!frame->geometry.nodes)
        atomic_fetch_add(&plan->geometry->index->frames_without, 1);
    if (!status && raster->on)
        frame->caster = glint_stage_table[GLINT_STAGE_RASTER];
    return status || raster->on ? status : glint_geometry_index(plan->geometry, renderer->pool, &frame->geometry, error);
}

static void end(glint_renderer *renderer)
{
    glint_raster_clear(renderer->own[GLINT_STAGE_RASTER]);
    free(renderer->own[GLINT_STAGE_RASTER]);
}

/// Takes the place of casting rays, as a part of the stage cast. The last of the list: asks which stages run.
const glint_stage glint_stage_raster = {
    .called = glint_raster_is_called,
    .begin = begin,
    .end = end,
    .in_sight = in_sight,
    .cast = cast,
    .create = create,
    .destroy = free,
};
