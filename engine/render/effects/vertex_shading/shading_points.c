#include "engine/render/effects/vertex_shading/shading_points.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/render/light_groups/plan.h"
#include "engine/render/frame/renderer.h"

#include <stdlib.h>

static void clear(glint_shading_points_cached *shading_points, glint_reuse *reuse)
{
    if (shading_points->reserved)
        glint_reuse_unreserve(reuse, shading_points->reserved);
    free(shading_points->light);
    free(shading_points->slopes);
    free(shading_points->state);
    *shading_points = (glint_shading_points_cached) { 0 };
}

static glint_status ensure_capacity(glint_shading_points_cached *shading_points, uint32_t blocks, size_t derivatives,
                                    size_t groups, glint_reuse *reuse, glint_error *error)
{
    const size_t count = 2 * (size_t)blocks, slopes = derivatives ? 3 * (derivatives + 1) : 0,
                 each = (1 + groups) * sizeof *shading_points->light + slopes * sizeof *shading_points->slopes,
                 bytes = count * (GLINT_SHADING_POINT_BLOCK * each + 1);
    clear(shading_points, reuse);
    shading_points->light = glint_alloc((1 + groups) * count * GLINT_SHADING_POINT_BLOCK, sizeof *shading_points->light);
    shading_points->state = glint_alloc(count, sizeof *shading_points->state);
    if (derivatives)
        shading_points->slopes = glint_alloc(count * GLINT_SHADING_POINT_BLOCK * slopes, sizeof *shading_points->slopes);
    if (!shading_points->light || !shading_points->state || (derivatives && !shading_points->slopes)) {
        clear(shading_points, reuse);
        return glint_fail_nomem(error);
    }
    shading_points->blocks = blocks;
    shading_points->slope_count = derivatives;
    shading_points->group_count = groups;
    shading_points->reserved = glint_reuse_reserve(reuse, bytes) ? bytes : 0;
    return GLINT_OK;
}

glint_status glint_shading_points_begin(glint_renderer *renderer, glint_tile_frame *frame, glint_error *error)
{
    const glint_plan *plan = frame->plan;
    glint_shading_points_cached *shading_points = renderer->own[GLINT_STAGE_VERTEX_SHADING];
    if (!shading_points && !(shading_points = renderer->own[GLINT_STAGE_VERTEX_SHADING] = calloc(1, sizeof *shading_points)))
        return glint_fail_nomem(error);
    const uint32_t count = plan->geometry->table.shading_point_count;
    const uint32_t blocks = (count + GLINT_SHADING_POINT_BLOCK - 1) / GLINT_SHADING_POINT_BLOCK;
    const size_t derivatives = plan->derivatives ? plan->derivatives->count : 0;
    const size_t groups = plan->light_groups ? plan->light_groups->count : 0;
    if (shading_points->blocks != blocks || shading_points->slope_count != derivatives || shading_points->group_count != groups) {
        glint_status status = ensure_capacity(shading_points, blocks, derivatives, groups, &renderer->reuse, error);
        if (status)
            return status;
    }
    const bool known = shading_points->reserved && glint_key_equal(shading_points->key, plan->vertex_key);
    uint64_t *reuses = &renderer->tiles[0]->counts.reuses[GLINT_STAGE_VERTEX_SHADING];
    for (uint32_t i = 0; i < 2 * blocks; i++) {
        if (!known)
            atomic_store_explicit(&shading_points->state[i], GLINT_BLOCK_NONE, memory_order_relaxed);
        *reuses += atomic_load_explicit(&shading_points->state[i], memory_order_relaxed) == GLINT_BLOCK_DONE;
    }
    shading_points->key = plan->vertex_key;
    return GLINT_OK;
}

void glint_shading_points_end(glint_renderer *renderer)
{
    clear(renderer->own[GLINT_STAGE_VERTEX_SHADING], &renderer->reuse);
    free(renderer->own[GLINT_STAGE_VERTEX_SHADING]);
}
