// The meshes of a study's scene: their shading, edited and restored; and spheres of triangles with other numbers of
// segments, in a copy of the scene.
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

typedef void visitor(glint_shape *shape, void *data);

// Visits every shape that is not a group, once per instance. Skips parts of combined solids, which do not allow every
// shading.
static void visit(glint_shape *shape, visitor *see, void *data)
{
    const bool group = glint_shape_get(shape)->kind == GLINT_SHAPE_GROUP;
    if (!group)
        see(shape, data);
    for (size_t i = 0; group && i < glint_group_count(shape); i++)
        visit(glint_group_child(shape, i), see, data);
}

static void visit_all(const glint_scene *scene, visitor *see, void *data)
{
    for (size_t i = 0; i < glint_scene_shape_count(scene); i++)
        visit(glint_scene_shape_at(scene, i), see, data);
}

static bool is_globe(const glint_shape *shape, int64_t *segments)
{
    double center[3], radius;
    return glint_sphere_mesh_get(shape, center, &radius, segments);
}

static void look_at(glint_shape *shape, void *data)
{
    cost_meshes *meshes = data;
    const glint_shape_desc *desc = glint_shape_get(shape);
    int64_t segments;
    if (desc->kind != GLINT_SHAPE_MESH)
        return;
    meshes->is_mixed = meshes->is_mixed || (meshes->count > 0 && desc->shading != meshes->shading);
    meshes->shading = desc->shading;
    meshes->count++;
    if (!is_globe(shape, &segments))
        return;
    meshes->segments = meshes->globe_count == 0 || meshes->segments == segments ? segments : 0;
    meshes->globe_count++;
}

cost_meshes cost_scene_meshes(const cost_scene *scene)
{
    cost_meshes meshes = { 0 };
    visit_all(scene->scene, look_at, &meshes);
    return meshes;
}

// ---- Shading ----

typedef struct shading_edit {
    cost_scene *scene;
    glint_shading shading;
    glint_status status;
    glint_error *error;
} shading_edit;

static void set_shading(glint_shape *shape, void *data)
{
    shading_edit *edit = data;
    glint_shape_desc desc = *glint_shape_get(shape);
    desc.struct_size = sizeof desc;
    if (edit->status || desc.kind != GLINT_SHAPE_MESH || desc.shading == edit->shading)
        return;
    cost_shaded *grown = realloc(edit->scene->shaded, (edit->scene->shaded_count + 1) * sizeof *grown);
    if (!grown) {
        *edit->error = (glint_error) { GLINT_ERR_NOMEM, "out of memory" };
        edit->status = GLINT_ERR_NOMEM;
        return;
    }
    edit->scene->shaded = grown;
    grown[edit->scene->shaded_count++] = (cost_shaded) { shape, desc.shading };
    desc.shading = edit->shading;
    edit->status = glint_shape_set(shape, &desc, edit->error);
}

glint_status cost_scene_set_shading(cost_scene *scene, glint_shading shading, glint_error *error)
{
    shading_edit edit = { scene, shading, GLINT_OK, error };
    visit_all(scene->scene, set_shading, &edit);
    return edit.status;
}

void cost_scene_restore_meshes(cost_scene *scene)
{
    scene->scene = scene->original;
    while (scene->shaded_count > 0) {
        const cost_shaded *was = &scene->shaded[--scene->shaded_count];
        glint_shape_desc desc = *glint_shape_get(was->shape);
        desc.struct_size = sizeof desc;
        desc.shading = was->shading;
        glint_shape_set(was->shape, &desc, NULL); // cannot fail: it was valid before
    }
}

// ---- Segments ----

static void note_globe(glint_shape *shape, void *data)
{
    int64_t segments;
    bool *any = data;
    *any = *any || is_globe(shape, &segments);
}

// Makes a sphere of triangles with other segments; 0: the exact sphere that it approximates.
static glint_status make_globe(const glint_shape *from, int64_t segments, glint_shape **out, glint_error *error)
{
    const glint_shape_desc *desc = glint_shape_get(from);
    glint_shape_desc sphere = *desc;
    glint_mesh_desc mesh = glint_mesh_desc_default();
    double center[3], radius;
    int64_t own;
    glint_material *const *materials;
    glint_shape_materials(from, &materials);
    glint_sphere_mesh_get(from, center, &radius, &own);
    mesh.has_shading = true;
    mesh.shading = desc->shading;
    mesh.material = sphere.material = materials[0];
    mesh.transform = desc->transform;
    mesh.two_sided = desc->two_sided;
    memcpy(mesh.name, desc->name, sizeof mesh.name);
    if (segments > 0)
        return glint_sphere_mesh_create(center, radius, segments, &mesh, out, error);
    sphere.kind = GLINT_SHAPE_SPHERE;
    memcpy(sphere.center, center, sizeof center);
    sphere.radius = radius;
    return glint_shape_create(&sphere, out, error);
}

// Copies a shape; the caller owns a reference. Shapes without a sphere of triangles are shared.
static glint_status copy_shape(glint_shape *from, int64_t segments, glint_shape **out, glint_error *error)
{
    int64_t own;
    bool any = false;
    visit(from, note_globe, &any);
    if (!any) {
        *out = glint_shape_retain(from);
        return GLINT_OK;
    }
    if (is_globe(from, &own))
        return make_globe(from, segments, out, error);
    glint_shape *group = NULL;
    glint_status status = glint_shape_create(glint_shape_get(from), &group, error);
    for (size_t i = 0; i < glint_group_count(from) && !status; i++) {
        glint_shape *child = NULL;
        status = copy_shape(glint_group_child(from, i), segments, &child, error);
        if (!status)
            status = glint_group_add(group, child, error);
        glint_shape_release(child);
    }
    if (status)
        glint_shape_release(group);
    else
        *out = group;
    return status;
}

static glint_status copy_scene(glint_scene *from, int64_t segments, glint_scene *to, glint_error *error)
{
    glint_status status = glint_scene_set(to, glint_scene_get(from), error);
    for (size_t i = 0; i < glint_scene_light_count(from) && !status; i++)
        status = glint_scene_add_light(to, glint_scene_light_at(from, i), error);
    for (size_t i = 0; i < glint_scene_shape_count(from) && !status; i++) {
        glint_shape *shape = NULL;
        status = copy_shape(glint_scene_shape_at(from, i), segments, &shape, error);
        if (!status)
            status = glint_scene_add_shape(to, shape, error);
        glint_shape_release(shape);
    }
    return status;
}

// Copies live until the study ends, so that their indices are built only once.
glint_status cost_scene_set_segments(cost_scene *scene, int64_t segments, glint_error *error)
{
    for (int i = 0; i < scene->copy_count; i++)
        if (scene->copies[i].segments == segments) {
            scene->scene = scene->copies[i].scene;
            return GLINT_OK;
        }
    glint_scene *copy = NULL;
    glint_status status = glint_scene_create(&copy, error);
    if (!status)
        status = copy_scene(scene->original, segments, copy, error);
    if (status) {
        glint_scene_release(copy);
        return status;
    }
    scene->copies[scene->copy_count++] = (cost_copy) { segments, copy };
    scene->scene = copy;
    return GLINT_OK;
}

void cost_scene_close_meshes(cost_scene *scene)
{
    while (scene->copy_count > 0)
        glint_scene_release(scene->copies[--scene->copy_count].scene);
    free(scene->shaded);
    scene->shaded = NULL;
}
