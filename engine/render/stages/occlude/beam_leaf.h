// beam_leaf: tests the triangles of a node against the points of a beam. As in cast/leaf.h, a float test selects
// pairs of triangle and point, which are then decided a vector at a time, with a different triangle in each lane.
// Contract: stages.h, occlude.
#ifndef GLINT_OCCLUDE_BEAM_LEAF_H
#define GLINT_OCCLUDE_BEAM_LEAF_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/leaf.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/leaf.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/occlude/beam.h"
#include "engine/render/stages/occlude/beam_points.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/simd/real.h"

/// Returns the maximum w of the unoccluded points of a cell.
static inline float R(farthest_in)(const R(beam) * beam, uint32_t cell)
{
    const uint32_t end = beam->begin[cell + 1];
    vf far = f_set(-HUGE_VALF);
    for (uint32_t j = beam->begin[cell]; j < end; j += VF) {
        const unsigned in_cell = end - j < VF ? (1u << (end - j)) - 1 : (1u << VF) - 1;
        far = f_select(fm_from_bits(in_cell), f_max(f_load_any(beam->w + j), far), far); // NaN is ignored
    }
    return f_max_all(far);
}

/// Marks the points from[0] .. from[15] that are in `blocked` and still unoccluded as blocked. If such a point was
/// the farthest of its cell, the cell's maximum is computed again, once for consecutive points of the same cell.
static inline void R(close_points)(R(beam) * beam, const uint16_t *from, unsigned blocked)
{
    const uint32_t none = BEAM_DOWN * SCREEN_ACROSS;
    float *const far = beam->far[0];
    uint32_t stale = none;
    for (; blocked; blocked &= blocked - 1) {
        const uint32_t i = from[__builtin_ctz(blocked)], at = beam->at[i], cell = beam->cell[i];
        const float w = beam->w[i];
        if (w == -HUGE_VALF)
            continue;
        if (stale != cell && stale != none) {
            far[stale] = R(farthest_in)(beam, stale);
            stale = none;
        }
        if (w == far[cell])
            stale = cell;
        beam->tile->args->unoccluded[0][at / GLINT_GROUP] &= (uint16_t) ~(1u << at % GLINT_GROUP);
        beam->w[i] = -HUGE_VALF;
        beam->unoccluded--;
    }
    if (stale != none)
        far[stale] = R(farthest_in)(beam, stale);
}

/// Copies the point at index `at` into lane n of the output arrays. If the occluder is a triangle, also copies the
/// ray that hit the point.
static inline void R(copy_point)(const glint_occlude_args *args, uint32_t at, bool triangle, int n, real *const point[3],
                                 real *const direction[3], real *slack)
{
    const uint32_t g = at / GLINT_GROUP, lane = at % GLINT_GROUP;
    for (int k = 0; k < 3; k++)
        point[k][n] = ((const real *)args->point[k])[at];
    if (!triangle)
        return;
    const uint32_t across = args->camera ? args->camera->groups_across : 1;
    const R(group_directions) viewing = R(directions_of)(args->camera, g % across, g / across);
    slack[n] = ((const real *)args->slack)[at];
    for (int k = 0; k < 3; k++)
        direction[k][n] = viewing.across ? viewing.across[k * GLINT_GROUP + lane] + viewing.down[k * GLINT_GROUP + lane]
                                         : ((const real *)args->direction[k])[at];
}

static inline void R(begin_beam_leaf)(R(beam_leaf) * leaf)
{
    memset(leaf->corner, 0, sizeof leaf->corner);
    leaf->own = leaf->back = 0;
    leaf->count = 0;
}

/// Loads the corners. Lanes without a triangle are unchanged.
static inline void R(load_beam_leaf)(const R(beam) * beam, unsigned mask, R(beam_leaf) * leaf)
{
    const glint_geometry_table *geometry = beam->tile->args->geometry;
    _Alignas(64) real moved[GLINT_NODE_WIDTH];
    R(load_node_corners)(geometry, leaf->node, mask, leaf->corner);
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++) {
            const vr reference = r_set(geometry->reference[k]), scale = r_set(geometry->scale);
            for (int i = 0; i < GLINT_NODE_WIDTH; i += VR)
                r_store(moved + i, (r_load(leaf->corner[j][k] + i) - reference) * scale - r_set(beam->view.exact[k]));
            R(narrow)(moved, leaf->shown.corner[j][k]);
        }
}

// ---- The decision ----

/// Returns which of the VR pairs from number i on have their triangle between the point and the light.
static unsigned R(pairs_blocked)(const R(beam) * beam, int i)
{
    const R(beam_leaf) *leaf = &beam->leaf;
    const R(shadow_tile) *tile = beam->tile;
    const glint_occlude_args *args = tile->args;
    const unsigned all = (1u << VR) - 1, own = leaf->own >> i & all, back = leaf->back >> i & all;
    const vr zero = r_set(0),
             light[3] = { r_load(tile->position[0]), r_load(tile->position[1]), r_load(tile->position[2]) };
    vr corner[3][3], point[3], d[3], ray[3];
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            corner[j][k] = r_pick(leaf->corner[j][k], leaf->slot + i);
    for (int k = 0; k < 3; k++) {
        point[k] = r_load(leaf->point[k] + i);
        ray[k] = r_load(leaf->direction[k] + i);
        d[k] = light[k];
        if (!args->directional)
            d[k] = (d[k] - point[k]) * r_set(args->scale);
    }
    const double scale = args->geometry->scale;
    const R(triangle_plane) plane = R(plane_of)(corner, scale, light, args->directional);
    unsigned blocked = own & ((rm_bits(r_lt(zero, plane.light)) & back) | (rm_bits(r_lt(plane.light, zero)) & ~back));
    if (own != all)
        blocked |= rm_bits(R(triangle_blocks)(corner, scale, point, d, r_load(leaf->slack + i), &plane, ray)) & ~own;
    return blocked;
}

static void R(decide_beam_pairs)(R(beam) * beam)
{
    R(beam_leaf) *leaf = &beam->leaf;
    uint64_t *tests = beam->tile->args->tests;
    if (tests)
        *tests += (unsigned)leaf->count;
    for (int n = leaf->count; n % VR; n++) {
        leaf->slot[n] = leaf->slot[0];
        leaf->slack[n] = leaf->slack[0];
        for (int k = 0; k < 3; k++) {
            leaf->point[k][n] = leaf->point[k][0];
            leaf->direction[k][n] = leaf->direction[k][0];
        }
    }
    for (int i = 0; i < leaf->count; i += VR) {
        const unsigned there = leaf->count - i < VR ? (1u << (leaf->count - i)) - 1 : (1u << VR) - 1;
        R(close_points)(beam, leaf->from + i, R(pairs_blocked)(beam, i) & there);
    }
    leaf->own = leaf->back = 0;
    leaf->count = 0;
}

static inline void R(add_beam_pair)(R(beam) * beam, int slot, uint32_t i, bool own)
{
    R(beam_leaf) *leaf = &beam->leaf;
    real *const point[3] = { leaf->point[0], leaf->point[1], leaf->point[2] };
    real *const direction[3] = { leaf->direction[0], leaf->direction[1], leaf->direction[2] };
    const int n = leaf->count++;
    leaf->slot[n] = (uint32_t)slot;
    leaf->from[n] = (uint16_t)i;
    leaf->own |= (unsigned)own << n;
    leaf->back |= (unsigned)((beam->own[i] & BEAM_BACK) != 0) << n;
    R(copy_point)(beam->tile->args, beam->at[i], true, n, point, direction, leaf->slack);
    if (leaf->count == GLINT_BEAM_PAIRS)
        R(decide_beam_pairs)(beam);
}

/// Makes pairs from the recorded points and their triangles.
static inline void R(pair_points)(R(beam) * beam)
{
    for (int n = 0; n < beam->runs; n++) {
        const R(near_points) run = beam->run[n];
        for (unsigned near = run.near; near; near &= near - 1) {
            const unsigned lane = (unsigned)__builtin_ctz(near);
            R(add_beam_pair)(beam, run.slot, run.first + lane, run.own >> lane & 1);
        }
    }
    beam->runs = 0;
}

// ---- The filter ----

/// Tests the points from `i` up to, not including, `end`.
INNER void R(points_near_triangle)(R(beam) * beam, int slot, own_side mine, uint32_t i, uint32_t end)
{
    const leaf_on_screen *shown = &beam->leaf.shown;
    int n = beam->runs;
    for (; i < end; i += VF) { // testing the few points behind the triangle costs less than a branch
        const unsigned in_run = end - i < VF ? (1u << (end - i)) - 1 : (1u << VF) - 1;
        const unsigned behind = fm_bits(f_le(f_set(shown->near[slot]), f_load_any(beam->w + i))) & in_run;
        const vi owner = f_bits(f_load_any((const float *)(beam->own + i)));
        const unsigned own = fm_bits(i_eq(i_and(owner, i_set(~BEAM_BACK)), i_set(mine.id)));
        const unsigned dark = mine.any ? own : fm_bits(i_eq(owner, i_set(mine.id | mine.side)));
        const unsigned near = between_edges(shown, slot, f_load_any(beam->uv[0] + i), f_load_any(beam->uv[1] + i));
        const unsigned found = behind & ((near & ~own) | dark);
        beam->run[n] = (R(near_points)) { (uint16_t)i, (uint16_t)found, (uint16_t)own, (uint16_t)slot };
        n += found != 0;
    }
    beam->runs = n;
}

/// Finds the points that the triangle in a slot may block.
static void R(block_triangle)(R(beam) * beam, int slot)
{
    const R(beam_leaf) *leaf = &beam->leaf;
    const screen_cells cells = leaf->cells[slot];
    if (!any_behind((const float(*)[SCREEN_ACROSS])beam->far, leaf->shown.near[slot], cells))
        return;
    // the determinant is negative if the light is in front; a point seen from behind is on the other side
    const own_side mine = { leaf->node->child[slot] & ~GLINT_NODE_PRIM,
                            leaf->shown.negative >> slot & 1 ? BEAM_BACK : 0, !(leaf->shown.certain >> slot & 1) };
    const uint16_t *top = beam->begin + first_row(cells) * SCREEN_ACROSS;
    const uint16_t *bottom = beam->begin + last_row(cells) * SCREEN_ACROSS;
    const int first = first_column(cells), end = last_column(cells) + 1;
    const bool whole = end - first == SCREEN_ACROSS; // the cells of all rows are contiguous
    if (beam->runs > GLINT_BEAM_RUNS)
        R(pair_points)(beam);
    for (; top <= bottom; top = whole ? bottom + 1 : top + SCREEN_ACROSS)
        R(points_near_triangle)(beam, slot, mine, top[first], whole ? bottom[end] : top[end]);
}

/// Removes from args->unoccluded the points that the triangles in the slots of `mask` block. The points for all
/// triangles are selected before the first pair is made, without branches, as in groups.h.
static void R(block_triangles)(R(beam) * beam, const glint_node *node, const node_on_screen *seen, unsigned mask)
{
    R(beam_leaf) *leaf = &beam->leaf;
    leaf->node = node;
    R(load_beam_leaf)(beam, mask, leaf);
    show_leaf(&beam->view, seen, GLINT_REAL == 32, &leaf->shown);
    for (mask = cells_of_leaf(&beam->view, seen, &leaf->shown, mask, leaf->cells); mask; mask &= mask - 1)
        R(block_triangle)(beam, __builtin_ctz(mask));
    R(pair_points)(beam);
    R(decide_beam_pairs)(beam);
}

#endif
