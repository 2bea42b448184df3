/// Coefficients of the operations of programs: the polynomials of their elementary functions, and the hash.
///
/// The polynomials are Taylor series where noted, otherwise Chebyshev interpolations in exact arithmetic, rounded to
/// double. The relative error of each polynomial on its interval is below 1e-16.
#ifndef GLINT_PATTERN_KERNEL_COEFFICIENTS_H
#define GLINT_PATTERN_KERNEL_COEFFICIENTS_H

#include "engine/render/stages/simd/coefficients.h"

// pi/2 = high + middle + low. The first two have 33 bits, so that their products with a number of 20 bits are exact
#define GLINT_HALF_PI_HIGH 0x1.921fb54400000p+0
#define GLINT_HALF_PI_MIDDLE 0x1.0b4611a600000p-34
#define GLINT_HALF_PI_LOW 0x1.3198a2e037073p-69
#define GLINT_2_PI 0x1.45f306dc9c883p-1 ///< 2 / pi
#define GLINT_PI_2 0x1.921fb54442d18p+0
#define GLINT_PI_4 0x1.921fb54442d18p-1
#define GLINT_PI_1 0x1.921fb54442d18p+1
#define GLINT_ANGLE_MAX 0x1p20 ///< lanes with a larger angle are reduced one by one
#define GLINT_TAN_PI_8 0x1.a827999fcef32p-2

// sin(x) = x + (x z) (S0 + S1 z ...), cos(x) = 1 + z (C0 + C1 z ...), z = x x, |x| <= pi/4: Taylor
#define GLINT_SINE \
    { \
        -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000 \
    }
#define GLINT_COSINE \
    { \
        -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600, -1.0 / 87178291200, \
            1.0 / 20922789888000 \
    }

// 2^f for f in [-1/2, 1/2]: Taylor
#define GLINT_POWER_OF_2 \
    { \
        1.0, 0x1.62e42fefa39efp-1, 0x1.ebfbdff82c58fp-3, 0x1.c6b08d704a0c0p-5, 0x1.3b2ab6fba4e77p-7, \
            0x1.5d87fe78a6731p-10, 0x1.430912f86c787p-13, 0x1.ffcbfc588b0c7p-17, 0x1.62c0223a5c824p-20, \
            0x1.b5253d395e7c4p-24, 0x1.e4cf5158b8ecap-28, 0x1.e8cac7351bb25p-32, 0x1.c3bd650fc2986p-36, \
            0x1.816193166d0f9p-40 \
    }

// log2((1 + s) / (1 - s)) / s for s^2, |s| <= (sqrt(2) - 1) / (sqrt(2) + 1)
#define GLINT_LOG2_RATIO \
    { \
        0x1.71547652b82fep+1, 0x1.ec709dc3a03fcp-1, 0x1.2776c50ef9fccp-1, 0x1.a61762a7085b5p-2, 0x1.484b144873aafp-2, \
            0x1.0c9a5991ac1dbp-2, 0x1.c6a297a1c02bep-3, 0x1.87740344cfbf0p-3, 0x1.87d8eea5e8a95p-3 \
    }

// atan(t) / t for t^2, |t| <= tan(pi/8)
#define GLINT_ARC_TANGENT \
    { \
        1.0, -0x1.555555555552fp-2, 0x1.9999999994669p-3, -0x1.2492492259b2cp-3, 0x1.c71c70cb76ec2p-4, \
            -0x1.745cf64dbfb04p-4, 0x1.3b10f0f4cc702p-4, -0x1.10ea1d0b39da0p-4, 0x1.def9ec3f53387p-5, \
            -0x1.9c79bdc863d9bp-5, 0x1.3702e375a901dp-5, -0x1.23b9304da971fp-6 \
    }

// asin(t) / t for t^2, |t| <= 1/2
#define GLINT_ARC_SINE \
    { \
        1.0, 0x1.55555555552e8p-3, 0x1.3333333376f76p-4, 0x1.6db6db3f6a946p-5, 0x1.f1c72cd29986fp-6, \
            0x1.6e89eb5c47bcdp-6, 0x1.1c6c3184e43eap-6, 0x1.c6fa7fa93ae3ap-7, 0x1.8eca8e1460bfap-7, \
            0x1.abe7380074e55p-8, 0x1.3fb59ef99ab8bp-6, -0x1.09372b2b156dfp-6, 0x1.0528866391770p-5 \
    }

// The factors of the hash: odd 32-bit numbers without a pattern, one per coordinate
#define GLINT_HASH_X 0xb5a3f1e7u
#define GLINT_HASH_Y 0x93d1c2b5u
#define GLINT_HASH_Z 0xd8e6a94du
#define GLINT_HASH_SEED 0x9c5b7a33u
#define GLINT_HASH_A 0xe3779b51u
#define GLINT_HASH_B 0xaf1d35c9u
#define GLINT_HASH_C 0xc7a94e6bu

/// Factor of noise: one over the maximum of noise with Perlin's gradients, 1.03635382 at (0.3553, 0.4815, 0.5),
/// rounded down.
#define GLINT_NOISE_SCALE 0.9649

#endif
