// occlude_beam: if there are many occluders between a tile and its light, the index is traversed once with the tile's
// beam (beam.h). A possible occluder is only tested against the points in its cells. Contract: stages.h, occlude.
#ifndef GLINT_OCCLUDE_THROUGH_BEAM_H
#define GLINT_OCCLUDE_THROUGH_BEAM_H

#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/occlude/beam.h"
#include "engine/render/stages/occlude/beam_leaf.h"
#include "engine/render/stages/occlude/beam_points.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/occlude/grid.h"
#include "engine/render/stages/occlude/near.h"
#include "engine/render/stages/occlude/occlude.h"
#include "engine/render/stages/simd/real.h"

// ---- The decision ----

static void R(decide_batch)(R(beam) * beam, const glint_prim *prim)
{
    R(beam_batch) *batch = &beam->batch;
    if (!batch->count)
        return;
    const R(light_sides) sides = R(seen_sides)(beam->tile, NULL, prim);
    const unsigned all = (1u << batch->count) - 1;
    R(close_points)
    (beam, batch->from,
     R(decide_blocked)(&batch->args, prim, beam->tile->position, 0, sides, batch->own, all));
    batch->count = 0;
    batch->own = 0;
    batch->back = 0;
}

static inline void R(add_to_batch)(R(beam) * beam, const glint_prim *prim, uint32_t i, uint32_t on, bool own)
{
    R(beam_batch) *batch = &beam->batch;
    real *const point[3] = { batch->point[0], batch->point[1], batch->point[2] };
    const int n = batch->count++;
    batch->from[n] = (uint16_t)i;
    batch->on[n] = on & ~BEAM_BACK;
    batch->own |= (unsigned)own << n;
    batch->back |= (uint16_t)((unsigned)((on & BEAM_BACK) != 0) << n);
    R(copy_point)(beam->tile->args, beam->at[i], false, n, point, NULL, NULL);
    if (batch->count == GLINT_GROUP)
        R(decide_batch)(beam, prim);
}

// ---- The filter ----

/// A possible occluder between points and light.
typedef struct R(beam_blocker) {
    const glint_prim *prim;
    uint32_t id;
    float near; ///< smallest w of the box of the primitive
    bool torus;
    shape_on_screen shape;
    rod_on_screen rod;
} R(beam_blocker);

/// Finds the points from `i` up to, not including, `end` that the primitive may block. Of the points on the primitive
/// itself, it only blocks points seen from behind, see blocked.h.
INNER void R(points_near)(R(beam) * beam, const R(beam_blocker) * b, uint32_t i, uint32_t end)
{
    int n = beam->runs;
    for (; i < end; i += VF) {
        const vf u = f_load_any(beam->uv[0] + i), v = f_load_any(beam->uv[1] + i), w = f_load_any(beam->w + i);
        const unsigned in_run = end - i < VF ? (1u << (end - i)) - 1 : (1u << VF) - 1;
        const unsigned behind = fm_bits(f_le(f_set(b->near), w)) & in_run;
        const vi owner = f_bits(f_load_any((const float *)(beam->own + i)));
        const unsigned front = b->torus ? 0 : fm_bits(i_eq(owner, i_set(b->id)));
        unsigned near = behind & ~front & near_shape(&b->shape, u, v);
        if (b->rod.is)
            near &= near_rod(&b->rod, u, v);
        beam->run[n] = (R(near_points)) { .first = (uint16_t)i, .near = (uint16_t)near };
        n += near != 0;
    }
    beam->runs = n;
}

static void R(block_cells)(R(beam) * beam, const glint_node *node, const node_on_screen *seen, int slot)
{
    const glint_geometry_table *geometry = beam->tile->args->geometry;
    const uint32_t id = node->child[slot] & ~GLINT_NODE_PRIM;
    const screen_cells cells = seen->cells[slot];
    R(beam_blocker) b = { .prim = &geometry->prims[id], .id = id, .near = seen->near[slot] };
    b.torus = is_torus(geometry, b.prim);
    b.shape = shape_of(node, seen, slot, b.prim, &beam->view);
    if (GLINT_REAL == 64) // as in cast_other
        see_rod(geometry, b.prim, &beam->view, &b.rod);
    const uint16_t *top = beam->begin + first_row(cells) * SCREEN_ACROSS;
    const uint16_t *bottom = beam->begin + last_row(cells) * SCREEN_ACROSS;
    const int first = first_column(cells), end = last_column(cells) + 1;
    if (end - first == SCREEN_ACROSS) // the cells of all rows are contiguous
        R(points_near)(beam, &b, *top, bottom[SCREEN_ACROSS]);
    for (; end - first < SCREEN_ACROSS && top <= bottom; top += SCREEN_ACROSS)
        R(points_near)(beam, &b, top[first], top[end]);
    for (int n = 0; n < beam->runs; n++)
        for (unsigned near = beam->run[n].near; near; near &= near - 1) {
            const uint32_t i = beam->run[n].first + (unsigned)__builtin_ctz(near), on = beam->own[i];
            R(add_to_batch)(beam, b.prim, i, on, (on & ~BEAM_BACK) == id);
        }
    beam->runs = 0;
    R(decide_batch)(beam, b.prim);
}

/// Removes from args->unoccluded the points that the primitives in the slots of `mask` block.
static void R(block_prims)(R(beam) * beam, const glint_node *node, const node_on_screen *seen, unsigned mask)
{
    const unsigned triangles = triangles_in(beam->tile->args->geometry, node, mask);
    for (unsigned bits = mask & ~triangles; bits; bits &= bits - 1)
        R(block_cells)(beam, node, seen, __builtin_ctz(bits));
    if (triangles)
        R(block_triangles)(beam, node, seen, triangles);
}

// ---- Traversal ----

/// Traverses the index with the beam. A node's primitives are tested while the next one's memory is prefetched, as in
/// walk_tile.
static void R(walk_beam)(R(beam) * beam)
{
    const glint_geometry_table *geometry = beam->tile->args->geometry;
    const glint_node *waiting = NULL;
    unsigned waiting_prims = 0;
    int height = 0, turn = 0;
    screen_entry stack[WALK_STACK];
    node_on_screen seen[2];
    stack[height++] = entry_of_root(&beam->view);
    for (; height > 0 && beam->unoccluded && !is_stopped(beam->tile->args->stop); turn = !turn) {
        const screen_entry top = stack[--height];
        const glint_node *node = &geometry->nodes[top.node];
        unsigned prims = 0;
        rows_behind behind;
        if (find_behind((const float(*)[SCREEN_ACROSS])beam->far, top, &behind)) {
            const unsigned mask = boxes_on_screen(node, &beam->view, &seen[turn]), all = prims_of_node(node);
            prims = slots_before(&behind, &seen[turn], mask & all);
            prefetch_prims(geometry, node, prims);
            for (unsigned bits = mask & ~all; bits; bits &= bits - 1)
                stack[height++] = entry_of(node, &seen[turn], __builtin_ctz(bits));
        }
        prefetch_nodes(geometry, stack, height);
        if (waiting_prims)
            R(block_prims)(beam, waiting, &seen[!turn], waiting_prims);
        waiting = node;
        waiting_prims = prims;
    }
    if (waiting_prims)
        R(block_prims)(beam, waiting, &seen[!turn], waiting_prims);
}

static void R(begin_batch)(const glint_occlude_args *args, R(beam_batch) * batch)
{
    batch->count = 0;
    batch->own = 0;
    batch->back = 0;
    batch->args = *args;
    batch->args.camera = NULL;
    batch->args.back = &batch->back;
    batch->args.prim = batch->on;
    for (int k = 0; k < 3; k++)
        batch->args.point[k] = batch->point[k];
    memset(batch->point, 0, sizeof batch->point); // the kernels also compute lanes without a point
    memset(batch->on, 0xff, sizeof batch->on);
}

/// Removes from args->unoccluded the points that the index's primitives block. Returns false, with nothing changed,
/// if these points cannot form a beam.
static bool R(occlude_beam)(const R(shadow_tile) * tile)
{
    const glint_occlude_args *args = tile->args;
    R(beam_coords) coords;
    R(beam) beam;
    beam.tile = tile;
    if (!R(aim_beam)(tile, &beam.view))
        return false;
    if (!R(project_points)(tile, args->unoccluded[0], &beam.view, &coords))
        return false;
    R(sort_points)(&beam, args->unoccluded[0], &coords);
    R(begin_batch)(args, &beam.batch);
    R(begin_beam_leaf)(&beam.leaf);
    beam.runs = 0;
    R(walk_beam)(&beam);
    return true;
}

// ---- One point light ----

/// Computes the shadows if there are too many occluders for a list.
static void R(occlude_many)(const R(shadow_tile) * tile, R(shadow_group) * group)
{
    const glint_occlude_args *args = tile->args;
    uint16_t *unoccluded = args->unoccluded[0];
    for (uint32_t g = 0; g < args->group_count; g++) {
        R(begin_group)(g, group);
        unoccluded[g] = (uint16_t)R(test_unbounded)(tile, NULL, group, unoccluded[g]);
    }
    if (!args->geometry->nodes || R(occlude_by_grid)(tile, group) || R(occlude_beam)(tile))
        return;
    group->last_blocker = GLINT_MISS;
    for (uint32_t g = 0; g < args->group_count; g++)
        if (unoccluded[g]) {
            R(begin_group)(g, group);
            unoccluded[g] = (uint16_t)R(walk_group)(tile, NULL, group, unoccluded[g]);
        }
}

static void R(occlude_point)(const glint_occlude_args *args)
{
    uint16_t *out = args->unoccluded[0];
    R(shadow_tile) tile;
    R(shadow_group) group;
    group.last_blocker = GLINT_MISS;
    R(begin_shadows)(args, args->lit[0], &tile);
    for (uint32_t g = 0; g < args->group_count; g++) {
        out[g] = args->lit[0][g];
        *args->rays += (unsigned)__builtin_popcount(out[g]);
    }
    if (!tile.count)
        return;
    R(aim_at)(&tile, NULL);
    if (tile.count > GLINT_OCCLUDERS) {
        R(occlude_many)(&tile, &group);
        return;
    }
    uint32_t near[GLINT_TILE_GROUPS];
    R(find_near)(&tile, &group, near);
    for (uint32_t g = 0; g < args->group_count; g++) {
        R(begin_group)(g, &group);
        for (unsigned bits = near[g]; bits && out[g]; bits &= bits - 1)
            out[g] &= (uint16_t)~R(blocked_by)(&tile, tile.occluders[__builtin_ctz(bits)], &group, out[g]);
    }
}

#endif
