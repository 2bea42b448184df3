/// The workshop, by the renderer alone: this program is linked with engine/render, film and base, and with C's library,
/// libm and threads. It writes the light of the picture as a .pfm.
///
///     alone WIDTH HEIGHT > workshop.pfm
#include "engine/glint.h"
#include "engine/glint_math.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static glint_error error;

static void need(glint_status status)
{
    if (status == GLINT_OK)
        return;
    fprintf(stderr, "alone: %s\n", error.message);
    exit(1);
}

static void add_ball(glint_scene *scene, double x, double y, double z, double radius, const double color[3], double gloss)
{
    glint_material_desc paint = glint_material_desc_default();
    glint_shape_desc ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    glint_shape *shape;
    for (int c = 0; c < 3; c++) {
        paint.ambient[c] = paint.diffuse[c] = color[c];
        paint.specular[c] = gloss;
    }
    paint.shininess = 128;
    need(glint_material_create(&paint, &ball.material, &error));
    memcpy(ball.center, (double[]) { x, y, z }, sizeof ball.center);
    ball.radius = radius;
    need(glint_shape_create(&ball, &shape, &error));
    need(glint_scene_add_shape(scene, shape, &error));
    glint_shape_release(shape);
    glint_material_release(ball.material);
}

static void add_lamp(glint_scene *scene)
{
    glint_light_desc lamp = glint_light_desc_default(GLINT_LIGHT_SPHERE);
    glint_light *light;
    lamp.position[1] = 20;
    lamp.radius = 0;
    need(glint_light_create(&lamp, &light, &error));
    need(glint_scene_add_light(scene, light, &error));
    glint_light_release(light);
}

static void add_camera(glint_scene *scene)
{
    glint_camera_desc view = glint_camera_desc_default();
    glint_scene_desc desc = glint_scene_desc_default();
    memcpy(view.eye, (double[]) { 0, 6.2, 20.5 }, sizeof view.eye);
    memcpy(view.at, (double[]) { 0, 3.8, 0 }, sizeof view.at);
    view.fov_y_rad = 42 * (3.14159265358979323846 / 180);
    memcpy(desc.ambient, (double[]) { 0.16, 0.17, 0.20 }, sizeof desc.ambient);
    memcpy(desc.background, (double[]) { glint_srgb_decode(0x8f / 255.0), glint_srgb_decode(0xb3 / 255.0), glint_srgb_decode(0xd9 / 255.0) }, sizeof desc.background);
    need(glint_camera_create(&view, &desc.camera, &error));
    need(glint_scene_set(scene, &desc, &error));
    glint_camera_release(desc.camera);
}

static glint_image *render(const glint_scene *scene, int width, int height)
{
    const glint_renderer_desc workers = glint_renderer_desc_default();
    glint_render_desc desc = glint_render_desc_default();
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    desc.width = width;
    desc.height = height;
    desc.samples = 4;
    need(glint_plan_create(scene, &desc, &plan, &error));
    need(glint_renderer_create(&workers, &renderer, &error));
    need(glint_render(renderer, plan, &image, NULL, &error));
    glint_renderer_destroy(renderer);
    glint_plan_destroy(plan);
    return image;
}

int main(int argc, char **argv)
{
    glint_scene *scene;
    if (argc != 3)
        return 2;
    const int width = atoi(argv[1]), height = atoi(argv[2]);
    need(glint_scene_create(&scene, &error));
    add_lamp(scene);
    add_ball(scene, 0, -10000, 0, 10000, (double[]) { 0.42, 0.40, 0.37 }, 0);
    add_ball(scene, -1.0, 4.0, -4.5, 4.0, (double[]) { 0.70, 0.10, 0.08 }, 0.7);
    add_ball(scene, 5.8, 3.0, -1.0, 3.0, (double[]) { 0.85, 0.55, 0.10 }, 0.7);
    add_ball(scene, -6.6, 2.5, 0.5, 2.5, (double[]) { 0.10, 0.35, 0.62 }, 0.7);
    add_ball(scene, 0.6, 2.0, 4.2, 2.0, (double[]) { 0.16, 0.48, 0.20 }, 0.7);
    add_camera(scene);
    glint_image *image = render(scene, width, height);
    float *light = malloc(3 * sizeof *light * (size_t)width * (size_t)height);
    if (!light)
        return 1;
    need(glint_image_floats(image, GLINT_PASS_BEAUTY, light, &error));
    printf("PF\n%d %d\n-1.0\n", width, height);
    for (int y = height - 1; y >= 0; y--)
        fwrite(light + 3 * (size_t)y * (size_t)width, 3 * sizeof *light, (size_t)width, stdout);
    free(light);
    glint_image_release(image);
    glint_scene_release(scene);
    return fflush(stdout) ? 1 : 0;
}
