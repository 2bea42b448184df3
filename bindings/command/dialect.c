// glint --dialect gr: runs scenes in the dialect of a course with the modules of scripts/lib that the command carries.
#include <string.h>

#include "bindings/command/cli.h"

typedef struct module { // a carried Lua module
    const char *name;
    const unsigned char *text;
    size_t size;
} module;

#include "bindings/command/dialect.h" // LIBRARY

typedef struct code_buffer {
    luaL_Buffer buffer;
    bool begun; // luaL_buffinit was called: at the first write, as lua_dump needs the function on top until then
} code_buffer;

static int add_code(lua_State *L, const void *bytes, size_t size, void *context)
{
    code_buffer *code = context;
    if (!code->begun)
        luaL_buffinit(L, &code->buffer);
    code->begun = true;
    luaL_addlstring(&code->buffer, bytes, size);
    return 0;
}

// Removes line numbers from the module, so that errors and warnings name the nearest line of the scene.
static void strip(lua_State *L)
{
    code_buffer code = { .begun = false };
    size_t size;
    if (lua_dump(L, add_code, &code, true))
        luaL_error(L, "out of memory");
    luaL_pushresult(&code.buffer);
    const char *bytes = lua_tolstring(L, -1, &size);
    if (luaL_loadbufferx(L, bytes, size, "=gr", "b") != LUA_OK)
        lua_error(L);
}

static int load_module(lua_State *L)
{
    const module *which = lua_touserdata(L, lua_upvalueindex(1));
    if (luaL_loadbufferx(L, (const char *)which->text, which->size, which->name, "t") != LUA_OK)
        return lua_error(L);
    strip(L);
    lua_pushvalue(L, 1);
    lua_call(L, 1, 1);
    return 1;
}

void cli_carry_dialect(lua_State *L)
{
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_PRELOAD_TABLE);
    for (size_t i = 0; i < sizeof LIBRARY / sizeof *LIBRARY; i++) {
        lua_pushlightuserdata(L, (void *)&LIBRARY[i]);
        lua_pushcclosure(L, load_module, 1);
        lua_setfield(L, -2, LIBRARY[i].name);
    }
    lua_pop(L, 1);
}

static int set_option(lua_State *L)
{
    lua_settable(L, 1);
    return 0;
}

// Sets an option of the module whose options are on top of the stack. The module's error becomes the option's error.
static void pass_option(lua_State *L, const char *name, const char *text)
{
    if (!text)
        return;
    lua_pushcfunction(L, set_option);
    lua_pushvalue(L, -2);
    lua_pushstring(L, name);
    lua_pushstring(L, text);
    if (lua_pcall(L, 3, 0, 0) == LUA_OK)
        return;
    luaL_gsub(L, lua_tostring(L, -1), "gr.options.", "--gr-");
    lua_error(L);
}

void cli_open_dialect(lua_State *L, const cli_options *options)
{
    if (!options->dialect)
        return;
    lua_getglobal(L, "require");
    lua_pushstring(L, options->dialect);
    lua_call(L, 1, 1);
    lua_pushvalue(L, -1);
    lua_setglobal(L, options->dialect);
    lua_getfield(L, -1, "options");
    for (int i = 0; i < CLI_DIALECT_OPTIONS; i++)
        pass_option(L, cli_dialect_options[i], options->dialect_text[i]);
    lua_settop(L, 0);
}

// ---- The options ----

const char *const cli_dialect_options[CLI_DIALECT_OPTIONS] = { "order", "pixel", "specular", "background", "plane",
                                                                "axis" };

bool cli_check_dialect(const cli_options *options, char message[GLINTL_MESSAGE_SIZE])
{
    for (int i = 0; i < CLI_DIALECT_OPTIONS && !options->dialect; i++)
        if (options->dialect_text[i])
            return glintL_complain(message, "--gr-%s: expected together with --dialect gr", cli_dialect_options[i]);
    if (options->dialect && options->untrusted_s > 0)
        return glintL_complain(message, "--dialect: cannot be combined with --untrusted, because scenes of the dialect "
                                        "use files, modules and libraries of Lua");
    return true;
}
