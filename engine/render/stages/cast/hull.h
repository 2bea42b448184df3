// hull: the intervals of rays inside a closed mesh that is a part of a combined solid. A point is inside if the rest
// of the ray leaves the mesh more often than it enters. This also holds at edges and corners, because each ray
// crosses at most one of the triangles that share an edge or corner. The ray is treated as if it were shifted along
// the two axes perpendicular to the direction's largest component, by an infinitesimal amount, infinitely more along
// the second axis than along the first. Contract: stages.h, cast.
#ifndef GLINT_CAST_HULL_H
#define GLINT_CAST_HULL_H

#include "engine/render/stages/cast/face.h"
#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/shared_edge.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/simd/real.h"

#define HULL_CROSSINGS_MAX 16 ///< number of crossings of a ray that are stored at a time

/// The crossings of one ray with triangles, ahead of its origin, nearest first.
typedef struct R(crossings) {
    int count, sum; ///< sum: number of exits minus entries over all crossings
    real t[HULL_CROSSINGS_MAX];
    int winding[HULL_CROSSINGS_MAX]; ///< exits minus entries at that t
    uint32_t triangle[HULL_CROSSINGS_MAX]
                     [2]; ///< at that t, the first triangle through which the ray enters, and the first one through
        ///< which it leaves; GLINT_MISS: none
    uint32_t begun[2]; ///< the same for crossings at the ray's origin
    real lost; ///< the nearest crossing that could not be stored; inf: none
} R(crossings);

/// A vector of rays that are tested against one mesh.
typedef struct R(hull_rays) {
    const glint_geometry_table *table;
    const glint_prim *part;
    const vr *o, *d;
    const uint32_t *on; ///< the primitive that each ray starts on; NULL: none
    vr permuted[3]; ///< the direction, with the axes permuted so that its largest component is last
    rm y, z; ///< lanes whose direction has y, or z, as its largest component; in the other lanes it is x
    _Alignas(64) real origin[3][VR];
    _Alignas(64) real from[VR]; ///< t up to which crossings were handled before
    ray_view view[VR];
    R(crossings) of[VR];
} R(hull_rays);

static inline void R(permute_axes)(const R(hull_rays) * rays, const vr v[3], vr out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = r_select(rays->z, v[k], r_select(rays->y, v[(k + 2) % 3], v[(k + 1) % 3]));
}

static void R(begin_hull_rays)(R(hull_rays) * rays, vr from)
{
    const glint_geometry_table *table = rays->table;
    const vr ax = R(abs)(rays->d[0]), ay = R(abs)(rays->d[1]), az = R(abs)(rays->d[2]);
    _Alignas(64) real local[3][VR], dir[3][VR];
    rays->y = r_lt(ax, ay);
    rays->z = r_lt(r_select(rays->y, ay, ax), az);
    R(permute_axes)(rays, rays->d, rays->permuted);
    r_store(rays->from, from);
    for (int k = 0; k < 3; k++) {
        r_store(rays->origin[k], rays->o[k]);
        r_store(local[k], (rays->o[k] - r_set(table->reference[k])) * r_set(table->scale));
        r_store(dir[k], rays->d[k]);
    }
    for (int i = 0; i < VR; i++) {
        rays->view[i].slack = R(walk_slack)(table);
        for (int k = 0; k < 3; k++) {
            rays->view[i].origin[k] = (float)local[k][i];
            rays->view[i].inverse[k] = 1 / (float)dir[k][i];
        }
        rays->of[i].count = rays->of[i].sum = 0;
        rays->of[i].begun[0] = rays->of[i].begun[1] = GLINT_MISS;
        rays->of[i].lost = (real)HUGE_VAL;
    }
}

/// Stores a triangle if, of the triangles crossed at this t in the same direction, it was defined first.
static inline void R(note_triangle)(uint32_t found[2], int winding, uint32_t index)
{
    if (index < found[winding > 0])
        found[winding > 0] = index;
}

static void R(store_crossing)(R(crossings) * of, real t, int winding, uint32_t index)
{
    int at = 0;
    if (!(t < of->lost))
        return;
    while (at < of->count && of->t[at] < t)
        at++;
    if (at == of->count || of->t[at] != t) {
        if (of->count == HULL_CROSSINGS_MAX)
            of->lost = at == HULL_CROSSINGS_MAX ? t : of->t[--of->count];
        if (at == HULL_CROSSINGS_MAX)
            return;
        for (int i = of->count++; i > at; i--) {
            of->t[i] = of->t[i - 1];
            of->winding[i] = of->winding[i - 1];
            memcpy(of->triangle[i], of->triangle[i - 1], sizeof of->triangle[i]);
        }
        of->t[at] = t;
        of->winding[at] = 0;
        of->triangle[at][0] = of->triangle[at][1] = GLINT_MISS;
    }
    of->winding[at] += winding;
    R(note_triangle)(of->triangle[at], winding, index);
}

static inline bool R(starts_on_hull)(const R(hull_rays) * rays, int i)
{
    const glint_hull *hull = &rays->table->hulls[rays->part->item];
    return rays->on && rays->on[i] != GLINT_MISS && rays->on[i] - (rays->table->prim_count + hull->first) < hull->count;
}

/// Stores the crossings with the triangle: rays of `out` leave through it, rays of `in` enter through it.
static void R(note_crossings)(R(hull_rays) * rays, uint32_t index, unsigned out, unsigned in, vr crossing_t)
{
    const glint_prim *prim = &rays->table->prims[index];
    const real near = R(near_shared_edge)(rays->table);
    _Alignas(64) real t[VR];
    r_store(t, crossing_t);
    for (unsigned bits = out | in; bits; bits &= bits - 1) {
        const int i = __builtin_ctz(bits), orientation = out >> i & 1 ? 1 : -1;
        const bool on_surface = rays->on && rays->on[i] != GLINT_MISS, on_hull = R(starts_on_hull)(rays, i);
        bool begun = t[i] == 0; // this is only exact for shared planes; at an edge, rounding decides
        if (rays->on && rays->on[i] == index)
            continue;
        if ((!prim->face || on_hull) && t[i] <= near && -near <= t[i]) {
            const R(flat) flat = R(flat_of)(prim, rays->table->scale);
            const real point[3] = { rays->origin[0][i], rays->origin[1][i], rays->origin[2][i] };
            begun = R(is_in_plane)(&flat, point, on_surface) || begun;
        }
        if (begun) {
            R(note_triangle)(rays->of[i].begun, orientation, index);
        } else if (rays->from[i] < t[i]) {
            rays->of[i].sum += orientation;
            R(store_crossing)(&rays->of[i], t[i], orientation, index);
        }
    }
}

/// Tests one triangle for the rays of `lanes`.
static void R(cross_triangle)(R(hull_rays) * rays, uint32_t index, unsigned lanes)
{
    const glint_prim *prim = &rays->table->prims[index];
    const vr zero = r_set(0), scale = r_set(rays->table->scale);
    const vr dx = rays->permuted[0], dy = rays->permuted[1], dz = rays->permuted[2];
    vr p[3][3], x[3], y[3], z[3];
    rm up = r_lt(zero, zero), down = up;
    R(corners_from)(rays->o, prim, rays->table->scale, p);
    for (int j = 0; j < 3; j++) {
        vr c[3];
        R(permute_axes)(rays, p[j], c);
        x[j] = c[0] * dz - c[2] * dx;
        y[j] = c[1] * dz - c[2] * dy;
        z[j] = c[2];
    }
    for (int j = 0; j < 3; j++) {
        const int k = (j + 1) % 3;
        const vr side = x[j] * y[k] - y[j] * x[k];
        up = rm_or(up, rm_and(rm_and(r_le(y[j], zero), r_lt(zero, y[k])), r_lt(zero, side)));
        down = rm_or(down, rm_and(rm_and(r_le(y[k], zero), r_lt(zero, y[j])), r_lt(side, zero)));
    }
    const rm ahead = r_lt(zero, dz), left = rm_andnot(up, down), right = rm_andnot(down, up);
    const unsigned with = rm_bits(rm_or(rm_and(left, ahead), rm_andnot(right, ahead))) & lanes;
    const unsigned against = rm_bits(rm_or(rm_and(right, ahead), rm_andnot(left, ahead))) & lanes;
    if (!(with | against))
        return;
    const glint_face *face = R(face_of)(rays->table, prim);
    vr t;
    if (face) {
        t = R(face_t)(face, rays->o, rays->d);
    } else {
        const R(ray_edges) edges = R(make_ray_edges)(p, rays->d, false);
        for (int j = 0; j < 3; j++)
            z[j] = z[j] / (dz * scale);
        t = edges.depth / ((R(det)(&edges) * edges.dz) * scale);
        t = r_min(r_max(t, r_min(r_min(z[0], z[1]), z[2])), r_max(r_max(z[0], z[1]), z[2]));
    }
    R(note_crossings)(rays, index, rays->part->inverted ? against : with, rays->part->inverted ? with : against, t);
}

/// Finds all triangles that the rays of `lanes` cross.
static void R(walk_hull)(R(hull_rays) * rays, const glint_hull *hull, unsigned lanes)
{
    struct {
        uint32_t node;
        unsigned lanes;
    } stack[WALK_STACK];
    int height = 0;
    stack[height].node = 0;
    stack[height++].lanes = lanes;
    while (height > 0) {
        const glint_node *node = &hull->nodes[stack[--height].node];
        unsigned near[GLINT_NODE_WIDTH] = { 0 };
        for (unsigned bits = stack[height].lanes; bits; bits &= bits - 1) {
            _Alignas(64) float depth[GLINT_NODE_WIDTH];
            for (unsigned slots = boxes_on_ray(node, &rays->view[__builtin_ctz(bits)], HUGE_VALF, depth); slots;
                 slots &= slots - 1)
                near[__builtin_ctz(slots)] |= bits & -bits;
        }
        for (int i = 0; i < GLINT_NODE_WIDTH; i++) {
            const uint32_t child = node->child[i];
            if (near[i] && child & GLINT_NODE_PRIM) {
                R(cross_triangle)(rays, rays->table->prim_count + hull->first + (child & ~GLINT_NODE_PRIM), near[i]);
            } else if (near[i]) {
                stack[height].node = child;
                stack[height++].lanes = near[i];
            }
        }
    }
}

/// The intervals of one ray inside a mesh, with the triangles where it enters and leaves.
typedef struct R(ray_within) {
    int count;
    real t[2][GLINT_HULL_PARTS];
    uint32_t triangle[2][GLINT_HULL_PARTS];
    real known; ///< t up to which all intervals are known
} R(ray_within);

/// Makes the crossings of a ray that starts on the mesh agree with whether it goes inside: if the crossings ahead
/// disagree, adds an exit or entry at its origin.
static int R(agree_at_start)(R(crossings) * of, uint32_t on, bool inside)
{
    const int winding = (inside ? 1 : 0) - of->sum;
    if (inside == (of->sum > 0))
        return of->sum;
    const uint32_t begun = of->begun[winding > 0];
    R(store_crossing)(of, (real)GLINT_LEAST_T, winding, begun == GLINT_MISS ? on : begun);
    return inside;
}

/// Computes the intervals. remaining: exits minus entries that are still ahead of the ray.
static void R(find_within)(const R(crossings) * of, int remaining, R(ray_within) * in)
{
    in->count = 0;
    in->known = of->lost;
    in->t[0][0] = (real)-HUGE_VAL;
    for (int i = 0; i < of->count; i++) {
        const int after = remaining - of->winding[i], side = remaining > 0;
        if (side != (after > 0)) {
            if (!side && in->count == GLINT_HULL_PARTS) {
                in->known = of->t[i];
                return;
            }
            in->t[side][in->count] = of->t[i];
            in->triangle[side][in->count] = of->triangle[i][side];
            in->count += side;
        }
        remaining = after;
    }
    if (remaining > 0)
        in->t[1][in->count++] = (real)HUGE_VAL;
}

/// Computes the intervals of the rays of `lanes` inside a mesh, GLINT_HULL_PARTS at a time. `t` and `triangle` belong
/// to the parts of the mesh; *known: t up to which the intervals are complete. into: lanes whose rays go into the
/// mesh if they start on it. first: whether this is the first call for these rays. Returns the parts with an
/// interval, one bit each.
static unsigned R(hull_stretches)(R(hull_rays) * rays, unsigned lanes, unsigned into, bool first, vr *const t[2],
                                  uint32_t (*const triangle[2])[VR], vr *known)
{
    const glint_hull *hull = &rays->table->hulls[rays->part->item];
    _Alignas(64) real ends[2][GLINT_HULL_PARTS][VR], known_to[VR];
    int most = 0;
    R(walk_hull)(rays, hull, lanes);
    for (int i = 0; i < VR; i++) {
        R(ray_within) in = { .count = 0, .known = (real)HUGE_VAL };
        R(crossings) *of = &rays->of[i];
        if (lanes >> i & 1) {
            const bool own = first && R(starts_on_hull)(rays, i);
            R(find_within)(of, own ? R(agree_at_start)(of, rays->on[i], into >> i & 1) : of->sum, &in);
        }
        known_to[i] = in.known;
        most = in.count > most ? in.count : most;
        for (int k = 0; k < GLINT_HULL_PARTS; k++)
            for (int end = 0; end < 2; end++) {
                ends[end][k][i] = k < in.count ? in.t[end][k] : (real)(end ? -HUGE_VAL : HUGE_VAL);
                triangle[end][k][i] = k < in.count ? in.triangle[end][k] : GLINT_MISS;
            }
    }
    for (int k = 0; k < GLINT_HULL_PARTS; k++)
        for (int end = 0; end < 2; end++)
            t[end][k] = r_load(ends[end][k]);
    *known = r_min(*known, r_load(known_to));
    return (1u << most) - 1;
}

#endif
