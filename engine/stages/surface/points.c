// Points, normals and materials of hits.
#include "engine/stages/simd/isa.h"

KERNEL(surface, glint_surface_args)
#if GLINT_WITH_VERTEX
KERNEL(vertex, glint_vertex_args)
#endif
