// The arithmetic of arrays: operators, sums and extremes.
#include <math.h>
#include <stdint.h>

#include "bindings/value/array.h"

#define STEPS_MAX ((lua_Integer)1 << 53)

// An operand: an array, a number, or one number for each column.
typedef struct operand {
    const glintL_array *array;
    double number[WIDTH_MAX];
    lua_Integer whole;
    bool is_whole; // the number is whole, and the other operand is an array of whole numbers
} operand;

static void read_operand(lua_State *L, int index, const glintL_array *other, const char *sign, operand *out)
{
    const double *v = glintL_to_vector(L, index);
    const size_t width = other ? other->width : 1;
    out->array = glintL_to_array(L, index);
    out->is_whole = lua_isinteger(L, index);
    out->whole = lua_tointeger(L, index);
    if (out->array) {
        out->is_whole = out->array->is_whole;
        return;
    }
    const bool is_list = lua_istable(L, index) && lua_rawlen(L, index) == width && width > 1;
    if (lua_type(L, index) != LUA_TNUMBER && !is_list && !(v && width == 3))
        glintL_refuse(L, index, sign, width == 1 ? "array or number" : "array, number, or a number for each column");
    for (size_t c = 0; c < width; c++) {
        if (is_list) {
            lua_rawgeti(L, index, (lua_Integer)c + 1);
            out->number[c] = glintL_read_number(L, -1, sign);
            lua_pop(L, 1);
        } else
            out->number[c] = v ? v[c] : lua_tonumber(L, index);
    }
}

static double apply(int op, double a, double b)
{
    switch (op) {
    case LUA_OPADD:
        return a + b;
    case LUA_OPSUB:
        return a - b;
    case LUA_OPMUL:
        return a * b;
    default:
        return a / b;
    }
}

static int64_t apply_whole(int op, int64_t a, int64_t b) // wraps around, as in Lua
{
    const uint64_t x = (uint64_t)a, y = (uint64_t)b;
    return (int64_t)(op == LUA_OPADD ? x + y : op == LUA_OPSUB ? x - y : x * y);
}

static double operand_at(const operand *o, size_t i, size_t column)
{
    return o->array ? number_at(o->array, i) : o->number[column];
}

int glintL_array_operate(lua_State *L, int op)
{
    static const char *const signs[] = {
        [LUA_OPADD] = "a + b", [LUA_OPSUB] = "a - b", [LUA_OPMUL] = "a * b", [LUA_OPDIV] = "a / b"
    };
    const glintL_array *left = glintL_to_array(L, 1), *right = glintL_to_array(L, 2), *any = left ? left : right;
    operand a, b;
    if (left && right && (left->count != right->count || left->width != right->width))
        return glintL_error(L, "%s: arrays of the same size expected, got %I x %I and %I x %I", signs[op],
                            (LUAI_UACINT)left->count, (LUAI_UACINT)left->width, (LUAI_UACINT)right->count,
                            (LUAI_UACINT)right->width);
    read_operand(L, 1, any, signs[op], &a);
    read_operand(L, 2, any, signs[op], &b);
    const bool is_whole = a.is_whole && b.is_whole && op != LUA_OPDIV;
    glintL_array *out = glintL_push_array(L, any->count, any->width, is_whole);
    for (size_t row = 0, i = 0; row < out->count; row++) {
        for (size_t c = 0; c < out->width; c++, i++) {
            if (is_whole)
                out->wholes[i] = apply_whole(op, a.array ? a.array->wholes[i] : a.whole, b.array ? b.array->wholes[i] : b.whole);
            else
                out->numbers[i] = apply(op, operand_at(&a, i, c), operand_at(&b, i, c));
        }
    }
    return 1;
}

int glintL_array_add(lua_State *L) { return glintL_array_operate(L, LUA_OPADD); }
int glintL_array_subtract(lua_State *L) { return glintL_array_operate(L, LUA_OPSUB); }
int glintL_array_multiply(lua_State *L) { return glintL_array_operate(L, LUA_OPMUL); }
int glintL_array_divide(lua_State *L) { return glintL_array_operate(L, LUA_OPDIV); }

int glintL_array_negate(lua_State *L)
{
    lua_settop(L, 1); // an operator without a second operand gets the first one twice
    lua_pushinteger(L, -1);
    return glintL_array_operate(L, LUA_OPMUL);
}

int glintL_array_floor(lua_State *L)
{
    const glintL_array *a = glintL_check_array(L);
    glintL_array *out = glintL_push_array(L, a->count, a->width, a->is_whole);
    for (size_t i = 0; i < a->count * a->width; i++) {
        if (a->is_whole)
            out->wholes[i] = a->wholes[i];
        else
            out->numbers[i] = floor(a->numbers[i]);
    }
    return 1;
}

// bins(low, high, count): 1 .. count, equal parts of low .. high; beyond them the nearest; count + 1 for NaN.
int glintL_array_bins(lua_State *L)
{
    const glintL_array *a = glintL_check_array(L);
    const double low = glintL_read_number(L, 2, "array.bins.low"), high = glintL_read_number(L, 3, "array.bins.high");
    const lua_Integer count = luaL_checkinteger(L, 4);
    if (!(low < high) || count < 1 || count > STEPS_MAX)
        return glintL_error(L, "array.bins: low below high and a count >= 1 expected, got %f, %f and %I", low, high,
                            (LUAI_UACINT)count);
    const double scale = (double)count / (high - low);
    glintL_array *out = glintL_push_array(L, a->count, a->width, true);
    for (size_t i = 0; i < a->count * a->width; i++) {
        const double share = (number_at(a, i) - low) * scale, last = (double)(count - 1);
        out->wholes[i] = isnan(share) ? count + 1 : share > 0 ? (int64_t)fmin(share, last) + 1 : 1;
    }
    return 1;
}

// counts(): a list; its n-th number is how often the whole number n occurs.
int glintL_array_counts(lua_State *L)
{
    const glintL_array *a = glintL_check_array(L);
    if (!a->is_whole || a->width != 1)
        return glintL_error(L, "array.counts: array of integers expected");
    lua_newtable(L);
    for (size_t i = 0, same = 0; i < a->count; i++) {
        same++;
        if (i + 1 < a->count && a->wholes[i] == a->wholes[i + 1])
            continue;
        lua_rawgeti(L, -1, a->wholes[i]);
        lua_pushinteger(L, lua_tointeger(L, -1) + (lua_Integer)same);
        lua_rawseti(L, -3, a->wholes[i]);
        lua_pop(L, 1);
        same = 0;
    }
    return 1;
}

// ---- Sums and extremes of each column ----

typedef enum summary { MIN, MAX, SUM, MEAN } summary;

// Returns the sum of a column with the terms that plain addition loses (A. Neumaier, ZAMM 54, 1974).
static double sum_of(const glintL_array *a, size_t column)
{
    double sum = 0, lost = 0;
    for (size_t i = column; i < a->count * a->width; i += a->width) {
        const double x = number_at(a, i), next = sum + x;
        lost += fabs(sum) >= fabs(x) ? (sum - next) + x : (x - next) + sum;
        sum = next;
    }
    return isfinite(sum) ? sum + lost : sum;
}

// Returns the position of the smallest or largest number of a column; of the first one if all are NaN.
static size_t extreme(const glintL_array *a, size_t column, bool largest)
{
    size_t best = column;
    for (size_t i = column + a->width; i < a->count * a->width; i += a->width) {
        bool is_better;
        if (a->is_whole)
            is_better = largest ? a->wholes[i] > a->wholes[best] : a->wholes[i] < a->wholes[best];
        else
            is_better = isnan(a->numbers[best]) || (largest ? a->numbers[i] > a->numbers[best] : a->numbers[i] < a->numbers[best]);
        best = is_better ? i : best;
    }
    return best;
}

static void push_summary(lua_State *L, const glintL_array *a, size_t column, summary what)
{
    int64_t whole = 0;
    if (what == MIN || what == MAX) {
        glintL_push_element(L, a, extreme(a, column, what == MAX));
    } else if (what == SUM && a->is_whole) {
        for (size_t i = column; i < a->count * a->width; i += a->width)
            whole = apply_whole(LUA_OPADD, whole, a->wholes[i]);
        lua_pushinteger(L, whole);
    } else
        lua_pushnumber(L, sum_of(a, column) / (what == MEAN ? (double)a->count : 1));
}

static int summarize(lua_State *L, summary what, const char *name)
{
    const glintL_array *a = glintL_check_array(L);
    if (a->count == 0 && what != SUM)
        return glintL_error(L, "array.%s: array with at least one row expected", name);
    if (a->width > 1)
        lua_createtable(L, (int)a->width, 0);
    for (size_t c = 0; c < a->width; c++) {
        push_summary(L, a, c, what);
        if (a->width > 1)
            lua_rawseti(L, -2, (lua_Integer)c + 1);
    }
    if (a->width == 3) {
        double v[3];
        glintL_read_three(L, -1, name, "three numbers", v);
        glintL_push_vector(L, v);
    }
    return 1;
}

int glintL_array_min(lua_State *L) { return summarize(L, MIN, "min"); }
int glintL_array_max(lua_State *L) { return summarize(L, MAX, "max"); }
int glintL_array_sum(lua_State *L) { return summarize(L, SUM, "sum"); }
int glintL_array_mean(lua_State *L) { return summarize(L, MEAN, "mean"); }
