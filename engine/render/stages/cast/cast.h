// cast: the nearest hit of each ray from the eye. The whole tile traverses the index once, nearest boxes first. Each
// primitive that the traversal reaches is tested group by group. Contract: stages.h.
#ifndef GLINT_CAST_CAST_H
#define GLINT_CAST_CAST_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/leaf.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/slot.h"
#include "engine/render/stages/index/candidate.h"
#include "engine/render/stages/index/cover.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/view.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

/// Casts the only candidate of a group: rays that miss it hit nothing. sphere, a constant: it is a sphere.
INNER void R(cast_alone)(const R(tile_cast) * tile, const R(candidate) * candidate, const bool sphere, int x, int y,
                         unsigned near)
{
    const glint_cast_args *args = tile->args;
    const uint32_t g = (uint32_t)(y * tile->across + x);
    const size_t at = (size_t)g * GLINT_GROUP;
    const vr f[3] = { r_set(candidate->f[0]), r_set(candidate->f[1]), r_set(candidate->f[2]) };
    const R(group_directions) directions = R(directions_of)(args->camera, (uint32_t)x, (uint32_t)y);
    unsigned hits = 0;
    near &= args->active[g];
    count_tests(args->tests, near);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned lanes = near >> i & ((1u << VR) - 1);
        vr d[3], t = r_set(HUGE_VAL);
        rm hit = rm_from_bits(0);
        if (lanes) {
            R(load_direction)(directions, args->direction, 0, i, d);
            if (sphere)
                hit = R(intersect_ball)(f, d, DOT(d, d), r_set(candidate->c), r_set(candidate->r2),
                                        r_set(candidate->scale), &t);
            else
                hit = R(intersect_candidate)(args, candidate, f, d, &t);
            hit = rm_and(rm_from_bits(lanes), hit);
            hit = rm_and(hit, r_lt(t, r_set(HUGE_VAL)));
        }
        r_store((real *)args->t + at + i, r_select(hit, t, r_set(HUGE_VAL)));
        hits |= rm_bits(hit) << i;
    }
    for (int i = 0; i < GLINT_GROUP; i += VF)
        i_store(args->prim + at + i,
                f_bits(f_select(fm_from_bits(hits >> i & ((1u << VF) - 1)), f_from_bits(i_set(candidate->id)),
                                f_from_bits(i_set(GLINT_MISS)))));
    args->hits[g] = (uint16_t)hits;
}

/// Casts groups inside the image in which a sphere fills every pixel, so that no pixel needs its own test.
static void R(cast_filled)(const R(tile_cast) * tile, const R(candidate) * candidate, uint64_t groups)
{
    const glint_cast_args *args = tile->args;
    const vr f[3] = { r_set(-candidate->f[0]), r_set(-candidate->f[1]), r_set(-candidate->f[2]) };
    const vr c = r_set(candidate->c), r2 = r_set(candidate->r2), scale = r_set(candidate->scale);
    const bool distant = candidate->distant;
    if (args->tests)
        *args->tests += GLINT_GROUP * (unsigned)__builtin_popcountll(groups);
    for (; groups; groups &= groups - 1) {
        const int slot = __builtin_ctzll(groups), x = slot % COVER_ACROSS, y = slot / COVER_ACROSS;
        const uint32_t g = (uint32_t)(y * tile->across + x);
        const size_t at = (size_t)g * GLINT_GROUP;
        const R(group_directions) directions = R(directions_of)(args->camera, (uint32_t)x, (uint32_t)y);
        for (int i = 0; i < GLINT_GROUP; i += VR) {
            vr d[3];
            R(load_direction)(directions, args->direction, 0, i, d);
            const vr a = DOT(d, d), b = DOT(f, d);
            const vr disc = distant ? R(discriminant_afar)(f, d, a * r2) : R(discriminant)(f, d, a, b, c, r2);
            r_store((real *)args->t + at + i, c / ((b + r_sqrt(disc)) * scale));
        }
        lanes_put(args->prim + at, 0xffff, candidate->id);
        args->hits[g] = 0xffff;
    }
}

static inline void R(clear_groups)(R(tile_cast) * tile, uint64_t groups)
{
    for (; groups; groups &= groups - 1) {
        const int slot = __builtin_ctzll(groups), x = slot % COVER_ACROSS, y = slot / COVER_ACROSS;
        const uint32_t g = (uint32_t)(y * tile->across + x);
        if (tile->deep) {
            R(start_group)(tile->args, g);
            R(note_depth)(tile, x, y);
            continue;
        }
        for (int i = 0; i < GLINT_GROUP; i += VR)
            r_store((real *)tile->args->t + (size_t)g * GLINT_GROUP + i, r_set(HUGE_VAL));
        lanes_put(tile->args->prim + (size_t)g * GLINT_GROUP, 0xffff, GLINT_MISS);
        tile->args->hits[g] = 0;
    }
}

/// Casts a group whose pixels need their own tests, against the candidates that the group may show.
INNER void R(cast_mixed)(R(tile_cast) * tile, const R(candidate) *const *candidates, int count, const uint64_t may[],
                         const uint64_t sure[], int slot)
{
    const int x = slot % COVER_ACROSS, y = slot / COVER_ACROSS;
    const uint32_t g = (uint32_t)(y * tile->across + x);
    unsigned near[GLINT_FIRST_CANDIDATES];
    const R(candidate) * order[GLINT_FIRST_CANDIDATES];
    int found = 0;
    for (int k = 0; k < count; k++) {
        if (!(may[k] >> slot & 1))
            continue;
        near[found] = sure[k] >> slot & 1 ? 0xffff : R(near_pixels)(tile, candidates[k], x, y);
        order[found] = candidates[k];
        found += near[found] != 0;
    }
    if (found == 1 && !tile->deep && order[0]->prim->kind != GLINT_PRIM_COMBINED) {
        if (order[0]->prim->kind == GLINT_PRIM_SPHERE)
            R(cast_alone)(tile, order[0], true, x, y, near[0]);
        else
            R(cast_alone)(tile, order[0], false, x, y, near[0]);
        return;
    }
    R(start_group)(tile->args, g);
    for (int k = 0; k < found; k++)
        R(decide_pixels)(tile, order[k], x, y, near[k]);
    if (tile->deep)
        R(note_depth)(tile, x, y);
    else
        R(finish_group)(tile->args, g);
}

/// Returns a bit mask of the groups that have a ray; *whole: the groups with a ray in every lane.
static inline uint64_t R(live_groups)(const R(tile_cast) * tile, uint64_t *whole)
{
    uint64_t live = 0;
    *whole = 0;
    for (int y = 0; y < tile->down; y++) {
        const uint16_t *row = tile->args->active + y * tile->across;
        uint64_t halves[2] = { 0 };
        if (tile->across == COVER_ACROSS)
            memcpy(halves, row, sizeof halves);
        if ((halves[0] & halves[1]) == UINT64_MAX) {
            live |= (uint64_t)0xff << y * COVER_ACROSS;
            *whole |= (uint64_t)0xff << y * COVER_ACROSS;
            continue;
        }
        for (int x = 0; x < tile->across; x++) {
            live |= (uint64_t)(row[x] != 0) << (y * COVER_ACROSS + x);
            *whole |= (uint64_t)(row[x] == 0xffff) << (y * COVER_ACROSS + x);
        }
    }
    return live;
}

/// Casts the first candidates to every group.
static void R(cast_first)(R(tile_cast) * tile, const R(candidate) *const *candidates, int count, uint64_t may[])
{
    const uint64_t all = R(all_groups)(tile);
    uint64_t whole;
    const uint64_t live = R(live_groups)(tile, &whole);
    uint64_t sure[GLINT_FIRST_CANDIDATES], any = 0, several = 0, filled = 0;
    for (int k = 0; k < count && live != all; k++)
        may[k] &= live;
    R(cover_tile)(tile, candidates, count, may, sure);
    for (int k = 0; k < count; k++) {
        several |= any & may[k];
        any |= may[k];
    }
    const uint64_t alone = any & ~several & whole;
    for (int k = 0; k < count; k++) {
        const uint64_t fills = alone & may[k] & sure[k];
        if (!fills || candidates[k]->prim->kind != GLINT_PRIM_SPHERE)
            continue;
        R(cast_filled)(tile, candidates[k], fills);
        filled |= fills;
    }
    R(clear_groups)(tile, all & ~any);
    if (!tile->scaled && any & ~filled)
        R(scale_tile)(tile);
    for (uint64_t bits = any & ~filled; bits; bits &= bits - 1)
        R(cast_mixed)(tile, candidates, count, may, sure, __builtin_ctzll(bits));
    for (uint64_t bits = tile->deep ? filled : 0; bits; bits &= bits - 1) {
        const int slot = __builtin_ctzll(bits);
        R(note_depth)(tile, slot % COVER_ACROSS, slot / COVER_ACROSS);
    }
}

/// Opens the root: its primitives become candidates, and its nodes are pushed on the stack, the nearest last. Returns
/// the number of candidates. may: for each candidate, the groups in which its box may be visible.
static int R(open_root)(R(tile_cast) * tile, R(candidate) * candidates, uint64_t may[], screen_entry *stack,
                        int *height)
{
    const glint_node *root = tile->args->geometry->nodes;
    node_on_screen seen;
    int order[GLINT_NODE_WIDTH], found = 0;
    const int count = sort_slots(boxes_on_screen(root, &tile->view, &seen), seen.near, order);
    for (int i = 0; i < count; i++) {
        if (!(root->child[order[i]] & GLINT_NODE_PRIM))
            continue;
        const screen_cells cells = seen.cells[order[i]];
        may[found] = R(groups_between)(first_column(cells), last_column(cells), first_row(cells), last_row(cells));
        R(make_candidate)(tile, root->child[order[i]] & ~GLINT_NODE_PRIM, &candidates[found++]);
    }
    for (int i = count; i-- > 0;)
        if (!(root->child[order[i]] & GLINT_NODE_PRIM))
            stack[(*height)++] = entry_of(root, &seen, order[i]);
    return found;
}

/// Tests the groups against the primitives in the slots of `mask`.
INNER void R(cast_prims_as)(R(tile_cast) * tile, const bool gathered, R(cast_leaf) * leaf, const glint_node *node,
                            const node_on_screen *seen, unsigned mask)
{
    const unsigned triangles = triangles_in(tile->args->geometry, node, mask);
    int order[GLINT_NODE_WIDTH];
    const int count = sort_slots(mask & ~triangles, seen->near, order);
    for (int i = 0; i < count; i++)
        R(cast_slot)(tile, gathered, node, seen, order[i]);
    if (triangles && !gathered && GLINT_WITH(LENS) && tile->lens)
        R(cast_lens_triangles)(tile, leaf, node, seen, triangles);
    else if (triangles)
        R(cast_triangles)(tile, gathered, leaf, node, seen, triangles);
}

/// Does the same for pixels at any position.
static __attribute__((noinline)) void R(cast_prims_to_pixels)(R(tile_cast) * tile, R(cast_leaf) * leaf, const glint_node *node,
                                                              const node_on_screen *seen, unsigned mask)
{
    R(cast_prims_as)(tile, true, leaf, node, seen, mask);
}

static void R(cast_prims)(R(tile_cast) * tile, R(cast_leaf) * leaf, const glint_node *node, const node_on_screen *seen,
                          unsigned mask)
{
    if (tile->pixels)
        R(cast_prims_to_pixels)(tile, leaf, node, seen, mask);
    else
        R(cast_prims_as)(tile, false, leaf, node, seen, mask);
}

/// Traverses the index with the tile's rays. A node's primitives are tested only after the next node has been visited,
/// so that their memory can be prefetched in the meantime.
static void R(walk_tile)(R(tile_cast) * tile, screen_entry *stack, int height)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    const glint_node *waiting = NULL;
    unsigned waiting_prims = 0;
    int turn = 0;
    node_on_screen seen[2];
    R(cast_leaf) leaf;
    R(begin_leaf)(&leaf);
    if (!tile->scaled)
        R(scale_tile)(tile);
    for (; height > 0 && !is_stopped(tile->args->stop); turn = !turn) {
        const screen_entry top = stack[--height];
        const glint_node *node = &geometry->nodes[top.node];
        int order[GLINT_NODE_WIDTH];
        unsigned mask = 0, prims = 0;
        rows_behind behind;
        if (find_behind((const float(*)[SCREEN_ACROSS])tile->far, top, &behind)) {
            mask = GLINT_WITH(LENS) && tile->lens
                       ? boxes_through_lens(node, &tile->view, &tile->lens->seen, &seen[turn])
                       : boxes_on_screen(node, &tile->view, &seen[turn]);
            const unsigned all = prims_of_node(node);
            prims = slots_before(&behind, &seen[turn], mask & all);
            prefetch_prims(geometry, node, prims);
            for (int i = sort_slots(mask & ~all, seen[turn].near, order); i-- > 0;)
                stack[height++] = entry_of(node, &seen[turn], order[i]);
        }
        prefetch_nodes(geometry, stack, height);
        if (waiting_prims)
            R(cast_prims)(tile, &leaf, waiting, &seen[!turn], waiting_prims);
        waiting = node;
        waiting_prims = prims;
    }
    if (waiting_prims)
        R(cast_prims)(tile, &leaf, waiting, &seen[!turn], waiting_prims);
}

/// Makes candidates of at most `capacity` planes ahead of the camera, starting with plane number *next.
static int R(open_planes)(R(tile_cast) * tile, uint32_t *next, R(candidate) * candidates, int capacity)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    int found = 0;
    for (; *next < geometry->unbounded_count && found < capacity; ++*next) {
        const uint32_t id = geometry->unbounded[*next];
        if (!R(plane_ahead)(tile->args->camera, &tile->view, &geometry->prims[id]))
            continue;
        R(make_candidate)(tile, id, &candidates[found++]);
    }
    return found;
}

/// Casts in a scene with few primitives.
static void R(cast_few)(const glint_cast_args *args, const R(cast_view) * view)
{
    R(tile_cast) tile;
    const R(candidate) * list[GLINT_FIRST_CANDIDATES];
    uint64_t may[GLINT_FIRST_CANDIDATES];
    const int count = R(candidates_in)(view, args->camera, list, view->count);
    tile.args = args;
    tile.scaled = tile.deep = tile.parallel = false;
    tile.lens = NULL;
    tile.pixels = NULL;
    tile.rr = view->rr;
    tile.uu = view->uu;
    tile.spread = view->spread;
    tile.across = (int)args->camera->groups_across;
    tile.down = (int)(args->camera->group_count / args->camera->groups_across);
    for (int k = 0; k < count; k++)
        may[k] = R(all_groups)(&tile);
    R(cast_first)(&tile, list, count, may);
}

/// Casts in a scene with many primitives.
static void R(cast_many)(const glint_cast_args *args)
{
    const glint_geometry_table *geometry = args->geometry;
    R(tile_cast) tile;
    R(candidate) candidates[GLINT_FIRST_CANDIDATES];
    const R(candidate) * list[GLINT_FIRST_CANDIDATES];
    uint64_t may[GLINT_FIRST_CANDIDATES];
    screen_entry stack[WALK_STACK];
    int height = 0, count = 0;
    uint32_t planes = 0;
    R(begin_tile)(args, &tile);
    if (geometry->nodes)
        count = R(open_root)(&tile, candidates, may, stack, &height);
    const int rooted = count;
    count += R(open_planes)(&tile, &planes, candidates + count, GLINT_FIRST_CANDIDATES - count);
    for (int k = 0; k < count; k++) {
        R(make_cover)(&tile, &candidates[k]);
        list[k] = &candidates[k];
        if (k >= rooted)
            may[k] = R(all_groups)(&tile);
    }
    tile.deep = height > 0 || planes < geometry->unbounded_count;
    R(cast_first)(&tile, list, count, may);
    if (!tile.deep)
        return;
    while ((count = R(open_planes)(&tile, &planes, candidates, GLINT_FIRST_CANDIDATES)) > 0)
        R(cast_candidates)(&tile, candidates, count);
    R(walk_tile)(&tile, stack, height);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(finish_group)(args, g);
}

#endif
