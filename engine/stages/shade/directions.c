// Microfacets, and the directions of continued rays.
#include "engine/stages/shade/bounce.h"
#include "engine/stages/shade/microfacets.h"
#include "engine/stages/shade/scatter.h"
#include "engine/stages/shade/spread.h"

#if GLINT_WITH_FACET
KERNEL(view, glint_view_args)
KERNEL(facet, glint_facet_args)
#endif
#if GLINT_WITH_BOUNCE
KERNEL(bounce, glint_bounce_args)
#endif
#if GLINT_WITH_INDIRECT
KERNEL(scatter, glint_scatter_args)
KERNEL(spread, glint_spread_args)
#endif
