// Computes how fast reflected light changes: evaluates the formulas of stages/ref/light.h, stages/ref/shade.h and
// effects/microfacet/ref.h on numbers with slopes. Contract: contract.h.
#ifndef GLINT_DERIVATIVE_KERNEL_LIGHT_H
#define GLINT_DERIVATIVE_KERNEL_LIGHT_H

#include "engine/render/effects/derivative/kernel_sloped.h"
#include "engine/render/pattern/kernel_call.h"
#include "engine/render/pattern/kernel_elementary.h"
#include "engine/render/pattern/kernel_exact.h"
#include "engine/render/stages/simd/elementary.h"

// Sets of inputs that have slopes. Each kernel is compiled for some combinations of these sets.
enum {
    SLOPES_BENT = 1, ///< points, normals and eye vectors
    SLOPES_TURNED = 2, ///< position and direction of the light
    SLOPES_OTHER = 4, ///< colours, and all other inputs
    SLOPES_ALL = 7
};

/// A vector of VD points with their slopes.
typedef struct seen_lanes {
    vs point[3], normal[3], eye[3];
} seen_lanes;

/// The data of a light for VD lanes of a group.
typedef struct shine_lanes {
    vs direction[3]; ///< unit, towards the light
    vs cosine; ///< n.l
    vs distance; ///< directional: infinite
    vs weight; ///< attenuation by distance, cone and the light's surface, times the transmitted share
    bool weighs; ///< false: the weight is 1
} shine_lanes;

INNER void load_points(const glint_derivative_points *points, int quantity, const unsigned slopes, int i, vs out[3])
{
    const double *const *from = quantity == 0 ? points->point : quantity == 1 ? points->normal : points->eye;
    for (int c = 0; c < 3; c++)
        out[c] = s_load(from[c], points->slope[quantity][c], slopes & SLOPES_BENT, i);
}

INNER seen_lanes seen_points(const glint_derivative_points *points, const unsigned slopes, int i)
{
    seen_lanes out;
    load_points(points, 0, slopes, i, out.point);
    load_points(points, 1, slopes, i, out.normal);
    load_points(points, 2, slopes, i, out.eye);
    return out;
}

/// Returns the factor of a spot's cone; see spot_x and cone in stages/ref/light.h.
INNER vs spot_cone(const glint_derivative_light *light, const unsigned slopes, const vs direction[3])
{
    const bool any = slopes, turned = slopes & SLOPES_TURNED, other = slopes & SLOPES_OTHER;
    const vs axis[3] = { s_of(turned, light->axis[0]), s_of(turned, light->axis[1]), s_of(turned, light->axis[2]) };
    const vs zero = s_set(0), one = s_set(1), c = s_sub(zero, s_dot(axis, direction));
    vs x = s_keep(any, s_mul(s_sub(c, s_of(other, light->outer)), s_of(other, light->inverse)));
    if (light->inverse.value == HUGE_VAL)
        x = s_keep(any, s_select(d_lt(d_set(light->outer.value), c.v), one, zero));
    x = s_keep(any, s_max(s_min(x, one), zero));
    const vs step = s_mul(s_mul(x, x), s_sub(s_set(3), s_add(x, x)));
    if (light->exponent.value == 0 && light->exponent.slope == 0)
        return step;
    return s_mul(step, s_pow(c, s_of(other, light->exponent)));
}

/// Returns the weight of a light's surface with radiance, from the orientation and the distance of the surface.
INNER vs surface_weight(const glint_derivative_source *source, const vs direction[3], vs length2, vs distance, int i)
{
    vs normal[3];
    for (int c = 0; c < 3; c++)
        normal[c] = s_level(d_load(source->normal[c] + i));
    vs m = s_sub(s_set(0), s_dot(direction, normal));
    if (source->both)
        m = s_select(d_lt(m.v, d_set(0)), s_sub(s_set(0), m), m);
    return s_div(m, s_mul(length2, distance));
}

/// Computes the attenuation by distance and cone.
INNER vs weaken(const glint_derivative_light *light, const shine_lanes *s, const unsigned slopes)
{
    const bool any = slopes, other = slopes & SLOPES_OTHER;
    vs weight = s->weight;
    if (light->attenuated) {
        const vs first = s_of(other, light->coefficients[1]), second = s_of(other, light->coefficients[2]);
        const vs further = s_mul(s->distance, s_add(first, s_mul(second, s->distance)));
        weight = s_keep(any, s_div(weight, s_add(s_of(other, light->coefficients[0]), further)));
    }
    if (light->is_spot)
        weight = s_keep(any, s_mul(weight, spot_cone(light, slopes, s->direction)));
    return weight;
}

INNER shine_lanes find_shine(const glint_derivative_light *light, const glint_derivative_source *source, const vs point[3],
                             const vs normal[3], const unsigned slopes, int i)
{
    const bool turned = slopes & SLOPES_TURNED, moving = slopes & (SLOPES_BENT | SLOPES_TURNED);
    const bool any = slopes;
    shine_lanes s = { .distance = s_keep(moving, s_set(HUGE_VAL)), .weight = s_keep(any, s_set(1)) };
    s.weighs = source->weight || source->radiant || light->attenuated || light->is_spot;
    if (source->weight)
        s.weight = s_keep(any, s_level(d_load(source->weight + i)));
    for (int c = 0; c < 3; c++) {
        const vs to = { d_load(source->position[c] + i), d_set(turned ? light->position[c].slope : 0), !turned };
        s.direction[c] = s_keep(moving, light->directional ? s_keep(moving, to) : s_keep(moving, s_sub(to, point[c])));
    }
    if (!light->directional) {
        const vs length2 = s_dot(s.direction, s.direction);
        const vs_length length = s_length(length2);
        const vs inverse = s_keep(moving, length.inverse);
        s.distance = s_keep(moving, length.whole);
        if (source->radiant)
            s.weight = s_keep(any, s_mul(s.weight, surface_weight(source, s.direction, length2, s.distance, i)));
        for (int c = 0; c < 3; c++)
            s.direction[c] = s_keep(moving, s_mul(s.direction[c], inverse));
    }
    s.weight = weaken(light, &s, slopes);
    s.cosine = s_dot(s.direction, normal);
    return s;
}

/// Returns the program's result for value `which`, or `own` if there is none.
INNER vs take_plane(const glint_derivative_planes *planes, int which, const unsigned slopes, int i, vs own)
{
    const bool other = slopes & SLOPES_OTHER;
    if (!planes || !planes->value[which])
        return s_keep(other, own);
    const vd slope = planes->slope[which] ? d_load(planes->slope[which] + i) : d_set(0);
    return (vs) { d_load(planes->value[which] + i), slope, !other };
}

/// Returns S of Phong and Blinn-Phong.
INNER vs power_lanes(const glint_derivative_material *material, vs shininess, const shine_lanes *s, const vs normal[3],
                    const vs eye[3])
{
    vs x;
    if (material->highlight == GLINT_HIGHLIGHT_PHONG) {
        const vs twice = s_mul(s_dot(normal, eye), s_set(2));
        x = s_keep(!s->cosine.level, s_sub(s_mul(s->cosine, twice), s_dot(s->direction, eye)));
    } else {
        vs h[3];
        for (int c = 0; c < 3; c++)
            h[c] = s_add(s->direction[c], eye[c]);
        x = s_keep(!s->cosine.level, s_div(s_dot(h, normal), s_sqrt(s_dot(h, h))));
    }
    const vs strength = s_pow(x, shininess);
    return material->lobe == GLINT_LOBE_POWER_COSINE ? s_keep(true, s_mul(strength, s->cosine)) : s_keep(true, strength);
}

/// Returns Smith's masking for Beckmann's distribution: x times Lambda at the cosine x; see stages/ref/shade.h.
INNER vs mask_lanes(vs alpha, vs x)
{
    const vs zero = s_set(0), one = s_set(1), rest = s_sub(one, s_mul(x, x));
    const vs s = s_mul(alpha, s_sqrt(s_max(rest, zero))), q = s_div(x, s);
    const vs up = s_mul(s, s_add(s_mul(s_sub(s_mul(q, s_set(0.396)), s_set(1.259)), q), one));
    const vs down = s_add(s_mul(q, s_set(2.181)), s_set(3.535));
    return s_select(d_lt(q.v, d_set(1.6)), s_div(up, down), zero);
}

/// Returns the factor D G / (4 n.v) of pi D F G / (4 n.v) n.l, as in stages/ref/shade.h; `sine2`: squared sine of the
/// angle between n and h.
INNER vs facet_lanes(const glint_derivative_material *material, vs alpha, vs sine2, vs l, vs v)
{
    const vs one = s_set(1), aa = s_mul(alpha, alpha), floor = s_set(0x1p-126), cosine2 = s_sub(one, sine2);
    if (material->lobe == GLINT_LOBE_GGX) {
        const vs b = s_sub(one, aa), u = s_div(alpha, s_add(sine2, s_mul(aa, cosine2)));
        const vs to_light = s_mul(l, s_sqrt(s_add(aa, s_mul(b, s_mul(v, v)))));
        const vs d = s_add(to_light, s_mul(v, s_sqrt(s_add(aa, s_mul(b, s_mul(l, l))))));
        return s_keep(true, s_mul(s_mul(u, u), s_div(s_mul(l, s_set(0.5)), s_max(d, floor))));
    }
    const vs c = s_max(cosine2, s_set(0x1p-40));
    const vs y = s_div(s_mul(s_div(sine2, c), s_set(-0x1.71547652b82fep+0)), aa); // the factor is -log2(e)
    const vd e = d_exp2(y.v);
    const vs spread = { e, (e * d_set(0x1.62e42fefa39efp-1)) * y.d, y.level };
    const vs masked = s_add(s_mul(v, mask_lanes(alpha, l)), s_mul(l, mask_lanes(alpha, v)));
    const vs d = s_add(s_mul(l, v), masked);
    return s_keep(true, s_mul(s_div(s_div(s_div(spread, c), c), aa), s_div(s_mul(l, s_set(0.25)), s_max(d, floor))));
}

/// Computes S of microfacets, and S times Schlick's (1 - v.h)^5.
INNER void lobe_lanes(const glint_derivative_material *material, vs alpha, const shine_lanes *s, const vs normal[3],
                     const vs eye[3], vs *specular, vs *grazing)
{
    const vs zero = s_set(0), one = s_set(1);
    vs h[3], across[3];
    for (int c = 0; c < 3; c++)
        h[c] = s_add(s->direction[c], eye[c]);
    for (int c = 0; c < 3; c++) {
        const int a = (c + 1) % 3, b = (c + 2) % 3;
        across[c] = s_sub(s_mul(h[b], normal[a]), s_mul(h[a], normal[b]));
    }
    const vs h2 = s_dot(h, h), sine2 = s_min(s_div(s_dot(across, across), h2), one);
    const vs l = s_min(s->cosine, one);
    const vs v = s_max(s_min(s_dot(normal, eye), one), zero); // a bumped normal may face away; see effects/microfacet/ref.h
    const vs lobe = facet_lanes(material, alpha, sine2, l, v);
    const vs z = s_min(s_mul(s_add(one, s_dot(s->direction, eye)), s_set(0.5)), one);
    const vs m = s_sub(one, s_sqrt(s_max(z, zero))), mm = s_mul(m, m);
    const dm there = d_lt(zero.v, h2.v);
    *specular = s_keep(true, s_select(there, lobe, zero));
    *grazing = s_keep(true, s_select(there, s_mul(lobe, s_mul(s_mul(mm, mm), m)), zero));
}

/// The products of a light's colours and a material's reflectances.
typedef struct shared_colors {
    vs diffuse[3], specular[3], grazing[3];
} shared_colors;

INNER shared_colors share_colors(const glint_slope_args *args, const unsigned slopes)
{
    const glint_derivative_light *light = args->light;
    const glint_derivative_material *m = args->material;
    const bool other = slopes & SLOPES_OTHER;
    shared_colors out;
    for (int c = 0; c < 3; c++) {
        const vs shiny = s_of(other, light->specular[c]);
        out.diffuse[c] = s_mul(s_of(other, m->diffuse[c]), s_of(other, light->diffuse[c]));
        out.specular[c] = s_mul(s_of(other, m->specular[c]), shiny);
        out.grazing[c] = s_mul(s_of(other, m->grazing[c]), shiny);
    }
    return out;
}

/// Returns the light that VD lanes reflect, in channel c.
INNER vs reflected_light(const glint_slope_args *args, const shared_colors *k, const shine_lanes *s, vs specular,
                         vs grazing, const unsigned slopes, int c, int i)
{
    const glint_derivative_source *source = args->source;
    const vs one = s_set(1);
    vs light_out = s_keep(true, s_mul(k->diffuse[c], s->cosine));
    if (args->planes)
        light_out = s_keep(true, s_mul(light_out, take_plane(args->planes, GLINT_DERIVED_DIFFUSE + c, slopes, i, one)));
    if (args->material->highlight != GLINT_HIGHLIGHT_NONE) {
        vs shiny = s_keep(true, s_mul(k->specular[c], specular));
        if (args->material->highlight == GLINT_HIGHLIGHT_FACETS)
            shiny = s_keep(true, s_add(shiny, s_mul(k->grazing[c], grazing)));
        if (args->planes)
            shiny = s_keep(true, s_mul(shiny, take_plane(args->planes, GLINT_DERIVED_SPECULAR + c, slopes, i, one)));
        light_out = s_keep(true, s_add(light_out, shiny));
    }
    if (s->weighs)
        light_out = s_keep(true, s_mul(light_out, s->weight));
    if (source->tint[0])
        light_out = s_keep(true, s_mul(light_out, s_load(source->tint[c], source->tint_slope[c], true, i)));
    return light_out;
}

INNER void slope_lanes(const glint_slope_args *args, const shared_colors *k, const unsigned slopes, int i)
{
    const glint_derivative_material *m = args->material;
    const bool other = slopes & SLOPES_OTHER;
    const dm reached = dm_from_bits(args->lanes >> i & D_ALL);
    vs specular = s_keep(true, s_set(0)), grazing = s_keep(true, s_set(0));
    const seen_lanes seen = seen_points(args->points, slopes, i);
    const shine_lanes s = find_shine(args->light, args->source, seen.point, seen.normal, slopes, i);
    if (m->highlight == GLINT_HIGHLIGHT_FACETS) {
        const vs alpha = take_plane(args->planes, GLINT_DERIVED_ALPHA, slopes, i, s_of(other, m->alpha));
        lobe_lanes(m, alpha, &s, seen.normal, seen.eye, &specular, &grazing);
    } else if (m->highlight != GLINT_HIGHLIGHT_NONE) {
        const vs power = take_plane(args->planes, GLINT_DERIVED_SHININESS, slopes, i, s_of(other, m->shininess));
        specular = power_lanes(m, power, &s, seen.normal, seen.eye);
    }
    for (int c = 0; c < 3; c++) {
        const vs light_out = reflected_light(args, k, &s, specular, grazing, slopes, c, i);
        d_store(args->sum[c] + i, d_load(args->sum[c] + i) + d_select(reached, light_out.d, d_set(0)));
        if (args->whole[0])
            d_store(args->whole[c] + i, d_load(args->whole[c] + i) + d_select(reached, light_out.v, d_set(0)));
    }
}

INNER void slope_group(const glint_slope_args *args, const unsigned slopes)
{
    const shared_colors k = share_colors(args, slopes);
    for (int i = 0; i < GLINT_GROUP; i += VD)
        if (args->lanes >> i & D_ALL)
            slope_lanes(args, &k, slopes, i);
}

static void slope(const glint_slope_args *args)
{
    const bool bent = args->points->slope[0][0], turned = args->light->turns;
    const bool other = args->light->shines || args->material->varies || args->planes || args->source->tint[0];
    if (bent && (turned || other))
        slope_group(args, SLOPES_ALL);
    else if (bent)
        slope_group(args, SLOPES_BENT);
    else if (turned && other)
        slope_group(args, SLOPES_TURNED | SLOPES_OTHER);
    else if (turned)
        slope_group(args, SLOPES_TURNED);
    else
        slope_group(args, SLOPES_OTHER);
}

INNER void arrival_group(const glint_arrival_args *args, const unsigned slopes)
{
    const glint_arrival_args call = *args; // a copy, because stores might change it
    const glint_derivative_source *source = call.source;
    const bool any = slopes, other = slopes & SLOPES_OTHER;
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        const seen_lanes seen = seen_points(call.points, slopes, i);
        const shine_lanes s = find_shine(call.light, source, seen.point, seen.normal, slopes, i);
        vs all[GLINT_ARRIVAL_COUNT] = { s.direction[0], s.direction[1], s.direction[2], s.weight,
                                        s.weight,       s.weight,       s.distance };
        for (int c = 0; c < 3; c++) {
            all[3 + c] = s_keep(any, s_mul(s_of(other, call.light->diffuse[c]), s.weight));
            if (source->tint[0])
                all[3 + c] = s_keep(any, s_mul(all[3 + c], s_load(source->tint[c], source->tint_slope[c], other, i)));
        }
        for (int n = 0; n < GLINT_ARRIVAL_COUNT; n++) {
            if (call.value[n])
                d_store(call.value[n] + i, all[n].v);
            if (any && call.slope[n])
                d_store(call.slope[n] + i, all[n].level ? d_set(0) : all[n].d);
        }
    }
}

static void arrival(const glint_arrival_args *args)
{
    const bool bent = args->points->slope[0][0], turned = args->light->turns;
    const bool other = args->light->shines || args->source->tint[0];
    bool sloped = false;
    for (int n = 0; n < GLINT_ARRIVAL_COUNT; n++)
        sloped = sloped || args->slope[n];
    if (!sloped)
        arrival_group(args, 0);
    else if (bent && !turned && !other)
        arrival_group(args, SLOPES_BENT);
    else if (bent)
        arrival_group(args, SLOPES_ALL);
    else
        arrival_group(args, SLOPES_TURNED | SLOPES_OTHER);
}

static void eyes(const glint_eyes_args *args)
{
    const glint_eyes_args call = *args; // a copy, because stores might change it
    for (int i = 0; i < GLINT_GROUP; i += VD) {
        vd d[3];
        for (int c = 0; c < 3; c++)
            d[c] = d_load(call.direction + c * GLINT_GROUP + i);
        for (int c = 0; c < 3 && call.more; c++)
            d[c] = d[c] + d_load(call.more + c * GLINT_GROUP + i);
        const vd inverse = d_set(-1) / d_sqrt(DOT(d, d));
        for (int c = 0; c < 3; c++)
            d_store(call.eye[c] + i, d[c] * inverse);
    }
}

#endif
