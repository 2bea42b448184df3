/// A program in two parts: what does not depend on some of its numbers, and the rest. Internal.
#ifndef GLINT_PROGRAM_SPLIT_H
#define GLINT_PROGRAM_SPLIT_H

#include "engine/program/program.h"

/// The numbers and textures of both parts are those of the program, or of any other program with its structure.
typedef struct glint_split {
    glint_program_code first; ///< its outputs are cached for the second part
    glint_program_code second; ///< its inputs are these, in their order
    uint32_t truths; ///< a bit a kept value: it is 0 or 1, but where it is made of NaN
    uint32_t cost; ///< of the cached values and of the instructions of both parts, see below
    uint32_t saved; ///< of the instructions that the second part skips, in tenths of a nanosecond per point
} glint_split;

/// Puts everything that depends on the `changed` numbers (one flag per number) into the second part. The rest of the second part is found by a
/// minimal cut: of all that can be kept, and run again, what takes the least time; of equals, what leaves the least to be run.
///
/// Returns false without memory. *out is NULL where there is nothing to keep, or too much.
bool glint_split_create(const glint_program *program, const bool *changed, glint_split **out);
void glint_split_destroy(glint_split *split); ///< NULL: nothing

#endif
