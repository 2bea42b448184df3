/// Lines with formulas: which dollar signs enclose a formula, sizes computed by hand, spaces between signs, errors. In
/// the bitmap font at 130 pixels each character is 80 pixels wide, and a script of 91 pixels has characters of 56.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/figures/text/line.h"
#include "engine/glint_figures.h"

#define EM 130.0
#define LETTER 80.0
#define SCRIPT (0.7 * EM)
#define SCRIPT_LETTER 56.0

static glint_line line;

static void set(const char *text)
{
    const glint_typeface typeface = glint_typeface_open(NULL, EM);
    glint_error error;
    assert_int_equal(glint_line_check("text", text, &error), GLINT_OK);
    glint_line_set(&typeface, text, SIZE_MAX, &line);
}

static double width_of(const char *text)
{
    set(text);
    return line.width;
}

static bool is_run(int i, const char *text) { return line.runs[i].size == strlen(text) && memcmp(line.runs[i].text, text, strlen(text)) == 0; }

/// Joins the runs of a line, with a bar between two.
static const char *pieces(const char *text)
{
    static char joined[512];
    set(text);
    joined[0] = '\0';
    for (int i = 0; i < line.run_count; i++) {
        strcat(joined, i ? "|" : "");
        strncat(joined, line.runs[i].text, line.runs[i].size);
    }
    return joined;
}

static void test_dollars(void **state)
{
    (void)state;
    static const char *const texts[][2] = {
        { "$5", "$5" },
        { "$5 and $10", "$5 and $10" },
        { "\\$5", "$5" },
        { "a \\$ and $x$", "a |$ and |x" },
        { "$x$ and $y$", "x| and |y" },
        { "costs $ 5 $", "costs $ 5 $" },
        { "$5 or $x$", "$5 or |x" },
        { "a$b", "a$b" },
        { "$", "$" },
        { "x^2", "x^2" },
        { "\\alpha", "\\alpha" },
        { "$12.5$", "12.5" },
        { "\xc2\xb5 $\xce\xb1$", "\xc2\xb5 |\xce\xb1" },
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        assert_string_equal(pieces(texts[i][0]), texts[i][1]);
    // Plain text has the measures of its typeface.
    const glint_typeface typeface = glint_typeface_open(NULL, EM);
    assert_int_equal(width_of("Price: $5"), glint_typeface_width(&typeface, "Price: $5", SIZE_MAX));
    assert_int_equal(line.above + line.below, typeface.height);
    assert_int_equal(line.above, typeface.above);
}

/// A fraction is as wide as its widest part plus the space on both sides. Its bar is as wide as that part.
static void test_fraction(void **state)
{
    (void)state;
    assert_int_equal(width_of("$\\frac{abc}{d}$"), (int)ceil(3 * LETTER + 2 * 0.12 * EM));
    assert_int_equal(line.rule_count, 1);
    assert_true(line.rules[0].width == 3 * LETTER);
    assert_true(fabs(line.rules[0].x - 0.12 * EM) < 1e-9);
    assert_true(line.runs[0].x == line.rules[0].x && line.runs[3].x == line.rules[0].x + LETTER);
    assert_true(line.runs[0].em == EM && line.runs[3].em == EM); // a displayed formula has parts of full size
    const glint_rule *bar = &line.rules[0];
    const glint_run *low = &line.runs[3];
    assert_true(line.runs[0].y < bar->y && low->y - glint_typeface_box(&(glint_typeface) { .scale = 10 }, low).above > bar->y + bar->height);
    assert_true(line.above > 1.3 * EM && line.below > EM / 2);
    set("$x^{\\frac{a}{b}}$"); // in a superscript, the parts are as small as the superscript's own scripts
    assert_true(line.runs[1].em == 0.5 * EM);
    set("$\\frac{\\frac{a}{b}}{c}$");
    assert_true(line.runs[0].em == SCRIPT && line.runs[2].em == EM);
}

static void test_scripts(void **state)
{
    (void)state;
    assert_int_equal(width_of("$x^2_3$"), (int)ceil(LETTER + SCRIPT_LETTER + 0.05 * EM));
    assert_true(line.runs[1].em == SCRIPT && line.runs[2].em == SCRIPT);
    assert_true(line.runs[1].x == LETTER && line.runs[2].x == LETTER);
    assert_true(line.runs[1].y < 0 && line.runs[2].y > 0);
    assert_true(floor(line.runs[1].y) == line.runs[1].y); // in whole pixels
    set("$x_{y_{z_w}}$");
    assert_true(line.runs[1].em == SCRIPT && line.runs[2].em == 0.5 * EM && line.runs[3].em == 0.5 * EM);
    set("$x^2$");
    const double y = line.runs[1].y;
    set("$x_1^2$");
    assert_true(line.runs[2].y == y);
    set("$\\left(\\frac{a}{b}\\right)^2$"); // a tall base raises its exponent
    assert_true(line.runs[4].y < y);
}

static void test_spaces(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double letters, eighteenths;
    } cases[] = {
        { "$a+b$", 3, 8 },
        { "$a=b$", 3, 10 },
        { "$a = -b$", 4, 10 }, // a sign, not a difference
        { "$-a$", 2, 0 },
        { "$(-a)$", 4, 0 },
        { "$a,b$", 3, 3 },
        { "$ab$", 2, 0 },
        { "$a\\,b\\;c\\quad d$", 4, 3 + 5 + 18 },
        { "$\\cos x$", 4, 3 },
        { "$\\cos(x)$", 6, 0 },
        { "$a\\cos x$", 5, 6 },
        { "$1-\\cos x$", 6, 4 + 4 + 3 },
        { "$a+$", 2, 0 },
        { "$a-=b$", 4, 10 },
        { "$\\text{a b}$", 3, 0 },
        { "$\\mathrm{max}$", 3, 0 },
        { "$0.25$", 4, 0 },
        { "$a\\le b$", 3, 10 },
        { "$a\\to\\infty$", 3, 10 },
        { "$2\\times 3$", 3, 8 },
        { "$a\\mapsto b$", 3, 10 },
        { "$a\\equiv b$", 3, 10 },
        { "$\\operatorname{max} x$", 4, 3 },
        { "$a\\mp b$", 4, 8 }, // the bitmap font has no such sign, and draws -+
        { "$a\\ b~c$", 3, 12 },
        { "$a\\!b\\:c$", 3, 4 - 3 },
        { "$\\lvert x\\rvert$", 3, 0 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double width = cases[i].letters * LETTER + cases[i].eighteenths / 18 * EM;
        assert_true(width_of(cases[i].text) >= width - 1e-6 && line.width < width + 1);
    }
    assert_int_equal(width_of("$x^{a+b=c}$"), (int)ceil(LETTER + 5 * SCRIPT_LETTER + 0.05 * EM)); // no spaces in scripts
}

static void test_roots_and_accents(void **state)
{
    (void)state;
    set("$\\sqrt{ab}$");
    assert_true(line.rules[0].width == 2 * LETTER);
    assert_true(line.runs[1].x == line.rules[0].x && line.runs[2].x == line.rules[0].x + LETTER);
    set("$\\sqrt[3]{x}$");
    assert_true(is_run(0, "3") && line.runs[0].em == 0.5 * EM && line.runs[0].y < 0);
    static const char *const accents[] = { "$\\hat n$", "$\\vec n$", "$\\tilde n$", "$\\dot n$" };
    for (int i = 0; i < 4; i++) {
        assert_int_equal(width_of(accents[i]), LETTER);
        assert_int_equal(line.run_count, 2);
    }
    set("$\\hat n$");
    const double low = line.runs[1].y;
    set("$\\hat l$"); // the hat is higher above a tall letter
    assert_true(line.runs[1].y < low);
    set("$\\bar{AB}$");
    assert_true(line.rule_count == 1 && line.rules[0].width == 2 * LETTER && line.rules[0].y < -0.7 * EM);
}

/// Commands of lecture notes: every one is set; digits and primes as TeX takes them.
static void test_lecture_notes(void **state)
{
    (void)state;
    static const char *const formulas[] = {
        "$\\mathcal{L}$", "$\\langle n, l \\rangle$", "$\\lVert x \\rVert$", "$\\binom{n}{k}$", "$\\prod_i x_i$", "$a \\ll b$",
        "$\\mathbb{R}^3$", "$\\boldsymbol{n}$", "$a \\sim b$", "$\\tfrac12$", "$\\ell$", "$\\mp 1$", "$a\\ b$", "$f'$",
        "$f^\\prime$", "$A^\\dagger$", "$\\operatorname{max}$", "$\\lfloor x \\rfloor$", "$\\frac12$", "$\\sum\\limits_{i=1}^n x$",
        "$\\left\\langle x \\right\\rangle$", "$\\bigl( x \\bigr)$", "$\\forall x \\in A \\Rightarrow x \\notin B$",
        "$\\overline{AB} \\underline{x}$", "$\\ddot x \\widehat{ab}$", "$\\operatorname*{argmax}_x f$", "$\\textbf{a b}$",
    };
    for (size_t i = 0; i < sizeof formulas / sizeof *formulas; i++)
        set(formulas[i]);
    assert_string_equal(pieces("$\\frac12$"), "1|2");
    assert_int_equal(line.rule_count, 1);
    assert_string_equal(pieces("$\\tfrac12 3$"), "1|2|3");
    assert_true(line.runs[0].em == SCRIPT && line.runs[2].em == EM);
    assert_string_equal(pieces("$\\binom nk$"), "(|n|k|)");
    assert_true(line.rule_count == 0 && line.runs[0].stretch > 1.5 && line.runs[1].x == line.runs[2].x);
    assert_string_equal(pieces("$\\displaystyle 2 \\textsf{a b}$"), "2|a b");
    assert_true(line.runs[0].x == 0);
    set("$f'$");
    const double x = line.runs[1].x, width = line.width;
    set("$f^\\prime$");
    assert_true(line.runs[1].em == EM && line.runs[1].y == 0 && line.runs[1].x == x && line.width <= width + 0.05 * EM + 1);
    set("$\\mathbb{R}$"); // a bold letter instead of one that the font lacks
    assert_true(is_run(0, "R") && line.runs[0].bold);
    set("$\\big(x\\Big($");
    assert_true(line.runs[0].stretch > 1 && line.runs[2].stretch > line.runs[0].stretch);
    set("$\\overline{AB}$");
    assert_true(line.rule_count == 1 && line.rules[0].x == 0 && line.rules[0].width == 2 * LETTER);
}

/// \left and \right cover the part between them.
static void test_fences(void **state)
{
    (void)state;
    set("$\\left(\\frac{a}{b}\\right)$");
    const glint_run *opening = &line.runs[0], *closing = &line.runs[3];
    assert_true(is_run(0, "(") && is_run(3, ")") && opening->stretch > 1.5 && opening->stretch == closing->stretch);
    set("$\\left.x\\right|$");
    assert_true(line.run_count == 2 && line.runs[1].stretch == 1);
}

static void test_faults(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        { "$\\foo$", "text: expected a command that formulas have, got \\foo at character 2" },
        { "ab $x + \\hut n$", "text: expected a command that formulas have, got \\hut at character 9" },
        { "\xc3\xa4 $\\foo$", "text: expected a command that formulas have, got \\foo at character 4" },
        { "a\n$\\foo$", "text: expected a command that formulas have, got \\foo at character 4" },
        { "$\\$", NULL }, // the dollar sign is not the end of a formula
        { "$x\\\\y$", "text: expected a command that formulas have, got \\\\ at character 3" },
        { "$\\frac{a}$", "text: expected a sign or {...} after \\frac at character 2" },
        { "$\\frac$", "text: expected a sign or {...} after \\frac at character 2" },
        { "$\\hat$", "text: expected a sign or {...} after \\hat at character 2" },
        { "$x^$", "text: expected a sign or {...} after ^ at character 3" },
        { "$x_{}^{}$", NULL },
        { "$x^2^3$", "text: expected at most one ^ at a sign, got another at character 5" },
        { "${x$", "text: expected a } for the {, got none at character 2" },
        { "$x}$", "text: expected a { for each }, got a } at character 3" },
        { "$\\left(x$", "text: expected a \\right for the \\left, got none at character 2" },
        { "$x\\right)$", "text: expected a \\left for each \\right, got a \\right at character 3" },
        { "$\\left x\\right)$", "text: expected a delimiter such as ( ] | . \\{ \\| \\langle \\rfloor after \\left at character 2" },
        { "$\\sqrt[3{x}$", "text: expected a ] for the [, got none at character 7" },
        { "$\\text x$", "text: expected {...} after \\text at character 2" },
        { "$\\text{\\alpha}$", "text: expected only letters in \\text{...}, got \\ at character 8" },
        { "$a@b$", "text: expected a sign that formulas have, or \\text{@}, got @ at character 3" },
        { "$$", "text: expected a formula between dollar signs (\\$ is a dollar sign), got none at character 1" },
        { "$\\hat\\hat\\hat\\hat\\hat\\hat\\hat\\hat\\hat\\hat x$", "text: expected at most 10 nested parts, got more at character 43" },
        { "${{{{{{{{{{{x}}}}}}}}}}}$", "text: expected at most 10 nested parts, got more at character 12" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        glint_error error = { .message = "" };
        const glint_status status = glint_line_check("text", cases[i].text, &error);
        assert_int_equal(status, cases[i].message ? GLINT_ERR_INVALID : GLINT_OK);
        assert_string_equal(error.message, cases[i].message ? cases[i].message : "");
    }
    char text[400] = "$", signs[400] = "$";
    for (int i = 0; i < 200; i++)
        strcat(text, "x");
    for (int i = 0; i < 40; i++)
        strcat(signs, "\\bar x");
    glint_error error;
    assert_int_equal(glint_line_check("text", strcat(text, "$"), &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "text: expected at most 128 signs in the formulas of a line, got more at character 131");
    assert_int_equal(glint_line_check("text", strcat(signs, "$"), &error), GLINT_ERR_INVALID);
    assert_non_null(strstr(error.message, "text: expected at most 32 bars in a line, got more at character"));
}

/// A line is broken only outside its formulas.
static void test_blanks(void **state)
{
    (void)state;
    static const char text[] = "if $a + b$ is $5 or $c d$ less";
    static const int expected[] = { 2, 10, 13, 16, 19, 25 };
    size_t count = 0;
    for (const char *at = text; (at = glint_line_blank(text, at, text + sizeof text - 1)) != NULL; at++, count++)
        assert_int_equal(at - text, expected[count]);
    assert_int_equal(count, sizeof expected / sizeof *expected);
}

/// The mask of a line shows its letters and rules and nothing outside its extents.
static void test_drawing(void **state)
{
    (void)state;
    const glint_typeface typeface = glint_typeface_open(NULL, 26);
    glint_line_set(&typeface, "$\\sqrt{x}\\le\\frac{\\hat n}{2}$", SIZE_MAX, &line);
    const int margin = 20, width = line.width + 2 * margin, height = line.above + line.below + 2 * margin;
    glint_mask mask = { width, height, calloc((size_t)width, (size_t)height) };
    assert_non_null(mask.coverage);
    glint_line_draw(&typeface, &line, margin, margin + line.above, &mask);
    long inside = 0, all = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const int value = mask.coverage[y * width + x];
            all += value;
            if (y >= margin && y < height - margin && x >= margin - line.pad && x < width - margin + line.pad)
                inside += value;
        }
    assert_true(all > 100 * 255 && inside == all);
    const glint_rule *bar = &line.rules[1];
    const int x = margin + (int)ceil(bar->x), y = margin + line.above + (int)bar->y;
    assert_int_equal(mask.coverage[y * width + x], 255);
    assert_int_equal(mask.coverage[(y - 1) * width + x], 0);
    free(mask.coverage);
}

/// Programs can list the commands, and each of them can be set.
static void test_commands(void **state)
{
    (void)state;
    static const char *const expected[][3] = { { "alpha", "\xce\xb1", "variable" }, { "sum", "\xe2\x88\x91", "large" },
                                               { "le", "\xe2\x89\xa4", "relation" }, { "cos", "cos", "operator" } };
    const char *name, *text, *kind;
    size_t found = 0, count = 0;
    for (; (name = glint_formula_command(count, &text, &kind)) != NULL; count++) {
        char formula[64];
        snprintf(formula, sizeof formula, "$\\%s$", name);
        set(formula);
        for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
            found += !strcmp(name, expected[i][0]) && !strcmp(text, expected[i][1]) && !strcmp(kind, expected[i][2]);
    }
    assert_int_equal(found, sizeof expected / sizeof *expected);
    assert_true(count > 100);
    assert_null(glint_formula_command(SIZE_MAX, &text, &kind));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dollars),           cmocka_unit_test(test_fraction), cmocka_unit_test(test_scripts),
        cmocka_unit_test(test_spaces),            cmocka_unit_test(test_faults),   cmocka_unit_test(test_blanks),
        cmocka_unit_test(test_roots_and_accents), cmocka_unit_test(test_fences),
        cmocka_unit_test(test_commands),          cmocka_unit_test(test_lecture_notes),   cmocka_unit_test(test_drawing)
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
