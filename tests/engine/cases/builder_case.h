/// Programs that tests build, one at a time.
#ifndef GLINT_TESTS_BUILDER_CASE_H
#define GLINT_TESTS_BUILDER_CASE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "engine/glint.h"
#include "engine/glint_math.h"
#include "engine/glint_programs.h"

static glint_error error;

#define OK(call) \
    do { \
        if ((call) != GLINT_OK) \
            fail_msg("%s: %s", #call, error.message); \
    } while (0)

static glint_builder *builder;

static void begin_program(glint_program_kind kind) { OK(glint_builder_create(kind, &builder, &error)); }

static glint_value num(double x)
{
    glint_value out;
    OK(glint_builder_number(builder, x, &out, &error));
    return out;
}

static glint_value in(glint_input input)
{
    glint_value out;
    OK(glint_builder_input(builder, input, &out, &error));
    return out;
}

static glint_value op(glint_op which, glint_value a, glint_value b, glint_value c)
{
    const glint_value operands[GLINT_OPERANDS_MAX] = { a, b, c };
    glint_value out[GLINT_RESULTS_MAX];
    OK(glint_builder_op(builder, which, operands, out, &error));
    return out[0];
}

static glint_program *end_program(const glint_value *outputs, size_t count)
{
    glint_program *program;
    OK(glint_builder_finish(builder, outputs, count, &program, &error));
    glint_builder_destroy(builder);
    return program;
}

#endif
