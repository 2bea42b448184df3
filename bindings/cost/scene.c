// The state of a scene: its camera, materials and lights, edited for one plan and restored.
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

static int by_address(const void *a, const void *b)
{
    const glint_material *left = *(glint_material *const *)a, *right = *(glint_material *const *)b;
    return (left > right) - (left < right);
}

// Lists a shape, and all shapes in a group; returns how many there are. NULL: only counts.
static size_t gather_shapes(glint_shape *shape, glint_shape **out)
{
    size_t count = 1;
    if (out)
        *out = shape;
    for (size_t i = 0; i < glint_group_count(shape); i++)
        count += gather_shapes(glint_group_child(shape, i), out ? out + count : NULL);
    return count;
}

static size_t gather_all(const glint_scene *scene, glint_shape **out)
{
    size_t count = 0;
    for (size_t i = 0; i < glint_scene_shape_count(scene); i++)
        count += gather_shapes(glint_scene_shape_at(scene, i), out ? out + count : NULL);
    return count;
}

// Lists each material once, because shapes share them.
static bool list_materials(cost_scene *scene)
{
    glint_material *const *list;
    size_t count = 0;
    for (size_t i = 0; i < scene->shape_count; i++)
        count += glint_shape_materials(scene->shapes[i], &list);
    scene->materials = calloc(count + 1, sizeof *scene->materials);
    scene->material_notes = calloc(count + 1, sizeof *scene->material_notes);
    if (!scene->materials || !scene->material_notes)
        return false;
    count = 0;
    for (size_t i = 0; i < scene->shape_count; i++)
        for (size_t k = glint_shape_materials(scene->shapes[i], &list); k > 0; k--)
            scene->materials[count++] = list[k - 1];
    qsort(scene->materials, count, sizeof *scene->materials, by_address);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || scene->materials[i] != scene->materials[scene->material_count - 1])
            scene->materials[scene->material_count++] = scene->materials[i];
    return true;
}

static bool note_objects(cost_scene *scene)
{
    bool good = glint_camera_create(glint_camera_get(scene->camera), &scene->camera_note, NULL) == GLINT_OK &&
                glint_scene_create(&scene->note, NULL) == GLINT_OK &&
                glint_scene_set(scene->note, glint_scene_get(scene->original), NULL) == GLINT_OK;
    for (size_t i = 0; i < scene->material_count && good; i++)
        good =
            glint_material_create(glint_material_get(scene->materials[i]), &scene->material_notes[i], NULL) == GLINT_OK;
    for (size_t i = 0; i < scene->light_count && good; i++)
        good = glint_light_create(glint_light_get(scene->lights[i]), &scene->light_notes[i], NULL) == GLINT_OK;
    return good;
}

bool cost_scene_open(cost_scene *scene, glint_scene *engine_scene)
{
    const size_t lights = glint_scene_light_count(engine_scene);
    *scene = (cost_scene) { .scene = engine_scene, .original = engine_scene };
    scene->camera = glint_scene_get(engine_scene)->camera;
    scene->shape_count = gather_all(engine_scene, NULL);
    scene->shapes = calloc(scene->shape_count + 1, sizeof *scene->shapes);
    scene->lights = calloc(lights + 1, sizeof *scene->lights);
    scene->light_notes = calloc(lights + 1, sizeof *scene->light_notes);
    if (!scene->shapes || !scene->lights || !scene->light_notes)
        return false;
    gather_all(engine_scene, scene->shapes);
    if (!list_materials(scene))
        return false;
    for (scene->light_count = 0; scene->light_count < lights; scene->light_count++)
        scene->lights[scene->light_count] = glint_scene_light_at(engine_scene, scene->light_count);
    return note_objects(scene);
}

void cost_scene_close(cost_scene *scene)
{
    for (size_t i = 0; i < scene->material_count; i++)
        glint_material_release(scene->material_notes[i]);
    for (size_t i = 0; i < scene->light_count; i++)
        glint_light_release(scene->light_notes[i]);
    glint_camera_release(scene->camera_note);
    glint_scene_release(scene->note);
    free(scene->shapes);
    free(scene->materials);
    free(scene->material_notes);
    free(scene->lights);
    free(scene->light_notes);
    cost_scene_close_meshes(scene);
    memset(scene, 0, sizeof *scene);
}

glint_status cost_scene_restore(cost_scene *scene, glint_error *error)
{
    glint_status status = glint_camera_set(scene->camera, glint_camera_get(scene->camera_note), error);
    if (!status)
        status = glint_scene_set(scene->scene, glint_scene_get(scene->note), error);
    for (size_t i = 0; i < scene->material_count && !status; i++)
        status = glint_material_set(scene->materials[i], glint_material_get(scene->material_notes[i]), error);
    for (size_t i = 0; i < scene->light_count && !status; i++)
        status = glint_light_set(scene->lights[i], glint_light_get(scene->light_notes[i]), error);
    cost_scene_restore_meshes(scene);
    return status;
}
