/// Sets a formula. Internal.
#ifndef GLINT_TEXT_FORMULA_H
#define GLINT_TEXT_FORMULA_H

#include "engine/figures/text/line.h"

/// The first fault of a formula.
typedef struct glint_formula_fault {
    const char *at; ///< the sign or command to which `message` refers; NULL: nothing is wrong
    char message[160]; ///< a sentence that lacks the position at its end: "expected ..., got ..."
} glint_formula_fault;

/// Sets a formula at the end of a line that ends at `*x`, and moves `*x` and the line's extents. On a fault the line is
/// incomplete.
void glint_formula_set(const glint_typeface *typeface, const char *formula, size_t size, double *x, glint_line *line,
                       glint_formula_fault *fault);

#endif
