/// Indirect light: from each matt point some paths of light are followed backwards, over directions as dense as their
/// cosine, and the mean of what they find, times kd, is what the point gives on.
///
/// Paths do not branch. Where one meets a surface it takes the light that the lights send there, and goes on in one of the
/// directions the surface sends light on to: scattered, mirrored or refracted, chosen with probability as the shares, and
/// weighed by one over it. So the memory is one batch, however long paths are. They stay in the lane of their point: what
/// a path finds depends on its pixel, on the numbers of its sample and of its turns, and on the seed.
///
/// Of an area light each path takes one sample at each point, another from path to path. Light that is computed at each point
/// and found by chance as well would count twice: paths do not see lights, whether rays of the eye do or not.
///
/// A path too weak to be seen ends: what a sample loses so is, in the mean, a quarter of GLINT_BOUNCE_LOSS at most.
#include "engine/base/alloc.h"
#include "engine/base/sequence.h"
#include "engine/base/vec.h"
#include "engine/tile/batch.h"

#include <stdlib.h>
#include <string.h>

#define GOLDEN 0x1.9e3779b97f4a8p-1 ///< multiples of it, less their whole part, fill 0 .. 1 evenly from the first on
#define STRENGTH_MAX 1e150

typedef enum turn { TURN_NONE, TURN_SCATTERED, TURN_MIRRORED, TURN_REFRACTED } turn;

/// Points of the unit square, for the scattered rays: see glint_scatter_args.
typedef struct draws {
    _Alignas(64) uint32_t number[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t order[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t digits[2][GLINT_TILE_SAMPLES];
} draws;

struct glint_indirect {
    glint_batch batch;
    glint_plan plan; ///< the frame's, with one sample of each light, which is not seen
    glint_tile_frame frame; ///< likewise
    glint_plan_light *lights; ///< of that plan; NULL: there are none
    uint32_t paths[GLINT_TILE_SAMPLES]; ///< that each point gets
    uint16_t matt[GLINT_TILE_GROUPS]; ///< the points that get any
    uint64_t
        block[GLINT_TILE_SAMPLES]; ///< a number for the 4 x 4 pixels of each point, and for its place among mirrors
    uint32_t lane[GLINT_TILE_SAMPLES]; ///< which of these pixels
    uint16_t scattered[GLINT_TILE_GROUPS]; ///< rays that go on so
    draws first, next; ///< of the points, and of what their paths met
    _Alignas(64) double direction[3][GLINT_TILE_SAMPLES];
};

struct glint_indirect *glint_indirect_create(const glint_plan *plan)
{
    struct glint_indirect *indirect = glint_alloc(1, sizeof *indirect);
    if (!indirect)
        return NULL;
    indirect->lights = glint_alloc(plan->indirect.light_count, sizeof *indirect->lights);
    if (!indirect->lights) {
        free(indirect);
        return NULL;
    }
    return indirect;
}

void glint_indirect_destroy(struct glint_indirect *indirect)
{
    if (!indirect)
        return;
    free(indirect->lights);
    free(indirect);
}

static double mean(const double c[3]) { return ((c[0] + c[1]) + c[2]) / 3; }

static double largest(const double c[3]) { return fmax(c[0], fmax(c[1], c[2])); }

// ---- Numbers that are as good as random ----

/// Pixels of 2 x 2 belong together first, so that these have an even set as well.
static uint32_t lane_order(uint32_t lane)
{
    const uint32_t x = lane & 3, y = lane >> 2;
    return (x & 1) | (y & 1) << 1 | (x >> 1) << 2 | (y >> 1) << 3;
}

/// Notes which block of pixels point i of `seen` belongs to.
static void find_block(struct glint_indirect *indirect, const glint_tile *to, const glint_plan *plan,
                       const glint_batch_ray *ray, uint32_t i)
{
    const uint32_t pixel = ray ? ray->pixel : i, group = pixel / GLINT_GROUP;
    const uint32_t x = to->x0 / 4 + group % to->groups_across, y = to->y0 / 4 + group / to->groups_across;
    const uint64_t place = ray ? 1 + 2 * (uint64_t)ray->depth + (ray->term == GLINT_TERM_MIRROR) : 0;
    uint64_t block = glint_sequence_mix(x | (uint64_t)y << 32, (uint64_t)plan->desc.seed);
    indirect->block[i] = glint_sequence_mix(block, place);
    indirect->lane[i] = lane_order(pixel % GLINT_GROUP);
}

/// Which point of its sequence path `number` of a pixel's point i takes.
static uint64_t number_in_block(const struct glint_indirect *indirect, uint32_t i, uint64_t number)
{
    const uint64_t each = (uint64_t)indirect->plan.indirect.samples * (uint64_t)indirect->plan.desc.samples;
    return indirect->lane[i] * each + number;
}

/// The seed of that sequence, two for each turn: `which` says what for. k: the point.
static uint64_t seed_of(const struct glint_indirect *indirect, uint32_t i, uint64_t k, uint32_t which)
{
    return glint_sequence_mix(indirect->block[i], which | (k >> 32) << 32);
}

/// The point itself.
static void draw(const struct glint_indirect *indirect, uint32_t i, uint64_t number, uint32_t which, double out[2])
{
    const uint64_t k = number_in_block(indirect, i, number);
    glint_sequence_scrambled((uint32_t)k, seed_of(indirect, i, k, which), out);
}

/// Notes it for the stage scatter, which takes the point `further` than what is noted.
static void note_draw(const struct glint_indirect *indirect, uint32_t i, uint64_t k, uint32_t which, uint32_t further,
                      draws *to)
{
    const glint_sequence_seed seed = glint_sequence_seed_of(seed_of(indirect, i, k, which));
    to->number[i] = (uint32_t)k - further;
    to->order[i] = seed.order;
    to->digits[0][i] = seed.digits[0];
    to->digits[1][i] = seed.digits[1];
}

/// One sample of each light, as strong as all of them: another for each path and turn.
static void take_lights(struct glint_indirect *indirect, const glint_plan *plan, uint64_t number, uint32_t step)
{
    for (uint32_t i = 0; i < plan->indirect.light_count; i++) {
        const uint32_t first = plan->indirect.light_rows[i], count = plan->indirect.light_rows[i + 1] - first;
        double part = (double)(number % (1u << 20)) * GOLDEN + step * (GOLDEN * GOLDEN);
        part -= floor(part);
        glint_plan_light *light = &indirect->lights[i];
        *light = plan->lights[first + (uint32_t)(part * count)];
        light->joined = false;
        for (int c = 0; c < 3; c++) {
            light->diffuse[c] = fmin(light->diffuse[c] * count, STRENGTH_MAX);
            light->specular[c] = fmin(light->specular[c] * count, STRENGTH_MAX);
        }
    }
}

// ---- Where paths begin ----

/// How many paths each point gets: fewer where it is seen by mirrors that leave little of it. Returns the most.
static uint32_t find_points(struct glint_indirect *indirect, const glint_tile *to, const glint_tile_frame *frame,
                            const glint_tile *seen, const glint_batch *from)
{
    const glint_plan *plan = frame->plan;
    uint32_t most = 0;
    double room[3];
    for (uint32_t g = 0; g < seen->group_count; g++) {
        indirect->matt[g] = 0;
        for (unsigned left = seen->at.hits[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            const glint_batch_ray *ray = from ? &from->ray[i] : NULL;
            const double weight = ray ? largest(ray->weight) : 1;
            const double samples = plan->indirect.samples;
            if (largest(glint_tile_diffuse(seen, plan, i, room)) == 0)
                continue;
            indirect->paths[i] = (uint32_t)fmin(fmax(ceil(samples * weight), 1), samples);
            indirect->matt[g] |= (uint16_t)(left & -left);
            most = indirect->paths[i] > most ? indirect->paths[i] : most;
            find_block(indirect, to, plan, ray, i);
        }
    }
    return most;
}

/// Directions for the rays in indirect->scattered, around the normals of `tile`, by points that are `further` than those drawn.
static void scatter(struct glint_indirect *indirect, const glint_tile *tile, const glint_tile_frame *frame,
                    const draws *drawn, uint32_t further)
{
    glint_scatter_args args = { .group_count = tile->group_count,
                                .wanted = indirect->scattered,
                                .number = drawn->number,
                                .order = drawn->order,
                                .digits = { drawn->digits[0], drawn->digits[1] },
                                .further = further };
    for (int c = 0; c < 3; c++) {
        args.normal[c] = tile->surface.normal[c];
        args.direction[c] = indirect->direction[c];
    }
    frame->stages->geometry[frame->plan->desc.precision].scatter(&args);
}

/// Sends ray i along its direction from a point of `tile`.
static void leave(const struct glint_indirect *indirect, const glint_tile *tile, double factor, uint32_t i,
                  glint_batch_ray *ray)
{
    const glint_plan *plan = &indirect->plan;
    double room[3];
    const double *share = glint_tile_diffuse(tile, plan, i, room);
    ray->inward = glint_has_lane(tile->hit.back, i);
    ray->scatters++;
    for (int c = 0; c < 3; c++)
        ray->direction[c] = glint_real_at(indirect->direction[c], plan->desc.precision, i);
    const double left = glint_tile_leaves(tile, plan, i, ray->direction) ? factor : 0;
    for (int c = 0; c < 3; c++)
        ray->weight[c] = fmin(ray->weight[c] * (share[c] * left), GLINT_WEIGHT_MAX);
}

/// The first rays of path `path` of every point. Returns whether there are any.
static bool begin_paths(struct glint_indirect *indirect, const glint_tile_frame *frame, const glint_tile *seen,
                        const glint_batch *from, uint32_t path, uint64_t number)
{
    glint_batch *batch = &indirect->batch;
    unsigned any = 0;
    batch->tile.group_count = seen->group_count;
    for (uint32_t g = 0; g < seen->group_count; g++) {
        indirect->scattered[g] = 0;
        for (unsigned left = indirect->matt[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            if (path >= indirect->paths[i])
                continue;
            const uint64_t k = number_in_block(indirect, i, number);
            if (path == 0 || (uint32_t)k == 0) // a seed lasts for 2^32 points
                note_draw(indirect, i, k, 0, path, &indirect->first);
            indirect->scattered[g] |= (uint16_t)(left & -left);
        }
        any |= batch->tile.active[g] = indirect->scattered[g];
    }
    if (!any)
        return false;
    scatter(indirect, seen, frame, &indirect->first, path);
    for (uint32_t g = 0; g < seen->group_count; g++)
        for (unsigned left = batch->tile.active[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            const double share = 1.0 / indirect->paths[i];
            glint_batch_ray *ray = &batch->ray[i];
            *ray = glint_batch_start_ray(from ? from : batch, seen, frame, i);
            if (!from)
                ray->term = GLINT_TERM_INDIRECT;
            ray->least = largest(ray->weight) * share * frame->plan->indirect.least;
            leave(indirect, seen, share, i, ray);
        }
    return true;
}

// ---- Where they go on ----

/// Rays that mirrors and transparent materials may send on; finds where to.
static void find_ways(struct glint_indirect *indirect, const glint_tile_frame *frame)
{
    glint_batch *batch = &indirect->batch;
    const glint_plan *plan = frame->plan;
    unsigned any = 0;
    for (uint32_t g = 0; g < batch->tile.group_count; g++) {
        batch->wanted[g] = 0;
        for (unsigned left = plan->bouncing ? batch->tile.at.hits[g] : 0; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            const glint_bounce_material *m = &plan->bouncing[batch->tile.surface.material[i]];
            if ((m->mirrors || m->transmits) && batch->ray[i].depth < plan->desc.max_depth)
                batch->wanted[g] |= (uint16_t)(left & -left);
        }
        any |= batch->wanted[g];
    }
    if (any)
        glint_batch_find_ways(batch, &batch->tile, frame);
}

/// Chooses how ray i goes on, and starts it there unless it is scattered.
static turn choose(struct glint_indirect *indirect, const glint_tile_frame *frame, uint64_t number, uint32_t i,
                   glint_batch_ray *next)
{
    glint_batch *batch = &indirect->batch;
    const glint_batch_ray *ray = &batch->ray[i];
    double share[3] = { 0 }, least = 0, room[3];
    const double *diffuse = glint_tile_diffuse(&batch->tile, frame->plan, i, room);
    glint_batch_ray split[2];
    if (ray->scatters < frame->plan->indirect.bounces)
        for (int c = 0; c < 3; c++)
            share[0] += diffuse[c] * ray->weight[c];
    if (glint_has_lane(batch->wanted, i)) {
        glint_batch_split(batch, &batch->tile, frame, i, &split[0], &split[1]);
        share[1] = 3 * mean(split[0].weight);
        share[2] = 3 * mean(split[1].weight);
    }
    const double all = (share[0] + share[1]) + share[2];
    if (!(all > 0))
        return TURN_NONE;
    int chosen = share[0] > 0 ? 0 : share[1] > 0 ? 1 : 2;
    if (share[chosen] < all) {
        double number_of[2];
        draw(indirect, i, number, 2 * (ray->scatters + ray->depth) + 1, number_of);
        chosen = number_of[0] * all < share[0]                                 ? 0
                 : number_of[0] * all < share[0] + share[1] || !(share[2] > 0) ? 1
                                                                               : 2;
    }
    const double chance = share[chosen] / all;
    *next = chosen ? split[chosen - 1] : glint_batch_start_ray(batch, &batch->tile, frame, i);
    for (int c = 0; c < 3; c++) {
        next->weight[c] = fmin(next->weight[c] / chance, GLINT_WEIGHT_MAX);
        least = fmax(least, next->weight[c] * (chosen ? 1 : diffuse[c]));
    }
    if (least <= ray->least)
        return TURN_NONE;
    return (turn)(TURN_SCATTERED + chosen);
}

/// Sends every ray on that has found a surface to go on from. Returns whether any does.
static bool go_on(struct glint_indirect *indirect, const glint_tile_frame *frame, uint64_t number)
{
    glint_batch *batch = &indirect->batch;
    glint_tile *tile = &batch->tile;
    unsigned any = 0;
    find_ways(indirect, frame);
    for (uint32_t g = 0; g < tile->group_count; g++) {
        indirect->scattered[g] = 0;
        tile->active[g] = 0;
        for (unsigned left = tile->at.hits[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            const uint16_t bit = (uint16_t)(left & -left);
            glint_batch_ray next;
            const turn chosen = choose(indirect, frame, number, i, &next);
            if (chosen == TURN_NONE)
                continue;
            batch->ray[i] = next;
            tile->active[g] |= bit;
            if (chosen != TURN_SCATTERED)
                continue;
            note_draw(indirect, i, number_in_block(indirect, i, number), 2 * (next.scatters + next.depth), 0,
                      &indirect->next);
            indirect->scattered[g] |= bit;
        }
        any |= tile->active[g];
    }
    if (!any)
        return false;
    scatter(indirect, tile, frame, &indirect->next, 0);
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned left = indirect->scattered[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            leave(indirect, tile, 1, i, &batch->ray[i]);
        }
    return true;
}

// ---- What they find ----

/// Adds the light that the rays have found to their pixels.
static void collect(const glint_batch *batch, const glint_plan *plan, glint_tile *to)
{
    for (uint32_t i = 0; i < batch->tile.group_count * GLINT_GROUP; i++) {
        const glint_batch_ray *ray = &batch->ray[i];
        const bool last = glint_has_lane(batch->tile.at.hits, i) && ray->scatters == plan->indirect.bounces;
        for (int c = 0; c < 3 && glint_has_lane(batch->tile.active, i); c++) {
            const double rest = last ? glint_tile_ambient_rest(&batch->tile, plan, i, c) : 0;
            to->film.sum[ray->term][c][ray->pixel] += ray->weight[c] * (glint_batch_found(batch, c, i) + rest);
        }
    }
}

static void count_rays(const glint_batch *batch, glint_tile *to)
{
    for (uint32_t g = 0; g < batch->tile.group_count; g++)
        to->counts.indirect += (unsigned)__builtin_popcount(batch->tile.active[g]);
}

/// The light of faces and vertices is kept for all readers: it is made of every sample of the lights.
static void light(struct glint_indirect *indirect, const glint_tile_frame *frame, bool any)
{
    glint_batch *batch = &indirect->batch;
    const bool shading_points = any && frame->plan->runs[GLINT_STAGE_VERTEX];
    const bool lit = shading_points ? glint_tile_choose_sampled(&batch->tile, frame) : any;
    glint_batch_shine(batch, &indirect->frame, lit);
    if (shading_points && glint_tile_has_shading_points(&batch->tile))
        glint_tile_vertex(&batch->tile, frame);
}

/// One path of each point, to its end.
static void follow(struct glint_indirect *indirect, const glint_tile_frame *frame, glint_tile *to, uint64_t number)
{
    glint_batch *batch = &indirect->batch;
    bool any = true;
    for (uint32_t step = 0; any && !glint_tile_cancelled(frame); step++) {
        count_rays(batch, to);
        glint_batch_load(batch, frame->plan->desc.precision);
        take_lights(indirect, frame->plan, number, step);
        any = glint_batch_cast(batch, &indirect->frame);
        light(indirect, frame, any);
        collect(batch, frame->plan, to);
        any = any && go_on(indirect, frame, number);
    }
}

void glint_tile_indirect(glint_tile *tile, const glint_tile_frame *frame, const glint_tile *seen,
                         const glint_batch *from)
{
    struct glint_indirect *indirect = tile->indirect;
    glint_batch *batch = &indirect->batch;
    indirect->plan = *frame->plan;
    indirect->plan.lights = indirect->lights;
    indirect->plan.light_count = frame->plan->indirect.light_count;
    indirect->plan.runs[GLINT_STAGE_VISIBLE_LIGHT] = false;
    indirect->plan.visible_light_count = 0;
    indirect->frame = *frame;
    indirect->frame.plan = &indirect->plan;
    const uint32_t paths = find_points(indirect, tile, frame, seen, from);
    glint_batch_begin(batch, tile, frame, GLINT_WALK_INDIRECT);
    for (uint32_t path = 0; path < paths && !glint_tile_cancelled(frame); path++) {
        const uint64_t number = (uint64_t)tile->sample * frame->plan->indirect.samples + path;
        batch->tile.sample = (uint32_t)number;
        if (begin_paths(indirect, frame, seen, from, path, number))
            follow(indirect, frame, tile, number);
    }
    glint_batch_end(batch, tile);
}
