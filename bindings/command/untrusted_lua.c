// The Lua of an untrusted script: an environment made from a list of names, in a state whose memory is counted.
#include "bindings/command/untrusted.h"

#include <lualib.h>
#include <stdlib.h>
#include <string.h>

#define INSTRUCTIONS 1000 // instructions between two checks for an interrupt

// ---- Memory ----

// Returns the bytes that malloc uses for a block: its size and a header, in steps of two words, at least four words.
static size_t taken(size_t size)
{
    const size_t word = sizeof(size_t), whole = (size + word + 2 * word - 1) & ~(2 * word - 1);
    return size == 0 ? 0 : whole > 4 * word ? whole : 4 * word;
}

static void *allocate(void *context, void *block, size_t old_size, size_t size)
{
    cli_lua_memory *memory = context;
    if (!block)
        old_size = 0; // for a new block Lua passes the kind of object here
    const size_t before = taken(old_size), after = taken(size);
    if (after > before && after - before > memory->most - memory->used)
        return NULL;
    void *grown = size ? realloc(block, size) : NULL;
    if (!size)
        free(block);
    if (grown || !size)
        memory->used += after - before;
    return grown;
}

lua_State *cli_untrusted_state(cli_lua_memory *memory)
{
    memory->used = 0;
    return lua_newstate(allocate, memory);
}

// ---- Time ----

// Raises after an interrupt. New coroutines inherit this hook. Once it has raised, each further instruction raises
// again, so that no pcall can continue.
static void look(lua_State *L, lua_Debug *where)
{
    (void)where;
    if (!glintL_get_run(L)->interrupted)
        return;
    lua_sethook(L, look, LUA_MASKCOUNT, 1);
    luaL_error(L, "interrupted");
}

// ---- Replacements of Lua's functions ----

// load(chunk, name, mode, env): accepts only text, whatever the mode. Lua's `load` is the upvalue.
static int load_text(lua_State *L)
{
    const bool has_env = lua_gettop(L) >= 4;
    lua_settop(L, 4);
    lua_pushliteral(L, "t");
    lua_replace(L, 3);
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    if (!has_env)
        lua_pop(L, 1);
    lua_call(L, has_env ? 4 : 3, LUA_MULTRET);
    return lua_gettop(L);
}

// Rejects __gc: a finalizer could run while no hook does.
static int set_metatable(lua_State *L)
{
    luaL_checktype(L, 1, LUA_TTABLE);
    luaL_argexpected(L, lua_isnoneornil(L, 2) || lua_istable(L, 2), 2, "nil or table");
    lua_settop(L, 2);
    if (lua_istable(L, 2)) {
        lua_pushliteral(L, "__gc");
        if (lua_rawget(L, 2) != LUA_TNIL)
            return luaL_error(L, "setmetatable: an untrusted script cannot have finalizers (__gc)");
        lua_settop(L, 2);
    }
    if (luaL_getmetafield(L, 1, "__metatable") != LUA_TNIL)
        return luaL_error(L, "cannot change a protected metatable");
    lua_setmetatable(L, 1);
    return 1;
}

// print(...) with control characters escaped.
static int print_escaped(lua_State *L)
{
    const int count = lua_gettop(L);
    for (int i = 1; i <= count; i++) {
        size_t size;
        const char *text = luaL_tolstring(L, i, &size);
        if (i > 1)
            fputc('\t', stdout);
        glintL_put_text(stdout, text, size);
        lua_pop(L, 1);
    }
    fputc('\n', stdout);
    fflush(stdout);
    return 0;
}

// `require "glint"` returns the upvalue.
static int require_glint(lua_State *L)
{
    const char *name = luaL_checkstring(L, 1);
    if (strcmp(name, "glint") != 0)
        return luaL_error(L, "module '%s' not found: an untrusted script can require only the module glint", name);
    lua_pushvalue(L, lua_upvalueindex(1));
    return 1;
}

// ---- The environment ----

static const char *const BASE_NAMES[] = { "assert", "error",    "getmetatable", "ipairs", "next",     "pairs",
                                          "pcall",  "print",    "rawequal",     "rawget", "rawlen",   "rawset",
                                          "select", "tonumber", "tostring",     "type",   "_VERSION", NULL };
static const char *const COROUTINE_NAMES[] = { "close",  "create", "isyieldable", "resume", "running",
                                               "status", "wrap",   "yield",       NULL };
static const char *const STRING_NAMES[] = { "byte",    "char",  "find",   "format", "gmatch",   "gsub",
                                            "len",     "lower", "match",  "pack",   "packsize", "rep",
                                            "reverse", "sub",   "unpack", "upper",  NULL };
static const char *const TABLE_NAMES[] = { "concat", "insert", "move", "pack", "remove", "sort", "unpack", NULL };
static const char *const OS_NAMES[] = { "clock", "date", "difftime", "time", NULL };
static const char *const MATH_NAMES[] = { "abs", "acos",       "asin", "atan",      "ceil", "cos",    "deg",
                                          "exp", "floor",      "fmod", "huge",      "log",  "max",    "maxinteger",
                                          "min", "mininteger", "modf", "pi",        "rad",  "random", "randomseed",
                                          "sin", "sqrt",       "tan",  "tointeger", "type", "ult",    NULL };
static const char *const UTF8_NAMES[] = { "char", "charpattern", "codepoint", "codes", "len", "offset", NULL };

typedef struct library {
    const char *name; // "": the globals
    lua_CFunction open;
    const char *const *names;
} library;

static const library LIBRARIES[] = {
    { "", luaopen_base, BASE_NAMES },
    { LUA_COLIBNAME, luaopen_coroutine, COROUTINE_NAMES },
    { LUA_STRLIBNAME, luaopen_string, STRING_NAMES },
    { LUA_TABLIBNAME, luaopen_table, TABLE_NAMES },
    { LUA_OSLIBNAME, luaopen_os, OS_NAMES },
    { LUA_MATHLIBNAME, luaopen_math, MATH_NAMES },
    { LUA_UTF8LIBNAME, luaopen_utf8, UTF8_NAMES },
};

// Copies the names of the table on top into the table at `to`.
static void copy_names(lua_State *L, const char *const *names, int to)
{
    for (; *names; names++) {
        lua_getfield(L, -1, *names);
        lua_setfield(L, to, *names);
    }
}

static void open_library(lua_State *L, const library *lib, int globals)
{
    lua_pushcfunction(L, lib->open);
    lua_pushstring(L, lib->name);
    lua_call(L, 1, 1);
    if (*lib->name) {
        lua_newtable(L);
        lua_insert(L, -2);
        copy_names(L, lib->names, lua_gettop(L) - 1);
        lua_pop(L, 1);
        lua_setfield(L, globals, lib->name);
    } else {
        copy_names(L, lib->names, globals);
        lua_getfield(L, -1, "load");
        lua_pushcclosure(L, load_text, 1);
        lua_setfield(L, globals, "load");
        lua_pop(L, 1);
    }
}

void cli_open_untrusted(lua_State *L, glintL_run *run)
{
    lua_settop(L, 0);
    glintL_attach_run(L, run);
    lua_newtable(L); // 1: the new globals
    for (size_t i = 0; i < sizeof LIBRARIES / sizeof *LIBRARIES; i++)
        open_library(L, &LIBRARIES[i], 1);
    lua_pushcfunction(L, luaopen_glint);
    lua_call(L, 0, 1);
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE); // only glint's functions reach it
    lua_pushvalue(L, -2);
    lua_setfield(L, -2, "glint");
    lua_getfield(L, 1, LUA_MATHLIBNAME);
    lua_setfield(L, -2, LUA_MATHLIBNAME);
    lua_pop(L, 1);
    lua_pushcclosure(L, require_glint, 1);
    lua_setfield(L, 1, "require");
    lua_pushcfunction(L, print_escaped);
    lua_setfield(L, 1, "print");
    lua_pushcfunction(L, set_metatable);
    lua_setfield(L, 1, "setmetatable");
    lua_pushvalue(L, 1);
    lua_setfield(L, 1, LUA_GNAME);
    // Strings have the methods of the reduced library, and their metatable cannot be reached.
    lua_pushliteral(L, "");
    lua_getmetatable(L, -1);
    lua_getfield(L, 1, LUA_STRLIBNAME);
    lua_setfield(L, -2, "__index");
    glintL_set_flag(L, "__metatable", false);
    lua_settop(L, 1);
    lua_rawseti(L, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
    glintL_open_own(L);
    lua_sethook(L, look, LUA_MASKCOUNT, INSTRUCTIONS);
}
