// pair: combined solids of two parts that are convex, before rays that start outside of both. Where a ray goes into a part, the place
// says whether it is in the other: that takes neither a root nor a division, and most hits need no other end. What is within rounding
// of a face is left to combined.h; ends are made as there, to the last bit. Contract: stages.h, cast.

#define PAIR_SLACK 0x1p-40 ///< a share of what heights and squares are made of; their rounding is far below it
#define PAIR_CHORD 0x1p-30 ///< half of what is within a curved side, over the way there: above it its two ends are in order

/// A box, ball or cylinder before a vector of rays.
typedef struct R(convex) {
    const glint_solid *solid;
    vr rise[3], low[3], high[3]; ///< over each slab; heights of the start over its faces
    vr f[3], e[3]; ///< start and direction, where the shape is the unit one; of a box not used
} R(convex);

static inline bool R(is_convex)(const glint_geometry_table *table, const glint_prim *part)
{
    if (part->kind != GLINT_PRIM_SOLID)
        return false;
    const uint32_t form = table->solids[part->item].form;
    return form == GLINT_FORM_BOX || form == GLINT_FORM_BALL || form == GLINT_FORM_CYLINDER;
}

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
    return r_set(PAIR_SLACK) * (R(abs)(x->low[i]) + R(abs)(x->high[i]));
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
    const vr slack = r_set(PAIR_SLACK) * (size + r_set(1 + x->solid->places));
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
        before = r_lt(r_set(PAIR_CHORD) * R(abs)(round.b), round.s);
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
        told = rm_andnot(r_lt(r_set(PAIR_CHORD) * R(abs)(round.b), round.s), round.along);
    }
    for (int i = 0; i < glint_slab_count(solid->form); i++) {
        const rm rising = r_lt(r_set(0), x->rise[i]);
        told = rm_andnot(told, r_eq(x->rise[i], r_set(0)));
        *t = r_min(r_select(rising, x->high[i], x->low[i]) / -x->rise[i], *t);
    }
    return told;
}

/// What a vector of rays meets of a pair.
typedef struct R(pair_hits) {
    vr t;
    rm first, second; ///< by which part
    rm missed;
} R(pair_hits);

INNER void R(meet_difference)(const R(convex) x[2], R(pair_hits) * hits)
{
    rm hit, in, out;
    R(way_into)(&x[0], &hits->t, &hit, &hits->missed);
    hits->first = hits->second = rm_from_bits(0);
    if (!rm_bits(hit))
        return;
    R(convex_at)(&x[1], hits->t, &in, &out);
    hits->first = rm_and(hit, out);
    in = rm_and(hit, in);
    if (!rm_bits(in))
        return;
    vr end;
    rm held, gone;
    const rm told = rm_and(in, R(way_out_of)(&x[1], &end));
    R(convex_at)(&x[0], end, &held, &gone);
    hits->second = rm_and(told, held);
    hits->missed = rm_or(hits->missed, rm_and(told, gone));
    hits->t = r_select(hits->second, end, hits->t);
}

INNER void R(meet_intersection)(const R(convex) x[2], R(pair_hits) * hits)
{
    vr t[2];
    rm hit[2], missed[2], in[2], out[2];
    for (int i = 0; i < 2; i++)
        R(way_into)(&x[i], &t[i], &hit[i], &missed[i]);
    const rm both = rm_and(hit[0], hit[1]), later = r_lt(t[0], t[1]);
    hits->t = r_max(t[0], t[1]);
    for (int i = 0; i < 2; i++)
        R(convex_at)(&x[i], hits->t, &in[i], &out[i]);
    hits->first = rm_andnot(rm_and(both, in[1]), later);
    hits->second = rm_and(rm_and(both, in[0]), later);
    hits->missed = rm_or(rm_or(missed[0], missed[1]), rm_and(both, rm_or(rm_andnot(out[1], later), rm_and(out[0], later))));
}

INNER void R(meet_union)(const R(convex) x[2], R(pair_hits) * hits)
{
    const vr none = r_set(HUGE_VAL);
    vr t[2];
    rm hit[2], missed[2];
    for (int i = 0; i < 2; i++) {
        R(way_into)(&x[i], &t[i], &hit[i], &missed[i]);
        t[i] = r_select(hit[i], t[i], none);
    }
    const rm told = rm_and(rm_or(hit[0], missed[0]), rm_or(hit[1], missed[1]));
    hits->t = r_min(t[0], t[1]);
    const vr apart = hits->t * r_set(1 + PAIR_SLACK);
    hits->first = rm_and(told, r_lt(apart, t[1]));
    hits->second = rm_and(told, r_lt(apart, t[0]));
    hits->missed = rm_and(missed[0], missed[1]);
}

/// Whether a whole is a pair.
static inline bool R(is_pair)(const glint_geometry_table *table, const glint_combined *whole)
{
    const glint_prim *parts = &table->prims[table->prim_count + whole->first];
    return GLINT_REAL == 64 && whole->length == 3 && whole->count == 2 && R(is_convex)(table, &parts[0]) &&
           R(is_convex)(table, &parts[1]);
}

/// What rays that start on neither part meet. Returns the lanes that are decided.
static unsigned R(meet_pair)(const glint_geometry_table *table, const glint_combined *whole, const vr o[3], const vr d[3],
                             R(pair_hits) * hits)
{
    R(convex) x[2];
    for (uint32_t j = 0; j < 2; j++)
        R(begin_convex)(table, &table->prims[table->prim_count + whole->first + j], o, d, &x[j]);
    if (whole->program[2] == GLINT_COMBINE_DIFFERENCE)
        R(meet_difference)(x, hits);
    else if (whole->program[2] == GLINT_COMBINE_INTERSECTION)
        R(meet_intersection)(x, hits);
    else
        R(meet_union)(x, hits);
    return rm_bits(rm_or(hits->missed, rm_or(hits->first, hits->second)));
}
