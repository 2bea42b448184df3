// light: the effect of one light at each point, before shadows and colours. The geometry is real; square root,
// division and logarithm follow in float for the whole group, because float is accurate enough for them. This file
// has spots and area lights, and functions for plain.h and lit_surface.h; the stage itself is in plain.h. Contract:
// stages.h.
#ifndef GLINT_LIGHT_LIGHT_H
#define GLINT_LIGHT_LIGHT_H

#include "engine/stages/cast/camera.h"
#include "engine/stages/light/cone.h"
#include "engine/stages/light/light_sample.h"
#include "engine/stages/simd/real.h"

/// The results of one light or sample for a group.
typedef struct R(lit_group) {
    _Alignas(64) real along[GLINT_GROUP]; ///< n.l, in the light's units
    _Alignas(64) real distance2[GLINT_GROUP];
    _Alignas(64) real x[GLINT_GROUP], x_less_1[GLINT_GROUP]; ///< (r.v)^2 or (n.h)^2, and the same minus 1
    _Alignas(64) float cone_cosine[GLINT_GROUP], cone_less_1[GLINT_GROUP], cone_step[GLINT_GROUP]; ///< for a spot:
        ///< cosine of the angle to the axis, the cosine minus 1, and the smooth step
    unsigned lit, shiny;
    vf brightest; ///< maximum over the groups so far, for each lane
} R(lit_group);

/// Computes (r.v)^2 as num / den. Returns the lanes with a highlight.
INNER rm R(phong_parts)(vr nl, vr nv, vr lv, vr l2a, vr *num, vr *den)
{
    vr rv = (r_set(2) * nl) * nv - lv;
    *num = rv * rv;
    *den = l2a;
    return r_lt(r_set(0), rv);
}

/// Computes (n.h)^2 likewise, from the same h in num and den. At grazing light h is a difference with few digits
/// left: if it were rounded differently in num and den, the error would grow by 1 / |h|^2, and then by the shininess.
INNER vr R(blinn_parts)(const vr n[3], const vr l[3], const vr d[3], vr l2, vr a, vr *num, vr *den)
{
    const vr w = r_sqrt(l2 * a);
    const vr h[3] = { a * l[0] - w * d[0], a * l[1] - w * d[1], a * l[2] - w * d[2] };
    const vr nh = DOT(n, h);
    *num = nh * nh;
    *den = DOT(h, h);
    return nh;
}

/// Data shared by a light's samples: the surfaces of one group, and one vector of the group's lanes.
typedef struct R(lit_point) {
    unsigned phong, blinn; ///< lanes whose material has a Phong highlight; a Blinn-Phong highlight
    _Alignas(64) float least[GLINT_GROUP]; ///< `least` of each lane's material, if `sparing`; otherwise 0
    R(group_directions) directions;
    vr point[3], normal[3];
    bool aimed; ///< true: the next field is set
    vr direction[3];
    bool viewed; ///< true: the next fields are set
    vr a, nv; ///< a = length2(direction)
} R(lit_point);

INNER void R(view_lanes)(const glint_light_args *args, size_t at, int i, R(lit_point) * surface)
{
    if (surface->viewed)
        return;
    if (!surface->aimed)
        R(load_direction)(surface->directions, args->direction, at, i, surface->direction);
    surface->a = DOT(surface->direction, surface->direction);
    surface->nv = -DOT(surface->normal, surface->direction);
    surface->viewed = true;
}

/// Returns 1 / (c0 + (c1 d + c2 d^2)).
INNER vr R(fall_off)(const glint_light_args *args, vr distance)
{
    const vr c0 = r_set(args->coefficients[0]), c1 = r_set(args->coefficients[1]), c2 = r_set(args->coefficients[2]);
    return r_set(1) / (c0 + (c1 * distance + c2 * (distance * distance)));
}

/// Computes the real part of one vector of lanes, for sample s. `kind` is a constant.
INNER void R(light_lanes)(const glint_light_args *args, const int kind, uint32_t s,
                          const R(light_sample_set) * light_samples, size_t at, int i, unsigned open,
                          R(lit_point) * surface, R(lit_group) * group)
{
    const vr zero = r_set(0), scale = r_set(args->scale);
    vr l[3], m = zero;
    for (int k = 0; k < 3; k++) {
        if (kind == LIGHT_CONE) {
            l[k] = r_load(light_samples->direction[s][k] + i);
            continue;
        }
        l[k] = kind == LIGHT_LIGHT_SAMPLE ? r_load(light_samples->light_sample[s].position[k] + i)
                                          : r_set(args->position[k]);
        if (!args->directional)
            l[k] = (l[k] - surface->point[k]) * scale;
    }
    vr l2 = DOT(l, l), nl = DOT(surface->normal, l);
    rm ahead = r_lt(zero, nl);
    const bool aimed = kind == LIGHT_LIGHT_SAMPLE && args->light_sample[s]->emission != GLINT_EMIT_ALL;
    if (kind == LIGHT_SPOT)
        ahead = rm_and(
            ahead, R(in_cone)(args->spot, l, l2, group->cone_cosine + i, group->cone_less_1 + i, group->cone_step + i));
    if (aimed)
        ahead = rm_and(ahead, R(in_front)(args->light_sample[s], &light_samples->light_sample[s], i, l, &m));
    const unsigned lit = rm_bits(ahead) & open >> i & ((1u << VR) - 1);
    group->lit |= lit << i;
    if (!lit)
        return;
    r_store(group->along + i, nl);
    r_store(group->distance2 + i, l2);
    if (args->attenuated) {
        vr attenuation;
        if (kind == LIGHT_CONE)
            attenuation = R(fall_off)(args, r_load(light_samples->far[s] + i));
        else
            attenuation = R(fall_off)(args, r_sqrt(l2) / scale);
        if (aimed && args->light_sample[s]->emission != GLINT_EMIT_FRONT)
            attenuation = attenuation * (m / (l2 * r_sqrt(l2)));
        if (kind == LIGHT_CONE)
            attenuation = attenuation * r_load(light_samples->weight + i);
        r_store_f(args->attenuation[s] + at + i, attenuation);
    }
    const unsigned phong = surface->phong >> i & lit, blinn = GLINT_WITH_BLINN ? surface->blinn >> i & lit : 0;
    if (!(phong | blinn))
        return;
    R(view_lanes)(args, at, i, surface);
    const vr a = surface->a, nv = surface->nv, lv = -DOT(l, surface->direction);
    vr num, den;
    rm some = rm_and(rm_from_bits(phong), R(phong_parts)(nl, nv, lv, l2 * a, &num, &den));
    if (blinn) {
        vr blinn_num, blinn_den;
        const rm mask = rm_from_bits(blinn);
        const vr nh = R(blinn_parts)(surface->normal, l, surface->direction, l2, a, &blinn_num, &blinn_den);
        some = rm_or(some, rm_and(mask, rm_and(r_lt(zero, nh), r_lt(zero, blinn_den))));
        num = r_select(mask, blinn_num, num);
        den = r_select(mask, blinn_den, den);
    }
    some = rm_andnot(some, r_lt(num, R(load_wide)(surface->least + i) * den));
    if (!rm_bits(some))
        return;
    const vr x = r_min(num / den, r_set(1));
    r_store(group->x + i, x);
    r_store(group->x_less_1 + i, x - r_set(1));
    group->shiny |= rm_bits(rm_and(some, r_le(r_set(0x1p-126), x))) << i;
}

/// Computes the float part of one group.
INNER void R(finish_light)(const glint_light_args *args, const int kind, uint32_t s, size_t at, R(lit_group) * group)
{
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm lit = fm_from_bits(group->lit >> i & ((1u << VF) - 1));
        vf cosine = R(load_narrow)(group->along + i);
        if (!args->directional)
            cosine = cosine / f_sqrt(R(load_narrow)(group->distance2 + i));
        f_store(args->cosine[s] + at + i, f_select(lit, f_min(cosine, f_set(1)), f_set(0)));
        if (args->attenuated) {
            vf attenuation = f_min(f_load(args->attenuation[s] + at + i), f_set(GLINT_ATTENUATION_MAX));
            if (kind == LIGHT_SPOT)
                attenuation =
                    attenuation * R(cone_factor)(args->spot, lit, f_load(group->cone_cosine + i),
                                                 f_load(group->cone_less_1 + i), f_load(group->cone_step + i));
            f_store(args->attenuation[s] + at + i, f_select(lit, attenuation, f_set(0)));
        }
        const unsigned shiny_lanes = group->shiny >> i & ((1u << VF) - 1);
        if (args->highlights && !shiny_lanes) {
            f_store(args->log2_specular[s] + at + i, f_set(GLINT_NO_SPECULAR));
        } else if (args->highlights) {
            const fm shiny = fm_from_bits(shiny_lanes);
            vf log2 =
                f_log2(f_select(shiny, R(load_narrow)(group->x + i), f_set(1)), R(load_narrow)(group->x_less_1 + i));
            log2 = f_select(shiny, f_set(0.5f) * log2, f_set(GLINT_NO_SPECULAR));
            f_store(args->log2_specular[s] + at + i, log2);
            group->brightest = f_max(group->brightest, log2);
        }
    }
}

INNER void R(say_brightest)(const glint_light_args *args, uint32_t s, vf brightest)
{
    if (args->highlights && args->brightest[s])
        *args->brightest[s] = f_max_all(brightest);
}

/// Sets the highlight of lanes that show one material.
INNER void R(sort_lanes)(const glint_light_args *args, const glint_shade_material *material, unsigned lanes,
                         R(lit_point) * surface)
{
    if (material->highlight == GLINT_HIGHLIGHT_PHONG)
        surface->phong |= lanes;
    else if (GLINT_WITH_BLINN && material->highlight == GLINT_HIGHLIGHT_BLINN)
        surface->blinn |= lanes;
    const vf least = f_set(args->sparing ? material->least : 0);
    for (int i = 0; i < GLINT_GROUP; i += VF)
        f_store(surface->least + i,
                f_select(fm_from_bits(lanes >> i & ((1u << VF) - 1)), least, f_load(surface->least + i)));
}

/// Sets the highlights of the lanes `rest`, material by material.
INNER void R(sort_highlights)(const glint_light_args *args, size_t at, unsigned rest, R(lit_point) * surface)
{
    surface->phong = surface->blinn = 0;
    while (args->highlights && rest) {
        const uint32_t material = args->material[at + (unsigned)__builtin_ctz(rest)];
        const unsigned lanes = lanes_equal(args->material + at, material);
        R(sort_lanes)(args, &args->materials[material], lanes, surface);
        rest &= ~lanes;
    }
}

/// Computes the real part of a group for each sample. The surfaces must be known.
INNER void R(light_group)(const glint_light_args *args, const int kind, const uint32_t samples,
                          R(light_sample_set) * light_samples, R(group_cursor) cursor, R(lit_point) * surface,
                          R(lit_group) * groups)
{
    const size_t at = (size_t)cursor.g * GLINT_GROUP;
    const unsigned open = args->hits[cursor.g] & ~(unsigned)args->dark[cursor.g];
    for (uint32_t s = 0; s < samples; s++)
        groups[s].lit = groups[s].shiny = 0;
    if (!open)
        return;
    surface->directions = R(directions_of)(args->camera, cursor.x, cursor.y);
    R(sort_highlights)(args, at, open, surface);
    if (kind == LIGHT_CONE)
        R(place_in_cone)(args->light_sample, samples, args->scale, args->point, args->normal, at, light_samples);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        R(load3)(args->point, at + i, surface->point);
        R(load3)(args->normal, at + i, surface->normal);
        surface->aimed = surface->viewed = false;
        for (uint32_t s = 0; s < samples; s++)
            R(light_lanes)(args, kind, s, light_samples, at, i, open, surface, &groups[s]);
    }
}

/// Computes all groups. `kind` is a constant, and so is `samples` for a light without samples.
static inline void R(light_groups)(const glint_light_args *args, const int kind, const uint32_t samples,
                                   R(light_sample_set) * light_samples, R(lit_group) * groups)
{
    R(lit_point) surface = { 0 };
    for (uint32_t s = 0; s < samples; s++)
        groups[s].brightest = f_set(GLINT_NO_SPECULAR);
    for (R(group_cursor) cursor = { 0 }; cursor.g < args->group_count; R(next_group)(args->camera, &cursor)) {
        R(light_group)(args, kind, samples, light_samples, cursor, &surface, groups);
        for (uint32_t s = 0; s < samples; s++) {
            args->lit[s][cursor.g] = (uint16_t)groups[s].lit;
            if (groups[s].lit)
                R(finish_light)(args, kind, s, (size_t)cursor.g * GLINT_GROUP, &groups[s]);
        }
    }
    for (uint32_t s = 0; s < samples; s++)
        R(say_brightest)(args, s, groups[s].brightest);
}

static void R(light_area)(const glint_light_args *args)
{
    R(light_sample_set) light_samples;
    R(lit_group) groups[GLINT_LIGHT_CHUNK] = { { .lit = 0 } };
    R(load_light_samples)(args->light_sample, args->sample_count, &light_samples);
    if (R(is_cone)(args->light_sample[0]))
        R(light_groups)(args, LIGHT_CONE, args->sample_count, &light_samples, groups);
    else
        R(light_groups)(args, LIGHT_LIGHT_SAMPLE, args->sample_count, &light_samples, groups);
}

static void R(light_spot)(const glint_light_args *args)
{
    R(lit_group) group = { .lit = 0 };
    R(light_groups)(args, LIGHT_SPOT, 1, NULL, &group);
}

#endif
