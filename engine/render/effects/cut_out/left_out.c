#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(cut_out, "cut_out", "material.opacity", "cut-outs", glint_plan_cuts(plan))
