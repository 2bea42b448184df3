/// Rays against spheres, decided by the engine and by 400-bit arithmetic from the same binary64 inputs. Half of the
/// rays are aimed at tangency, within 1e-2 .. 1e-16 of the radius; scales, offsets and directions' lengths are log-uniform.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <mpfr.h>
#include <stdlib.h>
#include <string.h>

#include "engine/glint.h"

#define BITS 400
#define EPS 0x1p-53

static uint64_t state = 7;

static double uniform(double low, double high)
{
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * ((double)(state >> 11) * 0x1p-53);
}

static double log_uniform(double low, double high)
{
    return exp(uniform(log(low), log(high)));
}

static void random_direction(double v[3])
{
    double length2;
    do {
        for (int c = 0; c < 3; c++)
            v[c] = uniform(-1, 1);
        length2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    } while (length2 > 1 || length2 < 0.01);
    for (int c = 0; c < 3; c++)
        v[c] /= sqrt(length2);
}

typedef struct truth {
    bool hit;
    double t, normal[3];
    double margin; ///< how far the line's distance from the centre is from the radius, in units of |f| + r
    double origin_margin; ///< how far the origin is from the surface, in the same units
} truth;

/// sum = a . b
static void dot(mpfr_t sum, mpfr_t a[3], mpfr_t b[3])
{
    mpfr_t p;
    mpfr_init2(p, BITS);
    mpfr_set_zero(sum, 1);
    for (int c = 0; c < 3; c++) {
        mpfr_mul(p, a[c], b[c], MPFR_RNDN);
        mpfr_add(sum, sum, p, MPFR_RNDN);
    }
    mpfr_clear(p);
}

/// The nearest root t > 0 of |f + t d| = r, from the definition.
static truth decide(const double o[3], const double d[3], const double c[3], double r)
{
    truth out = { 0 };
    mpfr_t f[3], v[3], A, B, C, D, R, t, u;
    mpfr_inits2(BITS, A, B, C, D, R, t, u, (mpfr_ptr)0);
    for (int i = 0; i < 3; i++) {
        mpfr_init2(f[i], BITS);
        mpfr_init2(v[i], BITS);
        mpfr_set_d(f[i], o[i], MPFR_RNDN);
        mpfr_sub_d(f[i], f[i], c[i], MPFR_RNDN);
        mpfr_set_d(v[i], d[i], MPFR_RNDN);
    }
    dot(A, v, v);
    dot(B, f, v);
    dot(C, f, f);
    mpfr_set_d(R, r, MPFR_RNDN);
    mpfr_sqrt(u, C, MPFR_RNDN);
    const double reach = mpfr_get_d(u, MPFR_RNDN) + r;
    mpfr_sub(u, u, R, MPFR_RNDN);
    out.origin_margin = fabs(mpfr_get_d(u, MPFR_RNDN)) / reach;
    mpfr_mul(D, B, B, MPFR_RNDN); // distance^2 of the line: C - B^2 / A
    mpfr_div(D, D, A, MPFR_RNDN);
    mpfr_sub(D, C, D, MPFR_RNDN);
    mpfr_abs(D, D, MPFR_RNDN);
    mpfr_sqrt(u, D, MPFR_RNDN);
    mpfr_sub(u, u, R, MPFR_RNDN);
    out.margin = fabs(mpfr_get_d(u, MPFR_RNDN)) / reach;
    mpfr_sqr(R, R, MPFR_RNDN);
    mpfr_sub(D, R, D, MPFR_RNDN); // h^2 A, h half the chord
    if (mpfr_sgn(D) >= 0) {
        mpfr_div(D, D, A, MPFR_RNDN);
        mpfr_sqrt(D, D, MPFR_RNDN);
        mpfr_div(B, B, A, MPFR_RNDN);
        mpfr_neg(B, B, MPFR_RNDN);
        mpfr_sub(t, B, D, MPFR_RNDN);
        if (mpfr_sgn(t) <= 0)
            mpfr_add(t, B, D, MPFR_RNDN);
        out.hit = mpfr_sgn(t) > 0;
        out.t = mpfr_get_d(t, MPFR_RNDN);
        for (int i = 0; i < 3; i++) {
            mpfr_mul(u, v[i], t, MPFR_RNDN);
            mpfr_add(u, u, f[i], MPFR_RNDN);
            out.normal[i] = mpfr_get_d(u, MPFR_RNDN) / r;
        }
    }
    for (int i = 0; i < 3; i++)
        mpfr_clears(f[i], v[i], (mpfr_ptr)0);
    mpfr_clears(A, B, C, D, R, t, u, (mpfr_ptr)0);
    return out;
}

typedef struct ray_case {
    double o[3], d[3], c[3], r;
} ray_case;

static ray_case random_case(void)
{
    ray_case k;
    const double size = log_uniform(1e-8, 1e8), offset = log_uniform(1e-3, 1e6) * size;
    k.r = size * uniform(0.5, 1);
    const double away = k.r * (uniform(0, 1) < 0.3 ? 1 + (uniform(0, 1) < 0.5 ? -1 : 1) * log_uniform(1e-15, 1)
                                                   : log_uniform(1e-3, 1e6));
    double u[3], side[3], along = 0;
    random_direction(u);
    for (int c = 0; c < 3; c++) {
        k.c[c] = uniform(0, 1) < 0.3 ? 0 : uniform(-1, 1) * offset;
        k.o[c] = k.c[c] - u[c] * fabs(away);
    }
    random_direction(side); // a foot of the perpendicular at the wanted distance from the centre
    for (int c = 0; c < 3; c++)
        along += side[c] * u[c];
    double miss = k.r * (uniform(0, 1) < 0.5 ? 1 + (uniform(0, 1) < 0.5 ? -1 : 1) * log_uniform(1e-16, 1e-2)
                                             : uniform(0, 1.2));
    double length = 0, foot[3];
    for (int c = 0; c < 3; c++) {
        foot[c] = side[c] - along * u[c];
        length += foot[c] * foot[c];
    }
    const double stretch = log_uniform(1e-20, 1e20);
    for (int c = 0; c < 3; c++)
        k.d[c] = ((k.c[c] + miss * foot[c] / sqrt(length)) - k.o[c]) * (uniform(0, 1) < 0.1 ? -stretch : stretch);
    return k;
}

static glint_scene *one_sphere(const ray_case *k)
{
    glint_scene *scene;
    glint_shape *shape;
    glint_shape_desc desc = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    memcpy(desc.center, k->c, sizeof k->c);
    desc.radius = k->r;
    assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
    assert_int_equal(glint_shape_create(&desc, &shape, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_shape(scene, shape, NULL), GLINT_OK);
    glint_shape_release(shape);
    return scene;
}

static long case_count(void)
{
    const char *soak = getenv("GLINT_SOAK_RAYS");
    return soak ? atol(soak) : 300000;
}

static void spheres_against_oracle(void **unused)
{
    (void)unused;
    long wrong = 0, hits = 0, close = 0, loose = 0;
    double worst_t = 0, worst_n = 0;
    for (long i = 0; i < case_count(); i++) {
        const ray_case k = random_case();
        if (k.d[0] == 0 && k.d[1] == 0 && k.d[2] == 0)
            continue;
        const truth want = decide(k.o, k.d, k.c, k.r);
        glint_scene *scene = one_sphere(&k);
        glint_hit got;
        bool hit;
        assert_int_equal(glint_scene_cast(scene, k.o, k.d, &hit, &got, NULL), GLINT_OK);
        glint_scene_release(scene);
        if (want.margin < 8 * EPS || want.origin_margin < 8 * EPS) {
            close++;
            continue;
        }
        if (hit != want.hit) {
            if (wrong++ < 5)
                print_message("o %a %a %a d %a %a %a c %a %a %a r %a: %d, truth %d, margin %g\n", k.o[0], k.o[1], k.o[2],
                              k.d[0], k.d[1], k.d[2], k.c[0], k.c[1], k.c[2], k.r, hit, want.hit, want.margin);
            continue;
        }
        if (!hit)
            continue;
        hits++;
        // t is as well conditioned as the chord: its relative error grows as 1 / (distance from tangency)
        const double t_error = fabs(got.t / want.t - 1), bound = 8 * EPS / fmin(sqrt(want.margin), want.origin_margin);
        if (t_error > fmax(bound, 1e-13))
            loose++;
        worst_t = fmax(worst_t, t_error / fmax(bound, 1e-13));
        double f2 = 0, n_error = 0;
        for (int c = 0; c < 3; c++) {
            f2 += (k.o[c] - k.c[c]) * (k.o[c] - k.c[c]);
            n_error = fmax(n_error, fabs(got.normal[c] - want.normal[c]));
        }
        const double allowed = fmax(1e-9, 8 * EPS * (sqrt(f2) + k.r) / k.r) / fmin(1, sqrt(want.margin * (sqrt(f2) + k.r) / k.r));
        worst_n = fmax(worst_n, n_error / allowed);
    }
    print_message("%ld hits, %ld within 8 ulp of tangency or of the surface, wrong %ld; worst t %.3f, worst normal %.3f of "
                  "the bound\n", hits, close, wrong, worst_t, worst_n);
    assert_int_equal(wrong, 0);
    assert_int_equal(loose, 0);
    assert_true(worst_n <= 1);
    assert_true(hits > case_count() / 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(spheres_against_oracle) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
