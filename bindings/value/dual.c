// Dual numbers: a number and its derivatives (slopes) by a few variables. Arithmetic makes new dual numbers. A field of
// an object stores only the value; the object's userdata stores the slopes.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bindings/value/glintL.h"

static const char VARIABLES; // address used as the registry key for the list of the variables' names
static const char SLOPED; // registry key for the userdata that store slopes, as weak keys

// ---- Variables ----

int glintL_find_variable(lua_State *L, const char *name)
{
    int found = -1;
    luaL_checkstack(L, 4, "variable");
    glintL_push_table(L, &VARIABLES);
    const lua_Integer count = luaL_len(L, -1);
    for (lua_Integer i = 1; i <= count && found < 0; i++) {
        lua_rawgeti(L, -1, i);
        if (strcmp(lua_tostring(L, -1), name) == 0)
            found = (int)i - 1;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return found;
}

static int add_variable(lua_State *L, const char *name)
{
    glintL_push_table(L, &VARIABLES);
    const lua_Integer count = luaL_len(L, -1);
    if (count == GLINTL_VARIABLES_MAX)
        glintL_error(L, "variable: at most %d variables in a script expected, got '%s', too", GLINTL_VARIABLES_MAX, name);
    lua_pushstring(L, name);
    lua_rawseti(L, -2, count + 1);
    lua_pop(L, 1);
    return (int)count;
}

const char *glintL_near_variable(lua_State *L, const char *name)
{
    const char *near = NULL;
    luaL_checkstack(L, 4, "variable");
    glintL_push_table(L, &VARIABLES);
    const lua_Integer count = luaL_len(L, -1);
    for (lua_Integer i = 1; i <= count; i++) {
        lua_rawgeti(L, -1, i);
        near = glintL_nearer(name, near, lua_tostring(L, -1)); // the list retains the string
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return near;
}

void glintL_push_variable(lua_State *L, const char *name, double value)
{
    glintL_dual d = { .value = value };
    const int known = glintL_find_variable(L, name);
    const int number = known >= 0 ? known : add_variable(L, name);
    d.slope[number] = 1;
    d.depends = UINT32_C(1) << number;
    glintL_push_dual(L, &d);
}

// ---- The value ----

void glintL_push_dual(lua_State *L, const glintL_dual *d)
{
    luaL_checkstack(L, 2, "number");
    if (!d->depends) {
        lua_pushnumber(L, d->value);
        return;
    }
    glintL_dual *out = lua_newuserdatauv(L, sizeof *out, 0);
    *out = *d;
    luaL_setmetatable(L, GLINTL_DUAL);
}

bool glintL_read_dual(lua_State *L, int index, glintL_dual *out)
{
    const glintL_dual *d = glintL_to_dual(L, index);
    if (d)
        *out = *d;
    else if (lua_type(L, index) == LUA_TNUMBER)
        *out = (glintL_dual) { .value = lua_tonumber(L, index) };
    else
        return false;
    return true;
}

glintL_dual glintL_dual_apply(const glintL_dual *a, double by_a, const glintL_dual *b, double by_b, double value)
{
    glintL_dual out = { .value = value, .depends = a->depends | (b ? b->depends : 0) };
    for (int i = 0; i < GLINTL_VARIABLES_MAX; i++) { // a slope of 0 stays 0, even where the derivative is infinite
        out.slope[i] = a->slope[i] != 0 ? by_a * a->slope[i] : 0;
        if (b && b->slope[i] != 0)
            out.slope[i] += by_b * b->slope[i];
    }
    return out;
}

glintL_dual glintL_dual_pow(const glintL_dual *a, const glintL_dual *b)
{
    const double x = a->value, y = b->value, power = pow(x, y);
    return glintL_dual_apply(a, y * pow(x, y - 1), b, x > 0 ? power * log(x) : 0, power);
}

// ---- Operators ----

// Returns whether the other operand (a symbol or vector) has its own operator, and lets it compute the result.
static bool defer(lua_State *L, const char *event)
{
    for (int i = 1; i <= 2; i++) {
        const int type = lua_type(L, i);
        if ((type != LUA_TUSERDATA && type != LUA_TTABLE) || glintL_to_dual(L, i) || luaL_getmetafield(L, i, event) == LUA_TNIL)
            continue;
        lua_pushvalue(L, 1);
        lua_pushvalue(L, 2);
        lua_call(L, 2, 1);
        return true;
    }
    return false;
}

static void read_operands(lua_State *L, glintL_dual *a, glintL_dual *b)
{
    for (int i = 1; i <= 2; i++)
        if (!glintL_read_dual(L, i, i == 1 ? a : b))
            glintL_refuse(L, i, "", "number");
}

static int push_result(lua_State *L, glintL_dual d)
{
    glintL_push_dual(L, &d);
    return 1;
}

// Computes a operator b. Upvalues: the metamethod's name and Lua's code of the operator.
static int compute(lua_State *L)
{
    glintL_dual a, b;
    if (defer(L, lua_tostring(L, lua_upvalueindex(1))))
        return 1;
    read_operands(L, &a, &b);
    const double x = a.value, y = b.value, quotient = x / y;
    switch (lua_tointeger(L, lua_upvalueindex(2))) {
    case LUA_OPADD:
        return push_result(L, glintL_dual_apply(&a, 1, &b, 1, x + y));
    case LUA_OPSUB:
        return push_result(L, glintL_dual_apply(&a, 1, &b, -1, x - y));
    case LUA_OPMUL:
        return push_result(L, glintL_dual_apply(&a, y, &b, x, x * y));
    case LUA_OPDIV:
        return push_result(L, glintL_dual_apply(&a, 1 / y, &b, -quotient / y, quotient));
    case LUA_OPMOD:
        lua_pushnumber(L, x);
        lua_pushnumber(L, y);
        lua_arith(L, LUA_OPMOD);
        return push_result(L, glintL_dual_apply(&a, 1, &b, -floor(quotient), lua_tonumber(L, -1)));
    case LUA_OPIDIV:
        lua_pushnumber(L, floor(quotient));
        return 1;
    default:
        return push_result(L, glintL_dual_pow(&a, &b));
    }
}

static int negate(lua_State *L)
{
    const glintL_dual *a = luaL_checkudata(L, 1, GLINTL_DUAL);
    return push_result(L, glintL_dual_apply(a, -1, NULL, 0, -a->value));
}

// Compares the values. Upvalues: as for compute.
static int compare(lua_State *L)
{
    glintL_dual a, b;
    read_operands(L, &a, &b);
    lua_pushnumber(L, a.value);
    lua_pushnumber(L, b.value);
    lua_pushboolean(L, lua_compare(L, -2, -1, (int)lua_tointeger(L, lua_upvalueindex(2))));
    return 1;
}

static int to_string(lua_State *L)
{
    const glintL_dual *d = luaL_checkudata(L, 1, GLINTL_DUAL);
    lua_pushnumber(L, d->value);
    lua_tostring(L, -1);
    return 1;
}

static int concatenate(lua_State *L)
{
    luaL_tolstring(L, 1, NULL);
    luaL_tolstring(L, 2, NULL);
    lua_concat(L, 2);
    return 1;
}

void glintL_open_dual(lua_State *L)
{
    static const struct {
        const char *event;
        int code;
        lua_CFunction function;
    } operators[] = {
        { "__add", LUA_OPADD, compute }, { "__sub", LUA_OPSUB, compute }, { "__mul", LUA_OPMUL, compute },
        { "__div", LUA_OPDIV, compute }, { "__mod", LUA_OPMOD, compute }, { "__idiv", LUA_OPIDIV, compute },
        { "__pow", LUA_OPPOW, compute }, { "__eq", LUA_OPEQ, compare },   { "__lt", LUA_OPLT, compare },
        { "__le", LUA_OPLE, compare },
    };
    static const luaL_Reg meta[] = {
        { "__unm", negate }, { "__tostring", to_string }, { "__concat", concatenate }, { NULL, NULL },
    };
    glintL_new_type(L, GLINTL_DUAL, meta);
    luaL_getmetatable(L, GLINTL_DUAL);
    for (size_t i = 0; i < sizeof operators / sizeof *operators; i++) {
        lua_pushstring(L, operators[i].event);
        lua_pushinteger(L, operators[i].code);
        lua_pushcclosure(L, operators[i].function, 2);
        lua_setfield(L, -2, operators[i].event);
    }
    lua_pop(L, 1);
}

// ---- Fields ----

bool glintL_read_duals(lua_State *L, int index, const char *path, bool is_color, int count, double *out)
{
    const glintL_dual *whole = glintL_to_dual(L, index);
    bool any = whole && (count == 1 || is_color);
    if (any)
        for (int c = 0; c < count; c++)
            out[c] = whole->value;
    if (count == 1 || any || !lua_istable(L, index))
        return any;
    double read[3];
    bool good = lua_rawlen(L, index) == 3;
    luaL_checkstack(L, 2, "vector");
    for (int c = 0; c < 3; c++) {
        glintL_dual d = { .value = 0 };
        lua_rawgeti(L, index, c + 1);
        any = any || glintL_to_dual(L, -1);
        good = glintL_read_dual(L, -1, &d) && good;
        read[c] = d.value;
        lua_pop(L, 1);
    }
    if (!any)
        return false;
    if (!good)
        glintL_error(L, "%s: three numbers expected", path);
    memcpy(out, read, sizeof read);
    return true;
}

// The slopes of one field of an object, in the engine's units.
typedef struct slopes {
    glintL_dual of[3]; // slopes of each component
} slopes;

static int count_of(const glintL_field *field)
{
    return field->type >= GLINT_TYPE_VECTOR && field->type <= GLINT_TYPE_COLOR ? 3 : 1;
}

static void key_of(const glintL_field *field, char key[64]) { snprintf(key, 64, "d:%s", field->name); }

// Finds the slopes of the value at `index`; false: it has none.
static bool find_slopes(lua_State *L, int index, const glintL_field *field, slopes *out)
{
    const int count = count_of(field);
    bool any = false;
    *out = (slopes) { { { 0 } } };
    index = lua_absindex(L, index);
    if (glintL_to_dual(L, index)) {
        for (int c = 0; c < count; c++)
            out->of[c] = *glintL_to_dual(L, index);
        return true;
    }
    for (int c = 0; c < 3 && count == 3 && lua_istable(L, index); c++) {
        lua_rawgeti(L, index, c + 1);
        any = glintL_to_dual(L, -1) || any;
        glintL_read_dual(L, -1, &out->of[c]);
        lua_pop(L, 1);
    }
    return any;
}

static void put_slopes(lua_State *L, int object, const glintL_field *field, const slopes *s)
{
    char key[64];
    key_of(field, key);
    if (!s && !glintL_push_kept(L, object, key))
        return; // the common case: no slopes before and after
    if (!s) {
        lua_pushnil(L);
        glintL_keep(L, object, key, -1);
        lua_pop(L, 2);
        return;
    }
    slopes *kept = lua_newuserdatauv(L, sizeof *kept, 0);
    *kept = *s;
    glintL_keep(L, object, key, -1);
    lua_pop(L, 1);
    glintL_note_sloped(L, object);
}

void glintL_note_sloped(lua_State *L, int index)
{
    index = lua_absindex(L, index);
    luaL_checkstack(L, 6, "slopes");
    glintL_push_weak_table(L, &SLOPED, "k");
    lua_pushvalue(L, index);
    lua_pushboolean(L, true);
    lua_rawset(L, -3);
    lua_pop(L, 1);
}

void glintL_keep_slopes(lua_State *L, int index, const glintL_field *field, int value)
{
    slopes s;
    if (!(field->takes & GLINT_TAKES_VARIABLE))
        return;
    luaL_checkstack(L, 8, "field");
    put_slopes(L, lua_absindex(L, index), field, find_slopes(L, value, field, &s) ? &s : NULL);
}

void glintL_keep_part_slopes(lua_State *L, int index, const glintL_field *field, int part, int value)
{
    char key[64];
    slopes s = { { { 0 } } };
    const glintL_dual *d = glintL_to_dual(L, value);
    luaL_checkstack(L, 8, "field");
    key_of(field, key);
    const bool known = glintL_push_kept(L, index, key);
    if (known) {
        s = *(const slopes *)lua_touserdata(L, -1);
        lua_pop(L, 1);
    }
    s.of[part] = d ? *d : (glintL_dual) { .value = 0 };
    if (known || d)
        put_slopes(L, lua_absindex(L, index), field, &s);
}

void glintL_keep_table_slopes(lua_State *L, int index, int table, const glintL_field *fields)
{
    for (const glintL_field *field = fields; field->name; field++) {
        if (!(field->takes & GLINT_TAKES_VARIABLE))
            continue;
        lua_pushstring(L, field->name);
        lua_rawget(L, table);
        glintL_keep_slopes(L, index, field, -1);
        lua_pop(L, 1);
    }
}

bool glintL_push_sloped(lua_State *L, int index, const glintL_field *field)
{
    char key[64];
    if (!(field->takes & GLINT_TAKES_VARIABLE))
        return false;
    key_of(field, key);
    if (!glintL_push_kept(L, index, key))
        return false;
    const slopes *s = lua_touserdata(L, -1);
    if (count_of(field) == 1) {
        glintL_push_dual(L, &s->of[0]);
    } else {
        lua_createtable(L, 3, 3);
        for (int c = 0; c < 3; c++) {
            glintL_push_dual(L, &s->of[c]);
            lua_pushvalue(L, -1);
            lua_rawseti(L, -3, c + 1);
            lua_setfield(L, -2, &"x\0y\0z"[2 * c]);
        }
    }
    lua_remove(L, -2);
    return true;
}

bool glintL_get_slope(lua_State *L, int index, const glintL_field *field, int variable, double out[3])
{
    char key[64];
    bool any = false;
    if (!(field->takes & GLINT_TAKES_VARIABLE))
        return false;
    key_of(field, key);
    if (!glintL_push_kept(L, index, key))
        return false;
    const slopes *s = lua_touserdata(L, -1);
    for (int c = 0; c < 3; c++) {
        out[c] = s->of[c].slope[variable];
        any = any || (s->of[c].depends >> variable & 1);
    }
    lua_pop(L, 1);
    return any;
}

void glintL_push_all_sloped(lua_State *L) { glintL_push_weak_table(L, &SLOPED, "k"); }
