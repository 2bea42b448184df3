// glint.variable, glint.value, and the functions of `math` for dual numbers.
#include <math.h>
#include <string.h>

#include "bindings/value/glintL.h"

static const char MATH; // address used as a registry key; the value true means that math is extended

static int push_result(lua_State *L, glintL_dual d)
{
    glintL_push_dual(L, &d);
    return 1;
}

// ---- Functions of one number ----

typedef struct function {
    const char *name;
    double (*value)(double x), (*slope)(double x, double y); // value and slope of the function; y: the value at x
} function;

static double slope_sin(double x, double y) { return (void)y, glint_cos(x); }
static double slope_cos(double x, double y) { return (void)y, -glint_sin(x); }
static double slope_tan(double x, double y) { return (void)x, 1 + y * y; }
static double slope_exp(double x, double y) { return (void)x, y; }
static double slope_log(double x, double y) { return (void)y, 1 / x; }
static double slope_sqrt(double x, double y) { return (void)x, 0.5 / y; }
static double slope_abs(double x, double y) { return (void)y, x < 0 ? -1.0 : x > 0 ? 1.0 : 0.0; }
static double slope_asin(double x, double y) { return (void)y, 1 / sqrt((1 - x) * (1 + x)); }
static double slope_acos(double x, double y) { return -slope_asin(x, y); }
static double slope_level(double x, double y) { return (void)x, (void)y, 0; }

static const function own[] = {
    { "sin", glint_sin, slope_sin }, { "cos", glint_cos, slope_cos }, { "tan", glint_tan, slope_tan },
    { "exp", glint_exp, slope_exp }, { "log", glint_log, slope_log }, { "sqrt", sqrt, slope_sqrt },
    { "abs", fabs, slope_abs },      { "floor", floor, slope_level }, { "ceil", ceil, slope_level },
    { NULL, NULL, NULL },
};
static const function of_lua[] = {
    { "sin", sin, slope_sin },       { "cos", cos, slope_cos },       { "tan", tan, slope_tan },
    { "exp", exp, slope_exp },       { "log", log, slope_log },       { "sqrt", sqrt, slope_sqrt },
    { "abs", fabs, slope_abs },      { "asin", asin, slope_asin },    { "acos", acos, slope_acos },
    { "floor", floor, slope_level }, { "ceil", ceil, slope_level },   { NULL, NULL, NULL },
};

// Pushes the greater or the smaller of the numbers at 1 and 2.
static bool push_extreme(lua_State *L, bool most)
{
    glintL_dual a, b;
    if (!glintL_read_dual(L, 1, &a) || !glintL_read_dual(L, 2, &b))
        return false;
    lua_pushvalue(L, (most ? a.value > b.value : a.value < b.value) ? 1 : 2);
    return true;
}

bool glintL_dual_function(lua_State *L, const char *name)
{
    const glintL_dual *x = glintL_to_dual(L, 1);
    if ((x || glintL_to_dual(L, 2)) && strcmp(name, "pow") == 0) {
        glintL_dual a, b;
        if (!glintL_read_dual(L, 1, &a) || !glintL_read_dual(L, 2, &b))
            return false;
        push_result(L, glintL_dual_pow(&a, &b));
        return true;
    }
    if ((x || glintL_to_dual(L, 2)) && (strcmp(name, "min") == 0 || strcmp(name, "max") == 0))
        return push_extreme(L, name[1] == 'a');
    for (const function *f = own; x && f->name; f++) {
        if (strcmp(f->name, name) != 0)
            continue;
        const double y = f->value(x->value);
        if (f->slope == slope_level)
            lua_pushnumber(L, y);
        else
            push_result(L, glintL_dual_apply(x, f->slope(x->value, y), NULL, 0, y));
        return true;
    }
    return false;
}

// Calls Lua's own function, the first upvalue, with the same arguments.
static int call_plain(lua_State *L)
{
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
    return lua_gettop(L);
}

static int apply_one(lua_State *L)
{
    const function *f = lua_touserdata(L, lua_upvalueindex(2));
    const glintL_dual *x = glintL_to_dual(L, 1);
    if (!x)
        return call_plain(L);
    if (lua_gettop(L) > 1)
        return glintL_error(L, "math.%s: expected no second argument, because the first depends on glint.variable", f->name);
    const double y = f->value(x->value);
    if (f->slope == slope_level) { // rounding functions return integers, as in Lua
        lua_pushnumber(L, y);
        lua_Number floating = lua_tonumber(L, -1);
        lua_Integer whole;
        if (lua_numbertointeger(floating, &whole))
            lua_pushinteger(L, whole);
        return 1;
    }
    return push_result(L, glintL_dual_apply(x, f->slope(x->value, y), NULL, 0, y));
}

// ---- Functions of several numbers ----

// Computes min or max. Upvalues: Lua's own function; whether it is max.
static int apply_extreme(lua_State *L)
{
    const bool most = lua_toboolean(L, lua_upvalueindex(2));
    const int count = lua_gettop(L);
    int best = 1;
    bool any = false;
    for (int i = 1; i <= count; i++)
        any = any || glintL_to_dual(L, i);
    if (!any)
        return call_plain(L);
    for (int i = 1; i <= count; i++) {
        glintL_dual x, y;
        if (!glintL_read_dual(L, i, &x) || !glintL_read_dual(L, best, &y))
            glintL_refuse(L, i, most ? "math.max" : "math.min", "number");
        best = (most ? x.value > y.value : x.value < y.value) ? i : best;
    }
    lua_pushvalue(L, best);
    return 1;
}

static int apply_atan(lua_State *L)
{
    glintL_dual y, x = { .value = 1 };
    if (!glintL_to_dual(L, 1) && !glintL_to_dual(L, 2))
        return call_plain(L);
    if (!glintL_read_dual(L, 1, &y) || (!lua_isnoneornil(L, 2) && !glintL_read_dual(L, 2, &x)))
        return glintL_error(L, "math.atan: numbers expected");
    const double r2 = x.value * x.value + y.value * y.value;
    return push_result(L, glintL_dual_apply(&y, x.value / r2, &x, -y.value / r2, atan2(y.value, x.value)));
}

// Extends the functions of `math` to dual numbers when the first variable is made. Other scripts keep Lua's functions.
static void extend_math(lua_State *L)
{
    luaL_checkstack(L, 6, "math");
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &MATH) != LUA_TNIL || lua_getglobal(L, "math") != LUA_TTABLE) {
        lua_settop(L, -2);
        return;
    }
    lua_pushboolean(L, true);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &MATH);
    for (const function *f = of_lua; f->name; f++) {
        lua_getfield(L, -1, f->name);
        lua_pushlightuserdata(L, (void *)(uintptr_t)f);
        lua_pushcclosure(L, apply_one, 2);
        lua_setfield(L, -2, f->name);
    }
    for (int most = 0; most < 2; most++) {
        lua_getfield(L, -1, most ? "max" : "min");
        lua_pushboolean(L, most);
        lua_pushcclosure(L, apply_extreme, 2);
        lua_setfield(L, -2, most ? "max" : "min");
    }
    lua_getfield(L, -1, "atan");
    lua_pushcclosure(L, apply_atan, 1);
    lua_setfield(L, -2, "atan");
    lua_pop(L, 2);
}

// ---- The module's functions ----

void glintL_make_variable(lua_State *L, const char *name, double value)
{
    const int top = lua_gettop(L);
    extend_math(L);
    lua_settop(L, top);
    glintL_push_variable(L, name, value);
}

static int new_variable(lua_State *L)
{
    size_t length;
    if (lua_type(L, 1) != LUA_TSTRING)
        glintL_refuse(L, 1, "variable.name", "string");
    const char *name = lua_tolstring(L, 1, &length);
    if (length == 0 || length >= GLINT_DERIVATIVE_NAME_SIZE || strcspn(name, ", ") != length)
        glintL_refuse(L, 1, "variable.name", "name of 1 to 31 bytes without blanks and commas");
    const double value = glintL_read_number(L, 2, "variable.value");
    if (!isfinite(value))
        glintL_refuse(L, 2, "variable.value", "finite number");
    glintL_make_variable(L, name, value);
    return 1;
}

static int value_of(lua_State *L)
{
    const glintL_dual *d = glintL_to_dual(L, 1);
    lua_pushnumber(L, d ? d->value : glintL_read_number(L, 1, "value"));
    return 1;
}

void glintL_open_variable(lua_State *L)
{
    static const luaL_Reg functions[] = { { "variable", new_variable }, { "value", value_of }, { NULL, NULL } };
    glintL_open_dual(L);
    luaL_setfuncs(L, functions, 0);
}
