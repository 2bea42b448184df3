#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/scene/area_light.h"
#include "engine/scene/objects.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 0x1.921fb54442d18p+1

glint_light_desc glint_light_desc_default(glint_light_kind kind)
{
    return (glint_light_desc) { .kind = kind,
                                .color = { 1, 1, 1 },
                                .intensity = 1,
                                .attenuation = { 1, 0, 0 },
                                .shadows = true,
                                .direction = { 0, -1, 0 },
                                .inner_rad = 20 * PI / 180,
                                .outer_rad = 30 * PI / 180,
                                .normal = { 0, -1, 0 },
                                .radius = 1,
                                .samples = 16 };
}

static bool has_area(glint_light_kind kind)
{
    return kind == GLINT_LIGHT_DISK || kind == GLINT_LIGHT_POLYGON || kind == GLINT_LIGHT_SPHERE;
}

// ---- Checks ----

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

static glint_status check_spot(const glint_light_desc *desc, glint_error *error)
{
    const double inner = desc->inner_rad, outer = desc->outer_rad;
    glint_status status = glint_check_direction("direction", desc->direction, error);
    if (!status)
        status = glint_check_range("exponent", desc->exponent, 0, DBL_MAX, "number >= 0", error);
    if (!status && !(0 <= inner && inner <= outer && outer <= PI))
        status = glint_fail(error, GLINT_ERR_INVALID,
                            "%s: half angles 0 <= inner <= outer <= 180 expected, got inner %.12g and outer %.12g",
                            outer <= PI ? "inner" : "outer", inner * 180 / PI, outer * 180 / PI);
    return status;
}

static glint_status check_area(const glint_light_desc *desc, glint_error *error)
{
    glint_status status = glint_check_whole("samples", desc->samples, 1, 65536, error);
    if (!status && desc->has_radiance)
        status = glint_check_range("radiance", desc->radiance, 0, DBL_MAX, "number >= 0", error);
    if (!status && desc->has_radiance && desc->intensity != 1)
        status =
            glint_fail(error, GLINT_ERR_INVALID, "intensity: 1 expected beside a radiance, got %.15g", desc->intensity);
    if (!status &&
        (desc->shadow > GLINT_SHADOW_CAPS || (desc->shadow == GLINT_SHADOW_CAPS && desc->kind != GLINT_LIGHT_SPHERE)))
        status = glint_fail(error, GLINT_ERR_INVALID, "shadow: rays or hard expected, caps of a sphere light alone");
    const double *a = desc->attenuation;
    if (!status && desc->shadow == GLINT_SHADOW_CAPS && desc->has_radiance && (a[0] != 1 || a[1] != 0 || a[2] != 0))
        status =
            glint_fail(error, GLINT_ERR_INVALID,
                       "attenuation: {1, 0, 0} expected beside a radiance and shadow = caps, got {%.9g, %.9g, %.9g}",
                       a[0], a[1], a[2]);
    if (!status && desc->kind != GLINT_LIGHT_POLYGON)
        status = glint_check_range("radius", desc->radius, 0, DBL_MAX, "number >= 0", error);
    if (!status && desc->kind != GLINT_LIGHT_POLYGON && desc->has_radiance && desc->radius > 0) // which is squared
        status = glint_check_range("radius", desc->radius, 1e-150, 1e150,
                                   "0 or a number 1e-150 .. 1e150 beside a radiance", error);
    if (!status && desc->kind == GLINT_LIGHT_DISK)
        status = glint_check_direction("normal", desc->normal, error);
    if (!status && desc->kind == GLINT_LIGHT_POLYGON)
        status = glint_light_sample_check_polygon(desc, error);
    return status;
}

static glint_status check(const glint_light_desc *desc, glint_error *error)
{
    glint_status status = check_colors(desc, error);
    if (!status)
        status = glint_check_range("intensity", desc->intensity, 0, DBL_MAX, "number >= 0", error);
    if (!status)
        status = glint_check_color("attenuation", desc->attenuation, error);
    const double *a = desc->attenuation;
    if (!status && a[0] == 0 && a[1] == 0 && a[2] == 0)
        status = glint_fail(error, GLINT_ERR_INVALID, "attenuation: one number > 0 expected, got {0, 0, 0}");
    if (!status && desc->kind == GLINT_LIGHT_DIRECTIONAL)
        status = glint_check_direction("direction", desc->direction, error);
    else if (!status && desc->kind != GLINT_LIGHT_POLYGON)
        status = glint_check_vector("position", desc->position, error);
    if (!status && desc->kind == GLINT_LIGHT_SPOT)
        status = check_spot(desc, error);
    if (!status && has_area(desc->kind))
        status = check_area(desc, error);
    return status;
}

// ---- The object ----

/// Takes a checked description over, with a copy of the corners. On error the light is as it was.
static glint_status take(glint_light *light, const glint_light_desc *desc, glint_error *error)
{
    double(*vertices)[3] = NULL;
    if (desc->kind == GLINT_LIGHT_POLYGON) {
        vertices = malloc(desc->vertex_count * sizeof *vertices);
        if (!vertices)
            return glint_fail_nomem(error);
        memcpy(vertices, desc->vertices, desc->vertex_count * sizeof *vertices);
    }
    double(*old)[3] = light->vertices;
    light->desc = *desc;
    light->desc.vertices = (const double(*)[3])vertices;
    light->desc.vertex_count = vertices ? desc->vertex_count : 0;
    light->vertices = vertices;
    free(old);
    return GLINT_OK;
}

glint_status glint_light_create(const glint_light_desc *desc, glint_light **out, glint_error *error)
{
    GLINT_REFUSE_NULL(desc, error);
    GLINT_REFUSE_NULL(out, error);
    if (desc->kind > GLINT_LIGHT_SPHERE)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: no such kind of light");
    glint_status status = check(desc, error);
    if (status)
        return status;
    glint_light *light = calloc(1, sizeof *light);
    if (!light)
        return glint_fail_nomem(error);
    light->references = 1;
    status = take(light, desc, error);
    if (status)
        free(light);
    else
        *out = light;
    return status;
}

glint_status glint_light_set(glint_light *light, const glint_light_desc *desc, glint_error *error)
{
    GLINT_REFUSE_NULL(light, error);
    GLINT_REFUSE_NULL(desc, error);
    if (desc->kind != light->desc.kind)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: a light cannot become one of another kind");
    glint_status status = check(desc, error);
    return status ? status : take(light, desc, error);
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
    if (light && --light->references == 0) {
        free(light->vertices);
        free(light);
    }
}

void glint_describe_light(const glint_light_desc *desc, size_t number, char *out, size_t size)
{
    static const char *const kinds[] = {
        [GLINT_LIGHT_POINT] = "point_light",     [GLINT_LIGHT_DIRECTIONAL] = "directional_light",
        [GLINT_LIGHT_SPOT] = "spot_light",       [GLINT_LIGHT_DISK] = "disk_light",
        [GLINT_LIGHT_POLYGON] = "polygon_light", [GLINT_LIGHT_SPHERE] = "sphere_light",
    };
    if (desc->name[0])
        snprintf(out, size, "%s '%s'", kinds[desc->kind], desc->name);
    else
        snprintf(out, size, "%s #%zu", kinds[desc->kind], number);
}
