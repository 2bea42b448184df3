/// The contract of the stages from there to the picture: vertex, bounce, scatter, sky, shade, resolve, differ, tone. Begin with stages.h.
#ifndef GLINT_CONTRACT_FILM_H
#define GLINT_CONTRACT_FILM_H

#include "engine/stages/contract/light.h"

// ---- vertex: light that was computed once for a face or a vertex ----

/// The light of all lights together at a face or vertex, for two terms.
typedef struct glint_shading_point_light {
    float term[2][3]; ///< diffuse, specular; finite
} glint_shading_point_light;

typedef struct glint_vertex_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< a bit a lane: its triangle has sites
    const uint16_t *back; ///< of surface
    const uint32_t *prim;
    const glint_prim *prims;
    double scale; ///< of the table
    const glint_shading_points *shading_points;
    const glint_shading_point_light *light[2]; ///< of each site: seen from the front, from behind
    const glint_camera_args *camera; ///< the rays, as in glint_surface_args
    const void *origin[3], *direction[3];
    double *sum[2][3]; ///< in and out: added to where wanted; NULL: there is no such term
} glint_vertex_args;
// The arithmetic: ref/triangle.h, in double; the weights are the same as in surface.

// caps: the share left is 1, times that of each primitive, in the table's order. Of two balls that do not meet, the one with the
// shorter tangent is before the other. The arithmetic: ref/caps.h, by G. Oat and P. Sander, "Ambient aperture lighting", I3D
// 2007, here by halves of all angles, so that caps of 1e-8 keep their digits; areas by Gauss and Bonnet, sectors less triangles.

// ---- bounce: where rays go on from a surface ----

typedef struct glint_bounce_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< a bit a lane
    const glint_camera_args *camera; ///< the rays, of a perspective camera; NULL: their directions are in direction
    const void *direction[3], *normal[3]; ///< real; the normal as surface gives it
    const void *ratio; ///< real, > 0: refractive index on the ray's side of the surface over that beyond it
    void *reflected[3], *refracted[3]; ///< out, real, of length 1 up to rounding
    void *reflectance; ///< out, real: of a dielectric and unpolarised light, 0 .. 1
    uint16_t *total; ///< out: those of the wanted lanes with total internal reflection, whose `refracted` is undefined
} glint_bounce_args;
// Written where wanted. Groups without a wanted lane get total = 0 and nothing else; other lanes hold anything.
// The arithmetic: ref/real.h, by Snell and Fresnel.

// ---- scatter: directions around normals, as dense as their cosine ----

typedef struct glint_scatter_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< a bit a lane
    const void *normal[3]; ///< real, unit
    const uint32_t *number, *order, *digits[2]; ///< one a ray: a point of a sequence, and that sequence's seed
    uint32_t further; ///< points that all rays are beyond their `number`
    void *direction[3]; ///< out, real, of length 1 up to rounding and 2e-9
} glint_scatter_args;
// Groups without a wanted lane are not written; in others, lanes that are not wanted hold anything.
// A point (u, v) of the unit square is chosen as glint_sequence_flipped does, in double: equal areas of the square get equal
// shares of an even sky's light.
// The arithmetic: ref/scatter.h: the disk, lifted, which is cosine-weighted, in the orthonormal basis of T. Duff et al., JCGT
// 6(1), 2017.

// ---- sky: what rays that meet nothing bring ----

typedef struct glint_sky_args {
    uint32_t group_count;
    const uint16_t *missed; ///< a bit a lane
    const double *weight[3];
    double background[3];
    double *sum[3]; ///< in and out: where missed, weight times background is added
} glint_sky_args;

// ---- shade: the terms of each sample ----

typedef enum glint_term {
    GLINT_TERM_BACKGROUND,
    GLINT_TERM_AMBIENT,
    GLINT_TERM_DIFFUSE,
    GLINT_TERM_SPECULAR,
    GLINT_TERM_INDIRECT, ///< what other surfaces and the background light
    GLINT_TERM_MIRROR, ///< what mirrors show
    GLINT_TERM_TRANSMISSION, ///< what shows through
    GLINT_TERM_COUNT
} glint_term;
#define GLINT_TERM_LOCAL GLINT_TERM_INDIRECT ///< how many shade makes

typedef struct glint_shade_light {
    bool joined; ///< a further sample of the light before it in this call, with the same colours
    const uint16_t *lit; ///< lanes that the light reaches: its `lit`, or `open` where it casts shadows
    const float *cosine, *attenuation, *log2_specular; ///< attenuation: NULL = 1 everywhere
    const float *sine2, *schlick; ///< read for materials of GLINT_HIGHLIGHT_FACETS
    bool
        summed; ///< all samples of a light, as soft_light sums them up: `cosine` is its diffuse, `highlight` its specular,
    ///< and no other factors are read. No light is joined to it, and no material has microfacets
    const float *highlight;
    double diffuse[3], specular[3]; ///< colour times intensity
} glint_shade_light;

/// Numbers of materials that differ from sample to sample: read in lanes whose material says so, finite and >= 0 there.
/// NULL: no material has them.
typedef struct glint_shade_planes {
    const float *diffuse[3], *ambient[3], *specular[3];
    const float *shininess, *alpha;
    double ambient_light[3]; ///< what a plane of ambient reflectances is multiplied by
    const float *shaded[2][3]; ///< diffuse and specular terms of materials of GLINT_PLANE_SHADED, read in lanes that a light
    ///< reaches, 0 elsewhere; NULL: 0. Not read with sums
} glint_shade_planes;

typedef struct glint_shade_args {
    uint32_t group_count;
    const uint16_t *active, *hits;
    const uint32_t *material;
    const uint32_t *only; ///< the material of all hits, where they have one; NULL: not known
    const glint_shade_material *materials;
    const glint_shade_planes *planes; ///< NULL: no material has any
    double background[3];
    const float *facing; ///< read for materials of GLINT_HIGHLIGHT_FACETS
    bool highlights; ///< false: the specular term is not computed
    bool first; ///< also the terms that no light makes: background and ambient
    const glint_shade_light *lights;
    uint32_t light_count; ///< at most GLINT_LIGHT_CHUNK
    double *sum
        [GLINT_TERM_COUNT]
        [3]; ///< in and out: added to (specular: if highlights); NULL: the frame has one sample and these are all lights
    float *film[GLINT_TERM_COUNT][3]; ///< out when sum is NULL: the terms; NULL where it is not needed
    float *beauty[3]; ///< out when sum is NULL
} glint_shade_args;
// A light's contribution to a term is float; terms are added up in double:
// background where active and not hit, ambient where hit, then each light in order. The arithmetic: ref/shade.h; GGX and Beckmann
// with Smith's masking, whose Beckmann form is that of B. Walter et al., EGSR 2007. The samples of joined lights are added up
// first, in order, in float from 0. Products of colours, and what planes say, are made in double; a highlight is 0 below
// 2^-40. Of materials of GLINT_PLANE_SHADED no light is read. Where a sum is NULL the totals start at 0 and each is rounded to
// float: film, and
// beauty = ((background + ambient) + diffuse) + specular in float.

// ---- resolve: the mean of several samples ----

typedef struct glint_resolve_args {
    uint32_t group_count;
    double samples;
    double *sum[GLINT_TERM_COUNT][3]; ///< of the terms that shade does not make: NULL where the frame has none
    float *film[GLINT_TERM_COUNT][3]; ///< out, or NULL
    float *beauty[3]; ///< out
} glint_resolve_args;
// term = (float)(sum / samples); beauty as in shade, then ((beauty + indirect) + mirror) + transmission of those there are

// resolve_samples: as shade for each of `count` samples in turn, with sums that begin at 0, and then resolve; all have
// `first`, and `lights` of GLINT_LIGHT_CHUNK in all at most. They have groups, active, background, highlights and film and
// beauty, which groups without an active lane leave as they are, in common; `sum` is not read, and no material is of
// GLINT_PLANE_SHADED.

// ---- estimate, range, differ: which neighbours show different things, for adaptive sampling ----

#define GLINT_DIFFER_PAIRS 32 ///< most in a call
#define GLINT_DIFFER_LENGTH 40 ///< numbers that an array of a line may be read up to, however few pairs there are
enum { GLINT_DIFFER_ID, GLINT_DIFFER_NORMAL, GLINT_DIFFER_CODE = 4, GLINT_DIFFER_VALUES = 8 };
enum { GLINT_DIFFER_ALONG, GLINT_DIFFER_ACROSS, GLINT_DIFFER_FALLING, GLINT_DIFFER_RISING, GLINT_DIFFER_WAYS };

/// estimate: codes of 16 bits as sRGB gives them before they are rounded, by a sum of three roots. That has sRGB's derivative but for
/// a share of GLINT_ESTIMATE_SHARE, so that the estimates of two colours are as far apart as their codes but for that share of it
/// and for GLINT_ESTIMATE_SLACK, the rounding of three codes and of float.
#define GLINT_ESTIMATE_SHARE 0.004f
#define GLINT_ESTIMATE_SLACK 4.0f ///< codes

typedef struct glint_estimate_args {
    uint32_t count; ///< a multiple of GLINT_GROUP
    float gain; ///< factor of the light
    const float *light;
    float *code; ///< out
} glint_estimate_args;
// The arithmetic: ref/differ.h.

typedef struct glint_range_args {
    uint32_t count; ///< a multiple of GLINT_GROUP, above 0
    float gain, floor, top; ///< numbers are multiplied by the gain, then those below `floor` and NaN are `floor`, those above `top` are `top`
    const float *numbers;
} glint_range_args;
// range: the least and the most of so many.

/// Two lines of pixels, p[0] .. and q[0] ..: rows, or columns, that lie side by side. Each value of a line is an array of
/// GLINT_DIFFER_LENGTH numbers or more.
typedef struct glint_differ_args {
    const float *const *p, *const *q; ///< GLINT_DIFFER_VALUES each: number of the object, its normal, codes. q: NULL, there is no such line
    uint32_t count; ///< pairs (p[i], q[i])
    uint32_t ahead; ///< pairs of which one is a place further on. Both at most GLINT_DIFFER_PAIRS
    bool along; ///< p's pixels are compared with each other
    bool alpha; ///< codes have four channels, else three
    float low, high; ///< a sum of differences of codes that is not enough for certain; that is enough if it is exceeded
    float cosine; ///< of normals: below it they differ
} glint_differ_args;

/// A bit a pair. `sure`: it differs. `open`: it does if its codes do, which low and high leave open; of a pair that is
/// sure as well it means nothing.
typedef struct glint_differences {
    uint32_t sure[GLINT_DIFFER_WAYS], open[GLINT_DIFFER_WAYS];
} glint_differences;
// Bit i is of (p[i], p[i + 1]) along, (p[i], q[i]) across, (p[i], q[i + 1]) falling and (p[i + 1], q[i]) rising.
// Pixels differ by objects, where these are the same and not 0 by normals, and by codes. The arithmetic: ref/differ.h.

// ---- tone: 8-bit codes, written into the image ----

/// Any rising map of 0 .. top to 0 .. 255 whose steps are further apart than the buckets. A bucket holds the floats
/// that agree in their upper 16 bits; its entry is code | threshold << 8: the code of its first float, and from which
/// of the lower 16 bits on the code is one more (65536: never). The last entry is top's.
#define GLINT_TONE_FIRST 0x3800u ///< upper bits of 2^-15; floats below have code 0

/// Avoids most look-ups: an estimate of the pixel value with a fraction, and its error bound.
typedef struct glint_tone_fit {
    float knee, slope, base; ///< x < knee: v = slope x + base
    float scale[16], power[6], offset; ///< others: v = scale[e & 15] P(m) + offset; x = m 2^(e - 127), m in [1, 2),
        ///< P(m) = power[0] + power[1] m + ... + power[5] m^5
    uint32_t doubt; ///< v is in [256, 512), so that its lower 15 bits are the fraction. Where they are >= doubt, the
        ///< 8 bits above them are the table's code, however the estimate is rounded, with or without FMA
} glint_tone_fit;

typedef struct glint_tone_args {
    uint32_t group_count, groups_across; ///< as in glint_camera_args; group_count is a multiple of groups_across
    const uint16_t *active; ///< a bit a lane: pixels whose codes are wanted, of those inside the image
    const float *beauty[3];
    float gain; ///< > 0: factor of the light
    float white, top; ///< light above `white` is clipped; above `top` (at most `white`) all codes are that of `top`
    const uint32_t *table;
    const glint_tone_fit *fit; ///< NULL: use only the table. The pixel values are the same with either
    uint8_t *codes; ///< out: red, green, blue of the first lane of group 0
    size_t stride; ///< bytes from a row of pixels to the next. Only bytes of active lanes are written
    uint64_t *clipped, *nonfinite; ///< added to: active lanes with a channel > white; with one of beauty that
        ///< is not finite
} glint_tone_args;
// The arithmetic: ref/ref.c. Clipped where gain times beauty, in float, is above `white`; NaN counts as 0.

// ---- elementary functions, elementary.h and ref.c ----
// log2 of 2^-126 .. 1, result float; exp2 of -126 .. 0, float: by polynomials in one written order, whose coefficients stand in
// coefficients.h.

#endif
