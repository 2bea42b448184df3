#include "engine/render/reuse/reuse.h"
#include "engine/base/alloc.h"
#include "engine/render/effects/bounce/plan.h"
#include "engine/render/stages/simd/coefficients.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// Blocks are cut from large chunks of memory, so that many tiles share few pages.
#define CHUNK_BYTES ((size_t)4 << 20)
#define BLOCK_ALIGN 64

void glint_reuse_init(glint_reuse *reuse, bool on, size_t budget)
{
    memset(reuse, 0, sizeof *reuse);
    pthread_mutex_init(&reuse->lock, NULL);
    reuse->on = on;
    reuse->budget = budget ? budget : (size_t)sysconf(_SC_PHYS_PAGES) / 4 * (size_t)sysconf(_SC_PAGESIZE);
}

void glint_reuse_clear(glint_reuse *reuse)
{
    while (reuse->chunk) {
        void *before = *(void **)reuse->chunk;
        free(reuse->chunk);
        reuse->chunk = before;
    }
    for (size_t i = 0; i < reuse->tile_count; i++)
        free(reuse->tiles[i].lights);
    free(reuse->tiles);
    reuse->tiles = NULL;
    reuse->tile_count = reuse->used = reuse->free_bytes = 0;
    reuse->light_count = 0;
    reuse->cast = reuse->pattern = reuse->view = (glint_key) { 0 };
    memset(reuse->light, 0, sizeof reuse->light);
}

void glint_reuse_destroy(glint_reuse *reuse)
{
    glint_reuse_clear(reuse);
    glint_splits_clear(&reuse->splits);
    free(reuse->positions);
    pthread_mutex_destroy(&reuse->lock);
}

/// Makes the slots of every tile, or none at all.
static void make_slots(glint_reuse *reuse, const glint_plan *plan, size_t tile_count, uint32_t light_count)
{
    reuse->width = (uint32_t)plan->desc.width;
    reuse->height = (uint32_t)plan->desc.height;
    reuse->samples = (uint32_t)plan->desc.samples;
    reuse->real_size = plan->desc.precision == GLINT_PRECISION_FLOAT ? sizeof(float) : sizeof(double);
    reuse->plain = plan->geometry->index->plain;
    reuse->plane_count = plan->patterns ? plan->patterns->plane_count : 0;
    const size_t bytes = tile_count * (sizeof *reuse->tiles + light_count * sizeof *reuse->tiles->lights);
    if (bytes > reuse->budget - reuse->pictures || !(reuse->tiles = calloc(tile_count, sizeof *reuse->tiles)))
        return;
    reuse->light_count = light_count;
    for (reuse->tile_count = 0; reuse->tile_count < tile_count; reuse->tile_count++) {
        glint_cached_tile *tile = &reuse->tiles[reuse->tile_count];
        tile->lights = calloc(light_count ? light_count : 1, sizeof *tile->lights);
        if (!tile->lights) {
            glint_reuse_clear(reuse);
            return;
        }
    }
    reuse->used = bytes;
}

void glint_reuse_begin(glint_reuse *reuse, const glint_plan *plan, size_t tile_count)
{
    if (!reuse->on)
        return;
    const uint32_t lights = plan->light_count < GLINT_CACHED_LIGHTS ? plan->light_count : GLINT_CACHED_LIGHTS;
    const size_t real_size = plan->desc.precision == GLINT_PRECISION_FLOAT ? sizeof(float) : sizeof(double);
    if (reuse->tile_count != tile_count || reuse->width != plan->desc.width || reuse->height != plan->desc.height ||
        reuse->samples != plan->desc.samples || reuse->real_size != real_size || reuse->light_count != lights ||
        reuse->plain != plan->geometry->index->plain ||
        reuse->plane_count != (plan->patterns ? plan->patterns->plane_count : 0)) {
        glint_reuse_clear(reuse);
        make_slots(reuse, plan, tile_count, lights);
    }
    const bool is_eager = reuse->is_eager && !plan->base && !plan->is_base;
    reuse->caches_cast = is_eager || glint_key_equal(reuse->cast, plan->keys[GLINT_STAGE_CAST]);
    reuse->cast = plan->keys[GLINT_STAGE_CAST];
    reuse->caches_pattern = plan->patterns && glint_key_equal(reuse->pattern, plan->keys[GLINT_STAGE_PATTERN]);
    reuse->pattern = plan->keys[GLINT_STAGE_PATTERN];
    glint_splits_begin(&reuse->splits, plan);
    reuse->caches_view = is_eager || glint_key_equal(reuse->view, plan->keys[GLINT_STAGE_MICROFACET_VIEW]);
    reuse->view = plan->keys[GLINT_STAGE_MICROFACET_VIEW];
    for (uint32_t i = 0; i < reuse->light_count; i++) {
        reuse->caches_light[i] = glint_key_equal(reuse->light[i], plan->lights[i].key);
        reuse->light[i] = plan->lights[i].key;
    }
}

bool glint_reuse_shows_more(const glint_cached_tile *tile, const glint_plan *plan)
{
    if (plan->derivatives || plan->runs[GLINT_STAGE_INDIRECT] || (plan->runs[GLINT_STAGE_VERTEX_SHADING] && tile->shading_points))
        return true;
    if (!glint_plan_sends_rays(plan) || plan->tints || tile->shown_count > GLINT_SHOWN_MAX)
        return glint_plan_sends_rays(plan) || plan->tints;
    for (uint32_t i = 0; i < tile->shown_count; i++) {
        if (glint_sends_on(&plan->bouncing[tile->shown[i]]))
            return true;
    }
    return false;
}

/// Returns whether the highlight of a material may be above 0 in the tile.
static bool shines(const glint_reuse *reuse, const glint_cached_tile *tile, const glint_plan *plan, uint32_t index)
{
    const glint_shade_material *material = &plan->materials[index];
    if ((material->highlight != GLINT_HIGHLIGHT_PHONG && material->highlight != GLINT_HIGHLIGHT_BLINN) ||
        plan->light_count > reuse->light_count || material->planes)
        return true;
    for (uint32_t i = 0; i < reuse->light_count; i++)
        if (tile->lights[i].reaches && !(material->shininess * tile->lights[i].brightest < GLINT_EXP2_LOWEST))
            return true;
    return false;
}

/// Continues a key with the materials that are visible in the tile.
static glint_key materials_key(const glint_reuse *reuse, const glint_cached_tile *tile, const glint_plan *plan, glint_key key)
{
    if (tile->shown_count > GLINT_SHOWN_MAX)
        return glint_key_mix(key, plan->all_materials_key);
    for (uint32_t i = 0; i < tile->shown_count; i++) {
        const uint32_t shown = tile->shown[i];
        key = glint_key_mix(key, (shines(reuse, tile, plan, shown) ? plan->material_keys : plan->matte_keys)[shown]);
    }
    return key;
}

glint_key glint_reuse_film_key(const glint_reuse *reuse, const glint_cached_tile *tile, const glint_plan *plan)
{
    if (!glint_key_equal(tile->seen, plan->keys[GLINT_STAGE_SURFACE]))
        return (glint_key) { 0 };
    glint_key key = glint_key_mix(plan->keys[GLINT_STAGE_SURFACE], plan->output_key);
    if (tile->background)
        key = glint_key_mix(key, plan->background_key);
    if (tile->shown_count == 0)
        return key;
    if (glint_reuse_shows_more(tile, plan)) {
        key = glint_key_mix(glint_key_mix(key, plan->all_materials_key), plan->all_lights_key);
        return glint_key_mix(key, plan->background_key);
    }
    key = materials_key(reuse, tile, plan, key);
    for (uint32_t i = 0; i < reuse->light_count; i++) {
        const glint_cached_light *light = &tile->lights[i];
        if (!glint_key_equal(light->position, plan->lights[i].position_key))
            return (glint_key) { 0 };
        if (light->reaches)
            key = glint_key_mix(key, plan->lights[i].color_key);
    }
    if (plan->light_count > reuse->light_count)
        key = glint_key_mix(key, plan->all_lights_key);
    return key;
}

bool glint_reuse_reserve(glint_reuse *reuse, size_t bytes)
{
    const size_t half = reuse->budget / 2;
    if (!reuse->on || bytes > half || reuse->pictures > half - bytes ||
        reuse->used > reuse->budget - reuse->pictures - bytes)
        return false;
    reuse->pictures += bytes;
    return true;
}

void glint_reuse_unreserve(glint_reuse *reuse, size_t bytes) { reuse->pictures -= bytes; }

/// Makes a chunk for blocks of this size: a large one if it fits into the budget.
static bool add_chunk(glint_reuse *reuse, size_t bytes)
{
    const size_t available = reuse->budget - reuse->pictures, least = bytes + BLOCK_ALIGN;
    const size_t whole =
        least < CHUNK_BYTES && available >= CHUNK_BYTES && reuse->used <= available - CHUNK_BYTES ? CHUNK_BYTES : least;
    if (whole > available || reuse->used > available - whole)
        return false;
    char *chunk = glint_alloc_large(whole, 1);
    if (!chunk)
        return false;
    *(void **)(void *)chunk = reuse->chunk;
    reuse->chunk = chunk;
    reuse->free = chunk + BLOCK_ALIGN;
    reuse->free_bytes = whole - BLOCK_ALIGN;
    reuse->used += whole;
    return true;
}

/// Returns a block of uninitialised memory within the budget, or NULL. The block is valid until the whole cache is
/// cleared.
static void *hold(glint_reuse *reuse, size_t bytes)
{
    void *block = NULL;
    bytes = (bytes + BLOCK_ALIGN - 1) / BLOCK_ALIGN * BLOCK_ALIGN;
    pthread_mutex_lock(&reuse->lock);
    if (bytes <= reuse->free_bytes || add_chunk(reuse, bytes)) {
        block = reuse->free;
        reuse->free += bytes;
        reuse->free_bytes -= bytes;
    }
    pthread_mutex_unlock(&reuse->lock);
    return block;
}

bool glint_reuse_hold_cast(glint_reuse *reuse, glint_cached_tile *tile)
{
    const size_t samples = (size_t)reuse->samples * GLINT_TILE_SAMPLES;
    if (!tile->t) {
        char *block = hold(reuse, samples * (reuse->real_size + sizeof(uint32_t)) + samples / 8);
        if (!block)
            return false;
        tile->t = block;
        tile->prim = (uint32_t *)(block + samples * reuse->real_size);
        tile->hits = (uint16_t *)(tile->prim + samples);
    }
    return true;
}

bool glint_reuse_hold_light(glint_reuse *reuse, glint_cached_light *light)
{
    const size_t samples = (size_t)reuse->samples * GLINT_TILE_SAMPLES;
    if (!light->cosine) {
        float *block = hold(reuse, 3 * samples * sizeof *block + samples / 8);
        if (!block)
            return false;
        light->cosine = block;
        light->attenuation = block + samples;
        light->log2_specular = block + 2 * samples;
        light->lit = (uint16_t *)(block + 3 * samples);
    }
    return true;
}

bool glint_reuse_hold_occlude(glint_reuse *reuse, glint_cached_light *light, bool caps)
{
    const size_t samples = (size_t)reuse->samples * GLINT_TILE_SAMPLES;
    if (!light->unoccluded)
        light->unoccluded = hold(reuse, samples / 8);
    if (light->unoccluded && caps && !light->visible)
        light->visible = hold(reuse, samples * sizeof *light->visible);
    return light->unoccluded != NULL && (light->visible || !caps);
}

bool glint_reuse_hold_planes(glint_reuse *reuse, glint_cached_tile *tile)
{
    if (!tile->planes)
        tile->planes =
            hold(reuse, (size_t)reuse->samples * reuse->plane_count * GLINT_TILE_SAMPLES * sizeof *tile->planes);
    return tile->planes != NULL;
}

bool glint_reuse_hold_values(glint_reuse *reuse, glint_cached_tile *tile)
{
    const size_t bytes = reuse->samples * glint_splits_bytes(&reuse->splits);
    if (bytes <= tile->value_bytes)
        return true;
    void *values = hold(reuse, bytes);
    if (!values) // the contents and their keys stay
        return false;
    tile->values = values;
    tile->value_bytes = bytes;
    tile->split = (glint_key) { 0 };
    return true;
}

bool glint_reuse_hold_view(glint_reuse *reuse, glint_cached_tile *tile)
{
    if (!tile->facing)
        tile->facing = hold(reuse, (size_t)reuse->samples * GLINT_TILE_SAMPLES * sizeof *tile->facing);
    return tile->facing != NULL;
}

bool glint_reuse_hold_facet(glint_reuse *reuse, glint_cached_light *light)
{
    const size_t samples = (size_t)reuse->samples * GLINT_TILE_SAMPLES;
    if (!light->sine2) {
        float *block = hold(reuse, 2 * samples * sizeof *block);
        if (!block)
            return false;
        light->sine2 = block;
        light->schlick = block + samples;
    }
    return true;
}
