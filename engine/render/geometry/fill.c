/// Makes the primitives of a scene from its shapes, with their materials and parts.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/geometry/fill.h"

#include <stdlib.h>
#include <string.h>

/// Maps the normal of a corner for smooth shading. If the map does not preserve angles, all normals of the mesh keep
/// the lengths that the map gives them, with a common factor: interpolated normals are then the map of normals
/// interpolated in the mesh's own space.
static void place_corner_normal(const glint_placing *placing, const double n[3], double out[3])
{
    double largest = 0;
    if (!placing->map || placing->similar) {
        glint_place_normal(placing, n, out);
        return;
    }
    for (int c = 0; c < 3; c++)
        largest = fmax(largest, vec_max_abs(placing->cofactors[c]));
    const double scale = power_of_two_scale(largest) * (placing->determinant < 0 ? -1 : 1);
    for (int c = 0; c < 3; c++)
        out[c] = vec_dot(placing->cofactors[c], n) * scale;
}

glint_status glint_fill_material(glint_list *materials, glint_material *material, uint32_t *out, glint_error *error)
{
    size_t index = glint_list_find(materials, material);
    glint_status status = GLINT_OK;
    if (index == materials->count)
        status = glint_list_add(materials, material, error);
    *out = (uint32_t)index;
    return status;
}

static bool is_smooth(const glint_shape *shape)
{
    return shape->mesh && (shape->desc.shading == GLINT_SHADING_PHONG || shape->desc.shading == GLINT_SHADING_GOURAUD);
}

static bool is_shared(const glint_shape *shape)
{
    return shape->mesh && (shape->desc.shading == GLINT_SHADING_FLAT || shape->desc.shading == GLINT_SHADING_GOURAUD);
}

/// Returns the number of shading points of one instance of a shape.
static size_t count_shading_points(const glint_shape *shape)
{
    if (!is_shared(shape))
        return 0;
    return shape->desc.shading == GLINT_SHADING_FLAT ? shape->mesh->face_count : shape->mesh->shading_point_count;
}

/// Returns the shading point of corner j of triangle i, counted from the shape's first one.
static uint32_t shading_point_of(const glint_shape *shape, size_t i, int j)
{
    const glint_mesh *mesh = shape->mesh;
    if (shape->desc.shading == GLINT_SHADING_FLAT)
        return mesh->faces ? mesh->faces[i] : (uint32_t)i;
    return (mesh->shading_points ? mesh->shading_points : mesh->triangles)[i][j];
}

static void name_shading_point(glint_geometry *geometry, const glint_prim *prim, int j, uint32_t shading_point)
{
    geometry->shading_points[prim->shading_points].at[j] = shading_point;
    if (prim->id < geometry->shading_point_prims[shading_point])
        geometry->shading_point_prims[shading_point] = prim->id;
}

/// Makes a triangle that is perpendicular to an axis share its face with other triangles in the same plane, first
/// those of its own mesh.
static void share_face(glint_filler *f, glint_prim *prim, const glint_mesh *mesh, size_t i,
                       const glint_placing *placing)
{
    double lower[3], upper[3], normal[3], own[3] = { 0, 0, 0 };
    const int axis = glint_level_axis(mesh, i);
    const double *corner = mesh->vertices[mesh->triangles[i][0]];
    if (axis == 3)
        return;
    if (axis != f->level_axis || corner[axis] != f->level) {
        for (int c = 0; c < 3; c++)
            normal[c] = c == axis;
        glint_face_init(&f->geometry->faces[f->face_count++], placing, normal, corner);
    }
    f->level_axis = axis;
    f->level = corner[axis];
    prim->face = f->face_count;
    glint_prim_bounds(NULL, prim, lower, upper);
    for (int j = 0; j < 3; j++)
        for (int c = 0; c < 3; c++)
            own[c] = fmax(own[c], fabs(mesh->vertices[mesh->triangles[i][j]][c]));
    glint_face_bound(&f->geometry->faces[prim->face - 1], placing, lower, upper, own);
}

void glint_fill_triangle(glint_filler *f, glint_prim *prim, const glint_shape *shape, size_t i,
                         const glint_placing *placing, bool reversed)
{
    const glint_mesh *mesh = shape->mesh;
    const uint32_t *at = mesh->triangles[i], *normal = mesh->triangle_normals ? mesh->triangle_normals[i] : at;
    prim->kind = GLINT_PRIM_TRIANGLE;
    prim->corner = f->geometry->corners[f->corner_count++];
    prim->face = 0;
    prim->item = is_smooth(shape) ? f->normal_count++ : GLINT_MISS;
    if (prim->item != GLINT_MISS && shape->desc.shading == GLINT_SHADING_PHONG) {
        f->geometry->normals[prim->item].terminator = shape->desc.terminator;
        f->geometry->table.moves = f->geometry->table.moves || shape->desc.terminator > 0;
    }
    prim->shading_points = is_shared(shape) ? f->shared_count++ : GLINT_MISS;
    for (int j = 0; j < 3; j++) {
        const int from = reversed ? (3 - j) % 3 : j;
        glint_place_point(placing, mesh->vertices[at[from]], prim->corner[j]);
        if (prim->item != GLINT_MISS)
            place_corner_normal(placing, mesh->normals[normal[from]], f->geometry->normals[prim->item].normal[j]);
        if (prim->shading_points != GLINT_MISS)
            name_shading_point(f->geometry, prim, j,
                               f->geometry->table.shading_point_count + shading_point_of(shape, i, from));
    }
    share_face(f, prim, mesh, i, placing);
}

void glint_fill_solid(glint_filler *f, glint_prim *prim, const glint_shape_desc *desc, const glint_placing *placing)
{
    glint_geometry *geometry = f->geometry;
    prim->item = f->solid_count++;
    f->face_count += (uint32_t)glint_solid_init(prim, &geometry->solids[prim->item], desc, placing,
                                                geometry->faces ? geometry->faces + f->face_count : NULL);
    geometry->table.tori = geometry->table.tori || desc->kind == GLINT_SHAPE_TORUS;
}

/// Adds a ball, which stays a sphere if the map preserves angles.
static void add_ball(glint_filler *f, glint_prim *prim, const double center[3], double radius,
                     const glint_placing *placing)
{
    double factor = 1, moved[3];
    if (!placing->map || glint_transform_similar(placing->map, &factor)) {
        glint_place_point(placing, center, moved);
        glint_sphere_init(prim, moved, radius * factor);
        return;
    }
    glint_shape_desc desc = { .kind = GLINT_SHAPE_SPHERE, .radius = radius };
    vec_copy(desc.center, center);
    glint_fill_solid(f, prim, &desc, placing);
}

static void add_cylinder(glint_filler *f, glint_prim *prim, const glint_shape_desc *many, const double item[],
                         const glint_placing *placing)
{
    glint_shape_desc desc = { .kind = GLINT_SHAPE_CYLINDER, .radius = item[6], .capped = many->capped };
    vec_copy(desc.base, item);
    vec_copy(desc.top, item + 3);
    glint_fill_solid(f, prim, &desc, placing);
}

void glint_fill_dress(glint_filler *f, glint_prim *prim, uint32_t part, uint32_t material, uint32_t medium, bool two_sided)
{
    *prim = (glint_prim) { .id = f->id_count++, .two_sided = two_sided, .material = material, .medium = medium };
    f->geometry->prim_part[prim->id] = part;
}

static void add_prim(glint_filler *f, const glint_shape *shape, size_t i, uint32_t part, const glint_placing *placing)
{
    glint_geometry *geometry = f->geometry;
    const glint_shape_desc *desc = &shape->desc;
    const uint32_t material = f->numbers[shape->index ? shape->index[i] : 0];
    glint_prim *prim = &geometry->prims[geometry->table.prim_count++];
    glint_fill_dress(f, prim, part, material, material, desc->two_sided);
    switch (desc->kind) {
    case GLINT_SHAPE_MESH:
        glint_fill_triangle(f, prim, shape, i, placing, glint_is_mirroring(placing));
        break;
    case GLINT_SHAPE_SPHERES:
        add_ball(f, prim, shape->items + GLINT_SPHERE_NUMBERS * i, shape->items[GLINT_SPHERE_NUMBERS * i + 3], placing);
        break;
    case GLINT_SHAPE_CYLINDERS:
        add_cylinder(f, prim, desc, shape->items + GLINT_CYLINDER_NUMBERS * i, placing);
        break;
    case GLINT_SHAPE_SPHERE:
        add_ball(f, prim, desc->center, desc->radius, placing);
        break;
    case GLINT_SHAPE_PLANE:
        glint_plane_init(prim, geometry->planes[f->plane_count++], desc->point, desc->normal, placing);
        break;
    default:
        glint_fill_solid(f, prim, desc, placing);
        break;
    }
}

void glint_fill_part(glint_filler *f, uint32_t part, glint_shape *shape, const glint_placing *placing)
{
    glint_geometry *geometry = f->geometry;
    geometry->parts[part] =
        (glint_part) { .shape = shape, .dress = shape, .first_prim = f->id_count, .first_object = f->object_count };
    if (placing->map) {
        geometry->maps[f->map_count] = *placing->map;
        geometry->parts[part].map = &geometry->maps[f->map_count++];
    }
    geometry->part_count++;
}

static glint_status add_prims(glint_filler *f, glint_shape *shape, const glint_placing *placing)
{
    glint_geometry *geometry = f->geometry;
    for (size_t i = 0; i < shape->material_count; i++) {
        glint_status status = glint_fill_material(&geometry->materials, shape->materials[i], &f->numbers[i], f->error);
        if (status)
            return status;
    }
    const uint32_t part = geometry->whole_count++;
    glint_fill_part(f, part, shape, placing);
    f->level_axis = 3;
    for (size_t i = 0; i < shape->count; i++)
        add_prim(f, shape, i, part, placing);
    f->object_count += shape->mesh ? 1 : (uint32_t)shape->count;
    geometry->table.triangles += shape->mesh ? (uint32_t)shape->count : 0;
    geometry->table.shading_point_count += (uint32_t)count_shading_points(shape);
    return GLINT_OK;
}

glint_status glint_fill_placing(const glint_filler *f, const glint_shape *shape, const glint_transform *around,
                                 glint_transform *map, glint_placing *placing)
{
    double linear[3][3], factor = 1;
    glint_status status = GLINT_OK;
    *map = around ? glint_transform_product(around, &shape->desc.transform) : shape->desc.transform;
    *placing = (glint_placing) { .map = map };
    if (glint_transform_is_identity(map))
        placing->map = NULL;
    else if (around)
        status = glint_check_transform("group.transform: combined with the groups around it", map, f->error);
    if (status)
        return status;
    glint_transform_linear(map, linear);
    glint_linear_scale(linear);
    placing->determinant = glint_linear_cofactors(linear, placing->cofactors);
    placing->similar = !placing->map || glint_transform_similar(map, &factor);
    return GLINT_OK;
}

/// Adds a shape. around: the map of the groups that contain the shape; NULL: the identity.
static glint_status add_shape(glint_filler *f, glint_shape *shape, const glint_transform *around)
{
    glint_transform map;
    glint_placing placing;
    glint_status status = glint_fill_placing(f, shape, around, &map, &placing);
    if (status)
        return status;
    if (glint_shape_combines(shape))
        return glint_fill_combined(f, shape, &placing, around);
    if (shape->desc.kind != GLINT_SHAPE_GROUP)
        return add_prims(f, shape, &placing);
    for (size_t i = 0; i < shape->children.count && !status; i++)
        status = add_shape(f, shape->children.items[i], placing.map);
    return status;
}

#define VISITS_MAX ((size_t)1 << 28) ///< shapes and groups, each counted once per instance

/// Returns the number of flat faces of a solid's instances, at most.
static size_t count_faces(const glint_shape *shape)
{
    return glint_shape_is_solid(shape) ? (shape->desc.kind == GLINT_SHAPE_BOX ? 6 : 2) * shape->count : 0;
}

/// Counts the primitives of a shape. mapped: the shape is in a group that has a transform. within: the shape is in a
/// combined solid.
static glint_status count_shape(glint_filler *f, const glint_shape *shape, bool mapped, bool within)
{
    const bool group = glint_shape_has_children(shape) && (within || !glint_shape_combines(shape));
    glint_status status = GLINT_OK;
    mapped = mapped || !glint_transform_is_identity(&shape->desc.transform);
    if (++f->visits > VISITS_MAX)
        return glint_fail(f->error, GLINT_ERR_INVALID, "scene: at most %zu shapes and groups expected", VISITS_MAX);
    for (size_t i = 0; i < shape->children.count && !status; i++)
        status = count_shape(f, shape->children.items[i], mapped, within || glint_shape_combines(shape));
    if (within && !group) {
        const size_t count = glint_member_parts(shape);
        f->members += count;
        f->hulls += shape->mesh != NULL;
        f->hull_prims += shape->mesh ? shape->count : 0;
        f->corners += shape->mesh ? shape->count + count : 0;
        f->planes += shape->desc.kind == GLINT_SHAPE_PLANE;
        f->smooth += is_smooth(shape) ? shape->count : 0;
        f->maps += mapped ? count + 1 : 0;
        f->solids += shape->mesh ? 0 : count;
        f->faces += shape->mesh ? glint_count_levels(shape->mesh) : 6; // at most
        f->materials = shape->material_count > f->materials ? shape->material_count : f->materials;
        return status;
    }
    f->planes += shape->desc.kind == GLINT_SHAPE_PLANE;
    f->corners += shape->mesh ? shape->count : !within && glint_shape_combines(shape);
    f->combined += !within && glint_shape_combines(shape);
    f->parts += !group;
    f->maps += !group && mapped; // at most
    f->prims += group ? 0 : shape->count;
    f->smooth += is_smooth(shape) ? shape->count : 0;
    f->shared += is_shared(shape) ? shape->count : 0;
    f->shading_points += count_shading_points(shape);
    f->solids += mapped || glint_shape_is_solid(shape) ? shape->count : 0; // at most
    f->faces += shape->mesh ? glint_count_levels(shape->mesh) : count_faces(shape);
    f->materials = shape->material_count > f->materials ? shape->material_count : f->materials;
    return status;
}

static bool allocate_shading_points(glint_filler *f)
{
    glint_geometry *geometry = f->geometry;
    if (!f->shading_points)
        return true;
    geometry->shading_points = glint_alloc(f->shared, sizeof *geometry->shading_points);
    geometry->shading_point_prims = glint_alloc(f->shading_points, sizeof *geometry->shading_point_prims);
    if (!geometry->shading_points || !geometry->shading_point_prims)
        return false;
    memset(geometry->shading_point_prims, 0xff, f->shading_points * sizeof *geometry->shading_point_prims);
    return true;
}

static bool allocate(glint_filler *f)
{
    glint_geometry *geometry = f->geometry;
    const size_t members = f->members + f->hull_prims;
    geometry->member_count = (uint32_t)members;
    f->numbers = glint_alloc(f->materials, sizeof *f->numbers);
    // members are appended when the primitives are arranged
    geometry->prims = glint_alloc_large(f->prims + members, sizeof *geometry->prims);
    geometry->members = members ? glint_alloc(members, sizeof *geometry->members) : NULL;
    geometry->hulls = f->hulls ? glint_alloc(f->hulls, sizeof *geometry->hulls) : NULL;
    geometry->combined = f->combined ? glint_alloc(f->combined, sizeof *geometry->combined) : NULL;
    geometry->prim_part = glint_alloc(f->prims + members, sizeof *geometry->prim_part);
    geometry->parts = glint_alloc(f->parts + f->members + f->hulls, sizeof *geometry->parts);
    geometry->maps = f->maps ? glint_alloc(f->maps, sizeof *geometry->maps) : NULL;
    geometry->normals = f->smooth ? glint_alloc(f->smooth, sizeof *geometry->normals) : NULL;
    f->solids += f->combined > 0; // if there are no `solids`, kernels look neither for solids nor for combined solids
    geometry->solids = f->solids ? glint_alloc(f->solids, sizeof *geometry->solids) : NULL;
    geometry->faces = f->faces ? glint_alloc(f->faces, sizeof *geometry->faces) : NULL;
    geometry->corners = f->corners ? glint_alloc_large(f->corners, sizeof *geometry->corners) : NULL;
    geometry->planes = f->planes ? glint_alloc(f->planes, sizeof *geometry->planes) : NULL;
    if ((f->corners && !geometry->corners) || (f->planes && !geometry->planes))
        return false;
    if ((f->members && !geometry->members) || (f->combined && !geometry->combined) || (f->hulls && !geometry->hulls))
        return false;
    return f->numbers && geometry->prims && geometry->prim_part && geometry->parts && (geometry->maps || !f->maps) &&
           (geometry->normals || !f->smooth) && (geometry->solids || !f->solids) && (geometry->faces || !f->faces) &&
           allocate_shading_points(f);
}

glint_status glint_geometry_fill(glint_geometry *geometry, const glint_scene *scene, glint_error *error)
{
    glint_filler f = { .geometry = geometry, .error = error };
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < scene->shapes.count && !status; i++)
        status = count_shape(&f, glint_scene_shape(scene, i), false, false);
    const size_t surfaces = f.prims + f.members + f.hull_prims;
    if (!status && surfaces >= INT32_MAX)
        status = glint_fail(error, GLINT_ERR_INVALID, "scene: fewer than 2147483647 surfaces expected, got %zu", surfaces);
    if (!status && f.shading_points >= INT32_MAX)
        status = glint_fail(error, GLINT_ERR_INVALID,
                            "scene: fewer than 2147483647 faces and vertices with light of their own expected, got %zu",
                            f.shading_points);
    if (!status && !allocate(&f))
        status = glint_fail_nomem(error);
    for (size_t i = 0; i < scene->shapes.count && !status; i++)
        status = add_shape(&f, glint_scene_shape(scene, i), NULL);
    free(f.numbers);
    geometry->table.prims = geometry->prims;
    geometry->table.corner_normals = geometry->normals;
    geometry->table.solids = geometry->solids;
    geometry->table.combined = geometry->combined;
    geometry->table.hulls = geometry->hulls;
    geometry->hull_count = f.hull_count;
    geometry->id_count = f.id_count;
    geometry->corner_count = f.corner_count;
    geometry->table.shading_points = geometry->shading_points;
    geometry->table.faces = geometry->faces;
    return status;
}
