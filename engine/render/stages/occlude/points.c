// Computes the points that a light reaches.
#include "engine/render/stages/light/soft_shadow.h"

#if GLINT_WITH(SHADOW)
KERNEL(occlude, glint_occlude_args)
#endif
