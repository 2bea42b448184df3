/// The contract of the stages that find what lights do at a point: view, light, facet, occlude, soft_light. Begin with stages.h.
#ifndef GLINT_CONTRACT_LIGHT_H
#define GLINT_CONTRACT_LIGHT_H

#include "engine/stages/contract/hits.h"

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
    GLINT_EMIT_CONE ///< of a ball, by radiance: each lane has a sample of its own, in the cone in which it sees the ball
} glint_emission;

/// One sample of an area light: a place on its surface for each lane, so that the pixels of a 4 x 4 block see sixteen.
typedef struct glint_light_sample {
    _Alignas(64) double position[3][GLINT_GROUP]; ///< GLINT_EMIT_CONE: where in the cone: a share u of it, 0 .. 1, and
        ///< cosine and sine of an angle around its axis
    double normal[3][GLINT_GROUP]; ///< unit, of the surface there; GLINT_EMIT_CONE: none
    double center[3], radius; ///< a ball around the whole light, of GLINT_EMIT_CONE the light itself
    double lower[3], upper[3]; ///< a box around the whole light
    uint32_t emission;
} glint_light_sample;
/// Of a point's distance to the centre: so near to the ball's surface it is on it.
#define GLINT_CONE_SLACK_DOUBLE 0x1p-40
#define GLINT_CONE_SLACK_FLOAT 0x1p-18
// GLINT_EMIT_CONE, for each lane in double whatever real is (C: cone_sample.h), u, cos, sin its own three numbers:
//   D = (center - point) scale, d = sqrt(length2(D)), r = radius scale, x = (d - r) (d + r), g = x / length2(D)
//   It is within the ball where g < (dot(normal, D) > 0 ? slack : -slack): a point on the surface sees the half of the ball
//   that its normal looks at, or nothing.
//   outside: q = r / d, q2 = q q, h = 1 / (1 + sqrt(max(g, 0))): 1 - the cosine of the cone's edge is q2 h, without the loss of a
//            difference; m = (u q2) h, s2 = (u h) (2 - m), c = 1 - m, s = q sqrt(s2); axis D / d
//            t = (d max(g, 0)) / (c + q sqrt(max(1 - s2, 0))): to where that direction meets the ball
//   within:  q = q2 = h = 1, axis the normal: half of all directions;  b = -dot(D, way), e = max(-x, 0), k = sqrt(b b + e),
//            t = b > 0 ? e / (b + k) : k - b: to where it leaves the ball
//   way = (s cos tangent + s sin bitangent) + c axis, in the frame of scatter; far = t (1 / scale);
//   position = point + way far. All are rounded to real then; but light_side (below) reads the position as it was
//   weight = 2 (q2 h): the solid angle over pi, so that the mean of weight cosine is irradiance over pi radiance

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
    double
        scale; ///< a power of two that brings distances to the light, of radiant lamps their size, near 1; 1 where that is
        ///< near enough already
    const glint_spot *spot; ///< NULL: light in all directions
    uint32_t sample_count; ///< of an area light; else 1
    const glint_light_sample
        *light_sample[GLINT_LIGHT_CHUNK]; ///< the samples; light_sample[0] is NULL when it is no area light
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
    float *brightest[GLINT_LIGHT_CHUNK]; ///< the largest log2_specular written, or GLINT_NO_SPECULAR; may be NULL
} glint_light_args;
#define GLINT_NO_SPECULAR (-1e30f)
#define GLINT_ATTENUATION_MAX 0x1p100f ///< white by far, and a few of them still add up to a finite number
// Groups without a hit get lit = 0 and nothing else is written; of groups with lit = 0 only `lit` is written.
// l = (position - point) scale (directional: l = position; cone: l = way); l2 = length2(l); nl = dot(normal, l)
// lit = hit and nl > 0 and not dark and, of spots and lamps, as below
// cosine:      point light: q = (float)l2, m = (float)nl, min(m / sqrt(q), 1) in float
//              directional: min((float)nl, 1)
// attenuation: d = sqrt(l2) / scale (cone: far), A = 1 / (c0 + (c1 d + c2 (d d))); min((float)A, GLINT_ATTENUATION_MAX)
//   spot       c = min(-dot(axis, l) / sqrt(l2), 1), x = max(min((c - outer) inverse, 1), 0);  lit where x > 0
//              w = min((float)A, GLINT_ATTENUATION_MAX) (float)((x x) (3 - 2 x))
//              exponent not 0: lit where c >= 2^-126;  w = w S,  S as in shade with y = exponent log2(c)
//   lamp       m = -dot(normal of the sample, l); EMIT_ALL: m is not computed
//              EMIT_RADIANT_BOTH: m = max(m, -m)
//              lit where m > 0;  radiant: min((float)(A (m / (l2 sqrt(l2)))), GLINT_ATTENUATION_MAX)
//   cone       min((float)(A weight), GLINT_ATTENUATION_MAX)
// highlight:   a = length2(direction), nv = -dot(normal, direction), lv = -dot(l, direction)
//   Phong      rv = (2 nl) nv - lv;  x = min((rv rv) / (l2 a), 1);  there is one where rv > 0
//   Blinn      w = sqrt(l2 a);  h = l a - direction w (component by component);  nh = dot(normal, h);  num = nh nh;
//              den = length2(h);  x = min(num / den, 1);  there is one where nh > 0 and den > 0
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
    const glint_light_sample *light_sample[GLINT_LIGHT_CHUNK];
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
    const glint_light_sample *light_sample[GLINT_LIGHT_CHUNK];
    const uint16_t *lit[GLINT_LIGHT_CHUNK];
    const void *point[3];
    const void *normal[3]; ///< read of GLINT_EMIT_CONE
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
    uint64_t
        *tests; ///< added to: pairs of a point, or of a point and a sample, and a primitive that are decided, as in
        ///< glint_cast_args
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

#endif
