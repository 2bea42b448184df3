// Warnings that teach: each appears once, names the cause and the cure, and is certain.
//
//   a shininess without a specular colour, a parameter that is not read       here
//   a light inside a closed sphere, an object outside the view, a smooth
//   mesh of few faces                                                         warn_view.c
//   pictures that are all black                                               warn_black.c, at the end
//   a picture that is clipped                                                 brightness.c, events.c, at the end
//
// --warnings=error ends the run with exit code 2 at the first warning.
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/run.h"

#define SAID_MAX 100 // warnings of one run

// Registry keys of two tables. MADE: a material's userdata (weak) -> the place where it was made. DULL: that place ->
// the number of materials made there that have a shininess and never had a specular.
static const char MADE, DULL;

// ---- Each warning once ----

// Returns the part of a message that identifies it, without the frame at its beginning.
static const char *gist_of(const char *message)
{
    const size_t digits = strncmp(message, "frame ", 6) == 0 ? strspn(message + 6, "0123456789") : 0;
    return digits && message[6 + digits] == ':' ? message + 6 + digits : message;
}

// Returns whether a warning is new and among the first SAID_MAX. When memory is short it may be repeated.
static bool is_new(glintL_run *run, const char *message)
{
    message = gist_of(message);
    for (size_t i = 0; i < run->said_count; i++)
        if (strcmp(run->said[i], message) == 0)
            return false;
    if (run->said_count == SAID_MAX)
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
    if (run->reporter.warn) {
        run->reporter.warn(run->reporter.context, message);
    } else {
        fputs("glint: warning: ", stderr);
        glintL_put_text(stderr, message, strlen(message));
        fputc('\n', stderr);
    }
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
    if (run->said_count == SAID_MAX)
        say(run, "too many warnings; no more are shown");
}

void glintL_warn(lua_State *L, const char *message)
{
    glintL_push_position(L);
    glintL_run_warn(glintL_get_run(L), "%s%s", lua_tostring(L, -1), message);
    lua_pop(L, 1);
}

void glintL_warn_of_shutter(glintL_run *run)
{
    glintL_run_warn(
        run, "camera.shutter: nothing moves while it is open; move objects in the frame function of a glint.animation");
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

// Adds to the count of the place on top, and pops the place.
static void count_dull(lua_State *L, lua_Integer change)
{
    glintL_push_table(L, &DULL);
    lua_pushvalue(L, -2);
    lua_rawget(L, -2);
    lua_Integer count = lua_tointeger(L, -1) + change;
    lua_pop(L, 1);
    lua_pushvalue(L, -2);
    if (count > 0)
        lua_pushinteger(L, count);
    else
        lua_pushnil(L);
    lua_rawset(L, -3);
    lua_pop(L, 2);
}

void glintL_note_material(lua_State *L, int index, bool is_dull)
{
    if (!is_dull)
        return;
    luaL_checkstack(L, 8, "material");
    index = lua_absindex(L, index);
    glintL_push_weak_table(L, &MADE, "k");
    lua_pushvalue(L, index);
    luaL_where(L, 1);
    lua_rawset(L, -3);
    lua_pop(L, 1);
    luaL_where(L, 1);
    count_dull(L, 1);
}

void glintL_note_specular(lua_State *L, int index)
{
    luaL_checkstack(L, 8, "material");
    index = lua_absindex(L, index);
    glintL_push_weak_table(L, &MADE, "k");
    lua_pushvalue(L, index);
    if (lua_rawget(L, -2) == LUA_TSTRING) {
        count_dull(L, -1);
        lua_pushvalue(L, index);
        lua_pushnil(L);
        lua_rawset(L, -3);
    } else {
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

static void report_dull(lua_State *L, glintL_run *run)
{
    const char *first = NULL;
    glintL_push_table(L, &DULL);
    lua_pushnil(L);
    while (lua_next(L, -2)) {
        const char *where = lua_tostring(L, -2); // the table retains it
        if (!first || strcmp(where, first) < 0)
            first = where;
        lua_pop(L, 1);
    }
    if (first)
        glintL_run_warn(
            run, "%smaterial.shininess has no effect while specular is black; set specular, too, such as specular = "
                 "0.5", first);
    lua_pop(L, 1);
}

// ---- Parameters ----

static bool is_part_of_name(int c) { return isalnum(c) || c == '_'; }

// Returns how often the word occurs in the file; -1: it cannot be read.
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

// Warns about parameters that are not read, except those whose name occurs again in the script: they may be read under
// some condition.
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
            glintL_run_warn(run, "params.%s: the script never reads this parameter; use it, or remove it", name);
        else if (!is_read && is_set(run, name) && glintL_selection_is_whole(&run->request.selection))
            glintL_run_warn(run, "--set %s: the script did not read this parameter with these settings, so it "
                                 "changes nothing", name);
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
    glintL_report_black(run);
}
