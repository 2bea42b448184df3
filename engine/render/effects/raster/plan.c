#include "engine/render/effects/raster/plan.h"
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"

#include <float.h>
#include <stdlib.h>

#define CHUNK 16384u ///< triangles that one worker projects at a time
#define ENTRIES_MAX ((size_t)1 << 25) ///< 400 MB
#define COUNTS_MAX ((size_t)1 << 24)
#define BUCKETS 64 ///< number of depth intervals for sorting a tile's entries

/// The picture plane for projection.
typedef struct picture {
    const glint_plan_camera *camera;
    double width, height, scale;
    double per_right, per_up; ///< 1 / length^2
    double unit[2]; ///< 1 / length: how many half pixels a world unit is at distance 1
    double low[2], high[2]; ///< range of sample positions within a pixel, across and down
    double rounding; ///< relative rounding error of one operation
    bool is_float;
} picture;

/// The pixels that a triangle may cover, both ends included.
typedef struct extent {
    uint16_t x0, y0, x1, y1;
    float depth; ///< see glint_raster_entry; +inf: none
} extent;

typedef struct scanning {
    picture screen;
    const glint_geometry_table *geometry;
    uint32_t across; ///< tiles
    size_t tile_count, chunk_count;
    extent *extents; ///< pixels of each primitive
    uint32_t *counts; ///< number of entries per chunk and tile; then the position of the chunk's first entry of the
        ///< tile
    glint_raster *raster;
} scanning;

// ---- Projection ----

/// A corner relative to the eye.
typedef struct seen_corner {
    double p[3]; ///< relative to the eye, rounded as in the decision of hits
    double z, s, t; ///< along the view and across it, not yet divided by z
    double size; ///< magnitude of p and of its terms, for the rounding error
} seen_corner;

typedef struct range {
    double low, high;
} range;

// fmin and fmax would be calls, a dozen for each triangle.
static inline double lower(double a, double b) { return a < b ? a : b; }
static inline double higher(double a, double b) { return a > b ? a : b; }

static inline void cover(range *r, double x, double slack)
{
    r->low = lower(x - slack, r->low);
    r->high = higher(x + slack, r->high);
}

static inline seen_corner see_corner(const picture *screen, const double corner[3])
{
    const glint_plan_camera *camera = screen->camera;
    seen_corner out = { .size = 0 };
    for (int c = 0; c < 3; c++) {
        out.p[c] = screen->is_float ? (double)((float)corner[c] - (float)camera->eye[c]) : corner[c] - camera->eye[c];
        out.size += fabs(out.p[c]) + (camera->orthographic ? fabs(corner[c]) + fabs(camera->eye[c]) : 0);
    }
    out.z = vec_dot(out.p, camera->forward);
    out.s = vec_dot(out.p, camera->right) * screen->per_right;
    out.t = vec_dot(out.p, camera->up) * screen->per_up;
    return out;
}

/// Extends the ranges by a corner in front of the eye.
static inline void cover_corner(const picture *screen, const seen_corner *corner, range *s, range *t)
{
    const double per_z = screen->camera->orthographic ? 1 : 1 / corner->z, x = corner->s * per_z, y = corner->t * per_z;
    const double slack = 64 * screen->rounding * (corner->size * per_z);
    cover(s, x, slack * (screen->unit[0] + fabs(x)) + 0x1p-40 * (fabs(screen->camera->span[0]) + fabs(x)));
    cover(t, y, slack * (screen->unit[1] + fabs(y)) + 0x1p-40 * (fabs(screen->camera->span[1]) + fabs(y)));
}

/// Extends the ranges along an edge that crosses the plane of the eye: it goes to infinity on the screen.
static void cover_far(const seen_corner *front, const seen_corner *other, range *s, range *t)
{
    const double share = other->z < 0 ? front->z / (front->z - other->z) : 1;
    const double x = front->s + (other->s - front->s) * share, y = front->t + (other->t - front->t) * share;
    const double sure_x = 0x1p-14 * (fabs(front->s) + fabs(other->s)),
                 sure_y = 0x1p-14 * (fabs(front->t) + fabs(other->t));
    if (!(x > sure_x))
        s->low = -HUGE_VAL;
    if (!(x < -sure_x))
        s->high = HUGE_VAL;
    if (!(y > sure_y))
        t->low = -HUGE_VAL;
    if (!(y < -sure_y))
        t->high = HUGE_VAL;
}

/// Computes the part of the screen that a triangle may cover. Returns false if the triangle is behind the eye.
static inline bool cover_triangle(const picture *screen, const seen_corner corner[3], range *s, range *t)
{
    const double sure = screen->is_float ? 1e-4 : 1e-10;
    int front[3], behind = 0, in_front = 0;
    for (int j = 0; j < 3; j++) {
        front[j] = corner[j].z > sure * corner[j].size;
        in_front += front[j];
        behind += corner[j].z < -sure * corner[j].size;
    }
    if (behind == 3)
        return false;
    *s = *t = (range) { HUGE_VAL, -HUGE_VAL };
    for (int j = 0; j < 3; j++)
        if (front[j] || screen->camera->orthographic)
            cover_corner(screen, &corner[j], s, t);
    if (screen->camera->orthographic || in_front == 3)
        return true;
    if (in_front == 0)
        *s = *t = (range) { -HUGE_VAL, HUGE_VAL };
    for (int j = 0; j < 9; j++)
        if (front[j / 3] && !front[j % 3])
            cover_far(&corner[j / 3], &corner[j % 3], s, t);
    return true;
}

/// Returns a lower bound of t * scale; -inf if the triangle is so close to edge-on that rounding may put a hit
/// anywhere.
static inline float depth_of(const picture *screen, const seen_corner corner[3])
{
    const double edge_on = screen->is_float ? 1e-3 : 1e-9, margin = screen->is_float ? 1e-3 : 1e-6;
    double f[3], g[3], n[3];
    vec_sub(f, corner[1].p, corner[0].p);
    vec_sub(g, corner[2].p, corner[0].p);
    vec_cross(n, f, g);
    const double size = higher(corner[0].size, higher(corner[1].size, corner[2].size));
    const double volume = vec_dot(n, screen->camera->orthographic ? screen->camera->forward : corner[0].p);
    if (!(fabs(volume) > edge_on * size * size * (screen->camera->orthographic ? 1 : size)))
        return -HUGE_VALF;
    const double z = lower(corner[0].z, lower(corner[1].z, corner[2].z));
    const double depth = (z - margin * size) * screen->scale;
    return (float)lower(depth - 0x1p-20 * fabs(depth), FLT_MAX);
}

/// Computes the integers within a range, clipped to 0 .. size - 1. Returns false if there are none.
static inline bool pixels_of(double low, double high, double size, uint16_t *first, uint16_t *last)
{
    if (low > size - 1 || high < 0)
        return false;
    const int32_t from = low > 0 ? (int32_t)low : 0,
                  to = high < size - 1 ? (int32_t)high : (int32_t)size - 1; // NaN: all
    *first = (uint16_t)(from + (low > from)); // rounded up
    *last = (uint16_t)to;
    return *first <= *last;
}

static inline extent project(const picture *screen, const glint_prim *prim)
{
    const extent none = { .depth = HUGE_VALF };
    extent out = none;
    range s, t;
    seen_corner corner[3];
    for (int j = 0; j < 3; j++)
        corner[j] = see_corner(screen, prim->corner[j]);
    if (!cover_triangle(screen, corner, &s, &t))
        return none;
    const double *span = screen->camera->span;
    if (!pixels_of((s.low + span[0]) / 2 - screen->high[0], (s.high + span[0]) / 2 - screen->low[0],
                   screen->width, &out.x0, &out.x1) ||
        !pixels_of((span[1] - t.high) / 2 - screen->high[1], (span[1] - t.low) / 2 - screen->low[1],
                   screen->height, &out.y0, &out.y1))
        return none;
    out.depth = depth_of(screen, corner);
    return out;
}

// ---- Tiles ----

static void count_chunk(void *context, size_t chunk, int worker)
{
    const scanning *s = context;
    uint32_t *counts = s->counts + chunk * s->tile_count;
    const uint32_t end = s->geometry->prim_count;
    (void)worker;
    for (uint32_t i = (uint32_t)chunk * CHUNK; i < end && i < (chunk + 1) * CHUNK; i++) {
        const glint_prim *prim = &s->geometry->prims[i];
        extent *e = &s->extents[i];
        *e = prim->kind == GLINT_PRIM_TRIANGLE ? project(&s->screen, prim) : (extent) { .depth = HUGE_VALF };
        if (e->depth == HUGE_VALF)
            continue;
        for (uint32_t y = e->y0 / GLINT_TILE_HEIGHT; y <= e->y1 / GLINT_TILE_HEIGHT; y++)
            for (uint32_t x = e->x0 / GLINT_TILE_WIDTH; x <= e->x1 / GLINT_TILE_WIDTH; x++)
                counts[y * s->across + x]++;
    }
}

/// Clips a range to a tile that begins at `start`, relative to it.
static void clip(uint32_t low, uint32_t high, uint32_t start, uint32_t size, uint8_t *first, uint8_t *last)
{
    *first = (uint8_t)(low > start ? low - start : 0);
    *last = (uint8_t)(high < start + size ? high - start : size - 1);
}

static void enter_chunk(void *context, size_t chunk, int worker)
{
    const scanning *s = context;
    uint32_t *next = s->counts + chunk * s->tile_count;
    const uint32_t end = s->geometry->prim_count;
    (void)worker;
    for (uint32_t i = (uint32_t)chunk * CHUNK; i < end && i < (chunk + 1) * CHUNK; i++) {
        const extent *e = &s->extents[i];
        if (e->depth == HUGE_VALF)
            continue;
        for (uint32_t y = e->y0 / GLINT_TILE_HEIGHT; y <= e->y1 / GLINT_TILE_HEIGHT; y++)
            for (uint32_t x = e->x0 / GLINT_TILE_WIDTH; x <= e->x1 / GLINT_TILE_WIDTH; x++) {
                glint_raster_entry *entry = &s->raster->entries[next[y * s->across + x]++];
                entry->prim = i;
                entry->depth = e->depth;
                clip(e->x0, e->x1, x * GLINT_TILE_WIDTH, GLINT_TILE_WIDTH, &entry->x0, &entry->x1);
                clip(e->y0, e->y1, y * GLINT_TILE_HEIGHT, GLINT_TILE_HEIGHT, &entry->y0, &entry->y1);
            }
    }
}

static int bucket_of(float depth, float low, float per_depth)
{
    const float x = (depth - low) * per_depth;
    return x > 0 ? x < BUCKETS - 1 ? (int)x : BUCKETS - 1 : 0;
}

/// Sorts entries roughly by depth, nearest first, so that hidden triangles need no decision.
static void order_tile(void *context, size_t tile, int worker)
{
    const scanning *s = context;
    const size_t count = s->raster->first[tile + 1] - s->raster->first[tile];
    glint_raster_entry *entries = s->raster->entries + s->raster->first[tile];
    float low = HUGE_VALF, high = -HUGE_VALF;
    size_t at[BUCKETS + 1] = { 0 };
    (void)worker;
    glint_raster_entry *copy = count > 2 ? malloc(count * sizeof *copy) : NULL;
    if (!copy)
        return; // any order will do
    memcpy(copy, entries, count * sizeof *copy);
    for (size_t i = 0; i < count; i++) {
        low = copy[i].depth > -HUGE_VALF ? fminf(low, copy[i].depth) : low;
        high = fmaxf(high, copy[i].depth);
    }
    const float per_depth = high > low ? BUCKETS / (high - low) : 0;
    for (size_t i = 0; i < count; i++)
        at[bucket_of(copy[i].depth, low, per_depth) + 1]++;
    for (int k = 1; k <= BUCKETS; k++)
        at[k] += at[k - 1];
    for (size_t i = 0; i < count; i++)
        entries[at[bucket_of(copy[i].depth, low, per_depth)]++] = copy[i];
    free(copy);
}

/// Turns the counts into positions; returns the number of entries.
static size_t place_entries(scanning *s)
{
    size_t total = 0;
    for (size_t tile = 0; tile < s->tile_count; tile++) {
        s->raster->first[tile] = total;
        for (size_t chunk = 0; chunk < s->chunk_count; chunk++) {
            uint32_t *count = &s->counts[chunk * s->tile_count + tile];
            const uint32_t here = *count;
            *count = (uint32_t)(total < ENTRIES_MAX ? total : ENTRIES_MAX);
            total += here;
        }
    }
    s->raster->first[s->tile_count] = total;
    return total;
}

// ---- A frame ----

static picture make_screen(const glint_plan *plan, double scale)
{
    const glint_plan_camera *camera = &plan->camera;
    picture out = { .camera = camera, .width = plan->desc.width, .height = plan->desc.height, .scale = scale };
    out.is_float = plan->desc.precision == GLINT_PRECISION_FLOAT;
    out.rounding = out.is_float ? 0x1p-24 : 0x1p-53;
    out.per_right = 1 / vec_dot(camera->right, camera->right);
    out.per_up = 1 / vec_dot(camera->up, camera->up);
    out.unit[0] = sqrt(out.per_right);
    out.unit[1] = sqrt(out.per_up);
    const bool one = plan->desc.samples == 1 && !glint_plan_casts_centres(plan);
    double only[2];
    glint_plan_sample_offset(plan, 0, only);
    for (int c = 0; c < 2; c++) {
        out.low[c] = one ? only[c] : 0;
        out.high[c] = one ? only[c] : 1;
    }
    return out;
}

static glint_status enter_all(scanning *s, glint_pool *pool, glint_error *error)
{
    glint_raster *raster = s->raster;
    const size_t placed = place_entries(s), total = placed ? placed : 1; // at least one, so that memory is allocated
    if (total > ENTRIES_MAX)
        return GLINT_OK;
    if (total > raster->entry_capacity) {
        free(raster->entries);
        raster->entry_capacity = 0;
        raster->entries = glint_alloc_large(total, sizeof *raster->entries);
        if (!raster->entries)
            return glint_fail_nomem(error);
        raster->entry_capacity = total;
    }
    glint_pool_run(pool, s->chunk_count, enter_chunk, s);
    glint_pool_run(pool, s->tile_count, order_tile, s);
    raster->on = true;
    return GLINT_OK;
}

glint_status glint_raster_begin(glint_raster *raster, const glint_plan *plan, const glint_geometry_table *geometry,
                                glint_pool *pool, glint_error *error)
{
    const uint32_t width = (uint32_t)plan->desc.width, height = (uint32_t)plan->desc.height;
    scanning s = { .screen = make_screen(plan, geometry->scale), .geometry = geometry, .raster = raster };
    s.across = (width + GLINT_TILE_WIDTH - 1) / GLINT_TILE_WIDTH;
    s.tile_count = (size_t)s.across * ((height + GLINT_TILE_HEIGHT - 1) / GLINT_TILE_HEIGHT);
    s.chunk_count = (geometry->prim_count + CHUNK - 1) / CHUNK;
    raster->on = false;
    glint_status status = glint_geometry_others(plan->geometry, pool, &raster->others, &raster->rest, error);
    if (status || s.tile_count > COUNTS_MAX / (s.chunk_count + 1))
        return status;
    if (s.tile_count > raster->tile_capacity) {
        free(raster->first);
        raster->tile_capacity = 0;
        raster->first = glint_alloc(s.tile_count + 1, sizeof *raster->first);
        raster->tile_capacity = raster->first ? s.tile_count : 0;
    }
    s.extents = glint_alloc_large(geometry->prim_count, sizeof *s.extents);
    s.counts = glint_alloc(s.chunk_count * s.tile_count, sizeof *s.counts);
    status = glint_fail_nomem(error);
    if (raster->first && s.extents && s.counts) {
        glint_pool_run(pool, s.chunk_count, count_chunk, &s);
        status = enter_all(&s, pool, error);
    }
    free(s.extents);
    free(s.counts);
    return status;
}

void glint_raster_clear(glint_raster *raster)
{
    free(raster->first);
    free(raster->entries);
    *raster = (glint_raster) { 0 };
}

// ---- Scan or cast ----

// Nanoseconds on one core of an EPYC (Zen 4), at 1280x720, for spheres and terrains of 1,000 to 1,000,000 triangles.
// A wrong guess costs a few of them per triangle or pixel.
#define PROJECT_NS 45 ///< per triangle, in view or not
#define VISIT_NS 20 ///< additional time of casting per triangle in view ...
#define PIXEL_NS 1 ///< ... and per sample
#define MERGE_NS 4 ///< per sample, if other primitives are cast as well
#define BUILD_NS 500 ///< to build an index, per primitive
#define FRAMES_WITHOUT 8 ///< frames after which the projections cost as much as building an index

/// Facts about a geometry, which other threads may be arranging or indexing.
typedef struct outlook {
    double in_view; ///< share of its triangles, estimated from some of them
    bool alone; ///< there are only triangles
    bool indexed;
} outlook;

static outlook survey(const glint_plan *plan)
{
    enum { LOOKED_AT = 509 }; // a prime, so that samples do not follow the lines of a regular mesh
    glint_geometry *geometry = plan->geometry;
    outlook out = { .in_view = 1, .indexed = true };
    if (pthread_mutex_trylock(&geometry->index->lock))
        return out; // another thread is indexing it
    const picture screen = make_screen(plan, geometry->table.scale);
    const uint32_t count = geometry->table.prim_count, step = count / LOOKED_AT + 1;
    uint32_t looked = 0, seen = 0;
    for (uint32_t i = 0; i < count; i += step) {
        const glint_prim *prim = &geometry->prims[i];
        if (prim->kind != GLINT_PRIM_TRIANGLE)
            continue;
        looked++;
        seen += project(&screen, prim).depth < HUGE_VALF;
    }
    if (looked)
        out.in_view = (double)seen / looked;
    out.alone = geometry->table.triangles == count;
    out.indexed = geometry->index->built;
    pthread_mutex_unlock(&geometry->index->lock);
    return out;
}

/// Returns whether scanning is likely to be faster than casting.
static bool pays(const glint_plan *plan)
{
    const glint_geometry *geometry = plan->geometry;
    const outlook known = survey(plan);
    const double triangles = geometry->table.triangles, samples = plan->desc.samples;
    const double pixels = plan->desc.width * plan->desc.height * samples;
    const double raster = triangles * PROJECT_NS + (known.alone ? 0 : pixels * MERGE_NS);
    double cast = pixels * PIXEL_NS + samples * VISIT_NS * triangles * known.in_view;
    if (!plan->walks && !known.indexed && atomic_load(&geometry->index->frames_without) < FRAMES_WITHOUT)
        cast += BUILD_NS * triangles;
    return cast > raster;
}

bool glint_raster_is_called(const glint_plan *plan)
{
    const glint_visibility requested = plan->desc.visibility;
    return plan->geometry->table.triangles > 0 && !plan->lens && requested != GLINT_VISIBILITY_CAST &&
           (requested == GLINT_VISIBILITY_SCAN || pays(plan));
}
