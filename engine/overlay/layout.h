/// Layout of one overlay as stamps. Internal.
#ifndef GLINT_OVERLAY_LAYOUT_H
#define GLINT_OVERLAY_LAYOUT_H

#include "engine/overlay/overlay.h"
#include "engine/overlay/pointer.h"
#include "engine/text/typeface.h"

typedef struct glint_layout {
    const glint_overlays *overlays;
    const glint_overlay_desc *desc;
    glint_stamps *stamps;
    glint_place *places; ///< curves and text positions of all overlays; NULL: no overlay points at the world. Borrowed
    glint_place *place; ///< of this one
    const glint_hidden_parts *hidden; ///< hidden parts of the overlay's curve; NULL: none
    glint_typeface typeface;
    double em; ///< font size, pixels
    double length; ///< length of a colour bar or an axis, pixels
    int width, height; ///< size of everything drawn, without the background; pixels
    int corner[2], size[2]; ///< position and size of the overlay with its background in the picture; pixels
    int padding; ///< padding between the overlay and the edge of its background, pixels
    char text[GLINT_OVERLAY_TEXT_SIZE]; ///< text of a label, wrapped
} glint_layout;

/// Computes the places (curves and text positions) of a frame's overlays. *out is NULL if no overlay points at the
/// world; otherwise the caller frees it.
glint_status glint_layout_places(const glint_overlays *overlays, glint_place **out, glint_error *error);
/// Begins overlay number `i` of a frame. letters: borrowed; NULL: the bitmap font. places: the result of
/// glint_layout_places.
glint_layout glint_layout_begin_at(const glint_overlays *overlays, size_t i, double dpi, glint_letters *letters,
                                   glint_place *places, glint_stamps *stamps);
/// Begins an overlay. letters  borrowed; NULL: the bitmap font.
glint_layout glint_layout_begin(const glint_overlays *overlays, const glint_overlay_desc *desc, double dpi, glint_letters *letters,
                                glint_stamps *stamps);
/// Converts a length in points to pixels, at most the largest side of a picture.
double glint_layout_pixels(double points, double dpi);
/// Measures an overlay and finds its position; for an overlay that points at the world, the position of its text. Not
/// for axes at a box.
void glint_layout_place(glint_layout *layout, double dpi);

/// Returns the width of the widest line, and the number of lines.
int glint_layout_measure(const glint_layout *layout, const char *text, int *lines);
/// Draws the lines of a text; the top left of the first is x, y. `align` is 0 to align each line on the left of
/// `width`, 0.5 to centre it, and 1 to align it on the right.
void glint_layout_text(const glint_layout *layout, const char *text, int x, int y, int width, double align,
                       const double color[3]);
/// Fills a rectangle, clipped to the picture.
void glint_layout_fill(const glint_layout *layout, int x, int y, int width, int height, const double color[3],
                       double opacity);
/// Makes a mask for a rectangle, clipped to the picture: *stamp receives the mask's position. False: the rectangle is
/// outside the picture, or out of memory.
bool glint_layout_mask(const glint_layout *layout, int x, int y, int width, int height, glint_stamp *stamp);

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
void glint_axes_measure(glint_layout *layout);
void glint_axes_draw(const glint_layout *layout, int x, int y);
/// Draws axes at a box. The box determines their position.
void glint_box_axes_draw(const glint_layout *layout);

#endif
