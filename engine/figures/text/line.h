/// A line of text with formulas between dollar signs, set as runs of letters and rules. Internal.
///
///     line.c      finds the formulas of a line; measures, breaks and draws lines
///     formula.c   sets one formula: a subset of TeX's mathematics, in the style of displayed formulas
///     construct.c its fractions, roots, accents and fences
///     box.c       the boxes from which a formula is put together
///     symbols.c   the signs and commands
///
/// A `$` begins a formula if no blank follows it, and if the next `$` of the line does not follow a blank and no digit
/// follows that `$`. Every other `$` is a dollar sign, and so is `\$`.
#ifndef GLINT_TEXT_LINE_H
#define GLINT_TEXT_LINE_H

#include "engine/figures/text/typeface.h"

#define GLINT_LINE_RUNS 128 ///< most runs of a line that has a formula
#define GLINT_LINE_RULES 32 ///< most rules of a line

/// A filled rectangle: the bar of a fraction, a root or an accent.
typedef struct glint_rule {
    double x, y, width, height; ///< of its upper left corner from the left end of the line's baseline; pixels
} glint_rule;

/// A line of text. Runs and rules are placed from the left end of its baseline, y downwards.
typedef struct glint_line {
    int width; ///< pixels
    int pad; ///< pixels beyond the width, on both sides, that letters may cover
    int above, below; ///< from the baseline to the top and to the bottom, pixels; at least as large as in the typeface
    int run_count, rule_count;
    glint_run runs[GLINT_LINE_RUNS]; ///< their texts are parts of the line's text, or static
    glint_rule rules[GLINT_LINE_RULES];
} glint_line;

/// Sets the first `size` bytes of UTF-8 text, at most to its end, without newlines. A line that glint_line_check
/// refuses is set as plain text.
void glint_line_set(const glint_typeface *typeface, const char *text, size_t size, glint_line *out);
/// Checks the formulas of a text of several lines; the message begins with `name`.
glint_status glint_line_check(const char *name, const char *text, glint_error *error);
/// Returns the next blank of a line, from `at` to `end`, that is not part of a formula; NULL: none.
/// line  the start of the line.
const char *glint_line_blank(const char *line, const char *at, const char *end);
/// Returns the next place of a line, from `at` to `end`, where a formula may be broken: before a relation, a plus or a
/// minus that is outside all groups and fences; NULL: none.
const char *glint_line_operator(const char *line, const char *at, const char *end);
/// Draws a line into the mask. The left end of its baseline is at the upper edge of row y.
void glint_line_draw(const glint_typeface *typeface, const glint_line *line, int x, int y, glint_mask *mask);

#endif
