// Computes the points that a light reaches, and the light from an area light with its shadows.
#include "engine/render/stages/light/soft_light.h"
#include "engine/render/stages/light/soft_shadow.h"

#if GLINT_WITH(SHADOW)
KERNEL(occlude, glint_occlude_args)
#if GLINT_WITH(AREA)
bool GLINT_ENTRY(R(soft_light))(const glint_soft_args *args)
{
    return R(soft_light)(args);
}
#endif
#endif
