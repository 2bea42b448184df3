// glint reproduce FILE SCRIPT: renders the frame of a finished file again, with the options stored in the file, and
// compares the two. The Lua module reads the texts of the files; this file renders to a temporary folder.
#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bindings/command/cli.h"
#include "engine/glint_compare.h"

#define UNREADABLE 5 // exit code: no whole picture with a key

static const unsigned char REPRODUCE_LUA[] = {
#include "bindings/command/reproduce.lua.h"
};

typedef struct reproduction {
    char folder[256]; // temporary folder of the new file
    char output[300]; // the new file's name pattern
    char *made[GLINTL_PASSES_MAX + 1]; // owned names of the new files by pass; for light passes only the last one
    bool lacks_memory; // a name in `made` could not be allocated
} reproduction;

// ---- Requesting the frame ----

// Keeps the value on top of the stack until the end of the command, and pops it.
static void keep(lua_State *L) { luaL_ref(L, LUA_REGISTRYINDEX); }

// set_params(sets, swept): sets the parameters, a list of { name, text }; the last `swept` ones are swept.
static int set_params(lua_State *L)
{
    glintL_request *request = &cli_task_of(L)->run->request;
    for (lua_Integer i = 1, count = luaL_len(L, 1); i <= count; i++) {
        lua_rawgeti(L, 1, i);
        lua_getfield(L, -1, "name");
        lua_getfield(L, -2, "text");
        if (!cli_add_set(request, lua_tostring(L, -2), lua_tostring(L, -1)))
            return cli_task_fail(L, GLINTL_EXIT_FAILED, "out of memory");
        lua_pop(L, 3);
    }
    request->swept_count = (size_t)luaL_checkinteger(L, 2);
    lua_settop(L, 1);
    keep(L);
    return 0;
}

// set_option(name, text): sets a render option, if it is one.
static int set_option(lua_State *L)
{
    const int field = glintL_render_find(luaL_checkstring(L, 1));
    if (field >= 0)
        cli_task_of(L)->run->request.render_text[field] = luaL_checkstring(L, 2);
    lua_settop(L, 2);
    keep(L);
    return 0;
}

// check(frame): selects the frame. Returns what is wrong with the frame or the options; nothing if they are good.
static int check(lua_State *L)
{
    glintL_request *request = &cli_task_of(L)->run->request;
    glintL_render scratch = glintL_render_default();
    char message[GLINTL_MESSAGE_SIZE];
    bool good = glintL_selection_parse(&request->selection, luaL_checkstring(L, 1), message);
    for (int field = 0; field < GLINTL_RENDER_FIELDS && good; field++)
        good = !request->render_text[field] ||
               glintL_render_set_text(&scratch, field, request->render_text[field], message);
    lua_pushstring(L, message);
    return good ? 0 : 1;
}

// ---- Rendering to a temporary folder ----

static const char *host_name(void)
{
    static char host[32];
    if (gethostname(host, sizeof host) != 0)
        host[0] = '\0';
    host[sizeof host - 1] = '\0';
    for (char *c = host; *c; c++)
        *c = *c == '/' ? '-' : *c;
    return host;
}

static void remove_folder(const char *path)
{
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder && (entry = readdir(folder));)
        unlinkat(dirfd(folder), entry->d_name, 0); // does not remove folders, such as "."
    if (folder)
        closedir(folder);
    rmdir(path);
}

// Removes the folders that killed processes on this host left.
static void collect_folders(const char *temporary)
{
    char prefix[48], path[512];
    DIR *folder = opendir(temporary);
    const int length = snprintf(prefix, sizeof prefix, "glint.%s.", host_name());
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        struct stat info;
        char *end = NULL;
        if (strncmp(entry->d_name, prefix, (size_t)length) != 0)
            continue;
        const long process = strtol(entry->d_name + length, &end, 10);
        if (process <= 0 || *end != '.' || kill((pid_t)process, 0) == 0 || errno != ESRCH)
            continue;
        snprintf(path, sizeof path, "%.200s/%.300s", temporary, entry->d_name);
        if (lstat(path, &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == geteuid())
            remove_folder(path);
    }
    if (folder)
        closedir(folder);
}

static void open_folder(lua_State *L, reproduction *r)
{
    const char *temporary = getenv("TMPDIR");
    temporary = temporary && *temporary ? temporary : "/tmp";
    collect_folders(temporary);
    snprintf(r->folder, sizeof r->folder, "%.180s/glint.%s.%ld.XXXXXX", temporary, host_name(), (long)getpid());
    if (!mkdtemp(r->folder)) {
        lua_pushfstring(L, "%s: cannot create this folder", r->folder);
        r->folder[0] = '\0';
        cli_task_fail(L, GLINTL_EXIT_FAILED, lua_tostring(L, -1));
    }
    snprintf(r->output, sizeof r->output, "%s/%%04d.png", r->folder);
}

static void take_frame(void *context, const glintL_run *run, const glintL_record *record)
{
    reproduction *r = context;
    (void)run;
    for (int pass = 0; pass <= GLINTL_PASSES_MAX && pass < record->slots; pass++) {
        free(r->made[pass]);
        r->made[pass] = record->files[pass] ? strdup(record->files[pass]) : NULL;
        r->lacks_memory = r->lacks_memory || (record->files[pass] && !r->made[pass]);
    }
}

// Runs the script. Fails if the run fails.
static void run_script(lua_State *L, const cli_task *task)
{
    glintL_run *run = task->run;
    const glintL_request *request = &run->request;
    cli_script script;
    bool good = cli_run_script(&script, task->options, run) && glintL_call_settle(run);
    cli_close_script(&script);
    good = glintL_run_collect(run, true) && good;
    for (size_t i = 0; i < request->set_count; i++)
        if (!good && !request->sets[i].is_known && strstr(run->message, "--set ")) {
            lua_pushfstring(L, "%s: has no parameter '%s', but %s was rendered with it", run->script,
                            request->sets[i].name, task->options->file);
            cli_task_fail(L, GLINTL_EXIT_USAGE, lua_tostring(L, -1));
        }
    if (run->exit_code || run->interrupted)
        cli_task_fail(L, run->exit_code ? run->exit_code : GLINTL_EXIT_FAILED, run->message);
}

static glint_pass pass_of(const char *name)
{
    if (strncmp(name, "d:", 2) == 0)
        return GLINT_PASS_DERIVATIVE; // the only derivative
    if (strncmp(name, "light:", 6) == 0)
        return GLINT_PASS_LIGHT; // the only light pass
    return *name ? glint_pass_from_name(name) : GLINT_PASS_BEAUTY;
}

// render(pass, frame): renders the requested frame. Returns the path of the new file.
static int render(lua_State *L)
{
    const cli_task *task = cli_task_of(L);
    glintL_run *run = task->run;
    reproduction *r = task->own;
    const char *name = luaL_checkstring(L, 1);
    const glint_pass pass = pass_of(name);
    open_folder(L, r);
    run->request.render_text[glintL_render_find("output")] = r->output;
    run->request.render_text[glintL_render_find("passes")] = *name ? name : "none";
    run->request.force = true;
    run->no_sheets = true;
    run->reporter = (glintL_reporter) { .context = r, .frame = take_frame };
    run_script(L, task);
    const char *path = pass <= GLINTL_PASSES_MAX ? r->made[pass] : NULL;
    if (!path && r->lacks_memory)
        return cli_task_fail(L, GLINTL_EXIT_FAILED, "out of memory");
    lua_pushstring(L, path);
    if (path)
        return 1;
    lua_pushfstring(L, "%s: has no frame %s", run->script, luaL_checkstring(L, 2));
    return cli_task_fail(L, GLINTL_EXIT_USAGE, lua_tostring(L, -1));
}

// ---- Comparing ----

// read(path): returns the picture of a file.
static int read_picture(lua_State *L)
{
    glint_error error;
    return cli_push_picture(L, luaL_checkstring(L, 1), false, &error) ? 1 : cli_task_fail(L, UNREADABLE, error.message);
}

// compare(path, path): returns the largest difference of two pictures, what is wrong or nil, and the second picture.
static int compare(lua_State *L)
{
    const char *had = luaL_checkstring(L, 1), *path = luaL_checkstring(L, 2);
    const glint_compare_desc desc = { .fail = 0, .warn = 0 };
    glint_compare_result result = { 0 };
    glint_error error;
    const bool good = cli_push_picture(L, path, false, &error) && !glint_compare_files(had, path, &desc, &result, &error);
    lua_pushnumber(L, result.max_error);
    lua_pushstring(L, good ? NULL : error.message);
    lua_pushvalue(L, 3);
    return 3;
}

// ---- The command ----

static void clean_up(reproduction *r)
{
    for (int pass = 0; pass <= GLINTL_PASSES_MAX; pass++) {
        if (r->made[pass])
            unlink(r->made[pass]); // normally the only files in the folder; needs no memory to list it
        free(r->made[pass]);
    }
    if (*r->folder && rmdir(r->folder) != 0)
        remove_folder(r->folder);
}

int cli_reproduce(cli_options *options, cli_output *output, glintL_run *run)
{
    static const luaL_Reg functions[] = {
        { "read", read_picture },     { "text", cli_picture_text }, { "set_params", set_params },
        { "set_option", set_option }, { "check", check },           { "render", render },
        { "compare", compare },       { NULL, NULL },
    };
    static const glintL_carried module = { "@reproduce.lua", REPRODUCE_LUA, sizeof REPRODUCE_LUA };
    reproduction r = { .folder = "" };
    cli_task task = { NULL, options, output, run, functions, &r, 0 };
    cli_run_module(&task, &module, 1);
    clean_up(&r);
    return task.code;
}
