// glint.vector: three immutable numbers, read by x, y, z, by r, g, b, by u, v and by 1, 2, 3. Its operators are those
// of patterns, see bindings/pattern/symbol.c.
#include <stdio.h>
#include <string.h>

#include "bindings/value/glintL.h"

static void push(lua_State *L, const double *v, size_t count)
{
    double *out = lua_newuserdatauv(L, count * sizeof *out, 0);
    memcpy(out, v, count * sizeof *out);
    luaL_setmetatable(L, GLINTL_VECTOR_TYPE);
}

void glintL_push_vector(lua_State *L, const double v[3]) { push(L, v, 3); }

void glintL_push_texel(lua_State *L, const double v[4]) { push(L, v, 4); }

static const double *check_self(lua_State *L)
{
    const double *v = glintL_to_vector(L, 1);
    if (!v) {
        const char *got = glintL_push_spelling(L, 1);
        glintL_error(L, "vector expected, got %s%s", got, glintL_push_colon_cure(L, 1));
    }
    return v;
}

static int equal(lua_State *L)
{
    const double *a = glintL_to_vector(L, 1), *b = glintL_to_vector(L, 2);
    lua_pushboolean(L, a && b && a[0] == b[0] && a[1] == b[1] && a[2] == b[2]);
    return 1;
}

static int length(lua_State *L)
{
    lua_pushinteger(L, 3);
    return 1;
}

int glintL_unpack(lua_State *L)
{
    const double *v = check_self(L);
    for (int i = 0; i < 3; i++)
        lua_pushnumber(L, v[i]);
    return 3;
}

static int to_string(lua_State *L)
{
    char text[96];
    const double *v = check_self(L);
    snprintf(text, sizeof text, "{%.14g, %.14g, %.14g}", v[0], v[1], v[2]);
    lua_pushstring(L, text);
    return 1;
}

static int read_method(lua_State *L, const char *name)
{
    const char *near = NULL;
    for (const luaL_Reg *method = glintL_get_tracing(L)->methods; method->name; method++) {
        near = glintL_nearer(name, near, method->name);
        if (strcmp(name, method->name) == 0) {
            lua_pushcfunction(L, method->func);
            return 1;
        }
    }
    return glintL_no_such_field(L, "vector", name, near);
}

static int read_field(lua_State *L)
{
    static const char letters[] = "xyzrgbuv";
    const double *v = check_self(L);
    if (lua_isinteger(L, 2)) {
        lua_Integer i = lua_tointeger(L, 2);
        if (i >= 1 && i <= 3)
            lua_pushnumber(L, v[i - 1]);
        else
            lua_pushnil(L); // ends ipairs
        return 1;
    }
    if (lua_type(L, 2) != LUA_TSTRING)
        return glintL_bad_key(L, "vector", 2);
    const char *name = lua_tostring(L, 2);
    const char *letter = *name && !name[1] ? strchr(letters, *name) : NULL;
    if (letter)
        lua_pushnumber(L, v[(letter - letters) % 3]);
    else if (strcmp(name, "a") == 0 && lua_rawlen(L, 1) == 4 * sizeof *v)
        lua_pushnumber(L, v[3]);
    else
        return read_method(L, name);
    return 1;
}

static int write_field(lua_State *L)
{
    const char *name = luaL_tolstring(L, 2, NULL);
    return glintL_error(L,
                        "vector.%s: a vector cannot be changed; assign a new vector to the object's field: "
                        "object.field = {x, y, z}",
                        name);
}

void glintL_open_vector(lua_State *L)
{
    static const luaL_Reg meta[] = {
        { "__eq", equal },
        { "__len", length },
        { "__tostring", to_string },
        { "__index", read_field },
        { "__newindex", write_field },
        { NULL, NULL },
    };
    static const glintL_field fields[] = {
        { .name = "x" }, { .name = "y" }, { .name = "z" },  { .name = "r" },
        { .name = "g" }, { .name = "b" }, { .name = "u" }, { .name = "v" },
        { .name = NULL },
    };
    static const glintL_variant variant = { .name = "vector", .fields = fields };
    glintL_new_type(L, GLINTL_VECTOR_TYPE, meta);
    glintL_list_variant(L, &variant, glintL_get_tracing(L)->methods);
}
