// The contact sheet of a sweep, drawn when its frames are written: what sweep_sheet.lua needs of the run and the job.
#include <string.h>

#include "bindings/run/carried.h"
#include "bindings/run/film.h"
#include "bindings/run/sheet.h"
#include "engine/glint_figures.h"

// ---- Fields ----

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

static int no_sheet_field(lua_State *L)
{
    const char *name = luaL_checkstring(L, 1);
    return glintL_no_such_field(L, "sweep.sheet", name, glintL_nearest(name, FIELDS));
}

static int is_colorbar(lua_State *L)
{
    const glint_overlay *bar = glintL_test_object(L, 1, GLINTL_OVERLAY);
    lua_pushboolean(L, bar && glint_overlay_get(bar)->kind == GLINT_OVERLAY_COLORBAR);
    return 1;
}

// name_of_object(value): returns the name that a script gave an object, or nil.
static int name_of_object(lua_State *L)
{
    const bool is_named = lua_isuserdata(L, 1) && !glintL_test_object(L, 1, GLINTL_SCENE) && // has no name
                          luaL_getmetafield(L, 1, "__name") != LUA_TNIL &&
                          glintL_test_object(L, 1, lua_tostring(L, -1)) &&
                          lua_getfield(L, 1, "name") == LUA_TSTRING && lua_rawlen(L, -1) > 0;
    return is_named ? 1 : 0;
}

// ---- Drawing ----

// name_file(naming, number, pass): returns the file name of a frame's pass.
static int name_file(lua_State *L)
{
    char path[GLINTL_PATH_SIZE];
    if (!glintL_name_file(lua_touserdata(L, 1), luaL_checkinteger(L, 2), luaL_checkstring(L, 3), path))
        glintL_error(L, "output: the file name '%s...' is too long", path);
    lua_pushstring(L, path);
    return 1;
}

// note_written(what, path, number): returns whether the run has not failed.
static int note_written(lua_State *L)
{
    lua_pushboolean(L, glintL_written_note(glintL_get_run(L), luaL_checkstring(L, 1), luaL_checkstring(L, 2),
                                           luaL_checkinteger(L, 3)));
    return 1;
}

// report_figure(what, path, count)
static int report_figure(lua_State *L)
{
    const glintL_reporter *reporter = &glintL_get_run(L)->reporter;
    if (reporter->figure)
        reporter->figure(reporter->context, luaL_checkstring(L, 1), luaL_checkstring(L, 2), luaL_checkinteger(L, 3));
    return 0;
}

const luaL_Reg glintL_sweep_functions[] = {
    { "no_sheet_field", no_sheet_field }, { "is_colorbar", is_colorbar },   { "name_of_object", name_of_object },
    { "name_file", name_file },           { "note_written", note_written }, { "report_figure", report_figure },
    { NULL, NULL },
};

typedef struct sheet_call {
    const glintL_naming *naming;
    int64_t first;
    bool partial;
} sheet_call;

static int draw_protected(lua_State *L)
{
    const glintL_job *job = lua_touserdata(L, 1);
    const sheet_call *what = lua_touserdata(L, 2);
    const glintL_naming *naming = what->naming;
    glintL_run *run = glintL_get_run(L);
    glintL_render render = job->render;
    luaL_checkstack(L, 12, "sheet");
    glintL_run_apply(run, &render);
    lua_getiuservalue(L, 1, GLINTL_JOB_SHEET);
    lua_getiuservalue(L, 1, GLINTL_JOB_FRAME);
    lua_pushinteger(L, job->frames);
    lua_createtable(L, 0, 9);
    lua_pushlightuserdata(L, (void *)naming);
    lua_setfield(L, -2, "naming");
    glintL_render_push(L, glintL_render_find("passes"), &render);
    lua_setfield(L, -2, "rendered");
    glintL_set_text(L, "pattern", naming->film ? naming->film->path : naming->pattern);
    glintL_set_text(L, "live", run->live);
    glintL_set_number(L, "dpi", render.dpi);
    glintL_set_whole(L, "first", what->first);
    glintL_set_flag(L, "is_verbatim", naming->is_plain || naming->film);
    glintL_set_flag(L, "is_swept", run->point_count > 1);
    glintL_set_flag(L, "is_partial", what->partial);
    glintL_call_own(L, "sweep_sheet", "make", 4, 0);
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
