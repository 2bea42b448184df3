/// What the parts of plan/derivative*.c share: the slopes of a scene. Internal to them.
#ifndef GLINT_DERIVATIVE_SLOPES_H
#define GLINT_DERIVATIVE_SLOPES_H

#include "engine/plan/plan.h"

/// The slopes of a derivative, in the descriptions' own form: a number is how fast that of the description changes.
typedef struct glint_scene_slopes {
    glint_material_desc *materials; ///< in the geometry's order
    glint_light_desc *lights; ///< in the scene's
    glint_shape_desc *shapes; ///< of the geometry's parts
    glint_camera_desc camera;
    glint_scene_desc scene;
    glint_derivative_programs *programs; ///< as glint_plan_derivative has them
} glint_scene_slopes;

/// effects/derivative/fields.c: adds one slope to those of its object's description; fails where no derivative goes through the field.
glint_status glint_derivative_add(const glint_plan *plan, const glint_scene *scene, const glint_derivative *d,
                                  const glint_slope *s, glint_scene_slopes *out, glint_error *error);

/// effects/derivative/view.c: of the eye, by slopes of its camera; `out` is 0 before.
void glint_derivative_fill_view(glint_derivative_view *out, const glint_plan *plan, const glint_camera_desc *desc,
                                const glint_camera_desc *slope);

/// effects/derivative/plan_shaders.c: how fast shaders change with what derivatives change of what they read.
glint_status glint_derivative_find_gradients(glint_plan *plan, glint_error *error);

static inline void duals(glint_dual out[3], const double value[3], const double slope[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = dual(value[c], slope[c]);
}

static inline bool glint_any_slope(const double v[3]) { return v[0] != 0 || v[1] != 0 || v[2] != 0; }

static inline bool glint_has_slope(const glint_dual *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (list[i].slope != 0)
            return true;
    return false;
}

#endif
