/// Data of the current sample that stages request. It is only computed when a stage needs it.
#include "engine/render/tile/tile.h"

void glint_tile_need_rays(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (!walk->rays)
        glint_tile_make_rays(tile, frame);
    walk->rays = true;
}

void glint_tile_need_points(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (walk->points)
        return;
    glint_tile_need_rays(tile, frame, walk);
    glint_tile_find_surfaces(tile, frame);
    walk->points = true;
}
