/// Which primitives a tile's rays may meet. Conservative: what is left out, no ray of the tile could have met, so a
/// list's length never shows in the picture. Internal.
#ifndef GLINT_CULL_H
#define GLINT_CULL_H

#include "engine/plan.h"

/// Pixels [x0, x1) x [y0, y1) of the image, any sample of them. `out` has room for every primitive.
uint32_t glint_cull_primary(const glint_plan *plan, const double x[2], const double y[2], uint32_t *out);

/// Occluders between the light and a box of points.
uint32_t glint_cull_shadow(const glint_plan *plan, const glint_plan_light *light, const double lower[3],
                           const double upper[3], uint32_t *out);

#endif
