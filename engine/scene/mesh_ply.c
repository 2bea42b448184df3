/// PLY files: a head that says which numbers each vertex and each face has, then these, as text or binary in either byte order.
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/scene/mesh_file.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ELEMENTS_MAX 32
#define PROPERTIES_MAX 256

typedef enum format { TEXT, LITTLE, BIG } format;

/// Types of numbers; each has two names.
typedef enum number_type { INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64, TYPE_COUNT } number_type;

static const char *const TYPES[TYPE_COUNT][2] = { { "char", "int8" },     { "uchar", "uint8" },   { "short", "int16" },
                                                  { "ushort", "uint16" }, { "int", "int32" },     { "uint", "uint32" },
                                                  { "float", "float32" }, { "double", "float64" } };
static const unsigned char SIZES[TYPE_COUNT] = { 1, 1, 2, 2, 4, 4, 4, 8 };

/// What a property is to a mesh. The first ones are numbers of a vertex, of a face the colours alone.
typedef enum property_role {
    X,
    Y,
    Z,
    NX,
    NY,
    NZ,
    U,
    V,
    RED,
    GREEN,
    BLUE,
    NUMBERS, ///< how many these are
    VERTEX_NUMBERS = NUMBERS,
    PASSED_OVER
} property_role;

typedef struct property {
    number_type type, count_type; ///< count_type: of a list
    bool is_list;
    property_role role;
} property;

typedef struct element {
    char name[32];
    uint64_t count;
    uint32_t property_count;
    property properties[PROPERTIES_MAX];
} element;

typedef struct head {
    format format;
    uint32_t element_count;
    uint64_t vertex_count, face_count;
    const element *colored; ///< whose colours count; NULL: there are none
    element elements[ELEMENTS_MAX];
} head;

/// The file while its numbers are read.
typedef struct body {
    glint_mesh_reader *reader;
    const head *head;
    const element *element;
    uint64_t row; ///< of the element, from 1
    const char *at; ///< TEXT: in the line of the row
    bool bad_normals; ///< some are 0 or not finite
} body;

// ---- The head ----

static bool find_type(const char *word, number_type *out)
{
    for (int i = 0; i < TYPE_COUNT; i++)
        if (strcmp(word, TYPES[i][0]) == 0 || strcmp(word, TYPES[i][1]) == 0) {
            *out = (number_type)i;
            return true;
        }
    return false;
}

static property_role role_of(const element *e, const property *p, const char *name)
{
    static const struct {
        const char *name;
        property_role role;
    } roles[] = { { "x", X },         { "y", Y },
                  { "z", Z },         { "nx", NX },
                  { "ny", NY },       { "nz", NZ },
                  { "u", U },         { "v", V },
                  { "s", U },         { "t", V },
                  { "texture_u", U }, { "texture_v", V },
                  { "red", RED },     { "green", GREEN },
                  { "blue", BLUE },   { "diffuse_red", RED },
                  { "r", RED },       { "diffuse_green", GREEN },
                  { "g", GREEN },     { "diffuse_blue", BLUE },
                  { "b", BLUE } };
    const bool vertex = strcmp(e->name, "vertex") == 0, face = strcmp(e->name, "face") == 0;
    if (face && p->is_list && (strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0))
        return VERTEX_NUMBERS;
    for (size_t i = 0; i < sizeof roles / sizeof *roles && (vertex || face) && !p->is_list; i++)
        if (strcmp(name, roles[i].name) == 0 && (vertex || roles[i].role >= RED))
            return roles[i].role;
    return PASSED_OVER;
}

static bool has_role(const element *e, property_role role)
{
    for (uint32_t i = 0; i < e->property_count; i++)
        if (e->properties[i].role == role)
            return true;
    return false;
}

static glint_status read_property(glint_mesh_reader *r, element *e, char **words)
{
    property p = { 0 };
    p.is_list = words[1] && strcmp(words[1], "list") == 0;
    char **rest = words + (p.is_list ? 3 : 1);
    const bool typed = p.is_list ? words[2] && find_type(words[2], &p.count_type) : true;
    if (!typed || !rest[0] || !find_type(rest[0], &p.type) || !rest[1] || rest[2] ||
        (p.is_list && p.count_type >= FLOAT32))
        return glint_mesh_refuse(&r->text, "property TYPE NAME or property list TYPE TYPE NAME", words[0]);
    if (e->property_count == PROPERTIES_MAX)
        return glint_mesh_refuse(&r->text, "at most 256 properties", words[0]);
    p.role = role_of(e, &p, rest[1]);
    if (p.role >= RED && p.role <= BLUE && has_role(e, p.role))
        p.role = PASSED_OVER; // other colours, under another name
    if (p.role != PASSED_OVER && has_role(e, p.role))
        return glint_mesh_refuse(&r->text, "a property once", rest[1]);
    e->properties[e->property_count++] = p;
    return GLINT_OK;
}

static glint_status read_element(glint_mesh_reader *r, head *h, char **words)
{
    char *end;
    errno = 0;
    const unsigned long long count = words[1] && words[2] ? strtoull(words[2], &end, 10) : 0;
    if (!words[1] || !words[2] || words[3] || errno || *end || *words[2] == '-')
        return glint_mesh_refuse(&r->text, "element NAME COUNT", words[0]);
    if (h->element_count == ELEMENTS_MAX)
        return glint_mesh_refuse(&r->text, "at most 32 elements", words[0]);
    for (uint32_t i = 0; i < h->element_count; i++)
        if (strcmp(h->elements[i].name, words[1]) == 0)
            return glint_mesh_refuse(&r->text, "an element once", words[1]);
    element *e = &h->elements[h->element_count++];
    *e = (element) { .count = count };
    snprintf(e->name, sizeof e->name, "%s", words[1]);
    if (strcmp(e->name, "vertex") == 0)
        h->vertex_count = count;
    if (strcmp(e->name, "face") == 0)
        h->face_count = count;
    return GLINT_OK;
}

static glint_status read_format(glint_mesh_reader *r, head *h, char **words)
{
    static const char *const names[] = { "ascii", "binary_little_endian", "binary_big_endian" };
    for (int i = 0; i < 3 && words[1]; i++)
        if (strcmp(words[1], names[i]) == 0) {
            h->format = (format)i;
            return GLINT_OK;
        }
    return glint_mesh_refuse(&r->text, "format ascii, binary_little_endian or binary_big_endian",
                             words[1] ? words[1] : "");
}

/// Cuts a line into words, NULL after the last; those past the fifth are left out.
static void split(char *line, char *words[7])
{
    char *rest = NULL;
    int count = 0;
    for (char *word = strtok_r(line, " \t", &rest); word && count < 6; word = strtok_r(NULL, " \t", &rest))
        words[count++] = word;
    words[count] = NULL;
}

static glint_status read_head(glint_mesh_reader *r, head *h)
{
    char *words[7];
    bool more = true, formatted = false;
    glint_status status = glint_mesh_next_line(&r->text, false, &more);
    if (!status && strcmp(r->text.line, "ply") != 0)
        status = glint_mesh_refuse(&r->text, "ply", r->text.line);
    while (!status) {
        status = glint_mesh_next_line(&r->text, false, &more);
        if (status)
            break;
        if (!more)
            return glint_mesh_refuse(&r->text, "end_header", "the end of the file");
        split(r->text.line, words);
        if (!words[0] || strcmp(words[0], "comment") == 0 || strcmp(words[0], "obj_info") == 0)
            continue;
        if (strcmp(words[0], "end_header") == 0)
            return formatted ? GLINT_OK : glint_mesh_refuse(&r->text, "format above end_header", words[0]);
        formatted = formatted || strcmp(words[0], "format") == 0;
        if (strcmp(words[0], "format") == 0)
            status = read_format(r, h, words);
        else if (strcmp(words[0], "element") == 0)
            status = read_element(r, h, words);
        else if (strcmp(words[0], "property") == 0 && h->element_count > 0)
            status = read_property(r, &h->elements[h->element_count - 1], words);
        else
            status = glint_mesh_refuse(&r->text, "format, comment, element, property or end_header", words[0]);
    }
    return status;
}

/// How many of red, green and blue an element has; 0 where some are not 8 bits.
static int count_colors(const element *e)
{
    int count = 0;
    for (uint32_t i = 0; i < e->property_count; i++) {
        const property *p = &e->properties[i];
        if (p->role < RED || p->role > BLUE)
            continue;
        if (p->type != UINT8)
            return 0;
        count++;
    }
    return count;
}

/// Finds the colours that count, those of faces before those of vertices; a material of the script stands for all.
static void find_colors(const glint_mesh_reader *r, head *h)
{
    bool any = false;
    for (uint32_t i = 0; i < h->element_count; i++) {
        const element *e = &h->elements[i];
        any = any || has_role(e, RED) || has_role(e, GREEN) || has_role(e, BLUE);
        if (count_colors(e) == 3 && (!h->colored || strcmp(e->name, "face") == 0))
            h->colored = e;
    }
    if (r->desc->material || r->desc->material_count)
        h->colored = NULL;
    else if (any && !h->colored)
        glint_mesh_warn(r->desc, r->text.path,
                        "its colours are passed over: red, green and blue of 8 bits (uchar) expected");
}

/// Whether the elements make a mesh, and have no more rows than the file has room for.
static glint_status check_head(const glint_mesh_reader *r, const head *h)
{
    bool places = false, faces = false;
    for (uint32_t i = 0; i < h->element_count; i++) {
        const element *e = &h->elements[i];
        uint64_t least = 0;
        for (uint32_t k = 0; k < e->property_count; k++)
            least += h->format == TEXT
                         ? 1
                         : SIZES[e->properties[k].is_list ? e->properties[k].count_type : e->properties[k].type];
        if (e->count > 0 && (least == 0 || e->count > r->text.size / least))
            return glint_fail(r->error, GLINT_ERR_FORMAT,
                              "%s: element %s: no more than the file has room for expected, got %llu", r->text.path,
                              e->name, (unsigned long long)e->count);
        places = places || (has_role(e, X) && has_role(e, Y) && has_role(e, Z));
        faces = faces || has_role(e, VERTEX_NUMBERS);
    }
    if (!places)
        return glint_fail(r->error, GLINT_ERR_FORMAT, "%s: an element vertex with x, y and z expected", r->text.path);
    if (!faces || h->face_count == 0)
        return glint_fail(r->error, GLINT_ERR_FORMAT,
                          "%s: an element face with a list vertex_indices expected, got %llu vertices and no face",
                          r->text.path, (unsigned long long)h->vertex_count);
    return GLINT_OK;
}

// ---- Numbers ----

static glint_status fail_at(const body *b, const char *expected, const char *got)
{
    return glint_fail(b->reader->error, GLINT_ERR_FORMAT, "%s: %s %llu of %llu: %s expected, got %s",
                      b->reader->text.path, b->element->name, (unsigned long long)b->row,
                      (unsigned long long)b->element->count, expected, got);
}

static double number_of(number_type type, const unsigned char *bytes)
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
    memcpy(&number, bytes, SIZES[type]);
    switch (type) {
    case INT8:
        return number.i8;
    case UINT8:
        return bytes[0];
    case INT16:
        return number.i16;
    case UINT16:
        return number.u16;
    case INT32:
        return number.i32;
    case UINT32:
        return number.u32;
    case FLOAT32:
        return (double)number.f;
    default:
        return number.d;
    }
}

static glint_status read_bytes(body *b, number_type type, double *out)
{
    unsigned char bytes[8] = { 0 };
    const size_t size = SIZES[type];
    FILE *file = b->reader->text.file;
    for (size_t i = 0; i < size; i++) {
        const int c = getc_unlocked(file);
        if (c == EOF)
            return ferror(file)
                       ? glint_fail(b->reader->error, GLINT_ERR_IO, "%s: %s", b->reader->text.path, strerror(errno))
                       : fail_at(b, "a number", "the end of the file");
        bytes[b->head->format == BIG ? size - 1 - i : i] = (unsigned char)c;
    }
    *out = number_of(type, bytes);
    return GLINT_OK;
}

static glint_status read_word(body *b, double *out)
{
    char *end, shown[48];
    b->at = glint_skip_blanks(b->at);
    *out = glint_read_double(b->at, &end, b->reader->text.c_locale);
    if (end != b->at && glint_ends_word(*end)) {
        b->at = end;
        return GLINT_OK;
    }
    snprintf(shown, sizeof shown, "'%.40s'", b->at);
    for (char *c = shown; *c; c++)
        *c = (unsigned char)*c < ' ' || *c == 127 ? ' ' : *c;
    return fail_at(b, "a number", shown);
}

static glint_status read_number(body *b, number_type type, double *out)
{
    return b->head->format == TEXT ? read_word(b, out) : read_bytes(b, type, out);
}

/// A whole number 0 .. most.
static glint_status read_whole(body *b, number_type type, double most, const char *what, uint32_t *out)
{
    double number;
    char expected[96], got[40];
    glint_status status = read_number(b, type, &number);
    if (status)
        return status;
    if (number >= 0 && number <= most && number == floor(number)) {
        *out = (uint32_t)number;
        return GLINT_OK;
    }
    snprintf(expected, sizeof expected, "%s, 0 .. %.0f,", what, most);
    snprintf(got, sizeof got, "%.15g", number);
    return fail_at(b, expected, got);
}

// ---- Rows ----

static glint_status read_face(body *b, const property *p)
{
    glint_mesh_reader *r = b->reader;
    uint32_t size, number;
    glint_status status = read_whole(b, p->count_type, INT32_MAX, "a number of corners", &size);
    if (!status && size < 3)
        status = fail_at(b, "3 corners or more", "fewer");
    for (uint32_t i = 0; i < size && !status; i++) {
        status = read_whole(b, p->type, (double)b->head->vertex_count - 1, "the number of a vertex", &number);
        if (!status)
            status = glint_mesh_append(&r->corners, &number, r->error);
    }
    return status ? status : glint_mesh_append(&r->sizes, &size, r->error);
}

static glint_status pass_over(body *b, const property *p)
{
    double number;
    uint32_t count = 1;
    glint_status status =
        p->is_list ? read_whole(b, p->count_type, UINT32_MAX, "the length of a list", &count) : GLINT_OK;
    for (uint32_t i = 0; i < count && !status; i++)
        status = read_number(b, p->type, &number);
    return status;
}

/// The numbers of a row that a mesh has go to `v`.
static glint_status read_properties(body *b, double v[NUMBERS])
{
    for (uint32_t i = 0; i < b->element->property_count; i++) {
        const property *p = &b->element->properties[i];
        glint_status status;
        if (p->role == VERTEX_NUMBERS)
            status = read_face(b, p);
        else
            status = p->role == PASSED_OVER ? pass_over(b, p) : read_number(b, p->type, &v[p->role]);
        if (status)
            return status;
    }
    if (b->head->format == TEXT && *glint_skip_blanks(b->at))
        return fail_at(b, "the end of the line", "more numbers");
    return GLINT_OK;
}

static glint_status add_color(body *b, const double v[NUMBERS])
{
    uint8_t codes[3];
    char got[40];
    for (int c = 0; c < 3; c++) {
        const double code = v[RED + c];
        if (!(code >= 0 && code <= 255 && code == floor(code))) { // of a text
            snprintf(got, sizeof got, "%.15g", code);
            return fail_at(b, "a colour's code, 0 .. 255,", got);
        }
        codes[c] = (uint8_t)code;
    }
    return glint_mesh_append(&b->reader->colors, codes, b->reader->error);
}

static glint_status add_vertex(body *b, const double v[NUMBERS])
{
    glint_mesh_reader *r = b->reader;
    double normal[3] = { v[NX], v[NY], v[NZ] };
    glint_status status = glint_mesh_append(&r->vertices, v, r->error);
    if (!status && r->has_normals) {
        const bool bad =
            !isfinite(normal[0]) || !isfinite(normal[1]) || !isfinite(normal[2]) || vec_max_abs(normal) == 0;
        if (bad)
            memset(normal, 0, sizeof normal);
        b->bad_normals = b->bad_normals || bad;
        status = glint_mesh_append(&r->normals, normal, r->error);
    }
    if (!status && has_role(b->element, U) && has_role(b->element, V))
        status = glint_mesh_append(&r->uv, &v[U], r->error);
    return status;
}

static glint_status next_row(body *b)
{
    bool more = true;
    while (b->head->format == TEXT) {
        glint_status status = glint_mesh_next_line(&b->reader->text, false, &more);
        b->at = b->reader->text.line;
        if (status)
            return status;
        if (!more)
            return fail_at(b, "a line", "the end of the file");
        if (*glint_skip_blanks(b->at))
            break;
    }
    return GLINT_OK;
}

static glint_status read_rows(body *b)
{
    const element *e = b->element;
    const bool is_vertex = strcmp(e->name, "vertex") == 0;
    glint_status status = GLINT_OK;
    if (is_vertex)
        b->reader->has_normals = has_role(e, NX) && has_role(e, NY) && has_role(e, NZ);
    for (b->row = 1; b->row <= e->count && !status; b->row++) {
        double v[NUMBERS] = { 0 };
        status = next_row(b);
        if (!status)
            status = read_properties(b, v);
        if (!status && is_vertex)
            status = add_vertex(b, v);
        if (!status && e == b->head->colored)
            status = add_color(b, v);
    }
    return status;
}

/// Vertices without a normal have none: the corners that meet there take those of their faces.
static glint_status drop_bad_normals(glint_mesh_reader *r)
{
    const double up[3] = { 0, 0, 1 };
    const uint32_t none = GLINT_NO_NORMAL, *corners = r->corners.items;
    double *normals = r->normals.items;
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < r->corners.count && !status; i++)
        status = glint_mesh_append(&r->corner_normals,
                                   vec_max_abs(normals + 3 * (size_t)corners[i]) > 0 ? &corners[i] : &none, r->error);
    for (size_t i = 0; i < r->normals.count; i++)
        if (vec_max_abs(normals + 3 * i) == 0)
            vec_copy(normals + 3 * i, up);
    return status;
}

glint_status glint_mesh_read_ply(glint_mesh_reader *r)
{
    head *h = calloc(1, sizeof *h);
    if (!h)
        return glint_fail_nomem(r->error);
    body b = { .reader = r, .head = h };
    glint_status status = read_head(r, h);
    if (!status)
        status = check_head(r, h);
    if (!status)
        find_colors(r, h);
    for (uint32_t i = 0; i < h->element_count && !status; i++) {
        b.element = &h->elements[i];
        status = read_rows(&b);
    }
    if (!status && b.bad_normals)
        status = drop_bad_normals(r);
    r->colors_of_faces = h->colored && strcmp(h->colored->name, "face") == 0;
    if (!status && h->colored)
        status = glint_mesh_color_faces(r);
    free(h);
    return status;
}
