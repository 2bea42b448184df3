// cast_parallel: the nearest hit of the rays of an orthographic camera's tile, which walk the index together as those of one eye
// do (cast.h). Contract: stages.h.

/// The tile's rays: the screen lies across them, and its places are theirs wherever they are.
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

static void R(aim_parallel)(const glint_cast_args *args, R(tile_cast) * tile)
{
    R(begin_tile)(args, tile);
    R(aim_parallel_screen)(args->camera, args->geometry, &tile->view);
    tile->parallel = tile->deep = true;
}

/// The rays and the planes: what all of the tile has behind it is known before the walk.
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
    R(aim_parallel)(args, &tile);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(cast_planes)(&tile, g);
    stack[0] = entry_of_root(&tile.view);
    R(walk_tile)(&tile, stack, 1);
    for (uint32_t g = 0; g < args->group_count; g++)
        R(finish_group)(args, g);
}
