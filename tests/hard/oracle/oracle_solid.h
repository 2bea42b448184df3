/// Exact results for a ray and an ellipsoid, box, cylinder, cone, disk, torus or triangle, under any map: in 113 bits, from the
/// binary64 numbers of its description.
///
/// How near a decision is to the other one is asked of the shape itself: it is met grown and shrunk by a share `margin` of
/// its unit size. Where the two differ, either answer will do; else t lies between theirs. A solid is what its parts have in
/// common: the slabs of a box, the side and the slab of a cylinder or cone. Rounding moves each of them by a margin of its
/// own, and the one that ends the ray's way within is any that can end it so.
#ifndef HARD_ORACLE_SOLID_H
#define HARD_ORACLE_SOLID_H

#include "engine/glint.h"
#include "tests/hard/oracle/oracle.h"

typedef struct hard_solid {
    glint_shape_desc desc; ///< of a sphere, box, disk, cylinder, cone or torus; its transform counts
    bool is_triangle;
    double corner[3][3];
} hard_solid;

#define SOLID_PARTS 3 ///< of a box; other shapes have fewer

typedef struct solid_normal {
    double n[3]; ///< outward, unit; of a triangle to the side from which its corners run counter-clockwise
    double turn; ///< by how much it turns between where the grown and the shrunk shape are met
} solid_normal;

typedef struct solid_truth {
    bool hit, close; ///< close: hit means nothing
    double t, least, most; ///< of the nearest t > 0; of the grown and the shrunk shape, in order
    int normals; ///< how many will do: 1, more next to an edge; 0: any, next to a cone's apex
    solid_normal normal[SOLID_PARTS];
} solid_truth;

/// `rounding`: of the engine's arithmetic, in units of 2^-53; the margin is made of it, of the map's condition and of how far
/// the ray starts.
solid_truth oracle_solid(const hard_ray *ray, const hard_solid *solid, double rounding);

#endif
