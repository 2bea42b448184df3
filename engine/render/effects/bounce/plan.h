/// Rays that surfaces send on: reflected, refracted or straight through. Internal.
#ifndef GLINT_BOUNCE_PLAN_H
#define GLINT_BOUNCE_PLAN_H

#include "engine/render/plan/plan.h"

#define GLINT_BOUNCE_DEPTH 31 ///< largest max_depth if mirror + transmission of a material exceed 1
/// number of surfaces in a chain at which both the reflected and the refracted ray are followed
#define GLINT_BOUNCE_SPLITS 16
/// Limit, in linear light per sample, for the total of weak rays that are not followed
#define GLINT_BOUNCE_LOSS 0x1p-20

/// Mirror, transmission and absorption of a material.
typedef struct glint_bounce_material {
    double mirror[3], transmission[3], absorption[3], ior;
    double clear; ///< share of the light that goes straight on; 0 if a program computes it
    bool fresnel, mirrors, transmits; ///< in some channel
    bool clears; ///< whether the material is translucent
    bool rough; ///< whether the rays that it reflects and refracts are spread by microfacets; then also:
    double alpha; ///< width of their distribution
    bool beckmann; ///< the distribution; false: GGX
    bool facets; ///< whether highlights are of the same microfacets, so that reflected rays do not see lamps
    double specular[3]; ///< factor of `mirror`; 1 without `facets`
    bool schlick; ///< whether `mirror` is multiplied by Schlick's reflectance, from f0
    double f0[3];
} glint_bounce_material;

/// Returns whether a material sends on rays: reflected, refracted or straight through it.
static inline bool glint_sends_on(const glint_bounce_material *m) { return m->mirrors || m->transmits || m->clears; }
/// Returns whether it reflects or refracts rays in many directions.
static inline bool glint_is_spreading(const glint_bounce_material *m) { return (m->mirrors || m->transmits) && m->rough; }
/// Returns whether it sends on rays in the directions of the laws of reflection and refraction.
static inline bool glint_is_sharp(const glint_bounce_material *m) { return (m->mirrors || m->transmits) && !m->rough; }

/// Returns whether some material of the scene is a mirror, transparent or translucent.
static inline bool glint_bounce_is_needed(const glint_plan *plan)
{
    bool needed = plan->translucent;
    for (size_t i = 0; i < plan->geometry->materials.count; i++) {
        const glint_material_desc *desc = glint_plan_material(plan, i);
        needed = needed || glint_material_mirrors(desc) || glint_material_transmits(desc);
    }
    return needed;
}

/// Fills the materials that send on rays, and a bound of the light along a ray, for which the tables of indirect light
/// are read.
glint_status glint_bounce_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error);
/// Continues a key with max_depth and the materials that send on rays.
glint_key glint_bounce_key(const glint_plan *plan, glint_key key);
/// Continues a key with the transmission of a material.
static inline glint_key glint_transmission_key(const glint_bounce_material *m, glint_key key)
{
    GLINT_KEY_ADD(key, m->transmission);
    if (m->clear > 0)
        GLINT_KEY_ADD(key, m->clear);
    GLINT_KEY_ADD(key, m->absorption);
    return key;
}

#endif
