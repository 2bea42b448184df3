/// Estimates the work of rendering a frame right after another frame, from the keys of both frames and without
/// rendering.
#include "engine/render/plan/plan.h"

/// Counts the rows of lights whose keys differ from the same rows of the previous plan.
static double changed_lights(const glint_plan *plan, const glint_plan *before, bool positions)
{
    double count = 0;
    for (uint32_t i = 0; i < plan->light_count; i++) {
        const glint_plan_light *light = &plan->lights[i], *old = i < before->light_count ? &before->lights[i] : NULL;
        count += !old || !(positions ? glint_key_equal(light->position_key, old->position_key)
                                     : glint_key_equal(light->key, old->key));
    }
    return count;
}

/// Returns the relative work of shading again: 1, or a half if only highlights of materials differ.
static double shade_work(const glint_plan *plan, const glint_plan *before)
{
    bool matte = plan->material_count == before->material_count && plan->matte_keys && before->matte_keys, highlights = false;
    for (uint32_t i = 0; i < plan->material_count && matte; i++) {
        matte = glint_key_equal(plan->matte_keys[i], before->matte_keys[i]);
        highlights = highlights || !glint_key_equal(plan->material_keys[i], before->material_keys[i]);
    }
    return matte && highlights ? 0.5 : 1;
}

double glint_plan_work_after(const glint_plan *plan, const glint_plan *before, uint64_t *stages)
{
    if (!plan || !before || !stages)
        return 0;
    double work = 0;
    *stages = 0;
    for (uint32_t id = 0, i = 0; id < GLINT_STAGE_COUNT; id++) {
        if (!plan->runs[id] || !glint_stage_table[id]->name)
            continue;
        if (!before->runs[id] || !glint_key_equal(plan->keys[id], before->keys[id])) {
            *stages |= (uint64_t)1 << i;
            work += id == GLINT_STAGE_LIGHT     ? changed_lights(plan, before, false)
                    : id == GLINT_STAGE_OCCLUDE ? changed_lights(plan, before, true)
                    : id == GLINT_STAGE_SHADE   ? shade_work(plan, before)
                                                : 1;
        }
        i++;
    }
    return work;
}
