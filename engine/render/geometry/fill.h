/// Fills the primitives of a scene: fill.c, and fill_combined.c for combined solids. Internal.
#ifndef GLINT_FILL_H
#define GLINT_FILL_H

#include "engine/render/geometry/prims.h"

typedef struct glint_filler {
    glint_geometry *geometry;
    uint32_t *numbers; ///< material indices of the current shape
    uint32_t object_count, id_count;
    size_t members, combined; ///< number of parts of combined solids, and of combined solids
    size_t hulls, hull_prims; ///< number of parts that are meshes, and of their triangles
    size_t prims, parts, smooth, shared, shading_points, solids, faces,
        materials; ///< number of solids, faces and so on; materials: the largest number that one shape has
    size_t maps; ///< upper bound for the number of parts that have a map
    size_t corners, planes; ///< number of corners of triangles and boxes; number of rows of planes
    size_t visits, map_count;
    uint32_t corner_count, plane_count, normal_count, shared_count, solid_count, face_count, combined_count, hull_count, member_count, hull_prim_count;
    int level_axis; ///< axis that the shape's last axis-aligned triangle is perpendicular to; 3: there was none yet
    double level; ///< coordinate of that triangle on this axis
    glint_error *error;
} glint_filler;

/// Writes the indices of the shape's materials, and appends new materials to `materials`.
glint_status glint_fill_material(glint_list *materials, glint_material *material, uint32_t *out, glint_error *error);
/// Fills in a part. placing: the shape's placement under all groups around it.
void glint_fill_part(glint_filler *f, uint32_t part, glint_shape *shape, const glint_placing *placing);
/// Fills in the fields of a primitive that do not depend on its position.
void glint_fill_dress(glint_filler *f, glint_prim *prim, uint32_t part, uint32_t material, uint32_t medium, bool two_sided);
void glint_fill_solid(glint_filler *f, glint_prim *prim, const glint_shape_desc *desc, const glint_placing *placing);
/// Fills in a triangle. reversed: its corners are taken in reverse order, so that the front stays the front under a
/// mirroring map.
void glint_fill_triangle(glint_filler *f, glint_prim *prim, const glint_shape *shape, size_t i,
                         const glint_placing *placing, bool reversed);
/// Computes a shape's placement. around: the map of the groups that contain it; NULL: the identity. map: memory for
/// the product of the maps.
glint_status glint_fill_placing(const glint_filler *f, const glint_shape *shape, const glint_transform *around, glint_transform *map,
                                glint_placing *placing);
/// fill_combined.c: adds a combined solid and its parts. around: as for glint_fill_placing.
glint_status glint_fill_combined(glint_filler *f, glint_shape *shape, const glint_placing *placing,
                                 const glint_transform *around);

/// Returns how many parts of a combined solid a shape counts as. Not for groups.
static inline uint32_t glint_member_parts(const glint_shape *shape)
{
    return shape->mesh ? GLINT_HULL_PARTS : shape->desc.kind == GLINT_SHAPE_TORUS ? 2 : 1;
}

static inline bool glint_is_mirroring(const glint_placing *placing) { return placing->map && placing->determinant < 0; }

#endif
