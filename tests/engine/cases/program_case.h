/// Random programs for the tests: a recipe that can be built several times,
/// with and without the builder's optimisations.
#ifndef GLINT_PROGRAM_CASE_H
#define GLINT_PROGRAM_CASE_H

#include "engine/render/program/builder.h"
#include "tests/engine/cases/stage_case.h"

enum { RECIPE_STEPS = 60 };

typedef struct recipe_step {
    glint_op op; ///< an operation, GLINT_SSA_INPUT or GLINT_SSA_NUMBER
    uint32_t operand[GLINT_OPERANDS_MAX]; ///< indices of earlier values
    double number;
} recipe_step;

typedef struct recipe {
    recipe_step step[RECIPE_STEPS];
    uint32_t step_count, value_count;
    uint32_t output[3], output_count;
} recipe;

static glint_texture *recipe_texture; ///< texture that the program reads; NULL: the program reads no texels

/// Returns a typical decimal number or, if `odd`, sometimes a special value.
static inline double recipe_number(bool odd)
{
    static const double usual[] = { 0, 1, 2, 0.5, -1, 3, 10, 0.1, 0.25, -0.5, 100, 1e7 };
    return maybe_odd(odd, one_in(2) ? usual[below(COUNT_OF(usual))] : between(-4, 4));
}

static inline bool recipe_may_have(glint_op op)
{
    return recipe_texture || (op != GLINT_OP_TEXEL && op != GLINT_OP_TEXEL_SLOPE);
}

static inline void recipe_add(recipe *r, recipe_step step, uint32_t results)
{
    r->step[r->step_count++] = step;
    r->value_count += results;
}

/// Makes a random recipe: inputs, then numbers, then operations on earlier values, often on numbers.
static inline recipe random_recipe(bool odd)
{
    recipe r = { .output_count = one_in(2) ? 1 : 3 };
    const uint32_t reads = 1 + below(5), numbers = 1 + below(5), operations = below(RECIPE_STEPS - 12);
    for (uint32_t i = 0; i < reads; i++)
        recipe_add(&r, (recipe_step) { .op = GLINT_SSA_INPUT, .operand = { below(GLINT_INPUT_L_X) } }, 1);
    for (uint32_t i = 0; i < numbers; i++)
        recipe_add(&r, (recipe_step) { .op = GLINT_SSA_NUMBER, .number = recipe_number(odd) }, 1);
    for (uint32_t i = 0; i < operations;) {
        recipe_step step = { .op = (glint_op)below(GLINT_OP_COUNT) };
        if (one_in(3))
            step.op = (glint_op)below(GLINT_OP_LESS);
        if (!recipe_may_have(step.op))
            continue;
        for (int k = 0; k < GLINT_OPERANDS_MAX; k++)
            step.operand[k] = one_in(3) ? reads + below(numbers) : below(r.value_count);
        if (step.op == GLINT_OP_NOISE_SLOPE)
            step.operand[3] = reads; // a placeholder: recipe_op replaces it
        recipe_add(&r, step, glint_op_info_of(step.op)->results);
        i++;
    }
    for (uint32_t k = 0; k < r.output_count; k++)
        r.output[k] = one_in(8) ? below(r.value_count) : r.value_count - 1 - below(r.value_count < 6 ? 1 : 6);
    return r;
}

static inline glint_status recipe_op(glint_builder *b, const recipe_step *step, const glint_value *value,
                                     glint_value *out, glint_error *error)
{
    glint_value operands[GLINT_OPERANDS_MAX];
    uint32_t texture = 0;
    for (int k = 0; k < GLINT_OPERANDS_MAX; k++)
        operands[k] = value[step->operand[k]];
    if (step->op == GLINT_OP_NOISE_SLOPE && glint_builder_number(b, step->operand[0] & 3, &operands[3], error))
        return GLINT_ERR_NOMEM;
    if (step->op >= GLINT_OP_TEXEL && glint_builder_texture(b, recipe_texture, &texture, error))
        return GLINT_ERR_NOMEM;
    return glint_builder_add(b, step->op, texture, operands, out, error);
}

/// Builds the recipe's program; if `plain`, without folding, sharing or fusing.
static inline glint_program *recipe_build(const recipe *r, bool plain)
{
    glint_builder *b;
    glint_program *program = NULL;
    glint_error error;
    glint_value value[RECIPE_STEPS * GLINT_RESULTS_MAX], output[3];
    uint32_t count = 0;
    glint_status status = glint_builder_create(GLINT_PROGRAM_PATTERN, &b, &error);
    b->plain = plain;
    for (uint32_t i = 0; i < r->step_count && !status; i++) {
        const recipe_step *step = &r->step[i];
        if (step->op == (glint_op)GLINT_SSA_INPUT)
            status = glint_builder_input(b, (glint_input)step->operand[0], &value[count], &error);
        else if (step->op == (glint_op)GLINT_SSA_NUMBER)
            status = glint_builder_number(b, step->number, &value[count], &error);
        else
            status = recipe_op(b, step, value, &value[count], &error);
        count += step->op < GLINT_OP_COUNT ? glint_op_info_of(step->op)->results : 1;
    }
    for (uint32_t k = 0; k < r->output_count; k++)
        output[k] = value[r->output[k]];
    if (!status)
        status = glint_builder_finish(b, output, r->output_count, &program, &error);
    glint_builder_destroy(b);
    if (status)
        fail_msg("%s", error.message);
    return program;
}

/// Returns stage arguments for a program, with random points. The caller provides the outputs.
static inline glint_program_args program_inputs(const glint_program *program, uint32_t groups, bool odd)
{
    glint_program_args args = { .code = &program->code, .group_count = groups };
    for (uint32_t i = 0; i < GLINT_INPUT_COUNT; i++) {
        double *row = input(KIND_DOUBLE, groups * GLINT_GROUP), scale = one_in(4) ? 1e7 : 10;
        for (uint32_t lane = 0; lane < groups * GLINT_GROUP; lane++)
            row[lane] = maybe_odd(odd, one_in(10) ? (double)below(9) - 4 : between(-scale, scale));
        args.input[i] = row;
        args.same |= one_in(4) ? 1u << i : 0;
        for (uint32_t lane = 0; args.same >> i & 1 && lane < GLINT_NUMBER_LANES; lane++)
            row[lane] = row[0];
    }
    args.rows = input(KIND_DOUBLE, (program->code.row_count + 1) * GLINT_PROGRAM_LANES);
    return args;
}

#endif
