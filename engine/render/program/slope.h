/// Derivatives of values, built one operation at a time. Internal to program/slope*.c.
#ifndef GLINT_PROGRAM_SLOPE_H
#define GLINT_PROGRAM_SLOPE_H

#include "engine/render/program/builder.h"

#define GLINT_SLOPE_NOTHING UINT32_MAX

typedef struct glint_slope_maker {
    glint_builder *builder;
    uint32_t count; ///< values of the program; the values of its derivatives follow
    glint_value *given; ///< the adjoint of each value as summed so far; GLINT_SLOPE_NOTHING: nothing added yet
    bool *varies; ///< for each value, whether it depends on an input to derive by
    glint_status status; ///< status of the first failure; values made after it are meaningless
    glint_error *error;
} glint_slope_maker;

glint_value glint_slope_number(glint_slope_maker *s, double x);
/// Returns the result of an operation of up to three operands. Pass 0 for unused operands.
glint_value glint_slope_op(glint_slope_maker *s, glint_op op, glint_value a, glint_value b, glint_value c);

/// Adds `amount` to the adjoint of a value, if the value varies.
void glint_slope_give(glint_slope_maker *s, glint_value to, glint_value amount);
/// Passes the adjoint of value i, an operation, on to its operands, times the partial derivatives.
void glint_slope_pass(glint_slope_maker *s, glint_value i);

#endif
