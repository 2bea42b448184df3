/// The vector vocabulary for AVX2 and FMA. simd/avx512.h explains the words.
#ifndef GLINT_SIMD_H
#define GLINT_SIMD_H

#include <immintrin.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define VF 8
#define VD 4
typedef __m256 vf;
typedef __m256d vd;
typedef __m256i vi;
typedef __m256i vq;
typedef __m256 fm;
typedef __m256d dm;

static inline vf f_set(float x) { return _mm256_set1_ps(x); }
static inline vf f_load(const float *p) { return _mm256_load_ps(p); }
static inline void f_store(float *p, vf x) { _mm256_store_ps(p, x); }
static inline vf f_sqrt(vf x) { return _mm256_sqrt_ps(x); }
static inline vf f_min(vf a, vf b) { return _mm256_min_ps(a, b); }
static inline vf f_max(vf a, vf b) { return _mm256_max_ps(a, b); }
static inline float f_max_all(vf x)
{
    __m128 y = _mm_max_ps(_mm256_castps256_ps128(x), _mm256_extractf128_ps(x, 1));
    y = _mm_max_ps(y, _mm_movehl_ps(y, y));
    return _mm_cvtss_f32(_mm_max_ss(y, _mm_shuffle_ps(y, y, 1)));
}
static inline float f_min_all(vf x)
{
    __m128 y = _mm_min_ps(_mm256_castps256_ps128(x), _mm256_extractf128_ps(x, 1));
    y = _mm_min_ps(y, _mm_movehl_ps(y, y));
    return _mm_cvtss_f32(_mm_min_ss(y, _mm_shuffle_ps(y, y, 1)));
}
static inline vf f_abs(vf x) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), x); }
static inline fm f_lt(vf a, vf b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
static inline fm f_le(vf a, vf b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
static inline fm f_eq(vf a, vf b) { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
static inline vf f_select(fm m, vf a, vf b) { return _mm256_blendv_ps(b, a, m); }
static inline fm fm_and(fm a, fm b) { return _mm256_and_ps(a, b); }
static inline fm fm_or(fm a, fm b) { return _mm256_or_ps(a, b); }
static inline fm fm_andnot(fm a, fm b) { return _mm256_andnot_ps(b, a); }
static inline unsigned fm_bits(fm m) { return (unsigned)_mm256_movemask_ps(m); }
static inline fm fm_from_bits(unsigned bits)
{
    const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32((int)bits), lane), lane));
}

static inline vi f_bits(vf x) { return _mm256_castps_si256(x); }
static inline vf f_from_bits(vi x) { return _mm256_castsi256_ps(x); }
static inline vi i_from_f(vf x) { return _mm256_cvttps_epi32(x); } // rounds towards 0
static inline vi i_set(uint32_t x) { return _mm256_set1_epi32((int)x); }
static inline vi i_add(vi a, vi b) { return _mm256_add_epi32(a, b); }
static inline vi i_sub(vi a, vi b) { return _mm256_sub_epi32(a, b); }
static inline vi i_and(vi a, vi b) { return _mm256_and_si256(a, b); }
static inline vi i_or(vi a, vi b) { return _mm256_or_si256(a, b); }
#define i_shl(x, n) _mm256_slli_epi32(x, n)
#define i_shr(x, n) _mm256_srli_epi32(x, n)
static inline fm i_lt(vi a, vi b) { return _mm256_castsi256_ps(_mm256_cmpgt_epi32(b, a)); }
static inline fm i_eq(vi a, vi b) { return _mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b)); }
static inline vi i_load(const uint32_t *p) { return _mm256_load_si256((const __m256i *)p); }
static inline void i_store(uint32_t *p, vi x) { _mm256_store_si256((__m256i *)p, x); }
static inline vi i_gather(const uint32_t *table, vi index)
{
    return _mm256_i32gather_epi32((const int *)table, index, 4);
}

static inline fm i_any_above(vi a, vi b, vi c, vi limit)
{
    const vi most = _mm256_max_epu32(_mm256_max_epu32(a, b), c);
    return f_from_bits(_mm256_xor_si256(_mm256_cmpeq_epi32(_mm256_max_epu32(most, limit), limit), i_set(0xffffffff)));
}
static inline vi i_min(vi a, vi b) { return _mm256_min_epi32(a, b); }
static inline vf f_fma(vf a, vf b, vf c) { return _mm256_fmadd_ps(a, b, c); }

static inline vf f_load_any(const float *p) { return _mm256_loadu_ps(p); }
static inline vi i_merge(vi mask, vi a, vi b) { return _mm256_blendv_epi8(b, a, mask); }

#define F_EXPONENTS 16
static inline vf f_by_exponent(const vf table[F_EXPONENTS / VF], vf x)
{
    const vi exponent = i_shr(f_bits(x), 23);
    const vf low = _mm256_permutevar8x32_ps(table[0], exponent), high = _mm256_permutevar8x32_ps(table[1], exponent);
    return _mm256_blendv_ps(low, high, f_from_bits(i_shl(f_bits(x), 5))); // bit 3 of the exponent selects the half of
        // the table
}
#define f_by_exponent f_by_exponent

static inline void i_store_rgb(uint8_t *to, size_t stride, vi rgb, bool spill)
{
    const __m128i bytes = _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1);
    const __m256i packed = _mm256_shuffle_epi8(rgb, _mm256_broadcastsi128_si256(bytes));
    const __m128i row[2] = { _mm256_castsi256_si128(packed), _mm256_extracti128_si256(packed, 1) };
    for (int i = 0; i < 2; i++, to += stride) {
        if (spill) {
            _mm_storeu_si128((__m128i *)to, row[i]);
        } else {
            _mm_storel_epi64((__m128i *)to, row[i]);
            const int last = _mm_extract_epi32(row[i], 2);
            memcpy(to + 8, &last, sizeof last);
        }
    }
}

static inline vd d_set(double x) { return _mm256_set1_pd(x); }
static inline vd d_load(const double *p) { return _mm256_load_pd(p); }
static inline void d_store(double *p, vd x) { _mm256_store_pd(p, x); }
static inline vd d_pick(const double *table, const uint32_t *index)
{
    return _mm256_i32gather_pd(table, _mm_load_si128((const __m128i *)index), 8);
}
static inline vd d_sqrt(vd x) { return _mm256_sqrt_pd(x); }
static inline vd d_min(vd a, vd b) { return _mm256_min_pd(a, b); }
static inline vd d_max(vd a, vd b) { return _mm256_max_pd(a, b); }
static inline dm d_lt(vd a, vd b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
static inline dm d_le(vd a, vd b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
static inline dm d_eq(vd a, vd b) { return _mm256_cmp_pd(a, b, _CMP_EQ_OQ); }
static inline vd d_select(dm m, vd a, vd b) { return _mm256_blendv_pd(b, a, m); }
static inline dm dm_and(dm a, dm b) { return _mm256_and_pd(a, b); }
static inline dm dm_or(dm a, dm b) { return _mm256_or_pd(a, b); }
static inline dm dm_andnot(dm a, dm b) { return _mm256_andnot_pd(b, a); }
static inline unsigned dm_bits(dm m) { return (unsigned)_mm256_movemask_pd(m); }
static inline dm dm_from_bits(unsigned bits)
{
    const __m256i lane = _mm256_setr_epi64x(1, 2, 4, 8);
    return _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(_mm256_set1_epi64x((int)bits), lane), lane));
}

static inline vd d_load_f(const float *p) { return _mm256_cvtps_pd(_mm_load_ps(p)); }
static inline void d_store_f(float *p, vd x) { _mm_store_ps(p, _mm256_cvtpd_ps(x)); }

/// Joins two vectors of doubles, rounded to float.
static inline vf f_join(vd low, vd high)
{
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(low)), _mm256_cvtpd_ps(high), 1);
}

/// Splits a vector of floats into two vectors of doubles.
static inline void f_split(vf x, vd out[2])
{
    out[0] = _mm256_cvtps_pd(_mm256_castps256_ps128(x));
    out[1] = _mm256_cvtps_pd(_mm256_extractf128_ps(x, 1));
}

/// Stores i into p in the lanes of the mask.
static inline void d_put_index(uint32_t *p, dm mask, uint32_t i)
{
    float *to = (float *)p;
    const __m128 low = _mm_castpd_ps(_mm256_castpd256_pd128(mask)),
                 high = _mm_castpd_ps(_mm256_extractf128_pd(mask, 1));
    const __m128 index = _mm_castsi128_ps(_mm_set1_epi32((int)i));
    _mm_store_ps(to, _mm_blendv_ps(_mm_load_ps(to), index, _mm_shuffle_ps(low, high, 0x88)));
}

static inline vd d_exponent(vd x)
{
    __m256i e = _mm256_srli_epi64(_mm256_castpd_si256(x), 52);
    return _mm256_castsi256_pd(_mm256_or_si256(e, _mm256_set1_epi64x(0x4330000000000000))) - d_set(0x1p52 + 1023);
}
static inline vd d_mantissa(vd x)
{
    __m256i m = _mm256_and_si256(_mm256_castpd_si256(x), _mm256_set1_epi64x(0x000fffffffffffff));
    return _mm256_castsi256_pd(_mm256_or_si256(m, _mm256_set1_epi64x(0x3ff0000000000000)));
}

static inline vd d_abs(vd x) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), x); }
static inline vd d_copysign(vd size, vd sign)
{
    return _mm256_or_pd(_mm256_andnot_pd(_mm256_set1_pd(-0.0), size), _mm256_and_pd(_mm256_set1_pd(-0.0), sign));
}
static inline vd d_floor(vd x) { return _mm256_floor_pd(x); }
static inline vd d_ceil(vd x) { return _mm256_ceil_pd(x); }

static inline vq d_bits(vd x) { return _mm256_castpd_si256(x); }
static inline vd d_of_bits(vq x) { return _mm256_castsi256_pd(x); }
/// Returns the bits of floor(x) + 0x1.8p52: for |x| < 2^51, the lowest bits are the lowest bits of the integer part.
static inline vq d_floor_bits(vd x) { return d_bits(d_floor(x) + d_set(0x1.8p52)); }
static inline vq q_set(uint64_t x) { return _mm256_set1_epi64x((long long)x); }
static inline vq q_add(vq a, vq b) { return _mm256_add_epi64(a, b); }
static inline vq q_and(vq a, vq b) { return _mm256_and_si256(a, b); }
static inline vq q_or(vq a, vq b) { return _mm256_or_si256(a, b); }
static inline vq q_xor(vq a, vq b) { return _mm256_xor_si256(a, b); }
static inline vq q_mul(vq a, vq b) { return _mm256_mul_epu32(a, b); }
#define q_shl(x, n) _mm256_slli_epi64(x, n)
#define q_shr(x, n) _mm256_srli_epi64(x, n)
static inline dm q_is(vq x, uint32_t bits, uint32_t value)
{
    return _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(x, q_set(bits)), q_set(value)));
}
static inline dm q_test(vq x, uint32_t bit) { return q_is(x, bit, bit); }

#define GLINT_D_FUSED 1 ///< the following three functions exist
/// Return a * b + c and c - a * b, rounded once.
static inline vd d_fma(vd a, vd b, vd c) { return _mm256_fmadd_pd(a, b, c); }
static inline vd d_fnma(vd a, vd b, vd c) { return _mm256_fnmadd_pd(a, b, c); }
/// Returns min(|a|, |b|); undefined for NaN.
static inline vd d_least_size(vd a, vd b) { return d_min(d_abs(a), d_abs(b)); }

static inline vd d_two_prod(vd a, vd b, vd *error)
{
    vd p = a * b;
    *error = _mm256_fmsub_pd(a, b, p);
    return p;
}

#endif
