// glint sheet FILES -o SHEET and glint assemble FILES -o FILM: figures made from finished frames. The Lua modules read
// the options and list the files.
#include <stdlib.h>

#include "bindings/command/cli.h"
#include "bindings/run/film.h"
#include "bindings/run/sheet.h"
#include "engine/glint_figures.h"

static const unsigned char SHEET_LUA[] = {
#include "bindings/command/sheet.lua.h"
};
static const unsigned char ASSEMBLE_LUA[] = {
#include "bindings/command/assemble.lua.h"
};

// ---- Sheets ----

// colormaps(): returns the names of the colour maps, and the size of a colour bar's title, bytes.
static int colormaps(lua_State *L)
{
    lua_newtable(L);
    for (int map = 0; map < GLINT_COLORMAP_COUNT; map++) {
        lua_pushstring(L, glint_colormap_name((glint_colormap)map));
        lua_rawseti(L, -2, map + 1);
    }
    lua_pushinteger(L, GLINT_OVERLAY_TEXT_SIZE);
    return 2;
}

// Reads the colour bar at `index`, as sheet.lua describes it.
static glint_overlay_desc read_colorbar(lua_State *L, int index)
{
    glint_overlay_desc bar = glint_overlay_desc_default(GLINT_OVERLAY_COLORBAR);
    lua_getfield(L, index, "map");
    bar.map = (glint_colormap)(lua_tointeger(L, -1) - 1);
    lua_getfield(L, index, "low");
    bar.low = lua_tonumber(L, -1);
    lua_getfield(L, index, "high");
    bar.high = lua_tonumber(L, -1);
    lua_getfield(L, index, "title");
    snprintf(bar.text, sizeof bar.text, "%s", lua_tostring(L, -1));
    return bar;
}

// sheet(description): makes the sheet, see bindings/run/sheet.lua.
static int sheet(lua_State *L)
{
    const cli_task *task = cli_task_of(L);
    const cli_options *options = task->options;
    char message[GLINTL_MESSAGE_SIZE];
    int code = GLINTL_EXIT_FAILED;
    glint_overlay_desc bar;
    lua_settop(L, 1);
    if (lua_getfield(L, 1, "colorbar") == LUA_TTABLE) {
        bar = read_colorbar(L, 2);
        lua_pushlightuserdata(L, &bar);
        lua_setfield(L, 1, "colorbar");
    }
    lua_getfield(L, 1, "files");
    const size_t count = lua_rawlen(L, -1);
    char *live = options->is_live ? cli_live(options, &options->request, &code, message) : NULL;
    if (options->is_live && !live)
        return cli_task_fail(L, code, message);
    lua_settop(L, 1);
    glintL_set_text(L, "live", live);
    free(live);
    code = glintL_sheet_make(L, message);
    if (code)
        return cli_task_fail(L, code, message);
    if (*message)
        cli_print_warning(task->output, message);
    cli_reporter(task->output).figure(task->output, "sheet", options->output, (int64_t)count);
    return 0;
}

int cli_sheet(cli_options *options, cli_output *output, glintL_run *run)
{
    static const luaL_Reg functions[] = { { "colormaps", colormaps }, { "sheet", sheet }, { NULL, NULL } };
    const glintL_carried modules[] = { cli_files_module, { "@sheet.lua", SHEET_LUA, sizeof SHEET_LUA } };
    cli_task task = { .name = "sheet", .options = options, .output = output, .run = run, .functions = functions };
    return cli_run_module(&task, modules, 2);
}

// ---- Films ----

// film_kind(path): returns the kind of a film.
static int film_kind(lua_State *L)
{
    static const char *const kinds[] = { "none", "apng", "mp4", "webm", "gif" }; // see glintL_film_kind
    lua_pushstring(L, kinds[glintL_film_kind_of(luaL_checkstring(L, 1), true)]);
    return 1;
}

// assemble(files): makes the film.
static int assemble(lua_State *L)
{
    const cli_task *task = cli_task_of(L);
    glintL_run *run = task->run;
    char message[GLINTL_MESSAGE_SIZE], *path = (char *)(uintptr_t)task->options->output; // read only
    glintL_film made = { .path = path, .kind = glintL_film_kind_of(path, true) };
    made.fps = run->request.fps > 0 ? run->request.fps : 24;
    made.files = cli_push_files(L, 1, &made.count);
    int code = GLINTL_EXIT_USAGE;
    if (glintL_film_check_files(&made, !run->request.force, message))
        code = glintL_film_make(run, &made, message);
    if (code || run->interrupted)
        return cli_task_fail(L, code, message);
    run->reporter.figure(run->reporter.context, "film", path, (int64_t)made.count);
    return 0;
}

int cli_assemble(cli_options *options, cli_output *output, glintL_run *run)
{
    static const luaL_Reg functions[] = { { "film_kind", film_kind }, { "assemble", assemble }, { NULL, NULL } };
    const glintL_carried modules[] = { cli_files_module, { "@assemble.lua", ASSEMBLE_LUA, sizeof ASSEMBLE_LUA } };
    cli_task task = { .name = "assemble", .options = options, .output = output, .run = run, .functions = functions };
    if (!output->quiet)
        output->progress = cli_progress_create(output->color);
    cli_run_module(&task, modules, 2);
    cli_progress_destroy(output->progress);
    output->progress = NULL;
    return task.code;
}
