// glint describe SCRIPT and glint SCRIPT --help: the script's parameters and the comment it begins with.
#include <stdlib.h>
#include <string.h>

#include "bindings/command/cli.h"

// ---- The comment ----

// Reads one line without its end; NULL at the end of the file.
static char *read_line(FILE *file, char **line, size_t *size)
{
    ssize_t length = getline(line, size, file);
    if (length < 0)
        return NULL;
    while (length > 0 && ((*line)[length - 1] == '\n' || (*line)[length - 1] == '\r'))
        (*line)[--length] = '\0';
    return *line;
}

// Copies the lines of a "--[[" comment up to its "]]".
static void copy_block(FILE *file, char *text, char **line, size_t *size, FILE *out)
{
    while (text) {
        char *end = strstr(text, "]]");
        if (end)
            *end = '\0';
        fprintf(out, "%s\n", text);
        if (end)
            return;
        text = read_line(file, line, size);
    }
}

// The comment at the top of a script, without its dashes: owned by the caller; NULL: out of memory.
static char *read_comment(const char *path)
{
    char *text = NULL, *line = NULL;
    size_t length = 0, size = 0;
    FILE *out = open_memstream(&text, &length), *file = out ? fopen(path, "r") : NULL;
    bool first = true;
    while (file && read_line(file, &line, &size)) {
        if (first && line[0] == '#') // for the shell
            continue;
        if (first && strncmp(line, "--[[", 4) == 0) {
            copy_block(file, line + 4, &line, &size, out);
            break;
        }
        if (strncmp(line, "--", 2) != 0)
            break;
        fprintf(out, "%s\n", line + (line[2] == ' ' ? 3 : 2));
        first = false;
    }
    if (file)
        fclose(file);
    if (out)
        fclose(out);
    free(line);
    while (text && length > 0 && text[length - 1] == '\n')
        text[--length] = '\0';
    return text;
}

// ---- The parameters: the spec is on top of the stack ----

// Prints the value on top as JSON and pops it.
static void print_value(lua_State *L, FILE *out)
{
    if (lua_type(L, -1) == LUA_TBOOLEAN)
        fputs(lua_toboolean(L, -1) ? "true" : "false", out);
    else if (lua_isinteger(L, -1))
        fprintf(out, LUA_INTEGER_FMT, lua_tointeger(L, -1));
    else if (lua_type(L, -1) == LUA_TNUMBER)
        glintL_json_number(out, lua_tonumber(L, -1));
    else
        glintL_json_string(out, lua_tostring(L, -1));
    lua_pop(L, 1);
}

static void print_param_json(lua_State *L, FILE *out)
{
    static const char *const names[] = { "name", "type", "default", "value", "min", "max", "doc" };
    for (int i = 0; i < 7; i++) {
        if (lua_getfield(L, -1, names[i]) == LUA_TNIL) {
            lua_pop(L, 1);
            continue;
        }
        fprintf(out, "%c\"%s\":", i ? ',' : '{', names[i]);
        print_value(L, out);
    }
    if (lua_getfield(L, -1, "choices") == LUA_TTABLE) {
        for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, -1); i++) {
            fputs(i == 1 ? ",\"choices\":[" : ",", out);
            lua_rawgeti(L, -1, i);
            print_value(L, out);
        }
        fputc(']', out);
    }
    lua_pop(L, 1);
    fputc('}', out);
}

// The text of a field, left on the stack so that it is not collected; NULL: there is none.
static const char *push_text(lua_State *L, int spec, const char *name)
{
    return lua_getfield(L, spec, name) == LUA_TNIL ? NULL : luaL_tolstring(L, -1, NULL);
}

static void print_choices(lua_State *L, int spec, FILE *out)
{
    if (lua_getfield(L, spec, "choices") != LUA_TTABLE)
        return;
    int choices = lua_gettop(L);
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, choices); i++) {
        lua_rawgeti(L, choices, i);
        fprintf(out, "%s%s", i > 1 ? "|" : "  ", luaL_tolstring(L, -1, NULL));
    }
}

static void print_param_line(lua_State *L, FILE *out)
{
    char head[128];
    int spec = lua_gettop(L);
    luaL_checkstack(L, 64, "describe");
    const char *min = push_text(L, spec, "min"), *max = push_text(L, spec, "max"), *doc = push_text(L, spec, "doc");
    snprintf(head, sizeof head, "%s=%s", push_text(L, spec, "name"), push_text(L, spec, "value"));
    fprintf(out, "  %-22s", head);
    if (min || max)
        fprintf(out, "  %s .. %s", min ? min : "", max ? max : "");
    print_choices(L, spec, out);
    fprintf(out, "%s%s\n", doc ? "  " : "", doc ? doc : "");
    lua_settop(L, spec);
}

// ---- The command ----

typedef struct description {
    const cli_options *options;
    const glintL_run *run;
    const char *comment;
    FILE *out;
} description;

void cli_print_params(lua_State *L, FILE *out)
{
    glintL_push_params(L);
    lua_Integer count = (lua_Integer)lua_rawlen(L, -1);
    fputc('[', out);
    for (lua_Integer i = 1; i <= count; i++) {
        if (i > 1)
            fputc(',', out);
        lua_rawgeti(L, -1, i);
        print_param_json(L, out);
        lua_pop(L, 1);
    }
    fputc(']', out);
    lua_pop(L, 1);
}

static void print_json(lua_State *L, const description *what)
{
    fputs("{\"event\":\"description\",\"script\":", what->out);
    glintL_json_string(what->out, what->run->script);
    fputs(",\"doc\":", what->out);
    glintL_json_string(what->out, what->comment);
    fputs(",\"params\":", what->out);
    cli_print_params(L, what->out);
    fputs("}\n", what->out);
}

static void print_for_people(lua_State *L, const description *what)
{
    glintL_push_params(L);
    lua_Integer count = (lua_Integer)lua_rawlen(L, -1);
    if (*what->comment)
        fprintf(what->out, "%s\n\n", what->comment);
    if (count > 0)
        fprintf(what->out, "Parameters, set by --set name=value:\n");
    else
        fprintf(what->out, "%s has no parameters.\n", what->run->script);
    for (lua_Integer i = 1; i <= count; i++) {
        lua_rawgeti(L, -1, i);
        print_param_line(L, what->out);
        lua_pop(L, 1);
    }
}

static int print_protected(lua_State *L)
{
    const description *what = lua_touserdata(L, 1);
    if (glintL_push_unknown_set(L))
        return lua_error(L);
    if (what->options->json)
        print_json(L, what);
    else
        print_for_people(L, what);
    return 0;
}

int cli_describe(cli_options *options, cli_output *output, glintL_run *run)
{
    cli_script script;
    run->mode = GLINTL_MODE_DESCRIBE;
    bool good = cli_run_script(&script, options, run) || (run->is_stopped && !run->exit_code && !run->interrupted);
    char *comment = read_comment(options->script);
    description what = { options, run, comment ? comment : "", output->data };
    if (good) {
        lua_settop(script.state, 0);
        lua_pushcfunction(script.state, print_protected);
        lua_pushlightuserdata(script.state, &what);
        if (lua_pcall(script.state, 1, 0, 0) != LUA_OK)
            glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "%s", lua_tostring(script.state, -1));
    }
    free(comment);
    cli_close_script(&script);
    if (run->exit_code)
        cli_report_error(output, 0, run->exit_code, run->message);
    return run->exit_code;
}
