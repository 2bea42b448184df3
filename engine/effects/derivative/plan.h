/// What derivatives of a frame read: materials and lights as dual numbers. Internal.
#ifndef GLINT_DERIVATIVE_H
#define GLINT_DERIVATIVE_H

#include "engine/base/dual.h"
#include "engine/base/hash.h"
#include "engine/effects/pattern/plan.h"
#include "engine/program/program.h"
#include "engine/stages/stages.h"

/// What a material sends on; slopes.
typedef struct glint_derivative_bounce {
    double mirror[3], transmission[3], absorption[3], ior; ///< of a number that nothing reads 0
} glint_derivative_bounce;

/// How fast programs of a material change; owned references.
typedef struct glint_derivative_programs {
    const glint_program *of[GLINT_FIELD_COUNT]; ///< NULL: not at all
} glint_derivative_programs;

typedef struct glint_plan_derivative {
    char name[GLINT_DERIVATIVE_NAME_SIZE];
    glint_derivative_programs *programs; ///< beside the plan's materials
    glint_derivative_material *materials; ///< beside the plan's
    glint_derivative_bounce *bounces; ///< likewise
    glint_derivative_light *lights; ///< in the scene's order
    glint_derivative_part *parts; ///< beside the geometry's
    glint_derivative_view view;
    struct {
        double color[3], near, far; ///< as in glint_plan
    } fade; ///< slopes of a depth cue
    double background[3]; ///< slopes
    bool moves; ///< some shadow does
    bool bends; ///< some surface moves, or the eye, or an index of refraction turns rays
    bool weighs; ///< some material sends on or absorbs another share
    bool fades; ///< the depth cue changes
    bool everywhere; ///< something has a slope that no light brings
    bool repaints; ///< some program changes
} glint_plan_derivative;

typedef struct glint_plan_derivatives {
    size_t count, light_count, material_count;
    bool moves, bends, weighs, fades, everywhere, repaints;
    glint_plan_derivative of[GLINT_DERIVATIVES_MAX];
    glint_gradient *gradients; ///< of materials' shaders, beside the plan's materials; NULL: none has one
    glint_plan_derivative level[GLINT_DERIVATIVES_MAX]; ///< of each, as if slopes that are 0 were not: tells what depends on it
} glint_plan_derivatives;

void glint_plan_derivatives_free(glint_plan_derivatives *derivatives); ///< NULL: nothing

#endif
