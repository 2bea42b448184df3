// glint.label, glint.colorbar, glint.axes, glint.arrow, glint.line, glint.arc, glint.polyline, glint.lobe, glint.path,
// glint.frustum, glint.chart
#include <string.h>

#include "bindings/lua/chart.h"

typedef glint_overlay_desc desc_type;

#define AT(member) offsetof(desc_type, member)

// ---- Special fields ----

static const char *const PLACES[3][3] = {
    { "top left", "top", "top right" }, { "left", "center", "right" }, { "bottom left", "bottom", "bottom right" }
};

static void read_pair(lua_State *L, int index, const char *path, const char *expected, double out[2])
{
    if (!lua_istable(L, index) || lua_rawlen(L, index) != 2)
        glintL_refuse(L, index, path, expected);
    glintL_check_list(L, index, path, false);
    luaL_checkstack(L, 1, "pair");
    for (int i = 0; i < 2; i++) {
        lua_rawgeti(L, index, i + 1);
        out[i] = glintL_read_number(L, -1, path);
        lua_pop(L, 1);
    }
}

static void push_pair(lua_State *L, const double pair[2], const char *name)
{
    lua_createtable(L, 2, 0);
    for (int i = 0; i < 2; i++) {
        lua_pushnumber(L, pair[i]);
        lua_rawseti(L, -2, i + 1);
    }
    glintL_freeze(L, name);
}

static void read_at(lua_State *L, int index, const char *path, void *desc)
{
    static const char expected[] = "\"top left\", \"top\", \"top right\", \"left\", \"center\", \"right\", \"bottom "
                                   "left\", \"bottom\", \"bottom right\" or {x, y} as fractions of the picture";
    desc_type *d = desc;
    if (lua_type(L, index) != LUA_TSTRING) {
        read_pair(L, index, path, expected, d->at);
        return;
    }
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 3; x++)
            if (strcmp(lua_tostring(L, index), PLACES[y][x]) == 0) {
                d->at[0] = x / 2.0;
                d->at[1] = y / 2.0;
                return;
            }
    glintL_refuse(L, index, path, expected);
}

static void push_at(lua_State *L, const void *desc)
{
    const desc_type *d = desc;
    const double x = 2 * d->at[0], y = 2 * d->at[1];
    if (d->has_position || d->has_point)
        lua_pushnil(L);
    else if (x == (int)x && y == (int)y)
        lua_pushstring(L, PLACES[(int)y][(int)x]);
    else
        push_pair(L, d->at, "at");
}

static void read_position(lua_State *L, int index, const char *path, void *desc)
{
    read_pair(L, index, path, "{x, y} in pixels", ((desc_type *)desc)->position);
}

static void push_position(lua_State *L, const void *desc) { push_pair(L, ((const desc_type *)desc)->position, "position"); }

static void copy_text(lua_State *L, int index, const char *path, char *out, size_t capacity)
{
    size_t length;
    if (lua_type(L, index) != LUA_TSTRING)
        glintL_refuse(L, index, path, "string");
    const char *text = lua_tolstring(L, index, &length);
    if (length >= capacity)
        glintL_error(L, "%s: at most %d bytes expected, got %d", path, (int)capacity - 1, (int)length);
    if (memchr(text, '\0', length))
        glintL_error(L, "%s: string without a zero byte expected", path);
    memset(out, 0, capacity);
    memcpy(out, text, length);
}

static void read_text(lua_State *L, int index, const char *path, void *desc)
{
    copy_text(L, index, path, ((desc_type *)desc)->text, GLINT_OVERLAY_TEXT_SIZE);
}

static void push_text(lua_State *L, const void *desc) { lua_pushstring(L, ((const desc_type *)desc)->text); }

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
        copy_text(L, lua_gettop(L), path, ((desc_type *)desc)->names[i], GLINT_AXIS_NAME_SIZE);
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

static void read_points(lua_State *L, int index, const char *path, void *desc)
{
    desc_type *d = desc;
    if (!lua_istable(L, index))
        glintL_refuse(L, index, path, "list of points");
    const size_t count = glintL_check_list(L, index, path, false);
    if (count < 2 || count > GLINT_OVERLAY_POINTS_MAX)
        glintL_error(L, "%s: 2 .. %d points expected, got %d", path, GLINT_OVERLAY_POINTS_MAX, (int)count);
    luaL_checkstack(L, 2, "points");
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        const char *element = lua_pushfstring(L, "%s[%d]", path, (int)i + 1);
        glintL_read_three(L, lua_gettop(L) - 1, element, "{x, y, z}", d->points[i]);
        lua_pop(L, 2);
    }
    d->point_count = count;
}

static void push_points(lua_State *L, const void *desc)
{
    const desc_type *d = desc;
    lua_createtable(L, (int)d->point_count, 0);
    for (size_t i = 0; i < d->point_count; i++) {
        glintL_push_vector(L, d->points[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    glintL_freeze(L, "points");
}

// Returns the points computed for the last frame, as a list of lists: one for each stroke.
static int strokes(lua_State *L)
{
    const desc_type desc = *glint_overlay_get(glintL_check_object(L, 1, GLINTL_OVERLAY));
    lua_newtable(L);
    for (size_t i = 0; i < desc.point_count; i++) {
        if (desc.point_flags[i] & GLINT_POINT_BEGINS) {
            lua_settop(L, 2);
            lua_newtable(L);
            lua_pushvalue(L, 3);
            lua_rawseti(L, 2, (lua_Integer)lua_rawlen(L, 2) + 1);
        }
        glintL_push_vector(L, desc.points[i]);
        lua_rawseti(L, 3, (lua_Integer)lua_rawlen(L, 3) + 1);
    }
    lua_settop(L, 2);
    return 1;
}

static const luaL_Reg COMPUTED[] = { { "strokes", strokes }, { NULL, NULL } };

// ---- Objects that an overlay is computed from, stored with its userdata ----

static void read_owner(lua_State *L, int index, const char *path, const char *type)
{
    if (!glintL_test_object(L, index, type))
        glintL_refuse(L, index, path, type + sizeof "glint." - 1);
}

// Pushes the object stored with the userdata at 1, whose field is read.
static void push_owner(lua_State *L, const char *name)
{
    if (!glintL_push_kept(L, 1, name))
        lua_pushnil(L);
}

static void read_material(lua_State *L, int index, const char *path, void *desc)
{
    (void)desc;
    read_owner(L, index, path, GLINTL_MATERIAL);
}

static void push_material(lua_State *L, const void *desc)
{
    (void)desc;
    push_owner(L, "material");
}

static void read_camera(lua_State *L, int index, const char *path, void *desc)
{
    (void)desc;
    read_owner(L, index, path, GLINTL_CAMERA);
}

static void push_camera(lua_State *L, const void *desc)
{
    (void)desc;
    push_owner(L, "camera");
}

static void read_scene(lua_State *L, int index, const char *path, void *desc)
{
    (void)desc;
    if (!lua_isnil(L, index))
        read_owner(L, index, path, GLINTL_SCENE);
}

static void push_scene(lua_State *L, const void *desc)
{
    (void)desc;
    push_owner(L, "scene");
}

// ---- The objects ----

static const char *const ORIENTATIONS[] = { "vertical", "horizontal", NULL };
static const char *const HIDDEN[] = { "drawn", "dashed", "none", NULL };

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

static const char *const SCALES[] = { "linear", "log", NULL };

// Reads "linear" or "log" for the field `name`; returns whether it is "log".
static bool read_log(lua_State *L, int index, const char *object, const char *name)
{
    const glintL_field scale = { .name = name, .type = GLINT_TYPE_CHOICE, .names = SCALES };
    unsigned which;
    glintL_read_field(L, index, object, &scale, &which);
    return which == 1;
}

static void read_scale(lua_State *L, int index, const char *path, void *desc)
{
    (void)path;
    ((desc_type *)desc)->is_log = read_log(L, index, "colorbar", "scale");
}

static void push_scale(lua_State *L, const void *desc) { lua_pushstring(L, SCALES[((const desc_type *)desc)->is_log]); }

// clang-format off
#define EVERY_OVERLAY \
    {.name = "at", GLINTL_CUSTOM(read_at, push_at)}, \
    {.name = "position", GLINTL_CUSTOM(read_position, push_position), .set_offset = AT(has_position)}, \
    LOOKS

#define LOOKS \
    {.name = "size", .type = GLINT_TYPE_NUMBER, .offset = AT(size), .set_offset = AT(has_size)}, \
    {.name = "margin", .type = GLINT_TYPE_NUMBER, .offset = AT(margin), .set_offset = AT(has_margin)}, \
    {.name = "color", .type = GLINT_TYPE_COLOR, .offset = AT(color)}, \
    {.name = "background", .type = GLINT_TYPE_COLOR, .offset = AT(background), .set_offset = AT(has_background)}, \
    {.name = "opacity", .type = GLINT_TYPE_NUMBER, .offset = AT(opacity)}, \
    {.name = "name", .type = GLINT_TYPE_TEXT, .offset = AT(name)}

#define CURVE \
    {.name = "label", GLINTL_CUSTOM(read_text, push_text)}, \
    {.name = "width", .type = GLINT_TYPE_NUMBER, .offset = AT(width), .set_offset = AT(has_width)}, \
    HIDES

#define HIDES {.name = "hidden", .type = GLINT_TYPE_CHOICE, .offset = AT(hidden), .names = HIDDEN}

#define LENGTH {.name = "length", .type = GLINT_TYPE_NUMBER, .offset = AT(length), .set_offset = AT(has_length)}
// clang-format on

static const glintL_field LABEL_FIELDS[] = {
    { .name = "text", GLINTL_CUSTOM(read_text, push_text), .required = true },
    { .name = "at_point", .type = GLINT_TYPE_VECTOR, .offset = AT(point), .set_offset = AT(has_point) },
    HIDES,
    EVERY_OVERLAY,
    { .name = NULL },
};

static const glintL_field COLORBAR_FIELDS[] = {
    { .name = "map", GLINTL_CUSTOM(read_map, push_map), .required = true },
    { .name = "low", .type = GLINT_TYPE_NUMBER, .offset = AT(low), .required = true },
    { .name = "high", .type = GLINT_TYPE_NUMBER, .offset = AT(high), .required = true },
    { .name = "title", GLINTL_CUSTOM(read_text, push_text) },
    { .name = "ticks", GLINTL_CUSTOM(read_ticks, push_ticks) },
    { .name = "scale", GLINTL_CUSTOM(read_scale, push_scale) },
    { .name = "orientation", .type = GLINT_TYPE_CHOICE, .offset = AT(orientation), .names = ORIENTATIONS },
    LENGTH,
    EVERY_OVERLAY,
    { .name = NULL },
};

static const glintL_field AXES_FIELDS[] = {
    { .name = "box", GLINTL_CUSTOM(read_box, push_box), .set_offset = AT(has_box) }, // sets default names of the axes
    { .name = "labels", GLINTL_CUSTOM(read_names, push_names) },
    { .name = "values", GLINTL_CUSTOM(read_values, push_values), .set_offset = AT(has_values) },
    LENGTH,
    EVERY_OVERLAY,
    { .name = NULL },
};

// The x of a chart is read with the series.
static void read_x(lua_State *L, int index, const char *path, void *desc)
{
    (void)index, (void)desc;
    if (!lua_istable(L, 1))
        glintL_error(L, "%s: only glint.chart { ... } takes x; assign series with their own x", path);
}

// The labels of a chart are read with the series.
static void read_labels(lua_State *L, int index, const char *path, void *desc)
{
    (void)desc;
    if (!lua_istable(L, 1))
        glintL_error(L, "%s: only glint.chart { ... } takes labels; assign series with their own label", path);
    if (!lua_istable(L, index))
        glintL_refuse(L, index, path, "list of texts, one for each series");
}

static void push_nil(lua_State *L, const void *desc)
{
    (void)desc;
    lua_pushnil(L);
}

#define AXIS(i, letter) \
    static void read_title_##letter(lua_State *L, int index, const char *path, void *desc) \
    { \
        copy_text(L, index, path, ((desc_type *)desc)->titles[i], GLINT_CHART_TEXT_SIZE); \
    } \
    static void push_title_##letter(lua_State *L, const void *desc) { lua_pushstring(L, ((const desc_type *)desc)->titles[i]); } \
    static void read_range_##letter(lua_State *L, int index, const char *path, void *desc) \
    { \
        read_pair(L, index, path, "{first, last}", ((desc_type *)desc)->range[i]); \
    } \
    static void push_range_##letter(lua_State *L, const void *desc) { push_pair(L, ((const desc_type *)desc)->range[i], #letter "_range"); } \
    static void read_scale_##letter(lua_State *L, int index, const char *path, void *desc) \
    { \
        ((desc_type *)desc)->is_log_axis[i] = read_log(L, index, "chart", #letter "_scale"); \
        (void)path; \
    } \
    static void push_scale_##letter(lua_State *L, const void *desc) { lua_pushstring(L, SCALES[((const desc_type *)desc)->is_log_axis[i]]); }

AXIS(0, x)
AXIS(1, y)

static void read_extent(lua_State *L, int index, const char *path, void *desc)
{
    read_pair(L, index, path, "{width, height} in points", ((desc_type *)desc)->extent);
}

static void push_extent(lua_State *L, const void *desc) { push_pair(L, ((const desc_type *)desc)->extent, "extent"); }

static const glintL_field CHART_FIELDS[] = {
    { .name = "series", GLINTL_CUSTOM(glintL_chart_read, glintL_chart_push) },
    { .name = "x", GLINTL_CUSTOM(read_x, push_nil) },
    { .name = "y", GLINTL_CUSTOM(glintL_chart_read_y, push_nil) },
    { .name = "labels", GLINTL_CUSTOM(read_labels, push_nil) },
    { .name = "title", GLINTL_CUSTOM(read_text, push_text) },
    { .name = "x_label", GLINTL_CUSTOM(read_title_x, push_title_x) },
    { .name = "y_label", GLINTL_CUSTOM(read_title_y, push_title_y) },
    { .name = "x_scale", GLINTL_CUSTOM(read_scale_x, push_scale_x) },
    { .name = "y_scale", GLINTL_CUSTOM(read_scale_y, push_scale_y) },
    { .name = "x_range", GLINTL_CUSTOM(read_range_x, push_range_x), .set_offset = AT(has_range[0]) },
    { .name = "y_range", GLINTL_CUSTOM(read_range_y, push_range_y), .set_offset = AT(has_range[1]) },
    { .name = "extent", GLINTL_CUSTOM(read_extent, push_extent), .set_offset = AT(has_extent) },
    EVERY_OVERLAY,
    { .name = NULL },
};

static const glintL_field LINE_FIELDS[] = {
    { .name = "from", .type = GLINT_TYPE_VECTOR, .offset = AT(from), .required = true },
    { .name = "to", .type = GLINT_TYPE_VECTOR, .offset = AT(to), .required = true },
    CURVE,
    LOOKS,
    { .name = NULL },
};

static const glintL_field ARC_FIELDS[] = {
    { .name = "at", .type = GLINT_TYPE_VECTOR, .offset = AT(point), .required = true },
    { .name = "from", .type = GLINT_TYPE_DIRECTION, .offset = AT(from), .required = true },
    { .name = "to", .type = GLINT_TYPE_DIRECTION, .offset = AT(to), .required = true },
    { .name = "radius", .type = GLINT_TYPE_NUMBER, .offset = AT(radius), .set_offset = AT(has_radius) },
    CURVE,
    LOOKS,
    { .name = NULL },
};

static const glintL_field POLYLINE_FIELDS[] = {
    { .name = "points", GLINTL_CUSTOM(read_points, push_points), .required = true },
    CURVE,
    LOOKS,
    { .name = NULL },
};

static const glintL_field LOBE_FIELDS[] = {
    { .name = "point", .type = GLINT_TYPE_VECTOR, .offset = AT(point), .required = true },
    { .name = "material", GLINTL_CUSTOM(read_material, push_material), .required = true },
    { .name = "to_light", .type = GLINT_TYPE_DIRECTION, .offset = AT(to), .required = true },
    { .name = "normal", .type = GLINT_TYPE_DIRECTION, .offset = AT(from), .set_offset = AT(has_normal) },
    { .name = "scale", .type = GLINT_TYPE_NUMBER, .offset = AT(radius), .set_offset = AT(has_radius) },
    CURVE,
    LOOKS,
    { .name = NULL },
};

static const glintL_field PATH_FIELDS[] = {
    { .name = "scene", GLINTL_CUSTOM(read_scene, push_scene) },
    { .name = "origin", .type = GLINT_TYPE_VECTOR, .offset = AT(from), .required = true },
    { .name = "direction", .type = GLINT_TYPE_DIRECTION, .offset = AT(to), .required = true },
    { .name = "depth", .type = GLINT_TYPE_NUMBER, .offset = AT(depth) },
    { .name = "reach", .type = GLINT_TYPE_NUMBER, .offset = AT(radius), .set_offset = AT(has_radius) },
    CURVE,
    LOOKS,
    { .name = NULL },
};

static const glintL_field FRUSTUM_FIELDS[] = {
    { .name = "camera", GLINTL_CUSTOM(read_camera, push_camera), .required = true },
    { .name = "distance", .type = GLINT_TYPE_NUMBER, .offset = AT(radius), .set_offset = AT(has_radius) },
    { .name = "aspect", .type = GLINT_TYPE_NUMBER, .offset = AT(aspect) },
    CURVE,
    LOOKS,
    { .name = NULL },
};

static const luaL_Reg CHART_METHODS[] = { { "save", glintL_chart_push_save }, { NULL, NULL } };

static const glintL_variant VARIANTS[] = {
    [GLINT_OVERLAY_LABEL] = { .name = "label", .fields = LABEL_FIELDS },
    [GLINT_OVERLAY_COLORBAR] = { .name = "colorbar", .fields = COLORBAR_FIELDS },
    [GLINT_OVERLAY_AXES] = { .name = "axes", .fields = AXES_FIELDS },
    [GLINT_OVERLAY_ARROW] = { .name = "arrow", .fields = LINE_FIELDS },
    [GLINT_OVERLAY_LINE] = { .name = "line", .fields = LINE_FIELDS },
    [GLINT_OVERLAY_ARC] = { .name = "arc", .fields = ARC_FIELDS },
    [GLINT_OVERLAY_POLYLINE] = { .name = "polyline", .fields = POLYLINE_FIELDS },
    [GLINT_OVERLAY_LOBE] = { .name = "lobe", .fields = LOBE_FIELDS, .getters = COMPUTED },
    [GLINT_OVERLAY_PATH] = { .name = "path", .fields = PATH_FIELDS, .getters = COMPUTED },
    [GLINT_OVERLAY_FRUSTUM] = { .name = "frustum", .fields = FRUSTUM_FIELDS, .getters = COMPUTED },
    [GLINT_OVERLAY_CHART] = { .name = "chart", .fields = CHART_FIELDS, .getters = CHART_METHODS },
};

static const glintL_variant *variant(const void *object) { return &VARIANTS[glint_overlay_get(object)->kind]; }

GLINTL_FUNCTIONS(overlay);

// Lets the last assignment decide between at, position and at_point.
static void assigned(lua_State *L, const glintL_field *field, void *desc)
{
    desc_type *d = desc;
    const bool is_at = strcmp(field->name, "at") == 0;
    if (is_at && d->has_box)
        glintL_error(L, "axes.at: only for axes without a box; axes with a box lie along its edges");
    if (is_at || strcmp(field->name, "at_point") == 0)
        d->has_position = false;
    if (d->kind == GLINT_OVERLAY_LABEL && (is_at || strcmp(field->name, "position") == 0))
        d->has_point = false;
}

static void begin(int kind, void *desc) { *(desc_type *)desc = glint_overlay_desc_default((glint_overlay_kind)kind); }

static void given(lua_State *L, const glintL_variant *of, const void *desc)
{
    const desc_type *d = desc;
    if (d->kind == GLINT_OVERLAY_CHART && !d->chart)
        glintL_error(L, "chart.series: list of series expected, got nil; a chart with one curve may have y instead");
    lua_pushliteral(L, "at");
    if (lua_rawget(L, 1) != LUA_TNIL && d->has_position)
        glintL_error(L, "%s: at or position expected, got both", of->name);
    if (!lua_isnil(L, -1) && d->has_box)
        glintL_error(L, "axes: at or box expected, got both");
    if (d->has_point && (!lua_isnil(L, -1) || d->has_position))
        glintL_error(L, "label: at_point or %s expected, got both", d->has_position ? "position" : "at");
    lua_pop(L, 1);
}

static const char *const OWNERS[] = { "material", "scene", "camera", NULL };

// Stores an assigned object, the value at 3, with the userdata at 1.
static void accepted(lua_State *L, const glintL_field *field, const void *desc)
{
    (void)desc;
    for (int i = 0; OWNERS[i]; i++)
        if (strcmp(field->name, OWNERS[i]) == 0)
            glintL_keep(L, 1, field->name, 3);
}

// Stores the objects of the constructor's table, at 1, with the userdata at 2.
static void made(lua_State *L, const void *desc)
{
    (void)desc;
    for (int i = 0; OWNERS[i]; i++) {
        lua_pushstring(L, OWNERS[i]);
        if (lua_rawget(L, 1) != LUA_TNIL)
            glintL_keep(L, 2, OWNERS[i], lua_gettop(L));
        lua_pop(L, 1);
    }
}

static const glintL_class CLASS = {
    .type = GLINTL_OVERLAY,
    .variant = variant,
    GLINTL_FUNCTION_MEMBERS,
    .assigned = assigned,
    .begin = begin,
    .given = given,
    .accepted = accepted,
    .made = made,
};

void glintL_open_overlay(lua_State *L) { glintL_open_objects(L, &CLASS, VARIANTS, sizeof VARIANTS / sizeof *VARIANTS); }
