// glint.sweep: one frame for each combination of values on some axes; sweep.lua and sweep_sheet.lua have its logic.
//
//     glint.sweep { scene = s, size = { 640, 480 }, over = { { red, "shininess", { 1, 4, 16 } }, ... } }
//
// The first axis changes fastest; on a sheet it goes across.
#include <string.h>

#include "bindings/run/carried.h"

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

static void read_axes(lua_State *L, int index, int job_index)
{
    glintL_job *job = lua_touserdata(L, job_index);
    lua_pushvalue(L, index);
    glintL_call_own(L, "sweep", "read_axes", 1, 2);
    job->frames = lua_tointeger(L, -1);
    lua_pop(L, 1);
    lua_setiuservalue(L, job_index, GLINTL_JOB_FRAME);
}

static void read_sheet(lua_State *L, int index, int job_index)
{
    lua_pushvalue(L, index);
    glintL_call_own(L, "sweep_sheet", "check_fields", 1, 0);
    lua_pushvalue(L, index);
    lua_setiuservalue(L, job_index, GLINTL_JOB_SHEET);
}

// Checks the sheet of the sweep at `index` against its axes, when both are set.
static void check_together(lua_State *L, int index)
{
    const glintL_job *job = lua_touserdata(L, index);
    const int top = lua_gettop(L);
    luaL_checkstack(L, 4, "sheet");
    if (lua_getiuservalue(L, index, GLINTL_JOB_SHEET) == LUA_TTABLE &&
        lua_getiuservalue(L, index, GLINTL_JOB_FRAME) != LUA_TNIL) {
        lua_pushinteger(L, job->frames);
        glintL_call_own(L, "sweep_sheet", "check", 3, 0);
    }
    lua_settop(L, top);
}

void glintL_sweep_read(lua_State *L, int index, int job_index, const char *name)
{
    luaL_checkstack(L, 4, "sweep");
    if (strcmp(name, "size") == 0)
        read_size(L, index, lua_touserdata(L, job_index));
    else if (strcmp(name, "over") == 0)
        read_axes(L, index, job_index);
    else
        read_sheet(L, index, job_index);
    check_together(L, job_index);
}

void glintL_sweep_build(lua_State *L, int index, int64_t n)
{
    luaL_checkstack(L, 4, "sweep");
    lua_getiuservalue(L, index, GLINTL_JOB_FRAME);
    lua_getiuservalue(L, index, GLINTL_JOB_SAVED);
    lua_pushinteger(L, n);
    glintL_call_own(L, "sweep", "set_axes", 3, 2);
    lua_setiuservalue(L, index, GLINTL_JOB_SAVED);
    lua_setiuservalue(L, index, GLINTL_JOB_PLACE);
    lua_getiuservalue(L, index, GLINTL_JOB_SHEET);
    glintL_call_own(L, "sweep_sheet", "list_names", 1, 1);
    lua_setiuservalue(L, index, GLINTL_JOB_NAMES);
}

void glintL_sweep_restore(lua_State *L, int index)
{
    luaL_checkstack(L, 4, "sweep");
    lua_getiuservalue(L, index, GLINTL_JOB_FRAME);
    if (lua_getiuservalue(L, index, GLINTL_JOB_SAVED) == LUA_TTABLE) {
        glintL_call_own(L, "sweep", "restore_axes", 2, 0);
        lua_pushnil(L);
        lua_setiuservalue(L, index, GLINTL_JOB_SAVED);
    } else {
        lua_pop(L, 2);
    }
}
