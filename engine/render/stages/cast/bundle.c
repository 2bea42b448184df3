// Camera rays, and hits of coherent bundles of rays: rays from one eye, also through pixels at any position.
#include "engine/render/adaptive/kernel_pixels.h"
#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/cast.h"

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

KERNEL(camera, glint_camera_args)
KERNEL(cast_bundle, glint_cast_args)

bool GLINT_ENTRY(R(in_sight))(const glint_cast_args *args)
{
    return R(in_sight)(args);
}
