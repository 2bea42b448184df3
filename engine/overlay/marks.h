/// Numbers along a colour bar or an axis. Internal.
#ifndef GLINT_OVERLAY_MARKS_H
#define GLINT_OVERLAY_MARKS_H

#include "engine/glint.h"
#include "engine/text/typeface.h"

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

/// Adds a number between first and last, which must differ. decimals: number of decimals shown; -1: as many as
/// needed. Adds nothing when the list is full.
void glint_marks_add(glint_marks *marks, const glint_typeface *typeface, double first, double last, double value, int decimals);
/// Replaces the marks by round numbers between first and last: multiples of 1, 2, 2.5 or 5 times a power of ten, in
/// at least `steps` steps, if that many marks fit. Returns the length of a step as a share of the range; 1: there are
/// only the first and the last number.
double glint_marks_round(glint_marks *marks, const glint_typeface *typeface, double first, double last, double steps);

#endif
