/// The vector vocabulary, spelled for SSE2, which every x86-64 has. What the words mean: simd/avx512.h.
#ifndef GLINT_SIMD_H
#define GLINT_SIMD_H

#include <emmintrin.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define VF 4
#define VD 2
typedef __m128 vf;
typedef __m128d vd;
typedef __m128i vi;
typedef __m128i vq;
typedef __m128 fm;
typedef __m128d dm;

static inline vf f_set(float x) { return _mm_set1_ps(x); }
static inline vf f_load(const float *p) { return _mm_load_ps(p); }
static inline vf f_load_any(const float *p) { return _mm_loadu_ps(p); }
static inline void f_store(float *p, vf x) { _mm_store_ps(p, x); }
static inline vf f_sqrt(vf x) { return _mm_sqrt_ps(x); }
static inline vf f_min(vf a, vf b) { return _mm_min_ps(a, b); }
static inline vf f_max(vf a, vf b) { return _mm_max_ps(a, b); }
static inline float f_max_all(vf x)
{
    x = _mm_max_ps(x, _mm_movehl_ps(x, x));
    return _mm_cvtss_f32(_mm_max_ss(x, _mm_shuffle_ps(x, x, 1)));
}
static inline float f_min_all(vf x)
{
    x = _mm_min_ps(x, _mm_movehl_ps(x, x));
    return _mm_cvtss_f32(_mm_min_ss(x, _mm_shuffle_ps(x, x, 1)));
}
static inline vf f_abs(vf x) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), x); }
static inline fm f_lt(vf a, vf b) { return _mm_cmplt_ps(a, b); }
static inline fm f_le(vf a, vf b) { return _mm_cmple_ps(a, b); }
static inline fm f_eq(vf a, vf b) { return _mm_cmpeq_ps(a, b); }
static inline vf f_select(fm m, vf a, vf b) { return _mm_or_ps(_mm_and_ps(m, a), _mm_andnot_ps(m, b)); }
static inline fm fm_and(fm a, fm b) { return _mm_and_ps(a, b); }
static inline fm fm_or(fm a, fm b) { return _mm_or_ps(a, b); }
static inline fm fm_andnot(fm a, fm b) { return _mm_andnot_ps(b, a); }
static inline unsigned fm_bits(fm m) { return (unsigned)_mm_movemask_ps(m); }
static inline fm fm_from_bits(unsigned bits)
{
    const __m128i lane = _mm_setr_epi32(1, 2, 4, 8);
    return _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32((int)bits), lane), lane));
}

static inline vi f_bits(vf x) { return _mm_castps_si128(x); }
static inline vf f_from_bits(vi x) { return _mm_castsi128_ps(x); }
static inline vi i_from_f(vf x) { return _mm_cvttps_epi32(x); } // towards 0
static inline vi i_set(uint32_t x) { return _mm_set1_epi32((int)x); }
static inline vi i_add(vi a, vi b) { return _mm_add_epi32(a, b); }
static inline vi i_sub(vi a, vi b) { return _mm_sub_epi32(a, b); }
static inline vi i_and(vi a, vi b) { return _mm_and_si128(a, b); }
static inline vi i_or(vi a, vi b) { return _mm_or_si128(a, b); }
#define i_shl(x, n) _mm_slli_epi32(x, n)
#define i_shr(x, n) _mm_srli_epi32(x, n)
static inline fm i_lt(vi a, vi b) { return _mm_castsi128_ps(_mm_cmplt_epi32(a, b)); }
static inline fm i_eq(vi a, vi b) { return _mm_castsi128_ps(_mm_cmpeq_epi32(a, b)); }
static inline vi i_load(const uint32_t *p) { return _mm_load_si128((const __m128i *)p); }
static inline void i_store(uint32_t *p, vi x) { _mm_store_si128((__m128i *)p, x); }
static inline vi i_gather(const uint32_t *table, vi index)
{
    uint32_t i[4];
    _mm_storeu_si128((__m128i *)i, index);
    return _mm_setr_epi32((int)table[i[0]], (int)table[i[1]], (int)table[i[2]], (int)table[i[3]]);
}

static inline fm i_any_above(vi a, vi b, vi c, vi limit)
{
    const vi far = i_or(i_or(i_sub(limit, a), i_sub(limit, b)), i_sub(limit, c)); // below 0 where above or negative
    return i_lt(i_or(far, i_or(i_or(a, b), c)), i_set(0));
}

static inline void i_store_rgb(uint8_t *to, size_t stride, vi rgb, bool spill)
{
    (void)stride, (void)spill;
    const __m128i pair = _mm_or_si128(_mm_and_si128(rgb, _mm_set1_epi64x(0xffffff)),
                                      _mm_and_si128(_mm_srli_epi64(rgb, 8), _mm_set1_epi64x(0xffffff000000)));
    const __m128i packed = _mm_or_si128(_mm_move_epi64(pair), _mm_slli_si128(_mm_srli_si128(pair, 8), 6));
    _mm_storel_epi64((__m128i *)to, packed);
    const int last = _mm_cvtsi128_si32(_mm_srli_si128(packed, 8));
    memcpy(to + 8, &last, sizeof last);
}

static inline vd d_set(double x) { return _mm_set1_pd(x); }
static inline vd d_load(const double *p) { return _mm_load_pd(p); }
static inline void d_store(double *p, vd x) { _mm_store_pd(p, x); }
static inline vd d_pick(const double *table, const uint32_t *index)
{
    return _mm_setr_pd(table[index[0]], table[index[1]]);
}
static inline vd d_sqrt(vd x) { return _mm_sqrt_pd(x); }
static inline vd d_min(vd a, vd b) { return _mm_min_pd(a, b); }
static inline vd d_max(vd a, vd b) { return _mm_max_pd(a, b); }
static inline dm d_lt(vd a, vd b) { return _mm_cmplt_pd(a, b); }
static inline dm d_le(vd a, vd b) { return _mm_cmple_pd(a, b); }
static inline dm d_eq(vd a, vd b) { return _mm_cmpeq_pd(a, b); }
static inline vd d_select(dm m, vd a, vd b) { return _mm_or_pd(_mm_and_pd(m, a), _mm_andnot_pd(m, b)); }
static inline dm dm_and(dm a, dm b) { return _mm_and_pd(a, b); }
static inline dm dm_or(dm a, dm b) { return _mm_or_pd(a, b); }
static inline dm dm_andnot(dm a, dm b) { return _mm_andnot_pd(b, a); }
static inline unsigned dm_bits(dm m) { return (unsigned)_mm_movemask_pd(m); }
static inline dm dm_from_bits(unsigned bits)
{
    return _mm_castsi128_pd(_mm_set_epi64x(-(long long)(bits >> 1 & 1), -(long long)(bits & 1)));
}

static inline vd d_load_f(const float *p)
{
    return _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)p)));
}
static inline void d_store_f(float *p, vd x) { _mm_storel_epi64((__m128i *)p, _mm_castps_si128(_mm_cvtpd_ps(x))); }

/// Two vectors of doubles, rounded.
static inline vf f_join(vd low, vd high) { return _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high)); }

/// The other way.
static inline void f_split(vf x, vd out[2])
{
    out[0] = _mm_cvtps_pd(x);
    out[1] = _mm_cvtps_pd(_mm_movehl_ps(x, x));
}

/// p = i in the lanes of the mask.
static inline void d_put_index(uint32_t *p, dm mask, uint32_t i)
{
    for (int lane = 0; lane < VD; lane++)
        if (_mm_movemask_pd(mask) >> lane & 1)
            p[lane] = i;
}

static inline vd d_exponent(vd x)
{
    __m128i e = _mm_srli_epi64(_mm_castpd_si128(x), 52);
    return _mm_castsi128_pd(_mm_or_si128(e, _mm_set1_epi64x(0x4330000000000000))) - d_set(0x1p52 + 1023);
}
static inline vd d_mantissa(vd x)
{
    __m128i m = _mm_and_si128(_mm_castpd_si128(x), _mm_set1_epi64x(0x000fffffffffffff));
    return _mm_castsi128_pd(_mm_or_si128(m, _mm_set1_epi64x(0x3ff0000000000000)));
}

static inline vd d_abs(vd x) { return _mm_andnot_pd(_mm_set1_pd(-0.0), x); }
static inline vd d_copysign(vd size, vd sign)
{
    return _mm_or_pd(_mm_andnot_pd(_mm_set1_pd(-0.0), size), _mm_and_pd(_mm_set1_pd(-0.0), sign));
}
static inline vd d_floor(vd x)
{
    const vd big = d_set(0x1p52), size = d_abs(x);
    const vd near = d_copysign((size + big) - big, x), low = near - d_select(d_lt(x, near), d_set(1), d_set(0));
    return d_select(d_lt(size, big), d_copysign(low, x), x);
}
static inline vd d_ceil(vd x) { return -d_floor(-x); }

static inline vq d_bits(vd x) { return _mm_castpd_si128(x); }
static inline vd d_of_bits(vq x) { return _mm_castsi128_pd(x); }
/// Those of floor(x) + 0x1.8p52: where |x| < 2^51, their lowest are those of the whole part.
static inline vq d_floor_bits(vd x) { return d_bits(d_floor(x) + d_set(0x1.8p52)); }
static inline vq q_set(uint64_t x) { return _mm_set1_epi64x((long long)x); }
static inline vq q_add(vq a, vq b) { return _mm_add_epi64(a, b); }
static inline vq q_and(vq a, vq b) { return _mm_and_si128(a, b); }
static inline vq q_or(vq a, vq b) { return _mm_or_si128(a, b); }
static inline vq q_xor(vq a, vq b) { return _mm_xor_si128(a, b); }
static inline vq q_mul(vq a, vq b) { return _mm_mul_epu32(a, b); }
#define q_shl(x, n) _mm_slli_epi64(x, n)
#define q_shr(x, n) _mm_srli_epi64(x, n)
static inline dm q_is(vq x, uint32_t bits, uint32_t value)
{
    const vq same = _mm_cmpeq_epi32(_mm_and_si128(x, q_set(bits)), q_set(value));
    return _mm_castsi128_pd(_mm_shuffle_epi32(same, 0xa0));
}
static inline dm q_test(vq x, uint32_t bit) { return q_is(x, bit, bit); }

/// Dekker's product (1971), with Veltkamp's splitting: the same bits as the FMA, short of over- and underflow.
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
