#include "engine/geometry/bvh_split.h"
#include "engine/base/alloc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#define BINS 16
#define CHUNK 16384 ///< records; what one worker takes at a time
#define CHUNKS_MAX 64
/// By place a path may split this often, then by number: what peels off a few of a million each time must end.
#define SPLITS_MAX 64

typedef glint_float4 v4;
typedef int32_t v4i __attribute__((vector_size(16)));
typedef glint_bounds bounds;

typedef struct bins {
    bounds box[3][BINS];
    uint32_t count[3][BINS];
} bins;

/// Where the centres of a set fall: bin = (center - origin) scale. An axis that tells nothing apart has scale 0.
typedef struct grid {
    v4 origin, scale;
} grid;

typedef struct cut {
    int axis; ///< -1: none
    int bin; ///< first of the upper part
} cut;

/// What one worker does of a split, or of loading the boxes.
typedef struct glint_chunk {
    bins bins;
    bounds box; ///< loading: of the boxes
    bounds center[2]; ///< of the lower and the upper part; loading: of all, in the first
    uint32_t begin, count; ///< in the set
    uint32_t to[2]; ///< where in the other buffer the parts go
} chunk;

typedef struct split_work {
    const glint_record *from;
    glint_record *to;
    chunk *chunks;
    grid grid;
    cut cut;
} split_work;

/// a < b ? a : b in each lane: where a is NaN, b.
static inline v4 min4(v4 a, v4 b)
{
#if defined(__SSE2__)
    return _mm_min_ps(a, b);
#else
    const v4i less = a < b;
    return (v4)(((v4i)a & less) | ((v4i)b & ~less));
#endif
}

/// a > b ? a : b in each lane: where a is NaN, b.
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

/// The box alone: an index is no number to compute with.
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

/// Only the first three lanes count.
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
    const glint_record *records = work->from + c->begin;
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

/// Half the area of a box, in units of the set, and a little of its sides, which tell boxes without area apart.
static inline float half_area(bounds box, float scale)
{
    const v4 size = max4(box.upper * scale - box.lower * scale, (v4) { 0 });
    const v4 sides = size * ((v4) { size[1], size[2], size[0], 0 } + 0x1p-20f);
    return sides[0] + sides[1] + sides[2];
}

/// 1 / the longest side of a box, so that areas neither overflow nor vanish together.
static float area_scale(const bounds *box)
{
    float longest = 0;
    for (int axis = 0; axis < 3; axis++)
        longest = fmaxf(longest, box->upper[axis] * 0.5f - box->lower[axis] * 0.5f);
    return fminf(0.5f / longest, 0x1p120f);
}

/// Nodes full of records; the cost of a set is its area times this.
static inline float node_count(uint32_t records)
{
    return (float)((records + GLINT_NODE_WIDTH - 1) / GLINT_NODE_WIDTH);
}

/// The cheapest place on one axis, when it is cheaper than *cost.
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

static void move_chunk(void *context, size_t index, int worker)
{
    (void)worker;
    const split_work *work = context;
    chunk *c = &work->chunks[index];
    const glint_record *records = work->from + c->begin;
    const int axis = work->cut.axis, bin = work->cut.bin;
    const float origin = work->grid.origin[axis], scale = work->grid.scale[axis];
    static const v4i skip[2] = { { 0, 0, 0, 0 }, { -1, -1, -1, -1 } };
    bounds lower = empty, upper = empty;
    size_t to_lower = c->to[0], to_upper = c->to[1];
    for (uint32_t i = 0; i < c->count; i++) {
        const v4 center = box_center(record_box(&records[i]));
        const float place = (records[i].lower[axis] * 0.25f + records[i].upper[axis] * 0.25f - origin) * scale;
        const size_t is_upper = (int)place >= bin;
        work->to[to_lower ^ ((to_lower ^ to_upper) & -is_upper)] = records[i];
        to_lower += !is_upper;
        to_upper += is_upper;
        // all ones are a NaN, which min4 and max4 pass over
        bounds_add_point(&lower, (v4)((v4i)center | skip[is_upper]));
        bounds_add_point(&upper, (v4)((v4i)center | skip[!is_upper]));
    }
    c->center[0] = lower;
    c->center[1] = upper;
}

void glint_run_items(glint_pool *pool, size_t count, glint_pool_item *item, void *context)
{
    if (pool && count > 1) {
        glint_pool_run(pool, count, item, context);
        return;
    }
    for (size_t i = 0; i < count; i++)
        item(context, i, 0);
}

/// The chunks' bins together, in the first one's place, which keeps its counts.
static bins add_bins(const chunk *chunks, size_t count)
{
    bins sum = chunks[0].bins;
    for (size_t i = 1; i < count; i++)
        for (int axis = 0; axis < 3; axis++)
            for (int bin = 0; bin < BINS; bin++) {
                bounds_add(&sum.box[axis][bin], &chunks[i].bins.box[axis][bin]);
                sum.count[axis][bin] += chunks[i].bins.count[axis][bin];
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

/// Everything of the two sets but their centres, which the move finds out.
static void part(const bins *b, cut where, glint_record_set *set, glint_record_set *above)
{
    *above = *set;
    above->buffer = set->buffer = !set->buffer;
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

/// Shares `total` records out to `count` chunks, and returns `count`.
static size_t cut_chunks(chunk *chunks, size_t count, uint32_t total)
{
    for (size_t i = 0; i < count; i++) {
        chunks[i].begin = (uint32_t)((uint64_t)total * i / count);
        chunks[i].count = (uint32_t)((uint64_t)total * (i + 1) / count) - chunks[i].begin;
    }
    return count;
}

static void split_chunks(const glint_records *records, chunk *chunks, size_t count, glint_record_set *set,
                         glint_record_set *above)
{
    split_work work = {
        glint_records_of(records, set), records->buffers[!set->buffer], chunks, grid_of(set), { -1, 0 }
    };
    cut_chunks(chunks, count, set->count);
    glint_run_items(records->pool, count, bin_chunk, &work);
    const bins sum = add_bins(chunks, count);
    work.cut = find_cut(&sum, set);
    if (work.cut.axis < 0) {
        glint_records_halve(records, set, above);
        return;
    }
    part(&sum, work.cut, set, above);
    uint32_t to_lower = set->begin, to_upper = above->begin;
    for (size_t i = 0; i < count; i++) {
        const uint32_t below = count_below(&chunks[i].bins, work.cut);
        chunks[i].to[0] = to_lower;
        chunks[i].to[1] = to_upper;
        to_lower += below;
        to_upper += chunks[i].count - below;
    }
    glint_run_items(records->pool, count, move_chunk, &work);
    for (size_t i = 0; i < count; i++) {
        bounds_add(&set->center, &chunks[i].center[0]);
        bounds_add(&above->center, &chunks[i].center[1]);
    }
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
    const glint_box *boxes;
    glint_record *to;
    chunk *chunks;
} load_work;

static void load_chunk(void *context, size_t index, int worker)
{
    (void)worker;
    const load_work *work = context;
    chunk *c = &work->chunks[index];
    for (uint32_t i = c->begin; i < c->begin + c->count; i++) {
        const float *l = work->boxes[i].lower, *u = work->boxes[i].upper;
        glint_record record = { { l[0], l[1], l[2], 0 }, { u[0], u[1], u[2], 0 } };
        record.lower = (v4)((v4i)record.lower | (v4i) { 0, 0, 0, (int32_t)i });
        work->to[i] = record;
    }
    measure(work->to + c->begin, c->count, &c->box, &c->center[0]);
}

bool glint_records_init(glint_records *records, const glint_box *boxes, uint32_t count, glint_pool *pool,
                        glint_record_set *root)
{
    *records = (glint_records) { .pool = pool };
    for (int i = 0; i < 2; i++)
        records->buffers[i] = glint_alloc_large(count, sizeof(glint_record));
    records->chunks = glint_alloc(CHUNKS_MAX, sizeof *records->chunks);
    if (!records->buffers[0] || !records->buffers[1] || !records->chunks)
        return false;
    load_work work = { boxes, records->buffers[0], records->chunks };
    const size_t chunks = cut_chunks(records->chunks, chunk_count(count), count);
    glint_run_items(pool, chunks, load_chunk, &work);
    *root = (glint_record_set) { .box = empty, .center = empty, .count = count };
    for (size_t i = 0; i < chunks; i++) {
        bounds_add(&root->box, &work.chunks[i].box);
        bounds_add(&root->center, &work.chunks[i].center[0]);
    }
    return true;
}

void glint_records_free(glint_records *records)
{
    free(records->buffers[0]);
    free(records->buffers[1]);
    free(records->chunks);
}
