// simple: combined solids of a few parts that are convex, all united, all met or all but the first taken away, before rays that start
// outside. Where a ray goes into a part, the place says whether it is in the others: that takes neither a root nor a division, and
// most hits need no other end. What is within rounding of a face is left to combined.h; ends are made as there, to the last bit.
// Contract: stages.h, cast.

#define SIMPLE_SLACK 0x1p-40 ///< a share of what heights and squares are made of; their rounding is far below it
#define SIMPLE_CHORD 0x1p-30 ///< half the chord through a curved side, over the way to its middle: above it the two ends are in order

/// A box, ball or cylinder before a vector of rays.
typedef struct R(convex) {
    const glint_solid *solid;
    vr rise[3], low[3], high[3]; ///< over each slab; heights of the start over its faces
    vr f[3], e[3]; ///< start and direction, where the shape is the unit one; of a box not used
} R(convex);

INNER void R(begin_convex)(const glint_geometry_table *table, const glint_prim *part, const vr o[3], const vr d[3],
                           R(convex) * x)
{
    const glint_solid *solid = x->solid = &table->solids[part->item];
    for (int i = 0; i < glint_slab_count(solid->form); i++) {
        vr height[2] = { r_set(0), r_set(0) };
        x->rise[i] = R(over_slab)(solid->faces + 2 * i, o, d, height);
        x->low[i] = height[0];
        x->high[i] = height[1];
    }
    if (solid->form == GLINT_FORM_BOX)
        return;
    R(unit_offset)(solid, part, o, x->f);
    R(to_unit)(solid, d, x->e);
}

INNER vr R(slab_slack)(const R(convex) * x, int i)
{
    return r_set(SIMPLE_SLACK) * (R(abs)(x->low[i]) + R(abs)(x->high[i]));
}

/// Where rays are at t: `in` and `out` of the curved side for certain.
INNER void R(side_at)(const R(convex) * x, vr t, rm *in, rm *out)
{
    const bool ball = x->solid->form == GLINT_FORM_BALL;
    const vr k[3] = { x->f[0] + t * x->e[0], x->f[1] + t * x->e[1], x->f[2] + t * x->e[2] };
    const vr size = (R(abs)(x->f[0]) + R(abs)(x->f[1])) + R(abs)(x->f[2]);
    vr over = k[0] * k[0] + k[1] * k[1] - r_set(1);
    if (ball)
        over = over + k[2] * k[2];
    const vr slack = r_set(SIMPLE_SLACK) * (size + r_set(1 + x->solid->places));
    *in = r_lt(over, -slack);
    *out = r_lt(slack, over);
}

/// The same of the whole part.
INNER void R(convex_at)(const R(convex) * x, vr t, rm *in, rm *out)
{
    *in = rm_from_bits((1u << VR) - 1);
    *out = rm_from_bits(0);
    if (x->solid->form != GLINT_FORM_BOX)
        R(side_at)(x, t, in, out);
    for (int i = 0; i < glint_slab_count(x->solid->form); i++) {
        const vr moved = t * x->rise[i], above = x->low[i] + moved, below = -(x->high[i] + moved);
        const vr slack = R(slab_slack)(x, i), least = r_min(above, below);
        *in = rm_and(*in, r_lt(slack, least));
        *out = rm_or(*out, r_lt(least, -slack));
    }
}

/// Where rays go into a part ahead; hit and missed: those that do so or pass it for certain.
INNER void R(way_into)(const R(convex) * x, vr *t, rm *hit, rm *missed)
{
    const glint_solid *solid = x->solid;
    const vr zero = r_set(0);
    rm told = rm_from_bits((1u << VR) - 1), before = told, past = rm_from_bits(0);
    vr side = r_set(-HUGE_VAL);
    if (solid->form != GLINT_FORM_BOX) {
        const R(quadratic) round = R(quadratic_of)(x->f, x->e, solid->form == GLINT_FORM_BALL, solid->places);
        side = r_select(round.ahead, round.c, round.q) / r_select(round.ahead, round.q, round.a);
        past = rm_andnot(r_lt(round.disc, zero), round.along);
        before = r_lt(r_set(SIMPLE_CHORD) * R(abs)(round.b), round.s);
        told = rm_andnot(told, round.along);
    }
    *t = side;
    for (int i = 0; i < glint_slab_count(solid->form); i++) {
        const rm within = rm_and(r_lt(zero, x->low[i]), r_lt(x->high[i], zero)), rising = r_lt(zero, x->rise[i]);
        if (rm_bits(within) == (1u << VR) - 1)
            continue;
        told = rm_andnot(told, r_eq(x->rise[i], zero));
        *t = r_max(r_select(rising, x->low[i], x->high[i]) / -x->rise[i], *t);
    }
    for (int i = 0; i < glint_slab_count(solid->form); i++) {
        const vr moved = *t * x->rise[i];
        const vr left = r_select(r_lt(zero, x->rise[i]), -(x->high[i] + moved), x->low[i] + moved);
        const vr slack = R(slab_slack)(x, i);
        before = rm_and(before, r_lt(slack, left));
        past = rm_or(past, r_lt(left, -slack));
    }
    if (solid->form == GLINT_FORM_CYLINDER) { // by an end: within the side or not
        rm in, out;
        const rm flat = r_lt(side, *t);
        R(side_at)(x, *t, &in, &out);
        before = rm_andnot(before, rm_andnot(flat, in));
        past = rm_or(past, rm_and(flat, out));
    }
    *hit = rm_and(rm_andnot(told, past), rm_and(before, rm_and(r_lt(zero, *t), r_lt(*t, r_set(HUGE_VAL)))));
    *missed = rm_and(told, past);
}

/// Where rays that are in a part go out of it. Returns those for which that is certain.
INNER rm R(way_out_of)(const R(convex) * x, vr *t)
{
    const glint_solid *solid = x->solid;
    rm told = rm_from_bits((1u << VR) - 1);
    *t = r_set(HUGE_VAL);
    if (solid->form != GLINT_FORM_BOX) {
        const R(quadratic) round = R(quadratic_of)(x->f, x->e, solid->form == GLINT_FORM_BALL, solid->places);
        *t = r_select(round.ahead, round.q, round.c) / r_select(round.ahead, round.a, round.q);
        told = rm_andnot(r_lt(r_set(SIMPLE_CHORD) * R(abs)(round.b), round.s), round.along);
    }
    for (int i = 0; i < glint_slab_count(solid->form); i++) {
        const rm rising = r_lt(r_set(0), x->rise[i]);
        told = rm_andnot(told, r_eq(x->rise[i], r_set(0)));
        *t = r_min(r_select(rising, x->high[i], x->low[i]) / -x->rise[i], *t);
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
INNER void R(meet_difference)(R(convex) x[], uint32_t count, R(simple_hits) * hits)
{
    rm hit, held, in = rm_from_bits(0), out;
    R(way_into)(&x[0], &hits->t, &hit, &hits->missed);
    hits->part = r_set(0);
    hits->hit = hit;
    if (!rm_bits(hit))
        return;
    for (uint32_t j = 1; j < count; j++) {
        R(convex_at)(&x[j], hits->t, &in, &out);
        hits->hit = rm_and(hits->hit, out);
    }
    in = rm_and(hit, in);
    if (count > 2 || !rm_bits(in))
        return;
    vr end;
    rm gone;
    const rm told = rm_and(in, R(way_out_of)(&x[1], &end));
    R(convex_at)(&x[0], end, &held, &gone);
    const rm second = rm_and(told, held);
    hits->missed = rm_or(hits->missed, rm_and(told, gone));
    hits->hit = rm_or(hits->hit, second);
    hits->t = r_select(second, end, hits->t);
    hits->part = r_select(second, r_set(1), hits->part);
}

/// What all parts have in common begins where the last of them does, if the others have not ended there.
INNER void R(meet_intersection)(R(convex) x[], uint32_t count, R(simple_hits) * hits)
{
    rm all = rm_from_bits((1u << VR) - 1), hit, missed, in, out;
    hits->t = r_set(-HUGE_VAL);
    hits->part = r_set(0);
    hits->missed = rm_from_bits(0);
    for (uint32_t j = 0; j < count; j++) {
        vr t;
        R(way_into)(&x[j], &t, &hit, &missed);
        const rm later = r_lt(hits->t, t);
        all = rm_and(all, hit);
        hits->missed = rm_or(hits->missed, missed);
        hits->t = r_select(later, t, hits->t);
        hits->part = r_select(later, r_set(j), hits->part);
    }
    hits->hit = all;
    for (uint32_t j = 0; j < count; j++) {
        const rm own = r_eq(hits->part, r_set(j));
        R(convex_at)(&x[j], hits->t, &in, &out);
        hits->hit = rm_and(hits->hit, rm_or(own, in));
        hits->missed = rm_or(hits->missed, rm_andnot(rm_and(all, out), own));
    }
}

/// All parts together begin where the first of them does.
INNER void R(meet_union)(R(convex) x[], uint32_t count, R(simple_hits) * hits)
{
    const vr none = r_set(HUGE_VAL);
    rm told = rm_from_bits((1u << VR) - 1), hit, missed;
    vr next = none;
    hits->t = none;
    hits->part = r_set(0);
    hits->missed = told;
    for (uint32_t j = 0; j < count; j++) {
        vr t;
        R(way_into)(&x[j], &t, &hit, &missed);
        t = r_select(hit, t, none);
        told = rm_and(told, rm_or(hit, missed));
        hits->missed = rm_and(hits->missed, missed);
        hits->part = r_select(r_lt(t, hits->t), r_set(j), hits->part);
        next = r_min(r_max(t, hits->t), next);
        hits->t = r_min(t, hits->t);
    }
    hits->hit = rm_and(told, r_lt(hits->t * r_set(1 + SIMPLE_SLACK), next));
}

/// What rays that start on no part of a simple whole meet. Returns the lanes that are decided.
static unsigned R(meet_simple)(const glint_geometry_table *table, const glint_combined *whole, const vr o[3], const vr d[3],
                               R(simple_hits) * hits)
{
    R(convex) x[GLINT_SIMPLE_PARTS];
    for (uint32_t j = 0; j < whole->count; j++)
        R(begin_convex)(table, &table->prims[table->prim_count + whole->first + j], o, d, &x[j]);
    if (whole->program[2] == GLINT_COMBINE_DIFFERENCE)
        R(meet_difference)(x, whole->count, hits);
    else if (whole->program[2] == GLINT_COMBINE_INTERSECTION)
        R(meet_intersection)(x, whole->count, hits);
    else
        R(meet_union)(x, whole->count, hits);
    return rm_bits(rm_or(hits->missed, hits->hit));
}
