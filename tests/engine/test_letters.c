/// Text through FreeType: the coverage of a letter, reproducible and independent of clipping, and the choice of font.
/// Skipped without FreeType or without a font.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/figures/text/line.h"

static glint_letters *open_font(void)
{
    glint_letters *letters = NULL;
    unsetenv("GLINT_FONT");
    assert_int_equal(glint_letters_open(&letters, NULL), GLINT_OK);
    if (!letters)
        skip();
    return letters;
}

static glint_mask draw(const glint_typeface *typeface, const char *text, int x, int y, int width, int height)
{
    glint_mask mask = { width, height, calloc((size_t)width, (size_t)height) };
    assert_non_null(mask.coverage);
    const glint_run run = { text, SIZE_MAX, x, y + typeface->above, typeface->em, 0, 1, false, false };
    glint_typeface_draw(typeface, &run, &mask);
    return mask;
}

static long ink_of(const glint_mask *mask)
{
    long sum = 0;
    for (int i = 0; i < mask->width * mask->height; i++)
        sum += mask->coverage[i];
    return sum;
}

static void test_widths(void **state)
{
    (void)state;
    glint_letters *letters = open_font();
    const glint_typeface small = glint_typeface_open(letters, 20), large = glint_typeface_open(letters, 200);
    assert_true(glint_typeface_width(&small, "W", SIZE_MAX) > 2 * glint_typeface_width(&small, "i", SIZE_MAX));
    assert_true(abs(10 * glint_typeface_width(&small, "Hello", SIZE_MAX) - glint_typeface_width(&large, "Hello", SIZE_MAX)) <= 10);
    assert_int_equal(glint_typeface_width(&small, "", SIZE_MAX), 0);
    assert_int_equal(glint_typeface_width(&small, "Hello", 1), glint_typeface_width(&small, "H", SIZE_MAX));
    assert_true(small.above > 14 && small.above < small.height && small.line >= small.height - 1);
    glint_letters_close(letters);
}

/// A letter stands on the baseline and stays below the typeface's height. Greek letters and signs exist and differ.
static void test_shapes(void **state)
{
    (void)state;
    glint_letters *letters = open_font();
    const glint_typeface face = glint_typeface_open(letters, 40);
    static const char *const texts[] = { "H", "\xce\xb1", "\xc2\xb0", "\xe2\x88\x92", "\xe2\x82\x80" }; // alpha, degree, minus, subscript 0
    glint_mask masks[5];
    for (int i = 0; i < 5; i++) {
        masks[i] = draw(&face, texts[i], 0, 0, 60, face.height);
        assert_true(ink_of(&masks[i]) > 20 * 255);
        for (int k = 0; k < i; k++)
            assert_memory_not_equal(masks[i].coverage, masks[k].coverage, (size_t)60 * (size_t)face.height);
    }
    for (int x = 0; x < 60; x++) { // no part of an H is below the baseline
        for (int y = face.above; y < face.height; y++)
            assert_int_equal(masks[0].coverage[y * 60 + x], 0);
    }
    long foot = 0;
    for (int x = 0; x < 60; x++)
        foot += masks[0].coverage[(face.above - 1) * 60 + x];
    assert_true(foot > 4 * 255);
    for (int i = 0; i < 5; i++)
        free(masks[i].coverage);
    glint_letters_close(letters);
}

/// A clipped window shows the same pixels as the whole text.
static void test_cut(void **state)
{
    (void)state;
    glint_letters *letters = open_font();
    const glint_typeface face = glint_typeface_open(letters, 31.5);
    const glint_mask all = draw(&face, "fjord \xc3\x85gW", 5, 3, 200, 50);
    const glint_mask again = draw(&face, "fjord \xc3\x85gW", 5, 3, 200, 50);
    const glint_mask part = draw(&face, "fjord \xc3\x85gW", 5 - 37, 3 - 14, 90, 21);
    assert_memory_equal(all.coverage, again.coverage, 200 * 50);
    assert_true(ink_of(&all) > 0);
    for (int y = 0; y < 21; y++)
        assert_memory_equal(part.coverage + y * 90, all.coverage + (y + 14) * 200 + 37, 90);
    free(all.coverage);
    free(again.coverage);
    free(part.coverage);
    glint_letters_close(letters);
}

/// The pixels of a line with a formula. They are compared where the font and the library are Debian 12's (DejaVu Sans
/// 2.37, FreeType 2.12.1), which the key identifies.
/// Elsewhere the test compares sizes, which depend on neither hinting nor antialiasing.
static void test_pinned(void **state)
{
    (void)state;
    glint_letters *letters = open_font();
    static glint_line line;
    const glint_typeface face = glint_typeface_open(letters, 20);
    char key[33], pixels[33];
    glint_line_set(&face, "Snell $\\frac{\\sin\\theta_1}{\\sin\\theta_2}=\\frac{n_2}{n_1}$", SIZE_MAX, &line);
    glint_mask mask = { 160, 80, calloc(160, 80) };
    assert_non_null(mask.coverage);
    glint_line_draw(&face, &line, 4, 40, &mask);
    glint_key_hex(glint_letters_key(letters), key);
    glint_key_hex(glint_key_add((glint_key) { 0 }, mask.coverage, 160 * 80), pixels);
    if (strcmp(key, "ddc13588899c41c421ee8f600fa788df") == 0)
        assert_string_equal(pixels, "274bcc97086d5dfe655959f79fd75e0c");
    assert_true(line.width > 140 && line.width < 200 && line.rule_count == 2);
    assert_true(ink_of(&mask) > 300 * 255);
    free(mask.coverage);
    glint_letters_close(letters);
}

static void test_choice(void **state)
{
    (void)state;
    glint_error error;
    glint_letters *letters = open_font();
    const glint_key font = glint_letters_key(letters);
    glint_letters_close(letters);
    setenv("GLINT_FONT", "bitmap", 1);
    assert_int_equal(glint_letters_open(&letters, &error), GLINT_OK);
    assert_null(letters);
    assert_false(glint_key_equal(font, glint_letters_key(letters)));
    setenv("GLINT_FONT", "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf", 1);
    if (!glint_letters_open(&letters, &error)) {
        assert_non_null(letters);
        assert_false(glint_key_equal(font, glint_letters_key(letters)));
        glint_letters_close(letters);
    }
    setenv("GLINT_FONT", "/dev/null", 1);
    assert_int_equal(glint_letters_open(&letters, &error), GLINT_ERR_INVALID);
    assert_non_null(strstr(error.message, "GLINT_FONT: expected the file of a scalable font, or the word bitmap, got '/dev/null'"));
    letters = open_font();
    assert_true(glint_key_equal(font, glint_letters_key(letters)));
    glint_letters_close(letters);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_widths), cmocka_unit_test(test_shapes), cmocka_unit_test(test_cut), cmocka_unit_test(test_choice),
        cmocka_unit_test(test_pinned)
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
