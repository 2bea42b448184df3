// glint.sweep: one frame for each combination of values on some axes.
//
//     glint.sweep { scene = s, size = { 640, 480 }, over = { { red, "shininess", { 1, 4, 16 } }, ... } }
//
// The first axis changes fastest; on a sheet it goes across.
#include <stdio.h>
#include <string.h>

#include "bindings/run/sheet.h"

#define AXES_MAX 16

// Checks one axis, { object, "field", { values } }, at `axis`; returns how many values it has.
static size_t check_axis(lua_State *L, int axis, const char *path)
{
    char full[64];
    if (!lua_istable(L, axis) || glintL_check_list(L, axis, path, false) != 3)
        glintL_refuse(L, axis, path, "{ object, \"field\", { values } }");
    int object = lua_gettop(L) + 1, field = object + 1, values = object + 2;
    lua_rawgeti(L, axis, 1);
    lua_rawgeti(L, axis, 2);
    lua_rawgeti(L, axis, 3);
    snprintf(full, sizeof full, "%s[1]", path);
    if (!lua_isuserdata(L, object) && !lua_istable(L, object))
        glintL_refuse(L, object, full, "object");
    snprintf(full, sizeof full, "%s[2]", path);
    if (lua_type(L, field) != LUA_TSTRING)
        glintL_refuse(L, field, full, "name of a field");
    lua_pushvalue(L, field);
    lua_gettable(L, object); // raises if there is no such field
    lua_pop(L, 1);
    snprintf(full, sizeof full, "%s[3]", path);
    if (!lua_istable(L, values))
        glintL_refuse(L, values, full, "list of values");
    size_t count = glintL_check_list(L, values, full, false);
    if (count == 0)
        glintL_error(L, "%s: at least one value expected, got an empty list", full);
    lua_settop(L, object - 1);
    return count;
}

// Pushes a copy of the axes at `axes`, which the script cannot change later.
void glintL_sweep_push_axes(lua_State *L, int axes)
{
    lua_newtable(L);
    int copy = lua_gettop(L);
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, axes); i++) {
        lua_rawgeti(L, axes, i);
        int axis = lua_gettop(L);
        lua_createtable(L, 3, 0);
        lua_rawgeti(L, axis, 1);
        lua_rawseti(L, axis + 1, 1);
        lua_rawgeti(L, axis, 2);
        lua_rawseti(L, axis + 1, 2);
        lua_rawgeti(L, axis, 3);
        lua_newtable(L);
        for (lua_Integer v = 1; v <= (lua_Integer)lua_rawlen(L, axis + 2); v++) {
            lua_rawgeti(L, axis + 2, v);
            lua_rawseti(L, axis + 3, v);
        }
        lua_rawseti(L, axis + 1, 3);
        lua_settop(L, axis + 1);
        lua_rawseti(L, copy, i);
        lua_settop(L, copy);
    }
}

static void read_axes(lua_State *L, int index, int job_index)
{
    glintL_job *job = lua_touserdata(L, job_index);
    char path[48];
    int64_t frames = 1;
    if (!lua_istable(L, index))
        glintL_refuse(L, index, "sweep.over", "list of axes");
    size_t axes = glintL_check_list(L, index, "sweep.over", false);
    if (axes == 0 || axes > AXES_MAX)
        glintL_error(L, "sweep.over: 1 .. %d axes expected, got %d", AXES_MAX, (int)axes);
    luaL_checkstack(L, 8, "sweep");
    for (size_t i = 1; i <= axes; i++) {
        snprintf(path, sizeof path, "sweep.over[%d]", (int)i);
        lua_rawgeti(L, index, (lua_Integer)i);
        frames *= (int64_t)check_axis(L, lua_gettop(L), path);
        lua_pop(L, 1);
        if (frames > GLINTL_FRAMES_MAX)
            glintL_error(L, "sweep.over: at most %d frames expected", GLINTL_FRAMES_MAX);
    }
    job->frames = frames;
    glintL_sweep_push_axes(L, index);
    lua_setiuservalue(L, job_index, GLINTL_JOB_FRAME);
}

static void read_size(lua_State *L, int index, glintL_job *job)
{
    static const char *const names[] = { "width", "height" };
    glintL_render read = job->render;
    if (!lua_istable(L, index) || glintL_check_list(L, index, "sweep.size", false) != 2)
        glintL_refuse(L, index, "sweep.size", "{ width, height }");
    for (int i = 0; i < 2; i++) {
        lua_rawgeti(L, index, i + 1);
        glintL_render_read(L, -1, "sweep.size: ", glintL_render_find(names[i]), &read);
        lua_pop(L, 1);
    }
    job->render = read;
}

void glintL_sweep_read(lua_State *L, int index, int job_index, const char *name)
{
    if (strcmp(name, "size") == 0) {
        read_size(L, index, lua_touserdata(L, job_index));
    } else if (strcmp(name, "over") == 0) {
        read_axes(L, index, job_index);
    } else {
        glintL_sweep_check_sheet(L, index);
        lua_pushvalue(L, index);
        lua_setiuservalue(L, job_index, GLINTL_JOB_SHEET);
    }
    glintL_sweep_check_together(L, job_index);
}

int glintL_new_sweep(lua_State *L)
{
    lua_settop(L, 1);
    glintL_push_job(L, GLINTL_JOB_SWEEP);
    glintL_job_read_table(L, 1, 2);
    if (lua_getiuservalue(L, 2, GLINTL_JOB_FRAME) == LUA_TNIL)
        glintL_refuse(L, -1, "sweep.over", "list of axes");
    lua_settop(L, 2);
    return 1;
}

// ---- One frame ----

// Saves the values of the fields before the first frame, in a table under the axes' list: { object, name, value }.
static void save(lua_State *L, int index, int axes)
{
    lua_Integer count = (lua_Integer)lua_rawlen(L, axes);
    lua_newtable(L);
    int saved = lua_gettop(L);
    for (lua_Integer i = 1; i <= count; i++) {
        int object = glintL_sweep_push_axis(L, axes, i);
        lua_pushvalue(L, object + 1);
        lua_gettable(L, object);
        lua_rawseti(L, saved, i);
        lua_settop(L, saved);
    }
    lua_setiuservalue(L, index, GLINTL_JOB_SAVED);
}

void glintL_sweep_build(lua_State *L, int index, int64_t n)
{
    int64_t rest = n - 1;
    luaL_checkstack(L, 12, "sweep");
    int top = lua_gettop(L);
    lua_getiuservalue(L, index, GLINTL_JOB_FRAME);
    int axes = lua_gettop(L);
    if (lua_getiuservalue(L, index, GLINTL_JOB_SAVED) == LUA_TNIL)
        save(L, index, axes);
    lua_settop(L, axes);
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, axes); i++) {
        int object = glintL_sweep_push_axis(L, axes, i);
        int64_t count = (int64_t)lua_rawlen(L, object + 2);
        lua_rawgeti(L, object + 2, rest % count + 1);
        glintL_set_field(L, object, lua_tostring(L, object + 1));
        rest /= count;
        lua_settop(L, axes);
    }
    glintL_sweep_push_position(L, index, n);
    lua_setiuservalue(L, index, GLINTL_JOB_PLACE);
    lua_settop(L, top);
}

void glintL_sweep_restore(lua_State *L, int index)
{
    luaL_checkstack(L, 12, "sweep");
    int top = lua_gettop(L);
    lua_getiuservalue(L, index, GLINTL_JOB_FRAME);
    if (lua_getiuservalue(L, index, GLINTL_JOB_SAVED) == LUA_TTABLE) {
        for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, top + 1); i++) {
            int object = glintL_sweep_push_axis(L, top + 1, i);
            if (lua_rawgeti(L, top + 2, i) != LUA_TNIL)
                glintL_set_field(L, object, lua_tostring(L, object + 1));
            lua_settop(L, top + 2);
        }
        lua_pushnil(L);
        lua_setiuservalue(L, index, GLINTL_JOB_SAVED);
    }
    lua_settop(L, top);
}
