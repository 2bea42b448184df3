/// The words of simd/generic.h for which WebAssembly has instructions that clang does not use: roots and integer
/// parts of both lanes, the bits of a mask, conversions between float and double, and products of 32-bit integers.
/// Included by generic.h after its types.
#ifndef GLINT_SIMD_WASM_H
#define GLINT_SIMD_WASM_H

#include <wasm_simd128.h>

static inline unsigned fm_bits(fm m) { return (unsigned)wasm_i32x4_bitmask((v128_t)m); }
static inline unsigned dm_bits(dm m) { return (unsigned)wasm_i64x2_bitmask((v128_t)m); }

static inline vd d_load_f(const float *p) { return (vd)wasm_f64x2_promote_low_f32x4(wasm_v128_load64_zero(p)); }
static inline vf f_join(vd low, vd high)
{
    return (vf)wasm_i64x2_shuffle(wasm_f32x4_demote_f64x2_zero((v128_t)low), wasm_f32x4_demote_f64x2_zero((v128_t)high), 0, 2);
}
static inline void f_split(vf x, vd out[2])
{
    out[0] = (vd)wasm_f64x2_promote_low_f32x4((v128_t)x);
    out[1] = (vd)wasm_f64x2_promote_low_f32x4(wasm_i64x2_shuffle((v128_t)x, (v128_t)x, 1, 1));
}
static inline void d_store_f(float *p, vd x) { wasm_v128_store64_lane(p, wasm_f32x4_demote_f64x2_zero((v128_t)x), 0); }
static inline void d_put_index(uint32_t *p, dm mask, uint32_t i)
{
    const v128_t narrow = wasm_i32x4_shuffle((v128_t)mask, (v128_t)mask, 0, 2, 0, 2);
    wasm_v128_store64_lane(p, wasm_v128_bitselect(wasm_i32x4_splat((int32_t)i), wasm_v128_load64_zero(p), narrow), 0);
}

static inline vf f_sqrt(vf x) { return (vf)wasm_f32x4_sqrt((v128_t)x); }
static inline vd d_sqrt(vd x) { return (vd)wasm_f64x2_sqrt((v128_t)x); }
static inline vd d_floor(vd x) { return (vd)wasm_f64x2_floor((v128_t)x); }
static inline vd d_ceil(vd x) { return (vd)wasm_f64x2_ceil((v128_t)x); }

static inline vf f_select(fm m, vf a, vf b) { return (vf)wasm_v128_bitselect((v128_t)a, (v128_t)b, (v128_t)m); }
static inline vd d_select(dm m, vd a, vd b) { return (vd)wasm_v128_bitselect((v128_t)a, (v128_t)b, (v128_t)m); }
static inline vf f_min(vf a, vf b) { return (vf)wasm_f32x4_pmin((v128_t)b, (v128_t)a); }
static inline vf f_max(vf a, vf b) { return (vf)wasm_f32x4_pmax((v128_t)b, (v128_t)a); }
static inline vd d_min(vd a, vd b) { return (vd)wasm_f64x2_pmin((v128_t)b, (v128_t)a); }
static inline vd d_max(vd a, vd b) { return (vd)wasm_f64x2_pmax((v128_t)b, (v128_t)a); }
static inline vf f_abs(vf x) { return (vf)wasm_f32x4_abs((v128_t)x); }
static inline vd d_abs(vd x) { return (vd)wasm_f64x2_abs((v128_t)x); }

static inline vq q_mul(vq a, vq b)
{
    return (vq)wasm_u64x2_extmul_low_u32x4(wasm_i32x4_shuffle((v128_t)a, (v128_t)a, 0, 2, 0, 2), wasm_i32x4_shuffle((v128_t)b, (v128_t)b, 0, 2, 0, 2));
}

#endif
