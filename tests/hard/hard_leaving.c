/// Rays that leave a surface: a convex shape never shadows itself or reflects itself, and a ray that has entered
/// leaves only through the far side.
#include "tests/hard/oracle/aim_solid.h"
#include "tests/hard/oracle/point.h"

#include <string.h>

#define SIDE 128

static const double black[3] = { 0 }, white[3] = { 1, 1, 1 };

typedef struct tally {
    uint64_t rays, wrong;
} tally;

static void note(const char *name, const tally *sum)
{
    if (hard_table)
        printf("| %s | %llu | %llu |\n", name, (unsigned long long)sum->rays, (unsigned long long)sum->wrong);
    hard_right(sum->rays - sum->wrong);
}

/// Sets a camera that looks along `ray` and sees the shape, from close to its surface or far away.
static void look_along(glint_scene *scene, const hard_ray *ray)
{
    glint_camera_desc camera = glint_camera_desc_default();
    memcpy(camera.eye, ray->o, sizeof camera.eye);
    memcpy(camera.direction, ray->d, sizeof camera.direction);
    camera.has_direction = true;
    camera.fov_y_rad = chance(0.5) ? 1 : log_uniform(1e-6, 2);
    scene_camera(scene, &camera);
}

/// Returns whether the ray hit the shape from outside.
static bool from_outside(const hard_ray *ray, const glint_hit *hit)
{
    double front = 0;
    for (int c = 0; c < 3; c++)
        front -= hit->normal[c] * ray->d[c];
    return front > 0;
}

static glint_light_desc random_light(const hard_ray *ray, const glint_hit *hit)
{
    static const glint_light_kind kinds[] = { GLINT_LIGHT_POINT, GLINT_LIGHT_POINT, GLINT_LIGHT_DIRECTIONAL,
                                              GLINT_LIGHT_SPHERE, GLINT_LIGHT_DISK };
    glint_light_desc light = glint_light_desc_default(kinds[random_bits() % 5]);
    double away = 0, side[3];
    random_direction(side);
    for (int c = 0; c < 3; c++)
        away = fmax(away, fabs(ray->o[c] - hit->point[c]));
    if (light.kind == GLINT_LIGHT_SPHERE || light.kind == GLINT_LIGHT_DISK) {
        light.radius = away * log_uniform(1e-9, 10); // the light may touch or overlap the shape
        light.samples = 4;
        light.has_radiance = chance(0.5);
        light.radiance = 1;
    }
    for (int c = 0; c < 3; c++) { // the light is in front of the point, sometimes by very little
        light.position[c] = hit->point[c] + away * log_uniform(1e-9, 1e3) * (hit->normal[c] + side[c]);
        light.direction[c] = -(hit->normal[c] + side[c]);
    }
    return light;
}

static glint_image *lit(glint_scene *scene, const glint_light_desc *light, bool shadows, glint_frame_stats *stats)
{
    glint_error error;
    glint_light_desc desc = *light;
    glint_light *lamp;
    const frame_desc size = { SIDE, SIDE, GLINT_PRECISION_DOUBLE, 1u << GLINT_PASS_DIFFUSE, 1, NULL };
    desc.shadows = shadows;
    must(glint_light_create(&desc, &lamp, &error), &error);
    must(glint_scene_add_light(scene, lamp, &error), &error);
    glint_image *image = frame(scene, &size, stats);
    must(glint_scene_remove_light(scene, lamp, &error), &error);
    glint_light_release(lamp);
    return image;
}

/// Checks that the picture is identical with and without shadows.
static void shadows(int kind, uint64_t rays)
{
    tally sum = { 0 };
    char name[80];
    snprintf(name, sizeof name, "%s: to the light", solid_names[kind]);
    hard_test("fuzz", name);
    glint_material *matt = material_new(GLINT_MODEL_LAMBERT, white, 0, 1);
    while (sum.rays < rays) {
        double size;
        glint_hit hit;
        glint_frame_stats stats;
        const hard_solid s = solid_random(kind, &size);
        const hard_ray ray = solid_aim(&s, size);
        glint_scene *scene = solid_alone(&s, matt);
        if (cast(scene, &ray, &hit) && (from_outside(&ray, &hit) || kind == SOLID_DISK || kind == SOLID_KINDS - 1)) {
            look_along(scene, &ray);
            scene_light_up(scene, 0, black);
            const glint_light_desc light = random_light(&ray, &hit);
            glint_image *with = lit(scene, &light, true, &stats), *without = lit(scene, &light, false, NULL);
            const long differ = pixels_that_differ(with, without, GLINT_PASS_DIFFUSE);
            sum.rays += stats.rays.shadow;
            sum.wrong += (uint64_t)differ;
            if (differ)
                hard_check(false, "%ld self-hits of %llu: %s, light %d at %a %a %a, eye %a %a %a", differ,
                           (unsigned long long)stats.rays.shadow, solid_names[kind], light.kind, light.position[0],
                           light.position[1], light.position[2], ray.o[0], ray.o[1], ray.o[2]);
            glint_image_release(with);
            glint_image_release(without);
        }
        glint_scene_release(scene);
    }
    glint_material_release(matt);
    note(name, &sum);
}

/// In a white world a mirror shows 1, and glass at depth 1 transmits nothing yet.
static void sent_on(int kind, bool glass, uint64_t rays)
{
    tally sum = { 0 };
    char name[80];
    const glint_pass pass = glass ? GLINT_PASS_TRANSMISSION : GLINT_PASS_MIRROR;
    snprintf(name, sizeof name, glass ? "%s: into glass" : "%s: mirrored", solid_names[kind]);
    hard_test("fuzz", name);
    glint_material *material = point_glass(0, !glass, glass, chance(0.5) ? 1.5 : 1, false);
    while (sum.rays < rays) {
        double size;
        glint_hit hit;
        glint_frame_stats stats;
        const hard_solid s = solid_random(kind, &size);
        const hard_ray ray = solid_aim(&s, size);
        glint_scene *scene = solid_alone(&s, material);
        if (cast(scene, &ray, &hit) && from_outside(&ray, &hit)) {
            const frame_desc desc = { SIDE, SIDE, GLINT_PRECISION_DOUBLE, 1u << pass | 1u << GLINT_PASS_OBJECT_ID, 1, NULL };
            look_along(scene, &ray);
            scene_light_up(scene, 0, white);
            glint_image *image = frame_to_depth(scene, &desc, 1, &stats);
            long differ = 0;
            for (int i = 0; i < SIDE * SIDE; i++) {
                float p[3], id[3];
                pixel(image, pass, i % SIDE, i / SIDE, p);
                pixel(image, GLINT_PASS_OBJECT_ID, i % SIDE, i / SIDE, id);
                differ += p[0] != (id[0] == 1 && !glass ? 1.0f : 0.0f);
            }
            sum.rays += stats.rays.mirror + stats.rays.refraction;
            sum.wrong += (uint64_t)differ;
            if (differ)
                hard_check(false, "%ld of %llu rays: %s, eye %a %a %a, at %a %a %a", differ,
                           (unsigned long long)(stats.rays.mirror + stats.rays.refraction), solid_names[kind], ray.o[0],
                           ray.o[1], ray.o[2], hit.point[0], hit.point[1], hit.point[2]);
            glint_image_release(image);
        }
        glint_scene_release(scene);
    }
    glint_material_release(material);
    note(name, &sum);
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    if (hard_table)
        printf("Rays that leave a convex surface.\n\n| rays | how many | wrong |\n| --- | --- | --- |\n");
    for (int kind = 0; kind < SOLID_KINDS; kind++)
        if (kind != SOLID_TORUS)
            shadows(kind, hard_rays / 20);
    for (int kind = 0; kind < SOLID_KINDS; kind++) {
        if (kind == SOLID_TORUS)
            continue;
        sent_on(kind, false, hard_rays / 20);
        if (kind != SOLID_DISK && kind != SOLID_KINDS - 1) // a disk and a triangle have no inside
            sent_on(kind, true, hard_rays / 20);
    }
    return hard_end();
}
