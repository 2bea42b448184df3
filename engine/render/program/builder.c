/// glint_builder: values in static single assignment. Operations on numbers are folded and equal values are shared
/// when they are added.
#include "engine/render/program/builder.h"

#include "engine/base/alloc.h"
#include "engine/base/status.h"

#include <stdlib.h>
#include <string.h>

glint_status glint_builder_create(glint_program_kind kind, glint_builder **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    if ((unsigned)kind > GLINT_PROGRAM_SHADER)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: pattern or shader expected, got %d", (int)kind);
    if (!GLINT_WITH(PROGRAM))
        return glint_fail(error, GLINT_ERR_UNSUPPORTED,
                          "this glint was built without patterns, shaders and textures (WITHOUT=PROGRAM)");
    glint_builder *builder = calloc(1, sizeof *builder);
    if (!builder)
        return glint_fail_nomem(error);
    builder->kind = kind;
    *out = builder;
    return GLINT_OK;
}

void glint_builder_destroy(glint_builder *builder)
{
    if (!builder)
        return;
    for (uint32_t i = 0; i < builder->texture_count; i++)
        glint_texture_release(builder->textures[i]);
    free(builder->textures);
    free(builder->nodes);
    free(builder->slots);
    free(builder->parameters);
    free(builder);
}

// ---- Existing values ----------------------------------------------------------------------------------------------

static uint64_t hash_node(const glint_ssa_node *node)
{
    uint64_t h = node->op * 0x9e3779b97f4a7c15u + node->texture, number;
    memcpy(&number, &node->number, sizeof number);
    for (int k = 0; k < GLINT_OPERANDS_MAX; k++)
        h = (h ^ node->operand[k]) * 0xbf58476d1ce4e5b9u;
    h = (h ^ number) * 0x94d049bb133111ebu;
    return h ^ h >> 31;
}

static bool same_node(const glint_ssa_node *a, const glint_ssa_node *b)
{
    return a->op == b->op && a->texture == b->texture && memcmp(a->operand, b->operand, sizeof a->operand) == 0 &&
           memcmp(&a->number, &b->number, sizeof a->number) == 0;
}

/// Returns the hash slot of a node: the slot that holds an equal node, or the free slot for a new one.
static uint32_t *find_slot(const glint_builder *builder, const glint_ssa_node *node)
{
    uint32_t at = (uint32_t)hash_node(node) & (builder->slot_count - 1);
    while (builder->slots[at] && !same_node(&builder->nodes[builder->slots[at] - 1], node))
        at = (at + 1) & (builder->slot_count - 1);
    return &builder->slots[at];
}

/// Reserves space for GLINT_RESULTS_MAX more nodes and a hash slot.
static glint_status ensure_capacity(glint_builder *builder, glint_error *error)
{
    if (builder->count + GLINT_RESULTS_MAX <= builder->capacity)
        return GLINT_OK;
    if (builder->count + GLINT_RESULTS_MAX > GLINT_VALUES_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "program: at most %u values expected, numbers included",
                          GLINT_VALUES_MAX);
    const uint32_t capacity = builder->capacity ? 2 * builder->capacity : 64;
    glint_ssa_node *nodes = realloc(builder->nodes, capacity * sizeof *nodes);
    if (!nodes)
        return glint_fail_nomem(error);
    builder->nodes = nodes;
    uint32_t *slots = calloc(2 * (size_t)capacity, sizeof *slots);
    if (!slots)
        return glint_fail_nomem(error);
    free(builder->slots);
    builder->slots = slots;
    builder->slot_count = 2 * capacity;
    builder->capacity = capacity;
    for (uint32_t i = 0; i < builder->count; i++)
        if (nodes[i].part == 0)
            *find_slot(builder, &nodes[i]) = i + 1;
    return GLINT_OK;
}

/// Returns the value of an equal node if there is one, otherwise adds the node. The other results follow the first one.
static glint_status share(glint_builder *builder, const glint_ssa_node *node, uint32_t results, glint_value *out,
                          glint_error *error)
{
    const glint_status status = ensure_capacity(builder, error);
    if (status)
        return status;
    uint32_t *slot = find_slot(builder, node);
    if (!*slot || (builder->plain && glint_ssa_is_op(node))) {
        *slot = builder->count + 1;
        for (uint32_t k = 0; k < results; k++) {
            builder->nodes[builder->count] = *node;
            builder->nodes[builder->count++].part = (uint16_t)k;
        }
    }
    for (uint32_t k = 0; k < results; k++)
        out[k] = *slot - 1 + k;
    return GLINT_OK;
}

glint_status glint_builder_intern(glint_builder *builder, uint16_t kind, uint32_t operand, double number,
                                  glint_value *out, glint_error *error)
{
    const glint_ssa_node node = { .op = kind, .operand = { operand }, .number = number };
    return share(builder, &node, 1, out, error);
}

glint_status glint_builder_number(glint_builder *builder, double number, glint_value *out, glint_error *error)
{
    GLINT_REFUSE_NULL(builder, error);
    GLINT_REFUSE_NULL(out, error);
    return glint_builder_intern(builder, GLINT_SSA_NUMBER, 0, number, out, error);
}

glint_status glint_builder_input(glint_builder *builder, glint_input input, glint_value *out, glint_error *error)
{
    GLINT_REFUSE_NULL(builder, error);
    GLINT_REFUSE_NULL(out, error);
    if ((unsigned)input >= GLINT_INPUT_COUNT)
        return glint_fail(error, GLINT_ERR_INVALID, "input: no such input: %d", (int)input);
    if (builder->kind == GLINT_PROGRAM_PATTERN && input >= GLINT_INPUT_L_X)
        return glint_fail(error, GLINT_ERR_INVALID, "input: a pattern has no %s, which a shader has",
                          glint_input_name(input));
    const glint_ssa_node node = { .op = GLINT_SSA_INPUT, .operand = { input } };
    return share(builder, &node, 1, out, error);
}

bool glint_builder_is_number(const glint_builder *builder, glint_value value, double *number)
{
    if (!builder)
        return false;
    if (value >= builder->count || builder->nodes[value].op != GLINT_SSA_NUMBER)
        return false;
    if (number)
        *number = builder->nodes[value].number;
    return true;
}

size_t glint_builder_length(const glint_builder *builder)
{
    if (!builder)
        return 0;
    size_t length = 0;
    for (uint32_t i = 0; i < builder->count; i++)
        length += glint_ssa_is_op(&builder->nodes[i]) && builder->nodes[i].part == 0;
    return length;
}

// ---- Operations ---------------------------------------------------------------------------------------------------

void glint_fold(glint_op op, const glint_texture *texture, const double *operands, double results[GLINT_RESULTS_MAX])
{
    const glint_op_info *info = glint_op_info_of(op);
    const uint16_t first_lane = 1;
    double numbers[GLINT_OPERANDS_MAX][GLINT_NUMBER_LANES] = { { 0 } }, rows[GLINT_RESULTS_MAX * GLINT_PROGRAM_LANES];
    double lanes[GLINT_RESULTS_MAX][GLINT_GROUP];
    glint_instruction at = { .op = (uint16_t)op,
                             .operands = (uint8_t)info->operands,
                             .results = (uint8_t)info->results };
    glint_program_code code = { .instructions = &at,
                                .length = 1,
                                .row_count = info->results,
                                .output_count = info->results,
                                .numbers = (const double(*)[GLINT_NUMBER_LANES])numbers };
    glint_program_args args = { .code = &code, .group_count = 1, .wanted = &first_lane, .rows = rows };
    const glint_texture_table *table = texture ? glint_texture_table_of(texture) : NULL;
    code.textures = &table;
    for (uint32_t k = 0; k < info->operands; k++) {
        numbers[k][0] = operands[k];
        at.in[k] = (uint16_t)(GLINT_ROW_NUMBER + k);
    }
    for (uint32_t k = 0; k < info->results; k++) {
        at.out[k] = code.outputs[k] = (uint16_t)k;
        args.result[k] = lanes[k];
    }
    // all instruction sets return the same bits, so the first one in the build will do
    glint_stages_built[0]->program(&args);
    for (uint32_t k = 0; k < info->results; k++)
        results[k] = lanes[k][0];
}

void glint_op_apply(glint_op op, const double *operands, double *results)
{
    if (!operands || !results)
        return;
    double all[GLINT_RESULTS_MAX];
    glint_fold(op, NULL, operands, all);
    memcpy(results, all, glint_op_info_of(op)->results * sizeof *all);
}

/// Replaces an operation on numbers by its results.
static glint_status fold(glint_builder *builder, glint_op op, uint32_t texture, const glint_value *operands,
                         glint_value *out, glint_error *error)
{
    const glint_op_info *info = glint_op_info_of(op);
    double numbers[GLINT_OPERANDS_MAX], results[GLINT_RESULTS_MAX];
    glint_status status = GLINT_OK;
    for (uint32_t k = 0; k < info->operands; k++)
        numbers[k] = builder->nodes[operands[k]].number;
    glint_fold(op, builder->texture_count ? builder->textures[texture] : NULL, numbers, results);
    for (uint32_t k = 0; k < info->results && !status; k++)
        status = glint_builder_number(builder, results[k], &out[k], error);
    return status;
}

static bool is_the_number(const glint_builder *builder, glint_value value, double number)
{
    return builder->nodes[value].op == GLINT_SSA_NUMBER &&
           memcmp(&builder->nodes[value].number, &number, sizeof number) == 0;
}

/// Returns whether the operation always returns one of its operands unchanged, bit for bit, and writes this operand
/// to *out.
static bool gives_operand(const glint_builder *builder, glint_op op, const glint_value *operand, glint_value *out)
{
    double number;
    int which = -1;
    if (op == GLINT_OP_MUL && is_the_number(builder, operand[0], 1))
        which = 1;
    else if ((op == GLINT_OP_MUL || op == GLINT_OP_DIV) && is_the_number(builder, operand[1], 1))
        which = 0;
    else if (op == GLINT_OP_SUB && is_the_number(builder, operand[1], 0))
        which = 0;
    else if (op == GLINT_OP_SELECT && glint_builder_is_number(builder, operand[0], &number))
        which = number != 0 ? 1 : 2;
    else if (op == GLINT_OP_SELECT && operand[1] == operand[2])
        which = 1;
    if (which >= 0)
        *out = operand[which];
    return which >= 0;
}

glint_status glint_builder_add(glint_builder *builder, glint_op op, uint32_t texture, const glint_value *operands,
                               glint_value *out, glint_error *error)
{
    const glint_op_info *info = glint_op_info_of(op);
    glint_ssa_node node = { .op = (uint16_t)op, .texture = texture };
    bool numbers = true;
    for (uint32_t k = 0; k < info->operands; k++) {
        if (operands[k] >= builder->count)
            return glint_fail(error, GLINT_ERR_INVALID, "%s: operand %u is not a value of this builder", info->name,
                              (unsigned)k + 1);
        node.operand[k] = operands[k];
        numbers = numbers && builder->nodes[operands[k]].op == GLINT_SSA_NUMBER;
    }
    if (!builder->plain && numbers)
        return fold(builder, op, texture, operands, out, error);
    if (!builder->plain && gives_operand(builder, op, operands, out))
        return GLINT_OK;
    return share(builder, &node, info->results, out, error);
}

glint_status glint_builder_op(glint_builder *builder, glint_op op, const glint_value *operands, glint_value *out,
                              glint_error *error)
{
    GLINT_REFUSE_NULL(builder, error);
    GLINT_REFUSE_NULL(operands, error);
    GLINT_REFUSE_NULL(out, error);
    if ((unsigned)op > GLINT_OP_PARITY)
        return glint_fail(error, GLINT_ERR_INVALID, "op: no operation of a caller's: %d", (int)op);
    return glint_builder_add(builder, op, 0, operands, out, error);
}

// ---- Textures -----------------------------------------------------------------------------------------------------

glint_status glint_builder_texture(glint_builder *builder, const glint_texture *texture, uint32_t *out,
                                   glint_error *error)
{
    uint32_t i = 0;
    while (i < builder->texture_count && builder->textures[i] != texture)
        i++;
    *out = i;
    if (i < builder->texture_count)
        return GLINT_OK;
    glint_texture **textures = realloc(builder->textures, (i + 1) * sizeof(glint_texture *));
    if (!textures)
        return glint_fail_nomem(error);
    builder->textures = textures;
    textures[builder->texture_count++] = glint_texture_retain((glint_texture *)texture);
    return GLINT_OK;
}

/// Writes the value that `value` becomes if the input `other` is read instead of UV_FOOTPRINT.
static glint_status read_instead(glint_builder *builder, glint_value value, glint_input other, glint_value *out, glint_error *error)
{
    glint_value *map = malloc(((size_t)value + GLINT_RESULTS_MAX) * sizeof *map), operands[GLINT_OPERANDS_MAX] = { 0 };
    glint_status status = map ? GLINT_OK : glint_fail_nomem(error);
    for (glint_value i = 0; i <= value && !status; i++) {
        const glint_ssa_node node = builder->nodes[i];
        const bool is_op = glint_ssa_is_op(&node);
        bool changed = false;
        if (is_op && node.part > 0)
            continue; // written together with the first result
        map[i] = i;
        if (node.op == GLINT_SSA_INPUT && node.operand[0] == GLINT_INPUT_UV_FOOTPRINT)
            status = glint_builder_input(builder, other, &map[i], error);
        for (uint32_t k = 0; is_op && k < glint_op_info_of((glint_op)node.op)->operands; k++) {
            operands[k] = map[node.operand[k]];
            changed = changed || operands[k] != node.operand[k];
        }
        for (uint32_t k = 1; is_op && k < glint_op_info_of((glint_op)node.op)->results; k++)
            map[i + k] = i + k;
        if (changed)
            status = glint_builder_add(builder, (glint_op)node.op, node.texture, operands, map + i, error);
    }
    *out = status ? value : map[value];
    free(map);
    return status;
}

glint_status glint_builder_texel_by_axis(glint_builder *builder, const glint_texture *texture, glint_value u, glint_value v,
                                         const glint_value footprint[2], glint_value out[4], glint_error *error)
{
    GLINT_REFUSE_NULL(builder, error);
    GLINT_REFUSE_NULL(texture, error);
    GLINT_REFUSE_NULL(footprint, error);
    GLINT_REFUSE_NULL(out, error);
    const bool square = glint_texture_width(texture) == glint_texture_height(texture);
    glint_value operands[] = { u, v, footprint[0], footprint[1] };
    uint32_t index;
    glint_status status = glint_builder_texture(builder, texture, &index, error);
    for (int k = 0; k < 2 && !square && footprint[k] < builder->count && !status; k++)
        status = read_instead(builder, footprint[k], k ? GLINT_INPUT_UV_FOOTPRINT_V : GLINT_INPUT_UV_FOOTPRINT_U, &operands[2 + k], error);
    return status ? status : glint_builder_add(builder, GLINT_OP_TEXEL, index, operands, out, error);
}

glint_status glint_builder_texel(glint_builder *builder, const glint_texture *texture, glint_value u, glint_value v,
                                 glint_value footprint, glint_value out[4], glint_error *error)
{
    const glint_value width[2] = { footprint, footprint };
    return glint_builder_texel_by_axis(builder, texture, u, v, width, out, error);
}

glint_status glint_builder_finish(glint_builder *builder, const glint_value *outputs, size_t count, glint_program **out,
                                  glint_error *error)
{
    GLINT_REFUSE_NULL(builder, error);
    GLINT_REFUSE_NULL(outputs, error);
    GLINT_REFUSE_NULL(out, error);
    const bool pattern = builder->kind == GLINT_PROGRAM_PATTERN;
    if (pattern && count != 1 && count != 3)
        return glint_fail(error, GLINT_ERR_INVALID, "count: 1 or 3 outputs of a pattern expected, got %zu", count);
    if (!pattern && count != 3 && count != 6)
        return glint_fail(error, GLINT_ERR_INVALID, "count: 3 or 6 outputs of a shader expected, got %zu", count);
    return builder->parameter_count ? glint_builder_finish_open(builder, outputs, count, out, error)
                                    : glint_program_make(builder, outputs, count, out, error);
}

// ---- Values of a finished program ----

/// Returns the value of an operand: a row, an input or a number. row: the value that each row holds.
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
