// beam_points: sorts the points of a tile into cells of the light's view (beam.h), so that each occluder is tested
// against few points.
#ifndef GLINT_OCCLUDE_BEAM_POINTS_H
#define GLINT_OCCLUDE_BEAM_POINTS_H

#include "engine/render/stages/cast/meet.h"
#include "engine/render/stages/index/leaf.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/occlude/beam.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/simd/real.h"

/// One surface, and up to a group of points that are decided against it. The points need not be neighbours.
typedef struct R(beam_batch) {
    glint_occlude_args args; ///< arguments of the call, with these points instead of the tile's
    _Alignas(64) real point[3][GLINT_GROUP];
    uint16_t back;
    uint16_t from[GLINT_GROUP]; ///< index in the beam
    _Alignas(64) uint32_t on[GLINT_GROUP]; ///< the primitive that each point is on
    int count;
    unsigned own; ///< lanes whose point is on the surface itself
} R(beam_batch);

#define GLINT_BEAM_PAIRS (2 * GLINT_GROUP)

#define GLINT_BEAM_RUNS 128 ///< if there are more runs, pairs are made before the next triangle

/// The points that a primitive may block, out of VF consecutive points in the beam.
typedef struct R(near_points) {
    uint16_t first, near;
    uint16_t own, slot; ///< for a triangle: the points that are on it, and the slot of the triangle
} R(near_points);

/// The triangles of a node, and pairs of a triangle and a point that are to be decided.
typedef struct R(beam_leaf) {
    _Alignas(64) real corner[3][3][GLINT_NODE_WIDTH]; ///< the corners of the triangle in each slot
    _Alignas(64) real point[3][GLINT_BEAM_PAIRS], direction[3][GLINT_BEAM_PAIRS], slack[GLINT_BEAM_PAIRS];
    _Alignas(64) uint32_t slot[GLINT_BEAM_PAIRS];
    uint16_t from[GLINT_BEAM_PAIRS]; ///< index in the beam
    unsigned own, back; ///< pairs whose point is on the triangle; pairs whose point is seen from behind
    int count;
    const glint_node *node;
    leaf_on_screen shown;
    _Alignas(64) uint32_t cells[GLINT_NODE_WIDTH]; ///< the cells of each triangle, in the format of screen_cells
} R(beam_leaf);

typedef struct R(beam) {
    const R(shadow_tile) * tile;
    screen_view view;
    uint32_t count, unoccluded; ///< number of points, and number of points without an occluder so far
    // the points in the order of cells, row by row
    _Alignas(64) float uv[2][GLINT_TILE_SAMPLES + GLINT_GROUP];
    _Alignas(64) float w[GLINT_TILE_SAMPLES + GLINT_GROUP]; ///< -inf for blocked points
    uint32_t own[GLINT_TILE_SAMPLES + GLINT_GROUP]; ///< the primitive that the point is on, with the flag BEAM_BACK
        ///< if it is seen from behind
    uint16_t at[GLINT_TILE_SAMPLES + GLINT_GROUP], cell[GLINT_TILE_SAMPLES + GLINT_GROUP];
    uint16_t begin[BEAM_DOWN * SCREEN_ACROSS + 1]; ///< index of the first point of each cell
    _Alignas(64) float far[BEAM_DOWN][SCREEN_ACROSS]; ///< maximum w of each cell's unoccluded points
    R(beam_batch) batch;
    R(beam_leaf) leaf;
    R(near_points) run[GLINT_BEAM_RUNS + 1 + GLINT_TILE_SAMPLES / VF + BEAM_DOWN]; ///< points that a triangle may
        ///< block and that are not yet paired with it
    int runs;
} R(beam);

// ---- The points ----

/// Sets the beam's frame. Returns false if the light is in the middle of the points.
static bool R(aim_beam)(const R(shadow_tile) * tile, screen_view *view)
{
    const glint_occlude_args *args = tile->args;
    const glint_geometry_table *geometry = args->geometry;
    double away[3], along[3] = { 0, 0, 0 }, size = 0, width = 0;
    int longest = 0;
    for (int k = 0; k < 3; k++) {
        view->origin[k] = 0.5f * (tile->lower[k] + tile->upper[k]);
        view->exact[k] = (double)view->origin[k];
        const double light = (args->position[k] - geometry->reference[k]) * geometry->scale;
        away[k] = args->directional ? -args->position[k] : (double)view->origin[k] - light;
        size += largest_of(tile->lower[k], tile->upper[k]);
        width += tile->upper[k] - tile->lower[k];
        if (tile->upper[k] - tile->lower[k] > tile->upper[longest] - tile->lower[longest])
            longest = k;
    }
    along[longest] = 1;
    // uses the camera's direction, along which the points of a tile lie behind each other
    const bool seen = args->camera && make_beam_axes(away, args->camera->forward, view);
    for (int next = 0; !seen && !make_beam_axes(away, along, view); next++) {
        if (next == 3)
            return false;
        for (int k = 0; k < 3; k++)
            along[k] = k == next;
    }
    view->inverse = args->directional ? 0 : (float)(1 / sqrt(DOT(away, away)));
    view->base = view->unit[0] = view->unit[1] = 1;
    view->count[0] = SCREEN_ACROSS;
    view->count[1] = BEAM_DOWN;
    view->margin = 0;
    view->slack = 4 * GLINT_FILTER_SLACK * (float)size + 2 * R(walk_slack)(geometry);
    // at least the distance of a point from its triangle's plane
    view->corner_slack = (float)(16 * GLINT_POINT_SLACK * geometry->extent * geometry->scale);
    view->drift = 2 * GLINT_FILTER_SLACK * (float)width + 4 * view->corner_slack; // this suffices because k of a
        // point is above BEAM_NEAREST
    return true;
}

/// Computes the points of a group in the index's frame, relative to `origin`, before rounding to float.
static inline void R(points_from)(const void *const point[3], size_t at, const glint_geometry_table *geometry,
                                  const double origin[3], float (*local)[GLINT_GROUP])
{
    _Alignas(64) real moved[GLINT_GROUP];
    for (int k = 0; k < 3; k++) {
        const vr reference = r_set(geometry->reference[k]), scale = r_set(geometry->scale);
        for (int i = 0; i < GLINT_GROUP; i += VR)
            r_store(moved + i, (r_load((const real *)point[k] + at + i) - reference) * scale - r_set(origin[k]));
        R(narrow)(moved, local[k]);
    }
}

/// The projected positions of the points in the light's view, in the order of the call's groups.
typedef struct R(beam_coords) {
    _Alignas(64) float uv[2][GLINT_TILE_SAMPLES], w[GLINT_TILE_SAMPLES];
    _Alignas(64) uint32_t cell[GLINT_TILE_SAMPLES];
} R(beam_coords);

/// Projects the points and computes bounds of their positions. Returns whether these points can form a beam; they
/// cannot if there is a NaN.
static bool R(project_points)(const R(shadow_tile) * tile, const uint16_t *lit, screen_view *view,
                              R(beam_coords) * coords)
{
    _Alignas(64) float local[3][GLINT_GROUP];
    vf least[3], most[3];
    for (int j = 0; j < 3; j++) {
        least[j] = f_set(HUGE_VALF);
        most[j] = f_set(-HUGE_VALF);
    }
    for (uint32_t g = 0; g < tile->args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        float *const out[3] = { coords->uv[0] + at, coords->uv[1] + at, coords->w + at };
        if (!lit[g])
            continue;
        R(points_from)(tile->args->point, at, tile->args->geometry, view->exact, local);
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const vf x[3] = { f_load(local[0] + i), f_load(local[1] + i), f_load(local[2] + i) };
            vf seen[3];
            for (int j = 0; j < 3; j++)
                seen[j] =
                    (f_set(view->axis[j][0]) * x[0] + f_set(view->axis[j][1]) * x[1]) + f_set(view->axis[j][2]) * x[2];
            const vf k = f_set(1) + seen[2] * f_set(view->inverse);
            f_store(out[0] + i, seen[0] / k);
            f_store(out[1] + i, seen[1] / k);
            f_store(out[2] + i, seen[2]);
        }
        for (int j = 0; j < 3; j++)
            widen(out[j], lit[g], &least[j], &most[j]);
    }
    float wide2 = 0;
    for (int j = 0; j < 2; j++) {
        view->first[j] = f_min_all(least[j]);
        view->last[j] = f_max_all(most[j]);
        const float width = view->last[j] - view->first[j];
        const float wide = largest_of(view->first[j], view->last[j]) * view->inverse;
        if (!(width < 0x1p100f))
            return false;
        view->cells[j] = width > 0x1p-100f ? (float)view->count[j] / width : 0;
        wide2 += wide * wide;
    }
    view->far = f_max_all(most[2]);
    view->stretch = 1.00001f * (1 + wide2);
    finish_screen(view);
    return 1 + f_min_all(least[2]) * view->inverse > BEAM_NEAREST && wide2 < BEAM_WIDEST * BEAM_WIDEST;
}

/// Sorts the points by cell.
static void R(sort_points)(R(beam) * beam, const uint16_t *lit, R(beam_coords) * coords)
{
    const glint_occlude_args *args = beam->tile->args;
    uint16_t next[BEAM_DOWN * SCREEN_ACROSS] = { 0 };
    for (uint32_t g = 0; g < args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        if (!lit[g])
            continue;
        for (size_t i = at; i < at + GLINT_GROUP; i += VF)
            i_store(coords->cell + i, i_add(screen_cell(&beam->view, 0, f_load(coords->uv[0] + i)),
                                            i_shl(screen_cell(&beam->view, 1, f_load(coords->uv[1] + i)), 4)));
        for (unsigned lanes = lit[g]; lanes; lanes &= lanes - 1)
            next[coords->cell[at + (unsigned)__builtin_ctz(lanes)]]++;
    }
    beam->count = 0;
    for (int c = 0; c < BEAM_DOWN * SCREEN_ACROSS; c++) {
        beam->begin[c] = (uint16_t)beam->count;
        beam->count += next[c];
        next[c] = beam->begin[c];
        beam->far[c / SCREEN_ACROSS][c % SCREEN_ACROSS] = -HUGE_VALF;
    }
    beam->begin[BEAM_DOWN * SCREEN_ACROSS] = (uint16_t)beam->count;
    beam->unoccluded = beam->count;
    for (uint32_t g = 0; g < args->group_count; g++)
        for (unsigned lanes = lit[g]; lanes; lanes &= lanes - 1) {
            const size_t from = (size_t)g * GLINT_GROUP + (unsigned)__builtin_ctz(lanes);
            const uint32_t cell = coords->cell[from], to = next[cell]++;
            float *far = &beam->far[cell / SCREEN_ACROSS][cell % SCREEN_ACROSS];
            beam->uv[0][to] = coords->uv[0][from];
            beam->uv[1][to] = coords->uv[1][from];
            beam->w[to] = coords->w[from];
            beam->own[to] = args->prim[from] | (args->back[g] >> from % GLINT_GROUP & 1 ? BEAM_BACK : 0);
            beam->at[to] = (uint16_t)from;
            beam->cell[to] = (uint16_t)cell;
            *far = larger(coords->w[from], *far); // NaN in w is ignored
        }
}

#endif
