/// Exact results for a ray and a sphere, a ray and a plane, a reflection and a pixel value, computed from the
/// definition and the binary64 inputs of the engine, without any of its kernels. `oracle_*` works in multiple
/// precision and decides exactly; `quick_*` works in 113 bits and reports when that is not enough.
#ifndef HARD_ORACLE_H
#define HARD_ORACLE_H

#include <stdbool.h>

typedef struct hard_ray {
    double o[3], d[3]; ///< origin; direction, of any nonzero length
} hard_ray;

typedef struct hard_sphere {
    double c[3], r;
} hard_sphere;

typedef struct hard_plane {
    double p[3], n[3]; ///< a point of the plane; the plane's normal, of any nonzero length
} hard_plane;

#define PARALLEL 1e-30 ///< a ray with |n . d| below this share of |n| |d| does not hit the plane

typedef struct truth {
    bool hit;
    double t; ///< nearest t > 0, rounded once
    double n[3]; ///< outward unit normal at the hit; for a plane, the plane's own normal
    double cosine; ///< |n . d| / |d| at the hit
    /// How far the decision between hit and miss is from changing. For a sphere: the difference between the radius
    /// and the line's distance from the centre, in units of |f| + r, f = o - c.
    /// For a plane: |n . d| in units of |n| |d|.
    double tangency;
    double surface; ///< distance of the ray's origin from the surface; for a sphere in units of |f| + r, for a plane
        ///< of |o| + |p|
} truth;

truth oracle_sphere(const hard_ray *ray, const hard_sphere *sphere);
truth oracle_plane(const hard_ray *ray, const hard_plane *plane);

/// Returns false when 113 bits do not decide between hit and miss, or do not give t to a thousandth of an ulp.
bool quick_sphere(const hard_ray *ray, const hard_sphere *sphere, truth *out);
bool quick_plane(const hard_ray *ray, const hard_plane *plane, truth *out);

/// Returns the result of the quick version where it suffices, otherwise of the oracle.
truth true_sphere(const hard_ray *ray, const hard_sphere *sphere);
truth true_plane(const hard_ray *ray, const hard_plane *plane);

/// Returns whether o - c is exact in binary64 in every component, so that nothing is lost before the engine begins.
bool exact_difference(const double o[3], const double c[3]);

/// The diffuse and specular terms of one light of strength 1 on a white material.
typedef struct reflection {
    double diffuse, specular;
    double log2_specular; ///< log2 of `specular`; -inf where it is 0
} reflection;

/// Computes a reflection, by n.h instead of r.v if `blinn`. The vectors need not be unit vectors. The normal is
/// turned towards the eye.
reflection oracle_reflection(bool blinn, double shininess, const double normal[3], const double to_light[3],
                             const double to_eye[3]);

/// Returns floor(range x + 0.5), where x is a linear value or its sRGB encoding (IEC 61966-2-1:1999).
int oracle_code(double linear, bool srgb, int range);

#endif
