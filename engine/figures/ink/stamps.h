/// Marks as stamps: rectangles of one colour, blended into rows of pixel values. Internal.
#ifndef GLINT_INK_STAMPS_H
#define GLINT_INK_STAMPS_H

#include "engine/figures/ink/ink.h"
#include "engine/glint.h"

/// A rectangle of one colour, in the pixel values of one picture.
typedef struct glint_stamp {
    int x, y, width, height; ///< rectangle in the whole picture, pixels; may lie outside the picture
    uint8_t *coverage; ///< width * height values; NULL: 255 everywhere. Owned
    uint8_t opacity; ///< factor of the coverage; 255: opaque
    uint16_t ink[3]; ///< pixel values of the colour
} glint_stamp;

/// Stamps in drawing order, for one picture.
typedef struct glint_stamps {
    glint_stamp *of;
    size_t count, capacity;
    bool lost; ///< out of memory: some stamps are missing
    glint_transfer transfer; ///< transfer function of the pixel values
    int bits; ///< bits of a pixel value: 8 or 16
} glint_stamps;

/// Returns the pixel value of a linear value. bits  8 or 16.
uint16_t glint_ink_code(double linear, glint_transfer transfer, int bits);
/// Makes the stamps of a page's marks. Nothing is left to free on failure.
glint_status glint_stamps_make(const glint_ink *ink, glint_transfer transfer, int bits, glint_stamps *out,
                               glint_error *error);
void glint_stamps_free(glint_stamps *stamps);
/// Adds a stamp of a linear colour. Takes over its coverage, which is freed at once if memory is short.
void glint_stamps_add(glint_stamps *stamps, glint_stamp stamp, const double color[3]);
/// Makes a mask for the part of a rectangle inside `clip`: *stamp receives the mask's position. False: they have no
/// common part, or out of memory.
bool glint_stamps_mask(glint_stamps *stamps, const glint_rect *clip, int x, int y, int width, int height,
                       glint_stamp *stamp);
/// Adds the stamps of strokes, antialiased as one shape. strokes.c
void glint_stamps_strokes(glint_stamps *stamps, const glint_ink_mark *mark);
/// Returns whether a stamp has a pixel in the `count` rows of the whole picture that begin with row `first`.
bool glint_stamps_touch(const glint_stamps *stamps, int first, int count);
/// Draws the stamps on a row of pixel values.
/// codes     `width` pixels of 3 or 4 channels, of the stamps' bits; alpha is not premultiplied.
/// x, y      of the first pixel, in the whole picture.
void glint_stamps_row(const glint_stamps *stamps, int x, int y, int width, int channels, void *codes);

#endif
