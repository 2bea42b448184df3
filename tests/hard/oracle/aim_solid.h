/// Solids and triangles under maps, and rays made to hurt.
#ifndef HARD_AIM_SOLID_H
#define HARD_AIM_SOLID_H

#include "tests/hard/oracle/drive.h"
#include "tests/hard/oracle/oracle_solid.h"

#define SOLID_KINDS 7
#define SOLID_DISK 2
#define SOLID_TORUS 5 ///< the one that is not convex
extern const char *const solid_names[SOLID_KINDS]; ///< the last is the triangle

/// Any size and place, often under a map that turns, stretches, shears and mirrors. *size: about its own, before the map.
hard_solid solid_random(int kind, double *size);

/// A scene of it.
glint_scene *solid_alone(const hard_solid *s, glint_material *material);

/// From anywhere, or from another point of the shape, at a point of it, or past it by little, or along its surface.
hard_ray solid_aim(const hard_solid *s, double size);

#endif
