// resolve: the mean of several samples, from sums in memory. resolve_samples: the same, but the samples are shaded in
// the same pass, and their sums are in registers, or in memory for one group. Contract: stages.h.
#ifndef GLINT_FILM_RESOLVE_H
#define GLINT_FILM_RESOLVE_H

#include "engine/render/stages/shade/group.h"
#include "engine/render/stages/shade/shade.h"
#include "engine/render/stages/simd/elementary.h"

/// A number of samples.
typedef struct sample_count {
    double samples;
    double inverse; ///< 1 / samples if samples is a power of two, so that multiplying gives the same bits as dividing;
        ///< otherwise 0
} sample_count;

static inline sample_count count_samples(double samples)
{
    int exponent;
    return (sample_count) { samples, frexp(samples, &exponent) == 0.5 ? 1 / samples : 0 };
}

/// Returns sum / samples.
static inline vd mean_of(sample_count count, vd sum)
{
    if (count.inverse > 0)
        return sum * d_set(count.inverse);
    return sum / d_set(count.samples);
}

/// Stores the mean of a group of sums.
static inline void store_mean(sample_count count, const double *sum, float mean[GLINT_GROUP])
{
    for (int i = 0; i < GLINT_GROUP; i += VD)
        d_store_f(mean + i, mean_of(count, d_load(sum + i)));
}

/// Computes the mean of one term that shade does not compute.
static inline void resolve_further(const glint_resolve_args *args, sample_count count, int term, size_t at)
{
    _Alignas(64) float mean[GLINT_GROUP];
    for (int c = 0; c < 3; c++) {
        store_mean(count, args->sum[term][c] + at, mean);
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const vf x = f_load(mean + i);
            if (args->film[term][c])
                f_store(args->film[term][c] + at + i, x);
            f_store(args->beauty[c] + at + i, f_load(args->beauty[c] + at + i) + x);
        }
    }
}

/// Computes the means of the terms that shade computes.
static inline void resolve_terms(sample_count count, const group_sums *from, float *const film[][3],
                                 float *const beauty[3], size_t at)
{
    group_terms terms;
    for (int k = 0; k < GLINT_TERM_LOCAL; k++)
        for (int c = 0; c < 3; c++)
            store_mean(count, from->sum[k][c] + from->at, terms.term[k][c]);
    finish_terms(&terms, film, beauty, at);
}

static void resolve(const glint_resolve_args *args)
{
    const sample_count count = count_samples(args->samples);
    for (uint32_t g = 0; g < args->group_count; g++) {
        const group_sums sums = { args->sum, (size_t)g * GLINT_GROUP };
        resolve_terms(count, &sums, args->film, args->beauty, sums.at);
        for (int k = GLINT_TERM_LOCAL; k < GLINT_TERM_COUNT; k++)
            if (args->sum[k][0])
                resolve_further(args, count, k, sums.at);
    }
}

// ---- Samples shaded together ----

/// Returns the mean of terms that are equal in all samples, added up in the same way as other terms.
static inline float mean_of_equal(sample_count count, double term)
{
    double sum = 0;
    for (uint32_t k = 0; k < (uint32_t)count.samples; k++)
        sum = sum + term;
    return (float)(count.inverse > 0 ? sum * count.inverse : sum / count.samples);
}

/// Computes one vector of the mean of a term that lights contribute to, in each channel.
static inline void mean_lights(sample_count count, const material_lanes *m, int term, int i, vf mean[3])
{
    vd total[3][VF / VD];
    for (int c = 0; c < 3; c++)
        for (int h = 0; h < VF / VD; h++)
            total[c][h] = d_set(0);
    add_lights(m, false, term, sharing_lights(m, term), i, total);
    for (int c = 0; c < 3; c++) {
        for (int h = 0; h < VF / VD; h++)
            total[c][h] = mean_of(count, total[c][h]);
        mean[c] = f_join(total[c][0], total[c][1]);
    }
}

/// Returns whether every sample shows the same material in every lane of the group at `at`, without planes. If so,
/// begins with this material.
static inline bool begin_whole(const glint_shade_args *sample, uint32_t count, light_colors *colors, size_t at,
                               material_lanes *m)
{
    const glint_shade_material *material = NULL;
    for (uint32_t k = 0; k < count; k++) {
        if (sample[k].hits[at / GLINT_GROUP] != 0xffff)
            return false;
        begin_lanes(&sample[k], colors, at, 0xffff, m);
        if (m->lanes != 0xffff || m->painted || (k > 0 && m->material != material))
            return false;
        material = m->material;
    }
    return true;
}

/// Resolves a group that shows one material and stores no terms, in registers.
static inline void resolve_whole(const glint_shade_args *sample, sample_count count, material_lanes *m)
{
    float ambient[3];
    for (uint32_t k = 0; k < (uint32_t)count.samples; k++)
        add_factors(&sample[k], m->material, m->specular, m->at, &m->factors);
    for (uint32_t k = 0; k < m->factors.count; k++) {
        color_light(m->material, m->specular, m->factors.light[k], k, m->colors);
        m->factors.number[k] = (uint8_t)k;
    }
    for (int c = 0; c < 3; c++)
        ambient[c] = mean_of_equal(count, m->material->ambient[c]);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf mean[2][3];
        for (int term = 0; term < (m->factors.shiny ? 2 : 1); term++)
            mean_lights(count, m, term, i, mean[term]);
        for (int c = 0; c < 3; c++) {
            vf beauty = f_set(ambient[c]) + mean[0][c];
            if (m->factors.shiny)
                beauty = beauty + mean[1][c];
            f_store(sample->beauty[c] + m->at + i, beauty);
        }
    }
}

/// Resolves any group.
static inline void resolve_mixed(const glint_shade_args *sample, sample_count count, light_colors *colors, uint32_t g)
{
    _Alignas(64) double sum[GLINT_TERM_LOCAL][3][GLINT_GROUP];
    double *const to[GLINT_TERM_LOCAL][3] = { [GLINT_TERM_BACKGROUND] = { sum[0][0], sum[0][1], sum[0][2] },
                                              [GLINT_TERM_AMBIENT] = { sum[1][0], sum[1][1], sum[1][2] },
                                              [GLINT_TERM_DIFFUSE] = { sum[2][0], sum[2][1], sum[2][2] },
                                              [GLINT_TERM_SPECULAR] = { sum[3][0], sum[3][1], sum[3][2] } };
    const group_sums sums = { to, 0 };
    memset(sum, 0, sizeof sum);
    colors->of = NULL;
    for (uint32_t k = 0; k < (uint32_t)count.samples; k++)
        shade_sums(&sample[k], g, colors, &sums);
    resolve_terms(count, &sums, sample->film, sample->beauty, (size_t)g * GLINT_GROUP);
}

static void resolve_samples(const glint_shade_args *sample, uint32_t samples)
{
    const sample_count count = count_samples(samples);
    const bool simple = !wants_terms(sample);
    light_colors colors;
    material_lanes m;
    float background[3];
    for (int c = 0; c < 3; c++)
        background[c] = mean_of_equal(count, sample->background[c]);
    for (uint32_t g = 0; g < sample->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        unsigned any = 0;
        for (uint32_t k = 0; k < samples; k++)
            any |= sample[k].hits[g];
        if (simple && any == 0xffff && begin_whole(sample, samples, &colors, at, &m))
            resolve_whole(sample, count, &m);
        else if (simple && !any && sample->active[g] == 0xffff)
            store_even(background, 0xffff, sample->beauty, at);
        else if (sample->active[g])
            resolve_mixed(sample, count, &colors, g);
    }
}

#endif
