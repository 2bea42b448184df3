/// log2 and exp2 in the order of operations of stages.h, and the small vector algebra that every stage uses.
#ifndef GLINT_ELEMENTARY_H
#define GLINT_ELEMENTARY_H

#include "engine/render/stages/simd/coefficients.h"
#include "engine/render/stages/simd/vector.h"

/// For functions of the innermost loops, which must be inlined, however large the file is.
#define INNER static __attribute__((always_inline)) inline

static inline vf f_exponent(vf x)
{
    return f_from_bits(i_or(i_shr(f_bits(x), 23), i_set(0x4b000000))) - f_set(0x1p23f + 127);
}

static inline vf f_mantissa(vf x) { return f_from_bits(i_or(i_and(f_bits(x), i_set(0x007fffff)), i_set(0x3f800000))); }

/// Returns log2 of m 2^e, with m = 1 + f in [sqrt(1/2), sqrt(2)).
static inline vf f_log2_of_parts(vf e, vf f)
{
    vf p = f_set(GLINT_LOG2_C9);
    p = p * f + f_set(GLINT_LOG2_C8);
    p = p * f + f_set(GLINT_LOG2_C7);
    p = p * f + f_set(GLINT_LOG2_C6);
    p = p * f + f_set(GLINT_LOG2_C5);
    p = p * f + f_set(GLINT_LOG2_C4);
    p = p * f + f_set(GLINT_LOG2_C3);
    p = p * f + f_set(GLINT_LOG2_C2);
    p = p * f + f_set(GLINT_LOG2_C1);
    p = p * f + f_set(GLINT_LOG2_C0);
    return e + f * p;
}

/// Returns log2 of x in [2^-126, 1]; `less_1`: x - 1, which the caller computes from a more accurate x if possible.
static inline vf f_log2(vf x, vf less_1)
{
    const fm near_1 = f_le(f_set((float)GLINT_SQRT1_2), x);
    vf m = f_mantissa(x), e = f_exponent(x);
    const fm upper = f_le(f_set((float)GLINT_SQRT2), m);
    m = f_select(upper, f_set(0.5f) * m, m);
    e = f_select(upper, e + f_set(1), e);
    return f_log2_of_parts(f_select(near_1, f_set(0), e), f_select(near_1, less_1, m - f_set(1)));
}

/// Returns 2^y for y <= 0, and 0 below `lowest`, which is at least -126.
static inline vf f_exp2_above(vf y, float lowest)
{
    fm vanishes = f_lt(y, f_set(lowest));
    vf n = (y + f_set(12582912.0f)) - f_set(12582912.0f);
    vf f = y - n;
    vf p = f_set(GLINT_EXP2_D6);
    p = p * f + f_set(GLINT_EXP2_D5);
    p = p * f + f_set(GLINT_EXP2_D4);
    p = p * f + f_set(GLINT_EXP2_D3);
    p = p * f + f_set(GLINT_EXP2_D2);
    p = p * f + f_set(GLINT_EXP2_D1);
    p = p * f + f_set(GLINT_EXP2_D0);
    vf power = f_from_bits(i_shl(f_bits(n + f_set(0x1p23f + 127)), 23));
    return f_select(vanishes, f_set(0), p * power);
}

static inline vf f_exp2(vf y) { return f_exp2_above(y, GLINT_EXP2_LOWEST); }

/// Returns a + b, and its rounding error (Knuth, TAOCP 4.2.2).
static inline vd d_two_sum(vd a, vd b, vd *error)
{
    vd s = a + b, v = s - a;
    *error = (a - (s - v)) + (b - v);
    return s;
}

// Masks of a whole group, one bit per lane.

static inline unsigned lanes_equal(const uint32_t *index, uint32_t value)
{
    unsigned bits = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF)
        bits |= fm_bits(i_eq(i_load(index + i), i_set(value))) << i;
    return bits;
}

static inline unsigned lanes_below(const uint32_t *index, uint32_t bound)
{
    unsigned bits = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF)
        bits |= fm_bits(i_lt(i_load(index + i), i_set(bound))) << i;
    return bits;
}

static inline unsigned lanes_with(const uint32_t *flags, uint32_t flag)
{
    unsigned bits = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF)
        bits |= fm_bits(i_eq(i_and(i_load(flags + i), i_set(flag)), i_set(flag))) << i;
    return bits;
}

/// Stores `value` into `to` in the lanes whose bit is set.
static inline void lanes_put(uint32_t *to, unsigned bits, uint32_t value)
{
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(bits >> i & ((1u << VF) - 1));
        i_store(to + i, f_bits(f_select(mask, f_from_bits(i_set(value)), f_from_bits(i_load(to + i)))));
    }
}

/// Returns the largest number of a group.
static inline float group_highest(const float x[GLINT_GROUP])
{
    vf most = f_load(x);
    for (int i = VF; i < GLINT_GROUP; i += VF)
        most = f_max(most, f_load(x + i));
    return f_max_all(most);
}

/// Extends an interval by the numbers of the lanes in `bits`.
static inline void widen(const float x[GLINT_GROUP], unsigned bits, vf *least, vf *most)
{
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(bits >> i & ((1u << VF) - 1));
        *least = f_select(mask, f_min(f_load(x + i), *least), *least);
        *most = f_select(mask, f_max(f_load(x + i), *most), *most);
    }
}

#define DOT(a, b) (((a)[0] * (b)[0] + (a)[1] * (b)[1]) + (a)[2] * (b)[2])

#endif
