/// The BVH: a tree of boxes, 16 per node, over all bounded primitives. Internal.
///
/// Boxes are float and conservative: the caller rounds outwards, and the tree never shrinks a box. The kernels
/// traverse it (stages/walk.h); a ray cannot hit a primitive that they do not reach.
#ifndef GLINT_BVH_H
#define GLINT_BVH_H

#include "engine/base/pool.h"
#include "engine/render/stages/stages.h"

typedef struct glint_box {
    _Alignas(16) float lower[3]; ///< lower <= upper, finite
    uint32_t item; ///< the number that a leaf slot stores, below 2^31
    float upper[3];
    float unused;
} glint_box;

typedef struct glint_bvh {
    glint_node *nodes; ///< 64-byte aligned, owned; nodes[0] is the root. NULL: no boxes
    uint32_t node_count;
} glint_bvh;

/// Allocates memory for boxes; NULL: out of memory.
glint_box *glint_boxes_alloc(uint32_t count);
void glint_boxes_free(glint_box *boxes, uint32_t count);

/// Builds the tree over boxes[0 .. count); leaf slots hold the box's item. Binned SAH, collapsed to 16 wide. The tree
/// depends only on the boxes and their order, not on the threads. No path is longer than GLINT_BVH_DEPTH nodes,
/// whatever the boxes: for example, a million boxes at one position are split into halves by number. A node fills its
/// slots from the first on, in the order of the children's centres along the node's widest axis. An empty slot has
/// child 0.
///
/// boxes  from glint_boxes_alloc(count), finite, also degenerate; count below 2^31. They are sorted in place and
///        always freed here, before the parts are copied to the finished tree.
/// pool   its workers build subtrees; NULL: the calling thread builds all.
glint_status glint_bvh_build(glint_box *boxes, uint32_t count, glint_pool *pool, glint_bvh *out,
                             glint_error *error);
void glint_bvh_free(glint_bvh *bvh);

#endif
