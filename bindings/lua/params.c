// glint.params: numbers, switches, words and points of a script that the command line can set.
//
//     local P = glint.params { radius = { 15, min = 1, max = 40, doc = "orbit radius" }, shiny = true, lamp = { { 3, 5, 2 }, drag = true } }
//
// The default determines the type. The text of --set is read as a literal of that type and never evaluated.
#include <stdlib.h>
#include <string.h>

#include "bindings/lua/lua.h"

static const char LIST; // address used as the registry key for the list of all parameters

typedef struct params_box {
    void *self; // see glintL_job
} params_box;

// ---- The list of all parameters, and their entries in a picture's file ----

void glintL_push_params(lua_State *L)
{
    luaL_checkstack(L, 4, "params");
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &LIST) == LUA_TTABLE)
        return;
    lua_pop(L, 1);
    lua_newtable(L);
    lua_pushvalue(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &LIST);
}

// Pushes the value of the spec at `spec` as written in a picture's text: one line without line breaks.
static void push_value_text(lua_State *L, int spec)
{
    char number[32];
    if (lua_getfield(L, spec, "value") == LUA_TNUMBER && !lua_isinteger(L, -1)) {
        glintL_format_number(number, lua_tonumber(L, -1));
        lua_pushstring(L, number);
    } else {
        luaL_gsub(L, luaL_tolstring(L, -1, NULL), "\n", "\\n");
        lua_remove(L, -2);
    }
    lua_remove(L, -2);
}

// Writes every parameter as "name=value", one per line, into the run.
static void write_text(lua_State *L, glintL_run *run)
{
    glintL_push_params(L);
    int list = lua_gettop(L);
    lua_Integer count = luaL_len(L, list);
    lua_pushliteral(L, "");
    for (lua_Integer i = 1; i <= count; i++) {
        lua_rawgeti(L, list, i);
        int spec = lua_gettop(L);
        lua_pushstring(L, i > 1 ? "\n" : "");
        lua_getfield(L, spec, "name");
        lua_pushliteral(L, "=");
        push_value_text(L, spec);
        lua_remove(L, spec);
        lua_concat(L, 5);
    }
    free(run->params_text);
    run->params_text = strdup(lua_tostring(L, -1));
    if (!run->params_text)
        luaL_error(L, "out of memory");
    lua_settop(L, list - 1);
}

// Adds the line "name=text" or "name:choice=text" to the text on top. spec: absolute; choice: 0 for the label.
static void add_name(lua_State *L, int spec, lua_Integer choice)
{
    lua_getfield(L, spec, "name");
    if (choice > 0) {
        lua_pushliteral(L, ":");
        lua_getfield(L, spec, "choices");
        lua_rawgeti(L, -1, choice);
        luaL_tolstring(L, -1, NULL);
        lua_replace(L, -3);
        lua_pop(L, 1);
        lua_concat(L, 3);
    }
    lua_pushliteral(L, "=");
    if (choice > 0) {
        lua_getfield(L, spec, "names");
        lua_rawgeti(L, -1, choice);
        lua_remove(L, -2);
    } else {
        lua_getfield(L, spec, "label");
    }
    luaL_gsub(L, lua_tostring(L, -1), "\n", " ");
    lua_remove(L, -2);
    lua_pushliteral(L, "\n");
    lua_concat(L, 5);
}

// Writes the labels of parameters and the names of their choices into the run.
static void write_names(lua_State *L, glintL_run *run)
{
    glintL_push_params(L);
    const int list = lua_gettop(L), spec = list + 2;
    const lua_Integer count = luaL_len(L, list);
    luaL_checkstack(L, 12, "params");
    lua_pushliteral(L, "");
    for (lua_Integer i = 1; i <= count; i++) {
        lua_rawgeti(L, list, i);
        lua_insert(L, list + 1); // below the text
        const int at = list + 1;
        lua_Integer choices = lua_getfield(L, at, "names") == LUA_TTABLE ? luaL_len(L, -1) : 0;
        const bool has_label = lua_getfield(L, at, "label") == LUA_TSTRING;
        lua_settop(L, spec);
        if (has_label)
            add_name(L, at, 0);
        for (lua_Integer c = 1; c <= choices; c++)
            add_name(L, at, c);
        lua_remove(L, at);
    }
    free(run->names_text);
    run->names_text = strdup(lua_tostring(L, -1));
    if (!run->names_text)
        luaL_error(L, "out of memory");
    lua_settop(L, list - 1);
}

bool glintL_push_unknown_set(lua_State *L)
{
    const glintL_run *run = glintL_get_run(L);
    for (size_t i = 0; i < run->request.set_count; i++) {
        const glintL_set *set = &run->request.sets[i];
        const char *near = NULL;
        if (set->is_known)
            continue;
        glintL_push_params(L);
        lua_Integer count = luaL_len(L, -1);
        for (lua_Integer p = 1; p <= count; p++) {
            lua_rawgeti(L, -1, p);
            lua_getfield(L, -1, "name");
            near = glintL_nearer(set->name, near, lua_tostring(L, -1)); // the list retains the string
            lua_pop(L, 2);
        }
        const char *option = set->values ? "sweep" : "set";
        if (near)
            lua_pushfstring(L, "--%s %s: no such parameter; did you mean '%s'?", option, set->name, near);
        else
            lua_pushfstring(L, "--%s %s: no such parameter%s", option, set->name,
                            count ? "; --help lists them" : ": the script has none");
        return true;
    }
    return false;
}

// ---- The object ----

// Pushes the names of the table at 1, sorted, because tables have no order.
static lua_Integer push_names(lua_State *L)
{
    lua_Integer count = 0;
    lua_newtable(L);
    int names = lua_gettop(L);
    lua_pushnil(L);
    while (lua_next(L, 1)) {
        lua_pop(L, 1);
        size_t length;
        if (lua_type(L, -1) != LUA_TSTRING)
            glintL_bad_key(L, "params", -1);
        const char *name = lua_tolstring(L, -1, &length);
        if (length == 0 || length > GLINT_NAME_SIZE || strcspn(name, "=\n") != length)
            glintL_refuse(L, -1, "params", "name of 1 to 64 bytes without '='");
        lua_Integer at = ++count;
        for (; at > 1; at--) {
            lua_rawgeti(L, names, at - 1);
            if (strcmp(lua_tostring(L, -1), name) < 0) {
                lua_pop(L, 1);
                break;
            }
            lua_rawseti(L, names, at);
        }
        lua_pushvalue(L, -1);
        lua_rawseti(L, names, at);
    }
    return count;
}

// Adds the spec on top to the list, replacing one with the same name; pops it.
static void list_spec(lua_State *L, const char *name, int list)
{
    lua_Integer count = luaL_len(L, list), at = 1;
    for (; at <= count; at++) {
        lua_rawgeti(L, list, at);
        lua_getfield(L, -1, "name");
        bool same = strcmp(lua_tostring(L, -1), name) == 0;
        lua_pop(L, 2);
        if (same)
            break;
    }
    lua_rawseti(L, list, at);
}

static int new_params(lua_State *L)
{
    glintL_run *run = glintL_get_run(L);
    if (!lua_istable(L, 1))
        glintL_refuse(L, 1, "params", "table");
    lua_settop(L, 1);
    luaL_checkstack(L, 12, "params");
    params_box *box = lua_newuserdatauv(L, sizeof *box, 2); // 2: with the values, and the specs
    box->self = box;
    luaL_setmetatable(L, GLINTL_PARAMS);
    lua_newtable(L);
    lua_setiuservalue(L, 2, 2);
    lua_newtable(L); // 3: name -> value
    glintL_push_params(L); // 4
    lua_Integer count = push_names(L); // 5
    for (lua_Integer i = 1; i <= count; i++) {
        lua_rawgeti(L, 5, i);
        const char *name = lua_tostring(L, 6);
        lua_getfield(L, 1, name); // 7
        glintL_push_param_spec(L, run, name, 7);
        glintL_push_param_value(L, lua_gettop(L));
        lua_setfield(L, 3, name);
        lua_getiuservalue(L, 2, 2);
        lua_pushvalue(L, -2);
        lua_setfield(L, -2, name);
        lua_pop(L, 1);
        list_spec(L, name, 4);
        lua_settop(L, 5);
    }
    lua_settop(L, 4);
    lua_pushvalue(L, 3);
    lua_setiuservalue(L, 2, 1);
    write_text(L, run);
    write_names(L, run);
    lua_settop(L, 2);
    return 1;
}

// Marks the parameter whose name is at `name` as read.
static void mark_read(lua_State *L, int params, int name)
{
    lua_getiuservalue(L, params, 2);
    lua_pushvalue(L, name);
    if (lua_rawget(L, -2) == LUA_TTABLE) {
        glintL_set_flag(L, "is_read", true);
    }
    lua_pop(L, 2);
}

// Turns the parameter on top into a variable if the command line requests a derivative by it.
static void vary(lua_State *L, const char *name)
{
    if (!glintL_wants_variable(glintL_get_run(L), name))
        return;
    if (lua_type(L, -1) != LUA_TNUMBER)
        glintL_error(L, "passes: d:%s: the parameter is a %s; only number parameters have derivatives", name, lua_isuserdata(L, -1) ? "point" : luaL_typename(L, -1));
    if (strlen(name) >= GLINT_DERIVATIVE_NAME_SIZE)
        glintL_error(L, "passes: d:%s: expected a name of at most %d bytes", name, GLINT_DERIVATIVE_NAME_SIZE - 1);
    glintL_make_variable(L, name, lua_tonumber(L, -1));
}

static int read_param(lua_State *L)
{
    const char *near = NULL;
    luaL_checkudata(L, 1, GLINTL_PARAMS);
    if (lua_type(L, 2) != LUA_TSTRING)
        glintL_bad_key(L, "params", 2);
    lua_settop(L, 2);
    lua_getiuservalue(L, 1, 1);
    lua_pushvalue(L, 2);
    if (lua_rawget(L, 3) != LUA_TNIL) {
        mark_read(L, 1, 2);
        vary(L, lua_tostring(L, 2));
        return 1;
    }
    lua_pushnil(L);
    lua_replace(L, 4);
    while (lua_next(L, 3)) {
        near = glintL_nearer(lua_tostring(L, 2), near, lua_tostring(L, -2));
        lua_pop(L, 1);
    }
    return glintL_no_such_field(L, "params", lua_tostring(L, 2), near);
}

static int write_param(lua_State *L)
{
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "?";
    return glintL_error(L, "params.%s: a parameter is read-only; set it with --set %s=...", name, name);
}

static int next_param(lua_State *L)
{
    lua_settop(L, 2);
    if (lua_next(L, 1))
        return 2;
    lua_pushnil(L);
    return 1;
}

static int pairs_of_params(lua_State *L)
{
    luaL_checkudata(L, 1, GLINTL_PARAMS);
    lua_pushcfunction(L, next_param);
    lua_newtable(L); // a copy, so that the script cannot change the values
    lua_getiuservalue(L, 1, 1);
    lua_pushnil(L);
    while (lua_next(L, -2)) {
        mark_read(L, 1, lua_gettop(L) - 1);
        vary(L, lua_tostring(L, -2));
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, -5);
    }
    lua_pop(L, 1);
    lua_pushnil(L);
    return 3;
}

void glintL_open_params(lua_State *L)
{
    static const luaL_Reg meta[] = {
        { "__index", read_param },
        { "__newindex", write_param },
        { "__pairs", pairs_of_params },
        { NULL, NULL },
    };
    glintL_new_type(L, GLINTL_PARAMS, meta);
    glintL_set_function(L, "params", new_params);
}
