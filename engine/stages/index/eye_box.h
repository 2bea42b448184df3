// eye_box: which rays from one eye may meet what is in a box. Where a ray at t goes through the plane of a face, 1 / t is linear
// in its place on the screen. It goes in through the last of the planes that the eye is before, and out through the first of the
// others: least and greatest of these numbers say whether it is ever within. Float and conservative, as all of walk.h is.
#ifndef GLINT_INDEX_EYE_BOX_H
#define GLINT_INDEX_EYE_BOX_H

#include "engine/stages/index/screen.h"
#include "engine/stages/index/walk.h"
#include "engine/stages/simd/elementary.h"

/// The planes of a box: coefficients of 1, s and t.
typedef struct eye_box {
    float in[3][3], out[6][3];
    int in_count, out_count;
    float margin; ///< more than what rounding moves these numbers by
} eye_box;

/// A plane square to axis k, `away` from the eye. s, t: as large as places are.
static inline void see_plane(const glint_camera_args *camera, int k, double away, double s, double t, float out[3],
                             float *margin)
{
    const double per = 1 / away, base = camera->forward[k] * per;
    const double along_s = camera->right[k] * per, along_t = camera->up[k] * per;
    out[0] = (float)base;
    out[1] = (float)along_s;
    out[2] = (float)along_t;
    const float size = (float)((fabs(base) + s * fabs(along_s)) + t * fabs(along_t));
    *margin = larger(WALK_SLACK * size, *margin);
}

/// The box in a slot of a node. NaN and infinity keep rays.
static eye_box see_box(const glint_camera_args *camera, const screen_view *view, const glint_node *node, int slot)
{
    const double s = fmax(fabsf(view->first[0]), fabsf(view->last[0])) + 2;
    const double t = fmax(fabsf(view->first[1]), fabsf(view->last[1])) + 2;
    eye_box box = { .in_count = 0, .out_count = 0, .margin = 0 };
    for (int k = 0; k < 3; k++) {
        const double lower = node->lower[k][slot], upper = node->upper[k][slot], eye = view->exact[k];
        const double loose = WALK_SLACK * fmax(fabs(lower), fabs(upper)) + 0x1p-40 * fabs(eye);
        const double below = (lower - loose) - eye, above = (upper + loose) - eye;
        see_plane(camera, k, below, s, t, below > 0 ? box.in[box.in_count++] : box.out[box.out_count++], &box.margin);
        see_plane(camera, k, above, s, t, above < 0 ? box.in[box.in_count++] : box.out[box.out_count++], &box.margin);
    }
    return box;
}

INNER vf over_plane(const float plane[3], vf s, vf t)
{
    return (f_set(plane[0]) + t * f_set(plane[2])) + s * f_set(plane[1]);
}

/// Lanes whose rays, at s and t, may be within ahead.
INNER unsigned lanes_in_box(const eye_box *box, vf s, vf t)
{
    vf in = f_set(FLT_MAX), out = f_set(0);
    for (int i = 0; i < box->in_count; i++)
        in = f_min(over_plane(box->in[i], s, t), in);
    for (int i = 0; i < box->out_count; i++)
        out = f_max(over_plane(box->out[i], s, t), out);
    return ~fm_bits(f_lt(in + f_set(box->margin), out)) & ((1u << VF) - 1);
}

#endif
