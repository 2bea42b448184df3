// The series of glint.chart: tables with label, x, y, color, width and dots; charts as pictures of their own.
#include "bindings/lua/overlay.h"
#include "bindings/lua/lua.h"
#include "bindings/value/array.h"

#include <string.h>

static const char CHARTS; // address used as the registry key for a table from lists of series to their charts

typedef struct series {
    char label[GLINT_CHART_TEXT_SIZE];
    bool has_color, has_width, has_dots;
    double color[3], width;
} series;

// Copies the text at `index`.
static void read_label(lua_State *L, int index, const char *path, void *out)
{
    size_t length;
    if (lua_type(L, index) != LUA_TSTRING)
        glintL_refuse(L, index, path, "string");
    const char *text = lua_tolstring(L, index, &length);
    if (length >= GLINT_CHART_TEXT_SIZE || strlen(text) != length)
        glintL_error(L, "%s: at most %d bytes, none of them zero, expected", path, GLINT_CHART_TEXT_SIZE - 1);
    memcpy(((series *)out)->label, text, length + 1);
}

static void ignore(lua_State *L, int index, const char *path, void *out) // the points are read by read_points
{
    (void)L, (void)index, (void)path, (void)out;
}

static const glintL_field FIELDS[] = {
    { .name = "label", GLINTL_CUSTOM(read_label, NULL) },
    { .name = "x", GLINTL_CUSTOM(ignore, NULL) },
    { .name = "y", GLINTL_CUSTOM(ignore, NULL), .required = true },
    { .name = "color", .type = GLINT_TYPE_COLOR, .offset = offsetof(series, color), .set_offset = offsetof(series, has_color) },
    { .name = "width", .type = GLINT_TYPE_NUMBER, .offset = offsetof(series, width), .set_offset = offsetof(series, has_width) },
    { .name = "dots", .type = GLINT_TYPE_FLAG, .offset = offsetof(series, has_dots) },
    { .name = NULL },
};

// Returns the numbers at `index`: an array, or a list, which an array replaces.
static const glintL_array *take_numbers(lua_State *L, int index, const char *path, const char *expected)
{
    const glintL_array *array = glintL_to_array(L, index);
    if (array ? array->width != 1 : !lua_istable(L, index))
        glintL_refuse(L, index, path, expected);
    if (array)
        return array;
    return glintL_take_list(L, index, &(glintL_numbers) { .path = path }, glintL_check_list(L, index, path, false));
}

// Calls the function at `function` for each x.
static void call_function(lua_State *L, int function, const char *path, size_t count, const double *x, double *out)
{
    for (size_t i = 0; i < count; i++) {
        lua_pushvalue(L, function);
        lua_pushnumber(L, x[i]);
        lua_call(L, 1, 1);
        const char *full = lua_pushfstring(L, "%s(%f)", path, x[i]);
        out[i] = glintL_read_number(L, lua_gettop(L) - 1, full);
        lua_pop(L, 2);
    }
}

// Pushes the x of the series at `index`: its own list, the chart's, or nil.
static void push_x(lua_State *L, int index)
{
    lua_pushliteral(L, "x");
    if (lua_rawget(L, index) == LUA_TNIL && lua_istable(L, 1)) {
        lua_pop(L, 1);
        lua_pushliteral(L, "x");
        lua_rawget(L, 1);
    }
}

// Pushes a buffer with the points of the series at `index`: x, then y.
static void push_points(lua_State *L, int index, const char *path, glint_curve *out)
{
    const char *x_path = lua_pushfstring(L, "%s.x", path), *y_path = lua_pushfstring(L, "%s.y", path);
    push_x(L, index);
    const int x = lua_gettop(L), y = x + 1;
    lua_pushliteral(L, "y");
    lua_rawget(L, index);
    const bool has_function = lua_isfunction(L, y);
    const glintL_array *xs = lua_isnil(L, x) ? NULL : take_numbers(L, x, x_path, "list or array of numbers"), *ys = NULL;
    if (has_function && !xs)
        glintL_error(L, "%s: list of the numbers at which y is called expected", x_path);
    if (!has_function)
        ys = take_numbers(L, y, y_path, "list or array of numbers, or function of x");
    const size_t count = xs ? xs->count : ys ? ys->count : 0;
    if (ys && ys->count != count)
        glintL_error(L, "%s: as many numbers as in x expected: %d, got %d", y_path, (int)count, (int)ys->count);
    double *points = lua_newuserdatauv(L, (2 * count + 1) * sizeof *points, 0);
    for (size_t i = 0; i < count; i++) {
        points[i] = xs ? number_at(xs, i) : (double)i + 1;
        points[count + i] = ys ? number_at(ys, i) : 0;
    }
    if (has_function)
        call_function(L, y, y_path, count, points, points + count);
    lua_replace(L, x - 2);
    lua_settop(L, x - 2);
    out->x = points;
    out->y = points + count;
    out->count = count;
}

static int release(lua_State *L)
{
    glint_chart **chart = lua_touserdata(L, 1);
    glint_chart_release(*chart);
    *chart = NULL;
    return 0;
}

// Makes space for a chart's reference, which lives as long as the list of series at `index`. Returns the space, NULL at
// first.
static glint_chart **keep(lua_State *L, int index)
{
    glintL_push_weak_table(L, &CHARTS, "k");
    lua_pushvalue(L, index);
    glint_chart **chart = lua_newuserdatauv(L, sizeof *chart, 0);
    *chart = NULL;
    lua_createtable(L, 0, 1);
    glintL_set_function(L, "__gc", release);
    lua_setmetatable(L, -2);
    lua_rawset(L, -3);
    lua_pop(L, 1);
    return chart;
}

// Takes the label of series number `i`, which has none, from the labels of the constructor's table.
static void read_own_label(lua_State *L, size_t i, series *out)
{
    char path[40];
    if (out->label[0] || !lua_istable(L, 1))
        return;
    lua_pushliteral(L, "labels");
    if (lua_rawget(L, 1) == LUA_TTABLE && lua_rawgeti(L, -1, (lua_Integer)i + 1) != LUA_TNIL) {
        snprintf(path, sizeof path, "chart.labels[%zu]", i + 1);
        read_label(L, lua_gettop(L), path, out);
    }
}

// Reads the list of series at `index`. The chart lives as long as the table at `owner`.
static void read_series(lua_State *L, int index, int owner, const char *path, void *desc)
{
    glint_error error;
    glint_curve curves[GLINT_CURVES_MAX];
    series read[GLINT_CURVES_MAX];
    const int top = lua_gettop(L);
    if (!lua_istable(L, index))
        glintL_refuse(L, index, path, "list of series");
    const size_t count = glintL_check_list(L, index, path, false);
    if (count < 1 || count > GLINT_CURVES_MAX)
        glintL_error(L, "%s: 1 .. %d series expected, got %d", path, GLINT_CURVES_MAX, (int)count);
    luaL_checkstack(L, (int)count + 12, "series");
    for (size_t i = 0; i < count; i++) {
        char full[64];
        snprintf(full, sizeof full, "%.40s[%zu]", path, i + 1);
        read[i] = (series) { .label = "" };
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        glintL_read_table(L, -1, full, FIELDS, &read[i], false);
        const int row = lua_gettop(L);
        read_own_label(L, i, &read[i]);
        lua_settop(L, row);
        push_points(L, row, full, &curves[i]);
        lua_remove(L, -2); // leaves the buffer
        curves[i].label = read[i].label;
        curves[i].has_color = read[i].has_color;
        memcpy(curves[i].color, read[i].color, sizeof curves[i].color);
        curves[i].has_width = read[i].has_width;
        curves[i].width = read[i].width;
        curves[i].has_dots = read[i].has_dots;
    }
    glint_chart **chart = keep(L, owner);
    glintL_check_status(L, "chart", &error, glint_chart_create(curves, count, chart, &error));
    ((glint_overlay_desc *)desc)->chart = *chart;
    lua_settop(L, top);
}

static void read_list(lua_State *L, int index, const char *path, void *desc) { read_series(L, index, index, path, desc); }

static void read_y(lua_State *L, int index, const char *path, void *desc)
{
    if (!lua_istable(L, 1))
        glintL_error(L, "%s: only glint.chart { ... } takes y; assign series", path);
    if (((glint_overlay_desc *)desc)->chart)
        glintL_error(L, "chart: series or y expected, got both");
    lua_createtable(L, 1, 0);
    lua_createtable(L, 0, 1);
    lua_pushvalue(L, index);
    lua_setfield(L, -2, "y");
    lua_rawseti(L, -2, 1);
    read_series(L, lua_gettop(L), 1, "chart.series", desc);
    lua_pop(L, 1);
}

static void push_numbers(lua_State *L, const double *of, size_t count, const char *name)
{
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        lua_pushnumber(L, of[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, name);
}

static void push_curve(lua_State *L, const glint_curve *curve)
{
    lua_createtable(L, 0, 6);
    glintL_set_text(L, "label", curve->label);
    push_numbers(L, curve->x, curve->count, "x");
    push_numbers(L, curve->y, curve->count, "y");
    if (curve->has_color) {
        glintL_push_vector(L, curve->color);
        lua_setfield(L, -2, "color");
    }
    if (curve->has_width) {
        glintL_set_number(L, "width", curve->width);
    }
    glintL_set_flag(L, "dots", curve->has_dots);
}

static void push_list(lua_State *L, const void *desc)
{
    const glint_overlay_desc *d = desc;
    const glint_curve *curve;
    luaL_checkstack(L, 6, "series");
    lua_newtable(L);
    for (size_t i = 0; (curve = glint_chart_curve(d->chart, i)) != NULL; i++) {
        push_curve(L, curve);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    glintL_freeze(L, "series");
}

// ---- A chart as a picture ----

typedef struct save_options {
    int64_t width, height;
    double dpi;
} save_options;

// Renders a scene without lights on one thread.
static glint_status draw(glint_scene *scene, const save_options *options, glint_image **out, glint_error *error)
{
    glint_render_desc desc = glint_render_desc_default();
    glint_renderer_desc on = glint_renderer_desc_default();
    glint_renderer *renderer = NULL;
    glint_plan *plan = NULL;
    desc.width = options->width;
    desc.height = options->height;
    on.threads = 1;
    glint_status status = glint_plan_create(scene, &desc, &plan, error);
    if (!status)
        status = glint_renderer_create(&on, &renderer, error);
    if (!status)
        status = glint_render(renderer, plan, out, NULL, error);
    glint_renderer_destroy(renderer);
    glint_plan_destroy(plan);
    return status;
}

// Writes a chart: save(path, { width, height, dpi }). This is not a frame of the run.
static int save(lua_State *L)
{
    static const glintL_field fields[] = {
        { .name = "width", .type = GLINT_TYPE_WHOLE, .offset = offsetof(save_options, width), .low = 1, .high = GLINT_SIDE_MAX },
        { .name = "height", .type = GLINT_TYPE_WHOLE, .offset = offsetof(save_options, height), .low = 1, .high = GLINT_SIDE_MAX },
        { .name = "dpi", .type = GLINT_TYPE_NUMBER, .offset = offsetof(save_options, dpi) },
        { .name = NULL },
    };
    glint_error error;
    glint_image *image;
    save_options read = { 640, 400, 0 };
    lua_settop(L, 3);
    if (!lua_isnil(L, 3))
        glintL_read_table(L, 3, "save", fields, &read, false);
    if (!glintL_push_chart_scene(L, 1))
        return luaL_typeerror(L, 1, "chart");
    glintL_give_camera(L, glintL_get_run(L), 4);
    glintL_box *box = glintL_new_box(L, GLINTL_IMAGE);
    glintL_check_status(L, "save", &error, draw(glintL_check_object(L, 4, GLINTL_SCENE), &read, &image, &error));
    box->object = image;
    lua_getfield(L, 5, "save");
    lua_insert(L, 5);
    lua_pushvalue(L, 2);
    lua_createtable(L, 0, 1);
    glintL_set_number(L, "dpi", read.dpi);
    lua_call(L, 3, LUA_MULTRET);
    return lua_gettop(L) - 4;
}

static int push_save(lua_State *L)
{
    lua_pushcfunction(L, save);
    return 1;
}

// ---- The fields ----

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
        glintL_overlay_copy_text(L, index, path, ((desc_type *)desc)->titles[i], GLINT_CHART_TEXT_SIZE); \
    } \
    static void push_title_##letter(lua_State *L, const void *desc) { lua_pushstring(L, ((const desc_type *)desc)->titles[i]); } \
    static void read_range_##letter(lua_State *L, int index, const char *path, void *desc) \
    { \
        glintL_overlay_read_pair(L, index, path, "{first, last}", ((desc_type *)desc)->range[i]); \
    } \
    static void push_range_##letter(lua_State *L, const void *desc) { glintL_overlay_push_pair(L, ((const desc_type *)desc)->range[i], #letter "_range"); } \
    static void read_scale_##letter(lua_State *L, int index, const char *path, void *desc) \
    { \
        ((desc_type *)desc)->is_log_axis[i] = glintL_overlay_read_log(L, index, "chart", #letter "_scale"); \
        (void)path; \
    } \
    static void push_scale_##letter(lua_State *L, const void *desc) { lua_pushstring(L, glintL_overlay_scales[((const desc_type *)desc)->is_log_axis[i]]); }

AXIS(0, x)
AXIS(1, y)

static void read_extent(lua_State *L, int index, const char *path, void *desc)
{
    glintL_overlay_read_pair(L, index, path, "{width, height} in points", ((desc_type *)desc)->extent);
}

static void push_extent(lua_State *L, const void *desc) { glintL_overlay_push_pair(L, ((const desc_type *)desc)->extent, "extent"); }

const glintL_field glintL_chart_fields[] = {
    { .name = "series", GLINTL_CUSTOM(read_list, push_list) },
    { .name = "x", GLINTL_CUSTOM(read_x, push_nil) },
    { .name = "y", GLINTL_CUSTOM(read_y, push_nil) },
    { .name = "labels", GLINTL_CUSTOM(read_labels, push_nil) },
    { .name = "title", GLINTL_CUSTOM(glintL_overlay_read_text, glintL_overlay_push_text) },
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

const luaL_Reg glintL_chart_methods[] = { { "save", push_save }, { NULL, NULL } };
