/// Scattered rays under a sky with bright parts: half of them are drawn by the sky's table, half by the cosine.
///
/// A ray's weight is the cosine density divided by the mean of both densities, whichever drew it (the balance
/// heuristic of E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997). So no weight exceeds 2,
/// a bright part is found by its own density, and rays go on as paths like all others.
#include "engine/base/vec.h"
#include "engine/render/effects/environment/sky.h"
#include "engine/render/effects/indirect/paths.h"

#include <math.h>

#define PI 0x1.921fb54442d18p+1

/// Maps a point of the unit square to a direction around a normal, with the density of the cosine: the arithmetic of
/// the stage scatter in double.
static void draw_cosine(const double n[3], const double u[2], double d[3])
{
    const double r = sqrt(u[0]), h = sqrt(1 - u[0]), x = r * glint_cos(2 * PI * u[1]), y = r * glint_sin(2 * PI * u[1]);
    double tangent[3], bitangent[3];
    vec_tangents(n, tangent, bitangent);
    for (int c = 0; c < 3; c++)
        d[c] = (x * tangent[c] + y * bitangent[c]) + h * n[c];
}

/// Draws a direction. The first coordinate chooses the density and is stretched again, so that both halves stay
/// stratified. Returns the ray's weight; 0 below the horizon.
static double draw(const glint_sky *sky, const double n[3], const double square[2], double d[3])
{
    const bool by_sky = square[0] < 0.5;
    const double u[2] = { by_sky ? 2 * square[0] : 2 * square[0] - 1, square[1] };
    if (by_sky)
        glint_sky_draw(sky, u, d);
    else
        draw_cosine(n, u, d);
    const double cosine = vec_dot(n, d) / PI;
    return cosine > 0 ? cosine / (0.5 * glint_sky_density(sky, d) + 0.5 * cosine) : 0;
}

void glint_indirect_draw_sky(const glint_tile *tile, const glint_plan *plan, const uint16_t *wanted, const draws *drawn,
                             uint32_t further, double (*direction)[GLINT_TILE_SAMPLES], double *share)
{
    const glint_precision precision = plan->desc.precision;
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = wanted[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            double square[2], n[3], d[3];
            glint_indirect_square(drawn, i, further, square);
            for (int c = 0; c < 3; c++)
                n[c] = glint_real_at(tile->surface.normal[c], precision, i);
            share[i] = draw(plan->sky, n, square, d);
            for (int c = 0; c < 3; c++)
                glint_real_put(direction[c], precision, i, d[c]);
        }
}

void glint_indirect_weigh_sky(glint_rays *rays, const uint16_t *wanted, const double *share)
{
    for (uint32_t g = 0; g < rays->group_count; g++)
        for (unsigned bits = wanted[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            if (!(share[i] > 0))
                rays->active[g] &= (uint16_t) ~(bits & -bits);
            for (int c = 0; c < 3; c++)
                rays->throughput[c][i] *= share[i];
        }
}
