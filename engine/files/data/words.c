/// A hash table with open addressing. The text of all words is in one block.
#include "engine/files/data/words.h"

#include "engine/base/status.h"

#include <stdlib.h>
#include <string.h>

#define WORDS_MAX 65536

typedef struct entry {
    size_t at; ///< position of the word in `text`
    uint32_t length, number;
    bool used;
} entry;

struct glint_words {
    entry *entries; ///< a power of two, at most half of them used
    size_t size, count;
    char *text;
    size_t bytes, space; ///< used and allocated bytes of `text`
};

static size_t hash_of(const char *word, size_t length)
{
    uint32_t hash = 2166136261u; // FNV-1a
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)word[i]) * 16777619u;
    return hash ^ hash >> 15;
}

/// Returns the entry of a word, or the unused one where it would be.
static entry *slot_of(const glint_words *words, const char *word, size_t length)
{
    for (size_t i = hash_of(word, length);; i++) {
        entry *e = &words->entries[i & (words->size - 1)];
        if (!e->used || (e->length == length && memcmp(words->text + e->at, word, length) == 0))
            return e;
    }
}

int64_t glint_words_find(const glint_words *words, const char *word, size_t length)
{
    const entry *e = slot_of(words, word, length);
    return e->used ? (int64_t)e->number : -1;
}

static bool grow(glint_words *words)
{
    const glint_words old = *words;
    entry *entries = calloc(2 * old.size, sizeof *entries);
    if (!entries)
        return false;
    words->entries = entries;
    words->size = 2 * old.size;
    for (size_t i = 0; i < old.size; i++)
        if (old.entries[i].used)
            *slot_of(words, words->text + old.entries[i].at, old.entries[i].length) = old.entries[i];
    free(old.entries);
    return true;
}

glint_status glint_words_create(glint_words **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    glint_words *words = calloc(1, sizeof *words);
    if (!words)
        return glint_fail_nomem(error);
    words->size = 16;
    words->space = 64;
    words->entries = calloc(words->size, sizeof *words->entries);
    words->text = malloc(words->space);
    if (!words->entries || !words->text) {
        glint_words_destroy(words);
        return glint_fail_nomem(error);
    }
    *out = words;
    return GLINT_OK;
}

glint_status glint_words_add(glint_words *words, const char *word, size_t length, uint32_t number, glint_error *error)
{
    GLINT_REFUSE_NULL(words, error);
    GLINT_REFUSE_NULL(word, error);
    entry *e = slot_of(words, word, length);
    if (e->used) {
        e->number = number;
        return GLINT_OK;
    }
    if (words->count == WORDS_MAX || length > UINT32_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "words: at most %d words expected", WORDS_MAX);
    if (words->space - words->bytes < length) {
        char *text = realloc(words->text, 2 * words->space + length);
        if (!text)
            return glint_fail_nomem(error);
        words->text = text;
        words->space = 2 * words->space + length;
    }
    if (2 * (words->count + 1) > words->size) {
        if (!grow(words))
            return glint_fail_nomem(error);
        e = slot_of(words, word, length);
    }
    *e = (entry) { .at = words->bytes, .length = (uint32_t)length, .number = number, .used = true };
    memcpy(words->text + words->bytes, word, length);
    words->bytes += length;
    words->count++;
    return GLINT_OK;
}

void glint_words_destroy(glint_words *words)
{
    if (!words)
        return;
    free(words->entries);
    free(words->text);
    free(words);
}
