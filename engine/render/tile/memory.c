/// The working memory of a tile that only some frames need. It is allocated for the first such frame, and kept for
/// later ones.
#include "engine/base/alloc.h"
#include "engine/render/pattern/pattern.h"

#include <stdlib.h>

/// Makes the memory of programs fit the plan. Returns false when out of memory.
static bool fit_pattern(glint_tile *tile, const glint_plan *plan)
{
    if (glint_pattern_fits(tile->pattern, plan))
        return true;
    glint_pattern_destroy(tile->pattern);
    tile->pattern = plan->patterns ? glint_pattern_create(plan) : NULL;
    return tile->pattern || !plan->patterns;
}

static bool has_soft_shadows(const glint_plan *plan)
{
    for (uint32_t i = 0; i < plan->light_count; i++)
        if (plan->lights[i].light_samples && plan->lights[i].shadows)
            return true;
    return false;
}

bool glint_tile_fit_stage(glint_tile *tile, const glint_plan *plan, glint_stage_id id)
{
    const glint_stage *stage = glint_stage_table[id];
    if (stage->sized)
        glint_tile_free_stage(tile, id);
    if (!plan->runs[id] || !stage->create)
        return true;
    if (!tile->own[id])
        tile->own[id] = stage->create(plan);
    return tile->own[id] && (!stage->fit || stage->fit(tile->own[id], plan));
}

void glint_tile_free_stage(glint_tile *tile, glint_stage_id id)
{
    if (glint_stage_table[id]->destroy)
        glint_stage_table[id]->destroy(tile->own[id]);
    tile->own[id] = NULL;
}

bool glint_tile_extend(glint_tile *tile, const glint_plan *plan)
{
    bool good = true;
    tile->view.made = false; // the view belongs to another frame
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        good = glint_tile_fit_stage(tile, plan, (glint_stage_id)id) && good;
    if (plan->is_base && !tile->differ)
        good = (tile->differ = glint_differ_work_create()) && good;
    if (plan->together && !tile->samples)
        good = (tile->samples = glint_samples_create()) && good;
    if (plan->base && plan->local && !tile->gathered)
        good = (tile->gathered = glint_gathered_create()) && good;
    if (has_soft_shadows(plan) && !tile->shadow_scratch)
        good = (tile->shadow_scratch = glint_alloc_large(1, GLINT_OCCLUDE_SCRATCH)) && good;
    return fit_pattern(tile, plan) && good;
}

void glint_tile_destroy(glint_tile *tile)
{
    if (!tile)
        return;
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        glint_tile_free_stage(tile, (glint_stage_id)id);
    glint_differ_work_destroy(tile->differ);
    glint_gathered_destroy(tile->gathered);
    glint_samples_destroy(tile->samples);
    glint_pattern_destroy(tile->pattern);
    free(tile->shadow_scratch);
    free(tile);
}
