// light_sample: the additions of spot and area lights to a light's arithmetic. Contract: stages.h, at
// glint_light_args.
#ifndef GLINT_LIGHT_SAMPLE_H
#define GLINT_LIGHT_SAMPLE_H

#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/simd/real.h"

#define LIGHT_PLAIN 0 // kinds of light that the light stage is compiled for
#define LIGHT_SPOT 1
#define LIGHT_SAMPLE 2
#define LIGHT_CONE 3 // lights whose samples are computed for each group

/// One sample's positions and normals for all lanes, in the type that the stage computes with.
typedef struct R(light_sample_lanes) {
    const real (*position)[GLINT_GROUP], (*normal)[GLINT_GROUP];
    const double (*exact_position)[GLINT_GROUP]; ///< the unrounded positions
} R(light_sample_lanes);

/// The samples of one call.
typedef struct R(light_sample_set) {
    R(light_sample_lanes) light_sample[GLINT_LIGHT_CHUNK];
#if GLINT_REAL == 32
    _Alignas(64) float rounded[GLINT_LIGHT_CHUNK][2][3][GLINT_GROUP]; ///< memory for rounded positions and normals
#endif
    // for GLINT_EMIT_CONE, the samples of the current group:
    _Alignas(64) double exact_position[GLINT_LIGHT_CHUNK][3][GLINT_GROUP];
    _Alignas(64) real direction[GLINT_LIGHT_CHUNK][3][GLINT_GROUP],
        far[GLINT_LIGHT_CHUNK][GLINT_GROUP]; ///< unit directions and distances from the points to the samples
    _Alignas(64) real weight[GLINT_GROUP]; ///< the cone's solid angle over pi
} R(light_sample_set);

static inline void R(load_light_samples)(const glint_light_sample *const light_sample[], uint32_t count,
                                         R(light_sample_set) * out)
{
    for (uint32_t s = 0; s < count; s++) {
#if GLINT_REAL == 32
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < GLINT_GROUP; i++) {
                out->rounded[s][0][k][i] = (float)light_sample[s]->position[k][i];
                out->rounded[s][1][k][i] = (float)light_sample[s]->normal[k][i];
            }
        out->light_sample[s].position = (const float(*)[GLINT_GROUP])out->rounded[s][0];
        out->light_sample[s].normal = (const float(*)[GLINT_GROUP])out->rounded[s][1];
#else
        out->light_sample[s].position = light_sample[s]->position;
        out->light_sample[s].normal = light_sample[s]->normal;
#endif
        out->light_sample[s].exact_position = light_sample[s]->position;
    }
    for (uint32_t s = 0; s < count && light_sample[s]->emission == GLINT_EMIT_CONE; s++) {
        out->light_sample[s].exact_position = (const double(*)[GLINT_GROUP])out->exact_position[s];
#if GLINT_REAL == 64
        out->light_sample[s].position = out->light_sample[s].exact_position;
#endif
    }
}

/// Returns the lanes within the cone. Also computes the cosine of the angle to the axis, this cosine minus 1, and the
/// smooth step.
static inline rm R(in_cone)(const glint_spot *spot, const vr l[3], vr l2, vr *cosine, vr *less_1, vr *step)
{
    const vr axis[3] = { r_set(spot->axis[0]), r_set(spot->axis[1]), r_set(spot->axis[2]) };
    const vr one = r_set(1);
    vr c = r_min(-DOT(axis, l) / r_sqrt(l2), one);
    vr x = r_max(r_min((c - r_set(spot->outer)) * r_set(spot->inverse), one), r_set(0));
    rm lit = r_lt(r_set(0), x);
    if (spot->exponent != 0)
        lit = rm_and(lit, r_le(r_set(0x1p-126), c));
    *cosine = c;
    *less_1 = c - one;
    *step = (x * x) * (r_set(3) - r_set(2) * x);
    return lit;
}

/// Returns the cone's factor in float; undefined in lanes that are not lit.
static inline vf R(cone_factor)(const glint_spot *spot, fm lit, vf cosine, vf less_1, vf step)
{
    if (spot->exponent == 0)
        return step;
    const vf one = f_set(1);
    return step * f_exp2(f_set(spot->exponent) * f_log2(f_select(lit, cosine, one), f_select(lit, less_1, f_set(0))));
}

/// Returns the lanes towards which a sample emits; *m: the cosine at the light's surface, times the distance in the
/// light's units.
static inline rm R(in_front)(uint32_t emission, const R(light_sample_lanes) * lanes, int i, const vr l[3], vr *m)
{
    const vr n[3] = { r_load(lanes->normal[0] + i), r_load(lanes->normal[1] + i), r_load(lanes->normal[2] + i) };
    *m = -DOT(n, l);
    if (emission == GLINT_EMIT_RADIANT_BOTH)
        *m = r_max(*m, -*m);
    return r_lt(r_set(0), *m);
}

#endif
