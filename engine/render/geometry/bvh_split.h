/// Splits a set of boxes in two, for bvh.c. Internal to it.
#ifndef GLINT_BVH_SPLIT_H
#define GLINT_BVH_SPLIT_H

#include "engine/base/pool.h"
#include "engine/render/geometry/bvh.h"

typedef float glint_float4 __attribute__((vector_size(16), may_alias)); // lower or upper corner of a box, in four lanes

typedef struct glint_bounds {
    glint_float4 lower, upper; ///< corners of the box; the fourth lane is not a coordinate
} glint_bounds;

/// A box before it is in the tree. lower[3] holds the bits of its item.
typedef glint_bounds glint_record;

/// Consecutive records.
typedef struct glint_record_set {
    glint_bounds box; ///< bounds of the boxes
    glint_bounds center; ///< bounds of the boxes' centres; centres are halved so that no difference overflows
    uint32_t begin, count;
    uint32_t splits; ///< number of splits by position on the path from the root to this set
} glint_record_set;

/// The records of a tree that is being built. A split exchanges the first record of the lower part that belongs to
/// the upper part with the first record of the upper part that belongs to the lower part, and so on, so that their
/// order does not depend on the number of workers.
typedef struct glint_records {
    glint_record *all; ///< owned
    /// owned; scratch of splits, as long as `all`: indices of the records of a piece that are in the wrong part
    uint32_t *wrong;
    uint32_t count;
    struct glint_chunk *chunks; ///< owned; scratch of splits by several workers
    glint_pool *pool; ///< borrowed workers; may be NULL
} glint_records;

/// Uses boxes[0 .. count), count > 0, as the records; `root` becomes the set of all records. False: out of memory.
/// glint_records_free frees everything, also after a failure.
bool glint_records_init(glint_records *records, glint_box *boxes, uint32_t count, glint_pool *pool,
                        glint_record_set *root);
void glint_records_free(glint_records *records);
/// Returns the memory of records that are already in nodes to the system.
void glint_records_drop(const glint_records *records, const glint_record_set *set);

/// Splits by position, where the surface area heuristic is lowest, or by number if all positions are equal; `set`
/// becomes the lower part and `above` the upper one. set->count must be above GLINT_NODE_WIDTH. shared: the pool's
/// workers share the split, which pays for large sets; the result is the same.
void glint_records_split(const glint_records *records, glint_record_set *set, glint_record_set *above, bool shared);
/// Splits a set into halves by number. If it has 16^k records, each half has exactly 16^k / 2.
void glint_records_halve(const glint_records *records, glint_record_set *set, glint_record_set *above);

static inline const glint_record *glint_records_of(const glint_records *records, const glint_record_set *set)
{
    return records->all + set->begin;
}

#endif
