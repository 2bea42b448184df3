/// A program split in two: a part that does not depend on some of the numbers, and the rest. Internal.
#ifndef GLINT_PROGRAM_SPLIT_H
#define GLINT_PROGRAM_SPLIT_H

#include "engine/render/program/program.h"

/// The numbers and textures of both parts belong to the program, or to any other program with the same structure.
typedef struct glint_split {
    glint_program_code first; ///< its outputs are cached for the second part
    glint_program_code second; ///< its inputs are the outputs of the first part, in the same order
    uint32_t truths; ///< a bit for each cached value, set if the value is always 0 or 1 (unless computed from NaN)
    uint32_t cost; ///< cost of the cached values and of the instructions that both parts run, tenths of a nanosecond
        ///< per point
    uint32_t saved; ///< cost of all instructions that the changed numbers do not affect, in the same unit
} glint_split;

/// Puts everything that depends on the `changed` numbers (one flag per number) into the second part. A minimum cut
/// decides which other values are cached and which are computed again: the cut takes the least time and, among cuts
/// with equal time, computes the fewest values again.
///
/// False: out of memory. *out is NULL if there is nothing to cache, or too much.
bool glint_split_create(const glint_program *program, const bool *changed, glint_split **out);
void glint_split_destroy(glint_split *split); ///< NULL: no effect

#endif
