// Boxes: the userdata for objects of the engine.
#include <stdint.h>
#include <limits.h>
#include <string.h>

#include "bindings/value/glintL.h"

static const char TRACING; // address used as the registry key for the functions for patterns

#define OBJECT_BYTES 1024 // roughly the engine's memory for a sphere, light or material

static const char BOXES; // address used as the registry key for the table of boxes by object

glintL_box *glintL_new_box(lua_State *L, const char *type)
{
    luaL_checkstack(L, 4, "object");
    glintL_box *box = lua_newuserdatauv(L, sizeof *box, 1);
    box->object = NULL;
    luaL_setmetatable(L, type);
    return box;
}

void *glintL_test_object(lua_State *L, int index, const char *type)
{
    const glintL_box *box = luaL_testudata(L, index, type);
    return box ? box->object : NULL;
}

void *glintL_check_object(lua_State *L, int index, const char *type)
{
    const char *name = type + sizeof "glint." - 1;
    const glintL_box *box = luaL_testudata(L, index, type);
    if (!box) {
        const char *got = glintL_push_spelling(L, index);
        glintL_error(L, "%s expected, got %s%s", name, got, glintL_push_colon_cure(L, index));
    } else if (!box->object)
        glintL_error(L, "%s is closed", name);
    return box ? box->object : NULL;
}

void glintL_push_table(lua_State *L, const void *key)
{
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, key) != LUA_TNIL)
        return;
    lua_pop(L, 1);
    lua_newtable(L);
    lua_pushvalue(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, key);
}

void glintL_push_weak_table(lua_State *L, const void *key, const char *mode)
{
    glintL_push_table(L, key);
    if (!lua_getmetatable(L, -1)) {
        lua_createtable(L, 0, 1);
        lua_pushstring(L, mode);
        lua_setfield(L, -2, "__mode");
        lua_pushvalue(L, -1);
        lua_setmetatable(L, -3);
    }
    lua_pop(L, 1);
}

void glintL_remember(lua_State *L, void *object)
{
    luaL_checkstack(L, 4, "object");
    glintL_push_weak_table(L, &BOXES, "v");
    lua_pushvalue(L, -2);
    lua_rawsetp(L, -2, object);
    lua_pop(L, 1);
    glintL_charge(L, OBJECT_BYTES);
}

// Allocates nothing.
void glintL_push_remembered(lua_State *L, const void *object)
{
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &BOXES) == LUA_TTABLE) {
        lua_rawgetp(L, -1, object);
        lua_remove(L, -2);
        const glintL_box *box = lua_touserdata(L, -1);
        if (box && box->object == object) // otherwise it was closed, and its address is reused
            return;
    }
    lua_pop(L, 1);
    lua_pushnil(L);
}

const glintL_class *glintL_class_of(lua_State *L, const char *type)
{
    luaL_getmetatable(L, type);
    lua_getfield(L, -1, "class");
    const glintL_class *class = lua_touserdata(L, -1);
    lua_pop(L, 2);
    return class;
}

void glintL_push_object(lua_State *L, const char *type, void *object)
{
    luaL_checkstack(L, 6, "object");
    glintL_push_remembered(L, object);
    if (!object || !lua_isnil(L, -1))
        return;
    lua_pop(L, 1);
    glintL_box *box = glintL_new_box(L, type);
    box->object = glintL_class_of(L, type)->retain(object);
    glintL_remember(L, object);
}

void glintL_keep(lua_State *L, int index, const char *key, int value)
{
    index = lua_absindex(L, index);
    value = lua_absindex(L, value);
    luaL_checkstack(L, 4, "object");
    if (lua_getiuservalue(L, index, 1) != LUA_TTABLE) {
        lua_pop(L, 1);
        lua_newtable(L);
        lua_pushvalue(L, -1);
        lua_setiuservalue(L, index, 1);
    }
    lua_pushvalue(L, value);
    lua_setfield(L, -2, key);
    lua_pop(L, 1);
}

bool glintL_push_kept(lua_State *L, int index, const char *key)
{
    luaL_checkstack(L, 3, "object");
    if (lua_getiuservalue(L, index, 1) == LUA_TTABLE) {
        lua_getfield(L, -1, key);
        lua_remove(L, -2);
    }
    const bool found = !lua_isnil(L, -1);
    if (!found)
        lua_pop(L, 1);
    return found;
}

void glintL_charge(lua_State *L, size_t bytes)
{
    size_t kib = bytes / 1024;
    if (kib > 0 && lua_gc(L, LUA_GCISRUNNING) == 1) // not if the script has stopped the collector
        lua_gc(L, LUA_GCSTEP, kib < INT_MAX ? (int)kib : INT_MAX);
}

bool glintL_push_object_name(lua_State *L, int index)
{
    if (luaL_getmetafield(L, index, "class") == LUA_TNIL)
        return false;
    const glintL_class *class = lua_touserdata(L, -1);
    lua_pop(L, 1);
    const void *object = class ? glintL_test_object(L, index, class->type) : NULL;
    if (object)
        lua_pushstring(L, class->variant(object)->name);
    else if (class)
        lua_pushfstring(L, "closed %s", class->type + sizeof "glint." - 1);
    return class != NULL;
}

void glintL_set_tracing(lua_State *L, const glintL_tracing *tracing)
{
    lua_pushlightuserdata(L, (void *)(uintptr_t)tracing);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &TRACING);
}

const glintL_tracing *glintL_get_tracing(lua_State *L)
{
    luaL_checkstack(L, 1, "patterns");
    lua_rawgetp(L, LUA_REGISTRYINDEX, &TRACING);
    const glintL_tracing *tracing = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return tracing;
}
