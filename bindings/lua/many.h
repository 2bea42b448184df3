/// Which material each of many has: the fields material, materials and index of glint.spheres and glint.mesh. Internal.
#ifndef GLINT_L_MANY_H
#define GLINT_L_MANY_H

#include "bindings/value/glintL.h"

/// The names of a constructor, whose table is the first argument, and free positions on its stack.
typedef struct glintL_many {
    const char *object, *each; ///< "spheres", "sphere"
    int material, materials, index; ///< the fields
    int index_buffer, pointers; ///< memory
    int kept; ///< the list that keeps the materials; nil without any
} glintL_many;

/// Counts the materials and makes room for their pointers, and the list that keeps them alive. NULL: there are none.
glint_material **glintL_many_prepare(lua_State *L, const glintL_many *many, size_t *material_count);
/// The numbers of materials, from 0, of `count` things. NULL: all have the first.
const uint32_t *glintL_many_index(lua_State *L, const glintL_many *many, size_t count, size_t material_count);
/// Fills the pointers. Last before the engine is called, and without allocating: until then a finalizer could close a material.
void glintL_many_read(lua_State *L, const glintL_many *many, size_t material_count, glint_material **pointers);
/// Keeps the materials as long as the userdata at `box`.
void glintL_many_keep(lua_State *L, const glintL_many *many, int box);

#endif
