/// Reads STL files: single triangles, as text or binary. Corners at the same position become one vertex.
#include "engine/base/status.h"
#include "engine/files/mesh/file.h"

#include <errno.h>
#include <string.h>
#include <strings.h>

#define HEAD_BYTES 84 ///< bytes before the triangles: a text, and the number of triangles
#define TRIANGLE_BYTES 50 ///< bytes of a triangle: a normal, three corners in binary32, two bytes of no fixed meaning

/// Adds a triangle. Corners with the same bits share a vertex.
static glint_status add_triangle(glint_mesh_reader *r, double corners[3][3])
{
    static const uint32_t size = 3;
    uint32_t number;
    glint_status status = GLINT_OK;
    for (int i = 0; i < 3 && !status; i++) {
        for (int c = 0; c < 3; c++)
            corners[i][c] += 0.0; // -0 and 0 are the same position
        status = glint_mesh_find(&r->vertex_set, &r->vertices, corners[i], sizeof corners[i], &number, r->error);
        if (!status)
            status = glint_mesh_append(&r->corners, &number, r->error);
    }
    return status ? status : glint_mesh_append(&r->sizes, &size, r->error);
}

// ---- Binary ----

static float float_at(const unsigned char *bytes)
{
    float number;
    memcpy(&number, bytes, sizeof number); // little-endian, like all machines that the engine supports
    return number;
}

/// Reads the colour of a triangle as VisCAM writes it: 5 bits each of red, green and blue, with bit 15 set.
static glint_status read_color(glint_mesh_reader *r, uint32_t bits)
{
    double v[3];
    for (uint32_t c = 0; c < 3; c++)
        v[c] = bits & 0x8000 ? (bits >> (10 - 5 * c) & 31) / 31.0 : GLINT_MESH_NO_COLOR;
    r->colors_of_faces = r->colors_of_faces || (bits & 0x8000);
    return glint_mesh_append(&r->numbers_of_colors, v, r->error);
}

static glint_status read_binary(glint_mesh_reader *r, uint32_t count)
{
    unsigned char record[TRIANGLE_BYTES];
    double corners[3][3];
    for (uint32_t i = 0; i < count; i++) {
        if (fread(record, sizeof record, 1, r->text.file) != 1)
            return ferror(r->text.file) ? glint_fail(r->error, GLINT_ERR_IO, "%s: %s", r->text.path, strerror(errno))
                                        : glint_fail(r->error, GLINT_ERR_FORMAT, "%s: %u triangles expected, got %u",
                                                     r->text.path, count, i);
        for (int k = 0; k < 9; k++)
            corners[k / 3][k % 3] = (double)float_at(record + 12 + 4 * k);
        glint_status status = add_triangle(r, corners);
        if (!status)
            status = read_color(r, record[48] | (uint32_t)record[49] << 8);
        if (status)
            return status;
    }
    return GLINT_OK;
}

/// Gives faces their colours, unless the script gives materials or the colours have the form of Magics.
static glint_status color(glint_mesh_reader *r, const char *head)
{
    bool magics = false;
    for (int i = 0; i + 6 <= HEAD_BYTES - 4; i++)
        magics = magics || memcmp(head + i, "COLOR=", 6) == 0;
    if (magics)
        glint_mesh_note_that(r, GLINT_MESH_NOTE_COLOR, 0,
                             "its colours are ignored: glint reads those of VisCAM's form, not of Magics'");
    if (!magics && r->colors_of_faces && !r->desc->material && !r->desc->material_count) {
        glint_status status = glint_mesh_take_colors(r, r->sizes.count);
        return status ? status : glint_mesh_color_faces(r);
    }
    return GLINT_OK;
}

// ---- Text ----

static const char *const WORDS[] = { "facet", "outer", "vertex", "vertex", "vertex", "endloop", "endfacet" };

/// The parser's position within the structure of a text file.
typedef struct state {
    int step; ///< step within a facet, 0 .. 6; 0 also between facets
    bool ended; ///< whether the last solid has ended
    double corners[3][3];
} state;

/// Reads a line of a facet or between facets. Text after a solid is skipped, up to the next solid.
static glint_status read_statement(glint_mesh_reader *r, const char *at, state *s)
{
    char expected[32];
    const int step = s->step;
    const bool ends = glint_mesh_is_word(at, "endsolid");
    if (step == 0 && (ends || glint_mesh_is_word(at, "solid"))) {
        s->ended = ends;
        return GLINT_OK;
    }
    if (s->ended && !glint_mesh_is_word(at, WORDS[0])) {
        glint_mesh_note_that(r, GLINT_MESH_NOTE_UNKNOWN, r->text.number, "this line, after the solid, is ignored");
        return GLINT_OK;
    }
    if (step == 0 && (strchr("#;/", *at) || glint_mesh_is_word(at, "color"))) {
        glint_mesh_note_that(r, GLINT_MESH_NOTE_COLOR, r->text.number, "this line, between facets, is ignored");
        return GLINT_OK;
    }
    snprintf(expected, sizeof expected, step ? "%s" : "%s or endsolid", WORDS[step]);
    if (!glint_mesh_is_word(at, WORDS[step]))
        return glint_mesh_refuse(&r->text, expected, at);
    if (step >= 2 && step <= 4) {
        at += sizeof "vertex" - 1;
        for (int c = 0; c < 3; c++) {
            const char *end, *word = glint_skip_blanks(at);
            s->corners[step - 2][c] = glint_mesh_read_double(word, &end);
            if (end == word || !glint_ends_word(*end))
                return glint_mesh_refuse(&r->text, "a number", word);
            at = end;
        }
    }
    s->step = (step + 1) % 7;
    return s->step ? GLINT_OK : add_triangle(r, s->corners);
}

/// Reads the next line that is not empty, with its first word in lower case; *at is NULL at the end of the file.
static glint_status next_statement(glint_mesh_reader *r, char **at)
{
    bool more = true;
    *at = NULL;
    while (!*at && more) {
        glint_status status = glint_mesh_next_line(&r->text, false, &more);
        if (status)
            return status;
        char *from = r->text.line;
        while (glint_is_blank(*from))
            from++;
        *at = *from ? from : NULL;
    }
    for (char *c = *at; c && !glint_ends_word(*c); c++)
        *c = (char)(*c >= 'A' && *c <= 'Z' ? *c + 'a' - 'A' : *c);
    return GLINT_OK;
}

static glint_status read_text(glint_mesh_reader *r)
{
    char *at;
    state s = { 0 };
    glint_status status = next_statement(r, &at);
    while (!status && at) {
        status = read_statement(r, at, &s);
        if (!status)
            status = next_statement(r, &at);
    }
    return !status && s.step ? glint_mesh_refuse(&r->text, WORDS[s.step], "the end of the file") : status;
}

// ---- The file ----

/// Returns whether a file is text: its first word is "solid", and its first bytes contain a facet or an end after the
/// first line, or no byte that cannot be in a text.
static bool is_text(const char *bytes, size_t count)
{
    size_t at = 0;
    bool printable = true, behind = false, facets = false;
    while (at < count && (glint_is_blank(bytes[at]) || bytes[at] == '\r' || bytes[at] == '\n'))
        at++;
    if (count - at < 5 || strncasecmp(bytes + at, "solid", 5) != 0)
        return false;
    for (; at < count; at++) {
        printable = printable && bytes[at] != 0;
        behind = behind || bytes[at] == '\n' || bytes[at] == '\r';
        facets = facets ||
                 (behind && (strncasecmp(bytes + at, "facet", 5) == 0 || strncasecmp(bytes + at, "endsolid", 8) == 0));
    }
    return facets || printable;
}

/// Refuses a file that is not text and does not have the size that its number of triangles requires.
static glint_status refuse_size(glint_mesh_reader *r, const char *head, size_t got, uint32_t count)
{
    bool printable = got > 0;
    for (size_t i = 0; i < got && i < HEAD_BYTES; i++)
        printable = printable && ((unsigned char)head[i] >= ' ' || (head[i] && strchr("\t\r\n", head[i])));
    if (!printable || got < 5)
        return glint_fail(r->error, GLINT_ERR_FORMAT,
                          "%s: \"solid\" or %d bytes and %d for each of its %u triangles expected, got %llu bytes",
                          r->text.path, HEAD_BYTES, TRIANGLE_BYTES, count, (unsigned long long)r->text.size);
    r->text.number = 1;
    return glint_mesh_refuse(&r->text, "the first word solid", head);
}

/// A file whose size fits its number of triangles is binary, whatever its header says, because both formats may begin
/// with "solid". A longer file that is not text is binary, too; the bytes after its triangles are ignored.
glint_status glint_mesh_read_stl(glint_mesh_reader *r)
{
    char bytes[1024 + 8] = { 0 }; // the zeros end every comparison
    uint32_t count;
    glint_mesh_text *t = &r->text;
    glint_status status = glint_mesh_text_rewind(t, 0);
    const size_t got = status ? 0 : fread(bytes, 1, sizeof bytes - 8, t->file);
    memcpy(&count, bytes + 80, sizeof count);
    const uint64_t needed = HEAD_BYTES + (uint64_t)count * TRIANGLE_BYTES;
    const bool text = t->size != needed && is_text(bytes + t->start, got - (size_t)t->start);
    if (!status && !text && (got < HEAD_BYTES || t->size < needed))
        status = refuse_size(r, bytes + t->start, got - (size_t)t->start, count);
    if (!status)
        status = glint_mesh_text_rewind(t, text ? t->start : HEAD_BYTES);
    if (!status)
        status = text ? read_text(r) : read_binary(r, count);
    if (!status && !text && t->size > needed)
        glint_mesh_note_that(r, GLINT_MESH_NOTE_UNKNOWN, 0,
                             "the data after the last triangle is ignored: bytes %llu .. %llu",
                             (unsigned long long)needed, (unsigned long long)t->size - 1);
    if (!status && !text)
        status = color(r, bytes);
    if (!status && r->sizes.count == 0)
        status = glint_fail(r->error, GLINT_ERR_FORMAT, "%s: triangles expected, got none", t->path);
    return status;
}
