// cast_rays: the nearest hit of rays with any origins. In small scenes, groups of rays are tested against all
// primitives. Otherwise the rays of a group traverse the index together while they are coherent (together.h), and
// then each on its own. The rays of a tile of an orthographic camera, or of a camera with a lens, traverse the index
// as one beam (parallel.h). Contract: stages.h.
#ifndef GLINT_CAST_RAYS_H
#define GLINT_CAST_RAYS_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/combined.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/nearest.h"
#include "engine/render/stages/cast/shared_edge.h"
#include "engine/render/stages/cast/solid.h"
#include "engine/render/stages/cast/torus.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

/// Computes t where rays that enter a sphere or solid leave it. They always leave it, because it is convex. Rays that
/// start on a form without an inside may hit its other side.
static inline rm R(exit_t)(const glint_geometry_table *table, const glint_prim *prim, const vr o[3], const vr d[3],
                           vr *t)
{
    const rm all = rm_from_bits((1u << VR) - 1);
    vr f[3];
    if (prim->kind == GLINT_PRIM_SOLID) {
        const glint_solid *solid = &table->solids[prim->item];
        R(solid_start) start;
        R(start_at)(solid, prim, o, &start);
        const R(span) span = R(span_along)(solid, &start, d, true);
        *t = span.t[1];
        if (is_open(solid))
            return rm_and(rm_and(span.hit, span.second), r_lt(r_set(0), *t));
        *t = r_max(*t, r_set(GLINT_LEAST_T));
        return all;
    }
    R(offset)(o, prim, f);
    const vr b = -DOT(f, d);
    *t = r_max((b + b) / (DOT(d, d) * r_set(glint_sphere_scale(prim))), r_set(GLINT_LEAST_T));
    return all;
}

/// Computes t where rays that leave a torus hit it again; inward: rays that go inside, which always hit it again.
static inline rm R(reentry_t)(const glint_solid *solid, const glint_prim *prim, const vr o[3], const vr d[3],
                              unsigned inward, vr *t)
{
    vr f[3], e[3];
    R(unit_offset)(solid, prim, o, f);
    R(to_unit)(solid, d, e);
    const R(torus_start) start = { rm_from_bits((1u << VR) - 1), rm_from_bits(inward) };
    return R(intersect_torus)(solid, f, e, start, t);
}

/// Returns whether a ray that passes through the surface may hit it again. Rays hit a part of a combined solid only
/// by way of that solid.
static inline bool R(has_inside)(const glint_geometry_table *table, uint32_t id)
{
    if (id >= table->prim_count)
        return false;
    const glint_prim *prim = &table->prims[id];
    return prim->kind == GLINT_PRIM_SPHERE ||
           (prim->kind == GLINT_PRIM_SOLID && table->solids[prim->item].form != GLINT_FORM_DISK);
}

/// Tests the rays of a group that may hit the primitive that they start on: rays that go into it, and all rays that
/// leave a torus.
static inline void R(cast_on_own)(const glint_cast_args *args, uint32_t g)
{
    const glint_geometry_table *table = args->geometry;
    const size_t at = (size_t)g * GLINT_GROUP;
    unsigned lanes = args->active[g] & (table->tori ? 0xffffu : args->inward[g]);
    while (lanes) {
        const uint32_t id = args->leaving[at + (size_t)__builtin_ctz(lanes)];
        unsigned same = lanes & lanes_equal(args->leaving + at, id);
        lanes &= ~same;
        if (!R(has_inside)(table, id))
            continue;
        const bool torus = is_torus(table, &table->prims[id]);
        if (!torus)
            same &= args->inward[g];
        for (int i = 0; i < GLINT_GROUP; i += VR) {
            vr o[3], d[3], t;
            const unsigned own = same >> i & ((1u << VR) - 1);
            if (!own)
                continue;
            R(load3)(args->origin, at + (size_t)i, o);
            R(load3)(args->direction, at + (size_t)i, d);
            const glint_prim *prim = &table->prims[id];
            const rm hit = torus ? R(reentry_t)(&table->solids[prim->item], prim, o, d, args->inward[g] >> i, &t)
                                 : R(exit_t)(table, prim, o, d, &t);
            R(update_nearest)(args, at + (size_t)i, id, rm_and(rm_from_bits(own), hit), t);
        }
    }
}

/// Decides one primitive for the lanes `near` of a group. Returns whether any hit was stored.
static inline bool R(decide_rays)(const glint_cast_args *args, uint32_t g, uint32_t id, unsigned near)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    const glint_prim *prim = &args->geometry->prims[id];
    const unsigned leave = args->leaving ? lanes_equal(args->leaving + at, id) : 0;
    const bool shared_edge = args->leaving && prim->kind == GLINT_PRIM_TRIANGLE;
    const bool rounded = args->leaving && prim->kind == GLINT_PRIM_PLANE;
    const unsigned on_surfaces = rounded ? ~lanes_equal(args->leaving + at, GLINT_MISS) : 0;
    bool any = false;
    R(flat) flat;
    if (prim->kind == GLINT_PRIM_COMBINED)
        return R(cast_combined_rays)(args, g, prim, near);
    count_tests(args->tests, near);
    if (shared_edge)
        flat = R(flat_of)(prim, args->geometry->scale);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned own = leave >> i & ((1u << VR) - 1);
        if (!(near >> i & ((1u << VR) - 1)))
            continue;
        vr o[3], d[3], f[3], p[3][3], t;
        R(load3)(args->origin, at + i, o);
        R(load3)(args->direction, at + i, d);
        rm hit;
        if (prim->kind == GLINT_PRIM_TRIANGLE) {
            R(corners_from)(o, prim, args->geometry->scale, p);
            const R(ray_edges) edges = R(make_ray_edges)(p, d, shared_edge);
            hit =
                R(intersect_edges)(&edges, p, o, d, r_set(args->geometry->scale), R(face_of)(args->geometry, prim), &t);
            hit = R(unless_begun_on)(args->geometry, prim, shared_edge ? args->leaving + at + i : NULL, o, hit, t);
            if (shared_edge)
                hit = R(intersect_shared_edge)(args, at + (size_t)i, own, o, &flat, &edges, hit, &t);
        } else if (prim->kind == GLINT_PRIM_SOLID) {
            const glint_solid *solid = &args->geometry->solids[prim->item];
            R(solid_start) start;
            R(start_at)(solid, prim, o, &start);
            hit = R(intersect_solid)(solid, &start, d, &t);
        } else {
            R(offset)(o, prim, f);
            vr c = R(offset_constant)(f, prim);
            if (rounded)
                c = r_select(rm_from_bits(on_surfaces >> i & ((1u << VR) - 1)), R(point_constant)(f, prim), c);
            hit = R(intersect)(f, c, d, prim, &t);
        }
        hit = rm_andnot(hit, rm_from_bits(own)); // see cast_on_own
        if (!rm_bits(hit))
            continue;
        R(update_nearest)(args, at + i, id, hit, t);
        any = true;
    }
    return any;
}

/// Tests one primitive against all rays of a group.
static inline void R(cast_on_group)(const glint_cast_args *args, uint32_t g, const R(ray_group) * rays, uint32_t id)
{
    const unsigned near = R(near_rays)(rays, &args->geometry->prims[id]);
    if (near)
        R(decide_rays)(args, g, id, near);
}

/// Traverses the index with one ray. Primitives that the ray may hit are tested against the ray's whole group,
/// because rays of a group are often similar.
static void R(walk_ray)(const glint_cast_args *args, uint32_t g, const R(ray_group) * rays, int lane)
{
    const glint_geometry_table *geometry = args->geometry;
    const real *t = (const real *)args->t + (size_t)g * GLINT_GROUP + lane;
    const glint_node *node;
    ray_walk walk;
    unsigned prims;
    walk.ray.slack = R(walk_slack)(geometry);
    for (int k = 0; k < 3; k++) {
        walk.ray.origin[k] = rays->local[k][lane];
        walk.ray.inverse[k] = 1 / rays->direction[k][lane];
    }
    begin_ray_walk(&walk, geometry->nodes);
    while ((node = next_on_ray(&walk, R(reach_in_index)(args, *t), &prims)))
        for (; prims; prims &= prims - 1)
            R(cast_on_group)(args, g, rays, node->child[__builtin_ctz(prims)] & ~GLINT_NODE_PRIM);
}

#define LENS_BEAM 8 ///< if radius / focus distance of the lens is above this, the rays of a tile are not coherent

/// Returns whether the rays traverse the index as one beam.
static inline bool R(is_beam)(const glint_camera_args *camera)
{
    return camera && !(camera->lens && camera->lens->radius * camera->lens->per_focus > LENS_BEAM);
}

/// Prepares a group's rays for filter and traversal. local: memory for the origins of the rays.
static inline void R(make_ray_group)(const glint_cast_args *args, uint32_t g, float local[3][GLINT_GROUP],
                                     R(ray_group) * rays)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    R(index_frame)((const void *const *)args->origin, at, args->geometry, local);
    R(set_origins)((const void *const *)args->origin, at, (const float(*)[GLINT_GROUP])local, rays);
    for (int k = 0; k < 3; k++)
        R(narrow)((const real *)args->direction[k] + at, rays->direction[k]);
}

/// Starts a group with the hits that need no index: on the primitives that the rays start on, and on unbounded
/// primitives. Returns false if there are no rays.
static inline bool R(begin_rays)(const glint_cast_args *args, uint32_t g, float local[3][GLINT_GROUP],
                                 R(ray_group) * rays)
{
    const glint_geometry_table *geometry = args->geometry;
    R(start_group)(args, g);
    if (!args->active[g])
        return false;
    R(make_ray_group)(args, g, local, rays);
    if (args->leaving)
        R(cast_on_own)(args, g);
    for (uint32_t i = 0; i < geometry->unbounded_count; i++)
        R(cast_on_group)(args, g, rays, geometry->unbounded[i]);
    return true;
}

/// The primitives of a small index: spheres are listed from the front on, other primitives from the end backwards.
typedef struct R(few_prims) {
    uint32_t id[GLINT_FEW];
    int spheres, others;
} R(few_prims);

static inline void R(list_few)(const glint_geometry_table *geometry, R(few_prims) * few)
{
    uint32_t stack[WALK_STACK];
    int height = 0;
    few->spheres = few->others = 0;
    stack[height++] = 0;
    while (height > 0) {
        const glint_node *node = &geometry->nodes[stack[--height]];
        for (int i = 0; i < GLINT_NODE_WIDTH; i++) {
            const uint32_t child = node->child[i], id = child & ~GLINT_NODE_PRIM;
            if (!(node->lower[0][i] <= node->upper[0][i]))
                continue;
            if (!(child & GLINT_NODE_PRIM))
                stack[height++] = child;
            else if (GLINT_REAL == 64 && geometry->prims[id].kind == GLINT_PRIM_SPHERE)
                few->id[few->spheres++] = id;
            else
                few->id[GLINT_FEW - ++few->others] = id;
        }
    }
}

/// Decides the rays that float could not decide.
static void R(decide_rest)(const glint_cast_args *args, uint32_t g, const R(few_prims) * few, unsigned lanes)
{
    _Alignas(64) float local[3][GLINT_GROUP];
    R(ray_group) rays;
    R(make_ray_group)(args, g, local, &rays);
    for (int n = 0; n < few->spheres; n++) {
        const unsigned near = lanes & R(near_rays)(&rays, &args->geometry->prims[few->id[n]]);
        if (near)
            R(decide_rays)(args, g, few->id[n], near);
    }
}

/// Casts in a scene with few primitives.
static void R(cast_few_rays)(const glint_cast_args *args)
{
    _Alignas(64) float local[3][GLINT_GROUP];
    R(ray_group) rays;
    R(few_prims) few;
    R(ray_pairs) pairs = { .count = 0 };
    R(list_few)(args->geometry, &few);
    for (uint32_t g = 0; g < args->group_count; g++) {
        if (!R(begin_rays)(args, g, local, &rays))
            continue;
        for (int n = GLINT_FEW - few.others; n < GLINT_FEW; n++)
            R(cast_on_group)(args, g, &rays, few.id[n]);
        R(cast_spheres)(args, g, &rays, few.id, few.spheres, &pairs);
    }
    R(decide_ray_pairs)(args, &pairs);
    for (uint32_t g = 0; g < args->group_count; g++) {
        if (pairs.undecided[g])
            R(decide_rest)(args, g, &few, pairs.undecided[g]);
        R(finish_group)(args, g);
    }
}

#endif
