/// A frame: its tiles on the worker pool, each walked through the plan's stages; progress and cancel.
#include "engine/base/alloc.h"
#include "engine/base/pool.h"
#include "engine/base/status.h"
#include "engine/film/image.h"
#include "engine/film/tone.h"
#include "engine/frame/grids.h"
#include "engine/frame/outline.h"
#include "engine/frame/refine.h"
#include "engine/frame/render.h"
#include "engine/reuse/reuse.h"
#include "engine/tile/tile.h"
#include "engine/plan/tints.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/// Pictures whose memory a renderer holds on to, for a job with two in its queue: these, the one that is encoded and the one
/// that is rendered. A fifth would be new memory and a whole picture to copy or make each time.
#define GLINT_SPARE_IMAGES 4

struct glint_renderer {
    glint_pool *pool;
    const glint_stages *stages;
    bool time_stages, count_work;
    atomic_bool cancelled;
    atomic_bool *stop; ///< that; of a renderer of bases, that of its frames
    atomic_size_t tiles_done;
    atomic_size_t tile_count;
    glint_tile **tiles; ///< a tile's working memory for each worker
    glint_reuse reuse;
    glint_shading_points_cached shading_points;
    glint_raster raster;
    glint_tints tints; ///< of frames where what transmits tints shadows
    glint_grids own_grids, *grids; ///< a renderer of bases has that of its frames
    glint_image *last; ///< the last frame, given again when nothing it reads changed
    /// Pictures given before, whose memory is used again once no other reference holds them.
    glint_image *spare[GLINT_SPARE_IMAGES];
    glint_key last_key;
    double last_region[4];
    glint_frame_stats last_stats;
    glint_refine own_refine, *refine; ///< likewise
    double refined_by[3]; ///< threshold, curve and exposure that the last base was compared by
    /// Makes the pictures that adaptive sampling looks at, with the pool and the tiles of this one; NULL until a frame
    /// has it, and again after one that has not.
    struct glint_renderer *base;
    bool shares; ///< it is such a one
};

/// One call of glint_render.
typedef struct frame {
    glint_renderer *renderer;
    glint_tile_frame shared;
    glint_extent extent;
} frame;

/// What the environment says, where the choice is left open.
static glint_status choose_hits(glint_hits_choice *hits, glint_error *error)
{
    static const char *const words[] = { "measured", "kept", "anew" };
    const char *word = getenv("GLINT_HITS");
    if ((unsigned)*hits > GLINT_HITS_ANEW)
        return glint_fail(error, GLINT_ERR_INVALID, "hits: one of glint_hits_choice expected, got %d", (int)*hits);
    if (*hits != GLINT_HITS_MEASURED || !word || !*word)
        return GLINT_OK;
    for (int i = 0; i < 3; i++)
        if (strcmp(word, words[i]) == 0) {
            *hits = (glint_hits_choice)i;
            return GLINT_OK;
        }
    return glint_fail(error, GLINT_ERR_INVALID, "GLINT_HITS: measured, kept or anew expected, got '%.40s'", word);
}

glint_renderer_desc glint_renderer_desc_default(void) { return (glint_renderer_desc) { 0 }; }

glint_status glint_renderer_create(const glint_renderer_desc *desc, glint_renderer **out, glint_error *error)
{
    glint_renderer *renderer = calloc(1, sizeof *renderer);
    if (!renderer)
        return glint_fail_nomem(error);
    glint_tone_store_open();
    renderer->stop = &renderer->cancelled;
    renderer->grids = &renderer->own_grids;
    renderer->refine = &renderer->own_refine;
    renderer->time_stages = desc->time_stages;
    renderer->count_work = desc->count_work;
    glint_hits_choice hits = desc->hits;
    glint_status status = choose_hits(&hits, error);
    glint_reuse_init(&renderer->reuse, !desc->no_reuse, desc->reuse_memory, hits);
    if (!status)
        status = glint_choose_isa(desc->isa, &renderer->stages, error);
    const int threads = desc->threads ? desc->threads : glint_pool_processors();
    if (!status)
        status = glint_pool_create(threads, &renderer->pool, error);
    if (!status && !(renderer->tiles = calloc((size_t)threads, sizeof *renderer->tiles)))
        status = glint_fail_nomem(error);
    for (int i = 0; i < threads && !status; i++)
        if (!(renderer->tiles[i] = glint_alloc(1, sizeof **renderer->tiles)))
            status = glint_fail_nomem(error);
    if (status) {
        glint_renderer_destroy(renderer);
        return status;
    }
    *out = renderer;
    return GLINT_OK;
}

static void drop_spares(glint_renderer *renderer)
{
    for (int i = 0; i < GLINT_SPARE_IMAGES; i++) {
        if (renderer->spare[i] && renderer->reuse.on)
            glint_reuse_unreserve(&renderer->reuse, glint_image_bytes(renderer->spare[i]));
        glint_image_release(renderer->spare[i]);
        renderer->spare[i] = NULL;
    }
}

void glint_renderer_destroy(glint_renderer *renderer)
{
    if (!renderer)
        return;
    glint_renderer_destroy(renderer->base);
    glint_refine_clear(&renderer->own_refine);
    for (int i = 0; !renderer->shares && renderer->tiles && i < glint_pool_threads(renderer->pool); i++)
        glint_tile_destroy(renderer->tiles[i]);
    if (!renderer->shares)
        free(renderer->tiles);
    drop_spares(renderer);
    glint_shading_points_clear(&renderer->shading_points, &renderer->reuse);
    glint_raster_clear(&renderer->raster);
    glint_grids_clear(&renderer->own_grids);
    glint_reuse_destroy(&renderer->reuse);
    glint_image_release(renderer->last);
    if (!renderer->shares) {
        glint_pool_destroy(renderer->pool);
        glint_tone_store_close();
    }
    free(renderer);
}

const char *glint_renderer_isa(const glint_renderer *renderer) { return renderer->stages->name; }

int glint_renderer_threads(const glint_renderer *renderer) { return glint_pool_threads(renderer->pool); }

void glint_renderer_cancel(glint_renderer *renderer) { atomic_store(&renderer->cancelled, true); }

double glint_renderer_progress(const glint_renderer *renderer)
{
    const size_t count = atomic_load(&renderer->tile_count);
    return count ? (double)atomic_load(&renderer->tiles_done) / (double)count : 0;
}

static void render_item(void *context, size_t index, int worker)
{
    frame *f = context;
    glint_renderer *renderer = f->renderer;
    if (!glint_tile_cancelled(&f->shared))
        glint_tile_render(renderer->tiles[worker], &f->shared, f->extent.tile_x + (uint32_t)(index % f->extent.across),
                          f->extent.tile_y + (uint32_t)(index / f->extent.across));
    atomic_fetch_add(&renderer->tiles_done, 1);
}

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

/// A row of tiles is stamped by the stamps of its tiles.
static void stamp_rows(glint_image *image, uint32_t across)
{
    for (size_t row = 0; image->codes && row < glint_image_stamps(image); row++) {
        const glint_film_stamp *film = image->film + row * across;
        glint_key key = { 0 };
        bool known = true;
        for (size_t x = 0; x < across; x++) {
            known = known && film[x].codes;
            key = glint_key_mix(key, (glint_key) { film[x].codes, film[x].codes });
        }
        image->row_stamp[row] = known ? key.low : 0;
    }
}

static void collect_stats(glint_renderer *renderer, const glint_plan *plan, const glint_extent *extent, double wall_ms,
                          glint_frame_stats *stats)
{
    glint_tile_counts sum = { 0 };
    for (int i = 0; i < glint_pool_threads(renderer->pool); i++) {
        const glint_tile_counts *part = &renderer->tiles[i]->counts;
        for (int k = 0; k < GLINT_STAGE_COUNT; k++) {
            sum.ns[k] += part->ns[k];
            sum.runs[k] += part->runs[k];
            sum.reuses[k] += part->reuses[k];
        }
        sum.tile_ns += part->tile_ns;
        sum.primary += part->primary;
        sum.shadow += part->shadow;
        sum.work.tests += part->work.tests;
        sum.work.light_samples += part->work.light_samples;
        sum.work.powers += part->work.powers;
        sum.work.sites += part->work.sites;
        sum.work.lights_seen += part->work.lights_seen;
        sum.work.overlaps += part->work.overlaps;
        sum.work.patterns += part->work.patterns;
        sum.work.environment += part->work.environment;
        sum.mirror += part->mirror;
        sum.refraction += part->refraction;
        sum.indirect += part->indirect;
        sum.clipped += part->clipped;
        sum.nonfinite += part->nonfinite;
        sum.compared += part->compared;
        for (int way = 0; way < 2; way++) {
            sum.ways[way] += part->ways[way];
            sum.way_ns[way] += part->way_ns[way];
        }
    }
    sum.reuses[GLINT_STAGE_VERTEX] += renderer->shading_points.ready;
    sum.ns[GLINT_STAGE_CAST] += (uint64_t)(renderer->raster.ms * 1e6) * (uint64_t)glint_pool_threads(renderer->pool);
    const double toned = sum.tile_ns ? (double)sum.ns[GLINT_STAGE_TONE] / (double)sum.tile_ns : 0;
    glint_odd_pattern odd = { 0 };
    for (int i = 0; i < glint_pool_threads(renderer->pool); i++)
        glint_odd_pattern_add(&odd, &renderer->tiles[i]->counts.odd);
    *stats = (glint_frame_stats) { .render_ms = wall_ms * (1 - toned), .tone_ms = wall_ms * toned };
    stats->rays = (glint_ray_counts) { .primary = sum.primary,
                                       .shadow = sum.shadow,
                                       .mirror = sum.mirror,
                                       .refraction = sum.refraction,
                                       .indirect = sum.indirect };
    stats->work = sum.work;
    stats->hits_kept = sum.ways[0];
    stats->hits_anew = sum.ways[1];
    stats->hits_kept_us = sum.compared ? sum.way_ns[0] * 1e-3 / (double)sum.compared : 0;
    stats->hits_anew_us = sum.compared ? sum.way_ns[1] * 1e-3 / (double)sum.compared : 0;
    stats->pixels = (uint64_t)extent->width * (uint64_t)extent->height;
    stats->clipped = sum.clipped;
    stats->nonfinite = sum.nonfinite;
    if (odd.count) {
        stats->odd = odd.count;
        stats->odd_field = glint_field_name(odd.field);
        if (odd.field != GLINT_FIELD_BACKGROUND)
            memcpy(stats->odd_material, plan->patterns->of[odd.material].desc.name, sizeof stats->odd_material);
        memcpy(stats->odd_point, odd.point, sizeof stats->odd_point);
    }
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        if (!plan->runs[id])
            continue;
        stats->stage_name[stats->stage_count] = glint_stage_names[id];
        if (renderer->time_stages)
            stats->stage_ms[stats->stage_count] = (double)sum.ns[id] * 1e-6;
        const uint64_t calls = sum.runs[id] + sum.reuses[id];
        stats->stage_reused[stats->stage_count++] =
            calls ? (double)sum.reuses[id] / (double)calls : sum.reuses[GLINT_STAGE_CAST] > 0;
    }
}

/// What needs all tiles.
static void finish(glint_renderer *renderer, const glint_plan *plan, const glint_extent *extent, glint_image *image)
{
    glint_tile_counts *counts = &renderer->tiles[0]->counts;
    if (!plan->runs[GLINT_STAGE_OUTLINE] || atomic_load(renderer->stop))
        return;
    const uint64_t start = glint_tile_now_ns();
    glint_outline(plan->base ? plan->base : plan, extent, renderer->pool, image);
    counts->ns[GLINT_STAGE_OUTLINE] += glint_tile_now_ns() - start;
    counts->runs[GLINT_STAGE_OUTLINE]++;
}

/// Whether some tile's hits are not there from an earlier frame.
static bool casts(const glint_reuse *reuse, const glint_plan *plan)
{
    for (size_t i = 0; i < reuse->tile_count; i++)
        if (!glint_key_equal(reuse->tiles[i].cast, plan->keys[GLINT_STAGE_CAST]))
            return true;
    return reuse->tile_count == 0;
}

/// What the frame's rays meet, and by which way what the eye sees is found.
static glint_status prepare(glint_renderer *renderer, const glint_plan *plan, glint_tile_frame *shared,
                            size_t tile_count, glint_error *error)
{
    glint_geometry *geometry = plan->geometry;
    glint_status status = plan->needs_index
                              ? glint_geometry_index(geometry, renderer->pool, &shared->geometry, error)
                              : glint_geometry_arrange(geometry, &shared->geometry, error);
    if (status)
        return status;
    if (plan->tints) {
        glint_tints_find(&renderer->tints, plan, &shared->geometry);
        shared->tints = &renderer->tints;
    }
    if (shared->base) { // other pixels in every frame
        glint_reuse_clear(&renderer->reuse);
    } else {
        glint_reuse_carry(&renderer->reuse, plan, renderer->spare, GLINT_SPARE_IMAGES);
        glint_reuse_begin(&renderer->reuse, plan, tile_count);
    }
    renderer->raster.ms = 0;
    if (!plan->raster || !casts(&renderer->reuse, plan))
        return GLINT_OK;
    const double begin = now_ms();
    status = glint_raster_begin(&renderer->raster, plan, &shared->geometry, renderer->pool, error);
    renderer->raster.ms = now_ms() - begin;
    if (!shared->geometry.nodes)
        atomic_fetch_add(&geometry->index->frames_without, 1);
    shared->raster = !status && renderer->raster.on ? &renderer->raster : NULL;
    if (!status && !shared->raster)
        status = glint_geometry_index(geometry, renderer->pool, &shared->geometry, error);
    return status;
}

static bool has_format(const glint_image *image, const glint_render_desc *desc)
{
    uint32_t passes = 0;
    for (int pass = 0; pass < GLINT_PLANE_COUNT; pass++)
        passes |= (uint32_t)glint_image_has_pass(image, (glint_pass)pass) << pass;
    return image->width == (int)desc->width && image->height == (int)desc->height && passes == desc->passes &&
           image->alpha == desc->alpha && image->outline == desc->outline && (image->codes != NULL) == desc->codes &&
           (!desc->codes || glint_tone_same(&image->code_tone, &desc->tone));
}

/// Pixels of a row from whose samples other things are kept than from those of one beside them, or not from all the same. `up` and
/// `down`: the rows beside it; at an edge itself.
static uint64_t count_row(const uint32_t *at, const uint32_t *up, const uint32_t *down, int width)
{
    uint64_t count = 0;
    uint32_t before = 0, own = at[0]; // before: what parts this pixel from the one before it
    for (int x = 0; x < width; x++) {
        const uint32_t next = x + 1 < width ? at[x + 1] : own, after = own ^ next;
        count += own == 0 || (before | after | (own ^ up[x]) | (own ^ down[x])) != 0;
        before = after;
        own = next;
    }
    return count;
}

/// Pixels at the edges of shadows that a derivative's parameter moves.
static uint64_t count_shifted(const glint_image *image, const glint_extent *e)
{
    uint64_t count = 0;
    for (int y = e->y; y < e->y + e->height; y++) {
        const uint32_t *row = image->shadows + (size_t)y * (size_t)image->width + (size_t)e->x;
        count += count_row(row, y > e->y ? row - image->width : row, y + 1 < e->y + e->height ? row + image->width : row, e->width);
    }
    return count;
}

/// `base`: of adaptive sampling, after the choice; else NULL.
static glint_status run(glint_renderer *renderer, const glint_plan *plan, glint_image *image, const glint_image *base,
                        const glint_tone_table *table, glint_frame_stats *stats, glint_error *error)
{
    frame f = { .renderer = renderer,
                .shared = { .plan = plan,
                            .stages = renderer->stages,
                            .image = image,
                            .last = renderer->last && has_format(renderer->last, &plan->desc) ? renderer->last : NULL,
                            .tone_table = table,
                            .gain = glint_tone_gain(&plan->desc.tone),
                            .reuse = &renderer->reuse,
                            .shading_points = &renderer->shading_points,
                            .base = base,
                            .refine = renderer->refine,
                            .cancelled = renderer->stop,
                            .time_stages = renderer->time_stages,
                            .count_work = renderer->count_work } };
    const double begin = now_ms();
    f.extent = glint_plan_extent(&plan->desc);
    const uint32_t across = ((uint32_t)plan->desc.width + GLINT_TILE_WIDTH - 1) / GLINT_TILE_WIDTH;
    const size_t tiles = across * glint_image_stamps(image), rendered = (size_t)f.extent.across * f.extent.down;
    glint_status status = prepare(renderer, plan, &f.shared, tiles, error);
    if (!status && plan->is_base)
        status = glint_refine_begin(renderer->refine, renderer->stages, image, &plan->desc, error);
    if (image->film && (base || !renderer->reuse.tile_count)) // what is put there is not signed
        memset(image->film, 0, tiles * sizeof *image->film);
    if (!status)
        status = glint_grids_begin(renderer->grids, &f.shared, &f.extent, glint_pool_threads(renderer->pool), error);
    if (!status)
        status = glint_shading_points_begin(&renderer->shading_points, plan, &renderer->reuse, error);
    if (status)
        return status;
    if (renderer->reuse.tile_count && !image->film &&
        !(image->film = calloc(tiles, sizeof *image->film)))
        return glint_fail_nomem(error);
    for (int i = 0; i < glint_pool_threads(renderer->pool); i++) {
        renderer->tiles[i]->counts = (glint_tile_counts) { 0 };
        if (!glint_tile_extend(renderer->tiles[i], plan))
            return glint_fail_nomem(error);
    }
    atomic_store(&renderer->tiles_done, 0);
    atomic_store(&renderer->tile_count, rendered);
    const double start = now_ms();
    glint_pool_run(renderer->pool, rendered, render_item, &f);
    finish(renderer, plan, &f.extent, image);
    collect_stats(renderer, plan, &f.extent, now_ms() - start + renderer->raster.ms, stats);
    stats->build_ms = start - begin - renderer->raster.ms;
    stats->shifted = plan->derivatives && plan->derivatives->moves ? count_shifted(image, &f.extent) : 0;
    if (atomic_load(renderer->stop))
        return glint_fail(error, GLINT_ERR_CANCELLED, "cancelled");
    if (image->film)
        stamp_rows(image, across);
    return GLINT_OK;
}

glint_pool *glint_renderer_pool(const glint_renderer *renderer) { return renderer->pool; }

/// The key of the whole picture.
static glint_key picture_key(const glint_plan *plan)
{
    const glint_stage_id last = plan->desc.codes ? GLINT_STAGE_TONE : GLINT_STAGE_RESOLVE;
    return plan->keys[plan->derivatives ? GLINT_STAGE_DERIVATIVE : last];
}

/// Gives the last picture again when this frame's would be the same.
static bool unchanged(glint_renderer *renderer, const glint_plan *plan, glint_image **out, glint_frame_stats *stats)
{
    const glint_image *last = renderer->last;
    if (!last || !last->codes != !plan->desc.codes || !glint_key_equal(renderer->last_key, picture_key(plan)) ||
        memcmp(renderer->last_region, plan->desc.region, sizeof renderer->last_region) != 0)
        return false;
    *out = glint_image_retain(renderer->last);
    if (stats) {
        *stats = (glint_frame_stats) { .stage_count = renderer->last_stats.stage_count };
        stats->clipped = renderer->last_stats.clipped;
        stats->pixels = renderer->last_stats.pixels;
        stats->nonfinite = renderer->last_stats.nonfinite;
        stats->refined = renderer->last_stats.refined;
        stats->shifted = renderer->last_stats.shifted;
        for (int i = 0; i < stats->stage_count; i++) {
            stats->stage_name[i] = renderer->last_stats.stage_name[i];
            stats->stage_reused[i] = 1;
        }
    }
    return true;
}

static void remember(glint_renderer *renderer, const glint_plan *plan, glint_image *image,
                     const glint_frame_stats *stats)
{
    bool within_budget = false;
    for (int i = 0; i < GLINT_SPARE_IMAGES; i++)
        within_budget = within_budget || renderer->spare[i] == image;
    glint_image_release(renderer->last);
    renderer->last = within_budget && renderer->reuse.on ? glint_image_retain(image) : NULL;
    renderer->last_key = picture_key(plan);
    memcpy(renderer->last_region, plan->desc.region, sizeof renderer->last_region);
    renderer->last_stats = *stats;
}

/// A picture to render into: one given before with no other reference, or a new one.
static glint_status take_image(glint_renderer *renderer, const glint_render_desc *desc, glint_image **out,
                               glint_error *error)
{
    int free_slot = -1;
    for (int i = 0; i < GLINT_SPARE_IMAGES; i++) {
        glint_image *image = renderer->spare[i];
        if (image && !has_format(image, desc)) {
            drop_spares(renderer);
            break;
        }
        if (image && atomic_load(&image->references) == 1) {
            *out = glint_image_retain(image);
            return GLINT_OK;
        }
    }
    for (int i = 0; i < GLINT_SPARE_IMAGES; i++)
        free_slot = renderer->spare[i] ? free_slot : i;
    glint_status status = glint_image_create_for(desc, out, error);
    if (!status && free_slot >= 0 &&
        (!renderer->reuse.on || glint_reuse_reserve(&renderer->reuse, glint_image_bytes(*out))))
        renderer->spare[free_slot] = glint_image_retain(*out);
    return status;
}

// ---- Adaptive sampling ----

static void forget(glint_renderer *renderer)
{
    glint_image_release(renderer->last);
    renderer->last = NULL;
}

/// A renderer that keeps its own, half of what may be kept, and shares the rest.
static glint_status open_base(glint_renderer *renderer, glint_error *error)
{
    glint_renderer *base = renderer->base;
    if (base)
        return GLINT_OK;
    base = calloc(1, sizeof *base);
    if (!base)
        return glint_fail_nomem(error);
    base->shares = true;
    base->pool = renderer->pool;
    base->tiles = renderer->tiles;
    base->stages = renderer->stages;
    base->stop = renderer->stop;
    base->grids = renderer->grids;
    base->refine = renderer->refine;
    base->time_stages = renderer->time_stages;
    base->count_work = renderer->count_work;
    glint_reuse_init(&base->reuse, renderer->reuse.on, renderer->reuse.budget / 2 + 1, renderer->reuse.hits);
    renderer->base = base;
    return GLINT_OK;
}

void glint_frame_stats_add(glint_frame_stats *to, const glint_frame_stats *more, double share)
{
    to->build_ms += more->build_ms;
    to->render_ms += more->render_ms + more->tone_ms;
    to->rays.primary += more->rays.primary;
    to->rays.shadow += more->rays.shadow;
    to->rays.mirror += more->rays.mirror;
    to->rays.refraction += more->rays.refraction;
    to->rays.indirect += more->rays.indirect;
    to->work.tests += more->work.tests;
    to->work.light_samples += more->work.light_samples;
    to->work.powers += more->work.powers;
    to->work.sites += more->work.sites;
    to->work.lights_seen += more->work.lights_seen;
    to->work.patterns += more->work.patterns;
    to->work.environment += more->work.environment;
    to->work.overlaps += more->work.overlaps;
    if (!to->odd && more->odd) {
        to->odd_field = more->odd_field;
        memcpy(to->odd_material, more->odd_material, sizeof to->odd_material);
        memcpy(to->odd_point, more->odd_point, sizeof to->odd_point);
    }
    to->odd += more->odd;
    for (int i = 0; i < to->stage_count; i++)
        for (int k = 0; k < more->stage_count; k++) {
            if (to->stage_name[i] != more->stage_name[k] || to->stage_name[i] == glint_stage_names[GLINT_STAGE_TONE])
                continue;
            to->stage_ms[i] += more->stage_ms[k];
            to->stage_reused[i] += share * (more->stage_reused[k] - to->stage_reused[i]);
        }
}

/// Adds what the base took, and the choice, of which compare_ms were within it.
static void add_base(glint_frame_stats *to, const glint_frame_stats *base, const glint_plan *plan, double choose_ms,
                     double compare_ms, bool time_stages)
{
    const double pixels = (double)to->pixels;
    const double all = pixels + (double)to->refined * plan->desc.samples; // samples
    glint_frame_stats_add(to, base, pixels / all);
    to->render_ms += choose_ms;
    if (!glint_plan_compares_codes(&plan->desc)) { // its codes are the picture's
        to->render_ms -= base->tone_ms;
        to->tone_ms += base->tone_ms;
    }
    for (int i = 0; i < to->stage_count; i++)
        if (time_stages && to->stage_name[i] == glint_stage_names[GLINT_STAGE_REFINE])
            to->stage_ms[i] = choose_ms + compare_ms;
}

/// Of the last base nothing is taken where its pixels would be compared otherwise, or were given up half way.
static glint_status render_base(glint_renderer *renderer, const glint_plan *plan, glint_image **out, glint_frame_stats *stats,
                                glint_error *error)
{
    const glint_render_desc *desc = &plan->base->desc;
    const double by[] = { desc->adaptive, desc->tone.curve, desc->tone.exposure };
    glint_renderer *base = renderer->base;
    if (memcmp(renderer->refined_by, by, sizeof by) != 0)
        forget(base);
    memcpy(renderer->refined_by, by, sizeof by);
    const glint_status status = glint_render_instant(base, plan->base, out, stats, error);
    if (status)
        forget(base);
    return status;
}

/// The base in the picture that is made of it: `base` is that picture, with planes of `*more` where it has none. Nothing is kept.
static glint_status render_in_place(glint_renderer *renderer, const glint_plan *plan, const glint_image *image,
                                    const glint_tone_table *table, glint_image *base, glint_image **more,
                                    glint_frame_stats *stats, glint_error *error)
{
    glint_render_desc desc = plan->base->desc;
    glint_status status = GLINT_OK;
    *base = *image;
    base->film = NULL;
    desc.codes = false;
    desc.passes &= ~plan->desc.passes;
    if (desc.passes)
        status = renderer->reuse.on ? glint_image_create_for(&desc, more, error) : take_image(renderer->base, &desc, more, error);
    for (int pass = 0; pass < GLINT_PLANE_COUNT && *more; pass++)
        for (int c = 0; c < 3; c++)
            if ((*more)->plane[pass][c])
                base->plane[pass][c] = (*more)->plane[pass][c];
    renderer->base->reuse.on = false;
    if (!status)
        status = run(renderer->base, plan->base, base, NULL, table, stats, error);
    renderer->base->reuse.on = renderer->reuse.on;
    return status;
}

/// What comparing took of the time of the tiles last rendered, where stages are timed.
static double comparing_ms(const glint_renderer *renderer)
{
    double ms = 0;
    for (int i = 0; i < glint_pool_threads(renderer->pool); i++)
        ms += (double)renderer->tiles[i]->counts.ns[GLINT_STAGE_REFINE] * 1e-6;
    return ms;
}

/// The pixels of a base that are worth it, then those.
static glint_status refine_base(glint_renderer *renderer, const glint_plan *plan, glint_image *image, const glint_image *base,
                                const glint_tone_table *table, const glint_frame_stats *first, glint_frame_stats *stats,
                                glint_error *error)
{
    const double compare_ms = comparing_ms(renderer), start = now_ms();
    const glint_extent extent = glint_plan_extent(&plan->desc);
    renderer->refine->base = base; // it may be that of the last frame
    glint_refine_choose(renderer->refine, &extent, plan->lens != NULL, renderer->pool);
    const double choose_ms = now_ms() - start;
    const glint_status status = run(renderer, plan, image, base, table, stats, error);
    renderer->refine->base = NULL;
    if (status)
        return status;
    stats->refined = renderer->refine->count;
    add_base(stats, first, plan, choose_ms, compare_ms, renderer->time_stages);
    return GLINT_OK;
}

/// The base of a frame, then what is worth more. The base stands in the frame's own picture where nothing of it is kept: without
/// reuse, and in the first frame.
static glint_status run_adaptive(glint_renderer *renderer, const glint_plan *plan, glint_image *image,
                                 const glint_tone_table *table, glint_frame_stats *stats, glint_error *error)
{
    glint_refine *refine = renderer->refine;
    glint_image *kept = NULL, in_place;
    glint_frame_stats first;
    const bool alone = !renderer->reuse.on || !renderer->base;
    refine->whole = !glint_plan_compares_codes(&plan->desc) && !plan->derivatives &&
                    !(plan->lens && glint_tile_wants_geometry(plan));
    refine->in_place = refine->whole && alone;
    glint_status status = open_base(renderer, error);
    if (!status)
        status = refine->in_place ? render_in_place(renderer, plan, image, table, &in_place, &kept, &first, error)
                                  : render_base(renderer, plan, &kept, &first, error);
    if (!status)
        status = refine_base(renderer, plan, image, refine->in_place ? &in_place : kept, table, &first, stats, error);
    glint_image_release(kept);
    return status;
}

glint_status glint_render_instant(glint_renderer *renderer, const glint_plan *plan, glint_image **out,
                                  glint_frame_stats *stats, glint_error *error)
{
    const glint_render_desc *desc = &plan->desc;
    glint_image *image = NULL;
    const glint_tone_table *table = NULL;
    glint_frame_stats counted;
    if (atomic_load(renderer->stop))
        return glint_fail(error, GLINT_ERR_CANCELLED, "cancelled");
    if (unchanged(renderer, plan, out, stats))
        return GLINT_OK;
    glint_status status = take_image(renderer, desc, &image, error);
    if (!status && desc->codes)
        status = glint_tone_table_shared(&desc->tone, &table, error);
    if (!plan->base) {
        glint_renderer_destroy(renderer->base);
        renderer->base = NULL;
    }
    for (size_t i = 0; !status && plan->derivatives && i < plan->derivatives->count; i++)
        memcpy(image->derivative[i], plan->derivatives->of[i].name, sizeof image->derivative[i]);
    if (!status && plan->base)
        status = run_adaptive(renderer, plan, image, table, &counted, error);
    else if (!status)
        status = run(renderer, plan, image, NULL, table, &counted, error);
    if (status) {
        glint_image_release(image);
        return status;
    }
    remember(renderer, plan, image, &counted);
    if (stats)
        *stats = counted;
    *out = image;
    return GLINT_OK;
}

glint_status glint_render(glint_renderer *renderer, const glint_plan *plan, glint_image **out, glint_frame_stats *stats,
                          glint_error *error)
{
    const double *r = plan->desc.region;
    glint_image *whole = NULL, *part = NULL;
    glint_status status = plan->times ? glint_render_times(renderer, plan, &whole, stats, error)
                                      : glint_render_instant(renderer, plan, &whole, stats, error);
    if (!status && r[2] > 0) {
        status = glint_image_crop(whole, (int)r[0], (int)r[1], (int)r[2], (int)r[3], &part, error);
        glint_image_release(whole);
        whole = part;
    }
    if (!status && plan->overlays)
        status = glint_image_cover(whole, plan->overlays, (int)r[0], (int)r[1], &whole, error);
    if (!status)
        *out = whole;
    return status;
}
