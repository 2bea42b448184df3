/// The contract of estimate and differ: which neighbouring pixels differ. Begin with stages.h.
#ifndef GLINT_CONTRACT_ADAPTIVE_H
#define GLINT_CONTRACT_ADAPTIVE_H

#include "engine/render/stages/contract/tables.h"

#define GLINT_DIFFER_PAIRS 32 ///< maximum number of pairs per call
#define GLINT_DIFFER_LENGTH 40 ///< length of each array of a line: kernels may read all of it for any number of pairs
enum { GLINT_DIFFER_ID, GLINT_DIFFER_NORMAL, GLINT_DIFFER_CODE = 4, GLINT_DIFFER_VALUES = 8 };
enum { GLINT_DIFFER_ALONG, GLINT_DIFFER_ACROSS, GLINT_DIFFER_FALLING, GLINT_DIFFER_RISING, GLINT_DIFFER_DIRECTIONS };

/// estimate: approximate 16-bit sRGB values before rounding, as a sum of three roots. Its derivative has a relative
/// error of at most GLINT_ESTIMATE_SHARE. The difference of two estimates therefore has this relative error, plus an
/// error of at most GLINT_ESTIMATE_SLACK from the rounding of three values and of float.
#define GLINT_ESTIMATE_SHARE 0.004f
#define GLINT_ESTIMATE_SLACK 4.0f ///< 16-bit values

typedef struct glint_estimate_args {
    uint32_t count; ///< a multiple of GLINT_GROUP
    float gain; ///< factor of the light
    const float *light;
    float *code; ///< out
} glint_estimate_args;
// The arithmetic: ref.h.

/// Two adjacent lines of pixels, p[0] .. and q[0] .., both rows or both columns. Each value of a line is an array of
/// GLINT_DIFFER_LENGTH numbers or more.
typedef struct glint_differ_args {
    const float *const *p, *const *q; ///< GLINT_DIFFER_VALUES arrays for each line: object number, normal, estimates.
        ///< q NULL: there is no second line
    uint32_t count; ///< number of pairs (p[i], q[i])
    uint32_t ahead; ///< number of diagonal pairs, and of pairs along a line. Both counts are at most
        ///< GLINT_DIFFER_PAIRS
    bool along; ///< true: adjacent pixels of p are also compared with each other
    bool alpha; ///< true: the estimates have four channels; false: three
    float low, high; ///< limits for the sum of the differences of two pixels' estimates: below `low` the pixels
        ///< certainly have the same colour, above `high` they certainly differ
    float cosine; ///< two normals differ if the cosine of their angle is below this
} glint_differ_args;

/// One bit per pair. `sure`: the pair differs. `undecided`: the sum of differences is between `low` and `high`, so
/// that the caller must compare the exact values; undefined for pairs that are sure.
typedef struct glint_differences {
    uint32_t sure[GLINT_DIFFER_DIRECTIONS], undecided[GLINT_DIFFER_DIRECTIONS];
} glint_differences;
// Bit i stands for the pair (p[i], p[i + 1]) in `along`, (p[i], q[i]) in `across`, (p[i], q[i + 1]) in `falling` and
// (p[i + 1], q[i]) in `rising`. Pixels differ by object, by normal if both objects are the same and not 0, and by
// their estimates. The arithmetic: ref.h.

#endif
