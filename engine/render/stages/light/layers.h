// occlude_by_layers: computes which samples of an area light reach the points, for tiles with too many occluders for
// a list. All segments traverse the index together, once. The primitives that they reach are sorted into layers
// (layer.h) and tested there. Certain results of the float test are final; the other segments are decided in real,
// from point to sample. Contract: stages.h, occlude.
#ifndef GLINT_LIGHT_LAYERS_H
#define GLINT_LIGHT_LAYERS_H

#include "engine/render/stages/cast/leaf.h"
#include "engine/render/stages/index/screen.h"
#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/light/cone.h"
#include "engine/render/stages/light/layer.h"
#include "engine/render/stages/light/layer_blocker.h"
#include "engine/render/stages/light/layer_frame.h"
#include "engine/render/stages/light/soft.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/occlude/grid.h"
#include "engine/render/stages/occlude/through_beam.h"
#include "engine/render/stages/simd/real.h"

#if GLINT_REAL == 64

// ---- The occluders ----

/// Computes the positions of the corners of the triangles in the slots of `mask`.
static inline void R(place_corners)(const R(layers) * l, const glint_node *node, unsigned mask, float to[3][3][GLINT_NODE_WIDTH])
{
    const glint_geometry_table *geometry = l->tile->args->geometry;
    _Alignas(64) real corner[3][3][GLINT_NODE_WIDTH] = { { { 0 } } }, moved[GLINT_NODE_WIDTH];
    _Alignas(64) float local[3][GLINT_NODE_WIDTH];
    R(load_node_corners)(geometry, node, mask, corner);
    for (int j = 0; j < 3; j++) {
        for (int k = 0; k < 3; k++) {
            const vr reference = r_set(geometry->reference[k]), scale = r_set(geometry->scale);
            for (int i = 0; i < GLINT_NODE_WIDTH; i += VR)
                r_store(moved + i, (r_load(corner[j][k] + i) - reference) * scale - r_set(l->frame.exact[k]));
            R(narrow)(moved, local[k]);
        }
        for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
            const vf x[3] = { f_load(local[0] + i), f_load(local[1] + i), f_load(local[2] + i) };
            for (int k = 0; k < 3; k++)
                f_store(to[j][k] + i, along_axis(l->frame.axis[k], x));
        }
    }
}

/// Records the primitives in the slots of `mask` that may be between points and samples. The caller checks that there
/// is space.
static void R(note_prims)(R(layers) * l, const glint_node *node, unsigned mask)
{
    const layer_frame *frame = &l->frame;
    const unsigned triangles = triangles_in(l->tile->args->geometry, node, mask);
    _Alignas(64) float low[3][GLINT_NODE_WIDTH], high[3][GLINT_NODE_WIDTH], corner[3][3][GLINT_NODE_WIDTH];
    unsigned between = 0;
    for (int i = 0; i < GLINT_NODE_WIDTH; i += VF) {
        vf middle[3], half[3], least[3], most[3];
        for (int k = 0; k < 3; k++)
            box_axis(node, k, i, frame->origin[k], frame->slack, &middle[k], &half[k]);
        for (int j = 0; j < 3; j++) {
            box_along(middle, half, frame->axis[j], &least[j], &most[j]);
            if (j == 2) { // clips to the ends of the segments
                least[j] = f_max(least[j], f_set(frame->lowest - frame->slack));
                most[j] = f_min(most[j], f_set(frame->farthest + frame->slack));
            }
            f_store(low[j] + i, least[j]);
            f_store(high[j] + i, most[j]);
        }
        between |= fm_bits(f_le(least[2], most[2])) << i;
    }
    mask &= between;
    if (mask & triangles)
        R(place_corners)(l, node, mask & triangles, corner);
    for (; mask; mask &= mask - 1) {
        const int slot = __builtin_ctz(mask);
        layer_prim *to = &l->prim[l->count++];
        to->id = node->child[slot] & ~GLINT_NODE_PRIM;
        for (int j = 0; j < 3; j++) {
            to->low[j] = low[j][slot];
            to->high[j] = high[j][slot];
            for (int k = 0; k < 3 && triangles >> slot & 1; k++)
                to->corner[j][k] = corner[j][k][slot];
        }
    }
}

// ---- Layers ----

/// Returns the best number of layers for the recorded primitives, whose middles are at heights from `low` to `high`.
/// The costs are in nanoseconds, measured with vectors of 16: 2 to sort a segment, 12 to test a vector of segments,
/// 40 to begin a primitive, and 4 for each row of cells of the primitive.
static int R(count_layers)(const R(layers) * l, float low, float high)
{
    const layer_frame *frame = &l->frame;
    const float segments = (float)l->unoccluded, prims = (float)l->count;
    float size[2] = { 0, 0 }, least = HUGE_VALF;
    int best = 1;
    for (int n = 0; n < l->count; n++)
        for (int j = 0; j < 2; j++)
            size[j] += (l->prim[n].high[j] - l->prim[n].low[j]) / prims;
    for (int layers = 1; layers <= LAYERS_MOST; layers *= 2) {
        float vectors = segments * (1 / 16.0f), rows = 1;
        for (int j = 0; j < 2; j++) {
            const float cell = frame->width[j] / LAYER_ACROSS;
            const float off = 0.25f * (high - low) / (float)layers * (frame->slope[j][1] - frame->slope[j][0]);
            rows = smaller(size[j] + off + cell, frame->width[j]) / cell; // along the second axis
            vectors *= rows / LAYER_ACROSS;
        }
        const float time = 2 * segments * (float)layers + prims * (40 + 4 * rows + 12 * (vectors + 0.5f * rows));
        if (time < least) {
            least = time;
            best = layers;
        }
    }
    return best;
}

/// Computes the cells of a layer's plane that primitive n may be in.
static void R(find_cells_of)(R(layers) * l, int n)
{
    const layer_rays *rays = &l->rays;
    for (int j = 0; j < 2; j++) {
        const float first = (l->least[n][j] - rays->first[j]) * rays->cells[j], last = (l->most[n][j] - rays->first[j]) * rays->cells[j];
        l->first[n][j] = (uint8_t)smaller(larger(first, 0), LAYER_ACROSS - 1);
        l->last[n][j] = (uint8_t)smaller(larger(last, 0), LAYER_ACROSS - 1);
    }
}

/// Tests the primitives of one layer.
static void R(block_one_layer)(R(layers) * l, const uint16_t *order, int count)
{
    layer_rays *rays = &l->rays;
    float low = HUGE_VALF, high = -HUGE_VALF;
    for (int i = 0; i < count; i++) {
        low = smaller(low, l->prim[order[i]].low[2]);
        high = larger(high, l->prim[order[i]].high[2]);
    }
    const float h = 0.5f * (low + high);
    for (int j = 0; j < 2; j++) {
        rays->first[j] = HUGE_VALF;
        rays->last[j] = -HUGE_VALF;
        for (int i = 0; i < count; i++) {
            const int n = order[i];
            R(cross_plane)(&l->frame, &l->prim[n], h, j, &l->least[n][j], &l->most[n][j]);
            rays->first[j] = smaller(rays->first[j], l->least[n][j]);
            rays->last[j] = larger(rays->last[j], l->most[n][j]);
        }
        const float width = rays->last[j] - rays->first[j];
        rays->cells[j] = width > 0x1p-100f ? LAYER_ACROSS / width : 0;
    }
    if (!sort_layer(l->tile->args, &l->frame, h, rays))
        return;
    for (int i = 0; i < count; i++) {
        R(find_cells_of)(l, order[i]);
        R(block_layer)(l, order[i], h);
    }
}

/// Tests the recorded primitives.
static void R(block_noted)(R(layers) * l)
{
    uint16_t begin[LAYERS_MOST + 1] = { 0 };
    float low = HUGE_VALF, high = -HUGE_VALF;
    for (int n = 0; n < l->count; n++) {
        const float middle = 0.5f * (l->prim[n].low[2] + l->prim[n].high[2]);
        low = smaller(low, middle);
        high = larger(high, middle);
    }
    const int layers = l->count ? R(count_layers)(l, low, high) : 0;
    const float per_h = high > low ? (float)layers / (high - low) : 0;
    for (int pass = 0; pass < 2; pass++) { // first counts, then stores
        for (int n = 0; n < l->count; n++) {
            const float middle = 0.5f * (l->prim[n].low[2] + l->prim[n].high[2]);
            const int layer = (int)smaller((middle - low) * per_h, (float)(layers - 1));
            if (pass)
                l->order[begin[layer]++] = (uint16_t)n;
            else
                begin[layer + 1]++;
        }
        for (int n = 0; n < layers && !pass; n++)
            begin[n + 1] = (uint16_t)(begin[n + 1] + begin[n]);
    }
    for (int n = 0, from = 0; n < layers && l->unoccluded; from = begin[n++])
        if (begin[n] > from)
            R(block_one_layer)(l, l->order + from, begin[n] - from);
    l->count = 0;
}

/// Traverses the index with all segments of the tile.
static void R(walk_layers)(R(layers) * l)
{
    const R(shadow_tile) *tile = l->tile;
    const glint_geometry_table *geometry = tile->args->geometry;
    const glint_node *node;
    shaft_walk walk;
    unsigned prims;
    begin_shaft_walk(&walk, geometry->nodes, tile->lower, tile->upper, &tile->light);
    while (l->unoccluded && !is_stopped(tile->args->stop) && (node = next_in_shaft(&walk, &prims))) {
        if (!prims)
            continue;
        if (l->count + GLINT_NODE_WIDTH > LAYER_PRIMS)
            R(block_noted)(l);
        R(note_prims)(l, node, prims);
    }
    R(block_noted)(l);
}

static void R(begin_segments)(R(layers) * l)
{
    R(begin_batch)(l->tile->args, &l->batch);
    memset(l->light, 0, sizeof l->light);
    memset(l->direction, 0, sizeof l->direction);
    memset(l->slack, 0, sizeof l->slack);
    l->batch.args.slack = l->slack;
    for (int k = 0; k < 3; k++)
        l->batch.args.direction[k] = l->direction[k];
}

/// Computes args->unoccluded for all samples. Returns false, with nothing changed, if there is no memory, or if these
/// points and samples allow no frame.
static bool R(occlude_by_layers)(R(shadow_tile) * tile, const uint16_t *lit)
{
    const glint_occlude_args *args = tile->args;
    const uint64_t rays = *args->rays;
    R(layers) *l = args->scratch;
    _Static_assert(sizeof *l <= GLINT_OCCLUDE_SCRATCH, "the layers fit");
    if (!l || tile->unbounded > GLINT_OCCLUDERS || R(is_cone)(args->light_sample[0]) || !R(aim_layers)(tile, lit, &l->frame))
        return false;
    tile->count = tile->unbounded; // unbounded primitives are tested by a list
    R(occlude_listed)(tile, lit);
    l->tile = tile;
    l->count = 0;
    l->unoccluded = 0;
    for (uint32_t s = 0; s < args->sample_count; s++)
        for (uint32_t g = 0; g < args->group_count; g++)
            l->unoccluded += (unsigned)__builtin_popcount(args->unoccluded[s][g]);
    *args->rays = rays + l->unoccluded;
    R(begin_segments)(l);
    R(walk_layers)(l);
    return true;
}
#else // if float decides, occlude_walking is used

static bool R(occlude_by_layers)(R(shadow_tile) * tile, const uint16_t *lit)
{
    (void)tile;
    (void)lit;
    return false;
}
#endif

#endif
