// pixels: what rays of a camera meet whose pixels are given one by one, as adaptive sampling gathers them. Contract: stages.h.

/// Decides a sphere for all lanes of a group of pixels wherever they are.
INNER void R(decide_ball)(const glint_cast_args *args, const R(candidate) * ball, uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    const vr f[3] = { r_set(ball->f[0]), r_set(ball->f[1]), r_set(ball->f[2]) };
    const R(group_directions) directions = R(directions_of)(args->camera, 0, g);
    count_tests(args->tests, args->active[g]);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        vr d[3], t;
        R(load_direction)(directions, args->direction, 0, i, d);
        const vr a = DOT(d, d), b = -DOT(f, d);
        if (!rm_bits(r_le(r_set(0), R(discriminant)(f, d, a, b, r_set(ball->c), r_set(ball->r2)))))
            continue;
        const rm hit = R(meet_ball)(f, d, a, r_set(ball->c), r_set(ball->r2), r_set(ball->scale), &t);
        if (rm_bits(hit))
            R(keep_nearest)(args, at + (size_t)i, ball->id, hit, t);
    }
}

/// Decides a candidate for all rays of pixels wherever they are.
static void R(cast_to_pixels)(R(tile_cast) * tile, const R(candidate) * candidate)
{
    const glint_cast_args *args = tile->args;
    for (uint32_t g = 0; g < args->group_count; g++)
        if (candidate->prim->kind == GLINT_PRIM_SPHERE)
            R(decide_ball)(args, candidate, g);
        else
            R(decide_pixels)(tile, candidate, 0, (int)g, args->active[g]);
}

/// Of pixels wherever they are. Meant for scenes with few primitives: of others each is tested against every ray.
static void R(cast_pixels)(const glint_cast_args *args)
{
    const glint_camera_args *camera = args->camera;
    const R(candidate) * list[GLINT_FIRST_CANDIDATES];
    glint_camera_args around = *camera;
    glint_cast_args tile_args = *args;
    glint_cast_view own;
    R(tile_cast) tile;
    own.made = false;
    around.groups_across = (uint32_t)(camera->end[0] - camera->x0 + 3) / 4;
    around.group_count = around.groups_across * ((uint32_t)(camera->end[1] - camera->y0 + 3) / 4);
    tile_args.camera = &around;
    const R(cast_view) *view = R(view_of)(&tile_args, &own);
    const int count = view->few ? R(candidates_in)(view, &around, list, view->count) : 0;
    tile.args = args;
    tile.across = 1;
    for (uint32_t g = 0; g < args->group_count; g++)
        R(start_group)(args, g);
    for (int k = 0; k < count; k++)
        R(cast_to_pixels)(&tile, list[k]);
    for (uint32_t id = 0; !view->few && id < args->geometry->prim_count; id++) {
        R(candidate) candidate;
        R(place_candidate)(args, id, &candidate);
        R(cast_to_pixels)(&tile, &candidate);
    }
    for (uint32_t g = 0; g < args->group_count; g++)
        R(finish_group)(args, g);
}
