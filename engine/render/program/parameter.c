/// Numbers that change with parameters. A program stores them as numbers, and its tangents compute the derivatives of
/// its outputs by each parameter.
#include "engine/render/program/builder.h"

#include "engine/base/status.h"

#include <stdlib.h>
#include <string.h>

glint_status glint_builder_parameter(glint_builder *builder, double number, const double *slopes, size_t count,
                                     glint_value *out, glint_error *error)
{
    GLINT_REFUSE_NULL(builder, error);
    GLINT_REFUSE_NULL(out, error);
    double all[GLINT_PARAMETERS_MAX] = { 0 };
    uint32_t i = 0;
    if (count > GLINT_PARAMETERS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "count: at most %d slopes expected, got %zu", GLINT_PARAMETERS_MAX, count);
    if (count)
        GLINT_REFUSE_NULL(slopes, error);
    memcpy(all, slopes, count * sizeof *slopes);
    while (i < builder->parameter_count && memcmp(builder->parameters[i], all, sizeof all) != 0)
        i++;
    if (i == builder->parameter_count) {
        double(*parameters)[GLINT_PARAMETERS_MAX] = realloc(builder->parameters, (i + 1) * sizeof *parameters);
        if (!parameters)
            return glint_fail_nomem(error);
        builder->parameters = parameters;
        memcpy(parameters[builder->parameter_count++], all, sizeof all);
    }
    return glint_builder_intern(builder, GLINT_SSA_PARAMETER, i, number, out, error);
}

/// Copies one node of another builder into `to`. open: parameters stay parameters.
static glint_status copy_node(const glint_builder *from, uint32_t i, bool open, glint_builder *to, glint_value *map,
                              glint_error *error)
{
    const glint_ssa_node *node = &from->nodes[i];
    glint_value operands[GLINT_OPERANDS_MAX], results[GLINT_RESULTS_MAX];
    uint32_t texture = 0;
    if (node->op == GLINT_SSA_INPUT)
        return glint_builder_input(to, (glint_input)node->operand[0], &map[i], error);
    if (node->op == GLINT_SSA_PARAMETER && open)
        return glint_builder_intern(to, GLINT_SSA_PARAMETER, node->operand[0], node->number, &map[i], error);
    if (!glint_ssa_is_op(node))
        return glint_builder_number(to, node->number, &map[i], error);
    if (node->part > 0) // already added, together with the first result
        return GLINT_OK;
    const glint_op_info *info = glint_op_info_of((glint_op)node->op);
    const bool picture = node->op == GLINT_OP_TEXEL || node->op == GLINT_OP_TEXEL_SLOPE;
    glint_status status = picture ? glint_builder_texture(to, from->textures[node->texture], &texture, error) : GLINT_OK;
    for (uint32_t k = 0; k < info->operands; k++)
        operands[k] = map[node->operand[k]];
    if (!status)
        status = glint_builder_add(to, (glint_op)node->op, texture, operands, results, error);
    for (uint32_t k = 0; k < info->results && !status; k++)
        map[i + k] = results[k];
    return status;
}

glint_status glint_builder_copy(const glint_builder *from, bool open, glint_builder **out, glint_value **map,
                                glint_error *error)
{
    glint_status status = glint_builder_create(from->kind, out, error);
    if (status)
        return status;
    (*out)->plain = from->plain;
    *map = malloc((from->count + GLINT_RESULTS_MAX) * sizeof **map);
    if (!*map)
        status = glint_fail_nomem(error);
    for (uint32_t i = 0; i < from->count && !status; i++)
        status = copy_node(from, i, open, *out, *map, error);
    return status;
}

glint_status glint_builder_close(const glint_builder *builder, const glint_value *outputs, size_t count,
                                 glint_program **out, glint_error *error)
{
    glint_builder *closed = NULL;
    glint_value *map = NULL, values[GLINT_PROGRAM_OUTPUTS_MAX];
    glint_status status = glint_builder_copy(builder, false, &closed, &map, error);
    for (size_t k = 0; k < count && !status; k++) {
        if (outputs[k] >= builder->count)
            status = glint_fail(error, GLINT_ERR_INVALID, "outputs: number %zu is not a value of this builder", k + 1);
        else
            values[k] = map[outputs[k]];
    }
    if (!status)
        status = glint_program_make(closed, values, count, out, error);
    free(map);
    glint_builder_destroy(closed);
    return status;
}

static bool is_level(const glint_builder *builder, size_t parameter)
{
    bool level = true;
    for (uint32_t i = 0; i < builder->parameter_count; i++)
        level = level && builder->parameters[i][parameter] == 0;
    return level;
}

glint_status glint_builder_finish_open(const glint_builder *builder, const glint_value *outputs, size_t count,
                                       glint_program **out, glint_error *error)
{
    glint_program *program;
    glint_status status = glint_builder_close(builder, outputs, count, &program, error);
    if (status)
        return status;
    program->tangents = calloc(GLINT_PARAMETERS_MAX, sizeof *program->tangents);
    if (!program->tangents)
        status = glint_fail_nomem(error);
    for (size_t k = 0; k < GLINT_PARAMETERS_MAX && !status; k++)
        if (!is_level(builder, k))
            status = glint_builder_tangent(builder, outputs, count, k, &program->tangents[k], error);
    if (status)
        glint_program_release(program);
    else
        *out = program;
    return status;
}

const glint_program *glint_program_tangent(const glint_program *program, size_t parameter)
{
    if (!program)
        return NULL;
    return program->tangents && parameter < GLINT_PARAMETERS_MAX ? program->tangents[parameter] : NULL;
}
