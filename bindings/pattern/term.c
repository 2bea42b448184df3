// Numbers and symbols in C.
#include "bindings/pattern/pattern.h"

#include <ctype.h>
#include <float.h>
#include <stdio.h>
#include <string.h>

typedef struct symbol {
    uint64_t serial; // serial number of the symbol's trace
    glint_value value;
    uint32_t choice; // number of the choice, from 1 on; 0: not a choice
} symbol;

typedef struct traces {
    glintL_trace *innermost;
    uint64_t count;
} traces;

static const char TRACES; // address used as a registry key

static traces *get_traces(lua_State *L)
{
    luaL_checkstack(L, 2, "trace");
    lua_rawgetp(L, LUA_REGISTRYINDEX, &TRACES);
    traces *all = lua_touserdata(L, -1);
    lua_pop(L, 1);
    if (!all) {
        all = lua_newuserdatauv(L, sizeof *all, 0);
        *all = (traces) { NULL, 0 };
        lua_rawsetp(L, LUA_REGISTRYINDEX, &TRACES);
    }
    return all;
}

glintL_trace *glintL_current_trace(lua_State *L) { return get_traces(L)->innermost; }

void glintL_enter_trace(lua_State *L, glintL_trace *trace)
{
    traces *all = get_traces(L);
    trace->serial = ++all->count;
    trace->outer = all->innermost;
    all->innermost = trace;
}

void glintL_leave_trace(lua_State *L, const glintL_trace *trace) { get_traces(L)->innermost = trace->outer; }

// ---- Computing ----

glintL_term glintL_number_term(double number) { return (glintL_term) { .number = number }; }

static glint_value value_of(lua_State *L, glint_builder *builder, glintL_term term)
{
    glint_error error;
    glint_value value = term.value;
    if (!term.is_symbol)
        glintL_check_status(L, "", &error, glint_builder_number(builder, term.number, &value, &error));
    return value;
}

static void apply_symbols(lua_State *L, glint_op op, const glint_op_info *info, const glintL_term *operands,
                          glintL_term *results)
{
    glint_error error;
    glint_value in[GLINT_OPERANDS_MAX], out[GLINT_RESULTS_MAX];
    glint_builder *builder = glintL_current_trace(L)->builder;
    for (uint32_t i = 0; i < info->operands; i++)
        in[i] = value_of(L, builder, operands[i]);
    glintL_check_status(L, "", &error, glint_builder_op(builder, op, in, out, &error));
    for (uint32_t i = 0; i < info->results; i++) {
        results[i] = (glintL_term) { .value = out[i] };
        results[i].is_symbol = !glint_builder_is_number(builder, out[i], &results[i].number);
    }
}

void glintL_apply(lua_State *L, glint_op op, const glintL_term *operands, glintL_term *results)
{
    const glint_op_info *info = glint_op_info_of(op);
    double in[GLINT_OPERANDS_MAX], out[GLINT_RESULTS_MAX];
    for (uint32_t i = 0; i < info->operands; i++) {
        if (operands[i].is_symbol) {
            apply_symbols(L, op, info, operands, results);
            return;
        }
        in[i] = operands[i].number;
    }
    glint_op_apply(op, in, out);
    for (uint32_t i = 0; i < info->results; i++)
        results[i] = glintL_number_term(out[i]);
}

glintL_term glintL_apply1(lua_State *L, glint_op op, glintL_term a)
{
    glintL_term result;
    glintL_apply(L, op, &a, &result);
    return result;
}

glintL_term glintL_apply2(lua_State *L, glint_op op, glintL_term a, glintL_term b)
{
    glintL_term result;
    glintL_apply(L, op, (const glintL_term[2]) { a, b }, &result);
    return result;
}

glintL_term glintL_apply3(lua_State *L, glint_op op, glintL_term a, glintL_term b, glintL_term c)
{
    glintL_term result;
    glintL_apply(L, op, (const glintL_term[3]) { a, b, c }, &result);
    return result;
}

glintL_term glintL_dot_terms(lua_State *L, const glintL_term a[3], const glintL_term b[3])
{
    glintL_term sum = glintL_apply2(L, GLINT_OP_MUL, a[0], b[0]);
    for (int i = 1; i < 3; i++)
        sum = glintL_apply2(L, GLINT_OP_ADD, sum, glintL_apply2(L, GLINT_OP_MUL, a[i], b[i]));
    return sum;
}

// ---- From Lua ----

// Converts a number with slopes: while tracing, to a parameter of the program; at one point, to the number. A slope of
// 0 by a variable that the number depends on becomes the smallest number, so that the program records the dependency;
// its products vanish in float32.
static glintL_term dual_term(lua_State *L, const glintL_trace *trace, const glintL_dual *d)
{
    glint_error error;
    glintL_term term = { .is_symbol = true };
    double slope[GLINTL_VARIABLES_MAX];
    for (int i = 0; i < GLINTL_VARIABLES_MAX; i++)
        slope[i] = d->slope[i] == 0 && d->depends >> i & 1 ? DBL_TRUE_MIN : d->slope[i];
    if (!trace->builder || !d->depends)
        return glintL_number_term(d->value);
    glintL_check_status(L, "", &error,
                        glint_builder_parameter(trace->builder, d->value, slope, GLINTL_VARIABLES_MAX, &term.value, &error));
    return term;
}

// Reads a number or a symbol; false: it is neither. Raises for a symbol that has outlived its function.
static bool to_term(lua_State *L, int index, glintL_term *out)
{
    if (lua_type(L, index) == LUA_TNUMBER) {
        *out = glintL_number_term(lua_tonumber(L, index));
        return true;
    }
    const glintL_dual *d = glintL_to_dual(L, index);
    glintL_trace *trace = glintL_current_trace(L);
    if (d && trace) {
        *out = dual_term(L, trace, d);
        return true;
    }
    const symbol *found = luaL_testudata(L, index, GLINTL_SYMBOL);
    if (!found)
        return false;
    if (!trace || trace->serial != found->serial)
        glintL_error(L, "a symbol of another call of a pattern's function: values computed from p or s are valid "
                        "only during that call; do not store them in variables outside the function");
    if (found->choice)
        trace->choices.used[(found->choice - 1) / 64] |= (uint64_t)1 << (found->choice - 1) % 64;
    *out = (glintL_term) { .is_symbol = true, .value = found->value };
    return true;
}

// Pops a key and reads the element there, without metamethods.
static bool to_element(lua_State *L, int index, glintL_term *out)
{
    lua_rawget(L, index);
    bool found = to_term(L, -1, out);
    lua_pop(L, 1);
    return found;
}

static bool to_named(lua_State *L, int index, glintL_operand *out)
{
    bool found = true;
    for (int i = 0; i < 3 && found; i++) {
        lua_pushstring(L, &"x\0y\0z"[2 * i]);
        found = to_element(L, index, &out->at[i]);
    }
    return found;
}

static bool to_list(lua_State *L, int index, glintL_operand *out)
{
    bool found = lua_rawlen(L, index) == 3;
    for (int i = 0; i < 3 && found; i++) {
        lua_pushinteger(L, i + 1);
        found = to_element(L, index, &out->at[i]);
    }
    return found;
}

static bool is_color_name(lua_State *L, int index)
{
    const char *text = lua_type(L, index) == LUA_TSTRING ? lua_tostring(L, index) : "";
    return *text == '#' || isalpha((unsigned char)*text);
}

bool glintL_to_operand(lua_State *L, int index, bool allow_color, glintL_operand *out)
{
    double color[3];
    const double *vector = NULL;
    index = lua_absindex(L, index);
    luaL_checkstack(L, 8, "operand");
    out->is_vector = false;
    if (to_term(L, index, &out->at[0])) {
        out->at[1] = out->at[2] = out->at[0];
        return true;
    }
    out->is_vector = true;
    if (lua_istable(L, index))
        return to_named(L, index, out) || to_list(L, index, out);
    if (allow_color && is_color_name(L, index)) {
        glintL_read_color(L, index, "", color);
        vector = color;
    } else {
        vector = glintL_to_vector(L, index);
    }
    for (int i = 0; vector && i < 3; i++)
        out->at[i] = glintL_number_term(vector[i]);
    return vector != NULL;
}

void glintL_read_operand(lua_State *L, int index, const char *path, glintL_operand *out)
{
    if (glintL_to_operand(L, index, true, out))
        return;
    if (lua_istable(L, index) && luaL_getmetafield(L, index, "__name") == LUA_TSTRING &&
        strcmp(lua_tostring(L, -1), GLINTL_SURROUNDINGS) == 0)
        glintL_error(L, "%s: number, symbol or vector expected, got s, the values of the point; a pattern is a function(p, s), "
                        "where p has x, y and z",
                     path);
    if (lua_istable(L, index))
        glintL_error(L, "%s: expected a number, a symbol or a vector {x, y, z}, got another table", path);
    if (glintL_to_dual(L, index)) // inside a pattern's function it is allowed
        glintL_error(L, "%s: number or vector expected, got a number made of glint.variable; glint.value(x) is the "
                        "plain number", path);
    if (lua_isnoneornil(L, index))
        glintL_error(L, "%s: number, symbol or vector expected, got %s: is a variable or a field not set?", path,
                     glintL_push_spelling(L, index));
    glintL_refuse(L, index, path, "number, symbol or vector");
}

glintL_term glintL_read_term(lua_State *L, int index, const char *path)
{
    glintL_operand operand;
    glintL_read_operand(L, index, path, &operand);
    if (operand.is_vector)
        glintL_error(L, "%s: one number or symbol expected, got a vector", path);
    return operand.at[0];
}

int glintL_read_position(lua_State *L, int index, const char *path, glintL_term out[3])
{
    glintL_operand operand;
    glintL_read_operand(L, index, path, &operand);
    if (operand.is_vector) {
        memcpy(out, operand.at, sizeof operand.at);
        return index + 1;
    }
    if (lua_isnoneornil(L, index + 1))
        glintL_error(L, "%s: expected a vector, or x, y and z, got one number", path);
    for (int i = 0; i < 3; i++)
        out[i] = glintL_read_term(L, index + i, path);
    return index + 3;
}

// ---- To Lua ----

static void push_symbol(lua_State *L, glintL_term term, uint32_t choice)
{
    luaL_checkstack(L, 3, "symbol");
    if (!term.is_symbol) {
        lua_pushnumber(L, term.number);
        return;
    }
    symbol *made = lua_newuserdatauv(L, sizeof *made, 0);
    *made = (symbol) { glintL_current_trace(L)->serial, term.value, choice };
    luaL_setmetatable(L, GLINTL_SYMBOL);
}

void glintL_push_term(lua_State *L, glintL_term term) { push_symbol(L, term, 0); }

void glintL_push_choice(lua_State *L, glintL_term term)
{
    glintL_trace *trace = glintL_current_trace(L);
    if (!term.is_symbol || trace->choices.count == GLINTL_CHOICES_MAX) {
        glintL_push_term(L, term);
        return;
    }
    const uint32_t number = trace->choices.count++;
    if (!trace->before || trace->before->used[number / 64] >> number % 64 & 1) {
        push_symbol(L, term, number + 1);
        return;
    }
    luaL_where(L, 1);
    if (!trace->before->place[0])
        snprintf(trace->before->place, sizeof trace->before->place, "%s", lua_tostring(L, -1));
    lua_pop(L, 1);
    lua_pushboolean(L, false);
}

void glintL_push_operand(lua_State *L, const glintL_operand *operand)
{
    if (operand->is_vector)
        glintL_push_triple(L, operand->at);
    else
        glintL_push_term(L, operand->at[0]);
}

// ---- Textures ----

// Adds a lookup to a builder; numbers give numbers.
static glint_status apply_builder(glint_builder *builder, const glint_texture *texture, const glintL_term in[4],
                          glintL_term out[4], glint_error *error)
{
    glint_value values[4], color[4];
    glint_status status = GLINT_OK;
    for (int i = 0; i < 4 && !status; i++) {
        values[i] = in[i].value;
        if (!in[i].is_symbol)
            status = glint_builder_number(builder, in[i].number, &values[i], error);
    }
    if (!status)
        status = glint_builder_texel_by_axis(builder, texture, values[0], values[1], values + 2, color, error);
    for (int i = 0; i < 4 && !status; i++) {
        out[i] = (glintL_term) { .value = color[i] };
        out[i].is_symbol = !glint_builder_is_number(builder, color[i], &out[i].number);
    }
    return status;
}

// Looks up a texel. With only plain numbers there may be no builder; then the call makes one.
void glintL_apply_texture(lua_State *L, const glint_texture *texture, const glintL_term in[4], glintL_term out[4])
{
    const glintL_trace *trace = glintL_current_trace(L);
    glint_builder *builder = trace ? trace->builder : NULL;
    glint_error error;
    if (builder) {
        glintL_check_status(L, "texture", &error, apply_builder(builder, texture, in, out, &error));
        return;
    }
    glint_status status = glint_builder_create(GLINT_PROGRAM_PATTERN, &builder, &error);
    if (!status)
        status = apply_builder(builder, texture, in, out, &error);
    glint_builder_destroy(builder);
    glintL_check_status(L, "texture", &error, status);
}
