/// Dual numbers: a value and its derivative with respect to a parameter. Internal; conventions as in
/// engine/base/vec.h.
#ifndef GLINT_BASE_DUAL_H
#define GLINT_BASE_DUAL_H

#include "engine/glint_math.h"

#include <math.h>

typedef struct glint_dual {
    double value, slope;
} glint_dual;

static inline glint_dual dual(double value, double slope) { return (glint_dual) { value, slope }; }

static inline glint_dual dual_add(glint_dual a, glint_dual b) { return dual(a.value + b.value, a.slope + b.slope); }

static inline glint_dual dual_sub(glint_dual a, glint_dual b) { return dual(a.value - b.value, a.slope - b.slope); }

static inline glint_dual dual_mul(glint_dual a, glint_dual b)
{
    return dual(a.value * b.value, a.slope * b.value + a.value * b.slope);
}

static inline glint_dual dual_scale(glint_dual a, double s) { return dual(a.value * s, a.slope * s); }

static inline glint_dual dual_div(glint_dual a, glint_dual b)
{
    const double q = a.value / b.value;
    return dual(q, (a.slope - q * b.slope) / b.value);
}

static inline glint_dual dual_sqrt(glint_dual a)
{
    const double root = sqrt(a.value);
    return dual(root, root > 0 ? a.slope / (2 * root) : 0);
}

static inline glint_dual dual_cos(glint_dual a) { return dual(glint_cos(a.value), -glint_sin(a.value) * a.slope); }

/// 2^a.
static inline glint_dual dual_exp2(glint_dual a)
{
    const double power = glint_pow(2, a.value);
    return dual(power, power * (0x1.62e42fefa39efp-1 * a.slope));
}

/// Normalises a vector that is not zero.
static inline void dual_normalize(glint_dual v[3])
{
    const glint_dual length =
        dual_sqrt(dual_add(dual_add(dual_mul(v[0], v[0]), dual_mul(v[1], v[1])), dual_mul(v[2], v[2])));
    for (int c = 0; c < 3; c++)
        v[c] = dual_div(v[c], length);
}

#endif
