// Common code of the kernels of operations. Each kernel reads and writes whole rows, one vector after the other. For
// each vector, the kernel reads all operands before it writes a result, so that a result may overwrite an operand.
#ifndef GLINT_PATTERN_KERNEL_CALL_H
#define GLINT_PATTERN_KERNEL_CALL_H

#include "engine/render/stages/simd/elementary.h"

typedef struct op_call {
    const double *in[GLINT_OPERANDS_MAX];
    size_t step[GLINT_OPERANDS_MAX]; ///< operand k is read at index lane & step[k]; 0 for a constant, which is only
        ///< one group long
    double *out[GLINT_RESULTS_MAX];
    size_t lanes;
    const glint_texture_table *texture;
} op_call;

static inline vd op_in(const op_call *call, int k, size_t lane) { return d_load(call->in[k] + (lane & call->step[k])); }

// Defines kernels with one result, from the operands a; a and b; a, b and c; or a to f. The compiler unrolls the
// inner loop.
#define OP_KERNEL(name, operands, expression) \
    static void op_##name(const op_call *call) \
    { \
        const op_call at = *call; \
        const double *const end = at.out[0] + at.lanes; \
        operands(OP_BEGIN); \
        for (double *to = at.out[0]; to < end; to += GLINT_GROUP) { \
            for (int i = 0; i < GLINT_GROUP; i += VD) { \
                operands(OP_VECTOR); \
                d_store(to + i, expression); \
            } \
            operands(OP_NEXT); \
        } \
    }
#define OP_BEGIN(k, name) \
    const double *from_##name = at.in[k]; \
    const size_t group_of_##name = GLINT_GROUP & at.step[k]
#define OP_VECTOR(k, name) const vd name = d_load(from_##name + i)
#define OP_NEXT(k, name) from_##name += group_of_##name
#define OP_A(each) each(0, a)
#define OP_AB(each) \
    OP_A(each); \
    each(1, b)
#define OP_ABC(each) \
    OP_AB(each); \
    each(2, c)
#define OP_ABCDEF(each) \
    OP_ABC(each); \
    each(3, d); \
    each(4, e); \
    each(5, f)

/// Returns 1 where the mask is set, otherwise 0.
static inline vd d_truth(dm mask) { return d_select(mask, d_set(1), d_set(0)); }

static inline vd d_horner(const double *c, int count, vd x)
{
    vd p = d_set(c[count - 1]);
    for (int i = count - 2; i >= 0; i--)
        p = p * x + d_set(c[i]);
    return p;
}
#define D_HORNER(name, x) d_horner(name, (int)(sizeof name / sizeof *name), x)

/// Replaces the given lanes of y by a scalar function of these lanes of a and b.
static __attribute__((noinline)) vd d_each(vd y, unsigned lanes, vd a, vd b, double (*function)(double, double))
{
    _Alignas(64) double out[VD], x[2][VD];
    d_store(out, y);
    d_store(x[0], a);
    d_store(x[1], b);
    for (; lanes; lanes &= lanes - 1) {
        const int i = __builtin_ctz(lanes);
        out[i] = function(x[0][i], x[1][i]);
    }
    return d_load(out);
}

#define D_ALL ((1u << VD) - 1)

#endif
