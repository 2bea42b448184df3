// The eye's hits on triangles, by scan conversion.
#include "engine/stages/cast/raster.h"

#if GLINT_WITH_RASTER
KERNEL(raster, glint_raster_args)
#endif
