/// The slopes of a scene, shared by the files of this folder. Internal.
#ifndef GLINT_DERIVATIVE_SLOPES_H
#define GLINT_DERIVATIVE_SLOPES_H

#include "engine/render/plan/plan.h"

/// The slopes of a derivative in the form of descriptions: each number is the derivative of the description's number.
typedef struct glint_scene_slopes {
    glint_material_desc *materials; ///< slopes of the materials, in the order of the geometry
    glint_light_desc *lights; ///< slopes of the lights, in the order of the scene
    glint_shape_desc *shapes; ///< slopes of the shapes, one for each part of the geometry
    glint_camera_desc camera;
    glint_scene_desc scene;
    glint_derivative_programs *programs; ///< derivatives of programs, as in glint_plan_derivative
} glint_scene_slopes;

/// effects/derivative/fields.c: adds one slope to the description of its object; fails if the field has no derivative.
glint_status glint_derivative_add(const glint_plan *plan, const glint_scene *scene, const glint_derivative *d,
                                  const glint_slope *s, glint_scene_slopes *out, glint_error *error);

/// effects/derivative/plan_translucent.c: multiplies the slopes of translucent materials out, see
/// glint_plan_material. Fails if such a material has no derivative.
glint_status glint_derivative_weigh(const glint_plan *plan, const glint_derivative *d, glint_scene_slopes *slopes,
                                    glint_error *error);

/// effects/derivative/view.c: computes the slopes of the view from those of the camera; `out` must be zeroed.
void glint_derivative_fill_view(glint_derivative_view *out, const glint_plan *plan, const glint_camera_desc *desc,
                                const glint_camera_desc *slope);

/// effects/derivative/plan_shaders.c: makes the gradients of shaders for the inputs that derivatives change.
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
