/// Formulas follow the rules of TeX's displayed formulas (D. Knuth, The TeXbook, appendix G), with limits next to large
/// operators. Letters are slanted, because the font of texts is a single file. Vertical positions are whole pixels, so
/// that a formula is as sharp as plain text.
#include "engine/figures/text/setter.h"

#include "engine/figures/text/font.h"

#include <math.h>
#include <string.h>

#define DEPTH_MAX 10 ///< most nested commands, scripts and groups

// In font sizes:
#define UP 0.42 ///< shift of a superscript
#define DOWN 0.16 ///< shift of a subscript
#define DOWN_BOTH 0.25 ///< shift of a subscript below a superscript
#define HEIGHT_X 0.55 ///< height of an x
#define SCRIPT_SPACE 0.05 ///< space after scripts
#define LARGE 1.35 ///< size of a large operator in a displayed formula
#define DROP 0.4 ///< the baseline of a superscript below the top of a part of several signs, in its own font sizes
#define SINK 0.05 ///< the baseline of a subscript below the foot of such a part
#define SCRIPTS_GAP 0.2 ///< gap between a superscript and a subscript

/// Part of a list.
typedef struct atom {
    glint_atom kind;
    glint_box box;
} atom;

// ---- Reading ----

void glint_setter_skip_blanks(glint_setter *s)
{
    while (s->at < s->end && *s->at == ' ')
        s->at++;
}

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns the size of the command at a backslash, without the backslash: its letters or one sign; 0 at the end.
static size_t command_size(const char *at, const char *end)
{
    const char *name = at + 1, *behind = name;
    while (behind < end && is_letter(*behind))
        behind++;
    if (behind == name && name < end)
        glint_font_code(&behind);
    return (size_t)((behind < end ? behind : end) - name);
}

bool glint_setter_is_command(const glint_setter *s, const char *name)
{
    const size_t size = strlen(name);
    return s->at < s->end && *s->at == '\\' && command_size(s->at, s->end) == size && memcmp(s->at + 1, name, size) == 0;
}

size_t glint_setter_sign_size(const char *at, const char *end)
{
    const char *behind = at;
    if (*at == '\\')
        return 1 + command_size(at, end);
    glint_font_code(&behind);
    return (size_t)((behind < end ? behind : end) - at);
}

static glint_box set_group(glint_setter *s, glint_style st)
{
    const char *opening = s->at++;
    const glint_box b = glint_setter_list(s, st, '\0');
    if (s->at == s->end || *s->at != '}')
        glint_setter_fail(s, opening, "expected a } for the {, got none");
    else
        s->at++;
    return b;
}

static atom set_nucleus(glint_setter *s, glint_style st);

glint_box glint_setter_argument(glint_setter *s, glint_style st, const char *of)
{
    glint_setter_skip_blanks(s);
    if (s->at == s->end || strchr("}^_", *s->at)) {
        glint_setter_fail(s, of, "expected a sign or {...} after %.*s", (int)glint_setter_sign_size(of, s->end), of);
        return glint_box_begin(s);
    }
    if (*s->at == '{' && s->depth < DEPTH_MAX) {
        s->depth++;
        const glint_box group = set_group(s, st);
        s->depth--;
        return group;
    }
    return set_nucleus(s, st).box;
}

// ---- Atoms ----

/// Returns the style of scripts.
static glint_style script_style(glint_style st)
{
    return (glint_style) { st.level < GLINT_LEVEL_SCRIPT ? GLINT_LEVEL_SCRIPT : GLINT_LEVEL_SCRIPT_OF_SCRIPT, st.letters };
}

/// Sets a prime in a superscript as large and as high as the sign ' next to a letter.
static atom set_prime(glint_setter *s, glint_style st, const char *text)
{
    const double em = glint_setter_em(s, st.level == GLINT_LEVEL_SCRIPT ? GLINT_LEVEL_TEXT : GLINT_LEVEL_SCRIPT);
    const double y = floor(UP * em + 0.5);
    atom a = { GLINT_ATOM_ORDINARY, glint_setter_run(s, (glint_run) { text, strlen(text), 0, 0, em, 0, 1, false, false }) };
    glint_box_move(s, &a.box, 0, y);
    a.box.above -= y;
    a.box.below += y;
    return a;
}

static atom set_symbol(glint_setter *s, glint_style st, const glint_symbol *symbol)
{
    const char *text = glint_setter_text(s, symbol);
    atom a = { symbol->atom, { .width = 0 } };
    if (st.level >= GLINT_LEVEL_SCRIPT && strcmp(symbol->name, "prime") == 0)
        return set_prime(s, st, text);
    if (!symbol->is_large || st.level != GLINT_LEVEL_DISPLAY) {
        a.box = glint_setter_letters(s, st, text, strlen(text), symbol->is_variable);
        return a;
    }
    const double em = LARGE * glint_setter_em(s, st.level);
    a.box = glint_setter_run(s, (glint_run) { text, strlen(text), 0, 0, em, 0, 1, false, false });
    const double y = floor((a.box.above - a.box.below) / 2 - glint_setter_axis(s, st.level) + 0.5);
    glint_box_move(s, &a.box, 0, y);
    a.box.above -= y;
    a.box.below += y;
    a.box.is_letter = false;
    return a;
}

/// Returns the width of a space command in font sizes; 0: it is none.
static double space_of(const char *name, size_t size)
{
    static const char *const names[] = { ",", ";", "quad", ":", ">", "!", " ", "qquad" };
    static const double spaces[] = { 3 / 18.0, 5 / 18.0, 1, 4 / 18.0, 4 / 18.0, -3 / 18.0, 1 / 3.0, 2 };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (glint_symbol_is(names[i], name, size))
            return spaces[i];
    return 0;
}

static atom set_command(glint_setter *s, glint_style st)
{
    const char *at = s->at;
    const size_t size = command_size(at, s->end);
    const glint_symbol *symbol = glint_symbol_find(true, at + 1, size);
    const double space = space_of(at + 1, size);
    atom a = { GLINT_ATOM_SPACE, glint_box_begin(s) };
    s->at += 1 + size;
    a.box.width = space * glint_setter_em(s, st.level);
    if (space != 0 || glint_symbol_is("displaystyle", at + 1, size)) // formulas are displayed already
        return a;
    if (symbol)
        return set_symbol(s, st, symbol);
    if (!glint_setter_construct(s, st, at, size, &a.kind, &a.box))
        glint_setter_fail(s, at, "expected a command that formulas have, got \\%.*s", (int)(size < 40 ? size : 40), at + 1);
    return a;
}

/// Skips \limits and \nolimits: limits are next to large operators.
static void skip_limits(glint_setter *s)
{
    for (glint_setter_skip_blanks(s); glint_setter_is_command(s, "limits") || glint_setter_is_command(s, "nolimits");
         glint_setter_skip_blanks(s))
        s->at += 1 + command_size(s->at, s->end);
}

/// Sets digits with a decimal point.
static atom set_number(glint_setter *s, glint_style st)
{
    const char *first = s->at;
    while (s->at < s->end && (is_digit(*s->at) || (*s->at == '.' && s->at + 1 < s->end && is_digit(s->at[1]))))
        s->at++;
    return (atom) { GLINT_ATOM_ORDINARY, glint_setter_letters(s, st, first, (size_t)(s->at - first), false) };
}

/// Sets a letter, a sign or any character beyond ASCII.
static atom set_character(glint_setter *s, glint_style st)
{
    const char *first = s->at;
    const size_t size = glint_setter_sign_size(first, s->end);
    const glint_symbol *symbol = glint_symbol_find(false, first, size);
    s->at += size;
    if (*first == '~')
        return (atom) { GLINT_ATOM_SPACE, { .width = space_of(" ", 1) * glint_setter_em(s, st.level) } };
    if (symbol)
        return set_symbol(s, st, symbol);
    if (is_letter(*first) || (unsigned char)*first >= 0x80)
        return (atom) { GLINT_ATOM_ORDINARY, glint_setter_letters(s, st, first, size, is_letter(*first)) };
    glint_setter_fail(s, first, "expected a sign that formulas have, or \\text{%c}, got %c", *first, *first);
    return (atom) { GLINT_ATOM_ORDINARY, glint_box_begin(s) };
}

/// Sets the base of scripts: a sign, a command with its arguments or a group.
static atom set_nucleus(glint_setter *s, glint_style st)
{
    atom a = { GLINT_ATOM_ORDINARY, glint_box_begin(s) };
    if (s->depth == DEPTH_MAX) {
        glint_setter_fail(s, s->at, "expected at most %d nested parts, got more", DEPTH_MAX);
        return a;
    }
    s->depth++;
    if (*s->at == '\\')
        a = set_command(s, st);
    else if (*s->at == '{')
        a.box = set_group(s, st);
    else if (is_digit(*s->at))
        a = set_number(s, st);
    else if (*s->at != '^' && *s->at != '_') // scripts of nothing
        a = set_character(s, st);
    s->depth--;
    return a;
}

/// Moves scripts to their places next to a nucleus, and adds them to it. scripts: superscript and subscript.
static void place_scripts(glint_setter *s, glint_style st, glint_box *nucleus, const glint_box scripts[2], const bool has[2])
{
    const double em = glint_setter_em(s, st.level), script = glint_setter_em(s, script_style(st).level);
    const double drop = nucleus->is_letter ? 0 : nucleus->above - DROP * script;
    const double sink = nucleus->is_letter ? 0 : nucleus->below + SINK * script;
    double up = fmax(fmax(UP * em, drop), scripts[0].below + HEIGHT_X * em / 4);
    double down = fmax((has[0] ? DOWN_BOTH : DOWN) * em, sink);
    if (!has[0])
        down = fmax(down, scripts[1].above - 0.8 * HEIGHT_X * em);
    else if (has[1])
        down = fmax(down, SCRIPTS_GAP * em + scripts[1].above - (up - scripts[0].below));
    up = floor(up + 0.5);
    down = floor(down + 0.5);
    double width = nucleus->width;
    const double shifts[2] = { -up, down }, leans[2] = { nucleus->lean, 0 };
    for (int i = 0; i < 2; i++)
        if (has[i]) {
            glint_box_move(s, &scripts[i], nucleus->width + leans[i], shifts[i]);
            glint_box_add(nucleus, &scripts[i], shifts[i]);
            width = fmax(width, nucleus->width + leans[i] + scripts[i].width + scripts[i].lean + SCRIPT_SPACE * em);
        }
    nucleus->width = width;
    nucleus->lean = 0;
    nucleus->is_letter = false;
}

static atom set_atom(glint_setter *s, glint_style st)
{
    atom a = set_nucleus(s, st);
    glint_box scripts[2] = { { .width = 0 }, { .width = 0 } };
    bool has[2] = { false, false };
    for (skip_limits(s); s->at < s->end && (*s->at == '^' || *s->at == '_'); glint_setter_skip_blanks(s)) {
        const char *sign = s->at++;
        const int i = *sign == '_';
        if (has[i]) {
            glint_setter_fail(s, sign, "expected at most one %c at a sign, got another", *sign);
            return a;
        }
        has[i] = true;
        scripts[i] = glint_setter_argument(s, script_style(st), sign);
    }
    if (has[0] || has[1]) {
        a.kind = a.kind == GLINT_ATOM_SPACE ? GLINT_ATOM_ORDINARY : a.kind;
        place_scripts(s, st, &a.box, scripts, has);
        glint_box_end(s, &a.box);
    }
    return a;
}

// ---- Lists of atoms ----

/// Returns the space between two atoms, in font sizes. The table's rows are for the left atom, its columns for the right
/// one. 1 is a thin space; A, B and C are a thin, a medium and a thick space that scripts leave out; . does not occur.
static double space_between(glint_atom left, glint_atom right, glint_level of)
{
    static const char *const table[] = { "01BC000A", "11.C000A", "BB..B..B", "CC.0C00C",
                                         "00.00000", "01BC000A", "AA.AAAAA", "A1BCA0AA" };
    static const double spaces[] = { ['0'] = 0, ['1'] = 3, ['A'] = 3, ['B'] = 4, ['C'] = 5, ['.'] = 0 };
    const char c = table[left][right];
    return of >= GLINT_LEVEL_SCRIPT && c != '1' ? 0 : spaces[(unsigned char)c] / 18;
}

/// A list under construction.
typedef struct list {
    glint_box box;
    int last; ///< class of the last atom; -1: none
    glint_box last_box; ///< the last atom
    double last_space; ///< the space before it; pixels
} list;

/// Returns whether no operand precedes a binary sign, so that the sign is an ordinary one, as in -1.
static bool lacks_operand(int before)
{
    return before < 0 || before == GLINT_ATOM_BINARY || before == GLINT_ATOM_OPERATOR || before == GLINT_ATOM_RELATION ||
           before == GLINT_ATOM_OPENING || before == GLINT_ATOM_PUNCTUATION;
}

/// Turns a binary sign at the end of a list into an ordinary one, because no second operand follows.
static void make_ordinary(glint_setter *s, list *l)
{
    if (l->last != GLINT_ATOM_BINARY)
        return;
    l->last = GLINT_ATOM_ORDINARY;
    l->box.width -= l->last_space;
    glint_box_move(s, &l->last_box, -l->last_space, 0);
}

static void add_atom(glint_setter *s, glint_style st, list *l, atom a)
{
    l->box.width += l->box.lean;
    l->box.lean = 0;
    if (a.kind == GLINT_ATOM_SPACE) {
        l->box.width += a.box.width;
        return;
    }
    if (a.kind == GLINT_ATOM_BINARY && lacks_operand(l->last))
        a.kind = GLINT_ATOM_ORDINARY;
    if (a.kind == GLINT_ATOM_RELATION || a.kind == GLINT_ATOM_CLOSING || a.kind == GLINT_ATOM_PUNCTUATION)
        make_ordinary(s, l);
    l->last_space = l->last < 0 ? 0 : space_between((glint_atom)l->last, a.kind, st.level) * glint_setter_em(s, st.level);
    if (a.box.runs[0] == l->box.runs[0]) // an accent belongs to a single letter
        l->box.middle = a.box.middle;
    else
        l->box.middle = (l->box.width + l->last_space + a.box.width) / 2;
    l->box.is_letter = a.box.is_letter && a.box.runs[0] == l->box.runs[0];
    l->box.width += l->last_space;
    glint_box_move(s, &a.box, l->box.width, 0);
    glint_box_add(&l->box, &a.box, 0);
    l->box.width += a.box.width;
    l->box.lean = a.box.lean;
    l->last = a.kind;
    l->last_box = a.box;
}

glint_box glint_setter_list(glint_setter *s, glint_style st, char stop)
{
    list l = { .box = glint_box_begin(s), .last = -1 };
    glint_setter_skip_blanks(s);
    while (s->at < s->end && *s->at != '}' && *s->at != stop && !glint_setter_is_command(s, "right")) {
        add_atom(s, st, &l, set_atom(s, st));
        glint_setter_skip_blanks(s);
    }
    make_ordinary(s, &l);
    glint_box_end(s, &l.box);
    return l.box;
}

void glint_formula_set(const glint_typeface *typeface, const char *formula, size_t size, double *x, glint_line *line,
                       glint_formula_fault *fault)
{
    glint_setter s = { .typeface = typeface, .at = formula, .end = formula + size, .line = line, .fault = fault };
    const glint_box b = glint_setter_list(&s, (glint_style) { GLINT_LEVEL_DISPLAY, GLINT_LETTERS_ITALIC }, '\0');
    if (s.at < s.end && *s.at == '}')
        glint_setter_fail(&s, s.at, "expected a { for each }, got a }");
    else if (s.at < s.end)
        glint_setter_fail(&s, s.at, "expected a \\left for each \\right, got a \\right");
    glint_box_move(&s, &b, *x, 0);
    *x += b.width + b.lean;
    line->above = (int)fmax(line->above, ceil(b.above));
    line->below = (int)fmax(line->below, ceil(b.below));
}
