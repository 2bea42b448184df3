#include "engine/render/program/weigh.h"

#include "engine/base/maker.h"
#include "engine/render/program/builder.h"

#define LEAST_SHARE 0x1p-100 ///< a surface with a smaller share is invisible; divisors are at least this

static glint_maker begin(glint_program_kind kind, glint_error *error)
{
    glint_maker m = { .error = error };
    m.status = glint_builder_create(kind, &m.builder, error);
    return m;
}

static glint_status finish(glint_maker *m, const glint_value *outputs, size_t count, glint_program **out)
{
    if (!m->status)
        m->status = glint_program_make(m->builder, outputs, count, out, m->error);
    glint_builder_destroy(m->builder);
    return m->status;
}

/// Returns the value of the share, clamped to 0 .. 1.
static glint_value share_of(glint_maker *m, const glint_share *share)
{
    glint_value given[GLINT_PROGRAM_OUTPUTS_MAX] = { 0 };
    if (!share->program)
        return glint_maker_number(m, share->number);
    if (!m->status)
        m->status = glint_builder_load(m->builder, share->program, NULL, given, m->error);
    const glint_value zero = glint_maker_number(m, 0), least = glint_maker_with(m, GLINT_OP_MIN, given[0], 1);
    const glint_value above = glint_maker_apply(m, GLINT_OP_LESS, zero, given[0]);
    return glint_maker_apply3(m, GLINT_OP_SELECT, above, least, zero);
}

glint_status glint_share_rest(const glint_share *share, glint_program **out, glint_error *error)
{
    glint_maker m = begin(GLINT_PROGRAM_PATTERN, error);
    const glint_value one = glint_maker_number(&m, 1), value = share_of(&m, share);
    const glint_value rest = glint_maker_apply(&m, GLINT_OP_SUB, one, value);
    return finish(&m, &rest, 1, out);
}

glint_status glint_share_color(const glint_share *share, const double color[3], glint_program **out, glint_error *error)
{
    const bool grey = color[0] == color[1] && color[1] == color[2];
    glint_maker m = begin(GLINT_PROGRAM_PATTERN, error);
    const glint_value value = share_of(&m, share);
    glint_value outputs[3];
    for (int c = 0; c < 3; c++)
        outputs[c] = glint_maker_with(&m, GLINT_OP_MUL, value, color[c]);
    return finish(&m, outputs, grey ? 1 : 3, out);
}

/// Fills `instead` with the values that replace the reflectances among the inputs of a shader; 0: the input is not
/// replaced.
static void divide_inputs(glint_maker *m, uint32_t inputs, glint_value share, glint_value instead[GLINT_INPUT_COUNT])
{
    const glint_value divisor = glint_maker_with(m, GLINT_OP_MAX, share, LEAST_SHARE);
    for (int input = GLINT_INPUT_KD_R; input <= GLINT_INPUT_KS_B; input++) {
        if (inputs >> input & 1) {
            const glint_value given = glint_maker_input(m, (glint_input)input);
            instead[input] = glint_maker_apply(m, GLINT_OP_DIV, given, divisor);
        }
    }
}

glint_status glint_share_program(const glint_share *share, const glint_program *program, glint_program **out,
                                 glint_error *error)
{
    glint_maker m = begin(program->kind, error);
    glint_value instead[GLINT_INPUT_COUNT] = { 0 }, outputs[GLINT_PROGRAM_OUTPUTS_MAX] = { 0 };
    const glint_value value = share_of(&m, share);
    if (program->kind == GLINT_PROGRAM_SHADER)
        divide_inputs(&m, program->inputs, value, instead);
    if (!m.status)
        m.status = glint_builder_load(m.builder, program, instead, outputs, error);
    for (uint32_t k = 0; k < program->code.output_count; k++)
        outputs[k] = glint_maker_apply(&m, GLINT_OP_MUL, outputs[k], value);
    return finish(&m, outputs, program->code.output_count, out);
}
