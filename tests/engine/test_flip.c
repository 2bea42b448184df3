/// FLIP against a direct implementation of the paper's formulas in two dimensions, values computed by hand, and
/// properties; the other error measures on pictures with known errors.
#include "engine/compare/flip.h"
#include "engine/glint_compare.h"
#include "tests/engine/cases/image_case.h"

#include <math.h>

#define SIDE_MAX 40

// ---- The reference: doubles, full 2D filters, cbrt, pow and exp of the C library ----------------------------------

#define PPD (0.7 * (3840 / 0.7) * (3.14159265358979323846 / 180))

typedef struct oracle {
    int width, height;
    double rgb[3][SIDE_MAX * SIDE_MAX];
} oracle;

static const double XYZ[3][3] = { { 10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794 },
                                  { 2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897 },
                                  { 1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382 } };

static void white_relative(const double rgb[3], double w[3])
{
    for (int i = 0; i < 3; i++)
        w[i] = (XYZ[i][0] * rgb[0] + XYZ[i][1] * rgb[1] + XYZ[i][2] * rgb[2]) / (XYZ[i][0] + XYZ[i][1] + XYZ[i][2]);
}

static void opponent_at(const oracle *o, int x, int y, double out[3])
{
    x = x < 0 ? 0 : x >= o->width ? o->width - 1 : x;
    y = y < 0 ? 0 : y >= o->height ? o->height - 1 : y;
    double rgb[3] = { o->rgb[0][y * SIDE_MAX + x], o->rgb[1][y * SIDE_MAX + x], o->rgb[2][y * SIDE_MAX + x] }, w[3];
    white_relative(rgb, w);
    out[0] = 116 * w[1] - 16;
    out[1] = 500 * (w[0] - w[1]);
    out[2] = 200 * (w[1] - w[2]);
}

static double sensitivity(int channel, double d2) // d2 is in squared degrees
{
    static const double pi = 3.14159265358979323846;
    static const double a[3][2] = { { 1, 0 }, { 1, 0 }, { 34.1, 13.5 } };
    static const double b[3][2] = { { 0.0047, 1e-5 }, { 0.0053, 1e-5 }, { 0.04, 0.025 } };
    double sum = 0;
    for (int i = 0; i < 2; i++)
        sum += a[channel][i] * sqrt(pi / b[channel][i]) * exp(-pi * pi * d2 / b[channel][i]);
    return sum;
}

static void solve3(const double w[3], double rgb[3]) // Solves the equations of the matrix above by Cramer's rule.
{
    double m[3][3], det = 0, v[3];
    for (int i = 0; i < 3; i++)
        v[i] = w[i] * (XYZ[i][0] + XYZ[i][1] + XYZ[i][2]);
    for (int column = -1; column < 3; column++) {
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                m[i][j] = j == column ? v[i] : XYZ[i][j];
        double d = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                   m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                   m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
        if (column < 0)
            det = d;
        else
            rgb[column] = fmin(1, fmax(0, d / det));
    }
}

static double lab_f(double t) { return t > pow(6.0 / 29, 3) ? cbrt(t) : t / (3 * pow(6.0 / 29, 2)) + 4.0 / 29; }

static void lab_of(const double rgb[3], double lab[3])
{
    double w[3];
    white_relative(rgb, w);
    lab[0] = 116 * lab_f(w[1]) - 16;
    lab[1] = 500 * (lab_f(w[0]) - lab_f(w[1])) * 0.01 * lab[0];
    lab[2] = 200 * (lab_f(w[1]) - lab_f(w[2])) * 0.01 * lab[0];
}

static void seen_color(const oracle *o, int x, int y, double lab[3])
{
    double sum[3] = { 0 }, weight[3] = { 0 }, rgb[3];
    for (int j = -10; j <= 10; j++)
        for (int i = -10; i <= 10; i++) {
            double v[3];
            opponent_at(o, x + i, y + j, v);
            for (int c = 0; c < 3; c++) {
                double g = sensitivity(c, (i * i + j * j) / (PPD * PPD));
                sum[c] += g * v[c];
                weight[c] += g;
            }
        }
    double l = (sum[0] / weight[0] + 16) / 116;
    double w[3] = { sum[1] / weight[1] / 500 + l, l, l - sum[2] / weight[2] / 200 };
    solve3(w, rgb);
    lab_of(rgb, lab);
}

static double feature(const oracle *o, int x, int y, int order)
{
    const double sd = 0.5 * 0.082 * PPD;
    const int r = (int)ceil(3 * sd);
    double along[2] = { 0 };
    for (int axis = 0; axis < 2; axis++) {
        double plus = 0, minus = 0, sum_plus = 0, sum_minus = 0;
        for (int j = -r; j <= r; j++)
            for (int i = -r; i <= r; i++) {
                double k = axis ? j : i, v[3], g = exp(-(i * i + j * j) / (2 * sd * sd));
                double tap = order == 1 ? -k * g : (k * k / (sd * sd) - 1) * g;
                opponent_at(o, x + i, y + j, v);
                *(tap > 0 ? &plus : &minus) += fabs(tap);
                *(tap > 0 ? &sum_plus : &sum_minus) += fabs(tap) * (v[0] + 16) / 116;
            }
        along[axis] = sum_plus / plus - sum_minus / minus;
    }
    return hypot(along[0], along[1]);
}

static double hyab(const double a[3], const double b[3]) { return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]); }

static double oracle_flip(const oracle *a, const oracle *b)
{
    double green[3], blue[3], sum = 0;
    lab_of((double[3]) { 0, 1, 0 }, green);
    lab_of((double[3]) { 0, 0, 1 }, blue);
    double largest = pow(hyab(green, blue), 0.7), knee = 0.4 * largest;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            double la[3], lb[3];
            seen_color(a, x, y, la);
            seen_color(b, x, y, lb);
            double e = pow(hyab(la, lb), 0.7);
            e = e < knee ? 0.95 / knee * e : 0.95 + (e - knee) / (largest - knee) * 0.05;
            double edge = fabs(feature(a, x, y, 1) - feature(b, x, y, 1));
            double point = fabs(feature(a, x, y, 2) - feature(b, x, y, 2));
            sum += pow(e, 1 - pow(fmax(edge, point) / sqrt(2), 0.5));
        }
    return sum / (a->width * a->height);
}

// ---- Pictures -----------------------------------------------------------------------------------------------------

static glint_flip *flip_of(const oracle *o)
{
    float planes[3][SIDE_MAX * SIDE_MAX];
    const float *const rgb[3] = { planes[0], planes[1], planes[2] };
    glint_flip *flip = NULL;
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < o->height; y++)
            for (int x = 0; x < o->width; x++)
                planes[c][y * o->width + x] = (float)o->rgb[c][y * SIDE_MAX + x];
    assert_int_equal(glint_flip_create(o->width, o->height, rgb, &flip, NULL), GLINT_OK);
    return flip;
}

static double flip_between(const oracle *a, const oracle *b)
{
    glint_flip *fa = flip_of(a), *fb = flip_of(b);
    double mean = glint_flip_mean(fa, fb);
    glint_flip_destroy(fa);
    glint_flip_destroy(fb);
    return mean;
}

static oracle flat(int width, int height, double r, double g, double b)
{
    oracle o = { .width = width, .height = height };
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            o.rgb[0][y * SIDE_MAX + x] = r;
            o.rgb[1][y * SIDE_MAX + x] = g;
            o.rgb[2][y * SIDE_MAX + x] = b;
        }
    return o;
}

static double random_unit(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

/// Patches of one colour with speckles: edges, points and flat areas.
static oracle speckled(int width, int height, uint32_t seed)
{
    oracle o = { .width = width, .height = height };
    double patch[3] = { 0 };
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++) {
                if (x % 9 == 0)
                    patch[c] = (float)random_unit(&seed);
                double speck = random_unit(&seed);
                o.rgb[c][y * SIDE_MAX + x] = speck < 0.1 ? (float)speck * 10 : patch[c];
            }
    return o;
}

// ---- FLIP ---------------------------------------------------------------------------------------------------------

static void test_flip_by_hand(void **state)
{
    (void)state;
    oracle black = flat(24, 24, 0, 0, 0), white = flat(24, 24, 1, 1, 1);
    oracle green = flat(24, 24, 0, 1, 0), blue = flat(24, 24, 0, 0, 1);
    // White has L* = 100, black 0: HyAB 100, 100^0.7 = 25.1189. The largest distance is between green and blue,
    // 87.735, -75.61, 72.98 and 32.297, 25.58, -34.84 with Hunt: 55.438 + 147.86 = 203.30, ^0.7 = 41.276. The knee is
    // at 16.510; 0.95 + 0.05 (25.1189 - 16.510) / (41.276 - 16.510) = 0.96738.
    assert_float_equal(flip_between(&black, &white), 0.96738, 2e-5);
    assert_float_equal(flip_between(&green, &blue), 1, 1e-5);
    // L* 50 is Y = ((50 + 16) / 116)^3: HyAB 50, 50^0.7 = 15.4626; 0.95 * 15.4626 / 16.510 = 0.8897.
    double y = pow(66.0 / 116, 3);
    oracle grey = flat(24, 24, y, y, y);
    assert_float_equal(flip_between(&black, &grey), 0.8897, 1e-4);
}

static void test_flip_oracle(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 33, 21 }, { 1, 1 }, { 40, 1 }, { 1, 17 }, { 5, 40 } };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        oracle a = speckled(sizes[i][0], sizes[i][1], 7), b = speckled(sizes[i][0], sizes[i][1], 8);
        double got = flip_between(&a, &b), want = oracle_flip(&a, &b);
        if (fabs(got - want) > 2e-5 || want < 0.05)
            fail_msg("%d x %d: %.9g, want %.9g", a.width, a.height, got, want);
        assert_true(got == flip_between(&b, &a));
        assert_true(flip_between(&a, &a) == 0);
    }
}

static void test_flip_grows(void **state)
{
    (void)state;
    oracle a = flat(30, 30, 0.3, 0.3, 0.3), b = a;
    double before = 0;
    for (int i = 1; i <= 5; i++) { // a dot of growing brightness
        b.rgb[1][15 * SIDE_MAX + 15] = 0.3 + 0.1 * i;
        double now = flip_between(&a, &b);
        assert_true(now > before && now < 1);
        before = now;
    }
}

// ---- The reference ------------------------------------------------------------------------------------------------

static void fill(glint_image *image, float value, int odd_pixel, float odd)
{
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < image->width * image->height; i++)
            image->plane[GLINT_PASS_BEAUTY][c][i] = i == odd_pixel ? odd : value;
}

static glint_image *film(int width, int height, float value, int odd_pixel, float odd)
{
    glint_image *image = NULL;
    assert_int_equal(glint_image_create(width, height, 1u << GLINT_PASS_BEAUTY, NULL, &image, NULL), GLINT_OK);
    fill(image, value, odd_pixel, odd);
    return image;
}

static void test_reference_known(void **state)
{
    (void)state;
    const glint_tone_desc tone = glint_tone_desc_default();
    const float code = (float)glint_srgb_decode(100 / 255.0);
    glint_image *halves[2] = { film(10, 10, code - 0.001f, -1, 0), film(10, 10, code + 0.001f, -1, 0) };
    glint_image *test = film(10, 10, code, 37, (float)glint_srgb_decode(110 / 255.0));
    glint_reference *reference = NULL;
    glint_picture_error got;
    assert_int_equal(glint_reference_create((const glint_image *const *)halves, 2, &tone, &reference, NULL), GLINT_OK);
    assert_int_equal(glint_reference_measure(reference, test, 0, &got, NULL), GLINT_OK);
    double d = glint_srgb_decode(110 / 255.0) - (double)code;
    assert_float_equal(got.rmse, sqrt(d * d / 100), 1e-7);
    assert_float_equal(got.relmse, d * d / ((double)code * code + 0.01) / 100, 1e-7);
    assert_true(got.max_code == 10 && got.over1 == 0.01 && got.over8 == 0.01);
    assert_true(got.flip > 0 && got.flip < 0.2);

    // Written to a file, exact pixel values lose nothing at either depth.
    // A value off by 0.4 of an 8-bit step loses only that.
    glint_picture_error file;
    for (int bits = 8; bits <= 16; bits += 8) {
        assert_int_equal(glint_reference_measure(reference, test, bits, &file, NULL), GLINT_OK);
        assert_float_equal(file.rmse, got.rmse, 2e-6);
    }
    fill(test, (float)glint_srgb_decode(100.4 / 255), -1, 0);
    assert_int_equal(glint_reference_measure(reference, test, 8, &file, NULL), GLINT_OK);
    assert_true(file.rmse < 1e-6);
    assert_int_equal(glint_reference_measure(reference, test, 16, &file, NULL), GLINT_OK);
    assert_float_equal(file.rmse, glint_srgb_decode(100.4 / 255) - (double)code, 1e-5);
    assert_float_equal(file.max_code, 0.4, 0.003);
    fill(test, 3, -1, 0); // brighter than white: a file cannot store it, so the float value counts
    assert_int_equal(glint_reference_measure(reference, test, 8, &file, NULL), GLINT_OK);
    assert_float_equal(file.rmse, 3 - (double)code, 1e-6);

    glint_image_release(halves[0]);
    glint_image_release(halves[1]);
    glint_image_release(test);
    glint_reference_destroy(reference);
    glint_reference_destroy(NULL);
}

// Exposure and curve change how a file stores light, not the light itself: an error of 0.4 steps stays 0.4 steps.
static void test_reference_tones(void **state)
{
    (void)state;
    const glint_tone_curve curves[] = { GLINT_TONE_CLAMP, GLINT_TONE_REINHARD, GLINT_TONE_FILMIC };
    for (int i = 0; i < 9; i++) {
        glint_tone_desc tone = glint_tone_desc_default();
        tone.curve = curves[i % 3];
        tone.exposure = i / 3 * 3 - 3; // exposures -3, 0, 3
        const double gain = exp2(tone.exposure);
        const double light = glint_tone_curve_inverse(tone.curve, glint_srgb_decode(100 / 255.0)) / gain;
        const double off = glint_tone_curve_inverse(tone.curve, glint_srgb_decode(100.4 / 255)) / gain;
        glint_image *base = film(4, 3, (float)light, -1, 0), *test = film(4, 3, (float)off, -1, 0);
        glint_reference *reference = NULL;
        glint_picture_error got;
        assert_int_equal(glint_reference_create((const glint_image *const *)&base, 1, &tone, &reference, NULL),
                         GLINT_OK);
        assert_int_equal(glint_reference_measure(reference, test, 0, &got, NULL), GLINT_OK);
        assert_float_equal(got.rmse / light, off / light - 1, 1e-5);
        assert_int_equal(glint_reference_measure(reference, test, 16, &got, NULL), GLINT_OK);
        assert_float_equal(got.rmse / light, off / light - 1, 1e-4); // a value is off by half a 16-bit step at most
        assert_float_equal(got.max_code, 0.4, 0.003);
        assert_int_equal(glint_reference_measure(reference, test, 8, &got, NULL), GLINT_OK);
        assert_true(got.rmse < 1e-6 * light);
        fill(test, (float)(1e5 * light), -1, 0); // white, whose pixel value has no finite light under reinhard
        assert_int_equal(glint_reference_measure(reference, test, 8, &got, NULL), GLINT_OK);
        assert_float_equal(got.rmse / light, 1e5 - 1, 1);
        glint_image_release(base);
        glint_image_release(test);
        glint_reference_destroy(reference);
    }
}

static void test_reference_picture(void **state)
{
    (void)state;
    const glint_tone_desc tone = glint_tone_desc_default();
    glint_image *base = film(4, 3, (float)glint_srgb_decode(100 / 255.0), -1, 0), *difference = NULL;
    glint_image *test = film(4, 3, (float)glint_srgb_decode(103 / 255.0), 5, 1);
    glint_reference *reference = NULL;
    assert_int_equal(glint_reference_create((const glint_image *const *)&base, 1, &tone, &reference, NULL), GLINT_OK);
    assert_int_equal(glint_reference_difference(reference, test, 16, &difference, NULL), GLINT_OK);
    for (int i = 0; i < 4 * 3 * 3; i++)
        assert_int_equal(((uint8_t *)difference->codes)[i], i / 3 == 5 ? 255 : 48);
    assert_ptr_not_equal(glint_reference_image(reference), NULL);
    glint_image_release(base);
    glint_image_release(test);
    glint_image_release(difference);
    glint_reference_destroy(reference);
}

static void test_reference_refuses(void **state)
{
    (void)state;
    const glint_tone_desc tone = glint_tone_desc_default();
    glint_image *a = film(4, 3, 0, -1, 0), *b = film(3, 4, 0, -1, 0), *ids = NULL;
    const glint_image *const two[2] = { a, b };
    glint_reference *reference = NULL;
    glint_picture_error got;
    glint_error error;
    assert_int_equal(glint_image_create(4, 3, 1u << GLINT_PASS_OBJECT_ID, NULL, &ids, NULL), GLINT_OK);
    assert_int_equal(glint_reference_create(two, 0, &tone, &reference, &error), GLINT_ERR_INVALID);
    assert_int_equal(glint_reference_create(two, 2, &tone, &reference, &error), GLINT_ERR_INVALID);
    assert_non_null(strstr(error.message, "4 x 3 pixels expected, got 3 x 4"));
    assert_int_equal(glint_reference_create(two, 1, &tone, &reference, &error), GLINT_OK);
    assert_int_equal(glint_reference_measure(reference, b, 0, &got, &error), GLINT_ERR_INVALID);
    assert_int_equal(glint_reference_measure(reference, ids, 0, &got, &error), GLINT_ERR_INVALID);
    assert_int_equal(glint_reference_measure(reference, a, 12, &got, &error), GLINT_ERR_INVALID);
    assert_non_null(strstr(error.message, "file_bits"));
    glint_image_release(a);
    glint_image_release(b);
    glint_image_release(ids);
    glint_reference_destroy(reference);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flip_by_hand),      cmocka_unit_test(test_flip_oracle),
        cmocka_unit_test(test_flip_grows),        cmocka_unit_test(test_reference_known),
        cmocka_unit_test(test_reference_tones),   cmocka_unit_test(test_reference_picture),
        cmocka_unit_test(test_reference_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
