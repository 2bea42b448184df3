/// PLY files: the contents of the header. Internal to scene/.
#ifndef GLINT_MESH_PLY_H
#define GLINT_MESH_PLY_H

#include "engine/files/mesh/file.h"

#define GLINT_PLY_ELEMENTS_MAX 32
#define GLINT_PLY_PROPERTIES_MAX 256

typedef enum glint_ply_format { GLINT_PLY_TEXT, GLINT_PLY_LITTLE, GLINT_PLY_BIG } glint_ply_format;

/// Types of numbers; each type has two names.
typedef enum glint_ply_type {
    GLINT_PLY_INT8,
    GLINT_PLY_UINT8,
    GLINT_PLY_INT16,
    GLINT_PLY_UINT16,
    GLINT_PLY_INT32,
    GLINT_PLY_UINT32,
    GLINT_PLY_FLOAT32,
    GLINT_PLY_FLOAT64,
    GLINT_PLY_TYPE_COUNT
} glint_ply_type;

/// The meaning of a property for a mesh. The first properties are numbers of a vertex; of these, a face has only the
/// colours.
typedef enum glint_ply_role {
    GLINT_PLY_X,
    GLINT_PLY_Y,
    GLINT_PLY_Z,
    GLINT_PLY_NX,
    GLINT_PLY_NY,
    GLINT_PLY_NZ,
    GLINT_PLY_U,
    GLINT_PLY_V,
    GLINT_PLY_RED,
    GLINT_PLY_GREEN,
    GLINT_PLY_BLUE,
    GLINT_PLY_NUMBERS, ///< number of the properties above
    GLINT_PLY_VERTEX_NUMBERS = GLINT_PLY_NUMBERS,
    GLINT_PLY_STRIP, ///< vertices of triangle strips, with -1 between strips
    GLINT_PLY_WEDGE, ///< texture coordinates of a face's corners, u and v each
    GLINT_PLY_PASSED_OVER
} glint_ply_role;

typedef struct glint_ply_property {
    glint_ply_type type, count_type; ///< type of the property; count_type: type of the length of a list
    bool is_list;
    glint_ply_role role;
} glint_ply_property;

typedef struct glint_ply_element {
    char name[32];
    uint64_t count;
    uint32_t property_count;
    glint_ply_property properties[GLINT_PLY_PROPERTIES_MAX];
} glint_ply_element;

typedef struct glint_ply_head {
    glint_ply_format format;
    uint32_t element_count;
    uint64_t vertex_count, face_count; ///< number of vertices; face_count: number of rows in all elements that have
        ///< faces or strips
    char texture[512]; ///< the picture that the file names; "": none
    const glint_ply_element *colored; ///< the element that gives the colours; NULL: there are none
    glint_ply_type color_type; ///< type of the numbers of these colours
    glint_ply_element elements[GLINT_PLY_ELEMENTS_MAX];
} glint_ply_head;

extern const unsigned char glint_ply_sizes[GLINT_PLY_TYPE_COUNT]; ///< bytes

bool glint_ply_has_role(const glint_ply_element *e, glint_ply_role role);
/// Reads the header of a file, including its end_header.
glint_status glint_ply_read_head(glint_mesh_reader *reader, glint_ply_head *head);

#endif
