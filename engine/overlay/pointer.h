/// Overlays that point at places in the world: their curves in the picture, and places for their texts. Internal.
#ifndef GLINT_OVERLAY_POINTER_H
#define GLINT_OVERLAY_POINTER_H

#include "engine/overlay/overlay.h"

#define GLINT_POINTER_POINTS 65 ///< of an arc

/// The points of an overlay that lie in front of the camera, in a row: 1 of a label, 2 of an arrow or a line, 65 of an
/// arc. The curve between them has a parameter that is i at point i and grows evenly in the picture between points.
typedef struct glint_pointer {
    int count; ///< 0: nothing is drawn
    double world[GLINT_POINTER_POINTS][3];
    double pixel[GLINT_POINTER_POINTS][2]; ///< from the picture's upper left corner
    double depth[GLINT_POINTER_POINTS]; ///< along the view
    double range[2]; ///< the parameters that are drawn: of lines, those in and close to the picture
    double length; ///< of that part of the curve, pixels
    bool behind[2]; ///< whether from and to lie behind the camera; of an arc or a label both are the same
} glint_pointer;

/// Computes the curve of an overlay that points.
void glint_pointer_find(const glint_overlays *overlays, const glint_overlay_desc *desc, glint_pointer *out);
/// Computes the parameters of the part of piece `i`, between points i and i + 1, that lies in or close to the picture.
/// Returns its length in pixels; below 0: no part does.
double glint_pointer_piece(const glint_overlays *overlays, const glint_pointer *pointer, int i, double range[2]);
/// Returns whether an arrow or a line ends where it begins.
bool glint_pointer_is_point(const glint_overlay_desc *desc);
/// Returns the point of the curve with a parameter.
void glint_pointer_at(const glint_pointer *pointer, bool orthographic, double at, double world[3]);
/// Returns the same point in the picture.
void glint_pointer_pixel(const glint_pointer *pointer, double at, double pixel[2]);

/// An overlay's curve, and the rectangle of its text or of all of it in the picture.
typedef struct glint_place {
    glint_pointer pointer; ///< of an overlay that does not point: count is 0
    bool has_rect;
    double low[2], high[2]; ///< pixels
} glint_place;

struct glint_layout;

/// Draws the arrow, the line or the arc, without its text.
void glint_pointer_draw(const struct glint_layout *layout, double dpi);
/// Returns whether the text of a placed overlay that points is drawn.
bool glint_pointer_shows_text(const struct glint_layout *layout);
/// Sets the corner of a text whose size is known: a free place next to what the overlay points at.
void glint_pointer_place(struct glint_layout *layout, double margin);

#endif
