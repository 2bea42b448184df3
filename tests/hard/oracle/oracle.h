/// Exact results for a ray and a sphere, a ray and a plane, a reflection, a pixel value: from the definition, from the binary64
/// numbers that the engine gets, and by nobody's kernel. `oracle_*` answers in multiple precision and decides exactly;
/// `quick_*` answers in 113 bits and says when that is not enough.
#ifndef HARD_ORACLE_H
#define HARD_ORACLE_H

#include <stdbool.h>

typedef struct hard_ray {
    double o[3], d[3]; ///< origin; direction, any length but 0
} hard_ray;

typedef struct hard_sphere {
    double c[3], r;
} hard_sphere;

typedef struct hard_plane {
    double p[3], n[3]; ///< a point of it; its normal, any length but 0
} hard_plane;

#define PARALLEL 1e-30 ///< a plane is not met by a ray whose |n . d| is below this share of |n| |d|

typedef struct truth {
    bool hit;
    double t; ///< of the nearest t > 0, rounded once
    double n[3]; ///< outward unit normal there; a plane's own
    double cosine; ///< |n . d| / |d| there
    /// How far the decision is from the other one. Sphere: the line's distance from the centre against the radius, in
    /// units of |f| + r, f = o - c. Plane: |n . d| in units of |n| |d|.
    double tangency;
    double surface; ///< how far the origin is from the surface; sphere: in units of |f| + r, plane: of |o| + |p|
} truth;

truth oracle_sphere(const hard_ray *ray, const hard_sphere *sphere);
truth oracle_plane(const hard_ray *ray, const hard_plane *plane);

/// False when 113 bits do not tell hit from miss, or t to a thousandth of an ulp.
bool quick_sphere(const hard_ray *ray, const hard_sphere *sphere, truth *out);
bool quick_plane(const hard_ray *ray, const hard_plane *plane, truth *out);

/// Quick where that is enough.
truth true_sphere(const hard_ray *ray, const hard_sphere *sphere);
truth true_plane(const hard_ray *ray, const hard_plane *plane);

/// Whether o - c is exact in binary64, in every component: then no answer is lost before the engine begins.
bool exact_difference(const double o[3], const double c[3]);

/// The two terms of one light of strength 1 on a white material.
typedef struct reflection {
    double diffuse, specular;
    double log2_specular; ///< of `specular`; -inf where it is 0
} reflection;

/// blinn: n.h instead of r.v. The vectors need not be unit; the normal is turned to the eye.
reflection oracle_reflection(bool blinn, double shininess, const double normal[3], const double to_light[3],
                             const double to_eye[3]);

/// floor(range x + 0.5) of a linear value or of its sRGB encoding (IEC 61966-2-1:1999).
int oracle_code(double linear, bool srgb, int range);

#endif
