// A camera for a scene without one: it views all shapes from the front, a little from the right and from above. A chart
// without shapes needs only some camera, because it lies in the picture.
#include <math.h>

#include "bindings/run/run.h"
#include "engine/glint_figures.h"

#define FOV 35.0 // degrees
#define MARGIN 1.1

static void push_vector_field(lua_State *L, const char *name, const double v[3])
{
    glintL_push_vector(L, v);
    lua_setfield(L, -2, name);
}

// Returns whether a scene without shapes has a chart.
static bool is_chart(const glint_scene *scene)
{
    bool has_chart = false;
    for (size_t i = 0; i < glint_scene_overlay_count(scene); i++)
        has_chart = has_chart || glint_overlay_get(glint_scene_overlay_at(scene, i))->kind == GLINT_OVERLAY_CHART;
    return has_chart && !glint_scene_shape_count(scene);
}

// Sets the camera of the scene at `index`.
static void set_camera(lua_State *L, int index, const double eye[3], const double at[3])
{
    luaL_checkstack(L, 6, "camera");
    index = lua_absindex(L, index);
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    lua_getfield(L, -1, "glint");
    lua_getfield(L, -1, "camera");
    lua_createtable(L, 0, 3);
    push_vector_field(L, "eye", eye);
    push_vector_field(L, "at", at);
    glintL_set_number(L, "fov", FOV);
    lua_call(L, 1, 1);
    lua_setfield(L, index, "camera");
    lua_pop(L, 2);
}

void glintL_give_camera(lua_State *L, glintL_run *run, int index)
{
    static const double from[3] = { 0.3, 0.3, 0.9055385138137417 }; // unit
    const glint_scene *scene = glintL_test_object(L, index, GLINTL_SCENE);
    double center[3], eye[3], radius;
    if (!scene || glint_scene_get(scene)->camera)
        return;
    if (is_chart(scene)) {
        set_camera(L, index, (const double[]) { 0, 0, 1 }, (const double[]) { 0, 0, 0 });
        return;
    }
    if (!glintL_bound_scene(scene, center, &radius))
        return;
    const double distance = MARGIN * radius / glint_sin(FOV / 2 * 0x1.1df46a2529d39p-6);
    for (int i = 0; i < 3; i++)
        eye[i] = center[i] + distance * from[i];
    set_camera(L, index, eye, center);
    glintL_run_warn(run, "the scene has no camera; glint uses one that shows the whole scene: glint.camera { eye = { "
                         "%.4g, %.4g, %.4g }, at = { %.4g, %.4g, %.4g }, fov = %g }",
                    eye[0], eye[1], eye[2], center[0], center[1], center[2], FOV);
}

void glintL_give_cameras(lua_State *L, int list, glintL_run *run)
{
    luaL_checkstack(L, 4, "jobs");
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, list); i++) {
        lua_rawgeti(L, list, i);
        lua_getiuservalue(L, -1, GLINTL_JOB_SCENE);
        glintL_give_camera(L, run, -1);
        lua_pop(L, 2);
    }
}
