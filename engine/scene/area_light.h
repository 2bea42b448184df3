/// The surfaces of area lights: checks, areas, and where their samples lie. Internal.
#ifndef GLINT_LIGHT_SAMPLE_H
#define GLINT_LIGHT_SAMPLE_H

#include "engine/glint.h"
#include "engine/stages/stages.h"

/// At least three corners, finite, different, in one plane, convex, with an area.
glint_status glint_light_sample_check_polygon(const glint_light_desc *desc, glint_error *error);

/// Unit, to the side from which the corners run counter-clockwise.
void glint_light_sample_polygon_normal(const glint_light_desc *desc, double normal[3]);

/// Returns the area of the side or sides that shine; 0 for a light without a surface.
double glint_light_sample_area(const glint_light_desc *desc);

/// How far it reaches from its middle or a corner of it, about.
double glint_light_sample_size(const glint_light_desc *desc);

/// Describes the whole light: its ball and box. For caps.
void glint_light_sample_whole(const glint_light_desc *desc, glint_light_sample *out);

/// How many patterns samples of a pixel take turns in: a power of two.
uint32_t glint_light_sample_turns(const glint_light_desc *desc, double pixel_samples);

/// Fills turns x samples lamps: all turns of sample 0, then of sample 1 ...
///
/// Sample s of N takes the point ((s + a) / N, frac(s g + b)) of the unit square, g the golden ratio: a lattice that is
/// even for any N. (a, b) is another for each of the 16 pixels of a block and for each turn, a (0,2) sequence, so that
/// means over blocks and over samples of a pixel are of an even set too. The square is laid on the surface so that areas
/// stay in proportion; of a sphere by radiance on the cone in which a point sees it, so that solid angles do, and with
/// an even N in pairs: ((k + a) / (N/2), frac(k g + b)) and ((k + 1 - a) / (N/2), that + 1/2).
void glint_light_sample_fill(const glint_light_desc *desc, uint32_t turns, double seed, glint_light_sample *out);

#endif
