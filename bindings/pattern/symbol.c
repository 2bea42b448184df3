// glint.symbol: a number that is known only at each point. Operators on it write the program.
#include "bindings/pattern/pattern.h"

#include <math.h>
#include <string.h>

// ---- Powers ----

#define PRODUCTS_MAX 16 // largest whole exponent computed by products

static glintL_term whole_power(lua_State *L, glintL_term base, int exponent)
{
    glintL_term power = glintL_number_term(1);
    bool has_power = false;
    for (int bits = exponent; bits > 0; bits >>= 1) {
        if (bits & 1)
            power = has_power ? glintL_apply2(L, GLINT_OP_MUL, power, base) : base;
        has_power = has_power || bits & 1;
        if (bits > 1)
            base = glintL_apply2(L, GLINT_OP_MUL, base, base);
    }
    return power;
}

// Computes a power. In Lua x ^ 2 is x * x, too. Other powers use C's pow there, so their last bits may differ from the
// program's.
static glintL_term power_of(lua_State *L, glintL_term base, glintL_term exponent)
{
    const double e = exponent.number;
    const bool is_whole = !exponent.is_symbol && e == floor(e) && fabs(e) <= PRODUCTS_MAX;
    if (!is_whole || e < 0 || e > 2)
        glintL_current_trace(L)->has_power = true;
    if (!exponent.is_symbol && e == 0.5)
        return glintL_apply1(L, GLINT_OP_SQRT, base);
    if (!is_whole)
        return glintL_apply2(L, GLINT_OP_POW, base, exponent);
    const glintL_term power = whole_power(L, base, (int)fabs(e));
    return e < 0 ? glintL_apply2(L, GLINT_OP_DIV, glintL_number_term(1), power) : power;
}

// ---- Operators ----

static glintL_term operate(lua_State *L, glint_op op, glintL_term a, glintL_term b)
{
    const bool is_number = !a.is_symbol && !b.is_symbol;
    if (op == GLINT_OP_POW && is_number)
        return glintL_number_term(b.number == 2 ? a.number * a.number : pow(a.number, b.number)); // as in Lua
    if (op == GLINT_OP_POW)
        return power_of(L, a, b);
    if (op == GLINT_OP_FLOOR) // floor of the quotient
        return glintL_apply1(L, GLINT_OP_FLOOR, glintL_apply2(L, GLINT_OP_DIV, a, b));
    return glintL_apply2(L, op, a, b);
}

static int apply_operator(lua_State *L, glint_op op)
{
    static const char *const signs[] = {
        [GLINT_OP_ADD] = "a + b", [GLINT_OP_SUB] = "a - b", [GLINT_OP_MUL] = "a * b",    [GLINT_OP_DIV] = "a / b",
        [GLINT_OP_MOD] = "a % b", [GLINT_OP_POW] = "a ^ b", [GLINT_OP_FLOOR] = "a // b",
    };
    glintL_operand a, b, result;
    if (glintL_to_array(L, 2) && op <= GLINT_OP_DIV) // vector + array
        return glintL_array_operate(L, op == GLINT_OP_ADD ? LUA_OPADD : op == GLINT_OP_SUB ? LUA_OPSUB : op == GLINT_OP_MUL ? LUA_OPMUL : LUA_OPDIV);
    for (int i = 1; i <= 2; i++)
        if (lua_type(L, i) == LUA_TSTRING) // Lua would convert "1" to a number
            glintL_refuse(L, i, signs[op], "number, symbol or vector");
    glintL_read_operand(L, 1, signs[op], &a);
    glintL_read_operand(L, 2, signs[op], &b);
    result.is_vector = a.is_vector || b.is_vector;
    for (int i = 0; i < (result.is_vector ? 3 : 1); i++)
        result.at[i] = operate(L, op, a.at[i], b.at[i]);
    glintL_push_operand(L, &result);
    return 1;
}

static int add(lua_State *L) { return apply_operator(L, GLINT_OP_ADD); }

static int subtract(lua_State *L) { return apply_operator(L, GLINT_OP_SUB); }

static int multiply(lua_State *L) { return apply_operator(L, GLINT_OP_MUL); }

static int divide(lua_State *L) { return apply_operator(L, GLINT_OP_DIV); }

static int modulo(lua_State *L) { return apply_operator(L, GLINT_OP_MOD); }

static int power(lua_State *L) { return apply_operator(L, GLINT_OP_POW); }

static int floor_divide(lua_State *L) { return apply_operator(L, GLINT_OP_FLOOR); }

static int negate(lua_State *L)
{
    glintL_operand a;
    glintL_read_operand(L, 1, "-a", &a);
    for (int i = 0; i < (a.is_vector ? 3 : 1); i++)
        a.at[i] = glintL_apply1(L, GLINT_OP_NEG, a.at[i]);
    glintL_push_operand(L, &a);
    return 1;
}

// ---- Operations that cannot be traced ----

// Refuses math.min and math.max, which compare their arguments.
static void refuse_least(lua_State *L)
{
    lua_Debug caller;
    if (!lua_getstack(L, 1, &caller) || !lua_getinfo(L, "Sn", &caller) || *caller.what != 'C' || !caller.name)
        return;
    if (strcmp(caller.name, "min") == 0 || strcmp(caller.name, "max") == 0)
        glintL_error(L, "math.%s of a symbol: its value is not known, because the function runs once for all points; "
                        "write glint.%s", caller.name,
                     caller.name);
}

static int refuse_less(lua_State *L)
{
    refuse_least(L);
    return glintL_error(L, "a < b or a > b of a symbol: its value is not known, because the function runs once for "
                           "all points; write glint.select(glint.less(a, b), x, y)");
}

static int refuse_less_equal(lua_State *L)
{
    return glintL_error(L, "a <= b or a >= b of a symbol: its value is not known, because the function runs once for "
                           "all points; write glint.select(glint.lesseq(a, b), x, y)");
}

static int refuse_concat(lua_State *L)
{
    return glintL_error(L, "a .. b of a symbol: it cannot become text, because its value is not known when the "
                           "function runs");
}

static int refuse_bits(lua_State *L)
{
    return glintL_error(L, "& | ~ << >> of a symbol: it is not an integer; use products and glint.floor, or "
                           "glint.hash");
}

void glintL_set_arithmetic(lua_State *L)
{
    static const luaL_Reg operators[] = {
        { "__add", add },   { "__sub", subtract }, { "__mul", multiply },      { "__div", divide },
        { "__mod", modulo }, { "__pow", power },    { "__idiv", floor_divide }, { "__unm", negate },
        { NULL, NULL },
    };
    luaL_setfuncs(L, operators, 0);
}

void glintL_set_operators(lua_State *L)
{
    static const luaL_Reg refused[] = {
        { "__lt", refuse_less },  { "__le", refuse_less_equal }, { "__concat", refuse_concat },
        { "__band", refuse_bits }, { "__bor", refuse_bits },      { "__bxor", refuse_bits },
        { "__bnot", refuse_bits }, { "__shl", refuse_bits },      { "__shr", refuse_bits },
        { NULL, NULL },
    };
    glintL_set_arithmetic(L);
    luaL_setfuncs(L, refused, 0);
    glintL_set_flag(L, "__metatable", false);
}

static int refuse_equal(lua_State *L)
{
    return glintL_error(L, "a == b or a ~= b of symbols: their values are not known, because the function runs once "
                           "for all points; write glint.select(glint.equal(a, b), x, y)");
}

static int refuse_length(lua_State *L)
{
    return glintL_error(L, "#a of a symbol: it is one number; glint.length(v) is the length of a vector");
}

static int refuse_index(lua_State *L)
{
    return glintL_error(L, "symbol.%s: a symbol is one number and has no fields; vectors have x, y and z",
                        luaL_tolstring(L, 2, NULL));
}

static int refuse_call(lua_State *L)
{
    return glintL_error(L, "a symbol is called: it is a number, not a function; is a * missing?");
}

static int to_string(lua_State *L)
{
    lua_pushliteral(L, "symbol");
    return 1;
}

void glintL_open_symbol(lua_State *L)
{
    static const luaL_Reg meta[] = {
        { "__eq", refuse_equal },
        { "__len", refuse_length },
        { "__index", refuse_index },
        { "__newindex", refuse_index },
        { "__call", refuse_call },
        { "__tostring", to_string },
        { NULL, NULL },
    };
    luaL_newmetatable(L, GLINTL_SYMBOL);
    glintL_set_operators(L);
    luaL_setfuncs(L, meta, 0);
    lua_pop(L, 1);
}
