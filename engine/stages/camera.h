// camera: the rays of one sample of each pixel of a tile. Contract: stages.h.

/// 2 (first + step) - size for the lanes of a group, in double, rounded to real. `mirrored`: size - 2 (...).
static inline void R(pixel_axis)(double first, const double step[GLINT_GROUP], double offset, double size,
                                 bool mirrored, real out[GLINT_GROUP])
{
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        vd twice = d_set(2) * ((d_set(first) + d_load(step + i)) + d_set(offset));
        vd s = twice - d_set(size);
        if (mirrored)
            s = d_set(size) - twice;
#if GLINT_REAL == 64
        d_store(out + i, s);
#else
        d_store_f(out + i, s);
#endif
    }
}

static void R(camera)(const glint_camera_args *args)
{
    static const _Alignas(64) double lane_x[GLINT_GROUP] = { 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3 };
    static const _Alignas(64) double lane_y[GLINT_GROUP] = { 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3 };
    _Alignas(64) real sx[GLINT_GROUP], sy[GLINT_GROUP];
    vr base[3], right[3], up[3], forward[3];
    for (int c = 0; c < 3; c++) {
        right[c] = r_set(args->right[c]);
        up[c] = r_set(args->up[c]);
        forward[c] = r_set(args->forward[c]);
        base[c] = forward[c];
        if (args->orthographic)
            base[c] = r_set(args->eye[c]);
    }
    for (uint32_t g = 0, column = 0, row = 0; g < args->group_count; g++, column++) {
        if (column == args->groups_across)
            column = 0, row++;
        R(pixel_axis)(args->x0 + 4 * column, lane_x, args->offset[0], args->width, false, sx);
        if (column == 0)
            R(pixel_axis)(args->y0 + 4 * row, lane_y, args->offset[1], args->height, true, sy);
        const size_t at = (size_t)g * GLINT_GROUP;
        for (int i = 0; i < GLINT_GROUP; i += VR)
            for (int c = 0; c < 3; c++) {
                vr v = (base[c] + r_load(sx + i) * right[c]) + r_load(sy + i) * up[c], d = v;
                if (args->orthographic) {
                    r_store((real *)args->origin[c] + at + i, v);
                    d = forward[c];
                }
                r_store((real *)args->direction[c] + at + i, d);
                r_store_f(args->direction_f[c] + at + i, d);
            }
    }
}
