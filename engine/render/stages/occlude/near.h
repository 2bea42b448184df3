// near: selects the occluders of a tile's list that may be between the points of a group and the light, a vector of
// occluders at a time. All segments of the group are within `reach` of the segment of one point of the group: their
// starts are that close to the point, and the segments end in one point or are parallel. The test is in float and
// conservative: the primitives that it leaves out block nothing. Contract: stages.h, occlude.
#ifndef GLINT_OCCLUDE_NEAR_H
#define GLINT_OCCLUDE_NEAR_H

#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/simd/real.h"

#define NEAR_MIDDLE 0x0660u ///< the lanes in the middle of a group
#define NEAR_LEAST 2 ///< with fewer occluders than this, testing all of them directly is faster
#define NEAR_MOST 0x1p80f ///< if the squared reach is above this, no occluder is left out

/// A list's occluders as bounding balls in the index's frame, one per lane.
typedef struct R(near_list) {
    _Alignas(64) float center[3][GLINT_OCCLUDERS], bound[GLINT_OCCLUDERS];
    _Alignas(64) uint32_t id[GLINT_OCCLUDERS];
    unsigned spheres; ///< lanes that hold spheres
} R(near_list);

static void R(list_balls)(const R(shadow_tile) * tile, R(near_list) * list)
{
    memset(list, 0, sizeof *list);
    for (int n = 0; n < tile->count; n++) {
        const glint_prim *prim = &tile->args->geometry->prims[tile->occluders[n].id];
        for (int k = 0; k < 3; k++)
            list->center[k][n] = prim->filter_center[k];
        list->bound[n] = prim->filter_bound;
        list->id[n] = tile->occluders[n].id;
        list->spheres |= (unsigned)(prim->kind == GLINT_PRIM_SPHERE) << n;
    }
}

static inline unsigned R(all_occluders)(const R(shadow_tile) * tile)
{
    return UINT32_MAX >> (GLINT_OCCLUDERS - tile->count);
}

/// Returns an occluder's bit in the list, or 0.
static inline unsigned R(lanes_of)(const R(shadow_tile) * tile, const R(near_list) * list, uint32_t id)
{
    unsigned lanes = 0;
    for (int i = 0; i < GLINT_OCCLUDERS; i += GLINT_GROUP)
        lanes |= lanes_equal(list->id + i, id) << i;
    return lanes & R(all_occluders)(tile);
}

/// Returns the maximum distance between the points of `lanes` and one point of the group, rounded up; infinite if
/// float overflows.
static inline float R(reach_of_group)(const R(shadow_group) * group, const float from[3], unsigned lanes)
{
    vf most = f_set(0);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const vf e[3] = { f_load(group->local[0] + i) - f_set(from[0]), f_load(group->local[1] + i) - f_set(from[1]),
                          f_load(group->local[2] + i) - f_set(from[2]) };
        const vf away2 = DOT(e, e), known = f_select(f_lt(away2, f_set(NEAR_MOST)), away2, f_set(HUGE_VALF));
        most = f_max(most, f_select(fm_from_bits(lanes >> i & ((1u << VF) - 1)), known, f_set(0)));
    }
    return sqrtf(f_max_all(most)) * (1 + 0x1p-18f);
}

/// Returns the occluders whose balls come near the segments from points within `reach` of `from`. As in
/// sort_by_sphere.
static inline unsigned R(balls_near)(const R(shadow_tile) * tile, const R(near_list) * list, const float from[3],
                                     float reach)
{
    const float slack = 2 * GLINT_FILTER_SLACK * ((fabsf(from[0]) + fabsf(from[1])) + fabsf(from[2]));
    unsigned near = 0;
    vf d[3];
    for (int k = 0; k < 3; k++)
        d[k] = f_set(tile->args->directional ? tile->local_light[k][0] : tile->local_light[k][0] - from[k]);
    for (int i = 0; i < tile->count; i += VF) {
        vf f[3];
        for (int k = 0; k < 3; k++)
            f[k] = f_set(from[k]) - f_load(list->center[k] + i);
        const vf limit = f_load(list->bound + i) + f_set(reach + slack), limit2 = limit * limit;
        const unsigned behind = fm_bits(fm_and(f_lt(f_set(0), DOT(f, d)), f_lt(limit2, DOT(f, f))));
        near |= (R(near_lanes)((const vf *)f, (const vf *)d, limit2) & ~behind) << i;
    }
    return near & R(all_occluders)(tile);
}

/// Returns the occluders, one bit each, that `lanes` of a group are tested against. A sphere is left out if all lanes
/// are on its outside.
static unsigned R(near_occluders)(const R(shadow_tile) * tile, const R(near_list) * list, R(shadow_group) * group,
                                  unsigned lanes)
{
    const unsigned middle = lanes & NEAR_MIDDLE;
    const uint32_t *prim = tile->args->prim + group->at;
    unsigned own = 0, rest = lanes;
    float from[3];
    R(place_group)(tile, group);
    for (int k = 0; k < 3; k++)
        from[k] = group->local[k][__builtin_ctz(middle ? middle : lanes)];
    const unsigned near = R(balls_near)(tile, list, from, R(reach_of_group)(group, from, lanes));
    for (int count = 0; rest; count++) {
        const uint32_t id = prim[__builtin_ctz(rest)];
        own |= R(lanes_of)(tile, list, id);
        rest &= ~lanes_equal(prim, id);
        if (!rest && !count && !(lanes & tile->args->back[group->at / GLINT_GROUP]))
            return near & ~(own & list->spheres);
    }
    return near | own;
}

/// Computes the occluders that each group's unoccluded lanes are tested against, one bit each; 0 for groups without
/// such lanes.
static void R(find_near)(const R(shadow_tile) * tile, R(shadow_group) * group, uint32_t near[GLINT_TILE_GROUPS])
{
    const glint_occlude_args *args = tile->args;
    const uint16_t *unoccluded = args->unoccluded[0];
    R(near_list) list;
    if (GLINT_REAL == 32 || tile->far ||
        tile->count < NEAR_LEAST) { // if float decides, the filter must use the same numbers as the decision
        for (uint32_t g = 0; g < args->group_count; g++)
            near[g] = unoccluded[g] ? R(all_occluders)(tile) : 0;
        return;
    }
    R(list_balls)(tile, &list);
    for (uint32_t g = 0; g < args->group_count; g++) {
        R(begin_group)(g, group);
        near[g] = unoccluded[g] ? R(near_occluders)(tile, &list, group, unoccluded[g]) : 0;
    }
}

#endif
