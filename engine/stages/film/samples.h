// resolve_samples: shade and resolve in one pass, with sums in registers or in memory for one group. Contract:
// stages.h.
#ifndef GLINT_FILM_SAMPLES_H
#define GLINT_FILM_SAMPLES_H

#include "engine/stages/film/resolve.h"
#include "engine/stages/program/exact.h"
#include "engine/stages/shade/group.h"
#include "engine/stages/shade/microfacet_lobes.h"
#include "engine/stages/shade/phong.h"
#include "engine/stages/shade/shade.h"
#include "engine/stages/simd/elementary.h"

/// All samples of a frame, and the data shared by every group.
typedef struct samples_frame {
    const glint_shade_args *sample;
    uint32_t count;
    double inverse; ///< see mean_of
    float background[3]; ///< the mean over all samples
} samples_frame;

/// Returns the mean of terms that are equal in all samples, added up in the same way as other terms.
static inline float mean_of_equal(const samples_frame *frame, double term)
{
    double sum = 0;
    for (uint32_t k = 0; k < frame->count; k++)
        sum = sum + term;
    return (float)(frame->inverse > 0 ? sum * frame->inverse : sum / (double)frame->count);
}

/// One light's contribution to a term in a channel: the factor times kd Id or ks Is, plus the grazing term of
/// microfacets.
typedef struct light_share {
    const float *factor, *grazing; ///< grazing NULL: there is no grazing term
    float color, rise;
} light_share;

static inline light_share share_of(const light_factors *factors, const glint_shade_material *material, uint32_t k,
                                   int term, int c)
{
    const glint_shade_light *light = factors->light[k];
    if (!term)
        return (light_share) { factors->diffuse[k], NULL, share_color(material->diffuse[c], light->diffuse[c]), 0 };
    return (light_share) { factors->specular[k], has_facets(material) ? factors->grazing[k] : NULL,
                           share_color(material->specular[c], light->specular[c]),
                           has_facets(material) ? share_color(material->grazing[c], light->specular[c]) : 0 };
}

/// Returns one vector of the contribution.
static inline vf share_lanes(const light_share *share, int i)
{
    vf x = f_load(share->factor + i) * f_set(share->color);
    if (share->grazing)
        x = x + f_load(share->grazing + i) * f_set(share->rise);
    return x;
}

/// Computes one vector of a term with lights, in each channel: the mean of all shares.
static inline void mean_shares(const samples_frame *frame, const light_factors *factors,
                               const glint_shade_material *material, int term, int i, vf mean[3])
{
    vd total[3][VF / VD];
    for (int c = 0; c < 3; c++)
        for (int h = 0; h < VF / VD; h++)
            total[c][h] = d_set(0);
    for (uint32_t k = 0; k < factors->count; k++)
        for (int c = 0; c < 3; c++) {
            const light_share share = share_of(factors, material, k, term, c);
            vd halves[VF / VD];
            f_split(share_lanes(&share, i), halves);
            for (int h = 0; h < VF / VD; h++)
                total[c][h] = total[c][h] + halves[h];
        }
    for (int c = 0; c < 3; c++) {
        for (int h = 0; h < VF / VD; h++)
            total[c][h] = mean_of(total[c][h], frame->count, frame->inverse);
        mean[c] = f_join(total[c][0], total[c][1]);
    }
}

/// Returns the material that every sample shows in every lane; NULL: there is none.
static inline const glint_shade_material *only_material(const samples_frame *frame, uint32_t g)
{
    const glint_shade_material *material = NULL;
    for (uint32_t k = 0; k < frame->count; k++) {
        const glint_shade_args *sample = &frame->sample[k];
        unsigned lanes = 0xffff;
        if (sample->hits[g] != 0xffff)
            return NULL;
        const glint_shade_material *shown = material_of(sample, (size_t)g * GLINT_GROUP, &lanes);
        if (lanes != 0xffff || (material && shown != material) || (GLINT_WITH_PROGRAM && shown->planes))
            return NULL;
        material = shown;
    }
    return material;
}

/// Resolves a group that shows one material and stores no terms, in registers.
static inline void resolve_whole(const samples_frame *frame, const glint_shade_material *material, uint32_t g)
{
    const bool specular = frame->sample->highlights && material->highlight;
    light_factors factors;
    float ambient[3];
    factors.count = 0;
    factors.shiny = 0;
    for (uint32_t k = 0; k < frame->count; k++)
        add_factors(&frame->sample[k], material, NULL, specular, g, &factors);
    for (int c = 0; c < 3; c++)
        ambient[c] = mean_of_equal(frame, material->ambient[c]);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf diffuse[3], highlight[3] = { f_set(0), f_set(0), f_set(0) };
        mean_shares(frame, &factors, material, 0, i, diffuse);
        if (specular && factors.shiny)
            mean_shares(frame, &factors, material, 1, i, highlight);
        for (int c = 0; c < 3; c++) {
            vf beauty = f_set(ambient[c]) + diffuse[c];
            if (specular && factors.shiny)
                beauty = beauty + highlight[c];
            f_store(frame->sample->beauty[c] + (size_t)g * GLINT_GROUP + i, beauty);
        }
    }
}

/// Resolves any group.
static inline void resolve_mixed(const samples_frame *frame, uint32_t g)
{
    _Alignas(64) double sum[GLINT_TERM_LOCAL][3][GLINT_GROUP];
    double *const to[GLINT_TERM_LOCAL][3] = { [GLINT_TERM_BACKGROUND] = { sum[0][0], sum[0][1], sum[0][2] },
                                              [GLINT_TERM_AMBIENT] = { sum[1][0], sum[1][1], sum[1][2] },
                                              [GLINT_TERM_DIFFUSE] = { sum[2][0], sum[2][1], sum[2][2] },
                                              [GLINT_TERM_SPECULAR] = { sum[3][0], sum[3][1], sum[3][2] } };
    const group_sums sums = { to, 0 };
    group_terms terms;
    light_colors colors;
    colors.of = NULL;
    memset(sum, 0, sizeof sum);
    for (uint32_t k = 0; k < frame->count; k++)
        shade_sums(&frame->sample[k], g, &colors, &sums);
    for (int term = 0; term < GLINT_TERM_LOCAL; term++)
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < GLINT_GROUP; i += VD)
                d_store_f(terms.term[term][c] + i, mean_of(d_load(sum[term][c] + i), frame->count, frame->inverse));
    finish_terms(&terms, frame->sample->film, frame->sample->beauty, (size_t)g * GLINT_GROUP);
}

static void resolve_samples(const glint_shade_args *sample, uint32_t count)
{
    samples_frame frame = { .sample = sample, .count = count, .inverse = inverse_of(count) };
    const bool simple = !wants_terms(sample);
    for (int c = 0; c < 3; c++)
        frame.background[c] = mean_of_equal(&frame, sample->background[c]);
    for (uint32_t g = 0; g < sample->group_count; g++) {
        unsigned any = 0;
        for (uint32_t k = 0; k < count; k++)
            any |= sample[k].hits[g];
        const glint_shade_material *material = simple && any == 0xffff ? only_material(&frame, g) : NULL;
        if (material)
            resolve_whole(&frame, material, g);
        else if (simple && !any && sample->active[g] == 0xffff)
            store_even(sample, frame.background, (size_t)g * GLINT_GROUP);
        else if (sample->active[g])
            resolve_mixed(&frame, g);
    }
}

#endif
