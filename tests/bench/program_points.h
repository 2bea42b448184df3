/// The points that programs are timed with:
/// the inputs of a pattern or shader for 128 points, and buffers for the results.
#ifndef GLINT_BENCH_PROGRAM_POINTS_H
#define GLINT_BENCH_PROGRAM_POINTS_H

#include <stdint.h>

#include "engine/glint.h"
#include "engine/glint_math.h"

enum { PROGRAM_POINTS = 128, PROGRAM_REPEATS = 100 };

typedef struct program_points {
    _Alignas(64) double input[GLINT_INPUT_COUNT][PROGRAM_POINTS];
    _Alignas(64) float plane[6][PROGRAM_POINTS];
} program_points;

/// Fills the inputs: positions in -10 .. 10; shininess below 64; other inputs in 0 .. 1, so that about half of the
/// highlights are nonzero.
static inline void program_points_fill(program_points *points)
{
    uint64_t state = 1;
    for (int i = 0; i < GLINT_INPUT_COUNT; i++)
        for (int k = 0; k < PROGRAM_POINTS; k++) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            const double share = (double)(state >> 11) * 0x1p-53;
            points->input[i][k] = i < 3 ? 20 * share - 10 : i == GLINT_INPUT_SHININESS ? 64 * share : 0.8 * share;
        }
}

#endif
