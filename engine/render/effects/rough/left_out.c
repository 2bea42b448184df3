#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(rough, "rough", "material.roughness", "rays of rough surfaces", plan->rough_samples > 0)
