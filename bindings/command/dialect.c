// glint --dialect gr: runs scenes in the dialect of a course with the modules of scripts/lib that the command carries.
#include <string.h>

#include "bindings/command/cli.h"

static const unsigned char GR[] = {
#include "scripts/lib/gr.lua.h"
};
static const unsigned char CHECK[] = {
#include "scripts/lib/gr/check.lua.h"
};
static const unsigned char FILES[] = {
#include "scripts/lib/gr/files.lua.h"
};
static const unsigned char GENERATION[] = {
#include "scripts/lib/gr/generation.lua.h"
};
static const unsigned char LAMP[] = {
#include "scripts/lib/gr/lamp.lua.h"
};
static const unsigned char LAYERS[] = {
#include "scripts/lib/gr/layers.lua.h"
};
static const unsigned char LUA5[] = {
#include "scripts/lib/gr/lua5.lua.h"
};
static const unsigned char MESH[] = {
#include "scripts/lib/gr/mesh.lua.h"
};
static const unsigned char NORMAL_MAP[] = {
#include "scripts/lib/gr/normal_map.lua.h"
};
static const unsigned char OBJ[] = {
#include "scripts/lib/gr/obj.lua.h"
};
static const unsigned char OPERATIONS[] = {
#include "scripts/lib/gr/operations.lua.h"
};
static const unsigned char OPTIONS[] = {
#include "scripts/lib/gr/options.lua.h"
};
static const unsigned char PICTURE[] = {
#include "scripts/lib/gr/picture.lua.h"
};
static const unsigned char SURFACE[] = {
#include "scripts/lib/gr/surface.lua.h"
};

static const struct carried {
    const char *name, *source;
    const unsigned char *text;
    size_t size;
} modules[] = {
    { "gr", "@gr.lua", GR, sizeof GR },
    { "gr.check", "@gr/check.lua", CHECK, sizeof CHECK },
    { "gr.files", "@gr/files.lua", FILES, sizeof FILES },
    { "gr.generation", "@gr/generation.lua", GENERATION, sizeof GENERATION },
    { "gr.lamp", "@gr/lamp.lua", LAMP, sizeof LAMP },
    { "gr.layers", "@gr/layers.lua", LAYERS, sizeof LAYERS },
    { "gr.lua5", "@gr/lua5.lua", LUA5, sizeof LUA5 },
    { "gr.mesh", "@gr/mesh.lua", MESH, sizeof MESH },
    { "gr.normal_map", "@gr/normal_map.lua", NORMAL_MAP, sizeof NORMAL_MAP },
    { "gr.obj", "@gr/obj.lua", OBJ, sizeof OBJ },
    { "gr.operations", "@gr/operations.lua", OPERATIONS, sizeof OPERATIONS },
    { "gr.options", "@gr/options.lua", OPTIONS, sizeof OPTIONS },
    { "gr.picture", "@gr/picture.lua", PICTURE, sizeof PICTURE },
    { "gr.surface", "@gr/surface.lua", SURFACE, sizeof SURFACE },
};

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
    const struct carried *module = lua_touserdata(L, lua_upvalueindex(1));
    if (luaL_loadbufferx(L, (const char *)module->text, module->size, module->source, "t") != LUA_OK)
        return lua_error(L);
    strip(L);
    lua_pushvalue(L, 1);
    lua_call(L, 1, 1);
    return 1;
}

void cli_carry_dialect(lua_State *L)
{
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_PRELOAD_TABLE);
    for (size_t i = 0; i < sizeof modules / sizeof *modules; i++) {
        lua_pushlightuserdata(L, (void *)&modules[i]);
        lua_pushcclosure(L, load_module, 1);
        lua_setfield(L, -2, modules[i].name);
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
