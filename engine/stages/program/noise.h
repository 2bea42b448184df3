// The hash, parity and noise. Contract: contract/program.h.

/// The lower 32 bits count.
static inline vq q_fold(vq x) { return q_xor(x, q_shr(x, 32)); }

static inline vq q_times(vq x, uint32_t factor) { return q_mul(x, q_set(factor)); }

/// A whole number modulo 2^32.
static inline vq q_word(vd whole) { return d_bits(whole + d_set(GLINT_ROUNDER_DOUBLE)); }

/// What a sum of products by GLINT_HASH_X, _Y, _Z and _SEED is as a number without a pattern.
static inline vq q_hash(vq sum) { return q_fold(q_times(q_fold(sum), GLINT_HASH_A)); }

static inline vq q_hash_word(vq h, vq word, uint32_t factor) { return q_fold(q_times(q_xor(h, word), factor)); }

/// 32 bits as a number of [0, 1).
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
OP_KERNEL(parity, OP_ABC, d_odd((d_odd(d_floor(a)) + d_odd(d_floor(b))) + d_odd(d_floor(c))))

/// Where a point is among the corners of its cube.
typedef struct noise_place {
    vq word[3][2]; ///< of the hash: the lower and the upper side along each axis
    vd from[3][2]; ///< from either to the point
    vd fade[3];
} noise_place;

INNER void noise_locate(const vd p[3], noise_place *at)
{
    static const uint32_t factor[3] = { GLINT_HASH_X, GLINT_HASH_Y, GLINT_HASH_Z };
    for (int k = 0; k < 3; k++) {
        const vd whole = d_floor(p[k]), t = p[k] - whole;
        const vq word = q_word(whole);
        at->word[k][0] = q_times(word, factor[k]);
        at->word[k][1] = q_times(q_add(word, q_set(1)), factor[k]);
        at->from[k][0] = t;
        at->from[k][1] = t - d_set(1);
        at->fade[k] = t * t * t * (t * (t * d_set(6) - d_set(15)) + d_set(10));
    }
}

INNER vd d_between(vd t, vd a, vd b) { return a + t * (b - a); }

INNER vq noise_corner(const noise_place *at, int c, vq seed)
{
    return q_add(q_add(q_add(at->word[0][c & 1], at->word[1][c >> 1 & 1]), at->word[2][c >> 2]), seed);
}

/// -x where the bit of h is set.
INNER vd d_turned(vd x, vq h, int bit) { return d_of_bits(q_xor(d_bits(x), q_shl(q_shr(h, bit), 63))); }

/// Which two axes a gradient is of, by bits 0 .. 3 of its hash.
typedef struct noise_axes {
    dm y_first; ///< the first axis is y, else x
    dm y_second, x_second; ///< the second is y or x, else z
} noise_axes;

INNER noise_axes noise_axes_of(vq h)
{
    const dm upper = q_test(h, 8), middle = q_test(h, 4);
    const dm either = dm_or(upper, middle), all = dm_from_bits(D_ALL);
    return (noise_axes) { upper, dm_andnot(all, either), dm_andnot(dm_and(upper, middle), q_test(h, 1)) };
}

/// The gradient of a corner times the way from there to the point.
INNER vd noise_ramp(const noise_place *at, int c, vq h, const noise_axes *axes)
{
    const vd x = at->from[0][c & 1], y = at->from[1][c >> 1 & 1], z = at->from[2][c >> 2];
    const vd first = d_select(axes->y_first, y, x);
    const vd second = d_select(axes->y_second, y, d_select(axes->x_second, x, z));
    return d_turned(first, h, 0) + d_turned(second, h, 1);
}

INNER vd noise_between(const noise_place *at, const vd corner[8])
{
    const vd *f = at->fade;
    const vd near = d_between(f[1], d_between(f[0], corner[0], corner[1]), d_between(f[0], corner[2], corner[3]));
    const vd far = d_between(f[1], d_between(f[0], corner[4], corner[5]), d_between(f[0], corner[6], corner[7]));
    return d_between(f[2], near, far);
}

INNER vq noise_gradient(const noise_place *at, int c, vq seed)
{
    return q_shr(q_times(q_hash(noise_corner(at, c, seed)), GLINT_HASH_B), 28);
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

/// What a step along an axis adds, the other two axes between corners.
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

/// The part of a gradient along an axis: -1, 0 or 1.
INNER vd noise_along(vq h, const noise_axes *axes, int axis)
{
    const vd zero = d_set(0), first = d_turned(d_set(1), h, 0), second = d_turned(d_set(1), h, 1);
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
