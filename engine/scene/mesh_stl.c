/// STL files: triangles one by one, as text or binary. Corners at one place become one vertex.
#include "engine/base/status.h"
#include "engine/scene/mesh_file.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <strings.h>

#define HEAD_BYTES 84 ///< a text and the number of triangles
#define TRIANGLE_BYTES 50 ///< a normal, three corners in binary32, two bytes of no fixed meaning

/// Adds a triangle: its vertices are found by their numbers' bits.
static glint_status add_triangle(glint_mesh_reader *r, double corners[3][3])
{
    static const uint32_t size = 3;
    uint32_t number;
    glint_status status = GLINT_OK;
    for (int i = 0; i < 3 && !status; i++) {
        for (int c = 0; c < 3; c++)
            corners[i][c] += 0.0; // -0 and 0 are one place
        status = glint_mesh_find(&r->places, &r->vertices, corners[i], sizeof corners[i], &number, r->error);
        if (!status)
            status = glint_mesh_append(&r->corners, &number, r->error);
    }
    return status ? status : glint_mesh_append(&r->sizes, &size, r->error);
}

// ---- Binary ----

static float float_at(const unsigned char *bytes)
{
    float number;
    memcpy(&number, bytes, sizeof number); // little-endian, as every machine that the engine runs on
    return number;
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
        for (int k = 0; k < 9; k++) {
            corners[k / 3][k % 3] = (double)float_at(record + 12 + 4 * k);
            if (!isfinite(corners[k / 3][k % 3]))
                return glint_fail(r->error, GLINT_ERR_FORMAT, "%s: triangle %u: finite numbers expected", r->text.path,
                                  i + 1);
        }
        glint_status status = add_triangle(r, corners);
        if (status)
            return status;
    }
    return GLINT_OK;
}

// ---- Text ----

static const char *const WORDS[] = { "facet", "outer", "vertex", "vertex", "vertex", "endloop", "endfacet" };

/// A line of a facet, the `place`-th from 0; after the last comes the first of the next one, or the end of the solid.
static glint_status read_statement(glint_mesh_reader *r, const char *at, int *place, double corners[3][3])
{
    char expected[32];
    if (*place == 0 && (glint_mesh_is_word(at, "endsolid") || glint_mesh_is_word(at, "solid")))
        return GLINT_OK;
    snprintf(expected, sizeof expected, *place ? "%s" : "%s or endsolid", WORDS[*place]);
    if (!glint_mesh_is_word(at, WORDS[*place]))
        return glint_mesh_refuse(&r->text, expected, at);
    if (*place >= 2 && *place <= 4) {
        at += sizeof "vertex" - 1;
        for (int c = 0; c < 3; c++) {
            glint_status status = glint_mesh_number(&r->text, &at, &corners[*place - 2][c]);
            if (status)
                return status;
        }
    }
    *place = (*place + 1) % 7;
    return *place ? GLINT_OK : add_triangle(r, corners);
}

/// The next line in place, its first word in small letters; *at NULL: there is none.
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
    int place = 0;
    char *at;
    double corners[3][3];
    glint_status status = next_statement(r, &at);
    while (!status && at) {
        status = read_statement(r, at, &place, corners);
        if (!status)
            status = next_statement(r, &at);
    }
    return !status && place ? glint_mesh_refuse(&r->text, WORDS[place], "the end of the file") : status;
}

// ---- The file ----

/// A file whose size fits its number of triangles is binary, whatever its head says; "solid" begins some of both kinds.
glint_status glint_mesh_read_stl(glint_mesh_reader *r)
{
    unsigned char head[HEAD_BYTES] = { 0 };
    uint32_t count;
    glint_status status;
    const size_t got = fread(head, 1, sizeof head, r->text.file);
    memcpy(&count, head + 80, sizeof count);
    const bool fits = got == sizeof head && r->text.size == HEAD_BYTES + (uint64_t)count * TRIANGLE_BYTES;
    const bool text = !fits && strncasecmp((const char *)head, "solid", 5) == 0;
    if (!fits && !text)
        return glint_fail(r->error, GLINT_ERR_FORMAT,
                          "%s: \"solid\" or %d bytes and %d for each of its %u triangles expected, got %llu bytes",
                          r->text.path, HEAD_BYTES, TRIANGLE_BYTES, count, (unsigned long long)r->text.size);
    if (text)
        rewind(r->text.file);
    status = text ? read_text(r) : read_binary(r, count);
    if (!status && r->sizes.count == 0)
        status = glint_fail(r->error, GLINT_ERR_FORMAT, "%s: triangles expected, got none", r->text.path);
    return status;
}
