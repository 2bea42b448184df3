#include "engine/program/weigh.h"

#include "engine/program/builder.h"

#define LEAST_SHARE 0x1p-100 ///< a surface shows nothing below it; divisions by the share use at least this

/// A program that is being built. After the first failure its values are meaningless.
typedef struct maker {
    glint_builder *builder;
    glint_status status;
    glint_error *error;
} maker;

static glint_value number(maker *m, double x)
{
    glint_value out = 0;
    if (!m->status)
        m->status = glint_builder_number(m->builder, x, &out, m->error);
    return out;
}

static glint_value op(maker *m, glint_op code, glint_value a, glint_value b, glint_value c)
{
    const glint_value operands[] = { a, b, c };
    glint_value out = 0;
    if (!m->status)
        m->status = glint_builder_add(m->builder, code, 0, operands, &out, m->error);
    return out;
}

static maker begin(glint_program_kind kind, glint_error *error)
{
    maker m = { .error = error };
    m.status = glint_builder_create(kind, &m.builder, error);
    return m;
}

static glint_status finish(maker *m, const glint_value *outputs, size_t count, glint_program **out)
{
    if (!m->status)
        m->status = glint_program_make(m->builder, outputs, count, out, m->error);
    glint_builder_destroy(m->builder);
    return m->status;
}

/// Returns the value of the share, within 0 .. 1.
static glint_value share_of(maker *m, const glint_share *share)
{
    glint_value given[GLINT_PROGRAM_OUTPUTS_MAX] = { 0 };
    if (!share->program)
        return number(m, share->number);
    if (!m->status)
        m->status = glint_builder_load(m->builder, share->program, NULL, given, m->error);
    const glint_value zero = number(m, 0), least = op(m, GLINT_OP_MIN, given[0], number(m, 1), 0);
    return op(m, GLINT_OP_SELECT, op(m, GLINT_OP_LESS, zero, given[0], 0), least, zero);
}

glint_status glint_share_rest(const glint_share *share, glint_program **out, glint_error *error)
{
    maker m = begin(GLINT_PROGRAM_PATTERN, error);
    const glint_value value = op(&m, GLINT_OP_SUB, number(&m, 1), share_of(&m, share), 0);
    return finish(&m, &value, 1, out);
}

glint_status glint_share_color(const glint_share *share, const double color[3], glint_program **out, glint_error *error)
{
    const bool grey = color[0] == color[1] && color[1] == color[2];
    maker m = begin(GLINT_PROGRAM_PATTERN, error);
    const glint_value value = share_of(&m, share);
    glint_value outputs[3];
    for (int c = 0; c < 3; c++)
        outputs[c] = op(&m, GLINT_OP_MUL, number(&m, color[c]), value, 0);
    return finish(&m, outputs, grey ? 1 : 3, out);
}

/// Fills `instead` with the values that replace the reflectances among the inputs of a shader; 0: the input is not replaced.
static void divide_inputs(maker *m, uint32_t inputs, glint_value share, glint_value instead[GLINT_INPUT_COUNT])
{
    const glint_value divisor = op(m, GLINT_OP_MAX, share, number(m, LEAST_SHARE), 0);
    for (int input = GLINT_INPUT_KD_R; input <= GLINT_INPUT_KS_B; input++) {
        glint_value given = 0;
        if (!(inputs >> input & 1) || m->status)
            continue;
        m->status = glint_builder_input(m->builder, (glint_input)input, &given, m->error);
        instead[input] = op(m, GLINT_OP_DIV, given, divisor, 0);
    }
}

glint_status glint_share_program(const glint_share *share, const glint_program *program, glint_program **out,
                                 glint_error *error)
{
    maker m = begin(program->kind, error);
    glint_value instead[GLINT_INPUT_COUNT] = { 0 }, outputs[GLINT_PROGRAM_OUTPUTS_MAX] = { 0 };
    const glint_value value = share_of(&m, share);
    if (program->kind == GLINT_PROGRAM_SHADER)
        divide_inputs(&m, program->inputs, value, instead);
    if (!m.status)
        m.status = glint_builder_load(m.builder, program, instead, outputs, error);
    for (uint32_t k = 0; k < program->code.output_count; k++)
        outputs[k] = op(&m, GLINT_OP_MUL, outputs[k], value, 0);
    return finish(&m, outputs, program->code.output_count, out);
}
