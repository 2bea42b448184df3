/// The background program at given directions. Internal.
#ifndef GLINT_ENVIRONMENT_DIRECTIONS_H
#define GLINT_ENVIRONMENT_DIRECTIONS_H

#include "engine/render/effects/environment/plan.h"
#include "engine/render/stages/stages.h"

struct glint_environment;

/// Creates the memory for running the plan's background program. NULL: out of memory.
void *glint_environment_create(const glint_plan *plan);
void glint_environment_destroy(void *memory);

/// Computes the brightness of the background, the sum of the program's channels, for groups of directions of any
/// length. Refused light counts as by rays: at least 0, NaN is 0.
/// pixel   the angle that a texture is filtered over
/// groups  at most GLINT_PROGRAM_GROUPS
void glint_environment_evaluate(struct glint_environment *environment, const glint_plan_environment *own,
                                const glint_stages *stages, double pixel, double (*d)[3][GLINT_GROUP], uint32_t groups,
                                double *brightness);

#endif
