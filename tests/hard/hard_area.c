/// Test cases for area lights: radius 0, the shaded point inside the light, lights too small for float, irradiance in
/// closed form and the rate of convergence, the noise of a ball light, and the extent of shadows.
#include "tests/hard/oracle/oracle_light.h"
#include "tests/hard/oracle/point.h"

#include <string.h>

/// Describes a light of radius r at height h above the floor's point, facing the point.
static glint_light_desc above(glint_light_kind kind, double h, double r)
{
    glint_light_desc light = glint_light_desc_default(kind);
    light.position[1] = h;
    light.radius = r;
    return light;
}

static glint_light_desc radiant(glint_light_kind kind, double h, double r, double samples)
{
    glint_light_desc light = above(kind, h, r);
    light.has_radiance = true;
    light.radiance = 1;
    light.samples = samples;
    return light;
}

/// L8: a light of radius 0 gives the same bits as a point light and costs no more rays.
static void no_radius(void)
{
    hard_test("L8", "area light of radius 0");
    uint64_t rays[2][2] = { { 0 } };
    long differ[2] = { 0 };
    for (int i = 0; i < 100; i++)
        for (int p = 0; p < 2; p++) {
            const hard_sphere ball = { { uniform(-1, 1), 1, uniform(-1, 1) }, 1 };
            glint_light_desc point = glint_light_desc_default(GLINT_LIGHT_POINT);
            for (int c = 0; c < 3; c++)
                point.position[c] = c == 1 ? uniform(1.5, 9) : uniform(-5, 5);
            point.attenuation[2] = uniform(0, 1);
            glint_light_desc area = glint_light_desc_default(i % 2 ? GLINT_LIGHT_DISK : GLINT_LIGHT_SPHERE);
            memcpy(area.position, point.position, sizeof area.position);
            memcpy(area.attenuation, point.attenuation, sizeof area.attenuation);
            area.radius = 0;
            glint_frame_stats stats;
            const double want = point_lit(&point, &ball, 0, 6, 0, (glint_precision)p, NULL, &stats);
            rays[0][p] += stats.rays.shadow;
            const double got = point_lit(&area, &ball, 0, 6, 0, (glint_precision)p, NULL, &stats);
            rays[1][p] += stats.rays.shadow;
            differ[p] += !hard_check(got == want, "%.17g, a point light %.17g", got, want);
        }
    hard_check(rays[0][0] >= rays[1][0] && rays[0][1] >= rays[1][1], "%llu shadow rays, of point lights %llu",
               (unsigned long long)(rays[1][0] + rays[1][1]), (unsigned long long)(rays[0][0] + rays[0][1]));
    hard_row("L8", "radius 0: pictures unlike a point light's",
             &(hard_values) { 0, (double)differ[0], (double)differ[1], HARD_BLANK, HARD_BLANK },
             !differ[0] && !differ[1]);
    hard_row("L8", "radius 0: shadow rays for each of the point light's",
             &(hard_values) { 1, (double)rays[1][0] / (double)rays[0][0], (double)rays[1][1] / (double)rays[0][1],
                              HARD_BLANK, HARD_BLANK },
             rays[0][0] >= rays[1][0] && rays[0][1] >= rays[1][1]);
}

/// The textbook's irradiance pi sin^2 of the half angle, where sin^2 = 1 - cos^2 and cos = sqrt(1 - r^2/d^2); or, if
/// `weight`, the weight 2 pi (1 - cos) of a sample of the cone.
#define NAIVE(name, real, root) \
    static double name(bool weight, double r, double d) \
    { \
        const real q = (real)r / (real)d, c = root(1 - q * q); \
        return (double)(weight ? 2 * (real)M_PI * (1 - c) : (real)M_PI * (1 - c * c)); \
    }
NAIVE(naive_float, float, sqrtf)
NAIVE(naive_double, double, sqrt)

/// Compares the light on the floor with a closed form, in both precisions, with a relative error of `share`.
static void compare(const char *id, const char *what, const glint_light_desc *light, double width, double share,
                    hard_values *shown)
{
    double *const got[2] = { &shown->in_double, &shown->in_float };
    bool right = true;
    for (int p = 0; p < 2; p++) {
        *got[p] = point_lit(light, NULL, 0, width, 0, (glint_precision)p, NULL, NULL);
        right &= hard_check(fabs(*got[p] - shown->truth) <= share * shown->truth, "%s: %.10g, truth %.10g", what,
                            *got[p], shown->truth);
    }
    hard_row(id, what, shown, right);
}

/// L9: the point is inside the light, so the whole sky has radiance 1: pi, with 4096 samples.
static void within(void)
{
    static const double places[][2] = { { 0.5, 2 }, { 0, 2 }, { 0.9, 1 }, { 1e-9, 1 }, { 3e5, 1e6 }, { 1e-12, 1e-11 } };
    hard_test("L9", "point inside a sphere light");
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        char what[64];
        const double h = places[i][0], r = places[i][1];
        const glint_light_desc light = radiant(GLINT_LIGHT_SPHERE, h, r, 4096);
        hard_values shown = { .truth = M_PI,
                              .naive_double = naive_double(false, r, h),
                              .naive_float = naive_float(false, r, h) };
        snprintf(what, sizeof what, "radius %g, %g from its centre", r, h);
        compare("L9", what, &light, 1e-6 * r, 0.02, &shown);
    }
}

/// L10: a light so small that 1 - cos is 0 in float. The textbook's column is 2 pi (1 - cos), the weight of its
/// samples, which is nearly pi r^2/d^2 for small lights.
static void tiny(void)
{
    hard_test("L10", "sphere light of a small angle");
    hard_check(fabs(oracle_cap(1e-4) - 5.0000000125e-9) < 1e-18, "oracle 1 - cos %.12g", oracle_cap(1e-4));
    for (double ratio = 1e-2; ratio > 1e-13; ratio *= 1e-2) {
        char what[64];
        const double h = uniform(0.5, 2);
        const glint_light_desc light = radiant(GLINT_LIGHT_SPHERE, h, ratio * h, 1024);
        hard_values shown = { .truth = oracle_ball(ratio * h, h),
                              .naive_double = naive_double(true, ratio * h, h),
                              .naive_float = naive_float(true, ratio * h, h) };
        snprintf(what, sizeof what, "r/d = %g, radiance 1", ratio);
        compare("L10", what, &light, 1e-6, 0.01, &shown);
    }
}

/// L11: compares with closed forms, and checks the error of N samples.
static void closed_form(glint_light_kind kind, const char *name, double h, double r, double stated)
{
    const double want = kind == GLINT_LIGHT_DISK ? oracle_disk(r, h) : oracle_ball(r, h);
    double first[2] = { 0 };
    if (stated > 0)
        hard_check(fabs(want - stated) < 1e-10, "oracle %.12g, stated %.12g", want, stated);
    for (int n = 16; n <= 1024; n *= 4) {
        char what[96];
        double off[2];
        hard_values shown = { want, 0, 0, HARD_BLANK, HARD_BLANK };
        double *const got[2] = { &shown.in_double, &shown.in_float };
        const glint_light_desc light = radiant(kind, h, r, n);
        bool right = true;
        for (int p = 0; p < 2; p++) {
            *got[p] = point_lit(&light, NULL, 0, 1e-6 * h, want, (glint_precision)p, &off[p], NULL);
            if (n == 16)
                first[p] = off[p];
            const double rounding =
                1e-6 * want; // rounding is the only error of a ball, whose samples all contribute equally
            right &= hard_check(off[p] <= fmax(2 * first[p] / sqrt(n / 16.0), rounding),
                                "%s: error of %d samples %g, of 16 %g", name, n, off[p], first[p]) &
                     hard_check(n < 1024 || off[p] <= fmax(first[p] / 8, rounding),
                                "%s: error of 1024 samples %g, of 16 %g", name, off[p], first[p]) &
                     hard_check(fabs(*got[p] - want) <= 2.5 * off[p] + rounding, "%s: mean %g, truth %g", name, *got[p],
                                want);
        }
        snprintf(what, sizeof what, "%s, radius %g at %g, %d samples: error %.1e", name, r, h, n, off[0]);
        hard_row("L11", what, &shown, right);
    }
}

static void closed_forms(void)
{
    hard_test("L11", "closed forms of disk and ball");
    closed_form(GLINT_LIGHT_DISK, "disk", 2, 1, 0.6283185307);
    closed_form(GLINT_LIGHT_SPHERE, "ball", 2, 1, 0.7853981634);
    const bool table = hard_table;
    hard_table = false; // too many rows for the table
    for (int i = 0; i < 6; i++) {
        const double h = log_uniform(1e-6, 1e6), r = h * uniform(0.1, 0.9);
        closed_form(i % 2 ? GLINT_LIGHT_DISK : GLINT_LIGHT_SPHERE, "random", h, r, 0);
    }
    hard_table = table;
}

// ---- Noise ----

/// Returns the relative RMS error of 16 samples of a ball's whole surface, half of which is invisible from the point:
/// the textbook's columns. The ball has radius 1,
/// at a distance `away` and at an angle `tilt` (radians) from the floor's normal.
static double surface_noise(double away, double tilt)
{
    const double place[2] = { away * sin(tilt), away * cos(tilt) }, want = M_PI / (away * away) * cos(tilt);
    double square = 0;
    for (int trial = 0; trial < 20000; trial++) {
        double sum = 0;
        for (int i = 0; i < 16; i++) {
            double n[3];
            random_direction(n);
            const double l[3] = { place[0] + n[0], place[1] + n[1], n[2] };
            const double l2 = (l[0] * l[0] + l[1] * l[1]) + l[2] * l[2];
            const double facing = -((n[0] * l[0] + n[1] * l[1]) + n[2] * l[2]);
            if (facing > 0 && l[1] > 0)
                sum += 4 * M_PI / 16 * facing * l[1] / (l2 * l2);
        }
        square += (sum / want - 1) * (sum / want - 1);
    }
    return sqrt(square / 20000);
}

/// Checks the noise of a pixel with 16 samples of a ball of radius 1, `away` radii away and `degrees` off the normal.
/// The noise must be at most `most`, and the mean over the block of pixels must equal the closed form.
static void check_noise(double away, double degrees, double most)
{
    const double tilt = degrees * M_PI / 180, want = M_PI / (away * away) * cos(tilt);
    glint_light_desc light = radiant(GLINT_LIGHT_SPHERE, away * cos(tilt), 1, 16);
    hard_values shown = { 0, 0, 0, surface_noise(away, tilt), HARD_BLANK };
    double *const got[2] = { &shown.in_double, &shown.in_float };
    bool right = true;
    char what[96];
    light.position[0] = away * sin(tilt);
    light.radiance = 1e4; // so bright that no pixel of a distant ball rounds to 0
    for (int p = 0; p < 2; p++) {
        double off;
        const double mean = point_lit(&light, NULL, 0, 1e-6, 1e4 * want, (glint_precision)p, &off, NULL) / (1e4 * want);
        *got[p] = off / (1e4 * want);
        right &= hard_check(*got[p] <= most, "%g radii, %g degrees: noise %g", away, degrees, *got[p]) &
                 hard_check(fabs(mean - 1) <= 0.1 * most + 1e-6, "%g radii, %g degrees: mean %.9g of the truth", away,
                            degrees, mean);
    }
    snprintf(what, sizeof what, "noise of 16 samples, ball %g radii away, %g degrees off the normal", away, degrees);
    hard_row("cone", what, &shown, right);
}

/// Checks the noise of balls entirely above the horizon, which are sampled by solid angle.
static void noise(void)
{
    hard_test("cone", "noise of a ball by radiance");
    for (int i = 0; i < 7; i++) {
        static const double far[] = { 1.0001, 1.05, 1.33, 3, 100, 1e4, 1e9 };
        check_noise(far[i], 0, 1e-6);
        if (far[i] >= 1.33)
            check_noise(far[i], 30, 0.01);
        if (far[i] >= 3)
            check_noise(far[i], 60, 0.01);
    }
}

// ---- Shadows ----

typedef struct shadow {
    double light, height, ball, between; ///< radius and height of the light; radius and height of the occluder
} shadow;

/// Returns the share of the light that reaches the floor at x, with 1024 samples:
/// 0 in the umbra, 1 outside the penumbra.
static double share(const shadow *s, double x, glint_precision precision)
{
    const hard_sphere ball = { { 0, s->between, 0 }, s->ball };
    glint_light_desc light = above(GLINT_LIGHT_SPHERE, s->height, s->light);
    light.samples = 1024;
    const double open = point_lit(&light, NULL, x, 1e-9 * s->height, 0, precision, NULL, NULL);
    return point_lit(&light, &ball, x, 1e-9 * s->height, 0, precision, NULL, NULL) / open;
}

/// Returns the x where the share first exceeds `level` if that is 0, or first reaches `level` if that is 1.
static double edge(const shadow *s, double level, glint_precision precision)
{
    double low = 0, high = 3 * oracle_shadow(false, s->light, s->height, s->ball, s->between);
    for (int i = 0; i < 14; i++) {
        const double x = 0.5 * (low + high), here = share(s, x, precision);
        *((level == 0 ? here > 0 : here >= 1) ? &high : &low) = x;
    }
    return level == 0 ? high : low;
}

/// L12. In the umbra all samples are occluded, outside the penumbra none. With so many samples the visible edges of
/// the shadow are close to the true edges.
static void check_shadow(const char *what, const shadow *s, double stated_umbra, double stated_penumbra)
{
    const double umbra = oracle_shadow(true, s->light, s->height, s->ball, s->between),
                 penumbra = oracle_shadow(false, s->light, s->height, s->ball, s->between);
    hard_values inner = { umbra, 0, 0, HARD_BLANK, HARD_BLANK }, outer = { penumbra, 0, 0, HARD_BLANK, HARD_BLANK };
    double *const edges[2][2] = { { &inner.in_double, &inner.in_float }, { &outer.in_double, &outer.in_float } };
    bool right = true;
    char line[128];
    if (stated_penumbra > 0)
        hard_check(fabs(umbra - stated_umbra) < 1e-12 && fabs(penumbra - stated_penumbra) < 1e-7,
                   "oracle %.12g and %.12g, stated %.12g and %.12g", umbra, penumbra, stated_umbra, stated_penumbra);
    for (int p = 0; p < 2; p++) {
        const glint_precision precision = (glint_precision)p;
        const double near = p ? 1e-5 : 1e-8;
        right &= hard_check(share(s, umbra * (1 - near), precision) == 0, "light within the umbra") &
                 hard_check(share(s, penumbra * (1 + near), precision) == 1, "shadow beyond the penumbra");
        *edges[0][p] = edge(s, 0, precision);
        *edges[1][p] = edge(s, 1, precision);
        right &= hard_check(*edges[0][p] >= umbra * (1 - near) && *edges[0][p] < umbra + 0.1 * (penumbra - umbra),
                            "umbra ends at %g, truth %g", *edges[0][p], umbra) &
                 hard_check(*edges[1][p] <= penumbra * (1 + near) && *edges[1][p] > penumbra - 0.1 * (penumbra - umbra),
                            "penumbra ends at %g, truth %g", *edges[1][p], penumbra);
    }
    snprintf(line, sizeof line, "%s: where light begins, by 1024 samples", what);
    hard_row("L12", line, &inner, right);
    snprintf(line, sizeof line, "%s: where all of it is there", what);
    hard_row("L12", line, &outer, right);
}

static void shadows(void)
{
    hard_test("L12", "umbra and penumbra");
    check_shadow("light 0.5 at 4, ball 0.5 at 2", &(shadow) { 0.5, 4, 0.5, 2 }, 0.5, sqrt(3));
    check_shadow("light 0.1 at 4, ball 1 at 2", &(shadow) { 0.1, 4, 1, 2 }, 0, 0);
    check_shadow("light 0.6 at 5, ball 0.5 at 1", &(shadow) { 0.6, 5, 0.5, 1 }, 0, 0);
    check_shadow("all times 2^20", &(shadow) { 0x1p19, 0x1p22, 0x1p19, 0x1p21 }, 0, 0);
    check_shadow("all times 1e-6", &(shadow) { 0.5e-6, 4e-6, 0.5e-6, 2e-6 }, 0, 0);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_columns("Lights with a surface: the diffuse light of a white point of a floor.");
    no_radius();
    within();
    tiny();
    closed_forms();
    noise();
    shadows();
    return hard_end();
}
