/// Images: planes, tone, the passes as pictures, comparison.
#include "engine/glint_compare.h"
#include "tests/engine/cases/image_case.h"

// ---- Image --------------------------------------------------------------------------------------------------------

static void test_image_sizes(void **state) // test case I4
{
    (void)state;
    static const int sides[][2] = {{65536, 65536}, {1, 0}, {0, 1}, {-1, 5}, {65536, 1}};
    for (size_t i = 0; i < 5; i++) {
        glint_image *image = NULL;
        glint_error error;
        assert_int_equal(glint_image_create(sides[i][0], sides[i][1], 1, NULL, &image, &error), GLINT_ERR_INVALID);
        assert_null(image);
    }
    glint_image *thin = make_image(1, 10000, NULL);
    float out[3];
    glint_error error;
    assert_int_equal(glint_image_pixel(thin, GLINT_PASS_DEPTH, 0, 9999, out, NULL), GLINT_OK);
    assert_true(out[0] == out[1] || isinf(out[0]));
    assert_int_equal(glint_image_pixel(thin, GLINT_PASS_DEPTH, 1, 0, out, &error), GLINT_ERR_INVALID);
    assert_int_equal(glint_image_pixel(thin, GLINT_PASS_COUNT, 0, 0, out, &error), GLINT_ERR_INVALID);
    assert_true((uintptr_t)thin->plane[0][0] % 64 == 0);
    assert_null(thin->row_stamp);
    assert_ptr_equal(glint_image_retain(thin), thin);
    glint_image_release(thin);
    glint_image_release(thin);
    glint_image_release(NULL);
    glint_tone_desc tone = glint_tone_desc_default();
    glint_image *coded = make_image(3, 2 * GLINT_TILE_HEIGHT + 1, &tone);
    assert_int_equal(glint_image_stamps(coded), 3);
    for (size_t i = 0; i < 3; i++)
        assert_int_equal(coded->row_stamp[i], 0);
    glint_image_release(coded);
    for (int pass = 0; pass < GLINT_PASS_COUNT; pass++)
        assert_int_equal(glint_pass_from_name(glint_pass_name((glint_pass)pass)), pass);
    assert_int_equal(glint_pass_from_name("nothing"), GLINT_PASS_COUNT);
    assert_null(glint_pass_name(GLINT_PASS_COUNT));
}

// ---- Tone ---------------------------------------------------------------------------------------------------------

static void check_code(const glint_tone_table *table, float x)
{
    double want = glint_tone_value(&table->desc, x);
    if (code_of(table, x) != want)
        fail_msg("curve %d, %d bits, transfer %d, rounding %d: %a gives %d, want %g", (int)table->desc.curve,
                 table->desc.bits, (int)table->desc.transfer, (int)table->desc.rounding, (double)x, code_of(table, x),
                 want);
}

/// Checks every float where the pixel value could step: the inverse of each value, and up to 20 floats on either side.
static void check_every_step(const glint_tone_desc *desc)
{
    const glint_tone_table *table;
    assert_int_equal(glint_tone_table_shared(desc, &table, NULL), GLINT_OK);
    int max = desc->bits == 16 ? 65535 : 255;
    for (int k = 0; k <= 2 * max; k++) {
        double encoded = 0.5 * k / max;
        double y = desc->transfer == GLINT_TRANSFER_SRGB ? glint_srgb_decode(encoded) : encoded;
        float x = (float)glint_tone_curve_inverse(desc->curve, y);
        int reach = desc->bits == 16 ? 2 : 20;
        for (int i = 0; i < reach; i++)
            x = nextafterf(x, 0);
        for (int i = 0; i <= 2 * reach; i++, x = nextafterf(x, INFINITY))
            check_code(table, x);
    }
    for (uint32_t bits = 0; bits < 0x5a800000u; bits += 9973) { // checks a sample of all floats, too
        float x;
        memcpy(&x, &bits, sizeof x);
        check_code(table, x);
    }
    assert_int_equal(code_of(table, NAN), 0);
    assert_int_equal(code_of(table, INFINITY), max);
    assert_int_equal(code_of(table, -INFINITY), 0);
    const float limit = (float)glint_tone_curve_white(desc->curve);
    // the filmic limit, about 5.6, lies between two floats
    const float white = desc->curve == GLINT_TONE_CLAMP ? 1 : nextafterf(limit, INFINITY);
    assert_int_equal(code_of(table, white), max);
    assert_int_equal(code_of(table, 1.0001f * white), max);
    assert_int_equal(code_of(table, -1), 0);
}

static void test_tone_every_step(void **state)
{
    (void)state;
    for (int i = 0; i < 24; i++) {
        glint_tone_desc desc = {(glint_tone_curve)(i / 8), i & 1 ? GLINT_TRANSFER_LINEAR : GLINT_TRANSFER_SRGB,
                                i & 2 ? GLINT_ROUNDING_TRUNCATE : GLINT_ROUNDING_NEAREST, i & 4 ? 16 : 8, 0, false};
        check_every_step(&desc);
    }
}

static void test_tone_known(void **state) // test cases I1, I2, I3
{
    (void)state;
    glint_tone_desc linear = {GLINT_TONE_CLAMP, GLINT_TRANSFER_LINEAR, GLINT_ROUNDING_NEAREST, 8, 0, false};
    static const double in[] = {0.49999 / 255, 0.5 / 255, 1.5 / 255, 127.5 / 255, 0.999, 1.0001, NAN, -1, INFINITY};
    static const int want[] = {0, 1, 2, 128, 255, 255, 0, 0, 255};
    for (int i = 0; i < 9; i++)
        assert_int_equal((int)glint_tone_value(&linear, in[i]), want[i]);
    glint_tone_desc d8 = glint_tone_desc_default(), d16 = d8;
    d16.bits = 16;
    static const double light[] = {0.0031308, 0.18, 0.2140411, 0.5, 0.75, 1};
    static const int want8[] = {10, 118, 127, 188, 225, 255}, want16[] = {2651, 30235, 32767, 48192, 57725, 65535};
    for (int i = 0; i < 6; i++) {
        assert_int_equal((int)glint_tone_value(&d8, light[i]), want8[i]);
        assert_int_equal((int)glint_tone_value(&d16, light[i]), want16[i]);
    }
    for (int k = 0; k <= 255; k++)
        assert_int_equal((int)glint_tone_value(&d8, glint_srgb_decode(k / 255.0)), k);
    for (int k = 0; k <= 65535; k++)
        assert_int_equal((int)glint_tone_value(&d16, glint_srgb_decode(k / 65535.0)), k);
    d8.bits = 12;
    glint_tone_table *table = NULL;
    assert_int_equal(glint_tone_table_create(&d8, &table, NULL), GLINT_ERR_INVALID);
    double start = now_ms();
    assert_int_equal(glint_tone_table_create(&d16, &table, NULL), GLINT_OK);
    print_message("16-bit sRGB table: %.1f ms\n", now_ms() - start);
    glint_tone_table_destroy(table);
}

static void count_row(const glint_tone_table *table, float gain, const float *r, const float *g, const float *b, size_t count,
                      uint64_t counts[2])
{
    uint8_t rgb[18];
    glint_tone_row(table, gain, (const float *const[3]) {r, g, b}, NULL, (const int[2]) {0, 0}, count, rgb, counts);
}

static void test_tone_counts(void **state)
{
    (void)state;
    static const float r[] = {0.5f, 2, NAN, 0, INFINITY, -1}, g[] = {0.5f, 2, 0, -INFINITY, 0, 0}, b[6] = {0};
    glint_tone_desc desc = glint_tone_desc_default();
    const glint_tone_table *table;
    uint64_t counts[2] = {10, 20};
    assert_int_equal(glint_tone_table_shared(&desc, &table, NULL), GLINT_OK);
    count_row(table, 1, r, g, b, 6, counts);
    assert_int_equal(counts[0], 12);
    assert_int_equal(counts[1], 23);
    // 2 becomes exactly white, which is not clipped
    count_row(table, 0.5f, r, g, b, 6, counts);
    assert_int_equal(counts[0], 13);
    desc.curve = GLINT_TONE_REINHARD; // this curve clips nothing
    assert_int_equal(glint_tone_table_shared(&desc, &table, NULL), GLINT_OK);
    count_row(table, 1, r, g, b, 6, counts);
    assert_int_equal(counts[0], 13);
    desc.curve = GLINT_TONE_FILMIC;
    static const float bright[] = {5.5f, 5.7f, 1e30f, 0, 0, 0};
    assert_int_equal(glint_tone_table_shared(&desc, &table, NULL), GLINT_OK);
    count_row(table, 1, bright, g + 5, b, 1, counts);
    assert_int_equal(counts[0], 13);
    count_row(table, 1, bright + 1, b, b, 2, counts);
    assert_int_equal(counts[0], 15);
}

static void check_near(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance))
        fail_msg("%.17g, want %.17g", got, want);
}

/// The tone curves against the published formulas, over the range of light in typical scenes.
static void test_tone_curves(void **state)
{
    (void)state;
    static const double light[] = {1e-4, 0.01, 0.18, 0.5, 1, 2, 4, 5.5};
    for (int i = 0; i < 8; i++) {
        const double x = light[i];
        double hable[2];
        for (int k = 0; k < 2; k++) {
            const double v = k ? 11.2 : 2 * x;
            hable[k] = (v * (0.15 * v + 0.10 * 0.50) + 0.20 * 0.02) / (v * (0.15 * v + 0.50) + 0.20 * 0.30) - 0.02 / 0.30;
        }
        check_near(glint_tone_curve_value(GLINT_TONE_CLAMP, x), x < 1 ? x : 1, 0);
        check_near(glint_tone_curve_value(GLINT_TONE_REINHARD, x), x / (1 + x), 1e-15);
        check_near(glint_tone_curve_value(GLINT_TONE_FILMIC, x), hable[0] / hable[1], 1e-14);
        for (int curve = GLINT_TONE_REINHARD; curve <= GLINT_TONE_FILMIC; curve++) {
            const double y = glint_tone_curve_value((glint_tone_curve)curve, x);
            check_near(glint_tone_curve_inverse((glint_tone_curve)curve, y), x, 1e-13 * x);
        }
    }
}

/// One stop more equals twice the light, for every pixel value.
static void test_tone_exposure(void **state)
{
    (void)state;
    for (int i = 0; i < 6; i++) {
        glint_tone_desc plain = glint_tone_desc_default(), exposed;
        plain.curve = (glint_tone_curve)(i / 2);
        plain.bits = i & 1 ? 16 : 8;
        exposed = plain;
        exposed.exposure = -1.5;
        const float gain = glint_tone_gain(&exposed);
        check_near(gain, 0.35355339059327373, 2e-8);
        for (double x = 1e-5; x < 100; x *= 1.07)
            check_near(glint_tone_value(&exposed, (float)x), glint_tone_value(&plain, gain * (float)x), 0);
    }
    glint_tone_desc desc = glint_tone_desc_default();
    desc.exposure = 1;
    assert_int_equal((int)glint_tone_value(&desc, 0.25), 188);
    static const double wrong[] = {33, -33, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        desc.exposure = wrong[i];
        assert_int_equal(glint_tone_check(&desc, NULL), GLINT_ERR_INVALID);
    }
}

/// Returns entry x, y of Bayer's matrix of 2^level x 2^level, by its recursion M(2n) = [4M, 4M + 2; 4M + 3, 4M + 1].
static int bayer(int level, int x, int y)
{
    static const int corner[2][2] = {{0, 2}, {3, 1}};
    const int half = level ? 1 << (level - 1) : 0;
    return level ? 4 * bayer(level - 1, x % half, y % half) + corner[y / half][x / half] : 0;
}

/// Dithering: each pixel value by its threshold, the means of blocks, and whole values, for each curve.
static void test_tone_dither(void **state)
{
    (void)state;
    for (int curve = 0; curve < 3; curve++) {
        glint_tone_desc desc = {.curve = (glint_tone_curve)curve, .transfer = GLINT_TRANSFER_SRGB, .bits = 8, .dither = true};
        const glint_tone_table *table;
        assert_int_equal(glint_tone_table_shared(&desc, &table, NULL), GLINT_OK);
        for (double value = 0; value <= 255; value += value < 2 ? 0.0625 : 2.71875) {
            const double light = glint_tone_curve_inverse(desc.curve, glint_srgb_decode(value / 255));
            if (!(light < 1e6))
                continue;
            float row[8];
            double sum = 0;
            for (int i = 0; i < 8; i++)
                row[i] = (float)light;
            for (int y = 0; y < 8; y++) {
                uint8_t rgb[24];
                glint_tone_row(table, 1, (const float *const[3]) {row, row, row}, NULL, (const int[2]) {16, 40 + y}, 8, rgb, NULL);
                for (int x = 0; x < 8; x++) {
                    const double up = value + (4 * bayer(3, x, y) + 2) / 257.0;
                    if (fabs(up - round(up)) > 0.005) // the light is rounded to float, and its value to a 257th
                        assert_int_equal(rgb[3 * x], (int)up);
                    assert_int_equal(rgb[3 * x], rgb[3 * x + 2]);
                    sum += rgb[3 * x];
                }
            }
            check_near(sum / 64, value, value == floor(value) ? 0 : 0.01);
        }
    }
}

// ---- Passes as pictures -------------------------------------------------------------------------------------------

static void test_view_passes(void **state)
{
    (void)state;
    glint_image *image = make_image(40, 30, NULL);
    double nearest = INFINITY;
    for (size_t p = 0; p < 1200; p++)
        nearest = fmin(nearest, image->plane[GLINT_PASS_DEPTH][0][p]);
    for (int i = 0; i < 8; i++) {
        glint_write_desc desc = describe(in_folder("pass.png"));
        desc.pass = (glint_pass)(GLINT_PASS_DEPTH + i % 4);
        desc.tone.bits = i < 4 ? 8 : 16;
        int max = i < 4 ? 255 : 65535;
        write_ok(image, &desc);
        glint_bytes bytes = read_ok(desc.path);
        glint_png png;
        assert_int_equal(glint_png_decode(bytes.data, bytes.size, &png, NULL), GLINT_OK);
        for (size_t p = 0; p < 1200; p++)
            for (size_t c = 0; c < 3; c++) {
                int code = i < 4 ? ((uint8_t *)png.codes)[3 * p + c] : ((uint16_t *)png.codes)[3 * p + c];
                bool hit = image->plane[GLINT_PASS_OBJECT_ID][0][p] != 0;
                if (!hit)
                    assert_int_equal(code, 0);
                else if (desc.pass == GLINT_PASS_NORMAL)
                    assert_int_equal(code, c == 2 ? max : max / 2 + 1);
                else if (desc.pass == GLINT_PASS_ALPHA)
                    assert_int_equal(code, (int)floor(max * image->plane[GLINT_PASS_ALPHA][0][p] + 0.5));
                else if (desc.pass == GLINT_PASS_DEPTH)
                    assert_int_equal(code, (int)floor(max * (nearest / image->plane[GLINT_PASS_DEPTH][0][p]) + 0.5));
            }
        free(png.codes);
        free(bytes.data);
    }
    glint_image_release(image);
}

static void test_pass_not_cached(void **state)
{
    (void)state;
    glint_tone_desc tone = glint_tone_desc_default();
    glint_image *image = NULL;
    glint_error error;
    assert_int_equal(glint_image_create(4, 4, 0, &tone, &image, NULL), GLINT_OK);
    memset(image->codes, 7, 48);
    glint_write_desc desc = describe(in_folder("x.png"));
    write_ok(image, &desc);
    desc.tone.bits = 16;
    assert_int_equal(glint_image_write(image, &desc, &error), GLINT_ERR_INVALID);
    desc.pass = GLINT_PASS_DEPTH;
    assert_int_equal(glint_image_write(image, &desc, &error), GLINT_ERR_INVALID);
    desc.path = in_folder("x.tiff");
    assert_int_equal(glint_image_write(image, &desc, &error), GLINT_ERR_INVALID);
    assert_non_null(strstr(error.message, "x.tiff"));
    assert_non_null(strstr(error.message, ".pfm"));
    glint_image_release(image);
}

// ---- Compare and PFM ----------------------------------------------------------------------------------------------

static void test_compare(void **state)
{
    (void)state;
    glint_image *image = make_image(40, 30, NULL);
    glint_write_desc desc = describe(in_folder("a.pfm"));
    glint_compare_result r;
    glint_compare_desc limits = {0.2, 0.05};
    write_ok(image, &desc);
    assert_int_equal(glint_compare_files(desc.path, desc.path, NULL, &r, NULL), GLINT_OK);
    assert_true(r.max_error == 0 && isinf(r.peak_snr) && r.failed == 0 && r.channels == 3 && r.pixels == 1200);
    image->plane[0][1][40 * 3 + 7] += 0.25f;
    image->plane[0][2][40 * 9 + 2] += 0.125f;
    desc.path = in_folder("b.pfm");
    write_ok(image, &desc);
    assert_int_equal(glint_compare_files(in_folder("a.pfm"), desc.path, &limits, &r, NULL), GLINT_OK);
    assert_true(r.max_x == 7 && r.max_y == 3 && r.max_channel == 1 && fabs(r.max_error - 0.25) < 1e-6);
    assert_true(r.failed == 1 && r.warned == 2);
    assert_true(fabs(r.mean_error - 0.375 / 3600) < 1e-8);
    assert_true(fabs(r.rms_error - sqrt(0.078125 / 3600)) < 1e-8);
    assert_true(fabs(r.peak_snr - 20 * log10(1 / r.rms_error)) < 1e-9);
    desc.pass = GLINT_PASS_DEPTH; // one channel, equal infinities
    desc.path = in_folder("depth.pfm");
    write_ok(image, &desc);
    assert_int_equal(glint_compare_files(desc.path, desc.path, NULL, &r, NULL), GLINT_OK);
    assert_true(r.channels == 1 && r.max_error == 0);
    assert_int_equal(glint_compare_files(desc.path, in_folder("a.pfm"), NULL, &r, NULL), GLINT_ERR_INVALID);
    assert_int_equal(r.width, -1);
    assert_int_equal(glint_compare_files(desc.path, in_folder("none.pfm"), NULL, &r, NULL), GLINT_ERR_IO);
    glint_bytes bytes = read_ok(in_folder("depth.pfm"));
    assert_memory_equal(bytes.data, "Pf\n40 30\n-1.0\n", 14);
    assert_int_equal(bytes.size, 14 + 4800);
    assert_int_equal(glint_file_write(in_folder("cut.pfm"), bytes.data, bytes.size - 1, NULL), GLINT_OK);
    assert_int_equal(glint_compare_files(desc.path, in_folder("cut.pfm"), NULL, &r, NULL), GLINT_ERR_FORMAT);
    free(bytes.data);
    glint_image_release(image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_image_sizes), cmocka_unit_test(test_tone_known), cmocka_unit_test(test_tone_every_step),
        cmocka_unit_test(test_tone_counts),   cmocka_unit_test(test_tone_curves), cmocka_unit_test(test_tone_exposure), cmocka_unit_test(test_tone_dither), WITH_FOLDER(test_view_passes),     WITH_FOLDER(test_pass_not_cached),
        WITH_FOLDER(test_compare),
    };
    glint_tone_store_open();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    glint_tone_store_close();
    return failed;
}
