// blocked: decides whether a surface is between a point and a light. A float test decides the certain cases of
// spheres, and selects solids near the segment. The other cases are decided along the segment from the point to the
// light. For spheres this needs no root and no division: the segment crosses a sphere if one end is inside and the
// other outside, or if both are outside, the foot of the perpendicular lies between them and the discriminant is not
// negative. Contract: stages.h, occlude.
#ifndef GLINT_OCCLUDE_BLOCKED_H
#define GLINT_OCCLUDE_BLOCKED_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/combined.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/solid.h"
#include "engine/render/stages/cast/torus.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

#define GLINT_OCCLUDERS 32 ///< capacity of a tile's list; GLINT_OCCLUDERS_FEW for area lights, for triangles, and if
    ///< float decides
#define GLINT_OCCLUDERS_FEW 12
#define FAR_LIGHT 0x1p60 ///< in the index's units; at larger distances, squares of the distance may overflow float

/// The position of the light relative to a primitive, one bit per lane: outside (or in front), inside (or behind). A
/// light on the surface has neither bit.
typedef struct R(light_sides) {
    uint16_t outside, inside;
} R(light_sides);

/// A primitive between the tile and the light.
typedef struct R(occluder) {
    uint32_t id;
    R(light_sides) sides;
} R(occluder);

/// Data shared by the groups of one call.
typedef struct R(shadow_tile) {
    const glint_occlude_args *args;
    light_bounds light; ///< the whole light if it is an area light
    _Alignas(64) real position[3][GLINT_GROUP]; ///< for each lane, the position of the light or of its current sample
    _Alignas(64) float local_light[3][GLINT_GROUP]; ///< the same position in the index's frame
    bool far; ///< true: local_light, or numbers computed from it, may overflow
    R(occluder) occluders[GLINT_OCCLUDERS];
    int count, unbounded; ///< number of occluders, and of the unbounded ones, which come first; count above
        ///< GLINT_OCCLUDERS: too many for a list
    float lower[3], upper[3]; ///< a box around the lit points, in the index's frame
} R(shadow_tile);

/// A group's shadow rays, made when a test needs them.
typedef struct R(shadow_group) {
    size_t at;
    bool placed, made;
    _Alignas(64) float local[3][GLINT_GROUP]; ///< only set if `placed`: the points in the index's frame
    uint32_t last_blocker; ///< the last primitive that blocked a point in the groups so far, or GLINT_MISS
    R(ray_group) rays; ///< only set if `made`: the rays in the index's units; --precision float: in the light's units
    _Alignas(64) float inverse[3][GLINT_GROUP]; ///< if there are solids: one over the directions' components
} R(shadow_group);

/// Returns 1 if the light is outside or in front of the primitive, -1 if inside or behind, 0 if on it.
static int R(light_side)(const glint_occlude_args *args, const glint_prim *prim, const double position[3])
{
    double f[3], height;
    if (prim->kind == GLINT_PRIM_TRIANGLE || prim->kind == GLINT_PRIM_COMBINED)
        return 0; // decided lane by lane
    for (int k = 0; k < 3; k++)
        f[k] = position[k] - prim->center[k];
    if (prim->kind == GLINT_PRIM_SOLID)
        return args->directional || !glint_solid_holds(&args->geometry->solids[prim->item], prim->center, position) ? 1 : -1;
    if (prim->kind == GLINT_PRIM_PLANE) {
        height = args->directional ? DOT(prim->normal, position) : DOT(prim->normal, f);
    } else {
        for (int k = 0; k < 3; k++)
            f[k] *= glint_sphere_scale(prim);
        const double length2 = DOT(f, f); // its error is a few roundings
        if (args->directional || !(length2 < glint_sphere_r2(prim) * (1 + 1e-12)))
            return 1;
        if (length2 < glint_sphere_r2(prim) * (1 - 1e-12))
            return -1;
        const vd v[3] = { d_set(f[0]), d_set(f[1]), d_set(f[2]) };
        _Alignas(64) double c[VD];
        d_store(c, d_exact_power(v, d_set(glint_sphere_r2(prim)), d_set(glint_sphere_r2_low(prim))));
        height = c[0];
    }
    return (height > 0) - (height < 0);
}

/// Returns the sides of the light. `target`: positions of the sample; NULL if the light is not an area light.
static inline R(light_sides)
    R(sides_of)(const glint_occlude_args *args, const double (*target)[GLINT_GROUP], const glint_prim *prim)
{
    R(light_sides) sides = { 0, 0 };
    for (int lane = 0; lane < (target ? GLINT_GROUP : 1); lane++) {
        double position[3];
        for (int k = 0; k < 3; k++)
            position[k] = target ? target[k][lane] : args->position[k];
        const int side = R(light_side)(args, prim, position);
        const uint16_t lanes = (uint16_t)(target ? 1u << lane : 0xffffu);
        sides.outside |= side > 0 ? lanes : 0;
        sides.inside |= side < 0 ? lanes : 0;
    }
    return sides;
}

/// Aims the tile's segments at the light (target NULL), or at one sample of the light.
static inline void R(aim_at)(R(shadow_tile) * tile, const double (*target)[GLINT_GROUP])
{
    const glint_occlude_args *args = tile->args;
    const glint_geometry_table *geometry = args->geometry;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < GLINT_GROUP; i += VR) {
            if (target)
                for (int j = i; j < i + VR; j++)
                    tile->position[k][j] = (real)target[k][j];
            else
                r_store(tile->position[k] + i, r_set(args->position[k]));
        }
    tile->far = false;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < GLINT_GROUP; i++) {
            const double x = target ? target[k][i] : args->position[k];
            const double local = args->directional ? x : (x - geometry->reference[k]) * geometry->scale;
            tile->local_light[k][i] = (float)local;
            tile->far = tile->far || !(fabs(local) < FAR_LIGHT);
        }
}

static inline void R(begin_group)(uint32_t g, R(shadow_group) * group)
{
    group->at = (size_t)g * GLINT_GROUP;
    group->placed = group->made = false;
}

/// Computes directions from points to the light, in its units.
static inline void R(directions_to)(const glint_occlude_args *args, const real position[3][GLINT_GROUP], size_t at,
                                    int i, vr d[3])
{
    for (int k = 0; k < 3; k++) {
        d[k] = r_load(position[k] + i);
        if (!args->directional)
            d[k] = (d[k] - r_load((const real *)args->point[k] + at + i)) * r_set(args->scale);
    }
}

static inline void R(place_group)(const R(shadow_tile) * tile, R(shadow_group) * group)
{
    if (!group->placed)
        R(index_frame)(tile->args->point, group->at, tile->args->geometry, group->local);
    group->placed = true;
}

/// Computes directions in the light's units: they are used for a far light, where they cover only a part of the
/// distance, and if float decides, because the filter must use the same numbers as the decision.
static inline void R(aim_in_units)(const R(shadow_tile) * tile, R(shadow_group) * group)
{
    _Alignas(64) real to_light[3][GLINT_GROUP];
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        vr d[3];
        R(directions_to)(tile->args, tile->position, group->at, i, d);
        for (int k = 0; k < 3; k++)
            r_store(to_light[k] + i, d[k]);
    }
    for (int k = 0; k < 3; k++)
        R(narrow)(to_light[k], group->rays.direction[k]);
}

/// Computes directions as differences of both ends in float. The error of a direction grows with the distance along
/// the segment. At a primitive it is at most GLINT_FILTER_SLACK times the lengths of the primitive's centre and the
/// point.
static inline void R(aim_in_index)(const R(shadow_tile) * tile, R(shadow_group) * group)
{
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            vf d = f_load(tile->local_light[k] + i);
            if (!tile->args->directional)
                d = d - f_load(group->local[k] + i);
            f_store(group->rays.direction[k] + i, d);
        }
}

static inline void R(make_shadow_rays)(const R(shadow_tile) * tile, R(shadow_group) * group)
{
    const glint_occlude_args *args = tile->args;
    R(place_group)(tile, group);
    R(set_origins)(args->point, group->at, (const float(*)[GLINT_GROUP])group->local, &group->rays);
    if (GLINT_REAL == 32 || tile->far)
        R(aim_in_units)(tile, group);
    else
        R(aim_in_index)(tile, group);
    for (int k = 0; args->geometry->solids && k < 3; k++)
        for (int i = 0; i < GLINT_GROUP; i += VF)
            f_store(group->inverse[k] + i, f_set(1) / f_load(group->rays.direction[k] + i));
    group->made = true;
}

static inline rm R(either)(rm mask, rm a, rm b) { return rm_or(rm_and(mask, a), rm_andnot(b, mask)); }

/// Returns which segments of a vector a sphere blocks. f: from the sphere's centre to the start of the segment; c:
/// |f|^2 minus the squared radius; d: direction.
static inline rm R(sphere_blocks)(const glint_occlude_args *args, const R(ball) *ball, unsigned outside,
                                  unsigned inside, const vr f[3], vr c, const vr d[3])
{
    const unsigned all = (1u << VR) - 1;
    const vr zero = r_set(0), scale = ball->scale;
    const rm from_outside = r_lt(zero, c), from_inside = r_lt(c, zero);
    if (inside == all)
        return from_outside;
    vr a = DOT(d, d), b = -DOT(f, d);
    rm blocked = rm_and(r_lt(zero, b), r_le(zero, R(discriminant)(f, d, a, b, c, ball->r2)));
    if (!args->directional)
        blocked = rm_and(blocked, r_lt(b * r_set(args->scale), a * scale));
    if (outside == all)
        return rm_or(from_inside, blocked);
    blocked = R(either)(rm_from_bits(outside), rm_or(from_inside, blocked), rm_andnot(blocked, from_inside));
    return R(either)(rm_from_bits(inside), from_outside, blocked);
}

/// Returns which segments of a vector a plane blocks. h: the heights of the points over the plane.
static inline rm R(plane_blocks)(unsigned outside, unsigned inside, vr h)
{
    return rm_or(rm_and(rm_from_bits(outside), r_lt(h, r_set(0))), rm_and(rm_from_bits(inside), r_lt(r_set(0), h)));
}

/// Returns the lanes of `wanted` that a triangle blocks from lights at `position`; `own`: lanes whose points are on
/// the triangle.
static unsigned R(blocked_by_triangle)(const glint_occlude_args *args, const glint_prim *prim,
                                       const real position[3][GLINT_GROUP], size_t at, unsigned own, unsigned wanted)
{
    const double scale = args->geometry->scale;
    const unsigned back = args->back[at / GLINT_GROUP];
    const uint32_t g = (uint32_t)(at / GLINT_GROUP), across = args->camera ? args->camera->groups_across : 1;
    const R(group_directions) viewing = R(directions_of)(args->camera, g % across, g / across);
    const vr zero = r_set(0);
    vr corner[3][3];
    unsigned blocked = 0;
    count_tests(args->tests, wanted);
    R(corners_of)(prim, corner);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned lanes = wanted >> i & ((1u << VR) - 1), own_lanes = own >> i & lanes;
        if (!lanes)
            continue;
        const vr light[3] = { r_load(position[0] + i), r_load(position[1] + i), r_load(position[2] + i) };
        const R(triangle_plane) plane = R(plane_of)(corner, scale, light, args->directional);
        unsigned hit = 0;
        if (own_lanes)
            hit = own_lanes &
                  ((rm_bits(r_lt(zero, plane.light)) & back >> i) | (rm_bits(r_lt(plane.light, zero)) & ~(back >> i)));
        if (lanes & ~own_lanes) {
            vr p[3], d[3], ray[3];
            R(load3)(args->point, at + i, p);
            R(load_direction)(viewing, args->direction, at, i, ray);
            R(directions_to)(args, position, at, i, d);
            const vr slack = r_load((const real *)args->slack + at + i);
            hit |= rm_bits(R(triangle_blocks)(corner, scale, p, d, slack, &plane, ray)) & lanes & ~own_lanes;
        }
        blocked |= hit << i;
    }
    return blocked;
}

/// Returns the lanes of `wanted` that a torus blocks, including the lanes `own`, whose points are on the torus.
/// outside: lanes in which the light is outside.
static unsigned R(blocked_by_torus)(const glint_occlude_args *args, const glint_prim *prim,
                                    const real position[3][GLINT_GROUP], size_t at, unsigned own, unsigned wanted,
                                    unsigned outside)
{
    const glint_solid *solid = &args->geometry->solids[prim->item];
    const unsigned back = own & args->back[at / GLINT_GROUP], all = (1u << VR) - 1;
    const vr end = r_set(args->directional ? HUGE_VAL : 1 / args->scale);
    unsigned blocked = 0;
    count_tests(args->tests, wanted);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned lanes = wanted >> i & all, inside = ~outside >> i & all;
        vr p[3], d[3], f[3], e[3];
        if (!lanes)
            continue;
        R(load3)(args->point, at + i, p);
        R(directions_to)(args, position, at, i, d);
        R(unit_offset)(solid, prim, p, f);
        R(to_unit)(solid, d, e);
        const R(torus_start) start = { rm_from_bits(own >> i & all), rm_from_bits(back >> i & all) };
        const unsigned gone = rm_bits(R(leaves_torus)(f, e, start));
        unsigned parted = gone & inside;
        if (lanes & ~gone) {
            R(torus_line) l;
            R(along_torus)(solid, f, e, start, &l);
            parted |= rm_bits(R(torus_parts)(&l, f, e, end, rm_from_bits(inside), start));
        }
        blocked |= (parted & lanes) << i;
    }
    return blocked;
}

/// Returns the lanes of `wanted` that a solid blocks. own: lanes whose points are on the solid. outside: lanes in
/// which the light is outside.
static unsigned R(blocked_by_solid)(const glint_occlude_args *args, const glint_prim *prim,
                                    const real position[3][GLINT_GROUP], size_t at, unsigned own, unsigned wanted,
                                    unsigned outside)
{
    const glint_solid *solid = &args->geometry->solids[prim->item];
    if (solid->form == GLINT_FORM_TORUS)
        return R(blocked_by_torus)(args, prim, position, at, own, wanted, outside);
    const unsigned back = own & args->back[at / GLINT_GROUP], within = is_open(solid) ? back : 0;
    unsigned blocked = solid->form == GLINT_FORM_DISK || is_open(solid) ? 0 : back & outside;
    wanted &= ~(own & ~within);
    count_tests(args->tests, wanted);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned lanes = wanted >> i & ((1u << VR) - 1);
        vr p[3], d[3];
        if (!lanes)
            continue;
        R(load3)(args->point, at + i, p);
        R(directions_to)(args, position, at, i, d);
        const rm mine = rm_from_bits(within >> i & ((1u << VR) - 1));
        blocked |= (rm_bits(R(solid_blocks)(solid, prim, p, d, args->scale, args->directional, mine)) & lanes) << i;
    }
    return blocked;
}

/// Returns the lanes of a group whose points are on parts of a combined solid.
static inline unsigned R(lanes_on_parts)(const glint_occlude_args *args, const glint_combined *whole, size_t at)
{
    const uint32_t first = args->geometry->prim_count + whole->first;
    return lanes_below(args->prim + at, first + whole->count) & ~lanes_below(args->prim + at, first);
}

/// Returns `wanted` without the lanes whose segments leave a combined solid: the segments that leave a part which
/// contains the whole solid.
static unsigned R(stay_in_combined)(const glint_occlude_args *args, const glint_prim *prim, size_t at, unsigned wanted)
{
    const glint_combined *whole = &args->geometry->combined[prim->item];
    const uint32_t first = args->geometry->prim_count + whole->first;
    if (!R(lanes_on_parts)(args, whole, at))
        return wanted; // no lane is on a part, so the parts need not be loaded
    const unsigned back = args->back[at / GLINT_GROUP];
    for (uint64_t bits = whole->all & whole->needs; bits && wanted; bits &= bits - 1) {
        const uint32_t index = first + (uint32_t)__builtin_ctzll(bits);
        const unsigned into = args->geometry->prims[index].inverted ? ~back : back;
        wanted &= ~lanes_equal(args->prim + at, index) | into;
    }
    return wanted;
}

/// Returns the lanes of `wanted` that a combined solid blocks. A segment from one of its parts starts inside if the
/// point is seen from behind, otherwise outside.
static unsigned R(blocked_by_combined)(const glint_occlude_args *args, const glint_prim *prim,
                                       const real position[3][GLINT_GROUP], size_t at, unsigned wanted)
{
    const glint_combined *whole = &args->geometry->combined[prim->item];
    const unsigned back = args->back[at / GLINT_GROUP];
    unsigned blocked = 0;
    count_tests(args->tests, wanted);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned lanes = wanted >> i & ((1u << VR) - 1);
        R(stretches) s;
        vr p[3], d[3], from = r_set(0), t;
        if (!lanes)
            continue;
        R(load3)(args->point, at + i, p);
        R(directions_to)(args, position, at, i, d);
        const R(whole_rays) rays = { p, d, args->prim + at + i, back >> i, lanes };
        for (unsigned pending = lanes, hit; pending;) {
            pending = R(next_change)(args->geometry, whole, &rays, pending, &from, &s, &t, &hit);
            if (!args->directional)
                hit &= rm_bits(r_lt(t * r_set(args->scale), r_set(1)));
            blocked |= hit << i;
        }
    }
    return blocked;
}

/// Returns which of VR segments along d, from lane i of the group at `at` on, a sphere or a plane blocks, one bit
/// each. No point is on the primitive.
static inline unsigned R(lanes_blocked)(const glint_occlude_args *args, const glint_prim *prim, const R(ball) *ball,
                                        R(light_sides) sides, size_t at, int i, const vr d[3])
{
    const unsigned all = (1u << VR) - 1, outside = sides.outside >> i & all, inside = sides.inside >> i & all;
    vr p[3], f[3];
    R(load3)(args->point, at + (size_t)i, p);
    if (prim->kind == GLINT_PRIM_SPHERE) {
        for (int k = 0; k < 3; k++)
            f[k] = (p[k] - r_set(prim->center[k])) * ball->scale;
        const vr c = R(exact_power)(f, ball->r2, ball->r2_low);
        return rm_bits(R(sphere_blocks)(args, ball, outside, inside, f, c, d));
    }
    R(offset)(p, prim, f);
    return rm_bits(R(plane_blocks)(outside, inside, R(point_constant)(f, prim)));
}

/// Returns the lanes of `wanted` that a primitive blocks from lights at `position`. own: lanes whose points are on the
/// primitive; if it is a sphere, it blocks those that are seen from behind. sides: where the lights are.
static unsigned R(decide_blocked)(const glint_occlude_args *args, const glint_prim *prim,
                                  const real position[3][GLINT_GROUP], size_t at, R(light_sides) sides, unsigned own,
                                  unsigned wanted)
{
    if (prim->kind == GLINT_PRIM_TRIANGLE)
        return R(blocked_by_triangle)(args, prim, position, at, own, wanted);
    if (prim->kind == GLINT_PRIM_SOLID)
        return R(blocked_by_solid)(args, prim, position, at, own, wanted, sides.outside);
    if (prim->kind == GLINT_PRIM_COMBINED)
        return R(blocked_by_combined)(args, prim, position, at, wanted);
    unsigned blocked = prim->kind == GLINT_PRIM_SPHERE ? own & args->back[at / GLINT_GROUP] & sides.outside : 0;
    wanted &= ~own;
    if (!wanted)
        return blocked;
    count_tests(args->tests, wanted);
    const R(ball) ball = R(ball_of)(prim);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned lanes = wanted >> i & ((1u << VR) - 1);
        vr d[3];
        if (!lanes)
            continue;
        R(directions_to)(args, position, at, i, d);
        blocked |= (R(lanes_blocked)(args, prim, &ball, sides, at, i, d) & lanes) << i;
    }
    return blocked;
}

/// Lanes of a group after the float test of their segments against a sphere.
typedef struct R(sphere_lanes) {
    unsigned near; ///< the sphere may block them
    unsigned within; ///< lanes of `near` whose segment certainly passes through the inside
} R(sphere_lanes);

/// Classifies a sphere. The sphere is not near a segment if the segment's line misses it, or if the sphere is behind
/// the segment's start and does not contain the start. For certain hits, the radius is reduced by as much as the
/// filter enlarges it.
static R(sphere_lanes) R(sort_by_sphere)(const R(shadow_tile) * tile, const R(ray_group) * rays, const glint_prim *prim)
{
#if GLINT_REAL == 64
    const vf zero = f_set(0), width = f_set(2 * (float)(prim->radius * tile->args->geometry->scale));
    R(sphere_lanes) out = { 0, 0 };
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        vf f[3], d[3];
        for (int k = 0; k < 3; k++)
            d[k] = f_load(rays->direction[k] + i);
        const vf limit = R(filter_offset)(rays, i, prim, f), limit2 = limit * limit;
        const vf x[3] = { f[1] * d[2] - f[2] * d[1], f[2] * d[0] - f[0] * d[2], f[0] * d[1] - f[1] * d[0] };
        const vf beside2 = DOT(x, x), length2 = DOT(d, d), back = DOT(f, d);
        const fm behind = fm_and(f_lt(zero, back), f_lt(limit2, DOT(f, f)));
        const unsigned away = fm_bits(fm_or(f_lt(limit2 * length2, beside2), behind));
        out.near |= (~away & ((1u << VF) - 1)) << i;
        if (away == (1u << VF) - 1)
            continue;
        const vf inner = width - limit, inner2 = (inner * inner) * length2;
        fm within = fm_and(f_lt(zero, inner), f_lt(beside2, inner2));
        within = fm_and(within, f_le(back, zero)); // the foot of the perpendicular is on the segment
        if (!tile->args->directional)
            within = fm_and(within, f_le(-back, length2));
        // where squares overflow or underflow, nothing is certain
        within = fm_and(within, fm_and(f_lt(f_set(0x1p-100f), inner2), f_lt(length2, f_set(0x1p80f))));
        out.within |= (fm_bits(within) & ~away) << i;
    }
    return out;
#else // float decides
    (void)tile;
    return (R(sphere_lanes)) { R(near_rays)(rays, prim), 0 };
#endif
}

/// Returns the lanes of `wanted` whose segments pass near the box of a solid or combined solid.
static unsigned R(segments_near)(const R(shadow_tile) * tile, const glint_prim *prim, R(shadow_group) * group, unsigned wanted)
{
    const glint_geometry_table *table = tile->args->geometry;
    if (!group->made)
        R(make_shadow_rays)(tile, group);
    if (prim->kind == GLINT_PRIM_SOLID) {
        const glint_solid *solid = &table->solids[prim->item];
        return wanted & R(rays_to_box)(&group->rays, group->inverse, solid->lower, solid->upper);
    }
    const glint_combined *whole = &table->combined[prim->item];
    return wanted & R(rays_to_box)(&group->rays, group->inverse, whole->lower, whole->upper);
}

/// Returns the lanes of `wanted` that the primitive blocks.
INNER unsigned R(blocked_by)(const R(shadow_tile) * tile, R(occluder) occluder, R(shadow_group) * group,
                             unsigned wanted)
{
    const glint_occlude_args *args = tile->args;
    const glint_prim *prim = &args->geometry->prims[occluder.id];
    const unsigned own = lanes_equal(args->prim + group->at, occluder.id) & wanted;
    unsigned others = wanted & ~own, certain = 0;
    if (prim->kind == GLINT_PRIM_COMBINED) { // points are on its parts, never on the whole
        others = R(stay_in_combined)(args, prim, group->at, others);
    } else if (prim->kind == GLINT_PRIM_TRIANGLE && others) {
        if (!group->made)
            R(make_shadow_rays)(tile, group);
        others &= R(near_rays)(&group->rays, prim);
    } else if (prim->kind == GLINT_PRIM_SPHERE && others && occluder.sides.inside != 0xffff) {
        // if the light is inside, the sphere blocks every point outside
        if (!group->made)
            R(make_shadow_rays)(tile, group);
        const R(sphere_lanes) sorted = R(sort_by_sphere)(tile, &group->rays, prim);
        others &= sorted.near | occluder.sides.inside;
        if (occluder.sides.outside == 0xffff)
            certain = others & sorted.within;
        count_tests(args->tests, certain);
        others &= ~certain;
    }
    if (others && (prim->kind == GLINT_PRIM_SOLID || prim->kind == GLINT_PRIM_COMBINED))
        others = R(segments_near)(tile, prim, group, others);
    if (!(own | others))
        return certain;
    return certain | R(decide_blocked)(args, prim, tile->position, group->at, occluder.sides, own, own | others);
}

#endif
