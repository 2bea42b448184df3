/// What adaptive sampling chooses by estimates of codes is what it chooses by the codes.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "engine/film/tone.h"
#include "engine/frame/refine.h"

enum { WIDTH = 83, HEIGHT = 41, PIXELS = WIDTH * HEIGHT };

static uint64_t state = 1;

static double uniform(double low, double high)
{
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(state >> 33) / 0x1p31;
}

static glint_render_desc desc_of(float exposure)
{
    glint_render_desc desc = glint_render_desc_default();
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.tone.exposure = (double)exposure;
    return glint_plan_base(&desc);
}

/// Each row has a colour in every second pixel, and between them colours that are about the threshold from it; some are none.
static void paint(glint_image *image, double threshold)
{
    const float odd[4] = { NAN, HUGE_VALF, -1, 0x1p-140F };
    double of_row[3] = { 0 };
    for (size_t i = 0; i < PIXELS; i++) {
        const double step = i % WIDTH % 2 ? threshold / 3 * uniform(0.985, 1.015) : 0;
        for (int c = 0; c < 3; c++) {
            if (i % WIDTH == 0)
                of_row[c] = uniform(-0.02, 1.02);
            image->plane[GLINT_PASS_BEAUTY][c][i] = i % 97 == 5 ? odd[i / 97 % 4] : (float)glint_srgb_decode(of_row[c] + step);
            image->plane[GLINT_PASS_NORMAL][c][i] = c == 1;
        }
        image->plane[GLINT_PASS_OBJECT_ID][0][i] = 1;
    }
}

/// The choice by the codes of a picture, or where it has none by estimates; row by row.
static void choose(glint_pool *pool, const glint_image *image, const glint_render_desc *desc, double threshold,
                   uint8_t chosen[PIXELS])
{
    glint_refine refine = { 0 };
    for (int y = 0; y < HEIGHT; y++) {
        const glint_extent row = { .y = y, .width = WIDTH, .height = 1 };
        assert_int_equal(glint_refine_choose(&refine, image, &row, desc, threshold, false, pool, NULL), GLINT_OK);
        memcpy(chosen + y * WIDTH, refine.chosen + y * WIDTH, WIDTH);
    }
    glint_refine_clear(&refine);
}

static long try(glint_pool *pool, float exposure, double threshold)
{
    uint8_t by_codes[PIXELS], by_estimates[PIXELS];
    glint_render_desc desc = desc_of(exposure), coded = desc;
    const glint_tone_table *table;
    glint_image *image, *with;
    long count = 0;
    coded.codes = true;
    assert_int_equal(glint_image_create_for(&desc, &image, NULL), GLINT_OK);
    assert_int_equal(glint_image_create_for(&coded, &with, NULL), GLINT_OK);
    assert_null(image->codes);
    paint(image, threshold);
    for (int c = 0; c < 3; c++) {
        memcpy(with->plane[GLINT_PASS_BEAUTY][c], image->plane[GLINT_PASS_BEAUTY][c], PIXELS * sizeof(float));
        memcpy(with->plane[GLINT_PASS_NORMAL][c], image->plane[GLINT_PASS_NORMAL][c], PIXELS * sizeof(float));
    }
    memcpy(with->plane[GLINT_PASS_OBJECT_ID][0], image->plane[GLINT_PASS_OBJECT_ID][0], PIXELS * sizeof(float));
    assert_int_equal(glint_tone_table_shared(&coded.tone, &table, NULL), GLINT_OK);
    glint_tone_row16(table, glint_tone_gain(&coded.tone), with->plane[GLINT_PASS_BEAUTY][0], with->plane[GLINT_PASS_BEAUTY][1],
                     with->plane[GLINT_PASS_BEAUTY][2], PIXELS, with->codes, NULL, NULL);
    choose(pool, with, &coded, threshold, by_codes);
    choose(pool, image, &desc, threshold, by_estimates);
    for (size_t i = 0; i < PIXELS; i++) {
        assert_int_equal(by_estimates[i], by_codes[i]);
        count += by_codes[i];
    }
    glint_image_release(image);
    glint_image_release(with);
    return count;
}

static void test_choice(void **unused)
{
    (void)unused;
    static const double thresholds[] = { 0.0005, 0.004, 0.03, 0.2, 0.9 };
    glint_pool *pool;
    glint_tone_store_open();
    assert_int_equal(glint_pool_create(2, &pool, NULL), GLINT_OK);
    for (size_t k = 0; k < sizeof thresholds / sizeof *thresholds; k++) {
        long count = 0;
        for (int run = 0; run < 40; run++)
            count += try(pool, run % 4 ? 0 : (float)uniform(-2, 2), thresholds[k]);
        assert_true(count > 40 * PIXELS / 10 && count < 40 * PIXELS * 9 / 10);
    }
    glint_pool_destroy(pool);
    glint_tone_store_close();
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_choice) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
