// plain: lights without a surface or a cone: one light, or several lights that differ only in position. Values that
// do not depend on the light are computed once for all lights. The arithmetic is the same as in light.h. Contract:
// stages.h.
#ifndef GLINT_LIGHT_PLAIN_H
#define GLINT_LIGHT_PLAIN_H

#include "engine/stages/cast/camera.h"
#include "engine/stages/light/light.h"
#include "engine/stages/light/lit_surface.h"
#include "engine/stages/simd/real.h"

/// A vector of VR points, with the data that all lights share.
typedef struct R(plain_part) {
    vr point[3], normal[3], direction[3];
    vr a, nv; ///< length2(direction), and n.v
} R(plain_part);

/// Computes (r.v)^2 or (n.h)^2 as a fraction, for one light, in the lanes of a vector that have a highlight and for
/// which `sparing` does not leave it out. `whole` has the light's other results.
INNER void R(plain_highlight)(const R(lit_point) * surface, const R(plain_part) * part, const vr l[3], int j,
                              unsigned lit, R(lit_whole) * whole)
{
    const int i = j * VR;
    const unsigned phong = surface->phong >> i & lit, blinn = GLINT_WITH_BLINN ? surface->blinn >> i & lit : 0;
    if (!(phong | blinn))
        return;
    const vr nl = whole->nl[j], l2 = whole->l2[j], lv = -DOT(l, part->direction);
    vr num, den;
    rm some = rm_and(rm_from_bits(phong), R(phong_parts)(nl, part->nv, lv, l2 * part->a, &num, &den));
    if (blinn) {
        vr blinn_num, blinn_den;
        const rm mask = rm_from_bits(blinn);
        const vr nh = R(blinn_parts)(part->normal, l, part->direction, l2, part->a, &blinn_num, &blinn_den);
        some = rm_or(some, rm_and(mask, rm_and(r_lt(r_set(0), nh), r_lt(r_set(0), blinn_den))));
        num = r_select(mask, blinn_num, num);
        den = r_select(mask, blinn_den, den);
    }
    some = rm_andnot(some, r_lt(num, R(load_wide)(surface->least + i) * den));
    whole->num[j] = num;
    whole->den[j] = den;
    whole->some |= rm_bits(some) << i;
}

/// The kinds of light positions, each compiled separately; light_plain chooses.
enum { R(PLAIN_AFAR), R(PLAIN_NEAR), R(PLAIN_SCALED) };

/// Computes one light's part in real for a group, of which the lanes of `open` may be lit. `kind` and `shiny`
/// (whether the group has highlights) are constants.
INNER void R(plain_parts)(const glint_light_args *args, const int kind, const bool shiny, const R(lit_point) * surface,
                          const R(plain_part) * parts, const double *position, unsigned open, R(lit_whole) * whole)
{
    unsigned lit = 0;
    whole->some = 0;
#pragma GCC unroll 8
    for (int j = 0; j < LIT_PARTS; j++) {
        const R(plain_part) *part = &parts[j];
        vr l[3];
        for (int k = 0; k < 3; k++) {
            l[k] = r_set(position[k]);
            if (kind != R(PLAIN_AFAR))
                l[k] = l[k] - part->point[k];
            if (kind == R(PLAIN_SCALED))
                l[k] = l[k] * r_set(args->scale);
        }
        const vr nl = whole->nl[j] = DOT(part->normal, l);
        const unsigned ahead = rm_bits(r_lt(r_set(0), nl));
        whole->l2[j] = DOT(l, l);
        lit |= ahead << j * VR;
        if (!shiny)
            continue;
        whole->num[j] = whole->den[j] = r_set(0);
        R(plain_highlight)(surface, part, l, j, ahead & open >> j * VR, whole);
    }
    whole->lit = lit & open;
}

/// Computes light s for one group.
INNER void R(plain_light)(const glint_light_args *args, const int kind, const bool shiny, R(group_cursor) cursor,
                          const R(lit_point) * surface, const R(plain_part) * parts, unsigned open, uint32_t s, vf *brightest)
{
    R(lit_whole) whole;
    R(plain_parts)
    (args, kind, shiny, surface, parts, args->positions[0] ? args->positions[s] : args->position, open, &whole);
    args->lit[s][cursor.g] = (uint16_t)whole.lit;
    if (whole.lit)
        R(finish_whole)(args, &whole, shiny, s, (size_t)cursor.g * GLINT_GROUP, brightest);
}

/// Computes all lights for one group; the lanes in `open` may be lit. `kind` is a constant.
INNER void R(plain_group)(const glint_light_args *args, const int kind, R(group_cursor) cursor, unsigned open,
                          R(lit_point) * surface, vf brightest[])
{
    const size_t at = (size_t)cursor.g * GLINT_GROUP;
    const R(group_directions) directions = R(directions_of)(args->camera, cursor.x, cursor.y);
    R(plain_part) part[LIT_PARTS];
    R(sort_highlights)(args, at, open, surface);
    for (int j = 0; j < LIT_PARTS; j++) {
        R(load3)(args->point, at + (size_t)(j * VR), part[j].point);
        R(load3)(args->normal, at + (size_t)(j * VR), part[j].normal);
        part[j].direction[0] = part[j].direction[1] = part[j].direction[2] = r_set(0);
        if (surface->phong | surface->blinn)
            R(load_direction)(directions, args->direction, at, j * VR, part[j].direction);
        part[j].a = DOT(part[j].direction, part[j].direction);
        part[j].nv = -DOT(part[j].normal, part[j].direction);
    }
    for (uint32_t s = 0; s < args->sample_count; s++) {
        if (surface->phong | surface->blinn)
            R(plain_light)(args, kind, true, cursor, surface, part, open, s, &brightest[s]);
        else
            R(plain_light)(args, kind, false, cursor, surface, part, open, s, &brightest[s]);
    }
}

/// Computes all groups. `kind` is a constant.
INNER void R(plain_groups)(const glint_light_args *args, const int kind)
{
    R(lit_point) surface = { 0 };
    vf brightest[GLINT_LIGHT_CHUNK];
    for (uint32_t s = 0; s < args->sample_count; s++)
        brightest[s] = f_set(GLINT_NO_SPECULAR);
    for (R(group_cursor) cursor = { 0 }; cursor.g < args->group_count; R(next_group)(args->camera, &cursor)) {
        const unsigned open = args->hits[cursor.g] & ~(unsigned)args->dark[cursor.g];
        for (uint32_t s = 0; s < args->sample_count && !open; s++)
            args->lit[s][cursor.g] = 0;
        if (open)
            R(plain_group)(args, kind, cursor, open, &surface, brightest);
    }
    for (uint32_t s = 0; s < args->sample_count; s++)
        R(say_brightest)(args, s, brightest[s]);
}

static void R(light_plain)(const glint_light_args *args)
{
    if (args->directional)
        R(plain_groups)(args, R(PLAIN_AFAR));
    else if ((real)args->scale == 1)
        R(plain_groups)(args, R(PLAIN_NEAR));
    else
        R(plain_groups)(args, R(PLAIN_SCALED));
}

// ---- Any light ----

static void R(light)(const glint_light_args *args)
{
    if (GLINT_WITH_AREA && args->light_sample[0])
        R(light_area)(args);
    else if (GLINT_WITH_SPOT && args->spot)
        R(light_spot)(args);
    else
        R(light_plain)(args);
}

#endif
