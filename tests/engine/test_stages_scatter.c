/// Directions for indirect light: every instruction set against the scalar reference, the reference against closed
/// forms, and the low-discrepancy sequence.
#include "engine/base/sequence.h"
#include "tests/engine/cases/stage_rays.h"

#define ALIGNED _Alignas(64)

#define CASES 300

static void scatter_case(int precision, bool odd)
{
    const uint32_t groups = 1 + below(6), n = groups * GLINT_GROUP;
    const void *normal[3];
    input3(normal, real_kind(precision), n);
    uint32_t *drawn[4];
    for (int k = 0; k < 4; k++)
        drawn[k] = input(KIND_U32, n);
    for (uint32_t i = 0; i < n; i++) {
        double v[3];
        random_unit(v);
        if (one_in(6))
            v[2] = copysign(one_in(2) ? 0 : 1e-9, v[2]);
        for (int k = 0; k < 3; k++)
            v[k] = maybe_odd(odd, v[k]);
        put3(normal, precision, i, v);
        for (int k = 0; k < 4; k++)
            drawn[k][i] = one_in(5) ? below(2) - 1 : (uint32_t)random_bits();
    }
    glint_scatter_args args = { .group_count = groups,
                                .wanted = masks(groups),
                                .number = drawn[0],
                                .order = drawn[1],
                                .digits = { drawn[2], drawn[3] },
                                .further = one_in(2) ? 0 : (uint32_t)random_bits() };
    memcpy(args.normal, normal, sizeof normal);
    FOR_EACH_TESTED
    {
        for (int k = 0; k < 3; k++)
            args.direction[k] = output("direction", real_kind(precision), n);
        geometry(precision)->scatter(&args);
        for (uint32_t i = 0; i < n; i++) // the other lanes may hold anything
            for (int k = 0; k < 3 && args.wanted[i / GLINT_GROUP] && !lane_of(args.wanted, i); k++)
                put(args.direction[k], precision, i, 0);
        compare_outputs("scatter");
    }
}

static void test_scatter(void **state)
{
    (void)state;
    run_cases(CASES, 17000, scatter_case);
}

/// Draws facets of wide and narrow distributions, seen from above to grazing.
static void spread_case(int precision, bool odd)
{
    const uint32_t groups = 1 + below(6), n = groups * GLINT_GROUP;
    const array_kind kind = real_kind(precision);
    const void *normal[3], *ray[3], *disk[2];
    const void *alpha = input(kind, n), *share[6];
    const bool weighs = !one_in(3);
    input3(normal, kind, n);
    input3(ray, kind, n);
    for (int k = 0; k < 2; k++)
        disk[k] = input(kind, n);
    for (int k = 0; k < 6; k++)
        share[k] = input(KIND_DOUBLE, n);
    for (uint32_t i = 0; i < n; i++) {
        double up[3], v[3];
        const double radius = sqrt(between(0, 1)), angle = between(0, 6.3);
        random_unit(up);
        random_unit(v);
        for (int k = 0; k < 3 && one_in(5); k++)
            v[k] = -up[k];
        for (int k = 0; k < 3; k++) {
            up[k] = maybe_odd(odd, up[k]);
            v[k] = maybe_odd(odd, v[k]);
        }
        put3(normal, precision, i, up);
        put3(ray, precision, i, v);
        put(alpha, precision, i, one_in(4) ? 1e-18 : power_of_ten(-8, 0));
        for (int k = 0; k < 6; k++)
            put(share[k], GLINT_PRECISION_DOUBLE, i, maybe_odd(odd, one_in(5) ? power_of_ten(148, 152) : between(0, 1)));
        put(disk[0], precision, i, radius * cos(angle));
        put(disk[1], precision, i, radius * sin(angle));
    }
    glint_spread_args args = { .group_count = groups, .wanted = masks(groups), .alpha = alpha, .disk = { disk[0], disk[1] } };
    memcpy(args.normal, normal, sizeof normal);
    memcpy(args.ray, ray, sizeof ray);
    memcpy(args.head_on, share, sizeof args.head_on);
    memcpy(args.added, share + 3, sizeof args.added);
    FOR_EACH_TESTED
    {
        const int count = weighs ? 8 : 5;
        void *out[8];
        for (int k = 0; k < count; k++)
            out[k] = output("spread", k < 3 ? kind : KIND_DOUBLE, n);
        memcpy(args.direction, out, sizeof args.direction);
        args.grazing = out[3];
        args.weight = out[4];
        if (weighs)
            memcpy(args.ray_weight, out + 5, sizeof args.ray_weight);
        geometry(precision)->spread(&args);
        for (uint32_t i = 0; i < n; i++) // the other lanes may hold anything
            for (int k = 0; k < count && args.wanted[i / GLINT_GROUP] && !lane_of(args.wanted, i); k++)
                put(out[k], k < 3 ? precision : GLINT_PRECISION_DOUBLE, i, 0);
        compare_outputs("spread");
    }
}

static void test_spread(void **state)
{
    (void)state;
    run_cases(CASES, 23000, spread_case);
}

/// Adds the background to nonzero sums where rays missed, and leaves the others unchanged.
static void sky_case(int precision, bool odd)
{
    (void)precision;
    const uint32_t groups = 1 + below(6), n = groups * GLINT_GROUP;
    double *before = input(KIND_DOUBLE, n);
    glint_sky_args args = { .group_count = groups, .missed = masks(groups) };
    for (int c = 0; c < 3; c++) {
        double *weight = input(KIND_DOUBLE, n);
        for (uint32_t i = 0; i < n; i++) {
            before[i] = between(0, 2);
            weight[i] = maybe_odd(odd, one_in(5) ? 0 : power_of_ten(-6, 0));
        }
        args.weight[c] = weight;
        args.background[c] = one_in(5) ? 0 : between(0, 3);
    }
    FOR_EACH_TESTED
    {
        for (int c = 0; c < 3; c++) {
            args.sum[c] = output("sum", KIND_DOUBLE, n);
            memcpy(args.sum[c], before, n * sizeof *before);
        }
        running->sky(&args);
        for (uint32_t i = 0; i < n; i++)
            if (!lane_of(args.missed, i) && args.sum[0][i] != before[i])
                mismatches++;
        compare_outputs("sky");
    }
}

static void test_sky(void **state)
{
    (void)state;
    run_cases(CASES, 20000, sky_case);
}

/// Computes one direction around `n`, from point k of a seed's sequence.
static void direction_of(const double n[3], uint32_t k, uint64_t seed, double out[3])
{
    static ALIGNED double normal[3][GLINT_GROUP], direction[3][GLINT_GROUP];
    static ALIGNED uint32_t drawn[4][GLINT_GROUP];
    const uint16_t first = 1;
    const glint_sequence_seed flips = glint_sequence_seed_of(seed);
    glint_scatter_args args = { .group_count = 1,
                                .wanted = &first,
                                .number = drawn[0],
                                .order = drawn[1],
                                .digits = { drawn[2], drawn[3] },
                                .further = k / 3 };
    drawn[0][0] = k - k / 3;
    drawn[1][0] = flips.order;
    drawn[2][0] = flips.digits[0];
    drawn[3][0] = flips.digits[1];
    for (int c = 0; c < 3; c++) {
        normal[c][0] = n[c];
        args.normal[c] = normal[c];
        args.direction[c] = direction[c];
    }
    running->geometry[GLINT_PRECISION_DOUBLE].scatter(&args);
    for (int c = 0; c < 3; c++)
        out[c] = direction[c][0];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The cosine with the normal is sqrt(1 - u). v is the azimuth in turns.
static void test_closed_forms(void **state)
{
    (void)state;
    random_state = 18000;
    for (int k = 0; k < 3000; k++) {
        double n[3], d[2][3], square[2][2];
        uint32_t point[2];
        random_unit(n);
        const uint64_t seed = random_bits();
        for (int j = 0; j < 2; j++) {
            point[j] = (uint32_t)random_bits();
            glint_sequence_scrambled(point[j], seed, square[j]);
        }
        const double turn = 2 * acos(-1) * (square[0][1] - square[1][1]);
        const double across = sqrt(square[0][0] * square[1][0]), up = sqrt((1 - square[0][0]) * (1 - square[1][0]));
        FOR_EACH_TESTED
        {
            for (int j = 0; j < 2; j++) {
                direction_of(n, point[j], seed, d[j]);
                assert_true(fabs(sqrt(dot(d[j], d[j])) - 1) < 2e-9);
                assert_true(fabs(dot(d[j], n) - sqrt(1 - square[j][0])) < 1e-14);
            }
            const double cosine = (dot(d[0], d[1]) - up) / across; // cosine of the azimuth between both directions
            assert_true(across < 1e-3 || fabs(cosine - cos(turn)) < 1e-8 / across);
        }
    }
}

/// Tests means over the hemisphere: the mean of 1, of the direction, and of the direction's squares.
static void test_means(void **state)
{
    (void)state;
    enum { COUNT = 1 << 14 };
    const double n[3] = { 0.36, -0.48, 0.8 };
    double mean[3] = { 0 }, square = 0;
    running = &glint_stages_ref;
    for (uint32_t k = 0; k < COUNT; k++) {
        double d[3];
        direction_of(n, k, 5, d);
        for (int c = 0; c < 3; c++)
            mean[c] += d[c] / COUNT;
        square += dot(d, n) * dot(d, n) / COUNT;
    }
    for (int c = 0; c < 3; c++)
        assert_true(fabs(mean[c] - 2.0 / 3 * n[c]) < 2e-4); // the mean of cos under the density cos / pi
    assert_true(fabs(square - 0.5) < 2e-4);
}

/// For any seed, every 2^m points from a multiple of 2^m on have one point in each
/// of the 2^m boxes, for every box shape.
static void test_evenness(void **state)
{
    (void)state;
    static bool taken[1 << 8];
    random_state = 19000;
    for (int k = 0; k < 400; k++) {
        const int m = (int)below(9), wide = (int)below((uint32_t)m + 1);
        const uint32_t from = below(1u << 20) << m;
        const uint64_t seed = random_bits();
        memset(taken, 0, sizeof taken);
        for (uint32_t i = 0; i < 1u << m; i++) {
            double p[2];
            glint_sequence_scrambled(from + i, seed, p);
            assert_true(p[0] >= 0 && p[0] < 1 && p[1] >= 0 && p[1] < 1);
            const uint32_t box = (uint32_t)(p[0] * (1 << wide)) << (m - wide) | (uint32_t)(p[1] * (1 << (m - wide)));
            if (taken[box])
                fail_msg("seed %llx, 2^%d points from %u: two in box %u of 2^%d x 2^%d", (unsigned long long)seed, m,
                         from, box, wide, m - wide);
            taken[box] = true;
        }
    }
}

/// Sequences of different seeds are as independent as random numbers:
/// tests correlations of first points over many seeds.
static void test_independence(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    double mean[3] = { 0 };
    for (uint64_t seed = 0; seed < COUNT; seed++) {
        double a[2], b[2];
        glint_sequence_scrambled((uint32_t)(seed % 16), glint_sequence_mix(7, seed), a);
        glint_sequence_scrambled((uint32_t)(seed % 16), glint_sequence_mix(7, seed + 1), b);
        mean[0] += (a[0] - 0.5) * (a[1] - 0.5) * 12 / COUNT;
        mean[1] += (a[0] - 0.5) * (b[0] - 0.5) * 12 / COUNT;
        mean[2] += (a[1] - 0.5) * (b[1] - 0.5) * 12 / COUNT;
    }
    for (int i = 0; i < 3; i++)
        assert_true(fabs(mean[i]) < 5 / sqrt(COUNT));
}

int main(void)
{
    find_tested();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scatter),  cmocka_unit_test(test_spread),       cmocka_unit_test(test_closed_forms), cmocka_unit_test(test_means),
        cmocka_unit_test(test_evenness), cmocka_unit_test(test_independence), cmocka_unit_test(test_sky),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    print_skipped();
    return failed;
}
