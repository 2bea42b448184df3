/// Programs: the builder, and the results of its programs.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/render/program/builder.h"

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
    op2(b, GLINT_OP_SIN, x, 0); // no output needs this value
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

/// Checks the listing of a program with one output.
static void check_listing(glint_builder *b, glint_value out, const char *want)
{
    glint_program *p = finish(b, &out, 1);
    char *listing = glint_program_listing(p);
    assert_string_equal(listing, want);
    free(listing);
    glint_program_release(p);
}

static void test_pairs(void **state)
{
    (void)state;
    glint_builder *b = new_builder(GLINT_PROGRAM_PATTERN);
    const glint_value x = read_input(b, GLINT_INPUT_P_X), y = read_input(b, GLINT_INPUT_P_Y);
    const glint_value z = read_input(b, GLINT_INPUT_P_Z), product = op2(b, GLINT_OP_MUL, x, y);
    check_listing(b, op2(b, GLINT_OP_ADD, z, product), "r0 = muladd p.x p.y p.z\nreturn r0\n");
    check_listing(b, op2(b, GLINT_OP_SUB, product, z), "r0 = mulsub p.x p.y p.z\nreturn r0\n");
    check_listing(b, op2(b, GLINT_OP_SUB, z, product), "r0 = submul p.z p.x p.y\nreturn r0\n");
    const glint_value way = op2(b, GLINT_OP_SUB, y, x), share = op2(b, GLINT_OP_MUL, way, z);
    check_listing(b, op2(b, GLINT_OP_ADD, x, share), "r0 = mix p.x p.y p.z\nreturn r0\n");
    check_listing(b, op2(b, GLINT_OP_ADD, z, share), "r0 = sub p.y p.x\nr0 = muladd r0 p.z p.z\nreturn r0\n");
    const glint_value three = op2(b, GLINT_OP_MUL, z, product), cosine = op2(b, GLINT_OP_COS, z, 0);
    check_listing(b, three, "r0 = mulmul p.x p.y p.z\nreturn r0\n");
    check_listing(b, op2(b, GLINT_OP_ADD, three, cosine),
                  "r0 = mul p.x p.y\nr1 = cos p.z\nr0 = muladd p.z r0 r1\nreturn r0\n");
    const glint_value square = op2(b, GLINT_OP_MUL, z, z), two = op2(b, GLINT_OP_ADD, product, op2(b, GLINT_OP_MUL, y, z));
    check_listing(b, op2(b, GLINT_OP_ADD, two, square), "r0 = dot p.x p.y p.y p.z p.z p.z\nreturn r0\n");
    check_listing(b, op2(b, GLINT_OP_ADD, square, two), "r0 = dot p.x p.y p.y p.z p.z p.z\nreturn r0\n");
    check_listing(b, op2(b, GLINT_OP_ADD, two, op2(b, GLINT_OP_MUL, two, z)), // a subexpression used twice
                  "r0 = mul p.x p.y\nr0 = muladd p.y p.z r0\nr0 = muladd r0 p.z r0\nreturn r0\n");
    const glint_value outputs[] = { op2(b, GLINT_OP_ADD, z, product), product, z }; // the product is an output too
    glint_program *p = finish(b, outputs, 3);
    assert_int_equal(glint_program_length(p), 2);
    glint_program_release(p);
    glint_builder_destroy(b);
}

static void test_numbers(void **state)
{
    (void)state;
    glint_builder *b = new_builder(GLINT_PROGRAM_PATTERN);
    const glint_value x = read_input(b, GLINT_INPUT_P_X), tenth = number(b, 0.1), fifth = number(b, 0.2);
    const glint_value sum = op2(b, GLINT_OP_ADD, tenth, fifth);
    double got, color[3];
    assert_true(glint_builder_is_number(b, sum, &got) && got == 0.1 + 0.2);
    assert_int_equal(op2(b, GLINT_OP_MUL, x, number(b, 1)), x);
    assert_int_equal(op2(b, GLINT_OP_SUB, x, number(b, 0)), x);
    assert_int_not_equal(op2(b, GLINT_OP_ADD, x, number(b, 0)), x); // x + 0 is not x: the sum turns -0 into 0
    assert_int_equal(op3(b, GLINT_OP_SELECT, number(b, 2), tenth, x), tenth);
    assert_int_not_equal(number(b, 0.0), number(b, -0.0));
    const glint_value outputs[] = { tenth, sum, op2(b, GLINT_OP_SIN, fifth, 0) };
    glint_program *p = finish(b, outputs, 3);
    assert_true(glint_program_constant(p, color) && color[0] == 0.1 && color[1] == 0.1 + 0.2);
    assert_true(fabs(color[2] - sin(0.2)) < 1e-16);
    assert_int_equal(glint_program_length(p), 0);
    glint_program_release(p);
    p = finish(b, &x, 1);
    assert_false(glint_program_constant(p, color));
    glint_program_release(p);
    glint_builder_destroy(b);
}

/// Makes sin(x + i) for many i, then the sum of these sines.
static glint_value sum_of_sines(glint_builder *b, int count, glint_value *sine)
{
    const glint_value x = read_input(b, GLINT_INPUT_P_X);
    for (int i = 0; i < count; i++)
        sine[i] = op2(b, GLINT_OP_SIN, op2(b, GLINT_OP_ADD, x, number(b, i)), 0);
    glint_value sum = sine[0];
    for (int i = 1; i < count; i++)
        sum = op2(b, GLINT_OP_ADD, sum, sine[i]);
    return sum;
}

static void expect_failure(glint_status status, const char *part)
{
    assert_int_equal(status, GLINT_ERR_INVALID);
    if (!strstr(error.message, part))
        fail_msg("'%s' has no '%s'", error.message, part);
}

/// A sum of sines needs a row for each sine in the order of definition, but only two rows when ordered by use. When
/// all sines are used again after the sum, no order helps, and the builder refuses.
static void test_rows(void **state)
{
    (void)state;
    glint_value sine[300];
    glint_builder *b = new_builder(GLINT_PROGRAM_PATTERN);
    const glint_value sum = sum_of_sines(b, 300, sine);
    glint_program *p = finish(b, &sum, 1);
    assert_in_range(glint_program_rows(p), 1, 3);
    assert_int_equal(glint_program_length(p), 899);
    glint_program_release(p);
    glint_value twice = sum;
    for (int i = 0; i < 300; i++)
        twice = op2(b, GLINT_OP_DIV, twice, op2(b, GLINT_OP_MAX, sine[i], sum));
    expect_failure(glint_builder_finish(b, &twice, 1, &p, &error), "256 intermediate values");
    glint_builder_destroy(b);
}

static void test_limits(void **state)
{
    (void)state;
    glint_program *p;
    glint_builder *b = new_builder(GLINT_PROGRAM_PATTERN);
    glint_value v = read_input(b, GLINT_INPUT_P_X), out;
    for (int i = 0; i < GLINT_PROGRAM_LENGTH_MAX; i++)
        v = op2(b, GLINT_OP_SQRT, v, 0);
    p = finish(b, &v, 1);
    assert_int_equal(glint_program_length(p), GLINT_PROGRAM_LENGTH_MAX);
    glint_program_release(p);
    v = op2(b, GLINT_OP_SQRT, v, 0);
    expect_failure(glint_builder_finish(b, &v, 1, &p, &error), "at most 4096 instructions expected, got 4097");
    glint_status status = GLINT_OK;
    for (int i = 0; i < 100000 && !status; i++)
        status = glint_builder_number(b, i, &out, &error);
    expect_failure(status, "at most 65536 values");
    glint_builder_destroy(b);
}

static void test_errors(void **state)
{
    (void)state;
    glint_builder *b = new_builder(GLINT_PROGRAM_PATTERN), *s = new_builder(GLINT_PROGRAM_SHADER);
    glint_program *p;
    const glint_value x = read_input(b, GLINT_INPUT_P_X), wrong[] = { x, 77 }, many[] = { x, x, x, x, x, x };
    glint_value out = 12345;
    expect_failure(glint_builder_op(b, GLINT_OP_ADD, wrong, &out, &error),
                   "add: operand 2 is not a value of this builder");
    expect_failure(glint_builder_op(b, (glint_op)-1, wrong, &out, &error), "op: ");
    expect_failure(glint_builder_op(b, GLINT_OP_TEXEL, wrong, &out, &error), "op: ");
    expect_failure(glint_builder_input(b, GLINT_INPUT_LIGHT_R, &out, &error), "a pattern has no light.r");
    expect_failure(glint_builder_input(s, GLINT_INPUT_COUNT, &out, &error), "input: ");
    assert_int_equal(out, 12345);
    assert_int_equal(glint_builder_input(s, GLINT_INPUT_LIGHT_R, &out, &error), GLINT_OK);
    expect_failure(glint_builder_finish(b, many, 2, &p, &error), "1 or 3 outputs of a pattern expected, got 2");
    expect_failure(glint_builder_finish(s, many, 1, &p, &error), "3 or 6 outputs of a shader expected, got 1");
    expect_failure(glint_builder_finish(b, &wrong[1], 1, &p, &error), "outputs: number 1");
    expect_failure(glint_builder_create((glint_program_kind)2, &b, &error), "kind: ");
    assert_null(glint_op_info_of(GLINT_OP_COUNT));
    assert_null(glint_input_name(GLINT_INPUT_COUNT));
    for (int op = 0; op < GLINT_OP_COUNT; op++)
        assert_true(glint_op_info_of((glint_op)op)->operands >= 1 && glint_op_info_of((glint_op)op)->results >= 1);
    glint_builder_destroy(b);
    glint_builder_destroy(s);
    glint_builder_destroy(NULL);
    glint_program_release(NULL);
}

/// Makes the program x op k.
static glint_program *little_program(glint_op op, double k)
{
    glint_builder *b = new_builder(GLINT_PROGRAM_PATTERN);
    const glint_value out = op2(b, op, read_input(b, GLINT_INPUT_P_X), number(b, k));
    glint_program *p = finish(b, &out, 1);
    glint_builder_destroy(b);
    return p;
}

static void test_keys(void **state)
{
    (void)state;
    glint_program *p[] = { little_program(GLINT_OP_ADD, 2), little_program(GLINT_OP_ADD, 2),
                           little_program(GLINT_OP_ADD, 3), little_program(GLINT_OP_MUL, 2) };
    assert_true(glint_key_equal(p[0]->structure, p[1]->structure) && glint_key_equal(p[0]->numbers, p[1]->numbers));
    assert_true(glint_key_equal(p[0]->structure, p[2]->structure) && !glint_key_equal(p[0]->numbers, p[2]->numbers));
    assert_true(!glint_key_equal(p[0]->structure, p[3]->structure) && glint_key_equal(p[0]->numbers, p[3]->numbers));
    for (int i = 0; i < 4; i++)
        glint_program_release(p[i]);
}

/// Only the second of the three results of noise3 is used; a row is reused after its last reader.
static void test_results(void **state)
{
    (void)state;
    glint_builder *b = new_builder(GLINT_PROGRAM_PATTERN);
    glint_value operands[3], out[3];
    for (int k = 0; k < 3; k++)
        operands[k] = op2(b, GLINT_OP_MUL, read_input(b, (glint_input)k), number(b, 3));
    assert_int_equal(glint_builder_op(b, GLINT_OP_NOISE3, operands, out, &error), GLINT_OK);
    glint_program *p = finish(b, &out[1], 1);
    assert_int_equal(glint_program_rows(p), 3);
    double inputs[GLINT_INPUT_COUNT] = { 0.3, 0.7, -1.2 }, got, folded[GLINT_RESULTS_MAX];
    double scaled[GLINT_OPERANDS_MAX] = { 3 * inputs[0], 3 * inputs[1], 3 * inputs[2] };
    assert_int_equal(glint_program_evaluate(p, inputs, &got, &error), GLINT_OK);
    glint_fold(GLINT_OP_NOISE3, NULL, scaled, folded);
    assert_true(got == folded[1] && folded[0] != folded[1] && folded[1] != folded[2]);
    glint_program_release(p);
    glint_builder_destroy(b);
}

enum { CHAIN_INPUTS = 9 };
static const glint_input chain_inputs[CHAIN_INPUTS] = { GLINT_INPUT_N_X, GLINT_INPUT_N_Y, GLINT_INPUT_N_Z, GLINT_INPUT_V_X, GLINT_INPUT_V_Y,
                                                        GLINT_INPUT_V_Z, GLINT_INPUT_L_X, GLINT_INPUT_L_Y, GLINT_INPUT_L_Z };

static double chain_factor(int i) { return 1 + i % 7; }

/// Makes a program that multiplies the light by `length` factors 1 + c x. The x cycle through the inputs.
static glint_program *make_chain(int length)
{
    glint_builder *b = new_builder(GLINT_PROGRAM_SHADER);
    glint_value product = number(b, 1), out[3];
    for (int i = 0; i < length; i++) {
        const glint_value x = read_input(b, chain_inputs[i % CHAIN_INPUTS]);
        product = op2(b, GLINT_OP_MUL, product, op3(b, GLINT_OP_MULADD, x, number(b, chain_factor(i)), number(b, 1)));
    }
    for (int c = 0; c < 3; c++)
        out[c] = op2(b, GLINT_OP_MUL, product, read_input(b, (glint_input)(GLINT_INPUT_LIGHT_R + c)));
    glint_program *program = finish(b, out, 3);
    glint_builder_destroy(b);
    return program;
}

/// Sums the derivatives of the chain's light with respect to its inputs, in the first lane.
/// Input k changes by weight[k].
static void sum_gradient(const glint_gradient *gradient, double (*inputs)[GLINT_GROUP], double (*weights)[GLINT_GROUP],
                         double (*sum)[GLINT_GROUP])
{
    const uint16_t first_lane = 1;
    for (uint32_t from = 0; from < gradient->count; from += gradient->each) {
        glint_program_sums sums = { .sum = { sum[0], sum[1], sum[2] } };
        glint_program_args args = { .code = &gradient->programs[from / gradient->each]->code, .group_count = 1, .wanted = &first_lane,
                                    .sums = &sums, .sums_count = 1, .sums_alone = true };
        for (int k = 0; k < GLINT_INPUT_COUNT; k++)
            args.input[k] = inputs[k];
        for (uint32_t n = 0; n < args.code->output_count; n++) {
            sums.by[n] = weights[gradient->of[from + n].input];
            sums.sum_of[n] = (uint8_t)gradient->of[from + n].channel;
        }
        glint_stages_ref.program(&args);
    }
}

static void check_chain(int length, const glint_gradient *gradient)
{
    double inputs[GLINT_INPUT_COUNT][GLINT_GROUP] = { { 0 } }, weights[GLINT_INPUT_COUNT][GLINT_GROUP] = { { 0 } };
    double sum[3][GLINT_GROUP] = { { 0 } }, product = 1, slope = 0;
    for (int k = 0; k < CHAIN_INPUTS; k++) {
        inputs[chain_inputs[k]][0] = 0.002 * (k - 4);
        weights[chain_inputs[k]][0] = k + 1;
    }
    for (int i = 0; i < length; i++) {
        const double factor = 1 + chain_factor(i) * inputs[chain_inputs[i % CHAIN_INPUTS]][0];
        product *= factor;
        slope += chain_factor(i) * weights[chain_inputs[i % CHAIN_INPUTS]][0] / factor;
    }
    for (int c = 0; c < 3; c++)
        inputs[GLINT_INPUT_LIGHT_R + c][0] = c + 1;
    sum_gradient(gradient, inputs, weights, sum);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(sum[c][0] / ((c + 1) * product * slope) - 1) < 1e-12);
}

/// One program computes all derivatives. If it would be too long, several programs do,
/// and beyond that the gradient is refused.
static void test_gradients(void **state)
{
    (void)state;
    int whole = 0, parts = 0;
    glint_status status = GLINT_OK;
    for (int length = 10; !status; length += length / 10) {
        glint_program *chain = make_chain(length);
        glint_gradient gradient;
        status = glint_shader_gradient(chain, chain->inputs, &gradient, &error);
        if (!status) {
            check_chain(length, &gradient);
            whole += gradient.each == gradient.count;
            parts += gradient.each == GLINT_GRADIENT_PART;
        }
        glint_gradient_release(&gradient);
        glint_program_release(chain);
    }
    assert_int_equal(status, GLINT_ERR_INVALID);
    assert_true(whole > 0 && parts > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_listing), cmocka_unit_test(test_pairs),   cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_rows),    cmocka_unit_test(test_limits),  cmocka_unit_test(test_errors),
        cmocka_unit_test(test_keys),    cmocka_unit_test(test_results),
        cmocka_unit_test(test_gradients),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
