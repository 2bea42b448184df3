#include "engine/base/status.h"
#include "engine/render/scene/fields.h"
#include "engine/render/scene/objects.h"

#include <math.h>
#include <stdlib.h>

#define PI 0x1.921fb54442d18p+1
#define GLINT_BLADES_MAX 64
#define BLADES "0 or a whole number 3 .. 64"

// ---- The table of fields ----

typedef glint_camera_desc DESC;

static const char *const projections[] = { "perspective", "orthographic", NULL };

#define GIVEN(field) .set_offset = offsetof(DESC, field)
#define SLOPES .takes = GLINT_TAKES_VARIABLE
#define ANY .low = -DBL_MAX, .high = DBL_MAX, .expected = "finite number"
#define PIXELS .high = DBL_MAX, .expected = "pixels > 0"

const glint_object_field glint_camera_fields[] = {
    { GLINT_ROW(eye, VECTOR), .initial = { 0, 0, 10 }, SLOPES, .doc = "world units. No default: required without `matrix`" },
    { GLINT_ROW(at, VECTOR), .unset_offset = offsetof(DESC, has_direction), SLOPES,
      .doc = "a point to look at; different from `eye`. No default: give either `at` or `direction`; the last assignment counts" },
    { GLINT_ROW(direction, DIRECTION), GIVEN(has_direction), .initial = { 0, 0, -1 }, SLOPES,
      .doc = "a direction to look in; not zero. No default: nil while `at` is used" },
    { GLINT_ROW(up, DIRECTION), .initial = { 0, 1, 0 }, SLOPES,
      .doc = "not zero; if parallel to the view, replaced by the world axis least aligned with the view" },
    { .name = "matrix", .type = GLINT_TYPE_POSE, .parts = glint_camera_fields,
      .doc = "instead of eye, direction and up: R and t of OpenCV, 3 or 4 rows of four numbers. They map a world point "
             "to x right, y down, z away from the eye; R is a rotation" },
    { GLINT_NAMED("fov", fov_y_rad, ANGLE), .low = 4.9406564584124654e-324, .high = 0x1.921fb54442d17p+1,
      .expected = "angle between 0 and 180 degrees", .initial = { 40 * PI / 180 }, SLOPES,
      .doc = "vertical field of view of a perspective camera, degrees, between 0 and 180" },
    { GLINT_ROW(fx, NUMBER), PIXELS,
      .doc = "horizontal focal length in pixels, > 0, instead of `fov`; the last assignment counts. Default 0: from `fov`" },
    { GLINT_ROW(fy, NUMBER), PIXELS, .doc = "vertical focal length in pixels. Default 0: fx" },
    { GLINT_ROW(cx, NUMBER), GIVEN(has_cx), ANY,
      .doc = "column of the principal point, pixels from the left edge, where the first pixel's centre is at 0.5 "
             "(OpenCV's own count has it at 0: add 0.5). Default nil: the middle" },
    { GLINT_ROW(cy, NUMBER), GIVEN(has_cy), ANY,
      .doc = "row of the principal point, pixels from the upper edge. Default nil: the middle" },
    { GLINT_ROW(w, NUMBER), PIXELS,
      .doc = "width of the picture that fx, fy, cx and cy are for, pixels; for other sizes they are scaled. Default 0: never scaled" },
    { GLINT_ROW(h, NUMBER), PIXELS, .doc = "height of that picture; given together with `w`. Default 0" },
    { GLINT_ROW(projection, CHOICE), .names = projections, .doc = "an orthographic camera has a `height`" },
    { GLINT_ROW(height, NUMBER), GLINT_ABOVE_0, .initial = { 10 }, SLOPES,
      .doc = "vertical extent of an orthographic camera, world units, > 0" },
    { GLINT_ROW(pixel_offset, NUMBER), GLINT_SHARE, .initial = { 0.5 },
      .doc = "position of a single sample within its pixel, 0 .. 1. Default 0.5, the centre" },
    { GLINT_ROW(shutter, NUMBER), GLINT_SHARE,
      .doc = "time that the shutter is open, as a share of the time from one frame to the next, 0 .. 1. An animation's "
             "frame function is then called for several times around the frame's own, and the picture's light is their "
             "mean. Default 0, an instant" },
    { GLINT_ROW(shutter_times, WHOLE), .low = 1, .high = GLINT_SHUTTER_TIMES_MAX, .initial = { 8 },
      .doc = "number of times for `shutter`, 1 .. 1024" },
    { GLINT_ROW(aperture, NUMBER), GLINT_AT_LEAST_0, SLOPES,
      .doc = "radius of the lens, world units, >= 0. Default 0, a pinhole: everything is sharp" },
    { GLINT_ROW(focus, DISTANCE), SLOPES,
      .doc = "the plane in focus: its distance along the view, > 0, or a point on it in front of the eye. nil: `at`" },
    { GLINT_ROW(blades, WHOLE), .high = GLINT_BLADES_MAX, .expected = BLADES,
      .doc = "0: a round lens; 3 .. 64: a regular polygon inscribed in the lens's circle, with a corner at the top" },
    { GLINT_NAMED("blade_rotation", blade_rotation_rad, ANGLE), ANY,
      .doc = "turns the polygon, counter-clockwise as the eye sees it, degrees" },
    { GLINT_ROW(name, TEXT), .doc = "for messages, at most 63 bytes" },
    { .name = NULL },
};
_Static_assert(offsetof(DESC, has_focus_point) == offsetof(DESC, focus) + sizeof(double), "GLINT_TYPE_DISTANCE");

static glint_camera_desc defaults(void)
{
    glint_camera_desc desc = { .has_direction = false };
    glint_fields_reset(glint_camera_fields, &desc);
    return desc;
}

void glint_camera_desc_init(glint_camera_desc *desc, size_t size)
{
    const glint_camera_desc full = defaults();
    glint_desc_write(desc, size, &full, sizeof full);
}

// ---- Checks of several fields ----

static glint_status check_view(const glint_camera_desc *desc, glint_error *error)
{
    const double *at = desc->at, *eye = desc->eye;
    if (desc->has_direction)
        return GLINT_OK;
    if (at[0] == eye[0] && at[1] == eye[1] && at[2] == eye[2])
        return glint_fail(error, GLINT_ERR_INVALID,
                          "at: a point other than the eye expected, got {%.15g, %.15g, %.15g}", at[0], at[1], at[2]);
    if (!(isfinite(at[0] - eye[0]) && isfinite(at[1] - eye[1]) && isfinite(at[2] - eye[2])))
        return glint_fail(error, GLINT_ERR_INVALID, "at: a point within reach of the eye expected, got {%g, %g, %g}",
                          at[0], at[1], at[2]);
    return GLINT_OK;
}

/// Checks fx, fy, w and h.
static glint_status check_pixels(const glint_camera_desc *desc, glint_error *error)
{
    if (desc->fy > 0 && !(desc->fx > 0))
        return glint_fail(error, GLINT_ERR_INVALID, "fx: expected pixels > 0, because fy is set, got 0");
    if (desc->fx > 0 && desc->projection == GLINT_PROJECTION_ORTHOGRAPHIC)
        return glint_fail(error, GLINT_ERR_INVALID, "fx: a perspective camera expected; an orthographic one has a height");
    if ((desc->w > 0) != (desc->h > 0))
        return glint_fail(error, GLINT_ERR_INVALID, "w: w and h expected, got one of them");
    return GLINT_OK;
}

static glint_status check_lens(const glint_camera_desc *desc, glint_error *error)
{
    glint_status status = desc->has_focus_point ? glint_check_vector("focus", desc->focus_point, error) : GLINT_OK;
    if (!status && !(desc->focus >= 0 && isfinite(desc->focus)))
        status = glint_fail(error, GLINT_ERR_INVALID, "focus: number > 0 or {x, y, z} expected, got %.15g", desc->focus);
    if (!status && desc->has_focus_point && desc->focus > 0)
        status = glint_fail(error, GLINT_ERR_INVALID, "focus: a distance or a point expected, got both");
    if (!status && desc->blades > 0 && desc->blades < 3)
        status = glint_fail(error, GLINT_ERR_INVALID, "blades: " BLADES " expected, got %d", (int)desc->blades);
    return status;
}

static glint_status check(const glint_camera_desc *desc, glint_error *error)
{
    glint_status status = glint_fields_check(glint_camera_fields, desc, error);
    if (!status)
        status = check_view(desc, error);
    if (!status)
        status = check_pixels(desc, error);
    return status ? status : check_lens(desc, error);
}

// ---- The object ----

glint_status glint_camera_create(const glint_camera_desc *given, glint_camera **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_camera_desc, defaults());
    status = check(desc, error);
    if (status)
        return status;
    glint_camera *camera = malloc(sizeof *camera);
    if (!camera)
        return glint_fail_nomem(error);
    *camera = (glint_camera) { .references = 1, .desc = *desc };
    *out = camera;
    return GLINT_OK;
}

glint_status glint_camera_set(glint_camera *camera, const glint_camera_desc *given, glint_error *error)
{
    GLINT_REFUSE_NULL(camera, error);
    GLINT_TAKE_DESC(glint_camera_desc, defaults());
    status = check(desc, error);
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
