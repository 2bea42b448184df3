// Cures: hints that messages add for common mistakes.
#include <stdio.h>
#include <string.h>

#include "bindings/value/glintL.h"

#define NAME_SIZE 40

bool glintL_is_module(lua_State *L, int index)
{
    index = lua_absindex(L, index);
    luaL_checkstack(L, 3, "message");
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    lua_getfield(L, -1, "glint");
    const bool is = lua_istable(L, -1) && lua_rawequal(L, index, -1);
    lua_pop(L, 2);
    return is;
}

// Returns whether the table of the loaded module ("glint", "math") has a function of that name.
static bool has_function(lua_State *L, const char *module, const char *name)
{
    luaL_checkstack(L, 4, "message");
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    bool has = false;
    if (lua_getfield(L, -1, module) == LUA_TTABLE) {
        lua_pushstring(L, name);
        has = lua_rawget(L, -2) == LUA_TFUNCTION;
        lua_pop(L, 1);
    }
    lua_pop(L, 2);
    return has;
}

bool glintL_makes(lua_State *L, const char *name) { return has_function(L, "glint", name); }

// Returns how the script called the running C function; false: not by a name.
static bool find_call(lua_State *L, lua_Debug *call)
{
    return lua_getstack(L, 0, call) && lua_getinfo(L, "n", call) && call->name;
}

const char *glintL_push_dot_cure(lua_State *L, int index)
{
    lua_Debug call;
    if (index != 1 || !glintL_is_module(L, index) || !find_call(L, &call))
        return lua_pushliteral(L, "");
    return lua_pushfstring(L, "; write glint.%s with a dot, not with a colon", call.name);
}

const char *glintL_push_colon_cure(lua_State *L, int index)
{
    lua_Debug call;
    if (index != 1 || !find_call(L, &call) || strcmp(call.namewhat, "field") != 0)
        return lua_pushliteral(L, "");
    return lua_pushfstring(L, "; a method takes a colon: object:%s(...)", call.name);
}

const char *glintL_push_name_after(lua_State *L, const char *text, const char *before)
{
    const char *at = strstr(text, before);
    if (!at)
        return NULL;
    at += strlen(before);
    return lua_pushlstring(L, at, strcspn(at, "')"));
}

const char *glintL_push_lua_cure(lua_State *L, const char *text)
{
    luaL_checkstack(L, 6, "message");
    if (strstr(text, "attempt to perform arithmetic on a table value"))
        return lua_pushliteral(L, "; a table is not a vector: write glint.vector(0.8, 0.2, 0.2) * 0.5, not { 0.8, "
                                  "0.2, 0.2 } * 0.5");
    if (strstr(text, "attempt to perform arithmetic on a glint.pattern value"))
        return lua_pushliteral(L, "; a pattern is not a number: compute inside its function, "
                                  "glint.pattern(function(p, s) return 0.5 * ... end)");
    const char *name = glintL_push_name_after(L, text, "attempt to call a nil value (global '");
    if (!name)
        return NULL;
    if (has_function(L, "glint", name))
        return lua_pushfstring(L, "; is it glint.%s?", name);
    if (has_function(L, "math", name))
        return lua_pushfstring(L, "; is it math.%s?", name);
    return NULL;
}
