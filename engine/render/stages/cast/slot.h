// slot: tests a primitive in a slot of a node, except a triangle, against the groups of a tile in which the primitive
// may be visible. Contract: stages.h, cast.
#ifndef GLINT_CAST_SLOT_H
#define GLINT_CAST_SLOT_H

#include "engine/render/stages/cast/groups.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/rays.h"
#include "engine/render/stages/index/candidate.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

/// Finds the groups with rays that come near the primitive. Returns the number of these groups. rods, a constant:
/// whether the primitive may be longer than wide.
INNER int R(find_near_groups)(const R(tile_cast) * tile, const bool gathered, const glint_node *node,
                              const node_on_screen *seen, int slot, const bool rods, R(near_group) * out)
{
    const float depth = seen->near[slot];
    const uint32_t id = node->child[slot] & ~GLINT_NODE_PRIM;
    uint64_t groups = R(groups_behind)(tile, gathered, seen->cells[slot], depth);
    int count = 0;
    if (!groups)
        return 0;
    const shape_on_screen shape = shape_of(node, seen, slot, &tile->args->geometry->prims[id], &tile->view);
    rod_on_screen rod = { .is = false };
    if (rods)
        see_rod(tile->args->geometry, &tile->args->geometry->prims[id], &tile->view, &rod);
    for (; groups; groups &= groups - 1) {
        const R(tile_group) at = R(lowest_group)(tile, gathered, groups);
        unsigned lanes = 0;
        if (!gathered && GLINT_WITH(LENS) && tile->lens)
            lanes = R(lanes_through_lens)(tile, &shape, seen->middle[2][slot], depth, at.x, at.y);
        else
            for (int i = 0; i < GLINT_GROUP; i += VF) {
                const vf s = f_load(at.s + i), t = f_load(at.t + i);
                unsigned near = R(lanes_in_front)(tile, &at, i, depth) & near_shape(&shape, s, -t);
                if (rod.is)
                    near &= near_rod(&rod, s, -t);
                lanes |= near << i;
            }
        count = R(note_near)(&at, lanes, out, count);
    }
    return count;
}

// ---- A sphere ----

/// VR lanes of a group, some of whose rays come near a sphere.
typedef struct R(near_part) {
    uint16_t at; ///< number of the first lane in the tile
    uint16_t across, down; ///< offsets of the two summands of the directions, see group_directions
} R(near_part);

/// Lists the vectors of the groups in which any lane is near. Returns the number of vectors.
INNER int R(find_near_parts)(const R(tile_cast) * tile, const R(near_group) * groups, int count, R(near_part) * out)
{
    int parts = 0;
    for (int n = 0; n < count; n++)
        for (int i = 0; i < GLINT_GROUP; i += VR) {
            const int x = groups[n].x, y = groups[n].y, g = y * tile->across + x;
            out[parts] = (R(near_part)) { (uint16_t)(g * GLINT_GROUP + i), (uint16_t)(x * 3 * GLINT_GROUP + i),
                                          (uint16_t)(y * 3 * GLINT_GROUP + i) };
            parts += (groups[n].lanes >> i & ((1u << VR) - 1)) != 0;
        }
    return parts;
}

/// Decides the sphere for rays from the eye.
INNER void R(decide_ball_of_eye)(const glint_cast_args *args, uint32_t id, const R(near_part) * parts, int count)
{
    R(candidate) ball;
    R(place_candidate)(args, id, &ball);
    const vr f[3] = { r_set(ball.f[0]), r_set(ball.f[1]), r_set(ball.f[2]) };
    const vr c = r_set(ball.c), r2 = r_set(ball.r2), scale = r_set(ball.scale);
    for (int n = 0; n < count; n++) {
        const real *across = (const real *)args->camera->across + parts[n].across;
        const real *down = (const real *)args->camera->down + parts[n].down;
        vr d[3], t;
        for (int k = 0; k < 3; k++)
            d[k] = r_load(across + k * GLINT_GROUP) + r_load(down + k * GLINT_GROUP);
        const rm hit = R(intersect_ball)(f, d, DOT(d, d), c, r2, scale, &t);
        R(update_nearest)(args, parts[n].at, id, hit, t);
    }
}

/// Decides the sphere for parallel rays.
INNER void R(decide_ball_of_parallels)(const glint_cast_args *args, uint32_t id, const R(near_part) * parts, int count)
{
    const glint_prim *prim = &args->geometry->prims[id];
    const R(ball) ball = R(ball_of)(prim);
    vr center[3], d[3];
    for (int k = 0; k < 3; k++) {
        center[k] = r_set(prim->center[k]);
        d[k] = r_set(args->camera->forward[k]);
    }
    const vr a = DOT(d, d);
    for (int n = 0; n < count; n++) {
        const size_t at = parts[n].at;
        vr f[3], t;
        for (int k = 0; k < 3; k++)
            f[k] = (r_load((const real *)args->origin[k] + at) - center[k]) * ball.scale;
        const vr c = R(exact_power)(f, ball.r2, ball.r2_low);
        const rm hit = R(intersect_ball)(f, d, a, c, ball.r2, ball.scale, &t);
        R(update_nearest)(args, at, id, hit, t);
    }
}

/// Casts a sphere, for rays that do not start on a lens.
INNER void R(cast_ball)(R(tile_cast) * tile, const bool gathered, const glint_node *node, const node_on_screen *seen,
                        int slot)
{
    const uint32_t id = node->child[slot] & ~GLINT_NODE_PRIM;
    R(near_group) groups[GLINT_TILE_GROUPS];
    R(near_part) parts[GLINT_TILE_SAMPLES / VR];
    const int count = R(find_near_groups)(tile, gathered, node, seen, slot, false, groups);
    if (!count)
        return;
    const int part_count = R(find_near_parts)(tile, groups, count, parts);
    if (!gathered && tile->parallel)
        R(decide_ball_of_parallels)(tile->args, id, parts, part_count);
    else
        R(decide_ball_of_eye)(tile->args, id, parts, part_count);
    for (int n = 0; n < count; n++) {
        count_tests(tile->args->tests, groups[n].lanes);
        R(note_group)(tile, gathered, groups[n]);
    }
}

// ---- Other primitives, and spheres through a lens ----

/// Casts any primitive except a triangle.
INNER void R(cast_other)(R(tile_cast) * tile, const bool gathered, const glint_node *node, const node_on_screen *seen,
                         int slot)
{
    const uint32_t id = node->child[slot] & ~GLINT_NODE_PRIM;
    R(near_group) groups[GLINT_TILE_GROUPS];
    R(candidate) candidate;
    const int count = R(find_near_groups)(tile, gathered, node, seen, slot, GLINT_REAL == 64, groups);
    if (!count)
        return;
    if (gathered || !tile->parallel)
        R(place_candidate)(tile->args, id, &candidate);
    for (int n = 0; n < count; n++) {
        const int x = groups[n].x, y = groups[n].y;
        if (!gathered && tile->parallel
                ? R(decide_rays)(tile->args, (uint32_t)(y * tile->across + x), id, groups[n].lanes)
                : R(decide_pixels)(tile, &candidate, x, y, groups[n].lanes))
            R(note_group)(tile, gathered, groups[n]);
    }
}

/// Casts the primitive in the slot.
INNER void R(cast_slot)(R(tile_cast) * tile, const bool gathered, const glint_node *node, const node_on_screen *seen,
                        int slot)
{
    const uint32_t kind = tile->args->geometry->prims[node->child[slot] & ~GLINT_NODE_PRIM].kind;
    if (kind == GLINT_PRIM_SPHERE && (gathered || !tile->lens))
        R(cast_ball)(tile, gathered, node, seen, slot);
    else
        R(cast_other)(tile, gathered, node, seen, slot);
}

#endif
