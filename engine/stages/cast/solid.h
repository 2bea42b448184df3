// solid: what cast, surface and occlude need of affine images of the unit ball, cube, cylinder, cone and disk, and of a
// cylinder's and a cone's side alone. The ray is
// taken to where the shape is the unit one; its t stays. Contract: stages.h.

/// Where a ray goes into a solid and where it leaves.
typedef struct R(span) {
    vr t[2];
    rm hit;
    rm second; ///< t[1] is where the ray leaves: of an open form, through the side
    rm flat[2]; ///< by way of a face of the slab, not of the curved side
    vr face[2][3]; ///< the outward normal of that face
} R(span);

static inline void R(to_unit)(const glint_solid *solid, const vr v[3], vr out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = (r_set(solid->inverse[k][0]) * v[0] + r_set(solid->inverse[k][1]) * v[1]) +
                 r_set(solid->inverse[k][2]) * v[2];
}

/// From the solid's centre to a point, where the shape is the unit one.
static inline void R(unit_offset)(const glint_solid *solid, const glint_prim *prim, const vr point[3], vr out[3])
{
    const vr away[3] = { point[0] - r_set(prim->center[0]), point[1] - r_set(prim->center[1]),
                         point[2] - r_set(prim->center[2]) };
    R(to_unit)(solid, away, out);
}

/// Cuts the span by lower <= f_axis + t e_axis <= 1.
static inline void R(cut_by_slab)(R(span) * span, const vr f[3], const vr e[3], int axis, double lower)
{
    const vr zero = r_set(0), low = r_set(lower), high = r_set(1), x = f[axis], d = e[axis];
    const rm rising = r_lt(zero, d), parallel = rm_andnot(r_le(d, zero), r_lt(d, zero));
    const vr enter = r_select(rising, low - x, high - x) / d, leave = r_select(rising, high - x, low - x) / d;
    const rm later = rm_andnot(r_lt(span->t[0], enter), parallel);
    const rm sooner = rm_andnot(r_lt(leave, span->t[1]), parallel);
    span->t[0] = r_select(later, enter, span->t[0]);
    span->t[1] = r_select(sooner, leave, span->t[1]);
    span->flat[0] = rm_or(span->flat[0], later);
    span->flat[1] = rm_or(span->flat[1], sooner);
    for (int k = 0; k < 3; k++) {
        const vr one = r_set(k == axis), out = r_select(rising, one, zero - one),
                 in = r_select(rising, zero - one, one);
        span->face[0][k] = r_select(later, in, span->face[0][k]);
        span->face[1][k] = r_select(sooner, out, span->face[1][k]);
    }
    span->hit = rm_andnot(span->hit, rm_and(parallel, rm_or(r_lt(x, low), r_lt(high, x))));
}

/// a t^2 - 2 b t + c <= 0 for a ball (three axes) or cylinder (two).
static inline void R(cut_round)(R(span) * span, const vr f[3], const vr e[3], bool ball)
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
    c = c - one;
    const rm near = r_lt(b * b, a);
    const vr disc = r_select(near, b * b - a * c, a - cross);
    const vr s = r_sqrt(r_max(disc, zero));
    const rm ahead = r_le(zero, b), along = rm_andnot(r_le(a, zero), r_lt(a, zero));
    const vr q = r_select(ahead, b + s, b - s);
    const vr far = q / a, other = c / q;
    // along the axis of a cylinder: all of it or nothing
    span->t[0] = r_select(along, r_set(-HUGE_VAL), r_select(ahead, other, far));
    span->t[1] = r_select(along, r_set(HUGE_VAL), r_select(ahead, far, other));
    span->hit = rm_or(rm_and(along, r_le(c, zero)), rm_andnot(r_le(zero, disc), along));
}

/// Rays that are begun anew where they are nearest to a cone's apex: what cut_cone takes are differences of squares, and
/// where those of the start are far greater than those of any hit, too little is left. So it is with rays from afar, and
/// with rays that pass the apex at about a third of how far from it they start, or less: down the side of either half. But what
/// starts on the side, as far as rounding lets us know, stays: whether that is within is the same for all its rays.
static inline rm R(starts_anew)(const vr from[3], vr toward, vr e2)
{
    const vr zero = r_set(0), away2 = DOT(from, from);
    const vr side = (from[0] * from[0] + from[1] * from[1]) - from[2] * from[2];
    const rm passes = r_lt(r_set(0.875) * (away2 * e2), toward * toward);
    const rm on = rm_and(r_lt(zero, from[2]), r_le(r_max(side, -side), r_set(GLINT_POINT_SLACK) * away2));
    return rm_or(r_lt(r_set(16), away2), rm_andnot(passes, on));
}

/// x^2 + y^2 <= z^2 on the side of z >= 0, the apex at the origin.
static inline void R(cut_cone)(R(span) * span, const vr from[3], const vr e[3])
{
    const vr zero = r_set(0), toward = DOT(from, e), e2 = DOT(e, e);
    const vr move = r_select(R(starts_anew)(from, toward, e2), -toward / e2, zero);
    const vr f[3] = { from[0] + move * e[0], from[1] + move * e[1], from[2] + move * e[2] };
    const vr a = (e[0] * e[0] + e[1] * e[1]) - e[2] * e[2], c = (f[0] * f[0] + f[1] * f[1]) - f[2] * f[2];
    const vr b = f[2] * e[2] - (f[0] * e[0] + f[1] * e[1]);
    const vr x = f[1] * e[2] - f[2] * e[1], y = f[2] * e[0] - f[0] * e[2], z = f[0] * e[1] - f[1] * e[0];
    const vr disc = (x * x + y * y) - z * z;
    const vr s = r_sqrt(r_max(disc, zero));
    const rm ahead = r_le(zero, b), steep = r_lt(a, zero), level = rm_andnot(r_le(a, zero), steep);
    const vr q = r_select(ahead, b + s, b - s);
    const vr far = q / a, other = r_select(r_eq(q, zero), far, c / q); // through the apex both are 0
    const vr low = r_min(far, other), high = r_max(far, other), single = c / (r_set(2) * b);
    const rm up = r_lt(zero, e[2]);
    // steeper than the side: one end is within the other half of the double cone; along the side: there is but one, of either
    const rm ours = rm_or(rm_and(up, r_lt(zero, b)), rm_andnot(r_lt(b, zero), up));
    const vr end = r_select(level, single, r_select(up, high, low));
    const rm open = rm_or(steep, level);
    span->t[0] = r_select(open, r_select(up, end, r_set(-HUGE_VAL)), low) + move;
    span->t[1] = r_select(open, r_select(up, r_set(HUGE_VAL), end), high) + move;
    span->hit = rm_or(rm_or(steep, rm_and(level, ours)), rm_andnot(r_le(zero, disc), level));
}

/// Takes the faces of a cylinder or cone away: what went through one meets the side once or not at all.
static inline void R(open_ends)(R(span) * span)
{
    const rm none = rm_from_bits(0);
    const vr in = span->t[0];
    span->t[0] = r_select(span->flat[0], span->t[1], in);
    span->t[1] = r_select(span->flat[1], in, span->t[1]);
    span->second = rm_andnot(span->second, span->flat[1]);
    span->hit = rm_andnot(span->hit, rm_and(span->flat[0], span->flat[1]));
    span->flat[0] = span->flat[1] = none;
}

static inline R(span) R(span_of)(const glint_solid *solid, const vr f[3], const vr e[3])
{
    const vr zero = r_set(0);
    const rm none = rm_from_bits(0), all = rm_from_bits((1u << VR) - 1);
    R(span)
    span = { .t = { r_set(-HUGE_VAL), r_set(HUGE_VAL) },
             .hit = all,
             .second = all,
             .flat = { none, none },
             .face = { { zero, zero, zero }, { zero, zero, zero } } };
    switch (solid->form) {
    case GLINT_FORM_BALL:
        R(cut_round)(&span, f, e, true);
        break;
    case GLINT_FORM_CYLINDER:
    case GLINT_FORM_TUBE:
        R(cut_round)(&span, f, e, false);
        R(cut_by_slab)(&span, f, e, 2, -1);
        break;
    case GLINT_FORM_CONE:
    case GLINT_FORM_FUNNEL:
        R(cut_cone)(&span, f, e);
        R(cut_by_slab)(&span, f, e, 2, 0);
        break;
    case GLINT_FORM_BOX:
        for (int axis = 0; axis < 3; axis++)
            R(cut_by_slab)(&span, f, e, axis, -1);
        break;
    default: // a disk: one place
        span.t[0] = span.t[1] = -f[2] / e[2];
        span.flat[0] = span.flat[1] = all;
        span.face[0][2] = span.face[1][2] = r_set(1);
        const vr x = f[0] + span.t[0] * e[0], y = f[1] + span.t[0] * e[1];
        span.hit = r_le(x * x + y * y, r_set(1));
        break;
    }
    span.hit = rm_and(span.hit, r_le(span.t[0], span.t[1]));
    if (is_open(solid))
        R(open_ends)(&span);
    return span;
}

static inline rm R(meet_solid)(const glint_solid *solid, const vr f[3], const vr d[3], vr *t)
{
    vr e[3];
    R(to_unit)(solid, d, e);
    const R(span) span = R(span_of)(solid, f, e);
    *t = r_select(r_lt(r_set(0), span.t[0]), span.t[0], span.t[1]);
    return rm_and(span.hit, r_lt(r_set(0), *t));
}

/// Brings a point next to the curved side onto it; g: the outward normal there.
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

/// Where a ray meets the solid, and the unit normal there.
static inline void R(solid_surface)(const glint_solid *solid, const glint_prim *prim, const vr from[3], const vr d[3],
                                    vr t, vr n[3], vr p[3])
{
    vr f[3], e[3], k[3], side[3], g[3], on_side[3];
    R(unit_offset)(solid, prim, from, f);
    R(to_unit)(solid, d, e);
    const R(span) span = R(span_of)(solid, f, e);
    const rm entering = r_eq(t, span.t[0]);
    const rm flat = rm_or(rm_and(entering, span.flat[0]), rm_andnot(span.flat[1], entering));
    for (int c = 0; c < 3; c++)
        on_side[c] = k[c] = f[c] + t * e[c];
    R(onto_side)(solid->form, on_side, side);
    for (int c = 0; c < 3; c++) {
        const vr face = r_select(entering, span.face[0][c], span.face[1][c]);
        const rm this_axis = rm_or(r_lt(face, r_set(0)), r_lt(r_set(0), face));
        g[c] = r_select(flat, face, side[c]);
        k[c] = r_select(flat, r_select(this_axis, face, k[c]), on_side[c]);
    }
    if (solid->form == GLINT_FORM_DISK)
        k[2] = r_set(0);
    else if (solid->form == GLINT_FORM_CONE) // which has its apex at 0
        k[2] = r_select(rm_and(flat, r_lt(g[2], r_set(0))), r_set(0), k[2]);
    for (int c = 0; c < 3; c++) {
        n[c] = (r_set(solid->inverse[0][c]) * g[0] + r_set(solid->inverse[1][c]) * g[1]) +
               r_set(solid->inverse[2][c]) * g[2];
        p[c] = r_set(prim->center[c]) + ((r_set(solid->forward[c][0]) * k[0] + r_set(solid->forward[c][1]) * k[1]) +
                                         r_set(solid->forward[c][2]) * k[2]);
    }
    const vr length = r_sqrt(DOT(n, n));
    for (int c = 0; c < 3; c++)
        n[c] = n[c] / length;
}

/// Whether the surface is crossed by segments from `point` along d, which end at 1 / scale; directional: nowhere. In lanes
/// of `own` they begin on it, within: what they can meet is the other side of an open form.
static inline rm R(solid_blocks)(const glint_solid *solid, const glint_prim *prim, const vr point[3], const vr d[3],
                                 double scale, bool directional, rm own)
{
    vr f[3], e[3];
    R(unit_offset)(solid, prim, point, f);
    R(to_unit)(solid, d, e);
    const R(span) span = R(span_of)(solid, f, e);
    const vr zero = r_set(0), end = r_set(directional ? HUGE_VAL : 1), unit = r_set(directional ? 1 : scale);
    const rm first = rm_andnot(rm_and(r_lt(zero, span.t[0]), r_lt(span.t[0] * unit, end)), own);
    const rm second = rm_and(r_lt(zero, span.t[1]), r_lt(span.t[1] * unit, end));
    return rm_and(span.hit, rm_or(first, rm_andnot(second, rm_andnot(own, span.second))));
}
