/// The plan's side of effects, in NAME/plan.c, for their declarations in other files of the folders: functions as
/// `prepare`, `check`, `release` and `pass_key` of glint_stage. Internal.
#ifndef GLINT_EFFECTS_PREPARE_H
#define GLINT_EFFECTS_PREPARE_H

#include "engine/plan/plan.h"

/// Materials that send rays on, and a bound of the light along a ray, for which the tables of indirect light are read.
glint_status glint_bounce_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error);
glint_status glint_derivative_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error);
glint_status glint_derivative_check(const glint_plan *plan, const glint_scene *scene, glint_error *error);
void glint_derivative_release(glint_plan *plan);
/// Continues a key with everything that a pass, of the frame's derivatives, reads in addition to the frame.
glint_key glint_derivative_key(const glint_plan *plan, int pass, glint_key key);
glint_status glint_environment_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error);
void glint_environment_release(glint_plan *plan);
/// Sets plan->sky to a table of the background, for stages that sample it, unless the plan already has one. There is
/// none if the background is plain, or so even that its table would not reduce noise.
glint_status glint_sky_find(glint_plan *plan, glint_error *error);
void glint_sky_release(const struct glint_sky *sky);
/// Subtracts the part of the materials' ambient light that indirect light replaces.
glint_status glint_indirect_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error);
/// Finds the samples of each light, for paths that take one of them; once.
glint_status glint_indirect_find_light_rows(glint_plan *plan, glint_error *error);
/// Replaces a plan's lights by the lights of all times, each weighted by its share.
glint_status glint_shutter_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error);
void glint_shutter_release(glint_plan *plan);
glint_status glint_visible_lights_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error);
void glint_visible_lights_release(glint_plan *plan);

#endif
