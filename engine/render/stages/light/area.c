// The light from an area light, with its shadows.
#include "engine/render/stages/light/soft_light.h"

#if GLINT_WITH(AREA) && GLINT_WITH(SHADOW)
bool GLINT_ENTRY(R(soft_light))(const glint_soft_args *args)
{
    return R(soft_light)(args);
}
#endif
