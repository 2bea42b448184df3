/// Point sequences that fill the unit square evenly. Internal.
#ifndef GLINT_BASE_SEQUENCE_H
#define GLINT_BASE_SEQUENCE_H

#include <stdint.h>

/// Computes point k of the first 2^bits points of Sobol's (0,2) sequence. The first n points are stratified in all
/// elementary intervals for every power of two n. Points are centred in their cells. The seed, a whole number >= 0,
/// shifts them around the torus (0: no shift).
void glint_sequence_point(uint32_t k, int bits, double seed, double out[2]);

/// Computes the shift of glint_sequence_point for a seed, 0 .. 1 in both directions; seed 0: no shift.
void glint_sequence_shift(double seed, double out[2]);

/// Computes point k of Sobol's (0,2) sequence, with digits and order scrambled at random by the seed. Sequences of
/// different seeds are independent, and each is stratified, as are any 2^m consecutive points that start at a
/// multiple of 2^m. (A. Owen, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences", 1995; by hashing, as in B.
/// Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020.)
void glint_sequence_scrambled(uint32_t k, uint64_t seed, double out[2]);

/// The scrambling constants of one seed: for the order of the points and for the digits of each coordinate.
typedef struct glint_sequence_seed {
    uint32_t order, digits[2];
} glint_sequence_seed;
glint_sequence_seed glint_sequence_seed_of(uint64_t seed);
void glint_sequence_flipped(uint32_t k, const glint_sequence_seed *seed, double out[2]);

/// Returns a hash of the two numbers.
uint64_t glint_sequence_mix(uint64_t a, uint64_t b);

/// Returns the smallest `bits` with 2^bits >= n, for n <= 2^31.
int glint_sequence_bits(uint32_t n);

#endif
