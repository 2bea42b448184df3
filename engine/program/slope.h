/// How values' derivatives are made of values, an operation at a time. Internal to program/slope*.c.
#ifndef GLINT_PROGRAM_SLOPE_H
#define GLINT_PROGRAM_SLOPE_H

#include "engine/program/builder.h"

#define GLINT_SLOPE_NOTHING UINT32_MAX

typedef struct glint_slope_maker {
    glint_builder *builder;
    uint32_t count; ///< values of the program itself; values of its derivatives follow
    glint_value *given; ///< what each value was given so far; GLINT_SLOPE_NOTHING
    bool *varies; ///< depends on an input that counts
    glint_status status; ///< of the first failure; values made after it are meaningless
    glint_error *error;
} glint_slope_maker;

glint_value glint_slope_number(glint_slope_maker *s, double x);
/// The result of an operation of three operands, or of fewer; the others are 0.
glint_value glint_slope_op(glint_slope_maker *s, glint_op op, glint_value a, glint_value b, glint_value c);

/// Adds to the adjoint of a value, if it varies.
void glint_slope_give(glint_slope_maker *s, glint_value to, glint_value what);
/// Value i, of an operation, passes what it was given on to its operands, times its derivatives by them.
void glint_slope_pass(glint_slope_maker *s, glint_value i);

#endif
