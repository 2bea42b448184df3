#include "engine/base/status.h"
#include "engine/scene/objects.h"
#include "engine/stages/stages.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

glint_status glint_scene_create(glint_scene **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    glint_scene *scene = calloc(1, sizeof *scene);
    if (!scene)
        return glint_fail_nomem(error);
    scene->references = 1;
    *out = scene;
    return GLINT_OK;
}

static glint_status check_depth_cue(const glint_scene_desc *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    if (desc->has_depth_cue_color)
        status = glint_check_color("depth_cue.color", desc->depth_cue_color, error);
    if (!status)
        status = glint_check_range("depth_cue.near", desc->depth_cue_near, 0, DBL_MAX, "finite number >= 0", error);
    if (!status && !(desc->depth_cue_far > desc->depth_cue_near && isfinite(desc->depth_cue_far)))
        status =
            glint_fail(error, GLINT_ERR_INVALID, "depth_cue.far: finite number above near, %.10g, expected, got %.10g",
                       desc->depth_cue_near, desc->depth_cue_far);
    return status;
}

static glint_status check_background(const glint_scene_desc *desc, glint_error *error)
{
    const glint_program *program = desc->background_program;
    if (program && glint_program_kind_of(program) != GLINT_PROGRAM_PATTERN)
        return glint_fail(error, GLINT_ERR_INVALID, "background: a pattern expected, got a shader");
    if (program && desc->has_depth_cue && !desc->has_depth_cue_color)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "depth_cue.color: a colour expected where the background, which it follows, is a pattern");
    return glint_check_color("background", desc->background, error);
}

static glint_status check_ambient_occlusion(const glint_scene_desc *desc, glint_error *error)
{
    if (desc->has_indirect)
        return glint_fail(error, GLINT_ERR_INVALID, "ambient_occlusion: either this or indirect expected: indirect light "
                                                    "is dim where little of the sky is open by itself");
    glint_status status = glint_check_whole("ambient_occlusion.samples", desc->ambient_occlusion_samples, 1, 65536, error);
    if (!status && !(desc->ambient_occlusion_distance > 0))
        status = glint_fail(error, GLINT_ERR_INVALID, "ambient_occlusion.distance: number > 0 expected, got %.15g",
                            desc->ambient_occlusion_distance);
    return status;
}

glint_status glint_scene_set(glint_scene *scene, const glint_scene_desc *given, glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    if (!given)
        return glint_fail(error, GLINT_ERR_INVALID, "desc: pointer expected, got NULL");
    glint_scene_desc folded = *given;
    const glint_scene_desc *desc = &folded;
    if (given->background_program &&
        glint_pattern_numbers(given->background_program, GLINT_REFLECTANCE_MAX, folded.background))
        folded.background_program = NULL;
    glint_status status = glint_check_color("ambient", desc->ambient, error);
    if (!status)
        status = check_background(desc, error);
    if (!status && desc->has_depth_cue)
        status = check_depth_cue(desc, error);
    if (!status && desc->has_indirect)
        status = glint_check_whole("indirect.samples", desc->indirect_samples, 1, 65536, error);
    if (!status && desc->has_indirect)
        status = glint_check_whole("indirect.bounces", desc->indirect_bounces, 0, 0x1p31, error);
    if (!status && desc->has_ambient_occlusion)
        status = check_ambient_occlusion(desc, error);
    if (status)
        return status;
    glint_camera_retain(desc->camera);
    glint_camera_release(scene->desc.camera);
    glint_program_retain(desc->background_program);
    glint_program_release(scene->desc.background_program);
    scene->desc = *desc;
    return GLINT_OK;
}

const glint_scene_desc *glint_scene_get(const glint_scene *scene) { return &scene->desc; }

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
    for (size_t i = 0; i < scene->overlays.count; i++)
        glint_overlay_release(glint_scene_overlay_at(scene, i));
    glint_camera_release(scene->desc.camera);
    glint_program_release(scene->desc.background_program);
    glint_geometry_release(scene->geometry);
    glint_list_free(&scene->shapes);
    glint_list_free(&scene->lights);
    glint_list_free(&scene->overlays);
    free(scene);
}

static glint_status add(glint_list *list, void *object, const char *what, glint_error *error)
{
    if (glint_list_find(list, object) < list->count)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: already in the scene", what);
    return glint_list_add(list, object, error);
}

static glint_status drop(glint_list *list, const void *object, const char *what, glint_error *error)
{
    const size_t index = glint_list_find(list, object);
    if (index == list->count)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: not in the scene", what);
    glint_list_remove(list, index);
    return GLINT_OK;
}

glint_status glint_scene_add_shape(glint_scene *scene, glint_shape *shape, glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    GLINT_REFUSE_NULL(shape, error);
    glint_status status = add(&scene->shapes, shape, "shape", error);
    if (!status)
        glint_shape_retain(shape);
    return status;
}

glint_status glint_scene_add_light(glint_scene *scene, glint_light *light, glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    GLINT_REFUSE_NULL(light, error);
    glint_status status = add(&scene->lights, light, "light", error);
    if (!status)
        glint_light_retain(light);
    return status;
}

glint_status glint_scene_add_overlay(glint_scene *scene, glint_overlay *overlay, glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    GLINT_REFUSE_NULL(overlay, error);
    glint_status status = add(&scene->overlays, overlay, "overlay", error);
    if (!status)
        glint_overlay_retain(overlay);
    return status;
}

glint_status glint_scene_remove_shape(glint_scene *scene, glint_shape *shape, glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    GLINT_REFUSE_NULL(shape, error);
    glint_status status = drop(&scene->shapes, shape, "shape", error);
    if (!status)
        glint_shape_release(shape);
    return status;
}

glint_status glint_scene_remove_light(glint_scene *scene, glint_light *light, glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    GLINT_REFUSE_NULL(light, error);
    glint_status status = drop(&scene->lights, light, "light", error);
    if (!status)
        glint_light_release(light);
    return status;
}

glint_status glint_scene_remove_overlay(glint_scene *scene, glint_overlay *overlay, glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    GLINT_REFUSE_NULL(overlay, error);
    glint_status status = drop(&scene->overlays, overlay, "overlay", error);
    if (!status)
        glint_overlay_release(overlay);
    return status;
}

size_t glint_scene_shape_count(const glint_scene *scene) { return scene->shapes.count; }

size_t glint_scene_light_count(const glint_scene *scene) { return scene->lights.count; }

size_t glint_scene_overlay_count(const glint_scene *scene) { return scene->overlays.count; }

glint_shape *glint_scene_shape_at(const glint_scene *scene, size_t index) { return glint_scene_shape(scene, index); }

glint_light *glint_scene_light_at(const glint_scene *scene, size_t index) { return glint_scene_light(scene, index); }

glint_overlay *glint_scene_overlay_at(const glint_scene *scene, size_t index) { return scene->overlays.items[index]; }
