// face: the planes of flat surfaces. Faces that the scene describes in one plane share one glint_face, so that a ray
// hits all of them at the same t, and the face that was defined first wins. A ray that starts on a face is at height
// 0. Contract: stages.h.
#ifndef GLINT_CAST_FACE_H
#define GLINT_CAST_FACE_H

#include "engine/render/stages/simd/real.h"

/// Returns x, or 0 if |x| is at most `bound`, the bound of its rounding error.
static inline vr R(unless_within)(vr x, vr bound) { return r_select(r_le(r_max(x, -x), bound), r_set(0), x); }

/// Returns the height of a point over a face.
static inline vr R(face_height)(const glint_face *face, const vr point[3])
{
    const vr n[3] = { r_set(face->normal[0]), r_set(face->normal[1]), r_set(face->normal[2]) };
    if (face->axis == 0)
        return n[0] * (point[0] - r_set(face->at[0]));
    if (face->axis == 1)
        return n[1] * (point[1] - r_set(face->at[1]));
    if (face->axis == 2)
        return n[2] * (point[2] - r_set(face->at[2]));
    const vr q[3] = { point[0] - r_set(face->at[0]), point[1] - r_set(face->at[1]), point[2] - r_set(face->at[2]) };
    return R(unless_within)(DOT(n, q), r_set(GLINT_ON_FACE) * r_set(face->magnitude));
}

/// Computes the same as over_slab for a pair of parallel faces that are perpendicular to axis k, a constant.
INNER vr R(over_level_slab)(const glint_face *low, const int k, const vr *point, const vr d[3], vr height[2])
{
    const vr n = r_set(low->normal[k]);
    for (int i = 0; i < 2 && point; i++)
        height[i] = n * (point[k] - r_set(low[i].at[k]));
    return n * d[k];
}

/// Returns how fast rays rise over the faces low[0] and low[1], which have the same normal. Also computes the heights
/// of `point`, where the rays start, over both faces. point: NULL: no heights are wanted.
INNER vr R(over_slab)(const glint_face *low, const vr *point, const vr d[3], vr height[2])
{
    if (low->axis < 3)
        return low->axis == 0   ? R(over_level_slab)(low, 0, point, d, height)
               : low->axis == 1 ? R(over_level_slab)(low, 1, point, d, height)
                                : R(over_level_slab)(low, 2, point, d, height);
    const vr n[3] = { r_set(low->normal[0]), r_set(low->normal[1]), r_set(low->normal[2]) };
    for (int i = 0; i < 2 && point; i++) {
        const double *at = low[i].at;
        const vr q[3] = { point[0] - r_set(at[0]), point[1] - r_set(at[1]), point[2] - r_set(at[2]) };
        height[i] = R(unless_within)(DOT(n, q), r_set(GLINT_ON_FACE) * r_set(low[i].magnitude));
    }
    return DOT(n, d);
}

/// Does the same for one face, without heights.
static inline vr R(face_rise)(const glint_face *face, const vr d[3]) { return R(over_slab)(face, NULL, d, NULL); }

/// Returns t where rays hit the plane.
static inline vr R(face_t)(const glint_face *face, const vr o[3], const vr d[3])
{
    return -R(face_height)(face, o) / R(face_rise)(face, d);
}

#endif
