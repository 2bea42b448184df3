// sweep.sheet: the contact sheet of a sweep, drawn when its frames are written.
//
//     sheet = { label = true, names = { shininess = "n" }, format = "%.0f", passes = true, columns = 4, difference = 1,
//               gain = 8, title = "...", colorbar = bar, output = "sheet.png" }
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bindings/run/film.h"
#include "bindings/run/sheet.h"

// ---- Checking ----

static void check_text(lua_State *L, int index, const char *path, const char *expected)
{
    size_t length;
    if (lua_type(L, index) != LUA_TSTRING || strlen(lua_tolstring(L, index, &length)) != length || length == 0)
        glintL_refuse(L, index, path, expected);
}

static void check_number(lua_State *L, int index, const char *path, double min, double max, bool whole,
                         const char *expected)
{
    double value = glintL_read_number(L, index, path);
    if (!(value >= min && value <= max) || (whole && value != (double)(int64_t)value))
        glintL_refuse(L, index, path, expected);
}

// Checks { axis = text }; glintL_sheet_check checks the texts.
static void check_texts(lua_State *L, int index, const char *path)
{
    if (!lua_istable(L, index))
        glintL_refuse(L, index, path, "table { axis = text }");
    lua_pushnil(L);
    while (lua_next(L, index)) {
        if (lua_type(L, -2) != LUA_TSTRING)
            glintL_bad_key(L, path, -2);
        check_text(L, lua_gettop(L), path, "table { axis = text }");
        lua_pop(L, 1);
    }
}

static void check_field(lua_State *L, int index, const char *name)
{
    char path[48], message[GLINTL_MESSAGE_SIZE];
    snprintf(path, sizeof path, "sweep.sheet.%s", name);
    if (strcmp(name, "label") == 0) {
        if (!lua_isboolean(L, index) && !lua_isfunction(L, index) && lua_type(L, index) != LUA_TSTRING)
            glintL_refuse(L, index, path, "boolean, string or function");
    } else if (strcmp(name, "columns") == 0) {
        check_number(L, index, path, 1, GLINT_SIDE_MAX, true, "whole number 1 .. 65535");
    } else if (strcmp(name, "difference") == 0) {
        check_number(L, index, path, 1, GLINTL_SHEET_MAX, true, "number of a frame, from 1,");
    } else if (strcmp(name, "gain") == 0) {
        check_number(L, index, path, 1e-3, 1e6, false, "number 0.001 .. 1000000");
    } else if (strcmp(name, "size") == 0) {
        check_number(L, index, path, 1, 10000, false, "points 1 .. 10000");
    } else if (strcmp(name, "dpi") == 0) {
        check_number(L, index, path, 0, 1e6, false, "number 0 .. 1000000");
    } else if (strcmp(name, "names") == 0 || (strcmp(name, "format") == 0 && !lua_isstring(L, index))) {
        check_texts(L, index, path);
    } else if (strcmp(name, "format") == 0) {
        check_text(L, index, path, "text");
    } else if (strcmp(name, "transparent") == 0 || strcmp(name, "passes") == 0) {
        if (!lua_isboolean(L, index))
            glintL_refuse(L, index, path, "boolean");
    } else if (strcmp(name, "colorbar") == 0) {
        const glint_overlay *bar = glintL_test_object(L, index, GLINTL_OVERLAY);
        if (!bar || glint_overlay_get(bar)->kind != GLINT_OVERLAY_COLORBAR)
            glintL_refuse(L, index, path, "glint.colorbar");
    } else {
        check_text(L, index, path, name[0] == 't' ? "text" : "file name");
        glintL_sheet as_output = { .path = lua_tostring(L, index), .count = 1 };
        if (name[0] == 'o' && !glintL_sheet_check(&as_output, message))
            glintL_error(L, "%s: %s", path, message);
    }
}

static const glintL_field FIELDS[] = {
    { .name = "label" }, { .name = "columns" }, { .name = "difference" }, { .name = "gain" },
    { .name = "title" }, { .name = "output" },  { .name = "size" },       { .name = "dpi" },
    { .name = "transparent" }, { .name = "colorbar" }, { .name = "names" }, { .name = "format" },
    { .name = "passes" }, { .name = NULL },
};

void glintL_list_sheet(lua_State *L)
{
    static const glintL_variant variant = { .name = "sheet", .fields = FIELDS };
    glintL_list_variant(L, &variant, NULL);
}

void glintL_sweep_check_sheet(lua_State *L, int index)
{
    if (!lua_istable(L, index))
        glintL_refuse(L, index, "sweep.sheet", "table");
    luaL_checkstack(L, 6, "sheet");
    lua_pushnil(L);
    while (lua_next(L, index)) {
        if (lua_type(L, -2) != LUA_TSTRING)
            glintL_bad_key(L, "sweep.sheet", -2);
        const char *name = lua_tostring(L, -2);
        if (!glintL_find_field(FIELDS, name))
            glintL_no_such_field(L, "sweep.sheet", name, glintL_nearest(name, FIELDS));
        check_field(L, lua_gettop(L), name);
        lua_pop(L, 1);
    }
}

// The contents of the sheet. The table `kept` on the stack owns the strings.
typedef struct lists {
    char **files, **positions, **labels;
    int64_t passes; // pictures of each frame
} lists;

static int64_t read_whole(lua_State *L, int sheet, const char *name)
{
    lua_getfield(L, sheet, name);
    int64_t value = (int64_t)lua_tonumber(L, -1);
    lua_pop(L, 1);
    return value;
}

static const char *read_text(lua_State *L, int sheet, const char *name) // the table retains it
{
    const char *text = lua_getfield(L, sheet, name) == LUA_TSTRING ? lua_tostring(L, -1) : NULL;
    lua_pop(L, 1);
    return text;
}

// Pushes a field as "axis=text" lines. The field is a table { axis = text }, or one text for all axes, whose line has
// an empty name.
static const char *push_lines(lua_State *L, int sheet, const char *name)
{
    lua_pushliteral(L, "");
    const int lines = lua_gettop(L), type = lua_getfield(L, sheet, name);
    if (type == LUA_TSTRING) {
        lua_pushfstring(L, "=%s", lua_tostring(L, -1));
        lua_replace(L, lines);
    }
    if (type == LUA_TTABLE)
        lua_pushnil(L);
    while (type == LUA_TTABLE && lua_next(L, lines + 1)) {
        lua_pushfstring(L, "%s%s=%s\n", lua_tostring(L, lines), lua_tostring(L, -2), lua_tostring(L, -1));
        lua_replace(L, lines);
        lua_pop(L, 1);
    }
    lua_settop(L, lines);
    return lua_tostring(L, lines);
}

// Reads a sheet. Leaves two strings on the stack, which the result borrows.
static glintL_sheet read_sheet(lua_State *L, int sheet, const lists *l, int64_t count, const char *path)
{
    glintL_sheet out = { .path = path, .files = l->files, .count = (size_t)count, .positions = l->positions };
    out.labels = l->labels;
    out.names = push_lines(L, sheet, "names");
    out.formats = push_lines(L, sheet, "format");
    out.label = read_text(L, sheet, "label");
    out.title = read_text(L, sheet, "title");
    out.columns = read_whole(L, sheet, "columns");
    out.difference = read_whole(L, sheet, "difference");
    lua_getfield(L, sheet, "gain");
    out.gain = lua_tonumber(L, -1);
    lua_getfield(L, sheet, "size");
    out.size = lua_tonumber(L, -1);
    lua_getfield(L, sheet, "dpi");
    out.dpi = lua_tonumber(L, -1);
    lua_getfield(L, sheet, "transparent");
    out.transparent = lua_toboolean(L, -1);
    lua_getfield(L, sheet, "colorbar"); // the table retains it
    const glint_overlay *bar = glintL_test_object(L, -1, GLINTL_OVERLAY);
    out.colorbar = bar ? glint_overlay_get(bar) : NULL;
    if (lua_getfield(L, sheet, "label") == LUA_TBOOLEAN && !lua_toboolean(L, -1))
        out.label = "none";
    lua_pop(L, 6);
    return out;
}

// Checks that every {name} of a template is an axis of the sweep, whose frame has these "name=value" lines.
static void check_template(lua_State *L, const char *label, const char *lines)
{
    size_t unused;
    for (const char *at = strchr(label, '{'); at; at = strchr(at + 1, '{')) {
        size_t length = strcspn(at + 1, "}");
        if (at[1 + length] == '\0' || glintL_find_line(lines, at + 1, length, &unused) ||
            (length == 4 && memcmp(at + 1, "file", 4) == 0) || (length == 5 && memcmp(at + 1, "frame", 5) == 0))
            continue;
        lua_pushlstring(L, at, length + 2);
        glintL_error(L, "sweep.sheet.label: %s: the name of an axis, {file} or {frame} expected", lua_tostring(L, -1));
    }
}

void glintL_sweep_check_together(lua_State *L, int index)
{
    const glintL_job *job = lua_touserdata(L, index);
    char message[GLINTL_MESSAGE_SIZE];
    luaL_checkstack(L, 8, "sheet");
    int top = lua_gettop(L);
    if (lua_getiuservalue(L, index, GLINTL_JOB_FRAME) != LUA_TNIL &&
        lua_getiuservalue(L, index, GLINTL_JOB_SHEET) == LUA_TTABLE) {
        int sheet = lua_gettop(L);
        lists none = { 0 };
        const char *output = read_text(L, sheet, "output");
        glintL_sheet made = read_sheet(L, sheet, &none, job->frames, output ? output : "sheet.png");
        glintL_sweep_push_position(L, index, 1);
        if (lua_getfield(L, sheet, "passes") != LUA_TNIL && lua_toboolean(L, -1))
            lua_pushfstring(L, "%s\npass=", lua_tostring(L, -2));
        else
            lua_pop(L, 1);
        const char *axes = lua_tostring(L, -1);
        if (!glintL_sheet_check(&made, message) || !glintL_sheet_check_axes(&made, axes, message))
            glintL_error(L, "sweep.sheet.%s", message);
        if (lua_getfield(L, sheet, "label") == LUA_TSTRING)
            check_template(L, lua_tostring(L, -1), axes);
    }
    lua_settop(L, top);
}

// ---- Drawing ----

// Writes the default name: "out/%04d.png" -> "out/sheet.png"; "x_%04d.png", "x.png" and "x.mp4" -> "x_sheet.png".
static void default_output(const glintL_naming *naming, char out[GLINTL_PATH_SIZE])
{
    const char *pattern = naming->film ? naming->film->path : naming->pattern, *slash = strrchr(pattern, '/'),
               *name = slash ? slash + 1 : pattern;
    size_t length = strcspn(name, naming->is_plain || naming->film ? "" : "%#");
    const char *dot = strrchr(name, '.');
    if (length == strlen(name) && dot)
        length = (size_t)(dot - name);
    while (length > 0 && strchr("_-. ", name[length - 1]))
        length--;
    snprintf(out, GLINTL_PATH_SIZE, "%.*s%.*s%s", (int)(name - pattern), pattern, (int)length, name,
             length ? "_sheet.png" : "sheet.png");
}

// Adds the number of the first frame, for a later sweep of the same run: "sheet.png" -> "sheet_0013.png".
static void number_output(char path[GLINTL_PATH_SIZE], int64_t first)
{
    char ending[16];
    char *dot = strrchr(path, '.');
    size_t stem = (size_t)(dot - path);
    snprintf(ending, sizeof ending, "%s", dot);
    snprintf(path + stem, GLINTL_PATH_SIZE - stem, "_%04" PRId64 "%s", first, ending);
}

typedef struct sheet_call {
    const glintL_naming *naming;
    int64_t first;
    bool partial;
} sheet_call;

// Pushes the result of the label function for a pass of frame n: function(values, n, pass), with values[name] = value
// for each axis.
static void push_label(lua_State *L, int function, int job, int64_t n, const char *pass)
{
    lua_pushvalue(L, function);
    glintL_sweep_push_values(L, job, n);
    lua_pushinteger(L, n);
    lua_pushstring(L, pass);
    lua_call(L, 3, 1);
    if (lua_type(L, -1) != LUA_TSTRING && lua_type(L, -1) != LUA_TNUMBER)
        glintL_refuse(L, -1, "sweep.sheet.label: the function's result", "string");
}

static char *keep(lua_State *L, int kept)
{
    char *text = (char *)(uintptr_t)lua_tostring(L, -1); // only read from here on
    lua_rawseti(L, kept, (lua_Integer)lua_rawlen(L, kept) + 1);
    return text;
}

static char **new_list(lua_State *L, int64_t count, int kept)
{
    char **list = lua_newuserdatauv(L, (size_t)count * sizeof *list, 0);
    lua_rawseti(L, kept, (lua_Integer)lua_rawlen(L, kept) + 1);
    return list;
}

// Returns the first cell without a file, and the last one; 0: all have files.
static int64_t find_missing(const lists *l, int64_t count, int64_t *last)
{
    int64_t first = 0;
    for (int64_t cell = 1; cell <= count; cell++) {
        if (access(l->files[cell - 1], R_OK) == 0)
            continue;
        first = first ? first : cell;
        *last = cell;
    }
    return first;
}

static void fill_cell(lua_State *L, int job, const sheet_call *what, int64_t n, const char *pass, int label, int kept,
                      size_t cell, lists *out)
{
    char path[GLINTL_PATH_SIZE];
    if (!glintL_name_file(what->naming, what->first + n - 1, pass, path))
        glintL_error(L, "output: the file name '%s...' is too long", path);
    lua_pushstring(L, path);
    out->files[cell] = keep(L, kept);
    glintL_sweep_push_position(L, job, n);
    out->positions[cell] = keep(L, kept);
    if (out->labels) {
        push_label(L, label, job, n, pass);
        out->labels[cell] = keep(L, kept);
    }
}

// Fills the lists with the passes in the table at `passes`, which change fastest.
static void fill_lists(lua_State *L, int job, const sheet_call *what, int64_t frames, int passes, int label, int kept,
                       lists *out)
{
    out->passes = (int64_t)lua_rawlen(L, passes);
    if (frames > GLINTL_SHEET_MAX / out->passes)
        glintL_error(L, "sweep.sheet: at most %d pictures expected", GLINTL_SHEET_MAX);
    out->files = new_list(L, frames * out->passes, kept);
    out->positions = new_list(L, frames * out->passes, kept);
    out->labels = lua_isfunction(L, label) ? new_list(L, frames * out->passes, kept) : NULL;
    for (int64_t n = 1; n <= frames; n++)
        for (int64_t pass = 1; pass <= out->passes; pass++) {
            lua_rawgeti(L, passes, pass);
            fill_cell(L, job, what, n, lua_tostring(L, -1), label, kept, (size_t)((n - 1) * out->passes + pass - 1), out);
            lua_pop(L, 1);
        }
}

static void warn_missing(const glintL_run *run, const char *path, int64_t from, int64_t to)
{
    if (from == to)
        glintL_run_note(run, "%s: not drawn: frame %" PRId64 " is not rendered yet", path, from);
    else
        glintL_run_note(run, "%s: not drawn: frames between %" PRId64 " and %" PRId64 " are not rendered yet", path, from,
                        to);
}

// Draws the sheet from the files, when everything else is known.
static void draw(glintL_run *run, const sheet_call *what, const glintL_sheet *sheet, const lists *l)
{
    char message[GLINTL_MESSAGE_SIZE];
    int64_t last = 0, missing = find_missing(l, (int64_t)sheet->count, &last);
    if (missing && what->partial) {
        warn_missing(run, sheet->path, what->first + (missing - 1) / l->passes, what->first + (last - 1) / l->passes);
        return;
    }
    int code = glintL_sheet_make(sheet, message);
    if (code && what->partial)
        glintL_run_note(run, "%s: not drawn: %s", sheet->path, message);
    else if (code)
        glintL_run_fail(run, code, 0, "%s: %s", sheet->path, message);
    else if (run->reporter.figure)
        run->reporter.figure(run->reporter.context, "sheet", sheet->path, (int64_t)sheet->count);
}

// Pushes the passes on the sheet: the picture, and with `passes` in the sheet those that are rendered.
static void push_passes(lua_State *L, int sheet, const glintL_render *render)
{
    const bool has_all = lua_getfield(L, sheet, "passes") != LUA_TNIL && lua_toboolean(L, -1);
    if (has_all)
        glintL_render_push(L, glintL_render_find("passes"), render);
    else
        lua_newtable(L);
    for (lua_Integer i = (lua_Integer)lua_rawlen(L, -1); i >= 1; i--) {
        if (lua_rawgeti(L, -1, i) == LUA_TSTRING && strcmp(lua_tostring(L, -1), "light:*") == 0)
            glintL_error(L, "sweep.sheet.passes: expected the names of lights in the passes light:NAME, got 'light:*'");
        lua_rawseti(L, -2, i + 1);
    }
    lua_pushliteral(L, "beauty");
    lua_rawseti(L, -2, 1);
    lua_remove(L, -2);
}

static int draw_protected(lua_State *L)
{
    const glintL_job *job = lua_touserdata(L, 1);
    const sheet_call *what = lua_touserdata(L, 2);
    glintL_run *run = glintL_get_run(L);
    glintL_render render = job->render;
    char output[GLINTL_PATH_SIZE];
    lists l;
    luaL_checkstack(L, 24, "sheet");
    glintL_run_apply(run, &render);
    lua_getiuservalue(L, 1, GLINTL_JOB_SHEET); // 3
    lua_getfield(L, 3, "label"); // 4
    lua_newtable(L); // 5
    push_passes(L, 3, &render); // 6
    fill_lists(L, 1, what, job->frames, 6, 4, 5, &l);
    const char *given = read_text(L, 3, "output");
    if (given)
        snprintf(output, sizeof output, "%s", given);
    else
        default_output(what->naming, output);
    if (what->first > 1 && (!given || run->point_count > 1))
        number_output(output, what->first);
    glintL_sheet sheet = read_sheet(L, 3, &l, job->frames * l.passes, output);
    sheet.live = run->live;
    if (sheet.dpi == 0) // uses the dpi of the pictures
        sheet.dpi = render.dpi;
    if (glintL_written_note(run, "sheet", output, what->first))
        draw(run, what, &sheet, &l);
    return 0;
}

bool glintL_sweep_make_sheet(lua_State *L, int index, const glintL_naming *naming, int64_t first, bool partial)
{
    glintL_run *run = glintL_get_run(L);
    sheet_call what = { naming, first, partial };
    int top = lua_gettop(L), type = lua_getiuservalue(L, index, GLINTL_JOB_SHEET);
    lua_settop(L, top);
    if (type != LUA_TTABLE)
        return true;
    if (!glintL_run_collect(run, true)) // from here on all its frames are written
        return false;
    lua_pushcfunction(L, glintL_message_handler);
    lua_pushcfunction(L, draw_protected);
    lua_pushvalue(L, index);
    lua_pushlightuserdata(L, &what);
    run->in_frame = true;
    int status = lua_pcall(L, 2, 0, top + 1);
    run->in_frame = false;
    if (status != LUA_OK)
        glintL_run_fail(run, glintL_script_exit(run, status), 0, "%s", lua_tostring(L, -1));
    lua_settop(L, top);
    return run->exit_code == 0;
}
