/// Points that fill the unit square evenly. Internal.
#ifndef GLINT_BASE_SEQUENCE_H
#define GLINT_BASE_SEQUENCE_H

#include <stdint.h>

/// Point k of the first 2^bits of Sobol's (0,2) sequence, so that any power-of-two number of first points is stratified
/// in every way; centred in its cells, and shifted around the torus by the seed, a whole number >= 0 (0: not at all).
void glint_sequence_point(uint32_t k, int bits, double seed, double out[2]);

/// Point k of Sobol's (0,2) sequence, its digits and its order scrambled at random by the seed, so that sequences of
/// different seeds have nothing in common and each keeps its evenness: that of every 2^m points from a multiple of 2^m on.
/// (A. Owen, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences", 1995; by hashing, as in B. Burley, "Practical Hash-based
/// Owen Scrambling", JCGT 9(4), 2020.)
void glint_sequence_scrambled(uint32_t k, uint64_t seed, double out[2]);

/// The constants of a sequence derived from its seed: how the order and each coordinate's digits are scrambled.
typedef struct glint_sequence_seed {
    uint32_t order, digits[2];
} glint_sequence_seed;
glint_sequence_seed glint_sequence_seed_of(uint64_t seed);
void glint_sequence_flipped(uint32_t k, const glint_sequence_seed *seed, double out[2]);

/// A number that has everything of both, mixed.
uint64_t glint_sequence_mix(uint64_t a, uint64_t b);

/// The least `bits` with 2^bits >= n, for n <= 2^31.
int glint_sequence_bits(uint32_t n);

#endif
