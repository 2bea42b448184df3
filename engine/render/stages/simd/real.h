/// The words of the vocabulary for `real`: double if the Makefile defines GLINT_REAL as 64, float if it is 32.
/// R(name) is the name of a kernel or helper for this precision.
#ifndef GLINT_REAL_H
#define GLINT_REAL_H

#include "engine/render/stages/simd/elementary.h"

#if GLINT_REAL == 64
#define real double
#define vr vd
#define rm dm
#define VR VD
#define R(name) name##_f64
#define r_set d_set
#define r_load d_load
#define r_store d_store
#define r_sqrt d_sqrt
#define r_min d_min
#define r_max d_max
#define r_lt d_lt
#define r_le d_le
#define r_eq d_eq
#define r_select d_select
#define rm_and dm_and
#define rm_or dm_or
#define rm_andnot dm_andnot
#define rm_bits dm_bits
#define rm_from_bits dm_from_bits
#define r_store_f d_store_f
#define r_exponent d_exponent
#define r_mantissa d_mantissa
#define r_put_index d_put_index
#define r_pick d_pick
#define r_pack d_pack
#define GLINT_PARALLEL 1e-60 // a ray is parallel to a plane if the angle's squared sine is below this
#define GLINT_POINT_SLACK GLINT_POINT_SLACK_DOUBLE
#define GLINT_ON_FACE GLINT_ON_FACE_DOUBLE
#define GLINT_ROUNDER GLINT_ROUNDER_DOUBLE
#define GLINT_SPHERE_CLOSE GLINT_SPHERE_CLOSE_DOUBLE
#else
#define real float
#define vr vf
#define rm fm
#define VR VF
#define R(name) name##_f32
#define r_set(x) f_set((float)(x))
#define r_load f_load
#define r_store f_store
#define r_sqrt f_sqrt
#define r_min f_min
#define r_max f_max
#define r_lt f_lt
#define r_le f_le
#define r_eq f_eq
#define r_select f_select
#define rm_and fm_and
#define rm_or fm_or
#define rm_andnot fm_andnot
#define rm_bits fm_bits
#define rm_from_bits fm_from_bits
#define r_store_f f_store
#define r_exponent f_exponent
#define r_mantissa f_mantissa
#define r_put_index(p, mask, i) i_store(p, f_bits(f_select(mask, f_from_bits(i_set(i)), f_from_bits(i_load(p)))))
#define r_pack f_pack
#define r_pick(table, index) f_from_bits(i_gather((const uint32_t *)(table), i_load(index)))
#define GLINT_PARALLEL 1e-30
#define GLINT_POINT_SLACK GLINT_POINT_SLACK_FLOAT
#define GLINT_ON_FACE GLINT_ON_FACE_FLOAT
#define GLINT_ROUNDER GLINT_ROUNDER_FLOAT
#define GLINT_SPHERE_CLOSE GLINT_SPHERE_CLOSE_FLOAT
#endif

/// Loads VR floats as real; load_narrow loads VF reals as floats. A wide load of data from narrower stores would
/// stall until the stores are in the cache.
static inline vr R(load_wide)(const float *p)
{
#if GLINT_REAL == 64
    return d_load_f(p);
#else
    return f_load(p);
#endif
}

static inline vf R(load_narrow)(const real *p)
{
#if GLINT_REAL == 64
    return f_join(d_load(p), d_load(p + VD));
#else
    return f_load(p);
#endif
}

/// Convert VD lanes of real to doubles, and back, rounded.
static inline vd R(load_exact)(const real *p)
{
#if GLINT_REAL == 64
    return d_load(p);
#else
    return d_load_f(p);
#endif
}

static inline void R(store_exact)(real *p, vd x)
{
#if GLINT_REAL == 64
    d_store(p, x);
#else
    d_store_f(p, x);
#endif
}

/// Converts a group of reals to floats.
static inline void R(narrow)(const real from[GLINT_GROUP], float to[GLINT_GROUP])
{
    for (int i = 0; i < GLINT_GROUP; i += VF)
        f_store(to + i, R(load_narrow)(from + i));
}

#endif
