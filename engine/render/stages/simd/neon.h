/// The words of simd/generic.h for which ARM has instructions that GCC does not use: the bits of a mask, conversions
/// between float and double, and products of 32-bit integers. Frames take 2 to 7 % fewer instructions, with the same
/// bits. Included by generic.h after its types.
#ifndef GLINT_SIMD_NEON_H
#define GLINT_SIMD_NEON_H

#include <arm_neon.h>

static inline unsigned fm_bits(fm m)
{
    const uint32x4_t lane = { 1, 2, 4, 8 };
    return vaddvq_u32(vandq_u32((uint32x4_t)m, lane));
}
static inline unsigned dm_bits(dm m)
{
    const uint64x2_t lane = { 1, 2 };
    return (unsigned)vaddvq_u64(vandq_u64((uint64x2_t)m, lane));
}

static inline vd d_load_f(const float *p) { return (vd)vcvt_f64_f32(vld1_f32(p)); }
static inline vf f_join(vd low, vd high)
{
    return (vf)vcvt_high_f32_f64(vcvt_f32_f64((float64x2_t)low), (float64x2_t)high);
}
static inline void f_split(vf x, vd out[2])
{
    out[0] = (vd)vcvt_f64_f32(vget_low_f32((float32x4_t)x));
    out[1] = (vd)vcvt_high_f64_f32((float32x4_t)x);
}
static inline void d_put_index(uint32_t *p, dm mask, uint32_t i)
{
    vst1_u32(p, vbsl_u32(vmovn_u64((uint64x2_t)mask), vdup_n_u32(i), vld1_u32(p)));
}

static inline vq q_mul(vq a, vq b)
{
    return (vq)vmull_u32(vmovn_u64((uint64x2_t)a), vmovn_u64((uint64x2_t)b));
}

#endif
