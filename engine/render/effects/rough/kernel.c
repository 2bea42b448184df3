// spread: rays that the facets of GGX's distribution reflect. Contract: contract.h.
#include "engine/render/effects/indirect/kernel_scatter.h"

/// Computes the normal of the facet at a point of the disk. e: direction to the eye in the tangent basis.
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

/// Reflects the rays of VR lanes. Writes the cosines and the weights of these lanes.
static inline void R(spread_lanes)(const glint_spread_args *args, size_t at, real *cosines, real *weights)
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
    r_store(cosines, cosine);
    r_store(weights, r_select(r_lt(zero, z), (z * (e[2] + a)) / (z * a + e[2] * b), zero));
    for (int k = 0; k < 3; k++)
        r_store((real *)args->direction[k] + at, (x * tangent[k] + y * bitangent[k]) + z * n[k]);
}

/// Computes the weights of a group's rays.
static inline void R(weigh_group)(const glint_spread_args *args, size_t at)
{
    for (size_t i = at; i < at + GLINT_GROUP; i += VD) {
        const vd part = d_load(args->weight + i), grazing = d_load(args->grazing + i) * part;
        for (int c = 0; c < 3; c++) {
            const vd weight = d_load(args->head_on[c] + i) * part + d_load(args->added[c] + i) * grazing;
            d_store(args->ray_weight[c] + i, d_min(weight, d_set(GLINT_WEIGHT_MAX)));
        }
    }
}

static inline void R(spread_group)(const glint_spread_args *args, size_t at)
{
    _Alignas(64) real cosine[GLINT_GROUP], weight[GLINT_GROUP];
    _Alignas(64) double c[GLINT_GROUP];
    for (uint32_t i = 0; i < GLINT_GROUP; i += VR)
        R(spread_lanes)(args, at + i, cosine + i, weight + i);
    for (uint32_t i = 0; i < GLINT_GROUP; i++) {
        c[i] = (double)cosine[i];
        args->weight[at + i] = (double)weight[i];
    }
    for (uint32_t i = 0; i < GLINT_GROUP; i += VD) {
        const vd r = d_set(1) - d_load(c + i);
        d_store(args->grazing + at + i, (r * r) * (r * r) * r);
    }
    if (args->ray_weight[0])
        R(weigh_group)(args, at);
}

static void R(spread)(const glint_spread_args *args)
{
    for (uint32_t g = 0; g < args->group_count; g++)
        if (args->wanted[g])
            R(spread_group)(args, (size_t)g * GLINT_GROUP);
}

#if GLINT_WITH(ROUGH)
KERNEL(spread, glint_spread_args)
#endif
