// box: where rays that start outside of a box go into it. A ray does so through the last of the faces that it comes to from
// outside, if it has not gone out through another by then. Which face that is takes products alone, so that one division finds
// the place, by the same numbers as all six would. What is within rounding of an edge is left to solid.h. Contract: stages.h,
// cast.
#ifndef GLINT_CAST_BOX_H
#define GLINT_CAST_BOX_H

#include "engine/stages/cast/face.h"
#include "engine/stages/cast/triangle.h"
#include "engine/stages/simd/real.h"

#define BOX_SLACK 0x1p-40 ///< a share of what heights are made of; the rounding of places on rays is far below it

/// Rays before the three pairs of faces of a box: how fast they rise over each, and heights of their start.
typedef struct R(box_slabs) {
    vr rise[3], low[3], high[3];
} R(box_slabs);

/// Slab i, before rays that start at `place` along d.
INNER void R(begin_slab)(const glint_face *faces, const vr *place, const vr d[3], int i, R(box_slabs) * slabs)
{
    vr height[2] = { r_set(0), r_set(0) };
    slabs->rise[i] = R(over_slab)(faces + 2 * i, place, d, height);
    slabs->low[i] = height[0];
    slabs->high[i] = height[1];
}

INNER vr R(slab_slack)(vr low, vr high) { return r_set(BOX_SLACK) * (R(abs)(low) + R(abs)(high)); }

/// hit and missed: rays that go into it ahead, at t, or pass it, both for certain.
INNER void R(into_box)(const R(box_slabs) * slabs, vr *t, rm *hit, rm *missed)
{
    const vr zero = r_set(0);
    vr in[3], out[3]; // how far it is to the face by which a ray goes into each slab, to the other
    vr speed[3], way = zero, fast = r_set(1);
    rm own[3], before = rm_from_bits((1u << VR) - 1), past = rm_from_bits(0);
    for (int i = 0; i < 3; i++) {
        const rm rising = r_lt(zero, slabs->rise[i]);
        in[i] = r_select(rising, -slabs->low[i], slabs->high[i]);
        out[i] = r_select(rising, -slabs->high[i], slabs->low[i]);
        speed[i] = R(abs)(slabs->rise[i]);
        own[i] = i == 0 ? r_lt(zero, in[i]) : r_lt(way * speed[i], in[i] * fast);
        way = r_select(own[i], in[i], way);
        fast = r_select(own[i], speed[i], fast);
    }
    own[1] = rm_andnot(own[1], own[2]);
    own[0] = rm_andnot(own[0], rm_or(own[1], own[2]));
    *t = way / fast;
    for (int i = 0; i < 3; i++) {
        const vr moved = *t * speed[i], left = out[i] - moved, slack = R(slab_slack)(slabs->low[i], slabs->high[i]);
        before = rm_and(before, rm_or(own[i], rm_and(r_lt(slack, moved - in[i]), r_lt(slack, left))));
        past = rm_or(past, r_lt(left, -slack));
    }
    *hit = rm_and(before, rm_and(r_lt(zero, *t), r_lt(*t, r_set(HUGE_VAL))));
    *missed = past;
}

// ---- Rays from one eye ----

/// The constants of a box for the rays. 1 / t at a face is a constant times the speed at which the ray approaches it: rays enter by the
/// least of these numbers of the faces that the eye is before, and out by the greatest of the others.
typedef struct R(eye_slabs) {
    real height[3]; ///< of the eye over the face in front, where it is before one
    real in[3], least[3]; ///< 1 / t is `in` times the rise; where the eye is between the faces `in` is 0, `least` infinite
    real out[3], back[3]; ///< of the other face; where the eye is between them, of both; else `back` is 0
    bool before; ///< the eye is before one face or more
} R(eye_slabs);

/// |x|, of -0 too.
static inline real R(size)(real x) { return x < 0 ? -x : x == 0 ? 0 : x; }

/// height: of the eye over the faces.
static inline void R(see_slabs)(const real height[6], R(eye_slabs) * eye)
{
    eye->before = false;
    for (int i = 0; i < 3; i++) {
        const real low = height[2 * i], high = height[2 * i + 1];
        const bool below = low < 0, above = high > 0, between = !below && !above;
        eye->height[i] = below ? low : high;
        eye->in[i] = below ? -1 / low : above ? -1 / high : 0;
        eye->least[i] = between ? (real)HUGE_VALF : 0;
        eye->out[i] = between ? 1 / R(size)(high) : above ? -1 / low : -1 / high;
        eye->back[i] = between ? -1 / R(size)(low) : 0; // of either 0
        eye->before = eye->before || !between;
    }
}

/// Like into_box; *per_way: 1 / t, up to rounding.
INNER void R(into_eye_box)(const R(eye_slabs) * eye, const vr rise[3], vr *t, vr *per_way, rm *hit, rm *missed)
{
    const vr zero = r_set(0);
    vr in[3], out = zero, least = r_set(HUGE_VAL);
    for (int i = 0; i < 3; i++) {
        in[i] = rise[i] * r_set(eye->in[i]) + r_set(eye->least[i]);
        least = r_min(in[i], least);
        out = r_max(r_max(rise[i] * r_set(eye->out[i]), rise[i] * r_set(eye->back[i])), out);
    }
    *per_way = least;
    const vr more = least * r_set(1 + BOX_SLACK), less = least * r_set(1 - BOX_SLACK);
    const rm own[3] = { r_le(in[0], more), r_le(in[1], more), r_le(in[2], more) };
    const rm two = rm_or(rm_and(own[0], rm_or(own[1], own[2])), rm_and(own[1], own[2])); // within rounding of an edge
    const vr height = r_select(own[0], r_set(eye->height[0]),
                               r_select(own[1], r_set(eye->height[1]), r_set(eye->height[2])));
    const vr over = r_select(own[0], rise[0], r_select(own[1], rise[1], rise[2]));
    *t = height / -over;
    *hit = rm_and(rm_andnot(r_lt(out, less), two), rm_and(r_lt(r_set(0x1p-100), least), r_lt(least, r_set(0x1p100))));
    *missed = r_lt(more, out);
}

#endif
