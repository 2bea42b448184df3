/// Derivatives by the position of the eye, its orientation and its lens.
#include "engine/base/vec.h"
#include "engine/render/effects/derivative/slopes.h"

#include <string.h>

static void dual_cross(glint_dual out[3], const glint_dual a[3], const glint_dual b[3])
{
    for (int c = 0; c < 3; c++) {
        const int i = (c + 1) % 3, k = (c + 2) % 3;
        out[c] = dual_sub(dual_mul(a[i], b[k]), dual_mul(a[k], b[i]));
    }
}

static glint_dual dual_dot(const glint_dual a[3], const glint_dual b[3])
{
    return dual_add(dual_add(dual_mul(a[0], b[0]), dual_mul(a[1], b[1])), dual_mul(a[2], b[2]));
}

static void put_slopes(double out[3], const glint_dual v[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = v[c].slope;
}

/// Computes the unit axes across the view; see view_axes in plan/camera.c. If `up` is parallel to the view, a
/// constant axis replaces it.
static void find_axes(const glint_plan *plan, const glint_camera_desc *desc, const glint_camera_desc *slope,
                      const glint_dual forward[3], glint_dual right[3], glint_dual up[3])
{
    double hint[3], across[3];
    vec_normalize(hint, desc->up);
    vec_cross(across, plan->camera.forward, hint);
    duals(up, desc->up, slope->up);
    if (vec_dot(across, across) < 1e-24) {
        vec_copy(hint, plan->camera.up);
        for (int c = 0; c < 3; c++)
            up[c] = dual(hint[c], 0);
    }
    dual_normalize(up);
    dual_cross(right, forward, up);
    dual_normalize(right);
    dual_cross(up, right, forward);
}

/// Returns half a pixel, in units of the axes; see plan/camera.c. axis: the plan's right or up.
static glint_dual find_size(const glint_plan *plan, const glint_camera_desc *desc, const glint_camera_desc *slope, const double axis[3])
{
    if (desc->fx > 0)
        return dual(sqrt(vec_dot(axis, axis)), 0);
    const double tangent = glint_tan(desc->fov_y_rad / 2);
    const glint_dual half = plan->camera.orthographic
                                ? dual(0.5 * desc->height, 0.5 * slope->height)
                                : dual(tangent, (1 + tangent * tangent) * (slope->fov_y_rad / 2));
    return dual_scale(half, 1.0 / plan->desc.height);
}

/// Returns one over the distance of the plane of focus; see find_focus in plan/lens.c.
static glint_dual find_nearness(const glint_camera_desc *desc, const glint_camera_desc *slope, const glint_dual eye[3],
                                const glint_dual forward[3])
{
    glint_dual to_focus[3], focus = dual(desc->focus, slope->focus);
    if (!(desc->focus > 0)) {
        duals(to_focus, desc->has_focus_point ? desc->focus_point : desc->at,
              desc->has_focus_point ? slope->focus_point : slope->at);
        for (int c = 0; c < 3; c++)
            to_focus[c] = dual_sub(to_focus[c], eye[c]);
        focus = dual_dot(to_focus, forward);
    }
    return dual_div(dual(1, 0), focus);
}

void glint_derivative_fill_view(glint_derivative_view *out, const glint_plan *plan, const glint_camera_desc *desc,
                                const glint_camera_desc *slope)
{
    const glint_dual wide = find_size(plan, desc, slope, plan->camera.right), high = find_size(plan, desc, slope, plan->camera.up);
    glint_dual eye[3], forward[3], up[3], right[3];
    duals(eye, desc->eye, slope->eye);
    duals(forward, desc->has_direction ? desc->direction : desc->at, desc->has_direction ? slope->direction : slope->at);
    for (int c = 0; c < 3 && !desc->has_direction; c++)
        forward[c] = dual_sub(forward[c], eye[c]);
    dual_normalize(forward);
    find_axes(plan, desc, slope, forward, right, up);
    put_slopes(out->eye, eye);
    put_slopes(out->forward, forward);
    for (int c = 0; c < 3; c++) {
        out->right[c] = dual_mul(right[c], wide).slope;
        out->up[c] = dual_mul(up[c], high).slope;
    }
    if (plan->lens) {
        put_slopes(out->lens[0], right);
        put_slopes(out->lens[1], up);
        out->wider = slope->aperture / desc->aperture;
        out->nearer = find_nearness(desc, slope, eye, forward).slope;
    }
    out->moves = glint_any_slope(out->eye) || glint_any_slope(out->forward) || glint_any_slope(out->right) ||
                 glint_any_slope(out->up) || out->wider != 0 || out->nearer != 0;
}
