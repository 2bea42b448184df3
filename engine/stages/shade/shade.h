// shade: the terms of each sample. A group is processed material by material, so that colours and exponents are the
// same in every lane. Lights are added in their order, in double. Contract: stages.h.
#ifndef GLINT_SHADE_SHADE_H
#define GLINT_SHADE_SHADE_H

#include "engine/stages/program/exact.h"
#include "engine/stages/program/texel.h"
#include "engine/stages/shade/group.h"
#include "engine/stages/shade/microfacet_lobes.h"
#include "engine/stages/shade/mixed.h"
#include "engine/stages/shade/phong.h"
#include "engine/stages/shade/planes.h"
#include "engine/stages/simd/elementary.h"

/// Shades a group of one sample, and adds the result to the sums.
static __attribute__((noinline)) void shade_sums(const glint_shade_args *args, uint32_t g, light_colors *colors,
                                                 const group_sums *to)
{
    const unsigned hits = args->hits[g], empty = args->active[g] & ~hits;
    light_factors factors;
    for (int c = 0; args->first && empty && c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VD)
            add_where(to->sum[GLINT_TERM_BACKGROUND][c] + to->at, i, false, empty, d_set(args->background[c]));
    for (unsigned rest = hits, lanes; rest; rest &= ~lanes) {
        lanes = rest;
        const glint_shade_material *material = material_of(args, (size_t)g * GLINT_GROUP, &lanes);
        const bool specular = args->highlights && material->highlight;
        if (GLINT_WITH_PROGRAM && material->planes) {
            add_planes(args, material, specular, g, to, lanes);
            continue;
        }
        find_factors(args, material, specular, g, &factors);
        if (lanes == 0xffff)
            add_material(args, material, specular, &factors, colors, to, true, lanes);
        else
            add_material(args, material, specular, &factors, colors, to, false, lanes);
    }
}

/// Stores the terms that are needed, and adds all terms up.
static inline void finish_terms(const group_terms *terms, float *const film[][3], float *const beauty[3], size_t at)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            vf t[GLINT_TERM_LOCAL];
            for (int k = 0; k < GLINT_TERM_LOCAL; k++) {
                t[k] = f_load(terms->term[k][c] + i);
                if (film[k][c])
                    f_store(film[k][c] + at + i, t[k]);
            }
            f_store(beauty[c] + at + i, ((t[0] + t[1]) + t[2]) + t[3]);
        }
}

/// Stores the background in lanes without a hit, and 0 in the other terms.
static inline void start_direct(const glint_shade_args *args, uint32_t g, group_terms *terms)
{
    const unsigned empty = args->active[g] & ~(unsigned)args->hits[g];
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(empty >> i & ((1u << VF) - 1));
        for (int c = 0; c < 3; c++) {
            f_store(terms->term[GLINT_TERM_BACKGROUND][c] + i,
                    f_select(mask, f_set((float)args->background[c]), f_set(0)));
            for (int k = GLINT_TERM_AMBIENT; k < GLINT_TERM_LOCAL; k++)
                f_store(terms->term[k][c] + i, f_set(0));
        }
    }
}

/// Stores a group that has one colour in every lane, because it shows no surface, or no light reaches it.
static inline void store_even(const glint_shade_args *args, const float color[3], size_t at)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VF)
            f_store(args->beauty[c] + at + i, f_set(color[c]));
}

/// Shades a group in registers, in the common case: one material in every lane, with the given values, at most one
/// light, and no terms to store.
INNER void shade_whole(const glint_shade_args *args, const glint_shade_material *material, const float *number, uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    _Alignas(64) float diffuse[GLINT_GROUP], highlight[GLINT_GROUP] = { 0 };
    bool shiny = args->highlights && material->highlight;
    if (!args->light_count || !args->lights->lit[g]) {
        store_even(args, number + MIXED_AMBIENT, at);
        return;
    }
    if (shiny)
        shiny = put_factors(args->lights, material, NULL, true, at, false, diffuse, highlight);
    else
        put_factors(args->lights, material, NULL, false, at, false, diffuse, NULL);
    for (int i = 0; i < GLINT_GROUP; i += VF)
        for (int c = 0; c < 3; c++) {
            vf sum = f_set(number[MIXED_AMBIENT + c]) + f_load(diffuse + i) * f_set(number[MIXED_DIFFUSE + c]);
            if (shiny)
                sum = sum + f_load(highlight + i) * f_set(number[MIXED_SPECULAR + c]);
            f_store(args->beauty[c] + at + i, sum);
        }
}

/// Does the same for any material and any lights.
static __attribute__((noinline)) void shade_lit(const glint_shade_args *args, const glint_shade_material *material,
                                                bool specular, const light_factors *factors, light_colors *colors, size_t at)
{
    const int kinds = lit_kinds(factors, specular);
    color_lights(args, material, specular, colors);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf light[2][3] = { { f_set(0), f_set(0), f_set(0) }, { f_set(0), f_set(0), f_set(0) } };
        for (int k = 0; k < kinds; k++)
            light_material(material, factors, colors, k, i, light[k]);
        for (int c = 0; c < 3; c++) // the sums have the order of finish_terms
            f_store(args->beauty[c] + at + i, (f_set(0 + (float)material->ambient[c]) + light[0][c]) + light[1][c]);
    }
}

static inline bool wants_terms(const glint_shade_args *args)
{
    for (int k = 0; k < GLINT_TERM_LOCAL; k++)
        if (args->film[k][0])
            return true;
    return false;
}

/// Shades a group whose terms are final, because this call has all lights and there is one sample; `simple` is a
/// constant.
INNER void shade_group(const glint_shade_args *args, const bool simple, uint32_t g, light_colors *colors,
                       mixed_table *mixed)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    unsigned rest = args->hits[g];
    light_factors factors;
    group_terms terms;
    if (simple && !rest && args->active[g] == 0xffff) {
        const float background[3] = { (float)args->background[0], (float)args->background[1],
                                      (float)args->background[2] };
        store_even(args, background, at);
        return;
    }
    bool begun = false;
    for (unsigned lanes; rest; rest &= ~lanes) {
        lanes = rest;
        const glint_shade_material *material = material_of(args, at, &lanes);
        if (simple && lanes != 0xffff && !begun && shade_mixed(args, g, mixed))
            return;
        const bool specular = args->highlights && material->highlight;
        const bool planes = GLINT_WITH_PROGRAM && material->planes;
        const bool shaded = planes && material->planes & GLINT_PLANE_SHADED && args->planes->shaded[0][0];
        if (simple && lanes == 0xffff && mixed->usable && is_plain_material(material)) {
            shade_whole(args, material, mixed_numbers_of(args, material, mixed), g);
            return;
        }
        if (planes)
            find_plane_factors(args, material, specular, g, &factors);
        else
            find_factors(args, material, specular, g, &factors);
        if (planes && !shaded && simple && lanes == 0xffff && factors.count <= 1 && !has_facets(material)) {
            whole_planes(args, material, specular && factors.shiny, &factors, at);
            return;
        }
        if (!planes && simple && lanes == 0xffff) {
            shade_lit(args, material, specular, &factors, colors, at);
            return;
        }
        if (!begun)
            start_direct(args, g, &terms);
        begun = true;
        if (shaded)
            shade_shaded(args, material, g, lanes, &terms);
        else if (planes)
            shade_planes(args, material, specular, &factors, at, lanes, &terms);
        else
            shade_direct(args, material, specular, &factors, colors, lanes, &terms);
    }
    if (!begun)
        start_direct(args, g, &terms);
    finish_terms(&terms, args->film, args->beauty, at);
}

static void shade(const glint_shade_args *args)
{
    const bool simple = !wants_terms(args);
    light_colors colors;
    mixed_table mixed;
    colors.of = NULL;
    begin_mixed(args, &mixed);
    if (GLINT_WITH_SAMPLES && args->sum[0][0]) {
        for (uint32_t g = 0; g < args->group_count; g++) {
            const group_sums sums = { args->sum, (size_t)g * GLINT_GROUP };
            shade_sums(args, g, &colors, &sums);
        }
    } else if (simple) {
        for (uint32_t g = 0; g < args->group_count; g++)
            shade_group(args, true, g, &colors, &mixed);
    } else {
        for (uint32_t g = 0; g < args->group_count; g++)
            shade_group(args, false, g, &colors, &mixed);
    }
}

#endif
