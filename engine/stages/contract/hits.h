/// The contract of the stages that find what rays meet, and where: camera, cast, scan, surface. Begin with stages.h.
#ifndef GLINT_CONTRACT_HITS_H
#define GLINT_CONTRACT_HITS_H

#include "engine/stages/contract/tables.h"

// ---- camera: rays of one sample of each pixel ----

typedef struct glint_camera_args {
    uint32_t group_count, groups_across; ///< group g is column g % groups_across, row g / groups_across
    double x0, y0; ///< the tile's first pixel
    double offset[2]; ///< where in the pixel this sample lies, 0 .. 1
    double width, height; ///< of the image
    bool orthographic;
    double eye[3], forward[3], right[3], up[3]; ///< right and up are scaled to half a pixel
    void *across, *down; ///< out, real, perspective: 3 times 16 numbers a column and a row of groups; see below
    void *origin[3], *direction[3]; ///< out, real, orthographic: one a ray
} glint_camera_args;
// lane i of group (gx, gy): px = (x0 + 4 gx + i % 4) + offset[0], py likewise with i / 4
// sx = 2 px - width, sy = height - 2 py                             (all of that in double, then rounded to real)
// perspective:  direction = (forward + sx right) + sy up, of which across is the first term and down the second:
//               component c of lane i of group (gx, gy) is across[(3 gx + c) 16 + i] + down[(3 gy + c) 16 + i]
// orthographic: direction = forward, origin = (eye + sx right) + sy up

// ---- cast: the nearest hit of each ray ----

/// What a camera sees of a table from wherever on its picture: made by the first call, of use to those after it.
typedef struct glint_cast_view {
    _Alignas(64) unsigned char room[8128]; ///< the kernels' own
    bool made; ///< false before the first call
} glint_cast_view;

typedef struct glint_cast_args {
    uint32_t group_count;
    const uint16_t *active; ///< a bit a lane: pixels inside the image; other lanes are misses
    const glint_geometry_table *geometry;
    const atomic_bool *stop; ///< true: the results do not matter any more; NULL: they do
    const glint_camera_args *camera; ///< cast_bundle only: the rays
    glint_cast_view *view; ///< in_sight and cast_bundle only: shared by calls of one thread whose geometry, and whose
        ///< camera but for tile and offset, are the same; NULL: nothing is shared
    bool parallel; ///< cast_rays only: the directions of a group are all the same
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
#define GLINT_LEAST_WAY 0x1p-126 ///< t of what is met where the ray begins
#define GLINT_NEAR_SHARED_EDGE \
    0x1p-10 ///< of the scene: rays that are in a triangle's plane further than this stay there
// in_sight reads active, geometry, camera and view alone: false: no ray of the camera's tile can hit anything; then
// cast_bundle reads no directions.
// The best hit starts as t = +inf, GLINT_MISS. A primitive replaces it where 0 < t < inf and (t < best, or t == best and its
// id is lower). Index and filter are free to reject what the decision below would miss, and no more.
// sphere, real:   f = (origin - center) * scale (a bundle's origin is the eye), c = exact_c(f, prim)
//                 a = length2(direction), b = -dot(f, direction)
//                 near = b*b < a*r2
//                 disc = near ? b*b - a*c : a*r2 - length2(cross(f, direction))
//                        cross(f, d) = (f.y d.z - f.z d.y, f.z d.x - f.x d.z, f.x d.y - f.y d.x)
//                 s = sqrt(max(disc, 0)), q = b >= 0 ? b + s : b - s
//                 far_root = c <= 0 and b >= 0
//                 t = (far_root ? q : c) / (far_root ? a * scale : q * scale)
//                 a hit where disc >= 0 and t > 0
// exact_c, double: p_i = f_i f_i with error e_i (two_prod); x = two_sum(p_0, p_1, x_e), y = two_sum(x, p_2, y_e),
//                 z = two_sum(y, -r2, z_e); c = z + (((x_e + y_e) + z_e) + (((e_0 + e_1) + e_2) - r2_low))
//          float: c = dot(f, f) - (float)r2
// plane, real:    h = dot(normal, origin - center); nd = dot(normal, direction)
//                 t = -h / nd; a hit where nd nd >= 1e-60 length2(direction) (float: 1e-30) and t > 0
// triangle, real: P_j = (corner_j - origin) * scale of the table, j = 0, 1, 2; edges (e, dz, depth) of these and direction:
//                 det = (e_0 + e_1) + e_2;  t = depth / ((det dz) * scale)
//                 a hit where the ray passes and t > 0
//                 passes: least = min(min(e_0, e_1), e_2), most = max(max(e_0, e_1), e_2); where least > 0 or most < 0; where
//                 least = 0 or most = 0 only if min X <= 0 <= max X and min Y <= 0 <= max Y as well: an e of 0 may be one whose
//                 sign is lost, and of a triangle seen edge-on all are
// edges(P, d):    z = 0; z = 1 where max(d_1, -d_1) > max(d_0, -d_0); z = 2 where max(d_2, -d_2) > that of the larger of
//                 these; x = (z + 1) mod 3, y = (z + 2) mod 3; dz = d_z
//                 X_j = P_jx d_z - P_jz d_x, Y_j = P_jy d_z - P_jz d_y: the corners as seen along the ray
//                 e_0 = X_2 Y_1 - Y_2 X_1, e_1 = X_0 Y_2 - Y_0 X_2, e_2 = X_1 Y_0 - Y_1 X_0
//                 depth = (e_0 P_0z + e_1 P_1z) + e_2 P_2z
//                 Neighbours see their common corners at the same X, Y and, since rounding is monotonic, no e has the
//                 wrong sign for them: no ray goes through a common edge or corner (Woop, Benthin, Wald, JCGT 2(1)
//                 2013; here without the division, in the scaled plane).
// solid, real:    f = inverse (origin - center), e = inverse direction (each row's dot product); span(f, e) = in, out
//                 t = in > 0 ? in : out; a hit where span hits and t > 0
// span:           ball, cylinder: a = e.x^2 + e.y^2, b = f.x e.x + f.y e.y, c = f.x^2 + f.y^2, x = cross(f, e), w = x.z^2; ball:
//                 a, b, c are length2(e), dot(f, e), length2(f), w = length2(x); then b = -b, c = c - 1
//                 disc = b*b < a ? b*b - a*c : a - w; s = sqrt(max(disc, 0)); q = b >= 0 ? b + s : b - s
//                 far = q / a, other = c / q; in, out = b >= 0 ? (other, far) : (far, other); hits where disc >= 0
//                 where a = 0: in = -inf, out = inf, hits where c <= 0
//                 cone: the ray is begun nearest to the apex, at f + m e with m = -dot(f, e) / length2(e), which is added to in
//                 and out, where it starts anew: 16 < length2(f), or dot(f, e)^2 > 0.875 (length2(f) length2(e)) and not on the
//                 side: f.z > 0 and |(f.x^2 + f.y^2) - f.z^2| <= point_slack length2(f)
//                 then a = (e.x^2 + e.y^2) - e.z^2, c = (f.x^2 + f.y^2) - f.z^2, b = f.z e.z - (f.x e.x + f.y e.y)
//                 disc = (x.x^2 + x.y^2) - x.z^2 with x = cross(f, e); s, q, far, other as above, but where q = 0,
//                 through the apex, other = far; low, high = min, max of them
//                 a > 0: in, out = low, high; hits where disc >= 0
//                 else hits where a < 0 or b and e.z have one sign; end = a = 0 ? c / (2 b) : e.z > 0 ? high : low; in, out = e.z > 0 ? (end, inf) : (-inf, end)
//                 box: in = -inf, out = inf, hits
//                 then, cylinder and cone: slab of z, from -1 or (cone) 0; box: slabs of x, y, z, from -1
//                 slab from low, of axis i: where e_i = 0: hits only where not (f_i < low or f_i > 1), else
//                 enter = ((e_i > 0 ? low : 1) - f_i) / e_i, leave = ((e_i > 0 ? 1 : low) - f_i) / e_i
//                 where in < enter: in = enter, by this face; where leave < out: out = leave, by this face
//                 disk: in = out = -f.z / e.z; x = f.x + in e.x, y likewise; hits where x x + y y <= 1
//                 and in <= out
//                 tube, funnel: as cylinder and cone, without the faces: where `in` is by a face, in = out, and where `out` is,
//                 out = in; both: no hit
// A ray meets the primitive that it leaves by a rule of its own: not, but for spheres and solids other than disks where the
// lane is inward (and starts on them or within): these surely, at t = max((b + b) / (a scale), least_way) and max(out, least_way) (tube, funnel: where the span
// hits, `out` is not by a face and 0 < out, there).
// A ray that leaves triangle A meets another, B, as above unless it is in the planes of both at once as far as rounding lets us
// know: it starts in B's plane, or crosses that, at t as above, before it is off A's for certain; or unless it does not pass B,
// and 0 < t: what it begins off by may have brought it by an edge:
//                 m_P and M_P of triangle P as m and M in occlude; over_P(x) = dot(m_P, x - corner_0 of P), give or take
//                 off_P(x) = point_slack dot(M_P, |x - corner_0 of P|); slack as in surface, of A and with the origin as point:
//                 |over_B(origin)| <= ((|m_B.x| + |m_B.y|) + |m_B.z|) slack + off_B(origin), or
//                 0 < t <= near_beside extent and t |dot(m_A, direction)| <= ((|m_A.x| + |m_A.y|) + |m_A.z|) slack
// Then it meets B, at least_way if it starts there and else at t, where a corner of B is over A on the side of
// dot(m_A, direction), a corner of A over B on that of -dot(m_B, direction), and the ray is at B by `loose`, `move` and `reach` of
// occlude, with `on`; for its bounds at (t direction) scale in place of 0. A corner c is over P by over_P(c), if that is
// more than off_P(c) + ((|m_P.x| + |m_P.y|) + |m_P.z|) (point_slack |c|_max). So of two faces that share an edge the other is met
// where the ray goes between them, and only there.
// two_sum(a, b): s = a + b, v = s - a, error = (a - (s - v)) + (b - v)
// two_prod(a, b): p = a b, error = a b - p exactly (FMA, or Dekker with the splitter 2^27 + 1)

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
// As cast, with the triangles of the entries in place of all primitives.

// ---- surface: point, normal and material of each hit ----

/// A box around points, in the world, and what they are on.
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
    void *point[3], *normal[3]; ///< out, real; the normal is unit and turned to the viewer
    uint32_t *material; ///< out
    uint16_t *back; ///< out: lanes seen from behind (from inside), whose normal was turned to the viewer
    uint16_t *dark; ///< out: of these, lanes of one-sided surfaces: ambient only
    void *slack; ///< out, real: bound of what rounding moved the point by off its triangle, a component; may be NULL
    glint_point_box *box; ///< out: of all hits' points; may be NULL
} glint_surface_args;
// Groups without a hit get back = dark = 0 and nothing else; of other groups, lanes without a hit get point = normal = 0
// and material = 0. Where it is not NULL, `slack` of lanes that hit no triangle is 0.
// sphere: f = (origin - center) * scale (the camera's origin is its eye); ts = t scale; r = radius scale
//         n = f + ts direction (component by component), times 1 / r (a division 1 / r first)
//         where length2(f) < GLINT_SPHERE_CLOSE: that is n. The error of t at a point that is seen at an angle i goes along the
//         ray, and grows as 1 / cos i does: n is as long as it should be but for F^2 + 8 roundings, F = |f| / r
//         else where length2(f) < GLINT_SPHERE_NEAR: n = n (1.5 - 0.5 length2(n))
//         elsewhere: a = length2(direction), b = -dot(f, direction), w = b / a, l = f + w direction,
//                 h = sqrt(max(r2 - length2(l), 0) / a), n = b >= 0 and c >= 0 ? l - h direction : l + h direction
//                 with c = length2(f) - r2;  m = length2(n); n = n / sqrt(m) (each component divided);
//                 where not m > 0: n = -direction / sqrt(a)
//         point = center + radius n
// plane:  n = normal; point = origin + t direction
// triangle: e as in cast; inverse = 1 / ((e_0 + e_1) + e_2), w_j = e_j inverse; f = corner_1 - corner_0, g = corner_2 - corner_0
//         point = corner_0 + (w_1 f + w_2 g): within slack of the plane, for any w_1, w_2 within [0, 1 + 2^-50]:
//         slack = point_slack ((|f|_max + |g|_max) + |point|_max), |v|_max = max(max(|v_0|, |v_1|), |v_2|): f and g are one
//         rounding off, the products, their sum and the point one each
//         n, double, then rounded: m = cross(f scale, g scale), n = m / sqrt(length2(m)) (each component divided)
//         where it has corner normals: s = (w_0 normal_0 + w_1 normal_1) + w_2 normal_2, l = length2(s), s = s / sqrt(l); where
//         not l > 0: s = n. The geometric n decides what is `back`; s = dot(s, back ? -n : n) < 0 ? -s : s is the normal.
// solid:  f, e, in, out as in cast; through what `in` is by where t = in, else `out`; k = f + t e
//         through the curved side: ball: k = g = k / sqrt((k.x^2 + k.y^2) + k.z^2); else r = sqrt(k.x^2 + k.y^2), g = (k.x / r,
//         k.y / r, cone ? -1 : 0), 0 for x and y where not r > 0; k.x, k.y = g.x h, g.y h with h = cone ? k.z : 1
//         through a face: g = its outward normal (disk: +z), k's component there = the face's
//         n = transpose(inverse) g (each column's dot product), over sqrt(length2(n)); point = center + forward k
// then    back = dot(n, direction) > 0; n = back ? -n : n, after `point` was made with the outward n

#define GLINT_SPHERE_NEAR 0x1p40
#define GLINT_SPHERE_CLOSE_DOUBLE 0x1p8
#define GLINT_SPHERE_CLOSE_FLOAT 2.0f

/// Sixteen roundings. Four move a point off its triangle, eight are in the height of a point over a plane (three in m, one in
/// q, four in products and sums); the rest is for products of roundings and for the rounding of the bounds themselves.
#define GLINT_POINT_SLACK_DOUBLE 0x1p-49
#define GLINT_POINT_SLACK_FLOAT 0x1p-20

#endif
