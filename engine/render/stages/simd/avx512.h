/// The vector vocabulary for AVX-512 (F, DQ, VL, BW) and FMA.
///
///   vf: 16 floats
///   vd: 8 doubles
///   vi: 32-bit integers, as many as vf
///   vq: 64-bit integers, as many as vd
///   fm, dm: masks of vf and vd
///
/// An index is a 32-bit number below 2^31 (or GLINT_MISS) in a lane of either width: vd holds it as the value of a
/// double, vf as raw bits. Arithmetic is written with operators. FMA is only used in two_prod; in unit, where it
/// gives the bits of a division; and in the estimate of tone, whose rounding does not affect results.
#ifndef GLINT_SIMD_H
#define GLINT_SIMD_H

#include <immintrin.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define VF 16
#define VD 8
typedef __m512 vf;
typedef __m512d vd;
typedef __m512i vi;
typedef __m512i vq;
typedef __mmask16 fm;
typedef __mmask8 dm;

static inline vf f_set(float x) { return _mm512_set1_ps(x); }
static inline vf f_load(const float *p) { return _mm512_load_ps(p); }
static inline void f_store(float *p, vf x) { _mm512_store_ps(p, x); }
static inline vf f_sqrt(vf x) { return _mm512_sqrt_ps(x); }
static inline vf f_min(vf a, vf b) { return _mm512_min_ps(a, b); }
static inline vf f_max(vf a, vf b) { return _mm512_max_ps(a, b); }
static inline float f_max_all(vf x) { return _mm512_reduce_max_ps(x); }
static inline float f_min_all(vf x) { return _mm512_reduce_min_ps(x); }
static inline vf f_abs(vf x) { return _mm512_abs_ps(x); }
static inline fm f_lt(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
static inline fm f_le(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
static inline fm f_eq(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
static inline vf f_select(fm m, vf a, vf b) { return _mm512_mask_blend_ps(m, b, a); }
static inline fm fm_and(fm a, fm b) { return a & b; }
static inline fm fm_or(fm a, fm b) { return a | b; }
static inline fm fm_andnot(fm a, fm b) { return a & (fm)~b; }
static inline unsigned fm_bits(fm m) { return m; }
static inline fm fm_from_bits(unsigned bits) { return (fm)bits; }

static inline vi f_bits(vf x) { return _mm512_castps_si512(x); }
static inline vf f_from_bits(vi x) { return _mm512_castsi512_ps(x); }
static inline vi i_from_f(vf x) { return _mm512_cvttps_epi32(x); } // rounds towards 0
static inline vi i_set(uint32_t x) { return _mm512_set1_epi32((int)x); }
static inline vi i_add(vi a, vi b) { return _mm512_add_epi32(a, b); }
static inline vi i_sub(vi a, vi b) { return _mm512_sub_epi32(a, b); }
static inline vi i_and(vi a, vi b) { return _mm512_and_si512(a, b); }
static inline vi i_or(vi a, vi b) { return _mm512_or_si512(a, b); }
#define i_shl(x, n) _mm512_slli_epi32(x, n)
#define i_shr(x, n) _mm512_srli_epi32(x, n)
static inline fm i_lt(vi a, vi b) { return _mm512_cmplt_epi32_mask(a, b); }
static inline fm i_eq(vi a, vi b) { return _mm512_cmpeq_epi32_mask(a, b); }
static inline vi i_load(const uint32_t *p) { return _mm512_load_si512(p); }
static inline void i_store(uint32_t *p, vi x) { _mm512_store_si512(p, x); }
static inline vi i_gather(const uint32_t *table, vi index) { return _mm512_i32gather_epi32(index, table, 4); }

#define GLINT_PACKS 1 ///< the following four functions exist; three of them pack selected lanes at the front of a
    ///< vector, with undefined lanes after them
static inline void i_store_any(uint32_t *to, vi x) { _mm512_storeu_si512(to, x); }
static inline void i_pack(uint32_t *to, vi x, unsigned lanes)
{
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32((__mmask16)lanes, x));
}
static inline void f_pack(float *to, vf x, unsigned lanes)
{
    _mm512_storeu_ps(to, _mm512_maskz_compress_ps((__mmask16)lanes, x));
}
static inline void d_pack(double *to, __m512d x, unsigned lanes)
{
    _mm512_storeu_pd(to, _mm512_maskz_compress_pd((__mmask8)lanes, x));
}

static inline vi i_min(vi a, vi b) { return _mm512_min_epi32(a, b); }
static inline vf f_fma(vf a, vf b, vf c) { return _mm512_fmadd_ps(a, b, c); }

static inline vf f_load_any(const float *p) { return _mm512_loadu_ps(p); }

/// Selects the bytes of a where the mask's bytes are 255, and the bytes of b where they are 0.
static inline vi i_merge(vi mask, vi a, vi b) { return _mm512_ternarylogic_epi32(mask, a, b, 0xca); }

/// Returns the lanes where the bits of a, b or c, as unsigned integers, are above the limit.
static inline fm i_any_above(vi a, vi b, vi c, vi limit)
{
    return _mm512_cmpgt_epu32_mask(_mm512_max_epu32(_mm512_max_epu32(a, b), c), limit);
}

/// Returns table[biased exponent & 15]; the table is F_EXPONENTS floats in registers.
#define F_EXPONENTS 16
static inline vf f_by_exponent(const vf table[F_EXPONENTS / VF], vf x)
{
    return _mm512_permutexvar_ps(i_shr(f_bits(x), 23), table[0]);
}
#define f_by_exponent f_by_exponent

/// Stores pixels, one per lane as red | green << 8 | blue << 16, as rows of four: 12 bytes, `stride` apart. `spill`:
/// whether the four bytes after each row may be overwritten.
static inline void i_store_rgb(uint8_t *to, size_t stride, vi rgb, bool spill)
{
    const __m128i bytes = _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1);
    const __m512i packed = _mm512_shuffle_epi8(rgb, _mm512_broadcast_i32x4(bytes));
    const __m128i row[4] = { _mm512_castsi512_si128(packed), _mm512_extracti32x4_epi32(packed, 1),
                             _mm512_extracti32x4_epi32(packed, 2), _mm512_extracti32x4_epi32(packed, 3) };
    for (int i = 0; i < 4; i++, to += stride) {
        if (spill) {
            _mm_storeu_si128((__m128i *)to, row[i]);
        } else {
            _mm_storel_epi64((__m128i *)to, row[i]);
            const int last = _mm_extract_epi32(row[i], 2);
            memcpy(to + 8, &last, sizeof last);
        }
    }
}

static inline vd d_set(double x) { return _mm512_set1_pd(x); }
static inline vd d_load(const double *p) { return _mm512_load_pd(p); }
static inline void d_store(double *p, vd x) { _mm512_store_pd(p, x); }

/// Returns table[index], for a table of 16 numbers and indices below 16.
static inline vd d_pick(const double *table, const uint32_t *index)
{
    const __m512i i = _mm512_cvtepu32_epi64(_mm256_load_si256((const __m256i *)index));
    return _mm512_permutex2var_pd(d_load(table), i, d_load(table + 8));
}
static inline vd d_sqrt(vd x) { return _mm512_sqrt_pd(x); }
static inline vd d_min(vd a, vd b) { return _mm512_min_pd(a, b); }
static inline vd d_max(vd a, vd b) { return _mm512_max_pd(a, b); }
static inline dm d_lt(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
static inline dm d_le(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
static inline dm d_eq(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
static inline vd d_select(dm m, vd a, vd b) { return _mm512_mask_blend_pd(m, b, a); }
static inline dm dm_and(dm a, dm b) { return a & b; }
static inline dm dm_or(dm a, dm b) { return a | b; }
static inline dm dm_andnot(dm a, dm b) { return a & (dm)~b; }
static inline unsigned dm_bits(dm m) { return m; }
static inline dm dm_from_bits(unsigned bits) { return (dm)bits; }

static inline vd d_load_f(const float *p) { return _mm512_cvtps_pd(_mm256_load_ps(p)); }
static inline void d_store_f(float *p, vd x) { _mm256_store_ps(p, _mm512_cvtpd_ps(x)); }

/// Joins two vectors of doubles, rounded to float.
static inline vf f_join(vd low, vd high)
{
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(low)), _mm512_cvtpd_ps(high), 1);
}

/// Splits a vector of floats into two vectors of doubles.
static inline void f_split(vf x, vd out[2])
{
    out[0] = _mm512_cvtps_pd(_mm512_castps512_ps256(x));
    out[1] = _mm512_cvtps_pd(_mm512_extractf32x8_ps(x, 1));
}

/// Stores i into p, in the lanes of the mask.
static inline void d_put_index(uint32_t *p, dm mask, uint32_t i)
{
    __m256i *to = (__m256i *)p;
    _mm256_store_si256(to, _mm256_mask_blend_epi32(mask, _mm256_load_si256(to), _mm256_set1_epi32((int)i)));
}

/// Return the biased exponent, as a number, and the mantissa, in [1, 2). For normal numbers > 0.
static inline vd d_exponent(vd x)
{
    __m512i e = _mm512_srli_epi64(_mm512_castpd_si512(x), 52);
    return _mm512_castsi512_pd(_mm512_or_si512(e, _mm512_set1_epi64(0x4330000000000000))) - d_set(0x1p52 + 1023);
}
static inline vd d_mantissa(vd x)
{
    __m512i m = _mm512_and_si512(_mm512_castpd_si512(x), _mm512_set1_epi64(0x000fffffffffffff));
    return _mm512_castsi512_pd(_mm512_or_si512(m, _mm512_set1_epi64(0x3ff0000000000000)));
}

static inline vd d_abs(vd x) { return _mm512_abs_pd(x); }
static inline vd d_copysign(vd size, vd sign)
{
    return _mm512_or_pd(_mm512_andnot_pd(_mm512_set1_pd(-0.0), size), _mm512_and_pd(_mm512_set1_pd(-0.0), sign));
}
static inline vd d_floor(vd x) { return _mm512_roundscale_pd(x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
static inline vd d_ceil(vd x) { return _mm512_roundscale_pd(x, _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC); }

static inline vq d_bits(vd x) { return _mm512_castpd_si512(x); }
static inline vd d_of_bits(vq x) { return _mm512_castsi512_pd(x); }
/// Returns the bits of floor(x) + 0x1.8p52: for |x| < 2^51, the lowest bits are the lowest bits of the integer part.
static inline vq d_floor_bits(vd x)
{
    return d_bits(_mm512_add_round_pd(x, d_set(0x1.8p52), _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC));
}
static inline vq q_set(uint64_t x) { return _mm512_set1_epi64((long long)x); }
static inline vq q_add(vq a, vq b) { return _mm512_add_epi64(a, b); }
static inline vq q_and(vq a, vq b) { return _mm512_and_si512(a, b); }
static inline vq q_or(vq a, vq b) { return _mm512_or_si512(a, b); }
static inline vq q_xor(vq a, vq b) { return _mm512_xor_si512(a, b); }
#define q_shl(x, n) _mm512_slli_epi64(x, n)
#define q_shr(x, n) _mm512_srli_epi64(x, n)

/// Returns the 64-bit products of the unsigned lower 32 bits.
static inline vq q_mul(vq a, vq b) { return _mm512_mul_epu32(a, b); }

/// Returns the lanes in which x has the same bits as `value` at the positions that are set in `bits`, which are all
/// among the lower 32.
static inline dm q_is(vq x, uint32_t bits, uint32_t value)
{
    return value ? _mm512_cmpeq_epi64_mask(q_and(x, q_set(bits)), q_set(value)) : _mm512_testn_epi64_mask(x, q_set(bits));
}

/// Returns the lanes in which `bit`, one of the lower 32 bits, is set.
static inline dm q_test(vq x, uint32_t bit) { return _mm512_test_epi64_mask(x, q_set(bit)); }

#define GLINT_D_FUSED 1 ///< the following three functions exist
/// Return a * b + c and c - a * b, rounded once.
static inline vd d_fma(vd a, vd b, vd c) { return _mm512_fmadd_pd(a, b, c); }
static inline vd d_fnma(vd a, vd b, vd c) { return _mm512_fnmadd_pd(a, b, c); }

/// Returns min(|a|, |b|); undefined for NaN.
static inline vd d_least_size(vd a, vd b) { return _mm512_range_pd(a, b, 10); }

static inline vd d_two_prod(vd a, vd b, vd *error)
{
    vd p = a * b;
    *error = _mm512_fmsub_pd(a, b, p);
    return p;
}

#endif
