// planes: shades materials whose values differ between samples and are read from planes. Contract: stages.h, shade.
#ifndef GLINT_SHADE_PLANES_H
#define GLINT_SHADE_PLANES_H

#include "engine/stages/program/exact.h"
#include "engine/stages/shade/group.h"
#include "engine/stages/shade/microfacet_lobes.h"
#include "engine/stages/shade/phong.h"
#include "engine/stages/simd/elementary.h"

/// Returns the product of a plane's values and a light's colour, like share_color.
static inline vf plane_color(const float *plane, double light)
{
    vd halves[VF / VD];
    f_split(f_load(plane), halves);
    return f_min(f_join(halves[0] * d_set(light), halves[1] * d_set(light)), f_set(FLT_MAX));
}

/// Computes one vector of a factor times a colour; plane NULL: the colour comes from the table.
static inline vf plane_product(const float *factor, const float *plane, double constant, double light)
{
    const vf color = plane ? plane_color(plane, constant * light) : f_set(share_color(constant, light));
    return f_load(factor) * color;
}

/// Returns the plane of a material's reflectance in a channel; term 0: diffuse, otherwise specular. NULL: the
/// reflectance is in the material table.
static inline const float *plane_of(const glint_shade_args *args, const glint_shade_material *material, int term, int c,
                                    size_t at)
{
    const bool has = material->planes & (term ? GLINT_PLANE_SPECULAR : GLINT_PLANE_DIFFUSE);
    return has ? (term ? args->planes->specular : args->planes->diffuse)[c] + at : NULL;
}

/// Computes one light's contribution to a term in a channel.
static inline void plane_share(const glint_shade_args *args, const glint_shade_material *material,
                               const light_factors *factors, uint32_t k, int term, int c, size_t at,
                               float share[GLINT_GROUP])
{
    const glint_shade_light *light = factors->light[k];
    const bool specular = term > 0;
    const float *plane = plane_of(args, material, term, c, at);
    const double constant = (specular ? material->specular : material->diffuse)[c];
    const double strength = (specular ? light->specular : light->diffuse)[c];
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const float *lanes = plane ? plane + i : NULL;
        vf x = plane_product((specular ? factors->specular : factors->diffuse)[k] + i, lanes, constant, strength);
        if (specular && has_facets(material))
            x = x + plane_product(factors->grazing[k] + i, lanes, material->grazing[c], strength);
        f_store(share + i, x);
    }
}

/// Returns the ambient term of a vector of lanes, in double.
static inline vd plane_ambient(const glint_shade_args *args, const glint_shade_material *material, int c, size_t at)
{
    const glint_shade_planes *planes = args->planes;
    if (material->planes & GLINT_PLANE_AMBIENT_IS_DIFFUSE)
        return d_load_f(planes->diffuse[c] + at) * d_set(planes->ambient_light[c]);
    if (material->planes & GLINT_PLANE_AMBIENT)
        return d_load_f(planes->ambient[c] + at) * d_set(planes->ambient_light[c]);
    return d_set(material->ambient[c]);
}

static inline void find_plane_factors(const glint_shade_args *args, const glint_shade_material *material, bool specular,
                                      uint32_t g, light_factors *factors)
{
    factors->count = 0;
    factors->shiny = 0;
    if (material->planes & GLINT_PLANE_SHADED)
        return;
    if (has_only_factors(args, specular))
        put_only_factors(args->lights, material, g, factors);
    else if (material->planes & GLINT_PLANE_SHININESS)
        add_factors(args, material, args->planes->shininess + (size_t)g * GLINT_GROUP, specular, g, factors);
    else
        add_factors(args, material, NULL, specular, g, factors);
}

/// Like add_material, for a material with planes.
static __attribute__((noinline)) void add_planes(const glint_shade_args *args, const glint_shade_material *material,
                                                 bool specular, uint32_t g, const group_sums *to, unsigned lanes)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    _Alignas(64) float share[GLINT_GROUP];
    light_factors factors;
    find_plane_factors(args, material, specular, g, &factors);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; args->first && i < GLINT_GROUP; i += VD)
            add_where(to->sum[GLINT_TERM_AMBIENT][c] + to->at, i, false, lanes,
                      plane_ambient(args, material, c, at + (size_t)i));
        for (int kind = 0; kind < (specular && factors.shiny ? 2 : 1); kind++)
            for (uint32_t k = 0; k < factors.count; k++) {
                plane_share(args, material, &factors, k, kind, c, at, share);
                for (int i = 0; i < GLINT_GROUP; i += VD)
                    add_where(to->sum[GLINT_TERM_DIFFUSE + kind][c] + to->at, i, false, lanes, d_load_f(share + i));
            }
    }
}

/// Computes the sum of all lights' contributions to a term in double, and rounds it.
static inline void sum_plane_shares(const glint_shade_args *args, const glint_shade_material *material,
                                    const light_factors *factors, int term, int c, size_t at, float sum[GLINT_GROUP])
{
    _Alignas(64) float share[GLINT_GROUP];
    vd total[GLINT_GROUP / VD];
    plane_share(args, material, factors, 0, term, c, at, sum);
    if (factors->count == 1)
        return;
    for (int i = 0; i < GLINT_GROUP; i += VD)
        total[i / VD] = d_load_f(sum + i);
    for (uint32_t k = 1; k < factors->count; k++) {
        plane_share(args, material, factors, k, term, c, at, share);
        for (int i = 0; i < GLINT_GROUP; i += VD)
            total[i / VD] = total[i / VD] + d_load_f(share + i);
    }
    for (int i = 0; i < GLINT_GROUP; i += VD)
        d_store_f(sum + i, total[i / VD]);
}

/// Returns a vector of a plane times a number, computed in double.
static inline vf scaled_plane(const float *plane, double number)
{
    vd part[VF / VD];
    f_split(f_load(plane), part);
    return f_join(part[0] * d_set(number), part[1] * d_set(number));
}

/// Computes one channel of whole_planes. `has`: the material's planes. light NULL: no light reaches the group. The
/// function reads all numbers first, because the compiler must assume that stores change them.
INNER void whole_channel(const glint_shade_args *args, const glint_shade_material *material, unsigned has, bool shines,
                         const light_factors *factors, int c, size_t at)
{
    const glint_shade_planes *planes = args->planes;
    const glint_shade_light *light = factors->count ? factors->light[0] : NULL;
    const bool follows = has & GLINT_PLANE_AMBIENT_IS_DIFFUSE;
    const float *ambient = follows ? planes->diffuse[c] + at : has & GLINT_PLANE_AMBIENT ? planes->ambient[c] + at : NULL;
    const float *diffuse = has & GLINT_PLANE_DIFFUSE ? planes->diffuse[c] + at : NULL,
                *specular = has & GLINT_PLANE_SPECULAR ? planes->specular[c] + at : NULL;
    const double ambient_light = planes->ambient_light[c], kd = light ? material->diffuse[c] * light->diffuse[c] : 0,
                 ks = light ? material->specular[c] * light->specular[c] : 0;
    const float own[3] = { (float)material->ambient[c], light ? share_color(material->diffuse[c], light->diffuse[c]) : 0,
                           light ? share_color(material->specular[c], light->specular[c]) : 0 };
    float *beauty = args->beauty[c] + at;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf sum = ambient ? scaled_plane(ambient + i, ambient_light) : f_set(own[0]);
        if (light)
            sum = sum + f_load(factors->diffuse[0] + i) * (diffuse ? plane_color(diffuse + i, kd) : f_set(own[1]));
        if (light && shines)
            sum = sum + f_load(factors->specular[0] + i) * (specular ? plane_color(specular + i, ks) : f_set(own[2]));
        f_store(beauty + i, sum);
    }
}

/// Like shade_whole. In the common case, the diffuse reflectance is also the ambient reflectance.
static __attribute__((noinline)) void whole_planes(const glint_shade_args *args, const glint_shade_material *material,
                                                   bool shines, const light_factors *factors, size_t at)
{
    const unsigned painted = GLINT_PLANE_DIFFUSE | GLINT_PLANE_AMBIENT_IS_DIFFUSE, has = material->planes;
    for (int c = 0; c < 3; c++) {
        if ((has & ~(unsigned)GLINT_PLANE_SHININESS) == painted)
            whole_channel(args, material, painted, shines, factors, c, at);
        else
            whole_channel(args, material, has, shines, factors, c, at);
    }
}

/// Like shade_direct.
static __attribute__((noinline)) void shade_planes(const glint_shade_args *args, const glint_shade_material *material,
                                                   bool specular, const light_factors *factors, size_t at,
                                                   unsigned lanes, group_terms *terms)
{
    _Alignas(64) float light[2][3][GLINT_GROUP], ambient[GLINT_GROUP];
    const int kinds = factors->count == 0 ? 0 : specular ? 2 : 1;
    for (int k = 0; k < kinds; k++)
        for (int c = 0; c < 3; c++)
            sum_plane_shares(args, material, factors, k, c, at, light[k][c]);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < GLINT_GROUP; i += VD)
            d_store_f(ambient + i, plane_ambient(args, material, c, at + (size_t)i));
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const fm mask = fm_from_bits(lanes >> i & ((1u << VF) - 1));
            put_float(terms->term[GLINT_TERM_AMBIENT][c] + i, mask, f_load(ambient + i));
            for (int k = 0; k < kinds; k++)
                put_float(terms->term[GLINT_TERM_DIFFUSE + k][c] + i, mask, f_load(light[k][c] + i));
        }
    }
}

/// Returns the lanes of a group that any light reaches.
static inline unsigned lanes_reached(const glint_shade_args *args, uint32_t g)
{
    unsigned lit = 0;
    for (uint32_t k = 0; k < args->light_count; k++)
        lit |= args->lights[k].lit[g];
    return lit;
}

/// The lanes of a group that any light reaches, as masks.
typedef struct reached_lanes {
    fm part[GLINT_GROUP / VF];
} reached_lanes;

static inline reached_lanes find_reached(unsigned lit)
{
    reached_lanes reached;
    for (int i = 0; i < GLINT_GROUP; i += VF)
        reached.part[i / VF] = fm_from_bits(lit >> i & ((1u << VF) - 1));
    return reached;
}

/// Like shade_direct.
static __attribute__((noinline)) void shade_shaded(const glint_shade_args *args, const glint_shade_material *material,
                                                   uint32_t g, unsigned lanes, group_terms *terms)
{
    const reached_lanes reached = find_reached(lanes_reached(args, g));
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const size_t k = (size_t)g * GLINT_GROUP + (size_t)i;
            const fm mask = fm_from_bits(lanes >> i & ((1u << VF) - 1));
            put_float(terms->term[GLINT_TERM_AMBIENT][c] + i, mask,
                      f_join(plane_ambient(args, material, c, k), plane_ambient(args, material, c, k + VD)));
            for (int term = 0; term < 2; term++)
                put_float(terms->term[GLINT_TERM_DIFFUSE + term][c] + i, mask,
                          f_select(reached.part[i / VF], f_load(args->planes->shaded[term][c] + k), f_set(0)));
        }
}

#endif
