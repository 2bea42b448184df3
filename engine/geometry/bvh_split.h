/// Splits a set of boxes in two, for bvh.c. Internal to it.
#ifndef GLINT_BVH_SPLIT_H
#define GLINT_BVH_SPLIT_H

#include "engine/base/pool.h"
#include "engine/geometry/bvh.h"

typedef float glint_float4 __attribute__((vector_size(16), may_alias)); // the four lanes of half a box

typedef struct glint_bounds {
    glint_float4 lower, upper; ///< the fourth lane is not a coordinate
} glint_bounds;

/// A box before it is in the tree. lower[3] holds the bits of its item.
typedef glint_bounds glint_record;

/// Consecutive records.
typedef struct glint_record_set {
    glint_bounds box; ///< of the boxes
    glint_bounds center; ///< bounds of their centres, which are halved so that no difference overflows
    uint32_t begin, count;
    uint32_t splits; ///< splits by position on the path from the root
} glint_record_set;

/// A split exchanges records that are in the wrong part: the first one of the lower part with the first one of the
/// upper part, and so on, so that their order does not depend on the number of workers.
typedef struct glint_records {
    glint_record *all; ///< owned
    /// owned; scratch of splits, of the same length: the records of a piece that are in the wrong part
    uint32_t *wrong;
    uint32_t count;
    struct glint_chunk *chunks; ///< owned; scratch of splits by several workers
    glint_pool *pool; ///< borrowed, may be NULL
} glint_records;

/// Uses boxes[0 .. count), count > 0, as the records; `root` becomes the set of all. False: out of memory.
/// glint_records_free frees everything, also after a failure.
bool glint_records_init(glint_records *records, glint_box *boxes, uint32_t count, glint_pool *pool,
                        glint_record_set *root);
void glint_records_free(glint_records *records);
/// Returns the memory of records that are already in nodes to the system.
void glint_records_drop(const glint_records *records, const glint_record_set *set);

/// Splits by position, where the surface area heuristic is lowest, or by number if all positions are equal; `set`
/// becomes the lower part and `above` the upper one. set->count must be above GLINT_NODE_WIDTH. `shared`: the pool's
/// workers do it, which pays for large sets; the result is the same.
void glint_records_split(const glint_records *records, glint_record_set *set, glint_record_set *above, bool shared);
/// Splits into halves by number: 16^k records into sets of exactly 16^k / 2.
void glint_records_halve(const glint_records *records, glint_record_set *set, glint_record_set *above);

static inline const glint_record *glint_records_of(const glint_records *records, const glint_record_set *set)
{
    return records->all + set->begin;
}

#endif
