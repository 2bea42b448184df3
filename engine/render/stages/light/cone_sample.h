/// The reference for cone.h: one sample of a ball for one point, in plain C. Contract: stages.h, at
/// glint_light_sample.
#ifndef GLINT_CONE_SAMPLE_H
#define GLINT_CONE_SAMPLE_H

#include "engine/render/stages/stages.h"

#include <math.h>

typedef struct glint_cone_sample {
    double direction[3], far; ///< from the point to the sample: unit direction, and distance
    double position[3];
    double weight; ///< the solid angle over pi
} glint_cone_sample;

static inline double glint_cone_dot(const double a[3], const double b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

/// Computes a direction at the polar angle given by `cosine` from the unit vector n. x and y: cosine and sine of the
/// azimuth around n, times the sine of the polar angle.
static inline void glint_cone_turn(const double n[3], double x, double y, double cosine, double out[3])
{
    const double g = n[2] >= 0 ? 1 : -1;
    const double p = -1 / (g + n[2]), q = (n[0] * n[1]) * p;
    const double tangent[3] = { 1 + g * ((n[0] * n[0]) * p), g * q, 0 - g * n[0] };
    const double bitangent[3] = { q, g + (n[1] * n[1]) * p, 0 - n[1] };
    for (int k = 0; k < 3; k++)
        out[k] = (x * tangent[k] + y * bitangent[k]) + cosine * n[k];
}

/// Returns a sample. `slack`: GLINT_CONE_SLACK_ for the precision of the point and its normal.
static inline glint_cone_sample glint_cone_at(const glint_light_sample *light_sample, double scale, double slack,
                                              const double point[3], const double normal[3], uint32_t lane)
{
    const double u = light_sample->position[0][lane],
                 turn[2] = { light_sample->position[1][lane], light_sample->position[2][lane] };
    const double r = light_sample->radius * scale;
    double to[3], t;
    glint_cone_sample out;
    for (int k = 0; k < 3; k++)
        to[k] = (light_sample->center[k] - point[k]) * scale;
    const double length2 = glint_cone_dot(to, to), d = sqrt(length2), excess = (d - r) * (d + r);
    const double g = excess / length2;
    if (g < (glint_cone_dot(normal, to) > 0 ? slack : -slack)) { // inside, or on the surface: half of all directions
        const double inside = 0 - excess > 0 ? 0 - excess : 0, s = sqrt(u * (2 - u));
        glint_cone_turn(normal, s * turn[0], s * turn[1], 1 - u, out.direction);
        const double b = 0 - glint_cone_dot(to, out.direction), root = sqrt(b * b + inside);
        t = b > 0 ? inside / (b + root) : root - b;
        out.weight = 2;
    } else {
        const double open = g > 0 ? g : 0, q = r / d, q2 = q * q, h = 1 / (1 + sqrt(open));
        const double m = (u * q2) * h, s2 = (u * h) * (2 - m), s = q * sqrt(s2), rest = 1 - s2;
        const double axis[3] = { to[0] / d, to[1] / d, to[2] / d };
        glint_cone_turn(axis, s * turn[0], s * turn[1], 1 - m, out.direction);
        t = (d * open) / ((1 - m) + q * sqrt(rest > 0 ? rest : 0));
        out.weight = 2 * (q2 * h);
    }
    out.far = t * (1 / scale);
    for (int k = 0; k < 3; k++) {
        const double hit = point[k] + out.direction[k] * out.far,
                     above = hit > light_sample->lower[k] ? hit : light_sample->lower[k];
        out.position[k] = above < light_sample->upper[k] ? above : light_sample->upper[k];
    }
    return out;
}

#endif
