/// Fractions, roots, accents and fences.
#include "engine/text/setter.h"

#include "engine/text/font.h"

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

static glint_box set_fraction(glint_setter *s, glint_style st, const char *of)
{
    const bool small = st.level != GLINT_LEVEL_DISPLAY;
    const glint_style inner = part_style(st);
    const double em = glint_setter_em(s, st.level), bar = glint_setter_thickness(s, st.level);
    const double gap = em * (small ? PART_GAP_SMALL : PART_GAP);
    const double top = floor(-glint_setter_axis(s, st.level) - bar / 2 + 0.5), space = FRACTION_SPACE * em;
    glint_box fraction = glint_box_begin(s);
    const glint_box high = glint_setter_argument(s, inner, of), low = glint_setter_argument(s, inner, of);
    const double width = fmax(high.width + high.lean, low.width + low.lean);
    const double up = ceil(fmax(em * (small ? PART_UP_SMALL : PART_UP), gap - top + high.below));
    const double down = ceil(fmax(em * (small ? PART_DOWN_SMALL : PART_DOWN), top + bar + gap + low.above));
    glint_box_move(s, &high, space + (width - high.width - high.lean) / 2, -up);
    glint_box_move(s, &low, space + (width - low.width - low.lean) / 2, down);
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

typedef struct accent {
    const char *name;
    const char *texts[2]; ///< the signs that draw it; the second one if the font lacks the first
} accent;

static const accent accents[] = {
    { "hat", { "\xcb\x86", "^" } }, // U+02C6
    { "tilde", { "\xcb\x9c", "~" } }, // U+02DC
    { "dot", { "\xcb\x99", "\xc2\xb7" } }, // U+02D9, U+00B7
    { "vec", { "\xe2\x83\x97", "\xe2\x86\x92" } }, // U+20D7, U+2192
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
    const glint_run run = { text, strlen(text), 0, 0, glint_setter_em(s, st.level), 0, 1, false };
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
        glint_setter_fail(s, of, "expected {...} after \\text");
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
    if (size - escaped == 1 && strchr(escaped ? "{}|" : "()[]|./", *sign)) {
        *out = *sign == '.' ? NULL : glint_symbol_find(escaped, sign, 1);
        s->at += size;
        return true;
    }
    glint_setter_fail(s, of, "expected one of ( ) [ ] | / . \\{ \\} \\| after %.*s", (int)glint_setter_sign_size(of, s->end),
                      of);
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

static glint_box set_fenced(glint_setter *s, glint_style st, const char *of)
{
    const glint_symbol *signs[2];
    int numbers[2] = { -1, -1 };
    const double axis = glint_setter_axis(s, st.level);
    glint_box all = glint_box_begin(s), body = all;
    for (int i = 0; i < 2; i++) {
        const char *command = i ? s->at : of;
        s->at += i ? strlen("\\right") : 0;
        if (!read_delimiter(s, command, &signs[i]))
            return all;
        if (signs[i]) {
            numbers[i] = s->line->run_count;
            const glint_box sign = glint_setter_letters(s, st, signs[i]->text, strlen(signs[i]->text), false);
            glint_box_move(s, &sign, all.width, 0);
            all.width += sign.width;
        }
        if (i)
            break;
        body = glint_setter_list(s, st, '\0');
        if (!glint_setter_is_command(s, "right")) {
            glint_setter_fail(s, of, "expected a \\right for the \\left, got none");
            return all;
        }
        glint_box_move(s, &body, all.width, 0);
        all.width += body.width + body.lean;
    }
    glint_box_add(&all, &body, 0);
    for (int i = 0; i < 2 && !s->fault->at; i++)
        if (numbers[i] >= 0) {
            const double half = fmax(body.above - axis, body.below + axis);
            const glint_box sign = stretch_delimiter(s, &s->line->runs[numbers[i]], half, axis);
            glint_box_add(&all, &sign, 0);
        }
    all.middle = all.width / 2;
    glint_box_end(s, &all);
    return all;
}

bool glint_setter_construct(glint_setter *s, glint_style st, const char *at, size_t size, glint_atom *kind, glint_box *out)
{
    const char *name = at + 1;
    const bool is_fraction = glint_symbol_is("frac", name, size), is_left = glint_symbol_is("left", name, size);
    *kind = is_fraction || is_left ? GLINT_ATOM_INNER : GLINT_ATOM_ORDINARY;
    for (size_t i = 0; i < sizeof accents / sizeof *accents; i++)
        if (glint_symbol_is(accents[i].name, name, size)) {
            *out = set_accent(s, st, &accents[i], at);
            return true;
        }
    if (is_fraction)
        *out = set_fraction(s, st, at);
    else if (is_left)
        *out = set_fenced(s, st, at);
    else if (glint_symbol_is("sqrt", name, size))
        *out = set_root(s, st, at);
    else if (glint_symbol_is("text", name, size))
        *out = set_text(s, st, at);
    else if (glint_symbol_is("mathrm", name, size))
        *out = glint_setter_argument(s, (glint_style) { st.level, GLINT_LETTERS_UPRIGHT }, at);
    else if (glint_symbol_is("mathbf", name, size))
        *out = glint_setter_argument(s, (glint_style) { st.level, GLINT_LETTERS_BOLD }, at);
    else
        return false;
    return true;
}
