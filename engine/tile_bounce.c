/// What lies beyond the first surface of a tile: mirrored and refracted rays, and what they find.
///
/// Rays wait in levels of at most one tile's samples. A batch is all that waits in the highest level, and where a surface
/// sends on two rays, the weaker goes a level up and the stronger stays: so a level never holds more than the batch that
/// filled it, and a ray of level n has at most 2^-n of the first one's weight wherever mirror + transmission is at most 1.
/// That bounds the memory, however long the chains are. The order of a pixel's rays, and so of its sums, depends on
/// nothing but that pixel.
///
/// A ray too weak to be seen is not followed: all that a sample loses so is at most GLINT_BOUNCE_LOSS of linear light, by
/// the plan's bound of what any ray can bring. That is 1/318 of the smallest step between two 8-bit sRGB codes.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/tile.h"

#include <stdlib.h>

#define WEIGHT_MAX 1e150 ///< products with what a surface gives stay finite

typedef struct bounce_ray {
    double origin[3], direction[3], weight[3];
    uint32_t leaving; ///< `coincident` of the primitive it starts on
    uint32_t pixel; ///< its sample's place in the tile
    uint32_t depth; ///< surfaces on its way so far
    uint16_t term; ///< of the first surface's: mirror or transmission
    bool inward;
    glint_media media;
} bounce_ray;

struct glint_bounce {
    glint_tile tile; ///< the batch, with its rays in arrays
    bounce_ray batch[GLINT_TILE_SAMPLES];
    bounce_ray levels[GLINT_BOUNCE_LEVELS][GLINT_TILE_SAMPLES];
    uint32_t counts[GLINT_BOUNCE_LEVELS];
    double budget[GLINT_TILE_SAMPLES]; ///< light that each sample may still lose
    uint16_t inward[GLINT_TILE_GROUPS], wanted[GLINT_TILE_GROUPS], total[GLINT_TILE_GROUPS];
    _Alignas(64) uint32_t leaving[GLINT_TILE_SAMPLES];
    _Alignas(64) double ratio[GLINT_TILE_SAMPLES];
    _Alignas(64) double reflectance[GLINT_TILE_SAMPLES];
    _Alignas(64) double reflected[3][GLINT_TILE_SAMPLES], refracted[3][GLINT_TILE_SAMPLES];
};

/// Its pages are the system's until a level is used.
struct glint_bounce *glint_bounce_create(void) { return glint_alloc(1, sizeof(struct glint_bounce)); }

void glint_bounce_destroy(struct glint_bounce *bounce) { free(bounce); }

static bool has_lane(const uint16_t *mask, uint32_t i) { return mask[i / GLINT_GROUP] >> i % GLINT_GROUP & 1; }

bool glint_tile_sends_on(const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_bounce_material *materials = frame->plan->bouncing;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++)
        if (has_lane(tile->at.hits, i) &&
            (materials[tile->material[i]].mirrors || materials[tile->material[i]].transmits))
            return true;
    return false;
}

// ---- What the eye is in ----

static bool holds(const glint_prim *prim, const double point[3])
{
    double e[3];
    if (prim->kind != GLINT_PRIM_SPHERE && prim->kind != GLINT_PRIM_PLANE)
        return false;
    vec_sub(e, point, prim->center);
    if (prim->kind == GLINT_PRIM_PLANE)
        return vec_dot(prim->normal, e) < 0;
    return sqrt(vec_dot(e, e)) < prim->radius;
}

void glint_find_eye_media(const glint_plan *plan, const glint_geometry_table *geometry, glint_media *media)
{
    double sizes[GLINT_MEDIA_MAX]; // falling: what is smaller is inside
    *media = (glint_media) { 0 };
    for (uint32_t i = 0; i < geometry->prim_count && !plan->camera.orthographic; i++) {
        const glint_prim *prim = &geometry->prims[i];
        if (!plan->bouncing[prim->material].transmits || !holds(prim, plan->camera.eye))
            continue;
        const double size = prim->kind == GLINT_PRIM_SPHERE ? prim->radius : HUGE_VAL;
        if (media->count == GLINT_MEDIA_MAX && size >= sizes[0])
            continue;
        if (media->count == GLINT_MEDIA_MAX)
            for (uint32_t k = 1; k < media->count; k++)
                sizes[k - 1] = sizes[k];
        glint_media_enter(media, prim->material);
        uint32_t at = media->count - 1;
        for (; at > 0 && sizes[at - 1] < size; at--) {
            sizes[at] = sizes[at - 1];
            media->material[at] = media->material[at - 1];
        }
        sizes[at] = size;
        media->material[at] = prim->material;
    }
}

// ---- From a surface on ----

static double index_of(const glint_plan *plan, uint32_t medium)
{
    return medium == GLINT_NO_MEDIUM ? 1 : plan->bouncing[medium].ior;
}

/// The refractive index on the ray's side of a surface over that beyond it. What lets nothing through is solid: its
/// index is beyond, from whichever side it is seen.
static double index_ratio(const glint_plan *plan, const glint_media *media, uint32_t material, bool back)
{
    const glint_bounce_material *m = &plan->bouncing[material];
    glint_media beyond = *media;
    if (!m->transmits)
        return index_of(plan, glint_media_top(media)) / m->ior;
    glint_media_cross(&beyond, material, back);
    return index_of(plan, glint_media_before(media, material, back)) / index_of(plan, glint_media_top(&beyond));
}

static const glint_media *media_of(const struct glint_bounce *bounce, const glint_tile *tile,
                                   const glint_tile_frame *frame, uint32_t i)
{
    return tile == &bounce->tile ? &bounce->batch[i].media : &frame->eye_media;
}

/// Where the rays of the samples in `tile` go on.
static void find_ways(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_precision precision = frame->plan->desc.precision;
    glint_bounce_args args = { .group_count = tile->group_count,
                               .wanted = bounce->wanted,
                               .camera = glint_tile_rays_of(tile),
                               .ratio = bounce->ratio,
                               .reflectance = bounce->reflectance,
                               .total = bounce->total };
    for (int c = 0; c < 3; c++) {
        args.direction[c] = tile->direction[c];
        args.normal[c] = tile->normal[c];
        args.reflected[c] = bounce->reflected[c];
        args.refracted[c] = bounce->refracted[c];
    }
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        double ratio = 1;
        if (has_lane(bounce->wanted, i))
            ratio =
                index_ratio(frame->plan, media_of(bounce, tile, frame, i), tile->material[i], has_lane(tile->back, i));
        glint_real_put(bounce->ratio, precision, i, ratio);
    }
    frame->stages->geometry[precision].bounce(&args);
}

/// The hits of `tile` whose materials send rays on, and whose chain is not at its end.
static bool choose(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame)
{
    const glint_plan *plan = frame->plan;
    bool any = false;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        bounce->wanted[g] = 0;
        for (unsigned left = tile->at.hits[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            const glint_bounce_material *m = &plan->bouncing[tile->material[i]];
            const uint32_t depth = tile == &bounce->tile ? bounce->batch[i].depth : 0;
            if ((m->mirrors || m->transmits) && depth < plan->desc.max_depth)
                bounce->wanted[g] |= (uint16_t)(left & -left);
        }
        any = any || bounce->wanted[g];
    }
    return any;
}

static double total_weight(const bounce_ray *ray) { return (ray->weight[0] + ray->weight[1]) + ray->weight[2]; }

/// Whether a ray must be followed; if not, what it might have brought is off the budget.
static bool matters(struct glint_bounce *bounce, const glint_plan *plan, const bounce_ray *ray)
{
    const double weight = fmax(ray->weight[0], fmax(ray->weight[1], ray->weight[2]));
    double *budget = &bounce->budget[ray->pixel];
    if (weight == 0)
        return false;
    const double lost = weight * plan->brightest;
    if (!(4 * lost <= *budget))
        return true;
    *budget -= lost;
    return false;
}

static void push(struct glint_bounce *bounce, uint32_t level, const bounce_ray *ray)
{
    if (level < GLINT_BOUNCE_LEVELS)
        bounce->levels[level][bounce->counts[level]++] = *ray;
}

/// A ray that starts where sample `i` of the tile hits, before its direction and weight are known.
static bounce_ray start_ray(const struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame,
                            uint32_t i)
{
    bounce_ray ray = { .weight = { 1, 1, 1 }, .pixel = i, .media = *media_of(bounce, tile, frame, i) };
    if (tile == &bounce->tile)
        ray = bounce->batch[i];
    ray.depth++;
    ray.leaving = frame->geometry.prims[tile->at.prim[i]].coincident;
    for (int c = 0; c < 3; c++)
        ray.origin[c] = glint_real_at(tile->point[c], frame->plan->desc.precision, i);
    return ray;
}

/// Points a ray along `way`, and weighs it.
static void send(bounce_ray *ray, const double (*way)[GLINT_TILE_SAMPLES], glint_precision precision, uint32_t i,
                 const double share[3], double factor)
{
    for (int c = 0; c < 3; c++) {
        ray->direction[c] = glint_real_at(way[c], precision, i);
        ray->weight[c] = fmin(ray->weight[c] * (share[c] * factor), WEIGHT_MAX);
    }
}

/// The mirrored and the refracted ray of one sample, the stronger one staying in `level`.
static void send_on(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame, uint32_t i,
                    uint32_t level)
{
    const glint_plan *plan = frame->plan;
    const glint_precision precision = plan->desc.precision;
    const glint_bounce_material *m = &plan->bouncing[tile->material[i]];
    const bool first = tile != &bounce->tile, back = has_lane(tile->back, i), total = has_lane(bounce->total, i);
    const double mirrored = m->fresnel ? glint_real_at(bounce->reflectance, precision, i) : 1;
    bounce_ray mirror = start_ray(bounce, tile, frame, i), through = mirror;
    send(&mirror, (const double(*)[GLINT_TILE_SAMPLES])bounce->reflected, precision, i, m->mirror, mirrored);
    mirror.inward = back;
    send(&through, (const double(*)[GLINT_TILE_SAMPLES])(total ? bounce->reflected : bounce->refracted), precision, i,
         m->transmission, m->fresnel ? 1 - mirrored : 1);
    through.inward = total ? back : !back;
    if (!total)
        glint_media_cross(&through.media, tile->material[i], back);
    if (first) {
        mirror.term = GLINT_TERM_MIRROR;
        through.term = GLINT_TERM_TRANSMISSION;
    } else if (total) { // both go the same way
        for (int c = 0; c < 3; c++)
            mirror.weight[c] = fmin(mirror.weight[c] + through.weight[c], WEIGHT_MAX);
        through.weight[0] = through.weight[1] = through.weight[2] = 0;
    }
    const bool mirrors = matters(bounce, plan, &mirror), transmits = matters(bounce, plan, &through);
    const bool weaker_mirror = mirrors && transmits && total_weight(&mirror) < total_weight(&through);
    if (mirrors)
        push(bounce, level + weaker_mirror, &mirror);
    if (transmits)
        push(bounce, level + (mirrors && !weaker_mirror), &through);
}

/// Sends on what the samples of `tile` have hit; `level` is that of the batch, and empty.
static void spawn(struct glint_bounce *bounce, const glint_tile *tile, const glint_tile_frame *frame, uint32_t level)
{
    if (!choose(bounce, tile, frame))
        return;
    find_ways(bounce, tile, frame);
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned left = bounce->wanted[g]; left; left &= left - 1)
            send_on(bounce, tile, frame, g * GLINT_GROUP + (uint32_t)__builtin_ctz(left), level);
}

// ---- A batch ----

/// Takes all rays of a level into the arrays of the batch; what is left of its last group does nothing.
static void load_batch(struct glint_bounce *bounce, glint_precision precision, uint32_t level,
                       glint_tile_counts *counts)
{
    glint_tile *tile = &bounce->tile;
    const uint32_t count = bounce->counts[level];
    memcpy(bounce->batch, bounce->levels[level], count * sizeof *bounce->batch);
    bounce->counts[level] = 0;
    tile->group_count = (count + GLINT_GROUP - 1) / GLINT_GROUP;
    for (uint32_t g = 0; g < tile->group_count; g++)
        tile->active[g] = bounce->inward[g] = 0;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        const bounce_ray *ray = &bounce->batch[i < count ? i : 0];
        for (int c = 0; c < 3; c++) {
            glint_real_put(tile->origin[c], precision, i, ray->origin[c]);
            glint_real_put(tile->direction[c], precision, i, ray->direction[c]);
        }
        bounce->leaving[i] = ray->leaving;
        if (i >= count)
            continue;
        tile->active[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
        if (ray->inward)
            bounce->inward[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
        counts->mirror += ray->term == GLINT_TERM_MIRROR;
        counts->refraction += ray->term == GLINT_TERM_TRANSMISSION;
    }
}

static bool cast_batch(struct glint_bounce *bounce, const glint_tile_frame *frame)
{
    glint_tile *tile = &bounce->tile;
    glint_cast_args args = { .group_count = tile->group_count,
                             .active = tile->active,
                             .geometry = &frame->geometry,
                             .stop = frame->cancelled,
                             .leaving = bounce->leaving,
                             .inward = bounce->inward,
                             .t = tile->at.t,
                             .prim = tile->at.prim,
                             .hits = tile->at.hits };
    for (int c = 0; c < 3; c++) {
        args.origin[c] = tile->origin[c];
        args.direction[c] = tile->direction[c];
    }
    frame->stages->geometry[frame->plan->desc.precision].cast_rays(&args);
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count; g++)
        any |= tile->at.hits[g];
    return any;
}

/// Weakens the rays by what they went through since their last surface.
static void absorb(struct glint_bounce *bounce, const glint_tile_frame *frame)
{
    const glint_tile *tile = &bounce->tile;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        if (!has_lane(tile->active, i))
            continue;
        bounce_ray *ray = &bounce->batch[i];
        const bool hit = has_lane(tile->at.hits, i);
        const uint32_t medium = hit && frame->plan->bouncing[tile->material[i]].transmits
                                    ? glint_media_before(&ray->media, tile->material[i], has_lane(tile->back, i))
                                    : glint_media_top(&ray->media);
        if (medium == GLINT_NO_MEDIUM)
            continue;
        const double way = glint_real_at(tile->at.t, frame->plan->desc.precision, i); // the directions are unit
        for (int c = 0; c < 3; c++)
            if (frame->plan->bouncing[medium].absorption[c] > 0)
                ray->weight[c] *= glint_exp(-frame->plan->bouncing[medium].absorption[c] * way);
    }
}

/// One light, or those samples of one that follow each other in a chunk; returns how many rows of the plan they are.
static uint32_t shine(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, uint32_t slot, uint32_t end)
{
    const glint_plan_light *lights = &frame->plan->lights[first];
    uint32_t slots[GLINT_LIGHT_CHUNK], count = 0;
    do {
        slots[count] = slot + count;
        count++;
    } while (slot + count < end && lights[slot + count].joined);
    glint_tile_shine(tile, frame, first, slots, count);
    if (frame->plan->runs[GLINT_STAGE_FACET])
        glint_tile_facet(tile, frame, first, slots, count);
    if (lights[slot].shadows)
        glint_tile_occlude(tile, frame, first, slots, count);
    return count;
}

/// What the lights do to the points of the batch.
static void light_batch(glint_tile *tile, const glint_tile_frame *frame, bool any)
{
    const glint_plan *plan = frame->plan;
    const uint32_t lights = any ? plan->light_count : 0;
    uint32_t from = 0;
    for (int k = 0; k < GLINT_TERM_LOCAL; k++)
        for (int c = 0; c < 3; c++)
            memset(tile->sum[k][c], 0, tile->group_count * GLINT_GROUP * sizeof *tile->sum[k][c]);
    if (any && plan->runs[GLINT_STAGE_VIEW])
        glint_tile_view(tile, frame);
    do {
        const uint32_t count = lights - from < GLINT_LIGHT_CHUNK ? lights - from : GLINT_LIGHT_CHUNK;
        for (uint32_t i = 0; i < count;)
            i += shine(tile, frame, from, i, count);
        glint_tile_shade(tile, frame, from, count);
        for (uint32_t i = 0; i < count && plan->tints; i++)
            if (plan->lights[from + i].shadows && glint_tile_is_shadowed(tile, i))
                glint_tile_tint(tile, frame, from + i, i);
        from += count;
    } while (from < lights);
}

/// Adds what the rays found to their pixels.
static void collect(const struct glint_bounce *bounce, glint_tile *to)
{
    const glint_tile *tile = &bounce->tile;
    for (uint32_t i = 0; i < tile->group_count * GLINT_GROUP; i++) {
        if (!has_lane(tile->active, i))
            continue;
        const bounce_ray *ray = &bounce->batch[i];
        for (int c = 0; c < 3; c++) {
            double light = tile->sum[0][c][i];
            for (int k = 1; k < GLINT_TERM_LOCAL; k++)
                light += tile->sum[k][c][i];
            to->sum[ray->term][c][ray->pixel] += ray->weight[c] * light;
        }
    }
}

static void run_batch(struct glint_bounce *bounce, glint_tile *to, const glint_tile_frame *frame, uint32_t level)
{
    glint_tile *tile = &bounce->tile;
    load_batch(bounce, frame->plan->desc.precision, level, &to->counts);
    const bool any = cast_batch(bounce, frame);
    if (any)
        glint_tile_find_surfaces(tile, frame);
    absorb(bounce, frame);
    light_batch(tile, frame, any);
    collect(bounce, to);
    if (any)
        spawn(bounce, tile, frame, level);
}

static void begin(struct glint_bounce *bounce, const glint_tile *to, const glint_tile_frame *frame)
{
    glint_tile *tile = &bounce->tile;
    tile->camera = (glint_camera_args) { .orthographic = true }; // rays in arrays
    tile->tint = to->tint;
    tile->sample = to->sample;
    tile->counts = (glint_tile_counts) { 0 };
    tile->clock = to->clock;
    tile->at = (glint_tile_sample) { .t = tile->t, .prim = tile->prim, .hits = tile->hits };
    for (int i = 0; i < GLINT_LIGHT_CHUNK; i++) {
        glint_tile_light *own = &tile->lights[i];
        tile->at.light[i].cosine = own->cosine;
        tile->at.light[i].attenuation = own->attenuation;
        tile->at.light[i].log2_specular = own->log2_specular;
        tile->at.light[i].lit = own->lit;
        tile->at.light[i].open = own->open;
    }
    if (frame->plan->facets)
        glint_tile_lend_facets(tile, to);
    memset(bounce->counts, 0, sizeof bounce->counts);
    for (int i = 0; i < GLINT_TILE_SAMPLES; i++)
        bounce->budget[i] = GLINT_BOUNCE_LOSS;
}

void glint_tile_bounce(glint_tile *tile, const glint_tile_frame *frame)
{
    struct glint_bounce *bounce = tile->bounce;
    begin(bounce, tile, frame);
    spawn(bounce, tile, frame, 0);
    for (uint32_t level = 1;;) {
        while (level > 0 && bounce->counts[level] == 0)
            level--;
        if (bounce->counts[level] == 0 || glint_tile_cancelled(frame))
            break;
        run_batch(bounce, tile, frame, level);
        if (level + 1 < GLINT_BOUNCE_LEVELS)
            level++;
    }
    tile->counts.shadow += bounce->tile.counts.shadow;
    tile->counts.work.light_samples += bounce->tile.counts.work.light_samples;
    tile->counts.work.powers += bounce->tile.counts.work.powers;
}
