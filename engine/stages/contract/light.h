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
// Groups without a hit are not written. The arithmetic: ref/microfacets.h.

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
/// Relative to a point's distance from the centre: a point this near to the sphere's surface is on it.
#define GLINT_CONE_SLACK_DOUBLE 0x1p-40
#define GLINT_CONE_SLACK_FLOAT 0x1p-18
// GLINT_EMIT_CONE: cone_sample.h, for each lane in double whatever real is. A point on the surface sees the half of the ball
// that its normal looks at, or nothing. The position is brought into the light's box, which rounding leaves where the point is
// 2^52 radii away; then it is rounded to real, but light_side (below) reads it as it was. The weight is the solid angle over
// pi, so that the mean of weight cosine is irradiance over pi radiance.

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
    const double *place[GLINT_LIGHT_CHUNK]; ///< for several similar lights without samples or a cone, which differ only in it:
        ///< the position of each; place[0] NULL: there is one light, at `position`
    double
        scale; ///< a power of two that brings distances to the light, of radiant lamps their size, near 1; 1 where that is
        ///< near enough already
    const glint_spot *spot; ///< NULL: light in all directions
    uint32_t sample_count; ///< of an area light, or how many lights there are
    const glint_light_sample
        *light_sample[GLINT_LIGHT_CHUNK]; ///< the samples; light_sample[0] is NULL when it is not an area light
    bool attenuated; ///< false: attenuation is not written; true for spots and radiant lamps
    double coefficients[3]; ///< c0, c1, c2
    bool highlights; ///< false: log2_specular is not written
    bool sparing; ///< highlights that are 0 whatever their strength are left out
    // out, for each sample or light:
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
// The arithmetic: ref/light.h; S of a spot as in shade. log2_specular is 0.5 log2 of (r.v)^2 or (n.h)^2: there is none below
// 2^-126, and, if sparing, none where the material's `least` says that the highlight is 0.
// In --precision float all of this is float, the products of squared lengths included.

// ---- lit_surface: surface and the light of a plain lamp in one ----
//
// surface and then light of the same groups, with two differences: of a light without samples and without a cone alone, and
// normals may be left out but where `all_normals` or `mixed` is set.

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
// The arithmetic: ref/microfacets.h; Schlick's (v.h)^2 comes by half of the angle between l and v, without making h unit.

// ---- occlude: which points a light reaches ----

#define GLINT_GRID_STEPS 6144 ///< of place, in a cell of a light's grid
#define GLINT_GRID_ASIDE 4.5 ///< cells: an entry's place lies from this far before its cell to this far behind it
#define GLINT_GRID_RADIUS 8 ///< steps in a unit of an entry's radius
#define GLINT_GRID_RADIUS_BITS 12 ///< of an entry's size, the lower ones

/// What stands before a light without samples: small spheres, which it is outside of, in square cells of its view. What is at
/// (a, b, w) along the axes from the origin has its place at u = a / w and v = b / w, or directional at a and b.
typedef struct glint_light_grid {
    bool directional;
    double position[3]; ///< as in glint_occlude_args
    double origin[3]; ///< the light's place; directional: the index's
    double axis[3][3]; ///< across, down and away from the light, as long as the index's unit
    float first[2], cells; ///< place of the first cell, cells in a unit of place
    uint32_t count[2]; ///< columns and rows
    float nearest, slices; ///< least `near`, above 0 where the light has a place; into how many a unit of w is cut from there on
    bool sorted; ///< in each cell `near` never falls
    const uint32_t *begin; ///< where each cell's entries begin, row by row, and where the last one's end
    // of each entry, a sphere in a cell, and of GLINT_GROUP more, which mean nothing:
    const uint32_t *place; ///< of its middle, in steps from GLINT_GRID_ASIDE before its cell: across, and 2^16 times down
    const uint32_t *size; ///< its radius, and above that `near`. A segment that meets it has
        ///< du^2 + dv^2 <= radius^2 (1 + u^2 + v^2), by its own place; directional: <= radius^2. No point that it blocks
        ///< has a smaller (w - nearest) slices than `near`
    const uint32_t *id;
    uint32_t others[GLINT_GRID_OTHERS], other_count; ///< the bounded primitives that are in no cell
} glint_light_grid;

#define GLINT_OCCLUDE_ROOM ((size_t)512 << 10) ///< bytes

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
    const glint_light_grid *grid; ///< of this light and geometry; NULL: there is none
    const atomic_bool *stop; ///< as in glint_cast_args
    const glint_camera_args *camera; ///< the rays that found the points, of a perspective camera; NULL: in direction
    const void *direction[3];
    const void *slack; ///< of surface; read where the table has triangles
    void *room; ///< of area lights: GLINT_OCCLUDE_ROOM bytes, which mean nothing before and after; NULL: none, and clutter takes longer
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
// light_side of a primitive, double: > 0 where the light is outside of a sphere or a solid, < 0 where it is inside; of a
// plane the sign of its height over it.
// A lane is blocked where any primitive other than its own blocks it: where 0 < t < 1 on the segment from the point to the
// light. The arithmetic: ref/occlude.h, ref/triangle.h, ref/solid.h. What a point's own primitive does:
//   sphere  blocks where `back` and the light is outside; plane: never
//   triangle  by the side of its plane that the light is on. A flat mesh throws no shadow on itself, points on its edges
//           included, and no light enters a closed mesh by an edge: a point that is, as far as rounding lets us know, in
//           another triangle's plane too is blocked by that where the triangle reaches to the point and parts it from the
//           light as seen along the viewer's ray
//   solid   a disk never; tube and funnel by their other side; a torus where the rest
//           of the segment crosses it, of which it is known to which side it begins; others, being convex, where `back` and the
//           light is outside

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
