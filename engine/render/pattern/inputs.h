/// The inputs of programs at points: one row of doubles per input. Internal.
#ifndef GLINT_PATTERN_INPUTS_H
#define GLINT_PATTERN_INPUTS_H

#include "engine/render/pattern/pattern.h"

/// The lanes of a group that show one material.
typedef struct glint_pattern_lanes {
    uint32_t material;
    uint16_t group, lanes;
} glint_pattern_lanes;

typedef struct glint_pattern_inputs {
    const double *from[GLINT_INPUT_COUNT]; ///< where a program reads: a row, or directly an array of the tile
    uint32_t used, same; ///< one bit per input: `from` is set; see glint_program_args
    _Alignas(64) double row[GLINT_INPUT_COUNT][GLINT_PROGRAM_LANES];
    double uv_slope[2][3][GLINT_PROGRAM_LANES]; ///< the gradients of u and v in the shape's own space
} glint_pattern_inputs;

/// Computes the inputs in `reads` (one bit each) for the lanes of `count` entries, one group each: entry k has the
/// lanes from 16 k on. Other lanes are undefined.
void glint_pattern_gather(glint_pattern_inputs *inputs, const glint_tile_frame *frame,
                          const glint_pattern_points *points, uint32_t reads, const glint_pattern_lanes *entries,
                          uint32_t count);
/// Points an input at its own row.
double *glint_pattern_row(glint_pattern_inputs *inputs, glint_input input);
/// Sets every lane of an input to one number, until the input is gathered again.
void glint_pattern_put_number(glint_pattern_inputs *inputs, glint_input input, double number);

#endif
