/// A build without light passes.
#include "engine/effects/left_out.h"

GLINT_LEFT_OUT(light_groups, "light_groups", "light_passes", "light passes", plan->light_groups)
