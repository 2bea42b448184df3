/// The contract of the stages: what all of them share, and the tables that they look up. Begin with stages.h.
#ifndef GLINT_CONTRACT_TABLES_H
#define GLINT_CONTRACT_TABLES_H

#include "engine/stages/contract/with.h"

#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define GLINT_GROUP 16
#define GLINT_TILE_WIDTH 32
#define GLINT_TILE_HEIGHT 24
#define GLINT_TILE_GROUPS (GLINT_TILE_WIDTH * GLINT_TILE_HEIGHT / GLINT_GROUP)
#define GLINT_TILE_SAMPLES (GLINT_TILE_WIDTH * GLINT_TILE_HEIGHT)
#define GLINT_MISS 0xffffffffu ///< in `prim`: nothing hit
#define GLINT_FILTER_SLACK (16 * 0x1p-24f) ///< what float rounding may add to a distance, of the lengths it came from
#define GLINT_GRID_OTHERS 12 ///< what a light's grid leaves to be tested one by one, at most
#define GLINT_LIGHT_CHUNK 16 ///< lights, or samples of one light, that one call of a stage takes at most

// ---- Tables: what the kernels look up, made by plan.c ------------------------------------------------------------

typedef enum glint_prim_kind {
    GLINT_PRIM_SPHERE,
    GLINT_PRIM_PLANE,
    GLINT_PRIM_TRIANGLE = GLINT_KIND(GLINT_WITH_MESH, 2),
    GLINT_PRIM_SOLID = GLINT_KIND(GLINT_WITH_SOLID, 3),
    GLINT_PRIM_COMBINED = GLINT_KIND(GLINT_WITH_COMBINED, 4),
    GLINT_PRIM_HULL = GLINT_KIND(GLINT_WITH_COMBINED, 5) ///< a closed mesh, as a part of a combined solid
} glint_prim_kind;

/// One surface, as far as no ray is concerned: a line of the cache, of which the filter reads the first half.
typedef struct glint_prim {
    _Alignas(64) uint16_t kind;
    uint8_t two_sided; ///< 0: seen from behind it gets ambient light only
    uint8_t turned; ///< 1: a part that is taken away: the outside of it is the inside of the whole
    uint32_t id; ///< its number in order of definition, from 0
    uint32_t material; ///< index in the material table
    float filter_center[3]; ///< of a sphere around it: (center - reference) * scale, in the index's frame
    float filter_bound; ///< >= its radius (1 + 2e-6) + 16 * 2^-24 |filter_center|, in the index's units; plane: +inf; triangle:
                        ///< of its box, where the box has on each side 13 GLINT_POINT_SLACK_DOUBLE extent scale besides
    uint32_t medium; ///< index in the material table: the medium entered through it; for a part: of its whole
    union {
        double center[3]; ///< sphere, solid: centre; plane: a point of it
        struct {
            double (*corner)[3]; ///< triangle: three; combined, hull: the middle of its box, the box's lower and its upper corner, -inf
                ///< and inf where it has no end
            uint32_t shading_points; ///< triangle: index in sites, GLINT_MISS: its light is computed for each sample
        };
    };
    union {
        double radius; ///< sphere, world units
        double *normal; ///< plane: unit; behind it, in normal[3], 2 (|normal| . |center|), above 0; 0: it is along two axes, and
            ///< heights are exact
        struct {
            uint32_t item; ///< triangle: index in corner_normals, GLINT_MISS: it has its own; solid: index in solids;
                ///< combined: index in combined; hull: index in hulls
            uint32_t face; ///< of a combined solid's parts: 1 and 2: a torus, by the first and by the second stretch that a ray is inside
                ///< of it, two parts that follow each other; 1 .. GLINT_HULL_PARTS: a closed mesh, likewise; 0: any other solid.
                ///< Triangle: 1 + index in faces, of the plane it shares with others; 0: it has its own
        };
    };
} glint_prim;

/// A sphere's unit is a power of two: its radius times this is in [1, 2). radius: a normal number.
static inline double glint_sphere_scale(const glint_prim *prim)
{
    uint64_t bits;
    double scale;
    memcpy(&bits, &prim->radius, sizeof bits);
    const uint64_t exponent = 2046 - (bits >> 52); // of 2^e it is 1023 + e
    bits = (exponent > 1 ? exponent : 1) << 52;
    memcpy(&scale, &bits, sizeof scale);
    return scale;
}

/// (radius scale)^2, rounded.
static inline double glint_sphere_r2(const glint_prim *prim)
{
    const double r = prim->radius * glint_sphere_scale(prim);
    return r * r;
}

/// The rounding error of the number above.
static inline double glint_sphere_r2_low(const glint_prim *prim)
{
    const double r = prim->radius * glint_sphere_scale(prim);
#ifdef __FMA__
    return __builtin_fma(r, r, -(r * r));
#else
    const double wide = (0x1p27 + 1) * r, upper = wide - (wide - r);
    const double lower = r - upper; // Veltkamp's halves, of which products are exact, as Dekker has it
    return ((upper * upper - r * r) + 2 * (upper * lower)) + lower * lower;
#endif
}

#define GLINT_NODE_WIDTH 16
#define GLINT_NODE_PRIM 0x80000000u ///< in `child`: the rest is the index of a primitive, not of a node
#define GLINT_BVH_DEPTH 32 ///< nodes on the longest path from the root

/// Sixteen boxes of the spatial index, a lane each. An empty slot has lower = +inf, upper = -inf.
typedef struct glint_node {
    float lower[3][GLINT_NODE_WIDTH], upper[3][GLINT_NODE_WIDTH];
    uint32_t child[GLINT_NODE_WIDTH];
} glint_node;

/// Normals at the corners of a triangle that is shaded smoothly, unit or as a map that keeps no angles leaves them.
typedef struct glint_corner_normals {
    double normal[3][3];
} glint_corner_normals;

/// The points of a triangle whose light is computed once for all samples: its corners, or its face three times.
typedef struct glint_shading_points {
    uint32_t at[3];
} glint_shading_points;

/// The unit shapes: x^2 + y^2 + z^2 <= 1; all of x, y, z in -1 .. 1; x^2 + y^2 <= 1 with z in -1 .. 1; x^2 + y^2 <= z^2 with
/// z in 0 .. 1; x^2 + y^2 <= 1 with z = 0; (sqrt(x^2 + y^2) - 1)^2 + z^2 <= tube^2.
typedef enum glint_form {
    GLINT_FORM_BALL,
    GLINT_FORM_BOX,
    GLINT_FORM_CYLINDER,
    GLINT_FORM_CONE,
    GLINT_FORM_DISK,
    GLINT_FORM_TUBE, ///< only the side of a cylinder or cone, which has no inside
    GLINT_FORM_FUNNEL,
    GLINT_FORM_TORUS
} glint_form;

/// The plane of a flat face. Whatever was described in one plane, along two axes of one map or by one place and normal, has
/// the same numbers here, except for the sign of the normal: all of them are hit at the same t.
typedef struct glint_face {
    double normal[3]; ///< unit
    double at[3]; ///< a place of the plane
    double places; ///< |normal| . (bound of |x| on the surface + |at|): what heights over it are made of
    uint32_t axis; ///< of the world, which the normal is along; 3: none
} glint_face;

/// The image of a unit shape under center + forward k.
typedef struct glint_solid {
    double inverse[3][3], forward[3][3]; ///< rows
    const glint_face *faces; ///< box: of low x, high x, low y, high y, low z, high z; cylinder, cone, disk and the open forms:
        ///< of low z, high z (of a disk they are one); ball, torus: none. Normals point from low to high
    double places; ///< sphere, cylinder, cone: bound of the terms of x^2 + y^2 - 1 (or similar) for points on the side;
        ///< torus: bound of the terms of the distance from the circle in the middle of its tube
    double tube; ///< torus: radius of its tube where that circle's is 1, above 0 and below 1
    float lower[3], upper[3]; ///< a box around it, in the index's frame and rounded outwards; of a part: not known
    float axis[3], thick; ///< cylinder, cone and open forms that are longer than wide: the line through the centre along this, which is
                          ///< unit but for rounding, is nowhere further off than `thick`, in the index's units; else that is infinite
    uint32_t form;
} glint_solid;

#define GLINT_PARTS_MAX 64 ///< of a combined solid
#define GLINT_HULL_PARTS 4 ///< of these a closed mesh is as many: the stretches of a ray within it that are held at a time

/// Operations in the program of a combined solid, besides numbers of parts.
enum {
    GLINT_COMBINE_UNION = GLINT_PARTS_MAX, ///< of the two sets before it, like the next two
    GLINT_COMBINE_INTERSECTION,
    GLINT_COMBINE_DIFFERENCE, ///< the second is taken away from the first
    GLINT_COMBINE_NOTHING ///< an empty set
};

/// Solids and planes, the half-space that a plane's normal leaves, made one by a program in postfix. No ray meets its parts but by
/// way of it; hits are theirs: they have numbers in prims, which are beyond those of what rays meet.
typedef struct glint_combined {
    uint32_t first; ///< prims[prim_count + first] is part 0
    uint32_t count; ///< of parts
    uint32_t length; ///< of the program
    float lower[3], upper[3]; ///< a box around it, as of a solid
    // sets of parts, a bit each:
    uint64_t all; ///< every part, where the program has no empty set; else 0
    uint64_t needs; ///< those without any of which the whole is nothing
    uint64_t alone; ///< those that are the whole where all others are nothing
    uint8_t program[2 * GLINT_PARTS_MAX];
} glint_combined;

/// A closed mesh that is a part of a combined solid. Its triangles are prims[prim_count + first] and on, in the order of definition; they
/// run counter-clockwise as seen from outside of the whole. Hits are theirs.
typedef struct glint_hull {
    uint32_t first, count;
    const glint_node *nodes; ///< a tree over them, in the index's frame; a slot's GLINT_NODE_PRIM child is a triangle's number from 0
} glint_hull;

/// How many pairs of faces there are.
static inline int glint_slab_count(uint32_t form)
{
    return form == GLINT_FORM_BALL || form == GLINT_FORM_TORUS ? 0 : form == GLINT_FORM_BOX ? 3 : 1;
}

/// The axis that a vector lies along; 3: none.
static inline int glint_axis_along(const double v[3])
{
    const int x = v[0] != 0, y = v[1] != 0, z = v[2] != 0;
    return x + y + z != 1 ? 3 : x ? 0 : y ? 1 : 2;
}

/// Relative to the terms of a height: the bound of its rounding error. Points nearer to a face are on it.
#define GLINT_ON_FACE_DOUBLE 0x1p-50
#define GLINT_ON_FACE_FLOAT 0x1p-21

/// The height of a place over a face; 0 on it as far as rounding lets us know.
static inline double glint_face_height(const glint_face *face, const double place[3])
{
    double q[3];
    for (int c = 0; c < 3; c++)
        q[c] = place[c] - face->at[c];
    if (face->axis < 3)
        return face->normal[face->axis] * q[face->axis];
    const double h = (face->normal[0] * q[0] + face->normal[1] * q[1]) + face->normal[2] * q[2];
    const double on = GLINT_ON_FACE_DOUBLE * face->places;
    return h <= on && -on <= h ? 0 : h;
}

/// Whether a place is inside, not on, the solid around `center`; no place is inside a disk, tube or funnel.
static inline bool glint_solid_holds(const glint_solid *solid, const double center[3], const double place[3])
{
    double k[3];
    for (int i = 0; i < glint_slab_count(solid->form); i++)
        if (!(glint_face_height(&solid->faces[2 * i], place) > 0 && glint_face_height(&solid->faces[2 * i + 1], place) < 0))
            return false;
    if (solid->form == GLINT_FORM_BOX)
        return true;
    for (int c = 0; c < 3; c++) {
        const double *row = solid->inverse[c];
        k[c] = (row[0] * (place[0] - center[0]) + row[1] * (place[1] - center[1])) + row[2] * (place[2] - center[2]);
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

/// The surfaces that rays hit (the first of bit-equal ones), and the index over the bounded ones. Its frame is (x - reference) * scale.
typedef struct glint_geometry_table {
    const glint_prim *prims; ///< triangles first, and those and the others in the order of the index, so that neighbours in space are
        ///< neighbours in memory; after them the parts of combined solids and the triangles of those that are meshes, which are not counted
    uint32_t prim_count, triangles; ///< triangles: of prims[0 .. triangles)
    const double (*corners)[3][3]; ///< of these
    const glint_node *nodes; ///< nodes[0] is the root; NULL: nothing has an end
    const uint32_t *unbounded; ///< the primitives that are not in the tree: planes
    uint32_t unbounded_count;
    double reference[3], scale; ///< scale is a power of two
    double extent; ///< bound of every coordinate and radius, world units
    bool tori; ///< there are some
    const glint_corner_normals *corner_normals;
    const glint_solid *solids; ///< NULL: there are none, nor combined ones
    const glint_combined *combined;
    const glint_hull *hulls; ///< NULL: there are none
    const glint_face *faces; ///< of triangles
    const glint_shading_points *shading_points;
    uint32_t shading_point_count; ///< 0: all light is computed for each sample
} glint_geometry_table;

/// The input of a material's specular term from the stages before shade.
typedef enum glint_highlight {
    GLINT_HIGHLIGHT_NONE,
    GLINT_HIGHLIGHT_PHONG,
    GLINT_HIGHLIGHT_BLINN,
    GLINT_HIGHLIGHT_FACETS ///< of microfacets: the stages `view` and `facet`
} glint_highlight;

/// The kind of highlight that shade computes from it.
typedef enum glint_lobe {
    GLINT_LOBE_POWER,
    GLINT_LOBE_POWER_COSINE, ///< times n.l
    GLINT_LOBE_GGX,
    GLINT_LOBE_BECKMANN
} glint_lobe;

/// The fields of a material that differ between samples, one bit each: they are read from planes, see glint_shade_planes.
enum {
    GLINT_PLANE_DIFFUSE = 1,
    GLINT_PLANE_AMBIENT = 2,
    GLINT_PLANE_AMBIENT_IS_DIFFUSE = 4, ///< the plane of the diffuse reflectance is the ambient one's, too
    GLINT_PLANE_SPECULAR = 8,
    GLINT_PLANE_SHININESS = 16,
    GLINT_PLANE_ALPHA = 32,
    GLINT_PLANE_SHADED = 64 ///< what all lights make of it together is in planes, or in the sums already
};

typedef struct glint_shade_material {
    double diffuse[3], specular[3]; ///< for fields in planes: the factor of the plane
    double ambient[3]; ///< ka * Ia
    float shininess;
    float least; ///< of (r.v)^2 or (n.h)^2: below it the highlight is 0 for certain; 0: wherever that is not known
    uint32_t highlight; ///< glint_highlight: what its specular term is of
    uint32_t lobe; ///< glint_lobe
    float alpha; ///< width of the distribution of microfacets, 1e-18 .. 1
    double grazing[3]; ///< of microfacets: `specular` is ks f0, this is ks (1 - f0); with a plane of ks, without the ks
    uint32_t planes; ///< GLINT_PLANE_...; 0: all is here
} glint_shade_material;

#endif
