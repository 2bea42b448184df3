// face: the planes of flat surfaces. What was described in one plane has one face's numbers, so that all of it is met at the
// same t and the first defined wins; and what starts on a face is at height 0. Contract: stages.h.

/// 0 in place of what rounding may have made of 0.
static inline vr R(unless_within)(vr x, vr bound) { return r_select(r_le(r_max(x, -x), bound), r_set(0), x); }

/// The height of a place over a face.
static inline vr R(face_height)(const glint_face *face, const vr place[3])
{
    const vr n[3] = { r_set(face->normal[0]), r_set(face->normal[1]), r_set(face->normal[2]) };
    if (face->axis == 0)
        return n[0] * (place[0] - r_set(face->at[0]));
    if (face->axis == 1)
        return n[1] * (place[1] - r_set(face->at[1]));
    if (face->axis == 2)
        return n[2] * (place[2] - r_set(face->at[2]));
    const vr q[3] = { place[0] - r_set(face->at[0]), place[1] - r_set(face->at[1]), place[2] - r_set(face->at[2]) };
    return R(unless_within)(DOT(n, q), r_set(GLINT_ON_FACE) * r_set(face->places));
}

/// How fast a ray rises over a face.
static inline vr R(face_rise)(const glint_face *face, const vr d[3])
{
    const vr n[3] = { r_set(face->normal[0]), r_set(face->normal[1]), r_set(face->normal[2]) };
    if (face->axis == 0)
        return n[0] * d[0];
    if (face->axis == 1)
        return n[1] * d[1];
    if (face->axis == 2)
        return n[2] * d[2];
    return DOT(n, d);
}

/// Where rays meet the plane.
static inline vr R(face_way)(const glint_face *face, const vr o[3], const vr d[3])
{
    return -R(face_height)(face, o) / R(face_rise)(face, d);
}
