#include "tests/hard/oracle/point.h"

#include <math.h>
#include <string.h>

static const double black[3] = { 0 }, white[3] = { 1, 1, 1 };

static void unit(double v[3])
{
    const double length = hypot(hypot(v[0], v[1]), v[2]);
    for (int c = 0; c < 3; c++)
        v[c] /= length;
}

glint_reflection point_reflection(glint_material *material, const double n[3], const double l[3], const double v[3],
                                  glint_precision precision)
{
    hard_plane plane = { { 0 }, { n[0], n[1], n[2] } };
    hard_ray ray = { { v[0], v[1], v[2] }, { 0 } };
    glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_DIRECTIONAL);
    glint_reflection out;
    float diffuse[3], specular[3];
    unit(ray.o);
    for (int c = 0; c < 3; c++) {
        ray.d[c] = -ray.o[c];
        light.direction[c] = -l[c];
    }
    light.shadows = false;
    glint_scene *scene = scene_new();
    scene_plane(scene, &plane, material);
    scene_light(scene, &light);
    glint_image *image = frame_of_ray(scene, &ray, precision, 1u << GLINT_PASS_DIFFUSE | 1u << GLINT_PASS_SPECULAR);
    glint_scene_release(scene);
    pixel(image, GLINT_PASS_DIFFUSE, 0, 0, diffuse);
    pixel(image, GLINT_PASS_SPECULAR, 0, 0, specular);
    glint_image_release(image);
    for (int c = 0; c < 3; c++) {
        out.diffuse[c] = diffuse[c];
        out.specular[c] = specular[c];
    }
    return out;
}

double point_lit(const glint_light_desc *light, const hard_sphere *more, double x, double width, double want,
                 glint_precision precision, double *off, glint_frame_stats *stats)
{
    const hard_plane floor = { { 0 }, { 0, 1, 0 } };
    glint_scene *scene = scene_new();
    glint_material *matt = material_new(GLINT_MODEL_LAMBERT, white, 0, 1);
    glint_camera_desc camera = glint_camera_desc_default();
    const double away = fmax(light->position[1], light->radius);
    memcpy(camera.eye, (double[3]) { x + away, 0.4 * away, 0 }, sizeof camera.eye);
    camera.at[0] = x;
    camera.projection = GLINT_PROJECTION_ORTHOGRAPHIC;
    camera.height = width;
    scene_camera(scene, &camera);
    scene_plane(scene, &floor, matt);
    glint_material_release(matt);
    if (more)
        scene_sphere(scene, more, NULL);
    scene_light(scene, light);
    scene_light_up(scene, 0, black);
    const frame_desc desc = { 4, 4, precision, 1u << GLINT_PASS_DIFFUSE, 1, NULL };
    glint_image *image = frame(scene, &desc, stats);
    glint_scene_release(scene);
    double sum = 0, square = 0;
    for (int i = 0; i < 16; i++) {
        float p[3];
        pixel(image, GLINT_PASS_DIFFUSE, i % 4, i / 4, p);
        sum += p[0];
        square += (p[0] - want) * (p[0] - want);
    }
    glint_image_release(image);
    if (off)
        *off = sqrt(square / 16);
    return sum / 16;
}

double point_seen(glint_scene *scene, const hard_ray *ray, glint_precision precision, double max_depth, glint_pass pass)
{
    glint_camera_desc camera = glint_camera_desc_default();
    float p[3];
    camera.has_direction = true;
    memcpy(camera.eye, ray->o, sizeof camera.eye);
    memcpy(camera.direction, ray->d, sizeof camera.direction);
    scene_camera(scene, &camera);
    const frame_desc desc = { 1, 1, precision, 1u << pass, 1, NULL };
    glint_image *image = frame_to_depth(scene, &desc, max_depth, NULL);
    pixel(image, pass, 0, 0, p);
    glint_image_release(image);
    return p[0];
}

glint_material *point_glass(double ambient, double mirror, double transmission, double ior, bool fresnel)
{
    glint_material *material;
    glint_error error;
    glint_material_desc desc = glint_material_desc_default();
    desc.has_ambient = desc.has_mirror = true;
    for (int c = 0; c < 3; c++) {
        desc.diffuse[c] = 0;
        desc.ambient[c] = ambient;
        desc.mirror[c] = mirror;
        desc.transmission[c] = transmission;
    }
    desc.ior = ior;
    desc.fresnel = fresnel;
    must(glint_material_create(&desc, &material, &error), &error);
    return material;
}
