#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(transparent_shadow, "transparent_shadow", "material", "light through transparent objects",
               (plan->transmits || plan->clears) && plan->shadow_count > 0)
