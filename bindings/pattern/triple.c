// glint.triple: a table of three terms x, y, z with at least one symbol, and with the operators of vectors. Three plain
// numbers are a vector instead.
#include "bindings/pattern/pattern.h"

#include <string.h>

static bool read_numbers(const glintL_term *v, int count, double *out)
{
    bool good = true;
    for (int i = 0; i < count; i++) {
        out[i] = v[i].number;
        good = good && !v[i].is_symbol;
    }
    return good;
}

static void push_table(lua_State *L, const glintL_term v[3])
{
    lua_createtable(L, 0, 3);
    for (int i = 0; i < 3; i++) {
        glintL_push_term(L, v[i]);
        lua_setfield(L, -2, &"x\0y\0z"[2 * i]);
    }
    luaL_setmetatable(L, GLINTL_TRIPLE);
}

void glintL_push_triple(lua_State *L, const glintL_term v[3])
{
    double numbers[3];
    luaL_checkstack(L, 4, "vector");
    if (read_numbers(v, 3, numbers))
        glintL_push_vector(L, numbers);
    else
        push_table(L, v);
}

void glintL_push_color(lua_State *L, const glintL_term v[4])
{
    double numbers[4];
    luaL_checkstack(L, 4, "color");
    if (read_numbers(v, 4, numbers)) {
        glintL_push_texel(L, numbers);
        return;
    }
    push_table(L, v);
    lua_pushliteral(L, "a");
    glintL_push_term(L, v[3]);
    lua_rawset(L, -3);
}

// Reads a vector argument; does not accept a scalar.
static void read_vector(lua_State *L, int index, const char *path, glintL_term out[3])
{
    glintL_operand operand;
    if (lua_gettop(L) == 0)
        glintL_error(L, "%s: a vector expected, got no value; a method takes a colon: v:%s()", path, path);
    glintL_read_operand(L, index, path, &operand);
    if (!operand.is_vector)
        glintL_error(L, "%s: a vector expected, got one %s", path, operand.at[0].is_symbol ? "symbol" : "number");
    memcpy(out, operand.at, sizeof operand.at);
}

static void read_two(lua_State *L, const char *path, glintL_term a[3], glintL_term b[3])
{
    read_vector(L, 1, path, a);
    read_vector(L, 2, path, b);
}

// ---- Methods ----

int glintL_dot(lua_State *L)
{
    glintL_term a[3], b[3];
    read_two(L, "dot", a, b);
    glintL_push_term(L, glintL_dot_terms(L, a, b));
    return 1;
}

int glintL_cross(lua_State *L)
{
    glintL_term a[3], b[3], out[3];
    read_two(L, "cross", a, b);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = glintL_apply2(L, GLINT_OP_SUB, glintL_apply2(L, GLINT_OP_MUL, a[j], b[k]),
                               glintL_apply2(L, GLINT_OP_MUL, a[k], b[j]));
    }
    glintL_push_triple(L, out);
    return 1;
}

static glintL_term length_of(lua_State *L, const glintL_term v[3])
{
    return glintL_apply1(L, GLINT_OP_SQRT, glintL_dot_terms(L, v, v));
}

int glintL_length(lua_State *L)
{
    glintL_term v[3];
    read_vector(L, 1, "length", v);
    glintL_push_term(L, length_of(L, v));
    return 1;
}

int glintL_unit(lua_State *L)
{
    glintL_term v[3];
    read_vector(L, 1, "unit", v);
    const glintL_term size = length_of(L, v);
    for (int i = 0; i < 3; i++)
        v[i] = glintL_apply2(L, GLINT_OP_DIV, v[i], size);
    glintL_push_triple(L, v);
    return 1;
}

// Returns d - 2 (n.d) n, as in GLSL, for an incident direction and a unit normal.
int glintL_reflect(lua_State *L)
{
    glintL_term d[3], n[3];
    read_two(L, "reflect", d, n);
    const glintL_term twice = glintL_apply2(L, GLINT_OP_MUL, glintL_number_term(2), glintL_dot_terms(L, n, d));
    for (int i = 0; i < 3; i++)
        d[i] = glintL_apply2(L, GLINT_OP_SUB, d[i], glintL_apply2(L, GLINT_OP_MUL, twice, n[i]));
    glintL_push_triple(L, d);
    return 1;
}

static int unpack(lua_State *L)
{
    glintL_term v[3];
    read_vector(L, 1, "unpack", v);
    for (int i = 0; i < 3; i++)
        glintL_push_term(L, v[i]);
    return 3;
}

// glint.vector: makes a vector from x, y, z, or from a list, a vector or one number.
static int new_vector(lua_State *L)
{
    glintL_operand operand;
    if (lua_gettop(L) == 3) {
        for (int i = 0; i < 3; i++)
            operand.at[i] = glintL_read_term(L, i + 1, "vector");
    } else if (lua_gettop(L) == 1) {
        glintL_read_operand(L, 1, "vector", &operand);
    } else {
        return glintL_error(L, "vector: expected x, y and z, or one value, got %d values", lua_gettop(L));
    }
    glintL_push_triple(L, operand.at);
    return 1;
}

// ---- The metatable ----

static const luaL_Reg METHODS[] = {
    { "dot", glintL_dot },   { "cross", glintL_cross },     { "length", glintL_length },
    { "unit", glintL_unit }, { "reflect", glintL_reflect }, { "unpack", unpack },
    { NULL, NULL },
};

// Looks up fields that the table itself lacks: r, g, b and u, v, the numbers 1, 2, 3, and methods.
static int read_field(lua_State *L)
{
    static const char letters[] = "rgbuv", places[] = "01201";
    int index = -1;
    if (lua_isinteger(L, 2)) {
        const lua_Integer i = lua_tointeger(L, 2);
        index = i >= 1 && i <= 3 ? (int)i - 1 : -1;
        if (index < 0)
            return 0; // ends ipairs
    } else if (lua_type(L, 2) != LUA_TSTRING) {
        return glintL_bad_key(L, "vector", 2);
    } else {
        const char *name = lua_tostring(L, 2);
        const char *letter = *name && !name[1] ? strchr(letters, *name) : NULL;
        index = letter ? places[letter - letters] - '0' : -1;
    }
    if (index >= 0) {
        lua_pushstring(L, &"x\0y\0z"[2 * index]);
        lua_rawget(L, 1);
        return 1;
    }
    const char *name = lua_tostring(L, 2), *near = NULL;
    for (const luaL_Reg *method = METHODS; method->name; method++) {
        near = glintL_nearer(name, near, method->name);
        if (strcmp(name, method->name) == 0) {
            lua_pushcfunction(L, method->func);
            return 1;
        }
    }
    return glintL_no_such_field(L, "vector", name, near);
}

static int write_field(lua_State *L)
{
    return glintL_error(L, "vector.%s: a vector has only x, y and z", luaL_tolstring(L, 2, NULL));
}

static int equal(lua_State *L)
{
    glintL_operand a, b;
    glintL_read_operand(L, 1, "a == b", &a);
    glintL_read_operand(L, 2, "a == b", &b);
    bool same = true;
    for (int i = 0; i < 3; i++) {
        if (a.at[i].is_symbol || b.at[i].is_symbol)
            return glintL_error(L,
                                "a == b or a ~= b of vectors of symbols: their values are not known, because the "
                                "function runs once for all points; write glint.select(glint.equal(a.x, b.x), x, y)");
        same = same && a.at[i].number == b.at[i].number;
    }
    lua_pushboolean(L, same);
    return 1;
}

static int count(lua_State *L)
{
    lua_pushinteger(L, 3);
    return 1;
}

static int to_string(lua_State *L)
{
    lua_pushliteral(L, "{");
    for (int i = 0; i < 3; i++) {
        lua_pushstring(L, &"x\0y\0z"[2 * i]);
        lua_rawget(L, 1);
        luaL_tolstring(L, -1, NULL);
        lua_remove(L, -2);
        lua_pushstring(L, i < 2 ? ", " : "}");
    }
    lua_concat(L, 7);
    return 1;
}

void glintL_open_triple(lua_State *L)
{
    static const luaL_Reg meta[] = {
        { "__eq", equal },           { "__len", count },        { "__newindex", write_field },
        { "__tostring", to_string }, { "__index", read_field }, { NULL, NULL },
    };
    static const glintL_field fields[] = {
        { .name = "x" }, { .name = "y" }, { .name = "z" }, { .name = "r" },  { .name = "g" },
        { .name = "b" }, { .name = "u" }, { .name = "v" }, { .name = NULL },
    };
    static const glintL_variant variant = { .name = "triple", .fields = fields };
    static const luaL_Reg functions[] = {
        { "dot", glintL_dot },   { "cross", glintL_cross },     { "length", glintL_length },
        { "unit", glintL_unit }, { "reflect", glintL_reflect }, { "vector", new_vector },
        { NULL, NULL },
    };
    luaL_newmetatable(L, GLINTL_TRIPLE);
    glintL_set_operators(L);
    luaL_setfuncs(L, meta, 0);
    luaL_getmetatable(L, GLINTL_VECTOR_TYPE);
    glintL_set_arithmetic(L);
    lua_pop(L, 2);
    glintL_list_variant(L, &variant, METHODS);
    luaL_setfuncs(L, functions, 0);
}
