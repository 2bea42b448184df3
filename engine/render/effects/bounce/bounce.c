/// Rays beyond the first surface of a tile: reflected, refracted and straight ones, and their light.
///
/// Rays wait in levels, each with space for the samples of one tile. A batch is all the rays of the highest level. If
/// a surface sends on several rays, the strongest stays in the batch's level, the second goes one level up and the
/// third two levels: a level never holds more rays than the batch that filled it. That bounds the memory, however
/// long the chains are. The order of a pixel's rays, and so of its sums, only depends on that pixel.
///
/// If all rays of every surface were followed, their number would double at each surface. Beyond GLINT_BOUNCE_SPLITS
/// surfaces only one ray is followed. It is drawn with a probability proportional to the weights, and takes the
/// weight of all: no light is lost, and work no longer doubles. The random number is a hash of the ray's own bits, so
/// that it is always the same.
///
/// max_depth does not count translucent surfaces that a ray goes straight through. They are counted
/// apart, at most GLINT_STRAIGHT_MAX.
///
/// A ray too weak to be seen is not followed. A sample loses at most GLINT_BOUNCE_LOSS of linear light in total, by
/// the plan's bound of the light along any ray. That is 1/318 of the smallest step between two 8-bit sRGB values.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/render/effects/bounce/plan.h"
#include "engine/render/effects/derivative/work.h"
#include "engine/render/light_groups/light_groups.h"

#include <stdlib.h>
#include <string.h>

/// One level, and GLINT_SPLITS - 1 more for each surface that may send on several rays.
#define LEVELS ((GLINT_SPLITS - 1) * GLINT_BOUNCE_SPLITS + 1)

struct glint_bounce {
    glint_batch batch;
    glint_rays buffers[LEVELS];
    glint_rays *levels[LEVELS]; ///< rays of each level; taking some swaps the buffers
    uint32_t counts[LEVELS];
    double budget[GLINT_TILE_SAMPLES]; ///< light that each sample may still lose
    double (*albedo)[GLINT_TILE_SAMPLES]; ///< where the albedo along the rays is added; NULL: their light is
    glint_ray_slope *slopes; ///< slopes of the rays of all levels and of the batch's own rays; NULL until a frame has
        ///< derivatives
};

/// Not zeroed as a whole, so that the system allocates the pages of a level only when it is used.
static void *create(const glint_plan *plan)
{
    (void)plan;
    struct glint_bounce *bounce = aligned_alloc(_Alignof(struct glint_bounce), sizeof *bounce);
    if (!bounce)
        return NULL;
    memset(&bounce->batch, 0, sizeof bounce->batch);
    bounce->slopes = NULL;
    for (int i = 0; i < LEVELS; i++) {
        bounce->buffers[i].slopes = NULL;
        bounce->levels[i] = &bounce->buffers[i];
        bounce->counts[i] = 0;
    }
    return bounce;
}

static void destroy(void *memory)
{
    struct glint_bounce *bounce = memory;
    if (!bounce)
        return;
    glint_tile_free_stage(&bounce->batch.tile, GLINT_STAGE_DERIVATIVE);
    free(bounce->slopes);
    free(bounce);
}

/// Makes space for the slopes of rays.
static bool fit(void *memory, const glint_plan *plan)
{
    struct glint_bounce *bounce = memory;
    const size_t each = (size_t)GLINT_TILE_SAMPLES * GLINT_DERIVATIVES_MAX;
    if (!plan->derivatives)
        return true;
    if (!bounce->slopes)
        bounce->slopes = malloc((LEVELS + 1) * each * sizeof *bounce->slopes); // the system allocates pages when used
    for (size_t i = 0; bounce->slopes && i < LEVELS; i++)
        bounce->buffers[i].slopes = bounce->slopes + i * each;
    if (bounce->slopes)
        bounce->batch.own.slopes = bounce->slopes + LEVELS * each;
    return bounce->slopes && glint_tile_fit_stage(&bounce->batch.tile, plan, GLINT_STAGE_DERIVATIVE);
}

// ---- From a surface on ----

/// Returns the depth of the ray that found sample i; 0 for a ray of the eye.
static uint32_t depth_at(const struct glint_bounce *bounce, const glint_tile *tile, uint32_t i)
{
    return tile == &bounce->batch.tile ? bounce->batch.rays->depth[bounce->batch.ray_of[i]] : 0;
}

/// Returns the number of translucent surfaces that the ray to sample i went straight through.
static uint32_t passes_at(const struct glint_bounce *bounce, const glint_tile *tile, uint32_t i)
{
    return tile == &bounce->batch.tile ? bounce->batch.rays->straight_count[bounce->batch.ray_of[i]] : 0;
}

/// Returns whether the surface of sample i sends on a ray, and the chain has not reached its end.
static bool goes_on(const struct glint_bounce *bounce, const glint_tile *tile, const glint_plan *plan, uint32_t i)
{
    const glint_bounce_material *m = &plan->bouncing[tile->surface.material[i]];
    return (glint_is_sharp(m) && depth_at(bounce, tile, i) < plan->desc.max_depth) ||
           (m->clears && passes_at(bounce, tile, i) < GLINT_STRAIGHT_MAX);
}

/// Selects the hits of `tile` whose materials send rays on, and whose chain has not reached its end.
static bool choose(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    bool any = false;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        bounce->batch.wanted[g] = 0;
        for (unsigned bits = tile->at.hits[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            if (goes_on(bounce, tile, plan, i))
                bounce->batch.wanted[g] |= (uint16_t)(bits & -bits);
        }
        any = any || bounce->batch.wanted[g];
    }
    return any;
}

/// The rays that continue from a sample.
typedef struct parting {
    double weight[GLINT_SPLITS][3];
    glint_ray_slope slopes[GLINT_SPLITS][GLINT_DERIVATIVES_MAX]; ///< in frames with derivatives
} parting;

static double total_weight(const double weight[3]) { return (weight[0] + weight[1]) + weight[2]; }

/// Returns whether a ray must be followed. Otherwise subtracts the ray's largest possible light from the budget.
static bool matters(const glint_plan *plan, const double weight[3], double *budget)
{
    double most = weight[0]; // none is NaN
    for (int c = 1; c < 3; c++)
        most = weight[c] > most ? weight[c] : most;
    if (most == 0) // the ray does not exist
        return false;
    const double lost = most * plan->brightest;
    if (!(4 * lost <= *budget))
        return true;
    *budget -= lost;
    return false;
}

/// Sends one of the rays of sample i to a level.
static void push(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame, uint32_t level, uint32_t i,
                 const parting *rays_of, glint_event event)
{
    const glint_plan *plan = frame->plan;
    glint_rays *rays = bounce->levels[level];
    const uint32_t n = bounce->counts[level]++;
    if (n == 0)
        glint_rays_clear(rays, GLINT_TILE_GROUPS);
    glint_ray_continue(&bounce->batch, tile, frame, i, event, rays, n);
    for (int c = 0; c < 3; c++)
        rays->throughput[c][n] = rays_of->weight[event][c];
    if (plan->derivatives)
        memcpy(rays->slopes + n * plan->derivatives->count, rays_of->slopes[event],
               plan->derivatives->count * sizeof *rays->slopes);
}

/// Returns a number in 0 .. 1 that only depends on the mirrored ray: a hash of its direction's bits (the finish of
/// splitmix64).
static double lot_of(const glint_batch *batch, glint_precision precision, uint32_t i, uint32_t depth)
{
    uint64_t z = depth;
    for (int c = 0; c < 3; c++) {
        const double x = glint_real_at(batch->reflected[c], precision, i);
        uint64_t bits;
        memcpy(&bits, &x, sizeof bits);
        z = (z ^ bits) * 0xbf58476d1ce4e5b9u;
        z = (z ^ z >> 27) * 0x94d049bb133111ebu;
        z ^= z >> 31;
    }
    return (double)(z >> 11) * 0x1p-53;
}

/// Adds the weight of ray `other` to ray `one`.
static void take_weight(const glint_plan *plan, parting *rays, int one, int other)
{
    for (int c = 0; c < 3; c++) {
        rays->weight[one][c] = glint_clamp_throughput(rays->weight[one][c] + rays->weight[other][c]);
        rays->weight[other][c] = 0;
        for (size_t k = 0; plan->derivatives && k < plan->derivatives->count; k++)
            rays->slopes[one][k].weight[c] += rays->slopes[other][k].weight[c];
    }
}

/// Draws one of the rays, with a probability proportional to their weights. It takes the weight of all. lot: 0 .. 1.
static void draw(const glint_plan *plan, parting *rays, double lot)
{
    const double mirrored = total_weight(rays->weight[0]), refracted = total_weight(rays->weight[1]),
                 straight = total_weight(rays->weight[2]), at = lot * (mirrored + refracted + straight);
    const bool mirror = at < mirrored || !(refracted + straight > 0);
    const bool refraction = refracted > 0 && (at < mirrored + refracted || !(straight > 0));
    const int drawn = mirror ? GLINT_EVENT_MIRROR : refraction ? GLINT_EVENT_REFRACT : GLINT_EVENT_STRAIGHT;
    for (int event = 0; event < GLINT_SPLITS; event++)
        if (event != drawn)
            take_weight(plan, rays, drawn, event);
}

/// Sends on the rays of a sample that matter, the strongest to level `base`, the others to the levels above.
static void push_all(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame, uint32_t base, uint32_t i,
                     const parting *rays, double *budget)
{
    const glint_plan *plan = frame->plan;
    const int event_count = plan->clears ? GLINT_SPLITS : GLINT_EVENT_STRAIGHT;
    double total[GLINT_SPLITS];
    for (int event = 0; event < event_count; event++)
        total[event] = matters(plan, rays->weight[event], budget) ? total_weight(rays->weight[event]) : 0;
    for (int event = 0; event < event_count; event++) {
        uint32_t stronger = 0;
        if (!(total[event] > 0))
            continue;
        for (int other = 0; other < event_count; other++)
            stronger += total[other] > total[event] || (other < event && total[other] == total[event]);
        push(bounce, tile, frame, base + stronger, i, rays, (glint_event)event);
    }
}

/// Leaves out the ray that goes straight on, and divides the weights of the others by the opacity. For albedos.
static void scale_by_opacity(const glint_tile *tile, const glint_plan *plan, uint32_t i, double weight[GLINT_SPLITS][3])
{
    double color[3];
    const double opacity = glint_tile_albedo(tile, plan, i, true, color);
    for (int event = 0; event < GLINT_SPLITS; event++)
        for (int c = 0; c < 3; c++)
            weight[event][c] = event != GLINT_EVENT_STRAIGHT && opacity > 0 ? weight[event][c] / opacity : 0;
}

/// Sends on the rays of sample i.
static void send_on(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                    uint32_t base)
{
    const glint_plan *plan = frame->plan;
    const glint_batch *batch = &bounce->batch;
    const bool first = tile != &batch->tile;
    const uint32_t ray = first ? 0 : batch->ray_of[i], depth = depth_at(bounce, tile, i),
                   surfaces = depth + passes_at(bounce, tile, i) + 1;
    parting rays;
    for (int c = 0; c < 3; c++)
        for (int event = 0; event < GLINT_SPLITS; event++)
            rays.weight[event][c] = first ? 1 : batch->rays->throughput[c][ray];
    glint_bsdf_weights(batch, tile, frame, i, rays.weight);
    if (plan->derivatives)
        glint_derive_split(batch, tile, frame, i, rays.slopes);
    // only the straight ray is left, or effects/rough follows the others
    if (!(depth < plan->desc.max_depth) || plan->bouncing[tile->surface.material[i]].rough)
        memset(rays.weight, 0, GLINT_EVENT_STRAIGHT * sizeof *rays.weight);
    if (bounce->albedo)
        scale_by_opacity(tile, plan, i, rays.weight);
    if (!first && glint_has_lane(batch->total, i)) // the mirrored and the totally reflected ray have the same direction
        take_weight(plan, &rays, GLINT_EVENT_MIRROR, GLINT_EVENT_REFRACT);
    if (!first && surfaces > GLINT_BOUNCE_SPLITS)
        draw(plan, &rays, lot_of(batch, plan->desc.precision, i, surfaces));
    push_all(bounce, tile, frame, base, i, &rays, &bounce->budget[first ? i : batch->rays->pixel[ray]]);
}

/// Empties level `base` and those above that rays may be sent to.
static void begin_sending(struct glint_bounce *bounce, uint32_t base)
{
    for (uint32_t level = base; level < base + GLINT_SPLITS && level < LEVELS; level++)
        bounce->counts[level] = 0;
}

static void end_sending(struct glint_bounce *bounce, uint32_t base)
{
    for (uint32_t level = base; level < base + GLINT_SPLITS && level < LEVELS; level++)
        bounce->levels[level]->group_count = (bounce->counts[level] + GLINT_GROUP - 1) / GLINT_GROUP;
}

/// Sends on rays from the hits of the eye's samples, to level 0.
static void spawn_first(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame)
{
    if (!choose(bounce, tile, frame))
        return;
    glint_event_find_directions(&bounce->batch, tile, frame);
    begin_sending(bounce, 0);
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = bounce->batch.wanted[g]; bits; bits &= bits - 1)
            send_on(bounce, tile, frame, g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits), 0);
    end_sending(bounce, 0);
}

/// Sends on rays from the hits of the batch, in the order of its rays; `level` is the level of these rays, which is
/// empty by now, like the levels above.
static void spawn(struct glint_bounce *bounce, const glint_tile_frame *frame, uint32_t level)
{
    const glint_batch *batch = &bounce->batch;
    if (!choose(bounce, &batch->tile, frame))
        return;
    glint_event_find_directions(&bounce->batch, &batch->tile, frame);
    begin_sending(bounce, level);
    for (uint32_t g = 0; g < batch->rays->group_count; g++)
        for (unsigned bits = batch->rays->active[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            if (glint_batch_has_sample(batch, i) && glint_has_lane(batch->wanted, batch->sample[i]))
                send_on(bounce, &batch->tile, frame, batch->sample[i], level);
        }
    end_sending(bounce, level);
}

// ---- A batch ----

/// Takes all rays of a level into the batch.
static void take_level(struct glint_bounce *bounce, uint32_t level, glint_tile_counts *counts)
{
    glint_rays *rays = bounce->levels[level];
    bounce->levels[level] = bounce->batch.rays;
    bounce->batch.rays = rays;
    for (uint32_t i = 0; i < bounce->counts[level]; i++) {
        counts->mirror += rays->term[i] == GLINT_TERM_MIRROR;
        counts->refraction += rays->term[i] == GLINT_TERM_TRANSMISSION;
    }
    bounce->counts[level] = 0;
}

/// Adds the light along the rays to their pixels, in order.
static void collect(const glint_batch *batch, const glint_plan *plan, glint_tile *to)
{
    const glint_rays *rays = batch->rays;
    const bool covers = glint_tile_wants_coverage(plan);
    for (uint32_t g = 0; g < rays->group_count; g++)
        for (unsigned bits = rays->active[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            double(*sum)[GLINT_TILE_SAMPLES] = to->film.sum[rays->term[i]];
            const uint32_t pixel = rays->pixel[i];
            double weight[3];
            if (covers && glint_batch_uncovers(batch, plan, i)) {
                to->film.covered[pixel] -= ((rays->throughput[0][i] + rays->throughput[1][i]) + rays->throughput[2][i]) / 3;
                if (plan->desc.alpha)
                    continue;
            }
            for (int c = 0; c < 3; c++) {
                weight[c] = rays->throughput[c][i];
                sum[c][pixel] += weight[c] * glint_batch_light_of(batch, plan, c, i);
            }
            if (plan->light_groups && glint_batch_has_sample(batch, i))
                glint_groups_collect(batch, plan, to, batch->sample[i], pixel, weight);
        }
}

/// Returns whether sample i is a smooth mirror or smooth glass that sends on rays.
static bool is_followed(const struct glint_bounce *bounce, const glint_tile *tile, const glint_plan *plan, uint32_t i)
{
    return glint_is_sharp(&plan->bouncing[tile->surface.material[i]]) && depth_at(bounce, tile, i) < plan->desc.max_depth;
}

/// Adds the albedo along the rays to their pixels, in order. The surroundings have the albedo 1.
static void collect_albedo(struct glint_bounce *bounce, const glint_tile_frame *frame)
{
    const glint_batch *batch = &bounce->batch;
    const glint_rays *rays = batch->rays;
    for (uint32_t g = 0; g < rays->group_count; g++)
        for (unsigned bits = rays->active[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits), at = batch->sample[i];
            double color[3] = { 1, 1, 1 };
            if (glint_batch_has_sample(batch, i) && glint_has_lane(batch->tile.at.hits, at))
                glint_tile_albedo(&batch->tile, frame->plan, at, is_followed(bounce, &batch->tile, frame->plan, at), color);
            for (int c = 0; c < 3; c++)
                bounce->albedo[c][rays->pixel[i]] += rays->throughput[c][i] * color[c];
        }
}

static void run_albedo_batch(struct glint_bounce *bounce, const glint_tile_frame *frame, uint32_t level)
{
    take_level(bounce, level, &bounce->batch.tile.counts);
    const bool any = glint_batch_cast(&bounce->batch, frame);
    if (any)
        glint_batch_find_patterns(&bounce->batch, frame);
    collect_albedo(bounce, frame);
    if (any)
        spawn(bounce, frame, level);
}

static void run_batch(struct glint_bounce *bounce, glint_tile *to, const glint_tile_frame *frame, uint32_t level)
{
    if (bounce->albedo) {
        run_albedo_batch(bounce, frame, level);
        return;
    }
    take_level(bounce, level, &to->counts);
    const bool any = glint_batch_cast(&bounce->batch, frame);
    if (any || bounce->batch.whole)
        glint_batch_light(&bounce->batch, frame, frame, any);
    collect(&bounce->batch, frame->plan, to);
    glint_tile_step(to, frame, GLINT_AFTER_SECONDARY, &(glint_sample_walk) { .any = any, .batch = &bounce->batch });
    if (any)
        spawn(bounce, frame, level);
}

/// Follows the rays of a tile's samples. albedo: where their albedo is added; NULL: their light is.
static void follow(glint_tile *tile, const glint_tile_frame *frame, double (*albedo)[GLINT_TILE_SAMPLES])
{
    struct glint_bounce *bounce = tile->own[GLINT_STAGE_BOUNCE];
    bounce->albedo = albedo;
    glint_batch_begin(&bounce->batch, tile, frame, GLINT_WALK_BOUNCE);
    // paths start in sample order
    bounce->batch.ordered = frame->plan->runs[GLINT_STAGE_INDIRECT] || frame->plan->runs[GLINT_STAGE_ROUGH];
    memset(bounce->counts, 0, sizeof bounce->counts);
    for (int i = 0; i < GLINT_TILE_SAMPLES; i++)
        bounce->budget[i] = GLINT_BOUNCE_LOSS;
    spawn_first(bounce, tile, frame);
    for (uint32_t level = GLINT_SPLITS - 1;;) { // the highest level that may have rays
        while (level > 0 && bounce->counts[level] == 0)
            level--;
        if (bounce->counts[level] == 0 || glint_tile_cancelled(frame))
            break;
        run_batch(bounce, tile, frame, level);
        level = level + GLINT_SPLITS - 1 < LEVELS ? level + GLINT_SPLITS - 1 : LEVELS - 1;
    }
    glint_batch_end(&bounce->batch, tile);
}

static bool called(const glint_plan *plan)
{
    return plan->geometry->table.prim_count > 0 &&
           (plan->clears || (plan->sharp && plan->desc.max_depth > 0));
}

static bool adds(const glint_tile *tile, const glint_tile_frame *frame, bool any)
{
    return any && glint_tile_shows(tile, frame, glint_sends_on);
}

/// Adds the light along the rays that surfaces send on.
static void add(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (!walk->any || tile->direct || !glint_tile_shows(tile, frame, glint_sends_on))
        return;
    glint_tile_need_points(tile, frame, walk);
    follow(tile, frame, NULL);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_BOUNCE, false);
}

/// Replaces the albedo of smooth mirrors and smooth glass with the albedo of what they show: the blend of the albedos of
/// their reflected and refracted rays (Open Image Denoise 2, "Albedo"). At most 1, unless the surface itself has more.
static void add_albedo(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    struct glint_bounce *bounce = tile->own[GLINT_STAGE_BOUNCE];
    glint_plan plan = *frame->plan;
    glint_tile_frame plain = *frame;
    double own[3], least[3][GLINT_TILE_SAMPLES];
    if (!glint_tile_shows(tile, frame, glint_is_sharp))
        return;
    plain.plan = &plan;
    plan.derivatives = NULL;
    plan.brightest = 1;
    glint_plan_drop(&plan, GLINT_STAGE_DERIVATIVE);
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const bool followed = glint_has_lane(tile->at.hits, i) && is_followed(bounce, tile, &plan, i);
        if (followed)
            glint_tile_albedo(tile, &plan, i, true, own);
        for (int c = 0; c < 3; c++) {
            least[c][i] = followed ? own[c] : walk->albedo[c][i];
            walk->albedo[c][i] = least[c][i];
        }
    }
    follow(tile, &plain, walk->albedo);
    for (int c = 0; c < 3; c++)
        for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++)
            walk->albedo[c][i] = fmax(least[c][i], fmin(walk->albedo[c][i], 1));
}

const glint_stage glint_stage_bounce = {
    .name = "bounce",
    .doc = "mirror and refraction rays, rays through translucent surfaces, and the light of these rays",
    .calls = "derivative",
    .prepare = glint_bounce_prepare,
    .called = called,
    .own = glint_bounce_key,
    .reads = GLINT_READS_OWN(BOUNCE),
    .walks = true,
    .sums = true,
    .normals = true,
    .remote = true,
    .step = { [GLINT_AT_ALBEDO] = add_albedo, [GLINT_AFTER_LIGHTS] = add },
    .adds = adds,
    .create = create,
    .destroy = destroy,
    .fit = fit,
};
