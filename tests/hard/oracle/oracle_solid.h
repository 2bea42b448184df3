/// Exact results for a ray and an ellipsoid, box, cylinder, cone, disk, torus or triangle, under any map: in 113
/// bits, from the binary64 numbers of its description.
///
/// To see whether a decision is too close, the oracle also intersects the ray with the shape grown and shrunk by a
/// share `margin` of its unit size. Where the two results differ, either answer is accepted; otherwise t is between
/// them. A solid is the intersection of its parts: the slabs of a box, the side and the slab of a cylinder or cone.
/// Rounding moves each part by its own margin, so the part that ends the ray's span inside may be any that can do so
/// within the margins.
#ifndef HARD_ORACLE_SOLID_H
#define HARD_ORACLE_SOLID_H

#include "engine/glint.h"
#include "tests/hard/oracle/oracle.h"

typedef struct hard_solid {
    glint_shape_desc desc; ///< a sphere, box, disk, cylinder, cone or torus, with its transform
    bool is_triangle;
    double corner[3][3];
} hard_solid;

#define SOLID_PARTS 3 ///< number of parts of a box; other shapes have fewer

typedef struct solid_normal {
    double n[3]; ///< outward unit normal; for a triangle on the side from which its corners are counter-clockwise
    double turn; ///< how far the normal turns between the hits of the grown and the shrunk shape
} solid_normal;

typedef struct solid_truth {
    bool hit, close; ///< close: rounding could change the decision, and hit has no meaning
    double t, least, most; ///< nearest t > 0; the t of the grown and the shrunk shape, in order
    int normals; ///< number of acceptable normals: 1, or more next to an edge; 0 next to a cone's apex, where any
        ///< normal is acceptable
    solid_normal normal[SOLID_PARTS];
} solid_truth;

/// Intersects a ray with a solid. `rounding` is the rounding error of the engine's arithmetic, in units of 2^-53. The
/// margin is proportional to `rounding`, to the map's condition and to the distance of the ray's origin.
solid_truth oracle_solid(const hard_ray *ray, const hard_solid *solid, double rounding);

#endif
