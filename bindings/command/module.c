// Runs the commands whose logic is in Lua modules, and gives the modules the command line and the output.
#include <stdlib.h>

#include "bindings/command/cli.h"

cli_task *cli_task_of(lua_State *L) { return lua_touserdata(L, lua_upvalueindex(1)); }

static void report(cli_task *task, int code, const char *message)
{
    char full[GLINTL_MESSAGE_SIZE + 32];
    const bool is_stopped = task->run && task->run->interrupted;
    snprintf(full, sizeof full, "%s%s%s", task->name ? task->name : "", task->name ? ": " : "", message);
    if (is_stopped)
        cli_report_error(task->output, 0, 128 + (int)task->run->interrupted, "interrupted");
    else
        cli_report_error(task->output, 0, code, full);
    task->code = code;
}

int cli_task_fail(lua_State *L, int code, const char *message)
{
    cli_task *task = cli_task_of(L);
    report(task, code, message);
    lua_pushnil(L);
    return lua_error(L);
}

// fail(code, message): reports the failure and ends the module.
static int fail(lua_State *L) { return cli_task_fail(L, (int)luaL_checkinteger(L, 1), luaL_checkstring(L, 2)); }

// print(text): prints results.
static int print(lua_State *L)
{
    size_t size;
    const char *text = luaL_checklstring(L, 1, &size);
    glintL_put_text(cli_task_of(L)->output->data, text, size);
    return 0;
}

// event(text): prints an event, for programs.
static int event(lua_State *L)
{
    cli_output *output = cli_task_of(L)->output;
    fputs(luaL_checkstring(L, 1), output->data);
    cli_end_line(output);
    return 0;
}

// say(text): prints a message for people.
static int say(lua_State *L)
{
    size_t size;
    const char *text = luaL_checklstring(L, 1, &size);
    if (!cli_task_of(L)->output->quiet)
        glintL_put_text(stderr, text, size);
    return 0;
}

static void set_functions(lua_State *L, const cli_task *task, const luaL_Reg *functions)
{
    lua_pushlightuserdata(L, (void *)task);
    luaL_setfuncs(L, functions, 1);
}

// Pushes the argument of the module's function.
static void push_command(lua_State *L, const void *context)
{
    static const luaL_Reg common[] = {
        { "fail", fail }, { "print", print },            { "event", event },
        { "say", say },   { "number", cli_read_number }, { NULL, NULL },
    };
    const cli_task *task = context;
    const cli_options *options = task->options;
    lua_newtable(L);
    set_functions(L, task, common);
    set_functions(L, task, cli_files_functions);
    set_functions(L, task, task->functions);
    cli_push_options(L, options);
    lua_setfield(L, -2, "options");
    glintL_set_text(L, "script", options->script);
    glintL_set_text(L, "file", options->file);
    lua_createtable(L, options->argument_count, 0);
    for (int i = 0; i < options->argument_count; i++) {
        lua_pushstring(L, options->arguments[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "arguments");
}

int cli_run_module(cli_task *task, const glintL_carried *modules, size_t count)
{
    char message[GLINTL_MESSAGE_SIZE];
    glintL_made_text made;
    if (glintL_make_text(modules, count, "run", push_command, task, &made, message))
        task->code = (int)lua_tointeger(made.state, -1);
    else if (!task->code)
        report(task, GLINTL_EXIT_FAILED, message);
    glintL_drop_text(&made);
    return task->code;
}
