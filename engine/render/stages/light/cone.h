// cone: the positions of samples of a ball-shaped light, in the cone in which a point sees the ball. All of this is
// computed in double, even if real is float: the cone of a light 1e9 radii away is narrower than float's rounding
// error. Contract: stages.h, at glint_light_sample.
#ifndef GLINT_LIGHT_CONE_H
#define GLINT_LIGHT_CONE_H

#include "engine/render/stages/light/light_sample.h"
#include "engine/render/stages/simd/real.h"

/// The data that all samples of VD points share.
typedef struct R(cone) {
    vd point[3], away[3]; ///< away: vector from the point to the ball's centre, in the light's units
    vd axis[3], tangent[3], bitangent[3];
    vd distance, length2, sine, sine2, part; ///< length and squared length of `away`; q, q2 and h of cone_sample.h
    vd before, beyond; ///< squares: of the length of a tangent, for points outside; of half the chord, for points
        ///< inside
    dm within;
} R(cone);

/// Computes directions perpendicular to a unit vector (T. Duff et al., JCGT 6(1), 2017).
static inline void R(cone_frame)(R(cone) * cone)
{
    const vd one = d_set(1), zero = d_set(0), *n = cone->axis;
    const vd g = d_select(d_le(zero, n[2]), one, d_set(-1));
    const vd p = d_set(-1) / (g + n[2]), q = (n[0] * n[1]) * p;
    cone->tangent[0] = one + g * ((n[0] * n[0]) * p);
    cone->tangent[1] = g * q;
    cone->tangent[2] = zero - g * n[0];
    cone->bitangent[0] = q;
    cone->bitangent[1] = g + (n[1] * n[1]) * p;
    cone->bitangent[2] = zero - n[1];
}

static inline void R(see_ball)(const glint_light_sample *light_sample, double scale, const void *const point[3],
                               const void *const normal[3], size_t at, R(cone) * cone)
{
    const vd zero = d_set(0), one = d_set(1), r = d_set(light_sample->radius * scale);
    const double slack = GLINT_REAL == 64 ? GLINT_CONE_SLACK_DOUBLE : GLINT_CONE_SLACK_FLOAT;
    vd n[3];
    for (int k = 0; k < 3; k++) {
        n[k] = R(load_exact)((const real *)normal[k] + at);
        cone->point[k] = R(load_exact)((const real *)point[k] + at);
        cone->away[k] = (d_set(light_sample->center[k]) - cone->point[k]) * d_set(scale);
    }
    const vd length2 = DOT(cone->away, cone->away), d = d_sqrt(length2), excess = (d - r) * (d + r);
    const vd g = excess / length2;
    const dm facing = d_lt(zero, DOT(n, cone->away));
    cone->within = d_lt(g, d_select(facing, d_set(slack), d_set(-slack)));
    cone->distance = d;
    cone->length2 = length2;
    cone->before = d_max(g, zero);
    cone->beyond = d_max(zero - excess, zero);
    cone->sine = d_select(cone->within, one, r / d);
    cone->sine2 = cone->sine * cone->sine;
    cone->part = d_select(cone->within, one, one / (one + d_sqrt(cone->before)));
    for (int k = 0; k < 3; k++)
        cone->axis[k] = d_select(cone->within, n[k], cone->away[k] / d);
    R(cone_frame)(cone);
}

/// Computes the directions from the points to one sample each. Returns the distances at which they hit the ball from
/// outside, or leave it, in the light's units.
static inline vd R(aim_in_cone)(const R(cone) * cone, vd u, vd cosine, vd sine, vd direction[3])
{
    const vd zero = d_set(0), one = d_set(1);
    const vd m = (u * cone->sine2) * cone->part, c = one - m;
    const vd s2 = (u * cone->part) * (d_set(2) - m), s = cone->sine * d_sqrt(s2);
    const vd x = s * cosine, y = s * sine;
    for (int k = 0; k < 3; k++)
        direction[k] = (x * cone->tangent[k] + y * cone->bitangent[k]) + c * cone->axis[k];
    const vd far = c + cone->sine * d_sqrt(d_max(one - s2, zero));
    const vd b = zero - DOT(cone->away, direction), root = d_sqrt(b * b + cone->beyond);
    const vd inside = d_select(d_lt(zero, b), cone->beyond / (b + root), root - b);
    return d_select(cone->within, inside, (cone->distance * cone->before) / far);
}

/// Computes the `count` samples of `light_sample` for the points of the group at `at`, and stores them in `set`.
static __attribute__((noinline)) void R(place_in_cone)(const glint_light_sample *const light_sample[], uint32_t count, double scale,
                             const void *const point[3], const void *const normal[3], size_t at,
                             R(light_sample_set) * set)
{
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        R(cone) cone;
        R(see_ball)(light_sample[0], scale, point, normal, at + (size_t)i, &cone);
        R(store_exact)(set->weight + i, d_set(2) * (cone.sine2 * cone.part));
        for (uint32_t s = 0; s < count; s++) {
            const double(*square)[GLINT_GROUP] = light_sample[s]->position;
            vd direction[3];
            const vd t =
                R(aim_in_cone)(&cone, d_load(square[0] + i), d_load(square[1] + i), d_load(square[2] + i), direction);
            const vd far = t * d_set(1 / scale);
            R(store_exact)(set->far[s] + i, far);
            for (int k = 0; k < 3; k++) {
                const vd hit = cone.point[k] + direction[k] * far;
                const vd position =
                    d_min(d_max(hit, d_set(light_sample[0]->lower[k])), d_set(light_sample[0]->upper[k]));
                d_store(set->exact_position[s][k] + i, position);
                R(store_exact)(set->direction[s][k] + i, direction[k]);
#if GLINT_REAL == 32
                R(store_exact)(set->rounded[s][0][k] + i, position);
#endif
            }
        }
    }
}

static inline bool R(is_cone)(const glint_light_sample *light_sample)
{
    return light_sample && light_sample->emission == GLINT_EMIT_CONE;
}

#endif
