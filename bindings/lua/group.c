// glint.group: a list of shapes under one transform; and the combined solids: their parts and methods.
#include <stdio.h>

#include "bindings/lua/lua.h"
#include "engine/glint.h"

static glint_shape *check_group(lua_State *L, int index)
{
    glint_shape *shape = glintL_check_object(L, index, GLINTL_SHAPE);
    if (glint_shape_get(shape)->kind < GLINT_SHAPE_GROUP)
        glintL_refuse(L, index, "", "group");
    return shape;
}

// Stores the userdata of a child in the group's, so that it reads as the same object.
static void add_child(lua_State *L, int index, int value, const char *path)
{
    char key[32];
    glint_error error;
    if (!glintL_test_object(L, value, GLINTL_SHAPE))
        glintL_refuse(L, value, path, "shape");
    snprintf(key, sizeof key, "%p", glintL_test_object(L, value, GLINTL_SHAPE));
    glintL_keep(L, index, key, value);
    glint_shape *group = check_group(L, index), *child = glintL_test_object(L, value, GLINTL_SHAPE);
    if (!child) // a finalizer has closed the child
        glintL_refuse(L, value, path, "shape");
    glintL_check_status(L, "", &error, glint_group_add(group, child, &error));
}

// Returns "group.add", "union.add" and so on.
static const char *method_of(lua_State *L, const char *name)
{
    static const char *const kinds[] = { "group", "union", "intersection", "difference" };
    return lua_pushfstring(L, "%s.%s", kinds[glint_shape_get(check_group(L, 1))->kind - GLINT_SHAPE_GROUP], name);
}

int glintL_group_add(lua_State *L)
{
    const int count = lua_gettop(L) - 1;
    const char *name = method_of(L, "add");
    glintL_refuse_within_trace(L, name);
    if (count != 1)
        return glintL_error(L, "%s: one shape expected, got %d", name, count);
    add_child(L, 1, 2, name);
    lua_settop(L, 2);
    return 1;
}

int glintL_group_remove(lua_State *L)
{
    char key[32];
    glint_error error;
    glint_shape *group = check_group(L, 1), *child = glintL_test_object(L, 2, GLINTL_SHAPE);
    lua_settop(L, 2);
    const char *name = method_of(L, "remove");
    glintL_refuse_within_trace(L, name);
    if (!child)
        glintL_refuse(L, 2, name, "shape");
    snprintf(key, sizeof key, "%p", (void *)child);
    glintL_check_status(L, "", &error, glint_group_remove(group, child, &error));
    lua_settop(L, 2);
    lua_pushnil(L);
    glintL_keep(L, 1, key, 3);
    return 0;
}

void glintL_group_push_at(lua_State *L, const void *group, size_t index)
{
    glintL_push_object(L, GLINTL_SHAPE, glint_group_child(group, index));
}

void glintL_group_fill(lua_State *L, int list, int index, const char *name)
{
    const size_t count = glintL_check_list(L, list, name, true);
    if (count == 0 && glint_shape_get(check_group(L, index))->kind != GLINT_SHAPE_GROUP)
        glintL_error(L, "%s: shapes expected, such as glint.%s { glint.sphere {...}, glint.box {...} }", name, name);
    for (size_t i = 1; i <= count; i++) {
        char path[32];
        lua_rawgeti(L, list, (lua_Integer)i);
        snprintf(path, sizeof path, "%s[%zu]", name, i);
        add_child(L, index, lua_gettop(L), path);
        lua_pop(L, 1);
    }
}
