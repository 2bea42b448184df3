/// The boxes of a formula, made of runs and rules.
#include "engine/base/number.h"
#include "engine/text/setter.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#define SLANT 0.2 ///< the slope of DejaVu Sans Oblique
#define RULE 0.065 ///< thickness of a rule, in font sizes; at least one pixel

void glint_setter_fail(glint_setter *s, const char *at, const char *format, ...)
{
    va_list arguments;
    if (!s->fault->at) {
        va_start(arguments, format);
        glint_print_list(s->fault->message, sizeof s->fault->message, format, arguments);
        va_end(arguments);
        s->fault->at = at;
    }
    s->at = s->end;
}

double glint_setter_em(const glint_setter *s, glint_level of)
{
    static const double sizes[] = { 1, 1, 0.7, 0.5 };
    return s->typeface->em * sizes[of];
}

double glint_setter_thickness(const glint_setter *s, glint_level of)
{
    return fmax(1, floor(RULE * glint_setter_em(s, of) + 0.5));
}

glint_box glint_box_begin(const glint_setter *s)
{
    const int runs = s->line->run_count, rules = s->line->rule_count;
    return (glint_box) { .runs = { runs, runs }, .rules = { rules, rules } };
}

void glint_box_end(const glint_setter *s, glint_box *b)
{
    b->runs[1] = s->line->run_count;
    b->rules[1] = s->line->rule_count;
}

void glint_box_move(const glint_setter *s, const glint_box *b, double x, double y)
{
    for (int i = b->runs[0]; i < b->runs[1]; i++) {
        s->line->runs[i].x += x;
        s->line->runs[i].y += y;
    }
    for (int i = b->rules[0]; i < b->rules[1]; i++) {
        s->line->rules[i].x += x;
        s->line->rules[i].y += y;
    }
}

void glint_box_add(glint_box *to, const glint_box *b, double y)
{
    to->above = fmax(to->above, b->above - y);
    to->below = fmax(to->below, b->below + y);
}

void glint_setter_rule(glint_setter *s, double x, double y, double width, double height)
{
    if (s->line->rule_count == GLINT_LINE_RULES)
        glint_setter_fail(s, s->at, "expected at most %d bars in a line, got more", GLINT_LINE_RULES);
    else
        s->line->rules[s->line->rule_count++] = (glint_rule) { x, y, width, height };
}

glint_box glint_setter_run(glint_setter *s, glint_run run)
{
    glint_box b = glint_box_begin(s);
    if (s->line->run_count == GLINT_LINE_RUNS) {
        glint_setter_fail(s, s->at, "expected at most %d signs in the formulas of a line, got more", GLINT_LINE_RUNS);
        return b;
    }
    const glint_run_box ink = glint_typeface_box(s->typeface, &run);
    s->line->runs[s->line->run_count++] = run;
    b.width = glint_typeface_advance(s->typeface, &run);
    b.above = ink.above;
    b.below = ink.below;
    b.lean = fmax(0, ink.right - b.width);
    b.middle = (ink.left + ink.right + run.slant * ink.above) / 2;
    b.is_letter = true;
    glint_box_end(s, &b);
    return b;
}

glint_box glint_setter_letters(glint_setter *s, glint_style st, const char *text, size_t size, bool is_variable)
{
    // The bitmap font has no slant.
    const double slant = is_variable && st.letters == GLINT_LETTERS_ITALIC && s->typeface->letters ? SLANT : 0;
    const bool bold = st.letters == GLINT_LETTERS_BOLD;
    return glint_setter_run(s, (glint_run) { text, size, 0, 0, glint_setter_em(s, st.level), slant, 1, bold });
}

double glint_setter_axis(const glint_setter *s, glint_level of)
{
    const glint_run minus = { "\xe2\x88\x92", 3, 0, 0, glint_setter_em(s, of), 0, 1, false };
    const glint_run_box ink = glint_typeface_box(s->typeface, &minus);
    return (ink.above - ink.below) / 2;
}
