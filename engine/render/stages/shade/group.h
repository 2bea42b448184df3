// group: computes the terms of one material's lanes of a group, under the lights of a call: the factors of the lights,
// the reflectances (from the material or from planes), and the sums over lights. Contract: stages.h, shade.
#ifndef GLINT_SHADE_GROUP_H
#define GLINT_SHADE_GROUP_H

#include "engine/render/effects/microfacet/kernel_lobes.h"
#include "engine/render/stages/shade/phong.h"
#include "engine/render/stages/simd/elementary.h"

// ---- The factors of the lights ----

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

/// Appends the factors of the lights that reach a group to the list. specular: highlights are wanted.
static inline void add_factors(const glint_shade_args *args, const glint_shade_material *material, bool specular,
                               size_t at, light_factors *factors)
{
    const bool power = specular && material->lobe == GLINT_LOBE_POWER;
    const bool painted = GLINT_WITH(PROGRAM) && material->planes & GLINT_PLANE_SHININESS;
    const float *exponent = painted ? args->planes->shininess + at : NULL;
    bool begun = false; // true: the next lights may be joined to the last light of the list
    for (uint32_t k = 0; k < args->light_count; k++) {
        const glint_shade_light *light = &args->lights[k];
        begun = begun && light->joined;
        if (!light->lit[at / GLINT_GROUP])
            continue;
        const uint32_t slot = begun ? factors->count - 1 : factors->count++;
        float *diffuse = factors->factor[SHARE_DIFFUSE][slot], *highlight = factors->factor[SHARE_SPECULAR][slot];
        bool shiny = specular;
        if (light->summed)
            put_sums(light, specular, at, diffuse, highlight);
        else if (begun)
            shiny = put_factors(light, material, exponent, power, at, true, diffuse, highlight);
        else
            shiny = put_factors(light, material, exponent, power, at, false, diffuse, highlight);
        if (specular && !power && !light->summed) {
            put_lobe(args, light, material, at, begun, highlight, factors->factor[SHARE_GRAZING][slot]);
            shiny = true;
        }
        factors->shiny |= (uint32_t)shiny << slot;
        factors->light[slot] = light;
        factors->number[slot] = (uint8_t)k;
        begun = true;
    }
}

// ---- The colours of the lights on a material ----

/// The products of one material's reflectances and the lights' colours. They are cached because consecutive groups
/// often show the same material.
typedef struct light_colors {
    const glint_shade_args *of; ///< NULL: no colours are cached yet
    const glint_shade_material *material;
    double product[SHARE_COUNT][GLINT_LIGHT_CHUNK][3];
    float color[SHARE_COUNT][GLINT_LIGHT_CHUNK][3]; ///< the products, limited to finite numbers, so that 0 times a
        ///< colour is 0
} light_colors;

/// Computes the colours of one light. specular: highlights are wanted.
static inline void color_light(const glint_shade_material *material, bool specular, const glint_shade_light *light,
                               uint32_t number, light_colors *colors)
{
    const double *reflectance[SHARE_COUNT] = { material->diffuse, material->specular, material->grazing };
    const int count = !specular ? 1 : has_facets(material) ? SHARE_COUNT : SHARE_GRAZING;
    for (int k = 0; k < count; k++)
        for (int c = 0; c < 3; c++) {
            const double x = reflectance[k][c] * (k == SHARE_DIFFUSE ? light->diffuse : light->specular)[c];
            colors->product[k][number][c] = x;
            colors->color[k][number][c] = x < FLT_MAX ? (float)x : FLT_MAX;
        }
}

static inline void color_lights(const glint_shade_args *args, const glint_shade_material *material, bool specular,
                                light_colors *colors)
{
    if (colors->of == args && colors->material == material)
        return;
    colors->of = args;
    colors->material = material;
    for (uint32_t k = 0; k < args->light_count; k++)
        color_light(material, specular, &args->lights[k], k, colors);
}

// ---- The lanes of a material ----

/// One material's lanes of a group.
typedef struct material_lanes {
    const glint_shade_args *args;
    const glint_shade_material *material;
    light_colors *colors;
    size_t at; ///< offset of the group
    unsigned lanes;
    bool specular; ///< highlights are wanted
    bool painted; ///< some values of the material come from planes
    bool shaded; ///< the terms of the lights come from planes
    unsigned reached; ///< if `shaded`: the lanes that any light reaches
    light_factors factors;
} material_lanes;

/// Begins with the material of the first of the lanes `rest` of a group, without factors.
static inline void begin_lanes(const glint_shade_args *args, light_colors *colors, size_t at, unsigned rest,
                               material_lanes *m)
{
    const uint32_t index = args->only ? *args->only : args->material[at + (unsigned)__builtin_ctz(rest)];
    m->args = args;
    m->material = &args->materials[index];
    m->colors = colors;
    m->at = at;
    m->lanes = args->only ? rest : rest & lanes_equal(args->material + at, index);
    m->specular = args->highlights && m->material->highlight;
    m->painted = GLINT_WITH(PROGRAM) && m->material->planes;
    m->shaded = false;
    m->factors.count = 0;
    m->factors.shiny = 0;
}

/// Stores the factors of the only light, for a material without highlights: the common case of add_factors.
INNER void put_only_factors(const glint_shade_light *light, const glint_shade_material *material, size_t at,
                            light_factors *factors)
{
    if (!light->lit[at / GLINT_GROUP])
        return;
    factors->count = 1;
    factors->light[0] = light;
    factors->number[0] = 0;
    put_factors(light, material, NULL, false, at, false, factors->factor[SHARE_DIFFUSE][0], NULL);
}

/// Computes the factors and the colours. No light is read for materials of GLINT_PLANE_SHADED.
static inline void find_lights(material_lanes *m)
{
    const glint_shade_args *args = m->args;
    if (m->painted && m->material->planes & GLINT_PLANE_SHADED)
        return;
    if (!m->specular && args->light_count == 1 && !args->lights->summed)
        put_only_factors(args->lights, m->material, m->at, &m->factors);
    else
        add_factors(args, m->material, m->specular, m->at, &m->factors);
    color_lights(m->args, m->material, m->specular, m->colors);
}

/// Returns the lights whose contribution to a term may differ from 0, one bit each. term 0: diffuse; 1: specular.
static inline uint32_t sharing_lights(const material_lanes *m, int term)
{
    return term ? m->factors.shiny : (1u << m->factors.count) - 1;
}

/// Returns the plane of a reflectance; NULL: the reflectance is the material's.
static inline const float *plane_of(const material_lanes *m, int kind, int c)
{
    const bool has = m->material->planes & (kind == SHARE_DIFFUSE ? GLINT_PLANE_DIFFUSE : GLINT_PLANE_SPECULAR);
    return has ? (kind == SHARE_DIFFUSE ? m->args->planes->diffuse : m->args->planes->specular)[c] + m->at : NULL;
}

/// Computes one vector of a factor times its colour, in each channel. `painted` is a constant.
INNER void share_factor(const material_lanes *m, const bool painted, int kind, uint32_t slot, int i, vf share[3])
{
    const uint32_t number = m->factors.number[slot];
    const vf factor = f_load(m->factors.factor[kind][slot] + i);
    for (int c = 0; c < 3; c++) {
        const float *plane = painted ? plane_of(m, kind, c) : NULL;
        vf color = f_set(m->colors->color[kind][number][c]);
        if (plane) {
            const vd product = d_set(m->colors->product[kind][number][c]);
            vd half[VF / VD];
            f_split(f_load(plane + i), half);
            color = f_min(f_join(half[0] * product, half[1] * product), f_set(FLT_MAX));
        }
        share[c] = factor * color;
    }
}

/// Computes one vector of a light's contribution to a term, in each channel. `painted` is a constant.
INNER void share_light(const material_lanes *m, const bool painted, int term, uint32_t slot, int i, vf share[3])
{
    vf grazing[3];
    share_factor(m, painted, term, slot, i, share);
    if (!term || !has_facets(m->material))
        return;
    share_factor(m, painted, SHARE_GRAZING, slot, i, grazing);
    for (int c = 0; c < 3; c++)
        share[c] = share[c] + grazing[c];
}

/// Adds the contributions of `lights`, one bit per slot, in order and in double. `painted` is a constant.
INNER void add_lights(const material_lanes *m, const bool painted, int term, uint32_t lights, int i,
                      vd total[3][VF / VD])
{
    for (; lights; lights &= lights - 1) {
        vf share[3];
        share_light(m, painted, term, (uint32_t)__builtin_ctz(lights), i, share);
        for (int c = 0; c < 3; c++) {
            vd next[VF / VD];
            f_split(share[c], next);
            for (int h = 0; h < VF / VD; h++)
                total[c][h] = total[c][h] + next[h];
        }
    }
}

/// Computes one vector of the rounded sum of all lights' contributions. `painted` is a constant.
INNER void sum_lights(const material_lanes *m, const bool painted, int term, int i, vf sum[3])
{
    const uint32_t lights = sharing_lights(m, term), more = lights & (lights - 1);
    vd total[3][VF / VD];
    for (int c = 0; c < 3; c++)
        sum[c] = f_set(0);
    if (painted && m->shaded) {
        const fm reached = fm_from_bits(m->reached >> i & ((1u << VF) - 1));
        for (int c = 0; c < 3; c++)
            sum[c] = f_select(reached, f_load(m->args->planes->shaded[term][c] + m->at + i), f_set(0));
        return;
    }
    if (lights)
        share_light(m, painted, term, (uint32_t)__builtin_ctz(lights), i, sum);
    if (!more)
        return;
    for (int c = 0; c < 3; c++)
        f_split(sum[c], total[c]);
    add_lights(m, painted, term, more, i, total);
    for (int c = 0; c < 3; c++)
        sum[c] = f_join(total[c][0], total[c][1]);
}

/// Returns VD lanes of the ambient term. `painted` is a constant.
INNER vd ambient_of(const material_lanes *m, const bool painted, int c, int i)
{
    const glint_shade_planes *planes = m->args->planes;
    if (painted && m->material->planes & GLINT_PLANE_AMBIENT_IS_DIFFUSE)
        return d_load_f(planes->diffuse[c] + m->at + i) * d_set(planes->ambient_light[c]);
    if (painted && m->material->planes & GLINT_PLANE_AMBIENT)
        return d_load_f(planes->ambient[c] + m->at + i) * d_set(planes->ambient_light[c]);
    return d_set(m->material->ambient[c]);
}

// ---- Sums over samples ----

static inline dm lane_mask(unsigned lanes, int i) { return dm_from_bits(lanes >> i & ((1u << VD) - 1)); }

/// Stores one vector of a sum in the given lanes.
static inline void put_double(double *sum, int i, unsigned lanes, vd x)
{
    if (lanes != 0xffff)
        x = d_select(lane_mask(lanes, i), x, d_load(sum + i));
    d_store(sum + i, x);
}

/// Sums in double over samples and lights; `at`: the offset of a group in these sums.
typedef struct group_sums {
    double *const (*sum)[3];
    size_t at;
} group_sums;

/// Adds one vector to the sums of a term that lights contribute to. `painted` is a constant.
INNER void add_term(const material_lanes *m, const bool painted, const group_sums *to, int term, int i)
{
    double *const *sum = to->sum[GLINT_TERM_DIFFUSE + term];
    vd total[3][VF / VD];
    for (int c = 0; c < 3; c++)
        for (int h = 0; h < VF / VD; h++)
            total[c][h] = d_load(sum[c] + to->at + i + h * VD);
    add_lights(m, painted, term, sharing_lights(m, term), i, total);
    for (int c = 0; c < 3; c++)
        for (int h = 0; h < VF / VD; h++)
            put_double(sum[c] + to->at, i + h * VD, m->lanes, total[c][h]);
}

/// Adds a material's lanes to sums. `painted` is a constant.
INNER void add_lanes(const material_lanes *m, const bool painted, const group_sums *to)
{
    for (int c = 0; m->args->first && c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VD) {
            double *sum = to->sum[GLINT_TERM_AMBIENT][c] + to->at;
            put_double(sum, i, m->lanes, d_load(sum + i) + ambient_of(m, painted, c, i));
        }
    for (int term = 0; term < 2; term++)
        for (int i = 0; sharing_lights(m, term) && i < GLINT_GROUP; i += VF)
            add_term(m, painted, to, term, i);
}

#endif
