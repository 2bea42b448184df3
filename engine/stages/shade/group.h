// group: the factors, terms and sums of a group, for all variants of shading. Contract: stages.h, shade.
#ifndef GLINT_SHADE_GROUP_H
#define GLINT_SHADE_GROUP_H

#include "engine/stages/program/exact.h"
#include "engine/stages/shade/microfacet_lobes.h"
#include "engine/stages/shade/phong.h"
#include "engine/stages/simd/elementary.h"

/// Stores the factors of a light whose samples are already summed up.
static inline void put_sums(const glint_shade_light *light, bool specular, size_t at, float diffuse[GLINT_GROUP],
                            float highlight[GLINT_GROUP])
{
    const unsigned lit = light->lit[at / GLINT_GROUP];
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(lit >> i & ((1u << VF) - 1));
        f_store(diffuse + i, f_select(mask, f_load(light->cosine + at + i), f_set(0)));
        if (specular)
            f_store(highlight + i, f_select(mask, f_load(light->highlight + at + i), f_set(0)));
    }
}

/// Stores the factors of the only light, for a material without highlights.
INNER void put_only_factors(const glint_shade_light *light, const glint_shade_material *material, uint32_t g,
                            light_factors *factors)
{
    factors->count = light->lit[g] ? 1 : 0;
    factors->shiny = 0;
    factors->light[0] = light;
    factors->number[0] = 0;
    if (factors->count)
        put_factors(light, material, NULL, false, (size_t)g * GLINT_GROUP, false, factors->diffuse[0], NULL);
}

static inline bool has_only_factors(const glint_shade_args *args, bool specular)
{
    return !specular && args->light_count == 1 && !args->lights->summed;
}

/// Appends the factors of the lights that reach a group to the list. `exponent`: see put_factors.
INNER void add_factors(const glint_shade_args *args, const glint_shade_material *material, const float *exponent,
                       bool specular, uint32_t g, light_factors *factors)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    const bool power = specular && material->lobe == GLINT_LOBE_POWER;
    bool begun = false; // true: the next lights may be joined to the last light of the list
    for (uint32_t k = 0; k < args->light_count; k++) {
        const glint_shade_light *light = &args->lights[k];
        begun = begun && light->joined;
        if (!light->lit[g])
            continue;
        const uint32_t slot = begun ? factors->count - 1 : factors->count++;
        bool shiny = specular;
        if (light->summed)
            put_sums(light, specular, at, factors->diffuse[slot], factors->specular[slot]);
        else if (begun)
            shiny = put_factors(light, material, exponent, power, at, true, factors->diffuse[slot],
                                factors->specular[slot]);
        else
            shiny = put_factors(light, material, exponent, power, at, false, factors->diffuse[slot],
                                factors->specular[slot]);
        if (specular && !power && !light->summed) {
            put_lobe(args, light, material, at, begun, factors->specular[slot], factors->grazing[slot]);
            shiny = true;
        }
        factors->shiny |= (uint32_t)shiny << slot;
        factors->light[slot] = light;
        factors->number[slot] = (uint8_t)k;
        begun = true;
    }
}

INNER void find_factors(const glint_shade_args *args, const glint_shade_material *material, bool specular, uint32_t g,
                        light_factors *factors)
{
    factors->count = 0;
    factors->shiny = 0;
    if (has_only_factors(args, specular))
        put_only_factors(args->lights, material, g, factors);
    else
        add_factors(args, material, NULL, specular, g, factors);
}

/// Returns the product of a material's reflectance and a light's colour, limited to finite numbers, so that 0 times
/// it is 0.
static inline float share_color(double reflectance, double light)
{
    const double color = reflectance * light;
    return color < FLT_MAX ? (float)color : FLT_MAX;
}

/// A group's terms in float, before they are added up.
typedef struct group_terms {
    _Alignas(64) float term[GLINT_TERM_LOCAL][3][GLINT_GROUP];
} group_terms;

/// Stores `x` where the mask is set.
static inline void put_float(float *to, fm mask, vf x) { f_store(to, f_select(mask, x, f_load(to))); }

/// Returns the lights whose contribution to a term may differ from 0, one bit each.
static inline uint32_t sharing_lights(const light_factors *factors, int term)
{
    return term ? factors->shiny : (1u << factors->count) - 1;
}

/// The products kd Id and ks Is, and the factors of microfacets, of one material for all lights of a call. They are
/// cached because consecutive groups often show the same material.
typedef struct light_colors {
    const glint_shade_args *of; ///< NULL: no colours are cached yet
    const glint_shade_material *material;
    float color[2][GLINT_LIGHT_CHUNK][3], rise[GLINT_LIGHT_CHUNK][3]; ///< color[0]: diffuse, color[1]: specular;
        ///< rise: factor of Schlick's term
} light_colors;

/// Computes the colours. specular: highlights are wanted.
static inline void color_lights(const glint_shade_args *args, const glint_shade_material *material, bool specular,
                                light_colors *colors)
{
    if (colors->of == args && colors->material == material)
        return;
    colors->of = args;
    colors->material = material;
    for (uint32_t k = 0; k < args->light_count; k++) {
        const glint_shade_light *light = &args->lights[k];
        for (int c = 0; c < 3; c++)
            colors->color[0][k][c] = share_color(material->diffuse[c], light->diffuse[c]);
        for (int c = 0; specular && c < 3; c++)
            colors->color[1][k][c] = share_color(material->specular[c], light->specular[c]);
        for (int c = 0; has_facets(material) && c < 3; c++)
            colors->rise[k][c] = share_color(material->grazing[c], light->specular[c]);
    }
}

/// Computes one vector of lanes of the contribution of the light in `slot`, in each channel. `facets` is a constant.
INNER void share_channels(const light_factors *factors, const light_colors *colors, const bool facets, int term, uint32_t slot,
                          int i, vf share[3])
{
    const uint32_t number = factors->number[slot];
    const vf factor = f_load((term ? factors->specular : factors->diffuse)[slot] + i);
    for (int c = 0; c < 3; c++)
        share[c] = factor * f_set(colors->color[term][number][c]);
    for (int c = 0; facets && term && c < 3; c++)
        share[c] = share[c] + f_load(factors->grazing[slot] + i) * f_set(colors->rise[number][c]);
}

/// Adds the contributions of `lights`, one bit per slot, in order and in double. `facets` is a constant.
INNER void add_lights(const light_factors *factors, const light_colors *colors, const bool facets, int term, uint32_t lights,
                      int i, vd total[3][VF / VD])
{
    for (; lights; lights &= lights - 1) {
        vf share[3];
        share_channels(factors, colors, facets, term, (uint32_t)__builtin_ctz(lights), i, share);
        for (int c = 0; c < 3; c++) {
            vd next[VF / VD];
            f_split(share[c], next);
            for (int h = 0; h < VF / VD; h++)
                total[c][h] = total[c][h] + next[h];
        }
    }
}

/// Computes one vector of lanes of the rounded sum of all lights' contributions. With one light, this is the light's
/// contribution. `facets` is a constant.
INNER void sum_lights(const light_factors *factors, const light_colors *colors, const bool facets, int term, int i, vf sum[3])
{
    const uint32_t lights = sharing_lights(factors, term), more = lights & (lights - 1);
    vd total[3][VF / VD];
    share_channels(factors, colors, facets, term, lights ? (uint32_t)__builtin_ctz(lights) : 0, i, sum);
    if (!more)
        return;
    for (int c = 0; c < 3; c++)
        f_split(sum[c], total[c]);
    add_lights(factors, colors, facets, term, more, i, total);
    for (int c = 0; c < 3; c++)
        sum[c] = f_join(total[c][0], total[c][1]);
}

/// Does the same for any material, with or without microfacets.
static inline void light_material(const glint_shade_material *material, const light_factors *factors, const light_colors *colors,
                                  int term, int i, vf sum[3])
{
    if (has_facets(material))
        sum_lights(factors, colors, true, term, i, sum);
    else
        sum_lights(factors, colors, false, term, i, sum);
}

/// Returns the number of a material's terms that lights contribute to: 0, 1 (diffuse), or 2 (diffuse and specular).
static inline int lit_kinds(const light_factors *factors, bool specular)
{
    return factors->count == 0 ? 0 : specular ? 2 : 1;
}

/// Shades one material's lanes of a group whose terms are final, without sums in memory.
static __attribute__((noinline)) void shade_direct(const glint_shade_args *args, const glint_shade_material *material,
                                                   bool specular, const light_factors *factors, light_colors *colors,
                                                   unsigned lanes, group_terms *terms)
{
    const int kinds = lit_kinds(factors, specular);
    color_lights(args, material, specular, colors);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(lanes >> i & ((1u << VF) - 1));
        for (int c = 0; c < 3; c++)
            put_float(terms->term[GLINT_TERM_AMBIENT][c] + i, mask, f_set((float)material->ambient[c]));
        for (int k = 0; k < kinds; k++) {
            vf light[3];
            light_material(material, factors, colors, k, i, light);
            for (int c = 0; c < 3; c++)
                put_float(terms->term[GLINT_TERM_DIFFUSE + k][c] + i, mask, light[c]);
        }
    }
}

static inline dm lane_mask(unsigned lanes, int i) { return dm_from_bits(lanes >> i & ((1u << VD) - 1)); }

/// Stores one vector of a sum in the given lanes; `whole`: whether these are all lanes of the group.
static inline void put_where(double *sum, int i, bool whole, unsigned lanes, vd x)
{
    d_store(sum + i, whole ? x : d_select(lane_mask(lanes, i), x, d_load(sum + i)));
}

/// Adds to one vector of a sum.
static inline void add_where(double *sum, int i, bool whole, unsigned lanes, vd x)
{
    put_where(sum, i, whole, lanes, d_load(sum + i) + x);
}

/// Sums in double over samples and lights; `at`: the offset of a group in these sums.
typedef struct group_sums {
    double *const (*sum)[3];
    size_t at;
} group_sums;

/// Adds one vector of a material's lanes to the sums of a term. `whole`, a constant: the material is in all lanes.
static inline void add_term(const glint_shade_material *material, const light_factors *factors, const light_colors *colors,
                            const group_sums *to, bool whole, unsigned lanes, int term, int i)
{
    const uint32_t lights = sharing_lights(factors, term);
    vd total[3][VF / VD];
    for (int c = 0; c < 3; c++)
        for (int h = 0; h < VF / VD; h++)
            total[c][h] = d_load(to->sum[GLINT_TERM_DIFFUSE + term][c] + to->at + i + h * VD);
    if (has_facets(material))
        add_lights(factors, colors, true, term, lights, i, total);
    else
        add_lights(factors, colors, false, term, lights, i, total);
    for (int c = 0; c < 3; c++)
        for (int h = 0; h < VF / VD; h++)
            put_where(to->sum[GLINT_TERM_DIFFUSE + term][c] + to->at, i + h * VD, whole, lanes, total[c][h]);
}

/// Adds one material's lanes of a group to sums. `whole`, a constant: the material is in all lanes.
static inline void add_material(const glint_shade_args *args, const glint_shade_material *material, bool specular,
                                const light_factors *factors, light_colors *colors, const group_sums *to, bool whole, unsigned lanes)
{
    for (int c = 0; args->first && c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VD)
            add_where(to->sum[GLINT_TERM_AMBIENT][c] + to->at, i, whole, lanes, d_set(material->ambient[c]));
    color_lights(args, material, specular, colors);
    for (int term = 0; factors->count && term < (specular && factors->shiny ? 2 : 1); term++)
        for (int i = 0; i < GLINT_GROUP; i += VF)
            add_term(material, factors, colors, to, whole, lanes, term, i);
}

/// Returns the material of the first of the given lanes of a group, and computes which of these lanes have the same
/// material.
static inline const glint_shade_material *material_of(const glint_shade_args *args, size_t at, unsigned *lanes)
{
    const uint32_t index = args->only ? *args->only : args->material[at + (unsigned)__builtin_ctz(*lanes)];
    if (!args->only)
        *lanes &= lanes_equal(args->material + at, index);
    return &args->materials[index];
}

#endif
