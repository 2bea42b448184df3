// soft: computes which points the samples of an area light reach. Each occluder is first tested against the bounding
// ball of the light, in float, for 16 points at a time. This test needs no rays if the occluder completely hides the
// ball from a point, or hides no part of it. Otherwise the occluder is tested against all samples of a group at once.
// All decisions agree with occlude.h.
#ifndef GLINT_LIGHT_SOFT_H
#define GLINT_LIGHT_SOFT_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/light/cone.h"
#include "engine/render/stages/light/light_sample.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/occlude/grid.h"
#include "engine/render/stages/simd/real.h"

/// The remaining tests of a group.
typedef struct R(soft_group) {
    unsigned near[GLINT_OCCLUDERS]; ///< lanes to test against each occluder of the tile's list
    unsigned any_near; ///< lanes to test against any occluder
    unsigned hidden; ///< lanes from which some occluder completely hides the light
} R(soft_group);

/// The position of the whole light relative to an occluder of the tile's list, in the index's frame.
typedef struct R(soft_occluder) {
    float away; ///< distance from the occluder's centre to the light's centre
    float slack; ///< error bound of a distance
    bool outside; ///< true: the whole light is outside the occluder
    int side; ///< for a plane: 1: the whole light is in front of it; -1: behind it; 0: neither
} R(soft_occluder);

/// The whole light, and data that the groups of one call share in addition to the tile's.
typedef struct R(whole_light) {
    float middle[3], radius; ///< middle and radius of the light's bounding ball
    double scale; ///< scale of the index's frame
    R(soft_occluder) occluders[GLINT_OCCLUDERS];
    R(light_sample_set) light_samples;
    bool cone; ///< true: samples are computed for each group, and are valid for the current group
    bool ready; ///< true: the fields for samples are set
    R(light_sides) sides[GLINT_OCCLUDERS][GLINT_LIGHT_CHUNK];
    unsigned unoccluded[GLINT_LIGHT_CHUNK]; ///< for each sample, the unoccluded lanes of the current group
} R(whole_light);

/// Returns 1 if the light's box, in the index's frame, is in front of the plane, -1 if it is behind, 0 if neither is
/// certain.
static int R(side_of_box)(const R(shadow_tile) * tile, const glint_prim *plane)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    const float *lower = tile->light.lower, *upper = tile->light.upper;
    double height = 0, reach = 0, size = 0;
    for (int k = 0; k < 3; k++) {
        const double middle = 0.5 * ((double)lower[k] + (double)upper[k]), half = (double)upper[k] - middle;
        const double x = middle / geometry->scale + geometry->reference[k];
        height += plane->normal[k] * (x - plane->center[k]);
        reach += fabs(plane->normal[k]) * (half / geometry->scale);
        size += fabs(x) + fabs(plane->center[k]);
    }
    reach += (GLINT_REAL == 64 ? 1e-12 : 1e-5) * size;
    return (height > reach) - (height < -reach);
}

static void R(place_soft_light)(const R(shadow_tile) * tile, R(whole_light) * light)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    const glint_light_sample *light_sample = tile->args->light_sample[0];
    const float loose = 2 * R(walk_slack)(geometry);
    float size = 0;
    for (int k = 0; k < 3; k++) {
        light->middle[k] = (float)((light_sample->center[k] - geometry->reference[k]) * geometry->scale);
        size += largest_of(tile->lower[k], tile->upper[k]) + fabsf(light->middle[k]);
    }
    light->radius = (float)(light_sample->radius * geometry->scale) * 1.00001f + (WALK_SLACK * size + loose);
    light->scale = geometry->scale;
    light->ready = false;
    for (int n = 0; n < tile->count; n++) {
        const glint_prim *prim = &geometry->prims[tile->occluders[n].id];
        R(soft_occluder) *out = &light->occluders[n];
        float away2 = 0, total = size + light->radius;
        *out = (R(soft_occluder)) { .side = 0 };
        if (prim->kind == GLINT_PRIM_PLANE) {
            out->side = R(side_of_box)(tile, prim);
            continue;
        }
        for (int k = 0; k < 3; k++) {
            const float d = light->middle[k] - prim->filter_center[k];
            away2 += d * d;
            total += fabsf(prim->filter_center[k]);
        }
        out->away = sqrtf(away2);
        out->slack = 4 * WALK_SLACK * total + loose;
        out->outside = out->away > prim->filter_bound + (light->radius + out->slack);
    }
}

/// The lanes of a group, classified by the effect of an occluder.
typedef struct R(soft_lanes) {
    unsigned apart; ///< lanes in which the occluder hides no part of the light
    unsigned hidden; ///< lanes in which the occluder completely hides the light
} R(soft_lanes);

static inline R(soft_lanes) R(sort_by_plane)(const R(shadow_tile) * tile, const glint_prim *plane, int side, size_t at)
{
    R(soft_lanes) out = { 0, 0 };
    for (int i = 0; side && i < GLINT_GROUP; i += VR) {
        vr p[3], f[3];
        R(load3)(tile->args->point, at + (size_t)i, p);
        R(offset)(p, plane, f);
        const vr h = R(point_constant)(f, plane);
        out.hidden |= rm_bits(side > 0 ? r_lt(h, r_set(0)) : r_lt(r_set(0), h)) << i;
    }
    out.apart = side ? 0xffff & ~out.hidden : 0;
    return out;
}

/// Classifies an occluder by its bounding ball. The ball is apart from the cone from the point around the light if a
/// plane that touches the ball has both the point and the light on the other side. Three planes are tried: along the
/// side of the cone, perpendicular to the direction at the point, and perpendicular to it at the light. A sphere
/// completely hides the light if it contains the cone's full width at some depth.
static inline R(soft_lanes) R(sort_by_ball)(const R(whole_light) * light, const R(soft_occluder) * occluder,
                                            const glint_prim *prim, const float local[3][GLINT_GROUP])
{
    R(soft_lanes) out = { 0, 0 };
    const vf radius = f_set(light->radius), bound = f_set(prim->filter_bound), slack = f_set(occluder->slack);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf to_light[3], e[3], off[3]; // vectors from the point to the light, from the point to the occluder, and the
            // perpendicular between the two
        for (int k = 0; k < 3; k++) {
            const vf x = f_load(local[k] + i);
            to_light[k] = f_set(light->middle[k]) - x;
            e[k] = f_set(prim->filter_center[k]) - x;
        }
        const vf length2 = DOT(to_light, to_light), ee = DOT(e, e), along = DOT(e, to_light),
                 inverse = f_set(1) / length2;
        const vf share = along * inverse, one = f_set(1);
        // close to the occluder, and where squares overflow or underflow, nothing is decided
        const fm fit =
            fm_and(f_lt(f_max(f_set(4) * (radius * radius), f_set(0x1p-80f)), length2), f_lt(length2, f_set(0x1p80f)));
        for (int k = 0; k < 3; k++)
            off[k] = e[k] - share * to_light[k];
        const vf beside2 = DOT(off, off) * (one - (radius * radius) * inverse);
        const vf loose = slack * (one + ee * inverse), reach = bound + share * radius;
        fm apart = fm_and(fit, f_lt(reach + f_set(2) * loose, f_sqrt(beside2)));
        if (fm_bits(apart) == (1u << VF) - 1) {
            out.apart |= fm_bits(apart) << i;
            continue;
        }
        const vf far = f_sqrt(ee), length = f_sqrt(length2), before = ee - along;
        const vf doubt = slack * ((far + length) + f_set(occluder->away));
        const fm behind = fm_and(f_lt(bound + slack, far), f_lt((radius + bound) * far + doubt, before));
        apart = fm_or(apart, fm_and(fit, behind));
        if (occluder->outside)
            apart = fm_or(apart, fm_and(fit, f_lt(bound * f_set(occluder->away) + doubt, before)));
        out.apart |= fm_bits(apart) << i;
        if (prim->kind != GLINT_PRIM_SPHERE || !occluder->outside)
            continue;
        const vf part = f_min(f_max(share, f_set(0)), one);
        for (int k = 0; k < 3; k++)
            off[k] = e[k] - part * to_light[k];
        const vf widest = f_sqrt(DOT(off, off)) + (part * radius + slack);
        const vf within = f_set((float)(prim->radius * light->scale) * 0.99999f);
        out.hidden |= fm_bits(fm_and(fit, f_lt(widest, within))) << i;
    }
    return out;
}

/// Classifies the tile's occluders for the lanes of a group.
static R(soft_group)
    R(sort_group)(const R(shadow_tile) * tile, const R(whole_light) * light, R(shadow_group) * group, unsigned lanes)
{
    const glint_occlude_args *args = tile->args;
    const unsigned back = args->back[group->at / GLINT_GROUP];
    R(soft_group) out;
    out.any_near = out.hidden = 0;
    for (int k = 0; k < tile->count; k++) {
        const uint32_t id = tile->occluders[k].id;
        const glint_prim *prim = &args->geometry->prims[id];
        const unsigned own = lanes_equal(args->prim + group->at, id) & lanes;
        unsigned near = own; // points on the primitive must be seen from behind, except on triangles and tori
        if (prim->kind == GLINT_PRIM_PLANE)
            near = 0;
        else if (prim->kind != GLINT_PRIM_TRIANGLE && !is_torus(args->geometry, prim))
            near &= back;
        const unsigned others = lanes & ~(own | out.hidden);
        if (others) {
            R(soft_lanes) sorted;
            if (prim->kind == GLINT_PRIM_PLANE) {
                sorted = R(sort_by_plane)(tile, prim, light->occluders[k].side, group->at);
            } else {
                R(place_group)(tile, group);
                sorted = R(sort_by_ball)(light, &light->occluders[k], prim, (const float(*)[GLINT_GROUP])group->local);
            }
            out.hidden |= sorted.hidden & others;
            near |= others & ~(sorted.apart | sorted.hidden);
        }
        out.near[k] = near;
        out.any_near |= near;
    }
    out.any_near &= ~out.hidden;
    return out;
}

/// Prepares the data for samples when the first group needs them: once per call, or per group if samples are computed
/// for each group.
static void R(prepare_samples)(const R(shadow_tile) * tile, R(whole_light) * light)
{
    const glint_occlude_args *args = tile->args;
    for (uint32_t s = 0; s < args->sample_count; s++)
        for (int k = 0; k < tile->count; k++) {
            light->sides[k][s] = (R(light_sides)) { 0xffff, 0 };
            if (!light->occluders[k].outside)
                light->sides[k][s] = R(sides_of)(args, light->light_samples.light_sample[s].exact_position,
                                                 &args->geometry->prims[tile->occluders[k].id]);
        }
    light->ready = !light->cone;
}

/// Loads the samples of a call.
static void R(load_samples)(const glint_light_sample *const light_sample[], uint32_t count, R(whole_light) * light)
{
    R(load_light_samples)(light_sample, count, &light->light_samples);
    light->cone = R(is_cone)(light_sample[0]);
}

/// Removes from every sample's unoccluded lanes the lanes of `near` that the tile's occluder k blocks.
static inline void R(block_samples)(const R(shadow_tile) * tile, int k, unsigned near, size_t at,
                                    R(whole_light) * light)
{
    const glint_occlude_args *args = tile->args;
    const uint32_t id = tile->occluders[k].id;
    const glint_prim *prim = &args->geometry->prims[id];
    const bool sphere = prim->kind == GLINT_PRIM_SPHERE;
    const unsigned all = (1u << VR) - 1, own = lanes_equal(args->prim + at, id) & near;
    const unsigned back = sphere ? args->back[at / GLINT_GROUP] & own : 0, others = near & ~own;
    if (!sphere && prim->kind != GLINT_PRIM_PLANE) {
        const unsigned wanted =
            prim->kind == GLINT_PRIM_COMBINED ? R(stay_in_combined)(args, prim, at, near) : near;
        for (uint32_t s = 0; s < args->sample_count; s++)
            light->unoccluded[s] &=
                ~R(decide_blocked)(args, prim, light->light_samples.light_sample[s].position, at, light->sides[k][s],
                                   own & light->unoccluded[s], wanted & light->unoccluded[s]);
        return;
    }
    for (uint32_t s = 0; back && s < args->sample_count; s++)
        light->unoccluded[s] &= ~(back & light->sides[k][s].outside);
    const R(ball) ball = R(ball_of)(prim);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        vr p[3], d[3], f[3];
        if (!(others >> i & all))
            continue;
        R(load3)(args->point, at + (size_t)i, p);
        R(offset)(p, prim, f);
        const vr c = R(point_constant)(f, prim);
        for (uint32_t s = 0; s < args->sample_count; s++) {
            const unsigned lanes = light->unoccluded[s] & others;
            const R(light_sides) sides = light->sides[k][s];
            const unsigned outside = sides.outside >> i & all, inside = sides.inside >> i & all;
            if (!(lanes >> i & all))
                continue;
            count_tests(args->tests, lanes >> i & all);
            R(directions_to)(args, light->light_samples.light_sample[s].position, at, i, d);
            const rm hit =
                sphere ? R(sphere_blocks)(args, &ball, outside, inside, f, c, d) : R(plane_blocks)(outside, inside, c);
            light->unoccluded[s] &= ~((rm_bits(hit) & lanes >> i & all) << i);
        }
    }
}

/// Removes the blocked lanes from the unoccluded lanes of every sample, for a sorted group.
static void R(block_group)(const R(shadow_tile) * tile, const R(soft_group) * sorted, size_t at, R(whole_light) * light)
{
    if (!light->ready)
        R(prepare_samples)(tile, light);
    for (int k = 0; k < tile->count; k++)
        if (sorted->near[k] & sorted->any_near)
            R(block_samples)(tile, k, sorted->near[k] & sorted->any_near, at, light);
}

static void R(occlude_listed)(const R(shadow_tile) * tile, const uint16_t *lit)
{
    const glint_occlude_args *args = tile->args;
    R(shadow_group) group = { .last_blocker = GLINT_MISS };
    R(whole_light) light;
    R(place_soft_light)(tile, &light);
    R(load_samples)(args->light_sample, args->sample_count, &light);
    for (uint32_t g = 0; g < args->group_count; g++) {
        R(soft_group) sorted;
        sorted.any_near = sorted.hidden = 0;
        if (lit[g] && tile->count) {
            R(begin_group)(g, &group);
            sorted = R(sort_group)(tile, &light, &group, lit[g]);
        }
        for (uint32_t s = 0; s < args->sample_count; s++) {
            light.unoccluded[s] = args->lit[s][g] & ~sorted.hidden;
            *args->rays += (unsigned)__builtin_popcount(light.unoccluded[s] & sorted.any_near);
        }
        if (sorted.any_near && light.cone)
            R(place_in_cone)
        (args->light_sample, args->sample_count, args->scale, args->point, args->normal, group.at,
         &light.light_samples);
        if (sorted.any_near)
            R(block_group)(tile, &sorted, group.at, &light);
        for (uint32_t s = 0; s < args->sample_count; s++)
            args->unoccluded[s][g] = (uint16_t)light.unoccluded[s];
    }
}

#endif
