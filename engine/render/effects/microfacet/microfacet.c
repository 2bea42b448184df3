/// Microfacets: the stages view and facet, and the memory of their results.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/tile/tile.h"

#include <stdlib.h>

static glint_tile_facets *own_of(const glint_tile *tile) { return tile->own[GLINT_STAGE_MICROFACET_VIEW]; }

static bool view_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k)
{
    glint_cached_tile *cached = tile->cached;
    const bool known = cached && glint_key_equal(cached->view, frame->plan->keys[GLINT_STAGE_MICROFACET_VIEW]);
    tile->at.facing = own_of(tile)->facing;
    if (known || (cached && frame->reuse->caches_view &&
                  (k ? cached->facing != NULL : glint_reuse_hold_view(frame->reuse, cached))))
        tile->at.facing = cached->facing + (size_t)k * GLINT_TILE_SAMPLES;
    return known;
}

static bool facet_memory(glint_tile *tile, const glint_tile_frame *frame, uint32_t k, uint32_t light, uint32_t slot)
{
    glint_reuse *reuse = frame->reuse;
    glint_cached_light *cached = tile->cached && light < reuse->light_count ? &tile->cached->lights[light] : NULL;
    const size_t first = (size_t)k * GLINT_TILE_SAMPLES;
    const bool known = cached && glint_key_equal(cached->facet, frame->plan->lights[light].key);
    tile->at.light[slot].sine2 = own_of(tile)->sine2[slot];
    tile->at.light[slot].schlick = own_of(tile)->schlick[slot];
    if (known ||
        (cached && reuse->caches_light[light] && (k ? cached->sine2 != NULL : glint_reuse_hold_facet(reuse, cached)))) {
        tile->at.light[slot].sine2 = cached->sine2 + first;
        tile->at.light[slot].schlick = cached->schlick + first;
    }
    return known;
}

static void sign(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    (void)walk;
    const glint_plan *plan = frame->plan;
    const glint_reuse *reuse = frame->reuse;
    glint_cached_tile *cached = tile->cached;
    if (reuse->caches_view && cached->facing)
        cached->view = plan->keys[GLINT_STAGE_MICROFACET_VIEW];
    for (uint32_t i = 0; i < reuse->light_count; i++)
        if (reuse->caches_light[i] && cached->lights[i].sine2)
            cached->lights[i].facet = plan->lights[i].key;
}

static void view(glint_tile *tile, const glint_tile_frame *frame)
{
    glint_view_args args = { .group_count = tile->group_count,
                             .hits = tile->at.hits,
                             .camera = glint_tile_rays_of(tile),
                             .facing = tile->at.facing };
    for (int c = 0; c < 3; c++) {
        args.normal[c] = tile->surface.normal[c];
        args.direction[c] = tile->rays.direction[c];
    }
    frame->stages->geometry[frame->plan->desc.precision].view(&args);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_MICROFACET_VIEW, false);
}

static void facet(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, const uint32_t *slot, uint32_t count)
{
    const glint_plan *plan = frame->plan;
    const glint_plan_light *light = &plan->lights[first + slot[0]];
    glint_facet_args args = { .group_count = tile->group_count,
                              .camera = glint_tile_rays_of(tile),
                              .material = tile->surface.material,
                              .materials = plan->materials,
                              .directional = light->directional,
                              .scale = light->scale,
                              .sample_count = count };
    vec_copy(args.position, light->position);
    for (uint32_t i = 0; i < count; i++) {
        args.light_sample[i] = glint_tile_light_sample_of(tile, &plan->lights[first + slot[i]]);
        args.lit[i] = tile->at.light[slot[i]].lit;
        args.sine2[i] = tile->at.light[slot[i]].sine2;
        args.schlick[i] = tile->at.light[slot[i]].schlick;
    }
    for (int c = 0; c < 3; c++) {
        args.point[c] = tile->surface.point[c];
        args.normal[c] = tile->surface.normal[c];
        args.direction[c] = tile->rays.direction[c];
    }
    frame->stages->geometry[plan->desc.precision].facet(&args);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_MICROFACET, false);
    tile->counts.runs[GLINT_STAGE_MICROFACET] += count - 1;
}

static bool called(const glint_plan *plan) { return glint_plan_is_lit(plan) && plan->facets; }

/// Computes the viewing angles of microfacets.
static void find_view(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (view_memory(tile, frame, walk->sample)) {
        glint_tile_count_stage(tile, frame, GLINT_STAGE_MICROFACET_VIEW, true);
        return;
    }
    glint_tile_need_points(tile, frame, walk);
    view(tile, frame);
}

/// Computes the angles of microfacets for the rows of a light.
static void find_facets(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    uint32_t unknown[GLINT_LIGHT_CHUNK], unknown_count = 0;
    for (uint32_t i = walk->slot; i < walk->slot + walk->count; i++) {
        if (facet_memory(tile, frame, walk->sample, walk->from + i, i))
            glint_tile_count_stage(tile, frame, GLINT_STAGE_MICROFACET, true);
        else
            unknown[unknown_count++] = i;
    }
    if (!unknown_count)
        return;
    glint_tile_need_points(tile, frame, walk);
    facet(tile, frame, walk->from, unknown, unknown_count);
}

static void *create(const glint_plan *plan)
{
    (void)plan;
    return glint_alloc(1, sizeof(glint_tile_facets));
}

const glint_stage glint_stage_microfacet_view = {
    .name = "view",
    .doc = "cosine of the viewing angle at each point, for microfacets",
    .called = called,
    .reads = GLINT_READS_OWN(BUMP),
    .step[GLINT_AT_LIT] = find_view,
    .create = create,
    .destroy = free,
    .shared = true,
};

const glint_stage glint_stage_microfacet = {
    .name = "facet",
    .doc = "half vector and Fresnel factor of each light, for microfacets",
    .called = called,
    .per_light = true,
    .remote = true,
    .step = { [GLINT_AT_LIGHT] = find_facets, [GLINT_AT_KEYS] = sign },
};
