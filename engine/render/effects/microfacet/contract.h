/// The contract of view and facet, which measure angles for materials of microfacets. Begin with stages.h.
#ifndef GLINT_CONTRACT_MICROFACET_H
#define GLINT_CONTRACT_MICROFACET_H

#include "engine/render/stages/contract/light.h"

// ---- view: the angle at which each point is seen, for materials of microfacets ----

typedef struct glint_view_args {
    uint32_t group_count;
    const uint16_t *hits;
    const glint_camera_args *camera; ///< as in glint_light_args
    const void *normal[3], *direction[3];
    float *facing; ///< out: n.v in 0 .. 1
} glint_view_args;
// Groups without a hit are not written. The arithmetic: ref.h.

// ---- facet: the position of a light's half vector, for materials with microfacets ----

typedef struct glint_facet_args {
    uint32_t group_count;
    const glint_camera_args *camera; ///< this field and the following ones are as in glint_light_args
    const void *point[3], *normal[3], *direction[3];
    const uint32_t *material;
    const glint_shade_material *materials;
    bool directional;
    double position[3];
    double scale;
    uint32_t sample_count;
    const glint_light_sample *light_sample[GLINT_LIGHT_CHUNK];
    const uint16_t *lit[GLINT_LIGHT_CHUNK]; ///< written by the stage light
    // out, for each sample:
    float *sine2[GLINT_LIGHT_CHUNK]; ///< squared sine between n and h; GLINT_NO_SPECULAR where unlit or h is undefined
    float *schlick[GLINT_LIGHT_CHUNK]; ///< (1 - v.h)^5; 0 where unlit or if h is undefined
} glint_facet_args;
// Only groups with a lit lane on a material of GLINT_HIGHLIGHT_FACETS are written, in every lane. The arithmetic:
// ref.h; Schlick's (v.h)^2 is computed from half of the angle between l and v, so that h need not be
// unit.

#endif
