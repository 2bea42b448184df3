/// Exact results for light: microfacets, spot lights, area lights, mirrors and glass. Computed from the definitions
/// in multiple precision, from the binary64 inputs of the engine.
#ifndef HARD_ORACLE_LIGHT_H
#define HARD_ORACLE_LIGHT_H

#include <stdbool.h>

/// Returns GGX's D, alpha^2 / (pi (sin^2 + alpha^2 cos^2)^2), at an angle (radians) between n and h.
double oracle_ggx(double alpha, double angle);

/// Returns pi D F G / (4 n.v) of white GGX or Beckmann facets. F is Schlick's from f0, G is Smith's
/// (height-correlated; Beckmann's Lambda is the rational fit of Walter et al. 2007). alpha = roughness^2. The vectors
/// need not be unit vectors. The result is 0 below the horizon.
double oracle_facets(bool beckmann, double roughness, double f0, const double n[3], const double l[3],
                     const double v[3]);

/// Returns the strength of a spot light along `to_point`:
/// smoothstep of the cosine between outer and inner, times cos^exponent.
double oracle_spot(double inner_rad, double outer_rad, double exponent, const double axis[3], const double to_point[3]);

/// Returns 1 - cos of the half angle that a ball subtends whose radius is `ratio` times its distance.
double oracle_cap(double ratio);

/// Return the irradiance from radiance 1 at a point that faces the light's centre: disk pi r^2 / (r^2 + d^2), ball pi
/// r^2 / d^2.
double oracle_disk(double radius, double distance);
double oracle_ball(double radius, double distance);

/// Returns the extent of a shadow on a plane: of a ball of radius `ball` at height `between`, under a ball light on
/// the axis. If `umbra`, the extent is the distance at which light begins; otherwise the distance at which the whole
/// light is visible.
double oracle_shadow(bool umbra, double light, double height, double ball, double between);

/// Returns a dielectric's reflectance for unpolarised light. `ratio` is the index on the ray's side over the index
/// beyond.
double oracle_fresnel(double ratio, double cosine);
/// Returns the sine beyond the surface by Snell's law; above 1 for total reflection.
double oracle_snell(double ratio, double sine);

/// Returns a (1 + m + m^2 + ... + m^depth), the light of facing mirrors with reflectance m and emission a.
double oracle_facing_mirrors(double shine, double mirror, double depth);

#endif
