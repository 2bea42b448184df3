// Makes camera rays, and finds hits in two ways: for coherent bundles from one eye (a tile's pixels, or pixels at any
// position), and for rays that need not be coherent. One file, because both traversals call the same tests of primitives.
#include "engine/render/adaptive/kernel_pixels.h"
#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/cast.h"
#include "engine/render/stages/cast/parallel.h"
#include "engine/render/stages/cast/rays.h"
#include "engine/render/stages/cast/together.h"

static void R(cast_bundle)(const glint_cast_args *args)
{
    glint_cast_view own;
    if (args->camera->pixel[0]) {
        R(cast_pixels)(args);
        return;
    }
    own.made = false;
    const R(cast_view) *view = R(view_of)(args, &own);
    if (view->few)
        R(cast_few)(args, view);
    else
        R(cast_many)(args);
}

static bool R(in_sight)(const glint_cast_args *args)
{
    const glint_geometry_table *geometry = args->geometry;
    glint_cast_view own;
    own.made = false;
    const R(cast_view) *few = R(view_of)(args, &own);
    const R(candidate) * list[GLINT_FIRST_CANDIDATES];
    screen_view view;
    node_on_screen seen;
    if (few->few)
        return R(candidates_in)(few, args->camera, list, 1) > 0;
    R(aim_screen)(args->camera, geometry, &view);
    for (uint32_t i = 0; i < geometry->unbounded_count; i++)
        if (R(plane_ahead)(args->camera, &view, &geometry->prims[geometry->unbounded[i]]))
            return true;
    return geometry->nodes && boxes_on_screen(geometry->nodes, &view, &seen);
}

/// Casts in a scene with many primitives.
static void R(cast_many_rays)(const glint_cast_args *args)
{
    _Alignas(64) float local[3][GLINT_GROUP];
    R(ray_group) rays;
    R(lone_rays) lone;
    R(ray_pairs) pairs = { .count = 0 };
    for (uint32_t g = 0; g < args->group_count; g++) {
        if (!R(begin_rays)(args, g, local, &rays))
            continue;
        R(load_lone_rays)(&rays, &lone);
        const unsigned usual = GLINT_REAL == 64 ? lone.usual : 0;
        if (args->active[g] & usual)
            R(walk_rays)(args, g, &rays, &lone, args->active[g] & usual, &pairs);
        for (unsigned lanes = args->active[g] & ~usual; lanes; lanes &= lanes - 1)
            R(walk_ray)(args, g, &rays, __builtin_ctz(lanes));
    }
    R(decide_ray_pairs)(args, &pairs);
    for (uint32_t g = 0; g < args->group_count; g++) {
        if (pairs.undecided[g])
            R(make_ray_group)(args, g, local, &rays);
        for (unsigned lanes = pairs.undecided[g]; lanes; lanes &= lanes - 1)
            R(walk_ray)(args, g, &rays, __builtin_ctz(lanes));
        R(finish_group)(args, g);
    }
}

static void R(cast_rays)(const glint_cast_args *args)
{
    const glint_geometry_table *geometry = args->geometry;
    _Alignas(64) float local[3][GLINT_GROUP];
    R(ray_group) rays;
    if (geometry->nodes && R(is_beam)(args->camera)) {
        R(cast_parallel)(args);
    } else if (geometry->nodes && geometry->prim_count > GLINT_FEW) {
        R(cast_many_rays)(args);
    } else if (geometry->nodes) {
        R(cast_few_rays)(args);
    } else {
        for (uint32_t g = 0; g < args->group_count; g++) {
            R(begin_rays)(args, g, local, &rays);
            R(finish_group)(args, g);
        }
    }
}

KERNEL(camera, glint_camera_args)
KERNEL(cast_bundle, glint_cast_args)
KERNEL(cast_rays, glint_cast_args)

bool GLINT_ENTRY(R(in_sight))(const glint_cast_args *args)
{
    return R(in_sight)(args);
}
