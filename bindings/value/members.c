// The objects of scenes and groups, by number, and the iteration over the members of any object.
#include <string.h>

#include "bindings/value/glintL.h"

int glintL_push_numbered(lua_State *L, const glintL_class *class, const void *object, lua_Integer number)
{
    if (number >= 1 && number <= class->count(object))
        class->push_at(L, object, (size_t)number - 1);
    else
        lua_pushnil(L);
    return 1;
}

// Returns the class of argument 1, or NULL if it is no object.
static const glintL_class *class_of_argument(lua_State *L)
{
    if (luaL_getmetafield(L, 1, "class") == LUA_TNIL)
        return NULL;
    const glintL_class *class = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return class;
}

// Returns the class of argument 1, which must be a scene, a group or a combined solid.
static const glintL_class *list_class(lua_State *L, const void **object)
{
    const glintL_class *class = class_of_argument(L);
    *object = class && class->count ? glintL_check_object(L, 1, class->type) : NULL;
    if (!*object || class->count(*object) < 0)
        glintL_refuse(L, 1, "", "scene or group");
    return class;
}

int glintL_count_objects(lua_State *L)
{
    const void *object;
    const glintL_class *class = list_class(L, &object);
    lua_pushinteger(L, class->count(object));
    return 1;
}

// Looks at the list again after each object: making a userdata may run a finalizer of the script, which may change it.
int glintL_list_objects(lua_State *L)
{
    const void *object;
    lua_settop(L, 1);
    lua_newtable(L);
    for (lua_Integer i = 1;; i++) {
        const glintL_class *class = list_class(L, &object);
        glintL_push_numbered(L, class, object, i);
        if (lua_isnil(L, -1))
            break;
        lua_rawseti(L, 2, i);
    }
    lua_settop(L, 2);
    return 1;
}

// The step of pairs. Upvalue 1: the number of steps so far. The objects of a list come first, then the fields that are
// not nil, in the order of the manual.
static int next_member(lua_State *L)
{
    const glintL_class *class = class_of_argument(L);
    if (!class)
        return glintL_refuse(L, 1, "", "object");
    for (;;) {
        const void *object = glintL_check_object(L, 1, class->type);
        const lua_Integer count = class->count && class->count(object) > 0 ? class->count(object) : 0;
        const lua_Integer step = lua_tointeger(L, lua_upvalueindex(1));
        const glintL_field *field = glintL_fields_of(class->variant(object));
        for (lua_Integer i = count; field && field->name && i < step; i++)
            field++;
        lua_pushinteger(L, step + 1);
        lua_replace(L, lua_upvalueindex(1));
        lua_settop(L, 1);
        if (step < count)
            lua_pushinteger(L, step + 1);
        else if (field && field->name)
            lua_pushstring(L, field->name);
        else
            return 0;
        lua_pushvalue(L, 2);
        lua_gettable(L, 1);
        if (!lua_isnil(L, 3))
            return 2;
    }
}

int glintL_pairs(lua_State *L)
{
    lua_pushinteger(L, 0);
    lua_pushcclosure(L, next_member, 1);
    lua_pushvalue(L, 1);
    return 2;
}

// Pushes the value of a field of the object at 1; nil if the field is not set. Returns whether a program that has no
// pattern in Lua, such as a texture of a mesh's file, replaces the value.
static bool push_own(lua_State *L, const glintL_class *class, const glintL_field *field)
{
    union {
        max_align_t align;
        char bytes[GLINTL_DESC_SIZE];
    } desc;
    const glint_program *program = NULL;
    if (field->program_offset && glintL_push_kept(L, 1, field->name))
        return false;
    class->get(glintL_check_object(L, 1, class->type), &desc);
    if (field->program_offset)
        memcpy(&program, desc.bytes + field->program_offset, sizeof program);
    if (field->type == GLINT_TYPE_OBJECT)
        lua_getfield(L, 1, field->name);
    else
        glintL_push_field(L, field, &desc);
    return program;
}

int glintL_list_fields(lua_State *L)
{
    const glintL_class *class = class_of_argument(L);
    lua_settop(L, 1);
    if (!class)
        return glintL_refuse(L, 1, "", "object");
    const glintL_variant *variant = class->variant(glintL_check_object(L, 1, class->type));
    lua_newtable(L);
    for (const glintL_field *field = glintL_fields_of(variant); field && field->name; field++) {
        const bool has_program = push_own(L, class, field);
        lua_createtable(L, 4, 0);
        lua_pushstring(L, field->name);
        lua_rawseti(L, 4, 1);
        if (variant->kind && !field->required && !field->set_offset) {
            glintL_push_default(L, field);
            lua_rawseti(L, 4, 3);
        }
        lua_pushboolean(L, has_program);
        lua_rawseti(L, 4, 4);
        lua_pushvalue(L, 3);
        lua_rawseti(L, 4, 2);
        if (has_program || !lua_isnil(L, 3))
            lua_rawseti(L, 2, (lua_Integer)lua_rawlen(L, 2) + 1);
        lua_settop(L, 2);
    }
    return 1;
}
