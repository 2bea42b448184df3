/// The spatial index: a tree of boxes, 16 to a node, over everything that has an end. Internal.
///
/// Boxes are float and conservative: whoever makes them rounds outwards, and the tree takes nothing away. The kernels
/// walk it (stages/walk.h); what they do not reach, no ray of theirs can hit.
#ifndef GLINT_BVH_H
#define GLINT_BVH_H

#include "engine/base/pool.h"
#include "engine/stages/stages.h"

typedef struct glint_box {
    _Alignas(16) float lower[3]; ///< lower <= upper, finite
    uint32_t item; ///< what a leaf slot holds of it, below 2^31
    float upper[3];
    float unused;
} glint_box;

typedef struct glint_bvh {
    glint_node *nodes; ///< 64-byte aligned, owned; nodes[0] is the root. NULL: no boxes
    uint32_t node_count;
} glint_bvh;

/// Memory for boxes; NULL: there is none.
glint_box *glint_boxes_alloc(uint32_t count);
void glint_boxes_free(glint_box *boxes, uint32_t count);

/// Builds the tree over boxes[0 .. count); leaf slots hold the item of the box. Binned SAH, collapsed 16 wide. The
/// tree depends only on the boxes and their order, not on the threads. No path is longer than GLINT_BVH_DEPTH nodes, whatever the
/// boxes: a million at one place are halved by number. A node fills its slots from the first on, in the order of their
/// centres along its widest axis; the child of an empty one is 0.
///
/// boxes  of glint_boxes_alloc(count), any finite ones, degenerate too; count below 2^31. They are sorted where they are and freed here,
///        whatever the result: before the finished tree stands beside its parts.
/// pool   subtrees are built on its workers; NULL: on the calling thread.
glint_status glint_bvh_build(glint_box *boxes, uint32_t count, glint_pool *pool, glint_bvh *out,
                             glint_error *error);
void glint_bvh_free(glint_bvh *bvh);

#endif
