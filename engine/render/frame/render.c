/// Renders a frame: its tiles on the worker pool, each walked through the plan's stages; progress and cancelling.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/glint_inspect.h"
#include "engine/render/frame/render.h"
#include "engine/render/frame/renderer.h"

#include <stdlib.h>
#include <string.h>

/// One call of glint_render.
typedef struct frame {
    glint_renderer *renderer;
    glint_tile_frame shared;
    glint_extent extent;
} frame;

static glint_renderer_desc defaults(void) { return (glint_renderer_desc) { 0 }; }

void glint_renderer_desc_init(glint_renderer_desc *desc, size_t size)
{
    const glint_renderer_desc full = defaults();
    glint_desc_write(desc, size, &full, sizeof full);
}

glint_status glint_renderer_create(const glint_renderer_desc *given, glint_renderer **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_renderer_desc, defaults());
    glint_renderer *renderer = calloc(1, sizeof *renderer);
    if (!renderer)
        return glint_fail_nomem(error);
    glint_tone_store_open();
    renderer->stop = &renderer->cancelled;
    renderer->grids = &renderer->own_grids;
    renderer->refine = &renderer->own_refine;
    renderer->time_stages = desc->time_stages;
    renderer->count_work = desc->count_work;
    glint_reuse_init(&renderer->reuse, !desc->no_reuse, desc->reuse_memory);
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

/// Frees the memory of a stage.
static void end_stage(glint_renderer *renderer, int id)
{
    if (renderer->own[id])
        glint_stage_table[id]->end(renderer);
    renderer->own[id] = NULL;
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
    glint_picture_forget(renderer);
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        end_stage(renderer, id);
    glint_grids_clear(&renderer->own_grids);
    glint_reuse_destroy(&renderer->reuse);
    if (!renderer->shares) {
        glint_pool_destroy(renderer->pool);
        glint_tone_store_close();
    }
    free(renderer);
}

const char *glint_renderer_isa(const glint_renderer *renderer) { return renderer ? renderer->stages->name : NULL; }

int glint_renderer_threads(const glint_renderer *renderer) { return renderer ? glint_pool_threads(renderer->pool) : 0; }

void glint_renderer_cache_hits(glint_renderer *renderer)
{
    if (renderer)
        renderer->reuse.is_eager = true;
}

void glint_renderer_cancel(glint_renderer *renderer)
{
    if (!renderer)
        return;
    atomic_store(&renderer->cancelled, true);
}

double glint_renderer_progress(const glint_renderer *renderer)
{
    if (!renderer)
        return 0;
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

/// Makes the stamp of each row of tiles from the stamps of its tiles.
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

/// Finishes the frame with the work that needs all tiles.
static void finish(frame *f)
{
    glint_tile_counts *counts = &f->renderer->tiles[0]->counts;
    for (int id = 0; id < GLINT_STAGE_COUNT; id++) {
        if (!f->shared.plan->runs[id] || !glint_stage_table[id]->finish || atomic_load(f->renderer->stop))
            continue;
        const uint64_t start = glint_tile_now_ns();
        glint_stage_table[id]->finish(f->renderer, &f->shared, &f->extent);
        counts->ns[id] += glint_tile_now_ns() - start;
        counts->runs[id]++;
    }
}

/// Prepares the geometry for the frame's rays, and the data of stages.
static glint_status prepare(glint_renderer *renderer, const glint_plan *plan, glint_tile_frame *shared,
                            size_t tile_count, glint_error *error)
{
    glint_status status = plan->needs_index
                              ? glint_geometry_index(plan->geometry, renderer->pool, &shared->geometry, error)
                              : glint_geometry_arrange(plan->geometry, &shared->geometry, error);
    if (status)
        return status;
    glint_reuse_carry(&renderer->reuse, plan, renderer->spare, GLINT_SPARE_IMAGES);
    glint_reuse_begin(&renderer->reuse, plan, tile_count);
    for (int i = 0; i < glint_pool_threads(renderer->pool); i++)
        renderer->tiles[i]->counts = (glint_tile_counts) { 0 };
    renderer->cast_ms = 0;
    for (int id = 0; id < GLINT_STAGE_COUNT && !status; id++) {
        if (!plan->runs[id])
            end_stage(renderer, id);
        else if (glint_stage_table[id]->begin)
            status = glint_stage_table[id]->begin(renderer, shared, error);
    }
    return status;
}

/// Returns whether an image has exactly these light passes. list: as in a plan's description.
static bool has_lights(const glint_image *image, const char *list)
{
    size_t i = 0;
    for (const char *at = list; at; i++) {
        const size_t length = strcspn(at, ",");
        if (i == image->light_count || strlen(image->light_name[i]) != length || strncmp(image->light_name[i], at, length) != 0)
            return false;
        at = at[length] ? at + length + 1 : NULL;
    }
    return i == image->light_count;
}

static bool has_format(const glint_image *image, const glint_render_desc *desc)
{
    uint32_t passes = 0;
    for (int pass = 0; pass < GLINT_PLANE_COUNT; pass++)
        passes |= (uint32_t)glint_image_has_pass(image, (glint_pass)pass) << pass;
    return image->width == (int)desc->width && image->height == (int)desc->height && passes == desc->passes &&
           image->alpha == desc->alpha && image->outline == desc->outline && (image->codes != NULL) == desc->codes &&
           (!desc->codes || glint_tone_same(&image->code_tone, &desc->tone)) && has_lights(image, desc->light_passes);
}

static frame frame_of(glint_renderer *renderer, const glint_plan *plan, glint_image *image, const glint_image *base,
                      const glint_tone_table *table)
{
    const glint_image *last = renderer->last.image;
    return (frame) { .renderer = renderer,
                     .shared = { .plan = plan,
                                 .stages = glint_stages_for(renderer->stages, plan->desc.precision == GLINT_PRECISION_FLOAT),
                                 .image = image,
                                 .last = last && has_format(last, &plan->desc) ? last : NULL,
                                 .tone_table = table,
                                 .gain = glint_tone_gain(&plan->desc.tone),
                                 .reuse = &renderer->reuse,
                                 .own = renderer->own,
                                 .base = base,
                                 .refine = renderer->refine,
                                 .cancelled = renderer->stop,
                                 .time_stages = renderer->time_stages,
                                 .count_work = renderer->count_work },
                     .extent = glint_plan_extent(&plan->desc) };
}

/// Prepares the data of tiles besides the picture's planes. `tiles`: number of tiles of the whole picture.
static glint_status begin_tiles(frame *f, size_t tiles, glint_error *error)
{
    glint_renderer *renderer = f->renderer;
    const glint_plan *plan = f->shared.plan;
    glint_image *image = f->shared.image;
    const int threads = glint_pool_threads(renderer->pool);
    glint_status status = prepare(renderer, plan, &f->shared, tiles, error);
    if (!status && plan->is_base)
        status = glint_refine_begin(renderer->refine, renderer->stages, image, &plan->desc, error);
    if (image->film && !renderer->reuse.tile_count) // stamps are not used
        memset(image->film, 0, tiles * sizeof *image->film);
    if (!status)
        status = glint_grids_begin(renderer->grids, &f->shared, &f->extent, threads, error);
    if (status)
        return status;
    if (renderer->reuse.tile_count && !image->film && !(image->film = calloc(tiles, sizeof *image->film)))
        return glint_fail_nomem(error);
    for (int i = 0; i < threads; i++)
        if (!glint_tile_extend(renderer->tiles[i], plan))
            return glint_fail_nomem(error);
    return GLINT_OK;
}

glint_status glint_renderer_run(glint_renderer *renderer, const glint_plan *plan, glint_image *image, const glint_image *base,
                                const glint_tone_table *table, glint_frame_stats *stats, glint_error *error)
{
    const double begin = glint_frame_now_ms();
    const uint32_t across = ((uint32_t)plan->desc.width + GLINT_TILE_WIDTH - 1) / GLINT_TILE_WIDTH;
    frame f = frame_of(renderer, plan, image, base, table);
    const size_t rendered = (size_t)f.extent.across * f.extent.down;
    const glint_status status = begin_tiles(&f, across * glint_image_stamps(image), error);
    if (status)
        return status;
    atomic_store(&renderer->tiles_done, 0);
    atomic_store(&renderer->tile_count, rendered);
    const double start = glint_frame_now_ms();
    glint_pool_run(renderer->pool, rendered, render_item, &f);
    finish(&f);
    glint_renderer_collect(renderer, plan, &f.extent, glint_frame_now_ms() - start + renderer->cast_ms, stats);
    stats->build_ms = start - begin - renderer->cast_ms;
    stats->shifted = plan->derivatives && plan->derivatives->moves ? glint_count_shifted(image, &f.extent) : 0;
    if (atomic_load(renderer->stop))
        return glint_fail(error, GLINT_ERR_CANCELLED, "cancelled");
    if (image->film)
        stamp_rows(image, across);
    return GLINT_OK;
}

glint_pool *glint_renderer_pool(const glint_renderer *renderer) { return renderer->pool; }

glint_status glint_renderer_take_image(glint_renderer *renderer, const glint_render_desc *desc, glint_image **out,
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

/// Returns the last picture if nobody else references it: unchanged tiles are then already in place. NULL: it is
/// referenced, or it has another format.
static glint_image *take_last(glint_renderer *renderer, const glint_plan *plan)
{
    glint_picture *last = &renderer->last;
    for (int i = 0; i < GLINT_SPARE_IMAGES && last->image && !plan->base; i++)
        if (renderer->spare[i] == last->image && has_format(last->image, &plan->desc) && atomic_load(&last->image->references) == 2) {
            last->key = (glint_key) { 0 }; // the picture is about to change
            return glint_image_retain(last->image);
        }
    return NULL;
}

glint_status glint_render_instant(glint_renderer *renderer, const glint_plan *plan, glint_image **out,
                                  glint_frame_stats *stats, glint_error *error)
{
    const glint_render_desc *desc = &plan->desc;
    const glint_tone_table *table = NULL;
    glint_frame_stats counted;
    if (atomic_load(renderer->stop))
        return glint_fail(error, GLINT_ERR_CANCELLED, "cancelled");
    if (glint_picture_give(renderer, plan, out, stats))
        return GLINT_OK;
    glint_image *image = take_last(renderer, plan);
    glint_status status = image ? GLINT_OK : glint_renderer_take_image(renderer, desc, &image, error);
    if (!status && desc->codes)
        status = glint_tone_table_shared(&desc->tone, &table, error);
    if (!plan->base) {
        glint_renderer_destroy(renderer->base);
        renderer->base = NULL;
    }
    for (size_t i = 0; !status && plan->derivatives && i < plan->derivatives->count; i++)
        memcpy(image->derivative[i], plan->derivatives->of[i].name, sizeof image->derivative[i]);
    if (!status && plan->base)
        status = glint_renderer_run_adaptive(renderer, plan, image, table, &counted, error);
    else if (!status)
        status = glint_renderer_run(renderer, plan, image, NULL, table, &counted, error);
    if (status) {
        glint_image_release(image);
        return status;
    }
    glint_picture_remember(renderer, plan, image, &counted);
    if (stats)
        *stats = counted;
    *out = image;
    return GLINT_OK;
}

/// Lays the plan's overlays over a picture. On failure the picture is released.
static glint_status cover(const glint_renderer *renderer, const glint_plan *plan, glint_image **image, glint_error *error)
{
    const int64_t *r = plan->desc.region;
    glint_cover *over = NULL;
    glint_status status = glint_cover_hide(renderer->stages, plan, &over, error);
    if (status)
        glint_image_release(*image);
    else
        status = glint_image_cover(*image, over, (int)r[0], (int)r[1], image, error);
    glint_cover_release(over);
    return status;
}

glint_status glint_render(glint_renderer *renderer, const glint_plan *plan, glint_image **out, glint_frame_stats *stats,
                          glint_error *error)
{
    GLINT_REFUSE_NULL(renderer, error);
    GLINT_REFUSE_NULL(plan, error);
    GLINT_REFUSE_NULL(out, error);
    const int64_t *r = plan->desc.region;
    glint_image *whole = NULL, *part = NULL;
    glint_status status = plan->times ? glint_stage_table[GLINT_STAGE_SHUTTER]->render(renderer, plan, &whole, stats, error)
                                      : glint_render_instant(renderer, plan, &whole, stats, error);
    if (!status && r[2] > 0) {
        status = glint_image_crop(whole, (int)r[0], (int)r[1], (int)r[2], (int)r[3], &part, error);
        glint_image_release(whole);
        whole = part;
    }
    if (!status && plan->cover)
        status = cover(renderer, plan, &whole, error);
    if (!status)
        *out = whole;
    return status;
}
