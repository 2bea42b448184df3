/// All primitives that rays can hit, in one table: made from a scene's shapes, cached in the scene until a shape
/// changes, and shared by all plans made until then. Internal.
#ifndef GLINT_GEOMETRY_H
#define GLINT_GEOMETRY_H

#include "engine/base/hash.h"
#include "engine/render/geometry/bvh.h"
#include "engine/render/scene/objects.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>

/// The BVH, which is retained when only materials change.
typedef struct glint_index {
    atomic_size_t references;
    pthread_mutex_t lock; ///< protects the building of the tree
    bool built;
    uint32_t box_count; ///< number of primitives with a box in the tree
    uint32_t *order; ///< index of the primitive at each position of the tree's order; set when the primitives are
        ///< arranged
    bool plain; ///< whether `order` is the order of definition, because the tree was not built yet
    atomic_uint frames_without; ///< number of frames that were scanned without a tree
    glint_bvh bvh;
} glint_index;

/// A shape's run of primitives; one for each instance of the shape.
typedef struct glint_part {
    glint_shape *shape; ///< owned by the scene
    /// The shape whose materials it uses: itself, except for parts of combined solids without a material
    const glint_shape *dress;
    glint_shape *whole; ///< for a part of a combined solid: the scene's object that contains the part; otherwise NULL
    uint32_t first_prim, first_object; ///< ids of its first primitive and of its first object, from 0
    const glint_transform *map; ///< map of the shape under all its groups, owned by the geometry; NULL: the identity
} glint_part;

struct glint_geometry {
    atomic_size_t references;
    glint_key revision; ///< revision key of the shapes from which the geometry was made
    glint_prim *prims; ///< in order of definition, or in the order of the BVH once it is built
    bool arranged; ///< whether `prims` is in the order of the BVH
    double (*corners)[3][3]; ///< corners of triangles, and of the boxes of combined solids; in the order of the
        ///< primitives
    uint32_t corner_count; ///< number of corners
    double (*planes)[4]; ///< the fields of planes, except the position
    uint32_t *prim_part; ///< index of the part of each primitive, by the primitive's id
    glint_part *parts; ///< in order of definition; parts of combined solids come last
    glint_transform *maps; ///< maps of the parts that have one
    uint32_t part_count, whole_count; ///< number of parts; whole_count: number of parts that are not in a combined
        ///< solid
    glint_corner_normals *normals; ///< normals of the corners of triangles that are shaded smoothly
    glint_shading_points *shading_points; ///< shading points of triangles whose light is computed per face or vertex
    uint32_t *shading_point_prims; ///< id of the first triangle of each shading point
    uint32_t *index_of_id; ///< position in `prims` of the primitive with each id, once arranged; NULL: there are no
        ///< shading points
    glint_solid *solids;
    glint_combined *combined;
    glint_hull *hulls; ///< meshes of combined solids; their `first` counts from the first of `members`
    struct glint_hull_tree **hull_trees; ///< one tree for each of `hulls`
    uint32_t hull_count;
    glint_prim *members; ///< the parts of combined solids, in order of definition, and the triangles of their meshes.
        ///< After arranging, `prims` contains them, too
    uint32_t member_count;
    glint_face *faces; ///< faces of solids and triangles
    uint32_t *unbounded;
    glint_list materials; ///< materials in order of first use; the scene's shapes own them
    glint_index *index;
    glint_bvh others; ///< BVH of the primitives that are neither triangles nor planes, built on first use
    bool has_others; ///< `others` is built
    double thinnest; ///< smallest size of a curved primitive, world units; infinite: there are none
    uint32_t id_count; ///< number of primitives described, including parts of combined solids and repeats
    glint_geometry_table table; ///< the table that kernels read; without `nodes` until the index is built
    glint_key where, look; ///< hash of the primitives' positions; hash of their materials and sides
};

/// Returns the scene's geometry, from the last plan if no shape has changed since. The caller owns a reference.
glint_status glint_geometry_of(const glint_scene *scene, glint_geometry **out, glint_error *error);
glint_geometry *glint_geometry_retain(glint_geometry *geometry);

/// A value of `filter_bound`: no ray hits the primitive, because an earlier one is bit-equal.
#define GLINT_REPEATED (-1.0F)

/// Builds the BVH unless it is built. Any thread; `pool` may be NULL. *table: includes the BVH.
glint_status glint_geometry_index(glint_geometry *geometry, glint_pool *pool, glint_geometry_table *table,
                                  glint_error *error);
/// Does the same as glint_geometry_index for callers that do not traverse the BVH: the BVH is not built, and *table
/// includes it only if it exists. The first call of these two functions fixes the order of the primitives.
glint_status glint_geometry_arrange(glint_geometry *geometry, glint_geometry_table *table, glint_error *error);
/// Makes *table from an arranged geometry, but without its triangles and with a BVH of the other primitives. *any:
/// whether there are other primitives.
glint_status glint_geometry_others(glint_geometry *geometry, glint_pool *pool, glint_geometry_table *table, bool *any,
                                   glint_error *error);

/// geometry/light_grid.c: makes the grid of a light without samples over an arranged table with its BVH. position:
/// for a directional light, the unit vector towards the light. max_bytes: the most bytes that the grid may take. *out
/// is NULL if there is no grid: it would take more bytes, or too few primitives are small spheres on one side of the
/// light that do not contain the light.
glint_status glint_light_grid_create(const glint_geometry_table *table, bool directional, const double position[3],
                                     size_t max_bytes, glint_light_grid **out, glint_error *error);
void glint_light_grid_destroy(glint_light_grid *grid);

/// Returns the index of a primitive's object in order of definition, from 0. A whole mesh is one object; each sphere
/// of a shape with many spheres is an object.
uint32_t glint_geometry_object(const glint_geometry *geometry, uint32_t id);

/// geometry/fill.c: makes the primitives of the scene's shapes, in order of definition, with their materials and parts.
glint_status glint_geometry_fill(glint_geometry *geometry, const glint_scene *scene, glint_error *error);
/// geometry/sizes.c: refuses shapes that are too small or too large for the squares that the kernels compute. Fills
/// `thinnest`.
glint_status glint_geometry_check_sizes(glint_geometry *geometry, glint_error *error);
/// Refuses shapes that are too small for rays from a point to hit them. who: the name of the point, for the message.
glint_status glint_geometry_check_reach(const glint_geometry *geometry, const char *who, const double from[3],
                                        glint_error *error);
/// Writes all numbers that define a primitive's position, and returns their number.
enum { GLINT_PRIM_RECORD_MAX = 50 };
int glint_prim_record(const glint_geometry *geometry, const glint_prim *prim, double out[GLINT_PRIM_RECORD_MAX]);
/// Computes a box around a bounded primitive.
void glint_prim_bounds(const glint_solid *solids, const glint_prim *prim, double lower[3], double upper[3]);

static inline bool glint_prim_bounded(const glint_prim *prim)
{
    return prim->kind == GLINT_PRIM_COMBINED ? prim->corner[1][0] > -HUGE_VAL : prim->kind != GLINT_PRIM_PLANE;
}

/// Returns whether the BVH contains the primitive.
static inline bool glint_prim_in_tree(const glint_prim *prim)
{
    return prim->filter_bound != GLINT_REPEATED && glint_prim_bounded(prim);
}

/// geometry/boxes.c: sets the bounding sphere of a primitive for the filter. The bounding sphere of a sphere is the
/// sphere itself. For other primitives it surrounds the box; for a solid it may be smaller.
void glint_prim_place_sphere(const glint_geometry_table *table, glint_prim *prim);
/// Computes the filter's data about the axis of a solid whose bounding sphere was set by glint_prim_place_sphere.
void glint_prim_place_axis(const glint_geometry_table *table, const glint_prim *prim, glint_solid *solid);
/// Computes the primitive's box in the BVH's frame, rounded outwards.
void glint_prim_place_box(const glint_geometry_table *table, const glint_prim *prim, uint32_t item, glint_box *box);
/// Computes the `count` boxes of the primitives in the tree, in the order of `prims`, which other threads may read.
/// solids: leaves out the triangles. NULL: out of memory.
glint_box *glint_geometry_boxes(const glint_geometry *geometry, uint32_t count, bool solids, glint_pool *pool);
/// geometry/arrange.c: puts the primitives into the order of the BVH, unbounded ones last, and removes repeats.
glint_status glint_geometry_move(glint_geometry *geometry, glint_pool *pool, glint_error *error);

/// geometry/hulls.c: makes the trees of closed meshes that are parts, or reuses equal trees of `last` (NULL: none).
glint_status glint_geometry_hull_trees(glint_geometry *geometry, const glint_geometry *last, glint_error *error);
void glint_geometry_release_hulls(glint_geometry *geometry);
/// Returns how a ray crosses a triangle: 1: outwards, -1: inwards, 0: the ray misses the triangle, or the triangle is
/// behind the ray's origin. For a closed mesh, the sum over all triangles is the number of times that the mesh
/// encloses the ray's origin.
int glint_prim_crossing(const glint_prim *triangle, const double from[3], const double d[3]);

static inline bool glint_prim_has_corners(const glint_prim *prim)
{
    return prim->kind == GLINT_PRIM_TRIANGLE || prim->kind == GLINT_PRIM_COMBINED || prim->kind == GLINT_PRIM_HULL;
}

/// geometry/combined.c: computes the box of a combined solid whose program and members are set: the centre, the lower
/// and the upper corner; -inf and inf where it is unbounded.
void glint_combined_box(const glint_geometry *geometry, const glint_combined *combined, double box[3][3]);
/// Computes the sets of parts that follow from the program of a combined solid: all, needs, alone.
void glint_combined_roles(glint_combined *combined);
/// Returns whether a point is inside the combined solid.
bool glint_combined_holds(const glint_geometry *geometry, const glint_combined *combined, const double point[3]);

#endif
