// caps: the share of a sphere light that each point sees past spheres and planes, in closed form. Contract: stages.h,
// occlude.
//
// Shares are multiplied in the order of the table, whatever the order in which the index finds the spheres.
#ifndef GLINT_LIGHT_CAPS_H
#define GLINT_LIGHT_CAPS_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/occlude/occlude.h"
#include "engine/render/stages/simd/real.h"

#define GLINT_CAPS 16 ///< number of primitives that a group looks up at a time

/// The light as seen from the points of a group.
typedef struct R(light_cap) {
    _Alignas(64) real direction[3][GLINT_GROUP]; ///< unit vector towards the light's centre
    _Alignas(64) real sine[GLINT_GROUP], cosine[GLINT_GROUP]; ///< sine and cosine of half the cap's angular radius
    _Alignas(64) real power[GLINT_GROUP]; ///< squared length of a tangent to the light, in the light's units
    _Alignas(64) real visible[GLINT_GROUP]; ///< visible share of the light so far
    unsigned around; ///< lanes inside the light
} R(light_cap);

/// Returns atan2(y, x) for y, x >= 0, from the series for an eighth of the angle.
static inline vr R(angle_of)(vr y, vr x)
{
    const vr one = r_set(1);
    vr t = y / (r_sqrt(x * x + y * y) + x);
    for (int i = 0; i < 2; i++)
        t = t / (one + r_sqrt(one + t * t));
    const vr q = -(t * t);
    vr sum = r_set(1.0 / 23);
    for (int k = 10; k >= 0; k--)
        sum = sum * q + r_set(1.0 / (2 * k + 1));
    return r_set(8) * (t * sum);
}

/// Returns the cosine of half the angle whose cosine is k.
static inline vr R(half_cosine)(vr k) { return r_sqrt(r_set(0.5) + r_set(0.5) * k); }

static void R(make_light_cap)(const glint_occlude_args *args, size_t at, R(light_cap) * cap)
{
    const vr zero = r_set(0), one = r_set(1), radius = r_set(args->light_sample[0]->radius * args->scale);
    cap->around = 0;
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        vr p[3], l[3];
        R(load3)(args->point, at + i, p);
        for (int k = 0; k < 3; k++)
            l[k] = (r_set(args->position[k]) - p[k]) * r_set(args->scale);
        const vr d = r_sqrt(DOT(l, l)), power = (d - radius) * (d + radius);
        const vr cosine = R(half_cosine)(r_sqrt(r_max(power, zero)) / d);
        for (int k = 0; k < 3; k++)
            r_store(cap->direction[k] + i, l[k] / d);
        r_store(cap->cosine + i, cosine);
        r_store(cap->sine + i, r_min(radius / d, one) / (r_set(2) * cosine));
        r_store(cap->power + i, power);
        r_store(cap->visible + i, one);
        cap->around |= (rm_bits(r_lt(radius, d)) ^ ((1u << VR) - 1)) << i;
    }
}

/// Returns the share of one cap that lies inside another cap. ss, cs: sine and cosine of half the first cap's radius;
/// sa, ca: of half the other cap's radius; sg, cg: of half the angle between the centres.
static inline vr R(covered_part)(vr ss, vr cs, vr sa, vr ca, vr sg, vr cg)
{
    const vr zero = r_set(0), one = r_set(1), two = r_set(2);
    const vr sum_s = sa * cg + ca * sg, sum_c = ca * cg - sa * sg;
    const vr less_s = sg * ca - cg * sa, less_c = cg * ca + sg * sa;
    const vr x0 = ss * sum_c + cs * sum_s, x1 = cs * sum_s - ss * sum_c;
    const vr x2 = ss * less_c + cs * less_s, x3 = ss * less_c - cs * less_s;
    const rm apart = r_le(x3, zero), whole = r_le(x2, zero), within = r_le(x1, zero);
    const rm settled = rm_or(apart, rm_or(whole, within));
    vr part = r_select(within, r_min((sa / ss) * (sa / ss), one), zero);
    part = r_select(apart, zero, r_select(whole, one, part));
    if (rm_bits(settled) == (1u << VR) - 1)
        return part;
    const vr at_light = two * R(angle_of)(r_sqrt(x1 * x3), r_sqrt(x0 * x2));
    const vr at_other = two * R(angle_of)(r_sqrt(x2 * x3), r_sqrt(x0 * x1));
    const vr edges = x0 * x3 + x1 * x2, product = (ss / cs) * (sa / ca);
    const vr sine = two * (r_sqrt(x0 * x3) * r_sqrt(x1 * x2)) / edges, cosine = (x0 * x3 - x1 * x2) / edges;
    const vr excess = two * R(angle_of)(product * sine, one + product * cosine);
    const vr lens =
        (at_light + (at_other * (two * (sa * sa)) - excess) / ss / (two * ss)) / r_set(0x1.921fb54442d18p+1);
    return r_select(settled, part, r_min(r_max(lens, zero), one));
}

/// Returns the share of the light's diameter above a height over its centre, for points on the side of the plane to
/// which the light extends.
static inline double R(share_of_diameter)(double radius, double height)
{
    const double share = (radius + height) / (2 * radius);
    return share < 0 ? 0 : share > 1 ? 1 : share;
}

/// Returns how far the light's centre is inside the sphere, or in front of the plane.
static inline double R(depth_of_light)(const glint_occlude_args *args, const glint_prim *prim)
{
    double f[3];
    for (int k = 0; k < 3; k++)
        f[k] = args->position[k] - prim->center[k];
    return prim->kind == GLINT_PRIM_PLANE ? DOT(prim->normal, f) : prim->radius - sqrt(DOT(f, f));
}

/// Multiplies the group's shares by the share that a primitive leaves visible. own: lanes with points on it.
static void R(cover)(const glint_occlude_args *args, const glint_prim *prim, size_t at, unsigned own, unsigned lit,
                     R(light_cap) * cap)
{
    const bool plane = prim->kind == GLINT_PRIM_PLANE;
    const unsigned all = (1u << VR) - 1, back = args->back[at / GLINT_GROUP];
    const double radius = args->light_sample[0]->radius, depth = R(depth_of_light)(args, prim);
    const vr zero = r_set(0), one = r_set(1), within = r_set(R(share_of_diameter)(radius, depth));
    const vr behind = r_set(R(share_of_diameter)(radius, -depth)), unit = r_set(plane ? 1 : args->scale / glint_sphere_scale(prim));
    const unsigned wanted = lit & ~(cap->around | (plane ? own : own & ~back));
    *args->overlaps += (unsigned)__builtin_popcount(wanted);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const rm lanes = rm_from_bits(wanted >> i & all), mine = rm_from_bits(own >> i & all);
        vr p[3], f[3], share;
        if (!(wanted >> i & all))
            continue;
        R(load3)(args->point, at + i, p);
        R(offset)(p, prim, f);
        const vr c = R(point_constant)(f, prim);
        if (plane) {
            share = r_select(r_lt(zero, c), within, r_select(r_lt(c, zero), behind, one));
        } else {
            const vr d = r_sqrt(DOT(f, f)), cosine = R(half_cosine)(r_sqrt(r_max(c, zero)) / d);
            const vr sine = r_min(r_set(prim->radius * glint_sphere_scale(prim)) / d, one) / (r_set(2) * cosine);
            vr apart[3], along[3];
            for (int k = 0; k < 3; k++) {
                const vr u = r_load(cap->direction[k] + i), v = -f[k] / d;
                apart[k] = u - v;
                along[k] = u + v;
            }
            const vr covered =
                R(covered_part)(r_load(cap->sine + i), r_load(cap->cosine + i), sine, cosine,
                                r_set(0.5) * r_sqrt(DOT(apart, apart)), r_set(0.5) * r_sqrt(DOT(along, along)));
            const rm before = r_lt((c * unit) * unit, r_load(cap->power + i));
            share = r_select(before, one - covered, one);
            share = r_select(rm_or(mine, r_lt(c, zero)), within, share);
        }
        const vr visible = r_load(cap->visible + i);
        r_store(cap->visible + i, r_select(lanes, visible * share, visible));
    }
}

/// Adds a primitive to the sorted list of the first GLINT_CAPS primitives from `from` on. Returns the list's length.
static int R(add_cap)(uint32_t id, uint32_t from, uint32_t ids[GLINT_CAPS], int count)
{
    if (id < from || (count == GLINT_CAPS && id > ids[count - 1]))
        return count;
    int at = count < GLINT_CAPS ? count++ : GLINT_CAPS - 1;
    for (; at > 0 && ids[at - 1] > id; at--)
        ids[at] = ids[at - 1];
    ids[at] = id;
    return count;
}

/// Lists the first GLINT_CAPS primitives from `from` on that may occlude the light, in the table's order. lower, upper:
/// the box of the points. Returns their number.
static int R(find_caps)(const R(shadow_tile) * tile, const float lower[3], const float upper[3], uint32_t from,
                        uint32_t ids[GLINT_CAPS])
{
    const glint_geometry_table *geometry = tile->args->geometry;
    const glint_node *node;
    shaft_walk walk;
    unsigned prims;
    int count = 0;
    for (uint32_t i = 0; i < geometry->unbounded_count; i++)
        count = R(add_cap)(geometry->unbounded[i], from, ids, count);
    begin_shaft_walk(&walk, geometry->nodes, lower, upper, &tile->light);
    while ((node = next_in_shaft(&walk, &prims)))
        for (; prims; prims &= prims - 1)
            count = R(add_cap)(node->child[__builtin_ctz(prims)] & ~GLINT_NODE_PRIM, from, ids, count);
    return count;
}

/// Computes the bounding box of a group's lanes, enlarged by rounding errors.
static void R(group_box)(const R(shadow_tile) * tile, R(shadow_group) * group, unsigned lanes, float lower[3],
                         float upper[3])
{
    R(place_group)(tile, group);
    for (int k = 0; k < 3; k++) {
        vf least = f_set(HUGE_VALF), most = f_set(-HUGE_VALF);
        widen(group->local[k], lanes, &least, &most);
        lower[k] = f_min_all(least);
        upper[k] = f_max_all(most);
    }
    loosen(lower, upper, R(walk_slack)(tile->args->geometry));
}

/// Computes the shares of one group. Returns the lanes with a share above 0.
static unsigned R(caps_of_group)(const R(shadow_tile) * tile, uint32_t g, unsigned lit, R(light_cap) * cap)
{
    const glint_occlude_args *args = tile->args;
    R(shadow_group) group = { .last_blocker = GLINT_MISS };
    float lower[3], upper[3];
    uint32_t ids[GLINT_CAPS], from = 0;
    int count;
    R(begin_group)(g, &group);
    R(make_light_cap)(args, group.at, cap);
    R(group_box)(tile, &group, lit, lower, upper);
    do {
        count = R(find_caps)(tile, lower, upper, from, ids);
        for (int k = 0; k < count; k++) {
            const glint_prim *prim = &args->geometry->prims[ids[k]];
            const unsigned own = lanes_equal(args->prim + group.at, ids[k]) & lit;
            R(cover)(args, prim, group.at, own, lit, cap);
        }
        from = count ? ids[count - 1] + 1 : 0;
    } while (count == GLINT_CAPS && !is_stopped(args->stop));
    unsigned unoccluded = 0;
    for (int i = 0; i < GLINT_GROUP; i += VR)
        unoccluded |= rm_bits(r_lt(r_set(0), r_load(cap->visible + i))) << i;
    return unoccluded & lit;
}

static __attribute__((noinline)) void R(occlude_caps)(const glint_occlude_args *args)
{
    R(shadow_tile) tile;
    R(light_cap) cap;
    const uint16_t *lit = args->lit[0];
    R(begin_shadows)(args, lit, &tile);
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        unsigned unoccluded = lit[g];
        for (int i = 0; i < GLINT_GROUP; i++)
            args->visible[at + (size_t)i] = (float)(lit[g] >> i & 1);
        if (lit[g] && tile.count > 0) {
            unoccluded = R(caps_of_group)(&tile, g, lit[g], &cap);
            for (unsigned bits = lit[g]; bits; bits &= bits - 1)
                args->visible[at + (unsigned)__builtin_ctz(bits)] = (float)cap.visible[__builtin_ctz(bits)];
        }
        args->unoccluded[0][g] = (uint16_t)unoccluded;
    }
}

#endif
