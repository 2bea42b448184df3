/// Depth cue: the light of a sample fades, by the way to its first surface, towards a colour. What fades is scaled in every
/// term, and the colour's share goes to the term of the background, whose place it takes: so passes still add up.
///
/// All of it is double, and the same code for every instruction set: a frame without cue has none of it.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/tile.h"

#include <stdlib.h>
#include <string.h>

struct glint_cue {
    double total[GLINT_TERM_COUNT][3][GLINT_TILE_SAMPLES]; ///< over the samples that are done
    double share[GLINT_TILE_SAMPLES]; ///< of the colour in each pixel of the current sample
};

struct glint_cue *glint_cue_create(void) { return glint_alloc(1, sizeof(struct glint_cue)); }
void glint_cue_destroy(struct glint_cue *cue) { free(cue); }

void glint_tile_find_cue(glint_tile *tile, const glint_plan *plan, bool any)
{
    double *share = tile->cue->share;
    const glint_precision precision = plan->desc.precision;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        double d[3];
        share[i] = 0;
        if (!any)
            continue;
        if (!(tile->at.hits[i / GLINT_GROUP] >> i % GLINT_GROUP & 1) &&
            !(plan->runs[GLINT_STAGE_GLOW] && glint_tile_sees_light(tile, i)))
            continue;
        for (int c = 0; c < 3; c++)
            d[c] = glint_tile_direction(tile, precision, c, i);
        const double depth = glint_real_at(tile->at.t, precision, i) * sqrt(vec_dot(d, d));
        const double x = (depth - plan->cue.near) / (plan->cue.far - plan->cue.near);
        share[i] = x > 0 ? x < 1 ? x : 1 : 0;
    }
}

void glint_tile_cue(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const double *share = tile->cue->share;
    for (int k = 0; k < GLINT_TERM_COUNT; k++)
        for (int c = 0; c < 3 && glint_plan_has_term(plan, (glint_term)k); c++) {
            double *sum = tile->sum[k][c], *total = tile->cue->total[k][c];
            const double color = k == GLINT_TERM_BACKGROUND ? plan->cue.color[c] : 0;
            for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
                const double before = tile->sample == 0 ? 0 : total[i];
                total[i] = before + ((share[i] < 1 ? sum[i] * (1 - share[i]) : 0) + share[i] * color);
                sum[i] = 0;
            }
        }
    glint_tile_book(tile, frame, GLINT_STAGE_CUE, false);
}

void glint_tile_take_cued(glint_tile *tile, const glint_plan *plan)
{
    for (int k = 0; k < GLINT_TERM_COUNT; k++)
        if (glint_plan_has_term(plan, (glint_term)k))
            memcpy(tile->sum[k], tile->cue->total[k], sizeof tile->sum[k]);
}
