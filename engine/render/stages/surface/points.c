// Points, normals and materials of hits.
#include "engine/render/stages/surface/surface.h"

KERNEL(surface, glint_surface_args)
