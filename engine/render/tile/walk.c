/// The walk of a tile: runs the stages in their order.
#include "engine/render/pattern/pattern.h"

#include <string.h>

#define TIMED_TILES 17 ///< one of this many tiles is timed; not a divisor of common picture widths in tiles

// ---- A sample ----

/// Computes the points of the listed lanes only, because their programs read no other lanes.
static void need_painted(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *w)
{
    uint16_t painted[GLINT_TILE_GROUPS];
    glint_tile_need_rays(tile, frame, w);
    glint_tile_painted_lanes(tile, painted);
    glint_tile_find_points(tile, frame, painted);
}

/// Runs the programs of the visible materials.
static void find_patterns(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *w)
{
    const bool normals = glint_pattern_needs_normals(frame->plan) || frame->geometry.triangles || frame->geometry.solids;
    if (w->patterns || !frame->plan->runs[GLINT_STAGE_PATTERN])
        return;
    w->patterns = true;
    if (glint_tile_pattern_memory(tile, frame, w->sample)) {
        glint_tile_count_stage(tile, frame, GLINT_STAGE_PATTERN, true);
        return;
    }
    if (!glint_tile_find_painted(tile, frame) || glint_tile_recall_pattern(tile, frame, w->sample))
        return;
    if (!w->lit && !w->points && normals) {
        glint_tile_need_points(tile, frame, w);
        glint_tile_find_painted(tile, frame); // bumps make their own lists
    } else if (!w->lit && !w->points)
        need_painted(tile, frame, w);
    glint_tile_cache_pattern(tile, frame, w->sample);
}

/// Returns whether this walk stores the picture's geometry: the walk through the pixels' centres, or sample 0 if it
/// is the same ray.
static bool shows_geometry(const glint_tile_frame *frame, const glint_sample_walk *w)
{
    if (w->sample > 0 || !glint_tile_wants_geometry(frame->plan))
        return false;
    return glint_plan_casts_centres(frame->plan) ? w->centres : !frame->base;
}

/// Returns whether the fused surface-and-light kernel applies: one point or directional light and no bumps. When
/// stages are timed, each runs separately.
static bool is_plain(const glint_tile_frame *frame, const glint_sample_walk *w)
{
    const glint_plan *plan = frame->plan;
    return !w->points && !frame->time_stages && !glint_plan_bumps(plan) && plan->light_count == 1 &&
           !plan->lights[0].light_samples && !plan->lights[0].is_spot;
}

/// Stores the picture's geometry if this walk has it.
static void store_geometry(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *w, bool any)
{
    if (!w->shows)
        return;
    if (any)
        glint_tile_need_points(tile, frame, w);
    if (any && frame->plan->desc.passes >> GLINT_PASS_ALBEDO & 1)
        find_patterns(tile, frame, w);
    glint_tile_store_geometry(tile, frame);
    w->shows = false;
}

/// Casts the rays. Returns whether anything is hit.
static bool find_hits(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *w)
{
    const glint_plan *plan = frame->plan;
    const bool known = glint_tile_hit_memory(tile, frame, w->sample);
    if (!plan->runs[GLINT_STAGE_CAST]) {
        memset(tile->at.hits, 0, tile->group_count * sizeof *tile->at.hits);
    } else if (known) {
        glint_tile_count_stage(tile, frame, GLINT_STAGE_CAST, true);
    } else {
        if (!w->rays && glint_tile_in_sight(tile, frame))
            glint_tile_need_rays(tile, frame, w);
        glint_tile_cast(tile, frame);
    }
    glint_tile_step(tile, frame, GLINT_AT_HITS, w);
    const bool any = w->any = glint_has_lanes(tile->at.hits, tile->group_count);
    if (!any)
        glint_tile_cache_box(tile, frame, NULL);
    if (tile->cached && !glint_key_equal(tile->cached->seen, plan->keys[GLINT_STAGE_SURFACE])) {
        if (any)
            glint_tile_note_surfaces(tile, frame, w->sample);
        else
            glint_tile_note_nothing(tile, w->sample);
    }
    tile->at.only = tile->cached && tile->cached->only != GLINT_MISS ? &tile->cached->only : NULL;
    if (glint_tile_wants_coverage(plan))
        glint_tile_count_hits(tile, plan, w->sample);
    w->shows = shows_geometry(frame, w);
    if (w->shows && !(any && is_plain(frame, w)))
        store_geometry(tile, frame, w, any);
    return any;
}

/// Returns whether the fused kernel should also write normals: if a later stage is likely to read them, and for
/// triangles and solids, where they cost little.
static bool wants_normals(const glint_tile_frame *frame, const glint_sample_walk *w)
{
    const glint_plan *plan = frame->plan;
    return w->shows || plan->reads_normals || glint_pattern_needs_normals(plan) || frame->geometry.triangles ||
           frame->geometry.solids;
}

/// The slots of lights that still need the stages light (`shine`) and `occlude`.
typedef struct light_work {
    uint32_t shine[GLINT_LIGHT_CHUNK], occlude[GLINT_LIGHT_CHUNK], shining, occluding;
} light_work;

/// Returns the work for `count` rows of the plan from `first + slot` on.
static light_work find_light_work(glint_tile *tile, const glint_tile_frame *frame, const glint_sample_walk *w, uint32_t first,
                                  uint32_t slot, uint32_t count)
{
    light_work work = { .shining = 0 };
    for (uint32_t i = slot; i < slot + count; i++) {
        const bool shadows = frame->plan->lights[first + i].shadows;
        bool light_known, occlude_known;
        glint_tile_light_memory(tile, frame, w->sample, first + i, i, &light_known, &occlude_known);
        if (light_known)
            glint_tile_count_stage(tile, frame, GLINT_STAGE_LIGHT, true);
        else
            work.shine[work.shining++] = i;
        if (shadows && occlude_known)
            glint_tile_count_stage(tile, frame, GLINT_STAGE_OCCLUDE, true);
        else if (shadows)
            work.occlude[work.occluding++] = i;
    }
    return work;
}

/// Computes light and shadow of one light, or of similar lights, for this sample: `count` rows of the plan from
/// `first + slot` on.
static void find_light(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *w, uint32_t first, uint32_t slot,
                       uint32_t count)
{
    const glint_plan_light *lights = &frame->plan->lights[first];
    light_work work = find_light_work(tile, frame, w, first, slot, count);
    if (work.shining && is_plain(frame, w)) {
        const bool normals = wants_normals(frame, w);
        glint_tile_need_rays(tile, frame, w);
        glint_tile_find_lit_surfaces(tile, frame, first, normals);
        w->lit = true;
        w->points = normals;
    } else {
        if (work.shining || work.occluding)
            glint_tile_need_points(tile, frame, w);
        if (work.shining == count && glint_tile_sum_light(tile, frame, first, slot, count))
            work.occluding = 0;
        else if (work.shining)
            glint_tile_shine(tile, frame, first, work.shine, work.shining);
    }
    if (work.occluding)
        glint_tile_occlude(tile, frame, first, work.occlude, work.occluding);
    const uint32_t together = lights[slot].light_samples ? count : 1;
    for (w->slot = slot, w->count = together; w->slot < slot + count; w->slot += together)
        glint_tile_step(tile, frame, GLINT_AT_LIGHT, w);
    for (uint32_t i = slot; i < slot + count; i++)
        if (tile->cached && first + i < frame->reuse->light_count)
            glint_tile_note_light(tile, first + i, i, lights[i].shadows, w->sample);
}

/// Computes a chunk of lights. The samples of one light are computed together, and so are similar lights.
static void find_lights(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *w, uint32_t first, uint32_t count)
{
    for (uint32_t slot = 0, next; slot < count; slot = next) {
        const glint_plan_light *lights = &frame->plan->lights[first];
        for (next = slot + 1; next < count && (lights[next].joined || lights[next].same_but_position); next++)
            continue;
        find_light(tile, frame, w, first, slot, next - slot);
    }
}

/// Finds the materials and points that shading a chunk of lights needs and that are not yet known.
static void need_shading(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *w, bool any, bool lit, uint32_t from)
{
    if (from == 0 && any && !w->points && !w->lit) {
        glint_tile_count_stage(tile, frame, GLINT_STAGE_SURFACE, true);
        glint_tile_name_materials(tile, frame);
    }
    if (any)
        find_patterns(tile, frame, w);
    const bool inside = frame->plan->absorbs_transmitted; // to find points inside an absorbing medium
    if (lit && !w->points && (inside || glint_tile_shows_shader(tile, frame->plan)))
        glint_tile_need_points(tile, frame, w);
}

/// Renders one sample of every pixel: hits, then the lights, a chunk at a time.
static void sample(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    glint_sample_walk w = { .sample = k };
    if (k == 0)
        tile->boxed = tile->painted = tile->cached_samples = 0;
    tile->own_lights = frame->plan->together ? k * frame->plan->light_count : 0;
    glint_tile_aim(tile, frame, k);
    tile->own_planes = frame->plan->together ? k : 0;
    glint_pattern_point(tile->pattern, tile, GLINT_WALK_EYE);
    w.shines = find_hits(tile, frame, &w);
    glint_tile_step(tile, frame, GLINT_AFTER_PRIMARY, &w);
    const uint32_t lights = w.shines ? frame->plan->light_count : 0;
    uint32_t from = 0;
    if (w.shines)
        glint_tile_step(tile, frame, GLINT_AT_LIT, &w);
    do {
        const uint32_t count = lights - from < GLINT_LIGHT_CHUNK ? lights - from : GLINT_LIGHT_CHUNK;
        w.from = from;
        find_lights(tile, frame, &w, from, count);
        store_geometry(tile, frame, &w, w.any);
        need_shading(tile, frame, &w, w.any, w.shines, from);
        w.count = count;
        if (frame->plan->together)
            glint_tile_remember_sample(tile, frame, count);
        else
            glint_tile_shade(tile, frame, from, count);
        glint_tile_step(tile, frame, GLINT_AT_SHADED, &w);
        from += count;
    } while (from < lights && !glint_tile_cancelled(frame));
    glint_tile_step(tile, frame, GLINT_AFTER_LIGHTS, &w);
    glint_tile_step(tile, frame, GLINT_AT_SUMMED, &w);
}

/// Renders some samples, from number `first` on, of `count` gathered pixels.
static void sample_gathered(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *slots, uint32_t count,
                            uint32_t first)
{
    const uint32_t remaining = (uint32_t)frame->plan->desc.samples - first,
                   most = glint_tile_gathered_samples(frame->plan);
    const uint32_t samples = remaining < most ? remaining : most;
    glint_sample_walk w = { .rays = true, .gathered = true };
    tile->own_lights = 0;
    glint_tile_gather(tile, frame, slots, count, first, samples);
    w.shines = find_hits(tile, frame, &w);
    glint_tile_step(tile, frame, GLINT_AFTER_PRIMARY, &w);
    const uint32_t lights = w.shines ? frame->plan->light_count : 0;
    find_lights(tile, frame, &w, 0, lights);
    need_shading(tile, frame, &w, w.any, w.shines, 0);
    glint_tile_step(tile, frame, GLINT_AFTER_LIGHTS, &w);
    glint_tile_shade_gathered(tile, frame, lights, slots, count, first, samples);
}

/// Renders all samples of gathered pixels.
static void take_gathered(glint_tile *tile, const glint_tile_frame *frame, const uint16_t *slots, uint32_t count)
{
    const uint32_t most = glint_tile_most_gathered(frame->plan), samples = (uint32_t)frame->plan->desc.samples;
    for (uint32_t i = 0; i < count; i += most)
        for (uint32_t k = 0; k < samples && !glint_tile_cancelled(frame); k += glint_tile_gathered_samples(frame->plan))
            sample_gathered(tile, frame, slots + i, count - i < most ? count - i : most, k);
}

/// Renders all samples of the active pixels. Returns false when cancelled.
static bool take_samples(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    uint16_t slots[GLINT_TILE_SAMPLES];
    const uint32_t gathered = glint_tile_list_gathered(tile, frame, slots);
    take_gathered(tile, frame, slots, gathered);
    for (uint32_t k = 0; !gathered && k < (uint32_t)plan->desc.samples && !glint_tile_cancelled(frame); k++)
        sample(tile, frame, k);
    if (glint_tile_cancelled(frame))
        return false;
    glint_tile_step(tile, frame, GLINT_AT_DONE, NULL);
    if (plan->together && !gathered)
        glint_tile_resolve_samples(tile, frame);
    else if (plan->accumulate && !gathered && !tile->direct)
        glint_tile_resolve(tile, frame);
    return true;
}

/// Stores the geometry seen by a pinhole in the middle of the lens through the pixels' centres. Nothing is cached.
static void find_geometry(glint_tile *tile, const glint_tile_frame *frame)
{
    glint_cached_tile *cached = tile->cached;
    glint_sample_walk w = { .sample = 0, .centres = true };
    tile->cached = NULL;
    glint_tile_aim(tile, frame, 0);
    glint_plan_centre_offset(frame->plan, tile->camera.offset);
    tile->camera.lens = NULL;
    glint_pattern_point(tile->pattern, tile, GLINT_WALK_EYE);
    store_geometry(tile, frame, &w, find_hits(tile, frame, &w));
    tile->cached = cached;
}

/// Returns the current time for timed tiles, otherwise 0. If stages are not timed, a few tiles give the share of tone.
static uint64_t clock_of(const glint_tile *tile, const glint_tile_frame *frame)
{
    return frame->time_stages || tile->index % TIMED_TILES == 0 ? glint_tile_now_ns() : 0;
}

static void tone(glint_tile *tile, const glint_tile_frame *frame)
{
    const uint64_t start = clock_of(tile, frame);
    if (!frame->plan->runs[GLINT_STAGE_TONE])
        return;
    glint_tile_tone(tile, frame);
    tile->counts.runs[GLINT_STAGE_TONE]++;
    tile->counts.ns[GLINT_STAGE_TONE] += clock_of(tile, frame) - start;
}

/// Prepares the cache of the tile, before its first sample.
static void begin_cached(glint_tile *tile, const glint_tile_frame *frame)
{
    if (tile->cached)
        frame->image->film[tile->index] = (glint_film_stamp) { 0 };
    glint_tile_fit_cached(tile, frame);
    if (tile->cached)
        glint_tile_prefetch(tile, frame);
}

/// Runs every stage that the tile needs.
static void run_stages(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const glint_film_counts before = { .clipped = tile->counts.clipped,
                                       .nonfinite = tile->counts.nonfinite,
                                       .lights = tile->counts.runs[GLINT_STAGE_LIGHT] };
    tile->direct = false;
    if (glint_tile_wants_geometry(plan) && glint_plan_casts_centres(plan))
        find_geometry(tile, frame);
    const bool refined = !frame->base || glint_tile_choose_refined(tile, frame);
    if (refined)
        begin_cached(tile, frame);
    glint_tile_prefetch_output(tile, frame);
    if (plan->is_base)
        glint_tile_prefetch_borders(tile, frame->refine);
    if (refined && !take_samples(tile, frame))
        return;
    if (refined)
        glint_tile_sign_cached(tile, frame);
    glint_tile_step(tile, frame, GLINT_AT_STORE, NULL);
    if (frame->base)
        glint_tile_take_base(tile, frame);
    glint_tile_store_light(tile, frame);
    tone(tile, frame);
    if (plan->is_base)
        glint_tile_compare(tile, frame, before);
    glint_tile_sign_film(tile, frame, before, refined);
}

void glint_tile_render(glint_tile *tile, const glint_tile_frame *frame, uint32_t column, uint32_t row)
{
    const glint_plan *plan = frame->plan;
    const uint32_t across = ((uint32_t)plan->desc.width + GLINT_TILE_WIDTH - 1) / GLINT_TILE_WIDTH;
    tile->index = (size_t)row * across + column;
    const uint64_t start = clock_of(tile, frame);
    tile->clock = start;
    tile->cached = frame->reuse->tile_count ? &frame->reuse->tiles[tile->index] : NULL;
    glint_tile_place_at(tile, plan, column, row);
    if (!glint_tile_is_unchanged(tile, frame) && !glint_tile_is_base(tile, frame))
        run_stages(tile, frame);
    tile->counts.tile_ns += clock_of(tile, frame) - start;
}
