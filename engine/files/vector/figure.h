/// Figures: pixel values with marks over them, as a .png, .svg or .pdf of the same look. Internal.
///
/// In a .svg and a .pdf, the picture is a bitmap and the marks are vectors; text can be selected. A page has
/// 72 / dpi points for each pixel. There are no dates and no random numbers in the files.
#ifndef GLINT_FILE_FIGURE_H
#define GLINT_FILE_FIGURE_H

#include "engine/figures/ink/ink.h"
#include "engine/files/picture/png.h"
#include "engine/files/picture/write.h"

typedef struct glint_figure {
    const glint_png_source *source; ///< the pixel values below the marks
    const glint_ink *ink; ///< the marks, on the whole page; NULL: none
    int x, y; ///< position of the first pixel of `source` on the page
} glint_figure;

/// Returns whether the format has marks as vectors.
static inline bool glint_file_is_vector(glint_file_kind kind)
{
    return kind == GLINT_FILE_SVG || kind == GLINT_FILE_PDF;
}

/// Appends a .png, .svg or .pdf to `out`, which may have grown on failure. GLINT_ERR_UNSUPPORTED: this build cannot
/// write .pdf.
glint_status glint_figure_encode(const glint_figure *figure, glint_file_kind kind, const glint_png_desc *desc,
                                 glint_bytes *out, glint_error *error);
/// Writes a figure to a file whose ending chooses the format.
glint_status glint_figure_write(const glint_figure *figure, const char *path, const glint_png_desc *desc,
                                glint_error *error);

/// Appends an .svg: a page of the size of the figure's pixels. svg.c
glint_status glint_svg_encode(const glint_figure *figure, const glint_png_desc *desc, glint_bytes *out,
                              glint_error *error);
/// Appends an SVG element that has only the marks. svg.c
/// box  the visible part of the page: x, y, width and height.
glint_status glint_svg_encode_marks(const glint_ink *ink, const double box[4], glint_transfer transfer, glint_bytes *out,
                                    glint_error *error);
/// Appends a .pdf of one page, of 8-bit sRGB values. pdf.c
glint_status glint_pdf_encode(const glint_figure *figure, const glint_png_desc *desc, glint_bytes *out,
                              glint_error *error);

/// Returns points per pixel.
static inline double glint_figure_unit(const glint_png_desc *desc) { return desc->dpi > 0 ? 72 / desc->dpi : 1; }

#endif
