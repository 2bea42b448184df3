#include "engine/render/geometry/bvh_split.h"
#include "engine/base/alloc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#define BINS 16
#define CHUNK 16384 ///< records that one worker takes at a time
#define CHUNKS_MAX 64
/// Number of splits by position allowed on a path; further splits are by number. Otherwise splits that each remove
/// only a few of a million records would make the tree too deep.
#define SPLITS_MAX 64

typedef glint_float4 v4;
typedef int32_t v4i __attribute__((vector_size(16), may_alias));
typedef glint_bounds bounds;

typedef struct bins {
    bounds box[3][BINS];
    uint32_t count[3][BINS];
} bins;

/// The bins of a set's centres: bin = (center - origin) scale. On an axis where all centres are equal, scale is 0.
typedef struct grid {
    v4 origin, scale;
} grid;

typedef struct cut {
    int axis; ///< -1: none
    int bin; ///< index of the first bin of the upper part
} cut;

/// The share of one worker in a split, or in loading the boxes.
typedef struct glint_chunk {
    bins bins;
    bounds box; ///< when loading: bounds of the chunk's boxes
    bounds center; ///< when loading: bounds of the centres of these boxes
    uint32_t begin, count; ///< in the set
} chunk;

/// The share of one worker in moving records of a part together.
typedef struct piece {
    bounds center[2]; ///< bounds of the centres of the records that go to the lower part and to the upper part
    uint32_t begin, count; ///< in the set
    /// Number of records in the wrong part, in this piece and in the part's pieces before it
    uint32_t wrong, wrong_before;
} piece;

typedef struct split_work {
    glint_record *records; ///< records of the set
    uint32_t *wrong; ///< the set's part of the scratch `wrong` of glint_records
    chunk *chunks;
    piece pieces[2][CHUNKS_MAX]; ///< pieces of the lower part and of the upper part
    size_t count; ///< number of chunks, and of pieces of each part
    glint_pool *pool; ///< workers that share the split; NULL: one thread does everything
    grid grid;
    cut cut;
} split_work;

/// Returns a < b ? a : b in each lane; where a is NaN, b.
static inline v4 min4(v4 a, v4 b)
{
#if defined(__SSE2__)
    return _mm_min_ps(a, b);
#else
    const v4i less = a < b;
    return (v4)(((v4i)a & less) | ((v4i)b & ~less));
#endif
}

/// Returns a > b ? a : b in each lane; where a is NaN, b.
static inline v4 max4(v4 a, v4 b)
{
#if defined(__SSE2__)
    return _mm_max_ps(a, b);
#else
    const v4i more = a > b;
    return (v4)(((v4i)a & more) | ((v4i)b & ~more));
#endif
}

static const bounds empty = { { INFINITY, INFINITY, INFINITY, INFINITY },
                              { -INFINITY, -INFINITY, -INFINITY, -INFINITY } };

static inline void bounds_add(bounds *sum, const bounds *other)
{
    sum->lower = min4(other->lower, sum->lower);
    sum->upper = max4(other->upper, sum->upper);
}

static inline void bounds_add_point(bounds *sum, v4 point)
{
    sum->lower = min4(point, sum->lower);
    sum->upper = max4(point, sum->upper);
}

/// Returns only the box of a record, because the fourth lane of a record is an index, not a coordinate.
static inline bounds record_box(const glint_record *record)
{
    return (bounds) { (v4)((v4i)record->lower & (v4i) { -1, -1, -1, 0 }), record->upper };
}

static inline v4 box_center(bounds box) { return box.lower * 0.25f + box.upper * 0.25f; }

static grid grid_of(const glint_record_set *set)
{
    grid g = { .origin = set->center.lower };
    for (int axis = 0; axis < 3; axis++) {
        const float scale = BINS / (set->center.upper[axis] - set->center.lower[axis]);
        g.scale[axis] = isfinite(scale) ? scale : 0;
    }
    return g;
}

/// Returns the bins of a centre. Only the first three lanes are defined.
static inline v4i bins_of(grid g, v4 center)
{
    const v4 last = { BINS - 1, BINS - 1, BINS - 1, 0 };
    return __builtin_convertvector(min4((center - g.origin) * g.scale, last), v4i);
}

static inline void bins_add(bins *b, int axis, int bin, const bounds *box)
{
    bounds_add(&b->box[axis][bin], box);
    b->count[axis][bin]++;
}

static void bin_chunk(void *context, size_t index, int worker)
{
    (void)worker;
    const split_work *work = context;
    chunk *c = &work->chunks[index];
    const glint_record *records = work->records + c->begin;
    const grid g = work->grid;
    for (int axis = 0; axis < 3; axis++)
        for (int bin = 0; bin < BINS; bin++)
            c->bins.box[axis][bin] = empty;
    memset(c->bins.count, 0, sizeof c->bins.count);
    for (uint32_t i = 0; i < c->count; i++) {
        const bounds box = record_box(&records[i]);
        const v4i bin = bins_of(g, box_center(box));
        bins_add(&c->bins, 0, bin[0], &box);
        bins_add(&c->bins, 1, bin[1], &box);
        bins_add(&c->bins, 2, bin[2], &box);
    }
}

/// Returns half the area of a box, in units of the set, plus a small fraction of its sides, so that boxes without
/// area can be compared, too.
static inline float half_area(bounds box, float scale)
{
    const v4 size = max4(box.upper * scale - box.lower * scale, (v4) { 0 });
    const v4 sides = size * ((v4) { size[1], size[2], size[0], 0 } + 0x1p-20f);
    return sides[0] + sides[1] + sides[2];
}

/// Returns 1 / the longest side of a box, so that no area overflows and not all areas underflow.
static float area_scale(const bounds *box)
{
    float longest = 0;
    for (int axis = 0; axis < 3; axis++)
        longest = fmaxf(longest, box->upper[axis] * 0.5f - box->lower[axis] * 0.5f);
    return fminf(0.5f / longest, 0x1p120f);
}

/// Returns the number of nodes that the records fill; the cost of a set is this number times the set's area.
static inline float node_count(uint32_t records)
{
    return (float)((records + GLINT_NODE_WIDTH - 1) / GLINT_NODE_WIDTH);
}

/// Finds the cheapest cut on one axis, if it is cheaper than *cost.
static void cut_axis(const bins *b, int axis, uint32_t total, float scale, float *cost, cut *best)
{
    float above[BINS];
    bounds box = empty;
    for (int bin = BINS - 1; bin > 0; bin--) {
        bounds_add(&box, &b->box[axis][bin]);
        above[bin] = half_area(box, scale);
    }
    box = empty;
    uint32_t below = 0;
    for (int bin = 1; bin < BINS; bin++) {
        bounds_add(&box, &b->box[axis][bin - 1]);
        below += b->count[axis][bin - 1];
        if (below == 0 || below == total)
            continue;
        const float c = half_area(box, scale) * node_count(below) + above[bin] * node_count(total - below);
        if (c < *cost) {
            *cost = c;
            *best = (cut) { axis, bin };
        }
    }
}

static cut find_cut(const bins *b, const glint_record_set *set)
{
    cut best = { -1, 0 };
    float cost = INFINITY;
    const float scale = area_scale(&set->box);
    for (int axis = 0; axis < 3; axis++)
        cut_axis(b, axis, set->count, scale, &cost, &best);
    return best;
}

/// Finds the records of a piece that belong to the other part.
static void find_wrong(void *context, size_t index, int worker)
{
    (void)worker;
    split_work *work = context;
    const size_t upper_part = index >= work->count;
    piece *p = &work->pieces[upper_part][index - (upper_part ? work->count : 0)];
    const int axis = work->cut.axis, bin = work->cut.bin;
    const float origin = work->grid.origin[axis], scale = work->grid.scale[axis];
    static const v4i skip[2] = { { 0, 0, 0, 0 }, { -1, -1, -1, -1 } };
    bounds lower = empty, upper = empty;
    uint32_t *wrong = work->wrong + p->begin;
    size_t count = 0;
    for (uint32_t i = p->begin; i < p->begin + p->count; i++) {
        const glint_record *record = &work->records[i];
        const v4 center = box_center(record_box(record));
        const float position = (record->lower[axis] * 0.25f + record->upper[axis] * 0.25f - origin) * scale;
        const size_t is_upper = (int)position >= bin;
        wrong[count] = i;
        count += is_upper != upper_part;
        // all bits set make a NaN, which min4 and max4 ignore
        bounds_add_point(&lower, (v4)((v4i)center | skip[is_upper]));
        bounds_add_point(&upper, (v4)((v4i)center | skip[!is_upper]));
    }
    p->center[0] = lower;
    p->center[1] = upper;
    p->wrong = (uint32_t)count;
}

/// Swaps misplaced records of a piece of the lower part with the misplaced records of equal rank in the upper part.
static void swap_wrong(void *context, size_t index, int worker)
{
    (void)worker;
    split_work *work = context;
    const piece *p = &work->pieces[0][index], *other = work->pieces[1];
    uint32_t at = p->wrong_before;
    for (uint32_t i = 0; i < p->wrong; i++, at++) {
        while (at >= other->wrong_before + other->wrong)
            other++;
        glint_record *a = &work->records[work->wrong[p->begin + i]];
        glint_record *b = &work->records[work->wrong[other->begin + (at - other->wrong_before)]];
        const glint_record record = *a;
        *a = *b;
        *b = record;
    }
}

/// Adds the bins of the other chunks to the first.
static const bins *add_bins(chunk *chunks, size_t count)
{
    bins *sum = &chunks[0].bins;
    for (size_t i = 1; i < count; i++)
        for (int axis = 0; axis < 3; axis++)
            for (int bin = 0; bin < BINS; bin++) {
                bounds_add(&sum->box[axis][bin], &chunks[i].bins.box[axis][bin]);
                sum->count[axis][bin] += chunks[i].bins.count[axis][bin];
            }
    return sum;
}

static uint32_t count_below(const bins *b, cut where)
{
    uint32_t count = 0;
    for (int bin = 0; bin < where.bin; bin++)
        count += b->count[where.axis][bin];
    return count;
}

/// Fills in both sets except for the bounds of their centres, which are computed when the records are moved.
static void part(const bins *b, cut where, glint_record_set *set, glint_record_set *above)
{
    *above = *set;
    above->splits = ++set->splits;
    set->count = count_below(b, where);
    above->begin += set->count;
    above->count -= set->count;
    set->box = above->box = set->center = above->center = empty;
    for (int bin = 0; bin < BINS; bin++)
        bounds_add(bin < where.bin ? &set->box : &above->box, &b->box[where.axis][bin]);
}

static size_t chunk_count(uint32_t records)
{
    const size_t count = records / CHUNK;
    return count < 1 ? 1 : count < CHUNKS_MAX ? count : CHUNKS_MAX;
}

/// Divides `total` records among `count` chunks, and returns `count`.
static size_t cut_chunks(chunk *chunks, size_t count, uint32_t total)
{
    for (size_t i = 0; i < count; i++) {
        chunks[i].begin = (uint32_t)((uint64_t)total * i / count);
        chunks[i].count = (uint32_t)((uint64_t)total * (i + 1) / count) - chunks[i].begin;
    }
    return count;
}

/// Divides a part of the set among the pieces, as many as the work has.
static void cut_pieces(split_work *work, int part, uint32_t begin, uint32_t total)
{
    for (size_t i = 0; i < work->count; i++) {
        piece *p = &work->pieces[part][i];
        const uint32_t from = (uint32_t)((uint64_t)total * i / work->count);
        *p = (piece) { .begin = begin + from, .count = (uint32_t)((uint64_t)total * (i + 1) / work->count) - from };
    }
}

/// Moves the records of each part to consecutive positions.
static void move_records(split_work *work, glint_record_set *set, glint_record_set *above)
{
    cut_pieces(work, 0, 0, set->count);
    cut_pieces(work, 1, set->count, above->count);
    glint_run_items(work->pool, 2 * work->count, find_wrong, work);
    for (int part = 0; part < 2; part++)
        for (size_t i = 0; i < work->count; i++) {
            piece *p = &work->pieces[part][i];
            p->wrong_before = i ? p[-1].wrong_before + p[-1].wrong : 0;
            bounds_add(&set->center, &p->center[0]);
            bounds_add(&above->center, &p->center[1]);
        }
    glint_run_items(work->pool, work->count, swap_wrong, work);
}

static void split_chunks(const glint_records *records, chunk *chunks, size_t count, glint_record_set *set,
                         glint_record_set *above)
{
    split_work work;
    work.records = records->all + set->begin;
    work.wrong = records->wrong + set->begin;
    work.chunks = chunks;
    work.pool = count > 1 ? records->pool : NULL; // with one chunk, the caller may be one of the pool's workers
    work.count = cut_chunks(chunks, count, set->count);
    work.grid = grid_of(set);
    glint_run_items(work.pool, count, bin_chunk, &work);
    const bins *sum = add_bins(chunks, count);
    work.cut = find_cut(sum, set);
    if (work.cut.axis < 0) {
        glint_records_halve(records, set, above);
        return;
    }
    part(sum, work.cut, set, above);
    move_records(&work, set, above);
}

void glint_records_split(const glint_records *records, glint_record_set *set, glint_record_set *above, bool shared)
{
    if (set->splits >= SPLITS_MAX) {
        glint_records_halve(records, set, above);
        return;
    }
    const size_t count = chunk_count(set->count);
    if (shared && records->pool && count > 1) {
        split_chunks(records, records->chunks, count, set, above);
        return;
    }
    chunk whole;
    split_chunks(records, &whole, 1, set, above);
}

static void measure(const glint_record *records, size_t count, bounds *box, bounds *center)
{
    *box = *center = empty;
    for (size_t i = 0; i < count; i++) {
        const bounds b = record_box(&records[i]);
        bounds_add(box, &b);
        bounds_add_point(center, box_center(b));
    }
}

void glint_records_halve(const glint_records *records, glint_record_set *set, glint_record_set *above)
{
    const uint32_t pair = 2 * GLINT_NODE_WIDTH;
    *above = *set;
    set->count = (set->count + pair - 1) / pair * GLINT_NODE_WIDTH;
    above->begin += set->count;
    above->count -= set->count;
    measure(glint_records_of(records, set), set->count, &set->box, &set->center);
    measure(glint_records_of(records, above), above->count, &above->box, &above->center);
}

typedef struct load_work {
    const glint_record *records;
    chunk *chunks;
} load_work;

static void load_chunk(void *context, size_t index, int worker)
{
    (void)worker;
    const load_work *work = context;
    chunk *c = &work->chunks[index];
    measure(work->records + c->begin, c->count, &c->box, &c->center);
}

bool glint_records_init(glint_records *records, glint_box *boxes, uint32_t count, glint_pool *pool,
                        glint_record_set *root)
{
    _Static_assert(sizeof(glint_box) == sizeof(glint_record), "a box is a record");
    *records = (glint_records) { .pool = pool, .all = (glint_record *)(void *)boxes, .count = count };
    records->wrong = glint_scratch_resize(NULL, 0, count * sizeof *records->wrong);
    records->chunks = glint_alloc(CHUNKS_MAX, sizeof *records->chunks);
    if (!records->wrong || !records->chunks)
        return false;
    load_work work = { records->all, records->chunks };
    const size_t chunks = cut_chunks(records->chunks, chunk_count(count), count);
    glint_run_items(pool, chunks, load_chunk, &work);
    *root = (glint_record_set) { .box = empty, .center = empty, .count = count };
    for (size_t i = 0; i < chunks; i++) {
        bounds_add(&root->box, &work.chunks[i].box);
        bounds_add(&root->center, &work.chunks[i].center);
    }
    return true;
}

void glint_records_free(glint_records *records)
{
    glint_boxes_free((glint_box *)(void *)records->all, records->count);
    glint_scratch_free(records->wrong, records->count * sizeof *records->wrong);
    free(records->chunks);
    records->all = NULL;
    records->wrong = NULL;
    records->chunks = NULL;
}

void glint_records_drop(const glint_records *records, const glint_record_set *set)
{
    glint_scratch_drop(records->all, records->count * sizeof *records->all, set->begin * sizeof *records->all,
                       (set->begin + set->count) * sizeof *records->all);
}
