#include "engine/overlay/marks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define NARROWEST 1e-290 ///< narrower ranges have steps below the smallest power of ten

/// Returns the largest step of 1, 2, 2.5 or 5 times a power of ten that is at most `most`, > 0 and finite. *decimals:
/// the decimals that its multiples need.
static double round_step(double most, int *decimals)
{
    static const double steps[] = { 5, 2.5, 2, 1 };
    int exponent = (int)floor(glint_log(most) / 2.302585092994046 + 1e-9), i = 0;
    const double power = glint_pow(10, exponent);
    while (i < 3 && steps[i] * power > most * (1 + 1e-9))
        i++;
    *decimals = (steps[i] == 2.5) - exponent;
    *decimals = *decimals < 0 ? 0 : *decimals;
    return steps[i] * power;
}

void glint_marks_add(glint_marks *marks, const glint_typeface *typeface, double first, double last, double value, int decimals)
{
    glint_mark *m = &marks->of[marks->count];
    if (marks->count == GLINT_OVERLAY_TICKS_MAX)
        return;
    m->share = (value - first) / (last - first);
    value = value == 0 ? 0 : value; // turns -0 into 0
    if (decimals < 0 || decimals > 6 || fabs(value) >= 1e7)
        snprintf(m->text, sizeof m->text, "%.6g", value);
    else
        snprintf(m->text, sizeof m->text, "%.*f", decimals, value);
    m->width = glint_typeface_width(typeface, m->text, strlen(m->text));
    marks->widest = m->width > marks->widest ? m->width : marks->widest;
    marks->count++;
}

double glint_marks_round(glint_marks *marks, const glint_typeface *typeface, double first, double last, double steps)
{
    const double low = fmin(first, last), high = fmax(first, last);
    int decimals;
    marks->count = marks->widest = 0;
    if (high - low <= NARROWEST) {
        glint_marks_add(marks, typeface, first, last, first, -1);
        glint_marks_add(marks, typeface, first, last, last, -1);
        return 1;
    }
    const double step = round_step((high - low) / steps, &decimals);
    for (double n = ceil(low / step - 1e-9); n * step <= high + 1e-9 * step && n + 1 > n && marks->count < GLINT_OVERLAY_TICKS_MAX; n++)
        glint_marks_add(marks, typeface, first, last, fmin(fmax(n * step, low), high), decimals);
    return step / (high - low);
}
