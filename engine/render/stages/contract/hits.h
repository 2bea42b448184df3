/// The contract of the stages that compute which primitive a ray hits, and where: camera, cast, surface. Begin with
/// stages.h.
#ifndef GLINT_CONTRACT_HITS_H
#define GLINT_CONTRACT_HITS_H

#include "engine/render/stages/contract/tables.h"

// ---- camera: rays of one sample of each pixel ----

/// The points where the rays of one sample cross the lens, one per lane, in world units.
typedef struct glint_lens {
    double shift[3][GLINT_GROUP]; ///< offset from the centre of the lens to the point, in the plane of the lens
    double bend[3][GLINT_GROUP]; ///< shift / focus: subtracted from the direction
    double radius; ///< maximum length of a shift
    double per_focus; ///< 1 / focus
} glint_lens;

typedef struct glint_camera_args {
    uint32_t group_count, groups_across; ///< group g is column g % groups_across, row g / groups_across
    double x0, y0; ///< the tile's first pixel
    double offset[2]; ///< position of the sample in its pixel, 0 .. 1
    double width, height; ///< size in pixels of an image that is symmetric around the point where `forward` is seen
    double beyond[2]; ///< by how many pixels the actual image is wider and higher than the symmetric one
    bool orthographic;
    double eye[3], forward[3], right[3], up[3]; ///< eye and three directions; `right` and `up` are half a pixel long
    const glint_lens *lens; ///< NULL: all rays of a perspective camera start at the eye
    const double *pixel[2]; ///< column and row of each lane's pixel or, if `offset` is 0, of a point in that pixel;
        ///< NULL: each lane has the pixel at its position in the tile. Only for a perspective camera without a lens.
        ///< If set, groups_across is 1, and no pixel is before (x0, y0)
    double end[2]; ///< only with `pixel`: all pixels are before (end[0], end[1])
    void *across, *down; ///< out, real, perspective: 3 times 16 numbers per column of groups, and per row of groups;
        ///< see below
    void *origin[3], *direction[3]; ///< out, real, orthographic or with a lens: one per ray
} glint_camera_args;
// lane i of group (gx, gy):
//   px = (x0 + 4 gx + i % 4) + offset[0], py = (y0 + 4 gy + i / 4) + offset[1]
//   sx = 2 px - width, sy = height - 2 py, all computed in double, then rounded to real
// if `pixel` is set: px = pixel[0][16 g + i] + offset[0], py = pixel[1][16 g + i] + offset[1]; `across` holds -0, and
// `down` holds the whole direction
// perspective: direction = (forward + sx right) + sy up. The first term is stored in across, the second in down:
//   component c of lane i of group (gx, gy) is across[(3 gx + c) 16 + i] + down[(3 gy + c) 16 + i]
// orthographic: direction = forward, origin = (eye + sx right) + sy up
// with a lens, in each lane: bend is subtracted from the direction, and shift is added to the origin (perspective: to
// the eye)

// ---- cast: the nearest hit of each ray ----

/// The primitives of a table that are visible anywhere in the picture of a camera. The first call computes the view,
/// and later calls use it.
typedef struct glint_cast_view {
    _Alignas(64) unsigned char scratch[8128]; ///< private to the kernels
    bool made; ///< false before the first call
} glint_cast_view;

typedef struct glint_cast_args {
    uint32_t group_count;
    const uint16_t *active; ///< one bit per lane: pixels inside the image; other lanes are misses
    const glint_geometry_table *geometry;
    const atomic_bool *stop; ///< true: the results are no longer needed; NULL: never stops
    const glint_camera_args *camera; ///< cast_bundle: the rays; cast_rays: the camera of the tile that the rays
        ///< belong to if it is orthographic or has a lens, otherwise NULL
    glint_cast_view *view; ///< in_sight and cast_bundle only: shared by calls of one thread with the same geometry and
        ///< the same camera (except for tile and offset); NULL: nothing is shared
    const void *origin[3], *direction[3]; ///< cast_rays only: real, one per ray
    const uint32_t *leaving; ///< cast_rays only: the primitive that each ray starts on, or GLINT_MISS; NULL: no ray
        ///< starts on one
    const uint16_t *inward; ///< with `leaving`, one bit per lane: the ray goes into the primitive that it starts on
    void *t; ///< out, real: distance in lengths of `direction`: the hit is at origin + t direction; +inf where
        ///< nothing is hit
    uint32_t *prim; ///< out: index in prims, or GLINT_MISS
    uint16_t *hits; ///< out, one bit per lane: the ray hits something
    uint64_t
        *tests; ///< in and out: the number of pairs of a ray and a primitive that the formulas below decided is
        ///< added. It depends on index and filter. May be NULL
} glint_cast_args;
#define GLINT_LEAST_T 0x1p-126 ///< t of a hit at the origin of the ray
#define GLINT_TURN_NEAR 0x1p-20 ///< quartic of a torus: after a step this small towards a turning point, the error is
    ///< below rounding, because convergence is cubic
#define GLINT_TURN_STEPS 24 ///< maximum number of steps to a turning point; more than 10 are only needed where three
    ///< turning points coincide
#define GLINT_ROOT_STEPS 64 ///< maximum number of steps to a root; bisection needs 52
#define GLINT_NEAR_SHARED_EDGE \
    0x1p-10 ///< relative to the scene: a ray that stays in a triangle's plane for longer than this counts as lying in
        ///< the plane
// in_sight reads only active, geometry, camera and view. If it returns false, no ray of the camera's tile can hit
// anything, and cast_bundle reads no directions.
// The best hit starts as t = +inf, GLINT_MISS. A primitive replaces it if 0 < t < inf and (t < best, or t == best and
// its id is lower). Index and filter may only reject primitives that the formulas below would miss.
// The arithmetic: ref/cast.h, ref/triangle.h, ref/solid.h. The methods, and their reasons:
//   sphere: the discriminant is computed from the distance between the line and the centre if the ray begins far
//     away, and as b^2 - a c if it begins close. c is exact, by error-free sums and products,
//     so that points on the surface are distinguished from points next to it
//   triangle: edge functions in the plane perpendicular to the ray's longest axis. Neighbours see their common
//     corners at the same X, Y. Rounding is monotonic, so no edge function of these neighbours has the wrong sign,
//     and no ray slips through a common edge or corner (Woop, Benthin, Wald, JCGT 2(1) 2013; here without the
//     division, in the scaled plane). An edge function of 0 may have lost its sign to rounding, and all of them are 0
//     for a triangle seen edge-on: in these cases error bounds decide
//   solid: the ray is intersected with the unit shape in the shape's own frame. For a cone, the ray's origin is moved
//     to the point nearest to the apex if that saves digits
//   torus: a quartic. The signs of the quartic at its turning points tell how many roots there are, and which root is
//     the first one ahead
//   faces: faces that the scene describes in the same plane share one glint_face, except for the sign of the normal.
//     Faces along two axes of one map (a transform and the groups around it) always share it, other faces if point
//     and normal are bit-equal. Rays hit such faces at bit-equal t, so that every ray hits the one that was defined
//     first, among boxes, caps, disks, planes and meshes. A ray that starts on a face is at height 0 and would hit
//     the face at t = 0, which does not count. The height is exactly 0 if the face is along two axes of the world,
//     otherwise it is 0 within rounding. The same holds for the curved sides of solids other than spheres, and for
//     the plane of a triangle.
// A ray never hits the primitive that it leaves, with two exceptions: a ray in an `inward` lane, which starts on or
// inside of a sphere or a solid other than a disk, always hits it again, at GLINT_LEAST_T or beyond; and a ray that
// leaves a torus outwards can hit the torus again.
// A ray that leaves triangle A hits another triangle B like any other ray, with two exceptions: the ray lies in both
// planes within rounding, or it does not cross B and the offset of its origin may have moved it over a common edge.
// In these two cases the ray hits B if a corner of B is above A on the ray's side, a corner of A is above B on the
// other side, and the ray is at B within rounding. So of two faces that share an edge, the ray hits the other face
// exactly if it goes between them.

// ---- surface: point, normal and material of each hit ----

/// The bounding box of some points in world space, and the primitive that the points are on.
typedef struct glint_point_box {
    double lower[3], upper[3]; ///< lower > upper: empty
    uint32_t only; ///< the primitive that all points are on, if none of them is seen from behind; GLINT_MISS: unknown
} glint_point_box;

typedef struct glint_surface_args {
    uint32_t group_count;
    const uint16_t *hits;
    const uint32_t *prim;
    const uint32_t *only; ///< the primitive that all hits share; NULL: unknown
    const glint_prim *prims;
    bool mixed; ///< prims has triangles or solids; false: the fields for them are not read
    double scale; ///< the table's scale
    const glint_solid *solids;
    const glint_corner_normals *corner_normals; ///< NULL: every triangle is shaded flat
    const glint_camera_args *camera; ///< the rays of a perspective camera; NULL: they are in `origin` and `direction`
    const void *origin[3], *direction[3]; ///< real, one per ray
    const void *t;
    void *point[3], *normal[3]; ///< out, real; unit normals, turned towards the viewer; normal[0] NULL: only points
    bool all_normals; ///< only for lit_surface; false: some normals may be left out unless `mixed` is set
    uint32_t *material; ///< out
    uint16_t *back; ///< out: lanes seen from behind (from inside); their normals were flipped towards the viewer
    uint16_t *dark; ///< out: lanes of `back` on one-sided surfaces, which get ambient light only
    void *slack; ///< out, real: bound, per component, of the distance by which rounding moves the point off its
        ///< triangle; may be NULL, for example if there are no triangles
    glint_point_box *box; ///< out: the bounding box of the points of all hits; may be NULL
} glint_surface_args;
// Groups without a hit only get back = dark = 0. In other groups, lanes without a hit get point = normal = 0 and
// material = 0. If `slack` is not NULL, it is -(point_slack |point|_max) in lanes that hit something other than a
// triangle: the bound of the point's rounding error, marked by the sign. Points of faces and planes perpendicular to
// an axis of the world have that coordinate exactly.
// If only points are computed (not for a mixed table), `box` and `slack` are NULL, and material, back and dark are
// not written.
// The arithmetic: ref/real.h, ref/triangle.h, ref/solid.h. The normal of a close sphere is not normalised: its length
// is 1 within F^2 + 8 roundings, F = |origin - center| / radius, because the error of t moves the point along the
// ray, and grows as 1 / cos i for a point seen at an angle i. The normal of a sphere further away is normalised. The
// normal of a very distant sphere is computed from the line's distance from the centre. The slack of a triangle holds
// for corner weights within [0, 1 + 2^-50]: it covers one rounding each for the edges, the products, their sum and
// the point. The geometric normal decides `back`, also for smooth triangles. The point of a solid is projected onto
// its surface. A smooth triangle with `terminator` moves its points after that: ref/triangle.h, toward_curve.
// Their `slack` is negative, as that of other surfaces: they are on no triangle.

#define GLINT_SPHERE_NEAR 0x1p40
#define GLINT_SPHERE_CLOSE_DOUBLE 0x1p8
#define GLINT_SPHERE_CLOSE_FLOAT 2.0f

/// Sixteen roundings: four move a point off its triangle, and eight change the height of a point over a plane (three
/// of them in m, one in q, four in products and sums). The rest covers products of roundings and the rounding of the
/// bounds themselves.
#define GLINT_POINT_SLACK_DOUBLE 0x1p-49
#define GLINT_POINT_SLACK_FLOAT 0x1p-20

#endif
