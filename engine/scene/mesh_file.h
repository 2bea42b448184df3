/// What the readers of mesh files share: a file read by lines or by bytes, arrays that grow, and what is read so far.
/// Internal to scene/.
#ifndef GLINT_MESH_FILE_H
#define GLINT_MESH_FILE_H

#include <stdio.h>

#include "engine/base/hash.h"
#include "engine/base/number.h"
#include "engine/glint.h"

/// An array that grows.
typedef struct glint_mesh_array {
    void *items;
    size_t count, room, size; ///< `size` of one item, bytes
} glint_mesh_array;

glint_status glint_mesh_append(glint_mesh_array *array, const void *item, glint_error *error);

/// Finds items of an array by their first bytes, which no two of them share.
typedef struct glint_mesh_set {
    uint32_t *slots; ///< numbers of items from 1; 0: free
    size_t room; ///< a power of two
} glint_mesh_set;

/// The number of the item that begins with the same `key_size` bytes; `item` is appended where there is none.
glint_status glint_mesh_find(glint_mesh_set *set, glint_mesh_array *array, const void *item, size_t key_size,
                             uint32_t *number, glint_error *error);

/// A file that is being read.
typedef struct glint_mesh_text {
    const char *path;
    FILE *file;
    uint64_t size; ///< bytes
    locale_t c_locale; ///< decimal points whatever the script's locale
    char *line;
    size_t room, number; ///< number: of the line at hand, from 1
    glint_error *error;
} glint_mesh_text;

/// Opens a file; to be closed whatever it returns.
glint_status glint_mesh_text_open(glint_mesh_text *text, const char *path, glint_error *error);
void glint_mesh_text_close(glint_mesh_text *text);
/// The next line, without its end. *more: there was one. joined: a backslash at the end joins the following one.
glint_status glint_mesh_next_line(glint_mesh_text *text, bool joined, bool *more);
/// GLINT_ERR_FORMAT: "PATH: line N: WHAT expected, got 'GOT'".
glint_status glint_mesh_refuse(const glint_mesh_text *text, const char *expected, const char *got);
/// A finite number at *at, which moves behind it; ended by a blank or the line's end.
glint_status glint_mesh_number(const glint_mesh_text *text, const char **at, double *out);

static inline bool glint_is_blank(char c) { return c == ' ' || c == '\t'; }
static inline bool glint_ends_word(char c) { return !c || glint_is_blank(c); }

static inline const char *glint_skip_blanks(const char *at)
{
    while (glint_is_blank(*at))
        at++;
    return at;
}

/// Whether a line begins with a word.
bool glint_mesh_is_word(const char *line, const char *word);

/// The file named `name` in the folder of `path`, or `name` where it begins at the root. NULL: out of memory; free() frees it.
char *glint_mesh_beside(const char *path, const char *name);

typedef struct glint_mesh_library glint_mesh_library; ///< mesh_mtl.h

/// A mesh while its file is read.
typedef struct glint_mesh_reader {
    glint_mesh_text text;
    const glint_mesh_desc *desc;
    glint_mesh_array vertices, normals, uv, corners, corner_normals, sizes;
    glint_mesh_array corner_uv; ///< of the corners up to the last that named one
    glint_mesh_array material_index; ///< of each face, where faces have materials of their own
    glint_mesh_library *library; ///< .obj: the materials; NULL: those of `desc`
    glint_mesh_array colors; ///< .ply: sRGB codes of red, green and blue, of each vertex or face; none: there are none
    bool colors_of_faces; ///< not of vertices
    glint_mesh_array materials; ///< .ply: glint_material *, owned; none: those of `desc`
    glint_mesh_set places; ///< .stl: of the vertices
    bool has_normals;
    glint_error *error;
} glint_mesh_reader;

/// Says that something is passed over; the file's name stands before the message.
void glint_mesh_warn(const glint_mesh_desc *desc, const char *path, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

glint_status glint_mesh_read_obj(glint_mesh_reader *reader);
glint_status glint_mesh_read_stl(glint_mesh_reader *reader);
glint_status glint_mesh_read_ply(glint_mesh_reader *reader);
/// Makes the materials, and the index of each face among them, of the colours of a file that is read.
glint_status glint_mesh_color_faces(glint_mesh_reader *reader);

/// glint_mesh_create; flat: NULL, or faces without an area are no error but left out, and counted here.
glint_status glint_mesh_make(const glint_mesh_desc *desc, size_t *flat, glint_shape **out, glint_error *error);

#endif
