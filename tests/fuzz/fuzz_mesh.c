/// Bytes as a Wavefront .obj file: a mesh, which is then seen from the front in a small picture, or a message.
#include "engine/glint.h"
#include "tests/fuzz/fuzz.h"

#include <string.h>

static glint_renderer *renderer;

static void see(glint_shape *shape)
{
    glint_camera_desc c = glint_camera_desc_default();
    glint_render_desc d = glint_render_desc_default();
    glint_scene *scene;
    glint_camera *camera;
    glint_plan *plan;
    glint_image *image;
    glint_error error;
    c.eye[2] = 5;
    FUZZ_CHECK(!glint_camera_create(&c, &camera, &error), "%s", error.message);
    FUZZ_CHECK(!glint_scene_create(&scene, &error), "%s", error.message);
    glint_scene_desc s = *glint_scene_get(scene);
    s.camera = camera;
    FUZZ_CHECK(!glint_scene_set(scene, &s, &error), "%s", error.message);
    FUZZ_CHECK(!glint_scene_add_shape(scene, shape, &error), "%s", error.message);
    d.width = d.height = 16;
    if (!glint_plan_create(scene, &d, &plan, &error)) {
        if (!glint_render(renderer, plan, &image, NULL, &error))
            glint_image_release(image);
        glint_plan_destroy(plan);
    }
    glint_scene_release(scene);
    glint_camera_release(camera);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    glint_renderer_desc r = glint_renderer_desc_default();
    glint_mesh_desc d = glint_mesh_desc_default();
    glint_shape *shape;
    glint_error error = { 0 };
    r.threads = 1;
    r.no_reuse = true;
    if (!renderer)
        FUZZ_CHECK(!glint_renderer_create(&r, &renderer, &error), "%s", error.message);
    if (glint_mesh_load(fuzz_file(data, size), &d, &shape, &error)) {
        FUZZ_CHECK(*error.message && strlen(error.message) < sizeof error.message, "a message");
        return 0;
    }
    see(shape);
    glint_shape_release(shape);
    return 0;
}
