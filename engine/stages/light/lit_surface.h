// lit_surface: surface and light of one plain light in one pass over each group, so that points and normals stay in
// registers. The arithmetic is the same as in surface.h and light.h. Contract: stages.h.
#ifndef GLINT_LIGHT_LIT_SURFACE_H
#define GLINT_LIGHT_LIT_SURFACE_H

#include "engine/stages/cast/camera.h"
#include "engine/stages/cast/triangle.h"
#include "engine/stages/light/light.h"
#include "engine/stages/light/light_sample.h"
#include "engine/stages/simd/real.h"
#include "engine/stages/surface/surface.h"

#define LIT_PARTS (GLINT_GROUP / VR)

/// The results of a group's computation in real.
typedef struct R(lit_whole) {
    vr nl[LIT_PARTS], l2[LIT_PARTS]; ///< n.l, and the squared length of l, in the light's units
    vr num[LIT_PARTS], den[LIT_PARTS]; ///< numerator and denominator of (r.v)^2 or (n.h)^2, in lanes of `some`
    unsigned lit, back, some; ///< lanes above the light's horizon; seen from behind; with a highlight
} R(lit_whole);

/// Data that all groups of a call read, as real, in memory.
typedef struct R(lit_call) {
    real position[3], scale;
    bool scaled;
    R(surface_walk) walk;
} R(lit_call);

/// The constants of a call for all its groups.
typedef struct R(lit_wants) {
    bool normals, slack;
} R(lit_wants);

/// Computes VR lanes of the part in real, for points p with outward normals n, seen along d.
INNER void R(light_part)(const glint_surface_args *surface, const glint_light_args *light, const R(lit_call) * call,
                         const R(lit_wants) wants, const glint_shade_material *material, const vr d[3], const vr n[3],
                         const vr p[3], size_t at, int j, R(point_box) * box, R(lit_whole) * whole)
{
    const int i = j * VR;
    vr l[3];
    for (int k = 0; k < 3; k++) {
        r_store((real *)surface->point[k] + at + i, p[k]);
        l[k] = r_set(call->position[k]);
        if (!light->directional)
            l[k] = l[k] - p[k];
        if (call->scaled)
            l[k] = l[k] * r_set(call->scale);
    }
    if (surface->box)
        R(enclose)(box, p, true, rm_from_bits(0));
    if (wants.slack)
        r_store((real *)surface->slack + at + i, r_set(-GLINT_POINT_SLACK) * R(largest)(p));
    const vr away = DOT(n, d), l2 = DOT(l, l);
    const rm back = r_lt(r_set(0), away);
    for (int k = 0; wants.normals && k < 3; k++)
        r_store((real *)surface->normal[k] + at + i, r_select(back, -n[k], n[k]));
    vr nl = DOT(n, l);
    nl = r_select(back, -nl, nl); // for the normal turned towards the viewer
    const rm ahead = r_lt(r_set(0), nl);
    whole->nl[j] = nl;
    whole->l2[j] = l2;
    whole->lit |= rm_bits(ahead) << i;
    whole->back |= rm_bits(back) << i;
    whole->num[j] = whole->den[j] = r_set(0);
    if (!material)
        return;
    const vr a = DOT(d, d);
    rm some;
    if (!GLINT_WITH_BLINN || material->highlight == GLINT_HIGHLIGHT_PHONG) {
        const vr nv = r_select(back, away, -away), lv = -DOT(l, d);
        some = R(phong_parts)(nl, nv, lv, l2 * a, &whole->num[j], &whole->den[j]);
    } else {
        const vr nh = R(blinn_parts)(n, l, d, l2, a, &whole->num[j], &whole->den[j]);
        some = rm_and(r_lt(r_set(0), r_select(back, -nh, nh)), r_lt(r_set(0), whole->den[j]));
    }
    const rm spared = r_lt(whole->num[j], r_set(light->sparing ? material->least : 0) * whole->den[j]);
    whole->some |= rm_bits(rm_and(ahead, rm_andnot(some, spared))) << i;
}

/// Computes the vectors of a group that shows one solid, one plane, or one sphere near the eye; `kind` is a constant.
INNER void R(light_parts)(const glint_surface_args *surface, const glint_light_args *light, const R(lit_call) * call,
                          R(seen_slot) * slot, const R(lit_wants) wants, const glint_prim_kind kind, const glint_shade_material *material,
                          R(group_directions) directions, size_t at, R(point_box) * box, R(lit_whole) * whole)
{
#pragma GCC unroll 8
    for (int j = 0; j < LIT_PARTS; j++) {
        vr d[3], n[3], p[3];
        R(find_whole)(surface, slot, kind, directions, at, j * VR, d, n, p);
        R(light_part)(surface, light, call, wants, material, d, n, p, at, j, box, whole);
    }
}

INNER vf R(join)(const vr *x)
{
#if GLINT_REAL == 64
    return f_join(x[0], x[1]);
#else
    return x[0];
#endif
}

/// Returns the highlights of VF lanes from i on.
INNER vf R(lit_log2)(const R(lit_whole) * whole, int i)
{
    unsigned some = whole->some >> i & ((1u << VF) - 1);
    if (!some)
        return f_set(GLINT_NO_SPECULAR);
    vr x[VF / VR], less_1[VF / VR];
    for (int j = 0; j < VF / VR; j++) {
        x[j] = r_min(whole->num[i / VR + j] / whole->den[i / VR + j], r_set(1));
        less_1[j] = x[j] - r_set(1);
        some &= ~((~rm_bits(r_le(r_set(0x1p-126), x[j])) & ((1u << VR) - 1)) << j * VR);
    }
    const fm shiny = fm_from_bits(some);
    const vf log2 = f_log2(f_select(shiny, R(join)(x), f_set(1)), R(join)(less_1));
    return f_select(shiny, f_set(0.5f) * log2, f_set(GLINT_NO_SPECULAR));
}

/// Computes the part in float, for light or sample s. `shiny`, a constant: whether any lane may have a highlight.
INNER void R(finish_whole)(const glint_light_args *light, const R(lit_whole) * whole, const bool shiny, uint32_t s,
                           size_t at, vf *brightest)
{
#pragma GCC unroll 4
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm lit = fm_from_bits(whole->lit >> i & ((1u << VF) - 1));
        vf cosine = R(join)(whole->nl + i / VR);
        if (!light->directional)
            cosine = cosine / f_sqrt(R(join)(whole->l2 + i / VR));
        f_store(light->cosine[s] + at + i, f_select(lit, f_min(cosine, f_set(1)), f_set(0)));
        if (light->attenuated) {
            vr attenuation[VF / VR];
            for (int j = 0; j < VF / VR; j++)
                attenuation[j] = R(fall_off)(light, r_sqrt(whole->l2[i / VR + j]) / r_set(light->scale));
            const vf w = f_min(R(join)(attenuation), f_set(GLINT_ATTENUATION_MAX));
            f_store(light->attenuation[s] + at + i, f_select(lit, w, f_set(0)));
        }
        if (light->highlights) {
            const vf log2 = shiny ? R(lit_log2)(whole, i) : f_set(GLINT_NO_SPECULAR);
            f_store(light->log2_specular[s] + at + i, log2);
            *brightest = f_max(*brightest, log2);
        }
    }
}

/// Processes a group that shows one sphere, plane or solid in every lane, from a side that is not dark: the common
/// case. Returns whether the group was of this kind. Constants: mixed: surface->mixed; normals: whether all normals
/// are wanted.
INNER bool R(light_whole)(const glint_surface_args *surface, const glint_light_args *light, R(lit_call) * call,
                          const bool mixed, const bool normals, R(group_cursor) cursor, R(point_box) * box,
                          vf *brightest)
{
    const size_t at = (size_t)cursor.g * GLINT_GROUP;
    if (!surface->camera || (surface->hits[cursor.g] & light->hits[cursor.g]) != 0xffff)
        return false;
    const uint32_t id = surface->only ? *surface->only : surface->prim[at];
    if (!surface->only && lanes_equal(surface->prim + at, id) != 0xffff)
        return false;
    R(load_prim)(surface, &call->walk, mixed, id);
    R(seen_slot) *slot = R(last_seen)(&call->walk, mixed);
    const glint_prim *prim = slot->prim.prim;
    const bool sphere = prim->kind == GLINT_PRIM_SPHERE, solid = mixed && prim->kind == GLINT_PRIM_SOLID;
    if (!prim->two_sided || !(solid || R(is_near_or_plane)(&slot->prim)))
        return false;
    const glint_shade_material *material = &light->materials[prim->material];
    if (!light->highlights || (material->highlight != GLINT_HIGHLIGHT_PHONG &&
                               (!GLINT_WITH_BLINN || material->highlight != GLINT_HIGHLIGHT_BLINN)))
        material = NULL;
    const R(group_directions) directions = R(directions_of)(surface->camera, cursor.x, cursor.y);
    R(lit_whole) whole;
    whole.lit = whole.back = whole.some = 0;
    const R(lit_wants) wants = { normals, mixed && surface->slack };
    if (sphere)
        R(light_parts)(surface, light, call, slot, wants, GLINT_PRIM_SPHERE, material, directions, at, box, &whole);
    else if (!solid)
        R(light_parts)(surface, light, call, slot, wants, GLINT_PRIM_PLANE, material, directions, at, box, &whole);
    else
        R(light_parts)(surface, light, call, slot, wants, GLINT_PRIM_SOLID, material, directions, at, box, &whole);
    lanes_put(surface->material + at, 0xffff, prim->material);
    surface->back[cursor.g] = (uint16_t)whole.back;
    surface->dark[cursor.g] = 0;
    light->lit[0][cursor.g] = (uint16_t)whole.lit;
    call->walk.any_back = call->walk.any_back || whole.back;
    if (whole.lit)
        R(finish_whole)(light, &whole, true, 0, at, brightest);
    return true;
}

#endif
