/// The walk of a batch of rays: casts them, packs their hits into few groups, and runs the stages.
#include "engine/base/vec.h"
#include "engine/render/pattern/pattern.h"
#include "engine/render/light_groups/light_groups.h"

#include <string.h>

#define SORTED_PRIMS 32 ///< packed hits are sorted by primitive in scenes with at most this many; a power of 2

// ---- Before and after ----

/// Returns whether some light has a different sample for each lane.
static bool has_area_light(const glint_plan *plan)
{
    for (uint32_t i = 0; i < plan->light_count; i++)
        if (plan->lights[i].light_samples)
            return true;
    return false;
}

void glint_batch_begin(glint_batch *batch, const glint_tile *to, const glint_tile_frame *frame, glint_walk walk)
{
    glint_tile *tile = &batch->tile;
    tile->camera = (glint_camera_args) { .orthographic = true }; // rays in arrays
    for (int id = 0; id < GLINT_STAGE_COUNT; id++)
        if (glint_stage_table[id]->shared)
            tile->own[id] = to->own[id];
    if (!batch->rays)
        batch->rays = &batch->own;
    batch->ordered = batch->distances = false;
    batch->by_lane = has_area_light(frame->plan);
    tile->batch = batch;
    tile->own[GLINT_STAGE_LIGHT_GROUPS] = glint_group_sums_of(to, walk == GLINT_WALK_SHADING_POINTS);
    tile->shadow_scratch = to->shadow_scratch;
    tile->sample = to->sample;
    tile->counts = (glint_tile_counts) { 0 };
    tile->clock = to->clock;
    tile->at = (glint_tile_sample) {
        .t = tile->hit.t, .prim = tile->hit.prim, .hits = tile->hit.mask, .sampled = tile->hit.mask
    };
    tile->own_lights = 0;
    glint_pattern_point(to->pattern, tile, walk);
    for (uint32_t i = 0; i < GLINT_LIGHT_CHUNK; i++)
        glint_tile_use_own_light(tile, i);
}

void glint_batch_end(const glint_batch *batch, glint_tile *to)
{
    to->counts.shadow += batch->tile.counts.shadow;
    glint_work_add(&to->counts.work, &batch->tile.counts.work);
    to->counts.runs[GLINT_STAGE_VERTEX_SHADING] += batch->tile.counts.runs[GLINT_STAGE_VERTEX_SHADING];
    glint_odd_patterns_add(&to->counts.odd, &batch->tile.counts.odd);
}

// ---- Hits of the rays ----

/// Returns whether stages between cast and surface need all rays in their original places, including those that hit
/// nothing.
static bool needs_all(const glint_plan *plan)
{
    return glint_plan_cuts(plan) || plan->runs[GLINT_STAGE_VISIBLE_LIGHT];
}

static void cast(glint_batch *batch, const glint_tile_frame *frame)
{
    glint_tile *tile = &batch->tile;
    const glint_rays *rays = batch->rays;
    glint_cast_args args = { .group_count = rays->group_count,
                             .active = rays->active,
                             .geometry = &frame->geometry,
                             .stop = frame->cancelled,
                             .leaving = rays->origin_prim,
                             .inward = rays->inward,
                             .t = batch->whole ? tile->at.t : batch->t,
                             .prim = batch->whole ? tile->at.prim : batch->prim,
                             .hits = tile->at.hits,
                             .tests = glint_tile_tests_of(tile, frame) };
    for (int c = 0; c < 3; c++) {
        args.origin[c] = rays->origin[c];
        args.direction[c] = rays->direction[c];
    }
    frame->stages->geometry[frame->plan->desc.precision].cast_rays(&args);
}

/// Gives every ray the sample of its own number.
static void take_all(glint_batch *batch, const glint_tile_frame *frame)
{
    glint_tile *tile = &batch->tile;
    const glint_rays *rays = batch->rays;
    const size_t size = rays->group_count * GLINT_GROUP * sizeof(double);
    tile->group_count = rays->group_count;
    memcpy(tile->active, rays->active, rays->group_count * sizeof *tile->active);
    for (int c = 0; c < 3; c++) {
        memcpy(tile->rays.origin[c], rays->origin[c], size);
        memcpy(tile->rays.direction[c], rays->direction[c], size);
    }
    for (uint32_t i = 0; i < rays->group_count * GLINT_GROUP; i++)
        batch->sample[i] = batch->ray_of[i] = (uint16_t)i;
    glint_tile_step(tile, frame, GLINT_AT_CAST, NULL);
    glint_tile_step(tile, frame, GLINT_AT_HITS, &(glint_sample_walk) { .rays = true });
}

/// Gives ray i sample `to`.
static void give_sample(glint_batch *batch, uint32_t i, uint32_t to)
{
    batch->sample[i] = (uint16_t)to;
    batch->ray_of[to] = (uint16_t)i;
}

/// Moves the rays' numbers in an array of real to their samples.
static void take_reals(const uint16_t *ray_of, uint32_t count, glint_precision precision, const void *from, void *to)
{
    for (uint32_t n = 0; n < count && precision == GLINT_PRECISION_DOUBLE; n++)
        ((double *)to)[n] = ((const double *)from)[ray_of[n]];
    for (uint32_t n = 0; n < count && precision == GLINT_PRECISION_FLOAT; n++)
        ((float *)to)[n] = ((const float *)from)[ray_of[n]];
}

/// Moves the rays' hits to the first `count` samples; samples without a ray are undefined.
static void move_hits(glint_batch *batch, glint_precision precision, uint32_t count)
{
    glint_tile *tile = &batch->tile;
    const glint_rays *rays = batch->rays;
    for (int c = 0; c < 3; c++) {
        take_reals(batch->ray_of, count, precision, rays->origin[c], tile->rays.origin[c]);
        take_reals(batch->ray_of, count, precision, rays->direction[c], tile->rays.direction[c]);
    }
    take_reals(batch->ray_of, count, precision, batch->t, tile->at.t);
    for (uint32_t n = 0; n < count; n++)
        tile->at.prim[n] = batch->prim[batch->ray_of[n]];
}

/// Marks the samples that have hits. next: the first sample without a hit, for each lane.
static void mark_hits(glint_tile *tile, const uint32_t next[GLINT_GROUP])
{
    uint32_t least = UINT32_MAX, most = 0; // groups
    for (uint32_t lane = 0; lane < GLINT_GROUP; lane++) {
        least = next[lane] / GLINT_GROUP < least ? next[lane] / GLINT_GROUP : least;
        most = next[lane] / GLINT_GROUP > most ? next[lane] / GLINT_GROUP : most;
    }
    for (uint32_t g = 0; g < most; g++) {
        unsigned hits = g < least ? 0xffff : 0;
        for (uint32_t lane = 0; g >= least && lane < GLINT_GROUP; lane++)
            if (g < next[lane] / GLINT_GROUP)
                hits |= 1u << lane;
            else
                tile->at.prim[g * GLINT_GROUP + lane] = GLINT_MISS;
        tile->active[g] = tile->at.hits[g] = (uint16_t)hits;
    }
    tile->group_count = most;
}

/// Gives hits the first samples of their lane. Area lights choose their points by the lane.
static void pack_lanes(glint_batch *batch, glint_precision precision)
{
    uint32_t next[GLINT_GROUP], end = 0;
    for (uint32_t lane = 0; lane < GLINT_GROUP; lane++)
        next[lane] = lane;
    memset(batch->ray_of, 0, batch->rays->group_count * GLINT_GROUP * sizeof *batch->ray_of); // for samples without a ray
    for (uint32_t g = 0; g < batch->rays->group_count; g++)
        for (unsigned bits = batch->with_sample[g]; bits; bits &= bits - 1) {
            const uint32_t lane = (uint32_t)__builtin_ctz(bits);
            give_sample(batch, g * GLINT_GROUP + lane, next[lane]);
            end = next[lane] >= end ? next[lane] + 1 : end;
            next[lane] += GLINT_GROUP;
        }
    move_hits(batch, precision, end);
    mark_hits(&batch->tile, next);
}

/// Gives hits the first samples, without gaps. In scenes with few primitives, hits are sorted by primitive, so that
/// most groups show only one.
static void pack(glint_batch *batch, const glint_tile_frame *frame)
{
    const uint32_t last = frame->geometry.prim_count <= SORTED_PRIMS ? SORTED_PRIMS - 1 : 0; // 0: unsorted
    uint32_t first[SORTED_PRIMS + 1] = { 0 }, next[GLINT_GROUP], count = 0;
    uint16_t from[GLINT_TILE_SAMPLES];
    for (uint32_t g = 0; g < batch->rays->group_count; g++)
        for (unsigned bits = batch->with_sample[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            from[count++] = (uint16_t)i;
            first[(batch->prim[i] & last) + 1]++;
        }
    for (uint32_t k = 1; k <= last; k++)
        first[k] += first[k - 1];
    for (uint32_t n = 0; n < count; n++)
        give_sample(batch, from[n], first[batch->prim[from[n]] & last]++);
    move_hits(batch, frame->plan->desc.precision, count);
    for (uint32_t lane = 0; lane < GLINT_GROUP; lane++)
        next[lane] = lane + (count + GLINT_GROUP - 1 - lane) / GLINT_GROUP * GLINT_GROUP;
    mark_hits(&batch->tile, next);
}

/// Turns the rays' hits into samples.
static void take_hits(glint_batch *batch, const glint_tile_frame *frame)
{
    memcpy(batch->with_sample, batch->tile.at.hits, batch->rays->group_count * sizeof *batch->with_sample);
    if (batch->by_lane)
        pack_lanes(batch, frame->plan->desc.precision);
    else
        pack(batch, frame);
}

/// Returns the medium inside the surface of sample i.
static uint32_t medium_of(const glint_tile *tile, const glint_tile_frame *frame, uint32_t i)
{
    return frame->geometry.prims[tile->at.prim[i]].medium;
}

uint32_t glint_batch_crossed(const glint_batch *batch, const glint_tile_frame *frame, uint32_t ray)
{
    const glint_tile *tile = &batch->tile;
    const glint_media *media = &batch->rays->media[ray];
    const uint32_t at = batch->sample[ray];
    const bool hit = glint_batch_has_sample(batch, ray) && glint_has_lane(tile->at.hits, at);
    return hit && frame->plan->bouncing[tile->surface.material[at]].transmits
               ? glint_media_before(media, medium_of(tile, frame, at), glint_has_lane(tile->hit.back, at))
               : glint_media_top(media);
}

/// Multiplies the rays' throughput by the absorption since their last surface.
static void absorb(glint_batch *batch, const glint_tile_frame *frame)
{
    const glint_tile *tile = &batch->tile;
    glint_rays *rays = batch->rays;
    for (uint32_t i = 0; i < rays->group_count * GLINT_GROUP; i++) {
        const uint32_t medium = glint_has_lane(rays->active, i) ? glint_batch_crossed(batch, frame, i) : GLINT_NO_MEDIUM;
        if (medium == GLINT_NO_MEDIUM)
            continue;
        const double distance = glint_batch_has_sample(batch, i)
                                    ? glint_real_at(tile->at.t, frame->plan->desc.precision, batch->sample[i])
                                    : HUGE_VAL; // directions are unit
        for (int c = 0; c < 3; c++)
            rays->throughput[c][i] *= glint_plan_transmittance(frame->plan->bouncing[medium].absorption[c], distance);
    }
}

void glint_batch_find_missed(const glint_batch *batch, uint16_t missed[GLINT_TILE_GROUPS])
{
    for (uint32_t g = 0; g < batch->rays->group_count; g++)
        missed[g] =
            batch->rays->active[g] & (uint16_t) ~(batch->whole ? batch->tile.at.hits[g] : batch->with_sample[g]);
}

bool glint_batch_cast(glint_batch *batch, const glint_tile_frame *frame)
{
    glint_tile *tile = &batch->tile;
    batch->whole = batch->ordered || needs_all(frame->plan);
    cast(batch, frame);
    if (batch->whole)
        take_all(batch, frame);
    else
        take_hits(batch, frame);
    const bool any = glint_has_lanes(tile->at.hits, tile->group_count);
    tile->at.only = NULL;
    if (any && !batch->distances)
        glint_tile_find_surfaces(tile, frame);
    if (frame->plan->absorbs)
        absorb(batch, frame);
    if (!batch->whole)
        glint_tile_step(tile, frame, GLINT_AT_MISSED, &(glint_sample_walk) { .batch = batch });
    return any;
}

/// Computes the illumination by one light, by consecutive samples of one light, or by several similar lights. Returns
/// the number of rows of the plan that were handled.
static uint32_t shine(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk, uint32_t slot, uint32_t end)
{
    const uint32_t first = walk->from;
    const glint_plan_light *lights = &frame->plan->lights[first];
    uint32_t slots[GLINT_LIGHT_CHUNK], shadowed[GLINT_LIGHT_CHUNK], count = 0, shadows = 0;
    do {
        slots[count] = slot + count;
        if (lights[slot + count].shadows)
            shadowed[shadows++] = slot + count;
        count++;
    } while (slot + count < end && (lights[slot + count].joined || lights[slot + count].same_but_position));
    if (glint_tile_sum_light(tile, frame, first, slot, count))
        return count;
    glint_tile_shine(tile, frame, first, slots, count);
    const uint32_t together = lights[slot].light_samples ? count : 1;
    for (walk->slot = slot, walk->count = together; walk->slot < slot + count; walk->slot += together)
        glint_tile_step(tile, frame, GLINT_AT_LIGHT, walk);
    if (shadows)
        glint_tile_occlude(tile, frame, first, shadowed, shadows);
    return count;
}

void glint_batch_light(glint_batch *batch, const glint_tile_frame *frame, const glint_tile_frame *lights, bool any)
{
    const glint_stage *vertex = frame->plan->runs[GLINT_STAGE_VERTEX_SHADING] ? glint_stage_table[GLINT_STAGE_VERTEX_SHADING] : NULL;
    glint_sample_walk walk = { .rays = true, .points = true, .any = any, .shines = any };
    if (vertex)
        vertex->step[GLINT_AFTER_PRIMARY](&batch->tile, frame, &walk);
    glint_batch_shine(batch, lights, walk.shines);
    if (vertex)
        vertex->step[GLINT_AFTER_LIGHTS](&batch->tile, frame, &walk);
}

void glint_batch_find_patterns(glint_batch *batch, const glint_tile_frame *frame)
{
    if (frame->plan->runs[GLINT_STAGE_PATTERN] && glint_tile_fields_shown(&batch->tile, frame->plan) & GLINT_FIELDS_PLANES)
        glint_tile_find_patterns(&batch->tile, frame);
}

void glint_batch_shine(glint_batch *batch, const glint_tile_frame *frame, bool any)
{
    glint_tile *tile = &batch->tile;
    const glint_plan *plan = frame->plan;
    const uint32_t lights = any ? plan->light_count : 0;
    glint_sample_walk walk = { .rays = true, .points = true, .any = any, .shines = any };
    for (int k = 0; k < GLINT_TERM_LOCAL; k++)
        for (int c = 0; c < 3; c++)
            memset(tile->film.sum[k][c], 0, tile->group_count * GLINT_GROUP * sizeof *tile->film.sum[k][c]);
    if (any)
        glint_tile_step(tile, frame, GLINT_AT_LIT, &walk);
    glint_batch_find_patterns(batch, frame);
    do {
        const uint32_t count = lights - walk.from < GLINT_LIGHT_CHUNK ? lights - walk.from : GLINT_LIGHT_CHUNK;
        for (uint32_t i = 0; i < count;)
            i += shine(tile, frame, &walk, i, count);
        glint_tile_shade(tile, frame, walk.from, count);
        walk.count = count;
        glint_tile_step(tile, frame, GLINT_AT_SHADED, &walk);
        walk.from += count;
    } while (walk.from < lights);
}
