// glint --dialect gr: runs scenes in the dialect of a course with the modules of scripts/lib that the command carries.
#include <string.h>

#include "bindings/command/cli.h"
#include "bindings/run/carried.h"

#include "bindings/command/dialect.h" // LIBRARY

static int load_module(lua_State *L)
{
    glintL_load_stripped(L, lua_touserdata(L, lua_upvalueindex(1)));
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
