// Warnings that teach: each appears once, names the cause and the cure, and is certain.
//
//   a shininess without a specular colour, a parameter that is not read       here
//   a light inside a closed sphere, an object outside the view, a smooth
//   mesh of few faces                                                         warn_view.c
//   pictures that are all black                                               warn_black.c, at the end
//   a picture that is clipped                                                 brightness.c, events.c, at the end
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/run.h"

// Registry keys of two tables. MADE: a material's userdata (weak) -> the place where it was made. DULL: that place ->
// the number of materials made there that have a shininess and never had a specular.
static const char MADE, DULL;

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
