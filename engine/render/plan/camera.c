#include "engine/base/math.h"
#include "engine/base/sequence.h"
#include "engine/base/vec.h"
#include "engine/render/plan/plan.h"

#include <string.h>

/// Computes the axes of the view. If `up` is parallel to the view, the world axis least aligned with it replaces it.
static void view_axes(const glint_camera_desc *desc, double forward[3], double right[3], double up[3])
{
    if (desc->has_direction) {
        vec_normalize(forward, desc->direction);
    } else {
        vec_sub(forward, desc->at, desc->eye);
        vec_normalize(forward, forward);
    }
    double hint[3];
    vec_normalize(hint, desc->up);
    vec_cross(right, forward, hint);
    if (vec_dot(right, right) < 1e-24) {
        int least = 0;
        for (int c = 1; c < 3; c++)
            if (fabs(forward[c]) < fabs(forward[least]))
                least = c;
        double axis[3] = { least == 0, least == 1, least == 2 };
        vec_cross(right, forward, axis);
    }
    vec_normalize(right, right);
    vec_cross(up, right, forward);
}

/// Computes half the size of a pixel at distance 1, and the field `span` of glint_plan_camera.
static void find_pixels(const glint_camera_desc *desc, double width, double height, double half[2], double span[2])
{
    const double wide = desc->w > 0 ? width / desc->w : 1, high = desc->h > 0 ? height / desc->h : 1;
    const double half_height = desc->projection == GLINT_PROJECTION_ORTHOGRAPHIC ? 0.5 * desc->height : glint_tan_half(desc->fov_y_rad);
    half[0] = half[1] = half_height / height;
    if (desc->fx > 0) {
        half[0] = 0.5 / (wide * desc->fx);
        half[1] = 0.5 / (high * (desc->fy > 0 ? desc->fy : desc->fx));
    }
    span[0] = desc->has_cx ? 2 * (wide * desc->cx) : width;
    span[1] = desc->has_cy ? 2 * (high * desc->cy) : height;
}

void glint_camera_window(const glint_camera_desc *desc, double width, double height, double window[4])
{
    if (!desc || !window)
        return;
    double half[2], span[2];
    find_pixels(desc, width, height, half, span);
    window[0] = -span[0] * half[0];
    window[1] = (2 * width - span[0]) * half[0];
    window[2] = (span[1] - 2 * height) * half[1];
    window[3] = span[1] * half[1];
}

void glint_plan_camera_init(glint_plan_camera *out, const glint_camera_desc *desc, double width, double height)
{
    double right[3], up[3];
    *out = (glint_plan_camera) { .orthographic = desc->projection == GLINT_PROJECTION_ORTHOGRAPHIC,
                                 .pixel_offset = desc->pixel_offset };
    vec_copy(out->eye, desc->eye);
    view_axes(desc, out->forward, right, up);
    double half[2];
    find_pixels(desc, width, height, half, out->span);
    vec_scale(out->right, right, half[0]);
    vec_scale(out->up, up, half[1]);
}

glint_cover_camera glint_plan_cover_camera(const glint_plan_camera *camera)
{
    glint_cover_camera out = { .orthographic = camera->orthographic, .pixel_offset = camera->pixel_offset };
    memcpy(out.span, camera->span, sizeof out.span);
    vec_copy(out.eye, camera->eye);
    vec_copy(out.view[0], camera->right);
    vec_copy(out.view[1], camera->up);
    vec_copy(out.view[2], camera->forward);
    return out;
}

void glint_camera_point(const glint_camera_desc *desc, double width, double height, const double pixel[2], double distance,
                        double point[3])
{
    if (!desc || !pixel || !point)
        return;
    glint_plan_camera camera;
    glint_plan_camera_init(&camera, desc, width, height);
    const double shift = 0.5 - camera.pixel_offset, scale = camera.orthographic ? 1 : distance;
    const double right = (2 * (pixel[0] - shift) - camera.span[0]) * scale;
    const double up = (camera.span[1] - 2 * (pixel[1] - shift)) * scale;
    for (int c = 0; c < 3; c++)
        point[c] = camera.eye[c] + (distance * camera.forward[c] + (right * camera.right[c] + up * camera.up[c]));
}

bool glint_camera_project(const glint_camera_desc *desc, double width, double height, const double point[3], double pixel[2],
                          double *depth)
{
    if (!desc || !point || !pixel || !depth)
        return false;
    glint_plan_camera camera;
    glint_plan_camera_init(&camera, desc, width, height);
    const glint_cover_camera seen = glint_plan_cover_camera(&camera);
    double at[2], d[3];
    const double along = glint_cover_project(&seen, point, at);
    if (!(along > 0) || !isfinite(at[0]) || !isfinite(at[1]))
        return false;
    vec_sub(d, point, desc->eye);
    *depth = camera.orthographic ? along : sqrt(vec_dot(d, d));
    memcpy(pixel, at, sizeof at);
    return true;
}

void glint_plan_sample_offset(const glint_plan *plan, uint32_t k, double out[2])
{
    glint_sequence_point(k, glint_sequence_bits((uint32_t)plan->desc.samples), plan->desc.seed, out);
    for (int i = 0; i < 2; i++)
        out[i] = fmin(fmax(out[i] + (plan->camera.pixel_offset - 0.5), 0), 1);
}

void glint_plan_centre_offset(const glint_plan *plan, double out[2])
{
    out[0] = out[1] = plan->camera.pixel_offset;
}

bool glint_plan_casts_centres(const glint_plan *plan)
{
    double sample[2], centre[2];
    glint_plan_sample_offset(plan->base ? plan->base : plan, 0, sample);
    glint_plan_centre_offset(plan, centre);
    return !plan->is_base && (plan->lens || sample[0] != centre[0] || sample[1] != centre[1]);
}

bool glint_plan_compares_codes(const glint_render_desc *desc)
{
    return desc->alpha || desc->tone.curve != GLINT_TONE_CLAMP;
}

glint_tone_desc glint_plan_compared(const glint_render_desc *desc)
{
    glint_tone_desc tone = glint_tone_desc_default();
    tone.curve = desc->tone.curve;
    tone.exposure = desc->tone.exposure;
    tone.bits = 16;
    return tone;
}

glint_render_desc glint_plan_base(const glint_render_desc *desc)
{
    glint_render_desc base = *desc;
    base.samples = 1;
    base.outline = GLINT_OUTLINE_NONE;
    base.passes = desc->passes & ~(1u << GLINT_PASS_REFINED | 1u << GLINT_PASS_OUTLINE) & ((1u << GLINT_PASS_COUNT) - 1);
    base.passes |= 1u << GLINT_PASS_BEAUTY;
    if (glint_plan_compares_codes(desc)) {
        base.codes = true;
        base.tone = glint_plan_compared(desc);
    }
    return base;
}
