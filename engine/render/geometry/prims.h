/// Makes single primitives from descriptions; fill.c makes all primitives of a scene. Internal.
#ifndef GLINT_PRIMS_H
#define GLINT_PRIMS_H

#include "engine/render/geometry/faces.h"
#include "engine/render/geometry/geometry.h"

void glint_sphere_init(glint_prim *prim, const double center[3], double radius);
/// Makes a plane. buffer: memory for the plane's fields except the position; it must live as long as the primitive.
void glint_plane_init(glint_prim *prim, double buffer[4], const double point[3], const double normal[3],
                      const glint_placing *placing);
/// Makes a sphere, box, disk, cylinder, cone or torus; faces: memory for its faces. Returns the number of faces.
int glint_solid_init(glint_prim *prim, glint_solid *solid, const glint_shape_desc *desc, const glint_placing *placing,
                     glint_face *faces);

/// Scales a map by a power of two, so that no product of two of its numbers overflows or underflows. Returns the
/// factor.
double glint_linear_scale(double m[3][3]);

#endif
