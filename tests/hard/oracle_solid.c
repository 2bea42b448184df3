#include "tests/hard/oracle_solid.h"

#include <math.h>

__extension__ typedef _Float128 quad;

typedef struct frame_of {
    quad m[3][3], inverse[3][3], center[3]; ///< x = center + m k
    quad normals[3][3]; ///< transpose of inverse
} frame_of;

/// A ray in the unit shape's frame.
typedef struct unit_ray {
    quad f[3], e[3];
} unit_ray;

static quad size_of(quad x) { return x < 0 ? -x : x; }

static quad dot(const quad u[3], const quad v[3]) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

// ---- The map from the unit shape ----

/// Two unit vectors square to a third.
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

/// The shape as described, before its transform.
static void described(const glint_shape_desc *desc, frame_of *frame)
{
    quad center[3], along[3];
    *frame = (frame_of) { .m = { { 0 } } };
    for (int c = 0; c < 3; c++) {
        const quad base = desc->base[c], top = desc->top[c];
        const bool cone = desc->kind == GLINT_SHAPE_CONE, disk = desc->kind == GLINT_SHAPE_DISK;
        center[c] = cone ? top : disk ? desc->center[c] : (base + top) / 2;
        along[c] = cone ? base - top : disk ? desc->normal[c] : (top - base) / 2;
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
    if (desc->kind == GLINT_SHAPE_DISK) { // it has no height; any unit of it will do
        const quad length = sqrtf128(dot(along, along));
        for (int c = 0; c < 3; c++)
            along[c] *= desc->radius / length;
    }
    set_round(frame, center, along, desc->radius);
}

static void transformed(const glint_transform *map, frame_of *frame)
{
    const frame_of from = *frame;
    for (int i = 0; i < 3; i++) {
        frame->center[i] = map->m[i][3];
        for (int k = 0; k < 3; k++) {
            frame->center[i] += map->m[i][k] * from.center[k];
            frame->m[i][k] = 0;
            for (int j = 0; j < 3; j++)
                frame->m[i][k] += map->m[i][j] * from.m[j][k];
        }
    }
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

static quad norm_of(quad m[3][3])
{
    quad sum = 0;
    for (int i = 0; i < 3; i++)
        sum += dot(m[i], m[i]);
    return sqrtf128(sum);
}

// ---- The unit shapes, grown by g (shrunk where it is below 0) ----

typedef struct span {
    bool hit;
    quad t[2];
} span;

static void cut(span *s, quad from, quad to)
{
    s->t[0] = from > s->t[0] ? from : s->t[0];
    s->t[1] = to < s->t[1] ? to : s->t[1];
    s->hit = s->hit && s->t[0] <= s->t[1];
}

static void cut_slab(span *s, quad f, quad e, quad low, quad high)
{
    if (e == 0) {
        s->hit = s->hit && f >= low && f <= high;
        return;
    }
    const quad a = (low - f) / e, b = (high - f) / e;
    cut(s, a < b ? a : b, a < b ? b : a);
}

/// a t^2 + 2 b t + c <= 0
static void cut_quadric(span *s, quad a, quad b, quad c)
{
    const quad disc = b * b - a * c;
    if (a == 0) {
        s->hit = s->hit && c <= 0;
        return;
    }
    if (disc < 0) {
        s->hit = false;
        return;
    }
    const quad root = sqrtf128(disc), q = b > 0 ? -b - root : -b + root, t0 = q / a, t1 = q == 0 ? t0 : c / q;
    cut(s, t0 < t1 ? t0 : t1, t0 < t1 ? t1 : t0);
}

/// x^2 + y^2 <= (z + g)^2 for z >= -g: the half of the double cone.
static void cut_cone(span *s, const unit_ray *r, quad g, quad base)
{
    const quad z = r->f[2] + g, ez = r->e[2];
    const quad a = r->e[0] * r->e[0] + r->e[1] * r->e[1] - ez * ez, b = r->f[0] * r->e[0] + r->f[1] * r->e[1] - z * ez,
               c = r->f[0] * r->f[0] + r->f[1] * r->f[1] - z * z, disc = b * b - a * c;
    cut_slab(s, z, ez, 0, base + g);
    if (!s->hit)
        return;
    if (a == 0 && b == 0) {
        s->hit = c <= 0;
    } else if (a == 0) {
        const quad t = -c / (2 * b);
        if (b > 0)
            cut(s, s->t[0], t);
        else
            cut(s, t, s->t[1]);
    } else if (a > 0 || disc < 0) {
        if (disc < 0)
            s->hit = s->hit && a < 0;
        else
            cut_quadric(s, a, b, c);
    } else { // steeper than the side: outside between the roots; within z >= 0 one of the two ends is left
        const quad root = sqrtf128(disc), q = b > 0 ? -b - root : -b + root, t0 = q / a, t1 = q == 0 ? t0 : c / q;
        if (ez > 0)
            cut(s, t0 < t1 ? t1 : t0, s->t[1]);
        else
            cut(s, s->t[0], t0 < t1 ? t0 : t1);
    }
}

static span meet(const glint_shape_desc *desc, const unit_ray *r, quad g)
{
    const quad huge = (quad)HUGE_VAL;
    quad one = 1 + g;
    const quad aa = r->e[0] * r->e[0] + r->e[1] * r->e[1], bb = r->f[0] * r->e[0] + r->f[1] * r->e[1],
               cc = r->f[0] * r->f[0] + r->f[1] * r->f[1];
    span s = { true, { -huge, huge } };
    switch (desc->kind) {
    case GLINT_SHAPE_SPHERE:
        cut_quadric(&s, aa + r->e[2] * r->e[2], bb + r->f[2] * r->e[2], cc + r->f[2] * r->f[2] - one * one);
        break;
    case GLINT_SHAPE_BOX:
        for (int c = 0; c < 3; c++)
            cut_slab(&s, r->f[c], r->e[c], -one, one);
        break;
    case GLINT_SHAPE_CYLINDER:
        cut_quadric(&s, aa, bb, cc - one * one);
        cut_slab(&s, r->f[2], r->e[2], -one, one);
        break;
    case GLINT_SHAPE_CONE:
        cut_cone(&s, r, g, 1 + g);
        break;
    default: { // a disk: a plane off by g moves the point on it by as much, times how flat the ray is
        if (r->e[2] == 0)
            return (span) { false, { 0, 0 } };
        const quad t = -r->f[2] / r->e[2], x = r->f[0] + t * r->e[0], y = r->f[1] + t * r->e[1];
        one += g * sqrtf128(aa) / size_of(r->e[2]);
        if (one < 0)
            one = 0;
        s = (span) { x * x + y * y <= one * one, { t, t } };
    }
    }
    return s;
}

/// The end of the span that is the first ahead: 0, 1; 2: none.
static int first_ahead(const span *s) { return !s->hit ? 2 : s->t[0] > 0 ? 0 : s->t[1] > 0 ? 1 : 2; }

/// The outward normal of the unit shape at a point of its surface, by which of its parts the point is nearest; *edge: two
/// are as near.
static void unit_normal(const glint_shape_desc *desc, const quad k[3], quad margin, quad n[3], bool *edge)
{
    const quad round = sqrtf128(k[0] * k[0] + k[1] * k[1]);
    quad off[4] = { 0, 0, 0, 0 };
    int parts = 0, best = 0;
    n[0] = n[1] = n[2] = 0;
    *edge = false;
    if (desc->kind == GLINT_SHAPE_SPHERE) {
        for (int c = 0; c < 3; c++)
            n[c] = k[c];
        return;
    }
    if (desc->kind == GLINT_SHAPE_DISK) {
        n[2] = 1;
        return;
    }
    if (desc->kind == GLINT_SHAPE_BOX) {
        for (; parts < 3; parts++)
            off[parts] = size_of(size_of(k[parts]) - 1);
    } else {
        off[parts++] = size_of(size_of(k[2]) - 1); // an end
        off[parts++] = size_of(round - (desc->kind == GLINT_SHAPE_CONE ? k[2] : 1));
    }
    for (int i = 1; i < parts; i++)
        best = off[i] < off[best] ? i : best;
    for (int i = 0; i < parts; i++)
        *edge = *edge || (i != best && off[i] < 16 * margin);
    *edge = *edge || (desc->kind == GLINT_SHAPE_CONE && round < 16 * margin); // its apex
    if (desc->kind == GLINT_SHAPE_BOX) {
        n[best] = k[best] > 0 ? 1 : -1;
    } else if (best == 0) {
        n[2] = k[2] > 0 ? 1 : -1;
    } else {
        n[0] = k[0] / round;
        n[1] = k[1] / round;
        n[2] = desc->kind == GLINT_SHAPE_CONE ? -1 : 0;
    }
}

static void set_normal(const hard_ray *ray, const quad n[3], solid_truth *out)
{
    const quad d[3] = { ray->d[0], ray->d[1], ray->d[2] }, length = sqrtf128(dot(n, n));
    for (int c = 0; c < 3; c++)
        out->n[c] = (double)(n[c] / length);
    out->cosine = (double)(size_of(dot(n, d)) / (length * sqrtf128(dot(d, d))));
}

static void bracket(const span *exact, const span *grown, const span *shrunk, solid_truth *out)
{
    const int end = first_ahead(exact);
    out->hit = end < 2;
    out->close = first_ahead(grown) != end || first_ahead(shrunk) != end;
    if (out->close || end == 2)
        return;
    const quad a = grown->t[end], b = shrunk->t[end];
    out->t = (double)exact->t[end];
    out->least = (double)(a < b ? a : b);
    out->most = (double)(a < b ? b : a);
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
    const quad reach = sqrtf128(dot(r.f, r.f)) + 2 + norm_of(frame.inverse) * sqrtf128(dot(frame.center, frame.center));
    const quad margin = rounding * (quad)0x1p-53 * norm_of(frame.m) * norm_of(frame.inverse) * reach;
    const span s = meet(desc, &r, 0), more = meet(desc, &r, margin), less = meet(desc, &r, -margin);
    bracket(&s, &more, &less, &out);
    if (desc->kind == GLINT_SHAPE_DISK) {
        out.least -= (double)(margin / size_of(r.e[2]));
        out.most += (double)(margin / size_of(r.e[2]));
    }
    if (margin > 1e-3 || (desc->kind == GLINT_SHAPE_DISK && size_of(r.f[2]) < 4 * margin))
        out.close = true; // nothing to hold on to; or in the disk's plane
    if (out.hit && !out.close) {
        const quad t = s.t[first_ahead(&s)];
        quad k[3], g[3], n[3];
        for (int c = 0; c < 3; c++)
            k[c] = r.f[c] + t * r.e[c];
        unit_normal(desc, k, margin, g, &out.edge);
        for (int c = 0; c < 3; c++)
            n[c] = dot(frame.normals[c], g);
        set_normal(ray, n, &out);
        const quad moved = (out.most - out.least) * sqrtf128(dot(r.e, r.e)) + margin;
        const quad bend =
            desc->kind == GLINT_SHAPE_SPHERE || (desc->kind != GLINT_SHAPE_BOX && g[0] * g[0] + g[1] * g[1] > 0)
                ? 4 / (desc->kind == GLINT_SHAPE_CONE ? k[2] : 1)
                : 0;
        out.turn = (double)(bend * moved * norm_of(frame.m) * norm_of(frame.inverse));
    }
    return out;
}

// ---- Triangles ----

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
    for (int j = 0; j < 3; j++) { // d . (p_k x p_i): which side of an edge the ray passes on
        const quad *a = p[(j + 1) % 3], *b = p[(j + 2) % 3];
        e[j] = d[0] * (a[1] * b[2] - a[2] * b[1]) + d[1] * (a[2] * b[0] - a[0] * b[2]) +
               d[2] * (a[0] * b[1] - a[1] * b[0]);
    }
    const quad det = e[0] + e[1] + e[2], length = sqrtf128(dot(d, d)), turn = det < 0 ? -1 : 1;
    // each edge is made of differences of products of two such numbers and a component of d
    const quad off = rounding * (quad)0x1p-53 * reach * reach * length;
    const quad least = turn * (turn * e[0] < turn * e[1] ? (turn * e[0] < turn * e[2] ? e[0] : e[2])
                                                         : (turn * e[1] < turn * e[2] ? e[1] : e[2]));
    const quad t = det == 0 ? 0 : dot(n, p[0]) / dot(n, d);
    out.hit = det != 0 && least >= 0 && t > 0;
    const quad moved = det == 0 ? 0 : 4 * off * (reach / length + size_of(t)) / size_of(det);
    out.close = size_of(least) < off || size_of(det) < 64 * off || size_of(t) < moved;
    out.t = (double)t;
    out.least = (double)(t - moved);
    out.most = (double)(t + moved);
    set_normal(ray, n, &out);
    return out;
}

solid_truth oracle_solid(const hard_ray *ray, const hard_solid *solid, double rounding)
{
    return solid->is_triangle ? of_triangle(ray, solid->corner, rounding) : of_solid(ray, &solid->desc, rounding);
}
