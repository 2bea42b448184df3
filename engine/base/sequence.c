#include "engine/base/sequence.h"

#include <math.h>

int glint_sequence_bits(uint32_t n)
{
    int bits = 0;
    while (1u << bits < n)
        bits++;
    return bits;
}

uint64_t glint_sequence_mix(uint64_t a, uint64_t b)
{
    uint64_t x = a * UINT64_C(0x9e3779b97f4a7c15) + b;
    for (int i = 0; i < 2; i++) {
        x ^= x >> 32;
        x *= UINT64_C(0xd6e8feb86659fd93);
    }
    return x ^ x >> 32;
}

/// Reverses the lower `bits` bits.
static uint32_t reverse(uint32_t k, int bits)
{
    uint32_t r = 0;
    for (int i = 0; i < bits; i++)
        r |= (k >> i & 1) << (bits - 1 - i);
    return r;
}

static uint32_t reverse32(uint32_t x)
{
    x = x >> 16 | x << 16;
    x = (x & 0xff00ff00u) >> 8 | (x & 0x00ff00ffu) << 8;
    x = (x & 0xf0f0f0f0u) >> 4 | (x & 0x0f0f0f0fu) << 4;
    x = (x & 0xccccccccu) >> 2 | (x & 0x33333333u) << 2;
    return (x & 0xaaaaaaaau) >> 1 | (x & 0x55555555u) << 1;
}

/// Flips each bit or leaves it, depending only on the seed and on the lower bits.
static uint32_t flip_upwards(uint32_t x, uint32_t seed)
{
    x ^= x * 0x9e3779b2u;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x7f4a7c16u;
    x ^= x * 0xb5297a4eu;
    return x;
}

glint_sequence_seed glint_sequence_seed_of(uint64_t seed)
{
    const uint64_t digits = glint_sequence_mix(seed, 1);
    return (glint_sequence_seed) { (uint32_t)(seed ^ seed >> 32), { (uint32_t)digits, (uint32_t)(digits >> 32) } };
}

void glint_sequence_flipped(uint32_t k, const glint_sequence_seed *seed, double out[2])
{
    const uint32_t position = reverse32(flip_upwards(reverse32(k), seed->order));
    uint32_t second = 0;
    for (uint32_t i = position, v = 1u << 31; i; i >>= 1, v ^= v >> 1)
        if (i & 1)
            second ^= v;
    out[0] = (reverse32(flip_upwards(position, seed->digits[0])) + 0.5) * 0x1p-32;
    out[1] = (reverse32(flip_upwards(reverse32(second), seed->digits[1])) + 0.5) * 0x1p-32;
}

void glint_sequence_scrambled(uint32_t k, uint64_t seed, double out[2])
{
    const glint_sequence_seed flips = glint_sequence_seed_of(seed);
    glint_sequence_flipped(k, &flips, out);
}

void glint_sequence_shift(double seed, double out[2])
{
    out[0] = seed * 0x1.3c6ef372fe95p-1; // golden-ratio steps keep the shifts of neighbouring seeds far apart
    out[1] = seed * 0x1.83b2b3de7cfacp-1;
    for (int i = 0; i < 2; i++)
        out[i] -= floor(out[i]);
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
    if (seed > 0) {
        double shift[2];
        glint_sequence_shift(seed, shift);
        for (int i = 0; i < 2; i++) {
            out[i] += shift[i];
            out[i] -= floor(out[i]);
        }
    }
}
