/// What one light adds to a derivative, for sixteen points at once. Internal to engine/tile.
#ifndef GLINT_DERIVATIVE_LIGHT_H
#define GLINT_DERIVATIVE_LIGHT_H

#include "engine/plan/derivative.h"

/// Points of a group: sixteen doubles each.
typedef struct glint_derivative_points {
    const double *point[3];
    const double *normal[3]; ///< unit, turned to the eye
    const double *eye[3]; ///< unit, towards it
    const double *slope[3][3]; ///< of the three; slope[0][0] NULL: all are 0
} glint_derivative_points;

/// What of a material programs give, for a group: numbers beside those of glint_derivative_material.
enum {
    GLINT_DERIVED_DIFFUSE, ///< three, by which the material's are multiplied; and so of the next
    GLINT_DERIVED_SPECULAR = 3,
    GLINT_DERIVED_SHININESS = 6, ///< in the place of the material's, and so the next
    GLINT_DERIVED_ALPHA,
    GLINT_DERIVED_COUNT
};

typedef struct glint_derivative_planes {
    const double *value[GLINT_DERIVED_COUNT]; ///< sixteen each; NULL: the material's own
    const double *slope[GLINT_DERIVED_COUNT]; ///< NULL: 0
} glint_derivative_planes;

/// A light as a group sees it, or one sample of it.
typedef struct glint_derivative_source {
    const double *position[3]; ///< directional: the unit vector towards it
    const double *normal[3]; ///< of its surface; read of radiant ones
    const double *weight; ///< share of it that reaches the point; NULL: 1
    const double *tint[3], *tint_slope[3]; ///< what is left of its colours on the way; tint[0] NULL: all
    bool radiant; ///< with cos' / distance^2
    bool both; ///< radiant: to both sides
} glint_derivative_source;

/// bend.c: the slopes of those points of a group, among `lanes`, that derivative number `index` moves; returns
/// which they are.
struct glint_tile;
struct glint_tile_frame;
unsigned glint_bend_points(const struct glint_tile *tile, const struct glint_tile_frame *frame, size_t index, uint32_t g,
                           unsigned lanes, const glint_derivative_points *points, double (*bend)[3][GLINT_GROUP]);
/// Unit vectors against the directions of rays.
void glint_derive_eyes(double direction[3][GLINT_GROUP], double *const eye[3]);
/// How a light comes to points of a group: the unit way to it, what of its colour arrives, and how far it is, as the inputs from
/// GLINT_INPUT_L_X on.
#define GLINT_ARRIVAL_COUNT 7
typedef struct glint_derivative_arrival {
    double value[GLINT_ARRIVAL_COUNT][GLINT_GROUP], slope[GLINT_ARRIVAL_COUNT][GLINT_GROUP];
} glint_derivative_arrival;

void glint_derive_arrival(const glint_derivative_light *light, const glint_derivative_points *points,
                          const glint_derivative_source *source, glint_derivative_arrival *out);

/// planes: of what programs give; NULL: they give nothing.
///
/// Adds the slope of what a light leaves on lanes, a bit each, of one material to `sum`, and that itself to `whole`. whole[0]
/// NULL: nothing.
void glint_derive_light(const glint_derivative_light *light, const glint_derivative_material *material,
                        const glint_derivative_planes *planes, const glint_derivative_points *points, const glint_derivative_source *source, unsigned which,
                        double *const sum[3], double *const whole[3]);

#endif
