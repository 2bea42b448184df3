// glint.sin and similar functions: their results have the same bits on every machine, unlike the C library's.
#include "bindings/lua/lua.h"

static int apply(lua_State *L, const char *path, double (*function)(double))
{
    if (!glintL_dual_function(L, path))
        lua_pushnumber(L, function(glintL_read_number(L, 1, path)));
    return 1;
}

static int math_sin(lua_State *L) { return apply(L, "sin", glint_sin); }

static int math_cos(lua_State *L) { return apply(L, "cos", glint_cos); }

static int math_tan(lua_State *L) { return apply(L, "tan", glint_tan); }

static int math_exp(lua_State *L) { return apply(L, "exp", glint_exp); }

static int math_log(lua_State *L)
{
    if (!lua_isnoneornil(L, 2))
        glintL_error(L, "log: one number expected; for another base, divide by glint.log(base)");
    return apply(L, "log", glint_log);
}

static int math_pow(lua_State *L)
{
    if (glintL_dual_function(L, "pow"))
        return 1;
    double x = glintL_read_number(L, 1, "pow");
    lua_pushnumber(L, glint_pow(x, glintL_read_number(L, 2, "pow")));
    return 1;
}

void glintL_open_math(lua_State *L)
{
    static const luaL_Reg functions[] = {
        { "sin", math_sin }, { "cos", math_cos }, { "tan", math_tan }, { "exp", math_exp },
        { "log", math_log }, { "pow", math_pow }, { NULL, NULL },
    };
    luaL_setfuncs(L, functions, 0);
}
