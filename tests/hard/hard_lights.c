/// Test cases for lights: at the shaded point, inside shapes, far away, spots, area lights, and sums of very many
/// lights. Each case is rendered in double and float, compared with the textbook's formula,
/// and repeated with other numbers.
#include "tests/engine/cases/step.h"
#include "tests/hard/oracle/oracle_light.h"
#include "tests/hard/oracle/point.h"

#include <string.h>

static glint_light_desc light_sample_at(glint_light_kind kind, double x, double y, double z)
{
    glint_light_desc light = glint_light_desc_default(kind);
    light.position[0] = x;
    light.position[1] = y;
    light.position[2] = z;
    return light;
}

static double lit(const glint_light_desc *light, const hard_sphere *more, double x, glint_precision precision)
{
    return point_lit(light, more, x, 1e-6, 0, precision, NULL, NULL);
}

/// Checks both precisions, each within `off` of the truth.
static void compare(const char *id, const char *what, const glint_light_desc *light, hard_values *shown, double off,
                    double off_float)
{
    shown->in_double = lit(light, NULL, 0, GLINT_PRECISION_DOUBLE);
    shown->in_float = lit(light, NULL, 0, GLINT_PRECISION_FLOAT);
    const bool right = hard_check(fabs(shown->in_double - shown->truth) <= off, "%s in double: %.10g, truth %.10g",
                                  what, shown->in_double, shown->truth) &
                       hard_check(fabs(shown->in_float - shown->truth) <= off_float, "%s in float: %.10g, truth %.10g",
                                  what, shown->in_float, shown->truth);
    hard_row(id, what, shown, right);
}

// ---- Where distances vanish or overflow ----

/// The textbook's n.l / (c0 + c2 d^2) for a light at height h above a floor, at a horizontal distance x.
#define NAIVE(name, real, root) \
    static double name(double x, double h, double c0, double c2) \
    { \
        const real d2 = (real)x * (real)x + (real)h * (real)h, d = root(d2); \
        return (double)((real)h / d / ((real)c0 + (real)c2 * d2)); \
    }
NAIVE(naive_float, float, sqrtf)
NAIVE(naive_double, double, sqrt)

/// L1: every kind of light exactly at the shaded point.
static void at_the_point(void)
{
    static const glint_light_kind kinds[] = { GLINT_LIGHT_POINT, GLINT_LIGHT_SPOT, GLINT_LIGHT_DISK,
                                              GLINT_LIGHT_SPHERE };
    hard_test("L1", "light at the shaded point");
    for (int k = 0; k < 4; k++)
        for (int c2 = 0; c2 < 2; c2++)
            for (int p = 0; p < 2; p++) { // a ray straight down hits the origin exactly
                const hard_plane floor = { { 0 }, { 0, 1, 0 } };
                const hard_ray down = { { 0, 4, 0 }, { 0, -1, 0 } };
                glint_light_desc light = light_sample_at(kinds[k], 0, 0, 0);
                light.radius = 0;
                if (c2)
                    memcpy(light.attenuation, (double[3]) { 0, 0, 1 }, sizeof light.attenuation);
                glint_scene *scene = scene_new();
                scene_plane(scene, &floor, NULL);
                scene_light(scene, &light);
                const double got = point_seen(scene, &down, p ? GLINT_PRECISION_FLOAT : GLINT_PRECISION_DOUBLE, 5, GLINT_PASS_BEAUTY);
                glint_scene_release(scene);
                hard_check(got == 0, "kind %d: %g", kinds[k], got);
            }
    hard_row("L1", "light at the shaded point",
             &(hard_values) { 0, 0, 0, naive_double(0, 0, 0, 1), naive_float(0, 0, 0, 1) }, true);
}

static void far_and_near(void)
{
    hard_test("L4", "light at 1e30 and beyond, no attenuation");
    static const double distances[] = { 1e18, 1e30, 1e155, 8e307 };
    for (int i = 0; i < 4; i++) {
        const double far = distances[i];
        char what[64];
        const glint_light_desc light = light_sample_at(GLINT_LIGHT_POINT, far, 2 * far, 0);
        hard_values shown = { .truth = 2 / sqrt(5),
                              .naive_double = naive_double(far, 2 * far, 1, 0),
                              .naive_float = naive_float(far, 2 * far, 1, 0) };
        snprintf(what, sizeof what, "light at %g", far);
        // the range of float ends at 3.4e38
        compare("L4", what, &light, &shown, 0x1p-23, far < 1e38 ? 0x1p-22 : 1);
    }
    hard_test("L5", "light next to the point, inverse square");
    static const double heights[] = { 1e-10, 1e-30, 1e-100, 1e-300 };
    for (int i = 0; i < 4; i++) { // lights straight above the point that the ray hits
        const double near = heights[i];
        const hard_plane floor = { { 0 }, { 0, 1, 0 } };
        const hard_ray down = { { 0, 4, 0 }, { 0, -1, 0 } };
        glint_light_desc light = light_sample_at(GLINT_LIGHT_POINT, 0, near, 0);
        hard_values shown = { HARD_BLANK, 0, 0, naive_double(0, near, 0, 1), naive_float(0, near, 0, 1) };
        double *const got[2] = { &shown.in_double, &shown.in_float };
        char what[64];
        bool right = true;
        memcpy(light.attenuation, (double[3]) { 0, 0, 1 }, sizeof light.attenuation);
        for (int p = 0; p < 2; p++) {
            glint_scene *scene = scene_new();
            scene_plane(scene, &floor, NULL);
            scene_light(scene, &light);
            *got[p] = point_seen(scene, &down, p ? GLINT_PRECISION_FLOAT : GLINT_PRECISION_DOUBLE, 5, GLINT_PASS_BEAUTY);
            glint_scene_release(scene);
            // a height below the smallest float is 0 in float, so the light is at the point
            const bool vanished = p && (float)near == 0;
            right &=
                hard_check(vanished ? *got[p] == 0 : *got[p] >= 1 && *got[p] < HUGE_VAL, "%g away: %g", near, *got[p]);
        }
        snprintf(what, sizeof what, "%g away: white, finite", near);
        hard_row("L5", what, &shown, right);
    }
}

// ---- Inside and outside of an opaque ball ----

/// L2, L3, L3b: the visible light on a ball of radius 1 straight ahead,
/// for an eye and a light inside or outside the ball.
static void within(void)
{
    static const struct {
        const char *id, *what;
        double eye, light;
        bool directional;
        double want;
    } list[] = {
        { "L2", "light inside a ball, eye outside", 3, 0.25, false, 0 },
        { "L3", "both inside, light at the centre", 0.5, 0, false, 1 },
        { "L3", "both inside", 0.5, 0.25, false, 1 },
        { "L3b", "eye inside, light outside", 0.5, 3, false, 0 },
        { "L3b", "eye inside, directional light", 0.5, 1, true, 0 },
        { "L2", "light and eye outside", 3, 4, false, 1 },
    };
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        hard_values shown = { list[i].want, 0, 0, HARD_BLANK, HARD_BLANK };
        double *const got[2] = { &shown.in_double, &shown.in_float };
        bool right = true;
        hard_test(list[i].id, list[i].what);
        for (int e = -30; e <= 30; e += 10) // other scales, and other view directions
            for (int way = 0; way < 3; way++)
                for (int p = 0; p < 2; p++) {
                    hard_ray ray = { { 0 }, { 0 } };
                    const hard_sphere ball = { { 0 }, ldexp(1, e) };
                    const double ahead = list[i].eye > 1 ? -1 : 1, white[3] = { 1, 1, 1 };
                    glint_light_desc light =
                        light_sample_at(list[i].directional ? GLINT_LIGHT_DIRECTIONAL : GLINT_LIGHT_POINT, 0, 0, 0);
                    ray.o[way] = ldexp(list[i].eye, e);
                    ray.d[way] = ahead;
                    memset(light.direction, 0, sizeof light.direction);
                    light.direction[way] = -ahead;
                    light.position[way] = ldexp(list[i].light, e);
                    glint_scene *scene = scene_new();
                    glint_material *matt = material_new(GLINT_MODEL_LAMBERT, white, 0, 1);
                    scene_sphere(scene, &ball, matt);
                    glint_material_release(matt);
                    scene_light(scene, &light);
                    *got[p] = point_seen(scene, &ray, p ? GLINT_PRECISION_FLOAT : GLINT_PRECISION_DOUBLE, 5, GLINT_PASS_DIFFUSE);
                    glint_scene_release(scene);
                    right &= hard_check(*got[p] == list[i].want, "%g, not %g", *got[p], list[i].want);
                }
        hard_row(list[i].id, list[i].what, &shown, right);
    }
}

// ---- Spots ----

#define DEGREE (M_PI / 180)

static double naive_spot(double inner, double outer, double angle)
{
    const float c = cosf((float)angle), in = cosf((float)inner), out = cosf((float)outer);
    float x = (c - out) / (in - out);
    x = x < 0 ? 0 : x > 1 ? 1 : x;
    return x * x * (3 - 2 * x);
}

/// A spot light 4 units above the floor's point, with its axis at an angle `angle`.
static glint_light_desc spot_off(double inner, double outer, double exponent, double angle)
{
    glint_light_desc light = light_sample_at(GLINT_LIGHT_SPOT, 0, 4, 0);
    light.direction[0] = sin(angle);
    light.direction[1] = -cos(angle);
    light.direction[2] = 0;
    light.inner_rad = inner;
    light.outer_rad = outer;
    light.exponent = exponent;
    return light;
}

static void check_spot(const char *id, const char *what, double inner, double outer, double exponent, double angle,
                       double stated)
{
    const double to_point[3] = { 0, -1, 0 };
    const glint_light_desc light = spot_off(inner, outer, exponent, angle);
    hard_values shown = { .truth = oracle_spot(inner, outer, exponent, light.direction, to_point),
                          .naive_double = HARD_BLANK,
                          .naive_float = naive_spot(inner, outer, angle) * pow(cos(angle), exponent) };
    if (!isnan(stated))
        hard_check(fabs(shown.truth - stated) <= 5e-10, "oracle %.12g, stated %.12g", shown.truth, stated);
    // allows for the rounding of the cosine and of the pixel's position, times the profile's slope, and for the power
    const double width = fmax(cos(inner) - cos(outer), 1e-300), power = 1 + exponent;
    const double off = 4e-7 * power + fmin(1, 1e-14 / width), off_float = 1e-5 * power + fmin(1, 2e-6 / width);
    compare(id, what, &light, &shown, off, off_float);
}

/// L6: a spot light of 180 degrees equals a point light bit for bit, in any direction.
static void whole_spots(int scenes)
{
    long differ = 0;
    hard_test("L6", "spot of 180 degrees");
    for (int i = 0; i < scenes; i++)
        for (int p = 0; p < 2; p++) {
            const hard_sphere ball = { { uniform(-1, 1), 1, uniform(-1, 1) }, 1 };
            glint_light_desc light =
                light_sample_at(GLINT_LIGHT_POINT, uniform(-5, 5), uniform(1.5, 9), uniform(-5, 5));
            const double point = point_lit(&light, &ball, 0, 6, 0, (glint_precision)p, NULL, NULL);
            glint_light_desc spot =
                light_sample_at(GLINT_LIGHT_SPOT, light.position[0], light.position[1], light.position[2]);
            random_direction(spot.direction);
            spot.inner_rad = spot.outer_rad = M_PI;
            const double got = point_lit(&spot, &ball, 0, 6, 0, (glint_precision)p, NULL, NULL);
            differ += !hard_check(got == point, "%.17g, a point light %.17g", got, point);
        }
    hard_row("L6", "180 degrees: pictures unlike a point light's",
             &(hard_values) { 0, (double)differ, 0, HARD_BLANK, HARD_BLANK }, differ == 0);
}

static void spots(void)
{
    whole_spots(100 / (int)case_step());
    check_spot("L6", "inner = outer = 25, 24.999 off", 25 * DEGREE, 25 * DEGREE, 0, 24.999 * DEGREE, 1);
    check_spot("L6", "inner = outer = 25, 25.001 off", 25 * DEGREE, 25 * DEGREE, 0, 25.001 * DEGREE, 0);
    check_spot("L6", "inner = outer = 0, on the axis", 0, 0, 0, 0, NAN);
    check_spot("L6", "inner = outer = 90", 90 * DEGREE, 90 * DEGREE, 0, 80 * DEGREE, 1);
    hard_test("L7", "smoothstep in the cosine");
    check_spot("L7", "inner 20, outer 30, 25 off", 20 * DEGREE, 30 * DEGREE, 0, 25 * DEGREE, 0.5700181842);
    check_spot("L7", "the same, exponent 7", 20 * DEGREE, 30 * DEGREE, 7, 25 * DEGREE, NAN);
    check_spot("L7", "inner 0, outer 1e-3, 5e-4 off", 0, 1e-3, 0, 5e-4, NAN);
    check_spot("L7", "inner 89, outer 179, 85 off", 89 * DEGREE, 179 * DEGREE, 0, 85 * DEGREE, NAN);
    const bool table = hard_table;
    hard_table = false; // too many rows for the table
    for (int i = 0; i < 500; i += (int)case_step()) {
        const double outer = uniform(0, 3.14), inner = uniform(0, outer), exponent = chance(0.5) ? 0 : uniform(0, 50);
        check_spot("L7", "random", inner, outer, exponent, uniform(0, 1.4), NAN);
    }
    hard_table = table;
}

// ---- Sums ----

/// L13: n lights of intensity 1/n. L14: a thousand lights of 1e36 on a material that is black in one channel.
static void sums(int many)
{
    const double purple[3] = { 1, 0, 1 };
    for (int kind = 0; kind < 2; kind++) {
        const int count = kind ? 1000 : many;
        const double each = kind ? 1e36 : 1.0 / count;
        hard_values shown = { kind ? HARD_BLANK : 1, 0, 0, 0, 0 };
        float naive = 0;
        hard_test(kind ? "L14" : "L13", kind ? "1000 lights of 1e36" : "a million lights of 1e-6");
        glint_scene *scene = scene_new();
        const hard_plane floor = { { 0 }, { 0, 1, 0 } };
        glint_material *matt = material_new(GLINT_MODEL_LAMBERT, purple, 0, 1);
        scene_plane(scene, &floor, matt);
        glint_material_release(matt);
        glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_DIRECTIONAL);
        memcpy(light.direction, (double[3]) { 0, -1, 0 }, sizeof light.direction);
        light.intensity = each;
        for (int i = 0; i < count; i++) {
            light.shadows = kind && i % 2 == 0;
            scene_light(scene, &light);
            naive += (float)each;
            shown.naive_double += each;
        }
        shown.naive_float = (double)naive;
        double *const got[2] = { &shown.in_double, &shown.in_float };
        const hard_ray down = { { 0, 4, 0 }, { 0, -1, 0 } };
        bool right = true;
        for (int p = 0; p < 2; p++) {
            glint_image *image = frame_of_ray(scene, &down, p ? GLINT_PRECISION_FLOAT : GLINT_PRECISION_DOUBLE, 1u << GLINT_PASS_BEAUTY);
            float c[3];
            pixel(image, GLINT_PASS_BEAUTY, 0, 0, c);
            glint_image_release(image);
            *got[p] = c[0];
            right &= hard_check(kind ? c[0] >= 1 : fabsf(c[0] - 1) <= 0x1p-23f, "%d lights: %.9g", count, c[0]) &
                     hard_check(c[1] == 0 && c[2] == c[0], "channels %g %g %g", c[0], c[1], c[2]);
        }
        glint_scene_release(scene);
        hard_row(kind ? "L14" : "L13",
                 kind ? "1000 lights of 1e36: white, and 0 where the material is 0" : "1e6 lights of 1e-6", &shown,
                 right);
    }
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_columns("Lights: the diffuse light of a white point of a floor.");
    at_the_point();
    within();
    far_and_near();
    spots();
    sums(1000000 / (int)case_step());
    return hard_end();
}
