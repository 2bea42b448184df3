#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(light_groups, "light_groups", "light_passes", "light passes", plan->desc.light_passes)

const char *glint_plan_light_pass(const glint_plan *plan, size_t index)
{
    (void)plan, (void)index;
    return NULL;
}
