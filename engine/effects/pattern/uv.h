/// Coordinates on the surfaces of shapes: u and v. Internal.
#ifndef GLINT_PATTERN_UV_H
#define GLINT_PATTERN_UV_H

#include "engine/plan/plan.h"

/// A point of a shape, as far as its coordinates depend on it; each kind reads what it names.
typedef struct glint_uv_point {
    double p[3]; ///< in the shape's own space
    double from_center[3]; ///< spheres: of the same
    int axis; ///< box: of the face that it is on
    bool upper; ///< box: that face is the one at `max`
    uint32_t triangle; ///< mesh: its number, from 0
} glint_uv_point;

typedef struct glint_surface_uv {
    double at[2];
    double unit; ///< how wide one unit of them is, in the shape's own space
    double slope[2][3]; ///< how they grow along the axes of that space
} glint_surface_uv;

void glint_surface_uv_at(const glint_pattern_place *place, const glint_uv_point *point, glint_surface_uv *out);

#endif
