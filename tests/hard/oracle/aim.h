/// Rays that are hard to decide: made for the fuzz, of every kind that has hurt a ray tracer.
#ifndef HARD_AIM_H
#define HARD_AIM_H

#include "tests/hard/oracle/oracle.h"

/// A sphere of scale 1e-8 .. 1e8, at or away from the origin, and a ray at it: half of the rays pass within
/// 1e-2 .. 1e-16 of tangency; origins far away, near, on and in the surface; directions of any length, whole or with
/// components that all but vanish.
void aim_at_sphere(hard_ray *ray, hard_sphere *sphere);

/// A plane and a ray, half of them grazing within 1e-2 .. 1e-16, origins on it, near it and far away.
void aim_at_plane(hard_ray *ray, hard_plane *plane);

/// `count` spheres about one place: concentric with radii a few ulp apart, bit-equal, or apart; and a ray at them.
void aim_at_many(hard_ray *ray, hard_sphere *spheres, int count);

#endif
