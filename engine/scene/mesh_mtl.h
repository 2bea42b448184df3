/// The materials of .obj files: what usemtl names, as the files that mtllib names have it. Internal to scene/.
#ifndef GLINT_MESH_MTL_H
#define GLINT_MESH_MTL_H

#include "engine/scene/mesh_file.h"

/// Where a picture lies: at a shape's coordinates times `scale` plus `offset`.
typedef struct glint_mesh_map {
    double scale[2], offset[2];
    bool clamp; ///< beyond 0 .. 1 is the picture's border, not the picture again
} glint_mesh_map;

/// A pattern of the picture's first `channels` (1 or 3) times numbers.
glint_status glint_mesh_paint(const glint_texture *texture, const glint_mesh_map *map, const double factor[3],
                              size_t channels, glint_program **out, glint_error *error);

/// Whether a picture's red, green and blue are alike in the mean: heights are grey, directions of normals are bluish.
glint_status glint_mesh_find_grey(const glint_texture *texture, bool *grey, glint_error *error);

/// NULL: out of memory.
glint_mesh_library *glint_mesh_library_create(void);
void glint_mesh_library_free(glint_mesh_library *library); ///< NULL: nothing
/// mtllib: reads the materials of a file, or of several; `names` is the rest of the line. A file that cannot be read gives a warning.
glint_status glint_mesh_library_read(glint_mesh_library *library, const glint_mesh_reader *reader, const char *names);
/// usemtl: the faces that follow have this material.
void glint_mesh_library_use(glint_mesh_library *library, const char *name);
/// The material of a face: a number among those that faces have, in the order of their first faces.
glint_status glint_mesh_library_face(glint_mesh_library *library, uint32_t *number, glint_error *error);
/// Makes the materials of a file that is read; missing pictures are warnings.
glint_status glint_mesh_library_make(glint_mesh_library *library, const glint_mesh_reader *reader);
/// Whether a face has a material that a file describes; after glint_mesh_library_make.
bool glint_mesh_library_found(const glint_mesh_library *library);
/// Puts them into a description; the library keeps them until it is freed.
void glint_mesh_library_give(const glint_mesh_library *library, const glint_mesh_reader *reader, glint_mesh_desc *desc);

#endif
