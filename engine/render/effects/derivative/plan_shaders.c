/// Derivatives of shaders: programs for their derivatives by those inputs that some derivative changes.
#include "engine/base/status.h"
#include "engine/render/effects/derivative/slopes.h"
#include "engine/render/program/program.h"

#include <stdlib.h>

#define BITS(first, count) (((1u << (count)) - 1) << (first))
#define GEOMETRY (BITS(GLINT_INPUT_P_X, 12) | BITS(GLINT_INPUT_UV_U, 4)) ///< position, normal and viewer
#define TO_LIGHTS (BITS(GLINT_INPUT_L_X, 3) | 1u << GLINT_INPUT_DISTANCE) ///< directions and distances to lights
#define COLORS BITS(GLINT_INPUT_LIGHT_R, 3) ///< light that arrives
#define REFLECTANCES BITS(GLINT_INPUT_KD_R, 7) ///< with the exponent

/// Returns whether the amount of some light depends on its direction.
static bool depends_on_direction(const glint_plan *plan, const glint_plan_derivative *d)
{
    bool any = false;
    for (size_t i = 0; i < plan->derivatives->light_count; i++)
        any = any || d->lights[i].attenuated || d->lights[i].is_spot;
    for (size_t i = 0; i < plan->light_count; i++)
        any = any || plan->lights[i].light_samples;
    return any;
}

/// Returns the inputs of a shader that a derivative changes, one bit each.
static uint32_t find_inputs(const glint_plan *plan, const glint_plan_derivative *d, uint32_t material)
{
    const uint32_t arrival = TO_LIGHTS | (depends_on_direction(plan, d) ? COLORS : 0);
    uint32_t inputs = d->bends ? GEOMETRY | arrival : 0;
    for (size_t i = 0; i < plan->derivatives->light_count; i++)
        inputs |= d->lights[i].varies ? arrival | (d->lights[i].shines ? COLORS : 0) : 0;
    for (size_t i = 0; i < plan->derivatives->material_count; i++) // the light may come through any material
        inputs |= glint_any_slope(d->bounces[i].transmission) ? TO_LIGHTS | COLORS : 0;
    return inputs | (d->materials[material].varies ? REFLECTANCES : 0);
}

/// Makes the gradient of a shader by `inputs`. name: the derivative that an error message names.
static glint_status find_gradient(glint_plan *plan, const glint_program *shader, uint32_t inputs, const char *name,
                                  glint_gradient *out, glint_error *error)
{
    glint_error why;
    const glint_status status = glint_shader_gradient(shader, inputs, out, &why);
    if (status)
        return glint_fail(error, status, "derivative '%s': material.model: the shader's derivative: %s",
                          name, why.message);
    for (uint32_t k = 0; k < out->count; k += out->each) {
        const uint32_t rows = out->programs[k / out->each]->code.row_count;
        plan->patterns->row_count = plan->patterns->row_count < rows ? rows : plan->patterns->row_count;
    }
    return GLINT_OK;
}

/// Makes the forward programs of a material's shader, if there are few derivatives.
static glint_status find_forward(glint_plan *plan, const glint_program *shader, uint32_t material, glint_gradient *out,
                                 glint_error *error)
{
    const glint_plan_derivatives *all = plan->derivatives;
    glint_status status = GLINT_OK;
    for (size_t k = 0; k < all->count && all->count <= GLINT_FORWARD_MAX && !status; k++) {
        const uint32_t inputs = shader->inputs & find_inputs(plan, &all->of[k], material);
        if (inputs)
            status = glint_shader_forward(shader, inputs, &out->forward[k], error);
        const uint32_t rows = out->forward[k] ? out->forward[k]->code.row_count : 0;
        plan->patterns->row_count = plan->patterns->row_count < rows ? rows : plan->patterns->row_count;
    }
    return status;
}

glint_status glint_derivative_find_gradients(glint_plan *plan, glint_error *error)
{
    glint_plan_derivatives *all = plan->derivatives;
    glint_status status = GLINT_OK;
    if (!plan->patterns || !plan->patterns->shaders)
        return GLINT_OK;
    all->gradients = calloc(all->material_count, sizeof *all->gradients);
    if (!all->gradients)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < all->material_count && !status; i++) {
        const glint_program *shader = plan->patterns->of[i].program[GLINT_FIELD_SHADER];
        const char *name = NULL; // the first derivative that needs any
        uint32_t inputs = 0;
        for (size_t k = 0; k < all->count && shader; k++) {
            inputs |= shader->inputs & find_inputs(plan, &all->of[k], i);
            name = inputs && !name ? all->of[k].name : name;
        }
        if (inputs)
            status = find_gradient(plan, shader, inputs, name, &all->gradients[i], error);
        if (inputs && !status)
            status = find_forward(plan, shader, i, &all->gradients[i], error);
    }
    return status;
}
