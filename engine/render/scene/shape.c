#include "engine/base/hash.h"
#include "engine/base/status.h"
#include "engine/glint_inspect.h"
#include "engine/render/scene/fields.h"
#include "engine/render/scene/objects.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_SPHERES ((size_t)1 << 30)

// ---- The tables of fields ----

typedef glint_shape_desc DESC;

static const char *const material_kind[] = { "glint.material", NULL };
static const char *const shadings[] = { "faceted", "phong", "flat", "gouraud", NULL };

#define SLOPES .takes = GLINT_TAKES_VARIABLE
#define POINT(field, ...) { GLINT_ROW(field, VECTOR), .required = true, .unit = "world units", __VA_ARGS__ }
#define NORMAL(...) \
    { GLINT_ROW(normal, DIRECTION), .required = true, .initial = { 0, 1, 0 }, .doc = "not zero, need not be unit", __VA_ARGS__ }
#define RADIUS(...) { GLINT_ROW(radius, NUMBER), .required = true, GLINT_ABOVE_0, .initial = { 1 }, .unit = "world units", __VA_ARGS__ }
#define CAPPED(ends) \
    { GLINT_ROW(capped, FLAG), .initial = { true }, \
      .doc = "closed at " ends "; false: only the side surface, which is also visible from inside" }
#define PLACED(doc_of_name) \
    { GLINT_ROW(transform, TRANSFORM), .doc = "maps the described shape to its place in the world; nil: no change" }, \
    { GLINT_ROW(name, TEXT), .doc = doc_of_name }

#define EVERY_SHAPE \
    { GLINT_ROW(material, OBJECT), .names = material_kind, \
      .doc = "Default: a new material with default fields; for a part of a combined solid, the material of the solid" }, \
    { GLINT_ROW(two_sided, FLAG), .initial = { true }, \
      .doc = "true: the normal is turned to the viewer; false: the back gets only ambient light" }, \
    PLACED("for messages and `glint explain`, at most 63 bytes"), \
    { .name = NULL }

static const glint_object_field sphere_fields[] = {
    POINT(center, SLOPES, .doc = "the centre"),
    RADIUS(SLOPES, .doc = "> 0; a frame needs a radius >= 1e-150, also relative to the distance from the eye"),
    EVERY_SHAPE,
};

static const glint_object_field plane_fields[] = {
    POINT(point, SLOPES, .doc = "any point on the plane"),
    NORMAL(SLOPES),
    EVERY_SHAPE,
};

static const glint_object_field box_fields[] = {
    POINT(min, .initial = { -1, -1, -1 }, .doc = "the corner of the smallest coordinates"),
    POINT(max, .initial = { 1, 1, 1 }, .doc = "the corner of the largest coordinates, each greater than in `min`"),
    EVERY_SHAPE,
};

static const glint_object_field disk_fields[] = {
    POINT(center, .doc = "the centre"), NORMAL(), RADIUS(.doc = "> 0"), EVERY_SHAPE,
};

static const glint_object_field cylinder_fields[] = {
    POINT(base, .doc = "the middle of one end"),
    POINT(top, .initial = { 0, 1, 0 }, .doc = "the middle of the other end; different from `base`"),
    RADIUS(.doc = "> 0"),
    CAPPED("both ends"),
    EVERY_SHAPE,
};

static const glint_object_field cone_fields[] = {
    POINT(base, .doc = "the middle of the base"),
    POINT(top, .initial = { 0, 1, 0 }, .doc = "the apex; different from `base`"),
    RADIUS(.doc = "radius of the base, > 0"),
    CAPPED("its base"),
    EVERY_SHAPE,
};

static const glint_object_field torus_fields[] = {
    POINT(center, .doc = "the centre"),
    { GLINT_ROW(axis, DIRECTION), .initial = { 0, 1, 0 }, .doc = "the axis of rotation, not zero" },
    { GLINT_ROW(major, NUMBER), .required = true, GLINT_ABOVE_0, .initial = { 1 }, .unit = "world units",
      .doc = "radius of the circle in the middle of its tube, > 0" },
    { GLINT_ROW(minor, NUMBER), .required = true, .high = DBL_MAX, .initial = { 0.25 }, .unit = "world units",
      .doc = "radius of the tube, > 0 and less than major, so that the tube does not intersect itself" },
    EVERY_SHAPE,
};

static const glint_object_field cylinders_fields[] = { CAPPED("both ends"), EVERY_SHAPE };

static const glint_object_field mesh_fields[] = {
    { GLINT_ROW(shading, CHOICE), .names = shadings, .doc = "where the light is computed" },
    { GLINT_ROW(terminator, NUMBER), .high = 1,
      .doc = "phong shading: 1 moves points outwards to the curved surface before light and shadow are computed, so that the "
             "terminator has no steps; 0: points stay on the flat faces. Not with `transmission`, `opacity` or in combined solids" },
    EVERY_SHAPE,
};

static const glint_object_field group_fields[] = { PLACED("at most 63 bytes"), { .name = NULL } };

static const glint_object_field other_fields[] = { EVERY_SHAPE };

const glint_object_field *const glint_shape_fields[] = {
    [GLINT_SHAPE_SPHERE] = sphere_fields,      [GLINT_SHAPE_PLANE] = plane_fields,
    [GLINT_SHAPE_SPHERES] = other_fields,      [GLINT_SHAPE_MESH] = mesh_fields,
    [GLINT_SHAPE_BOX] = box_fields,            [GLINT_SHAPE_DISK] = disk_fields,
    [GLINT_SHAPE_CYLINDER] = cylinder_fields,  [GLINT_SHAPE_CONE] = cone_fields,
    [GLINT_SHAPE_TORUS] = torus_fields,        [GLINT_SHAPE_CYLINDERS] = cylinders_fields,
    [GLINT_SHAPE_GROUP] = group_fields,
    [GLINT_SHAPE_UNION] = other_fields,        [GLINT_SHAPE_INTERSECTION] = other_fields,
    [GLINT_SHAPE_DIFFERENCE] = other_fields,
};

static glint_shape_desc defaults(glint_shape_kind kind)
{
    glint_shape_desc desc = { .kind = kind, .transform = glint_transform_identity() };
    for (int k = GLINT_SHAPE_SPHERE; k <= GLINT_SHAPE_DIFFERENCE; k++)
        glint_fields_reset(glint_shape_fields[k], &desc);
    return desc;
}

void glint_shape_desc_init(glint_shape_desc *desc, size_t size, glint_shape_kind kind)
{
    const glint_shape_desc full = defaults(kind);
    glint_desc_write(desc, size, &full, sizeof full);
}

// ---- Checks of several fields ----

static glint_status check_box(const glint_shape_desc *desc, glint_error *error)
{
    for (int c = 0; c < 3; c++)
        if (!(desc->min[c] < desc->max[c]))
            return glint_fail(error, GLINT_ERR_INVALID, "max: %c above that of min (%.15g) expected, got %.15g", "xyz"[c],
                              desc->min[c], desc->max[c]);
    return GLINT_OK;
}

static glint_status check_ends(const glint_shape_desc *desc, glint_error *error)
{
    if (memcmp(desc->base, desc->top, sizeof desc->base) != 0)
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "top: a point other than base expected, got {%.15g, %.15g, %.15g}",
                      desc->top[0], desc->top[1], desc->top[2]);
}

static glint_status check_torus(const glint_shape_desc *desc, glint_error *error)
{
    if (desc->minor > 0 && desc->minor < desc->major)
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "minor: number > 0 and below major (%.15g) expected, got %.15g",
                      desc->major, desc->minor);
}

static glint_status check(const glint_shape_desc *desc, glint_error *error)
{
    const glint_status status = glint_fields_check(glint_shape_fields[desc->kind], desc, error);
    if (status)
        return status;
    switch (desc->kind) {
    case GLINT_SHAPE_BOX:
        return check_box(desc, error);
    case GLINT_SHAPE_CYLINDER:
    case GLINT_SHAPE_CONE:
        return check_ends(desc, error);
    case GLINT_SHAPE_TORUS:
        return check_torus(desc, error);
    default:
        return GLINT_OK;
    }
}

// ---- Revisions ----

static atomic_uint_least64_t last_revision;

static uint64_t next_revision(void) { return atomic_fetch_add(&last_revision, 1) + 1; }

void glint_shape_changed(glint_shape *shape) { shape->revision = next_revision(); }

uint64_t glint_shape_revision(glint_shape *shape)
{
    if (!glint_shape_has_children(shape) || shape->checked == atomic_load(&last_revision))
        return shape->revision;
    glint_key key = { 0 };
    for (size_t i = 0; i < shape->children.count; i++) {
        const uint64_t revision = glint_shape_revision(shape->children.items[i]);
        key = glint_key_add(key, &revision, sizeof revision);
    }
    if (key.low != shape->children_hash)
        glint_shape_changed(shape);
    shape->children_hash = key.low;
    shape->checked = atomic_load(&last_revision);
    return shape->revision;
}

glint_material *glint_material_or_default(glint_material *material, glint_error *error)
{
    if (material)
        return glint_material_retain(material);
    const glint_material_desc desc = glint_material_desc_default();
    glint_material_create(&desc, &material, error);
    return material;
}

glint_shape *glint_shape_alloc(const glint_shape_desc *desc, size_t material_count)
{
    glint_shape *shape = calloc(1, sizeof *shape);
    if (!shape)
        return NULL;
    shape->references = 1;
    shape->revision = next_revision();
    shape->desc = *desc;
    shape->count = desc->kind != GLINT_SHAPE_GROUP;
    shape->dressed = desc->material != NULL;
    shape->materials = calloc(material_count, sizeof *shape->materials);
    if (!shape->materials) {
        free(shape);
        return NULL;
    }
    return shape;
}

glint_status glint_shape_create(const glint_shape_desc *given, glint_shape **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_shape_desc, defaults(given->kind));
    if (desc->kind > GLINT_SHAPE_DIFFERENCE || desc->kind == GLINT_SHAPE_MESH || glint_shape_is_many(desc->kind))
        return glint_fail(error, GLINT_ERR_INVALID, "kind: any kind except spheres, cylinders and mesh expected");
    status = check(desc, error);
    if (status)
        return status;
    glint_shape *shape = glint_shape_alloc(desc, 1);
    if (!shape)
        return glint_fail_nomem(error);
    shape->materials[0] = glint_material_or_default(desc->material, error);
    if (!shape->materials[0]) {
        glint_shape_release(shape);
        return GLINT_ERR_NOMEM;
    }
    shape->material_count = 1;
    shape->desc.material = shape->materials[0];
    *out = shape;
    return GLINT_OK;
}

glint_status glint_shape_set(glint_shape *shape, const glint_shape_desc *given, glint_error *error)
{
    GLINT_REFUSE_NULL(shape, error);
    GLINT_TAKE_DESC(glint_shape_desc, defaults(given->kind));
    if (desc->kind != shape->desc.kind)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: a shape cannot become one of another kind");
    status = check(desc, error);
    if (status)
        return status;
    if (shape->mesh)
        status = glint_mesh_prepare(shape->mesh, shape->index, desc->shading, error);
    if (status)
        return status;
    const bool dressed = desc->material && (shape->dressed || desc->material != shape->materials[0]);
    glint_material *material = glint_material_or_default(desc->material, error);
    if (!material)
        return GLINT_ERR_NOMEM;
    shape->dressed = dressed;
    glint_material_release(shape->materials[0]);
    shape->materials[0] = material;
    shape->desc = *desc;
    shape->desc.material = material;
    shape->revision = next_revision();
    return GLINT_OK;
}

bool glint_shape_has_material(const glint_shape *shape) { return shape && shape->dressed; }

const glint_shape_desc *glint_shape_get(const glint_shape *shape) { return shape ? &shape->desc : NULL; }

glint_shape *glint_shape_retain(glint_shape *shape)
{
    if (shape)
        shape->references++;
    return shape;
}

void glint_shape_release(glint_shape *shape)
{
    if (!shape || --shape->references > 0)
        return;
    for (size_t i = 0; i < shape->material_count; i++)
        glint_material_release(shape->materials[i]);
    free(shape->materials);
    for (size_t i = 0; i < shape->children.count; i++)
        glint_shape_release(shape->children.items[i]);
    glint_list_free(&shape->children);
    glint_mesh_free(shape->mesh);
    free(shape->items);
    free(shape->index);
    free(shape);
}

void glint_shape_stretch(glint_shape *shape, const double center[3], double radius, bool first)
{
    for (int c = 0; c < 3; c++) {
        const double low = center[c] - radius, high = center[c] + radius;
        if (first || low < shape->lower[c])
            shape->lower[c] = low;
        if (first || high > shape->upper[c])
            shape->upper[c] = high;
    }
}

bool glint_shape_bounds(const glint_shape *shape, double lower[3], double upper[3])
{
    if (!shape || !lower || !upper)
        return false;
    if (!glint_shape_is_many(shape->desc.kind) && shape->desc.kind != GLINT_SHAPE_MESH)
        return false;
    memcpy(lower, shape->lower, sizeof shape->lower);
    memcpy(upper, shape->upper, sizeof shape->upper);
    return true;
}

const char *glint_shape_kind_name(glint_shape_kind kind)
{
    static const char *const kinds[] = { "sphere",   "plane", "spheres", "mesh",  "box",   "disk",
                                         "cylinder", "cone",  "torus",   "cylinders", "group", "union",
                                         "intersection", "difference" };
    return kinds[kind];
}

void glint_describe_shape(const glint_shape_desc *desc, size_t number, char *out, size_t size)
{
    const char *kind = glint_shape_kind_name(desc->kind);
    if (desc->name[0])
        snprintf(out, size, "%s '%s'", kind, desc->name);
    else
        snprintf(out, size, "%s #%zu", kind, number);
}

size_t glint_shape_materials(const glint_shape *shape, glint_material *const **list)
{
    if (!shape || !list)
        return 0;
    *list = shape->materials;
    return shape->material_count;
}
