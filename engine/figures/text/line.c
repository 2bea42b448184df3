#include "engine/figures/text/line.h"
#include "engine/glint.h"

#include "engine/base/status.h"
#include "engine/figures/text/font.h"
#include "engine/figures/text/formula.h"

#include <math.h>
#include <string.h>

#define PAD 0.25 ///< how far an accent may extend beyond its line, in font sizes

/// Returns the first dollar sign from `at` to `end` that no backslash precedes; NULL: none.
static const char *find_dollar(const char *at, const char *end)
{
    for (; at < end; at++)
        if (*at == '$')
            return at;
        else if (*at == '\\' && at + 1 < end)
            at++;
    return NULL;
}

/// Finds the next formula: its dollar signs. False: there is none.
static bool find_formula(const char *at, const char *end, const char *signs[2])
{
    for (signs[0] = find_dollar(at, end); signs[0]; signs[0] = signs[1]) {
        signs[1] = find_dollar(signs[0] + 1, end);
        if (!signs[1])
            return false;
        const char first = signs[0][1], last = *(signs[1] - 1), behind = signs[1] + 1 < end ? signs[1][1] : ' ';
        if (first != ' ' && last != ' ' && !(behind >= '0' && behind <= '9'))
            return true;
    }
    return false;
}

/// Adds plain text at the end of a line, without the backslashes of dollar signs. False: the line has too many runs.
static bool add_plain(const glint_typeface *typeface, const char *text, const char *end, double *x, glint_line *line)
{
    while (text < end) {
        const char *next = text;
        while (next < end && !(*next == '\\' && next + 1 < end && next[1] == '$'))
            next++;
        const glint_run run = { .text = text, .size = (size_t)(next - text), .x = *x, .em = typeface->em, .stretch = 1 };
        if (run.size && line->run_count == GLINT_LINE_RUNS)
            return false;
        if (run.size)
            line->runs[line->run_count++] = run;
        *x += glint_typeface_advance(typeface, &run);
        text = next < end ? next + 1 : end;
    }
    return true;
}

/// Sets a line that contains dollar signs.
static void set_mixed(const glint_typeface *typeface, const char *text, const char *end, glint_line *line,
                      glint_formula_fault *fault)
{
    const char *signs[2];
    double x = 0;
    while (!fault->at && find_formula(text, end, signs)) {
        const size_t size = (size_t)(signs[1] - signs[0]) - 1;
        if (!add_plain(typeface, text, signs[0], &x, line)) {
            *fault = (glint_formula_fault) { signs[0], "expected fewer formulas in a line, got more" };
            return;
        }
        if (size == 0)
            *fault = (glint_formula_fault) { signs[0], "expected a formula between dollar signs (\\$ is a dollar sign), "
                                                       "got none" };
        line->pad = (int)ceil(PAD * typeface->em);
        glint_formula_set(typeface, signs[0] + 1, size, &x, line, fault);
        text = signs[1] + 1;
    }
    if (!fault->at && !add_plain(typeface, text, end, &x, line))
        *fault = (glint_formula_fault) { text, "expected fewer dollar signs in a line, got more" };
    line->width = (int)(fmin(x, GLINT_SIDE_MAX) + 0.999);
}

static void set_plain(const glint_typeface *typeface, const char *text, size_t size, glint_line *line)
{
    line->width = glint_typeface_width(typeface, text, size);
    line->pad = 0;
    line->above = typeface->above;
    line->below = typeface->height - typeface->above;
    line->run_count = 1;
    line->rule_count = 0;
    line->runs[0] = (glint_run) { .text = text, .size = size, .em = typeface->em, .stretch = 1 };
}

/// Sets a line; on a fault as plain text.
static glint_formula_fault set(const glint_typeface *typeface, const char *text, size_t size, glint_line *out)
{
    glint_formula_fault fault = { NULL, "" };
    size = strnlen(text, size);
    if (memchr(text, '$', size)) {
        out->run_count = out->rule_count = out->pad = 0;
        out->above = typeface->above;
        out->below = typeface->height - typeface->above;
        set_mixed(typeface, text, text + size, out, &fault);
        if (!fault.at)
            return fault;
    }
    set_plain(typeface, text, size, out);
    return fault;
}

void glint_line_set(const glint_typeface *typeface, const char *text, size_t size, glint_line *out)
{
    set(typeface, text, size, out);
}

glint_status glint_line_check(const char *name, const char *text, glint_error *error)
{
    const glint_typeface typeface = glint_typeface_open(NULL, GLINT_FONT_HEIGHT);
    glint_line line;
    for (const char *at = text; *at;) {
        const size_t size = strcspn(at, "\n");
        const glint_formula_fault fault = set(&typeface, at, size, &line);
        if (fault.at)
            return glint_fail(error, GLINT_ERR_INVALID, "%s: %s at character %zu", name, fault.message,
                              1 + glint_font_count(text, (size_t)(fault.at - text)));
        at += size + (at[size] == '\n');
    }
    return GLINT_OK;
}

const char *glint_line_blank(const char *line, const char *at, const char *end)
{
    const char *signs[2];
    while (at < end && (at = memchr(at, ' ', (size_t)(end - at))) != NULL) {
        const char *from = line;
        while (find_formula(from, end, signs) && signs[1] < at)
            from = signs[1] + 1;
        if (!find_formula(from, end, signs) || at < signs[0])
            return at;
        at = signs[1];
    }
    return NULL;
}

/// Returns the bytes of a token of a formula: a command, or one byte.
static size_t token_size(const char *at)
{
    const size_t letters = *at == '\\' ? strspn(at + 1, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ") : 0;
    return letters ? 1 + letters : *at == '\\' ? 2 : 1;
}

static bool is_token(const char *at, size_t size, const char *const *names)
{
    for (; *names; names++)
        if (strlen(*names) == size && memcmp(at, *names, size) == 0)
            return true;
    return false;
}

const char *glint_line_operator(const char *line, const char *at, const char *end)
{
    static const char *const signs[] = { "=", "+", "-", "<", ">", "\\approx", "\\propto", "\\sim", "\\le", "\\leq", "\\ge", "\\geq", "\\to", NULL };
    static const char *const opening[] = { "{", "(", "[", "\\left", NULL }, *const closing[] = { "}", ")", "]", "\\right", NULL };
    const char *formula[2];
    for (const char *from = line; find_formula(from, end, formula); from = formula[1] + 1) {
        int depth = 0;
        bool has_operand = false; // a sign without an operand before it belongs to the operand after it
        for (const char *t = formula[0] + 1; t < formula[1]; t += token_size(t)) {
            const size_t size = token_size(t);
            const bool is_sign = is_token(t, size, signs);
            depth += is_token(t, size, opening) - is_token(t, size, closing);
            if (t >= at && is_sign && has_operand && depth == 0)
                return t;
            has_operand = *t == ' ' ? has_operand : !is_sign;
        }
    }
    return NULL;
}

static void draw_rule(const glint_rule *rule, double x, double y, glint_mask *mask)
{
    const double low[2] = { x + rule->x, y + rule->y }, high[2] = { low[0] + rule->width, low[1] + rule->height };
    const int first[2] = { (int)fmax(0, floor(low[0])), (int)fmax(0, floor(low[1])) };
    const int last[2] = { (int)fmin(mask->width, ceil(high[0])), (int)fmin(mask->height, ceil(high[1])) };
    for (int row = first[1]; row < last[1]; row++)
        for (int column = first[0]; column < last[0]; column++) {
            const double wide = fmin(high[0], column + 1) - fmax(low[0], column);
            const double tall = fmin(high[1], row + 1) - fmax(low[1], row);
            uint8_t *to = mask->coverage + (size_t)row * (size_t)mask->width + (size_t)column;
            *to = (uint8_t)(*to + (255 - *to) * wide * tall + 0.5);
        }
}

void glint_line_draw(const glint_typeface *typeface, const glint_line *line, int x, int y, glint_mask *mask)
{
    for (int i = 0; i < line->run_count; i++) {
        glint_run run = line->runs[i];
        run.x += x;
        run.y += y;
        glint_typeface_draw(typeface, &run, mask);
    }
    for (int i = 0; i < line->rule_count; i++)
        draw_rule(&line->rules[i], x, y, mask);
}
