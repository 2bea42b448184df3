/// Random numbers that are identical on every platform (splitmix64). A test sets `random_state` to a seed.
#ifndef GLINT_TESTS_RANDOM_H
#define GLINT_TESTS_RANDOM_H

#include <stdbool.h>
#include <stdint.h>

#include "tests/engine/cases/step.h"

static uint64_t random_state;

static inline uint64_t random_bits(void)
{
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/// A random integer in 0 .. n - 1.
static inline uint32_t below(uint32_t n) { return (uint32_t)((random_bits() >> 32) * n >> 32); }

static inline bool one_in(uint32_t n) { return below(n) == 0; }

static inline double between(double a, double b) { return a + (b - a) * ((double)(random_bits() >> 11) * 0x1p-53); }

#endif
