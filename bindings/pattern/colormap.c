// glint.colormap: a function that gives the colour of a number, within patterns and outside.
#include "bindings/pattern/pattern.h"

#include <math.h>

#define COLORMAP "glint.colormap" // the type of the userdata that hold the tables as textures
#define ENTRIES 256

const char *const glintL_colormaps[] = { "viridis", "magma", "cividis", "turbo", "coolwarm", NULL };
_Static_assert(sizeof glintL_colormaps / sizeof *glintL_colormaps == GLINT_COLORMAP_COUNT + 1, "a name each");

static const char TEXTURES; // its address is the registry's key of those that were made, by number

// A table as a picture of one row, between whose texels light is mixed.
static glint_status make_texture(glint_colormap which, glint_texture **out, glint_error *error)
{
    uint8_t rgb[ENTRIES][3];
    glint_texture_desc desc = glint_texture_desc_default();
    for (int i = 0; i < ENTRIES; i++)
        for (int c = 0; c < 3; c++)
            rgb[i][c] = (uint8_t)(glint_colormap_table(which)[i] >> (16 - 8 * c));
    desc.rgb = rgb[0];
    desc.width = ENTRIES;
    desc.height = 1;
    desc.wrap = GLINT_WRAP_CLAMP;
    return glint_texture_create(&desc, out, error);
}

static void push_texture(lua_State *L, glint_colormap which)
{
    glint_error error;
    glintL_push_table(L, &TEXTURES);
    if (lua_rawgeti(L, -1, (lua_Integer)which) == LUA_TNIL) {
        lua_pop(L, 1);
        glint_texture **texture = lua_newuserdatauv(L, sizeof(glint_texture *), 0);
        *texture = NULL;
        luaL_setmetatable(L, COLORMAP);
        glintL_check_status(L, "colormap", &error, make_texture(which, texture, &error));
        lua_pushvalue(L, -1);
        lua_rawseti(L, -3, (lua_Integer)which);
    }
    lua_remove(L, -2);
}

static int close_texture(lua_State *L)
{
    glint_texture **texture = lua_touserdata(L, 1);
    glint_texture_release(*texture);
    *texture = NULL;
    return 0;
}

// The function; its upvalues are the texture and the ends of its range. The middles of the first and the last texel are
// these ends, and beyond them is what is there.
static int color_of(lua_State *L)
{
    glint_texture *const *texture = lua_touserdata(L, lua_upvalueindex(1));
    const double low = lua_tonumber(L, lua_upvalueindex(2)), high = lua_tonumber(L, lua_upvalueindex(3));
    glintL_term in[3] = { [1] = glintL_number_term(0.5), [2] = glintL_number_term(0) }, out[4];
    if (lua_gettop(L) != 1)
        return glintL_error(L, "colormap: one number or symbol expected, got %d values", lua_gettop(L));
    glintL_term share = glintL_read_term(L, 1, "colormap");
    if (low != 0)
        share = glintL_apply2(L, GLINT_OP_SUB, share, glintL_number_term(low));
    if (low != 0 || high != 1)
        share = glintL_apply2(L, GLINT_OP_DIV, share, glintL_number_term(high - low));
    in[0] = glintL_apply3(L, GLINT_OP_MULADD, share, glintL_number_term((ENTRIES - 1.0) / ENTRIES),
                          glintL_number_term(0.5 / ENTRIES));
    glintL_apply_texture(L, *texture, in, out);
    glintL_push_triple(L, out);
    return 1;
}

static double read_end(lua_State *L, int index, const char *path, double otherwise)
{
    const double end = lua_isnoneornil(L, index) ? otherwise : glintL_read_number(L, index, path);
    if (!isfinite(end))
        glintL_error(L, "%s: finite number expected, got %f", path, end);
    return end;
}

static int new_colormap(lua_State *L)
{
    static const glintL_field field = { .name = "name", .kind = GLINTL_ENUM, .names = glintL_colormaps };
    unsigned which = 0;
    lua_settop(L, 3);
    glintL_read_field(L, 1, "colormap", &field, &which);
    const double low = read_end(L, 2, "colormap.low", 0), high = read_end(L, 3, "colormap.high", 1);
    if (!(low != high && isfinite(high - low)))
        return glintL_error(L, "colormap.high: another number than low (%f) expected, got %f", low, high);
    push_texture(L, (glint_colormap)which);
    lua_pushnumber(L, low);
    lua_pushnumber(L, high);
    lua_pushcclosure(L, color_of, 3);
    return 1;
}

void glintL_open_colormap(lua_State *L)
{
    luaL_newmetatable(L, COLORMAP);
    lua_pushcfunction(L, close_texture);
    lua_setfield(L, -2, "__gc");
    lua_pop(L, 1);
    lua_pushcfunction(L, new_colormap);
    lua_setfield(L, -2, "colormap");
}
