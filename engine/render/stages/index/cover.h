// cover: finds the groups of a tile in which a candidate may be visible, the groups that it fills, and the groups in
// which another candidate hides it. The test uses the ray through the middle of each group, and bounds for the
// group's other rays. It is float and conservative, including rounding and NaN: uncertain cases are tested pixel by
// pixel. Contract: stages.h, cast.
#ifndef GLINT_INDEX_COVER_H
#define GLINT_INDEX_COVER_H

#include "engine/render/stages/index/candidate.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

#define COVER_ACROSS (GLINT_TILE_WIDTH / 4) ///< number of columns of groups; in a set of groups, bit COVER_ACROSS y +
    ///< x is group (x, y)
#define COVER_MARGIN 1e-4 ///< relative margin of certain decisions; far above the rounding errors of float and real

_Static_assert(COVER_ACROSS == 8, "groups_between repeats a row's bits a byte each");

/// Returns the groups from column `left` to `right` and from row `top` to `bottom`, inclusive, one bit each.
static inline uint64_t R(groups_between)(int left, int right, int top, int bottom)
{
    const uint64_t rows = ((uint64_t)2 << (COVER_ACROSS * bottom + COVER_ACROSS - 1)) - ((uint64_t)1 << COVER_ACROSS * top);
    return (uint64_t)bit_range(left, right) * 0x0101010101010101 & rows;
}

static inline uint64_t R(all_groups)(const R(tile_cast) * tile)
{
    return R(groups_between)(0, tile->across - 1, 0, tile->down - 1);
}

INNER bool R(is_round)(const R(candidate) * candidate)
{
    const uint16_t kind = candidate->prim->kind;
    return kind == GLINT_PRIM_SPHERE || kind == GLINT_PRIM_SOLID || kind == GLINT_PRIM_COMBINED;
}

// ---- A candidate in all groups ----

/// Computes the cover of a sphere that does not contain the eye.
static inline void R(make_sphere_cover)(const R(tile_cast) * tile, R(candidate) * candidate)
{
    const glint_camera_args *camera = tile->args->camera;
    const glint_prim *prim = candidate->prim;
    const double f[3] = { candidate->f[0], candidate->f[1], candidate->f[2] }, ff = DOT(f, f), size = sqrt(ff);
    const double c = candidate->c;
    candidate->distant = 2.1 * glint_sphere_r2(prim) < ff;
    if (!(1e-30 < c) || !(1e-15 < glint_sphere_scale(prim) && glint_sphere_scale(prim) < 1e15))
        return;
    candidate->ahead[0] = (float)-DOT(f, camera->forward);
    candidate->ahead[1] = (float)-DOT(f, camera->right);
    candidate->ahead[2] = (float)-DOT(f, camera->up);
    candidate->sway = 4 * (fabsf(candidate->ahead[1]) + fabsf(candidate->ahead[2])) +
                      (float)(GLINT_FILTER_SLACK * size) * tile->longest;
    candidate->inner = (float)(prim->radius * glint_sphere_scale(prim) * (1 - COVER_MARGIN) - 2 * GLINT_FILTER_SLACK * size);
    candidate->power = (float)(c / glint_sphere_scale(prim));
}

/// Computes the cover of a candidate whose filter is set. No hit is certain for triangles and solids.
static void R(make_cover)(const R(tile_cast) * tile, R(candidate) * candidate)
{
    const double c = candidate->c, height = fabs(c);
    double diagonal2[2] = { 0, 0 }, s2 = 0, t2 = 0;
    candidate->outer = sqrtf(candidate->limit) * (1 + 0x1p-20f);
    candidate->inner = -1;
    candidate->power = 0;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++) {
            const double s = candidate->along_s[k], t = candidate->along_t[k], diagonal = i ? s + t : s - t;
            diagonal2[i] += diagonal * diagonal;
        }
    for (int k = 0; k < 3; k++) {
        s2 += (double)candidate->along_s[k] * (double)candidate->along_s[k];
        t2 += (double)candidate->along_t[k] * (double)candidate->along_t[k];
    }
    candidate->axis_length[0] = (float)sqrt(s2);
    candidate->axis_length[1] = (float)sqrt(t2);
    candidate->around = (float)(4.00001 * sqrt(fmax(diagonal2[0], diagonal2[1])));
    if (candidate->prim->kind == GLINT_PRIM_SPHERE) {
        R(make_sphere_cover)(tile, candidate);
    } else if (candidate->prim->kind == GLINT_PRIM_PLANE && 1e-30 < height && height < 1e30) {
        candidate->inner = 1;
        candidate->power = (float)height;
    }
}

// ---- Groups ----

/// A vector of VF groups of a tile.
typedef struct R(patches) {
    vf s, t, length; ///< screen position of the group's middle, and length of the direction there
} R(patches);

/// Returns the groups from group i on, i a multiple of VF.
INNER R(patches) R(patches_at)(const R(tile_cast) * tile, int i)
{
    static const _Alignas(
        64) float column[GLINT_GROUP] = { 0, 8, 16, 24, 32, 40, 48, 56, 0, 8, 16, 24, 32, 40, 48, 56 };
    static const _Alignas(64) float row[GLINT_GROUP] = { 0, 0, 0, 0, 0, 0, 0, 0, 8, 8, 8, 8, 8, 8, 8, 8 };
    const glint_camera_args *camera = tile->args->camera;
    const float s = (float)(2 * camera->x0 + 4 - camera->width), above = (float)(i / GLINT_GROUP * 16);
    const float t = (float)(camera->height - (2 * camera->y0 + 4)) - above;
    R(patches)
    out = { .s = f_set(s) + f_load(column + i % GLINT_GROUP), .t = f_set(t) - f_load(row + i % GLINT_GROUP) };
    out.length = f_sqrt((f_set(1) + out.s * out.s * f_set(tile->rr)) + out.t * out.t * f_set(tile->uu));
    return out;
}

INNER void R(filter_at)(const R(candidate) * candidate, const R(patches) * at, vf v[3])
{
    for (int k = 0; k < 3; k++)
        v[k] =
            (f_set(candidate->base[k]) + at->s * f_set(candidate->along_s[k])) + at->t * f_set(candidate->along_t[k]);
}

/// Returns how much an edge function varies within a group, from the middle to a corner.
INNER float R(edge_sway)(const R(candidate) * candidate, int j)
{
    return 4 * (fabsf(candidate->along_s[j]) + fabsf(candidate->along_t[j]));
}

/// Returns the groups in which all rays pass a round candidate within `inner`. v: f x d in the middle of each group.
/// |f x d|^2 - inner^2 |d|^2 changes towards a corner by at most its slope and its curvature. Along a horizon both
/// terms grow at the same rate.
INNER unsigned R(filled_groups)(const R(tile_cast) * tile, const R(candidate) * candidate, const R(patches) * at, const vf v[3])
{
    const vf inner = f_set(candidate->inner), inner2 = inner * inner, around = f_set(candidate->around);
    const vf s = inner2 * (at->s * f_set(tile->rr)), t = inner2 * (at->t * f_set(tile->uu));
    vf by_s = -s, by_t = -t;
    for (int k = 0; k < 3; k++) {
        by_s = by_s + v[k] * f_set(candidate->along_s[k]);
        by_t = by_t + v[k] * f_set(candidate->along_t[k]);
    }
    const vf middle = DOT(v, v) - inner2 * (at->length * at->length);
    const vf most = (middle + f_set(8) * (f_abs(by_s) + f_abs(by_t))) + around * around;
    return fm_bits(fm_and(f_lt(f_set(0), inner), f_lt(most, f_set(0))));
}

/// Returns the groups in which the candidate may be visible; *sure: the groups that it fills.
INNER unsigned R(cover_groups)(const R(tile_cast) * tile, const R(candidate) * candidate, const R(patches) * at,
                               unsigned *sure)
{
    const vf zero = f_set(0);
    vf v[3];
    R(filter_at)(candidate, at, v);
    if (!R(is_round)(candidate)) {
        const vf limit = f_set(candidate->limit);
        vf most = v[0] + f_set(R(edge_sway)(candidate, 0));
        for (int j = 1; j < 3; j++)
            most = f_min(most, v[j] + f_set(R(edge_sway)(candidate, j)));
        *sure = fm_bits(fm_and(f_lt(zero, f_set(candidate->inner)), f_lt(limit, v[0] - f_set(R(edge_sway)(candidate, 0)))));
        return ~fm_bits(f_lt(most, -limit)) & ((1u << VF) - 1);
    }
    const vf spread = f_set(tile->spread), around = f_set(candidate->around), off2 = DOT(v, v);
    const vf reach = f_set(candidate->outer) * (at->length + spread) + around;
    *sure = R(filled_groups)(tile, candidate, at, v);
    if (*sure) { // the candidate must be in front of the eye, not behind
        const vf b =
            (f_set(candidate->ahead[0]) + at->s * f_set(candidate->ahead[1])) + at->t * f_set(candidate->ahead[2]);
        *sure &= fm_bits(f_lt(zero, b));
    }
    return ~fm_bits(f_lt(reach * reach, off2)) & ((1u << VF) - 1);
}

/// Computes bounds of t of the hits in the groups. The upper bound only holds in groups that the candidate fills.
INNER void R(bounds_of_t)(const R(tile_cast) * tile, const R(candidate) * candidate, const R(patches) * at, vf *low,
                          vf *high)
{
    const vf zero = f_set(0), less = f_set(1 - 1e-5f), more = f_set(1 + 1e-5f), power = f_set(candidate->power);
    *low = zero;
    *high = f_set(HUGE_VALF);
    if (!(candidate->power > 0))
        return;
    if (candidate->prim->kind == GLINT_PRIM_PLANE) {
        const vf nearing =
            (f_set(candidate->base[0]) + at->s * f_set(candidate->along_s[0])) + at->t * f_set(candidate->along_t[0]);
        const vf sway = f_set(R(edge_sway)(candidate, 0) + candidate->limit);
        *low = less * (power / f_max(nearing + sway, zero));
        *high = more * (power / (nearing - sway));
        return;
    }
    const vf sway = f_set(candidate->sway), c = f_set((float)candidate->c), spread = f_set(tile->spread);
    const vf doubt = f_set(1e-5f);
    const vf b = (f_set(candidate->ahead[0]) + at->s * f_set(candidate->ahead[1])) + at->t * f_set(candidate->ahead[2]);
    const vf most = f_max(b + sway, zero), least = f_max(b - sway, zero);
    const vf longest = at->length + spread, shortest = f_max(at->length - spread, zero);
    const vf above = (most * most - shortest * shortest * c) + doubt * (most * most);
    const vf below = (least * least - longest * longest * c) - doubt * (least * least);
    *low = less * (power / (most + f_sqrt(f_max(above, zero))));
    *high = more * (power / (least + f_sqrt(f_max(below, zero))));
}

/// Removes from `may` the groups, from group i on, that another candidate fills closer to the eye.
static inline void R(leave_hidden)(const R(tile_cast) * tile, const R(candidate) *const *candidates, int count,
                                   const R(patches) * at, unsigned may[], const unsigned sure[])
{
    vf low[GLINT_FIRST_CANDIDATES], nearest = f_set(HUGE_VALF);
    for (int k = 0; k < count; k++) {
        vf high;
        if (!may[k])
            continue;
        R(bounds_of_t)(tile, candidates[k], at, &low[k], &high);
        nearest = f_select(fm_from_bits(may[k] & sure[k]), f_min(high, nearest), nearest);
    }
    for (int k = 0; k < count; k++)
        if (may[k])
            may[k] &= ~fm_bits(f_lt(nearest, low[k]));
}

/// Computes the covers of all candidates. may: in: for each candidate, the groups in which its box may be visible;
/// out: the groups in which the candidate may be visible. sure: out: the groups that the candidate fills unless
/// another one is in front of it.
static void R(cover_tile)(const R(tile_cast) * tile, const R(candidate) *const *candidates, int count, uint64_t may[],
                          uint64_t sure[])
{
    const int end = COVER_ACROSS * tile->down;
    for (int k = 0; k < count; k++)
        sure[k] = 0;
    for (int i = 0; i < end; i += VF) {
        const R(patches) at = R(patches_at)(tile, i);
        unsigned here[GLINT_FIRST_CANDIDATES], fill[GLINT_FIRST_CANDIDATES], any = 0, several = 0, filled = 0;
        for (int k = 0; k < count; k++) {
            here[k] = (unsigned)(may[k] >> i) & ((1u << VF) - 1);
            fill[k] = 0;
            if (!here[k])
                continue;
            here[k] &= R(cover_groups)(tile, candidates[k], &at, &fill[k]);
            several |= any & here[k];
            any |= here[k];
            filled |= fill[k];
        }
        if (several & filled)
            R(leave_hidden)(tile, candidates, count, &at, here, fill);
        for (int k = 0; k < count; k++) {
            may[k] = (may[k] & ~((((uint64_t)1 << VF) - 1) << i)) | (uint64_t)here[k] << i;
            sure[k] |= (uint64_t)fill[k] << i;
        }
    }
}

#endif
