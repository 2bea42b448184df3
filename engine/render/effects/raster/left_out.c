#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(raster, "raster", "visibility", "scan conversion", plan->desc.visibility == GLINT_VISIBILITY_SCAN)
