/// The planes of flat surfaces: the same numbers for whatever was described in one plane. Internal.
#ifndef GLINT_FACES_H
#define GLINT_FACES_H

#include "engine/scene/objects.h"
#include "engine/stages/stages.h"

/// A shape where it stands: the map of all groups around it, NULL where there is none but the identity.
typedef struct glint_placing {
    const glint_transform *map;
    double cofactors[3][3], determinant; ///< of it, scaled by a power of two
    bool similar; ///< it keeps angles
} glint_placing;

/// `out` may be `p`.
void glint_place_point(const glint_placing *place, const double p[3], double out[3]);
/// Keeps the side that a normal points to, under mirroring maps too. A normal of length 0 stays.
void glint_place_normal(const glint_placing *place, const double n[3], double out[3]);

/// The plane through a point, square to a normal of any length. It is made of as little as describes it: where the normal is
/// along an axis, of only the point's coordinate on that axis.
void glint_face_init(glint_face *face, const glint_placing *place, const double normal[3], const double point[3]);
/// Takes note of a surface on the face, within lower .. upper; in its own space no coordinate is beyond +-own.
void glint_face_bound(glint_face *face, const glint_placing *place, const double lower[3], const double upper[3],
                      const double own[3]);

/// The faces of a solid, in the order of glint_solid; out: room for six.
void glint_solid_faces(const glint_shape_desc *desc, glint_form form, const glint_placing *place, glint_face *out);

/// The axis to which a face of a mesh is square: all its corners have one coordinate there. 3: there is none.
int glint_level_axis(const glint_mesh *mesh, size_t triangle);
/// How many planes of such faces there are, each run of triangles in one plane counted once.
size_t glint_count_levels(const glint_mesh *mesh);

#endif
