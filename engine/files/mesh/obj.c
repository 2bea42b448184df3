/// Reads Wavefront .obj files line by line. Only the vertices, normals, coordinates and faces read so far are in
/// memory.
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/files/mesh/mtl.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef glint_mesh_reader reader;
typedef glint_mesh_index_kind index_kind;

static const char *const KINDS[] = { "vertex", "normal", "texture coordinate" };

static glint_status append(reader *r, glint_mesh_array *array, const void *item)
{
    return glint_mesh_append(array, item, r->error);
}

static glint_status complain(const reader *r, const char *expected, const char *got)
{
    return glint_mesh_refuse(&r->text, expected, got);
}

// ---- The contents of a line ----

/// Reads three numbers, or two texture coordinates, the second of which is optional. Non-finite numbers are stored
/// unchanged.
static glint_status read_numbers(reader *r, const char **at, int count, double v[3])
{
    for (int i = 0; i < count; i++) {
        const char *end;
        *at = glint_skip_blanks(*at);
        if (count == 2 && i == 1 && (!**at || **at == '#'))
            break;
        v[i] = glint_mesh_read_double(*at, &end);
        if (end == *at || !glint_ends_number(*end))
            return complain(r, "a number", *at);
        *at = end;
    }
    return GLINT_OK;
}

/// Notes that the numbers after a vertex's coordinates are not colours, for this and all other vertices.
static void refuse_colors(reader *r)
{
    glint_mesh_note_that(r, GLINT_MESH_NOTE_COLOR, r->text.number,
                         "the numbers after the coordinates are ignored: colours 0 .. 1 or 0 .. 255 expected");
}

/// Reads the numbers after a vertex. Three are its colour, as many programs write it; a fourth is alpha. A single one
/// is its weight.
static glint_status read_color(reader *r, const char *at)
{
    static const double grey[3] = { GLINT_MESH_NO_COLOR, GLINT_MESH_NO_COLOR, GLINT_MESH_NO_COLOR };
    double v[3];
    bool good = true;
    glint_status status = GLINT_OK;
    for (int i = 0; i < 3; i++) {
        const char *end;
        at = glint_skip_blanks(at);
        v[i] = glint_mesh_read_double(at, &end);
        if (end == at || !glint_ends_number(*end))
            return GLINT_OK;
        good = good && v[i] >= 0 && v[i] <= 255;
        at = end;
    }
    if (!good)
        refuse_colors(r);
    while (r->numbers_of_colors.count + 1 < r->vertices.count && !status)
        status = append(r, &r->numbers_of_colors, grey);
    return status ? status : append(r, &r->numbers_of_colors, v);
}

/// Reads ZBrush's comment "#MRGB ": mask, red, green and blue of the next vertices, two hexadecimal digits each.
static glint_status read_zbrush(reader *r, const char *at)
{
    glint_status status = GLINT_OK;
    unsigned codes[4];
    for (at = glint_skip_blanks(at);
         sscanf(at, "%2x%2x%2x%2x", &codes[0], &codes[1], &codes[2], &codes[3]) == 4 && !status; at += 8) {
        const double v[3] = { codes[1] / 255.0, codes[2] / 255.0, codes[3] / 255.0 };
        status = append(r, &r->numbers_of_colors, v);
    }
    return status;
}

static glint_status read_vertex(reader *r, const char *at)
{
    double v[3];
    glint_status status = read_numbers(r, &at, 3, v);
    if (!status)
        status = append(r, &r->vertices, v);
    return status ? status : read_color(r, at);
}

static glint_status read_normal(reader *r, const char *at)
{
    double v[3];
    glint_status status = read_numbers(r, &at, 3, v);
    if (status)
        return status;
    if (!isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2]) || vec_max_abs(v) == 0) {
        v[0] = v[1] = v[2] = 0;
        glint_mesh_note_that(r, GLINT_MESH_NOTE_NORMAL, r->text.number, "a normal of length 0 is ignored");
    }
    return append(r, &r->normals, v);
}

static glint_status read_pair(reader *r, const char *at)
{
    double v[3] = { 0 };
    glint_status status = read_numbers(r, &at, 2, v);
    for (int i = 0; i < 2; i++)
        v[i] = isfinite(v[i]) ? v[i] : 0;
    return status ? status : append(r, &r->uv, v);
}

/// Reads the index of a vertex, normal or pair of coordinates, from 1, or from the end if negative; *out counts from
/// 0. It may refer to an item that follows later: the largest index is checked at the end.
static glint_status read_index(reader *r, const char **at, size_t count, index_kind kind, uint32_t *out)
{
    char *end, expected[96];
    errno = 0;
    const long long value = strtoll(*at, &end, 10);
    const long long index = value < 0 ? (long long)count + value : value - 1;
    if (end != *at && !errno && value == 0 && kind != GLINT_MESH_OF_VERTEX) {
        *at = end;
        *out = GLINT_NO_NORMAL; // the same value as GLINT_NO_UV
        return GLINT_OK;
    }
    if (end == *at || errno || value == 0 || index < 0 || index >= INT32_MAX) {
        snprintf(expected, sizeof expected, "a %s number 1 .. %zu", KINDS[kind], count);
        return complain(r, expected, *at);
    }
    *at = end;
    *out = (uint32_t)index;
    if ((size_t)index >= count && (!r->far[kind].line || (size_t)index > r->far[kind].index)) {
        r->far[kind].index = (size_t)index;
        r->far[kind].line = r->text.number;
    }
    return GLINT_OK;
}

/// Reads another index of a corner, after a slash, if there is one.
static glint_status read_part(reader *r, const char **at, size_t count, index_kind kind, uint32_t *out)
{
    ++*at;
    const bool is_number = (**at >= '0' && **at <= '9') || **at == '-' || **at == '+';
    return is_number ? read_index(r, at, count, kind, out) : GLINT_OK;
}

/// Reads a corner: v, v/vt, v//vn or v/vt/vn.
static glint_status read_corner(reader *r, const char **at)
{
    uint32_t vertex, normal = GLINT_NO_NORMAL, uv = GLINT_NO_UV;
    const char *start = *at;
    glint_status status = read_index(r, at, r->vertices.count, GLINT_MESH_OF_VERTEX, &vertex);
    if (!status && **at == '/')
        status = read_part(r, at, r->uv.count, GLINT_MESH_OF_UV, &uv);
    if (!status && **at == '/')
        status = read_part(r, at, r->normals.count, GLINT_MESH_OF_NORMAL, &normal);
    if (!status && !glint_ends_number(**at))
        return complain(r, "v, v/vt, v//vn or v/vt/vn", start);
    if (!status)
        status = append(r, &r->corners, &vertex);
    if (!status)
        status = append(r, &r->corner_normals, &normal);
    return status ? status : append(r, &r->corner_uv, &uv);
}

static glint_status read_face(reader *r, const char *at)
{
    uint32_t size = 0, material;
    for (at = glint_skip_blanks(at); *at && *at != '#'; at = glint_skip_blanks(at), size++) {
        glint_status status = read_corner(r, &at);
        if (status)
            return status;
    }
    if (size < 3) {
        r->corners.count -= size;
        r->corner_normals.count -= size;
        r->corner_uv.count -= size;
        glint_mesh_note_that(r, GLINT_MESH_NOTE_FACE, r->text.number, "a face of fewer than 3 corners is left out");
        return GLINT_OK;
    }
    glint_status status = append(r, &r->sizes, &size);
    if (!status)
        status = append(r, &r->groups, &r->group);
    if (!status && r->library)
        status = glint_mesh_library_face(r->library, &material, r->error);
    return status || !r->library ? status : append(r, &r->material_index, &material);
}

/// Returns the rest of a line, without blanks around it.
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

/// Reads a statement about materials. *known: it is such a statement.
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

static bool is_among(const char *line, const char *const *words)
{
    while (*words && !glint_mesh_is_word(line, *words))
        words++;
    return *words != NULL;
}

/// Skips a statement that does not concern meshes.
static void pass_over(reader *r, const char *at)
{
    static const char *const silent[] = { "vp",         "g",         "o",      "l",        "p",
                                          "bevel",      "lod",       "mg",     "usemap", "c_interp", "d_interp",
                                          "shadow_obj", "trace_obj", "maplib", NULL };
    static const char *const free_form[] = { "cstype", "deg",  "bmat", "step", "curv", "curv2", "surf",  "parm",
                                             "trim",   "hole", "scrv", "sp",   "end",  "con",   "ctech", "stech",
                                             "bsp",    "bzp",  "cdc",  "cdp",  "res",  NULL };
    if (is_among(at, silent))
        return;
    const bool is_curve = is_among(at, free_form);
    const int length = (int)strcspn(at, " \t");
    glint_mesh_note_that(r, is_curve ? GLINT_MESH_NOTE_FREE_FORM : GLINT_MESH_NOTE_UNKNOWN, r->text.number,
                         is_curve ? "'%.*s' is ignored: free-form curves and surfaces are not read"
                                  : "'%.*s' is ignored: not a statement of .obj files",
                         length < 24 ? length : 24, at);
}

static glint_status read_statement(reader *r)
{
    bool known;
    char *at = r->text.line;
    while (glint_is_blank(*at))
        at++;
    if (strncmp(at, "#MRGB ", 6) == 0)
        return read_zbrush(r, at + 6);
    if (!*at || *at == '#')
        return GLINT_OK;
    if (glint_mesh_is_word(at, "v"))
        return read_vertex(r, at + 1);
    if (glint_mesh_is_word(at, "vn"))
        return read_normal(r, at + 2);
    if (glint_mesh_is_word(at, "vt"))
        return read_pair(r, at + 2);
    if (glint_mesh_is_word(at, "f") || glint_mesh_is_word(at, "fo"))
        return read_face(r, at + (at[1] == 'o' ? 2 : 1));
    if (glint_mesh_is_word(at, "s"))
        return glint_mesh_read_group(r, at + 1);
    glint_status status = read_material(r, at, &known);
    if (!known)
        pass_over(r, at);
    return status;
}

// ---- The file ----

/// Checks that all indices of one kind exist in the file. If it has no normals or texture coordinates, their indices
/// are ignored.
static glint_status check_far(reader *r, index_kind kind, size_t count)
{
    char expected[96], got[32];
    if (!r->far[kind].line || r->far[kind].index < count)
        return GLINT_OK;
    if (count == 0 && kind != GLINT_MESH_OF_VERTEX) {
        glint_mesh_note_that(r, kind == GLINT_MESH_OF_UV ? GLINT_MESH_NOTE_NO_UV : GLINT_MESH_NOTE_NO_NORMALS,
                             r->far[kind].line, "%s %zu is ignored: the file has none", KINDS[kind],
                             r->far[kind].index + 1);
        return GLINT_OK;
    }
    snprintf(expected, sizeof expected, "a %s number 1 .. %zu", KINDS[kind], count);
    snprintf(got, sizeof got, "%zu", r->far[kind].index + 1);
    r->text.number = r->far[kind].line;
    return complain(r, expected, got);
}

static bool names_any(const glint_mesh_array *numbers)
{
    for (size_t i = 0; i < numbers->count; i++)
        if (((const uint32_t *)numbers->items)[i] != GLINT_NO_UV)
            return true;
    return false;
}

/// Checks the indices of corners after the whole file has been read.
static glint_status check_corners(reader *r)
{
    glint_status status = check_far(r, GLINT_MESH_OF_VERTEX, r->vertices.count);
    if (!status)
        status = check_far(r, GLINT_MESH_OF_NORMAL, r->normals.count);
    if (!status)
        status = check_far(r, GLINT_MESH_OF_UV, r->uv.count);
    r->has_normals = r->normals.count && names_any(&r->corner_normals);
    if (!r->uv.count || !names_any(&r->corner_uv))
        r->uv.count = r->corner_uv.count = 0;
    if (!status && r->has_normals && r->notes[GLINT_MESH_NOTE_NORMAL].count)
        status = glint_mesh_drop_normals(r);
    return status ? status : glint_mesh_smooth(r);
}

/// Gives faces the colours of their vertices, unless they have materials.
static glint_status color(reader *r)
{
    if (!r->numbers_of_colors.count || r->notes[GLINT_MESH_NOTE_COLOR].count || r->desc->material ||
        r->desc->material_count)
        return GLINT_OK;
    if (r->library && glint_mesh_library_is_used(r->library)) {
        glint_mesh_note_that(r, GLINT_MESH_NOTE_COLOR, 0,
                             "the colours of its vertices are ignored: its faces have materials");
        return GLINT_OK;
    }
    glint_mesh_library_free(r->library);
    r->library = NULL;
    r->material_index.count = 0;
    glint_status status = glint_mesh_take_colors(r, r->vertices.count);
    return status ? status : glint_mesh_color_faces(r);
}

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
        status = glint_fail(r->error, GLINT_ERR_FORMAT, "%s: faces expected, got %zu vertices and none%s", r->text.path,
                            r->vertices.count, r->vertices.count ? "" : ": is it a Wavefront .obj?");
    if (!status)
        status = check_corners(r);
    if (!status && r->library)
        status = glint_mesh_library_make(r->library, r);
    return status ? status : color(r);
}
