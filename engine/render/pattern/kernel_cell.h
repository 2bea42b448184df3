// Cells: each unit cube has one feature point. The two points nearest to a position are in the 125 cubes around it:
// its own cube, the 26 cubes next to it, and the 98 beyond, most of which are too far away. Contract:
// contract.h.
#ifndef GLINT_PATTERN_KERNEL_CELL_H
#define GLINT_PATTERN_KERNEL_CELL_H

#include "engine/render/pattern/kernel_call.h"
#include "engine/render/pattern/kernel_coefficients.h"
#include "engine/render/pattern/kernel_exact.h"
#include "engine/render/pattern/kernel_noise.h"
#include "engine/render/stages/simd/elementary.h"

#define CELL_SIDE 5

typedef struct cell_place {
    vq word[3][CELL_SIDE]; ///< terms of the hash, for each cube along each axis
    vd x[3][CELL_SIDE]; ///< lower sides of the cubes, relative to the position
    vd least2[3][CELL_SIDE]; ///< squared distances to the cubes, along this axis only
} cell_place;

typedef struct cell_nearest {
    vd length2[2];
    vd to[2][3]; ///< vectors from the position to the two nearest feature points
} cell_nearest;

INNER void cell_locate(const vd p[3], cell_place *at)
{
    static const uint32_t factor[3] = { GLINT_HASH_X, GLINT_HASH_Y, GLINT_HASH_Z };
    for (int k = 0; k < 3; k++) {
        const vd whole = d_floor(p[k]), t = p[k] - whole;
        const vq word = q_word(whole);
        for (int n = 0; n < CELL_SIDE; n++) {
            const vd x = d_set(n - CELL_SIDE / 2) - t;
            const vd least = d_max(d_max(x, -(x + d_set(1))), d_set(0));
            at->word[k][n] = q_times(q_add(word, q_set((uint64_t)(int64_t)(n - CELL_SIDE / 2))), factor[k]);
            at->x[k][n] = x;
            at->least2[k][n] = least * least;
        }
    }
}

INNER void cell_visit(const cell_place *at, int i, int j, int k, bool slope, cell_nearest *nearest)
{
    const vd least2 = (at->least2[0][i] + at->least2[1][j]) + at->least2[2][k];
    if (!dm_bits(d_lt(least2, nearest->length2[1])))
        return;
    const vq seed = q_times(q_set(4), GLINT_HASH_SEED);
    const vq h = q_hash(q_add(q_add(q_add(at->word[0][i], at->word[1][j]), at->word[2][k]), seed));
    const vd d[3] = { at->x[0][i] + d_of_word(q_times(h, GLINT_HASH_B)),
                      at->x[1][j] + d_of_word(q_times(h, GLINT_HASH_C)),
                      at->x[2][k] + d_of_word(q_times(h, GLINT_HASH_X)) };
    const vd length2 = DOT(d, d);
    const dm first = d_lt(length2, nearest->length2[0]), second = d_lt(length2, nearest->length2[1]);
    for (int c = 0; slope && c < 3; c++) {
        nearest->to[1][c] = d_select(first, nearest->to[0][c], d_select(second, d[c], nearest->to[1][c]));
        nearest->to[0][c] = d_select(first, d[c], nearest->to[0][c]);
    }
    nearest->length2[1] = d_select(first, nearest->length2[0], d_select(second, length2, nearest->length2[1]));
    nearest->length2[0] = d_select(first, length2, nearest->length2[0]);
}

/// Returns whether the cube (i, j, k) is in the given ring around the middle cube.
INNER bool cell_in_ring(int i, int j, int k, int ring)
{
    const int a = abs(i - CELL_SIDE / 2), b = abs(j - CELL_SIDE / 2), c = abs(k - CELL_SIDE / 2);
    const int most = a > b ? a : b;
    return (most > c ? most : c) == ring;
}

INNER void cell_find(const vd p[3], bool slope, cell_nearest *nearest)
{
    cell_place at;
    cell_locate(p, &at);
    for (int n = 0; n < 2; n++) {
        nearest->length2[n] = d_set(INFINITY);
        for (int c = 0; c < 3; c++)
            nearest->to[n][c] = d_set(NAN);
    }
    for (int ring = 0; ring <= CELL_SIDE / 2; ring++) {
        if (ring == CELL_SIDE / 2) { // even the nearest cubes of this ring may be too far away
            vd least2 = d_min(at.least2[0][0], at.least2[0][CELL_SIDE - 1]);
            for (int c = 1; c < 3; c++)
                least2 = d_min(least2, d_min(at.least2[c][0], at.least2[c][CELL_SIDE - 1]));
            if (!dm_bits(d_lt(least2, nearest->length2[1])))
                return;
        }
        for (int k = CELL_SIDE / 2 - ring; k <= CELL_SIDE / 2 + ring; k++)
            for (int j = CELL_SIDE / 2 - ring; j <= CELL_SIDE / 2 + ring; j++)
                for (int i = CELL_SIDE / 2 - ring; i <= CELL_SIDE / 2 + ring; i++)
                    if (cell_in_ring(i, j, k, ring))
                        cell_visit(&at, i, j, k, slope, nearest);
    }
}

static void op_cell(const op_call *call)
{
    for (size_t i = 0; i < call->lanes; i += VD) {
        const vd p[3] = { op_in(call, 0, i), op_in(call, 1, i), op_in(call, 2, i) };
        cell_nearest nearest;
        cell_find(p, false, &nearest);
        for (int n = 0; n < 2; n++)
            d_store(call->out[n] + i, d_sqrt(nearest.length2[n]));
    }
}

static void op_cell_slope(const op_call *call)
{
    for (size_t i = 0; i < call->lanes; i += VD) {
        const vd p[3] = { op_in(call, 0, i), op_in(call, 1, i), op_in(call, 2, i) };
        cell_nearest nearest;
        cell_find(p, true, &nearest);
        for (int n = 0; n < 2; n++)
            for (int c = 0; c < 3; c++)
                d_store(call->out[3 * n + c] + i, -nearest.to[n][c] / d_sqrt(nearest.length2[n]));
    }
}

#endif
