#include "engine/base/status.h"
#include "engine/objects.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

glint_light_desc glint_light_desc_default(glint_light_kind kind)
{
    return (glint_light_desc) { .kind = kind,
                                .color = { 1, 1, 1 },
                                .intensity = 1,
                                .attenuation = { 1, 0, 0 },
                                .shadows = true,
                                .direction = { 0, -1, 0 } };
}

static glint_status check_colors(const glint_light_desc *desc, glint_error *error)
{
    glint_status status = glint_check_color("color", desc->color, error);
    if (!status)
        status = glint_check_color("ambient", desc->ambient, error);
    if (!status && desc->has_diffuse)
        status = glint_check_color("diffuse", desc->diffuse, error);
    if (!status && desc->has_specular)
        status = glint_check_color("specular", desc->specular, error);
    return status;
}

static glint_status check(const glint_light_desc *desc, glint_error *error)
{
    glint_status status = check_colors(desc, error);
    if (!status)
        status = glint_check_range("intensity", desc->intensity, 0, 1.7976931348623157e308, "number >= 0", error);
    if (!status)
        status = glint_check_color("attenuation", desc->attenuation, error);
    const double *a = desc->attenuation;
    if (!status && a[0] == 0 && a[1] == 0 && a[2] == 0)
        status = glint_fail(error, GLINT_ERR_INVALID, "attenuation: one number > 0 expected, got {0, 0, 0}");
    if (!status && desc->kind == GLINT_LIGHT_POINT)
        status = glint_check_vector("position", desc->position, error);
    if (!status && desc->kind == GLINT_LIGHT_DIRECTIONAL)
        status = glint_check_direction("direction", desc->direction, error);
    return status;
}

glint_status glint_light_create(const glint_light_desc *desc, glint_light **out, glint_error *error)
{
    if (desc->kind > GLINT_LIGHT_DIRECTIONAL)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: no such kind of light");
    glint_status status = check(desc, error);
    if (status)
        return status;
    glint_light *light = malloc(sizeof *light);
    if (!light)
        return glint_fail_nomem(error);
    *light = (glint_light) { .references = 1, .desc = *desc };
    *out = light;
    return GLINT_OK;
}

glint_status glint_light_set(glint_light *light, const glint_light_desc *desc, glint_error *error)
{
    if (desc->kind != light->desc.kind)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: a light cannot become one of another kind");
    glint_status status = check(desc, error);
    if (!status)
        light->desc = *desc;
    return status;
}

const glint_light_desc *glint_light_get(const glint_light *light) { return &light->desc; }

glint_light *glint_light_retain(glint_light *light)
{
    if (light)
        light->references++;
    return light;
}

void glint_light_release(glint_light *light)
{
    if (light && --light->references == 0)
        free(light);
}

void glint_describe_light(const glint_light_desc *desc, size_t number, char *out, size_t size)
{
    const char *kind = desc->kind == GLINT_LIGHT_POINT ? "point_light" : "directional_light";
    if (desc->name[0])
        snprintf(out, size, "%s '%s'", kind, desc->name);
    else
        snprintf(out, size, "%s #%zu", kind, number);
}
