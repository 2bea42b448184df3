/// Everything rays meet, in one table: made from a scene's shapes, kept with the scene until a shape changes, shared by
/// the plans made meanwhile. Internal.
#ifndef GLINT_GEOMETRY_H
#define GLINT_GEOMETRY_H

#include "engine/base/hash.h"
#include "engine/geometry/bvh.h"
#include "engine/scene/objects.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>

/// The index, which outlives a change of materials.
typedef struct glint_index {
    atomic_size_t references;
    pthread_mutex_t lock; ///< over the building
    bool built;
    uint32_t box_count; ///< of the primitives that have a box in it
    uint32_t *order; ///< the primitive in each place, once arranged: the tree's order
    bool plain; ///< that of definition: the tree was not there yet
    atomic_uint frames_without; ///< that were scanned while there was no tree
    glint_bvh bvh;
} glint_index;

/// A shape's run of primitives; as many as there are groups that show it.
typedef struct glint_part {
    glint_shape *shape; ///< the scene's
    const glint_shape *dress; ///< the shape whose materials it has: itself, but of parts of combined solids that have none
    glint_shape *whole; ///< of such a part: the combined solid that is an object of the scene; NULL: it is one itself
    uint32_t first_prim, first_object; ///< ids of its first primitive and of its first object, from 0
    const glint_transform *map; ///< of it and of its groups, one of the geometry's; NULL: the identity
} glint_part;

struct glint_geometry {
    atomic_size_t references;
    glint_key revision; ///< of the shapes it was made from
    glint_prim *prims; ///< in order of definition, and in the order of the index once it is built
    bool arranged; ///< in the order of the index
    double (*corners)[3][3]; ///< of triangles, and the boxes of combined solids; in the order of the primitives
    uint32_t corner_count; ///< of these
    double (*planes)[4]; ///< the numbers of planes, besides a place
    uint32_t *prim_part; ///< which part each is of, by id
    glint_part *parts; ///< in order of definition; parts of combined solids after all else
    glint_transform *maps; ///< of those that have one
    uint32_t part_count, whole_count; ///< whole_count: of those that are not part of a combined solid
    glint_corner_normals *normals; ///< of triangles that are shaded smoothly
    glint_shading_points *shading_points; ///< of triangles with light computed per face or vertex
    uint32_t *shading_point_prims; ///< id of the first triangle of each site
    uint32_t *places; ///< where the primitive of an id is, once arranged; NULL: there are no sites
    glint_solid *solids;
    glint_combined *combined;
    glint_hull *hulls; ///< of combined solids; `first` counts from the members on
    struct glint_hull_tree **hull_trees; ///< of each
    uint32_t hull_count;
    glint_prim *members; ///< the parts of combined solids, in order of definition, and the triangles of their meshes; prims has
                         ///< them, too, once arranged
    uint32_t member_count;
    glint_face *faces; ///< of solids and triangles
    uint32_t *unbounded;
    glint_list materials; ///< in order of first use; the scene's shapes own them
    glint_index *index;
    glint_bvh others; ///< of primitives that are neither triangles nor planes, built on first use
    bool has_others; ///< `others` is built
    double thinnest; ///< least size of curved primitives, world units; infinite: there are none
    uint32_t id_count; ///< primitives that were described, parts of combined solids and repeats included
    glint_geometry_table table; ///< for the kernels; without `nodes` until the index is built
    glint_key where, look; ///< of the places; of materials and sides
};

/// The scene's geometry, from the last plan where no shape has changed since. The caller owns a reference.
glint_status glint_geometry_of(const glint_scene *scene, glint_geometry **out, glint_error *error);
glint_geometry *glint_geometry_retain(glint_geometry *geometry);

/// In `filter_bound`: no ray meets the primitive, since one before it is bit-equal.
#define GLINT_REPEATED (-1.0F)

/// Builds the index unless it is there. Any thread; `pool` may be NULL. *table: with the index.
glint_status glint_geometry_index(glint_geometry *geometry, glint_pool *pool, glint_geometry_table *table,
                                  glint_error *error);
/// The same for callers that do not walk the index: it is not built, and *table is without it unless it is there. The order of the
/// primitives is set by the first of these two calls, and stays.
glint_status glint_geometry_arrange(glint_geometry *geometry, glint_geometry_table *table, glint_error *error);
/// Makes *table from an arranged geometry without its triangles, with an index of the rest. *any: there are other primitives.
glint_status glint_geometry_others(glint_geometry *geometry, glint_pool *pool, glint_geometry_table *table, bool *any,
                                   glint_error *error);

/// geometry/light_grid.c: makes the grid of a light without samples over an arranged table with its index. position:
/// directional: the unit vector towards the light. room: bytes that it may take. *out NULL: there is none, since too little is small
/// spheres that the light is outside of and sees to one side, or it would take more.
glint_status glint_light_grid_create(const glint_geometry_table *table, bool directional, const double position[3], size_t room,
                                     glint_light_grid **out, glint_error *error);
void glint_light_grid_destroy(glint_light_grid *grid);

/// The number of a primitive's object in order of definition, from 0: a mesh is one object, a sphere of many is one.
uint32_t glint_geometry_object(const glint_geometry *geometry, uint32_t id);

/// geometry/fill.c: makes the primitives of the scene's shapes, in order of definition, with their materials and parts.
glint_status glint_geometry_fill(glint_geometry *geometry, const glint_scene *scene, glint_error *error);
/// geometry/sizes.c: refuses shapes that are too small or too large for the squares that the kernels compute. Fills `thinnest`.
glint_status glint_geometry_check_sizes(glint_geometry *geometry, glint_error *error);
/// Refuses shapes that are too small for rays from a place to hit them. who: the place, for the message.
glint_status glint_geometry_check_reach(const glint_geometry *geometry, const char *who, const double from[3],
                                        glint_error *error);
/// All that a primitive's place is made of. Returns how many numbers.
enum { GLINT_PLACE_MAX = 50 };
int glint_prim_place(const glint_geometry *geometry, const glint_prim *prim, double out[GLINT_PLACE_MAX]);
/// A box around a primitive that has an end.
void glint_prim_bounds(const glint_solid *solids, const glint_prim *prim, double lower[3], double upper[3]);

static inline bool glint_prim_bounded(const glint_prim *prim)
{
    return prim->kind == GLINT_PRIM_COMBINED ? prim->corner[1][0] > -HUGE_VAL : prim->kind != GLINT_PRIM_PLANE;
}

/// Whether the index has it.
static inline bool glint_prim_in_tree(const glint_prim *prim)
{
    return prim->filter_bound != GLINT_REPEATED && glint_prim_bounded(prim);
}

/// geometry/boxes.c: a sphere around a primitive becomes its filter's: its own, or that of its box, or a smaller one.
void glint_prim_place_sphere(const glint_geometry_table *table, glint_prim *prim);
/// The filter's data about the axis of a solid with such a sphere.
void glint_prim_place_axis(const glint_geometry_table *table, const glint_prim *prim, glint_solid *solid);
/// Its box in the index's frame, rounded outwards.
void glint_prim_place_box(const glint_geometry_table *table, const glint_prim *prim, uint32_t item, glint_box *box);
/// Computes the `count` boxes of the primitives in the tree, in the order of `prims`, which other threads may read. solids: without
/// triangles. NULL: no memory.
glint_box *glint_geometry_boxes(const glint_geometry *geometry, uint32_t count, bool solids, glint_pool *pool);
/// geometry/arrange.c: puts the primitives into the order of the index, those without an end last; repeats are gone.
glint_status glint_geometry_move(glint_geometry *geometry, glint_pool *pool, glint_error *error);

/// geometry/hulls.c: makes the trees of closed meshes that are parts, or reuses equal trees of `last` (NULL: none).
glint_status glint_geometry_hull_trees(glint_geometry *geometry, const glint_geometry *last, glint_error *error);
void glint_geometry_release_hulls(glint_geometry *geometry);
/// Returns how a ray crosses a triangle: 1: outwards, -1: inwards, 0: it misses, or the triangle is behind. For a closed mesh the sum of
/// all is how often the place is inside.
int glint_prim_crossing(const glint_prim *triangle, const double from[3], const double d[3]);

static inline bool glint_prim_has_corners(const glint_prim *prim)
{
    return prim->kind == GLINT_PRIM_TRIANGLE || prim->kind == GLINT_PRIM_COMBINED || prim->kind == GLINT_PRIM_HULL;
}

/// geometry/combined.c: the box of a combined solid whose program and members are there: the middle, the lower and the upper corner; -inf
/// and inf where it has no end.
void glint_combined_box(const glint_geometry *geometry, const glint_combined *combined, double box[3][3]);
/// Sets of parts that its program makes known: all, needs, alone.
void glint_combined_roles(glint_combined *combined);
/// Whether a place is inside the combined solid.
bool glint_combined_holds(const glint_geometry *geometry, const glint_combined *combined, const double place[3]);

#endif
