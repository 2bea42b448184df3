/// The spatial index: a tree of boxes, 16 to a node, over everything that has an end. Internal.
///
/// Boxes are float and conservative: whoever makes them rounds outwards, and the tree takes nothing away. The kernels
/// walk it (stages/walk.h); what they do not reach, no ray of theirs can hit.
#ifndef GLINT_BVH_H
#define GLINT_BVH_H

#include "engine/base/pool.h"
#include "engine/stages/stages.h"

typedef struct glint_box {
    float lower[3], upper[3]; ///< lower <= upper, finite
} glint_box;

typedef struct glint_bvh {
    glint_node *nodes; ///< 64-byte aligned, owned; nodes[0] is the root. NULL: no boxes
    uint32_t node_count;
} glint_bvh;

/// Builds the tree over boxes[0 .. count); leaf slots hold the index of the box. Binned SAH, collapsed 16 wide. The
/// tree is a function of the boxes alone, not of the threads. No path is longer than GLINT_BVH_DEPTH nodes, whatever the
/// boxes: a million at one place are halved by number. A node fills its slots from the first on, in the order of their
/// centres along its widest axis; the child of an empty one is 0.
///
/// boxes  any finite boxes, degenerate ones too; count below 2^31.
/// pool   subtrees are built on its workers; NULL: on the calling thread.
glint_status glint_bvh_build(const glint_box *boxes, uint32_t count, glint_pool *pool, glint_bvh *out,
                             glint_error *error);
void glint_bvh_free(glint_bvh *bvh);

#endif
