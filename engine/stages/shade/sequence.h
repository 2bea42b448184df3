// sequence: points of scrambled Sobol sequences, a group at a time: plain loops over arrays of 16, which compilers make vectors
// of. The arithmetic: base/sequence.c, glint_sequence_flipped.

/// The bits of each number in the other order.
static inline void reverse_group(uint32_t x[GLINT_GROUP])
{
    for (int i = 0; i < GLINT_GROUP; i++) {
        uint32_t y = x[i] >> 16 | x[i] << 16;
        y = (y & 0xff00ff00u) >> 8 | (y & 0x00ff00ffu) << 8;
        y = (y & 0xf0f0f0f0u) >> 4 | (y & 0x0f0f0f0fu) << 4;
        y = (y & 0xccccccccu) >> 2 | (y & 0x33333333u) << 2;
        x[i] = (y & 0xaaaaaaaau) >> 1 | (y & 0x55555555u) << 1;
    }
}

/// Flips each bit or not, by the seed and the bits below it.
static inline void flip_group(uint32_t x[GLINT_GROUP], const uint32_t seed[GLINT_GROUP])
{
    for (int i = 0; i < GLINT_GROUP; i++) {
        uint32_t y = x[i] ^ x[i] * 0x9e3779b2u;
        y = (y + seed[i]) * (seed[i] >> 16 | 1);
        y ^= y * 0x7f4a7c16u;
        x[i] = y ^ y * 0xb5297a4eu;
    }
}

/// The second coordinate's bits, lowest first, from those of the place. Bit i of the place stands for (1 + x)^i modulo 2; halves
/// are parted by (1 + x)^16 = 1 + x^16, and so on down.
static inline void second_group(uint32_t x[GLINT_GROUP])
{
    for (int i = 0; i < GLINT_GROUP; i++) {
        uint32_t y = x[i] ^ x[i] >> 16;
        y ^= y >> 8 & 0x00ff00ffu;
        y ^= y >> 4 & 0x0f0f0f0fu;
        y ^= y >> 2 & 0x33333333u;
        x[i] = y ^ (y >> 1 & 0x55555555u);
    }
}

/// Digits as a number in 0 .. 1.
static inline void scale_group(const uint32_t digits[GLINT_GROUP], double out[GLINT_GROUP])
{
    for (int i = 0; i < GLINT_GROUP; i++)
        out[i] = (digits[i] + 0.5) * 0x1p-32;
}

/// Points of the sequences of one group, from `at` on.
static inline void scrambled_group(const glint_scatter_args *args, size_t at, double out[2][GLINT_GROUP])
{
    _Alignas(64) uint32_t first[GLINT_GROUP], second[GLINT_GROUP];
    for (int i = 0; i < GLINT_GROUP; i++)
        first[i] = args->number[at + (size_t)i] + args->further;
    reverse_group(first);
    flip_group(first, args->order + at);
    reverse_group(first);
    memcpy(second, first, sizeof second);
    second_group(second);
    flip_group(first, args->digits[0] + at);
    flip_group(second, args->digits[1] + at);
    reverse_group(first);
    reverse_group(second);
    scale_group(first, out[0]);
    scale_group(second, out[1]);
}
