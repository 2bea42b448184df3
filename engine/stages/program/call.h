// What the kernels of operations have in common: one reads whole rows and writes whole rows, a vector after the other, and of
// each vector reads all operands before it writes a result, which may be in an operand's place.

typedef struct op_call {
    const double *in[GLINT_OPERANDS_MAX];
    size_t step[GLINT_OPERANDS_MAX]; ///< lane & step: where in an operand; 0 of a number, which stands there for one vector
    double *out[GLINT_RESULTS_MAX];
    size_t lanes;
    const glint_texture_table *texture;
} op_call;

static inline vd op_in(const op_call *call, int k, size_t lane)
{
    return d_load(call->in[k] + (lane & call->step[k]));
}

// One result from operands a, from a and b, from a, b and c.
#define OP_KERNEL(name, operands, expression) \
    static void op_##name(const op_call *call) \
    { \
        const op_call at = *call; \
        for (size_t i = 0; i < at.lanes; i += VD) { \
            operands; \
            d_store(at.out[0] + i, expression); \
        } \
    }
#define OP_A const vd a = op_in(&at, 0, i)
#define OP_AB OP_A, b = op_in(&at, 1, i)
#define OP_ABC OP_AB, c = op_in(&at, 2, i)

/// 1 where the mask is set, else 0.
static inline vd d_truth(dm mask) { return d_select(mask, d_set(1), d_set(0)); }

static inline vd d_horner(const double *c, int count, vd x)
{
    vd p = d_set(c[count - 1]);
    for (int i = count - 2; i >= 0; i--)
        p = p * x + d_set(c[i]);
    return p;
}
#define D_HORNER(name, x) d_horner(name, (int)(sizeof name / sizeof *name), x)

/// Replaces lanes of y by what a scalar function makes of those of a and b.
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
