// cast_parallel: the nearest hit of the rays of a tile, for orthographic cameras and cameras with a lens. The rays
// traverse the index together, as rays from one eye do (cast.h). Contract: stages.h.
#ifndef GLINT_CAST_PARALLEL_H
#define GLINT_CAST_PARALLEL_H

#include "engine/render/stages/cast/cast.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/rays.h"
#include "engine/render/stages/index/candidate.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

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

/// Prepares the lens for the screen. The lens changes directions by up to `bend`, so the spread of the directions
/// grows.
static void R(aim_lens)(const glint_cast_args *args, screen_view *view, R(tile_lens) * out)
{
    const glint_camera_args *camera = args->camera;
    const glint_lens *lens = camera->lens;
    const double scale = args->geometry->scale, bend = lens->radius * lens->per_focus;
    for (int j = 0; j < 2; j++) {
        const double *along = j == 0 ? camera->right : camera->up, sign = j == 0 ? 1 : -1;
        const double length2 = DOT(along, along), per = camera->orthographic ? 1 / length2 : scale / length2;
        for (int i = 0; i < GLINT_GROUP; i++)
            out->across[j][i] = (float)(sign * per *
                                        ((lens->shift[0][i] * along[0] + lens->shift[1][i] * along[1]) +
                                         lens->shift[2][i] * along[2]));
        out->seen.reach[j] = (float)(1.00001 * lens->radius * per * sqrt(length2));
    }
    out->seen.per_focus = (float)(lens->per_focus / scale);
    const float slope = sqrtf(larger(view->stretch - 1, 0)) + (float)bend;
    view->stretch = 1.00001f * (1 + slope * slope);
    finish_screen(view);
    view->reach += 2 * GLINT_FILTER_SLACK * view->root_stretch * (float)(lens->radius * scale);
}

static void R(aim_parallel)(const glint_cast_args *args, R(tile_cast) * tile, R(tile_lens) * lens)
{
    R(begin_tile)(args, tile);
    if (args->camera->orthographic)
        R(aim_parallel_screen)(args->camera, args->geometry, &tile->view);
    if (args->camera->lens) {
        R(aim_lens)(args, &tile->view, lens);
        tile->lens = lens;
    }
    tile->parallel = tile->deep = true;
}

/// Returns whether rays through a lens may hit a plane; always true for an orthographic camera.
static inline bool R(lens_sees_plane)(const R(tile_cast) * tile, const glint_prim *prim)
{
    const glint_camera_args *camera = tile->args->camera;
    return camera->orthographic || R(plane_ahead)(camera, &tile->view, prim);
}

/// Tests the rays against the planes, so that a depth limit for the tile is known before the traversal.
static void R(cast_planes)(R(tile_cast) * tile, uint32_t g)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    _Alignas(64) float local[3][GLINT_GROUP];
    R(ray_group) rays;
    R(start_group)(tile->args, g);
    if (geometry->unbounded_count > 0 && !tile->lens)
        R(make_ray_group)(tile->args, g, local, &rays);
    for (uint32_t i = 0; i < geometry->unbounded_count; i++)
        if (!tile->lens)
            R(cast_on_group)(tile->args, g, &rays, geometry->unbounded[i]);
        else if (R(lens_sees_plane)(tile, &geometry->prims[geometry->unbounded[i]]))
            R(decide_rays)(tile->args, g, geometry->unbounded[i], tile->args->active[g]);
    R(note_depth)(tile, (int)g % tile->across, (int)g / tile->across);
}

static void R(cast_parallel)(const glint_cast_args *args)
{
    R(tile_cast) tile;
    R(tile_lens) lens;
    screen_entry stack[WALK_STACK];
    R(aim_parallel)(args, &tile, &lens);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(cast_planes)(&tile, g);
    stack[0] = entry_of_root(&tile.view);
    R(walk_tile)(&tile, stack, 1);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(finish_group)(args, g);
}

#endif
