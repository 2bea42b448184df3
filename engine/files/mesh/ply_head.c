/// Reads the header of PLY files, which describes the numbers of each vertex and face.
#include "engine/base/status.h"
#include "engine/files/mesh/ply.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/// Each type of number has two names.
static const char *const TYPES[GLINT_PLY_TYPE_COUNT][2] = { { "char", "int8" },     { "uchar", "uint8" },
                                                            { "short", "int16" },   { "ushort", "uint16" },
                                                            { "int", "int32" },     { "uint", "uint32" },
                                                            { "float", "float32" }, { "double", "float64" } };
const unsigned char glint_ply_sizes[GLINT_PLY_TYPE_COUNT] = { 1, 1, 2, 2, 4, 4, 4, 8 };

static bool find_type(const char *word, glint_ply_type *out)
{
    for (int i = 0; i < GLINT_PLY_TYPE_COUNT; i++)
        if (strcmp(word, TYPES[i][0]) == 0 || strcmp(word, TYPES[i][1]) == 0) {
            *out = (glint_ply_type)i;
            return true;
        }
    return false;
}

static glint_ply_role role_of(const glint_ply_element *e, const glint_ply_property *p, const char *name)
{
    static const struct {
        const char *name;
        glint_ply_role role;
    } roles[] = { { "x", GLINT_PLY_X },         { "y", GLINT_PLY_Y },
                  { "z", GLINT_PLY_Z },         { "nx", GLINT_PLY_NX },
                  { "ny", GLINT_PLY_NY },       { "nz", GLINT_PLY_NZ },
                  { "u", GLINT_PLY_U },         { "v", GLINT_PLY_V },
                  { "s", GLINT_PLY_U },         { "t", GLINT_PLY_V },
                  { "texture_u", GLINT_PLY_U }, { "texture_v", GLINT_PLY_V },
                  { "red", GLINT_PLY_RED },     { "green", GLINT_PLY_GREEN },
                  { "blue", GLINT_PLY_BLUE },   { "diffuse_red", GLINT_PLY_RED },
                  { "r", GLINT_PLY_RED },       { "diffuse_green", GLINT_PLY_GREEN },
                  { "g", GLINT_PLY_GREEN },     { "diffuse_blue", GLINT_PLY_BLUE },
                  { "b", GLINT_PLY_BLUE } };
    const bool vertex = strcmp(e->name, "vertex") == 0, face = strcmp(e->name, "face") == 0;
    const bool strips = strcmp(e->name, "tristrips") == 0;
    if ((face || strips) && p->is_list && (strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0))
        return face ? GLINT_PLY_VERTEX_NUMBERS : GLINT_PLY_STRIP;
    if (face && p->is_list && strcmp(name, "texcoord") == 0)
        return GLINT_PLY_WEDGE;
    for (size_t i = 0; i < sizeof roles / sizeof *roles && (vertex || face) && !p->is_list; i++)
        if (strcmp(name, roles[i].name) == 0 && (vertex || roles[i].role >= GLINT_PLY_RED))
            return roles[i].role;
    return GLINT_PLY_PASSED_OVER;
}

bool glint_ply_has_role(const glint_ply_element *e, glint_ply_role role)
{
    for (uint32_t i = 0; i < e->property_count; i++)
        if (e->properties[i].role == role)
            return true;
    return false;
}

static glint_status read_property(glint_mesh_reader *r, glint_ply_element *e, char **words)
{
    glint_ply_property p = { 0 };
    p.is_list = words[1] && strcmp(words[1], "list") == 0;
    char **rest = words + (p.is_list ? 3 : 1);
    const bool typed = p.is_list ? words[2] && find_type(words[2], &p.count_type) : true;
    if (typed && rest[0] && rest[1] && !find_type(rest[0], &p.type))
        return glint_mesh_refuse(&r->text, "one of the types char, uchar, short, ushort, int, uint, float and double",
                                 rest[0]);
    if (!typed || !rest[0] || !rest[1] || rest[2] || (p.is_list && p.count_type >= GLINT_PLY_FLOAT32))
        return glint_mesh_refuse(&r->text, "property TYPE NAME or property list TYPE TYPE NAME", words[0]);
    if (e->property_count == GLINT_PLY_PROPERTIES_MAX)
        return glint_mesh_refuse(&r->text, "at most 256 properties", words[0]);
    p.role = role_of(e, &p, rest[1]);
    if (p.role >= GLINT_PLY_RED && p.role <= GLINT_PLY_BLUE && glint_ply_has_role(e, p.role))
        p.role = GLINT_PLY_PASSED_OVER; // other colours, which have another name
    if (p.role != GLINT_PLY_PASSED_OVER && glint_ply_has_role(e, p.role))
        return glint_mesh_refuse(&r->text, "a property once", rest[1]);
    e->properties[e->property_count++] = p;
    return GLINT_OK;
}

static glint_status read_element(glint_mesh_reader *r, glint_ply_head *h, char **words)
{
    char *end;
    errno = 0;
    const unsigned long long count = words[1] && words[2] ? strtoull(words[2], &end, 10) : 0;
    if (!words[1] || !words[2] || words[3] || errno || *end || *words[2] == '-')
        return glint_mesh_refuse(&r->text, "element NAME COUNT", words[0]);
    if (h->element_count == GLINT_PLY_ELEMENTS_MAX)
        return glint_mesh_refuse(&r->text, "at most 32 elements", words[0]);
    for (uint32_t i = 0; i < h->element_count; i++)
        if (strcmp(h->elements[i].name, words[1]) == 0)
            return glint_mesh_refuse(&r->text, "an element once", words[1]);
    glint_ply_element *e = &h->elements[h->element_count++];
    *e = (glint_ply_element) { .count = count };
    snprintf(e->name, sizeof e->name, "%s", words[1]);
    if (strcmp(e->name, "vertex") == 0)
        h->vertex_count = count;
    if (strcmp(e->name, "face") == 0 || strcmp(e->name, "tristrips") == 0)
        h->face_count += count;
    return GLINT_OK;
}

static glint_status read_format(glint_mesh_reader *r, glint_ply_head *h, char **words)
{
    static const char *const names[] = { "ascii", "binary_little_endian", "binary_big_endian" };
    for (int i = 0; i < 3 && words[1]; i++)
        if (strcmp(words[1], names[i]) == 0) {
            h->format = (glint_ply_format)i;
            return GLINT_OK;
        }
    return glint_mesh_refuse(&r->text, "format ascii, binary_little_endian or binary_big_endian",
                             words[1] ? words[1] : "");
}

/// Splits a line into words, NULL after the last; words after the sixth are dropped.
static void split(char *line, char *words[7])
{
    char *rest = NULL;
    int count = 0;
    for (char *word = strtok_r(line, " \t", &rest); word && count < 6; word = strtok_r(NULL, " \t", &rest))
        words[count++] = word;
    words[count] = NULL;
}

/// Reads the comment that names the picture of a mesh; only the first such comment counts.
static void take_texture(glint_mesh_reader *r, glint_ply_head *h)
{
    static const char comment[] = "comment TextureFile";
    if (!glint_mesh_is_word(r->text.line, "comment") || strncmp(r->text.line, comment, sizeof comment - 1) != 0)
        return;
    const char *name = glint_skip_blanks(r->text.line + sizeof comment - 1);
    if (!h->texture[0])
        snprintf(h->texture, sizeof h->texture, "%s", name);
    else
        glint_mesh_note_that(r, GLINT_MESH_NOTE_PICTURE, 0, "its picture %.60s is ignored: a mesh has one", name);
}

static glint_status read_words(glint_mesh_reader *r, glint_ply_head *h)
{
    char *words[7];
    bool more = true, formatted = false;
    glint_status status = glint_mesh_next_line(&r->text, false, &more);
    if (!status && (!glint_mesh_is_word(r->text.line, "ply") || *glint_skip_blanks(r->text.line + 3)))
        status = glint_mesh_refuse(&r->text, "ply", r->text.line);
    while (!status) {
        status = glint_mesh_next_line(&r->text, false, &more);
        if (status)
            break;
        if (!more)
            return glint_mesh_refuse(&r->text, "end_header", "the end of the file");
        take_texture(r, h);
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

/// Returns whether an element has red, green and blue of the same type, and writes *type.
static bool has_colors(const glint_ply_element *e, glint_ply_type *type)
{
    int count = 0;
    for (uint32_t i = 0; i < e->property_count; i++) {
        const glint_ply_property *p = &e->properties[i];
        if (p->role < GLINT_PLY_RED || p->role > GLINT_PLY_BLUE)
            continue;
        if (count++ > 0 && p->type != *type)
            return false;
        *type = p->type;
    }
    return count == 3;
}

/// Chooses the colours: faces before vertices. If the script gives a material, the file's colours are not used.
static void find_colors(const glint_mesh_reader *r, glint_ply_head *h)
{
    bool any = false;
    glint_ply_type type;
    for (uint32_t i = 0; i < h->element_count; i++) {
        const glint_ply_element *e = &h->elements[i];
        any = any || glint_ply_has_role(e, GLINT_PLY_RED) || glint_ply_has_role(e, GLINT_PLY_GREEN) ||
              glint_ply_has_role(e, GLINT_PLY_BLUE);
        if ((!h->colored || strcmp(e->name, "face") == 0) && has_colors(e, &type)) {
            h->colored = e;
            h->color_type = type;
        }
    }
    if (r->desc->material || r->desc->material_count)
        h->colored = NULL;
    else if (any && !h->colored)
        glint_mesh_warn(r->desc, r->text.path, "its colours are ignored: red, green and blue of one type expected");
}

/// Checks that the elements make a mesh, and that the file is long enough for their rows.
static glint_status check_head(const glint_mesh_reader *r, const glint_ply_head *h)
{
    bool positions = false, faces = false, strips = false;
    for (uint32_t i = 0; i < h->element_count; i++) {
        const glint_ply_element *e = &h->elements[i];
        uint64_t least = 0;
        for (uint32_t k = 0; k < e->property_count; k++)
            least +=
                h->format == GLINT_PLY_TEXT
                    ? 1
                    : glint_ply_sizes[e->properties[k].is_list ? e->properties[k].count_type : e->properties[k].type];
        if (e->count > 0 && (least == 0 || e->count > r->text.size / least))
            return glint_fail(r->error, GLINT_ERR_FORMAT,
                              "%s: element %s: rows that fit into the file expected, got %llu", r->text.path, e->name,
                              (unsigned long long)e->count);
        positions = positions || (glint_ply_has_role(e, GLINT_PLY_X) && glint_ply_has_role(e, GLINT_PLY_Y) &&
                                  glint_ply_has_role(e, GLINT_PLY_Z));
        faces = faces || glint_ply_has_role(e, GLINT_PLY_VERTEX_NUMBERS);
        strips = strips || glint_ply_has_role(e, GLINT_PLY_STRIP);
    }
    if (!positions)
        return glint_fail(r->error, GLINT_ERR_FORMAT, "%s: an element vertex with x, y and z expected", r->text.path);
    if ((!faces && !strips) || h->face_count == 0)
        return glint_fail(r->error, GLINT_ERR_FORMAT,
                          "%s: an element face with a list vertex_indices expected, got %llu vertices and no face; "
                          "glint.points reads point clouds",
                          r->text.path, (unsigned long long)h->vertex_count);
    return GLINT_OK;
}

glint_status glint_ply_read_head(glint_mesh_reader *r, glint_ply_head *h)
{
    glint_status status = read_words(r, h);
    if (!status)
        status = check_head(r, h);
    if (!status)
        find_colors(r, h);
    return status;
}
