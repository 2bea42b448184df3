/// Indirect light and ambient occlusion in the plan. Internal.
#ifndef GLINT_INDIRECT_PLAN_H
#define GLINT_INDIRECT_PLAN_H

#include "engine/glint_types.h"

struct glint_plan;
struct glint_plan_input;

/// Indirect light; all 0: there is none.
typedef struct glint_plan_indirect {
    uint32_t samples, bounces;
    uint32_t *light_rows; ///< first row in plan->lights of each light, and one more entry for the end
    uint32_t light_count;
    double (*rest)[3]; ///< one per material: the ambient light that is added where paths end
    double least; ///< a path ends when its weight falls below this share of its weight at the start
    bool is_sky; ///< ambient occlusion: paths only test whether the sky is visible
    double distance; ///< ambient occlusion: distance within which surfaces block the sky; may be infinite
} glint_plan_indirect;

/// Subtracts the part of the materials' ambient light that indirect light replaces.
glint_status glint_indirect_prepare(struct glint_plan *plan, const struct glint_plan_input *from, glint_error *error);
/// Finds the samples of each light, for paths that take one of them; once.
glint_status glint_indirect_find_light_rows(struct glint_plan *plan, glint_error *error);

#endif
