/// Backgrounds computed by programs. Internal.
#ifndef GLINT_ENVIRONMENT_PLAN_H
#define GLINT_ENVIRONMENT_PLAN_H

#include "engine/render/plan/plan.h"

/// A background computed by a program.
typedef struct glint_plan_environment {
    glint_program *program; ///< owned reference
    /// Maps p, a direction, to its position in a picture of all directions; NULL: `program` does not read it
    glint_program *uv;
    uint32_t row_count; ///< the largest number of rows that one of the two programs needs
    double pixel; ///< angle of a pixel, for filtering; 0: rays are parallel
    double most; ///< upper bound of the program's result
} glint_plan_environment;

glint_status glint_environment_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error);
void glint_environment_release(glint_plan *plan);
/// Sets plan->sky to a table of the background, for stages that sample it, unless the plan already has one. There is
/// none if the background is plain, or so even that its table would not reduce noise.
glint_status glint_sky_find(glint_plan *plan, glint_error *error);
void glint_sky_release(const struct glint_sky *sky);

#endif
