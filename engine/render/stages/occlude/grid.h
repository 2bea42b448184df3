// grid: tests points of a tile against the occluders in the cells of the light's view (glint_light_grid). Each point
// searches its cell for entries that may block it, nearest to the light first. These pairs of point and entry are
// decided a vector at a time, with a different sphere in each lane, until every point is blocked or has no entry left.
// Contract: stages.h, occlude.
#ifndef GLINT_OCCLUDE_GRID_H
#define GLINT_OCCLUDE_GRID_H

#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/cast/triangle.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/occlude/occlude.h"
#include "engine/render/stages/simd/real.h"

#if GLINT_REAL == 64

#define GRID_FAR 0x1p20 // for directional lights, in the index's units: the projection of points beyond this distance
    // is not accurate enough
#define GRID_REACH (GLINT_GRID_RADIUS * GLINT_GRID_RADIUS * (1 + 0x1p-20f)) // steps^2 per unit radius^2, plus rounding
#define GRID_BIAS 0x1p23f // an integer n below 2^23 is the lower bits of the float GRID_BIAS + n

/// Points that may be blocked, and their state.
typedef struct grid_points {
    uint32_t count, live_count;
    uint16_t live[GLINT_TILE_SAMPLES]; ///< points that are not decided yet
    float uv[2][GLINT_TILE_SAMPLES], near[GLINT_TILE_SAMPLES]; ///< positions and depths in the format of entries,
        ///< plus GRID_BIAS
    float reach[GLINT_TILE_SAMPLES]; ///< factor of the square of an entry's radius
    uint32_t next[GLINT_TILE_SAMPLES], end[GLINT_TILE_SAMPLES]; ///< the entries of the cell that are still to be tested
    uint16_t at[GLINT_TILE_SAMPLES]; ///< number of the sample
} grid_points;

/// Pairs of a point and the sphere that it is tested against.
typedef struct grid_pairs {
    uint32_t count;
    uint32_t id[GLINT_TILE_SAMPLES];
    uint16_t point[GLINT_TILE_SAMPLES]; ///< index in the points
} grid_pairs;

// ---- Projected positions ----

/// A group's projected positions in the light's view.
typedef struct grid_coords {
    _Alignas(64) float uv[2][GLINT_GROUP], w[GLINT_GROUP], reach[GLINT_GROUP];
    _Alignas(64) uint32_t cell[GLINT_GROUP];
    unsigned known; ///< lanes whose positions are defined
} grid_coords;

/// Projects VD lanes from i on.
static void grid_lane_coords(const glint_occlude_args *args, size_t at, int i, grid_coords *out)
{
    const glint_light_grid *grid = args->grid;
    const vd one = d_set(1);
    vd x[3], seen[3], size = d_set(0), reach = one, per_w = one;
    for (int k = 0; k < 3; k++)
        x[k] = d_load((const double *)args->point[k] + at + i) - d_set(grid->origin[k]);
    for (int j = 0; j < 3; j++) {
        seen[j] = (d_set(grid->axis[j][0]) * x[0] + d_set(grid->axis[j][1]) * x[1]) + d_set(grid->axis[j][2]) * x[2];
        size = size + abs_f64(seen[j]);
    }
    if (!grid->directional)
        per_w = one / seen[2];
    for (int j = 0; j < 2; j++) {
        const vd coord = seen[j] * per_w;
        if (!grid->directional)
            reach = reach + coord * coord;
        d_store_f(out->uv[j] + i, coord);
    }
    d_store_f(out->w + i, seen[2]);
    d_store_f(out->reach + i, reach);
    out->known |= dm_bits(d_lt(size, d_set(grid->directional ? GRID_FAR : 0x1p100))) << i;
}

/// Returns integers below GRID_BIAS plus GRID_BIAS, as floats.
static inline vf grid_biased(vi x) { return f_from_bits(i_or(x, i_set(0x4b000000))); }

/// Computes the cells of a group's points, and the projected positions in the format of entries. Returns the lanes
/// that are in a cell and farther from the light than the nearest of all entries.
static unsigned grid_cells(const glint_light_grid *grid, grid_coords *coords)
{
    const vf bias = f_set(GRID_BIAS), aside = f_set((float)(GLINT_GRID_ASIDE * GLINT_GRID_STEPS) + GRID_BIAS);
    unsigned inside = 0;
    for (int i = 0; i < GLINT_GROUP; i += VF) {
        const vf w = f_load(coords->w + i);
        vi cell[2];
        fm in = f_le(f_set(grid->nearest), w);
        for (int j = 0; j < 2; j++) {
            const vf x = (f_load(coords->uv[j] + i) - f_set(grid->first[j])) * f_set(grid->cells);
            in = fm_and(in, fm_and(f_le(f_set(0), x), f_lt(x, f_set((float)grid->count[j]))));
            cell[j] = i_from_f(f_select(in, x, f_set(0)));
            f_store(coords->uv[j] + i, (x - (grid_biased(cell[j]) - bias)) * f_set(GLINT_GRID_STEPS) + aside);
        }
        f_store(coords->w + i, (w - f_set(grid->nearest)) * f_set(grid->slices) + bias);
        f_store(coords->reach + i, f_load(coords->reach + i) * f_set(GRID_REACH));
        i_store(coords->cell + i, i_or(i_shl(cell[1], 16), cell[0])); // upper half: row, lower half: column
        inside |= fm_bits(in) << i;
    }
    return inside;
}

/// Returns the lanes of `back`, which are seen from behind, that are on a sphere in a cell. The light is outside of
/// the sphere, so the sphere blocks the light.
static unsigned grid_own(const glint_occlude_args *args, size_t at, unsigned back)
{
    const glint_light_grid *grid = args->grid;
    unsigned blocked = 0;
    for (; back; back &= back - 1) {
        const uint32_t id = args->prim[at + (unsigned)__builtin_ctz(back)];
        bool other = id == GLINT_MISS || args->geometry->prims[id].kind != GLINT_PRIM_SPHERE;
        for (uint32_t k = 0; k < grid->other_count && !other; k++)
            other = grid->others[k] == id;
        blocked |= other ? 0 : back & -back;
    }
    return blocked;
}

/// Adds lanes of a group, and prefetches the entries of their cells.
static void grid_add_lanes(const glint_light_grid *grid, const grid_coords *coords, uint32_t g, unsigned lanes,
                           grid_points *points)
{
    for (; lanes; lanes &= lanes - 1) {
        const uint32_t lane = (unsigned)__builtin_ctz(lanes), k = points->count;
        const uint32_t cell = (coords->cell[lane] >> 16) * grid->count[0] + (coords->cell[lane] & 0xffff);
        const uint32_t next = grid->begin[cell], end = grid->begin[cell + 1];
        if (next == end)
            continue;
        __builtin_prefetch(grid->center + next);
        __builtin_prefetch(grid->size + next);
        points->next[k] = next;
        points->end[k] = end;
        points->uv[0][k] = coords->uv[0][lane];
        points->uv[1][k] = coords->uv[1][lane];
        points->near[k] = coords->w[lane];
        points->reach[k] = coords->reach[lane];
        points->at[k] = (uint16_t)(g * GLINT_GROUP + lane);
        points->live[k] = (uint16_t)k;
        points->count++;
    }
}

/// Adds the unoccluded points of a group that may be blocked. Returns false if some projected position is unknown.
static bool grid_add_group(const glint_occlude_args *args, uint32_t g, grid_points *points)
{
    const size_t at = (size_t)g * GLINT_GROUP;
    grid_coords coords;
    coords.known = 0;
    for (int i = 0; i < GLINT_GROUP; i += VD)
        grid_lane_coords(args, at, i, &coords);
    if (args->unoccluded[0][g] & ~coords.known)
        return false;
    args->unoccluded[0][g] &= (uint16_t)~grid_own(args, at, args->unoccluded[0][g] & args->back[g]);
    grid_add_lanes(args->grid, &coords, g, args->unoccluded[0][g] & grid_cells(args->grid, &coords), points);
    return true;
}

// ---- The filter ----

static inline vi grid_load(const uint32_t *p) { return f_bits(f_load_any((const float *)p)); }

/// Returns an entry's position along an axis, in the format of points: the lower 16 bits.
static inline vf grid_step(vi center) { return grid_biased(i_and(center, i_set(0xffff))); }

/// Returns the lanes in which the distance in steps, (du, dv), is within an entry's reach.
static inline fm grid_within(vi size, vf du, vf dv, vf reach)
{
    const vf radius = grid_biased(i_and(size, i_set((1u << GLINT_GRID_RADIUS_BITS) - 1))) - f_set(GRID_BIAS);
    return f_le(du * du + dv * dv, radius * radius * reach);
}

/// Returns the lanes in which an entry is near enough to the light to block a point at depth w.
static inline fm grid_before(vi size, vf w) { return f_le(grid_biased(i_shr(size, GLINT_GRID_RADIUS_BITS)), w); }

/// Returns the next entry that may block point k, whose own primitive is `own`; GLINT_MISS: none.
static uint32_t grid_next(const glint_light_grid *grid, const grid_points *points, uint32_t k, uint32_t own)
{
    const uint32_t end = points->end[k];
    const vf u = f_set(points->uv[0][k]), v = f_set(points->uv[1][k]), reach = f_set(points->reach[k]);
    const vf w = f_set(points->near[k]);
    for (uint32_t from = points->next[k]; from < end; from += VF) {
        const unsigned there = end - from < VF ? (1u << (end - from)) - 1 : (1u << VF) - 1;
        const vi center = grid_load(grid->center + from), size = grid_load(grid->size + from);
        const unsigned before = fm_bits(grid_before(size, w)) & there;
        unsigned near =
            before & fm_bits(grid_within(size, grid_step(center) - u, grid_step(i_shr(center, 16)) - v, reach));
        for (; near; near &= near - 1)
            if (grid->id[from + (unsigned)__builtin_ctz(near)] != own)
                return from + (unsigned)__builtin_ctz(near);
        if (grid->sorted && before != there) // the remaining entries are behind the point
            break;
    }
    return GLINT_MISS;
}

/// Makes a pair of each undecided point and its next entry. Points without a next entry are unoccluded.
static void grid_pair(const glint_occlude_args *args, grid_points *points, grid_pairs *pairs)
{
    pairs->count = 0;
    for (uint32_t i = 0; i < points->live_count; i++) {
        const uint32_t k = points->live[i];
        const uint32_t entry = grid_next(args->grid, points, k, args->prim[points->at[k]]), n = pairs->count;
        if (entry == GLINT_MISS)
            continue;
        points->next[k] = entry + 1;
        pairs->id[n] = args->grid->id[entry];
        pairs->point[n] = (uint16_t)k;
        pairs->count++;
        const char *prim = (const char *)&args->geometry->prims[pairs->id[n]];
        __builtin_prefetch(prim);
        __builtin_prefetch(prim + 64);
    }
}

// ---- The decision ----

/// The data of VD pairs, in the format in which the decision reads it.
typedef struct grid_lanes {
    _Alignas(64) double center[3][VD], scale[VD], r2[VD], r2_low[VD], point[3][VD];
} grid_lanes;

/// Returns the lanes whose sphere blocks the light. The light is outside of the sphere. Otherwise like sphere_blocks.
static unsigned grid_blocked(const glint_occlude_args *args, const grid_lanes *lanes)
{
    const vd zero = d_set(0), scale = d_load(lanes->scale), r2 = d_load(lanes->r2);
    vd f[3], d[3];
    for (int k = 0; k < 3; k++) {
        const vd p = d_load(lanes->point[k]);
        f[k] = (p - d_load(lanes->center[k])) * scale;
        d[k] = d_set(args->position[k]);
        if (!args->directional)
            d[k] = (d[k] - p) * d_set(args->scale);
    }
    const vd c = exact_power_f64(f, r2, d_load(lanes->r2_low)), a = DOT(d, d), b = -DOT(f, d);
    dm blocked = dm_and(d_lt(zero, b), d_le(zero, discriminant_f64(f, d, a, b, c, r2)));
    if (!args->directional)
        blocked = dm_and(blocked, d_lt(b * d_set(args->scale), a * scale));
    return dm_bits(dm_or(d_lt(c, zero), blocked));
}

/// Decides all pairs. Blocked points are removed from the undecided points; the others stay undecided.
static void grid_decide(const glint_occlude_args *args, const grid_pairs *pairs, grid_points *points)
{
    grid_lanes lanes;
    points->live_count = 0;
    for (uint32_t first = 0; first < pairs->count; first += VD) {
        const uint32_t there = pairs->count - first < VD ? pairs->count - first : VD;
        for (uint32_t n = 0; n < VD; n++) { // lanes without a pair use the first one
            const uint32_t pair = first + (n < there ? n : 0), at = points->at[pairs->point[pair]];
            const glint_prim *prim = &args->geometry->prims[pairs->id[pair]];
            for (int k = 0; k < 3; k++) {
                lanes.center[k][n] = prim->center[k];
                lanes.point[k][n] = ((const double *)args->point[k])[at];
            }
            lanes.scale[n] = glint_sphere_scale(prim);
            lanes.r2[n] = glint_sphere_r2(prim);
            lanes.r2_low[n] = glint_sphere_r2_low(prim);
        }
        count_tests(args->tests, (1u << there) - 1);
        const unsigned blocked = grid_blocked(args, &lanes);
        for (uint32_t n = 0; n < there; n++) {
            const uint32_t k = pairs->point[first + n], at = points->at[k];
            if (blocked >> n & 1)
                args->unoccluded[0][at / GLINT_GROUP] &= (uint16_t) ~(1u << at % GLINT_GROUP);
            else
                points->live[points->live_count++] = (uint16_t)k;
        }
    }
}

// ---- All ----

/// Removes from args->unoccluded the points that are blocked by primitives that are in no cell.
static void grid_others(const shadow_tile_f64 *tile, shadow_group_f64 *group)
{
    const glint_occlude_args *args = tile->args;
    const glint_light_grid *grid = args->grid;
    for (uint32_t k = 0; k < grid->other_count; k++) {
        const glint_prim *prim = &args->geometry->prims[grid->others[k]];
        const occluder_f64 occluder = { grid->others[k], seen_sides_f64(tile, NULL, prim) };
        for (uint32_t g = 0; g < args->group_count; g++) {
            begin_group_f64(g, group);
            if (args->unoccluded[0][g])
                args->unoccluded[0][g] &= (uint16_t)~blocked_by_f64(tile, occluder, group, args->unoccluded[0][g]);
        }
    }
}

/// Removes from args->unoccluded the points that the index's primitives block. Returns false if some projected
/// position is unknown; the result is then incomplete.
static bool occlude_grid(const shadow_tile_f64 *tile, shadow_group_f64 *group)
{
    const glint_occlude_args *args = tile->args;
    grid_points points;
    grid_pairs pairs;
    grid_others(tile, group);
    points.count = 0;
    for (uint32_t g = 0; g < args->group_count; g++)
        if (args->unoccluded[0][g] && !grid_add_group(args, g, &points))
            return false;
    points.live_count = points.count;
    while (points.live_count && !is_stopped(args->stop)) {
        grid_pair(args, &points, &pairs);
        grid_decide(args, &pairs, &points);
    }
    return true;
}

#endif

/// Computes the occlusion with the grid. Returns false if there is no grid or the grid cannot be used. It is never
/// used if float decides, because its entries may differ from the spheres that float would hit.
static inline bool R(occlude_by_grid)(const R(shadow_tile) * tile, R(shadow_group) * group)
{
#if GLINT_REAL == 64
    return tile->args->grid && occlude_grid(tile, group);
#else
    (void)tile;
    (void)group;
    return false;
#endif
}

#endif
