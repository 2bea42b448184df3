/// The parts of formula.c, construct.c and box.c, which set a formula. Internal.
#ifndef GLINT_TEXT_SETTER_H
#define GLINT_TEXT_SETTER_H

#include "engine/figures/text/formula.h"
#include "engine/figures/text/symbols.h"

typedef enum glint_level {
    GLINT_LEVEL_DISPLAY,
    GLINT_LEVEL_TEXT, ///< parts of a displayed fraction
    GLINT_LEVEL_SCRIPT,
    GLINT_LEVEL_SCRIPT_OF_SCRIPT,
} glint_level;

typedef enum glint_letter_style {
    GLINT_LETTERS_ITALIC,
    GLINT_LETTERS_UPRIGHT,
    GLINT_LETTERS_BOLD,
    GLINT_LETTERS_BOLD_ITALIC,
    GLINT_LETTERS_CALLIGRAPHIC,
    GLINT_LETTERS_DOUBLE, ///< double-struck
} glint_letter_style;

typedef struct glint_style {
    glint_level level;
    glint_letter_style letters;
} glint_style;

/// The runs and rules of a part of the formula, and its extents; pixels.
typedef struct glint_box {
    int runs[2], rules[2]; ///< index of the first one, and of the one after the last
    double width;
    double above, below; ///< from the baseline
    double lean; ///< how far the last letter extends beyond the width; added before a superscript
    double middle; ///< horizontal position of an accent
    bool is_letter; ///< one run of letters
} glint_box;

typedef struct glint_setter {
    const glint_typeface *typeface;
    const char *at, *end; ///< the rest of the formula
    glint_line *line;
    glint_formula_fault *fault;
    int depth; ///< nested parts around `at`
} glint_setter;

// ---- box.c ----

/// Reports the first fault and skips the rest of the formula.
void glint_setter_fail(glint_setter *s, const char *at, const char *format, ...) __attribute__((format(printf, 3, 4)));
/// Returns the font size of a level, pixels.
double glint_setter_em(const glint_setter *s, glint_level level);
/// Returns the thickness of a rule, pixels.
double glint_setter_thickness(const glint_setter *s, glint_level level);
/// Returns the height of the axis, on which fractions and signs are centred; pixels.
double glint_setter_axis(const glint_setter *s, glint_level level);
/// Begins a box at the end of the line.
glint_box glint_box_begin(const glint_setter *s);
/// Ends a box with all runs and rules since it began.
void glint_box_end(const glint_setter *s, glint_box *box);
void glint_box_move(const glint_setter *s, const glint_box *box, double x, double y);
/// Adds the vertical extents of a box that is moved down by y.
void glint_box_add(glint_box *to, const glint_box *box, double y);
void glint_setter_rule(glint_setter *s, double x, double y, double width, double height);
/// Adds a run of letters at the origin. Returns its box; the run is the last one of the line.
glint_box glint_setter_run(glint_setter *s, glint_run run);
/// Returns the text that the font can draw for a symbol.
const char *glint_setter_text(const glint_setter *s, const glint_symbol *symbol);
/// Adds letters in a style. is_variable  slanted in italic style.
glint_box glint_setter_letters(glint_setter *s, glint_style style, const char *text, size_t size, bool is_variable);

// ---- formula.c ----

void glint_setter_skip_blanks(glint_setter *s);
/// Returns whether the next part of the formula is a command.
bool glint_setter_is_command(const glint_setter *s, const char *name);
/// Returns the size of the character at `at`, or of the command with its backslash.
size_t glint_setter_sign_size(const char *at, const char *end);
/// Sets the argument of a command or of ^ and _, which begins at `of`: a group in braces, or one sign.
glint_box glint_setter_argument(glint_setter *s, glint_style style, const char *of);
/// Sets atoms until the end, a closing brace, \right or `stop`; '\0': no other sign.
glint_box glint_setter_list(glint_setter *s, glint_style style, char stop);

// ---- construct.c ----

/// Sets the command at `at`, whose name has `size` bytes, with its arguments: a fraction, a root, an accent, fences or
/// letters of another shape. False: there is no such command.
bool glint_setter_construct(glint_setter *s, glint_style style, const char *at, size_t size, glint_atom *kind, glint_box *out);

#endif
