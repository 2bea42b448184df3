// shared_edge: rays that leave a triangle by an edge or corner, and the triangles that share that edge or corner.
// Rounding can put the ray's origin on either side of these triangles. The relative position of the two triangles
// decides whether the ray hits the second one. Contract: stages.h.
#ifndef GLINT_CAST_SHARED_EDGE_H
#define GLINT_CAST_SHARED_EDGE_H

#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/simd/real.h"

/// A triangle's plane in the table's units, and the rounding error of heights over it.
typedef struct R(flat) {
    real m[3], size[3], corner[3][3];
} R(flat);

static inline real R(size_of)(real x) { return x < 0 ? -x : x; }

static inline R(flat) R(flat_of)(const glint_prim *prim, double scale)
{
    R(flat) out;
    real f[3], g[3];
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            out.corner[j][k] = (real)prim->corner[j][k];
    for (int k = 0; k < 3; k++) {
        f[k] = (out.corner[1][k] - out.corner[0][k]) * (real)scale;
        g[k] = (out.corner[2][k] - out.corner[0][k]) * (real)scale;
    }
    for (int k = 0; k < 3; k++) {
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        const real a = f[x] * g[y], b = f[y] * g[x];
        out.m[k] = a - b;
        out.size[k] = R(size_of)(a) + R(size_of)(b);
    }
    return out;
}

/// Computes the height of a point over the plane, and the rounding error of the height.
static inline real R(height_over)(const R(flat) * flat, const real at[3], real *rounding)
{
    real q[3];
    for (int k = 0; k < 3; k++)
        q[k] = at[k] - flat->corner[0][k];
    *rounding = (real)GLINT_POINT_SLACK * ((flat->size[0] * R(size_of)(q[0]) + flat->size[1] * R(size_of)(q[1])) +
                                           flat->size[2] * R(size_of)(q[2]));
    return DOT(flat->m, q);
}

static inline real R(spread_of)(const R(flat) * flat)
{
    return (R(size_of)(flat->m[0]) + R(size_of)(flat->m[1])) + R(size_of)(flat->m[2]);
}

static inline real R(size_of_all)(const real v[3])
{
    real most = 0;
    for (int k = 0; k < 3; k++)
        most = most < R(size_of)(v[k]) ? R(size_of)(v[k]) : most;
    return most;
}

/// Returns whether a point is in the triangle's plane within rounding. on_surface: whether the point was computed on
/// some surface, and has the rounding error of such points.
static inline bool R(is_in_plane)(const R(flat) * flat, const real point[3], bool on_surface)
{
    real rounding;
    const real h = R(height_over)(flat, point, &rounding), off = (real)GLINT_POINT_SLACK * R(size_of_all)(point);
    return R(size_of)(h) <= (on_surface ? rounding + R(spread_of)(flat) * off : rounding);
}

static inline real R(near_shared_edge)(const glint_geometry_table *table)
{
    return (real)(GLINT_NEAR_SHARED_EDGE * table->extent);
}

/// Removes hits where a ray starts on the triangle. o: origins of the rays of `hit`; leaving: the primitives that the
/// rays start on, or NULL.
static inline rm R(unless_begun_on)(const glint_geometry_table *table, const glint_prim *prim, const uint32_t *leaving,
                                    const vr o[3], rm hit, vr t)
{
    if (!rm_bits(hit) || prim->face)
        return hit;
    unsigned soon = rm_bits(rm_and(hit, r_le(t, r_set(R(near_shared_edge)(table))))), on = 0;
    if (!soon)
        return hit;
    const R(flat) flat = R(flat_of)(prim, table->scale);
    _Alignas(64) real origin[3][VR];
    for (int k = 0; k < 3; k++)
        r_store(origin[k], o[k]);
    for (; soon; soon &= soon - 1) {
        const int j = __builtin_ctz(soon);
        const real start[3] = { origin[0][j], origin[1][j], origin[2][j] };
        if (R(is_in_plane)(&flat, start, leaving && leaving[j] != GLINT_MISS))
            on |= soon & -soon;
    }
    return rm_andnot(hit, rm_from_bits(on));
}

/// Returns whether a corner of the other triangle is certainly on the side of the plane that `side` points to. The
/// corners are rounded, too.
static inline bool R(reaches)(const R(flat) * flat, real side, const R(flat) * other)
{
    for (int j = 0; j < 3; j++) {
        real rounding;
        const real h = R(height_over)(flat, other->corner[j], &rounding), extent = R(size_of_all)(other->corner[j]);
        const real off = rounding + R(spread_of)(flat) * ((real)GLINT_POINT_SLACK * extent);
        if (off < R(size_of)(h) && ((0 < side && 0 < h) || (side < 0 && h < 0)))
            return true;
    }
    return false;
}

/// Returns the rounding error of a computed point on the triangle, per component.
static inline real R(point_slack_of)(const R(flat) * flat, const real o[3])
{
    real f = 0, g = 0, p = 0;
    for (int k = 0; k < 3; k++) {
        const real a = R(size_of)(flat->corner[1][k] - flat->corner[0][k]),
                   b = R(size_of)(flat->corner[2][k] - flat->corner[0][k]), c = R(size_of)(o[k]);
        f = a < f ? f : a;
        g = b < g ? g : b;
        p = c < p ? p : c;
    }
    return (real)GLINT_POINT_SLACK * ((f + g) + p);
}

/// Returns whether the point of the ray at t = `t` is on the triangle, within the error of the ray's origin: on the
/// same side of all edges, and within the bounds of the corners. For a triangle seen edge-on, the ray is near all
/// edges.
static inline bool R(passes_near)(const R(flat) * flat, const real o[3], const real d[3], real t, real slack,
                                  double scale)
{
    vr p[3][3], direction[3];
    real r = 0, low[3], high[3];
    for (int k = 0; k < 3; k++) {
        direction[k] = r_set(d[k]);
        for (int j = 0; j < 3; j++) {
            const real from = (flat->corner[j][k] - o[k]) * (real)scale;
            r = r < R(size_of)(from) ? R(size_of)(from) : r;
            low[k] = j == 0 || from < low[k] ? from : low[k];
            high[k] = j == 0 || high[k] < from ? from : high[k];
            p[j][k] = r_set(from);
        }
    }
    const real loose = 2 * (slack * (real)scale) + (real)GLINT_POINT_SLACK * r;
    for (int k = 0; k < 3; k++) {
        const real at = (t * d[k]) * (real)scale;
        if (!(low[k] <= at + loose && at - loose <= high[k]))
            return false;
    }
    const R(ray_edges) edges = R(make_ray_edges)(p, direction, true);
    const vr move = R(abs)(edges.dz) * r_set(loose);
    return rm_bits(rm_and(R(within)(&edges, move * (edges.reach + r_set(2) * move)),
                          R(between_corners)(p, direction, move))) &
           1;
}

/// Returns whether a ray passes through `other`. The ray starts on `from`, and at t = `t` it is in both planes within
/// rounding. It passes through if `other` extends to the side that the ray goes to, and the ray leaves the side of
/// `other` that `from` is on.
static inline bool R(goes_through)(const R(flat) * from, const R(flat) * other, const real o[3], const real d[3],
                                   real t, real slack, double scale)
{
    return R(reaches)(from, DOT(from->m, d), other) && R(reaches)(other, -DOT(other->m, d), from) &&
           R(passes_near)(other, o, d, t, slack, scale);
}

/// Returns whether a ray that starts on `from` is still in its plane, within rounding, when it hits another plane at
/// t = `t`. A ray at a grazing angle may start on the wrong side of `from` and pass an edge on that side.
static inline bool R(is_still_on)(const R(flat) * from, const real d[3], real slack, real t)
{
    return t * R(size_of)(DOT(from->m, d)) <= R(spread_of)(from) * slack;
}

/// Returns the lanes whose lines pass through the triangle, within the error of the rays' origins.
static inline unsigned R(at_triangle)(const glint_geometry_table *table, const R(ray_edges) * edges)
{
    // an upper bound of every `loose`: the sizes that `loose` is computed from are at most 12 extents
    const vr move = R(abs)(edges->dz) * r_set((real)(13 * GLINT_POINT_SLACK * table->extent * table->scale));
    return rm_bits(R(within)(edges, move * (edges->reach + r_set(2) * move)));
}

/// Returns the lanes of at_triangle whose rays may reach the triangle.
static inline unsigned R(may_be_near)(const glint_geometry_table *table, const R(ray_edges) * edges, vr t)
{
    return R(at_triangle)(table, edges) & rm_bits(r_lt(r_set(0), t));
}

/// Decides two kinds of lanes again: rays that lie in the plane of the triangle that they leave and in the plane of
/// this triangle, and rays that pass near an edge of this triangle. `at`: the first lane of the vector; `own`: lanes
/// whose rays leave this triangle; `edges`: `reach` must be set.
static inline rm R(intersect_shared_edge)(const glint_cast_args *args, size_t at, unsigned own, const vr o[3],
                                          const R(flat) * flat, const R(ray_edges) * edges, rm hit, vr *t)
{
    const glint_geometry_table *table = args->geometry;
    const real *const m = flat->m;
    const real spread = R(spread_of)(flat);
    const real far = (real)(2 * GLINT_POINT_SLACK * table->extent);
    // an upper bound of all error bounds: points, corners and their differences are at most 2 extents
    const real most = far * (5 * spread + 2 * ((flat->size[0] + flat->size[1]) + flat->size[2]));
    vr q[3];
    for (int k = 0; k < 3; k++)
        q[k] = o[k] - r_set(flat->corner[0][k]);
    const vr h = (r_set(m[0]) * q[0] + r_set(m[1]) * q[1]) + r_set(m[2]) * q[2];
    const real near = R(near_shared_edge)(table);
    const rm soon = rm_and(r_lt(r_set(0), *t), r_le(*t, r_set(near)));
    _Alignas(64) real each_t[VR];
    unsigned begins = 0, anew = 0, through = 0;
    const unsigned by_edge = R(may_be_near)(table, edges, *t) & ~rm_bits(hit);
    unsigned rest = (~rm_bits(r_lt(r_set(most), R(abs)(h))) | rm_bits(soon) | by_edge) & ~own & ((1u << VR) - 1);
    rest &= (unsigned)args->active[at / GLINT_GROUP] >> at % GLINT_GROUP; // `leaving` is undefined in other lanes
    if (rest)
        r_store(each_t, *t);
    for (; rest; rest &= rest - 1) {
        const unsigned lane = rest & -rest;
        const int j = __builtin_ctz(rest);
        const size_t i = at + (size_t)j;
        const uint32_t from_id = args->leaving[i];
        if (from_id == GLINT_MISS || table->prims[from_id].kind != GLINT_PRIM_TRIANGLE)
            continue;
        real origin[3], d[3], rounding;
        for (int k = 0; k < 3; k++) {
            origin[k] = ((const real *)args->origin[k])[i];
            d[k] = ((const real *)args->direction[k])[i];
        }
        const R(flat) from = R(flat_of)(&table->prims[from_id], table->scale);
        const real slack = R(point_slack_of)(&from, origin), height = R(height_over)(flat, origin, &rounding);
        if (!(spread * slack + rounding < R(size_of)(height))) {
            begins |= lane;
            each_t[j] = 0;
        } else if (!(by_edge & lane) &&
                   !(0 < each_t[j] && each_t[j] <= near && R(is_still_on)(&from, d, slack, each_t[j]))) {
            continue;
        }
        anew |= lane;
        if (R(goes_through)(&from, flat, origin, d, each_t[j], slack, table->scale))
            through |= lane;
    }
    *t = r_select(rm_from_bits(begins), r_set(GLINT_LEAST_T), *t);
    return rm_or(rm_andnot(hit, rm_from_bits(anew)), rm_from_bits(through));
}

#endif
