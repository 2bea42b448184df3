/// The brightest value of pictures, the number of clipped values, and the exposure that avoids clipping.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "engine/film/image.h"
#include "engine/film/tone.h"
#include "engine/glint_inspect.h"

#define WIDTH 4
#define HEIGHT 3

/// An image whose red plane is `red`. Its other channels are 0.25.
static glint_image *new_image(uint32_t passes, const float red[WIDTH * HEIGHT])
{
    glint_image *image;
    glint_error error;
    assert_int_equal(glint_image_create(WIDTH, HEIGHT, passes, NULL, &image, &error), GLINT_OK);
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++)
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < WIDTH * HEIGHT && image->plane[pass][c]; i++)
                image->plane[pass][c][i] = c == 0 ? red[i] : 0.25f;
    return image;
}

static void test_brightness(void **state)
{
    static const float red[WIDTH * HEIGHT] = { 0, 1, 1.5f, 3, INFINITY, NAN, -7, 0.5f, 2, 4, 0, 0 };
    glint_image *image = new_image(1u << GLINT_PASS_BEAUTY, red);
    glint_brightness sum = { 0 };
    glint_error error;
    (void)state;
    assert_int_equal(glint_image_brightness(image, 0, &sum, &error), GLINT_OK);
    assert_true(sum.most == 4 && sum.values == 3 * WIDTH * HEIGHT && sum.clipped == 4 && sum.pictures == 1);
    assert_int_equal(glint_image_brightness(image, -1, &sum, &error), GLINT_OK);
    assert_true(sum.most == 4 && sum.values == 6 * WIDTH * HEIGHT && sum.clipped == 6 && sum.pictures == 2);
    assert_int_equal(glint_image_brightness(image, -2, &sum, &error), GLINT_OK);
    assert_int_equal(sum.clipped, 6);
    glint_image_release(image);
    image = new_image(1u << GLINT_PASS_DEPTH, red);
    assert_int_equal(glint_image_brightness(image, 0, &sum, &error), GLINT_ERR_INVALID);
    double range[2] = { INFINITY, -INFINITY };
    assert_int_equal(glint_image_range(image, GLINT_PASS_DEPTH, range, &error), GLINT_OK);
    assert_true(range[0] == -7 && range[1] == 4);
    assert_int_equal(glint_image_range(image, GLINT_PASS_BEAUTY, range, &error), GLINT_ERR_INVALID);
    assert_int_equal(glint_image_brightness(NULL, 0, &sum, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "image: pointer expected, got NULL");
    glint_image_release(image);
}

/// -log2 of the brightest value, rounded down to hundredths.
static void test_exposure(void **state)
{
    static const double pairs[][2] = { { 1, 0 }, { 2, -1 },     { 0.5, 1 },    { 3, -1.59 }, { 2.31, -1.21 },
                                       { 0, 0 }, { 0.9, 0.15 }, { 1e30, -32 }, { 1e-30, 32 } };
    (void)state;
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        assert_true(glint_exposure_for(pairs[i][0]) == pairs[i][1]);
    for (int k = 1; k < 4000; k++) {
        const float most = (float)(0.01 * k);
        glint_tone_desc tone = { .exposure = glint_exposure_for((double)most) };
        assert_true(glint_tone_gain(&tone) * most <= 1);
        tone.exposure += 0.01;
        assert_true(glint_tone_gain(&tone) * most > 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_brightness), cmocka_unit_test(test_exposure) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
