/// From shapes to primitives.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/geometry.h"

#include <stdlib.h>
#include <string.h>

// ---- One primitive ----

static void sphere_init(glint_prim *prim, const double center[3], double radius)
{
    prim->kind = GLINT_PRIM_SPHERE;
    for (int c = 0; c < 3; c++)
        prim->center[c] = center[c] + 0.0; // -0 and 0 are one place
    prim->radius = radius;
    prim->scale = power_of_two_scale(radius);
    const double r = radius * prim->scale;
    prim->r2 = r * r;
    prim->r2_low = fma(r, r, -prim->r2);
}

static void plane_init(glint_prim *prim, const double point[3], const double normal[3])
{
    prim->kind = GLINT_PRIM_PLANE;
    for (int c = 0; c < 3; c++)
        prim->center[c] = point[c] + 0.0;
    vec_normalize(prim->normal, normal);
    prim->scale = 1;
}

int glint_prim_place(const glint_prim *prim, double out[GLINT_PLACE_MAX])
{
    out[0] = prim->kind;
    if (prim->kind == GLINT_PRIM_TRIANGLE) {
        memcpy(out + 1, prim->corner, sizeof prim->corner);
        return 10;
    }
    vec_copy(out + 1, prim->center);
    vec_copy(out + 4, prim->normal);
    out[7] = prim->radius;
    return 8;
}

void glint_prim_bounds(const glint_prim *prim, double lower[3], double upper[3])
{
    for (int c = 0; c < 3; c++) {
        lower[c] = prim->center[c] - prim->radius;
        upper[c] = prim->center[c] + prim->radius;
        if (prim->kind == GLINT_PRIM_TRIANGLE) {
            lower[c] = fmin(prim->corner[0][c], fmin(prim->corner[1][c], prim->corner[2][c]));
            upper[c] = fmax(prim->corner[0][c], fmax(prim->corner[1][c], prim->corner[2][c]));
        }
    }
}

// ---- All of a scene ----

typedef struct filler {
    glint_geometry *geometry;
    const glint_scene *scene;
    uint32_t *numbers; ///< of the materials of the shape at hand
    uint32_t object_count;
    size_t normal_count;
    glint_error *error;
} filler;

/// The number of the shape's material in `materials`, which grows as new ones appear.
static glint_status material_number(glint_list *materials, glint_material *material, uint32_t *out, glint_error *error)
{
    size_t index = glint_list_find(materials, material);
    glint_status status = GLINT_OK;
    if (index == materials->count)
        status = glint_list_add(materials, material, error);
    *out = (uint32_t)index;
    return status;
}

static void triangle_init(filler *f, glint_prim *prim, const glint_shape *shape, size_t i)
{
    const glint_mesh *mesh = shape->mesh;
    const uint32_t *at = mesh->triangles[i];
    prim->kind = GLINT_PRIM_TRIANGLE;
    prim->item = GLINT_MISS;
    for (int j = 0; j < 3; j++)
        vec_copy(prim->corner[j], mesh->vertices[at[j]]);
    if (shape->desc.shading == GLINT_SHADING_FLAT)
        return;
    prim->item = (uint32_t)f->normal_count++;
    const uint32_t *normal = mesh->triangle_normals ? mesh->triangle_normals[i] : at;
    for (int j = 0; j < 3; j++)
        vec_copy(f->geometry->normals[prim->item].normal[j], mesh->normals[normal[j]]);
}

static void add_prim(filler *f, const glint_shape *shape, size_t i, uint32_t part)
{
    glint_geometry *geometry = f->geometry;
    const glint_shape_desc *desc = &shape->desc;
    const uint32_t at = geometry->table.prim_count++;
    glint_prim *prim = &geometry->prims[at];
    if (desc->kind == GLINT_SHAPE_MESH)
        triangle_init(f, prim, shape, i);
    else if (desc->kind == GLINT_SHAPE_SPHERES)
        sphere_init(prim, shape->spheres[i], shape->spheres[i][3]);
    else if (desc->kind == GLINT_SHAPE_SPHERE)
        sphere_init(prim, desc->center, desc->radius);
    else
        plane_init(prim, desc->point, desc->normal);
    prim->id = at;
    prim->two_sided = desc->two_sided;
    prim->material = f->numbers[shape->index ? shape->index[i] : 0];
    geometry->prim_part[at] = part;
}

static glint_status add_shape(filler *f, glint_shape *shape)
{
    glint_geometry *geometry = f->geometry;
    for (size_t i = 0; i < shape->material_count; i++) {
        glint_status status = material_number(&geometry->materials, shape->materials[i], &f->numbers[i], f->error);
        if (status)
            return status;
    }
    const uint32_t part = geometry->part_count++;
    geometry->parts[part] = (glint_part) { shape, geometry->table.prim_count, f->object_count };
    for (size_t i = 0; i < shape->count; i++)
        add_prim(f, shape, i, part);
    f->object_count += shape->mesh ? 1 : (uint32_t)shape->count;
    geometry->table.triangles = geometry->table.triangles || shape->mesh;
    return GLINT_OK;
}

glint_status glint_geometry_fill(glint_geometry *geometry, const glint_scene *scene, glint_error *error)
{
    filler f = { .geometry = geometry, .scene = scene, .error = error };
    size_t count = 0, materials = 0, smooth = 0;
    for (size_t i = 0; i < scene->shapes.count; i++) {
        const glint_shape *shape = glint_scene_shape(scene, i);
        count += shape->count;
        smooth += shape->mesh && shape->desc.shading != GLINT_SHADING_FLAT ? shape->count : 0;
        materials = shape->material_count > materials ? shape->material_count : materials;
    }
    if (count >= INT32_MAX)
        return glint_fail(error, GLINT_ERR_INVALID, "scene: fewer than 2147483647 surfaces expected, got %zu", count);
    f.numbers = glint_alloc(materials, sizeof *f.numbers);
    geometry->prims = glint_alloc(count, sizeof *geometry->prims);
    geometry->prim_part = glint_alloc(count, sizeof *geometry->prim_part);
    geometry->parts = glint_alloc(scene->shapes.count, sizeof *geometry->parts);
    geometry->normals = smooth ? glint_alloc(smooth, sizeof *geometry->normals) : NULL;
    glint_status status = GLINT_OK;
    if (!f.numbers || !geometry->prims || !geometry->prim_part || !geometry->parts || (smooth && !geometry->normals))
        status = glint_fail_nomem(error);
    for (size_t i = 0; i < scene->shapes.count && !status; i++)
        status = add_shape(&f, glint_scene_shape(scene, i));
    free(f.numbers);
    geometry->table.prims = geometry->prims;
    geometry->table.corner_normals = geometry->normals;
    return status;
}
