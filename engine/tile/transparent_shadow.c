/// Light through transparent objects. Points that a light does not reach freely are tested again: a ray towards the light
/// is followed straight through whatever transmits, and takes its colour at each surface. No light is bent. What
/// absorbs takes its part of the whole distance: where the light stands in it, or the point, or both.
///
/// What parts a point from a light for good is decided by `occlude` alone: where the ray meets nothing that transmits, the
/// point stays dark.
#include "engine/base/alloc.h"
#include "engine/base/vec.h"
#include "engine/tile/batch.h"
#include "engine/tile/cut_out.h"

#include <stdlib.h>
#include <string.h>

#define CROSSINGS_MAX 4096 ///< surfaces that one ray crosses; a point behind more is dark

struct glint_transparent_shadow {
    _Alignas(64) double origin[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double direction[3][GLINT_TILE_SAMPLES];
    _Alignas(
        64) double target[3][GLINT_TILE_SAMPLES]; ///< of each ray: the light's position; directional: the direction
    _Alignas(64) double point[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double normal[3][GLINT_TILE_SAMPLES];
    _Alignas(64) double t[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t prim[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t material[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t leaving[GLINT_TILE_SAMPLES];
    _Alignas(64) float attenuation[3][GLINT_TILE_SAMPLES]; ///< the light's, times the colour, for each channel
    uint16_t hits[GLINT_TILE_GROUPS], back[GLINT_TILE_GROUPS], dark[GLINT_TILE_GROUPS];
    uint16_t active[GLINT_TILE_GROUPS]; ///< rays not ended yet
    uint16_t inward[GLINT_TILE_GROUPS];
    uint16_t holes[GLINT_TILE_GROUPS]; ///< rays that have come to one; 0 in frames without
    uint16_t arrived[GLINT_TILE_GROUPS]; ///< through something
    uint16_t dim[GLINT_TILE_GROUPS]; ///< points inside what absorbs
    double color[3][GLINT_TILE_SAMPLES];
    glint_media media[GLINT_TILE_SAMPLES];
    float *planes; ///< of what programs give; NULL: the plan has none for transmission
    bool crossed[GLINT_TILE_SAMPLES];
};

struct glint_transparent_shadow *glint_transparent_shadow_create(void)
{
    return glint_alloc(1, sizeof(struct glint_transparent_shadow));
}

void glint_transparent_shadow_destroy(struct glint_transparent_shadow *transparent_shadow) { free(transparent_shadow); }

/// What is around a sample's point, on the side of the viewer, to which the light comes as well.
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

void glint_tile_find_dim(const glint_tile *tile, const glint_tile_frame *frame)
{
    for (uint32_t g = 0; g < tile->group_count; g++) {
        tile->transparent_shadow->dim[g] = 0;
        for (unsigned left = tile->at.hits[g]; left; left &= left - 1) {
            const glint_media media = media_at(tile, frame, g * GLINT_GROUP + (uint32_t)__builtin_ctz(left));
            tile->transparent_shadow->dim[g] |= (uint16_t)(absorbs(frame->plan, &media) ? left & -left : 0);
        }
    }
}

uint16_t glint_tile_dim_lanes(const glint_tile *tile, uint32_t g) { return tile->transparent_shadow->dim[g]; }

bool glint_tile_is_shadowed(const glint_tile *tile, const glint_plan *plan, uint32_t slot)
{
    for (uint32_t g = 0; g < tile->group_count; g++) {
        const unsigned whole = tile->at.light[slot].open[g] & ~(plan->dims ? tile->transparent_shadow->dim[g] : 0u);
        if (tile->at.light[slot].lit[g] & ~whole)
            return true;
    }
    return false;
}

/// Finds where sample i's ray goes to, from its first point.
static void find_target(struct glint_transparent_shadow *transparent_shadow, const glint_tile *tile,
                        const glint_tile_frame *frame, const glint_plan_light *light, uint32_t i)
{
    double target[3];
    glint_tile_light_target(tile, frame, light, i, target);
    for (int c = 0; c < 3; c++)
        transparent_shadow->target[c][i] = target[c];
}

/// Starts sample i's ray at a point of primitive `prim`.
static void aim(struct glint_transparent_shadow *transparent_shadow, const glint_tile_frame *frame,
                const glint_plan_light *light, const double (*point)[GLINT_TILE_SAMPLES], uint32_t i, uint32_t prim,
                bool inward)
{
    const glint_precision precision = frame->plan->desc.precision;
    const uint16_t bit = (uint16_t)(1u << i % GLINT_GROUP);
    uint16_t *inwards = &transparent_shadow->inward[i / GLINT_GROUP];
    for (int c = 0; c < 3; c++) {
        const double from = glint_real_at(point[c], precision, i), to = transparent_shadow->target[c][i];
        glint_real_put(transparent_shadow->origin[c], precision, i, from);
        glint_real_put(transparent_shadow->direction[c], precision, i, light->directional ? to : to - from);
    }
    transparent_shadow->leaving[i] = prim;
    *inwards = (uint16_t)(inward ? *inwards | bit : *inwards & ~bit);
}

static void begin(struct glint_transparent_shadow *transparent_shadow, const glint_tile *tile,
                  const glint_tile_frame *frame, const glint_plan_light *light, uint32_t slot)
{
    for (uint32_t g = 0; g < tile->group_count; g++) {
        transparent_shadow->active[g] = (uint16_t)(tile->at.light[slot].lit[g] & ~tile->at.light[slot].open[g]);
        transparent_shadow->arrived[g] = transparent_shadow->inward[g] = 0;
        for (uint32_t i = g * GLINT_GROUP; i < (g + 1) * GLINT_GROUP; i++) {
            transparent_shadow->leaving[i] = GLINT_MISS;
            for (int c = 0; c < 3; c++) {
                glint_real_put(transparent_shadow->origin[c], frame->plan->desc.precision, i, 0);
                glint_real_put(transparent_shadow->direction[c], frame->plan->desc.precision, i, 1);
                transparent_shadow->color[c][i] = 1;
                transparent_shadow->attenuation[c][i] = 0;
            }
            transparent_shadow->crossed[i] = false;
        }
        for (unsigned left = transparent_shadow->active[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            transparent_shadow->media[i] = media_at(tile, frame, i);
            find_target(transparent_shadow, tile, frame, light, i);
            aim(transparent_shadow, frame, light, tile->surface.point, i, tile->at.prim[i],
                tile->hit.back[g] & left & -left);
        }
    }
}

/// What a medium leaves of channel c over a distance.
static double left_of(const glint_plan *plan, uint32_t medium, int c, double way)
{
    return glint_plan_left(medium == GLINT_NO_MEDIUM ? 0 : plan->bouncing[medium].absorption[c], way);
}

/// The rest of the distance to the light, on which there is nothing more; directional light has none that ends.
static void arrive(struct glint_transparent_shadow *transparent_shadow, const glint_tile_frame *frame,
                   const glint_plan_light *light, uint32_t i)
{
    const uint32_t medium = glint_media_top(&transparent_shadow->media[i]);
    double d[3];
    for (int c = 0; c < 3; c++)
        d[c] = glint_real_at(transparent_shadow->direction[c], frame->plan->desc.precision, i);
    const double way = light->directional ? HUGE_VAL : sqrt(vec_dot(d, d));
    for (int c = 0; c < 3; c++)
        transparent_shadow->color[c][i] *= left_of(frame->plan, medium, c, way);
    transparent_shadow->arrived[i / GLINT_GROUP] |= (uint16_t)(1u << i % GLINT_GROUP);
}

/// Points that the light reaches freely, inside what absorbs.
static void dim(struct glint_transparent_shadow *transparent_shadow, const glint_tile *tile,
                const glint_tile_frame *frame, const glint_plan_light *light, uint32_t slot)
{
    for (uint32_t g = 0; g < tile->group_count; g++)
        for (unsigned left = tile->at.light[slot].open[g] & transparent_shadow->dim[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            transparent_shadow->media[i] = media_at(tile, frame, i);
            find_target(transparent_shadow, tile, frame, light, i);
            aim(transparent_shadow, frame, light, tile->surface.point, i, tile->at.prim[i], false);
            arrive(transparent_shadow, frame, light, i);
        }
}

static void cast(struct glint_transparent_shadow *transparent_shadow, glint_tile *tile, const glint_tile_frame *frame)
{
    const struct glint_geometry_stages *stages = &frame->stages->geometry[frame->plan->desc.precision];
    glint_cast_args rays = { .group_count = tile->group_count,
                             .active = transparent_shadow->active,
                             .geometry = &frame->geometry,
                             .stop = frame->cancelled,
                             .leaving = transparent_shadow->leaving,
                             .inward = transparent_shadow->inward,
                             .t = transparent_shadow->t,
                             .prim = transparent_shadow->prim,
                             .hits = transparent_shadow->hits,
                             .tests = glint_tile_tests_of(tile, frame) };
    glint_surface_args surfaces = { .group_count = tile->group_count,
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

/// What programs give of the surfaces that are met: their transmission, and where they have holes.
static void find_transmission(struct glint_transparent_shadow *transparent_shadow, glint_tile *tile,
                              const glint_tile_frame *frame)
{
    glint_pattern_points points = { .group_count = tile->group_count,
                                    .hits = transparent_shadow->hits,
                                    .back = transparent_shadow->back,
                                    .prim = transparent_shadow->prim,
                                    .material = transparent_shadow->material,
                                    .tile = tile,
                                    .planes = transparent_shadow->planes,
                                    .fields = 1u << GLINT_FIELD_TRANSMISSION };
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

/// Takes the colour of one surface, and of the distance up to it. Returns whether any light is left.
static bool cross(struct glint_transparent_shadow *transparent_shadow, const glint_tile_frame *frame, uint32_t i,
                  double length)
{
    const glint_plan *plan = frame->plan;
    const uint32_t material = transparent_shadow->material[i],
                   inside = frame->geometry.prims[transparent_shadow->prim[i]].medium;
    const bool back = transparent_shadow->back[i / GLINT_GROUP] >> i % GLINT_GROUP & 1;
    const uint32_t medium = glint_media_before(&transparent_shadow->media[i], inside, back);
    bool any = false;
    double room[3];
    const double *transmission = glint_color_at(transparent_shadow->planes, plan, GLINT_FIELD_TRANSMISSION, material, i,
                                                plan->bouncing[material].transmission, room);
    for (int c = 0; c < 3; c++) {
        transparent_shadow->color[c][i] *= transmission[c] * left_of(plan, medium, c, length);
        any = any || transparent_shadow->color[c][i] > 0;
    }
    glint_media_cross(&transparent_shadow->media[i], inside, back);
    transparent_shadow->crossed[i] = true;
    return any;
}

static double length_of(const struct glint_transparent_shadow *transparent_shadow, glint_precision precision,
                        uint32_t i)
{
    double d[3];
    for (int c = 0; c < 3; c++)
        d[c] = glint_real_at(transparent_shadow->direction[c], precision, i);
    return glint_real_at(transparent_shadow->t, precision, i) * sqrt(vec_dot(d, d));
}

/// One surface further with every ray. Returns whether any goes on.
static bool step(struct glint_transparent_shadow *transparent_shadow, glint_tile *tile, const glint_tile_frame *frame,
                 const glint_plan_light *light)
{
    const glint_precision precision = frame->plan->desc.precision;
    unsigned any = 0;
    cast(transparent_shadow, tile, frame);
    if (transparent_shadow->planes || glint_plan_cuts(frame->plan))
        find_transmission(transparent_shadow, tile, frame);
    for (uint32_t g = 0; g < tile->group_count; g++) {
        unsigned on = 0;
        for (unsigned left = transparent_shadow->active[g]; left; left &= left - 1) {
            const unsigned bit = left & -left;
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            tile->counts.shadow++;
            if (!(transparent_shadow->hits[g] & bit) ||
                (!light->directional && !(glint_real_at(transparent_shadow->t, precision, i) < 1))) {
                if (transparent_shadow->crossed[i])
                    arrive(transparent_shadow, frame, light, i);
            } else if ((transparent_shadow->holes[g] & bit) ||
                       (frame->plan->bouncing[transparent_shadow->material[i]].transmits &&
                        cross(transparent_shadow, frame, i, length_of(transparent_shadow, precision, i)))) {
                aim(transparent_shadow, frame, light, (const double(*)[GLINT_TILE_SAMPLES])transparent_shadow->point, i,
                    transparent_shadow->prim[i], !(transparent_shadow->back[g] & bit));
                on |= bit;
            }
        }
        transparent_shadow->active[g] = (uint16_t)on;
        any |= on;
    }
    return any;
}

/// Shades with the coloured light: as three lights, one for each channel.
static void shade(struct glint_transparent_shadow *transparent_shadow, glint_tile *tile, const glint_tile_frame *frame,
                  const glint_plan_light *light, uint32_t slot)
{
    glint_shade_light lights[3];
    glint_shade_planes planes;
    glint_shade_args args = { .group_count = tile->group_count,
                              .active = tile->active,
                              .hits = tile->at.hits,
                              .material = tile->surface.material,
                              .materials = frame->plan->materials,
                              .planes = glint_tile_shade_planes(tile, frame->plan, &planes),
                              .facing = tile->at.facing,
                              .highlights = frame->plan->highlights,
                              .lights = lights,
                              .light_count = 3 };
    for (int c = 0; c < 3; c++) {
        lights[c] = (glint_shade_light) { .lit = transparent_shadow->arrived,
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
    if (!glint_tile_shows_shader(tile, frame->plan))
        return;
    glint_shader_light reach = { .lit = transparent_shadow->arrived };
    for (int c = 0; c < 3; c++)
        reach.weight[c] = transparent_shadow->attenuation[c];
    glint_tile_shader(tile, frame, light, &reach);
}

void glint_tile_transparent_shadow(glint_tile *tile, const glint_tile_frame *frame, uint32_t index, uint32_t slot)
{
    struct glint_transparent_shadow *transparent_shadow = tile->transparent_shadow;
    const glint_plan_light *light = &frame->plan->lights[index];
    begin(transparent_shadow, tile, frame, light, slot);
    memset(transparent_shadow->holes, 0, sizeof transparent_shadow->holes);
    transparent_shadow->planes = frame->plan->patterns && frame->plan->patterns->plane[GLINT_FIELD_TRANSMISSION] >= 0
                                     ? glint_pattern_planes(tile->pattern, GLINT_WALK_SHADOW)
                                     : NULL;
    for (int k = 0; k < CROSSINGS_MAX && step(transparent_shadow, tile, frame, light); k++)
        if (glint_tile_cancelled(frame))
            return;
    if (frame->plan->dims)
        dim(transparent_shadow, tile, frame, light, slot);
    unsigned any = 0;
    for (uint32_t g = 0; g < tile->group_count; g++) {
        any |= transparent_shadow->arrived[g];
        for (unsigned left = transparent_shadow->arrived[g]; left; left &= left - 1) {
            const uint32_t i = g * GLINT_GROUP + (uint32_t)__builtin_ctz(left);
            const double a = light->cap          ? tile->at.light[slot].visible[i]
                             : light->attenuated ? tile->at.light[slot].attenuation[i]
                                                 : 1;
            for (int c = 0; c < 3; c++)
                transparent_shadow->attenuation[c][i] =
                    (float)fmin(a * transparent_shadow->color[c][i], GLINT_ATTENUATION_MAX);
        }
    }
    if (any)
        shade(transparent_shadow, tile, frame, light, slot);
}
