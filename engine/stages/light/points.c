// The light that reaches points, shadows aside.
#include "engine/stages/simd/isa.h"

KERNEL(light, glint_light_args)

void GLINT_ENTRY(R(lit_surface))(const glint_surface_args *surface, const glint_light_args *light)
{
    R(lit_surface)(surface, light);
}
