/// The directions in which microfacets send a ray, drawn from the distribution of the normals that the ray sees
/// (E. Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018; by caps of the hemisphere as in J.
/// Dupuy and A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023).
///
/// The weight of a ray is the reflected or transmitted share at the facet, times the probability that no other facet
/// is in its way: G2 / G1 with Smith's height-correlated G2 for reflection, and G1 of the new direction for
/// refraction (B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007).
///
/// Under a sky with bright parts, a ray that is reflected, or refracted out of glass, is drawn by the sky's table
/// (effects/environment/sky.h) or by the facets, whichever is likely to bring more light: nearly always by the sky where
/// the surface mirrors or blurs a sun, and rarely elsewhere. Both directions are weighed by the balance heuristic, as in
/// effects/indirect/sky.c.
///
/// Facets of Beckmann's distribution are drawn from GGX too, and weighted by the quotient of the two distributions,
/// exp(-x) (1 + x)^2 with x = tan^2 / alpha^2, which is at most 4/e.
#include "engine/base/math.h"
#include "engine/base/vec.h"
#include "engine/render/effects/environment/sky.h"
#include "engine/render/pattern/pattern.h"
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
    const glint_bounce_material *m;
    double ratio; ///< see glint_event_ratio
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

static view look(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                 const glint_bounce_material *m)
{
    view v = { .alpha = m->alpha, .beckmann = m->beckmann, .m = m, .ratio = glint_event_ratio(batch, tile, frame, i) };
    double to_eye[3];
    find_view(tile, frame->plan, i, v.axis[2], to_eye);
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

/// Fills the shares of reflection and refraction at a facet. cosine: of the arriving ray and the facet.
static void find_shares(const view *v, double cosine, double share[2])
{
    const glint_bounce_material *m = v->m;
    const double least = LEAST_CHANCE;
    share[0] = share[1] = 0;
    for (int c = 0; c < 3; c++) {
        const double r = fmax(reflectance(m, c, cosine, v->ratio), least);
        share[GLINT_EVENT_MIRROR] += m->mirrors ? m->mirror[c] * m->specular[c] * r : 0;
        if (m->transmits)
            share[GLINT_EVENT_REFRACT] += fmax(m->transmission[c], least) * (m->fresnel ? fmax(1 - r, least) : 1);
    }
}

static double cosine_at(const view *v, const double facet[3]) { return fmin(vec_dot(v->to_eye, facet), 1); }

/// Finds the ray that leaves a facet along the axes. Returns whether it crosses the surface.
static bool leave_facet(const view *v, const double facet[3], glint_event event, double out[3])
{
    const double cosine = cosine_at(v, facet), ratio = v->ratio;
    const double s = event == GLINT_EVENT_REFRACT ? refracted_cosine(cosine, ratio) : -1;
    for (int k = 0; k < 3; k++)
        out[k] = s >= 0 ? (ratio * cosine - s) * facet[k] - ratio * v->to_eye[k] : 2 * cosine * facet[k] - v->to_eye[k];
    return s >= 0;
}

/// Turns a direction along the axes into one of the scene, of length 1.
static void to_scene(const view *v, const double along[3], double direction[3])
{
    for (int c = 0; c < 3; c++)
        direction[c] = (along[0] * v->axis[0][c] + along[1] * v->axis[1][c]) + along[2] * v->axis[2][c];
    vec_normalize(direction, direction);
}

// ---- Under a bright sky ----

/// A ray that leaves a facet.
typedef struct leaving {
    double facet[3], x; ///< see draw_facet; x < 0: no facet sends the ray there
    glint_event event;
    double factor; ///< of its weight
} leaving;

/// Draws a direction by the sky, and finds the facet that reflects the ray there, or refracts it there out of glass.
/// open: whether no medium is beyond the surface.
static leaving draw_by_sky(const view *v, const glint_sky *sky, bool open, const double square[2], double direction[3])
{
    leaving ray = { .x = -1, .event = GLINT_EVENT_MIRROR };
    double out[3];
    glint_sky_draw(sky, square, direction);
    for (int k = 0; k < 3; k++)
        out[k] = vec_dot(v->axis[k], direction);
    if (!(out[2] > 0 ? v->m->mirrors : open && v->ratio != 1))
        return ray;
    ray.event = out[2] > 0 ? GLINT_EVENT_MIRROR : GLINT_EVENT_REFRACT;
    const double part = ray.event == GLINT_EVENT_MIRROR ? 1 : v->ratio;
    for (int k = 0; k < 3; k++)
        ray.facet[k] = part < 1 ? -(part * v->to_eye[k] + out[k]) : part * v->to_eye[k] + out[k];
    const bool faces = ray.event == GLINT_EVENT_MIRROR || (vec_dot(ray.facet, v->to_eye) > 0 && vec_dot(ray.facet, out) < 0);
    if (!(ray.facet[2] > 0) || !faces)
        return ray;
    vec_normalize(ray.facet, ray.facet);
    const double slope = sqrt(ray.facet[0] * ray.facet[0] + ray.facet[1] * ray.facet[1]) / (v->alpha * ray.facet[2]);
    ray.x = slope * slope;
    return ray;
}

/// Returns the probability of the event of a ray at its facet.
static double event_chance(const view *v, const leaving *ray)
{
    double share[2];
    if (!v->m->mirrors || !v->m->transmits)
        return 1;
    find_shares(v, cosine_at(v, ray->facet), share);
    return share[ray->event] / (share[0] + share[1]);
}

/// Returns the density of the rays that draw_facet and the choice of an event send where this ray goes, per steradian; may
/// be infinite.
static double facet_density(const view *v, const leaving *ray)
{
    const double c = ray->facet[2] * ray->facet[2];
    const double d = 1 / (PI * (v->alpha * v->alpha) * (c * c) * ((1 + ray->x) * (1 + ray->x)));
    const double mirrored = d / (2 * (v->to_eye[2] + stretched(v->alpha, v->to_eye[2]))) * event_chance(v, ray);
    if (ray->event == GLINT_EVENT_MIRROR)
        return mirrored;
    const double cosine = cosine_at(v, ray->facet), s = refracted_cosine(cosine, v->ratio), wide = v->ratio * cosine - s;
    return mirrored * (4 * cosine * s / (wide * wide));
}

/// Returns the probability of a direction drawn by the sky against one drawn by facets, given both densities there:
/// by the light that either is expected to bring. A direction of the sky brings the sky's total light, if facets send the
/// ray there; one of the facets brings the mean light of all directions. Where facets find the bright part more often
/// than the sky does, it is left to them.
static double sky_chance(double facets, double sky)
{
    const double ratio = facets / sky, light = 1 / (1 / facets + 1 / sky); // both may be 0, the first infinite
    return sky > 0 ? light / (light + 1 / (4 * PI)) / (1 + ratio * ratio) : 0;
}

/// Returns the density of the facets relative to that of both, drawn with these chances (the balance heuristic).
static double balance(double facets, double sky, double chance)
{
    const double both = chance * sky + (1 - chance) * facets;
    return !(both > 0) ? 0 : both < HUGE_VAL ? facets / both : 1 / (1 - chance);
}

/// Replaces a ray of the facets, by its probability, with one that the sky draws; sets its factor. open: see draw_by_sky.
///
/// Both are drawn from the same point. The chance of the sky depends on the direction that it draws, so the weights of both
/// use the chance at their own direction. The sky draws no ray into glass, which the far side would bend away from the
/// sun, and none that is totally reflected where refraction was drawn.
static void draw_either(const view *v, const glint_sky *sky, bool open, const double cube[3], leaving *ray)
{
    double direction[3], out[3], chance = 0;
    leaving other = draw_by_sky(v, sky, open, cube, direction);
    if (other.x >= 0) {
        const double facets = facet_density(v, &other), density = glint_sky_density(sky, direction);
        chance = sky_chance(facets, density);
        other.factor = balance(facets, density, chance) * (event_chance(v, ray) / event_chance(v, &other));
    }
    if (cube[2] < chance) {
        *ray = other;
        return;
    }
    const bool through = leave_facet(v, ray->facet, ray->event, out);
    to_scene(v, out, direction);
    const bool drawn = ray->event == GLINT_EVENT_MIRROR || (through && open && v->ratio != 1);
    const double facets = facet_density(v, ray), density = drawn ? glint_sky_density(sky, direction) : 0;
    const double own = drawn ? sky_chance(facets, density) : 0;
    ray->factor = (drawn ? balance(facets, density, own) : 1) * ((1 - own) / (1 - chance));
}

// ---- Rays ----

void glint_rough_shares(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                        const double disk[2], double share[2])
{
    glint_bounce_material buffer;
    const view v = look(batch, tile, frame, i, glint_tile_bouncing(tile, frame->plan, i, &buffer));
    double facet[3];
    draw_facet(&v, disk, facet);
    find_shares(&v, cosine_at(&v, facet), share);
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

glint_event glint_rough_leave(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                              const double disk[2], const double *cube, glint_event event, glint_rays *rays, uint32_t n)
{
    glint_bounce_material buffer;
    const glint_bounce_material *m = glint_tile_bouncing(tile, frame->plan, i, &buffer);
    const view v = look(batch, tile, frame, i, m);
    leaving ray = { .event = event, .factor = 1 };
    double out[3], direction[3], weight[3];
    ray.x = draw_facet(&v, disk, ray.facet);
    if (frame->plan->sky) {
        uint32_t sides[2] = { 0 };
        if (m->transmits)
            glint_event_sides(batch, tile, frame, i, sides);
        draw_either(&v, frame->plan->sky, m->transmits && sides[1] == GLINT_NO_MEDIUM, cube, &ray);
    }
    const bool through = leave_facet(&v, ray.facet, ray.event, out);
    to_scene(&v, out, direction);
    const double along = through ? -out[2] : out[2];
    vec_scale(out, direction, through ? -1 : 1);
    const bool leaves = along > 0 && glint_event_leaves(tile, frame->plan, i, out);
    const double factor = leaves && ray.x >= 0 ? unmasked(&v, ray.x, along, through) : 0;
    for (int c = 0; c < 3; c++)
        weight[c] = rays->throughput[c][n];
    weigh(m, ray.event, cosine_at(&v, ray.facet), v.ratio, factor * ray.factor, weight);
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
    return ray.event;
}
