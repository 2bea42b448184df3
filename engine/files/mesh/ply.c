/// Reads PLY files: a header that describes the numbers of each vertex and face, then the numbers, as text or binary
/// in either byte order.
#include "engine/base/number.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/files/mesh/ply.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/// The state of reading the numbers.
typedef struct body {
    glint_mesh_reader *reader;
    const glint_ply_head *head;
    const glint_ply_element *element;
    uint64_t row; ///< number of the row within the element, from 1
    const char *at; ///< GLINT_PLY_TEXT: position in the line of the row
    bool takes_wedges; ///< whether texture coordinates come from the corners of faces, because vertices have none
    bool bad_normals; ///< whether some normals are 0 or not finite
} body;

// ---- Numbers ----

static glint_status fail_at(const body *b, const char *expected, const char *got)
{
    char line[24] = "";
    if (b->head->format == GLINT_PLY_TEXT)
        snprintf(line, sizeof line, ":%zu", b->reader->text.number);
    return glint_fail(b->reader->error, GLINT_ERR_FORMAT, "%s%s: %s %llu of %llu: %s expected, got %s",
                      b->reader->text.path, line, b->element->name, (unsigned long long)b->row,
                      (unsigned long long)b->element->count, expected, got);
}

static double number_of(glint_ply_type type, const unsigned char *bytes)
{
    union {
        int8_t i8;
        int16_t i16;
        int32_t i32;
        uint16_t u16;
        uint32_t u32;
        float f;
        double d;
    } number;
    memcpy(&number, bytes, glint_ply_sizes[type]);
    switch (type) {
    case GLINT_PLY_INT8:
        return number.i8;
    case GLINT_PLY_UINT8:
        return bytes[0];
    case GLINT_PLY_INT16:
        return number.i16;
    case GLINT_PLY_UINT16:
        return number.u16;
    case GLINT_PLY_INT32:
        return number.i32;
    case GLINT_PLY_UINT32:
        return number.u32;
    case GLINT_PLY_FLOAT32:
        return (double)number.f;
    default:
        return number.d;
    }
}

static glint_status read_bytes(body *b, glint_ply_type type, double *out)
{
    unsigned char bytes[8] = { 0 };
    const size_t size = glint_ply_sizes[type];
    FILE *file = b->reader->text.file;
    for (size_t i = 0; i < size; i++) {
        const int c = getc_unlocked(file);
        if (c == EOF)
            return ferror(file)
                       ? glint_fail(b->reader->error, GLINT_ERR_IO, "%s: %s", b->reader->text.path, strerror(errno))
                       : fail_at(b, "a number", "the end of the file");
        bytes[b->head->format == GLINT_PLY_BIG ? size - 1 - i : i] = (unsigned char)c;
    }
    *out = number_of(type, bytes);
    return GLINT_OK;
}

/// Reads the next line that is not empty.
static glint_status next_line(body *b)
{
    bool more = true;
    do {
        glint_status status = glint_mesh_next_line(&b->reader->text, false, &more);
        b->at = glint_skip_blanks(b->reader->text.line);
        if (status)
            return status;
        if (!more)
            return fail_at(b, "a line", "the end of the file");
    } while (!*b->at);
    return GLINT_OK;
}

/// Reads the next word as a number, from this line or a later one.
static glint_status read_word(body *b, double *out)
{
    const char *end;
    char shown[48];
    b->at = glint_skip_blanks(b->at);
    glint_status status = *b->at ? GLINT_OK : next_line(b);
    if (status)
        return status;
    *out = glint_mesh_read_double(b->at, &end);
    if (end != b->at && glint_ends_word(*end)) {
        b->at = end;
        return GLINT_OK;
    }
    snprintf(shown, sizeof shown, "'%.40s'", b->at);
    for (char *c = shown; *c; c++)
        *c = (unsigned char)*c < ' ' || *c == 127 ? ' ' : *c;
    return fail_at(b, "a number", shown);
}

static glint_status read_number(body *b, glint_ply_type type, double *out)
{
    return b->head->format == GLINT_PLY_TEXT ? read_word(b, out) : read_bytes(b, type, out);
}

/// Checks that a number is a whole number from 0 to `most`.
static glint_status check_whole(body *b, double number, double most, const char *field, uint32_t *out)
{
    char expected[96], got[40];
    if (number >= 0 && number <= most && number == floor(number)) {
        *out = (uint32_t)number;
        return GLINT_OK;
    }
    glint_print(expected, sizeof expected, "%s 0 .. %.0f", field, most);
    glint_print(got, sizeof got, "%.15g", number);
    return fail_at(b, expected, got);
}

static glint_status read_whole(body *b, glint_ply_type type, double most, const char *field, uint32_t *out)
{
    double number;
    glint_status status = read_number(b, type, &number);
    return status ? status : check_whole(b, number, most, field, out);
}

// ---- Rows ----

/// Reads a face. A face of fewer than 3 corners is left out.
static glint_status read_face(body *b, const glint_ply_property *p, uint32_t *size)
{
    glint_mesh_reader *r = b->reader;
    uint32_t number;
    glint_status status = read_whole(b, p->count_type, INT32_MAX, "a number of corners", size);
    for (uint32_t i = 0; i < *size && !status; i++) {
        status = read_whole(b, p->type, (double)b->head->vertex_count - 1, "a vertex number", &number);
        if (!status)
            status = glint_mesh_append(&r->corners, &number, r->error);
    }
    if (status || *size >= 3)
        return status ? status : glint_mesh_append(&r->sizes, size, r->error);
    r->corners.count -= *size;
    glint_mesh_note_that(r, GLINT_MESH_NOTE_FACE, 0, "face %llu of fewer than 3 corners is left out",
                         (unsigned long long)b->row);
    return GLINT_OK;
}

/// Reads triangle strips: each vertex after the first two makes a triangle with the two before it; every second
/// triangle is flipped.
static glint_status read_strips(body *b, const glint_ply_property *p)
{
    static const uint32_t three = 3;
    glint_mesh_reader *r = b->reader;
    uint32_t count = 0, length = 0, last[3] = { 0 };
    double number;
    glint_status status = read_whole(b, p->count_type, UINT32_MAX, "a list length", &count);
    for (uint32_t i = 0; i < count && !status; i++) {
        status = read_number(b, p->type, &number);
        if (!status && number == -1) {
            length = 0;
            continue;
        }
        if (!status)
            status = check_whole(b, number, (double)b->head->vertex_count - 1, "a vertex number", &last[2]);
        const bool is_flat =
            last[0] == last[1] || last[1] == last[2] || last[0] == last[2]; // such triangles join two parts of a strip
        if (!status && ++length >= 3 && !is_flat) {
            const uint32_t odd = length % 2, corners[3] = { last[odd ? 0 : 1], last[odd ? 1 : 0], last[2] };
            for (int k = 0; k < 3 && !status; k++)
                status = glint_mesh_append(&r->corners, &corners[k], r->error);
            if (!status)
                status = glint_mesh_append(&r->sizes, &three, r->error);
        }
        last[0] = last[1];
        last[1] = last[2];
    }
    return status;
}

/// Reads the texture coordinates of a face's corners; `size` is the number of corners.
static glint_status read_wedge(body *b, const glint_ply_property *p, uint32_t size)
{
    glint_mesh_reader *r = b->reader;
    uint32_t count = 0;
    double pair[2] = { 0 };
    glint_status status = read_whole(b, p->count_type, UINT32_MAX, "a list length", &count);
    for (uint32_t i = 0; i < count && !status; i++) {
        status = read_number(b, p->type, &pair[i % 2]);
        pair[i % 2] = isfinite(pair[i % 2]) ? pair[i % 2] : 0;
        if (!status && i % 2 && size >= 3 && count == 2 * size) {
            const uint32_t number = (uint32_t)r->uv.count;
            status = glint_mesh_append(&r->uv, pair, r->error);
            if (!status)
                status = glint_mesh_append(&r->corner_uv, &number, r->error);
        }
    }
    return status;
}

static glint_status pass_over(body *b, const glint_ply_property *p)
{
    double number;
    uint32_t count = 1;
    glint_status status =
        p->is_list ? read_whole(b, p->count_type, UINT32_MAX, "a list length", &count) : GLINT_OK;
    for (uint32_t i = 0; i < count && !status; i++)
        status = read_number(b, p->type, &number);
    return status;
}

/// Reads the properties of a row. The numbers that a mesh uses go to `v`.
static glint_status read_properties(body *b, double v[GLINT_PLY_NUMBERS])
{
    uint32_t size = 0; // number of corners of the face
    for (uint32_t i = 0; i < b->element->property_count; i++) {
        const glint_ply_property *p = &b->element->properties[i];
        glint_status status;
        if (p->role == GLINT_PLY_VERTEX_NUMBERS)
            status = read_face(b, p, &size);
        else if (p->role == GLINT_PLY_STRIP)
            status = read_strips(b, p);
        else if (p->role == GLINT_PLY_WEDGE && b->takes_wedges)
            status = read_wedge(b, p, size);
        else if (p->role == GLINT_PLY_WEDGE)
            status = pass_over(b, p);
        else
            status = p->role == GLINT_PLY_PASSED_OVER ? pass_over(b, p) : read_number(b, p->type, &v[p->role]);
        if (status)
            return status;
    }
    if (b->head->format == GLINT_PLY_TEXT && *glint_skip_blanks(b->at))
        return fail_at(b, "the end of the line", "more numbers");
    return GLINT_OK;
}

/// Adds a colour whose numbers are not 8-bit integers. Their range is known only after all colours are read. 16-bit
/// integers are divided by 65535, other numbers by 255.
static glint_status add_color_of_type(body *b, const double rgb[3])
{
    glint_mesh_reader *r = b->reader;
    const bool is_float = b->head->color_type == GLINT_PLY_FLOAT32 || b->head->color_type == GLINT_PLY_FLOAT64;
    const double most = is_float ? 1 : b->head->color_type == GLINT_PLY_UINT16 ? 65535 : 255;
    double v[3];
    for (int c = 0; c < 3; c++) {
        v[c] = rgb[c] / most;
        if (!(v[c] >= 0 && v[c] <= (is_float ? 255 : 1)))
            glint_mesh_note_that(r, GLINT_MESH_NOTE_COLOR, 0,
                                 "%s %llu: its colours are ignored: red, green and blue 0 .. %.0f expected",
                                 b->element->name, (unsigned long long)b->row, most);
    }
    return glint_mesh_append(&r->numbers_of_colors, v, r->error);
}

static glint_status add_color(body *b, const double v[GLINT_PLY_NUMBERS])
{
    glint_mesh_reader *r = b->reader;
    uint8_t codes[3];
    char got[40];
    if (b->head->color_type != GLINT_PLY_UINT8)
        return add_color_of_type(b, v + GLINT_PLY_RED);
    for (int c = 0; c < 3; c++) {
        const double code = v[GLINT_PLY_RED + c];
        if (!(code >= 0 && code <= 255 && code == floor(code))) { // text files may contain such numbers
            glint_print(got, sizeof got, "%.15g", code);
            return fail_at(b, "a colour value 0 .. 255", got);
        }
        codes[c] = (uint8_t)code;
    }
    return glint_mesh_append(&r->colors, codes, r->error);
}

static glint_status add_vertex(body *b, const double v[GLINT_PLY_NUMBERS])
{
    glint_mesh_reader *r = b->reader;
    double normal[3] = { v[GLINT_PLY_NX], v[GLINT_PLY_NY], v[GLINT_PLY_NZ] };
    glint_status status = glint_mesh_append(&r->vertices, v, r->error);
    if (!status && r->has_normals) {
        const bool bad =
            !isfinite(normal[0]) || !isfinite(normal[1]) || !isfinite(normal[2]) || vec_max_abs(normal) == 0;
        if (bad)
            memset(normal, 0, sizeof normal);
        b->bad_normals = b->bad_normals || bad;
        status = glint_mesh_append(&r->normals, normal, r->error);
    }
    const double uv[2] = { isfinite(v[GLINT_PLY_U]) ? v[GLINT_PLY_U] : 0,
                           isfinite(v[GLINT_PLY_V]) ? v[GLINT_PLY_V] : 0 };
    if (!status && glint_ply_has_role(b->element, GLINT_PLY_U) && glint_ply_has_role(b->element, GLINT_PLY_V))
        status = glint_mesh_append(&r->uv, uv, r->error);
    return status;
}

/// Gives corners without texture coordinates the index GLINT_NO_UV, if other corners have coordinates.
static glint_status fill_wedges(glint_mesh_reader *r)
{
    static const uint32_t none = GLINT_NO_UV;
    glint_status status = GLINT_OK;
    while (r->corner_uv.count < r->corners.count && !status)
        status = glint_mesh_append(&r->corner_uv, &none, r->error);
    return status;
}

static glint_status read_rows(body *b)
{
    glint_mesh_reader *r = b->reader;
    const glint_ply_element *e = b->element;
    const bool is_vertex = strcmp(e->name, "vertex") == 0, is_text = b->head->format == GLINT_PLY_TEXT;
    glint_status status = GLINT_OK;
    if (is_vertex)
        r->has_normals = glint_ply_has_role(e, GLINT_PLY_NX) && glint_ply_has_role(e, GLINT_PLY_NY) &&
                         glint_ply_has_role(e, GLINT_PLY_NZ);
    for (b->row = 1; b->row <= e->count && !status; b->row++) {
        double v[GLINT_PLY_NUMBERS] = { 0 };
        const size_t faces = r->sizes.count;
        if (is_text)
            status = next_line(b);
        if (!status)
            status = read_properties(b, v);
        if (!status && is_vertex)
            status = add_vertex(b, v);
        if (!status && e == b->head->colored && (is_vertex || r->sizes.count > faces))
            status = add_color(b, v);
        if (!status && b->takes_wedges)
            status = fill_wedges(r);
    }
    return status;
}

/// Makes the materials from the file's picture or from its colours.
static glint_status make_materials(glint_mesh_reader *r, const glint_ply_head *h)
{
    const bool has_own = r->desc->material || r->desc->material_count;
    glint_status status = GLINT_OK;
    if (h->texture[0] && r->uv.count && !has_own) {
        if (h->colored)
            glint_mesh_note_that(r, GLINT_MESH_NOTE_COLOR, 0, "its colours are ignored: it has a picture");
        return glint_mesh_picture_faces(r, h->texture);
    }
    if (h->texture[0] && !has_own)
        glint_mesh_note_that(r, GLINT_MESH_NOTE_PICTURE, 0,
                             "its picture %.60s is ignored: there are no texture coordinates (s, t)", h->texture);
    if (!h->colored || r->notes[GLINT_MESH_NOTE_COLOR].count)
        return GLINT_OK;
    if (h->color_type != GLINT_PLY_UINT8)
        status = glint_mesh_take_colors(r, r->numbers_of_colors.count);
    if (!status && r->colors_of_faces && r->colors.count != r->sizes.count) {
        glint_mesh_note_that(r, GLINT_MESH_NOTE_COLOR, 0, "its colours are ignored: strips of triangles have none");
        return GLINT_OK;
    }
    return status ? status : glint_mesh_color_faces(r);
}

static glint_status read_elements(body *b)
{
    glint_mesh_reader *r = b->reader;
    const glint_ply_head *h = b->head;
    glint_status status = GLINT_OK;
    b->takes_wedges = true;
    for (uint32_t i = 0; i < h->element_count; i++)
        b->takes_wedges = b->takes_wedges && !glint_ply_has_role(&h->elements[i], GLINT_PLY_U);
    for (uint32_t i = 0; i < h->element_count && !status; i++) {
        b->element = &h->elements[i];
        status = read_rows(b);
    }
    if (!status && r->sizes.count == 0)
        return glint_fail(r->error, GLINT_ERR_FORMAT, "%s: a face of 3 corners or more expected, got none",
                          r->text.path);
    if (b->takes_wedges && !r->uv.count)
        r->corner_uv.count = 0;
    return !status && b->bad_normals ? glint_mesh_drop_normals(r) : status;
}

glint_status glint_mesh_read_ply(glint_mesh_reader *r)
{
    glint_ply_head *h = calloc(1, sizeof *h);
    if (!h)
        return glint_fail_nomem(r->error);
    body b = { .reader = r, .head = h };
    glint_status status = glint_ply_read_head(r, h);
    r->text.longest = (size_t)1 << 26; // a strip is one line
    if (!status)
        status = read_elements(&b);
    r->colors_of_faces = h->colored && strcmp(h->colored->name, "face") == 0;
    if (!status)
        status = make_materials(r, h);
    free(h);
    return status;
}
