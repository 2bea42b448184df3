#include "engine/render/effects/left_out.h"

GLINT_LEFT_OUT(microfacet_view, "microfacet", "material.model", "microfacets", plan->facets)
GLINT_LEFT_OUT(microfacet, "microfacet", "material.model", "microfacets", plan->facets)
