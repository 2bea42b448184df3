#include "engine/base/hash.h"
#include "engine/base/status.h"
#include "engine/scene/objects.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_SPHERES ((size_t)1 << 30)

glint_shape_desc glint_shape_desc_default(glint_shape_kind kind)
{
    return (glint_shape_desc) { .kind = kind,
                                .transform = glint_transform_identity(),
                                .two_sided = true,
                                .capped = true,
                                .radius = 1,
                                .normal = { 0, 1, 0 },
                                .min = { -1, -1, -1 },
                                .max = { 1, 1, 1 },
                                .top = { 0, 1, 0 },
                                .axis = { 0, 1, 0 },
                                .major = 1,
                                .minor = 0.25 };
}

static glint_status check_radius(const glint_shape_desc *desc, glint_error *error)
{
    if (desc->radius > 0 && isfinite(desc->radius))
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "radius: number > 0 expected, got %.15g", desc->radius);
}

static glint_status check_box(const glint_shape_desc *desc, glint_error *error)
{
    glint_status status = glint_check_vector("min", desc->min, error);
    if (!status)
        status = glint_check_vector("max", desc->max, error);
    for (int c = 0; c < 3 && !status; c++)
        if (!(desc->min[c] < desc->max[c]))
            status = glint_fail(error, GLINT_ERR_INVALID, "max: %c above that of min (%.15g) expected, got %.15g",
                                "xyz"[c], desc -> min[c], desc -> max[c]);
    return status;
}

static glint_status check_ends(const glint_shape_desc *desc, glint_error *error)
{
    glint_status status = glint_check_vector("base", desc->base, error);
    if (!status)
        status = glint_check_vector("top", desc->top, error);
    if (!status)
        status = check_radius(desc, error);
    if (!status && memcmp(desc->base, desc->top, sizeof desc->base) == 0)
        status =
            glint_fail(error, GLINT_ERR_INVALID, "top: a point other than base expected, got {%.15g, %.15g, %.15g}",
                       desc->top[0], desc->top[1], desc->top[2]);
    return status;
}

static glint_status check_torus(const glint_shape_desc *desc, glint_error *error)
{
    glint_status status = glint_check_vector("center", desc->center, error);
    if (!status)
        status = glint_check_direction("axis", desc->axis, error);
    if (!status && !(desc->major > 0 && isfinite(desc->major)))
        status = glint_fail(error, GLINT_ERR_INVALID, "major: number > 0 expected, got %.15g", desc->major);
    if (!status && !(desc->minor > 0 && desc->minor < desc->major))
        status = glint_fail(error, GLINT_ERR_INVALID, "minor: number > 0 and below major (%.15g) expected, got %.15g",
                            desc->major, desc->minor);
    return status;
}

static glint_status check_fields(const glint_shape_desc *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    switch (desc->kind) {
    case GLINT_SHAPE_SPHERE:
        status = glint_check_vector("center", desc->center, error);
        return status ? status : check_radius(desc, error);
    case GLINT_SHAPE_DISK:
        status = glint_check_vector("center", desc->center, error);
        if (!status)
            status = check_radius(desc, error);
        return status ? status : glint_check_direction("normal", desc->normal, error);
    case GLINT_SHAPE_PLANE:
        status = glint_check_vector("point", desc->point, error);
        return status ? status : glint_check_direction("normal", desc->normal, error);
    case GLINT_SHAPE_BOX:
        return check_box(desc, error);
    case GLINT_SHAPE_CYLINDER:
    case GLINT_SHAPE_CONE:
        return check_ends(desc, error);
    case GLINT_SHAPE_TORUS:
        return check_torus(desc, error);
    case GLINT_SHAPE_MESH:
        return glint_check_shading(desc->shading, error);
    default:
        return GLINT_OK;
    }
}

static glint_status check(const glint_shape_desc *desc, glint_error *error)
{
    glint_status status = glint_check_transform("transform", &desc->transform, error);
    return status ? status : check_fields(desc, error);
}

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

glint_status glint_shape_create(const glint_shape_desc *desc, glint_shape **out, glint_error *error)
{
    GLINT_REFUSE_NULL(desc, error);
    GLINT_REFUSE_NULL(out, error);
    if (desc->kind > GLINT_SHAPE_DIFFERENCE || desc->kind == GLINT_SHAPE_SPHERES || desc->kind == GLINT_SHAPE_MESH)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: one that needs only a description expected");
    glint_status status = check(desc, error);
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

glint_status glint_shape_set(glint_shape *shape, const glint_shape_desc *desc, glint_error *error)
{
    GLINT_REFUSE_NULL(shape, error);
    GLINT_REFUSE_NULL(desc, error);
    if (desc->kind != shape->desc.kind)
        return glint_fail(error, GLINT_ERR_INVALID, "kind: a shape cannot become one of another kind");
    glint_status status = check(desc, error);
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
    free(shape->spheres);
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
    if (shape->desc.kind != GLINT_SHAPE_SPHERES && shape->desc.kind != GLINT_SHAPE_MESH)
        return false;
    memcpy(lower, shape->lower, sizeof shape->lower);
    memcpy(upper, shape->upper, sizeof shape->upper);
    return true;
}

size_t glint_spheres_count(const glint_shape *shape) { return shape ? shape->count : 0; }

static void read_sphere(const glint_spheres_desc *desc, size_t i, double out[4])
{
    if (!desc->is_float) {
        memcpy(out, (const char *)desc->data + i * 4 * sizeof(double), 4 * sizeof(double));
        return;
    }
    float f[4];
    memcpy(f, (const char *)desc->data + i * sizeof f, sizeof f);
    for (int c = 0; c < 4; c++)
        out[c] = f[c];
}

static glint_status check_sphere(size_t i, const double s[4], glint_error *error)
{
    if (!isfinite(s[0]) || !isfinite(s[1]) || !isfinite(s[2]))
        return glint_fail(error, GLINT_ERR_INVALID,
                          "data: sphere %zu: finite centre expected, got {%.15g, %.15g, %.15g}", i + 1, s[0], s[1],
                          s[2]);
    if (!(s[3] > 0 && isfinite(s[3])))
        return glint_fail(error, GLINT_ERR_INVALID, "data: sphere %zu: radius > 0 expected, got %.15g", i + 1, s[3]);
    return GLINT_OK;
}

static glint_status fill_spheres(glint_shape *shape, const glint_spheres_desc *desc, glint_error *error)
{
    shape->spheres = malloc(desc->count * sizeof *shape->spheres);
    if (!shape->spheres)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < desc->count; i++) {
        read_sphere(desc, i, shape->spheres[i]);
        glint_status status = check_sphere(i, shape->spheres[i], error);
        if (status)
            return status;
        glint_shape_stretch(shape, shape->spheres[i], shape->spheres[i][3], i == 0);
    }
    shape->count = desc->count;
    if (!desc->material_index)
        return GLINT_OK;
    shape->index = malloc(desc->count * sizeof *shape->index);
    if (!shape->index)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < desc->count; i++) {
        shape->index[i] = desc->material_index[i];
        if (shape->index[i] >= shape->material_count)
            return glint_fail(error, GLINT_ERR_INVALID, "index: sphere %zu: material 1 .. %zu expected, got %llu",
                              i + 1, shape->material_count, (unsigned long long)shape->index[i] + 1);
    }
    return GLINT_OK;
}

glint_status glint_spheres_create(const glint_spheres_desc *desc, glint_shape **out, glint_error *error)
{
    GLINT_REFUSE_NULL(desc, error);
    GLINT_REFUSE_NULL(out, error);
    if (desc->count < 1 || desc->count > MAX_SPHERES)
        return glint_fail(error, GLINT_ERR_INVALID, "data: 1 .. %zu spheres expected, got %zu", MAX_SPHERES,
                          desc->count);
    for (size_t i = 0; i < desc->material_count; i++)
        if (!desc->materials[i])
            return glint_fail(error, GLINT_ERR_INVALID, "materials: entry %zu is missing", i + 1);
    glint_shape_desc base = glint_shape_desc_default(GLINT_SHAPE_SPHERES);
    base.two_sided = desc->two_sided;
    memcpy(base.name, desc->name, sizeof base.name);
    const size_t materials = desc->material_count ? desc->material_count : 1;
    glint_shape *shape = glint_shape_alloc(&base, materials);
    if (!shape)
        return glint_fail_nomem(error);
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < materials && !status; i++) {
        shape->materials[i] = glint_material_or_default(desc->material_count ? desc->materials[i] : NULL, error);
        if (shape->materials[i])
            shape->material_count++;
        else
            status = GLINT_ERR_NOMEM;
    }
    if (!status)
        status = fill_spheres(shape, desc, error);
    if (status) {
        glint_shape_release(shape);
        return status;
    }
    shape->desc.material = shape->materials[0];
    *out = shape;
    return GLINT_OK;
}

const char *glint_shape_kind_name(glint_shape_kind kind)
{
    static const char *const kinds[] = { "sphere",   "plane", "spheres", "mesh",  "box",   "disk",
                                         "cylinder", "cone",  "torus",   "group", "union", "intersection",
                                         "difference" };
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
