/// A small bitmap font for labels. Internal.
#ifndef GLINT_TEXT_FONT_H
#define GLINT_TEXT_FONT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define GLINT_FONT_WIDTH 8 ///< of every character, in pixels
#define GLINT_FONT_HEIGHT 13

/// The 13 rows, from the top, of the UTF-8 character at *text, which moves past it; the leftmost pixel is the highest bit.
/// Latin-1, Greek and a few signs are there; another character, or a byte that is none, looks like U+FFFD.
const uint8_t *glint_font_next(const char **text);

/// The code of the UTF-8 character at *text, which moves past it; U+FFFD for a byte that is none.
uint32_t glint_font_code(const char **text);

/// Whether there is a character.
bool glint_font_has(uint32_t code);

/// How many characters the first `size` bytes of `text` (to its end at most) are.
size_t glint_font_count(const char *text, size_t size);

#endif
