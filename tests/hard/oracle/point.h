/// One point of a surface, and a frame of one pixel that shows it.
#ifndef HARD_POINT_H
#define HARD_POINT_H

#include "tests/hard/oracle/drive.h"

/// The diffuse and the specular light of a plane through the origin that is seen from v and lit from l by a directional
/// light of strength 1. The vectors need not be unit.
glint_reflection point_reflection(glint_material *material, const double n[3], const double l[3], const double v[3],
                                  glint_precision precision);

/// A white matt floor y = 0 under one light, seen at (x, 0, 0) along (-1, -0.4, 0); `more`: what else the scene holds,
/// or NULL. The block of 4 x 4 pixels around that point is within `width`: their mean, and their root mean square distance
/// from `want` in *off (which may be NULL).
double point_lit(const glint_light_desc *light, const hard_sphere *more, double x, double width, double want,
                 glint_precision precision, double *off, glint_frame_stats *stats);

/// Looks along a ray at what a scene holds, which becomes a picture of one pixel: of `pass`, its first channel.
double point_seen(glint_scene *scene, const hard_ray *ray, glint_precision precision, double max_depth,
                  glint_pass pass);

/// A material that only mirrors and lets through, and only glows, each `ambient`, mirror and transmission of it.
glint_material *point_glass(double ambient, double mirror, double transmission, double ior, bool fresnel);

#endif
