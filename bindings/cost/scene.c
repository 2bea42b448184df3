// The scene of a study: its materials and lights, edited for one plan and restored.
#include <stdlib.h>
#include <string.h>

#include "bindings/cost/cost.h"

static int by_address(const void *a, const void *b)
{
    const glint_material *left = *(glint_material *const *)a, *right = *(glint_material *const *)b;
    return (left > right) - (left < right);
}

// Lists the materials of a shape, or of all shapes in a group; returns how many there are. NULL: only counts.
static size_t gather_materials(const glint_shape *shape, glint_material **out)
{
    glint_material *const *list;
    size_t count = glint_shape_materials(shape, &list);
    if (out && count > 0)
        memcpy(out, list, count * sizeof *list);
    for (size_t i = 0; i < glint_group_count(shape); i++)
        count += gather_materials(glint_group_child(shape, i), out ? out + count : NULL);
    return count;
}

// Lists each material once, because shapes share them.
static void list_materials(cost_scene *scene, const glint_scene *engine_scene)
{
    size_t count = 0;
    for (size_t i = 0; i < glint_scene_shape_count(engine_scene); i++)
        count += gather_materials(glint_scene_shape_at(engine_scene, i), scene->materials + count);
    qsort(scene->materials, count, sizeof *scene->materials, by_address);
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && scene->materials[i] == scene->materials[scene->material_count - 1])
            continue;
        scene->material_descs[scene->material_count] = *glint_material_get(scene->materials[i]);
        scene->materials[scene->material_count++] = scene->materials[i];
    }
}

// Lists the lights. Their descriptions get copies of the corners, because setting a light frees its own.
static void list_lights(cost_scene *scene, const glint_scene *engine_scene)
{
    double(*corners)[3] = scene->corners;
    for (size_t i = 0; i < glint_scene_light_count(engine_scene); i++) {
        glint_light_desc *desc = &scene->light_descs[i];
        scene->lights[i] = glint_scene_light_at(engine_scene, i);
        *desc = *glint_light_get(scene->lights[i]);
        if (desc->vertex_count == 0)
            continue;
        memcpy(corners, desc->vertices, desc->vertex_count * sizeof *corners);
        desc->vertices = (const double(*)[3])corners;
        corners += desc->vertex_count;
    }
    scene->light_count = glint_scene_light_count(engine_scene);
}

bool cost_scene_open(cost_scene *scene, glint_scene *engine_scene)
{
    size_t shapes = glint_scene_shape_count(engine_scene), lights = glint_scene_light_count(engine_scene), most = 1;
    size_t corners = 1;
    for (size_t i = 0; i < shapes; i++)
        most += gather_materials(glint_scene_shape_at(engine_scene, i), NULL);
    for (size_t i = 0; i < lights; i++)
        corners += glint_light_get(glint_scene_light_at(engine_scene, i))->vertex_count;
    *scene = (cost_scene) { .scene = engine_scene, .original = engine_scene, .desc = *glint_scene_get(engine_scene) };
    scene->materials = calloc(most, sizeof *scene->materials);
    scene->material_descs = calloc(most, sizeof *scene->material_descs);
    scene->lights = calloc(lights + 1, sizeof *scene->lights);
    scene->light_descs = calloc(lights + 1, sizeof *scene->light_descs);
    scene->corners = calloc(corners, sizeof *scene->corners);
    if (!scene->materials || !scene->material_descs || !scene->lights || !scene->light_descs || !scene->corners)
        return false;
    list_materials(scene, engine_scene);
    list_lights(scene, engine_scene);
    return true;
}

void cost_scene_close(cost_scene *scene)
{
    free(scene->materials);
    free(scene->material_descs);
    free(scene->lights);
    free(scene->light_descs);
    free(scene->corners);
    cost_scene_close_meshes(scene);
    memset(scene, 0, sizeof *scene);
}

void cost_scene_restore(cost_scene *scene)
{
    glint_scene_set(scene->scene, &scene->desc, NULL);
    for (size_t i = 0; i < scene->material_count; i++) // cannot fail: they were valid before
        glint_material_set(scene->materials[i], &scene->material_descs[i], NULL);
    for (size_t i = 0; i < scene->light_count; i++)
        glint_light_set(scene->lights[i], &scene->light_descs[i], NULL);
    cost_scene_restore_meshes(scene);
}

static void set_three(double out[3], double value) { out[0] = out[1] = out[2] = value; }

glint_status cost_scene_show_light(cost_scene *scene, size_t light, glint_error *error)
{
    glint_material_desc white = glint_material_desc_default();
    glint_scene_desc direct = *glint_scene_get(scene->scene);
    direct.has_indirect = direct.has_ambient_occlusion = false;
    glint_status status = glint_scene_set(scene->scene, &direct, error);
    white.model = GLINT_MODEL_LAMBERT;
    set_three(white.diffuse, 1);
    for (size_t i = 0; i < scene->material_count && !status; i++)
        status = glint_material_set(scene->materials[i], &white, error);
    for (size_t i = 0; i < scene->light_count && !status; i++) {
        glint_light_desc desc = *glint_light_get(scene->lights[i]);
        desc.has_diffuse = desc.has_specular = desc.has_radiance = false;
        desc.intensity = light >= scene->light_count || i == light ? 1 : 0;
        set_three(desc.color, 1);
        set_three(desc.attenuation, 0);
        desc.attenuation[0] = 1;
        status = glint_light_set(scene->lights[i], &desc, error);
    }
    return status;
}
