/// Finds shadow rays that may hit something transparent, using only bounds, so that other rays are not followed.
/// Internal.
#ifndef GLINT_TINTS_H
#define GLINT_TINTS_H

#include "engine/render/plan/plan.h"

#define GLINT_TINTS_MAX 64

typedef struct glint_ball {
    double center[3], radius;
} glint_ball;

/// Balls around all transparent primitives of a frame.
typedef struct glint_tints {
    uint32_t count;
    bool everywhere; ///< some transparent primitives are unbounded: the balls are not used
    double extent; ///< extent of the geometry
    glint_ball of[GLINT_TINTS_MAX];
} glint_tints;

/// Computes the balls of a plan with `tints`: one for each primitive, or for neighbours in the order of the table if
/// there are more.
void glint_tints_find(glint_tints *tints, const glint_plan *plan, const glint_geometry_table *table);

/// The target of the rays from points to one light.
typedef struct glint_tint_light {
    bool directional;
    double position[3]; ///< position of the light; directional: the direction
    double radius; ///< radius of an area light's samples around `position`
} glint_tint_light;

/// Returns the lanes of a group whose rays to a light may hit one of `count` balls listed in `chosen`. point: sixteen
/// of each coordinate.
uint16_t glint_tints_lanes(const glint_tints *tints, const uint16_t *chosen, uint32_t count,
                           const double point[3][GLINT_GROUP], uint16_t lanes, const glint_tint_light *light);
/// Lists in `chosen` the balls that a ray from any point of a ball to the light may hit. Returns their number.
uint32_t glint_tints_choose(const glint_tints *tints, const glint_ball *points, const glint_tint_light *light,
                            uint16_t chosen[GLINT_TINTS_MAX]);

#endif
