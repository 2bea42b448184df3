/// Wavefront .obj files, a line at a time: nothing but the vertices, normals, coordinates and faces read so far is kept.
#include "engine/base/status.h"
#include "engine/scene/mesh_mtl.h"
#include "engine/scene/objects.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

typedef glint_mesh_reader reader;

static glint_status append(reader *r, glint_mesh_array *array, const void *item)
{
    return glint_mesh_append(array, item, r->error);
}

static glint_status complain(const reader *r, const char *expected, const char *got)
{
    return glint_mesh_refuse(&r->text, expected, got);
}

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
static glint_status read_numbers(reader *r, const char *at, int count, glint_mesh_array *into)
{
    double v[3] = { 0 };
    for (int i = 0; i < count; i++) {
        at = glint_skip_blanks(at);
        if (count == 2 && i == 1 && (!*at || *at == '#'))
            break;
        glint_status status = glint_mesh_number(&r->text, &at, &v[i]);
        if (status)
            return status;
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
    if (end != *at && !errno && value != 0 && index >= 0 && index < (long long)count && index < INT32_MAX) {
        *at = end;
        *out = (uint32_t)index;
        return GLINT_OK;
    }
    snprintf(expected, sizeof expected, "the number of a %s, 1 .. %zu,", what, count);
    return complain(r, expected, *at);
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
    if (!status && !glint_ends_word(**at))
        return complain(r, "v, v/vt, v//vn or v/vt/vn", start);
    if (!status)
        status = append(r, &r->corners, &vertex);
    return status ? status : append(r, &r->corner_normals, &normal);
}

static glint_status read_face(reader *r, const char *at)
{
    const char *start = at;
    uint32_t size = 0, material;
    for (at = glint_skip_blanks(at); *at && *at != '#'; at = glint_skip_blanks(at), size++) {
        glint_status status = read_corner(r, &at);
        if (status)
            return status;
    }
    if (size < 3)
        return complain(r, "3 corners or more", start);
    glint_status status = append(r, &r->sizes, &size);
    if (!status && r->library)
        status = glint_mesh_library_face(r->library, &material, r->error);
    return status || !r->library ? status : append(r, &r->material_index, &material);
}

/// The rest of a line, without blanks around it.
static const char *rest_of(char *at)
{
    size_t length;
    while (glint_is_blank(*at))
        at++;
    for (length = strlen(at); length > 0 && glint_is_blank(at[length - 1]); length--)
        ;
    at[length] = 0;
    return at;
}

/// Statements about materials; *known: it was one.
static glint_status read_material(reader *r, char *at, bool *known)
{
    const bool uses = glint_mesh_is_word(at, "usemtl");
    *known = uses || glint_mesh_is_word(at, "mtllib");
    if (!*known || !r->library)
        return GLINT_OK;
    const char *names = rest_of(at + 6);
    if (!uses)
        return glint_mesh_library_read(r->library, r, names);
    glint_mesh_library_use(r->library, names);
    return GLINT_OK;
}

static glint_status read_statement(reader *r)
{
    static const char *const passed_over[] = { "vp",       "g",          "o",         "s",      "l",      "p",
                                               "bevel",    "lod",        "mg",        "usemap", "maplib", "c_interp",
                                               "d_interp", "shadow_obj", "trace_obj", NULL };
    bool known;
    char *at = r->text.line;
    while (glint_is_blank(*at))
        at++;
    if (!*at || *at == '#')
        return GLINT_OK;
    if (glint_mesh_is_word(at, "v"))
        return read_numbers(r, at + 1, 3, &r->vertices);
    if (glint_mesh_is_word(at, "vn"))
        return read_numbers(r, at + 2, 3, &r->normals);
    if (glint_mesh_is_word(at, "vt"))
        return read_numbers(r, at + 2, 2, &r->uv);
    if (glint_mesh_is_word(at, "f") || glint_mesh_is_word(at, "fo"))
        return read_face(r, at + (at[1] == 'o' ? 2 : 1));
    for (int i = 0; passed_over[i]; i++)
        if (glint_mesh_is_word(at, passed_over[i]))
            return GLINT_OK;
    glint_status status = read_material(r, at, &known);
    return known ? status : complain(r, "v, vn, vt, f, g, o, s, usemtl, mtllib, l, p or #", at);
}

// ---- The file ----

glint_status glint_mesh_read_obj(reader *r)
{
    bool more = true;
    glint_status status = GLINT_OK;
    if (!r->desc->material && !r->desc->material_count) {
        r->library = glint_mesh_library_create();
        status = r->library ? GLINT_OK : glint_fail_nomem(r->error);
    }
    while (more && !status) {
        status = glint_mesh_next_line(&r->text, true, &more);
        if (!status && more)
            status = read_statement(r);
    }
    if (!status && r->sizes.count == 0)
        status = glint_fail(r->error, GLINT_ERR_FORMAT, "%s: faces expected, got %zu vertices and none", r->text.path,
                            r->vertices.count);
    if (!status && r->corner_uv.count)
        status = append_uv(r, GLINT_NO_UV);
    if (!status && !r->corner_uv.count)
        r->uv.count = 0; // no face names them
    return !status && r->library ? glint_mesh_library_make(r->library, r) : status;
}
