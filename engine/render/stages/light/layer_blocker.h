// layer_blocker: tests one primitive against the segments in the primitive's cells of a layer. A float test decides
// most segments. The other segments are paired with the primitive and decided in real. Contract: stages.h, occlude.
#ifndef GLINT_LIGHT_LAYER_BLOCKER_H
#define GLINT_LIGHT_LAYER_BLOCKER_H

#include "engine/render/stages/index/walk.h"
#include "engine/render/stages/light/layer.h"
#include "engine/render/stages/light/layer_frame.h"
#include "engine/render/stages/occlude/beam.h"
#include "engine/render/stages/occlude/beam_leaf.h"
#include "engine/render/stages/occlude/beam_points.h"
#include "engine/render/stages/occlude/blocked.h"
#include "engine/render/stages/occlude/grid.h"
#include "engine/render/stages/occlude/occlude.h"
#include "engine/render/stages/occlude/through_beam.h"
#include "engine/render/stages/simd/real.h"

#if GLINT_REAL == 64

// ---- The decision ----

/// Marks segment i of the layer as blocked.
static inline void R(close_segment)(R(layers) * l, uint32_t i)
{
    const uint32_t at = l->rays.at[i], s = at / GLINT_TILE_SAMPLES, point = at % GLINT_TILE_SAMPLES;
    if (l->rays.from[i] == HUGE_VALF)
        return;
    l->rays.from[i] = HUGE_VALF;
    l->tile->args->unoccluded[s][point / GLINT_GROUP] &= (uint16_t) ~(1u << point % GLINT_GROUP);
    l->unoccluded--;
}

/// Decides the batch: pairs of segments and one primitive.
static void R(decide_segments)(R(layers) * l, const glint_prim *prim)
{
    R(beam_batch) *batch = &l->batch;
    const real(*light)[GLINT_GROUP] = (const real(*)[GLINT_GROUP])l->light;
    if (!batch->count)
        return;
    const R(light_sides) sides = R(seen_sides)(l->tile, light, prim);
    const unsigned all = (1u << batch->count) - 1;
    unsigned blocked = R(decide_blocked)(&batch->args, prim, light, 0, sides, batch->own, all);
    for (; blocked; blocked &= blocked - 1)
        R(close_segment)(l, batch->from[__builtin_ctz(blocked)]);
    batch->count = 0;
    batch->own = 0;
    batch->back = 0;
}

static inline void R(add_segment)(R(layers) * l, const glint_prim *prim, uint32_t i, bool own)
{
    R(beam_batch) *batch = &l->batch;
    const glint_occlude_args *args = l->tile->args;
    const uint32_t on = l->rays.on[i], at = l->rays.at[i] % GLINT_TILE_SAMPLES, s = l->rays.at[i] / GLINT_TILE_SAMPLES;
    real *const point[3] = { batch->point[0], batch->point[1], batch->point[2] };
    real *const direction[3] = { l->direction[0], l->direction[1], l->direction[2] };
    const int n = batch->count++;
    batch->from[n] = (uint16_t)i;
    batch->on[n] = on & ~BEAM_BACK;
    batch->own |= (unsigned)own << n;
    batch->back |= (uint16_t)((unsigned)((on & BEAM_BACK) != 0) << n);
    for (int k = 0; k < 3; k++)
        l->light[k][n] = args->light_sample[s]->position[k][at % GLINT_GROUP];
    R(copy_point)(args, at, prim->kind == GLINT_PRIM_TRIANGLE, n, point, direction, l->slack);
    if (batch->count == GLINT_GROUP)
        R(decide_segments)(l, prim);
}

// ---- The filter ----

/// Bit masks of the segments of a run that may be blocked, and of the segments that certainly are.
typedef struct layer_lanes_hit {
    unsigned near, certain;
} layer_lanes_hit;

/// The primitive that the segments of a run are tested against.
typedef struct R(layer_blocker) {
    const layer_prim *at;
    const glint_prim *prim;
    bool torus, clear; ///< clear: every sample is outside of the primitive, and beyond it as seen from the points
    float center[3], reach2, inner2; ///< for a sphere: its centre, and the squared distances from the centre within
        ///< which a segment may hit the sphere, and certainly hits it
    float above; ///< points with h below this are certainly below the primitive (triangle: its top; sphere: its centre)
    float doubt; ///< for a triangle: error bound of the edge functions
    float unit[3][3], limit; ///< for a solid: the images of the frame's axes in the space of the unit shape; limit:
        ///< maximum size of the shape there
    int form; ///< for a solid: the form
} R(layer_blocker);

/// Tests a triangle: a segment crosses it if, as seen along the segment, it is on the same side of all edges.
INNER layer_lanes_hit R(test_corners)(const layer_rays *rays, const R(layer_blocker) * b, uint32_t i)
{
    const vf base[2] = { f_load_any(rays->base[0] + i), f_load_any(rays->base[1] + i) };
    const vf slope[2] = { f_load_any(rays->slope[0] + i), f_load_any(rays->slope[1] + i) };
    const vf from = f_load_any(rays->from + i), doubt = f_set(b->doubt);
    vf x[3], y[3], e[3];
    for (int j = 0; j < 3; j++) {
        const float *corner = b->at->corner[j];
        x[j] = f_set(corner[0]) - (base[0] + slope[0] * f_set(corner[2]));
        y[j] = f_set(corner[1]) - (base[1] + slope[1] * f_set(corner[2]));
    }
    for (int j = 0; j < 3; j++)
        e[j] = x[(j + 1) % 3] * y[(j + 2) % 3] - x[(j + 2) % 3] * y[(j + 1) % 3];
    const vf least = f_min(f_min(e[0], e[1]), e[2]), most = f_max(f_max(e[0], e[1]), e[2]);
    const vf area = (e[0] + e[1]) + e[2], of_area = f_set(3) * doubt; // NaN if any edge function is NaN
    const fm front_side = f_lt(of_area, area), back_side = f_lt(area, -of_area), apart = fm_and(f_lt(least, -doubt), f_lt(doubt, most));
    const fm front = fm_and(f_lt(doubt, least), front_side), back = fm_and(f_lt(most, -doubt), back_side);
    const vi owner = f_bits(f_load_any((const float *)(rays->on + i))), id = i_set(b->at->id);
    const fm own = i_eq(i_and(owner, i_set(~BEAM_BACK)), id), seen_behind = i_eq(owner, i_set(b->at->id | BEAM_BACK));
    // a triangle blocks the light from points on itself if light and viewer are on different sides
    const fm lit = fm_or(fm_andnot(front_side, seen_behind), fm_and(back_side, seen_behind));
    const fm there = f_le(from, f_set(b->at->high[2]));
    layer_lanes_hit out;
    out.near = fm_bits(fm_and(there, fm_or(fm_andnot(fm_from_bits((1u << VF) - 1), fm_or(apart, own)), fm_andnot(own, lit))));
    out.certain = b->clear ? fm_bits(fm_andnot(fm_and(fm_or(front, back), f_lt(from, f_set(b->above))), own)) : 0;
    return out;
}

/// Tests a sphere: a segment certainly hits the sphere if it is inside the sphere at the centre's height.
INNER layer_lanes_hit R(test_middle)(const layer_rays *rays, const R(layer_blocker) * b, uint32_t i)
{
    const vf slope[2] = { f_load_any(rays->slope[0] + i), f_load_any(rays->slope[1] + i) };
    const vf x = (f_load_any(rays->base[0] + i) + slope[0] * f_set(b->center[2])) - f_set(b->center[0]);
    const vf y = (f_load_any(rays->base[1] + i) + slope[1] * f_set(b->center[2])) - f_set(b->center[1]);
    const vf from = f_load_any(rays->from + i), turn = x * slope[1] - y * slope[0], beside2 = x * x + y * y;
    const vf stretch = (f_set(1) + slope[0] * slope[0]) + slope[1] * slope[1];
    const vi owner = f_bits(f_load_any((const float *)(rays->on + i)));
    const fm front = i_eq(owner, i_set(b->at->id)), own = i_eq(i_and(owner, i_set(~BEAM_BACK)), i_set(b->at->id));
    const fm there = f_le(from, f_set(b->at->high[2]));
    const fm away = f_lt(f_set(b->reach2) * stretch, beside2 + turn * turn);
    layer_lanes_hit out;
    out.near = fm_bits(fm_andnot(there, fm_or(away, front)));
    out.certain = b->clear ? fm_bits(fm_andnot(fm_and(f_lt(beside2, f_set(b->inner2)), f_lt(from, f_set(b->above))), own)) : 0;
    return out;
}

/// Returns the lanes whose lines certainly miss a solid, in the space of its unit shape. Cylinders, cones and disks
/// are bounded by a cylinder around the axis, balls and tori by a ball. A box and a line are apart if an axis
/// perpendicular to the line and to an edge of the box separates them.
INNER fm R(off_unit_shape)(const R(layer_blocker) * b, const vf x[2], const vf slope[2])
{
    vf o[3], d[3];
    for (int k = 0; k < 3; k++) {
        o[k] = f_set(b->unit[0][k]) * x[0] + f_set(b->unit[1][k]) * x[1];
        d[k] = (f_set(b->unit[0][k]) * slope[0] + f_set(b->unit[1][k]) * slope[1]) + f_set(b->unit[2][k]);
    }
    const vf limit = f_set(b->limit), limit2 = limit * limit, turn = o[0] * d[1] - o[1] * d[0];
    if (b->form == GLINT_FORM_CYLINDER || b->form == GLINT_FORM_CONE || b->form == GLINT_FORM_TUBE || b->form == GLINT_FORM_FUNNEL ||
        b->form == GLINT_FORM_DISK)
        return f_lt(limit2 * (d[0] * d[0] + d[1] * d[1]), turn * turn);
    const vf c[3] = { o[1] * d[2] - o[2] * d[1], o[2] * d[0] - o[0] * d[2], turn };
    if (b->form != GLINT_FORM_BOX)
        return f_lt(limit2 * DOT(d, d), DOT(c, c));
    fm off = f_lt(limit * (f_abs(d[1]) + f_abs(d[2])), f_abs(c[0]));
    off = fm_or(off, f_lt(limit * (f_abs(d[2]) + f_abs(d[0])), f_abs(c[1])));
    return fm_or(off, f_lt(limit * (f_abs(d[0]) + f_abs(d[1])), f_abs(c[2])));
}

/// Tests other primitives by their bounding boxes.
INNER layer_lanes_hit R(test_extent)(const layer_rays *rays, const R(layer_blocker) * b, uint32_t i)
{
    const float *low = b->at->low, *high = b->at->high;
    const vf from = f_load_any(rays->from + i), start = f_max(f_set(low[2]), f_min(from, f_set(high[2])));
    fm in = f_le(from, f_set(high[2]));
    vf at[2], slope[2];
    for (int j = 0; j < 2; j++) {
        const vf base = f_load_any(rays->base[j] + i);
        slope[j] = f_load_any(rays->slope[j] + i);
        const vf x = base + slope[j] * start, y = base + slope[j] * f_set(high[2]);
        in = fm_and(in, fm_and(f_le(f_min(x, y), f_set(high[j])), f_le(f_set(low[j]), f_max(x, y))));
        at[j] = (base + slope[j] * f_set(b->center[2])) - f_set(b->center[j]);
    }
    if (b->prim->kind == GLINT_PRIM_SOLID && fm_bits(in))
        in = fm_andnot(in, R(off_unit_shape)(b, at, slope));
    const vi owner = f_bits(f_load_any((const float *)(rays->on + i)));
    if (!b->torus)
        in = fm_andnot(in, i_eq(owner, i_set(b->at->id)));
    return (layer_lanes_hit) { fm_bits(in), 0 };
}

/// Tests the segments from index `i` up to, not including, `end`.
INNER void R(block_segments)(R(layers) * l, const R(layer_blocker) * b, uint32_t i, uint32_t end)
{
    for (; i < end; i += VF) {
        const unsigned in_run = end - i < VF ? (1u << (end - i)) - 1 : (1u << VF) - 1;
        layer_lanes_hit hit;
        if (b->prim->kind == GLINT_PRIM_TRIANGLE)
            hit = R(test_corners)(&l->rays, b, i);
        else if (b->prim->kind == GLINT_PRIM_SPHERE)
            hit = R(test_middle)(&l->rays, b, i);
        else
            hit = R(test_extent)(&l->rays, b, i);
        for (unsigned bits = hit.certain & in_run; bits; bits &= bits - 1)
            R(close_segment)(l, i + (unsigned)__builtin_ctz(bits));
        for (unsigned bits = hit.near & ~hit.certain & in_run; bits; bits &= bits - 1) {
            const uint32_t n = i + (unsigned)__builtin_ctz(bits);
            R(add_segment)(l, b->prim, n, (l->rays.on[n] & ~BEAM_BACK) == b->at->id);
        }
    }
}

/// Returns an error bound for the positions of segments and a primitive at heights from `least` to `most`. Beyond the
/// ends of a segment the error grows with the extrapolation.
static inline float R(slack_at)(const layer_frame *frame, const layer_prim *prim, float least, float most)
{
    float size = 0;
    for (int j = 0; j < 3; j++)
        size += largest_of(prim->low[j], prim->high[j]);
    const float beyond = larger(larger(frame->highest - least, most - frame->nearest), 0);
    return (frame->slack + LAYER_SLACK * (size + largest_of(least, most))) * (1 + 2 * beyond * frame->per_gap);
}

/// Computes bounds of the positions, along axis j, at which segments that hit a primitive cross a plane at h.
static inline void R(cross_plane)(const layer_frame *frame, const layer_prim *prim, float h, int j, float *least, float *most)
{
    const float up = h - prim->low[2], down = h - prim->high[2]; // up >= down
    const float left = frame->slope[j][0], right = frame->slope[j][1], slack = R(slack_at)(frame, prim, h, h);
    *least = prim->low[j] + smaller(smaller(up * left, up * right), smaller(down * left, down * right)) - slack;
    *most = prim->high[j] + larger(larger(up * left, up * right), larger(down * left, down * right)) + slack;
}

static void R(make_ball)(const R(layers) * l, R(layer_blocker) * out)
{
    const layer_frame *frame = &l->frame;
    const glint_prim *prim = out->prim;
    float size = 0;
    for (int j = 0; j < 3; j++) {
        float x[3];
        for (int k = 0; k < 3; k++)
            x[k] = prim->filter_center[k] - frame->origin[k];
        size += fabsf(prim->filter_center[j]) + fabsf(frame->origin[j]);
        out->center[j] = DOT(frame->axis[j], x);
    }
    const float h = out->center[2], slack = 2 * R(slack_at)(frame, out->at, h, h) + 4 * WALK_SLACK * size;
    const float reach = (prim->filter_bound + slack) * 1.00001f;
    const float inner = (float)(prim->radius * l->tile->args->geometry->scale) * 0.99999f - slack;
    out->reach2 = reach * reach;
    out->inner2 = inner > 0 ? inner * inner : 0;
    out->above = h - slack;
    out->clear = out->clear && h < frame->nearest && R(light_outside)(l->tile, prim);
}

/// Sets the fields that depend on the kind of primitive. `wide`: as in make_blocker.
static void R(make_shape)(const R(layers) * l, float wide, R(layer_blocker) * out)
{
    const layer_frame *frame = &l->frame;
    const glint_geometry_table *geometry = l->tile->args->geometry;
    const glint_prim *prim = out->prim;
    const glint_solid *solid = &geometry->solids[prim->item];
    double middle[3], size = 0;
    for (int k = 0; k < 3; k++)
        middle[k] = (prim->center[k] - geometry->reference[k]) * geometry->scale - frame->exact[k];
    for (int j = 0; j < 3; j++) {
        const double axis[3] = { (double)frame->axis[j][0], (double)frame->axis[j][1], (double)frame->axis[j][2] };
        out->center[j] = (float)DOT(axis, middle);
        for (int k = 0; k < 3; k++) {
            const double x = DOT(solid->inverse[k], axis) / geometry->scale;
            out->unit[j][k] = (float)x;
            size += x * x;
        }
    }
    const float h = out->center[2], slack = R(slack_at)(frame, out->at, h, h) + 0x1p-20f * (wide + fabsf(h - out->at->low[2]) + fabsf(h - out->at->high[2]));
    out->form = (int)solid->form;
    out->limit = (float)(solid->form == GLINT_FORM_TORUS ? 1 + solid->tube : 1) * 1.00001f + 2 * slack * (float)sqrt(size);
}

/// Prepares a primitive. wide: bound of the perpendicular distance between a segment and a corner of the primitive,
/// along both axes.
static void R(make_blocker)(const R(layers) * l, const layer_prim *at, float wide, R(layer_blocker) * out)
{
    const glint_geometry_table *geometry = l->tile->args->geometry;
    const glint_prim *prim = &geometry->prims[at->id];
    *out = (R(layer_blocker)) { .at = at, .prim = prim, .torus = is_torus(geometry, prim) };
    out->clear = at->high[2] < l->frame.nearest;
    if (prim->kind == GLINT_PRIM_SPHERE)
        R(make_ball)(l, out);
    if (prim->kind == GLINT_PRIM_SOLID)
        R(make_shape)(l, wide, out);
    if (prim->kind != GLINT_PRIM_TRIANGLE)
        return;
    const float a = at->corner[0][2], b = at->corner[1][2], c = at->corner[2][2];
    const float least = smaller(smaller(a, b), c), most = larger(larger(a, b), c);
    const float beyond = larger(larger(at->low[2] - least, most - at->high[2]), 0);
    const float slack = R(slack_at)(&l->frame, at, least, most);
    out->doubt = 8 * slack * (wide + 4 * LAYER_STEEPEST * beyond);
    out->above = least - slack;
    out->clear = most < l->frame.nearest - slack;
}

/// Tests the segments in the cells of primitive n.
static void R(block_layer)(R(layers) * l, int n, float h)
{
    const layer_rays *rays = &l->rays;
    const layer_prim *prim = &l->prim[n];
    const float off = larger(fabsf(h - prim->low[2]), fabsf(h - prim->high[2]));
    float wide = 4 * LAYER_STEEPEST * off;
    for (int j = 0; j < 2; j++)
        wide += (l->most[n][j] - l->least[n][j]) + 2 * (rays->last[j] - rays->first[j]) / LAYER_ACROSS;
    R(layer_blocker) blocker;
    R(make_blocker)(l, prim, wide, &blocker);
    for (int row = l->first[n][1]; row <= l->last[n][1]; row++) {
        const uint16_t *begin = rays->begin + row * LAYER_ACROSS;
        R(block_segments)(l, &blocker, begin[l->first[n][0]], begin[l->last[n][0] + 1]);
    }
    R(decide_segments)(l, blocker.prim);
}
#endif

#endif
