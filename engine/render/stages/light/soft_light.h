// soft_light: light, occlude and the sums of shade for the samples of an area light, a group at a time. Points from
// which the light is completely hidden are skipped, and sums stay in registers. The arithmetic is the same as in the
// single stages. Contract: stages.h.
#ifndef GLINT_LIGHT_SOFT_LIGHT_H
#define GLINT_LIGHT_SOFT_LIGHT_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/light/cone.h"
#include "engine/render/stages/light/light.h"
#include "engine/render/stages/light/light_sample.h"
#include "engine/render/stages/light/soft.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/occlude/occlude.h"
#include "engine/render/stages/simd/real.h"

/// Data shared by all groups of a call.
typedef struct R(soft_call) {
    const glint_soft_args *args;
    R(shadow_tile) tile;
    R(whole_light) light;
    R(gloss) gloss; ///< of the current group
} R(soft_call);

/// The sums over samples of VF lanes.
typedef struct R(soft_sums) {
    vf diffuse, specular;
    unsigned reached;
} R(soft_sums);

/// Adds a sample.
INNER void R(add_lit)(const R(gloss) * gloss, int i, const R(lit_lanes) * lanes, R(soft_sums) * sums)
{
    const vf share = sums->diffuse + lanes->weight * lanes->cosine;
    sums->diffuse = f_select(fm_from_bits(lanes->lit), share, sums->diffuse);
    sums->reached |= lanes->lit;
    if (!lanes->shiny)
        return;
    vf s = f_exp2(f_load(gloss->shininess + i) * lanes->log2);
    if (gloss->cosine)
        s = s * f_select(fm_from_bits(gloss->cosine >> i & LIT_LANES), lanes->cosine, f_set(1));
    sums->specular = sums->specular + f_select(fm_from_bits(lanes->shiny), lanes->weight * s, f_set(0));
}

/// Adds all samples for the lanes from i on. The lanes that each sample may reach are in call->light; rays are counted
/// for lanes of `near`. Constants: kind, glossy.
INNER R(soft_sums) R(add_samples)(const R(soft_call) * call, const int kind, const bool glossy, R(group_cursor) cursor,
                                  int i, unsigned near)
{
    const glint_light_args *args = call->args->light;
    R(soft_sums) sums = { f_set(0), f_set(0), 0 };
    R(lit_points) p;
    R(load_points)(args, cursor, i, &p);
    for (uint32_t s = 0; s < args->sample_count; s++) {
        const unsigned open = call->light.unoccluded[s] >> i & LIT_LANES;
        const R(lit_lanes) lanes =
            R(light_lanes)(args, kind, glossy, s, &call->light.light_samples, &call->gloss, &p, i, open);
        if (lanes.lit)
            R(add_lit)(&call->gloss, i, &lanes, &sums);
        if (near)
            *call->args->occlude->rays += (unsigned)__builtin_popcount(lanes.ahead & near);
    }
    return sums;
}

/// Compiles one copy for each set of constants.
static R(soft_sums) R(add_vector)(const R(soft_call) * call, R(group_cursor) cursor, int i, unsigned near)
{
    const bool glossy = (call->gloss.phong | call->gloss.blinn) >> i & LIT_LANES;
    if (call->light.cone)
        return glossy ? R(add_samples)(call, LIGHT_CONE, true, cursor, i, near)
                      : R(add_samples)(call, LIGHT_CONE, false, cursor, i, near);
    return glossy ? R(add_samples)(call, LIGHT_SAMPLE, true, cursor, i, near)
                  : R(add_samples)(call, LIGHT_SAMPLE, false, cursor, i, near);
}

/// Processes one group. open: the lanes from which the light is not completely hidden; near: the lanes of `open` from
/// which a part of the light may be hidden.
static void R(sum_group)(R(soft_call) * call, R(group_cursor) cursor, unsigned open, unsigned near)
{
    const glint_soft_args *args = call->args;
    const size_t at = (size_t)cursor.g * GLINT_GROUP;
    R(soft_sums) sums[GLINT_GROUP / VF];
    unsigned reached = 0;
    R(sort_gloss)(args->light, at, open, &call->gloss);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        sums[i / VF] = R(add_vector)(call, cursor, i, near >> i & LIT_LANES);
        reached |= sums[i / VF].reached << i;
    }
    args->reached[cursor.g] = (uint16_t)reached;
    for (int i = 0; reached && i < GLINT_GROUP; i += VF) {
        f_store(args->diffuse + at + i, sums[i / VF].diffuse);
        if (args->light->highlights)
            f_store(args->specular + at + i, sums[i / VF].specular);
    }
}

static void R(sum_groups)(R(soft_call) * call, const uint16_t *lit)
{
    const glint_soft_args *args = call->args;
    const glint_light_args *light = args->light;
    R(shadow_group) group = { .last_blocker = GLINT_MISS };
    for (R(group_cursor) cursor = { 0 }; cursor.g < light->group_count; R(next_group)(light->camera, &cursor)) {
        R(soft_group) sorted;
        sorted.any_near = sorted.hidden = 0;
        if (lit[cursor.g] && call->tile.count) {
            R(begin_group)(cursor.g, &group);
            sorted = R(sort_group)(&call->tile, &call->light, &group, lit[cursor.g]);
        }
        const unsigned open = lit[cursor.g] & ~sorted.hidden;
        args->reached[cursor.g] = 0;
        if (!open)
            continue;
        if (call->light.cone)
            R(place_in_cone)
            (light->light_sample, light->sample_count, light->scale, light->point, light->normal,
             (size_t)cursor.g * GLINT_GROUP, &call->light.light_samples);
        for (uint32_t s = 0; s < GLINT_LIGHT_CHUNK; s++)
            call->light.unoccluded[s] = open;
        if (sorted.any_near)
            R(block_group)(&call->tile, &sorted, group.at, &call->light);
        R(sum_group)(call, cursor, open, sorted.any_near);
    }
}

static bool R(soft_light)(const glint_soft_args *args)
{
    const glint_light_args *light = args->light;
    R(soft_call) call;
    uint16_t lit[GLINT_TILE_GROUPS];
    call.args = args;
    call.tile.count = 0;
    call.gloss = (R(gloss)) { .phong = 0 };
    for (uint32_t g = 0; g < light->group_count; g++)
        lit[g] = light->hits[g] & (light->hits[g] ? ~(unsigned)light->dark[g] : 0);
    if (args->occlude)
        R(begin_shadows)(args->occlude, lit, &call.tile);
    if (call.tile.count > GLINT_OCCLUDERS)
        return false;
    if (call.tile.count)
        R(place_soft_light)(&call.tile, &call.light);
    R(load_samples)(light->light_sample, light->sample_count, &call.light);
    R(sum_groups)(&call, lit);
    return true;
}

#endif
