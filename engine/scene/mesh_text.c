/// What the readers of mesh files share: arrays that grow, and the lines of a file.
#include "engine/scene/mesh_file.h"

#include "engine/base/open.h"
#include "engine/base/status.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
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
    *text = (glint_mesh_text) { .path = path, .room = 4096, .longest = LINE_MAX_BYTES, .error = error };
    glint_status status = glint_open_file(path, &file, &text->size, error);
    if (status)
        return status;
    text->file = fdopen(file, "rb");
    if (!text->file)
        close(file);
    text->line = malloc(text->room);
    text->c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!text->file || !text->line || !text->c_locale)
        return glint_fail_nomem(error);
    text->begin_bytes = fread(text->begin, 1, sizeof text->begin, text->file);
    text->start = text->begin_bytes >= 3 && memcmp(text->begin, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    return glint_mesh_text_rewind(text, text->start);
}

glint_status glint_mesh_text_rewind(glint_mesh_text *text, long start)
{
    return fseek(text->file, start, SEEK_SET) ? glint_file_fail(text->error, text->path, errno) : GLINT_OK;
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
    if (text->room >= text->longest)
        return glint_fail(text->error, GLINT_ERR_FORMAT, "%s: line %zu: at most %zu bytes expected", text->path,
                          text->number, text->longest);
    char *line = realloc(text->line, text->room * 2);
    if (!line)
        return glint_fail_nomem(text->error);
    text->line = line;
    text->room *= 2;
    return GLINT_OK;
}

/// Reads the rest of a line's end after a carriage return: LF, also after more of them. In a file whose first line ends in
/// CR without LF nothing more belongs to it: the bytes that follow a head may be anything.
static void end_at_return(glint_mesh_text *text)
{
    int c = '\r', returns = 0;
    for (; c == '\r' && !text->lone_returns; c = getc_unlocked(text->file))
        returns++;
    if (text->lone_returns || c == '\n')
        return;
    if (c != EOF)
        ungetc(c, text->file);
    text->lone_returns = text->number == 1 && c != EOF;
    text->skipped += (size_t)returns - 1; // empty lines
}

glint_status glint_mesh_next_line(glint_mesh_text *text, bool joined, bool *more)
{
    size_t used = 0;
    int c = 0;
    text->number += 1 + text->skipped;
    text->skipped = 0;
    *more = false;
    while ((c = getc_unlocked(text->file)) != EOF) {
        *more = true;
        if (c == '\r')
            end_at_return(text);
        if ((c == '\n' || c == '\r') && joined && used > 0 && text->line[used - 1] == '\\') {
            text->line[used - 1] = ' ';
            text->skipped++;
            continue;
        }
        if (c == '\n' || c == '\r')
            break;
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

static char *join(const char *path, const char *name)
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

char *glint_mesh_beside(const char *path, const char *name)
{
    char *out = join(path, name);
    const char *slash = out ? strpbrk(name, "/\\") : NULL;
    if (!slash || access(out, F_OK) == 0)
        return out;
    for (const char *next; (next = strpbrk(slash + 1, "/\\")) != NULL;)
        slash = next;
    char *base = join(path, slash + 1); // of a path on another machine
    if (!base || access(base, F_OK) != 0) {
        free(base);
        return out;
    }
    free(out);
    return base;
}
