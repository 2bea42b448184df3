/// Vectors of sixteen floats for the programs that glint is compared with: AVX-512, with everything that -ffast-math
/// allows.
///
/// The logarithm, the power and the sRGB curve are polynomials of the mantissa with an error
/// of 3e-6, far below an 8-bit step.
#ifndef GLINT_BENCH_WIDE_H
#define GLINT_BENCH_WIDE_H

#include <immintrin.h>

typedef __m512 vf;
typedef __m512i vi;
typedef __mmask16 vm;

typedef struct vec {
    vf x, y, z;
} vec;

static inline vf all(float x) { return _mm512_set1_ps(x); }
static inline vf pick(vm mask, vf yes, vf no) { return _mm512_mask_blend_ps(mask, no, yes); }
static inline vm less(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
/// Returns entry `index` (0 .. 15, one index per lane) of a table that is held in one register.
static inline vf look_up(vf table, vi index) { return _mm512_permutexvar_ps(index, table); }

static inline vf dot(vec a, vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec add_scaled(vec a, vec b, vf s) { return (vec) { a.x + b.x * s, a.y + b.y * s, a.z + b.z * s }; }
static inline vec minus(vec a, vec b) { return (vec) { a.x - b.x, a.y - b.y, a.z - b.z }; }
static inline vec scaled(vec a, vf s) { return (vec) { a.x * s, a.y * s, a.z * s }; }
static inline vec all3(const float v[3]) { return (vec) { all(v[0]), all(v[1]), all(v[2]) }; }

/// Returns 1 / sqrt(x): the processor's 14-bit estimate, refined by one Newton step.
static inline vf inverse_sqrt(vf x)
{
    vf r = _mm512_rsqrt14_ps(x);
    return r * (all(1.5F) - all(0.5F) * x * r * r);
}

static inline vf log2_of(vf x)
{
    vf m = _mm512_getmant_ps(x, _MM_MANT_NORM_1_2, _MM_MANT_SIGN_zero);
    vf p = all(-0.0245685347F);
    p = p * m + all(0.265024293F);
    p = p * m + all(-1.22929101F);
    p = p * m + all(3.21280029F);
    p = p * m + all(-5.26168251F);
    p = p * m + all(6.06687145F);
    p = p * m + all(-3.02915154F);
    return p + _mm512_getexp_ps(x);
}

static inline vf exp2_of(vf x)
{
    x = _mm512_max_ps(x, all(-100));
    vf whole = _mm512_roundscale_ps(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC), f = x - whole;
    vf p = all(0.00966636852F);
    p = p * f + all(0.0559219758F);
    p = p * f + all(0.24022349F);
    p = p * f + all(0.693121045F);
    p = p * f + all(1);
    return _mm512_scalef_ps(p, whole);
}

/// Converts linear light to 8-bit sRGB values: 1.055 x^(1/2.4) - 0.055, or 12.92 x for dark values.
static inline vi srgb_of(vf x)
{
    x = _mm512_max_ps(_mm512_min_ps(x, all(1)), all(0));
    vf m = _mm512_getmant_ps(x, _MM_MANT_NORM_1_2, _MM_MANT_SIGN_zero);
    vi exponent = _mm512_srli_epi32(_mm512_castps_si512(x), 23); // the low four bits select the table entry
    // 255 1.055 2^(5/12 (k - 15)): entry 15 is the octave from 1; the lowest entries are in the linear part.
    const vf octave =
        _mm512_setr_ps(3.534721F, 4.718287F, 6.298157F, 8.407031F, 11.22204F, 14.97963F, 19.9954F, 26.69066F, 35.62776F,
                       47.55735F, 63.48145F, 84.73757F, 113.1111F, 150.9852F, 201.541F, 269.025F);
    vf p = all(-0.01048321F);
    p = p * m + all(0.0869535458F);
    p = p * m + all(-0.313670527F);
    p = p * m + all(0.824403559F);
    p = p * m + all(0.412809969F);
    vf curve = p * look_up(octave, exponent) - all(0.055F * 255);
    vf codes = pick(less(x, all(0.0031308F)), x * all(12.92F * 255), curve);
    return _mm512_cvtps_epi32(codes);
}

#endif
