// nearest: tests rays with their own origins against spheres. A float pass finds, for each ray, the sphere that the
// ray may enter first, and the distance before which it cannot enter any other sphere. Then the first spheres are
// decided in double, a vector of pairs of ray and sphere at a time. A ray is only tested against all spheres if it
// misses the first one, or hits it beyond that distance. Contract: stages.h, cast.
#ifndef GLINT_CAST_NEAREST_H
#define GLINT_CAST_NEAREST_H

#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

#define GLINT_FEW 32 ///< a scene with at most this number of primitives is tested without its index
#define GLINT_RAY_PAIRS 64

/// Error bound of a distance between a ray and a sphere in float, relative to the lengths that the distance is
/// computed from: one rounding each for origin, centre and direction, six for differences and products, three for
/// quotient and square root.
#define NEAREST_SLACK 0x1p-20f

/// The first candidate of each ray from the float pass, and the rays that remain to be decided otherwise.
typedef struct R(ray_pairs) {
    _Alignas(64) real origin[3][GLINT_RAY_PAIRS], direction[3][GLINT_RAY_PAIRS];
    _Alignas(64) real center[3][GLINT_RAY_PAIRS], scale[GLINT_RAY_PAIRS];
    _Alignas(64) real r2[GLINT_RAY_PAIRS], r2_low[GLINT_RAY_PAIRS];
    float next[GLINT_RAY_PAIRS]; ///< the distance before which the ray enters no other sphere, in the index's units
    uint32_t ray[GLINT_RAY_PAIRS], prim[GLINT_RAY_PAIRS];
    int count;
    uint16_t undecided[GLINT_TILE_GROUPS]; ///< rays that must be tested against all primitives, one bit per lane
} R(ray_pairs);

/// Returns the distance of a hit at t in the index's units, rounded up.
static inline float R(reach_in_index)(const glint_cast_args *args, real t)
{
    return (float)(t * (real)args->geometry->scale) * (1 + 0x1p-22f);
}

/// Stores the hit of one ray if it is the nearest so far.
static inline void R(update_ray)(const glint_cast_args *args, uint32_t ray, uint32_t id, real t)
{
    const glint_prim *prims = args->geometry->prims;
    real *best = (real *)args->t + ray;
    uint32_t *best_id = args->prim + ray;
    const bool tie = t == *best && t < (real)HUGE_VAL && *best_id != GLINT_MISS && prims[id].id < prims[*best_id].id;
    if (!(t < *best || tie))
        return;
    *best = t;
    *best_id = id;
}

/// Decides VR pairs from number i on.
INNER unsigned R(intersect_pairs)(const R(ray_pairs) * pairs, int i, real t[VR])
{
    vr f[3], d[3], hit_t;
    const vr scale = r_load(pairs->scale + i), r2 = r_load(pairs->r2 + i);
    for (int k = 0; k < 3; k++) {
        f[k] = (r_load(pairs->origin[k] + i) - r_load(pairs->center[k] + i)) * scale;
        d[k] = r_load(pairs->direction[k] + i);
    }
    const vr c = R(exact_power)(f, r2, r_load(pairs->r2_low + i));
    const unsigned hits = rm_bits(R(intersect_ball)(f, d, DOT(d, d), c, r2, scale, &hit_t));
    r_store(t, hit_t);
    return hits;
}

static __attribute__((noinline)) void R(decide_ray_pairs)(const glint_cast_args *args, R(ray_pairs) * pairs)
{
    _Alignas(64) real t[VR];
    if (args->tests)
        *args->tests += (unsigned)pairs->count;
    for (int i = 0; i < pairs->count; i += VR) {
        const unsigned hits = R(intersect_pairs)(pairs, i, t);
        for (int j = i; j < i + VR && j < pairs->count; j++) {
            const uint32_t ray = pairs->ray[j];
            if (hits >> (j - i) & 1)
                R(update_ray)(args, ray, pairs->prim[j], t[j - i]);
            if (pairs->next[j] <= R(reach_in_index)(args, ((const real *)args->t)[ray]))
                pairs->undecided[ray / GLINT_GROUP] |= (uint16_t)(1u << ray % GLINT_GROUP);
        }
    }
    pairs->count = 0;
}

static inline void R(add_pair)(const glint_cast_args *args, R(ray_pairs) * pairs, uint32_t ray, uint32_t id, float next)
{
    const glint_prim *prim = &args->geometry->prims[id];
    const int n = pairs->count++;
    for (int k = 0; k < 3; k++) {
        pairs->origin[k][n] = ((const real *)args->origin[k])[ray];
        pairs->direction[k][n] = ((const real *)args->direction[k])[ray];
        pairs->center[k][n] = (real)prim->center[k];
    }
    pairs->scale[n] = (real)glint_sphere_scale(prim);
    pairs->r2[n] = (real)glint_sphere_r2(prim);
    pairs->r2_low[n] = (real)glint_sphere_r2_low(prim);
    pairs->ray[n] = ray;
    pairs->prim[n] = id;
    pairs->next[n] = next;
    if (pairs->count == GLINT_RAY_PAIRS)
        R(decide_ray_pairs)(args, pairs);
}

/// A vector of VF rays in float.
typedef struct R(float_rays) {
    vf origin[3], direction[3], bound;
    vf length, per_a; ///< |d|, 1 / |d|^2
    fm usual; ///< lanes whose origin and direction are in the range in which float neither overflows nor underflows
        ///< in the functions below
} R(float_rays);

INNER void R(load_float_rays)(const R(ray_group) * rays, int i, R(float_rays) * out)
{
    for (int k = 0; k < 3; k++) {
        out->origin[k] = f_load(rays->local[k] + i);
        out->direction[k] = f_load(rays->direction[k] + i);
    }
    out->bound = f_load(rays->bound + i);
    const vf a = DOT(out->direction, out->direction);
    out->length = f_sqrt(a);
    out->per_a = f_set(1) / a;
    out->usual = fm_and(fm_and(f_lt(f_set(0x1p-40f), a), f_lt(a, f_set(0x1p40f))), f_lt(out->bound, f_set(1)));
}

/// Returns the lanes that may enter a sphere, or start inside of it. If there are any, *entry gets a lower bound of
/// the distance to the entry, in the index's units, infinite in the other lanes.
INNER fm R(enter_ball)(const R(float_rays) * rays, const glint_prim *prim, vf *entry)
{
    vf f[3];
    const vf *d = rays->direction;
    for (int k = 0; k < 3; k++)
        f[k] = rays->origin[k] - f_set(prim->filter_center[k]);
    const vf x[3] = { f[1] * d[2] - f[2] * d[1], f[2] * d[0] - f[0] * d[2], f[0] * d[1] - f[1] * d[0] };
    const vf limit = (f_set(prim->filter_bound) + rays->bound) * rays->length;
    const vf discriminant = limit * limit - DOT(x, x), b = -DOT(f, d);
    if (!fm_bits(f_le(f_set(0), discriminant)))
        return fm_from_bits(0);
    const vf half = f_sqrt(f_max(discriminant, f_set(0)));
    const vf slack = f_set(NEAREST_SLACK) * (f_abs(b) + limit);
    const fm near = fm_and(f_le(f_set(0), discriminant), f_le(f_set(0), (b + half) + slack));
    *entry = f_select(near, f_max((b - half) - slack, f_set(0)) * rays->per_a, f_set(HUGE_VALF));
    return near;
}

/// The possible first hits of a group.
typedef struct R(first_hits) {
    _Alignas(64) float entry[GLINT_GROUP], next[GLINT_GROUP];
    _Alignas(64) uint32_t prim[GLINT_GROUP];
    unsigned usual;
} R(first_hits);

/// Finds the first sphere of `list` that each ray may enter, and the distance to the second such sphere.
static inline void R(find_first)(const glint_cast_args *args, const R(ray_group) * rays, size_t at,
                                 const uint32_t *list, int count, R(first_hits) * out)
{
    const uint32_t common = args->leaving && lanes_equal(args->leaving + at, args->leaving[at]) == 0xffff
                                ? args->leaving[at]
                                : GLINT_MISS; // the primitive that all rays leave
    out->usual = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        R(float_rays) lanes;
        vf entry = f_set(HUGE_VALF), next = entry, first = f_from_bits(i_set(GLINT_MISS));
        R(load_float_rays)(rays, i, &lanes);
        const vi leaving = args->leaving ? i_load(args->leaving + at + i) : i_set(GLINT_MISS);
        for (int n = 0; n < count; n++) {
            vf own = f_set(HUGE_VALF);
            if (list[n] == common || !fm_bits(R(enter_ball)(&lanes, &args->geometry->prims[list[n]], &own)))
                continue;
            own = f_select(i_eq(leaving, i_set(list[n])), f_set(HUGE_VALF), own);
            first = f_select(f_lt(own, entry), f_from_bits(i_set(list[n])), first);
            next = f_min(next, f_max(own, entry));
            entry = f_min(own, entry);
        }
        f_store(out->entry + i, entry);
        f_store(out->next + i, next);
        i_store(out->prim + i, f_bits(first));
        out->usual |= fm_bits(lanes.usual) << i;
    }
}

/// Tests the spheres of a small scene against a group.
static inline void R(cast_spheres)(const glint_cast_args *args, uint32_t g, const R(ray_group) * rays,
                                   const uint32_t *list, int count, R(ray_pairs) * pairs)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    R(first_hits) first;
    R(find_first)(args, rays, at, list, count, &first);
    pairs->undecided[g] |= (uint16_t)(args->active[g] & ~first.usual);
    for (unsigned bits = args->active[g] & first.usual & ~lanes_equal(first.prim, GLINT_MISS); bits; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        const uint32_t ray = (uint32_t)at + (uint32_t)lane;
        if (first.entry[lane] <= R(reach_in_index)(args, ((const real *)args->t)[ray]))
            R(add_pair)(args, pairs, ray, first.prim[lane], first.next[lane]);
    }
}

// ---- Single rays in the index ----

/// Further data of a group's rays for traversal.
typedef struct R(lone_rays) {
    _Alignas(64) float inverse[3][GLINT_GROUP], length[GLINT_GROUP],
        per_a[GLINT_GROUP]; ///< for a direction d: 1 / d, |d|, 1 / |d|^2
    unsigned usual; ///< lanes within float's range
} R(lone_rays);

static inline void R(load_lone_rays)(const R(ray_group) * rays, R(lone_rays) * out)
{
    out->usual = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        R(float_rays) lanes;
        R(load_float_rays)(rays, i, &lanes);
        for (int k = 0; k < 3; k++)
            f_store(out->inverse[k] + i, f_set(1) / lanes.direction[k]);
        f_store(out->length + i, lanes.length);
        f_store(out->per_a + i, lanes.per_a);
        out->usual |= fm_bits(lanes.usual) << i;
    }
}

/// The possible first hits of a group's rays so far, in the index's units.
typedef struct R(first_balls) {
    _Alignas(64) float far[GLINT_GROUP]; ///< upper bound of the distance of the first hit
    float entry[2][GLINT_GROUP],
        next[GLINT_GROUP]; ///< distances at which each ray may enter the first two spheres, and the third one
    uint32_t prim[2][GLINT_GROUP]; ///< the first two spheres; GLINT_MISS: none
} R(first_balls);

static inline void R(begin_balls)(const glint_cast_args *args, size_t at, R(first_balls) * first)
{
    const vf none = f_set(HUGE_VALF);
    for (int lane = 0; lane < GLINT_GROUP; lane++)
        first->far[lane] = R(reach_in_index)(args, ((const real *)args->t)[at + (size_t)lane]);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        f_store(first->next + i, none);
        for (int k = 0; k < 2; k++) {
            f_store(first->entry[k] + i, none);
            i_store(first->prim[k] + i, i_set(GLINT_MISS));
        }
    }
}

/// Limits the search along a ray to the distance `far`.
static inline void R(limit_distance)(R(first_balls) * first, int lane, float far)
{
    first->far[lane] = smaller(first->far[lane], far);
}

/// One ray.
typedef struct R(lone_ray) {
    float origin[3], direction[3], inverse[3], length, per_a;
    float enter[3], leave[3]; ///< the origin, moved by its rounding error so that boxes begin earlier and end later
    int first[3]; ///< offsets in a node, in floats, of the box sides by which the ray may enter
    int last[3]; ///< offsets of the sides by which the ray may leave
    uint32_t leaving;
} R(lone_ray);

static inline void R(load_lone_ray)(const glint_cast_args *args, size_t at, const R(ray_group) * rays,
                                    const R(lone_rays) * lone, R(lone_ray) * ray)
{
    const size_t lane = at % GLINT_GROUP;
    ray->length = lone->length[lane];
    ray->per_a = lone->per_a[lane];
    ray->leaving = args->leaving ? args->leaving[at] : GLINT_MISS;
    for (int k = 0; k < 3; k++) {
        const float x = rays->local[k][lane], moved = 0x1p-22f * fabsf(x) + FLT_MIN;
        ray->origin[k] = x;
        ray->direction[k] = rays->direction[k][lane];
        ray->inverse[k] = lone->inverse[k][lane];
        const bool back = ray->inverse[k] < 0;
        ray->enter[k] = back ? x - moved : x + moved;
        ray->leave[k] = back ? x + moved : x - moved;
        ray->first[k] = (back ? k + 3 : k) * GLINT_NODE_WIDTH;
        ray->last[k] = (back ? k : k + 3) * GLINT_NODE_WIDTH;
    }
}

/// Returns the boxes that the ray may enter before `far`, and computes where it enters each. As in boxes_on_ray, all
/// rounding errors except the origin's are relative to the distance.
static inline unsigned R(boxes_of_lone_ray)(const glint_node *node, const R(lone_ray) * ray, float far,
                                            float depth[GLINT_NODE_WIDTH])
{
    unsigned inside = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
        vf enter = f_set(0), leave = f_set(far);
        for (int k = 0; k < 3; k++) {
            const float *first = (const float *)node + ray->first[k], *last = (const float *)node + ray->last[k];
            const vf inverse = f_set(ray->inverse[k]);
            enter = f_max((f_load(first + i) - f_set(ray->enter[k])) * inverse, enter); // NaN (0 times inf) keeps
            leave = f_min((f_load(last + i) - f_set(ray->leave[k])) * inverse, leave); // the previous value
        }
        f_store(depth + i, enter);
        inside |= fm_bits(f_le(enter, leave * f_set(1 + WALK_SLACK))) << i;
    }
    return inside;
}

/// Distances along a ray to the spheres of a node, one per slot.
typedef struct R(balls_on_ray) {
    _Alignas(64) float entry[GLINT_NODE_WIDTH]; ///< lower bound of the entry
    _Alignas(64) float sure[GLINT_NODE_WIDTH]; ///< upper bound of the entry; infinite: the ray may miss
} R(balls_on_ray);

/// The sphere that fills each box of a node: the vector from the sphere's centre to the ray's origin, and bounds of
/// the radius after rounding.
typedef struct R(boxed_balls) {
    vf f[3], least, most, margin;
} R(boxed_balls);

INNER R(boxed_balls) R(balls_in_boxes)(const glint_node *node, const R(lone_ray) * ray, int i)
{
    R(boxed_balls) out;
    vf size = f_set(0);
    for (int k = 0; k < 3; k++) {
        const vf lower = f_load(node->lower[k] + i), upper = f_load(node->upper[k] + i);
        const vf middle = f_set(0.5f) * (lower + upper), half = upper - middle, from = f_set(ray->origin[k]);
        out.f[k] = from - middle;
        out.least = k ? f_min(out.least, half) : half;
        out.most = k ? f_max(out.most, half) : half;
        size = size + (f_abs(middle) + f_abs(from));
    }
    out.margin = f_set(NEAREST_SLACK) * (size + out.most);
    return out;
}

/// Returns the slots whose spheres the ray may enter before `far`, or starts inside of.
static inline unsigned R(intersect_balls)(const glint_node *node, const R(lone_ray) * ray, float far,
                                          R(balls_on_ray) * out)
{
    const vf d[3] = { f_set(ray->direction[0]), f_set(ray->direction[1]), f_set(ray->direction[2]) };
    const vf length = f_set(ray->length), per_a = f_set(ray->per_a), zero = f_set(0);
    unsigned may = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
        const R(boxed_balls) ball = R(balls_in_boxes)(node, ray, i);
        const vf *f = ball.f;
        const vf x[3] = { f[1] * d[2] - f[2] * d[1], f[2] * d[0] - f[0] * d[2], f[0] * d[1] - f[1] * d[0] };
        const vf limit = ball.most + ball.margin, inner = f_max(ball.least - ball.margin, zero);
        const vf x2 = DOT(x, x), b = -DOT(f, d), reach = limit * length, least = inner * length;
        const vf discriminant = reach * reach - x2, inner_discriminant = least * least - x2;
        if (!fm_bits(f_le(zero, discriminant)))
            continue;
        const vf half = f_sqrt(f_max(discriminant, zero)), slack = f_set(NEAREST_SLACK) * (f_abs(b) + reach);
        const vf entry = f_max((b - half) - slack, zero) * per_a;
        const fm near =
            fm_and(fm_and(f_le(zero, discriminant), f_le(zero, (b + half) + slack)), f_le(entry, f_set(far)));
        if (!fm_bits(near))
            continue;
        const vf inner_half = f_sqrt(f_max(inner_discriminant, zero));
        const fm outside = fm_and(f_lt(limit * limit, DOT(f, f)), f_lt(zero, b));
        const vf sure = ((b - inner_half) + (slack + ball.margin * length)) * per_a;
        f_store(out->entry + i, entry);
        f_store(out->sure + i, f_select(fm_and(outside, f_lt(zero, inner_discriminant)), sure, f_set(HUGE_VALF)));
        may |= fm_bits(near) << i;
    }
    return may;
}

/// Records a sphere that a ray may enter.
static inline void R(note_ball)(R(first_balls) * first, int lane, uint32_t id, float entry, float sure)
{
    if (entry < first->entry[0][lane]) {
        first->next[lane] = first->entry[1][lane];
        first->entry[1][lane] = first->entry[0][lane];
        first->prim[1][lane] = first->prim[0][lane];
        first->entry[0][lane] = entry;
        first->prim[0][lane] = id;
    } else if (entry < first->entry[1][lane]) {
        first->next[lane] = first->entry[1][lane];
        first->entry[1][lane] = entry;
        first->prim[1][lane] = id;
    } else {
        first->next[lane] = smaller(first->next[lane], entry);
    }
    R(limit_distance)(first, lane, sure);
}

/// Records the spheres of a node in the slots of `mask`.
static inline void R(note_balls)(const glint_node *node, unsigned mask, const R(lone_ray) * ray, int lane,
                                 R(first_balls) * first)
{
    R(balls_on_ray) balls;
    for (mask &= R(intersect_balls)(node, ray, first->far[lane], &balls); mask; mask &= mask - 1) {
        const int slot = __builtin_ctz(mask);
        const uint32_t id = node->child[slot] & ~GLINT_NODE_PRIM;
        if (id != ray->leaving)
            R(note_ball)(first, lane, id, balls.entry[slot], balls.sure[slot]);
    }
}

/// Queues the pairs of a group that remain to be decided.
static inline void R(pair_first)(const glint_cast_args *args, size_t at, unsigned lanes, const R(first_balls) * first,
                                 R(ray_pairs) * pairs)
{
    for (lanes &= ~lanes_equal(first->prim[0], GLINT_MISS); lanes; lanes &= lanes - 1) {
        const int lane = __builtin_ctz(lanes);
        const uint32_t ray = (uint32_t)at + (uint32_t)lane;
        const float far = first->far[lane], second = first->entry[1][lane], next = first->next[lane];
        const bool two = first->prim[1][lane] != GLINT_MISS && second <= far;
        if (!(first->entry[0][lane] <= far))
            continue;
        if (two)
            R(add_pair)(args, pairs, ray, first->prim[1][lane], HUGE_VALF);
        R(add_pair)(args, pairs, ray, first->prim[0][lane], two ? next : smaller(second, next));
    }
}

#endif
