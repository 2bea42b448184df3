/// The planes of flat surfaces: surfaces described in the same plane have identical numbers. Internal.
#ifndef GLINT_FACES_H
#define GLINT_FACES_H

#include "engine/render/scene/objects.h"
#include "engine/render/stages/stages.h"

/// The placement of a shape: the product of the maps of all groups that contain it; NULL: the identity.
typedef struct glint_placing {
    const glint_transform *map;
    double cofactors[3][3], determinant; ///< cofactors and determinant of the map, scaled by a power of two
    bool similar; ///< whether the map preserves angles
} glint_placing;

/// Maps a point to the world. `out` may be `p`.
void glint_place_point(const glint_placing *placing, const double p[3], double out[3]);
/// Maps a normal to the world. The normal stays on its side of the surface, even if the map mirrors. A normal of
/// length 0 stays 0.
void glint_place_normal(const glint_placing *placing, const double n[3], double out[3]);

/// Computes the plane through a point, perpendicular to a normal of any length, from as few numbers as possible: if
/// the normal is along an axis, only from the point's coordinate on that axis.
void glint_face_init(glint_face *face, const glint_placing *placing, const double normal[3], const double point[3]);
/// Extends the magnitude of the face, from which its rounding errors are bounded, to a surface within lower .. upper
/// in the world. In the shape's own space, the surface is within -own .. own.
void glint_face_bound(glint_face *face, const glint_placing *placing, const double lower[3], const double upper[3],
                      const double own[3]);

/// Computes the faces of a solid, in the order in which glint_solid numbers them. out: space for six faces.
void glint_solid_faces(const glint_shape_desc *desc, glint_form form, const glint_placing *placing, glint_face *out);

/// Returns the axis that a triangle of a mesh is perpendicular to: all corners have the same coordinate there. 3:
/// there is none.
int glint_level_axis(const glint_mesh *mesh, size_t triangle);
/// Returns the number of planes of the triangles that are perpendicular to an axis. Consecutive triangles in one
/// plane count once.
size_t glint_count_levels(const glint_mesh *mesh);

#endif
