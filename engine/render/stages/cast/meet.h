// meet: intersects rays with a surface. A float test rejects lanes of a whole group at a time; the remaining lanes
// are decided in `real`. Contract: stages.h, cast.
#ifndef GLINT_CAST_MEET_H
#define GLINT_CAST_MEET_H

#include "engine/render/stages/cast/face.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

/// Computes |f|^2 - (r2 + r2_low) without cancellation.
INNER vd d_exact_power(const vd f[3], vd r2, vd r2_low)
{
    vd e0, e1, e2;
    vd p0 = d_two_prod(f[0], f[0], &e0), p1 = d_two_prod(f[1], f[1], &e1), p2 = d_two_prod(f[2], f[2], &e2);
    vd xe, ye, ze;
    vd x = d_two_sum(p0, p1, &xe), y = d_two_sum(x, p2, &ye), z = d_two_sum(y, -r2, &ze);
    return z + (((xe + ye) + ze) + (((e0 + e1) + e2) - r2_low));
}

INNER vr R(exact_power)(const vr f[3], vr r2, vr r2_low)
{
#if GLINT_REAL == 64
    return d_exact_power(f, r2, r2_low);
#else
    (void)r2_low;
    return DOT(f, f) - r2;
#endif
}

/// Values that depend on a sphere's radius, computed once for many rays; unused for other primitives.
typedef struct R(ball) {
    vr scale, r2, r2_low;
} R(ball);

static inline R(ball) R(ball_of)(const glint_prim *prim)
{
    if (prim->kind != GLINT_PRIM_SPHERE)
        return (R(ball)) { r_set(0), r_set(0), r_set(0) };
    return (R(ball)) { r_set(glint_sphere_scale(prim)), r_set(glint_sphere_r2(prim)), r_set(glint_sphere_r2_low(prim)) };
}

INNER vr R(exact_c)(const vr f[3], const glint_prim *prim)
{
    return R(exact_power)(f, r_set(glint_sphere_r2(prim)), r_set(glint_sphere_r2_low(prim)));
}

/// Returns the discriminant a r^2 - |f x d|^2. ar2: a r^2.
INNER vr R(discriminant_afar)(const vr f[3], const vr d[3], vr ar2)
{
    vr x = f[1] * d[2] - f[2] * d[1], y = f[2] * d[0] - f[0] * d[2], z = f[0] * d[1] - f[1] * d[0];
    return ar2 - ((x * x + y * y) + z * z);
}

/// Returns the more accurate of two discriminants: within the sphere's width b^2 - a c, from further away a r^2 - |f
/// x d|^2. Haines, Gunther, Akenine-Moller, Ray Tracing Gems ch. 7, gives the second form; neither form is accurate
/// everywhere.
INNER vr R(discriminant)(const vr f[3], const vr d[3], vr a, vr b, vr c, vr r2)
{
    vr bb = b * b, ar2 = a * r2;
    const rm near = r_lt(bb, ar2);
    if (!rm_bits(near))
        return R(discriminant_afar)(f, d, ar2);
    vr inner = bb - a * c;
    if (rm_bits(near) == (1u << VR) - 1) // for example a ground seen from above: no cross product is needed
        return inner;
    return r_select(near, inner, R(discriminant_afar)(f, d, ar2));
}

/// Intersects one sphere, or a different one in each lane.
INNER rm R(intersect_ball)(const vr f[3], const vr d[3], vr a, vr c, vr r2, vr scale, vr *t)
{
    const vr zero = r_set(0);
    vr b = -DOT(f, d);
    vr disc = R(discriminant)(f, d, a, b, c, r2);
    vr s = r_sqrt(r_max(disc, zero));
    rm ahead = r_le(zero, b);
    vr q = r_select(ahead, b + s, b - s);
    rm far_root = rm_and(r_le(c, zero), ahead);
    *t = r_select(far_root, q, c) / (r_select(far_root, a, q) * scale);
    return rm_and(r_le(zero, disc), r_lt(zero, *t));
}

INNER rm R(intersect_plane)(const vr d[3], vr a, vr h, const glint_prim *prim, vr *t)
{
    const vr n[3] = { r_set(prim->normal[0]), r_set(prim->normal[1]), r_set(prim->normal[2]) };
    vr nd = DOT(n, d);
    *t = -h / nd;
    return rm_and(r_le(r_set(GLINT_PARALLEL) * a, nd * nd), r_lt(r_set(0), *t));
}

// ---- The filter for rays with their own origins ----

/// Returns the lanes of a group whose rays come near the sphere. `f`: from the sphere's centre to the ray's origin;
/// the ray passes the centre at the distance |f x d| / |d|. Written so that lanes with NaN and infinity stay.
static inline unsigned R(near_lanes)(const vf f[3], const vf d[3], vf limit2)
{
    vf x[3] = { f[1] * d[2] - f[2] * d[1], f[2] * d[0] - f[0] * d[2], f[0] * d[1] - f[1] * d[0] };
    return ~fm_bits(f_lt(limit2 * DOT(d, d), DOT(x, x))) & ((1u << VF) - 1);
}

/// Transforms points of a group into the index's frame.
static inline void R(index_frame)(const void *const point[3], size_t at, const glint_geometry_table *geometry,
                                  float (*local)[GLINT_GROUP])
{
    _Alignas(64) real moved[GLINT_GROUP];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < GLINT_GROUP; i += VR)
            r_store(moved + i,
                    (r_load((const real *)point[k] + at + i) - r_set(geometry->reference[k])) * r_set(geometry->scale));
        R(narrow)(moved, local[k]);
    }
}

/// A group of rays, as filter and traversal need it.
typedef struct R(ray_group) {
    const float (*local)[GLINT_GROUP]; ///< origins, in the index's frame
    _Alignas(64) float direction[3][GLINT_GROUP];
    _Alignas(64) float bound[GLINT_GROUP]; ///< bound of the error that the rounding of `local` adds to a distance
    const float *origin[3]; ///< --precision float: the unchanged origins
} R(ray_group);

/// Sets every field except `direction`. `local`: the same origins as index_frame computed them.
static inline void R(set_origins)(const void *const point[3], size_t at, const float (*local)[GLINT_GROUP],
                                  R(ray_group) * rays)
{
    rays->local = local;
    for (int i = 0; i < GLINT_GROUP; i += VF) // the sum of the absolute components is an upper bound of the length
        f_store(rays->bound + i,
                f_set(GLINT_FILTER_SLACK) * ((f_abs(f_load(rays->local[0] + i)) + f_abs(f_load(rays->local[1] + i))) +
                                             f_abs(f_load(rays->local[2] + i))));
    for (int k = 0; k < 3; k++)
        rays->origin[k] = (const float *)point[k] + (GLINT_REAL == 32 ? at : 0);
}

/// Computes f, from the sphere's centre to the rays' origins. Rays within the returned distance are not rejected.
static inline vf R(filter_offset)(const R(ray_group) * rays, int i, const glint_prim *prim, vf f[3])
{
#if GLINT_REAL == 64
    for (int k = 0; k < 3; k++)
        f[k] = f_load(rays->local[k] + i) - f_set(prim->filter_center[k]);
    return f_set(prim->filter_bound) + f_load(rays->bound + i);
#else // if float decides, the filter must use the same f as the decision, including the rounding error of f
    for (int k = 0; k < 3; k++)
        f[k] = f_load(rays->origin[k] + i);
    if (prim->kind != GLINT_PRIM_SPHERE)
        return f_set(HUGE_VALF);
    for (int k = 0; k < 3; k++)
        f[k] = (f[k] - f_set((float)prim->center[k])) * f_set((float)glint_sphere_scale(prim));
    return f_set((float)(prim->radius * glint_sphere_scale(prim) * (1 + 2e-6))) +
           f_set(GLINT_FILTER_SLACK) * ((f_abs(f[0]) + f_abs(f[1])) + f_abs(f[2]));
#endif
}

/// Returns the lanes of the group whose rays pass near the primitive.
static unsigned R(near_rays)(const R(ray_group) * rays, const glint_prim *prim)
{
    unsigned near = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf f[3], d[3];
        for (int k = 0; k < 3; k++)
            d[k] = f_load(rays->direction[k] + i);
        const vf limit = R(filter_offset)(rays, i, prim, f);
        near |= R(near_lanes)(f, d, limit * limit) << i;
    }
    return near;
}

/// Returns the lanes of the group whose rays may enter the box from `lower` to `upper`, in the index's frame.
/// inverse: one over the components of the directions; its error is relative to the box's distance along the ray.
static unsigned R(rays_to_box)(const R(ray_group) * rays, float (*inverse)[GLINT_GROUP], const float lower[3],
                               const float upper[3])
{
    unsigned inside = 0;
    float slack = 0;
    for (int k = 0; k < 3; k++)
        slack += GLINT_FILTER_SLACK * (fabsf(lower[k]) + fabsf(upper[k]));
    for (int i = 0; i < GLINT_GROUP && GLINT_REAL == 64; i += VF) {
        const vf bound = f_load(rays->bound + i) + f_set(slack);
        vf enter = f_set(0), leave = f_set(HUGE_VALF);
        for (int k = 0; k < 3; k++) {
            const vf from = f_load(rays->local[k] + i), over = f_load(inverse[k] + i);
            const vf x = ((f_set(lower[k]) - from) - bound) * over, y = ((f_set(upper[k]) - from) + bound) * over;
            enter = f_max(f_min(x, y), enter); // NaN comes from 0 times infinity, for a ray along the border of the
                // box: either answer is right
            leave = f_min(f_max(x, y), leave);
        }
        inside |= (~fm_bits(f_lt(leave * f_set(1 + WALK_SLACK), enter)) & ((1u << VF) - 1)) << i;
    }
    return GLINT_REAL == 64 ? inside : 0xffff; // if float decides, nothing is rejected here
}

// ---- The decision ----

/// Returns the lanes of `tied` in which the primitive `id` was defined before the primitive of the current hit. A
/// lane at t = inf (after float overflow) has no current hit, and stays a miss.
static unsigned R(wins_tie)(const glint_prim *prims, uint32_t id, const uint32_t *best, unsigned tied)
{
    unsigned wins = 0;
    for (; tied; tied &= tied - 1) {
        const uint32_t old = best[__builtin_ctz(tied)];
        if (old != GLINT_MISS && prims[id].id < prims[old].id)
            wins |= tied & -tied;
    }
    return wins;
}

/// Stores `t` in the lanes of `hit` where it is nearer than the current hit.
INNER void R(update_nearest)(const glint_cast_args *args, size_t at, uint32_t id, rm hit, vr t)
{
    real *best_t = (real *)args->t + at;
    uint32_t *best_id = args->prim + at;
    const vr old_t = r_load(best_t);
    const rm tie = rm_and(rm_and(hit, r_eq(t, old_t)), r_lt(t, r_set(HUGE_VAL))); // at infinity there is nothing to tie
    hit = rm_and(hit, r_lt(t, old_t));
    if (rm_bits(tie))
        hit = rm_or(hit, rm_from_bits(R(wins_tie)(args->geometry->prims, id, best_id, rm_bits(tie))));
    r_store(best_t, r_select(hit, t, old_t));
    r_put_index(best_id, hit, id);
}

/// Computes f, from the primitive's centre or point to the ray's origin: scaled for a sphere, unscaled for a plane.
static inline void R(offset)(const vr origin[3], const glint_prim *prim, vr f[3])
{
    for (int k = 0; k < 3; k++) {
        f[k] = origin[k] - r_set(prim->center[k]);
        if (prim->kind == GLINT_PRIM_SPHERE)
            f[k] = f[k] * r_set(glint_sphere_scale(prim));
    }
}

/// Returns a primitive's constant for all rays from one origin: c for a sphere, the origin's height over a plane.
static inline vr R(offset_constant)(const vr f[3], const glint_prim *prim)
{
    if (prim->kind == GLINT_PRIM_SPHERE)
        return R(exact_c)(f, prim);
    const vr n[3] = { r_set(prim->normal[0]), r_set(prim->normal[1]), r_set(prim->normal[2]) };
    return DOT(n, f);
}

/// Does the same for an origin on some surface, which rounding has moved: if the height over a plane is within this
/// rounding error, the result is 0.
static inline vr R(point_constant)(const vr f[3], const glint_prim *prim)
{
    const vr c = R(offset_constant)(f, prim);
    if (prim->kind != GLINT_PRIM_PLANE || !(prim->normal[3] > 0))
        return c;
    const vr n[3] = { r_set(prim->normal[0]), r_set(prim->normal[1]), r_set(prim->normal[2]) };
    const vr sizes = (R(abs)(n[0] * f[0]) + R(abs)(n[1] * f[1])) + R(abs)(n[2] * f[2]);
    return R(unless_within)(c, r_set(GLINT_ON_FACE) * (sizes + r_set(prim->normal[3])));
}

INNER rm R(intersect)(const vr f[3], vr c, const vr d[3], const glint_prim *prim, vr *t)
{
    const vr a = DOT(d, d);
    if (prim->kind == GLINT_PRIM_SPHERE)
        return R(intersect_ball)(f, d, a, c, r_set(glint_sphere_r2(prim)), r_set(glint_sphere_scale(prim)), t);
    return R(intersect_plane)(d, a, c, prim, t);
}

/// Starts a group: t is +inf in active lanes, and -inf in the other lanes, so that no hit is nearer there.
static inline void R(start_group)(const glint_cast_args *args, uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const rm active = rm_from_bits(args->active[g] >> i & ((1u << VR) - 1));
        r_store((real *)args->t + at + i, r_select(active, r_set(HUGE_VAL), r_set(-HUGE_VAL)));
    }
    for (int i = 0; i < GLINT_GROUP; i += VF)
        i_store(args->prim + at + i, i_set(GLINT_MISS));
}

/// Writes the group's hit mask. Lanes outside the image become ordinary misses.
static inline void R(finish_group)(const glint_cast_args *args, uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    args->hits[g] = (uint16_t)~lanes_equal(args->prim + at, GLINT_MISS);
    for (int i = 0; args->active[g] != 0xffff && i < GLINT_GROUP; i += VR) {
        const rm active = rm_from_bits(args->active[g] >> i & ((1u << VR) - 1));
        real *t = (real *)args->t + at + i;
        r_store(t, r_select(active, r_load(t), r_set(HUGE_VAL)));
    }
}

/// Returns the distance of a group's farthest hit in the index's units, rounded up; infinite if a ray has no hit.
static inline float R(farthest)(const glint_cast_args *args, size_t at)
{
    _Alignas(64) real t[GLINT_GROUP];
    _Alignas(64) float far[GLINT_GROUP];
    for (int i = 0; i < GLINT_GROUP; i += VR)
        r_store(t + i, r_load((const real *)args->t + at + i) * r_set(args->geometry->scale));
    R(narrow)(t, far);
    return group_highest(far) * (1 + 0x1p-22f);
}

/// Returns the rounding error that float arithmetic adds in the traversal, in the index's units.
static inline float R(walk_slack)(const glint_geometry_table *geometry)
{
#if GLINT_REAL == 64
    (void)geometry;
    return 0;
#else
    return (float)(GLINT_FILTER_SLACK * geometry->extent * geometry->scale);
#endif
}

#endif
