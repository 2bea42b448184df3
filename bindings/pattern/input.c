// The inputs of a function at a point: p, and the fields of s.
#include "bindings/pattern/pattern.h"

#include <string.h>

typedef struct field {
    const char *name, *long_name; // long_name: the name in material:evaluate; NULL: none
    glint_input first; // the first of `count` consecutive inputs
    int count;
    bool is_of_shaders;
    double initial[3]; // default in evaluate{}
} field;

static const field FIELDS[] = {
    { "p", NULL, GLINT_INPUT_P_X, 3, false, { 0, 0, 0 } },
    { "world", NULL, GLINT_INPUT_WORLD_X, 3, false, { 0, 0, 0 } },
    { "n", "normal", GLINT_INPUT_N_X, 3, false, { 0, 0, 1 } },
    { "v", "to_eye", GLINT_INPUT_V_X, 3, false, { 0, 0, 1 } },
    { "uv", NULL, GLINT_INPUT_UV_U, 2, false, { 0, 0, 0 } },
    { "footprint", NULL, GLINT_INPUT_FOOTPRINT, 1, false, { 0 } },
    { "uv_footprint", NULL, GLINT_INPUT_UV_FOOTPRINT, 1, false, { 0 } },
    { "l", "to_light", GLINT_INPUT_L_X, 3, true, { 0, 0, 1 } },
    { "light", NULL, GLINT_INPUT_LIGHT_R, 3, true, { 1, 1, 1 } },
    { "distance", NULL, GLINT_INPUT_DISTANCE, 1, true, { 1 } },
    { "kd", NULL, GLINT_INPUT_KD_R, 3, true, { 0.8, 0.8, 0.8 } },
    { "ks", NULL, GLINT_INPUT_KS_R, 3, true, { 0, 0, 0 } },
    { "shininess", NULL, GLINT_INPUT_SHININESS, 1, true, { 32 } },
};

#define FIELD_COUNT (sizeof FIELDS / sizeof *FIELDS)

static const field *find_field(const char *name)
{
    for (size_t i = 0; i < FIELD_COUNT; i++)
        if (strcmp(FIELDS[i].name, name) == 0 || (FIELDS[i].long_name && strcmp(FIELDS[i].long_name, name) == 0))
            return &FIELDS[i];
    return NULL;
}

static glintL_term input_term(lua_State *L, const glintL_trace *trace, glint_input input)
{
    glintL_term term = { .is_symbol = !trace->point };
    glint_error error;
    if (trace->point)
        term.number = trace->point[input];
    else
        glintL_check_status(L, "", &error, glint_builder_input(trace->builder, input, &term.value, &error));
    return term;
}

static void push_field(lua_State *L, const glintL_trace *trace, const field *f)
{
    glintL_term terms[3] = { glintL_number_term(0), glintL_number_term(0), glintL_number_term(0) };
    for (int i = 0; i < f->count; i++)
        terms[i] = input_term(L, trace, f->first + (glint_input)i);
    if (f->count == 1)
        glintL_push_term(L, terms[0]);
    else
        glintL_push_triple(L, terms);
}

void glintL_push_point(lua_State *L) { push_field(L, glintL_current_trace(L), &FIELDS[0]); }

// Reads a field of s. 1: s, 2: the field's name. Stores the field in s.
static int read_surroundings(lua_State *L)
{
    const glintL_trace *trace = glintL_current_trace(L);
    if (lua_type(L, 2) != LUA_TSTRING)
        return glintL_bad_key(L, "s", 2);
    const char *name = lua_tostring(L, 2), *near = NULL;
    const field *f = find_field(name);
    if (!trace)
        return glintL_error(L, "s.%s: s is valid only during one call of a pattern's function", name);
    if (f && (trace->is_shader || !f->is_of_shaders)) {
        push_field(L, trace, f);
        lua_pushvalue(L, 2);
        lua_pushvalue(L, -2);
        lua_rawset(L, 1);
        return 1;
    }
    if (f)
        return glintL_error(L, "s.%s: a pattern has no light; use glint.shader, which is evaluated for each light", name);
    for (size_t i = 0; i < FIELD_COUNT; i++)
        if (trace->is_shader || !FIELDS[i].is_of_shaders)
            near = glintL_nearer(name, near, FIELDS[i].name);
    return glintL_no_such_field(L, "s", name, near);
}

static int write_surroundings(lua_State *L)
{
    return glintL_error(L, "s.%s: the values of a point are read-only", luaL_tolstring(L, 2, NULL));
}

void glintL_push_surroundings(lua_State *L)
{
    lua_newtable(L);
    luaL_setmetatable(L, GLINTL_SURROUNDINGS);
}

void glintL_open_input(lua_State *L)
{
    static const luaL_Reg meta[] = {
        { "__index", read_surroundings },
        { "__newindex", write_surroundings },
        { NULL, NULL },
    };
    glintL_field fields[FIELD_COUNT + 1] = { { .name = NULL } };
    const glintL_variant variant = { .name = "surroundings", .fields = fields };
    for (size_t i = 0; i < FIELD_COUNT; i++)
        fields[i].name = FIELDS[i].name;
    glintL_new_type(L, GLINTL_SURROUNDINGS, meta);
    glintL_list_variant(L, &variant, NULL);
}

// ---- evaluate{} ----

static void read_value(lua_State *L, int index, const field *f, double out[3])
{
    glintL_operand operand;
    char path[32] = "evaluate.";
    strcat(path, f->name);
    if (f->count == 2 && lua_istable(L, index) && lua_rawlen(L, index) == 2) { // {u, v}
        for (int i = 0; i < 2; i++) {
            lua_rawgeti(L, index, i + 1);
            out[i] = glintL_read_number(L, -1, path);
            lua_pop(L, 1);
        }
        return;
    }
    glintL_read_operand(L, index, path, &operand);
    if (operand.is_vector != (f->count > 1) && f->first != GLINT_INPUT_KD_R && f->first != GLINT_INPUT_KS_R &&
        f->first != GLINT_INPUT_LIGHT_R)
        glintL_refuse(L, index, path, f->count > 1 ? "{x, y, z}" : "number");
    for (int i = 0; i < f->count; i++) {
        if (operand.at[i].is_symbol)
            glintL_refuse(L, index, path, "number");
        out[i] = operand.at[i].number;
    }
}

static void check_names(lua_State *L, int index, bool is_shader)
{
    lua_pushnil(L);
    while (lua_next(L, index)) {
        const char *near = NULL;
        lua_pop(L, 1);
        if (lua_type(L, -1) != LUA_TSTRING)
            glintL_bad_key(L, "evaluate", -1);
        const char *name = lua_tostring(L, -1);
        const field *f = find_field(name);
        if (f && (is_shader || !f->is_of_shaders))
            continue;
        for (size_t i = 0; i < FIELD_COUNT; i++)
            if (is_shader || !FIELDS[i].is_of_shaders)
                near = glintL_nearer(name, near, FIELDS[i].name);
        glintL_no_such_field(L, "evaluate", name, near);
    }
}

void glintL_read_inputs(lua_State *L, int index, bool is_shader, double inputs[GLINT_INPUT_COUNT])
{
    if (!lua_istable(L, index))
        glintL_refuse(L, index, "evaluate", "table {p = {x, y, z}}");
    check_names(L, index, is_shader);
    for (size_t i = 0; i < FIELD_COUNT; i++) {
        const field *f = &FIELDS[i];
        double value[3];
        memcpy(value, f->initial, sizeof value);
        lua_pushstring(L, f->name);
        if (lua_rawget(L, index) == LUA_TNIL && f->long_name) {
            lua_pushstring(L, f->long_name);
            lua_rawget(L, index);
            lua_replace(L, -2);
        }
        if (!lua_isnil(L, -1)) {
            read_value(L, lua_gettop(L), f, value);
        } else if (f->first == GLINT_INPUT_WORLD_X) {
            memcpy(value, &inputs[GLINT_INPUT_P_X], sizeof value);
        }
        lua_pop(L, 1);
        memcpy(&inputs[f->first], value, (size_t)f->count * sizeof *value);
    }
    inputs[GLINT_INPUT_UV_FOOTPRINT_U] = inputs[GLINT_INPUT_UV_FOOTPRINT_V] = inputs[GLINT_INPUT_UV_FOOTPRINT];
}
