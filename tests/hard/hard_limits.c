/// Pictures at the limits of valid input: scenes scaled by powers of two, numbers near the largest, the largest
/// sizes, the most lights, the most spheres, and empty scenes;
/// for each instruction set and several numbers of threads.
#include "engine/glint_files.h"
#include "tests/engine/cases/sets.h"
#include "tests/engine/cases/step.h"
#include "tests/hard/oracle/drive.h"
#include "tests/hard/oracle/still.h"

#include <float.h>
#include <math.h>
#include <string.h>
#include <stdlib.h>

static const double none[3] = { 0 }, one[3] = { 1, 1, 1 };

#define COLOR_PASSES \
    (1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_AMBIENT | 1u << GLINT_PASS_DIFFUSE | 1u << GLINT_PASS_SPECULAR)

// ---- S36 ----

static void scale_vector(double v[3], int e)
{
    for (int c = 0; c < 3; c++)
        v[c] = ldexp(v[c], e);
}

static hard_still scaled(const hard_still *still, int e)
{
    hard_still s = *still;
    for (int i = 0; i < s.count; i++) {
        scale_vector(s.spheres[i].c, e);
        s.spheres[i].r = ldexp(s.spheres[i].r, e);
    }
    scale_vector(s.light, e);
    scale_vector(s.eye, e);
    scale_vector(s.at, e);
    return s;
}

/// Adds an attenuated light, and a plane through the first sphere.
static glint_scene *attenuated(const hard_still *still, double size, int e)
{
    glint_scene *scene = still_scene(still);
    glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_POINT);
    memcpy(light.position, still->eye, sizeof light.position);
    light.attenuation[1] = ldexp(0.1 / size, -e);
    light.attenuation[2] = ldexp(0.01 / (size * size), -2 * e);
    scene_light(scene, &light);
    hard_plane floor = { .n = { 0.25, 1, 0.125 } };
    memcpy(floor.p, still->spheres[0].c, sizeof floor.p);
    scene_plane(scene, &floor, NULL);
    return scene;
}

static void check_scales(int stills)
{
    hard_test("S36", "scale by powers of two");
    const glint_precision precisions[] = { GLINT_PRECISION_DOUBLE, GLINT_PRECISION_FLOAT };
    for (int i = 0; i < stills; i++) {
        const hard_still still = still_random(1, 100);
        for (int p = 0; p < 2; p++) {
            const frame_desc desc = { 40, 30,  precisions[p], 1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_OBJECT_ID,
                                      1,  NULL };
            glint_scene *scene = attenuated(&still, still.spheres[0].r, 0);
            glint_image *plain = frame(scene, &desc, NULL);
            glint_scene_release(scene);
            for (int e = -40; e <= 40; e += 8) {
                const hard_still other = scaled(&still, e);
                scene = attenuated(&other, still.spheres[0].r, e);
                glint_image *image = frame(scene, &desc, NULL);
                glint_scene_release(scene);
                const long differ = pixels_that_differ(plain, image, GLINT_PASS_BEAUTY) +
                                    pixels_that_differ(plain, image, GLINT_PASS_OBJECT_ID);
                hard_check(differ == 0, "still life %d, %s, scale 2^%d: %ld pixels differ", i, p ? "float" : "double",
                           e, differ);
                glint_image_release(image);
            }
            glint_image_release(plain);
        }
    }
}

// ---- N1 ----

static void check_machines(int stills)
{
    hard_test("N1", "instruction sets and threads");
    static const int threads[] = { 1, 2, 3, 7 };
    for (int i = 0; i < stills; i++) {
        const hard_still still = still_random(1, 100);
        glint_scene *scene = attenuated(&still, still.spheres[0].r, 0);
        for (int p = 0; p < 2; p++) {
            frame_desc desc = { 129, 67, p ? GLINT_PRECISION_FLOAT : GLINT_PRECISION_DOUBLE, COLOR_PASSES, 1, "ref" };
            glint_image *plain = frame(scene, &desc, NULL);
            for (size_t k = 0; k < INSTRUCTION_SETS; k++) {
                desc.isa = instruction_sets[k];
                desc.threads = threads[(k + (size_t)i) % 4];
                if (!isa_usable(desc.isa))
                    continue;
                glint_image *image = frame(scene, &desc, NULL);
                const long differ = pixels_that_differ(plain, image, GLINT_PASS_BEAUTY);
                hard_check(differ == 0, "still life %d, %s, %d threads: %ld pixels differ", i, desc.isa, desc.threads,
                           differ);
                glint_image_release(image);
            }
            glint_image_release(plain);
        }
        glint_scene_release(scene);
    }
}

// ---- Numbers near the largest double ----

static double huge(void) { return chance(0.3) ? 0 : chance(0.3) ? uniform(0, 1) : log_uniform(1e-300, 1e300); }

static void huge_vector(double v[3], double reach)
{
    for (int c = 0; c < 3; c++)
        v[c] = chance(0.3) ? 0 : (chance(0.5) ? -1 : 1) * log_uniform(1 / reach, reach);
}

static double largest(const double v[3]) { return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2]))); }

/// A valid scene with numbers from the smallest to the largest; some fields keep their defaults.
static glint_scene *extreme_scene(void)
{
    glint_error error;
    glint_scene *scene = scene_new();
    const double reach = chance(0.5) ? 1e2 : 1e150, background[3] = { huge(), huge(), huge() };
    glint_camera_desc camera = glint_camera_desc_default();
    huge_vector(camera.eye, reach);
    camera.fov_y_rad = uniform(0.001, 3.141);
    for (int i = 0; i < 3; i++) {
        glint_material_desc desc = glint_material_desc_default();
        glint_material *material;
        hard_sphere ball;
        hard_plane floor = { .n = { 0, 1, 0 } };
        for (int c = 0; c < 3; c++) {
            desc.diffuse[c] = huge();
            desc.specular[c] = huge();
        }
        desc.shininess = huge();
        desc.model = chance(0.5) ? GLINT_MODEL_PHONG : GLINT_MODEL_BLINN_PHONG;
        must(glint_material_create(&desc, &material, &error), &error);
        huge_vector(ball.c, reach);
        huge_vector(floor.p, reach);
        ball.r = log_uniform(fmax(1 / reach, 2e-150 * fmax(largest(ball.c), largest(camera.eye))), reach);
        scene_sphere(scene, &ball, material);
        if (chance(0.3))
            scene_plane(scene, &floor, material);
        glint_material_release(material);
        for (int c = 0; c < 3; c++)
            camera.at[c] = ball.c[c] + (ball.c[c] == camera.eye[c] ? 1 : 0);
        glint_light_desc light = glint_light_desc_default(chance(0.7) ? GLINT_LIGHT_POINT : GLINT_LIGHT_DIRECTIONAL);
        huge_vector(light.position, reach);
        huge_vector(light.direction, reach);
        light.direction[1] = light.direction[1] == 0 ? -1 : light.direction[1];
        light.intensity = huge();
        for (int c = 0; c < 3; c++) {
            light.attenuation[c] = huge();
            light.color[c] = huge();
        }
        light.attenuation[0] = light.attenuation[0] == 0 ? 1e-300 : light.attenuation[0];
        scene_light(scene, &light);
    }
    scene_light_up(scene, huge(), background);
    scene_camera(scene, &camera);
    return scene;
}

/// No plane has NaN or negative values, values above the largest float are counted,
/// and written files hold finite numbers.
static void check_finite(uint64_t scenes)
{
    hard_test("finite", "extreme numbers");
    static const glint_pass passes[] = { GLINT_PASS_BEAUTY, GLINT_PASS_AMBIENT, GLINT_PASS_DIFFUSE,
                                         GLINT_PASS_SPECULAR };
    for (uint64_t i = 0; i < scenes; i++) {
        glint_scene *scene = extreme_scene();
        const frame_desc desc = {
            9, 7, chance(0.8) ? GLINT_PRECISION_DOUBLE : GLINT_PRECISION_FLOAT, COLOR_PASSES | 1u << GLINT_PASS_NORMAL, 1, NULL
        };
        glint_frame_stats stats;
        glint_image *image = frame(scene, &desc, &stats);
        uint64_t infinite = 0;
        bool good = true;
        for (int y = 0; y < 7; y++)
            for (int x = 0; x < 9; x++) {
                float p[3];
                for (size_t k = 0; k < sizeof passes / sizeof *passes; k++) {
                    pixel(image, passes[k], x, y, p);
                    for (int c = 0; c < 3; c++)
                        good = good && p[c] >= 0; // the comparison is false for NaN
                }
                pixel(image, GLINT_PASS_BEAUTY, x, y, p);
                infinite += !isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]);
                pixel(image, GLINT_PASS_NORMAL, x, y, p);
                const float length = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
                good = good && (length == 0 || fabsf(length - 1) < (desc.precision == GLINT_PRECISION_FLOAT ? 1e-2f : 1e-6f));
            }
        hard_check(good, "extreme scene %llu: NaN, a negative colour or a normal that is not unit",
                   (unsigned long long)i);
        hard_check(infinite == stats.nonfinite, "extreme scene %llu: %llu pixels are not finite, %llu reported",
                   (unsigned long long)i, (unsigned long long)infinite, (unsigned long long)stats.nonfinite);
        glint_image_release(image);
        glint_scene_release(scene);
    }
}

/// Values above the largest float are written as the largest float.
static void check_written(void)
{
    hard_test("finite", "what is written");
    char path[64];
    const double far_too_bright[3] = { 1e39, 1e300, 0.5 };
    glint_error error;
    glint_scene *scene = scene_new();
    glint_camera_desc camera = glint_camera_desc_default();
    scene_camera(scene, &camera);
    scene_light_up(scene, 0, far_too_bright);
    const frame_desc desc = { 1, 1, GLINT_PRECISION_DOUBLE, COLOR_PASSES, 1, NULL };
    glint_image *image = frame(scene, &desc, NULL);
    temporary_file(path, ".pfm");
    glint_write_desc write = { .struct_size = sizeof(glint_write_desc), .path = path, .pass = GLINT_PASS_BEAUTY, .tone = glint_tone_desc_default() };
    must(glint_image_write(image, &write, &error), &error);
    FILE *file = fopen(path, "rb");
    float values[3] = { 0 };
    const bool read =
        file && fseek(file, -(long)sizeof values, SEEK_END) == 0 && fread(values, sizeof values, 1, file) == 1;
    hard_check(read && values[0] == FLT_MAX && values[1] == FLT_MAX && values[2] == 0.5f,
               "a .pfm of 1e39, 1e300, 0.5 holds %g, %g, %g", values[0], values[1], values[2]);
    if (file)
        fclose(file);
    remove(path);
    glint_image_release(image);
    glint_scene_release(scene);
}

// ---- The smallest and the most distant shapes ----

/// Makes a shape around the origin, 2 `size` wide and deep. A ray down the z axis hits it at z = size.
static glint_shape *small_shape(glint_shape_kind kind, bool mapped, double size)
{
    static const double x[3] = { 1, 0, 0 }, z[3] = { 0, 0, 1 };
    glint_error error;
    glint_shape *shape;
    glint_shape_desc desc = glint_shape_desc_default(kind);
    const double own = mapped ? 1 : size, by[3] = { size, size, size };
    desc.radius = own;
    desc.major = 2 * own;
    desc.minor = own;
    for (int c = 0; c < 3; c++) {
        const double *along = kind == GLINT_SHAPE_CYLINDER ? x : z; // rays hit a cylinder's side
        desc.center[c] = kind == GLINT_SHAPE_DISK    ? own * z[c]
                         : kind == GLINT_SHAPE_TORUS ? -2 * own * x[c] // puts its tube at the origin
                                                     : 0;
        desc.normal[c] = desc.axis[c] = z[c];
        desc.base[c] = -own * along[c];
        desc.top[c] = own * along[c];
    }
    snprintf(desc.name, sizeof desc.name, "mite");
    if (mapped)
        desc.transform = glint_transform_scale(by);
    must(glint_shape_create(&desc, &shape, &error), &error);
    return shape;
}

static bool says(const glint_error *error, const char *shape, const char *what)
{
    return strstr(error->message, shape) && strstr(error->message, what) && strstr(error->message, "expected");
}

static const char *const size_names[] = { [GLINT_SHAPE_SPHERE] = "sphere 'mite'",
                                          [GLINT_SHAPE_DISK] = "disk 'mite'",
                                          [GLINT_SHAPE_CYLINDER] = "cylinder 'mite'",
                                          [GLINT_SHAPE_CONE] = "cone 'mite'",
                                          [GLINT_SHAPE_TORUS] = "torus 'mite'" };

/// Checks that a one-pixel frame shows the scene's first object, or is refused with the reason. If `thin`, the ray
/// may miss the object.
static void check_frame_of(glint_scene *scene, const hard_ray *ray, bool thin, const char *name, const char *refused)
{
    const glint_render_desc desc = { .struct_size = sizeof(glint_render_desc), .width = 1, .height = 1, .samples = 1, .passes = 1u << GLINT_PASS_OBJECT_ID,
                                     .tone = glint_tone_desc_default() };
    glint_camera_desc camera = glint_camera_desc_default();
    glint_error error;
    glint_plan *plan = NULL;
    memcpy(camera.eye, ray->o, sizeof camera.eye);
    memset(camera.at, 0, sizeof camera.at);
    scene_camera(scene, &camera);
    const glint_status status = glint_plan_create(scene, &desc, &plan, &error);
    bool right = refused && status && says(&error, name, refused);
    if (!status && !refused) {
        const frame_desc one_pixel = { 1, 1, GLINT_PRECISION_DOUBLE, desc.passes, 1, NULL };
        glint_image *image = frame(scene, &one_pixel, NULL);
        float id[3];
        pixel(image, GLINT_PASS_OBJECT_ID, 0, 0, id);
        right = id[0] == 1 || thin;
        glint_image_release(image);
    }
    hard_check(right, "%s seen from %g: %s", name, ray->o[2], status ? error.message : "rendered");
    glint_plan_destroy(plan);
}

/// Casts and renders from `distance` above the origin. The shape must be hit at the right t and visible, or refused
/// in both cases with the reason.
static void check_size(glint_shape_kind kind, bool mapped, double size, double distance, const char *refused)
{
    const hard_ray ray = { { 0, 0, distance }, { 0, 0, -1 } };
    const char *const name = size_names[kind];
    glint_error error;
    glint_shape *shape = small_shape(kind, mapped, size);
    glint_scene *scene = scene_new();
    must(glint_scene_add_shape(scene, shape, &error), &error);
    bool hit = false;
    glint_hit got = { 0 };
    const glint_status status = glint_scene_cast(scene, ray.o, ray.d, &hit, &got, &error);
    // the side and the base of a cone are rounded separately: below this size a gap may open between them
    const bool thin = kind == GLINT_SHAPE_CONE && size < 0x1p-50 * distance;
    const bool right = hit ? fabs(got.t / (distance - size) - 1) <= 0x1p-51 : thin;
    const bool told = refused && status == GLINT_ERR_INVALID && says(&error, name, refused);
    hard_check(refused ? told : !status && right, "%s of %g at %g: %s, t %g", name, size, distance,
               status ? error.message
               : hit  ? "hit"
                      : "miss",
               got.t);
    check_frame_of(scene, &ray, thin, name, refused);
    glint_shape_release(shape);
    glint_scene_release(scene);
}

/// Shapes smaller than 1e-150, absolutely or relative to their distance, are refused with the reason. The rays hit
/// all other shapes.
static void check_small(void)
{
    hard_test("S25", "the smallest spheres and solids, the farthest");
    static const glint_shape_kind kinds[] = { GLINT_SHAPE_SPHERE, GLINT_SHAPE_DISK, GLINT_SHAPE_CYLINDER,
                                              GLINT_SHAPE_CONE, GLINT_SHAPE_TORUS };
    for (int k = 0; k < 10; k++) {
        const glint_shape_kind kind = kinds[k / 2];
        const bool mapped = k % 2, ball = kind == GLINT_SHAPE_SPHERE;
        const char *const width = ball ? "radius >= 1e-150" : "half widths 1e-150 .. 1e+150";
        const bool wide = kind == GLINT_SHAPE_DISK || (ball && !mapped);
        for (double size = 1e-140; size < 1e-9; size *= 1e10)
            check_size(kind, mapped, size, 5, NULL);
        check_size(kind, mapped, 6e-150, 5, NULL);
        check_size(kind, mapped, 1.1e-150, 5e-150, NULL);
        check_size(kind, mapped, 1, 0.9e150, NULL);
        check_size(kind, mapped, 0.4e150, 5e150, NULL);
        check_size(kind, mapped, 4e-150, 5, "too small for rays from");
        check_size(kind, mapped, 1, 1.1e150, "too small for rays from");
        check_size(kind, mapped, 1e-145, 1e10, "too small for rays from");
        for (double size = 1e-151; size > 1e-200; size /= 1e10)
            check_size(kind, mapped, size, 5, width);
        check_size(kind, mapped, 1.1e150, 5e150, ball || wide ? NULL : "half widths");
        check_size(kind, mapped, 1e160, 5e160, wide ? NULL : "half widths");
    }
}

// ---- Sizes and counts ----

static glint_scene *floor_scene(void)
{
    glint_scene *scene = scene_new();
    const hard_plane floor = { { 0, 0, 0 }, { 0, 0, 1 } };
    glint_camera_desc camera = glint_camera_desc_default();
    glint_material *white = material_new(GLINT_MODEL_LAMBERT, one, 0, 1);
    scene_plane(scene, &floor, white);
    glint_material_release(white);
    scene_camera(scene, &camera);
    return scene;
}

static void check_sides(void)
{
    hard_test("I4", "sides from 1 to 65535");
    glint_scene *scene = floor_scene();
    scene_light_up(scene, 0.5, none);
    const int sides[][2] = { { 65535, 1 }, { 1, 65535 }, { 1, 1 }, { 65535, 2 } };
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        const frame_desc desc = { sides[i][0], sides[i][1], GLINT_PRECISION_DOUBLE, 1u << GLINT_PASS_BEAUTY, 1, NULL };
        glint_image *image = frame(scene, &desc, NULL);
        long wrong = 0;
        for (int y = 0; y < sides[i][1]; y++)
            for (int x = 0; x < sides[i][0]; x++) {
                float p[3];
                pixel(image, GLINT_PASS_BEAUTY, x, y, p);
                wrong += p[0] != 0.5f && p[0] != 0;
            }
        float middle[3];
        pixel(image, GLINT_PASS_BEAUTY, sides[i][0] / 2, sides[i][1] / 2, middle);
        hard_check(wrong == 0 && middle[0] == 0.5f && glint_image_width(image) == sides[i][0] &&
                       glint_image_height(image) == sides[i][1],
                   "%d x %d: %ld pixels wrong, %g in the middle", sides[i][0], sides[i][1], wrong, middle[0]);
        glint_image_release(image);
    }
    // I4: the engine allocates nothing for refused sizes, and can count all pixels and samples of the largest size.
    const int64_t refused[][2] = { { 65536, 65536 }, { 65536, 1 }, { 1, 65536 }, { 1, 0 },
                                   { 0, 1 },         { -1, 5 },    { 5, -1 },    { 4294967297, 1 },
                                   { 1, 4294967297 }, { INT64_MAX, INT64_MAX }, { INT64_MIN, 2 } };
    glint_plan *plan;
    glint_error error;
    glint_render_desc desc = glint_render_desc_default();
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        desc.width = refused[i][0];
        desc.height = refused[i][1];
        hard_check(glint_plan_create(scene, &desc, &plan, &error) == GLINT_ERR_INVALID &&
                       (!strncmp(error.message, "width", 5) || !strncmp(error.message, "height", 6)),
                   "%lld x %lld is refused by name", (long long)refused[i][0], (long long)refused[i][1]);
    }
    desc.width = desc.height = 65535; // each side is allowed, the product of the sides is not
    hard_check(glint_plan_create(scene, &desc, &plan, &error) == GLINT_ERR_INVALID &&
                   strstr(error.message, "65535 x 65535"),
               "65535 x 65535 is refused by name");
    desc.height = 32767;
    desc.samples = 65536;
    must(glint_plan_create(scene, &desc, &plan, &error), &error);
    const uint64_t rays = glint_plan_expected_rays(plan).primary;
    hard_check(rays == UINT64_C(65535) * 32767 * 65536, "65535 x 32767 x 65536: %llu rays", (unsigned long long)rays);
    glint_plan_destroy(plan);
    glint_scene_release(scene);
}

/// L13: the sum of a million lights, and as many shadow-casting lights without occluders.
static void check_lights(int count)
{
    hard_test("L13", "a million lights");
    glint_scene *scene = floor_scene();
    glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_DIRECTIONAL);
    light.intensity = 1.0 / count;
    light.direction[0] = light.direction[1] = 0;
    light.direction[2] = -1;
    for (int i = 0; i < count; i++) {
        light.shadows = i % 2 == 0;
        scene_light(scene, &light);
    }
    const frame_desc desc = { 1, 1, GLINT_PRECISION_DOUBLE, COLOR_PASSES, 1, NULL };
    glint_image *image = frame(scene, &desc, NULL);
    float p[3];
    pixel(image, GLINT_PASS_BEAUTY, 0, 0, p);
    hard_check(fabsf(p[0] - 1) <= 0x1p-23f, "%d lights add up to %.9g", count, p[0]);
    glint_image_release(image);
    glint_scene_release(scene);
}

/// B1: concentric spheres; one giant among tiny spheres. The nearest is found in either order of definition.
static void check_crowd(int count)
{
    hard_test("B1", "many spheres in one place");
    double *rows = malloc((size_t)count * 4 * sizeof *rows);
    for (int kind = 0; kind < 4; kind++) {
        const bool concentric = kind < 2, reverse = kind & 1;
        for (int i = 0; i < count; i++) {
            double *row = rows + 4 * (reverse ? count - 1 - i : i);
            const double spread = concentric ? 0 : (double)i / count;
            row[0] = row[1] = spread;
            row[2] = -spread;
            row[3] = concentric ? 1 + i * 0x1p-40 : i == 0 ? 1e7 : 1e-7;
        }
        glint_error error;
        glint_shape *shape;
        glint_hit hit;
        const glint_spheres_desc desc = { .struct_size = sizeof(glint_spheres_desc), .data = rows, .count = (size_t)count, .two_sided = true };
        glint_scene *scene = scene_new();
        must(glint_spheres_create(&desc, &shape, &error), &error);
        must(glint_scene_add_shape(scene, shape, &error), &error);
        glint_shape_release(shape);
        const int last = count - 1, aimed = concentric ? last : count / 3;
        const double spread = concentric ? 0 : (double)aimed / count;
        const hard_ray ray = { { spread, spread, 5 }, { 0, 0, -1 } };
        const double r = concentric ? 1 + last * 0x1p-40 : 1e-7, t = 5 + spread - r;
        const bool found = cast(scene, &ray, &hit);
        hard_check(found && hit.element == (size_t)(reverse ? last - aimed : aimed) && fabs(hit.t - t) <= 1e-14,
                   "%d spheres, kind %d: number %zu at %.17g, truth %d at %.17g", count, kind, found ? hit.element : 0,
                   found ? hit.t : 0, reverse ? last - aimed : aimed, t);
        glint_scene_release(scene);
    }
    free(rows);
}

static void check_nothing(void)
{
    hard_test("B1", "no object");
    const double blue[3] = { 0.25, 0.5, 1 };
    glint_scene *scene = scene_new();
    glint_camera_desc camera = glint_camera_desc_default();
    glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_POINT);
    const hard_ray ray = { { 0 }, { 0, 0, 1 } };
    glint_hit hit;
    scene_camera(scene, &camera);
    scene_light_up(scene, 1, blue);
    scene_light(scene, &light);
    hard_check(!cast(scene, &ray, &hit), "nothing to hit");
    const frame_desc desc = { 33, 17, GLINT_PRECISION_DOUBLE, COLOR_PASSES | 1u << GLINT_PASS_DEPTH, 2, NULL };
    glint_image *image = frame(scene, &desc, NULL);
    long wrong = 0;
    for (int y = 0; y < 17; y++)
        for (int x = 0; x < 33; x++) {
            float p[3], depth[3];
            pixel(image, GLINT_PASS_BEAUTY, x, y, p);
            pixel(image, GLINT_PASS_DEPTH, x, y, depth);
            wrong += p[0] != 0.25f || p[1] != 0.5f || p[2] != 1 || depth[0] != HUGE_VALF;
        }
    hard_check(wrong == 0, "%ld pixels of nothing are not the background", wrong);
    glint_image_release(image);
    glint_scene_release(scene);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    hard_list_tests("At the edge of what may be asked for.");
    const bool soak = hard_rays > 10000000;
    check_scales(soak ? 200 : 10);
    check_machines(soak ? 100 : 6);
    check_finite(hard_rays / 500);
    check_written();
    check_small();
    check_sides();
    check_lights(1000000 / (int)case_step());
    check_crowd(soak ? 1000000 : 100000 / (int)case_step());
    check_nothing();
    return hard_end();
}
