/// Letters of one size, drawn as coverage masks. Internal.
#ifndef GLINT_TEXT_TYPEFACE_H
#define GLINT_TEXT_TYPEFACE_H

#include "engine/figures/text/letters.h"

typedef struct glint_typeface {
    glint_letters *letters; ///< borrowed; NULL: the bitmap font
    double em; ///< font size, pixels
    double least; ///< smallest font size of scripts in formulas, unless `em` is smaller, pixels
    int scale; ///< for the bitmap font: picture pixels per font pixel, >= 1
    int height; ///< height from the lowest to the highest point of letters; pixels
    int above; ///< the part of `height` above the baseline; pixels
    int line; ///< distance between lines, pixels
} glint_typeface;

/// em  font size in pixels, 1 .. GLINT_SIDE_MAX; for the bitmap font rounded to a multiple of 13.
glint_typeface glint_typeface_open(glint_letters *letters, double em);
/// Returns the width of the first `size` bytes of UTF-8 text, at most to its end; pixels.
int glint_typeface_width(const glint_typeface *typeface, const char *text, size_t size);
/// Places the letters of a run and returns the width of the run, pixels.
/// out  written: glint_font_count(run->text, run->size) letters.
double glint_typeface_place(const glint_typeface *typeface, const glint_run *run, glint_letter *out);
/// Returns the picture pixels for each pixel of the bitmap font.
int glint_typeface_scale(double em);
/// Returns whether the font has a letter.
bool glint_typeface_has(const glint_typeface *typeface, uint32_t code);
/// Returns the width of a run, pixels.
double glint_typeface_advance(const glint_typeface *typeface, const glint_run *run);
/// Returns the rectangle that a run covers; all zero for a run without visible letters.
glint_run_box glint_typeface_box(const glint_typeface *typeface, const glint_run *run);
/// Draws a run into the mask, clipped to the mask. The bitmap font rounds the size to a multiple of 13 and the position
/// to pixels, and has no slant.
void glint_typeface_draw(const glint_typeface *typeface, const glint_run *run, glint_mask *mask);

#endif
