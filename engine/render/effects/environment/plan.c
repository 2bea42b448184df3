/// A background that a program computes from the direction of rays that leave the scene.
#include "engine/base/alloc.h"
#include "engine/base/maker.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/effects/environment/plan.h"
#include "engine/render/program/builder.h"

#include <stdlib.h>

#define TURN 0x1.921fb54442d18p+2 // 2 pi

/// Makes a program for the position of a direction in a picture of all directions.
static glint_status make_uv(glint_builder *builder, glint_program **out, glint_error *error)
{
    glint_maker m = { .builder = builder, .error = error };
    const glint_value x = glint_maker_input(&m, GLINT_INPUT_P_X), y = glint_maker_input(&m, GLINT_INPUT_P_Y),
                      z = glint_maker_input(&m, GLINT_INPUT_P_Z);
    const glint_value around = glint_maker_apply(&m, GLINT_OP_ATAN2, x, glint_maker_apply(&m, GLINT_OP_NEG, z, 0));
    const glint_value down = glint_maker_apply(&m, GLINT_OP_NEG, y, 0);
    const glint_value least = glint_maker_with(&m, GLINT_OP_MAX, down, -1); // rounding may leave -1 .. 1
    const glint_value cosine = glint_maker_with(&m, GLINT_OP_MIN, least, 1);
    const glint_value turned = glint_maker_with(&m, GLINT_OP_DIV, around, TURN);
    glint_value uv[2];
    uv[0] = glint_maker_with(&m, GLINT_OP_ADD, turned, 0.5);
    uv[1] = glint_maker_with(&m, GLINT_OP_DIV, glint_maker_apply(&m, GLINT_OP_ACOS, cosine, 0), TURN / 2);
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

glint_status glint_environment_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    const glint_scene_desc *scene = &from->scene->desc;
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

void glint_environment_release(glint_plan *plan)
{
    glint_plan_environment *environment = plan->environment;
    glint_sky_release(plan->sky);
    if (!environment)
        return;
    glint_program_release(environment->program);
    glint_program_release(environment->uv);
    free(environment);
}
