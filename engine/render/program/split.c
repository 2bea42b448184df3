/// Splits a program: builds the graph of its values, finds a cut through it, and writes the code of both sides.
#include "engine/render/program/split.h"
#include "engine/render/program/flow.h"

#include "engine/base/alloc.h"

#include <stdlib.h>
#include <string.h>

// Costs in tenths of a nanosecond per point.
#define COST_OF_NUMBER 8u ///< cost of a cached double
#define COST_OF_TRUTH 1u ///< cost of a cached bit
#define COST_MAX 160u ///< above this cost nothing is cached

#define NO_VALUE UINT32_MAX ///< marks an operand that is a number

/// A program's values: its inputs, then the results of its instructions.
typedef struct values {
    const glint_program_code *code;
    uint32_t count;
    uint32_t *operand; ///< values of the operands, GLINT_OPERANDS_MAX for each instruction
    uint32_t *first; ///< index of the first result of each instruction
    bool *dynamic; ///< the instructions that depend on the changed numbers
    bool *second; ///< the instructions that the second part runs
    uint32_t *maker; ///< the instruction that computes each value; NO_VALUE for an input
    uint32_t *last; ///< the last reader of each value in the part being written
    uint16_t *slot; ///< row or input of each value in the part being written
    glint_flow flow;
    uint32_t cached[GLINT_PROGRAM_OUTPUTS_MAX], cached_count;
} values;

static void destroy(values *v)
{
    free(v->operand);
    free(v->first);
    free(v->dynamic);
    free(v->second);
    free(v->maker);
    free(v->last);
    free(v->slot);
    glint_flow_destroy(&v->flow);
}

static bool begin(values *v, const glint_program_code *code)
{
    const size_t length = code->length + 1u;
    *v = (values) { .code = code, .count = GLINT_INPUT_COUNT };
    for (uint32_t i = 0; i < code->length; i++)
        v->count += code->instructions[i].results;
    v->operand = malloc(length * GLINT_OPERANDS_MAX * sizeof *v->operand);
    v->first = malloc(length * sizeof *v->first);
    v->dynamic = calloc(length, sizeof *v->dynamic);
    v->second = calloc(length, sizeof *v->second);
    v->maker = malloc(v->count * sizeof *v->maker);
    v->last = malloc(v->count * sizeof *v->last);
    v->slot = malloc(v->count * sizeof *v->slot);
    return v->operand && v->first && v->dynamic && v->second && v->maker && v->last && v->slot &&
           glint_flow_create(&v->flow, 2 + code->length + v->count,
                             GLINT_INPUT_COUNT + length * (GLINT_OPERANDS_MAX + 1) + v->count +
                                 GLINT_PROGRAM_OUTPUTS_MAX);
}

// ---- The graph ----------------------------------------------------------------------------------------------------

/// Returns the value that an operand reads; NO_VALUE: a number. holder: the value that each row holds.
static uint32_t value_at(const uint32_t *holder, uint32_t slot)
{
    if (slot >= GLINT_ROW_NUMBER)
        return NO_VALUE;
    return slot < GLINT_ROW_INPUT ? holder[slot] : slot - GLINT_ROW_INPUT;
}

/// Numbers the values, and marks those that depend on the changed numbers. outputs: the values of the program's
/// outputs.
static void name_values(values *v, const bool *changed, uint32_t *outputs)
{
    uint32_t holder[GLINT_PROGRAM_ROWS_MAX] = { 0 }, next = GLINT_INPUT_COUNT;
    for (uint32_t i = 0; i < GLINT_INPUT_COUNT; i++)
        v->maker[i] = NO_VALUE;
    for (uint32_t i = 0; i < v->code->length; i++) {
        const glint_instruction *at = &v->code->instructions[i];
        for (uint32_t k = 0; k < at->operands; k++) {
            const uint32_t value = value_at(holder, at->in[k]);
            v->operand[i * GLINT_OPERANDS_MAX + k] = value;
            v->dynamic[i] = v->dynamic[i] ||
                            (value == NO_VALUE ? changed[at->in[k] - GLINT_ROW_NUMBER]
                                               : v->maker[value] != NO_VALUE && v->dynamic[v->maker[value]]);
        }
        v->first[i] = next;
        for (uint32_t k = 0; k < at->results; k++) {
            v->maker[next] = i;
            holder[at->out[k]] = next++;
        }
    }
    for (uint32_t k = 0; k < v->code->output_count; k++)
        outputs[k] = value_at(holder, v->code->outputs[k]);
}

static uint32_t cost_of_op(uint16_t op)
{
    switch (op) {
    case GLINT_OP_DIV:
    case GLINT_OP_SQRT:
    case GLINT_OP_PARITY:
        return 3;
    case GLINT_OP_MOD:
    case GLINT_OP_SMOOTHSTEP:
    case GLINT_OP_HASH:
    case GLINT_OP_HIGHLIGHT:
        return 6;
    case GLINT_OP_SIN:
    case GLINT_OP_COS:
    case GLINT_OP_EXP2:
    case GLINT_OP_LOG2:
    case GLINT_OP_ATAN2:
    case GLINT_OP_ACOS:
        return 10;
    case GLINT_OP_POW:
    case GLINT_OP_NOISE:
        return 22;
    case GLINT_OP_NOISE3:
    case GLINT_OP_NOISE_SLOPE:
    case GLINT_OP_TEXEL:
    case GLINT_OP_TEXEL_SLOPE:
        return 60;
    case GLINT_OP_CELL:
    case GLINT_OP_CELL_SLOPE:
        return 120;
    default:
        return 1;
    }
}

static bool is_truth(uint16_t op)
{
    return (op >= GLINT_OP_LESS && op <= GLINT_OP_NOT) || op == GLINT_OP_STEP || op == GLINT_OP_PARITY;
}

static uint32_t cost_of_value(const values *v, uint32_t value)
{
    const uint32_t maker = v->maker[value];
    return maker != NO_VALUE && is_truth(v->code->instructions[maker].op) ? COST_OF_TRUTH : COST_OF_NUMBER;
}

static uint32_t node_of(uint32_t instruction) { return 2 + instruction; }
static uint32_t node_of_value(const values *v, uint32_t value) { return 2 + v->code->length + value; }

static bool is_dynamic(const values *v, uint32_t value)
{
    return v->maker[value] != NO_VALUE && v->dynamic[v->maker[value]];
}

/// Adds a reader of a value. The reader gets the value from the cache, or from the second part, which then needs the
/// value's operands as well.
static void add_reader(values *v, uint32_t value, uint32_t reader)
{
    if (value != NO_VALUE && !is_dynamic(v, value))
        glint_flow_add(&v->flow, node_of_value(v, value), reader, GLINT_FLOW_ENDLESS);
}

/// Builds the graph. The sink's side consists of the instructions that the second part runs and the values that it
/// reads. Returns the cost of all instructions that do not depend on the changed numbers.
static uint32_t make_graph(values *v, const uint32_t *outputs)
{
    uint32_t rest = 0;
    for (uint32_t i = 0; i < GLINT_INPUT_COUNT; i++)
        glint_flow_add(&v->flow, GLINT_FLOW_SOURCE, node_of_value(v, i), COST_OF_NUMBER);
    for (uint32_t i = 0; i < v->code->length; i++) {
        const glint_instruction *at = &v->code->instructions[i];
        for (uint32_t k = 0; k < at->operands; k++)
            add_reader(v, v->operand[i * GLINT_OPERANDS_MAX + k], v->dynamic[i] ? GLINT_FLOW_SINK : node_of(i));
        if (v->dynamic[i])
            continue;
        glint_flow_add(&v->flow, GLINT_FLOW_SOURCE, node_of(i), cost_of_op(at->op));
        rest += cost_of_op(at->op);
        for (uint32_t k = 0; k < at->results; k++)
            glint_flow_add(&v->flow, node_of(i), node_of_value(v, v->first[i] + k),
                           cost_of_value(v, v->first[i] + k));
    }
    for (uint32_t k = 0; k < v->code->output_count; k++)
        add_reader(v, outputs[k], GLINT_FLOW_SINK);
    return rest;
}

/// Lists the cached values and the instructions of the second part. Returns false if there are none, or too many.
static bool find_sides(values *v)
{
    for (uint32_t i = 0; i < v->code->length; i++)
        v->second[i] = v->dynamic[i] || glint_flow_near_sink(&v->flow, node_of(i));
    for (uint32_t i = 0; i < v->count; i++) {
        const uint32_t maker = v->maker[i];
        if (is_dynamic(v, i) || (maker != NO_VALUE && v->second[maker]) ||
            !glint_flow_near_sink(&v->flow, node_of_value(v, i)))
            continue;
        if (v->cached_count == GLINT_PROGRAM_OUTPUTS_MAX)
            return false;
        v->cached[v->cached_count++] = i;
    }
    return v->cached_count > 0;
}

// ---- The code of a part -------------------------------------------------------------------------------------------

/// Finds the last reader of each value, from the end backwards, in a part that runs the `wanted` instructions. The
/// outputs count as read at the end.
static void find_last(values *v, bool *wanted, const uint32_t *outputs, uint32_t count)
{
    for (uint32_t i = 0; i < v->count; i++)
        v->last[i] = NO_VALUE;
    for (uint32_t k = 0; k < count; k++)
        if (outputs[k] != NO_VALUE)
            v->last[outputs[k]] = v->code->length;
    for (uint32_t i = v->code->length; i-- > 0;) {
        const glint_instruction *at = &v->code->instructions[i];
        bool read = false;
        for (uint32_t k = 0; k < at->results; k++)
            read = read || v->last[v->first[i] + k] != NO_VALUE;
        wanted[i] = wanted[i] && read;
        for (uint32_t k = 0; k < at->operands && wanted[i]; k++) {
            const uint32_t value = v->operand[i * GLINT_OPERANDS_MAX + k];
            if (value != NO_VALUE && v->last[value] == NO_VALUE)
                v->last[value] = i;
        }
    }
}

static uint16_t take_row(bool *taken, uint32_t *most)
{
    uint32_t row = 0;
    while (row < GLINT_PROGRAM_ROWS_MAX && taken[row])
        row++;
    if (row < GLINT_PROGRAM_ROWS_MAX)
        taken[row] = true;
    *most = row + 1 > *most ? row + 1 : *most;
    return (uint16_t)row;
}

/// Assigns rows to an instruction's results. First frees the rows of operands that this instruction is the last to
/// read.
static void place_results(values *v, uint32_t i, glint_instruction *to, bool *taken, uint32_t *most)
{
    for (uint32_t k = 0; k < to->operands; k++) {
        const uint32_t value = v->operand[i * GLINT_OPERANDS_MAX + k];
        if (value != NO_VALUE && v->last[value] == i && v->slot[value] < GLINT_ROW_INPUT)
            taken[v->slot[value]] = false;
    }
    for (uint32_t k = 0; k < to->results; k++)
        v->slot[v->first[i] + k] = to->out[k] = take_row(taken, most);
    for (uint32_t k = 0; k < to->results; k++)
        if (v->last[v->first[i] + k] == NO_VALUE && to->out[k] < GLINT_PROGRAM_ROWS_MAX)
            taken[to->out[k]] = false;
}

/// Writes the part that runs the `wanted` instructions; its inputs already have their rows. The part may turn out to
/// need too many rows. False: out of memory.
static bool write_part(values *v, bool *wanted, const uint32_t *outputs, uint32_t count, glint_program_code *part)
{
    bool taken[GLINT_PROGRAM_ROWS_MAX] = { false };
    glint_instruction *to = glint_alloc(v->code->length + 1u, sizeof *to);
    part->instructions = to;
    if (!to)
        return false;
    find_last(v, wanted, outputs, count);
    for (uint32_t i = 0; i < v->code->length; i++) {
        if (!wanted[i])
            continue;
        *to = v->code->instructions[i];
        for (uint32_t k = 0; k < to->operands; k++) {
            const uint32_t value = v->operand[i * GLINT_OPERANDS_MAX + k];
            to->in[k] = value == NO_VALUE ? to->in[k] : v->slot[value];
        }
        place_results(v, i, to++, taken, &part->row_count);
        part->length++;
    }
    part->output_count = count;
    for (uint32_t k = 0; k < count; k++)
        if (outputs[k] != NO_VALUE)
            part->outputs[k] = v->slot[outputs[k]];
    return true;
}

static bool write_parts(values *v, const uint32_t *outputs, glint_split *split)
{
    bool *first = v->dynamic; // `dynamic` is not read any more
    for (uint32_t i = 0; i < v->code->length; i++)
        first[i] = !first[i];
    for (uint32_t i = 0; i < GLINT_INPUT_COUNT; i++)
        v->slot[i] = (uint16_t)(GLINT_ROW_INPUT + i);
    if (!write_part(v, first, v->cached, v->cached_count, &split->first))
        return false;
    for (uint32_t k = 0; k < v->cached_count; k++) {
        v->slot[v->cached[k]] = (uint16_t)(GLINT_ROW_INPUT + k);
        split->truths |= cost_of_value(v, v->cached[k]) == COST_OF_TRUTH ? 1u << k : 0;
    }
    memcpy(split->second.outputs, v->code->outputs, sizeof split->second.outputs); // write_part keeps numbers
    return write_part(v, v->second, outputs, v->code->output_count, &split->second);
}

// ---- Both parts ---------------------------------------------------------------------------------------------------

void glint_split_destroy(glint_split *split)
{
    if (split) {
        free((void *)split->first.instructions);
        free((void *)split->second.instructions);
    }
    free(split);
}

bool glint_split_create(const glint_program *program, const bool *changed, glint_split **out)
{
    uint32_t outputs[GLINT_PROGRAM_OUTPUTS_MAX];
    values v;
    glint_split *split = calloc(1, sizeof *split);
    bool good = begin(&v, &program->code) && split, found = false;
    *out = NULL;
    if (good) {
        name_values(&v, changed, outputs);
        split->saved = make_graph(&v, outputs);
        split->cost = glint_flow_fill(&v.flow, COST_MAX);
        found = split->cost <= COST_MAX && find_sides(&v);
        good = !found || write_parts(&v, outputs, split);
        found = found && split->first.row_count <= GLINT_PROGRAM_ROWS_MAX &&
                split->second.row_count <= GLINT_PROGRAM_ROWS_MAX;
    }
    destroy(&v);
    if (good && found)
        *out = split;
    else
        glint_split_destroy(split);
    return good;
}
