/// Backgrounds computed by a program, through glint.h only: counts, stages that run again, refused values; and
/// patterns that are constants, inside and outside a field's range.
#include <string.h>

#include "engine/glint_inspect.h"
#include "tests/engine/cases/builder_case.h"

#define WIDTH 96
#define HEIGHT 72

/// Returns the program offset + slope d.y.
static glint_program *gradient(double offset, double slope)
{
    begin_program(GLINT_PROGRAM_PATTERN);
    const glint_value rise = op(GLINT_OP_MUL, in(GLINT_INPUT_P_Y), num(slope), 0);
    const glint_value value = op(GLINT_OP_ADD, rise, num(offset), 0);
    return end_program(&value, 1);
}

static glint_program *constant(glint_program_kind kind, double number)
{
    begin_program(kind);
    const glint_value value = num(number);
    return end_program((const glint_value[]) { value, value, value }, kind == GLINT_PROGRAM_SHADER ? 3 : 1);
}

// ---- A ball in front of the background ------------------------------------------------------------------------------

typedef struct world {
    glint_scene *scene;
    glint_material *material;
    glint_light *lamp;
    glint_renderer *renderer;
    glint_frame_stats stats;
} world;

static world new_world(bool no_reuse)
{
    world w = { 0 };
    glint_camera_desc camera = glint_camera_desc_default();
    glint_material_desc material = glint_material_desc_default();
    glint_light_desc lamp = glint_light_desc_default(GLINT_LIGHT_POINT);
    glint_shape_desc ball = glint_shape_desc_default(GLINT_SHAPE_SPHERE);
    const glint_renderer_desc renderer = { .struct_size = sizeof(glint_renderer_desc), .threads = 2, .count_work = true, .no_reuse = no_reuse };
    glint_scene_desc scene = { .struct_size = sizeof(glint_scene_desc), .ambient = { 0.5, 0.5, 0.5 } };
    glint_shape *shape;
    OK(glint_camera_create(&camera, &scene.camera, &error));
    OK(glint_material_create(&material, &w.material, &error));
    OK(glint_light_create(&lamp, &w.lamp, &error));
    ball.material = w.material;
    ball.radius = 2;
    OK(glint_shape_create(&ball, &shape, &error));
    OK(glint_scene_create(&w.scene, &error));
    OK(glint_scene_set(w.scene, &scene, &error));
    OK(glint_scene_add_shape(w.scene, shape, &error));
    OK(glint_scene_add_light(w.scene, w.lamp, &error));
    OK(glint_renderer_create(&renderer, &w.renderer, &error));
    glint_camera_release(scene.camera);
    glint_shape_release(shape);
    return w;
}

static void release_world(world *w)
{
    glint_renderer_destroy(w->renderer);
    glint_scene_release(w->scene);
    glint_material_release(w->material);
    glint_light_release(w->lamp);
}

/// Sets the background and releases the caller's reference.
static glint_status set_background(world *w, glint_program *program)
{
    glint_scene_desc desc = *glint_scene_get(w->scene);
    desc.struct_size = sizeof desc;
    desc.background_program = program;
    const glint_status status = glint_scene_set(w->scene, &desc, &error);
    glint_program_release(program);
    return status;
}

/// Renders and returns the value of pixel x, y.
static double render(world *w, int x, int y)
{
    glint_render_desc desc = glint_render_desc_default();
    glint_plan *plan;
    glint_image *image;
    float light[3];
    desc.width = WIDTH;
    desc.height = HEIGHT;
    OK(glint_plan_create(w->scene, &desc, &plan, &error));
    OK(glint_render(w->renderer, plan, &image, &w->stats, &error));
    OK(glint_image_pixel(image, GLINT_PASS_BEAUTY, x, y, light, &error));
    glint_plan_destroy(plan);
    glint_image_release(image);
    return (double)light[0];
}

static double share_reused(const glint_frame_stats *stats, const char *stage)
{
    for (int i = 0; i < stats->stage_count; i++)
        if (strcmp(stats->stage_name[i], stage) == 0)
            return stats->stage_reused[i];
    return -1;
}

// ---- Work of a frame ------------------------------------------------------------------------------------------------

/// The stage runs for every ray that hits nothing, and for no other ray; with a mirror also for reflected rays that
/// leave the scene. Without a program the stage does not exist.
static void test_counts(void **state)
{
    (void)state;
    world w = new_world(true);
    render(&w, 0, 0);
    assert_true(share_reused(&w.stats, "environment") == -1 && w.stats.work.environment == 0);
    OK(set_background(&w, gradient(0.5, 0.25)));
    render(&w, 0, 0);
    const uint64_t missing = w.stats.work.environment;
    assert_true(missing > WIDTH * HEIGHT / 2 && missing < WIDTH * HEIGHT);
    assert_true(share_reused(&w.stats, "environment") == 0 && w.stats.odd[GLINT_ODD_NEGATIVE].count == 0);
    glint_material_desc mirror = *glint_material_get(w.material);
    mirror.struct_size = sizeof mirror;
    mirror.has_mirror = true;
    mirror.mirror[0] = mirror.mirror[1] = mirror.mirror[2] = 0.5;
    OK(glint_material_set(w.material, &mirror, &error));
    render(&w, 0, 0);
    assert_int_equal(w.stats.work.environment, WIDTH * HEIGHT); // every ray leaves the scene in the end
    release_world(&w);
}

/// A changed parameter of the background runs only `shade`, where the background is visible. A moved light does not
/// affect tiles that show only the background.
static void test_reuse(void **state)
{
    (void)state;
    world w = new_world(false);
    for (int i = 0; i < 3; i++) {
        OK(set_background(&w, gradient(0.5, 0.25)));
        render(&w, 0, 0);
    }
    assert_true(share_reused(&w.stats, "environment") == 1 && w.stats.work.environment == 0);
    double corner = 0;
    for (int i = 0; i < 3; i++) { // the third frame reuses the results of the second
        OK(set_background(&w, gradient(0.5, 0.125 * i)));
        corner = render(&w, 0, 0);
    }
    assert_true(corner > 0.5 && corner < 0.5 + 0.25);
    assert_true(share_reused(&w.stats, "cast") == 1 && share_reused(&w.stats, "light") == 1);
    assert_true(share_reused(&w.stats, "environment") < 0.5);
    glint_light_desc lamp = *glint_light_get(w.lamp);
    lamp.struct_size = sizeof lamp;
    lamp.position[0] += 1;
    OK(glint_light_set(w.lamp, &lamp, &error));
    assert_true(render(&w, 0, 0) == corner);
    assert_true(share_reused(&w.stats, "environment") > 0 && share_reused(&w.stats, "environment") < 1);
    release_world(&w);
}

/// NaN and values out of range are reported, with a direction where they occur.
static void test_odd(void **state)
{
    (void)state;
    world w = new_world(true);
    OK(set_background(&w, gradient(0, 1)));
    const glint_odd *odd = &w.stats.odd[GLINT_ODD_NEGATIVE];
    assert_true(render(&w, 0, HEIGHT - 1) == 0 && odd->count > 0);
    assert_true(w.stats.odd[GLINT_ODD_NAN].count == 0 && w.stats.odd[GLINT_ODD_HUGE].count == 0);
    assert_string_equal(odd->field, "background");
    assert_string_equal(odd->material, "");
    const double *d = odd->point;
    assert_true(d[1] < 0 && d[2] < 0 && d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < 1 + 1e-12);
    release_world(&w);
}

static void test_refused(void **state)
{
    (void)state;
    world w = new_world(true);
    assert_int_equal(set_background(&w, constant(GLINT_PROGRAM_SHADER, 1)), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "background: a pattern expected, got a shader");
    OK(set_background(&w, gradient(0.5, 0.25)));
    glint_scene_desc desc = *glint_scene_get(w.scene);
    desc.struct_size = sizeof desc;
    desc.has_depth_cue = true;
    desc.depth_cue_far = 9;
    assert_int_equal(glint_scene_set(w.scene, &desc, &error), GLINT_ERR_INVALID);
    assert_non_null(strstr(error.message, "depth_cue.color: a colour expected"));
    desc.has_depth_cue_color = true;
    OK(glint_scene_set(w.scene, &desc, &error));
    release_world(&w);
}

// ---- Constant patterns ----------------------------------------------------------------------------------------------

/// A constant in range becomes a plain colour. A constant out of range runs as a program, gives 0 and is reported.
static void test_numbers(void **state)
{
    (void)state;
    world w = new_world(true);
    OK(set_background(&w, constant(GLINT_PROGRAM_PATTERN, 0.25)));
    assert_null(glint_scene_get(w.scene)->background_program);
    assert_true(glint_scene_get(w.scene)->background[2] == 0.25 && render(&w, 0, 0) == 0.25);
    OK(set_background(&w, constant(GLINT_PROGRAM_PATTERN, -0.25)));
    assert_non_null(glint_scene_get(w.scene)->background_program);
    assert_true(render(&w, 0, 0) == 0 && w.stats.odd[GLINT_ODD_NEGATIVE].count == w.stats.work.environment && w.stats.work.environment > 0);
    release_world(&w);
}

static void test_material_numbers(void **state)
{
    (void)state;
    world w = new_world(true);
    glint_material_desc plain = *glint_material_get(w.material), desc = plain;
    plain.struct_size = sizeof plain;
    desc.program.diffuse = constant(GLINT_PROGRAM_PATTERN, 0.5);
    OK(glint_material_set(w.material, &desc, &error));
    assert_true(!glint_material_get(w.material)->program.diffuse && glint_material_get(w.material)->diffuse[1] == 0.5);
    glint_program_release(desc.program.diffuse);
    desc = plain;
    desc.program.diffuse = constant(GLINT_PROGRAM_PATTERN, -1);
    OK(glint_material_set(w.material, &desc, &error));
    glint_program_release(desc.program.diffuse);
    assert_true(render(&w, WIDTH / 2, HEIGHT / 2) == 0 && w.stats.odd[GLINT_ODD_NEGATIVE].count > 0);
    assert_string_equal(w.stats.odd[GLINT_ODD_NEGATIVE].field, "diffuse");
    desc = plain;
    desc.program.opacity = constant(GLINT_PROGRAM_PATTERN, -1); // the surface is fully transparent
    OK(glint_material_set(w.material, &desc, &error));
    assert_true(render(&w, WIDTH / 2, HEIGHT / 2) == 0);
    glint_program_release(desc.program.opacity);
    desc.program.opacity = constant(GLINT_PROGRAM_PATTERN, 7);
    OK(glint_material_set(w.material, &desc, &error));
    assert_true(render(&w, WIDTH / 2, HEIGHT / 2) > 0.4);
    glint_program_release(desc.program.opacity);
    desc = plain;
    desc.program.bump = constant(GLINT_PROGRAM_PATTERN, -3); // the height is the same everywhere
    OK(glint_material_set(w.material, &desc, &error));
    assert_null(glint_material_get(w.material)->program.bump);
    glint_program_release(desc.program.bump);
    release_world(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_counts),  cmocka_unit_test(test_reuse),   cmocka_unit_test(test_odd),
        cmocka_unit_test(test_refused), cmocka_unit_test(test_numbers), cmocka_unit_test(test_material_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
