/// Puts primitives into the order of the BVH, in place, because memory may not suffice for a copy of all of them.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/render/geometry/geometry.h"

#include <stdlib.h>
#include <string.h>

#define STRIDE 1024 ///< distance between the positions where walks begin
#define RUN 64 ///< walks that a worker takes at a time
#define WALKS 8 ///< walks that it advances in turn, because each waits for memory
#define CHUNK 4096 ///< primitives whose corners a worker moves at a time
#define AHEAD 8 ///< primitives whose corners are prefetched

/// The new order of the primitives: first those in the BVH, then unbounded ones, then repeats.
typedef struct arrangement {
    const glint_geometry *geometry;
    glint_prim *prims;
    uint32_t count;
    uint32_t *rest; ///< old positions of the primitives that come after the last one in the BVH
    uint8_t *done; ///< whether each position has its final primitive
    glint_prim *first; ///< copies of the primitives that were at the positions where walks begin
    double (*corners)[3][3]; ///< memory for all corners in their new order; NULL: there are none
    uint32_t *chunks; ///< scratch: one number for each chunk of primitives or of parts of combined solids
} arrangement;

static inline uint32_t source_of(const arrangement *a, uint32_t position)
{
    const glint_index *index = a->geometry->index;
    return position < index->box_count ? index->order[position] : a->rest[position - index->box_count];
}

static void arrangement_free(arrangement *a)
{
    free(a->rest);
    free(a->done);
    free(a->first);
    free(a->corners);
    free(a->chunks);
}

static bool allocate_corners(arrangement *a)
{
    const uint32_t members = a->geometry->member_count, most = a->count > members ? a->count : members;
    if (!a->geometry->corners)
        return true;
    a->corners = glint_alloc_large(a->geometry->corner_count, sizeof *a->corners);
    a->chunks = glint_alloc(most / CHUNK + 1, sizeof *a->chunks);
    return a->corners && a->chunks;
}

static bool arrangement_init(arrangement *a, const glint_geometry *geometry)
{
    const uint32_t count = geometry->table.prim_count, bounded = geometry->index->box_count;
    uint32_t at = geometry->table.unbounded_count;
    *a = (arrangement) { .geometry = geometry, .prims = geometry->prims, .count = count };
    a->rest = malloc((count - bounded + 1) * sizeof *a->rest);
    a->done = calloc((size_t)count + 1, sizeof *a->done);
    a->first = glint_alloc_large(count / STRIDE + 1, sizeof *a->first);
    if (!a->rest || !a->done || !a->first || !allocate_corners(a))
        return false;
    memcpy(a->rest, geometry->unbounded, at * sizeof *a->rest);
    for (uint32_t i = 0; i < count; i += STRIDE)
        a->first[i / STRIDE] = geometry->prims[i];
    for (uint32_t i = 0; i < count && at < count - bounded; i++) // until all repeats are found
        if (geometry->prims[i].filter_bound == GLINT_REPEATED)
            a->rest[at++] = i;
    return true;
}

/// Follows the permutation's cycle from each start position of a run to the next start position of any walk.
static void walk_cycles(void *context, size_t index, int worker)
{
    (void)worker;
    arrangement *a = context;
    const size_t walks = (a->count + STRIDE - 1) / STRIDE, last = (index + 1) * RUN, end = last < walks ? last : walks;
    size_t next = index * RUN;
    uint32_t at[WALKS], live = 0;
    while (live < WALKS && next < end)
        at[live++] = (uint32_t)next++ * STRIDE;
    while (live)
        for (uint32_t k = 0; k < live;) {
            const uint32_t to = at[k], from = source_of(a, to);
            a->done[to] = 1;
            if (from % STRIDE) {
                a->prims[to] = a->prims[from];
                at[k++] = from;
                continue;
            }
            a->prims[to] = a->first[from / STRIDE];
            if (next < end)
                at[k++] = (uint32_t)next++ * STRIDE;
            else
                at[k] = at[--live];
        }
}

/// Moves the cycles that no walk has reached.
static void move_rest(arrangement *a)
{
    for (uint32_t i = 0; i < a->count; i++) {
        if (a->done[i] || source_of(a, i) == i)
            continue;
        const glint_prim first = a->prims[i];
        uint32_t to = i;
        for (uint32_t from; (from = source_of(a, to)) != i; to = from) {
            a->prims[to] = a->prims[from];
            a->done[to] = 1;
        }
        a->prims[to] = first;
        a->done[to] = 1;
    }
}

static void move_prims(arrangement *a, glint_pool *pool)
{
    glint_run_items(pool, (a->count + (size_t)STRIDE * RUN - 1) / ((size_t)STRIDE * RUN), walk_cycles, a);
    move_rest(a);
}

// ---- Corners ----

typedef struct corner_work {
    glint_prim *prims;
    uint32_t count;
    uint32_t *first; ///< first corner of each chunk; before that is known, the number of its corners
    double (*to)[3][3];
} corner_work;

static uint32_t chunk_end(const corner_work *work, size_t chunk)
{
    const size_t end = (chunk + 1) * CHUNK;
    return (uint32_t)(end < work->count ? end : work->count);
}

static void count_corners(void *context, size_t index, int worker)
{
    (void)worker;
    corner_work *work = context;
    uint32_t count = 0;
    for (uint32_t i = (uint32_t)index * CHUNK; i < chunk_end(work, index); i++)
        count += glint_prim_has_corners(&work->prims[i]);
    work->first[index] = count;
}

static void move_chunk(void *context, size_t index, int worker)
{
    (void)worker;
    const corner_work *work = context;
    const uint32_t end = chunk_end(work, index);
    double(*to)[3][3] = work->to + work->first[index];
    for (uint32_t i = (uint32_t)index * CHUNK; i < end; i++) {
        if (i + AHEAD < end && glint_prim_has_corners(&work->prims[i + AHEAD]))
            glint_prefetch(work->prims[i + AHEAD].corner, sizeof *to);
        if (!glint_prim_has_corners(&work->prims[i]))
            continue;
        memcpy(to, work->prims[i].corner, sizeof *to);
        work->prims[i].corner = *to++;
    }
}

/// Moves the corners of the primitives and returns the number of corners. first: space for one number per chunk.
static uint32_t move_corners_of(glint_prim *prims, uint32_t count, double (*to)[3][3], uint32_t *first, glint_pool *pool)
{
    corner_work work = { prims, count, first, to };
    const size_t chunks = ((size_t)count + CHUNK - 1) / CHUNK;
    uint32_t next = 0;
    glint_run_items(pool, chunks, count_corners, &work);
    for (size_t i = 0; i < chunks; i++) {
        const uint32_t corners = first[i];
        first[i] = next;
        next += corners;
    }
    glint_run_items(pool, chunks, move_chunk, &work);
    return next;
}

/// Moves the corners to the order of the primitives, so that neighbours in space are neighbours in memory.
static void move_corners(glint_geometry *geometry, arrangement *a, glint_pool *pool)
{
    const uint32_t moved = move_corners_of(a->prims, a->count, a->corners, a->chunks, pool);
    move_corners_of(geometry->members, geometry->member_count, a->corners + moved, a->chunks, pool);
    free(geometry->corners);
    geometry->corners = a->corners;
    geometry->table.corners = (const double(*)[3][3])a->corners;
    a->corners = NULL;
}

// ---- All ----

glint_status glint_geometry_move(glint_geometry *geometry, glint_pool *pool, glint_error *error)
{
    const uint32_t bounded = geometry->index->box_count;
    arrangement a;
    bool allocated = arrangement_init(&a, geometry);
    if (geometry->shading_points && !geometry->index_of_id)
        allocated =
            (geometry->index_of_id = glint_alloc(geometry->id_count, sizeof *geometry->index_of_id)) && allocated;
    if (allocated) {
        move_prims(&a, pool);
        if (geometry->corners)
            move_corners(geometry, &a, pool);
        for (uint32_t i = 0; geometry->index_of_id && i < bounded; i++)
            geometry->index_of_id[geometry->prims[i].id] = i;
        for (uint32_t i = 0; i < geometry->table.unbounded_count; i++)
            geometry->unbounded[i] = bounded + i;
        geometry->table.prim_count = bounded + geometry->table.unbounded_count;
        if (geometry->member_count)
            memcpy(geometry->prims + geometry->table.prim_count, geometry->members,
                   geometry->member_count * sizeof *geometry->members);
        geometry->arranged = true;
    }
    arrangement_free(&a);
    return allocated ? GLINT_OK : glint_fail_nomem(error);
}
