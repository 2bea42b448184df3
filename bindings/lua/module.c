// luaopen_glint: the module's table.
#include "bindings/run/system.h"
#include "bindings/value/glintL.h"

static int list_fields(lua_State *L)
{
    glintL_push_listed(L);
    return 1;
}

// _other_kind(path): "device", "pipe", "socket" or "folder" where it is one. For scripts/lib alone.
static int other_kind(lua_State *L)
{
    lua_pushstring(L, glintL_other_kind(luaL_checkstring(L, 1)));
    return 1;
}

__attribute__((visibility("default"))) int luaopen_glint(lua_State *L)
{
    static void (*const parts[])(lua_State *) = {
        glintL_open_vector,    glintL_open_material, glintL_open_light,     glintL_open_camera,
        glintL_open_transform, glintL_open_shape,    glintL_open_scene,     glintL_open_image,
        glintL_open_math,      glintL_open_params,   glintL_open_animation, glintL_open_patterns,
    };
    luaL_checkversion(L);
    glintL_open_run(L);
    glintL_set_tracing(L, &glintL_patterns);
    lua_newtable(L);
    lua_pushliteral(L, GLINT_VERSION);
    lua_setfield(L, -2, "version");
    lua_pushcfunction(L, list_fields); // for the test of meta/glint.lua alone
    lua_setfield(L, -2, "_fields");
    lua_pushcfunction(L, other_kind);
    lua_setfield(L, -2, "_other_kind");
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        parts[i](L);
    return 1;
}
