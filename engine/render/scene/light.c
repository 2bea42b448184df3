#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/scene/area_light.h"
#include "engine/render/scene/fields.h"
#include "engine/render/scene/objects.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 0x1.921fb54442d18p+1

// ---- The tables of fields ----

typedef glint_light_desc DESC;

static const char *const shadows[] = { "rays", "hard", "caps", NULL };

#define GIVEN(field) .set_offset = offsetof(DESC, field)
#define SLOPES .takes = GLINT_TAKES_VARIABLE
#define NONZERO(field, text) { GLINT_ROW(field, DIRECTION), .required = true, .initial = { 0, -1, 0 }, .doc = text }
#define AIM(text) { GLINT_ROW(direction, DIRECTION), .required = true, .initial = { 0, -1, 0 }, SLOPES, .doc = text }
#define POSITION(text) { GLINT_ROW(position, VECTOR), .required = true, SLOPES, .unit = "world units", .doc = text }
#define RADIUS(text) { GLINT_ROW(radius, NUMBER), .required = true, GLINT_AT_LEAST_0, .initial = { 1 }, .unit = "world units", .doc = text }

#define EVERY_LIGHT(slopes_of_distance) \
    { GLINT_ROW(color, COLOR), .initial = { 1, 1, 1 }, SLOPES, .doc = "the light's colour, >= 0" }, \
    { GLINT_ROW(intensity, NUMBER), GLINT_AT_LEAST_0, .initial = { 1 }, SLOPES, .doc = ">= 0, multiplies each of the three terms" }, \
    { GLINT_ROW(ambient, COLOR), SLOPES, \
      .doc = ">= 0, adds to the scene's ambient light; neither attenuated nor shadowed" }, \
    { GLINT_ROW(diffuse, COLOR), GIVEN(has_diffuse), .follows = "color", SLOPES, .doc = "colour of the diffuse term, >= 0" }, \
    { GLINT_ROW(specular, COLOR), GIVEN(has_specular), .follows = "color", SLOPES, .doc = "colour of the highlight, >= 0" }, \
    { GLINT_ROW(attenuation, VECTOR), .high = DBL_MAX, .initial = { 1, 0, 0 }, .takes = slopes_of_distance, \
      .doc = "{c0, c1, c2} of A = 1 / (c0 + c1 d + c2 d^2), each >= 0, not all 0" }, \
    { GLINT_ROW(shadows, FLAG), .initial = { true }, .doc = "whether it casts shadows" }, \
    { GLINT_ROW(visible, FLAG), \
      .doc = "whether the eye, mirrors and glass see its surface, from the sides that shine. With `radiance` L it " \
             "shows pi L color; with `intensity` I it shows color I A(D), where D is its radius (for a polygon, " \
             "the radius of a disk of the same area). The surface casts no shadow and is not an object: the passes " \
             "treat it as background with a depth and a normal. No effect on lights without a surface" }, \
    { GLINT_ROW(name, TEXT), .doc = "used in messages, `glint explain` and its pass \"light:NAME\", at most 63 " \
                                    "bytes" }, \
    { GLINT_ROW(group, TEXT), \
      .doc = "the pass \"light:GROUP\" holds the light of all lights of this group together, at most 63 bytes. Default \"\": by `name`" }

#define EVERY_AREA_LIGHT \
    EVERY_LIGHT(GLINT_TAKES_VARIABLE), \
    { GLINT_ROW(samples, WHOLE), .low = 1, .high = 65536, .initial = { 16 }, \
      .doc = "points of the surface for each sample of a pixel, 1 .. 65536. The points differ between the pixels " \
             "of a 4 x 4 block, so that 16 samples look like 256 from a distance" }, \
    { GLINT_ROW(shadow, CHOICE), .names = shadows, \
      .doc = "rays: one shadow ray to each sample. hard: one ray to the light's centre, for all samples. caps: " \
             "only for sphere lights, in closed form, without noise: the terms of a point light at its centre " \
             "(with `radiance` L, of irradiance pi L r^2/d^2 (n.l)) times the visible fraction of the light. The " \
             "fraction is exact for one blocking sphere; for several it is the product of the fractions that each " \
             "leaves. Scenes with other shapes than spheres and planes, or with transparent shapes, use rays " \
             "instead; `glint explain` says which. With `radiance`, caps are the limit of rays, except that the " \
             "cosine is constant across the light. With `intensity` they are not: its rays go to the whole " \
             "surface, including the far side" }, \
    { GLINT_ROW(radiance, NUMBER), GIVEN(has_radiance), GLINT_AT_LEAST_0, SLOPES, \
      .doc = ">= 0, only together with an intensity of 1. nil: `intensity` is used. Default nil" }

static const glint_object_field point_fields[] = {
    EVERY_LIGHT(GLINT_TAKES_VARIABLE),
    POSITION("position of the light"),
    { .name = NULL },
};

static const glint_object_field directional_fields[] = {
    EVERY_LIGHT(0),
    AIM("direction in which the light travels; not zero, need not be a unit vector"),
    { .name = NULL },
};

static const glint_object_field spot_fields[] = {
    EVERY_LIGHT(GLINT_TAKES_VARIABLE),
    POSITION("position of the light"),
    AIM("direction of the axis; not zero, need not be a unit vector"),
    { GLINT_NAMED("inner", inner_rad, ANGLE), .required = true, .high = PI, .initial = { 20 * PI / 180 }, SLOPES, .unit = "degrees",
      .doc = "half angle of the fully lit cone, 0 <= inner <= outer" },
    { GLINT_NAMED("outer", outer_rad, ANGLE), .required = true, .high = PI, .initial = { 30 * PI / 180 }, SLOPES, .unit = "degrees",
      .doc = "half angle beyond which there is no light, <= 180; between the two angles the light follows a "
             "smoothstep of the cosine" },
    { GLINT_ROW(exponent, NUMBER), GLINT_AT_LEAST_0, SLOPES, .doc = ">= 0: the light also falls off as cos^exponent from the axis" },
    { .name = NULL },
};

static const glint_object_field disk_fields[] = {
    EVERY_AREA_LIGHT,
    POSITION("its centre"),
    NONZERO(normal, "points to the side that shines; not zero, need not be a unit vector"),
    RADIUS(">= 0; 0 is a point"),
    { .name = NULL },
};

static const glint_object_field polygon_fields[] = {
    EVERY_AREA_LIGHT,
    { GLINT_ROW(vertices, POINTS), .required = true, .unit = "world units",
      .doc = "3 .. 4096 corners of a convex polygon in one plane; it shines to the side from which the corners run "
             "counter-clockwise" },
    { GLINT_ROW(two_sided, FLAG), .doc = "whether it shines to both sides" },
    { .name = NULL },
};
_Static_assert(offsetof(DESC, vertex_count) == offsetof(DESC, vertices) + sizeof(void *), "GLINT_TYPE_POINTS");

static const glint_object_field sphere_fields[] = {
    EVERY_AREA_LIGHT,
    POSITION("its centre"),
    RADIUS(">= 0; 0 is a point light, bit for bit"),
    { .name = NULL },
};

const glint_object_field *const glint_light_fields[] = {
    [GLINT_LIGHT_POINT] = point_fields, [GLINT_LIGHT_DIRECTIONAL] = directional_fields, [GLINT_LIGHT_SPOT] = spot_fields,
    [GLINT_LIGHT_DISK] = disk_fields,   [GLINT_LIGHT_POLYGON] = polygon_fields,         [GLINT_LIGHT_SPHERE] = sphere_fields,
};

static glint_light_desc defaults(glint_light_kind kind)
{
    glint_light_desc desc = { .kind = kind };
    for (int k = GLINT_LIGHT_POINT; k <= GLINT_LIGHT_SPHERE; k++)
        glint_fields_reset(glint_light_fields[k], &desc);
    return desc;
}

void glint_light_desc_init(glint_light_desc *desc, size_t size, glint_light_kind kind)
{
    const glint_light_desc full = defaults(kind);
    glint_desc_write(desc, size, &full, sizeof full);
}

static bool has_area(glint_light_kind kind)
{
    return kind == GLINT_LIGHT_DISK || kind == GLINT_LIGHT_POLYGON || kind == GLINT_LIGHT_SPHERE;
}

// ---- Checks ----

static glint_status check_spot(const glint_light_desc *desc, glint_error *error)
{
    const double inner = desc->inner_rad, outer = desc->outer_rad;
    if (0 <= inner && inner <= outer && outer <= PI)
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID,
                      "%s: half angles 0 <= inner <= outer <= 180 expected, got inner %.12g and outer %.12g",
                      outer <= PI ? "inner" : "outer", inner * 180 / PI, outer * 180 / PI);
}

static glint_status check_area(const glint_light_desc *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    if (desc->has_radiance && desc->intensity != 1)
        status =
            glint_fail(error, GLINT_ERR_INVALID, "intensity: with a radiance, expected 1, got %.15g", desc->intensity);
    if (!status && desc->shadow == GLINT_SHADOW_CAPS && desc->kind != GLINT_LIGHT_SPHERE)
        status = glint_fail(error, GLINT_ERR_INVALID, "shadow: rays or hard expected; only sphere lights have caps");
    const double *a = desc->attenuation;
    if (!status && desc->shadow == GLINT_SHADOW_CAPS && desc->has_radiance && (a[0] != 1 || a[1] != 0 || a[2] != 0))
        status =
            glint_fail(error, GLINT_ERR_INVALID,
                       "attenuation: with a radiance and shadow = caps, expected {1, 0, 0}, got {%.9g, %.9g, "
                       "%.9g}",
                       a[0], a[1], a[2]);
    // the kernels square the radius
    if (!status && desc->kind != GLINT_LIGHT_POLYGON && desc->has_radiance && desc->radius > 0)
        status = glint_check_range("radius", desc->radius, 1e-150, 1e150,
                                   "0 or a number 1e-150 .. 1e150 together with a radiance", error);
    if (!status && desc->kind == GLINT_LIGHT_POLYGON)
        status = glint_light_sample_check_polygon(desc, error);
    return status;
}

static glint_status check(const glint_light_desc *desc, glint_error *error)
{
    glint_status status = glint_fields_check(glint_light_fields[desc->kind], desc, error);
    const double *a = desc->attenuation;
    if (!status && a[0] == 0 && a[1] == 0 && a[2] == 0)
        status = glint_fail(error, GLINT_ERR_INVALID, "attenuation: one number > 0 expected, got {0, 0, 0}");
    if (!status && desc->kind == GLINT_LIGHT_SPOT)
        status = check_spot(desc, error);
    if (!status && has_area(desc->kind))
        status = check_area(desc, error);
    return status;
}

// ---- The object ----

/// Takes over a checked description, with a copy of the corners. On error the light is unchanged.
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

glint_status glint_light_create(const glint_light_desc *given, glint_light **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_light_desc, defaults(given->kind));
    if (desc->kind > GLINT_LIGHT_SPHERE)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: no such kind of light");
    status = check(desc, error);
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

glint_status glint_light_set(glint_light *light, const glint_light_desc *given, glint_error *error)
{
    GLINT_REFUSE_NULL(light, error);
    GLINT_TAKE_DESC(glint_light_desc, defaults(given->kind));
    if (desc->kind != light->desc.kind)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: a light cannot become one of another kind");
    status = check(desc, error);
    return status ? status : take(light, desc, error);
}

const glint_light_desc *glint_light_get(const glint_light *light) { return light ? &light->desc : NULL; }

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

void glint_scene_light_pass(const glint_scene *scene, size_t index, char name[GLINT_NAME_SIZE])
{
    if (!name || index >= glint_scene_light_count(scene))
        return;
    const glint_light_desc *desc = &glint_scene_light(scene, index)->desc;
    char plain[GLINT_NAME_SIZE];
    if (desc->group[0] || desc->name[0]) {
        snprintf(name, GLINT_NAME_SIZE, "%s", desc->group[0] ? desc->group : desc->name);
        return;
    }
    glint_describe_light(desc, index + 1, plain, sizeof plain); // "point_light #2"
    snprintf(name, GLINT_NAME_SIZE, "%.*s_%zu", (int)strcspn(plain, " "), plain, index + 1);
}
