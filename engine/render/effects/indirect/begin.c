/// The beginning of paths of indirect light: points and first directions.
#include "engine/base/sequence.h"
#include "engine/base/vec.h"
#include "engine/render/effects/indirect/paths.h"

#include <math.h>
#include <string.h>

/// Orders the pixels of a block in squares of 2 x 2, so that each square gets an even set of numbers as well.
static uint32_t lane_order(uint32_t lane)
{
    const uint32_t x = lane & 3, y = lane >> 2;
    return (x & 1) | (y & 1) << 1 | (x >> 1) << 2 | (y >> 1) << 3;
}

/// Finds the block of point i of `seen`; `block`: the previous one.
static void find_block(struct glint_indirect *indirect, const glint_tile *to, const glint_plan *plan, uint32_t i,
                       glint_pixel_block *block)
{
    const glint_rays *first = &indirect->first;
    const uint32_t group = first->pixel[i] / GLINT_GROUP;
    const uint32_t x = to->x0 / 4 + group % to->groups_across, y = to->y0 / 4 + group / to->groups_across;
    const uint64_t at = x | (uint64_t)y << 32,
                   depth_code = indirect->salt + (first->term[i] == GLINT_TERM_INDIRECT
                                    ? 0
                                    : 1 + 2 * (uint64_t)first->depth[i] + (first->term[i] == GLINT_TERM_MIRROR));
    if (!block->known || block->at != at || block->depth_code != depth_code) {
        const uint64_t number = glint_sequence_mix(glint_sequence_mix(at, (uint64_t)plan->desc.seed), depth_code);
        *block = (glint_pixel_block) { .known = true, .at = at, .depth_code = depth_code, .number = number };
    }
    indirect->block[i] = block->number;
    indirect->lane[i] = lane_order(first->pixel[i] % GLINT_GROUP);
}

/// Returns the factor of the light of paths at sample i of a tile: the diffuse reflectance; with ambient occlusion
/// the ambient light of the whole sky.
static const double *first_weight(const glint_tile *seen, const glint_plan *plan, uint32_t i, double buffer[3])
{
    if (!plan->indirect.is_sky)
        return glint_tile_diffuse(seen, plan, i, buffer);
    for (int c = 0; c < 3; c++)
        buffer[c] = glint_tile_ambient_rest(seen, plan, i, c);
    return buffer;
}

uint32_t glint_indirect_paths_of(const glint_plan *plan, const glint_batch *from, uint32_t i)
{
    const double samples = plan->indirect.samples;
    double weight = 0;
    for (int c = 0; from && c < 3; c++)
        weight = glint_larger(weight, from->rays->throughput[c][from->ray_of[i]]);
    return from ? (uint32_t)fmin(fmax(ceil(samples * weight), 1), samples) : (uint32_t)plan->indirect.samples;
}

void glint_indirect_begin_point(struct glint_indirect *indirect, const glint_tile *to, const glint_plan *plan, uint32_t i,
                                uint32_t paths, const double *factor, glint_pixel_block *block)
{
    glint_rays *first = &indirect->first;
    const double part = 1.0 / paths, arriving[3] = { first->throughput[0][i], first->throughput[1][i], first->throughput[2][i] };
    first->point[i] = i;
    first->min_throughput[i] = glint_largest(arriving) * part * plan->indirect.least;
    for (int c = 0; c < 3; c++) {
        glint_real_put(first->direction[c], plan->desc.precision, i, 0);
        first->throughput[c][i] = indirect->weight[c][i] = glint_clamp_throughput(arriving[c] * (factor[c] * part));
    }
    indirect->paths[i] = paths;
    find_block(indirect, to, plan, i, block);
    indirect->fewest = paths < indirect->fewest ? paths : indirect->fewest;
}

/// Starts the scattered paths of point i. Returns their number.
static uint32_t scatter_point(struct glint_indirect *indirect, const glint_tile *to, const glint_tile_frame *frame,
                              const glint_tile *seen, const glint_batch *from, uint32_t i, const double *factor,
                              glint_pixel_block *block)
{
    const uint32_t paths = glint_indirect_paths_of(frame->plan, from, i);
    glint_rays *first = &indirect->first;
    glint_ray_begin(from ? from : &indirect->batch, seen, frame, i, first, i);
    if (!from)
        first->term[i] = GLINT_TERM_INDIRECT;
    glint_rays_mark(first->inward, i, glint_has_lane(seen->hit.back, i));
    first->scatters[i]++;
    glint_indirect_begin_point(indirect, to, frame->plan, i, paths, factor, block);
    return paths;
}

uint32_t glint_indirect_find_points(struct glint_indirect *indirect, const glint_tile *to,
                                    const glint_tile_frame *frame, const glint_tile *seen, const glint_batch *from)
{
    uint32_t most = 0;
    double buffer[3];
    glint_pixel_block block = { .known = false };
    indirect->fewest = UINT32_MAX;
    glint_rays_clear(&indirect->first, seen->group_count);
    for (uint32_t g = 0; g < seen->group_count; g++) {
        for (unsigned bits = seen->at.hits[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            const double *factor = first_weight(seen, frame->plan, i, buffer);
            if (glint_largest(factor) == 0)
                continue;
            const uint32_t paths = scatter_point(indirect, to, frame, seen, from, i, factor, &block);
            most = paths > most ? paths : most;
        }
        indirect->matt[g] = indirect->first.active[g];
    }
    return most;
}

void glint_indirect_scatter(const glint_tile_frame *frame, uint32_t group_count, const void *const normal[3],
                            const uint16_t *wanted, const draws *drawn, uint32_t further,
                            double (*direction)[GLINT_TILE_SAMPLES])
{
    glint_scatter_args args = { .group_count = group_count,
                                .wanted = wanted,
                                .number = drawn->number,
                                .order = drawn->order,
                                .digits = { drawn->digits[0], drawn->digits[1] },
                                .further = further };
    for (int c = 0; c < 3; c++) {
        args.normal[c] = normal[c];
        args.direction[c] = direction[c];
    }
    frame->stages->geometry[frame->plan->desc.precision].scatter(&args);
}

/// Restores the weights of the first rays, except those that a bumped normal sends into the surface; under a sky,
/// multiplies them by the weights of their directions.
static void weigh_first(struct glint_indirect *indirect, const glint_tile_frame *frame, const glint_tile *seen)
{
    glint_rays *first = &indirect->first;
    if (frame->plan->absorbs || glint_plan_bumps(frame->plan) || frame->plan->sky)
        memcpy(first->throughput, indirect->weight, sizeof first->throughput);
    if (frame->plan->sky)
        glint_indirect_weigh_sky(first, first->active, indirect->share);
    if (!glint_plan_bumps(frame->plan))
        return;
    for (uint32_t i = 0; i < first->group_count * GLINT_GROUP; i++)
        if (glint_has_lane(first->active, i) &&
            !glint_indirect_leaves(seen, frame->plan, i, (const double(*)[GLINT_TILE_SAMPLES])first->direction))
            for (int c = 0; c < 3; c++)
                first->throughput[c][i] = 0;
}

/// Selects the points that have a path number `path`. Returns whether there are any.
static bool select_points(struct glint_indirect *indirect, uint32_t path)
{
    glint_rays *first = &indirect->first;
    unsigned any = 0;
    memcpy(first->active, indirect->matt, first->group_count * sizeof *first->active);
    for (uint32_t g = 0; g < first->group_count; g++) {
        for (unsigned bits = path < indirect->fewest ? 0 : first->active[g]; bits; bits &= bits - 1)
            if (path >= indirect->paths[g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits)])
                first->active[g] &= (uint16_t) ~(bits & -bits);
        any |= first->active[g];
    }
    return any;
}

/// Draws for the points that have a path number `path`. A seed lasts for 2^32 points of a sequence. When it changes,
/// only the points before the change are drawn.
static void draw_first(struct glint_indirect *indirect, const glint_plan *plan, uint32_t path, uint64_t number)
{
    const bool lasting = (uint64_t)plan->indirect.samples * (uint64_t)plan->desc.samples <= UINT32_MAX / GLINT_GROUP;
    if (path > 0 && lasting)
        return;
    glint_sequence_seed seed;
    uint64_t last = 0; // the block of the last seed
    bool known = false;
    for (uint32_t g = 0; g < indirect->first.group_count; g++)
        for (unsigned bits = indirect->first.active[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            const uint64_t k = glint_indirect_point_of(indirect, i, number);
            if (path != 0 && (uint32_t)k != 0)
                continue;
            if (!known || k >> 32 != 0 || indirect->block[i] != last)
                seed = glint_sequence_seed_of(glint_indirect_seed_of(indirect, i, k, 0));
            known = k >> 32 == 0;
            last = indirect->block[i];
            glint_indirect_note(&indirect->first_draws, i, k, &seed, path);
        }
}

bool glint_indirect_choose_points(struct glint_indirect *indirect, const glint_plan *plan, uint32_t path, uint64_t number)
{
    if (!select_points(indirect, path))
        return false;
    draw_first(indirect, plan, path, number);
    return true;
}

bool glint_indirect_begin_paths(struct glint_indirect *indirect, const glint_tile_frame *frame, const glint_tile *seen,
                                uint32_t path, uint64_t number)
{
    glint_rays *first = &indirect->first;
    const void *const normal[] = { seen->surface.normal[0], seen->surface.normal[1], seen->surface.normal[2] };
    if (!glint_indirect_choose_points(indirect, frame->plan, path, number))
        return false;
    if (frame->plan->sky)
        glint_indirect_draw_sky(seen, frame->plan, first->active, &indirect->first_draws, path, first->direction, indirect->share);
    else
        glint_indirect_scatter(frame, seen->group_count, normal, first->active, &indirect->first_draws, path, first->direction);
    weigh_first(indirect, frame, seen);
    return true;
}
