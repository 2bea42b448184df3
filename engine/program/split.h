/// A program in two parts: what does not depend on some of its numbers, and the rest. Internal.
#ifndef GLINT_PROGRAM_SPLIT_H
#define GLINT_PROGRAM_SPLIT_H

#include "engine/program/program.h"

/// The numbers and textures of both parts are the program's, and so are those of any other program of its structure.
typedef struct glint_split {
    glint_program_code first; ///< its outputs are what is kept for the second
    glint_program_code second; ///< its inputs are these, in their order
    uint32_t truths; ///< a bit a kept value: it is 0 or 1, but where it is made of NaN
    uint32_t cost; ///< of what is kept and of what both parts run, as below
    uint32_t saved; ///< of what the second part need not run; tenths of a nanosecond a point
} glint_split;

/// Puts what depends on the numbers that are `changed`, a flag a number, into the second part. What else is there is found by a
/// minimal cut: of all that can be kept, and run again, what takes the least time; of equals, what leaves the least to be run.
///
/// Returns false without memory. *out is NULL where there is nothing to keep, or too much.
bool glint_split_create(const glint_program *program, const bool *changed, glint_split **out);
void glint_split_destroy(glint_split *split); ///< NULL: nothing

#endif
