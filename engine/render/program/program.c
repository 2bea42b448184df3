/// glint_program: its properties, and whether its code may be run.
#include "engine/render/program/program.h"

#include "engine/base/status.h"

#include <stdlib.h>

glint_program *glint_program_retain(glint_program *program)
{
    if (program)
        atomic_fetch_add(&program->references, 1);
    return program;
}

void glint_program_release(glint_program *program)
{
    if (!program || atomic_fetch_sub(&program->references, 1) > 1)
        return;
    for (uint32_t i = 0; i < program->texture_count; i++)
        glint_texture_release(program->textures[i]);
    for (uint32_t i = 0; program->tangents && i < GLINT_PARAMETERS_MAX; i++)
        glint_program_release(program->tangents[i]);
    for (uint32_t i = 0; i < GLINT_ATTACHED_MAX && program->attached[i]; i++)
        program->attached[i]->release(program->attached[i]);
    free(program->tangents);
    free(program->textures);
    free((void *)program->code.textures);
    free((void *)program->code.instructions);
    free((void *)program->code.numbers);
    free(program);
}

glint_program_kind glint_program_kind_of(const glint_program *program) { return program ? program->kind : 0; }

size_t glint_program_output_count(const glint_program *program) { return program ? program->code.output_count : 0; }

size_t glint_program_length(const glint_program *program) { return program ? program->code.length : 0; }

size_t glint_program_rows(const glint_program *program) { return program ? program->code.row_count : 0; }

bool glint_program_reads(const glint_program *program, glint_input input)
{
    if (!program)
        return false;
    return (unsigned)input < GLINT_INPUT_COUNT && (program->inputs >> input & 1);
}

void glint_program_structure(const glint_program *program, uint64_t key[2])
{
    if (!program || !key)
        return;
    key[0] = program->structure.high;
    key[1] = program->structure.low;
}

bool glint_program_constant(const glint_program *program, double *outputs)
{
    if (!program || !outputs)
        return false;
    const glint_program_code *code = &program->code;
    for (uint32_t k = 0; k < code->output_count; k++)
        if (code->outputs[k] < GLINT_ROW_NUMBER)
            return false;
    for (uint32_t k = 0; k < code->output_count; k++)
        outputs[k] = code->numbers[code->outputs[k] - GLINT_ROW_NUMBER][0];
    return true;
}

// ---- Checking the code --------------------------------------------------------------------------------------------

typedef struct known {
    uint64_t written[GLINT_PROGRAM_ROWS_MAX / 64];
    uint32_t rows, numbers;
    uint64_t inputs;
} known;

static bool can_be_read(const known *k, uint32_t row)
{
    if (row >= GLINT_ROW_NUMBER)
        return row - GLINT_ROW_NUMBER < k->numbers;
    if (row >= GLINT_ROW_INPUT)
        return row - GLINT_ROW_INPUT < GLINT_CODE_INPUTS && (k->inputs >> (row - GLINT_ROW_INPUT) & 1);
    return row < k->rows && (k->written[row / 64] >> row % 64 & 1);
}

static glint_status check_instruction(known *k, const glint_program_code *code, uint32_t at, uint32_t texture_count,
                                      glint_error *error)
{
    const glint_instruction *in = &code->instructions[at];
    const glint_op_info *info = glint_op_info_of((glint_op)in->op);
    if (!info || in->operands != info->operands || in->results != info->results)
        return glint_fail(error, GLINT_ERR_INVALID, "instruction %u: no such operation: %u", at, in->op);
    if (in->op >= GLINT_OP_TEXEL && in->texture >= texture_count)
        return glint_fail(error, GLINT_ERR_INVALID, "instruction %u: no such texture: %u", at, in->texture);
    for (uint32_t i = 0; i < info->operands; i++)
        if (!can_be_read(k, in->in[i]))
            return glint_fail(error, GLINT_ERR_INVALID, "instruction %u: nothing to read in row %u", at, in->in[i]);
    for (uint32_t i = 0; i < info->results; i++) {
        if (in->out[i] >= k->rows)
            return glint_fail(error, GLINT_ERR_INVALID, "instruction %u: no such row to write: %u", at, in->out[i]);
        for (uint32_t j = 0; j < i; j++)
            if (in->out[j] == in->out[i])
                return glint_fail(error, GLINT_ERR_INVALID, "instruction %u: two results in row %u", at, in->out[i]);
        k->written[in->out[i] / 64] |= (uint64_t)1 << in->out[i] % 64;
    }
    return GLINT_OK;
}

glint_status glint_code_check(const glint_program_code *code, uint32_t number_count, uint32_t texture_count,
                              uint64_t inputs, glint_error *error)
{
    known k = { .rows = code->row_count, .numbers = number_count, .inputs = inputs };
    glint_status status = GLINT_OK;
    if (code->length > GLINT_PROGRAM_LENGTH_MAX || code->row_count > GLINT_PROGRAM_ROWS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "program: at most %d instructions and %d rows expected, got %u and %u",
                          GLINT_PROGRAM_LENGTH_MAX, GLINT_PROGRAM_ROWS_MAX, code->length, code->row_count);
    if (code->output_count < 1 || code->output_count > GLINT_CODE_OUTPUTS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "program: 1 .. %d outputs expected, got %u", GLINT_CODE_OUTPUTS_MAX,
                          code->output_count);
    for (uint32_t at = 0; at < code->length && !status; at++)
        status = check_instruction(&k, code, at, texture_count, error);
    for (uint32_t i = 0; i < code->output_count && !status; i++)
        if (!can_be_read(&k, code->outputs[i]))
            status = glint_fail(error, GLINT_ERR_INVALID, "output %u: nothing to read in row %u", i, code->outputs[i]);
    return status;
}
