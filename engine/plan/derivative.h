/// What derivatives of a frame read: materials and lights as dual numbers. Internal.
#ifndef GLINT_DERIVATIVE_H
#define GLINT_DERIVATIVE_H

#include "engine/base/dual.h"
#include "engine/base/hash.h"
#include "engine/plan/patterns.h"
#include "engine/program/program.h"
#include "engine/stages/stages.h"

/// A material, as glint_shade_material has it.
typedef struct glint_derivative_material {
    uint32_t varies; ///< 0: nothing of it has a slope
    uint32_t highlight, lobe; ///< glint_highlight, glint_lobe; of a material without a highlight that gets one, too
    uint32_t unused; ///< 0: no padding
    glint_dual diffuse[3], specular[3], grazing[3], ambient[3], shininess, alpha;
} glint_derivative_material;

/// What a material sends on; slopes.
typedef struct glint_derivative_bounce {
    double mirror[3], transmission[3], absorption[3], ior; ///< of a number that nothing reads 0
} glint_derivative_bounce;

/// A light of the scene, or what its samples have in common.
typedef struct glint_derivative_light {
    uint32_t varies;
    uint32_t moves; ///< its shadows do
    uint32_t directional, is_spot;
    uint32_t attenuated; ///< by distance
    uint32_t unused; ///< 0: no padding
    glint_dual position[3]; ///< directional: the unit vector towards it; of an area light the slope is that of its samples
    glint_dual coefficients[3], diffuse[3], specular[3];
    glint_dual axis[3], outer, inverse, exponent; ///< of a spot, see glint_spot
} glint_derivative_light;

/// A surface that moves; slopes, in the world.
typedef struct glint_derivative_part {
    uint32_t moves;
    uint32_t unused; ///< 0: no padding
    double place[3]; ///< of a sphere's centre or a plane's point
    double growth; ///< of a sphere's radius, in shares of it
    double normal[3]; ///< of a plane's unit normal
    double pivot[3]; ///< around which a plane turns: no slope
} glint_derivative_part;

/// The eye and its lens; slopes.
typedef struct glint_derivative_view {
    uint32_t moves;
    uint32_t unused; ///< 0: no padding
    double eye[3], forward[3], right[3], up[3]; ///< as in glint_plan_camera
    double lens[2][3]; ///< of the unit axes of the lens, to the right and up; without a lens 0, and so the next
    double wider; ///< of the aperture, in shares of it
    double nearer; ///< of one over the distance of its focus
} glint_derivative_view;

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
