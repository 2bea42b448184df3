/// What lies beyond the first surface of a tile: mirrored and refracted rays, and what they find.
///
/// Rays wait in levels of at most one tile's samples. A batch is all that waits in the highest level, and where a surface
/// sends on two rays, the weaker goes a level up and the stronger stays: so a level never holds more than the batch that
/// filled it, and a ray of level n has at most 2^-n of the first one's weight wherever mirror + transmission is at most 1.
/// That bounds the memory, however long the chains are. The order of a pixel's rays, and so of its sums, depends on
/// nothing but that pixel.
///
/// Where both rays of a surface were followed for ever, their number would double with each. Beyond GLINT_BOUNCE_SPLITS
/// surfaces one, drawn by lot as they weigh, stands for both with the weight of the two: no light is lost, and work no longer
/// doubles. The lot is made of the ray's own bits, so that it falls the same everywhere.
///
/// A ray too weak to be seen is not followed: all that a sample loses so is at most GLINT_BOUNCE_LOSS of linear light, by
/// the plan's bound of what any ray can bring. That is 1/318 of the smallest step between two 8-bit sRGB codes.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/tile/derivative/work.h"

#include <stdlib.h>
#include <string.h>

struct glint_bounce {
    glint_batch batch;
    glint_rays room[GLINT_BOUNCE_LEVELS];
    glint_rays *levels[GLINT_BOUNCE_LEVELS]; ///< each in some room, or the batch's own: what is taken changes places with it
    uint32_t counts[GLINT_BOUNCE_LEVELS];
    double budget[GLINT_TILE_SAMPLES]; ///< light that each sample may still lose
    glint_ray_slope *slopes; ///< what those of all levels and of the batch's own rays are in; NULL until a frame has derivatives
};

/// Not zeroed as a whole: the pages of a level are the system's until it is used.
struct glint_bounce *glint_bounce_create(void)
{
    struct glint_bounce *bounce = aligned_alloc(_Alignof(struct glint_bounce), sizeof *bounce);
    if (!bounce)
        return NULL;
    memset(&bounce->batch, 0, sizeof bounce->batch);
    bounce->slopes = NULL;
    for (int i = 0; i < GLINT_BOUNCE_LEVELS; i++) {
        bounce->room[i].slopes = NULL;
        bounce->levels[i] = &bounce->room[i];
        bounce->counts[i] = 0;
    }
    return bounce;
}

void glint_bounce_destroy(struct glint_bounce *bounce)
{
    if (!bounce)
        return;
    glint_derivative_destroy(bounce->batch.tile.derivative);
    free(bounce->slopes);
    free(bounce);
}

bool glint_bounce_derives(struct glint_bounce *bounce, const glint_plan *plan)
{
    const size_t each = (size_t)GLINT_TILE_SAMPLES * GLINT_DERIVATIVES_MAX;
    if (!bounce->batch.tile.derivative)
        bounce->batch.tile.derivative = glint_derivative_create();
    if (!bounce->slopes)
        bounce->slopes = malloc((GLINT_BOUNCE_LEVELS + 1) * each * sizeof *bounce->slopes); // pages are the system's until used
    for (size_t i = 0; bounce->slopes && i < GLINT_BOUNCE_LEVELS; i++)
        bounce->room[i].slopes = bounce->slopes + i * each;
    if (bounce->slopes)
        bounce->batch.own.slopes = bounce->slopes + GLINT_BOUNCE_LEVELS * each;
    return bounce->slopes && bounce->batch.tile.derivative && glint_derivative_fits(bounce->batch.tile.derivative, plan);
}

bool glint_tile_sends_on(const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_bounce_material *materials = frame->plan->bouncing;
    uint32_t last = GLINT_MISS; // most lanes show what the lane before shows
    if (tile->at.only) {
        const glint_bounce_material *only = &materials[frame->geometry.prims[*tile->at.only].material];
        return only->mirrors || only->transmits;
    }
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned left = tile->at.hits[g]; left; left &= left - 1) {
            const uint32_t material = tile->surface.material[g * GLINT_GROUP + (uint32_t)__builtin_ctz(left)];
            if (material != last && (materials[material].mirrors || materials[material].transmits))
                return true;
            last = material;
        }
    return false;
}

// ---- From a surface on ----

/// The hits of `tile` whose materials send rays on, and whose chain is not at its end.
static bool choose(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    bool any = false;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        bounce->batch.wanted[g] = 0;
        for (unsigned left = tile->at.hits[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            const glint_bounce_material *m = &plan->bouncing[tile->surface.material[i]];
            const uint32_t depth = tile == &bounce->batch.tile ? bounce->batch.rays->depth[bounce->batch.ray_of[i]] : 0;
            if ((m->mirrors || m->transmits) && depth < plan->desc.max_depth)
                bounce->batch.wanted[g] |= (uint16_t)(left & -left);
        }
        any = any || bounce->batch.wanted[g];
    }
    return any;
}

static double total_weight(const glint_ray *ray) { return (ray->weight[0] + ray->weight[1]) + ray->weight[2]; }

/// Whether a ray must be followed; if not, what it might have brought is off the budget.
static bool matters(struct glint_bounce *bounce, const glint_plan *plan, const glint_ray *ray)
{
    double weight = ray->weight[0]; // none is NaN
    for (int c = 1; c < 3; c++)
        weight = ray->weight[c] > weight ? ray->weight[c] : weight;
    if (weight == 0) // of a ray that is none, nothing else may be set
        return false;
    double *budget = &bounce->budget[ray->pixel];
    const double lost = weight * plan->brightest;
    if (!(4 * lost <= *budget))
        return true;
    *budget -= lost;
    return false;
}

/// slopes: of the ray; of frames without derivatives not read.
static void push(struct glint_bounce *bounce, const glint_plan *plan, uint32_t level, const glint_ray *ray,
                 const glint_ray_slope *slopes)
{
    if (level >= GLINT_BOUNCE_LEVELS)
        return;
    const uint32_t count = bounce->counts[level]++;
    if (count % GLINT_GROUP == 0)
        bounce->levels[level]->active[count / GLINT_GROUP] = bounce->levels[level]->inward[count / GLINT_GROUP] = 0;
    glint_rays_put(bounce->levels[level], plan, count, ray);
    if (plan->derivatives)
        memcpy(bounce->levels[level]->slopes + count * plan->derivatives->count, slopes,
               plan->derivatives->count * sizeof *slopes);
}

/// A number in 0 .. 1 that is the ray's own: made of its direction's bits (the finish of splitmix64).
static double lot_of(const glint_ray *ray)
{
    uint64_t z = ray->depth;
    for (int c = 0; c < 3; c++) {
        uint64_t bits;
        memcpy(&bits, &ray->direction[c], sizeof bits);
        z = (z ^ bits) * 0xbf58476d1ce4e5b9u;
        z = (z ^ z >> 27) * 0x94d049bb133111ebu;
        z ^= z >> 31;
    }
    return (double)(z >> 11) * 0x1p-53;
}

/// Gives a ray the weight of another, which then has none.
static void take_weight(const glint_plan *plan, glint_ray *one, glint_ray *other, glint_ray_slope *slopes,
                        const glint_ray_slope *more)
{
    for (int c = 0; c < 3; c++) {
        one->weight[c] = glint_weight(one->weight[c] + other->weight[c]);
        other->weight[c] = 0;
        for (size_t k = 0; plan->derivatives && k < plan->derivatives->count; k++)
            slopes[k].weight[c] += more[k].weight[c];
    }
}

/// One of two rays, by lot as they weigh, gets the weight of both, the other none.
static void stand_for_both(const glint_plan *plan, glint_ray *a, glint_ray *b, glint_ray_slope *a_slopes,
                           glint_ray_slope *b_slopes)
{
    if (!(total_weight(b) > 0) || lot_of(a) * (total_weight(a) + total_weight(b)) < total_weight(a))
        take_weight(plan, a, b, a_slopes, b_slopes);
    else
        take_weight(plan, b, a, b_slopes, a_slopes);
}

/// The mirrored and the refracted ray of one sample, the stronger one staying in `level`.
static void send_on(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                    uint32_t level)
{
    const glint_plan *plan = frame->plan;
    glint_ray mirror, through;
    glint_ray_slope slopes[2][GLINT_DERIVATIVES_MAX];
    glint_batch_split(&bounce->batch, tile, frame, i, &mirror, &through);
    if (plan->derivatives)
        glint_derive_split(&bounce->batch, tile, frame, i, slopes[0], slopes[1]);
    if (tile != &bounce->batch.tile) {
        mirror.term = GLINT_TERM_MIRROR;
        through.term = GLINT_TERM_TRANSMISSION;
    } else if (glint_has_lane(bounce->batch.total, i)) { // both go the same way
        take_weight(plan, &mirror, &through, slopes[0], slopes[1]);
    } else if (mirror.depth > GLINT_BOUNCE_SPLITS) {
        stand_for_both(plan, &mirror, &through, slopes[0], slopes[1]);
    }
    const bool mirrors = matters(bounce, plan, &mirror), transmits = matters(bounce, plan, &through);
    const bool weaker_mirror = mirrors && transmits && total_weight(&mirror) < total_weight(&through);
    if (mirrors)
        push(bounce, plan, level + weaker_mirror, &mirror, slopes[0]);
    if (transmits)
        push(bounce, plan, level + (mirrors && !weaker_mirror), &through, slopes[1]);
}

/// Sends on what the eye's samples have hit, to level 0.
static void spawn_first(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame)
{
    if (!choose(bounce, tile, frame))
        return;
    glint_batch_find_ways(&bounce->batch, tile, frame);
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned left = bounce->batch.wanted[g]; left; left &= left - 1)
            send_on(bounce, tile, frame, g * GLINT_GROUP + (uint32_t)__builtin_ctz(left), 0);
}

/// Sends on what the batch has hit, in the order of its rays; `level` is where these were, and empty.
static void spawn(struct glint_bounce *bounce, const glint_tile_frame *frame, uint32_t level)
{
    const glint_batch *batch = &bounce->batch;
    if (!choose(bounce, &batch->tile, frame))
        return;
    glint_batch_find_ways(&bounce->batch, &batch->tile, frame);
    for (uint32_t g = 0; g < batch->rays->group_count; g++)
        for (unsigned left = batch->rays->active[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            if (glint_batch_has_sample(batch, i) && glint_has_lane(batch->wanted, batch->sample[i]))
                send_on(bounce, &batch->tile, frame, batch->sample[i], level);
        }
}

// ---- A batch ----

/// Takes all rays of a level into the batch.
static void take_level(struct glint_bounce *bounce, uint32_t level, glint_tile_counts *counts)
{
    glint_rays *rays = bounce->levels[level];
    bounce->levels[level] = bounce->batch.rays;
    bounce->batch.rays = rays;
    rays->group_count = (bounce->counts[level] + GLINT_GROUP - 1) / GLINT_GROUP;
    for (uint32_t i = 0; i < bounce->counts[level]; i++) {
        counts->mirror += rays->term[i] == GLINT_TERM_MIRROR;
        counts->refraction += rays->term[i] == GLINT_TERM_TRANSMISSION;
    }
    bounce->counts[level] = 0;
}

/// Adds what the rays found to their pixels, in their order.
static void collect(const glint_batch *batch, const glint_plan *plan, glint_tile *to)
{
    const glint_rays *rays = batch->rays;
    for (uint32_t g = 0; g < rays->group_count; g++)
        for (unsigned left = rays->active[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            double(*sum)[GLINT_TILE_SAMPLES] = to->film.sum[rays->term[i]];
            const uint32_t pixel = rays->pixel[i];
            for (int c = 0; c < 3; c++)
                sum[c][pixel] += rays->weight[c][i] * glint_batch_light_of(batch, plan, c, i);
        }
}

static void run_batch(struct glint_bounce *bounce, glint_tile *to, const glint_tile_frame *frame, uint32_t level)
{
    take_level(bounce, level, &to->counts);
    const bool any = glint_batch_cast(&bounce->batch, frame);
    if (any || bounce->batch.whole)
        glint_batch_light(&bounce->batch, frame, any);
    if (frame->plan->derivatives) {
        if (frame->plan->absorbs)
            glint_derive_absorption(&bounce->batch, frame);
        glint_derive_collect(&bounce->batch, frame->plan, to);
    }
    collect(&bounce->batch, frame->plan, to);
    if (any && frame->plan->runs[GLINT_STAGE_INDIRECT])
        glint_tile_indirect(to, frame, &bounce->batch.tile, &bounce->batch);
    if (any)
        spawn(bounce, frame, level);
}

void glint_tile_bounce(glint_tile *tile, const glint_tile_frame *frame)
{
    struct glint_bounce *bounce = tile->bounce;
    glint_batch_begin(&bounce->batch, tile, frame, GLINT_WALK_BOUNCE);
    bounce->batch.ordered = frame->plan->runs[GLINT_STAGE_INDIRECT]; // whose paths begin in the order of samples
    memset(bounce->counts, 0, sizeof bounce->counts);
    for (int i = 0; i < GLINT_TILE_SAMPLES; i++)
        bounce->budget[i] = GLINT_BOUNCE_LOSS;
    spawn_first(bounce, tile, frame);
    for (uint32_t level = 1;;) {
        while (level > 0 && bounce->counts[level] == 0)
            level--;
        if (bounce->counts[level] == 0 || glint_tile_cancelled(frame))
            break;
        run_batch(bounce, tile, frame, level);
        if (level + 1 < GLINT_BOUNCE_LEVELS)
            level++;
    }
    glint_batch_end(&bounce->batch, tile);
}
