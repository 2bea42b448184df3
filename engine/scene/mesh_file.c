/// glint_mesh_load: by the ending of a file's name, its reader; then the mesh of what was read.
#include "engine/scene/mesh_file.h"

#include "engine/base/open.h"
#include "engine/base/status.h"
#include "engine/scene/mesh_mtl.h"
#include "engine/scene/objects.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#define LINE_MAX_BYTES ((size_t)1 << 20)

// ---- Arrays ----

glint_status glint_mesh_append(glint_mesh_array *array, const void *item, glint_error *error)
{
    if (array->count == array->room) {
        const size_t room = array->room ? 2 * array->room : 1024;
        void *items = room > SIZE_MAX / array->size ? NULL : realloc(array->items, room * array->size);
        if (!items)
            return glint_fail_nomem(error);
        array->items = items;
        array->room = room;
    }
    memcpy((char *)array->items + array->count * array->size, item, array->size);
    array->count++;
    return GLINT_OK;
}

static const char *item_at(const glint_mesh_array *array, size_t i)
{
    return (const char *)array->items + i * array->size;
}

static size_t slot_of(const glint_mesh_set *set, const void *item, size_t key_size)
{
    return (size_t)glint_key_add((glint_key) { 0 }, item, key_size).low & (set->room - 1);
}

/// Room for twice as many items, at most half of the slots taken.
static glint_status grow_set(glint_mesh_set *set, const glint_mesh_array *array, size_t key_size, glint_error *error)
{
    glint_mesh_set grown = { .room = set->room ? 2 * set->room : 1024 };
    grown.slots = calloc(grown.room, sizeof *grown.slots);
    if (!grown.slots)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < array->count; i++) {
        size_t slot = slot_of(&grown, item_at(array, i), key_size);
        while (grown.slots[slot])
            slot = (slot + 1) & (grown.room - 1);
        grown.slots[slot] = (uint32_t)i + 1;
    }
    free(set->slots);
    *set = grown;
    return GLINT_OK;
}

glint_status glint_mesh_find(glint_mesh_set *set, glint_mesh_array *array, const void *item, size_t key_size,
                             uint32_t *number, glint_error *error)
{
    glint_status status = GLINT_OK;
    if (2 * array->count >= set->room)
        status = grow_set(set, array, key_size, error);
    if (status)
        return status;
    size_t slot = slot_of(set, item, key_size);
    while (set->slots[slot] && memcmp(item_at(array, set->slots[slot] - 1), item, key_size) != 0)
        slot = (slot + 1) & (set->room - 1);
    if (!set->slots[slot]) {
        status = glint_mesh_append(array, item, error);
        set->slots[slot] = (uint32_t)array->count;
    }
    *number = set->slots[slot] - 1;
    return status;
}

// ---- Lines ----

glint_status glint_mesh_text_open(glint_mesh_text *text, const char *path, glint_error *error)
{
    int file;
    *text = (glint_mesh_text) { .path = path, .room = 4096, .error = error };
    glint_status status = glint_open_file(path, &file, &text->size, error);
    if (status)
        return status;
    text->file = fdopen(file, "rb");
    if (!text->file)
        close(file);
    text->line = malloc(text->room);
    text->c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return text->file && text->line && text->c_locale ? GLINT_OK : glint_fail_nomem(error);
}

void glint_mesh_text_close(glint_mesh_text *text)
{
    if (text->file)
        fclose(text->file);
    if (text->c_locale)
        freelocale(text->c_locale);
    free(text->line);
}

glint_status glint_mesh_refuse(const glint_mesh_text *text, const char *expected, const char *got)
{
    char shown[48];
    snprintf(shown, sizeof shown, "%.40s", got);
    for (char *c = shown; *c; c++)
        *c = (unsigned char)*c < ' ' || *c == 127 ? ' ' : *c;
    return glint_fail(text->error, GLINT_ERR_FORMAT, "%s: line %zu: %s expected, got '%s'", text->path, text->number,
                      expected, shown);
}

static glint_status grow_line(glint_mesh_text *text, size_t used)
{
    if (used + 2 < text->room)
        return GLINT_OK;
    if (text->room >= LINE_MAX_BYTES)
        return glint_fail(text->error, GLINT_ERR_FORMAT, "%s: line %zu: at most %zu bytes expected", text->path,
                          text->number, LINE_MAX_BYTES);
    char *line = realloc(text->line, text->room * 2);
    if (!line)
        return glint_fail_nomem(text->error);
    text->line = line;
    text->room *= 2;
    return GLINT_OK;
}

glint_status glint_mesh_next_line(glint_mesh_text *text, bool joined, bool *more)
{
    size_t used = 0;
    int c = 0;
    text->number++;
    *more = false;
    while ((c = getc_unlocked(text->file)) != EOF) {
        *more = true;
        if (c == '\n' && joined && used > 0 && text->line[used - 1] == '\\') {
            text->line[used - 1] = ' ';
            continue;
        }
        if (c == '\n')
            break;
        if (c == '\r')
            continue;
        glint_status status = grow_line(text, used);
        if (status)
            return status;
        text->line[used++] = c ? (char)c : '?';
    }
    text->line[used] = 0;
    if (ferror(text->file))
        return glint_fail(text->error, GLINT_ERR_IO, "%s: %s", text->path, strerror(errno));
    return GLINT_OK;
}

glint_status glint_mesh_number(const glint_mesh_text *text, const char **at, double *out)
{
    char *end;
    *at = glint_skip_blanks(*at);
    *out = glint_read_double(*at, &end, text->c_locale);
    if (end == *at || !glint_ends_word(*end))
        return glint_mesh_refuse(text, "a number", *at);
    if (!isfinite(*out))
        return glint_mesh_refuse(text, "a finite number", *at);
    *at = end;
    return GLINT_OK;
}

bool glint_mesh_is_word(const char *line, const char *word)
{
    const size_t length = strlen(word);
    return strncmp(line, word, length) == 0 && glint_ends_word(line[length]);
}

char *glint_mesh_beside(const char *path, const char *name)
{
    const char *slash = strrchr(path, '/');
    const size_t folder = *name == '/' || !slash ? 0 : (size_t)(slash - path) + 1, length = strlen(name);
    char *out = malloc(folder + length + 1);
    if (!out)
        return NULL;
    memcpy(out, path, folder);
    memcpy(out + folder, name, length + 1);
    for (char *c = out + folder; *c; c++)
        *c = *c == '\\' ? '/' : *c;
    return out;
}

void glint_mesh_warn(const glint_mesh_desc *desc, const char *path, const char *format, ...)
{
    char message[512];
    if (!desc->warns)
        return;
    const int used = snprintf(message, sizeof message / 2, "%.240s: ", path);
    va_list args;
    va_start(args, format);
    vsnprintf(message + used, sizeof message - (size_t)used, format, args);
    va_end(args);
    desc->warns(desc->context, message);
}

// ---- The file ----

static glint_status make_mesh(glint_mesh_reader *r, bool leave_flat, glint_shape **out)
{
    glint_mesh_desc mesh = *r->desc;
    glint_error inner;
    size_t flat = 0;
    mesh.vertices = r->vertices.items;
    mesh.vertex_count = r->vertices.count;
    mesh.corners = r->corners.items;
    mesh.face_sizes = r->sizes.items;
    mesh.face_count = r->sizes.count;
    mesh.normals = r->has_normals ? r->normals.items : NULL;
    mesh.normal_count = r->has_normals ? r->normals.count : 0;
    mesh.normal_corners = r->has_normals && r->corner_normals.count ? r->corner_normals.items : NULL;
    mesh.uv = r->uv.count ? r->uv.items : NULL;
    mesh.uv_count = r->uv.count;
    mesh.uv_corners = r->corner_uv.count ? r->corner_uv.items : NULL;
    if (r->library)
        glint_mesh_library_give(r->library, r, &mesh);
    if (r->materials.count) {
        mesh.materials = r->materials.items;
        mesh.material_count = r->materials.count;
        mesh.material_index = r->material_index.items;
    }
    glint_status status = glint_mesh_make(&mesh, leave_flat ? &flat : NULL, out, &inner);
    if (status)
        return glint_fail(r->error, status, "%.300s: %.200s", r->text.path, inner.message);
    if (flat)
        glint_mesh_warn(r->desc, r->text.path, "%zu of %zu faces are left out: they have no area", flat,
                        r->sizes.count);
    return GLINT_OK;
}

static void release(glint_mesh_reader *r)
{
    glint_mesh_array *const arrays[] = { &r->vertices,       &r->normals,   &r->uv,    &r->corners,
                                         &r->corner_normals, &r->corner_uv, &r->sizes, &r->material_index,
                                         &r->colors,         &r->materials };
    for (size_t i = 0; i < r->materials.count; i++)
        glint_material_release(((glint_material **)r->materials.items)[i]);
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free(arrays[i]->items);
    free(r->places.slots);
    glint_mesh_library_free(r->library);
    glint_mesh_text_close(&r->text);
}

typedef glint_status (*reading)(glint_mesh_reader *reader);

static reading reader_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    if (dot && strcasecmp(dot, ".stl") == 0)
        return glint_mesh_read_stl;
    return dot && strcasecmp(dot, ".ply") == 0 ? glint_mesh_read_ply : glint_mesh_read_obj;
}

glint_status glint_mesh_load(const char *path, const glint_mesh_desc *desc, glint_shape **out, glint_error *error)
{
    glint_mesh_reader r = { .desc = desc, .error = error };
    const reading read = reader_of(path);
    r.vertices.size = r.normals.size = 3 * sizeof(double);
    r.uv.size = 2 * sizeof(double);
    r.colors.size = 3;
    r.materials.size = sizeof(glint_material *);
    r.corners.size = r.corner_normals.size = r.corner_uv.size = r.sizes.size = r.material_index.size = sizeof(uint32_t);
    glint_status status = desc->has_shading ? glint_check_shading(desc->shading, error) : GLINT_OK;
    if (status)
        return status;
    if (desc->reads)
        desc->reads(desc->context, path);
    status = glint_mesh_text_open(&r.text, path, error);
    if (!status)
        status = read(&r);
    if (!status)
        status = make_mesh(&r, read != glint_mesh_read_obj, out);
    release(&r);
    return status;
}
