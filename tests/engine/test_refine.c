/// The pixel choice of adaptive sampling: its kernels on every instruction set against the scalar reference, and the
/// choice by estimated pixel values against the choice by exact ones.
#include "tests/engine/cases/stage_case.h"

#include "engine/film/tone.h"
#include "engine/render/adaptive/choose.h"
#include "tests/engine/cases/floor_scene.h"

enum { WIDTH = 32, HEIGHT = 41, PIXELS = WIDTH * HEIGHT };

static glint_render_desc desc_of(double exposure, double threshold)
{
    glint_render_desc desc = glint_render_desc_default();
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.adaptive = threshold;
    desc.tone.exposure = exposure;
    return glint_plan_base(&desc);
}

/// The even pixels of a row have one colour. The odd pixels have colours that differ from it by about the threshold.
/// Some pixels have special values.
static void paint(glint_image *image, double threshold)
{
    const float odd[4] = { NAN, HUGE_VALF, -1, 0x1p-140F };
    double of_row[3] = { 0 };
    for (size_t i = 0; i < PIXELS; i++) {
        const double step = i % WIDTH % 2 ? threshold / 3 * between(0.985, 1.015) : 0;
        for (int c = 0; c < 3; c++) {
            if (i % WIDTH == 0)
                of_row[c] = between(-0.02, 1.02);
            image->plane[GLINT_PASS_BEAUTY][c][i] = i % 97 == 5 ? odd[i / 97 % 4] : (float)glint_srgb_decode(of_row[c] + step);
        }
    }
}

/// Compares neighbours in a row of the picture, by the pixel values or by estimates of them.
static uint32_t compare_row(const glint_refine *refine, size_t y)
{
    _Alignas(64) float light[48] = { 0 }, code[4][48], id[48] = { 0 };
    const float *line[GLINT_DIFFER_VALUES] = { id, id, id, id, code[0], code[1], code[2], code[3] };
    const glint_estimate_args estimate = { .count = 48, .gain = refine->gain, .light = light };
    uint32_t differ[GLINT_DIFFER_DIRECTIONS];
    for (int c = 0; c < 3; c++) {
        glint_estimate_args args = estimate;
        args.code = code[c];
        memcpy(light, refine->base->plane[GLINT_PASS_BEAUTY][c] + y * WIDTH, WIDTH * sizeof *light);
        refine->stages->estimate(&args);
        for (size_t x = 0; x < WIDTH && refine->coded; x++)
            code[c][x] = ((const uint16_t *)refine->base->codes)[3 * (y * WIDTH + x) + (size_t)c];
    }
    glint_refine_lines lines = { .args = { .p = line, .ahead = WIDTH - 1, .count = WIDTH, .along = true } };
    for (int c = 0; c < 3; c++)
        lines.light[0][c] = lines.light[1][c] = refine->base->plane[GLINT_PASS_BEAUTY][c] + y * WIDTH;
    glint_refine_compare(refine, &lines, differ);
    return differ[GLINT_DIFFER_ALONG];
}

/// Returns the number of differing pairs.
static long try(double exposure, double threshold)
{
    glint_render_desc desc = desc_of(exposure, threshold), coded = desc;
    const glint_tone_table *table;
    glint_refine by_codes = { 0 }, by_estimates = { 0 };
    glint_image *image;
    long count = 0;
    coded.codes = true;
    coded.tone = glint_plan_compared(&desc);
    assert_int_equal(glint_image_create_for(&coded, &image, NULL), GLINT_OK);
    paint(image, threshold);
    assert_int_equal(glint_tone_table_shared(&coded.tone, &table, NULL), GLINT_OK);
    float *const *beauty = image->plane[GLINT_PASS_BEAUTY];
    glint_tone_row(table, glint_tone_gain(&coded.tone), (const float *const[3]) { beauty[0], beauty[1], beauty[2] }, NULL,
                   (const int[2]) { 0, 0 }, PIXELS, image->codes, NULL);
    assert_int_equal(glint_refine_begin(&by_estimates, running, image, &desc, NULL), GLINT_OK);
    assert_int_equal(glint_refine_begin(&by_codes, running, image, &desc, NULL), GLINT_OK);
    assert_false(by_estimates.coded);
    by_codes.coded = true;
    by_codes.low = by_codes.high = (float)by_codes.least;
    for (size_t y = 0; y < HEIGHT; y++) {
        const uint32_t codes = compare_row(&by_codes, y);
        assert_int_equal(compare_row(&by_estimates, y), codes);
        count += __builtin_popcount(codes);
    }
    glint_refine_clear(&by_codes);
    glint_refine_clear(&by_estimates);
    glint_image_release(image);
    return count;
}

static void test_choice(void **unused)
{
    (void)unused;
    static const double thresholds[] = { 0.0005, 0.004, 0.03, 0.2, 0.9 };
    glint_tone_store_open();
    FOR_EACH_TESTED
    {
        random_state = 1;
        for (size_t k = 0; k < COUNT_OF(thresholds); k++) {
            long count = 0;
            for (int run = 0; run < 40; run++)
                count += try(run % 4 ? 0 : between(-2, 2), thresholds[k]);
            assert_true(count > 40 * PIXELS / 20 && count < 40 * PIXELS * 9 / 10);
        }
    }
    glint_tone_store_close();
}

// ---- The kernels --------------------------------------------------------------------------------------------------

static void estimate_case(int precision, bool odd)
{
    const uint32_t count = GLINT_GROUP * (1 + below(5));
    float *light = input(KIND_FLOAT, count);
    const float gain = one_in(2) ? 1 : 1.7F;
    (void)precision;
    for (uint32_t i = 0; i < count; i++)
        light[i] = (float)maybe_odd(odd, one_in(3) ? power_of_ten(-6, 1) : between(-0.1, 1.2));
    FOR_EACH_TESTED
    {
        const glint_estimate_args args = { count, gain, light, output("code", KIND_FLOAT, count) };
        running->estimate(&args);
        compare_outputs("estimate");
    }
}

/// Fills a line with values that often equal another line's, and with pixel values around the limits `low` and `high`.
static void fill_line(float *const line[GLINT_DIFFER_VALUES], bool odd)
{
    for (uint32_t i = 0; i < GLINT_DIFFER_LENGTH; i++) {
        line[GLINT_DIFFER_ID][i] = (float)(one_in(4) ? below(3) : 1);
        for (int c = 0; c < 3; c++)
            line[GLINT_DIFFER_NORMAL + c][i] = (float)maybe_odd(odd, one_in(3) ? between(-0.3, 0.3) : c == 1);
        for (int c = 0; c < 4; c++)
            line[GLINT_DIFFER_CODE + c][i] = (float)between(0, 100);
    }
}

static void differ_case(int precision, bool odd)
{
    float *lines[2][GLINT_DIFFER_VALUES];
    const uint32_t count = 1 + below(GLINT_DIFFER_PAIRS), ahead = one_in(2) ? count - 1 : count;
    const float low = (float)between(0, 150), high = low + (float)(one_in(2) ? 0 : between(0, 60));
    const bool along = one_in(2), across = !along || one_in(2), alpha = one_in(2);
    (void)precision;
    for (int line = 0; line < 2; line++) {
        for (int v = 0; v < GLINT_DIFFER_VALUES; v++) {
            float *array = input(KIND_FLOAT, GLINT_DIFFER_LENGTH + 1);
            lines[line][v] = array + 1; // an unaligned address
        }
        fill_line(lines[line], odd);
    }
    const glint_differ_args args = { .p = (const float *const *)lines[0],
                                     .q = across ? (const float *const *)lines[1] : NULL,
                                     .count = count,
                                     .ahead = ahead,
                                     .along = along,
                                     .alpha = alpha,
                                     .low = low,
                                     .high = high,
                                     .cosine = GLINT_REFINE_NORMAL };
    FOR_EACH_TESTED
    {
        uint32_t *bits = output("differences", KIND_U32, 2 * GLINT_DIFFER_DIRECTIONS);
        glint_differences found;
        running->differ(&args, &found);
        memcpy(bits, &found, sizeof found);
        compare_outputs("differ");
    }
}

static void test_kernels(void **unused)
{
    (void)unused;
    run_cases(400, 23000, estimate_case);
    run_cases(2000, 24000, differ_case);
}

// ---- A picture with pixel values only ----

/// Makes balls over a floor, under a light of this intensity.
static glint_scene *make_balls(double strength)
{
    glint_scene *scene = make_floor((const double[3]) { 0, 3, 9 }, (const double[3]) { 0, 0.8, 0 });
    glint_light_desc d = glint_light_desc_default(GLINT_LIGHT_POINT);
    glint_light *light;
    memcpy(d.position, (const double[3]) { 2, 6, 5 }, sizeof d.position);
    d.intensity = strength;
    assert_int_equal(glint_light_create(&d, &light, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_light(scene, light, NULL), GLINT_OK);
    glint_light_release(light);
    for (int i = 0; i < 6; i++)
        add_ball(scene, (const double[3]) { 1.3 * (i % 3 - 1), 0.5, i / 3 - 0.5 }, 0.5, 0.2 * (i % 2));
    return scene;
}

static glint_image *render_codes(const glint_scene *scene, uint32_t passes, int threads, glint_frame_stats *stats)
{
    glint_renderer_desc renderer_desc = glint_renderer_desc_default();
    glint_render_desc desc = glint_render_desc_default();
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    renderer_desc.threads = threads;
    renderer_desc.no_reuse = threads > 1;
    desc.width = 101;
    desc.height = 75;
    desc.samples = 5;
    desc.adaptive = 0.1;
    desc.codes = true;
    desc.passes = passes;
    assert_int_equal(glint_renderer_create(&renderer_desc, &renderer, NULL), GLINT_OK);
    assert_int_equal(glint_plan_create(scene, &desc, &plan, NULL), GLINT_OK);
    assert_int_equal(glint_render(renderer, plan, &image, stats, NULL), GLINT_OK);
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    return image;
}

/// A picture without stored light has the same pixel values and counts as a picture with stored light: when no, some
/// or nearly all values are clipped, and with infinite light.
static void test_codes_alone(void **unused)
{
    static const double strength[4] = { 0.4, 1.9, 30, 1e39 };
    (void)unused;
    for (int i = 0; i < 8; i++) {
        glint_scene *scene = make_balls(strength[i % 4]);
        glint_frame_stats with, alone;
        glint_image *light = render_codes(scene, 1u << GLINT_PASS_BEAUTY, 1 + i / 4, &with);
        glint_image *codes = render_codes(scene, 0, 1 + i / 4, &alone);
        assert_true(with.refined > 100 && with.refined < 5000);
        assert_int_equal(alone.refined, with.refined);
        assert_int_equal(alone.clipped, with.clipped);
        assert_int_equal(alone.nonfinite, with.nonfinite);
        assert_int_equal(alone.clipped > 0, i % 4 > 0);
        assert_memory_equal(codes->codes, light->codes, 101 * 75 * glint_image_pixel_bytes(light));
        glint_image_release(light);
        glint_image_release(codes);
        glint_scene_release(scene);
    }
}

int main(void)
{
    find_tested();
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_kernels), cmocka_unit_test(test_choice),
                                        cmocka_unit_test(test_codes_alone) };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    print_skipped();
    return failed;
}
