// glint.NAME for the operations of programs: of plain numbers, of symbols, and of vectors component by component.
#include "bindings/pattern/pattern.h"

#include <stdio.h>
#include <string.h>

// The operation is the upvalue of each function.
static glint_op this_op(lua_State *L) { return (glint_op)lua_tointeger(L, lua_upvalueindex(1)); }

static void check_count(lua_State *L, const glint_op_info *info, int least, int most)
{
    const int count = lua_gettop(L);
    if (count >= least && count <= most)
        return;
    if (least == most)
        glintL_error(L, "%s: %d argument%s expected, got %d", info->name, least, least == 1 ? "" : "s", count);
    glintL_error(L, "%s: %d or %d arguments expected, got %d", info->name, least, most, count);
}

// Whether it gives 0 or 1.
static bool is_choice(glint_op op)
{
    return (op >= GLINT_OP_LESS && op <= GLINT_OP_NOT) || op == GLINT_OP_STEP || op == GLINT_OP_PARITY;
}

// Operations that know nothing of places: each component of vectors for itself, a scalar with each of them.
static int apply_each(lua_State *L)
{
    const glint_op op = this_op(L);
    const glint_op_info *info = glint_op_info_of(op);
    const int count = (int)info->operands;
    glintL_operand in[GLINT_OPERANDS_MAX], out = { .is_vector = false };
    char path[48];
    check_count(L, info, count, count);
    if (!glintL_current_trace(L) && glintL_dual_function(L, info->name))
        return 1;
    for (int i = 0; i < count; i++) {
        snprintf(path, sizeof path, count > 1 ? "%s: argument %d" : "%s", info->name, i + 1);
        glintL_read_operand(L, i + 1, path, &in[i]);
        out.is_vector = out.is_vector || in[i].is_vector;
    }
    for (int c = 0; c < (out.is_vector ? 3 : 1); c++) {
        glintL_term operands[GLINT_OPERANDS_MAX];
        for (int i = 0; i < count; i++)
            operands[i] = in[i].at[c];
        glintL_apply(L, op, operands, &out.at[c]);
    }
    if (is_choice(op) && !out.is_vector)
        glintL_push_choice(L, out.at[0]);
    else
        glintL_push_operand(L, &out);
    return 1;
}

// Operations on a place: a vector, or x, y and z.
static int apply_place(lua_State *L)
{
    const glint_op op = this_op(L);
    const glint_op_info *info = glint_op_info_of(op);
    glintL_term place[3], results[GLINT_RESULTS_MAX];
    check_count(L, info, 1, 3);
    const int end = glintL_read_place(L, 1, info->name, place);
    if (lua_gettop(L) >= end)
        return glintL_error(L, "%s: a vector, or x, y and z expected, got more", info->name);
    glintL_apply(L, op, place, results);
    if (op == GLINT_OP_NOISE3) {
        glintL_push_triple(L, results);
        return 1;
    }
    for (uint32_t i = 0; i < info->results; i++)
        (is_choice(op) ? glintL_push_choice : glintL_push_term)(L, results[i]);
    return (int)info->results;
}

static bool is_of_places(glint_op op)
{
    return op == GLINT_OP_NOISE || op == GLINT_OP_NOISE3 || op == GLINT_OP_CELL || op == GLINT_OP_HASH ||
           op == GLINT_OP_PARITY;
}

// Functions of plain numbers that programs do not have.
static int refuse_symbol(lua_State *L)
{
    if (luaL_testudata(L, 1, GLINTL_SYMBOL))
        return glintL_error(L, "%s", lua_tostring(L, lua_upvalueindex(2)));
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
    return lua_gettop(L);
}

static void guard(lua_State *L, const char *name, const char *cure)
{
    lua_getfield(L, -1, name);
    lua_pushstring(L, cure);
    lua_pushcclosure(L, refuse_symbol, 2);
    lua_setfield(L, -2, name);
}

void glintL_open_operation(lua_State *L)
{
    for (glint_op op = 0; op <= GLINT_OP_PARITY; op++) {
        lua_pushinteger(L, (lua_Integer)op);
        lua_pushcclosure(L, is_of_places(op) ? apply_place : apply_each, 1);
        lua_setfield(L, -2, glint_op_info_of(op)->name);
    }
    guard(L, "tan", "tan of a symbol: write glint.sin(x) / glint.cos(x)");
    guard(L, "exp", "exp of a symbol: write glint.exp2(1.4426950408889634 * x)");
    guard(L, "log", "log of a symbol: write 0.6931471805599453 * glint.log2(x)");
}
