// bounce: the directions of reflected rays and of refracted rays, by Snell's law. Contract: contract.h.
#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/simd/real.h"

/// Computes a vector of rays. Returns the lanes in which a ray is refracted.
static inline unsigned R(bounce_lanes)(const glint_bounce_args *args, const vr d[3], size_t at)
{
    const vr zero = r_set(0), one = r_set(1);
    vr n[3], u[3];
    R(load3)(args->normal, at, n);
    const vr length = r_sqrt(DOT(d, d));
    for (int k = 0; k < 3; k++)
        u[k] = d[k] / length;
    const vr c = r_min(r_max(-DOT(n, u), zero), one), r = r_load((const real *)args->ratio + at);
    const rm same = r_eq(r, one);
    const vr k2 = one - (r * r) * (one - c * c);
    const vr s = r_select(same, c, r_sqrt(r_max(k2, zero)));
    const vr turn = r_set(2) * c, x = r * c, y = r * s, bend = x - s;
    const vr p = (x - s) / (x + s), q = (c - y) / (c + y);
    const rm open = rm_or(same, r_lt(zero, k2));
    vr reflectance = r_select(open, r_set(0.5) * (p * p + q * q), one);
    r_store((real *)args->reflectance + at, r_select(same, zero, reflectance));
    for (int k = 0; k < 3; k++) {
        r_store((real *)args->reflected[k] + at, u[k] + turn * n[k]);
        r_store((real *)args->refracted[k] + at, r * u[k] + bend * n[k]);
    }
    return rm_bits(open);
}

static void R(bounce)(const glint_bounce_args *args)
{
    for (R(group_cursor) cursor = { 0 }; cursor.g < args->group_count; R(next_group)(args->camera, &cursor)) {
        const uint32_t g = cursor.g;
        const size_t at = (size_t)g * GLINT_GROUP;
        const R(group_directions) directions = R(directions_of)(args->camera, cursor.x, cursor.y);
        unsigned through = 0;
        for (int i = 0; args->wanted[g] && i < GLINT_GROUP; i += VR) {
            vr d[3];
            R(load_direction)(directions, args->direction, at, i, d);
            through |= R(bounce_lanes)(args, d, at + (size_t)i) << i;
        }
        args->total[g] = (uint16_t)(args->wanted[g] & ~through);
    }
}

#if GLINT_WITH(BOUNCE)
KERNEL(bounce, glint_bounce_args)
#endif
