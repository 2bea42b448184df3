/// The walk of a tile: which stages run, in what order, and where their results go.
#include "engine/tile.h"

#include <math.h>
#include <string.h>

#define TIMED_TILES 17 ///< one in so many; no divisor of a picture's width in tiles that is common

void glint_tile_activate(glint_tile *tile)
{
    memset(tile->active, 0xff, sizeof tile->active);
    if (tile->width == GLINT_TILE_WIDTH && tile->height == GLINT_TILE_HEIGHT)
        return;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const uint32_t columns = tile->width - 4 * (g % tile->groups_across);
        const uint32_t rows = tile->height - 4 * (g / tile->groups_across);
        const uint32_t in_row = columns < 4 ? (1u << columns) - 1 : 15;
        const uint32_t in_rows = rows < 4 ? (1u << 4 * rows) - 1 : 0xffff;
        tile->active[g] = (uint16_t)(in_row * 0x1111 & in_rows);
    }
}

static void place(glint_tile *tile, const glint_plan *plan, uint32_t column, uint32_t row)
{
    const uint32_t width = (uint32_t)plan->desc.width, height = (uint32_t)plan->desc.height;
    tile->x0 = column * GLINT_TILE_WIDTH;
    tile->y0 = row * GLINT_TILE_HEIGHT;
    tile->transparent = plan->desc.alpha;
    tile->width = width - tile->x0 < GLINT_TILE_WIDTH ? width - tile->x0 : GLINT_TILE_WIDTH;
    tile->height = height - tile->y0 < GLINT_TILE_HEIGHT ? height - tile->y0 : GLINT_TILE_HEIGHT;
    tile->groups_across = (tile->width + 3) / 4;
    tile->group_count = tile->groups_across * ((tile->height + 3) / 4);
    glint_tile_activate(tile);
}

/// Points the sample's results at kept memory where this frame keeps them or has them, else at the tile's own. Memory is
/// asked for at the first sample alone: all samples of a tile are kept, or none. Returns whether the hits are known.
static bool find_hit_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    glint_reuse *reuse = frame->reuse;
    glint_kept_tile *kept = tile->kept;
    const size_t first = (size_t)k * GLINT_TILE_SAMPLES;
    const bool known = kept && glint_key_equal(kept->cast, frame->plan->keys[GLINT_STAGE_CAST]);
    tile->at.box = NULL;
    tile->at.t = tile->t;
    tile->at.prim = tile->prim;
    tile->at.hits = tile->hits;
    tile->at.sampled = tile->hits;
    if (known || (kept && reuse->keep_cast && (k ? kept->t != NULL : glint_reuse_hold_cast(reuse, kept)))) {
        tile->at.t = (char *)kept->t + first * reuse->real_size;
        tile->at.prim = kept->prim + first;
        tile->at.hits = kept->hits + first / GLINT_GROUP;
        tile->at.sampled = tile->at.hits;
    }
    return known;
}

static bool has_occlude(const glint_kept_light *kept, const glint_plan_light *light)
{
    return kept->open && (kept->visible || !light->cap);
}

static void find_light_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k, uint32_t light,
                              uint32_t slot, bool *light_known, bool *occlude_known)
{
    const glint_plan_light *l = &frame->plan->lights[light];
    glint_reuse *reuse = frame->reuse;
    glint_kept_light *kept = tile->kept && light < reuse->light_count ? &tile->kept->lights[light] : NULL;
    glint_tile_light *own = &tile->lights[tile->own_lights + slot];
    const size_t first = (size_t)k * GLINT_TILE_SAMPLES;
    *light_known = kept && glint_key_equal(kept->light, l->key);
    *occlude_known = kept && l->shadows && glint_key_equal(kept->occlude, l->key);
    tile->at.light[slot].cosine = own->cosine;
    tile->at.light[slot].attenuation = own->attenuation;
    tile->at.light[slot].log2_specular = own->log2_specular;
    tile->at.light[slot].lit = own->lit;
    tile->at.light[slot].open = own->open;
    tile->at.light[slot].visible = own->visible;
    tile->at.light[slot].brightest = GLINT_NO_SPECULAR;
    tile->at.light[slot].summed = false;
    if (*light_known ||
        (kept && reuse->keep_light[light] && (k ? kept->cosine != NULL : glint_reuse_hold_light(reuse, kept)))) {
        tile->at.light[slot].cosine = kept->cosine + first;
        tile->at.light[slot].attenuation = kept->attenuation + first;
        tile->at.light[slot].log2_specular = kept->log2_specular + first;
        tile->at.light[slot].lit = kept->lit + first / GLINT_GROUP;
        tile->at.light[slot].brightest = kept->kept_brightest;
    }
    if (*occlude_known || (kept && l->shadows && reuse->keep_light[light] &&
                           (k ? has_occlude(kept, l) : glint_reuse_hold_occlude(reuse, kept, l->cap)))) {
        tile->at.light[slot].open = kept->open + first / GLINT_GROUP;
        if (l->cap)
            tile->at.light[slot].visible = kept->visible + first;
    }
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
    for (uint32_t i = 0; i < reuse->light_count; i++) {
        if (reuse->keep_light[i] && kept->lights[i].cosine) {
            kept->lights[i].light = plan->lights[i].key;
            kept->lights[i].kept_brightest = kept->lights[i].brightest;
        }
        if (reuse->keep_light[i] && plan->lights[i].shadows && has_occlude(&kept->lights[i], &plan->lights[i]))
            kept->lights[i].occlude = plan->lights[i].key;
    }
    if (plan->runs[GLINT_STAGE_FACET])
        glint_tile_sign_facets(tile, frame);
}

// ---- What the tile shows ----

/// Whether light is worked out for the faces or vertices of what is there.
static bool has_sites(const glint_prim *prim) { return prim->kind == GLINT_PRIM_TRIANGLE && prim->sites != GLINT_MISS; }

static void note_material(glint_kept_tile *kept, uint32_t material)
{
    for (uint32_t i = 0; i < kept->shown_count && i < GLINT_SHOWN_MAX; i++)
        if (kept->shown[i] == material)
            return;
    if (kept->shown_count < GLINT_SHOWN_MAX)
        kept->shown[kept->shown_count] = material;
    if (kept->shown_count <= GLINT_SHOWN_MAX)
        kept->shown_count++;
}

/// Notes a sample's materials, and whether there is background among it.
static void note_surfaces(const glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    glint_kept_tile *kept = tile->kept;
    if (k == 0) {
        kept->shown_count = 0;
        kept->background = kept->sites = false;
    }
    uint32_t last = k ? kept->only : GLINT_MISS;
    bool several = k && kept->only == GLINT_MISS;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const uint32_t prim = tile->at.prim[i];
        if (prim == last || prim == GLINT_MISS)
            continue;
        note_material(kept, frame->geometry.prims[prim].material);
        kept->sites = kept->sites || has_sites(&frame->geometry.prims[prim]);
        several = several || last != GLINT_MISS;
        last = prim;
    }
    kept->only = several ? GLINT_MISS : last;
    for (uint32_t g = 0; g < tile->group_count; g++)
        kept->background = kept->background || tile->at.hits[g] != tile->active[g];
}

/// Notes whether a light reaches any point of a sample, and the most that its highlights may be there.
static void note_light(const glint_tile *tile, uint32_t index, uint32_t slot, bool shadows, uint32_t k)
{
    glint_kept_light *kept = &tile->kept->lights[index];
    const uint16_t *lanes = shadows ? tile->at.light[slot].open : tile->at.light[slot].lit;
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count; g++)
        any |= lanes[g];
    kept->reaches = (k && kept->reaches) || any;
    kept->brightest = fmaxf(k ? kept->brightest : GLINT_NO_SPECULAR, tile->at.light[slot].brightest);
}

/// The same where nothing is hit.
static void note_nothing(const glint_tile *tile, uint32_t k)
{
    if (k == 0) {
        tile->kept->shown_count = 0;
        tile->kept->only = GLINT_MISS;
    }
    tile->kept->background = true;
}

// ---- A sample ----

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
    bool lit; ///< points and the only light's work are made, and no normals
} walk;

static void need_rays(glint_tile *tile, const glint_tile_frame *frame, walk *w)
{
    if (!w->rays)
        glint_tile_make_rays(tile, frame);
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
    const bool known = find_hit_memory(tile, frame, w->sample);
    if (!plan->runs[GLINT_STAGE_CAST]) {
        memset(tile->at.hits, 0, tile->group_count * sizeof *tile->at.hits);
    } else if (known) {
        glint_tile_book(tile, frame, GLINT_STAGE_CAST, true);
    } else {
        if (glint_tile_in_sight(tile, frame))
            need_rays(tile, frame, w);
        glint_tile_cast(tile, frame);
    }
    if (plan->runs[GLINT_STAGE_GLOW]) {
        if (glint_tile_glow_in_sight(tile, frame)) {
            need_rays(tile, frame, w);
            glint_tile_see_lights(tile, frame, tile->active);
        }
        glint_tile_book(tile, frame, GLINT_STAGE_GLOW, false);
    }
    const bool any = any_hit(tile);
    if (!any)
        glint_tile_keep_box(tile, frame, NULL);
    if (tile->kept && !glint_key_equal(tile->kept->seen, plan->keys[GLINT_STAGE_SURFACE])) {
        if (any)
            note_surfaces(tile, frame, w->sample);
        else
            note_nothing(tile, w->sample);
    }
    tile->at.only = tile->kept && tile->kept->only != GLINT_MISS ? &tile->kept->only : NULL;
    if (glint_tile_wants_coverage(plan))
        glint_tile_count_hits(tile, plan, w->sample);
    if (w->sample == 0 && glint_tile_wants_geometry(plan) && !frame->base) {
        if (any)
            need_points(tile, frame, w);
        glint_tile_store_geometry(tile, frame);
    }
    return any;
}

/// What else a light's rows do to microfacets.
static void find_facets(glint_tile *tile, const glint_tile_frame *frame, walk *w, uint32_t first, uint32_t slot,
                        uint32_t count)
{
    uint32_t unknown[GLINT_LIGHT_CHUNK], left = 0;
    for (uint32_t i = slot; i < slot + count; i++) {
        if (glint_tile_facet_memory(tile, frame, w->sample, first + i, i))
            glint_tile_book(tile, frame, GLINT_STAGE_FACET, true);
        else
            unknown[left++] = i;
    }
    if (!left)
        return;
    need_points(tile, frame, w);
    glint_tile_facet(tile, frame, first, unknown, left);
}

/// The angles that microfacets are seen at.
static void find_view(glint_tile *tile, const glint_tile_frame *frame, walk *w)
{
    if (glint_tile_view_memory(tile, frame, w->sample)) {
        glint_tile_book(tile, frame, GLINT_STAGE_VIEW, true);
        return;
    }
    need_points(tile, frame, w);
    glint_tile_view(tile, frame);
}

/// Whether the points and what the light does there can be found in one: of spheres, planes and one plain lamp, where
/// nobody asks for normals. Where stages are timed, each runs by itself.
static bool is_plain(const glint_tile_frame *frame, const walk *w)
{
    const glint_plan *plan = frame->plan;
    return !w->points && !frame->time_stages && plan->light_count == 1 && !plan->lights[0].lamps &&
           !plan->lights[0].is_spot && !frame->geometry.triangles && !frame->geometry.solids;
}

/// What one light does to this sample: `count` rows of the plan from `first + slot` on.
static void find_light(glint_tile *tile, const glint_tile_frame *frame, walk *w, uint32_t first, uint32_t slot,
                       uint32_t count)
{
    const glint_plan_light *light = &frame->plan->lights[first + slot];
    uint32_t shine[GLINT_LIGHT_CHUNK], occlude[GLINT_LIGHT_CHUNK], shining = 0, occluding = 0;
    for (uint32_t i = slot; i < slot + count; i++) {
        bool light_known, occlude_known;
        find_light_memory(tile, frame, w->sample, first + i, i, &light_known, &occlude_known);
        if (light_known)
            glint_tile_book(tile, frame, GLINT_STAGE_LIGHT, true);
        else
            shine[shining++] = i;
        if (light->shadows && occlude_known)
            glint_tile_book(tile, frame, GLINT_STAGE_OCCLUDE, true);
        else if (light->shadows)
            occlude[occluding++] = i;
    }
    if (shining && is_plain(frame, w)) {
        need_rays(tile, frame, w);
        glint_tile_find_lit_surfaces(tile, frame, first);
        w->lit = true;
    } else {
        if (shining || occluding)
            need_points(tile, frame, w);
        if (shining == count && glint_tile_sum_light(tile, frame, first, slot, count))
            occluding = 0;
        else if (shining)
            glint_tile_shine(tile, frame, first, shine, shining);
    }
    if (occluding)
        glint_tile_occlude(tile, frame, first, occlude, occluding);
    if (frame->plan->runs[GLINT_STAGE_FACET])
        find_facets(tile, frame, w, first, slot, count);
    for (uint32_t i = slot; i < slot + count; i++)
        if (tile->kept && first + i < frame->reuse->light_count)
            note_light(tile, first + i, i, light->shadows, w->sample);
}

/// A chunk of lights; the samples of one are found together.
static void find_lights(glint_tile *tile, const glint_tile_frame *frame, walk *w, uint32_t first, uint32_t count)
{
    for (uint32_t slot = 0, next; slot < count; slot = next) {
        for (next = slot + 1; next < count && frame->plan->lights[first + next].joined; next++)
            continue;
        find_light(tile, frame, w, first, slot, next - slot);
    }
}

/// What a light gives through transparent objects.
static void find_tint(glint_tile *tile, const glint_tile_frame *frame, walk *w, uint32_t index, uint32_t slot)
{
    if (!frame->plan->lights[index].shadows || !glint_tile_is_shadowed(tile, frame->plan, slot))
        return;
    need_points(tile, frame, w);
    glint_tile_tint(tile, frame, index, slot);
}

/// What other surfaces and the background light.
static void find_indirect(glint_tile *tile, const glint_tile_frame *frame, walk *w)
{
    need_points(tile, frame, w);
    glint_tile_indirect(tile, frame, tile, NULL);
    glint_tile_book(tile, frame, GLINT_STAGE_INDIRECT, false);
}

/// What materials send on.
static void find_bounces(glint_tile *tile, const glint_tile_frame *frame, walk *w)
{
    if (!glint_tile_sends_on(tile, frame))
        return;
    need_points(tile, frame, w);
    glint_tile_bounce(tile, frame);
    glint_tile_book(tile, frame, GLINT_STAGE_BOUNCE, false);
}

/// The light of faces and vertices.
static void find_sites(glint_tile *tile, const glint_tile_frame *frame, walk *w)
{
    if (!glint_tile_has_sites(tile))
        return;
    need_points(tile, frame, w);
    glint_tile_vertex(tile, frame);
}

static void find_cue(glint_tile *tile, const glint_tile_frame *frame, walk *w, bool any)
{
    const bool seen = any || frame->plan->runs[GLINT_STAGE_GLOW];
    if (seen)
        need_rays(tile, frame, w);
    glint_tile_find_cue(tile, frame->plan, seen);
}

/// One sample of every pixel: hits, then the lights, a chunk at a time.
static void sample(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    walk w = { .sample = k };
    tile->boxed = k ? tile->boxed : 0;
    tile->own_lights = frame->plan->together ? k * frame->plan->light_count : 0;
    glint_tile_aim(tile, frame, k);
    const bool any = find_hits(tile, frame, &w);
    if (frame->plan->runs[GLINT_STAGE_CUE])
        find_cue(tile, frame, &w, any);
    const bool sites = any && frame->plan->runs[GLINT_STAGE_VERTEX];
    const bool lit = sites ? glint_tile_choose_sampled(tile, frame) : any;
    const uint32_t lights = lit ? frame->plan->light_count : 0;
    uint32_t from = 0;
    if (lit && frame->plan->runs[GLINT_STAGE_VIEW])
        find_view(tile, frame, &w);
    do {
        const uint32_t count = lights - from < GLINT_LIGHT_CHUNK ? lights - from : GLINT_LIGHT_CHUNK;
        find_lights(tile, frame, &w, from, count);
        if (from == 0 && any && !w.points && !w.lit) {
            glint_tile_book(tile, frame, GLINT_STAGE_SURFACE, true);
            glint_tile_name_materials(tile, frame);
        }
        if (lit && frame->plan->dims) // which points are inside what absorbs
            need_points(tile, frame, &w);
        if (frame->plan->together)
            glint_tile_remember_sample(tile, frame, count);
        else
            glint_tile_shade(tile, frame, from, count);
        for (uint32_t i = 0; i < count && frame->plan->tints; i++)
            find_tint(tile, frame, &w, from + i, i);
        from += count;
    } while (from < lights && !glint_tile_cancelled(frame));
    if (sites)
        find_sites(tile, frame, &w);
    if (any && frame->plan->runs[GLINT_STAGE_INDIRECT])
        find_indirect(tile, frame, &w);
    if (any && frame->plan->runs[GLINT_STAGE_BOUNCE])
        find_bounces(tile, frame, &w);
    if (frame->plan->runs[GLINT_STAGE_CUE])
        glint_tile_cue(tile, frame);
}

static bool is_per_light(glint_stage_id id)
{
    return id == GLINT_STAGE_LIGHT || id == GLINT_STAGE_FACET || id == GLINT_STAGE_OCCLUDE;
}

static bool is_known(glint_key key) { return !glint_key_equal(key, (glint_key) { 0 }); }

/// Whether the tile's pixels are those of the last picture; then they are copied, unless they are in this one's memory
/// from before.
static bool unchanged(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const glint_image *last = frame->last;
    if (!tile->kept || !last || !last->film)
        return false;
    const glint_key key = glint_reuse_film_key(frame->reuse, tile->kept, plan);
    if (!is_known(key) || !glint_key_equal(key, last->film[tile->index].key))
        return false;
    if (!glint_key_equal(key, frame->image->film[tile->index].key))
        glint_tile_copy(tile, frame);
    frame->image->film[tile->index] = last->film[tile->index];
    tile->counts.clipped += tile->kept->clipped;
    tile->counts.nonfinite += tile->kept->nonfinite;
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        if (plan->runs[id])
            tile->counts.reuses[id] += is_per_light((glint_stage_id)id) ? plan->light_count : 1;
    return true;
}

/// What the worker had counted before a tile.
typedef struct film_counts {
    uint64_t clipped, nonfinite;
    uint64_t lights; ///< calls of the stage light
} film_counts;

/// Writes down what the tile shows now.
static void sign_film(glint_tile *tile, const glint_tile_frame *frame, film_counts before)
{
    glint_kept_tile *kept = tile->kept;
    if (!kept)
        return;
    kept->seen = frame->plan->keys[GLINT_STAGE_SURFACE];
    for (uint32_t i = 0; i < frame->reuse->light_count && kept->shown_count > 0; i++)
        kept->lights[i].place = frame->plan->lights[i].place_key;
    const glint_key key = glint_reuse_film_key(frame->reuse, kept, frame->plan);
    const glint_film_stamp *last = frame->last && frame->last->film ? &frame->last->film[tile->index] : NULL;
    const bool moved = tile->counts.runs[GLINT_STAGE_LIGHT] != before.lights; // then codes seldom stay as they are
    const bool same = last && last->codes && !moved && glint_tile_has_codes_of(tile, frame->image, frame->last);
    frame->image->film[tile->index] = (glint_film_stamp) { .key = key, .codes = same ? last->codes : key.low };
    kept->clipped = tile->counts.clipped - before.clipped;
    kept->nonfinite = tile->counts.nonfinite - before.nonfinite;
}

/// The time now, of tiles that are timed, else 0. Without times of stages a few tiles tell what share the tone has.
static uint64_t clock_of(const glint_tile *tile, const glint_tile_frame *frame)
{
    return frame->time_stages || tile->index % TIMED_TILES == 0 ? glint_tile_now_ns() : 0;
}

/// Every stage that the tile needs.
static void run_stages(glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const film_counts before = { .clipped = tile->counts.clipped,
                                 .nonfinite = tile->counts.nonfinite,
                                 .lights = tile->counts.runs[GLINT_STAGE_LIGHT] };
    if (tile->kept)
        frame->image->film[tile->index] = (glint_film_stamp) { 0 };
    for (int k = 0; k < GLINT_TERM_COUNT && plan->accumulate && !plan->together; k++)
        if (glint_plan_has_term(plan, (glint_term)k))
            memset(tile->sum[k], 0, sizeof tile->sum[k]);
    const bool refined = !frame->base || glint_tile_choose_refined(tile, frame);
    for (uint32_t k = 0; refined && k < (uint32_t)plan->desc.samples; k++) {
        sample(tile, frame, k);
        if (glint_tile_cancelled(frame))
            return;
    }
    sign_kept(tile, frame);
    if (plan->runs[GLINT_STAGE_CUE] && refined)
        glint_tile_take_cued(tile, plan);
    if (plan->together && refined)
        glint_tile_resolve_samples(tile, frame);
    else if (plan->accumulate && refined)
        glint_tile_resolve(tile, frame);
    if (frame->base)
        glint_tile_take_base(tile, frame);
    glint_tile_store_light(tile, frame);
    const uint64_t rendered = clock_of(tile, frame);
    if (plan->runs[GLINT_STAGE_TONE]) {
        glint_tile_tone(tile, frame);
        tile->counts.runs[GLINT_STAGE_TONE]++;
    }
    tile->counts.ns[GLINT_STAGE_TONE] += clock_of(tile, frame) - rendered;
    sign_film(tile, frame, before);
}

void glint_tile_render(glint_tile *tile, const glint_tile_frame *frame, uint32_t column, uint32_t row)
{
    const glint_plan *plan = frame->plan;
    const uint32_t across = ((uint32_t)plan->desc.width + GLINT_TILE_WIDTH - 1) / GLINT_TILE_WIDTH;
    tile->index = (size_t)row * across + column;
    const uint64_t start = clock_of(tile, frame);
    tile->clock = start;
    tile->kept = frame->reuse->tile_count ? &frame->reuse->tiles[tile->index] : NULL;
    place(tile, plan, column, row);
    if (!unchanged(tile, frame))
        run_stages(tile, frame);
    tile->counts.tile_ns += clock_of(tile, frame) - start;
}
