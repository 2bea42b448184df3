// The hash, parity and noise. Contract: contract.h.
#ifndef GLINT_PATTERN_KERNEL_NOISE_H
#define GLINT_PATTERN_KERNEL_NOISE_H

#include "engine/render/pattern/kernel_call.h"
#include "engine/render/pattern/kernel_coefficients.h"
#include "engine/render/pattern/kernel_elementary.h"
#include "engine/render/pattern/kernel_exact.h"
#include "engine/render/stages/simd/elementary.h"

/// Combines the upper and the lower half of 64 bits; only the lower 32 bits of the result are used.
static inline vq q_fold(vq x) { return q_xor(x, q_shr(x, 32)); }

static inline vq q_times(vq x, uint32_t factor) { return q_mul(x, q_set(factor)); }

/// Returns an integer modulo 2^32.
static inline vq q_word(vd whole) { return d_bits(whole + d_set(GLINT_ROUNDER_DOUBLE)); }

/// Hashes a sum of products with GLINT_HASH_X, _Y, _Z and _SEED.
static inline vq q_hash(vq sum) { return q_fold(q_times(q_fold(sum), GLINT_HASH_A)); }

static inline vq q_hash_word(vq h, vq word, uint32_t factor) { return q_fold(q_times(q_xor(h, word), factor)); }

/// Converts 32 bits to a number in [0, 1).
static inline vd d_of_word(vq word)
{
    const vq fraction = q_shr(q_shl(word, 32), 12);
    return d_of_bits(q_or(fraction, q_set(0x3ff0000000000000))) - d_set(1);
}

static inline vd d_hash(vd x, vd y, vd z)
{
    const vd p[3] = { x, y, z }, zero = d_set(0);
    vq h = q_set(GLINT_HASH_SEED);
    for (int k = 0; k < 3; k++) {
        const vq bits = d_bits(d_select(d_eq(p[k], p[k]), p[k] + zero, zero));
        h = q_hash_word(h, bits, GLINT_HASH_A);
        h = q_hash_word(h, q_shr(bits, 32), GLINT_HASH_B);
    }
    return d_of_word(q_times(q_fold(q_times(h, GLINT_HASH_C)), GLINT_HASH_X));
}

static inline vd d_odd(vd whole) { return whole - d_set(2) * d_floor(d_set(0.5) * whole); }

OP_KERNEL(hash, OP_ABC, d_hash(a, b, c))
static inline dm d_below(vd x, double limit) { return d_lt(d_abs(x), d_set(limit)); }

/// Returns the lowest bit of the sum of integer parts.
static inline vd d_parity(vd a, vd b, vd c)
{
    if (dm_bits(dm_and(d_below(a, 0x1p51), dm_and(d_below(b, 0x1p51), d_below(c, 0x1p51)))) != D_ALL)
        return d_odd((d_odd(d_floor(a)) + d_odd(d_floor(b))) + d_odd(d_floor(c)));
    const vq bit = q_and(q_xor(d_floor_bits(a), q_xor(d_floor_bits(b), d_floor_bits(c))), q_set(1));
    const vd rounder = d_set(GLINT_ROUNDER_DOUBLE);
    return d_of_bits(q_or(d_bits(rounder), bit)) - rounder;
}

OP_KERNEL(parity, OP_ABC, d_parity(a, b, c))

/// The position of a point in its unit cube.
typedef struct noise_place {
    vq word[2][4]; ///< terms of the hash: word[0] for the four edges along z, x fastest; word[1] for the two sides
        ///< along z
    vd from[3][2]; ///< offsets from each of the cube's two sides along an axis to the point
    vd fade[3];
} noise_place;

INNER void noise_locate(const vd p[3], noise_place *at)
{
    static const uint32_t factor[3] = { GLINT_HASH_X, GLINT_HASH_Y, GLINT_HASH_Z };
    vq word[3][2];
    for (int k = 0; k < 3; k++) {
        const vd whole = d_floor(p[k]), t = p[k] - whole;
        const vq first = q_word(whole);
        word[k][0] = q_times(first, factor[k]);
        word[k][1] = q_times(q_add(first, q_set(1)), factor[k]);
        at->from[k][0] = t;
        at->from[k][1] = t - d_set(1);
        at->fade[k] = t * t * t * (t * (t * d_set(6) - d_set(15)) + d_set(10));
    }
    for (int c = 0; c < 4; c++)
        at->word[0][c] = q_add(word[0][c & 1], word[1][c >> 1]);
    for (int c = 0; c < 2; c++)
        at->word[1][c] = word[2][c];
}

INNER vd d_between(vd t, vd a, vd b) { return a + t * (b - a); }

/// Returns the hash of a corner's gradient, in bits 28 .. 31.
INNER vq noise_gradient(const noise_place *at, int c, vq seed)
{
    const vq sum = q_add(at->word[0][c & 3], q_add(at->word[1][c >> 2], seed));
    return q_times(q_hash(sum), GLINT_HASH_B);
}

/// Returns -x where the first, or second, bit of a gradient's hash is set, otherwise x.
INNER vd d_negated_by_first(vd x, vq h)
{
    return d_of_bits(q_xor(d_bits(x), q_and(q_shl(h, 35), q_set((uint64_t)1 << 63))));
}
INNER vd d_negated_by_second(vd x, vq h)
{
    return d_of_bits(q_xor(d_bits(x), q_and(q_shl(h, 34), q_set((uint64_t)1 << 63))));
}

/// The two axes of a gradient.
typedef struct noise_axes {
    dm y_first; ///< lanes whose first axis is y; it is x in the other lanes
    dm y_second, x_second; ///< lanes whose second axis is y; is x; it is z in the other lanes
} noise_axes;

INNER noise_axes noise_axes_of(vq h)
{
    return (noise_axes) { q_test(h, 8u << 28), q_is(h, 12u << 28, 0), q_is(h, 13u << 28, 12u << 28) };
}

/// Returns the dot product of a corner's gradient and the vector from the corner to the point.
INNER vd noise_ramp(const noise_place *at, int c, vq h, const noise_axes *axes)
{
    const vd x = at->from[0][c & 1], y = at->from[1][c >> 1 & 1], z = at->from[2][c >> 2];
    const vd first = d_select(axes->y_first, y, x);
    const vd second = d_select(axes->y_second, y, d_select(axes->x_second, x, z));
    return d_negated_by_first(first, h) + d_negated_by_second(second, h);
}

INNER vd noise_between(const noise_place *at, const vd corner[8])
{
    const vd *f = at->fade;
    const vd near = d_between(f[1], d_between(f[0], corner[0], corner[1]), d_between(f[0], corner[2], corner[3]));
    const vd far = d_between(f[1], d_between(f[0], corner[4], corner[5]), d_between(f[0], corner[6], corner[7]));
    return d_between(f[2], near, far);
}

INNER vd noise_of(const noise_place *at, vq seed)
{
    vd ramp[8];
    for (int c = 0; c < 8; c++) {
        const vq h = noise_gradient(at, c, seed);
        const noise_axes axes = noise_axes_of(h);
        ramp[c] = noise_ramp(at, c, h, &axes);
    }
    return d_set(GLINT_NOISE_SCALE) * noise_between(at, ramp);
}

static void op_noise(const op_call *call)
{
    for (size_t i = 0; i < call->lanes; i += VD) {
        const vd p[3] = { op_in(call, 0, i), op_in(call, 1, i), op_in(call, 2, i) };
        noise_place at;
        noise_locate(p, &at);
        d_store(call->out[0] + i, noise_of(&at, q_set(0)));
    }
}

static void op_noise3(const op_call *call)
{
    for (size_t i = 0; i < call->lanes; i += VD) {
        const vd p[3] = { op_in(call, 0, i), op_in(call, 1, i), op_in(call, 2, i) };
        noise_place at;
        noise_locate(p, &at);
        for (uint32_t k = 0; k < 3; k++)
            d_store(call->out[k] + i, noise_of(&at, q_times(q_set(k + 1), GLINT_HASH_SEED)));
    }
}

/// Computes the contribution of a step along an axis to the slope, interpolated along the other two axes.
INNER vd noise_across(const noise_place *at, const vd corner[8], int axis)
{
    const int step = 1 << axis, a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    vd edge[4];
    for (int k = 0; k < 4; k++) {
        const int c = (k & 1) << a | (k >> 1) << b;
        edge[k] = corner[c + step] - corner[c];
    }
    return d_between(at->fade[b], d_between(at->fade[a], edge[0], edge[1]), d_between(at->fade[a], edge[2], edge[3]));
}

/// Returns the component of a gradient along an axis: -1, 0 or 1.
INNER vd noise_along(vq h, const noise_axes *axes, int axis)
{
    const vd zero = d_set(0), first = d_negated_by_first(d_set(1), h), second = d_negated_by_second(d_set(1), h);
    if (axis == 0)
        return d_select(axes->y_first, d_select(axes->x_second, second, zero), first);
    if (axis == 1)
        return d_select(axes->y_first, first, d_select(axes->y_second, second, zero));
    return d_select(dm_or(axes->y_second, axes->x_second), zero, second);
}

static void op_noise_slope(const op_call *call)
{
    for (size_t i = 0; i < call->lanes; i += VD) {
        const vd p[3] = { op_in(call, 0, i), op_in(call, 1, i), op_in(call, 2, i) };
        const vq seed = q_times(q_word(op_in(call, 3, i)), GLINT_HASH_SEED);
        noise_place at;
        vd ramp[8], along[3][8];
        noise_locate(p, &at);
        for (int c = 0; c < 8; c++) {
            const vq h = noise_gradient(&at, c, seed);
            const noise_axes axes = noise_axes_of(h);
            ramp[c] = noise_ramp(&at, c, h, &axes);
            for (int k = 0; k < 3; k++)
                along[k][c] = noise_along(h, &axes, k);
        }
        for (int k = 0; k < 3; k++) {
            const vd t = at.from[k][0], steep = d_set(30) * (t * t) * (t * (t - d_set(2)) + d_set(1));
            const vd slope = noise_between(&at, along[k]) + steep * noise_across(&at, ramp, k);
            d_store(call->out[k] + i, d_set(GLINT_NOISE_SCALE) * slope);
        }
    }
}

#endif
