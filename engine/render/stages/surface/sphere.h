// sphere: the point and the normal of hits of a sphere. Contract: stages.h, surface.
#ifndef GLINT_SURFACE_SPHERE_H
#define GLINT_SURFACE_SPHERE_H

#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/simd/real.h"

/// Computes the normal if the origin is so far away that origin plus t direction loses all digits of the sphere. The
/// normal is instead computed from the foot of the perpendicular from the centre to the ray.
static inline void R(far_normal)(const vr f[3], const vr d[3], vr r2, vr n[3])
{
    const vr zero = r_set(0);
    vr a = DOT(d, d), b = -DOT(f, d), w = b / a;
    vr l[3] = { f[0] + w * d[0], f[1] + w * d[1], f[2] + w * d[2] };
    vr c = DOT(f, f) - r2;
    vr h = r_sqrt(r_max(r2 - DOT(l, l), zero) / a);
    rm entering = rm_and(r_le(zero, b), r_le(zero, c));
    for (int k = 0; k < 3; k++)
        n[k] = r_select(entering, l[k] - h * d[k], l[k] + h * d[k]);
    vr m = DOT(n, n), length = r_sqrt(m), ray = r_sqrt(a);
    rm defined = r_lt(zero, m);
    for (int k = 0; k < 3; k++)
        n[k] = r_select(defined, n[k] / length, -d[k] / ray);
}

/// Bounds of the distance between the origin and the sphere, for all lanes.
typedef enum R(sphere_range) { R(RANGE_ANY), R(RANGE_NEAR), R(RANGE_CLOSE) } R(sphere_range);

/// Returns the range for a camera. f: from the sphere's centre to the eye.
static R(sphere_range) R(range_of)(const real f[3])
{
    const real ff = DOT(f, f);
    return ff < GLINT_SPHERE_CLOSE ? R(RANGE_CLOSE) : ff < (real)GLINT_SPHERE_NEAR ? R(RANGE_NEAR) : R(RANGE_ANY);
}

INNER void R(sphere_surface)(const vr f[3], const vr d[3], vr t, const glint_prim *prim, real scale, real inverse_radius,
                             R(sphere_range) range, vr n[3], vr p[3])
{
    const vr radius = r_set(prim->radius);
    vr ts = t * r_set(scale);
    for (int k = 0; k < 3; k++)
        n[k] = (f[k] + ts * d[k]) * r_set(inverse_radius);
    if (range != R(RANGE_CLOSE)) {
        const vr newton = r_set(1.5) - r_set(0.5) * DOT(n, n);
        const rm close = range == R(RANGE_NEAR) ? rm_from_bits(0) : r_lt(DOT(f, f), r_set(GLINT_SPHERE_CLOSE));
        for (int k = 0; k < 3; k++)
            n[k] = r_select(close, n[k], n[k] * newton);
    }
    if (range == R(RANGE_ANY)) {
        const rm near = r_lt(DOT(f, f), r_set(GLINT_SPHERE_NEAR));
        vr far[3];
        if (rm_bits(near) != (1u << VR) - 1)
            R(far_normal)(f, d, r_set(glint_sphere_r2(prim)), far);
        for (int k = 0; k < 3 && rm_bits(near) != (1u << VR) - 1; k++)
            n[k] = r_select(near, n[k], far[k]);
    }
    for (int k = 0; k < 3; k++)
        p[k] = r_set(prim->center[k]) + radius * n[k];
}

#endif
