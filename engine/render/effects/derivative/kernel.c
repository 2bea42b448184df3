// Kernels that compute how fast hits, light and colours change.
#include "engine/render/effects/derivative/kernel_bend.h"
#include "engine/render/effects/derivative/kernel_light.h"

#if GLINT_WITH(DERIVATIVE)
KERNEL(eyes, glint_eyes_args)
KERNEL(bend, glint_bend_args)
KERNEL(slope, glint_slope_args)
KERNEL(arrival, glint_arrival_args)
#endif
