/// What one light adds to a derivative, for sixteen points at once. Internal to engine/tile.
#ifndef GLINT_DERIVATIVE_LIGHT_H
#define GLINT_DERIVATIVE_LIGHT_H

#include "engine/plan/derivative.h"

/// Points of a group, doubles.
typedef struct glint_derivative_points {
    _Alignas(64) double point[3][GLINT_GROUP];
    _Alignas(64) double normal[3][GLINT_GROUP]; ///< unit, turned to the eye
    _Alignas(64) double eye[3][GLINT_GROUP]; ///< unit, towards it
} glint_derivative_points;

/// A light as a group sees it, or one sample of it.
typedef struct glint_derivative_source {
    _Alignas(64) double position[3][GLINT_GROUP]; ///< directional: the unit vector towards it
    _Alignas(64) double normal[3][GLINT_GROUP]; ///< of its surface; read of radiant ones
    _Alignas(64) double weight[GLINT_GROUP]; ///< share of it that reaches the point; 0: none
    bool radiant; ///< with cos' / distance^2
    bool both; ///< radiant: to both sides
} glint_derivative_source;

/// Adds the slope of what a light leaves on lanes of one material, which have a weight, to `sum`.
void glint_derive_light(const glint_derivative_light *light, const glint_derivative_material *material,
                        const glint_derivative_points *points, const glint_derivative_source *source,
                        double *const sum[3]);

#endif
