// The points, normals and materials of hits, and the light that reaches them, before shadows.
#include "engine/render/stages/light/light.h"
#include "engine/render/stages/light/lit_surface.h"
#include "engine/render/stages/surface/surface.h"

KERNEL(surface, glint_surface_args)
KERNEL(light, glint_light_args)

void GLINT_ENTRY(R(lit_surface))(const glint_surface_args *surface, const glint_light_args *light)
{
    R(lit_surface)(surface, light);
}
