#include "engine/render/effects/bounce/plan.h"
#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(bounce, "bounce", "material", "mirrors and transparent materials", glint_bounce_is_needed(plan))
