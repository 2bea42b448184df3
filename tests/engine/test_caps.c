/// Soft shadows in closed form: the covered share of a light against its integral, every instruction set, and lights
/// that still need rays.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "tests/engine/cases/floor_scene.h"
#include "tests/engine/cases/random.h"
#include "tests/engine/cases/sets.h"

#define SIDE 80
#define PI 3.14159265358979323846264338327950288L

static glint_light *add_light(glint_scene *scene, const double center[3], double radius, glint_shadow shadow)
{
    glint_light_desc d = glint_light_desc_default(GLINT_LIGHT_SPHERE);
    glint_light *light;
    memcpy(d.position, center, sizeof d.position);
    d.radius = radius;
    d.shadow = shadow;
    assert_int_equal(glint_light_create(&d, &light, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_light(scene, light, NULL), GLINT_OK);
    glint_light_release(light);
    return light;
}

static glint_image *render(const glint_scene *scene, const char *isa, int threads, int side, glint_precision precision,
                           glint_frame_stats *stats)
{
    glint_render_desc desc = glint_render_desc_default();
    glint_renderer_desc r = { .struct_size = sizeof(glint_renderer_desc), .isa = isa, .threads = threads, .count_work = true };
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    desc.width = desc.height = side;
    desc.precision = precision;
    desc.passes |= 1u << GLINT_PASS_DIFFUSE | 1u << GLINT_PASS_OBJECT_ID;
    glint_status status = glint_renderer_create(&r, &renderer, NULL);
    if (status == GLINT_ERR_UNSUPPORTED)
        return NULL;
    assert_int_equal(status, GLINT_OK);
    assert_int_equal(glint_plan_create(scene, &desc, &plan, NULL), GLINT_OK);
    assert_int_equal(glint_render(renderer, plan, &image, stats, NULL), GLINT_OK);
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    return image;
}

static float diffuse_at(const glint_image *image, int x, int y)
{
    float p[3];
    assert_int_equal(glint_image_pixel(image, GLINT_PASS_DIFFUSE, x, y, p, NULL), GLINT_OK);
    return p[0];
}

// ---- The covered share, by integration ----

/// Returns the share of a light that a ball covers, as seen from the origin. Integrates over the light's disk in the
/// sky, ring by ring.
static long double covered(const double light[3], double light_radius, const double ball[3], double radius)
{
    enum { RINGS = 20000 };
    long double d2 = 0, e2 = 0, cross2 = 0, dot = 0, sum = 0;
    for (int c = 0; c < 3; c++) {
        const int i = (c + 1) % 3, j = (c + 2) % 3;
        const long double x = (long double)light[i] * ball[j] - (long double)light[j] * ball[i];
        d2 += (long double)light[c] * light[c];
        e2 += (long double)ball[c] * ball[c];
        cross2 += x * x;
        dot += (long double)light[c] * ball[c];
    }
    const long double s = asinl(light_radius / sqrtl(d2)), a = asinl(radius / sqrtl(e2));
    const long double g = atan2l(sqrtl(cross2), dot);
    for (int i = 0; i < RINGS; i++) {
        const long double t = s * (i + 0.5L) / RINGS;
        // sin^2 of half the angle, without cancellation: cos x = cos t cos g + sin t sin g cos f
        const long double half = sinl((t - g) / 2), over = sinl(a / 2) * sinl(a / 2) - half * half;
        const long double share = over / (sinl(t) * sinl(g));
        const long double f = share <= 0 ? 0 : share >= 1 ? PI : 2 * asinl(sqrtl(share));
        sum += f / PI * sinl(t);
    }
    return sum * s / RINGS / (2 * sinl(s / 2) * sinl(s / 2));
}

/// Renders the share of a light that is visible from the floor's origin. The eye is next to the origin.
static double share_seen(const double light[3], double light_radius, const double ball[3], double radius)
{
    double got[2];
    for (int shadows = 0; shadows < 2; shadows++) {
        const double eye[3] = { 0, 1e-300, 0 }, at[3] = { 0, 0, 0 };
        glint_scene *scene = make_floor(eye, at);
        glint_light *lamp = add_light(scene, light, light_radius, GLINT_SHADOW_CAPS);
        glint_light_desc d = *glint_light_get(lamp);
        d.struct_size = sizeof d;
        add_ball(scene, ball, radius, 0);
        d.shadows = shadows;
        d.radius = shadows ? light_radius : 0;
        assert_int_equal(glint_light_set(lamp, &d, NULL), GLINT_OK);
        glint_image *image = render(scene, NULL, 1, 1, GLINT_PRECISION_DOUBLE, NULL);
        got[shadows] = diffuse_at(image, 0, 0);
        glint_image_release(image);
        glint_scene_release(scene);
    }
    assert_true(got[0] > 0);
    return got[1] / got[0];
}

static void near_share(const double light[3], double light_radius, const double ball[3], double radius, double want)
{
    const double got = share_seen(light, light_radius, ball, radius);
    if (!(fabs(got - want) <= 2e-6))
        fail_msg("light %g %g %g, %g, ball %g %g %g, %g: %.9g, wanted %.9g", light[0], light[1], light[2], light_radius,
                 ball[0], ball[1], ball[2], radius, got, want);
}

/// Lights of any size, down to 1e-9 of their distance. The balls look as large as the light, smaller or larger, or
/// are next to the point.
static void parts_of_a_light(void **unused)
{
    int partial = 0;
    (void)unused;
    for (int n = 0; n < 600; n += (int)case_step()) {
        const double d = pow(10, between(-3, 3)), s = n % 3 ? between(0.01, 0.6) : pow(10, between(-9, -1));
        const double e = d * (n % 2 ? between(0.05, 0.3) : pow(10, between(-6, -1)));
        const double a = n % 5 < 3 ? s * pow(10, between(-0.7, 0.7)) : between(0.2, 1.2);
        const double g = a < 1.3 ? (a - s > 0 ? a - s : s - a) + between(0, 2) * (a < s ? a : s) : 0;
        const double tilt = between(0, 0.7), turn = between(0, 6.28);
        // the light is tilted by `tilt` from the vertical, the ball is at an angle `g` from the light
        const double light[3] = { d * sin(tilt) * cos(turn), d * cos(tilt), d * sin(tilt) * sin(turn) };
        const double right[3] = { -sin(turn), 0, cos(turn) };
        double ball[3];
        for (int c = 0; c < 3; c++)
            ball[c] = e * (cos(g) * light[c] / d + sin(g) * right[c]);
        const double radius = e * sin(a < 1.4 ? a : 1.4), light_radius = d * sin(s);
        if (e + radius > d - light_radius)
            continue; // the ball is not entirely in front of the light
        const double want = 1 - (double)covered(light, light_radius, ball, radius);
        partial += want > 0.01 && want < 0.99;
        near_share(light, light_radius, ball, radius, want);
    }
    assert_true(partial * (int)case_step() > 200);
}

static void one_in_the_other(void **unused)
{
    (void)unused;
    const double light[3] = { 0, 4, 0 };
    near_share(light, 0.5, (double[3]) { 0.1, 4.1, 0 }, 1.5, 0); // the light inside the ball
    near_share(light, 1.5, (double[3]) { 0.1, 4.1, 0 }, 0.5, 1); // the ball inside the light
    near_share(light, 0.5, (double[3]) { 0, 7, 0 }, 2, 1); // the ball behind the light
    near_share(light, 5, (double[3]) { 0, 2, 0 }, 0.5, 1); // the point inside the light
    near_share(light, 4, (double[3]) { 0, 2, 0 }, 0.5, 1); // the point on the light
    near_share(light, 0.5, (double[3]) { 0, 0.5, 0 }, 2, 0); // the point inside the ball, the light outside
    near_share(light, 0.5, (double[3]) { 0, 0.5, 0 }, 5, 1); // both inside the ball
    near_share(light, 0.5, (double[3]) { 0, 0.5, 0 }, 3.5, 0.5); // half of the light inside the ball
    near_share(light, 1e-149, (double[3]) { 0, 2, 0 }, 0.25e-149, 0.75); // the ball covers a quarter of the light
    near_share(light, 0.5, (double[3]) { 0, -40, 0 }, 2, 1); // the ball below the floor
}

/// Test case L12 in tests/hard: a light of radius 0.5 at height 4 above a ball of radius 0.5
/// at height 2: umbra 0.5, penumbra sqrt(3).
static void umbra_and_penumbra(void **unused)
{
    (void)unused;
    for (int i = 0; i < 400; i++) {
        const double x = i * 0.005, light[3] = { -x, 4, 0 }, ball[3] = { -x, 2, 0 };
        const double got = share_seen(light, 0.5, ball, 0.5);
        if (x < 0.5 - 1e-9)
            assert_true(got == 0);
        else if (x > sqrt(3) + 1e-9)
            assert_true(got == 1);
        else if (x > 0.5 + 1e-9 && x < sqrt(3) - 0.01)
            assert_true(got > 0 && got < 1);
    }
}

// ---- Pictures ----

static glint_scene *make_field(glint_shadow shadow, bool radiant)
{
    const double eye[3] = { 0, 6, 9 }, at[3] = { 0, 0.5, 0 }, above[3] = { 1, 6, 1 }, within[3] = { -1.2, 1, 0.5 };
    glint_scene *scene = make_floor(eye, at);
    for (int i = 0; i < 60; i++)
        add_ball(scene, (double[3]) { i % 8 - 3.5, 0.2 + 0.04 * i, i / 8 - 3 }, 0.15 + 0.01 * (i % 20),
                 i % 3 ? 0 : 0.3);
    add_ball(scene, (double[3]) { -1.2, 1, 0.2 }, 0.9, 0);
    for (int i = 0; i < 2; i++) {
        glint_light *light = add_light(scene, i ? within : above, 0.8, shadow);
        glint_light_desc d = *glint_light_get(light);
        d.struct_size = sizeof d;
        d.intensity = radiant ? 1 : 0.5;
        d.has_radiance = radiant;
        d.radiance = 2;
        assert_int_equal(glint_light_set(light, &d, NULL), GLINT_OK);
    }
    return scene;
}

static void every_way_gives_one_picture(void **unused)
{
    static const struct {
        const char *isa;
        int threads;
    } ways[] = { { "generic", 1 }, { "avx2", 1 }, { "avx512", 1 }, { NULL, 3 } };
    (void)unused;
    for (int precision = 0; precision < 2; precision++)
        for (int radiant = 0; radiant < 2; radiant++) {
            glint_scene *scene = make_field(GLINT_SHADOW_CAPS, radiant);
            glint_image *want = render(scene, "ref", 1, SIDE, (glint_precision)precision, NULL);
            for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
                glint_image *got = render(scene, ways[i].isa, ways[i].threads, SIDE, (glint_precision)precision, NULL);
                if (got && differing(got, want))
                    fail_msg("way %zu, precision %d: %d pixels differ", i, precision, differing(got, want));
                glint_image_release(got);
            }
            glint_image_release(want);
            glint_scene_release(scene);
        }
}

/// Compares the picture with 4096 samples, on the floor, where the light is high above the horizon.
static void truth_by_samples(void **unused)
{
    (void)unused;
    glint_image *image[2];
    for (int shadow = 0; shadow < 2; shadow++) {
        glint_scene *scene = make_floor((double[3]) { 0, 8, 9 }, (double[3]) { 0, 0, 0 });
        glint_light *light =
            add_light(scene, (double[3]) { 0, 9, 0 }, 0.5, shadow ? GLINT_SHADOW_CAPS : GLINT_SHADOW_RAYS);
        glint_light_desc d = *glint_light_get(light);
        d.struct_size = sizeof d;
        d.samples = 4096;
        d.has_radiance = true;
        d.radiance = 40;
        assert_int_equal(glint_light_set(light, &d, NULL), GLINT_OK);
        add_ball(scene, (double[3]) { 0.6, 4, 0 }, 0.7, 0);
        add_ball(scene, (double[3]) { -1.6, 3, 0.4 }, 0.5, 0);
        image[shadow] = render(scene, NULL, 1, SIDE, GLINT_PRECISION_DOUBLE, NULL);
        glint_scene_release(scene);
    }
    double most = 0, square = 0;
    int count = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            float id[3];
            glint_image_pixel(image[0], GLINT_PASS_OBJECT_ID, x, y, id, NULL);
            if (id[0] != 1)
                continue;
            const double off = fabs((double)diffuse_at(image[0], x, y) - (double)diffuse_at(image[1], x, y));
            most = fmax(most, off);
            square += off * off;
            count++;
        }
    assert_true(count > SIDE * SIDE / 2);
    if (most > 0.01 || sqrt(square / count) > 0.001) // the full light is about 1
        fail_msg("off by %g at most, rms %g", most, sqrt(square / count));
    glint_image_release(image[0]);
    glint_image_release(image[1]);
}

// ---- When the effect is used ----

static void only_where_called_for(void **unused)
{
    (void)unused;
    for (int shadow = 0; shadow < 2; shadow++) {
        glint_scene *scene = make_field(shadow ? GLINT_SHADOW_CAPS : GLINT_SHADOW_RAYS, false);
        glint_frame_stats stats;
        glint_image_release(render(scene, NULL, 1, SIDE, GLINT_PRECISION_DOUBLE, &stats));
        assert_int_equal(stats.work.overlaps > 0, shadow);
        assert_int_equal(stats.rays.shadow > 0, !shadow);
        assert_int_equal(has_effect(scene, "soft shadow by caps"), shadow);
        assert_int_equal(has_effect(scene, "soft shadow"), !shadow);
        glint_scene_release(scene);
    }
}

/// A box or glass makes the engine trace shadow rays, and the picture is identical to one computed with rays.
static void other_shapes_have_rays(void **unused)
{
    (void)unused;
    for (int glass = 0; glass < 2; glass++) {
        glint_image *image[2];
        for (int shadow = 0; shadow < 2; shadow++) {
            glint_scene *scene = make_field(shadow ? GLINT_SHADOW_CAPS : GLINT_SHADOW_RAYS, true);
            glint_shape_desc d = glint_shape_desc_default(glass ? GLINT_SHAPE_SPHERE : GLINT_SHAPE_BOX);
            glint_material_desc m = glint_material_desc_default();
            glint_material *material;
            glint_shape *shape;
            m.transmission[1] = glass;
            assert_int_equal(glint_material_create(&m, &material, NULL), GLINT_OK);
            d.material = material;
            assert_int_equal(glint_shape_create(&d, &shape, NULL), GLINT_OK);
            assert_int_equal(glint_scene_add_shape(scene, shape, NULL), GLINT_OK);
            assert_false(has_effect(scene, "soft shadow by caps"));
            assert_true(has_effect(scene, "soft shadow"));
            assert_int_equal(has_effect(scene, "rays in place of caps"), shadow);
            image[shadow] = render(scene, NULL, 1, SIDE, GLINT_PRECISION_DOUBLE, NULL);
            glint_shape_release(shape);
            glint_material_release(material);
            glint_scene_release(scene);
        }
        assert_int_equal(differing(image[0], image[1]), 0);
        glint_image_release(image[0]);
        glint_image_release(image[1]);
    }
}

/// Hard shadows: a point is dark where the centre of the light is hidden, and otherwise lit as without shadows. One
/// ray replaces sixteen samples.
static void hard_is_of_the_middle(void **unused)
{
    static const double corners[3][3] = { { 0, 6, 0 }, { 3, 6, 0 }, { 0, 6, 3 } };
    (void)unused;
    for (int kind = GLINT_LIGHT_DISK; kind <= GLINT_LIGHT_SPHERE; kind++) {
        glint_image *image[3]; // pictures without shadows, with hard shadows, and with a point light at the centre
        glint_frame_stats stats;
        for (int way = 0; way < 3; way++) {
            glint_scene *scene = make_floor((double[3]) { 0, 8, 9 }, (double[3]) { 0, 0, 0 });
            glint_light_desc d = glint_light_desc_default(way == 2 ? GLINT_LIGHT_POINT : (glint_light_kind)kind);
            glint_light *light;
            const bool polygon = kind == GLINT_LIGHT_POLYGON;
            memcpy(d.position, (double[3]) { polygon, 6, polygon }, sizeof d.position);
            d.shadows = way > 0;
            d.vertices = corners;
            d.vertex_count = 3;
            d.two_sided = true;
            d.shadow = way < 2 ? GLINT_SHADOW_HARD : GLINT_SHADOW_RAYS;
            assert_int_equal(glint_light_create(&d, &light, NULL), GLINT_OK);
            assert_int_equal(glint_scene_add_light(scene, light, NULL), GLINT_OK);
            glint_light_release(light);
            add_ball(scene, (double[3]) { 0.5, 2, 0.5 }, 1, 0);
            image[way] = render(scene, NULL, 1, SIDE, GLINT_PRECISION_DOUBLE, &stats);
            assert_true(way == 0 || (stats.rays.shadow <= SIDE * SIDE && stats.rays.shadow > SIDE * SIDE / 2));
            for (size_t i = 0; i < INSTRUCTION_SETS; i++) {
                glint_image *same = render(scene, instruction_sets[i], 2, SIDE, GLINT_PRECISION_DOUBLE, NULL);
                assert_true(!same || differing(same, image[way]) == 0);
                glint_image_release(same);
            }
            assert_int_equal(has_effect(scene, "hard shadow"), way > 0);
            assert_false(has_effect(scene, "soft shadow"));
            glint_scene_release(scene);
        }
        int dark = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const float all = diffuse_at(image[0], x, y), hard = diffuse_at(image[1], x, y);
                float id[3];
                glint_image_pixel(image[0], GLINT_PASS_OBJECT_ID, x, y, id, NULL);
                if (id[0] != 1)
                    continue;
                dark += hard == 0;
                assert_true(hard == (diffuse_at(image[2], x, y) > 0 ? all : 0));
            }
        assert_true(dark > 50);
        for (int way = 0; way < 3; way++)
            glint_image_release(image[way]);
    }
}

static void bad_descriptions_are_refused(void **unused)
{
    glint_light_desc d = glint_light_desc_default(GLINT_LIGHT_DISK);
    glint_light *light;
    glint_error error;
    (void)unused;
    d.shadow = GLINT_SHADOW_CAPS;
    assert_int_equal(glint_light_create(&d, &light, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "shadow: rays or hard expected; only sphere lights have caps");
    d = glint_light_desc_default(GLINT_LIGHT_SPHERE);
    d.shadow = GLINT_SHADOW_CAPS;
    d.has_radiance = true;
    d.attenuation[2] = 1;
    assert_int_equal(glint_light_create(&d, &light, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message,
                        "attenuation: with a radiance and shadow = caps, expected {1, 0, 0}, got {1, 0, 1}");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_of_a_light),
        cmocka_unit_test(one_in_the_other),
        cmocka_unit_test(umbra_and_penumbra),
        cmocka_unit_test(every_way_gives_one_picture),
        cmocka_unit_test(truth_by_samples),
        cmocka_unit_test(only_where_called_for),
        cmocka_unit_test(other_shapes_have_rays),
        cmocka_unit_test(hard_is_of_the_middle),
        cmocka_unit_test(bad_descriptions_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
