// light: the effect of a light at points: one light, several lights that differ only in position, a spot, or the
// samples of an area light. The geometry is real; square root, division and logarithm follow in float, because float
// is accurate enough for them. The points come from memory here, and from the hits in lit_surface.h; the results are
// stored here, and added up in soft_light.h. Contract: stages.h.
#ifndef GLINT_LIGHT_LIGHT_H
#define GLINT_LIGHT_LIGHT_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/light/cone.h"
#include "engine/render/stages/light/light_sample.h"
#include "engine/render/stages/simd/real.h"

#define LIT_PARTS (VF / VR) ///< number of vectors of real per vector of float
#define LIT_LANES ((1u << VF) - 1) ///< all lanes of a vector of float

INNER vf R(join)(const vr *x)
{
#if GLINT_REAL == 64
    return f_join(x[0], x[1]);
#else
    return x[0];
#endif
}

INNER unsigned R(join_bits)(const rm mask[LIT_PARTS])
{
    unsigned bits = 0;
    for (int j = 0; j < LIT_PARTS; j++)
        bits |= rm_bits(mask[j]) << j * VR;
    return bits;
}

/// The highlights of a group's lanes.
typedef struct R(gloss) {
    unsigned phong, blinn, cosine; ///< lanes whose material has a Phong highlight; a Blinn-Phong highlight; a lobe
        ///< with the factor n.l
    _Alignas(64) float shininess[GLINT_GROUP];
    _Alignas(64) float least[GLINT_GROUP]; ///< `least` of each lane's material, if `sparing`; otherwise 0
} R(gloss);

/// VF points of a group.
typedef struct R(lit_points) {
    vr point[LIT_PARTS][3], normal[LIT_PARTS][3];
    vr direction[LIT_PARTS][3], a[LIT_PARTS], nv[LIT_PARTS]; ///< a = length2(direction); only set if a lane is glossy
} R(lit_points);

/// The effect of a light or sample at VF points.
typedef struct R(lit_lanes) {
    unsigned ahead, lit, shiny; ///< lanes that have the light above their horizon; of these, the lanes that
        ///< it may reach; of these, the lanes with a highlight
    vf cosine, weight, log2; ///< n.l, attenuation, and log2 of r.v or n.h
} R(lit_lanes);

// ---- The highlight ----

/// Computes (r.v)^2 as num / den. Returns the lanes with a highlight.
INNER rm R(phong_parts)(vr nl, vr nv, vr lv, vr l2a, vr *num, vr *den)
{
    vr rv = (r_set(2) * nl) * nv - lv;
    *num = rv * rv;
    *den = l2a;
    return r_lt(r_set(0), rv);
}

/// Computes (n.h)^2 as num / den, both from the same h. Returns the lanes with a highlight. At grazing light h is a
/// difference with few digits left: if it were rounded differently in num and den, the error would grow by 1 / |h|^2,
/// and then by the shininess.
INNER rm R(blinn_parts)(const vr n[3], const vr l[3], const vr d[3], vr l2, vr a, vr *num, vr *den)
{
    const vr w = r_sqrt(l2 * a);
    const vr h[3] = { a * l[0] - w * d[0], a * l[1] - w * d[1], a * l[2] - w * d[2] };
    const vr nh = DOT(n, h);
    *num = nh * nh;
    *den = DOT(h, h);
    return rm_and(r_lt(r_set(0), nh), r_lt(r_set(0), *den));
}

/// Computes the lit lanes with a highlight, and log2 of r.v or n.h there. i: the first lane's number in the group.
INNER void R(find_highlight)(const R(gloss) * gloss, const R(lit_points) * p, int i, vr l[LIT_PARTS][3],
                             const vr l2[LIT_PARTS], const vr nl[LIT_PARTS], R(lit_lanes) * out)
{
    const unsigned phong = gloss->phong >> i & out->lit, blinn = GLINT_WITH(BLINN) ? gloss->blinn >> i & out->lit : 0;
    vr num[LIT_PARTS], den[LIT_PARTS], x[LIT_PARTS], less_1[LIT_PARTS];
    rm some[LIT_PARTS];
    if (!(phong | blinn))
        return;
    for (int j = 0; j < LIT_PARTS; j++) {
        const unsigned blinn_lanes = blinn >> j * VR & ((1u << VR) - 1);
        some[j] = R(phong_parts)(nl[j], p->nv[j], -DOT(l[j], p->direction[j]), l2[j] * p->a[j], &num[j], &den[j]);
        if (blinn_lanes) {
            vr blinn_num, blinn_den;
            const rm mask = rm_from_bits(blinn_lanes);
            const rm bright =
                R(blinn_parts)(p->normal[j], l[j], p->direction[j], l2[j], p->a[j], &blinn_num, &blinn_den);
            some[j] = rm_or(rm_and(mask, bright), rm_andnot(some[j], mask));
            num[j] = r_select(mask, blinn_num, num[j]);
            den[j] = r_select(mask, blinn_den, den[j]);
        }
        // NaN, and lanes in which den overflows, stay, and the division handles them
        some[j] = rm_andnot(some[j], r_lt(num[j], R(load_wide)(gloss->least + i + j * VR) * den[j]));
    }
    if (!(R(join_bits)(some) & (phong | blinn)))
        return;
    for (int j = 0; j < LIT_PARTS; j++) {
        x[j] = r_min(num[j] / den[j], r_set(1));
        less_1[j] = x[j] - r_set(1);
        some[j] = rm_and(some[j], r_le(r_set(0x1p-126), x[j]));
    }
    out->shiny = R(join_bits)(some) & (phong | blinn);
    const fm shiny = fm_from_bits(out->shiny);
    const vf log2 = f_set(0.5f) * f_log2(f_select(shiny, R(join)(x), f_set(1)), R(join)(less_1));
    out->log2 = f_select(shiny, log2, f_set(GLINT_NO_SPECULAR));
}

// ---- One light ----

/// Computes the vectors l from the points to light or sample s.
INNER void R(aim)(const glint_light_args *args, const int kind, uint32_t s, const R(light_sample_set) * samples, int i,
                  const R(lit_points) * p, vr l[LIT_PARTS][3])
{
    const double *position = kind == LIGHT_PLAIN && args->positions[0] ? args->positions[s] : args->position;
    const bool directional = kind <= LIGHT_SPOT && args->directional;
    const real scale = (real)args->scale;
    const bool between = kind != LIGHT_CONE && !directional;
    for (int j = 0; j < LIT_PARTS; j++)
        for (int k = 0; k < 3; k++) {
            if (kind == LIGHT_CONE)
                l[j][k] = r_load(samples->direction[s][k] + i + j * VR);
            else if (kind == LIGHT_SAMPLE)
                l[j][k] = r_load(samples->light_sample[s].position[k] + i + j * VR);
            else
                l[j][k] = r_set(position[k]);
        }
    for (int j = 0; between && j < LIT_PARTS; j++)
        for (int k = 0; k < 3; k++)
            l[j][k] = l[j][k] - p->point[j][k];
    for (int j = 0; between && scale != 1 && j < LIT_PARTS; j++) // only very large or small scenes are scaled
        for (int k = 0; k < 3; k++)
            l[j][k] = l[j][k] * r_set(scale);
}

/// Returns the attenuation, 1 / (c0 + (c1 d + c2 d^2)), with the factors of area lights. m: as computed by in_front.
INNER vf R(attenuate)(const glint_light_args *args, const int kind, const bool radiant, uint32_t s,
                      const R(light_sample_set) * samples, int i, const vr l2[LIT_PARTS], const vr m[LIT_PARTS])
{
    const vr c0 = r_set(args->coefficients[0]), c1 = r_set(args->coefficients[1]), c2 = r_set(args->coefficients[2]);
    vr w[LIT_PARTS];
    for (int j = 0; j < LIT_PARTS; j++) {
        vr d;
        if (kind == LIGHT_CONE)
            d = r_load(samples->far[s] + i + j * VR);
        else
            d = r_sqrt(l2[j]) / r_set(args->scale);
        w[j] = r_set(1) / (c0 + (c1 * d + c2 * (d * d)));
        if (radiant)
            w[j] = w[j] * (m[j] / (l2[j] * r_sqrt(l2[j])));
        if (kind == LIGHT_CONE)
            w[j] = w[j] * r_load(samples->weight + i + j * VR);
    }
    return f_min(R(join)(w), f_set(GLINT_ATTENUATION_MAX));
}

/// Computes light or sample s at the points of the lanes from i on. open: the lanes that the light may
/// reach. Constants: kind; glossy: whether some lane may have a highlight.
INNER R(lit_lanes) R(light_lanes)(const glint_light_args *args, const int kind, const bool glossy, uint32_t s,
                                  const R(light_sample_set) * samples, const R(gloss) * gloss, const R(lit_points) * p,
                                  int i, unsigned open)
{
    const uint32_t emission = kind == LIGHT_SAMPLE ? args->light_sample[0]->emission : GLINT_EMIT_ALL;
    const bool directional = kind <= LIGHT_SPOT && args->directional;
    vr l[LIT_PARTS][3], l2[LIT_PARTS], nl[LIT_PARTS], m[LIT_PARTS], cone[3][LIT_PARTS];
    rm ahead[LIT_PARTS];
    R(aim)(args, kind, s, samples, i, p, l);
    for (int j = 0; j < LIT_PARTS; j++) {
        l2[j] = DOT(l[j], l[j]);
        nl[j] = DOT(p->normal[j], l[j]);
        ahead[j] = r_lt(r_set(0), nl[j]);
        m[j] = r_set(0);
        if (kind == LIGHT_SPOT)
            ahead[j] = rm_and(ahead[j], R(in_cone)(args->spot, l[j], l2[j], &cone[0][j], &cone[1][j], &cone[2][j]));
        if (emission != GLINT_EMIT_ALL)
            ahead[j] = rm_and(ahead[j], R(in_front)(emission, &samples->light_sample[s], i + j * VR, l[j], &m[j]));
    }
    R(lit_lanes) out = { .ahead = R(join_bits)(ahead), .weight = f_set(1), .log2 = f_set(GLINT_NO_SPECULAR) };
    out.lit = out.ahead & open;
    if (!out.lit)
        return out;
    out.cosine = R(join)(nl);
    if (!directional)
        out.cosine = out.cosine / f_sqrt(R(join)(l2));
    out.cosine = f_min(out.cosine, f_set(1));
    if (args->attenuated)
        out.weight = R(attenuate)(args, kind, emission > GLINT_EMIT_FRONT, s, samples, i, l2, m);
    if (kind == LIGHT_SPOT)
        out.weight = out.weight * R(cone_factor)(args->spot, fm_from_bits(out.lit), R(join)(cone[0]), R(join)(cone[1]),
                                                 R(join)(cone[2]));
    if (glossy)
        R(find_highlight)(gloss, p, i, l, l2, nl, &out);
    return out;
}

// ---- The lights of a group ----

/// Stores the results of light or sample s for the lanes from at on.
INNER void R(store_lit)(const glint_light_args *args, uint32_t s, size_t at, const R(lit_lanes) * lanes)
{
    const fm lit = fm_from_bits(lanes->lit);
    f_store(args->cosine[s] + at, f_select(lit, lanes->cosine, f_set(0)));
    if (args->attenuated)
        f_store(args->attenuation[s] + at, f_select(lit, lanes->weight, f_set(0)));
    if (args->highlights)
        f_store(args->log2_specular[s] + at, lanes->log2);
}

/// Stores the lit lanes of a group, and the results of its vectors without lit lanes, which are not computed.
INNER void R(end_lit)(const glint_light_args *args, uint32_t s, uint32_t g, unsigned lit)
{
    const R(lit_lanes) none = { .lit = 0, .cosine = f_set(0), .weight = f_set(0), .log2 = f_set(GLINT_NO_SPECULAR) };
    args->lit[s][g] = (uint16_t)lit;
    for (int i = 0; lit && i < GLINT_GROUP; i += VF)
        if (!(lit >> i & LIT_LANES))
            R(store_lit)(args, s, (size_t)g * GLINT_GROUP + (size_t)i, &none);
}

INNER void R(say_brightest)(const glint_light_args *args, uint32_t s, vf brightest)
{
    if (args->highlights && args->brightest[s])
        *args->brightest[s] = f_max_all(brightest);
}

/// Sets the highlight of lanes that show one material.
INNER void R(sort_lanes)(const glint_light_args *args, const glint_shade_material *material, unsigned lanes,
                         R(gloss) * gloss)
{
    if (material->highlight == GLINT_HIGHLIGHT_PHONG)
        gloss->phong |= lanes;
    else if (GLINT_WITH(BLINN) && material->highlight == GLINT_HIGHLIGHT_BLINN)
        gloss->blinn |= lanes;
    else
        return;
    gloss->cosine |= material->lobe == GLINT_LOBE_POWER_COSINE ? lanes : 0;
    const vf least = f_set(args->sparing ? material->least : 0);
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const fm mask = fm_from_bits(lanes >> i & LIT_LANES);
        f_store(gloss->shininess + i, f_select(mask, f_set(material->shininess), f_load(gloss->shininess + i)));
        f_store(gloss->least + i, f_select(mask, least, f_load(gloss->least + i)));
    }
}

/// Sets the highlights of the lanes `rest`, material by material.
INNER void R(sort_gloss)(const glint_light_args *args, size_t at, unsigned rest, R(gloss) * gloss)
{
    gloss->phong = gloss->blinn = gloss->cosine = 0;
    while (args->highlights && rest) {
        const uint32_t material = args->material[at + (unsigned)__builtin_ctz(rest)];
        const unsigned lanes = lanes_equal(args->material + at, material);
        R(sort_lanes)(args, &args->materials[material], lanes, gloss);
        rest &= ~lanes;
    }
}

/// Loads the points of the lanes from i on and the rays that hit them.
INNER void R(load_points)(const glint_light_args *args, R(group_cursor) cursor, int i, R(lit_points) * p)
{
    const size_t at = (size_t)cursor.g * GLINT_GROUP;
    const R(group_directions) directions = R(directions_of)(args->camera, cursor.x, cursor.y);
    for (int j = 0; j < LIT_PARTS; j++) {
        R(load3)(args->point, at + (size_t)(i + j * VR), p->point[j]);
        R(load3)(args->normal, at + (size_t)(i + j * VR), p->normal[j]);
        R(load_direction)(directions, args->direction, at, i + j * VR, p->direction[j]);
        p->a[j] = DOT(p->direction[j], p->direction[j]);
        p->nv[j] = -DOT(p->normal[j], p->direction[j]);
    }
}

/// Computes all lights at the points of the lanes from i on. `kind` is a constant.
INNER void R(light_points)(const glint_light_args *args, const int kind, const R(light_sample_set) * samples,
                           const R(gloss) * gloss, R(group_cursor) cursor, int i, unsigned open, unsigned lit[],
                           vf brightest[])
{
    R(lit_points) p;
    R(load_points)(args, cursor, i, &p);
    for (uint32_t s = 0; s < args->sample_count; s++) {
        const R(lit_lanes) lanes = R(light_lanes)(args, kind, true, s, samples, gloss, &p, i, open >> i & LIT_LANES);
        if (!lanes.lit)
            continue;
        R(store_lit)(args, s, (size_t)cursor.g * GLINT_GROUP + (size_t)i, &lanes);
        lit[s] |= lanes.lit << i;
        brightest[s] = f_max(brightest[s], lanes.log2);
    }
}

/// Computes all lights for one group. `kind` is a constant.
INNER void R(light_group)(const glint_light_args *args, const int kind, R(light_sample_set) * samples, R(gloss) * gloss,
                          R(group_cursor) cursor, vf brightest[])
{
    const size_t at = (size_t)cursor.g * GLINT_GROUP;
    const unsigned open = args->hits[cursor.g] & ~(unsigned)args->dark[cursor.g];
    unsigned lit[GLINT_LIGHT_CHUNK];
    for (uint32_t s = 0; s < args->sample_count; s++)
        lit[s] = 0;
    if (open && kind == LIGHT_CONE)
        R(place_in_cone)(args->light_sample, args->sample_count, args->scale, args->point, args->normal, at, samples);
    if (open)
        R(sort_gloss)(args, at, open, gloss);
    for (int i = 0; open && i < GLINT_GROUP; i += VF)
        R(light_points)(args, kind, samples, gloss, cursor, i, open, lit, brightest);
    for (uint32_t s = 0; s < args->sample_count; s++)
        R(end_lit)(args, s, cursor.g, lit[s]);
}

/// Computes all groups. `kind` is a constant.
INNER void R(light_groups)(const glint_light_args *args, const int kind, R(light_sample_set) * samples)
{
    R(gloss) gloss = { .phong = 0 };
    vf brightest[GLINT_LIGHT_CHUNK];
    for (uint32_t s = 0; s < args->sample_count; s++)
        brightest[s] = f_set(GLINT_NO_SPECULAR);
    for (R(group_cursor) cursor = { 0 }; cursor.g < args->group_count; R(next_group)(args->camera, &cursor))
        R(light_group)(args, kind, samples, &gloss, cursor, brightest);
    for (uint32_t s = 0; s < args->sample_count; s++)
        R(say_brightest)(args, s, brightest[s]);
}

static void R(light_area)(const glint_light_args *args)
{
    R(light_sample_set) samples;
    R(load_light_samples)(args->light_sample, args->sample_count, &samples);
    if (R(is_cone)(args->light_sample[0]))
        R(light_groups)(args, LIGHT_CONE, &samples);
    else
        R(light_groups)(args, LIGHT_SAMPLE, &samples);
}

static void R(light)(const glint_light_args *args)
{
    if (GLINT_WITH(AREA) && args->light_sample[0])
        R(light_area)(args);
    else if (GLINT_WITH(SPOT) && args->spot)
        R(light_groups)(args, LIGHT_SPOT, NULL);
    else
        R(light_groups)(args, LIGHT_PLAIN, NULL);
}

#endif
