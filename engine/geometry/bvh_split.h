/// Splitting a set of boxes in two, for bvh.c. Internal to it.
#ifndef GLINT_BVH_SPLIT_H
#define GLINT_BVH_SPLIT_H

#include "engine/base/pool.h"
#include "engine/geometry/bvh.h"

typedef float glint_float4 __attribute__((vector_size(16), may_alias)); // the four numbers of half a box

typedef struct glint_bounds {
    glint_float4 lower, upper; ///< the fourth lane means nothing
} glint_bounds;

/// A box before it is in the tree. lower[3] holds the bits of its item.
typedef glint_bounds glint_record;

/// Records that lie side by side.
typedef struct glint_record_set {
    glint_bounds box; ///< of the boxes
    glint_bounds center; ///< of their centres, which are halved so that no difference overflows
    uint32_t begin, count;
    uint32_t splits; ///< by position, on the path from the root
} glint_record_set;

/// A split changes places of records that are in the wrong part: the first such of the lower with the first of the upper, and so on, so
/// that their order does not depend on how many workers find them.
typedef struct glint_records {
    glint_record *all; ///< owned
    uint32_t *wrong; ///< owned; scratch of splits, as long: which records of a piece are in the wrong part
    uint32_t count;
    struct glint_chunk *chunks; ///< owned; scratch of splits that the pool shares
    glint_pool *pool; ///< borrowed, may be NULL
} glint_records;

/// Takes boxes[0 .. count), count > 0, as the records; `root` becomes the set of all. False: out of memory;
/// glint_records_free frees everything that was made, also on failure.
bool glint_records_init(glint_records *records, glint_box *boxes, uint32_t count, glint_pool *pool,
                        glint_record_set *root);
void glint_records_free(glint_records *records);
/// Gives back the memory of records that are in nodes.
void glint_records_drop(const glint_records *records, const glint_record_set *set);

/// Splits by place, where the surface area heuristic finds it cheapest, or by number where places do not differ; `set`
/// becomes the lower part and `above` the other. set->count must be above GLINT_NODE_WIDTH. Either way has the same
/// result; `shared` has the pool's workers do it, which pays for large sets.
void glint_records_split(const glint_records *records, glint_record_set *set, glint_record_set *above, bool shared);
/// Splits into halves by number: 16^k records into 16^k / 2 and no more.
void glint_records_halve(const glint_records *records, glint_record_set *set, glint_record_set *above);

static inline const glint_record *glint_records_of(const glint_records *records, const glint_record_set *set)
{
    return records->all + set->begin;
}

#endif
