/// What a tile's working memory has beside the tile itself: allocated for the first frame that needs it, kept for those after it.
#include "engine/base/alloc.h"
#include "engine/effects/pattern/pattern.h"
#include "engine/effects/light_groups/light_groups.h"

#include <stdlib.h>

/// The memory of programs, whose size is the plan's. Returns whether there is enough.
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

bool glint_tile_extend(glint_tile *tile, const glint_plan *plan)
{
    bool good = true;
    tile->view.made = false; // another frame's
    if (plan->runs[GLINT_STAGE_INDIRECT]) { // its size is the plan's
        glint_indirect_destroy(tile->indirect);
        good = (tile->indirect = glint_indirect_create(plan)) != NULL;
    }
    if (plan->runs[GLINT_STAGE_BOUNCE] && !tile->bounce)
        good = (tile->bounce = glint_bounce_create()) && good;
    if (plan->is_base && !tile->differ)
        good = (tile->differ = glint_differ_work_create()) && good;
    if (plan->runs[GLINT_STAGE_VERTEX] && !tile->vertex)
        good = (tile->vertex = glint_vertex_create()) && good;
    if (plan->runs[GLINT_STAGE_DEPTH_CUE] && !tile->depth_cue)
        good = (tile->depth_cue = glint_depth_cue_create()) && good;
    if (plan->raster && !tile->raster_rest)
        good = (tile->raster_rest = glint_raster_rest_create()) && good;
    if (plan->tints && !tile->transparent_shadow)
        good = (tile->transparent_shadow = glint_transparent_shadow_create()) && good;
    if (plan->together && !tile->samples)
        good = (tile->samples = glint_samples_create()) && good;
    if (plan->base && plan->local && !tile->gathered)
        good = (tile->gathered = glint_gathered_create()) && good;
    if (has_soft_shadows(plan) && !tile->shadow_room)
        good = (tile->shadow_room = glint_alloc_large(1, GLINT_OCCLUDE_ROOM)) && good;
    if (plan->facets && !tile->facets)
        good = (tile->facets = glint_alloc(1, sizeof *tile->facets)) && good;
    if (plan->derivatives && !tile->derivative)
        good = (tile->derivative = glint_derivative_create()) && good;
    if (plan->derivatives && tile->derivative)
        good = glint_derivative_fits(tile->derivative, plan) && good;
    if (plan->derivatives && plan->runs[GLINT_STAGE_VERTEX] && tile->vertex)
        good = glint_vertex_derives(tile->vertex, plan) && good;
    if (plan->derivatives && tile->bounce)
        good = glint_bounce_derives(tile->bounce, plan) && good;
    glint_group_sums_destroy(tile->group_sums); // its size is the plan's
    tile->group_sums = NULL;
    if (plan->light_groups)
        good = (tile->group_sums = glint_group_sums_create(plan)) && good;
    good = fit_pattern(tile, plan) && good;
    glint_environment_destroy(tile->environment); // its size is the plan's
    tile->environment = NULL;
    if (plan->environment)
        good = (tile->environment = glint_environment_create(plan)) && good;
    if (plan->visible_light_count && !tile->visible_light)
        tile->visible_light = glint_visible_light_create();
    return good && (!plan->visible_light_count || glint_visible_light_fits(tile->visible_light, plan));
}

void glint_tile_destroy(glint_tile *tile)
{
    if (!tile)
        return;
    glint_bounce_destroy(tile->bounce);
    glint_transparent_shadow_destroy(tile->transparent_shadow);
    glint_differ_work_destroy(tile->differ);
    glint_gathered_destroy(tile->gathered);
    glint_vertex_destroy(tile->vertex);
    glint_raster_rest_destroy(tile->raster_rest);
    glint_visible_light_destroy(tile->visible_light);
    glint_depth_cue_destroy(tile->depth_cue);
    glint_indirect_destroy(tile->indirect);
    glint_samples_destroy(tile->samples);
    glint_pattern_destroy(tile->pattern);
    glint_environment_destroy(tile->environment);
    glint_derivative_destroy(tile->derivative);
    glint_group_sums_destroy(tile->group_sums);
    free(tile->facets);
    free(tile->shadow_room);
    free(tile);
}
