// soft_light: light, occlude and the sums of shade for the samples of an area light, a group at a time. Points from
// which the light is completely hidden are skipped, and sums stay in registers. The arithmetic is the same as in the
// single stages. Contract: stages.h.
#ifndef GLINT_LIGHT_SOFT_LIGHT_H
#define GLINT_LIGHT_SOFT_LIGHT_H

#include "engine/stages/cast/camera.h"
#include "engine/stages/cast/triangle.h"
#include "engine/stages/light/cone.h"
#include "engine/stages/light/light.h"
#include "engine/stages/light/light_sample.h"
#include "engine/stages/light/lit_surface.h"
#include "engine/stages/light/soft.h"
#include "engine/stages/occlude/blocked.h"
#include "engine/stages/occlude/occlude.h"
#include "engine/stages/simd/real.h"

#define SOFT_PARTS (VF / VR) // number of vectors of real per vector of float
#define SOFT_PLAIN 0 // the sums are compiled for three kinds of light. This one is neither attenuated nor directed
#define SOFT_PLACED 1
#define SOFT_CONE 2 // each point has its own samples

/// Material data of sixteen lanes, for highlights.
typedef struct R(soft_gloss) {
    unsigned phong, blinn, cosine; ///< lanes whose material has a Phong highlight; a Blinn-Phong highlight; a lobe
        ///< with the factor n.l
    _Alignas(64) float shininess[GLINT_GROUP];
    _Alignas(64) float least[GLINT_GROUP]; ///< lower limit of (r.v)^2 or (n.h)^2: below it, the highlight is 0 in
        ///< shade
} R(soft_gloss);

/// A vector of VF lanes of a group, with the sums of the samples' light so far.
typedef struct R(soft_point) {
    vr point[SOFT_PARTS][3], normal[SOFT_PARTS][3]; ///< if `plain`, the point is in the light's units
    vr direction[SOFT_PARTS][3], a[SOFT_PARTS], nv[SOFT_PARTS]; ///< only set if some lane is glossy
    vf diffuse, specular;
    unsigned reached;
} R(soft_point);

/// Data shared by all groups of a call.
typedef struct R(soft_call) {
    const glint_soft_args *args;
    R(shadow_tile) tile;
    R(whole_light) light;
    R(soft_gloss) gloss; ///< material data of the current group
    bool plain; ///< true: the light is not attenuated, samples emit in all directions, and the next field is set
    _Alignas(64) real scaled[GLINT_LIGHT_CHUNK][3][GLINT_GROUP]; ///< positions of the samples in the light's units
} R(soft_call);

INNER unsigned R(join_bits)(const rm mask[SOFT_PARTS])
{
    unsigned bits = 0;
    for (int j = 0; j < SOFT_PARTS; j++)
        bits |= rm_bits(mask[j]) << j * VR;
    return bits;
}

/// Returns the highlights of the lanes in `shiny`: w S.
INNER vf R(soft_highlight)(const R(soft_call) * call, int i, unsigned shiny, const vr x[SOFT_PARTS], vf w, vf cosine)
{
    const R(soft_gloss) *gloss = &call->gloss;
    const fm mask = fm_from_bits(shiny);
    vr less_1[SOFT_PARTS];
    for (int j = 0; j < SOFT_PARTS; j++)
        less_1[j] = x[j] - r_set(1);
    const vf log2 = f_set(0.5f) * f_log2(f_select(mask, R(join)(x), f_set(1)), R(join)(less_1));
    vf s = f_exp2(f_load(gloss->shininess + i) * f_select(mask, log2, f_set(0)));
    if (gloss->cosine)
        s = s * f_select(fm_from_bits(gloss->cosine >> i & ((1u << VF) - 1)), cosine, f_set(1));
    return f_select(mask, w * s, f_set(0));
}

/// Adds the highlights of one sample to the lanes in `lit`.
INNER void R(add_highlights)(const R(soft_call) * call, int i, unsigned lit, vr l[SOFT_PARTS][3],
                             const vr l2[SOFT_PARTS], const vr nl[SOFT_PARTS], vf w, vf cosine, R(soft_point) * p)
{
    const R(soft_gloss) *gloss = &call->gloss;
    const unsigned phong = gloss->phong >> i & lit, blinn = GLINT_WITH_BLINN ? gloss->blinn >> i & lit : 0;
    vr num[SOFT_PARTS], den[SOFT_PARTS], x[SOFT_PARTS];
    rm some[SOFT_PARTS];
    for (int j = 0; j < SOFT_PARTS; j++) {
        const vr lv = -DOT(l[j], p->direction[j]);
        const unsigned blinn_lanes = blinn >> j * VR & ((1u << VR) - 1);
        some[j] = R(phong_parts)(nl[j], p->nv[j], lv, l2[j] * p->a[j], &num[j], &den[j]);
        if (blinn_lanes) {
            vr blinn_num, blinn_den;
            const vr nh = R(blinn_parts)(p->normal[j], l[j], p->direction[j], l2[j], p->a[j], &blinn_num, &blinn_den);
            const rm mask = rm_from_bits(blinn_lanes), bright = rm_and(r_lt(r_set(0), nh), r_lt(r_set(0), blinn_den));
            some[j] = rm_or(rm_and(mask, bright), rm_andnot(some[j], mask));
            num[j] = r_select(mask, blinn_num, num[j]);
            den[j] = r_select(mask, blinn_den, den[j]);
        }
        // NaN, and lanes in which den overflows, stay, and the division handles them
        some[j] = rm_andnot(some[j], r_lt(num[j], R(load_wide)(gloss->least + i + j * VR) * den[j]));
    }
    if (!(R(join_bits)(some) & (phong | blinn)))
        return;
    for (int j = 0; j < SOFT_PARTS; j++) {
        x[j] = r_min(num[j] / den[j], r_set(1));
        some[j] = rm_and(some[j], r_le(r_set(0x1p-126), x[j]));
    }
    const unsigned shiny = R(join_bits)(some) & (phong | blinn);
    p->specular = p->specular + R(soft_highlight)(call, i, shiny, x, w, cosine);
}

/// Adds sample s to VF lanes from i on; `open`: the lanes that the sample may reach. Returns the lanes on the lit
/// side of the sample, including occluded ones.
INNER unsigned R(add_sample)(const R(soft_call) * call, const int kind, const bool glossy, uint32_t s, int i,
                             unsigned open, R(soft_point) * p)
{
    const glint_light_args *args = call->args->light;
    const R(light_sample_lanes) *light_sample = &call->light.light_samples.light_sample[s];
    const vr zero = r_set(0), scale = r_set(args->scale);
    const bool plain = kind == SOFT_PLAIN, cone = kind == SOFT_CONE;
    const bool aimed = kind == SOFT_PLACED && args->light_sample[s]->emission != GLINT_EMIT_ALL;
    vr l[SOFT_PARTS][3], l2[SOFT_PARTS], nl[SOFT_PARTS], m[SOFT_PARTS];
    rm ahead[SOFT_PARTS];
    for (int j = 0; j < SOFT_PARTS; j++) {
        for (int k = 0; k < 3; k++)
            if (cone)
                l[j][k] = r_load(call->light.light_samples.direction[s][k] + i + j * VR);
            else
                l[j][k] = plain ? r_load(call->scaled[s][k] + i + j * VR) - p->point[j][k]
                                : (r_load(light_sample->position[k] + i + j * VR) - p->point[j][k]) * scale;
        l2[j] = DOT(l[j], l[j]);
        nl[j] = DOT(p->normal[j], l[j]);
        ahead[j] = r_lt(zero, nl[j]);
        m[j] = zero;
        if (aimed)
            ahead[j] = rm_and(ahead[j], R(in_front)(args->light_sample[s], light_sample, i + j * VR, l[j], &m[j]));
    }
    const unsigned before = R(join_bits)(ahead), lit = before & open;
    if (!lit)
        return before;
    const fm mask = fm_from_bits(lit);
    const vf cosine = f_min(R(join)(nl) / f_sqrt(R(join)(l2)), f_set(1));
    vf w = f_set(1);
    if (!plain && args->attenuated) {
        vr attenuation[SOFT_PARTS];
        for (int j = 0; j < SOFT_PARTS; j++) {
            if (cone)
                attenuation[j] = R(fall_off)(args, r_load(call->light.light_samples.far[s] + i + j * VR));
            else
                attenuation[j] = R(fall_off)(args, r_sqrt(l2[j]) / scale);
            if (aimed && args->light_sample[s]->emission != GLINT_EMIT_FRONT)
                attenuation[j] = attenuation[j] * (m[j] / (l2[j] * r_sqrt(l2[j])));
            if (cone)
                attenuation[j] = attenuation[j] * r_load(call->light.light_samples.weight + i + j * VR);
        }
        w = f_min(R(join)(attenuation), f_set(GLINT_ATTENUATION_MAX));
    }
    p->diffuse = f_select(mask, p->diffuse + w * cosine, p->diffuse);
    p->reached |= lit;
    if (glossy)
        R(add_highlights)(call, i, lit, l, l2, nl, w, cosine, p);
    return before;
}

/// Sorts a group's lanes by their materials.
static void R(sort_gloss)(const glint_light_args *args, size_t at, unsigned rest, R(soft_gloss) * gloss)
{
    gloss->phong = gloss->blinn = gloss->cosine = 0;
    while (args->highlights && rest) {
        const uint32_t index = args->material[at + (unsigned)__builtin_ctz(rest)];
        const glint_shade_material *material = &args->materials[index];
        const unsigned lanes = lanes_equal(args->material + at, index) & rest;
        rest &= ~lanes;
        if (material->highlight == GLINT_HIGHLIGHT_PHONG)
            gloss->phong |= lanes;
        else if (GLINT_WITH_BLINN && material->highlight == GLINT_HIGHLIGHT_BLINN)
            gloss->blinn |= lanes;
        else
            continue;
        gloss->cosine |= material->lobe == GLINT_LOBE_POWER_COSINE ? lanes : 0;
        const vf least = f_set(args->sparing ? material->least : 0);
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const fm mask = fm_from_bits(lanes >> i & ((1u << VF) - 1));
            f_store(gloss->shininess + i, f_select(mask, f_set(material->shininess), f_load(gloss->shininess + i)));
            f_store(gloss->least + i, f_select(mask, least, f_load(gloss->least + i)));
        }
    }
}

/// Adds all samples for VF lanes from i on. The lanes that each sample may reach are in call->light; rays are counted
/// for lanes of `near`. `kind` and `glossy` are constants.
INNER void R(add_samples)(const R(soft_call) * call, const int kind, const bool glossy, R(group_cursor) cursor, int i,
                          unsigned near, R(soft_point) * p)
{
    const glint_light_args *args = call->args->light;
    const size_t at = (size_t)cursor.g * GLINT_GROUP;
    const R(group_directions) directions = R(directions_of)(args->camera, cursor.x, cursor.y);
    p->diffuse = p->specular = f_set(0);
    p->reached = 0;
    for (int j = 0; j < SOFT_PARTS; j++) {
        R(load3)(args->point, at + (size_t)(i + j * VR), p->point[j]);
        R(load3)(args->normal, at + (size_t)(i + j * VR), p->normal[j]);
        for (int k = 0; k < 3 && kind == SOFT_PLAIN; k++)
            p->point[j][k] = p->point[j][k] * r_set(args->scale);
        if (!glossy)
            continue;
        R(load_direction)(directions, args->direction, at, i + j * VR, p->direction[j]);
        p->a[j] = DOT(p->direction[j], p->direction[j]);
        p->nv[j] = -DOT(p->normal[j], p->direction[j]);
    }
    for (uint32_t s = 0; s < args->sample_count; s++) {
        const unsigned open = call->light.unoccluded[s] >> i & ((1u << VF) - 1);
        const unsigned before = R(add_sample)(call, kind, glossy, s, i, open, p);
        if (near)
            *call->args->occlude->rays += (unsigned)__builtin_popcount(before & near);
    }
}

/// One copy is compiled for each set of constants.
static void R(add_matt)(const R(soft_call) * call, R(group_cursor) cursor, int i, unsigned near, R(soft_point) * p)
{
    if (call->plain)
        R(add_samples)(call, SOFT_PLAIN, false, cursor, i, near, p);
    else if (call->light.cone)
        R(add_samples)(call, SOFT_CONE, false, cursor, i, near, p);
    else
        R(add_samples)(call, SOFT_PLACED, false, cursor, i, near, p);
}

static void R(add_glossy)(const R(soft_call) * call, R(group_cursor) cursor, int i, unsigned near, R(soft_point) * p)
{
    if (call->plain)
        R(add_samples)(call, SOFT_PLAIN, true, cursor, i, near, p);
    else if (call->light.cone)
        R(add_samples)(call, SOFT_CONE, true, cursor, i, near, p);
    else
        R(add_samples)(call, SOFT_PLACED, true, cursor, i, near, p);
}

/// Processes one group. open: the lanes from which the light is not completely hidden; near: the lanes of `open` from
/// which a part of the light may be hidden.
static void R(sum_group)(R(soft_call) * call, R(group_cursor) cursor, unsigned open, unsigned near)
{
    const glint_soft_args *args = call->args;
    const size_t at = (size_t)cursor.g * GLINT_GROUP;
    _Alignas(64) float diffuse[GLINT_GROUP], specular[GLINT_GROUP];
    R(soft_point) p;
    unsigned reached = 0;
    R(sort_gloss)(args->light, at, open, &call->gloss);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const unsigned lanes = (1u << VF) - 1;
        if ((call->gloss.phong | call->gloss.blinn) >> i & lanes)
            R(add_glossy)(call, cursor, i, near >> i & lanes, &p);
        else
            R(add_matt)(call, cursor, i, near >> i & lanes, &p);
        f_store(diffuse + i, p.diffuse);
        f_store(specular + i, p.specular);
        reached |= p.reached << i;
    }
    args->reached[cursor.g] = (uint16_t)reached;
    for (int i = 0; reached && i < GLINT_GROUP; i += VF) {
        f_store(args->diffuse + at + i, f_load(diffuse + i));
        if (args->light->highlights)
            f_store(args->specular + at + i, f_load(specular + i));
    }
}

static void R(sum_groups)(R(soft_call) * call, const uint16_t *lit)
{
    const glint_soft_args *args = call->args;
    R(shadow_group) group = { .last_blocker = GLINT_MISS };
    for (R(group_cursor) cursor = { 0 }; cursor.g < args->light->group_count;
         R(next_group)(args->light->camera, &cursor)) {
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
        (args->light->light_sample, args->light->sample_count, args->light->scale, args->light->point,
         args->light->normal, (size_t)cursor.g * GLINT_GROUP, &call->light.light_samples);
        for (uint32_t s = 0; s < GLINT_LIGHT_CHUNK; s++)
            call->light.unoccluded[s] = open;
        if (sorted.any_near)
            R(block_group)(&call->tile, &sorted, group.at, &call->light);
        R(sum_group)(call, cursor, open, sorted.any_near);
    }
}

/// Scales the positions of the samples, so that the direction to a sample is one difference. The light's scale is a
/// power of two, so the bits are the same, unless a number overflows or loses digits. In that case, returns false.
static bool R(scale_light_samples)(R(soft_call) * call)
{
    const glint_light_args *args = call->args->light;
    const bool wide = GLINT_REAL == 64;
    const double least_scale = wide ? 0x1p-500 : 0x1p-30, most_scale = wide ? 0x1p500 : 0x1p30;
    const vr least = r_set(wide ? 0x1p-400 : 0x1p-60), most = r_set(wide ? 0x1p500 : 0x1p60);
    if (!(args->scale > least_scale && args->scale < most_scale))
        return false;
    rm fit = r_lt(r_set(0), r_set(1));
    for (uint32_t s = 0; s < args->sample_count; s++)
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < GLINT_GROUP; i += VR) {
                const vr x = r_load(call->light.light_samples.light_sample[s].position[k] + i), size = r_max(x, -x);
                fit = rm_and(fit, rm_or(r_eq(x, r_set(0)), rm_and(r_lt(least, size), r_lt(size, most))));
                r_store(call->scaled[s][k] + i, x * r_set(args->scale));
            }
    return rm_bits(fit) == (1u << VR) - 1;
}

static bool R(soft_light)(const glint_soft_args *args)
{
    const glint_light_args *light = args->light;
    R(soft_call) call;
    uint16_t lit[GLINT_TILE_GROUPS];
    call.args = args;
    call.tile.count = 0;
    call.gloss = (R(soft_gloss)) { .phong = 0 };
    for (uint32_t g = 0; g < light->group_count; g++)
        lit[g] = light->hits[g] & (light->hits[g] ? ~(unsigned)light->dark[g] : 0);
    if (args->occlude)
        R(begin_shadows)(args->occlude, lit, &call.tile);
    if (call.tile.count > GLINT_OCCLUDERS)
        return false;
    if (call.tile.count)
        R(place_soft_light)(&call.tile, &call.light);
    R(load_samples)(light->light_sample, light->sample_count, &call.light);
    call.plain =
        !light->attenuated && light->light_sample[0]->emission == GLINT_EMIT_ALL && R(scale_light_samples)(&call);
    R(sum_groups)(&call, lit);
    return true;
}

#endif
