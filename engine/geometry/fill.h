/// Fills the primitives of a scene: fill.c, and fill_combined.c for combined solids. Internal.
#ifndef GLINT_FILL_H
#define GLINT_FILL_H

#include "engine/geometry/prims.h"

typedef struct glint_filler {
    glint_geometry *geometry;
    uint32_t *numbers; ///< of the materials of the shape at hand
    uint32_t object_count, id_count;
    size_t members, combined; ///< parts of combined solids, and those
    size_t hulls, hull_prims; ///< of those that are meshes, and their triangles
    size_t prims, parts, smooth, shared, shading_points, solids, faces,
        materials; ///< how many there are; materials: most of any shape
    size_t maps; ///< of parts, at most
    size_t corners, planes; ///< of triangles and boxes; of planes
    size_t visits, map_count;
    uint32_t corner_count, plane_count, normal_count, shared_count, solid_count, face_count, combined_count, hull_count, member_count, hull_prim_count;
    int level_axis; ///< of the last triangle of the shape that is square to an axis; 3: none so far
    double level; ///< where on it
    glint_error *error;
} glint_filler;

/// The number of the shape's material in `materials`, which grows as new ones appear.
glint_status glint_fill_material(glint_list *materials, glint_material *material, uint32_t *out, glint_error *error);
/// place: of the shape under all groups around it.
void glint_fill_part(glint_filler *f, uint32_t part, glint_shape *shape, const glint_placing *place);
/// The fields of a primitive that do not depend on its place.
void glint_fill_dress(glint_filler *f, glint_prim *prim, uint32_t part, uint32_t material, uint32_t medium, bool two_sided);
void glint_fill_solid(glint_filler *f, glint_prim *prim, const glint_shape_desc *desc, const glint_placing *place);
/// turned: its corners are taken the other way round: under a map that mirrors, its front stays its front.
void glint_fill_triangle(glint_filler *f, glint_prim *prim, const glint_shape *shape, size_t i, const glint_placing *place, bool turned);
/// around: the map of the groups that the shape is in; NULL: the identity. map: room for its own under that.
glint_status glint_fill_placing(const glint_filler *f, const glint_shape *shape, const glint_transform *around, glint_transform *map,
                                glint_placing *place);
/// fill_combined.c: a combined solid and its parts. around: as above.
glint_status glint_fill_combined(glint_filler *f, glint_shape *shape, const glint_placing *place, const glint_transform *around);

/// How many parts of a combined solid a shape other than a group counts as.
static inline uint32_t glint_member_parts(const glint_shape *shape)
{
    return shape->mesh ? GLINT_HULL_PARTS : shape->desc.kind == GLINT_SHAPE_TORUS ? 2 : 1;
}

static inline bool glint_is_mirroring(const glint_placing *place) { return place->map && place->determinant < 0; }

#endif
