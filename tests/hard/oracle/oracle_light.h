/// Exact results for light: microfacets, spot lights, area lights, mirrors and glass. Computed from the definitions
/// in multiple precision, from the binary64 inputs of the engine.
#ifndef HARD_ORACLE_LIGHT_H
#define HARD_ORACLE_LIGHT_H

#include <stdbool.h>

/// GGX's D: alpha^2 / (pi (sin^2 + alpha^2 cos^2)^2), at an angle (radians) between n and h.
double oracle_ggx(double alpha, double angle);

/// pi D F G / (4 n.v) of GGX or Beckmann, white. F is Schlick's from f0, G is Smith's (height-correlated; Beckmann's
/// Lambda is the rational fit of Walter et al. 2007). alpha = roughness^2. The vectors need not be unit vectors. 0
/// below the horizon.
double oracle_facets(bool beckmann, double roughness, double f0, const double n[3], const double l[3],
                     const double v[3]);

/// The strength of a spot light along `to_point`: smoothstep of the cosine between outer and inner, times cos^exponent.
double oracle_spot(double inner_rad, double outer_rad, double exponent, const double axis[3], const double to_point[3]);

/// 1 - cos of the half angle that a ball subtends, of radius `ratio` times its distance.
double oracle_cap(double ratio);

/// Irradiance from radiance 1 at a point that faces the light's centre: disk pi r^2 / (r^2 + d^2), ball pi r^2 / d^2.
double oracle_disk(double radius, double distance);
double oracle_ball(double radius, double distance);

/// Extent on a plane of the shadow of a ball of radius `ball` at height `between`, under a ball light on the axis.
/// umbra: distance at which light begins; otherwise at which the whole light is visible.
double oracle_shadow(bool umbra, double light, double height, double ball, double between);

/// A dielectric's reflectance for unpolarised light. ratio: the index on the ray's side over the index beyond.
double oracle_fresnel(double ratio, double cosine);
/// Snell: the sine beyond the surface; above 1 for total reflection.
double oracle_snell(double ratio, double sine);

/// a (1 + m + m^2 + ... + m^depth): facing mirrors with reflectance m and emission a.
double oracle_facing_mirrors(double shine, double mirror, double depth);

#endif
