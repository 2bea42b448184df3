/// Adds the values of a finished program to a builder.
#include "engine/program/builder.h"

/// Returns the value of an operand: a row, an input or a number. row: the value in each row.
static glint_status value_in(glint_builder *builder, const glint_program_code *code, const glint_value *row,
                             const glint_value *instead, uint32_t from, glint_value *out, glint_error *error)
{
    if (from < GLINT_ROW_INPUT) {
        *out = row[from];
        return GLINT_OK;
    }
    if (from >= GLINT_ROW_NUMBER)
        return glint_builder_number(builder, code->numbers[from - GLINT_ROW_NUMBER][0], out, error);
    if (instead && instead[from - GLINT_ROW_INPUT]) {
        *out = instead[from - GLINT_ROW_INPUT];
        return GLINT_OK;
    }
    return glint_builder_input(builder, (glint_input)(from - GLINT_ROW_INPUT), out, error);
}

static glint_status load_instruction(glint_builder *builder, const glint_program *program, const glint_instruction *in,
                                     const glint_value *instead, glint_value *row, glint_error *error)
{
    glint_value operands[GLINT_OPERANDS_MAX], results[GLINT_RESULTS_MAX];
    glint_status status = GLINT_OK;
    uint32_t texture = 0;
    for (uint32_t k = 0; k < in->operands && !status; k++)
        status = value_in(builder, &program->code, row, instead, in->in[k], &operands[k], error);
    if (in->op >= GLINT_OP_TEXEL && !status)
        status = glint_builder_texture(builder, program->textures[in->texture], &texture, error);
    if (!status)
        status = glint_builder_add(builder, (glint_op)in->op, texture, operands, results, error);
    for (uint32_t k = 0; k < in->results && !status; k++)
        row[in->out[k]] = results[k];
    return status;
}

glint_status glint_builder_load(glint_builder *builder, const glint_program *program, const glint_value *instead,
                                glint_value outputs[GLINT_PROGRAM_OUTPUTS_MAX], glint_error *error)
{
    const glint_program_code *code = &program->code;
    glint_value row[GLINT_PROGRAM_ROWS_MAX] = { 0 };
    glint_status status = GLINT_OK;
    for (uint32_t at = 0; at < code->length && !status; at++)
        status = load_instruction(builder, program, &code->instructions[at], instead, row, error);
    for (uint32_t k = 0; k < code->output_count && !status; k++)
        status = value_in(builder, code, row, instead, code->outputs[k], &outputs[k], error);
    return status;
}
