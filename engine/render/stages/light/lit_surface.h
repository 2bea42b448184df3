// lit_surface: surface and light of one plain light in one pass over each group, so that points and normals stay in
// registers. The arithmetic is the same as in surface.h and light.h. Contract: stages.h.
#ifndef GLINT_LIGHT_LIT_SURFACE_H
#define GLINT_LIGHT_LIT_SURFACE_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/light/light.h"
#include "engine/render/stages/simd/real.h"
#include "engine/render/stages/surface/surface.h"

/// Data that all groups of a call share. The constants `mixed` and `normals`: surface->mixed, and whether all normals
/// are wanted.
typedef struct R(lit_call) {
    const glint_surface_args *surface;
    const glint_light_args *light;
    R(surface_walk) walk;
    R(point_box) box;
    R(gloss) gloss; ///< of the last group, or of all groups that show only `material`
    uint32_t material; ///< GLINT_MISS: the last group showed several materials
    vf brightest;
} R(lit_call);

/// Stores points, and computes the normals and dot products in `p`. n: outward normals. Returns the lanes that are seen
/// from behind.
INNER unsigned R(put_part)(R(lit_call) * call, const bool mixed, const bool normals, const bool glossy, const vr n[3],
                           size_t at, int j, R(lit_points) * p)
{
    const glint_surface_args *surface = call->surface;
    const vr away = DOT(n, p->direction[j]);
    const rm back = r_lt(r_set(0), away);
    for (int k = 0; k < 3; k++) {
        p->normal[j][k] = r_select(back, -n[k], n[k]);
        r_store((real *)surface->point[k] + at, p->point[j][k]);
        if (normals)
            r_store((real *)surface->normal[k] + at, p->normal[j][k]);
    }
    if (surface->box)
        R(enclose)(&call->box, p->point[j], true, rm_from_bits(0));
    if (mixed && surface->slack)
        r_store((real *)surface->slack + at, r_set(-GLINT_POINT_SLACK) * R(largest)(p->point[j]));
    if (glossy) {
        p->a[j] = DOT(p->direction[j], p->direction[j]);
        p->nv[j] = r_select(back, away, -away);
    }
    return rm_bits(back);
}

/// Processes a group that shows one solid, one plane, or one sphere near the eye. Constants: mixed, normals, kind;
/// glossy: the material may have highlights.
INNER void R(light_vectors)(R(lit_call) * call, R(seen_slot) * slot, const bool mixed, const bool normals,
                            const glint_prim_kind kind, const bool glossy, R(group_cursor) cursor)
{
    const glint_light_args *light = call->light;
    const size_t at = (size_t)cursor.g * GLINT_GROUP;
    const R(group_directions) directions = R(directions_of)(light->camera, cursor.x, cursor.y);
    unsigned lit = 0, back = 0;
#pragma GCC unroll 4
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        R(lit_points) p;
        for (int j = 0; j < LIT_PARTS; j++) {
            vr n[3];
            R(find_whole)(call->surface, slot, kind, directions, at, i + j * VR, p.direction[j], n, p.point[j]);
            back |= R(put_part)(call, mixed, normals, glossy, n, at + (size_t)(i + j * VR), j, &p) << (i + j * VR);
        }
        const R(lit_lanes) lanes = R(light_lanes)(light, LIGHT_PLAIN, glossy, 0, NULL, &call->gloss, &p, i, LIT_LANES);
        if (!lanes.lit)
            continue;
        R(store_lit)(light, 0, at + (size_t)i, &lanes);
        lit |= lanes.lit << i;
        call->brightest = f_max(call->brightest, lanes.log2);
    }
    R(end_lit)(light, 0, cursor.g, lit);
    call->surface->back[cursor.g] = (uint16_t)back;
    call->surface->dark[cursor.g] = 0;
    call->walk.any_back = call->walk.any_back || back;
}

/// Calls light_vectors with `glossy` as a constant. With `normals`, materials without highlights use the copy for
/// highlights, too: another copy would only take longer to compile.
INNER void R(light_whole)(R(lit_call) * call, R(seen_slot) * slot, const bool mixed, const bool normals,
                          const glint_prim_kind kind, R(group_cursor) cursor)
{
    if (normals || (call->gloss.phong | call->gloss.blinn))
        R(light_vectors)(call, slot, mixed, normals, kind, true, cursor);
    else
        R(light_vectors)(call, slot, mixed, normals, kind, false, cursor);
}

/// Processes a group that shows one sphere, plane or solid in every lane, from a side that is not dark: the common
/// case. Returns whether the group was of this kind.
INNER bool R(try_whole)(R(lit_call) * call, const bool mixed, const bool normals, R(group_cursor) cursor)
{
    const glint_surface_args *surface = call->surface;
    const size_t at = (size_t)cursor.g * GLINT_GROUP;
    if (!surface->camera || (surface->hits[cursor.g] & call->light->hits[cursor.g]) != 0xffff)
        return false;
    const uint32_t id = surface->only ? *surface->only : surface->prim[at];
    if (!surface->only && lanes_equal(surface->prim + at, id) != 0xffff)
        return false;
    R(load_prim)(surface, &call->walk, mixed, id);
    R(seen_slot) *slot = R(last_seen)(&call->walk, mixed);
    const glint_prim *prim = slot->prim.prim;
    const bool solid = mixed && prim->kind == GLINT_PRIM_SOLID;
    if (!prim->two_sided || !(solid || R(is_near_or_plane)(&slot->prim)))
        return false;
    lanes_put(surface->material + at, 0xffff, prim->material);
    if (call->material != prim->material)
        R(sort_gloss)(call->light, at, 0xffff, &call->gloss);
    call->material = prim->material;
    if (prim->kind == GLINT_PRIM_SPHERE)
        R(light_whole)(call, slot, mixed, normals, GLINT_PRIM_SPHERE, cursor);
    else if (!solid)
        R(light_whole)(call, slot, mixed, normals, GLINT_PRIM_PLANE, cursor);
    else
        R(light_whole)(call, slot, mixed, normals, GLINT_PRIM_SOLID, cursor);
    return true;
}

/// Computes the light of a group whose points and normals are stored, and returns the group's brightest highlight. Not
/// inlined: few groups come here.
static __attribute__((noinline)) vf R(light_stored)(const glint_light_args *light, R(gloss) * gloss,
                                                    R(group_cursor) cursor)
{
    vf brightest = f_set(GLINT_NO_SPECULAR);
    R(light_group)(light, LIGHT_PLAIN, NULL, gloss, cursor, &brightest);
    return brightest;
}

/// Processes all groups of a call. Constants: mixed, normals.
INNER void R(lit_surfaces)(const glint_surface_args *surface, const glint_light_args *light, const bool mixed,
                           const bool normals)
{
    R(lit_call) call = { .surface = surface, .light = light, .material = GLINT_MISS };
    call.brightest = f_set(GLINT_NO_SPECULAR);
    R(begin_walk)(surface, &call.walk);
    R(empty_box)(&call.box);
    for (R(group_cursor) cursor = { 0 }; cursor.g < surface->group_count; R(next_group)(surface->camera, &cursor)) {
        const uint32_t g = cursor.g;
        if (!surface->hits[g]) {
            surface->back[g] = surface->dark[g] = 0;
            light->lit[0][g] = 0;
        } else if (!R(try_whole)(&call, mixed, normals, cursor)) {
            R(surface_group)(surface, &call.walk, &call.box, cursor, mixed ? R(MIXED) : R(BALLS_AND_PLANES));
            call.brightest = f_max(call.brightest, R(light_stored)(light, &call.gloss, cursor));
            call.material = GLINT_MISS;
        }
    }
    R(end_walk)(surface, &call.walk, &call.box);
    R(say_brightest)(light, 0, call.brightest);
}

/// Processes all groups of a call with triangles or solids. This is a separate function, so that it takes no registers
/// from the code for spheres and planes.
static __attribute__((noinline)) void R(lit_mixed)(const glint_surface_args *surface, const glint_light_args *light)
{
    R(lit_surfaces)(surface, light, true, true);
}

static void R(lit_surface)(const glint_surface_args *surface, const glint_light_args *light)
{
    if (surface->mixed)
        R(lit_mixed)(surface, light);
    else if (surface->all_normals)
        R(lit_surfaces)(surface, light, false, true);
    else
        R(lit_surfaces)(surface, light, false, false);
}

#endif
