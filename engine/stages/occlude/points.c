// The points that a light reaches.
#include "engine/stages/simd/isa.h"

#if GLINT_WITH_SHADOW
KERNEL(occlude, glint_occlude_args)
#endif
