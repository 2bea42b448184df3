/// 113-bit arithmetic. Private to the oracle.
#ifndef GLINT_TESTS_QUAD_H
#define GLINT_TESTS_QUAD_H

#include <math.h>

#ifdef __clang__ // clang has only the older name of the type in C, and glibc's headers hide the functions from it
__extension__ typedef __float128 quad;
quad floorf128(quad), sqrtf128(quad), expf128(quad), exp2f128(quad), log2f128(quad), powf128(quad, quad), sinf128(quad),
    cosf128(quad), tanf128(quad), acosf128(quad), atan2f128(quad, quad);
#else
__extension__ typedef _Float128 quad;
#endif

#endif
