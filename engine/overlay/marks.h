/// Numbers beside a colour bar or along an axis. Internal.
#ifndef GLINT_OVERLAY_MARKS_H
#define GLINT_OVERLAY_MARKS_H

#include "engine/glint.h"
#include "engine/text/typeface.h"

typedef struct glint_mark {
    double share; ///< of the way from the first number to the last
    char text[32];
    int width; ///< of the text, pixels
} glint_mark;

typedef struct glint_marks {
    glint_mark of[GLINT_OVERLAY_TICKS_MAX];
    int count;
    int widest; ///< of their texts
} glint_marks;

/// Adds a number between first and last, which are not the same, with so many decimals; -1: as many as it needs. None beyond the
/// greatest count.
void glint_marks_add(glint_marks *marks, const glint_typeface *typeface, double first, double last, double value, int decimals);
/// Puts round numbers between first and last in their place: multiples of 1, 2, 2.5 or 5 times a power of ten, with at least `steps`
/// steps between them where there is room for that many marks. Returns a step's share of the way; 1: there are only first and last.
double glint_marks_round(glint_marks *marks, const glint_typeface *typeface, double first, double last, double steps);

#endif
