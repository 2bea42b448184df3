// Elementary functions of doubles. Maximum errors:
//   sin, cos: 4e-16
//   exp2: 2.5e-16 of the result; for subnormal results, one unit in the last place
//   log2: 4e-16 of the result, or 4e-16 if the result is smaller than 1
//   pow: 1e-12 of the result
//   atan2, acos: 6e-16
// Contract: contract.h.
#ifndef GLINT_PATTERN_KERNEL_ELEMENTARY_H
#define GLINT_PATTERN_KERNEL_ELEMENTARY_H

#include "engine/render/pattern/kernel_call.h"
#include "engine/render/pattern/kernel_coefficients.h"
#include "engine/render/pattern/kernel_exact.h"
#include "engine/render/stages/simd/elementary.h"

static double scalar_sine(double x, double quarter) { return quarter != 0 ? glint_cos(x) : glint_sin(x); }

/// Returns the sine (quarter 0) or the cosine (quarter 1). Lanes with angles beyond GLINT_ANGLE_MAX are reduced one
/// by one.
INNER vd d_sine(vd x, uint64_t quarter)
{
    static const double sine[] = GLINT_SINE, cosine[] = GLINT_COSINE;
    const vd shifted = x * d_set(GLINT_2_PI) + d_set(GLINT_ROUNDER_DOUBLE), q = shifted - d_set(GLINT_ROUNDER_DOUBLE);
    const vd r = ((x - q * d_set(GLINT_HALF_PI_HIGH)) - q * d_set(GLINT_HALF_PI_MIDDLE)) - q * d_set(GLINT_HALF_PI_LOW);
    const vd z = r * r, s = r + (r * z) * D_HORNER(sine, z), c = d_set(1) + z * D_HORNER(cosine, z);
    const vq quadrant = q_add(d_bits(shifted), q_set(quarter));
    const vd y = d_select(q_test(quadrant, 1), c, s);
    const vd negated = d_of_bits(q_xor(d_bits(y), q_shl(q_and(quadrant, q_set(2)), 62)));
    const unsigned wide = D_ALL & ~dm_bits(d_le(d_abs(x), d_set(GLINT_ANGLE_MAX)));
    return wide ? d_each(negated, wide, x, d_set((double)quarter), scalar_sine) : negated;
}

/// Returns 2^n for an integer n, -1022 .. 1023.
static inline vd d_power_of_2(vd n) { return d_of_bits(q_shl(d_bits(n + d_set(0x1p52 + 1023)), 52)); }

static inline vd d_exp2(vd y)
{
    static const double series[] = GLINT_POWER_OF_2;
    const vd x = d_min(d_max(y, d_set(-1100)), d_set(1100));
    const vd n = (x + d_set(GLINT_ROUNDER_DOUBLE)) - d_set(GLINT_ROUNDER_DOUBLE), half = d_floor(d_set(0.5) * n);
    const vd power = (D_HORNER(series, x - n) * d_power_of_2(half)) * d_power_of_2(n - half);
    return d_select(d_eq(y, y), power, y);
}

static inline vd d_log2(vd x)
{
    static const double ratio[] = GLINT_LOG2_RATIO;
    const vd zero = d_set(0), one = d_set(1), infinity = d_set(INFINITY);
    const dm subnormal = d_lt(x, d_set(0x1p-1022));
    const vd scaled = d_select(subnormal, x * d_set(0x1p54), x);
    vd e = d_select(subnormal, d_set(-54), zero) + d_exponent(scaled), m = d_mantissa(scaled);
    const dm upper = d_le(d_set(GLINT_SQRT2), m);
    m = d_select(upper, d_set(0.5) * m, m);
    e = d_select(upper, e + one, e);
    const vd s = (m - one) / (m + one), log = e + s * D_HORNER(ratio, s * s);
    const vd beyond = d_select(d_lt(x, zero), d_set(NAN), d_select(d_eq(x, zero), -infinity, x));
    return d_select(dm_and(d_lt(zero, x), d_lt(x, infinity)), log, beyond);
}

static inline vd d_pow(vd x, vd y)
{
    const vd zero = d_set(0), one = d_set(1), size = d_abs(x), half = d_set(0.5) * y;
    const dm whole = d_eq(d_floor(y), y), even = d_eq(d_set(2) * d_floor(half), y), known = d_eq(y, y);
    vd power = d_exp2(y * d_log2(size));
    power = d_select(dm_and(d_eq(size, one), known), one, power);
    const dm negative = dm_and(d_lt(d_set(-INFINITY), x), d_lt(x, zero));
    power = d_select(dm_andnot(negative, whole), d_set(NAN), power);
    const dm negated = dm_and(d_lt(d_copysign(one, x), zero), dm_andnot(whole, even));
    power = d_select(negated, -power, power);
    return d_select(dm_or(d_eq(x, one), d_eq(y, zero)), one, power);
}

static inline vd d_atan2(vd y, vd x)
{
    static const double arc[] = GLINT_ARC_TANGENT;
    const vd zero = d_set(0), one = d_set(1), ax = d_abs(x), ay = d_abs(y);
    const dm steep = d_lt(ax, ay);
    const vd low = d_select(steep, ax, ay), high = d_select(steep, ay, ax);
    vd t = d_select(d_eq(low, high), one, low / high);
    t = d_select(d_eq(high, zero), zero, t);
    const dm upper = d_lt(d_set(GLINT_TAN_PI_8), t);
    t = d_select(upper, (t - one) / (t + one), t);
    vd angle = t * D_HORNER(arc, t * t);
    angle = d_select(upper, angle + d_set(GLINT_PI_4), angle);
    angle = d_select(steep, d_set(GLINT_PI_2) - angle, angle);
    angle = d_select(d_lt(d_copysign(one, x), zero), d_set(GLINT_PI_1) - angle, angle);
    return d_select(dm_and(d_eq(x, x), d_eq(y, y)), d_copysign(angle, y), d_set(NAN));
}

static inline vd d_acos(vd x)
{
    static const double arc[] = GLINT_ARC_SINE;
    const vd size = d_abs(x), two = d_set(2);
    const dm middle = d_le(size, d_set(0.5));
    const vd t = d_select(middle, x, d_sqrt(d_set(0.5) * (d_set(1) - size)));
    const vd angle = t * D_HORNER(arc, t * t);
    const vd outer = d_select(d_lt(x, d_set(0)), d_set(GLINT_PI_1) - two * angle, two * angle);
    return d_select(middle, d_set(GLINT_PI_2) - angle, outer);
}

OP_KERNEL(sin, OP_A, d_sine(a, 0))
OP_KERNEL(cos, OP_A, d_sine(a, 1))
OP_KERNEL(exp2, OP_A, d_exp2(a))
OP_KERNEL(log2, OP_A, d_log2(a))
OP_KERNEL(pow, OP_AB, d_pow(a, b))
OP_KERNEL(atan2, OP_AB, d_atan2(a, b))
OP_KERNEL(acos, OP_A, d_acos(a))

/// Computes the highlight S as the stage shade does, in float.
static void op_highlight(const op_call *call)
{
    const vd zero = d_set(0), one = d_set(1);
    for (size_t i = 0; i < call->lanes; i += VF) {
        vd x[VF / VD], s[VF / VD], out[VF / VD];
        unsigned shiny = 0;
        for (int k = 0; k < VF / VD; k++) {
            const vd cosine = op_in(call, 0, i + (size_t)k * VD), exponent = op_in(call, 1, i + (size_t)k * VD);
            const dm there = d_le(d_set(0x1p-126), cosine);
            shiny |= dm_bits(there) << k * VD;
            x[k] = d_select(there, d_min(cosine, one), one);
            s[k] = d_min(d_max(exponent, zero), d_set((double)FLT_MAX));
        }
        out[0] = out[VF / VD - 1] = zero;
        if (shiny) {
            const vf y = f_join(s[0], s[1]) * f_log2(f_join(x[0], x[1]), f_join(x[0] - one, x[1] - one));
            if (fm_bits(f_le(f_set(GLINT_EXP2_LOWEST), y)))
                f_split(f_select(fm_from_bits(shiny), f_exp2(y), f_set(0)), out);
        }
        for (int k = 0; k < VF / VD; k++)
            d_store(call->out[0] + i + (size_t)k * VD, out[k]);
    }
}

#endif
