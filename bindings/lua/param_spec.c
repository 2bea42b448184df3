// One parameter of glint.params: its default and limits, and its value from --set.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bindings/run/run.h"

const char *glintL_push_allowed(lua_State *L, int spec)
{
    luaL_Buffer out;
    luaL_checkstack(L, 12, "params");
    if (lua_getfield(L, spec, "choices") == LUA_TTABLE) {
        int choices = lua_gettop(L);
        luaL_buffinit(L, &out);
        lua_Integer count = luaL_len(L, choices);
        for (lua_Integer i = 1; i <= count; i++) {
            luaL_addstring(&out, i == 1 ? "" : i < count ? ", " : " or ");
            lua_rawgeti(L, choices, i);
            luaL_tolstring(L, -1, NULL);
            lua_remove(L, -2);
            luaL_addvalue(&out);
        }
        luaL_pushresult(&out);
    } else {
        const bool whole = lua_getfield(L, spec, "whole") == LUA_TBOOLEAN && lua_toboolean(L, -1);
        lua_getfield(L, spec, "type");
        const char *type = whole ? "whole number" : lua_tostring(L, -1);
        bool min = lua_getfield(L, spec, "min") != LUA_TNIL, max = lua_getfield(L, spec, "max") != LUA_TNIL;
        const char *low = luaL_tolstring(L, -2, NULL), *high = luaL_tolstring(L, -2, NULL);
        if (min && max)
            lua_pushfstring(L, "%s %s .. %s", type, low, high);
        else if (min || max)
            lua_pushfstring(L, "%s %s %s", type, min ? ">=" : "<=", min ? low : high);
        else if (strcmp(type, "boolean") == 0)
            lua_pushliteral(L, "true or false");
        else
            lua_pushstring(L, type);
    }
    return lua_tostring(L, -1);
}

static bool is_choice(lua_State *L, int choices, int value)
{
    lua_Integer count = luaL_len(L, choices);
    bool found = false;
    for (lua_Integer i = 1; i <= count && !found; i++) {
        lua_rawgeti(L, choices, i);
        found = lua_rawequal(L, -1, value);
        lua_pop(L, 1);
    }
    return found;
}

// Returns whether the value at `value`, which has the right type, is within the limits of the spec at `spec`. Both are
// absolute.
static bool is_allowed(lua_State *L, int spec, int value)
{
    luaL_checkstack(L, 6, "params");
    lua_getfield(L, spec, "whole");
    bool good = !lua_toboolean(L, -1) || lua_isinteger(L, value);
    lua_pop(L, 1);
    if (lua_getfield(L, spec, "choices") == LUA_TTABLE)
        good = good && is_choice(L, lua_gettop(L), value);
    if (lua_getfield(L, spec, "min") != LUA_TNIL)
        good = good && lua_compare(L, -1, value, LUA_OPLE);
    if (lua_getfield(L, spec, "max") != LUA_TNIL)
        good = good && lua_compare(L, value, -1, LUA_OPLE);
    lua_pop(L, 3);
    return good;
}

// Pushes the value that `text` spells for a parameter with the default at `index`. False: it is not a valid literal.
static bool push_literal(lua_State *L, const char *text, int index)
{
    lua_Integer whole;
    int is_whole;
    switch (lua_type(L, index)) {
    case LUA_TSTRING:
        lua_pushstring(L, text);
        return true;
    case LUA_TBOOLEAN:
        lua_pushboolean(L, strcmp(text, "true") == 0);
        return strcmp(text, "true") == 0 || strcmp(text, "false") == 0;
    default:
        if (lua_stringtonumber(L, text) == 0 || !isfinite(lua_tonumber(L, -1)))
            return false;
        // The user may write 20 or 20.0. The script gets the number type of the default, if the conversion is exact.
        whole = lua_tointegerx(L, -1, &is_whole);
        if (!lua_isinteger(L, index))
            lua_pushnumber(L, lua_tonumber(L, -1));
        else if (is_whole)
            lua_pushinteger(L, whole);
        return true;
    }
}

// ---- Reading one parameter ----

static glintL_set *find_set(glintL_run *run, const char *name)
{
    glintL_set *found = NULL;
    for (size_t i = 0; i < run->request.set_count; i++)
        if (strcmp(run->request.sets[i].name, name) == 0)
            (found = &run->request.sets[i])->is_known = true; // the last one wins
    return found;
}

static void check_type(lua_State *L, int index, const char *path)
{
    int type = lua_type(L, index);
    if (type != LUA_TSTRING && type != LUA_TBOOLEAN && type != LUA_TNUMBER)
        glintL_refuse(L, index, path, "number, boolean or string");
    if (type == LUA_TNUMBER && !isfinite(lua_tonumber(L, index)))
        glintL_refuse(L, index, path, "finite number");
}

// Copies min, max, doc, choices and whole from the table at `from` into the spec on top. The default is at spec.default.
static void read_limits(lua_State *L, int from, int spec, const char *path, const char *type)
{
    static const char *const names[] = { "min", "max", "doc", "choices", "whole" };
    char full[160];
    for (int i = 0; i < 5; i++) {
        snprintf(full, sizeof full, "%s.%s", path, names[i]);
        int found = lua_getfield(L, from, names[i]);
        if (found == LUA_TNIL) {
            lua_pop(L, 1);
            continue;
        }
        if ((i < 2 || i == 4) && strcmp(type, "number") != 0)
            glintL_error(L, "%s: a %s has no %s", full, type, names[i]);
        if (i == 4 && found != LUA_TBOOLEAN)
            glintL_refuse(L, -1, full, "boolean");
        if (i < 2 && !(found == LUA_TNUMBER && isfinite(lua_tonumber(L, -1))))
            glintL_refuse(L, -1, full, "finite number");
        if (i == 2 && found != LUA_TSTRING)
            glintL_refuse(L, -1, full, "string");
        if (i == 3) {
            if (found != LUA_TTABLE || glintL_check_list(L, -1, full, false) == 0)
                glintL_refuse(L, -1, full, "list of values");
            for (lua_Integer c = luaL_len(L, -1); c >= 1; c--) {
                lua_rawgeti(L, -1, c);
                if (strcmp(luaL_typename(L, -1), type) != 0)
                    glintL_refuse(L, -1, full, type);
                lua_pop(L, 1);
            }
        }
        lua_setfield(L, spec, names[i]);
    }
}

static void check_keys(lua_State *L, int index, const char *path)
{
    static const glintL_field known[] = {
        { .name = "min" },   { .name = "max" }, { .name = "choices" }, { .name = "doc" },
        { .name = "whole" }, { .name = NULL }
    };
    lua_pushnil(L);
    while (lua_next(L, index)) {
        lua_pop(L, 1);
        if (lua_type(L, -1) == LUA_TSTRING) {
            const char *key = lua_tostring(L, -1);
            if (!glintL_find_field(known, key))
                glintL_no_such_field(L, path, key, glintL_nearest(key, known));
        } else if (!lua_isinteger(L, -1) || lua_tointeger(L, -1) != 1) {
            glintL_bad_key(L, path, -1);
        }
    }
}

// Pushes the value that the command line's text gives the parameter; raises if the parameter does not allow it.
static void push_given(lua_State *L, const glintL_set *set, const char *text, int spec)
{
    lua_getfield(L, spec, "default");
    bool good = push_literal(L, text, lua_gettop(L));
    if (!good || !is_allowed(L, spec, lua_gettop(L))) {
        lua_pushfstring(L, "--%s %s: %s expected, got '%s'", set->values ? "sweep" : "set", set->name, glintL_push_allowed(L, spec), text);
        lua_error(L);
    }
}

// Stores the value of --set or --sweep for this parameter, if there is one, in spec.value.
static void apply_set(lua_State *L, glintL_run *run, const char *name, int spec)
{
    glintL_set *set = find_set(run, name);
    if (!set)
        return;
    if (set->values && run->point <= 1) // checks all values before the first picture
        for (int64_t i = 0; i < set->value_count; i++) {
            push_given(L, set, set->values[i], spec);
            lua_settop(L, spec);
        }
    push_given(L, set, set->text, spec);
    lua_setfield(L, spec, "value");
    lua_settop(L, spec);
}

void glintL_push_param_spec(lua_State *L, glintL_run *run, const char *name, int entry)
{
    char path[128];
    snprintf(path, sizeof path, "params.%s", name);
    luaL_checkstack(L, 12, "params");
    lua_newtable(L);
    int spec = lua_gettop(L);
    if (lua_istable(L, entry)) {
        check_keys(L, entry, path);
        lua_rawgeti(L, entry, 1);
    } else {
        lua_pushvalue(L, entry);
    }
    int value = lua_gettop(L);
    check_type(L, value, path);
    const char *type = luaL_typename(L, value);
    lua_pushstring(L, type);
    lua_setfield(L, spec, "type");
    lua_pushstring(L, name);
    lua_setfield(L, spec, "name");
    if (lua_istable(L, entry))
        read_limits(L, entry, spec, path, type);
    if (!is_allowed(L, spec, value))
        glintL_refuse(L, value, path, glintL_push_allowed(L, spec));
    lua_pushvalue(L, value);
    lua_setfield(L, spec, "default");
    lua_pushvalue(L, value);
    lua_setfield(L, spec, "value");
    apply_set(L, run, name, spec);
    lua_settop(L, spec);
}
