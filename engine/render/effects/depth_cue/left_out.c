#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(depth_cue, "depth_cue", "scene.depth_cue", "light that fades with the distance",
               from->scene->desc.has_depth_cue || plan->eye_medium.on)
