// rounds: traverses incoherent rays in scenes with triangles and solids. The rays of a group traverse the index in
// rounds, one node each per round. The triangles that they reach are decided in double, a vector of pairs of ray and
// triangle at a time, with a different pair in each lane. Pairs to which the rules of shared edges may apply are left
// to decide_rays. A solid is decided for all rays that reach it in the same round. Spheres are decided after the
// traversal (nearest.h). Contract: stages.h, cast.
#ifndef GLINT_CAST_ROUNDS_H
#define GLINT_CAST_ROUNDS_H

#include "engine/render/stages/cast/face.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/nearest.h"
#include "engine/render/stages/cast/rays.h"
#include "engine/render/stages/cast/shared_edge.h"
#include "engine/render/stages/cast/solid.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

#define GLINT_ROUND_PAIRS 96 ///< maximum number of pairs per round, a multiple of any VR
#define GLINT_ROUND_SOLIDS 64 ///< maximum number of solids per round
#define GLINT_STACKED_NODES_MAX 48 ///< maximum number of nodes that a group leaves to each of its rays, see together.h

/// The rays of a group in triangle space: their components are in the cyclic order that puts the direction's largest
/// component last, see edges_along. Then the same operations work for every lane, and give the same bits as in the
/// lane's original order.
typedef struct R(permuted_rays) {
    _Alignas(64) real origin[3][GLINT_GROUP], direction[3][GLINT_GROUP];
    uint8_t axis[GLINT_GROUP]; ///< the axis of the world that became the last component
} R(permuted_rays);

/// The nodes that a ray has yet to visit, and the distances at which the ray enters them.
typedef struct R(node_stack) {
    int height;
    // A packed store writes a whole vector: both arrays have space for its undefined entries above the top.
    uint32_t node[WALK_STACK + GLINT_NODE_WIDTH + GLINT_STACKED_NODES_MAX];
    float depth[WALK_STACK + GLINT_NODE_WIDTH + GLINT_STACKED_NODES_MAX];
} R(node_stack);

typedef struct R(rounds) {
    R(permuted_rays) permuted;
    _Alignas(64) uint32_t lane[GLINT_ROUND_PAIRS], prim[GLINT_ROUND_PAIRS]; ///< the pairs
    _Alignas(64) real corner[3][3][GLINT_ROUND_PAIRS]; ///< the corners of the triangles, permuted like the rays
    int count;
    uint32_t solid[GLINT_ROUND_SOLIDS]; ///< primitives other than triangles and spheres
    uint32_t rays[GLINT_ROUND_SOLIDS]; ///< rays that reached each solid, one bit per lane
    int solids;
    R(first_balls) first;
    R(lone_ray) ray[GLINT_GROUP];
    R(node_stack) stack[GLINT_GROUP];
} R(rounds);

/// Permutes the axes of the rays of `lanes`; other lanes are unchanged.
static inline void R(permute_rays)(const glint_cast_args *args, size_t at, unsigned lanes, R(permuted_rays) * out)
{
    for (; lanes; lanes &= lanes - 1) {
        const int lane = __builtin_ctz(lanes);
        real o[3], d[3];
        for (int k = 0; k < 3; k++) {
            o[k] = ((const real *)args->origin[k])[at + (size_t)lane];
            d[k] = ((const real *)args->direction[k])[at + (size_t)lane];
        }
        const real ax = R(size_of)(d[0]), ay = R(size_of)(d[1]), az = R(size_of)(d[2]);
        const int z = (ax < ay ? ay : ax) < az ? 2 : ax < ay ? 1 : 0;
        out->axis[lane] = (uint8_t)z;
        for (int k = 0; k < 3; k++) {
            out->origin[k][lane] = o[(z + 1 + k) % 3];
            out->direction[k][lane] = d[(z + 1 + k) % 3];
        }
    }
}

/// Loads the corners of all pairs. The last vector is filled up with pairs whose results are not read.
static inline void R(load_round)(const glint_geometry_table *geometry, R(rounds) * rounds)
{
    for (int n = 0; n < rounds->count; n++) {
        const double(*corner)[3] = geometry->corners[rounds->prim[n]];
        const int z = rounds->permuted.axis[rounds->lane[n]], x = z < 2 ? z + 1 : 0, y = 3 - z - x;
        for (int j = 0; j < 3; j++) {
            rounds->corner[j][0][n] = (real)corner[j][x];
            rounds->corner[j][1][n] = (real)corner[j][y];
            rounds->corner[j][2][n] = (real)corner[j][z];
        }
    }
    for (int n = rounds->count; n % VR; n++) {
        rounds->lane[n] = rounds->lane[0];
        for (int j = 0; j < 9; j++)
            rounds->corner[j / 3][j % 3][n] = 0;
    }
}

/// Returns the lanes whose rays certainly start off the triangle's plane. The error bound is the same as in
/// intersect_shared_edge: twice the rounding error of a height, which also covers the different order of terms here.
static inline unsigned R(begins_off_plane)(const glint_geometry_table *table, vr corner[3][3], const vr o[3])
{
    const vr scale = r_set(table->scale), far = r_set((real)(2 * GLINT_POINT_SLACK * table->extent));
    vr f[3], g[3], h = r_set(0), spread = h, size = h;
    for (int k = 0; k < 3; k++) {
        f[k] = (corner[1][k] - corner[0][k]) * scale;
        g[k] = (corner[2][k] - corner[0][k]) * scale;
    }
    for (int k = 0; k < 3; k++) {
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        const vr a = f[x] * g[y], b = f[y] * g[x], m = a - b;
        h = h + m * (o[k] - corner[0][k]);
        spread = spread + R(abs)(m);
        size = size + (R(abs)(a) + R(abs)(b));
    }
    return rm_bits(r_lt(far * (r_set(5) * spread + r_set(2) * size), R(abs)(h)));
}

/// The results of VR pairs of ray and triangle, one bit each.
typedef struct R(round_lanes) {
    _Alignas(64) real t[VR]; ///< t where each ray hits the plane of the triangle's corners
    unsigned at; ///< lanes whose line passes through the triangle, within the error of the ray's origin; other lanes
        ///< miss the triangle
    unsigned plain; ///< lanes of `at` that certainly pass through the triangle and certainly start off its plane
    unsigned off; ///< all lanes whose ray certainly starts off the plane
} R(round_lanes);

/// Tests the pairs from number i on.
INNER void R(intersect_round)(const glint_geometry_table *table, const R(rounds) * rounds, int i, R(round_lanes) * out)
{
    const R(permuted_rays) *permuted = &rounds->permuted;
    const vr scale = r_set(table->scale), zero = r_set(0);
    vr corner[3][3], p[3][3], o[3], d[3];
    for (int k = 0; k < 3; k++) {
        o[k] = r_pick(permuted->origin[k], rounds->lane + i);
        d[k] = r_pick(permuted->direction[k], rounds->lane + i);
        for (int j = 0; j < 3; j++) {
            corner[j][k] = r_load(rounds->corner[j][k] + i);
            p[j][k] = (corner[j][k] - o[k]) * scale;
        }
    }
    const R(ray_edges) edges = R(edges_along)(p, d, 2, true);
    out->at = R(at_triangle)(table, &edges);
    if (!out->at)
        return;
    const vr *e = edges.e, t = edges.depth / ((R(det)(&edges) * edges.dz) * scale);
    const rm sure = rm_or(r_lt(zero, r_min(r_min(e[0], e[1]), e[2])), r_lt(r_max(r_max(e[0], e[1]), e[2]), zero));
    out->off = R(begins_off_plane)(table, corner, o);
    out->plain = out->at & out->off & rm_bits(sure);
    if (!table->faces) // hits behind the origin are misses
        out->at &= rm_bits(r_lt(zero, t)) | ~out->off;
    r_store(out->t, t);
}

/// Returns t where a ray hits the plane that a triangle shares with others.
static inline real R(t_of_face)(const glint_cast_args *args, const glint_face *face, size_t ray)
{
    vr o[3], d[3];
    for (int k = 0; k < 3; k++) {
        o[k] = r_set(((const real *)args->origin[k])[ray]);
        d[k] = r_set(((const real *)args->direction[k])[ray]);
    }
    return R(first_lane)(R(face_t)(face, o, d));
}

/// Decides the pairs, and lowers the upper bounds of hits. If a ray certainly starts off the triangle's plane, and the
/// hit is not close, the hit is final: the ray starts neither on this triangle nor on another one at a shared edge.
/// Other pairs are left to decide_rays.
static __attribute__((noinline)) void R(decide_triangles)(const glint_cast_args *args, uint32_t g, R(rounds) * rounds)
{
    const glint_geometry_table *table = args->geometry;
    const real near = R(near_shared_edge)(table);
    R(round_lanes) lanes;
    R(load_round)(table, rounds);
    if (args->tests)
        *args->tests += (unsigned)rounds->count;
    for (int i = 0; i < rounds->count; i += VR) {
        const unsigned there = rounds->count - i < VR ? (1u << (rounds->count - i)) - 1 : (1u << VR) - 1;
        R(intersect_round)(table, rounds, i, &lanes);
        for (unsigned bits = lanes.at & there; bits; bits &= bits - 1) {
            const int j = __builtin_ctz(bits);
            const uint32_t lane = rounds->lane[i + j], id = rounds->prim[i + j], ray = g * GLINT_GROUP + lane;
            const glint_face *face = table->faces ? R(face_of)(table, &table->prims[id]) : NULL;
            const real t = face ? R(t_of_face)(args, face, ray) : lanes.t[j];
            if (lanes.off >> j & 1 && !(0 < t))
                continue;
            if (lanes.plain >> j & 1 && near < t)
                R(update_ray)(args, ray, id, t);
            else
                R(decide_rays)(args, g, id, 1u << lane);
            R(limit_distance)(&rounds->first, (int)lane, R(reach_in_index)(args, ((const real *)args->t)[ray]));
        }
    }
    rounds->count = 0;
}

/// Decides the solids.
static __attribute__((noinline)) void R(decide_solids)(const glint_cast_args *args, uint32_t g,
                                                       const R(ray_group) * rays, R(rounds) * rounds)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    unsigned nearer = 0;
    for (int n = 0; n < rounds->solids; n++) {
        const uint32_t id = rounds->solid[n];
        const unsigned near = R(near_rays)(rays, &args->geometry->prims[id]) & rounds->rays[n];
        if (near && R(decide_rays)(args, g, id, near))
            nearer |= near;
    }
    for (; nearer; nearer &= nearer - 1) {
        const int lane = __builtin_ctz(nearer);
        R(limit_distance)(&rounds->first, lane, R(reach_in_index)(args, ((const real *)args->t)[at + (size_t)lane]));
    }
    rounds->solids = 0;
}

/// Records that a ray reached a solid. The caller checks that there is space.
static inline void R(add_solid)(R(rounds) * rounds, uint32_t id, int lane)
{
    int n = 0;
    while (n < rounds->solids && rounds->solid[n] != id)
        n++;
    if (n == rounds->solids) {
        rounds->solids++;
        rounds->solid[n] = id;
        rounds->rays[n] = 0;
    }
    rounds->rays[n] |= 1u << lane;
}

/// Tests the primitives other than triangles in the slots of `mask`. Spheres are recorded, see pair_first.
static inline void R(intersect_others)(const glint_geometry_table *geometry, const glint_node *node, unsigned mask,
                                       int lane, R(rounds) * rounds)
{
    unsigned spheres = 0;
    for (unsigned bits = mask; bits; bits &= bits - 1) {
        const uint32_t id = node->child[__builtin_ctz(bits)] & ~GLINT_NODE_PRIM;
        if (geometry->prims[id].kind == GLINT_PRIM_SPHERE)
            spheres |= bits & -bits;
        else
            R(add_solid)(rounds, id, lane);
    }
    if (spheres)
        R(note_balls)(node, spheres, &rounds->ray[lane], lane, &rounds->first);
}

/// Pairs a ray with the triangles of a node in the slots of `mask`. Returns the slots of other primitives.
static inline unsigned R(add_to_round)(const glint_geometry_table *geometry, const glint_node *node, unsigned mask,
                                       int lane, R(rounds) * rounds)
{
    const uint32_t leaving = rounds->ray[lane].leaving; // skipped here, because cast_on_own tests the primitive that
        // the ray leaves
    unsigned others = 0;
    int n = rounds->count;
#ifdef GLINT_PACKS
    const vi id = i_and(i_load(node->child), i_set(~GLINT_NODE_PRIM));
    const unsigned triangles = mask & fm_bits(i_lt(id, i_set(geometry->triangles)));
    const unsigned hits = triangles & ~fm_bits(i_eq(id, i_set(leaving)));
    i_pack(rounds->prim + n, id, hits);
    i_store_any(rounds->lane + n, i_set((uint32_t)lane));
    n += __builtin_popcount(hits);
    others = mask & ~triangles;
#else
    for (; mask; mask &= mask - 1) {
        const uint32_t id = node->child[__builtin_ctz(mask)] & ~GLINT_NODE_PRIM;
        if (id >= geometry->triangles) {
            others |= mask & -mask;
        } else if (id != leaving) {
            rounds->lane[n] = (uint32_t)lane;
            rounds->prim[n++] = id;
        }
    }
#endif
    rounds->count = n;
    return others;
}

/// Pushes the nodes in the slots of `mask` on a ray's stack, the nearest on top.
static inline void R(push_nodes)(const glint_node *node, const float depth[GLINT_NODE_WIDTH], unsigned mask,
                                 R(node_stack) * stack)
{
    int n = stack->height;
#ifdef GLINT_PACKS
    // no branch is needed if there is no node, because entries above the top are never read
    const vf own = f_select(fm_from_bits(mask), f_load(depth), f_set(HUGE_VALF));
    const float nearest = f_min_all(own);
    const unsigned first = mask & fm_bits(f_eq(own, f_set(nearest))), top = first & -first;
    const int end = n + __builtin_popcount(mask), at = end - (mask != 0);
    f_pack(stack->depth + n, own, mask & ~top);
    i_pack(stack->node + n, i_load(node->child), mask & ~top);
    stack->depth[at] = nearest;
    stack->node[at] = node->child[__builtin_ctz(first | 0x8000)];
    n = end;
#else
    int order[GLINT_NODE_WIDTH];
    for (int i = sort_slots(mask, depth, order); i-- > 0; n++) {
        stack->depth[n] = depth[order[i]];
        stack->node[n] = node->child[order[i]];
    }
#endif
    stack->height = n;
}

/// Advances one ray to its next node. Returns whether there was one.
static inline bool R(step)(const glint_cast_args *args, int lane, R(rounds) * rounds)
{
    const float far = rounds->first.far[lane];
    R(node_stack) *stack = &rounds->stack[lane];
    _Alignas(64) float depth[GLINT_NODE_WIDTH];
    do {
        if (!stack->height)
            return false;
        stack->height--;
    } while (far < stack->depth[stack->height]);
    const glint_node *node = &args->geometry->nodes[stack->node[stack->height]];
    const unsigned mask = R(boxes_of_lone_ray)(node, &rounds->ray[lane], far, depth),
                   prims = mask & prims_of_node(node);
    if (prims) {
        const unsigned others = R(add_to_round)(args->geometry, node, prims, lane, rounds);
        if (others)
            R(intersect_others)(args->geometry, node, others, lane, rounds);
    }
    if (mask & ~prims)
        R(push_nodes)(node, depth, mask & ~prims, stack);
    return true;
}

/// Traverses the index with the rays in `lanes`, from the nodes of their stacks.
static __attribute__((noinline)) void R(walk_in_rounds)(const glint_cast_args *args, uint32_t g,
                                                        const R(ray_group) * rays, unsigned lanes, R(rounds) * rounds)
{
    for (unsigned going = lanes; going;) {
        for (unsigned bits = going; bits; bits &= bits - 1) {
            if (!R(step)(args, __builtin_ctz(bits), rounds))
                going &= ~(bits & -bits);
            if (rounds->count > GLINT_ROUND_PAIRS - GLINT_NODE_WIDTH)
                R(decide_triangles)(args, g, rounds);
            if (rounds->solids > GLINT_ROUND_SOLIDS - GLINT_NODE_WIDTH)
                R(decide_solids)(args, g, rays, rounds);
        }
        if (rounds->count >= VR || !going)
            R(decide_triangles)(args, g, rounds);
        if (rounds->solids)
            R(decide_solids)(args, g, rays, rounds);
    }
}

#endif
