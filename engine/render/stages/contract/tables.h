/// The contract of the stages: definitions that all of them share, and the tables that they read. Begin with
/// stages.h.
#ifndef GLINT_CONTRACT_TABLES_H
#define GLINT_CONTRACT_TABLES_H

#include "engine/film/codes.h"
#include "engine/render/stages/contract/with.h"

#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define GLINT_GROUP 16
#define GLINT_TILE_GROUPS (GLINT_TILE_WIDTH * GLINT_TILE_HEIGHT / GLINT_GROUP)
#define GLINT_TILE_SAMPLES (GLINT_TILE_WIDTH * GLINT_TILE_HEIGHT)
#define GLINT_MISS 0xffffffffu ///< in `prim`: nothing hit
#define GLINT_FILTER_SLACK (16 * 0x1p-24f) ///< error bound of a distance computed in float, relative to the lengths
    ///< that the distance is computed from
#define GLINT_GRID_OTHERS 12 ///< maximum number of bounded primitives that are in no cell of a light's grid and are
    ///< tested one by one
#define GLINT_LIGHT_CHUNK 16 ///< maximum number of lights, or of samples of one light, per call of a stage

// ---- Tables that the kernels read, made by plan.c ----------------------------------------------------------------

typedef enum glint_prim_kind {
    GLINT_PRIM_SPHERE,
    GLINT_PRIM_PLANE,
    GLINT_PRIM_TRIANGLE = GLINT_KIND(GLINT_WITH(MESH), 2),
    GLINT_PRIM_SOLID = GLINT_KIND(GLINT_WITH(SOLID), 3),
    GLINT_PRIM_COMBINED = GLINT_KIND(GLINT_WITH(COMBINED), 4),
    GLINT_PRIM_HULL = GLINT_KIND(GLINT_WITH(COMBINED), 5) ///< a closed mesh, as a part of a combined solid
} glint_prim_kind;

/// One surface, without data of any ray. It fills one cache line; the filter only reads the first half.
typedef struct glint_prim {
    _Alignas(64) uint16_t kind;
    uint8_t two_sided; ///< 0: a side seen from behind only gets ambient light
    uint8_t inverted; ///< 1: a subtracted part, whose outside is the inside of the whole
    uint32_t id; ///< number in order of definition, from 0
    uint32_t material; ///< index in the material table
    float filter_center[3]; ///< centre of a bounding sphere: (center - reference) * scale, in the index's frame
    float filter_bound; ///< radius of that sphere plus rounding: >= radius (1 + 2e-6) + 16 * 2^-24 |filter_center|,
                        ///< in the index's units; plane: +inf; triangle: the sphere encloses its bounding box,
                        ///< enlarged on each side by 13 GLINT_POINT_SLACK_DOUBLE extent scale
    uint32_t medium; ///< index in the material table: the medium that a ray enters through it; for a part: the medium
        ///< of the whole
    union {
        double center[3]; ///< sphere, solid: centre; plane: a point on it
        struct {
            double (*corner)[3]; ///< triangle: its three corners; combined, hull: centre, lower and upper corner of the
                ///< bounding box, -inf and inf where it is unbounded
            uint32_t shading_points; ///< triangle: index in shading_points; GLINT_MISS: the triangle's light is
                ///< computed for each sample
        };
    };
    union {
        double radius; ///< sphere, world units
        double *normal; ///< plane: the unit normal. normal[3] is 2 (|normal| . |center|), above 0; or 0: the plane is
            ///< along two axes, and heights over it are exact
        struct {
            uint32_t item; ///< triangle: index in corner_normals, GLINT_MISS: flat, with the face's normal; solid:
                ///< index in solids; combined: index in combined; hull: index in hulls
            uint32_t face; ///< part of a combined solid: a torus is two consecutive parts, 1 for the first interval
                ///< of a ray inside of it, 2 for the second; a closed mesh is consecutive parts, numbered 1 ..
                ///< GLINT_HULL_PARTS; 0: any other solid. Triangle: 1 + index in faces of the plane that it shares
                ///< with other triangles; 0: it shares none
        };
    };
} glint_prim;

/// Returns the scale of a sphere's unit, a power of two: the radius times this is in [1, 2). radius: a normal number.
static inline double glint_sphere_scale(const glint_prim *prim)
{
    uint64_t bits;
    double scale;
    memcpy(&bits, &prim->radius, sizeof bits);
    const uint64_t exponent = 2046 - (bits >> 52); // the exponent field of 2^e is 1023 + e
    bits = (exponent > 1 ? exponent : 1) << 52;
    memcpy(&scale, &bits, sizeof scale);
    return scale;
}

/// Returns (radius scale)^2, rounded.
static inline double glint_sphere_r2(const glint_prim *prim)
{
    const double r = prim->radius * glint_sphere_scale(prim);
    return r * r;
}

/// Returns the rounding error of glint_sphere_r2.
static inline double glint_sphere_r2_low(const glint_prim *prim)
{
    const double r = prim->radius * glint_sphere_scale(prim);
#ifdef __FMA__
    return __builtin_fma(r, r, -(r * r));
#else
    const double wide = (0x1p27 + 1) * r, upper = wide - (wide - r);
    const double lower = r - upper; // Veltkamp's split: products of the halves are exact, as in Dekker's product
    return ((upper * upper - r * r) + 2 * (upper * lower)) + lower * lower;
#endif
}

#define GLINT_NODE_WIDTH 16
#define GLINT_NODE_PRIM 0x80000000u ///< flag in `child`: the other bits are the index of a primitive, not of a node
#define GLINT_BVH_DEPTH 32 ///< maximum number of nodes on a path from the root

/// Sixteen boxes of the spatial index, one per lane. An empty slot has lower = +inf, upper = -inf.
typedef struct glint_node {
    float lower[3][GLINT_NODE_WIDTH], upper[3][GLINT_NODE_WIDTH];
    uint32_t child[GLINT_NODE_WIDTH];
} glint_node;

/// Normals at the corners of a smoothly shaded triangle: unit, except after a map that does not preserve angles.
typedef struct glint_corner_normals {
    double normal[3][3];
    double terminator; ///< see glint_mesh_desc; 0: points stay on the triangle
} glint_corner_normals;

/// The points of a triangle at which light is computed once for all samples: its corners, or its face three times.
typedef struct glint_shading_points {
    uint32_t at[3];
} glint_shading_points;

/// The unit shapes: x^2 + y^2 + z^2 <= 1; all of x, y, z in -1 .. 1; x^2 + y^2 <= 1 with z in -1 .. 1; x^2 + y^2 <=
/// z^2 with z in 0 .. 1; x^2 + y^2 <= 1 with z = 0; (sqrt(x^2 + y^2) - 1)^2 + z^2 <= tube^2.
typedef enum glint_form {
    GLINT_FORM_BALL,
    GLINT_FORM_BOX,
    GLINT_FORM_CYLINDER,
    GLINT_FORM_CONE,
    GLINT_FORM_DISK,
    GLINT_FORM_TUBE, ///< only the side of a cylinder or cone, without an inside
    GLINT_FORM_FUNNEL,
    GLINT_FORM_TORUS
} glint_form;

/// The plane of a flat face. All faces that the scene describes in one plane have the same values here, except for
/// the sign of the normal, so that rays hit them at the same t. These are faces along two axes of one map, or with
/// equal point and normal.
typedef struct glint_face {
    double normal[3]; ///< unit
    double at[3]; ///< a point on the plane
    double magnitude; ///< bound of the terms of a height over the face: |normal| . (bound of |x| on the surface +
        ///< |at|)
    uint32_t axis; ///< the axis of the world that the normal is parallel to; 3: none
} glint_face;

/// The image of a unit shape under center + forward k.
typedef struct glint_solid {
    double inverse[3][3], forward[3][3]; ///< rows
    const glint_face *faces; ///< box: the faces at low x, high x, low y, high y, low z, high z; cylinder, cone, disk
        ///< and the open forms: the faces at low z and high z (the same for a disk); ball, torus: NULL. Normals point
        ///< from low to high
    double magnitude; ///< sphere, cylinder, cone: bound of the terms of x^2 + y^2 - 1 (or similar) for points on the
        ///< side; torus: bound of the terms of a point's distance from the circle in the middle of the tube
    double tube; ///< torus: radius of its tube in the space in which the radius of that circle is 1; above 0 and below
        ///< 1
    float lower[3], upper[3]; ///< a bounding box in the index's frame, rounded outwards; undefined for a part
    float axis[3], thick; ///< cylinder, cone and open forms that are longer than wide: no point is further than
                          ///< `thick`, in the index's units, from the line through the centre along `axis`, which is
                          ///< unit within rounding; otherwise `thick` is infinite
    uint32_t form;
} glint_solid;

#define GLINT_PARTS_MAX 64 ///< maximum number of parts of a combined solid
#define GLINT_HULL_PARTS 4 ///< number of parts of one closed mesh: how many intervals of a ray inside the mesh are
    ///< stored at a time

/// Operations in the program of a combined solid; smaller numbers are parts.
enum {
    GLINT_COMBINE_UNION = GLINT_PARTS_MAX, ///< the union of the two sets before it; the next two operations also
        ///< combine two sets
    GLINT_COMBINE_INTERSECTION,
    GLINT_COMBINE_DIFFERENCE, ///< the first set minus the second
    GLINT_COMBINE_NOTHING ///< an empty set
};

/// Solids and planes (a plane stands for the half-space behind its normal) combined by a program in postfix. Rays hit
/// the parts only by way of the combined solid. A hit is stored with the index of the part in prims. Parts follow the
/// primitives that rays hit directly.
typedef struct glint_combined {
    uint32_t first; ///< prims[prim_count + first] is part 0
    uint32_t count; ///< number of parts
    uint32_t length; ///< length of the program
    float lower[3], upper[3]; ///< a bounding box, as for a solid
    // Sets of parts, one bit for each part:
    uint64_t all; ///< every part, if the program has no empty set; otherwise 0
    uint64_t needs; ///< if any one of these parts is empty, the whole is empty
    uint64_t alone; ///< each of these parts is the whole if all other parts are empty
    uint8_t program[2 * GLINT_PARTS_MAX];
} glint_combined;

/// A closed mesh that is a part of a combined solid. Its triangles are prims[prim_count + first] and the following,
/// in order of definition. Their corners run counter-clockwise as seen from outside of the whole. A hit is stored
/// with the index of the triangle.
typedef struct glint_hull {
    uint32_t first, count;
    const glint_node *nodes; ///< a tree over the triangles, in the index's frame; a GLINT_NODE_PRIM child is the
        ///< number of a triangle, from 0
} glint_hull;

/// Returns the number of pairs of parallel faces that a form has.
static inline int glint_slab_count(uint32_t form)
{
    return form == GLINT_FORM_BALL || form == GLINT_FORM_TORUS ? 0 : form == GLINT_FORM_BOX ? 3 : 1;
}

/// Returns the axis that a vector is parallel to; 3: none.
static inline int glint_axis_along(const double v[3])
{
    const int x = v[0] != 0, y = v[1] != 0, z = v[2] != 0;
    return x + y + z != 1 ? 3 : x ? 0 : y ? 1 : 2;
}

/// Bound of the rounding error of a height, relative to the terms of the height. A point closer to a face than this
/// counts as on the face.
#define GLINT_ON_FACE_DOUBLE 0x1p-50
#define GLINT_ON_FACE_FLOAT 0x1p-21

/// Returns the height of a point over a face; 0 if it is on the face within rounding.
static inline double glint_face_height(const glint_face *face, const double point[3])
{
    double q[3];
    for (int c = 0; c < 3; c++)
        q[c] = point[c] - face->at[c];
    if (face->axis < 3)
        return face->normal[face->axis] * q[face->axis];
    const double h = (face->normal[0] * q[0] + face->normal[1] * q[1]) + face->normal[2] * q[2];
    const double on = GLINT_ON_FACE_DOUBLE * face->magnitude;
    return h <= on && -on <= h ? 0 : h;
}

/// Returns whether a point is strictly inside the solid around `center`; always false for a disk, tube or funnel.
static inline bool glint_solid_holds(const glint_solid *solid, const double center[3], const double point[3])
{
    double k[3];
    for (int i = 0; i < glint_slab_count(solid->form); i++)
        if (!(glint_face_height(&solid->faces[2 * i], point) > 0 &&
              glint_face_height(&solid->faces[2 * i + 1], point) < 0))
            return false;
    if (solid->form == GLINT_FORM_BOX)
        return true;
    for (int c = 0; c < 3; c++) {
        const double *row = solid->inverse[c];
        k[c] = (row[0] * (point[0] - center[0]) + row[1] * (point[1] - center[1])) + row[2] * (point[2] - center[2]);
    }
    const double round = k[0] * k[0] + k[1] * k[1], z = k[2];
    switch (solid->form) {
    case GLINT_FORM_BALL:
        return round + z * z < 1;
    case GLINT_FORM_CYLINDER:
        return round < 1;
    case GLINT_FORM_CONE:
        return round < z * z;
    case GLINT_FORM_TORUS:
        return (sqrt(round) - 1) * (sqrt(round) - 1) + z * z < solid->tube * solid->tube;
    default:
        return false;
    }
}

/// The surfaces that rays hit (of bit-equal surfaces only the first), and the index over the bounded ones. The
/// index's frame is (x - reference) * scale.
typedef struct glint_geometry_table {
    const glint_prim *prims; ///< triangles first, then the others, each in the order of the index, so that neighbours
        ///< in space are neighbours in memory. They are followed by the parts of combined solids, and by the
        ///< triangles of parts that are meshes, which prim_count does not include
    uint32_t prim_count, triangles; ///< prims[0 .. triangles) are triangles
    const double (*corners)[3][3]; ///< the corners of each triangle
    const glint_node *nodes; ///< nodes[0] is the root; NULL: no primitive is bounded
    const uint32_t *unbounded; ///< the primitives that are not in the tree: planes, and combined solids without bounds
    uint32_t unbounded_count;
    double reference[3], scale; ///< scale is a power of two
    double extent; ///< bound of every coordinate and radius, world units
    bool tori; ///< true: the scene has tori
    bool moves; ///< true: some `corner_normals` have a terminator above 0
    const glint_corner_normals *corner_normals;
    const glint_solid *solids; ///< NULL: there are neither solids nor combined solids
    const glint_combined *combined;
    const glint_hull *hulls; ///< NULL: none
    const glint_face *faces; ///< the planes that triangles share
    const glint_shading_points *shading_points;
    uint32_t shading_point_count; ///< 0: all light is computed per sample
} glint_geometry_table;

/// The input of a material's specular term from the stages before shade.
typedef enum glint_highlight {
    GLINT_HIGHLIGHT_NONE,
    GLINT_HIGHLIGHT_PHONG,
    GLINT_HIGHLIGHT_BLINN,
    GLINT_HIGHLIGHT_FACETS ///< microfacets: the input comes from the stages `view` and `facet`
} glint_highlight;

/// The kind of highlight that shade computes from this input.
typedef enum glint_lobe {
    GLINT_LOBE_POWER,
    GLINT_LOBE_POWER_COSINE, ///< the power, times n.l
    GLINT_LOBE_GGX,
    GLINT_LOBE_BECKMANN
} glint_lobe;

/// The fields of a material that differ between samples, one bit each. They are read from planes, see
/// glint_shade_planes.
enum {
    GLINT_PLANE_DIFFUSE = 1,
    GLINT_PLANE_AMBIENT = 2,
    GLINT_PLANE_AMBIENT_IS_DIFFUSE = 4, ///< the plane of the diffuse reflectance also has the ambient reflectance
    GLINT_PLANE_SPECULAR = 8,
    GLINT_PLANE_SHININESS = 16,
    GLINT_PLANE_ALPHA = 32,
    GLINT_PLANE_SHADED = 64 ///< the planes have the total light of all lights, or the sums already include it
};

typedef struct glint_shade_material {
    double diffuse[3], specular[3]; ///< reflectances; for a field in a plane, the factor of the plane
    double ambient[3]; ///< ka * Ia
    float shininess;
    float least; ///< lower limit of (r.v)^2 or (n.h)^2: below it the highlight is certainly 0; 0: unknown
    uint32_t highlight; ///< glint_highlight: the input of its specular term
    uint32_t lobe; ///< glint_lobe
    float alpha; ///< width of the microfacet distribution, 1e-18 .. 1
    double grazing[3]; ///< microfacets: `specular` is ks f0, and this is ks (1 - f0); if a plane has ks, neither
        ///< includes the factor ks
    uint32_t planes; ///< GLINT_PLANE_...; 0: all fields are in this structure
} glint_shade_material;

#endif
