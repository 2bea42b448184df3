/// The materials of .obj files: mtllib names files that define them, usemtl selects one. Internal to scene/.
#ifndef GLINT_MESH_MTL_H
#define GLINT_MESH_MTL_H

#include "engine/files/mesh/file.h"
#include "engine/glint_programs.h"

/// The mapping of a picture: texture coordinates times `scale` plus `offset`.
typedef struct glint_mesh_map {
    double scale[2], offset[2];
    bool clamp; ///< outside 0 .. 1 the border continues; otherwise the picture repeats
} glint_mesh_map;

/// Makes a pattern of the picture's first `channels` (1 or 3), multiplied by `factor`.
glint_status glint_mesh_paint(const glint_texture *texture, const glint_mesh_map *map, const double factor[3],
                              size_t channels, glint_program **out, glint_error *error);

/// Determines whether the mean colour of a picture is grey, as in height maps; normal maps are bluish.
glint_status glint_mesh_find_grey(const glint_texture *texture, bool *grey, glint_error *error);

/// Creates an empty library; NULL: out of memory.
glint_mesh_library *glint_mesh_library_create(void);
void glint_mesh_library_free(glint_mesh_library *library); ///< NULL: nothing
/// Handles mtllib: reads the materials of one or several files; `names` is the rest of the line. A file that cannot
/// be read causes a warning.
glint_status glint_mesh_library_read(glint_mesh_library *library, const glint_mesh_reader *reader, const char *names);
/// Handles usemtl: the faces that follow have this material.
void glint_mesh_library_use(glint_mesh_library *library, const char *name);
/// Writes the index of a face's material among all materials that faces use, in the order of their first faces.
glint_status glint_mesh_library_face(glint_mesh_library *library, uint32_t *number, glint_error *error);
/// Makes the materials of the file; missing pictures cause warnings.
glint_status glint_mesh_library_make(glint_mesh_library *library, const glint_mesh_reader *reader);
/// Returns whether a face has a material that a file describes; after glint_mesh_library_make.
bool glint_mesh_library_is_used(const glint_mesh_library *library);
/// Puts the materials into a description; the library owns them until it is freed.
void glint_mesh_library_give(const glint_mesh_library *library, const glint_mesh_reader *reader, glint_mesh_desc *desc);

#endif
