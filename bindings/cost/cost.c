// glint cost SCRIPT: what accuracy costs in time, for one frame of the user's own scene. The modules do the study; this
// file gives them the script's scene, the options, the terminal and the files.
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bindings/cost/cost.h"
#include "bindings/run/system.h"

#define NAME_MAX_BYTES 256 // room for the names of pictures in a path

static const char PAGE[] = {
#include "bindings/cost/page.html.h"
};
static const char STYLE[] = {
#include "bindings/cost/plot.css.h"
};
#include "bindings/cost/modules.h" // LIBRARY

cost_study *cost_study_of(lua_State *L) { return lua_touserdata(L, lua_upvalueindex(1)); }

// ---- Failures ----

// Raises nil: the run has failed, or a signal stopped it.
static int stop(lua_State *L)
{
    lua_pushnil(L);
    return lua_error(L);
}

int cost_fail(lua_State *L, const glint_error *error)
{
    if (error->status != GLINT_ERR_CANCELLED)
        glintL_run_fail(cost_study_of(L)->run, glintL_run_exit_code(error->status), 0, "%s", error->message);
    return stop(L);
}

static int refuse_option(lua_State *L, const char *option, const char *message)
{
    glintL_run_fail(cost_study_of(L)->run, GLINTL_EXIT_USAGE, 0, "%s%s", option, message);
    return stop(L);
}

static int out_of_memory(lua_State *L)
{
    glintL_run_fail(cost_study_of(L)->run, GLINTL_EXIT_FAILED, 0, "out of memory");
    return stop(L);
}

// refuse(message): fails the run, because an option is wrong.
static int refuse(lua_State *L) { return refuse_option(L, "", luaL_checkstring(L, 1)); }

// ---- The report's folder ----

static bool check_folder(const char *folder, char message[GLINTL_MESSAGE_SIZE])
{
    if (!*folder || strlen(folder) > GLINTL_PATH_SIZE - NAME_MAX_BYTES)
        return glintL_complain(message, "a folder to write to expected, got '%.200s'", folder);
    errno = 0;
    if (glintL_make_folders(folder) && access(folder, W_OK | X_OK) == 0)
        return true;
    const int why = errno;
    return glintL_complain(message, "a folder to write to expected, got '%.600s': %s", folder, strerror(why));
}

static glint_status remove_file(const char *path, glint_error *error)
{
    if (unlink(path) == 0 || errno == ENOENT)
        return GLINT_OK;
    *error = (glint_error) { .status = GLINT_ERR_IO };
    snprintf(error->message, sizeof error->message, "%.400s: %s", path, strerror(errno));
    return GLINT_ERR_IO;
}

// write(name, bytes): writes a file of the report; nil: removes it.
static int write_file(lua_State *L)
{
    const cost_study *study = cost_study_of(L);
    char path[GLINTL_PATH_SIZE];
    size_t size;
    const char *bytes = lua_tolstring(L, 2, &size);
    glint_error error;
    snprintf(path, sizeof path, "%s/%s", study->options->report, luaL_checkstring(L, 1));
    const glint_status status = bytes ? glintL_write_text(path, bytes, size, &error) : remove_file(path, &error);
    if (!status)
        return 0;
    glintL_run_fail(study->run, glintL_run_exit_code(status), 0, "--report: %s", error.message);
    return stop(L);
}

// ---- The scene ----

static bool read_scene(const cost_study *study)
{
    cli_script script;
    glintL_run *run = study->run;
    run->mode = GLINTL_MODE_EXPLAIN;
    run->explain_frame = study->options->frame;
    run->keeps_scene = true;
    glintL_selection_clear(&run->request.selection); // here --frame is not a selection
    cli_run_script(&script, study->options, run);
    cli_close_script(&script);
    if (!run->exit_code && !run->interrupted && !run->retained_scene)
        glintL_run_fail(run, GLINTL_EXIT_USAGE, 0,
                        "--frame: expected a frame of the script, 1 .. %" PRId64 ", got '%" PRId64 "'", run->count,
                        study->options->frame);
    return !run->exit_code && !run->interrupted;
}

static void add_options(lua_State *L, const cost_study *study)
{
    const cli_options *options = study->options;
    const glintL_run *run = study->run;
    glintL_set_flag(L, "quick", options->quick);
    glintL_set_flag(L, "json", options->json);
    glintL_set_text(L, "report", options->report);
    glintL_set_text(L, "knobs", options->knobs);
    glintL_set_number(L, "start_ms", study->output->start_ms);
    if (options->budget_s > 0)
        glintL_set_number(L, "deadline_ms", study->output->start_ms + options->budget_s * 1e3);
    glintL_set_text(L, "script", run->script);
    glintL_set_whole(L, "frame", run->explain_frame);
    if (run->call_count == 0)
        glintL_set_whole(L, "total", run->count);
    lua_pushlstring(L, PAGE, sizeof PAGE);
    lua_setfield(L, -2, "page");
    lua_pushlstring(L, STYLE, sizeof STYLE);
    lua_setfield(L, -2, "style");
}

// open(): runs the script. Returns the options, and the frame's scene and options as numbers that knobs read.
static int open_study(lua_State *L)
{
    cost_study *study = cost_study_of(L);
    const cli_options *options = study->options;
    char message[GLINTL_MESSAGE_SIZE];
    if (options->is_live && !options->report)
        return refuse_option(L, "--live: ", "expected together with --report DIR, whose page shows the live figure");
    if (options->report && !check_folder(options->report, message))
        return refuse_option(L, "--report: ", message);
    study->moments = cost_moments_open(&study->run->moments);
    if (!study->moments)
        return out_of_memory(L);
    if (!read_scene(study))
        return stop(L);
    study->own = &study->run->retained_render;
    if (!cost_scene_open(&study->scene, study->run->retained_scene))
        return out_of_memory(L);
    lua_newtable(L);
    add_options(L, study);
    cost_add_subject(L, study);
    return 1;
}

// ---- The course of the study ----

// live(): returns the HTML of --live for the page, or nil.
static int live(lua_State *L)
{
    const cost_study *study = cost_study_of(L);
    char message[GLINTL_MESSAGE_SIZE];
    int code = 0;
    if (!study->options->is_live)
        return 0;
    char *html = cli_live(study->options, &study->run->request, &code, message);
    if (!html) {
        glintL_run_fail(study->run, code, 0, "%s", message);
        return stop(L);
    }
    lua_pushstring(L, html);
    free(html);
    return 1;
}

// begin(): opens the progress bar and the renderers. Returns the description of the machine.
static int begin(lua_State *L)
{
    cost_study *study = cost_study_of(L);
    char model[128], machine[256];
    glint_error error;
    if (!study->output->quiet)
        study->output->progress = cli_progress_create(study->output->color);
    if (!cost_open_renderers(study, &error))
        return cost_fail(L, &error);
    const glint_renderer *renderer = study->renderers[false][false];
    const int threads = glint_renderer_threads(renderer);
    glintL_processor_name(model);
    snprintf(machine, sizeof machine, "%.100s, %d thread%s, %s, glint " GLINT_VERSION ", compiler %.40s", model,
             threads, threads == 1 ? "" : "s", glint_renderer_isa(renderer), __VERSION__);
    lua_pushstring(L, machine);
    return 1;
}

// finish(): closes the progress bar. Returns whether the run has not failed.
static int finish(lua_State *L)
{
    cost_study *study = cost_study_of(L);
    cli_progress_destroy(study->output->progress);
    study->output->progress = NULL;
    lua_pushboolean(L, !study->run->exit_code);
    return 1;
}

// say(text): prints a line for people.
static int say(lua_State *L)
{
    const cli_output *output = cost_study_of(L)->output;
    if (output->progress)
        cli_progress_clear(output->progress);
    if (!output->quiet)
        glintL_put_text(stderr, luaL_checkstring(L, 1), (size_t)luaL_len(L, 1));
    return 0;
}

// show(what, step_ms, remaining_ms): shows the current step on a terminal, with the expected time of this step and of
// the rest of the study. Raises nil if the run was stopped.
static int show(lua_State *L)
{
    const cost_study *study = cost_study_of(L);
    const char *what = luaL_checkstring(L, 1);
    const double step_ms = luaL_checknumber(L, 2), remaining_ms = luaL_checknumber(L, 3);
    if (study->output->progress)
        cli_progress_step(study->output->progress, what, glintL_now_ms() - study->output->start_ms, step_ms,
                          remaining_ms);
    return study->run->interrupted || study->run->exit_code ? stop(L) : 0;
}

// now(): returns the time in milliseconds.
static int now(lua_State *L)
{
    lua_pushnumber(L, glintL_now_ms());
    return 1;
}

// print(text): prints the results.
static int print(lua_State *L)
{
    size_t size;
    const char *text = luaL_checklstring(L, 1, &size);
    fwrite(text, 1, size, cost_study_of(L)->output->data);
    return 0;
}

static const luaL_Reg functions[] = {
    { "refuse", refuse }, { "open", open_study },  { "live", live },
    { "begin", begin },   { "finish", finish }, { "say", say },          { "show", show },
    { "now", now },       { "print", print },   { "write", write_file }, { NULL, NULL },
};

static void push_tools(lua_State *L, const void *context)
{
    const luaL_Reg *const lists[] = { functions, cost_measure_functions, cost_error_functions };
    const cost_study *study = context;
    lua_newtable(L);
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        lua_pushlightuserdata(L, (void *)study);
        luaL_setfuncs(L, lists[i], 1);
    }
    glintL_set_text(L, "knobs", study->options->knobs);
}

static void close_study(cost_study *study)
{
    for (int keeps = 0; keeps < 2; keeps++)
        for (int counts = 0; counts < 2; counts++)
            if (study->renderers[keeps][counts] != study->run->renderer)
                glint_renderer_destroy(study->renderers[keeps][counts]);
    cost_moments_close(study->moments);
    glint_reference_destroy(study->references[0]);
    glint_reference_destroy(study->references[1]);
    cost_scene_close(&study->scene);
}

int cli_cost(cli_options *options, cli_output *output, glintL_run *run)
{
    cost_study study = { .output = output, .run = run, .options = options };
    char message[GLINTL_MESSAGE_SIZE];
    glintL_made_text made;
    if (!glintL_make_text(LIBRARY, sizeof LIBRARY / sizeof *LIBRARY, "study", push_tools, &study, &made, message) &&
        !run->interrupted)
        glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "%s", message);
    glintL_drop_text(&made);
    cli_progress_destroy(output->progress);
    output->progress = NULL;
    if (run->interrupted)
        cli_report_error(output, 0, 128 + (int)run->interrupted, "interrupted");
    else if (run->exit_code)
        cli_report_error(output, 0, run->exit_code, run->message);
    close_study(&study);
    return run->exit_code;
}
