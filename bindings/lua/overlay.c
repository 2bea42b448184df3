// glint.label, glint.colorbar, glint.axes, glint.arrow, glint.line, glint.arc, glint.polyline, glint.lobe, glint.path,
// glint.frustum, glint.chart
#include <string.h>

#include "bindings/lua/overlay.h"
#include "engine/glint.h"

// ---- Special fields ----

static const char *const PLACES[3][3] = {
    { "top left", "top", "top right" }, { "left", "center", "right" }, { "bottom left", "bottom", "bottom right" }
};

void glintL_overlay_read_pair(lua_State *L, int index, const char *path, const char *expected, double out[2])
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

void glintL_overlay_push_pair(lua_State *L, const double pair[2], const char *name)
{
    lua_createtable(L, 2, 0);
    for (int i = 0; i < 2; i++) {
        lua_pushnumber(L, pair[i]);
        lua_rawseti(L, -2, i + 1);
    }
    glintL_freeze(L, name);
}

void glintL_overlay_read_at(lua_State *L, int index, const char *path, void *desc)
{
    static const char expected[] = "\"top left\", \"top\", \"top right\", \"left\", \"center\", \"right\", \"bottom "
                                   "left\", \"bottom\", \"bottom right\" or {x, y} as fractions of the picture";
    desc_type *d = desc;
    if (lua_type(L, index) != LUA_TSTRING) {
        glintL_overlay_read_pair(L, index, path, expected, d->at);
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

void glintL_overlay_push_at(lua_State *L, const void *desc)
{
    const desc_type *d = desc;
    const double x = 2 * d->at[0], y = 2 * d->at[1];
    if (d->has_position || d->has_point)
        lua_pushnil(L);
    else if (x == (int)x && y == (int)y)
        lua_pushstring(L, PLACES[(int)y][(int)x]);
    else
        glintL_overlay_push_pair(L, d->at, "at");
}

void glintL_overlay_read_position(lua_State *L, int index, const char *path, void *desc)
{
    glintL_overlay_read_pair(L, index, path, "{x, y} in pixels", ((desc_type *)desc)->position);
}

void glintL_overlay_push_position(lua_State *L, const void *desc) { glintL_overlay_push_pair(L, ((const desc_type *)desc)->position, "position"); }

void glintL_overlay_copy_text(lua_State *L, int index, const char *path, char *out, size_t capacity)
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

void glintL_overlay_read_text(lua_State *L, int index, const char *path, void *desc)
{
    glintL_overlay_copy_text(L, index, path, ((desc_type *)desc)->text, GLINT_OVERLAY_TEXT_SIZE);
}

void glintL_overlay_push_text(lua_State *L, const void *desc) { lua_pushstring(L, ((const desc_type *)desc)->text); }

// ---- The objects ----

const char *const glintL_overlay_scales[] = { "linear", "log", NULL };

// Reads "linear" or "log" for the field `name`; returns whether it is "log".
bool glintL_overlay_read_log(lua_State *L, int index, const char *object, const char *name)
{
    const glintL_field scale = { .name = name, .type = GLINT_TYPE_CHOICE, .names = glintL_overlay_scales };
    unsigned which;
    glintL_read_field(L, index, object, &scale, &which);
    return which == 1;
}

const char *const glintL_overlay_hidden[] = { "drawn", "dashed", "none", NULL };

static const glintL_field LABEL_FIELDS[] = {
    { .name = "text", GLINTL_CUSTOM(glintL_overlay_read_text, glintL_overlay_push_text), .required = true },
    { .name = "at_point", .type = GLINT_TYPE_VECTOR, .offset = AT(point), .set_offset = AT(has_point) },
    HIDES,
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

static const glintL_variant VARIANTS[] = {
    [GLINT_OVERLAY_LABEL] = { .name = "label", .fields = LABEL_FIELDS },
    [GLINT_OVERLAY_COLORBAR] = { .name = "colorbar", .fields = glintL_colorbar_fields },
    [GLINT_OVERLAY_AXES] = { .name = "axes", .fields = glintL_axes_fields },
    [GLINT_OVERLAY_ARROW] = { .name = "arrow", .fields = LINE_FIELDS },
    [GLINT_OVERLAY_LINE] = { .name = "line", .fields = LINE_FIELDS },
    [GLINT_OVERLAY_ARC] = { .name = "arc", .fields = ARC_FIELDS },
    [GLINT_OVERLAY_POLYLINE] = { .name = "polyline", .fields = glintL_polyline_fields },
    [GLINT_OVERLAY_LOBE] = { .name = "lobe", .fields = glintL_lobe_fields, .getters = glintL_curve_getters },
    [GLINT_OVERLAY_PATH] = { .name = "path", .fields = glintL_path_fields, .getters = glintL_curve_getters },
    [GLINT_OVERLAY_FRUSTUM] = { .name = "frustum", .fields = glintL_frustum_fields, .getters = glintL_curve_getters },
    [GLINT_OVERLAY_CHART] = { .name = "chart", .fields = glintL_chart_fields, .getters = glintL_chart_methods },
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

static const glintL_class CLASS = {
    .type = GLINTL_OVERLAY,
    .variant = variant,
    GLINTL_FUNCTION_MEMBERS,
    .assigned = assigned,
    .begin = begin,
    .given = given,
    .accepted = glintL_curve_accepted,
    .made = glintL_curve_made,
};

void glintL_open_overlay(lua_State *L) { glintL_open_objects(L, &CLASS, VARIANTS, sizeof VARIANTS / sizeof *VARIANTS); }
