// phong: the local lighting of one light: diffuse w (n.l), and the highlight w S. Here w is the attenuation, and S =
// 2^(shininess log2 x). The stage light computes x: r.v for Phong (B. T. Phong, "Illumination for Computer Generated
// Pictures", CACM 18(6), 1975), n.h for Blinn-Phong (J. F. Blinn, "Models of Light Reflection for Computer
// Synthesized Pictures", SIGGRAPH 1977). Contract: stages.h.
#ifndef GLINT_SHADE_PHONG_H
#define GLINT_SHADE_PHONG_H

#include "engine/render/stages/simd/elementary.h"

/// The factors of a light, and the reflectances and colours with which they are multiplied.
enum { SHARE_DIFFUSE, SHARE_SPECULAR, SHARE_GRAZING, SHARE_COUNT };

/// The geometric factors of the lights that reach a group, for one material: w (n.l), w S, and for microfacets w S
/// times Schlick's (1 - v.h)^5; 0 in lanes that a light does not reach.
typedef struct light_factors {
    _Alignas(64) float factor[SHARE_COUNT][GLINT_LIGHT_CHUNK][GLINT_GROUP];
    const glint_shade_light *light[GLINT_LIGHT_CHUNK];
    uint8_t number[GLINT_LIGHT_CHUNK]; ///< number of each light in the call
    uint32_t count;
    uint32_t shiny; ///< one bit for each light whose specular factors are not all 0
} light_factors;

/// Computes w (n.l) and w S of one light or sample, for a group. `exponent`: the exponent of each lane of the group;
/// NULL: the material's exponent. `add`: adds to the stored values of the light to which this light is joined.
/// Returns whether w S may be above 0 in any lane.
INNER bool put_factors(const glint_shade_light *light, const glint_shade_material *material, const float *exponent,
                       bool specular, size_t at, bool add, float diffuse[GLINT_GROUP], float highlight[GLINT_GROUP])
{
    const float *attenuation = light->attenuation ? light->attenuation + at : NULL, *cosine = light->cosine + at;
    const unsigned lit = light->lit[at / GLINT_GROUP];
    const float own = material->shininess;
    bool any = false;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf w = f_set(1);
        if (attenuation)
            w = f_load(attenuation + i);
        const fm mask = fm_from_bits(lit >> i & ((1u << VF) - 1));
        vf share = f_select(mask, w * f_load(cosine + i), f_set(0));
        if (add)
            share = f_load(diffuse + i) + share;
        f_store(diffuse + i, share);
        if (specular) {
            const vf log2 = f_load(light->log2_specular + at + i);
            vf y = f_set(own);
            if (exponent)
                y = f_load(exponent + i);
            y = y * log2;
            const fm there = fm_and(mask, f_lt(f_set(GLINT_NO_SPECULAR), log2));
            share = f_set(0);
            if (fm_bits(fm_andnot(there, f_lt(y, f_set(GLINT_EXP2_LOWEST))))) {
                share = f_select(there, w * f_exp2(y), f_set(0));
                any = true;
            }
            if (add)
                share = f_load(highlight + i) + share;
            f_store(highlight + i, share);
        }
    }
    return any;
}

#endif
