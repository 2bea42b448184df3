/// Programs that the engine itself makes: a builder and its first error, after which calls do nothing. Internal.
#ifndef GLINT_MAKER_H
#define GLINT_MAKER_H

#include "engine/glint.h"

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

/// An operation of one or two values.
static inline glint_value glint_maker_apply(glint_maker *m, glint_op op, glint_value a, glint_value b)
{
    const glint_value operands[] = { a, b };
    glint_value out = 0;
    if (!m->status)
        m->status = glint_builder_op(m->builder, op, operands, &out, m->error);
    return out;
}

/// An operation of a value and a number. A builder numbers values in the order in which they are made, and C leaves that of
/// arguments open: the number is made here, after the value, so that the program is the same whatever compiles this.
static inline glint_value glint_maker_with(glint_maker *m, glint_op op, glint_value a, double number)
{
    glint_value b = 0;
    if (!m->status)
        m->status = glint_builder_number(m->builder, number, &b, m->error);
    return glint_maker_apply(m, op, a, b);
}

#endif
