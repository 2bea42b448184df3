// Calls a function of a script with symbols, and makes a program from its results.
#include "bindings/pattern/pattern.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TRACED "glint.traced"
#define SESSION "glint.session"

// A call, owned by Lua, so that an error also frees the builder.
typedef struct session {
    glintL_trace trace;
    size_t count; // number of results: 1 or 3 for a pattern, 3 or 6 for a shader
    glintL_term terms[6];
} session;

static void close_builder(session *s)
{
    glint_builder_destroy(s->trace.builder);
    s->trace.builder = NULL;
}

static int close_session(lua_State *L)
{
    close_builder(lua_touserdata(L, 1));
    return 0;
}

static glintL_traced *push_traced(lua_State *L)
{
    glintL_traced *traced = lua_newuserdatauv(L, sizeof *traced, 0);
    *traced = (glintL_traced) { NULL, false };
    luaL_setmetatable(L, TRACED);
    return traced;
}

static int close_traced(lua_State *L)
{
    glintL_traced *traced = lua_touserdata(L, 1);
    glint_program_release(traced->program);
    traced->program = NULL;
    return 0;
}

// ---- Messages ----

const char *glintL_traced_position(lua_State *L, lua_CFunction reached)
{
    const glintL_trace *trace = reached == glintL_call_function ? glintL_current_trace(L) : NULL;
    return trace ? trace->place : NULL;
}

// Returns whether a message begins with a position such as "file:12: ".
static bool has_position(const char *text)
{
    for (const char *colon = strchr(text, ':'); colon; colon = strchr(colon + 1, ':')) {
        const size_t digits = strspn(colon + 1, "0123456789");
        if (digits > 0 && colon[1 + digits] == ':')
            return true;
    }
    return false;
}

// Pushes the replacement for a Lua function that needs a number.
static const char *push_own_function(lua_State *L, const char *text)
{
    const char *name = glintL_push_name_after(L, text, "bad argument #1 to '");
    if (name && strcmp(name, "fmod") == 0)
        return lua_pushliteral(L, "a symbol has no value yet; write a % b");
    if (name && glintL_makes(L, name))
        return lua_pushfstring(L, "a symbol has no value yet; write glint.%s", name);
    return lua_pushliteral(L, "a symbol has no value yet; use glint's own function, such as glint.sin(x) for "
                              "math.sin(x)");
}

// Adds a hint to Lua's own messages about symbols.
static int explain(lua_State *L)
{
    const glintL_trace *trace = glintL_current_trace(L);
    const char *text = lua_tostring(L, 1), *cure = NULL;
    if (lua_type(L, 1) != LUA_TSTRING)
        return 1;
    luaL_checkstack(L, 8, "message");
    if (strstr(text, "'for' ") && strstr(text, "number"))
        cure = "a loop needs plain numbers as limits, not values that depend on the point";
    else if (strstr(text, "got " GLINTL_SYMBOL) || strstr(text, "got " GLINTL_TRIPLE))
        cure = push_own_function(L, text);
    else if (strstr(text, "stack overflow"))
        cure = "the functions call each other endlessly";
    else if (strstr(text, "a nil value (field '?')"))
        cure = "a table cannot be indexed by a value that depends on the point; use glint.select";
    else if (strstr(text, "values expected, numbers included"))
        cure = "is a loop endless? In Lua, a comparison of values that depend on the point is always true";
    if (!cure || !trace || strstr(text, cure)) { // an inner pattern has added it
        lua_settop(L, 1);
        return 1;
    }
    lua_pushfstring(L, "%s%s: %s", has_position(text) ? "" : trace->place, text, cure);
    return 1;
}

// ---- The call ----

static void refuse_result(lua_State *L, const glintL_trace *trace, int index)
{
    const char *hint = lua_isnoneornil(L, index) ? ": is a return missing, or a table indexed by a value of the point? use glint.select"
                                                 : "";
    const char *got = lua_istable(L, index) ? "a table that is not a vector" : glintL_push_spelling(L, index);
    lua_pushfstring(L, "%s%s: the function must return a number, a symbol or a vector of three, got %s%s",
                    trace->place, trace->is_shader ? "shader" : "pattern", got, hint);
    lua_error(L);
}

// Reads the function's results, from index 2 on.
static void read_results(lua_State *L, session *s)
{
    const int count = lua_gettop(L) - 1, most = s->trace.is_shader ? 2 : 1;
    if (count > most && !s->trace.is_shader) {
        lua_pushfstring(L, "%spattern: the function must return one value, got %d; a colour is glint.vector(r, g, b) or { r, g, b }",
                        s->trace.place, count);
        lua_error(L);
    }
    if (count > most) {
        lua_pushfstring(L, "%sshader: the function must return the diffuse part, or the diffuse and the specular "
                           "part, got %d values",
                        s->trace.place, count);
        lua_error(L);
    }
    s->count = 0;
    for (int i = 0; i < (count > 1 ? count : 1); i++) {
        glintL_operand operand;
        if (i > 0 && lua_isnil(L, i + 2))
            break;
        if (!glintL_to_operand(L, i + 2, true, &operand))
            refuse_result(L, &s->trace, i + 2);
        for (int c = 0; c < (operand.is_vector || s->trace.is_shader ? 3 : 1); c++)
            s->terms[s->count++] = operand.at[c];
    }
}

// Runs a function. 1: the session, 2: the function. The script's Lua code ends below this C function, for positions in
// messages.
int glintL_call_function(lua_State *L)
{
    session *s = lua_touserdata(L, 1);
    if (!s->trace.is_shader)
        glintL_push_point(L);
    glintL_push_surroundings(L);
    lua_call(L, lua_gettop(L) - 2, LUA_MULTRET);
    read_results(L, s);
    return 0;
}

// Stores the position of the function of the pattern at `index`; a texture has none.
static void set_position(lua_State *L, int index, glintL_trace *trace)
{
    lua_Debug info;
    if (lua_getiuservalue(L, index, 1) != LUA_TFUNCTION) {
        lua_pop(L, 1);
        return;
    }
    lua_getinfo(L, ">S", &info);
    snprintf(trace->place, sizeof trace->place, "%s:%d: ", info.short_src, info.linedefined);
}

static session *push_session(lua_State *L, int index)
{
    const glintL_pattern *pattern = lua_touserdata(L, index);
    session *s = lua_newuserdatauv(L, sizeof *s, 0);
    *s = (session) { .trace = { .is_shader = pattern->kind == GLINT_PROGRAM_SHADER } };
    luaL_setmetatable(L, SESSION);
    set_position(L, index, &s->trace);
    return s;
}

// ---- Endless loops ----

#define STEPS_MAX 200000000 // Lua instructions in one call: some seconds
#define STEPS_BETWEEN 1000000

static glintL_trace *outermost(lua_State *L)
{
    glintL_trace *trace = glintL_current_trace(L);
    while (trace && trace->outer)
        trace = trace->outer;
    return trace;
}

static void count_steps(lua_State *L, lua_Debug *where)
{
    glintL_trace *trace = outermost(L);
    if (!trace)
        return;
    if (trace->hook)
        trace->hook(L, where);
    trace->steps += STEPS_BETWEEN;
    if (trace->steps > STEPS_MAX)
        glintL_error(L, "%s: its function has not returned after %d million steps; is a loop endless?",
                     trace->is_shader ? "shader" : "pattern", STEPS_MAX / 1000000);
}

// Installs a hook. The previous hook is still called, unless it runs at every instruction: then it is an interrupt.
static void begin_steps(lua_State *L, glintL_trace *trace)
{
    const int count = lua_gethookcount(L);
    if (trace->outer || (lua_gethook(L) && count < 2))
        return;
    trace->hook = lua_gethook(L);
    trace->hook_mask = lua_gethookmask(L);
    trace->hook_count = count;
    lua_sethook(L, count_steps, LUA_MASKCOUNT, STEPS_BETWEEN);
}

static void end_steps(lua_State *L, const glintL_trace *trace)
{
    if (!trace->outer && lua_gethook(L) == count_steps) // unless an interrupt has set its own hook
        lua_sethook(L, trace->hook, trace->hook_mask, trace->hook_count);
}

// ---- Output of the function ----

static int print_nothing(lua_State *L)
{
    (void)L;
    return 0;
}

// Swaps the function on top with the global `print`.
static void swap_print(lua_State *L)
{
    luaL_checkstack(L, 4, "pattern");
    lua_rawgeti(L, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
    lua_pushliteral(L, "print");
    lua_rawget(L, -2);
    lua_insert(L, -3);
    lua_insert(L, -2);
    lua_pushliteral(L, "print");
    lua_insert(L, -2);
    lua_rawset(L, -3);
    lua_pop(L, 1);
}

// Calls the function of the pattern at `index`; the session is a userdata at `held`. Only the first call with symbols
// may print, not the calls at single points.
static void call(lua_State *L, int index, int held)
{
    session *s = lua_touserdata(L, held);
    const bool is_quiet = s->trace.point || s->trace.before;
    const int top = lua_gettop(L);
    luaL_checkstack(L, 12, "pattern");
    if (is_quiet) {
        lua_pushcfunction(L, print_nothing);
        swap_print(L);
    }
    lua_pushcfunction(L, explain);
    lua_pushcfunction(L, glintL_call_function);
    lua_pushvalue(L, held);
    lua_getiuservalue(L, index, 1);
    glintL_enter_trace(L, &s->trace);
    begin_steps(L, &s->trace);
    const int status = lua_pcall(L, 2, 0, top + 1 + is_quiet);
    end_steps(L, &s->trace);
    glintL_leave_trace(L, &s->trace);
    if (is_quiet) {
        lua_pushvalue(L, top + 1);
        swap_print(L);
        lua_pop(L, 1);
    }
    if (status)
        lua_error(L);
    lua_settop(L, top);
}

size_t glintL_run_on_numbers(lua_State *L, int index, const double inputs[GLINT_INPUT_COUNT], double *outputs)
{
    const int top = lua_gettop(L);
    session *s = push_session(L, index);
    s->trace.point = inputs;
    call(L, index, top + 1);
    for (size_t i = 0; i < s->count; i++)
        outputs[i] = s->terms[i].number;
    const size_t count = s->count;
    lua_settop(L, top);
    return count;
}

// ---- The program ----

static glint_status finish(session *s, glint_program **out, glint_error *error)
{
    glint_value values[6];
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < s->count && !status; i++) {
        values[i] = s->terms[i].value;
        if (!s->terms[i].is_symbol)
            status = glint_builder_number(s->trace.builder, s->terms[i].number, &values[i], error);
    }
    return status ? status : glint_builder_finish(s->trace.builder, values, s->count, out, error);
}

// Makes the program of a texture used directly, at s.uv.
static glint_status finish_picture(glint_builder *builder, const glint_texture *texture, glint_program **out,
                                   glint_error *error)
{
    static const glint_input inputs[] = { GLINT_INPUT_UV_U, GLINT_INPUT_UV_V, GLINT_INPUT_UV_FOOTPRINT };
    glint_value in[3], color[4];
    glint_status status = GLINT_OK;
    for (int i = 0; i < 3 && !status; i++)
        status = glint_builder_input(builder, inputs[i], &in[i], error);
    if (!status)
        status = glint_builder_texel(builder, texture, in[0], in[1], in[2], color, error);
    return status ? status : glint_builder_finish(builder, color, 3, out, error);
}

static glint_status finish_texture(glint_builder *builder, const glint_texture *texture, bool is_background,
                                   glint_program **out, glint_error *error)
{
    glint_texture *around;
    if (!is_background)
        return finish_picture(builder, texture, out, error);
    glint_status status = glint_texture_rewrap(texture, GLINT_WRAP_AROUND, &around, error);
    if (status)
        return status;
    status = finish_picture(builder, around, out, error);
    glint_texture_release(around);
    return status;
}

// ---- Branches ----

static bool has_unused(const glintL_choices *choices)
{
    for (uint32_t i = 0; i < choices->count; i++)
        if (!(choices->used[i / 64] >> i % 64 & 1))
            return true;
    return false;
}

static void push_listing(lua_State *L, const glint_program *program)
{
    char *text = glint_program_listing(program);
    lua_pushstring(L, text);
    free(text);
}

// Calls the function again with its unused choices as false, and pushes the program as text. 1: the pattern, 2: the
// session of its call.
static int list_again(lua_State *L)
{
    const glintL_pattern *pattern = lua_touserdata(L, 1);
    session *first = lua_touserdata(L, 2);
    glint_error error;
    glintL_traced *traced = push_traced(L);
    session *s = push_session(L, 1);
    s->trace.before = &first->trace.choices;
    glintL_check_status(L, "", &error, glint_builder_create(pattern->kind, &s->trace.builder, &error));
    call(L, 1, 4);
    glintL_check_status(L, "", &error, finish(s, &traced->program, &error));
    push_listing(L, traced->program);
    return 1;
}

// Raises for an `if` on a choice. In Lua a choice is true even when it is 0, so the `if` always takes the same branch,
// which neither plain Lua nor the program reveals. So an unused choice must be replaceable by false without any effect.
static void refuse_branches(lua_State *L, int index, int held, const glintL_traced *traced)
{
    const session *s = lua_touserdata(L, held);
    const int top = lua_gettop(L);
    if (!has_unused(&s->trace.choices))
        return;
    push_listing(L, traced->program);
    lua_pushcfunction(L, list_again);
    lua_pushvalue(L, index);
    lua_pushvalue(L, held);
    const int status = lua_pcall(L, 2, 1, 0);
    if (status == LUA_ERRMEM)
        lua_error(L);
    if (status || !lua_rawequal(L, -1, -2)) {
        lua_pushfstring(L,
                        "%san `if`, `and` or `or` on this value: a symbol is always true, even where its value is 0; "
                        "use glint.select",
                        s->trace.choices.place);
        lua_error(L);
    }
    lua_settop(L, top);
}

// Compares a new structure with plain Lua once; user value 2 of the pattern lists the structures compared. The session
// of the call is a userdata at `held`.
static void compare_once(lua_State *L, int index, int held, const glintL_traced *traced)
{
    uint64_t key[2];
    glint_program_structure(traced->program, key);
    lua_getiuservalue(L, index, 2);
    lua_pushlstring(L, (const char *)key, sizeof key);
    lua_pushvalue(L, -1);
    if (lua_rawget(L, -3) == LUA_TNIL) {
        glintL_compare_points(L, index, traced);
        refuse_branches(L, index, held, traced);
        lua_pushvalue(L, -2);
        lua_pushboolean(L, true);
        lua_rawset(L, -5);
    }
    lua_pop(L, 3);
}

glintL_traced *glintL_make_program(lua_State *L, int index, bool is_background)
{
    const glintL_pattern *pattern = lua_touserdata(L, index);
    glint_status status;
    glint_error error;
    index = lua_absindex(L, index);
    luaL_checkstack(L, 12, "pattern");
    glintL_traced *traced = push_traced(L);
    const int top = lua_gettop(L);
    session *s = push_session(L, index);
    status = glint_builder_create(pattern->kind, &s->trace.builder, &error);
    if (!status && pattern->texture) {
        status = finish_texture(s->trace.builder, pattern->texture, is_background, &traced->program, &error);
    } else if (!status) {
        call(L, index, top + 1);
        status = finish(s, &traced->program, &error);
    }
    if (status) {
        const char *what = pattern->texture ? "texture" : s->trace.is_shader ? "shader" : "pattern";
        lua_pushfstring(L, "%s%s: %s", s->trace.place, what, error.message);
        lua_error(L);
    }
    traced->has_power = s->trace.has_power;
    close_builder(s);
    if (!pattern->texture)
        compare_once(L, index, top + 1, traced);
    lua_settop(L, top);
    return traced;
}

const char *glintL_push_pattern_position(lua_State *L, int index)
{
    glintL_trace trace = { .is_shader = false };
    if (glintL_to_pattern(L, index))
        set_position(L, lua_absindex(L, index), &trace);
    return lua_pushstring(L, trace.place);
}

void glintL_open_trace(lua_State *L)
{
    luaL_newmetatable(L, TRACED);
    glintL_set_function(L, "__gc", close_traced);
    luaL_newmetatable(L, SESSION);
    glintL_set_function(L, "__gc", close_session);
    lua_pop(L, 2);
}
