// spread: rays that the facets of GGX's distribution reflect. Contract: stages.h.
#ifndef GLINT_SHADE_SPREAD_H
#define GLINT_SHADE_SPREAD_H

#include "engine/stages/shade/scatter.h"

/// Computes the normal of the facet at a point of the disk, for the eye at e along the basis.
static inline void R(facet_of)(const vr e[3], vr alpha, vr x, vr y, vr facet[3])
{
    const vr zero = r_set(0), one = r_set(1), sx = alpha * e[0], sy = alpha * e[1];
    const vr length = r_sqrt((sx * sx + sy * sy) + e[2] * e[2]);
    const vr u = r_min(x * x + y * y, one), top = one + e[2] / length;
    const vr stretch = r_sqrt(r_max(top * (r_set(2) - u * top), zero));
    const vr fx = alpha * (x * stretch + sx / length), fy = alpha * (y * stretch + sy / length), fz = (one - u) * top;
    const vr size = r_sqrt((fx * fx + fy * fy) + fz * fz);
    const rm some = r_lt(zero, size);
    facet[0] = r_select(some, fx / size, zero);
    facet[1] = r_select(some, fy / size, zero);
    facet[2] = r_select(some, fz / size, one);
}

static inline void R(spread_lanes)(const glint_spread_args *args, size_t at)
{
    const vr zero = r_set(0), one = r_set(1), alpha = r_load((const real *)args->alpha + at), aa = alpha * alpha;
    vr n[3], v[3], tangent[3], bitangent[3], facet[3];
    R(load3)(args->normal, at, n);
    R(load3)(args->ray, at, v);
    R(tangents_of)(n, tangent, bitangent);
    const vr e[3] = { zero - DOT(tangent, v), zero - DOT(bitangent, v), r_min(r_max(zero - DOT(n, v), zero), one) };
    R(facet_of)(e, alpha, r_load((const real *)args->disk[0] + at), r_load((const real *)args->disk[1] + at), facet);
    const vr cosine = r_min(DOT(e, facet), one), twice = r_set(2) * cosine;
    const vr x = twice * facet[0] - e[0], y = twice * facet[1] - e[1], z = twice * facet[2] - e[2];
    const vr a = r_sqrt(e[2] * e[2] + aa * (one - e[2] * e[2])), b = r_sqrt(z * z + aa * r_max(one - z * z, zero));
    r_store((real *)args->cosine + at, cosine);
    r_store((real *)args->weight + at, r_select(r_lt(zero, z), (z * (e[2] + a)) / (z * a + e[2] * b), zero));
    for (int k = 0; k < 3; k++)
        r_store((real *)args->direction[k] + at, (x * tangent[k] + y * bitangent[k]) + z * n[k]);
}

static void R(spread)(const glint_spread_args *args)
{
    for (uint32_t g = 0; g < args->group_count; g++)
        for (uint32_t i = 0; args->wanted[g] && i < GLINT_GROUP; i += VR)
            R(spread_lanes)(args, (size_t)g * GLINT_GROUP + i);
}

#endif
