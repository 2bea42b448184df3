/// The material of each of many spheres or faces: the fields material, materials and index of glint.spheres and
/// glint.mesh. Internal.
#ifndef GLINT_L_MANY_H
#define GLINT_L_MANY_H

#include "bindings/lua/lua.h"

/// The fields of a constructor that makes many objects from one table, its first argument. `object` and `each` name
/// the objects in messages. The other fields are positions on the stack, reserved by the constructor.
typedef struct glintL_many {
    const char *object, *each; ///< "spheres", "sphere"
    int material, materials, index; ///< positions of the fields
    int index_buffer, pointers; ///< positions of memory
    int kept; ///< position of the list that retains the materials; nil without materials
} glintL_many;

/// Copies a field of the constructor's table to its position on the stack.
void glintL_many_fetch(lua_State *L, const char *name, int index);
/// Counts the materials, allocates their pointers, and makes the list that retains them. NULL: there are none.
glint_material **glintL_many_prepare(lua_State *L, const glintL_many *many, size_t *material_count);
/// Returns the materials' numbers, from 0, of `count` things. NULL: all have the first material.
const uint32_t *glintL_many_index(lua_State *L, const glintL_many *many, size_t count, size_t material_count);
/// Fills in the pointers. Call it right before the engine, with no allocation in between: a finalizer could close a
/// material.
void glintL_many_read(lua_State *L, const glintL_many *many, size_t material_count, glint_material **pointers);
/// Retains the materials as long as the userdata at `box` lives.
void glintL_many_keep(lua_State *L, const glintL_many *many, int box);

// ---- shape_data.c: fields that cannot be assigned ----

int glintL_get_data(lua_State *L); ///< of spheres and cylinders: a row each
int glintL_get_index(lua_State *L); ///< of many shapes and meshes: the material of each, from 1; nil: all have the first
int glintL_get_vertices(lua_State *L);
int glintL_get_faces(lua_State *L); ///< a row a triangle
int glintL_get_normals(lua_State *L); ///< a row a vertex, or a row a corner of each triangle; nil: none were given
int glintL_get_uv(lua_State *L); ///< the same

#endif
