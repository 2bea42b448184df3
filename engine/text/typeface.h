/// Letters of one size, drawn as coverage. Internal.
#ifndef GLINT_TEXT_TYPEFACE_H
#define GLINT_TEXT_TYPEFACE_H

#include "engine/text/letters.h"

typedef struct glint_typeface {
    glint_letters *letters; ///< borrowed; NULL: the bitmap font
    double em; ///< size of the letters, pixels
    int scale; ///< of the bitmap font: pixels of the picture for one of its own, >= 1
    int height; ///< of a line's letters, from the lowest to the highest point; pixels
    int above; ///< of that, above the line that they stand on
    int line; ///< from one line to the next, pixels
} glint_typeface;

/// em  size in pixels, 1 .. GLINT_SIDE_MAX; of the bitmap font the nearest multiple of its 13.
glint_typeface glint_typeface_open(glint_letters *letters, double em);
/// The width of the first `size` bytes of UTF-8 text, to its end at most; pixels.
int glint_typeface_width(const glint_typeface *typeface, const char *text, size_t size);
/// Whether the font has a letter.
bool glint_typeface_has(const glint_typeface *typeface, uint32_t code);
/// Draws the text into the mask, with its upper left corner at x, y; what falls outside is cut off.
void glint_typeface_draw(const glint_typeface *typeface, const char *text, size_t size, int x, int y, glint_mask *mask);

#endif
