/// The layout of a contact sheet: its measures, and its texts. Internal.
///
///     check.c      the description of a sheet
///     measure.c    the measures and the texts of a layout
///     sheet.c      the pictures, and the file
#ifndef GLINT_SHEET_LAYOUT_H
#define GLINT_SHEET_LAYOUT_H

#include "engine/figures/ink/ink.h"
#include "engine/glint_types.h"
#include "engine/glint_files.h"

#define GLINT_SHEET_INK 0x222222 // of texts
#define GLINT_SHEET_AXIS_BYTES 1000 // longest name of the columns or rows

/// The sheet's measures, in pixels.
typedef struct glint_sheet_layout {
    const glint_sheet_desc *desc;
    int width, height; ///< of each picture
    glint_ink ink; ///< everything except the pixels of pictures. Owned
    glint_typeface typeface, title; ///< typeface of labels; typeface of the title, which is twice as large
    int above, below; ///< extents of a line of labels or heads from its baseline, as large as the largest formula needs
    int title_width, title_height; ///< 0 without a title
    double unit; ///< pixels in a 13th of the label size
    int rows, blocks;
    int column, label; ///< width of a column; height of the label below a picture
    int difference; ///< height of the text below a difference; 0: no differences
    int column_head, row_head, block_head; ///< height of the heads above columns, width of the heads
        ///< next to rows, height of the heads above blocks; 0: none
    int left, top; ///< position of the first picture, without the head of its block
    int band; ///< height of a row of pictures together with its row of differences
    int gap;
    int note_lines; ///< at the bottom
    char note[160]; ///< text that explains the rows of differences, in parts
    glint_overlay_desc bar; ///< the sheet's colour bar, with lengths in pixels
    int bar_size[2];
    int64_t sheet_width, sheet_height;
} glint_sheet_layout;

/// Computes all measures. The size of the pictures and the ink are set.
void glint_sheet_measure(glint_sheet_layout *l);
/// Converts a length in 13ths of the label size to pixels.
int glint_sheet_pixels(const glint_sheet_layout *l, double units);
/// Returns the distance between lines of labels and heads.
int glint_sheet_line(const glint_sheet_layout *l);
/// Returns the width or height of the grid of pictures.
int64_t glint_sheet_grid(const glint_sheet_layout *l, bool across);
/// Writes the name of an axis, with an arrow.
void glint_sheet_axis(const char *name, char out[GLINT_SHEET_AXIS_BYTES + 8]);
int glint_sheet_axis_width(const glint_sheet_layout *l, const char *name); ///< of the name with its arrow

/// Converts a colour 0xRRGGBB to linear.
void glint_sheet_linear(uint32_t color, double out[3]);
/// Returns the width of the first `size` bytes of a text, in the typeface of labels.
int glint_sheet_text_width(const glint_sheet_layout *l, const char *text, size_t size);
/// Draws the first `size` bytes of a text with its upper left corner at x, y.
void glint_sheet_text(glint_sheet_layout *l, const glint_typeface *typeface, int x, int y, const char *text, size_t size,
                      glint_turn turn, uint32_t color);
/// Breaks `label` into lines at most `space` wide; parts share a line if they fit. If `draws`, draws the lines
/// from `y` down, centred between `x` and `x` + `space`. Returns the number of lines.
int glint_sheet_label(glint_sheet_layout *l, const char *label, int space, bool draws, int x, int y);

/// Checks the description of a sheet.
glint_status glint_sheet_check(const glint_sheet_desc *desc, const char *path, glint_error *error);
/// Checks the size of the measured sheet.
glint_status glint_sheet_check_sides(const glint_sheet_layout *l, glint_error *error);

#endif
