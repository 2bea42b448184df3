/// The curves of a chart, shared by the copies of its overlay. Internal.
#ifndef GLINT_OVERLAY_CURVES_H
#define GLINT_OVERLAY_CURVES_H

#include "engine/base/hash.h"
#include "engine/glint_types.h"
#include "engine/glint_figures.h"

/// Extends a key by all curves.
glint_key glint_chart_key(const glint_chart *chart, glint_key key);

#endif
