/// NULL for a required pointer gives an error that names the argument, and never a later crash.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "engine/glint.h"
#include "engine/glint_compare.h"
#include "engine/glint_data.h"
#include "engine/glint_figures.h"
#include "engine/glint_files.h"
#include "engine/glint_inspect.h"
#include "engine/glint_math.h"
#include "engine/glint_programs.h"

/// Checks that `call` refuses the argument `name` and fills `error`.
#define REFUSES(name, call) \
    do { \
        glint_error error = { 0 }; \
        assert_int_equal(call, GLINT_ERR_INVALID); \
        assert_string_equal(error.message, name ": pointer expected, got NULL"); \
    } while (0)

typedef struct parts {
    glint_scene *scene;
    glint_shape *shape, *group;
    glint_light *light;
    glint_material *material;
    glint_camera *camera;
    glint_renderer *renderer;
    glint_plan *plan;
    glint_image *image;
} parts;

static parts make(void)
{
    parts p = { 0 };
    const glint_shape_desc sphere = glint_shape_desc_default(GLINT_SHAPE_SPHERE), group = glint_shape_desc_default(GLINT_SHAPE_GROUP);
    const glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_POINT);
    const glint_material_desc material = glint_material_desc_default();
    const glint_camera_desc camera = glint_camera_desc_default();
    const glint_renderer_desc renderer = glint_renderer_desc_default();
    glint_render_desc frame = glint_render_desc_default();
    frame.width = frame.height = 8;
    assert_int_equal(glint_scene_create(&p.scene, NULL), GLINT_OK);
    assert_int_equal(glint_shape_create(&sphere, &p.shape, NULL), GLINT_OK);
    assert_int_equal(glint_shape_create(&group, &p.group, NULL), GLINT_OK);
    assert_int_equal(glint_light_create(&light, &p.light, NULL), GLINT_OK);
    assert_int_equal(glint_material_create(&material, &p.material, NULL), GLINT_OK);
    assert_int_equal(glint_camera_create(&camera, &p.camera, NULL), GLINT_OK);
    assert_int_equal(glint_renderer_create(&renderer, &p.renderer, NULL), GLINT_OK);
    glint_scene_desc scene = *glint_scene_get(p.scene);
    scene.struct_size = sizeof scene;
    scene.camera = p.camera;
    assert_int_equal(glint_scene_set(p.scene, &scene, NULL), GLINT_OK);
    assert_int_equal(glint_plan_create(p.scene, &frame, &p.plan, NULL), GLINT_OK);
    assert_int_equal(glint_render(p.renderer, p.plan, &p.image, NULL, NULL), GLINT_OK);
    return p;
}

static void destroy(parts *p)
{
    glint_image_release(p->image);
    glint_plan_destroy(p->plan);
    glint_renderer_destroy(p->renderer);
    glint_camera_release(p->camera);
    glint_material_release(p->material);
    glint_light_release(p->light);
    glint_shape_release(p->group);
    glint_shape_release(p->shape);
    glint_scene_release(p->scene);
}

static void test_null_of_scenes(void **state)
{
    parts p = make();
    glint_scene_desc desc = *glint_scene_get(p.scene);
    desc.struct_size = sizeof desc;
    (void)state;
    REFUSES("out", glint_scene_create(NULL, &error));
    REFUSES("scene", glint_scene_set(NULL, &desc, &error));
    REFUSES("desc", glint_scene_set(p.scene, NULL, &error));
    REFUSES("scene", glint_scene_add_shape(NULL, p.shape, &error));
    REFUSES("shape", glint_scene_add_shape(p.scene, NULL, &error));
    REFUSES("scene", glint_scene_add_light(NULL, p.light, &error));
    REFUSES("light", glint_scene_add_light(p.scene, NULL, &error));
    REFUSES("overlay", glint_scene_add_overlay(p.scene, NULL, &error));
    REFUSES("shape", glint_scene_remove_shape(p.scene, NULL, &error));
    REFUSES("light", glint_scene_remove_light(p.scene, NULL, &error));
    REFUSES("overlay", glint_scene_remove_overlay(p.scene, NULL, &error));
    REFUSES("group", glint_group_add(NULL, p.shape, &error));
    REFUSES("child", glint_group_add(p.group, NULL, &error));
    REFUSES("child", glint_group_remove(p.group, NULL, &error));
    assert_int_equal(glint_scene_add_shape(p.scene, NULL, NULL), GLINT_ERR_INVALID); // a call without an error struct
    assert_int_equal(glint_scene_shape_count(p.scene), 0);
    assert_int_equal(glint_group_count(p.group), 0);
    // numbers beyond the last object, and a name without an end
    char name[GLINT_NAME_SIZE] = "";
    glint_error error;
    assert_true(!glint_scene_shape_at(p.scene, 0) && !glint_scene_light_at(p.scene, 0) && !glint_scene_overlay_at(p.scene, 0));
    assert_true(!glint_group_child(p.group, 0) && !glint_group_child(p.shape, 3));
    glint_scene_light_pass(p.scene, 7, name);
    assert_string_equal(name, "");
    glint_light_desc light = *glint_light_get(p.light);
    light.struct_size = sizeof light;
    memset(light.name, 'x', sizeof light.name);
    assert_int_equal(glint_light_set(p.light, &light, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "name: at most 63 bytes and a NUL expected");
    destroy(&p);
}

static void test_null_of_objects(void **state)
{
    parts p = make();
    const glint_material_desc material = glint_material_desc_default();
    const glint_mesh_desc mesh = glint_mesh_desc_default();
    const double axis[3] = { 0, 0, 1 };
    glint_shape *shape = NULL;
    (void)state;
    REFUSES("desc", glint_material_create(NULL, &p.material, &error));
    REFUSES("out", glint_material_create(&material, NULL, &error));
    REFUSES("material", glint_material_set(NULL, &material, &error));
    REFUSES("desc", glint_material_set(p.material, NULL, &error));
    REFUSES("to_light", glint_material_evaluate(p.material, axis, NULL, axis, NULL, &error));
    REFUSES("desc", glint_light_create(NULL, &p.light, &error));
    REFUSES("desc", glint_light_set(p.light, NULL, &error));
    REFUSES("desc", glint_camera_create(NULL, &p.camera, &error));
    REFUSES("desc", glint_camera_set(p.camera, NULL, &error));
    REFUSES("desc", glint_shape_create(NULL, &shape, &error));
    REFUSES("desc", glint_shape_set(p.shape, NULL, &error));
    REFUSES("desc", glint_spheres_create(NULL, &shape, &error));
    REFUSES("desc", glint_cylinders_create(NULL, &shape, &error));
    REFUSES("desc", glint_bonds_create(NULL, &shape, &error));
    REFUSES("image", glint_image_floats(NULL, GLINT_PASS_BEAUTY, NULL, &error));
    REFUSES("out", glint_words_create(NULL, &error));
    REFUSES("words", glint_words_add(NULL, "a", 1, 1, &error));
    REFUSES("desc", glint_mesh_create(NULL, &shape, &error));
    REFUSES("desc", glint_mesh_create_counting(NULL, &(glint_mesh_faults) { 0 }, &shape, &error));
    REFUSES("faults", glint_mesh_create_counting(&mesh, NULL, &shape, &error));
    REFUSES("path", glint_mesh_load(NULL, &mesh, &shape, &error));
    REFUSES("center", glint_sphere_mesh_create(NULL, 1, 8, &mesh, &shape, &error));
    REFUSES("desc", glint_overlay_create(NULL, &(glint_overlay *) { NULL }, &error));
    REFUSES("curves", glint_chart_create(NULL, 1, &(glint_chart *) { NULL }, &error));
    REFUSES("desc", glint_texture_create(NULL, &(glint_texture *) { NULL }, &error));
    REFUSES("path", glint_texture_read(NULL, &(glint_texture_desc) { .struct_size = sizeof(glint_texture_desc) }, &(glint_texture *) { NULL }, &error));
    REFUSES("desc", glint_texture_read("a.png", NULL, &(glint_texture *) { NULL }, &error));
    REFUSES("image", glint_image_overlays_svg(NULL, &(glint_page) { 0 }, &(char *) { NULL }, &error));
    glint_builder *builder = NULL;
    assert_int_equal(glint_builder_create(GLINT_PROGRAM_PATTERN, &builder, NULL), GLINT_OK);
    REFUSES("slopes", glint_builder_parameter(builder, 1, NULL, 1, &(glint_value) { 0 }, &error));
    glint_builder_destroy(builder);
    destroy(&p);
}

static void test_null_of_frames(void **state)
{
    parts p = make();
    const glint_render_desc frame = glint_render_desc_default();
    const double point[3] = { 0, 0, 9 };
    bool hit;
    float pixel[3];
    glint_plan *plan = NULL;
    (void)state;
    REFUSES("scene", glint_plan_create(NULL, &frame, &plan, &error));
    REFUSES("desc", glint_plan_create(p.scene, NULL, &plan, &error));
    REFUSES("out", glint_plan_create(p.scene, &frame, NULL, &error));
    REFUSES("desc", glint_renderer_create(NULL, &p.renderer, &error));
    REFUSES("renderer", glint_render(NULL, p.plan, &p.image, NULL, &error));
    REFUSES("plan", glint_render(p.renderer, NULL, &p.image, NULL, &error));
    REFUSES("out", glint_render(p.renderer, p.plan, NULL, NULL, &error));
    REFUSES("image", glint_image_pixel(NULL, GLINT_PASS_BEAUTY, 0, 0, pixel, &error));
    REFUSES("desc", glint_image_write(p.image, NULL, &error));
    REFUSES("direction", glint_scene_cast(p.scene, point, NULL, &hit, NULL, &error));
    REFUSES("path", glint_draft_create(NULL, &(glint_draft *) { NULL }, &error));
    REFUSES("path", glint_picture_read(NULL, true, &(glint_picture *) { NULL }, &error));
    REFUSES("data", glint_picture_from_bytes(NULL, 0, &(glint_picture *) { NULL }, &error));
    destroy(&p);
}

/// Calls every function of the public headers that takes a pointer, with NULL for all its pointers. A status must be
/// GLINT_ERR_INVALID, a transform the identity, and any other result 0, NULL or false. tests/lua/check_header.lua
/// finds functions that are missing here.
static void test_null_of_every_function(void **state)
{
#define INVALID(call) assert_int_equal(call, GLINT_ERR_INVALID)
#define NOTHING(call) assert_false(call)
    (void)state;
    glint_op_apply(0, NULL, NULL);
    INVALID(glint_builder_create(0, NULL, NULL));
    glint_builder_destroy(NULL);
    INVALID(glint_builder_number(NULL, 0, NULL, NULL));
    INVALID(glint_builder_parameter(NULL, 0, NULL, 0, NULL, NULL));
    INVALID(glint_builder_input(NULL, 0, NULL, NULL));
    INVALID(glint_builder_op(NULL, 0, NULL, NULL, NULL));
    INVALID(glint_builder_texel(NULL, NULL, 0, 0, 0, NULL, NULL));
    INVALID(glint_builder_texel_by_axis(NULL, NULL, 0, 0, NULL, NULL, NULL));
    NOTHING(glint_builder_is_number(NULL, 0, NULL));
    NOTHING(glint_builder_length(NULL));
    INVALID(glint_builder_finish(NULL, NULL, 0, NULL, NULL));
    NOTHING(glint_program_retain(NULL));
    glint_program_release(NULL);
    INVALID(glint_program_evaluate(NULL, NULL, NULL, NULL));
    NOTHING(glint_program_kind_of(NULL));
    NOTHING(glint_program_output_count(NULL));
    NOTHING(glint_program_length(NULL));
    NOTHING(glint_program_rows(NULL));
    NOTHING(glint_program_reads(NULL, 0));
    glint_program_structure(NULL, NULL);
    NOTHING(glint_program_constant(NULL, NULL));
    NOTHING(glint_program_tangent(NULL, 0));
    NOTHING(glint_program_listing(NULL));
    INVALID(glint_texture_create(NULL, NULL, NULL));
    INVALID(glint_texture_read(NULL, NULL, NULL, NULL));
    INVALID(glint_texture_rewrap(NULL, 0, NULL, NULL));
    NOTHING(glint_texture_retain(NULL));
    glint_texture_release(NULL);
    NOTHING(glint_texture_width(NULL));
    NOTHING(glint_texture_height(NULL));
    NOTHING(glint_object_fields(0, NULL));
    glint_material_desc_resolve(NULL);
    INVALID(glint_material_create(NULL, NULL, NULL));
    INVALID(glint_material_set(NULL, NULL, NULL));
    NOTHING(glint_material_get(NULL));
    NOTHING(glint_material_retain(NULL));
    glint_material_release(NULL);
    INVALID(glint_material_evaluate(NULL, NULL, NULL, NULL, NULL, NULL));
    INVALID(glint_light_create(NULL, NULL, NULL));
    INVALID(glint_light_set(NULL, NULL, NULL));
    NOTHING(glint_light_get(NULL));
    NOTHING(glint_light_retain(NULL));
    glint_light_release(NULL);
    INVALID(glint_camera_create(NULL, NULL, NULL));
    INVALID(glint_camera_set(NULL, NULL, NULL));
    NOTHING(glint_camera_get(NULL));
    glint_camera_window(NULL, 0, 0, NULL);
    glint_camera_point(NULL, 0, 0, NULL, 0, NULL);
    NOTHING(glint_camera_project(NULL, 0, 0, NULL, NULL, NULL));
    NOTHING(glint_camera_retain(NULL));
    glint_camera_release(NULL);
    const glint_transform identity = glint_transform_identity(), made[] = {
        glint_transform_product(NULL, NULL),
        glint_transform_translate(NULL),
        glint_transform_scale(NULL),
        glint_transform_rotate_deg(NULL, 0),
    };
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        assert_memory_equal(&made[i], &identity, sizeof identity);
    INVALID(glint_shape_create(NULL, NULL, NULL));
    INVALID(glint_shape_set(NULL, NULL, NULL));
    NOTHING(glint_shape_get(NULL));
    NOTHING(glint_shape_retain(NULL));
    glint_shape_release(NULL);
    NOTHING(glint_shape_materials(NULL, NULL));
    NOTHING(glint_shape_bounds(NULL, NULL, NULL));
    INVALID(glint_group_add(NULL, NULL, NULL));
    INVALID(glint_group_remove(NULL, NULL, NULL));
    NOTHING(glint_group_count(NULL));
    NOTHING(glint_group_child(NULL, 0));
    INVALID(glint_spheres_create(NULL, NULL, NULL));
    NOTHING(glint_spheres_count(NULL));
    assert_null(glint_spheres_data(NULL));
    assert_null(glint_spheres_index(NULL));
    glint_words_destroy(NULL);
    NOTHING(glint_rows_read(&(glint_rows_desc) { .field_count = 1 }, NULL, 0, 1, &(size_t) { 0 }, &(size_t) { 0 }));
    INVALID(glint_mesh_create(NULL, NULL, NULL));
    INVALID(glint_mesh_create_counting(NULL, NULL, NULL, NULL));
    INVALID(glint_mesh_load(NULL, NULL, NULL, NULL));
    INVALID(glint_sphere_mesh_create(NULL, 0, 0, NULL, NULL, NULL));
    NOTHING(glint_mesh_bend(NULL));
    NOTHING(glint_sphere_mesh_get(NULL, NULL, NULL, NULL));
    NOTHING(glint_mesh_get(NULL, NULL));
    NOTHING(glint_shape_has_material(NULL));
    INVALID(glint_overlay_create(NULL, NULL, NULL));
    INVALID(glint_overlay_set(NULL, NULL, NULL));
    NOTHING(glint_overlay_get(NULL));
    NOTHING(glint_formula_command(0, NULL, NULL));
    NOTHING(glint_overlay_retain(NULL));
    glint_overlay_release(NULL);
    INVALID(glint_chart_create(NULL, 0, NULL, NULL));
    NOTHING(glint_chart_curve(NULL, 0));
    NOTHING(glint_chart_retain(NULL));
    glint_chart_release(NULL);
    INVALID(glint_scene_create(NULL, NULL));
    INVALID(glint_scene_set(NULL, NULL, NULL));
    NOTHING(glint_scene_get(NULL));
    NOTHING(glint_scene_retain(NULL));
    glint_scene_release(NULL);
    INVALID(glint_scene_add_shape(NULL, NULL, NULL));
    INVALID(glint_scene_add_light(NULL, NULL, NULL));
    INVALID(glint_scene_remove_shape(NULL, NULL, NULL));
    INVALID(glint_scene_remove_light(NULL, NULL, NULL));
    INVALID(glint_scene_add_overlay(NULL, NULL, NULL));
    INVALID(glint_scene_remove_overlay(NULL, NULL, NULL));
    NOTHING(glint_scene_shape_count(NULL));
    NOTHING(glint_scene_light_count(NULL));
    NOTHING(glint_scene_overlay_count(NULL));
    NOTHING(glint_scene_shape_at(NULL, 0));
    NOTHING(glint_scene_light_at(NULL, 0));
    NOTHING(glint_scene_overlay_at(NULL, 0));
    glint_scene_light_pass(NULL, 0, NULL);
    INVALID(glint_scene_cast(NULL, NULL, NULL, NULL, NULL, NULL));
    INVALID(glint_scene_path(NULL, NULL, NULL, 0, NULL, NULL, NULL));
    assert_int_equal(glint_pass_from_name(NULL), GLINT_PASS_COUNT);
    glint_tone_steps(NULL, NULL);
    INVALID(glint_plan_create(NULL, NULL, NULL, NULL));
    glint_shutter_desc(NULL);
    INVALID(glint_plan_create_exposed(NULL, NULL, NULL, 0, NULL, NULL));
    glint_plan_destroy(NULL);
    INVALID(glint_plan_check_overlays(NULL, 0, NULL, NULL, NULL));
    NOTHING(glint_plan_render_desc(NULL));
    NOTHING(glint_plan_light_pass(NULL, 0));
    NOTHING(glint_plan_effects(NULL, NULL));
    NOTHING(glint_plan_stages(NULL, NULL));
    (void)glint_plan_expected_rays(NULL);
    NOTHING(glint_plan_work_after(NULL, NULL, NULL));
    NOTHING(glint_plan_program(NULL, 0, NULL));
    INVALID(glint_renderer_create(NULL, NULL, NULL));
    glint_renderer_destroy(NULL);
    NOTHING(glint_renderer_isa(NULL));
    NOTHING(glint_renderer_threads(NULL));
    glint_renderer_cancel(NULL);
    NOTHING(glint_renderer_progress(NULL));
    glint_renderer_cache_hits(NULL);
    INVALID(glint_render(NULL, NULL, NULL, NULL, NULL));
    NOTHING(glint_image_retain(NULL));
    glint_image_release(NULL);
    NOTHING(glint_image_width(NULL));
    NOTHING(glint_image_without_overlays(NULL));
    INVALID(glint_image_overlays_svg(NULL, NULL, NULL, NULL));
    NOTHING(glint_image_height(NULL));
    NOTHING(glint_image_has_pass(NULL, 0));
    NOTHING(glint_image_derivative(NULL, 0));
    NOTHING(glint_image_light_pass(NULL, 0));
    NOTHING(glint_image_is_black(NULL));
    NOTHING(glint_image_exposure(NULL));
    INVALID(glint_image_brightness(NULL, 0, NULL, NULL));
    INVALID(glint_image_range(NULL, 0, NULL, NULL));
    INVALID(glint_image_pixel(NULL, 0, 0, 0, NULL, NULL));
    INVALID(glint_image_write(NULL, NULL, NULL));
    INVALID(glint_image_to_bytes(NULL, NULL, NULL, NULL, NULL));
    INVALID(glint_image_rgba(NULL, NULL, NULL, NULL));
    glint_frame_key(NULL, NULL, NULL);
    glint_whole_key(NULL, NULL, NULL);
    glint_plan_key(NULL, NULL);
    glint_plan_add_pass_key(NULL, GLINT_PASS_BEAUTY, NULL);
    NOTHING(glint_file_has_key(NULL, NULL));
    INVALID(glint_writer_create(0, 0, NULL, NULL));
    glint_writer_destroy(NULL);
    INVALID(glint_writer_submit(NULL, NULL, NULL, NULL, NULL));
    NOTHING(glint_writer_collect(NULL, 0, NULL));
    glint_writer_cancel(NULL);
    INVALID(glint_compare_files(NULL, NULL, NULL, NULL, NULL));
    INVALID(glint_reference_create(NULL, 0, NULL, NULL, NULL));
    glint_reference_destroy(NULL);
    NOTHING(glint_reference_image(NULL));
    INVALID(glint_reference_measure(NULL, NULL, 0, NULL, NULL));
    INVALID(glint_reference_difference(NULL, NULL, 0, NULL, NULL));
    NOTHING(glint_partner_seed(NULL));
    INVALID(glint_estimate_error(NULL, NULL, NULL, NULL, NULL));
    NOTHING(glint_estimate_pixels(NULL, NULL, NULL));
    INVALID(glint_lights_read(NULL, NULL, NULL));
    INVALID(glint_image_relight(NULL, NULL, NULL, NULL));
    INVALID(glint_draft_create(NULL, NULL, NULL));
    NOTHING(glint_draft_name(NULL));
    INVALID(glint_draft_append(NULL, NULL, 0, NULL));
    INVALID(glint_draft_finish(NULL, NULL));
    glint_draft_destroy(NULL);
    glint_drafts_collect(NULL);
    glint_scene_desc_init(NULL, 100);
    glint_camera_desc_init(NULL, 100);
    glint_light_desc_init(NULL, 100, GLINT_LIGHT_POINT);
    glint_material_desc_init(NULL, 100);
    glint_shape_desc_init(NULL, 100, GLINT_SHAPE_SPHERE);
    glint_mesh_desc_init(NULL, 100);
    glint_render_desc_init(NULL, 100);
    glint_renderer_desc_init(NULL, 100);
    glint_overlay_desc_init(NULL, 100, GLINT_OVERLAY_LABEL);
    glint_texture_desc_init(NULL, 100);
    INVALID(glint_picture_read(NULL, 0, NULL, NULL));
    INVALID(glint_picture_from_bytes(NULL, 0, NULL, NULL));
    glint_picture_destroy(NULL);
    NOTHING(glint_picture_width(NULL));
    NOTHING(glint_picture_height(NULL));
    NOTHING(glint_picture_bits(NULL));
    NOTHING(glint_picture_channels(NULL));
    NOTHING(glint_picture_transfer(NULL));
    NOTHING(glint_picture_text(NULL, NULL));
    glint_picture_row(NULL, 0, 0, NULL);
    glint_picture_light(NULL, 0, NULL);
    INVALID(glint_picture_join(NULL, 0, 0, 0, NULL, NULL));
    INVALID(glint_sheet_write(NULL, NULL, NULL));
    INVALID(glint_apng_create(NULL, NULL, NULL, NULL));
    INVALID(glint_apng_add(NULL, NULL, NULL));
    INVALID(glint_apng_finish(NULL, NULL));
    glint_apng_destroy(NULL);
}

/// A frame with neither passes nor pixel values is refused. One of the two is enough.
static void test_nothing_to_render(void **state)
{
    parts p = make();
    glint_render_desc frame = glint_render_desc_default();
    glint_plan *plan;
    glint_error error = { 0 };
    (void)state;
    frame.passes = 0;
    assert_int_equal(glint_plan_create(p.scene, &frame, &plan, &error), GLINT_ERR_INVALID);
    assert_string_equal(error.message, "passes: at least one pass expected, or `codes`; the frame would be empty");
    frame.codes = true;
    assert_int_equal(glint_plan_create(p.scene, &frame, &plan, NULL), GLINT_OK);
    glint_plan_destroy(plan);
    destroy(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_null_of_scenes),
        cmocka_unit_test(test_null_of_objects),
        cmocka_unit_test(test_null_of_frames),
        cmocka_unit_test(test_null_of_every_function),
        cmocka_unit_test(test_nothing_to_render),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
