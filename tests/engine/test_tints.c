/// Bounds of transparent occluders: no lane with a ray that hits one is classified as clear, and most others are.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "engine/base/vec.h"
#include "engine/render/effects/transparent_shadow/plan.h"

static uint64_t state = 1;

static double uniform(double low, double high)
{
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(state >> 33) / 0x1p31;
}

static void place(double out[3], double size)
{
    for (int c = 0; c < 3; c++)
        out[c] = uniform(-size, size);
}

/// Chooses a random point in a ball.
static void within(double out[3], const double center[3], double radius)
{
    double off[3];
    do
        place(off, 1);
    while (vec_dot(off, off) > 1);
    for (int c = 0; c < 3; c++)
        out[c] = center[c] + radius * off[c];
}

static bool meets(const double from[3], const glint_tint_light *light, const double to[3], const glint_ball *ball)
{
    double d[3], m[3], off[3];
    for (int c = 0; c < 3; c++) {
        d[c] = light->directional ? light->position[c] : to[c] - from[c];
        m[c] = ball->center[c] - from[c];
    }
    const double most = light->directional ? HUGE_VAL : 1, t = fmin(fmax(vec_dot(m, d) / vec_dot(d, d), 0), most);
    for (int c = 0; c < 3; c++)
        off[c] = t * d[c] - m[c];
    return vec_dot(off, off) < ball->radius * ball->radius;
}

typedef struct counts {
    long met, told; ///< number of lanes with a ray that hits a ball, and of lanes not classified as clear
} counts;

static counts try(const glint_tints *tints, const glint_tint_light *light, double spread)
{
    uint16_t chosen[GLINT_TINTS_MAX];
    double point[3][GLINT_GROUP];
    glint_ball points = { .radius = spread };
    counts out = { 0 };
    place(points.center, 4);
    const uint32_t count = glint_tints_choose(tints, &points, light, chosen);
    for (int i = 0; i < GLINT_GROUP; i++) {
        double p[3];
        within(p, points.center, spread);
        for (int c = 0; c < 3; c++)
            point[c][i] = p[c];
    }
    const uint16_t lanes = (uint16_t)(state >> 40),
                   told = glint_tints_lanes(tints, chosen, count, (const double(*)[GLINT_GROUP])point, lanes, light);
    assert_int_equal(told & ~lanes, 0);
    out.told = __builtin_popcount(told);
    for (unsigned left = lanes; left; left &= left - 1) {
        const int i = __builtin_ctz(left);
        const double from[3] = { point[0][i], point[1][i], point[2][i] };
        bool met = false;
        for (int sample = 0; sample < 8; sample++) {
            double to[3];
            within(to, light->position, light->radius);
            for (uint32_t k = 0; k < tints->count; k++)
                met = met || meets(from, light, to, &tints->of[k]);
        }
        assert_true(!met || told >> i & 1);
        out.met += met;
    }
    return out;
}

/// Tests all kinds of lights, points close together and far apart, and balls of all sizes,
/// some around points and lights.
static void test_rays(void **unused)
{
    (void)unused;
    counts sum = { 0 };
    for (int run = 0; run < 40000; run++) {
        glint_tints tints = { .count = 1 + (uint32_t)run % 7, .extent = 10 };
        glint_tint_light light = { .directional = run % 3 == 0, .radius = run % 3 == 1 ? uniform(0, 2) : 0 };
        for (uint32_t k = 0; k < tints.count; k++) {
            place(tints.of[k].center, 8);
            tints.of[k].radius = exp(uniform(-9, 1.5));
        }
        place(light.position, light.directional ? 1 : 10);
        const counts more = try(&tints, &light, exp(uniform(-6, 2)));
        sum.met += more.met;
        sum.told += more.told;
    }
    assert_true(sum.met > 10000);
    assert_true((double)sum.told < 1.25 * (double)sum.met);
}

/// NaN is not classified as clear.
static void test_odd(void **unused)
{
    (void)unused;
    const glint_tints tints = { .count = 1, .of = { { .radius = 1 } } };
    const uint16_t chosen[1] = { 0 };
    double point[3][GLINT_GROUP] = { { 0 } };
    for (int i = 0; i < GLINT_GROUP; i++)
        point[i % 3][i] = i % 2 ? NAN : HUGE_VAL;
    const glint_tint_light light = { .position = { 0, 5, 0 } };
    assert_int_equal(glint_tints_lanes(&tints, chosen, 1, (const double(*)[GLINT_GROUP])point, 0xffff, &light), 0xffff);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_rays), cmocka_unit_test(test_odd) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
