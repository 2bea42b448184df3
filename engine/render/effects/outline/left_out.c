#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(outline, "outline", "outline", "outlines", plan->desc.passes >> GLINT_PASS_OUTLINE & 1)
