/// Fractions, roots, accents and fences.
#include "engine/figures/text/setter.h"

#include "engine/figures/text/font.h"

#include <math.h>
#include <string.h>

// In font sizes:
#define PART_UP 0.72 ///< least shift of a numerator; in scripts PART_UP_SMALL
#define PART_UP_SMALL 0.45
#define PART_DOWN 0.7 ///< least shift of a denominator
#define PART_DOWN_SMALL 0.4
#define PART_GAP 0.14 ///< least gap between a part of a fraction and the bar
#define PART_GAP_SMALL 0.08
#define FRACTION_SPACE 0.12 ///< space on both sides of a fraction
#define ROOT_GAP 0.1 ///< gap between a radicand and its bar
#define INDEX_HEIGHT 0.6 ///< height of the index above the foot of a root's sign
#define ACCENT_GAP 0.06 ///< gap between a letter and its accent
#define BAR_HALF 0.25 ///< half of the length of a bar above a letter

#define INDEX_END 0.45 ///< right end of the index, as a share of the width of a root's sign

/// Returns the style of the parts of a fraction.
static glint_style part_style(glint_style st)
{
    return (glint_style) { st.level < GLINT_LEVEL_SCRIPT_OF_SCRIPT ? st.level + 1 : st.level, st.letters };
}

/// Sets the next part of a fraction: one digit, as in \frac12, or an argument.
static glint_box set_part(glint_setter *s, glint_style st, const char *of)
{
    glint_setter_skip_blanks(s);
    if (s->at == s->end || *s->at < '0' || *s->at > '9')
        return glint_setter_argument(s, st, of);
    s->at++;
    return glint_setter_letters(s, st, s->at - 1, 1, false);
}

static glint_box set_fraction(glint_setter *s, glint_style st, const char *of, bool has_bar)
{
    const bool small = st.level != GLINT_LEVEL_DISPLAY;
    const glint_style inner = part_style(st);
    const double em = glint_setter_em(s, st.level), bar = glint_setter_thickness(s, st.level);
    const double gap = em * (small ? PART_GAP_SMALL : PART_GAP);
    const double top = floor(-glint_setter_axis(s, st.level) - bar / 2 + 0.5), space = FRACTION_SPACE * em;
    glint_box fraction = glint_box_begin(s);
    const glint_box high = set_part(s, inner, of), low = set_part(s, inner, of);
    const double width = fmax(high.width + high.lean, low.width + low.lean);
    const double up = ceil(fmax(em * (small ? PART_UP_SMALL : PART_UP), gap - top + high.below));
    const double down = ceil(fmax(em * (small ? PART_DOWN_SMALL : PART_DOWN), top + bar + gap + low.above));
    glint_box_move(s, &high, space + (width - high.width - high.lean) / 2, -up);
    glint_box_move(s, &low, space + (width - low.width - low.lean) / 2, down);
    if (has_bar)
        glint_setter_rule(s, space, top, width, bar);
    glint_box_add(&fraction, &high, -up);
    glint_box_add(&fraction, &low, down);
    fraction.width = width + 2 * space;
    fraction.middle = fraction.width / 2;
    glint_box_end(s, &fraction);
    return fraction;
}

/// Sets [n] of a root. Returns its box.
static glint_box set_index(glint_setter *s)
{
    glint_box index = glint_box_begin(s);
    glint_setter_skip_blanks(s);
    if (s->at == s->end || *s->at != '[')
        return index;
    const char *opening = s->at++;
    index = glint_setter_list(s, (glint_style) { GLINT_LEVEL_SCRIPT_OF_SCRIPT, GLINT_LETTERS_ITALIC }, ']');
    if (s->at == s->end || *s->at != ']')
        glint_setter_fail(s, opening, "expected a ] for the [, got none");
    else
        s->at++;
    return index;
}

static glint_box set_root(glint_setter *s, glint_style st, const char *of)
{
    static const char sign[] = "\xe2\x88\x9a";
    const double em = glint_setter_em(s, st.level), bar = glint_setter_thickness(s, st.level);
    glint_box root = glint_box_begin(s);
    const glint_box index = set_index(s);
    const int number = s->line->run_count;
    const glint_box hook = glint_setter_letters(s, st, sign, sizeof sign - 1, false);
    const glint_box body = glint_setter_argument(s, st, of);
    if (s->fault->at)
        return root;
    const double least = hook.above + hook.below, needed = body.above + body.below + ROOT_GAP * em + bar;
    const double spare = fmax(0, least - needed) / 2, top = -ceil(body.above + ROOT_GAP * em + bar + spare);
    glint_run *run = &s->line->runs[number];
    run->stretch = fmax(1, (body.below - top) / least);
    const glint_run_box ink = glint_typeface_box(s->typeface, run);
    const double shift = fmax(0, index.width - INDEX_END * ink.right);
    const double raise = floor(top + ink.above + ink.below - INDEX_HEIGHT * em * run->stretch);
    run->x = shift;
    run->y = top + ink.above;
    glint_box_move(s, &index, shift + INDEX_END * ink.right - index.width, raise);
    glint_box_move(s, &body, shift + ink.right, 0);
    root.width = shift + ink.right + body.width + body.lean;
    glint_setter_rule(s, shift + ink.right, top, body.width + body.lean, bar);
    glint_box_add(&root, &index, raise);
    root.above = fmax(root.above, -top);
    root.below = fmax(body.below, top + ink.above + ink.below);
    root.middle = root.width / 2;
    glint_box_end(s, &root);
    return root;
}

/// Sets a bar above a box that begins with `accented`.
static void set_bar(glint_setter *s, glint_style st, glint_box *accented)
{
    const double em = glint_setter_em(s, st.level), bar = glint_setter_thickness(s, st.level);
    const double top = -ceil(accented->above + ACCENT_GAP * em + bar);
    const double half = accented->is_letter ? BAR_HALF * em : accented->width / 2;
    glint_setter_rule(s, accented->middle - half, top, 2 * half, bar);
    accented->above = -top;
}

/// Sets the argument of \overline or \underline with a bar along it.
static glint_box set_line(glint_setter *s, glint_style st, const char *at, bool is_under)
{
    const double gap = ACCENT_GAP * glint_setter_em(s, st.level), bar = glint_setter_thickness(s, st.level);
    glint_box b = glint_setter_argument(s, st, at);
    const double y = is_under ? ceil(b.below + gap) : -ceil(b.above + gap + bar);
    glint_setter_rule(s, 0, y, b.width + b.lean, bar);
    b.above = fmax(b.above, -y);
    b.below = fmax(b.below, y + bar);
    b.is_letter = false;
    glint_box_end(s, &b);
    return b;
}

typedef struct accent {
    const char *name;
    const char *texts[2]; ///< the signs that draw it; the second one if the font lacks the first
} accent;

static const accent accents[] = {
    { "hat", { "\xcb\x86", "^" } }, // U+02C6
    { "tilde", { "\xcb\x9c", "~" } }, // U+02DC
    { "dot", { "\xcb\x99", "\xc2\xb7" } }, // U+02D9, U+00B7
    { "vec", { "\xe2\x83\x97", "\xe2\x86\x92" } }, // U+20D7, U+2192
    { "ddot", { "\u00a8", "\u00a8" } },
    { "acute", { "\u00b4", "\u00b4" } },
    { "grave", { "`", "`" } },
    { "check", { "\u02c7", "v" } },
    { "breve", { "\u02d8", "u" } },
    { "widehat", { "\xcb\x86", "^" } },
    { "widetilde", { "\xcb\x9c", "~" } },
    { "overrightarrow", { "\xe2\x83\x97", "\xe2\x86\x92" } },
    { "bar", { NULL } }, // a rule
};

static glint_box set_accent(glint_setter *s, glint_style st, const accent *of, const char *at)
{
    glint_box accented = glint_setter_argument(s, st, at);
    if (!of->texts[0]) {
        set_bar(s, st, &accented);
        glint_box_end(s, &accented);
        return accented;
    }
    const char *code = of->texts[0];
    const char *text = of->texts[!glint_typeface_has(s->typeface, glint_font_code(&code))];
    const glint_run run = { text, strlen(text), 0, 0, glint_setter_em(s, st.level), 0, 1, false, true };
    const glint_run_box ink = glint_typeface_box(s->typeface, &run);
    const glint_box sign = glint_setter_run(s, run);
    const double y = -floor(accented.above + ACCENT_GAP * run.em + ink.below + 0.5);
    glint_box_move(s, &sign, accented.middle - (ink.left + ink.right) / 2, y);
    glint_box_add(&accented, &sign, y);
    glint_box_end(s, &accented);
    return accented;
}

/// Sets {letters} of \text, which may contain blanks but no command.
static glint_box set_text(glint_setter *s, glint_style st, const char *of)
{
    glint_setter_skip_blanks(s);
    const char *text = s->at + 1, *behind = s->at < s->end ? memchr(s->at, '}', (size_t)(s->end - s->at)) : NULL;
    if (s->at == s->end || *s->at != '{' || !behind) {
        glint_setter_fail(s, of, "expected {...} after %.*s", (int)glint_setter_sign_size(of, s->end), of);
        return glint_box_begin(s);
    }
    for (const char *c = text; c < behind; c++)
        if (*c == '\\' || *c == '{') {
            glint_setter_fail(s, c, "expected only letters in \\text{...}, got %c", *c);
            return glint_box_begin(s);
        }
    s->at = behind + 1;
    return glint_setter_letters(s, st, text, (size_t)(behind - text), false);
}

// ---- \left and \right ----

/// Reads the sign after \left or \right; *out NULL: no sign. False: a fault.
static bool read_delimiter(glint_setter *s, const char *of, const glint_symbol **out)
{
    *out = NULL;
    glint_setter_skip_blanks(s);
    const size_t size = s->at < s->end ? glint_setter_sign_size(s->at, s->end) : 0;
    const bool escaped = size && *s->at == '\\';
    const char *sign = s->at + escaped;
    const glint_symbol *symbol = size ? glint_symbol_find(escaped, sign, size - escaped) : NULL;
    if (symbol && (symbol->atom == GLINT_ATOM_OPENING || symbol->atom == GLINT_ATOM_CLOSING || strchr("|/.\\", *symbol->text) ||
                   strcmp(symbol->text, "\u2016") == 0)) {
        *out = *symbol->text == '.' ? NULL : symbol;
        s->at += size;
        return true;
    }
    glint_setter_fail(s, of, "expected a delimiter such as ( ] | . \\{ \\| \\langle \\rfloor after %.*s",
                      (int)glint_setter_sign_size(of, s->end), of);
    return false;
}

/// Stretches the run of a delimiter so that it covers `half` on both sides of the axis. Returns its box.
static glint_box stretch_delimiter(glint_setter *s, glint_run *run, double half, double axis)
{
    glint_box b = { 0 };
    glint_run_box ink = glint_typeface_box(s->typeface, run);
    run->stretch = fmax(1, 2 * half / (ink.above + ink.below));
    ink = glint_typeface_box(s->typeface, run);
    if (run->stretch > 1)
        run->y = (ink.above - ink.below) / 2 - axis;
    b.above = ink.above - run->y;
    b.below = ink.below + run->y;
    return b;
}

/// Adds the sign of a delimiter at the end of a box. Returns the number of its run.
static int add_delimiter(glint_setter *s, glint_style st, const glint_symbol *symbol, glint_box *to)
{
    const int number = s->line->run_count;
    const char *text = glint_setter_text(s, symbol);
    const glint_box sign = glint_setter_letters(s, st, text, strlen(text), false);
    glint_box_move(s, &sign, to->width, 0);
    to->width += sign.width;
    return number;
}

static void add_body(glint_setter *s, const glint_box *body, glint_box *to)
{
    glint_box_move(s, body, to->width, 0);
    to->width += body->width + body->lean;
}

/// Stretches the delimiters of a part, and ends the box of all three.
static void end_fenced(glint_setter *s, glint_style st, const int numbers[2], const glint_box *body, glint_box *all)
{
    const double axis = glint_setter_axis(s, st.level), half = fmax(body->above - axis, body->below + axis);
    glint_box_add(all, body, 0);
    for (int i = 0; i < 2 && !s->fault->at; i++)
        if (numbers[i] >= 0) {
            const glint_box sign = stretch_delimiter(s, &s->line->runs[numbers[i]], half, axis);
            glint_box_add(all, &sign, 0);
        }
    all->middle = all->width / 2;
    glint_box_end(s, all);
}

static glint_box set_binomial(glint_setter *s, glint_style st, const char *of)
{
    glint_box all = glint_box_begin(s);
    int numbers[2];
    numbers[0] = add_delimiter(s, st, glint_symbol_find(false, "(", 1), &all);
    const glint_box body = set_fraction(s, st, of, false);
    add_body(s, &body, &all);
    numbers[1] = add_delimiter(s, st, glint_symbol_find(false, ")", 1), &all);
    end_fenced(s, st, numbers, &body, &all);
    return all;
}

/// Sets a delimiter of a fixed size: \big, \Big, \bigg or \Bigg, alone or with l, r or m. False: another command.
static bool set_big(glint_setter *s, glint_style st, const char *at, size_t size, glint_atom *kind, glint_box *out)
{
    static const char *const names[] = { "big", "Big", "bigg", "Bigg" };
    static const double halves[] = { 0.6, 0.85, 1.15, 1.45 }; // in font sizes
    const char last = size ? at[size] : '\0';
    const size_t length = size - (last == 'l' || last == 'r' || last == 'm');
    int i = 0;
    while (i < 4 && !glint_symbol_is(names[i], at + 1, length))
        i++;
    if (i == 4)
        return false;
    const glint_symbol *symbol;
    *out = glint_box_begin(s);
    if (!read_delimiter(s, at, &symbol) || !symbol)
        return true;
    *kind = last == 'l' ? GLINT_ATOM_OPENING : last == 'r' ? GLINT_ATOM_CLOSING : last == 'm' ? GLINT_ATOM_RELATION : symbol->atom;
    const int number = add_delimiter(s, st, symbol, out);
    if (s->fault->at)
        return true;
    const double half = halves[i] * glint_setter_em(s, st.level), axis = glint_setter_axis(s, st.level);
    const glint_box sign = stretch_delimiter(s, &s->line->runs[number], half, axis);
    glint_box_add(out, &sign, 0);
    glint_box_end(s, out);
    return true;
}

static glint_box set_fenced(glint_setter *s, glint_style st, const char *of)
{
    const glint_symbol *signs[2];
    int numbers[2] = { -1, -1 };
    glint_box all = glint_box_begin(s), body = all;
    for (int i = 0; i < 2; i++) {
        const char *command = i ? s->at : of;
        s->at += i ? strlen("\\right") : 0;
        if (!read_delimiter(s, command, &signs[i]))
            return all;
        if (signs[i])
            numbers[i] = add_delimiter(s, st, signs[i], &all);
        if (i)
            break;
        body = glint_setter_list(s, st, '\0');
        if (!glint_setter_is_command(s, "right")) {
            glint_setter_fail(s, of, "expected a \\right for the \\left, got none");
            return all;
        }
        add_body(s, &body, &all);
    }
    end_fenced(s, st, numbers, &body, &all);
    return all;
}

// ---- Commands ----

typedef enum construct { FRACTION, BINOMIAL, FENCED, ROOT, TEXT, LETTERS, OPERATOR, OVERLINE, UNDERLINE } construct;

static const struct {
    const char *name;
    construct what;
    int level; ///< least glint_level of a fraction; -1: that of its surroundings
    glint_letter_style letters;
} constructs[] = {
    { "frac", FRACTION, -1, 0 },
    { "dfrac", FRACTION, GLINT_LEVEL_DISPLAY, 0 },
    { "cfrac", FRACTION, GLINT_LEVEL_DISPLAY, 0 },
    { "tfrac", FRACTION, GLINT_LEVEL_TEXT, 0 },
    { "binom", BINOMIAL, -1, 0 },
    { "dbinom", BINOMIAL, GLINT_LEVEL_DISPLAY, 0 },
    { "tbinom", BINOMIAL, GLINT_LEVEL_TEXT, 0 },
    { "left", FENCED, -1, 0 },
    { "sqrt", ROOT, -1, 0 },
    { "text", TEXT, -1, GLINT_LETTERS_UPRIGHT },
    { "textrm", TEXT, -1, GLINT_LETTERS_UPRIGHT },
    { "mbox", TEXT, -1, GLINT_LETTERS_UPRIGHT },
    { "textbf", TEXT, -1, GLINT_LETTERS_BOLD },
    { "textsf", TEXT, -1, GLINT_LETTERS_UPRIGHT },
    { "mathrm", LETTERS, -1, GLINT_LETTERS_UPRIGHT },
    { "mathsf", LETTERS, -1, GLINT_LETTERS_UPRIGHT },
    { "mathbf", LETTERS, -1, GLINT_LETTERS_BOLD },
    { "mathit", LETTERS, -1, GLINT_LETTERS_ITALIC },
    { "boldsymbol", LETTERS, -1, GLINT_LETTERS_BOLD_ITALIC },
    { "bm", LETTERS, -1, GLINT_LETTERS_BOLD_ITALIC },
    { "mathcal", LETTERS, -1, GLINT_LETTERS_CALLIGRAPHIC },
    { "mathscr", LETTERS, -1, GLINT_LETTERS_CALLIGRAPHIC },
    { "mathbb", LETTERS, -1, GLINT_LETTERS_DOUBLE },
    { "operatorname", OPERATOR, -1, GLINT_LETTERS_UPRIGHT },
    { "overline", OVERLINE, -1, 0 },
    { "underline", UNDERLINE, -1, 0 },
};

/// Sets a construct. inner  the style of its parts.
static glint_box set_construct(glint_setter *s, glint_style st, construct what, const char *at, glint_style inner)
{
    switch (what) {
    case FRACTION: return set_fraction(s, inner, at, true);
    case BINOMIAL: return set_binomial(s, inner, at);
    case FENCED: return set_fenced(s, st, at);
    case ROOT: return set_root(s, st, at);
    case TEXT: return set_text(s, inner, at);
    case OVERLINE:
    case UNDERLINE: return set_line(s, st, at, what == UNDERLINE);
    default: s->at += what == OPERATOR && s->at < s->end && *s->at == '*'; return glint_setter_argument(s, inner, at);
    }
}

bool glint_setter_construct(glint_setter *s, glint_style st, const char *at, size_t size, glint_atom *kind, glint_box *out)
{
    const char *name = at + 1;
    *kind = GLINT_ATOM_ORDINARY;
    for (size_t i = 0; i < sizeof accents / sizeof *accents; i++)
        if (glint_symbol_is(accents[i].name, name, size)) {
            *out = set_accent(s, st, &accents[i], at);
            return true;
        }
    for (size_t i = 0; i < sizeof constructs / sizeof *constructs; i++)
        if (glint_symbol_is(constructs[i].name, name, size)) {
            const construct what = constructs[i].what;
            glint_style inner = st;
            if (constructs[i].level == GLINT_LEVEL_DISPLAY || constructs[i].level > (int)st.level)
                inner.level = (glint_level)constructs[i].level;
            if (what == TEXT || what == LETTERS || what == OPERATOR)
                inner.letters = constructs[i].letters;
            *kind = what == FRACTION || what == FENCED ? GLINT_ATOM_INNER
                    : what == OPERATOR                 ? GLINT_ATOM_OPERATOR
                                                       : GLINT_ATOM_ORDINARY;
            *out = set_construct(s, st, what, at, inner);
            return true;
        }
    return set_big(s, st, at, size, kind, out);
}
