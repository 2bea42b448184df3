// glint help and glint completion: texts generated from the tables of commands and options.
#include "bindings/command/cli.h"

static const unsigned char HELP_LUA[] = {
#include "bindings/command/help.lua.h"
};
static const unsigned char COMPLETION_LUA[] = {
#include "bindings/command/completion.lua.h"
};

static void push_commands(lua_State *L)
{
    lua_createtable(L, CLI_COMMAND_COUNT, 0);
    for (int i = 0; i < CLI_COMMAND_COUNT; i++) {
        const cli_command_name *command = &cli_command_list[i];
        lua_newtable(L);
        glintL_set_text(L, "name", command->name);
        glintL_set_text(L, "synopsis", command->synopsis);
        glintL_set_text(L, "help", command->help);
        glintL_set_whole(L, "bit", command->command);
        lua_rawseti(L, -2, i + 1);
    }
}

// Pushes the placeholder of the option's value, or the choices of its field of scene:render{}: "a|b".
static void push_value(lua_State *L, const cli_option *option)
{
    const char *const *words = glintL_render_choices(glintL_render_find(option->name));
    luaL_Buffer choices;
    if (option->value && *option->value) {
        lua_pushstring(L, option->value);
        return;
    }
    luaL_buffinit(L, &choices);
    for (int i = 0; words && words[i]; i++) {
        luaL_addstring(&choices, i ? "|" : "");
        luaL_addstring(&choices, words[i]);
    }
    luaL_pushresult(&choices);
}

static void push_options(lua_State *L)
{
    lua_createtable(L, CLI_OPTION_COUNT, 0);
    for (int i = 0; i < CLI_OPTION_COUNT; i++) {
        const cli_option *option = &cli_option_list[i];
        lua_newtable(L);
        glintL_set_text(L, "name", option->name);
        lua_pushlstring(L, &option->letter, option->letter != '\0');
        lua_setfield(L, -2, "letter");
        push_value(L, option);
        lua_setfield(L, -2, "value");
        glintL_set_flag(L, "takes_value", option->value);
        glintL_set_flag(L, "may_lack", cli_option_may_lack(option));
        glintL_set_whole(L, "commands", option->commands);
        glintL_set_text(L, "help", option->help);
        glintL_set_text(L, "suggest", option->suggest);
        glintL_set_flag(L, "repeats", option->repeats);
        glintL_set_text(L, "group", option->group);
        lua_rawseti(L, -2, i + 1);
    }
}

// tables(): returns the commands, the options and the names of the passes.
static int tables(lua_State *L)
{
    push_commands(L);
    push_options(L);
    lua_createtable(L, GLINT_PASS_COUNT, 0);
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++) {
        lua_pushstring(L, glint_pass_name((glint_pass)pass));
        lua_rawseti(L, -2, pass + 1);
    }
    return 3;
}

// command(): returns the command on the command line, as a bit; nothing if none was given.
static int command(lua_State *L)
{
    const cli_options *options = cli_task_of(L)->options;
    if (!options->has_command)
        return 0;
    lua_pushinteger(L, options->command);
    lua_pushboolean(L, options->command == CLI_HELP);
    return 2;
}

static const luaL_Reg functions[] = { { "tables", tables }, { "command", command }, { NULL, NULL } };

int cli_help(cli_options *options, cli_output *output, glintL_run *run)
{
    static const glintL_carried module = { "@help.lua", HELP_LUA, sizeof HELP_LUA };
    return cli_run_module(&(cli_task) { "help", options, output, run, functions, NULL, 0 }, &module, 1);
}

int cli_completion(cli_options *options, cli_output *output, glintL_run *run)
{
    static const glintL_carried module = { "@completion.lua", COMPLETION_LUA, sizeof COMPLETION_LUA };
    return cli_run_module(&(cli_task) { "completion", options, output, run, functions, NULL, 0 }, &module, 1);
}
