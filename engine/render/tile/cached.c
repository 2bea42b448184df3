/// The cache of a tile for later frames: its results, the materials and lights that it shows, and the keys of both.
#include "engine/base/alloc.h"
#include "engine/render/tile/tile.h"

#include <math.h>

// ---- Its pixels ----

/// Returns a hash of which pixels of the tile get all samples; 0 if all of them do.
static uint64_t pixels_of(const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_key none = { 0 };
    if (!frame->base)
        return 0;
    const uint32_t *chosen = frame->refine->tiles[tile->index].chosen;
    return glint_key_add(none, chosen, GLINT_TILE_HEIGHT * sizeof *chosen).low | 1;
}

static void forget(glint_cached_tile *cached, uint32_t light_count)
{
    const glint_key none = { 0 };
    cached->cast = cached->view = cached->pattern = cached->split = cached->seen = cached->boxed = none;
    for (uint32_t i = 0; i < light_count; i++) {
        glint_cached_light *light = &cached->lights[i];
        light->light = light->facet = light->occlude = light->position = none;
    }
}

/// Returns whether hits and lights equal those of the last frame, so that at most shading has to run.
static bool is_settled(const glint_reuse *reuse, const glint_plan *plan)
{
    bool settled = reuse->caches_cast && plan->light_count == reuse->light_count;
    for (uint32_t i = 0; i < reuse->light_count; i++)
        settled = settled && reuse->caches_light[i];
    return settled;
}

bool glint_tile_may_gather(const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    if (!frame->base || !plan->local || plan->runs[GLINT_STAGE_PATTERN] || plan->camera.orthographic || plan->lens ||
        plan->desc.passes & GLINT_LIGHT_PASSES || glint_tile_wants_coverage(plan) || frame->caster)
        return false;
    for (uint32_t i = 0; i < plan->light_count; i++)
        if (plan->lights[i].light_samples) // which sample is taken depends on the lane
            return false;
    return true;
}

bool glint_tile_has_chosen(const glint_tile *tile, const glint_tile_frame *frame)
{
    const uint32_t *chosen = frame->refine->tiles[tile->index].chosen;
    uint32_t any = 0;
    for (uint32_t y = 0; y < tile->height; y++)
        any |= chosen[y];
    return any;
}

void glint_tile_fit_cached(glint_tile *tile, const glint_tile_frame *frame)
{
    glint_cached_tile *cached = tile->cached;
    const uint64_t pixels = pixels_of(tile, frame);
    if (!cached)
        return;
    if (pixels && glint_tile_may_gather(frame) && !is_settled(frame->reuse, frame->plan)) {
        tile->cached = NULL;
        return;
    }
    const bool again = !pixels || cached->last_pixels == pixels;
    cached->last_pixels = pixels;
    if (cached->pixels == pixels)
        return;
    if (again) {
        forget(cached, frame->reuse->light_count);
        cached->pixels = pixels;
    } else
        tile->cached = NULL;
}

// ---- Memory of results ----

/// Prefetches the first row of the tile's pixel values in the last picture.
static void prefetch_last_codes(const glint_tile *tile, const glint_image *last)
{
    const size_t pixel = glint_image_pixel_bytes(last);
    glint_prefetch((const char *)last->codes + (tile->y0 * (size_t)last->width + tile->x0) * pixel, tile->width * pixel);
}

/// Returns whether the tile may show a material with highlights.
static bool may_shine(const glint_cached_tile *cached, const glint_plan *plan)
{
    if (!plan->powers || !glint_key_equal(cached->seen, plan->keys[GLINT_STAGE_SURFACE]))
        return plan->powers; // the materials in the cached tile are unknown
    bool shines = cached->shown_count > GLINT_SHOWN_MAX;
    for (uint32_t i = 0; !shines && i < cached->shown_count; i++)
        shines = plan->materials[cached->shown[i]].highlight;
    return shines;
}

void glint_tile_prefetch(const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const glint_reuse *reuse = frame->reuse;
    const glint_cached_tile *cached = tile->cached;
    bool points = false;
    if (tile->index + 1 < reuse->tile_count)
        glint_prefetch(cached + 1, sizeof *cached); // prefetched, not read: it may belong to another worker
    if (!glint_key_equal(cached->cast, plan->keys[GLINT_STAGE_CAST]))
        return;
    glint_prefetch(cached->hits, GLINT_TILE_GROUPS * sizeof *cached->hits);
    const bool shines = may_shine(cached, plan);
    for (uint32_t i = 0; i < reuse->light_count; i++) {
        const glint_cached_light *light = &cached->lights[i];
        if (!glint_key_equal(light->light, plan->lights[i].key)) {
            points = true;
            continue;
        }
        glint_prefetch(light->cosine, GLINT_TILE_SAMPLES * sizeof *light->cosine);
        if (shines)
            glint_prefetch(light->log2_specular, GLINT_TILE_SAMPLES * sizeof *light->log2_specular);
    }
    if (points)
        glint_prefetch(cached->t, GLINT_TILE_SAMPLES * reuse->real_size);
    if (cached->only == GLINT_MISS) // the single primitive gives the materials
        glint_prefetch(cached->prim, GLINT_TILE_SAMPLES * sizeof *cached->prim);
    if (glint_splits_are_on(&reuse->splits) && glint_key_equal(cached->split, reuse->splits.key))
        glint_prefetch(cached->values, glint_splits_bytes(&reuse->splits));
    if (frame->last && frame->last != frame->image && frame->last->codes) // the first row often differs: see glint_tile_has_codes_of
        prefetch_last_codes(tile, frame->last);
}

/// Sets the sample's results to cache memory if this frame stores or reads them there, otherwise to the tile's own.
/// Memory is allocated only at the first sample: all samples of a tile are cached, or none. Returns whether the hits
/// are known.
bool glint_tile_hit_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    glint_reuse *reuse = frame->reuse;
    glint_cached_tile *cached = tile->cached;
    const size_t first = (size_t)k * GLINT_TILE_SAMPLES;
    const bool known = cached && glint_key_equal(cached->cast, frame->plan->keys[GLINT_STAGE_CAST]);
    tile->at.box = NULL;
    tile->at.t = tile->hit.t;
    tile->at.prim = tile->hit.prim;
    tile->at.hits = tile->hit.mask;
    tile->at.sampled = tile->hit.mask;
    if (known || (cached && reuse->caches_cast && (k ? cached->t != NULL : glint_reuse_hold_cast(reuse, cached)))) {
        tile->at.t = (char *)cached->t + first * reuse->real_size;
        tile->at.prim = cached->prim + first;
        tile->at.hits = cached->hits + first / GLINT_GROUP;
        tile->at.sampled = tile->at.hits;
    }
    return known;
}

static bool has_occlude(const glint_cached_light *cached, const glint_plan_light *light)
{
    return cached->unoccluded && (cached->visible || !light->cap);
}

void glint_tile_use_own_light(glint_tile *tile, uint32_t slot)
{
    glint_tile_light *own = &tile->lights[tile->own_lights + slot];
    tile->at.light[slot].cosine = own->cosine;
    tile->at.light[slot].attenuation = own->attenuation;
    tile->at.light[slot].log2_specular = own->log2_specular;
    tile->at.light[slot].lit = own->lit;
    tile->at.light[slot].unoccluded = own->unoccluded;
    tile->at.light[slot].visible = own->visible;
    tile->at.light[slot].brightest = GLINT_NO_SPECULAR;
    tile->at.light[slot].summed = false;
}

void glint_tile_light_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k, uint32_t light, uint32_t slot,
                             bool *light_known, bool *occlude_known)
{
    const glint_plan_light *l = &frame->plan->lights[light];
    glint_reuse *reuse = frame->reuse;
    glint_cached_light *cached = tile->cached && light < reuse->light_count ? &tile->cached->lights[light] : NULL;
    const size_t first = (size_t)k * GLINT_TILE_SAMPLES;
    *light_known = cached && glint_key_equal(cached->light, l->key);
    *occlude_known = cached && l->shadows && glint_key_equal(cached->occlude, l->key);
    glint_tile_use_own_light(tile, slot);
    if (*light_known || (cached && reuse->caches_light[light] &&
                         (k ? cached->cosine != NULL : glint_reuse_hold_light(reuse, cached)))) {
        tile->at.light[slot].cosine = cached->cosine + first;
        tile->at.light[slot].attenuation = cached->attenuation + first;
        tile->at.light[slot].log2_specular = cached->log2_specular + first;
        tile->at.light[slot].lit = cached->lit + first / GLINT_GROUP;
        tile->at.light[slot].brightest = cached->cached_brightest;
    }
    if (*occlude_known || (cached && l->shadows && reuse->caches_light[light] &&
                           (k ? has_occlude(cached, l) : glint_reuse_hold_occlude(reuse, cached, l->cap)))) {
        tile->at.light[slot].unoccluded = cached->unoccluded + first / GLINT_GROUP;
        if (l->cap)
            tile->at.light[slot].visible = cached->visible + first;
    }
}

/// Sets the keys of the cached arrays. Called after the last sample, because the keys cover all samples.
void glint_tile_sign_cached(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const glint_reuse *reuse = frame->reuse;
    glint_cached_tile *cached = tile->cached;
    if (!cached)
        return;
    if (reuse->caches_cast && cached->t && !glint_key_equal(cached->cast, plan->keys[GLINT_STAGE_CAST]))
        cached->cast = plan->keys[GLINT_STAGE_CAST];
    for (uint32_t i = 0; i < reuse->light_count; i++) {
        if (reuse->caches_light[i] && cached->lights[i].cosine) {
            cached->lights[i].light = plan->lights[i].key;
            cached->lights[i].cached_brightest = cached->lights[i].brightest;
        }
        if (reuse->caches_light[i] && plan->lights[i].shadows && has_occlude(&cached->lights[i], &plan->lights[i]))
            cached->lights[i].occlude = plan->lights[i].key;
    }
    glint_tile_step(tile, frame, GLINT_AT_KEYS, NULL);
}

// ---- Contents of the tile ----

/// Returns whether the light of this primitive is computed per face or vertex.
static bool has_shading_points(const glint_prim *prim)
{
    return prim->kind == GLINT_PRIM_TRIANGLE && prim->shading_points != GLINT_MISS;
}

static void note_material(glint_cached_tile *cached, uint32_t material)
{
    for (uint32_t i = 0; i < cached->shown_count && i < GLINT_SHOWN_MAX; i++)
        if (cached->shown[i] == material)
            return;
    if (cached->shown_count < GLINT_SHOWN_MAX)
        cached->shown[cached->shown_count] = material;
    if (cached->shown_count <= GLINT_SHOWN_MAX)
        cached->shown_count++;
}

/// Records a sample's materials, and whether it shows background.
void glint_tile_note_surfaces(const glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    glint_cached_tile *cached = tile->cached;
    if (k == 0) {
        cached->shown_count = 0;
        cached->background = cached->shading_points = false;
    }
    uint32_t last = k ? cached->only : GLINT_MISS;
    bool several = k && cached->only == GLINT_MISS;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const uint32_t prim = tile->at.prim[i];
        if (prim == last || prim == GLINT_MISS)
            continue;
        note_material(cached, frame->geometry.prims[prim].material);
        cached->shading_points = cached->shading_points || has_shading_points(&frame->geometry.prims[prim]);
        several = several || last != GLINT_MISS;
        last = prim;
    }
    cached->only = several ? GLINT_MISS : last;
    for (uint32_t g = 0; g < tile->group_count; g++)
        cached->background = cached->background || tile->at.hits[g] != tile->active[g];
}

/// Records whether a light reaches any point of a sample, and the largest possible highlight there.
void glint_tile_note_light(const glint_tile *tile, uint32_t index, uint32_t slot, bool shadows, uint32_t k)
{
    glint_cached_light *cached = &tile->cached->lights[index];
    const uint16_t *lanes = shadows ? tile->at.light[slot].unoccluded : tile->at.light[slot].lit;
    const bool any = glint_has_lanes(lanes, tile->group_count);
    cached->reaches = (k && cached->reaches) || any;
    cached->brightest = fmaxf(k ? cached->brightest : GLINT_NO_SPECULAR, tile->at.light[slot].brightest);
}

/// Records the materials of a sample without any hit.
void glint_tile_note_nothing(const glint_tile *tile, uint32_t k)
{
    if (k == 0) {
        tile->cached->shown_count = 0;
        tile->cached->only = GLINT_MISS;
    }
    tile->cached->background = true;
}

void glint_tile_cache_box(glint_tile *tile, const glint_tile_frame *frame, const glint_point_box *box)
{
    glint_cached_tile *cached = tile->cached;
    const glint_key surface = frame->plan->keys[GLINT_STAGE_SURFACE];
    if (!cached || tile->boxed != tile->sample || glint_key_equal(cached->boxed, surface))
        return;
    if (tile->sample == 0) {
        cached->boxed = (glint_key) { 0 }; // until all samples are in; some may not compute points
        cached->box = (glint_point_box) { { HUGE_VAL, HUGE_VAL, HUGE_VAL }, { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL }, 0 };
    }
    for (int c = 0; c < 3 && box; c++) {
        cached->box.lower[c] = fmin(cached->box.lower[c], box->lower[c]);
        cached->box.upper[c] = fmax(cached->box.upper[c], box->upper[c]);
    }
    cached->box.only = box && frame->plan->desc.samples == 1 ? box->only : GLINT_MISS;
    if (++tile->boxed == (uint32_t)frame->plan->desc.samples)
        cached->boxed = surface;
}

// ---- The tile's pixels ----

static bool is_known(glint_key key) { return !glint_key_equal(key, (glint_key) { 0 }); }

/// Returns a stamp of the pixels taken from the base and of those with all samples; 0: unknown.
static uint64_t base_stamp(const glint_tile *tile, const glint_tile_frame *frame)
{
    const uint64_t base = frame->base->film ? frame->base->film[tile->index].base : 0;
    const glint_key from = { base, 0 }, chosen = { pixels_of(tile, frame), 0 };
    return base ? glint_key_mix(from, chosen).low | 1 : 0;
}

/// Returns the stamp of the tile's pixels. The key is all zero if their inputs are unknown.
static glint_film_stamp stamp_of(const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_key base_alone = { 1, 0 };
    glint_film_stamp stamp = { .key = { 0 } };
    if (frame->base && !(stamp.base = base_stamp(tile, frame)))
        return stamp;
    stamp.key = !frame->base || glint_tile_has_chosen(tile, frame)
                    ? glint_reuse_film_key(frame->reuse, tile->cached, frame->plan)
                    : base_alone;
    if (is_known(stamp.key))
        stamp.codes = stamp.key.low ^ stamp.base;
    if (frame->plan->is_base)
        stamp.base = stamp.key.low;
    return stamp;
}

static bool are_like(const glint_film_stamp *a, const glint_film_stamp *b)
{
    return glint_key_equal(a->key, b->key) && a->base == b->base;
}

/// Returns whether the tile's pixels equal those of the last picture. They are then copied, unless this picture's
/// memory has them already.
bool glint_tile_is_unchanged(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const glint_image *last = frame->last;
    if (!tile->cached || !last || !last->film)
        return false;
    const glint_film_stamp *was = &last->film[tile->index];
    glint_film_stamp now = stamp_of(tile, frame);
    if (plan->is_base && was->base != frame->refine->tiles[tile->index].pixels)
        return false;
    if (plan->is_base) // `base` belongs to the stamp of the pixels, not to this frame's key
        now.base = was->base;
    if (!is_known(now.key) || !are_like(&now, was))
        return false;
    if (!are_like(&now, &frame->image->film[tile->index]))
        glint_tile_copy(tile, frame, last);
    frame->image->film[tile->index] = last->film[tile->index];
    tile->counts.clipped += tile->cached->clipped;
    tile->counts.nonfinite += tile->cached->nonfinite;
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        if (plan->runs[id])
            tile->counts.reuses[id] += glint_stage_table[id]->per_light ? plan->light_count : 1;
    return true;
}

void glint_tile_sign_film(glint_tile *tile, const glint_tile_frame *frame, glint_film_counts before, bool sampled)
{
    glint_cached_tile *cached = tile->cached;
    if (!cached)
        return;
    if (sampled)
        cached->seen = frame->plan->keys[GLINT_STAGE_SURFACE];
    for (uint32_t i = 0; sampled && i < frame->reuse->light_count && cached->shown_count > 0; i++)
        cached->lights[i].position = frame->plan->lights[i].position_key;
    glint_film_stamp stamp = stamp_of(tile, frame);
    const bool has_last = frame->last && frame->last != frame->image && frame->last->film; // pixel values still there
    const glint_film_stamp *last = has_last ? &frame->last->film[tile->index] : NULL;
    const bool moved = tile->counts.runs[GLINT_STAGE_LIGHT] != before.lights; // then pixel values rarely stay the same
    if (last && last->codes && !moved && glint_tile_has_codes_of(tile, frame->image, frame->last))
        stamp.codes = last->codes;
    frame->image->film[tile->index] = stamp;
    if (frame->plan->is_base)
        frame->refine->tiles[tile->index].pixels = stamp.base;
    cached->clipped = tile->counts.clipped - before.clipped;
    cached->nonfinite = tile->counts.nonfinite - before.nonfinite;
}
