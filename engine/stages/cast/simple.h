// simple: combined solids of a few parts that are convex, all united, all met or all but the first taken away, before rays that start
// outside. Where a ray goes into a part, the place says whether it is in the others: that takes neither a root nor a division, and
// most hits need no other end. What is within rounding of a face is left to combined.h; ends are made as there, to the last bit.
// Contract: stages.h, cast.

#define SIMPLE_SLACK BOX_SLACK ///< of what squares are made of, too
#define SIMPLE_CHORD 0x1p-30 ///< half the chord through a curved side, over the way to its middle: above it the two ends are in order

/// A part as all rays of one eye see it.
typedef struct R(eye_part) {
    real f[3], height[6]; ///< see solid_start
    real slack; ///< see side_at
    R(eye_slabs) slabs; ///< of a box
    bool level; ///< the map to the unit shape is along the axes
} R(eye_part);

/// Those of a simple whole, in its order; or a box.
typedef struct R(eye_parts) {
    R(eye_part) part[GLINT_SIMPLE_PARTS];
} R(eye_parts);

static inline void R(see_part)(const glint_solid *solid, const glint_prim *prim, const double eye[3], R(eye_part) * part)
{
    R(start_at_eye)(solid, prim, eye, part->f, part->height);
    if (solid->form == GLINT_FORM_BOX)
        R(see_slabs)(part->height, &part->slabs);
    const real away = (R(size)(part->f[0]) + R(size)(part->f[1])) + R(size)(part->f[2]);
    part->slack = (real)SIMPLE_SLACK * (away + (real)(1 + solid->places));
    part->level = true;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            part->level = part->level && (i == k || solid->inverse[i][k] == 0);
}

/// A box, ball or cylinder before a vector of rays. Below, `at_eye`, a constant: these start at one eye.
typedef struct R(convex) {
    const R(eye_part) *eye; ///< what is here holds instead of the start and the heights below
    const glint_solid *solid;
    R(box_slabs) slabs; ///< of a cylinder the first
    vr f[3], e[3]; ///< start and direction, where the shape is the unit one; of a box not used
} R(convex);

INNER void R(begin_convex)(const glint_geometry_table *table, const glint_prim *part, const vr o[3], const vr d[3],
                           const bool at_eye, R(convex) * x)
{
    const glint_solid *solid = x->solid = &table->solids[part->item];
    for (int i = 0; i < glint_slab_count(solid->form) && at_eye; i++)
        x->slabs.rise[i] = R(face_rise)(solid->faces + 2 * i, d);
    for (int i = 0; i < glint_slab_count(solid->form) && !at_eye; i++)
        R(begin_slab)(solid->faces, o, d, i, &x->slabs);
    if (solid->form == GLINT_FORM_BOX)
        return;
    if (!at_eye)
        R(unit_offset)(solid, part, o, x->f);
    if (!at_eye || !x->eye->level)
        R(to_unit)(solid, d, x->e);
    for (int k = 0; at_eye && x->eye->level && k < 3; k++) // what the other columns add is 0
        x->e[k] = r_set(solid->inverse[k][k]) * d[k];
}

/// The start, where the shape is the unit one.
INNER void R(start_of)(const R(convex) * x, const bool at_eye, vr f[3])
{
    for (int k = 0; k < 3; k++)
        f[k] = at_eye ? r_set(x->eye->f[k]) : x->f[k];
}

/// Its heights over the faces of slab i.
INNER vr R(over_low)(const R(convex) * x, const bool at_eye, int i)
{
    return at_eye ? r_set(x->eye->height[2 * i]) : x->slabs.low[i];
}

INNER vr R(over_high)(const R(convex) * x, const bool at_eye, int i)
{
    return at_eye ? r_set(x->eye->height[2 * i + 1]) : x->slabs.high[i];
}

/// Where rays are at t: `in` and `out` of the curved side for certain.
INNER void R(side_at)(const R(convex) * x, const bool at_eye, vr t, rm *in, rm *out)
{
    vr f[3];
    R(start_of)(x, at_eye, f);
    const vr k[3] = { f[0] + t * x->e[0], f[1] + t * x->e[1], f[2] + t * x->e[2] };
    vr over = k[0] * k[0] + k[1] * k[1] - r_set(1), slack;
    if (x->solid->form == GLINT_FORM_BALL)
        over = over + k[2] * k[2];
    if (at_eye)
        slack = r_set(x->eye->slack);
    else
        slack = r_set(SIMPLE_SLACK) * (((R(abs)(f[0]) + R(abs)(f[1])) + R(abs)(f[2])) + r_set(1 + x->solid->places));
    *in = r_lt(over, -slack);
    *out = r_lt(slack, over);
}

/// The same of the whole part.
INNER void R(convex_at)(const R(convex) * x, const bool at_eye, vr t, rm *in, rm *out)
{
    *in = rm_from_bits((1u << VR) - 1);
    *out = rm_from_bits(0);
    if (x->solid->form != GLINT_FORM_BOX)
        R(side_at)(x, at_eye, t, in, out);
    for (int i = 0; i < glint_slab_count(x->solid->form); i++) {
        const vr low = R(over_low)(x, at_eye, i), high = R(over_high)(x, at_eye, i), moved = t * x->slabs.rise[i];
        const vr slack = R(slab_slack)(low, high), least = r_min(low + moved, -(high + moved));
        *in = rm_and(*in, r_lt(slack, least));
        *out = rm_or(*out, r_lt(least, -slack));
    }
}

/// way_into of a box.
INNER void R(way_into_box)(const R(convex) * x, const bool at_eye, vr *t, rm *hit, rm *missed)
{
    if (!at_eye) {
        R(into_box)(&x->slabs, t, hit, missed);
        return;
    }
    if (x->eye->slabs.before) {
        R(into_eye_box)(&x->eye->slabs, x->slabs.rise, t, hit, missed);
        return;
    }
    *t = r_set(0);
    *hit = *missed = rm_from_bits(0); // the eye is within
}

/// Where rays go into a part ahead; hit and missed: those that do so or pass it for certain.
INNER void R(way_into)(const R(convex) * x, const bool at_eye, vr *t, rm *hit, rm *missed)
{
    const glint_solid *solid = x->solid;
    if (solid->form == GLINT_FORM_BOX) {
        R(way_into_box)(x, at_eye, t, hit, missed);
        return;
    }
    const vr zero = r_set(0);
    vr f[3];
    R(start_of)(x, at_eye, f);
    const R(quadratic) round = R(quadratic_of)(f, x->e, solid->form == GLINT_FORM_BALL, solid->places);
    const vr side = r_select(round.ahead, round.c, round.q) / r_select(round.ahead, round.q, round.a);
    rm past = rm_andnot(r_lt(round.disc, zero), round.along);
    rm before = r_lt(r_set(SIMPLE_CHORD) * R(abs)(round.b), round.s);
    rm told = rm_andnot(rm_from_bits((1u << VR) - 1), round.along);
    *t = side;
    if (solid->form == GLINT_FORM_CYLINDER) { // by an end: within the side or not
        rm in, out;
        const vr rise = x->slabs.rise[0], low = R(over_low)(x, at_eye, 0), high = R(over_high)(x, at_eye, 0);
        const rm within = rm_and(r_lt(zero, low), r_lt(high, zero)), rising = r_lt(zero, rise);
        if (rm_bits(within) != (1u << VR) - 1) {
            told = rm_andnot(told, r_eq(rise, zero));
            *t = r_max(r_select(rising, low, high) / -rise, side);
        }
        const vr moved = *t * rise, left = r_select(rising, -(high + moved), low + moved), slack = R(slab_slack)(low, high);
        before = rm_and(before, r_lt(slack, left));
        past = rm_or(past, r_lt(left, -slack));
        const rm flat = r_lt(side, *t);
        R(side_at)(x, at_eye, *t, &in, &out);
        before = rm_andnot(before, rm_andnot(flat, in));
        past = rm_or(past, rm_and(flat, out));
    }
    *hit = rm_and(rm_andnot(told, past), rm_and(before, rm_and(r_lt(zero, *t), r_lt(*t, r_set(HUGE_VAL)))));
    *missed = rm_and(told, past);
}

/// Where rays that are in a part go out of it. Returns those for which that is certain.
INNER rm R(way_out_of)(const R(convex) * x, const bool at_eye, vr *t)
{
    const glint_solid *solid = x->solid;
    rm told = rm_from_bits((1u << VR) - 1);
    *t = r_set(HUGE_VAL);
    if (solid->form != GLINT_FORM_BOX) {
        vr f[3];
        R(start_of)(x, at_eye, f);
        const R(quadratic) round = R(quadratic_of)(f, x->e, solid->form == GLINT_FORM_BALL, solid->places);
        *t = r_select(round.ahead, round.q, round.c) / r_select(round.ahead, round.a, round.q);
        told = rm_andnot(r_lt(r_set(SIMPLE_CHORD) * R(abs)(round.b), round.s), round.along);
    }
    for (int i = 0; i < glint_slab_count(solid->form); i++) {
        const vr rise = x->slabs.rise[i];
        told = rm_andnot(told, r_eq(rise, r_set(0)));
        *t = r_min(r_select(r_lt(r_set(0), rise), R(over_high)(x, at_eye, i), R(over_low)(x, at_eye, i)) / -rise, *t);
    }
    return told;
}

/// What a vector of rays meets of a whole.
typedef struct R(simple_hits) {
    vr t, part; ///< part: its number
    rm hit, missed; ///< for certain
} R(simple_hits);

/// The first part without the others. A ray that is in a cutter where it goes into the first may meet what is left where it goes out of
/// that cutter, if that is the only one.
INNER void R(meet_difference)(R(convex) x[], uint32_t count, const bool at_eye, R(simple_hits) * hits)
{
    rm hit, held, in = rm_from_bits(0), out;
    R(way_into)(&x[0], at_eye, &hits->t, &hit, &hits->missed);
    hits->part = r_set(0);
    hits->hit = hit;
    if (!rm_bits(hit))
        return;
    for (uint32_t j = 1; j < count; j++) {
        R(convex_at)(&x[j], at_eye, hits->t, &in, &out);
        hits->hit = rm_and(hits->hit, out);
    }
    in = rm_and(hit, in);
    if (count > 2 || !rm_bits(in))
        return;
    vr end;
    rm gone;
    const rm told = rm_and(in, R(way_out_of)(&x[1], at_eye, &end));
    R(convex_at)(&x[0], at_eye, end, &held, &gone);
    const rm second = rm_and(told, held);
    hits->missed = rm_or(hits->missed, rm_and(told, gone));
    hits->hit = rm_or(hits->hit, second);
    hits->t = r_select(second, end, hits->t);
    hits->part = r_select(second, r_set(1), hits->part);
}

/// What all parts have in common begins where the last of them does, if the others have not ended there.
INNER void R(meet_intersection)(R(convex) x[], uint32_t count, const bool at_eye, R(simple_hits) * hits)
{
    rm all = rm_from_bits((1u << VR) - 1), hit, missed, in, out;
    hits->t = r_set(-HUGE_VAL);
    hits->part = r_set(0);
    hits->missed = rm_from_bits(0);
    for (uint32_t j = 0; j < count; j++) {
        vr t;
        R(way_into)(&x[j], at_eye, &t, &hit, &missed);
        const rm later = r_lt(hits->t, t);
        all = rm_and(all, hit);
        hits->missed = rm_or(hits->missed, missed);
        hits->t = r_select(later, t, hits->t);
        hits->part = r_select(later, r_set(j), hits->part);
    }
    hits->hit = all;
    for (uint32_t j = 0; j < count; j++) {
        const rm own = r_eq(hits->part, r_set(j));
        R(convex_at)(&x[j], at_eye, hits->t, &in, &out);
        hits->hit = rm_and(hits->hit, rm_or(own, in));
        hits->missed = rm_or(hits->missed, rm_andnot(rm_and(all, out), own));
    }
}

/// All parts together begin where the first of them does.
INNER void R(meet_union)(R(convex) x[], uint32_t count, const bool at_eye, R(simple_hits) * hits)
{
    const vr none = r_set(HUGE_VAL);
    rm told = rm_from_bits((1u << VR) - 1), hit, missed;
    vr next = none;
    hits->t = none;
    hits->part = r_set(0);
    hits->missed = told;
    for (uint32_t j = 0; j < count; j++) {
        vr t;
        R(way_into)(&x[j], at_eye, &t, &hit, &missed);
        t = r_select(hit, t, none);
        told = rm_and(told, rm_or(hit, missed));
        hits->missed = rm_and(hits->missed, missed);
        hits->part = r_select(r_lt(t, hits->t), r_set(j), hits->part);
        next = r_min(r_max(t, hits->t), next);
        hits->t = r_min(t, hits->t);
    }
    hits->hit = rm_and(told, r_lt(hits->t * r_set(1 + SIMPLE_SLACK), next));
}

/// What rays that start on no part of a simple whole meet. eye: of those that start at one eye. Returns the lanes that are
/// decided.
INNER unsigned R(meet_simple)(const glint_geometry_table *table, const glint_combined *whole, const vr o[3], const vr d[3],
                              const bool at_eye, const R(eye_parts) * eye, R(simple_hits) * hits)
{
    R(convex) x[GLINT_SIMPLE_PARTS];
    for (uint32_t j = 0; j < whole->count; j++) {
        x[j].eye = at_eye ? &eye->part[j] : NULL;
        R(begin_convex)(table, &table->prims[table->prim_count + whole->first + j], o, d, at_eye, &x[j]);
    }
    if (whole->program[2] == GLINT_COMBINE_DIFFERENCE)
        R(meet_difference)(x, whole->count, at_eye, hits);
    else if (whole->program[2] == GLINT_COMBINE_INTERSECTION)
        R(meet_intersection)(x, whole->count, at_eye, hits);
    else
        R(meet_union)(x, whole->count, at_eye, hits);
    return rm_bits(rm_or(hits->missed, hits->hit));
}

static unsigned R(meet_from_anywhere)(const glint_geometry_table *table, const glint_combined *whole, const vr o[3],
                                      const vr d[3], R(simple_hits) * hits)
{
    return R(meet_simple)(table, whole, o, d, false, NULL, hits);
}

static unsigned R(meet_from_eye)(const glint_geometry_table *table, const glint_combined *whole, const R(eye_parts) * eye,
                                 const vr d[3], R(simple_hits) * hits)
{
    return R(meet_simple)(table, whole, NULL, d, true, eye, hits);
}
