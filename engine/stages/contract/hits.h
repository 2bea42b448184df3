/// The contract of the stages that find what rays meet, and where: camera, cast, scan, surface. Begin with stages.h.
#ifndef GLINT_CONTRACT_HITS_H
#define GLINT_CONTRACT_HITS_H

#include "engine/stages/contract/tables.h"

// ---- camera: rays of one sample of each pixel ----

/// Where on the lens the rays of one sample go through it, by the lane of their pixel; world units.
typedef struct glint_lens {
    double shift[3][GLINT_GROUP]; ///< from the middle of the lens, across the view
    double bend[3][GLINT_GROUP]; ///< shift / focus: what a direction loses
    double radius; ///< no shift is longer
    double per_focus; ///< 1 / focus
} glint_lens;

typedef struct glint_camera_args {
    uint32_t group_count, groups_across; ///< group g is column g % groups_across, row g / groups_across
    double x0, y0; ///< the tile's first pixel
    double offset[2]; ///< where in the pixel this sample lies, 0 .. 1
    double width, height; ///< of the image, were it as wide and high on both sides of where `forward` is seen
    double beyond[2]; ///< that it is wider and higher than so
    bool orthographic;
    double eye[3], forward[3], right[3], up[3]; ///< right and up are scaled to half a pixel
    const glint_lens *lens; ///< NULL: all rays of a perspective camera start at the eye
    const double *pixel[2]; ///< column and row of each lane's pixel, wherever it is, or, where `offset` is 0, of a place in it; NULL:
        ///< that of its place in the tile. Only of a perspective camera without a lens; then groups_across is 1, no pixel is before (x0, y0)
    double end[2]; ///< and none is from (end[0], end[1]) on
    void *across, *down; ///< out, real, perspective: 3 times 16 numbers a column and a row of groups; see below
    void *origin[3], *direction[3]; ///< out, real, orthographic or with a lens: one a ray
} glint_camera_args;
// lane i of group (gx, gy): px = (x0 + 4 gx + i % 4) + offset[0], py likewise with i / 4
// sx = 2 px - width, sy = height - 2 py                             (all of that in double, then rounded to real)
// where pixels are given: px = pixel[0][16 g + i] + offset[0], py likewise; across holds -0, and down the whole direction
// perspective:  direction = (forward + sx right) + sy up, of which across is the first term and down the second:
//               component c of lane i of group (gx, gy) is across[(3 gx + c) 16 + i] + down[(3 gy + c) 16 + i]
// orthographic: direction = forward, origin = (eye + sx right) + sy up
// with a lens, of the lane: direction is that less bend, origin is that (perspective: the eye) plus shift

// ---- cast: the nearest hit of each ray ----

/// The part of a table that a camera sees from any part of its picture: computed by the first call, and used by later ones.
typedef struct glint_cast_view {
    _Alignas(64) unsigned char room[8128]; ///< the kernels' own
    bool made; ///< false before the first call
} glint_cast_view;

typedef struct glint_cast_args {
    uint32_t group_count;
    const uint16_t *active; ///< a bit a lane: pixels inside the image; other lanes are misses
    const glint_geometry_table *geometry;
    const atomic_bool *stop; ///< true: the results do not matter any more; NULL: they do
    const glint_camera_args *camera; ///< cast_bundle: the rays; cast_rays: the camera whose tile they are, orthographic
        ///< or with a lens, or NULL
    glint_cast_view *view; ///< in_sight and cast_bundle only: shared by calls of one thread whose geometry, and whose
        ///< camera except for tile and offset, are the same; NULL: nothing is shared
    const void *origin[3], *direction[3]; ///< cast_rays only: real, one a ray
    const uint32_t *leaving; ///< cast_rays only: the primitive that each ray starts on, or GLINT_MISS; NULL: none of
        ///< them does
    const uint16_t *inward; ///< with `leaving`: a bit a lane: it begins inside that primitive
    void *t; ///< out, real: point = origin + t direction; +inf where nothing is hit
    uint32_t *prim; ///< out: index in prims, or GLINT_MISS
    uint16_t *hits; ///< out: a bit a lane
    uint64_t
        *tests; ///< added to: pairs of a ray and a primitive that are decided, by the formulas below; how many these
        ///< are is up to index and filter. may be NULL
} glint_cast_args;
#define GLINT_LEAST_WAY 0x1p-126 ///< t of a hit where the ray begins
#define GLINT_TURN_NEAR 0x1p-20 ///< of a torus's quartic: a step to a turn this small leaves less than rounding, being cubic
#define GLINT_TURN_STEPS 24 ///< to a turn, at most; more than 10 are taken only where three come together
#define GLINT_ROOT_STEPS 64 ///< to a root, at most; halving alone takes 52
#define GLINT_NEAR_SHARED_EDGE \
    0x1p-10 ///< of the scene: rays that are in a triangle's plane further than this stay there
// in_sight reads only active, geometry, camera and view: false: no ray of the camera's tile can hit anything; then
// cast_bundle reads no directions.
// The best hit starts as t = +inf, GLINT_MISS. A primitive replaces it where 0 < t < inf and (t < best, or t == best and its
// id is lower). Index and filter are free to reject what the decision below would miss, and no more.
// The arithmetic: ref/cast.h, ref/triangle.h, ref/solid.h. What it is for:
// sphere: by the distance of the line from the centre where the ray begins afar, as b^2 - a c close by; c is exact, by error-free
//         sums and products, so that a point on the surface is told from one beside it
// triangle: edge functions in the plane across the ray's longest axis. Neighbours see their common corners at the same X, Y
//         and, since rounding is monotonic, no edge function has the wrong sign for them: no ray goes through a common edge or
//         corner (Woop, Benthin, Wald, JCGT 2(1) 2013; here without the division, in the scaled plane). Where one is 0 its sign
//         may be lost, and of a triangle seen edge-on all are 0: the bounds decide
// solid:  the unit shape in its own frame; of a cone the ray is begun nearest to the apex, where that keeps more digits
// torus:  a quartic, told by the signs at its turns, which are places: how many roots there are, and which is the first ahead
// faces:  what was described in one plane has one face's numbers, but for the sign of the normal: along two axes of one map (a
//         transform and the groups around it) all of it, else what has bit-equal places and normals. It is met at bit-equal t,
//         so that of boxes, caps, disks, planes and meshes the first defined wins in every ray. What starts on a face is at
//         height 0 and meets it at t = 0, which is not a hit: exactly where the face is along two axes of the world, else as far
//         as rounding lets us know. So it is with a curved side but a sphere's, and with the plane of a triangle.
// A ray meets the primitive that it leaves by a rule of its own: not, but for spheres and solids other than disks where the
// lane is inward (and starts on them or within): these surely, at GLINT_LEAST_WAY or beyond. A torus is also met again by what
// leaves it outward.
// A ray that leaves triangle A meets another, B, as any other ray does unless it is in the planes of both at once as far as
// rounding lets us know, or does not pass B and may have been brought by an edge by what it begins off by. Then it meets B
// where a corner of B is over A on the ray's side, a corner of A over B on the other, and the ray is at B within rounding. So of
// two faces that share an edge the other is met where the ray goes between them, and only there.

// ---- scan: the nearest triangle of each ray, from a list of those that a tile may show ----

typedef struct glint_raster_entry {
    uint32_t prim; ///< a triangle
    uint8_t x0, y0, x1, y1; ///< the pixels of the tile that it may show in, both ends included
    float depth; ///< not above any t * scale of a hit
} glint_raster_entry;

typedef struct glint_raster_args {
    glint_cast_args cast; ///< as of cast_bundle, or with an orthographic camera as of cast_rays; `camera` in both
    const glint_raster_entry *entries; ///< in any order; the nearer first, the faster
    uint32_t entry_count;
} glint_raster_args;
// Like cast, with the triangles of the entries instead of all primitives.

// ---- surface: point, normal and material of each hit ----

/// A box around points in world space, and the primitives that they are on.
typedef struct glint_point_box {
    double lower[3], upper[3]; ///< lower > upper: there is none
    uint32_t only; ///< the primitive that all of them are on, none seen from behind; GLINT_MISS: not known
} glint_point_box;

typedef struct glint_surface_args {
    uint32_t group_count;
    const uint16_t *hits;
    const uint32_t *prim;
    const uint32_t *only; ///< the primitive of all hits, where they have one; NULL: not known
    const glint_prim *prims;
    bool mixed; ///< there are triangles or solids among prims; false: what they need is not read
    double scale; ///< of the table
    const glint_solid *solids;
    const glint_corner_normals *corner_normals; ///< NULL: every triangle is shaded flat
    const glint_camera_args *camera; ///< the rays, of a perspective camera; NULL: they are in origin and direction
    const void *origin[3], *direction[3]; ///< real, one a ray
    const void *t;
    void *point[3], *normal[3]; ///< out, real; the normal is unit and turned to the viewer; normal[0] NULL: points alone
    bool all_normals; ///< of lit_surface, which else may leave some out where `mixed` is not set
    uint32_t *material; ///< out
    uint16_t *back; ///< out: lanes seen from behind (from inside), whose normal was turned to the viewer
    uint16_t *dark; ///< out: of these, lanes of one-sided surfaces: ambient only
    void *slack; ///< out, real: bound of the point's rounding error off its triangle, per component; may be NULL,
        ///< as where there are no triangles
    glint_point_box *box; ///< out: of all hits' points; may be NULL
} glint_surface_args;
// Groups without a hit get back = dark = 0 and nothing else; of other groups, lanes without a hit get point = normal = 0
// and material = 0. Where it is not NULL, `slack` of lanes that hit no triangle is
// -(point_slack |point|_max): as large as what rounding may have moved the point by, and told apart by its sign. Points of a face
// or plane that is square to an axis of the world are exactly there.
// If only points are computed, not for a mixed table, `box` and `slack` are NULL, and material, back and dark are not written.
// The arithmetic: ref/real.h, ref/triangle.h, ref/solid.h. Of a sphere that is close, the normal is as long as it should be but
// for F^2 + 8 roundings, F = |origin - center| / radius: the error of t at a point that is seen at an angle i goes along the
// ray, and grows as 1 / cos i does. From further away it is brought to its length, from afar made of the line's distance from
// the centre. The slack of a triangle holds for corner weights within [0, 1 + 2^-50]: its edges are one rounding off, the
// products, their sum and the point one each. The geometric normal decides what is `back`, also of smooth triangles; the point
// of a solid is brought onto its surface.

#define GLINT_SPHERE_NEAR 0x1p40
#define GLINT_SPHERE_CLOSE_DOUBLE 0x1p8
#define GLINT_SPHERE_CLOSE_FLOAT 2.0f

/// Sixteen roundings. Four move a point off its triangle, eight are in the height of a point over a plane (three in m, one in
/// q, four in products and sums); the rest is for products of roundings and for the rounding of the bounds themselves.
#define GLINT_POINT_SLACK_DOUBLE 0x1p-49
#define GLINT_POINT_SLACK_FLOAT 0x1p-20

#endif
