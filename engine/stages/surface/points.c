// Points, normals and materials of hits.
#include "engine/stages/surface/surface.h"
#include "engine/stages/surface/vertex.h"

KERNEL(surface, glint_surface_args)
#if GLINT_WITH_VERTEX
KERNEL(vertex, glint_vertex_args)
#endif
