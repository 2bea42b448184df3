/// A 113-bit float for reference results: long double if it has 113 bits (ARM, RISC-V), otherwise the compiler's own.
#ifndef GLINT_TESTS_QUAD_H
#define GLINT_TESTS_QUAD_H

#include <float.h>

#if LDBL_MANT_DIG == 113
typedef long double quad;
#else
__extension__ typedef __float128 quad;
#endif

#endif
