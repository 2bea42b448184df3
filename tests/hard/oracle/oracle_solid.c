#include "tests/hard/oracle/oracle_solid.h"
#include "tests/hard/oracle/oracle_unit.h"

#include <math.h>

typedef struct frame_of {
    quad m[3][3], inverse[3][3], center[3]; ///< x = center + m k, for a point k of the unit shape
    quad normals[3][3]; ///< the transpose of inverse
    quad extent, place; ///< norms of m and center, without cancellation in their sums
    quad condition; ///< extent times the norm of inverse, the map's condition
} frame_of;

static quad size_of(quad x) { return x < 0 ? -x : x; }

static quad dot(const quad u[3], const quad v[3]) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

static quad norm_of(quad m[3][3])
{
    quad sum = 0;
    for (int i = 0; i < 3; i++)
        sum += dot(m[i], m[i]);
    return sqrtf128(sum);
}

static bool is_torus(const glint_shape_desc *desc) { return desc->kind == GLINT_SHAPE_TORUS; }

// ---- The map from the unit shape ----

/// Computes two unit vectors perpendicular to a third.
static void square_to(const quad along[3], quad x[3], quad y[3])
{
    const quad length = sqrtf128(dot(along, along));
    const int least = size_of(along[0]) <= size_of(along[1]) && size_of(along[0]) <= size_of(along[2]) ? 0
                      : size_of(along[1]) <= size_of(along[2])                                         ? 1
                                                                                                       : 2;
    quad axis[3] = { 0, 0, 0 }, norm;
    axis[least] = 1;
    for (int c = 0; c < 3; c++)
        x[c] = axis[(c + 1) % 3] * along[(c + 2) % 3] - axis[(c + 2) % 3] * along[(c + 1) % 3];
    norm = sqrtf128(dot(x, x));
    for (int c = 0; c < 3; c++)
        x[c] /= norm;
    for (int c = 0; c < 3; c++)
        y[c] = (along[(c + 1) % 3] * x[(c + 2) % 3] - along[(c + 2) % 3] * x[(c + 1) % 3]) / length;
}

static void set_round(frame_of *frame, const quad center[3], const quad along[3], double radius)
{
    quad x[3], y[3];
    square_to(along, x, y);
    for (int c = 0; c < 3; c++) {
        frame->m[c][0] = radius * x[c];
        frame->m[c][1] = radius * y[c];
        frame->m[c][2] = along[c];
        frame->center[c] = center[c];
    }
}

/// Computes the frame of the shape as its description says, before its transform.
static void described(const glint_shape_desc *desc, frame_of *frame)
{
    quad center[3], along[3];
    *frame = (frame_of) { .m = { { 0 } } };
    for (int c = 0; c < 3; c++) {
        const quad base = desc->base[c], top = desc->top[c];
        const bool cone = desc->kind == GLINT_SHAPE_CONE, disk = desc->kind == GLINT_SHAPE_DISK, torus = is_torus(desc);
        center[c] = cone ? top : disk || torus ? desc->center[c] : (base + top) / 2;
        along[c] = cone ? base - top : disk ? desc->normal[c] : torus ? desc->axis[c] : (top - base) / 2;
    }
    if (desc->kind == GLINT_SHAPE_BOX || desc->kind == GLINT_SHAPE_SPHERE) {
        for (int c = 0; c < 3; c++) {
            const quad low = desc->min[c], high = desc->max[c];
            const bool box = desc->kind == GLINT_SHAPE_BOX;
            frame->m[c][c] = box ? (high - low) / 2 : desc->radius;
            frame->center[c] = box ? (high + low) / 2 : desc->center[c];
        }
        return;
    }
    const double radius = is_torus(desc) ? desc->major : desc->radius;
    if (desc->kind == GLINT_SHAPE_DISK || is_torus(desc)) { // a disk has no height, so any unit will do
        const quad length = sqrtf128(dot(along, along));
        for (int c = 0; c < 3; c++)
            along[c] *= radius / length;
    }
    set_round(frame, center, along, radius);
}

static void transformed(const glint_transform *map, frame_of *frame)
{
    const frame_of from = *frame;
    quad sums[3][3] = { { 0 } }, places[3];
    for (int i = 0; i < 3; i++) {
        frame->center[i] = map->m[i][3];
        places[i] = size_of(map->m[i][3]);
        for (int k = 0; k < 3; k++) {
            frame->center[i] += map->m[i][k] * from.center[k];
            places[i] += size_of(map->m[i][k] * from.center[k]);
            frame->m[i][k] = 0;
            for (int j = 0; j < 3; j++) {
                frame->m[i][k] += map->m[i][j] * from.m[j][k];
                sums[i][k] += size_of(map->m[i][j] * from.m[j][k]);
            }
        }
    }
    frame->extent = norm_of(sums);
    frame->place = sqrtf128(dot(places, places));
}

static void invert(frame_of *frame)
{
    quad determinant = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3, c = (k + 1) % 3, d = (k + 2) % 3;
            frame->normals[i][k] = frame->m[a][c] * frame->m[b][d] - frame->m[a][d] * frame->m[b][c];
        }
    for (int k = 0; k < 3; k++)
        determinant += frame->m[0][k] * frame->normals[0][k];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            frame->normals[i][k] /= determinant;
            frame->inverse[k][i] = frame->normals[i][k];
        }
    frame->condition = frame->extent * norm_of(frame->inverse);
}

static void to_unit(const frame_of *frame, const hard_ray *ray, unit_ray *out)
{
    quad f[3], d[3];
    for (int c = 0; c < 3; c++) {
        f[c] = ray->o[c] - frame->center[c];
        d[c] = ray->d[c];
    }
    for (int c = 0; c < 3; c++) {
        out->f[c] = dot(frame->inverse[c], f);
        out->e[c] = dot(frame->inverse[c], d);
    }
}

static void add_normal(solid_truth *out, const quad n[3], quad turn)
{
    const quad length = sqrtf128(dot(n, n));
    solid_normal *next = &out->normal[out->normals++];
    for (int c = 0; c < 3; c++)
        next->n[c] = (double)(n[c] / length);
    next->turn = (double)turn;
}

/// Adds the acceptable normals where the ray hits the shape, at t.
static void add_normals(const glint_shape_desc *desc, const frame_of *frame, const unit_ray *r, quad margin,
                        const unit_span *grown, int end, quad t, solid_truth *out)
{
    const quad moved = (out->most - out->least) * sqrtf128(dot(r->e, r->e)) + margin;
    const quad x = r->f[0] + t * r->e[0], y = r->f[1] + t * r->e[1];
    if (desc->kind == GLINT_SHAPE_CONE && sqrtf128(x * x + y * y) < 16 * margin)
        return; // the hit is at the apex
    for (int part = 0; part < unit_parts(desc); part++) {
        quad g[3], n[3];
        if (!unit_may_end(desc, part, r, margin, end, grown))
            continue;
        unit_normal(desc, part, r, end, t, g);
        for (int c = 0; c < 3; c++)
            n[c] = dot(frame->normals[c], g);
        add_normal(out, n, 4 * unit_bend(desc, part, r, t) * moved * frame->condition);
    }
}

static void bracket(const unit_span *exact, const unit_span *grown, const unit_span *shrunk, solid_truth *out)
{
    const int end = unit_first_ahead(exact);
    out->hit = end < 2;
    out->close = unit_first_ahead(grown) != end || unit_first_ahead(shrunk) != end;
    if (out->close || end == 2)
        return;
    const quad a = grown->t[end], b = shrunk->t[end];
    out->t = (double)exact->t[end];
    out->least = (double)(a < b ? a : b);
    out->most = (double)(a < b ? b : a);
}

/// Returns how far rounding may move each part of the unit shape: 2^-53 times `rounding`, the condition and the
/// reach.
///
/// Let x = c + M k, M = T F: the shape's frame F under its transform T. Each column of F is off by a few
/// roundings, and the engine's M by nine roundings of the sums in |T| |F|. These move k by |M^-1| |T||F| |k|, the
/// condition times |k|. The elements of the inverse are cofactors (two roundings, despite cancellation) over the
/// determinant (three of |row| |cofactors|, so three of the condition, common to all) and one more: six. Its products
/// with x - c are of size |M^-1| |M k|, and so are the errors of their sums: three roundings of the condition times
/// |k|, one in x - c. The error of c, four roundings of |T| |c| and the translation, is multiplied by |M^-1|. So at
/// both ends of the ray's path to the shape, at f and at a |k| below 2, the error is some twenty roundings of the
/// condition times the reach below. Solving adds a few of the reach only, provided it squares nothing much longer
/// than the result. The norms here are Frobenius norms: their product, the condition, is at least 3, with equality
/// for conformal maps. Eight times the condition are two dozen roundings.
static quad margin_of(const frame_of *frame, const unit_ray *r, double rounding)
{
    const quad reach = sqrtf128(dot(r->f, r->f)) + 2 + frame->condition / frame->extent * frame->place;
    return rounding * (quad)0x1p-53 * frame->condition * reach;
}

static solid_truth of_solid(const hard_ray *ray, const glint_shape_desc *desc, double rounding)
{
    solid_truth out = { 0 };
    frame_of frame;
    unit_ray r;
    described(desc, &frame);
    transformed(&desc->transform, &frame);
    invert(&frame);
    to_unit(&frame, ray, &r);
    const quad margin = margin_of(&frame, &r, rounding);
    const unit_span s = unit_meet(desc, &r, 0), more = unit_meet(desc, &r, margin), less = unit_meet(desc, &r, -margin);
    bracket(&s, &more, &less, &out);
    if (desc->kind == GLINT_SHAPE_DISK) {
        out.least -= (double)(margin / size_of(r.e[2]));
        out.most += (double)(margin / size_of(r.e[2]));
    }
    if (margin > 1e-3 * (is_torus(desc) ? desc->minor / desc->major : 1) || (desc->kind == GLINT_SHAPE_DISK && size_of(r.f[2]) < 4 * margin))
        out.close = true; // the result is too imprecise to judge, or the ray is in the disk's plane
    const int end = unit_first_ahead(&s);
    if (out.hit && !out.close)
        add_normals(desc, &frame, &r, margin, &more, end, s.t[end], &out);
    return out;
}

// ---- Triangles ----

/// Returns whether the engine treats a point as in the plane, so that a ray from there does not hit it: n . q is less
/// than ON_PLANE of the sum of its terms, n = f x g. The rounding error is half of that.
#define ON_PLANE (17 * (quad)0x1p-53)

static bool is_on_plane(const quad f[3], const quad g[3], const quad n[3], const quad q[3])
{
    quad sizes = 0;
    for (int c = 0; c < 3; c++) {
        const int i = (c + 1) % 3, k = (c + 2) % 3;
        sizes += (size_of(f[i] * g[k]) + size_of(f[k] * g[i])) * size_of(q[c]);
    }
    return size_of(dot(n, q)) < ON_PLANE * sizes;
}

static solid_truth of_triangle(const hard_ray *ray, const double corner[3][3], double rounding)
{
    solid_truth out = { 0 };
    quad p[3][3], f[3], g[3], n[3], d[3], e[3], reach = 0;
    for (int j = 0; j < 3; j++)
        for (int c = 0; c < 3; c++) {
            p[j][c] = (quad)corner[j][c] - ray->o[c];
            reach = size_of(p[j][c]) > reach ? size_of(p[j][c]) : reach;
            d[c] = ray->d[c];
            f[c] = (quad)corner[1][c] - corner[0][c];
            g[c] = (quad)corner[2][c] - corner[0][c];
        }
    for (int c = 0; c < 3; c++) {
        const int i = (c + 1) % 3, k = (c + 2) % 3;
        n[c] = f[i] * g[k] - f[k] * g[i];
    }
    for (int j = 0; j < 3; j++) { // d . (p_k x p_i): the side of an edge on which the ray passes
        const quad *a = p[(j + 1) % 3], *b = p[(j + 2) % 3];
        e[j] = d[0] * (a[1] * b[2] - a[2] * b[1]) + d[1] * (a[2] * b[0] - a[0] * b[2]) +
               d[2] * (a[0] * b[1] - a[1] * b[0]);
    }
    const quad det = e[0] + e[1] + e[2], length = sqrtf128(dot(d, d)), turn = det < 0 ? -1 : 1;
    // each edge consists of differences of products of two such numbers and a component of d
    const quad off = rounding * (quad)0x1p-53 * reach * reach * length;
    const quad least = turn * (turn * e[0] < turn * e[1] ? (turn * e[0] < turn * e[2] ? e[0] : e[2])
                                                         : (turn * e[1] < turn * e[2] ? e[1] : e[2]));
    const quad t = det == 0 ? 0 : dot(n, p[0]) / dot(n, d);
    out.hit = det != 0 && least >= 0 && t > 0;
    const quad moved = det == 0 ? 0 : 4 * off * (reach / length + size_of(t)) / size_of(det);
    out.close = size_of(least) < off || size_of(det) < 64 * off || size_of(t) < moved || is_on_plane(f, g, n, p[0]);
    out.t = (double)t;
    out.least = (double)(t - moved);
    out.most = (double)(t + moved);
    add_normal(&out, n, 0);
    return out;
}

solid_truth oracle_solid(const hard_ray *ray, const hard_solid *solid, double rounding)
{
    return solid->is_triangle ? of_triangle(ray, solid->corner, rounding) : of_solid(ray, &solid->desc, rounding);
}
