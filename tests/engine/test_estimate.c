/// The error of a picture from its own samples: the seeds of partners, and the estimate of pictures with known errors.
#include "engine/glint_compare.h"
#include "tests/engine/cases/image_case.h"

#include <math.h>

/// A partner has another seed than the frame, always the same one, whose shift has all of its digits.
static void test_partner_seed(void **state)
{
    static const int64_t seeds[] = { 0, 1, 2, 7, 123456, INT64_C(1) << 53 };
    (void)state;
    int64_t before = 0;
    for (size_t i = 0; i < sizeof seeds / sizeof *seeds; i++)
        for (int64_t samples = 2; samples <= 65536; samples *= 2) {
            glint_render_desc desc = glint_render_desc_default();
            desc.samples = samples;
            desc.seed = seeds[i];
            const int64_t seed = glint_partner_seed(&desc);
            assert_true(seed > 0 && seed < 1 << 22 && seed != desc.seed && seed != before);
            assert_true(seed == glint_partner_seed(&desc));
            desc.seed = before = seed;
            assert_true(glint_partner_seed(&desc) != seed);
        }
}

static void test_known_errors(void **state)
{
    (void)state;
    glint_image *a = make_image(4, 2, NULL), *b = make_image(4, 2, NULL), *other = make_image(2, 4, NULL), *bare = NULL;
    glint_error error;
    double rmse = -1;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 8; i++) {
            a->plane[GLINT_PASS_BEAUTY][c][i] = 1;
            b->plane[GLINT_PASS_BEAUTY][c][i] = i % 2 ? 1.5f : 0.5f;
        }
    assert_int_equal(glint_estimate_error(a, b, NULL, &rmse, &error), GLINT_OK);
    assert_true(fabs(rmse - 0.5) < 1e-15);
    assert_true(glint_estimate_pixels(a, b, NULL) == 8);
    // as seen: one stop darker, both are below white; with clamp, 1.5 is as white as 1
    glint_tone_desc tone = glint_tone_desc_default();
    assert_int_equal(glint_estimate_error(a, b, &tone, &rmse, &error), GLINT_OK);
    assert_true(fabs(rmse - (1 - 0.735356983052449) * sqrt(0.5)) < 2e-5); // 0.7353 ...: sRGB of 0.5
    assert_true(glint_estimate_pixels(a, b, &tone) == 4);
    tone.exposure = -1;
    assert_int_equal(glint_estimate_error(a, b, &tone, &rmse, &error), GLINT_OK);
    const double dark = 0.735356983052449 - 0.537098730483194, bright = 0.880824780256386 - 0.735356983052449; // of 0.25, 0.75
    assert_true(fabs(rmse - sqrt((dark * dark + bright * bright) / 2)) < 2e-5);
    a->plane[GLINT_PASS_BEAUTY][0][3] = NAN;
    b->plane[GLINT_PASS_BEAUTY][1][5] = INFINITY;
    assert_int_equal(glint_estimate_error(a, b, NULL, &rmse, &error), GLINT_OK);
    assert_true(fabs(rmse - 0.5 * sqrt(22 / 24.0)) < 1e-15);
    assert_int_equal(glint_estimate_error(a, a, NULL, &rmse, &error), GLINT_OK);
    assert_true(rmse == 0 && isinf(glint_estimate_pixels(a, a, NULL)));
    assert_true(glint_estimate_pixels(a, other, NULL) == 0 && glint_estimate_pixels(NULL, a, NULL) == 0);
    for (int c = 0; c < 3; c++)
        memcpy(b->plane[GLINT_PASS_BEAUTY][c], a->plane[GLINT_PASS_BEAUTY][c], 8 * sizeof(float));
    b->plane[GLINT_PASS_BEAUTY][0][6] = 100; // one pixel holds all of the difference
    assert_true(glint_estimate_pixels(a, b, NULL) == 1);
    assert_int_equal(glint_estimate_error(a, other, NULL, &rmse, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "partner: 4 x 2 pixels expected, got 2 x 4");
    assert_int_equal(glint_image_create(4, 2, 1u << GLINT_PASS_DEPTH, NULL, &bare, &error), GLINT_OK);
    assert_int_equal(glint_estimate_error(bare, a, NULL, &rmse, &error), GLINT_ERR_INVALID);
    assert_int_equal(glint_estimate_error(a, bare, NULL, &rmse, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "image: expected a picture with its beauty pass");
    glint_image_release(a);
    glint_image_release(b);
    glint_image_release(other);
    glint_image_release(bare);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_partner_seed), cmocka_unit_test(test_known_errors) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
