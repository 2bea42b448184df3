#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(indirect, "indirect", "scene", "indirect light and ambient occlusion", glint_plan_has_indirect(&from->scene->desc))
