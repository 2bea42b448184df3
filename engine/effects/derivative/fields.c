/// The fields of a scene that have derivatives, and their slopes.
#include "engine/base/status.h"
#include "engine/effects/derivative/slopes.h"
#include "engine/program/program.h"

#include <stdio.h>
#include <string.h>

typedef struct slope_field {
    const char *name;
    size_t offset;
    int count; ///< components
    unsigned kinds; ///< kinds of lights that have it, one bit each
} slope_field;

#define MATERIAL(name, count) { #name, offsetof(glint_material_desc, name), count, 0 }
#define LIGHT(name, count, kinds) { #name, offsetof(glint_light_desc, name), count, kinds }
#define SCENE(name, count) { #name, offsetof(glint_scene_desc, name), count, 0 }
#define KIND(name) (1u << GLINT_LIGHT_##name)
#define AREA (KIND(DISK) | KIND(POLYGON) | KIND(SPHERE))
#define ALL (KIND(POINT) | KIND(DIRECTIONAL) | KIND(SPOT) | AREA)

static const slope_field material_fields[] = {
    MATERIAL(diffuse, 3),   MATERIAL(ambient, 3), MATERIAL(specular, 3), MATERIAL(shininess, 1),
    MATERIAL(roughness, 1), MATERIAL(f0, 3),      MATERIAL(mirror, 3),   MATERIAL(transmission, 3),
    MATERIAL(ior, 1),       MATERIAL(absorption, 3), MATERIAL(opacity, 1), { NULL, 0, 0, 0 },
};
static const slope_field light_fields[] = {
    LIGHT(color, 3, ALL),
    LIGHT(intensity, 1, ALL),
    LIGHT(ambient, 3, ALL),
    LIGHT(diffuse, 3, ALL),
    LIGHT(specular, 3, ALL),
    LIGHT(attenuation, 3, ALL & ~KIND(DIRECTIONAL)),
    LIGHT(position, 3, ALL & ~(KIND(DIRECTIONAL) | KIND(POLYGON))),
    LIGHT(direction, 3, KIND(DIRECTIONAL) | KIND(SPOT)),
    LIGHT(inner_rad, 1, KIND(SPOT)),
    LIGHT(outer_rad, 1, KIND(SPOT)),
    LIGHT(exponent, 1, KIND(SPOT)),
    LIGHT(radiance, 1, AREA),
    { NULL, 0, 0, 0 },
};
#define SHAPE(name, count, kind) { #name, offsetof(glint_shape_desc, name), count, 1u << GLINT_SHAPE_##kind }
#define CAMERA(name, count) { #name, offsetof(glint_camera_desc, name), count, 0 }
static const slope_field shape_fields[] = {
    SHAPE(center, 3, SPHERE), SHAPE(radius, 1, SPHERE), SHAPE(point, 3, PLANE), SHAPE(normal, 3, PLANE),
    { NULL, 0, 0, 0 },
};
static const slope_field camera_fields[] = {
    CAMERA(eye, 3), CAMERA(at, 3), CAMERA(direction, 3), CAMERA(up, 3), CAMERA(fov_y_rad, 1),
    CAMERA(height, 1), CAMERA(aperture, 1), CAMERA(focus, 1), CAMERA(focus_point, 3), { NULL, 0, 0, 0 },
};
static const slope_field scene_fields[] = {
    SCENE(ambient, 3),        SCENE(background, 3),    SCENE(depth_cue_color, 3),
    SCENE(depth_cue_near, 1), SCENE(depth_cue_far, 1), { NULL, 0, 0, 0 },
};

/// kinds: the kinds of objects that have the field, one bit each; 0: all.
static const slope_field *find_field(const slope_field *fields, const char *name, unsigned kinds)
{
    for (; name && fields->name; fields++)
        if (strcmp(fields->name, name) == 0 && (fields->kinds & kinds) == kinds)
            return fields;
    return NULL;
}

static glint_status refuse_field(const glint_derivative *d, const char *object, const char *field,
                                 const slope_field *offered, unsigned kinds, glint_error *error)
{
    char list[256] = "";
    size_t used = 0;
    for (; offered->name; offered++)
        if (offered->kinds == kinds || offered->kinds & kinds)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", offered->name);
    return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': %s.%s: no derivative goes through this field; of %s: %s",
                      d->name, object, field ? field : "(null)", object, used ? list : "none");
}

static void add(void *desc, const slope_field *field, const double slope[3])
{
    double *to = (double *)((char *)desc + field->offset);
    for (int c = 0; c < field->count; c++)
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
        return refuse_field(d, "material", s->field, material_fields, 0, error);
    const glint_program *own = plan->patterns ? plan->patterns->of[i].program[field] : NULL;
    if (!own && glint_pattern_program_of(&s->material->desc.program, field)) // the number is not read
        return GLINT_OK;
    if (!own || own->code.output_count != s->program->code.output_count || own->kind != s->program->kind)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "derivative '%s': material.%s: the slope is a program's, but not of the one that gives the field", d->name,
                          s->field);
    if (plan->translucent && plan->translucent[i].blends && field != GLINT_FIELD_SHININESS && field != GLINT_FIELD_ROUGHNESS)
        return glint_fail(error, GLINT_ERR_INVALID,
                          "derivative '%s': material.%s: a pattern of a translucent material has no derivative; one of an opaque "
                          "material has", d->name, s->field);
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
    const slope_field *field = find_field(material_fields, s->field, 0);
    if (!field)
        return refuse_field(d, "material", s->field, material_fields, 0, error);
    for (size_t i = 0; i < list->count; i++) {
        if (list->items[i] != s->material)
            continue;
        if (is_lost(&s->material->desc, s))
            return glint_fail(error, GLINT_ERR_INVALID,
                              "derivative '%s': material.specular: 0 has no derivative where a pattern gives the highlight's shape; "
                              "above 0 it has", d->name);
        add(&out->materials[i], field, s->slope);
    }
    return GLINT_OK;
}

static glint_status add_light(const glint_scene *scene, const glint_derivative *d, const glint_slope *s,
                              glint_scene_slopes *out, glint_error *error)
{
    const unsigned kind = 1u << s->light->desc.kind;
    const slope_field *field = find_field(light_fields, s->field, kind);
    char name[2 * GLINT_NAME_SIZE];
    if (!field) {
        glint_describe_light(&s->light->desc, 0, name, sizeof name);
        name[strcspn(name, " ")] = '\0';
        return refuse_field(d, name, s->field, light_fields, kind, error);
    }
    for (size_t i = 0; i < scene->lights.count; i++)
        if (scene->lights.items[i] == s->light)
            add(&out->lights[i], field, s->slope);
    return GLINT_OK;
}

static glint_status add_shape(const glint_plan *plan, const glint_derivative *d, const glint_slope *s,
                              glint_scene_slopes *out, glint_error *error)
{
    const unsigned kind = 1u << s->shape->desc.kind;
    const slope_field *field = find_field(shape_fields, s->field, kind);
    const bool known = kind & (1u << GLINT_SHAPE_SPHERE | 1u << GLINT_SHAPE_PLANE);
    if (!field)
        return refuse_field(d, kind == 1u << GLINT_SHAPE_SPHERE ? "sphere" : known ? "plane" : "shape", s->field,
                            shape_fields, known ? kind : 1u << 31, error);
    for (uint32_t i = 0; i < plan->geometry->part_count; i++)
        if (plan->geometry->parts[i].shape == s->shape)
            add(&out->shapes[i], field, s->slope);
    return GLINT_OK;
}

static glint_status add_camera(const glint_scene *scene, const glint_derivative *d, const glint_slope *s,
                               glint_scene_slopes *out, glint_error *error)
{
    const slope_field *field = find_field(camera_fields, s->field, 0);
    if (!field)
        return refuse_field(d, "camera", s->field, camera_fields, 0, error);
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
        return glint_fail(error, GLINT_ERR_INVALID, "derivative '%s': %s: the numbers of its program have no derivative; those of "
                          "materials have", d->name, s->field ? s->field : "(null)");
    if (s->material)
        return add_material(plan, d, s, out, error);
    if (s->light)
        return add_light(scene, d, s, out, error);
    if (s->shape)
        return add_shape(plan, d, s, out, error);
    if (s->camera)
        return add_camera(scene, d, s, out, error);
    const slope_field *field = find_field(scene_fields, s->field, 0);
    if (!field)
        return refuse_field(d, "scene", s->field, scene_fields, 0, error);
    add(&out->scene, field, s->slope);
    return GLINT_OK;
}
