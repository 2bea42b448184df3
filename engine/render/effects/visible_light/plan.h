/// The lights that the camera sees. Internal.
#ifndef GLINT_VISIBLE_LIGHT_PLAN_H
#define GLINT_VISIBLE_LIGHT_PLAN_H

#include "engine/render/plan/plan.h"

/// An edge of a polygon: its first corner, and the unit vector perpendicular to it.
typedef struct glint_plan_edge {
    double corner[3], inwards[3];
} glint_plan_edge;

/// The surface of a visible light.
typedef struct glint_plan_visible_light {
    bool ball; ///< otherwise flat
    bool one_sided; ///< flat light: shines only to the side of its normal
    double center[3], radius; ///< bounding ball; for a disk or sphere, its centre and radius
    double normal[3]; ///< flat: unit
    const glint_plan_edge *edges; ///< polygon
    size_t edge_count; ///< 0: a disk
    double shown[3]; ///< brightness: pi times its radiance, like all light in the film
    uint32_t source, group; ///< as in glint_plan_light
} glint_plan_visible_light;

/// The visible lights of a frame.
typedef struct glint_visible_lights {
    uint32_t count;
    glint_plan_visible_light of[];
} glint_visible_lights;

static inline const glint_visible_lights *glint_visible_lights_of(const glint_plan *plan)
{
    static const glint_visible_lights none = { 0 };
    return plan->own[GLINT_STAGE_VISIBLE_LIGHT] ? plan->own[GLINT_STAGE_VISIBLE_LIGHT] : &none;
}

glint_status glint_visible_lights_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error);

#endif
