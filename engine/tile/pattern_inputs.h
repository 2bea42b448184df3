/// What programs read of points: a row of doubles an input. Internal.
#ifndef GLINT_PATTERN_INPUTS_H
#define GLINT_PATTERN_INPUTS_H

#include "engine/tile/pattern.h"

typedef struct glint_pattern_inputs {
    _Alignas(64) double row[GLINT_INPUT_COUNT][GLINT_PROGRAM_LANES];
    double uv_slope[2][3][GLINT_PROGRAM_LANES]; ///< with u and v: how they grow along the axes of the shape's own space
} glint_pattern_inputs;

/// Fills the inputs in `reads`, a bit each, for some lanes of a group: lanes 16 k and on of the rows. Other lanes hold
/// anything.
void glint_pattern_gather(glint_pattern_inputs *inputs, const glint_tile_frame *frame,
                          const glint_pattern_points *points, uint32_t reads, uint32_t group, unsigned lanes,
                          uint32_t k);

#endif
