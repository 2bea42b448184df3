// What rays hit that have nothing in common.
#include "engine/stages/simd/isa.h"

KERNEL(cast_rays, glint_cast_args)
