/// The fields of a scene that have derivatives, and their slopes.
#include "engine/base/status.h"
#include "engine/render/effects/derivative/slopes.h"
#include "engine/render/program/program.h"
#include "engine/render/scene/fields.h"

#include <stdio.h>
#include <string.h>

/// Fields of descriptions that scripts cannot derive by, or not by that name; the rest are in the objects' own tables.
#define FIELD(desc, field, kind) \
    { .name = #field, .member = #field, .type = GLINT_TYPE_##kind, .offset = offsetof(glint_##desc##_desc, field), .takes = GLINT_TAKES_VARIABLE }
#define LIST(...) (const glint_object_field[]) { __VA_ARGS__, { .name = NULL } }

static const glint_object_field *const camera_fields =
    LIST(FIELD(camera, eye, VECTOR), FIELD(camera, at, VECTOR), FIELD(camera, direction, VECTOR), FIELD(camera, up, VECTOR),
         FIELD(camera, fov_y_rad, NUMBER), FIELD(camera, height, NUMBER), FIELD(camera, aperture, NUMBER),
         FIELD(camera, focus, NUMBER), FIELD(camera, focus_point, VECTOR));
static const glint_object_field *const scene_fields =
    LIST(FIELD(scene, ambient, VECTOR), FIELD(scene, background, VECTOR), FIELD(scene, depth_cue_color, VECTOR),
         FIELD(scene, depth_cue_near, NUMBER), FIELD(scene, depth_cue_far, NUMBER));

static bool has_derivative(const glint_object_field *field) { return field->takes & GLINT_TAKES_VARIABLE; }

static const glint_object_field *find_field(const glint_object_field *fields, const char *name)
{
    for (; name && fields->name; fields++)
        if (has_derivative(fields) && strcmp(fields->member, name) == 0)
            return fields;
    return NULL;
}

static glint_status refuse_field(const glint_derivative *d, const char *object, const char *field,
                                 const glint_object_field *offered, glint_error *error)
{
    char list[256] = "";
    size_t used = 0;
    for (; offered->name; offered++)
        if (has_derivative(offered))
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", offered->member);
    return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': %s.%s: this field has no derivative; fields of %s "
                                                "that have one: %s",
                      d->name, object, field ? field : "(null)", object, used ? list : "none");
}

static void add(void *desc, const glint_object_field *field, const double slope[3])
{
    double *to = (double *)((char *)desc + field->offset);
    for (int c = 0; c < (field->type >= GLINT_TYPE_VECTOR ? 3 : 1); c++)
        to[c] += slope[c];
}

/// Returns the field of that name, if its programs have derivatives; otherwise GLINT_FIELD_COUNT.
static int find_program_field(const char *name)
{
    for (int field = 0; field < GLINT_FIELD_COUNT; field++)
        if ((field < GLINT_FIELD_PLANES || field == GLINT_FIELD_SHADER) && field != GLINT_FIELD_REST && field != GLINT_FIELD_CLEAR &&
            name && strcmp(name, glint_field_name(field)) == 0)
            return field;
    return GLINT_FIELD_COUNT;
}

static glint_status add_program(const glint_plan *plan, const glint_derivative *d, const glint_slope *s,
                                glint_scene_slopes *out, glint_error *error)
{
    const glint_list *list = &plan->geometry->materials;
    const size_t i = glint_list_find(list, s->material);
    const int field = find_program_field(s->field);
    if (i == list->count)
        return GLINT_OK;
    if (field == GLINT_FIELD_COUNT)
        return refuse_field(d, "material", s->field, glint_material_fields, error);
    const glint_program *own = plan->patterns ? plan->patterns->of[i].program[field] : NULL;
    if (!own && glint_pattern_program_of(&s->material->desc, field)) // the number is not read
        return GLINT_OK;
    if (!own || own->code.output_count != s->program->code.output_count || own->kind != s->program->kind)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "derivative '%s': material.%s: the slope has a program, but it is not the program of this field", d->name,
                          s->field);
    if (plan->translucent && plan->translucent[i].blends && field != GLINT_FIELD_SHININESS && field != GLINT_FIELD_ROUGHNESS)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "derivative '%s': material.%s: a pattern of a translucent material has no derivative; use "
                          "an opaque material", d->name, s->field);
    plan->patterns->of[i].repaints = plan->patterns->of[i].repaints || field < GLINT_FIELD_PLANES;
    if (plan->patterns->row_count < s->program->code.row_count)
        plan->patterns->row_count = s->program->code.row_count;
    glint_program_release((glint_program *)(uintptr_t)out->programs[i].of[field]);
    out->programs[i].of[field] = glint_program_retain((glint_program *)(uintptr_t)s->program);
    return GLINT_OK;
}

/// Returns whether a slope of `specular` belongs to a channel that is 0, so that the highlight's pattern has no plane.
static bool is_lost(const glint_material_desc *desc, const glint_slope *s)
{
    const bool facets = desc->model == GLINT_MODEL_COOK_TORRANCE;
    const glint_program *shape = facets ? desc->program.roughness : desc->program.shininess;
    const bool needs_all = !facets && desc->normalized;
    bool lost = false;
    if (strcmp(s->field, "specular") != 0 || !shape || desc->program.specular || desc->program.shader ||
        desc->model == GLINT_MODEL_LAMBERT)
        return false;
    for (int c = 0; c < 3; c++)
        lost = lost || (s->slope[c] != 0 && desc->specular[c] == 0);
    return lost && (needs_all || !glint_material_is_shiny(desc));
}

static glint_status add_material(const glint_plan *plan, const glint_derivative *d, const glint_slope *s,
                                 glint_scene_slopes *out, glint_error *error)
{
    if (s->program)
        return add_program(plan, d, s, out, error);
    const glint_list *list = &plan->geometry->materials;
    const glint_object_field *field = find_field(glint_material_fields, s->field);
    if (!field)
        return refuse_field(d, "material", s->field, glint_material_fields, error);
    for (size_t i = 0; i < list->count; i++) {
        if (list->items[i] != s->material)
            continue;
        if (is_lost(&s->material->desc, s))
            return glint_fail(error, GLINT_ERR_INVALID,
                              "derivative '%s': material.specular: 0 has no derivative where a pattern gives the "
                              "highlight's shape; use a value above 0", d->name);
        add(&out->materials[i], field, s->slope);
    }
    return GLINT_OK;
}

static glint_status add_light(const glint_scene *scene, const glint_derivative *d, const glint_slope *s,
                              glint_scene_slopes *out, glint_error *error)
{
    const glint_object_field *fields = glint_light_fields[s->light->desc.kind], *field = find_field(fields, s->field);
    char name[2 * GLINT_NAME_SIZE];
    if (!field) {
        glint_describe_light(&s->light->desc, 0, name, sizeof name);
        name[strcspn(name, " ")] = '\0';
        return refuse_field(d, name, s->field, fields, error);
    }
    for (size_t i = 0; i < scene->lights.count; i++)
        if (scene->lights.items[i] == s->light)
            add(&out->lights[i], field, s->slope);
    return GLINT_OK;
}

static glint_status add_shape(const glint_plan *plan, const glint_derivative *d, const glint_slope *s,
                              glint_scene_slopes *out, glint_error *error)
{
    const glint_shape_kind kind = s->shape->desc.kind;
    const glint_object_field *field = find_field(glint_shape_fields[kind], s->field);
    if (!field)
        return refuse_field(d, kind == GLINT_SHAPE_SPHERE ? "sphere" : kind == GLINT_SHAPE_PLANE ? "plane" : "shape", s->field,
                            glint_shape_fields[kind], error);
    for (uint32_t i = 0; i < plan->geometry->part_count; i++)
        if (plan->geometry->parts[i].shape == s->shape)
            add(&out->shapes[i], field, s->slope);
    return GLINT_OK;
}

static glint_status add_camera(const glint_scene *scene, const glint_derivative *d, const glint_slope *s,
                               glint_scene_slopes *out, glint_error *error)
{
    const glint_object_field *field = find_field(camera_fields, s->field);
    if (!field)
        return refuse_field(d, "camera", s->field, camera_fields, error);
    if (scene->desc.camera == s->camera)
        add(&out->camera, field, s->slope);
    return GLINT_OK;
}

glint_status glint_derivative_add(const glint_plan *plan, const glint_scene *scene, const glint_derivative *d,
                              const glint_slope *s, glint_scene_slopes *out, glint_error *error)
{
    for (int c = 0; c < 3; c++)
        if (!isfinite(s->slope[c]))
            return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': %s: finite slopes expected, got %g", d->name,
                              s->field ? s->field : "(null)", s->slope[c]);
    if (s->program && !s->material)
        return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': %s: the numbers of its program have no "
                                                    "derivative; only the numbers of materials' programs have", d->name, s->field ? s->field : "(null)");
    if (s->material)
        return add_material(plan, d, s, out, error);
    if (s->light)
        return add_light(scene, d, s, out, error);
    if (s->shape)
        return add_shape(plan, d, s, out, error);
    if (s->camera)
        return add_camera(scene, d, s, out, error);
    const glint_object_field *field = find_field(scene_fields, s->field);
    if (!field)
        return refuse_field(d, "scene", s->field, scene_fields, error);
    add(&out->scene, field, s->slope);
    return GLINT_OK;
}
