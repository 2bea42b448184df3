/// The camera's lens: the points where samples cross it.
///
/// Sample k of the pixel in lane j of its group of 4 x 4 uses point j 2^b + k of one scrambled Sobol sequence, where
/// 2^b is the number of samples or the next power of two. So the points of a pixel are evenly spread over the lens,
/// and so are the points of all 16 pixels together. The order is scrambled as well, so that positions on the lens and
/// in the pixel are independent.
#include "engine/base/alloc.h"
#include "engine/base/math.h"
#include "engine/base/sequence.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/plan/plan.h"

#include <math.h>

#define PI 0x1.921fb54442d18p+1
#define BEND_MAX 1e12 ///< largest radius of the lens relative to its focus distance

/// Maps squares around the centre to circles, preserving areas (P. Shirley, K. Chiu, "A Low Distortion Map Between
/// Disk and Square", 1997): with a = 2 u - 1, b = 2 v - 1, the one with the larger magnitude is the radius.
static void round_point(const double square[2], double out[2])
{
    const double a = 2 * square[0] - 1, b = 2 * square[1] - 1;
    const bool across = fabs(a) > fabs(b);
    const double radius = across ? a : b;
    const double angle = radius == 0 ? 0 : across ? PI / 4 * (b / a) : PI / 2 - PI / 4 * (a / b);
    out[0] = radius * glint_cos(angle);
    out[1] = radius * glint_sin(angle);
}

/// Maps the square to a polygon: u selects a triangle between the centre and a side. The square root of the rest of u
/// goes from the centre to the side, v along the side.
static void polygon_point(const double square[2], uint32_t blades, double rotation, double out[2])
{
    const double position = square[0] * blades, side = fmin(floor(position), blades - 1.0);
    const double from = PI / 2 + rotation + 2 * PI * side / blades, to = from + 2 * PI / blades;
    const double radius = sqrt(fmin(position - side, 1));
    out[0] = radius * ((1 - square[1]) * glint_cos(from) + square[1] * glint_cos(to));
    out[1] = radius * ((1 - square[1]) * glint_sin(from) + square[1] * glint_sin(to));
}

void glint_lens_point(const double square[2], uint32_t blades, double rotation, double out[2])
{
    if (blades)
        polygon_point(square, blades, rotation, out);
    else
        round_point(square, out);
}

/// Computes the distance of the plane of focus along the view.
static glint_status find_focus(glint_plan_camera *camera, const glint_camera_desc *desc, glint_error *error)
{
    const double *point = desc->has_focus_point ? desc->focus_point : desc->at;
    double to_focus[3];
    camera->focus = desc->focus;
    if (desc->focus > 0)
        return GLINT_OK;
    if (!desc->has_focus_point && desc->has_direction)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "camera.focus: a camera with an aperture and a direction needs a focus: a number > 0, or {x, y, z}");
    vec_sub(to_focus, point, camera->eye);
    camera->focus = vec_dot(to_focus, camera->forward);
    if (camera->focus > 0 && isfinite(camera->focus))
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "camera.focus: a point in front of the eye expected, got {%.15g, %.15g, %.15g}",
                      point[0], point[1], point[2]);
}

/// Checks the fields of the lens.
static glint_status check_size(const glint_plan *plan, glint_error *error)
{
    const glint_plan_camera *camera = &plan->camera;
    double corner[3];
    if (!(camera->aperture <= BEND_MAX * camera->focus))
        return glint_fail(error, GLINT_ERR_INVALID, "camera.aperture: expected a number <= %.15g (%g times the focus), got %.15g",
                          BEND_MAX * camera->focus, BEND_MAX, camera->aperture);
    for (int c = 0; c < 3; c++)
        corner[c] = camera->eye[c] + (camera->eye[c] < 0 ? -camera->aperture : camera->aperture);
    return glint_geometry_check_reach(plan->geometry, "camera.aperture", corner, error);
}

static void fill_points(glint_plan *plan)
{
    const glint_plan_camera *camera = &plan->camera;
    const uint32_t samples = (uint32_t)plan->desc.samples, block = 1u << glint_sequence_bits(samples);
    const uint64_t seed = glint_sequence_mix((uint64_t)plan->desc.seed, 0x6c656e73); // a seed that only lenses use
    for (uint32_t k = 0; k < samples; k++)
        for (uint32_t lane = 0; lane < GLINT_GROUP; lane++) {
            double square[2], point[2];
            glint_sequence_scrambled(lane * block + k, seed, square);
            glint_lens_point(square, camera->blades, camera->blade_rotation, point);
            for (int j = 0; j < 2; j++)
                plan->lens[k].at[j][lane] = camera->aperture * point[j];
        }
}

glint_status glint_plan_find_lens(glint_plan *plan, const glint_camera_desc *desc, glint_error *error)
{
    glint_plan_camera *camera = &plan->camera;
    if (!(desc->aperture > 0))
        return GLINT_OK;
    camera->aperture = desc->aperture;
    camera->blades = (uint32_t)desc->blades;
    camera->blade_rotation = desc->blade_rotation_rad;
    glint_status status = find_focus(camera, desc, error);
    if (!status)
        status = check_size(plan, error);
    if (status)
        return status;
    plan->lens = glint_alloc((size_t)plan->desc.samples, sizeof *plan->lens);
    if (!plan->lens)
        return glint_fail_nomem(error);
    fill_points(plan);
    return GLINT_OK;
}

void glint_plan_lens_at(const glint_plan *plan, uint32_t k, glint_lens *out)
{
    const glint_plan_camera *camera = &plan->camera;
    const glint_lens_points *points = &plan->lens[k];
    const double per_focus = 1 / camera->focus;
    double right[3], up[3];
    vec_normalize(right, camera->right);
    vec_normalize(up, camera->up);
    out->radius = camera->aperture;
    out->per_focus = per_focus;
    for (int c = 0; c < 3; c++)
        for (int lane = 0; lane < GLINT_GROUP; lane++) {
            out->shift[c][lane] = points->at[0][lane] * right[c] + points->at[1][lane] * up[c];
            out->bend[c][lane] = out->shift[c][lane] * per_focus;
        }
}
