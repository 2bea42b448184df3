/// What a tile's working memory has beside the tile itself: made when the first frame asks for it, kept for those after it.
#include "engine/base/alloc.h"
#include "engine/tile/tile.h"

#include <stdlib.h>

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
    if (plan->runs[GLINT_STAGE_VERTEX] && !tile->vertex)
        good = (tile->vertex = glint_vertex_create()) && good;
    if (plan->runs[GLINT_STAGE_CUE] && !tile->cue)
        good = (tile->cue = glint_cue_create()) && good;
    if (plan->scan && !tile->beside)
        good = (tile->beside = glint_beside_create()) && good;
    if (plan->tints && !tile->tint)
        good = (tile->tint = glint_tint_create()) && good;
    if (plan->together && !tile->samples)
        good = (tile->samples = glint_samples_create()) && good;
    if (plan->facets && !tile->facets)
        good = (tile->facets = glint_alloc(1, sizeof *tile->facets)) && good;
    if (plan->glow_count && !tile->glow)
        tile->glow = glint_glow_create();
    return good && (!plan->glow_count || glint_glow_fits(tile->glow, plan));
}

void glint_tile_destroy(glint_tile *tile)
{
    if (!tile)
        return;
    glint_bounce_destroy(tile->bounce);
    glint_tint_destroy(tile->tint);
    glint_vertex_destroy(tile->vertex);
    glint_beside_destroy(tile->beside);
    glint_glow_destroy(tile->glow);
    glint_cue_destroy(tile->cue);
    glint_indirect_destroy(tile->indirect);
    glint_samples_destroy(tile->samples);
    free(tile->facets);
    free(tile);
}
