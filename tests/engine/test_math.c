/// glint_sin .. glint_pow against multiple-precision arithmetic, and their special cases.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <mpfr.h>
#include <stdio.h>
#include <string.h>

#include "engine/base/math.h"
#include "tests/engine/cases/random.h"

#define MAX_ULP 0.51 // a result is a sum of two doubles with a relative error below 2^-60, and is rounded once
#define MAX_ULP_SUBNORMAL 0.76 // subnormal results are rounded twice

/// Returns a number with a random sign and mantissa, and with an exponent uniform in low .. high.
static double random_scaled(int low, int high)
{
    double m = between(1, 2);
    double x = ldexp(m, low + (int)(random_bits() % (uint64_t)(high - low + 1)));
    return random_bits() & 1 ? -x : x;
}

static double error_ulp(double got, mpfr_t truth)
{
    double near = mpfr_get_d(truth, MPFR_RNDN);
    if (isinf(near) || isnan(near))
        return (isnan(near) && isnan(got)) || near == got ? 0 : INFINITY;
    int e;
    frexp(near, &e);
    double ulp = ldexp(1, e - 53 < -1074 ? -1074 : e - 53);
    mpfr_t difference;
    mpfr_init2(difference, 200);
    mpfr_sub_d(difference, truth, got, MPFR_RNDN);
    mpfr_div_d(difference, difference, ulp, MPFR_RNDN);
    double result = fabs(mpfr_get_d(difference, MPFR_RNDN));
    mpfr_clear(difference);
    return result;
}

typedef struct worst_case {
    double normal, subnormal, x, y;
} worst_case;

static void note_error(worst_case *worst, double got, mpfr_t truth, double x, double y)
{
    double ulp = error_ulp(got, truth);
    bool subnormal = fabs(got) < 0x1p-1022;
    double *slot = subnormal ? &worst->subnormal : &worst->normal;
    if (!(ulp <= *slot)) {
        *slot = ulp;
        worst->x = x;
        worst->y = y;
    }
}

static void check_worst(const char *name, const worst_case *worst)
{
    print_message("%s: %.4f ulp, subnormal results %.4f ulp (at %a %a)\n", name, worst->normal, worst->subnormal,
                  worst->x, worst->y);
    assert_true(worst->normal <= MAX_ULP);
    assert_true(worst->subnormal <= MAX_ULP_SUBNORMAL);
}

typedef int mpfr_function(mpfr_t, mpfr_srcptr, mpfr_rnd_t);

static void try_one(worst_case *worst, double (*ours)(double), mpfr_function *theirs, double x)
{
    mpfr_t in, truth;
    mpfr_init2(in, 53);
    mpfr_init2(truth, 160);
    mpfr_set_d(in, x, MPFR_RNDN);
    theirs(truth, in, MPFR_RNDN);
    note_error(worst, ours(x), truth, x, 0);
    mpfr_clear(in);
    mpfr_clear(truth);
}

static int oracle_sin(mpfr_t y, mpfr_srcptr x, mpfr_rnd_t r) { return mpfr_sin(y, x, r); }
static int oracle_cos(mpfr_t y, mpfr_srcptr x, mpfr_rnd_t r) { return mpfr_cos(y, x, r); }
static int oracle_tan(mpfr_t y, mpfr_srcptr x, mpfr_rnd_t r) { return mpfr_tan(y, x, r); }
static int oracle_exp(mpfr_t y, mpfr_srcptr x, mpfr_rnd_t r) { return mpfr_exp(y, x, r); }
static int oracle_log(mpfr_t y, mpfr_srcptr x, mpfr_rnd_t r) { return mpfr_log(y, x, r); }

static void check_angle_function(const char *name, double (*ours)(double), mpfr_function *theirs)
{
    worst_case worst = { 0 };
    random_state = 1;
    for (int i = 0; i < 40000; i += (int)case_step()) {
        try_one(&worst, ours, theirs, between(-7, 7));
        try_one(&worst, ours, theirs, random_scaled(-40, 20));
    }
    for (int i = 0; i < 10000; i += (int)case_step()) {
        try_one(&worst, ours, theirs, random_scaled(-1070, 1022));
        double near = (double)(1 + random_bits() % 100000) * 0x1.921fb54442d18p+0; // close to a multiple of pi/2
        try_one(&worst, ours, theirs, near);
        try_one(&worst, ours, theirs, nextafter(near, 0));
    }
    // The double closest to a multiple of pi/2, and the largest double.
    try_one(&worst, ours, theirs, 0x1.6ac5b262ca1ffp+849);
    try_one(&worst, ours, theirs, 0x1.fffffffffffffp+1023);
    try_one(&worst, ours, theirs, 0x1.921fb54442d18p-1);
    check_worst(name, &worst);
    assert_true(isnan(ours(INFINITY)) && isnan(ours(-INFINITY)) && isnan(ours(NAN)));
}

static void test_angles(void **state)
{
    (void)state;
    check_angle_function("sin", glint_sin, oracle_sin);
    check_angle_function("cos", glint_cos, oracle_cos);
    check_angle_function("tan", glint_tan, oracle_tan);
    assert_true(glint_sin(0) == 0 && signbit(glint_sin(-0.0)) && glint_cos(0) == 1 && signbit(glint_tan(-0.0)));
    assert_true(fabs(glint_tan(0x1.921fb54442d18p-1) - 1) <= 0x1p-53);
    assert_true(glint_tan_half(0x1.921fb54442d18p+0) == 1.0);
    assert_true(fabs(glint_tan_half(179.9 * 0x1.921fb54442d18p+1 / 180) - 1145.91529937) < 1e-8);
}

static void test_exp_log(void **state)
{
    (void)state;
    worst_case e = { 0 }, l = { 0 };
    random_state = 2;
    for (int i = 0; i < 50000; i += (int)case_step()) {
        try_one(&e, glint_exp, oracle_exp, between(-746, 710));
        try_one(&e, glint_exp, oracle_exp, random_scaled(-60, 3));
        try_one(&l, glint_log, oracle_log, fabs(random_scaled(-1074, 1023)));
        try_one(&l, glint_log, oracle_log, between(0.5, 2));
        try_one(&l, glint_log, oracle_log, 1 + random_scaled(-52, -4));
    }
    check_worst("exp", &e);
    check_worst("log", &l);
    assert_true(glint_exp(-INFINITY) == 0 && isinf(glint_exp(INFINITY)) && isnan(glint_exp(NAN)));
    assert_true(glint_exp(0) == 1 && isinf(glint_exp(710)) && glint_exp(-746) == 0);
    assert_true(isinf(glint_log(0)) && isinf(glint_log(INFINITY)) && isnan(glint_log(-1)) && isnan(glint_log(NAN)));
    assert_true(glint_log(1) == 0 && !signbit(glint_log(1)));
}

static void try_power(worst_case *worst, double x, double y)
{
    mpfr_t a, b, truth;
    mpfr_inits2(53, a, b, (mpfr_ptr)NULL);
    mpfr_init2(truth, 200);
    mpfr_set_d(a, x, MPFR_RNDN);
    mpfr_set_d(b, y, MPFR_RNDN);
    mpfr_pow(truth, a, b, MPFR_RNDN);
    note_error(worst, glint_pow(x, y), truth, x, y);
    mpfr_clears(a, b, truth, (mpfr_ptr)NULL);
}

static void test_pow(void **state)
{
    (void)state;
    worst_case worst = { 0 };
    random_state = 3;
    for (int i = 0; i < 60000; i += (int)case_step()) {
        double x = fabs(random_scaled(-1074, 1023));
        try_power(&worst, x, between(-740, 709) / log(x));
        try_power(&worst, 1 + random_scaled(-52, -2), random_scaled(0, 40));
        try_power(&worst, between(0, 2), between(-100, 100));
        try_power(&worst, between(0, 1), 1 / 2.4);
    }
    check_worst("pow", &worst);
    for (int base = -40; base <= 40; base++) { // pow is exact when the power is representable
        double exact = 1;
        for (int n = 0; n <= 9; n++, exact *= base)
            assert_true(glint_pow(base, n) == exact);
    }
    for (int n = -1074; n <= 1023; n++)
        assert_true(glint_pow(2, n) == ldexp(1, n));
    assert_true(glint_pow(0.999999, 1e6) > 0.367879257220 && glint_pow(0.999999, 1e6) < 0.367879257222);
}

static void test_pow_special(void **state)
{
    (void)state;
    static const double cases[] = { 0.0,
                                    -0.0,
                                    1,
                                    -1,
                                    2,
                                    -2,
                                    0.5,
                                    -0.5,
                                    3,
                                    -3,
                                    2.5,
                                    -2.5,
                                    1e300,
                                    -1e300,
                                    1e-300,
                                    -1e-300,
                                    0x1p53,
                                    0x1.fffffffffffffp52,
                                    -0x1.fffffffffffffp52,
                                    0x1p-1074,
                                    -0x1p-1074,
                                    0x1.fffffffffffffp1023,
                                    INFINITY,
                                    -INFINITY,
                                    NAN };
    size_t count = sizeof cases / sizeof *cases;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < count; k++) { // the C library follows annex F; other results may differ by an ulp
            double got = glint_pow(cases[i], cases[k]), want = pow(cases[i], cases[k]);
            bool same = isnan(want) ? isnan(got) : !memcmp(&got, &want, sizeof got);
            if (!same && isfinite(want) && want != 0)
                same = fabs(got - want) <= fabs(want) * 0x1p-52;
            if (!same)
                fail_msg("pow(%a, %a): %a, want %a", cases[i], cases[k], got, want);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_angles),
        cmocka_unit_test(test_exp_log),
        cmocka_unit_test(test_pow),
        cmocka_unit_test(test_pow_special),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
