/// A background that a program gives, by the direction in which rays leave the scene.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/plan/plan.h"
#include "engine/program/builder.h"

#include <stdlib.h>

#define TURN 0x1.921fb54442d18p+2 // 2 pi

/// A builder and its first error: calls after it do nothing.
typedef struct maker {
    glint_builder *builder;
    glint_status status;
    glint_error *error;
} maker;

static glint_value number(maker *m, double x)
{
    glint_value out = 0;
    if (!m->status)
        m->status = glint_builder_number(m->builder, x, &out, m->error);
    return out;
}

static glint_value input(maker *m, glint_input which)
{
    glint_value out = 0;
    if (!m->status)
        m->status = glint_builder_input(m->builder, which, &out, m->error);
    return out;
}

static glint_value apply(maker *m, glint_op op, glint_value a, glint_value b)
{
    const glint_value operands[GLINT_OPERANDS_MAX] = { a, b };
    glint_value out = 0;
    if (!m->status)
        m->status = glint_builder_op(m->builder, op, operands, &out, m->error);
    return out;
}

/// Where a direction is in a picture of all of them.
static glint_status make_uv(glint_builder *builder, glint_program **out, glint_error *error)
{
    maker m = { .builder = builder, .error = error };
    const glint_value ahead = apply(&m, GLINT_OP_NEG, input(&m, GLINT_INPUT_P_Z), 0);
    const glint_value around = apply(&m, GLINT_OP_ATAN2, input(&m, GLINT_INPUT_P_X), ahead);
    const glint_value down = apply(&m, GLINT_OP_NEG, input(&m, GLINT_INPUT_P_Y), 0);
    const glint_value cosine =
        apply(&m, GLINT_OP_MIN, apply(&m, GLINT_OP_MAX, down, number(&m, -1)), number(&m, 1)); // but for rounding
    const glint_value turned = apply(&m, GLINT_OP_DIV, around, number(&m, TURN));
    const glint_value uv[] = { apply(&m, GLINT_OP_ADD, turned, number(&m, 0.5)),
                               apply(&m, GLINT_OP_DIV, apply(&m, GLINT_OP_ACOS, cosine, 0), number(&m, TURN / 2)) };
    return m.status ? m.status : glint_program_make(builder, uv, 2, out, error);
}

static glint_status find_uv(glint_plan_environment *environment, glint_error *error)
{
    glint_builder *builder;
    glint_status status = glint_builder_create(GLINT_PROGRAM_PATTERN, &builder, error);
    if (status)
        return status;
    status = make_uv(builder, &environment->uv, error);
    glint_builder_destroy(builder);
    if (!status && environment->uv->code.row_count > environment->row_count)
        environment->row_count = environment->uv->code.row_count;
    return status;
}

glint_status glint_plan_find_environment(glint_plan *plan, const glint_scene_desc *scene, glint_error *error)
{
    if (!scene->background_program)
        return GLINT_OK;
    glint_plan_environment *environment = plan->environment = glint_alloc(1, sizeof *environment);
    if (!environment)
        return glint_fail_nomem(error);
    environment->program = glint_program_retain(scene->background_program);
    environment->row_count = environment->program->code.row_count;
    environment->most = GLINT_REFLECTANCE_MAX;
    environment->pixel = plan->camera.orthographic ? 0 : 2 * sqrt(vec_dot(plan->camera.right, plan->camera.right));
    return environment->program->inputs & GLINT_READS_UV ? find_uv(environment, error) : GLINT_OK;
}

void glint_plan_environment_free(glint_plan_environment *environment)
{
    if (!environment)
        return;
    glint_program_release(environment->program);
    glint_program_release(environment->uv);
    free(environment);
}
