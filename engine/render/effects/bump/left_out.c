#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(bump, "bump", "material.bump", "bumps", glint_plan_bumps(plan))
