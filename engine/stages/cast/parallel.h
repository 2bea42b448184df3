// cast_parallel: the nearest hit of the rays of a tile, for orthographic cameras. The rays traverse the index together,
// as rays from one eye do (cast.h). Contract: stages.h.
#ifndef GLINT_CAST_PARALLEL_H
#define GLINT_CAST_PARALLEL_H

#include "engine/stages/cast/cast.h"
#include "engine/stages/cast/meet.h"
#include "engine/stages/cast/rays.h"
#include "engine/stages/index/candidate.h"
#include "engine/stages/index/screen.h"
#include "engine/stages/index/walk.h"
#include "engine/stages/simd/real.h"

/// Aims the screen of the tile's parallel rays: the screen is perpendicular to the rays, so that a ray's position on
/// it is the same at every depth.
static void R(aim_parallel_screen)(const glint_camera_args *camera, const glint_geometry_table *geometry,
                                   screen_view *view)
{
    R(aim_screen)(camera, geometry, view);
    for (int j = 0; j < 2; j++) {
        const double *along = j == 0 ? camera->right : camera->up, sign = j == 0 ? 1 : -1;
        const double length2 = DOT(along, along);
        for (int k = 0; k < 3; k++)
            view->axis[j][k] = (float)(sign * along[k] / (length2 * geometry->scale));
        view->unit[j] = (float)(sqrt(length2) * geometry->scale);
    }
    view->base = 1;
    view->inverse = 0;
    view->stretch = 1.00001f;
    finish_screen(view);
}

/// Tests the rays against the planes, so that a depth limit for the tile is known before the traversal.
static void R(cast_planes)(R(tile_cast) * tile, uint32_t g)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    _Alignas(64) float local[3][GLINT_GROUP];
    R(ray_group) rays;
    R(start_group)(tile->args, g);
    if (geometry->unbounded_count > 0)
        R(make_ray_group)(tile->args, g, local, &rays);
    for (uint32_t i = 0; i < geometry->unbounded_count; i++)
        R(cast_on_group)(tile->args, g, &rays, geometry->unbounded[i]);
    R(note_depth)(tile, (int)g % tile->across, (int)g / tile->across);
}

static void R(cast_parallel)(const glint_cast_args *args)
{
    R(tile_cast) tile;
    screen_entry stack[WALK_STACK];
    R(begin_tile)(args, &tile);
    R(aim_parallel_screen)(args->camera, args->geometry, &tile.view);
    tile.parallel = tile.deep = true;
    for (uint32_t g = 0; g < args->group_count; g++)
        R(cast_planes)(&tile, g);
    stack[0] = entry_of_root(&tile.view);
    R(walk_tile)(&tile, stack, 1);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(finish_group)(args, g);
}

#endif
