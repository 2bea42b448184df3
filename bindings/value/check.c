// Reads values from a script: numbers, vectors and lists, with messages about wrong values.
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "bindings/value/glintL.h"

#define SPELT_MAX 40 // bytes of a script's string shown in a message, at most

// Pushes "file:line: " of the innermost running Lua code, or "".
void glintL_push_position(lua_State *L)
{
    const glintL_tracing *tracing = glintL_get_tracing(L);
    lua_Debug where;
    for (int level = 0; lua_getstack(L, level, &where); level++) {
        lua_getinfo(L, "Slf", &where);
        const char *place = tracing ? tracing->place(L, lua_tocfunction(L, -1)) : NULL;
        lua_pop(L, 1);
        if (place) { // a tail call loses the line
            lua_pushstring(L, place);
            return;
        }
        if (where.currentline > 0) {
            lua_pushfstring(L, "%s:%d: ", where.short_src, where.currentline);
            return;
        }
    }
    lua_pushliteral(L, "");
}

int glintL_error(lua_State *L, const char *format, ...)
{
    va_list args;
    luaL_checkstack(L, 8, "message");
    glintL_push_position(L);
    va_start(args, format);
    lua_pushvfstring(L, format, args);
    va_end(args);
    lua_concat(L, 2);
    return lua_error(L);
}

void glintL_check_status(lua_State *L, const char *path, const glint_error *error, glint_status status)
{
    if (status == GLINT_OK)
        return;
    if (status == GLINT_ERR_NOMEM || *path == '\0')
        glintL_error(L, "%s", error->message);
    else
        glintL_error(L, "%s%s%s", path, status == GLINT_ERR_INVALID ? "." : ": ", error->message);
}

// Pushes a string in quotes, cut to SPELT_MAX bytes, with '?' for bytes that could disturb a terminal.
static void push_quoted(lua_State *L, int index)
{
    size_t length, shown;
    const char *text = lua_tolstring(L, index, &length);
    char out[SPELT_MAX];
    shown = length < SPELT_MAX ? length : SPELT_MAX;
    for (size_t i = 0; i < shown; i++) {
        unsigned char c = (unsigned char)text[i];
        out[i] = c < 0x20 || c == 0x7f ? '?' : text[i];
    }
    lua_pushliteral(L, "\"");
    lua_pushlstring(L, out, shown);
    lua_pushstring(L, shown < length ? "...\"" : "\"");
    lua_concat(L, 3);
}

static void push_number(lua_State *L, int index)
{
    lua_Number x = lua_tonumber(L, index);
    if (isnan(x)) // Lua would write "-nan" for 0/0
        lua_pushliteral(L, "nan");
    else
        luaL_tolstring(L, index, NULL);
}

static void push_userdata(lua_State *L, int index)
{
    static const char prefix[] = "glint.";
    if (glintL_push_object_name(L, index))
        return;
    if (glintL_to_dual(L, index)) {
        lua_pushliteral(L, "a variable");
        return;
    }
    if (luaL_getmetafield(L, index, "__name") != LUA_TSTRING) {
        lua_pushliteral(L, "userdata");
        return;
    }
    const char *name = lua_tostring(L, -1);
    if (strncmp(name, prefix, sizeof prefix - 1) == 0) {
        lua_pushstring(L, name + sizeof prefix - 1);
        lua_remove(L, -2);
    }
}

const char *glintL_push_spelling(lua_State *L, int index)
{
    luaL_checkstack(L, 8, "message");
    index = lua_absindex(L, index);
    switch (lua_type(L, index)) {
    case LUA_TNONE:
        lua_pushliteral(L, "no value");
        break;
    case LUA_TBOOLEAN:
        lua_pushstring(L, lua_toboolean(L, index) ? "true" : "false");
        break;
    case LUA_TNUMBER:
        push_number(L, index);
        break;
    case LUA_TSTRING:
        lua_pushliteral(L, "string ");
        push_quoted(L, index);
        lua_concat(L, 2);
        break;
    case LUA_TUSERDATA:
        push_userdata(L, index);
        break;
    default:
        lua_pushstring(L, luaL_typename(L, index));
    }
    return lua_tostring(L, -1);
}

int glintL_refuse(lua_State *L, int index, const char *path, const char *expected)
{
    const char *got = glintL_push_spelling(L, index), *cure = glintL_push_dot_cure(L, index);
    return glintL_error(L, "%s%s%s expected, got %s%s", path, *path ? ": " : "", expected, got, cure);
}

int glintL_no_such_field(lua_State *L, const char *path, const char *name, const char *near)
{
    const char *dot = *path ? "." : "";
    char shown[SPELT_MAX + 1];
    snprintf(shown, sizeof shown, "%s", name);
    for (char *c = shown; *c; c++)
        *c = iscntrl((unsigned char)*c) ? '?' : *c;
    if (strcmp(path, "scene") == 0 && glintL_get_tracing(L)->frame_field(name) >= 0) {
        const bool is_depth = strcmp(name, "max_depth") == 0;
        return glintL_error(L, "scene.%s: no such field; it belongs to scene:render and glint.animation%s", shown,
                            is_depth ? ", or to the command as --max-depth" : "");
    }
    if (near)
        return glintL_error(L, "%s%s%s: no such field; did you mean '%s'?", path, dot, shown, near);
    return glintL_error(L, "%s%s%s: no such field", path, dot, shown);
}

// ---- Numbers, vectors and lists ----

int glintL_bad_key(lua_State *L, const char *path, int index)
{
    const char *got = glintL_push_spelling(L, index);
    return glintL_error(L, "%s%sname of a field expected, got %s", path, *path ? ": " : "", got);
}

// Refuses a dual number where its slopes would be lost.
static void refuse_dual(lua_State *L, int index, const char *path)
{
    if (glintL_to_dual(L, index))
        glintL_error(L, "%s%sthis has no derivative; use the plain number, glint.value(x)", path, *path ? ": " : "");
}

double glintL_read_number(lua_State *L, int index, const char *path)
{
    refuse_dual(L, index, path);
    if (lua_type(L, index) != LUA_TNUMBER) // a string does not count as a number
        glintL_refuse(L, index, path, "number");
    return lua_tonumber(L, index);
}

// Checks that the table has no keys except 1, 2 and 3, any of which may be missing.
static void check_three_keys(lua_State *L, int index, const char *path, const char *expected)
{
    lua_pushnil(L);
    while (lua_next(L, index)) {
        lua_pop(L, 1);
        if (lua_isinteger(L, -1)) {
            lua_Integer key = lua_tointeger(L, -1);
            if (key < 1 || key > 3)
                glintL_error(L, "%s%s%s expected, got a table with [%I]", path, *path ? ": " : "", expected,
                             (LUAI_UACINT)key);
        } else {
            const char *key = glintL_push_spelling(L, -1);
            glintL_error(L, "%s%s%s expected, got a table with the key %s", path, *path ? ": " : "", expected, key);
        }
    }
}

void glintL_read_three(lua_State *L, int index, const char *path, const char *expected, double out[3])
{
    double read[3];
    const double *vector = glintL_to_vector(L, index);
    if (vector) {
        memcpy(out, vector, sizeof read);
        return;
    }
    refuse_dual(L, index, path);
    if (!lua_istable(L, index))
        glintL_refuse(L, index, path, expected);
    index = lua_absindex(L, index);
    luaL_checkstack(L, 4, "vector");
    check_three_keys(L, index, path, expected);
    for (int i = 0; i < 3; i++) {
        bool is_number = lua_rawgeti(L, index, i + 1) == LUA_TNUMBER;
        refuse_dual(L, -1, path);
        read[i] = lua_tonumber(L, -1);
        if (!is_number || !isfinite(read[i])) {
            const char *got = glintL_push_spelling(L, -1);
            glintL_error(L, "%s[%d]: %s expected, got %s", path, i + 1, is_number ? "finite number" : "number", got);
        }
        lua_pop(L, 1);
    }
    memcpy(out, read, sizeof read);
}

void glintL_read_vector(lua_State *L, int index, const char *path, double out[3])
{
    glintL_read_three(L, index, path, "{x, y, z}", out);
}

// Raises for the first index from 1 on that the table lacks.
static void refuse_hole(lua_State *L, int index, const char *path)
{
    for (lua_Integer i = 1;; i++) {
        if (lua_rawgeti(L, index, i) == LUA_TNIL)
            glintL_error(L, "%s[%I]: a list without holes expected, got nil", path, (LUAI_UACINT)i);
        lua_pop(L, 1);
    }
}

size_t glintL_check_list(lua_State *L, int index, const char *path, bool allow_fields)
{
    lua_Integer count = 0, last = 0;
    index = lua_absindex(L, index);
    luaL_checkstack(L, 4, "list");
    lua_pushnil(L);
    while (lua_next(L, index)) {
        lua_pop(L, 1);
        lua_Integer key = lua_isinteger(L, -1) ? lua_tointeger(L, -1) : 0;
        if (key >= 1) {
            count++;
            last = key > last ? key : last;
        } else if (!(allow_fields && lua_type(L, -1) == LUA_TSTRING)) {
            const char *got = glintL_push_spelling(L, -1);
            glintL_error(L, "%s: a list expected, got a table with the key %s", path, got);
        }
    }
    if (last != count)
        refuse_hole(L, index, path);
    return (size_t)count;
}
