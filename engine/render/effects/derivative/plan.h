/// The input of a frame's derivatives: materials and lights as dual numbers. Internal.
#ifndef GLINT_DERIVATIVE_H
#define GLINT_DERIVATIVE_H

#include "engine/base/dual.h"
#include "engine/base/hash.h"
#include "engine/glint_programs.h"
#include "engine/render/pattern/plan.h"
#include "engine/render/program/program.h"
#include "engine/render/stages/stages.h"

struct glint_plan;
struct glint_plan_input;

/// Slopes of a material's mirror, transmission, absorption and translucency.
typedef struct glint_derivative_bounce {
    double mirror[3], transmission[3], absorption[3], ior; ///< 0 for numbers that are not read
    double clear; ///< slope of the share that goes straight on
} glint_derivative_bounce;

/// Derivatives of a material's programs; owned references.
typedef struct glint_derivative_programs {
    const glint_program *of[GLINT_FIELD_COUNT]; ///< NULL: the field does not change
} glint_derivative_programs;

typedef struct glint_plan_derivative {
    char name[GLINT_DERIVATIVE_NAME_SIZE];
    glint_derivative_programs *programs; ///< one for each material of the plan
    glint_derivative_material *materials; ///< one for each material of the plan
    glint_derivative_bounce *bounces; ///< one for each material of the plan
    glint_derivative_light *lights; ///< in the scene's order
    glint_derivative_part *parts; ///< one for each part of the geometry
    glint_derivative_view view;
    struct {
        double color[3], near, far; ///< slopes of the fields of the same names in glint_plan
    } fade; ///< slopes of a depth cue
    double background[3]; ///< slopes
    bool moves; ///< some shadow moves
    bool bends; ///< some surface moves, or the eye, or an index of refraction turns rays
    bool weighs; ///< some mirror, transmission or absorption changes
    bool fades; ///< the depth cue changes
    bool everywhere; ///< light without a lamp has a slope
    bool repaints; ///< some program changes
} glint_plan_derivative;

typedef struct glint_plan_derivatives {
    size_t count, light_count, material_count;
    bool moves, bends, weighs, fades, everywhere, repaints;
    glint_plan_derivative of[GLINT_DERIVATIVES_MAX];
    glint_gradient *gradients; ///< gradients of shaders, one for each material of the plan; NULL: no shaders
    glint_plan_derivative level[GLINT_DERIVATIVES_MAX]; ///< the same with all zero slopes replaced by 1: shows what
        ///< depends on the parameter
} glint_plan_derivatives;

glint_status glint_derivative_prepare(struct glint_plan *plan, const struct glint_plan_input *from, glint_error *error);
glint_status glint_derivative_check(const struct glint_plan *plan, const glint_scene *scene, glint_error *error);
void glint_derivative_release(struct glint_plan *plan);
/// Continues a key with everything that a pass, of the frame's derivatives, reads in addition to the frame.
glint_key glint_derivative_key(const struct glint_plan *plan, int pass, glint_key key);

#endif
