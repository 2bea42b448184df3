/// The contract of the stages from there to the picture: vertex, bounce, scatter, shade, resolve, tone. Begin with stages.h.
#ifndef GLINT_CONTRACT_FILM_H
#define GLINT_CONTRACT_FILM_H

#include "engine/stages/contract/light.h"

// ---- vertex: light that was worked out once for a face or a vertex ----

/// What all lights together add to the two terms at a site.
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
// w_j as in surface, x_j the light of the triangle's sites on the lane's side:
// sum += at[0] = at[1] = at[2] ? x_0 : (w_0 x_0 + w_1 x_1) + w_2 x_2                                          in double

// caps: the share left is 1, times that of each primitive, in the table's order; s of the light, a of a sphere:
//         l = (position - point) scale, r = radius scale, d = sqrt(length2(l)); where not r < d: 1
//         power_s = (d - r)(d + r); full = sqrt(max(power, 0)) / d, cosine = sqrt(0.5 + 0.5 full), sine = min(r / d, 1) / (2 cosine):
//         of half the angle that the light is seen at; of a sphere likewise, of -f, radius scale_of_prim and power_a = c = exact_c(f)
//         sphere: its own, seen from outside: 1; its own or c < 0: within; (c m) m < power_s, m = scale / scale_of_prim: 1 - part,
//                 else 1: of two balls that do not meet, the one with the shorter tangent is before the other
//         plane: its own: 1; h = dot(normal, point - center): h > 0: within, h < 0: behind, else 1
//         within, behind = min(max((r +- depth) / (2 r), 0), 1) in double and world units, depth = dot(normal, position - center),
//                 of a sphere radius - length(position - center)
// part:   of one cap in another, G. Oat and P. Sander, "Ambient aperture lighting", I3D 2007, here by halves of all angles
//         (so that caps of 1e-8 keep their digits): u, v = l / d, -f / |f|; sg, cg = 0.5 length(u - v), 0.5 length(u + v)
//         x0, x1, x2, x3 = sines of half of s + a + g, a + g - s, s + g - a, s + a - g, by way of a + g and g - a
//         x3 <= 0: 0; else x2 <= 0: 1; else x1 <= 0: min((sa / ss)^2, 1); else by Gauss and Bonnet, sectors less triangles:
//         B = 2 angle(sqrt(x1 x3), sqrt(x0 x2)), A = 2 angle(sqrt(x2 x3), sqrt(x0 x1)): the triangle's angles at s and a
//         E = 2 angle(k sin C, 1 + k cos C), its excess, k = (ss / cs) (sa / ca), C its angle where the edges cross:
//                 sin C = 2 sqrt(x0 x3) sqrt(x1 x2) / e, cos C = (x0 x3 - x1 x2) / e, e = x0 x3 + x1 x2
//         min(max((B + (A (2 sa^2) - E) / ss / (2 ss)) / pi, 0), 1)
// angle(y, x): t = y / (sqrt(x x + y y) + x); twice t = t / (1 + sqrt(1 + t t)); 8 t (1 - t^2/3 + ... - t^22/23)

// ---- bounce: where rays go on from a surface ----

typedef struct glint_bounce_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< a bit a lane
    const glint_camera_args *camera; ///< the rays, of a perspective camera; NULL: their directions are in direction
    const void *direction[3], *normal[3]; ///< real; the normal as surface gives it
    const void *ratio; ///< real, > 0: refractive index on the ray's side of the surface over that beyond it
    void *reflected[3], *refracted[3]; ///< out, real, unit but for rounding
    void *reflectance; ///< out, real: of a dielectric and unpolarised light, 0 .. 1
    uint16_t *total; ///< out: of the wanted lanes, those of total internal reflection, whose `refracted` means nothing
} glint_bounce_args;
// Written where wanted. Groups without a wanted lane get total = 0 and nothing else; other lanes hold anything.
// u = direction / sqrt(length2(direction)) (each component divided), c = min(max(-dot(normal, u), 0), 1), r = ratio
// reflected = u + (2 c) normal
// k = 1 - (r r) (1 - c c); s = r == 1 ? c : sqrt(max(k, 0));  total = r != 1 and not k > 0
// refracted = r u + (r c - s) normal                                                            (Snell)
// x = r c, y = r s, p = (x - s) / (x + s), q = (c - y) / (c + y)                                (Fresnel)
// reflectance = r == 1 ? 0 : total ? 1 : 0.5 (p p + q q)

// ---- scatter: directions around normals, as dense as their cosine ----

typedef struct glint_scatter_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< a bit a lane
    const void *normal[3]; ///< real, unit
    const double
        *square[2]; ///< u and v in 0 .. 1: equal areas of the unit square get equal shares of an even sky's light
    void *direction[3]; ///< out, real, unit but for rounding and 2e-9
} glint_scatter_args;
// Groups without a wanted lane are not written; in others, lanes that are not wanted hold anything.
// u and v are first rounded to real; a = 4 v, q = a rounded to a whole number: (a + w) - w with w = 1.5 2^52 (float: 2^23)
// f = (a - q) (pi/2), z = f f;  s = f + (f z) (S1 + z (S2 + z (S3 + z S4))),  c = 1 + z (C1 + z (C2 + z (C3 + z (C4 + z C5))))
// (sin, cos) = q = 1: (c, 0 - s); q = 2: (0 - s, 0 - c); q = 3: (0 - c, s); otherwise (s, c)
// x = sqrt(u) cos, y = sqrt(u) sin, h = sqrt(max(1 - u, 0))                             (the disk, lifted: cosine-weighted)
// g = n.z >= 0 ? 1 : -1, p = -1 / (g + n.z), q = (n.x n.y) p              (T. Duff et al., JCGT 6(1), 2017: an orthonormal basis)
// tangent = (1 + g ((n.x n.x) p), g q, 0 - g n.x), bitangent = (q, g + (n.y n.y) p, 0 - n.y)
// direction = (x tangent + y bitangent) + h n
// The coefficients stand in coefficients.h.

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
// What a light adds to a term is float; terms are added up in double:
//   background += background where active and not hit; ambient += materials[m].ambient where hit
//   for each light (with those joined to it) that has its lit bit set, in order:
//     w = attenuation (NULL: 1); all of this in float:
//     diffuse[c]  += (w cosine) (kd[c] diffuse[c]), the product p of the colours made in double: p < FLT_MAX ? (float)p : FLT_MAX
//     where the material has a highlight, highlights is true and log2_specular > GLINT_NO_SPECULAR:
//     y = shininess log2_specular, S = y < -40 ? 0 : exp2(y)
//     specular[c] += (w S) (ks[c] specular[c])
//     GLINT_LOBE_POWER_COSINE: S = S cosine
//     where the material is of GLINT_HIGHLIGHT_FACETS, highlights is true and sine2 > GLINT_NO_SPECULAR:
//     a = alpha, aa = a a, l = cosine, v = facing
//     GGX        t = sine2 + aa (1 - sine2), u = a / t, b = 1 - aa, d = l sqrt(aa + b (v v)) + v sqrt(aa + b (l l))
//                S = (u u) ((0.5 l) / max(d, FLT_MIN))
//     Beckmann   c = max(1 - sine2, 2^-40), y = -((sine2 / c) (1.442695 / aa)), e = y < -126 ? 0 : exp2(y)
//                d = (l v + v mask(l)) + l mask(v)
//                S = (((e / c) / c) (1 / aa)) ((0.25 l) / max(d, FLT_MIN))
//                mask(x): s = a sqrt(max(1 - x x, 0)), q = x / s, q < 1.6: (s ((0.396 q - 1.259) q + 1)) / (2.181 q + 3.535),
//                otherwise 0
//     S = min(S, GLINT_ATTENUATION_MAX), f = min(w S, GLINT_ATTENUATION_MAX)
//     specular[c] += f (ks[c] specular[c]) + (f schlick) (grazing[c] specular[c])
//     Of a material with planes: shininess and alpha are those of the lane; the products of colours are plane (kd[c] diffuse[c])
//     with kd[c] of the table, likewise specular and grazing; ambient += plane ambient_light[c]; all in double
//     joined lights: w cosine and w S (f and f schlick) are added up first, in order, in float from 0, over those with the lit bit set
// Where a sum is NULL the totals start at 0 and each is rounded to float: film, and
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
// beauty, which groups without an active lane leave as they are, in common; `sum` is not read.

// ---- tone: 8-bit codes, written into the image ----

/// Any rising map of 0 .. top to 0 .. 255 whose steps are further apart than the buckets. A bucket holds the floats
/// that agree in their upper 16 bits; its entry is code | threshold << 8: the code of its first float, and from which
/// of the lower 16 bits on the code is one more (65536: never). The last entry is top's.
#define GLINT_TONE_FIRST 0x3800u ///< upper bits of 2^-15; floats below have code 0

/// What spares most look-ups: an estimate of the code with a fraction, and how far it is to be trusted.
typedef struct glint_tone_fit {
    float knee, slope, base; ///< x < knee: v = slope x + base
    float scale[16], power[6], offset; ///< others: v = scale[e & 15] P(m) + offset; x = m 2^(e - 127), m in [1, 2),
        ///< P(m) = power[0] + power[1] m + ... + power[5] m^5
    uint32_t doubt; ///< v is in [256, 512), so that its lower 15 bits are the fraction. Where they are >= doubt, the
        ///< 8 bits above them are the table's code, however the estimate is rounded, with or without FMA
} glint_tone_fit;

typedef struct glint_tone_args {
    uint32_t group_count, groups_across; ///< as in glint_camera_args; group_count is a multiple of groups_across
    const uint16_t *active; ///< a bit a lane: pixels inside the image
    const float *beauty[3];
    float gain; ///< > 0: what light is multiplied by
    float white, top; ///< light above `white` is clipped; above `top` (at most `white`) all codes are that of `top`
    const uint32_t *table;
    const glint_tone_fit *fit; ///< NULL: the table alone. The codes are the same with either
    uint8_t *codes; ///< out: red, green, blue of the first lane of group 0
    size_t stride; ///< bytes from a row of pixels to the next. No byte but those of active lanes is written
    uint64_t *clipped, *nonfinite; ///< added to: active lanes with a channel > white; with one of beauty that
        ///< is not finite
} glint_tone_args;
// x = gain beauty in float; clipped where x > white; x = max(x, 0) (NaN gives 0), x = min(x, top); bits of x below GLINT_TONE_FIRST << 16: code 0;
// else entry = table[(bits >> 16) - GLINT_TONE_FIRST], code = (entry & 255) + ((bits & 0xffff) >= entry >> 8)

// ---- elementary functions, elementary.h and ref.c ----
// log2(x), 2^-126 <= x <= 1, real; result float: y = (float)x
//   y >= GLINT_SQRT1_2: e = 0, f = (float)(x - 1), the difference in real
//   else y = m 2^e with m in [1, 2); m >= GLINT_SQRT2: m = 0.5 m, e = e + 1; f = m - 1 (exact)
//   (both constants rounded to float)
//   p = C9; p = p f + C8 ... p = p f + C0; log2 = (float)e + f p
// exp2(y), float, -126 <= y <= 0: n = (y + 12582912) - 12582912, f = y - n,
//   p = D6; p = p f + D5 ... p = p f + D0; exp2 = p 2^n
// The coefficients stand in coefficients.h.

#endif
