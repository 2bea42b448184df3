#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/plan.h"

#include <float.h>

/// Strengths beyond this are white in any film; keeping below it, products of two stay finite.
#define STRENGTH_MAX 1e150

static bool is_black(const double c[3]) { return c[0] == 0 && c[1] == 0 && c[2] == 0; }

static void bounded(double out[3], const double color[3], double factor)
{
    for (int c = 0; c < 3; c++)
        out[c] = color[c] == 0 ? 0 : fmin(color[c] * factor, STRENGTH_MAX);
}

void glint_shade_material_init(glint_shade_material *out, const glint_material_desc *desc, const double ambient[3])
{
    *out = (glint_shade_material) { .shininess = (float)fmin(desc->shininess, FLT_MAX) };
    bounded(out->diffuse, desc->diffuse, 1);
    bounded(out->specular, desc->specular, 1);
    const double *ka = desc->has_ambient ? desc->ambient : desc->diffuse;
    for (int c = 0; c < 3; c++)
        out->ambient[c] = ka[c] == 0 ? 0 : fmin(ka[c] * ambient[c], STRENGTH_MAX);
    if (desc->model == GLINT_MODEL_LAMBERT)
        vec_scale(out->specular, out->specular, 0);
    else if (!is_black(out->specular))
        out->highlight = desc->model == GLINT_MODEL_PHONG ? GLINT_HIGHLIGHT_PHONG : GLINT_HIGHLIGHT_BLINN;
}

static void light_init(glint_plan_light *out, const glint_light_desc *desc, const double eye[3])
{
    *out = (glint_plan_light) { .directional = desc->kind == GLINT_LIGHT_DIRECTIONAL,
                                .shadows = desc->shadows,
                                .scale = 1 };
    bounded(out->diffuse, desc->has_diffuse ? desc->diffuse : desc->color, desc->intensity);
    bounded(out->specular, desc->has_specular ? desc->specular : desc->color, desc->intensity);
    if (out->directional) {
        vec_normalize(out->position, desc->direction);
        vec_scale(out->position, out->position, -1);
        out->coefficients[0] = 1;
        return;
    }
    const double *a = desc->attenuation;
    vec_copy(out->position, desc->position);
    vec_copy(out->coefficients, a);
    out->attenuated = a[0] != 1 || a[1] != 0 || a[2] != 0;
    double away[3];
    vec_sub(away, desc->position, eye);
    const double distance = vec_max_abs(away);
    if (distance > 0 && isfinite(distance))
        out->scale = power_of_two_scale(distance);
}

/// Ia: the scene's ambient light and every light's.
static void total_ambient(glint_plan *plan, const glint_scene *scene)
{
    vec_copy(plan->ambient, scene->desc.ambient);
    for (size_t i = 0; i < scene->lights.count; i++) {
        const glint_light_desc *desc = &glint_scene_light(scene, i)->desc;
        for (int c = 0; c < 3; c++)
            plan->ambient[c] += desc->ambient[c] * desc->intensity;
    }
    bounded(plan->ambient, plan->ambient, 1);
    bounded(plan->background, scene->desc.background, 1);
}

static glint_status make_materials(glint_plan *plan, bool *highlights, glint_error *error)
{
    const glint_list *list = &plan->geometry->materials;
    plan->materials = glint_alloc(list->count, sizeof *plan->materials);
    if (!plan->materials)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < list->count; i++) {
        glint_shade_material *material = &plan->materials[plan->material_count++];
        glint_shade_material_init(material, &((const glint_material *)list->items[i])->desc, plan->ambient);
        *highlights = *highlights || material->highlight;
    }
    return GLINT_OK;
}

glint_status glint_plan_shading(glint_plan *plan, const glint_scene *scene, glint_error *error)
{
    bool shiny = false, glossy_light = false;
    total_ambient(plan, scene);
    glint_status status = make_materials(plan, &shiny, error);
    if (status)
        return status;
    plan->lights = glint_alloc(scene->lights.count, sizeof *plan->lights);
    if (!plan->lights)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < scene->lights.count; i++) {
        glint_plan_light light;
        light_init(&light, &glint_scene_light(scene, i)->desc, plan->camera.eye);
        if (is_black(light.diffuse) && is_black(light.specular))
            continue;
        glossy_light = glossy_light || !is_black(light.specular);
        plan->shadow_count += light.shadows;
        plan->lights[plan->light_count++] = light;
    }
    plan->highlights = shiny && glossy_light;
    return GLINT_OK;
}
