#include "engine/render/frame/grids.h"

#include <math.h>
#include <string.h>

#define FEWEST 256 ///< smallest number of primitives: with fewer, traversing the BVH is as fast
/// smallest number of a frame's samples per primitive: with fewer, a grid is never made
#define SAMPLES_A_PRIMITIVE 0.5
#define SAMPLES_AT_ONCE 4.0 ///< samples per primitive and thread from which a grid pays in one frame; with fewer it
    ///< is made in the second frame with unchanged light and geometry

void glint_grids_clear(glint_grids *grids)
{
    for (uint32_t i = 0; i < grids->count; i++)
        glint_light_grid_destroy(grids->of[i].grid);
    *grids = (glint_grids) { .count = 0 };
}

static bool is_of(const glint_grids *grids, uint32_t i, const glint_plan_light *light)
{
    return grids->of[i].directional == light->directional &&
           memcmp(grids->of[i].position, light->position, sizeof light->position) == 0;
}

static bool has_grid(const glint_plan_light *light)
{
    return light->shadows && !light->light_samples && !light->cap;
}

/// Marks the plan's lights that an earlier frame recorded, and drops the rest.
static void keep_used(glint_grids *grids, const glint_plan *plan)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < grids->count; i++) {
        grids->of[i].used = false;
        for (uint32_t k = 0; k < plan->light_count && !grids->of[i].used; k++)
            grids->of[i].used = has_grid(&plan->lights[k]) && is_of(grids, i, &plan->lights[k]);
        if (grids->of[i].used)
            grids->of[kept++] = grids->of[i];
        else
            glint_light_grid_destroy(grids->of[i].grid);
    }
    grids->count = kept;
}

/// Records a light, or makes its grid: at once, or if an earlier frame recorded it.
static glint_status add(glint_grids *grids, const glint_plan_light *light, const glint_geometry_table *table,
                        bool at_once, size_t max_bytes, glint_error *error)
{
    uint32_t i = 0;
    while (i < grids->count && !is_of(grids, i, light))
        i++;
    const bool noted = i < grids->count && grids->of[i].used;
    if (i < grids->count && (grids->of[i].made || !noted))
        return GLINT_OK;
    if (i == grids->count) {
        grids->of[i].directional = light->directional;
        grids->of[i].used = grids->of[i].made = false;
        grids->of[i].grid = NULL;
        memcpy(grids->of[i].position, light->position, sizeof light->position);
        grids->count++;
    }
    if (!noted && !at_once)
        return GLINT_OK;
    grids->of[i].made = true;
    return glint_light_grid_create(table, light->directional, light->position, max_bytes, &grids->of[i].grid, error);
}

/// Returns whether a tile needs shadows that are not cached.
static bool lacks_shadows(const glint_tile_frame *frame, size_t index)
{
    const glint_plan *plan = frame->plan;
    const glint_reuse *reuse = frame->reuse;
    const glint_cached_tile *tile = &reuse->tiles[index];
    const glint_key film = glint_reuse_film_key(reuse, tile, plan), none = { 0 };
    if (frame->last && frame->last->film && !glint_key_equal(film, none) &&
        glint_key_equal(film, frame->last->film[index].key))
        return false;
    if (glint_key_equal(tile->seen, plan->keys[GLINT_STAGE_SURFACE]) && tile->shown_count == 0)
        return false;
    for (uint32_t i = 0; i < reuse->light_count; i++)
        if (plan->lights[i].shadows && !glint_key_equal(tile->lights[i].occlude, plan->lights[i].key))
            return true;
    return plan->light_count > reuse->light_count;
}

/// Returns the number of the frame's samples that need shadows.
static double count_shadowed(const glint_tile_frame *frame, const glint_extent *extent)
{
    const glint_plan *plan = frame->plan;
    const double all = (double)extent->width * extent->height * plan->desc.samples;
    size_t lacking = 0;
    if (!frame->reuse->tile_count || glint_plan_sends_rays(plan))
        return all;
    for (size_t i = 0; i < frame->reuse->tile_count; i++)
        lacking += lacks_shadows(frame, i);
    return fmin(all, (double)lacking * GLINT_TILE_SAMPLES * plan->desc.samples);
}

/// Records lights, or makes their grids, where that pays.
static glint_status find(glint_grids *grids, const glint_tile_frame *frame, const glint_extent *extent, int threads,
                         glint_error *error)
{
    const glint_plan *plan = frame->plan;
    const glint_geometry_table *table = &frame->geometry;
    glint_status status = GLINT_OK;
    if (!glint_key_equal(grids->where, plan->where) || grids->nodes != table->nodes ||
        grids->plain != plan->geometry->index->plain)
        glint_grids_clear(grids);
    grids->where = plan->where;
    grids->nodes = table->nodes;
    grids->plain = plan->geometry->index->plain;
    keep_used(grids, plan);
    if (!table->nodes || table->prim_count < FEWEST || plan->desc.precision == GLINT_PRECISION_FLOAT)
        return GLINT_OK;
    const double samples = count_shadowed(frame, extent);
    if (samples < SAMPLES_A_PRIMITIVE * table->prim_count)
        return GLINT_OK;
    const bool at_once = samples >= SAMPLES_AT_ONCE * table->prim_count * threads;
    for (uint32_t k = 0; k < plan->light_count && grids->count < GLINT_TILE_GRIDS && !status; k++)
        if (has_grid(&plan->lights[k]))
            status = add(grids, &plan->lights[k], table, at_once, frame->reuse->budget / GLINT_TILE_GRIDS, error);
    return status;
}

glint_status glint_grids_begin(glint_grids *grids, glint_tile_frame *frame, const glint_extent *extent, int threads,
                               glint_error *error)
{
    const glint_status status = frame->base ? GLINT_OK : find(grids, frame, extent, threads, error);
    for (uint32_t i = 0; i < grids->count; i++)
        frame->grids[i] = grids->of[i].grid;
    frame->grid_count = grids->count;
    return status;
}
