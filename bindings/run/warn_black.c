// Explains why all pictures of a run are black. The first picture is examined once it is known to be black. A picture
// with light ends the search, so that other runs lose no time.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bindings/run/run.h"

#define RAYS_ACROSS 25 // rays across the picture that search for a hit
#define RAYS_DOWN 15

static bool is_dark(const double c[3]) { return !(c[0] > 0 || c[1] > 0 || c[2] > 0); }

static bool gives_light(const glint_light_desc *light)
{
    const double strength = light->has_radiance ? light->radiance : light->intensity;
    const bool colored = !is_dark(light->color) || (light->has_diffuse && !is_dark(light->diffuse)) ||
                         (light->has_specular && !is_dark(light->specular));
    return strength > 0 && (colored || !is_dark(light->ambient));
}

static bool any_light(const glint_scene *scene)
{
    for (size_t i = 0; i < glint_scene_light_count(scene); i++)
        if (gives_light(glint_light_get(glint_scene_light_at(scene, i))))
            return true;
    return !is_dark(glint_scene_get(scene)->ambient);
}

// ---- The camera's view ----

typedef struct view {
    const glint_scene *scene;
    const glint_camera_desc *camera;
    int width, height; // pixels
    double forward[3], right[3], up[3], window[4];
} view;

// Casts a ray at a point of the picture: -1 .. 1 to the right and upwards. False: no hit.
static bool cast(const view *v, double sx, double sy, glint_hit *hit)
{
    const double *window = v->window;
    const double x = window[0] + (sx + 1) / 2 * (window[1] - window[0]), y = window[2] + (sy + 1) / 2 * (window[3] - window[2]);
    const bool parallel = v->camera->projection != GLINT_PROJECTION_PERSPECTIVE;
    double origin[3], direction[3];
    bool is_hit = false;
    for (int c = 0; c < 3; c++) {
        const double aside = x * v->right[c] + y * v->up[c];
        origin[c] = v->camera->eye[c] + (parallel ? aside : 0);
        direction[c] = v->forward[c] + (parallel ? 0 : aside);
    }
    return !glint_scene_cast(v->scene, origin, direction, &is_hit, hit, NULL) && is_hit;
}

// Returns whether a ray through the centre of one of the 9 pixels around a point hits a shape.
static bool hits_near(const view *v, double sx, double sy)
{
    glint_hit found;
    const int column = (int)((sx + 1) / 2 * v->width), row = (int)((sy + 1) / 2 * v->height);
    for (int i = 0; i < 9; i++)
        if (cast(v, 2 * (column + i % 3 - 0.5) / v->width - 1, 2 * (row + i / 3 - 0.5) / v->height - 1, &found))
            return true;
    return false;
}

// Returns the hit of the ray nearest to the picture's centre, from a grid of rays. False: no ray hits.
// covers  whether a shape that a ray hits also covers the centre of a pixel.
static bool find_hit(const glint_scene *scene, const glint_camera_desc *camera, const glint_render_desc *desc, glint_hit *hit,
                     bool *covers)
{
    view v = { .scene = scene, .camera = camera, .width = desc->width, .height = desc->height };
    double best = HUGE_VAL;
    *covers = true;
    if (!glintL_view_axes(camera, v.forward, v.right, v.up))
        return true; // treated as a hit: not known
    *covers = false;
    glint_camera_window(camera, desc->width, desc->height, v.window);
    for (int i = 0; i < RAYS_ACROSS * RAYS_DOWN; i++) {
        const double sx = 2 * (i % RAYS_ACROSS + 0.5) / RAYS_ACROSS - 1, sy = 2 * (i / RAYS_ACROSS + 0.5) / RAYS_DOWN - 1;
        glint_hit found;
        if ((*covers && sx * sx + sy * sy >= best) || !cast(&v, sx, sy, &found))
            continue;
        *covers = *covers || hits_near(&v, sx, sy);
        if (sx * sx + sy * sy < best) {
            best = sx * sx + sy * sy;
            *hit = found;
        }
    }
    return best < HUGE_VAL;
}

// Returns whether the ray from the eye to the hit leaves a closed shape there.
static bool is_inside(const glint_camera_desc *camera, const glint_hit *hit)
{
    const glint_shape_kind kind = glint_shape_get(hit->shape)->kind;
    double out = 0;
    for (int c = 0; c < 3; c++)
        out += (hit->point[c] - camera->eye[c]) * hit->normal[c];
    return out > 0 && (kind == GLINT_SHAPE_SPHERE || kind == GLINT_SHAPE_SPHERES || kind == GLINT_SHAPE_BOX ||
                       kind == GLINT_SHAPE_CYLINDER || kind == GLINT_SHAPE_CONE || kind == GLINT_SHAPE_TORUS || kind == GLINT_SHAPE_CYLINDERS ||
                       kind >= GLINT_SHAPE_UNION);
}

// ---- The cause ----

static void explain(const glint_scene *scene, const glintL_work *work, char *out, size_t room)
{
    const glint_camera *camera = glint_scene_get(scene)->camera;
    glint_hit hit = { .shape = NULL };
    bool covers = true;
    if (work->stats.nonfinite > 0)
        snprintf(out, room, "%llu pixels are not finite; lights, reflectances or lengths are too large",
                 (unsigned long long)work->stats.nonfinite);
    else if (glint_scene_shape_count(scene) == 0)
        snprintf(out, room,
                 "the scene has no shape; add one, such as glint.sphere { center = { 0, 0, 0 }, radius = 1 }");
    else if (!any_light(scene))
        snprintf(
            out, room,
            glint_scene_light_count(scene)
                ? "no light of the scene is brighter than 0, and its ambient is 0; set intensity = 1, or ambient = 0.1"
                : "the scene has no light, and its ambient is 0; add glint.point_light { position = { 5, 9, 5 } }, or "
                  "ambient = 0.1");
    else if (!camera || (!find_hit(scene, glint_camera_get(camera), &work->render.desc, &hit, &covers) &&
                         !glintL_may_show(scene, glint_camera_get(camera), &work->render.desc)))
        snprintf(out, room, "the camera looks past all shapes; point its `at` at one of them, or move its eye back");
    else if (!covers)
        snprintf(out, room,
                 "the shapes in view are so small or thin that none covers the centre of a pixel; move the eye closer, or "
                 "render more pixels");
    else if (hit.shape && is_inside(glint_camera_get(camera), &hit))
        snprintf(out, room,
                 "the camera's eye is inside %s%s%s, which no light reaches; move the eye out, or move a light in",
                 *glint_shape_get(hit.shape)->name ? "'" : "a closed shape", glint_shape_get(hit.shape)->name,
                 *glint_shape_get(hit.shape)->name ? "'" : "");
    else if (!is_dark(glint_scene_get(scene)->ambient))
        snprintf(out, room, "no light leaves the visible surfaces: their materials reflect none of the scene's ambient light, and "
                            "the other lights are behind them, enclosed or blocked");
    else
        snprintf(out, room,
                 "no light reaches the visible surfaces: the lights are behind them, enclosed or blocked, or the "
                 "materials are black; set ambient = 0.1 to see the shapes");
}

void glintL_look_for_black(glintL_run *run, const glint_scene *scene, const glintL_work *work)
{
    if (run->has_light || run->is_dialect || !work->image || run->request.warnings == GLINTL_WARNINGS_NONE)
        return;
    if (!glint_image_is_black(work->image)) {
        run->has_light = true;
    } else if (!*run->black) {
        const int used =
            snprintf(run->black, sizeof run->black, "frame %lld: the picture is black: ", (long long)work->index);
        explain(scene, work, run->black + used, sizeof run->black - (size_t)used);
    }
}

void glintL_report_black(glintL_run *run)
{
    if (*run->black && !run->has_light && !run->told_of_view)
        glintL_run_warn(run, "%s", run->black);
}
