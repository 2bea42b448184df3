/// Layout of one overlay as stamps. Internal.
#ifndef GLINT_OVERLAY_LAYOUT_H
#define GLINT_OVERLAY_LAYOUT_H

#include "engine/overlay/overlay.h"
#include "engine/text/typeface.h"

typedef struct glint_layout {
    const glint_overlays *overlays;
    const glint_overlay_desc *desc;
    glint_stamps *stamps;
    glint_typeface typeface;
    double em; ///< font size, pixels
    double length; ///< of a colour bar or an axis, pixels
    int width, height; ///< of everything drawn, without the background; pixels
    int corner[2], size[2]; ///< of the overlay with its background, position and size in the picture; pixels
    int padding; ///< between the overlay and the edge of its background, pixels
    char text[GLINT_OVERLAY_TEXT_SIZE]; ///< of a label, wrapped
} glint_layout;

/// Begins an overlay. letters  borrowed; NULL: the bitmap font.
glint_layout glint_layout_begin(const glint_overlays *overlays, const glint_overlay_desc *desc, double dpi, glint_letters *letters,
                                glint_stamps *stamps);
/// Measures an overlay and finds its position; not for axes at a box.
void glint_layout_place(glint_layout *layout, double dpi);

/// Returns the width of the widest line, and the number of lines.
int glint_layout_measure(const glint_layout *layout, const char *text, int *lines);
/// Draws the lines of a text from x, y on. Each is placed at the share `align`, 0 .. 1, of the space that it leaves
/// free in `width`.
void glint_layout_text(const glint_layout *layout, const char *text, int x, int y, int width, double align,
                       const double color[3]);
/// Fills a rectangle, clipped to the picture.
void glint_layout_fill(const glint_layout *layout, int x, int y, int width, int height, const double color[3],
                       double opacity);
/// Makes a mask for a rectangle, clipped to the picture: *stamp has its position. False: the rectangle is outside, or
/// out of memory.
bool glint_layout_mask(const glint_layout *layout, int x, int y, int width, int height, glint_stamp *stamp);

/// Draws an antialiased line with round ends, clipped to the picture.
/// from   pixels from the picture's upper left corner.
/// way    vector to the other end; pixels.
/// half   half the thickness; pixels.
void glint_layout_line(const glint_layout *layout, const double from[2], const double offset[2], double half,
                       const double color[3]);

void glint_colorbar_measure(glint_layout *layout);
void glint_colorbar_draw(const glint_layout *layout, int x, int y);
void glint_axes_measure(glint_layout *layout);
void glint_axes_draw(const glint_layout *layout, int x, int y);
/// Draws axes at a box, which have no position of their own.
void glint_box_axes_draw(const glint_layout *layout);

#endif
