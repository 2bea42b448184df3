// resolve: the mean of several samples. Contract: stages.h.
#ifndef GLINT_FILM_RESOLVE_H
#define GLINT_FILM_RESOLVE_H

#include "engine/stages/program/exact.h"
#include "engine/stages/shade/group.h"
#include "engine/stages/shade/shade.h"
#include "engine/stages/simd/elementary.h"

/// Returns 1 / samples if samples is a power of two, so that multiplying gives the same bits as dividing; otherwise
/// 0.
static inline double inverse_of(double samples)
{
    int exponent;
    return frexp(samples, &exponent) == 0.5 ? 1 / samples : 0;
}

/// Returns sum / samples. `inverse`: the result of inverse_of for these samples.
static inline vd mean_of(vd sum, double samples, double inverse)
{
    if (inverse > 0)
        return sum * d_set(inverse);
    return sum / d_set(samples);
}

/// Computes the mean of one term that shade does not compute.
static inline void resolve_further(const glint_resolve_args *args, double inverse, int term, size_t at)
{
    _Alignas(64) float mean[GLINT_GROUP];
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < GLINT_GROUP; i += VD)
            d_store_f(mean + i, mean_of(d_load(args->sum[term][c] + at + i), args->samples, inverse));
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const vf x = f_load(mean + i);
            if (args->film[term][c])
                f_store(args->film[term][c] + at + i, x);
            f_store(args->beauty[c] + at + i, f_load(args->beauty[c] + at + i) + x);
        }
    }
}

static void resolve(const glint_resolve_args *args)
{
    const double inverse = inverse_of(args->samples);
    group_terms terms;
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        for (int k = 0; k < GLINT_TERM_LOCAL; k++)
            for (int c = 0; c < 3; c++)
                for (int i = 0; i < GLINT_GROUP; i += VD)
                    d_store_f(terms.term[k][c] + i, mean_of(d_load(args->sum[k][c] + at + i), args->samples, inverse));
        finish_terms(&terms, args->film, args->beauty, at);
        for (int k = GLINT_TERM_LOCAL; k < GLINT_TERM_COUNT; k++)
            if (args->sum[k][0])
                resolve_further(args, inverse, k, at);
    }
}

#endif
