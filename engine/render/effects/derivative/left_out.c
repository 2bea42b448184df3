#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(derivative, "derivative", "derivatives", "derivatives", from->desc->derivative_count > 0)
