/// The font that text is drawn with, by FreeType. Internal.
///
/// The environment's GLINT_FONT is the path of a font, or "bitmap"; without it the first that is there of some places where systems
/// have DejaVu Sans. Where there is none, or no FreeType in this build, it is the bitmap font of font.h.
#ifndef GLINT_TEXT_LETTERS_H
#define GLINT_TEXT_LETTERS_H

#include "engine/base/hash.h"
#include "engine/glint.h"
#include "engine/text/mask.h"

typedef struct glint_letters glint_letters; ///< an open font; of one thread at a time

/// *out NULL: the bitmap font. GLINT_ERR_INVALID: GLINT_FONT names a file that is not a font.
glint_status glint_letters_open(glint_letters **out, glint_error *error);
void glint_letters_close(glint_letters *letters); ///< NULL: nothing
/// Whether there was no memory for something: text that was measured or drawn is not as it should be.
bool glint_letters_lost(const glint_letters *letters);
/// Returns what the pixels of text depend on besides the text: the font, and the version of the library.
glint_key glint_letters_key(const glint_letters *letters);

/// "FreeType 2.12.1"; a static string; NULL: this build has none.
const char *glint_letters_library(void);

/// Pixels above and below the line that letters of `em` pixels stand on, and from one line to the next.
void glint_letters_measure(glint_letters *letters, double em, int *above, int *below, int *line);
/// The width of the first `size` bytes of UTF-8 text, to its end at most; pixels.
int glint_letters_width(glint_letters *letters, double em, const char *text, size_t size);
/// Whether the font has a letter.
bool glint_letters_has(const glint_letters *letters, uint32_t code);
/// Draws the text into the mask, x its left end, y the row below the line that the letters stand on.
void glint_letters_draw(glint_letters *letters, double em, const char *text, size_t size, int x, int y, glint_mask *mask);

#endif
