/// The walk of a tile: which stages run, in what order, and where their results go.
#include "engine/tile.h"
#include "engine/cull.h"

#include <string.h>

static void place(glint_tile *tile, const glint_plan *plan, uint32_t column, uint32_t row)
{
    const uint32_t width = (uint32_t)plan->desc.width, height = (uint32_t)plan->desc.height;
    tile->x0 = column * GLINT_TILE_WIDTH;
    tile->y0 = row * GLINT_TILE_HEIGHT;
    tile->width = width - tile->x0 < GLINT_TILE_WIDTH ? width - tile->x0 : GLINT_TILE_WIDTH;
    tile->height = height - tile->y0 < GLINT_TILE_HEIGHT ? height - tile->y0 : GLINT_TILE_HEIGHT;
    tile->groups_across = (tile->width + 3) / 4;
    tile->group_count = tile->groups_across * ((tile->height + 3) / 4);
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const uint32_t columns = tile->width - 4 * (g % tile->groups_across);
        const uint32_t rows = tile->height - 4 * (g / tile->groups_across);
        const uint32_t in_row = columns < 4 ? (1u << columns) - 1 : 15;
        const uint32_t in_rows = rows < 4 ? (1u << 4 * rows) - 1 : 0xffff;
        tile->active[g] = (uint16_t)(in_row * 0x1111 & in_rows);
    }
}

/// Points the sample's results at kept memory where this frame keeps them or has them, else at the tile's own. Memory is
/// asked for at the first sample alone: all samples of a tile are kept, or none.
static void find_geometry_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k, bool *cast_known,
                                 bool *surface_known)
{
    const glint_plan *plan = frame->plan;
    glint_reuse *reuse = frame->reuse;
    glint_kept_tile *kept = tile->kept;
    const size_t first = (size_t)k * GLINT_TILE_SAMPLES;
    *cast_known = kept && glint_key_equal(kept->cast, plan->keys[GLINT_STAGE_CAST]);
    *surface_known = kept && glint_key_equal(kept->surface, plan->keys[GLINT_STAGE_SURFACE]);
    tile->at.t = tile->t;
    tile->at.prim = tile->prim;
    tile->at.hits = tile->hits;
    tile->at.material = tile->material;
    if (*cast_known || (kept && reuse->keep_cast && (k ? kept->t != NULL : glint_reuse_hold_cast(reuse, kept)))) {
        tile->at.t = (char *)kept->t + first * reuse->real_size;
        tile->at.prim = kept->prim + first;
        tile->at.hits = kept->hits + first / GLINT_GROUP;
    }
    if (*surface_known ||
        (kept && reuse->keep_surface && (k ? kept->material != NULL : glint_reuse_hold_surface(reuse, kept))))
        tile->at.material = kept->material + first;
}

static void find_light_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k, uint32_t light,
                              uint32_t slot, bool *light_known, bool *occlude_known)
{
    const glint_plan_light *l = &frame->plan->lights[light];
    glint_reuse *reuse = frame->reuse;
    glint_kept_light *kept = tile->kept && light < reuse->light_count ? &tile->kept->lights[light] : NULL;
    glint_tile_light *own = &tile->lights[slot];
    const size_t first = (size_t)k * GLINT_TILE_SAMPLES;
    *light_known = kept && glint_key_equal(kept->light, l->key);
    *occlude_known = kept && l->shadows && glint_key_equal(kept->occlude, l->key);
    tile->at.light[slot].cosine = own->cosine;
    tile->at.light[slot].attenuation = own->attenuation;
    tile->at.light[slot].log2_specular = own->log2_specular;
    tile->at.light[slot].lit = own->lit;
    tile->at.light[slot].open = own->open;
    if (*light_known ||
        (kept && reuse->keep_light[light] && (k ? kept->cosine != NULL : glint_reuse_hold_light(reuse, kept)))) {
        tile->at.light[slot].cosine = kept->cosine + first;
        tile->at.light[slot].attenuation = kept->attenuation + first;
        tile->at.light[slot].log2_specular = kept->log2_specular + first;
        tile->at.light[slot].lit = kept->lit + first / GLINT_GROUP;
    }
    if (*occlude_known || (kept && l->shadows && reuse->keep_light[light] &&
                           (k ? kept->open != NULL : glint_reuse_hold_occlude(reuse, kept))))
        tile->at.light[slot].open = kept->open + first / GLINT_GROUP;
}

/// Writes down what the kept arrays hold now. After the last sample, since the keys cover all of them.
static void sign_kept(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const glint_reuse *reuse = frame->reuse;
    glint_kept_tile *kept = tile->kept;
    if (!kept)
        return;
    if (reuse->keep_cast && kept->t)
        kept->cast = plan->keys[GLINT_STAGE_CAST];
    if (reuse->keep_surface && kept->material)
        kept->surface = plan->keys[GLINT_STAGE_SURFACE];
    for (uint32_t i = 0; i < reuse->light_count; i++) {
        if (reuse->keep_light[i] && kept->lights[i].cosine)
            kept->lights[i].light = plan->lights[i].key;
        if (reuse->keep_light[i] && plan->lights[i].shadows && kept->lights[i].open)
            kept->lights[i].occlude = plan->lights[i].key;
    }
}

static bool any_hit(const glint_tile *tile)
{
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count; g++)
        any |= tile->at.hits[g];
    return any;
}

/// Rays, hits and, as soon as somebody needs them, points: of one sample.
typedef struct walk {
    uint32_t sample;
    bool rays, points; ///< made already
} walk;

static void need_rays(glint_tile *tile, const glint_tile_frame *frame, walk *w)
{
    if (!w->rays)
        glint_tile_make_rays(tile, frame, w->sample);
    w->rays = true;
}

static void need_points(glint_tile *tile, const glint_tile_frame *frame, walk *w)
{
    if (w->points)
        return;
    need_rays(tile, frame, w);
    glint_tile_find_surfaces(tile, frame);
    w->points = true;
}

/// Returns whether anything is hit.
static bool find_hits(glint_tile *tile, const glint_tile_frame *frame, walk *w)
{
    const glint_plan *plan = frame->plan;
    bool cast_known, surface_known;
    find_geometry_memory(tile, frame, w->sample, &cast_known, &surface_known);
    if (!plan->runs[GLINT_STAGE_CAST]) {
        memset(tile->at.hits, 0, sizeof tile->hits);
    } else if (cast_known) {
        glint_tile_book(tile, frame, GLINT_STAGE_CAST, true);
    } else {
        const double x[2] = { tile->x0, tile->x0 + tile->width }, y[2] = { tile->y0, tile->y0 + tile->height };
        need_rays(tile, frame, w);
        tile->candidate_count = glint_cull_primary(plan, x, y, tile->candidates);
        glint_tile_cast(tile, frame);
    }
    const bool any = any_hit(tile);
    if (any && (!surface_known || (w->sample == 0 && glint_tile_wants_geometry(plan))))
        need_points(tile, frame, w);
    else if (any)
        glint_tile_book(tile, frame, GLINT_STAGE_SURFACE, true);
    if (w->sample == 0 && glint_tile_wants_geometry(plan)) {
        need_rays(tile, frame, w);
        glint_tile_store_geometry(tile, frame);
    }
    return any;
}

/// What one light does to this sample.
static void find_light(glint_tile *tile, const glint_tile_frame *frame, walk *w, uint32_t index, uint32_t slot)
{
    const glint_plan_light *light = &frame->plan->lights[index];
    bool light_known, occlude_known;
    find_light_memory(tile, frame, w->sample, index, slot, &light_known, &occlude_known);
    if (light_known) {
        glint_tile_book(tile, frame, GLINT_STAGE_LIGHT, true);
    } else {
        need_points(tile, frame, w);
        glint_tile_shine(tile, frame, light, slot);
    }
    if (!light->shadows)
        return;
    if (occlude_known) {
        glint_tile_book(tile, frame, GLINT_STAGE_OCCLUDE, true);
    } else {
        need_points(tile, frame, w);
        glint_tile_occlude(tile, frame, light, slot);
    }
}

/// One sample of every pixel: hits, then the lights, a chunk at a time.
static void sample(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    walk w = { .sample = k };
    const uint32_t lights = find_hits(tile, frame, &w) ? frame->plan->light_count : 0;
    uint32_t from = 0;
    do {
        const uint32_t count = lights - from < GLINT_LIGHT_CHUNK ? lights - from : GLINT_LIGHT_CHUNK;
        for (uint32_t i = 0; i < count; i++)
            find_light(tile, frame, &w, from + i, i);
        glint_tile_shade(tile, frame, from, count);
        from += count;
    } while (from < lights && !glint_tile_cancelled(frame));
}

void glint_tile_render(glint_tile *tile, const glint_tile_frame *frame, uint32_t column, uint32_t row)
{
    const glint_plan *plan = frame->plan;
    const uint64_t start = glint_tile_now_ns();
    const uint32_t across = ((uint32_t)plan->desc.width + GLINT_TILE_WIDTH - 1) / GLINT_TILE_WIDTH;
    tile->clock = start;
    tile->kept = frame->reuse->tile_count ? &frame->reuse->tiles[(size_t)row * across + column] : NULL;
    place(tile, plan, column, row);
    if (plan->accumulate)
        memset(tile->sum, 0, sizeof tile->sum);
    for (uint32_t k = 0; k < (uint32_t)plan->desc.samples; k++) {
        sample(tile, frame, k);
        if (glint_tile_cancelled(frame))
            return;
    }
    sign_kept(tile, frame);
    if (plan->accumulate)
        glint_tile_resolve(tile, frame);
    glint_tile_store_light(tile, frame);
    const uint64_t rendered = glint_tile_now_ns();
    if (plan->runs[GLINT_STAGE_TONE]) {
        glint_tile_tone(tile, frame);
        tile->counts.runs[GLINT_STAGE_TONE]++;
    }
    const uint64_t done = glint_tile_now_ns();
    tile->counts.ns[GLINT_STAGE_TONE] += done - rendered;
    tile->counts.tile_ns += done - start;
}
