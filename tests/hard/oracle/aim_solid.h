/// Solids and triangles under maps, and adversarial rays.
#ifndef HARD_AIM_SOLID_H
#define HARD_AIM_SOLID_H

#include "tests/hard/oracle/drive.h"
#include "tests/hard/oracle/oracle_solid.h"

#define SOLID_KINDS 7
#define SOLID_DISK 2
#define SOLID_TORUS 5 ///< index of the torus, the only kind that is not convex
extern const char *const solid_names[SOLID_KINDS]; ///< names of the kinds; the last kind is the triangle

/// Makes a shape of any size and position, often under a map that rotates, stretches, shears and mirrors. *size gets
/// the approximate size of the shape before the map.
hard_solid solid_random(int kind, double *size);

/// Creates a scene with only this shape.
glint_scene *solid_alone(const hard_solid *s, glint_material *material);

/// Aims a ray at a point of the shape, slightly past the shape, or along its surface. The ray starts anywhere, or at
/// another point of the shape.
hard_ray solid_aim(const hard_solid *s, double size);

#endif
