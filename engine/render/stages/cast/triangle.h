// triangle: triangles for cast, surface and occlude. The corners as seen along the ray decide on which side a ray
// passes an edge. The decision is the same for all triangles that share the edge's corners. Contract: stages.h.
#ifndef GLINT_CAST_TRIANGLE_H
#define GLINT_CAST_TRIANGLE_H

#include "engine/render/stages/cast/face.h"
#include "engine/render/stages/simd/real.h"

/// A triangle in the space of a ray.
typedef struct R(ray_edges) {
    vr e[3]; ///< unnormalised weights of the corners
    vr dz; ///< the direction's largest component
    vr depth; ///< weighted sum of the corners along that axis
    vr reach; ///< sum of the absolute values of the terms of e; only set if wanted
} R(ray_edges);

static inline vr R(abs)(vr x) { return r_max(x, -x); }

/// Computes the edge functions. `z`: the axis of the direction's largest component.
static inline R(ray_edges) R(edges_along)(vr p[3][3], const vr d[3], int z, bool want_reach)
{
    const int x = (z + 1) % 3, y = (z + 2) % 3;
    vr X[3], Y[3];
    R(ray_edges) out;
    for (int j = 0; j < 3; j++) {
        X[j] = p[j][x] * d[z] - p[j][z] * d[x];
        Y[j] = p[j][y] * d[z] - p[j][z] * d[y];
    }
    out.e[0] = X[2] * Y[1] - Y[2] * X[1];
    out.e[1] = X[0] * Y[2] - Y[0] * X[2];
    out.e[2] = X[1] * Y[0] - Y[1] * X[0];
    out.dz = d[z];
    out.depth = (out.e[0] * p[0][z] + out.e[1] * p[1][z]) + out.e[2] * p[2][z];
    out.reach = r_set(0);
    if (want_reach)
        out.reach = ((((R(abs)(X[0]) + R(abs)(Y[0])) + R(abs)(X[1])) + R(abs)(Y[1])) + R(abs)(X[2])) + R(abs)(Y[2]);
    return out;
}

static inline R(ray_edges) R(select_edges)(rm mask, const R(ray_edges) * a, const R(ray_edges) * b)
{
    R(ray_edges) out;
    for (int j = 0; j < 3; j++)
        out.e[j] = r_select(mask, a->e[j], b->e[j]);
    out.dz = r_select(mask, a->dz, b->dz);
    out.depth = r_select(mask, a->depth, b->depth);
    out.reach = r_select(mask, a->reach, b->reach);
    return out;
}

/// Computes the edge functions. p: the corners relative to the rays' origins. The rays of a group nearly always have
/// their largest component along the same axis.
INNER R(ray_edges) R(make_ray_edges)(vr p[3][3], const vr d[3], bool want_reach)
{
    const vr ax = R(abs)(d[0]), ay = R(abs)(d[1]), az = R(abs)(d[2]);
    const rm y = r_lt(ax, ay), z = r_lt(r_select(y, ay, ax), az);
    const unsigned ys = rm_bits(y), zs = rm_bits(z), all = (1u << VR) - 1;
    if (zs == all)
        return R(edges_along)(p, d, 2, want_reach);
    R(ray_edges) out, other;
    if (ys == all) {
        out = R(edges_along)(p, d, 1, want_reach);
    } else {
        out = R(edges_along)(p, d, 0, want_reach);
        if (ys) {
            other = R(edges_along)(p, d, 1, want_reach);
            out = R(select_edges)(y, &other, &out);
        }
    }
    if (zs) {
        other = R(edges_along)(p, d, 2, want_reach);
        out = R(select_edges)(z, &other, &out);
    }
    return out;
}

static inline vr R(det)(const R(ray_edges) * edges) { return (edges->e[0] + edges->e[1]) + edges->e[2]; }

/// Returns the lanes whose ray passes all edges on the same side, or on the edge itself, within `reach`.
static inline rm R(within)(const R(ray_edges) * edges, vr reach)
{
    const vr *e = edges->e;
    return rm_or(r_le(-reach, r_min(r_min(e[0], e[1]), e[2])), r_le(r_max(r_max(e[0], e[1]), e[2]), reach));
}

/// Returns the lanes whose ray passes between the smallest and the largest corner coordinate along X and along Y of
/// edges_along, within `reach`.
static rm R(between_corners)(vr p[3][3], const vr d[3], vr reach)
{
    const vr ax = R(abs)(d[0]), ay = R(abs)(d[1]), az = R(abs)(d[2]);
    const rm y = r_lt(ax, ay), z = r_lt(r_select(y, ay, ax), az);
    vr permuted[4][3]; // direction and corners, with the direction's largest component last
    for (int j = 0; j < 4; j++) {
        const vr *v = j == 3 ? d : p[j];
        for (int k = 0; k < 3; k++)
            permuted[j][k] = r_select(z, v[k], r_select(y, v[(k + 2) % 3], v[(k + 1) % 3]));
    }
    rm between = rm_from_bits((1u << VR) - 1);
    for (int k = 0; k < 2; k++) {
        vr x[3];
        for (int j = 0; j < 3; j++)
            x[j] = permuted[j][k] * permuted[3][2] - permuted[j][2] * permuted[3][k];
        between = rm_and(
            between, rm_and(r_le(r_min(r_min(x[0], x[1]), x[2]), reach), r_le(-reach, r_max(r_max(x[0], x[1]), x[2]))));
    }
    return between;
}

/// Returns whether the ray passes through the triangle or its edges. An edge function of 0 may have lost its sign by
/// rounding. All edge functions are 0 along the plane of a triangle seen edge-on, where only the corners bound the
/// triangle.
static inline rm R(passes)(const R(ray_edges) * edges, vr p[3][3], const vr d[3])
{
    const vr *e = edges->e, zero = r_set(0);
    const rm inside = R(within)(edges, zero);
    const rm sure = rm_or(r_lt(zero, r_min(r_min(e[0], e[1]), e[2])), r_lt(r_max(r_max(e[0], e[1]), e[2]), zero));
    if (!rm_bits(rm_andnot(inside, sure)))
        return inside;
    return rm_and(inside, rm_or(sure, R(between_corners)(p, d, zero)));
}

/// Returns the face of a triangle that shares its plane with others, otherwise NULL.
static inline const glint_face *R(face_of)(const glint_geometry_table *table, const glint_prim *prim)
{
    return prim->face ? &table->faces[prim->face - 1] : NULL;
}

/// Intersects a triangle in the space of the ray; p: the corners relative to the ray's origin, in units of the table.
/// face: the face of the triangle's shared plane, or NULL.
static inline rm R(intersect_edges)(const R(ray_edges) * edges, vr p[3][3], const vr o[3], const vr d[3], vr scale,
                                    const glint_face *face, vr *t)
{
    if (face)
        *t = R(face_t)(face, o, d);
    else
        *t = edges->depth / ((R(det)(edges) * edges->dz) * scale);
    return rm_and(R(passes)(edges, p, d), r_lt(r_set(0), *t));
}

/// Does the same from the corners only.
static inline rm R(intersect_triangle)(vr p[3][3], const vr o[3], const vr d[3], vr scale, const glint_face *face,
                                       vr *t)
{
    const R(ray_edges) edges = R(make_ray_edges)(p, d, false);
    return R(intersect_edges)(&edges, p, o, d, scale, face, t);
}

/// Copies a triangle's corners into every lane.
static inline void R(corners_of)(const glint_prim *prim, vr corner[3][3])
{
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            corner[j][k] = r_set(prim->corner[j][k]);
}

/// Computes corners relative to a point.
static inline void R(relative_corners)(vr corner[3][3], const vr from[3], double scale, vr p[3][3])
{
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            p[j][k] = (corner[j][k] - from[k]) * r_set(scale);
}

/// Computes a triangle's corners relative to a point.
static inline void R(corners_from)(const vr from[3], const glint_prim *prim, double scale, vr p[3][3])
{
    vr corner[3][3];
    R(corners_of)(prim, corner);
    R(relative_corners)(corner, from, scale, p);
}

// ---- Surface ----

/// Computes a triangle's unit normal, on the side from which its corners run counter-clockwise.
static inline void R(triangle_normal)(const glint_prim *prim, double scale, double n[3])
{
    double f[3], g[3];
    for (int k = 0; k < 3; k++) {
        f[k] = (prim->corner[1][k] - prim->corner[0][k]) * scale;
        g[k] = (prim->corner[2][k] - prim->corner[0][k]) * scale;
    }
    for (int k = 0; k < 3; k++)
        n[k] = f[(k + 1) % 3] * g[(k + 2) % 3] - f[(k + 2) % 3] * g[(k + 1) % 3];
    const double length = sqrt(DOT(n, n));
    for (int k = 0; k < 3; k++)
        n[k] /= length;
}

static inline vr R(largest)(const vr v[3]) { return r_max(r_max(R(abs)(v[0]), R(abs)(v[1])), R(abs)(v[2])); }

/// Computes the point where rays from `from` hit a triangle, the weights of its corners there, and the rounding error.
static inline void R(triangle_point)(vr corner[3][3], double scale, const vr from[3], const vr d[3], vr w[3],
                                     vr point[3], vr *slack)
{
    vr p[3][3], f[3], g[3];
    R(relative_corners)(corner, from, scale, p);
    const R(ray_edges) edges = R(make_ray_edges)(p, d, false);
    const vr inverse = r_set(1) / R(det)(&edges);
    for (int j = 0; j < 3; j++)
        w[j] = edges.e[j] * inverse;
    for (int k = 0; k < 3; k++) {
        f[k] = corner[1][k] - corner[0][k];
        g[k] = corner[2][k] - corner[0][k];
        point[k] = corner[0][k] + (w[1] * f[k] + w[2] * g[k]);
    }
    *slack = r_set(GLINT_POINT_SLACK) * ((R(largest)(f) + R(largest)(g)) + R(largest)(point));
}

/// Computes the interpolated normal, on the side of `facing`, the geometric normal on the viewer's side.
static inline void R(smooth_normal)(vr corner[3][3], const vr w[3], const vr flat[3], const vr facing[3], vr out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = (w[0] * corner[0][k] + w[1] * corner[1][k]) + w[2] * corner[2][k];
    const vr l = DOT(out, out), length = r_sqrt(l);
    const rm defined = r_lt(r_set(0), l);
    for (int k = 0; k < 3; k++)
        out[k] = r_select(defined, out[k] / length, flat[k]);
    const rm away = r_lt(DOT(out, facing), r_set(0));
    for (int k = 0; k < 3; k++)
        out[k] = r_select(away, -out[k], out[k]);
}

/// Moves a point of a triangle towards the surface that the normals at its corners describe: by `share` of the mean
/// distance to their tangent planes, of those above the point. facing: the geometric normal on the viewer's side.
static inline void R(toward_curve)(vr corner[3][3], vr normal[3][3], const vr w[3], const vr facing[3], vr share,
                                   vr point[3])
{
    const vr zero = r_set(0);
    vr sum[3] = { zero, zero, zero }, curved[3];
    for (int k = 0; k < 3; k++)
        curved[k] = (w[0] * normal[0][k] + w[1] * normal[1][k]) + w[2] * normal[2][k];
    const rm away = r_lt(DOT(curved, facing), zero);
    for (int j = 0; j < 3; j++) {
        const vr q[3] = { point[0] - corner[j][0], point[1] - corner[j][1], point[2] - corner[j][2] };
        const vr l = DOT(normal[j], normal[j]), h = DOT(normal[j], q), below = r_min(r_select(away, -h, h), zero);
        const vr move = r_select(r_lt(zero, l), (w[j] * r_select(away, -below, below)) / l, zero);
        for (int k = 0; k < 3; k++)
            sum[k] = sum[k] + move * normal[j][k];
    }
    for (int k = 0; k < 3; k++)
        point[k] = point[k] - share * sum[k];
}

// ---- Occlude ----

/// A triangle's plane.
typedef struct R(triangle_plane) {
    vr m[3]; ///< normal, not unit
    vr light; ///< signed value whose sign is the side of the plane that the light is on
    vr size[3]; ///< sum of the absolute values of the terms of m
} R(triangle_plane);

/// Computes a triangle's plane. light: the light's position, or the direction towards it.
static inline R(triangle_plane) R(plane_of)(vr corner[3][3], double scale, const vr light[3], bool directional)
{
    R(triangle_plane) plane;
    vr f[3], g[3], q[3];
    for (int k = 0; k < 3; k++) {
        f[k] = (corner[1][k] - corner[0][k]) * r_set(scale);
        g[k] = (corner[2][k] - corner[0][k]) * r_set(scale);
        q[k] = light[k];
        if (!directional)
            q[k] = q[k] - corner[0][k];
    }
    for (int k = 0; k < 3; k++) {
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        const vr a = f[x] * g[y], b = f[y] * g[x];
        plane.m[k] = a - b;
        plane.size[k] = R(abs)(a) + R(abs)(b);
    }
    plane.light = DOT(plane.m, q);
    return plane;
}

/// For points in the triangle's plane, returns the lanes in which the triangle separates the point from the light: the
/// point touches the triangle, and the light is not on the viewer's side. ray: the directions of the viewer's rays.
static inline rm R(parts_from_light)(vr p[3][3], const vr d[3], const R(ray_edges) * edges,
                                     const R(triangle_plane) * plane, vr slack, double scale, const vr ray[3])
{
    const vr zero = r_set(0);
    vr r = zero;
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            r = r_max(r, R(abs)(p[j][k]));
    const vr loose = r_set(2) * (slack * r_set(scale)) + r_set(GLINT_POINT_SLACK) * r;
    const vr move = R(abs)(edges->dz) * loose;
    const vr reach = move * (edges->reach + r_set(2) * move);
    const vr away = DOT(plane->m, ray);
    const rm other_side =
        rm_or(rm_and(r_lt(away, zero), r_lt(plane->light, zero)), rm_and(r_lt(zero, away), r_lt(zero, plane->light)));
    rm parts = rm_and(other_side, R(within)(edges, reach));
    if (!rm_bits(parts))
        return parts;
    parts = rm_and(parts, R(between_corners)(p, d, move)); // if the light is in this plane, all edges are within reach
    for (int k = 0; k < 3; k++) { // it is possible that the triangle is behind the point
        const vr low = r_min(r_min(p[0][k], p[1][k]), p[2][k]), high = r_max(r_max(p[0][k], p[1][k]), p[2][k]);
        parts = rm_and(parts, rm_and(r_le(low, loose), r_le(-loose, high)));
    }
    return parts;
}

/// Returns the segments, from points of other surfaces, that the triangle blocks.
static inline rm R(triangle_blocks)(vr corner[3][3], double scale, const vr point[3], const vr d[3], vr slack,
                                    const R(triangle_plane) * plane, const vr ray[3])
{
    const vr zero = r_set(0);
    vr p[3][3], q[3];
    R(relative_corners)(corner, point, scale, p);
    for (int k = 0; k < 3; k++)
        q[k] = point[k] - corner[0][k];
    const vr h = DOT(plane->m, q);
    const vr spread = (R(abs)(plane->m[0]) + R(abs)(plane->m[1])) + R(abs)(plane->m[2]);
    const vr rounding = (plane->size[0] * R(abs)(q[0]) + plane->size[1] * R(abs)(q[1])) + plane->size[2] * R(abs)(q[2]);
    const vr bound = spread * R(abs)(slack) + r_set(GLINT_POINT_SLACK) * rounding;
    const rm in_plane = r_le(R(abs)(h), bound), on = rm_and(r_lt(zero, slack), in_plane);
    const bool any_on = rm_bits(on);
    const R(ray_edges) edges = R(make_ray_edges)(p, d, any_on);
    const vr det = R(det)(&edges);
    const rm crosses =
        rm_or(rm_and(r_lt(h, zero), r_lt(zero, plane->light)), rm_and(r_lt(zero, h), r_lt(plane->light, zero)));
    const rm through = rm_and(R(passes)(&edges, p, d), rm_or(r_lt(det, zero), r_lt(zero, det)));
    const rm blocks = rm_andnot(rm_and(crosses, through), in_plane);
    if (!any_on)
        return blocks;
    return rm_or(blocks, rm_and(on, R(parts_from_light)(p, d, &edges, plane, slack, scale, ray)));
}

#endif
