/// The directions in which microfacets send a ray, drawn from the distribution of the normals that the ray sees
/// (E. Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018; by caps of the hemisphere as in J.
/// Dupuy and A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023).
///
/// The weight of a ray is the reflected or transmitted share at the facet, times the probability that no other facet
/// is in its way: G2 / G1 with Smith's height-correlated G2 for reflection, and G1 of the new direction for
/// refraction (B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007).
///
/// Under a sky with bright parts, a reflected ray is drawn by the sky's table (effects/environment/sky.h) or by the facets,
/// whichever is likely to bring more light: nearly always by the sky where the surface mirrors a sun, and rarely
/// elsewhere. Both directions are weighed by the balance heuristic, as in effects/indirect/sky.c.
///
/// Facets of Beckmann's distribution are drawn from GGX too, and weighted by the quotient of the two distributions,
/// exp(-x) (1 + x)^2 with x = tan^2 / alpha^2, which is at most 4/e.
#include "engine/base/math.h"
#include "engine/base/vec.h"
#include "engine/render/effects/environment/sky.h"
#include "engine/render/effects/pattern/pattern.h"
#include "engine/render/effects/rough/rough.h"

#define PI 0x1.921fb54442d18p+1
#define BECKMANN_FAR 700 ///< x above which Beckmann's distribution has no facets in double
#define LEAST_CHANCE 0.01 ///< of reflection and of refraction

// ---- The surface ----

/// A sample of a rough surface, seen along a ray.
typedef struct view {
    double axis[3][3]; ///< two tangents and the normal on the ray's side
    double to_eye[3]; ///< unit vector against the ray, along these axes; the last component is >= 0
    double alpha;
    bool beckmann;
} view;

static void load_normal(const glint_tile *tile, const glint_plan *plan, uint32_t i, bool bumped, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = glint_real_at(bumped ? tile->surface.normal[c] : tile->unbumped[c], plan->desc.precision, i);
}

/// Finds the normal of sample i on the ray's side, with its bump, and the unit vector against the ray.
static void find_view(const glint_tile *tile, const glint_plan *plan, uint32_t i, double normal[3], double to_eye[3])
{
    for (int c = 0; c < 3; c++)
        to_eye[c] = -glint_tile_direction(tile, plan->desc.precision, c, i);
    vec_normalize(to_eye, to_eye);
    load_normal(tile, plan, i, true, normal);
    if (glint_plan_bumps(plan) && !(vec_dot(normal, to_eye) > 0))
        load_normal(tile, plan, i, false, normal);
}

static view look(const glint_tile *tile, const glint_plan *plan, uint32_t i, const glint_bounce_material *m)
{
    view v = { .alpha = m->alpha, .beckmann = m->beckmann };
    double to_eye[3];
    find_view(tile, plan, i, v.axis[2], to_eye);
    vec_tangents(v.axis[2], v.axis[0], v.axis[1]);
    for (int k = 0; k < 3; k++)
        v.to_eye[k] = vec_dot(v.axis[k], to_eye);
    v.to_eye[2] = fmin(fmax(v.to_eye[2], 0), 1);
    return v;
}

// ---- A facet ----

/// Draws the normal of a facet along the axes. Returns x, its tan^2 / alpha^2.
static double draw_facet(const view *v, const double disk[2], double facet[3])
{
    double eye[3] = { v->alpha * v->to_eye[0], v->alpha * v->to_eye[1], v->to_eye[2] };
    vec_normalize(eye, eye);
    const double u = fmin(disk[0] * disk[0] + disk[1] * disk[1], 1), top = 1 + eye[2];
    const double stretch = sqrt(fmax(top * (2 - u * top), 0));
    const double h[3] = { disk[0] * stretch + eye[0], disk[1] * stretch + eye[1], (1 - u) * top };
    facet[0] = v->alpha * h[0];
    facet[1] = v->alpha * h[1];
    facet[2] = h[2];
    if (vec_max_abs(facet) > 0)
        vec_normalize(facet, facet);
    else
        facet[2] = 1;
    return (h[0] * h[0] + h[1] * h[1]) / (h[2] * h[2]);
}

/// Returns the length of a direction with the cosine c after its tangential part is multiplied by alpha.
static double stretched(double alpha, double c) { return sqrt(c * c + alpha * alpha * (1 - c * c)); }

/// Returns c times Smith's Lambda of Beckmann's distribution at the cosine c, in Heitz' form of Walter's fit.
static double beckmann_mask(double alpha, double c)
{
    const double s = alpha * sqrt(fmax(1 - c * c, 0)), q = c / s;
    return q < 1.6 ? s * ((0.396 * q - 1.259) * q + 1) / (2.181 * q + 3.535) : 0;
}

/// Returns the part of the weight that depends on the distribution. c: the cosine of the new direction, on its side.
static double unmasked(const view *v, double x, double c, bool through)
{
    const double eye = v->to_eye[2], a = stretched(v->alpha, eye), b = stretched(v->alpha, c);
    if (!v->beckmann)
        return through ? 2 * c / (c + b) : c * (eye + a) / (c * a + eye * b);
    if (!(x < BECKMANN_FAR))
        return 0;
    const double quotient = glint_exp(-x) * ((1 + x) * (1 + x)) * ((eye + a) / 2); // times G1 of GGX, divided by eye
    const double mask = beckmann_mask(v->alpha, eye), other = beckmann_mask(v->alpha, c);
    return through ? quotient * (c / ((eye + mask) * (c + other))) : quotient * (c / (c * (eye + mask) + eye * other));
}

/// Returns the cosine of the refracted ray at a facet; a negative number for total reflection. c: the cosine of the
/// arriving ray. ratio: see glint_event_ratio.
static double refracted_cosine(double c, double ratio)
{
    const double k = 1 - ratio * ratio * (1 - c * c);
    return ratio == 1 ? c : k > 0 ? sqrt(k) : -1;
}

/// Returns the share of unpolarised light that a dielectric reflects (Fresnel). s: the cosine of the refracted ray.
static double dielectric(double c, double s, double ratio)
{
    const double p = (ratio * c - s) / (ratio * c + s), q = (c - ratio * s) / (c + ratio * s);
    return ratio == 1 ? 0 : s < 0 ? 1 : 0.5 * (p * p + q * q);
}

/// Returns the reflected share in channel c at a facet, without the material's factors. cosine: of the arriving ray and
/// the facet. ratio: see glint_event_ratio; only read with `fresnel`.
static double reflectance(const glint_bounce_material *m, int c, double cosine, double ratio)
{
    if (m->fresnel)
        return dielectric(cosine, refracted_cosine(cosine, ratio), ratio);
    const double r = 1 - cosine;
    return glint_schlick(m, c, (r * r) * (r * r) * r);
}

// ---- Under a bright sky ----

/// Draws a direction by the sky, and finds the facet that reflects the ray there. Returns x as draw_facet does; a
/// negative number: no facet reflects the ray there.
static double draw_by_sky(const view *v, const glint_sky *sky, const double square[2], double facet[3], double direction[3])
{
    double out[3];
    glint_sky_draw(sky, square, direction);
    for (int k = 0; k < 3; k++) {
        out[k] = vec_dot(v->axis[k], direction);
        facet[k] = v->to_eye[k] + out[k];
    }
    if (!(out[2] > 0) || !(facet[2] > 0))
        return -1;
    vec_normalize(facet, facet);
    const double slope = sqrt(facet[0] * facet[0] + facet[1] * facet[1]) / (v->alpha * facet[2]);
    return slope * slope;
}

/// Returns the density of the rays that draw_facet reflects at a facet, per steradian; may be infinite.
static double facet_density(const view *v, double x, const double facet[3])
{
    const double c = facet[2] * facet[2];
    const double d = 1 / (PI * (v->alpha * v->alpha) * (c * c) * ((1 + x) * (1 + x)));
    return d / (2 * (v->to_eye[2] + stretched(v->alpha, v->to_eye[2])));
}

/// Returns the probability of a direction drawn by the sky against one drawn by facets, given both densities there:
/// by the light that either is expected to bring. A direction of the sky brings the sky's total light, if facets reflect
/// it; one of the facets brings the mean light of all directions.
static double sky_chance(double facets, double sky)
{
    const double light = 1 / (1 / facets + 1 / sky); // both may be 0, the first infinite
    return light / (light + 1 / (4 * PI));
}

/// Returns the density of the facets relative to that of both, drawn with these chances (the balance heuristic).
static double balance(double facets, double sky, double chance)
{
    const double both = chance * sky + (1 - chance) * facets;
    return !(both > 0) ? 0 : both < HUGE_VAL ? facets / both : 1 / (1 - chance);
}

/// Draws a facet by the sky or by the ray. *share: the factor of its ray's weight. Returns x as draw_by_sky does.
///
/// Both are drawn from the same point. The chance of the sky depends on the direction that it draws, so the weights of both
/// use the chance at their own direction.
static double draw_either(const view *v, const glint_sky *sky, const double cube[3], const double disk[2], double facet[3],
                          double *share)
{
    double direction[3], chance = 0;
    const double x = draw_by_sky(v, sky, cube, facet, direction);
    if (x >= 0) {
        const double facets = facet_density(v, x, facet), density = glint_sky_density(sky, direction);
        chance = sky_chance(facets, density);
        *share = balance(facets, density, chance);
    }
    if (cube[2] < chance)
        return x;
    const double own = draw_facet(v, disk, facet), cosine = vec_dot(v->to_eye, facet);
    for (int c = 0; c < 3; c++) {
        direction[c] = 0;
        for (int k = 0; k < 3; k++)
            direction[c] += (2 * cosine * facet[k] - v->to_eye[k]) * v->axis[k][c];
    }
    vec_normalize(direction, direction);
    const double facets = facet_density(v, own, facet), density = glint_sky_density(sky, direction), other = sky_chance(facets, density);
    *share = balance(facets, density, other) * ((1 - other) / (1 - chance));
    return own;
}

// ---- Rays ----

void glint_rough_shares(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                        const double disk[2], double share[2])
{
    glint_bounce_material buffer;
    const glint_bounce_material *m = glint_tile_bouncing(tile, frame->plan, i, &buffer);
    const view v = look(tile, frame->plan, i, m);
    const double ratio = glint_event_ratio(batch, tile, frame, i), least = LEAST_CHANCE;
    double facet[3];
    draw_facet(&v, disk, facet);
    share[0] = share[1] = 0;
    for (int c = 0; c < 3; c++) {
        const double r = fmax(reflectance(m, c, fmin(vec_dot(v.to_eye, facet), 1), ratio), least);
        share[GLINT_EVENT_MIRROR] += m->mirrors ? m->mirror[c] * m->specular[c] * r : 0;
        if (m->transmits)
            share[GLINT_EVENT_REFRACT] += fmax(m->transmission[c], least) * (m->fresnel ? fmax(1 - r, least) : 1);
    }
}

/// Fills the weights of a ray at a facet. Totally reflected light has not crossed the surface: see glint_bsdf_weights.
static void weigh(const glint_bounce_material *m, glint_event event, double cosine, double ratio, double factor,
                  double weight[3])
{
    const bool total = refracted_cosine(cosine, ratio) < 0;
    for (int c = 0; c < 3; c++) {
        const double r = reflectance(m, c, cosine, ratio), mirror = m->mirror[c] * m->specular[c];
        const double beyond = (total ? fmax(1 - m->clear - mirror, 0) : m->transmission[c]) * (m->fresnel ? 1 - r : 1);
        weight[c] = glint_clamp_throughput(weight[c] * ((event == GLINT_EVENT_MIRROR ? mirror * r : beyond) * factor));
    }
}

void glint_rough_leave(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       const double disk[2], const double *cube, glint_event event, glint_rays *rays, uint32_t n)
{
    glint_bounce_material buffer;
    const glint_bounce_material *m = glint_tile_bouncing(tile, frame->plan, i, &buffer);
    const view v = look(tile, frame->plan, i, m);
    const double ratio = glint_event_ratio(batch, tile, frame, i);
    double facet[3], out[3], direction[3], weight[3], share = 1;
    const glint_sky *sky = event == GLINT_EVENT_MIRROR ? frame->plan->sky : NULL;
    const double x = sky ? draw_either(&v, sky, cube, disk, facet, &share) : draw_facet(&v, disk, facet);
    const double cosine = fmin(vec_dot(v.to_eye, facet), 1);
    const double s = event == GLINT_EVENT_REFRACT ? refracted_cosine(cosine, ratio) : -1;
    const bool through = s >= 0;
    for (int k = 0; k < 3; k++)
        out[k] = through ? (ratio * cosine - s) * facet[k] - ratio * v.to_eye[k] : 2 * cosine * facet[k] - v.to_eye[k];
    for (int c = 0; c < 3; c++) {
        direction[c] = (out[0] * v.axis[0][c] + out[1] * v.axis[1][c]) + out[2] * v.axis[2][c];
        weight[c] = rays->throughput[c][n];
    }
    vec_normalize(direction, direction);
    const double along = through ? -out[2] : out[2];
    vec_scale(out, direction, through ? -1 : 1);
    const bool leaves = along > 0 && glint_tile_leaves(tile, frame->plan, i, out);
    const double factor = leaves && x >= 0 ? unmasked(&v, x, along, through) : 0;
    weigh(m, event, cosine, ratio, factor * share, weight);
    for (int c = 0; c < 3; c++) {
        glint_real_put(rays->direction[c], frame->plan->desc.precision, n, direction[c]);
        rays->throughput[c][n] = weight[c];
    }
    rays->depth[n]++;
    rays->camera_path[n] = false;
    glint_rays_mark(rays->inward, n, glint_has_lane(tile->hit.back, i) != through);
    glint_rays_mark(rays->skip_emitters, n, m->facets ? !through : rays->scatters[n] > 0);
    if (through && frame->plan->transmits)
        glint_event_cross(tile, frame, i, &rays->media[n]);
}
