/// Points that fill the unit square evenly. Internal.
#ifndef GLINT_BASE_SEQUENCE_H
#define GLINT_BASE_SEQUENCE_H

#include <stdint.h>

/// Point k of the first 2^bits of Sobol's (0,2) sequence, so that any power-of-two number of first points is stratified
/// in every way; centred in its cells, and shifted around the torus by the seed, a whole number >= 0 (0: not at all).
void glint_sequence_point(uint32_t k, int bits, double seed, double out[2]);

/// The least `bits` with 2^bits >= n, for n <= 2^31.
int glint_sequence_bits(uint32_t n);

#endif
