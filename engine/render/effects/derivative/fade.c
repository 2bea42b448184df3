/// Derivatives of light that fades with the distance from the eye; see effects/depth_cue/depth_cue.c.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/effects/depth_cue/depth_cue.h"
#include "engine/render/effects/derivative/work.h"

#include <stdlib.h>

/// The share of a pixel's light that remains, and the share of the colour that it fades towards.
typedef struct fade {
    glint_dual transmittance[3], share;
} fade;

bool glint_derive_fade_fits(glint_derivative_work *work, const glint_plan *plan)
{
    if (plan->runs[GLINT_STAGE_DEPTH_CUE] && !work->faded)
        work->faded = glint_alloc(GLINT_DERIVATIVES_MAX, sizeof *work->faded);
    return !plan->runs[GLINT_STAGE_DEPTH_CUE] || work->faded;
}

/// Returns the distance of the hit that the eye sees in lane i.
static glint_dual distance_of(const glint_tile *tile, const glint_tile_frame *frame, size_t index, uint32_t i,
                              double distance)
{
    glint_derivative_points points;
    glint_derivative_find_points(tile, frame, i / GLINT_GROUP, &points);
    glint_dual out = dual(distance, 0);
    glint_bend bend;
    if (frame->plan->derivatives->of[index].bends && glint_has_lane(tile->at.hits, i) &&
        glint_bend_sample(tile, frame, index, i, &points, &bend))
        for (int c = 0; c < 3; c++)
            out.slope -= (bend.point[c] - bend.from[c]) * points.eye[c][i % GLINT_GROUP];
    return out;
}

static glint_dual share_of(const glint_plan *plan, const glint_plan_derivative *d, glint_dual distance)
{
    const glint_plan_depth_cue *cue = glint_plan_depth_cue_of(plan);
    if (!cue || !(distance.value < HUGE_VAL))
        return dual(0, 0);
    const glint_dual near = dual(cue->near, d->fade.near), far = dual(cue->far, d->fade.far);
    const glint_dual x = dual_div(dual_sub(distance, near), dual_sub(far, near));
    return x.value >= 1 ? dual(1, 0) : x.value > 0 ? x : dual(0, 0);
}

static fade find_fade(const glint_plan *plan, const glint_plan_derivative *d, glint_dual distance)
{
    fade out = { .share = share_of(plan, d, distance) };
    const glint_dual rest = dual_sub(dual(1, 0), out.share);
    for (int c = 0; c < 3; c++) {
        const double a = plan->eye_medium.absorption[c], more = plan->eye_medium.on ? d->bounces[plan->eye_medium.material].absorption[c] : 0;
        const double transmittance = glint_plan_transmittance(a, distance.value);
        out.transmittance[c] = rest;
        if (distance.value < HUGE_VAL)
            out.transmittance[c] =
                dual_mul(rest, dual(transmittance, -transmittance * (a * distance.slope + more * distance.value)));
        else
            out.transmittance[c] = dual_scale(rest, transmittance);
    }
    return out;
}

void glint_derive_fade(glint_tile *tile, const glint_tile_frame *frame)
{
    glint_derivative_work *work = glint_derivative_of(tile);
    const glint_plan *plan = frame->plan;
    const glint_plan_derivatives *all = plan->derivatives;
    const glint_plan_depth_cue *cue = glint_plan_depth_cue_of(plan);
    const bool weighs = glint_derivatives_weigh(all);
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const double distance = glint_tile_hit_distance(tile, plan, i);
        for (size_t k = 0; k < all->count; k++) {
            const glint_plan_derivative *d = &all->of[k];
            const fade f = find_fade(plan, d, distance_of(tile, frame, k, i, distance));
            for (int c = 0; c < 3; c++) {
                const double before = tile->sample == 0 ? 0 : work->faded[k][c][i], light = weighs ? work->light[c][i] : 0;
                const double color = f.share.slope * (cue ? cue->color[c] : 0) + f.share.value * d->fade.color[c];
                const double own = f.transmittance[c].value > 0 ? work->sum[k][c][i] * f.transmittance[c].value : 0;
                work->faded[k][c][i] = before + ((own + light * f.transmittance[c].slope) + color);
                work->sum[k][c][i] = 0;
            }
        }
    }
}
