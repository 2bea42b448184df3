/// One point of a surface, and a one-pixel frame that shows it.
#ifndef HARD_POINT_H
#define HARD_POINT_H

#include "tests/hard/oracle/drive.h"

/// Returns the diffuse and specular light of a plane through the origin, seen from v and lit from l by a directional
/// light of strength 1. The vectors need not be unit vectors.
glint_reflection point_reflection(glint_material *material, const double n[3], const double l[3], const double v[3],
                                  glint_precision precision);

/// Renders a white matt floor y = 0 under one light, seen at (x, 0, 0) along (-1, -0.4, 0): a block of 4 x 4 pixels
/// around that point, `width` wide. `more` is another sphere in the scene, or NULL. Returns the mean of the pixels.
/// *off, unless NULL, gets the root mean square distance of the pixels from `want`.
double point_lit(const glint_light_desc *light, const hard_sphere *more, double x, double width, double want,
                 glint_precision precision, double *off, glint_frame_stats *stats);

/// Renders one pixel of a scene along a ray. Returns the first channel of `pass`.
double point_seen(glint_scene *scene, const hard_ray *ray, glint_precision precision, double max_depth,
                  glint_pass pass);

/// Creates a material with only ambient, mirror and transmission.
glint_material *point_glass(double ambient, double mirror, double transmission, double ior, bool fresnel);

#endif
