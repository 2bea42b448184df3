/// Layout of one overlay. Internal.
#ifndef GLINT_OVERLAY_LAYOUT_H
#define GLINT_OVERLAY_LAYOUT_H

#include "engine/figures/ink/ink.h"
#include "engine/figures/overlay/overlay.h"
#include "engine/figures/overlay/pointer.h"
#include "engine/glint_figures.h"

typedef struct glint_layout {
    const glint_overlays *overlays;
    const glint_overlay_desc *desc;
    glint_ink *ink; ///< the overlay is drawn there. Borrowed; its font is the overlay's
    glint_place *places; ///< curves and text positions of all overlays; NULL: no overlay points at the world. Borrowed
    glint_place *place; ///< this overlay's entry in `places`; NULL without `places`
    const glint_hidden_parts *hidden; ///< hidden parts of the overlay's curve; NULL: none
    glint_typeface typeface;
    double dpi; ///< pixels per inch; 0: not given
    double em; ///< font size, pixels
    double length; ///< length of a colour bar or an axis, pixels
    double extent[2]; ///< width and height of a chart, pixels
    int width, height; ///< size of everything drawn, without the background; pixels
    int corner[2], size[2]; ///< position and size of the overlay with its background in the picture; pixels
    int padding; ///< padding between the overlay and the edge of its background, pixels
    char text[GLINT_OVERLAY_TEXT_SIZE]; ///< text of a label, wrapped
} glint_layout;

/// Computes the curves of a frame's overlays that point at the world, and the rectangles of those that do not, which
/// their texts must not cover. *out is NULL if no overlay points at the world; otherwise the caller frees it.
/// ink  its font is the overlays'; nothing is drawn.
glint_status glint_layout_places(const glint_overlays *overlays, double dpi, glint_ink *ink, glint_place **out,
                                 glint_error *error);
/// Begins overlay number `i` of a frame. places: the result of glint_layout_places.
glint_layout glint_layout_begin_at(const glint_overlays *overlays, size_t i, double dpi, glint_place *places, glint_ink *ink);
/// Begins an overlay.
glint_layout glint_layout_begin(const glint_overlays *overlays, const glint_overlay_desc *desc, double dpi, glint_ink *ink);
/// Converts a length in points to pixels, at most the largest side of a picture.
double glint_layout_pixels(double points, double dpi);
/// Returns the size of an overlay's letters before overlays->enlarged; pixels.
double glint_layout_own_size(const glint_overlays *overlays, const glint_overlay_desc *desc, double dpi);
/// Breaks and shrinks the formulas of a text that is wider than the page.
void glint_layout_fit_text(glint_layout *layout);
/// Measures a colour bar. On a page, shortens a bar that is longer than the page.
void glint_layout_measure_bar(glint_layout *layout, double margin);
/// Measures an overlay and finds its position; for an overlay that points at the world, the position of its text. Not
/// for axes at a box.
void glint_layout_place(glint_layout *layout, double dpi);

/// Returns the width of a line of `size` bytes, and its height.
int glint_layout_line_size(const glint_layout *layout, const char *text, size_t size, int *height);
/// Returns the width of the widest line, and the distance from the top of the first line to the top of a line below the
/// last one; pixels.
int glint_layout_measure(const glint_layout *layout, const char *text, int *advance);
/// Draws the lines of a text; the top left of the first is x, y. `align` is 0 to align each line on the left of
/// `width`, 0.5 to centre it, and 1 to align it on the right.
void glint_layout_text(const glint_layout *layout, const char *text, int x, int y, int width, double align,
                       const double color[3]);
/// Fills a rectangle, clipped to the picture.
void glint_layout_fill(const glint_layout *layout, int x, int y, int width, int height, const double color[3],
                       double opacity);
/// Draws the strokes as one antialiased shape, clipped to the picture.
void glint_layout_strokes(const glint_layout *layout, const glint_strokes *strokes, const double color[3]);
/// Draws an antialiased line with round ends, clipped to the picture.
/// from   pixels from the picture's upper left corner.
/// offset vector to the other end; pixels.
/// half   half the thickness; pixels.
void glint_layout_line(const glint_layout *layout, const double from[2], const double offset[2], double half,
                       const double color[3]);

void glint_colorbar_measure(glint_layout *layout);
void glint_colorbar_draw(const glint_layout *layout, int x, int y);
void glint_chart_measure(glint_layout *layout);
/// Returns whether a measured chart has space for its curves.
bool glint_chart_fits(const glint_layout *layout);
void glint_chart_draw(const glint_layout *layout, int x, int y);
void glint_axes_measure(glint_layout *layout);
void glint_axes_draw(const glint_layout *layout, int x, int y);
/// Draws axes at a box. The box determines their position.
void glint_box_axes_draw(const glint_layout *layout);

#endif
