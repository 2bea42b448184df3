#include "engine/base/status.h"
#include "engine/scene/objects.h"

#include <math.h>
#include <stdlib.h>

#define PI 0x1.921fb54442d18p+1
#define GLINT_BLADES_MAX 64

glint_camera_desc glint_camera_desc_default(void)
{
    return (glint_camera_desc) { .projection = GLINT_PERSPECTIVE,
                                 .eye = { 0, 0, 10 },
                                 .up = { 0, 1, 0 },
                                 .direction = { 0, 0, -1 },
                                 .fov_y_rad = 40 * PI / 180,
                                 .height = 10,
                                 .pixel_offset = 0.5,
                                 .shutter_times = 8 };
}

static glint_status check_view(const glint_camera_desc *desc, glint_error *error)
{
    glint_status status = glint_check_vector("eye", desc->eye, error);
    if (status)
        return status;
    if (desc->has_direction)
        return glint_check_direction("direction", desc->direction, error);
    status = glint_check_vector("at", desc->at, error);
    const double *at = desc->at, *eye = desc->eye;
    if (!status && at[0] == eye[0] && at[1] == eye[1] && at[2] == eye[2])
        status = glint_fail(error, GLINT_ERR_INVALID,
                            "at: a point other than the eye expected, got {%.15g, %.15g, %.15g}", at[0], at[1], at[2]);
    if (!status && !(isfinite(at[0] - eye[0]) && isfinite(at[1] - eye[1]) && isfinite(at[2] - eye[2])))
        status = glint_fail(error, GLINT_ERR_INVALID, "at: a point within reach of the eye expected, got {%g, %g, %g}",
                            at[0], at[1], at[2]);
    return status;
}

/// Checks fx, fy, w and h.
static glint_status check_pixels(const glint_camera_desc *desc, glint_error *error)
{
    const double numbers[] = { desc->fx, desc->fy, desc->w, desc->h };
    static const char *const names[] = { "fx", "fy", "w", "h" };
    for (int i = 0; i < 4; i++)
        if (!(numbers[i] >= 0 && isfinite(numbers[i])))
            return glint_fail(error, GLINT_ERR_INVALID, "%s: pixels > 0 expected, got %.15g", names[i], numbers[i]);
    if (desc->fy > 0 && !(desc->fx > 0))
        return glint_fail(error, GLINT_ERR_INVALID, "fx: expected pixels > 0, because fy is set, got 0");
    if (desc->fx > 0 && desc->projection == GLINT_ORTHOGRAPHIC)
        return glint_fail(error, GLINT_ERR_INVALID, "fx: a perspective camera expected; an orthographic one has a height");
    if ((desc->w > 0) != (desc->h > 0))
        return glint_fail(error, GLINT_ERR_INVALID, "w: w and h expected, got one of them");
    if ((desc->has_cx && !isfinite(desc->cx)) || (desc->has_cy && !isfinite(desc->cy)))
        return glint_fail(error, GLINT_ERR_INVALID, "%s: finite number expected", isfinite(desc->cx) ? "cy" : "cx");
    return GLINT_OK;
}

static glint_status check_lens(const glint_camera_desc *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    if (!(desc->aperture >= 0 && isfinite(desc->aperture)))
        status = glint_fail(error, GLINT_ERR_INVALID, "aperture: number >= 0 expected, got %.15g", desc->aperture);
    if (!status && desc->has_focus_point)
        status = glint_check_vector("focus", desc->focus_point, error);
    if (!status && !(desc->focus >= 0 && isfinite(desc->focus)))
        status = glint_fail(error, GLINT_ERR_INVALID, "focus: number > 0 or {x, y, z} expected, got %.15g", desc->focus);
    if (!status && desc->has_focus_point && desc->focus > 0)
        status = glint_fail(error, GLINT_ERR_INVALID, "focus: a distance or a point expected, got both");
    if (!status && desc->blades != 0 &&
        !(desc->blades >= 3 && desc->blades <= GLINT_BLADES_MAX && desc->blades == floor(desc->blades)))
        status = glint_fail(error, GLINT_ERR_INVALID, "blades: 0 or a whole number 3 .. %d expected, got %.15g",
                            GLINT_BLADES_MAX, desc->blades);
    if (!status && !isfinite(desc->blade_rotation_rad))
        status = glint_fail(error, GLINT_ERR_INVALID, "blade_rotation: finite number expected, got %.15g",
                            desc->blade_rotation_rad * 180 / PI);
    return status;
}

static glint_status check(const glint_camera_desc *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    if (desc->projection > GLINT_ORTHOGRAPHIC)
        status = glint_fail(error, GLINT_ERR_INVALID, "projection: no such projection");
    if (!status)
        status = check_view(desc, error);
    if (!status)
        status = glint_check_direction("up", desc->up, error);
    if (!status && !(desc->fov_y_rad > 0 && desc->fov_y_rad < PI))
        status = glint_fail(error, GLINT_ERR_INVALID, "fov: angle between 0 and 180 degrees expected, got %.15g",
                            desc->fov_y_rad * 180 / PI);
    if (!status && !(desc->height > 0 && isfinite(desc->height)))
        status = glint_fail(error, GLINT_ERR_INVALID, "height: number > 0 expected, got %.15g", desc->height);
    if (!status)
        status = check_pixels(desc, error);
    if (!status)
        status = glint_check_range("pixel_offset", desc->pixel_offset, 0, 1, "number 0 .. 1", error);
    if (!status)
        status = glint_check_range("shutter", desc->shutter, 0, 1, "number 0 .. 1", error);
    if (!status)
        status = glint_check_whole("shutter_times", desc->shutter_times, 1, GLINT_SHUTTER_TIMES_MAX, error);
    if (!status)
        status = check_lens(desc, error);
    return status;
}

glint_status glint_camera_create(const glint_camera_desc *desc, glint_camera **out, glint_error *error)
{
    GLINT_REFUSE_NULL(desc, error);
    GLINT_REFUSE_NULL(out, error);
    glint_status status = check(desc, error);
    if (status)
        return status;
    glint_camera *camera = malloc(sizeof *camera);
    if (!camera)
        return glint_fail_nomem(error);
    *camera = (glint_camera) { .references = 1, .desc = *desc };
    *out = camera;
    return GLINT_OK;
}

glint_status glint_camera_set(glint_camera *camera, const glint_camera_desc *desc, glint_error *error)
{
    GLINT_REFUSE_NULL(camera, error);
    GLINT_REFUSE_NULL(desc, error);
    glint_status status = check(desc, error);
    if (!status)
        camera->desc = *desc;
    return status;
}

const glint_camera_desc *glint_camera_get(const glint_camera *camera) { return camera ? &camera->desc : NULL; }

glint_camera *glint_camera_retain(glint_camera *camera)
{
    if (camera)
        camera->references++;
    return camera;
}

void glint_camera_release(glint_camera *camera)
{
    if (camera && --camera->references == 0)
        free(camera);
}
