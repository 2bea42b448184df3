/// The derivatives of a program in reverse mode: from the output back to the inputs, each value passes its adjoint on
/// to its operands, times its partial derivatives (A. Griewank and A. Walther, "Evaluating Derivatives", SIAM 2008).
/// Shaders also have forward mode.
#include "engine/render/program/slope.h"

#include "engine/base/status.h"

#include <stdlib.h>

static glint_value two(glint_slope_maker *s, glint_op op, glint_value a, glint_value b) { return glint_slope_op(s, op, a, b, 0); }

// ---- The program --------------------------------------------------------------------------------------------------

static void find_varying(glint_slope_maker *s, uint32_t inputs)
{
    const glint_ssa_node *nodes = s->builder->nodes;
    for (uint32_t i = 0; i < s->count; i++) {
        s->given[i] = GLINT_SLOPE_NOTHING;
        if (nodes[i].op == GLINT_SSA_INPUT)
            s->varies[i] = inputs >> nodes[i].operand[0] & 1;
        for (uint32_t k = 0; glint_ssa_is_op(&nodes[i]) && k < glint_op_info_of((glint_op)nodes[i].op)->operands; k++)
            s->varies[i] = s->varies[i] || s->varies[nodes[i].operand[k]];
    }
}

static void walk_back(glint_slope_maker *s)
{
    for (uint32_t i = s->count; i-- > 0 && !s->status;)
        if (s->given[i] != GLINT_SLOPE_NOTHING && glint_ssa_is_op(&s->builder->nodes[i]))
            glint_slope_pass(s, i);
}

static void finish(glint_slope_maker *s, const glint_input *inputs, size_t count, glint_program **out)
{
    glint_value outputs[GLINT_PROGRAM_OUTPUTS_MAX];
    for (size_t k = 0; k < count && !s->status; k++) {
        glint_value input;
        s->status = glint_builder_input(s->builder, inputs[k], &input, s->error);
        outputs[k] =
            !s->status && input < s->count && s->given[input] != GLINT_SLOPE_NOTHING ? s->given[input] : glint_slope_number(s, 0);
    }
    if (!s->status)
        s->status = glint_program_make(s->builder, outputs, count, out, s->error);
}

/// Begins with a program's values. inputs: the inputs to derive by, one bit each.
static void begin(glint_slope_maker *s, const glint_program *program, uint32_t inputs, glint_value outputs[GLINT_PROGRAM_OUTPUTS_MAX])
{
    s->status = glint_builder_create(program->kind, &s->builder, s->error);
    if (s->status)
        return;
    s->status = glint_builder_load(s->builder, program, NULL, outputs, s->error);
    s->count = s->builder->count;
    s->given = malloc((s->count + 1) * sizeof *s->given);
    s->varies = calloc(s->count + 1, sizeof *s->varies);
    if (!s->status && (!s->given || !s->varies))
        s->status = glint_fail_nomem(s->error);
    if (!s->status)
        find_varying(s, inputs);
}

static glint_status end(glint_slope_maker *s)
{
    free(s->given);
    free(s->varies);
    glint_builder_destroy(s->builder);
    return s->status;
}

glint_status glint_program_slope(const glint_program *program, const glint_input *inputs, size_t count,
                                 glint_program **out, glint_error *error)
{
    glint_slope_maker s = { .error = error };
    glint_value outputs[GLINT_PROGRAM_OUTPUTS_MAX];
    uint32_t wanted = 0;
    if (count < 1 || count > GLINT_PROGRAM_OUTPUTS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "count: 1 .. %d inputs expected, got %zu",
                          GLINT_PROGRAM_OUTPUTS_MAX, count);
    for (size_t k = 0; k < count; k++)
        wanted |= 1u << inputs[k];
    begin(&s, program, wanted, outputs);
    if (!s.status) {
        glint_slope_give(&s, outputs[0], glint_slope_number(&s, 1));
        walk_back(&s);
        finish(&s, inputs, count, out);
    }
    return end(&s);
}

// ---- Shaders ------------------------------------------------------------------------------------------------------

/// Returns 1 where the value of an output is used, and 0 where the output is clamped to the range from the smallest
/// to the largest number.
static glint_value is_within(glint_slope_maker *s, glint_value output)
{
    const glint_value least = glint_slope_number(s, 0x1p-1074), most = glint_slope_number(s, GLINT_REFLECTANCE_MAX);
    return two(s, GLINT_OP_EQUAL, output, glint_slope_op(s, GLINT_OP_CLAMP, output, least, most));
}

/// Lists the slopes of channel c of a shader's light that are not 0 everywhere.
static void list_channel(glint_slope_maker *s, const glint_value *outputs, uint32_t output_count, uint32_t c, uint32_t inputs,
                         glint_gradient *out, glint_value *values)
{
    for (uint32_t i = 0; i < s->count; i++)
        s->given[i] = GLINT_SLOPE_NOTHING;
    for (uint32_t k = c; k < output_count; k += 3)
        glint_slope_give(s, outputs[k], is_within(s, outputs[k]));
    walk_back(s);
    for (uint32_t i = 0; i < s->count && !s->status; i++) {
        const glint_ssa_node *node = &s->builder->nodes[i];
        if (node->op != GLINT_SSA_INPUT || s->given[i] == GLINT_SLOPE_NOTHING || !(inputs >> node->operand[0] & 1))
            continue;
        values[out->count] = s->given[i];
        out->of[out->count++] = (glint_gradient_entry) { c, node->operand[0] };
    }
}

/// Makes one program for all slopes if it can hold them, because one program computes their common values only once.
static glint_status make_gradient(const glint_builder *builder, const glint_value *values, glint_gradient *out, glint_error *error)
{
    glint_status status = glint_program_make(builder, values, out->count, &out->programs[0], error);
    out->each = out->count;
    if (status != GLINT_ERR_INVALID)
        return status;
    out->each = GLINT_GRADIENT_PART;
    status = GLINT_OK;
    for (uint32_t k = 0; k < out->count && !status; k += out->each) {
        const uint32_t remaining = out->count - k, count = remaining < out->each ? remaining : out->each;
        status = glint_program_make(builder, values + k, count, &out->programs[k / out->each], error);
    }
    return status;
}

glint_status glint_shader_gradient(const glint_program *shader, uint32_t inputs, glint_gradient *out, glint_error *error)
{
    glint_slope_maker s = { .error = error };
    glint_value outputs[GLINT_PROGRAM_OUTPUTS_MAX], values[GLINT_GRADIENT_MAX];
    *out = (glint_gradient) { .count = 0 };
    begin(&s, shader, inputs, outputs);
    for (uint32_t c = 0; c < 3 && !s.status; c++)
        list_channel(&s, outputs, shader->code.output_count, c, inputs, out, values);
    if (out->count && !s.status)
        s.status = make_gradient(s.builder, values, out, error);
    return end(&s);
}

void glint_gradient_release(glint_gradient *gradient)
{
    for (size_t k = 0; k < GLINT_FORWARD_MAX; k++)
        glint_program_release(gradient->forward[k]);
    for (size_t k = 0; k < sizeof gradient->programs / sizeof *gradient->programs; k++)
        glint_program_release(gradient->programs[k]);
}

// ---- Shaders, forward ---------------------------------------------------------------------------------------------

/// Adds a share of a slope to a sum. GLINT_SLOPE_NOTHING stands for an empty sum.
static glint_value add_share(glint_slope_maker *s, glint_value sum, glint_value share, glint_value slope)
{
    double number = 0;
    const bool is_number = !s->status && glint_builder_is_number(s->builder, share, &number);
    const bool off = is_number && number == -1 && sum != GLINT_SLOPE_NOTHING;
    const glint_value term = off ? slope : two(s, GLINT_OP_MUL, share, slope);
    return sum == GLINT_SLOPE_NOTHING ? term : two(s, off ? GLINT_OP_SUB : GLINT_OP_ADD, sum, term);
}

/// Returns the slope of an operation's result from the slopes of its operands. A choice has the slope of the chosen
/// operand; the slope of any other operation is the sum of its partial derivatives, each times the slope of its
/// operand.
static glint_value find_slope(glint_slope_maker *s, glint_value i, const glint_value *slope)
{
    const glint_ssa_node node = s->builder->nodes[i];
    const uint32_t operands = glint_op_info_of((glint_op)node.op)->operands;
    glint_value sum = GLINT_SLOPE_NOTHING;
    if (node.op == GLINT_OP_SELECT) {
        const glint_value b = slope[node.operand[1]], c = slope[node.operand[2]], zero = glint_slope_number(s, 0);
        return glint_slope_op(s, GLINT_OP_SELECT, node.operand[0], b == GLINT_SLOPE_NOTHING ? zero : b,
                              c == GLINT_SLOPE_NOTHING ? zero : c);
    }
    s->given[i] = glint_slope_number(s, 1);
    glint_slope_pass(s, i);
    s->given[i] = GLINT_SLOPE_NOTHING;
    for (uint32_t k = 0; k < operands && !s->status; k++) {
        glint_value *share = &s->given[node.operand[k]];
        if (*share != GLINT_SLOPE_NOTHING && slope[node.operand[k]] != GLINT_SLOPE_NOTHING)
            sum = add_share(s, sum, *share, slope[node.operand[k]]);
        *share = GLINT_SLOPE_NOTHING;
    }
    return sum;
}

/// Computes the slopes of the program's own values.
static void find_slopes(glint_slope_maker *s, glint_value *slope)
{
    for (uint32_t i = 0; i < s->count && !s->status; i++) {
        const glint_ssa_node node = s->builder->nodes[i];
        slope[i] = GLINT_SLOPE_NOTHING;
        if (s->varies[i] && node.op == GLINT_SSA_INPUT)
            s->status = glint_builder_intern(s->builder, GLINT_SSA_INPUT, GLINT_INPUT_COUNT + node.operand[0], 0,
                                             &slope[i], s->error);
        else if (s->varies[i] && glint_ssa_is_op(&node))
            slope[i] = find_slope(s, i, slope);
    }
}

/// Returns the slope of channel c of a shader's light.
static glint_value sum_channel(glint_slope_maker *s, const glint_value *outputs, uint32_t output_count, uint32_t c,
                               const glint_value *slope)
{
    glint_value sum = GLINT_SLOPE_NOTHING;
    for (uint32_t k = c; k < output_count && !s->status; k += 3) {
        if (slope[outputs[k]] == GLINT_SLOPE_NOTHING)
            continue;
        const glint_value zero = glint_slope_number(s, 0);
        const glint_value own = glint_slope_op(s, GLINT_OP_SELECT, is_within(s, outputs[k]), slope[outputs[k]], zero);
        sum = sum == GLINT_SLOPE_NOTHING ? own : two(s, GLINT_OP_ADD, sum, own);
    }
    return sum == GLINT_SLOPE_NOTHING ? glint_slope_number(s, 0) : sum;
}

glint_status glint_shader_forward(const glint_program *shader, uint32_t inputs, glint_program **out, glint_error *error)
{
    glint_slope_maker s = { .error = error };
    glint_value outputs[GLINT_PROGRAM_OUTPUTS_MAX], values[3];
    *out = NULL;
    begin(&s, shader, inputs, outputs);
    glint_value *slope = s.status ? NULL : malloc((s.count + 1) * sizeof *slope);
    if (!s.status && !slope)
        s.status = glint_fail_nomem(error);
    if (!s.status)
        find_slopes(&s, slope);
    for (uint32_t c = 0; c < 3 && !s.status; c++)
        values[c] = sum_channel(&s, outputs, shader->code.output_count, c, slope);
    if (!s.status)
        s.status = glint_program_make(s.builder, values, 3, out, error);
    free(slope);
    const glint_status status = end(&s);
    return status == GLINT_ERR_INVALID ? GLINT_OK : status;
}

// ---- Derivatives by parameters ------------------------------------------------------------------------------------

/// Marks the values that depend on parameter number `parameter`. The copy numbers its parameters like the builder.
static void find_changing(glint_slope_maker *s, const glint_builder *builder, size_t parameter)
{
    find_varying(s, 0);
    for (uint32_t i = 0; i < s->count; i++) {
        const glint_ssa_node *node = &s->builder->nodes[i];
        if (node->op == GLINT_SSA_PARAMETER)
            s->varies[i] = builder->parameters[node->operand[0]][parameter] != 0;
        for (uint32_t k = 0; glint_ssa_is_op(node) && k < glint_op_info_of((glint_op)node->op)->operands; k++)
            s->varies[i] = s->varies[i] || s->varies[node->operand[k]];
    }
}

/// Returns the slope of an output by the parameter: a sum over all numbers that depend on the parameter.
static glint_value gather(glint_slope_maker *s, const glint_builder *builder, size_t parameter)
{
    glint_value sum = glint_slope_number(s, 0);
    bool any = false;
    for (uint32_t i = 0; i < s->count && !s->status; i++) {
        const glint_ssa_node node = s->builder->nodes[i];
        if (node.op != GLINT_SSA_PARAMETER || !s->varies[i] || s->given[i] == GLINT_SLOPE_NOTHING)
            continue;
        const glint_value share = two(s, GLINT_OP_MUL, s->given[i], glint_slope_number(s, builder->parameters[node.operand[0]][parameter]));
        sum = any ? two(s, GLINT_OP_ADD, sum, share) : share;
        any = true;
    }
    return sum;
}

glint_status glint_builder_tangent(const glint_builder *builder, const glint_value *outputs, size_t count, size_t parameter,
                                   glint_program **out, glint_error *error)
{
    glint_slope_maker s = { .error = error };
    glint_value *map = NULL, values[GLINT_PROGRAM_OUTPUTS_MAX];
    s.status = glint_builder_copy(builder, true, &s.builder, &map, error);
    s.count = s.builder ? s.builder->count : 0;
    s.given = malloc((s.count + 1) * sizeof *s.given);
    s.varies = calloc(s.count + 1, sizeof *s.varies);
    if (!s.status && (!s.given || !s.varies))
        s.status = glint_fail_nomem(error);
    if (!s.status)
        find_changing(&s, builder, parameter);
    for (size_t k = 0; k < count && !s.status; k++) {
        for (uint32_t i = 0; i < s.count; i++)
            s.given[i] = GLINT_SLOPE_NOTHING;
        glint_slope_give(&s, map[outputs[k]], glint_slope_number(&s, 1));
        walk_back(&s);
        values[k] = gather(&s, builder, parameter);
    }
    if (!s.status)
        s.status = glint_builder_close(s.builder, values, count, out, error);
    free(map);
    return end(&s);
}
