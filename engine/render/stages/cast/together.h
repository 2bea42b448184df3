// together: traverses the index with a whole group of rays while they stay coherent, for example after reflection in
// a flat mirror, or from a small part of a lens. Each node is tested twice: first against the bounds of the whole
// group, then each surviving child against every ray. The rays visit a node one by one (rounds.h) if few rays reach
// it, or if more children than rays survive the tests. Contract: stages.h, cast.
#ifndef GLINT_CAST_TOGETHER_H
#define GLINT_CAST_TOGETHER_H

#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/nearest.h"
#include "engine/render/stages/cast/rays.h"
#include "engine/render/stages/cast/rounds.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

#define GLINT_FEW_LANES 3 ///< if a node has at most this number of rays, each ray traverses it on its own

/// Bounds, over all rays of a group, of the values that boxes_of_lone_ray computes. An axis along which the rays have
/// both signs of direction has no bound.
typedef struct R(common_slabs) {
    float enter[3], leave[3]; ///< bounds of the origins, subtracted from the box sides by which rays enter and leave
    float gentle[3], steep[3]; ///< inverse directions with the smallest and the largest size; steep may be infinite
    int first[3], last[3]; ///< offsets in a node, in floats, of the sides by which rays enter and leave
} R(common_slabs);

/// A node that rays of a group have yet to visit.
typedef struct R(common_node) {
    _Alignas(64) float depth[GLINT_GROUP]; ///< distance at which each ray enters the node
    uint32_t node;
    unsigned lanes;
} R(common_node);

/// The rays of a group during traversal.
typedef struct R(common_walk) {
    _Alignas(64) float enter[3][GLINT_GROUP], leave[3][GLINT_GROUP]; ///< as in R(lone_ray)
    const R(ray_group) * rays;
    const R(lone_rays) * lone;
    unsigned back[3]; ///< the rays with a negative direction along each axis
    const uint32_t *leaving; ///< NULL: no ray starts on a primitive
    R(common_slabs) slabs;
    int height;
    R(common_node) stack[WALK_STACK];
} R(common_walk);

// ---- Bounds of the group ----

/// Computes the minimum and maximum of the numbers in `lanes`, of which there is at least one.
static inline void R(range_in)(const float x[GLINT_GROUP], unsigned lanes, float *least, float *most)
{
    vf low = f_set(HUGE_VALF), high = f_set(-HUGE_VALF);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm there = fm_from_bits(lanes >> i);
        low = f_min(f_select(there, f_load(x + i), low), low);
        high = f_max(f_select(there, f_load(x + i), high), high);
    }
    *least = f_min_all(low);
    *most = f_max_all(high);
}

static inline void R(find_common_slabs)(const R(common_walk) * walk, unsigned lanes, R(common_slabs) * slabs)
{
    for (int k = 0; k < 3; k++) {
        const unsigned back = walk->back[k] & lanes;
        slabs->first[k] = (back ? k + 3 : k) * GLINT_NODE_WIDTH;
        slabs->last[k] = (back ? k : k + 3) * GLINT_NODE_WIDTH;
        slabs->enter[k] = HUGE_VALF;
        slabs->leave[k] = -HUGE_VALF;
        slabs->gentle[k] = slabs->steep[k] = 1;
        if (back && back != lanes) {
            slabs->first[k] = k * GLINT_NODE_WIDTH;
            slabs->last[k] = (k + 3) * GLINT_NODE_WIDTH;
            continue;
        }
        float low, high;
        R(range_in)(walk->lone->inverse[k], lanes, &low, &high);
        slabs->gentle[k] = back ? high : low;
        slabs->steep[k] = back ? low : high;
        R(range_in)(walk->enter[k], lanes, &low, &high);
        slabs->enter[k] = back ? low : high;
        R(range_in)(walk->leave[k], lanes, &low, &high);
        slabs->leave[k] = back ? high : low;
    }
}

/// Returns the boxes that some ray may enter before `far`; depth: lower bound of the entry over all rays. Rounding is
/// monotonic, so each rounded product is a bound of the rounded products of all rays.
static inline unsigned R(boxes_in_slabs)(const glint_node *node, const R(common_slabs) * slabs, float far,
                                         float depth[GLINT_NODE_WIDTH])
{
    unsigned inside = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
        vf enter = f_set(0), leave = f_set(far);
        for (int k = 0; k < 3; k++) {
            const float *first = (const float *)node + slabs->first[k], *last = (const float *)node + slabs->last[k];
            const vf gentle = f_set(slabs->gentle[k]), steep = f_set(slabs->steep[k]);
            const vf x = f_load(first + i) - f_set(slabs->enter[k]), y = f_load(last + i) - f_set(slabs->leave[k]);
            enter = f_max(f_min(x * gentle, x * steep), enter); // a NaN (0 times inf) keeps the previous value
            leave = f_min(f_max(y * gentle, y * steep), leave);
        }
        f_store(depth + i, enter);
        inside |= fm_bits(f_le(enter, leave * f_set(1 + WALK_SLACK))) << i;
    }
    return inside;
}

// ---- Single rays of the group ----

/// Returns the rays that may enter the box in a slot of a node before their `far`, and computes the distances of
/// entry, like boxes_of_lone_ray.
static inline unsigned R(rays_in_slot)(const glint_node *node, int slot, const R(common_walk) * walk,
                                       const R(first_balls) * first, float depth[GLINT_GROUP])
{
    unsigned inside = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf enter = f_set(0), leave = f_load(first->far + i);
        for (int k = 0; k < 3; k++) {
            const fm back = fm_from_bits(walk->back[k] >> i);
            const vf lower = f_set(node->lower[k][slot]), upper = f_set(node->upper[k][slot]);
            const vf inverse = f_load(walk->lone->inverse[k] + i);
            enter = f_max((f_select(back, upper, lower) - f_load(walk->enter[k] + i)) * inverse, enter);
            leave = f_min((f_select(back, lower, upper) - f_load(walk->leave[k] + i)) * inverse, leave);
        }
        f_store(depth + i, enter);
        inside |= fm_bits(f_le(enter, leave * f_set(1 + WALK_SLACK))) << i;
    }
    return inside;
}

/// Records the sphere in a slot of a node for the rays of `lanes` that may enter it or start inside of it, like
/// intersect_balls and note_ball.
static inline void R(note_ball_of_group)(const glint_node *node, int slot, const R(common_walk) * walk, unsigned lanes,
                                         R(first_balls) * first)
{
    const vf zero = f_set(0), none = f_set(HUGE_VALF);
    const uint32_t id = node->child[slot] & ~GLINT_NODE_PRIM;
    float middle[3], least = HUGE_VALF, most = 0, size = 0;
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5f * (node->lower[k][slot] + node->upper[k][slot]);
        const float half = node->upper[k][slot] - middle[k];
        least = smaller(least, half);
        most = larger(most, half);
        size += fabsf(middle[k]);
    }
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf f[3], d[3], far_off = f_set(size + most);
        for (int k = 0; k < 3; k++) {
            const vf from = f_load(walk->rays->local[k] + i);
            f[k] = from - f_set(middle[k]);
            d[k] = f_load(walk->rays->direction[k] + i);
            far_off = far_off + f_abs(from);
        }
        const vf length = f_load(walk->lone->length + i), per_a = f_load(walk->lone->per_a + i);
        const vf margin = f_set(NEAREST_SLACK) * far_off, far = f_load(first->far + i);
        const vf limit = f_set(most) + margin, inner = f_max(f_set(least) - margin, zero);
        const vf x[3] = { f[1] * d[2] - f[2] * d[1], f[2] * d[0] - f[0] * d[2], f[0] * d[1] - f[1] * d[0] };
        const vf x2 = DOT(x, x), b = -DOT(f, d), reach = limit * length, sure_reach = inner * length;
        const vf discriminant = reach * reach - x2, sure_discriminant = sure_reach * sure_reach - x2;
        const vf half = f_sqrt(f_max(discriminant, zero)), slack = f_set(NEAREST_SLACK) * (f_abs(b) + reach);
        const vf entry = f_max((b - half) - slack, zero) * per_a;
        fm near = fm_and(fm_and(f_le(zero, discriminant), f_le(zero, (b + half) + slack)), f_le(entry, far));
        near = fm_and(near, fm_from_bits(lanes >> i));
        if (walk->leaving)
            near = fm_andnot(near, i_eq(i_load(walk->leaving + i), i_set(id)));
        if (!fm_bits(near))
            continue;
        const vf sure = ((b - f_sqrt(f_max(sure_discriminant, zero))) + (slack + margin * length)) * per_a;
        const fm enters = fm_and(fm_and(f_lt(limit * limit, DOT(f, f)), f_lt(zero, b)), f_lt(zero, sure_discriminant));
        const vf own = f_select(near, entry, none), way0 = f_load(first->entry[0] + i),
                 way1 = f_load(first->entry[1] + i);
        const fm before = f_lt(own, way0), second = f_lt(own, way1);
        const vf prim0 = f_from_bits(i_load(first->prim[0] + i)), prim1 = f_from_bits(i_load(first->prim[1] + i));
        const vf prim = f_from_bits(i_set(id));
        f_store(first->next + i, f_min(f_load(first->next + i), f_max(own, way1)));
        f_store(first->entry[1] + i, f_max(way0, f_min(own, way1)));
        i_store(first->prim[1] + i, f_bits(f_select(before, prim0, f_select(second, prim, prim1))));
        f_store(first->entry[0] + i, f_min(own, way0));
        i_store(first->prim[0] + i, f_bits(f_select(before, prim, prim0)));
        f_store(first->far + i, f_select(fm_and(near, enters), f_min(far, sure), far));
    }
}

/// Pairs the rays in `lanes` with a triangle.
static inline void R(add_lanes_to_round)(const R(common_walk) * walk, uint32_t id, unsigned lanes, R(rounds) * rounds)
{
    int n = rounds->count;
    if (walk->leaving)
        lanes &= ~lanes_equal(walk->leaving, id);
    for (; lanes; lanes &= lanes - 1) {
        rounds->lane[n] = (uint32_t)__builtin_ctz(lanes);
        rounds->prim[n++] = id;
    }
    rounds->count = n;
}

// ---- Traversal ----

/// Tests the rays in `lanes` against the primitive in a slot of a node.
static inline void R(intersect_slot)(const glint_cast_args *args, uint32_t g, const glint_node *node, int slot,
                                     const R(common_walk) * walk, unsigned lanes, R(rounds) * rounds)
{
    const glint_geometry_table *geometry = args->geometry;
    const uint32_t id = node->child[slot] & ~GLINT_NODE_PRIM;
    _Alignas(64) float depth[GLINT_GROUP];
    if (id < geometry->triangles) {
        R(add_lanes_to_round)(walk, id, lanes & R(rays_in_slot)(node, slot, walk, &rounds->first, depth), rounds);
        if (rounds->count > GLINT_ROUND_PAIRS - GLINT_GROUP)
            R(decide_triangles)(args, g, rounds);
    } else if (geometry->prims[id].kind == GLINT_PRIM_SPHERE) {
        R(note_ball_of_group)(node, slot, walk, lanes, &rounds->first);
    } else {
        const unsigned near = lanes & R(rays_in_slot)(node, slot, walk, &rounds->first, depth);
        for (unsigned bits = near; bits; bits &= bits - 1)
            R(add_solid)(rounds, id, __builtin_ctz(bits));
        if (rounds->solids == GLINT_ROUND_SOLIDS)
            R(decide_solids)(args, g, walk->rays, rounds);
    }
}

/// Pushes a node on the stacks of the rays that reach it. Returns false if some stack is full.
static inline bool R(leave_to_each)(const R(common_node) * entry, unsigned lanes, R(rounds) * rounds)
{
    for (unsigned bits = lanes; bits; bits &= bits - 1)
        if (rounds->stack[__builtin_ctz(bits)].height == GLINT_STACKED_NODES_MAX)
            return false;
    for (unsigned bits = lanes; bits; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        R(node_stack) *stack = &rounds->stack[lane];
        stack->node[stack->height] = entry->node;
        stack->depth[stack->height++] = entry->depth[lane];
    }
    return true;
}

/// Advances the rays to the next node. Returns whether there was one.
static inline bool R(step_together)(const glint_cast_args *args, uint32_t g, R(common_walk) * walk, R(rounds) * rounds)
{
    _Alignas(64) float depth[GLINT_NODE_WIDTH];
    int order[GLINT_NODE_WIDTH];
    if (!walk->height)
        return false;
    R(common_node) *entry = &walk->stack[--walk->height];
    unsigned lanes = 0;
    float least, far;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm there = f_le(f_load(entry->depth + i), f_load(rounds->first.far + i));
        lanes |= fm_bits(there) << i;
    }
    lanes &= entry->lanes;
    if (!lanes)
        return true;
    if (__builtin_popcount(lanes) <= GLINT_FEW_LANES && R(leave_to_each)(entry, lanes, rounds))
        return true;
    R(range_in)(rounds->first.far, lanes, &least, &far);
    const glint_node *node = &args->geometry->nodes[entry->node];
    const unsigned mask = R(boxes_in_slabs)(node, &walk->slabs, far, depth), prims = mask & prims_of_node(node);
    if (__builtin_popcount(mask) > __builtin_popcount(lanes) && R(leave_to_each)(entry, lanes, rounds))
        return true;
    for (unsigned bits = prims; bits; bits &= bits - 1)
        R(intersect_slot)(args, g, node, __builtin_ctz(bits), walk, lanes, rounds);
    if (rounds->count >= VR)
        R(decide_triangles)(args, g, rounds);
    if (rounds->solids)
        R(decide_solids)(args, g, walk->rays, rounds);
    for (int n = sort_slots(mask & ~prims, depth, order); n-- > 0;) {
        R(common_node) *next = &walk->stack[walk->height];
        next->node = node->child[order[n]];
        next->lanes = lanes & R(rays_in_slot)(node, order[n], walk, &rounds->first, next->depth);
        walk->height += next->lanes != 0;
    }
    return true;
}

static inline void R(begin_together)(const glint_cast_args *args, size_t at, const R(ray_group) * rays,
                                     const R(lone_rays) * lone, unsigned lanes, R(common_walk) * walk)
{
    walk->rays = rays;
    walk->lone = lone;
    walk->leaving = args->leaving ? args->leaving + at : NULL;
    for (int k = 0; k < 3; k++) {
        walk->back[k] = 0;
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const vf x = f_load(rays->local[k] + i), moved = f_set(0x1p-22f) * f_abs(x) + f_set(FLT_MIN);
            const fm back = f_lt(f_load(lone->inverse[k] + i), f_set(0));
            walk->back[k] |= fm_bits(back) << i;
            f_store(walk->enter[k] + i, f_select(back, x - moved, x + moved));
            f_store(walk->leave[k] + i, f_select(back, x + moved, x - moved));
        }
    }
    R(find_common_slabs)(walk, lanes, &walk->slabs);
    walk->height = 1;
    walk->stack[0].node = 0;
    walk->stack[0].lanes = lanes;
    for (int i = 0; i < GLINT_GROUP; i += VF)
        f_store(walk->stack[0].depth + i, f_set(0));
}

/// Reverses the stack, so that the nearest remaining node is on top.
static inline void R(reverse_stack)(R(node_stack) * stack)
{
    for (int i = 0, j = stack->height - 1; i < j; i++, j--) {
        const uint32_t node = stack->node[i];
        const float depth = stack->depth[i];
        stack->node[i] = stack->node[j];
        stack->depth[i] = stack->depth[j];
        stack->node[j] = node;
        stack->depth[j] = depth;
    }
}

/// Traverses the index with the rays of a group in `lanes`.
static __attribute__((noinline)) void R(walk_rays)(const glint_cast_args *args, uint32_t g, const R(ray_group) * rays,
                                                   const R(lone_rays) * lone, unsigned lanes, R(ray_pairs) * pairs)
{
    R(rounds) buffer, *const rounds = &buffer;
    R(common_walk) walk;
    const size_t at = (size_t)g * GLINT_GROUP;
    unsigned alone = 0;
    R(begin_balls)(args, at, &rounds->first);
    if (args->geometry->triangles)
        R(permute_rays)(args, at, lanes, &rounds->permuted);
    rounds->count = rounds->solids = 0;
    for (unsigned bits = lanes; bits; bits &= bits - 1)
        rounds->stack[__builtin_ctz(bits)].height = 0;
    R(begin_together)(args, at, rays, lone, lanes, &walk);
    while (R(step_together)(args, g, &walk, rounds))
        ;
    if (rounds->count)
        R(decide_triangles)(args, g, rounds);
    for (unsigned bits = lanes; bits; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        if (!rounds->stack[lane].height)
            continue;
        R(reverse_stack)(&rounds->stack[lane]);
        R(load_lone_ray)(args, at + (size_t)lane, rays, lone, &rounds->ray[lane]);
        alone |= bits & -bits;
    }
    R(walk_in_rounds)(args, g, rays, alone, rounds);
    R(pair_first)(args, at, lanes, &rounds->first, pairs);
}

#endif
