/// The declaration of the stage derivative.
#include "engine/base/alloc.h"
#include "engine/render/effects/derivative/work.h"

#include <stdlib.h>

static void *create(const glint_plan *plan)
{
    (void)plan;
    return glint_alloc(1, sizeof(glint_derivative_work));
}

static void destroy(void *memory)
{
    glint_derivative_work *work = memory;
    if (work) {
        free(work->painted);
        free(work->faded);
        glint_shader_slopes_free(work->shader);
    }
    free(work);
}

static glint_key own_key(const glint_plan *plan, glint_key key)
{
    for (size_t i = 0; i < plan->derivatives->count; i++)
        key = glint_derivative_key(plan, GLINT_PASS_DERIVATIVE + (int)i, key);
    return key;
}

static bool called(const glint_plan *plan) { return plan->derivatives; }

/// Computes how fast the shaded light changes with parameters.
static void derive(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (walk->any)
        glint_tile_need_points(tile, frame, walk);
    glint_tile_derive(tile, frame, walk->from, walk->count);
    if (walk->from == 0)
        glint_tile_count_stage(tile, frame, GLINT_STAGE_DERIVATIVE, false);
}

static void fade(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    (void)walk;
    if (frame->plan->runs[GLINT_STAGE_DEPTH_CUE])
        glint_derive_fade(tile, frame);
}

/// Adds the slopes of secondary rays.
static void collect(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (frame->plan->absorbs)
        glint_derive_absorption(walk->batch, frame);
    glint_derive_collect(walk->batch, frame->plan, tile);
}

static void store(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    (void)walk;
    glint_tile_store_derivatives(tile, frame);
}

static bool fit(void *memory, const glint_plan *plan) { return glint_derivative_fits(memory, plan); }

static bool always(const glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light)
{
    (void)tile, (void)frame, (void)light;
    return true;
}

/// Next to `shade`; no stage reads its result.
const glint_stage glint_stage_derivative = {
    .name = "derivative",
    .doc = "derivatives of the picture by parameters",
    .prepare = glint_derivative_prepare,
    .check = glint_derivative_check,
    .release = glint_derivative_release,
    .called = called,
    .own = own_key,
    .pass_key = glint_derivative_key,
    .reads = GLINT_READS_OWN(DERIVATIVE),
    .normals = true,
    .remote = true,
    .step = { [GLINT_AT_SHADED] = derive, [GLINT_AFTER_LIGHTS] = fade, [GLINT_AFTER_SECONDARY] = collect, [GLINT_AT_STORE] = store },
    .adds = glint_tile_adds_anywhere,
    .singles = always,
    .create = create,
    .destroy = destroy,
    .fit = fit,
};
