// Reads texels. Level and position are computed for all lanes at once, and the texels are read lane by lane.
// Contract: contract.h.
#ifndef GLINT_PATTERN_KERNEL_TEXEL_H
#define GLINT_PATTERN_KERNEL_TEXEL_H

#include "engine/render/pattern/kernel_call.h"
#include "engine/render/pattern/kernel_elementary.h"
#include "engine/render/pattern/kernel_exact.h"
#include "engine/render/stages/simd/elementary.h"

/// One level of a texture: the four texels to read, and their weights.
typedef struct texel_place {
    _Alignas(64) double x[VD], y[VD]; ///< column and row of the upper left texel, -1 .. side - 1
    _Alignas(64) double fx[VD], fy[VD];
} texel_place;

static inline vd texel_wrap(bool repeat, vd u)
{
    if (repeat)
        u = u - d_floor(u);
    return d_min(d_max(u, d_set(0)), d_set(1));
}

static inline bool texel_repeats_u(const glint_texture_table *texture) { return texture->wrap != GLINT_WRAP_CLAMP; }

static inline bool texel_repeats_v(const glint_texture_table *texture) { return texture->wrap == GLINT_WRAP_REPEAT; }

/// Computes positions and weights. width, height: the size of each lane's level.
static void texel_locate(vd u, vd v, vd width, vd height, texel_place *at)
{
    const vd x = u * width - d_set(0.5), y = (d_set(1) - v) * height - d_set(0.5);
    d_store(at->x, d_floor(x));
    d_store(at->y, d_floor(y));
    d_store(at->fx, x - d_floor(x));
    d_store(at->fy, y - d_floor(y));
}

/// Wraps or clamps an index `at`, -1 .. side.
static inline size_t texel_index(bool repeat, int at, uint32_t side)
{
    if (at < 0)
        return repeat ? side - 1 : 0;
    if ((uint32_t)at < side)
        return (size_t)at;
    return repeat ? 0 : side - 1;
}

/// Returns the four channels of the four texels of a lane: upper left, upper right, lower left, lower right.
static inline void texel_corners(const glint_texture_table *texture, const glint_texture_level *level,
                                 const texel_place *at, int lane, const float *corner[4])
{
    const bool across = texel_repeats_u(texture), down = texel_repeats_v(texture);
    const int x = (int)at->x[lane], y = (int)at->y[lane];
    const size_t left = texel_index(across, x, level->width), right = texel_index(across, x + 1, level->width);
    const size_t upper = texel_index(down, y, level->height) * level->width;
    const size_t lower = texel_index(down, y + 1, level->height) * level->width;
    corner[0] = level->texels + 4 * (upper + left);
    corner[1] = level->texels + 4 * (upper + right);
    corner[2] = level->texels + 4 * (lower + left);
    corner[3] = level->texels + 4 * (lower + right);
}

static inline double mixed(double t, double a, double b) { return a + t * (b - a); }

static void texel_color(const float *const corner[4], double fx, double fy, double out[4])
{
    for (int c = 0; c < 4; c++) {
        const double upper = mixed(fx, (double)corner[0][c], (double)corner[1][c]);
        const double lower = mixed(fx, (double)corner[2][c], (double)corner[3][c]);
        out[c] = mixed(fy, upper, lower);
    }
}

static void texel_slopes(const float *const corner[4], double fx, double fy, const glint_texture_level *level,
                         double out[8])
{
    for (int c = 0; c < 4; c++) {
        const double a = (double)corner[0][c], b = (double)corner[1][c];
        const double d = (double)corner[2][c], e = (double)corner[3][c];
        out[c] = (double)level->width * mixed(fy, b - a, e - d);
        out[4 + c] = -((double)level->height * (mixed(fx, d, e) - mixed(fx, a, b)));
    }
}

/// The positions that each lane reads. A pixel's longer side is covered by several squares as wide as its shorter side.
typedef struct texel_filter {
    vd level; ///< the level to read; the fraction is the share of the next level
    vd probes; ///< number of positions
    vd u, v; ///< from the first position to the last one
} texel_filter;

static inline texel_filter texel_filter_of(const glint_texture_table *texture, vd u_footprint, vd v_footprint)
{
    const vd width = d_set(texture->levels[0].width), height = d_set(texture->levels[0].height), one = d_set(1), none = d_set(0);
    const vd across = u_footprint * width, down = v_footprint * height;
    const dm tall = d_lt(across, down);
    const vd longer = d_select(tall, down, across), shorter = d_select(tall, across, down);
    const vd size = d_max(d_max(shorter, one), longer / d_set(GLINT_TEXEL_PROBES));
    const vd level = d_min(d_select(d_lt(one, size), d_log2(size), none), d_set(texture->level_count - 1));
    const vd spread = (longer - size) / d_select(tall, height, width);
    return (texel_filter) { level, d_max(d_ceil(longer / size - d_set(GLINT_TEXEL_SLACK)), one), d_select(tall, none, spread),
                            d_select(tall, spread, none) };
}

/// Reads the given lanes from their level (`next` 0), or adds the next level times the share of that level (`next`
/// 1).
static void texel_add(const op_call *call, vd u, vd v, const double level[VD], unsigned lanes, int next, bool slope,
                      double out[VD][GLINT_RESULTS_MAX])
{
    _Alignas(64) double width[VD] = { 0 }, height[VD] = { 0 };
    texel_place at;
    for (unsigned bits = lanes; bits; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        width[lane] = call->texture->levels[(int)level[lane] + next].width;
        height[lane] = call->texture->levels[(int)level[lane] + next].height;
    }
    texel_locate(u, v, d_load(width), d_load(height), &at);
    for (unsigned bits = lanes; bits; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        const glint_texture_level *from = &call->texture->levels[(int)level[lane] + next];
        const float *corner[4];
        double made[GLINT_RESULTS_MAX];
        texel_corners(call->texture, from, &at, lane, corner);
        if (slope)
            texel_slopes(corner, at.fx[lane], at.fy[lane], from, made);
        else
            texel_color(corner, at.fx[lane], at.fy[lane], made);
        for (int c = 0; c < (slope ? 8 : 4); c++)
            out[lane][c] = next ? mixed(level[lane] - (int)level[lane], out[lane][c], made[c]) : made[c];
    }
}

static void texel_nearest(const op_call *call, vd u, vd v, bool slope, double out[VD][GLINT_RESULTS_MAX])
{
    const glint_texture_level *from = &call->texture->levels[0];
    const vd width = d_set(from->width), height = d_set(from->height), one = d_set(1);
    _Alignas(64) double x[VD], y[VD];
    d_store(x, d_min(d_floor(u * width), width - one));
    d_store(y, d_min(d_floor((one - v) * height), height - one));
    for (int lane = 0; lane < VD; lane++)
        for (size_t c = 0; c < (slope ? 8 : 4); c++)
            out[lane][c] = slope ? 0 : (double)from->texels[4 * ((size_t)y[lane] * from->width + (size_t)x[lane]) + c];
}

/// Reads the given lanes at one position.
static void texel_read(const op_call *call, vd u, vd v, vd level, unsigned lanes, bool slope, double out[VD][GLINT_RESULTS_MAX])
{
    const unsigned between = lanes & dm_bits(d_lt(d_floor(level), level));
    _Alignas(64) double levels[VD];
    d_store(levels, level);
    u = texel_wrap(texel_repeats_u(call->texture), u);
    v = texel_wrap(texel_repeats_v(call->texture), v);
    texel_add(call, u, v, levels, lanes, 0, slope, out);
    if (between)
        texel_add(call, u, v, levels, between, 1, slope, out);
}

/// Reads the lanes with several positions, and stores their mean.
static void texel_probe(const op_call *call, vd u, vd v, const texel_filter *filter, unsigned several, bool slope,
                        double out[VD][GLINT_RESULTS_MAX])
{
    _Alignas(64) double probes[VD];
    double sum[VD][GLINT_RESULTS_MAX] = { { 0 } }, one[VD][GLINT_RESULTS_MAX];
    d_store(probes, filter->probes);
    unsigned lanes = several;
    for (int i = 0; lanes; i++) {
        const vd at = d_set(i) / (filter->probes - d_set(1)) - d_set(0.5);
        texel_read(call, u + filter->u * at, v + filter->v * at, filter->level, lanes, slope, one);
        for (unsigned bits = lanes; bits; bits &= bits - 1) {
            const int lane = __builtin_ctz(bits);
            for (int c = 0; c < (slope ? 8 : 4); c++)
                sum[lane][c] += one[lane][c];
            if (i + 1 >= (int)probes[lane])
                lanes &= ~(1u << lane);
        }
    }
    for (unsigned bits = several; bits; bits &= bits - 1)
        for (int c = 0, lane = __builtin_ctz(bits); c < (slope ? 8 : 4); c++)
            out[lane][c] = sum[lane][c] / probes[lane];
}

INNER void texel_vector(const op_call *call, size_t i, bool slope)
{
    const vd u = op_in(call, 0, i), v = op_in(call, 1, i);
    double out[VD][GLINT_RESULTS_MAX];
    if (call->texture->filter == GLINT_FILTER_NEAREST) {
        texel_nearest(call, texel_wrap(texel_repeats_u(call->texture), u), texel_wrap(texel_repeats_v(call->texture), v), slope, out);
    } else {
        const texel_filter filter = texel_filter_of(call->texture, op_in(call, 2, i), op_in(call, 3, i));
        const unsigned several = dm_bits(d_lt(d_set(1), filter.probes));
        if (several != D_ALL)
            texel_read(call, u, v, filter.level, D_ALL & ~several, slope, out);
        if (several)
            texel_probe(call, u, v, &filter, several, slope, out);
    }
    for (int c = 0; c < (slope ? 8 : 4); c++)
        for (int lane = 0; lane < VD; lane++)
            call->out[c][i + (size_t)lane] = out[lane][c];
}

static void op_texel(const op_call *call)
{
    for (size_t i = 0; i < call->lanes; i += VD)
        texel_vector(call, i, false);
}

static void op_texel_slope(const op_call *call)
{
    for (size_t i = 0; i < call->lanes; i += VD)
        texel_vector(call, i, true);
}

#endif
