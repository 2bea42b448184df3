#include "bindings/lua/many.h"

#include <stdio.h>

#define PATH_SIZE 32

void glintL_many_fetch(lua_State *L, const char *name, int index)
{
    lua_pushstring(L, name);
    lua_rawget(L, 1);
    lua_replace(L, index);
}

const uint32_t *glintL_many_index(lua_State *L, const glintL_many *many, size_t count, size_t material_count)
{
    char path[PATH_SIZE];
    glintL_many_fetch(L, "index", many->index);
    if (lua_isnil(L, many->index) && material_count < 2)
        return NULL;
    if (material_count == 0)
        glintL_error(L, "%s.index: an index needs materials; set materials, too", many->object);
    snprintf(path, sizeof path, "%s.index", many->object);
    const glintL_array *array = glintL_to_array(L, many->index);
    if (lua_istable(L, many->index)) {
        const glintL_numbers numbers = { .path = path, .is_whole = true };
        array = glintL_take_list(L, many->index, &numbers, glintL_check_list(L, many->index, path, false));
    } else if (lua_type(L, many->index) == LUA_TSTRING) {
        const size_t bytes = lua_rawlen(L, many->index);
        if (bytes != count * sizeof(uint32_t))
            glintL_error(L, "%s: %I bytes (a u32 a %s) expected, got %I bytes", path,
                         (LUAI_UACINT)(count * sizeof(uint32_t)), many->each, (LUAI_UACINT)bytes);
        array = glintL_take_packed(L, many->index, 'u');
    } else if (!array) {
        glintL_refuse(L, many->index, path, "array, table or packed string of numbers");
        return NULL;
    }
    if (!array->is_whole || array->width != 1)
        glintL_refuse(L, many->index, path, "array of whole numbers");
    if (array->count != count)
        glintL_error(L, "%s: %I numbers (one a %s) expected, got %I", path, (LUAI_UACINT)count, many->each,
                     (LUAI_UACINT)array->count);
    uint32_t *out = lua_newuserdatauv(L, (count + 1) * sizeof *out, 0);
    lua_replace(L, many->index_buffer);
    for (size_t i = 0; i < count; i++) {
        const int64_t number = array->wholes[i];
        if (number < 1 || (uint64_t)number > material_count)
            glintL_error(L, "%s[%I]: number 1 .. %I expected, got %I", path, (LUAI_UACINT)i + 1,
                         (LUAI_UACINT)material_count, (LUAI_UACINT)number);
        out[i] = (uint32_t)number - 1;
    }
    return out;
}

glint_material **glintL_many_prepare(lua_State *L, const glintL_many *many, size_t *material_count)
{
    char path[PATH_SIZE];
    size_t count = 1;
    snprintf(path, sizeof path, "%s.materials", many->object);
    glintL_many_fetch(L, "material", many->material);
    glintL_many_fetch(L, "materials", many->materials);
    const bool one = !lua_isnil(L, many->material);
    *material_count = 0;
    if (one && !lua_isnil(L, many->materials))
        glintL_error(L, "%s: material or materials expected, got both", many->object);
    if (!one && lua_isnil(L, many->materials))
        return NULL;
    if (!one && !lua_istable(L, many->materials))
        glintL_refuse(L, many->materials, path, "list of materials");
    if (!one && (count = glintL_check_list(L, many->materials, path, false)) == 0)
        glintL_error(L, "%s: list of materials expected, got an empty table", path);
    lua_newtable(L);
    lua_replace(L, many->kept);
    for (size_t i = 1; i <= count; i++) {
        if (one)
            lua_pushvalue(L, many->material);
        else
            lua_rawgeti(L, many->materials, (lua_Integer)i);
        lua_rawseti(L, many->kept, (lua_Integer)i);
    }
    glint_material **pointers = lua_newuserdatauv(L, count * sizeof *pointers, 0);
    lua_replace(L, many->pointers);
    *material_count = count;
    return pointers;
}

void glintL_many_read(lua_State *L, const glintL_many *many, size_t material_count, glint_material **pointers)
{
    char path[PATH_SIZE];
    for (size_t i = 0; i < material_count; i++) {
        lua_rawgeti(L, many->kept, (lua_Integer)i + 1);
        pointers[i] = glintL_test_object(L, -1, GLINTL_MATERIAL);
        if (!pointers[i] && !lua_isnil(L, many->material)) {
            snprintf(path, sizeof path, "%s.material", many->object);
            glintL_refuse(L, -1, path, "material");
        }
        if (!pointers[i]) {
            const char *got = glintL_push_spelling(L, -1);
            glintL_error(L, "%s.materials[%I]: material expected, got %s", many->object, (LUAI_UACINT)i + 1, got);
        }
        lua_pop(L, 1);
    }
}

void glintL_many_keep(lua_State *L, const glintL_many *many, int box)
{
    if (!lua_isnil(L, many->material))
        glintL_keep(L, box, "material", many->material);
    else if (!lua_isnil(L, many->materials))
        glintL_keep(L, box, "materials", many->kept);
}
