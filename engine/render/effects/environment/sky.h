/// A table of a background's brightness, to draw directions by. Internal.
///
/// The sphere of directions is divided into cells of equal width in longitude and equal height in latitude. A cell's
/// weight is the brightness at its corners times its solid angle, so a cell is drawn about as often as its share of
/// the sky's light; within a cell the density is interpolated between its corners.
///
/// Weights are whole numbers, so sums are exact.
#ifndef GLINT_ENVIRONMENT_SKY_H
#define GLINT_ENVIRONMENT_SKY_H

typedef struct glint_sky glint_sky;

/// Draws a direction of length 1 by a point of the unit square. Stratified points give stratified directions.
void glint_sky_draw(const glint_sky *sky, const double u[2], double direction[3]);
/// Returns the density of drawn directions, per steradian. direction: of length 1.
double glint_sky_density(const glint_sky *sky, const double direction[3]);

#endif
