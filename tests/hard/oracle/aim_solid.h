/// Solids and triangles under maps, and adversarial rays.
#ifndef HARD_AIM_SOLID_H
#define HARD_AIM_SOLID_H

#include "tests/hard/oracle/drive.h"
#include "tests/hard/oracle/oracle_solid.h"

#define SOLID_KINDS 7
#define SOLID_DISK 2
#define SOLID_TORUS 5 ///< the only kind that is not convex
extern const char *const solid_names[SOLID_KINDS]; ///< the last one is the triangle

/// A shape of any size and position, often under a map that rotates, stretches, shears and mirrors. *size: its
/// approximate size before the map.
hard_solid solid_random(int kind, double *size);

/// Creates a scene with only this shape.
glint_scene *solid_alone(const hard_solid *s, glint_material *material);

/// A ray from anywhere, or from another point of the shape, at a point of the shape, slightly past it, or along its
/// surface.
hard_ray solid_aim(const hard_solid *s, double size);

#endif
