/// Rays that are hard to decide, of every kind that has broken a ray tracer, for the fuzz.
#ifndef HARD_AIM_H
#define HARD_AIM_H

#include "tests/hard/oracle/oracle.h"

/// Makes a sphere of size 1e-8 .. 1e8, at the origin or away from it, and a ray at the sphere. Half of the rays pass
/// within 1e-2 .. 1e-16 of tangency. Origins are far away, near, on and inside the surface. Directions have any
/// length, integer or nearly vanishing components.
void aim_at_sphere(hard_ray *ray, hard_sphere *sphere);

/// Makes a plane and a ray. Half of the rays are grazing, at 1e-2 .. 1e-16.
/// Origins are on the plane, near it and far away.
void aim_at_plane(hard_ray *ray, hard_plane *plane);

/// Makes `count` spheres around one point, concentric with radii a few ulp apart, identical, or separate, and a ray
/// at the spheres.
void aim_at_many(hard_ray *ray, hard_sphere *spheres, int count);

#endif
