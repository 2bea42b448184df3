#include "engine/tile/shading_points.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"

#include <stdlib.h>

void glint_sites_clear(glint_sites_kept *sites, glint_reuse *reuse)
{
    if (sites->reserved)
        glint_reuse_unreserve(reuse, sites->reserved);
    free(sites->light);
    free(sites->state);
    *sites = (glint_sites_kept) { 0 };
}

static glint_status make_room(glint_sites_kept *sites, uint32_t blocks, glint_reuse *reuse, glint_error *error)
{
    const size_t count = 2 * (size_t)blocks, bytes = count * (GLINT_SITE_BLOCK * sizeof *sites->light + 1);
    glint_sites_clear(sites, reuse);
    sites->light = glint_alloc(count * GLINT_SITE_BLOCK, sizeof *sites->light);
    sites->state = glint_alloc(count, sizeof *sites->state);
    if (!sites->light || !sites->state) {
        glint_sites_clear(sites, reuse);
        return glint_fail_nomem(error);
    }
    sites->blocks = blocks;
    sites->reserved = glint_reuse_reserve(reuse, bytes) ? bytes : 0;
    return GLINT_OK;
}

glint_status glint_sites_begin(glint_sites_kept *sites, const glint_plan *plan, glint_reuse *reuse, glint_error *error)
{
    const uint32_t count = plan->geometry->table.site_count;
    const uint32_t blocks = (count + GLINT_SITE_BLOCK - 1) / GLINT_SITE_BLOCK;
    if (!plan->runs[GLINT_STAGE_VERTEX]) {
        glint_sites_clear(sites, reuse);
        return GLINT_OK;
    }
    if (sites->blocks != blocks) {
        glint_status status = make_room(sites, blocks, reuse, error);
        if (status)
            return status;
    }
    const bool known = sites->reserved && glint_key_equal(sites->key, plan->vertex_key);
    sites->ready = 0;
    for (uint32_t i = 0; i < 2 * blocks; i++) {
        if (!known)
            atomic_store_explicit(&sites->state[i], GLINT_BLOCK_NONE, memory_order_relaxed);
        sites->ready += atomic_load_explicit(&sites->state[i], memory_order_relaxed) == GLINT_BLOCK_DONE;
    }
    sites->key = plan->vertex_key;
    return GLINT_OK;
}
