/// A picture from C, using only the public headers: a ball on the ground under one lamp.
///
///     cc c_example.c $(pkg-config --cflags --libs glint) -o c_example && ./c_example
///
/// The order is always the same: describe, plan, render, write. Every call that can fail returns a status and writes a
/// message that names the argument at fault; here the first failure ends the program.
#include <stdio.h>
#include <stdlib.h>

#include <glint.h>
#include <glint_files.h>
#include <glint_inspect.h>

static glint_error error;

static void need(glint_status status)
{
    if (status == GLINT_OK)
        return;
    fprintf(stderr, "c_example: %s\n", error.message);
    exit(1);
}

// Adds a shape with a material of the given colour. The scene retains what it needs of both.
static void add(glint_scene *scene, glint_shape_desc *shape_desc, double red, double green, double blue,
                double specular)
{
    glint_material_desc paint = glint_material_desc_default();
    glint_material *material;
    glint_shape *shape;
    paint.diffuse[0] = red, paint.diffuse[1] = green, paint.diffuse[2] = blue;
    paint.specular[0] = paint.specular[1] = paint.specular[2] = specular;
    paint.shininess = 64;
    need(glint_material_create(&paint, &material, &error));
    shape_desc->material = material;
    need(glint_shape_create(shape_desc, &shape, &error));
    need(glint_scene_add_shape(scene, shape, &error));
    glint_shape_release(shape);
    glint_material_release(material);
}

static void add_lamp(glint_scene *scene)
{
    glint_light_desc lamp = glint_light_desc_default(GLINT_LIGHT_POINT);
    glint_light *light;
    lamp.position[0] = 4, lamp.position[1] = 8, lamp.position[2] = 6;
    need(glint_light_create(&lamp, &light, &error));
    need(glint_scene_add_light(scene, light, &error));
    glint_light_release(light);
}

static glint_scene *make_scene(void)
{
    glint_scene *scene;
    glint_camera *camera;
    glint_camera_desc view = glint_camera_desc_default();
    view.eye[1] = 3, view.eye[2] = 8;
    view.at[1] = 1;
    need(glint_camera_create(&view, &camera, &error));
    need(glint_scene_create(&scene, &error));
    glint_scene_desc around = glint_scene_desc_default();
    around.camera = camera;
    around.ambient[0] = around.ambient[1] = around.ambient[2] = 0.125;
    need(glint_scene_set(scene, &around, &error));
    glint_camera_release(camera);

    glint_shape_desc ground = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    ground.normal[0] = 0, ground.normal[1] = 1, ground.normal[2] = 0;
    add(scene, &ground, 0.5, 0.5, 0.5, 0);
    glint_shape_desc ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    ball.center[1] = 1;
    ball.radius = 1;
    add(scene, &ball, 0.75, 0.25, 0.125, 0.5);
    add_lamp(scene);
    return scene;
}

int main(void)
{
    glint_scene *scene = make_scene();
    glint_render_desc what = glint_render_desc_default();
    glint_renderer_desc with = glint_renderer_desc_default();
    glint_write_desc file = { .struct_size = sizeof(glint_write_desc), .path = "c_example.png", .pass = GLINT_PASS_BEAUTY, .tone = glint_tone_desc_default() };
    glint_plan *plan;
    glint_renderer *renderer;
    glint_image *image;
    glint_frame_stats stats;
    what.width = 640;
    what.height = 360;
    what.samples = 4;
    what.codes = true;
    what.tone = file.tone;
    need(glint_plan_create(scene, &what, &plan, &error));
    need(glint_renderer_create(&with, &renderer, &error));
    need(glint_render(renderer, plan, &image, &stats, &error));
    need(glint_image_write(image, &file, &error));
    printf("c_example.png: %.1f ms, %s\n", stats.render_ms, glint_renderer_isa(renderer));
    glint_image_release(image);
    glint_renderer_destroy(renderer);
    glint_plan_destroy(plan);
    glint_scene_release(scene);
    return 0;
}
