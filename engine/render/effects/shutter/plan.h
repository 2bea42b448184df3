/// Frames with an open shutter. Internal.
#ifndef GLINT_SHUTTER_PLAN_H
#define GLINT_SHUTTER_PLAN_H

#include "engine/render/plan/plan.h"

/// Replaces a plan's lights by the lights of all times, each weighted by its share.
glint_status glint_shutter_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error);
void glint_shutter_release(glint_plan *plan);

#endif
