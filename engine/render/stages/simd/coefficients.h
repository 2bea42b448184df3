/// Polynomials of the two elementary functions that shading needs: Chebyshev interpolation in exact arithmetic,
/// rounded to float. The relative error of each polynomial on its interval is below 2e-8.
#ifndef GLINT_COEFFICIENTS_H
#define GLINT_COEFFICIENTS_H

#define GLINT_SQRT2 0x1.6a09e667f3bcdp+0
#define GLINT_SQRT1_2 0x1.6a09e667f3bcdp-1
#define GLINT_LOG2_E 1.442695f
#define GLINT_EXP2_LEAST (-126.0f) ///< below this exponent, a distribution is 0, however high its peak is
#define GLINT_EXP2_LOWEST (-40.0f) ///< below this exponent, a highlight is 0, because it could not change a 16-bit
    ///< pixel value

// log2(1 + f) / f for f in [sqrt(1/2) - 1, sqrt(2) - 1]
#define GLINT_LOG2_C0 0x1.715476p+0f
#define GLINT_LOG2_C1 -0x1.715470p-1f
#define GLINT_LOG2_C2 0x1.ec70aap-2f
#define GLINT_LOG2_C3 -0x1.715a70p-2f
#define GLINT_LOG2_C4 0x1.277a52p-2f
#define GLINT_LOG2_C5 -0x1.eab7aap-3f
#define GLINT_LOG2_C6 0x1.a38c68p-3f
#define GLINT_LOG2_C7 -0x1.87f6a2p-3f
#define GLINT_LOG2_C8 0x1.7a63a0p-3f
#define GLINT_LOG2_C9 -0x1.b84fb6p-4f

// 2^f for f in [-1/2, 1/2]
#define GLINT_EXP2_D0 0x1.000000p+0f
#define GLINT_EXP2_D1 0x1.62e430p-1f
#define GLINT_EXP2_D2 0x1.ebfbe0p-3f
#define GLINT_EXP2_D3 0x1.c6aeccp-5f
#define GLINT_EXP2_D4 0x1.3b2a1cp-7f
#define GLINT_EXP2_D5 0x1.5f48c0p-10f
#define GLINT_EXP2_D6 0x1.444000p-13f

// sin(x) = x + x z (S1 + ...) and cos(x) = 1 + z (C1 + ...) with z = x^2, for |x| <= pi/4: Taylor series, maximum
// error 2e-9
#define GLINT_HALF_PI 0x1.921fb54442d18p+0
#define GLINT_SIN_1 (-1.0 / 6)
#define GLINT_SIN_2 (1.0 / 120)
#define GLINT_SIN_3 (-1.0 / 5040)
#define GLINT_SIN_4 (1.0 / 362880)
#define GLINT_COS_1 (-1.0 / 2)
#define GLINT_COS_2 (1.0 / 24)
#define GLINT_COS_3 (-1.0 / 720)
#define GLINT_COS_4 (1.0 / 40320)
#define GLINT_COS_5 (-1.0 / 3628800)
#define GLINT_ROUNDER_DOUBLE 0x1.8p52 ///< adding and then subtracting this number rounds to an integer
#define GLINT_ROUNDER_FLOAT 0x1.8p23

#endif
