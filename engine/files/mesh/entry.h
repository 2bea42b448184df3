/// The materials of .obj files while they are read. Internal to scene/.
#ifndef GLINT_MESH_ENTRY_H
#define GLINT_MESH_ENTRY_H

#include "engine/files/mesh/mtl.h"
#include "engine/glint_programs.h"

#define GLINT_MESH_NO_FACE 0xffffffffu

/// Pictures that a material may have.
typedef enum glint_mesh_map_kind {
    GLINT_MAP_KD,
    GLINT_MAP_KS,
    GLINT_MAP_D,
    GLINT_MAP_BUMP,
    GLINT_MAP_COUNT
} glint_mesh_map_kind;

/// A material as a file describes it. A glint_mesh_set finds entries by their key.
typedef struct glint_mesh_entry {
    glint_key key; ///< hash of the name; 0: the material of the faces before the first usemtl
    glint_material_desc desc;
    double clear; ///< transparency: 1 - d
    bool has_d; ///< d was given, so Tr is ignored
    double
        illum; ///< 0 or 1: no highlight; 3 .. 7: mirror of Ks; 5 and 7: with Fresnel; 6 and 7: with refraction
    double ni; ///< index of refraction; 0: none
    double rough, metal; ///< roughness Pr and metallic share Pm; below 0: not given
    bool lacks_uv; ///< whether one of its faces has a corner without texture coordinates
    char *map[GLINT_MAP_COUNT]; ///< paths of pictures; NULL: none
    glint_mesh_map mapping[GLINT_MAP_COUNT]; ///< mapping of each picture
    double height; ///< -bm of the bump map, world units; 0: none, or not usable
    char bm[GLINT_NAME_SIZE]; ///< the file's text for -bm; "": none
} glint_mesh_entry;

typedef struct glint_mesh_picture {
    glint_key key; ///< hash of the picture's path, of `clamp`, and of whether its pixel values are linear
    glint_texture *texture; ///< NULL: the picture cannot be read
} glint_mesh_picture;

struct glint_mesh_library {
    glint_mesh_array known, used, pictures; ///< materials that the files define; materials that faces use; pictures
        ///< of both
    glint_mesh_set known_set, used_set, picture_set;
    glint_mesh_array materials; ///< glint_material *, one for each of `used`
    glint_mesh_entry current; ///< key and name of the material for the next faces
    uint32_t current_number; ///< index of `current` in `used`; GLINT_MESH_NO_FACE: no face has this material yet
    char *file; ///< the first file named; NULL: none
    bool is_used; ///< whether a face uses a material that a file defines
    size_t missing; ///< number of materials that faces use and no file defines
    char first_missing[GLINT_NAME_SIZE];
    size_t flat; ///< number of materials whose bump map has no height
    glint_mesh_entry first_flat; ///< the first material whose bump map has no height; it does not own its pictures
    size_t invisible; ///< number of materials that transmit all light
    char first_invisible[GLINT_NAME_SIZE];
    size_t bright; ///< number of colours above 1
    char first_bright[GLINT_NAME_SIZE + 80]; ///< the first one: "'paint' has Kd 255 0 0"
    bool reported; ///< whether a warning has already reported a file that could not be read
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
/// Copies as much of a name as fits into an object's name, without cutting a character in half.
void glint_mesh_copy_name(char out[GLINT_NAME_SIZE], const char *name);
/// Handles newmtl: writes the index of the entry that the next lines describe. A second material of the same name
/// replaces the first.
glint_status glint_mesh_library_begin(glint_mesh_library *library, const char *name, uint32_t *number,
                                      glint_error *error);
/// The keywords of pictures, by kind: map_Kd and so on.
extern const char *const glint_mesh_map_words[GLINT_MAP_COUNT];

#endif
