/// The walk of a batch of rays: into the arrays, through the stages, and where they go on.
#include "engine/tile/batch.h"
#include "engine/base/vec.h"
#include "engine/tile/cut_out.h"

#include <string.h>

// ---- Before and after ----

void glint_batch_begin(glint_batch *batch, const glint_tile *to, const glint_tile_frame *frame, glint_walk walk)
{
    glint_tile *tile = &batch->tile;
    tile->camera = (glint_camera_args) { .orthographic = true }; // rays in arrays
    tile->transparent_shadow = to->transparent_shadow;
    tile->batch_rays = batch->ray;
    tile->vertex = to->vertex;
    tile->facets = to->facets;
    tile->visible_light = to->visible_light;
    tile->environment = to->environment;
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
    if (frame->plan->facets)
        glint_tile_lend_facets(tile, to);
}

void glint_batch_end(const glint_batch *batch, glint_tile *to)
{
    to->counts.shadow += batch->tile.counts.shadow;
    to->counts.work.light_samples += batch->tile.counts.work.light_samples;
    to->counts.work.powers += batch->tile.counts.work.powers;
    to->counts.work.tests += batch->tile.counts.work.tests;
    to->counts.work.sites += batch->tile.counts.work.sites;
    to->counts.runs[GLINT_STAGE_VERTEX] += batch->tile.counts.runs[GLINT_STAGE_VERTEX];
    to->counts.work.lights_seen += batch->tile.counts.work.lights_seen;
    to->counts.work.overlaps += batch->tile.counts.work.overlaps;
    to->counts.work.patterns += batch->tile.counts.work.patterns;
    to->counts.work.environment += batch->tile.counts.work.environment;
    glint_odd_pattern_add(&to->counts.odd, &batch->tile.counts.odd);
}

// ---- What the rays find ----

void glint_batch_load(glint_batch *batch, glint_precision precision)
{
    static const glint_batch_ray nowhere = { .direction = { 1, 1, 1 }, .leaving = GLINT_MISS };
    glint_tile *tile = &batch->tile;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const uint32_t g = i / GLINT_GROUP, lane = i % GLINT_GROUP;
        const glint_batch_ray *ray = glint_has_lane(tile->active, i) ? &batch->ray[i] : &nowhere;
        for (int c = 0; c < 3; c++) {
            glint_real_put(tile->rays.origin[c], precision, i, ray->origin[c]);
            glint_real_put(tile->rays.direction[c], precision, i, ray->direction[c]);
        }
        batch->leaving[i] = ray->leaving;
        batch->inward[g] = (uint16_t)((lane ? batch->inward[g] : 0) | (unsigned)ray->inward << lane);
    }
}

static bool cast(glint_batch *batch, const glint_tile_frame *frame)
{
    glint_tile *tile = &batch->tile;
    glint_cast_args args = { .group_count = tile->group_count,
                             .active = tile->active,
                             .geometry = &frame->geometry,
                             .stop = frame->cancelled,
                             .leaving = batch->leaving,
                             .inward = batch->inward,
                             .t = tile->at.t,
                             .prim = tile->at.prim,
                             .hits = tile->at.hits,
                             .tests = glint_tile_tests_of(tile, frame) };
    for (int c = 0; c < 3; c++) {
        args.origin[c] = tile->rays.origin[c];
        args.direction[c] = tile->rays.direction[c];
    }
    frame->stages->geometry[frame->plan->desc.precision].cast_rays(&args);
    if (glint_plan_cuts(frame->plan))
        glint_tile_see_through(tile, frame);
    if (frame->plan->runs[GLINT_STAGE_VISIBLE_LIGHT] && glint_tile_visible_light_in_sight(tile, frame))
        glint_tile_see_lights(tile, frame, tile->active);
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count; g++)
        any |= tile->at.hits[g];
    return any;
}

/// Weakens the rays by what they went through since their last surface.
static void absorb(glint_batch *batch, const glint_tile_frame *frame)
{
    const glint_tile *tile = &batch->tile;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        if (!glint_has_lane(tile->active, i))
            continue;
        glint_batch_ray *ray = &batch->ray[i];
        const bool hit = glint_has_lane(tile->at.hits, i);
        const uint32_t medium =
            hit && frame->plan->bouncing[tile->surface.material[i]].transmits
                ? glint_media_before(&ray->media, tile->surface.material[i], glint_has_lane(tile->hit.back, i))
                : glint_media_top(&ray->media);
        if (medium == GLINT_NO_MEDIUM)
            continue;
        const double way = glint_real_at(tile->at.t, frame->plan->desc.precision, i); // the directions are unit
        for (int c = 0; c < 3; c++)
            ray->weight[c] *= glint_plan_left(frame->plan->bouncing[medium].absorption[c], way);
    }
}

bool glint_batch_cast(glint_batch *batch, const glint_tile_frame *frame)
{
    const bool any = cast(batch, frame);
    if (any)
        glint_tile_find_surfaces(&batch->tile, frame);
    if (frame->plan->transmits)
        absorb(batch, frame);
    return any;
}

/// One light, or those samples of one that follow each other in a chunk; returns how many rows of the plan they are.
static uint32_t shine(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, uint32_t slot, uint32_t end)
{
    const glint_plan_light *lights = &frame->plan->lights[first];
    uint32_t slots[GLINT_LIGHT_CHUNK], count = 0;
    do {
        slots[count] = slot + count;
        count++;
    } while (slot + count < end && lights[slot + count].joined);
    if (glint_tile_sum_light(tile, frame, first, slot, count))
        return count;
    glint_tile_shine(tile, frame, first, slots, count);
    if (frame->plan->runs[GLINT_STAGE_FACET])
        glint_tile_facet(tile, frame, first, slots, count);
    if (lights[slot].shadows)
        glint_tile_occlude(tile, frame, first, slots, count);
    return count;
}

void glint_batch_light(glint_batch *batch, const glint_tile_frame *frame, bool any)
{
    const bool shading_points = any && frame->plan->runs[GLINT_STAGE_VERTEX];
    if (shading_points)
        any = glint_tile_choose_sampled(&batch->tile, frame);
    glint_batch_shine(batch, frame, any);
    if (shading_points && glint_tile_has_shading_points(&batch->tile))
        glint_tile_vertex(&batch->tile, frame);
}

void glint_batch_shine(glint_batch *batch, const glint_tile_frame *frame, bool any)
{
    glint_tile *tile = &batch->tile;
    const glint_plan *plan = frame->plan;
    const uint32_t lights = any ? plan->light_count : 0;
    uint32_t from = 0;
    for (int k = 0; k < GLINT_TERM_LOCAL; k++)
        for (int c = 0; c < 3; c++)
            memset(tile->film.sum[k][c], 0, tile->group_count * GLINT_GROUP * sizeof *tile->film.sum[k][c]);
    if (any && plan->runs[GLINT_STAGE_VIEW])
        glint_tile_view(tile, frame);
    if (plan->runs[GLINT_STAGE_PATTERN] && glint_tile_fields_shown(tile, plan) & GLINT_FIELDS_PLANES)
        glint_tile_pattern(tile, frame);
    do {
        const uint32_t count = lights - from < GLINT_LIGHT_CHUNK ? lights - from : GLINT_LIGHT_CHUNK;
        for (uint32_t i = 0; i < count;)
            i += shine(tile, frame, from, i, count);
        glint_tile_shade(tile, frame, from, count);
        for (uint32_t i = 0; i < count && plan->tints; i++)
            if (plan->lights[from + i].shadows && glint_tile_is_shadowed(tile, plan, i))
                glint_tile_transparent_shadow(tile, frame, from + i, i);
        from += count;
    } while (from < lights);
}

double glint_batch_found(const glint_batch *batch, int c, uint32_t i)
{
    double light = batch->tile.film.sum[0][c][i];
    for (int k = 1; k < GLINT_TERM_LOCAL; k++)
        light += batch->tile.film.sum[k][c][i];
    return light;
}

// ---- From a surface on ----

static double index_of(const glint_plan *plan, uint32_t medium)
{
    return medium == GLINT_NO_MEDIUM ? 1 : plan->bouncing[medium].ior;
}

/// The refractive index on the ray's side of a surface over that beyond it. What lets nothing through is solid: its
/// index is beyond, from whichever side it is seen.
static double index_ratio(const glint_plan *plan, const glint_media *media, uint32_t material, bool back)
{
    const glint_bounce_material *m = &plan->bouncing[material];
    glint_media beyond = *media;
    if (!m->transmits)
        return index_of(plan, glint_media_top(media)) / m->ior;
    glint_media_cross(&beyond, material, back);
    return index_of(plan, glint_media_before(media, material, back)) / index_of(plan, glint_media_top(&beyond));
}

static const glint_media *media_of(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame,
                                   uint32_t i)
{
    return tile == &batch->tile ? &batch->ray[i].media : &frame->plan->eye_media;
}

void glint_batch_find_ways(glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_precision precision = frame->plan->desc.precision;
    glint_bounce_args args = { .group_count = tile->group_count,
                               .wanted = batch->wanted,
                               .camera = glint_tile_rays_of(tile),
                               .ratio = batch->ratio,
                               .reflectance = batch->reflectance,
                               .total = batch->total };
    for (int c = 0; c < 3; c++) {
        args.direction[c] = tile->rays.direction[c];
        args.normal[c] = tile->surface.normal[c];
        args.reflected[c] = batch->reflected[c];
        args.refracted[c] = batch->refracted[c];
    }
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        double ratio = 1;
        if (glint_has_lane(batch->wanted, i))
            ratio = index_ratio(frame->plan, media_of(batch, tile, frame, i), tile->surface.material[i],
                                glint_has_lane(tile->hit.back, i));
        glint_real_put(batch->ratio, precision, i, ratio);
    }
    if (glint_plan_bumps(frame->plan))
        glint_tile_bounce_normals(tile, frame->plan, batch->wanted, batch->ratio, args.normal);
    frame->stages->geometry[precision].bounce(&args);
}

glint_batch_ray glint_batch_start_ray(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame,
                                      uint32_t i)
{
    glint_batch_ray ray = { .weight = { 1, 1, 1 }, .pixel = i, .media = *media_of(batch, tile, frame, i) };
    if (tile == &batch->tile)
        ray = batch->ray[i];
    if (frame->plan->patterns)
        ray.way += glint_real_at(tile->at.t, frame->plan->desc.precision, i);
    ray.leaving = tile->at.prim[i];
    for (int c = 0; c < 3; c++)
        ray.origin[c] = glint_real_at(tile->surface.point[c], frame->plan->desc.precision, i);
    return ray;
}

/// What is totally reflected has not crossed the surface: all of it goes on, of which a mirror sends its part already.
/// What lets nothing through is a mirror alone.
static void total_share(const glint_bounce_material *m, double share[3])
{
    for (int c = 0; c < 3; c++)
        share[c] = m->transmits ? fmax(1 - m->mirror[c], 0) : 0;
}

/// Points a ray along `way`, and weighs it.
static void send(glint_batch_ray *ray, const double (*way)[GLINT_TILE_SAMPLES], glint_precision precision, uint32_t i,
                 const double share[3], double factor)
{
    for (int c = 0; c < 3; c++) {
        ray->direction[c] = glint_real_at(way[c], precision, i);
        ray->weight[c] = fmin(ray->weight[c] * (share[c] * factor), GLINT_WEIGHT_MAX);
    }
}

void glint_batch_split(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       glint_batch_ray *mirror, glint_batch_ray *through)
{
    const glint_precision precision = frame->plan->desc.precision;
    glint_bounce_material room;
    const glint_bounce_material *m = glint_tile_bouncing(tile, frame->plan, i, &room);
    const bool back = glint_has_lane(tile->hit.back, i), total = glint_has_lane(batch->total, i);
    const double mirrored = m->fresnel ? glint_real_at(batch->reflectance, precision, i) : 1;
    double rest[3];
    total_share(m, rest);
    *mirror = glint_batch_start_ray(batch, tile, frame, i);
    mirror->depth++;
    *through = *mirror;
    send(mirror, batch->reflected, precision, i, m->mirror, mirrored);
    mirror->inward = back;
    send(through, total ? batch->reflected : batch->refracted, precision, i, total ? rest : m->transmission,
         m->fresnel ? 1 - mirrored : 1);
    through->inward = total ? back : !back;
    if (!total)
        glint_media_cross(&through->media, tile->surface.material[i], back);
}
