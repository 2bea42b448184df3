/// The textbook's intersection, (-b +- sqrt(b^2 - 4ac)) / 2a, in float and in double, for comparison with the engine.
#ifndef HARD_NAIVE_H
#define HARD_NAIVE_H

#include "tests/hard/oracle/oracle.h"

#include <math.h>

#define NAIVE(name, real, root) \
    static inline bool name(const hard_ray *ray, const hard_sphere *sphere, double *t) \
    { \
        real a = 0, b = 0, c = 0; \
        for (int i = 0; i < 3; i++) { \
            const real d = (real)ray->d[i], f = (real)ray->o[i] - (real)sphere->c[i]; \
            a += d * d; \
            b += 2 * (d * f); \
            c += f * f; \
        } \
        c -= (real)sphere->r * (real)sphere->r; \
        const real disc = b * b - 4 * a * c; \
        if (!(disc >= 0)) \
            return false; \
        const real near = (-b - root(disc)) / (2 * a), far = (-b + root(disc)) / (2 * a); \
        *t = near > 0 ? near : far; \
        return *t > 0; \
    }

NAIVE(naive_float, float, sqrtf)
NAIVE(naive_double, double, sqrt)

#endif
