/// Light through transparent objects. Points that a light does not reach freely are tested again. A ray towards the
/// light goes straight through all surfaces that transmit or are translucent, and is tinted by each. Light is not
/// refracted. An absorbing medium absorbs over its whole distance, also if the light or the point is inside of it.
///
/// Only `occlude` decides which points stay dark: a point stays dark if its ray hits nothing that transmits. Rays
/// that certainly miss all transparent objects are not followed (plan.h). The other rays, of all samples of a light,
/// are packed into full groups, as many as fit, and packed again after each surface.
#include "engine/base/alloc.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/render/effects/cut_out/cut_out.h"
#include "engine/render/light_groups/light_groups.h"
#include "engine/render/effects/transparent_shadow/plan.h"
#include "engine/render/frame/renderer.h"
#include "engine/render/paths/event.h"

#include <stdlib.h>
#include <string.h>

#define CROSSINGS_MAX 4096 ///< maximum number of surfaces that one ray crosses; points behind more surfaces are dark

struct glint_transparent_shadow {
    uint16_t dim[GLINT_TILE_GROUPS]; ///< points inside an absorbing medium; first: see glint_tile_dim_lanes
    uint16_t whole[GLINT_LIGHT_CHUNK][GLINT_TILE_GROUPS]; ///< the other points that each light reaches, for shade
    // unfinished rays, packed from the start
    _Alignas(64) double origin[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double direction[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double point[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double normal[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double t[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t prim[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t material[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t leaving[GLINT_TILE_SAMPLES];
    uint16_t hits[GLINT_TILE_GROUPS], back[GLINT_TILE_GROUPS], dark[GLINT_TILE_GROUPS];
    uint16_t active[GLINT_TILE_GROUPS], inward[GLINT_TILE_GROUPS];
    uint16_t holes[GLINT_TILE_GROUPS]; ///< rays that have hit a hole; 0 in frames without holes
    uint16_t ray_of[GLINT_TILE_SAMPLES]; ///< index into the following arrays of each slot's ray
    uint32_t group_count;
    // all rays of a call of `follow`, one row of the light after the other
    double target[3][GLINT_TILE_SAMPLES]; ///< the light's position; directional: the direction
    double color[3][GLINT_TILE_SAMPLES];
    glint_media media[GLINT_TILE_SAMPLES]; ///< in frames with absorption
    uint16_t sample[GLINT_TILE_SAMPLES]; ///< the point at which the ray started
    bool crossed[GLINT_TILE_SAMPLES], arrived[GLINT_TILE_SAMPLES]; ///< the ray has crossed a surface; has reached the
        ///< light after crossing one
    uint32_t count, first[GLINT_LIGHT_CHUNK + 1]; ///< the first ray of each row, and the end
    // of the tile's samples
    _Alignas(64) float attenuation[3][GLINT_TILE_SAMPLES]; ///< the light's attenuation times its colour, for each
        ///< channel
    uint16_t reached[GLINT_TILE_GROUPS];
    uint16_t tinted[GLINT_TILE_GROUPS]; ///< points whose rays to the light are followed
    float *planes; ///< results of the programs of transmission and opacity; NULL: no such program
};

static void *create(const glint_plan *plan)
{
    (void)plan;
    return glint_alloc(1, sizeof(struct glint_transparent_shadow));
}

static struct glint_transparent_shadow *own_of(const glint_tile *tile) { return tile->own[GLINT_STAGE_TRANSPARENT_SHADOW]; }

/// Returns the medium on the viewer's side of the shaded point. The light arrives through the same medium.
static glint_media media_at(const glint_tile *tile, const glint_tile_frame *frame, uint32_t i)
{
    const glint_plan *plan = frame->plan;
    glint_media media = tile->batch ? *glint_batch_media(tile->batch, i) : plan->eye_media;
    if (!plan->bouncing[tile->surface.material[i]].transmits || !glint_has_lane(tile->hit.back, i))
        return media;
    const uint32_t medium = frame->geometry.prims[tile->at.prim[i]].medium;
    if (!glint_media_has(&media, medium))
        glint_media_enter(&media, medium);
    return media;
}

static bool absorbs(const glint_plan *plan, const glint_media *media)
{
    const uint32_t medium = glint_media_top(media);
    const double *a = medium == GLINT_NO_MEDIUM ? NULL : plan->bouncing[medium].absorption;
    return a && (a[0] > 0 || a[1] > 0 || a[2] > 0);
}

/// Returns the lanes of a group that may be inside an absorbing medium: behind surfaces that transmit, or in the
/// viewer's medium.
static unsigned lanes_within(const glint_tile *tile, const glint_plan *plan, uint32_t g)
{
    return tile->batch || absorbs(plan, &plan->eye_media) ? tile->at.hits[g] : tile->at.hits[g] & tile->hit.back[g];
}

/// Finds the points inside an absorbing medium, and returns whether there are any. The points must be known.
static bool find_dim(const glint_tile *tile, const glint_tile_frame *frame)
{
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        own_of(tile)->dim[g] = 0;
        for (unsigned bits = lanes_within(tile, frame->plan, g); bits; bits &= bits - 1) {
            const glint_media media = media_at(tile, frame, g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits));
            own_of(tile)->dim[g] |= (uint16_t)(absorbs(frame->plan, &media) ? bits & -bits : 0);
        }
        any |= own_of(tile)->dim[g];
    }
    return any;
}

/// Returns whether the light in `slot` is hidden or dimmed at any point.
static bool is_kept_off(const glint_tile *tile, const glint_plan *plan, uint32_t slot)
{
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const unsigned whole = tile->at.light[slot].unoccluded[g] & ~(plan->absorbs_transmitted ? own_of(tile)->dim[g] : 0u);
        if (tile->at.light[slot].lit[g] & ~whole)
            return true;
    }
    return false;
}

/// Returns whether one of `count` lights of the plan, from number `first` on, is hidden or dimmed at any point.
static bool is_shadowed(const glint_tile *tile, const glint_plan *plan, uint32_t first, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (plan->lights[first + i].shadows && is_kept_off(tile, plan, i))
            return true;
    return false;
}

// ---- The choice of rays ----

static glint_tint_light light_seen(const glint_tile *tile, const glint_plan_light *light)
{
    const glint_light_sample *light_sample = glint_tile_light_sample_of(tile, light);
    glint_tint_light seen = { .directional = light->directional, .radius = light_sample ? light_sample->radius : 0 };
    vec_copy(seen.position, light_sample ? light_sample->center : light->position);
    return seen;
}

/// Computes a ball around the tile's points. Returns false if it is unknown.
static bool ball_around(const glint_tile *tile, glint_ball *ball)
{
    double half[3];
    if (!tile->at.box)
        return false;
    for (int c = 0; c < 3; c++) {
        half[c] = 0.5 * tile->at.box->upper[c] - 0.5 * tile->at.box->lower[c];
        ball->center[c] = tile->at.box->lower[c] + half[c];
    }
    ball->radius = sqrt(vec_dot(half, half));
    return true;
}

/// Finds the lanes whose shadow rays may hit something transparent. Returns whether there are any.
static bool find_tinted(const glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light,
                        const uint16_t *lanes, uint16_t *tinted)
{
    const glint_tints *tints = frame->own[GLINT_STAGE_TRANSPARENT_SHADOW];
    const glint_tint_light seen = light_seen(tile, light);
    uint16_t chosen[GLINT_TINTS_MAX];
    glint_ball ball;
    unsigned any = 0;
    uint32_t count = tints->count;
    if (!tints->everywhere && ball_around(tile, &ball))
        count = glint_tints_choose(tints, &ball, &seen, chosen);
    else
        for (uint32_t i = 0; i < count; i++)
            chosen[i] = (uint16_t)i;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        double point[3][GLINT_GROUP];
        tinted[g] = tints->everywhere ? lanes[g] : 0;
        if (lanes[g] && count) {
            for (int c = 0; c < 3; c++)
                glint_reals_of(tile->surface.point[c], frame->plan->desc.precision, g, point[c]);
            tinted[g] = glint_tints_lanes(tints, chosen, count, (const double(*)[GLINT_GROUP])point, lanes[g], &seen);
        }
        any |= tinted[g];
    }
    return any;
}

/// Returns whether the light may cross a transparent surface before one of the tile's points, or is dimmed there. The
/// points must be known.
static bool may_be_tinted(const glint_tile *tile, const glint_tile_frame *frame, const glint_plan_light *light)
{
    return (frame->plan->absorbs_transmitted && find_dim(tile, frame)) ||
           (light->shadows && find_tinted(tile, frame, light, tile->at.hits, own_of(tile)->tinted));
}

/// Returns whether a material does not reflect any light from lamps.
static bool is_black(const glint_plan *plan, uint32_t material)
{
    const glint_shade_material *m = &plan->materials[material];
    return !plan->patterns && !plan->derivatives && m->highlight == GLINT_HIGHLIGHT_NONE && vec_max_abs(m->diffuse) == 0;
}

/// Returns the lanes whose rays to the light are followed: from points that reflect light and that are occluded from
/// some row.
static bool choose_points(glint_tile *tile, const glint_tile_frame *frame, uint32_t index, uint32_t slot, uint32_t count)
{
    uint16_t lanes[GLINT_TILE_GROUPS] = { 0 };
    for (uint32_t i = slot; i < slot + count; i++)
        for (uint32_t g = 0; g < tile->group_count; g++)
            lanes[g] |= (uint16_t)(tile->at.light[i].lit[g] & ~tile->at.light[i].unoccluded[g]);
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned bits = lanes[g]; bits; bits &= bits - 1)
            if (is_black(frame->plan, tile->surface.material[g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits)]))
                lanes[g] &= (uint16_t)~(bits & -bits);
    return find_tinted(tile, frame, &frame->plan->lights[index], lanes, own_of(tile)->tinted);
}

/// Return the lanes whose rays to a row of the light are followed, and those whose light arrives directly, at points
/// inside an absorbing medium.
static unsigned followed(const glint_tile *tile, uint32_t slot, uint32_t g)
{
    const unsigned lit = tile->at.light[slot].lit[g];
    return lit & ~(unsigned)tile->at.light[slot].unoccluded[g] & own_of(tile)->tinted[g];
}

static unsigned dimmed(const glint_tile *tile, const glint_plan *plan, uint32_t slot, uint32_t g)
{
    return plan->absorbs_transmitted ? tile->at.light[slot].unoccluded[g] & own_of(tile)->dim[g] : 0;
}

// ---- Rays ----

/// Puts ray `ray` into slot `to`: from point i of `point`, on primitive `prim`.
static void aim(struct glint_transparent_shadow *transparent_shadow, glint_precision precision, bool directional,
                const double (*point)[GLINT_TILE_SAMPLES], uint32_t i, uint32_t prim, bool inward, uint32_t ray,
                uint32_t to)
{
    const uint16_t bit = (uint16_t)(1u << to % GLINT_GROUP);
    uint16_t *inwards = &transparent_shadow->inward[to / GLINT_GROUP];
    for (int c = 0; c < 3; c++) {
        const double from = glint_real_at(point[c], precision, i), target = transparent_shadow->target[c][ray];
        glint_real_put(transparent_shadow->origin[c], precision, to, from);
        glint_real_put(transparent_shadow->direction[c], precision, to, directional ? target : target - from);
    }
    transparent_shadow->leaving[to] = prim;
    *inwards = (uint16_t)(inward ? *inwards | bit : *inwards & ~bit);
    transparent_shadow->ray_of[to] = (uint16_t)ray;
}

/// Returns the share of channel c that a medium transmits over a distance.
static double transmittance_of(const glint_plan *plan, uint32_t medium, int c, double distance)
{
    return glint_plan_transmittance(medium == GLINT_NO_MEDIUM ? 0 : plan->bouncing[medium].absorption[c], distance);
}

static double direction_length(const struct glint_transparent_shadow *transparent_shadow, glint_precision precision,
                               uint32_t i)
{
    double d[3];
    for (int c = 0; c < 3; c++)
        d[c] = glint_real_at(transparent_shadow->direction[c], precision, i);
    return sqrt(vec_dot(d, d));
}

/// Applies the absorption over the rest of the distance to the light, without further surfaces. A directional light
/// is infinitely far away.
static void arrive(struct glint_transparent_shadow *transparent_shadow, const glint_plan *plan,
                   const glint_plan_light *light, uint32_t i)
{
    const uint32_t ray = transparent_shadow->ray_of[i];
    transparent_shadow->arrived[ray] = true;
    if (!plan->absorbs)
        return;
    const uint32_t medium = glint_media_top(&transparent_shadow->media[ray]);
    const double distance =
        light->directional ? HUGE_VAL : direction_length(transparent_shadow, plan->desc.precision, i);
    for (int c = 0; c < 3; c++)
        transparent_shadow->color[c][ray] *= transmittance_of(plan, medium, c, distance);
}

/// Returns the share of light that goes straight on through the surface in slot i.
static double clear_at(const struct glint_transparent_shadow *transparent_shadow, const glint_plan *plan, uint32_t material,
                       uint32_t i)
{
    if (!plan->patterns || !(plan->patterns->of[material].made >> GLINT_FIELD_CLEAR & 1))
        return plan->bouncing[material].clear;
    return (double)glint_plane_of(transparent_shadow->planes, plan, GLINT_FIELD_CLEAR, 0)[i];
}

/// Multiplies the ray in slot i by the colour of one surface, and by the absorption up to it. Returns whether any
/// light is left.
static bool cross(struct glint_transparent_shadow *transparent_shadow, const glint_tile *tile,
                  const glint_tile_frame *frame, uint32_t i)
{
    const glint_plan *plan = frame->plan;
    const uint32_t material = transparent_shadow->material[i], ray = transparent_shadow->ray_of[i],
                   inside = frame->geometry.prims[transparent_shadow->prim[i]].medium;
    const bool back = glint_has_lane(transparent_shadow->back, i), fills = plan->bouncing[material].transmits;
    const double clear = clear_at(transparent_shadow, plan, material, i);
    bool any = false;
    double buffer[3], transmittance[3] = { 1, 1, 1 };
    const double *transmission = glint_color_at(transparent_shadow->planes, plan, GLINT_FIELD_TRANSMISSION, material, i,
                                                plan->bouncing[material].transmission, buffer);
    if (plan->absorbs) {
        const glint_media *media = &transparent_shadow->media[ray];
        const uint32_t medium = fills ? glint_media_before(media, inside, back) : glint_media_top(media);
        const double length = glint_real_at(transparent_shadow->t, plan->desc.precision, i) *
                              direction_length(transparent_shadow, plan->desc.precision, i);
        for (int c = 0; c < 3; c++)
            transmittance[c] = transmittance_of(plan, medium, c, length);
        if (fills)
            glint_media_cross(&transparent_shadow->media[ray], inside, back);
    }
    for (int c = 0; c < 3; c++) {
        const double share = transmission[c] + clear;
        if (plan->derivatives)
            glint_tile_derive_tint(tile, plan, material, ray, c, transparent_shadow->color[c][ray], share,
                                   transmittance[c]);
        transparent_shadow->color[c][ray] *= share * transmittance[c];
        any = any || transparent_shadow->color[c][ray] > 0;
    }
    transparent_shadow->crossed[ray] = true;
    return any;
}

// ---- Following the rays ----

/// Starts a ray at sample i, in slot `to`.
static void begin_ray(struct glint_transparent_shadow *transparent_shadow, const glint_tile *tile,
                      const glint_tile_frame *frame, const glint_plan_light *light, uint32_t i, bool inward,
                      uint32_t to)
{
    const uint32_t ray = transparent_shadow->count++;
    double target[3];
    glint_tile_light_target(tile, frame, light, i, target);
    for (int c = 0; c < 3; c++) {
        transparent_shadow->target[c][ray] = target[c];
        transparent_shadow->color[c][ray] = 1;
    }
    transparent_shadow->sample[ray] = (uint16_t)i;
    transparent_shadow->crossed[ray] = transparent_shadow->arrived[ray] = false;
    if (frame->plan->absorbs)
        transparent_shadow->media[ray] = media_at(tile, frame, i);
    aim(transparent_shadow, frame->plan->desc.precision, light->directional, tile->surface.point, i, tile->at.prim[i],
        inward, ray, to);
}

/// Sets the active lanes. The other lanes of the last group get dummy rays.
static void close_slots(struct glint_transparent_shadow *transparent_shadow, glint_precision precision, uint32_t count)
{
    transparent_shadow->group_count = (count + GLINT_GROUP - 1) / GLINT_GROUP;
    for (uint32_t g = 0; g < transparent_shadow->group_count; g++)
        transparent_shadow->active[g] = 0xffff;
    for (uint32_t i = count; i < transparent_shadow->group_count * GLINT_GROUP; i++) {
        transparent_shadow->active[i / GLINT_GROUP] &= (uint16_t) ~(1u << i % GLINT_GROUP);
        transparent_shadow->leaving[i] = GLINT_MISS;
        for (int c = 0; c < 3; c++) {
            glint_real_put(transparent_shadow->origin[c], precision, i, 0);
            glint_real_put(transparent_shadow->direction[c], precision, i, 1);
        }
    }
}

/// Starts the rays of `count` rows from `slot` on, from groups `from` to `end`.
static void begin(struct glint_transparent_shadow *transparent_shadow, const glint_tile *tile,
                  const glint_tile_frame *frame, uint32_t index, uint32_t slot, uint32_t count, uint32_t from,
                  uint32_t end)
{
    uint32_t slots = 0;
    transparent_shadow->count = 0;
    for (uint32_t row = 0; row < count; row++) {
        const glint_plan_light *light = &frame->plan->lights[index + row];
        transparent_shadow->first[row] = transparent_shadow->count;
        for (uint32_t g = from; g < end; g++) {
            const unsigned dim = dimmed(tile, frame->plan, slot + row, g);
            for (unsigned bits = followed(tile, slot + row, g) | dim; bits; bits &= bits - 1) {
                const unsigned bit = bits & -bits;
                begin_ray(transparent_shadow, tile, frame, light, g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits),
                          !(dim & bit) && (tile->hit.back[g] & bit), slots);
                if (dim & bit)
                    arrive(transparent_shadow, frame->plan, light, slots);
                else
                    slots++;
            }
        }
    }
    transparent_shadow->first[count] = transparent_shadow->count;
    close_slots(transparent_shadow, frame->plan->desc.precision, slots);
}

static void cast(struct glint_transparent_shadow *transparent_shadow, glint_tile *tile, const glint_tile_frame *frame)
{
    const struct glint_geometry_stages *stages = &frame->stages->geometry[frame->plan->desc.precision];
    glint_cast_args rays = { .group_count = transparent_shadow->group_count,
                             .active = transparent_shadow->active,
                             .geometry = &frame->geometry,
                             .stop = frame->cancelled,
                             .leaving = transparent_shadow->leaving,
                             .inward = transparent_shadow->inward,
                             .t = transparent_shadow->t,
                             .prim = transparent_shadow->prim,
                             .hits = transparent_shadow->hits,
                             .tests = glint_tile_tests_of(tile, frame) };
    glint_surface_args surfaces = { .group_count = transparent_shadow->group_count,
                                    .hits = transparent_shadow->hits,
                                    .prim = transparent_shadow->prim,
                                    .prims = frame->geometry.prims,
                                    .mixed = frame->geometry.triangles || frame->geometry.solids,
                                    .scale = frame->geometry.scale,
                                    .solids = frame->geometry.solids,
                                    .corner_normals = frame->geometry.corner_normals,
                                    .t = transparent_shadow->t,
                                    .material = transparent_shadow->material,
                                    .back = transparent_shadow->back,
                                    .dark = transparent_shadow->dark };
    for (int c = 0; c < 3; c++) {
        rays.origin[c] = surfaces.origin[c] = transparent_shadow->origin[c];
        rays.direction[c] = surfaces.direction[c] = transparent_shadow->direction[c];
        surfaces.point[c] = transparent_shadow->point[c];
        surfaces.normal[c] = transparent_shadow->normal[c];
    }
    stages->cast_rays(&rays);
    stages->surface(&surfaces);
}

/// Runs the programs of the surfaces hit: transmission, opacity and holes.
static void find_transmission(struct glint_transparent_shadow *transparent_shadow, glint_tile *tile,
                              const glint_tile_frame *frame)
{
    glint_pattern_points points = { .group_count = transparent_shadow->group_count,
                                    .hits = transparent_shadow->hits,
                                    .back = transparent_shadow->back,
                                    .prim = transparent_shadow->prim,
                                    .material = transparent_shadow->material,
                                    .tile = tile,
                                    .planes = transparent_shadow->planes,
                                    .fields = 1u << GLINT_FIELD_TRANSMISSION | 1u << GLINT_FIELD_CLEAR };
    for (int c = 0; c < 3; c++) {
        points.point[c] = transparent_shadow->point[c];
        points.normal[c] = transparent_shadow->normal[c];
        points.direction[c] = transparent_shadow->direction[c];
    }
    if (transparent_shadow->planes)
        glint_pattern_run(tile->pattern, frame, &points, &tile->counts);
    if (glint_plan_cuts(frame->plan))
        glint_tile_find_holes(tile, frame, &points, transparent_shadow->holes);
}

static bool transmits_light(const glint_plan *plan, uint32_t material)
{
    return plan->bouncing[material].transmits || plan->bouncing[material].clears;
}

/// Advances every ray by one surface, and packs the rays that go on.
static void step(struct glint_transparent_shadow *transparent_shadow, glint_tile *tile, const glint_tile_frame *frame,
                 const glint_plan_light *light)
{
    const glint_precision precision = frame->plan->desc.precision;
    uint32_t next = 0;
    cast(transparent_shadow, tile, frame);
    if (transparent_shadow->planes || glint_plan_cuts(frame->plan))
        find_transmission(transparent_shadow, tile, frame);
    for (uint32_t g = 0; g < transparent_shadow->group_count; g++) {
        tile->counts.shadow += (uint64_t)__builtin_popcount(transparent_shadow->active[g]);
        for (unsigned bits = transparent_shadow->active[g]; bits; bits &= bits - 1) {
            const unsigned bit = bits & -bits;
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(bits), ray = transparent_shadow->ray_of[i];
            if (!(transparent_shadow->hits[g] & bit) ||
                (!light->directional && !(glint_real_at(transparent_shadow->t, precision, i) < 1))) {
                if (transparent_shadow->crossed[ray])
                    arrive(transparent_shadow, frame->plan, light, i);
            } else if ((transparent_shadow->holes[g] & bit) ||
                       (transmits_light(frame->plan, transparent_shadow->material[i]) &&
                        cross(transparent_shadow, tile, frame, i))) {
                aim(transparent_shadow, precision, light->directional,
                    (const double(*)[GLINT_TILE_SAMPLES])transparent_shadow->point, i, transparent_shadow->prim[i],
                    !(transparent_shadow->back[g] & bit), ray, next++);
            }
        }
    }
    close_slots(transparent_shadow, precision, next);
}

// ---- The light of the rays ----

/// Shades with the coloured light: as three lights, one for each channel.
static void shade(struct glint_transparent_shadow *transparent_shadow, glint_tile *tile, const glint_tile_frame *frame,
                  const glint_plan_light *light, uint32_t slot)
{
    glint_shade_light lights[3];
    glint_shade_planes planes;
    glint_shade_args args = { .group_count = tile->group_count,
                              .active = tile->active,
                              .hits = transparent_shadow->reached,
                              .material = tile->surface.material,
                              .materials = frame->plan->materials,
                              .planes = glint_tile_shade_planes(tile, frame->plan, &planes),
                              .facing = tile->at.facing,
                              .highlights = frame->plan->highlights,
                              .lights = lights,
                              .light_count = 3 };
    for (int c = 0; c < 3; c++) {
        lights[c] = (glint_shade_light) { .lit = transparent_shadow->reached,
                                          .cosine = tile->at.light[slot].cosine,
                                          .attenuation = transparent_shadow->attenuation[c],
                                          .log2_specular = tile->at.light[slot].log2_specular,
                                          .sine2 = tile->at.light[slot].sine2,
                                          .schlick = tile->at.light[slot].schlick };
        lights[c].diffuse[c] = light->diffuse[c];
        lights[c].specular[c] = light->specular[c];
        for (int k = 0; k < GLINT_TERM_LOCAL; k++)
            args.sum[k][c] = tile->film.sum[k][c];
    }
    frame->stages->shade(&args);
    glint_groups_shade_one(tile, frame, &args, light->group);
    if (!glint_tile_shows_shader(tile, frame->plan))
        return;
    glint_shader_light reach = { .light = light, .lit = transparent_shadow->reached };
    for (int c = 0; c < 3; c++)
        reach.weight[c] = transparent_shadow->attenuation[c];
    glint_tile_shader(tile, frame, &reach, 1);
}

/// Adds the light of row `row`, in `slot`, along the rays that have arrived.
static void add_row(struct glint_transparent_shadow *transparent_shadow, glint_tile *tile, const glint_tile_frame *frame,
                    const glint_plan_light *light, uint32_t row, uint32_t slot)
{
    bool any = false;
    memset(transparent_shadow->reached, 0, tile->group_count * sizeof *transparent_shadow->reached);
    for (uint32_t ray = transparent_shadow->first[row]; ray < transparent_shadow->first[row + 1]; ray++) {
        const uint32_t i = transparent_shadow->sample[ray];
        if (!transparent_shadow->arrived[ray])
            continue;
        const double a = light->cap          ? tile->at.light[slot].visible[i]
                         : light->attenuated ? tile->at.light[slot].attenuation[i]
                                             : 1;
        for (int c = 0; c < 3; c++)
            transparent_shadow->attenuation[c][i] =
                (float)fmin(a * transparent_shadow->color[c][ray], GLINT_ATTENUATION_MAX);
        transparent_shadow->reached[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
        if (frame->plan->derivatives)
            glint_tile_put_tint(tile, frame->plan, i, ray, (const double(*)[GLINT_TILE_SAMPLES])transparent_shadow->color);
        any = true;
    }
    if (any)
        shade(transparent_shadow, tile, frame, light, slot);
    if (any && frame->plan->derivatives)
        glint_tile_derive_tinted(tile, frame, light, slot, transparent_shadow->reached);
}

/// Follows the rays of groups `from` to `end`, which must fit. Returns false if cancelled.
static bool follow(glint_tile *tile, const glint_tile_frame *frame, uint32_t index, uint32_t slot, uint32_t count,
                   uint32_t from, uint32_t end)
{
    struct glint_transparent_shadow *transparent_shadow = own_of(tile);
    const glint_plan_light *lights = &frame->plan->lights[index];
    begin(transparent_shadow, tile, frame, index, slot, count, from, end);
    if (frame->plan->derivatives)
        glint_tile_begin_tints(tile, frame->plan);
    memset(transparent_shadow->holes, 0, sizeof transparent_shadow->holes);
    for (int k = 0; k < CROSSINGS_MAX && transparent_shadow->group_count; k++) {
        if (glint_tile_cancelled(frame))
            return false;
        step(transparent_shadow, tile, frame, lights);
    }
    for (uint32_t row = 0; row < count; row++)
        add_row(transparent_shadow, tile, frame, &lights[row], row, slot + row);
    return true;
}

/// Returns the number of rays that start at a group's points.
static uint32_t rays_from(const glint_tile *tile, const glint_plan *plan, uint32_t slot, uint32_t count, uint32_t g)
{
    uint32_t rays = 0;
    for (uint32_t i = slot; i < slot + count; i++)
        rays += (uint32_t)__builtin_popcount(followed(tile, i, g) | dimmed(tile, plan, i, g));
    return rays;
}

/// Adds one light, or consecutive samples of one in a chunk.
static void add_light(glint_tile *tile, const glint_tile_frame *frame, uint32_t index, uint32_t slot, uint32_t count)
{
    const glint_plan *plan = frame->plan;
    uint32_t from = 0, rays = 0;
    if (!choose_points(tile, frame, index, slot, count) && !plan->absorbs_transmitted)
        return;
    const int *plane = plan->patterns ? plan->patterns->plane : NULL;
    own_of(tile)->planes = plane && (plane[GLINT_FIELD_TRANSMISSION] >= 0 || plane[GLINT_FIELD_CLEAR] >= 0)
                               ? glint_pattern_planes(tile->pattern, GLINT_WALK_SHADOW)
                               : NULL;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const uint32_t more = rays_from(tile, plan, slot, count, g);
        if (rays + more > GLINT_TILE_SAMPLES) {
            if (!follow(tile, frame, index, slot, count, from, g))
                return;
            from = g;
            rays = 0;
        }
        rays += more;
    }
    if (rays)
        follow(tile, frame, index, slot, count, from, tile->group_count);
}

/// Adds the light of `count` lights of the plan, from number `first` on, at points that they reach through
/// transparent surfaces, or partly. The points must be known.
static void transparent_shadows(glint_tile *tile, const glint_tile_frame *frame, uint32_t first, uint32_t count)
{
    const glint_plan *plan = frame->plan;
    for (uint32_t slot = 0, next; slot < count; slot = next) {
        for (next = slot + 1; next < count && plan->lights[first + next].joined; next++)
            continue;
        bool shadowed = false;
        for (uint32_t i = slot; i < next; i++)
            shadowed = shadowed || is_kept_off(tile, plan, i);
        if (shadowed && plan->lights[first + slot].shadows)
            add_light(tile, frame, first + slot, slot, next - slot);
    }
}

static bool called(const glint_plan *plan) { return plan->tints; }

static glint_key own_key(const glint_plan *plan, glint_key key)
{
    for (uint32_t i = 0; i < plan->material_count; i++)
        key = glint_transmission_key(&plan->bouncing[i], key);
    return key;
}

static glint_status begin_frame(glint_renderer *renderer, glint_tile_frame *frame, glint_error *error)
{
    glint_tints *tints = renderer->own[GLINT_STAGE_TRANSPARENT_SHADOW];
    if (!tints && !(tints = renderer->own[GLINT_STAGE_TRANSPARENT_SHADOW] = malloc(sizeof *tints)))
        return glint_fail_nomem(error);
    glint_tints_find(tints, frame->plan, &frame->geometry);
    return GLINT_OK;
}

static void end(glint_renderer *renderer) { free(renderer->own[GLINT_STAGE_TRANSPARENT_SHADOW]); }

/// Adds the light of a chunk of lights through transparent objects.
static void add(glint_tile *tile, const glint_tile_frame *frame, glint_sample_walk *walk)
{
    if (tile->direct || !is_shadowed(tile, frame->plan, walk->from, walk->count))
        return;
    glint_tile_need_points(tile, frame, walk);
    transparent_shadows(tile, frame, walk->from, walk->count);
}

/// Leaves the points inside an absorbing medium out of the lanes of lights. No light is summed then.
static void mask_dim(glint_tile *tile, const glint_tile_frame *frame, glint_shade_args *args, glint_shade_light *lights,
                     uint32_t from, uint32_t count)
{
    struct glint_transparent_shadow *own = own_of(tile);
    (void)args;
    if (!frame->plan->absorbs_transmitted || count == 0 || !find_dim(tile, frame))
        return;
    for (uint32_t i = 0; i < count; i++) {
        if (!frame->plan->lights[from + i].shadows)
            continue;
        for (uint32_t g = 0; g < tile->group_count; g++)
            own->whole[i][g] = lights[i].lit[g] & (uint16_t)~own->dim[g];
        lights[i].lit = own->whole[i];
    }
}

static bool adds(const glint_tile *tile, const glint_tile_frame *frame, bool any)
{
    return any && (frame->plan->absorbs_transmitted || is_shadowed(tile, frame->plan, 0, frame->plan->light_count));
}

/// Runs as a part of the stages occlude and shade.
const glint_stage glint_stage_transparent_shadow = {
    .calls = "cut_out derivative",
    .called = called,
    .own = own_key,
    .begin = begin_frame,
    .end = end,
    .sums = true,
    .normals = true,
    .remote = true,
    .step[GLINT_AT_SHADED] = add,
    .before_shade = mask_dim,
    .adds = adds,
    .singles = may_be_tinted,
    .create = create,
    .destroy = free,
    .shared = true,
};
