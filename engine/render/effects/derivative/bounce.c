/// Derivatives beyond the first surface: each reflected or refracted ray has the slopes of its origin, of its
/// direction and of its weight. Its hits are held to their surfaces like the hits of the eye.
#include "engine/base/alloc.h"
#include "engine/base/dual.h"
#include "engine/base/vec.h"
#include "engine/render/effects/derivative/work.h"

#include <string.h>

// ---- Continued rays -----------------------------------------------------------------------------------------------

/// A ray at a surface, with its slopes for one derivative.
typedef struct turning {
    glint_dual direction[3], normal[3]; ///< unit
    glint_dual ratio; ///< see glint_batch
    glint_dual cosine; ///< between them
    glint_dual throughput[3]; ///< share of the light along the ray on arrival
    double point[3]; ///< slopes
} turning;

/// Returns the refractive index of a medium.
static glint_dual index_of(const glint_plan *plan, const glint_plan_derivative *d, uint32_t medium)
{
    return medium == GLINT_NO_MEDIUM ? dual(1, 0) : dual(plan->bouncing[medium].ior, d->bounces[medium].ior);
}

static turning find_turning(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, size_t index,
                            uint32_t i)
{
    const glint_plan *plan = frame->plan;
    const glint_plan_derivative *d = &plan->derivatives->of[index];
    glint_derivative_points points;
    glint_derivative_find_points(tile, frame, i / GLINT_GROUP, &points);
    const bool later = tile == &batch->tile;
    const uint32_t ray = later ? batch->ray_of[i] : 0;
    glint_bend bend = { .point = { 0 } };
    turning t = { .cosine = { 0, 0 } };
    uint32_t sides[2];
    if (d->bends)
        glint_bend_sample(tile, frame, index, i, &points, &bend);
    glint_event_sides(batch, tile, frame, i, sides);
    t.ratio = dual_div(index_of(plan, d, sides[0]), index_of(plan, d, sides[1]));
    for (int c = 0; c < 3; c++) {
        t.direction[c] = dual(-points.eye[c][i % GLINT_GROUP], -bend.eye[c]);
        t.normal[c] = dual(points.normal[c][i % GLINT_GROUP], bend.normal[c]);
        t.cosine = dual_sub(t.cosine, dual_mul(t.direction[c], t.normal[c]));
        t.point[c] = bend.point[c];
        t.throughput[c] = later ? dual(batch->rays->throughput[c][ray],
                                       batch->rays->slopes[ray * plan->derivatives->count + index].weight[c])
                                : dual(1, 0);
    }
    if (!(t.cosine.value > 0)) // as in the stage bounce
        t.cosine = dual(0, 0);
    return t;
}

/// Computes the cosine of the refracted ray, and the reflectance by Fresnel's formula; see effects/bounce/kernel.c.
static void refract(const turning *t, glint_dual *beyond, glint_dual *reflectance)
{
    const glint_dual one = dual(1, 0), c = t->cosine, r = t->ratio;
    const glint_dual k2 = dual_sub(one, dual_mul(dual_mul(r, r), dual_sub(one, dual_mul(c, c))));
    *beyond = k2.value > 0 ? dual_sqrt(k2) : dual(0, 0);
    const glint_dual x = dual_mul(r, c), y = dual_mul(r, *beyond);
    *reflectance = dual(0, 0);
    if (!(x.value + beyond->value > 0)) // along a surface between two equal media
        return;
    const glint_dual p = dual_div(dual_sub(x, *beyond), dual_add(x, *beyond)), q = dual_div(dual_sub(c, y), dual_add(c, y));
    *reflectance = dual_scale(dual_add(dual_mul(p, p), dual_mul(q, q)), 0.5);
}

/// Returns the slopes of a ray along ratio direction + bend normal, with the weight `share` times `factor`.
static glint_ray_slope slope_of(const turning *t, glint_dual ratio, glint_dual bend, const glint_dual share[3],
                                glint_dual factor)
{
    glint_ray_slope out;
    for (int c = 0; c < 3; c++) {
        out.origin[c] = t->point[c];
        out.direction[c] = dual_add(dual_mul(ratio, t->direction[c]), dual_mul(bend, t->normal[c])).slope;
        out.weight[c] = dual_mul(t->throughput[c], dual_mul(share[c], factor)).slope;
    }
    return out;
}

/// Returns channel c of a mirror or transmission: `value` and its slope, as a number or as a program's result.
static glint_dual share_of(const glint_tile *tile, const glint_plan *plan, size_t index, uint32_t i, int field, int c,
                           double value, double slope)
{
    const glint_program *program = plan->derivatives->of[index].programs[tile->surface.material[i]].of[field];
    return dual(value, program ? glint_derivative_painted(tile, plan, index, field, c)[i] : slope);
}

/// Like glint_bsdf_weights, for one derivative.
static void split(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, size_t index, uint32_t i,
                  glint_ray_slope slopes[GLINT_SPLITS][GLINT_DERIVATIVES_MAX])
{
    const uint32_t material = tile->surface.material[i];
    glint_bounce_material buffer;
    const glint_bounce_material *m = glint_tile_bouncing(tile, frame->plan, i, &buffer);
    const glint_derivative_bounce *slope = &frame->plan->derivatives->of[index].bounces[material];
    const bool total = glint_has_lane(batch->total, i);
    const turning t = find_turning(batch, tile, frame, index, i);
    const glint_dual one = dual(1, 0), twice = dual_scale(t.cosine, 2);
    const glint_dual clear = dual(m->clear, slope->clear), opacity = dual_sub(one, clear), straight[] = { clear, clear, clear };
    glint_dual beyond = one, reflectance = one, mirrored[3], sent[3];
    if (!total) {
        refract(&t, &beyond, &reflectance);
        reflectance.value = glint_real_at(batch->reflectance, frame->plan->desc.precision, i);
    }
    for (int c = 0; c < 3; c++) {
        mirrored[c] = share_of(tile, frame->plan, index, i, GLINT_FIELD_MIRROR, c, m->mirror[c], slope->mirror[c]);
        sent[c] = share_of(tile, frame->plan, index, i, GLINT_FIELD_TRANSMISSION, c, m->transmission[c], slope->transmission[c]);
        if (total) // see total_share of paths/event.c
            sent[c] = m->transmits && mirrored[c].value < opacity.value ? dual_sub(opacity, mirrored[c]) : dual(0, 0);
    }
    const glint_dual part = m->fresnel ? reflectance : one, rest = m->fresnel ? dual_sub(one, reflectance) : one;
    const glint_dual bend = total ? twice : dual_sub(dual_mul(t.ratio, t.cosine), beyond);
    slopes[GLINT_EVENT_MIRROR][index] = slope_of(&t, one, twice, mirrored, part);
    slopes[GLINT_EVENT_REFRACT][index] = slope_of(&t, total ? one : t.ratio, bend, sent, rest);
    slopes[GLINT_EVENT_STRAIGHT][index] = slope_of(&t, one, dual(0, 0), straight, one);
}

void glint_derive_split(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                        glint_ray_slope slopes[GLINT_SPLITS][GLINT_DERIVATIVES_MAX])
{
    for (size_t k = 0; k < frame->plan->derivatives->count; k++)
        split(batch, tile, frame, k, i, slopes);
}

// ---- Light of the rays --------------------------------------------------------------------------------------------

void glint_derive_absorption(const glint_batch *batch, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    const glint_rays *rays = batch->rays;
    const size_t count = plan->derivatives->count;
    for (uint32_t ray = 0; ray < rays->group_count * GLINT_GROUP; ray++) {
        const uint32_t medium = glint_has_lane(rays->active, ray) ? glint_batch_crossed(batch, frame, ray) : GLINT_NO_MEDIUM;
        if (medium == GLINT_NO_MEDIUM)
            continue;
        const uint32_t i = batch->sample[ray];
        const bool hit = glint_batch_has_sample(batch, ray) && glint_has_lane(batch->tile.at.hits, i);
        const double distance =
            glint_batch_has_sample(batch, ray) ? glint_real_at(batch->tile.at.t, plan->desc.precision, i) : HUGE_VAL;
        for (size_t k = 0; k < count; k++) {
            const glint_plan_derivative *d = &plan->derivatives->of[k];
            glint_derivative_points points;
            glint_derivative_find_points(&batch->tile, frame, i / GLINT_GROUP, &points);
            glint_ray_slope *slope = &rays->slopes[ray * count + k];
            glint_bend bend;
            double longer = 0;
            if (hit && d->bends && glint_bend_sample(&batch->tile, frame, k, i, &points, &bend))
                for (int c = 0; c < 3; c++)
                    longer -= (bend.point[c] - slope->origin[c]) * points.eye[c][i % GLINT_GROUP];
            for (int c = 0; c < 3; c++) {
                const double a = plan->bouncing[medium].absorption[c], more = d->bounces[medium].absorption[c];
                const double weight = rays->throughput[c][ray],
                             off = distance < HUGE_VAL ? a * longer + more * distance : 0;
                slope->weight[c] = slope->weight[c] * glint_plan_transmittance(a, distance) - weight * off;
            }
        }
    }
}

/// Adds to the pixel's hash the surfaces that a ray has hit, and the lights hidden from them.
static void note_ray(const glint_batch *batch, glint_tile *to, uint32_t ray)
{
    const glint_derivative_work *work = glint_derivative_of(&batch->tile);
    const uint32_t pixel = batch->rays->pixel[ray], i = batch->sample[ray];
    const bool sampled = glint_batch_has_sample(batch, ray);
    uint32_t *hash = &glint_derivative_of(to)->shadows[pixel];
    *hash = (*hash ^ (sampled ? work->shadows[i] : 1)) * GLINT_SHADOW_MIXER;
    if (sampled && glint_has_lane(work->mixed, i))
        glint_derivative_of(to)->mixed[pixel / GLINT_GROUP] |= (uint16_t)(1u << pixel % GLINT_GROUP);
}

void glint_derive_collect(const glint_batch *batch, const glint_plan *plan, glint_tile *to)
{
    const glint_plan_derivatives *all = plan->derivatives;
    const glint_rays *rays = batch->rays;
    const glint_derivative_work *work = glint_derivative_of(&batch->tile);
    for (uint32_t g = 0; g < rays->group_count; g++)
        for (unsigned bits = rays->active[g]; bits; bits &= bits - 1) {
            const uint32_t ray = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits), pixel = rays->pixel[ray];
            const bool sampled = glint_batch_has_sample(batch, ray);
            const uint32_t i = batch->sample[ray];
            const bool own = sampled && glint_derivatives_weigh(all) && glint_has_lane(batch->tile.at.hits, i);
            const bool seen = !plan->desc.alpha || !glint_batch_uncovers(batch, plan, ray);
            for (int c = 0; c < 3 && seen; c++) {
                const double weight = rays->throughput[c][ray];
                const double light = own ? work->light[c][i] : glint_batch_light_of(batch, plan, c, ray);
                if (glint_derivatives_read_light(to, plan))
                    glint_derivative_of(to)->light[c][pixel] += weight * light;
                for (size_t k = 0; k < all->count; k++) {
                    const double slope = sampled ? work->sum[k][c][i] : all->of[k].background[c];
                    glint_derivative_of(to)->sum[k][c][pixel] += rays->slopes[ray * all->count + k].weight[c] * light + weight * slope;
                }
            }
            if (all->moves)
                note_ray(batch, to, ray);
        }
}
