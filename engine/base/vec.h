/// Vectors of three doubles. Internal; arithmetic has a fixed order, as in the stages.
#ifndef GLINT_BASE_VEC_H
#define GLINT_BASE_VEC_H

#include <math.h>
#include <stdbool.h>
#include <string.h>

static inline double vec_dot(const double a[3], const double b[3]) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }

static inline void vec_copy(double out[3], const double v[3]) { memmove(out, v, 3 * sizeof *out); }

static inline void vec_sub(double out[3], const double a[3], const double b[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = a[c] - b[c];
}

static inline void vec_scale(double out[3], const double v[3], double s)
{
    for (int c = 0; c < 3; c++)
        out[c] = v[c] * s;
}

static inline void vec_cross(double out[3], const double a[3], const double b[3])
{
    const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    out[0] = x, out[1] = y, out[2] = z;
}

static inline double vec_max_abs(const double v[3]) { return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2]))); }

/// Returns the power of two that scales x > 0 into [1, 2), limited to normal numbers.
static inline double power_of_two_scale(double x)
{
    int exponent;
    frexp(x, &exponent);
    exponent = 1 - exponent;
    return ldexp(1, exponent < -1022 ? -1022 : exponent > 1022 ? 1022 : exponent);
}

/// Scales by a power of two so that the largest component is in [1, 2), and squares neither overflow nor underflow.
/// Returns the factor.
static inline double vec_rescale(double out[3], const double v[3])
{
    const double scale = power_of_two_scale(vec_max_abs(v));
    vec_scale(out, v, scale);
    return scale;
}

/// Normalises a finite vector that is not zero.
static inline void vec_normalize(double out[3], const double v[3])
{
    const double largest = vec_max_abs(v);
    if (largest > 0x1p-400 && largest < 0x1p400) { // squares neither overflow nor underflow
        vec_copy(out, v);
    } else {
        vec_rescale(out, v);
        vec_rescale(out, out); // a subnormal vector may need a second step
    }
    const double length = sqrt(vec_dot(out, out));
    for (int c = 0; c < 3; c++)
        out[c] /= length;
}

/// Computes two tangents to a unit vector, as the stages scatter and spread do (T. Duff et al., "Building an Orthonormal
/// Basis, Revisited", JCGT 6(1), 2017).
static inline void vec_tangents(const double n[3], double tangent[3], double bitangent[3])
{
    const double g = n[2] >= 0 ? 1 : -1, p = -1 / (g + n[2]), q = n[0] * n[1] * p;
    tangent[0] = 1 + g * (n[0] * n[0] * p);
    tangent[1] = g * q;
    tangent[2] = 0 - g * n[0];
    bitangent[0] = q;
    bitangent[1] = g + n[1] * n[1] * p;
    bitangent[2] = 0 - n[1];
}

#endif
