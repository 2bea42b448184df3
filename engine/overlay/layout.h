/// Lays out one overlay as stamps. Internal.
#ifndef GLINT_OVERLAY_LAYOUT_H
#define GLINT_OVERLAY_LAYOUT_H

#include "engine/overlay/overlay.h"
#include "engine/text/typeface.h"

typedef struct glint_layout {
    const glint_overlays *overlays;
    const glint_overlay_desc *desc;
    glint_stamps *stamps;
    glint_typeface typeface;
    double em; ///< size of its letters, pixels
    double length; ///< of a colour bar or an axis, pixels
    int width, height; ///< of all that it draws, without what lies behind; pixels
    int corner[2], size[2]; ///< of the overlay with its background, in the picture; pixels
    int padding; ///< between the overlay and the edge of its background, pixels
    char text[GLINT_OVERLAY_TEXT_SIZE]; ///< of a label, its lines broken
} glint_layout;

/// Begins an overlay. letters  borrowed; NULL: the bitmap font.
glint_layout glint_layout_begin(const glint_overlays *overlays, const glint_overlay_desc *desc, double dpi, glint_letters *letters,
                                glint_stamps *stamps);
/// Measures an overlay and says where it lies; not of axes at a box.
void glint_layout_place(glint_layout *layout, double dpi);

/// Width of the widest line, and how many there are.
int glint_layout_measure(const glint_layout *layout, const char *text, int *lines);
/// Draws the lines of a text from x, y on, each at the share `align` of the room that a width leaves.
void glint_layout_text(const glint_layout *layout, const char *text, int x, int y, int width, double align,
                       const double color[3]);
/// A rectangle, cut off at the picture's borders.
void glint_layout_fill(const glint_layout *layout, int x, int y, int width, int height, const double color[3],
                       double opacity);
/// A mask for a rectangle, cut off at the picture's borders: *stamp says where it lies. False: nothing of it is left, or
/// there is no memory.
bool glint_layout_mask(const glint_layout *layout, int x, int y, int width, int height, glint_stamp *stamp);

/// A line with round ends, its edges smoothed, cut off at the picture's borders.
/// from   pixels from the picture's upper left corner.
/// way    to its other end; pixels.
/// half   of its thickness; pixels.
void glint_layout_line(const glint_layout *layout, const double from[2], const double way[2], double half, const double color[3]);

void glint_colorbar_measure(glint_layout *layout);
void glint_colorbar_draw(const glint_layout *layout, int x, int y);
void glint_axes_measure(glint_layout *layout);
void glint_axes_draw(const glint_layout *layout, int x, int y);
/// Axes at a box: where they lie is not the layout's to say.
void glint_box_axes_draw(const glint_layout *layout);

#endif
