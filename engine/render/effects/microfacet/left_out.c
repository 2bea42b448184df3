#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(view, "microfacet", "material.model", "microfacets", plan->facets)
GLINT_LEFT_OUT(facet, "microfacet", "material.model", "microfacets", plan->facets)
