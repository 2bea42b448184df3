// glint.colormap: a function from numbers to colours, inside and outside patterns.
#include "bindings/pattern/pattern.h"
#include "engine/glint_figures.h"

#include <math.h>
#include <stdio.h>

#define COLORMAP "glint.colormap" // the type of the userdata that own the textures
#define ENTRIES 256
#define MISSING_CODE 128 // red, green and blue of missing values: grey

const char *const glintL_colormaps[] = { "viridis", "magma", "cividis", "turbo", "coolwarm", NULL };
_Static_assert(sizeof glintL_colormaps / sizeof *glintL_colormaps == GLINT_COLORMAP_COUNT + 1, "a name each");

static const char TEXTURES; // address used as the registry key for the table of textures by colormap

// Makes a texture of one row from a table of sRGB colours. Between texels it interpolates linear light.
static glint_status make_texture(uint8_t rgb[ENTRIES][3], glint_texture **out, glint_error *error)
{
    glint_texture_desc desc = glint_texture_desc_default();
    desc.rgb = rgb[0];
    desc.width = ENTRIES;
    desc.height = 1;
    desc.wrap = GLINT_WRAP_CLAMP;
    return glint_texture_create(&desc, out, error);
}

static void push_new_texture(lua_State *L, uint8_t rgb[ENTRIES][3])
{
    glint_error error;
    glint_texture **texture = lua_newuserdatauv(L, sizeof(glint_texture *), 0);
    *texture = NULL;
    luaL_setmetatable(L, COLORMAP);
    glintL_check_status(L, "colormap", &error, make_texture(rgb, texture, &error));
}

static void push_texture(lua_State *L, glint_colormap which)
{
    uint8_t rgb[ENTRIES][3];
    glintL_push_table(L, &TEXTURES);
    if (lua_rawgeti(L, -1, (lua_Integer)which) == LUA_TNIL) {
        lua_pop(L, 1);
        for (int i = 0; i < ENTRIES; i++)
            for (int c = 0; c < 3; c++)
                rgb[i][c] = (uint8_t)(glint_colormap_table(which)[i] >> (16 - 8 * c));
        push_new_texture(L, rgb);
        lua_pushvalue(L, -1);
        lua_rawseti(L, -3, (lua_Integer)which);
    }
    lua_remove(L, -2);
}

// ---- Maps from a script ----

// Reads the colour on top as sRGB, 0 .. 1 each; pops it.
static void take_color(lua_State *L, const char *path, double out[3])
{
    glintL_read_color(L, -1, path, out);
    for (int c = 0; c < 3; c++)
        out[c] = glint_srgb_encode(out[c]);
    lua_pop(L, 1);
}

static void put_color(const double color[3], uint8_t out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = (uint8_t)(255 * color[c] + 0.5);
}

// Samples the function over 0 .. 1.
static void read_function(lua_State *L, int index, const char *what, uint8_t rgb[ENTRIES][3])
{
    char path[96];
    snprintf(path, sizeof path, "%.60s: the function's result", what);
    for (int i = 0; i < ENTRIES; i++) {
        double color[3];
        lua_pushvalue(L, index);
        lua_pushnumber(L, i / (ENTRIES - 1.0));
        lua_call(L, 1, 1);
        take_color(L, path, color);
        put_color(color, rgb[i]);
    }
}

// Interpolates sRGB values between two colours, like the maps of other programs.
void glintL_read_colors(lua_State *L, int index, const char *what, uint8_t rgb[ENTRIES][3])
{
    char path[96];
    index = lua_absindex(L, index);
    luaL_checkstack(L, 4, "colours");
    if (lua_isfunction(L, index)) {
        read_function(L, index, what, rgb);
        return;
    }
    const size_t count = glintL_check_list(L, index, what, false);
    if (count < 2)
        glintL_error(L, "%s: a list of at least two colours expected, got %d", what, (int)count);
    for (int i = 0; i < ENTRIES; i++) {
        const double at = (double)i * (double)(count - 1) / (ENTRIES - 1);
        const size_t first = at < (double)(count - 1) ? (size_t)at : count - 2;
        double a[3], b[3];
        snprintf(path, sizeof path, "%.60s[%zu]", what, first + 1);
        lua_rawgeti(L, index, (lua_Integer)first + 1);
        take_color(L, path, a);
        snprintf(path, sizeof path, "%.60s[%zu]", what, first + 2);
        lua_rawgeti(L, index, (lua_Integer)first + 2);
        take_color(L, path, b);
        for (int c = 0; c < 3; c++)
            a[c] += (b[c] - a[c]) * (at - (double)first);
        put_color(a, rgb[i]);
    }
}

static void push_own_texture(lua_State *L)
{
    uint8_t rgb[ENTRIES][3];
    glintL_read_colors(L, 1, "colormap", rgb);
    push_new_texture(L, rgb);
}

// ---- The function ----

static int close_texture(lua_State *L)
{
    glint_texture **texture = lua_touserdata(L, 1);
    glint_texture_release(*texture);
    *texture = NULL;
    return 0;
}

// Returns whether the argument is a missing value: NaN. Symbols of patterns are never missing.
static bool is_missing(lua_State *L)
{
    return lua_gettop(L) == 1 && lua_type(L, 1) == LUA_TNUMBER && isnan(lua_tonumber(L, 1));
}

// Returns the texture's coordinate u for a number.
static glintL_term place_of(lua_State *L, glintL_term share, double low, double high)
{
    if (lua_toboolean(L, lua_upvalueindex(4))) // low and high are logarithms already
        share = glintL_apply1(L, GLINT_OP_LOG2, share);
    if (low != 0)
        share = glintL_apply2(L, GLINT_OP_SUB, share, glintL_number_term(low));
    if (low != 0 || high != 1)
        share = glintL_apply2(L, GLINT_OP_DIV, share, glintL_number_term(high - low));
    return glintL_apply3(L, GLINT_OP_MULADD, share, glintL_number_term((ENTRIES - 1.0) / ENTRIES),
                         glintL_number_term(0.5 / ENTRIES));
}

// Returns the colours of all numbers of the array at 1, which has one column.
static int colors_of(lua_State *L, const glint_texture *texture, double low, double high)
{
    const glintL_array *a = glintL_to_array(L, 1);
    if (a->width != 1)
        return glintL_error(L, "colormap: array of one column expected, got %I columns", (LUAI_UACINT)a->width);
    const double *missing = glintL_to_vector(L, lua_upvalueindex(5));
    glintL_array *out = glintL_push_array(L, a->count, 3, false);
    glintL_term in[4] = { [1] = glintL_number_term(0.5) }, color[4];
    for (size_t i = 0; i < a->count; i++) {
        const double number = a->is_whole ? (double)a->wholes[i] : a->numbers[i];
        in[0] = place_of(L, glintL_number_term(number), low, high);
        glintL_apply_texture(L, texture, in, color);
        for (int c = 0; c < 3; c++)
            out->numbers[3 * i + (size_t)c] = isnan(number) ? missing[c] : color[c].number;
    }
    return 1;
}

// Returns the colour of a number. Upvalues: the texture, the ends of its range, whether it is logarithmic, and the
// colour of missing values. The ends of the range are at the centres of the first and last texel. Values beyond them
// get the colour of the nearer end.
static int color_of(lua_State *L)
{
    glint_texture *const *texture = lua_touserdata(L, lua_upvalueindex(1));
    const double low = lua_tonumber(L, lua_upvalueindex(2)), high = lua_tonumber(L, lua_upvalueindex(3));
    if (is_missing(L)) {
        lua_pushvalue(L, lua_upvalueindex(5));
        return 1;
    }
    if (glintL_to_array(L, 1))
        return colors_of(L, *texture, low, high);
    glintL_term in[4] = { [1] = glintL_number_term(0.5) }, out[4];
    if (lua_gettop(L) != 1)
        return glintL_error(L, "colormap: one number or symbol expected, got %d values", lua_gettop(L));
    in[0] = place_of(L, glintL_read_term(L, 1, "colormap"), low, high);
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

static bool read_scale(lua_State *L, double *low, double *high)
{
    static const char *const scales[] = { "linear", "log", NULL };
    static const glintL_field field = { .name = "scale", .type = GLINT_TYPE_CHOICE, .names = scales };
    unsigned scale = 0;
    if (!lua_isnoneornil(L, 4))
        glintL_read_field(L, 4, "colormap", &field, &scale);
    if (scale == 1 && !(*low > 0 && *high > 0))
        glintL_error(L, "colormap: low and high above 0 expected of a logarithmic scale, got %f and %f", *low, *high);
    if (scale == 1) {
        *low = glintL_apply1(L, GLINT_OP_LOG2, glintL_number_term(*low)).number;
        *high = glintL_apply1(L, GLINT_OP_LOG2, glintL_number_term(*high)).number;
    }
    return scale == 1;
}

static int new_colormap(lua_State *L)
{
    static const glintL_field field = { .name = "name", .type = GLINT_TYPE_CHOICE, .names = glintL_colormaps };
    unsigned which = 0;
    const double grey = glint_srgb_decode(MISSING_CODE / 255.0);
    double missing[3] = { grey, grey, grey };
    lua_settop(L, 5);
    if (!lua_isnil(L, 5))
        glintL_read_color(L, 5, "colormap.missing", missing);
    const bool is_own = lua_istable(L, 1) || lua_isfunction(L, 1);
    if (!is_own)
        glintL_read_field(L, 1, "colormap", &field, &which);
    double low = read_end(L, 2, "colormap.low", 0), high = read_end(L, 3, "colormap.high", 1);
    if (!(low != high && isfinite(high - low)))
        return glintL_error(L, "colormap.high: another number than low (%f) expected, got %f", low, high);
    const bool is_log = read_scale(L, &low, &high);
    if (is_own)
        push_own_texture(L);
    else
        push_texture(L, (glint_colormap)which);
    lua_pushnumber(L, low);
    lua_pushnumber(L, high);
    lua_pushboolean(L, is_log);
    glintL_push_vector(L, missing);
    lua_pushcclosure(L, color_of, 5);
    return 1;
}

void glintL_open_colormap(lua_State *L)
{
    luaL_newmetatable(L, COLORMAP);
    glintL_set_function(L, "__gc", close_texture);
    lua_pop(L, 1);
    glintL_set_function(L, "colormap", new_colormap);
}
