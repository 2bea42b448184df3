// scatter: cosine-distributed directions around normals. Contract: contract.h.
#ifndef GLINT_INDIRECT_KERNEL_SCATTER_H
#define GLINT_INDIRECT_KERNEL_SCATTER_H

#include "engine/render/effects/indirect/kernel_sequence.h"
#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/simd/real.h"

/// Computes two tangents to a normal (T. Duff et al., JCGT 6(1), 2017).
static inline void R(tangents_of)(const vr n[3], vr tangent[3], vr bitangent[3])
{
    const vr zero = r_set(0), one = r_set(1), g = r_select(r_le(zero, n[2]), one, r_set(-1));
    const vr p = r_set(-1) / (g + n[2]), q = (n[0] * n[1]) * p;
    tangent[0] = one + g * ((n[0] * n[0]) * p);
    tangent[1] = g * q;
    tangent[2] = zero - g * n[0];
    bitangent[0] = q;
    bitangent[1] = g + (n[1] * n[1]) * p;
    bitangent[2] = zero - n[1];
}

/// Maps a point of the unit square to the unit disk: the radius is sqrt(u), the angle 2 pi v.
static inline void R(disk_point)(vr u, vr v, vr *x, vr *y)
{
    const vr zero = r_set(0), one = r_set(1), magic = r_set(GLINT_ROUNDER);
    const vr a = r_set(4) * v, q = (a + magic) - magic, f = (a - q) * r_set(GLINT_HALF_PI), z = f * f;
    const vr s = f + (f * z) * (r_set(GLINT_SIN_1) +
                                z * (r_set(GLINT_SIN_2) + z * (r_set(GLINT_SIN_3) + z * r_set(GLINT_SIN_4))));
    const vr c =
        one +
        z * (r_set(GLINT_COS_1) +
             z * (r_set(GLINT_COS_2) + z * (r_set(GLINT_COS_3) + z * (r_set(GLINT_COS_4) + z * r_set(GLINT_COS_5)))));
    const rm first = r_eq(q, one), second = r_eq(q, r_set(2)), third = r_eq(q, r_set(3)), odd = rm_or(first, third);
    const vr cosine = r_select(odd, s, c), sine = r_select(odd, c, s), radius = r_sqrt(u);
    *x = radius * r_select(rm_or(first, second), zero - cosine, cosine);
    *y = radius * r_select(rm_or(second, third), zero - sine, sine);
}

static inline void R(scatter_lanes)(const glint_scatter_args *args, vr u, vr v, size_t at)
{
    const vr zero = r_set(0), one = r_set(1);
    vr n[3], x, y;
    R(load3)(args->normal, at, n);
    R(disk_point)(u, v, &x, &y);
    const vr h = r_sqrt(r_max(one - u, zero));
    vr tangent[3], bitangent[3];
    R(tangents_of)(n, tangent, bitangent);
    for (int k = 0; k < 3; k++)
        r_store((real *)args->direction[k] + at, (x * tangent[k] + y * bitangent[k]) + h * n[k]);
}

/// Computes the directions of the first `count` groups of a list; the directions of the other groups are undefined.
static void R(scatter_groups)(const glint_scatter_args *args, const uint32_t groups[DRAWN_GROUPS], uint32_t count)
{
    _Alignas(64) double points[2][DRAWN];
    _Alignas(64) real square[2][DRAWN];
    scrambled_groups(args, groups, points);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < DRAWN; i++)
            square[k][i] = (real)points[k][i];
    for (uint32_t k = 0; k < count; k++)
        for (uint32_t i = 0; i < GLINT_GROUP; i += VR) {
            const uint32_t from = k * GLINT_GROUP + i;
            const size_t at = (size_t)groups[k] * GLINT_GROUP + i;
            R(scatter_lanes)(args, r_load(square[0] + from), r_load(square[1] + from), at);
        }
}

static void R(scatter)(const glint_scatter_args *args)
{
    uint32_t groups[DRAWN_GROUPS] = { 0 }, count = 0;
    for (uint32_t g = 0; g < args->group_count; g++) {
        if (!args->wanted[g])
            continue;
        groups[count++] = g;
        if (count < DRAWN_GROUPS)
            continue;
        R(scatter_groups)(args, groups, count);
        count = 0;
    }
    if (count)
        R(scatter_groups)(args, groups, count);
}

#endif
