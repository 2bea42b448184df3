// sequence: points of scrambled Sobol sequences, as plain loops over arrays, which compilers vectorise. Each product
// depends on the previous product, so two vectors are interleaved. glint_sequence_flipped in base/sequence.c defines
// the arithmetic.
#ifndef GLINT_INDIRECT_KERNEL_SEQUENCE_H
#define GLINT_INDIRECT_KERNEL_SEQUENCE_H

#include "engine/render/stages/simd/elementary.h"

#define DRAWN_GROUPS (VF < GLINT_GROUP ? 1 : 2) ///< groups that are computed together, so that there are two vectors
#define DRAWN (DRAWN_GROUPS * GLINT_GROUP)

/// Reverses the bits of each number.
static inline void reverse_drawn(uint32_t x[DRAWN])
{
    for (int i = 0; i < DRAWN; i++) {
        uint32_t y = x[i] >> 16 | x[i] << 16;
        y = (y & 0xff00ff00u) >> 8 | (y & 0x00ff00ffu) << 8;
        y = (y & 0xf0f0f0f0u) >> 4 | (y & 0x0f0f0f0fu) << 4;
        y = (y & 0xccccccccu) >> 2 | (y & 0x33333333u) << 2;
        x[i] = (y & 0xaaaaaaaau) >> 1 | (y & 0x55555555u) << 1;
    }
}

/// Flips each bit or not, depending on the seed and on the lower bits.
static inline void flip_drawn(uint32_t x[DRAWN], const uint32_t seed[DRAWN])
{
    for (int i = 0; i < DRAWN; i++) {
        uint32_t y = x[i] ^ x[i] * 0x9e3779b2u;
        y = (y + seed[i]) * (seed[i] >> 16 | 1);
        y ^= y * 0x7f4a7c16u;
        x[i] = y ^ y * 0xb5297a4eu;
    }
}

/// Computes the second coordinate's bits, lowest first, from the bits of the index. Bit i of the index stands for (1
/// + x)^i modulo 2. The identity (1 + x)^16 = 1 + x^16 separates the two halves of the bits. Then (1 + x)^8 = 1 + x^8
/// separates the two halves of each half, and so on.
static inline void second_drawn(uint32_t x[DRAWN])
{
    for (int i = 0; i < DRAWN; i++) {
        uint32_t y = x[i] ^ x[i] >> 16;
        y ^= y >> 8 & 0x00ff00ffu;
        y ^= y >> 4 & 0x0f0f0f0fu;
        y ^= y >> 2 & 0x33333333u;
        x[i] = y ^ (y >> 1 & 0x55555555u);
    }
}

/// Converts digits to numbers in 0 .. 1.
static inline void scale_drawn(const uint32_t digits[DRAWN], double out[DRAWN])
{
    for (int i = 0; i < DRAWN; i++)
        out[i] = (digits[i] + 0.5) * 0x1p-32;
}

/// Copies the numbers of the listed groups, one group after the other.
static inline void take_groups(const uint32_t *from, const uint32_t groups[DRAWN_GROUPS], uint32_t to[DRAWN])
{
    for (int k = 0; k < DRAWN_GROUPS; k++)
        memcpy(to + k * GLINT_GROUP, from + (size_t)groups[k] * GLINT_GROUP, GLINT_GROUP * sizeof *to);
}

/// Computes points of the sequences of the listed groups.
static inline void scrambled_groups(const glint_scatter_args *args, const uint32_t groups[DRAWN_GROUPS],
                                    double out[2][DRAWN])
{
    _Alignas(64) uint32_t first[DRAWN], second[DRAWN], seed[DRAWN];
    take_groups(args->number, groups, first);
    for (int i = 0; i < DRAWN; i++)
        first[i] += args->further;
    reverse_drawn(first);
    take_groups(args->order, groups, seed);
    flip_drawn(first, seed);
    reverse_drawn(first);
    memcpy(second, first, sizeof second);
    second_drawn(second);
    take_groups(args->digits[0], groups, seed);
    flip_drawn(first, seed);
    take_groups(args->digits[1], groups, seed);
    flip_drawn(second, seed);
    reverse_drawn(first);
    reverse_drawn(second);
    scale_drawn(first, out[0]);
    scale_drawn(second, out[1]);
}

#endif
