// Operations that round once or twice, and selections. Contract: contract.h.
#ifndef GLINT_PATTERN_KERNEL_EXACT_H
#define GLINT_PATTERN_KERNEL_EXACT_H

#include "engine/render/pattern/kernel_call.h"
#include "engine/render/stages/simd/elementary.h"

static inline vd d_round(vd x)
{
    const vd size = d_abs(x), whole = d_floor(size);
    const dm up = d_le(d_set(0.5), size - whole);
    return d_copysign(d_select(up, whole + d_set(1), whole), x);
}

static double scalar_fmod(double a, double b) { return fmod(a, b); }

/// Returns fmod(a, b). a - n b is exact, where n is the integer part of the quotient, or one more if the quotient was
/// rounded up to an integer.
static inline vd d_fmod(vd a, vd b)
{
    const vd size = d_abs(b), quotient = d_abs(a / b), n = d_floor(quotient);
    const dm easy =
        dm_and(d_lt(quotient, d_set(0x1p52)), dm_and(d_le(d_set(0x1p-500), size), d_le(size, d_set(0x1p500))));
    vd error, rest = d_two_prod(n, size, &error);
    rest = (d_abs(a) - rest) - error;
    rest = d_copysign(d_select(d_lt(rest, d_set(0)), rest + size, rest), a);
    const unsigned hard = D_ALL & ~dm_bits(easy);
    return hard ? d_each(rest, hard, a, b, scalar_fmod) : rest;
}

static inline dm d_is_between(double low, vd x, double high) { return dm_and(d_le(d_set(low), x), d_le(x, d_set(high))); }

static inline vd d_mod(vd a, vd b)
{
    const vd zero = d_set(0), m = d_fmod(a, b);
    const dm apart = dm_or(dm_and(d_lt(zero, m), d_lt(b, zero)), dm_and(d_lt(m, zero), d_lt(zero, b)));
    return d_select(apart, m + b, m);
}

/// Does the same if b is a power of two and `inverse` is 1 / b: except in rare lanes, only one product is rounded.
static inline vd d_mod_power(vd a, vd b, vd inverse)
{
    const vd size = d_abs(a), rest = a - d_floor(a * inverse) * b;
    const dm easy = dm_or(d_is_between(0x1p-500, size, 0x1p500), d_eq(size, d_set(0)));
    const vd m = d_select(d_eq(rest, d_set(0)), d_copysign(d_set(0), a), rest);
    return dm_bits(easy) == D_ALL ? m : d_select(easy, m, d_mod(a, b));
}

static inline vd d_clamp(vd x, vd low, vd high) { return d_min(d_max(x, low), high); }

static inline vd d_smoothstep(vd a, vd b, vd x)
{
    const vd t = d_clamp((x - a) / (b - a), d_set(0), d_set(1));
    return (t * t) * (d_set(3) - d_set(2) * t);
}

OP_KERNEL(add, OP_AB, a + b)
OP_KERNEL(sub, OP_AB, a - b)
OP_KERNEL(mul, OP_AB, (a * b))
OP_KERNEL(div_any, OP_AB, a / b)
OP_KERNEL(neg, OP_A, -a)
OP_KERNEL(abs, OP_A, d_abs(a))
OP_KERNEL(sqrt, OP_A, d_sqrt(a))
OP_KERNEL(min, OP_AB, d_min(a, b))
OP_KERNEL(max, OP_AB, d_max(a, b))
OP_KERNEL(floor, OP_A, d_floor(a))
OP_KERNEL(ceil, OP_A, d_ceil(a))
OP_KERNEL(round, OP_A, d_round(a))
OP_KERNEL(fract, OP_A, a - d_floor(a))
OP_KERNEL(mod_any, OP_AB, d_mod(a, b))
OP_KERNEL(mod_power, OP_ABC, d_mod_power(a, b, c))
OP_KERNEL(sign, OP_A, d_truth(d_lt(d_set(0), a)) - d_truth(d_lt(a, d_set(0))))
OP_KERNEL(muladd, OP_ABC, (a * b) + c)
OP_KERNEL(submul, OP_ABC, a - b * c)
OP_KERNEL(mulsub, OP_ABC, (a * b) - c)
OP_KERNEL(mulmul_any, OP_ABC, (a * b) * c)
OP_KERNEL(dot, OP_ABCDEF, (a * b + c * d) + e * f)
OP_KERNEL(mix, OP_ABC, a + c * (b - a))
OP_KERNEL(less, OP_AB, d_truth(d_lt(a, b)))
OP_KERNEL(lesseq, OP_AB, d_truth(d_le(a, b)))
OP_KERNEL(equal, OP_AB, d_truth(d_eq(a, b)))
OP_KERNEL(and, OP_AB, d_select(dm_or(d_eq(a, d_set(0)), d_eq(b, d_set(0))), d_set(0), d_set(1)))
OP_KERNEL(or, OP_AB, d_select(dm_and(d_eq(a, d_set(0)), d_eq(b, d_set(0))), d_set(0), d_set(1)))
OP_KERNEL(not, OP_A, d_truth(d_eq(a, d_set(0))))
OP_KERNEL(select, OP_ABC, d_select(d_eq(a, d_set(0)), c, b))
OP_KERNEL(step, OP_AB, d_select(d_lt(b, a), d_set(0), d_set(1)))
OP_KERNEL(smoothstep, OP_ABC, d_smoothstep(a, b, c))
OP_KERNEL(clamp, OP_ABC, d_clamp(a, b, c))

/// Reduces (a b) c, where a and b are constants, to a product of two operands. product: memory for a group of copies
/// of a b.
static inline void begin_mulmul(const op_call *call, double product[GLINT_GROUP], op_call *two)
{
    for (int i = 0; i < GLINT_GROUP; i += VD)
        d_store(product + i, d_load(call->in[0] + i) * d_load(call->in[1] + i));
    two->in[0] = product;
    two->in[1] = call->in[2];
    two->step[0] = 0;
    two->step[1] = call->step[2];
}

/// Computes (a b) c. a and b are often the same in all lanes, for example values of a material and a light.
static void op_mulmul(const op_call *call)
{
    _Alignas(64) double product[GLINT_GROUP];
    op_call two;
    if (call->step[0] | call->step[1]) {
        op_mulmul_any(call);
        return;
    }
    begin_mulmul(call, product, &two);
    two.out[0] = call->out[0];
    two.lanes = call->lanes;
    op_mul(&two);
}

// ---- Divisors that are powers of two ----

/// If operand k is a constant x, and x is a power of two in 2^-500 .. 2^500, stores 1 / x for a group and returns
/// true. Otherwise returns false.
static bool invert_power_of_2(const op_call *call, int k, double inverse[GLINT_GROUP])
{
    const double x = call->in[k][0];
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    if (call->step[k] || bits & 0x000fffffffffffff || !(x >= 0x1p-500 && x <= 0x1p500))
        return false;
    for (int i = 0; i < GLINT_GROUP; i++)
        inverse[i] = 1 / x;
    return true;
}

static void op_div(const op_call *call)
{
    _Alignas(64) double inverse[GLINT_GROUP];
    op_call at = *call;
    if (!invert_power_of_2(call, 1, inverse)) {
        op_div_any(call);
        return;
    }
    at.in[1] = inverse;
    op_mul(&at);
}

static void op_mod(const op_call *call)
{
    _Alignas(64) double inverse[GLINT_GROUP];
    op_call at = *call;
    if (!invert_power_of_2(call, 1, inverse)) {
        op_mod_any(call);
        return;
    }
    at.in[2] = inverse;
    at.step[2] = 0;
    op_mod_power(&at);
}

#endif
