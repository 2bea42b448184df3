/// Fading by the distance from the eye to the first surface of a sample. A medium around the eye transmits
/// exp(-absorption x distance) of the light; a depth cue then fades it towards a colour. Every term is scaled, and
/// the colour's share is added to the background term, so that passes still add up.
///
/// Everything is computed in double, by the same code for every instruction set.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/effects/depth_cue/depth_cue.h"
#include "engine/render/light_groups/light_groups.h"

#include <stdlib.h>
#include <string.h>

struct glint_depth_cue {
    double total[GLINT_TERM_COUNT][3][GLINT_TILE_SAMPLES]; ///< over the finished samples
    double transmittance[3][GLINT_TILE_SAMPLES]; ///< remaining share of the light in each pixel of the current sample
    double share[GLINT_TILE_SAMPLES]; ///< share of the cue's colour in each pixel of the current sample
};

static void *create(const glint_plan *plan)
{
    (void)plan;
    return glint_alloc(1, sizeof(struct glint_depth_cue));
}

static struct glint_depth_cue *own_of(const glint_tile *tile) { return tile->own[GLINT_STAGE_DEPTH_CUE]; }

/// Returns the share of the colour at a distance. The background does not fade.
static double share_of(const glint_plan_depth_cue *cue, double distance)
{
    const double x = cue ? (distance - cue->near) / (cue->far - cue->near) : 0;
    return distance < HUGE_VAL && x > 0 ? fmin(x, 1) : 0;
}

/// Computes the share of the cue and the transmittance from the first hits of the current sample, before any other
/// rays are traced.
static void find(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    const glint_plan *plan = frame->plan;
    const bool any = walk->any || plan->runs[GLINT_STAGE_VISIBLE_LIGHT];
    if (any)
        glint_tile_need_rays(tile, frame, walk);
    struct glint_depth_cue *depth_cue = own_of(tile);
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const double distance = any ? glint_tile_hit_distance(tile, plan, i) : HUGE_VAL;
        depth_cue->share[i] = share_of(glint_plan_depth_cue_of(plan), distance);
        for (int c = 0; c < 3; c++)
            depth_cue->transmittance[c][i] =
                (1 - depth_cue->share[i]) * glint_plan_transmittance(plan->eye_medium.absorption[c], distance);
    }
}

/// Adds the faded sums of the current sample to the totals of the tile, and clears the sums.
static void fade(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    (void)walk;
    const glint_plan *plan = frame->plan;
    const glint_plan_depth_cue *cue = glint_plan_depth_cue_of(plan);
    const double *share = own_of(tile)->share;
    for (int k = 0; k < GLINT_TERM_COUNT; k++)
        for (int c = 0; c < 3 && glint_plan_has_term(plan, (glint_term)k); c++) {
            double *sum = tile->film.sum[k][c], *total = own_of(tile)->total[k][c];
            const double *transmittance = own_of(tile)->transmittance[c];
            const double color = cue && k == GLINT_TERM_BACKGROUND ? cue->color[c] : 0;
            for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
                const double before = tile->sample == 0 ? 0 : total[i];
                total[i] = before + ((transmittance[i] > 0 ? sum[i] * transmittance[i] : 0) + share[i] * color);
                sum[i] = 0;
            }
        }
    glint_groups_fade(tile, plan, (const double(*)[GLINT_TILE_SAMPLES])own_of(tile)->transmittance);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_DEPTH_CUE, false);
}

/// Copies the totals to the sums that resolve reads.
static void take_faded(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    const glint_plan *plan = frame->plan;
    (void)walk;
    for (int k = 0; k < GLINT_TERM_COUNT; k++)
        if (glint_plan_has_term(plan, (glint_term)k))
            memcpy(tile->film.sum[k], own_of(tile)->total[k], sizeof tile->film.sum[k]);
}

static glint_key own_key(const glint_plan *plan, glint_key key)
{
    const glint_plan_depth_cue *cue = glint_plan_depth_cue_of(plan);
    if (cue)
        GLINT_KEY_ADD(key, *cue);
    if (plan->eye_medium.on)
        GLINT_KEY_ADD(key, plan->eye_medium.absorption);
    return key;
}

static glint_status prepare(glint_plan *plan, const glint_plan_input *from, glint_error *error)
{
    const glint_scene_desc *scene = &from->scene->desc;
    if (!scene->has_depth_cue || (plan->geometry->table.prim_count == 0 && !plan->own[GLINT_STAGE_VISIBLE_LIGHT]))
        return GLINT_OK;
    glint_plan_depth_cue *cue = malloc(sizeof *cue);
    if (!cue)
        return glint_fail_nomem(error);
    glint_plan_bounded(cue->color, scene->has_depth_cue_color ? scene->depth_cue_color : scene->background, 1);
    cue->near = scene->depth_cue_near;
    cue->far = scene->depth_cue_far;
    plan->own[GLINT_STAGE_DEPTH_CUE] = cue;
    return GLINT_OK;
}

static bool called(const glint_plan *plan) { return glint_plan_depth_cue_of(plan) || plan->eye_medium.on; }

const glint_stage glint_stage_depth_cue = {
    .name = "depth_cue",
    .doc = "light faded by the distance from the eye",
    .effect = "depth cue",
    .caller = "scene.depth_cue",
    .prepare = prepare,
    .called = called,
    .own = own_key,
    .reads = GLINT_READS_OWN(DEPTH_CUE),
    .walks = true,
    .sums = true,
    .remote = true,
    .scales = true,
    .step = { [GLINT_AFTER_PRIMARY] = find, [GLINT_AT_SUMMED] = fade, [GLINT_AT_DONE] = take_faded },
    .create = create,
    .destroy = free,
};
