/// Caches results of frames before the last. The keys of recent frames are remembered. If a key recurs, the following
/// keys will probably recur, too. From then on results are cached, and when the key changes they are set aside
/// instead of overwritten. Whole tiles are set aside if the hits' key changes (alternating cameras), otherwise single
/// lights (a lamp moving in a circle).
///
/// All results of one kind take the same time and memory, so the least recently used one is evicted.
#include "engine/render/reuse/reuse.h"

#include <stdlib.h>
#include <string.h>

/// With fewer primitives than this for each row of a light, computing the light takes no longer than reading a stored
/// result.
#define EARLIER_PRIMS 128

static const glint_key none = { 0 };

/// Returns how many results can be set aside, at most `most`. They may take half of the budget that is left by whole
/// pictures.
static size_t slots_for(const glint_reuse *reuse, size_t bytes, size_t most)
{
    const size_t fits = (reuse->budget - reuse->pictures) / 2 / bytes;
    return fits < most ? fits : most;
}

bool glint_recent_has(glint_recent *recent, size_t size, glint_key key)
{
    bool found = false;
    for (size_t i = 0; i < size && i < GLINT_EARLIER_MAX; i++)
        found = found || glint_key_equal(recent->keys[i], key);
    if (!found && size > 0)
        recent->keys[recent->next++ % size] = key;
    return found;
}

// ---- Lights ----

static size_t light_bytes(const glint_reuse *reuse)
{
    const size_t samples = (size_t)reuse->samples * GLINT_TILE_SAMPLES;
    return reuse->tile_count * (sizeof(glint_cached_light) + 3 * samples * sizeof(float) + samples / 4);
}

/// Returns the index of the set whose results have the key or, for an all-zero key, of a set to overwrite. sets: the
/// number of sets in use. -1: there is no such set.
static int find_set(const glint_earlier *e, int sets, uint32_t row, glint_key key)
{
    int oldest = -1;
    for (int s = 0; s < sets; s++) {
        if (glint_key_equal(e->sets[s].held[row], key))
            return s;
        if (oldest < 0 || e->sets[s].used[row] < e->sets[oldest].used[row])
            oldest = s;
    }
    return glint_key_equal(key, none) ? oldest : -1;
}

static bool make_set(glint_reuse *reuse, glint_earlier_set *set)
{
    const size_t bytes = reuse->tile_count * reuse->light_count * sizeof *set->lights;
    if (!set->lights && bytes <= reuse->budget - reuse->pictures - reuse->used) {
        set->lights = calloc(reuse->tile_count * reuse->light_count, sizeof *set->lights);
        reuse->used += set->lights ? bytes : 0;
    }
    return set->lights != NULL;
}

/// Swaps the results of one light in all tiles with the results in a set. Returns false when out of memory.
static bool exchange_light(glint_reuse *reuse, int s, uint32_t row)
{
    glint_earlier_set *set = &reuse->earlier->sets[s];
    if (!make_set(reuse, set))
        return false;
    for (size_t i = 0; i < reuse->tile_count; i++) {
        glint_cached_light *front = &reuse->tiles[i].lights[row], *other = &set->lights[i * reuse->light_count + row];
        const glint_cached_light light = *front;
        *front = *other;
        *other = light;
    }
    set->held[row] = reuse->light_recurs[row] ? reuse->light[row] : none;
    set->used[row] = ++reuse->earlier->frame;
    return true;
}

/// Returns whether the results of a light with a new key are cached in this frame.
static bool find_light(glint_reuse *reuse, uint32_t row, glint_key key)
{
    glint_earlier *e = reuse->earlier;
    const int sets = (int)slots_for(reuse, reuse->light_count * light_bytes(reuse), GLINT_EARLIER_MAX);
    const bool again = glint_recent_has(&e->lights[row], (size_t)sets, key);
    int s = again ? find_set(e, sets, row, key) : -1;
    if (s < 0 && reuse->light_recurs[row])
        s = find_set(e, sets, row, none);
    if (s >= 0)
        exchange_light(reuse, s, row);
    reuse->light_recurs[row] = again;
    return again;
}

/// Drops results that cover only the pixels chosen by adaptive sampling: their keys do not distinguish the pixels.
static void forget_lights(glint_reuse *reuse)
{
    for (int s = 0; s < GLINT_EARLIER_MAX; s++) {
        glint_earlier_set *set = &reuse->earlier->sets[s];
        memset(set->held, 0, sizeof set->held);
        for (size_t i = 0; set->lights && i < reuse->tile_count * reuse->light_count; i++)
            set->lights[i].light = set->lights[i].facet = set->lights[i].occlude = set->lights[i].position = none;
    }
    memset(reuse->earlier->lights, 0, sizeof reuse->earlier->lights);
    memset(reuse->light_recurs, 0, sizeof reuse->light_recurs);
}

/// Returns whether the results of a light are expensive enough to be worth their memory. Each sample of an area light
/// has its own row, but all samples share one search for occluders, so more samples make each row cheaper.
static bool is_dear(const glint_plan *plan, uint32_t row)
{
    size_t rows = 0;
    for (uint32_t i = 0; i < plan->light_count; i++)
        rows += plan->lights[i].source == plan->lights[row].source;
    return plan->geometry->table.prim_count >= EARLIER_PRIMS * rows;
}

void glint_earlier_lights(glint_reuse *reuse, const glint_plan *plan)
{
    const bool looks = reuse->earlier && !plan->base;
    if (plan->base && reuse->earlier)
        forget_lights(reuse);
    for (uint32_t i = 0; i < reuse->light_count; i++) {
        const glint_key key = plan->lights[i].key;
        reuse->caches_light[i] = glint_key_equal(reuse->light[i], key);
        if (!reuse->caches_light[i] && looks && is_dear(plan, i))
            reuse->caches_light[i] = find_light(reuse, i, key);
        reuse->light[i] = key;
    }
}

// ---- Whole tiles ----

static size_t tiles_bytes(const glint_reuse *reuse)
{
    const size_t samples = (size_t)reuse->samples * GLINT_TILE_SAMPLES;
    return reuse->tile_count * (sizeof *reuse->tiles + samples * (reuse->real_size + sizeof(uint32_t)) + samples / 8) +
           reuse->light_count * light_bytes(reuse);
}

static void free_tiles(glint_cached_tile *tiles, size_t count)
{
    for (size_t i = 0; tiles && i < count; i++)
        free(tiles[i].lights);
    free(tiles);
}

static bool make_tiles(glint_reuse *reuse, glint_earlier_tiles *slot)
{
    const size_t bytes = reuse->tile_count * (sizeof *reuse->tiles + reuse->light_count * sizeof *reuse->tiles->lights);
    if (slot->tiles || bytes > reuse->budget - reuse->pictures - reuse->used)
        return slot->tiles != NULL;
    bool good = (slot->tiles = calloc(reuse->tile_count, sizeof *slot->tiles)) != NULL;
    for (size_t i = 0; i < reuse->tile_count && good; i++)
        good = (slot->tiles[i].lights = calloc(reuse->light_count + 1, sizeof *slot->tiles->lights)) != NULL;
    if (!good) {
        free_tiles(slot->tiles, reuse->tile_count);
        slot->tiles = NULL;
    }
    reuse->used += good ? bytes : 0;
    return good;
}

static void exchange_tiles(glint_reuse *reuse, glint_earlier_tiles *slot)
{
    if (!make_tiles(reuse, slot))
        return;
    const glint_earlier_tiles other = *slot;
    slot->tiles = reuse->tiles;
    slot->cast = reuse->cast_recurs ? reuse->cast : none;
    slot->used = reuse->earlier->frame;
    memcpy(slot->light, reuse->light, sizeof slot->light);
    memcpy(slot->light_recurs, reuse->light_recurs, sizeof slot->light_recurs);
    reuse->tiles = other.tiles;
    memcpy(reuse->light, other.light, sizeof reuse->light);
    memcpy(reuse->light_recurs, other.light_recurs, sizeof reuse->light_recurs);
}

bool glint_earlier_find_tiles(glint_reuse *reuse, glint_key key)
{
    if (!reuse->earlier && reuse->tile_count &&
        sizeof *reuse->earlier <= (reuse->budget - reuse->pictures - reuse->used) / 16) {
        reuse->earlier = calloc(1, sizeof *reuse->earlier);
        reuse->used += reuse->earlier ? sizeof *reuse->earlier : 0;
    }
    glint_earlier *e = reuse->earlier;
    if (!e || glint_key_equal(reuse->cast, key))
        return glint_key_equal(reuse->cast, key);
    e->frame++;
    const int slots = (int)slots_for(reuse, tiles_bytes(reuse), GLINT_EARLIER_TILES);
    const bool again = glint_recent_has(&e->casts, (size_t)slots, key);
    glint_earlier_tiles *slot = NULL, *oldest = NULL;
    for (int i = 0; i < slots; i++) {
        slot = again && glint_key_equal(e->tiles[i].cast, key) ? &e->tiles[i] : slot;
        oldest = !oldest || e->tiles[i].used < oldest->used ? &e->tiles[i] : oldest;
    }
    if (slot || (oldest && reuse->cast_recurs))
        exchange_tiles(reuse, slot ? slot : oldest);
    reuse->cast_recurs = again;
    return again;
}

void glint_earlier_clear(glint_reuse *reuse)
{
    glint_earlier *e = reuse->earlier;
    for (int s = 0; e && s < GLINT_EARLIER_MAX; s++)
        free(e->sets[s].lights);
    for (int i = 0; e && i < GLINT_EARLIER_TILES; i++)
        free_tiles(e->tiles[i].tiles, reuse->tile_count);
    free(e);
    reuse->earlier = NULL;
    reuse->cast_recurs = false;
    memset(reuse->light_recurs, 0, sizeof reuse->light_recurs);
}
