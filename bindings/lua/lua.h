/// The parts of the module's table that these files make, and what they share. Private to bindings/lua.
#ifndef GLINTL_LUA_H
#define GLINTL_LUA_H

#include "bindings/run/run.h"

/// Each file's part of the module: adds its constructors to the table on top of the stack, and makes its metatables.
void glintL_open_material(lua_State *L);
void glintL_open_light(lua_State *L);
void glintL_open_camera(lua_State *L);
void glintL_open_shape(lua_State *L);
void glintL_open_overlay(lua_State *L); ///< label, colorbar, axes, arrow, line, arc, polyline, lobe, path, frustum
void glintL_open_scene(lua_State *L);
void glintL_open_image(lua_State *L);
void glintL_open_math(lua_State *L);
void glintL_open_params(lua_State *L);
void glintL_open_animation(lua_State *L); ///< animation and sweep

/// picture.c: glint.read_image.
void glintL_open_picture(lua_State *L);
/// rows.c: glint._row_reader, the reader of rows of text.
void glintL_open_rows(lua_State *L);
/// unpack.c: glint._unpack, the reader of compressed files.
void glintL_open_unpack(lua_State *L);
/// Writes the four bytes of a float32, little endian; returns the position after them.
char *glintL_put_float(char *to, float value);

/// The constructors glint.spheres, glint.cylinders and glint._bonds, in spheres.c.
int glintL_new_spheres(lua_State *L);
int glintL_new_cylinders(lua_State *L);
int glintL_new_bonds(lua_State *L);
/// The constructors glint.mesh and glint.sphere_mesh, in mesh.c.
int glintL_new_mesh(lua_State *L);
int glintL_new_sphere_mesh(lua_State *L);
/// group.c: methods, the getter `count`, and the children in the list at `list`.
int glintL_group_add(lua_State *L);
int glintL_group_remove(lua_State *L);
void glintL_group_push_at(lua_State *L, const void *group, size_t index);
void glintL_group_fill(lua_State *L, int list, int index, const char *name);
void glintL_open_texture(lua_State *L);

#endif
