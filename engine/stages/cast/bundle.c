// Camera rays, and what bundles of rays hit: rays of one eye, parallel ones, and those through a lens.
#include "engine/stages/simd/isa.h"

KERNEL(camera, glint_camera_args)
KERNEL(cast_bundle, glint_cast_args)

bool GLINT_ENTRY(R(in_sight))(const glint_cast_args *args)
{
    return R(in_sight)(args);
}
