// Points, normals and materials of hits.
#include "engine/stages/surface/surface.h"

KERNEL(surface, glint_surface_args)
