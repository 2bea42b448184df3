/// Coordinates on the surfaces of shapes: u and v. Internal.
#ifndef GLINT_PATTERN_UV_H
#define GLINT_PATTERN_UV_H

#include "engine/render/plan/plan.h"

/// A point on a shape. Each kind of shape reads only some of the fields.
typedef struct glint_uv_point {
    double p[3]; ///< in the shape's own space
    double from_center[3]; ///< spheres: from the centre to p
    int axis; ///< box: axis of the face that the point is on
    bool upper; ///< box: that face is the one at `max`
    uint32_t triangle; ///< mesh: index of the triangle, from 0
} glint_uv_point;

typedef struct glint_surface_uv {
    double at[2];
    double unit; ///< width of one unit of u and v, in the shape's own space
    double slope[2][3]; ///< gradients of u and v in that space
} glint_surface_uv;

void glint_surface_uv_at(const glint_pattern_space *space, const glint_uv_point *point, glint_surface_uv *out);

#endif
