// glint describe SCRIPT and glint SCRIPT --help: the script's parameters and its leading comment.
#include "bindings/command/cli.h"
#include "bindings/run/carried.h"

static const unsigned char DESCRIBE_LUA[] = {
#include "bindings/command/describe.lua.h"
};
static const glintL_carried MODULE = { "@describe.lua", DESCRIBE_LUA, sizeof DESCRIBE_LUA };

typedef struct description {
    lua_State *script; // has the list of parameters on top of its stack
    const cli_options *options;
    const glintL_run *run;
    FILE *out;
} description;

static void push_params(lua_State *L, const void *context)
{
    const description *subject = context;
    glintL_copy_value(subject->script, -1, L);
}

static void push_description(lua_State *L, const void *context)
{
    const description *subject = context;
    lua_newtable(L);
    push_params(L, context);
    lua_setfield(L, -2, "params");
    glintL_set_text(L, "script", subject->run->script);
    glintL_set_text(L, "path", subject->options->script);
}

// Prints the description. May raise in the script's state.
static void print(const description *subject, const char *function, void (*push)(lua_State *L, const void *context))
{
    char message[GLINTL_MESSAGE_SIZE];
    glintL_made_text made;
    const bool good = glintL_make_text(&MODULE, 1, function, push, subject, &made, message);
    if (good)
        glintL_put_text(subject->out, made.text, made.size);
    glintL_drop_text(&made);
    if (!good)
        luaL_error(subject->script, "%s", message);
}

void cli_print_params(lua_State *L, FILE *out)
{
    glintL_push_params(L);
    print(&(description) { .script = L, .out = out }, "params", push_params);
    lua_pop(L, 1);
}

static int print_protected(lua_State *L)
{
    const description *subject = lua_touserdata(L, 1);
    if (glintL_push_unknown_set(L))
        return lua_error(L);
    glintL_push_params(L);
    print(subject, subject->options->json ? "event" : "people", push_description);
    return 0;
}

int cli_describe(cli_options *options, cli_output *output, glintL_run *run)
{
    cli_script script;
    run->mode = GLINTL_MODE_DESCRIBE;
    bool good = cli_run_script(&script, options, run) || (run->is_stopped && !run->exit_code && !run->interrupted);
    description subject = { script.state, options, run, output->data };
    if (good) {
        lua_settop(script.state, 0);
        lua_pushcfunction(script.state, print_protected);
        lua_pushlightuserdata(script.state, &subject);
        if (lua_pcall(script.state, 1, 0, 0) != LUA_OK)
            glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "%s", lua_tostring(script.state, -1));
    }
    cli_close_script(&script);
    if (run->exit_code)
        cli_report_error(output, 0, run->exit_code, run->message);
    return run->exit_code;
}
