/// Derivatives of programs with respect to their inputs and constants, against central differences in 113 bits:
/// random formulas of all differentiable operations, at random points.
#include "engine/glint_math.h"
#include "engine/glint_programs.h"
#include "tests/hard/oracle/drive.h"
#include "tests/hard/oracle/quad.h"

#include <string.h>

#define NODES 12
#define STEP ((quad)1e-12)
#define PARAMETERS 3
#define OPERANDS 3 ///< most operands of any of these operations

/// A formula: each node is an operation on earlier nodes; the first nodes are the inputs and constants.
typedef struct formula {
    int count;
    glint_op op[NODES];
    int operand[NODES][OPERANDS];
} formula;

enum { INPUTS = 3, LEAVES = INPUTS + PARAMETERS };

static const glint_op ops[] = {
    GLINT_OP_ADD,    GLINT_OP_SUB,  GLINT_OP_MUL,    GLINT_OP_DIV,  GLINT_OP_NEG,        GLINT_OP_ABS,  GLINT_OP_SQRT,
    GLINT_OP_MIN,    GLINT_OP_MAX,  GLINT_OP_FRACT,  GLINT_OP_MULADD, GLINT_OP_SUBMUL,   GLINT_OP_MULSUB, GLINT_OP_MIX,
    GLINT_OP_LESS,   GLINT_OP_SELECT, GLINT_OP_STEP, GLINT_OP_SMOOTHSTEP, GLINT_OP_CLAMP, GLINT_OP_SIN, GLINT_OP_COS,
    GLINT_OP_EXP2,   GLINT_OP_LOG2, GLINT_OP_POW,    GLINT_OP_ATAN2, GLINT_OP_ACOS,
};

static quad least(quad a, quad b) { return a < b ? a : b; }
static quad most(quad a, quad b) { return a > b ? a : b; }

static quad ramp(quad a, quad b, quad x)
{
    const quad t = least(most((x - a) / (b - a), 0), 1);
    return t * t * (3 - 2 * t);
}

static quad apply(glint_op op, quad a, quad b, quad c)
{
    switch (op) {
    case GLINT_OP_ADD: return a + b;
    case GLINT_OP_SUB: return a - b;
    case GLINT_OP_MUL: return a * b;
    case GLINT_OP_DIV: return a / b;
    case GLINT_OP_NEG: return -a;
    case GLINT_OP_ABS: return a < 0 ? -a : a;
    case GLINT_OP_SQRT: return sqrtf128(a);
    case GLINT_OP_MIN: return least(a, b);
    case GLINT_OP_MAX: return most(a, b);
    case GLINT_OP_FRACT: return a - floorf128(a);
    case GLINT_OP_MULADD: return a * b + c;
    case GLINT_OP_SUBMUL: return a - b * c;
    case GLINT_OP_MULSUB: return a * b - c;
    case GLINT_OP_MIX: return a + c * (b - a);
    case GLINT_OP_LESS: return a < b;
    case GLINT_OP_SELECT: return a != 0 ? b : c;
    case GLINT_OP_STEP: return b < a ? 0 : 1;
    case GLINT_OP_SMOOTHSTEP: return ramp(a, b, c);
    case GLINT_OP_CLAMP: return least(most(a, b), c);
    case GLINT_OP_SIN: return sinf128(a);
    case GLINT_OP_COS: return cosf128(a);
    case GLINT_OP_EXP2: return exp2f128(a);
    case GLINT_OP_LOG2: return log2f128(a);
    case GLINT_OP_POW: return powf128(a, b);
    case GLINT_OP_ATAN2: return atan2f128(a, b);
    default: return acosf128(a);
    }
}

/// Returns whether an operation has no derivative, an unbounded one, or a value that rounding decides.
static bool is_steep(glint_op op, quad a, quad b, quad c)
{
    const quad size = a < 0 ? -a : a, other = b < 0 ? -b : b, width = a < b ? b - a : a - b, tie = 1e-9;
    const quad part = a - floorf128(a), over = most(a, b) - c;
    switch (op) {
    case GLINT_OP_ABS: return size < tie;
    case GLINT_OP_MIN:
    case GLINT_OP_MAX:
    case GLINT_OP_LESS:
    case GLINT_OP_STEP: return width < tie;
    case GLINT_OP_FRACT: return part < tie || part > 1 - tie;
    case GLINT_OP_SELECT: return size > 0 && size < tie;
    case GLINT_OP_CLAMP: return width < tie || (over < tie && over > -tie);
    case GLINT_OP_SQRT:
    case GLINT_OP_LOG2:
    case GLINT_OP_POW: return !(a > 1e-4);
    case GLINT_OP_DIV: return !(other > 1e-4);
    case GLINT_OP_ATAN2: return !(size + other > 1e-4);
    case GLINT_OP_ACOS: return !(size < 1 - 1e-4);
    case GLINT_OP_SMOOTHSTEP: return !(width > 1e-4);
    default: return false;
    }
}

/// Computes all nodes. Returns false when a node is steep, or when its value is far from 1,
/// where differences are inaccurate.
static bool evaluate(const formula *f, const quad *leaves, quad value[LEAVES + NODES])
{
    memcpy(value, leaves, LEAVES * sizeof *leaves);
    for (int i = 0; i < f->count; i++) {
        const int *at = f->operand[i];
        if (is_steep(f->op[i], value[at[0]], value[at[1]], value[at[2]]))
            return false;
        value[LEAVES + i] = apply(f->op[i], value[at[0]], value[at[1]], value[at[2]]);
        if (!(value[LEAVES + i] > -100 && value[LEAVES + i] < 100))
            return false;
    }
    return true;
}

static formula random_formula(void)
{
    formula f = { .count = 3 + (int)uniform(0, NODES - 3) };
    for (int i = 0; i < f.count; i++) {
        f.op[i] = ops[(size_t)uniform(0, sizeof ops / sizeof *ops)];
        for (int k = 0; k < OPERANDS; k++) // prefers recent nodes
            f.operand[i][k] = uniform(0, 1) < 0.5 && i > 0 ? LEAVES + i - 1 : (int)uniform(0, LEAVES + i);
    }
    return f;
}

static glint_program *make_program(const formula *f, const double *numbers, const double *slopes)
{
    glint_value values[LEAVES + NODES], operands[OPERANDS];
    glint_builder *builder;
    glint_program *program;
    glint_error error;
    must(glint_builder_create(GLINT_PROGRAM_PATTERN, &builder, &error), &error);
    for (int i = 0; i < INPUTS; i++)
        must(glint_builder_input(builder, (glint_input)(GLINT_INPUT_P_X + i), &values[i], &error), &error);
    for (int i = 0; i < PARAMETERS; i++)
        must(glint_builder_parameter(builder, numbers[i], &slopes[i], 1, &values[INPUTS + i], &error), &error);
    for (int i = 0; i < f->count; i++) {
        for (int k = 0; k < OPERANDS; k++)
            operands[k] = values[f->operand[i][k]];
        must(glint_builder_op(builder, f->op[i], operands, &values[LEAVES + i], &error), &error);
    }
    must(glint_builder_finish(builder, &values[LEAVES + f->count - 1], 1, &program, &error), &error);
    glint_builder_destroy(builder);
    return program;
}

/// Computes the derivative by differences with step `step`. Returns false when there is no derivative.
static bool difference(const formula *f, const quad *leaves, const double *slopes, quad step, quad *out)
{
    quad more[LEAVES], less[LEAVES], high[LEAVES + NODES], low[LEAVES + NODES];
    for (int i = 0; i < LEAVES; i++) {
        const quad by = i < INPUTS ? 0 : step * slopes[i - INPUTS];
        more[i] = leaves[i] + by;
        less[i] = leaves[i] - by;
    }
    if (!evaluate(f, more, high) || !evaluate(f, less, low))
        return false;
    *out = (high[LEAVES + f->count - 1] - low[LEAVES + f->count - 1]) / (2 * step);
    return true;
}

/// Checks one formula at several points. Returns the number of usable points.
static int compare(const formula *f, double *worst)
{
    double numbers[PARAMETERS], slopes[PARAMETERS], inputs[GLINT_INPUT_COUNT] = { 0 }, got, value;
    glint_error error;
    int told = 0;
    for (int i = 0; i < PARAMETERS; i++) {
        numbers[i] = uniform(0.1, 2);
        slopes[i] = uniform(-1, 1);
    }
    glint_program *program = make_program(f, numbers, slopes);
    const glint_program *tangent = glint_program_tangent(program, 0);
    hard_check(tangent && !glint_program_tangent(program, 1), "a program has tangents by what changes its numbers");
    for (int turn = 0; turn < 8; turn++) {
        quad leaves[LEAVES], want, wider, all[LEAVES + NODES];
        for (int i = 0; i < LEAVES; i++)
            leaves[i] = i < INPUTS ? (inputs[GLINT_INPUT_P_X + i] = uniform(0.1, 2)) : numbers[i - INPUTS];
        if (!evaluate(f, leaves, all) || !difference(f, leaves, slopes, STEP, &want) ||
            !difference(f, leaves, slopes, 1000 * STEP, &wider) || want > 1e4 || want < -1e4 || want - wider > 1e-9 ||
            wider - want > 1e-9)
            continue; // the point is at a kink or next to one
        must(glint_program_evaluate(tangent, inputs, &got, &error), &error);
        must(glint_program_evaluate(program, inputs, &value, &error), &error);
        const double off = fabs(got - (double)want) / (1 + fabs((double)want));
        *worst = fmax(*worst, off);
        hard_check(off < 1e-9 && fabs(value - (double)all[LEAVES + f->count - 1]) < 1e-9,
                   "last operation %s: %.17g, by differences %.17g", glint_op_info_of(f->op[f->count - 1])->name, got,
                   (double)want);
        told++;
    }
    glint_program_release(program);
    return told;
}

int main(int argc, char **argv)
{
    double worst = 0;
    int told = 0;
    hard_begin(argc, argv);
    hard_test("D3", "how programs change with their numbers");
    for (int turn = 0; turn < 20000; turn++) {
        const formula f = random_formula();
        told += compare(&f, &worst);
    }
    hard_check(told > 50000, "%d slopes compared", told);
    if (hard_table)
        printf("| slopes of programs by their numbers | %d | off by %.2g of 1 + the slope |\n", told, worst);
    return hard_end();
}
