/// Retains results after a change of geometry. If a few primitives have moved, appeared or disappeared, a tile that
/// shows none of these primitives, before or after the change, retains its hits. A light retains its shadows in a
/// tile if none of these primitives crosses the segments from the light to the tile's points. Such results get the
/// new plan's keys before the frame begins.
#include "engine/base/vec.h"
#include "engine/render/reuse/between.h"
#include "engine/render/reuse/reuse.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// in scenes with more primitives, frames after too many changes pause the search for changes
#define CARRY_PRIMS 16384u
/// in scenes with more primitives, the first frame does not record positions, because the positions are of no use if
/// only one picture is rendered
#define CARRY_AT_ONCE 131072u
#define CARRY_CHANGES 64 ///< if more primitives have changed, no results are retained
#define CARRY_PAUSE_MAX 16 ///< longest pause of the search for changes, in frames

typedef struct carry {
    glint_reuse *reuse;
    const glint_plan *plan;
    const glint_plan *before; ///< the same plan, but with the positions of the last frame, for its keys
    glint_ball balls[2 * CARRY_CHANGES]; ///< balls around all changed primitives, before and after the change
    uint32_t ball_count;
    const uint32_t *moved_to; ///< the new index of each primitive of the last frame; NULL: all indices are unchanged
    glint_image *const *images;
    uint32_t image_count;
} carry;

// ---- Changes ----

/// Returns the position of every primitive, by id. NULL: out of memory.
static glint_cached_position *find_positions(const glint_geometry *geometry, uint32_t count)
{
    glint_cached_position *positions = malloc((count + 1) * sizeof *positions);
    for (uint32_t id = 0; positions && id < count; id++)
        positions[id].at = GLINT_MISS;
    for (uint32_t i = 0; positions && i < geometry->table.prim_count; i++) {
        const glint_prim *prim = &geometry->prims[i];
        glint_cached_position *position = &positions[prim->id];
        double numbers[GLINT_PRIM_RECORD_MAX], lower[3], upper[3], half[3];
        const size_t bytes = (size_t)glint_prim_record(geometry, prim, numbers) * sizeof *numbers;
        position->key = glint_key_add((glint_key) { 0 }, numbers, bytes);
        position->at = i;
        position->radius = HUGE_VAL;
        if (!glint_prim_bounded(prim))
            continue;
        glint_prim_bounds(geometry->solids, prim, lower, upper);
        for (int c = 0; c < 3; c++) {
            position->center[c] = 0.5 * lower[c] + 0.5 * upper[c];
            half[c] = 0.5 * upper[c] - 0.5 * lower[c];
        }
        position->radius = prim->kind == GLINT_PRIM_SPHERE ? prim->radius : sqrt(vec_dot(half, half));
    }
    for (uint32_t i = 0; positions && i < geometry->member_count; i++) // the key of a combined solid includes its parts
        positions[geometry->members[i].id] = (glint_cached_position) { .at = geometry->table.prim_count + i };
    return positions;
}

static bool add_ball(carry *c, const glint_cached_position *position)
{
    if (position->at == GLINT_MISS)
        return true;
    if (!(position->radius < HUGE_VAL) || c->ball_count == 2 * CARRY_CHANGES)
        return false;
    glint_ball *b = &c->balls[c->ball_count++];
    vec_copy(b->center, position->center);
    b->radius = position->radius;
    return true;
}

/// Lists the changes. Returns false if there are too many.
static bool find_changes(carry *c, const glint_cached_position *was, const glint_cached_position *is, uint32_t count)
{
    for (uint32_t id = 0; id < count; id++) {
        const bool both = was[id].at != GLINT_MISS && is[id].at != GLINT_MISS;
        if (both ? glint_key_equal(was[id].key, is[id].key) : was[id].at == is[id].at)
            continue;
        if (!add_ball(c, &was[id]) || !add_ball(c, &is[id]))
            return false;
    }
    return true;
}

// ---- New keys ----

static void renew(glint_key *key, glint_key before, glint_key now)
{
    if (glint_key_equal(*key, before))
        *key = now;
}

/// Returns the new index of a primitive. GLINT_MISS and the values of lanes outside the picture do not change.
static uint32_t moved(const carry *c, uint32_t index)
{
    return c->moved_to && index < c->reuse->position_count ? c->moved_to[index] : index;
}

static void carry_hits(const carry *c, glint_cached_tile *tile)
{
    const glint_key *was = c->before->keys, *is = c->plan->keys;
    const bool hits = tile->t && glint_key_equal(tile->cast, was[GLINT_STAGE_CAST]);
    for (size_t i = 0; hits && c->moved_to && i < (size_t)c->reuse->samples * GLINT_TILE_SAMPLES; i++)
        tile->prim[i] = moved(c, tile->prim[i]);
    if (glint_key_equal(tile->seen, was[GLINT_STAGE_SURFACE]))
        tile->only = moved(c, tile->only);
    if (glint_key_equal(tile->boxed, was[GLINT_STAGE_SURFACE]))
        tile->box.only = moved(c, tile->box.only);
    renew(&tile->cast, was[GLINT_STAGE_CAST], is[GLINT_STAGE_CAST]);
    renew(&tile->pattern, was[GLINT_STAGE_PATTERN], is[GLINT_STAGE_PATTERN]);
    renew(&tile->view, was[GLINT_STAGE_MICROFACET_VIEW], is[GLINT_STAGE_MICROFACET_VIEW]);
    renew(&tile->seen, was[GLINT_STAGE_SURFACE], is[GLINT_STAGE_SURFACE]);
    renew(&tile->boxed, was[GLINT_STAGE_SURFACE], is[GLINT_STAGE_SURFACE]);
}

/// Renews the lights' keys. Returns whether all shadows are unchanged.
static bool carry_lights(const carry *c, glint_cached_tile *tile, bool boxed, uint32_t column, uint32_t row)
{
    bool all = true;
    for (uint32_t i = 0; i < c->reuse->light_count; i++) {
        const glint_plan_light *was = &c->before->lights[i], *is = &c->plan->lights[i];
        glint_cached_light *light = &tile->lights[i];
        const bool ordered =
            // visible shares are multiplied in the order of the primitives, and each product is rounded
            is->cap && c->moved_to;
        const bool clear = boxed && !ordered && !glint_may_shade(c->plan, is, &tile->box, c->balls, c->ball_count, column, row);
        const bool open = !is->shadows || clear;
        renew(&light->light, was->key, is->key);
        if (open) {
            renew(&light->occlude, was->key, is->key);
            renew(&light->position, was->position_key, is->position_key);
        }
        all = all && open;
    }
    return all && c->plan->light_count <= c->reuse->light_count;
}

static void carry_tile(const carry *c, size_t index, uint32_t column, uint32_t row)
{
    glint_cached_tile *tile = &c->reuse->tiles[index];
    const glint_key surface = c->before->keys[GLINT_STAGE_SURFACE];
    const bool seen = glint_key_equal(tile->seen, surface), boxed = glint_key_equal(tile->boxed, surface);
    if ((!seen && !glint_key_equal(tile->cast, c->before->keys[GLINT_STAGE_CAST])) ||
        glint_may_show(c->plan, c->balls, c->ball_count, column, row))
        return;
    const glint_key film = glint_reuse_film_key(c->reuse, tile, c->before);
    const bool more = tile->shown_count > 0 && glint_reuse_shows_more(tile, c->plan);
    carry_hits(c, tile);
    const bool lit = carry_lights(c, tile, boxed, column, row);
    if (!seen || more || (!lit && tile->shown_count > 0))
        return;
    const glint_key now = glint_reuse_film_key(c->reuse, tile, c->plan), none = { 0 };
    for (uint32_t i = 0; i < c->image_count && !glint_key_equal(film, none); i++)
        if (c->images[i] && c->images[i]->film)
            renew(&c->images[i]->film[index].key, film, now);
}

static void carry_all(const carry *c)
{
    glint_reuse *reuse = c->reuse;
    const uint32_t across = (reuse->width + GLINT_TILE_WIDTH - 1) / GLINT_TILE_WIDTH;
    for (size_t i = 0; i < reuse->tile_count; i++)
        carry_tile(c, i, (uint32_t)(i % across), (uint32_t)(i / across));
    reuse->cast = c->plan->keys[GLINT_STAGE_CAST]; // unchanged positions may be cached from now on
    renew(&reuse->pattern, c->before->keys[GLINT_STAGE_PATTERN], c->plan->keys[GLINT_STAGE_PATTERN]);
    renew(&reuse->view, c->before->keys[GLINT_STAGE_MICROFACET_VIEW], c->plan->keys[GLINT_STAGE_MICROFACET_VIEW]);
    for (uint32_t i = 0; i < reuse->light_count; i++)
        renew(&reuse->light[i], c->before->lights[i].key, c->plan->lights[i].key);
}

/// Computes the new index of each primitive of the last frame. Returns false when out of memory. *moved_to is NULL if
/// all indices are unchanged.
static bool find_moves(const glint_cached_position *was, const glint_cached_position *is, uint32_t count,
                       uint32_t **moved_to)
{
    bool same = true;
    for (uint32_t id = 0; id < count; id++)
        same = same && (was[id].at == GLINT_MISS || was[id].at == is[id].at);
    *moved_to = same ? NULL : calloc(count + 1, sizeof **moved_to);
    for (uint32_t id = 0; *moved_to && id < count; id++)
        if (was[id].at != GLINT_MISS)
            (*moved_to)[was[id].at] = is[id].at;
    return same || *moved_to;
}

/// Retains results across a change. Returns false if there are too many changes.
static bool carry_changes(carry *c, const glint_cached_position *is, uint32_t count)
{
    const glint_cached_position *was = c->reuse->positions;
    glint_plan_twin twin;
    uint32_t *moved_to = NULL;
    if (!find_changes(c, was, is, count))
        return false;
    if (!find_moves(was, is, count, &moved_to))
        return true;
    carry whole = *c;
    whole.moved_to = moved_to;
    whole.before = &twin.plan;
    if (glint_plan_twin_make(&twin, c->plan, c->reuse->where) &&
        glint_key_equal(c->reuse->cast, twin.plan.keys[GLINT_STAGE_CAST]))
        carry_all(&whole);
    glint_plan_twin_free(&twin);
    free(moved_to);
    return true;
}

/// Returns whether to record the positions of this frame. With many primitives, frames are skipped if most primitives
/// move.
static bool is_worth_finding(glint_reuse *reuse, uint32_t count)
{
    if (count * sizeof(glint_cached_position) >= reuse->budget / 64)
        return false;
    if (count > CARRY_AT_ONCE && glint_key_equal(reuse->where, (glint_key) { 0 }))
        return false;
    if (count <= CARRY_PRIMS || reuse->carry_wait == 0)
        return true;
    reuse->carry_wait--;
    return false;
}

/// After a frame with many changes, doubles the pause.
static void wait_longer(glint_reuse *reuse)
{
    reuse->carry_pause = reuse->carry_pause ? reuse->carry_pause * 2 : 1;
    if (reuse->carry_pause > CARRY_PAUSE_MAX)
        reuse->carry_pause = CARRY_PAUSE_MAX;
    reuse->carry_wait = reuse->carry_pause;
}

void glint_reuse_carry(glint_reuse *reuse, const glint_plan *plan, glint_image *const *images, uint32_t image_count)
{
    const glint_geometry *geometry = plan->geometry;
    const uint32_t count = geometry->id_count, lights = plan->light_count;
    const bool plain = reuse->plain == geometry->index->plain; // otherwise equal positions may be in another order
    if (!reuse->on || (plain && glint_key_equal(reuse->where, geometry->where)))
        return;
    carry c = { .reuse = reuse, .plan = plan, .images = images, .image_count = image_count };
    glint_cached_position *positions = is_worth_finding(reuse, count) ? find_positions(geometry, count) : NULL;
    const bool comparable = plain && reuse->positions && positions && reuse->position_count == count &&
                            reuse->tile_count > 0 &&
                            reuse->scale == geometry->table.scale && // with another scale, other values underflow
                            reuse->light_count == (lights < GLINT_CACHED_LIGHTS ? lights : GLINT_CACHED_LIGHTS);
    if (comparable && plan->desc.precision == GLINT_PRECISION_DOUBLE && !glint_plan_cuts(plan)) {
        if (carry_changes(&c, positions, count))
            reuse->carry_pause = 0;
        else
            wait_longer(reuse);
    }
    free(reuse->positions);
    reuse->positions = positions;
    reuse->position_count = count;
    reuse->where = geometry->where;
    reuse->scale = geometry->table.scale;
}
