/// A small bitmap font for labels. Internal.
#ifndef GLINT_TEXT_FONT_H
#define GLINT_TEXT_FONT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define GLINT_FONT_WIDTH 8 ///< width of every character, pixels
#define GLINT_FONT_HEIGHT 13
#define GLINT_FONT_ABOVE 11 ///< the part of the height above the baseline

/// Returns the 13 rows of the glyph of the UTF-8 character at *text, from the top, and moves *text past the
/// character. The leftmost pixel is the highest bit. The font has Latin-1, Greek and a few signs; other characters
/// and invalid bytes look like U+FFFD.
const uint8_t *glint_font_next(const char **text);

/// Returns the code of the UTF-8 character at *text, and moves *text past it; U+FFFD for an invalid byte.
uint32_t glint_font_code(const char **text);

/// Writes a character as UTF-8 and returns the number of its bytes. A control character and a code that is no character
/// are written as U+FFFD, as XML does not allow them.
size_t glint_font_encode(uint32_t code, char out[4]);

/// Returns whether the font has a character.
bool glint_font_has(uint32_t code);

/// Returns the number of characters in the first `size` bytes of `text`, at most to its end.
size_t glint_font_count(const char *text, size_t size);

#endif
