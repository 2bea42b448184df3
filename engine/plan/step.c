/// The work of a frame that is rendered right after another, judged by the keys of both and without a pixel.
#include "engine/plan/plan.h"

/// The rows of lights whose key differs from that of the same row of the plan before.
static double changed_lights(const glint_plan *plan, const glint_plan *before, bool places)
{
    double count = 0;
    for (uint32_t i = 0; i < plan->light_count; i++) {
        const glint_plan_light *light = &plan->lights[i], *old = i < before->light_count ? &before->lights[i] : NULL;
        count += !old || !(places ? glint_key_equal(light->place_key, old->place_key) : glint_key_equal(light->key, old->key));
    }
    return count;
}

double glint_plan_work_after(const glint_plan *plan, const glint_plan *before, uint32_t *stages)
{
    double work = 0;
    *stages = 0;
    for (uint32_t id = 0, i = 0; id < GLINT_STAGE_COUNT; id++) {
        if (!plan->runs[id] || !glint_stage_table[id]->name)
            continue;
        if (!before->runs[id] || !glint_key_equal(plan->keys[id], before->keys[id])) {
            *stages |= 1u << i;
            work += id == GLINT_STAGE_LIGHT     ? changed_lights(plan, before, false)
                    : id == GLINT_STAGE_OCCLUDE ? changed_lights(plan, before, true)
                                                : 1;
        }
        i++;
    }
    return work;
}
