/// The materials of .obj files while they are read. Internal to scene/.
#ifndef GLINT_MESH_ENTRY_H
#define GLINT_MESH_ENTRY_H

#include "engine/scene/mesh_mtl.h"

#define GLINT_MESH_NO_FACE 0xffffffffu

/// Pictures that a material may have.
typedef enum glint_mesh_map_kind {
    GLINT_MAP_KD,
    GLINT_MAP_KS,
    GLINT_MAP_D,
    GLINT_MAP_BUMP,
    GLINT_MAP_COUNT
} glint_mesh_map_kind;

/// A material as a file has it. Sets find these by their key.
typedef struct glint_mesh_entry {
    glint_key key; ///< of its name; 0: the faces before the first usemtl
    glint_material_desc desc;
    double clear; ///< what it lets through: 1 - d
    bool has_d; ///< d is there: Tr does not count
    double
        illum; ///< 0 or 1: without a highlight; 3 .. 7: a mirror of Ks; 5 and 7: by Fresnel's formulas; 6 and 7: bends light
    double ni; ///< index of refraction; 0: none
    double rough, metal; ///< Pr, Pm; below 0: none
    bool lacks_uv; ///< a face has it and a corner without coordinates
    char *map[GLINT_MAP_COUNT]; ///< NULL: none
    glint_mesh_map place[GLINT_MAP_COUNT]; ///< of each
    double height; ///< -bm of the relief, world units; 0: none that can be taken
    char bm[GLINT_NAME_SIZE]; ///< what the file says for it; "": nothing
} glint_mesh_entry;

typedef struct glint_mesh_picture {
    glint_key key; ///< of its path, of `clamp`, and of whether its codes are numbers as they are
    glint_texture *texture; ///< NULL: it cannot be read
} glint_mesh_picture;

struct glint_mesh_library {
    glint_mesh_array known, used, pictures; ///< of the files; of the faces; of both
    glint_mesh_set known_set, used_set, picture_set;
    glint_mesh_array materials; ///< glint_material *, one for each of `used`
    glint_mesh_entry current; ///< of faces that follow: its key and name
    uint32_t current_number; ///< among `used`; GLINT_MESH_NO_FACE: no face has it yet
    char *file; ///< the first that was named; NULL: none
    bool found; ///< a face has a material of a file
    size_t missing; ///< materials of faces that no file has
    char first_missing[GLINT_NAME_SIZE];
    size_t flat; ///< materials whose relief has no height
    glint_mesh_entry first_flat; ///< its pictures are another's
    size_t invisible; ///< materials that let all light through
    char first_invisible[GLINT_NAME_SIZE];
    bool told; ///< a file could not be read, which was a warning
};

static inline glint_mesh_entry *glint_mesh_known_at(const glint_mesh_library *library, size_t i)
{
    return (glint_mesh_entry *)library->known.items + i;
}

static inline glint_mesh_entry *glint_mesh_used_at(const glint_mesh_library *library, size_t i)
{
    return (glint_mesh_entry *)library->used.items + i;
}

glint_key glint_mesh_key_of(const char *name);
/// As much of a name as an object's has room for, without half a character at its end.
void glint_mesh_copy_name(char out[GLINT_NAME_SIZE], const char *name);
/// newmtl: the number of the entry that the lines below are about. A second one of a name takes its place.
glint_status glint_mesh_library_begin(glint_mesh_library *library, const char *name, uint32_t *number,
                                      glint_error *error);
/// The words of pictures, by kind: map_Kd ...
extern const char *const glint_mesh_map_words[GLINT_MAP_COUNT];

#endif
