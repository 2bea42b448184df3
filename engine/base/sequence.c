#include "engine/base/sequence.h"

#include <math.h>

int glint_sequence_bits(uint32_t n)
{
    int bits = 0;
    while (1u << bits < n)
        bits++;
    return bits;
}

/// Reverses the lower `bits` bits.
static uint32_t reverse(uint32_t k, int bits)
{
    uint32_t r = 0;
    for (int i = 0; i < bits; i++)
        r |= (k >> i & 1) << (bits - 1 - i);
    return r;
}

void glint_sequence_point(uint32_t k, int bits, double seed, double out[2])
{
    const double cells = (double)(1u << bits);
    uint32_t second = 0;
    for (uint32_t i = k, v = 1u << 31; i; i >>= 1, v ^= v >> 1)
        if (i & 1)
            second ^= v;
    out[0] = (reverse(k, bits) + 0.5) / cells;
    out[1] = ((bits ? second >> (32 - bits) : 0) + 0.5) / cells;
    if (seed > 0) { // golden-ratio steps: neighbouring seeds fall far apart
        out[0] += fmod(seed * 0x1.3c6ef372fe95p-1, 1);
        out[1] += fmod(seed * 0x1.83b2b3de7cfacp-1, 1);
        out[0] -= floor(out[0]);
        out[1] -= floor(out[1]);
    }
}
