/// Reflected and refracted rays: every instruction set against the scalar reference,
/// and the reference against closed forms.
#include "tests/engine/cases/stage_rays.h"

#define ALIGNED _Alignas(64)

#define CASES 200

/// Rays that hit surfaces at all angles, including grazing ones.
static void bounce_case(int precision, bool odd)
{
    ray_case c;
    start_rays(&c, one_in(2) ? RAYS_OF_EYE : RAYS_FREE, precision);
    const uint32_t groups = c.cast.group_count, n = groups * GLINT_GROUP;
    const void *normal[3];
    input3(normal, real_kind(precision), n);
    void *ratio = input(real_kind(precision), n);
    for (uint32_t i = 0; i < n; i++) {
        double origin[3], direction[3], v[3];
        random_unit(v);
        get_ray(&c, i, origin, direction);
        if (one_in(4)) // grazing rays
            random_across(direction, v);
        const double sign = dot3(v, direction) > 0 ? -1 : 1;
        for (int k = 0; k < 3; k++)
            v[k] = maybe_odd(odd, v[k] * sign);
        put3(normal, precision, i, v);
        put(ratio, precision, i, maybe_odd(odd, one_in(4) ? 1 : one_in(4) ? power_of_ten(-40, 30) : between(0.3, 3)));
    }
    glint_bounce_args args = { .group_count = groups,
                               .wanted = masks(groups),
                               .camera = c.kind == RAYS_OF_EYE ? &c.camera : NULL,
                               .ratio = ratio };
    memcpy(args.normal, normal, sizeof normal);
    memcpy(args.direction, c.direction, sizeof args.direction);
    FOR_EACH_TESTED
    {
        void *out[7];
        for (int k = 0; k < 7; k++)
            out[k] = output(k < 3 ? "reflected" : k < 6 ? "refracted" : "reflectance", real_kind(precision), n);
        memcpy(args.reflected, out, sizeof args.reflected);
        memcpy(args.refracted, out + 3, sizeof args.refracted);
        args.reflectance = out[6];
        args.total = output("total", KIND_U16, groups);
        geometry(precision)->bounce(&args);
        for (uint32_t i = 0; i < n; i++) // the other lanes may hold anything
            for (int k = 0; k < 7 && !lane_of(args.wanted, i); k++)
                put(out[k], precision, i, 0);
        compare_outputs("bounce");
    }
    end_rays(&c);
}

static void test_bounce(void **state)
{
    (void)state;
    run_cases(CASES, 14000, bounce_case);
}

typedef struct answer {
    double reflected[3], refracted[3], reflectance;
    bool total;
} answer;

/// Reflects and refracts a ray in the plane z = 0. The ray falls on the floor y = 0 from the left, at an angle with
/// this sine and cosine.
static answer ask(double ratio, double sine, double cosine)
{
    static ALIGNED double direction[3][GLINT_GROUP], normal[3][GLINT_GROUP], ratios[GLINT_GROUP];
    static ALIGNED double reflected[3][GLINT_GROUP], refracted[3][GLINT_GROUP], reflectance[GLINT_GROUP];
    const uint16_t first = 1;
    uint16_t total;
    answer out;
    glint_bounce_args args = {
        .group_count = 1, .wanted = &first, .ratio = ratios, .reflectance = reflectance, .total = &total
    };
    direction[0][0] = sine;
    direction[1][0] = -cosine;
    normal[1][0] = 1;
    ratios[0] = ratio;
    for (int c = 0; c < 3; c++) {
        args.direction[c] = direction[c];
        args.normal[c] = normal[c];
        args.reflected[c] = reflected[c];
        args.refracted[c] = refracted[c];
    }
    running->geometry[GLINT_PRECISION_DOUBLE].bounce(&args);
    for (int c = 0; c < 3; c++) {
        out.reflected[c] = reflected[c][0];
        out.refracted[c] = refracted[c][0];
    }
    out.reflectance = reflectance[0];
    out.total = total & 1;
    return out;
}

static void near(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance))
        fail_msg("%s: %.17g, wanted %.17g", running->name, got, want);
}

static void test_closed_forms(void **state)
{
    (void)state;
    static const double fresnel[][2] = { { 1, 0.04 }, { 0.5, 0.0891867128 }, { 0.1, 0.5715925203 }, { 0, 1 } };
    FOR_EACH_TESTED
    {
        answer a = ask(1.5, 2.0 / 3, sqrt(5) / 3); // critical angle: almost nothing is transmitted
        near(a.reflectance, 1, 1e-7);
        a = ask(1.5, 1, 0);
        assert_true(a.total);
        near(a.reflectance, 1, 0);
        a = ask(1.5, 0.8, 0.6); // beyond the critical angle: total reflection
        assert_true(a.total);
        near(a.reflectance, 1, 0);
        near(a.reflected[0], 0.8, 2e-16);
        near(a.reflected[1], 0.6, 2e-16);
        a = ask(1, 0.6, 0.8); // no boundary: the ray goes on unchanged
        assert_false(a.total);
        near(a.refracted[0], 0.6, 0);
        near(a.refracted[1], -0.8, 0);
        near(a.reflectance, 0, 0);
        for (size_t i = 0; i < COUNT_OF(fresnel); i++) {
            const double cosine = fresnel[i][0];
            near(ask(1 / 1.5, sqrt(1 - cosine * cosine), cosine).reflectance, fresnel[i][1], 5e-11);
        }
        near(ask(1.5, sqrt(1 - 0.5625), 0.75).reflectance, 0.5, 1e-15);
        a = ask(1 / 1.5, sqrt(0.5), sqrt(0.5));
        near(atan2(a.refracted[0], -a.refracted[1]) * 180 / acos(-1), 28.125505702, 5e-10);
        near(hypot(a.refracted[0], a.refracted[1]), 1, 3e-16);
    }
}

/// Snell's law is reversible: the reversed refracted ray leaves along the incident direction,
/// with the same reflectance.
static void test_reversible(void **state)
{
    (void)state;
    random_state = 15000;
    for (int k = 0; k < 2000; k++) {
        const double ratio = between(0.4, 2.5), cosine = between(0.01, 1), sine = sqrt(1 - cosine * cosine);
        FOR_EACH_TESTED
        {
            const answer there = ask(ratio, sine, cosine);
            assert_int_equal(there.total, ratio * sine >= 1);
            if (there.total)
                continue;
            const answer back = ask(1 / ratio, there.refracted[0], -there.refracted[1]);
            near(there.refracted[0], ratio * sine, 1e-15);
            if (-there.refracted[1] > 1e-3) {
                near(back.refracted[0], sine, 1e-12);
                near(back.reflectance, there.reflectance, 1e-10);
            }
        }
    }
}

int main(void)
{
    find_tested();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bounce),
        cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_reversible),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    print_skipped();
    return failed;
}
