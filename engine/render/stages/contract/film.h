/// The contract of the stages that follow the lights, up to the picture: shade, resolve, tone. Begin with
/// stages.h.
#ifndef GLINT_CONTRACT_FILM_H
#define GLINT_CONTRACT_FILM_H

#include "engine/render/stages/contract/light.h"

#define GLINT_WEIGHT_MAX 1e150 ///< of a ray: products with a surface's light are finite below it

// ---- shade: the terms of each sample ----

typedef enum glint_term {
    GLINT_TERM_BACKGROUND,
    GLINT_TERM_AMBIENT,
    GLINT_TERM_DIFFUSE,
    GLINT_TERM_SPECULAR,
    GLINT_TERM_INDIRECT, ///< light from other surfaces and the background
    GLINT_TERM_MIRROR, ///< light reflected by mirrors
    GLINT_TERM_TRANSMISSION, ///< light through transparent surfaces
    GLINT_TERM_COUNT
} glint_term;
#define GLINT_TERM_LOCAL GLINT_TERM_INDIRECT ///< number of terms that shade computes

typedef struct glint_shade_light {
    bool joined; ///< this is another sample of the previous element's light in this call, with the same colours
    const uint16_t *lit; ///< bit mask of the lanes that the light reaches: `lit` of the light stage, or `unoccluded`
        ///< if the light casts shadows
    const float *cosine, *attenuation, *log2_specular; ///< attenuation NULL: 1 everywhere
    const float *sine2, *schlick; ///< only read for materials of GLINT_HIGHLIGHT_FACETS
    bool
        summed; ///< the sums over all samples of a light, as soft_light computes them: `cosine` is the diffuse sum,
    ///< `highlight` the specular sum, and no other factors are read. No light is joined to a summed one, and no
    ///< material has microfacets
    const float *highlight;
    double diffuse[3], specular[3]; ///< the light's colour times its intensity
} glint_shade_light;

/// Material fields that differ between samples. They are read in the lanes whose material has the matching bit in
/// `planes`, and are finite and >= 0 there. NULL: no material has that field in a plane.
typedef struct glint_shade_planes {
    const float *diffuse[3], *ambient[3], *specular[3];
    const float *shininess, *alpha;
    double ambient_light[3]; ///< factor of the planes of ambient reflectances
    const float *shaded[2][3]; ///< diffuse and specular terms for materials of GLINT_PLANE_SHADED: read in lanes that
    ///< a light reaches; in the other lanes the terms are 0; NULL: 0. Not read if `sum` is set
} glint_shade_planes;

typedef struct glint_shade_args {
    uint32_t group_count;
    const uint16_t *active, *hits;
    const uint32_t *material;
    const uint32_t *only; ///< the material that all hits share; NULL: unknown
    const glint_shade_material *materials;
    const glint_shade_planes *planes; ///< NULL: no material has planes
    double background[3];
    const float *facing; ///< only read for materials of GLINT_HIGHLIGHT_FACETS
    bool highlights; ///< false: the specular term is not computed
    bool first; ///< true: this call also computes the terms that need no light: background and ambient
    const glint_shade_light *lights;
    uint32_t light_count; ///< at most GLINT_LIGHT_CHUNK
    double *sum
        [GLINT_TERM_COUNT]
        [3]; ///< in and out: the terms are added (specular only if `highlights` is set); NULL: the frame has one
            ///< sample, and this call has all lights
    float *film[GLINT_TERM_COUNT][3]; ///< out, if sum is NULL: the terms; NULL: not needed
    float *beauty[3]; ///< out, if sum is NULL
} glint_shade_args;
// A light's contribution to a term is float; terms are added up in double, in this order: background where active and
// not hit, ambient where hit, then each light. The arithmetic: ref/shade.h. GGX and Beckmann use Smith's masking, for
// Beckmann in the form of B. Walter et al., EGSR 2007. The samples of joined lights are added up first, in order, in
// float from 0. Products of colours and plane values are computed in double. A highlight is 0 below 2^-40. No light
// is read for materials of GLINT_PLANE_SHADED. If sum is NULL, the totals start at 0. Each total is rounded to float
// and stored in film, and beauty = ((background + ambient) + diffuse) + specular in float.

// ---- resolve: the mean of several samples ----

typedef struct glint_resolve_args {
    uint32_t group_count;
    double samples;
    double *sum[GLINT_TERM_COUNT][3]; ///< sums of the terms that shade does not compute; NULL: the frame does not
        ///< have this term
    float *film[GLINT_TERM_COUNT][3]; ///< out, or NULL
    float *beauty[3]; ///< out
} glint_resolve_args;
// Each term is (float)(sum / samples). beauty is computed as in shade, and then is ((beauty + indirect) + mirror) +
// transmission, with the terms that the frame has.

// resolve_samples: does the same as shade for each of `count` samples in turn, with sums that begin at 0, followed by
// resolve. `first` is set in all samples, which have at most GLINT_LIGHT_CHUNK lights in total. They share groups,
// active, background, highlights, film and beauty. Groups without an active lane leave film and beauty unchanged.
// `sum` is not read, and no material is of GLINT_PLANE_SHADED.

// ---- tone: 8-bit pixel values, written into the image ----

typedef struct glint_tone_args {
    uint32_t group_count, groups_across; ///< as in glint_camera_args; group_count is a multiple of groups_across
    const uint16_t *active; ///< one bit per lane: pixels inside the image whose values are wanted
    const float *beauty[3];
    float gain; ///< > 0: factor of the light
    float white, top; ///< light above `white` is clipped; light above `top` (at most `white`) gets the value of `top`
    const uint32_t *table;
    const glint_tone_fit *fit; ///< NULL: only the table is used, which gives the same pixel values
    uint8_t *codes; ///< out: red, green, blue of the first lane of group 0
    size_t stride; ///< bytes from one row of pixels to the next. Only bytes of active lanes are written
    uint64_t *clipped, *nonfinite; ///< in and out, increased by the numbers of active lanes with a channel above
        ///< `white`, and with a channel of beauty that is not finite
} glint_tone_args;
// The arithmetic: ref/ref.c. A lane is clipped if gain times beauty, in float, is above `white`; NaN counts as 0.

// ---- elementary functions, elementary.h and ref.c ----
//
// log2 of 2^-126 .. 1 and exp2 of -126 .. 0, both with float results: polynomials in one fixed order of operations,
// with the coefficients of coefficients.h.

#endif
