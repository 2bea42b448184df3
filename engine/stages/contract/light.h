/// The contract of the stages that compute the effect of a light at a point: view, light, facet, occlude, soft_light.
/// Begin with stages.h.
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

// ---- light: the effect of one light at each point, before shadows and colours ----

/// The cone of a spot light.
typedef struct glint_spot {
    double axis[3]; ///< unit, the direction of travel
    double outer; ///< cosine of the half angle, outside of which there is no light
    double inverse; ///< 1 / (cosine of the inner half angle - outer); +inf if both angles are equal
    float exponent; ///< power of the cosine; 0: none
} glint_spot;

typedef enum glint_emission {
    GLINT_EMIT_ALL, ///< each sample is a point light
    GLINT_EMIT_FRONT, ///< likewise, only to the side of its normal
    GLINT_EMIT_RADIANT_FRONT, ///< with the factor cos' / distance^2, only to the side of its normal
    GLINT_EMIT_RADIANT_BOTH, ///< to both sides
    GLINT_EMIT_CONE ///< a ball with radiance: each lane has its own sample, in the cone in which it sees the ball
} glint_emission;

/// One sample of an area light: a position on its surface for each lane, so that the pixels of a 4 x 4 block see
/// sixteen positions.
typedef struct glint_light_sample {
    _Alignas(64) double position[3][GLINT_GROUP]; ///< GLINT_EMIT_CONE: position in the cone: a share u of it, 0 .. 1,
        ///< and cosine and sine of an angle around its axis
    double normal[3][GLINT_GROUP]; ///< unit, normal of the light's surface; GLINT_EMIT_CONE: none
    double center[3], radius; ///< a ball around the whole light; GLINT_EMIT_CONE: the light itself
    double lower[3], upper[3]; ///< a box around the whole light
    uint32_t emission;
} glint_light_sample;
/// Relative to a point's distance from the centre: points this close to the sphere's surface count as on it.
#define GLINT_CONE_SLACK_DOUBLE 0x1p-40
#define GLINT_CONE_SLACK_FLOAT 0x1p-18
// GLINT_EMIT_CONE: cone_sample.h, for each lane, in double also if real is float. A point on the ball's surface sees
// the half of the ball on the side of its normal, or nothing. The position is clamped to the light's box: rounding
// can leave the box where the point is 2^52 radii away. It is then rounded to real, but light_side (below) reads the
// unrounded position. The weight is the solid angle over pi, so that the mean of weight cosine is irradiance over pi
// radiance.

typedef struct glint_light_args {
    uint32_t group_count;
    const uint16_t *hits;
    const glint_camera_args *camera; ///< the rays of a perspective camera; NULL: the directions are in `direction`
    const void *point[3], *normal[3], *direction[3];
    const uint32_t *material;
    const glint_shade_material *materials; ///< only `highlight` and `least` are read
    const uint16_t *dark;
    bool directional;
    double position[3]; ///< of the light; directional: the unit vector towards it; not read for area lights
    const double *positions[GLINT_LIGHT_CHUNK]; ///< for several lights, without samples or cones, that differ only in
        ///< position: the position of each; positions[0] NULL: one light, at `position`
    double
        scale; ///< a power of two that brings distances to the light, and for radiant lamps their size, near 1; 1 if
        ///< they are near enough already
    const glint_spot *spot; ///< NULL: light in all directions
    uint32_t sample_count; ///< samples of an area light, or number of lights
    const glint_light_sample
        *light_sample[GLINT_LIGHT_CHUNK]; ///< the samples; light_sample[0] NULL: not an area light
    bool attenuated; ///< false: attenuation is not written; true for spots and radiant lamps
    double coefficients[3]; ///< c0, c1, c2
    bool highlights; ///< false: log2_specular is not written
    bool sparing; ///< highlights are left out if they are 0 at any intensity
    // out, for each sample or light:
    uint16_t *lit[GLINT_LIGHT_CHUNK]; ///< one bit per lane: the light is above the surface's horizon and emits towards
        ///< the point
    float *cosine[GLINT_LIGHT_CHUNK]; ///< n.l in 0 .. 1; 0 where unlit
    float *attenuation[GLINT_LIGHT_CHUNK]; ///< w; 0 where unlit
    float *log2_specular
        [GLINT_LIGHT_CHUNK]; ///< log2 of r.v or n.h; GLINT_NO_SPECULAR if there is none or the lane is unlit
    float *brightest[GLINT_LIGHT_CHUNK]; ///< the largest log2_specular written, or GLINT_NO_SPECULAR; may be NULL
} glint_light_args;
#define GLINT_NO_SPECULAR (-1e30f)
#define GLINT_ATTENUATION_MAX 0x1p100f ///< far above white, yet the sum of a few is finite
// Groups without a hit only get lit = 0. Groups with lit = 0 only get `lit`. The arithmetic: ref/light.h; S of a spot
// as in shade. log2_specular is 0.5 log2 of (r.v)^2 or (n.h)^2. There is none below 2^-126, nor, if `sparing`, where
// the material's `least` says that the highlight is 0. With --precision float all of this is float, also products of
// squared lengths.

// ---- lit_surface: surface and the light of a plain lamp in one ----
//
// Like surface followed by light for the same groups, with two differences: the light has neither samples nor a cone,
// and normals may be left out unless `all_normals` or `mixed` is set.

// ---- facet: the position of a light's half vector, for materials with microfacets ----

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
    const uint16_t *lit[GLINT_LIGHT_CHUNK]; ///< written by the stage light
    // out, for each sample:
    float *sine2[GLINT_LIGHT_CHUNK]; ///< squared sine between n and h; GLINT_NO_SPECULAR where unlit or if h is
        ///< undefined
    float *schlick[GLINT_LIGHT_CHUNK]; ///< (1 - v.h)^5; 0 where unlit or if h is undefined
} glint_facet_args;
// Only groups with a lit lane on a material of GLINT_HIGHLIGHT_FACETS are written, in every lane. The arithmetic:
// ref/microfacets.h; Schlick's (v.h)^2 is computed from half of the angle between l and v, so that h need not be
// unit.

// ---- occlude: which points a light reaches ----

#define GLINT_GRID_STEPS 6144 ///< steps of `center` per cell of a light's grid
#define GLINT_GRID_ASIDE 4.5 ///< cells: the position of an entry is at most this far before or behind its cell
#define GLINT_GRID_RADIUS 8 ///< steps per unit of an entry's radius
#define GLINT_GRID_RADIUS_BITS 12 ///< lower bits of an entry's size, which hold the radius

/// The occluders of a light without samples: small spheres that the light is outside of, in square cells of the
/// light's view. A point at (a, b, w) along the axes from the origin is projected to u = a / w, v = b / w; for a
/// directional light to u = a, v = b.
typedef struct glint_light_grid {
    bool directional;
    double position[3]; ///< as in glint_occlude_args
    double origin[3]; ///< the light's position; directional: the index's origin
    double axis[3][3]; ///< across, down and away from the light; their length is the index's unit
    float first[2], cells; ///< projected position of the first cell, cells per unit
    uint32_t count[2]; ///< columns and rows
    float nearest, slices; ///< smallest `near`, above 0 if the light has a position; slices of depth per unit of w,
        ///< counted from there
    bool sorted; ///< in each cell the entries are in order of `near`
    const uint32_t *begin; ///< where each cell's entries begin, row by row, and the end of the last cell
    // for each entry, a sphere in a cell, and GLINT_GROUP undefined entries more:
    const uint32_t *center; ///< of the sphere's centre, in steps from GLINT_GRID_ASIDE before its cell: across + 2^16
        ///< down
    const uint32_t *size; ///< radius, and `near` in the bits above. A segment that hits the sphere has du^2 + dv^2 <=
        ///< radius^2 (1 + u^2 + v^2), at its own projected position; directional: <= radius^2. All points that the
        ///< sphere blocks have (w - nearest) slices >= `near`
    const uint32_t *id;
    uint32_t others[GLINT_GRID_OTHERS], other_count; ///< the bounded primitives that are in no cell
} glint_light_grid;

#define GLINT_OCCLUDE_SCRATCH ((size_t)512 << 10) ///< bytes

typedef struct glint_occlude_args {
    uint32_t group_count;
    uint32_t sample_count; ///< as in glint_light_args
    const glint_light_sample *light_sample[GLINT_LIGHT_CHUNK];
    const uint16_t *lit[GLINT_LIGHT_CHUNK];
    const void *point[3];
    const void *normal[3]; ///< only read for GLINT_EMIT_CONE
    const uint32_t *prim; ///< the primitives that the points are on; GLINT_MISS: none
    const uint16_t *back;
    bool directional;
    double position[3]; ///< as in glint_light_args
    double scale; ///< as in glint_light_args
    const glint_geometry_table *geometry;
    const glint_light_grid *grid; ///< of this light and geometry; NULL: none
    const atomic_bool *stop; ///< as in glint_cast_args
    const glint_camera_args *camera; ///< the rays of a perspective camera that hit the points; NULL: the directions are
        ///< in `direction`
    const void *direction[3];
    const void *slack; ///< written by surface; only read if the table has triangles
    void *scratch; ///< area lights: GLINT_OCCLUDE_SCRATCH bytes of memory; NULL: none, and scenes with many occluders
        ///< take longer
    const glint_point_box *box; ///< written by surface: around all lit points, perhaps also others; NULL: unknown
    uint16_t *unoccluded[GLINT_LIGHT_CHUNK]; ///< out: the lanes of `lit` without an occluder
    uint64_t *rays; ///< added to: lanes of `lit`; for area lights, those that no test of the whole light decides
    float *visible; ///< out, caps: the visible share of the light in lanes of `lit`, 0 in others; `unoccluded` then has
    ///< the lanes with a share above 0. The table has only spheres and planes, and lamp[0] is the light around
    ///< `position`; its samples are ignored. NULL: no caps
    uint64_t *overlaps; ///< caps, added to: pairs of a point and a primitive that were tested
    uint64_t
        *tests; ///< added to: pairs of a point, or of a point and a sample, and a primitive that are decided, as in
        ///< glint_cast_args
} glint_occlude_args;
// Below, `position` stands for each lane's own position of the light. light_side of a primitive, double: > 0 if the
// light is outside of a sphere or a solid, < 0 if it is inside; for a plane the sign of the light's height over it. A
// lane is blocked by any other primitive with 0 < t < 1 on the segment from the point to the light. The arithmetic:
// ref/occlude.h, ref/triangle.h, ref/solid.h. A point's own primitive blocks it as follows:
//   sphere: if `back` and the light is outside
//   plane: never
//   triangle: by the side of its plane that the light is on. A flat mesh casts no shadow on itself, including points
//     on its edges, and no light enters a closed mesh at an edge: if a point is within rounding in the plane of
//     another triangle, too, that triangle blocks it if it reaches to the point and separates it from the light as
//     seen along the viewer's ray
//   solid: a disk never; tube and funnel by their other side; a torus if the rest of the segment hits it, where it is
//     known on which side the segment begins; others, being convex, if `back` and the light is outside

// ---- soft_light: light, occlude and the sums of shade for the samples of an area light in one ----

typedef struct glint_soft_args {
    const glint_light_args *light; ///< of an area light; its outputs are not written
    const glint_occlude_args
        *occlude; ///< of the same points and samples; `lit` is not read, `unoccluded` not written; NULL:
        ///< the light casts no shadows
    // out:
    uint16_t *reached; ///< one bit per lane that some sample reaches
    float *diffuse; ///< the sum of w cosine over the samples that reach the lane
    float *specular; ///< the sum of w S; written if highlights
} glint_soft_args;
// Returns false if there are too many occluders for one kernel: the outputs are then undefined, and the caller calls
// light and occlude. Otherwise the results are those of light, occlude, and shade's sums for joined lights, for
// materials without microfacets. Groups that no sample reaches only get reached = 0. In other groups, lanes that no
// sample reaches get 0.

#endif
