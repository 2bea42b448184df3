// surface: the point, the normal and the material of each hit. A group is processed object by object. Most groups
// show only one object, so that the object's constants are the same in every lane. Contract: stages.h.
#ifndef GLINT_SURFACE_SURFACE_H
#define GLINT_SURFACE_SURFACE_H

#include "engine/render/stages/cast/camera.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/solid.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/simd/real.h"
#include "engine/render/stages/surface/mesh.h"
#include "engine/render/stages/surface/sphere.h"

/// Projects points next to a plane of any normal onto it. The height that remains is within one rounding, wherever
/// the rays started.
INNER void R(onto_plane_of)(const glint_prim *prim, const vr n[3], vr p[3])
{
    const vr q[3] = { p[0] - r_set(prim->center[0]), p[1] - r_set(prim->center[1]), p[2] - r_set(prim->center[2]) };
    const vr h = DOT(n, q);
    for (int k = 0; k < 3; k++)
        p[k] = p[k] - h * n[k];
}

/// Stores `x` in the lanes of `mask`; `whole`: whether these are all lanes.
INNER void R(put)(void *array, size_t at, bool whole, rm mask, vr x)
{
    real *to = (real *)array + at;
    if (!whole)
        x = r_select(mask, x, r_load(to));
    r_store(to, x);
}

/// The constants of a primitive for all rays of a camera.
typedef struct R(seen_prim) {
    uint32_t id; ///< GLINT_MISS: no primitive yet
    const glint_prim *prim;
    real scale, inverse_radius; ///< for a sphere, in the sphere's units
    R(sphere_range) range; ///< for a sphere: bounds of the distance of the eye
    real f[3]; ///< vector from the centre to the eye: for a sphere, scaled; for a solid, in the space of the unit
        ///< shape
    real normal[3]; ///< normal of a plane or a triangle
    int level; ///< for a plane: the axis that the plane is perpendicular to; 3: none
    real from[3],
        factor[3]; ///< for a plane: points are at from + factor (t direction). Along the axis `level`, from is the
        ///< plane's exact coordinate
} R(seen_prim);

/// Computes the constants of a primitive in place, because reading a copy of just-written numbers would stall.
/// height: memory for the heights of the eye over a solid's faces.
static inline void R(see_prim)(const glint_surface_args *args, uint32_t id, R(seen_prim) * seen, real height[6])
{
    const glint_prim *prim = &args->prims[id];
    *seen = (R(seen_prim)) { .id = id, .prim = prim };
    if (prim->kind != GLINT_PRIM_SPHERE) {
        double n[3] = { 0, 0, 0 };
        if (prim->kind == GLINT_PRIM_TRIANGLE)
            R(triangle_normal)(prim, args->scale, n);
        for (int k = 0; k < 3 && prim->kind == GLINT_PRIM_PLANE; k++)
            n[k] = prim->normal[k];
        for (int k = 0; k < 3; k++)
            seen->normal[k] = (real)(prim->inverted ? -n[k] : n[k]);
        seen->level = prim->kind == GLINT_PRIM_PLANE ? glint_axis_along(prim->normal) : 3;
        for (int k = 0; k < 3 && args->camera; k++) {
            seen->from[k] = (real)(k == seen->level ? prim->center[k] : args->camera->eye[k]);
            seen->factor[k] = k != seen->level;
        }
        if (prim->kind == GLINT_PRIM_SOLID && args->camera)
            R(start_at_eye)(&args->solids[prim->item], prim, args->camera->eye, seen->f, height);
        return;
    }
    seen->scale = (real)glint_sphere_scale(prim);
    seen->inverse_radius = (real)1 / ((real)prim->radius * seen->scale);
    if (!args->camera)
        return;
    for (int k = 0; k < 3; k++)
        seen->f[k] = ((real)args->camera->eye[k] - (real)prim->center[k]) * (real)glint_sphere_scale(prim);
    seen->range = R(range_of)(seen->f);
}

/// One primitive and its constants.
typedef struct R(seen_slot) {
    R(seen_prim) prim;
    real height[6]; ///< heights of the eye over a solid's faces
} R(seen_slot);

#define SEEN_SLOTS 4 ///< number of cached primitives; a tile's groups show the same few again and again

/// State while iterating over the groups of a tile.
typedef struct R(surface_walk) {
    uint32_t only; ///< the only primitive that groups showed so far; GLINT_MISS: none
    bool several, any_back; ///< several: groups also showed other primitives; any_back: some lane is seen from behind
    R(seen_slot) * last; ///< the slot of the last primitive
    R(seen_slot) slots[SEEN_SLOTS]; ///< indexed by the lowest bits of the primitive's index; only one is used if there
        ///< are only balls and planes, whose constants are computed quickly
} R(surface_walk);

/// Returns the last primitive's slot; mixed: a constant, see glint_surface_args.
INNER R(seen_slot) *R(last_seen)(R(surface_walk) * walk, const bool mixed) { return mixed ? walk->last : walk->slots; }

/// Points and normals of one vector of lanes that show one primitive.
typedef struct R(surface_lanes) {
    vr direction[3], point[3], normal[3], slack;
    vr away; ///< dot(outward normal, direction)
    rm back;
} R(surface_lanes);

/// Turns the normal towards the viewer. n: the outward normal.
INNER void R(face_viewer)(const vr n[3], R(surface_lanes) * surface)
{
    surface->away = DOT(n, surface->direction);
    surface->back = r_lt(r_set(0), surface->away);
    for (int k = 0; k < 3; k++)
        surface->normal[k] = r_select(surface->back, -n[k], n[k]);
}

INNER void R(find_on_solid)(const glint_surface_args *args, R(seen_slot) * slot, const vr from[3], const vr d[3], vr t, vr n[3],
                            vr p[3])
{
    const R(seen_prim) *seen = &slot->prim;
    const glint_solid *solid = &args->solids[seen->prim->item];
    R(solid_start) start = { .origin = from, .height = args->camera ? slot->height : NULL };
    for (int k = 0; k < 3; k++)
        start.f[k] = r_set(seen->f[k]);
    if (!args->camera)
        R(unit_offset)(solid, seen->prim, from, start.f);
    R(solid_surface)(solid, seen->prim, &start, d, t, n, p);
    for (int k = 0; seen->prim->inverted && k < 3; k++)
        n[k] = -n[k];
}

/// Computes a vector of lanes from i on.
INNER void R(find_lanes)(const glint_surface_args *args, R(seen_slot) * slot, R(group_directions) directions, size_t at,
                         int i, bool mixed, R(surface_lanes) * surface)
{
    const R(seen_prim) *seen = &slot->prim;
    const glint_prim *prim = seen->prim;
    const bool smooth = mixed && prim->kind == GLINT_PRIM_TRIANGLE && args->corner_normals && prim->item != GLINT_MISS;
    vr *d = surface->direction, *p = surface->point, n[3], from[3], f[3], w[3] = { r_set(0), r_set(0), r_set(0) };
    vr corner[3][3];
    R(load_direction)(directions, args->direction, at, i, d);
    const vr t = r_load((const real *)args->t + at + i);
    if (prim->kind == GLINT_PRIM_SPHERE) {
        for (int k = 0; k < 3; k++)
            f[k] = r_set(seen->f[k]);
        if (!args->camera) {
            R(load3)(args->origin, at + i, from);
            R(offset)(from, prim, f);
        }
        R(sphere_surface)(f, d, t, prim, seen->scale, seen->inverse_radius, seen->range, n, p);
    } else {
        for (int k = 0; k < 3; k++) {
            from[k] = args->camera ? r_set(args->camera->eye[k]) : r_load((const real *)args->origin[k] + at + i);
            n[k] = r_set(seen->normal[k]);
            p[k] = from[k] + t * d[k];
            if (k == seen->level)
                p[k] = r_set(prim->center[k]);
        }
        if (mixed && prim->kind == GLINT_PRIM_TRIANGLE) {
            R(corners_of)(prim, corner);
            R(triangle_point)(corner, args->scale, from, d, w, p, &surface->slack);
        } else if (mixed && prim->kind == GLINT_PRIM_SOLID)
            R(find_on_solid)(args, slot, from, d, t, n, p);
    }
    if (prim->kind == GLINT_PRIM_PLANE && seen->level == 3)
        R(onto_plane_of)(prim, n, p);
    if (mixed && prim->kind != GLINT_PRIM_TRIANGLE)
        surface->slack = r_set(-GLINT_POINT_SLACK) * R(largest)(p);
    R(face_viewer)(n, surface);
    if (smooth) {
        const vr facing[3] = { surface->normal[0], surface->normal[1], surface->normal[2] };
        const glint_corner_normals *corners = &args->corner_normals[prim->item];
        vr normal[3][3];
        for (int j = 0; j < 9; j++)
            normal[j / 3][j % 3] = r_set(corners->normal[j / 3][j % 3]);
        if (corners->terminator > 0) {
            R(toward_curve)(corner, normal, w, facing, r_set(corners->terminator), p);
            surface->slack = -surface->slack;
        }
        R(smooth_normal)(normal, w, n, facing, surface->normal);
    }
}

/// Computes one vector of a group that shows several triangles.
INNER void R(find_mesh_lanes)(const glint_surface_args *args, R(mesh_group) * mesh, R(group_directions) directions,
                              size_t at, int i, R(surface_lanes) * surface)
{
    vr corner[3][3], from[3], n[3], w[3];
    R(load_direction)(directions, args->direction, at, i, surface->direction);
    R(load_corners)(mesh->corner, i, corner);
    for (int k = 0; k < 3; k++) {
        from[k] = args->camera ? r_set(args->camera->eye[k]) : r_load((const real *)args->origin[k] + at + i);
        n[k] = R(load_rounded)(mesh->normal[k] + i);
    }
    R(triangle_point)(corner, args->scale, from, surface->direction, w, surface->point, &surface->slack);
    R(face_viewer)(n, surface);
    const unsigned smooth = mesh->smooth >> i & ((1u << VR) - 1);
    if (!smooth)
        return;
    vr curved[3], normal[3][3];
    R(load_corners)(mesh->corner_normal, i, normal);
    if (mesh->moves) {
        const vr share = R(load_rounded)(mesh->terminator + i);
        R(toward_curve)(corner, normal, w, surface->normal, share, surface->point);
        surface->slack = r_select(r_lt(r_set(0), share), -surface->slack, surface->slack);
    }
    R(smooth_normal)(normal, w, n, surface->normal, curved);
    for (int k = 0; k < 3; k++)
        surface->normal[k] = r_select(rm_from_bits(smooth), curved[k], surface->normal[k]);
}

/// A bounding box of points. NaN is ignored.
typedef struct R(point_box) {
    vr least[3], most[3];
} R(point_box);

INNER void R(empty_box)(R(point_box) * box)
{
    for (int k = 0; k < 3; k++) {
        box->least[k] = r_set(HUGE_VAL);
        box->most[k] = r_set(-HUGE_VAL);
    }
}

INNER void R(enclose)(R(point_box) * box, const vr point[3], bool whole, rm mask)
{
    for (int k = 0; k < 3; k++) {
        const vr least = r_min(point[k], box->least[k]), most = r_max(point[k], box->most[k]);
        box->least[k] = whole ? least : r_select(mask, least, box->least[k]);
        box->most[k] = whole ? most : r_select(mask, most, box->most[k]);
    }
}

static void R(write_box)(R(point_box) box, glint_point_box *out)
{
    _Alignas(64) real lanes[VR];
    for (int k = 0; k < 3; k++) {
        out->lower[k] = HUGE_VAL;
        out->upper[k] = -HUGE_VAL;
        r_store(lanes, box.least[k]);
        for (int i = 0; i < VR; i++)
            out->lower[k] = lanes[i] < out->lower[k] ? (double)lanes[i] : out->lower[k];
        r_store(lanes, box.most[k]);
        for (int i = 0; i < VR; i++)
            out->upper[k] = lanes[i] > out->upper[k] ? (double)lanes[i] : out->upper[k];
    }
}

/// The outputs of a call. Each combination is compiled separately.
typedef enum R(surface_outputs) {
    R(MIXED), ///< there are triangles or solids
    R(BALLS_AND_PLANES),
    R(POINTS_ONLY) ///< only points, of balls and planes
} R(surface_outputs);

/// Stores the given lanes of a vector, without changing the others. Returns the lanes that are seen from behind.
INNER unsigned R(store_lanes)(const glint_surface_args *args, const R(surface_lanes) * surface, size_t at,
                              unsigned lanes, R(surface_outputs) outputs, R(point_box) * box)
{
    const bool whole = lanes == (1u << VR) - 1;
    const rm mask = rm_from_bits(lanes);
    for (int k = 0; k < 3; k++)
        R(put)(args->point[k], at, whole, mask, surface->point[k]);
    if (outputs == R(POINTS_ONLY))
        return 0;
    for (int k = 0; k < 3; k++)
        R(put)(args->normal[k], at, whole, mask, surface->normal[k]);
    if (args->box)
        R(enclose)(box, surface->point, whole, mask);
    if (outputs == R(MIXED) && args->slack)
        R(put)(args->slack, at, whole, mask, surface->slack);
    return rm_bits(surface->back) & lanes;
}

/// Zeroes all lanes of a group in which only some lanes have hits.
static inline void R(clear_surface)(const glint_surface_args *args, size_t at)
{
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < GLINT_GROUP; i += VR) {
            r_store((real *)args->point[k] + at + i, r_set(0));
            if (args->normal[0])
                r_store((real *)args->normal[k] + at + i, r_set(0));
            if (args->slack)
                r_store((real *)args->slack + at + i, r_set(0));
        }
    if (args->normal[0])
        lanes_put(args->material + at, 0xffff, 0);
}

INNER void R(begin_walk)(const glint_surface_args *args, R(surface_walk) * walk)
{
    for (int i = 0; i < (args->mixed ? SEEN_SLOTS : 1); i++)
        walk->slots[i].prim.id = GLINT_MISS;
    walk->last = walk->slots;
    walk->only = GLINT_MISS;
    walk->several = walk->any_back = false;
}

/// Loads the constants of another primitive. Not inlined, so that the result stays in memory, from where it is
/// broadcast to all lanes.
static __attribute__((noinline)) void R(load_other_prim)(const glint_surface_args *args, R(surface_walk) * walk,
                                                         uint32_t id)
{
    R(seen_slot) *slot = walk->last = &walk->slots[args->mixed ? id % SEEN_SLOTS : 0];
    walk->several = walk->several || (walk->only != GLINT_MISS && walk->only != id);
    walk->only = id;
    if (slot->prim.id == id)
        return;
    R(see_prim)(args, id, &slot->prim, slot->height);
}

INNER void R(load_prim)(const glint_surface_args *args, R(surface_walk) * walk, const bool mixed, uint32_t id)
{
    if (R(last_seen)(walk, mixed)->prim.id != id)
        R(load_other_prim)(args, walk, id);
}

INNER void R(end_walk)(const glint_surface_args *args, const R(surface_walk) * walk, const R(point_box) * box)
{
    if (!args->box)
        return;
    R(write_box)(*box, args->box);
    args->box->only = walk->several || walk->any_back ? GLINT_MISS : walk->only;
}

/// Computes the lanes of a group that show several triangles. Returns the lanes seen from behind.
INNER unsigned R(surface_mesh)(const glint_surface_args *args, R(surface_walk) * walk, R(point_box) * box,
                               R(group_directions) directions, size_t at, unsigned lanes)
{
    R(mesh_group) mesh;
    unsigned back = 0;
    walk->several = true;
    R(load_mesh)(args, at, lanes, &mesh);
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        const unsigned here = lanes >> i & ((1u << VR) - 1);
        if (!here)
            continue;
        R(surface_lanes) surface;
        R(find_mesh_lanes)(args, &mesh, directions, at, i, &surface);
        back |= R(store_lanes)(args, &surface, at + (size_t)i, here, R(MIXED), box) << i;
    }
    return back;
}

/// Returns whether find_whole supports the primitive.
static inline bool R(is_near_or_plane)(const R(seen_prim) * seen)
{
    const uint32_t kind = seen->prim->kind;
    return kind == GLINT_PRIM_PLANE || (kind == GLINT_PRIM_SPHERE && seen->range != R(RANGE_ANY));
}

/// Computes directions, outward normals and points of the lanes from i on of a group that shows, in every lane, one
/// plane, one solid, or one sphere that is not far from the camera; `kind` is a constant.
INNER void R(find_whole)(const glint_surface_args *args, R(seen_slot) * slot, const glint_prim_kind kind,
                         R(group_directions) directions, size_t at, int i, vr d[3], vr n[3], vr p[3])
{
    const R(seen_prim) *seen = &slot->prim;
    R(load_direction)(directions, args->direction, at, i, d);
    const vr t = r_load((const real *)args->t + at + i);
    if (kind == GLINT_PRIM_SOLID) {
        const double *eye = args->camera->eye;
        const vr from[3] = { r_set(eye[0]), r_set(eye[1]), r_set(eye[2]) };
        R(find_on_solid)(args, slot, from, d, t, n, p);
        return;
    }
    if (kind == GLINT_PRIM_SPHERE) {
        const vr f[3] = { r_set(seen->f[0]), r_set(seen->f[1]), r_set(seen->f[2]) };
        if (seen->range == R(RANGE_CLOSE))
            R(sphere_surface)(f, d, t, seen->prim, seen->scale, seen->inverse_radius, R(RANGE_CLOSE), n, p);
        else
            R(sphere_surface)(f, d, t, seen->prim, seen->scale, seen->inverse_radius, R(RANGE_NEAR), n, p);
    }
    for (int k = 0; k < 3 && kind == GLINT_PRIM_PLANE; k++) {
        n[k] = r_set(seen->normal[k]);
        p[k] = r_set(seen->from[k]) + r_set(seen->factor[k]) * (t * d[k]);
    }
    if (kind == GLINT_PRIM_PLANE && seen->level == 3)
        R(onto_plane_of)(seen->prim, n, p);
}

/// Computes only the points of a group that shows one plane perpendicular to axis `level`, a constant.
INNER void R(place_level)(const glint_surface_args *args, const R(seen_prim) * seen, R(group_directions) directions,
                          size_t at, const int level)
{
    for (int k = 0; k < 3; k++) {
        real *to = (real *)args->point[k] + at;
        const real *across = directions.across + k * GLINT_GROUP, *down = directions.down + k * GLINT_GROUP;
        for (int i = 0; i < GLINT_GROUP; i += VR) {
            vr p = r_set(seen->from[k]);
            if (k != level)
                p = p + r_load((const real *)args->t + at + i) * (r_load(across + i) + r_load(down + i));
            r_store(to + i, p);
        }
    }
}

/// Computes only the points of a group that shows one sphere, or one plane of any other direction. kind: a constant.
INNER void R(place_lanes)(const glint_surface_args *args, R(seen_slot) * slot, const glint_prim_kind kind,
                          R(group_directions) directions, size_t at)
{
    for (int i = 0; i < GLINT_GROUP; i += VR) {
        vr d[3], n[3], p[3];
        R(find_whole)(args, slot, kind, directions, at, i, d, n, p);
        for (int k = 0; k < 3; k++)
            r_store((real *)args->point[k] + at + i, p[k]);
    }
}

/// Computes only the points of a group that shows one primitive.
INNER void R(place_whole)(const glint_surface_args *args, R(seen_slot) * slot, R(group_directions) directions, size_t at)
{
    const R(seen_prim) *seen = &slot->prim;
    if (seen->prim->kind == GLINT_PRIM_SPHERE)
        R(place_lanes)(args, slot, GLINT_PRIM_SPHERE, directions, at);
    else if (seen->level == 0)
        R(place_level)(args, seen, directions, at, 0);
    else if (seen->level == 1)
        R(place_level)(args, seen, directions, at, 1);
    else if (seen->level == 2)
        R(place_level)(args, seen, directions, at, 2);
    else
        R(place_lanes)(args, slot, GLINT_PRIM_PLANE, directions, at);
}

/// Computes one group with hits: its triangles together, if there are several, and the other lanes primitive by
/// primitive.
INNER void R(surface_group)(const glint_surface_args *args, R(surface_walk) * walk, R(point_box) * box,
                            R(group_cursor) cursor, R(surface_outputs) outputs)
{
    const uint32_t g = cursor.g;
    const size_t at = (size_t)g * GLINT_GROUP;
    const R(group_directions) directions = R(directions_of)(args->camera, cursor.x, cursor.y);
    unsigned rest = args->hits[g], back = 0, dark = 0;
    if (rest != 0xffff)
        R(clear_surface)(args, at);
    const bool meshes = outputs == R(MIXED) && args->slack; // only triangles need slack
    const unsigned mesh = meshes ? R(mesh_lanes)(args, at, rest) : 0;
    if (mesh) {
        back = R(surface_mesh)(args, walk, box, directions, at, mesh);
        dark = back & R(put_materials)(args, at, mesh);
        rest &= ~mesh;
    }
    while (rest) {
        R(seen_slot) *slot = R(last_seen)(walk, outputs == R(MIXED));
        uint32_t id = slot->prim.id; // the last primitive of the previous group is not looked up again
        unsigned lanes = lanes_equal(args->prim + at, id) & rest, behind = 0;
        if (!lanes) {
            id = args->prim[at + (unsigned)__builtin_ctz(rest)];
            lanes = lanes_equal(args->prim + at, id) & rest;
            R(load_prim)(args, walk, outputs == R(MIXED), id);
            slot = R(last_seen)(walk, outputs == R(MIXED));
        }
        const bool placed =
            outputs == R(POINTS_ONLY) && args->camera && lanes == 0xffff && R(is_near_or_plane)(&slot->prim);
        if (placed)
            R(place_whole)(args, slot, directions, at);
        for (int i = placed ? GLINT_GROUP : 0; i < GLINT_GROUP; i += VR) {
            const unsigned here = lanes >> i & ((1u << VR) - 1);
            if (!here)
                continue;
            R(surface_lanes) surface;
            R(find_lanes)(args, slot, directions, at, i, outputs == R(MIXED), &surface);
            behind |= R(store_lanes)(args, &surface, at + (size_t)i, here, outputs, box) << i;
        }
        if (outputs != R(POINTS_ONLY))
            lanes_put(args->material + at, lanes, slot->prim.prim->material);
        back |= behind;
        if (!slot->prim.prim->two_sided)
            dark |= behind;
        rest &= ~lanes;
    }
    if (outputs == R(POINTS_ONLY))
        return;
    args->back[g] = (uint16_t)back;
    args->dark[g] = (uint16_t)dark;
    walk->any_back = walk->any_back || back;
}

INNER void R(surface_groups)(const glint_surface_args *args, R(surface_outputs) outputs)
{
    R(surface_walk) walk;
    R(point_box) box;
    R(begin_walk)(args, &walk);
    R(empty_box)(&box);
    for (R(group_cursor) cursor = { 0 }; cursor.g < args->group_count; R(next_group)(args->camera, &cursor)) {
        if (args->hits[cursor.g])
            R(surface_group)(args, &walk, &box, cursor, outputs);
        else if (outputs != R(POINTS_ONLY))
            args->back[cursor.g] = args->dark[cursor.g] = 0;
    }
    R(end_walk)(args, &walk, &box);
}

static void R(surface)(const glint_surface_args *args)
{
    if (!args->normal[0])
        R(surface_groups)(args, R(POINTS_ONLY));
    else if (args->mixed)
        R(surface_groups)(args, R(MIXED));
    else
        R(surface_groups)(args, R(BALLS_AND_PLANES));
}

#endif
