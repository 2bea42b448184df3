// Lobes: pi D G / (4 n.v) of GGX and Beckmann, and normalised powers, from the results of the stage facet.
// Contract: contract.h.
#ifndef GLINT_SHADE_MICROFACET_LOBES_H
#define GLINT_SHADE_MICROFACET_LOBES_H

#include "engine/render/stages/simd/elementary.h"

static inline bool has_facets(const glint_shade_material *material)
{
    return GLINT_WITH(MICROFACET) && material->highlight == GLINT_HIGHLIGHT_FACETS;
}

/// Returns Smith's masking for Beckmann's distribution, in Heitz' form of Walter's fit: x times Lambda at the cosine
/// x.
static inline vf beckmann_mask(vf alpha, vf x)
{
    const vf one = f_set(1), s = alpha * f_sqrt(f_max(one - x * x, f_set(0))), q = x / s;
    const vf fit = (s * ((f_set(0.396f) * q - f_set(1.259f)) * q + one)) / (f_set(2.181f) * q + f_set(3.535f));
    return f_select(f_lt(q, f_set(1.6f)), fit, f_set(0));
}

/// Returns pi D G / (4 n.v) of the GGX distribution; l, v: the cosines n.l and n.v.
static inline vf ggx_lobe(vf alpha, vf sine2, vf l, vf v)
{
    const vf one = f_set(1), aa = alpha * alpha, b = one - aa;
    const vf u = alpha / (sine2 + aa * (one - sine2));
    const vf d = l * f_sqrt(aa + b * (v * v)) + v * f_sqrt(aa + b * (l * l));
    return (u * u) * ((f_set(0.5f) * l) / f_max(d, f_set(FLT_MIN)));
}

/// Returns the same for Beckmann's distribution.
static inline vf beckmann_lobe(vf alpha, vf sine2, vf l, vf v)
{
    const vf aa = alpha * alpha;
    const vf c = f_max(f_set(1) - sine2, f_set(0x1p-40f));
    const vf e = f_exp2_above(-((sine2 / c) * (f_set(GLINT_LOG2_E) / aa)), GLINT_EXP2_LEAST);
    const vf d = (l * v + v * beckmann_mask(alpha, l)) + l * beckmann_mask(alpha, v);
    return (((e / c) / c) * (f_set(1) / aa)) * ((f_set(0.25f) * l) / f_max(d, f_set(FLT_MIN)));
}

/// Stores a light's contribution, or adds it to the stored value.
static inline void put_share(float *to, bool add, vf share)
{
    if (add)
        share = f_load(to) + share;
    f_store(to, share);
}

/// Stores w S for lobes that are not only a power of a cosine, and for microfacets also w S (1 - v.h)^5. The
/// arguments are the same as for put_factors.
static __attribute__((noinline)) void put_lobe(const glint_shade_args *args, const glint_shade_light *light,
                                               const glint_shade_material *material, size_t at, bool add,
                                               float highlight[GLINT_GROUP], float grazing[GLINT_GROUP])
{
    const unsigned lit = light->lit[at / GLINT_GROUP];
    const bool facets = has_facets(material);
    const uint32_t planes = GLINT_WITH(PROGRAM) ? material->planes : 0;
    const float *exponent = planes & GLINT_PLANE_SHININESS ? args->planes->shininess + at : NULL;
    const float *width = planes & GLINT_PLANE_ALPHA ? args->planes->alpha + at : NULL;
    const vf most = f_set(GLINT_ATTENUATION_MAX), zero = f_set(0);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf w = f_set(1), share;
        if (light->attenuation)
            w = f_load(light->attenuation + at + i);
        const vf cosine = f_load(light->cosine + at + i);
        const vf angle = f_load((facets ? light->sine2 : light->log2_specular) + at + i);
        const fm mask = fm_and(fm_from_bits(lit >> i & ((1u << VF) - 1)), f_lt(f_set(GLINT_NO_SPECULAR), angle));
        if (!facets) {
            const vf s = exponent ? f_load(exponent + i) : f_set(material->shininess);
            share = w * (f_exp2(s * angle) * cosine);
            put_share(highlight + i, add, f_select(mask, share, zero));
            continue;
        }
        const vf v = f_load(args->facing + at + i), alpha = width ? f_load(width + i) : f_set(material->alpha);
        if (material->lobe == GLINT_LOBE_GGX)
            share = ggx_lobe(alpha, angle, cosine, v);
        else
            share = beckmann_lobe(alpha, angle, cosine, v);
        share = f_min(w * f_min(share, most), most);
        put_share(highlight + i, add, f_select(mask, share, zero));
        put_share(grazing + i, add, f_select(mask, share * f_load(light->schlick + at + i), zero));
    }
}

#endif
