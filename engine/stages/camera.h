// camera: the rays of one sample of each pixel of a tile. Contract: stages.h.

static void R(camera)(const glint_camera_args *args)
{
    enum { ACROSS = GLINT_TILE_WIDTH / 4, DOWN = GLINT_TILE_HEIGHT / 4 };
    _Alignas(64) real column[ACROSS][GLINT_GROUP], row[DOWN][GLINT_GROUP];
    const uint32_t across = args->groups_across, down = (args->group_count + across - 1) / across;
    for (uint32_t g = 0; g < across; g++)
        for (int i = 0; i < GLINT_GROUP; i++)
            column[g][i] = (real)(2 * ((args->x0 + 4 * g + i % 4) + args->offset[0]) - args->width);
    for (uint32_t g = 0; g < down; g++)
        for (int i = 0; i < GLINT_GROUP; i++)
            row[g][i] = (real)(args->height - 2 * ((args->y0 + 4 * g + i / 4) + args->offset[1]));

    vr base[3], right[3], up[3], forward[3];
    for (int c = 0; c < 3; c++) {
        right[c] = r_set(args->right[c]);
        up[c] = r_set(args->up[c]);
        forward[c] = r_set(args->forward[c]);
        base[c] = args->orthographic ? r_set(args->eye[c]) : forward[c];
    }
    void *const *moving = args->orthographic ? args->origin : args->direction;
    for (uint32_t g = 0; g < args->group_count; g++) {
        const real *sx = column[g % across], *sy = row[g / across];
        const size_t at = (size_t)g * GLINT_GROUP;
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < GLINT_GROUP; i += VR) {
                r_store((real *)moving[c] + at + i,
                        (base[c] + r_load(sx + i) * right[c]) + r_load(sy + i) * up[c]);
                if (args->orthographic)
                    r_store((real *)args->direction[c] + at + i, forward[c]);
            }
        R(unit)(args, at);
    }
}
