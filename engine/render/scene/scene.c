#include "engine/base/status.h"
#include "engine/glint_programs.h"
#include "engine/render/scene/fields.h"
#include "engine/render/scene/objects.h"
#include "engine/render/stages/stages.h"

#include <math.h>
#include <stdlib.h>

// ---- The table of fields ----

typedef glint_scene_desc DESC;

static const char *const cameras[] = { "glint.camera", NULL };

#define GIVEN(field) .set_offset = offsetof(DESC, field)

static const glint_object_field depth_cue_parts[] = {
    { GLINT_NAMED("color", depth_cue_color, COLOR), GIVEN(has_depth_cue_color), .follows = "background" },
    { GLINT_NAMED("near", depth_cue_near, NUMBER), .low = 0, .high = DBL_MAX, .expected = "finite number >= 0" },
    { GLINT_NAMED("far", depth_cue_far, NUMBER), .required = true },
    { .name = NULL },
};

static const glint_object_field indirect_parts[] = {
    { GLINT_NAMED("samples", indirect_samples, WHOLE), .low = 1, .high = 65536, .initial = { 16 } },
    { GLINT_NAMED("bounces", indirect_bounces, WHOLE), .low = 0, .high = 0x1p31, .initial = { 2 } },
    { .name = NULL },
};

static const glint_object_field ambient_occlusion_parts[] = {
    { GLINT_NAMED("samples", ambient_occlusion_samples, WHOLE), .low = 1, .high = 65536, .initial = { 16 } },
    { GLINT_NAMED("distance", ambient_occlusion_distance, NUMBER), .low = 4.9406564584124654e-324, .high = HUGE_VAL,
      .expected = "number > 0", .initial = { HUGE_VAL } },
    { .name = NULL },
};

const glint_object_field glint_scene_fields[] = {
    { GLINT_ROW(camera, OBJECT), .names = cameras, .doc = "required for a frame; nil: no camera" },
    { GLINT_ROW(ambient, COLOR), .takes = GLINT_TAKES_VARIABLE, .doc = "ambient light, >= 0" },
    { GLINT_ROW(background, COLOR), .program_offset = offsetof(DESC, background_program),
      .takes = GLINT_TAKES_PATTERN | GLINT_TAKES_TEXTURE | GLINT_TAKES_VARIABLE,
      .doc = "colour of rays that hit nothing, >= 0. In a pattern, p is the unit direction of the ray; a texture is "
             "a panorama of all directions with -z in its middle, +x three quarters from the left, +y at the top" },
    { .name = "depth_cue", .type = GLINT_TYPE_TABLE, GIVEN(has_depth_cue), .parts = depth_cue_parts,
      .doc = "light fades to color (default: the background, if it is a plain colour) from distance near (default 0) "
             "to far. Default nil: no fading" },
    { .name = "indirect", .type = GLINT_TYPE_TABLE, GIVEN(has_indirect), .parts = indirect_parts,
      .doc = "light from surface to surface instead of `ambient`, with a number of samples (16) and bounces (2). The "
             "excess of a material's `ambient` over its `diffuse` remains as emitted light. Default nil: off" },
    { .name = "ambient_occlusion", .type = GLINT_TYPE_TABLE, GIVEN(has_ambient_occlusion), .parts = ambient_occlusion_parts,
      .doc = "ambient light reduced by nearby surfaces, with a number of samples (16), up to a distance (infinite); "
             "not together with indirect. Default nil: off" },
    { GLINT_ROW(reflection_samples, WHOLE), .low = 0, .high = 65536, .initial = { 16 },
      .doc = "number of rays that a rough surface reflects or refracts for each sample of a pixel that shows it. 0: "
             "rough surfaces show lamps only" },
    { .name = NULL },
};

static glint_scene_desc defaults(void)
{
    glint_scene_desc desc = { .struct_size = sizeof desc };
    glint_fields_reset(glint_scene_fields, &desc);
    return desc;
}

void glint_scene_desc_init(glint_scene_desc *desc, size_t size)
{
    const glint_scene_desc full = defaults();
    glint_desc_write(desc, size, &full, sizeof full);
}

glint_status glint_scene_create(glint_scene **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    glint_scene *scene = calloc(1, sizeof *scene);
    if (!scene)
        return glint_fail_nomem(error);
    scene->references = 1;
    scene->desc = defaults();
    *out = scene;
    return GLINT_OK;
}

/// Checks the combination of fields.
static glint_status check_together(const glint_scene_desc *desc, glint_error *error)
{
    const glint_program *program = desc->background_program;
    if (program && glint_program_kind_of(program) != GLINT_PROGRAM_PATTERN)
        return glint_fail(error, GLINT_ERR_INVALID, "background: a pattern expected, got a shader");
    if (program && desc->has_depth_cue && !desc->has_depth_cue_color)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "depth_cue.color: a colour expected, because its default, the background, is a pattern");
    if (desc->has_depth_cue && !(desc->depth_cue_far > desc->depth_cue_near && isfinite(desc->depth_cue_far)))
        return glint_fail(error, GLINT_ERR_INVALID, "depth_cue.far: expected a finite number above near (%.10g), got %.10g",
                          desc->depth_cue_near, desc->depth_cue_far);
    if (desc->has_indirect && desc->has_ambient_occlusion)
        return glint_fail(error, GLINT_ERR_INVALID, "ambient_occlusion: either this or indirect expected, because "
                                                    "indirect light already includes the occlusion");
    return GLINT_OK;
}

glint_status glint_scene_set(glint_scene *scene, const glint_scene_desc *given, glint_error *error)
{
    GLINT_REFUSE_NULL(scene, error);
    GLINT_TAKE_DESC(glint_scene_desc, defaults());
    if (desc->background_program && glint_pattern_numbers(desc->background_program, GLINT_REFLECTANCE_MAX, full.background))
        full.background_program = NULL;
    status = glint_fields_check(glint_scene_fields, desc, error);
    if (!status)
        status = check_together(desc, error);
    if (status)
        return status;
    glint_camera_retain(desc->camera);
    glint_camera_release(scene->desc.camera);
    glint_program_retain(desc->background_program);
    glint_program_release(scene->desc.background_program);
    scene->desc = *desc;
    return GLINT_OK;
}

const glint_scene_desc *glint_scene_get(const glint_scene *scene) { return scene ? &scene->desc : NULL; }

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

static glint_status add(glint_list *list, void *object, const char *name, glint_error *error)
{
    if (glint_list_find(list, object) < list->count)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: already in the scene", name);
    return glint_list_add(list, object, error);
}

static glint_status drop(glint_list *list, const void *object, const char *name, glint_error *error)
{
    const size_t index = glint_list_find(list, object);
    if (index == list->count)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: not in the scene", name);
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

size_t glint_scene_shape_count(const glint_scene *scene) { return scene ? scene->shapes.count : 0; }

size_t glint_scene_light_count(const glint_scene *scene) { return scene ? scene->lights.count : 0; }

size_t glint_scene_overlay_count(const glint_scene *scene) { return scene ? scene->overlays.count : 0; }

glint_shape *glint_scene_shape_at(const glint_scene *scene, size_t index)
{
    return index < glint_scene_shape_count(scene) ? glint_scene_shape(scene, index) : NULL;
}

glint_light *glint_scene_light_at(const glint_scene *scene, size_t index)
{
    return index < glint_scene_light_count(scene) ? glint_scene_light(scene, index) : NULL;
}

glint_overlay *glint_scene_overlay_at(const glint_scene *scene, size_t index)
{
    return index < glint_scene_overlay_count(scene) ? scene->overlays.items[index] : NULL;
}
