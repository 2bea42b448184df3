// Warnings that teach: what they say is said once, names the cause and the cure, and is certain.
//
//   a shininess without a specular colour, a parameter that is not read       here
//   a light inside a closed sphere, an object outside the view                warn_view.c
//   a picture that is clipped                                                 events.c, at the end
//
// --warnings=error makes the first of them end the run with 2.
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/run.h"

static const char DULL; // its address is the registry's key: address of a material's box, or 1 .. -> where it was made

// ---- Said once ----

// Whether it is new. Without memory it may be said again.
static bool is_new(glintL_run *run, const char *message)
{
    for (size_t i = 0; i < run->said_count; i++)
        if (strcmp(run->said[i], message) == 0)
            return false;
    char *copy = strdup(message), **grown = realloc(run->said, (run->said_count + 1) * sizeof *grown);
    run->said = grown ? grown : run->said;
    if (copy && grown)
        grown[run->said_count++] = copy;
    else
        free(copy);
    return true;
}

void glintL_forget_warnings(glintL_run *run)
{
    for (size_t i = 0; i < run->said_count; i++)
        free(run->said[i]);
    free(run->said);
    run->said = NULL;
    run->said_count = 0;
}

static void say(const glintL_run *run, const char *message)
{
    if (run->reporter.warn)
        run->reporter.warn(run->reporter.context, message);
    else
        fprintf(stderr, "glint: warning: %s\n", message);
}

void glintL_run_warn(glintL_run *run, const char *format, ...)
{
    char message[GLINTL_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    if (run->request.warnings == GLINTL_WARNINGS_NONE || !is_new(run, message))
        return;
    if (run->request.warnings == GLINTL_WARNINGS_ERROR)
        glintL_run_fail(run, GLINTL_EXIT_USAGE, 0, "%.1000s (--warnings=error)", message);
    else
        say(run, message);
}

void glintL_warn(lua_State *L, const char *message)
{
    glintL_push_position(L);
    glintL_run_warn(glintL_get_run(L), "%s%s", lua_tostring(L, -1), message);
    lua_pop(L, 1);
}

void glintL_run_note(const glintL_run *run, const char *format, ...)
{
    char message[GLINTL_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    if (run->request.warnings != GLINTL_WARNINGS_NONE)
        say(run, message);
}

// ---- Shininess without specular ----

void glintL_note_material(lua_State *L, int index, bool is_dull)
{
    const void *box = lua_touserdata(L, index);
    luaL_checkstack(L, 6, "material");
    glintL_push_table(L, &DULL);
    if (lua_rawgetp(L, -1, box) != LUA_TNIL) // of a material that is gone: it never had a specular
        lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
    else
        lua_pop(L, 1);
    if (is_dull)
        luaL_where(L, 1);
    else
        lua_pushnil(L);
    lua_rawsetp(L, -2, box);
    lua_pop(L, 1);
}

void glintL_note_specular(lua_State *L, int index)
{
    luaL_checkstack(L, 4, "material");
    glintL_push_table(L, &DULL);
    lua_pushnil(L);
    lua_rawsetp(L, -2, lua_touserdata(L, index));
    lua_pop(L, 1);
}

static void report_dull(lua_State *L, glintL_run *run)
{
    const char *first = NULL;
    glintL_push_table(L, &DULL);
    lua_pushnil(L);
    while (lua_next(L, -2)) {
        const char *where = lua_tostring(L, -1); // the table keeps it
        if (!first || strcmp(where, first) < 0)
            first = where;
        lua_pop(L, 1);
    }
    if (first)
        glintL_run_warn(
            run, "%smaterial.shininess has no effect while specular is black; set that, too: specular = 0.5", first);
    lua_pop(L, 1);
}

// ---- Parameters ----

static bool is_part_of_name(int c) { return isalnum(c) || c == '_'; }

// How often the word stands in the file; -1: it cannot be read.
static int count_word(const char *path, const char *word)
{
    FILE *file = fopen(path, "r");
    char *line = NULL;
    size_t size = 0, length = strlen(word);
    int count = file ? 0 : -1;
    while (file && getline(&line, &size, file) >= 0)
        for (const char *at = strstr(line, word); at; at = strstr(at + length, word))
            count +=
                !(at > line && is_part_of_name((unsigned char)at[-1])) && !is_part_of_name((unsigned char)at[length]);
    free(line);
    if (file)
        fclose(file);
    return count;
}

static bool is_set(const glintL_run *run, const char *name)
{
    for (size_t i = 0; i < run->request.set_count; i++)
        if (strcmp(run->request.sets[i].name, name) == 0)
            return true;
    return false;
}

// A parameter that is read under conditions only is not unused: so the script's text must not have its name again.
static void report_params(lua_State *L, glintL_run *run, const char *script)
{
    glintL_push_params(L);
    lua_Integer count = luaL_len(L, -1);
    for (lua_Integer i = 1; i <= count; i++) {
        lua_rawgeti(L, -1, i);
        lua_getfield(L, -1, "name");
        const char *name = lua_tostring(L, -1);
        bool is_read = lua_getfield(L, -2, "is_read") != LUA_TNIL;
        if (!is_read && count_word(script, name) == 1)
            glintL_run_warn(run, "params.%s: the script never reads it; use it, or take it away", name);
        else if (!is_read && is_set(run, name) && glintL_selection_is_whole(&run->request.selection))
            glintL_run_warn(run, "--set %s: the script did not read it with these settings; it changes nothing", name);
        lua_pop(L, 3);
    }
    lua_pop(L, 1);
}

// ---- At the end ----

void glintL_report_observed(lua_State *L, glintL_run *run, const char *script)
{
    if (run->request.warnings == GLINTL_WARNINGS_NONE)
        return;
    luaL_checkstack(L, 12, "warnings");
    report_dull(L, run);
    report_params(L, run, script);
    glintL_report_unseen(L, run);
}
