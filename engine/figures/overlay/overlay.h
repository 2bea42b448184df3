/// Overlays, drawn over a finished picture: labels, colour bars, axes, arrows, lines, arcs, polylines, charts.
/// Internal.
///
///     overlay.c    the described objects, checked
///     overlays.c   all overlays of one frame, for a plan and its image; their key
///     hidden.c     the parts of curves, and the points of labels, that surfaces hide
///     layout.c     the position of each; colorbar.c, axes.c, box_axes.c: their parts
///     fit.c        sizes for a page: legible letters, and texts and bars that fit the page
///     chart.c      charts; curves.c: their curves, which overlays share
///     marks.c      the round numbers along colour bars, axes and charts
///     pointer.c    the curves of arrows, lines, arcs and polylines in the picture, and positions for texts next to them
///     drawing.c    texts, rectangles and strokes, in the ink of engine/figures/ink
///     faults.c     warnings about overlays that the picture cannot show
#ifndef GLINT_OVERLAY_H
#define GLINT_OVERLAY_H

#include "engine/figures/ink/ink.h"
#include "engine/film/cover.h"
#include "engine/glint_figures.h"

/// The parts of a curve that surfaces hide: `count` intervals of the parameter of glint_pointer_at, ascending.
typedef struct glint_hidden_parts {
    size_t count;
    double (*of)[2]; ///< owned
} glint_hidden_parts;

/// The overlays of one frame. Immutable, reference counted; any thread.
typedef struct glint_overlays {
    glint_cover base;
    int width, height; ///< size of the whole picture, pixels
    double view[3][3]; ///< unit vectors to the right, up and away from the eye
    glint_cover_camera camera;
    glint_key letters; ///< see glint_letters_key
    double scale; ///< pixels per pixel of the script's own picture: 1, except on a page
    double least; ///< smallest size of letters on a page, pixels; 0: none
    double enlarged; ///< factor of all sizes, so that the smallest letters have the size `least`, >= 1
    glint_hidden_parts *hidden; ///< hidden parts of each overlay's curve; NULL: none are hidden, or they are not
        ///< known yet. Owned
    size_t count;
    glint_overlay_desc of[]; ///< in drawing order
} glint_overlays;

extern const char *const glint_overlay_kinds[]; ///< "label", ...

/// Returns whether an overlay points at places in the world: an arrow, line, arc or polyline, or a label at a point.
static inline bool glint_overlay_points(const glint_overlay_desc *desc)
{
    return (desc->kind >= GLINT_OVERLAY_ARROW && desc->kind != GLINT_OVERLAY_CHART) || (desc->kind == GLINT_OVERLAY_LABEL && desc->has_point);
}

extern const glint_cover_maker glint_overlay_maker; ///< the functions of all overlays, see engine/film/cover.h
glint_status glint_overlays_take(glint_overlay *const *all, size_t count, int width, int height, const glint_cover_camera *camera,
                                 glint_cover **out, glint_error *error);
glint_status glint_overlays_hide(glint_cover *cover, const glint_sights *sights, glint_cover **out, glint_error *error);
glint_status glint_overlays_check(const glint_cover *cover, double dpi, void (*warns)(void *context, const char *message),
                                  void *context, glint_error *error);
glint_key glint_overlays_key(const glint_cover *cover, glint_key key);
void glint_overlays_free(glint_cover *cover);
/// Returns a copy with `hidden` of `count` empty rows, to be filled in by the caller. NULL: out of memory.
glint_overlays *glint_overlays_copy(const glint_overlays *overlays);
/// Returns a copy for a page of another size, with the hidden parts. NULL: out of memory.
/// factor  width and height of the page, in those of the picture.
/// scale   factor of the positions of overlays, which are in pixels of the script's own picture.
/// least   smallest size of letters, pixels.
/// dpi     of the page; 0: not given.
glint_overlays *glint_overlays_resize(const glint_overlays *overlays, const double factor[2], double scale, double least, double dpi);
/// Returns the factor of all sizes for which the letters have at least the size overlays->least, >= 1.
double glint_overlays_enlargement(const glint_overlays *overlays, double dpi);

/// Draws the overlays on a page of the size of the whole picture.
/// dpi  pixels per inch; 0: not given.
glint_status glint_overlays_draw(const glint_overlays *overlays, double dpi, glint_ink *ink, glint_error *error);
/// Measures a separate colour bar whose lengths are in pixels. size  out: width and height.
void glint_colorbar_measure_alone(const glint_overlay_desc *desc, glint_ink *ink, int size[2]);
/// Draws a separate colour bar whose upper left corner is x, y.
void glint_colorbar_draw_alone(const glint_overlay_desc *desc, glint_ink *ink, int x, int y);

#endif
