/// Turns a builder's values into a program: drops values that no output needs, fuses operations, allocates rows.
#include "engine/render/program/builder.h"

#include "engine/base/alloc.h"
#include "engine/base/status.h"

#include <stdlib.h>
#include <string.h>

/// rows of 2 KB that fit into the first-level cache, about; if more are needed, another order of operations is tried
#define ROWS_THAT_FIT 32u
#define UNUSED UINT32_MAX

typedef struct maker {
    uint32_t count;
    glint_ssa_node *nodes; ///< a copy of the builder's nodes, some of them fused
    uint32_t *uses; ///< number of readers of each value; 0: nothing reads it
    bool *needed; ///< for each operation, by its first result: whether an output depends on it
    uint32_t *order, length; ///< the operations in the order of their execution, each by its first result
    uint32_t *last; ///< position in `order` of each value's last reader; UNUSED: none; length: it is an output
    uint16_t *row;
    uint32_t rows;
} maker;

static void destroy(maker *m)
{
    free(m->nodes);
    free(m->uses);
    free(m->needed);
    free(m->order);
    free(m->last);
    free(m->row);
}

static bool begin(maker *m, const glint_builder *builder)
{
    const size_t count = builder->count;
    *m = (maker) { .count = builder->count };
    m->nodes = malloc((count + 1) * sizeof *m->nodes);
    m->uses = calloc(count + 1, sizeof *m->uses);
    m->needed = calloc(count + 1, sizeof *m->needed);
    m->order = malloc((count + 1) * sizeof *m->order);
    m->last = malloc((count + 1) * sizeof *m->last);
    m->row = calloc(count + 1, sizeof *m->row);
    if (!m->nodes || !m->uses || !m->needed || !m->order || !m->last || !m->row)
        return false;
    memcpy(m->nodes, builder->nodes, count * sizeof *m->nodes);
    return true;
}

static uint32_t first_of(const maker *m, glint_value value) { return value - m->nodes[value].part; }

static void mark_needed(maker *m, const glint_value *outputs, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        m->uses[outputs[k]]++;
        m->needed[first_of(m, outputs[k])] = true;
    }
    for (uint32_t i = m->count; i-- > 0;) {
        const glint_ssa_node *node = &m->nodes[i];
        if (!m->needed[i] || !glint_ssa_is_op(node))
            continue;
        for (uint32_t k = 0; k < glint_op_info_of((glint_op)node->op)->operands; k++) {
            m->uses[node->operand[k]]++;
            m->needed[first_of(m, node->operand[k])] = true;
        }
    }
}

// ---- Pairs --------------------------------------------------------------------------------------------------------

static bool is_only_of_this(const maker *m, glint_value value, glint_op op)
{
    return m->nodes[value].op == op && m->uses[value] == 1;
}

static void become(maker *m, uint32_t i, glint_op op, glint_value a, glint_value b, glint_value c, glint_value unused)
{
    glint_ssa_node *node = &m->nodes[i];
    node->op = (uint16_t)op;
    node->operand[0] = a;
    node->operand[1] = b;
    node->operand[2] = c;
    m->uses[unused] = 0;
    m->needed[unused] = false;
}

/// Turns x y + a with x = b - a into mix(a, b, y).
static void make_mix(maker *m, uint32_t i)
{
    for (int k = 0; k < 2; k++) {
        const glint_value *operand = m->nodes[i].operand, x = operand[k], y = operand[1 - k], a = operand[2];
        if (!is_only_of_this(m, x, GLINT_OP_SUB) || m->nodes[x].operand[1] != a)
            continue;
        m->uses[a]--;
        become(m, i, GLINT_OP_MIX, a, m->nodes[x].operand[0], y, x);
        return;
    }
}

static void make_pairs(maker *m)
{
    for (uint32_t i = 0; i < m->count; i++) {
        const glint_value a = m->nodes[i].operand[0], b = m->nodes[i].operand[1];
        const uint16_t op = m->nodes[i].op;
        if (!m->needed[i] || (op != GLINT_OP_ADD && op != GLINT_OP_SUB))
            continue;
        const glint_ssa_node *second = &m->nodes[b], *first = &m->nodes[a];
        if (is_only_of_this(m, b, GLINT_OP_MUL) && op == GLINT_OP_ADD)
            become(m, i, GLINT_OP_MULADD, second->operand[0], second->operand[1], a, b);
        else if (is_only_of_this(m, b, GLINT_OP_MUL))
            become(m, i, GLINT_OP_SUBMUL, a, second->operand[0], second->operand[1], b);
        else if (is_only_of_this(m, a, GLINT_OP_MUL))
            become(m, i, op == GLINT_OP_ADD ? GLINT_OP_MULADD : GLINT_OP_MULSUB, first->operand[0], first->operand[1],
                   b, a);
        if (m->nodes[i].op == GLINT_OP_MULADD)
            make_mix(m, i);
    }
}

/// Fuses products of three values that are not part of a sum.
static void make_products(maker *m)
{
    for (uint32_t i = 0; i < m->count; i++)
        for (int k = 0; k < 2 && m->needed[i] && m->nodes[i].op == GLINT_OP_MUL; k++) {
            const glint_value inner = m->nodes[i].operand[k], *of = m->nodes[inner].operand;
            if (is_only_of_this(m, inner, GLINT_OP_MUL))
                become(m, i, GLINT_OP_MULMUL, of[0], of[1], m->nodes[i].operand[1 - k], inner);
        }
}

/// Turns e f + (c d + a b) into dot(a, b, c, d, e, f).
static void make_dots(maker *m)
{
    for (uint32_t i = 0; i < m->count; i++) {
        const glint_value *last = m->nodes[i].operand, *second = m->nodes[last[2]].operand;
        const glint_value e = last[0], f = last[1], sum = last[2], c = second[0], d = second[1], product = second[2];
        if (!m->needed[i] || m->nodes[i].op != GLINT_OP_MULADD || !is_only_of_this(m, sum, GLINT_OP_MULADD) ||
            !is_only_of_this(m, product, GLINT_OP_MUL))
            continue;
        become(m, i, GLINT_OP_DOT, m->nodes[product].operand[0], m->nodes[product].operand[1], c, sum);
        m->uses[product] = 0;
        m->needed[product] = false;
        m->nodes[i].operand[3] = d;
        m->nodes[i].operand[4] = e;
        m->nodes[i].operand[5] = f;
    }
}

// ---- Order and rows -----------------------------------------------------------------------------------------------

static void order_as_written(maker *m)
{
    m->length = 0;
    for (uint32_t i = 0; i < m->count; i++)
        if (m->needed[i] && glint_ssa_is_op(&m->nodes[i]))
            m->order[m->length++] = i;
}

/// Orders the operations depth first from the first output, each operand right before its first reader. False: out of
/// memory.
static bool order_by_need(maker *m, const glint_value *outputs, size_t count)
{
    uint32_t *stack = malloc((m->count + 1) * sizeof *stack), depth = 0;
    uint8_t *seen = calloc(m->count + 1, 1); // 255: already in the order; otherwise the number of operands visited
    m->length = 0;
    for (size_t k = 0; k < count && stack && seen; k++) {
        stack[depth++] = first_of(m, outputs[k]);
        while (depth) {
            const uint32_t i = stack[depth - 1];
            const glint_ssa_node *node = &m->nodes[i];
            if (!glint_ssa_is_op(node) || seen[i] == 255) {
                depth--;
            } else if (seen[i] < glint_op_info_of((glint_op)node->op)->operands) {
                stack[depth++] = first_of(m, node->operand[seen[i]++]);
            } else {
                m->order[m->length++] = i;
                seen[i] = 255;
                depth--;
            }
        }
    }
    const bool done = stack && seen;
    free(stack);
    free(seen);
    return done;
}

static void find_last_uses(maker *m, const glint_value *outputs, size_t count)
{
    for (uint32_t i = 0; i < m->count; i++)
        m->last[i] = UNUSED;
    for (uint32_t at = 0; at < m->length; at++) {
        const glint_ssa_node *node = &m->nodes[m->order[at]];
        for (uint32_t k = 0; k < glint_op_info_of((glint_op)node->op)->operands; k++)
            m->last[node->operand[k]] = at;
    }
    for (size_t k = 0; k < count; k++)
        m->last[outputs[k]] = m->length;
}

typedef struct free_rows {
    uint64_t taken[GLINT_PROGRAM_ROWS_MAX / 64];
    uint32_t most; ///< largest number of rows in use at once; GLINT_PROGRAM_ROWS_MAX + 1: there are too few rows
} free_rows;

static uint16_t take_row(free_rows *rows)
{
    for (uint32_t w = 0; w < GLINT_PROGRAM_ROWS_MAX / 64; w++) {
        if (~rows->taken[w] == 0)
            continue;
        const uint32_t bit = (uint32_t)__builtin_ctzll(~rows->taken[w]), row = 64 * w + bit;
        rows->taken[w] |= (uint64_t)1 << bit;
        rows->most = rows->most > row + 1 ? rows->most : row + 1;
        return (uint16_t)row;
    }
    rows->most = GLINT_PROGRAM_ROWS_MAX + 1;
    return 0;
}

static void give_row(free_rows *rows, uint16_t row) { rows->taken[row / 64] &= ~((uint64_t)1 << row % 64); }

/// Assigns a row to each result. A result may reuse the row of an operand that has no later reader, because kernels
/// read operands before they write results.
static void give_out_rows(maker *m, const glint_value *outputs, size_t count)
{
    free_rows rows = { { 0 }, 0 };
    find_last_uses(m, outputs, count);
    for (uint32_t at = 0; at < m->length; at++) {
        const uint32_t i = m->order[at];
        const glint_op_info *info = glint_op_info_of((glint_op)m->nodes[i].op);
        for (uint32_t k = 0; k < info->operands; k++) {
            const glint_value value = m->nodes[i].operand[k];
            if (glint_ssa_is_op(&m->nodes[value]) && m->last[value] == at)
                give_row(&rows, m->row[value]);
        }
        for (uint32_t k = 0; k < info->results; k++)
            m->row[i + k] = take_row(&rows);
        for (uint32_t k = 0; k < info->results; k++)
            if (m->last[i + k] == UNUSED)
                give_row(&rows, m->row[i + k]);
    }
    m->rows = rows.most;
}

static glint_status find_rows(maker *m, const glint_value *outputs, size_t count, glint_error *error)
{
    order_as_written(m);
    if (m->length > GLINT_PROGRAM_LENGTH_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "program: at most %d instructions expected, got %u",
                          GLINT_PROGRAM_LENGTH_MAX, (unsigned)m->length);
    give_out_rows(m, outputs, count);
    if (m->rows > ROWS_THAT_FIT) {
        const uint32_t written = m->rows;
        if (!order_by_need(m, outputs, count))
            return glint_fail_nomem(error);
        give_out_rows(m, outputs, count);
        if (m->rows >= written) {
            order_as_written(m);
            give_out_rows(m, outputs, count);
        }
    }
    if (m->rows > GLINT_PROGRAM_ROWS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "program: more than %d intermediate values are needed at the same time; fewer expected",
                          GLINT_PROGRAM_ROWS_MAX);
    return GLINT_OK;
}

// ---- The program --------------------------------------------------------------------------------------------------

static bool allocate(glint_program *program, const glint_builder *builder, uint32_t length)
{
    program->code.instructions = glint_alloc(length, sizeof(glint_instruction));
    program->code.numbers =
        glint_alloc((size_t)GLINT_OPERANDS_MAX * length + GLINT_CODE_OUTPUTS_MAX, sizeof *program->code.numbers);
    program->textures = calloc(builder->texture_count + 1u, sizeof *program->textures);
    program->code.textures = calloc(builder->texture_count + 1u, sizeof *program->code.textures);
    return program->code.instructions && program->code.numbers && program->textures && program->code.textures;
}

/// Returns the row of a value. Enters numbers and inputs into the program at their first use.
static uint16_t slot_of(maker *m, glint_program *program, glint_value value)
{
    const glint_ssa_node *node = &m->nodes[value];
    if (glint_ssa_is_op(node))
        return m->row[value];
    if (node->op == GLINT_SSA_INPUT) {
        if (node->operand[0] < GLINT_INPUT_COUNT)
            program->inputs |= 1u << node->operand[0];
        else
            program->slopes |= 1u << (node->operand[0] - GLINT_INPUT_COUNT);
        return (uint16_t)(GLINT_ROW_INPUT + node->operand[0]);
    }
    if (!m->row[value]) {
        double(*numbers)[GLINT_NUMBER_LANES] = (double(*)[GLINT_NUMBER_LANES])program->code.numbers;
        for (int i = 0; i < GLINT_NUMBER_LANES; i++)
            numbers[program->number_count][i] = node->number;
        m->row[value] = (uint16_t)(GLINT_ROW_NUMBER + program->number_count++);
    }
    return m->row[value];
}

/// Returns the index of a builder's texture in the program's list.
static uint16_t slot_of_texture(glint_program *program, glint_texture *texture)
{
    uint32_t i = 0;
    while (i < program->texture_count && program->textures[i] != texture)
        i++;
    if (i == program->texture_count) {
        program->textures[i] = glint_texture_retain(texture);
        ((const glint_texture_table **)program->code.textures)[i] = glint_texture_table_of(texture);
        program->texture_count++;
    }
    return (uint16_t)i;
}

static void write_code(maker *m, const glint_builder *builder, glint_program *program, const glint_value *outputs,
                       size_t count)
{
    glint_program_code *code = &program->code;
    code->length = m->length;
    code->row_count = m->rows;
    for (uint32_t at = 0; at < m->length; at++) {
        const uint32_t i = m->order[at];
        const glint_op_info *info = glint_op_info_of((glint_op)m->nodes[i].op);
        glint_instruction *to = (glint_instruction *)&code->instructions[at];
        to->op = m->nodes[i].op;
        to->operands = (uint8_t)info->operands;
        to->results = (uint8_t)info->results;
        if (to->op >= GLINT_OP_TEXEL)
            to->texture = slot_of_texture(program, builder->textures[m->nodes[i].texture]);
        for (uint32_t k = 0; k < info->operands; k++)
            to->in[k] = slot_of(m, program, m->nodes[i].operand[k]);
        for (uint32_t k = 0; k < info->results; k++)
            to->out[k] = m->row[i + k];
    }
    code->output_count = (uint32_t)count;
    for (size_t k = 0; k < count; k++)
        code->outputs[k] = slot_of(m, program, outputs[k]);
}

static void make_keys(glint_program *program)
{
    const glint_program_code *code = &program->code;
    const uint32_t head[] = { program->kind, code->length, code->output_count, program->texture_count };
    glint_key key = glint_key_add((glint_key) { 0 }, head, sizeof head);
    key = glint_key_add(key, code->instructions, code->length * sizeof *code->instructions);
    key = glint_key_add(key, code->outputs, code->output_count * sizeof *code->outputs);
    for (uint32_t i = 0; i < program->texture_count; i++) {
        const glint_key texture = glint_texture_key(program->textures[i]);
        key = glint_key_add(key, &texture, sizeof texture);
    }
    program->structure = key;
    key = (glint_key) { 0 };
    for (uint32_t i = 0; i < program->number_count; i++)
        key = glint_key_add(key, &code->numbers[i][0], sizeof(double));
    program->numbers = key;
}

static glint_status check_outputs(const glint_builder *builder, const glint_value *outputs, size_t count,
                                  glint_error *error)
{
    if (count < 1 || count > GLINT_CODE_OUTPUTS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "count: 1 .. %d outputs expected, got %zu", GLINT_CODE_OUTPUTS_MAX,
                          count);
    for (size_t k = 0; k < count; k++)
        if (outputs[k] >= builder->count)
            return glint_fail(error, GLINT_ERR_INVALID, "outputs: number %zu is not a value of this builder", k + 1);
    return GLINT_OK;
}

static glint_status make(maker *m, const glint_builder *builder, const glint_value *outputs, size_t count,
                         glint_program *program, glint_error *error)
{
    mark_needed(m, outputs, count);
    if (!builder->plain) {
        make_pairs(m);
        make_dots(m);
        make_products(m);
    }
    const glint_status status = find_rows(m, outputs, count, error);
    if (status)
        return status;
    if (!allocate(program, builder, m->length))
        return glint_fail_nomem(error);
    write_code(m, builder, program, outputs, count);
    make_keys(program);
    return glint_code_check(&program->code, program->number_count, program->texture_count,
                            program->inputs | (uint64_t)program->slopes << GLINT_INPUT_COUNT, error);
}

glint_status glint_program_make(const glint_builder *builder, const glint_value *outputs, size_t count,
                                glint_program **out, glint_error *error)
{
    maker m;
    glint_status status = check_outputs(builder, outputs, count, error);
    if (status)
        return status;
    glint_program *program = calloc(1, sizeof *program);
    if (program) {
        program->kind = builder->kind;
        program->references = 1;
    }
    status =
        begin(&m, builder) && program ? make(&m, builder, outputs, count, program, error) : glint_fail_nomem(error);
    destroy(&m);
    if (status)
        glint_program_release(program);
    else
        *out = program;
    return status;
}
