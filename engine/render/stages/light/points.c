// Computes the light that reaches points, before shadows.
#include "engine/render/stages/light/light.h"
#include "engine/render/stages/light/lit_surface.h"

KERNEL(light, glint_light_args)

void GLINT_ENTRY(R(lit_surface))(const glint_surface_args *surface, const glint_light_args *light)
{
    R(lit_surface)(surface, light);
}
