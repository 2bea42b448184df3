/// What programs read of points: a row of doubles an input. Internal.
#ifndef GLINT_PATTERN_INPUTS_H
#define GLINT_PATTERN_INPUTS_H

#include "engine/effects/pattern/pattern.h"

/// The lanes of a group that show one material.
typedef struct glint_pattern_lanes {
    uint32_t material;
    uint16_t group, lanes;
} glint_pattern_lanes;

typedef struct glint_pattern_inputs {
    const double *from[GLINT_INPUT_COUNT]; ///< where a program reads: a row, or arrays of the tile as they are
    uint32_t used, same; ///< a bit an input: there is something in `from`; as glint_program_args has it
    _Alignas(64) double row[GLINT_INPUT_COUNT][GLINT_PROGRAM_LANES];
    double uv_slope[2][3][GLINT_PROGRAM_LANES]; ///< with u and v: how they grow along the axes of the shape's own space
} glint_pattern_inputs;

/// Finds the inputs in `reads`, a bit each, for the lanes of `count` entries, a group each: lanes 16 k and on are entry k's. Other
/// lanes hold anything.
void glint_pattern_gather(glint_pattern_inputs *inputs, const glint_tile_frame *frame,
                          const glint_pattern_points *points, uint32_t reads, const glint_pattern_lanes *entries,
                          uint32_t count);
/// Points an input at its own row.
double *glint_pattern_row(glint_pattern_inputs *inputs, glint_input input);
/// Gives every lane of an input one number, which stays until the input is gathered.
void glint_pattern_put_number(glint_pattern_inputs *inputs, glint_input input, double number);

#endif
