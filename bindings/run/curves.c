// The points of lobes, paths and frustums, computed before each frame from the state of the scene.
#include <math.h>
#include <string.h>

#include "bindings/run/run.h"
#include "engine/glint_figures.h"

#define SIDE 62 // points of a lobe on each side of its middle
#define HALF_TURN 1.5707963 // a little less than pi / 2: directions to the viewer stay above the surface
#define TALL 720.0 // height of the picture of a frustum, pixels, if its camera has none

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static double length_of(const double v[3]) { return sqrt(dot(v, v)); }

// Computes from + share * offset.
static void add_scaled(double out[3], const double from[3], double share, const double offset[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = from[c] + share * offset[c];
}

static void set_unit(double out[3], const double v[3])
{
    const double scale = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    double scaled[3];
    for (int c = 0; c < 3; c++)
        scaled[c] = v[c] / scale;
    const double length = length_of(scaled);
    for (int c = 0; c < 3; c++)
        out[c] = scaled[c] / length;
}

static void add_point(glint_overlay_desc *desc, const double point[3], unsigned flags)
{
    desc->point_flags[desc->point_count] = (uint8_t)flags;
    memcpy(desc->points[desc->point_count++], point, sizeof *desc->points);
}

// ---- Lobes ----

// Finds the normal of the surface at the lobe's point, on the side of the scene's camera. Casts a ray from a little
// above the point, away from the light.
static void find_normal(lua_State *L, const glint_scene *scene, const double light[3], glint_overlay_desc *desc)
{
    double origin[3], back[3] = { -light[0], -light[1], -light[2] };
    const double above = 1e-3 * fmax(length_of(desc->point), 1);
    glint_error error;
    glint_hit hit;
    bool hits = false;
    add_scaled(origin, desc->point, above, light);
    glintL_check_status(L, "lobe", &error, glint_scene_cast(scene, origin, back, &hits, &hit, &error));
    if (!hits || fabs(hit.t - above) > 1e-3 * above)
        glintL_error(L, "lobe.normal: {x, y, z} expected, because no surface is at the point {%f, %f, %f}", desc->point[0], desc->point[1],
                     desc->point[2]);
    const glint_camera *camera = glint_scene_get(scene)->camera;
    double view[3] = { hit.normal[0], hit.normal[1], hit.normal[2] };
    if (camera)
        add_scaled(view, glint_camera_get(camera)->eye, -1, desc->point);
    for (int c = 0; c < 3; c++)
        desc->from[c] = dot(hit.normal, view) < 0 ? -hit.normal[c] : hit.normal[c];
}

// Computes the unit direction in the lobe's plane that is perpendicular to the normal, on the side of the light. If the
// light is along the normal, the plane faces the scene's camera.
static void find_across(const glint_scene *scene, const double normal[3], const double light[3], const double point[3],
                        double out[3])
{
    const glint_camera *camera = glint_scene_get(scene)->camera;
    add_scaled(out, light, -dot(light, normal), normal);
    if (length_of(out) < 1e-9 && camera) {
        double view[3];
        add_scaled(view, glint_camera_get(camera)->eye, -1, point);
        for (int c = 0; c < 3; c++)
            out[c] = view[(c + 1) % 3] * normal[(c + 2) % 3] - view[(c + 2) % 3] * normal[(c + 1) % 3];
    }
    if (length_of(out) < 1e-9) { // any direction
        const double axis[3] = { fabs(normal[0]) < 0.9, fabs(normal[0]) >= 0.9, 0 };
        add_scaled(out, axis, -dot(axis, normal), normal);
    }
    set_unit(out, out);
}

// Adds the point of a lobe in the direction `angle`, from the normal towards `across`: as far away as the material, at
// index -1, reflects light in this direction.
static void add_lobe_point(lua_State *L, glintL_geometry *at, const double across[3], double angle, glint_overlay_desc *desc)
{
    glint_reflection light;
    glint_error error;
    double point[3];
    for (int c = 0; c < 3; c++)
        at->to_eye[c] = glint_cos(angle) * at->normal[c] + glint_sin(angle) * across[c];
    const glint_material *material = glintL_check_object(L, -1, GLINTL_MATERIAL);
    glintL_check_status(L, "lobe", &error, glintL_evaluate_material(material, at, &light, &error));
    const double mean = (light.specular[0] + light.specular[1] + light.specular[2]) / 3;
    add_scaled(point, desc->point, mean * (desc->has_radius ? desc->radius : 1), at->to_eye);
    add_point(desc, point, 0);
}

// Returns the angle in 0 .. pi / 2 whose cosine and sine have the ratio of these numbers, both >= 0. Uses the engine's
// sine and cosine, which have the same bits on every machine.
static double angle_of(double cosine, double sine)
{
    double low = 0, high = HALF_TURN;
    for (int i = 0; i < 60; i++) {
        const double middle = (low + high) / 2;
        const bool is_above = glint_sin(middle) * cosine < glint_cos(middle) * sine;
        low = is_above ? middle : low;
        high = is_above ? high : middle;
    }
    return low;
}

// Computes the points of a lobe, from one side of the normal to the other. The middle point is in the mirrored
// direction, and the points are densest there. The material is at index -1.
static void find_lobe(lua_State *L, const glint_scene *scene, glint_overlay_desc *desc)
{
    double light[3], across[3];
    glintL_geometry at;
    set_unit(light, desc->to);
    if (!desc->has_normal)
        find_normal(L, scene, light, desc);
    set_unit(at.normal, desc->from);
    memcpy(at.to_light, light, sizeof light);
    memcpy(at.p, desc->point, sizeof at.p);
    find_across(scene, at.normal, light, desc->point, across);
    if (!(dot(light, at.normal) > 0)) // the light is behind the surface
        return;
    const double mirrored = -angle_of(dot(light, at.normal), dot(light, across));
    add_point(desc, desc->point, GLINT_POINT_BEGINS);
    for (int i = -SIDE; i <= SIDE; i++) {
        const double share = (double)i / SIDE, end = i < 0 ? -HALF_TURN : HALF_TURN;
        add_lobe_point(L, &at, across, mirrored + share * share * (end - mirrored), desc);
    }
    add_point(desc, desc->point, 0);
}

// ---- Paths ----

static void find_path(lua_State *L, const glint_scene *scene, glint_overlay_desc *desc)
{
    glint_segment segments[GLINT_SEGMENTS_MAX];
    glint_error error;
    size_t count = 0;
    glintL_check_status(L, "path", &error,
                        glint_scene_path(scene, desc->from, desc->to, (uint32_t)desc->depth, segments, &count, &error));
    double first[3], reach = desc->radius;
    add_scaled(first, segments[0].to, -1, segments[0].from);
    if (!desc->has_radius)
        reach = segments[0].hit ? length_of(first) : length_of(desc->to);
    for (size_t i = 0; i < count; i++) {
        double end[3];
        add_scaled(end, segments[i].from, reach, segments[i].direction);
        add_point(desc, segments[i].from, GLINT_POINT_BEGINS);
        add_point(desc, segments[i].hit ? segments[i].to : end, segments[i].hit ? GLINT_POINT_MARKED : 0);
    }
}

// ---- Frustums ----

// Computes the edges of a camera's view: four lines to the corners of the picture, and the picture's outline. The lines
// begin at the eye or, for an orthographic camera, in the plane of the eye, where the outline is drawn as well.
static void find_frustum(const glint_camera_desc *camera, glint_overlay_desc *desc)
{
    const double height = camera->h > 0 ? camera->h : TALL, width = camera->w > 0 ? camera->w : desc->aspect * height;
    double distance = desc->radius, far[4][3], near[4][3], view[3];
    if (!desc->has_radius) {
        add_scaled(view, camera->at, -1, camera->eye);
        distance = camera->has_direction ? 1 : length_of(view);
    }
    for (int i = 0; i < 4; i++) {
        const double pixel[2] = { i == 1 || i == 2 ? width : 0, i > 1 ? height : 0 };
        glint_camera_point(camera, width, height, pixel, distance, far[i]);
        glint_camera_point(camera, width, height, pixel, 0, near[i]);
        add_point(desc, near[i], GLINT_POINT_BEGINS);
        add_point(desc, far[i], 0);
    }
    for (int i = 0; i <= 4; i++)
        add_point(desc, far[i % 4], i ? 0 : GLINT_POINT_BEGINS);
    for (int i = 0; i <= 4 && camera->projection == GLINT_PROJECTION_ORTHOGRAPHIC; i++)
        add_point(desc, near[i % 4], i ? 0 : GLINT_POINT_BEGINS);
}

// ---- All of a scene ----

// Pushes the object that the overlay at index -1 was made with; nil if it has none.
static void push_owner(lua_State *L, const char *name)
{
    if (!glintL_push_kept(L, -1, name))
        lua_pushnil(L);
}

// Computes the points of the overlay whose userdata is on top of the stack, and stores them.
static void update(lua_State *L, const glint_scene *scene)
{
    glint_overlay_desc desc = *glint_overlay_get(glintL_check_object(L, -1, GLINTL_OVERLAY));
    desc.struct_size = sizeof desc;
    glint_error error;
    desc.point_count = 0;
    if (desc.kind == GLINT_OVERLAY_LOBE) {
        push_owner(L, "material");
        glintL_trace_material(L, lua_gettop(L));
        find_lobe(L, scene, &desc);
    } else if (desc.kind == GLINT_OVERLAY_PATH) {
        push_owner(L, "scene");
        find_path(L, lua_isnil(L, -1) ? scene : glintL_check_object(L, -1, GLINTL_SCENE), &desc);
    } else {
        push_owner(L, "camera");
        find_frustum(glint_camera_get(glintL_check_object(L, -1, GLINTL_CAMERA)), &desc);
    }
    lua_pop(L, 1);
    if (!desc.has_normal) // the computed one is not the script's
        memcpy(desc.from, glint_overlay_get(glintL_check_object(L, -1, GLINTL_OVERLAY))->from, sizeof desc.from);
    glintL_check_status(L, "overlay", &error,
                        glint_overlay_set(glintL_check_object(L, -1, GLINTL_OVERLAY), &desc, &error));
}

void glintL_update_curves(lua_State *L, const glint_scene *scene)
{
    luaL_checkstack(L, 8, "overlays");
    for (size_t i = 0; i < glint_scene_overlay_count(scene); i++) {
        glint_overlay *overlay = glint_scene_overlay_at(scene, i);
        const glint_overlay_kind kind = glint_overlay_get(overlay)->kind;
        if (kind < GLINT_OVERLAY_LOBE || kind > GLINT_OVERLAY_FRUSTUM)
            continue;
        glintL_push_remembered(L, overlay);
        if (!lua_isnil(L, -1)) // otherwise the script has closed it: it keeps its points
            update(L, scene);
        lua_pop(L, 1);
    }
}
