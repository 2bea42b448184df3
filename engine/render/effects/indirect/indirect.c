/// Indirect light: from each matt point, paths of light are followed backwards, in directions with the density of
/// their cosine. The mean light of these paths, times kd, is the indirect light of the point.
///
/// Paths do not branch. Where a path hits a surface, it takes the light that the lamps send there, and continues in
/// one direction: scattered, mirrored, refracted or straight on. The direction is chosen with a probability
/// proportional to its share of the light, and the light is divided by this probability. So the memory is one batch
/// and three sets of rays, however long paths are. The light of a path depends on its pixel, on the numbers of its
/// sample and of its steps, and on the seed. Paths stay in the lane of their point, because the lane selects the
/// point of an area light.
///
/// At each point, a path takes one sample of an area light, a different one for each path. Light that is computed at
/// each point must not be hit by chance as well, or it would count twice: paths do not see lamps, even if the eye
/// does.
///
/// A path too weak to be seen ends. On average, a sample loses at most a quarter of GLINT_BOUNCE_LOSS this way.
#include "engine/base/alloc.h"
#include "engine/base/sequence.h"
#include "engine/base/vec.h"
#include "engine/render/effects/indirect/paths.h"
#include "engine/render/light_groups/light_groups.h"
#include "engine/render/effects/rough/rough.h"

#include <stdlib.h>
#include <string.h>

#define GOLDEN 0x1.9e3779b97f4a8p-1 ///< golden ratio: fractional parts of its multiples fill 0 .. 1 evenly

#define PI 0x1.921fb54442d18p+1
#define LEAST_SHARE 0.05 ///< assumed of a surface that reflects less head-on, because it reflects more at grazing angles

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

static void *create(const glint_plan *plan) { return glint_indirect_create(plan); }

void glint_indirect_destroy(void *memory)
{
    struct glint_indirect *indirect = memory;
    if (!indirect)
        return;
    free(indirect->lights);
    free(indirect);
}

static double mean(const double c[3]) { return ((c[0] + c[1]) + c[2]) / 3; }

// ---- Random numbers ----

void glint_indirect_draw(const struct glint_indirect *indirect, uint32_t i, uint64_t number, uint32_t which, double out[2])
{
    const uint64_t k = glint_indirect_point_of(indirect, i, number);
    glint_sequence_scrambled((uint32_t)k, glint_indirect_seed_of(indirect, i, k, which), out);
}

/// Selects one sample of each light, with the strength of all its samples: a different one for each path and step.
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
            light->diffuse[c] = fmin(light->diffuse[c] * count, GLINT_STRENGTH_MAX);
            light->specular[c] = fmin(light->specular[c] * count, GLINT_STRENGTH_MAX);
        }
    }
}

// ---- Continuing ----

/// Returns whether a path at sample i has not reached the limit of reflections and refractions.
static bool may_reflect(const glint_batch *batch, const glint_plan *plan, uint32_t i)
{
    return batch->rays->depth[batch->ray_of[i]] < plan->desc.max_depth;
}

/// Returns whether the surface of sample i may also mirror, refract or let through a path, and the path has not
/// reached its end.
static bool goes_on(const glint_batch *batch, const glint_plan *plan, uint32_t i)
{
    const uint32_t material = batch->tile.surface.material[i];
    const glint_bounce_material *m = &plan->bouncing[material];
    return ((m->mirrors || m->transmits) && may_reflect(batch, plan, i) && !glint_is_plain(plan, material)) ||
           (m->clears && batch->rays->straight_count[batch->ray_of[i]] < GLINT_STRAIGHT_MAX);
}

void glint_indirect_find_directions(struct glint_indirect *indirect, const glint_tile_frame *frame)
{
    glint_batch *batch = &indirect->batch;
    const glint_plan *plan = frame->plan;
    unsigned any = 0;
    for (uint32_t g = 0; g < batch->tile.group_count; g++) {
        batch->wanted[g] = 0;
        for (unsigned bits = plan->bouncing ? batch->tile.at.hits[g] : 0; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            if (goes_on(batch, plan, i))
                batch->wanted[g] |= (uint16_t)(bits & -bits);
        }
        any |= batch->wanted[g];
    }
    if (any)
        glint_event_find_directions(batch, &batch->tile, frame);
}

/// Returns which seed draws the direction of a path that ray `ray` continues without a change of its counters.
static uint32_t next_seed(const glint_rays *rays, uint32_t ray)
{
    return 2 * (rays->scatters[ray] + rays->depth[ray] + rays->straight_count[ray]);
}

/// Draws the event that continues a path, with a probability proportional to its share of the light.
static glint_event sample_event(const struct glint_indirect *indirect, uint64_t number, const glint_rays *rays, uint32_t ray,
                                const double share[GLINT_EVENTS], double all)
{
    static const glint_event order[] = { GLINT_EVENT_SCATTER, GLINT_EVENT_MIRROR, GLINT_EVENT_REFRACT, GLINT_EVENT_STRAIGHT };
    int likely = 0, last = GLINT_EVENTS - 1;
    double number_of[2], sum = 0;
    while (likely < last && !(share[order[likely]] > 0))
        likely++;
    if (!(share[order[likely]] < all))
        return order[likely];
    glint_indirect_draw(indirect, rays->point[ray], number, next_seed(rays, ray) + 1, number_of);
    while (last > 0 && !(share[order[last]] > 0))
        last--;
    for (int k = 0; k < last; k++) {
        sum += share[order[k]];
        if (number_of[0] * all < sum)
            return order[k];
    }
    return order[last];
}

static bool is_rough(const glint_batch *batch, const glint_plan *plan, uint32_t i)
{
    return plan->bouncing && plan->bouncing[batch->tile.surface.material[i]].rough;
}

/// Fills the shares of the mirrored and of the refracted ray of a rough surface, at the facet that path `number` draws.
static void spread_shares(const struct glint_indirect *indirect, const glint_tile_frame *frame, uint64_t number, uint32_t i,
                          double share[2])
{
    const glint_batch *batch = &indirect->batch;
    const uint32_t ray = batch->ray_of[i];
    double square[2], disk[2];
    const double weight[3] = { batch->rays->throughput[0][ray], batch->rays->throughput[1][ray], batch->rays->throughput[2][ray] };
    glint_bounce_material buffer;
    if (glint_is_plain(frame->plan, batch->tile.surface.material[i])) {
        const glint_bounce_material *m = glint_tile_bouncing(&batch->tile, frame->plan, i, &buffer);
        for (int c = 0; c < 3 && m->mirrors; c++)
            share[GLINT_EVENT_MIRROR] += weight[c] * (m->mirror[c] * m->specular[c] * (m->schlick ? glint_larger(m->f0[c], LEAST_SHARE) : 1));
        return;
    }
    glint_indirect_draw(indirect, batch->rays->point[ray], number, next_seed(batch->rays, ray), square);
    disk[0] = sqrt(square[0]) * glint_cos(2 * PI * square[1]);
    disk[1] = sqrt(square[0]) * glint_sin(2 * PI * square[1]);
    glint_rough_shares(batch, &batch->tile, frame, i, disk, share);
    share[GLINT_EVENT_MIRROR] *= mean(weight);
    share[GLINT_EVENT_REFRACT] *= mean(weight);
}

/// Returns whether an event at a surface spreads rays by its facets.
static bool spreads(bool rough, glint_event event)
{
    return rough && (event == GLINT_EVENT_MIRROR || event == GLINT_EVENT_REFRACT);
}

/// Chooses how the path of sample i continues, and starts its ray; the direction of a ray that is scattered or spread
/// follows. rough: whether the surface is.
static glint_event choose(struct glint_indirect *indirect, const glint_tile_frame *frame, uint64_t number, uint32_t i,
                          bool rough, glint_rays *next)
{
    glint_batch *batch = &indirect->batch;
    const glint_rays *rays = batch->rays;
    const uint32_t ray = batch->ray_of[i];
    double share[GLINT_EVENTS] = { 0 }, throughput[GLINT_EVENTS][3], least = 0, buffer[3];
    const double *diffuse = glint_tile_diffuse(&batch->tile, frame->plan, i, buffer);
    for (int event = 0; event < GLINT_EVENTS; event++)
        for (int c = 0; c < 3; c++)
            throughput[event][c] = rays->throughput[c][ray];
    if (rays->scatters[ray] < frame->plan->indirect.bounces)
        for (int c = 0; c < 3; c++)
            share[GLINT_EVENT_SCATTER] += diffuse[c] * rays->throughput[c][ray];
    if (glint_has_lane(batch->wanted, i)) {
        const bool ends = !may_reflect(batch, frame->plan, i); // only scattered or straight rays are left
        glint_bsdf_weights(batch, &batch->tile, frame, i, throughput);
        for (int event = 0; event < GLINT_SPLITS; event++)
            share[event] = ends && event != GLINT_EVENT_STRAIGHT ? 0 : 3 * mean(throughput[event]);
    }
    if (rough) {
        share[GLINT_EVENT_MIRROR] = share[GLINT_EVENT_REFRACT] = 0;
        if (frame->plan->rough_samples && may_reflect(batch, frame->plan, i))
            spread_shares(indirect, frame, number, i, share);
    }
    const double all = ((share[GLINT_EVENT_SCATTER] + share[GLINT_EVENT_MIRROR]) + share[GLINT_EVENT_REFRACT]) + share[GLINT_EVENT_STRAIGHT];
    if (!(all > 0))
        return GLINT_EVENT_NONE;
    const glint_event event = sample_event(indirect, number, rays, ray, share, all);
    const double pdf = share[event] / all;
    const bool by_facets = spreads(rough, event);
    for (int c = 0; c < 3; c++) {
        throughput[event][c] = glint_clamp_throughput((by_facets ? rays->throughput[c][ray] : throughput[event][c]) / pdf);
        least = glint_larger(least, by_facets ? all / 3 : throughput[event][c] * (event == GLINT_EVENT_SCATTER ? diffuse[c] : 1));
    }
    if (least <= rays->min_throughput[ray])
        return GLINT_EVENT_NONE;
    if (event == GLINT_EVENT_SCATTER || by_facets)
        glint_ray_begin(batch, &batch->tile, frame, i, next, i);
    else
        glint_ray_continue(batch, &batch->tile, frame, i, event, next, i);
    for (int c = 0; c < 3; c++)
        next->throughput[c][i] = throughput[event][c];
    if (event == GLINT_EVENT_MIRROR || event == GLINT_EVENT_REFRACT)
        glint_rays_mark(next->skip_emitters, i, next->scatters[i] > 0);
    return event;
}

/// Starts the reflected rays of the paths at plain rough surfaces, the lanes in `plain`.
static void spread_plain(struct glint_indirect *indirect, const glint_tile_frame *frame, const uint16_t *plain,
                         glint_rays *next)
{
    const glint_tile *tile = &indirect->batch.tile;
    const glint_precision precision = frame->plan->desc.precision;
    glint_spread_args args = { .group_count = tile->group_count, .wanted = plain, .alpha = indirect->alpha,
                               .grazing = indirect->grazing, .weight = indirect->unmasked,
                               .disk = { indirect->direction[0], indirect->direction[1] } };
    glint_bounce_material buffer;
    for (int c = 0; c < 3; c++) {
        args.normal[c] = tile->surface.normal[c];
        args.ray[c] = tile->rays.direction[c];
        args.direction[c] = indirect->direction[c];
    }
    frame->stages->geometry[precision].spread(&args);
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        if (!glint_has_lane(plain, i))
            continue;
        const glint_bounce_material *m = glint_tile_bouncing(tile, frame->plan, i, &buffer);
        next->depth[i]++;
        next->skip_emitters[i / GLINT_GROUP] |= (uint16_t)((unsigned)m->facets << i % GLINT_GROUP);
        for (int c = 0; c < 3; c++) {
            const double share = m->mirror[c] * m->specular[c] * glint_schlick(m, c, indirect->grazing[i]);
            glint_real_put(next->direction[c], precision, i, glint_real_at(indirect->direction[c], precision, i));
            next->throughput[c][i] = glint_clamp_throughput(next->throughput[c][i] * (share * indirect->unmasked[i]));
        }
    }
}

/// Starts the scattered ray of the path of sample i.
static void leave(const struct glint_indirect *indirect, const glint_tile_frame *frame, uint32_t i, glint_rays *next)
{
    const glint_tile *tile = &indirect->batch.tile;
    const glint_precision precision = frame->plan->desc.precision;
    double buffer[3];
    const double *diffuse = glint_tile_diffuse(tile, frame->plan, i, buffer);
    const bool free = glint_indirect_leaves(tile, frame->plan, i, indirect->direction);
    next->scatters[i]++;
    glint_rays_mark(next->skip_emitters, i, true);
    for (int c = 0; c < 3; c++) {
        glint_real_put(next->direction[c], precision, i, glint_real_at(indirect->direction[c], precision, i));
        next->throughput[c][i] = glint_clamp_throughput(next->throughput[c][i] * (diffuse[c] * (free ? 1 : 0)));
    }
}

/// Continues the paths that matt surfaces scatter.
static void scatter(struct glint_indirect *indirect, const glint_tile_frame *frame, glint_rays *next)
{
    const glint_tile *tile = &indirect->batch.tile;
    const void *const normal[] = { tile->surface.normal[0], tile->surface.normal[1], tile->surface.normal[2] };
    const draws *drawn = &indirect->next_draws;
    if (frame->plan->sky)
        glint_indirect_draw_sky(tile, frame->plan, indirect->scattered, drawn, 0, indirect->direction, indirect->share);
    else
        glint_indirect_scatter(frame, tile->group_count, normal, indirect->scattered, drawn, 0, indirect->direction);
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = indirect->scattered[g]; bits; bits &= bits - 1)
            leave(indirect, frame, g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits), next);
    if (frame->plan->sky)
        glint_indirect_weigh_sky(next, indirect->scattered, indirect->share);
}

/// Notes the point of the sequence for the next direction of a path.
static void draw_next(struct glint_indirect *indirect, const glint_rays *next, uint64_t number, uint32_t i)
{
    const uint64_t k = glint_indirect_point_of(indirect, next->point[i], number);
    const glint_sequence_seed seed = glint_sequence_seed_of(glint_indirect_seed_of(indirect, next->point[i], k, next_seed(next, i)));
    glint_indirect_note(&indirect->next_draws, i, k, &seed, 0);
}

/// Continues the paths that rough surfaces reflect or refract.
static void spread(struct glint_indirect *indirect, const glint_tile_frame *frame, uint64_t number, glint_rays *next)
{
    glint_batch *batch = &indirect->batch;
    const void *const up[] = { indirect->up[0], indirect->up[1], indirect->up[2] };
    glint_indirect_scatter(frame, batch->tile.group_count, up, indirect->spread, &indirect->next_draws, 0,
                           indirect->direction);
    uint16_t plain[GLINT_TILE_GROUPS] = { 0 };
    glint_bounce_material buffer;
    for (uint32_t g = 0; g < batch->tile.group_count; g++)
        for (unsigned bits = indirect->spread[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            double disk[2], cube[3], lot[2];
            if (glint_is_plain(frame->plan, batch->tile.surface.material[i])) {
                const double alpha = glint_tile_bouncing(&batch->tile, frame->plan, i, &buffer)->alpha;
                glint_real_put(indirect->alpha, frame->plan->desc.precision, i, alpha);
                plain[g] |= (uint16_t)(bits & -bits);
                continue;
            }
            for (int c = 0; c < 2; c++)
                disk[c] = glint_real_at(indirect->direction[c], frame->plan->desc.precision, i);
            glint_indirect_square(&indirect->next_draws, i, 0, cube);
            if (frame->plan->sky) // sample_event takes the first of them
                glint_indirect_draw(indirect, next->point[i], number, next_seed(batch->rays, batch->ray_of[i]) + 1, lot);
            cube[2] = frame->plan->sky ? lot[1] : 0;
            glint_rough_leave(batch, &batch->tile, frame, i, disk, cube, (glint_event)indirect->event[i], next, i);
        }
    spread_plain(indirect, frame, plain, next);
}

/// Returns whether a path at sample i has reached the limits of all its continuations.
static bool ends(const glint_batch *batch, const glint_plan *plan, uint32_t i, bool rough)
{
    return !(batch->rays->scatters[batch->ray_of[i]] < plan->indirect.bounces) && !glint_has_lane(batch->wanted, i) &&
           !(rough && may_reflect(batch, plan, i));
}

/// Continues every path that has hit a surface. Returns whether there is any.
static bool go_on(struct glint_indirect *indirect, const glint_tile_frame *frame, uint64_t number, uint32_t step)
{
    glint_batch *batch = &indirect->batch;
    const glint_tile *tile = &batch->tile;
    glint_rays *rays = &indirect->next[step & 1];
    unsigned any = 0;
    if (!frame->plan->bouncing && step + 1 >= frame->plan->indirect.bounces) // all paths have reached the limit
        return false;
    glint_indirect_find_directions(indirect, frame);
    glint_rays_clear(rays, tile->group_count);
    for (uint32_t g = 0; g < tile->group_count; g++) {
        indirect->scattered[g] = indirect->spread[g] = 0;
        for (unsigned bits = tile->at.hits[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            const bool rough = is_rough(batch, frame->plan, i);
            if (ends(batch, frame->plan, i, rough))
                continue;
            const glint_event event = choose(indirect, frame, number, i, rough, rays);
            if (event == GLINT_EVENT_NONE || (event != GLINT_EVENT_SCATTER && !spreads(rough, event)))
                continue;
            draw_next(indirect, rays, number, i);
            (event == GLINT_EVENT_SCATTER ? indirect->scattered : indirect->spread)[g] |= (uint16_t)(bits & -bits);
            glint_rays_mark(rays->inward, i, glint_has_lane(tile->hit.back, i));
            indirect->event[i] = (uint8_t)event;
        }
        any |= rays->active[g];
    }
    if (!any)
        return false;
    scatter(indirect, frame, rays);
    if (frame->plan->rough_samples)
        spread(indirect, frame, number, rays);
    batch->rays = rays;
    return true;
}

// ---- Light of the paths ----

/// Sums the light that the samples of a group send back along their rays, in each channel.
static void local_light(const glint_batch *batch, uint32_t g, double light[3][GLINT_GROUP])
{
    const double(*sum)[3][GLINT_TILE_SAMPLES] = batch->tile.film.sum;
    _Static_assert(GLINT_TERM_LOCAL == 4, "in the order of glint_batch_local_light");
    for (int c = 0; c < 3; c++)
        for (uint32_t i = 0; i < GLINT_GROUP; i++) {
            const uint32_t at = g * GLINT_GROUP + i;
            light[c][i] = ((sum[0][c][at] + sum[1][c][at]) + sum[2][c][at]) + sum[3][c][at];
        }
}

/// Scales the weight of light that ray i brings to at most desc.clamp, as if its pixel had only this path. The background
/// is not limited if the first ray of a path shows it, or the second one through glass. hit: whether the ray hit a surface.
static void limit_light(const struct glint_indirect *indirect, const glint_plan *plan, uint32_t i, bool hit, const double light[3],
                        double weight[3])
{
    const glint_rays *rays = indirect->batch.rays;
    const bool leaves_glass = rays->term[i] == GLINT_TERM_TRANSMISSION && rays->scatters[i] == 0 && rays->depth[i] <= 2;
    double most = 0;
    if (plan->desc.clamp == 0 || plan->indirect.is_sky || (!hit && (rays == &indirect->first || leaves_glass)))
        return;
    for (int c = 0; c < 3; c++)
        most = glint_larger(weight[c] * light[c] * indirect->paths[rays->point[i]], most);
    for (int c = 0; c < 3 && most > plan->desc.clamp; c++)
        weight[c] *= plan->desc.clamp / most;
}

/// Adds the light of rays that hit in some samples of a group. Paths that end there take the ambient light instead of
/// the indirect light of further steps.
static void collect_group(const struct glint_indirect *indirect, const glint_plan *plan, uint32_t g, unsigned lanes, glint_tile *to)
{
    const glint_batch *batch = &indirect->batch;
    const glint_rays *rays = batch->rays;
    double light[3][GLINT_GROUP];
    local_light(batch, g, light);
    for (unsigned bits = lanes; bits; bits &= bits - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(bits), at = g * GLINT_GROUP + lane, i = batch->ray_of[at];
        const bool last = plan->indirect.rest && rays->scatters[i] == plan->indirect.bounces && batch->tile.at.hits[g] >> lane & 1;
        double(*sum)[GLINT_TILE_SAMPLES] = to->film.sum[rays->term[i]], weight[3], rest[3], all[3];
        for (int c = 0; c < 3; c++) {
            rest[c] = last ? glint_tile_ambient_rest(&batch->tile, plan, at, c) : 0;
            weight[c] = rays->throughput[c][i];
            all[c] = light[c][lane] + rest[c];
        }
        limit_light(indirect, plan, i, batch->tile.at.hits[g] >> lane & 1, all, weight);
        for (int c = 0; c < 3; c++) {
            sum[c][rays->pixel[i]] += weight[c] * all[c];
            if (plan->light_groups)
                glint_groups_add_ambient(to, plan, rays->pixel[i], c, weight[c] * rest[c]);
        }
        if (plan->light_groups)
            glint_groups_collect(batch, plan, to, at, rays->pixel[i], weight);
    }
}

/// The first rays of the eye's points belong to the point's own pixel.
void glint_indirect_collect_missed(const struct glint_indirect *indirect, const glint_tile_frame *frame,
                                   const uint16_t *missed, const double *background, glint_tile *to)
{
    const glint_rays *rays = indirect->batch.rays;
    glint_sky_args args = { .group_count = rays->group_count, .missed = missed };
    for (int c = 0; c < 3; c++) {
        args.weight[c] = rays->throughput[c];
        args.background[c] = background ? background[c] : 0;
        args.sum[c] = to->film.sum[indirect->term < GLINT_TERM_COUNT ? indirect->term : GLINT_TERM_INDIRECT][c];
    }
    if (background && rays == &indirect->first && !indirect->batch.ordered && indirect->term < GLINT_TERM_COUNT) { // each ray has its own pixel
        frame->stages->sky(&args);
        return;
    }
    for (uint32_t i = 0; i < rays->group_count * GLINT_GROUP; i++) {
        double light[3], weight[3];
        if (!glint_has_lane(missed, i))
            continue;
        for (int c = 0; c < 3; c++) {
            light[c] = background ? background[c] : indirect->batch.shown[c][i];
            weight[c] = rays->throughput[c][i];
        }
        limit_light(indirect, frame->plan, i, false, light, weight);
        for (int c = 0; c < 3; c++)
            to->film.sum[rays->term[i]][c][rays->pixel[i]] += weight[c] * light[c];
    }
}

/// Adds the light of the rays to their pixels; for a whole batch in the order of rays, which may share pixels.
static void collect(const struct glint_indirect *indirect, const glint_tile_frame *frame, glint_tile *to)
{
    const glint_batch *batch = &indirect->batch;
    const uint16_t *lanes = batch->whole ? batch->rays->active : batch->tile.at.hits;
    const uint32_t groups = batch->whole ? batch->rays->group_count : batch->tile.group_count;
    for (uint32_t g = 0; g < groups; g++)
        if (lanes[g])
            collect_group(indirect, frame->plan, g, lanes[g], to);
    if (batch->whole)
        return;
    uint16_t missed[GLINT_TILE_GROUPS];
    glint_batch_find_missed(batch, missed);
    glint_indirect_collect_missed(indirect, frame, missed, frame->plan->environment ? NULL : frame->plan->background, to);
}

/// Counts the rays: those of rough surfaces by the term of their light.
static void count_rays(const struct glint_indirect *indirect, glint_tile *to)
{
    const glint_rays *rays = indirect->batch.rays;
    uint64_t *count = !indirect->salt ? &to->counts.indirect : &to->counts.mirror;
    for (uint32_t g = 0; g < rays->group_count; g++) {
        *count += (unsigned)__builtin_popcount(rays->active[g]);
        for (unsigned bits = indirect->term < GLINT_TERM_COUNT ? 0 : rays->active[g]; bits; bits &= bits - 1) {
            const bool refracted = rays->term[g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits)] == GLINT_TERM_TRANSMISSION;
            to->counts.refraction += refracted;
            *count -= refracted;
        }
    }
}

void glint_indirect_follow(struct glint_indirect *indirect, const glint_tile_frame *frame, glint_tile *to,
                           uint64_t number)
{
    glint_batch *batch = &indirect->batch;
    bool any = true;
    batch->rays = &indirect->first;
    for (uint32_t step = 0; any && !glint_tile_cancelled(frame); step++) {
        count_rays(indirect, to);
        take_lights(indirect, frame->plan, number, step);
        any = glint_batch_cast(batch, &indirect->frame);
        if (frame->plan->indirect.is_sky) {
            any = glint_indirect_open_sky(indirect, frame, any, step, to);
            continue;
        }
        if (any || batch->whole)
            glint_batch_light(batch, frame, &indirect->frame, any);
        collect(indirect, frame, to);
        any = any && go_on(indirect, frame, number, step);
    }
}

void glint_indirect_begin(struct glint_indirect *indirect, const glint_tile_frame *frame)
{
    indirect->plan = *frame->plan;
    indirect->plan.lights = indirect->lights;
    indirect->plan.light_count = frame->plan->indirect.light_count;
    indirect->frame = *frame;
    indirect->frame.plan = &indirect->plan;
    indirect->term = GLINT_TERM_INDIRECT;
    for (uint32_t i = 0; frame->plan->rough_samples && i < GLINT_TILE_SAMPLES; i++)
        for (int c = 0; c < 3; c++)
            glint_real_put(indirect->up[c], frame->plan->desc.precision, i, c == 2);
}

/// Follows paths of light from the hits of `seen`, and adds their light to the sums of `tile`. from: the batch that
/// `seen` belongs to; NULL: `seen` is `tile`, with the hits of the eye.
static void gather(glint_tile *tile, const glint_tile_frame *frame, const glint_tile *seen, const glint_batch *from)
{
    struct glint_indirect *indirect = tile->own[GLINT_STAGE_INDIRECT];
    glint_batch *batch = &indirect->batch;
    glint_indirect_begin(indirect, frame);
    glint_plan_drop(&indirect->plan, GLINT_STAGE_VISIBLE_LIGHT);
    if (frame->plan->indirect.is_sky) { // the sky counts as open whatever the background is
        indirect->plan.environment = NULL;
        glint_plan_drop(&indirect->plan, GLINT_STAGE_ENVIRONMENT);
    }
    const uint32_t paths = glint_indirect_find_points(indirect, tile, frame, seen, from);
    glint_batch_begin(batch, tile, frame, GLINT_WALK_INDIRECT);
    batch->ordered = from != NULL; // rays may share pixels
    batch->distances = frame->plan->indirect.is_sky && !frame->plan->transmits && !frame->plan->clears;
    for (uint32_t path = 0; path < paths && !glint_tile_cancelled(frame); path++) {
        const uint64_t number = (uint64_t)tile->sample * frame->plan->indirect.samples + path;
        batch->tile.sample = (uint32_t)number;
        if (glint_indirect_begin_paths(indirect, frame, seen, path, number))
            glint_indirect_follow(indirect, frame, tile, number);
    }
    glint_batch_end(batch, tile);
}

static glint_key own_key(const glint_plan *plan, glint_key key)
{
    GLINT_KEY_ADD(key, plan->indirect.samples);
    GLINT_KEY_ADD(key, plan->indirect.bounces);
    GLINT_KEY_ADD(key, plan->desc.clamp);
    if (plan->indirect.is_sky)
        GLINT_KEY_ADD(key, plan->indirect.distance);
    return glint_key_add(key, plan->indirect.rest, plan->material_count * sizeof *plan->indirect.rest);
}

static bool called(const glint_plan *plan) { return plan->indirect.samples > 0; }

/// Adds the light from other surfaces and from the background.
static void add(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (!walk->any)
        return;
    glint_tile_need_points(tile, frame, walk);
    gather(tile, frame, tile, NULL);
    glint_tile_count_stage(tile, frame, GLINT_STAGE_INDIRECT, false);
}

/// Adds this light at the hits of secondary rays.
static void add_sent(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (walk->any)
        gather(tile, frame, &walk->batch->tile, walk->batch);
}

static void release(glint_plan *plan)
{
    free(plan->indirect.rest);
    free(plan->indirect.light_rows);
}

const glint_stage glint_stage_indirect = {
    .name = "indirect",
    .doc = "light from other surfaces and from the background",
    .calls = "environment rough",
    .prepare = glint_indirect_prepare,
    .release = release,
    .called = called,
    .own = own_key,
    .reads = GLINT_READS_OWN(INDIRECT) | GLINT_READS_OWN(BOUNCE) | GLINT_READS_OWN(ROUGH),
    .walks = true,
    .sums = true,
    .normals = true,
    .remote = true,
    .step = { [GLINT_AFTER_LIGHTS] = add, [GLINT_AFTER_SECONDARY] = add_sent },
    .adds = glint_tile_adds_to_hits,
    .create = create,
    .destroy = glint_indirect_destroy,
    .sized = true,
};
