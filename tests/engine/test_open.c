/// Open cylinders and cones against 113-bit arithmetic: hits from outside and inside, and light.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "engine/glint.h"
#include "engine/glint_inspect.h"
#include "tests/engine/quad.h"

static uint64_t state;

static double uniform(double low, double high)
{
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(state >> 11) * 0x1p-53;
}

static void random_vector(double v[3], double size)
{
    for (int c = 0; c < 3; c++)
        v[c] = uniform(-size, size);
}

static quad dot(const quad a[3], const quad b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static quad root(quad x)
{
    quad y = sqrt((double)x);
    for (int i = 0; i < 3 && y > 0; i++)
        y = (y + x / y) / 2;
    return y;
}

/// The side of a cylinder or cone as its description says, before stretch and translation.
typedef struct side {
    quad from[3], along[3]; ///< the centre of one end, or the apex, and the unit vector to the other end
    quad length, radius, slope; ///< the radius at distance z from that end is radius + slope z
    quad stretch[3], move[3];
} side;

static glint_shape *random_shape(side *s)
{
    glint_shape_desc d = glint_shape_desc_default(uniform(0, 1) < 0.5 ? GLINT_SHAPE_CYLINDER : GLINT_SHAPE_CONE);
    glint_shape *shape;
    double by[3] = { uniform(0.5, 2), uniform(0.5, 2), uniform(0.5, 2) }, move[3];
    random_vector(d.base, 1);
    random_vector(d.top, 1);
    random_vector(move, 2);
    d.radius = uniform(0.2, 1.5);
    d.capped = false;
    const glint_transform scale = glint_transform_scale(by), shift = glint_transform_translate(move);
    d.transform = glint_transform_product(&shift, &scale);
    const bool cone = d.kind == GLINT_SHAPE_CONE;
    for (int c = 0; c < 3; c++) {
        s->from[c] = cone ? d.top[c] : d.base[c];
        s->along[c] = cone ? (quad)d.base[c] - d.top[c] : (quad)d.top[c] - d.base[c];
        s->stretch[c] = by[c];
        s->move[c] = move[c];
    }
    s->length = root(dot(s->along, s->along));
    for (int c = 0; c < 3; c++)
        s->along[c] /= s->length;
    s->radius = cone ? 0 : d.radius;
    s->slope = cone ? d.radius / s->length : 0;
    assert_int_equal(glint_shape_create(&d, &shape, NULL), GLINT_OK);
    return shape;
}

/// Intersects the line o + t d with the side, including both ends. *close becomes true if a hit is at an end, or if
/// the line is so nearly tangent that rounding decides. Returns the number of hits.
static int meet(const side *s, const quad o[3], const quad d[3], quad t[2], bool *close)
{
    quad f[3], e[3];
    for (int c = 0; c < 3; c++) {
        f[c] = (o[c] - s->move[c]) / s->stretch[c] - s->from[c];
        e[c] = d[c] / s->stretch[c];
    }
    const quad fz = dot(f, s->along), ez = dot(e, s->along), r = s->radius + s->slope * fz;
    const quad a = dot(e, e) - ez * ez - s->slope * s->slope * ez * ez;
    const quad b = dot(e, f) - ez * fz - s->slope * ez * r;
    const quad k = dot(f, f) - fz * fz - r * r;
    const quad disc = b * b - a * k;
    int count = 0;
    if (fabs((double)disc) < 1e-9 * (double)(b * b) || fabs((double)a) < 1e-9 * (double)dot(e, e))
        *close = true;
    if (disc < 0)
        return 0;
    for (int sign = -1; sign <= 1; sign += 2) {
        const quad at = (-b + sign * (a < 0 ? -root(disc) : root(disc))) / a, z = fz + at * ez;
        if (fabs((double)z) < 1e-9 || fabs((double)(z - s->length)) < 1e-9)
            *close = true;
        if (z >= 0 && z <= s->length)
            t[count++] = at;
    }
    return count;
}

/// Computes the outward normal at a point of the side, not normalised.
static void slope_at(const side *s, const quad p[3], quad n[3])
{
    quad f[3];
    for (int c = 0; c < 3; c++)
        f[c] = (p[c] - s->move[c]) / s->stretch[c] - s->from[c];
    const quad z = dot(f, s->along), r = s->radius + s->slope * z;
    for (int c = 0; c < 3; c++)
        n[c] = (f[c] - z * s->along[c] - s->slope * r * s->along[c]) / s->stretch[c];
}

static glint_scene *scene_of(glint_shape *shape, const double eye[3], const double at[3], const double light[3])
{
    glint_scene *scene;
    glint_camera *camera;
    glint_light *lamp;
    glint_camera_desc c = glint_camera_desc_default();
    glint_light_desc l = glint_light_desc_default(GLINT_LIGHT_POINT);
    memcpy(c.eye, eye, sizeof c.eye);
    memcpy(c.at, at, sizeof c.at);
    memcpy(l.position, light, sizeof l.position);
    assert_int_equal(glint_scene_create(&scene, NULL), GLINT_OK);
    assert_int_equal(glint_camera_create(&c, &camera, NULL), GLINT_OK);
    assert_int_equal(glint_light_create(&l, &lamp, NULL), GLINT_OK);
    assert_int_equal(glint_scene_set(scene, &(glint_scene_desc) { .struct_size = sizeof(glint_scene_desc), .camera = camera }, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_light(scene, lamp, NULL), GLINT_OK);
    assert_int_equal(glint_scene_add_shape(scene, shape, NULL), GLINT_OK);
    glint_camera_release(camera);
    glint_light_release(lamp);
    return scene;
}

/// Returns whether a picture of one pixel is lit.
static bool is_lit(const glint_scene *scene)
{
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    glint_renderer_desc r = { .struct_size = sizeof(glint_renderer_desc), .threads = 1 };
    glint_render_desc d = glint_render_desc_default();
    float p[3];
    d.width = d.height = 1;
    d.passes = 1u << GLINT_PASS_DIFFUSE;
    assert_int_equal(glint_renderer_create(&r, &renderer, NULL), GLINT_OK);
    assert_int_equal(glint_plan_create(scene, &d, &plan, NULL), GLINT_OK);
    assert_int_equal(glint_render(renderer, plan, &image, NULL, NULL), GLINT_OK);
    assert_int_equal(glint_image_pixel(image, GLINT_PASS_DIFFUSE, 0, 0, p, NULL), GLINT_OK);
    glint_image_release(image);
    glint_plan_destroy(plan);
    glint_renderer_destroy(renderer);
    return p[0] > 0;
}

typedef struct tally {
    int hits, misses, within, shadows, lights;
} tally;

/// Returns whether light reaches the visible side of the point. *close becomes true if rounding decides.
static bool reached(const side *s, const quad p[3], const quad n[3], const double eye[3], const double light[3],
                    bool *close)
{
    quad to_light[3], to_eye[3], t[2];
    for (int c = 0; c < 3; c++) {
        to_light[c] = light[c] - p[c];
        to_eye[c] = eye[c] - p[c];
    }
    const quad facing = dot(n, to_light) * (dot(n, to_eye) < 0 ? -1 : 1);
    const double lengths = sqrt((double)(dot(n, n) * dot(to_light, to_light)));
    *close = *close || fabs((double)facing) < 1e-6 * lengths;
    const int count = meet(s, p, to_light, t, close);
    bool open = facing > 0;
    for (int i = 0; i < count; i++) {
        if (fabs((double)t[i]) < 1e-12)
            continue; // the ray's starting point does not count as a hit
        *close = *close || fabs((double)t[i]) < 1e-6 || fabs((double)t[i] - 1) < 1e-6;
        open = open && !(t[i] > 0 && t[i] < 1);
    }
    return open;
}

static void one_case(uint64_t seed, tally *sum)
{
    side s;
    double eye[3], d[3], light[3];
    quad o[3], e[3], t[2], p[3], n[3], best = HUGE_VAL;
    glint_hit got;
    bool hit, close = false;
    state = seed * 1000003;
    glint_shape *shape = random_shape(&s);
    random_vector(eye, uniform(0, 1) < 0.3 ? 1 : 6);
    random_vector(light, uniform(0, 1) < 0.3 ? 1 : 6);
    for (int c = 0; c < 3; c++) {
        eye[c] += (double)s.move[c];
        light[c] += (double)s.move[c];
        d[c] = (double)(s.move[c] + s.from[c] + s.length * uniform(0, 1) * s.along[c]) + uniform(-1, 1) - eye[c];
        o[c] = eye[c];
        e[c] = d[c];
    }
    const int count = meet(&s, o, e, t, &close);
    for (int i = 0; i < count; i++)
        if (t[i] > 0 && t[i] < best)
            best = t[i];
    for (int c = 0; c < 3; c++)
        p[c] = o[c] + (best < HUGE_VAL ? best : 1) * e[c];
    const double at[3] = { (double)p[0], (double)p[1], (double)p[2] };
    glint_scene *scene = scene_of(shape, eye, at, light);
    assert_int_equal(glint_scene_cast(scene, eye, d, &hit, &got, NULL), GLINT_OK);
    if (!close && hit != (best < HUGE_VAL))
        fail_msg("case %d: %s, wanted t = %g", (int)seed, hit ? "a hit" : "no hit", (double)best);
    if (!close && hit) {
        slope_at(&s, p, n);
        if (fabs(got.t / (double)best - 1) > 1e-11)
            fail_msg("case %d: t = %.17g, wanted %.17g", (int)seed, got.t, (double)best);
        const double length = sqrt((double)dot(n, n));
        for (int c = 0; c < 3; c++)
            if (fabs(got.normal[c] - (double)n[c] / length) > 1e-8)
                fail_msg("case %d: normal %g, wanted %g", (int)seed, got.normal[c], (double)n[c] / length);
        const bool open = reached(&s, p, n, eye, light, &close);
        if (!close && is_lit(scene) != open)
            fail_msg("case %d: %s expected", (int)seed, open ? "light" : "shadow");
        sum->within += dot(n, e) > 0;
        sum->lights += open;
        sum->shadows += !open;
    }
    sum->hits += hit;
    sum->misses += !hit;
    glint_scene_release(scene);
    glint_shape_release(shape);
}

static void rays_and_shadows(void **unused)
{
    tally sum = { 0 };
    (void)unused;
    for (uint64_t seed = 1; seed <= 6000; seed++)
        one_case(seed, &sum);
    assert_true(sum.hits > 2000 && sum.misses > 500 && sum.within > 500 && sum.lights > 500 && sum.shadows > 500);
}

/// A ray reflected inside a mirror shape hits the other side of the same shape, and leaves through the open ends.
static void leaving_within(void **unused)
{
    (void)unused;
    for (int cone = 0; cone < 2; cone++) {
        glint_shape_desc d = glint_shape_desc_default(cone ? GLINT_SHAPE_CONE : GLINT_SHAPE_CYLINDER);
        glint_material_desc m = glint_material_desc_default();
        glint_material *material;
        glint_shape *shape;
        for (int c = 0; c < 3; c++) {
            m.mirror[c] = 0.5;
            m.diffuse[c] = 0;
        }
        m.has_mirror = true;
        assert_int_equal(glint_material_create(&m, &material, NULL), GLINT_OK);
        d.material = material;
        d.base[1] = cone ? 4 : 0; // the cone stands on its apex
        d.top[1] = cone ? 0 : 4;
        d.radius = cone ? 4 : 1;
        d.capped = false;
        assert_int_equal(glint_shape_create(&d, &shape, NULL), GLINT_OK);
        // In the tube the ray goes down at 45 degrees, hits x = 1 at y = 3.5 and x = -1 at y = 1.5, then leaves at
        // the bottom: 0.5 * 0.5. In the cone, which has a right angle at its apex, the ray is horizontal, is
        // reflected upwards and leaves through the base: 0.5.
        const double eye[3] = { 0, cone ? 2 : 4.5, 0 }, at[3] = { 1, cone ? 2 : 3.5, 0 };
        glint_scene *scene = scene_of(shape, eye, at, (double[3]) { 0, 50, 0 });
        glint_scene_desc s = *glint_scene_get(scene);
        s.struct_size = sizeof s;
        glint_render_desc r = glint_render_desc_default();
        glint_renderer_desc desc = { .struct_size = sizeof(glint_renderer_desc), .threads = 1 };
        glint_renderer *renderer;
        glint_plan *plan;
        glint_image *image;
        float p[3];
        for (int c = 0; c < 3; c++)
            s.background[c] = 1;
        assert_int_equal(glint_scene_set(scene, &s, NULL), GLINT_OK);
        r.width = r.height = 1;
        r.passes = 1u << GLINT_PASS_MIRROR;
        assert_int_equal(glint_renderer_create(&desc, &renderer, NULL), GLINT_OK);
        assert_int_equal(glint_plan_create(scene, &r, &plan, NULL), GLINT_OK);
        assert_int_equal(glint_render(renderer, plan, &image, NULL, NULL), GLINT_OK);
        assert_int_equal(glint_image_pixel(image, GLINT_PASS_MIRROR, 0, 0, p, NULL), GLINT_OK);
        assert_true(p[0] == (cone ? 0.5f : 0.25f));
        glint_image_release(image);
        glint_plan_destroy(plan);
        glint_renderer_destroy(renderer);
        glint_scene_release(scene);
        glint_shape_release(shape);
        glint_material_release(material);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_and_shadows),
        cmocka_unit_test(leaving_within),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
