/// Adaptive sampling: a frame in two steps: a base with one sample per pixel, and then all samples of the pixels that
/// need them. refine.h states the rule.
#include "engine/base/status.h"
#include "engine/render/frame/render.h"
#include "engine/render/frame/renderer.h"

#include <stdlib.h>
#include <string.h>

// ---- The base ----

/// Makes a renderer with its own cache (half of the budget) that shares everything else.
static glint_status open_base(glint_renderer *renderer, glint_error *error)
{
    glint_renderer *base = renderer->base;
    if (base)
        return GLINT_OK;
    base = calloc(1, sizeof *base);
    if (!base)
        return glint_fail_nomem(error);
    base->shares = true;
    base->pool = renderer->pool;
    base->tiles = renderer->tiles;
    base->stages = renderer->stages;
    base->stop = renderer->stop;
    base->grids = renderer->grids;
    base->refine = renderer->refine;
    base->time_stages = renderer->time_stages;
    base->count_work = renderer->count_work;
    glint_reuse_init(&base->reuse, renderer->reuse.on, renderer->reuse.budget / 2 + 1);
    renderer->base = base;
    return GLINT_OK;
}

/// Renders the base. The last base is discarded if its pixels would be compared differently now, or if it was
/// abandoned half way.
static glint_status render_base(glint_renderer *renderer, const glint_plan *plan, glint_image **out, glint_frame_stats *stats,
                                glint_error *error)
{
    const glint_render_desc *desc = &plan->base->desc;
    const double by[] = { desc->adaptive, desc->tone.curve, desc->tone.exposure };
    glint_renderer *base = renderer->base;
    if (memcmp(renderer->refined_by, by, sizeof by) != 0)
        glint_picture_forget(base);
    memcpy(renderer->refined_by, by, sizeof by);
    const glint_status status = glint_render_instant(base, plan->base, out, stats, error);
    if (status)
        glint_picture_forget(base);
    return status;
}

/// Renders the base into the picture that is made from it: `base` is that picture, with planes of `*more` where it
/// has none. Nothing is cached, and the last base is discarded, because the values that its pixels were compared by
/// are overwritten.
static glint_status render_in_place(glint_renderer *renderer, const glint_plan *plan, const glint_image *image,
                                    const glint_tone_table *table, glint_image *base, glint_image **more,
                                    glint_frame_stats *stats, glint_error *error)
{
    glint_render_desc desc = plan->base->desc;
    glint_status status = GLINT_OK;
    glint_picture_forget(renderer->base);
    glint_reuse_clear(&renderer->base->reuse);
    *base = *image;
    base->film = NULL;
    desc.codes = false;
    desc.light_passes = NULL;
    desc.passes &= ~plan->desc.passes;
    if (desc.passes)
        status = glint_renderer_take_image(renderer->base, &desc, more, error);
    for (int pass = 0; pass < GLINT_PLANE_COUNT && *more; pass++)
        for (int c = 0; c < 3; c++)
            if ((*more)->plane[pass][c])
                base->plane[pass][c] = (*more)->plane[pass][c];
    renderer->base->reuse.on = false;
    if (!status)
        status = glint_renderer_run(renderer->base, plan->base, base, NULL, table, stats, error);
    renderer->base->reuse.on = renderer->reuse.on;
    return status;
}

// ---- The frame ----

/// Adds the work and time of the base and of the choice after the base. compare_ms: the part of the base's time that
/// was spent on comparing pixels.
static void add_base(glint_frame_stats *to, const glint_frame_stats *base, const glint_plan *plan, double choose_ms,
                     double compare_ms, bool time_stages)
{
    const double pixels = (double)to->pixels;
    const double all = pixels + (double)to->refined * plan->desc.samples; // samples
    glint_frame_stats_add(to, base, pixels / all);
    to->render_ms += choose_ms;
    if (!glint_plan_compares_codes(&plan->desc)) { // then the base's pixel values are the picture's
        to->render_ms -= base->tone_ms;
        to->tone_ms += base->tone_ms;
    }
    for (int i = 0; i < to->stage_count; i++)
        if (time_stages && to->stage_name[i] == glint_stage_table[GLINT_STAGE_ADAPTIVE]->name)
            to->stage_ms[i] = choose_ms + compare_ms;
}

/// Returns the time that the last tiles spent on comparing pixels. Only known if stages are timed.
static double comparing_ms(const glint_renderer *renderer)
{
    double ms = 0;
    for (int i = 0; i < glint_pool_threads(renderer->pool); i++)
        ms += (double)renderer->tiles[i]->counts.ns[GLINT_STAGE_ADAPTIVE] * 1e-6;
    return ms;
}

/// Chooses the pixels of a base that need all samples, then renders these pixels.
static glint_status refine_base(glint_renderer *renderer, const glint_plan *plan, glint_image *image, const glint_image *base,
                                const glint_tone_table *table, const glint_frame_stats *first, glint_frame_stats *stats,
                                glint_error *error)
{
    const double compare_ms = comparing_ms(renderer), start = glint_frame_now_ms();
    const glint_extent extent = glint_plan_extent(&plan->desc);
    renderer->refine->base = base; // `base` may be the base of the last frame
    glint_refine_choose(renderer->refine, &extent, plan->lens != NULL, renderer->pool);
    const double choose_ms = glint_frame_now_ms() - start;
    const glint_status status = glint_renderer_run(renderer, plan, image, base, table, stats, error);
    renderer->refine->base = NULL;
    if (status)
        return status;
    stats->refined = renderer->refine->count;
    add_base(stats, first, plan, choose_ms, compare_ms, renderer->time_stages);
    return GLINT_OK;
}

/// The base is rendered into the frame's own picture if no pixel of the base is cached: without reuse, in the first
/// frame, and if so much has changed since the last frame that few pixels can stay.
glint_status glint_renderer_run_adaptive(glint_renderer *renderer, const glint_plan *plan, glint_image *image,
                                         const glint_tone_table *table, glint_frame_stats *stats, glint_error *error)
{
    glint_refine *refine = renderer->refine;
    glint_image *base_image = NULL, in_place;
    glint_frame_stats first;
    const bool alone =
        !renderer->reuse.on || !renderer->base || !glint_key_equal(renderer->setting, plan->setting_key);
    renderer->setting = plan->setting_key;
    refine->whole = !glint_plan_compares_codes(&plan->desc) && !plan->derivatives &&
                    !(glint_plan_casts_centres(plan) && glint_tile_wants_geometry(plan));
    refine->in_place = refine->whole && alone;
    glint_status status = open_base(renderer, error);
    if (!status)
        status = refine->in_place ? render_in_place(renderer, plan, image, table, &in_place, &base_image, &first, error)
                                  : render_base(renderer, plan, &base_image, &first, error);
    if (!status)
        status =
            refine_base(renderer, plan, image, refine->in_place ? &in_place : base_image, table, &first, stats, error);
    glint_image_release(base_image);
    return status;
}
