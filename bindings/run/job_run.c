// animation:run{...} and sweep:run{...}: render the frames of one job from a script. The command line still takes
// precedence.
#include <stdio.h>
#include <string.h>

#include "bindings/run/film.h"

static const glintL_field OPTIONS[] = {
    { .name = "frames" }, { .name = "shard" },  { .name = "threads" },
    { .name = "force" },  { .name = "repeat" }, { .name = NULL },
};

static int read_count(lua_State *L, int index, const char *path, const char *expected, int max)
{
    double count = glintL_read_number(L, index, path);
    if (!(count >= 1 && count <= max) || count != (int)count)
        glintL_refuse(L, index, path, expected);
    return (int)count;
}

// Reads one option. `frames` and `shard` are only checked to be strings; parse_selection reads them.
static void read_option(lua_State *L, int index, const char *name, glintL_request *request, glintL_render *render)
{
    char path[48];
    int field = glintL_render_find(name);
    snprintf(path, sizeof path, "run.%s", name);
    if (field >= 0) {
        glintL_render_read(L, index, "run.", field, render);
    } else if (strcmp(name, "threads") == 0) {
        request->threads = read_count(L, index, path, "whole number 1 .. 1024", 1024);
    } else if (strcmp(name, "repeat") == 0) {
        request->repeat = read_count(L, index, path, "whole number 1 .. 1000000", 1000000);
    } else if (strcmp(name, "force") == 0) {
        if (!lua_isboolean(L, index))
            glintL_refuse(L, index, path, "boolean");
        request->force = lua_toboolean(L, index);
    } else if (strcmp(name, "frames") == 0 || strcmp(name, "shard") == 0) {
        if (lua_type(L, index) != LUA_TSTRING && !(lua_isinteger(L, index) && name[0] == 'f'))
            glintL_refuse(L, index, path, name[0] == 'f' ? "frames such as \"1-3,5\"" : "shard such as \"1/4\"");
    } else {
        const char *near = glintL_nearest(name, OPTIONS);
        for (const glintL_field *f = glintL_render_fields; f->name; f++)
            near = glintL_nearer(name, near, f->name);
        glintL_no_such_field(L, "run", name, near);
    }
}

static void read_options(lua_State *L, int index, glintL_request *request, glintL_render *render)
{
    if (lua_isnoneornil(L, index))
        return;
    if (!lua_istable(L, index))
        glintL_refuse(L, index, "run", "table");
    lua_pushnil(L);
    while (lua_next(L, index)) {
        if (lua_type(L, -2) != LUA_TSTRING)
            glintL_bad_key(L, "run", -2);
        read_option(L, lua_gettop(L), lua_tostring(L, -2), request, render);
        lua_pop(L, 1);
    }
}

// Reads `frames` and `shard` from the table at 2, which read_option has checked. The selection owns memory, so nothing
// may raise after it is filled. False: the message is written.
static bool parse_selection(lua_State *L, glintL_selection *selection, char message[GLINTL_MESSAGE_SIZE])
{
    bool good = true;
    if (!lua_istable(L, 2))
        return true;
    lua_pushliteral(L, "frames");
    lua_rawget(L, 2);
    const char *frames = lua_tostring(L, -1);
    lua_pushliteral(L, "shard");
    lua_rawget(L, 2);
    const char *shard = lua_tostring(L, -1);
    if (frames)
        good = glintL_selection_parse(selection, frames, message);
    if (good && shard)
        good = glintL_selection_parse_shard(selection, shard, message);
    lua_pop(L, 2);
    return good;
}

static int run_protected(lua_State *L)
{
    bool *good = lua_touserdata(L, 2);
    *good = glintL_jobs_run(L, 1, glintL_get_run(L));
    return 0;
}

// Runs the list at `list`, whose only element is the job at 1, with `request`; then restores the run and the job. Does
// not raise.
static bool run_as(lua_State *L, glintL_run *run, int list, const glintL_request *request, const glintL_render *render)
{
    glintL_job *job = lua_touserdata(L, 1);
    glintL_request before = run->request;
    glintL_render render_before = job->render;
    // A later run of the script may need the command line's selection.
    bool is_own = request->selection.ranges != before.selection.ranges;
    bool good = false;
    run->request = *request;
    job->render = *render;
    lua_pushcfunction(L, run_protected);
    lua_pushvalue(L, list);
    lua_pushlightuserdata(L, &good);
    if (is_own && !glintL_selection_settle(run, run->count + 1, run->count + job->frames))
        lua_pop(L, 3);
    else if (lua_pcall(L, 2, 0, 0) != LUA_OK)
        good = glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "%s", lua_tostring(L, -1));
    if (!run->is_command) {
        good = glintL_run_collect(run, true) && good;
        good = good && glintL_films_finish(run);
    }
    job->render = render_before;
    run->request = before;
    return good;
}

static int push_summary(lua_State *L, const glintL_run *run, double start_ms)
{
    lua_createtable(L, 0, 3);
    glintL_set_whole(L, "frames", run->done);
    glintL_set_whole(L, "kept", run->kept);
    glintL_set_number(L, "seconds", (glintL_now_ms() - start_ms) * 1e-3);
    return 1;
}

// Begins a run in plain Lua. Without a command line, each run numbers its frames from 1.
static void begin_plain(glintL_run *run)
{
    glintL_films_destroy(run->films);
    run->films = NULL;
    run->exit_code = 0;
    run->count = run->call_count = run->earlier = 0;
    run->todo = run->done = run->kept = 0;
    run->brightness = (glint_brightness) { 0 };
}

// Chooses the command line's selection if there is one, otherwise the script's. False: the message is written.
static bool merge(lua_State *L, const glintL_run *run, glintL_request *request, char message[GLINTL_MESSAGE_SIZE])
{
    const glintL_selection *given = &run->request.selection;
    request->selection = (glintL_selection) { 0 };
    if (!parse_selection(L, &request->selection, message)) {
        glintL_selection_clear(&request->selection);
        return false;
    }
    if (given->range_count || given->shard_count) {
        glintL_selection_clear(&request->selection);
        request->selection = *given;
    }
    if (run->is_command) {
        request->threads = run->request.threads ? run->request.threads : request->threads;
        request->repeat = run->request.repeat > 1 ? run->request.repeat : request->repeat;
        request->force = run->request.force || request->force;
    }
    return true;
}

int glintL_job_run(lua_State *L)
{
    glintL_run *run = glintL_get_run(L);
    const glintL_job *job = luaL_checkudata(L, 1, GLINTL_ANIMATION);
    glintL_request request = run->request;
    glintL_render render = job->render;
    char message[GLINTL_MESSAGE_SIZE];
    double start = glintL_now_ms();
    lua_settop(L, 2);
    luaL_checkstack(L, 16, "run");
    if (run->mode == GLINTL_MODE_DESCRIBE)
        return glintL_stop_script(L);
    if (run->in_frame)
        return glintL_error(L, "run: not inside the frame function of an animation");
    glintL_check_may_render(L, run);
    if (glintL_push_unknown_set(L))
        return lua_error(L);
    read_options(L, 2, &request, &render);
    lua_newtable(L); // 3
    lua_pushvalue(L, 1);
    lua_rawseti(L, 3, 1);
    if (run->mode == GLINTL_MODE_EXPLAIN) {
        if (glintL_jobs_explain(L, 3, run))
            return glintL_stop_script(L);
        return run->exit_code ? glintL_error(L, "%s", run->message) : 0;
    }
    if (!run->is_command)
        begin_plain(run);
    if (!merge(L, run, &request, message))
        return glintL_error(L, "run: %s", message);
    bool good = !run->exit_code && glintL_call_settle(run) && run_as(L, run, 3, &request, &render);
    if (request.selection.ranges != run->request.selection.ranges)
        glintL_selection_clear(&request.selection);
    if (!good) {
        lua_pushstring(L, run->interrupted ? "interrupted" : run->message); // contains the position, as far as known
        return lua_error(L);
    }
    return push_summary(L, run, start);
}
