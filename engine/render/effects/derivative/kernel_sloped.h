// The vector vocabulary of derivatives: numbers with their slopes. Where `level` is a constant, the compiler
// removes the code for slopes that are 0. s_keep makes `level` a constant where branches join.
#ifndef GLINT_DERIVATIVE_KERNEL_SLOPED_H
#define GLINT_DERIVATIVE_KERNEL_SLOPED_H

#include "engine/render/pattern/kernel_elementary.h"
#include "engine/render/pattern/kernel_exact.h"
#include "engine/render/stages/simd/elementary.h"

/// Selects between two vectors of the same type, whatever type the compiler gives to sums.
INNER vd d_either(bool first, vd a, vd b) { return first ? a : b; }

typedef struct vs {
    vd v, d; ///< values and slopes
    bool level; ///< true: all slopes are 0, and d is not read
} vs;

INNER vs s_make(vd v, vd d) { return (vs) { v, d, false }; }
INNER vs s_level(vd v) { return (vs) { v, d_set(0), true }; }
INNER vs s_set(double x) { return s_level(d_set(x)); }
INNER vs s_of(bool sloped, glint_dual x) { return (vs) { d_set(x.value), d_set(sloped ? x.slope : 0), !sloped }; }
INNER vs s_load(const double *value, const double *slope, bool sloped, int i)
{
    return (vs) { d_load(value + i), sloped ? d_load(slope + i) : d_set(0), !sloped };
}

/// Returns `a`, with its slopes only if `sloped` is true.
INNER vs s_keep(bool sloped, vs a) { return (vs) { a.v, a.level ? d_set(0) : a.d, !sloped }; }

INNER vs s_add(vs a, vs b)
{
    return (vs) { a.v + b.v, d_either(a.level, b.d, d_either(b.level, a.d, a.d + b.d)), a.level && b.level };
}
INNER vs s_sub(vs a, vs b)
{
    return (vs) { a.v - b.v, d_either(b.level, a.d, d_either(a.level, d_set(0) - b.d, a.d - b.d)), a.level && b.level };
}
INNER vs s_mul(vs a, vs b)
{
    const vd d = d_either(a.level, a.v * b.d, d_either(b.level, a.d * b.v, a.d * b.v + a.v * b.d));
    return (vs) { a.v * b.v, d_either(a.level && b.level, d_set(0), d), a.level && b.level };
}
INNER vs s_div(vs a, vs b)
{
    const vd q = a.v / b.v;
    if (a.level && b.level)
        return s_level(q);
    return s_make(q, d_either(b.level, a.d, d_either(a.level, d_set(0) - q * b.d, a.d - q * b.d)) / b.v);
}
INNER vs s_sqrt(vs a)
{
    const vd r = d_sqrt(a.v), zero = d_set(0);
    return a.level ? s_level(r) : s_make(r, d_select(d_lt(zero, r), (d_set(0.5) * a.d) / r, zero));
}

/// A square root and its inverse. Their slopes need no further division.
typedef struct vs_length {
    vs whole, inverse;
} vs_length;

INNER vs_length s_length(vs square)
{
    const vd r = d_sqrt(square.v), q = d_set(1) / r, zero = d_set(0);
    if (square.level)
        return (vs_length) { s_level(r), s_level(q) };
    const vd slope = d_select(d_lt(zero, r), (d_set(0.5) * square.d) * q, zero);
    return (vs_length) { s_make(r, slope), s_make(q, (zero - q * slope) * q) };
}

INNER vs s_select(dm mask, vs a, vs b)
{
    return (vs) { d_select(mask, a.v, b.v), a.level && b.level ? d_set(0) : d_select(mask, a.d, b.d), a.level && b.level };
}
/// Return the minimum, which is b unless a < b, and the maximum.
INNER vs s_min(vs a, vs b) { return s_select(d_lt(a.v, b.v), a, b); }
INNER vs s_max(vs a, vs b) { return s_select(d_lt(b.v, a.v), a, b); }
INNER vs s_dot(const vs a[3], const vs b[3])
{
    return s_add(s_add(s_mul(a[0], b[0]), s_mul(a[1], b[1])), s_mul(a[2], b[2]));
}

/// Returns x^s for x in 0 .. 1, and 0 if x is not above 0.
INNER vs s_pow(vs x, vs s)
{
    const vd zero = d_set(0), one = d_set(1), ln_2 = d_set(0x1.62e42fefa39efp-1);
    const dm there = d_lt(zero, x.v);
    if (!dm_bits(there)) // many groups are far from any highlight
        return (vs) { zero, zero, x.level && s.level };
    const vd base = d_select(there, d_min(x.v, one), one), log2 = d_log2(base), y = d_exp2(s.v * log2);
    const vd value = d_select(there, y, zero);
    if (x.level && s.level)
        return s_level(value);
    const vd by_base = (s.v / base) * x.d, by_power = (ln_2 * log2) * s.d;
    const vd slope = y * d_either(x.level, by_power, d_either(s.level, by_base, by_base + by_power));
    return s_make(value, d_select(there, slope, zero));
}

#endif
