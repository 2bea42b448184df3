/// Programs of other versions: their descriptions are shorter or longer than the library's. A shorter one is in a block of
/// its own size, so that a sanitizer sees a read behind it.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "engine/glint.h"
#include "engine/glint_figures.h"
#include "engine/glint_files.h"
#include "engine/glint_programs.h"

static glint_scene *scene;
static glint_renderer *renderer;
static glint_image *image;

#define MAKES(object) \
    static glint_status make_##object(const void *desc, glint_error *error) \
    { \
        glint_##object *made = NULL; \
        const glint_status status = glint_##object##_create(desc, &made, error); \
        glint_##object##_release(made); \
        return status; \
    }
MAKES(camera)
MAKES(light)
MAKES(material)
MAKES(shape)
MAKES(overlay)
MAKES(texture)

static glint_status make_scene(const void *desc, glint_error *error) { return glint_scene_set(scene, desc, error); }

static glint_status make_spheres(const void *desc, glint_error *error)
{
    glint_shape *shape = NULL;
    const glint_status status = glint_spheres_create(desc, &shape, error);
    glint_shape_release(shape);
    return status;
}

static glint_status make_mesh(const void *desc, glint_error *error)
{
    static const double center[3] = { 0, 0, 0 };
    glint_shape *shape = NULL;
    const glint_status status = glint_sphere_mesh_create(center, 1, 8, desc, &shape, error);
    glint_shape_release(shape);
    return status;
}

static glint_status make_render(const void *desc, glint_error *error)
{
    glint_plan *plan = NULL;
    const glint_status status = glint_plan_create(scene, desc, &plan, error);
    glint_plan_destroy(plan);
    return status;
}

static glint_status make_renderer(const void *desc, glint_error *error)
{
    glint_renderer *made = NULL;
    const glint_status status = glint_renderer_create(desc, &made, error);
    glint_renderer_destroy(made);
    return status;
}

static glint_status make_write(const void *desc, glint_error *error)
{
    uint8_t *data = NULL;
    size_t size;
    const glint_status status = glint_image_to_bytes(image, desc, &data, &size, error);
    free(data);
    return status;
}

static glint_status make_sheet(const void *desc, glint_error *error)
{
    const glint_status status = glint_sheet_write(desc, "x.png", error);
    return status == GLINT_ERR_INVALID ? status : GLINT_OK; // there is no such picture
}

static void test_sizes(void **state)
{
    static const double sphere[4] = { 0, 0, 0, 1 };
    static const uint8_t pixel[3] = { 1, 2, 3 };
    static const glint_sheet_cell cell = { .path = "/nowhere/none.png" };
    const glint_scene_desc scene_desc = *glint_scene_get(scene);
    const glint_camera_desc camera = glint_camera_desc_default();
    const glint_light_desc light = glint_light_desc_default(GLINT_LIGHT_SPHERE);
    const glint_material_desc material = glint_material_desc_default();
    const glint_shape_desc shape = glint_shape_desc_default(GLINT_SHAPE_BOX);
    const glint_spheres_desc spheres = { .data = sphere, .count = 1 };
    const glint_mesh_desc mesh = glint_mesh_desc_default();
    glint_render_desc frame = glint_render_desc_default();
    const glint_renderer_desc workers = glint_renderer_desc_default();
    glint_overlay_desc label = glint_overlay_desc_default(GLINT_OVERLAY_LABEL);
    glint_texture_desc texture = glint_texture_desc_default();
    const glint_write_desc file = { .path = "x.png", .pass = GLINT_PASS_BEAUTY, .tone = glint_tone_desc_default() };
    const glint_sheet_desc sheet = { .cells = &cell, .cell_count = 1, .columns = 1, .gain = 1 };
    frame.width = frame.height = 8;
    memcpy(label.text, "a", 2);
    texture.width = texture.height = 1;
    texture.rgb = pixel;
    // cut: bytes of the last fields, which an older program does not have
    const struct {
        const char *name;
        glint_status (*make)(const void *desc, glint_error *error);
        const void *desc;
        size_t size, cut;
    } of[] = {
#define OF(name, desc, first) { #name, make_##name, &desc, sizeof desc, sizeof desc - offsetof(glint_##name##_desc, first) }
        OF(scene, scene_desc, reflection_samples), OF(camera, camera, name),        OF(light, light, name),
        OF(material, material, name),              OF(shape, shape, name),          OF(spheres, spheres, name),
        OF(mesh, mesh, reads),                     OF(render, frame, light_passes), OF(renderer, workers, reuse_memory),
        OF(overlay, label, name),                  OF(texture, texture, wrap),      OF(write, file, text),
        OF(sheet, sheet, transparent),
#undef OF
    };
    (void)state;
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        const size_t sizes[] = { of[i].size, of[i].size - of[i].cut, of[i].size + 24, of[i].size + 24, 0, sizeof(size_t), (size_t)-1 };
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
            const size_t known = sizes[k] < of[i].size && k < 4 ? sizes[k] : of[i].size, bytes = k < 4 ? sizes[k] : known;
            glint_error error = { 0 };
            char *desc = calloc(1, bytes);
            assert_non_null(desc);
            memcpy(desc, of[i].desc, known);
            memcpy(desc, &sizes[k], sizeof *sizes);
            if (k == 3)
                desc[bytes - 1] = 1; // a field that this version does not know
            const glint_status status = of[i].make(desc, &error);
            if (status != (k < 3 ? GLINT_OK : GLINT_ERR_INVALID))
                fail_msg("%s of %zu bytes: %s", of[i].name, sizes[k], error.message);
            if (k >= 3)
                assert_memory_equal(error.message, "desc.struct_size: ", 18);
            free(desc);
        }
    }
}

/// Fields that a program does not know have their defaults, also where the object had other values.
static void test_defaults(void **state)
{
    (void)state;
    glint_scene_desc desc = *glint_scene_get(scene);
    assert_true(desc.struct_size == sizeof desc);
    desc.struct_size = sizeof desc;
    desc.reflection_samples = 5;
    assert_int_equal(glint_scene_set(scene, &desc, NULL), GLINT_OK);
    assert_int_equal(glint_scene_get(scene)->reflection_samples, 5);
    desc.struct_size = offsetof(glint_scene_desc, reflection_samples);
    assert_int_equal(glint_scene_set(scene, &desc, NULL), GLINT_OK);
    assert_int_equal(glint_scene_get(scene)->reflection_samples, 16);
    struct {
        glint_render_desc desc;
        double more;
    } longer = { .more = 1 };
    glint_render_desc_init(&longer.desc, sizeof longer);
    assert_true(longer.more == 0 && longer.desc.struct_size == sizeof longer && longer.desc.width == 1280);
    glint_render_desc shorter = { .light_passes = "kept" };
    glint_render_desc_init(&shorter, offsetof(glint_render_desc, light_passes));
    assert_string_equal(shorter.light_passes, "kept");
    assert_true(shorter.struct_size == offsetof(glint_render_desc, light_passes) && shorter.height == 720);
}

static int begin(void **state)
{
    (void)state;
    const glint_renderer_desc workers = glint_renderer_desc_default();
    const glint_camera_desc view = glint_camera_desc_default();
    glint_scene_desc around = glint_scene_desc_default();
    glint_render_desc frame = glint_render_desc_default();
    glint_plan *plan = NULL;
    glint_status status = glint_scene_create(&scene, NULL);
    if (!status)
        status = glint_camera_create(&view, &around.camera, NULL);
    if (!status)
        status = glint_scene_set(scene, &around, NULL);
    glint_camera_release(around.camera);
    frame.width = frame.height = 8;
    if (!status)
        status = glint_plan_create(scene, &frame, &plan, NULL);
    if (!status)
        status = glint_renderer_create(&workers, &renderer, NULL);
    if (!status)
        status = glint_render(renderer, plan, &image, NULL, NULL);
    glint_plan_destroy(plan);
    return (int)status;
}

static int end(void **state)
{
    (void)state;
    glint_image_release(image);
    glint_renderer_destroy(renderer);
    glint_scene_release(scene);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_sizes), cmocka_unit_test(test_defaults) };
    return cmocka_run_group_tests(tests, begin, end);
}
