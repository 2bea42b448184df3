// torus: affine images of the unit torus, for cast, surface and occlude. A torus is not convex: a ray hits it up to
// four times, and a ray that leaves it may hit it again. ref/torus.h explains the method. Contract: stages.h.
#ifndef GLINT_CAST_TORUS_H
#define GLINT_CAST_TORUS_H

#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/simd/real.h"

/// Returns the factor of the quartic that has a different sign inside of the torus (below 0) and outside. *beyond:
/// the other factor, which is above 0 everywhere.
INNER vr R(torus_gap)(const vr k[3], vr tube2, vr *beyond)
{
    const vr one = r_set(1), round = r_sqrt(k[0] * k[0] + k[1] * k[1]), near = round - one, far = round + one;
    const vr level = k[2] * k[2];
    *beyond = (far * far + level) - tube2;
    return (near * near + level) - tube2;
}

/// Lines through a torus, parametrised from the point nearest to its centre. Up to three turning points of the
/// quartic divide each line into the stretches 0 .. 3, in which the quartic falls and rises in turn.
typedef struct R(torus_line) {
    vr tube, tube2;
    vr p[3], u[3];
    vr from, per, length, begin; ///< t = from + s per, with per = 1 / length; begin: s at t = 0
    vr reach; ///< there are no roots beyond -reach .. reach
    vr bend, lean;
    rm near; ///< lines that come near the torus; for other lines, only this field and the fields above are set
    vr turn[3], gap[3], beyond[3]; ///< s of the turning points, in order, and the factors of torus_gap there; if
        ///< there is only one turning point, the others are at infinity, outside
    vr begin_gap;
    rm on, inward; ///< rays that start on the surface; of these, the rays that go inside
    rm past[3]; ///< turning points behind the rays' origins
} R(torus_line);

/// The lanes whose rays leave the torus, and of these the lanes whose rays go inwards.
typedef struct R(torus_start) {
    rm leaves, inward;
} R(torus_start);

static inline R(torus_start) R(torus_afresh)(void)
{
    const rm none = rm_from_bits(0);
    return (R(torus_start)) { none, none };
}

/// Returns the largest x with x^3 + bend x = |lean|, for each line.
INNER vr R(last_turn)(const R(torus_line) * l)
{
    const vr three = r_set(3), zero = r_set(0), bend = l->bend, lean = R(abs)(l->lean), r = r_sqrt(r_max(-bend, zero));
    const vr by = r_select(r_lt(bend, zero), r_set(-2) * bend, bend);
    vr x = r + r_min(lean / by, (r_set(2) + lean) * r_set(0.34));
    unsigned wanted = rm_bits(l->near);
    for (int n = 0; n < GLINT_TURN_STEPS && wanted; n++) {
        const vr value = (x * x + bend) * x - lean, slope = three * (x * x) + bend;
        const vr step = value * slope / (slope * slope - value * (three * x));
        x = r_select(rm_from_bits(wanted), x - step, x);
        wanted &= ~rm_bits(r_le(R(abs)(step), r_set(GLINT_TURN_NEAR)));
    }
    return x;
}

/// Computes the turning points. last: the result of last_turn.
static inline void R(find_turns)(R(torus_line) * l, vr last)
{
    const vr zero = r_set(0), never = r_set(HUGE_VAL);
    const vr rest = -l->bend - r_set(0.75) * (last * last), root = r_sqrt(r_max(rest, zero));
    const vr low = r_set(-0.5) * last - root, high = r_set(-0.5) * last + root;
    const rm three = r_le(zero, rest), turned = r_lt(l->lean, zero);
    l->turn[0] = r_select(turned, -last, r_select(three, low, last));
    l->turn[1] = r_select(three, r_select(turned, -high, high), never);
    l->turn[2] = r_select(three, r_select(turned, -low, last), never);
    for (int i = 0; i < 3; i++) {
        const vr s = i == 0 ? l->turn[i] : r_select(three, l->turn[i], zero);
        const vr k[3] = { l->p[0] + l->u[0] * s, l->p[1] + l->u[1] * s, l->p[2] + l->u[2] * s };
        l->gap[i] = R(torus_gap)(k, l->tube2, &l->beyond[i]);
        if (i > 0)
            l->gap[i] = r_select(three, l->gap[i], r_set(1));
    }
}

/// Finds the stretch in which rays start, and whether they start on the surface.
static inline void R(begin_on_torus)(R(torus_line) * l, const glint_solid *solid, const vr f[3], const vr e[3],
                                     R(torus_start) start)
{
    const vr zero = r_set(0), one = r_set(1), within = r_set(GLINT_ON_FACE) * r_set(solid->magnitude);
    const vr round = r_sqrt(f[0] * f[0] + f[1] * f[1]);
    vr beyond;
    l->begin_gap = R(torus_gap)(f, l->tube2, &beyond);
    l->on = rm_or(start.leaves, r_le(R(abs)(l->begin_gap), within * (r_set(2) * l->tube + within)));
    for (int i = 0; i < 3; i++)
        l->past[i] = r_le(l->turn[i], l->begin);
    l->inward = rm_from_bits(0);
    if (!rm_bits(l->on))
        return;
    const vr rise = ((round - one) / round) * (f[0] * e[0] + f[1] * e[1]) + f[2] * e[2];
    const vr half = r_set(0.5);
    l->inward = rm_and(l->on, rm_or(rm_and(start.leaves, start.inward), rm_andnot(r_lt(rise, zero), start.leaves)));
    const rm outward = rm_andnot(l->on, l->inward);
    const rm first_in = r_lt(l->begin, half * l->turn[0] + half * l->turn[1]);
    const rm first_out = r_lt(l->begin, half * l->turn[1] + half * l->turn[2]);
    const rm later_in = rm_andnot(l->inward, first_in), later_out = rm_andnot(outward, first_out);
    l->past[0] = rm_or(rm_andnot(l->past[0], l->on), rm_or(outward, later_in));
    l->past[1] = rm_or(rm_andnot(l->past[1], l->on), rm_or(later_out, later_in));
    l->past[2] = rm_or(rm_andnot(l->past[2], l->on), later_out);
    // these rays start on the correct side of the surface, even if rounding has moved the next turning point
    const rm next[3] = { rm_andnot(l->inward, later_in), rm_andnot(outward, later_out), later_in };
    l->gap[0] = r_select(rm_and(next[0], r_lt(zero, l->gap[0])), zero, l->gap[0]);
    l->gap[1] = r_select(rm_and(next[1], r_le(l->gap[1], zero)), one, l->gap[1]);
    l->gap[2] = r_select(rm_and(next[2], r_lt(zero, l->gap[2])), zero, l->gap[2]);
}

/// Returns the lines that may come near the tube. Other lines stay within the hole of the ring while they are as high
/// as the tube, or never come close enough to the torus. The distance of a line from the axis grows towards both ends
/// of the line. Written so that lines with NaN stay.
INNER rm R(passes_tube)(const R(torus_line) * l, vr within)
{
    const vr one = r_set(1), wide = l->tube * r_set(1.01) + (within + r_set(1024 * GLINT_ON_FACE)), hole = one - wide;
    const vr per_level = one / l->u[2], a = (-wide - l->p[2]) * per_level, b = (wide - l->p[2]) * per_level;
    const vr end[2] = { r_max(r_min(a, b), -l->reach), r_min(r_max(a, b), l->reach) };
    rm out = rm_from_bits((1u << VR) - 1);
    for (int i = 0; i < 2; i++) {
        const vr x = l->p[0] + end[i] * l->u[0], y = l->p[1] + end[i] * l->u[1];
        out = rm_and(out, r_lt(x * x + y * y, hole * hole));
    }
    out = rm_or(rm_and(out, r_lt(r_set(0), hole)), r_lt(end[1], end[0]));
    return rm_andnot(rm_from_bits((1u << VR) - 1), out);
}

/// Prepares the roots of rays from f along e, in the space of the unit torus, up to `near`.
static inline void R(aim_at_torus)(const glint_solid *solid, const vr f[3], const vr e[3], R(torus_start) start,
                                   R(torus_line) * l)
{
    const vr zero = r_set(0), one = r_set(1), two = r_set(2), tube = r_set(solid->tube), ee = DOT(e, e);
    l->tube = tube;
    l->tube2 = tube * tube;
    const vr first = -DOT(f, e) / ee;
    const vr q[3] = { f[0] + e[0] * first, f[1] + e[1] * first, f[2] + e[2] * first };
    const vr again = -DOT(q, e) / ee, around = r_set(1.0001) * (one + tube);
    for (int c = 0; c < 3; c++)
        l->p[c] = q[c] + e[c] * again;
    const vr away2 = DOT(l->p, l->p), half2 = around * around - away2;
    l->near = r_lt(zero, half2);
    if (!rm_bits(l->near))
        return;
    l->from = first + again;
    l->length = r_sqrt(ee);
    l->per = one / l->length;
    l->begin = -l->from * l->length;
    for (int c = 0; c < 3; c++)
        l->u[c] = e[c] * l->per;
    l->reach = r_sqrt(r_max(half2, zero));
    l->near =
        rm_and(l->near, rm_or(start.leaves, R(passes_tube)(l, r_set(2 * GLINT_ON_FACE) * r_set(solid->magnitude))));
    l->bend = ((away2 + one) - l->tube2) - two * (l->u[0] * l->u[0] + l->u[1] * l->u[1]);
    l->lean = -two * (l->p[2] * l->u[2]);
}

static void R(along_torus)(const glint_solid *solid, const vr f[3], const vr e[3], R(torus_start) start, R(torus_line) * l)
{
    R(aim_at_torus)(solid, f, e, start, l);
    if (!rm_bits(l->near))
        return;
    R(find_turns)(l, R(last_turn)(l));
    R(begin_on_torus)(l, solid, f, e, start);
}

/// Returns the rays that leave the torus, do not go inside, and certainly never hit it again.
static inline rm R(leaves_torus)(const vr f[3], const vr e[3], R(torus_start) start)
{
    const rm outward = rm_andnot(start.leaves, start.inward);
    if (!rm_bits(outward))
        return outward;
    const vr one = r_set(1), round = r_sqrt(f[0] * f[0] + f[1] * f[1]);
    const vr rise = ((round - one) / round) * (f[0] * e[0] + f[1] * e[1]) + f[2] * e[2];
    return rm_and(outward, rm_and(r_le(one, round), r_le(r_set(0), rise)));
}

/// Returns the lines that have a root in a stretch.
static inline rm R(torus_crosses)(const R(torus_line) * l, int stretch)
{
    const vr zero = r_set(0);
    const rm first = r_le(l->gap[0], zero), parted = r_lt(zero, l->gap[1]), second = r_le(l->gap[2], zero);
    return rm_and(l->near, stretch == 0   ? first
                           : stretch == 1 ? rm_and(first, parted)
                           : stretch == 2 ? rm_and(parted, second)
                                          : second);
}

/// Returns the rays that start within a stretch, not on the surface.
static inline rm R(begins_in)(const R(torus_line) * l, int stretch)
{
    const rm all = rm_from_bits((1u << VR) - 1);
    const rm from = stretch == 0 ? all : l->past[stretch - 1];
    return rm_andnot(stretch == 3 ? from : rm_andnot(from, l->past[stretch]), l->on);
}

/// Returns the rays whose root in the stretch is ahead of the origin; the stretch must have a root.
static inline rm R(torus_ahead)(const R(torus_line) * l, int stretch)
{
    const vr zero = r_set(0);
    const rm all = rm_from_bits((1u << VR) - 1);
    const rm side = stretch % 2 ? r_lt(l->begin_gap, zero) : r_lt(zero, l->begin_gap);
    return rm_or(stretch == 0 ? rm_from_bits(0) : rm_andnot(all, l->past[stretch - 1]),
                 rm_and(R(begins_in)(l, stretch), side));
}

/// One stretch for each line.
typedef struct R(torus_stretch) {
    vr low, high, middle; ///< its ends; the lowest turning point, which is one of the ends
    vr gap; ///< the quartic at `middle`
    rm rising;
} R(torus_stretch);

static inline R(torus_stretch) R(stretch_at)(const R(torus_line) * l, int stretch)
{
    const int least = stretch < 2 ? 0 : 2;
    R(torus_stretch)
    out = { .low = stretch == 0 ? -l->reach : r_max(l->turn[stretch - 1], -l->reach),
            .high = stretch == 3 ? l->reach : r_min(l->turn[stretch], l->reach),
            .middle = l->turn[least],
            .gap = l->gap[least] * l->beyond[least],
            .rising = rm_from_bits(stretch % 2 ? (1u << VR) - 1 : 0) };
    out.low = r_select(R(begins_in)(l, stretch), r_max(out.low, l->begin), out.low);
    return out;
}

/// Moves s one step towards the roots; wanted: lanes that have not converged.
INNER void R(step_to_root)(const R(torus_line) * l, R(torus_stretch) * at, vr *s, unsigned *wanted)
{
    const vr zero = r_set(0), half = r_set(0.5), x = *s;
    const vr k[3] = { l->p[0] + l->u[0] * x, l->p[1] + l->u[1] * x, l->p[2] + l->u[2] * x };
    vr beyond;
    const vr gap = R(torus_gap)(k, l->tube2, &beyond);
    const rm inside = r_le(gap, zero), all = rm_from_bits((1u << VR) - 1);
    const rm ahead = rm_or(rm_and(inside, at->rising), rm_andnot(all, rm_or(inside, at->rising)));
    at->low = r_select(ahead, x, at->low);
    at->high = r_select(ahead, at->high, x);
    const vr value = gap * beyond, slope = r_set(4) * ((x * x + l->bend) * x - l->lean);
    const vr turn = r_set(6) * (x * x), size = turn + r_set(2) * R(abs)(l->bend);
    const vr bound = size + (r_set(2) + R(abs)(slope));
    vr next = x - value * slope / (slope * slope - value * (turn + r_set(2) * l->bend));
    next = r_select(rm_and(r_le(at->low, next), r_le(next, at->high)), next, half * at->low + half * at->high);
    const vr moved = R(abs)(next - x), on = r_set(GLINT_ON_FACE);
    const rm there = rm_or(r_le(moved * moved * moved * (bound * bound), on * (slope * slope)), r_le(moved, on));
    *s = r_select(rm_from_bits(*wanted), next, x);
    *wanted &= ~rm_bits(there);
}

/// Returns t of the root of each line's stretch, in the lanes that have one: `hit`.
static vr R(torus_root)(const R(torus_line) * l, R(torus_stretch) * at, rm hit)
{
    const vr zero = r_set(0), half = r_set(0.5);
    const vr curve = r_set(12) * (at->middle * at->middle) + r_set(4) * l->bend;
    const vr off = r_sqrt(r_max(r_set(-2) * at->gap / curve, zero));
    const vr guess = r_select(at->rising, at->middle + off, at->middle - off);
    const rm within = rm_and(r_le(at->low, guess), r_le(guess, at->high));
    vr s = r_select(within, guess, half * at->low + half * at->high);
    unsigned wanted = rm_bits(hit);
    for (int n = 0; n < GLINT_ROOT_STEPS && wanted; n++)
        R(step_to_root)(l, at, &s, &wanted);
    const vr t = l->from + s * l->per;
    return r_select(rm_and(hit, r_lt(zero, t)), t, r_set(GLINT_LEAST_T));
}

/// Finds the stretch of each line with the first root ahead. Returns the lanes that have one.
static rm R(first_ahead)(const R(torus_line) * l, R(torus_stretch) * at)
{
    rm hit = rm_from_bits(0);
    *at = (R(torus_stretch)) { .rising = hit };
    for (int stretch = 0; stretch < 4 && rm_bits(l->near); stretch++) {
        const rm here = rm_andnot(rm_and(R(torus_crosses)(l, stretch), R(torus_ahead)(l, stretch)), hit);
        if (!rm_bits(here))
            continue;
        const R(torus_stretch) found = R(stretch_at)(l, stretch);
        at->low = r_select(here, found.low, at->low);
        at->high = r_select(here, found.high, at->high);
        at->middle = r_select(here, found.middle, at->middle);
        at->gap = r_select(here, found.gap, at->gap);
        at->rising = rm_or(at->rising, rm_and(here, found.rising));
        hit = rm_or(hit, here);
    }
    return hit;
}

/// Computes the first hits of rays with the torus. Returns the rays that hit it. Rays that leave it and go inside
/// always hit it.
static rm R(intersect_torus)(const glint_solid *solid, const vr f[3], const vr e[3], R(torus_start) start, vr *t)
{
    R(torus_line) l;
    R(torus_stretch) at;
    R(along_torus)(solid, f, e, start, &l);
    const rm hit = rm_andnot(R(first_ahead)(&l, &at), R(leaves_torus)(f, e, start));
    *t = rm_bits(hit) ? R(torus_root)(&l, &at, hit) : r_set(GLINT_LEAST_T);
    return rm_or(hit, rm_and(start.leaves, start.inward));
}

/// Computes the intervals inside the torus, from ends[0] to ends[1] and from ends[2] to ends[3]. A ray that does not
/// come out in between has one interval, from the first root to the last. -inf: there is no such interval, or the ray
/// starts inside the interval.
static void R(torus_ends)(const glint_solid *solid, const vr f[3], const vr e[3], R(torus_start) start, vr ends[4])
{
    R(torus_line) l = { .near = rm_from_bits(0) }; // the other fields are not set if no line comes near the tube
    R(along_torus)(solid, f, e, start, &l);
    const vr zero = r_set(0), none = r_set(-HUGE_VAL);
    for (int stretch = 0; stretch < 4; stretch++) {
        const rm here = rm_and(R(torus_crosses)(&l, stretch), R(torus_ahead)(&l, stretch));
        ends[stretch] = none;
        if (!rm_bits(here))
            continue;
        R(torus_stretch) at = R(stretch_at)(&l, stretch);
        ends[stretch] = r_select(here, R(torus_root)(&l, &at, here), none);
    }
    ends[2] = r_select(rm_and(l.near, r_lt(zero, l.gap[1])), ends[2], ends[0]);
    const rm out = rm_or(r_lt(zero, ends[1]), r_lt(zero, ends[3]));
    ends[3] = r_select(rm_andnot(rm_and(start.leaves, start.inward), out), r_set(GLINT_LEAST_T), ends[3]);
}

/// Projects points next to the surface onto it; g: the outward normal there.
static inline void R(onto_torus)(double radius, vr k[3], vr g[3])
{
    const vr zero = r_set(0), one = r_set(1), tube = r_set(radius), round = r_sqrt(k[0] * k[0] + k[1] * k[1]);
    const rm off_axis = r_lt(zero, round);
    const vr x = r_select(off_axis, k[0] / round, zero), y = r_select(off_axis, k[1] / round, zero), w = round - one;
    const vr away = r_sqrt(w * w + k[2] * k[2]);
    const rm off_circle = r_lt(zero, away);
    const vr out = r_select(off_circle, w / away, one), up = r_select(off_circle, k[2] / away, zero);
    const vr from_axis = one + tube * out;
    k[0] = from_axis * x;
    k[1] = from_axis * y;
    k[2] = tube * up;
    g[0] = out * x;
    g[1] = out * y;
    g[2] = up;
}

/// Returns the segments from f that cross the surface before they end at t = end. end_inside: segments whose end is
/// inside. l: the lines as along_torus made them.
static rm R(torus_parts)(const R(torus_line) * l, const vr f[3], const vr e[3], vr end, rm end_inside,
                         R(torus_start) start)
{
    const vr zero = r_set(0);
    vr beyond;
    const rm gone = R(leaves_torus)(f, e, start), within = r_lt(R(torus_gap)(f, l->tube2, &beyond), zero);
    const rm afar = rm_or(rm_and(start.leaves, start.inward), rm_andnot(within, start.leaves));
    if (!rm_bits(l->near))
        return rm_or(rm_andnot(afar, end_inside), rm_andnot(end_inside, afar));
    const rm own = rm_or(rm_and(l->on, l->inward), rm_andnot(within, l->on));
    const rm inside = rm_or(rm_and(l->near, own), rm_andnot(afar, l->near));
    const vr last = (end - l->from) * l->length;
    rm parted = rm_or(rm_andnot(inside, end_inside), rm_andnot(end_inside, inside)), passes = l->near;
    for (int i = 0; i < 3; i++) {
        const rm inner = r_le(l->gap[i], zero);
        passes = rm_and(passes, rm_or(l->past[i], r_le(l->turn[i], last)));
        const rm differs = rm_or(rm_andnot(inside, inner), rm_andnot(inner, inside));
        parted = rm_or(parted, rm_andnot(rm_and(passes, differs), l->past[i]));
    }
    return rm_or(rm_andnot(parted, gone), rm_and(gone, end_inside));
}

#endif
