// camera: the rays of one sample of each pixel of a tile. Contract: stages.h.
#ifndef GLINT_CAST_CAMERA_H
#define GLINT_CAST_CAMERA_H

#include "engine/render/stages/simd/real.h"

/// Computes 2 (first + step) - size for the lanes of a group, in double, rounded to real. If `mirrored` is set,
/// computes size - 2 (first + step) instead.
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

static const _Alignas(64) double R(lane_x)[GLINT_GROUP] = { 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3 };
static const _Alignas(64) double R(lane_y)[GLINT_GROUP] = { 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3 };

/// Computes the directions from one eye. Each is the sum of a vector for the column and a vector for the row.
static void R(camera_perspective)(const glint_camera_args *args)
{
    _Alignas(64) real s[GLINT_GROUP];
    for (uint32_t x = 0; x < args->groups_across; x++) {
        real *across = (real *)args->across + (size_t)x * 3 * GLINT_GROUP;
        R(pixel_axis)(args->x0 + 4 * x, R(lane_x), args->offset[0], args->width, false, s);
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < GLINT_GROUP; i += VR)
                r_store(across + c * GLINT_GROUP + i, r_set(args->forward[c]) + r_load(s + i) * r_set(args->right[c]));
    }
    for (uint32_t y = 0; y < args->group_count / args->groups_across; y++) {
        real *down = (real *)args->down + (size_t)y * 3 * GLINT_GROUP;
        R(pixel_axis)(args->y0 + 4 * y, R(lane_y), args->offset[1], args->height, true, s);
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < GLINT_GROUP; i += VR)
                r_store(down + c * GLINT_GROUP + i, r_load(s + i) * r_set(args->up[c]));
    }
}

/// For pixels at any position: `down` gets the complete directions, and `across` gets -0, which changes no number,
/// not even the sign of a 0.
static void R(camera_pixels)(const glint_camera_args *args)
{
    _Alignas(64) real s[GLINT_GROUP], t[GLINT_GROUP];
    for (int i = 0; i < 3 * GLINT_GROUP; i += VR)
        r_store((real *)args->across + i, r_set(-0.0));
    for (uint32_t g = 0; g < args->group_count; g++) {
        real *down = (real *)args->down + (size_t)g * 3 * GLINT_GROUP;
        R(pixel_axis)(0, args->pixel[0] + (size_t)g * GLINT_GROUP, args->offset[0], args->width, false, s);
        R(pixel_axis)(0, args->pixel[1] + (size_t)g * GLINT_GROUP, args->offset[1], args->height, true, t);
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < GLINT_GROUP; i += VR)
                r_store(down + c * GLINT_GROUP + i, (r_set(args->forward[c]) + r_load(s + i) * r_set(args->right[c])) +
                                                        r_load(t + i) * r_set(args->up[c]));
    }
}

static void R(camera_orthographic)(const glint_camera_args *args)
{
    _Alignas(64) real s[GLINT_GROUP], t[GLINT_GROUP];
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        R(pixel_axis)(args->x0 + 4 * (g % args->groups_across), R(lane_x), args->offset[0], args->width, false, s);
        R(pixel_axis)(args->y0 + 4 * (g / args->groups_across), R(lane_y), args->offset[1], args->height, true, t);
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < GLINT_GROUP; i += VR) {
                r_store((real *)args->origin[c] + at + i,
                        (r_set(args->eye[c]) + r_load(s + i) * r_set(args->right[c])) +
                            r_load(t + i) * r_set(args->up[c]));
                r_store((real *)args->direction[c] + at + i, r_set(args->forward[c]));
            }
    }
}

/// Computes the rays of a group of a perspective camera with a lens.
INNER void R(lens_perspective)(const glint_camera_args *args, const real *shift, const real *bend, uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP, x = g % args->groups_across, y = g / args->groups_across;
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < GLINT_GROUP; i += VR) {
            const real *across = (const real *)args->across + (3 * x + c) * GLINT_GROUP + i;
            const real *down = (const real *)args->down + (3 * y + c) * GLINT_GROUP + i;
            r_store((real *)args->origin[c] + at + i, r_set(args->eye[c]) + r_load(shift + c * GLINT_GROUP + i));
            r_store((real *)args->direction[c] + at + i,
                    (r_load(across) + r_load(down)) - r_load(bend + c * GLINT_GROUP + i));
        }
}

/// Computes one component of the rays of an orthographic camera with a lens.
INNER void R(lens_orthographic)(const glint_camera_args *args, const real *shift, const real *bend, uint32_t g)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < GLINT_GROUP; i += VR) {
            real *origin = (real *)args->origin[c] + at + i, *direction = (real *)args->direction[c] + at + i;
            r_store(origin, r_load(origin) + r_load(shift + c * GLINT_GROUP + i));
            r_store(direction, r_load(direction) - r_load(bend + c * GLINT_GROUP + i));
        }
}

static void R(camera_lens)(const glint_camera_args *args)
{
    _Alignas(64) real shift[3 * GLINT_GROUP], bend[3 * GLINT_GROUP];
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < GLINT_GROUP; i++) {
            shift[c * GLINT_GROUP + i] = (real)args->lens->shift[c][i];
            bend[c * GLINT_GROUP + i] = (real)args->lens->bend[c][i];
        }
    if (args->orthographic)
        R(camera_orthographic)(args);
    else
        R(camera_perspective)(args);
    for (uint32_t g = 0; g < args->group_count; g++)
        if (args->orthographic)
            R(lens_orthographic)(args, shift, bend, g);
        else
            R(lens_perspective)(args, shift, bend, g);
}

static void R(camera)(const glint_camera_args *args)
{
    if (GLINT_WITH(LENS) && args->lens)
        R(camera_lens)(args);
    else if (args->pixel[0])
        R(camera_pixels)(args);
    else if (args->orthographic)
        R(camera_orthographic)(args);
    else
        R(camera_perspective)(args);
}

INNER void R(load3)(const void *const v[3], size_t at, vr out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = r_load((const real *)v[k] + at);
}

/// The number of a group, and the column and row of the group in the tile.
typedef struct R(group_cursor) {
    uint32_t g, x, y;
} R(group_cursor);

INNER void R(next_group)(const glint_camera_args *camera, R(group_cursor) * cursor)
{
    cursor->g++;
    if (camera && ++cursor->x == camera->groups_across) {
        cursor->x = 0;
        cursor->y++;
    }
}

/// The directions of one group: sums of a column's and a row's vector. If both are NULL, the directions are in arrays.
typedef struct R(group_directions) {
    const real *across, *down;
} R(group_directions);

INNER R(group_directions) R(directions_of)(const glint_camera_args *camera, uint32_t x, uint32_t y)
{
    if (!camera)
        return (R(group_directions)) { NULL, NULL };
    return (R(group_directions)) { (const real *)camera->across + (size_t)x * 3 * GLINT_GROUP,
                                   (const real *)camera->down + (size_t)y * 3 * GLINT_GROUP };
}

/// Loads the directions of the lanes from i on. `direction`, `at`: the arrays, and the offset of the group in them;
/// only read if the directions are in arrays.
INNER void R(load_direction)(R(group_directions) from, const void *const direction[3], size_t at, int i, vr out[3])
{
    for (int k = 0; k < 3; k++) {
        if (from.across)
            out[k] = r_load(from.across + k * GLINT_GROUP + i) + r_load(from.down + k * GLINT_GROUP + i);
        else
            out[k] = r_load((const real *)direction[k] + at + i);
    }
}

#endif
