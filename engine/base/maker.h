/// Makes programs inside the engine: a builder and its first error. After an error, calls do nothing. Internal.
#ifndef GLINT_MAKER_H
#define GLINT_MAKER_H

#include "engine/glint_math.h"
#include "engine/glint_programs.h"

typedef struct glint_maker {
    glint_builder *builder;
    glint_status status;
    glint_error *error;
} glint_maker;

static inline glint_value glint_maker_input(glint_maker *m, glint_input which)
{
    glint_value out = 0;
    if (!m->status)
        m->status = glint_builder_input(m->builder, which, &out, m->error);
    return out;
}

static inline glint_value glint_maker_number(glint_maker *m, double number)
{
    glint_value out = 0;
    if (!m->status)
        m->status = glint_builder_number(m->builder, number, &out, m->error);
    return out;
}

/// Applies an operation to up to three values; operands that the operation does not have are ignored.
static inline glint_value glint_maker_apply3(glint_maker *m, glint_op op, glint_value a, glint_value b, glint_value c)
{
    const glint_value operands[] = { a, b, c };
    glint_value out = 0;
    if (!m->status)
        m->status = glint_builder_op(m->builder, op, operands, &out, m->error);
    return out;
}

/// Applies an operation to one or two values.
static inline glint_value glint_maker_apply(glint_maker *m, glint_op op, glint_value a, glint_value b)
{
    return glint_maker_apply3(m, op, a, b, 0);
}

/// Applies an operation to a value and a number. A builder numbers its values in the order of their creation, and C
/// does not define in which order it evaluates arguments. So the number is made here, after the value, and every
/// compiler makes the same program.
static inline glint_value glint_maker_with(glint_maker *m, glint_op op, glint_value a, double number)
{
    const glint_value b = glint_maker_number(m, number);
    return glint_maker_apply(m, op, a, b);
}

#endif
