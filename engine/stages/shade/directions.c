// The directions of continued rays.
#include "engine/stages/shade/scatter.h"
#include "engine/stages/shade/spread.h"

#if GLINT_WITH_INDIRECT
KERNEL(scatter, glint_scatter_args)
KERNEL(spread, glint_spread_args)
#endif
