/// The font of texts, drawn by FreeType. Internal.
///
/// The environment variable GLINT_FONT is the path of a font, or "bitmap". Without it, the font is DejaVu Sans, at the
/// first of several system paths where it exists. If it exists at none of them, or if the build has no FreeType, the
/// font is the bitmap font of font.h.
#ifndef GLINT_TEXT_LETTERS_H
#define GLINT_TEXT_LETTERS_H

#include "engine/base/hash.h"
#include "engine/glint.h"
#include "engine/text/mask.h"

typedef struct glint_letters glint_letters; ///< an open font; used by one thread at a time

/// *out NULL: the bitmap font. GLINT_ERR_INVALID: GLINT_FONT names a file that is not a font.
glint_status glint_letters_open(glint_letters **out, glint_error *error);
void glint_letters_close(glint_letters *letters); ///< NULL: no effect
/// Returns whether memory was short at some point, so that text was measured or drawn incompletely.
bool glint_letters_lost(const glint_letters *letters);
/// Returns a key of everything, except the text, that the pixels of a text depend on: the font, and the version of
/// the library.
glint_key glint_letters_key(const glint_letters *letters);

/// Returns "FreeType 2.12.1", a static string; NULL: the build has no FreeType.
const char *glint_letters_library(void);

/// Returns the pixels above and below the baseline that letters of `em` pixels take, and the distance between lines.
void glint_letters_measure(glint_letters *letters, double em, int *above, int *below, int *line);
/// Returns the width of the first `size` bytes of UTF-8 text, at most to its end; pixels.
int glint_letters_width(glint_letters *letters, double em, const char *text, size_t size);
/// Returns whether the font has a letter.
bool glint_letters_has(const glint_letters *letters, uint32_t code);
/// Draws the text into the mask. x: the left end of the text; y: the row just below the baseline.
void glint_letters_draw(glint_letters *letters, double em, const char *text, size_t size, int x, int y, glint_mask *mask);

#endif
