// glint.NAME for the operations of programs: for plain numbers, symbols, and vectors by component.
#include "bindings/pattern/pattern.h"

#include <stdio.h>
#include <string.h>

// Returns the operation, the upvalue of each function.
static glint_op this_op(lua_State *L) { return (glint_op)lua_tointeger(L, lua_upvalueindex(1)); }

static void check_count(lua_State *L, const glint_op_info *info, int least, int most)
{
    const int count = lua_gettop(L);
    if (count >= least && count <= most)
        return;
    if (glintL_is_module(L, 1))
        glintL_error(L, "%s: write glint.%s with a dot, not with a colon", info->name, info->name);
    if (least == most)
        glintL_error(L, "%s: %d argument%s expected, got %d", info->name, least, least == 1 ? "" : "s", count);
    glintL_error(L, "%s: %d or %d arguments expected, got %d", info->name, least, most, count);
}

// Returns whether the operation's result is 0 or 1.
static bool is_choice(glint_op op)
{
    return (op >= GLINT_OP_LESS && op <= GLINT_OP_NOT) || op == GLINT_OP_STEP || op == GLINT_OP_PARITY;
}

// Operations on numbers. Vectors are processed by component; a scalar is combined with each component.
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

// Operations on a point: a vector, or x, y and z.
static int apply_position(lua_State *L)
{
    const glint_op op = this_op(L);
    const glint_op_info *info = glint_op_info_of(op);
    glintL_term position[3], results[GLINT_RESULTS_MAX];
    check_count(L, info, 1, 3);
    const int end = glintL_read_position(L, 1, info->name, position);
    if (lua_gettop(L) >= end)
        return glintL_error(L, "%s: expected a vector, or x, y and z, got more", info->name);
    glintL_apply(L, op, position, results);
    if (op == GLINT_OP_NOISE3) {
        glintL_push_triple(L, results);
        return 1;
    }
    for (uint32_t i = 0; i < info->results; i++)
        (is_choice(op) ? glintL_push_choice : glintL_push_term)(L, results[i]);
    return (int)info->results;
}

static bool is_of_positions(glint_op op)
{
    return op == GLINT_OP_NOISE || op == GLINT_OP_NOISE3 || op == GLINT_OP_CELL || op == GLINT_OP_HASH ||
           op == GLINT_OP_PARITY;
}

// Computes min and max of more than two arguments: of the first two, then of the result and the next.
static int apply_fold(lua_State *L)
{
    if (lua_gettop(L) <= 2)
        return apply_each(L);
    luaL_checkstack(L, 4, "arguments");
    while (lua_gettop(L) > 1) {
        lua_pushvalue(L, lua_upvalueindex(1));
        lua_pushcclosure(L, apply_each, 1);
        lua_pushvalue(L, 1);
        lua_pushvalue(L, 2);
        lua_call(L, 2, 1);
        lua_replace(L, 1);
        lua_remove(L, 2);
    }
    return 1;
}

// ---- exp, log and tan: for plain numbers the functions of math.c, inside a pattern operations ----

static glintL_term exp_term(lua_State *L, glintL_term x)
{
    return glintL_apply1(L, GLINT_OP_EXP2, glintL_apply2(L, GLINT_OP_MUL, glintL_number_term(0x1.71547652b82fep+0), x));
}

static glintL_term log_term(lua_State *L, glintL_term x)
{
    return glintL_apply2(L, GLINT_OP_MUL, glintL_number_term(0x1.62e42fefa39efp-1), glintL_apply1(L, GLINT_OP_LOG2, x));
}

static glintL_term tan_term(lua_State *L, glintL_term x)
{
    return glintL_apply2(L, GLINT_OP_DIV, glintL_apply1(L, GLINT_OP_SIN, x), glintL_apply1(L, GLINT_OP_COS, x));
}

static const struct {
    const char *name;
    glintL_term (*apply)(lua_State *L, glintL_term x);
} COMPOSED[] = { { "exp", exp_term }, { "log", log_term }, { "tan", tan_term } };

#define COMPOSED_COUNT (sizeof COMPOSED / sizeof *COMPOSED)

// Computes exp, log or tan. Upvalues: the function for plain numbers, the index in COMPOSED.
static int apply_composed(lua_State *L)
{
    const lua_Integer index = lua_tointeger(L, lua_upvalueindex(2));
    glintL_operand x;
    const bool is_alone = lua_gettop(L) == 1 && (glintL_current_trace(L) || glintL_to_vector(L, 1) || lua_istable(L, 1));
    if (!is_alone || glintL_is_module(L, 1)) {
        lua_pushvalue(L, lua_upvalueindex(1));
        lua_insert(L, 1);
        lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
        return lua_gettop(L);
    }
    glintL_read_operand(L, 1, COMPOSED[index].name, &x);
    for (int i = 0; i < (x.is_vector ? 3 : 1); i++)
        x.at[i] = COMPOSED[index].apply(L, x.at[i]);
    glintL_push_operand(L, &x);
    return 1;
}

void glintL_open_operation(lua_State *L)
{
    for (glint_op op = 0; op <= GLINT_OP_PARITY; op++) {
        const bool folds = op == GLINT_OP_MIN || op == GLINT_OP_MAX;
        lua_pushinteger(L, (lua_Integer)op);
        lua_pushcclosure(L, is_of_positions(op) ? apply_position : folds ? apply_fold : apply_each, 1);
        lua_setfield(L, -2, glint_op_info_of(op)->name);
    }
    for (size_t i = 0; i < COMPOSED_COUNT; i++) {
        lua_getfield(L, -1, COMPOSED[i].name);
        lua_pushinteger(L, (lua_Integer)i);
        lua_pushcclosure(L, apply_composed, 2);
        lua_setfield(L, -2, COMPOSED[i].name);
    }
}
