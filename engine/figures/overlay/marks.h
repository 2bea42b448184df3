/// Numbers along a colour bar, an axis or a chart. Internal.
#ifndef GLINT_OVERLAY_MARKS_H
#define GLINT_OVERLAY_MARKS_H

#include "engine/figures/text/typeface.h"
#include "engine/glint_types.h"
#include "engine/glint_figures.h"

typedef struct glint_mark {
    double share; ///< position along the bar or axis: 0 at the first number, 1 at the last
    char text[32];
    int width; ///< width of the text, pixels
} glint_mark;

typedef struct glint_marks {
    glint_mark of[GLINT_OVERLAY_TICKS_MAX];
    int count;
    int widest; ///< widest text, pixels
} glint_marks;

/// A range of numbers along a straight line.
typedef struct glint_scale {
    double first, last; ///< numbers at the two ends, different; above 0 for a logarithmic scale
    bool is_log;
    bool is_across; ///< the line is horizontal
    double length, em; ///< length of the line and size of the letters, pixels
} glint_scale;

/// Returns the position of a number along a scale: 0 at the first number, 1 at the last.
double glint_scale_share(const glint_scale *scale, double value);
/// Adds a number on a scale. decimals: number of decimals shown; -1: as many as needed. Adds nothing when the list is
/// full.
void glint_marks_add(glint_marks *marks, const glint_typeface *typeface, const glint_scale *scale, double value, int decimals);
/// Replaces the marks by round numbers between first and last: multiples of 1, 2, 2.5 or 5 times a power of ten, in
/// at least `steps` steps, if that many marks fit. Returns the length of a step as a share of the range; 1: there are
/// only the first and the last number.
double glint_marks_round(glint_marks *marks, const glint_typeface *typeface, double first, double last, double steps);
/// Replaces the marks by about five round numbers, or on a logarithmic scale by powers of ten, as far as their texts
/// fit.
void glint_marks_fit(glint_marks *marks, const glint_typeface *typeface, const glint_scale *scale);

#endif
