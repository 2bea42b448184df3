/// Shared by the readers of mesh files: a file read by lines or by bytes, growing arrays, and the data read so far.
/// Internal to scene/.
#ifndef GLINT_MESH_FILE_H
#define GLINT_MESH_FILE_H

#include <stdio.h>

#include "engine/base/hash.h"
#include "engine/glint.h"

/// An array that grows.
typedef struct glint_mesh_array {
    void *items;
    size_t count, capacity, size; ///< number of items; capacity in items; size of one item, bytes
} glint_mesh_array;

glint_status glint_mesh_append(glint_mesh_array *array, const void *item, glint_error *error);

/// A hash table that finds the items of an array by their first bytes, which must be unique.
typedef struct glint_mesh_set {
    uint32_t *slots; ///< index of the item + 1; 0: the slot is free
    size_t capacity; ///< number of slots, a power of two
} glint_mesh_set;

/// Writes the index of the item that begins with the same `key_size` bytes; appends `item` if there is none.
glint_status glint_mesh_find(glint_mesh_set *set, glint_mesh_array *array, const void *item, size_t key_size,
                             uint32_t *number, glint_error *error);

/// A file that is being read.
typedef struct glint_mesh_text {
    const char *path;
    FILE *file;
    uint64_t size; ///< bytes
    unsigned char begin[16]; ///< the first bytes of the file, `begin_bytes` of them
    size_t begin_bytes;
    long start; ///< offset where the text starts, after a byte order mark
    bool lone_returns; ///< whether lines end in CR without LF
    size_t skipped; ///< number of empty lines that were ignored after the current line
    char *line;
    size_t capacity, longest; ///< bytes of `line`: its capacity, and the limit of the capacity
    size_t number; ///< number of the current line, from 1
    glint_error *error;
} glint_mesh_text;

/// Opens a file; it must be closed even if this fails.
glint_status glint_mesh_text_open(glint_mesh_text *text, const char *path, glint_error *error);
void glint_mesh_text_close(glint_mesh_text *text);
/// Continues at byte `start` of the file.
glint_status glint_mesh_text_rewind(glint_mesh_text *text, long start);
/// Returns whether the file begins with the mark of UTF-16.
bool glint_mesh_text_is_utf16(const glint_mesh_text *text);
/// Reads the next line, without its end, which is LF, CRLF or CR. *more: there was a next line. joined: a backslash
/// at the end of a line joins it to the next one.
glint_status glint_mesh_next_line(glint_mesh_text *text, bool joined, bool *more);
/// Fails with GLINT_ERR_FORMAT and "PATH:LINE: WHAT expected, got 'GOT'".
glint_status glint_mesh_refuse(const glint_mesh_text *text, const char *expected, const char *got);
/// Reads a number as strtod does, with a decimal point. Also accepts exponents as written by Fortran (1.5D+03) and
/// NaN and infinity as written by Windows (-1.#IND). *end: the position after the number, or `at` if there is none.
double glint_mesh_read_double(const char *at, const char **end);
/// Reads a finite number at *at and moves *at past it. It ends at a blank, a comment (#) or the end of the line.
glint_status glint_mesh_number(const glint_mesh_text *text, const char **at, double *out);

static inline bool glint_is_blank(char c) { return c == ' ' || c == '\t'; }
static inline bool glint_ends_word(char c) { return !c || glint_is_blank(c); }
static inline bool glint_ends_number(char c) { return glint_ends_word(c) || c == '#'; }

static inline const char *glint_skip_blanks(const char *at)
{
    while (glint_is_blank(*at))
        at++;
    return at;
}

/// Returns whether a line begins with a keyword.
bool glint_mesh_is_word(const char *line, const char *word);

/// Returns the path of the file `name`, which may be quoted: relative to the folder of `path`, or as it is if
/// absolute. If that file does not exist, returns the path of a file in the folder of `path` with the last part of
/// `name`. NULL: out of memory; the caller frees it.
char *glint_mesh_sibling(const char *path, const char *name);

typedef struct glint_mesh_library glint_mesh_library; ///< mesh_mtl.h

/// The arrays that the indices of a corner refer to.
typedef enum glint_mesh_index_kind {
    GLINT_MESH_OF_VERTEX,
    GLINT_MESH_OF_NORMAL,
    GLINT_MESH_OF_UV,
    GLINT_MESH_OF_COUNT
} glint_mesh_index_kind;

/// Things that are skipped or replaced in a file; each kind gives one warning.
typedef enum glint_mesh_note_kind {
    GLINT_MESH_NOTE_FACE, ///< a face of fewer than 3 corners
    GLINT_MESH_NOTE_VERTEX, ///< a face with a vertex that is not finite
    GLINT_MESH_NOTE_NORMAL, ///< a normal of length 0
    GLINT_MESH_NOTE_NO_NORMALS, ///< a corner has an index of a normal, but the file has no normals
    GLINT_MESH_NOTE_NO_UV, ///< a corner has an index of texture coordinates, but the file has none
    GLINT_MESH_NOTE_FREE_FORM, ///< curves and surfaces
    GLINT_MESH_NOTE_UNKNOWN, ///< an unknown statement
    GLINT_MESH_NOTE_COLOR, ///< colours that are ignored
    GLINT_MESH_NOTE_PICTURE, ///< a picture that is ignored
    GLINT_MESH_NOTE_GROUP, ///< a smoothing group that cannot be read
    GLINT_MESH_NOTE_COUNT
} glint_mesh_note_kind;

typedef struct glint_mesh_note {
    size_t count;
    size_t line; ///< line of the first case; 0: the message already contains the position
    char first[160]; ///< message about the first case
} glint_mesh_note;

/// A mesh while its file is read.
typedef struct glint_mesh_reader {
    glint_mesh_text text;
    const glint_mesh_desc *desc;
    glint_mesh_array vertices, normals, uv, corners, corner_normals, sizes;
    glint_mesh_array corner_uv; ///< .obj: texture coordinates of each corner; empty: the same as the vertex indices,
        ///< or none
    glint_mesh_array material_index; ///< index of each face's material, if faces have materials
    glint_mesh_library *library; ///< .obj: the materials; NULL: `desc` has the materials
    glint_mesh_array colors; ///< 8-bit sRGB red, green and blue of each vertex or face; empty: none
    bool colors_of_faces; ///< whether `colors` belong to faces instead of vertices
    glint_mesh_array
        /// Red, green and blue as numbers, for vertices or faces, up to the last vertex or face that has a colour
        numbers_of_colors;
    struct {
        size_t index, line;
    } far[GLINT_MESH_OF_COUNT]; ///< .obj: the largest index that was not defined yet when a face used it, from 0, and
        ///< its line; 0: none
    glint_mesh_array materials; ///< the materials of `colors`: glint_material *, owned; empty: `desc` has the materials
    glint_mesh_set vertex_set; ///< .stl: finds vertices by their position
    bool has_normals;
    uint32_t group; ///< .obj: smoothing group of the next faces; 0: none
    glint_mesh_array groups; ///< .obj: smoothing group of each face
    glint_mesh_note notes[GLINT_MESH_NOTE_COUNT];
    glint_error *error;
} glint_mesh_reader;

/// Counts a statement that is ignored. The first message of a kind becomes its warning.
/// line  of the file, which the warning names; 0: none
void glint_mesh_note_that(glint_mesh_reader *reader, glint_mesh_note_kind kind, size_t line, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/// Gives corners whose normal has length 0 the normal of their face.
glint_status glint_mesh_drop_normals(glint_mesh_reader *reader);

/// Warns that something is ignored; the message starts with the file's name.
void glint_mesh_warn(const glint_mesh_desc *desc, const char *path, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// Reads the statement s of .obj files, after its word: a smoothing group, or off.
glint_status glint_mesh_read_group(glint_mesh_reader *reader, const char *at);
/// Adds the normals of faces in smoothing groups, after all corners have been read.
glint_status glint_mesh_smooth(glint_mesh_reader *reader);

glint_status glint_mesh_read_obj(glint_mesh_reader *reader);
glint_status glint_mesh_read_stl(glint_mesh_reader *reader);
glint_status glint_mesh_read_ply(glint_mesh_reader *reader);
/// Marks a colour that is not given.
#define GLINT_MESH_NO_COLOR (-1.0)
/// Fills `colors`, for `count` vertices or faces, from numbers_of_colors. The numbers are 8-bit values 0 .. 255 if
/// one is above 1 and all are whole, or if one is far above 1; otherwise they are 0 .. 1. Vertices and faces without
/// a colour become grey, like default materials.
glint_status glint_mesh_take_colors(glint_mesh_reader *reader, size_t count);
/// Makes the materials for a file's colours, and the material index of each face.
glint_status glint_mesh_color_faces(glint_mesh_reader *reader);
/// Makes one material from the picture that a file names; a picture that cannot be read causes a warning.
glint_status glint_mesh_picture_faces(glint_mesh_reader *reader, const char *name);

#endif
