/// Letters of one size, drawn as coverage. Internal.
#ifndef GLINT_TEXT_TYPEFACE_H
#define GLINT_TEXT_TYPEFACE_H

#include <stddef.h>
#include <stdint.h>

/// How much of each pixel is covered: 0 .. 255, top row first.
typedef struct glint_mask {
    int width, height;
    uint8_t *coverage;
} glint_mask;

typedef struct glint_typeface {
    int scale; ///< pixels of the picture for one of the bitmap font, >= 1
    int height; ///< of a line's letters, pixels
    int line; ///< from one line to the next, pixels
} glint_typeface;

/// Letters about `pixels` high, from the lowest to the highest point.
glint_typeface glint_typeface_open(double pixels);
/// The width of the first `size` bytes of UTF-8 text, to its end at most; pixels.
int glint_typeface_width(const glint_typeface *typeface, const char *text, size_t size);
/// Draws the text into the mask, with its upper left corner at x, y; what falls outside is cut off.
void glint_typeface_draw(const glint_typeface *typeface, const char *text, size_t size, int x, int y, glint_mask *mask);

#endif
