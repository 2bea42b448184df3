/// Noise, cells, hash and parity: range, continuity, uniformity. Tests the reference kernels.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/render/program/builder.h"
#include "tests/engine/cases/random.h"

static void pattern_at(glint_op op, double x, double y, double z, double results[GLINT_RESULTS_MAX])
{
    const double operands[GLINT_OPERANDS_MAX] = { x, y, z };
    glint_fold(op, NULL, operands, results);
}

static double pattern(glint_op op, double x, double y, double z)
{
    double results[GLINT_RESULTS_MAX];
    pattern_at(op, x, y, z, results);
    return results[0];
}

static void test_noise_range(void **state)
{
    (void)state;
    double least = 1, most = -1, sum = 0, square = 0;
    const int count = 1000000;
    random_state = 61000;
    for (int i = 0; i < count; i++) {
        const double x = between(-1e4, 1e4), y = between(-1e4, 1e4), z = between(-1e4, 1e4);
        const double n = pattern(GLINT_OP_NOISE, x, y, z);
        least = n < least ? n : least;
        most = n > most ? n : most;
        sum += n;
        square += n * n;
    }
    print_message("noise: %.4f .. %.4f, mean %.5f, deviation %.4f\n", least, most, sum / count, sqrt(square / count));
    assert_true(least >= -1 && most <= 1 && least < -0.85 && most > 0.85);
    assert_true(fabs(sum / count) < 0.001 && fabs(sqrt(square / count) - 0.25) < 0.05);
}

/// Perlin noise would be highest if every gradient were the best one. Times the scale, that value is just below 1.
static void test_noise_scale(void **state)
{
    (void)state;
    static const double way[3] = { 0.355256691, 0.481492214, 0.5 };
    double sum = 0;
    for (int c = 0; c < 8; c++) {
        double weight = 1, size[3], least = 1;
        for (int k = 0; k < 3; k++) {
            const double t = way[k], fade = t * t * t * (t * (t * 6 - 15) + 10);
            weight *= c >> k & 1 ? fade : 1 - fade;
            size[k] = c >> k & 1 ? 1 - t : t;
            least = size[k] < least ? size[k] : least;
        }
        sum += weight * (size[0] + size[1] + size[2] - least);
    }
    assert_true(sum * 0.9649 <= 1 && sum * 0.9649 > 0.9999);
}

/// Noise and its slope are continuous across the faces of cubes. Noise is 0 at integers, and works far from the origin.
static void test_noise_continuity(void **state)
{
    (void)state;
    random_state = 62000;
    for (int i = 0; i < 20000; i++) {
        double p[3] = { between(-99, 99), between(-99, 99), between(-99, 99) };
        const int axis = (int)below(3);
        p[axis] = floor(p[axis]);
        const double middle = pattern(GLINT_OP_NOISE, p[0], p[1], p[2]);
        p[axis] -= 1e-6;
        const double before = pattern(GLINT_OP_NOISE, p[0], p[1], p[2]);
        p[axis] += 2e-6;
        const double after = pattern(GLINT_OP_NOISE, p[0], p[1], p[2]);
        assert_true(fabs(middle - before) < 4e-6 && fabs((after - middle) - (middle - before)) < 1e-10);
        assert_true(pattern(GLINT_OP_NOISE, floor(p[0]), floor(p[1]), floor(p[2])) == 0);
    }
    assert_true(fabs(pattern(GLINT_OP_NOISE, 1e7 + 0.25, -1e7 + 0.5, 0.75)) > 1e-3);
    assert_true(isnan(pattern(GLINT_OP_NOISE, NAN, 0, 0)) && isnan(pattern(GLINT_OP_NOISE, 0, INFINITY, 0)));
}

/// The gradients of neighbours and of the three noises are uncorrelated.
static void test_noise_unlike(void **state)
{
    (void)state;
    double product[4] = { 0 }, square = 0;
    const int count = 100000;
    random_state = 63000;
    for (int i = 0; i < count; i++) {
        const double x = between(0, 200), y = between(0, 200), z = between(0, 200);
        double three[GLINT_RESULTS_MAX];
        const double n = pattern(GLINT_OP_NOISE, x, y, z);
        pattern_at(GLINT_OP_NOISE3, x, y, z, three);
        product[0] += n * three[0];
        product[1] += three[0] * three[1];
        product[2] += n * pattern(GLINT_OP_NOISE, x + 2, y, z);
        product[3] += n * pattern(GLINT_OP_NOISE, y, x, z);
        square += n * n;
    }
    for (int k = 0; k < 4; k++)
        assert_true(fabs(product[k] / square) < 0.02);
}

/// Returns chi-square of 64 boxes. With 63 degrees of freedom it is above 120 only once in 100000 times.
static double chi_square(const uint32_t box[64], double count)
{
    double sum = 0;
    for (int i = 0; i < 64; i++)
        sum += (box[i] - count / 64) * (box[i] - count / 64) / (count / 64);
    return sum;
}

static void test_hash(void **state)
{
    (void)state;
    uint32_t value[64] = { 0 }, lattice[64] = { 0 }, step[3][64] = { { 0 } };
    random_state = 64000;
    for (int i = 0; i < 64000; i++) {
        const double x = i % 40, y = i / 40 % 40, z = i / 1600;
        const double h = pattern(GLINT_OP_HASH, x, y, z), any = pattern(GLINT_OP_HASH, between(-1, 1), x, 0);
        assert_true(h >= 0 && h < 1);
        lattice[(int)(h * 64)]++;
        value[(int)(any * 64)]++;
        for (int k = 0; k < 3; k++) {
            const double next = pattern(GLINT_OP_HASH, x + (k == 0), y + (k == 1), z + (k == 2)) - h;
            step[k][(int)((next - floor(next)) * 64) & 63]++;
        }
    }
    assert_true(chi_square(value, 64000) < 120 && chi_square(lattice, 64000) < 120);
    for (int k = 0; k < 3; k++)
        assert_true(chi_square(step[k], 64000) < 120);
    assert_true(pattern(GLINT_OP_HASH, 0.0, 1, 2) == pattern(GLINT_OP_HASH, -0.0, 1, 2));
    assert_true(pattern(GLINT_OP_HASH, NAN, 1, 2) == pattern(GLINT_OP_HASH, -NAN, 1, 2));
    assert_true(pattern(GLINT_OP_HASH, 1, 2, 3) != pattern(GLINT_OP_HASH, 2, 1, 3));
}

/// Gradients are uniformly distributed: 12 of the 16 kinds can be distinguished by their slopes at integers.
static void test_gradients(void **state)
{
    (void)state;
    uint32_t zero[3] = { 0 }, count = 0;
    double sum[3] = { 0 };
    for (int i = 0; i < 64000; i++) {
        const double at[GLINT_OPERANDS_MAX] = { i % 40, i / 40 % 40, i / 1600, 0 };
        double slope[GLINT_RESULTS_MAX];
        glint_fold(GLINT_OP_NOISE_SLOPE, NULL, at, slope);
        for (int k = 0; k < 3; k++) {
            zero[k] += slope[k] == 0;
            sum[k] += slope[k];
            count += slope[k] != 0;
        }
    }
    assert_int_equal(count, 2 * 64000);
    assert_true(fabs(zero[0] / 64000.0 - 6.0 / 16) < 0.01); // x is nonzero in 10 of Perlin's 16 gradients
    for (int k = 0; k < 3; k++)
        assert_true(fabs(sum[k]) < 800);
}

/// A distance grows no faster than the point moves, and the second distance is no smaller than the first. If the
/// search overlooked a feature point, this would fail at the borders of the search.
static void test_cells(void **state)
{
    (void)state;
    random_state = 65000;
    double far = 0;
    for (int i = 0; i < 100000; i++) {
        double a[GLINT_RESULTS_MAX], b[GLINT_RESULTS_MAX];
        double p[3] = { between(-50, 50), between(-50, 50), between(-50, 50) }, q[3], way2 = 0;
        for (int k = 0; k < 3; k++) {
            q[k] = p[k] + between(-0.01, 0.01);
            if (one_in(4))
                q[k] = floor(p[k] + 0.5) + between(-1e-9, 1e-9);
            way2 += (q[k] - p[k]) * (q[k] - p[k]);
        }
        pattern_at(GLINT_OP_CELL, p[0], p[1], p[2], a);
        pattern_at(GLINT_OP_CELL, q[0], q[1], q[2], b);
        assert_true(a[0] >= 0 && a[0] <= a[1] && a[0] <= sqrt(3));
        for (int n = 0; n < 2; n++)
            assert_true(fabs(a[n] - b[n]) <= sqrt(way2) + 1e-12);
        far = a[1] > far ? a[1] : far;
    }
    assert_true(far > 1.1 && far < 1.7); // the distances are so large that the outer cubes were needed
}

static void test_parity(void **state)
{
    (void)state;
    random_state = 66000;
    for (int i = 0; i < 100000; i++) {
        const double size = one_in(2) ? 10 : 1e15;
        const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
        const long long sum = (long long)floor(x) + (long long)floor(y) + (long long)floor(z);
        assert_true(pattern(GLINT_OP_PARITY, x, y, z) == (double)(sum & 1));
    }
    assert_true(pattern(GLINT_OP_PARITY, -0.5, 0, 0) == 1 && pattern(GLINT_OP_PARITY, 1e300, 0, 0) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_noise_range),
        cmocka_unit_test(test_noise_scale),
        cmocka_unit_test(test_noise_continuity),
        cmocka_unit_test(test_noise_unlike),
        cmocka_unit_test(test_hash),
        cmocka_unit_test(test_gradients),
        cmocka_unit_test(test_cells),
        cmocka_unit_test(test_parity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
