/// The vector vocabulary in the vector extensions of GCC and clang, for any little-endian processor: ARM's NEON (with
/// the few intrinsics of simd/neon.h), WebAssembly (with the intrinsics of simd/wasm.h), RISC-V's V, x86's SSE2.
/// simd/avx512.h explains the words.
#ifndef GLINT_SIMD_H
#define GLINT_SIMD_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define VF 4
#define VD 2
// Loads and stores through a cast pointer may alias, as with Intel's own types.
typedef float vf __attribute__((vector_size(16), may_alias));
typedef double vd __attribute__((vector_size(16), may_alias));
typedef uint32_t vi __attribute__((vector_size(16), may_alias));
typedef int32_t fm __attribute__((vector_size(16)));
typedef int64_t dm __attribute__((vector_size(16)));
typedef uint64_t glint_u64x2 __attribute__((vector_size(16)));
typedef glint_u64x2 vq;
typedef float glint_f32x2 __attribute__((vector_size(8)));

#ifdef __aarch64__
#include "engine/render/stages/simd/neon.h"
#elif defined __wasm_simd128__
#include "engine/render/stages/simd/wasm.h"
#else
static inline unsigned fm_bits(fm m)
{
    const glint_u64x2 lane = (glint_u64x2)(m & (fm) { 1, 2, 4, 8 });
    const uint64_t all = lane[0] | lane[1];
    return (unsigned)(all | all >> 32);
}
static inline unsigned dm_bits(dm m)
{
    const dm lane = m & (dm) { 1, 2 };
    return (unsigned)(lane[0] | lane[1]);
}

static inline vd d_load_f(const float *p)
{
    glint_f32x2 x;
    memcpy(&x, p, sizeof x);
    return __builtin_convertvector(x, vd);
}

/// Joins two vectors of doubles, rounded to float.
static inline vf f_join(vd low, vd high)
{
    // written without (float)low[0] and so on, because GCC 12 would then use the unrounded numbers after f_split
    const glint_f32x2 x = __builtin_convertvector(low, glint_f32x2), y = __builtin_convertvector(high, glint_f32x2);
    return (vf) { x[0], x[1], y[0], y[1] };
}

/// Splits a vector of floats into two vectors of doubles.
static inline void f_split(vf x, vd out[2])
{
    out[0] = (vd) { x[0], x[1] };
    out[1] = (vd) { x[2], x[3] };
}

/// Stores i into p in the lanes of the mask.
static inline void d_put_index(uint32_t *p, dm mask, uint32_t i)
{
    for (int lane = 0; lane < VD; lane++)
        if (mask[lane])
            p[lane] = i;
}

static inline vq q_mul(vq a, vq b) { return (a & UINT32_MAX) * (b & UINT32_MAX); }
#endif

#ifndef __wasm_simd128__
static inline vf f_sqrt(vf x) { return (vf) { sqrtf(x[0]), sqrtf(x[1]), sqrtf(x[2]), sqrtf(x[3]) }; }
static inline vf f_select(fm m, vf a, vf b) { return (vf)(((fm)a & m) | ((fm)b & ~m)); }
static inline vf f_min(vf a, vf b) { return f_select(a < b, a, b); }
static inline vf f_max(vf a, vf b) { return f_select(a > b, a, b); }
static inline vf f_abs(vf x) { return (vf)((fm)x & INT32_MAX); }
static inline vd d_sqrt(vd x) { return (vd) { sqrt(x[0]), sqrt(x[1]) }; }
static inline vd d_select(dm m, vd a, vd b)
{
#ifdef __SSE2__ // GCC 12 fails on a select whose mask comes from several branches: plain SSE2 has no instruction for it
    __asm__("" : "+x"(m));
#endif
    return (vd)(((dm)a & m) | ((dm)b & ~m));
}
static inline vd d_min(vd a, vd b) { return d_select(a < b, a, b); }
static inline vd d_max(vd a, vd b) { return d_select(a > b, a, b); }
static inline vd d_abs(vd x) { return (vd)((dm)x & INT64_MAX); }
static inline vd d_floor(vd x) { return (vd) { floor(x[0]), floor(x[1]) }; }
static inline vd d_ceil(vd x) { return (vd) { ceil(x[0]), ceil(x[1]) }; }

static inline void d_store_f(float *p, vd x)
{
    const glint_f32x2 rounded = __builtin_convertvector(x, glint_f32x2);
    memcpy(p, &rounded, sizeof rounded);
}
#endif

static inline vf f_set(float x) { return (vf) { x, x, x, x }; }
static inline vf f_load(const float *p) { return *(const vf *)p; }
static inline vf f_load_any(const float *p)
{
    vf x;
    memcpy(&x, p, sizeof x);
    return x;
}
static inline void f_store(float *p, vf x) { *(vf *)p = x; }
static inline fm f_lt(vf a, vf b) { return a < b; }
static inline fm f_le(vf a, vf b) { return a <= b; }
static inline fm f_eq(vf a, vf b) { return a == b; }
static inline float f_max_all(vf x)
{
    const float low = x[0] > x[2] ? x[0] : x[2], high = x[1] > x[3] ? x[1] : x[3];
    return low > high ? low : high;
}
static inline float f_min_all(vf x)
{
    const float low = x[0] < x[2] ? x[0] : x[2], high = x[1] < x[3] ? x[1] : x[3];
    return low < high ? low : high;
}
static inline fm fm_and(fm a, fm b) { return a & b; }
static inline fm fm_or(fm a, fm b) { return a | b; }
static inline fm fm_andnot(fm a, fm b) { return a & ~b; }
static inline fm fm_from_bits(unsigned bits)
{
    const fm lane = { 1, 2, 4, 8 };
    return (lane & (int32_t)bits) == lane;
}

static inline vi f_bits(vf x) { return (vi)x; }
static inline vf f_from_bits(vi x) { return (vf)x; }
static inline vi i_from_f(vf x) { return (vi)__builtin_convertvector(x, fm); } // rounds towards 0
static inline vi i_set(uint32_t x) { return (vi) { x, x, x, x }; }
static inline vi i_add(vi a, vi b) { return a + b; }
static inline vi i_sub(vi a, vi b) { return a - b; }
static inline vi i_and(vi a, vi b) { return a & b; }
static inline vi i_or(vi a, vi b) { return a | b; }
#define i_shl(x, n) ((x) << (n))
#define i_shr(x, n) ((x) >> (n))
static inline fm i_lt(vi a, vi b) { return (fm)a < (fm)b; }
static inline fm i_eq(vi a, vi b) { return a == b; }
static inline vi i_load(const uint32_t *p) { return *(const vi *)p; }
static inline void i_store(uint32_t *p, vi x) { *(vi *)p = x; }
static inline vi i_gather(const uint32_t *table, vi index)
{
    return (vi) { table[index[0]], table[index[1]], table[index[2]], table[index[3]] };
}

static inline fm i_any_above(vi a, vi b, vi c, vi limit) { return (a > limit) | (b > limit) | (c > limit); }

static inline void i_store_rgb(uint8_t *to, size_t stride, vi rgb, bool spill)
{
    (void)stride, (void)spill;
    const uint32_t packed[3] = { rgb[0] | rgb[1] << 24, rgb[1] >> 8 | rgb[2] << 16, rgb[2] >> 16 | rgb[3] << 8 };
    memcpy(to, packed, sizeof packed);
}

static inline vd d_set(double x) { return (vd) { x, x }; }
static inline vd d_load(const double *p) { return *(const vd *)p; }
static inline void d_store(double *p, vd x) { *(vd *)p = x; }
static inline vd d_pick(const double *table, const uint32_t *index)
{
    return (vd) { table[index[0]], table[index[1]] };
}
static inline dm d_lt(vd a, vd b) { return a < b; }
static inline dm d_le(vd a, vd b) { return a <= b; }
static inline dm d_eq(vd a, vd b) { return a == b; }
static inline dm dm_and(dm a, dm b) { return a & b; }
static inline dm dm_or(dm a, dm b) { return a | b; }
static inline dm dm_andnot(dm a, dm b) { return a & ~b; }
static inline dm dm_from_bits(unsigned bits) { return (dm) { -(int64_t)(bits & 1), -(int64_t)(bits >> 1 & 1) }; }

static inline vd d_exponent(vd x)
{
    return (vd)((glint_u64x2)x >> 52 | 0x4330000000000000) - d_set(0x1p52 + 1023);
}
static inline vd d_mantissa(vd x) { return (vd)(((glint_u64x2)x & 0x000fffffffffffff) | 0x3ff0000000000000); }

static inline vd d_copysign(vd size, vd sign) { return (vd)(((dm)size & INT64_MAX) | ((dm)sign & INT64_MIN)); }

static inline vq d_bits(vd x) { return (vq)x; }
static inline vd d_of_bits(vq x) { return (vd)x; }
/// Returns the bits of floor(x) + 0x1.8p52: for |x| < 2^51, the lowest bits are the lowest bits of the integer part.
static inline vq d_floor_bits(vd x) { return d_bits(d_floor(x) + d_set(0x1.8p52)); }
static inline vq q_set(uint64_t x) { return (vq) { x, x }; }
static inline vq q_add(vq a, vq b) { return a + b; }
static inline vq q_and(vq a, vq b) { return a & b; }
static inline vq q_or(vq a, vq b) { return a | b; }
static inline vq q_xor(vq a, vq b) { return a ^ b; }
#define q_shl(x, n) ((x) << (n))
#define q_shr(x, n) ((x) >> (n))
static inline dm q_is(vq x, uint32_t bits, uint32_t value) { return (x & bits) == value; }
static inline dm q_test(vq x, uint32_t bit) { return q_is(x, bit, bit); }

#ifdef __FP_FAST_FMA
static inline vd d_two_prod(vd a, vd b, vd *error)
{
    const vd p = a * b;
    *error = (vd) { fma(a[0], b[0], -p[0]), fma(a[1], b[1], -p[1]) };
    return p;
}
#else
/// Returns a * b and the rounding error, by Dekker's product (1971) with Veltkamp's splitting: the same bits as with
/// FMA, except after overflow or underflow.
static inline vd d_two_prod(vd a, vd b, vd *error)
{
    const vd splitter = d_set(0x1p27 + 1);
    vd p = a * b;
    vd wa = splitter * a, wb = splitter * b;
    vd ah = wa - (wa - a), bh = wb - (wb - b);
    vd al = a - ah, bl = b - bh;
    *error = ((ah * bh - p) + ah * bl + al * bh) + al * bl;
    return p;
}
#endif

#endif
