// layer: sorts the segments from a tile's points to the samples of an area light into cells of a plane that the
// segments cross. Segments that start far apart may be close to each other at the depth of the occluders. A layer is
// a plane perpendicular to the direction of the light, and sorts the segments by their positions in this plane. All
// of this is float and conservative, like walk.h.
//
// The frame: origin in the middle of the points, two axes perpendicular to the direction to the light, and one, h,
// along it, right-handed. At height h, a segment is at the position base + slope h.
#ifndef GLINT_LIGHT_LAYER_H
#define GLINT_LIGHT_LAYER_H

#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/occlude/beam.h"
#include "engine/render/stages/simd/elementary.h"

#define LAYER_ACROSS 32 ///< number of columns and of rows of cells
#define LAYER_RAYS (GLINT_TILE_SAMPLES * GLINT_LIGHT_CHUNK)
#define LAYER_STEEPEST 2 ///< largest slope of a segment: steeper segments spread too much over a perpendicular plane

/// Error bound of a segment's or a primitive's coordinates, relative to their size: six roundings of a position in
/// the frame, which a slope of at most LAYER_STEEPEST triples, and as many for base, slope and the resulting
/// position.
#define LAYER_SLACK 0x1p-18f

/// The frame, and the ends of all segments in this frame.
typedef struct layer_frame {
    float origin[3], axis[3][3]; ///< in the index's frame
    double exact[3]; ///< the origin before it was rounded
    float slack; ///< bound of a segment's rounding error, at any h
    float lowest, highest; ///< smallest and largest h of a point
    float nearest, farthest; ///< smallest and largest h of a sample
    float per_gap; ///< 1 / (nearest - highest)
    float width[2]; ///< width, along both axes, of the bundle of all segments halfway to the light
    float slope[2][2]; ///< smallest and largest slope of a segment, along the two axes
    _Alignas(64) float point[3][GLINT_TILE_SAMPLES]; ///< positions of the points of lit groups
    _Alignas(64) float light[GLINT_LIGHT_CHUNK][3][GLINT_GROUP];
} layer_frame;

/// For all samples, the lanes of each group whose segments cross the rectangle, and the cells of these segments.
typedef struct layer_cells {
    uint16_t within[GLINT_LIGHT_CHUNK][GLINT_TILE_GROUPS];
    _Alignas(64) uint32_t cell[LAYER_RAYS];
} layer_cells;

/// The segments that cross a rectangle of a layer's plane, in the order of cells, row by row.
typedef struct layer_rays {
    layer_cells unsorted; ///< before they are sorted
    float first[2], last[2], cells[2]; ///< the rectangle; cells per unit
    _Alignas(64) float base[2][LAYER_RAYS + GLINT_GROUP], slope[2][LAYER_RAYS + GLINT_GROUP];
    _Alignas(64) float from[LAYER_RAYS + GLINT_GROUP]; ///< h of the segment's point; +inf for a blocked segment
    uint32_t on[LAYER_RAYS + GLINT_GROUP]; ///< the primitive that the point is on, with the flag BEAM_BACK if it is
        ///< seen from behind
    uint16_t at[LAYER_RAYS + GLINT_GROUP]; ///< GLINT_TILE_SAMPLES times the number of the sample, plus the number of
        ///< the point
    uint16_t begin[LAYER_ACROSS * LAYER_ACROSS + 1]; ///< index of the first segment of each cell
} layer_rays;

/// A vector of VF segments to one sample.
typedef struct layer_lanes {
    vf base[2], slope[2], from;
} layer_lanes;

static inline layer_lanes lanes_of_layer(const layer_frame *frame, uint32_t s, size_t at, int i)
{
    layer_lanes out;
    out.from = f_load(frame->point[2] + at + i);
    const vf per_h = f_set(1) / (f_load(frame->light[s][2] + i) - out.from);
    for (int j = 0; j < 2; j++) {
        const vf x = f_load(frame->point[j] + at + i);
        out.slope[j] = (f_load(frame->light[s][j] + i) - x) * per_h;
        out.base[j] = x - out.from * out.slope[j];
    }
    return out;
}

/// Computes axes along the line from the middle of the points to the middle of the light. Returns false if the two
/// middles coincide.
static bool make_layer_axes(const float lower[3], const float upper[3], const light_bounds *light, layer_frame *frame)
{
    double offset[3], across[3], down[3], least[3] = { 0, 0, 0 };
    int k = 0;
    for (int j = 0; j < 3; j++) {
        frame->origin[j] = 0.5f * (lower[j] + upper[j]);
        frame->exact[j] = (double)frame->origin[j];
        offset[j] = 0.5 * ((double)light->lower[j] + (double)light->upper[j]) - frame->exact[j];
    }
    const double length = sqrt(DOT(offset, offset));
    if (!(length > 0x1p-100) || !(length < 0x1p100))
        return false;
    for (int j = 1; j < 3; j++)
        if (fabs(offset[j]) < fabs(offset[k]))
            k = j;
    least[k] = 1;
    for (int j = 0; j < 3; j++)
        across[j] = (least[(j + 1) % 3] * offset[(j + 2) % 3] - least[(j + 2) % 3] * offset[(j + 1) % 3]) / length;
    const double width = sqrt(DOT(across, across));
    for (int j = 0; j < 3; j++)
        down[j] =
            (offset[(j + 1) % 3] * across[(j + 2) % 3] - offset[(j + 2) % 3] * across[(j + 1) % 3]) / (length * width);
    for (int j = 0; j < 3; j++) {
        frame->axis[0][j] = (float)(across[j] / width);
        frame->axis[1][j] = (float)down[j];
        frame->axis[2][j] = (float)(offset[j] / length);
    }
    return true;
}

static inline vf along_axis(const float axis[3], const vf x[3])
{
    return (f_set(axis[0]) * x[0] + f_set(axis[1]) * x[1]) + f_set(axis[2]) * x[2];
}

_Static_assert(LAYER_ACROSS == 1 << 5, "find_cells makes numbers of cells of it");

static inline vi cell_in_layer(const layer_rays *rays, int j, vf x)
{
    const vf cell = (x - f_set(rays->first[j])) * f_set(rays->cells[j]);
    return i_from_f(f_min(f_max(cell, f_set(0)), f_set(LAYER_ACROSS - 1)));
}

/// Computes the cells of the unoccluded segments at h. Returns the number of segments that cross the rectangle;
/// next[c]: number of segments in cell c.
static uint32_t find_cells(const glint_occlude_args *args, const layer_frame *frame, float h, layer_rays *rays,
                           uint16_t next[LAYER_ACROSS * LAYER_ACROSS])
{
    layer_cells *unsorted = &rays->unsorted;
    uint32_t count = 0;
    for (uint32_t s = 0; s < args->sample_count; s++)
        for (uint32_t g = 0; g < args->group_count; g++) {
            const size_t at = (size_t)g * GLINT_GROUP;
            uint32_t *cell = unsorted->cell + s * GLINT_TILE_SAMPLES + at;
            unsigned within = 0;
            for (int i = 0; i < GLINT_GROUP && args->unoccluded[s][g]; i += VF) {
                const layer_lanes lanes = lanes_of_layer(frame, s, at, i);
                fm in = f_le(lanes.from, f_set(HUGE_VALF));
                vi of[2];
                for (int j = 0; j < 2; j++) {
                    const vf x = lanes.base[j] + lanes.slope[j] * f_set(h);
                    in = fm_and(in, fm_and(f_le(f_set(rays->first[j]), x), f_le(x, f_set(rays->last[j]))));
                    of[j] = cell_in_layer(rays, j, x);
                }
                i_store(cell + i, i_add(of[0], i_shl(of[1], 5)));
                within |= fm_bits(in) << i;
            }
            within &= args->unoccluded[s][g];
            unsorted->within[s][g] = (uint16_t)within;
            count += (unsigned)__builtin_popcount(within);
            for (; within; within &= within - 1)
                next[cell[__builtin_ctz(within)]]++;
        }
    return count;
}

/// Sorts the unoccluded segments that cross the rectangle at h. Returns their number.
static uint32_t sort_layer(const glint_occlude_args *args, const layer_frame *frame, float h, layer_rays *rays)
{
    uint16_t next[LAYER_ACROSS * LAYER_ACROSS] = { 0 };
    const layer_cells *unsorted = &rays->unsorted;
    uint32_t total = 0;
    const uint32_t count = find_cells(args, frame, h, rays, next);
    for (int c = 0; c < LAYER_ACROSS * LAYER_ACROSS; c++) {
        rays->begin[c] = (uint16_t)total;
        total += next[c];
        next[c] = rays->begin[c];
    }
    rays->begin[LAYER_ACROSS * LAYER_ACROSS] = (uint16_t)total;
    for (uint32_t s = 0; s < args->sample_count; s++)
        for (uint32_t g = 0; g < args->group_count; g++) {
            const size_t at = (size_t)g * GLINT_GROUP, from = s * GLINT_TILE_SAMPLES + at;
            _Alignas(64) float base[2][GLINT_GROUP], slope[2][GLINT_GROUP];
            for (int i = 0; i < GLINT_GROUP && unsorted->within[s][g]; i += VF) {
                const layer_lanes lanes = lanes_of_layer(frame, s, at, i);
                for (int j = 0; j < 2; j++) {
                    f_store(base[j] + i, lanes.base[j]);
                    f_store(slope[j] + i, lanes.slope[j]);
                }
            }
            for (unsigned bits = unsorted->within[s][g]; bits; bits &= bits - 1) {
                const int lane = __builtin_ctz(bits);
                const uint32_t to = next[unsorted->cell[from + (size_t)lane]]++;
                for (int j = 0; j < 2; j++) {
                    rays->base[j][to] = base[j][lane];
                    rays->slope[j][to] = slope[j][lane];
                }
                rays->from[to] = frame->point[2][at + (size_t)lane];
                rays->on[to] = args->prim[at + (size_t)lane] | (args->back[g] >> lane & 1 ? BEAM_BACK : 0);
                rays->at[to] = (uint16_t)(from + (size_t)lane);
            }
        }
    return count;
}

#endif
