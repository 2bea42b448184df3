/// Shared by the readers of mesh files: growing arrays, and the lines of a file.
#include "engine/files/mesh/file.h"

#include "engine/base/number.h"
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
    if (array->count == array->capacity) {
        const size_t capacity = array->capacity ? 2 * array->capacity : 1024;
        void *items = capacity > SIZE_MAX / array->size ? NULL : realloc(array->items, capacity * array->size);
        if (!items)
            return glint_fail_nomem(error);
        array->items = items;
        array->capacity = capacity;
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
    return (size_t)glint_key_add((glint_key) { 0 }, item, key_size).low & (set->capacity - 1);
}

/// Doubles the capacity, so that at most half of the slots are used.
static glint_status grow_set(glint_mesh_set *set, const glint_mesh_array *array, size_t key_size, glint_error *error)
{
    glint_mesh_set grown = { .capacity = set->capacity ? 2 * set->capacity : 1024 };
    grown.slots = calloc(grown.capacity, sizeof *grown.slots);
    if (!grown.slots)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < array->count; i++) {
        size_t slot = slot_of(&grown, item_at(array, i), key_size);
        while (grown.slots[slot])
            slot = (slot + 1) & (grown.capacity - 1);
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
    if (2 * array->count >= set->capacity)
        status = grow_set(set, array, key_size, error);
    if (status)
        return status;
    size_t slot = slot_of(set, item, key_size);
    while (set->slots[slot] && memcmp(item_at(array, set->slots[slot] - 1), item, key_size) != 0)
        slot = (slot + 1) & (set->capacity - 1);
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
    *text = (glint_mesh_text) { .path = path, .capacity = 4096, .longest = LINE_MAX_BYTES, .error = error };
    glint_status status = glint_open_file(path, &file, &text->size, error);
    if (status)
        return status;
    text->file = fdopen(file, "rb");
    if (!text->file)
        close(file);
    text->line = malloc(text->capacity);
    if (!text->file || !text->line)
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
    free(text->line);
}

glint_status glint_mesh_refuse(const glint_mesh_text *text, const char *expected, const char *got)
{
    char shown[48] = "the end of the line";
    if (*got)
        snprintf(shown, sizeof shown, "'%.40s'", got);
    for (char *c = shown; *c; c++)
        *c = (unsigned char)*c < ' ' || *c == 127 ? ' ' : *c;
    return glint_fail(text->error, GLINT_ERR_FORMAT, "%s:%zu: %s expected, got %s", text->path, text->number, expected,
                      shown);
}

static glint_status grow_line(glint_mesh_text *text, size_t used)
{
    if (used + 2 < text->capacity)
        return GLINT_OK;
    if (text->capacity >= text->longest)
        return glint_fail(text->error, GLINT_ERR_FORMAT, "%s:%zu: at most %zu bytes expected", text->path, text->number,
                          text->longest);
    char *line = realloc(text->line, text->capacity * 2);
    if (!line)
        return glint_fail_nomem(text->error);
    text->line = line;
    text->capacity *= 2;
    return GLINT_OK;
}

/// Reads the rest of a line's end after a carriage return: LF, also after several carriage returns. If a file's first
/// line ends in CR without LF, only the CR belongs to the end, because any bytes may follow a header.
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

/// Reads a number again after replacing Fortran's exponents, with a D or without a letter, by exponents with E:
/// 1.5D+03, 1.5-103.
static double read_fortran(const char *at, const char **end)
{
    char copy[64], *copy_end;
    const size_t length = strcspn(at, " \t#"), mantissa = (size_t)(*end - at);
    const bool has_d = at[mantissa] == 'D' || at[mantissa] == 'd';
    const char *exponent = at + mantissa + has_d;
    if (mantissa == 0 || length + 2 > sizeof copy || !(has_d || *exponent == '+' || *exponent == '-'))
        return NAN;
    snprintf(copy, sizeof copy, "%.*se%.*s", (int)mantissa, at, (int)(length - (size_t)(exponent - at)), exponent);
    const double number = glint_read_double(copy, &copy_end);
    if (!*copy_end)
        *end = at + length;
    return number;
}

double glint_mesh_read_double(const char *at, const char **end)
{
    static const char *const none[] = { "#IND", "#INF", "#QNAN", "#SNAN" };
    char *stop;
    const double number = glint_read_double(at, &stop);
    *end = stop;
    if (stop == at || glint_ends_word(*stop))
        return number;
    for (size_t i = 0; i < sizeof none / sizeof *none && *stop == '#'; i++)
        if (strncmp(stop, none[i], strlen(none[i])) == 0) {
            *end = stop + strcspn(stop, " \t");
            return NAN;
        }
    return *stop == '#' ? number : read_fortran(at, end);
}

glint_status glint_mesh_number(const glint_mesh_text *text, const char **at, double *out)
{
    const char *end;
    *at = glint_skip_blanks(*at);
    *out = glint_mesh_read_double(*at, &end);
    if (end == *at || !glint_ends_number(*end))
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

bool glint_mesh_text_is_utf16(const glint_mesh_text *text)
{
    return text->begin_bytes >= 2 &&
           (memcmp(text->begin, "\xff\xfe", 2) == 0 || memcmp(text->begin, "\xfe\xff", 2) == 0);
}

/// Joins the folder of a path and a name. Quotation marks around the name are removed.
static char *join(const char *path, const char *name)
{
    const char *slash = strrchr(path, '/');
    size_t length = strlen(name);
    if (length > 2 && *name == '"' && name[length - 1] == '"') {
        name++;
        length -= 2;
    }
    const size_t folder = *name == '/' || !slash ? 0 : (size_t)(slash - path) + 1;
    char *out = malloc(folder + length + 1);
    if (!out)
        return NULL;
    memcpy(out, path, folder);
    memcpy(out + folder, name, length);
    out[folder + length] = 0;
    for (char *c = out + folder; *c; c++)
        *c = *c == '\\' ? '/' : *c;
    return out;
}

char *glint_mesh_sibling(const char *path, const char *name)
{
    char *out = join(path, name);
    const char *slash = out ? strpbrk(name, "/\\") : NULL;
    if (!slash || access(out, F_OK) == 0)
        return out;
    for (const char *next; (next = strpbrk(slash + 1, "/\\")) != NULL;)
        slash = next;
    char *base = join(path, slash + 1); // the last part of the name, which may be a path from another machine
    if (!base || access(base, F_OK) != 0) {
        free(base);
        return out;
    }
    free(out);
    return base;
}
