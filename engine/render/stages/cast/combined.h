// combined: solids made of other solids by union, intersection and difference. A ray has an interval inside each
// part. The ray can only enter or leave the whole at an end of such an interval. It does so if the program's result
// just before that end differs from the result just after it, with all parts evaluated at the same t. Parts whose
// faces are in one plane have bit-equal ends there, so that these parts change together. Contract: stages.h, cast.
#ifndef GLINT_CAST_COMBINED_H
#define GLINT_CAST_COMBINED_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/hull.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/solid.h"
#include "engine/render/stages/cast/torus.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

/// The intervals in which rays are inside each part, from t[0] to t[1]; t[0] = inf: none.
typedef struct R(stretches) {
    vr t[2][GLINT_PARTS_MAX];
    uint32_t triangle[2][GLINT_PARTS_MAX][VR]; ///< for meshes: the triangles through which the rays enter and leave
    vr known; ///< t up to which all intervals are known; a mesh may have further intervals beyond
    uint64_t live; ///< bit mask of the parts that have an interval
    uint32_t length; ///< length of the program; 0: these rays hit nothing
    const uint8_t *program; ///< the program of the whole, or a simplification for these rays in `own`
    uint8_t own[2 * GLINT_PARTS_MAX];
} R(stretches);

/// Computes the interval in the half-space behind a plane.
static void R(stretch_behind)(const glint_prim *plane, const vr o[3], const vr d[3], vr t[2])
{
    vr f[3];
    R(offset)(o, plane, f);
    const vr h = R(point_constant)(f, plane), zero = r_set(0);
    const vr n[3] = { r_set(plane->normal[0]), r_set(plane->normal[1]), r_set(plane->normal[2]) };
    const vr nd = DOT(n, d), at = -h / nd;
    const rm across = r_le(r_set(GLINT_PARALLEL) * DOT(d, d), nd * nd), out = r_lt(zero, nd), under = r_le(h, zero);
    const vr low = r_set(-HUGE_VAL), high = r_set(HUGE_VAL);
    t[0] = r_select(across, r_select(out, low, at), r_select(under, low, high));
    t[1] = r_select(across, r_select(out, at, high), r_select(under, high, low));
}

/// Computes the interval inside the part, ahead of the rays' origins. Returns whether any ray has one.
static bool R(stretch_within)(const glint_geometry_table *table, const glint_prim *part, const vr o[3], const vr d[3],
                              vr t[2])
{
    if (part->kind == GLINT_PRIM_PLANE) {
        R(stretch_behind)(part, o, d, t);
        return rm_bits(r_lt(r_set(0), t[1])) != 0;
    }
    const glint_solid *solid = &table->solids[part->item];
    R(solid_start) start;
    R(start_at)(solid, part, o, &start);
    R(span) span = R(span_along)(solid, &start, d, false);
    if (R(is_spent)(&span))
        return false;
    t[0] = r_select(span.hit, span.t[0], r_set(HUGE_VAL));
    t[1] = r_select(span.hit, span.t[1], r_set(-HUGE_VAL));
    return true;
}

/// Corrects the intervals of the lanes in `own`, whose rays start on the part: a ray that goes into the part is
/// inside it up to the other side, and any other ray of `own` is never inside.
static void R(stretch_from)(const glint_geometry_table *table, const glint_prim *part, const vr o[3], const vr d[3],
                            unsigned own, unsigned into, vr t[2])
{
    vr out = r_set(HUGE_VAL);
    if (part->kind == GLINT_PRIM_SOLID && (own & into)) {
        const glint_solid *solid = &table->solids[part->item];
        R(solid_start) start;
        R(start_at)(solid, part, o, &start);
        const R(span) span = R(span_along)(solid, &start, d, true);
        out = r_max(span.t[1], r_set(GLINT_LEAST_T));
    }
    const rm on = rm_from_bits(own), in = rm_from_bits(into & ((1u << VR) - 1));
    t[0] = r_select(on, r_select(in, r_set(-HUGE_VAL), r_set(HUGE_VAL)), t[0]);
    t[1] = r_select(on, r_select(in, out, r_set(-HUGE_VAL)), t[1]);
}

/// Computes the first or the second interval inside a torus; own, into: as in stretch_from. Returns whether any ray
/// has this interval.
static bool R(stretch_of_torus)(const glint_geometry_table *table, const glint_prim *part, const vr o[3], const vr d[3],
                                unsigned own, unsigned into, vr t[2])
{
    const glint_solid *solid = &table->solids[part->item];
    const R(torus_start) start = { rm_from_bits(own), rm_from_bits(own & into) };
    vr f[3], e[3], ends[4];
    R(unit_offset)(solid, part, o, f);
    R(to_unit)(solid, d, e);
    R(torus_ends)(solid, f, e, start, ends);
    t[0] = ends[2 * (part->face - 1)];
    t[1] = ends[2 * (part->face - 1) + 1];
    return rm_bits(r_lt(r_set(0), t[1])) != 0;
}

/// Returns the lanes of a vector in which the list has the number `wanted`.
static inline unsigned R(vector_lanes)(const uint32_t *list, uint32_t wanted)
{
    unsigned lanes = 0;
    for (int i = 0; i < VR; i++)
        lanes |= (unsigned)(list[i] == wanted) << i;
    return lanes;
}

/// Makes the program for a vector of rays: the program of the whole without parts that none of the rays enters. Often
/// few parts remain.
static void R(leave_parts)(const glint_combined *whole, uint64_t live, R(stretches) * s)
{
    uint32_t begin[GLINT_PARTS_MAX]; // offset of the code of each set so far; a set without code is empty
    uint32_t top = 0, n = 0;
    for (uint32_t k = 0; k < whole->length; k++) {
        const uint8_t p = whole->program[k];
        if (p < GLINT_PARTS_MAX || p == GLINT_COMBINE_NOTHING) {
            begin[top++] = n;
            if (p < GLINT_PARTS_MAX && live >> p & 1)
                s->own[n++] = p;
            continue;
        }
        const uint32_t second = begin[--top], first = begin[top - 1];
        const bool any_first = first < second, any_second = second < n;
        if (any_first && any_second)
            s->own[n++] = p;
        else if (p == GLINT_COMBINE_INTERSECTION || (p == GLINT_COMBINE_DIFFERENCE && !any_first))
            n = first;
    }
    s->length = n;
    s->live = 0;
    for (uint32_t k = 0; k < n; k++)
        if (s->own[k] < GLINT_PARTS_MAX)
            s->live |= (uint64_t)1 << s->own[k];
}

/// Does the same, with shortcuts for the case that all parts remain, and for the case that one remains.
static inline void R(make_program)(const glint_combined *whole, uint64_t live, R(stretches) * s)
{
    if (live && live == whole->all) {
        s->program = whole->program;
        s->length = whole->length;
        s->live = live;
        return;
    }
    s->program = s->own;
    if (live & (live - 1)) {
        R(leave_parts)(whole, live, s);
        return;
    }
    s->live = live & whole->alone;
    s->length = s->live != 0;
    s->own[0] = (uint8_t)(live ? __builtin_ctzll(live) : 0);
}

/// A vector of rays that are tested against a combined solid.
typedef struct R(whole_rays) {
    const vr *o, *d;
    const uint32_t *on; ///< the primitive that each ray starts on; NULL: none
    unsigned inward, lanes; ///< lanes whose rays go into that primitive; wanted lanes
} R(whole_rays);

/// Computes the intervals of a mesh, which uses the parts from j on. from: t up to which the intervals were handled
/// before; 0: none were. Returns the parts that have an interval.
static uint64_t R(stretches_of_hull)(const glint_geometry_table *table, const glint_prim *part, uint32_t j,
                                     const R(whole_rays) * w, unsigned lanes, vr from, R(stretches) * s)
{
    R(hull_rays) rays;
    rays.table = table;
    rays.part = part;
    rays.o = w->o;
    rays.d = w->d;
    rays.on = w->on;
    R(begin_hull_rays)(&rays, from);
    vr *const t[2] = { s->t[0] + j, s->t[1] + j };
    uint32_t(*const triangle[2])[VR] = { s->triangle[0] + j, s->triangle[1] + j };
    const unsigned into = part->inverted ? ~w->inward : w->inward;
    const bool first = rm_bits(r_lt(r_set(0), from)) == 0;
    return (uint64_t)R(hull_stretches)(&rays, lanes, into, first, t, triangle, &s->known) << j;
}

/// Returns whether any ray starts on one of the parts.
static inline bool R(starts_on)(const uint32_t *on, uint32_t first, uint32_t count)
{
    bool starts = false;
    for (int i = 0; on && i < VR; i++)
        starts = starts || on[i] - first < count;
    return starts;
}

/// Computes the intervals of a part that can have several intervals, or of any part if rays start on some part
/// (`starts`). Only the rays in `lanes` are needed. Returns whether any ray is inside the part.
static __attribute__((noinline)) bool R(stretch_of_part)(const glint_geometry_table *table, const glint_prim *part, uint32_t index,
                                                         const R(whole_rays) * w, unsigned lanes, bool starts, vr t[2])
{
    const unsigned all = (1u << VR) - 1;
    const unsigned into = part->inverted ? ~w->inward : w->inward;
    unsigned own = starts ? R(vector_lanes)(w->on, index) : 0;
    if (part->kind == GLINT_PRIM_SOLID && part->face) {
        own |= starts ? R(vector_lanes)(w->on, part->face == 1 ? index + 1 : index - 1) : 0;
        return R(stretch_of_torus)(table, part, w->o, w->d, own, into, t) || own;
    }
    t[0] = r_set(HUGE_VAL);
    t[1] = r_set(-HUGE_VAL);
    const bool any = ((own | ~lanes) & all) != all && R(stretch_within)(table, part, w->o, w->d, t);
    if (own)
        R(stretch_from)(table, part, w->o, w->d, own, into, t);
    return any || (own & into);
}

/// Computes the intervals of all parts. lanes: the unfinished lanes of w->lanes; from: as in stretches_of_hull.
static void R(find_stretches)(const glint_geometry_table *table, const glint_combined *whole, const R(whole_rays) * w,
                              unsigned lanes, vr from, R(stretches) * s)
{
    const uint32_t first = table->prim_count + whole->first;
    const bool starts = R(starts_on)(w->on, first, whole->count);
    s->known = r_set(HUGE_VAL);
    uint64_t live = 0;
    for (uint32_t j = 0; j < whole->count; j++) {
        const glint_prim *part = &table->prims[first + j];
        vr t[2];
        if (part->kind == GLINT_PRIM_HULL) {
            if (part->face == 1)
                live |= R(stretches_of_hull)(table, part, j, w, lanes, from, s);
            continue;
        }
        const bool several = part->kind == GLINT_PRIM_SOLID && part->face;
        if (several || starts ? R(stretch_of_part)(table, part, first + j, w, lanes, starts, t)
                              : R(stretch_within)(table, part, w->o, w->d, t)) {
            live |= (uint64_t)1 << j;
            s->t[0][j] = t[0];
            s->t[1][j] = t[1];
        } else if (whole->needs >> j & 1) {
            s->known = r_set(HUGE_VAL);
            s->live = 0;
            s->length = 0;
            return;
        }
    }
    R(make_program)(whole, live, s);
}

/// Whether rays are inside one set just before and just after a position on each ray.
typedef struct R(change) {
    rm before, after; ///< lanes whose ray is inside just before the position, and just after it
    vr part; ///< if the ray enters or leaves the set there: the part on whose surface it does
} R(change);

static inline rm R(unlike)(rm a, rm b) { return rm_or(rm_andnot(a, b), rm_andnot(b, a)); }

INNER rm R(combine_masks)(uint8_t operation, rm a, rm b)
{
    if (operation == GLINT_COMBINE_UNION)
        return rm_or(a, b);
    return operation == GLINT_COMBINE_INTERSECTION ? rm_and(a, b) : rm_andnot(a, b);
}

/// Combines two sets. The result gets the part of the first set that changes in the same direction as the result.
INNER void R(combine)(uint8_t operation, R(change) * a, const R(change) * b, const bool parts)
{
    const rm before = R(combine_masks)(operation, a->before, b->before);
    const rm after = R(combine_masks)(operation, a->after, b->after);
    if (parts)
        a->part = r_select(rm_or(R(unlike)(a->before, before), R(unlike)(a->after, after)), b->part, a->part);
    a->before = before;
    a->after = after;
}

/// Returns the change of the whole at t. parts, a constant: whether `part` of the result is wanted.
INNER R(change) R(change_at)(const R(stretches) * s, vr t, const bool parts)
{
    R(change) stack[GLINT_PARTS_MAX];
    int top = 0;
    for (uint32_t k = 0; k < s->length; k++) {
        const uint8_t p = s->program[k];
        R(change) *here = &stack[top];
        if (p < GLINT_PARTS_MAX) {
            const vr in = s->t[0][p], out = s->t[1][p];
            here->before = rm_and(r_lt(in, t), r_le(t, out));
            here->after = rm_and(r_le(in, t), r_lt(t, out));
            here->part = r_set(p);
            top++;
        } else {
            R(combine)(p, here - 2, here - 1, parts);
            top--;
        }
    }
    return stack[0];
}

/// Returns the first change of a single part beyond `from`, for rays that are inside of it from `in` to `out`.
INNER vr R(first_end)(vr in, vr out, vr from)
{
    const vr none = r_set(HUGE_VAL), end = r_select(r_lt(from, in), in, r_select(r_lt(from, out), out, none));
    return r_select(r_lt(in, out), end, none);
}

/// Returns the rays that are inside an interval just before t, and just after it.
INNER rm R(in_before)(const vr stretch[2], vr t) { return rm_and(r_lt(stretch[0], t), r_le(t, stretch[1])); }

INNER rm R(in_after)(const vr stretch[2], vr t) { return rm_and(r_le(stretch[0], t), r_lt(t, stretch[1])); }

/// Lowers *best to t, an end of an interval, in the lanes of `ends` in which t is beyond `from` and nearer than *best,
/// and `mask` equals `is`.
INNER void R(nearer_end)(vr t, vr from, rm ends, rm mask, const bool is, vr *best)
{
    const rm ahead = rm_and(r_lt(from, t), ends);
    *best = r_min(r_select(is ? rm_and(ahead, mask) : rm_andnot(ahead, mask), t, r_set(HUGE_VAL)), *best);
}

/// Returns the first change of a combination of two parts; operation: a constant. Whether the whole changes at an
/// end of one part's interval depends on whether the ray is inside the other part.
INNER vr R(first_of_two)(const uint8_t operation, const vr a[2], const vr b[2], vr from)
{
    const bool both = operation == GLINT_COMBINE_INTERSECTION, less = operation == GLINT_COMBINE_DIFFERENCE;
    const rm a_ends = r_lt(a[0], a[1]), b_ends = r_lt(b[0], b[1]);
    const bool late = both || less;
    vr best = r_set(HUGE_VAL);
    R(nearer_end)(a[0], from, a_ends, late ? R(in_after)(b, a[0]) : R(in_before)(b, a[0]), both, &best);
    R(nearer_end)(a[1], from, a_ends, late ? R(in_before)(b, a[1]) : R(in_after)(b, a[1]), both, &best);
    R(nearer_end)(b[0], from, b_ends, both ? R(in_after)(a, b[0]) : R(in_before)(a, b[0]), late, &best);
    R(nearer_end)(b[1], from, b_ends, both ? R(in_before)(a, b[1]) : R(in_after)(a, b[1]), late, &best);
    return best;
}

/// Returns the lanes in which a change of a combination of two parts at t belongs to the second part, because the
/// first part does not change in the same direction.
static inline rm R(is_of_second)(const R(stretches) * s, vr t)
{
    const uint8_t *p = s->program;
    const vr a[2] = { s->t[0][p[0]], s->t[1][p[0]] }, b[2] = { s->t[0][p[1]], s->t[1][p[1]] };
    const rm before = R(in_before)(a, t), after = R(in_after)(a, t);
    return rm_or(R(unlike)(before, R(combine_masks)(p[2], before, R(in_before)(b, t))),
                 R(unlike)(after, R(combine_masks)(p[2], after, R(in_after)(b, t))));
}

/// Returns the first change of a program with more than two parts.
static vr R(first_of_many)(const R(stretches) * s, vr from)
{
    vr best = r_set(HUGE_VAL);
    for (uint64_t bits = s->live; bits; bits &= bits - 1)
        for (int end = 0; end < 2; end++) {
            const vr t = s->t[end][__builtin_ctzll(bits)];
            const rm ahead = rm_and(r_lt(from, t), r_lt(t, best));
            if (!rm_bits(ahead))
                continue;
            const R(change) change = R(change_at)(s, t, false);
            best = r_select(rm_and(ahead, R(unlike)(change.before, change.after)), t, best);
        }
    return best;
}

/// Returns t of the first change of the whole beyond `from`; inf: none.
static inline vr R(first_change)(const R(stretches) * s, vr from)
{
    const uint8_t *p = s->program;
    if (s->length == 0)
        return r_set(HUGE_VAL);
    if (s->length == 1)
        return R(first_end)(s->t[0][p[0]], s->t[1][p[0]], from);
    if (s->length > 3)
        return R(first_of_many)(s, from);
    const vr a[2] = { s->t[0][p[0]], s->t[1][p[0]] }, b[2] = { s->t[0][p[1]], s->t[1][p[1]] };
    if (p[2] == GLINT_COMBINE_UNION)
        return R(first_of_two)(GLINT_COMBINE_UNION, a, b, from);
    return p[2] == GLINT_COMBINE_INTERSECTION ? R(first_of_two)(GLINT_COMBINE_INTERSECTION, a, b, from)
                                              : R(first_of_two)(GLINT_COMBINE_DIFFERENCE, a, b, from);
}

/// Computes the first change of the whole for the rays of `lanes`, into `s`, `t` and `hit`. Returns the rays that
/// need further intervals. The caller repeats the call for these rays, with the *from that this call stored, until no
/// ray is left.
static unsigned R(next_change)(const glint_geometry_table *table, const glint_combined *whole, const R(whole_rays) * w,
                               unsigned lanes, vr *from, R(stretches) * s, vr *t, unsigned *hit)
{
    R(find_stretches)(table, whole, w, lanes, *from, s);
    *t = R(first_change)(s, *from);
    const unsigned decided = rm_bits(rm_or(r_lt(*t, s->known), r_eq(s->known, r_set(HUGE_VAL))));
    *hit = rm_bits(r_lt(*t, r_set(HUGE_VAL))) & lanes & decided;
    *from = s->known * r_set(GLINT_REAL == 64 ? 1 - 0x1p-53 : 1 - 0x1p-24); // the next smaller number, because
        // `known` is a normal number
    return lanes & ~decided;
}

/// Stores hits of part j; for a mesh, hits of its triangles.
static void R(update_part)(const glint_cast_args *args, const glint_combined *whole, const R(stretches) * s, uint32_t j,
                           size_t at, rm mine, vr t)
{
    if (!rm_bits(mine))
        return;
    const uint32_t index = args->geometry->prim_count + whole->first + j;
    if (args->geometry->prims[index].kind != GLINT_PRIM_HULL) {
        R(update_nearest)(args, at, index, mine, t);
        return;
    }
    const unsigned in = rm_bits(r_eq(t, s->t[0][j]));
    for (unsigned bits = rm_bits(mine); bits; bits &= bits - 1) {
        const int i = __builtin_ctz(bits);
        R(update_nearest)(args, at, s->triangle[in >> i & 1 ? 0 : 1][j][i], rm_from_bits(bits & -bits), t);
    }
}

/// Decides the whole for a vector of rays, which begins at lane `at` of the call, and stores the nearest hits as hits
/// of parts. Returns whether any hit was stored.
static __attribute__((noinline)) bool R(cast_combined)(const glint_cast_args *args, const glint_combined *whole, size_t at, const R(whole_rays) * w)
{
    R(stretches) s;
    vr from = r_set(0), t;
    unsigned any = 0, hit, rest = w->lanes;
    while (rest) {
        rest = R(next_change)(args->geometry, whole, w, rest, &from, &s, &t, &hit);
        any |= hit;
        if (!hit)
            continue;
        if (s.length == 1) {
            R(update_part)(args, whole, &s, s.program[0], at, rm_from_bits(hit), t);
            continue;
        }
        if (s.length == 3) {
            const rm second = R(is_of_second)(&s, t), kept = rm_from_bits(hit);
            R(update_part)(args, whole, &s, s.program[0], at, rm_andnot(kept, second), t);
            R(update_part)(args, whole, &s, s.program[1], at, rm_and(kept, second), t);
            continue;
        }
        const vr part = R(change_at)(&s, t, true).part;
        for (uint64_t live = s.live; live; live &= live - 1) {
            const uint32_t j = (uint32_t)__builtin_ctzll(live);
            R(update_part)(args, whole, &s, j, at, rm_and(rm_from_bits(hit), r_eq(part, r_set(j))), t);
        }
    }
    return any != 0;
}

/// Decides a combined solid for the rays in the lanes `near` of a group. Returns whether any hit was stored.
static bool R(cast_combined_rays)(const glint_cast_args *args, uint32_t g, const glint_prim *prim, unsigned near)
{
    const glint_combined *whole = &args->geometry->combined[prim->item];
    const size_t at = (size_t)g * GLINT_GROUP;
    bool any = false;
    count_tests(args->tests, near);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        vr o[3], d[3];
        if (!(near >> i & ((1u << VR) - 1)))
            continue;
        R(load3)(args->origin, at + (size_t)i, o);
        R(load3)(args->direction, at + (size_t)i, d);
        const uint32_t *on = args->leaving ? args->leaving + at + i : NULL;
        const R(whole_rays) rays = { o, d, on, on ? args->inward[g] >> i : 0, near >> i & ((1u << VR) - 1) };
        if (R(cast_combined)(args, whole, at + (size_t)i, &rays))
            any = true;
    }
    return any;
}

/// Does the same for the rays from the eye in group (x, y) of a tile.
static __attribute__((noinline)) bool R(cast_combined_pixels)(const glint_cast_args *args, const glint_prim *prim, int x, int y,
                                                              size_t at, unsigned near)
{
    const R(group_directions) directions = R(directions_of)(args->camera, (uint32_t)x, (uint32_t)y);
    const double *eye = args->camera->eye;
    const vr o[3] = { r_set(eye[0]), r_set(eye[1]), r_set(eye[2]) };
    bool any = false;
    count_tests(args->tests, near);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        vr d[3];
        if (!(near >> i & ((1u << VR) - 1)))
            continue;
        R(load_direction)(directions, args->direction, 0, i, d);
        const R(whole_rays) rays = { o, d, NULL, 0, near >> i & ((1u << VR) - 1) };
        if (R(cast_combined)(args, &args->geometry->combined[prim->item], at + (size_t)i, &rays))
            any = true;
    }
    return any;
}

#endif
