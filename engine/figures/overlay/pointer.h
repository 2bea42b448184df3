/// Overlays that point at places in the world: their curves in the picture, and places for their texts. Internal.
#ifndef GLINT_OVERLAY_POINTER_H
#define GLINT_OVERLAY_POINTER_H

#include "engine/figures/overlay/overlay.h"

#define GLINT_ARC_POINTS 65 ///< points of an arc
#define GLINT_POINTER_POINTS (2 * GLINT_OVERLAY_POINTS_MAX) ///< most points: each piece of a polyline may be cut

/// The points of an overlay that points at the world, in order, as far as they lie in front of the camera: 1 for a
/// label, 2 for an arrow or a line, 65 for an arc, and all points of a polyline. The parameter of the curve through the
/// points is i at point i. Between points it grows evenly in the picture.
typedef struct glint_pointer {
    int count; ///< 0: nothing is drawn
    double world[GLINT_POINTER_POINTS][3];
    double pixel[GLINT_POINTER_POINTS][2]; ///< positions in pixels from the picture's upper left corner
    double depth[GLINT_POINTER_POINTS]; ///< along the view
    bool starts[GLINT_POINTER_POINTS]; ///< for a polyline: whether no piece leads to the point
    bool marked[GLINT_POINTER_POINTS]; ///< for a polyline: whether a dot is drawn at the point
    double range[2]; ///< first and last parameter to draw; for lines, limited to the part in and close to the picture
    bool behind[2]; ///< whether the start and the end of a line lie behind the camera; for an arc or a label both
        ///< flags are equal. For a polyline: whether a piece begins or ends behind the camera
} glint_pointer;

/// Computes the curve of an overlay that points.
void glint_pointer_find(const glint_overlays *overlays, const glint_overlay_desc *desc, glint_pointer *out);
/// Computes the parameters of the part of piece `i`, between points i and i + 1, that lies in or close to the
/// picture. Returns the length of that part in pixels; below 0: there is none.
double glint_pointer_piece(const glint_overlays *overlays, const glint_pointer *pointer, int i, double range[2]);
/// Returns whether an arrow or a line ends where it begins.
bool glint_pointer_is_point(const glint_overlay_desc *desc);
/// Returns the world point at a parameter of the curve.
void glint_pointer_at(const glint_pointer *pointer, bool orthographic, double at, double world[3]);
/// Returns the pixel position at a parameter of the curve.
void glint_pointer_pixel(const glint_pointer *pointer, double at, double pixel[2]);

/// An overlay's curve, and the rectangle in the picture of its text or, without a curve, of the whole overlay.
typedef struct glint_place {
    glint_pointer pointer; ///< the curve; its count is 0 if the overlay does not point at the world
    bool has_rect;
    double low[2], high[2]; ///< pixels
} glint_place;

struct glint_layout;

/// Draws the arrow, the line or the arc, without its text.
void glint_pointer_draw(const struct glint_layout *layout, double dpi);
/// Returns whether the text of a placed overlay that points is drawn.
bool glint_pointer_shows_text(const struct glint_layout *layout);
/// Sets the corner of a text whose size is known: a free position next to the point or curve of the overlay.
void glint_pointer_place(struct glint_layout *layout, double margin);

#endif
