#include "engine/base/status.h"
#include "engine/objects.h"

#include <stdlib.h>
#include <string.h>

glint_status glint_scene_create(glint_scene **out, glint_error *error)
{
    glint_scene *scene = calloc(1, sizeof *scene);
    if (!scene)
        return glint_fail_nomem(error);
    scene->references = 1;
    *out = scene;
    return GLINT_OK;
}

glint_status glint_scene_set(glint_scene *scene, const glint_scene_desc *desc, glint_error *error)
{
    glint_status status = glint_check_color("ambient", desc->ambient, error);
    if (!status)
        status = glint_check_color("background", desc->background, error);
    if (status)
        return status;
    glint_camera_retain(desc->camera);
    glint_camera_release(scene->desc.camera);
    scene->desc = *desc;
    return GLINT_OK;
}

const glint_scene_desc *glint_scene_get(const glint_scene *scene)
{
    return &scene->desc;
}

glint_scene *glint_scene_retain(glint_scene *scene)
{
    if (scene)
        scene->references++;
    return scene;
}

void glint_scene_release(glint_scene *scene)
{
    if (!scene || --scene->references > 0)
        return;
    for (size_t i = 0; i < scene->shapes.count; i++)
        glint_shape_release(glint_scene_shape(scene, i));
    for (size_t i = 0; i < scene->lights.count; i++)
        glint_light_release(glint_scene_light(scene, i));
    glint_camera_release(scene->desc.camera);
    free(scene->shapes.items);
    free(scene->shapes.slots);
    free(scene->lights.items);
    free(scene->lights.slots);
    free(scene);
}

static size_t hash_pointer(const void *object)
{
    return (size_t)(((uintptr_t)object >> 4) * UINT64_C(0x9e3779b97f4a7c15) >> 32);
}

/// The slot that holds `object`, or the free one where it would go.
static size_t find_slot(const glint_list *list, const void *object)
{
    size_t slot = hash_pointer(object) & (list->slot_count - 1);
    while (list->slots[slot] && list->items[list->slots[slot] - 1] != object)
        slot = (slot + 1) & (list->slot_count - 1);
    return slot;
}

static void fill_slots(glint_list *list)
{
    memset(list->slots, 0, list->slot_count * sizeof *list->slots);
    for (size_t i = 0; i < list->count; i++)
        list->slots[find_slot(list, list->items[i])] = (uint32_t)(i + 1);
}

/// Makes room for one more.
static glint_status grow(glint_list *list, glint_error *error)
{
    if (list->count < list->capacity)
        return GLINT_OK;
    const size_t capacity = list->capacity ? 2 * list->capacity : 8;
    void **items = realloc(list->items, capacity * sizeof *items);
    if (!items)
        return glint_fail_nomem(error);
    list->items = items;
    uint32_t *slots = malloc(2 * capacity * sizeof *slots);
    if (!slots)
        return glint_fail_nomem(error);
    free(list->slots);
    list->slots = slots;
    list->slot_count = 2 * capacity;
    list->capacity = capacity;
    fill_slots(list);
    return GLINT_OK;
}

static glint_status add(glint_list *list, void *object, const char *what, glint_error *error)
{
    glint_status status = grow(list, error);
    if (status)
        return status;
    const size_t slot = find_slot(list, object);
    if (list->slots[slot])
        return glint_fail(error, GLINT_ERR_INVALID, "%s: already in the scene", what);
    list->items[list->count++] = object;
    list->slots[slot] = (uint32_t)list->count;
    return GLINT_OK;
}

static glint_status drop(glint_list *list, const void *object, const char *what, glint_error *error)
{
    const size_t place = list->count ? list->slots[find_slot(list, object)] : 0;
    if (!place)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: not in the scene", what);
    memmove(list->items + place - 1, list->items + place, (list->count - place) * sizeof *list->items);
    list->count--;
    fill_slots(list);
    return GLINT_OK;
}

glint_status glint_scene_add_shape(glint_scene *scene, glint_shape *shape, glint_error *error)
{
    glint_status status = add(&scene->shapes, shape, "shape", error);
    if (!status)
        glint_shape_retain(shape);
    return status;
}

glint_status glint_scene_add_light(glint_scene *scene, glint_light *light, glint_error *error)
{
    glint_status status = add(&scene->lights, light, "light", error);
    if (!status)
        glint_light_retain(light);
    return status;
}

glint_status glint_scene_remove_shape(glint_scene *scene, glint_shape *shape, glint_error *error)
{
    glint_status status = drop(&scene->shapes, shape, "shape", error);
    if (!status)
        glint_shape_release(shape);
    return status;
}

glint_status glint_scene_remove_light(glint_scene *scene, glint_light *light, glint_error *error)
{
    glint_status status = drop(&scene->lights, light, "light", error);
    if (!status)
        glint_light_release(light);
    return status;
}

size_t glint_scene_shape_count(const glint_scene *scene)
{
    return scene->shapes.count;
}

size_t glint_scene_light_count(const glint_scene *scene)
{
    return scene->lights.count;
}
