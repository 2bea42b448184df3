/// Indirect light: light from other surfaces and from the background.
///
/// A material's ambient light is ka Ia. The part kd Ia represents the light of its surroundings, where Ia is the mean
/// light from all directions. Indirect light replaces this part by kd times the light of paths; it is used only where
/// a path ends. The excess of ka over kd is light of the surface's own.
///
/// Ambient occlusion is the same with paths of one step: that part of the ambient light, times the share of the sky
/// that is open.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/effects/environment/plan.h"

static bool is_matt(const glint_plan *plan, uint32_t i)
{
    const double *kd = glint_plan_diffuse(plan, i);
    return kd[0] > 0 || kd[1] > 0 || kd[2] > 0;
}

/// Splits a material's ambient light. If a program computes it or the diffuse reflectance, the stages pattern and
/// indirect split it.
static void part_ambient(glint_plan *plan, uint32_t i, double rest[3])
{
    glint_shade_material *material = &plan->materials[i];
    const double *diffuse = glint_plan_diffuse(plan, i), *ambient = plan->ambient;
    if (plan->patterns && plan->patterns->of[i].made >> GLINT_FIELD_DIFFUSE & 1) {
        material->planes &= ~(uint32_t)GLINT_PLANE_AMBIENT_IS_DIFFUSE;
        material->planes |= plan->patterns->of[i].made >> GLINT_FIELD_AMBIENT & 1 ? GLINT_PLANE_AMBIENT : 0u;
        rest[0] = rest[1] = rest[2] = 0;
        return;
    }
    for (int c = 0; c < 3; c++) {
        const double all = material->ambient[c], replaced = fmin(all, diffuse[c] * ambient[c]);
        material->ambient[c] = all - replaced;
        rest[c] = replaced;
    }
}

glint_status glint_indirect_find_light_rows(glint_plan *plan, glint_error *error)
{
    glint_plan_indirect *indirect = &plan->indirect;
    if (indirect->light_rows)
        return GLINT_OK;
    indirect->light_rows = glint_alloc((size_t)plan->light_count + 1, sizeof *indirect->light_rows);
    if (!indirect->light_rows)
        return glint_fail_nomem(error);
    for (uint32_t i = 0; i < plan->light_count; i++)
        if (!plan->lights[i].joined)
            indirect->light_rows[indirect->light_count++] = i;
    indirect->light_rows[indirect->light_count] = plan->light_count;
    return GLINT_OK;
}

glint_status glint_indirect_prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    const glint_scene_desc *scene = &from->scene->desc;
    glint_plan_indirect *indirect = &plan->indirect;
    bool matt = false;
    for (uint32_t i = 0; i < plan->material_count; i++)
        matt = matt || is_matt(plan, i);
    indirect->is_sky = scene->has_ambient_occlusion && vec_max_abs(plan->ambient) > 0;
    const bool wanted = indirect->is_sky || (scene->has_indirect && scene->indirect_bounces > 0);
    if (!wanted || !matt || plan->geometry->table.prim_count == 0)
        return GLINT_OK;
    indirect->rest = glint_alloc(plan->material_count, sizeof *indirect->rest);
    if (!indirect->rest)
        return glint_fail_nomem(error);
    indirect->samples = glint_plan_rays(plan, indirect->is_sky ? scene->ambient_occlusion_samples : scene->indirect_samples);
    indirect->bounces = indirect->is_sky ? 1 : (uint32_t)scene->indirect_bounces;
    indirect->distance = scene->ambient_occlusion_distance;
    for (uint32_t i = 0; i < plan->material_count; i++)
        part_ambient(plan, i, indirect->rest[i]);
    const glint_status status = indirect->is_sky ? GLINT_OK : glint_sky_find(plan, error);
    return status ? status : glint_indirect_find_light_rows(plan, error);
}
