/// The contract of the stages that compute the effect of a light at a point: light, occlude, soft_light. Begin
/// with stages.h.
#ifndef GLINT_CONTRACT_LIGHT_H
#define GLINT_CONTRACT_LIGHT_H

#include "engine/render/stages/contract/hits.h"

// ---- light: the effect of one light at each point, before shadows and colours ----

/// The cone of a spot light.
typedef struct glint_spot {
    double axis[3]; ///< unit, the direction of travel
    double outer; ///< cosine of the cone's half angle; there is no light outside of the cone
    double inverse; ///< 1 / (cosine of the inner half angle - outer); +inf if both angles are equal
    float exponent; ///< the light falls off with this power of the cosine; 0: it does not
} glint_spot;

typedef enum glint_emission {
    GLINT_EMIT_ALL, ///< each sample is a point light
    GLINT_EMIT_FRONT, ///< each sample is a point light that only emits to the side of its normal
    GLINT_EMIT_RADIANT_FRONT, ///< with the factor cos' / distance^2; each sample only emits to the side of its normal
    GLINT_EMIT_RADIANT_BOTH, ///< with the same factor; each sample emits to both sides
    GLINT_EMIT_CONE ///< a ball with radiance: each lane has its own sample, in the cone in which the lane's point
        ///< sees the ball
} glint_emission;

/// One sample of an area light: a position on its surface for each lane, so that the pixels of a 4 x 4 block see
/// sixteen positions.
typedef struct glint_light_sample {
    _Alignas(64) double position[3][GLINT_GROUP]; ///< GLINT_EMIT_CONE: position in the cone: a share u of the cone, 0
        ///< .. 1, and cosine and sine of an angle around its axis
    double normal[3][GLINT_GROUP]; ///< unit normal of the light's surface; GLINT_EMIT_CONE: unused
    double center[3], radius; ///< a ball around the whole light; GLINT_EMIT_CONE: the light itself
    double lower[3], upper[3]; ///< a box around the whole light
    uint32_t emission;
} glint_light_sample;
/// A point this close to the ball's surface counts as on the surface. The distance is relative to the point's distance
/// from the ball's centre.
#define GLINT_CONE_SLACK_DOUBLE 0x1p-40
#define GLINT_CONE_SLACK_FLOAT 0x1p-18
// GLINT_EMIT_CONE: each lane's sample is computed by cone_sample.h, in double even if real is float. A point on the
// ball's surface sees the half of the ball on the side of its normal, or nothing. The position is clamped to the
// light's box: if the point is 2^52 radii away, rounding can move the position out of the box. The position is then
// rounded to real, but light_side (below) reads the unrounded position. The weight is the solid angle over pi, so
// that the mean of weight times cosine is the irradiance divided by pi times the radiance.

typedef struct glint_light_args {
    uint32_t group_count;
    const uint16_t *hits;
    const glint_camera_args *camera; ///< the rays of a perspective camera; NULL: the directions are in `direction`
    const void *point[3], *normal[3], *direction[3];
    const uint32_t *material;
    const glint_shade_material *materials; ///< only `highlight` and `least` are read
    const uint16_t *dark;
    bool directional;
    double position[3]; ///< position; directional: the unit vector towards the light; area light: not read
    const double *positions[GLINT_LIGHT_CHUNK]; ///< the positions of several lights that have neither samples nor
        ///< cones and differ only in position; positions[0] NULL: one light, at `position`
    double
        scale; ///< a power of two that brings distances to the light, and for radiant lights their size, near 1; 1 if
        ///< they are near 1 already
    const glint_spot *spot; ///< NULL: light in all directions
    uint32_t sample_count; ///< number of samples of an area light, or number of lights
    const glint_light_sample
        *light_sample[GLINT_LIGHT_CHUNK]; ///< the samples; light_sample[0] NULL: not an area light
    bool attenuated; ///< false: attenuation is not written; always true for spots and radiant lights
    double coefficients[3]; ///< c0, c1, c2
    bool highlights; ///< false: log2_specular is not written
    bool sparing; ///< true: a highlight is left out if it is 0 whatever the light's intensity
    // out, for each sample or light:
    uint16_t *lit[GLINT_LIGHT_CHUNK]; ///< one bit per lane: the light is above the surface's horizon and emits towards
        ///< the point
    float *cosine[GLINT_LIGHT_CHUNK]; ///< n.l in 0 .. 1; 0 where unlit
    float *attenuation[GLINT_LIGHT_CHUNK]; ///< the attenuation w; 0 where unlit
    float *log2_specular
        [GLINT_LIGHT_CHUNK]; ///< log2 of r.v or n.h; GLINT_NO_SPECULAR if there is none or the lane is unlit
    float *brightest[GLINT_LIGHT_CHUNK]; ///< the largest log2_specular written, or GLINT_NO_SPECULAR; may be NULL
} glint_light_args;
#define GLINT_NO_SPECULAR (-1e30f)
#define GLINT_ATTENUATION_MAX 0x1p100f ///< far above white, yet the sum of a few such values is finite
// Groups without a hit only get lit = 0. Groups with lit = 0 only get `lit`. The arithmetic: ref/light.h; the factor
// S of a spot is computed as in shade. log2_specular is 0.5 log2 of (r.v)^2 or (n.h)^2. It is GLINT_NO_SPECULAR below
// 2^-126 and, if `sparing`, where the material's `least` says that the highlight is 0. With --precision float, all of
// this arithmetic is float, including products of squared lengths.

// ---- lit_surface: surface and light of a plain light in one stage ----
//
// Like surface followed by light for the same groups, with two differences: the light has neither samples nor a cone,
// and normals may be left out unless `all_normals` or `mixed` is set.

// ---- occlude: which points a light reaches ----

#define GLINT_GRID_STEPS 6144 ///< unit of `center`: number of steps per cell of a light's grid
#define GLINT_GRID_ASIDE 4.5 ///< in cells: the position of an entry is at most this far before or behind the entry's
    ///< cell
#define GLINT_GRID_RADIUS 8 ///< steps per unit of an entry's radius
#define GLINT_GRID_RADIUS_BITS 12 ///< number of the lower bits of an entry's size that hold the radius

/// The occluders of a light without samples: small spheres that do not contain the light, sorted into square cells of
/// the light's view. A point at (a, b, w) along the axes from the origin is projected to u = a / w, v = b / w; for a
/// directional light to u = a, v = b.
typedef struct glint_light_grid {
    bool directional;
    double position[3]; ///< as in glint_occlude_args
    double origin[3]; ///< the light's position; directional: the index's origin
    double axis[3][3]; ///< the axes across, down, and away from the light; their length is the index's unit
    float first[2], cells; ///< first: projected position of the first cell; cells: number of cells per unit
    uint32_t count[2]; ///< number of columns and rows
    float nearest, slices; ///< nearest: the smallest `near`, above 0 if the light has a position; slices: number of
        ///< depth slices per unit of w, counted from `nearest`
    bool sorted; ///< in each cell the entries are in order of `near`
    const uint32_t *begin; ///< index of each cell's first entry, row by row, and the end of the last cell's entries
    // One element for each entry, which is a sphere in a cell, and GLINT_GROUP undefined elements more:
    const uint32_t *center; ///< position of the sphere's centre, in steps from the point GLINT_GRID_ASIDE before the
        ///< cell: position across + 2^16 times position down
    const uint32_t *size; ///< the radius, and `near` in the bits above. A segment at the projected position (u, v)
        ///< that hits the sphere, whose centre is (du, dv) away, has du^2 + dv^2 <= radius^2 (1 + u^2 + v^2);
        ///< directional: <= radius^2. All points that the sphere blocks have (w - nearest) slices >= `near`
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
    const glint_light_grid *grid; ///< the grid of this light and geometry; NULL: there is none
    const atomic_bool *stop; ///< as in glint_cast_args
    const glint_camera_args *camera; ///< the rays of a perspective camera that hit the points; NULL: the directions are
        ///< in `direction`
    const void *direction[3];
    const void *slack; ///< as written by surface; only read if the table has triangles
    void *scratch; ///< area lights: GLINT_OCCLUDE_SCRATCH bytes of memory; NULL: no memory, which makes scenes with
        ///< many occluders slower
    const glint_point_box *box; ///< as written by surface: a box around all lit points, and perhaps other points;
        ///< NULL: unknown
    uint16_t *unoccluded[GLINT_LIGHT_CHUNK]; ///< out: the lanes of `lit` without an occluder
    uint64_t *rays; ///< in and out: the number of lanes of `lit` is added; for area lights, only lanes that no test
        ///< of the whole light decided
    float *visible; ///< out, caps: the visible share of the light in lanes of `lit`, 0 in others; `unoccluded` then
    ///< has the lanes with a share above 0. The table has only spheres and planes, and light_sample[0] gives the
    ///< light's ball around `position`; the samples are ignored. NULL: no caps
    uint64_t *overlaps; ///< in and out, caps: the number of tested pairs of a point and a primitive is added
    uint64_t
        *tests; ///< in and out: the number of decided pairs is added, as in glint_cast_args. A pair is a primitive
        ///< and a point, or a primitive and the segment from a point to a sample
} glint_occlude_args;
// Below, `position` is the position of the light in each lane. light_side of a primitive is a double: > 0 if the
// light is outside of a sphere or a solid, < 0 if it is inside; for a plane it has the sign of the light's height
// over the plane. Any primitive except the point's own blocks a lane if the segment from the point to the light hits
// it at 0 < t < 1. The arithmetic: ref/occlude.h, ref/triangle.h, ref/solid.h. A point's own primitive blocks the
// light as follows:
//   sphere: if `back` and the light is outside
//   plane: never
//   triangle: depending on the side of its plane that the light is on. A flat mesh casts no shadow on itself,
//     including points on its edges, and no light enters a closed mesh at an edge: if a point is, within rounding,
//     also in the plane of another triangle, that triangle blocks the light if it extends to the point and, as seen
//     along the viewer's ray, separates the point from the light
//   solid: a disk never; tube and funnel if the segment hits their other side; a torus if the rest of the segment
//     hits it, given the side on which the segment begins; other solids are convex: if `back` and the light is
//     outside

// caps: `visible` is the product of the shares that the primitives leave visible, starting with 1, in the table's
// order. If two balls do not touch, the one with the shorter tangent is in front of the other. The arithmetic:
// ref/caps.h, after C. Oat and P. Sander, "Ambient aperture lighting", I3D 2007. It uses half angles throughout, so
// that caps of 1e-8 keep their digits. Areas are computed by Gauss-Bonnet, as sectors minus triangles.

// ---- soft_light: light, occlude and the sums of shade in one stage, for the samples of an area light ----

typedef struct glint_soft_args {
    const glint_light_args *light; ///< arguments for an area light; the outputs in them are not written
    const glint_occlude_args
        *occlude; ///< arguments for the same points and samples; `lit` is not read, `unoccluded` not written; NULL:
        ///< the light casts no shadows
    // out:
    uint16_t *reached; ///< bit mask of the lanes that any sample reaches
    float *diffuse; ///< the sum of w cosine over the samples that reach the lane
    float *specular; ///< the sum of w S over these samples; written if `highlights` is set
} glint_soft_args;
// soft_light returns false if there are too many occluders for one kernel: the outputs are then undefined, and the
// caller calls light and occlude. Otherwise the results are those of light, occlude, and shade's sums for joined
// lights, for materials without microfacets. Groups that no sample reaches only get reached = 0. In other groups,
// lanes that no sample reaches get 0.

#endif
