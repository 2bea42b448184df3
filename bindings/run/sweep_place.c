// The place of a frame in a sweep: names of the axes and values, as text for files and as a table for labels.
#include <string.h>

#include "bindings/run/run.h"

int glintL_sweep_push_axis(lua_State *L, int axes, lua_Integer i)
{
    lua_rawgeti(L, axes, i);
    int axis = lua_gettop(L);
    for (int part = 1; part <= 3; part++)
        lua_rawgeti(L, axis, part);
    lua_remove(L, axis);
    return axis;
}

// Pushes and returns the name of the object at `object`; "" if it has none.
static const char *push_object_name(lua_State *L, int object)
{
    const int top = lua_gettop(L);
    const bool is_named = lua_isuserdata(L, object) && !glintL_test_object(L, object, GLINTL_SCENE) && // has no name
                          luaL_getmetafield(L, object, "__name") != LUA_TNIL &&
                          glintL_test_object(L, object, lua_tostring(L, -1)) &&
                          lua_getfield(L, object, "name") == LUA_TSTRING;
    if (!is_named)
        lua_pushliteral(L, "");
    lua_insert(L, top + 1);
    lua_settop(L, top + 1);
    return lua_tostring(L, -1);
}

// Pushes the name of an axis: its field; with the object before it if another axis has the same field.
static void push_axis_name(lua_State *L, int axes, lua_Integer i)
{
    int top = lua_gettop(L), object = glintL_sweep_push_axis(L, axes, i), others = 0;
    for (lua_Integer j = 1; j <= (lua_Integer)lua_rawlen(L, axes); j++) {
        int other = glintL_sweep_push_axis(L, axes, j);
        others += j != i && lua_rawequal(L, object + 1, other + 1);
        lua_settop(L, other - 1);
    }
    const char *name = push_object_name(L, object);
    if (others && *name)
        lua_pushfstring(L, "%s.%s", name, lua_tostring(L, object + 1));
    else if (others)
        lua_pushfstring(L, "%s %d", lua_tostring(L, object + 1), (int)i);
    else
        lua_pushvalue(L, object + 1);
    lua_replace(L, top + 1);
    lua_settop(L, top + 1);
}

void glintL_sweep_push_title(lua_State *L, int axes, lua_Integer i)
{
    const int top = lua_gettop(L), object = glintL_sweep_push_axis(L, axes, i);
    const char *name = push_object_name(L, object);
    if (*name)
        lua_pushfstring(L, "%s.%s", name, lua_tostring(L, object + 1));
    else
        push_axis_name(L, axes, i);
    lua_replace(L, top + 1);
    lua_settop(L, top + 1);
}

// Pushes the smallest string key of the table at `value` after the one at `after` (nil: of all), or nil.
static void push_next_name(lua_State *L, int value, int after)
{
    lua_pushnil(L);
    int least = lua_gettop(L);
    lua_pushnil(L);
    while (lua_next(L, value)) {
        lua_pop(L, 1);
        if (lua_type(L, -1) == LUA_TSTRING && (lua_isnil(L, after) || lua_compare(L, after, -1, LUA_OPLT)) &&
            (lua_isnil(L, least) || lua_compare(L, -1, least, LUA_OPLT))) {
            lua_pushvalue(L, -1);
            lua_replace(L, least);
        }
    }
}

// Pushes the text of the table at `value`, with or without names: a vector, a colour, the fields of indirect.
static void push_table_text(lua_State *L, int value)
{
    luaL_Buffer text;
    const char *between = "{";
    lua_pushnil(L);
    int name = lua_gettop(L);
    luaL_buffinit(L, &text);
    for (lua_Integer k = 1; k <= (lua_Integer)lua_rawlen(L, value); k++) {
        luaL_addstring(&text, between);
        lua_rawgeti(L, value, k);
        luaL_tolstring(L, -1, NULL);
        lua_remove(L, -2);
        luaL_addvalue(&text);
        between = ", ";
    }
    for (;;) {
        push_next_name(L, value, name);
        lua_replace(L, name);
        if (lua_isnil(L, name))
            break;
        luaL_addstring(&text, between);
        lua_pushvalue(L, name);
        luaL_addvalue(&text);
        luaL_addstring(&text, " = ");
        lua_pushvalue(L, name);
        lua_rawget(L, value);
        luaL_tolstring(L, -1, NULL);
        lua_remove(L, -2);
        luaL_addvalue(&text);
        between = ", ";
    }
    luaL_addstring(&text, *between == '{' ? "{}" : "}");
    luaL_pushresult(&text);
    lua_remove(L, name);
}

// Pushes the value on top, number `i` of its axis, as text on one line.
static void push_value_text(lua_State *L, int64_t i)
{
    char number[32];
    int value = lua_gettop(L);
    if (lua_type(L, value) == LUA_TNUMBER && !lua_isinteger(L, value)) {
        glintL_format_number(number, lua_tonumber(L, value));
        lua_pushstring(L, number);
    } else if (lua_istable(L, value)) {
        push_table_text(L, value);
    } else if (lua_isuserdata(L, value) && !glintL_to_vector(L, value)) { // an object
        lua_pushfstring(L, "number %d", (int)i);
    } else {
        luaL_tolstring(L, value, NULL);
    }
    luaL_gsub(L, lua_tostring(L, -1), "\n", " ");
    lua_remove(L, -2);
}

void glintL_sweep_push_position(lua_State *L, int index, int64_t n)
{
    int64_t rest = n - 1;
    luaL_checkstack(L, 20, "sweep");
    int top = lua_gettop(L);
    lua_getiuservalue(L, index, GLINTL_JOB_FRAME);
    lua_pushliteral(L, "");
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, top + 1); i++) {
        lua_pushstring(L, i > 1 ? "\n" : "");
        push_axis_name(L, top + 1, i);
        lua_pushliteral(L, "=");
        int object = glintL_sweep_push_axis(L, top + 1, i);
        int64_t count = (int64_t)lua_rawlen(L, object + 2);
        lua_rawgeti(L, object + 2, rest % count + 1);
        push_value_text(L, rest % count + 1);
        lua_replace(L, object);
        lua_settop(L, object);
        lua_concat(L, 5);
        rest /= count;
    }
    lua_remove(L, top + 1);
}

void glintL_sweep_push_values(lua_State *L, int index, int64_t n)
{
    int64_t rest = n - 1;
    luaL_checkstack(L, 20, "sweep");
    int top = lua_gettop(L);
    lua_getiuservalue(L, index, GLINTL_JOB_FRAME);
    lua_newtable(L);
    for (lua_Integer i = 1; i <= (lua_Integer)lua_rawlen(L, top + 1); i++) {
        push_axis_name(L, top + 1, i);
        int object = glintL_sweep_push_axis(L, top + 1, i);
        int64_t count = (int64_t)lua_rawlen(L, object + 2);
        lua_rawgeti(L, object + 2, rest % count + 1);
        lua_replace(L, object);
        lua_settop(L, object);
        lua_rawset(L, top + 2);
        rest /= count;
    }
    lua_remove(L, top + 1);
}
