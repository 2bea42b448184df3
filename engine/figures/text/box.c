/// The boxes of a formula, made of runs and rules.
#include "engine/base/number.h"
#include "engine/figures/text/font.h"
#include "engine/figures/text/setter.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

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
    const double em = s->typeface->em;
    return fmax(em * sizes[of], fmin(em, s->typeface->least));
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

const char *glint_setter_text(const glint_setter *s, const glint_symbol *symbol)
{
    const char *code = symbol->text;
    return symbol->plain && !glint_typeface_has(s->typeface, glint_font_code(&code)) ? symbol->plain : symbol->text;
}

// A to Z, a to z, and of the double-struck ones 0 to 9.
static const char double_struck[] =
    "\U0001d538\U0001d539\u2102\U0001d53b\U0001d53c\U0001d53d\U0001d53e\u210d\U0001d540\U0001d541\U0001d542"
    "\U0001d543\U0001d544\u2115\U0001d546\u2119\u211a\u211d\U0001d54a\U0001d54b\U0001d54c\U0001d54d\U0001d54e"
    "\U0001d54f\U0001d550\u2124\U0001d552\U0001d553\U0001d554\U0001d555\U0001d556\U0001d557\U0001d558\U0001d559"
    "\U0001d55a\U0001d55b\U0001d55c\U0001d55d\U0001d55e\U0001d55f\U0001d560\U0001d561\U0001d562\U0001d563\U0001d564"
    "\U0001d565\U0001d566\U0001d567\U0001d568\U0001d569\U0001d56a\U0001d56b\U0001d7d8\U0001d7d9\U0001d7da\U0001d7db"
    "\U0001d7dc\U0001d7dd\U0001d7de\U0001d7df\U0001d7e0\U0001d7e1";
static const char calligraphic[] =
    "\U0001d49c\u212c\U0001d49e\U0001d49f\u2130\u2131\U0001d4a2\u210b\u2110\U0001d4a5\U0001d4a6\u2112\u2133"
    "\U0001d4a9\U0001d4aa\U0001d4ab\U0001d4ac\u211b\U0001d4ae\U0001d4af\U0001d4b0\U0001d4b1\U0001d4b2\U0001d4b3"
    "\U0001d4b4\U0001d4b5\U0001d4b6\U0001d4b7\U0001d4b8\U0001d4b9\u212f\U0001d4bb\u210a\U0001d4bd\U0001d4be"
    "\U0001d4bf\U0001d4c0\U0001d4c1\U0001d4c2\U0001d4c3\u2134\U0001d4c5\U0001d4c6\U0001d4c7\U0001d4c8\U0001d4c9"
    "\U0001d4ca\U0001d4cb\U0001d4cc\U0001d4cd\U0001d4ce\U0001d4cf";

/// Finds the calligraphic or double-struck form of a letter. False: the font lacks it.
static bool find_form(const glint_setter *s, glint_letter_style style, const char **text, size_t *size)
{
    static const char order[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
    const char *at = style == GLINT_LETTERS_DOUBLE ? double_struck : calligraphic;
    const char *place = *size == 1 && **text ? strchr(order, **text) : NULL;
    if (!place || (style != GLINT_LETTERS_DOUBLE && style != GLINT_LETTERS_CALLIGRAPHIC))
        return false;
    for (const char *c = order; c < place && *at; c++)
        glint_font_code(&at);
    const char *behind = at;
    if (!*at || !glint_typeface_has(s->typeface, glint_font_code(&behind)))
        return false;
    *text = at;
    *size = (size_t)(behind - at);
    return true;
}

glint_box glint_setter_letters(glint_setter *s, glint_style st, const char *text, size_t size, bool is_variable)
{
    static const double slants[] = { [GLINT_LETTERS_ITALIC] = SLANT, [GLINT_LETTERS_BOLD_ITALIC] = SLANT,
                                     [GLINT_LETTERS_CALLIGRAPHIC] = 2 * SLANT, [GLINT_LETTERS_DOUBLE] = 0 };
    const bool has_form = find_form(s, st.letters, &text, &size);
    const double slant = is_variable && !has_form && s->typeface->letters ? slants[st.letters] : 0; // the bitmap font has none
    const bool bold = st.letters == GLINT_LETTERS_BOLD || st.letters == GLINT_LETTERS_BOLD_ITALIC ||
                      (st.letters == GLINT_LETTERS_DOUBLE && !has_form);
    return glint_setter_run(s, (glint_run) { text, size, 0, 0, glint_setter_em(s, st.level), slant, 1, bold, false });
}

double glint_setter_axis(const glint_setter *s, glint_level of)
{
    const glint_run minus = { "\xe2\x88\x92", 3, 0, 0, glint_setter_em(s, of), 0, 1, false, false };
    const glint_run_box ink = glint_typeface_box(s->typeface, &minus);
    return (ink.above - ink.below) / 2;
}
