/// Drawings: texts, rectangles and strokes, recorded in drawing order and then drawn as pixels or as vectors. Internal.
///
///     ink.c      the recorded marks
///     strokes.c  the coverage of strokes
///     stamp.c    marks as stamps, on rows of pixel values
///
/// Overlays, sheets and charts draw with these functions only. A .png takes the stamps; engine/files/vector/svg.c and pdf.c
/// take the marks, at the same positions. To draw a figure:
///
///     glint_ink ink;
///     glint_status status = glint_ink_open(640, 360, &ink, error);
///     const glint_typeface typeface = glint_typeface_open(ink.letters, 12);
///     glint_ink_fill(&ink, 40, 320, 560, 1, black, 1);
///     glint_ink_text(&ink, &typeface, "x", SIZE_MAX, 40, 324, GLINT_LEVEL, black);
///     ...
///     glint_ink_close(&ink);
///
/// Lengths are in pixels and colours are linear. Marks are drawn over each other in their order.
#ifndef GLINT_INK_H
#define GLINT_INK_H

#include "engine/figures/text/line.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct glint_stroke {
    double from[2], offset[2]; ///< one end of the stroke, from the picture's upper left corner; the vector to its
        ///< other end; pixels
} glint_stroke;

/// Strokes with round ends and an arrowhead.
typedef struct glint_strokes {
    glint_stroke *of; ///< freed by the caller
    size_t count, capacity;
    double half; ///< half of the strokes' width; pixels
    bool has_head;
    double head[3][2]; ///< the corners of the arrowhead; pixels
    bool lost; ///< out of memory: some strokes are missing
} glint_strokes;

void glint_strokes_add(glint_strokes *strokes, const double from[2], const double to[2]);

typedef struct glint_rect {
    int x, y, width, height; ///< upper left corner and size, pixels
} glint_rect;

/// The direction in which a text runs: to the right, down (turned a quarter clockwise), or up.
typedef enum glint_turn { GLINT_LEVEL, GLINT_DOWN, GLINT_UP } glint_turn;

typedef enum glint_mark_kind { GLINT_MARK_FILL, GLINT_MARK_TEXT, GLINT_MARK_STROKES } glint_mark_kind;

typedef struct glint_ink_mark {
    glint_mark_kind kind;
    double color[3]; ///< linear
    double opacity; ///< 0 .. 1
    glint_rect clip; ///< the mark is drawn only inside; inside the page
    glint_rect box; ///< rectangle of a fill, or box of a text with the line's pad at both ends; its width is measured
        ///< along the text unless the text is turned
    char *text; ///< of a text: UTF-8, one line; glint_line_set computes its runs and rules. Owned
    glint_typeface typeface; ///< of a text
    glint_turn turn; ///< of a text
    glint_strokes strokes; ///< owned
} glint_ink_mark;

/// A page with marks.
typedef struct glint_ink {
    int width, height; ///< size of the page, pixels
    glint_letters *letters; ///< the font of all texts. Owned; NULL: the bitmap font
    glint_rect clip; ///< clip rectangle of the next marks
    glint_ink_mark *of; ///< in drawing order
    size_t count, capacity;
    bool lost; ///< out of memory: some marks are missing
} glint_ink;

/// Begins an empty page. On failure there is nothing to close.
glint_status glint_ink_open(int width, int height, glint_ink *out, glint_error *error);
/// Changes the size of a page without marks, for a figure whose texts are measured first.
void glint_ink_resize(glint_ink *ink, int width, int height);
/// Frees the marks and closes the font.
void glint_ink_close(glint_ink *ink);
/// Returns GLINT_ERR_NOMEM if some marks are missing.
glint_status glint_ink_check(const glint_ink *ink, glint_error *error);

/// Clips the next marks to a rectangle. NULL: to the page.
void glint_ink_clip(glint_ink *ink, const glint_rect *rect);
/// Fills a rectangle. opacity  0 .. 1.
void glint_ink_fill(glint_ink *ink, int x, int y, int width, int height, const double color[3], double opacity);
/// Draws the first `size` bytes of UTF-8 text, at most to its end, as a line that may contain formulas.
/// x, y  upper left corner of the line, whose size glint_line_set computes; for a turned text, upper left corner of the
///       turned box.
void glint_ink_text(glint_ink *ink, const glint_typeface *typeface, const char *text, size_t size, int x, int y, glint_turn turn,
                    const double color[3]);
/// Draws strokes as one antialiased shape. Copies the strokes.
void glint_ink_strokes(glint_ink *ink, const glint_strokes *strokes, const double color[3]);

#endif
