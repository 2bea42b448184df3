// --orbit YAW,PITCH[,ZOOM[,RIGHT,UP]]: a view turned by hand. The camera moves around the point at which it looks while
// a frame is planned. Scripts say with `orbit = true` that a page may turn the view.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/run.h"
#include "engine/glint_math.h"

#define ELEVATION_MAX 89.0 // degrees between the view and the plane perpendicular to `up`
#define DEGREE 0x1.1df46a2529d39p-6 // radians

typedef double vector[3];

static double dot(const vector a, const vector b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const vector a, const vector b, vector out)
{
    const vector c = { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
    memcpy(out, c, sizeof c);
}

static void scale(vector v, double by)
{
    for (int i = 0; i < 3; i++)
        v[i] *= by;
}

static void add(vector v, const vector w, double by)
{
    for (int i = 0; i < 3; i++)
        v[i] += by * w[i];
}

static double normalize(vector v)
{
    const double length = sqrt(dot(v, v));
    scale(v, 1 / length);
    return length;
}

// Turns a vector about a unit axis.
static void turn(vector v, const vector axis, double degrees)
{
    vector side;
    const double c = glint_cos(degrees * DEGREE), s = glint_sin(degrees * DEGREE), along = (1 - c) * dot(axis, v);
    cross(axis, v, side);
    scale(v, c);
    add(v, side, s);
    add(v, axis, along);
}

// ---- Text ----

bool glintL_orbit_read(const char *text, glintL_orbit *orbit)
{
    double read[5] = { 0, 0, 1, 0, 0 };
    const bool is_allowed = strcmp(text, "true") == 0;
    if (is_allowed || strcmp(text, "false") == 0) {
        orbit->is_allowed = is_allowed;
        return true;
    }
    int count = 0;
    for (const char *at = text;; at++) {
        char *end;
        read[count] = strtod(at, &end);
        if (end == at || !isfinite(read[count]) || (*end && *end != ','))
            return false;
        at = end;
        count++;
        if (!*at)
            break;
        if (count == 5)
            return false;
    }
    const bool is_good = count != 1 && count != 4 && read[2] >= 1e-3 && read[2] <= 1e3;
    if (is_good)
        *orbit = (glintL_orbit) { .is_allowed = orbit->is_allowed, .yaw = read[0], .pitch = read[1], .zoom = read[2],
                                  .right = read[3], .up = read[4] };
    return is_good;
}

static bool is_turned(const glintL_orbit *orbit)
{
    return orbit->zoom > 0 && (orbit->yaw != 0 || orbit->pitch != 0 || orbit->zoom != 1 || orbit->right != 0 || orbit->up != 0);
}

bool glintL_orbit_spell(const glintL_orbit *orbit, char out[96])
{
    snprintf(out, 96, "%.9g,%.9g,%.9g,%.9g,%.9g", orbit->yaw, orbit->pitch, orbit->zoom, orbit->right, orbit->up);
    return is_turned(orbit);
}

// ---- The camera ----

// Stores the point at which the camera looks. A camera with a direction looks at the point of its axis next to the
// middle of the scene.
static void find_target(const glint_scene *scene, const glint_camera_desc *camera, vector target)
{
    vector along = { camera->direction[0], camera->direction[1], camera->direction[2] }, middle;
    double radius, distance = 1;
    memcpy(target, camera->has_direction ? camera->eye : camera->at, sizeof(vector));
    if (!camera->has_direction)
        return;
    normalize(along);
    if (glintL_bound_scene(scene, middle, &radius)) {
        add(middle, camera->eye, -1);
        distance = fmax(dot(middle, along), 1e-3 * radius);
    }
    add(target, along, distance);
}

// Raises the unit vector from the target to the eye by `pitch` degrees, and stops near `up` and its opposite. right: unit.
static void lift(vector back, const vector right, const vector up, double pitch)
{
    vector level;
    const double top = glint_sin(ELEVATION_MAX * DEGREE), flat = glint_cos(ELEVATION_MAX * DEGREE);
    cross(right, up, level);
    pitch = fmin(fmax(pitch, -2 * ELEVATION_MAX), 2 * ELEVATION_MAX);
    turn(back, right, -pitch);
    if (fabs(dot(back, up)) <= top && dot(back, level) >= 0)
        return;
    memcpy(back, level, sizeof(vector));
    scale(back, flat);
    add(back, up, pitch > 0 ? top : -top);
}

// Turns a camera around its target.
static void turn_camera(const glint_scene *scene, const glintL_orbit *orbit, const glint_render_desc *desc,
                        glint_camera_desc *camera)
{
    vector target, back, right, up = { camera->up[0], camera->up[1], camera->up[2] }, above;
    double window[4];
    find_target(scene, camera, target);
    memcpy(back, camera->eye, sizeof back);
    add(back, target, -1);
    const double distance = normalize(back) / orbit->zoom;
    normalize(up);
    cross(up, back, right);
    if (dot(right, right) < 1e-12) // the camera looks along `up`, and the engine chooses another axis
        return;
    normalize(right);
    lift(back, right, up, orbit->pitch);
    turn(back, up, orbit->yaw);
    turn(right, up, orbit->yaw);
    cross(back, right, above);
    camera->height /= orbit->zoom;
    glint_camera_window(camera, desc->width, desc->height, window);
    const double height = (window[3] - window[2]) * (camera->projection == GLINT_PROJECTION_ORTHOGRAPHIC ? 1 : distance);
    add(target, right, -orbit->right * height);
    add(target, above, -orbit->up * height);
    memcpy(camera->at, target, sizeof camera->at);
    memcpy(camera->eye, target, sizeof camera->eye);
    add(camera->eye, back, distance);
    for (int i = 0; i < 3; i++)
        camera->direction[i] = -back[i];
}

bool glintL_orbit_begin(const glint_scene *scene, const glintL_orbit *orbit, const glint_render_desc *desc,
                        glint_camera_desc *before)
{
    glint_camera *camera = scene ? glint_scene_get(scene)->camera : NULL;
    glint_error error;
    if (!camera || !is_turned(orbit))
        return false;
    *before = *glint_camera_get(camera);
    before->struct_size = sizeof *before;
    glint_camera_desc turned = *before;
    turn_camera(scene, orbit, desc, &turned);
    return glint_camera_set(camera, &turned, &error) == GLINT_OK;
}

void glintL_orbit_end(const glint_scene *scene, const glint_camera_desc *before)
{
    glint_error error;
    glint_camera_set(glint_scene_get(scene)->camera, before, &error);
}

glint_status glintL_orbit_plan(const glint_scene *scene, const glintL_orbit *orbit, const glint_render_desc *desc,
                               glint_camera_desc *camera, glint_plan **out, glint_error *error)
{
    glint_camera_desc before;
    const bool has_begun = glintL_orbit_begin(scene, orbit, desc, &before);
    if (camera && scene && glint_scene_get(scene)->camera)
        *camera = *glint_camera_get(glint_scene_get(scene)->camera);
    const glint_status status = glint_plan_create(scene, desc, out, error);
    if (has_begun)
        glintL_orbit_end(scene, &before);
    return status;
}
