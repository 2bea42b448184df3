// The fields of glint.colorbar and glint.axes.
#include <string.h>

#include "bindings/lua/overlay.h"

static void read_ticks(lua_State *L, int index, const char *path, void *desc)
{
    desc_type *d = desc;
    d->tick_count = 0;
    if (lua_isnil(L, index))
        return;
    if (!lua_istable(L, index))
        glintL_refuse(L, index, path, "list of numbers");
    const size_t count = glintL_check_list(L, index, path, false);
    if (count < 1 || count > GLINT_OVERLAY_TICKS_MAX)
        glintL_error(L, "%s: 1 .. %d numbers expected, got %d", path, GLINT_OVERLAY_TICKS_MAX, (int)count);
    luaL_checkstack(L, 1, "ticks");
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        d->ticks[i] = glintL_read_number(L, -1, path);
        lua_pop(L, 1);
    }
    d->tick_count = count;
}

static void push_ticks(lua_State *L, const void *desc)
{
    const desc_type *d = desc;
    if (d->tick_count == 0) {
        lua_pushnil(L);
        return;
    }
    lua_createtable(L, (int)d->tick_count, 0);
    for (size_t i = 0; i < d->tick_count; i++) {
        lua_pushnumber(L, d->ticks[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    glintL_freeze(L, "ticks");
}

static void read_names(lua_State *L, int index, const char *path, void *desc)
{
    if (!lua_istable(L, index) || lua_rawlen(L, index) != 3)
        glintL_refuse(L, index, path, "list of three strings");
    glintL_check_list(L, index, path, false);
    luaL_checkstack(L, 1, "names");
    for (int i = 0; i < 3; i++) {
        lua_rawgeti(L, index, i + 1);
        glintL_overlay_copy_text(L, lua_gettop(L), path, ((desc_type *)desc)->names[i], GLINT_AXIS_NAME_SIZE);
        lua_pop(L, 1);
    }
}

static void push_names(lua_State *L, const void *desc)
{
    lua_createtable(L, 3, 0);
    for (int i = 0; i < 3; i++) {
        lua_pushstring(L, ((const desc_type *)desc)->names[i]);
        lua_rawseti(L, -2, i + 1);
    }
    glintL_freeze(L, "labels");
}

// Reads {{x, y, z}, {x, y, z}}: the values at the lowest and the highest corner of a box.
static void read_corners(lua_State *L, int index, const char *path, double (*out)[3])
{
    if (!lua_istable(L, index) || lua_rawlen(L, index) != 2)
        glintL_refuse(L, index, path, "two corners {{x, y, z}, {x, y, z}}");
    glintL_check_list(L, index, path, false);
    luaL_checkstack(L, 2, "corners");
    for (int i = 0; i < 2; i++) {
        lua_rawgeti(L, index, i + 1);
        const char *corner = lua_pushfstring(L, "%s[%d]", path, i + 1);
        glintL_read_three(L, lua_gettop(L) - 1, corner, "{x, y, z}", out[i]);
        lua_pop(L, 2);
    }
}

static void push_corners(lua_State *L, const double (*corners)[3], const char *name)
{
    lua_createtable(L, 2, 0);
    for (int i = 0; i < 2; i++) {
        glintL_push_vector(L, corners[i]);
        lua_rawseti(L, -2, i + 1);
    }
    glintL_freeze(L, name);
}

// Reads three numbers from a field of the table at `index`; {0, 0, 0} if it has none.
static void read_side(lua_State *L, int index, const char *path, const char *name, double out[3])
{
    memset(out, 0, 3 * sizeof *out);
    luaL_checkstack(L, 2, "side");
    lua_pushstring(L, name);
    if (lua_rawget(L, index) != LUA_TNIL) {
        const char *whole = lua_pushfstring(L, "%s.%s", path, name);
        glintL_read_three(L, lua_gettop(L) - 1, whole, "{x, y, z}", out);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

static double read_tilt(lua_State *L, int index, const char *path, const char *name)
{
    lua_pushstring(L, name);
    const double tilt = lua_rawget(L, index) == LUA_TNIL ? 0 : glintL_read_number(L, -1, path);
    lua_pop(L, 1);
    return tilt;
}

static bool has_key(lua_State *L, int index, const char *name)
{
    if (!lua_istable(L, index))
        return false;
    luaL_checkstack(L, 1, "key");
    lua_pushstring(L, name);
    const bool has = lua_rawget(L, index) != LUA_TNIL;
    lua_pop(L, 1);
    return has;
}

// Reads a box in the form of glint.box and the atom readers: { low, size, xy, xz, yz }. An upright box gets two
// corners.
static void read_sized(lua_State *L, int index, const char *path, desc_type *d)
{
    double size[3];
    read_side(L, index, path, "low", d->box[0]);
    read_side(L, index, path, "size", size);
    const double xy = read_tilt(L, index, path, "xy"), xz = read_tilt(L, index, path, "xz"), yz = read_tilt(L, index, path, "yz");
    const double sides[3][3] = { { size[0], 0, 0 }, { xy, size[1], 0 }, { xz, yz, size[2] } };
    d->has_sides = xy != 0 || xz != 0 || yz != 0;
    memcpy(d->sides, sides, sizeof sides);
    for (int i = 0; i < 3; i++)
        d->box[1][i] = d->box[0][i] + size[i];
}

// Reads two corners, a box { low, size, ... } or a cell { origin, a, b, c }. The axes of a cell are called a, b and c
// unless labels say otherwise.
static void read_box(lua_State *L, int index, const char *path, void *desc)
{
    static const char *const usual[] = { "x", "y", "z" }, *const of_cell[] = { "a", "b", "c" };
    desc_type *d = desc;
    const bool had_sides = d->has_sides;
    d->has_sides = has_key(L, index, "a");
    if (d->has_sides) {
        read_side(L, index, path, "origin", d->box[0]);
        for (int i = 0; i < 3; i++)
            read_side(L, index, path, of_cell[i], d->sides[i]);
    } else if (has_key(L, index, "size")) {
        read_sized(L, index, path, d);
    } else {
        read_corners(L, index, path, d->box);
    }
    for (int i = 0; i < 3 && d->has_sides != had_sides; i++)
        if (strcmp(d->names[i], d->has_sides ? usual[i] : of_cell[i]) == 0)
            strcpy(d->names[i], d->has_sides ? of_cell[i] : usual[i]);
}

static void push_box(lua_State *L, const void *desc)
{
    static const char *const names[] = { "a", "b", "c" };
    const desc_type *d = desc;
    if (!d->has_sides) {
        push_corners(L, d->box, "box");
        return;
    }
    lua_createtable(L, 0, 4);
    glintL_push_vector(L, d->box[0]);
    lua_setfield(L, -2, "origin");
    for (int i = 0; i < 3; i++) {
        glintL_push_vector(L, d->sides[i]);
        lua_setfield(L, -2, names[i]);
    }
    glintL_freeze(L, "box");
}

static void read_values(lua_State *L, int index, const char *path, void *desc)
{
    read_corners(L, index, path, ((desc_type *)desc)->values);
}

static void push_values(lua_State *L, const void *desc) { push_corners(L, ((const desc_type *)desc)->values, "values"); }

static const char *const ORIENTATIONS[] = { "vertical", "horizontal", NULL };
#define HEX(color, shift) ("0123456789abcdef"[(color) >> (shift) & 15])

// Reads the name of a map, a list of colours or, only in the constructor, a function: calling the function for an
// existing bar might close the bar.
static void read_map(lua_State *L, int index, const char *path, void *desc)
{
    static const glintL_field name = { .name = "map", .type = GLINT_TYPE_CHOICE, .names = glintL_colormaps };
    desc_type *d = desc;
    uint8_t rgb[256][3];
    unsigned which;
    d->has_colors = lua_istable(L, index) || lua_isfunction(L, index);
    if (lua_isfunction(L, index) && !lua_istable(L, 1))
        glintL_error(L, "%s: the name of a map or a list of colours expected, got function; only glint.colorbar { "
                        "... } takes a function", path);
    if (!d->has_colors) {
        glintL_read_field(L, index, "colorbar", &name, &which);
        d->map = (glint_colormap)which;
        return;
    }
    glintL_read_colors(L, index, path, rgb);
    for (int i = 0; i < 256; i++)
        d->colors[i] = (uint32_t)rgb[i][0] << 16 | (uint32_t)rgb[i][1] << 8 | rgb[i][2];
}

static void push_map(lua_State *L, const void *desc)
{
    const desc_type *d = desc;
    if (!d->has_colors) {
        lua_pushstring(L, glintL_colormaps[d->map]);
        return;
    }
    lua_createtable(L, 256, 0);
    for (int i = 0; i < 256; i++) {
        lua_pushfstring(L, "#%c%c%c%c%c%c", HEX(d->colors[i], 20), HEX(d->colors[i], 16), HEX(d->colors[i], 12), HEX(d->colors[i], 8),
                        HEX(d->colors[i], 4), HEX(d->colors[i], 0));
        lua_rawseti(L, -2, i + 1);
    }
}

static void read_scale(lua_State *L, int index, const char *path, void *desc)
{
    (void)path;
    ((desc_type *)desc)->is_log = glintL_overlay_read_log(L, index, "colorbar", "scale");
}

static void push_scale(lua_State *L, const void *desc) { lua_pushstring(L, glintL_overlay_scales[((const desc_type *)desc)->is_log]); }

const glintL_field glintL_colorbar_fields[] = {
    { .name = "map", GLINTL_CUSTOM(read_map, push_map), .required = true },
    { .name = "low", .type = GLINT_TYPE_NUMBER, .offset = AT(low), .required = true },
    { .name = "high", .type = GLINT_TYPE_NUMBER, .offset = AT(high), .required = true },
    { .name = "title", GLINTL_CUSTOM(glintL_overlay_read_text, glintL_overlay_push_text) },
    { .name = "ticks", GLINTL_CUSTOM(read_ticks, push_ticks) },
    { .name = "scale", GLINTL_CUSTOM(read_scale, push_scale) },
    { .name = "orientation", .type = GLINT_TYPE_CHOICE, .offset = AT(orientation), .names = ORIENTATIONS },
    LENGTH,
    EVERY_OVERLAY,
    { .name = NULL },
};

const glintL_field glintL_axes_fields[] = {
    { .name = "box", GLINTL_CUSTOM(read_box, push_box), .set_offset = AT(has_box) }, // sets default names of the axes
    { .name = "labels", GLINTL_CUSTOM(read_names, push_names) },
    { .name = "values", GLINTL_CUSTOM(read_values, push_values), .set_offset = AT(has_values) },
    LENGTH,
    EVERY_OVERLAY,
    { .name = NULL },
};
