/// Tests whether a changed primitive may be visible in a tile, or lie between the tile's points and a light.
/// Internal.
///
/// Every answer is conservative: a ball reported outside is outside by more than the rounding of the kernels, of
/// these tests and of the balls themselves.
#ifndef GLINT_BETWEEN_H
#define GLINT_BETWEEN_H

#include "engine/render/plan/plan.h"

/// A ball around a changed primitive, either before or after the change.
typedef struct glint_ball {
    double center[3], radius;
} glint_ball;

/// Returns whether one of the balls may be visible in a tile.
bool glint_may_show(const glint_plan *plan, const glint_ball *balls, uint32_t count, uint32_t column, uint32_t row);

/// Returns whether one of the balls may lie between a light and the tile's points, which are in `box`.
bool glint_may_shade(const glint_plan *plan, const glint_plan_light *light, const glint_point_box *box,
                     const glint_ball *balls, uint32_t count, uint32_t column, uint32_t row);

#endif
