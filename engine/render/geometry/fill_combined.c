/// Makes the primitives of combined solids: the primitive that rays intersect, its parts, and the triangles of parts
/// that are meshes.
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/geometry/fill.h"

/// A combined solid that is being filled.
typedef struct maker {
    glint_shape *shape; ///< the whole
    glint_combined *combined;
    uint32_t nothings; ///< number of empty groups among the parts
    uint32_t medium; ///< index of the combined solid's material
} maker;

/// Returns the shape whose material is used for parts without a material: the whole solid, or one of its parts.
static const glint_shape *find_dress(const glint_shape *shape)
{
    if (shape->dressed && shape->desc.kind != GLINT_SHAPE_GROUP)
        return shape;
    for (size_t i = 0; i < shape->children.count; i++) {
        const glint_shape *found = find_dress(shape->children.items[i]);
        if (found)
            return found;
    }
    return NULL;
}

static glint_status too_many_parts(const glint_filler *f, const maker *m)
{
    char name[2 * GLINT_NAME_SIZE];
    glint_describe_shape(&m->shape->desc, f->geometry->whole_count, name, sizeof name);
    return glint_fail(f->error, GLINT_ERR_INVALID, "%s: at most %d parts expected", name, GLINT_PARTS_MAX);
}

/// Adds a part and leaves its position unset. order: see glint_prim.face.
static glint_status start_member(glint_filler *f, maker *m, glint_shape *shape, const glint_placing *placing,
                                 const glint_shape *dress, bool inverted, uint32_t order, glint_prim **out)
{
    glint_geometry *geometry = f->geometry;
    uint32_t material;
    glint_status status = glint_fill_material(&geometry->materials, dress->materials[0], &material, f->error);
    if (status)
        return status;
    const uint32_t part = (uint32_t)f->parts + f->member_count;
    glint_prim *prim = *out = &geometry->members[f->member_count++];
    glint_fill_part(f, part, shape, placing);
    geometry->parts[part].dress = dress;
    geometry->parts[part].whole = m->shape;
    glint_fill_dress(f, prim, part, material, m->medium, m->shape->desc.two_sided);
    prim->inverted = inverted;
    prim->face = order;
    m->combined->program[m->combined->length++] = (uint8_t)m->combined->count++;
    if (order > 1)
        m->combined->program[m->combined->length++] = GLINT_COMBINE_UNION;
    return GLINT_OK;
}

/// Adds a part that is a solid, ball or plane; half: 1 and 2 for the two halves of a torus, otherwise 0.
static glint_status add_member(glint_filler *f, maker *m, glint_shape *shape, const glint_placing *placing,
                               const glint_shape *dress, bool inverted, uint32_t half)
{
    glint_prim *prim;
    glint_status status = start_member(f, m, shape, placing, dress, inverted, half, &prim);
    if (status)
        return status;
    if (shape->desc.kind == GLINT_SHAPE_PLANE) {
        glint_plane_init(prim, f->geometry->planes[f->plane_count++], shape->desc.point, shape->desc.normal, placing);
        return GLINT_OK;
    }
    glint_fill_solid(f, prim, &shape->desc, placing);
    prim->face = half;
    return GLINT_OK;
}

/// Adds the triangles of a part that is a mesh; the indices of their materials are in f->numbers.
static void add_hull_triangles(glint_filler *f, const maker *m, glint_shape *shape, const glint_placing *placing,
                               const glint_shape *dress, bool inverted, glint_prim *box)
{
    glint_geometry *geometry = f->geometry;
    const uint32_t part = (uint32_t)(f->parts + f->members) + f->hull_count;
    glint_hull *hull = &geometry->hulls[f->hull_count++];
    *hull = (glint_hull) { .first = (uint32_t)f->members + f->hull_prim_count, .count = (uint32_t)shape->count };
    glint_fill_part(f, part, shape, placing);
    geometry->parts[part].dress = dress;
    geometry->parts[part].whole = m->shape;
    f->level_axis = 3;
    for (size_t i = 0; i < shape->count; i++) {
        glint_prim *prim = &geometry->members[hull->first + i];
        double lower[3], upper[3];
        glint_fill_dress(f, prim, part, f->numbers[dress == shape && shape->index ? shape->index[i] : 0], m->medium,
                   m->shape->desc.two_sided);
        glint_fill_triangle(f, prim, shape, i, placing,
                            (glint_is_mirroring(placing) != shape->mesh->closure.inverted) != inverted);
        glint_prim_bounds(NULL, prim, lower, upper);
        for (int c = 0; c < 3; c++) {
            box->corner[1][c] = i ? fmin(box->corner[1][c], lower[c]) : lower[c];
            box->corner[2][c] = i ? fmax(box->corner[2][c], upper[c]) : upper[c];
        }
    }
    f->hull_prim_count += hull->count;
}

/// Adds a closed mesh as GLINT_HULL_PARTS parts, and its triangles.
static glint_status add_hull(glint_filler *f, maker *m, glint_shape *shape, const glint_placing *placing,
                             const glint_shape *dress, bool inverted)
{
    glint_status status = GLINT_OK;
    glint_prim *prim[GLINT_HULL_PARTS];
    const uint32_t hull = f->hull_count;
    for (size_t i = 0; i < dress->material_count && !status; i++)
        status = glint_fill_material(&f->geometry->materials, dress->materials[i], &f->numbers[i], f->error);
    for (uint32_t k = 0; k < GLINT_HULL_PARTS && !status; k++)
        status = start_member(f, m, shape, placing, dress, inverted, k + 1, &prim[k]);
    if (status)
        return status;
    for (uint32_t k = 0; k < GLINT_HULL_PARTS; k++)
        prim[k]->corner = f->geometry->corners[f->corner_count++];
    add_hull_triangles(f, m, shape, placing, dress, inverted, prim[0]);
    for (uint32_t k = 0; k < GLINT_HULL_PARTS; k++) {
        prim[k]->kind = GLINT_PRIM_HULL;
        prim[k]->item = hull;
        for (int c = 0; c < 3; c++) {
            prim[k]->corner[1][c] = prim[0]->corner[1][c];
            prim[k]->corner[2][c] = prim[0]->corner[2][c];
            prim[k]->corner[0][c] = 0.5 * prim[0]->corner[1][c] + 0.5 * prim[0]->corner[2][c];
        }
    }
    return GLINT_OK;
}

static uint8_t operation_of(const glint_shape *shape)
{
    return shape->desc.kind == GLINT_SHAPE_INTERSECTION ? GLINT_COMBINE_INTERSECTION
           : shape->desc.kind == GLINT_SHAPE_DIFFERENCE ? GLINT_COMBINE_DIFFERENCE
                                                        : GLINT_COMBINE_UNION;
}

/// Adds a shape to a combined solid. dress: the shape whose material is used for shapes without a material.
static glint_status add_to_whole(glint_filler *f, maker *m, glint_shape *shape, const glint_transform *around,
                                 const glint_shape *dress, bool inverted)
{
    glint_combined *combined = m->combined;
    glint_transform map;
    glint_placing placing;
    glint_status status = glint_fill_placing(f, shape, around, &map, &placing);
    if (status)
        return status;
    if (shape->dressed && shape->desc.kind != GLINT_SHAPE_GROUP)
        dress = shape;
    const bool torus = shape->desc.kind == GLINT_SHAPE_TORUS;
    if (combined->count + m->nothings + glint_member_parts(shape) > GLINT_PARTS_MAX)
        return too_many_parts(f, m);
    if (shape->mesh)
        return add_hull(f, m, shape, &placing, dress, inverted);
    if (torus)
        status = add_member(f, m, shape, &placing, dress, inverted, 1);
    if (!glint_shape_has_children(shape))
        return status ? status : add_member(f, m, shape, &placing, dress, inverted, torus ? 2 : 0);
    if (shape->children.count == 0) {
        combined->program[combined->length++] = GLINT_COMBINE_NOTHING;
        m->nothings++;
    }
    for (size_t i = 0; i < shape->children.count && !status; i++) {
        const bool away = i > 0 && shape->desc.kind == GLINT_SHAPE_DIFFERENCE;
        status = add_to_whole(f, m, shape->children.items[i], placing.map, dress, inverted != away);
        if (i > 0)
            combined->program[combined->length++] = operation_of(shape);
    }
    return status;
}

/// Adds a combined solid. around: as for add_shape.
glint_status glint_fill_combined(glint_filler *f, glint_shape *shape, const glint_placing *placing,
                                 const glint_transform *around)
{
    glint_geometry *geometry = f->geometry;
    glint_prim *prim = &geometry->prims[geometry->table.prim_count++];
    const uint32_t part = geometry->whole_count++;
    const glint_shape *dress = find_dress(shape);
    maker m = { .shape = shape, .combined = &geometry->combined[f->combined_count] };
    if (!dress)
        dress = shape;
    glint_status status = glint_fill_material(&geometry->materials, dress->materials[0], &m.medium, f->error);
    if (status)
        return status;
    glint_fill_part(f, part, shape, placing);
    geometry->parts[part].dress = dress;
    *m.combined = (glint_combined) { .first = f->member_count };
    glint_fill_dress(f, prim, part, m.medium, m.medium, shape->desc.two_sided);
    prim->kind = GLINT_PRIM_COMBINED;
    prim->corner = geometry->corners[f->corner_count++];
    prim->item = f->combined_count++;
    char name[2 * GLINT_NAME_SIZE];
    glint_describe_shape(&shape->desc, geometry->whole_count, name, sizeof name);
    for (size_t i = 0; i < shape->children.count && !status; i++)
        status = glint_check_part(name, shape->children.items[i], f->error);
    if (!status)
        status = add_to_whole(f, &m, shape, around, dress, false);
    if (!status) {
        glint_combined_roles(m.combined);
        glint_combined_box(geometry, m.combined, prim->corner);
    }
    f->object_count++;
    return status;
}
