#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/scene/mesh_ears.h"
#include "engine/render/scene/objects.h"

#include <stdlib.h>

#define MOST ((size_t)INT32_MAX - 1) ///< most vertices, faces, triangles, normals and texture coordinates

static glint_mesh_desc defaults(void)
{
    return (glint_mesh_desc) { .transform = glint_transform_identity(), .two_sided = true };
}

void glint_mesh_desc_init(glint_mesh_desc *desc, size_t size)
{
    const glint_mesh_desc full = defaults();
    glint_desc_write(desc, size, &full, sizeof full);
}

void glint_mesh_free(glint_mesh *mesh)
{
    if (!mesh)
        return;
    free(mesh->vertices);
    free(mesh->triangles);
    free(mesh->normals);
    free(mesh->triangle_normals);
    free(mesh->uv);
    free(mesh->triangle_uv);
    free(mesh->uv_missing);
    free(mesh->faces);
    free(mesh->shading_points);
    free(mesh);
}

glint_status glint_check_shading(glint_shading shading, glint_error *error)
{
    if (shading <= GLINT_SHADING_GOURAUD)
        return GLINT_OK;
    return glint_fail(error, GLINT_ERR_INVALID, "shading: faceted, phong, flat or gouraud expected");
}

// ---- Faces to triangles ----

typedef struct builder {
    const glint_mesh_desc *desc;
    glint_mesh *mesh;
    size_t capacity; ///< capacity, in triangles
    glint_polygon face;
    size_t number; ///< number of the face, from 1
    glint_ears ears;
    uint32_t *index; ///< material of each triangle; NULL: all triangles have the same material
    glint_mesh_faults *faults; ///< NULL: faults are errors
    glint_error *error;
} builder;

static const double *vertex(const builder *b, uint32_t corner)
{
    return b->desc->vertices + 3 * (size_t)b->face.corners[corner];
}

static bool is_zero(const double v[3]) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

/// Resizes an array unless it is NULL. Returns false and leaves the array unchanged if out of memory.
static bool resize(void **array, size_t bytes)
{
    void *made = *array ? realloc(*array, bytes) : NULL;
    if (*array && !made)
        return false;
    *array = made;
    return true;
}

/// Doubles the capacity for triangles.
static bool grow(builder *b)
{
    glint_mesh *mesh = b->mesh;
    const size_t capacity = b->capacity * 2;
    void *of_corners[] = { mesh->triangles, mesh->triangle_normals, mesh->triangle_uv }, *faces = mesh->faces;
    bool good = resize(&faces, capacity * sizeof *mesh->faces);
    for (int i = 0; i < 3; i++)
        good = good && resize(&of_corners[i], capacity * sizeof *mesh->triangles);
    void *index = b->index;
    good = good && resize(&index, capacity * sizeof *b->index);
    b->index = index;
    mesh->triangles = of_corners[0];
    mesh->triangle_normals = of_corners[1];
    mesh->triangle_uv = of_corners[2];
    mesh->faces = faces;
    b->capacity = good ? capacity : b->capacity;
    return good;
}

/// Returns the number of a normal or pair of coordinates, or the number after the last one if it is `none`.
static uint32_t number_or(uint32_t number, uint32_t none, size_t count)
{
    return number == none ? (uint32_t)count : number;
}

/// Returns the index of the current face's material.
static uint32_t material_of(const builder *b)
{
    return b->desc->material_index ? b->desc->material_index[b->number - 1] : 0;
}

static glint_status add_triangle(builder *b, size_t first_corner, uint32_t i, uint32_t j, uint32_t k)
{
    glint_mesh *mesh = b->mesh;
    if (mesh->triangle_count == MOST)
        return glint_fail(b->error, GLINT_ERR_INVALID, "faces: at most %zu triangles expected", MOST);
    if (mesh->triangle_count == b->capacity && !grow(b))
        return glint_fail_nomem(b->error);
    if (mesh->faces)
        mesh->faces[mesh->triangle_count] = (uint32_t)(b->number - 1);
    if (b->index)
        b->index[mesh->triangle_count] = material_of(b);
    const uint32_t corner[3] = { i, j, k };
    for (int c = 0; c < 3; c++) {
        mesh->triangles[mesh->triangle_count][c] = b->face.corners[corner[c]];
        if (mesh->triangle_normals)
            mesh->triangle_normals[mesh->triangle_count][c] =
                number_or(b->desc->normal_corners[first_corner + corner[c]], GLINT_NO_NORMAL, b->desc->normal_count);
        if (mesh->triangle_uv)
            mesh->triangle_uv[mesh->triangle_count][c] =
                number_or(b->desc->uv_corners[first_corner + corner[c]], GLINT_NO_UV, b->desc->uv_count);
    }
    mesh->triangle_count++;
    return GLINT_OK;
}

static void polygon_normal(builder *b)
{
    glint_polygon *face = &b->face;
    double largest = 0, f[3], g[3], cross[3];
    for (uint32_t i = 1; i < face->size; i++) {
        vec_sub(f, vertex(b, i), vertex(b, 0));
        largest = fmax(largest, vec_max_abs(f));
    }
    const double scale = largest > 0 ? power_of_two_scale(largest) : 1;
    vec_scale(face->normal, face->normal, 0);
    for (uint32_t i = 1; i + 1 < face->size; i++) {
        vec_sub(f, vertex(b, i), vertex(b, 0));
        vec_sub(g, vertex(b, i + 1), vertex(b, 0));
        vec_scale(f, f, scale);
        vec_scale(g, g, scale);
        vec_cross(cross, f, g);
        for (int c = 0; c < 3; c++)
            face->normal[c] += cross[c];
    }
}

/// Returns whether the fan from the first corner stays within the polygon: none of its triangles is flipped.
static bool fan_fits(const builder *b)
{
    double cross[3];
    for (uint32_t i = 1; i + 1 < b->face.size; i++) {
        glint_polygon_cross(&b->face, 0, i, i + 1, cross);
        if (vec_dot(cross, b->face.normal) < 0)
            return false;
    }
    return true;
}

static glint_status cut_fan(builder *b, size_t first_corner)
{
    glint_status status = GLINT_OK;
    double cross[3];
    for (uint32_t i = 1; i + 1 < b->face.size && !status; i++) {
        glint_polygon_cross(&b->face, 0, i, i + 1, cross);
        if (!is_zero(cross))
            status = add_triangle(b, first_corner, 0, i, i + 1);
    }
    return status;
}

/// Cuts a polygon ear by ear. A polygon that crosses itself is an error, or is cut as a fan.
static glint_status cut_ears(builder *b, size_t first_corner)
{
    bool whole;
    glint_status status = glint_ears_cut(&b->ears, &b->face, &whole, b->error);
    if (!status && !whole && !b->faults)
        return glint_fail(b->error, GLINT_ERR_INVALID, "faces[%zu]: a polygon that does not cross itself expected",
                          b->number);
    if (!status && !whole) {
        b->faults->crossed++;
        return cut_fan(b, first_corner);
    }
    for (size_t i = 0; i < b->ears.triangle_count && !status; i++) {
        const uint32_t *corners = b->ears.triangles[i];
        status = add_triangle(b, first_corner, corners[0], corners[1], corners[2]);
    }
    return status;
}

static glint_status cut_face(builder *b, size_t first_corner)
{
    polygon_normal(b);
    if (is_zero(b->face.normal) && b->faults) {
        b->faults->flat++;
        return GLINT_OK;
    }
    if (is_zero(b->face.normal))
        return glint_fail(b->error, GLINT_ERR_INVALID,
                          "faces[%zu]: a face with an area expected: its vertices %u, %u, %u%s are on one line",
                          b->number, b->face.corners[0] + 1, b->face.corners[1] + 1, b->face.corners[2] + 1,
                          b->face.size > 3 ? ", ..." : "");
    return b->face.size == 3 || fan_fits(b) ? cut_fan(b, first_corner) : cut_ears(b, first_corner);
}

// ---- Checks ----

static glint_status check_counts(const glint_mesh_desc *desc, glint_error *error)
{
    if (desc->vertex_count < 3 || desc->vertex_count > MOST)
        return glint_fail(error, GLINT_ERR_INVALID, "vertices: 3 .. %zu expected, got %zu", MOST, desc->vertex_count);
    if (desc->face_count < 1 || desc->face_count > MOST)
        return glint_fail(error, GLINT_ERR_INVALID, "faces: 1 .. %zu expected, got %zu", MOST, desc->face_count);
    if (desc->normals && (desc->normal_count < 1 || desc->normal_count > MOST))
        return glint_fail(error, GLINT_ERR_INVALID, "normals: 1 .. %zu expected, got %zu", MOST, desc->normal_count);
    if (desc->normals && !desc->normal_corners && desc->normal_count != desc->vertex_count)
        return glint_fail(error, GLINT_ERR_INVALID, "normals: one per vertex (%zu) expected, got %zu",
                          desc->vertex_count, desc->normal_count);
    if (desc->uv && (desc->uv_count < 1 || desc->uv_count > MOST))
        return glint_fail(error, GLINT_ERR_INVALID, "uv: 1 .. %zu expected, got %zu", MOST, desc->uv_count);
    if (desc->uv && !desc->uv_corners && desc->uv_count != desc->vertex_count)
        return glint_fail(error, GLINT_ERR_INVALID, "uv: one per vertex (%zu) expected, got %zu", desc->vertex_count,
                          desc->uv_count);
    for (size_t i = 0; i < desc->material_count; i++)
        if (!desc->materials[i])
            return glint_fail(error, GLINT_ERR_INVALID, "materials: entry %zu is missing", i + 1);
    if (desc->material_index && !desc->material_count)
        return glint_fail(error, GLINT_ERR_INVALID, "materials: an index needs 1 or more, got none");
    glint_status status = glint_check_transform("transform", &desc->transform, error);
    if (!status)
        status = glint_check_range("terminator", desc->terminator, 0, 1, "number 0 .. 1", error);
    return !status && desc->has_shading ? glint_check_shading(desc->shading, error) : status;
}

static glint_status check_vertices(const glint_mesh_desc *desc, glint_error *error)
{
    for (size_t i = 0; i < desc->vertex_count; i++) {
        const double *v = desc->vertices + 3 * i;
        if (!isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2]))
            return glint_fail(error, GLINT_ERR_INVALID,
                              "vertices[%zu]: three finite numbers expected, got {%.15g, %.15g, %.15g}", i + 1, v[0],
                              v[1], v[2]);
    }
    for (size_t i = 0; desc->normals && i < desc->normal_count; i++) {
        const double *v = desc->normals + 3 * i;
        if (!isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2]) || is_zero(v))
            return glint_fail(error, GLINT_ERR_INVALID,
                              "normals[%zu]: expected three finite numbers, not all 0, got {%.15g, %.15g, %.15g}",
                              i + 1, v[0], v[1], v[2]);
    }
    for (size_t i = 0; desc->uv && i < desc->uv_count; i++) {
        const double *v = desc->uv + 2 * i;
        if (!isfinite(v[0]) || !isfinite(v[1]))
            return glint_fail(error, GLINT_ERR_INVALID, "uv[%zu]: two finite numbers expected, got {%.15g, %.15g}",
                              i + 1, v[0], v[1]);
    }
    return GLINT_OK;
}

static glint_status check_face(const builder *b, size_t first_corner)
{
    const glint_mesh_desc *desc = b->desc;
    if (b->face.size < 3)
        return glint_fail(b->error, GLINT_ERR_INVALID, "faces[%zu]: 3 vertices or more expected, got %u", b->number,
                          b->face.size);
    if (desc->material_count && material_of(b) >= desc->material_count)
        return glint_fail(b->error, GLINT_ERR_INVALID, "faces[%zu]: material 1 .. %zu expected, got %llu", b->number,
                          desc->material_count, (unsigned long long)material_of(b) + 1);
    for (uint32_t i = 0; i < b->face.size; i++) {
        if (b->face.corners[i] >= desc->vertex_count)
            return glint_fail(b->error, GLINT_ERR_INVALID, "faces[%zu]: vertex 1 .. %zu expected, got %llu", b->number,
                              desc->vertex_count, (unsigned long long)b->face.corners[i] + 1);
        const uint32_t normal = desc->normals && desc->normal_corners ? desc->normal_corners[first_corner + i] : 0;
        if (normal != GLINT_NO_NORMAL && desc->normals && normal >= desc->normal_count)
            return glint_fail(b->error, GLINT_ERR_INVALID, "faces[%zu]: normal 1 .. %zu expected, got %llu", b->number,
                              desc->normal_count, (unsigned long long)normal + 1);
        const uint32_t uv = desc->uv && desc->uv_corners ? desc->uv_corners[first_corner + i] : 0;
        if (uv == GLINT_NO_UV && desc->uv && !b->mesh->uv_missing[material_of(b)])
            b->mesh->uv_missing[material_of(b)] = b->number;
        if (uv != GLINT_NO_UV && desc->uv && uv >= desc->uv_count)
            return glint_fail(b->error, GLINT_ERR_INVALID, "faces[%zu]: uv 1 .. %zu expected, got %llu", b->number,
                              desc->uv_count, (unsigned long long)uv + 1);
    }
    return GLINT_OK;
}

// ---- The mesh ----

static glint_status copy_vertices(const glint_mesh_desc *desc, glint_mesh *mesh, glint_error *error)
{
    mesh->vertex_count = desc->vertex_count;
    mesh->vertices = malloc(desc->vertex_count * sizeof *mesh->vertices);
    if (desc->normals)
        mesh->normals = malloc((desc->normal_count + 1) * sizeof *mesh->normals);
    if (desc->uv)
        mesh->uv = calloc(desc->uv_count + 1, sizeof *mesh->uv);
    if (!mesh->vertices || (desc->normals && !mesh->normals) || (desc->uv && !mesh->uv))
        return glint_fail_nomem(error);
    for (size_t i = 0; i < desc->vertex_count; i++)
        for (int c = 0; c < 3; c++)
            mesh->vertices[i][c] = desc->vertices[3 * i + (size_t)c] + 0.0; // -0 and 0 are the same position
    for (size_t i = 0; desc->normals && i < desc->normal_count; i++)
        vec_normalize(mesh->normals[i], desc->normals + 3 * i);
    if (desc->normals)
        vec_scale(mesh->normals[desc->normal_count], desc->vertices, 0);
    if (desc->uv)
        memcpy(mesh->uv, desc->uv, desc->uv_count * sizeof *mesh->uv);
    return GLINT_OK;
}

static void sign_uv(glint_mesh *mesh, size_t uv_count)
{
    mesh->uv_key = glint_key_add((glint_key) { 0 }, mesh->uv, uv_count * sizeof *mesh->uv);
    if (mesh->triangle_uv)
        mesh->uv_key = glint_key_add(mesh->uv_key, mesh->triangle_uv, mesh->triangle_count * sizeof *mesh->triangle_uv);
}

static bool has_polygons(const glint_mesh_desc *desc)
{
    for (size_t i = 0; i < desc->face_count; i++)
        if (desc->face_sizes[i] > 3)
            return true;
    return false;
}

/// Allocates space for one triangle per face.
static glint_status allocate(builder *b)
{
    glint_mesh *mesh = b->mesh;
    const glint_mesh_desc *desc = b->desc;
    const bool numbered = desc->normals && desc->normal_corners, mapped = desc->uv && desc->uv_corners;
    const bool polygons = has_polygons(desc), several = desc->material_count > 1;
    mesh->triangles = malloc(b->capacity * sizeof *mesh->triangles);
    mesh->triangle_normals = numbered ? malloc(b->capacity * sizeof *mesh->triangles) : NULL;
    mesh->triangle_uv = mapped ? malloc(b->capacity * sizeof *mesh->triangles) : NULL;
    mesh->faces = polygons ? malloc(b->capacity * sizeof *mesh->faces) : NULL;
    mesh->uv_missing = calloc(desc->material_count ? desc->material_count : 1, sizeof *mesh->uv_missing);
    b->index = several ? malloc(b->capacity * sizeof *b->index) : NULL;
    if (!mesh->triangles || (numbered && !mesh->triangle_normals) || (mapped && !mesh->triangle_uv) ||
        (polygons && !mesh->faces) || !mesh->uv_missing || (several && !b->index))
        return glint_fail_nomem(b->error);
    return GLINT_OK;
}

static glint_status fill(builder *b)
{
    const glint_mesh_desc *desc = b->desc;
    glint_mesh *mesh = b->mesh;
    glint_status status = copy_vertices(desc, mesh, b->error);
    if (!status)
        status = allocate(b);
    mesh->face_count = desc->face_count;
    size_t first = 0;
    for (size_t i = 0; i < desc->face_count && !status; i++) {
        b->number = i + 1;
        b->face.vertices = desc->vertices;
        b->face.corners = desc->corners + first;
        b->face.size = desc->face_sizes[i];
        status = check_face(b, first);
        if (!status)
            status = cut_face(b, first);
        first += b->face.size;
    }
    glint_ears_free(&b->ears);
    if (!status && mesh->triangle_count == 0)
        status = glint_fail(b->error, GLINT_ERR_INVALID, "faces: one with an area expected, got %zu without",
                            desc->face_count);
    if (!status && mesh->uv)
        sign_uv(mesh, desc->uv_count);
    return status;
}

static glint_status take_materials(const glint_mesh_desc *desc, glint_shape *shape, glint_error *error)
{
    const size_t count = desc->material_count ? desc->material_count : 1;
    for (size_t i = 0; i < count; i++) {
        shape->materials[i] =
            glint_material_or_default(desc->material_count ? desc->materials[i] : desc->material, error);
        if (!shape->materials[i])
            return GLINT_ERR_NOMEM;
        shape->material_count++;
    }
    shape->desc.material = shape->materials[0];
    shape->dressed = desc->material_count || desc->material;
    return GLINT_OK;
}

static glint_status make_shape(const glint_mesh_desc *desc, glint_mesh_faults *faults, glint_shape *shape,
                               glint_error *error)
{
    shape->mesh = calloc(1, sizeof *shape->mesh);
    if (!shape->mesh)
        return glint_fail_nomem(error);
    builder b = { .desc = desc, .mesh = shape->mesh, .capacity = desc->face_count, .faults = faults, .error = error };
    glint_status status = take_materials(desc, shape, error);
    if (!status)
        status = fill(&b);
    shape->index = b.index;
    if (!status)
        status = glint_mesh_prepare(shape->mesh, shape->index, shape->desc.shading, error);
    shape->count = shape->mesh->triangle_count;
    for (size_t i = 0; i < shape->mesh->vertex_count && !status; i++)
        glint_shape_stretch(shape, shape->mesh->vertices[i], 0, i == 0);
    return status;
}

static glint_status make(const glint_mesh_desc *given, glint_mesh_faults *faults, glint_shape **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_mesh_desc, defaults());
    status = check_counts(desc, error);
    if (!status)
        status = check_vertices(desc, error);
    if (status)
        return status;
    glint_shape_desc base = glint_shape_desc_default(GLINT_SHAPE_MESH);
    base.two_sided = desc->two_sided;
    base.transform = desc->transform;
    base.terminator = desc->terminator;
    base.shading = desc->has_shading ? desc->shading : desc->normals ? GLINT_SHADING_PHONG : GLINT_SHADING_FACETED;
    memcpy(base.name, desc->name, sizeof base.name);
    glint_shape *shape = glint_shape_alloc(&base, desc->material_count ? desc->material_count : 1);
    if (!shape)
        return glint_fail_nomem(error);
    status = make_shape(desc, faults, shape, error);
    if (status) {
        glint_shape_release(shape);
        return status;
    }
    *out = shape;
    return GLINT_OK;
}

glint_status glint_mesh_create(const glint_mesh_desc *desc, glint_shape **out, glint_error *error)
{
    return make(desc, NULL, out, error);
}

glint_status glint_mesh_create_counting(const glint_mesh_desc *desc, glint_mesh_faults *faults, glint_shape **out,
                                        glint_error *error)
{
    GLINT_REFUSE_NULL(faults, error);
    return make(desc, faults, out, error);
}
