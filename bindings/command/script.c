// Runs a script: makes its Lua state, sets its module path, takes its results.
#include <errno.h>
#include <lualib.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bindings/command/untrusted.h"
#include "bindings/run/system.h"

#define UNTRUSTED_LUA_MEMORY ((size_t)64 << 20)

typedef struct task { // argument of the protected function
    cli_script *script;
    const cli_options *options;
    glintL_run *run;
} task;

static void set_arguments(lua_State *L, const cli_options *options)
{
    lua_createtable(L, options->argument_count, 1);
    lua_pushstring(L, options->script);
    lua_rawseti(L, -2, 0);
    for (int i = 0; i < options->argument_count; i++) {
        lua_pushstring(L, options->arguments[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setglobal(L, "arg");
}

// Adds templates to the front or the end of package.path; `package` is at index 1. A folder with ';' or '?' is skipped,
// since Lua would misread it.
static void add_path(lua_State *L, const char *folder, const char *templates, bool first)
{
    if (strpbrk(folder, ";?"))
        return;
    luaL_gsub(L, templates, "@", folder);
    lua_getfield(L, 1, "path");
    lua_pushfstring(L, "%s;%s", lua_tostring(L, first ? -2 : -1), lua_tostring(L, first ? -1 : -2));
    lua_setfield(L, 1, "path");
    lua_pop(L, 2);
}

// Adds the modules that were installed with this command (PREFIX/share next to PREFIX/bin). The order is: LUA_PATH,
// these modules, then modules installed elsewhere. A build that is not installed uses the modules of its source tree.
static void add_own_modules(lua_State *L, const char *program)
{
    char folder[GLINTL_PATH_SIZE], probe[GLINTL_PATH_SIZE + 64];
    if (!glintL_program_folder(program, folder, sizeof folder))
        return;
    snprintf(probe, sizeof probe, "%s../share/lua/5.4/glint/particles.lua", folder);
    const bool first = !getenv("LUA_PATH_5_4") && !getenv("LUA_PATH");
    if (access(probe, R_OK) == 0) {
        add_path(L, folder, "@../share/lua/5.4/?.lua", first);
        return;
    }
    snprintf(probe, sizeof probe, "%s../scripts/lib/glint/particles.lua", folder);
    if (access(probe, R_OK) == 0) // build/glint in its source tree
        add_path(L, folder, "@../scripts/lib/?.lua", first);
}

// Puts the script's folder and its lib/ first in the module path.
static void set_path(lua_State *L, const cli_options *options)
{
    const char *script = options->script, *base = glintL_base_name(script);
    lua_getglobal(L, "package");
    add_own_modules(L, options->program);
    lua_pushlstring(L, script, (size_t)(base - script));
    add_path(L, base > script ? lua_tostring(L, -1) : "./", "@?.lua;@lib/?.lua", true);
    lua_settop(L, 0);
}

static void open_libraries(lua_State *L, const task *work)
{
    if (work->options->untrusted_s > 0) {
        cli_open_untrusted(L, work->run);
        set_arguments(L, work->options);
        return;
    }
    luaL_openlibs(L);
    glintL_attach_run(L, work->run);
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_PRELOAD_TABLE);
    glintL_set_function(L, "glint", luaopen_glint);
    lua_settop(L, 0);
    set_arguments(L, work->options);
    set_path(L, work->options);
    cli_carry_dialect(L);
}

static int refuse_results(lua_State *L, int count)
{
    lua_pushfstring(L, "the script returned %d values; a list { ... } of them is expected", count);
    return lua_error(L);
}

static int refuse_silence(lua_State *L, const cli_options *options)
{
    if (options->dialect)
        lua_pushfstring(L, "%s rendered nothing; expected it to call %s.render", glintL_base_name(options->script),
                        options->dialect);
    else
        lua_pushfstring(L,
                        "%s returned nothing and rendered nothing; expected it to return an animation, a sweep, a "
                        "scene, a chart or a list of them, or to call scene:render",
                        glintL_base_name(options->script));
    return lua_error(L);
}

// Takes the script's results from the stack, 1 ..
static void take_results(lua_State *L, const task *work)
{
    glintL_run *run = work->run;
    cli_script *script = work->script;
    if (work->options->dialect)
        lua_settop(L, 0); // scripts that render by calls may return anything
    int count = lua_gettop(L);
    luaL_checkstack(L, 8, "jobs");
    if (glintL_push_unknown_set(L))
        lua_error(L);
    if (count > 1)
        refuse_results(L, count);
    if (lua_isnoneornil(L, 1)) {
        if (run->mode != GLINTL_MODE_DESCRIBE && run->call_count == 0 && run->earlier == 0 && run->count == 0)
            refuse_silence(L, work->options);
        return;
    }
    if (!glintL_push_jobs(L, 1))
        lua_error(L);
    lua_replace(L, 1);
    lua_settop(L, 1);
    script->has_jobs = true;
    script->frames = glintL_jobs_total(L, 1);
}

// Checks that a script under --sweep returns frames either at every value or at none.
static bool check_sweep(const task *work)
{
    glintL_run *run = work->run;
    return run->point_count == 0 || run->mode != GLINTL_MODE_RENDER ||
           glintL_run_fail(run, GLINTL_EXIT_USAGE, 0,
                           "--sweep: the script both calls scene:render and returns frames; expected only one of the "
                           "two");
}

// Runs the jobs in the list at 1.
static void run_results(lua_State *L, const task *work)
{
    if (work->run->mode == GLINTL_MODE_WATCH) {
        work->script->jobs = luaL_ref(L, LUA_REGISTRYINDEX);
    } else if (work->run->mode == GLINTL_MODE_EXPLAIN) {
        glintL_jobs_explain(L, 1, work->run);
    } else if (work->run->mode == GLINTL_MODE_RENDER) {
        if (!glintL_selection_settle(work->run, 1, work->run->count + work->script->frames))
            return;
        glintL_call_settle(work->run);
        glintL_jobs_run(L, 1, work->run);
    }
}

static bool is_picture(const char *path)
{
    static const char png[] = "\x89PNG\r\n\x1a\n";
    char begins[sizeof png - 1];
    FILE *file = fopen(path, "rb");
    const bool is = file && fread(begins, sizeof begins, 1, file) == 1 && memcmp(begins, png, sizeof begins) == 0;
    if (file)
        fclose(file);
    return is;
}

// Loads a script, from standard input if its name is "-". Rejects endless input.
static int load_script(lua_State *L, const char *path)
{
    const bool is_input = strcmp(path, "-") == 0;
    const char *other = is_input ? NULL : glintL_other_kind(path);
    if (other)
        lua_pushfstring(L, "%s: a script expected, got a %s", path, other);
    else if (!is_input && is_picture(path))
        lua_pushfstring(L, "%s: a script expected, got a PNG (glint reproduce %s renders it again)", path, path);
    else if (luaL_loadfilex(L, is_input ? NULL : path, "t") == LUA_OK)
        return LUA_OK;
    else if (strncmp(lua_tostring(L, -1), "attempt to load", 15) == 0) // the only message without the file's name
        lua_pushfstring(L, "%s: a script expected, got compiled Lua", is_input ? "stdin" : path);
    return LUA_ERRFILE;
}

static int run_protected(lua_State *L)
{
    const task *work = lua_touserdata(L, 1);
    lua_settop(L, 0);
    open_libraries(L, work);
    cli_set_state(L);
    if (work->run->measures)
        cli_hush_script(L);
    if (work->run->reporter.prepare)
        work->run->reporter.prepare(work->run->reporter.context, L);
    cli_open_dialect(L, work->options);
    if (load_script(L, work->options->script) != LUA_OK)
        return lua_error(L);
    work->run->since_ms = glintL_now_ms();
    lua_call(L, 0, LUA_MULTRET);
    take_results(L, work);
    if (work->script->has_jobs && check_sweep(work))
        run_results(L, work);
    if (work->run->mode == GLINTL_MODE_RENDER && !work->run->exit_code && !work->run->interrupted)
        glintL_report_observed(L, work->run, work->options->script);
    return 0;
}

// Suggests --dialect for a scene of the dialect that failed at its first use of the dialect's global.
static const char *dialect_hint(const cli_options *options, const char *message)
{
    return !options->dialect && strstr(message, "(global 'gr')") ? "; is it a scene for --dialect gr?" : "";
}

// Suggests a command with a similar name, or the script with its extension, when the script does not exist.
static const char *missing_hint(const cli_options *options, char out[GLINTL_PATH_SIZE + 32])
{
    char path[GLINTL_PATH_SIZE];
    const char *word = options->script;
    if (options->untrusted_s > 0 || strcmp(word, "-") == 0 || access(word, F_OK) == 0 || errno != ENOENT || strlen(word) > sizeof path - 5)
        return "";
    snprintf(path, sizeof path, "%s.lua", word);
    if (access(path, F_OK) == 0)
        snprintf(out, GLINTL_PATH_SIZE + 32, "; did you mean %s?", path);
    else if (options->command == CLI_RENDER && !strpbrk(word, "./"))
        return "; there is no command of this name either; glint --help lists the commands";
    else
        return "";
    return out;
}

bool cli_run_script(cli_script *script, const cli_options *options, glintL_run *run)
{
    task work = { script, options, run };
    run->is_dialect = options->dialect != NULL;
    *script = (cli_script) { .memory.most = UNTRUSTED_LUA_MEMORY };
    script->state = options->untrusted_s > 0 ? cli_untrusted_state(&script->memory) : luaL_newstate();
    lua_State *L = script->state;
    if (!L)
        return glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "out of memory");
    lua_pushcfunction(L, glintL_message_handler);
    lua_pushcfunction(L, run_protected);
    lua_pushlightuserdata(L, &work);
    int status = lua_pcall(L, 1, 0, 1);
    if (status != LUA_OK && !run->is_stopped && !run->interrupted) {
        char hint[GLINTL_PATH_SIZE + 32];
        const char *message = lua_tostring(L, -1);
        glintL_run_fail(run, glintL_script_exit(run, status), 0, "%s%s%s", message, dialect_hint(options, message),
                        missing_hint(options, hint));
    }
    return status == LUA_OK && !run->exit_code && !run->interrupted;
}

static int run_jobs_protected(lua_State *L)
{
    const task *work = lua_touserdata(L, 1);
    lua_rawgeti(L, LUA_REGISTRYINDEX, work->script->jobs);
    glintL_jobs_run(L, 2, work->run);
    return 0;
}

bool cli_run_jobs(cli_script *script, glintL_run *run)
{
    task work = { script, NULL, run };
    lua_State *L = script->state;
    lua_settop(L, 0);
    lua_pushcfunction(L, glintL_message_handler);
    lua_pushcfunction(L, run_jobs_protected);
    lua_pushlightuserdata(L, &work);
    if (lua_pcall(L, 1, 0, 1) != LUA_OK && !run->interrupted)
        glintL_run_fail(run, GLINTL_EXIT_FAILED, 0, "%s", lua_tostring(L, -1));
    return !run->exit_code && !run->interrupted;
}

void cli_close_script(cli_script *script)
{
    cli_set_state(NULL);
    if (script->state)
        lua_close(script->state);
    script->state = NULL;
}
