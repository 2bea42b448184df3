/// Derivatives through glint.h and through a script of the same scene are identical bit for bit: derivatives by
/// parameters of a material, a light, shapes, a camera, the scene and a pattern, in mirrors and glass, under an area
/// light, with several samples.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "engine/glint_files.h"
#include "tests/engine/cases/builder_case.h"

#define WIDTH 64
#define HEIGHT 48

static const char script[] =
    "local glint = require 'glint'\n"
    "local P = glint.params { which = 'numbers' }\n"
    "local x, s, wave, away = glint.variable('x', 2.5), glint.variable('s', 20), glint.variable('wave', 3), glint.variable('away', 8)\n"
    "local lamp = glint.point_light { position = { x, 4, 3 }, attenuation = { 1, 0, 0.02 } }\n"
    "local soft = glint.disk_light { position = { -3, 5, 2 }, normal = { 3, -5, -2 }, radius = 0.5, samples = 4, intensity = s / 50 }\n"
    "local shiny = glint.material { diffuse = { 0.7, 0.2, 0.1 }, specular = 0.5, shininess = s, mirror = 0.25 }\n"
    "local glass = glint.material { diffuse = 0, transmission = 0.9, ior = 1.5, fresnel = true }\n"
    "local striped = glint.material { diffuse = glint.pattern(function(p) return 0.5 + 0.25 * glint.sin(wave * p.x) end) }\n"
    "local function scene(floor, eye, ball)\n"
    "  return glint.scene { camera = glint.camera { eye = { 0, 2, eye }, at = { 0, 0, 0 } }, ambient = 0.1, background = { 0, 0.1, s / 100 },\n"
    "    lamp, soft, glint.plane { point = { 0, -1, 0 }, normal = { 0, 1, 0 }, material = floor },\n"
    "    glint.sphere { center = { 0, 0, 0 }, radius = ball, material = shiny },\n"
    "    glint.sphere { center = { 2, 0, 1 }, radius = 0.75, material = glass } }\n"
    "end\n"
    "local chosen = P.which == 'numbers' and scene(striped, 8, 1) or scene(glint.material { diffuse = 0.5 }, away, away / 8)\n"
    "return glint.animation { scene = chosen, frames = 1, output = P.which .. '.pfm', frame = function() end }\n";

typedef struct made {
    glint_scene *scene;
    glint_material *shiny, *glass, *floor;
    glint_light *lamp, *soft;
    glint_shape *ball;
    glint_program *stripes; ///< the floor's pattern; NULL: none
} made;

// ---- The scene ------------------------------------------------------------------------------------------------------

/// 0.5 + 0.25 sin(wave p.x), where wave is 3 and parameter 0.
static glint_program *make_stripes(void)
{
    const double one = 1;
    glint_value wave;
    begin_program(GLINT_PROGRAM_PATTERN);
    OK(glint_builder_parameter(builder, 3, &one, 1, &wave, &error));
    const glint_value sine = op(GLINT_OP_SIN, op(GLINT_OP_MUL, wave, in(GLINT_INPUT_P_X), 0), 0, 0);
    const glint_value value = op(GLINT_OP_ADD, num(0.5), op(GLINT_OP_MUL, num(0.25), sine, 0), 0);
    return end_program(&value, 1);
}

static void grey(double out[3], double value)
{
    for (int c = 0; c < 3; c++)
        out[c] = value;
}

static void make_materials(made *m)
{
    glint_material_desc d = glint_material_desc_default();
    d.has_specular = d.has_mirror = true;
    memcpy(d.diffuse, (const double[]) { 0.7, 0.2, 0.1 }, sizeof d.diffuse);
    grey(d.specular, 0.5);
    grey(d.mirror, 0.25);
    d.shininess = 20;
    OK(glint_material_create(&d, &m->shiny, &error));
    d = glint_material_desc_default();
    grey(d.diffuse, 0);
    grey(d.transmission, 0.9);
    d.ior = 1.5;
    d.fresnel = true;
    OK(glint_material_create(&d, &m->glass, &error));
    d = glint_material_desc_default();
    grey(d.diffuse, 0.5);
    d.program.diffuse = m->stripes;
    OK(glint_material_create(&d, &m->floor, &error));
}

static void make_lights(made *m)
{
    glint_light_desc d = glint_light_desc_default(GLINT_LIGHT_POINT);
    memcpy(d.position, (const double[]) { 2.5, 4, 3 }, sizeof d.position);
    memcpy(d.attenuation, (const double[]) { 1, 0, 0.02 }, sizeof d.attenuation);
    OK(glint_light_create(&d, &m->lamp, &error));
    d = glint_light_desc_default(GLINT_LIGHT_DISK);
    memcpy(d.position, (const double[]) { -3, 5, 2 }, sizeof d.position);
    memcpy(d.normal, (const double[]) { 3, -5, -2 }, sizeof d.normal);
    d.radius = 0.5;
    d.samples = 4;
    d.intensity = 20.0 / 50;
    OK(glint_light_create(&d, &m->soft, &error));
    OK(glint_scene_add_light(m->scene, m->lamp, &error));
    OK(glint_scene_add_light(m->scene, m->soft, &error));
}

static glint_shape *add_shape(made *m, const glint_shape_desc *desc)
{
    glint_shape *shape;
    OK(glint_shape_create(desc, &shape, &error));
    OK(glint_scene_add_shape(m->scene, shape, &error));
    return shape;
}

static void make_shapes(made *m)
{
    glint_shape_desc plane = glint_shape_desc_default(GLINT_SHAPE_PLANE), ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    memcpy(plane.point, (const double[]) { 0, -1, 0 }, sizeof plane.point);
    memcpy(plane.normal, (const double[]) { 0, 1, 0 }, sizeof plane.normal);
    plane.material = m->floor;
    glint_shape_release(add_shape(m, &plane));
    ball.material = m->shiny;
    ball.radius = 1;
    m->ball = add_shape(m, &ball);
    memcpy(ball.center, (const double[]) { 2, 0, 1 }, sizeof ball.center);
    ball.radius = 0.75;
    ball.material = m->glass;
    glint_shape_release(add_shape(m, &ball));
}

static made make_scene(bool striped)
{
    made m = { .stripes = striped ? make_stripes() : NULL };
    glint_camera_desc view = glint_camera_desc_default();
    glint_camera *camera;
    memcpy(view.eye, (const double[]) { 0, 2, 8 }, sizeof view.eye);
    grey(view.at, 0);
    OK(glint_camera_create(&view, &camera, &error));
    OK(glint_scene_create(&m.scene, &error));
    glint_scene_desc around = *glint_scene_get(m.scene);
    around.struct_size = sizeof around;
    around.camera = camera;
    grey(around.ambient, 0.1);
    memcpy(around.background, (const double[]) { 0, 0.1, 20.0 / 100 }, sizeof around.background);
    OK(glint_scene_set(m.scene, &around, &error));
    glint_camera_release(camera);
    make_materials(&m);
    make_lights(&m);
    make_shapes(&m);
    return m;
}

static void release(const made *m)
{
    glint_scene_release(m->scene);
    glint_material_release(m->shiny);
    glint_material_release(m->glass);
    glint_material_release(m->floor);
    glint_light_release(m->lamp);
    glint_light_release(m->soft);
    glint_shape_release(m->ball);
    glint_program_release(m->stripes);
}

// ---- The comparison -------------------------------------------------------------------------------------------------

/// Writes the pictures of the derivatives as NAME.d_DERIVATIVE.pfm.
static void write_pictures(const made *m, const char *name, const glint_derivative *derivatives, size_t count)
{
    glint_render_desc desc = glint_render_desc_default();
    glint_renderer_desc with = glint_renderer_desc_default();
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.samples = 4;
    desc.derivatives = derivatives;
    desc.derivative_count = count;
    OK(glint_plan_create(m->scene, &desc, &plan, &error));
    OK(glint_renderer_create(&with, &renderer, &error));
    OK(glint_render(renderer, plan, &image, NULL, &error));
    for (size_t i = 0; i < count; i++) {
        char path[64];
        glint_write_desc file = { .struct_size = sizeof(glint_write_desc), .path = path, .pass = (glint_pass)(GLINT_PASS_DERIVATIVE + i), .tone = glint_tone_desc_default() };
        snprintf(path, sizeof path, "c_%s.d_%s.pfm", name, derivatives[i].name);
        OK(glint_image_write(image, &file, &error));
    }
    glint_image_release(image);
    glint_renderer_destroy(renderer);
    glint_plan_destroy(plan);
}

static void write_numbers(void)
{
    const made m = make_scene(true);
    const glint_slope x = { .light = m.lamp, .field = "position", .slope = { 1, 0, 0 } };
    const glint_slope s[] = {
        { .material = m.shiny, .field = "shininess", .slope = { 1 } },
        { .light = m.soft, .field = "intensity", .slope = { 1.0 / 50 } },
        { .field = "background", .slope = { 0, 0, 1.0 / 100 } },
    };
    const glint_slope wave = { .material = m.floor, .field = "diffuse", .program = glint_program_tangent(m.stripes, 0) };
    write_pictures(&m, "numbers", (const glint_derivative[]) { { "x", &x, 1 }, { "s", s, 3 }, { "wave", &wave, 1 } }, 3);
    release(&m);
}

static void write_places(void)
{
    const made m = make_scene(false);
    const glint_slope away[] = {
        { .camera = glint_scene_get(m.scene)->camera, .field = "eye", .slope = { 0, 0, 1 } },
        { .shape = m.ball, .field = "radius", .slope = { 1.0 / 8 } },
    };
    write_pictures(&m, "places", &(const glint_derivative) { "away", away, 2 }, 1);
    release(&m);
}

/// Reads at most `capacity` bytes of a file. Fails when there is no such file.
static size_t bytes_of(const char *path, char *out, size_t capacity)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        fail_msg("%s is not there", path);
    const size_t count = fread(out, 1, capacity, file);
    fclose(file);
    return count;
}

static void test_same_bits(void **state)
{
    static const char *const names[] = { "numbers.d_x", "numbers.d_s", "numbers.d_wave", "places.d_away" };
    static char lua[WIDTH * HEIGHT * 12 + 99], c[WIDTH * HEIGHT * 12 + 99];
    (void)state;
    write_numbers();
    write_places();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s.pfm", names[i]);
        const size_t count = bytes_of(path, lua, sizeof lua);
        snprintf(path, sizeof path, "c_%s.pfm", names[i]);
        assert_true(count > WIDTH * HEIGHT * 12);
        assert_int_equal(bytes_of(path, c, sizeof c), count);
        assert_memory_equal(c, lua, count);
        size_t zeros = 0; // at most half of a picture may be zero
        for (size_t k = count - WIDTH * HEIGHT * 12; k < count; k++)
            zeros += c[k] == 0;
        assert_true(zeros < WIDTH * HEIGHT * 12 / 2);
    }
}

/// Runs the script in its own folder.
static int run_script(void **state)
{
    static char folder[] = "/tmp/glint_derivatives_XXXXXX";
    char here[4096], command[8192];
    const char *build = getenv("BUILD");
    if (!getcwd(here, sizeof here) || !mkdtemp(folder) || chdir(folder))
        return -1;
    FILE *file = fopen("s.lua", "w");
    if (!file || fputs(script, file) < 0 || fclose(file))
        return -1;
    *state = folder;
    for (int k = 0; k < 2; k++) {
        snprintf(command, sizeof command, "%s/%s/glint s.lua -D which=%s -q --size %dx%d --samples 4 --passes %s",
                 build && *build == '/' ? "" : here, build ? build : "build", k ? "places" : "numbers", WIDTH, HEIGHT,
                 k ? "d:away" : "d:x,d:s,d:wave");
        if (system(command))
            return -1;
    }
    return 0;
}

static int remove_folder(void **state)
{
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", (const char *)*state);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_same_bits) };
    return cmocka_run_group_tests(tests, run_script, remove_folder);
}
