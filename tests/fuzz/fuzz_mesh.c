/// Reads the input as a mesh file, whose type is detected from the first bytes, or as the mesh's material file. The
/// result is a message, or a mesh, which is rendered from the front in a small picture.
#include "engine/glint.h"
#include "engine/glint_files.h"
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
    s.struct_size = sizeof s;
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

/// Writes an .obj file that has the bytes as its material file.
static const char *mesh_with(const uint8_t *data, size_t size)
{
    char text[256];
    const char *path = fuzz_file_as(".mtl", data, size);
    const int length = snprintf(text, sizeof text,
                                "mtllib %s\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n"
                                "usemtl b\nf 3/1 2/1 1/1\n",
                                path);
    return fuzz_file_as(".obj", (const uint8_t *)text, (size_t)length);
}

static const char *file_of(const uint8_t *data, size_t size)
{
    if (size > 6 && memcmp(data, "newmtl", 6) == 0)
        return mesh_with(data, size);
    if (size > 3 && memcmp(data, "ply", 3) == 0)
        return fuzz_file_as(".ply", data, size);
    const bool solid = (size > 5 && memcmp(data, "solid", 5) == 0) || (size >= 84 && (size - 84) % 50 == 0);
    return solid ? fuzz_file_as(".stl", data, size) : fuzz_file(data, size);
}

static void take_message(void *context, const char *message)
{
    (void)context;
    FUZZ_CHECK(*message && strlen(message) < 512, "a warning");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    glint_renderer_desc r = glint_renderer_desc_default();
    glint_mesh_desc d = glint_mesh_desc_default();
    glint_shape *shape;
    glint_error error = { 0 };
    d.warns = take_message;
    r.threads = 1;
    r.no_reuse = true;
    if (!renderer)
        FUZZ_CHECK(!glint_renderer_create(&r, &renderer, &error), "%s", error.message);
    if (glint_mesh_load(file_of(data, size), &d, &shape, &error)) {
        FUZZ_CHECK(*error.message && strlen(error.message) < sizeof error.message, "a message");
        return 0;
    }
    see(shape);
    glint_shape_release(shape);
    return 0;
}
