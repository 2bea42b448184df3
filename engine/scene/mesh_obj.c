/// Wavefront .obj files, a line at a time: nothing but the vertices, normals, coordinates and faces read so far is kept.
#include "engine/base/open.h"
#include "engine/base/status.h"
#include "engine/scene/objects.h"

#include <errno.h>
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define LINE_MAX_BYTES ((size_t)1 << 20)

/// An array that grows.
typedef struct array {
    void *items;
    size_t count, room, size; ///< `size` of one item, bytes
} array;

typedef struct reader {
    const char *path;
    FILE *file;
    locale_t c_locale; ///< decimal points whatever the script's locale
    char *line;
    size_t line_room, number; ///< number: of the line at hand, from 1
    array vertices, normals, uv, corners, corner_normals, sizes;
    array corner_uv; ///< of the corners up to the last that named one
    bool has_normals; ///< a face named one
    glint_error *error;
} reader;

static glint_status append(reader *r, array *a, const void *item)
{
    if (a->count == a->room) {
        const size_t room = a->room ? 2 * a->room : 1024;
        void *items = room > SIZE_MAX / a->size ? NULL : realloc(a->items, room * a->size);
        if (!items)
            return glint_fail_nomem(r->error);
        a->items = items;
        a->room = room;
    }
    memcpy((char *)a->items + a->count * a->size, item, a->size);
    a->count++;
    return GLINT_OK;
}

static glint_status complain(const reader *r, const char *expected, const char *got)
{
    char shown[48];
    snprintf(shown, sizeof shown, "%.40s", got);
    for (char *c = shown; *c; c++)
        *c = (unsigned char)*c < ' ' || *c == 127 ? ' ' : *c;
    return glint_fail(r->error, GLINT_ERR_FORMAT, "%s: line %zu: %s expected, got '%s'", r->path, r->number, expected,
                      shown);
}

// ---- Lines ----

static glint_status grow_line(reader *r, size_t used)
{
    if (used + 2 < r->line_room)
        return GLINT_OK;
    if (r->line_room >= LINE_MAX_BYTES)
        return glint_fail(r->error, GLINT_ERR_FORMAT, "%s: line %zu: at most %zu bytes expected", r->path, r->number,
                          LINE_MAX_BYTES);
    char *line = realloc(r->line, r->line_room * 2);
    if (!line)
        return glint_fail_nomem(r->error);
    r->line = line;
    r->line_room *= 2;
    return GLINT_OK;
}

/// The next line, without its end; a backslash at the end joins the following one. *more: there was one.
static glint_status next_line(reader *r, bool *more)
{
    size_t used = 0;
    int c = 0;
    r->number++;
    *more = false;
    while ((c = getc_unlocked(r->file)) != EOF) {
        *more = true;
        if (c == '\n' && used > 0 && r->line[used - 1] == '\\') {
            r->line[used - 1] = ' ';
            continue;
        }
        if (c == '\n')
            break;
        if (c == '\r')
            continue;
        glint_status status = grow_line(r, used);
        if (status)
            return status;
        r->line[used++] = c ? (char)c : '?';
    }
    r->line[used] = 0;
    if (ferror(r->file))
        return glint_fail(r->error, GLINT_ERR_IO, "%s: %s", r->path, strerror(errno));
    return GLINT_OK;
}

static bool is_blank(char c) { return c == ' ' || c == '\t'; }

static const char *skip_blanks(const char *at)
{
    while (is_blank(*at))
        at++;
    return at;
}

static bool ends_word(char c) { return !c || is_blank(c); }

// ---- What a line says ----

/// Notes that the corner at hand has the coordinates `uv`; GLINT_NO_UV: that all before it have what they have.
static glint_status append_uv(reader *r, uint32_t uv)
{
    const uint32_t none = GLINT_NO_UV;
    glint_status status = GLINT_OK;
    while (r->corner_uv.count < r->corners.count && !status)
        status = append(r, &r->corner_uv, &none);
    return status || uv == GLINT_NO_UV ? status : append(r, &r->corner_uv, &uv);
}

/// Three numbers, of coordinates two, of which the second may be missing; one more, the weight or a colour after them, is
/// passed over.
static glint_status read_numbers(reader *r, const char *at, int count, array *into)
{
    double v[3] = { 0 };
    for (int i = 0; i < count; i++) {
        char *end;
        at = skip_blanks(at);
        if (count == 2 && i == 1 && (!*at || *at == '#'))
            break;
        v[i] = strtod_l(at, &end, r->c_locale);
        if (end == at || !ends_word(*end))
            return complain(r, "a number", at);
        if (!isfinite(v[i]))
            return complain(r, "a finite number", at);
        at = end;
    }
    return append(r, into, v);
}

/// A number of a vertex, normal or pair of coordinates, from 1, or from the end where negative; 0-based in *out.
static glint_status read_index(reader *r, const char **at, size_t count, const char *what, uint32_t *out)
{
    char *end, expected[96];
    errno = 0;
    const long long value = strtoll(*at, &end, 10);
    const long long index = value < 0 ? (long long)count + value : value - 1;
    snprintf(expected, sizeof expected, "the number of a %s, 1 .. %zu,", what, count);
    if (end == *at || errno || value == 0 || index < 0 || index >= (long long)count || index >= INT32_MAX)
        return complain(r, expected, *at);
    *at = end;
    *out = (uint32_t)index;
    return GLINT_OK;
}

/// vt of a corner; where the file has none so far, its form alone is checked.
static glint_status read_uv_number(reader *r, const char **at, const char *start)
{
    uint32_t uv;
    char *end;
    strtoll(*at, &end, 10);
    if (end == *at)
        return complain(r, "v, v/vt, v//vn or v/vt/vn", start);
    if (r->uv.count == 0) {
        *at = end;
        return GLINT_OK;
    }
    glint_status status = read_index(r, at, r->uv.count, "texture coordinate", &uv);
    return status ? status : append_uv(r, uv);
}

/// v, v/vt, v//vn or v/vt/vn.
static glint_status read_corner(reader *r, const char **at)
{
    uint32_t vertex, normal = GLINT_NO_NORMAL;
    const char *start = *at;
    glint_status status = read_index(r, at, r->vertices.count, "vertex", &vertex);
    if (!status && **at == '/') {
        ++*at;
        if (**at != '/')
            status = read_uv_number(r, at, start);
        if (!status && **at == '/') {
            ++*at;
            status = read_index(r, at, r->normals.count, "normal", &normal);
            r->has_normals = true;
        }
    }
    if (!status && !ends_word(**at))
        return complain(r, "v, v/vt, v//vn or v/vt/vn", start);
    if (!status)
        status = append(r, &r->corners, &vertex);
    return status ? status : append(r, &r->corner_normals, &normal);
}

static glint_status read_face(reader *r, const char *at)
{
    const char *start = at;
    uint32_t size = 0;
    for (at = skip_blanks(at); *at && *at != '#'; at = skip_blanks(at), size++) {
        glint_status status = read_corner(r, &at);
        if (status)
            return status;
    }
    if (size < 3)
        return complain(r, "3 corners or more", start);
    return append(r, &r->sizes, &size);
}

static bool is_word(const char *line, const char *word)
{
    const size_t length = strlen(word);
    return strncmp(line, word, length) == 0 && ends_word(line[length]);
}

static glint_status read_statement(reader *r)
{
    static const char *const passed_over[] = { "vp",     "g",        "o",        "s",          "usemtl",    "mtllib",
                                               "l",      "p",        "bevel",    "lod",        "mg",        "c_interp",
                                               "d_interp", "shadow_obj", "trace_obj", "usemap", "maplib", NULL };
    const char *at = skip_blanks(r->line);
    if (!*at || *at == '#')
        return GLINT_OK;
    if (is_word(at, "v"))
        return read_numbers(r, at + 1, 3, &r->vertices);
    if (is_word(at, "vn"))
        return read_numbers(r, at + 2, 3, &r->normals);
    if (is_word(at, "vt"))
        return read_numbers(r, at + 2, 2, &r->uv);
    if (is_word(at, "f") || is_word(at, "fo"))
        return read_face(r, at + (at[1] == 'o' ? 2 : 1));
    for (int i = 0; passed_over[i]; i++)
        if (is_word(at, passed_over[i]))
            return GLINT_OK;
    return complain(r, "v, vn, vt, f, g, o, s, usemtl, mtllib, l, p or #", at);
}

// ---- The file ----

static glint_status read_lines(reader *r)
{
    bool more = true;
    while (more) {
        glint_status status = next_line(r, &more);
        if (!status && more)
            status = read_statement(r);
        if (status)
            return status;
    }
    if (r->sizes.count == 0)
        return glint_fail(r->error, GLINT_ERR_FORMAT, "%s: faces expected, got %zu vertices and none", r->path,
                          r->vertices.count);
    return GLINT_OK;
}

static glint_status make_mesh(reader *r, const glint_mesh_desc *desc, glint_shape **out)
{
    glint_mesh_desc mesh = *desc;
    glint_error inner;
    mesh.vertices = r->vertices.items;
    mesh.vertex_count = r->vertices.count;
    mesh.corners = r->corners.items;
    mesh.face_sizes = r->sizes.items;
    mesh.face_count = r->sizes.count;
    mesh.normals = r->has_normals ? r->normals.items : NULL;
    mesh.normal_count = r->has_normals ? r->normals.count : 0;
    mesh.normal_corners = r->has_normals ? r->corner_normals.items : NULL;
    glint_status status = r->corner_uv.count ? append_uv(r, GLINT_NO_UV) : GLINT_OK;
    if (status)
        return status;
    mesh.uv = r->corner_uv.count ? r->uv.items : NULL;
    mesh.uv_count = r->corner_uv.count ? r->uv.count : 0;
    mesh.uv_corners = r->corner_uv.items;
    status = glint_mesh_create(&mesh, out, &inner);
    if (status)
        glint_fail(r->error, status, "%s: %s", r->path, inner.message);
    return status;
}

static glint_status open_stream(reader *r)
{
    int file;
    uint64_t size;
    glint_status status = glint_open_file(r->path, &file, &size, r->error);
    if (status)
        return status;
    r->file = fdopen(file, "rb");
    if (r->file)
        return GLINT_OK;
    close(file);
    return glint_fail_nomem(r->error);
}

glint_status glint_mesh_load(const char *path, const glint_mesh_desc *desc, glint_shape **out, glint_error *error)
{
    reader r = { .path = path, .line_room = 4096, .error = error };
    r.vertices.size = r.normals.size = 3 * sizeof(double);
    r.uv.size = 2 * sizeof(double);
    r.corners.size = r.corner_normals.size = r.corner_uv.size = r.sizes.size = sizeof(uint32_t);
    glint_status status = desc->has_shading ? glint_check_shading(desc->shading, error) : GLINT_OK;
    if (!status)
        status = open_stream(&r);
    if (status)
        return status;
    r.line = malloc(r.line_room);
    r.c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    status = r.line && r.c_locale ? read_lines(&r) : glint_fail_nomem(error);
    fclose(r.file);
    if (!status)
        status = make_mesh(&r, desc, out);
    if (r.c_locale)
        freelocale(r.c_locale);
    free(r.line);
    free(r.vertices.items);
    free(r.normals.items);
    free(r.corners.items);
    free(r.corner_normals.items);
    free(r.uv.items);
    free(r.corner_uv.items);
    free(r.sizes.items);
    return status;
}
