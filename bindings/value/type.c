// Metatables of types, and what glint._fields() lists of them.
#include <stdint.h>

#include "bindings/value/glintL.h"

static const char LISTED; // address used as the registry key for the result of glint._fields()
static const char VARIANTS; // address used as the registry key for the variants with rows, by name

const glintL_field *glintL_fields_of(const glintL_variant *variant)
{
    return variant->kind ? glint_object_fields(variant->kind, NULL) : variant->fields;
}

void glintL_set_text(lua_State *L, const char *name, const char *value)
{
    lua_pushstring(L, value);
    lua_setfield(L, -2, name);
}

void glintL_set_number(lua_State *L, const char *name, double value)
{
    lua_pushnumber(L, value);
    lua_setfield(L, -2, name);
}

void glintL_set_whole(lua_State *L, const char *name, lua_Integer value)
{
    lua_pushinteger(L, value);
    lua_setfield(L, -2, name);
}

void glintL_set_flag(lua_State *L, const char *name, bool value)
{
    lua_pushboolean(L, value);
    lua_setfield(L, -2, name);
}

void glintL_set_function(lua_State *L, const char *name, lua_CFunction value)
{
    lua_pushcfunction(L, value);
    lua_setfield(L, -2, name);
}

void glintL_new_type(lua_State *L, const char *type, const luaL_Reg *functions)
{
    luaL_newmetatable(L, type);
    luaL_setfuncs(L, functions, 0);
    glintL_set_flag(L, "__metatable", false);
    lua_pop(L, 1);
}

// Stores a variant that has rows in the engine.
static void note_rows(lua_State *L, const glintL_variant *variant)
{
    glintL_push_table(L, &VARIANTS);
    lua_pushlightuserdata(L, (void *)(uintptr_t)variant);
    lua_setfield(L, -2, variant->name);
    lua_pop(L, 1);
}

const glintL_variant *glintL_find_variant(lua_State *L, const char *name)
{
    glintL_push_table(L, &VARIANTS);
    lua_getfield(L, -1, name);
    const glintL_variant *variant = lua_touserdata(L, -1);
    lua_pop(L, 2);
    return variant;
}

void glintL_list_functions(lua_State *L, const luaL_Reg *functions, const char *how)
{
    for (; functions && functions->name; functions++) {
        lua_pushstring(L, how);
        lua_setfield(L, -2, functions->name);
    }
}

void glintL_list_variant(lua_State *L, const glintL_variant *variant, const luaL_Reg *methods)
{
    glintL_push_table(L, &LISTED);
    lua_newtable(L);
    for (const glintL_field *field = glintL_fields_of(variant); field && field->name; field++) {
        lua_pushliteral(L, "field");
        lua_setfield(L, -2, field->name);
    }
    glintL_list_functions(L, variant->getters, "field");
    glintL_list_functions(L, methods, "method");
    lua_setfield(L, -2, variant->name);
    lua_pop(L, 1);
    if (variant->kind)
        note_rows(L, variant);
}

void glintL_push_listed(lua_State *L) { glintL_push_table(L, &LISTED); }
