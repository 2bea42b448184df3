/// The contract of every stage: what it reads, what it writes, and the exact order of its arithmetic.
///
/// A stage takes plain arrays in and gives plain arrays out; it has never heard of a scene. Each is written once in
/// the vector vocabulary (simd_*.h) and compiled for every instruction set, and once more, on its own, as the scalar
/// reference (ref.c). All of them give the same bits: + - * / sqrt, compares and selects in the order written here,
/// no contraction, no reassociation. `min(a, b)` is `a < b ? a : b` and `max(a, b)` is `a > b ? a : b`, NaN included.
/// dot(a, b) is (a.x b.x + a.y b.y) + a.z b.z.   length2(a) is dot(a, a).
///
/// Samples of a tile travel in groups of 16: a block of 4 x 4 pixels, row by row. `real` is double or float by the
/// frame's precision; arrays of real are `void *` here and every kernel of geometry exists for both. Where a table
/// (which is double) meets float arithmetic, its numbers are first rounded to float.
///
/// Arrays are aligned to 64 bytes and as long as the groups; indices of primitives and materials are below 2^31. Where
/// a result is NaN, its sign and payload are not part of the promise.
#ifndef GLINT_STAGES_H
#define GLINT_STAGES_H

#include "engine/stages/with.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define GLINT_GROUP 16
#define GLINT_TILE_WIDTH 32
#define GLINT_TILE_HEIGHT 24
#define GLINT_TILE_GROUPS (GLINT_TILE_WIDTH * GLINT_TILE_HEIGHT / GLINT_GROUP)
#define GLINT_TILE_SAMPLES (GLINT_TILE_WIDTH * GLINT_TILE_HEIGHT)
#define GLINT_MISS 0xffffffffu ///< in `prim`: nothing hit
#define GLINT_FILTER_SLACK (16 * 0x1p-24f) ///< what float rounding may add to a distance, of the lengths it came from
#define GLINT_LIGHT_CHUNK 16 ///< lights, or samples of one light, that one call of a stage takes at most

// ---- Tables: what the kernels look up, made by plan.c ------------------------------------------------------------

typedef enum glint_prim_kind {
    GLINT_PRIM_SPHERE,
    GLINT_PRIM_PLANE,
    GLINT_PRIM_TRIANGLE = GLINT_KIND(GLINT_WITH_MESH, 2),
    GLINT_PRIM_SOLID = GLINT_KIND(GLINT_WITH_SOLID, 3)
} glint_prim_kind;

/// One surface, as far as no ray is concerned. What the filter reads is in the first 64 bytes.
typedef struct glint_prim {
    _Alignas(64) uint16_t kind;
    uint16_t two_sided; ///< 0: seen from behind it gets ambient light only
    uint32_t id; ///< its number in order of definition, from 0
    uint32_t material; ///< index in the material table
    float filter_center[3]; ///< of a sphere around it: (center - reference) * scale, in the index's frame
    float filter_bound; ///< >= its radius (1 + 2e-6) + 16 * 2^-24 |filter_center|, in the index's units; plane: +inf
    union {
        struct {
            double center[3]; ///< sphere, solid: centre; plane: a point of it
            double scale; ///< sphere: a power of two, so that radius * scale is in [1, 2)
            double normal[3]; ///< plane: unit
            double radius; ///< sphere, world units
            double r2, r2_low; ///< sphere: (radius * scale)^2 as an unevaluated sum; r2 is the rounded square
        };
        struct {
            double corner[3][3]; ///< triangle
            uint32_t item; ///< triangle: index in corner_normals, GLINT_MISS: it has its own; solid: index in solids
            uint32_t sites; ///< triangle: index in sites, GLINT_MISS: its light is worked out for each sample
        };
    };
} glint_prim;

#define GLINT_NODE_WIDTH 16
#define GLINT_NODE_PRIM 0x80000000u ///< in `child`: the rest is the index of a primitive, not of a node
#define GLINT_BVH_DEPTH 32 ///< nodes on the longest path from the root

/// Sixteen boxes of the spatial index, a lane each. An empty slot has lower = +inf, upper = -inf.
typedef struct glint_node {
    float lower[3][GLINT_NODE_WIDTH], upper[3][GLINT_NODE_WIDTH];
    uint32_t child[GLINT_NODE_WIDTH];
} glint_node;

/// Unit normals at the corners of a triangle that is shaded smoothly.
typedef struct glint_corner_normals {
    double normal[3][3];
} glint_corner_normals;

/// Where the light on a triangle is worked out once for all its samples: its corners, or its face three times.
typedef struct glint_sites {
    uint32_t at[3];
} glint_sites;

/// The unit shapes: x^2 + y^2 + z^2 <= 1; all of x, y, z in -1 .. 1; x^2 + y^2 <= 1 with z in -1 .. 1; x^2 + y^2 <= z^2 with
/// z in 0 .. 1; x^2 + y^2 <= 1 with z = 0.
typedef enum glint_form {
    GLINT_FORM_BALL,
    GLINT_FORM_BOX,
    GLINT_FORM_CYLINDER,
    GLINT_FORM_CONE,
    GLINT_FORM_DISK,
    GLINT_FORM_TUBE, ///< a cylinder's and a cone's side alone, which has no inside
    GLINT_FORM_FUNNEL
} glint_form;

/// The image of a unit shape under center + forward k.
typedef struct glint_solid {
    double inverse[3][3], forward[3][3]; ///< rows
    uint32_t form;
} glint_solid;

/// What rays meet: the surfaces, of bit-equal ones the first, and the index over those that have an end. Its frame is (x - reference) * scale.
typedef struct glint_geometry_table {
    const glint_prim *prims; ///< in the order of the index, so that neighbours in space are neighbours in memory
    uint32_t prim_count;
    const glint_node *nodes; ///< nodes[0] is the root; NULL: nothing has an end
    const uint32_t *unbounded; ///< the primitives that are not in the tree: planes
    uint32_t unbounded_count;
    double reference[3], scale; ///< scale is a power of two
    double extent; ///< bound of every coordinate and radius, world units
    bool triangles; ///< there are some
    const glint_corner_normals *corner_normals;
    const glint_solid *solids;
    const glint_sites *sites;
    uint32_t site_count; ///< 0: all light is worked out for each sample
} glint_geometry_table;

/// What the stages before shade find out for a material's specular term.
typedef enum glint_highlight {
    GLINT_HIGHLIGHT_NONE,
    GLINT_HIGHLIGHT_PHONG,
    GLINT_HIGHLIGHT_BLINN,
    GLINT_HIGHLIGHT_FACETS ///< of microfacets: the stages `view` and `facet`
} glint_highlight;

/// What shade makes of that.
typedef enum glint_lobe {
    GLINT_LOBE_POWER,
    GLINT_LOBE_POWER_COSINE, ///< times n.l
    GLINT_LOBE_GGX,
    GLINT_LOBE_BECKMANN
} glint_lobe;

typedef struct glint_shade_material {
    double diffuse[3], specular[3];
    double ambient[3]; ///< ka * Ia
    float shininess;
    float least; ///< of (r.v)^2 or (n.h)^2: below it the highlight is 0 for certain; 0: wherever that is not known
    uint32_t highlight; ///< glint_highlight: what its specular term is of
    uint32_t lobe; ///< glint_lobe
    float alpha; ///< width of the distribution of microfacets, 1e-18 .. 1
    double grazing[3]; ///< of microfacets: `specular` is ks f0, this is ks (1 - f0)
} glint_shade_material;

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
    const uint16_t *inward; ///< with `leaving`: a bit a lane: its way begins inside that primitive
    void *t; ///< out, real: point = origin + t direction; +inf where nothing is hit
    uint32_t *prim; ///< out: index in prims, or GLINT_MISS
    uint16_t *hits; ///< out: a bit a lane
} glint_cast_args;
#define GLINT_LEAST_WAY 0x1p-126 ///< t of what is met where the ray begins
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
//                 cone: from afar, 16 < length2(f), the ray is begun at f + m e with m = -dot(f, e) / length2(e), which is added
//                 to in and out; then a = (e.x^2 + e.y^2) - e.z^2, c = (f.x^2 + f.y^2) - f.z^2, b = f.z e.z - (f.x e.x + f.y e.y)
//                 disc = (x.x^2 + x.y^2) - x.z^2 with x = cross(f, e); s, q, far, other as above; low, high = min, max of them
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
// A ray that leaves triangle A meets another, B, as above unless it starts in B's plane as far as rounding lets us know:
//                 m_P and M_P of triangle P as m and M in occlude; over_P(x) = dot(m_P, x - corner_0 of P), give or take
//                 off_P(x) = point_slack dot(M_P, |x - corner_0 of P|); slack as in surface, of A and with the origin as point:
//                 |over_B(origin)| <= ((|m_B.x| + |m_B.y|) + |m_B.z|) slack + off_B(origin)
// Then it meets B at least_way where a corner of B is over A on the side of dot(m_A, direction), a corner of A over B on that of
// -dot(m_B, direction), and the ray is within `reach` of B as in occlude, with `on`. A corner c is over P by over_P(c), if that is
// more than off_P(c) + ((|m_P.x| + |m_P.y|) + |m_P.z|) (point_slack |c|_max). So of two faces that share an edge the other is met
// where the ray goes between them, and only there.
// two_sum(a, b): s = a + b, v = s - a, error = (a - (s - v)) + (b - v)
// two_prod(a, b): p = a b, error = a b - p exactly (FMA, or Dekker with the splitter 2^27 + 1)

// ---- scan: the nearest triangle of each ray, from a list of those that a tile may show ----

typedef struct glint_scan_entry {
    uint32_t prim; ///< a triangle
    uint8_t x0, y0, x1, y1; ///< the pixels of the tile that it may show in, both ends included
    float depth; ///< not above any t * scale of a hit
} glint_scan_entry;

typedef struct glint_scan_args {
    glint_cast_args cast; ///< as of cast_bundle, or with an orthographic camera as of cast_rays; `camera` in both
    const glint_scan_entry *entries; ///< in any order; the nearer first, the faster
    uint32_t entry_count;
} glint_scan_args;
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
    void
        *slack; ///< out, real: bound of what rounding moved the point by off its triangle, a component; NULL: not asked
    glint_point_box *box; ///< out: of all hits' points; NULL: not asked
} glint_surface_args;
// Groups without a hit get back = dark = 0 and nothing else; of other groups, lanes without a hit get point = normal = 0
// and material = 0. Where it is asked, `slack` of lanes that hit no triangle is 0.
// sphere: f = (origin - center) * scale (the camera's origin is its eye); ts = t scale; r = radius scale
//         n = f + ts direction (component by component), times 1 / r (a division 1 / r first)
//         where length2(f) < 2^40: n = n (1.5 - 0.5 length2(n))
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

/// Sixteen roundings. Four move a point off its triangle, eight are in the height of a point over a plane (three in m, one in
/// q, four in products and sums); the rest is for products of roundings and for the rounding of the bounds themselves.
#define GLINT_POINT_SLACK_DOUBLE 0x1p-49
#define GLINT_POINT_SLACK_FLOAT 0x1p-20

// ---- view: the angle at which each point is seen, for materials of microfacets ----

typedef struct glint_view_args {
    uint32_t group_count;
    const uint16_t *hits;
    const glint_camera_args *camera; ///< as in glint_light_args
    const void *normal[3], *direction[3];
    float *facing; ///< out: n.v in 0 .. 1
} glint_view_args;
// Groups without a hit are not written. q = (float)length2(direction), m = (float)-dot(normal, direction);
// facing = min(max(m / sqrt(q), 0), 1) in float

// ---- light: what one light does at each point, before shadows and colours ----

/// The cone of a spot light.
typedef struct glint_spot {
    double axis[3]; ///< unit, the direction of travel
    double outer; ///< cosine of the half angle outside of which there is no light
    double inverse; ///< 1 / (cosine of the inner half angle - outer); +inf where both are the same
    float exponent; ///< of the cosine; 0: none
} glint_spot;

typedef enum glint_emission {
    GLINT_EMIT_ALL, ///< each sample is a point light
    GLINT_EMIT_FRONT, ///< likewise, to the side of its normal
    GLINT_EMIT_RADIANT_FRONT, ///< with cos' / distance^2, to the side of its normal
    GLINT_EMIT_RADIANT_BOTH, ///< to both sides
    GLINT_EMIT_RADIANT_BALL ///< to the side of its normal, and everywhere within the ball
} glint_emission;

/// One sample of an area light: a place on its surface for each lane, so that the pixels of a 4 x 4 block see sixteen.
typedef struct glint_lamp {
    _Alignas(64) double position[3][GLINT_GROUP];
    double normal[3][GLINT_GROUP]; ///< unit, of the surface there
    double center[3], radius; ///< a ball around the whole light, of GLINT_EMIT_RADIANT_BALL the light itself
    double lower[3], upper[3]; ///< a box around the whole light
    uint32_t emission;
} glint_lamp;

typedef struct glint_light_args {
    uint32_t group_count;
    const uint16_t *hits;
    const glint_camera_args *camera; ///< the rays, of a perspective camera; NULL: their directions are in direction
    const void *point[3], *normal[3], *direction[3];
    const uint32_t *material;
    const glint_shade_material *materials; ///< of which `highlight` and `least` are read
    const uint16_t *dark;
    bool directional;
    double position[3]; ///< of the light; directional: the unit vector towards it; not read of area lights
    double scale; ///< a power of two that brings distances to the light, of radiant lamps their size, near 1
    const glint_spot *spot; ///< NULL: light in all directions
    uint32_t sample_count; ///< of an area light; else 1
    const glint_lamp *lamp[GLINT_LIGHT_CHUNK]; ///< the samples; lamp[0] is NULL when it is no area light
    bool attenuated; ///< false: attenuation is not written; true for spots and radiant lamps
    double coefficients[3]; ///< c0, c1, c2
    bool highlights; ///< false: log2_specular is not written
    bool sparing; ///< highlights that are 0 whatever their strength are left out
    // out, for each sample:
    uint16_t *lit[GLINT_LIGHT_CHUNK]; ///< a bit a lane where the light is above the surface's horizon and shines there
    float *cosine[GLINT_LIGHT_CHUNK]; ///< n.l in 0 .. 1; 0 where unlit
    float *attenuation[GLINT_LIGHT_CHUNK]; ///< w; 0 where unlit
    float *log2_specular
        [GLINT_LIGHT_CHUNK]; ///< log2 of r.v or n.h, GLINT_NO_SPECULAR where there is none or the lane is unlit
    float *brightest[GLINT_LIGHT_CHUNK]; ///< the largest log2_specular written, or GLINT_NO_SPECULAR; NULL: not asked
} glint_light_args;
#define GLINT_NO_SPECULAR (-1e30f)
#define GLINT_ATTENUATION_MAX 0x1p100f ///< white by far, and a few of them still add up to a finite number
// Groups without a hit get lit = 0 and nothing else is written; of groups with lit = 0 only `lit` is written.
// l = (position - point) scale (directional: l = position); l2 = length2(l); nl = dot(normal, l)
// lit = hit and nl > 0 and not dark and, of spots and lamps, as below
// cosine:      point light: q = (float)l2, m = (float)nl, min(m / sqrt(q), 1) in float
//              directional: min((float)nl, 1)
// attenuation: d = sqrt(l2) / scale, A = 1 / (c0 + (c1 d + c2 (d d))); min((float)A, GLINT_ATTENUATION_MAX)
//   spot       c = min(-dot(axis, l) / sqrt(l2), 1), x = max(min((c - outer) inverse, 1), 0);  lit where x > 0
//              w = min((float)A, GLINT_ATTENUATION_MAX) (float)((x x) (3 - 2 x))
//              exponent not 0: lit where c >= 2^-126;  w = w S,  S as in shade with y = exponent log2(c)
//   lamp       m = -dot(normal of the sample, l); EMIT_ALL: no m is asked
//              EMIT_RADIANT_BOTH: m = max(m, -m);  EMIT_RADIANT_BALL: likewise where length2(point - center) < radius radius
//              lit where m > 0;  radiant: min((float)(A (m / (l2 sqrt(l2)))), GLINT_ATTENUATION_MAX)
// highlight:   a = length2(direction), nv = -dot(normal, direction), lv = -dot(l, direction)
//   Phong      rv = (2 nl) nv - lv;  x = min((rv rv) / (l2 a), 1);  there is one where rv > 0
//   Blinn      w = sqrt(l2 a);  num = ((nl nl) a + (nv nv) l2) + ((2 nl) nv) w;  den = (2 w) (w + lv);
//              x = min(num / den, 1);  there is one where num > 0 and den > 0
//   sparing    num = rv rv and den = l2 a of Phong;  there is none where num < least den
//   log2_specular = 0.5 log2(x), see elementary functions below; x below 2^-126: none
// In --precision float all of this is float, l2 a included.

// ---- lit_surface: surface and the light of a plain lamp in one ----
//
// surface and then light of the same groups, with three differences: there are spheres and planes alone, a light without
// samples and without a cone, and normals may be left out.

// ---- facet: how a light's half vector lies, for materials of microfacets ----

typedef struct glint_facet_args {
    uint32_t group_count;
    const glint_camera_args *camera; ///< this and the following as in glint_light_args
    const void *point[3], *normal[3], *direction[3];
    const uint32_t *material;
    const glint_shade_material *materials;
    bool directional;
    double position[3];
    double scale;
    uint32_t sample_count;
    const glint_lamp *lamp[GLINT_LIGHT_CHUNK];
    const uint16_t *lit[GLINT_LIGHT_CHUNK]; ///< what the light stage wrote
    // out, for each sample:
    float *sine2[GLINT_LIGHT_CHUNK]; ///< squared sine between n and h; GLINT_NO_SPECULAR where unlit or without h
    float *schlick[GLINT_LIGHT_CHUNK]; ///< (1 - v.h)^5; 0 where unlit or without h
} glint_facet_args;
// Only groups with a lit lane on a material of GLINT_HIGHLIGHT_FACETS are written, in every lane.
// l as in light; p = sqrt(length2(l)), r = sqrt(length2(direction)), w = p r
// h = l r - direction p (component by component), k = cross(normal, h)
// there is one where lit and 0 < length2(h):  sine2 = (float)min(length2(k) / length2(h), 1)
//   z = (float)max(min((w - dot(l, direction)) / (2 w), 1), 0), which is (v.h)^2;  m = 1 - sqrt(z) in float
//   schlick = ((m m) (m m)) m

// ---- occlude: which points a light reaches ----

typedef struct glint_occlude_args {
    uint32_t group_count;
    uint32_t sample_count; ///< as in glint_light_args
    const glint_lamp *lamp[GLINT_LIGHT_CHUNK];
    const uint16_t *lit[GLINT_LIGHT_CHUNK];
    const void *point[3];
    const uint32_t *prim; ///< on which the points are; GLINT_MISS: on none
    const uint16_t *back;
    bool directional;
    double position[3]; ///< as in glint_light_args
    double scale; ///< as in glint_light_args
    const glint_geometry_table *geometry;
    const atomic_bool *stop; ///< as in glint_cast_args
    const glint_camera_args *camera; ///< the rays that found the points, of a perspective camera; NULL: in direction
    const void *direction[3];
    const void *slack; ///< of surface; read where the table has triangles
    const glint_point_box *box; ///< of surface, around all lit points and maybe others; NULL: not known
    uint16_t *open[GLINT_LIGHT_CHUNK]; ///< out: the lit lanes that nothing blocks
    uint64_t *rays; ///< added to: lit lanes; of area lights, those that no test of the whole light has settled
    float
        *visible; ///< out, caps: the share of the light that lit lanes see, 0 in others; `open` then has the lanes that
    ///< see any. There are spheres and planes alone, and lamp[0] is the light, whose samples mean nothing, around
    ///< `position`. NULL: no caps
    uint64_t *overlaps; ///< caps: added to: pairs of a point and a primitive that were looked at
} glint_occlude_args;
// `position` stands for each lane's own in what follows.
// light_side of a primitive, double: sphere: the sign of exact_c(f) with f = (position - center) * scale of the sphere, 1
//         where length2(f) overflows; directional: 1.  plane: the sign of dot(normal, position - center); directional: of
//         dot(normal, position)
// A lane is blocked where any primitive other than its own blocks it:
// sphere: d = (position - point) scale (directional: d = position); f = (point - center) * scale_of_prim, c = exact_c(f);
//         a = length2(d), b = -dot(f, d)
//         light_side < 0: blocked = c > 0
//         else c < 0:     blocked = light_side > 0
//         else            disc as in cast; blocked = b > 0 and disc >= 0 and (directional or b scale < a scale_of_prim)
// plane:  h = dot(normal, point - center); blocked = light_side and h have strictly opposite signs
// The own sphere: blocked where `back` and its light_side > 0. The own plane never blocks.
// triangle: f, g as in surface times scale of the table, m = cross(f, g) (both real); light = dot(m, position - corner_0)
//         (directional: dot(m, position))
//   The own: blocked = back ? light > 0 : light < 0.
//   Another: q = point - corner_0, h = dot(m, q); (e, dz) = edges of P_j = (corner_j - point) * scale and d
//         M_x = |f_y g_z| + |f_z g_y|, M_y = |f_z g_x| + |f_x g_z|, M_z = |f_x g_y| + |f_y g_x|
//         bound = ((|m_x| + |m_y|) + |m_z|) slack + point_slack ((M_x |q_x| + M_y |q_y|) + M_z |q_z|)
//         on = slack > 0 and |h| <= bound: as far as rounding lets us know the point lies in this plane too
//         not on: blocked = h and light have strictly opposite signs, the segment passes as in cast and the sum of e is not 0
//         on:     a segment from there leaves the plane at once and can meet the triangle at its own beginning alone. It is
//                 blocked where the triangle reaches to the point and parts it from the light as seen by the viewer's ray:
//                 r = max of all |P_jk|, loose = 2 (slack scale) + point_slack r, move = |dz| loose
//                 reach = move ((((((|X_0| + |Y_0|) + |X_1|) + |Y_1|) + |X_2|) + |Y_2|) + 2 move): what e may be off by
//                 away = dot(m, direction of the viewer's ray)
//                 blocked = (away < 0 and light < 0 or away > 0 and light > 0) and (all e >= -reach or all e <= reach), and of
//                 min X and min Y none > move, of max X and max Y none < -move, and for each k min P_jk <= loose and
//                 max P_jk >= -loose
// solid:  d as of spheres, in and out of the ray from `point` along d: blocked = hits and (0 < in and in scale < 1 or
//         0 < out and out scale < 1); directional: < inf, without scale
//         light_side, double: k = inverse (position - center): -1 where k is inside of all bounds of the form, else 1; directional: 1
//   The own: a disk never blocks; tube and funnel: blocked where `back` and the span hits, `out` is not by a face, 0 < out and
//         out scale < 1 (directional: < inf); others, being convex: blocked where `back` and light_side > 0.
//   Of triangles: a flat mesh throws no shadow on itself, points on its edges included, and no light enters a closed mesh by an edge.

// ---- soft_light: light, occlude and the sums of shade for the samples of an area light in one ----

typedef struct glint_soft_args {
    const glint_light_args *light; ///< of an area light; what it would write is not touched
    const glint_occlude_args *occlude; ///< of the same points and samples; `lit` is not read, `open` not touched; NULL:
        ///< the light throws no shadows
    // out:
    uint16_t *reached; ///< a bit a lane that some sample reaches
    float *diffuse; ///< the sum of w cosine over the samples that reach the lane
    float *specular; ///< the sum of w S; written if highlights
} glint_soft_args;
// False: too much lies between for one kernel; nothing that is written means anything, and light and occlude are to be called.
// Else as light, occlude, and shade's sums for joined lights, of materials without microfacets. Groups that no sample reaches
// get reached = 0 and nothing else; in others, lanes that none reaches get 0.

// ---- vertex: light that was worked out once for a face or a vertex ----

/// What all lights together add to the two terms at a site.
typedef struct glint_site_light {
    float term[2][3]; ///< diffuse, specular; finite
} glint_site_light;

typedef struct glint_vertex_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< a bit a lane: its triangle has sites
    const uint16_t *back; ///< of surface
    const uint32_t *prim;
    const glint_prim *prims;
    double scale; ///< of the table
    const glint_sites *sites;
    const glint_site_light *light[2]; ///< of each site: seen from the front, from behind
    const glint_camera_args *camera; ///< the rays, as in glint_surface_args
    const void *origin[3], *direction[3];
    double *sum[2][3]; ///< in and out: added to where wanted; NULL: there is no such term
} glint_vertex_args;
// w_j as in surface, x_j the light of the triangle's sites on the lane's side:
// sum += at[0] = at[1] = at[2] ? x_0 : (w_0 x_0 + w_1 x_1) + w_2 x_2                                          in double

// caps: the share left is 1, times that of each primitive, in the table's order; s of the light, a of a sphere:
//         l = (position - point) scale, r = radius scale, d = sqrt(length2(l)); where not r < d: 1
//         power_s = (d - r)(d + r); full = sqrt(max(power, 0)) / d, cosine = sqrt(0.5 + 0.5 full), sine = min(r / d, 1) / (2 cosine):
//         of half the angle that the light is seen at; of a sphere likewise, of -f, radius scale_of_prim and power_a = c = exact_c(f)
//         sphere: its own, seen from outside: 1; its own or c < 0: within; (c m) m < power_s, m = scale / scale_of_prim: 1 - part,
//                 else 1: of two balls that do not meet, the one with the shorter tangent is before the other
//         plane: its own: 1; h = dot(normal, point - center): h > 0: within, h < 0: behind, else 1
//         within, behind = min(max((r +- depth) / (2 r), 0), 1) in double and world units, depth = dot(normal, position - center),
//                 of a sphere radius - length(position - center)
// part:   of one cap in another, G. Oat and P. Sander, "Ambient aperture lighting", I3D 2007, here by halves of all angles
//         (so that caps of 1e-8 keep their digits): u, v = l / d, -f / |f|; sg, cg = 0.5 length(u - v), 0.5 length(u + v)
//         x0, x1, x2, x3 = sines of half of s + a + g, a + g - s, s + g - a, s + a - g, by way of a + g and g - a
//         x3 <= 0: 0; else x2 <= 0: 1; else x1 <= 0: min((sa / ss)^2, 1); else by Gauss and Bonnet, sectors less triangles:
//         B = 2 angle(sqrt(x1 x3), sqrt(x0 x2)), A = 2 angle(sqrt(x2 x3), sqrt(x0 x1)): the triangle's angles at s and a
//         E = 2 angle(k sin C, 1 + k cos C), its excess, k = (ss / cs) (sa / ca), C its angle where the edges cross:
//                 sin C = 2 sqrt(x0 x3) sqrt(x1 x2) / e, cos C = (x0 x3 - x1 x2) / e, e = x0 x3 + x1 x2
//         min(max((B + (A (2 sa^2) - E) / ss / (2 ss)) / pi, 0), 1)
// angle(y, x): t = y / (sqrt(x x + y y) + x); twice t = t / (1 + sqrt(1 + t t)); 8 t (1 - t^2/3 + ... - t^22/23)

// ---- bounce: where rays go on from a surface ----

typedef struct glint_bounce_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< a bit a lane
    const glint_camera_args *camera; ///< the rays, of a perspective camera; NULL: their directions are in direction
    const void *direction[3], *normal[3]; ///< real; the normal as surface gives it
    const void *ratio; ///< real, > 0: refractive index on the ray's side of the surface over that beyond it
    void *reflected[3], *refracted[3]; ///< out, real, unit but for rounding
    void *reflectance; ///< out, real: of a dielectric and unpolarised light, 0 .. 1
    uint16_t *total; ///< out: of the wanted lanes, those of total internal reflection, whose `refracted` means nothing
} glint_bounce_args;
// Written where wanted. Groups without a wanted lane get total = 0 and nothing else; other lanes hold anything.
// u = direction / sqrt(length2(direction)) (each component divided), c = min(max(-dot(normal, u), 0), 1), r = ratio
// reflected = u + (2 c) normal
// k = 1 - (r r) (1 - c c); s = r == 1 ? c : sqrt(max(k, 0));  total = r != 1 and not k > 0
// refracted = r u + (r c - s) normal                                                            (Snell)
// x = r c, y = r s, p = (x - s) / (x + s), q = (c - y) / (c + y)                                (Fresnel)
// reflectance = r == 1 ? 0 : total ? 1 : 0.5 (p p + q q)

// ---- scatter: directions around normals, as dense as their cosine ----

typedef struct glint_scatter_args {
    uint32_t group_count;
    const uint16_t *wanted; ///< a bit a lane
    const void *normal[3]; ///< real, unit
    const double
        *square[2]; ///< u and v in 0 .. 1: equal areas of the unit square get equal shares of an even sky's light
    void *direction[3]; ///< out, real, unit but for rounding and 2e-9
} glint_scatter_args;
// Groups without a wanted lane are not written; in others, lanes that are not wanted hold anything.
// u and v are first rounded to real; a = 4 v, q = a rounded to a whole number: (a + w) - w with w = 1.5 2^52 (float: 2^23)
// f = (a - q) (pi/2), z = f f;  s = f + (f z) (S1 + z (S2 + z (S3 + z S4))),  c = 1 + z (C1 + z (C2 + z (C3 + z (C4 + z C5))))
// (sin, cos) = q = 1: (c, 0 - s); q = 2: (0 - s, 0 - c); q = 3: (0 - c, s); otherwise (s, c)
// x = sqrt(u) cos, y = sqrt(u) sin, h = sqrt(max(1 - u, 0))                             (the disk, lifted: cosine-weighted)
// g = n.z >= 0 ? 1 : -1, p = -1 / (g + n.z), q = (n.x n.y) p              (T. Duff et al., JCGT 6(1), 2017: an orthonormal basis)
// tangent = (1 + g ((n.x n.x) p), g q, 0 - g n.x), bitangent = (q, g + (n.y n.y) p, 0 - n.y)
// direction = (x tangent + y bitangent) + h n
// The coefficients stand in coefficients.h.

// ---- shade: the terms of each sample ----

typedef enum glint_term {
    GLINT_TERM_BACKGROUND,
    GLINT_TERM_AMBIENT,
    GLINT_TERM_DIFFUSE,
    GLINT_TERM_SPECULAR,
    GLINT_TERM_INDIRECT, ///< what other surfaces and the background light
    GLINT_TERM_MIRROR, ///< what mirrors show
    GLINT_TERM_TRANSMISSION, ///< what shows through
    GLINT_TERM_COUNT
} glint_term;
#define GLINT_TERM_LOCAL GLINT_TERM_INDIRECT ///< how many shade makes

typedef struct glint_shade_light {
    bool joined; ///< a further sample of the light before it in this call, with the same colours
    const uint16_t *lit; ///< lanes that the light reaches: its `lit`, or `open` where it casts shadows
    const float *cosine, *attenuation, *log2_specular; ///< attenuation: NULL = 1 everywhere
    const float *sine2, *schlick; ///< read for materials of GLINT_HIGHLIGHT_FACETS
    bool
        summed; ///< all samples of a light, as soft_light sums them up: `cosine` is its diffuse, `highlight` its specular,
    ///< and no other factors are read. No light is joined to it, and no material has microfacets
    const float *highlight;
    double diffuse[3], specular[3]; ///< colour times intensity
} glint_shade_light;

typedef struct glint_shade_args {
    uint32_t group_count;
    const uint16_t *active, *hits;
    const uint32_t *material;
    const uint32_t *only; ///< the material of all hits, where they have one; NULL: not known
    const glint_shade_material *materials;
    double background[3];
    const float *facing; ///< read for materials of GLINT_HIGHLIGHT_FACETS
    bool highlights; ///< false: the specular term is not computed
    bool first; ///< also the terms that no light makes: background and ambient
    const glint_shade_light *lights;
    uint32_t light_count; ///< at most GLINT_LIGHT_CHUNK
    double *sum
        [GLINT_TERM_COUNT]
        [3]; ///< in and out: added to (specular: if highlights); NULL: the frame has one sample and these are all lights
    float *film[GLINT_TERM_COUNT][3]; ///< out when sum is NULL: the terms; NULL where nobody asked for one
    float *beauty[3]; ///< out when sum is NULL
} glint_shade_args;
// What a light adds to a term is float; terms are added up in double:
//   background += background where active and not hit; ambient += materials[m].ambient where hit
//   for each light (with those joined to it) that has its lit bit set, in order:
//     w = attenuation (NULL: 1); all of this in float:
//     diffuse[c]  += (w cosine) (kd[c] diffuse[c]), the product p of the colours made in double: p < FLT_MAX ? (float)p : FLT_MAX
//     where the material has a highlight, highlights is true and log2_specular > GLINT_NO_SPECULAR:
//     y = shininess log2_specular, S = y < -40 ? 0 : exp2(y)
//     specular[c] += (w S) (ks[c] specular[c])
//     GLINT_LOBE_POWER_COSINE: S = S cosine
//     where the material is of GLINT_HIGHLIGHT_FACETS, highlights is true and sine2 > GLINT_NO_SPECULAR:
//     a = alpha, aa = a a, l = cosine, v = facing
//     GGX        t = sine2 + aa (1 - sine2), u = a / t, b = 1 - aa, d = l sqrt(aa + b (v v)) + v sqrt(aa + b (l l))
//                S = (u u) ((0.5 l) / max(d, FLT_MIN))
//     Beckmann   c = max(1 - sine2, 2^-40), y = -((sine2 / c) (1.442695 / aa)), e = y < -126 ? 0 : exp2(y)
//                d = (l v + v mask(l)) + l mask(v)
//                S = (((e / c) / c) (1 / aa)) ((0.25 l) / max(d, FLT_MIN))
//                mask(x): s = a sqrt(max(1 - x x, 0)), q = x / s, q < 1.6: (s ((0.396 q - 1.259) q + 1)) / (2.181 q + 3.535),
//                otherwise 0
//     S = min(S, GLINT_ATTENUATION_MAX), f = min(w S, GLINT_ATTENUATION_MAX)
//     specular[c] += f (ks[c] specular[c]) + (f schlick) (grazing[c] specular[c])
//     joined lights: w cosine and w S (f and f schlick) are added up first, in order, in float from 0, over those with the lit bit set
// Where a sum is NULL the totals start at 0 and each is rounded to float: film, and
// beauty = ((background + ambient) + diffuse) + specular in float.

// ---- resolve: the mean of several samples ----

typedef struct glint_resolve_args {
    uint32_t group_count;
    double samples;
    double *sum[GLINT_TERM_COUNT][3]; ///< of the terms that shade does not make: NULL where the frame has none
    float *film[GLINT_TERM_COUNT][3]; ///< out, or NULL
    float *beauty[3]; ///< out
} glint_resolve_args;
// term = (float)(sum / samples); beauty as in shade, then ((beauty + indirect) + mirror) + transmission of those there are

// resolve_samples: as shade for each of `count` samples in turn, with sums that begin at 0, and then resolve; all have
// `first`, and `lights` of GLINT_LIGHT_CHUNK in all at most. They have groups, active, background, highlights and film and
// beauty, which groups without an active lane leave as they are, in common; `sum` is not read.

// ---- tone: 8-bit codes, written into the image ----

/// Any rising map of 0 .. top to 0 .. 255 whose steps are further apart than the buckets. A bucket holds the floats
/// that agree in their upper 16 bits; its entry is code | threshold << 8: the code of its first float, and from which
/// of the lower 16 bits on the code is one more (65536: never). The last entry is top's.
#define GLINT_TONE_FIRST 0x3800u ///< upper bits of 2^-15; floats below have code 0

/// What spares most look-ups: an estimate of the code with a fraction, and how far it is to be trusted.
typedef struct glint_tone_fit {
    float knee, slope, base; ///< x < knee: v = slope x + base
    float scale[16], power[6], offset; ///< others: v = scale[e & 15] P(m) + offset; x = m 2^(e - 127), m in [1, 2),
        ///< P(m) = power[0] + power[1] m + ... + power[5] m^5
    uint32_t doubt; ///< v is in [256, 512), so that its lower 15 bits are the fraction. Where they are >= doubt, the
        ///< 8 bits above them are the table's code, however the estimate is rounded, with or without FMA
} glint_tone_fit;

typedef struct glint_tone_args {
    uint32_t group_count, groups_across; ///< as in glint_camera_args; group_count is a multiple of groups_across
    const uint16_t *active; ///< a bit a lane: pixels inside the image
    const float *beauty[3];
    float gain; ///< > 0: what light is multiplied by
    float white, top; ///< light above `white` is clipped; above `top` (at most `white`) all codes are that of `top`
    const uint32_t *table;
    const glint_tone_fit *fit; ///< NULL: the table alone. The codes are the same with either
    uint8_t *codes; ///< out: red, green, blue of the first lane of group 0
    size_t stride; ///< bytes from a row of pixels to the next. No byte but those of active lanes is written
    uint64_t *clipped, *nonfinite; ///< added to: active lanes with a channel > white; with one of beauty that
        ///< is not finite
} glint_tone_args;
// x = gain beauty in float; clipped where x > white; x = max(x, 0) (NaN gives 0), x = min(x, top); bits of x below GLINT_TONE_FIRST << 16: code 0;
// else entry = table[(bits >> 16) - GLINT_TONE_FIRST], code = (entry & 255) + ((bits & 0xffff) >= entry >> 8)

// ---- elementary functions, elementary.h and ref.c ----
// log2(x), 2^-126 <= x <= 1, real; result float: y = (float)x
//   y >= GLINT_SQRT1_2: e = 0, f = (float)(x - 1), the difference in real
//   else y = m 2^e with m in [1, 2); m >= GLINT_SQRT2: m = 0.5 m, e = e + 1; f = m - 1 (exact)
//   (both constants rounded to float)
//   p = C9; p = p f + C8 ... p = p f + C0; log2 = (float)e + f p
// exp2(y), float, -126 <= y <= 0: n = (y + 12582912) - 12582912, f = y - n,
//   p = D6; p = p f + D5 ... p = p f + D0; exp2 = p 2^n
// The coefficients stand in coefficients.h.

/// One instruction set's stages. The object file defines this table and nothing else that can be seen.
typedef struct glint_stages {
    const char *name;
    struct glint_geometry_stages {
        void (*camera)(const glint_camera_args *args);
        bool (*in_sight)(const glint_cast_args *args);
        void (*cast_bundle)(const glint_cast_args *args);
        void (*cast_rays)(const glint_cast_args *args);
        void (*surface)(const glint_surface_args *args);
        void (*lit_surface)(const glint_surface_args *surface, const glint_light_args *light);
        void (*view)(const glint_view_args *args);
        void (*light)(const glint_light_args *args);
        void (*facet)(const glint_facet_args *args);
        void (*occlude)(const glint_occlude_args *args);
        bool (*soft_light)(const glint_soft_args *args);
        void (*bounce)(const glint_bounce_args *args);
        void (*vertex)(const glint_vertex_args *args);
        void (*scatter)(const glint_scatter_args *args);
        void (*scan)(const glint_scan_args *args);
    } geometry[2]; ///< by glint_precision: double, float
    void (*shade)(const glint_shade_args *args);
    void (*resolve)(const glint_resolve_args *args);
    void (*resolve_samples)(const glint_shade_args *sample, uint32_t count);
    void (*tone)(const glint_tone_args *args);
} glint_stages;

extern const glint_stages glint_stages_ref;
#if defined(__x86_64__)
extern const glint_stages glint_stages_sse2, glint_stages_avx2, glint_stages_avx512;
#endif

/// The stages by name, NULL-terminated, best last.
extern const glint_stages *const glint_stages_built[];
bool glint_stages_usable(const glint_stages *stages);
/// By name; NULL asks for the environment's GLINT_ISA, else the best usable. Returns NULL with *unknown telling whether
/// the name is unknown (true) or the machine lacks it (false); *asked is the name that was asked for.
const glint_stages *glint_stages_select(const char *name, const char **asked, bool *unknown);

#endif
