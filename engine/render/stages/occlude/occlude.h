// occlude: which points a light reaches. Contract: stages.h.
//
// A shaft around all segments of the tile lists the occluders. If there are too many, the segments traverse the index
// as a beam (through_beam.h) or, if they cannot form a beam, one by one.
#ifndef GLINT_OCCLUDE_OCCLUDE_H
#define GLINT_OCCLUDE_OCCLUDE_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/simd/real.h"
#include "engine/render/stages/surface/surface.h"

/// Adds an occluder to the tile's list. Returns false if the list is full.
static inline bool R(note_occluder)(R(shadow_tile) * tile, uint32_t id)
{
    const glint_occlude_args *args = tile->args;
    const bool few = GLINT_REAL == 32 || args->light_sample[0] || args->geometry->prims[id].kind == GLINT_PRIM_TRIANGLE;
    const int most = few ? GLINT_OCCLUDERS_FEW : GLINT_OCCLUDERS;
    if (tile->count >= most) {
        tile->count = GLINT_OCCLUDERS + 1;
        return false;
    }
    tile->occluders[tile->count].id = id;
    if (!args->light_sample[0]) // for an area light, the sides are computed for each sample
        tile->occluders[tile->count].sides = R(sides_of)(args, NULL, &args->geometry->prims[id]);
    tile->count++;
    return true;
}

/// Lists the tile's occluders. only: the primitive that all points are on, if known. A ball does not shadow its
/// visible outside, and a plane does not shadow itself.
static void R(find_occluders)(R(shadow_tile) * tile, uint32_t only)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    const glint_node *node;
    shaft_walk walk;
    unsigned prims;
    for (uint32_t i = 0; i < geometry->unbounded_count; i++)
        if (geometry->unbounded[i] != only && !R(note_occluder)(tile, geometry->unbounded[i]))
            return;
    tile->unbounded = tile->count;
    begin_shaft_walk(&walk, geometry->nodes, tile->lower, tile->upper, &tile->light);
    while ((node = next_in_shaft(&walk, &prims)))
        for (; prims; prims &= prims - 1) {
            const uint32_t id = node->child[__builtin_ctz(prims)] & ~GLINT_NODE_PRIM;
            if (id != only && !R(note_occluder)(tile, id))
                return;
        }
}

/// Returns whether the filter's data show that the whole light is certainly outside the sphere or solid.
static inline bool R(light_outside)(const R(shadow_tile) * tile, const glint_prim *prim)
{
    const bool ball = prim->kind == GLINT_PRIM_SPHERE || prim->kind == GLINT_PRIM_SOLID;
    float distance2 = 0, size = 0;
    if (!ball || tile->args->directional)
        return ball;
    for (int k = 0; k < 3; k++) {
        const float lower = tile->light.lower[k], upper = tile->light.upper[k], center = prim->filter_center[k];
        const float d = larger(larger(lower - center, center - upper), 0);
        distance2 += d * d;
        size += largest_of(lower, upper);
    }
    const float reach = prim->filter_bound + WALK_SLACK * size;
    return distance2 > reach * reach * (1 + 1e-5f);
}

/// Computes the same as sides_of, faster if the light is far from the primitive.
static inline R(light_sides)
    R(seen_sides)(const R(shadow_tile) * tile, const double (*target)[GLINT_GROUP], const glint_prim *prim)
{
    if (R(light_outside)(tile, prim))
        return (R(light_sides)) { 0xffff, 0 };
    return R(sides_of)(tile->args, target, prim);
}

/// Tests a primitive found by traversal. Returns the lanes that are still unoccluded.
static inline unsigned R(test_occluder)(const R(shadow_tile) * tile, const double (*target)[GLINT_GROUP],
                                        R(shadow_group) * group, uint32_t id, unsigned unoccluded)
{
    const glint_prim *prim = &tile->args->geometry->prims[id];
    const R(occluder) occluder = { id, R(seen_sides)(tile, target, prim) };
    const unsigned blocked = R(blocked_by)(tile, occluder, group, unoccluded);
    if (blocked)
        group->last_blocker = id;
    return unoccluded & ~blocked;
}

/// Traverses the index with the segment of one lane. The primitives that the traversal reaches are tested against all
/// unoccluded lanes.
static unsigned R(walk_lane)(const R(shadow_tile) * tile, const double (*target)[GLINT_GROUP], R(shadow_group) * group,
                             int lane, unsigned unoccluded)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    const float far = tile->args->directional ? HUGE_VALF : 1;
    const glint_node *node;
    ray_walk walk;
    unsigned prims;
    walk.ray.slack = R(walk_slack)(geometry);
    for (int k = 0; k < 3; k++) {
        const float origin = group->local[k][lane], light = tile->local_light[k][lane];
        walk.ray.origin[k] = origin;
        walk.ray.inverse[k] = 1 / (tile->args->directional ? light : light - origin);
        // accounts for the light's rounding error by enlarging the boxes
        walk.ray.slack = larger(walk.ray.slack, WALK_SLACK * fabsf(light));
    }
    begin_ray_walk(&walk, geometry->nodes);
    while (unoccluded >> lane & 1 && (node = next_on_ray(&walk, far, &prims)))
        for (; prims && unoccluded >> lane & 1; prims &= prims - 1)
            unoccluded = R(test_occluder)(tile, target, group, node->child[__builtin_ctz(prims)] & ~GLINT_NODE_PRIM,
                                          unoccluded);
    return unoccluded;
}

/// Returns the lanes of `unoccluded` that no unbounded surface blocks.
static inline unsigned R(test_unbounded)(const R(shadow_tile) * tile, const double (*target)[GLINT_GROUP],
                                         R(shadow_group) * group, unsigned unoccluded)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    for (uint32_t i = 0; i < geometry->unbounded_count && unoccluded; i++)
        unoccluded = R(test_occluder)(tile, target, group, geometry->unbounded[i], unoccluded);
    return unoccluded;
}

/// Returns the lanes of `unoccluded` that nothing in the index blocks, for a group that is traversed separately.
static unsigned R(walk_group)(const R(shadow_tile) * tile, const double (*target)[GLINT_GROUP], R(shadow_group) * group,
                              unsigned unoccluded)
{
    R(place_group)(tile, group);
    if (group->last_blocker != GLINT_MISS) // a primitive that blocked the last group often blocks this one, too
        unoccluded = R(test_occluder)(tile, target, group, group->last_blocker, unoccluded);
    unsigned bits = tile->args->geometry->nodes ? unoccluded : 0;
    for (; bits && !is_stopped(tile->args->stop); bits &= (bits - 1) & unoccluded)
        unoccluded = R(walk_lane)(tile, target, group, __builtin_ctz(bits), unoccluded);
    return unoccluded;
}

static void R(place_light)(R(shadow_tile) * tile)
{
    const glint_occlude_args *args = tile->args;
    const glint_geometry_table *geometry = args->geometry;
    const double *lower = args->light_sample[0] ? args->light_sample[0]->lower : args->position;
    const double *upper = args->light_sample[0] ? args->light_sample[0]->upper : args->position;
    tile->light.directional = args->directional;
    for (int k = 0; k < 3; k++)
        if (args->directional) {
            tile->light.lower[k] = tile->light.upper[k] = (float)args->position[k];
        } else {
            tile->light.lower[k] = (float)((lower[k] - geometry->reference[k]) * geometry->scale);
            tile->light.upper[k] = (float)((upper[k] - geometry->reference[k]) * geometry->scale);
        }
    if (args->light_sample[0])
        loosen(tile->light.lower, tile->light.upper, R(walk_slack)(geometry));
}

/// Computes the box of the lit points, in world space.
static void R(box_of_points)(const glint_occlude_args *args, const uint16_t *lit, glint_point_box *out)
{
    R(point_box) box;
    R(empty_box)(&box);
    for (uint32_t g = 0; g < args->group_count; g++)
        for (int i = 0; i < GLINT_GROUP; i += VR) {
            const unsigned lanes = lit[g] >> i & ((1u << VR) - 1);
            vr point[3];
            if (!lanes)
                continue;
            R(load3)(args->point, (size_t)g * GLINT_GROUP + i, point);
            R(enclose)(&box, point, false, rm_from_bits(lanes));
        }
    R(write_box)(box, out);
    out->only = GLINT_MISS;
}

/// Prepares a tile. lit: for each group, the lanes lit by the light or by any of its samples.
static inline void R(begin_shadows)(const glint_occlude_args *args, const uint16_t *lit, R(shadow_tile) * tile)
{
    const glint_geometry_table *geometry = args->geometry;
    glint_point_box box;
    unsigned any = 0;
    tile->args = args;
    tile->count = 0;
    tile->unbounded = GLINT_OCCLUDERS + 1;
    for (uint32_t g = 0; g < args->group_count; g++)
        any |= lit[g];
    if (!any)
        return;
    if (!args->box)
        R(box_of_points)(args, lit, &box);
    else
        box = *args->box;
    for (int k = 0; k < 3; k++) { // as in index_frame, which preserves the order of numbers
        const real reference = (real)geometry->reference[k], scale = (real)geometry->scale;
        tile->lower[k] = (float)(((real)box.lower[k] - reference) * scale);
        tile->upper[k] = (float)(((real)box.upper[k] - reference) * scale);
    }
    loosen(tile->lower, tile->upper, R(walk_slack)(geometry));
    R(place_light)(tile);
    const bool on_torus = geometry->tori && box.only != GLINT_MISS && is_torus(geometry, &geometry->prims[box.only]);
    R(find_occluders)(tile, on_torus ? GLINT_MISS : box.only);
}

#endif
