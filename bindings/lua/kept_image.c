// The image that scene:render returns for an existing file. It is rendered only when the script first reads it.
//
// Most scripts never do, so that resuming a loop costs nothing. On the first access the userdata becomes an ordinary
// image: it is a glintL_box followed by a plan.
#include "bindings/lua/lua.h"

#define KEPT_IMAGE "glint.kept_image"

typedef struct kept_image {
    glintL_box box; // box of the image that the userdata becomes
    glint_plan *plan; // owned; a snapshot of the scene
} kept_image;

void glintL_push_kept_image(lua_State *L)
{
    luaL_checkstack(L, 4, "image");
    kept_image *kept = lua_newuserdatauv(L, sizeof *kept, 1);
    kept->box.object = NULL;
    kept->plan = NULL;
    luaL_setmetatable(L, KEPT_IMAGE);
}

void glintL_set_kept_plan(lua_State *L, int index, glint_plan *plan)
{
    kept_image *kept = lua_touserdata(L, index);
    kept->plan = plan;
}

static int close_kept(lua_State *L)
{
    kept_image *kept = luaL_checkudata(L, 1, KEPT_IMAGE);
    glint_plan *plan = kept->plan;
    kept->plan = NULL;
    glint_plan_destroy(plan);
    return 0;
}

// Renders the image, and turns the userdata at 1, which must be on top of the stack, into it.
static void become_image(lua_State *L)
{
    kept_image *kept = luaL_checkudata(L, 1, KEPT_IMAGE);
    glintL_run *run = glintL_get_run(L);
    glint_image *image = NULL;
    glint_error error;
    if (!kept->plan)
        glintL_error(L, "image is closed");
    if (!glintL_run_open(run, &error) || glint_render(run->renderer, kept->plan, &image, NULL, &error))
        glintL_error(L, "image: %s", error.message);
    glint_plan_destroy(kept->plan);
    kept->plan = NULL;
    kept->box.object = image;
    luaL_setmetatable(L, GLINTL_IMAGE); // the metamethods of the image release the userdata from now on
}

static int read_member(lua_State *L)
{
    lua_settop(L, 2);
    lua_pushvalue(L, 1);
    become_image(L);
    lua_settop(L, 2);
    lua_gettable(L, 1);
    return 1;
}

static int write_member(lua_State *L)
{
    lua_settop(L, 3);
    lua_pushvalue(L, 1);
    become_image(L);
    lua_settop(L, 3);
    lua_settable(L, 1);
    return 0;
}

void glintL_open_kept_image(lua_State *L)
{
    static const luaL_Reg meta[] = {
        { "__index", read_member },
        { "__newindex", write_member },
        { "__gc", close_kept },
        { "__close", close_kept },
        { NULL, NULL },
    };
    luaL_newmetatable(L, KEPT_IMAGE);
    luaL_setfuncs(L, meta, 0);
    glintL_set_flag(L, "__metatable", false);
    lua_pushliteral(L, GLINTL_IMAGE); // the type's name in messages
    lua_setfield(L, -2, "__name");
    lua_pop(L, 1);
}
