#include "engine/base/number.h"
#include "engine/figures/overlay/marks.h"
#include "engine/glint_math.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define WANTED 4 ///< smallest number of steps between round numbers
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

double glint_scale_share(const glint_scale *scale, double value)
{
    const double ratio = scale->last / scale->first;
    if (scale->is_log && ratio > 0 && ratio <= DBL_MAX)
        return glint_log(value / scale->first) / glint_log(ratio);
    if (scale->is_log) // the ratio of a range of more than 308 powers of ten overflows
        return (glint_log(value) - glint_log(scale->first)) / (glint_log(scale->last) - glint_log(scale->first));
    return (value - scale->first) / (scale->last - scale->first);
}

void glint_marks_add(glint_marks *marks, const glint_typeface *typeface, const glint_scale *scale, double value, int decimals)
{
    glint_mark *m = &marks->of[marks->count];
    if (marks->count == GLINT_OVERLAY_TICKS_MAX)
        return;
    m->share = glint_scale_share(scale, value);
    value = value == 0 ? 0 : value; // turns -0 into 0
    if (decimals < 0 || decimals > 6 || fabs(value) >= 1e7)
        glint_print(m->text, sizeof m->text, "%.6g", value);
    else
        glint_print(m->text, sizeof m->text, "%.*f", decimals, value);
    m->width = glint_typeface_width(typeface, m->text, strlen(m->text));
    marks->widest = m->width > marks->widest ? m->width : marks->widest;
    marks->count++;
}

double glint_marks_round(glint_marks *marks, const glint_typeface *typeface, double first, double last, double steps)
{
    const glint_scale scale = { .first = first, .last = last };
    const double low = fmin(first, last), high = fmax(first, last);
    int decimals;
    marks->count = marks->widest = 0;
    if (high - low <= NARROWEST) {
        glint_marks_add(marks, typeface, &scale, first, -1);
        glint_marks_add(marks, typeface, &scale, last, -1);
        return 1;
    }
    const double step = round_step((high - low) / steps, &decimals);
    for (double n = ceil(low / step - 1e-9); n * step <= high + 1e-9 * step && n + 1 > n && marks->count < GLINT_OVERLAY_TICKS_MAX; n++)
        glint_marks_add(marks, typeface, &scale, fmin(fmax(n * step, low), high), decimals);
    return step / (high - low);
}

/// Returns the smallest distance between the middles of neighbouring numbers, in pixels.
static double pitch(const glint_marks *marks, const glint_typeface *typeface, const glint_scale *scale)
{
    return scale->is_across ? marks->widest + scale->em : typeface->height * 1.25;
}

/// Marks the powers of ten. If there are few of them, also marks two and five times each; if there are many, marks
/// only every second, third and so on; if there are none, marks the ends of the scale.
static void find_powers(glint_marks *marks, const glint_typeface *typeface, const glint_scale *scale)
{
    static const double factors[] = { 1, 2, 5 };
    const double low = fmin(scale->first, scale->last), high = fmax(scale->first, scale->last), ten = glint_log(10);
    const int first = (int)ceil(glint_log(low) / ten - 1e-9), last = (int)floor(glint_log(high) / ten + 1e-9);
    const double decades = (glint_log(high) - glint_log(low)) / ten;
    const int factor_count = last - first < 2 ? 3 : 1;
    int step = (last - first) / (GLINT_OVERLAY_TICKS_MAX - 1) + 1;
    marks->count = 0;
    marks->widest = glint_typeface_width(typeface, "1e+00", 5);
    while (step < last - first && step / decades * scale->length < pitch(marks, typeface, scale))
        step++;
    marks->widest = 0;
    for (int e = first - 1; e <= last; e += factor_count == 3 || e < first ? 1 : step)
        for (int i = 0; i < factor_count; i++) {
            const double value = factors[i] * glint_pow(10, e);
            if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9))
                glint_marks_add(marks, typeface, scale, value, -1);
        }
    if (marks->count)
        return;
    glint_marks_add(marks, typeface, scale, scale->first, -1);
    glint_marks_add(marks, typeface, scale, scale->last, -1);
}

void glint_marks_fit(glint_marks *marks, const glint_typeface *typeface, const glint_scale *scale)
{
    double steps = WANTED, share = 1;
    if (scale->is_log) {
        find_powers(marks, typeface, scale);
        return;
    }
    do {
        share = glint_marks_round(marks, typeface, scale->first, scale->last, steps);
        steps /= 2;
    } while (share * scale->length < pitch(marks, typeface, scale) && steps > 0.5);
}
