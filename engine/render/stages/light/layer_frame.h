// layer_frame: the data that the layers of a tile share, and the frame of the layers (layer.h), which is computed
// from the points and the samples. Contract: stages.h, occlude.
#ifndef GLINT_LIGHT_LAYER_FRAME_H
#define GLINT_LIGHT_LAYER_FRAME_H

#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/light/layer.h"
#include "engine/render/stages/occlude/beam_points.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/simd/real.h"

#if GLINT_REAL == 64

#define LAYER_PRIMS 1024 ///< maximum number of primitives tested at a time
#define LAYERS_MOST 16

/// A primitive in the frame.
typedef struct layer_prim {
    uint32_t id;
    float low[3], high[3]; ///< bounds of the primitive's box
    float corner[3][3]; ///< the corners of a triangle
} layer_prim;

typedef struct R(layers) {
    const R(shadow_tile) * tile;
    layer_frame frame;
    layer_rays rays;
    int count;
    layer_prim prim[LAYER_PRIMS];
    uint16_t order[LAYER_PRIMS]; ///< the primitives in the order of their layers
    float least[LAYER_PRIMS][2], most[LAYER_PRIMS][2]; ///< bounds of the positions at which segments that hit the
        ///< primitive cross the plane of the primitive's layer
    uint8_t first[LAYER_PRIMS][2], last[LAYER_PRIMS][2]; ///< the cells of these positions
    uint32_t unoccluded; ///< number of unoccluded segments
    R(beam_batch) batch;
    _Alignas(64) real light[3][GLINT_GROUP]; ///< the positions of the samples, for the segments of the batch
    _Alignas(64) real direction[3][GLINT_GROUP], slack[GLINT_GROUP]; ///< the rays that hit the points of the batch,
        ///< and the points' slack
} R(layers);

/// Extends two bounds by the positions of lanes.
static inline void bound_positions(const float (*position)[GLINT_GROUP], unsigned lanes, vf least[3], vf most[3])
{
    for (int j = 0; j < 3; j++)
        widen(position[j], lanes, &least[j], &most[j]);
}

/// Computes the positions of the points of lit groups, and their bounds.
static void R(place_points)(const R(shadow_tile) * tile, const uint16_t *lit, layer_frame *frame, vf least[3], vf most[3])
{
    for (uint32_t g = 0; g < tile->args->group_count; g++) {
        const size_t at = (size_t)g * GLINT_GROUP;
        _Alignas(64) float local[3][GLINT_GROUP], placed[3][GLINT_GROUP];
        if (!lit[g])
            continue;
        R(points_from)(tile->args->point, at, tile->args->geometry, frame->exact, local);
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const vf x[3] = { f_load(local[0] + i), f_load(local[1] + i), f_load(local[2] + i) };
            for (int j = 0; j < 3; j++)
                f_store(placed[j] + i, along_axis(frame->axis[j], x));
        }
        for (int j = 0; j < 3; j++)
            memcpy(frame->point[j] + at, placed[j], sizeof placed[j]);
        bound_positions((const float(*)[GLINT_GROUP])placed, lit[g], least, most);
    }
}

/// Computes the positions of the samples, and their bounds.
static void R(place_samples)(const R(shadow_tile) * tile, layer_frame *frame, vf least[3], vf most[3])
{
    const glint_geometry_table *geometry = tile->args->geometry;
    for (uint32_t s = 0; s < tile->args->sample_count; s++) {
        _Alignas(64) float local[3][GLINT_GROUP];
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < GLINT_GROUP; i++) {
                const double x = tile->args->light_sample[s]->position[k][i];
                local[k][i] = (float)((x - geometry->reference[k]) * geometry->scale - frame->exact[k]);
            }
        for (int i = 0; i < GLINT_GROUP; i += VF) {
            const vf x[3] = { f_load(local[0] + i), f_load(local[1] + i), f_load(local[2] + i) };
            for (int j = 0; j < 3; j++)
                f_store(frame->light[s][j] + i, along_axis(frame->axis[j], x));
        }
        bound_positions((const float(*)[GLINT_GROUP])frame->light[s], 0xffff, least, most);
    }
}

/// Makes the frame. Returns false if points and samples overlap in depth, or a slope is too steep.
static bool R(aim_layers)(const R(shadow_tile) * tile, const uint16_t *lit, layer_frame *frame)
{
    const glint_geometry_table *geometry = tile->args->geometry;
    vf least[2][3], most[2][3]; // bounds of the points, and of the samples
    float low[2][3], high[2][3], size = 0, steepest = 0;
    if (!make_layer_axes(tile->lower, tile->upper, &tile->light, frame))
        return false;
    for (int n = 0; n < 2; n++)
        for (int j = 0; j < 3; j++) {
            least[n][j] = f_set(HUGE_VALF);
            most[n][j] = f_set(-HUGE_VALF);
        }
    R(place_points)(tile, lit, frame, least[0], most[0]);
    R(place_samples)(tile, frame, least[1], most[1]);
    for (int n = 0; n < 2; n++)
        for (int j = 0; j < 3; j++) {
            low[n][j] = f_min_all(least[n][j]);
            high[n][j] = f_max_all(most[n][j]);
            size += largest_of(low[n][j], high[n][j]);
        }
    const float gap = low[1][2] - high[0][2], longest = high[1][2] - low[0][2];
    if (!(gap > 0.125f * longest) || !(size < 0x1p60f))
        return false;
    for (int j = 0; j < 2; j++) {
        const float right = high[1][j] - low[0][j], left = low[1][j] - high[0][j];
        frame->width[j] = 0.5f * ((high[0][j] - low[0][j]) + (high[1][j] - low[1][j]));
        frame->slope[j][0] = (left < 0 ? left / gap : left / longest) - 1e-5f;
        frame->slope[j][1] = (right > 0 ? right / gap : right / longest) + 1e-5f;
        steepest = larger(steepest, largest_of(frame->slope[j][0], frame->slope[j][1]));
    }
    if (!(steepest < LAYER_STEEPEST))
        return false;
    frame->lowest = low[0][2];
    frame->highest = high[0][2];
    frame->nearest = low[1][2];
    frame->farthest = high[1][2];
    frame->per_gap = 1 / gap;
    frame->slack = LAYER_SLACK * size + (float)(16 * GLINT_POINT_SLACK * geometry->extent * geometry->scale);
    return true;
}
#endif

#endif
