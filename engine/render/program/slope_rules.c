/// The derivative rules: how each operation passes its adjoint on to its operands.
#include "engine/render/program/slope.h"

#include "engine/base/status.h"

#define LN_2 0x1.62e42fefa39efp-1
#define ONE_OVER_LN_2 0x1.71547652b82fep+0

// ---- Making values ------------------------------------------------------------------------------------------------

static void make(glint_slope_maker *s, glint_op op, uint32_t texture, const glint_value *operands, glint_value *out)
{
    for (uint32_t k = 0; k < GLINT_RESULTS_MAX; k++)
        out[k] = 0;
    if (!s->status)
        s->status = glint_builder_add(s->builder, op, texture, operands, out, s->error);
}

glint_value glint_slope_op(glint_slope_maker *s, glint_op op, glint_value a, glint_value b, glint_value c)
{
    const glint_value operands[GLINT_OPERANDS_MAX] = { a, b, c };
    glint_value out[GLINT_RESULTS_MAX];
    make(s, op, 0, operands, out);
    return out[0];
}

static glint_value two(glint_slope_maker *s, glint_op op, glint_value a, glint_value b) { return glint_slope_op(s, op, a, b, 0); }

static glint_value one(glint_slope_maker *s, glint_op op, glint_value a) { return glint_slope_op(s, op, a, 0, 0); }

static glint_value times(glint_slope_maker *s, glint_value a, glint_value b) { return two(s, GLINT_OP_MUL, a, b); }

glint_value glint_slope_number(glint_slope_maker *s, double x)
{
    glint_value out = 0;
    if (!s->status)
        s->status = glint_builder_number(s->builder, x, &out, s->error);
    return out;
}

static glint_value where(glint_slope_maker *s, glint_value condition, glint_value a)
{
    return glint_slope_op(s, GLINT_OP_SELECT, condition, a, glint_slope_number(s, 0));
}

static glint_value unless(glint_slope_maker *s, glint_value condition, glint_value a)
{
    return glint_slope_op(s, GLINT_OP_SELECT, condition, glint_slope_number(s, 0), a);
}

void glint_slope_give(glint_slope_maker *s, glint_value to, glint_value amount)
{
    if (s->status || !s->varies[to])
        return;
    s->given[to] = s->given[to] == GLINT_SLOPE_NOTHING ? amount : two(s, GLINT_OP_ADD, s->given[to], amount);
}

// ---- Rules: g is the adjoint of the result r; a, b, c are its operands --------------------------------------------

typedef struct rule_case {
    glint_op op;
    glint_value r, g, a, b, c;
} rule_case;

static void pass_exact(glint_slope_maker *s, const rule_case *x)
{
    const glint_value g = x->g, a = x->a, b = x->b;
    switch (x->op) {
    case GLINT_OP_ADD:
    case GLINT_OP_SUB:
        glint_slope_give(s, a, g);
        glint_slope_give(s, b, x->op == GLINT_OP_ADD ? g : one(s, GLINT_OP_NEG, g));
        break;
    case GLINT_OP_MUL:
        glint_slope_give(s, a, times(s, g, b));
        glint_slope_give(s, b, times(s, g, a));
        break;
    case GLINT_OP_DIV:
        glint_slope_give(s, a, two(s, GLINT_OP_DIV, g, b));
        if (s->varies[b])
            glint_slope_give(s, b, one(s, GLINT_OP_NEG, two(s, GLINT_OP_DIV, times(s, g, x->r), b)));
        break;
    case GLINT_OP_NEG: glint_slope_give(s, a, one(s, GLINT_OP_NEG, g)); break;
    case GLINT_OP_ABS: glint_slope_give(s, a, times(s, g, one(s, GLINT_OP_SIGN, a))); break;
    case GLINT_OP_SQRT: glint_slope_give(s, a, two(s, GLINT_OP_DIV, times(s, g, glint_slope_number(s, 0.5)), x->r)); break;
    case GLINT_OP_MIN:
    case GLINT_OP_MAX: {
        const bool least = x->op == GLINT_OP_MIN;
        const glint_value first = two(s, GLINT_OP_LESS, least ? a : b, least ? b : a);
        glint_slope_give(s, a, where(s, first, g));
        glint_slope_give(s, b, unless(s, first, g));
        break;
    }
    case GLINT_OP_FRACT: glint_slope_give(s, a, g); break;
    case GLINT_OP_MOD:
        glint_slope_give(s, a, g);
        if (s->varies[b])
            glint_slope_give(s, b, one(s, GLINT_OP_NEG, times(s, g, one(s, GLINT_OP_FLOOR, two(s, GLINT_OP_DIV, a, b)))));
        break;
    default: break; // floor, ceil, round, sign: their slope is 0 wherever it exists
    }
}

static void pass_pairs(glint_slope_maker *s, const rule_case *x)
{
    const glint_value g = x->g, a = x->a, b = x->b, c = x->c;
    switch (x->op) {
    case GLINT_OP_MULADD:
    case GLINT_OP_MULSUB:
        glint_slope_give(s, a, times(s, g, b));
        glint_slope_give(s, b, times(s, g, a));
        glint_slope_give(s, c, x->op == GLINT_OP_MULADD ? g : one(s, GLINT_OP_NEG, g));
        break;
    case GLINT_OP_SUBMUL: {
        const glint_value negated = one(s, GLINT_OP_NEG, g);
        glint_slope_give(s, a, g);
        glint_slope_give(s, b, times(s, negated, c));
        glint_slope_give(s, c, times(s, negated, b));
        break;
    }
    case GLINT_OP_MULMUL:
        glint_slope_give(s, a, times(s, times(s, g, b), c));
        glint_slope_give(s, b, times(s, times(s, g, a), c));
        if (s->varies[c])
            glint_slope_give(s, c, times(s, g, times(s, a, b)));
        break;
    default: // mix
        glint_slope_give(s, a, times(s, g, two(s, GLINT_OP_SUB, glint_slope_number(s, 1), c)));
        glint_slope_give(s, b, times(s, g, c));
        if (s->varies[c])
            glint_slope_give(s, c, times(s, g, two(s, GLINT_OP_SUB, b, a)));
    }
}

/// Passes on the derivative of t t (3 - 2 t) with t = (x - a) / (b - a): 6 t (1 - t), and 0 where t is clamped.
static void pass_smoothstep(glint_slope_maker *s, const rule_case *x)
{
    const glint_value width = two(s, GLINT_OP_SUB, x->b, x->a);
    const glint_value t =
        glint_slope_op(s, GLINT_OP_CLAMP, two(s, GLINT_OP_DIV, two(s, GLINT_OP_SUB, x->c, x->a), width),
                       glint_slope_number(s, 0), glint_slope_number(s, 1));
    const glint_value rest = two(s, GLINT_OP_SUB, glint_slope_number(s, 1), t);
    const glint_value steep =
        two(s, GLINT_OP_DIV, times(s, x->g, times(s, times(s, glint_slope_number(s, 6), t), rest)), width);
    glint_slope_give(s, x->c, steep);
    if (s->varies[x->a])
        glint_slope_give(s, x->a, one(s, GLINT_OP_NEG, times(s, steep, rest)));
    if (s->varies[x->b])
        glint_slope_give(s, x->b, one(s, GLINT_OP_NEG, times(s, steep, t)));
}

static void pass_choice(glint_slope_maker *s, const rule_case *x)
{
    const glint_value g = x->g;
    if (x->op == GLINT_OP_SELECT) {
        glint_slope_give(s, x->b, where(s, x->a, g));
        glint_slope_give(s, x->c, unless(s, x->a, g));
    } else if (x->op == GLINT_OP_CLAMP) {
        const glint_value above = two(s, GLINT_OP_LESS, x->b, x->a), high = two(s, GLINT_OP_MAX, x->a, x->b);
        const glint_value below = two(s, GLINT_OP_LESS, high, x->c), inside = where(s, below, g);
        glint_slope_give(s, x->a, where(s, above, inside));
        glint_slope_give(s, x->b, unless(s, above, inside));
        glint_slope_give(s, x->c, unless(s, below, g));
    } else if (x->op == GLINT_OP_SMOOTHSTEP) {
        pass_smoothstep(s, x);
    } // results of 0 or 1 have slope 0
}

static void pass_powers(glint_slope_maker *s, const rule_case *x)
{
    const glint_value g = x->g, a = x->a, b = x->b;
    const bool power = x->op == GLINT_OP_POW;
    const glint_value there = two(s, GLINT_OP_LESS, glint_slope_number(s, 0), a);
    if (s->varies[a] && power)
        glint_slope_give(s, a, times(s, times(s, g, b), two(s, GLINT_OP_POW, a, two(s, GLINT_OP_SUB, b, glint_slope_number(s, 1)))));
    else if (s->varies[a]) // highlight: x is clamped to 1
        glint_slope_give(s, a, where(s, two(s, GLINT_OP_LESS, a, glint_slope_number(s, 1)),
                         where(s, there, two(s, GLINT_OP_DIV, times(s, times(s, g, b), x->r), a))));
    if (s->varies[b]) {
        const glint_value base = power ? a : two(s, GLINT_OP_MIN, a, glint_slope_number(s, 1));
        const glint_value log = times(s, one(s, GLINT_OP_LOG2, base), glint_slope_number(s, LN_2));
        glint_slope_give(s, b, where(s, there, times(s, times(s, g, x->r), log)));
    }
}

static void pass_elementary(glint_slope_maker *s, const rule_case *x)
{
    const glint_value g = x->g, a = x->a, b = x->b;
    switch (x->op) {
    case GLINT_OP_SIN: glint_slope_give(s, a, times(s, g, one(s, GLINT_OP_COS, a))); break;
    case GLINT_OP_COS: glint_slope_give(s, a, one(s, GLINT_OP_NEG, times(s, g, one(s, GLINT_OP_SIN, a)))); break;
    case GLINT_OP_EXP2: glint_slope_give(s, a, times(s, times(s, g, x->r), glint_slope_number(s, LN_2))); break;
    case GLINT_OP_LOG2: glint_slope_give(s, a, two(s, GLINT_OP_DIV, times(s, g, glint_slope_number(s, ONE_OVER_LN_2)), a)); break;
    case GLINT_OP_ATAN2: {
        const glint_value share = two(s, GLINT_OP_DIV, g, glint_slope_op(s, GLINT_OP_MULADD, a, a, times(s, b, b)));
        glint_slope_give(s, a, times(s, share, b));
        glint_slope_give(s, b, one(s, GLINT_OP_NEG, times(s, share, a)));
        break;
    }
    case GLINT_OP_ACOS: {
        const glint_value unit = glint_slope_number(s, 1);
        const glint_value square = times(s, two(s, GLINT_OP_SUB, unit, a), two(s, GLINT_OP_ADD, unit, a));
        glint_slope_give(s, a, one(s, GLINT_OP_NEG, two(s, GLINT_OP_DIV, g, one(s, GLINT_OP_SQRT, square))));
        break;
    }
    default: pass_powers(s, x);
    }
}

static void pass_on(glint_slope_maker *s, const rule_case *x)
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

// ---- Operations with kernels for their slopes ---------------------------------------------------------------------

/// Passes on the adjoint of one result of an operation that has a kernel for its slopes. The derivatives by `count`
/// operands start at `slope`, `apart` values from one to the next.
static void pass_slopes(glint_slope_maker *s, const glint_ssa_node *node, glint_value g, const glint_value *slope, int count,
                        int apart)
{
    for (int k = 0; k < count; k++)
        glint_slope_give(s, node->operand[k], times(s, g, slope[k * apart]));
}

static void pass_pattern(glint_slope_maker *s, const glint_ssa_node *node, uint32_t part, glint_value g)
{
    glint_value operands[GLINT_OPERANDS_MAX], slope[GLINT_RESULTS_MAX];
    for (int k = 0; k < GLINT_OPERANDS_MAX; k++)
        operands[k] = node->operand[k];
    switch ((glint_op)node->op) {
    case GLINT_OP_NOISE:
    case GLINT_OP_NOISE3:
        operands[3] = glint_slope_number(s, node->op == GLINT_OP_NOISE ? 0 : part + 1);
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
    default: break; // hash and parity: their slope is 0 wherever it exists
    }
}

static void pass_dot(glint_slope_maker *s, const glint_ssa_node *node, glint_value g)
{
    for (int k = 4; k >= 0; k -= 2) {
        glint_slope_give(s, node->operand[k], times(s, g, node->operand[k + 1]));
        glint_slope_give(s, node->operand[k + 1], times(s, g, node->operand[k]));
    }
}

void glint_slope_pass(glint_slope_maker *s, glint_value i)
{
    const glint_ssa_node node = s->builder->nodes[i];
    const rule_case x = { (glint_op)node.op, i, s->given[i], node.operand[0], node.operand[1], node.operand[2] };
    if (node.op == GLINT_OP_DOT)
        pass_dot(s, &node, x.g);
    else if (node.op >= GLINT_OP_NOISE && node.op != GLINT_OP_MULMUL)
        pass_pattern(s, &node, node.part, x.g);
    else
        pass_on(s, &x);
}
