/// Everything rays meet, in one table: made from a scene's shapes, kept with the scene until a shape changes, shared by
/// the plans made meanwhile. Internal.
#ifndef GLINT_GEOMETRY_H
#define GLINT_GEOMETRY_H

#include "engine/base/hash.h"
#include "engine/bvh.h"
#include "engine/objects.h"

#include <pthread.h>
#include <stdatomic.h>

/// The index, which outlives a change of materials.
typedef struct glint_index {
    atomic_size_t references;
    pthread_mutex_t lock; ///< over the building
    bool built;
    glint_box *boxes; ///< of the bounded primitives, until the index is built
    uint32_t *bounded; ///< the primitive of each box, likewise
    uint32_t box_count;
    uint32_t *order; ///< the primitive in each place of the tree's order, once built
    glint_bvh bvh;
} glint_index;

struct glint_geometry {
    atomic_size_t references;
    glint_key revision; ///< of the shapes it was made from
    glint_prim *prims; ///< in order of definition, and in that of the index once it is built
    bool arranged; ///< the latter
    uint32_t *prim_shape; ///< which shape of the scene each is of
    uint32_t *unbounded;
    glint_list materials; ///< in order of first use; the scene's shapes own them
    glint_index *index;
    glint_geometry_table table; ///< for the kernels; without `nodes` until the index is built
    glint_key where, look; ///< of the places; of materials and sides
};

/// The scene's geometry, from the last plan where no shape has changed since. The caller owns a reference.
glint_status glint_geometry_of(const glint_scene *scene, glint_geometry **out, glint_error *error);
glint_geometry *glint_geometry_retain(glint_geometry *geometry);
void glint_geometry_release(glint_geometry *geometry);

/// Builds the index unless it is there. Any thread; `pool` may be NULL. *table: with the index.
glint_status glint_geometry_index(glint_geometry *geometry, glint_pool *pool, glint_geometry_table *table,
                                  glint_error *error);

#endif
