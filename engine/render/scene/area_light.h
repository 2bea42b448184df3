/// The surfaces of area lights: checks, areas and sample positions. Internal.
#ifndef GLINT_LIGHT_SAMPLE_H
#define GLINT_LIGHT_SAMPLE_H

#include "engine/glint.h"
#include "engine/render/stages/stages.h"

/// Checks a polygon: at least three corners, finite, different, in one plane, convex, with an area.
glint_status glint_light_sample_check_polygon(const glint_light_desc *desc, glint_error *error);

/// Computes the unit normal of a polygon, on the side from which its corners run counter-clockwise.
void glint_light_sample_polygon_normal(const glint_light_desc *desc, double normal[3]);

/// Returns the area of the side or sides that emit light; 0 for a light without a surface.
double glint_light_sample_area(const glint_light_desc *desc);

/// Returns the approximate distance from the light's centre, or from a corner of it, to its border.
double glint_light_sample_size(const glint_light_desc *desc);

/// Fills in the ball and box of the whole light, for caps.
void glint_light_sample_whole(const glint_light_desc *desc, glint_light_sample *out);

/// Returns the number of sample sets that the samples of a pixel alternate between: a power of two.
uint32_t glint_light_sample_sets(const glint_light_desc *desc, double pixel_samples);

/// Fills sets x samples entries of `out`: all sets of sample 0, then of sample 1 ...
///
/// Sample s of N takes the point ((s + a) / N, frac(s g + b)) of the unit square, g the golden ratio: a lattice that
/// is even for any N. (a, b) comes from a (0,2) sequence and differs for the 16 pixels of a block and for each set.
/// Means over blocks and over the samples of a pixel therefore use even sets, too. The square is mapped to the
/// surface with areas in proportion. For a sphere with radiance it is mapped to the cone in which a point sees the
/// sphere, with solid angles in proportion. An even N then gives pairs: ((k + a) / (N/2), frac(k g + b)) and
/// ((k + 1 - a) / (N/2), the same + 1/2).
void glint_light_sample_fill(const glint_light_desc *desc, uint32_t sets, double seed, glint_light_sample *out);

#endif
