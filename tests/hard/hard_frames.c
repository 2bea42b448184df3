/// Difficult pictures against the truth: spheres tangent to pixel rays, through the filters and the BVH that a frame
/// uses and a single ray does not; random still lifes with their shadows; and rays that leave a surface towards a
/// light, which must not hit the surface.
#include "tests/hard/oracle/aim.h"
#include "tests/hard/oracle/drive.h"
#include "tests/hard/oracle/judge.h"
#include "tests/hard/oracle/still.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double black[3] = { 0 }, white[3] = { 1, 1, 1 };

// ---- Tangent spheres ----

#define SIDE 32 ///< makes all rays exact, with a field of view of 90 degrees or integer sizes
#define CROWD 24

/// A camera along -z whose rays are (u, v, -1) from one point, or (0, 0, -1) from (u, v, 0), with u and v multiples
/// of 2^-5 of the scale.
typedef struct grid_view {
    double eye[3], scale;
    bool orthographic;
} grid_view;

static hard_ray ray_of_pixel(const grid_view *view, int x, int y)
{
    const double u = (2 * x + 1 - SIDE) / (double)SIDE, v = (SIDE - 2 * y - 1) / (double)SIDE;
    hard_ray ray = { { view->eye[0], view->eye[1], view->eye[2] }, { u, v, -1 } };
    if (view->orthographic) {
        ray.o[0] += u * view->scale;
        ray.o[1] += v * view->scale;
        ray.d[0] = ray.d[1] = 0;
    }
    return ray;
}

static grid_view random_view(void)
{
    grid_view view = { .scale = ldexp(1, -26 + (int)(random_bits() % 53)), .orthographic = chance(0.4) };
    const double reach = chance(0.5) ? 0 : view.scale * log_uniform(1, 1e6);
    for (int c = 0; c < 3; c++) // integer multiples, so that eye + u is exact
        view.eye[c] = view.scale * rint(uniform(-1, 1) * reach / view.scale);
    return view;
}

/// Returns a sphere that is almost tangent to a pixel's ray.
static hard_sphere tangent_sphere(const grid_view *view)
{
    const hard_ray ray = ray_of_pixel(view, (int)(random_bits() % SIDE), (int)(random_bits() % SIDE));
    const double away = view->scale * log_uniform(0.1, 1e5), size = hypot(hypot(ray.d[0], ray.d[1]), 1);
    hard_sphere sphere = { .r = away * log_uniform(1e-4, 0.5) };
    const double turn = uniform(0, 6.3), off = sphere.r * (1 + (chance(0.5) ? -1 : 1) * log_uniform(1e-15, 1e-2));
    // two directions perpendicular to the ray
    const double a[3] = { 1, 0, ray.d[0] }, n = hypot(1, ray.d[0]);
    const double b[3] = { a[1] * ray.d[2] - a[2] * ray.d[1], a[2] * ray.d[0] - a[0] * ray.d[2],
                          a[0] * ray.d[1] - a[1] * ray.d[0] };
    for (int c = 0; c < 3; c++)
        sphere.c[c] = ray.o[c] + ray.d[c] / size * away + off * (cos(turn) * a[c] / n + sin(turn) * b[c] / (n * size));
    return sphere;
}

/// Returns a sphere so large that the whole grid of rays starts just above its surface.
static hard_sphere near_ground(const grid_view *view)
{
    hard_sphere sphere = { .r = view->scale * log_uniform(1e3, 1e10) };
    for (int c = 0; c < 3; c++)
        sphere.c[c] = view->eye[c];
    sphere.c[2] -= sphere.r + view->scale * log_uniform(1e-4, 1);
    return sphere;
}

/// Returns whether the line misses the sphere by more than the error of double arithmetic.
static bool surely_missed(const hard_ray *ray, const hard_sphere *sphere)
{
    double f[3], dd = 0, ff = 0, xx = 0;
    for (int c = 0; c < 3; c++) {
        f[c] = ray->o[c] - sphere->c[c];
        dd += ray->d[c] * ray->d[c];
        ff += f[c] * f[c];
    }
    for (int c = 0; c < 3; c++) {
        const int i = (c + 1) % 3, k = (c + 2) % 3;
        const double x = f[i] * ray->d[k] - f[k] * ray->d[i];
        xx += x * x;
    }
    return xx > 1.01 * sphere->r * sphere->r * dd + 1e-12 * ff * dd;
}

/// Returns the nearest sphere, counted from 1; 0 for none; -1 if undecidable, because these rays are rounded once
/// more than others.
static int nearest_of(const hard_ray *ray, const hard_sphere *spheres, int count, double *t)
{
    int nearest = 0;
    double second = HUGE_VAL;
    *t = HUGE_VAL;
    for (int i = 0; i < count; i++) {
        if (surely_missed(ray, &spheres[i]))
            continue;
        const truth want = true_sphere(ray, &spheres[i]);
        if (want.tangency < 2 * TANGENCY || want.surface < 2 * TANGENCY)
            return -1;
        if (!want.hit)
            continue;
        if (want.t < *t) {
            second = *t;
            *t = want.t;
            nearest = i + 1;
        } else {
            second = fmin(second, want.t);
        }
    }
    return nearest && second - *t < 1e-9 * second ? -1 : nearest;
}

static glint_image *render_crowd(const grid_view *view, const hard_sphere *spheres, int count)
{
    glint_scene *scene = scene_new();
    glint_camera_desc camera = glint_camera_desc_default();
    memcpy(camera.eye, view->eye, sizeof camera.eye);
    camera.has_direction = true;
    camera.fov_y_rad = 0x1.921fb54442d18p+0;
    if (view->orthographic) {
        camera.projection = GLINT_PROJECTION_ORTHOGRAPHIC;
        camera.height = 2 * view->scale;
    }
    scene_camera(scene, &camera);
    for (int i = 0; i < count; i++)
        scene_sphere(scene, &spheres[i], NULL);
    const frame_desc desc = { SIDE, SIDE, GLINT_PRECISION_DOUBLE, 1u << GLINT_PASS_DEPTH | 1u << GLINT_PASS_OBJECT_ID, 1, NULL };
    glint_image *image = frame(scene, &desc, NULL);
    glint_scene_release(scene);
    return image;
}

typedef struct tally {
    uint64_t pixels, hits, close, wrong;
} tally;

static void report(const char *name, const tally *sum)
{
    if (hard_table)
        printf("| %s | %llu | %llu | %llu | %llu |\n", name, (unsigned long long)sum->pixels,
               (unsigned long long)sum->hits, (unsigned long long)sum->close, (unsigned long long)sum->wrong);
    hard_right(sum->pixels - sum->wrong);
    hard_check(sum->hits >= sum->pixels / 5, "%s: only %llu hits in %llu pixels", name, (unsigned long long)sum->hits,
               (unsigned long long)sum->pixels);
}

static void judge_crowd(const grid_view *view, const hard_sphere *spheres, int count, tally *sum)
{
    glint_image *image = render_crowd(view, spheres, count);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const hard_ray ray = ray_of_pixel(view, x, y);
            double t;
            float id[3], depth[3];
            const int want = nearest_of(&ray, spheres, count, &t);
            pixel(image, GLINT_PASS_OBJECT_ID, x, y, id);
            pixel(image, GLINT_PASS_DEPTH, x, y, depth);
            sum->pixels++;
            sum->close += want < 0;
            if (want < 0)
                continue;
            sum->hits += want > 0;
            const double away = t * hypot(hypot(ray.d[0], ray.d[1]), 1);
            const bool right = (int)id[0] == want && (want == 0 || fabs(depth[0] - away) <= 0x1p-22 * away);
            sum->wrong += !right;
            if (!right)
                hard_check(false,
                           "pixel %d, %d of %d spheres, eye %a %a %a, scale %a%s: object %g at %g, truth %d at %g", x,
                           y, count, view->eye[0], view->eye[1], view->eye[2], view->scale,
                           view->orthographic ? ", orthographic" : "", id[0], depth[0], want, away);
        }
    glint_image_release(image);
}

static void tangent_pixels(uint64_t pixels)
{
    hard_test("fuzz", "spheres tangent to pixels");
    tally sum = { 0 };
    while (sum.pixels < pixels) {
        const grid_view view = random_view();
        hard_sphere spheres[CROWD];
        const int count = 1 + (int)(random_bits() % CROWD);
        for (int i = 0; i < count; i++)
            spheres[i] = chance(0.05) ? near_ground(&view) : tangent_sphere(&view);
        judge_crowd(&view, spheres, count, &sum);
    }
    report("spheres tangent to pixels", &sum);
}

// ---- Still lifes ----

#define STILL_SIDE 20

static void judge_still(const hard_still *still, tally *sum)
{
    glint_scene *scene = still_scene(still);
    const frame_desc desc = { STILL_SIDE,
                              STILL_SIDE,
                              GLINT_PRECISION_DOUBLE,
                              1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_DIFFUSE | 1u << GLINT_PASS_OBJECT_ID,
                              1,
                              NULL };
    glint_image *image = frame(scene, &desc, NULL);
    glint_scene_release(scene);
    for (int y = 0; y < STILL_SIDE; y++)
        for (int x = 0; x < STILL_SIDE; x++) {
            const still_pixel want = still_trace_113(still, STILL_SIDE, STILL_SIDE, x, y);
            const still_pixel got = still_engine_pixel(image, x, y);
            double off = 0;
            for (int c = 0; c < 3; c++)
                off = fmax(off, fabs(got.color[c] - want.color[c]));
            // allows for the steepest change of a highlight: the exponent times the rounding error of the angle
            const bool right = got.object == want.object && got.lit == want.lit && off < 1e-4;
            sum->pixels++;
            sum->hits += want.object > 0;
            sum->wrong += !right;
            if (!right)
                hard_check(false, "still life %llu, pixel %d, %d: object %d, truth %d; lit %d, truth %d; off by %g",
                           (unsigned long long)(sum->pixels / (STILL_SIDE * STILL_SIDE)), x, y, got.object, want.object,
                           got.lit, want.lit, off);
        }
    glint_image_release(image);
}

static void random_stills(uint64_t pixels)
{
    hard_test("fuzz", "random still lifes");
    tally sum = { 0 };
    while (sum.pixels < pixels) {
        const double scale = log_uniform(1e-6, 1e6), away = chance(0.5) ? 0 : scale * log_uniform(1, 1e6);
        const hard_still still = still_random(scale, away);
        judge_still(&still, &sum);
    }
    report("random still lifes", &sum);
}

// ---- Rays that leave a surface ----

#define LEAVING_SIDE 256

typedef struct bare {
    hard_sphere sphere;
    hard_plane plane;
    bool is_plane, twice; ///< twice: whether there is a second, identical object
    double eye[3], at[3];
    glint_light_desc light;
} bare;

/// Makes a shape with the eye outside or inside, and with the light outside, near or far,
/// or inside together with the eye.
static bare random_bare(void)
{
    bare b = { .is_plane = chance(0.2), .twice = chance(0.3) };
    const double size = log_uniform(1e-8, 1e8), away = chance(0.4) ? 0 : size * log_uniform(1, 1e7);
    const bool within = !b.is_plane && chance(0.3);
    double u[3], v[3];
    random_direction(u);
    random_direction(v);
    double along = 0, far = within ? uniform(0.05, 0.99) : 1 + log_uniform(1e-3, 1e4);
    double lamp = within ? uniform(0, 0.99) : 1 + log_uniform(1e-9, 1e9);
    for (int c = 0; c < 3; c++)
        along += u[c] * v[c];
    for (int c = 0; c < 3; c++) {
        b.sphere.c[c] = b.plane.p[c] = uniform(-1, 1) * away;
        b.plane.n[c] = u[c];
        v[c] = b.is_plane && along < 0 ? -v[c] : v[c];
    }
    b.sphere.r = size;
    b.light = glint_light_desc_default(within || chance(0.7) ? GLINT_LIGHT_POINT : GLINT_LIGHT_DIRECTIONAL);
    for (int c = 0; c < 3; c++) {
        b.eye[c] = b.sphere.c[c] + u[c] * size * far;
        b.at[c] = b.sphere.c[c] + (within ? -size * u[c] : 0);
        b.light.position[c] = b.sphere.c[c] + v[c] * size * lamp;
        b.light.direction[c] = -v[c];
    }
    return b;
}

static glint_image *render_bare(const bare *b, bool shadows, glint_frame_stats *stats)
{
    glint_scene *scene = scene_new();
    glint_camera_desc camera = glint_camera_desc_default();
    memcpy(camera.eye, b->eye, sizeof camera.eye);
    memcpy(camera.at, b->at, sizeof camera.at);
    camera.fov_y_rad = 1;
    scene_camera(scene, &camera);
    glint_light_desc light = b->light;
    light.shadows = shadows;
    scene_light(scene, &light);
    glint_material *material = material_new(GLINT_MODEL_LAMBERT, white, 0, 1);
    for (int i = 0; i <= b->twice; i++) {
        if (b->is_plane)
            scene_plane(scene, &b->plane, material);
        else
            scene_sphere(scene, &b->sphere, material);
    }
    glint_material_release(material);
    scene_light_up(scene, 0, black);
    const frame_desc desc = { LEAVING_SIDE, LEAVING_SIDE, GLINT_PRECISION_DOUBLE, 1u << GLINT_PASS_DIFFUSE, 1, NULL };
    glint_image *image = frame(scene, &desc, stats);
    glint_scene_release(scene);
    return image;
}

/// A convex shape never occludes the light at those of its own points that face the light.
static void leaving_rays(uint64_t rays)
{
    hard_test("fuzz", "rays leaving for the light");
    tally sum = { 0 };
    while (sum.pixels < rays) {
        const bare b = random_bare();
        glint_frame_stats stats;
        glint_image *with = render_bare(&b, true, &stats), *without = render_bare(&b, false, NULL);
        const long differ = pixels_that_differ(with, without, GLINT_PASS_DIFFUSE);
        glint_image_release(with);
        glint_image_release(without);
        sum.pixels += stats.rays.shadow;
        sum.hits += stats.rays.shadow;
        sum.wrong += (uint64_t)differ;
        if (differ)
            hard_check(false, "%ld self-hits: %s { { %a, %a, %a }, %a, normal %a %a %a }, eye %a %a %a, light %a %a %a",
                       differ, b.is_plane ? "plane" : "sphere", b.sphere.c[0], b.sphere.c[1], b.sphere.c[2], b.sphere.r,
                       b.plane.n[0], b.plane.n[1], b.plane.n[2], b.eye[0], b.eye[1], b.eye[2], b.light.position[0],
                       b.light.position[1], b.light.position[2]);
    }
    report("rays leaving for the light", &sum);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    if (hard_table)
        printf("Pictures against the truth.\n\n| what | pixels | hits | too close to tell | wrong |\n"
               "| --- | --- | --- | --- | --- |\n");
    tangent_pixels(hard_rays / 5);
    random_stills(hard_rays / 25);
    leaving_rays(hard_rays);
    return hard_end();
}
