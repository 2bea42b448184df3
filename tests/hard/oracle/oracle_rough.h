/// What rough surfaces reflect, in 113-bit arithmetic.
#ifndef GLINT_TESTS_ORACLE_ROUGH_H
#define GLINT_TESTS_ORACLE_ROUGH_H

#include <stdbool.h>

/// Returns the light that white facets with normals around n reflect towards v, under a sky that is 1 in the directions
/// with a positive component along `toward` and otherwise 0. rings: steps of the slope; the work grows as their square.
double oracle_step(bool beckmann, double roughness, const double n[3], const double v[3], const double toward[3], int rings);

#endif
