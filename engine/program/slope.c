/// The derivatives of a program, in reverse: from the output back to the inputs, each value passes on what it was given
/// to the operands that it was made of, times its derivative by them (A. Griewank and A. Walther, "Evaluating
/// Derivatives", SIAM 2008).
#include "engine/program/builder.h"

#include "engine/base/status.h"

#include <stdlib.h>

#define NOTHING UINT32_MAX
#define LN_2 0x1.62e42fefa39efp-1
#define ONE_OVER_LN_2 0x1.71547652b82fep+0

typedef struct slope_maker {
    glint_builder *builder;
    uint32_t count; ///< values of the program itself; those of its derivatives follow
    glint_value *given; ///< what each value was given so far; NOTHING
    bool *varies; ///< depends on an input that counts
    glint_status status; ///< of the first failure; what is made after it means nothing
    glint_error *error;
} slope_maker;

// ---- Making values ------------------------------------------------------------------------------------------------

static void make(slope_maker *s, glint_op op, uint32_t texture, const glint_value *operands, glint_value *out)
{
    for (uint32_t k = 0; k < GLINT_RESULTS_MAX; k++)
        out[k] = 0;
    if (!s->status)
        s->status = glint_builder_add(s->builder, op, texture, operands, out, s->error);
}

static glint_value three(slope_maker *s, glint_op op, glint_value a, glint_value b, glint_value c)
{
    const glint_value operands[GLINT_OPERANDS_MAX] = { a, b, c };
    glint_value out[GLINT_RESULTS_MAX];
    make(s, op, 0, operands, out);
    return out[0];
}

static glint_value two(slope_maker *s, glint_op op, glint_value a, glint_value b) { return three(s, op, a, b, 0); }

static glint_value one(slope_maker *s, glint_op op, glint_value a) { return three(s, op, a, 0, 0); }

static glint_value times(slope_maker *s, glint_value a, glint_value b) { return two(s, GLINT_OP_MUL, a, b); }

static glint_value number(slope_maker *s, double x)
{
    glint_value out = 0;
    if (!s->status)
        s->status = glint_builder_number(s->builder, x, &out, s->error);
    return out;
}

static glint_value where(slope_maker *s, glint_value condition, glint_value a)
{
    return three(s, GLINT_OP_SELECT, condition, a, number(s, 0));
}

static glint_value unless(slope_maker *s, glint_value condition, glint_value a)
{
    return three(s, GLINT_OP_SELECT, condition, number(s, 0), a);
}

static void give(slope_maker *s, glint_value to, glint_value what)
{
    if (s->status || !s->varies[to])
        return;
    s->given[to] = s->given[to] == NOTHING ? what : two(s, GLINT_OP_ADD, s->given[to], what);
}

// ---- Rules: g is what result r was given, a, b, c are its operands ------------------------------------------------

typedef struct rule_case {
    glint_op op;
    glint_value r, g, a, b, c;
} rule_case;

static void pass_exact(slope_maker *s, const rule_case *x)
{
    const glint_value g = x->g, a = x->a, b = x->b;
    switch (x->op) {
    case GLINT_OP_ADD:
    case GLINT_OP_SUB:
        give(s, a, g);
        give(s, b, x->op == GLINT_OP_ADD ? g : one(s, GLINT_OP_NEG, g));
        break;
    case GLINT_OP_MUL:
        give(s, a, times(s, g, b));
        give(s, b, times(s, g, a));
        break;
    case GLINT_OP_DIV:
        give(s, a, two(s, GLINT_OP_DIV, g, b));
        if (s->varies[b])
            give(s, b, one(s, GLINT_OP_NEG, two(s, GLINT_OP_DIV, times(s, g, x->r), b)));
        break;
    case GLINT_OP_NEG: give(s, a, one(s, GLINT_OP_NEG, g)); break;
    case GLINT_OP_ABS: give(s, a, times(s, g, one(s, GLINT_OP_SIGN, a))); break;
    case GLINT_OP_SQRT: give(s, a, two(s, GLINT_OP_DIV, times(s, g, number(s, 0.5)), x->r)); break;
    case GLINT_OP_MIN:
    case GLINT_OP_MAX: {
        const bool least = x->op == GLINT_OP_MIN;
        const glint_value first = two(s, GLINT_OP_LESS, least ? a : b, least ? b : a);
        give(s, a, where(s, first, g));
        give(s, b, unless(s, first, g));
        break;
    }
    case GLINT_OP_FRACT: give(s, a, g); break;
    case GLINT_OP_MOD:
        give(s, a, g);
        if (s->varies[b])
            give(s, b, one(s, GLINT_OP_NEG, times(s, g, one(s, GLINT_OP_FLOOR, two(s, GLINT_OP_DIV, a, b)))));
        break;
    default: break; // floor, ceil, round, sign: level wherever they have a slope
    }
}

static void pass_pairs(slope_maker *s, const rule_case *x)
{
    const glint_value g = x->g, a = x->a, b = x->b, c = x->c;
    switch (x->op) {
    case GLINT_OP_MULADD:
    case GLINT_OP_MULSUB:
        give(s, a, times(s, g, b));
        give(s, b, times(s, g, a));
        give(s, c, x->op == GLINT_OP_MULADD ? g : one(s, GLINT_OP_NEG, g));
        break;
    case GLINT_OP_SUBMUL: {
        const glint_value turned = one(s, GLINT_OP_NEG, g);
        give(s, a, g);
        give(s, b, times(s, turned, c));
        give(s, c, times(s, turned, b));
        break;
    }
    case GLINT_OP_MULMUL:
        give(s, a, times(s, times(s, g, b), c));
        give(s, b, times(s, times(s, g, a), c));
        if (s->varies[c])
            give(s, c, times(s, g, times(s, a, b)));
        break;
    default: // mix
        give(s, a, times(s, g, two(s, GLINT_OP_SUB, number(s, 1), c)));
        give(s, b, times(s, g, c));
        if (s->varies[c])
            give(s, c, times(s, g, two(s, GLINT_OP_SUB, b, a)));
    }
}

/// t t (3 - 2 t): 6 t (1 - t), and 0 where t is at an end; t = (x - a) / (b - a).
static void pass_smoothstep(slope_maker *s, const rule_case *x)
{
    const glint_value way = two(s, GLINT_OP_SUB, x->b, x->a);
    const glint_value t = three(s, GLINT_OP_CLAMP, two(s, GLINT_OP_DIV, two(s, GLINT_OP_SUB, x->c, x->a), way),
                                number(s, 0), number(s, 1));
    const glint_value rest = two(s, GLINT_OP_SUB, number(s, 1), t);
    const glint_value steep = two(s, GLINT_OP_DIV, times(s, x->g, times(s, times(s, number(s, 6), t), rest)), way);
    give(s, x->c, steep);
    if (s->varies[x->a])
        give(s, x->a, one(s, GLINT_OP_NEG, times(s, steep, rest)));
    if (s->varies[x->b])
        give(s, x->b, one(s, GLINT_OP_NEG, times(s, steep, t)));
}

static void pass_choice(slope_maker *s, const rule_case *x)
{
    const glint_value g = x->g;
    if (x->op == GLINT_OP_SELECT) {
        give(s, x->b, where(s, x->a, g));
        give(s, x->c, unless(s, x->a, g));
    } else if (x->op == GLINT_OP_CLAMP) {
        const glint_value above = two(s, GLINT_OP_LESS, x->b, x->a), high = two(s, GLINT_OP_MAX, x->a, x->b);
        const glint_value below = two(s, GLINT_OP_LESS, high, x->c), inside = where(s, below, g);
        give(s, x->a, where(s, above, inside));
        give(s, x->b, unless(s, above, inside));
        give(s, x->c, unless(s, below, g));
    } else if (x->op == GLINT_OP_SMOOTHSTEP) {
        pass_smoothstep(s, x);
    } // what is 0 or 1 is level
}

static void pass_powers(slope_maker *s, const rule_case *x)
{
    const glint_value g = x->g, a = x->a, b = x->b;
    const bool power = x->op == GLINT_OP_POW;
    const glint_value there = two(s, GLINT_OP_LESS, number(s, 0), a);
    if (s->varies[a] && power)
        give(s, a, times(s, times(s, g, b), two(s, GLINT_OP_POW, a, two(s, GLINT_OP_SUB, b, number(s, 1)))));
    else if (s->varies[a]) // highlight: x beyond 1 is 1
        give(s, a, where(s, two(s, GLINT_OP_LESS, a, number(s, 1)),
                         where(s, there, two(s, GLINT_OP_DIV, times(s, times(s, g, b), x->r), a))));
    if (s->varies[b]) {
        const glint_value base = power ? a : two(s, GLINT_OP_MIN, a, number(s, 1));
        const glint_value log = times(s, one(s, GLINT_OP_LOG2, base), number(s, LN_2));
        give(s, b, where(s, there, times(s, times(s, g, x->r), log)));
    }
}

static void pass_elementary(slope_maker *s, const rule_case *x)
{
    const glint_value g = x->g, a = x->a, b = x->b;
    switch (x->op) {
    case GLINT_OP_SIN: give(s, a, times(s, g, one(s, GLINT_OP_COS, a))); break;
    case GLINT_OP_COS: give(s, a, one(s, GLINT_OP_NEG, times(s, g, one(s, GLINT_OP_SIN, a)))); break;
    case GLINT_OP_EXP2: give(s, a, times(s, times(s, g, x->r), number(s, LN_2))); break;
    case GLINT_OP_LOG2: give(s, a, two(s, GLINT_OP_DIV, times(s, g, number(s, ONE_OVER_LN_2)), a)); break;
    case GLINT_OP_ATAN2: {
        const glint_value share = two(s, GLINT_OP_DIV, g, three(s, GLINT_OP_MULADD, a, a, times(s, b, b)));
        give(s, a, times(s, share, b));
        give(s, b, one(s, GLINT_OP_NEG, times(s, share, a)));
        break;
    }
    case GLINT_OP_ACOS: {
        const glint_value unit = number(s, 1);
        const glint_value square = times(s, two(s, GLINT_OP_SUB, unit, a), two(s, GLINT_OP_ADD, unit, a));
        give(s, a, one(s, GLINT_OP_NEG, two(s, GLINT_OP_DIV, g, one(s, GLINT_OP_SQRT, square))));
        break;
    }
    default: pass_powers(s, x);
    }
}

static void pass_on(slope_maker *s, const rule_case *x)
{
    if (x->op < GLINT_OP_MULADD)
        pass_exact(s, x);
    else if (x->op < GLINT_OP_LESS || x->op == GLINT_OP_MULMUL)
        pass_pairs(s, x);
    else if (x->op < GLINT_OP_SIN)
        pass_choice(s, x);
    else if (x->op < GLINT_OP_NOISE)
        pass_elementary(s, x);
}

// ---- Operations whose slopes have kernels of their own ------------------------------------------------------------

/// One result of such an operation: `slope` begins its derivatives by `count` operands, `apart` from one to the next.
static void pass_slopes(slope_maker *s, const glint_ssa_node *node, glint_value g, const glint_value *slope, int count,
                        int apart)
{
    for (int k = 0; k < count; k++)
        give(s, node->operand[k], times(s, g, slope[k * apart]));
}

static void pass_pattern(slope_maker *s, const glint_ssa_node *node, uint32_t part, glint_value g)
{
    glint_value operands[GLINT_OPERANDS_MAX], slope[GLINT_RESULTS_MAX];
    for (int k = 0; k < GLINT_OPERANDS_MAX; k++)
        operands[k] = node->operand[k];
    switch ((glint_op)node->op) {
    case GLINT_OP_NOISE:
    case GLINT_OP_NOISE3:
        operands[3] = number(s, node->op == GLINT_OP_NOISE ? 0 : part + 1);
        make(s, GLINT_OP_NOISE_SLOPE, 0, operands, slope);
        pass_slopes(s, node, g, slope, 3, 1);
        break;
    case GLINT_OP_CELL:
        make(s, GLINT_OP_CELL_SLOPE, 0, operands, slope);
        pass_slopes(s, node, g, slope + 3 * part, 3, 1);
        break;
    case GLINT_OP_TEXEL:
        make(s, GLINT_OP_TEXEL_SLOPE, node->texture, operands, slope);
        pass_slopes(s, node, g, slope + part, 2, 4);
        break;
    default: break; // hash and parity: level wherever they have a slope
    }
}

// ---- The program --------------------------------------------------------------------------------------------------

/// What is in a row, an input or a number. row: of each row the value that is in it.
static glint_value value_in(slope_maker *s, const glint_program_code *code, const glint_value *row, uint32_t from)
{
    glint_value out = 0;
    if (from < GLINT_ROW_INPUT)
        return row[from];
    if (from >= GLINT_ROW_NUMBER)
        return number(s, code->numbers[from - GLINT_ROW_NUMBER][0]);
    if (!s->status)
        s->status = glint_builder_input(s->builder, (glint_input)(from - GLINT_ROW_INPUT), &out, s->error);
    return out;
}

/// Builds the program's values once more, and gives its outputs.
static void copy_values(slope_maker *s, const glint_program *program, glint_value outputs[GLINT_PROGRAM_OUTPUTS_MAX])
{
    const glint_program_code *code = &program->code;
    glint_value row[GLINT_PROGRAM_ROWS_MAX] = { 0 }, operands[GLINT_OPERANDS_MAX], results[GLINT_RESULTS_MAX];
    for (uint32_t at = 0; at < code->length && !s->status; at++) {
        const glint_instruction *in = &code->instructions[at];
        uint32_t texture = 0;
        for (uint32_t k = 0; k < in->operands; k++)
            operands[k] = value_in(s, code, row, in->in[k]);
        if (in->op >= GLINT_OP_TEXEL && !s->status)
            s->status = glint_builder_texture(s->builder, program->textures[in->texture], &texture, s->error);
        make(s, (glint_op)in->op, texture, operands, results);
        for (uint32_t k = 0; k < in->results; k++)
            row[in->out[k]] = results[k];
    }
    for (uint32_t k = 0; k < code->output_count; k++)
        outputs[k] = value_in(s, code, row, code->outputs[k]);
}

static void find_what_varies(slope_maker *s, uint32_t inputs)
{
    const glint_ssa_node *nodes = s->builder->nodes;
    for (uint32_t i = 0; i < s->count; i++) {
        s->given[i] = NOTHING;
        if (nodes[i].op == GLINT_SSA_INPUT)
            s->varies[i] = inputs >> nodes[i].operand[0] & 1;
        for (uint32_t k = 0; glint_ssa_is_op(&nodes[i]) && k < glint_op_info_of((glint_op)nodes[i].op)->operands; k++)
            s->varies[i] = s->varies[i] || s->varies[nodes[i].operand[k]];
    }
}

static void walk_back(slope_maker *s)
{
    for (uint32_t i = s->count; i-- > 0 && !s->status;) {
        const glint_ssa_node node = s->builder->nodes[i];
        const glint_value g = s->given[i];
        if (g == NOTHING || !glint_ssa_is_op(&node))
            continue;
        const rule_case x = { (glint_op)node.op, i, g, node.operand[0], node.operand[1], node.operand[2] };
        if (node.op >= GLINT_OP_NOISE && node.op != GLINT_OP_MULMUL)
            pass_pattern(s, &node, node.part, g);
        else
            pass_on(s, &x);
    }
}

static void finish(slope_maker *s, const glint_input *inputs, size_t count, glint_program **out)
{
    glint_value outputs[GLINT_PROGRAM_OUTPUTS_MAX];
    for (size_t k = 0; k < count && !s->status; k++) {
        glint_value input;
        s->status = glint_builder_input(s->builder, inputs[k], &input, s->error);
        outputs[k] =
            !s->status && input < s->count && s->given[input] != NOTHING ? s->given[input] : number(s, 0);
    }
    if (!s->status)
        s->status = glint_program_make(s->builder, outputs, count, out, s->error);
}

/// Begins with a program's values; `inputs`, a bit each, count.
static void begin(slope_maker *s, const glint_program *program, uint32_t inputs, glint_value outputs[GLINT_PROGRAM_OUTPUTS_MAX])
{
    s->status = glint_builder_create(program->kind, &s->builder, s->error);
    if (s->status)
        return;
    copy_values(s, program, outputs);
    s->count = s->builder->count;
    s->given = malloc((s->count + 1) * sizeof *s->given);
    s->varies = calloc(s->count + 1, sizeof *s->varies);
    if (!s->status && (!s->given || !s->varies))
        s->status = glint_fail_nomem(s->error);
    if (!s->status)
        find_what_varies(s, inputs);
}

static glint_status end(slope_maker *s)
{
    free(s->given);
    free(s->varies);
    glint_builder_destroy(s->builder);
    return s->status;
}

glint_status glint_program_slope(const glint_program *program, const glint_input *inputs, size_t count,
                                 glint_program **out, glint_error *error)
{
    slope_maker s = { .error = error };
    glint_value outputs[GLINT_PROGRAM_OUTPUTS_MAX];
    uint32_t wanted = 0;
    if (count < 1 || count > GLINT_PROGRAM_OUTPUTS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "count: 1 .. %d inputs expected, got %zu",
                          GLINT_PROGRAM_OUTPUTS_MAX, count);
    for (size_t k = 0; k < count; k++)
        wanted |= 1u << inputs[k];
    begin(&s, program, wanted, outputs);
    if (!s.status) {
        give(&s, outputs[0], number(&s, 1));
        walk_back(&s);
        finish(&s, inputs, count, out);
    }
    return end(&s);
}

// ---- Of shaders ---------------------------------------------------------------------------------------------------

/// 1 where an output is taken as it is, 0 where it is bounded.
static glint_value is_within(slope_maker *s, glint_value output)
{
    return two(s, GLINT_OP_AND, two(s, GLINT_OP_LESS, number(s, 0), output),
               two(s, GLINT_OP_LESSEQ, output, number(s, GLINT_REFLECTANCE_MAX)));
}

/// Lists the slopes of channel c of a shader's light that are not 0 everywhere.
static void list_channel(slope_maker *s, const glint_value *outputs, uint32_t output_count, uint32_t c, uint32_t inputs,
                         glint_gradient *out, glint_value *values)
{
    for (uint32_t i = 0; i < s->count; i++)
        s->given[i] = NOTHING;
    for (uint32_t k = c; k < output_count; k += 3)
        give(s, outputs[k], is_within(s, outputs[k]));
    walk_back(s);
    for (uint32_t i = 0; i < s->count && !s->status; i++) {
        const glint_ssa_node *node = &s->builder->nodes[i];
        if (node->op != GLINT_SSA_INPUT || s->given[i] == NOTHING || !(inputs >> node->operand[0] & 1))
            continue;
        values[out->count] = s->given[i];
        out->of[out->count++] = (glint_gradient_place) { c, node->operand[0] };
    }
}

/// One program finds what its slopes share once.
static glint_status make_gradient(const glint_builder *builder, const glint_value *values, glint_gradient *out, glint_error *error)
{
    glint_status status = glint_program_make(builder, values, out->count, &out->programs[0], error);
    out->each = out->count;
    if (status != GLINT_ERR_INVALID)
        return status;
    out->each = GLINT_GRADIENT_PART;
    status = GLINT_OK;
    for (uint32_t k = 0; k < out->count && !status; k += out->each) {
        const uint32_t left = out->count - k, count = left < out->each ? left : out->each;
        status = glint_program_make(builder, values + k, count, &out->programs[k / out->each], error);
    }
    return status;
}

glint_status glint_shader_gradient(const glint_program *shader, uint32_t inputs, glint_gradient *out, glint_error *error)
{
    slope_maker s = { .error = error };
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
    for (size_t k = 0; k < sizeof gradient->programs / sizeof *gradient->programs; k++)
        glint_program_release(gradient->programs[k]);
}

// ---- By parameters ------------------------------------------------------------------------------------------------

/// What depends on parameter number `parameter`. The copy's parameters have the numbers of the builder's.
static void find_what_changes(slope_maker *s, const glint_builder *builder, size_t parameter)
{
    find_what_varies(s, 0);
    for (uint32_t i = 0; i < s->count; i++) {
        const glint_ssa_node *node = &s->builder->nodes[i];
        if (node->op == GLINT_SSA_PARAMETER)
            s->varies[i] = builder->parameters[node->operand[0]][parameter] != 0;
        for (uint32_t k = 0; glint_ssa_is_op(node) && k < glint_op_info_of((glint_op)node->op)->operands; k++)
            s->varies[i] = s->varies[i] || s->varies[node->operand[k]];
    }
}

/// What an output was given by all numbers that change, as fast as they do.
static glint_value gather(slope_maker *s, const glint_builder *builder, size_t parameter)
{
    glint_value sum = number(s, 0);
    bool any = false;
    for (uint32_t i = 0; i < s->count && !s->status; i++) {
        const glint_ssa_node node = s->builder->nodes[i];
        if (node.op != GLINT_SSA_PARAMETER || !s->varies[i] || s->given[i] == NOTHING)
            continue;
        const glint_value share = times(s, s->given[i], number(s, builder->parameters[node.operand[0]][parameter]));
        sum = any ? two(s, GLINT_OP_ADD, sum, share) : share;
        any = true;
    }
    return sum;
}

glint_status glint_builder_tangent(const glint_builder *builder, const glint_value *outputs, size_t count, size_t parameter,
                                   glint_program **out, glint_error *error)
{
    slope_maker s = { .error = error };
    glint_value *map = NULL, values[GLINT_PROGRAM_OUTPUTS_MAX];
    s.status = glint_builder_copy(builder, true, &s.builder, &map, error);
    s.count = s.builder ? s.builder->count : 0;
    s.given = malloc((s.count + 1) * sizeof *s.given);
    s.varies = calloc(s.count + 1, sizeof *s.varies);
    if (!s.status && (!s.given || !s.varies))
        s.status = glint_fail_nomem(error);
    if (!s.status)
        find_what_changes(&s, builder, parameter);
    for (size_t k = 0; k < count && !s.status; k++) {
        for (uint32_t i = 0; i < s.count; i++)
            s.given[i] = NOTHING;
        give(&s, map[outputs[k]], number(&s, 1));
        walk_back(&s);
        values[k] = gather(&s, builder, parameter);
    }
    if (!s.status)
        s.status = glint_builder_close(s.builder, values, count, out, error);
    free(map);
    return end(&s);
}
