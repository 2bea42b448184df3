/// What happens to a ray at a surface: media and their indices, Fresnel shares, and the continued ray.
#include "engine/render/paths/event.h"
#include "engine/base/vec.h"

#include <string.h>

bool glint_tile_shows(const glint_tile *tile, const glint_tile_frame *frame, bool (*test)(const glint_bounce_material *))
{
    const glint_bounce_material *materials = frame->plan->bouncing;
    uint32_t last = GLINT_MISS; // most lanes show the same primitive as the previous lane
    if (tile->at.only)
        return test(&materials[frame->geometry.prims[*tile->at.only].material]);
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = tile->at.hits[g]; bits; bits &= bits - 1) {
            const uint32_t material = tile->surface.material[g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits)];
            if (material != last && test(&materials[material]))
                return true;
            last = material;
        }
    return false;
}

/// Returns the medium inside the surface of sample i.
static uint32_t medium_of(const glint_tile *tile, const glint_tile_frame *frame, uint32_t i)
{
    return frame->geometry.prims[tile->at.prim[i]].medium;
}

static double index_of(const glint_plan *plan, uint32_t medium)
{
    return medium == GLINT_NO_MEDIUM ? 1 : plan->bouncing[medium].ior;
}

static const glint_media *media_of(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame,
                                   uint32_t i)
{
    return tile == &batch->tile && frame->plan->transmits ? glint_batch_media(batch, i) : &frame->plan->eye_media;
}

/// An opaque material is solid: its index applies beyond the surface, from either side.
void glint_event_sides(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       uint32_t sides[2])
{
    const glint_media *media = media_of(batch, tile, frame, i);
    const uint32_t material = tile->surface.material[i], medium = medium_of(tile, frame, i);
    const bool back = glint_has_lane(tile->hit.back, i);
    sides[0] = glint_media_top(media);
    sides[1] = material;
    if (!frame->plan->bouncing[material].transmits)
        return;
    glint_media beyond = *media;
    glint_media_cross(&beyond, medium, back);
    sides[0] = glint_media_before(media, medium, back);
    sides[1] = glint_media_top(&beyond);
}

double glint_event_ratio(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i)
{
    const glint_bounce_material *m = &frame->plan->bouncing[tile->surface.material[i]];
    uint32_t sides[2];
    if (!m->transmits && !m->fresnel && !glint_plan_bumps(frame->plan))
        return 1;
    glint_event_sides(batch, tile, frame, i, sides);
    return index_of(frame->plan, sides[0]) / index_of(frame->plan, sides[1]);
}

static void load(void *const array[3], glint_precision precision, uint32_t i, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = glint_real_at(array[c], precision, i);
}

/// Returns whether light along `d` continues with the normal `n` as with the surface's own normal: reflected on this
/// side of it, refracted beyond. ratio: see glint_bounce_args.
static bool goes_on(const double d[3], const double n[3], const double own[3], double ratio)
{
    double u[3], reflected[3], refracted[3];
    vec_normalize(u, d);
    const double cosine = -vec_dot(n, u), k = 1 - ratio * ratio * (1 - cosine * cosine), s = sqrt(fmax(k, 0));
    for (int c = 0; c < 3; c++) {
        reflected[c] = u[c] + 2 * cosine * n[c];
        refracted[c] = ratio * u[c] + (ratio * cosine - s) * n[c];
    }
    return cosine > 0 && vec_dot(reflected, own) > 0 && (!(k > 0) || vec_dot(refracted, own) < 0);
}

/// Computes the normals used for reflection and refraction. If the bumped normal would send light through the surface
/// of a mirror, or not through the surface of glass, the unbumped normal is used.
static void find_normals(glint_batch *batch, const glint_tile *tile, const glint_plan *plan, const void *normal[3])
{
    const glint_precision precision = plan->desc.precision;
    void *own[3], *perturbed[3];
    for (int c = 0; c < 3; c++) {
        own[c] = tile->unbumped[c];
        normal[c] = perturbed[c] = batch->normal[c];
        memcpy(perturbed[c], tile->surface.normal[c], tile->group_count * GLINT_GROUP * sizeof(double));
    }
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        double d[3], n[3], surface[3];
        if (!glint_has_lane(batch->wanted, i) || !plan->patterns->of[tile->surface.material[i]].slope)
            continue;
        load(perturbed, precision, i, n);
        load(own, precision, i, surface);
        for (int c = 0; c < 3; c++)
            d[c] = glint_tile_direction(tile, precision, c, i);
        for (int c = 0; c < 3 && !goes_on(d, n, surface, glint_real_at(batch->ratio, precision, i)); c++)
            glint_real_put(perturbed[c], precision, i, surface[c]);
    }
}

bool glint_event_leaves(const glint_tile *tile, const glint_plan *plan, uint32_t i, const double direction[3])
{
    double n[3];
    if (!glint_plan_bumps(plan) || !plan->patterns->of[tile->surface.material[i]].slope)
        return true;
    for (int c = 0; c < 3; c++)
        n[c] = glint_real_at(tile->unbumped[c], plan->desc.precision, i);
    return vec_dot(n, direction) > 0;
}

void glint_event_find_directions(glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_precision precision = frame->plan->desc.precision;
    glint_bounce_args args = { .group_count = tile->group_count,
                               .wanted = batch->wanted,
                               .camera = glint_tile_rays_of(tile),
                               .ratio = batch->ratio,
                               .reflectance = batch->reflectance,
                               .total = batch->total };
    for (int c = 0; c < 3; c++) {
        args.direction[c] = tile->rays.direction[c];
        args.normal[c] = tile->surface.normal[c];
        args.reflected[c] = batch->reflected[c];
        args.refracted[c] = batch->refracted[c];
    }
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = batch->wanted[g]; bits; bits &= bits - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits);
            glint_real_put(batch->ratio, precision, i, glint_event_ratio(batch, tile, frame, i));
        }
    if (glint_plan_bumps(frame->plan))
        find_normals(batch, tile, frame->plan, args.normal);
    frame->stages->geometry[precision].bounce(&args);
}

/// Fills the share of totally reflected light. This light has not crossed the surface, so all of it goes on, except
/// for the share that a mirror already reflects and the share that goes straight on.
static void total_share(const glint_bounce_material *m, double share[3])
{
    const double all = 1 - m->clear;
    for (int c = 0; c < 3; c++)
        share[c] = m->mirror[c] < all ? all - m->mirror[c] : 0;
}

void glint_bsdf_weights(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                       double throughput[GLINT_SPLITS][3])
{
    glint_bounce_material buffer;
    const glint_bounce_material *m = glint_tile_bouncing(tile, frame->plan, i, &buffer);
    const double part = m->fresnel ? glint_real_at(batch->reflectance, frame->plan->desc.precision, i) : 1;
    const double transmitted = m->fresnel ? 1 - part : 1;
    double rest[3];
    total_share(m, rest);
    const double *share = glint_has_lane(batch->total, i) ? rest : m->transmission;
    for (int c = 0; c < 3; c++) {
        throughput[GLINT_EVENT_MIRROR][c] = glint_clamp_throughput(throughput[GLINT_EVENT_MIRROR][c] * (m->mirror[c] * part));
        throughput[GLINT_EVENT_REFRACT][c] =
            m->transmits ? glint_clamp_throughput(throughput[GLINT_EVENT_REFRACT][c] * (share[c] * transmitted)) : 0;
        throughput[GLINT_EVENT_STRAIGHT][c] = m->clears ? glint_clamp_throughput(throughput[GLINT_EVENT_STRAIGHT][c] * m->clear) : 0;
    }
}

/// Returns whether a ray that goes on from sample i crosses its surface.
static bool crosses(const glint_batch *batch, uint32_t i, glint_event event)
{
    return event == GLINT_EVENT_STRAIGHT || (event == GLINT_EVENT_REFRACT && !glint_has_lane(batch->total, i));
}

void glint_event_cross(const glint_tile *tile, const glint_tile_frame *frame, uint32_t i, glint_media *media)
{
    if (frame->plan->bouncing[tile->surface.material[i]].transmits)
        glint_media_cross(media, medium_of(tile, frame, i), glint_has_lane(tile->hit.back, i));
}

/// Computes the unit direction of the straight ray of sample i. It is bit-identical to the direction of a secondary
/// ray, which is unit; the direction of a camera ray is normalised.
static void straight_direction(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = glint_tile_direction(tile, frame->plan->desc.precision, c, i);
    if (tile != &batch->tile)
        vec_normalize(out, out);
}

// ---- The ray that goes on ----

void glint_ray_begin(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                     glint_rays *rays, uint32_t n)
{
    const glint_plan *plan = frame->plan;
    const glint_precision precision = plan->desc.precision;
    const glint_rays *from = tile == &batch->tile ? batch->rays : NULL;
    const uint32_t ray = from ? batch->ray_of[i] : 0;
    for (int c = 0; c < 3; c++) {
        glint_real_put(rays->origin[c], precision, n, glint_real_at(tile->surface.point[c], precision, i));
        rays->throughput[c][n] = from ? from->throughput[c][ray] : 1;
    }
    rays->origin_prim[n] = tile->at.prim[i];
    rays->path_length[n] = from ? from->path_length[ray] : 0;
    if (plan->patterns)
        rays->path_length[n] += glint_real_at(tile->at.t, precision, i);
    rays->min_throughput[n] = from ? from->min_throughput[ray] : 0;
    rays->pixel[n] = from ? from->pixel[ray] : i;
    rays->point[n] = from ? from->point[ray] : 0;
    rays->depth[n] = from ? from->depth[ray] : 0;
    rays->straight_count[n] = from ? from->straight_count[ray] : 0;
    rays->scatters[n] = from ? from->scatters[ray] : 0;
    rays->term[n] = from ? from->term[ray] : 0;
    rays->camera_path[n] = from ? from->camera_path[ray] : true;
    glint_rays_mark(rays->active, n, true);
    glint_rays_mark(rays->inward, n, false);
    glint_rays_mark(rays->skip_emitters, n, from && glint_has_lane(from->skip_emitters, ray));
    if (plan->transmits)
        rays->media[n] = from ? from->media[ray] : plan->eye_media;
}

void glint_ray_continue(const glint_batch *batch, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                        glint_event event, glint_rays *rays, uint32_t n)
{
    const glint_precision precision = frame->plan->desc.precision;
    const bool through = crosses(batch, i, event);
    double direction[3];
    glint_ray_begin(batch, tile, frame, i, rays, n);
    for (int c = 0; c < 3; c++)
        direction[c] = glint_real_at(through ? batch->refracted[c] : batch->reflected[c], precision, i);
    if (event == GLINT_EVENT_STRAIGHT)
        straight_direction(batch, tile, frame, i, direction);
    for (int c = 0; c < 3; c++)
        glint_real_put(rays->direction[c], precision, n, direction[c]);
    if (event == GLINT_EVENT_STRAIGHT)
        rays->straight_count[n]++;
    else
        rays->depth[n]++;
    if (tile != &batch->tile)
        rays->term[n] = event == GLINT_EVENT_MIRROR ? GLINT_TERM_MIRROR : GLINT_TERM_TRANSMISSION;
    rays->camera_path[n] = rays->camera_path[n] && through;
    glint_rays_mark(rays->inward, n, glint_has_lane(tile->hit.back, i) != through);
    if (through && frame->plan->transmits)
        glint_event_cross(tile, frame, i, &rays->media[n]);
}
