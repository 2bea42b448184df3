/// Patterns from C, using only the public headers: a ball of marble on a chessboard.
///
///     cc c_pattern.c $(pkg-config --cflags --libs glint) -o c_pattern && ./c_pattern
///
/// A pattern is a program: a list of operations that describes a material at a point. It is built once, value by value,
/// and runs for every sample that shows the material. The rest is explained in c_example.c.
#include <stdio.h>
#include <stdlib.h>

#include <glint.h>
#include <glint_files.h>
#include <glint_inspect.h>
#include <glint_programs.h>

static glint_error error;
static glint_builder *pattern; ///< the pattern under construction

static void need(glint_status status)
{
    if (status == GLINT_OK)
        return;
    fprintf(stderr, "c_pattern: %s\n", error.message);
    exit(1);
}

static glint_value number(double x)
{
    glint_value out;
    need(glint_builder_number(pattern, x, &out, &error));
    return out;
}

static glint_value read(glint_input input)
{
    glint_value out;
    need(glint_builder_input(pattern, input, &out, &error));
    return out;
}

// Adds an operation with one result and up to three operands. Unused operands are ignored.
static glint_value op(glint_op which, glint_value a, glint_value b, glint_value c)
{
    const glint_value operands[] = { a, b, c };
    glint_value out;
    need(glint_builder_op(pattern, which, operands, &out, &error));
    return out;
}

static glint_value times(glint_value a, double b) { return op(GLINT_OP_MUL, a, number(b), 0); }

static glint_program *finish(const glint_value *outputs, size_t count)
{
    glint_program *program;
    need(glint_builder_finish(pattern, outputs, count, &program, &error));
    glint_builder_destroy(pattern);
    char *listing = glint_program_listing(program);
    if (listing)
        printf("%s\n", listing);
    free(listing);
    return program;
}

// Returns 0.05 or 0.9 by the parity of floor(x) + floor(y) + floor(z); on a plane across the y axis, y is exact.
static glint_program *chessboard(void)
{
    need(glint_builder_create(GLINT_PROGRAM_PATTERN, &pattern, &error));
    const glint_value odd = op(GLINT_OP_PARITY, read(GLINT_INPUT_P_X), read(GLINT_INPUT_P_Y), read(GLINT_INPUT_P_Z));
    const glint_value gray = op(GLINT_OP_SELECT, odd, number(0.05), number(0.9));
    return finish(&gray, 1);
}

// Mixes two colours by a sine of x, which noise of two sizes distorts.
static glint_program *marble(void)
{
    static const double light[3] = { 0.92, 0.9, 0.86 }, dark[3] = { 0.16, 0.2, 0.3 };
    need(glint_builder_create(GLINT_PROGRAM_PATTERN, &pattern, &error));
    const glint_value x = read(GLINT_INPUT_P_X), y = read(GLINT_INPUT_P_Y), z = read(GLINT_INPUT_P_Z);
    glint_value phase = times(x, 7), colour[3];
    for (double size = 2, strength = 5; size < 10; size *= 3, strength /= 3) {
        const glint_value noise = op(GLINT_OP_NOISE, times(x, size), times(y, size), times(z, size));
        phase = op(GLINT_OP_ADD, phase, times(noise, strength), 0);
    }
    const glint_value wave = op(GLINT_OP_SIN, phase, 0, 0);
    const glint_value share = op(GLINT_OP_MULADD, wave, number(0.5), number(0.5));
    for (int c = 0; c < 3; c++)
        colour[c] = op(GLINT_OP_MIX, number(light[c]), number(dark[c]), op(GLINT_OP_MUL, share, share, 0));
    return finish(colour, 3);
}

// Adds a shape with the program as its diffuse reflectance. The material retains the program.
static void add(glint_scene *scene, glint_shape_desc *shape_desc, glint_program *diffuse, double specular)
{
    glint_material_desc paint = glint_material_desc_default();
    glint_material *material;
    glint_shape *shape;
    paint.program.diffuse = diffuse;
    paint.specular[0] = paint.specular[1] = paint.specular[2] = specular;
    paint.shininess = 64;
    need(glint_material_create(&paint, &material, &error));
    shape_desc->material = material;
    need(glint_shape_create(shape_desc, &shape, &error));
    need(glint_scene_add_shape(scene, shape, &error));
    glint_shape_release(shape);
    glint_material_release(material);
    glint_program_release(diffuse);
}

static glint_scene *make_scene(void)
{
    glint_scene *scene;
    glint_camera *camera;
    glint_light *light;
    glint_camera_desc view = glint_camera_desc_default();
    view.eye[1] = 3, view.eye[2] = 8;
    view.at[1] = 1;
    view.fov_y_rad = 0.5;
    need(glint_camera_create(&view, &camera, &error));
    need(glint_scene_create(&scene, &error));
    glint_scene_desc around = glint_scene_desc_default();
    around.camera = camera;
    around.ambient[0] = around.ambient[1] = around.ambient[2] = 0.125;
    need(glint_scene_set(scene, &around, &error));
    glint_camera_release(camera);

    glint_shape_desc ground = glint_shape_desc_default(GLINT_SHAPE_PLANE);
    ground.normal[0] = 0, ground.normal[1] = 1, ground.normal[2] = 0;
    add(scene, &ground, chessboard(), 0);
    glint_shape_desc ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    ball.center[1] = 1;
    ball.radius = 1;
    add(scene, &ball, marble(), 0.5);
    glint_light_desc lamp = glint_light_desc_default(GLINT_LIGHT_POINT);
    lamp.position[0] = 4, lamp.position[1] = 8, lamp.position[2] = 6;
    need(glint_light_create(&lamp, &light, &error));
    need(glint_scene_add_light(scene, light, &error));
    glint_light_release(light);
    return scene;
}

int main(void)
{
    glint_scene *scene = make_scene();
    glint_render_desc what = glint_render_desc_default();
    glint_renderer_desc with = glint_renderer_desc_default();
    glint_write_desc file = { .struct_size = sizeof(glint_write_desc), .path = "c_pattern.png", .pass = GLINT_PASS_BEAUTY, .tone = glint_tone_desc_default() };
    glint_plan *plan;
    glint_renderer *renderer;
    glint_image *image;
    glint_frame_stats stats;
    what.width = 640;
    what.height = 360;
    what.samples = 4;
    need(glint_plan_create(scene, &what, &plan, &error));
    need(glint_renderer_create(&with, &renderer, &error));
    need(glint_render(renderer, plan, &image, &stats, &error));
    need(glint_image_write(image, &file, &error));
    printf("c_pattern.png: %.1f ms, %s\n", stats.render_ms, glint_renderer_isa(renderer));
    glint_image_release(image);
    glint_renderer_destroy(renderer);
    glint_plan_destroy(plan);
    glint_scene_release(scene);
    return 0;
}
