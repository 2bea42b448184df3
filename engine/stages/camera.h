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

/// out = start + s * along, a component at a time.
static inline void R(axis_vectors)(const double start[3], const double along[3], const real s[GLINT_GROUP],
                                   void *const out[3], size_t at)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i += VR)
            r_store((real *)out[c] + at + i, r_set(start[c]) + r_load(s + i) * r_set(along[c]));
}

static const _Alignas(64) double R(lane_x)[GLINT_GROUP] = { 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3 };
static const _Alignas(64) double R(lane_y)[GLINT_GROUP] = { 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3 };

/// Directions from one eye are sums of what the column says and what the row says.
static void R(camera_perspective)(const glint_camera_args *args)
{
    _Alignas(64) real s[GLINT_GROUP];
    for (uint32_t x = 0; x < args->groups_across; x++) {
        R(pixel_axis)(args->x0 + 4 * x, R(lane_x), args->offset[0], args->width, false, s);
        R(axis_vectors)(args->forward, args->right, s, args->across, (size_t)x * GLINT_GROUP);
    }
    for (uint32_t y = 0; y < args->group_count / args->groups_across; y++) {
        R(pixel_axis)(args->y0 + 4 * y, R(lane_y), args->offset[1], args->height, true, s);
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < GLINT_GROUP; i += VR)
                r_store((real *)args->down[c] + (size_t)y * GLINT_GROUP + i, r_load(s + i) * r_set(args->up[c]));
    }
}

static void R(camera_orthographic)(const glint_camera_args *args)
{
    _Alignas(64) real s[GLINT_GROUP], t[GLINT_GROUP];
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        R(pixel_axis)(args->x0 + 4 * (g % args->groups_across), R(lane_x), args->offset[0], args->width, false, s);
        R(pixel_axis)(args->y0 + 4 * (g / args->groups_across), R(lane_y), args->offset[1], args->height, true, t);
        R(axis_vectors)(args->eye, args->right, s, args->origin, at);
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < GLINT_GROUP; i += VR) {
                real *origin = (real *)args->origin[c] + at + i;
                r_store(origin, r_load(origin) + r_load(t + i) * r_set(args->up[c]));
                r_store((real *)args->direction[c] + at + i, r_set(args->forward[c]));
            }
    }
}

static void R(camera)(const glint_camera_args *args)
{
    if (args->orthographic)
        R(camera_orthographic)(args);
    else
        R(camera_perspective)(args);
}

static inline void R(load3)(const void *const v[3], size_t at, vr out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = r_load((const real *)v[k] + at);
}

/// A group, and where it stands among the camera's.
typedef struct R(group_place) {
    uint32_t g, x, y;
} R(group_place);

static inline void R(next_group)(const glint_camera_args *camera, R(group_place) * place)
{
    place->g++;
    if (camera && ++place->x == camera->groups_across) {
        place->x = 0;
        place->y++;
    }
}

/// Where the directions of one group are: the sum of two arrays, or one.
typedef struct R(group_directions) {
    const real *a[3], *b[3];
    bool sum;
} R(group_directions);

/// `direction` is read where `camera` is NULL.
static inline R(group_directions)
    R(directions_of)(const glint_camera_args *camera, const void *const direction[3], R(group_place) place)
{
    R(group_directions) out = { .sum = camera != NULL };
    for (int k = 0; k < 3; k++)
        if (camera) {
            out.a[k] = (const real *)camera->across[k] + (size_t)place.x * GLINT_GROUP;
            out.b[k] = (const real *)camera->down[k] + (size_t)place.y * GLINT_GROUP;
        } else {
            out.a[k] = out.b[k] = (const real *)direction[k] + (size_t)place.g * GLINT_GROUP;
        }
    return out;
}

static inline void R(load_direction)(const R(group_directions) * directions, int i, vr out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = r_load(directions->a[k] + i);
        if (directions->sum)
            out[k] = out[k] + r_load(directions->b[k] + i);
    }
}
