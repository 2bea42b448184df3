// luaopen_glint: the module's table.
#include <lualib.h>
#include <string.h>

#include "bindings/lua/lua.h"
#include "bindings/run/carried.h"
#include "bindings/run/system.h"

typedef struct members { // members of the module's table, which is at `index`
    lua_State *L;
    int index;
} members;

static bool has_member(const void *context, const char *name)
{
    const members *all = context;
    lua_pushstring(all->L, name);
    const bool found = lua_rawget(all->L, all->index) != LUA_TNIL;
    lua_pop(all->L, 1);
    return found;
}

// Returns the nearest name, and of equally near names the alphabetically first, because tables have no order.
static const char *nearest_member(lua_State *L, const char *name)
{
    const char *near = NULL;
    lua_pushnil(L);
    while (lua_next(L, 1)) {
        lua_pop(L, 1);
        const char *known = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "_"; // the table retains the string
        const bool is_near = *known != '_' && glintL_nearer(name, near, known) == known;
        if (is_near || (near && glintL_nearer(name, known, near) == known && strcmp(known, near) < 0))
            near = known;
    }
    return near ? near : glintL_meaning(name, has_member, &(members) { L, 1 });
}

// Returns whether `require "glint.<name>"` would find a module.
static bool is_module(lua_State *L, const char *name)
{
    bool found = false;
    if (lua_getfield(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE) == LUA_TTABLE &&
        lua_getfield(L, -1, LUA_LOADLIBNAME) == LUA_TTABLE && lua_getfield(L, -1, "searchpath") == LUA_TFUNCTION) {
        lua_pushfstring(L, "glint.%s", name);
        if (lua_getfield(L, -3, "path") == LUA_TSTRING && lua_pcall(L, 2, 1, 0) == LUA_OK)
            found = lua_isstring(L, -1);
    }
    lua_settop(L, 2);
    return found;
}

// Raises an error for an unknown member. 1: the module's table, 2: the name.
static int refuse_member(lua_State *L)
{
    lua_settop(L, 2);
    if (lua_type(L, 2) != LUA_TSTRING)
        return glintL_bad_key(L, "glint", 2);
    const char *name = lua_tostring(L, 2);
    if (is_module(L, name))
        return glintL_error(L, "glint.%s: this is a separate module; write local %s = require \"glint.%s\"", name, name, name);
    return glintL_no_such_field(L, "glint", name, nearest_member(L, name));
}

static int list_fields(lua_State *L)
{
    glintL_push_listed(L);
    return 1;
}

// _other_kind(path): returns "device", "pipe", "socket" or "folder" if the path is one. Only for scripts/lib.
static int other_kind(lua_State *L)
{
    lua_pushstring(L, glintL_other_kind(luaL_checkstring(L, 1)));
    return 1;
}

// _warn(message): gives a warning of the run, without a position. Only for scripts/lib.
static int warn(lua_State *L)
{
    glintL_run_warn(glintL_get_run(L), "%s", luaL_checkstring(L, 1));
    return 0;
}

// _output(): returns the value of -o, or nil. Only for scripts/.
static int output(lua_State *L)
{
    lua_pushstring(L, glintL_get_run(L)->request.render_text[glintL_render_find("output")]);
    return 1;
}

// _exposure(output): returns the stops that --exposure sets for a picture of this name; nil without --exposure, false in
// the run that finds the stops. Only for scripts/.
static int exposure(lua_State *L)
{
    const glintL_run *run = glintL_get_run(L);
    if (run->measures) {
        lua_pushboolean(L, false);
        return 1;
    }
    const glintL_folder_light *folder = glintL_find_folder(run, luaL_checkstring(L, 1));
    const char *text = folder && *folder->stops ? folder->stops : run->request.render_text[glintL_render_find("exposure")];
    lua_pushnil(L);
    if (text && !lua_stringtonumber(L, text))
        lua_pushnil(L);
    return 1;
}

// Methods of vectors.
static const luaL_Reg METHODS[] = {
    { "unpack", glintL_unpack },
    { "dot", glintL_dot },
    { "cross", glintL_cross },
    { "length", glintL_length },
    { "unit", glintL_unit },
    { "reflect", glintL_reflect },
    { NULL, NULL },
};

// What the values call of the layers above them.
static const glintL_tracing ABOVE = {
    .place = glintL_traced_position,
    .is_source = glintL_is_source,
    .refuse = glintL_refuse_within_trace,
    .keep = glintL_keep_source,
    .keep_all = glintL_keep_sources,
    .keep_closed = glintL_keep_closed,
    .methods = METHODS,
    .map_array = glintL_map_array,
    .frame_field = glintL_render_find,
};

__attribute__((visibility("default"))) int luaopen_glint(lua_State *L)
{
    static void (*const parts[])(lua_State *) = {
        glintL_open_vector,    glintL_open_array,    glintL_open_rows,      glintL_open_unpack,      glintL_open_material, glintL_open_light,     glintL_open_camera,
        glintL_open_transform, glintL_open_shape,    glintL_open_overlay, glintL_open_scene,     glintL_open_image,     glintL_open_picture,
        glintL_open_math,      glintL_open_variable,  glintL_open_params,   glintL_open_animation, glintL_open_patterns,
        glintL_open_texture,
    };
    luaL_checkversion(L);
    glintL_open_run(L);
    glintL_open_own(L);
    glintL_add_own(L, glintL_sheet_functions);
    glintL_add_own(L, glintL_sweep_functions);
    glintL_set_tracing(L, &ABOVE);
    lua_newtable(L);
    lua_pushliteral(L, GLINT_VERSION);
    lua_setfield(L, -2, "version");
    glintL_set_function(L, "_fields", list_fields); // only for the test of meta/glint.lua
    glintL_set_function(L, "_rows", glintL_list_rows); // only for that test, and for bindings/meta/fill.lua
    glintL_set_function(L, "_other_kind", other_kind);
    glintL_set_function(L, "_warn", warn);
    glintL_set_function(L, "_output", output);
    glintL_set_function(L, "_exposure", exposure);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        parts[i](L);
    glintL_set_own_function(L, "motion", "ease");
    glintL_set_own_function(L, "motion", "keys");
    lua_createtable(L, 0, 2);
    glintL_set_function(L, "__index", refuse_member);
    glintL_set_flag(L, "__metatable", false);
    lua_setmetatable(L, -2);
    return 1;
}
