// The Lua modules of bindings/run, which work on a script's objects in the script's state, and functions for them.
#include <string.h>
#include <unistd.h>

#include "bindings/run/carried.h"

#include "bindings/run/modules.h" // LIBRARY

// Registry keys of two tables: the functions of Lua that the modules see, and the modules.
static const char STANDARD, OWN;

// ---- Values, and messages about them ----

// refuse(value, path, expected), raise(message), bad_key(key, path), no_such_field(path, name, near): raise errors at the line of the script.
static int refuse(lua_State *L) { return glintL_refuse(L, 1, luaL_checkstring(L, 2), luaL_checkstring(L, 3)); }

static int raise_message(lua_State *L) { return glintL_error(L, "%s", luaL_checkstring(L, 1)); }

static int bad_key(lua_State *L) { return glintL_bad_key(L, luaL_checkstring(L, 2), 1); }

static int no_such_field(lua_State *L)
{
    return glintL_no_such_field(L, luaL_checkstring(L, 1), luaL_checkstring(L, 2), lua_tostring(L, 3));
}

// check_list(table, path, allow_fields): returns the length of a list.
static int check_list(lua_State *L)
{
    lua_pushinteger(L, (lua_Integer)glintL_check_list(L, 1, luaL_checkstring(L, 2), lua_toboolean(L, 3)));
    return 1;
}

// read_number(path, value): returns the number as a float.
static int read_number(lua_State *L)
{
    lua_pushnumber(L, glintL_read_number(L, 2, luaL_checkstring(L, 1)));
    return 1;
}

static int is_vector(lua_State *L)
{
    lua_pushboolean(L, glintL_to_vector(L, 1) != NULL);
    return 1;
}

// vector(x, y, z)
static int vector(lua_State *L)
{
    const double v[] = { luaL_checknumber(L, 1), luaL_checknumber(L, 2), luaL_checknumber(L, 3) };
    glintL_push_vector(L, v);
    return 1;
}

// is_object(value): returns whether a value is an object of glint, and not a vector.
static int is_object(lua_State *L)
{
    lua_pushboolean(L, lua_isuserdata(L, 1) && !glintL_to_vector(L, 1) && luaL_getmetafield(L, 1, "__index") != LUA_TNIL);
    return 1;
}

// spell_number(value): returns a float as the shortest text that reads back as the same number; nil for other values.
static int spell_number(lua_State *L)
{
    char text[32];
    if (lua_type(L, 1) != LUA_TNUMBER || lua_isinteger(L, 1))
        return 0;
    glintL_format_number(text, lua_tonumber(L, 1));
    lua_pushstring(L, text);
    return 1;
}

// ---- The run ----

static int note(lua_State *L)
{
    glintL_run_note(glintL_get_run(L), "%s", luaL_checkstring(L, 1));
    return 0;
}

// fail_run(code, message)
static int fail_run(lua_State *L)
{
    glintL_run_fail(glintL_get_run(L), (int)luaL_checkinteger(L, 1), 0, "%s", luaL_checkstring(L, 2));
    return 0;
}

static int is_readable(lua_State *L)
{
    lua_pushboolean(L, access(luaL_checkstring(L, 1), R_OK) == 0);
    return 1;
}

// ---- Loading ----

void glintL_open_own(lua_State *L)
{
    static const char *const names[] = { "ipairs", "math",   "next",  "pairs",    "rawequal", "rawget", "rawlen",
                                         "select", "string", "table", "tonumber", "tostring", "type" };
    lua_createtable(L, 0, sizeof names / sizeof *names);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (lua_getglobal(L, names[i]) == LUA_TTABLE) { // copies the library, which the script can change
            lua_newtable(L);
            for (lua_pushnil(L); lua_next(L, -3); lua_rawset(L, -4)) {
                lua_pushvalue(L, -2);
                lua_insert(L, -2);
            }
            lua_remove(L, -2);
        }
        lua_setfield(L, -2, names[i]);
    }
    lua_rawsetp(L, LUA_REGISTRYINDEX, &STANDARD);
}

// Loads the module with this name. 1: the table of the modules, 2: the name.
static int load_module(lua_State *L)
{
    static const char folder[] = "bindings.run.";
    const char *name = luaL_checkstring(L, 2);
    size_t i = 0;
    while (strcmp(LIBRARY[i].name + sizeof folder - 1, name) != 0)
        if (++i == sizeof LIBRARY / sizeof *LIBRARY)
            return 0;
    glintL_load_stripped(L, &LIBRARY[i]);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &STANDARD);
    lua_setupvalue(L, -2, 1);
    lua_pushvalue(L, 1);
    lua_call(L, 1, 1);
    lua_pushvalue(L, -1);
    lua_setfield(L, 1, name);
    return 1;
}

// Pushes the table of the modules, which has the C functions as well.
static void push_own(lua_State *L)
{
    static const luaL_Reg tools[] = {
        { "refuse", refuse },         { "raise", raise_message },       { "bad_key", bad_key }, { "check_list", check_list },
        { "read_number", read_number }, { "is_object", is_object }, { "spell_number", spell_number }, { "fields", glintL_list_fields },
        { "no_such_field", no_such_field }, { "is_vector", is_vector }, { "vector", vector }, { "note", note },             { "fail_run", fail_run },     { "is_readable", is_readable },   { NULL, NULL },
    };
    luaL_checkstack(L, 8, "modules");
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &OWN) == LUA_TTABLE)
        return;
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &STANDARD) != LUA_TTABLE) // a state without scripts
        glintL_open_own(L);
    lua_pop(L, 2);
    luaL_newlib(L, tools);
    luaL_setfuncs(L, glintL_carried_functions, 0);
    glintL_set_text(L, "version", GLINT_VERSION);
    lua_createtable(L, 0, 1);
    glintL_set_function(L, "__index", load_module);
    lua_setmetatable(L, -2);
    lua_pushvalue(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &OWN);
}

void glintL_add_own(lua_State *L, const luaL_Reg *functions)
{
    push_own(L);
    luaL_setfuncs(L, functions, 0);
    lua_pop(L, 1);
}

void glintL_call_own(lua_State *L, const char *module, const char *function, int arguments, int results)
{
    push_own(L);
    lua_getfield(L, -1, module);
    lua_getfield(L, -1, function);
    lua_replace(L, -3);
    lua_pop(L, 1);
    lua_insert(L, -1 - arguments);
    lua_call(L, arguments, results);
}

// Calls the function whose module and name are the upvalues.
static int call_own(lua_State *L)
{
    glintL_call_own(L, lua_tostring(L, lua_upvalueindex(1)), lua_tostring(L, lua_upvalueindex(2)), lua_gettop(L), LUA_MULTRET);
    return lua_gettop(L);
}

void glintL_set_own_function(lua_State *L, const char *module, const char *function)
{
    lua_pushstring(L, module);
    lua_pushstring(L, function);
    lua_pushcclosure(L, call_own, 2);
    lua_setfield(L, -2, function);
}
