// solid: affine images of the unit ball, cube, cylinder, cone and disk, and of the open sides of cylinder and cone,
// for cast, surface and occlude. The torus, which is not convex, is in torus.h. The ray is transformed to the space
// of the unit shape; its t stays the same. Contract: stages.h.
#ifndef GLINT_CAST_SOLID_H
#define GLINT_CAST_SOLID_H

#include "engine/render/stages/cast/face.h"
#include "engine/render/stages/cast/torus.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

/// The points where a ray enters and leaves a solid.
typedef struct R(span) {
    vr t[2];
    rm hit;
    rm second; ///< t[1] is a hit: for an open form, a hit of the curved side
    rm flat[2]; ///< lanes in which each end is on a flat face, not on the curved side
    vr face[2]; ///< the face: 1 + its axis in the space of the unit shape, negative if the face's outward normal
        ///< points in the negative direction of that axis
} R(span);

static inline void R(to_unit)(const glint_solid *solid, const vr v[3], vr out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = (r_set(solid->inverse[k][0]) * v[0] + r_set(solid->inverse[k][1]) * v[1]) +
                 r_set(solid->inverse[k][2]) * v[2];
}

/// Computes the offset from the solid's centre to a point, in the space of the unit shape.
static inline void R(unit_offset)(const glint_solid *solid, const glint_prim *prim, const vr point[3], vr out[3])
{
    const vr away[3] = { point[0] - r_set(prim->center[0]), point[1] - r_set(prim->center[1]),
                         point[2] - r_set(prim->center[2]) };
    R(to_unit)(solid, away, out);
}

/// The constants of a solid that depend on the rays' origins.
typedef struct R(solid_start) {
    vr f[3]; ///< vector from the centre to the origin, in the space of the unit shape; unused for a box
    const vr *origin; ///< the rays' origins
    const real *height; ///< heights of the origin over the faces, if all rays have the same origin; NULL: cut_by_slab
        ///< computes the heights
} R(solid_start);

static inline void R(start_at)(const glint_solid *solid, const glint_prim *prim, const vr origin[3],
                               R(solid_start) * start)
{
    start->origin = origin;
    start->height = NULL;
    if (solid->form != GLINT_FORM_BOX)
        R(unit_offset)(solid, prim, origin, start->f);
}

static inline real R(first_lane)(vr x)
{
    _Alignas(64) real lanes[VR];
    r_store(lanes, x);
    return lanes[0];
}

/// Computes the same data for rays that all start at the eye, as single numbers instead of vectors, also for a box.
static void R(start_at_eye)(const glint_solid *solid, const glint_prim *prim, const double eye[3], real f[3],
                            real height[6])
{
    const vr origin[3] = { r_set(eye[0]), r_set(eye[1]), r_set(eye[2]) };
    vr offset[3];
    R(unit_offset)(solid, prim, origin, offset);
    for (int k = 0; k < 3; k++)
        f[k] = R(first_lane)(offset[k]);
    for (int i = 0; i < 2 * glint_slab_count(solid->form); i++)
        height[i] = R(first_lane)(R(face_height)(&solid->faces[i], origin));
}

/// Clips the span to a pair of faces; `axis`: the axis of the unit shape that the faces are perpendicular to. flats:
/// whether span->flat is wanted; faces, a constant: whether span->face is wanted, too.
INNER void R(cut_by_slab)(R(span) * span, const glint_solid *solid, const R(solid_start) * start, const vr d[3], int slab,
                          int axis, const bool flats, const bool faces)
{
    const vr zero = r_set(0);
    vr height[2] = { zero, zero };
    const vr rise = R(over_slab)(solid->faces + 2 * slab, start->height ? NULL : start->origin, d, height),
             fall = -rise;
    const vr below = start->height ? r_set(start->height[2 * slab]) : height[0],
             above = start->height ? r_set(start->height[2 * slab + 1]) : height[1];
    const rm rising = r_lt(zero, rise), parallel = r_eq(rise, zero);
    vr enter = r_select(rising, below, above) / fall, leave = r_select(rising, above, below) / fall;
    if (rm_bits(parallel)) {
        enter = r_select(parallel, r_set(-HUGE_VAL), enter);
        leave = r_select(parallel, r_set(HUGE_VAL), leave);
        span->hit = rm_andnot(span->hit, rm_and(parallel, rm_or(r_lt(below, zero), r_lt(zero, above))));
    }
    if (flats || faces) {
        const rm later = r_lt(span->t[0], enter), sooner = r_lt(leave, span->t[1]);
        const vr up = r_set(axis + 1), down = r_set(-axis - 1);
        span->flat[0] = rm_or(span->flat[0], later);
        span->flat[1] = rm_or(span->flat[1], sooner);
        span->face[0] = faces ? r_select(later, r_select(rising, down, up), span->face[0]) : zero;
        span->face[1] = faces ? r_select(sooner, r_select(rising, up, down), span->face[1]) : zero;
    }
    span->t[0] = r_max(enter, span->t[0]);
    span->t[1] = r_min(leave, span->t[1]);
}

/// Returns whether no ray can hit the solid, given the span that is left.
INNER bool R(is_spent)(R(span) * span)
{
    span->hit = rm_and(span->hit, rm_and(r_le(span->t[0], span->t[1]), r_lt(r_set(0), span->t[1])));
    return rm_bits(span->hit) == 0;
}

/// Clips the span of a cylinder or cone to its ends.
INNER void R(cut_by_ends)(R(span) * span, const glint_solid *solid, const R(solid_start) * start, const vr d[3],
                          const bool faces, const bool whole)
{
    if (whole || !R(is_spent)(span))
        R(cut_by_slab)(span, solid, start, d, 0, 2, faces || is_open(solid), faces);
}

/// Sets both ends of the span to the point where rays hit a disk.
INNER void R(cut_by_disk)(R(span) * span, const glint_solid *solid, const R(solid_start) * start, const vr d[3],
                          const vr e[3])
{
    const vr height = start->height ? r_set(start->height[0]) : R(face_height)(solid->faces, start->origin);
    const vr t = -height / R(face_rise)(solid->faces, d);
    const vr x = start->f[0] + t * e[0], y = start->f[1] + t * e[1];
    span->t[0] = span->t[1] = t;
    span->flat[0] = span->flat[1] = rm_from_bits((1u << VR) - 1);
    span->face[0] = span->face[1] = r_set(3);
    span->hit = r_le(x * x + y * y, r_set(1));
}

/// The inequality a t^2 - 2 b t + c <= 0 and its roots. For b >= 0 the far root is q / a and the near root is c / q;
/// for b < 0 it is the other way round.
typedef struct R(quadratic) {
    vr a, b, c, disc, s, q;
    rm ahead, along; ///< ahead: lanes with b >= 0; along: lanes whose ray is parallel to the axis of a cylinder, and
        ///< fully inside or outside
} R(quadratic);

/// Computes the roots for a sphere (three axes) or cylinder (two). magnitude: the field of the solid.
INNER R(quadratic) R(quadratic_of)(const vr f[3], const vr e[3], bool ball, double magnitude)
{
    const vr zero = r_set(0), one = r_set(1);
    vr a = e[0] * e[0] + e[1] * e[1], b = f[0] * e[0] + f[1] * e[1], c = f[0] * f[0] + f[1] * f[1];
    const vr z = f[0] * e[1] - f[1] * e[0];
    vr cross = z * z;
    if (ball) {
        const vr x = f[1] * e[2] - f[2] * e[1], y = f[2] * e[0] - f[0] * e[2];
        a = a + e[2] * e[2];
        b = b + f[2] * e[2];
        c = c + f[2] * f[2];
        cross = (x * x + y * y) + z * z;
    }
    b = -b;
    c = R(unless_within)(c - one, r_set(GLINT_ON_FACE) * r_set(magnitude));
    const rm near = r_lt(b * b, a);
    const vr disc = r_select(near, b * b - a * c, a - cross);
    const vr s = r_sqrt(r_max(disc, zero));
    const rm ahead = r_le(zero, b), along = rm_andnot(r_le(a, zero), r_lt(a, zero));
    return (R(quadratic)) { a, b, c, disc, s, r_select(ahead, b + s, b - s), ahead, along };
}

INNER void R(cut_round)(R(span) * span, const vr f[3], const vr e[3], bool ball, double magnitude)
{
    const R(quadratic) round = R(quadratic_of)(f, e, ball, magnitude);
    const vr far = round.q / round.a, other = round.c / round.q, zero = r_set(0);
    // puts the ends in order: a solid seen from far away may be thinner than the rounding error
    span->t[0] = r_select(round.along, r_set(-HUGE_VAL), r_min(far, other));
    span->t[1] = r_select(round.along, r_set(HUGE_VAL), r_max(far, other));
    span->hit = rm_or(rm_and(round.along, r_le(round.c, zero)), rm_andnot(r_le(zero, round.disc), round.along));
}

/// Clips the span to the cone x^2 + y^2 <= z^2, z >= 0, with the apex at the origin.
///
/// The coefficients are differences of squares. If the squares of the origin are far greater than those of any hit,
/// too few digits are left: for rays from far away, and for rays along the side of either half of the double cone
/// that pass the apex at less than about a third of the origin's distance from the apex. Such rays are moved to start
/// at their point nearest to the apex, except for rays that start on the side.
INNER void R(cut_cone)(R(span) * span, const vr from[3], const vr e[3], double magnitude)
{
    const vr zero = r_set(0), toward = DOT(from, e), e2 = DOT(e, e), away2 = DOT(from, from);
    const vr side = (from[0] * from[0] + from[1] * from[1]) - from[2] * from[2];
    const vr off = r_set(GLINT_POINT_SLACK) * away2 + (r_set(GLINT_ON_FACE) * r_set(magnitude)) * from[2];
    const rm far_off = r_lt(r_set(16), away2), passes = r_lt(r_set(0.875) * (away2 * e2), toward * toward);
    const rm on = rm_andnot(rm_and(r_lt(zero, from[2]), r_le(r_max(side, -side), off)), far_off);
    const vr move = r_select(rm_or(far_off, rm_andnot(passes, on)), -toward / e2, zero);
    const vr f[3] = { from[0] + move * e[0], from[1] + move * e[1], from[2] + move * e[2] };
    const vr a = (e[0] * e[0] + e[1] * e[1]) - e[2] * e[2];
    const vr c = r_select(on, zero, (f[0] * f[0] + f[1] * f[1]) - f[2] * f[2]);
    const vr b = f[2] * e[2] - (f[0] * e[0] + f[1] * e[1]);
    const vr x = f[1] * e[2] - f[2] * e[1], y = f[2] * e[0] - f[0] * e[2], z = f[0] * e[1] - f[1] * e[0];
    const vr disc = (x * x + y * y) - z * z;
    const vr s = r_sqrt(r_max(disc, zero));
    const rm ahead = r_le(zero, b), steep = r_lt(a, zero), level = rm_andnot(r_le(a, zero), steep);
    const vr q = r_select(ahead, b + s, b - s);
    const vr far = q / a, other = r_select(r_eq(q, zero), far, c / q); // for a ray through the apex, both are 0
    const vr low = r_min(far, other), high = r_max(far, other), single = c / (r_set(2) * b);
    const rm up = r_lt(zero, e[2]);
    // for a ray steeper than the side, one end is on the other half of the double cone; a ray parallel to the side
    // has only one end, on either half
    const rm ours = rm_or(rm_and(up, r_lt(zero, b)), rm_andnot(r_lt(b, zero), up));
    const vr end = r_select(level, single, r_select(up, high, low));
    const rm open = rm_or(steep, level);
    span->t[0] = r_select(open, r_select(up, end, r_set(-HUGE_VAL)), low) + move;
    span->t[1] = r_select(open, r_select(up, r_set(HUGE_VAL), end), high) + move;
    span->hit = rm_or(rm_or(steep, rm_and(level, ours)), rm_andnot(r_le(zero, disc), level));
}

/// Removes the flat ends of a cylinder or cone: a ray through a flat end hits the side once or not at all.
INNER void R(open_ends)(R(span) * span)
{
    const rm none = rm_from_bits(0);
    const vr in = span->t[0];
    span->t[0] = r_select(span->flat[0], span->t[1], in);
    span->t[1] = r_select(span->flat[1], in, span->t[1]);
    span->second = rm_andnot(span->second, span->flat[1]);
    span->hit = rm_andnot(span->hit, rm_and(span->flat[0], span->flat[1]));
    span->flat[0] = span->flat[1] = none;
}

/// Computes the span of rays from `start` along d in the world, and e in the space of the unit shape; a box does not
/// need e. `faces` and `whole` are constants. If `whole` is false and no ray hits the solid ahead, only `hit` is
/// defined.
INNER R(span) R(span_of)(const glint_solid *solid, const R(solid_start) * start, const vr d[3], const vr e[3],
                         const bool faces, const bool whole)
{
    const vr zero = r_set(0), *f = start->f;
    const rm none = rm_from_bits(0), all = rm_from_bits((1u << VR) - 1);
    R(span)
    span = { .t = { r_set(-HUGE_VAL), r_set(HUGE_VAL) },
             .hit = all,
             .second = all,
             .flat = { none, none },
             .face = { zero, zero } };
    switch (solid->form) {
    case GLINT_FORM_BALL:
        R(cut_round)(&span, f, e, true, solid->magnitude);
        break;
    case GLINT_FORM_CYLINDER:
    case GLINT_FORM_TUBE:
        R(cut_round)(&span, f, e, false, solid->magnitude);
        R(cut_by_ends)(&span, solid, start, d, faces, whole);
        break;
    case GLINT_FORM_CONE:
    case GLINT_FORM_FUNNEL:
        R(cut_cone)(&span, f, e, solid->magnitude);
        R(cut_by_ends)(&span, solid, start, d, faces, whole);
        break;
    case GLINT_FORM_BOX:
        for (int axis = 0; axis < 3; axis++) {
            R(cut_by_slab)(&span, solid, start, d, axis, axis, faces, faces);
            if (!whole && axis < 2 && R(is_spent)(&span))
                break;
        }
        break;
    default:
        R(cut_by_disk)(&span, solid, start, d, e);
        break;
    }
    span.hit = rm_and(span.hit, r_le(span.t[0], span.t[1]));
    if (is_open(solid))
        R(open_ends)(&span);
    return span;
}

INNER R(span) R(span_along)(const glint_solid *solid, const R(solid_start) * start, const vr d[3], const bool whole)
{
    vr e[3] = { d[0], d[1], d[2] };
    if (solid->form != GLINT_FORM_BOX)
        R(to_unit)(solid, d, e);
    return R(span_of)(solid, start, d, e, false, whole);
}

static rm R(intersect_solid)(const glint_solid *solid, const R(solid_start) * start, const vr d[3], vr *t)
{
    if (solid->form == GLINT_FORM_TORUS) {
        vr e[3];
        R(to_unit)(solid, d, e);
        return R(intersect_torus)(solid, start->f, e, R(torus_afresh)(), t);
    }
    const R(span) span = R(span_along)(solid, start, d, false);
    *t = r_select(r_lt(r_set(0), span.t[0]), span.t[0], span.t[1]);
    return rm_and(span.hit, r_lt(r_set(0), *t));
}

/// Projects a point next to the curved side onto it; g: the outward normal there.
static inline void R(onto_side)(uint32_t form, vr k[3], vr g[3])
{
    const vr round = k[0] * k[0] + k[1] * k[1];
    if (form == GLINT_FORM_BALL) {
        const vr length = r_sqrt(round + k[2] * k[2]);
        for (int c = 0; c < 3; c++)
            g[c] = k[c] = k[c] / length;
        return;
    }
    const vr length = r_sqrt(round);
    const bool cone = form == GLINT_FORM_CONE || form == GLINT_FORM_FUNNEL;
    const vr radius = cone ? k[2] : r_set(1);
    const rm off_axis = r_lt(r_set(0), length);
    for (int c = 0; c < 2; c++) {
        g[c] = r_select(off_axis, k[c] / length, r_set(0));
        k[c] = g[c] * radius;
    }
    g[2] = cone ? r_set(-1) : r_set(0);
}

/// Sets the exact coordinate of points on a face along two axes of the world. face: the face of the unit shape, in
/// the lanes of `flat`.
static inline void R(onto_plane)(const glint_solid *solid, rm flat, const vr face[3], vr p[3])
{
    const int slabs = glint_slab_count(solid->form);
    for (int i = 0; i < slabs; i++) {
        const glint_face *low = &solid->faces[2 * i], *high = low + 1;
        if (low->axis > 2)
            continue;
        const vr out = face[slabs == 1 ? 2 : i];
        const rm is_low = rm_and(flat, r_lt(out, r_set(0))), is_high = rm_and(flat, r_lt(r_set(0), out));
        for (uint32_t c = 0; c < 3; c++)
            if (c == low->axis)
                p[c] = r_select(is_low, r_set(low->at[c]), r_select(is_high, r_set(high->at[c]), p[c]));
    }
}

/// Projects a point next to the unit shape's surface onto it. which: the face, as in span; flat: the lanes whose
/// point is on a face. g: the outward normal there; face: the number of the face.
INNER void R(onto_unit)(uint32_t form, vr which, rm flat, vr k[3], vr g[3], vr face[3])
{
    const bool round = form != GLINT_FORM_BOX && form != GLINT_FORM_DISK;
    vr on_side[3] = { k[0], k[1], k[2] }, side[3] = { k[0], k[1], k[2] };
    if (round)
        R(onto_side)(form, on_side, side);
    for (int c = 0; c < 3; c++) {
        const rm up = r_eq(which, r_set(c + 1)), down = r_eq(which, r_set(-c - 1));
        g[c] = face[c] = r_select(up, r_set(1), r_select(down, r_set(-1), r_set(0)));
        k[c] = r_select(rm_or(up, down), face[c], k[c]);
        if (round) {
            g[c] = r_select(flat, face[c], side[c]);
            k[c] = r_select(flat, k[c], on_side[c]);
        }
    }
    if (form == GLINT_FORM_DISK)
        k[2] = r_set(0);
    else if (form == GLINT_FORM_CONE) // the apex is at the origin
        k[2] = r_select(rm_and(flat, r_lt(g[2], r_set(0))), r_set(0), k[2]);
}

/// Computes the unit outward normal, from the normal g of the unit shape.
INNER void R(normal_of)(const glint_solid *solid, const vr g[3], vr n[3])
{
    for (int c = 0; c < 3; c++)
        n[c] = (r_set(solid->inverse[0][c]) * g[0] + r_set(solid->inverse[1][c]) * g[1]) +
               r_set(solid->inverse[2][c]) * g[2];
    const vr length = r_sqrt(DOT(n, n));
    for (int c = 0; c < 3; c++)
        n[c] = n[c] / length;
}

/// Computes the points where rays that start at `start` hit the solid, and the unit normals there.
static void R(solid_surface)(const glint_solid *solid, const glint_prim *prim, const R(solid_start) * start,
                             const vr d[3], vr t, vr n[3], vr p[3])
{
    vr e[3], k[3], g[3], face[3];
    rm flat = rm_from_bits(0);
    R(to_unit)(solid, d, e);
    for (int c = 0; c < 3; c++)
        k[c] = start->f[c] + t * e[c];
    if (solid->form == GLINT_FORM_TORUS) {
        R(onto_torus)(solid->tube, k, g);
    } else if (solid->form == GLINT_FORM_BALL) {
        R(onto_side)(solid->form, k, g);
    } else {
        const R(span) span = R(span_of)(solid, start, d, e, true, true);
        const rm entering = r_eq(t, span.t[0]);
        flat = rm_or(rm_and(entering, span.flat[0]), rm_andnot(span.flat[1], entering));
        R(onto_unit)(solid->form, r_select(entering, span.face[0], span.face[1]), flat, k, g, face);
    }
    for (int c = 0; c < 3; c++)
        p[c] = r_set(prim->center[c]) + ((r_set(solid->forward[c][0]) * k[0] + r_set(solid->forward[c][1]) * k[1]) +
                                         r_set(solid->forward[c][2]) * k[2]);
    R(onto_plane)(solid, flat, face, p);
    R(normal_of)(solid, g, n);
}

/// Returns the lanes whose segments from `point` along d cross the surface. Segments end at t = 1 / scale; if
/// `directional` is set, they never end. Segments in lanes of `own` start on the solid and go inside, so they can
/// only hit the other side of an open form.
static rm R(solid_blocks)(const glint_solid *solid, const glint_prim *prim, const vr point[3], const vr d[3],
                                 double scale, bool directional, rm own)
{
    const vr zero = r_set(0), end = r_set(directional ? HUGE_VAL : 1), unit = r_set(directional ? 1 : scale);
    R(solid_start) start;
    R(start_at)(solid, prim, point, &start);
    const R(span) span = R(span_along)(solid, &start, d, false);
    const rm first = rm_andnot(rm_and(r_lt(zero, span.t[0]), r_lt(span.t[0] * unit, end)), own);
    const rm second = rm_and(r_lt(zero, span.t[1]), r_lt(span.t[1] * unit, end));
    return rm_and(span.hit, rm_or(first, rm_andnot(second, rm_andnot(own, span.second))));
}

#endif
