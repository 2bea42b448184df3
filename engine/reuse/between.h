/// Whether something that has changed may show in a tile, or lie between what the tile shows and a light. Internal.
///
/// Every answer is on the safe side: what is said to be outside is so by more than all rounding of the kernels, of these tests and
/// of the balls themselves.
#ifndef GLINT_BETWEEN_H
#define GLINT_BETWEEN_H

#include "engine/plan/plan.h"

/// Around a primitive that has changed, as it was or as it is.
typedef struct glint_ball {
    double center[3], radius;
} glint_ball;

/// Whether one of the balls may show in a tile: is not for certain outside its rays.
bool glint_may_show(const glint_plan *plan, const glint_ball *balls, uint32_t count, uint32_t column, uint32_t row);

/// Whether one of them may lie between a light and the tile's points, which are in `box`.
bool glint_may_shade(const glint_plan *plan, const glint_plan_light *light, const glint_point_box *box,
                     const glint_ball *balls, uint32_t count, uint32_t column, uint32_t row);

#endif
