// glint.pattern and glint.shader: turn a function of a script into a program.
#include "bindings/pattern/pattern.h"

#include <stdlib.h>
#include <string.h>

glintL_pattern *glintL_to_pattern(lua_State *L, int index)
{
    static const char *const types[] = { GLINTL_PATTERN, GLINTL_SHADER, GLINTL_TEXTURE };
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (luaL_testudata(L, index, types[i]))
            return lua_touserdata(L, index);
    return NULL;
}

bool glintL_is_source(lua_State *L, int index, bool is_shader)
{
    const glintL_pattern *pattern = glintL_to_pattern(L, index);
    return pattern && (pattern->kind == GLINT_PROGRAM_SHADER) == is_shader;
}

static const char *name_of(const glintL_pattern *pattern)
{
    if (pattern->texture)
        return "texture";
    return pattern->kind == GLINT_PROGRAM_SHADER ? "shader" : "pattern";
}

static glintL_pattern *check_self(lua_State *L)
{
    glintL_pattern *pattern = glintL_to_pattern(L, 1);
    if (!pattern)
        glintL_refuse(L, 1, "", "pattern or shader");
    return pattern;
}

glintL_pattern *glintL_push_pattern(lua_State *L, glint_program_kind kind, const char *type)
{
    luaL_checkstack(L, 4, "pattern");
    glintL_pattern *pattern = lua_newuserdatauv(L, sizeof *pattern, 2);
    *pattern = (glintL_pattern) { .kind = kind };
    luaL_setmetatable(L, type);
    lua_newtable(L);
    lua_setiuservalue(L, -2, 2);
    return pattern;
}

static int make(lua_State *L, glint_program_kind kind, const char *type)
{
    const char *name = type + sizeof "glint." - 1;
    if (lua_gettop(L) != 1 || !lua_isfunction(L, 1)) {
        if (lua_gettop(L) > 1 && !glintL_is_module(L, 1))
            return glintL_error(L, "%s: one function expected, got %d values", name, lua_gettop(L));
        return glintL_refuse(L, 1, name, "function");
    }
    if (lua_iscfunction(L, 1))
        return glintL_error(L, "%s: a function written in Lua expected, got one of C", name);
    glintL_push_pattern(L, kind, type);
    lua_pushvalue(L, 1);
    lua_setiuservalue(L, -2, 1);
    return 1;
}

static int new_pattern(lua_State *L) { return make(L, GLINT_PROGRAM_PATTERN, GLINTL_PATTERN); }

static int new_shader(lua_State *L) { return make(L, GLINT_PROGRAM_SHADER, GLINTL_SHADER); }

// ---- Methods ----

int glintL_pattern_evaluate(lua_State *L)
{
    const glintL_pattern *pattern = check_self(L);
    const bool is_shader = pattern->kind == GLINT_PROGRAM_SHADER;
    double inputs[GLINT_INPUT_COUNT] = { 0 }, out[GLINT_PROGRAM_OUTPUTS_MAX] = { 0 };
    glint_error error;
    lua_settop(L, 2);
    glintL_read_inputs(L, 2, is_shader, inputs);
    const glintL_traced *traced = glintL_make_program(L, 1, false);
    glintL_check_status(L, "evaluate", &error, glint_program_evaluate(traced->program, inputs, out, &error));
    if (glint_program_output_count(traced->program) == 1)
        out[1] = out[2] = out[0];
    if (!is_shader) {
        glintL_push_vector(L, out);
        return 1;
    }
    lua_createtable(L, 0, 2);
    glintL_push_vector(L, out);
    lua_setfield(L, -2, "diffuse");
    glintL_push_vector(L, out + 3);
    lua_setfield(L, -2, "specular");
    return 1;
}

// array:map(f): the results of a pattern, or of a function that could be one, for all rows. The function has the row; of
// an array with one column, the number.
int glintL_map_array(lua_State *L)
{
    double inputs[GLINT_INPUT_COUNT] = { 0 };
    glint_error error;
    lua_settop(L, 2);
    const glintL_array *a = glintL_to_array(L, 1);
    if (!a || a->width > 3)
        return glintL_refuse(L, 1, "array.map", "array of 1 to 3 columns");
    if (lua_isfunction(L, 2)) {
        if (a->width == 1) {
            if (luaL_loadstring(L, "local f = ... return function(p) return f(p.x) end"))
                return lua_error(L);
            lua_pushvalue(L, 2);
            lua_call(L, 1, 1);
            lua_replace(L, 2);
        }
        glintL_push_pattern(L, GLINT_PROGRAM_PATTERN, GLINTL_PATTERN);
        lua_pushvalue(L, 2);
        lua_setiuservalue(L, -2, 1);
        lua_replace(L, 2);
    } else if (!glintL_is_source(L, 2, false))
        return glintL_refuse(L, 2, "array.map", "function or pattern");
    const glint_program *program = glintL_make_program(L, 2, false)->program;
    glintL_array *out = glintL_push_array(L, a->count, glint_program_output_count(program), false);
    for (size_t i = 0; i < a->count; i++) {
        for (size_t c = 0; c < a->width; c++) {
            const size_t at = i * a->width + c;
            inputs[GLINT_INPUT_P_X + c] = a->is_whole ? (double)a->wholes[at] : a->numbers[at];
        }
        glintL_check_status(L, "array.map", &error, glint_program_evaluate(program, inputs, out->numbers + i * out->width, &error));
    }
    return 1;
}

static int count_instructions(lua_State *L)
{
    check_self(L);
    lua_settop(L, 1);
    lua_pushinteger(L, (lua_Integer)glint_program_length(glintL_make_program(L, 1, false)->program));
    return 1;
}

// Pushes the listing, a block of C's, in protected mode, so that an error still frees it.
static int push_text(lua_State *L)
{
    lua_pushstring(L, lua_touserdata(L, 1));
    return 1;
}

static int to_string(lua_State *L)
{
    const glintL_pattern *pattern = check_self(L);
    lua_settop(L, 1);
    const glintL_traced *traced = glintL_make_program(L, 1, false);
    const int length = (int)glint_program_length(traced->program);
    lua_pushfstring(L, "%s of %d instruction%s\n", name_of(pattern), length, length == 1 ? "" : "s");
    lua_pushcfunction(L, push_text);
    char *listing = glint_program_listing(traced->program);
    if (!listing)
        return glintL_error(L, "out of memory");
    lua_pushlightuserdata(L, listing);
    const int status = lua_pcall(L, 1, 1, 0);
    free(listing);
    if (status)
        return lua_error(L);
    lua_concat(L, 2);
    return 1;
}

// Calls the function, inside another pattern's function or with plain numbers.
static int call(lua_State *L)
{
    check_self(L);
    lua_getiuservalue(L, 1, 1);
    lua_replace(L, 1);
    lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
    return lua_gettop(L);
}

static const luaL_Reg METHODS[] = { { "evaluate", glintL_pattern_evaluate }, { NULL, NULL } };

static int read_member(lua_State *L)
{
    const glintL_pattern *pattern = check_self(L);
    if (lua_type(L, 2) != LUA_TSTRING)
        return glintL_bad_key(L, name_of(pattern), 2);
    const char *name = lua_tostring(L, 2);
    if (strcmp(name, "evaluate") == 0) {
        lua_pushcfunction(L, glintL_pattern_evaluate);
        return 1;
    }
    return glintL_no_such_field(L, name_of(pattern), name, glintL_nearer(name, NULL, "evaluate"));
}

static int write_member(lua_State *L)
{
    const glintL_pattern *pattern = check_self(L);
    return glintL_error(L, "%s.%s: a %s cannot be changed; change the variables that its function reads", name_of(pattern),
                        luaL_tolstring(L, 2, NULL), name_of(pattern));
}

static void open_type(lua_State *L, const char *type)
{
    static const luaL_Reg meta[] = {
        { "__index", read_member }, { "__newindex", write_member }, { "__len", count_instructions },
        { "__call", call },         { "__tostring", to_string },    { NULL, NULL },
    };
    const glintL_variant variant = { .name = type + sizeof "glint." - 1 };
    glintL_new_type(L, type, meta);
    glintL_list_variant(L, &variant, METHODS);
}

void glintL_open_functions(lua_State *L)
{
    static const luaL_Reg constructors[] = {
        { "pattern", new_pattern },
        { "shader", new_shader },
        { NULL, NULL },
    };
    open_type(L, GLINTL_PATTERN);
    open_type(L, GLINTL_SHADER);
    luaL_setfuncs(L, constructors, 0);
}
