/// Many spheres or cylinders as one shape.
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/scene/objects.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ITEMS_MAX ((size_t)1 << 30)

static size_t numbers_of(glint_shape_kind kind)
{
    return kind == GLINT_SHAPE_SPHERES ? GLINT_SPHERE_NUMBERS : GLINT_CYLINDER_NUMBERS;
}

static const char *item_name(glint_shape_kind kind) { return kind == GLINT_SHAPE_SPHERES ? "sphere" : "cylinder"; }

static void read_item(const glint_spheres_desc *desc, size_t i, size_t numbers, double *out)
{
    float f[GLINT_CYLINDER_NUMBERS];
    if (!desc->is_float) {
        memcpy(out, (const char *)desc->data + i * numbers * sizeof(double), numbers * sizeof(double));
        return;
    }
    memcpy(f, (const char *)desc->data + i * numbers * sizeof(float), numbers * sizeof(float));
    for (size_t c = 0; c < numbers; c++)
        out[c] = f[c];
}

static bool is_finite(const double v[3]) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); }

static glint_status take_sphere(glint_shape *shape, size_t i, glint_error *error)
{
    const double *s = shape->items + GLINT_SPHERE_NUMBERS * i;
    if (!is_finite(s))
        return glint_fail(error, GLINT_ERR_INVALID,
                          "data: sphere %zu: finite centre expected, got {%.15g, %.15g, %.15g}", i + 1, s[0], s[1],
                          s[2]);
    if (!(s[3] > 0 && isfinite(s[3])))
        return glint_fail(error, GLINT_ERR_INVALID, "data: sphere %zu: radius > 0 expected, got %.15g", i + 1, s[3]);
    glint_shape_stretch(shape, s, s[3], i == 0);
    return GLINT_OK;
}

static glint_status take_cylinder(glint_shape *shape, size_t i, glint_error *error)
{
    const double *s = shape->items + GLINT_CYLINDER_NUMBERS * i;
    for (int end = 0; end < 2; end++)
        if (!is_finite(s + 3 * end))
            return glint_fail(error, GLINT_ERR_INVALID,
                              "data: cylinder %zu: finite %s expected, got {%.15g, %.15g, %.15g}", i + 1,
                              end ? "top" : "base", s[3 * end], s[3 * end + 1], s[3 * end + 2]);
    if (s[0] == s[3] && s[1] == s[4] && s[2] == s[5])
        return glint_fail(error, GLINT_ERR_INVALID,
                          "data: cylinder %zu: a top other than the base expected, got {%.15g, %.15g, %.15g}", i + 1,
                          s[3], s[4], s[5]);
    if (!(s[6] > 0 && isfinite(s[6])))
        return glint_fail(error, GLINT_ERR_INVALID, "data: cylinder %zu: radius > 0 expected, got %.15g", i + 1, s[6]);
    glint_shape_stretch(shape, s, s[6], i == 0);
    glint_shape_stretch(shape, s + 3, s[6], false);
    return GLINT_OK;
}

static glint_status allocate(glint_shape *shape, size_t count, bool indexed, glint_error *error)
{
    if (count < 1 || count > ITEMS_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "data: 1 .. %zu %ss expected, got %zu", ITEMS_MAX,
                          item_name(shape->desc.kind), count);
    shape->count = count;
    shape->items = count <= SIZE_MAX / GLINT_CYLINDER_NUMBERS / sizeof(double)
                       ? malloc(count * numbers_of(shape->desc.kind) * sizeof *shape->items)
                       : NULL;
    shape->index = indexed ? malloc(count * sizeof *shape->index) : NULL;
    return shape->items && (shape->index || !indexed) ? GLINT_OK : glint_fail_nomem(error);
}

static glint_status fill(glint_shape *shape, const glint_spheres_desc *desc, glint_error *error)
{
    const bool is_sphere = shape->desc.kind == GLINT_SHAPE_SPHERES;
    const size_t numbers = numbers_of(shape->desc.kind);
    glint_status status = allocate(shape, desc->count, desc->material_index, error);
    for (size_t i = 0; i < desc->count && !status; i++) {
        read_item(desc, i, numbers, shape->items + i * numbers);
        status = is_sphere ? take_sphere(shape, i, error) : take_cylinder(shape, i, error);
        if (!desc->material_index || status)
            continue;
        shape->index[i] = desc->material_index[i];
        if (shape->index[i] >= shape->material_count)
            status = glint_fail(error, GLINT_ERR_INVALID, "index: %s %zu: material 1 .. %zu expected, got %llu",
                                item_name(shape->desc.kind), i + 1, shape->material_count,
                                (unsigned long long)shape->index[i] + 1);
    }
    return status;
}

/// Makes a shape without items that retains its materials.
static glint_status begin(const glint_shape_desc *base, glint_material *const *list, size_t count, glint_shape **out,
                          glint_error *error)
{
    const size_t materials = count ? count : 1;
    for (size_t i = 0; i < count; i++)
        if (!list[i])
            return glint_fail(error, GLINT_ERR_INVALID, "materials: entry %zu is missing", i + 1);
    glint_shape *shape = glint_shape_alloc(base, materials);
    if (!shape)
        return glint_fail_nomem(error);
    for (size_t i = 0; i < materials; i++) {
        shape->materials[i] = glint_material_or_default(count ? list[i] : NULL, error);
        if (!shape->materials[i]) {
            glint_shape_release(shape);
            return GLINT_ERR_NOMEM;
        }
        shape->material_count++;
    }
    shape->desc.material = shape->materials[0];
    *out = shape;
    return GLINT_OK;
}

static glint_status create(glint_shape_kind kind, const glint_spheres_desc *given, glint_shape **out,
                           glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_spheres_desc, { .two_sided = true });
    glint_shape_desc base = glint_shape_desc_default(kind);
    glint_shape *shape = NULL;
    base.two_sided = desc->two_sided;
    memcpy(base.name, desc->name, sizeof base.name);
    status = begin(&base, desc->materials, desc->material_count, &shape, error);
    if (!status)
        status = fill(shape, desc, error);
    if (status)
        glint_shape_release(shape);
    else
        *out = shape;
    return status;
}

glint_status glint_spheres_create(const glint_spheres_desc *desc, glint_shape **out, glint_error *error)
{
    return create(GLINT_SHAPE_SPHERES, desc, out, error);
}

glint_status glint_cylinders_create(const glint_spheres_desc *desc, glint_shape **out, glint_error *error)
{
    return create(GLINT_SHAPE_CYLINDERS, desc, out, error);
}

const double *glint_spheres_data(const glint_shape *shape)
{
    return shape ? shape->items : NULL;
}

const uint32_t *glint_spheres_index(const glint_shape *shape) { return shape ? shape->index : NULL; }

size_t glint_spheres_count(const glint_shape *shape) { return shape ? shape->count : 0; }
