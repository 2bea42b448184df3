/// Programs: the builder, and what its programs give.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/program/builder.h"

static glint_error error;

static glint_builder *new_builder(glint_program_kind kind)
{
    glint_builder *builder;
    assert_int_equal(glint_builder_create(kind, &builder, &error), GLINT_OK);
    return builder;
}

static glint_value number(glint_builder *builder, double x)
{
    glint_value out;
    assert_int_equal(glint_builder_number(builder, x, &out, &error), GLINT_OK);
    return out;
}

static glint_value read_input(glint_builder *builder, glint_input input)
{
    glint_value out;
    assert_int_equal(glint_builder_input(builder, input, &out, &error), GLINT_OK);
    return out;
}

static glint_value op3(glint_builder *builder, glint_op op, glint_value a, glint_value b, glint_value c)
{
    const glint_value operands[] = { a, b, c };
    glint_value out[GLINT_RESULTS_MAX];
    if (glint_builder_op(builder, op, operands, out, &error) != GLINT_OK)
        fail_msg("%s", error.message);
    return out[0];
}

static glint_value op2(glint_builder *builder, glint_op op, glint_value a, glint_value b)
{
    return op3(builder, op, a, b, 0);
}

static glint_program *finish(glint_builder *builder, const glint_value *outputs, size_t count)
{
    glint_program *program;
    if (glint_builder_finish(builder, outputs, count, &program, &error) != GLINT_OK)
        fail_msg("%s", error.message);
    return program;
}

static void test_listing(void **state)
{
    (void)state;
    glint_builder *b = new_builder(GLINT_PROGRAM_PATTERN);
    const glint_value x = read_input(b, GLINT_INPUT_P_X), y = read_input(b, GLINT_INPUT_P_Y), half = number(b, 0.5);
    const glint_value sum = op2(b, GLINT_OP_ADD, op2(b, GLINT_OP_MUL, x, half), y);
    const glint_value again = op2(b, GLINT_OP_ADD, op2(b, GLINT_OP_MUL, x, half), y);
    assert_int_equal(sum, again);
    op2(b, GLINT_OP_SIN, x, 0); // which no output needs
    assert_int_equal(glint_builder_length(b), 3);
    const glint_value out = op2(b, GLINT_OP_SQRT, sum, 0);
    glint_program *p = finish(b, &out, 1);
    char *listing = glint_program_listing(p);
    assert_string_equal(listing, "r0 = muladd p.x 0.5 p.y\nr0 = sqrt r0\nreturn r0\n");
    free(listing);
    double inputs[GLINT_INPUT_COUNT] = { 3, 2.5 }, got;
    assert_int_equal(glint_program_evaluate(p, inputs, &got, &error), GLINT_OK);
    assert_true(got == 2);
    assert_int_equal(glint_program_length(p), 2);
    assert_int_equal(glint_program_rows(p), 1);
    assert_true(glint_program_reads(p, GLINT_INPUT_P_Y) && !glint_program_reads(p, GLINT_INPUT_P_Z));
    glint_program_release(p);
    glint_builder_destroy(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_listing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
