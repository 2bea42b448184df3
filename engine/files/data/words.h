/// A table from words to numbers. Internal.
#ifndef GLINT_DATA_WORDS_H
#define GLINT_DATA_WORDS_H

#include "engine/glint_types.h"
#include "engine/glint_data.h"

/// Returns the number of a word, or -1.
int64_t glint_words_find(const glint_words *words, const char *word, size_t length);

#endif
