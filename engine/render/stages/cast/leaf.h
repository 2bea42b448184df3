// cast_leaf: tests the triangles of a node against the groups of a tile. A float test selects the rays that may pass
// between the edges. These pairs of triangle and ray are decided a vector at a time, with a different triangle in
// each lane. Contract: stages.h, cast.
#ifndef GLINT_CAST_LEAF_H
#define GLINT_CAST_LEAF_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/face.h"
#include "engine/render/stages/cast/groups.h"
#include "engine/render/stages/cast/shared_edge.h"
#include "engine/render/stages/cast/solid.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/candidate.h"
#include "engine/render/stages/index/cover.h"
#include "engine/render/stages/index/leaf.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

#define GLINT_PAIRS (4 * GLINT_GROUP)

/// The triangles of one node, and the pairs that are still to be decided.
typedef struct R(cast_leaf) {
    _Alignas(64) real corner[3][3][GLINT_NODE_WIDTH]; ///< the corners of the triangle in each slot
    _Alignas(64) real origin[3][GLINT_PAIRS]; ///< the ray's origin, for each pair
    _Alignas(64) real direction[3][GLINT_PAIRS], t[GLINT_PAIRS];
    _Alignas(64) uint32_t slot[GLINT_PAIRS];
    _Alignas(64) uint32_t at[GLINT_PAIRS]; ///< the ray, for each pair
    int count;
    const glint_node *node;
    unsigned faced; ///< slots whose triangle shares its plane with others
    leaf_on_screen shown;
    _Alignas(64) uint32_t pixels[GLINT_NODE_WIDTH]; ///< the pixels in which each triangle may be visible, in the
        ///< format of screen_cells
    R(near_group) group[GLINT_NODE_WIDTH * GLINT_TILE_GROUPS]; ///< the groups in which each triangle may be visible
    uint8_t slot_of_group[GLINT_NODE_WIDTH * GLINT_TILE_GROUPS]; ///< the triangle's slot, for each element of `group`
    int groups;
} R(cast_leaf);

/// Loads the corners of triangles. Lanes of other slots are unchanged.
static inline void R(load_node_corners)(const glint_geometry_table *geometry, const glint_node *node, unsigned mask,
                                        real to[3][3][GLINT_NODE_WIDTH])
{
    for (; mask; mask &= mask - 1) {
        const int slot = __builtin_ctz(mask);
        const double(*corner)[3] = geometry->corners[node->child[slot] & ~GLINT_NODE_PRIM];
        for (int j = 0; j < 9; j++)
            to[j / 3][j % 3][slot] = (real)corner[j / 3][j % 3];
    }
}

static inline void R(begin_leaf)(R(cast_leaf) * leaf)
{
    memset(leaf->corner, 0, sizeof leaf->corner);
    leaf->count = 0;
    leaf->faced = 0;
}

/// Loads the corners. Lanes without a triangle are unchanged.
static inline void R(load_leaf)(const glint_cast_args *args, unsigned mask, R(cast_leaf) * leaf)
{
    const glint_geometry_table *geometry = args->geometry;
    _Alignas(64) real seen[GLINT_NODE_WIDTH];
    R(load_node_corners)(geometry, leaf->node, mask, leaf->corner);
    leaf->faced = 0;
    for (unsigned bits = geometry->faces ? mask : 0; bits; bits &= bits - 1)
        leaf->faced |=
            geometry->prims[leaf->node->child[__builtin_ctz(bits)] & ~GLINT_NODE_PRIM].face ? bits & -bits : 0;
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++) {
            const vr eye = r_set(args->camera->eye[k]), scale = r_set(geometry->scale);
            for (int i = 0; i < GLINT_NODE_WIDTH; i += VR)
                r_store(seen + i, (r_load(leaf->corner[j][k] + i) - eye) * scale);
            R(narrow)(seen, leaf->shown.corner[j][k]);
        }
}

/// Computes the pixels of the tile in which each triangle may be visible; for a triangle seen edge-on, the pixels of
/// the triangle's box. Returns the slots of `mask` that may be visible in any pixel.
static unsigned R(pixels_of_leaf)(const R(tile_cast) * tile, const node_on_screen *seen, unsigned mask,
                                  R(cast_leaf) * leaf)
{
    const unsigned edge_on = mask & ~leaf->shown.certain;
    const float start[2] = { tile->s[0][0], -tile->t[0][0] };
    const int count[2] = { 4 * tile->across, 4 * tile->down };
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
        vi pixels = i_set(0);
        fm none = fm_from_bits(0);
        for (int n = 1; n >= 0; n--) {
            const vf low = (f_load(leaf->shown.least[n] + i) - f_set(start[n])) * f_set(0.5f),
                     high = (f_load(leaf->shown.most[n] + i) - f_set(start[n])) * f_set(0.5f);
            // rounded up and down; NaN selects all pixels
            const vi first =
                i_sub(i_set(64), i_from_f(f_set(64) - f_min(f_max(low, f_set(0)), f_set((float)count[n]))));
            const vi end = i_from_f(f_max(f_min(high, f_set((float)(count[n] - 1))), f_set(-1)) + f_set(1));
            none = fm_or(none, i_lt(end, i_add(first, i_set(1))));
            pixels = i_or(i_shl(pixels, 16), i_or(first, i_shl(i_and(i_sub(end, i_set(1)), i_set(255)), 8)));
        }
        i_store(leaf->pixels + i, pixels);
        mask &= ~(fm_bits(none) << i);
    }
    for (unsigned bits = edge_on; bits; bits &= bits - 1) {
        const int slot = __builtin_ctz(bits);
        leaf->pixels[slot] = 4 * seen->cells[slot] + 0x03000300; // from the first pixel of the first cell to the last
            // pixel of the last cell
    }
    return mask | edge_on;
}

/// Finds the cells in which a triangle may be visible, for pixels at any position; for a triangle seen edge-on, the
/// cells of the triangle's box. Returns false if there are none.
static inline bool R(cells_of_triangle)(const R(tile_cast) * tile, const R(cast_leaf) * leaf, const node_on_screen *seen, int slot,
                                        screen_cells *out)
{
    const screen_view *view = &tile->view;
    *out = seen->cells[slot];
    if (!(leaf->shown.certain >> slot & 1))
        return true;
    for (int n = 0; n < 2; n++) {
        const float least = leaf->shown.least[n][slot], most = leaf->shown.most[n][slot], end = (float)(view->count[n] - 1);
        if (most < view->first[n] || view->last[n] < least)
            return false;
        const uint32_t first = (uint32_t)smaller(larger((least - view->first[n]) * view->cells[n], 0), end);
        const float behind = (most - view->first[n]) * view->cells[n];
        const uint32_t last = (uint32_t)(behind < end ? larger(behind, 0) : end);
        *out = (*out & (n ? 0xffffu : 0xffff0000u)) | (first | last << 8) << 16 * n;
    }
    return true;
}

/// Computes the origin of the ray of a pair. own, a constant here and below: whether each ray has its own origin;
/// otherwise all rays start at the eye.
INNER void R(start_of_pair)(const R(tile_cast) * tile, const R(cast_leaf) * leaf, bool own, int n, real ray_origin[3])
{
    for (int k = 0; k < 3; k++)
        ray_origin[k] = own ? leaf->origin[k][n] : (real)tile->args->camera->eye[k];
}

/// Returns whether the ray of a pair starts in the plane of a triangle.
INNER bool R(begins_in_plane)(const R(tile_cast) * tile, const R(cast_leaf) * leaf, bool own, int n,
                              const glint_prim *prim)
{
    real ray_origin[3];
    R(start_of_pair)(tile, leaf, own, n, ray_origin);
    const R(flat) flat = R(flat_of)(prim, tile->args->geometry->scale);
    return R(is_in_plane)(&flat, ray_origin, false);
}

/// Decides again the pairs from number i on whose triangles share their planes with others. through: lanes whose rays
/// pass between the edges; hits: lanes that hit so far. Returns the lanes that hit.
INNER unsigned R(decide_faced)(const R(tile_cast) * tile, R(cast_leaf) * leaf, bool own, int i, unsigned through,
                               unsigned hits)
{
    const glint_geometry_table *table = tile->args->geometry;
    for (; through; through &= through - 1) {
        const unsigned lane = through & -through;
        const int n = i + __builtin_ctz(through);
        if (!(leaf->faced >> leaf->slot[n] & 1))
            continue;
        const glint_prim *prim = &table->prims[leaf->node->child[leaf->slot[n]] & ~GLINT_NODE_PRIM];
        real ray_origin[3];
        R(start_of_pair)(tile, leaf, own, n, ray_origin);
        const vr o[3] = { r_set(ray_origin[0]), r_set(ray_origin[1]), r_set(ray_origin[2]) };
        const vr d[3] = { r_set(leaf->direction[0][n]), r_set(leaf->direction[1][n]), r_set(leaf->direction[2][n]) };
        leaf->t[n] = R(first_lane)(R(face_t)(R(face_of)(table, prim), o, d));
        hits = 0 < leaf->t[n] ? hits | lane : hits & ~lane;
    }
    return hits;
}

/// Stores hits that are nearer than all previous hits. near: a hit up to this distance may be the start of a ray in the
/// triangle's plane, and then does not count.
INNER void R(update_pair)(R(tile_cast) * tile, const R(cast_leaf) * leaf, bool own, int n, real near, uint64_t *moved)
{
    const glint_cast_args *args = tile->args;
    const glint_prim *prims = args->geometry->prims;
    const uint32_t at = leaf->at[n], id = leaf->node->child[leaf->slot[n]] & ~GLINT_NODE_PRIM;
    const real t = leaf->t[n];
    real *best = (real *)args->t + at;
    uint32_t *best_id = args->prim + at;
    if (t <= near && !prims[id].face && R(begins_in_plane)(tile, leaf, own, n, &prims[id]))
        return;
    const bool tie = t == *best && t < (real)HUGE_VAL && *best_id != GLINT_MISS && prims[id].id < prims[*best_id].id;
    if (!(t < *best || tie))
        return;
    *best = t;
    *best_id = id;
    __builtin_prefetch(&prims[id]); // for the stage surface: so far only the corners have been read
    tile->depth[at / GLINT_GROUP][at % GLINT_GROUP] = (float)(t * (real)args->geometry->scale) * (1 + 0x1p-22f);
    *moved |= (uint64_t)1 << at / GLINT_GROUP;
}

/// Computes, for VR pairs, the corners of the triangle relative to the ray's origin, in units of the table.
INNER void R(corners_of_pairs)(const R(cast_leaf) * leaf, bool own, const double eye[3], int i, vr scale, vr p[3][3])
{
    for (int k = 0; k < 3; k++) {
        const vr from = own ? r_load(leaf->origin[k] + i) : r_set(eye[k]);
        for (int j = 0; j < 3; j++)
            p[j][k] = (r_pick(leaf->corner[j][k], leaf->slot + i) - from) * scale;
    }
}

INNER void R(decide_pairs_of)(R(tile_cast) * tile, R(cast_leaf) * leaf, bool own)
{
    const real scale = (real)tile->args->geometry->scale, near = R(near_shared_edge)(tile->args->geometry);
    uint64_t moved = 0;
    if (tile->args->tests)
        *tile->args->tests += (unsigned)leaf->count;
    for (int n = leaf->count; n % VR; n++) {
        leaf->slot[n] = leaf->slot[0];
        for (int k = 0; k < 3; k++) {
            leaf->direction[k][n] = leaf->direction[k][0];
            if (own)
                leaf->origin[k][n] = leaf->origin[k][0];
        }
    }
    for (int i = 0; i < leaf->count; i += VR) {
        vr p[3][3], d[3], t;
        R(corners_of_pairs)(leaf, own, tile->args->camera->eye, i, r_set(scale), p);
        for (int k = 0; k < 3; k++)
            d[k] = r_load(leaf->direction[k] + i);
        const unsigned there = leaf->count - i < VR ? (1u << (leaf->count - i)) - 1 : (1u << VR) - 1;
        const R(ray_edges) edges = R(make_ray_edges)(p, d, false);
        unsigned hits = rm_bits(R(intersect_edges)(&edges, p, d, d, r_set(scale), NULL, &t)) & there;
        r_store(leaf->t + i, t);
        if (leaf->faced)
            hits = R(decide_faced)(tile, leaf, own, i, rm_bits(R(passes)(&edges, p, d)) & there, hits);
        for (; hits; hits &= hits - 1)
            R(update_pair)(tile, leaf, own, i + __builtin_ctz(hits), near, &moved);
    }
    for (; moved; moved &= moved - 1) {
        const int g = __builtin_ctzll(moved);
        const float far = group_highest(tile->depth[g]);
        if (tile->pixels)
            R(note_cells)(tile, g, far);
        else
            tile->far[g / tile->across][g % tile->across] = far;
    }
    leaf->count = 0;
}

static void R(decide_pairs)(R(tile_cast) * tile, R(cast_leaf) * leaf) { R(decide_pairs_of)(tile, leaf, false); }
static void R(decide_own_pairs)(R(tile_cast) * tile, R(cast_leaf) * leaf) { R(decide_pairs_of)(tile, leaf, true); }

/// Pairs a triangle with lanes of group (x, y).
static inline void R(add_pairs)(R(tile_cast) * tile, R(cast_leaf) * leaf, int slot, int x, int y, unsigned lanes)
{
    const R(group_directions) directions = R(directions_of)(tile->args->camera, (uint32_t)x, (uint32_t)y);
    const uint32_t first = (uint32_t)(y * tile->across + x) * GLINT_GROUP;
    int n = leaf->count;
#ifdef GLINT_PACKS
    static const _Alignas(64) uint32_t lane_numbers[GLINT_GROUP] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15 };
    i_pack(leaf->at + n, i_add(i_load(lane_numbers), i_set(first)), lanes);
    i_store_any(leaf->slot + n, i_set((uint32_t)slot));
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned some = lanes >> i & ((1u << VR) - 1);
        for (int k = 0; k < 3; k++) {
            const size_t from = (size_t)(k * GLINT_GROUP + i);
            r_pack(leaf->direction[k] + n, r_load(directions.across + from) + r_load(directions.down + from), some);
        }
        n += __builtin_popcount(some);
    }
#else
    for (; lanes; lanes &= lanes - 1, n++) {
        const unsigned lane = (unsigned)__builtin_ctz(lanes);
        leaf->slot[n] = (uint32_t)slot;
        leaf->at[n] = first + lane;
        for (int k = 0; k < 3; k++)
            leaf->direction[k][n] = directions.across[k * GLINT_GROUP + lane] + directions.down[k * GLINT_GROUP + lane];
    }
#endif
    leaf->count = n;
    if (n > GLINT_PAIRS - GLINT_GROUP)
        R(decide_pairs)(tile, leaf);
}

/// Does the same for group g, whose rays have their own origins.
static inline void R(add_own_pairs)(R(tile_cast) * tile, R(cast_leaf) * leaf, int slot, uint32_t g, unsigned lanes)
{
    const glint_cast_args *args = tile->args;
    int n = leaf->count;
    for (; lanes; lanes &= lanes - 1, n++) {
        const uint32_t at = g * GLINT_GROUP + (uint32_t)__builtin_ctz(lanes);
        leaf->slot[n] = (uint32_t)slot;
        leaf->at[n] = at;
        for (int k = 0; k < 3; k++) {
            leaf->origin[k][n] = ((const real *)args->origin[k])[at];
            leaf->direction[k][n] = ((const real *)args->direction[k])[at];
        }
    }
    leaf->count = n;
    if (n > GLINT_PAIRS - GLINT_GROUP)
        R(decide_own_pairs)(tile, leaf);
}

/// Finds the groups of `bits` with rays that may hit the triangle in a slot, and these rays.
INNER void R(find_groups_of_triangle)(const R(tile_cast) * tile, const bool gathered, R(cast_leaf) * leaf, int slot,
                                      uint64_t bits)
{
    const float near = leaf->shown.near[slot];
    int n = leaf->groups;
    for (; bits; bits &= bits - 1) {
        const R(tile_group) at = R(lowest_group)(tile, gathered, bits);
        unsigned lanes = 0;
        for (int i = 0; i < GLINT_GROUP; i += VF)
            lanes |= (R(lanes_in_front)(tile, &at, i, near) &
                      between_edges(&leaf->shown, slot, f_load(at.s + i), -f_load(at.t + i)))
                     << i;
        leaf->slot_of_group[n] = (uint8_t)slot;
        n = R(note_near)(&at, lanes, leaf->group, n);
    }
    leaf->groups = n;
}

/// Returns the groups in which the triangle in a slot may be visible.
INNER uint64_t R(groups_of_triangle)(const R(tile_cast) * tile, const bool gathered, const R(cast_leaf) * leaf,
                                     const node_on_screen *seen, int slot)
{
    screen_cells cells = leaf->pixels[slot];
    if (!gathered)
        return R(groups_between)(first_column(cells) / 4, last_column(cells) / 4, first_row(cells) / 4, last_row(cells) / 4);
    return R(cells_of_triangle)(tile, leaf, seen, slot, &cells) ? R(groups_behind)(tile, true, cells, leaf->shown.near[slot]) : 0;
}

/// Casts the triangles in the slots of `mask`.
INNER void R(cast_triangles)(R(tile_cast) * tile, const bool gathered, R(cast_leaf) * leaf, const glint_node *node,
                             const node_on_screen *seen, unsigned mask)
{
    leaf->node = node;
    leaf->groups = 0;
    R(load_leaf)(tile->args, mask, leaf);
    show_leaf(&tile->view, seen, GLINT_REAL == 32, &leaf->shown);
    for (mask = gathered ? mask : R(pixels_of_leaf)(tile, seen, mask, leaf); mask; mask &= mask - 1) {
        const int slot = __builtin_ctz(mask);
        R(find_groups_of_triangle)(tile, gathered, leaf, slot, R(groups_of_triangle)(tile, gathered, leaf, seen, slot));
    }
    const bool parallel = !gathered && tile->parallel;
    for (int n = 0; n < leaf->groups; n++) {
        const R(near_group) group = leaf->group[n];
        if (parallel)
            R(add_own_pairs)(tile, leaf, leaf->slot_of_group[n], (uint32_t)(group.y * tile->across + group.x), group.lanes);
        else
            R(add_pairs)(tile, leaf, leaf->slot_of_group[n], group.x, group.y, group.lanes);
    }
    if (parallel)
        R(decide_own_pairs)(tile, leaf);
    else
        R(decide_pairs)(tile, leaf);
}

// ---- Rays that start on a lens ----

/// Loads the corners. Lanes without a triangle are unchanged.
static void R(load_lens_leaf)(const R(tile_cast) * tile, unsigned mask, R(cast_leaf) * leaf, leaf_through_lens *out)
{
    const glint_cast_args *args = tile->args;
    R(load_leaf)(args, mask, leaf);
    show_through_lens(&leaf->shown, &tile->view, &tile->lens->seen, GLINT_REAL == 32, out);
}

/// Finds the rays that may hit the triangle in a slot.
static void R(cast_lens_triangle)(R(tile_cast) * tile, R(cast_leaf) * leaf, const leaf_through_lens *shown,
                                  const node_on_screen *seen, int slot)
{
    const R(tile_lens) *lens = tile->lens;
    const screen_cells cells = seen->cells[slot];
    const float near = seen->near[slot];
    const unsigned columns = bit_range(first_column(cells), last_column(cells));
    for (int y = first_row(cells); y <= last_row(cells); y++)
        for (unsigned bits = behind_in_row((const float(*)[SCREEN_ACROSS])tile->far, y, near, columns); bits;
             bits &= bits - 1) {
            const int x = __builtin_ctz(bits);
            const uint32_t g = (uint32_t)(y * tile->across + x);
            unsigned lanes = 0;
            for (int i = 0; i < GLINT_GROUP; i += VF) {
                const unsigned open = fm_bits(f_le(f_set(near), f_load(tile->depth[g] + i)));
                if (open)
                    lanes |= (open & hits_through_lens(shown, slot, f_load(tile->s[x] + i), -f_load(tile->t[y] + i),
                                                       f_load(lens->across[0] + i), f_load(lens->across[1] + i)))
                             << i;
            }
            if (lanes)
                R(add_own_pairs)(tile, leaf, slot, g, lanes);
        }
}

/// Casts the triangles in the slots of `mask`, nearest first.
static void R(cast_lens_triangles)(R(tile_cast) * tile, R(cast_leaf) * leaf, const glint_node *node,
                                   const node_on_screen *seen, unsigned mask)
{
    leaf_through_lens shown;
    int order[GLINT_NODE_WIDTH];
    const int count = sort_slots(mask, seen->near, order);
    leaf->node = node;
    R(load_lens_leaf)(tile, mask, leaf, &shown);
    for (int i = 0; i < count; i++)
        R(cast_lens_triangle)(tile, leaf, &shown, seen, order[i]);
    R(decide_own_pairs)(tile, leaf);
}

#endif
