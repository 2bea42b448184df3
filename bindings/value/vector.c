// glint.vector: three numbers that do not change, read by x, y, z, by r, g, b and by 1, 2, 3.
#include <stdio.h>
#include <string.h>

#include "bindings/value/glintL.h"

void glintL_push_vector(lua_State *L, const double v[3])
{
    double *out = lua_newuserdatauv(L, 3 * sizeof *out, 0);
    memcpy(out, v, 3 * sizeof *out);
    luaL_setmetatable(L, GLINTL_VECTOR_TYPE);
}

static const double *check_self(lua_State *L)
{
    const double *v = glintL_to_vector(L, 1);
    if (!v)
        glintL_refuse(L, 1, "", "vector");
    return v;
}

// A vector, or an array of three numbers, or (when allowed) one number for all three.
static void read_operand(lua_State *L, int index, bool allow_number, double out[3])
{
    if (allow_number && lua_type(L, index) == LUA_TNUMBER)
        out[0] = out[1] = out[2] = lua_tonumber(L, index);
    else if (glintL_to_vector(L, index))
        memcpy(out, glintL_to_vector(L, index), 3 * sizeof *out);
    else
        glintL_read_three(L, index, "vector", allow_number ? "vector or number" : "vector", out);
}

// Such a sum or product is one of patterns, see bindings/pattern.
static bool has_traced(lua_State *L)
{
    const glintL_tracing *tracing = glintL_get_tracing(L);
    return tracing->is_traced(L, 1) || tracing->is_traced(L, 2);
}

static int add(lua_State *L)
{
    double a[3], b[3];
    if (has_traced(L))
        return glintL_get_tracing(L)->operate(L, GLINT_OP_ADD);
    read_operand(L, 1, false, a);
    read_operand(L, 2, false, b);
    glintL_push_vector(L, (const double[3]) { a[0] + b[0], a[1] + b[1], a[2] + b[2] });
    return 1;
}

static int subtract(lua_State *L)
{
    double a[3], b[3];
    if (has_traced(L))
        return glintL_get_tracing(L)->operate(L, GLINT_OP_SUB);
    read_operand(L, 1, false, a);
    read_operand(L, 2, false, b);
    glintL_push_vector(L, (const double[3]) { a[0] - b[0], a[1] - b[1], a[2] - b[2] });
    return 1;
}

static int multiply(lua_State *L)
{
    double a[3], b[3];
    if (has_traced(L))
        return glintL_get_tracing(L)->operate(L, GLINT_OP_MUL);
    read_operand(L, 1, true, a);
    read_operand(L, 2, true, b);
    glintL_push_vector(L, (const double[3]) { a[0] * b[0], a[1] * b[1], a[2] * b[2] });
    return 1;
}

static int divide(lua_State *L)
{
    double a[3], b[3];
    if (has_traced(L))
        return glintL_get_tracing(L)->operate(L, GLINT_OP_DIV);
    read_operand(L, 1, true, a);
    read_operand(L, 2, true, b);
    glintL_push_vector(L, (const double[3]) { a[0] / b[0], a[1] / b[1], a[2] / b[2] });
    return 1;
}

static int negate(lua_State *L)
{
    const double *v = check_self(L);
    glintL_push_vector(L, (const double[3]) { -v[0], -v[1], -v[2] });
    return 1;
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
    static const char letters[] = "xyzrgb";
    const double *v = check_self(L);
    if (lua_isinteger(L, 2)) {
        lua_Integer i = lua_tointeger(L, 2);
        if (i >= 1 && i <= 3)
            lua_pushnumber(L, v[i - 1]);
        else
            lua_pushnil(L); // where ipairs stops
        return 1;
    }
    if (lua_type(L, 2) != LUA_TSTRING)
        return glintL_bad_key(L, "vector", 2);
    const char *name = lua_tostring(L, 2);
    const char *letter = *name && !name[1] ? strchr(letters, *name) : NULL;
    if (letter)
        lua_pushnumber(L, v[(letter - letters) % 3]);
    else
        return read_method(L, name);
    return 1;
}

static int write_field(lua_State *L)
{
    const char *name = luaL_tolstring(L, 2, NULL);
    return glintL_error(L,
                        "vector.%s: a vector does not change; assign a whole one to the object's field: "
                        "object.field = {x, y, z}",
                        name);
}

void glintL_open_vector(lua_State *L)
{
    static const luaL_Reg meta[] = {
        { "__add", add },
        { "__sub", subtract },
        { "__mul", multiply },
        { "__div", divide },
        { "__unm", negate },
        { "__eq", equal },
        { "__len", length },
        { "__tostring", to_string },
        { "__index", read_field },
        { "__newindex", write_field },
        { NULL, NULL },
    };
    static const glintL_field fields[] = {
        { .name = "x" }, { .name = "y" }, { .name = "z" },  { .name = "r" },
        { .name = "g" }, { .name = "b" }, { .name = NULL },
    };
    static const glintL_variant variant = { .name = "vector", .fields = fields };
    luaL_newmetatable(L, GLINTL_VECTOR_TYPE);
    luaL_setfuncs(L, meta, 0);
    lua_pushboolean(L, false);
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 1);
    glintL_list_variant(L, &variant, glintL_get_tracing(L)->methods);
}
