/// What pictures and the kernels that write their pixel values agree on. Internal.
#ifndef GLINT_FILM_CODES_H
#define GLINT_FILM_CODES_H

#include <stdint.h>

#define GLINT_TILE_WIDTH 32 ///< pixels
#define GLINT_TILE_HEIGHT 24

/// A table for any increasing map of 0 .. top to 0 .. 255. A bucket holds the floats with equal upper 16 bits, and
/// the map steps at most once within a bucket. Its entry is value | threshold << 8: the 8-bit value of the bucket's
/// first float, and the lower 16 bits of the first float whose value is one more (65536: none). The last entry is for
/// top.
#define GLINT_TONE_FIRST 0x3800u ///< upper bits of 2^-15; the value of smaller floats is 0

/// An estimate of the pixel value, with a fraction, and its error bound. It avoids most look-ups in the table.
typedef struct glint_tone_fit {
    float knee, slope, base; ///< x < knee: v = slope x + base
    float scale[16], power[6], offset; ///< x >= knee: v = scale[e & 15] P(m) + offset; x = m 2^(e - 127), m in [1,
        ///< 2), P(m) = power[0] + power[1] m + ... + power[5] m^5
    uint32_t doubt; ///< v is in [256, 512), so that its lower 15 bits are the fraction. If the fraction is >= doubt,
        ///< the 8 bits above it equal the table's value, however the estimate is rounded, with or without FMA
} glint_tone_fit;

#endif
