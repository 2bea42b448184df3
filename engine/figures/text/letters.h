/// The font of texts, drawn by FreeType. Internal.
///
/// The environment variable GLINT_FONT is the path of a font, or "bitmap". Without it, the font is DejaVu Sans, at the
/// first of several system paths where it exists. If it exists at none of them, or if the build has no FreeType, the
/// font is the bitmap font of font.h.
#ifndef GLINT_TEXT_LETTERS_H
#define GLINT_TEXT_LETTERS_H

#include "engine/base/hash.h"
#include "engine/figures/text/mask.h"
#include "engine/glint_types.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct glint_letters glint_letters; ///< an open font; used by one thread at a time

/// A run of letters of one size and shape.
typedef struct glint_run {
    const char *text; ///< UTF-8; borrowed
    size_t size; ///< bytes; the text may end earlier with NUL
    double x, y; ///< left end of the baseline, from the upper left corner of a mask or the baseline of a line; pixels
    double em; ///< font size, pixels
    double slant; ///< pixels to the right for each pixel of height; 0: upright
    double stretch; ///< factor of the letters' height; 1: none
    bool bold;
    bool is_accent; ///< a sign above a letter, which an .svg draws as a path: alone it may be a combining character
} glint_run;

/// The rectangle that the letters of a run cover: distances from the left end of the baseline, pixels.
typedef struct glint_run_box {
    double left, right; ///< to the right
    double above; ///< to the top, upwards
    double below; ///< to the bottom, downwards
} glint_run_box;

/// *out NULL: the bitmap font. GLINT_ERR_INVALID: GLINT_FONT names a file that is not a font.
glint_status glint_letters_open(glint_letters **out, glint_error *error);
void glint_letters_close(glint_letters *letters); ///< NULL: no effect
/// Returns whether memory was short at some point, so that text was measured or drawn incompletely.
bool glint_letters_lost(const glint_letters *letters);
/// Returns a key of everything, except the text, that the pixels of a text depend on: the font, and the version of
/// the library.
glint_key glint_letters_key(const glint_letters *letters);

/// A letter of a run, for output as vectors.
typedef struct glint_letter {
    uint32_t glyph; ///< its number in the font's file; of the bitmap font, its Unicode code
    uint32_t code; ///< its Unicode code; U+FFFD for an invalid byte
    double x; ///< where the letter begins; pixels from the start of the run
} glint_letter;

/// The font's file and its names. The strings are borrowed.
typedef struct glint_font_name {
    const char *path;
    const char *family; ///< "DejaVu Sans"
    bool bold, italic;
} glint_font_name;

/// Returns the names of an open font.
glint_font_name glint_letters_name(const glint_letters *letters);

/// Returns "FreeType 2.12.1", a static string; NULL: the build has no FreeType.
const char *glint_letters_library(void);

/// Returns the pixels above and below the baseline that letters of `em` pixels take, and the distance between lines.
void glint_letters_measure(glint_letters *letters, double em, int *above, int *below, int *line);
/// Returns the width of the first `size` bytes of UTF-8 text, at most to its end; pixels.
int glint_letters_width(glint_letters *letters, double em, const char *text, size_t size);
/// Places the letters of a run and returns the width of the run, pixels.
/// out  written: glint_font_count(run->text, run->size) letters.
double glint_letters_place(glint_letters *letters, const glint_run *run, glint_letter *out);
/// Returns by how many pixels the strokes of a run are wider than the font's; 0 unless the run is bold.
double glint_letters_growth(const glint_run *run);
/// Returns whether the font has a letter.
bool glint_letters_has(const glint_letters *letters, uint32_t code);
/// Returns the width of a run, pixels.
double glint_letters_advance(glint_letters *letters, const glint_run *run);
/// Returns the rectangle that a run covers; all zero for a run without visible letters.
glint_run_box glint_letters_box(glint_letters *letters, const glint_run *run);
/// Takes a part of an outline: `command` is M, L, Q or C as in SVG, with 1, 1, 2 or 3 points.
typedef void glint_outline_part(void *context, char command, int count, const double points[3][2]);
/// Calls `put` for the outline of each letter of a run at its x and y; pixels, y downwards.
void glint_letters_outline(glint_letters *letters, const glint_run *run, glint_outline_part *put, void *context);
/// Draws a run into the mask, clipped to the mask. The baseline is the upper edge of row y.
void glint_letters_draw(glint_letters *letters, const glint_run *run, glint_mask *mask);

#endif
