// simple: combined solids of a few parts that are convex, all united, or of which the first few are met and the others, the cutters,
// taken away, before rays that start outside. Where a ray goes into a part, the place says whether it is in the others: that takes
// neither a root nor a division, and most hits need no other end. What is within rounding of a face is left to combined.h; ends are
// made as there, to the last bit.
// Contract: stages.h, cast.
#ifndef GLINT_CAST_SIMPLE_H
#define GLINT_CAST_SIMPLE_H

#include "engine/stages/cast/box.h"
#include "engine/stages/cast/camera.h"
#include "engine/stages/cast/face.h"
#include "engine/stages/cast/solid.h"
#include "engine/stages/cast/triangle.h"
#include "engine/stages/simd/real.h"

#define SIMPLE_SLACK BOX_SLACK ///< of what squares are made of, too
#define SIMPLE_CHORD 0x1p-30 ///< half the chord through a curved side, over the way to its middle: above it the two ends are in order

/// A part as all rays of one eye see it.
typedef struct R(eye_part) {
    real f[3], height[6]; ///< see solid_start
    real slack; ///< see side_at
    R(eye_slabs) slabs; ///< of a box
    bool level; ///< the map to the unit shape is along the axes
} R(eye_part);

/// Wholes that have code of their own.
typedef enum R(simple_kind) {
    R(PARTS_ANY),
    R(PARTS_TWO),
    R(CUT_BOX) ///< see glint_combined; of rays from one eye, that is before a face of the box
} R(simple_kind);

/// Those of a simple whole, in its order; or a box.
typedef struct R(eye_parts) {
    R(simple_kind) kind;
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

/// The parts of a simple whole.
static inline void R(see_parts)(const glint_geometry_table *table, const glint_combined *whole, const double eye[3],
                                R(eye_parts) * parts)
{
    const glint_prim *first = &table->prims[table->prim_count + whole->first];
    for (uint32_t j = 0; j < whole->count; j++)
        R(see_part)(&table->solids[first[j].item], &first[j], eye, &parts->part[j]);
    parts->kind = whole->cut_box && parts->part[0].slabs.before ? R(CUT_BOX) : whole->count == 2 ? R(PARTS_TWO) : R(PARTS_ANY);
}

/// A box, ball or cylinder before a vector of rays. Below, `at_eye`, a constant: these start at one eye.
typedef struct R(convex) {
    const R(eye_part) *eye; ///< what is here holds instead of the start and the heights below
    const glint_solid *solid;
    uint32_t form;
    bool level; ///< of a cut box, or see eye_part
    R(box_slabs) slabs; ///< of a cylinder the first
    vr f[3], e[3]; ///< start and direction, where the shape is the unit one; of a box not used
} R(convex);

/// With `solid`, `eye`, `form` and `level` set.
INNER void R(begin_convex)(const glint_prim *part, const vr o[3], const vr d[3], const bool at_eye, R(convex) * x)
{
    const glint_solid *solid = x->solid;
    const bool level = x->level;
    if (x->form == GLINT_FORM_BOX && level) {
        for (int i = 0; i < 3 && at_eye; i++)
            x->slabs.rise[i] = R(over_level_slab)(solid->faces + 2 * i, i, NULL, d, NULL);
        for (int i = 0; i < 3 && !at_eye; i++)
            R(begin_level_slab)(solid->faces, o, d, i, &x->slabs);
        return;
    }
    for (int i = 0; i < glint_slab_count(x->form) && at_eye; i++)
        x->slabs.rise[i] = R(face_rise)(solid->faces + 2 * i, d);
    for (int i = 0; i < glint_slab_count(x->form) && !at_eye; i++)
        R(begin_slab)(solid->faces, o, d, i, &x->slabs);
    if (x->form == GLINT_FORM_BOX)
        return;
    if (!at_eye && !level)
        R(unit_offset)(solid, part, o, x->f);
    if (!level)
        R(to_unit)(solid, d, x->e);
    for (int k = 0; level && k < 3; k++) { // what the other columns add is 0
        x->e[k] = r_set(solid->inverse[k][k]) * d[k];
        if (!at_eye)
            x->f[k] = r_set(solid->inverse[k][k]) * (o[k] - r_set(part->center[k]));
    }
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
    if (x->form == GLINT_FORM_BALL)
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
    if (x->form != GLINT_FORM_BOX)
        R(side_at)(x, at_eye, t, in, out);
    for (int i = 0; i < glint_slab_count(x->form); i++) {
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
        vr per_way;
        R(into_eye_box)(&x->eye->slabs, x->slabs.rise, t, &per_way, hit, missed);
        return;
    }
    *t = r_set(0);
    *hit = *missed = rm_from_bits(0); // the eye is within
}

/// Where rays go into a part ahead; hit and missed: those that do so or pass it for certain.
INNER void R(way_into)(const R(convex) * x, const bool at_eye, vr *t, rm *hit, rm *missed)
{
    const glint_solid *solid = x->solid;
    if (x->form == GLINT_FORM_BOX) {
        R(way_into_box)(x, at_eye, t, hit, missed);
        return;
    }
    const vr zero = r_set(0);
    vr f[3];
    R(start_of)(x, at_eye, f);
    const R(quadratic) round = R(quadratic_of)(f, x->e, x->form == GLINT_FORM_BALL, solid->places);
    const vr side = r_select(round.ahead, round.c, round.q) / r_select(round.ahead, round.q, round.a);
    rm past = rm_andnot(r_lt(round.disc, zero), round.along);
    rm before = r_lt(r_set(SIMPLE_CHORD) * R(abs)(round.b), round.s);
    rm told = rm_andnot(rm_from_bits((1u << VR) - 1), round.along);
    *t = side;
    if (x->form == GLINT_FORM_CYLINDER) { // by an end: within the side or not
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
    if (x->form != GLINT_FORM_BOX) {
        vr f[3];
        R(start_of)(x, at_eye, f);
        const R(quadratic) round = R(quadratic_of)(f, x->e, x->form == GLINT_FORM_BALL, solid->places);
        *t = r_select(round.ahead, round.q, round.c) / r_select(round.ahead, round.a, round.q);
        told = rm_andnot(r_lt(r_set(SIMPLE_CHORD) * R(abs)(round.b), round.s), round.along);
    }
    for (int i = 0; i < glint_slab_count(x->form); i++) {
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

/// What all parts have in common begins where the last of them does, if the others have not ended there.
INNER void R(meet_intersection)(const R(convex) x[], uint32_t count, const bool at_eye, R(simple_hits) * hits)
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

/// What the first `met` parts have in common without the others, where that begins. Returns rays that are in the only cutter there,
/// which look_behind_cutter is for.
INNER rm R(meet_difference)(const R(convex) x[], const uint32_t met, const uint32_t count, const bool at_eye,
                            R(simple_hits) * hits)
{
    rm in = rm_from_bits(0), out;
    if (met > 1) {
        R(meet_intersection)(x, met, at_eye, hits);
    } else {
        R(way_into)(&x[0], at_eye, &hits->t, &hits->hit, &hits->missed);
        hits->part = r_set(0);
    }
    const rm hit = hits->hit;
    if (!at_eye && !rm_bits(hit)) // of one eye, rays near the whole do meet the part
        return hit;
    for (uint32_t j = met; j < count; j++) {
        R(convex_at)(&x[j], at_eye, hits->t, &in, &out);
        hits->hit = rm_and(hits->hit, out);
    }
    return count - met == 1 ? rm_and(hit, in) : rm_from_bits(0);
}

/// Rays that are in the only cutter, which is the last part, where they go into the others may meet what is left of these where they
/// go out of it.
INNER void R(look_behind_cutter)(const R(convex) x[], const uint32_t count, const bool at_eye, rm in, R(simple_hits) * hits)
{
    vr end;
    const rm told = rm_and(in, R(way_out_of)(&x[count - 1], at_eye, &end));
    rm second = told, gone = rm_from_bits(0), held, out;
    for (uint32_t j = 0; j + 1 < count; j++) {
        R(convex_at)(&x[j], at_eye, end, &held, &out);
        second = rm_and(second, held);
        gone = rm_or(gone, out);
    }
    hits->missed = rm_or(hits->missed, rm_and(told, gone));
    hits->hit = rm_or(hits->hit, second);
    hits->t = r_select(second, end, hits->t);
    hits->part = r_select(second, r_set(count - 1), hits->part);
}

/// As meet_difference, of a cut box before rays from one eye. Whether a ray is in the ball where it goes into the box is told by
/// places over t, so that it need not wait for the division: what 1 / t is off is far below the slack, as is all other rounding.
INNER rm R(meet_cut_box)(const R(convex) x[2], R(simple_hits) * hits)
{
    vr per_way, q[3];
    rm hit;
    R(into_eye_box)(&x[0].eye->slabs, x[0].slabs.rise, &hits->t, &per_way, &hit, &hits->missed);
    for (int k = 0; k < 3; k++)
        q[k] = r_set(x[1].eye->f[k]) * per_way + x[1].e[k];
    const vr unit = per_way * per_way, over = DOT(q, q) - unit, slack = r_set(x[1].eye->slack) * unit;
    hits->part = r_set(0);
    hits->hit = rm_and(hit, r_lt(slack, over));
    return rm_and(hit, r_lt(over, -slack));
}

/// All parts together begin where the first of them does.
INNER void R(meet_union)(const R(convex) x[], uint32_t count, const bool at_eye, R(simple_hits) * hits)
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

/// The part of a whole, before a vector of rays. eye: of those that start at one eye; kind: of the whole for these, a constant.
INNER void R(begin_part)(const glint_geometry_table *table, const glint_combined *whole, const R(simple_kind) kind, uint32_t j,
                         const vr o[3], const vr d[3], const bool at_eye, const R(eye_parts) * eye, R(convex) * x)
{
    const bool known = kind == R(CUT_BOX);
    const glint_prim *part = &table->prims[table->prim_count + whole->first + j];
    x->solid = &table->solids[part->item];
    x->eye = at_eye ? &eye->part[j] : NULL;
    x->form = !known ? x->solid->form : j == 0 ? GLINT_FORM_BOX : GLINT_FORM_BALL;
    x->level = known || (at_eye && x->eye->level);
    R(begin_convex)(part, o, d, at_eye, x);
}

/// How many parts of a simple whole, which is no union, are met before the others are taken away.
static inline uint32_t R(parts_met)(const glint_combined *whole)
{
    uint32_t met = 1;
    while (met < whole->count && whole->program[2 * met] == GLINT_COMBINE_INTERSECTION)
        met++;
    return met;
}

/// What rays that start on no part of a simple whole meet, but for those that it returns, see meet_difference. count: of parts.
INNER rm R(meet_simple)(const glint_combined *whole, const uint32_t count, const bool at_eye, const R(convex) x[],
                        R(simple_hits) * hits)
{
    if (whole->program[2] == GLINT_COMBINE_UNION) {
        R(meet_union)(x, count, at_eye, hits);
        return rm_from_bits(0);
    }
    const uint32_t met = R(parts_met)(whole);
    if (met == 1)
        return R(meet_difference)(x, 1, count, at_eye, hits);
    return R(meet_difference)(x, count > 2 ? met : 2, count, at_eye, hits);
}

static __attribute__((noinline)) unsigned R(meet_cut_box_from)(const glint_geometry_table *table, const glint_combined *whole,
                                                               const vr o[3], const vr d[3], R(simple_hits) * hits)
{
    R(convex) x[2];
    R(begin_part)(table, whole, R(CUT_BOX), 0, o, d, false, NULL, &x[0]);
    R(begin_part)(table, whole, R(CUT_BOX), 1, o, d, false, NULL, &x[1]);
    const rm in = R(meet_difference)(x, 1, 2, false, hits);
    if (rm_bits(in))
        R(look_behind_cutter)(x, 2, false, in, hits);
    return rm_bits(rm_or(hits->missed, hits->hit));
}

/// Returns the lanes that are decided.
static unsigned R(meet_from_anywhere)(const glint_geometry_table *table, const glint_combined *whole, const vr o[3],
                                      const vr d[3], R(simple_hits) * hits)
{
    R(convex) x[GLINT_SIMPLE_PARTS];
    if (whole->cut_box)
        return R(meet_cut_box_from)(table, whole, o, d, hits);
    for (uint32_t j = 0; j < whole->count; j++)
        R(begin_part)(table, whole, R(PARTS_ANY), j, o, d, false, NULL, &x[j]);
    const rm in = R(meet_simple)(whole, whole->count, false, x, hits);
    if (rm_bits(in))
        R(look_behind_cutter)(x, whole->count, false, in, hits);
    return rm_bits(rm_or(hits->missed, hits->hit));
}

/// The parts of a whole of `count`, before vector v of a group from one eye. kind: a constant.
INNER void R(begin_eye_parts)(const glint_geometry_table *table, const glint_combined *whole, const R(simple_kind) kind,
                              const uint32_t count, const R(eye_parts) * eye, const glint_cast_args *args,
                              R(group_directions) directions, int v, R(convex) x[])
{
    vr d[3];
    R(load_direction)(directions, args->direction, 0, v * VR, d);
    R(begin_part)(table, whole, kind, 0, NULL, d, true, eye, &x[0]); // two parts are in registers
    R(begin_part)(table, whole, kind, 1, NULL, d, true, eye, &x[1]);
    for (uint32_t j = 2; j < count; j++)
        R(begin_part)(table, whole, kind, j, NULL, d, true, eye, &x[j]);
}

/// What the vectors of a group from one eye meet of a whole; no branch is taken by what one of them does, so that they are worked
/// on together. kind: a constant. near: lanes that are wanted.
INNER void R(meet_group)(const glint_geometry_table *table, const glint_combined *whole, const R(simple_kind) kind,
                         const R(eye_parts) * eye, const glint_cast_args *args, R(group_directions) directions, unsigned near,
                         R(simple_hits) hits[])
{
    const uint32_t count = kind == R(PARTS_ANY) ? whole->count : 2;
    unsigned in[GLINT_GROUP / VR];
#pragma GCC unroll 8
    for (int v = 0; v < GLINT_GROUP / VR; v++) {
        const unsigned lanes = near >> v * VR & ((1u << VR) - 1);
        R(convex) x[GLINT_SIMPLE_PARTS];
        in[v] = 0;
        if (!lanes && kind != R(CUT_BOX))
            continue;
        R(begin_eye_parts)(table, whole, kind, count, eye, args, directions, v, x);
        if (kind == R(CUT_BOX))
            in[v] = lanes & rm_bits(R(meet_cut_box)(x, &hits[v]));
        else
            in[v] = lanes & rm_bits(R(meet_simple)(whole, count, true, x, &hits[v]));
    }
    for (int v = 0; v < GLINT_GROUP / VR; v++) {
        R(convex) x[GLINT_SIMPLE_PARTS];
        if (!in[v])
            continue;
        R(begin_eye_parts)(table, whole, kind, count, eye, args, directions, v, x);
        R(look_behind_cutter)(x, count, true, rm_from_bits(in[v]), &hits[v]);
    }
}

static __attribute__((noinline)) void R(meet_group_of_any)(const glint_geometry_table *table, const glint_combined *whole,
                                                           const R(eye_parts) * eye, const glint_cast_args *args,
                                                           R(group_directions) directions, unsigned near, R(simple_hits) hits[])
{
    R(meet_group)(table, whole, R(PARTS_ANY), eye, args, directions, near, hits);
}

static __attribute__((noinline)) void R(meet_group_of_two)(const glint_geometry_table *table, const glint_combined *whole,
                                                           const R(eye_parts) * eye, const glint_cast_args *args,
                                                           R(group_directions) directions, unsigned near, R(simple_hits) hits[])
{
    R(meet_group)(table, whole, R(PARTS_TWO), eye, args, directions, near, hits);
}

/// The same; kind: a constant.
INNER void R(meet_group_of)(const R(simple_kind) kind, const glint_geometry_table *table, const glint_combined *whole,
                            const R(eye_parts) * eye, const glint_cast_args *args, R(group_directions) directions,
                            unsigned near, R(simple_hits) hits[])
{
    if (kind == R(CUT_BOX))
        R(meet_group)(table, whole, R(CUT_BOX), eye, args, directions, near, hits);
    else if (kind == R(PARTS_TWO))
        R(meet_group_of_two)(table, whole, eye, args, directions, near, hits);
    else
        R(meet_group_of_any)(table, whole, eye, args, directions, near, hits);
}

// ---- Rays that start on a part ----

/// Those that go into cutter `on` are in it up to its other side. There they meet what is left of the first `met` parts, if they are
/// in all of these; what these have in common is convex, so that those that are out of it do not come back. kind: a constant.
INNER void R(meet_through_cutter)(const glint_geometry_table *table, const glint_combined *whole, const R(simple_kind) kind,
                                  const uint32_t count, const uint32_t met, const uint32_t on, const vr o[3], const vr d[3],
                                  R(simple_hits) * hits)
{
    R(convex) x;
    rm in, out;
    R(begin_part)(table, whole, kind, on, o, d, false, NULL, &x);
    const rm told = R(way_out_of)(&x, false, &hits->t);
    hits->t = r_max(hits->t, r_set(GLINT_LEAST_WAY));
    hits->missed = rm_from_bits(0);
    hits->hit = told;
    for (uint32_t j = 0; j < count; j++) {
        if (j == on)
            continue;
        R(begin_part)(table, whole, kind, j, o, d, false, NULL, &x);
        R(convex_at)(&x, false, hits->t, &in, &out);
        hits->hit = rm_and(hits->hit, j < met ? in : out);
        if (j < met)
            hits->missed = rm_or(hits->missed, rm_and(told, out));
    }
}

/// Those that go out of the part meet the others, if any is met alone.
static void R(meet_other_parts)(const glint_geometry_table *table, const glint_combined *whole, uint32_t on, const vr o[3],
                                const vr d[3], R(simple_hits) * hits)
{
    R(convex) x[GLINT_SIMPLE_PARTS];
    uint32_t others = 0;
    for (uint32_t j = 0; j < whole->count; j++)
        if (j != on)
            R(begin_part)(table, whole, R(PARTS_ANY), j, o, d, false, NULL, &x[others++]);
    R(meet_union)(x, others, false, hits);
}

/// What rays meet that start on part `on` of a simple whole; into: lanes that go into it there. Returns the lanes that are decided;
/// hits->part is of no use.
static unsigned R(meet_from_part)(const glint_geometry_table *table, const glint_combined *whole, uint32_t on, unsigned into,
                                  const vr o[3], const vr d[3], R(simple_hits) * hits)
{
    const bool united = whole->program[2] == GLINT_COMBINE_UNION;
    const uint32_t met = united ? whole->count : R(parts_met)(whole);
    const bool cutter = on >= met;
    hits->t = r_set(HUGE_VAL);
    hits->hit = rm_from_bits(0);
    hits->missed = rm_from_bits((1u << VR) - 1); // nothing is left of what all of the whole is in
    if (whole->cut_box && cutter)
        R(meet_through_cutter)(table, whole, R(CUT_BOX), 2, 1, 1, o, d, hits);
    else if (cutter)
        R(meet_through_cutter)(table, whole, R(PARTS_ANY), whole->count, met, on, o, d, hits);
    else if (united)
        R(meet_other_parts)(table, whole, on, o, d, hits);
    return rm_bits(rm_or(hits->missed, hits->hit)) & (cutter ? into : ~into);
}

#endif
